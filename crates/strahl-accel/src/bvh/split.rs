//! Splits sets of primitives by the surface area heuristic, for all top-down builders.

use super::MAX_DEPTH;
use super::bins::{Bins, Plane};
use super::refs::CHUNK;
use super::refs::{Extent, Ref, centers, classes};
use crate::boxes::Box32;
use rayon::prelude::*;

/// The size and cost of leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LeafModel {
    /// Most primitives in a leaf, at least 1.
    pub(crate) max_size: usize,
    /// The cost of the additional node that a split needs: 1, the unit, or 0 if there is a node with free places.
    pub(crate) node_cost: f64,
    /// The cost of visiting a block of primitives, in units of visiting a node.
    pub(crate) block_cost: f64,
    /// Logarithm of the number of primitives in a block, for classes other than 0.
    pub(crate) block_log: u32,
}

impl LeafModel {
    /// The logarithm of the size of blocks in sets of these classes.
    pub(crate) fn block_log(&self, classes: u8) -> u32 {
        if classes & 1 == 0 { self.block_log } else { 0 }
    }

    /// Whether primitives of these classes are a leaf of one block, which is never split.
    pub(crate) fn is_block(&self, count: usize, classes: u8) -> bool {
        classes.is_power_of_two() && blocks(count, self.block_log(classes)) == 1
    }

    /// Whether a leaf of so many blocks in a box of this area costs no more than its halves; `halves` is the sum of their
    /// blocks times their areas.
    pub(crate) fn is_cheaper(&self, blocks: usize, area: f64, halves: f64) -> bool {
        let whole = self.block_cost * blocks as f64 * area;
        whole <= self.node_cost * area + self.block_cost * halves
    }
}

/// How many blocks hold `n` primitives.
#[inline(always)]
pub(crate) fn blocks(n: usize, log: u32) -> usize {
    (n + (1 << log) - 1) >> log
}

/// Primitives that will become a subtree; at least one.
pub(crate) struct Set<'a> {
    pub(crate) refs: &'a mut [Ref],
    /// Space for as many references, to which its halves are moved.
    spare: &'a mut [Ref],
    pub(crate) extent: Extent,
    /// The number of splits on the way from the root.
    depth: usize,
}

impl<'a> Set<'a> {
    /// All primitives, and as many places.
    pub(crate) fn all(refs: &'a mut [Ref], spare: &'a mut [Ref]) -> Self {
        let extent = Extent::of_many(refs);
        Self {
            refs,
            spare,
            extent,
            depth: 0,
        }
    }

    /// Splits it, or returns it as a leaf.
    #[expect(
        clippy::result_large_err,
        reason = "both variants are the same sets on their way into the tree"
    )]
    pub(crate) fn split(self, leaf: &LeafModel, bins: &mut Bins) -> Result<[Self; 2], Self> {
        let (count, classes) = (self.refs.len(), self.extent.classes);
        if leaf.is_block(count, classes) {
            return Err(self);
        }
        let fits = count <= leaf.max_size && classes.is_power_of_two();
        let log = leaf.block_log(classes);
        // The number of levels that halving needs from here on. Halving takes over while there are still that many.
        let needed = (count - 1).ilog2() as usize + 1;
        if self.depth + needed >= MAX_DEPTH - 1 {
            return if fits { Err(self) } else { Ok(self.halved()) };
        }
        let chunks = bins.fill(self.refs, &self.extent.bounds, &self.extent.centers);
        let area = f64::from(bins.area(&self.extent.bounds));
        let Some(plane) = bins.cheapest(log) else {
            // All centres coincide, so no plane separates them. Crossed bars are better apart nevertheless.
            if !fits {
                return Ok(self.halved());
            }
            // In the order of the scene, independent of earlier splits: objects that were made together are usually close
            // together.
            self.refs.sort_unstable_by_key(Ref::id);
            let middle = count / 2;
            let cost = |refs: &[Ref]| {
                let area = bins.area(&Extent::of(refs).bounds);
                f64::from(area) * blocks(refs.len(), log) as f64
            };
            let halves = cost(&self.refs[..middle]) + cost(&self.refs[middle..]);
            let is_leaf = leaf.is_cheaper(blocks(count, log), area, halves);
            return if is_leaf {
                Err(self)
            } else {
                Ok(self.halved())
            };
        };
        if fits && leaf.is_cheaper(blocks(count, log), area, f64::from(plane.cost)) {
            return Err(self);
        }
        Ok(self.at(&plane, bins, &chunks))
    }

    /// Splits it at its [`middle`].
    fn halved(self) -> [Self; 2] {
        let middle = middle(self.refs, &self.extent);
        let (left, right) = self.refs.split_at_mut(middle);
        let (left_spare, right_spare) = self.spare.split_at_mut(middle);
        let half = |refs: &'a mut [Ref], spare| Self {
            extent: Extent::of(refs),
            refs,
            spare,
            depth: self.depth + 1,
        };
        [half(left, left_spare), half(right, right_spare)]
    }

    /// The order within the halves depends on the size of the set alone, not on the number of threads.
    fn at(self, plane: &Plane, bins: &Bins, chunks: &[Bins]) -> [Self; 2] {
        let (middle, centers) = match chunks {
            [] => {
                let middle = part(plane, self.refs, self.spare);
                (
                    middle,
                    [&self.spare[..middle], &self.spare[middle..]].map(centers),
                )
            }
            _ => parts(plane, self.refs, self.spare, chunks),
        };
        let bounds = bins.bounds(plane);
        let (left, right) = self.spare.split_at_mut(middle);
        let (left_spare, right_spare) = self.refs.split_at_mut(middle);
        let half = |refs: &'a mut [Ref], spare, side: usize| {
            let mut extent = Extent {
                bounds: bounds[side],
                centers: centers[side],
                classes: self.extent.classes,
            };
            if !extent.classes.is_power_of_two() {
                extent.classes = classes(refs);
            }
            Self {
                refs,
                spare,
                extent,
                depth: self.depth + 1,
            }
        };
        [half(left, left_spare, 0), half(right, right_spare, 1)]
    }
}

