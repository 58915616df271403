//! The heights, and the pyramid of their extremes.

use strahl_math::DVec3;

/// What a stored height of `u16` is divided by: full scale is just below 1, as in POV-Ray (measured).
pub(super) const SCALE: f64 = 65536.0;

/// Heights over a rectangular grid of vertices, x fastest, z ascending.
#[derive(Debug)]
pub(super) struct Grid {
    /// Vertices along x, at least 2.
    width: u32,
    /// Vertices along z, at least 2.
    depth: u32,
    heights: Box<[u16]>,
    /// Lowest and highest vertex of blocks of 2 x 2, 4 x 4, ... cells, but not of the one block that is all of the field.
    levels: Vec<Level>,
    /// Lowest and highest vertex of all.
    full: [u16; 2],
}

/// The blocks of one size, in fours: those that make up the same block of the next size.
#[derive(Debug)]
struct Level {
    /// How many fours there are along x.
    width: u32,
    fours: Box<[Four]>,
}

/// Lowest and highest vertex of the four quarters of a block, divided by [`SCALE`], which is exact; quarter `a + 2 b` is the lower (0) or the
/// upper (1) one along x and along z. Those beyond the edge of the field mean nothing.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Four {
    pub(super) low: [f32; 4],
    pub(super) high: [f32; 4],
}

impl Four {
    fn set(&mut self, quarter: usize, range: [u16; 2]) {
        let [low, high] = range.map(|h| f32::from(h) / SCALE as f32);
        (self.low[quarter], self.high[quarter]) = (low, high);
    }
}

/// Two triangles: a square of the grid, cut along the diagonal from `10` to `01`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) i: u32,
    pub(super) j: u32,
    /// Heights at (i, j), (i+1, j), (i, j+1) and (i+1, j+1).
    pub(super) heights: [u16; 4],
}

impl Cell {
    /// Lowest and highest vertex.
    pub(super) fn range(&self) -> [u16; 2] {
        hull(self.heights.map(|h| [h, h]).into_iter())
    }
}

fn hull(ranges: impl Iterator<Item = [u16; 2]>) -> [u16; 2] {
    ranges.fold([u16::MAX, 0], |[low, high], [a, b]| {
        [low.min(a), high.max(b)]
    })
}

