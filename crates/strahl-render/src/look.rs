//! Object and material of an element.

use crate::runs::Run;
use strahl_shade::MaterialId;

/// Object and material of an element.
#[derive(Clone, Debug)]
pub(crate) enum Looks {
    One(Look),
    /// Indexed by the tags of a CSG tree's leaves.
    Leaves(Box<[Look]>),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Look {
    pub(crate) object: u32,
    pub(crate) material: MaterialId,
    /// Index in the list of texture spaces, or [`Look::NO_SPACE`].
    pub(crate) texture_space: u32,
}

impl Look {
    /// The texture's space is the group's.
    pub(crate) const NO_SPACE: u32 = u32::MAX;
}

/// Runs are objects of one material.
impl Run for Look {
    type Item = Self;

    fn of(item: Self) -> Self {
        item
    }

    fn goes_on(&mut self, len: u32, item: &Self) -> bool {
        self.item(len) == *item
    }

    #[inline(always)]
    fn item(&self, place: u32) -> Self {
        Self {
            object: self.object.wrapping_add(place),
            ..*self
        }
    }
}
