//! Splits space instead of a set of primitives: a primitive that straddles the plane goes to both sides, each with its part
//! there.
//!
//! M. Stich, H. Friedrich, A. Dietrich, "Spatial Splits in Bounding Volume Hierarchies" (2009).

use crate::Shapes;
use crate::boxes::Box32;
use crate::bvh::bins::{BINS, Cut, cheapest};
use crate::bvh::refs::CHUNK;
use crate::bvh::refs::Ref;
use rayon::prelude::*;
use strahl_math::Vec4;

/// Cells per axis.
const CELLS: usize = 16;

/// A plane that splits space.
pub(super) struct SpaceCut {
    axis: usize,
    at: f32,
    /// Half area times number of blocks of primitives, summed over both sides.
    pub(super) cost: f32,
}

/// The cells that the box of a set is divided into, along each axis.
#[derive(Clone, Copy)]
struct Cells {
    lo: Vec4,
    size: Vec4,
}

impl Cells {
    /// The upper plane of a cell.
    fn end(&self, axis: usize, cell: usize) -> f32 {
        self.lo[axis] + self.size[axis] * ((cell + 1) as f32 / CELLS as f32)
    }

    /// The cell of a coordinate. Casts saturate, and take 0/0 to 0.
    fn of(&self, axis: usize, x: f32) -> usize {
        let cell = (x - self.lo[axis]) / self.size[axis] * CELLS as f32;
        (cell as usize).min(CELLS - 1)
    }
}

/// The contents of the cells of each axis.
#[derive(Clone)]
struct Content {
    /// The boxes around the parts of primitives in each cell.
    boxes: [[Box32; 3]; CELLS],
    /// The numbers of primitives that begin and end in each cell.
    begin: [[u32; 4]; CELLS],
    end: [[u32; 4]; CELLS],
}

impl Content {
    const EMPTY: Self = Self {
        boxes: [[Box32::EMPTY; 3]; CELLS],
        begin: [[0; 4]; CELLS],
        end: [[0; 4]; CELLS],
    };

    fn of(shapes: &dyn Shapes, refs: &[Ref], cells: &Cells) -> Self {
        let mut content = Self::EMPTY;
        for r in refs {
            for axis in 0..3 {
                content.add(shapes, r, cells, axis);
            }
        }
        content
    }

    fn add(&mut self, shapes: &dyn Shapes, r: &Ref, cells: &Cells, axis: usize) {
        let (lo, hi) = r.bounds().corners();
        let (first, last) = (cells.of(axis, lo[axis]), cells.of(axis, hi[axis]));
        self.begin[first][axis] += 1;
        self.end[last][axis] += 1;
        let mut rest = *r;
        for cell in first..last {
            let [part, other] = rest.halves(shapes, axis, cells.end(axis, cell));
            self.boxes[cell][axis].grow(part.bounds());
            rest = other;
        }
        self.boxes[last][axis].grow(rest.bounds());
    }

    fn merge(&mut self, other: &Self) {
        for cell in 0..CELLS {
            for axis in 0..3 {
                self.boxes[cell][axis].grow(&other.boxes[cell][axis]);
                self.begin[cell][axis] += other.begin[cell][axis];
                self.end[cell][axis] += other.end[cell][axis];
            }
        }
    }
}

impl SpaceCut {
    /// The cheapest one through a set whose boxes span `bounds`, in the unit `unit` and with blocks of `2^block_log` primitives.
    pub(super) fn cheapest(
        shapes: &dyn Shapes,
        refs: &[Ref],
        bounds: &Box32,
        unit: f32,
        block_log: u32,
    ) -> Option<Self> {
        let cells = Cells {
            lo: bounds.lo(),
            size: bounds.size(),
        };
        // Minima, maxima and integer sums are exact in any grouping, so the result does not depend on the threads.
        let content = refs
            .par_chunks(CHUNK)
            .map(|chunk| Content::of(shapes, chunk, &cells))
            .reduce_with(|mut a, b| {
                a.merge(&b);
                a
            })?;
        let mut right_costs = [Vec4::ZERO; BINS];
        let Cut {
            axis,
            last_left,
            cost,
        } = cheapest(
            &content.boxes,
            [&content.begin, &content.end],
            &mut right_costs,
            (unit, block_log),
        )?;
        let at = cells.end(axis, last_left);
        Some(Self { axis, at, cost })
    }

