//! The regular grid of cells, and grids within the crowded cells of grids.
//!
//! `resolution` chooses the number of cells, `build` sorts primitives into cells, `traverse` is the 3-D DDA.

mod build;
mod resolution;
mod traverse;

use crate::cells::Base;
use crate::parameters::{Parameter, Parameters};
use strahl_math::{Aabb, DVec3};

/// The parameters of [`Grid`], and with nested grids of its cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridParameters {
    /// Number of cells per primitive, above 0.
    pub density: f64,
    /// Number of cells along each axis of the outermost grid, instead of a density.
    pub resolution: Option<[u32; 3]>,
    /// The construction of V. Havran's published figures: boxes decide which primitives a cell lists, every cell is a step,
    /// primitives may be tested repeatedly.
    pub havran: bool,
}

impl Parameters for GridParameters {
    const DEFAULT: Self = Self {
        density: 8.0,
        resolution: None,
        havran: false,
    };
    const ALL: &'static [Parameter] = &[
        Parameter {
            name: "density",
            values: "NUMBER",
            about: "cells per primitive [8]",
        },
        Parameter {
            name: "resolution",
            values: "XxYxZ",
            about: "cells along each axis, instead of a density",
        },
        Parameter {
            name: "havran",
            values: "",
            about: "build and count as for V. Havran's published figures: by boxes, without mailboxes, without skipping empty cells",
        },
    ];

    fn set(&mut self, name: &str, value: &str) -> Option<()> {
        match name {
            "havran" => self.havran = true,
            "resolution" => {
                let mut counts = value.split('x').map(|n| n.parse().ok());
                let mut next = || counts.next()?.filter(|n| (1..=MOST_ALONG).contains(n));
                let resolution = [next()?, next()?, next()?];
                let cells = resolution.map(u64::from).iter().product::<u64>();
                if counts.next().is_some() || cells > MOST_CELLS {
                    return None;
                }
                self.resolution = Some(resolution);
            }
            _ => {
                let density = value.parse().ok();
                self.density = density.filter(|d| (1e-6..=1e6).contains(d))?;
            }
        }
        Some(())
    }

    fn value(&self, name: &str) -> Option<String> {
        match name {
            "havran" => self.havran.then(String::new),
            "resolution" => self.resolution.map(|[x, y, z]| format!("{x}x{y}x{z}")),
            _ => Some(self.density.to_string()),
        }
    }
}

/// Most cells of one grid.
const MOST_CELLS: u64 = 1 << 28;

/// Most cells along an axis.
const MOST_ALONG: u32 = 1 << 20;

/// A regular grid of cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid(Grids);

/// A grid whose crowded cells are grids themselves.
///
/// Cells are stored in blocks of 4 x 4 x 4 with a bit for each that is not empty; an empty block is skipped in one step.
/// Primitives without bounds are kept in a list beside the grid and always visited.
#[derive(Clone, Debug, PartialEq)]
pub struct Grids {
    base: Base,
    /// Grid 0 is the outermost.
    grids: Vec<SubGrid>,
    blocks: Vec<Block>,
    /// For each cell that is not empty the beginning of its primitives; one more entry for the end. With [`NESTED`] the only
    /// entry there is the number of a grid.
    offsets: Vec<u32>,
    ids: Vec<u32>,
}

/// Marks a cell with a nested grid.
const NESTED: u32 = 1 << 31;

/// A grid in a box.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SubGrid {
    min: DVec3,
    /// Size of a cell.
    cell: DVec3,
    /// Number of cells along each axis, at least 1.
    count: [u32; 3],
    /// Number of blocks along each axis.
    blocks: [u32; 3],
    first_block: u32,
}

/// 4 x 4 x 4 cells.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Block {
    /// A bit for each cell that is not empty.
    filled: u64,
    /// Number of the first of them.
    first: u32,
}

/// Cells along an edge of a block, as a power of two.
const BLOCK: u32 = 2;

impl SubGrid {
    /// The lower plane of a cell; that of the cell after the last is the upper end.
    #[inline(always)]
    fn plane(&self, axis: usize, index: u32) -> f64 {
        self.min[axis] + f64::from(index) * self.cell[axis]
    }

    fn cell_box(&self, index: [u32; 3]) -> Aabb {
        let plane = |up: u32| DVec3::from([0, 1, 2].map(|axis| self.plane(axis, index[axis] + up)));
        Aabb::new(plane(0), plane(1))
    }

    /// The cell a coordinate is in, the nearest one if it is outside.
    #[inline(always)]
    fn index(&self, axis: usize, coordinate: f64) -> u32 {
        // Conversions saturate; negative numbers become 0.
        let index = ((coordinate - self.min[axis]) / self.cell[axis]) as u32;
        index.min(self.count[axis] - 1)
    }

    /// The block of a cell, and its bit there.
    #[inline(always)]
    fn place(&self, index: [u32; 3]) -> (usize, u32) {
        let block = index.map(|i| (i >> BLOCK) as usize);
        let [x, y, _] = self.blocks.map(|n| n as usize);
        let [a, b, c] = index.map(|i| i & 3);
        (
            self.first_block as usize + block[0] + x * (block[1] + y * block[2]),
            a + 4 * b + 16 * c,
        )
    }

    fn block_count(&self) -> usize {
        self.blocks.iter().map(|n| *n as usize).product()
    }

    fn cell_count(&self) -> usize {
        self.count.iter().map(|n| *n as usize).product()
    }
}
