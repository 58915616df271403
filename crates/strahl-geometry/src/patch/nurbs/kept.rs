//! Which rectangle of each patch the loops leave at most.

use super::data::Patches;
use super::part::{Part, Rectangle, WHOLE};
use super::trim::{Region, Weighted, split};
use std::ops::Range;
use strahl_math::DVec2;
use strahl_math::error::gamma;

/// Boxes of curves are so much larger than the curves, in parts of all parameters: far more than their rounding errors.
const MARGIN: f64 = 1e-9;
/// A rectangle reaches so much further than what is kept, in parts of its patch: rays find points a little beyond.
const BEYOND: f64 = 1.0 / (1_u32 << 19) as f64;
/// Curves are halved until they are this part of a patch, or within one.
const SHORT: f64 = 1.0 / 16.0;
/// They are halved so often at most.
const HALVINGS: u32 = 10;
/// So many pieces of curves in patches are looked at; where there are more, all patches stay whole.
const MOST: usize = 1 << 22;

/// Finds what the loops leave of the patches through which they run: of all patches of a surface, row after row.
pub(super) fn shrink(patches: &mut Patches, region: &Region) {
    let mut cover = Cover {
        breaks: &patches.breaks,
        boxes: vec![None; patches.parts.len()],
        left: MOST,
    };
    for arc in region.arcs() {
        let weighted: Vec<Weighted> = arc.iter().map(|[x, y, w]| [x * w, y * w, *w]).collect();
        if cover.add(&weighted, HALVINGS).is_none() {
            return;
        }
    }
    for (part, around) in patches.parts.iter_mut().zip(cover.boxes) {
        if part.is_trimmed {
            part.kept = kept(part, around, region);
        }
    }
}

/// A box in the plane of the parameters.
type Box2 = [DVec2; 2];

/// The boxes of all that curves have in each patch.
struct Cover<'a> {
    breaks: &'a [Vec<f64>; 2],
    boxes: Vec<Option<Box2>>,
    /// How many pieces may still be looked at.
    left: usize,
}

impl Cover<'_> {
    /// Adds a piece of a curve; `None` if there are too many.
    fn add(&mut self, curve: &[Weighted], halvings: u32) -> Option<()> {
        let [low, high] = bounds(curve);
        let [columns, rows] = [0, 1].map(|k| self.cells(k, low[k], high[k]));
        if columns.is_empty() || rows.is_empty() {
            return Some(());
        }
        self.left = self.left.checked_sub(columns.len() * rows.len())?;
        let is_small = |k: usize, cells: &Range<usize>| {
            let [from, to] = [cells.start, cells.start + 1].map(|i| self.breaks[k][i]);
            (low[k] >= from && high[k] <= to) || high[k] - low[k] <= SHORT * (to - from)
        };
        if halvings > 0 && !(is_small(0, &columns) && is_small(1, &rows)) {
            let [first, second] = split(curve);
            self.add(&first, halvings - 1)?;
            return self.add(&second, halvings - 1);
        }
        let across = self.breaks[0].len() - 1;
        for row in rows {
            for own in &mut self.boxes[row * across..][columns.clone()] {
                let [a, b] = own.unwrap_or([low, high]);
                *own = Some([a.min(low), b.max(high)]);
            }
        }
        Some(())
    }

    /// The columns or rows of patches that a range of parameters touches.
    fn cells(&self, axis: usize, low: f64, high: f64) -> Range<usize> {
        let breaks = &self.breaks[axis];
        let from = breaks.partition_point(|b| *b < low).saturating_sub(1);
        let to = breaks.partition_point(|b| *b <= high);
        from..to.min(breaks.len() - 1)
    }
}

/// A box around a curve, from its control points.
fn bounds(curve: &[Weighted]) -> Box2 {
    let points = curve.iter().map(|[x, y, w]| DVec2::new(x / w, y / w));
    let [low, high] = points.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], p| {
        [low.min(p), high.max(p)]
    });
    let noise = MARGIN + low.abs().max(high.abs()).max_element() * gamma(64);
    [low - noise, high + noise]
}

/// What is kept of a part in which the curves have this box, in the parameters of the part.
///
/// Between a side of the part and the box there is no curve, so that all or nothing is kept there.
fn kept(part: &Part, around: Option<Box2>, region: &Region) -> Option<Rectangle> {
    let [from, to] = [part.from, part.to].map(DVec2::from_array);
    let middle = (from + to) * 0.5;
    let Some([low, high]) = around else {
        return region.contains(middle.to_array()).then_some(WHOLE);
    };
    let (low, high) = (low.clamp(from, to), high.clamp(from, to));
    let mut rectangle = WHOLE;
    let mut is_less = false;
    for k in 0..2 {
        for (end, side, curves) in [(0, from[k], low[k]), (1, to[k], high[k])] {
            let mut place = middle;
            place[k] = 0.5 * (side + curves);
            if side != curves && !region.contains(place.to_array()) {
                rectangle[k][end] = (curves - from[k]) / (to[k] - from[k]);
                is_less = true;
            }
        }
    }
    Some(if is_less {
        rectangle.map(|[a, b]| [a - BEYOND, b + BEYOND])
    } else {
        WHOLE
    })
}
