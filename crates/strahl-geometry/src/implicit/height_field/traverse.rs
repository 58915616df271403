//! Traverses the blocks of a height field with a ray: those that the ray may meet, front to back.
//!
//! Sixteen parts of a block are tested at once, in f32, from the place where the ray enters the field. The boxes around them are widened by more
//! than the rounding of all of it.

use super::grid::{Cell, Grid, SCALE};
use arrayvec::ArrayVec;
use std::ops::ControlFlow;
use strahl_math::{DVec3, Interval, Ray};
use strahl_simd::{Isa, Lanes16, Simd, dispatch};

/// How far the field's box is widened, in units of the largest coordinate involved times the unit of f64. It covers the error of the
/// triangle test (six roundings of numbers of that size) and that of the box test (four), with a margin; a box that is too large only costs
/// time.
const PAD: f64 = 32.0 * f64::EPSILON;

/// How far the boxes of blocks are widened besides, because they are tested in f32: of places within the unit cube there are at most twelve
/// roundings by 2⁻²⁴, together 7e-7. Those of places beyond it, where a block can reach, don't matter.
const PAD_F32: f64 = 4e-6;

/// Components of directions below this part of the largest one are taken as this large: the ray moves by less than [`PAD`] while it
/// passes the field, and no division by zero can occur.
const SLANT: f64 = 1.0 / (1u64 << 60) as f64;

/// A ray that comes from so far away that the widened boxes reach beyond the field visits all of it.
const BLIND: f64 = 1.0;

/// The most blocks that wait: of each level fifteen, and there are 15 levels of at most 2³⁰ heights.
const WAITING: usize = 256;

/// A block of `4^level` by `4^level` cells; of level 0 a cell.
#[derive(Clone, Copy)]
struct Block {
    level: u32,
    place: (u32, u32),
    /// Where the ray enters it, as [`Path`] counts.
    enter: f32,
}

/// A ray on its way through the field.
pub(super) struct Descent<'a> {
    grid: &'a Grid,
    /// Lower heights are ignored.
    floor: f64,
    origin: DVec3,
    direction: DVec3,
    /// The largest component of the direction.
    size: f64,
    /// Reciprocal direction.
    inverse: DVec3,
    /// How far boxes are widened.
    pad: f64,
    /// The range; its upper end may become smaller during the traversal.
    pub(super) range: Interval,
}

/// A ray within the field, in f32: its parameter is 0 where the ray enters the field, and its direction has a largest component of 1.
///
/// It meets the plane `x = k / columns` at `k * step[0] + near[0]` or somewhat later, `far[0]` in place of `near[0]` or somewhat
/// earlier; likewise for heights from 0 to 65,535, and along z.
struct Path {
    /// The parameter of the ray in f64 where it enters the field.
    enter: f64,
    /// What differences of parameters in f64 are multiplied by.
    size: f64,
    /// The way from a cell to the next one along x, from a height to the next one, and from a cell to the next one along z.
    step: [f32; 3],
    near: [f32; 3],
    far: [f32; 3],
    /// Which side of a block the ray meets first: 0 the lower, 1 the higher one.
    first: [u32; 3],
    /// All blocks are met.
    is_blind: bool,
}

impl Path {
    /// The last parameter that is within a range of the ray.
    #[inline]
    fn end(&self, range: Interval) -> f32 {
        if self.is_blind {
            return f32::INFINITY;
        }
        ((range.max - self.enter) * self.size) as f32
    }

    /// Where the ray enters and leaves the space between the two sides of parts of a block along x or z. The parts are `wide` cells wide, and
    /// `numbers` are theirs, counted from the `first`.
    #[inline(always)]
    fn sides<I: Isa>(
        &self,
        isa: I,
        axis: usize,
        first: u32,
        wide: f32,
        numbers: I::F32x16,
    ) -> (I::F32x16, I::F32x16) {
        let step = self.step[axis] * wide;
        let side = self.first[axis];
        let near = (first + side) as f32 * step + self.near[axis];
        let far = (first + 1 - side) as f32 * step + self.far[axis];
        let step = isa.splat_f32x16(step);
        (
            isa.mul_add_f32x16(numbers, step, isa.splat_f32x16(near)),
            isa.mul_add_f32x16(numbers, step, isa.splat_f32x16(far)),
        )
    }
}

