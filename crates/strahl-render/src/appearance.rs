//! The appearance of an element: its object, its material, and where its texture lies.

use crate::media::{Body, Crossing, Medium};
use crate::runs::Run;
use std::sync::Arc;
use strahl_shade::{Material, MaterialId};

/// The appearance of the elements of a shape.
#[derive(Clone, Debug)]
pub(crate) enum Appearances {
    One(Appearance),
    /// Of a CSG tree.
    Leaves {
        /// Indexed by the tags of the leaves.
        appearances: Arc<[Appearance]>,
        /// The leaf that is filled with what the whole is filled with, if there is one.
        whole: Option<u32>,
    },
}

impl Appearances {
    /// Of a tree that is a part of this body.
    pub(crate) fn of_leaves(appearances: Vec<Appearance>, body: u32) -> Self {
        let whole = appearances
            .iter()
            .position(|appearance| appearance.body == body);
        Self::Leaves {
            appearances: appearances.into(),
            whole: whole.map(|leaf| leaf as u32),
        }
    }

    /// All of them, changed.
    pub(crate) fn map(self, mut change: impl FnMut(Appearance) -> Appearance) -> Self {
        match self {
            Self::One(appearance) => Self::One(change(appearance)),
            Self::Leaves { appearances, whole } => Self::Leaves {
                appearances: appearances.iter().map(|a| change(*a)).collect(),
                whole,
            },
        }
    }

    /// The appearance of the leaf that says what is inside of the whole.
    pub(crate) fn of_inside(&self) -> Option<&Appearance> {
        match self {
            Self::One(appearance) => Some(appearance),
            Self::Leaves { appearances, whole } => appearances.get((*whole)? as usize),
        }
    }
}

/// Whether textures are evaluated at the texture coordinates of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum UvMapping {
    /// In space.
    Off,
    /// At (u, v, 0); transformations of objects don't move the texture: the object that has it has `uv_mapping`.
    Fixed,
    /// At (u, v, 0), with the transformations of objects: another object has `uv_mapping`, or the textures are those of a blob's
    /// components (measured with POV-Ray).
    Moved,
}

/// The object and the material of an element, and what else says how it is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Appearance {
    /// Number of the object.
    pub(crate) object: u32,
    pub(crate) material: MaterialId,
    /// Index in the list of texture spaces, or [`Appearance::NO_SPACE`].
    pub(crate) texture_space: u32,
    /// The number of the body that it is a part of: what is filled with one medium.
    pub(crate) body: u32,
    /// Whether fog is inside too.
    pub(crate) hollow: bool,
    /// Whether its textures lie on texture coordinates.
    pub(crate) uv: UvMapping,
}

impl Appearance {
    /// The texture's space is the group's.
    pub(crate) const NO_SPACE: u32 = u32::MAX;

    /// What is inside of it, in the space of the instances whose elements begin at `space`.
    #[inline]
    pub(crate) fn medium(&self, material: &Material, space: u64) -> Medium {
        Medium {
            body: match Crossing::of(material) {
                Crossing::BySide => Body::material(self.material),
                Crossing::ByTurns => Body::object(space, self.body),
            },
            material: self.material,
            hollow: self.hollow,
        }
    }
}

/// Objects of one material: parts of one body, or bodies of one part each.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AppearanceRun {
    first: Appearance,
    /// From the body of one to that of the next.
    bodies: u32,
}

impl Run for AppearanceRun {
    type Item = Appearance;

    fn of(item: Appearance) -> Self {
        let (first, bodies) = (item, 0);
        Self { first, bodies }
    }

    fn goes_on(&mut self, len: u32, item: &Appearance) -> bool {
        if len == 1 {
            self.bodies = item.body.wrapping_sub(self.first.body);
        }
        self.item(len) == *item
    }

    #[inline(always)]
    fn item(&self, place: u32) -> Appearance {
        let body = self.bodies.wrapping_mul(place);
        Appearance {
            object: self.first.object.wrapping_add(place),
            body: self.first.body.wrapping_add(body),
            ..self.first
        }
    }
}
