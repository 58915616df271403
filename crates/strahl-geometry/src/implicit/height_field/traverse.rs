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
        // The whole field, or more: a block may reach beyond the field's edge, which costs time only.
        let (dx, dz) = self.step;
        let (width, depth) = (f64::from(1u32 << top) * dx, f64::from(1u32 << top) * dz);
        let along_x = self.slab(0, 0.0, width);
        let along_z = self.slab(2, 0.0, depth);
        let part = (later(along_x.0, along_z.0), earlier(along_x.1, along_z.1));
        match self.over(part, self.grid.full_range()) {
            Some(part) => self.descend(top, (0, 0), part, &mut visit),
            None => ControlFlow::Continue(()),
        }
    }

    /// Visits the cells of a block above which the ray is in `part` of its parameters. The recursion is as deep as the pyramid, 31
    /// levels at most.
    fn descend(
        &mut self,
        level: usize,
        (i, j): (u32, u32),
        (enter, exit): (f64, f64),
        visit: &mut impl FnMut(&mut Interval, &Cell) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let Some(below) = level.checked_sub(1) else {
            return visit(&mut self.range, &self.grid.cell(i, j));
        };
        let (columns, rows) = self.grid.cells();
        let middle = |k: u32, step: f64| f64::from((2 * k + 1) << below) * step;
        let at_x = self.plane(0, middle(i, self.step.0));
        let at_z = self.plane(2, middle(j, self.step.1));
        // In the first half until the plane in the middle, in the second one from there.
        let halves =
            |(from, until): (f64, f64)| [(enter, earlier(exit, until)), (later(enter, from), exit)];
        let (along_x, along_z) = (halves(at_x), halves(at_z));
        let (x, z) = self.first;
        for (a, b) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let (i, j) = (2 * i + (x ^ a), 2 * j + (z ^ b));
            if i << below >= columns || j << below >= rows {
                continue;
            }
            let (along_x, along_z) = (along_x[a as usize], along_z[b as usize]);
            let part = (later(along_x.0, along_z.0), earlier(along_x.1, along_z.1));
            if part.0 <= part.1
                && let Some(part) = self.over(part, self.grid.range(below, i, j))
            {
                self.descend(below, (i, j), part, visit)?;
            }
        }
        ControlFlow::Continue(())
    }

    /// The parameters between which the ray meets a plane at right angles to an axis, with the pad on both sides of it.
    #[inline]
    fn plane(&self, axis: usize, at: f64) -> (f64, f64) {
        let a = (at - self.lower[axis]) * self.inverse[axis];
        let b = (at - self.upper[axis]) * self.inverse[axis];
        if a < b { (a, b) } else { (b, a) }
    }

    /// The parameters between which the ray is between two such planes.
    #[inline]
    fn slab(&self, axis: usize, low: f64, high: f64) -> (f64, f64) {
        let a = (low - self.lower[axis]) * self.inverse[axis];
        let b = (high - self.upper[axis]) * self.inverse[axis];
        if a < b { (a, b) } else { (b, a) }
    }

    /// The part of the parameters of a block in which the ray is between its lowest and its highest height and within the wanted range;
    /// `None` if there is none.
    #[inline]
    fn over(&self, (enter, exit): (f64, f64), [low, high]: [u16; 2]) -> Option<(f64, f64)> {
        let (low, high) = (f64::from(low) / SCALE, f64::from(high) / SCALE);
        if high < self.floor {
            return None;
        }
        let low = if low < self.floor { self.floor } else { low };
        let along_y = self.slab(1, low, high);
        let enter = later(later(self.range.min, enter), along_y.0);
        let exit = earlier(earlier(self.range.max, exit), along_y.1);
        (enter <= exit).then_some((enter, exit))
    }
}

/// The larger of two parameters; the first one if the second is NaN.
#[inline]
fn later(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// The smaller of two parameters; the first one if the second is NaN.
#[inline]
fn earlier(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}
