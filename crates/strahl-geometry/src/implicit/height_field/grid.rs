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
    /// Blocks of 4 x 4, 16 x 16, ... cells, up to the one block that is all of the field.
    levels: Vec<Level>,
    /// Lowest and highest vertex of all.
    full: [u16; 2],
}

/// The blocks of one size.
#[derive(Debug)]
pub(super) struct Level {
    /// How many there are along x and along z.
    pub(super) size: (u32, u32),
    blocks: Box<[Sixteen]>,
}

impl Level {
    /// Joins parts, whose number along x and along z and whose ranges are given, sixteen at a time.
    fn of(parts: (u32, u32), range: impl Fn(u32, u32) -> [u16; 2]) -> Self {
        let size = (parts.0.div_ceil(4), parts.1.div_ceil(4));
        let mut blocks = Vec::with_capacity(size.0 as usize * size.1 as usize);
        for (j, i) in (0..size.1).flat_map(|j| (0..size.0).map(move |i| (j, i))) {
            let mut block = Sixteen::EMPTY;
            for b in 0..4.min(parts.1 - 4 * j) {
                for a in 0..4.min(parts.0 - 4 * i) {
                    let part = (a + 4 * b) as usize;
                    [block.low[part], block.high[part]] = range(4 * i + a, 4 * j + b);
                }
            }
            blocks.push(block);
        }
        Self {
            size,
            blocks: blocks.into(),
        }
    }

    #[inline]
    pub(super) fn block(&self, i: u32, j: u32) -> &Sixteen {
        &self.blocks[j as usize * self.size.0 as usize + i as usize]
    }
}

/// Lowest and highest vertex of the sixteen parts of a block; part `a + 4 b` is number `a` along x and number `b` along z. Those beyond the edge of
/// the field have their lowest vertex above the highest.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Sixteen {
    pub(super) low: [u16; 16],
    pub(super) high: [u16; 16],
}

impl Sixteen {
    const EMPTY: Self = Self {
        low: [u16::MAX; 16],
        high: [0; 16],
    };

    /// Lowest and highest vertex of the block.
    fn range(&self) -> [u16; 2] {
        let low = self.low.iter().fold(u16::MAX, |a, b| a.min(*b));
        let high = self.high.iter().fold(0, |a, b| a.max(*b));
        [low, high]
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
    fn range(&self) -> [u16; 2] {
        let [a, b, c, d] = self.heights;
        [a.min(b).min(c.min(d)), a.max(b).max(c.max(d))]
    }
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
        let mut level = Level::of(grid.cells(), |i, j| grid.cell(i, j).range());
        while level.size != (1, 1) {
            let next = Level::of(level.size, |i, j| level.block(i, j).range());
            grid.levels.push(std::mem::replace(&mut level, next));
        }
        grid.full = level.block(0, 0).range();
        grid.levels.push(level);
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

    /// Blocks from those of 4 x 4 cells up to the one that is all of the field.
    pub(super) fn levels(&self) -> &[Level] {
        &self.levels
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
