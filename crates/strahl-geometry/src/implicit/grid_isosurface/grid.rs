//! The samples, and the pyramid of their extremes.

use strahl_math::{Aabb, DVec3};

/// Samples at the points with whole coordinates, z fastest, and which of them are inside.
#[derive(Debug)]
pub(super) struct Grid {
    /// Samples along x, y and z, at least 2 each.
    samples: [u32; 3],
    values: Box<[f32]>,
    level: f64,
    /// Whether small samples are inside, instead of large ones.
    inside_below: bool,
    /// Smallest and largest sample of blocks of 2, 4, ... cells along each axis; the last level is one block.
    pyramid: Vec<Level>,
}

#[derive(Debug)]
struct Level {
    blocks: [u32; 3],
    ranges: Box<[[f32; 2]]>,
}

/// The trilinear function of a cell, which is negative inside, by its values at the corners: x is bit 2 of their numbers, z bit 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) at: [u32; 3],
    pub(super) corners: [f64; 8],
}

fn hull(ranges: impl Iterator<Item = [f32; 2]>) -> [f32; 2] {
    ranges.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], [a, b]| {
        [low.min(a), high.max(b)]
    })
}

fn places(blocks: [u32; 3]) -> impl Iterator<Item = [u32; 3]> {
    let [x, y, z] = blocks;
    (0..x).flat_map(move |i| (0..y).flat_map(move |j| (0..z).map(move |k| [i, j, k])))
}

fn index([_, y, z]: [u32; 3], [i, j, k]: [u32; 3]) -> usize {
    (i as usize * y as usize + j as usize) * z as usize + k as usize
}

impl Grid {
    /// Takes as many values as there are samples.
    pub(super) fn new(samples: [u32; 3], values: Box<[f32]>, level: f64, below: bool) -> Self {
        let mut grid = Self {
            samples,
            values,
            level,
            inside_below: below,
            pyramid: vec![],
        };
        let mut below = grid.cells();
        while below.iter().any(|&count| count > 1) {
            let blocks = below.map(|count| count.div_ceil(2));
            let number = grid.pyramid.len();
            let range = |at: [u32; 3]| {
                // Samples are shared by cells, blocks are not.
                let (of, reach) = match number {
                    0 => (samples, 3),
                    _ => (below, 2),
                };
                let ends: [u32; 3] = std::array::from_fn(|k| (2 * at[k] + reach).min(of[k]));
                let inside = places(std::array::from_fn(|k| ends[k] - 2 * at[k]));
                let place = |step: [u32; 3]| std::array::from_fn(|k| 2 * at[k] + step[k]);
                hull(inside.map(|step| match grid.pyramid.last() {
                    None => [grid.values[index(of, place(step))]; 2],
                    Some(level) => level.ranges[index(of, place(step))],
                }))
            };
            let ranges = places(blocks).map(range).collect();
            grid.pyramid.push(Level { blocks, ranges });
            below = blocks;
        }
        grid
    }

    /// Cells along x, y and z.
    pub(super) fn cells(&self) -> [u32; 3] {
        self.samples.map(|count| count - 1)
    }

    /// The coordinates of the last samples.
    pub(super) fn size(&self) -> DVec3 {
        DVec3::from_array(self.cells().map(f64::from))
    }

    /// The number of the level that is one block.
    pub(super) fn top(&self) -> usize {
        self.pyramid.len()
    }

    /// The function at a sample: it is negative inside. The difference has the sign of the exact one.
    fn signed(&self, value: f32) -> f64 {
        let over = f64::from(value) - self.level;
        if self.inside_below { over } else { -over }
    }

    fn sample(&self, at: [u32; 3]) -> f64 {
        self.signed(self.values[index(self.samples, at)])
    }

    /// A cell.
    pub(super) fn cell(&self, at: [u32; 3]) -> Cell {
        let corners = std::array::from_fn(|n| {
            let n = n as u32;
            self.sample([at[0] + (n >> 2), at[1] + (n >> 1 & 1), at[2] + (n & 1)])
        });
        Cell { at, corners }
    }

    /// The cell that a point is in, or the nearest one.
    pub(super) fn cell_at(&self, p: DVec3) -> Cell {
        let cells = self.cells();
        // The cast rounds down; NaN and what is beyond becomes the first or the last cell.
        self.cell(std::array::from_fn(|k| (p[k] as u32).min(cells[k] - 1)))
    }

    /// Whether a block of `2^level` cells along each axis is all inside or all outside; `None` if it may have a surface.
    pub(super) fn uniform(&self, level: usize, at: [u32; 3]) -> Option<bool> {
        let [low, high] = match level.checked_sub(1).and_then(|l| self.pyramid.get(l)) {
            Some(level) => level.ranges[index(level.blocks, at)].map(|v| self.signed(v)),
            None => return self.cell(at).uniform(),
        };
        if low < 0.0 && high < 0.0 {
            return Some(true);
        }
        (low >= 0.0 && high >= 0.0).then_some(false)
    }

