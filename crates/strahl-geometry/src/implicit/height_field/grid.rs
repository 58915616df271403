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
    /// Lowest and highest vertex of blocks of 2 x 2, 4 x 4, ... cells; the last level is one block.
    levels: Vec<Level>,
}

#[derive(Debug)]
struct Level {
    width: u32,
    ranges: Box<[[u16; 2]]>,
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
        };
        let (mut columns, mut rows) = grid.cells();
        while columns > 1 || rows > 1 {
            let below = (columns, rows);
            (columns, rows) = (columns.div_ceil(2), rows.div_ceil(2));
            let below_level = grid.levels.len();
            let mut ranges = Vec::with_capacity(columns as usize * rows as usize);
            for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
                let inside = [(0, 0), (1, 0), (0, 1), (1, 1)]
                    .map(|(a, b)| (2 * i + a, 2 * j + b))
                    .into_iter()
                    .filter(|&(i, j)| i < below.0 && j < below.1);
                ranges.push(hull(inside.map(|(i, j)| grid.range(below_level, i, j))));
            }
            grid.levels.push(Level {
                width: columns,
                ranges: ranges.into(),
            });
        }
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

    /// The number of the level that is one block.
    pub(super) fn top(&self) -> usize {
        self.levels.len()
    }

    /// Lowest and highest vertex of a block of `2^level` by `2^level` cells.
    #[inline]
    pub(super) fn range(&self, level: usize, i: u32, j: u32) -> [u16; 2] {
        match level.checked_sub(1).and_then(|l| self.levels.get(l)) {
            Some(level) => level.ranges[j as usize * level.width as usize + i as usize],
            None => self.cell(i, j).range(),
        }
    }

    /// Lowest and highest vertex of all.
    pub(super) fn full_range(&self) -> [u16; 2] {
        self.range(self.top(), 0, 0)
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
