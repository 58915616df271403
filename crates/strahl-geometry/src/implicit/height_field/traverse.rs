//! Traverses the pyramid of extremes with a ray: the blocks that the ray may meet, front to back.

use super::grid::{Cell, Grid, SCALE};
use arrayvec::ArrayVec;
use std::ops::ControlFlow;
use strahl_math::{DVec3, Interval, Ray};
use strahl_simd::{Isa, Simd, dispatch};

/// How far the boxes of blocks are widened, in units of the largest coordinate involved times the unit of f64. It covers the
/// error of the triangle test (six roundings of numbers of that size) and that of the box test (four), with a margin; a box
/// that is too large only costs time.
const PAD: f64 = 32.0 * f64::EPSILON;

/// Components of directions below this part of the largest one are taken as this large: the ray moves by less than `PAD` while it
/// passes the field, and no division by zero can occur.
const SLANT: f64 = 1.0 / (1u64 << 60) as f64;

/// A block of `2^level` by `2^level` cells, or a cell, above which the ray is in a part of its parameters.
#[derive(Clone, Copy)]
struct Block {
    level: u32,
    place: (u32, u32),
    part: (f64, f64),
}

/// A ray on its way through the field.
pub(super) struct Descent<'a> {
    grid: &'a Grid,
    /// Lower heights are ignored.
    floor: f64,
    direction: DVec3,
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
            direction: ray.direction,
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
            Some(part) => {
                let block = self.block_below(part);
                dispatch!(Simd::best(), isa => self.descend(isa, block, &mut visit))
            }
            None => ControlFlow::Continue(()),
        }
    }

    /// The smallest block with all cells above which the ray is in a part of its parameters. A ray that is steep where it passes the heights is above
    /// few of them, and need not go down from the block of all cells.
    fn block_below(&self, part: (f64, f64)) -> Block {
        let (enter, exit) = part;
        let (columns, rows) = self.grid.cells();
        let cells = |axis: usize, count: u32| {
            let (from, to) = (enter * self.direction[axis], exit * self.direction[axis]);
            let (first, last) = if from < to { (from, to) } else { (to, from) };
            let (first, last) = (self.upper[axis] + first, self.lower[axis] + last);
            if first.is_nan() || last.is_nan() {
                // The ray comes from where numbers end.
                return (0, count - 1);
            }
            // The cast rounds down; what is beyond the edge becomes the first or the last cell.
            let cell = |x: f64| ((x * f64::from(count)) as u32).min(count - 1);
            (cell(first), cell(last))
        };
        let ((i, i_last), (j, j_last)) = (cells(0, columns), cells(2, rows));
        let level = u32::BITS - ((i ^ i_last) | (j ^ j_last)).leading_zeros();
        Block {
            level,
            place: (i >> level, j >> level),
            part,
        }
    }

    /// Visits the cells of a block.
    #[inline(always)]
    fn descend<I: Isa>(
        &mut self,
        isa: I,
        block: Block,
        visit: &mut impl FnMut(&mut Interval, &Cell) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let grid = self.grid;
        let (columns, rows) = grid.cells();
        let (x, z) = self.first;
        let (floor, below, above) = (
            isa.splat(self.floor),
            isa.splat(self.lower.y),
            isa.splat(self.upper.y),
        );
        let inverse = isa.splat(self.inverse.y);
        let start = isa.splat(self.range.min);
        // Of each block on the way down at most three quarters wait.
        let mut waiting = ArrayVec::<Block, 96>::new();
        let mut next = Some(block);
        while let Some(block) = next.or_else(|| waiting.pop()) {
            next = None;
            let (enter, exit) = block.part;
            if enter > self.range.max {
                continue;
            }
            let (i, j) = block.place;
            let Some(level) = block.level.checked_sub(1) else {
                visit(&mut self.range, &grid.cell(i, j))?;
                continue;
            };
            let middle = |k: u32, step: f64| f64::from((2 * k + 1) << level) * step;
            let at_x = self.plane(0, middle(i, self.step.0));
            let at_z = self.plane(2, middle(j, self.step.1));
            // The ray is in the first half until the plane in the middle, in the second one from there.
            let halves = |(from, until): (f64, f64), second: u32| {
                let (first, last) = ((enter, earlier(exit, until)), (later(enter, from), exit));
                match second {
                    0 => [first, last],
                    _ => [last, first],
                }
            };
            let ([xa, xb], [za, zb]) = (halves(at_x, x), halves(at_z, z));
            let four = grid.quarters(block.level, i, j);
            let (low, high) = (isa.load_wide(&four.low), isa.load_wide(&four.high));
            let is_high = isa.le(floor, high);
            let a = isa.mul(isa.sub(isa.max(low, floor), below), inverse);
            let b = isa.mul(isa.sub(high, above), inverse);
            let enters = isa.max(
                isa.load(&[xa.0, xb.0, xa.0, xb.0]),
                isa.load(&[za.0, za.0, zb.0, zb.0]),
            );
            let exits = isa.min(
                isa.load(&[xa.1, xb.1, xa.1, xb.1]),
                isa.load(&[za.1, za.1, zb.1, zb.1]),
            );
            let enters = isa.max(isa.max(start, enters), isa.min(a, b));
            let end = isa.splat(self.range.max);
            let exits = isa.min(isa.min(end, exits), isa.max(a, b));
            let met = isa.le(enters, exits) & is_high;
            if met == 0 {
                continue;
            }
            let (enters, exits) = (isa.store(enters), isa.store(exits));
            // The last one first: the first one is next, the others wait.
            let mut ordered = in_order(met, x, z);
            while ordered != 0 {
                let order = ordered.ilog2();
                ordered ^= 1 << order;
                let quarter = order ^ (x | z << 1);
                let place = (2 * i + (quarter & 1), 2 * j + (quarter >> 1));
                if place.0 << level >= columns || place.1 << level >= rows {
                    continue;
                }
                if let Some(earlier) = next {
                    waiting.push(earlier);
                }
                next = Some(Block {
                    level,
                    place,
                    part: (enters[quarter as usize], exits[quarter as usize]),
                });
            }
        }
        ControlFlow::Continue(())
    }

    /// The parameters between which the ray meets a plane at right angles to an axis, with the pad on both sides of it.
    #[inline(always)]
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
#[inline(always)]
fn later(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// The smaller of two parameters; the first one if the second is NaN.
#[inline(always)]
fn earlier(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The bits of four quarters in the order in which a ray meets them; `x` and `z` are the sides where it begins.
#[inline(always)]
fn in_order(quarters: u32, x: u32, z: u32) -> u32 {
    let by_x = match x {
        0 => quarters,
        _ => (quarters & 0b0101) << 1 | (quarters & 0b1010) >> 1,
    };
    match z {
        0 => by_x,
        _ => (by_x & 0b0011) << 2 | by_x >> 2,
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn quarters_are_sorted_by_the_sides_where_the_ray_begins() {
        for quarters in 0..16 {
            for (x, z) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let sorted = super::in_order(quarters, x, z);
                assert!((0..4).all(|k| sorted >> k & 1 == quarters >> (k ^ (x | z << 1)) & 1));
            }
        }
    }
}