    /// Splits a set into the parts on both sides. A primitive that straddles the plane goes to one side as a whole where that
    /// is cheaper than a part on each (reference unsplitting), and where no more parts are allowed (`spare`).
    pub(super) fn apply(&self, shapes: &dyn Shapes, refs: &[Ref], spare: usize) -> [Vec<Ref>; 2] {
        let mut sides = [Side::new(refs.len()), Side::new(refs.len())];
        let mut across = vec![];
        for r in refs {
            let (lo, hi) = r.bounds().corners();
            if hi[self.axis] <= self.at {
                sides[0].push(*r);
            } else if lo[self.axis] >= self.at {
                sides[1].push(*r);
            } else {
                across.push(*r);
                sides[0].expected += 1;
                sides[1].expected += 1;
                let parts = r.halves(shapes, self.axis, self.at);
                sides[0].bounds.grow(parts[0].bounds());
                sides[1].bounds.grow(parts[1].bounds());
            }
        }
        let mut spare = spare;
        for r in across {
            let parts = r.halves(shapes, self.axis, self.at);
            match self.choose(&sides, &r, &parts, spare > 0) {
                Choice::Both => {
                    spare -= 1;
                    for (side, part) in sides.iter_mut().zip(parts) {
                        side.refs.push(part);
                    }
                }
                Choice::Whole(side) => {
                    sides[side].refs.push(r);
                    sides[side].bounds.grow(r.bounds());
                    sides[1 - side].expected -= 1;
                }
                Choice::Part(side) => {
                    sides[side].refs.push(parts[side]);
                    sides[1 - side].expected -= 1;
                }
            }
        }
        sides.map(|side| side.refs)
    }

    fn choose(&self, sides: &[Side; 2], r: &Ref, parts: &[Ref; 2], may_both: bool) -> Choice {
        // Its box straddles the plane, but the primitive need not.
        if let Some(empty) = parts.iter().position(|p| p.bounds().is_empty()) {
            return Choice::Part(1 - empty);
        }
        let whole = |side: usize| {
            let mut bounds = sides[side].bounds;
            bounds.grow(r.bounds());
            let other = &sides[1 - side];
            area(&bounds) * sides[side].expected as f64
                + area(&other.bounds) * (other.expected - 1) as f64
        };
        let both: f64 = sides
            .iter()
            .map(|s| area(&s.bounds) * s.expected as f64)
            .sum();
        let (left, right) = (whole(0), whole(1));
        if may_both && both <= left && both <= right {
            Choice::Both
        } else {
            Choice::Whole(usize::from(right < left))
        }
    }
}

/// Where a straddling primitive goes.
enum Choice {
    Both,
    Whole(usize),
    Part(usize),
}

fn area(bounds: &Box32) -> f64 {
    if bounds.is_empty() {
        return 0.0;
    }
    bounds.half_area()
}

/// One side of a cut.
struct Side {
    refs: Vec<Ref>,
    /// The bounds of these and of the parts expected.
    bounds: Box32,
    /// The number of primitives if all straddling ones are split.
    expected: usize,
}

impl Side {
    fn new(capacity: usize) -> Self {
        Self {
            refs: Vec::with_capacity(capacity / 2),
            bounds: Box32::EMPTY,
            expected: 0,
        }
    }

    fn push(&mut self, r: Ref) {
        self.refs.push(r);
        self.bounds.grow(r.bounds());
        self.expected += 1;
    }
}
