//! The surface area heuristic over bins: where to split a set of boxes, and what that would cost.
//!
//! I. Wald, "On fast construction of SAH-based bounding volume hierarchies" (2007).

use super::split::{Ref, blocks};
use crate::boxes::Box32;
use rayon::prelude::*;
use strahl_math::Vec4;

/// Most bins per axis.
const BINS: usize = 32;
/// Sets larger than this are sorted into bins in parallel, in chunks of this size.
const CHUNK: usize = 16 * 1024;

/// A way to split: what falls into the bins up to one of an axis goes left.
pub(super) struct Plane {
    binning: Binning,
    axis: usize,
    last_left: usize,
    /// Half area times number of blocks of primitives, summed over both sides.
    pub(super) cost: f64,
}

impl Plane {
    #[inline(always)]
    pub(super) fn is_left(&self, r: &Ref) -> bool {
        self.binning.bins_of(r)[self.axis] <= self.last_left
    }

    /// The cheapest way to split a set whose doubled centres span `centers`, with blocks of `2^block_log` primitives; `None`
    /// if no plane separates any two of them.
    pub(super) fn cheapest(refs: &[Ref], centers: &Box32, block_log: u32) -> Option<Self> {
        let binning = Binning::new(refs.len(), centers);
        let bins = if refs.len() > CHUNK {
            // Minima, maxima and integer sums: exact in any grouping, so the threads leave no trace.
            refs.par_chunks(CHUNK)
                .map(|chunk| binning.fill(chunk))
                .reduce_with(Bins::merged)?
        } else {
            binning.fill(refs)
        };
        (0..3)
            .filter_map(|axis| bins.cheapest(axis, binning.count, block_log))
            // Of equal ones the first, so that the choice is unique.
            .reduce(|a, b| if b.0 < a.0 { b } else { a })
            .map(|(cost, axis, last_left)| Self {
                binning,
                axis,
                last_left,
                cost,
            })
    }
}

/// How doubled centres fall into bins.
struct Binning {
    lo: Vec4,
    scale: Vec4,
    count: usize,
}

impl Binning {
    fn new(refs: usize, centers: &Box32) -> Self {
        // Few primitives need few bins: sweeping over empty ones is most of the work near the leaves.
        let count = (4 + refs / 2).min(BINS);
        // An axis without extent gets an infinite or huge scale; its products are NaN or 0 and all end in bin 0.
        Self {
            lo: centers.lo(),
            scale: Vec4::splat(count as f32) / centers.size(),
            count,
        }
    }

    /// The bin on each axis. Casts saturate and take NaN to 0.
    #[inline(always)]
    fn bins_of(&self, r: &Ref) -> [usize; 3] {
        let at = (r.bounds.center() - self.lo) * self.scale;
        [at.x, at.y, at.z].map(|x| (x as u32 as usize).min(self.count - 1))
    }

    fn fill(&self, refs: &[Ref]) -> Bins {
        let mut bins = Bins::default();
        for r in refs {
            for (axis, bin) in self.bins_of(r).into_iter().enumerate() {
                bins.boxes[axis][bin].grow(&r.bounds);
                bins.counts[axis][bin] += 1;
            }
        }
        bins
    }
}

/// What fell into each bin of each axis.
struct Bins {
    boxes: [[Box32; BINS]; 3],
    counts: [[usize; BINS]; 3],
}

impl Default for Bins {
    fn default() -> Self {
        Self {
            boxes: [[Box32::EMPTY; BINS]; 3],
            counts: [[0; BINS]; 3],
        }
    }
}

impl Bins {
    fn merged(mut self, other: Self) -> Self {
        for axis in 0..3 {
            for bin in 0..BINS {
                self.boxes[axis][bin].grow(&other.boxes[axis][bin]);
                self.counts[axis][bin] += other.counts[axis][bin];
            }
        }
        self
    }

    /// The cost, the axis and the last bin of the left side of an axis's cheapest plane.
    fn cheapest(&self, axis: usize, bins: usize, log: u32) -> Option<(f64, usize, usize)> {
        let (boxes, counts) = (&self.boxes[axis][..bins], &self.counts[axis][..bins]);
        // Sweep from the right for the costs of all right sides, then from the left for the sums.
        let mut right_costs = [0.0; BINS];
        let (mut right, mut right_count) = (Box32::EMPTY, 0);
        for bin in (1..bins).rev() {
            right.grow(&boxes[bin]);
            right_count += counts[bin];
            if right_count > 0 {
                right_costs[bin - 1] = right.half_area() * blocks(right_count, log) as f64;
            }
        }
        let total = right_count + counts[0];
        let mut best: Option<(f64, usize, usize)> = None;
        let (mut left, mut left_count) = (Box32::EMPTY, 0);
        for bin in 0..bins - 1 {
            if counts[bin] == 0 {
                continue;
            }
            left.grow(&boxes[bin]);
            left_count += counts[bin];
            if left_count == total {
                break;
            }
            let cost = left.half_area() * blocks(left_count, log) as f64 + right_costs[bin];
            if best.is_none_or(|b| cost < b.0) {
                best = Some((cost, axis, bin));
            }
        }
        best
    }
}