impl Grid {
    /// Takes `width * depth` heights.
    pub(super) fn new(width: u32, depth: u32, heights: Box<[u16]>) -> Self {
        let mut grid = Self {
            width,
            depth,
            heights,
            levels: Vec::new(),
            full: [0; 2],
        };
        let (mut columns, mut rows) = grid.cells();
        let mut ranges: Vec<[u16; 2]> = Vec::new();
        while columns > 1 || rows > 1 {
            let below = (columns, rows);
            (columns, rows) = (columns.div_ceil(2), rows.div_ceil(2));
            let cells = ranges.is_empty();
            let mut fours = Vec::new();
            let mut hulls = Vec::with_capacity(columns as usize * rows as usize);
            for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
                let (mut four, mut all) = (Four::default(), [u16::MAX, 0]);
                for quarter in 0..4 {
                    let (i, j) = (2 * i + quarter % 2, 2 * j + quarter / 2);
                    if i < below.0 && j < below.1 {
                        let range = match cells {
                            true => grid.cell(i, j).range(),
                            false => ranges[j as usize * below.0 as usize + i as usize],
                        };
                        four.set(quarter as usize, range);
                        all = hull([all, range].into_iter());
                    }
                }
                if !cells {
                    fours.push(four);
                }
                hulls.push(all);
            }
            if !cells {
                grid.levels.push(Level {
                    width: columns,
                    fours: fours.into(),
                });
            }
            ranges = hulls;
        }
        grid.full = match ranges.first() {
            Some(full) => *full,
            None => grid.cell(0, 0).range(),
        };
        grid
    }

    /// Vertices along x and z.
    pub(super) fn size(&self) -> (u32, u32) {
        (self.width, self.depth)
    }

    /// Cells along x and z.
    pub(super) fn cells(&self) -> (u32, u32) {
        (self.width - 1, self.depth - 1)
    }

    /// How often cells have to be joined, two by two along each axis, until there is one block.
    pub(super) fn top(&self) -> u32 {
        let (columns, rows) = self.cells();
        u32::BITS - (columns.max(rows) - 1).leading_zeros()
    }

    /// The quarters of a block of `2^level` by `2^level` cells, `level` at least 1: blocks of half the size, or cells.
    #[inline]
    pub(super) fn quarters(&self, level: u32, i: u32, j: u32) -> Four {
        if level > 1 {
            let level = &self.levels[level as usize - 2];
            return level.fours[j as usize * level.width as usize + i as usize];
        }
        // A cell beyond the edge repeats the last one, so that four are computed without branches.
        let (columns, rows) = self.cells();
        let (i, j) = (2 * i, 2 * j);
        let right = usize::from(i + 1 < columns);
        let below = if j + 1 < rows { self.width as usize } else { 0 };
        let first = j as usize * self.width as usize + i as usize;
        let mut rows = [[0; 3]; 3];
        for (row, at) in rows
            .iter_mut()
            .zip([0, self.width as usize, self.width as usize + below])
        {
            let from = &self.heights[first + at..][..2 + right];
            *row = [from[0], from[1], from[1 + right]];
        }
        let mut four = Four::default();
        for quarter in 0..4 {
            let (a, b) = (quarter % 2, quarter / 2);
            let [p, q, r, s] = [
                rows[b][a],
                rows[b][a + 1],
                rows[b + 1][a],
                rows[b + 1][a + 1],
            ];
            four.set(quarter, [p.min(q).min(r.min(s)), p.max(q).max(r.max(s))]);
        }
        four
    }

    /// Lowest and highest vertex of all.
    pub(super) fn full_range(&self) -> [u16; 2] {
        self.full
    }

    #[inline]
    pub(super) fn height(&self, i: u32, j: u32) -> u16 {
        self.heights[j as usize * self.width as usize + i as usize]
    }

    #[inline]
    pub(super) fn cell(&self, i: u32, j: u32) -> Cell {
        let at = j as usize * self.width as usize + i as usize;
        let next = at + self.width as usize;
        let h = &self.heights;
        Cell {
            i,
            j,
            heights: [h[at], h[at + 1], h[next], h[next + 1]],
        }
    }

    /// Where vertex `(i, j)` of height `h` is in the unit cube. One expression for all who share the vertex.
    #[inline]
    pub(super) fn vertex(&self, i: u32, j: u32, h: u16) -> DVec3 {
        DVec3::new(
            f64::from(i) / f64::from(self.width - 1),
            f64::from(h) / SCALE,
            f64::from(j) / f64::from(self.depth - 1),
        )
    }

    /// The vertices of a cell, in the order of [`Cell::heights`].
    #[inline]
    pub(super) fn corners(&self, cell: &Cell) -> [DVec3; 4] {
        let [a, b, c, d] = cell.heights;
        [
            self.vertex(cell.i, cell.j, a),
            self.vertex(cell.i + 1, cell.j, b),
            self.vertex(cell.i, cell.j + 1, c),
            self.vertex(cell.i + 1, cell.j + 1, d),
        ]
    }

    /// The height of the surface at `x`, `z` within the unit square.
    pub(super) fn height_at(&self, x: f64, z: f64) -> f64 {
        let (columns, rows) = self.cells();
        let locate = |x: f64, count: u32| {
            let x = x * f64::from(count);
            // The cast rounds down; NaN and what is beyond becomes the first or the last cell.
            let cell = (x as u32).min(count - 1);
            (cell, x - f64::from(cell))
        };
        let ((i, u), (j, v)) = (locate(x, columns), locate(z, rows));
        let [a, b, c, d] = self.cell(i, j).heights.map(|h| f64::from(h) / SCALE);
        if u + v <= 1.0 {
            a + ((b - a) * u + (c - a) * v)
        } else {
            d + ((c - d) * (1.0 - u) + (b - d) * (1.0 - v))
        }
    }
}
