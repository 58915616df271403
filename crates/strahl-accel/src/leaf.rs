//! Leaves whose primitives lie in blocks of slots.

/// Primitives in a block of slots.
pub const BLOCK: usize = 4;

/// Marks a slot without a primitive.
pub const NO_PRIMITIVE: u32 = u32::MAX;

/// A leaf of a structure with blocks of slots.
#[derive(Clone, Copy, Debug)]
pub struct Leaf<'a> {
    /// The class of all its primitives.
    pub class: u8,
    /// Its first block.
    pub first_block: usize,
    /// Number of its primitives, at least one.
    pub count: usize,
    /// The slots of the structure.
    pub slots: &'a [u32],
}

impl<'a> Leaf<'a> {
    /// Number of its blocks.
    #[inline(always)]
    pub const fn blocks(&self) -> usize {
        self.count.div_ceil(BLOCK)
    }

    /// Its primitives.
    #[inline(always)]
    pub fn ids(&self) -> &'a [u32] {
        let first = self.first_block * BLOCK;
        &self.slots[first..first + self.count]
    }

    /// The content of a slot of one of its blocks: a primitive, or [`NO_PRIMITIVE`].
    #[inline(always)]
    pub fn id(&self, block: usize, lane: usize) -> u32 {
        let slot = (self.first_block + block) * BLOCK + lane;
        self.slots.get(slot).copied().unwrap_or(NO_PRIMITIVE)
    }
}
