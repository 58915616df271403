//! Traverses the pyramid of extremes with a ray: the blocks that the ray may meet, front to back.

use super::grid::{Cell, Grid, SCALE};
use std::ops::ControlFlow;
use strahl_math::{DVec3, Interval, Ray};

/// How far the boxes of blocks are widened, in units of the largest coordinate involved times the unit of f64. It covers the
/// error of the triangle test (six roundings of numbers of that size) and that of the box test (four), with a margin; a box
/// that is too large only costs time.
const PAD: f64 = 32.0 * f64::EPSILON;

/// Components of directions below this part of the largest one are taken as this large: the ray moves by less than `PAD` while it
/// passes the field, and no division by zero can occur.
const SLANT: f64 = 1.0 / (1u64 << 60) as f64;

/// A ray on its way through the field.
pub(super) struct Descent<'a> {
    grid: &'a Grid,
    /// Lower heights are ignored.
    floor: f64,
    /// Reciprocal direction.
    inverse: DVec3,
    /// Origin, plus and minus the pad, for the lower and upper faces of boxes.
    lower: DVec3,
    upper: DVec3,
    /// The size of a cell.
    step: (f64, f64),
    /// Which neighbour in x and in z comes first: 0 the lower, 1 the higher.
    first: (u32, u32),
    /// The range; its upper end may become smaller during the traversal.
    pub(super) range: Interval,
}

impl<'a> Descent<'a> {
    /// `None` for rays without a direction, or with NaN or infinite coordinates.
    pub(super) fn new(grid: &'a Grid, floor: f64, ray: &Ray, range: Interval) -> Option<Self> {
        let size = ray.direction.abs().max_element();
        if !(size > 0.0 && ray.direction.is_finite() && ray.origin.is_finite()) {
            return None;
        }
        let d = ray.direction.to_array().map(|d| {
            let least = size * SLANT;
            if d.abs() >= least {
                d
            } else if d < 0.0 {
                -least
            } else {
                least
            }
        });
        let pad = DVec3::splat((ray.origin.abs().max_element() + 2.0) * PAD);
        let (columns, rows) = grid.cells();
        Some(Self {
            grid,
            floor,
            inverse: DVec3::from_array(d.map(|d| 1.0 / d)),
            lower: ray.origin + pad,
            upper: ray.origin - pad,
            step: (1.0 / f64::from(columns), 1.0 / f64::from(rows)),
            first: (u32::from(d[0] < 0.0), u32::from(d[2] < 0.0)),
            range,
        })
    }

    /// Passes all cells that the ray may meet to the visitor, front to back as far as possible, until it stops.
    pub(super) fn run(
        &mut self,
        mut visit: impl FnMut(&mut Interval, &Cell) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let top = self.grid.top();
        if !self.meets(top, 0, 0, self.grid.full_range()) {
            return ControlFlow::Continue(());
        }
        self.descend(top, 0, 0, &mut visit)
    }

    /// The recursion is as deep as the pyramid, 31 levels at most.
    fn descend(
        &mut self,
        level: usize,
        i: u32,
        j: u32,
        visit: &mut impl FnMut(&mut Interval, &Cell) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let Some(below) = level.checked_sub(1) else {
            return visit(&mut self.range, &self.grid.cell(i, j));
        };
        let (columns, rows) = self.grid.cells();
        let (x, z) = self.first;
        for (a, b) in [(x, z), (x ^ 1, z), (x, z ^ 1), (x ^ 1, z ^ 1)] {
            let (i, j) = (2 * i + a, 2 * j + b);
            if i << below >= columns || j << below >= rows {
                continue;
            }
            if self.meets(below, i, j, self.grid.range(below, i, j)) {
                self.descend(below, i, j, visit)?;
            }
        }
        ControlFlow::Continue(())
    }

    /// Whether the ray meets the box of a block within the wanted range.
    #[inline]
    fn meets(&self, level: usize, i: u32, j: u32, [low, high]: [u16; 2]) -> bool {
        let (low, high) = (f64::from(low) / SCALE, f64::from(high) / SCALE);
        if high < self.floor {
            return false;
        }
        let low = if low < self.floor { self.floor } else { low };
        let from = |k: u32, step: f64| f64::from(k << level) * step;
        // A block may reach beyond the field's edge; that costs time only.
        let to = |k: u32, step: f64| f64::from((k + 1) << level) * step;
        let (dx, dz) = self.step;
        let lower = (DVec3::new(from(i, dx), low, from(j, dz)) - self.lower) * self.inverse;
        let upper = (DVec3::new(to(i, dx), high, to(j, dz)) - self.upper) * self.inverse;
        let (mut near, mut far) = (self.range.min, self.range.max);
        for k in 0..3 {
            let (a, b) = if lower[k] < upper[k] {
                (lower[k], upper[k])
            } else {
                (upper[k], lower[k])
            };
            near = if a > near { a } else { near };
            far = if b < far { b } else { far };
        }
        near <= far
    }
}
