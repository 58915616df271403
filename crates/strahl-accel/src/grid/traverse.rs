use super::{BLOCK, Grid, Grids, NESTED, SubGrid};
use crate::cells::Search;
use crate::{Accelerator, Exit, Place, TraversalStats, Visitor};
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
        self.base.search(ray, range, visitor, stats, |search| {
            let (walk, room) = (search.walk, search.room);
            let mut walker = Walker {
                grids: self,
                search,
            };
            if walk.is_thick(room) {
                walker.thick(0);
            } else {
                walker.grid(0, walk.near, 0);
            }
        });
    }

    fn bytes(&self) -> usize {
        size_of_val(self.grids.as_slice())
            + size_of_val(self.blocks.as_slice())
            + size_of_val(self.offsets.as_slice())
            + size_of_val(self.ids.as_slice())
            + self.base.unbounded.bytes()
    }

    fn nodes(&self) -> usize {
        self.grids.iter().map(SubGrid::cell_count).sum()
    }

    fn references(&self) -> usize {
        // Every grid but the outermost replaces one reference.
        self.ids.len() + 1 - self.grids.len().max(1) + self.base.unbounded.references()
    }
}

struct Walker<'w, V> {
    grids: &'w Grids,
    search: Search<'w, V>,
}

/// The content of a cell.
enum Content<'g> {
    Empty,
    Primitives(&'g [u32]),
    Grid(u32),
}

impl Grids {
    #[inline(always)]
    fn content(&self, filled: u64, first: u32, bit: u32) -> Content<'_> {
        if filled >> bit & 1 == 0 {
            return Content::Empty;
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
    /// Walks through a grid from where the ray enters it until nothing beyond can matter; returns whether to continue behind
    /// it. (Amanatides and Woo: A fast voxel traversal algorithm, 1987; but every crossing is computed from the number of its
    /// plane.)
    fn grid(&mut self, number: u32, near: f64, level: u32) -> bool {
        let (grids, walk) = (self.grids, self.search.walk);
        let grid = &grids.grids[number as usize];
        let whole = Aabb::new(grid.min, grid.cell_box(grid.count.map(|n| n - 1)).max);
        let start = walk.at_within(near, &whole);
        let mut index = [0, 1, 2].map(|axis| grid.index(axis, start[axis]));
        let up = [0, 1, 2].map(|axis| walk.up(axis));
        let mut next = [0, 1, 2]
            .map(|axis| walk.cross(axis, grid.plane(axis, index[axis] + u32::from(up[axis]))));
        let mut entered = near;
        loop {
            self.search.stats.node_visits += 1;
            let (place, bit) = grid.place(index);
            let block = grids.blocks[place];
            if block.filled == 0 && !grids.base.published {
                let skipped = self.skip(grid, &mut index, up);
                let (axis, left) = skipped;
                if V::WATCHES {
                    self.report_empty(grid, place, entered, left, axis, level);
                }
                if self.search.far < left || !step(grid, &mut index, axis, up[axis]) {
                    return self.search.far >= left;
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
                Content::Empty => true,
                Content::Primitives(ids) => self.search.visit(ids),
                Content::Grid(inner) => self.grid(inner, entered, level + 1),
            };
            // A primitive hit exactly at the crossing may be listed in the next cell only.
            if !go_on || self.search.far < left {
                return false;
            }
            if !step(grid, &mut index, axis, up[axis]) {
                return true;
            }
            next[axis] = walk.cross(axis, grid.plane(axis, index[axis] + u32::from(up[axis])));
            entered = left;
        }
    }

    /// Skips an empty block: moves to the cell at which the ray leaves it, and returns the axis and the parameter.
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
            self.search.walk.cross(axis, grid.plane(axis, plane))
        });
        let axis = smallest(crossings);
        let p = self.search.walk.moved.at(crossings[axis]);
        for other in 0..3 {
            // Never backwards: a coordinate rounded in the wrong direction must not make the walk go in circles.
            let (from, to) = match up[other] {
                true => (index[other], last[other]),
                false => (first[other], index[other]),
            };
            index[other] = grid.index(other, p[other]).clamp(from, to);
        }
        index[axis] = if up[axis] { last[axis] } else { first[axis] };
        (axis, crossings[axis])
    }

    /// Visits all cells within the margin of a thick ray, in the order of the grid; returns whether to continue.
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
                    if matches!(content, Content::Empty)
                        || self
                            .search
                            .walk
                            .meets(&grid.cell_box([i, j, k]), self.search.far)
                            .is_none()
                    {
                        continue;
                    }
                    self.search.stats.node_visits += 1;
                    let go_on = match content {
                        Content::Empty => true,
                        Content::Primitives(ids) => self.search.visit(ids),
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
        let place = Place::Cell(index, grid.cell_box(index));
        self.search.tell(place, level, near, far, self.exit(axis));
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
        self.search
            .tell(Place::Empty(b), level, near, far, self.exit(axis));
    }

    fn exit(&self, axis: usize) -> Option<Exit> {
        Some(Exit {
            axis,
            up: self.search.walk.up(axis),
            region: None,
        })
    }
}

/// The axis of the first crossing; of equal ones the first axis.
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
