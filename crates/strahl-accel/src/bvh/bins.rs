//! The surface area heuristic over bins: where to split a set of boxes, and what that would cost.
//!
//! I. Wald, "On fast construction of SAH-based bounding volume hierarchies" (2007).

use super::refs::{CHUNK, Ref};
use crate::boxes::Box32;
use rayon::prelude::*;
use strahl_math::{Mat4, Vec4};

/// Most bins per axis.
pub(crate) const BINS: usize = 32;
/// Adding this to a number of up to a few millions rounds it to an integer, which is in the last bits of the sum.
const ROUND: f32 = 12_582_912.0;

/// A split: primitives in the bins of an axis up to `last_left` go to the left.
pub(crate) struct Plane {
    axis: usize,
    lo: f32,
    scale: f32,
    last_left: usize,
    /// Half area times number of blocks of primitives, summed over both sides; in the unit of [`Bins::area`].
    pub(crate) cost: f32,
}

impl Plane {
    #[inline(always)]
    pub(crate) fn is_left(&self, r: &Ref) -> bool {
        let (lo, hi): (&[f32; 4], &[f32; 4]) = r.bounds().corners();
        let center = lo[self.axis] + hi[self.axis];
        // The same computation as in `Binning::place`; centres that are clamped there are on the same side here.
        (center - self.lo) * self.scale - 0.5 + ROUND <= ROUND + self.last_left as f32
    }
}

/// Maps doubled centres to bins.
#[derive(Clone, Copy)]
struct Binning {
    lo: Vec4,
    scale: Vec4,
    last: Vec4,
}

impl Binning {
    /// The number of bins for a set. Small sets get few bins, because sweeping over empty bins is most of the work near the
    /// leaves.
    fn count(refs: usize) -> usize {
        (4 + refs / 4).min(BINS)
    }

    fn new(count: usize, centers: &Box32) -> Self {
        let size = centers.size();
        // A little less, so that the last centre falls into the last bin. Centres in one plane all fall into the first bin.
        let scale = (Vec4::splat(count as f32 * 0.9999) / size).min(Vec4::splat(f32::MAX));
        Self {
            lo: centers.lo(),
            scale: Vec4::select(size.cmpgt(Vec4::ZERO), scale, Vec4::ZERO).with_w(0.0),
            last: Vec4::splat((count - 1) as f32),
        }
    }

    /// The bin on each axis.
    #[inline(always)]
    fn place(&self, r: &Ref) -> [usize; 3] {
        let at = (r.bounds().center() - self.lo) * self.scale - Vec4::splat(0.5);
        let at = at.max(Vec4::ZERO).min(self.last) + Vec4::splat(ROUND);
        let [x, y, z, _] = at.to_array();
        // They are in range; the remainder proves it to the compiler.
        [
            x.to_bits() as usize % BINS,
            y.to_bits() as usize % BINS,
            z.to_bits() as usize % BINS,
        ]
    }
}

/// Contents of each bin of each axis. Made once and used for many sets.
pub(crate) struct Bins {
    boxes: [[Box32; 3]; BINS],
    counts: [[u32; 4]; BINS],
    /// Costs of the primitives from a bin on, per axis.
    right_costs: [Vec4; BINS],
    binning: Binning,
    /// Number of bins in use.
    used: usize,
    /// Unit of areas, so that none overflows.
    unit: f32,
}

impl Default for Bins {
    fn default() -> Self {
        Self {
            boxes: [[Box32::EMPTY; 3]; BINS],
            counts: [[0; 4]; BINS],
            right_costs: [Vec4::ZERO; BINS],
            binning: Binning::new(1, &Box32::EMPTY),
            used: 0,
            unit: 1.0,
        }
    }
}

impl Bins {
    /// Sorts a set into bins; its boxes span `bounds`, its doubled centres `centers`. For large sets it also returns the
    /// contents of the bins for each chunk.
    pub(crate) fn fill(&mut self, refs: &[Ref], bounds: &Box32, centers: &Box32) -> Vec<Self> {
        self.used = Binning::count(refs.len());
        self.binning = Binning::new(self.used, centers);
        self.unit = bounds.unit();
        self.clear();
        if refs.len() <= CHUNK {
            self.add(refs);
            return vec![];
        }
        let (binning, used) = (self.binning, self.used);
        let chunks = refs.par_chunks(CHUNK).map(|chunk| {
            let mut bins = Self {
                binning,
                used,
                ..Self::default()
            };
            bins.add(chunk);
            bins
        });
        let chunks: Vec<Self> = chunks.collect();
        for chunk in &chunks {
            self.merge(chunk);
        }
        chunks
    }

    fn clear(&mut self) {
        for bin in 0..self.used.min(BINS) {
            self.boxes[bin] = [Box32::EMPTY; 3];
            self.counts[bin] = [0; 4];
        }
    }

    fn add(&mut self, refs: &[Ref]) {
        let binning = self.binning;
        for r in refs {
            let [x, y, z] = binning.place(r);
            self.boxes[x][0].grow(r.bounds());
            self.boxes[y][1].grow(r.bounds());
            self.boxes[z][2].grow(r.bounds());
            self.counts[x][0] += 1;
            self.counts[y][1] += 1;
            self.counts[z][2] += 1;
        }
    }

    fn merge(&mut self, other: &Self) {
        for bin in 0..self.used.min(BINS) {
            for axis in 0..3 {
                self.boxes[bin][axis].grow(&other.boxes[bin][axis]);
                self.counts[bin][axis] += other.counts[bin][axis];
            }
        }
    }

