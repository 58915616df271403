//! Splits long thin primitives before the tree is built: the boxes around their parts are much smaller than the box around the
//! whole.
//!
//! T. Karras, T. Aila, "Fast Parallel Construction of High-Quality Bounding Volume Hierarchies" (2013), section 4. Splits are
//! distributed by how much they save, and their planes are those of a grid over the whole scene, coarse planes first, so that
//! parts of neighbouring primitives end at the same planes.

use super::Bvh8;
use crate::Shapes;
use crate::boxes::Box32;
use crate::bvh::refs::CHUNK;
use crate::bvh::refs::{Extent, Ref};
use rayon::prelude::*;

/// Most splits of a primitive.
const MOST_CUTS: u32 = 31;
/// Only primitives are split whose box is this many times as large as the boxes around ever smaller parts: splitting ordinary
/// triangles makes rays slower (flake of 945 k triangles with 30 % more parts: 10 % more nodes and blocks).
const THIN: f64 = 8.0;
/// The grid has up to 2 to this many planes an axis.
const LEVELS: i32 = 20;

/// Splits primitives into at most `share` more parts than there were primitives.
pub(super) fn presplit(shapes: &dyn Shapes, refs: Vec<Ref>, share: f64) -> Vec<Ref> {
    let extent = Extent::of_many(&refs);
    let whole = Grid::new(&extent.bounds);
    let budget = (refs.len() as f64 * share) as usize;
    let budget = budget.min(Bvh8::MAX_PRIMITIVES.saturating_sub(refs.len()));
    let priority = |r: &Ref| whole.priority(shapes, r);
    let priorities: Vec<f32> = if refs.len() <= CHUNK {
        refs.iter().map(priority).collect()
    } else {
        refs.par_iter().map(priority).collect()
    };
    let Some(scale) = scale(&priorities, budget) else {
        return refs;
    };
    let cut = |(refs, priorities): (&[Ref], &[f32])| {
        let mut parts = Vec::with_capacity(refs.len() * 2);
        for (r, priority) in refs.iter().zip(priorities) {
            whole.cut(shapes, *r, cuts(*priority, scale), &mut parts);
        }
        parts
    };
    if refs.len() <= CHUNK {
        return cut((&refs, &priorities));
    }
    let chunks = refs.par_chunks(CHUNK).zip(priorities.par_chunks(CHUNK));
    let parts: Vec<Vec<Ref>> = chunks.map(cut).collect();
    parts.concat()
}

/// The number of splits of a primitive.
fn cuts(priority: f32, scale: f32) -> u32 {
    // Casts saturate.
    ((priority * scale) as u32).min(MOST_CUTS)
}

/// The largest factor found for the priorities that keeps the number of splits within the budget; `None` if there are none.
fn scale(priorities: &[f32], budget: usize) -> Option<f32> {
    let total = |scale: f32| -> usize {
        let cuts = |p: &f32| cuts(*p, scale) as usize;
        if priorities.len() <= CHUNK {
            priorities.iter().map(cuts).sum()
        } else {
            priorities.par_iter().map(cuts).sum()
        }
    };
    let most = priorities.iter().fold(0.0, |a: f32, b| a.max(*b));
    if !(most > 0.0) || budget == 0 {
        return None;
    }
    // The first gives no splits at all, the second too many.
    let (mut low, mut high) = (0.0, MOST_CUTS as f32 / most * 65536.0);
    for _ in 0..24 {
        let middle = 0.5 * (low + high);
        if total(middle) <= budget {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low > 0.0).then_some(low)
}

/// The planes at which primitives are split.
struct Grid {
    lo: [f32; 3],
    size: [f32; 3],
    unit: f32,
}

impl Grid {
    fn new(bounds: &Box32) -> Self {
        let (lo, size) = (bounds.lo().to_array(), bounds.size().to_array());
        let first = |v: [f32; 4]| [v[0], v[1], v[2]];
        Self {
            lo: first(lo),
            size: first(size),
            unit: bounds.unit(),
        }
    }

    /// The coarsest plane through the inside of a box: its axis, its level (1 for the middle of the scene) and where it is.
    fn plane(&self, bounds: &Box32) -> Option<(usize, i32, f32)> {
        let (lo, hi) = bounds.corners();
        let planes = (0..3).filter_map(|axis| {
            let cell = |x: f32| {
                let at = (x - self.lo[axis]) / self.size[axis] * (1 << LEVELS) as f32;
                (at as u32).min((1 << LEVELS) - 1)
            };
            let (a, b) = (cell(lo[axis]), cell(hi[axis]));
            // The highest bit that differs is the level of the plane between.
            let bit = 31 - (a ^ b).leading_zeros() as i32;
            if bit < 0 {
                return None;
            }
            let index = b >> bit << bit;
            let at = self.lo[axis] + self.size[axis] * (index as f32 / (1 << LEVELS) as f32);
            (lo[axis] < at && at < hi[axis]).then_some((axis, LEVELS - bit, at))
        });
        planes.reduce(|a, b| {
            let width = |p: &(usize, i32, f32)| hi[p.0] - lo[p.0];
            if (b.1, -width(&b)) < (a.1, -width(&a)) {
                b
            } else {
                a
            }
        })
    }

    /// The saving from splitting a primitive.
    fn priority(&self, shapes: &dyn Shapes, r: &Ref) -> f32 {
        let area = r.bounds().half_area();
        let thin = shapes
            .flat_area(r.id())
            .is_some_and(|flat| area > THIN * flat);
        if !thin {
            return 0.0;
        }
        match self.plane(r.bounds()) {
            Some((_, level, _)) => {
                let unit = f64::from(self.unit);
                // The area of the parts is negligible.
                (area * unit * unit * 0.5f64.powi(level)).sqrt().sqrt() as f32
            }
            None => 0.0,
        }
    }

    fn cut(&self, shapes: &dyn Shapes, r: Ref, cuts: u32, into: &mut Vec<Ref>) {
        let plane = if cuts == 0 {
            None
        } else {
            self.plane(r.bounds())
        };
        let Some((axis, _, at)) = plane else {
            into.push(r);
            return;
        };
        let parts = r.halves(shapes, axis, at);
        let longest = |b: &Box32| {
            if b.is_empty() {
                0.0
            } else {
                b.size().truncate().max_element()
            }
        };
        let [a, b] = [longest(parts[0].bounds()), longest(parts[1].bounds())];
        let first = ((cuts - 1) as f32 * a / (a + b) + 0.5) as u32;
        let shares = [first.min(cuts - 1), cuts - 1 - first.min(cuts - 1)];
        for (part, share) in parts.into_iter().zip(shares) {
            if !part.bounds().is_empty() {
                self.cut(shapes, part, share, into);
            }
        }
    }
}