impl<'a> Descent<'a> {
    /// `None` for rays without a direction, or with NaN or infinite coordinates.
    pub(super) fn new(grid: &'a Grid, floor: f64, ray: &Ray, range: Interval) -> Option<Self> {
        let size = ray.direction.abs().max_element();
        if !(size > 0.0 && ray.direction.is_finite() && ray.origin.is_finite()) {
            return None;
        }
        let least = size * SLANT;
        let inverse = ray.direction.to_array().map(|d| {
            if d.abs() >= least {
                1.0 / d
            } else if d < 0.0 {
                -1.0 / least
            } else {
                1.0 / least
            }
        });
        Some(Self {
            grid,
            floor,
            origin: ray.origin,
            direction: ray.direction,
            size,
            inverse: DVec3::from_array(inverse),
            pad: (ray.origin.abs().max_element() + 2.0) * PAD,
            range,
        })
    }

    /// Passes all cells that the ray may meet to the visitor, front to back as far as possible, until it stops.
    pub(super) fn run(
        &mut self,
        mut visit: impl FnMut(&mut Interval, &Cell) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let Some(part) = self.within() else {
            return ControlFlow::Continue(());
        };
        let block = self.block_below(part);
        if block.level == 0 {
            let (i, j) = block.place;
            return visit(&mut self.range, &self.grid.cell(i, j));
        }
        let path = self.path(part.0);
        dispatch!(Simd::best(), isa => self.descend(isa, &path, block, &mut visit))
    }

    /// The part of the parameters in the range in which the ray is within the box of the field; `None` if there is none.
    fn within(&self) -> Option<(f64, f64)> {
        let [low, high] = self.grid.full_range().map(|h| f64::from(h) / SCALE);
        if high < self.floor {
            return None;
        }
        let low = if low < self.floor { self.floor } else { low };
        let (mut enter, mut exit) = (self.range.min, self.range.max);
        for (axis, low, high) in [(0, 0.0, 1.0), (1, low, high), (2, 0.0, 1.0)] {
            let a = (low - (self.origin[axis] + self.pad)) * self.inverse[axis];
            let b = (high - (self.origin[axis] - self.pad)) * self.inverse[axis];
            let (from, until) = if a < b { (a, b) } else { (b, a) };
            (enter, exit) = (later(enter, from), earlier(exit, until));
        }
        (enter <= exit).then_some((enter, exit))
    }

    /// The smallest block with all cells above which the ray is in a part of its parameters. A ray that is steep where it passes the heights is above
    /// few of them, and need not go down from the block of all cells.
    fn block_below(&self, part: (f64, f64)) -> Block {
        let (enter, exit) = part;
        let (columns, rows) = self.grid.cells();
        let cells = |axis: usize, count: u32| {
            let (from, to) = (enter * self.direction[axis], exit * self.direction[axis]);
            let (first, last) = if from < to { (from, to) } else { (to, from) };
            let origin = self.origin[axis];
            let (first, last) = (origin - self.pad + first, origin + self.pad + last);
            if first.is_nan() || last.is_nan() {
                // The ray comes from where numbers end.
                return (0, count - 1);
            }
            // The cast rounds down; what is beyond the edge becomes the first or the last cell.
            let cell = |x: f64| ((x * f64::from(count)) as u32).min(count - 1);
            (cell(first), cell(last))
        };
        let ((i, i_last), (j, j_last)) = (cells(0, columns), cells(2, rows));
        let bits = u32::BITS - ((i ^ i_last) | (j ^ j_last)).leading_zeros();
        let level = bits.div_ceil(2);
        Block {
            level,
            place: (i >> (2 * level), j >> (2 * level)),
            enter: 0.0,
        }
    }

    /// The ray from a parameter on.
    fn path(&self, enter: f64) -> Path {
        let (columns, rows) = self.grid.cells();
        let inverse = (self.inverse * self.size).as_vec3();
        let mut start = self.origin + self.direction * enter;
        let mut pad = self.pad + PAD_F32;
        let is_blind = !(pad < BLIND && start.is_finite());
        if is_blind {
            // From here all blocks are within the pad.
            (start, pad) = (DVec3::splat(0.5), 8.0);
        }
        let (at, pad) = (-start.as_vec3() * inverse, inverse.abs() * pad as f32);
        let cell = DVec3::new(1.0 / f64::from(columns), 1.0 / SCALE, 1.0 / f64::from(rows));
        Path {
            enter,
            size: self.size,
            step: (cell.as_vec3() * inverse).to_array(),
            near: (at - pad).to_array(),
            far: (at + pad).to_array(),
            first: inverse.to_array().map(|d| u32::from(d < 0.0)),
            is_blind,
        }
    }

