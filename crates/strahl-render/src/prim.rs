//! Primitives of a group: what the ids of accelerators stand for.

use crate::runs::Run;

/// A primitive of a group in 12 bytes, because scenes have millions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Prim {
    /// Index of the mesh use, shape or instance.
    index: u32,
    triangle: u32,
    tag: PrimTag,
    /// Which rays can see it (bits of [`crate::RayClass`]).
    pub(crate) visible: u8,
    /// Bits of `Prim::*`.
    pub(crate) flags: u8,
}

const _: () = assert!(size_of::<Prim>() == 12);

/// The kind of a [`Prim`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(u8)]
enum PrimTag {
    Triangle,
    Shape,
    Sphere,
    Placed,
    Instance,
}

/// A [`Prim`], decoded.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PrimKind {
    /// Triangle `1` of mesh use `0`.
    Triangle(u32, u32),
    /// A shape in the group's own space.
    Shape(u32),
    /// A sphere in its compact form.
    Sphere(u32),
    /// A shape with a transformation.
    Placed(u32),
    /// An instance of another group.
    Instance(u32),
}

impl Prim {
    /// One-sided or with an alpha mask: each hit must be checked.
    pub(crate) const FILTERED: u8 = 1;
    /// May transmit light (its material transmits, or one of its leaves' does).
    pub(crate) const TRANSMITS: u8 = 2;
    /// May block light.
    pub(crate) const STOPS: u8 = 4;
    /// One-sided, or one of its leaves is.
    pub(crate) const ONE_SIDED: u8 = 8;
    /// Has an alpha mask.
    pub(crate) const MASKED: u8 = 16;
    /// It may matter to rays that they start inside of it.
    pub(crate) const FILLED: u8 = 32;
    /// Each hit must be checked, or it depends on the element whether it transmits light. Set by [`Prim::new`].
    const CHECKED: u8 = 64;
    /// A tree of both kinds, whose surfaces shadow rays look at together: finding the opaque ones first takes as long as finding all.
    pub(crate) const TOGETHER: u8 = 128;

    pub(crate) const fn new(kind: PrimKind, visible: u8, flags: u8) -> Self {
        let (tag, index, triangle) = match kind {
            PrimKind::Triangle(index, triangle) => (PrimTag::Triangle, index, triangle),
            PrimKind::Shape(index) => (PrimTag::Shape, index, 0),
            PrimKind::Sphere(index) => (PrimTag::Sphere, index, 0),
            PrimKind::Placed(index) => (PrimTag::Placed, index, 0),
            PrimKind::Instance(index) => (PrimTag::Instance, index, 0),
        };
        let is_mixed = flags & Self::TRANSMITS != 0 && flags & Self::STOPS != 0;
        let filters = Self::FILTERED | Self::ONE_SIDED | Self::MASKED;
        let checked = match is_mixed || flags & filters != 0 {
            true => Self::CHECKED,
            false => 0,
        };
        Self {
            index,
            triangle,
            tag,
            visible,
            flags: flags | checked,
        }
    }

    /// The shape that it is, if all its hits count for whoever wants the primitive: they need no checks one by one.
    #[inline(always)]
    pub(crate) const fn unfiltered_shape(&self) -> Option<u32> {
        match self.tag {
            PrimTag::Shape | PrimTag::Placed if self.flags & Self::CHECKED == 0 => Some(self.index),
            _ => None,
        }
    }

    /// Decodes it.
    #[inline(always)]
    pub(crate) const fn kind(&self) -> PrimKind {
        match self.tag {
            PrimTag::Triangle => PrimKind::Triangle(self.index, self.triangle),
            PrimTag::Shape => PrimKind::Shape(self.index),
            PrimTag::Sphere => PrimKind::Sphere(self.index),
            PrimTag::Placed => PrimKind::Placed(self.index),
            PrimTag::Instance => PrimKind::Instance(self.index),
        }
    }
}

/// Runs are the triangles of a mesh, or shapes of a kind with the same visibility and flags.
impl Run for Prim {
    type Item = Self;

    fn of(item: Self) -> Self {
        item
    }

    fn goes_on(&mut self, len: u32, item: &Self) -> bool {
        self.item(len) == *item
    }

    #[inline(always)]
    fn item(&self, place: u32) -> Self {
        match self.tag {
            PrimTag::Triangle => Self {
                triangle: self.triangle.wrapping_add(place),
                ..*self
            },
            _ => Self {
                index: self.index.wrapping_add(place),
                ..*self
            },
        }
    }
}
