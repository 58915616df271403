use super::{BLOCK, Grid, Grids, NESTED, SubGrid};
use crate::list::visit_all;
use crate::walk::{Mailbox, Walk};
use crate::{Accelerator, Exit, Place, Step, TraversalStats, Visitor};
use strahl_math::{Aabb, DVec3, Interval, Ray};

impl Accelerator for Grid {
    fn name(&self) -> &'static str {
        "grid"
    }

    #[inline]
    fn traverse<V: Visitor>(
        &self,
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        self.inner().traverse(ray, range, visitor, stats);
    }

    fn bytes(&self) -> usize {
        self.inner().bytes()
    }

    fn nodes(&self) -> usize {
        self.inner().nodes()
    }

    fn references(&self) -> usize {
        self.inner().references()
    }
}

impl Accelerator for Grids {
    fn name(&self) -> &'static str {
        "grids"
    }

    #[inline]
    fn traverse<V: Visitor>(
        &self,
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        let t_max = visit_all(self.unbounded.ids(), range.max, visitor, stats);
        if t_max > f64::NEG_INFINITY
            && let Some(room) = &self.room
            && let Some(walk) = Walk::new(ray, range, room)
        {
            let mut walker = Walker {
                grids: self,
                walk: &walk,
                t_max,
                far: walk.moved.upper(t_max),
                mailbox: Mailbox::new(),
                visitor,
                stats,
            };
            if walk.is_thick(room) {
                walker.thick(0);
            } else {
                walker.grid(0, walk.near, 0);
            }
        }
    }

    fn bytes(&self) -> usize {
        size_of_val(self.grids.as_slice())
            + size_of_val(self.blocks.as_slice())
            + size_of_val(self.offsets.as_slice())
            + size_of_val(self.ids.as_slice())
            + self.unbounded.bytes()
    }

    fn nodes(&self) -> usize {
        self.grids.iter().map(SubGrid::cell_count).sum()
    }

    fn references(&self) -> usize {
        // Every grid but the outermost takes the place of one reference.
        self.ids.len() + 1 - self.grids.len().max(1) + self.unbounded.references()
    }
}

struct Walker<'w, V> {
    grids: &'w Grids,
    walk: &'w Walk,
    t_max: f64,
    /// `t_max` as the walk counts.
    far: f64,
    mailbox: Mailbox,
    visitor: &'w mut V,
    stats: &'w mut TraversalStats,
}

/// What is in a cell.
enum Content<'g> {
    Nothing,
    Primitives(&'g [u32]),
    Grid(u32),
}

impl Grids {
    #[inline(always)]
    fn content(&self, filled: u64, first: u32, bit: u32) -> Content<'_> {
        if filled >> bit & 1 == 0 {
            return Content::Nothing;
        }
        let cell = (first + (filled & ((1 << bit) - 1)).count_ones()) as usize;
        let (start, end) = (self.offsets[cell], self.offsets[cell + 1] & !NESTED);
        if start & NESTED != 0 {
            return Content::Grid(self.ids[(start & !NESTED) as usize]);
        }
        Content::Primitives(&self.ids[start as usize..end as usize])
    }
}