    /// A box around the cells that have a part of the inside; `None` if there is none.
    pub(super) fn inside_bounds(&self) -> Option<Aabb> {
        let mut bounds: Option<Aabb> = None;
        for at in places(self.samples) {
            if self.sample(at) < 0.0 {
                let p = DVec3::from_array(at.map(f64::from));
                let near = Aabb::new(p - DVec3::ONE, p + DVec3::ONE);
                bounds = Some(bounds.map_or(near, |bounds| bounds.union(&near)));
            }
        }
        bounds.map(|b| Aabb::new(b.min.max(DVec3::ZERO), b.max.min(self.size())))
    }

    /// The gradient that central differences give at a point, interpolated between the samples.
    pub(super) fn smooth_gradient(&self, p: DVec3) -> DVec3 {
        let cell = self.cell_at(p);
        let slope = |at: [u32; 3], axis: usize| {
            let (mut low, mut high) = (at, at);
            low[axis] = at[axis].saturating_sub(1);
            high[axis] = (at[axis] + 1).min(self.samples[axis] - 1);
            (self.sample(high) - self.sample(low)) / f64::from(high[axis] - low[axis])
        };
        let local = cell.local(p);
        DVec3::from_array(std::array::from_fn(|axis| {
            let corners = std::array::from_fn(|n| {
                let n = n as u32;
                let [i, j, k] = cell.at;
                slope([i + (n >> 2), j + (n >> 1 & 1), k + (n & 1)], axis)
            });
            Cell { corners, ..cell }.value(local)
        }))
    }
}

impl Cell {
    fn uniform(&self) -> Option<bool> {
        if self.corners.iter().all(|&c| c < 0.0) {
            return Some(true);
        }
        self.corners.iter().all(|&c| c >= 0.0).then_some(false)
    }

    /// Where a point is in the cell, from 0 to 1.
    pub(super) fn local(&self, p: DVec3) -> DVec3 {
        (p - DVec3::from_array(self.at.map(f64::from))).clamp(DVec3::ZERO, DVec3::ONE)
    }

    /// The function at a place in the cell. The sums have the sign of their terms, if these agree, and on a face they have only the
    /// terms of that face: so neighbouring cells agree bit for bit, and a function without a change of sign has none.
    pub(super) fn value(&self, local: DVec3) -> f64 {
        let mix = |a: f64, b: f64, t: f64| a * (1.0 - t) + b * t;
        let c = &self.corners;
        let along_z = |n: usize| mix(c[n], c[n + 1], local.z);
        let low = mix(along_z(0), along_z(2), local.y);
        let high = mix(along_z(4), along_z(6), local.y);
        mix(low, high, local.x)
    }

    /// The coefficients of 1, x, y, z, xy, yz, zx and xyz.
    fn terms(&self) -> [f64; 8] {
        let [c000, c001, c010, c011, c100, c101, c110, c111] = self.corners;
        let (x, y, z) = (c100 - c000, c010 - c000, c001 - c000);
        let xy = (c110 - c010) - x;
        let yz = (c011 - c001) - y;
        let zx = (c101 - c100) - z;
        let xyz = ((c111 - c101) - (c110 - c100)) - yz;
        [c000, x, y, z, xy, yz, zx, xyz]
    }

    /// The gradient at a place in the cell.
    pub(super) fn gradient(&self, p: DVec3) -> DVec3 {
        let [_, x, y, z, xy, yz, zx, xyz] = self.terms();
        DVec3::new(
            x + xy * p.y + zx * p.z + xyz * p.y * p.z,
            y + xy * p.x + yz * p.z + xyz * p.z * p.x,
            z + yz * p.y + zx * p.x + xyz * p.x * p.y,
        )
    }

    /// The coefficients of s, s² and s³ of the function along `start + s step`.
    pub(super) fn along(&self, start: DVec3, step: DVec3) -> [f64; 3] {
        let [_, _, _, _, xy, yz, zx, xyz] = self.terms();
        let (p, e) = (start, step);
        let pairs = DVec3::new(e.y * e.z, e.z * e.x, e.x * e.y);
        [
            self.gradient(p).dot(e),
            xy * pairs.z + yz * pairs.x + zx * pairs.y + xyz * p.dot(pairs),
            xyz * e.x * e.y * e.z,
        ]
    }

    /// The rounding error of the function at a point of the cell.
    pub(super) fn noise(&self, p: DVec3, gradient: DVec3) -> f64 {
        use strahl_math::error::gamma;
        let largest = self.corners.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
        gamma(16) * largest + gamma(4) * gradient.abs().dot(p.abs())
    }
}