    /// Visits the cells of a block.
    #[inline(always)]
    fn descend<I: Isa>(
        &mut self,
        isa: I,
        path: &Path,
        block: Block,
        visit: &mut impl FnMut(&mut Interval, &Cell) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let grid = self.grid;
        let [x, y, z] = path.first;
        let order = Order::of(x, z);
        // Rounded down, so that no height above the floor is lost.
        let floor = isa.splat_f32x16(((self.floor * SCALE) as f32).next_down());
        let (columns, rows) = (isa.load_f32x16(&COLUMNS), isa.load_f32x16(&ROWS));
        let height = isa.splat_f32x16(path.step[1]);
        let (below, above) = (
            isa.splat_f32x16(path.near[1]),
            isa.splat_f32x16(path.far[1]),
        );
        let start = isa.splat_f32x16(0.0);
        let mut last = path.end(self.range);
        let mut waiting = ArrayVec::<Block, WAITING>::new();
        let mut next = Some(block);
        while let Some(block) = next.or_else(|| waiting.pop()) {
            next = None;
            if block.enter > last {
                continue;
            }
            let (i, j) = block.place;
            let Some(below_this) = block.level.checked_sub(1) else {
                visit(&mut self.range, &grid.cell(i, j))?;
                last = path.end(self.range);
                continue;
            };
            let sixteen = grid.levels()[below_this as usize].block(i, j);
            let (low, high) = (
                isa.load_words_x16(&sixteen.low),
                isa.load_words_x16(&sixteen.high),
            );
            let (low, high) = (isa.max_f32x16(low, floor), isa.max_f32x16(high, floor));
            let (lower, upper) = if y == 0 { (low, high) } else { (high, low) };
            // A part is this many cells wide.
            let wide = (1u32 << (2 * below_this)) as f32;
            let (from_x, until_x) = path.sides(isa, 0, 4 * i, wide, columns);
            let (from_z, until_z) = path.sides(isa, 2, 4 * j, wide, rows);
            let from_y = isa.mul_add_f32x16(lower, height, below);
            let until_y = isa.mul_add_f32x16(upper, height, above);
            let enters = isa.max_f32x16(
                isa.max_f32x16(from_x, from_z),
                isa.max_f32x16(from_y, start),
            );
            let exits = isa.min_f32x16(
                isa.min_f32x16(until_x, until_z),
                isa.min_f32x16(until_y, isa.splat_f32x16(last)),
            );
            let met = isa.le_f32x16(enters, exits);
            if met == 0 {
                continue;
            }
            let enters = isa.store_f32x16(enters).0;
            let parts = match below_this.checked_sub(1) {
                Some(level) => grid.levels()[level as usize].size,
                None => grid.cells(),
            };
            // The last one first: the first one is next, the others wait.
            let mut ordered = order.sorted(met);
            while ordered != 0 {
                let number = ordered.ilog2();
                ordered ^= 1 << number;
                let part = order.part(number);
                let place = (4 * i + part % 4, 4 * j + part / 4);
                if place.0 >= parts.0 || place.1 >= parts.1 {
                    continue;
                }
                if let Some(earlier) = next {
                    waiting.push(earlier);
                }
                next = Some(Block {
                    level: below_this,
                    place,
                    enter: enters[part as usize % 16],
                });
            }
        }
        ControlFlow::Continue(())
    }
}

/// The numbers of the parts of a block along x.
const COLUMNS: Lanes16 = Lanes16([
    0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0,
]);

/// The numbers of the parts of a block along z.
const ROWS: Lanes16 = Lanes16([
    0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0, 3.0, 3.0, 3.0, 3.0,
]);

/// The order in which a ray meets the parts of a block: row by row, each from where the ray comes.
#[derive(Clone, Copy)]
struct Order {
    /// The bits in which the numbers of parts and their places in this order differ.
    differing: u32,
}

impl Order {
    /// `x` and `z` are the sides where the ray begins.
    #[inline(always)]
    fn of(x: u32, z: u32) -> Self {
        Self {
            differing: (0b11 * x) | (0b1100 * z),
        }
    }

    /// The part at a place.
    #[inline(always)]
    fn part(self, place: u32) -> u32 {
        place ^ self.differing
    }

    /// The bits of parts, in this order.
    #[inline(always)]
    fn sorted(self, parts: u32) -> u32 {
        let all = match self.differing & 0b1000 {
            0 => parts,
            // All of them turned round, and then each row again.
            _ => (parts as u16).reverse_bits().into(),
        };
        let rows_are_turned = (self.differing & 0b1000 != 0) != (self.differing & 1 != 0);
        if !rows_are_turned {
            return all;
        }
        let pairs = (all & 0x5555) << 1 | all >> 1 & 0x5555;
        (pairs & 0x3333) << 2 | pairs >> 2 & 0x3333
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

#[cfg(test)]
mod tests {
    use super::Order;

    #[test]
    fn parts_are_sorted_by_the_sides_where_the_ray_begins() {
        for parts in 0..1u32 << 16 {
            for (x, z) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let order = Order::of(x, z);
                let sorted = order.sorted(parts);
                assert!((0..16).all(|k| sorted >> k & 1 == parts >> order.part(k) & 1));
            }
        }
    }
}