impl<V: Visitor> Walker<'_, V> {
    /// Walks through a grid from where the ray enters it, as far as anything may still be of interest; returns whether to go
    /// on behind it. (Amanatides and Woo: A fast voxel traversal algorithm, 1987; but every crossing is computed from
    /// the number of its plane.)
    fn grid(&mut self, number: u32, near: f64, level: u32) -> bool {
        let (grids, walk) = (self.grids, self.walk);
        let grid = &grids.grids[number as usize];
        let whole = Aabb::new(grid.min, grid.cell_box(grid.count.map(|n| n - 1)).max);
        let start = walk.at_within(near, &whole);
        let mut index = [0, 1, 2].map(|axis| grid.index(axis, start[axis]));
        let up = [0, 1, 2].map(|axis| walk.up(axis));
        let mut next = [0, 1, 2]
            .map(|axis| walk.cross(axis, grid.plane(axis, index[axis] + u32::from(up[axis]))));
        let mut entered = near;
        loop {
            self.stats.node_visits += 1;
            let (place, bit) = grid.place(index);
            let block = grids.blocks[place];
            if block.filled == 0 && !grids.plain {
                let skipped = self.skip(grid, &mut index, up);
                let (axis, left) = skipped;
                if V::WATCHES {
                    self.report_empty(grid, place, entered, left, axis, level);
                }
                if self.far < left || !step(grid, &mut index, axis, up[axis]) {
                    return self.far >= left;
                }
                next = [0, 1, 2].map(|axis| {
                    walk.cross(axis, grid.plane(axis, index[axis] + u32::from(up[axis])))
                });
                entered = left;
                continue;
            }
            let axis = smallest(next);
            let left = next[axis];
            if V::WATCHES {
                self.report(grid, index, entered, left, axis, level);
            }
            let go_on = match grids.content(block.filled, block.first, bit) {
                Content::Nothing => true,
                Content::Primitives(ids) => self.visit(ids),
                Content::Grid(inner) => self.grid(inner, entered, level + 1),
            };
            // What is hit exactly at the crossing may be in the next cell only.
            if !go_on || self.far < left {
                return false;
            }
            if !step(grid, &mut index, axis, up[axis]) {
                return true;
            }
            next[axis] = walk.cross(axis, grid.plane(axis, index[axis] + u32::from(up[axis])));
            entered = left;
        }
    }

    /// Passes an empty block: moves to the cell at which the ray leaves it, and says by which axis and where.
    fn skip(&self, grid: &SubGrid, index: &mut [u32; 3], up: [bool; 3]) -> (usize, f64) {
        let edge = 1 << BLOCK;
        let first = index.map(|i| i >> BLOCK << BLOCK);
        let last = [0, 1, 2].map(|axis| (first[axis] + edge).min(grid.count[axis]) - 1);
        let crossings = [0, 1, 2].map(|axis| {
            let plane = if up[axis] {
                last[axis] + 1
            } else {
                first[axis]
            };
            self.walk.cross(axis, grid.plane(axis, plane))
        });
        let axis = smallest(crossings);
        let p = self.walk.moved.at(crossings[axis]);
        for other in 0..3 {
            // Never back: a coordinate rounded the wrong way must not make the walk go in circles.
            let (from, to) = match up[other] {
                true => (index[other], last[other]),
                false => (first[other], index[other]),
            };
            index[other] = grid.index(other, p[other]).clamp(from, to);
        }
        index[axis] = if up[axis] { last[axis] } else { first[axis] };
        (axis, crossings[axis])
    }

    /// Shows the primitives of a cell to the visitor; returns whether it wants more.
    #[inline(always)]
    fn visit(&mut self, ids: &[u32]) -> bool {
        for id in ids {
            if !self.grids.plain && !self.mailbox.is_new(*id) {
                continue;
            }
            self.stats.primitive_tests += 1;
            let closest = self.visitor.visit(*id, self.t_max);
            if closest < self.t_max {
                if closest == f64::NEG_INFINITY {
                    return false;
                }
                self.t_max = closest;
                self.far = self.walk.moved.upper(closest);
            }
        }
        true
    }

    /// Looks at all cells within the margin of a thick ray, in the order of the grid; returns whether to go on.
    fn thick(&mut self, number: u32) -> bool {
        let grids = self.grids;
        let grid = &grids.grids[number as usize];
        let [x, y, z] = grid.count;
        for k in 0..z {
            for j in 0..y {
                for i in 0..x {
                    let (place, bit) = grid.place([i, j, k]);
                    let block = grids.blocks[place];
                    let content = grids.content(block.filled, block.first, bit);
                    if matches!(content, Content::Nothing)
                        || self
                            .walk
                            .meets(&grid.cell_box([i, j, k]), self.far)
                            .is_none()
                    {
                        continue;
                    }
                    self.stats.node_visits += 1;
                    let go_on = match content {
                        Content::Nothing => true,
                        Content::Primitives(ids) => self.visit(ids),
                        Content::Grid(inner) => self.thick(inner),
                    };
                    if !go_on {
                        return false;
                    }
                }
            }
        }
        true
    }

    fn report(
        &mut self,
        grid: &SubGrid,
        index: [u32; 3],
        near: f64,
        far: f64,
        axis: usize,
        level: u32,
    ) {
        self.tell(
            Place::Cell(index, grid.cell_box(index)),
            near,
            far,
            axis,
            level,
        );
    }

    fn report_empty(
        &mut self,
        grid: &SubGrid,
        place: usize,
        near: f64,
        far: f64,
        axis: usize,
        level: u32,
    ) {
        let number = place as u32 - grid.first_block;
        let [x, y, _] = grid.blocks;
        let first = [number % x, number / x % y, number / x / y].map(|b| b << BLOCK);
        let plane = |by: u32| {
            DVec3::from(
                [0, 1, 2].map(|axis| grid.plane(axis, (first[axis] + by).min(grid.count[axis]))),
            )
        };
        let b = Aabb::new(plane(0), plane(1 << BLOCK));
        self.tell(Place::Empty(b), near, far, axis, level);
    }

    fn tell(&mut self, place: Place, near: f64, far: f64, axis: usize, level: u32) {
        let exit = Exit {
            axis,
            up: self.walk.up(axis),
            region: None,
        };
        self.visitor.step(Step {
            place,
            level,
            near: self.walk.original(near),
            far: self.walk.original(far),
            exit: Some(exit),
        });
    }
}

/// The axis whose crossing is the first; of equal ones the first axis.
#[inline(always)]
fn smallest(t: [f64; 3]) -> usize {
    let axis = usize::from(t[1] < t[0]);
    if t[2] < t[axis] { 2 } else { axis }
}

/// The next cell along an axis; `false` if there is none.
#[inline(always)]
fn step(grid: &SubGrid, index: &mut [u32; 3], axis: usize, up: bool) -> bool {
    let i = &mut index[axis];
    if up {
        *i += 1;
        *i < grid.count[axis]
    } else if *i > 0 {
        *i -= 1;
        true
    } else {
        false
    }
}