/// The position to cut a list that no plane separates: between classes while there is more than one (the list is sorted by
/// class), then in the middle.
pub(crate) fn middle(refs: &mut [Ref], extent: &Extent) -> usize {
    if extent.classes.is_power_of_two() {
        return refs.len() / 2;
    }
    let lowest = extent.lowest_class();
    refs.sort_unstable_by_key(|r| (r.class(), r.id()));
    refs.partition_point(|r| r.class() == lowest)
}

/// Partitions primitives: those left of a plane first, then the others in reverse order. Returns the number on the left.
#[inline]
pub(crate) fn part(plane: &Plane, refs: &[Ref], to: &mut [Ref]) -> usize {
    let (mut left, mut right) = (0, to.len());
    for r in refs {
        // Without a branch, which would often be mispredicted: the primitive is written to both places, and the next one
        // overwrites the wrong copy.
        to[left] = *r;
        to[right - 1] = *r;
        let is_left = usize::from(plane.is_left(r));
        left += is_left;
        right -= 1 - is_left;
    }
    left
}

/// Partitions the chunks of a large set in parallel. Returns the number on the left, and the bounds of the doubled centres of
/// both sides.
fn parts(plane: &Plane, refs: &[Ref], to: &mut [Ref], chunks: &[Bins]) -> (usize, [Box32; 2]) {
    let counts: Vec<usize> = chunks.iter().map(|bins| bins.left_count(plane)).collect();
    let middle = counts.iter().sum();
    let (mut left, mut right) = to.split_at_mut(middle);
    let mut tasks = Vec::with_capacity(chunks.len());
    for (chunk, count) in refs.chunks(CHUNK).zip(counts) {
        let (to_left, to_right);
        (to_left, left) = left.split_at_mut(count);
        (to_right, right) = right.split_at_mut(chunk.len() - count);
        tasks.push((chunk, to_left, to_right));
    }
    // Minima and maxima are exact in any grouping, so the result does not depend on the threads.
    let centers = tasks.into_par_iter().map(|(chunk, left, right)| {
        const BLOCK: usize = 256;
        let mut buffer = [chunk[0]; BLOCK];
        let (mut l, mut r) = (0, 0);
        let mut spans = [Box32::EMPTY; 2];
        for block in chunk.chunks(BLOCK) {
            let buffer = &mut buffer[..block.len()];
            let middle = part(plane, block, buffer);
            let (a, b) = buffer.split_at(middle);
            spans[0].grow(&centers(a));
            spans[1].grow(&centers(b));
            left[l..l + a.len()].copy_from_slice(a);
            right[r..r + b.len()].copy_from_slice(b);
            l += a.len();
            r += b.len();
        }
        spans
    });
    let centers = centers.reduce(
        || [Box32::EMPTY; 2],
        |mut a, b| {
            a[0].grow(&b[0]);
            a[1].grow(&b[1]);
            a
        },
    );
    (middle, centers)
}
