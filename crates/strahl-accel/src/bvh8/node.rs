use crate::boxes::Box32;
use crate::leaf::BLOCK;
use strahl_math::Vec4;
use strahl_simd::{Isa, Lanes8};

/// Children of a node.
pub(super) const WIDTH: usize = 8;

/// A node: up to eight children with their boxes, in four cache lines.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// Per axis the lower planes, then the upper planes of all children. Places without a child have an empty box.
    pub(super) planes: [Lanes8; 6],
    pub(super) children: [Child; WIDTH],
}

const _: () = assert!(size_of::<Node>() == 256);

/// A child. Bit 31 distinguishes leaves from nodes. The rest is the number of a node; or a leaf's first block (25 bits), class
/// (2 bits) and number of primitives less one (4 bits).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Child(u32);

/// A leaf, decoded from a [`Child`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LeafChild {
    pub(super) first_block: usize,
    pub(super) class: u8,
    /// Number of primitives, from 1 to 16.
    pub(super) count: usize,
}

impl Child {
    const LEAF: u32 = 1 << 31;
    const BLOCK_BITS: u32 = 25;
    /// The most blocks that can be numbered.
    pub(super) const MAX_BLOCKS: usize = 1 << Self::BLOCK_BITS;
    /// The most primitives in a leaf.
    pub(super) const MAX_LEAF: usize = 16;

    pub(super) const fn inner(node: usize) -> Self {
        Self(node as u32)
    }

    pub(super) const fn leaf(first_block: usize, class: u8, count: usize) -> Self {
        Self(
            Self::LEAF
                | ((class as u32 & 3) << 29)
                | ((count as u32 - 1) << Self::BLOCK_BITS)
                | first_block as u32,
        )
    }

    #[inline(always)]
    pub(super) const fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    #[inline(always)]
    pub(super) const fn bits(self) -> u32 {
        self.0
    }

    #[inline(always)]
    pub(super) const fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    /// Whether it is a leaf of one block that is tested as a whole.
    #[inline(always)]
    pub(super) const fn is_block(self) -> bool {
        let parts = self.parts();
        self.is_leaf() && parts.class != 0 && parts.count <= BLOCK
    }

    /// The number of a node.
    #[inline(always)]
    pub(super) const fn node(self) -> usize {
        self.0 as usize
    }

    /// The parts of a leaf.
    #[inline(always)]
    pub(super) const fn parts(self) -> LeafChild {
        LeafChild {
            first_block: (self.0 as usize) & (Self::MAX_BLOCKS - 1),
            class: (self.0 >> 29) as u8 & 3,
            count: ((self.0 >> Self::BLOCK_BITS) as usize & (Self::MAX_LEAF - 1)) + 1,
        }
    }

    /// The same child after `nodes` nodes and `blocks` blocks were inserted in front of those it refers to.
    pub(super) fn moved(self, nodes: usize, blocks: usize) -> Self {
        Self(self.0 + if self.is_leaf() { blocks } else { nodes } as u32)
    }
}

impl LeafChild {
    /// The slots of its primitives.
    #[inline(always)]
    pub(super) const fn slots(self) -> std::ops::Range<usize> {
        let first = self.first_block * BLOCK;
        first..first + self.count
    }
}

impl Node {
    pub(super) const EMPTY: Self = {
        let (lo, hi) = (Lanes8([f32::INFINITY; 8]), Lanes8([f32::NEG_INFINITY; 8]));
        Self {
            planes: [lo, hi, lo, hi, lo, hi],
            children: [Child(0); WIDTH],
        }
    };

    pub(super) fn set(&mut self, place: usize, bounds: &Box32, child: Child) {
        for axis in 0..3 {
            self.planes[2 * axis].0[place] = bounds.lo()[axis];
            self.planes[2 * axis + 1].0[place] = bounds.hi()[axis];
        }
        self.children[place] = child;
    }
}

/// A node as the traversals use it.
pub(super) trait WideNode: Copy {
    /// The lower (side 0) or upper planes (side 1) of all children across an axis.
    fn planes<I: Isa>(&self, isa: I, axis: usize, side: usize) -> I::F32x8;

    /// The places with a child, as bits; all if the others have empty boxes.
    fn used(&self) -> u32;

    /// A child.
    fn child(&self, place: usize) -> Child;

    /// The children with their boxes.
    fn children(&self) -> impl Iterator<Item = (Child, Box32)>;
}

impl WideNode for Node {
    #[inline(always)]
    fn planes<I: Isa>(&self, isa: I, axis: usize, side: usize) -> I::F32x8 {
        isa.load_f32(&self.planes[2 * axis + side])
    }

    #[inline(always)]
    fn used(&self) -> u32 {
        u32::MAX
    }

    #[inline(always)]
    fn child(&self, place: usize) -> Child {
        self.children[place]
    }

    fn children(&self) -> impl Iterator<Item = (Child, Box32)> {
        (0..WIDTH)
            .filter(|i| self.planes[0].0[*i] <= self.planes[1].0[*i])
            .map(|i| {
                let corner = |side: usize| {
                    let [x, y, z] = std::array::from_fn(|axis| self.planes[2 * axis + side].0[i]);
                    Vec4::new(x, y, z, 0.0)
                };
                (self.children[i], Box32::of_corners(corner(0), corner(1)))
            })
    }
}
