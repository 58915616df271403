//! What builders of hierarchies have in common: sets of primitives, and where to split them by the surface area heuristic.

use super::MAX_DEPTH;
use super::bins::Plane;
use crate::boxes::Box32;

/// A primitive while a hierarchy is built.
#[derive(Clone, Copy)]
pub(crate) struct Ref {
    pub(crate) bounds: Box32,
    pub(crate) id: u32,
    /// Leaves hold primitives of one class only.
    pub(crate) class: u8,
}

/// What leaves look like and cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LeafModel {
    /// No leaf holds more primitives, at least 1.
    pub(crate) max_size: usize,
    /// What a visit of a block of primitives costs, in units of a visit of a node.
    pub(crate) block_cost: f64,
    /// Logarithm of the number of primitives in a block, for classes other than 0.
    pub(crate) block_log: u32,
}

impl LeafModel {
    /// The logarithm of the size of blocks in sets of these classes.
    fn block_log(&self, classes: u8) -> u32 {
        if classes & 1 == 0 { self.block_log } else { 0 }
    }
}

/// How many blocks hold `n` primitives.
#[inline(always)]
pub(super) fn blocks(n: usize, log: u32) -> usize {
    (n + (1 << log) - 1) >> log
}

/// The extent of a set: what its primitives' boxes span, and what their (doubled) centres span.
pub(crate) struct Extent {
    pub(crate) bounds: Box32,
    centers: Box32,
    /// The classes in it, as bits.
    pub(crate) classes: u8,
}

impl Extent {
    const EMPTY: Self = Self {
        bounds: Box32::EMPTY,
        centers: Box32::EMPTY,
        classes: 0,
    };

    pub(crate) fn of(refs: &[Ref]) -> Self {
        let mut extent = Self::EMPTY;
        for r in refs {
            extent.grow(r);
        }
        extent
    }

    #[inline(always)]
    fn grow(&mut self, r: &Ref) {
        self.bounds.grow(&r.bounds);
        self.centers.grow_to(r.bounds.center());
        self.classes |= 1 << r.class;
    }
}

/// A set after its primitives were ordered so that the left child's come first.
pub(crate) struct Split {
    pub(crate) middle: usize,
    pub(crate) left: Extent,
    pub(crate) right: Extent,
}

impl Split {
    /// Splits a set, or decides (`None`) that it is a leaf.
    pub(crate) fn choose(
        refs: &mut [Ref],
        extent: &Extent,
        depth: usize,
        leaf: &LeafModel,
    ) -> Option<Self> {
        if refs.len() == 1 {
            return None;
        }
        let fits = refs.len() <= leaf.max_size && extent.classes.is_power_of_two();
        let log = leaf.block_log(extent.classes);
        // From here on halving takes this many levels of nodes. It takes over while there are still that many.
        let needed = (refs.len() - 1).ilog2() as usize + 1;
        if depth + needed >= MAX_DEPTH - 1 {
            return (!fits).then(|| Self::without_plane(refs, extent));
        }
        let area = extent.bounds.half_area();
        let leaf_cost = leaf.block_cost * blocks(refs.len(), log) as f64 * area;
        let Some(plane) = Plane::cheapest(refs, &extent.centers, log) else {
            // All centres in one point: nothing to choose by. Crossed bars are better apart all the same.
            let halves = Self::without_plane(refs, extent);
            let cost = halves.cost(refs.len(), log);
            return (!fits || leaf_cost > area + leaf.block_cost * cost).then_some(halves);
        };
        if fits && leaf_cost <= area + leaf.block_cost * plane.cost {
            return None;
        }
        Some(Self::at(&plane, refs))
    }

    /// By class while there is more than one, then in the middle of the list.
    fn without_plane(refs: &mut [Ref], extent: &Extent) -> Self {
        let mut middle = refs.len() / 2;
        if !extent.classes.is_power_of_two() {
            let lowest = extent.classes.trailing_zeros() as u8;
            refs.sort_unstable_by_key(|r| (r.class, r.id));
            middle = refs.partition_point(|r| r.class == lowest);
        }
        Self {
            middle,
            left: Extent::of(&refs[..middle]),
            right: Extent::of(&refs[middle..]),
        }
    }

    /// Half area times number of blocks of primitives, summed over both sides.
    fn cost(&self, all: usize, log: u32) -> f64 {
        let side = |extent: &Extent, n| extent.bounds.half_area() * blocks(n, log) as f64;
        side(&self.left, self.middle) + side(&self.right, all - self.middle)
    }

    /// Exchanges primitives that are on the wrong side, from both ends: one thread does it, so the order is always the same.
    fn at(plane: &Plane, refs: &mut [Ref]) -> Self {
        let (mut left, mut right) = (Extent::EMPTY, Extent::EMPTY);
        let (mut middle, mut end) = (0, refs.len());
        while middle < end {
            let r = refs[middle];
            if plane.is_left(&r) {
                left.grow(&r);
                middle += 1;
            } else {
                right.grow(&r);
                end -= 1;
                refs.swap(middle, end);
            }
        }
        Self {
            middle,
            left,
            right,
        }
    }
}