    /// Half the surface area of a box in the unit of the costs.
    pub(crate) fn area(&self, bounds: &Box32) -> f32 {
        areas(&[*bounds; 3], self.unit).x
    }

    /// The cheapest way to split the set, with blocks of `2^block_log` primitives; `None` if no plane separates any two of them.
    pub(crate) fn cheapest(&mut self, block_log: u32) -> Option<Plane> {
        let used = self.used.min(BINS);
        let counts = &self.counts[..used];
        let model = (self.unit, block_log);
        let cut = cheapest(
            &self.boxes[..used],
            [counts; 2],
            &mut self.right_costs,
            model,
        )?;
        Some(Plane {
            axis: cut.axis,
            lo: self.binning.lo[cut.axis],
            scale: self.binning.scale[cut.axis],
            last_left: cut.last_left,
            cost: cut.cost,
        })
    }

    /// The bounds of the boxes on both sides of a plane.
    pub(crate) fn bounds(&self, plane: &Plane) -> [Box32; 2] {
        let used = self.used.min(BINS);
        let span = |bins: &[[Box32; 3]]| {
            let mut span = Box32::EMPTY;
            for bin in bins {
                span.grow(&bin[plane.axis]);
            }
            span
        };
        let (left, right) = self.boxes[..used].split_at(plane.last_left + 1);
        [span(left), span(right)]
    }

    /// The number of primitives on the left side of a plane.
    pub(crate) fn left_count(&self, plane: &Plane) -> usize {
        let left = &self.counts[..=plane.last_left];
        left.iter().map(|n| n[plane.axis] as usize).sum()
    }
}

/// A split between two bins of an axis.
pub(crate) struct Cut {
    pub(crate) axis: usize,
    /// The last bin on the left side.
    pub(crate) last_left: usize,
    /// Half area times number of blocks of primitives, summed over both sides.
    pub(crate) cost: f32,
}

/// The cheapest split between bins, per axis, given their boxes and the numbers of primitives that count if the bin is on the
/// left or on the right side. `model` is the unit of areas and the logarithm of the size of blocks. `None` if every split
/// leaves one side empty.
#[inline]
pub(crate) fn cheapest(
    boxes: &[[Box32; 3]],
    [left_counts, right_counts]: [&[[u32; 4]]; 2],
    right_costs: &mut [Vec4; BINS],
    (unit, block_log): (f32, u32),
) -> Option<Cut> {
    // Sweep from the right for the costs of all right sides, then from the left for the sums; all axes at once.
    let bins = boxes.len().min(BINS);
    let mut side = Side::EMPTY;
    for bin in (1..bins).rev() {
        side.grow(&boxes[bin], &right_counts[bin]);
        right_costs[bin] = side.costs(unit, block_log);
    }
    let mut side = Side::EMPTY;
    let mut best = Vec4::INFINITY;
    let mut last_left = Vec4::ZERO;
    for bin in 0..bins.saturating_sub(1) {
        side.grow(&boxes[bin], &left_counts[bin]);
        let cost = side.costs(unit, block_log) + right_costs[bin + 1];
        let better = cost.cmplt(best);
        best = Vec4::select(better, cost, best);
        last_left = Vec4::select(better, Vec4::splat(bin as f32), last_left);
    }
    // Of equal ones the first, so that the choice is unique.
    let axis = (0..3).reduce(|a, b| if best[b] < best[a] { b } else { a })?;
    (best[axis] < f32::INFINITY).then(|| Cut {
        axis,
        last_left: last_left[axis] as usize,
        cost: best[axis],
    })
}

/// One side of a plane, for each of the axes.
struct Side {
    boxes: [Box32; 3],
    counts: [u32; 4],
}

impl Side {
    const EMPTY: Self = Self {
        boxes: [Box32::EMPTY; 3],
        counts: [0; 4],
    };

    #[inline(always)]
    fn grow(&mut self, boxes: &[Box32; 3], counts: &[u32; 4]) {
        for (own, other) in self.boxes.iter_mut().zip(boxes) {
            own.grow(other);
        }
        for (own, other) in self.counts.iter_mut().zip(counts) {
            *own += other;
        }
    }

    /// Half area times number of blocks; infinite if this side is empty.
    #[inline(always)]
    fn costs(&self, unit: f32, block_log: u32) -> Vec4 {
        let mut blocks = [0.0; 4];
        for (blocks, count) in blocks.iter_mut().zip(self.counts) {
            *blocks = ((count + (1 << block_log) - 1) >> block_log) as i32 as f32;
        }
        let blocks = Vec4::from_array(blocks);
        let costs = areas(&self.boxes, unit) * blocks;
        Vec4::select(blocks.cmpgt(Vec4::ZERO), costs, Vec4::INFINITY)
    }
}

/// Half the surface areas of three boxes; 0 for empty ones.
#[inline(always)]
fn areas(boxes: &[Box32; 3], unit: f32) -> Vec4 {
    let size = |b: &Box32| b.size().max(Vec4::ZERO);
    let [a, b, c] = [size(&boxes[0]), size(&boxes[1]), size(&boxes[2])];
    let sizes = Mat4::from_cols(a, b, c, Vec4::ZERO).transpose();
    let [x, y, z] = [sizes.x_axis, sizes.y_axis, sizes.z_axis];
    let unit = Vec4::splat(unit);
    let (x, y, z) = (x * unit, y * unit, z * unit);
    x * y + z * (x + y)
}
