use super::resolution::cubic;
use super::{BLOCK, Block, Grid, GridParameters, Grids, NESTED, SubGrid};
use crate::Shapes;
use crate::cells::Base;
use crate::shapes::BoxesOnly;
use crate::walk::Room;
use rayon::prelude::*;
use strahl_math::{Aabb, DVec3};

/// Cells with more primitives become grids, if that reduces the references.
const CROWDED: usize = 16;

/// Levels of grids.
const LEVELS: u32 = 3;

impl Grid {
    /// Sorts primitives into the cells of one grid.
    pub fn build(shapes: &dyn Shapes, parameters: &GridParameters) -> Self {
        Self(Grids::build_levels(shapes, parameters, 1))
    }

    pub(super) fn inner(&self) -> &Grids {
        &self.0
    }
}

impl Grids {
    /// Sorts primitives into the cells of grids within grids.
    pub fn build(shapes: &dyn Shapes, parameters: &GridParameters) -> Self {
        Self::build_levels(shapes, parameters, LEVELS)
    }

    fn build_levels(shapes: &dyn Shapes, parameters: &GridParameters, levels: u32) -> Self {
        let (base, ids) = Base::gather(shapes, parameters.havran);
        let mut grids = Self {
            base,
            grids: Vec::new(),
            blocks: Vec::new(),
            offsets: Vec::new(),
            ids: Vec::new(),
        };
        if let Some(room) = grids.base.room {
            let boxes = BoxesOnly(shapes);
            let builder = Builder {
                shapes: if parameters.havran { &boxes } else { shapes },
                room,
                parameters: *parameters,
            };
            if let Some(cells) = builder.cells(&ids, &room.root, 1, levels) {
                grids.add(cells);
            }
        }
        grids
    }

    /// Adds a grid with those in its cells; returns its number.
    fn add(&mut self, cells: Cells) -> u32 {
        let number = self.grids.len();
        let first_block = self.blocks.len() as u32;
        let grid = SubGrid {
            first_block,
            ..cells.grid
        };
        self.grids.push(grid);
        let outermost = self.offsets.is_empty();
        if !outermost {
            // The end of the last cell is the beginning of the first one added.
            self.offsets.pop();
        }
        let first_cell = self.offsets.len() as u32;
        self.blocks.extend(cells.blocks.into_iter().map(|b| Block {
            first: b.first + first_cell,
            ..b
        }));
        let first_id = self.ids.len() as u32;
        self.offsets
            .extend(cells.offsets.iter().map(|o| o + first_id));
        self.ids.extend(cells.ids);
        for (cell, nested) in cells.nested {
            let inner = self.add(nested);
            let place = first_cell as usize + cell;
            let at = self.offsets[place] & !NESTED;
            self.offsets[place] = at | NESTED;
            self.ids[at as usize] = inner;
        }
        number as u32
    }
}

/// A grid while it is built: cells and ids are numbered within it.
struct Cells {
    grid: SubGrid,
    blocks: Vec<Block>,
    /// The beginning of the ids of each cell that is not empty, and the end of the last.
    offsets: Vec<u32>,
    /// The ids; a cell with a nested grid has one entry, which is not an id.
    ids: Vec<u32>,
    nested: Vec<(usize, Cells)>,
}

struct Builder<'s> {
    shapes: &'s dyn Shapes,
    room: Room,
    parameters: GridParameters,
}

impl Builder<'_> {
    /// A grid over some primitives in a box; `None` if there are too many references for 31 bits.
    fn cells(&self, ids: &[u32], region: &Aabb, level: u32, levels: u32) -> Option<Cells> {
        let grid = self.empty(ids.len(), region, level);
        let mut pairs: Vec<u64> = ids
            .par_iter()
            .with_min_len(256)
            .flat_map_iter(|id| self.places(&grid, *id))
            .collect();
        pairs.par_sort_unstable();
        if pairs.len() >= NESTED as usize {
            return None;
        }
        let mut cells = Cells {
            grid,
            blocks: vec![Block::default(); grid.block_count()],
            offsets: Vec::new(),
            ids: Vec::with_capacity(pairs.len()),
            nested: Vec::new(),
        };
        let mut block_of_next = 0;
        for same in pairs.chunk_by(|a, b| a >> 32 == b >> 32) {
            let place = (same[0] >> 32) as u32;
            let (block, bit) = ((place >> 6) as usize, place & 63);
            for block in &mut cells.blocks[block_of_next..=block] {
                block.first = cells.offsets.len() as u32;
            }
            block_of_next = block + 1;
            cells.blocks[block].filled |= 1 << bit;
            let cell = cells.offsets.len();
            cells.offsets.push(cells.ids.len() as u32);
            let ids: Vec<u32> = same.iter().map(|pair| *pair as u32).collect();
            match self.nested(&grid, place, &ids, level, levels) {
                Some(nested) => {
                    cells.nested.push((cell, nested));
                    cells.ids.push(0);
                }
                None => cells.ids.extend(ids),
            }
        }
        cells.offsets.push(cells.ids.len() as u32);
        Some(cells)
    }

    /// The cells of a box, for so many primitives.
    fn empty(&self, primitives: usize, region: &Aabb, level: u32) -> SubGrid {
        let wanted = self.parameters.density * primitives as f64;
        let count = match self.parameters.resolution {
            Some(given) if level == 1 => given,
            _ => cubic(region.size(), wanted, self.room.smallest_cell()),
        };
        let cell = region.size() / DVec3::from(count.map(f64::from));
        SubGrid {
            min: region.min,
            cell,
            count,
            blocks: count.map(|n| n.div_ceil(1 << BLOCK)),
            first_block: 0,
        }
    }

    /// The cells a primitive is in, each as `block (26 bits), bit in the block (6 bits), id (32 bits)`.
    fn places(&self, grid: &SubGrid, id: u32) -> Vec<u64> {
        let pad = DVec3::splat(self.room.pad);
        let bounds = self.shapes.bounds(id).padded(pad);
        let range =
            |axis: usize| grid.index(axis, bounds.min[axis])..=grid.index(axis, bounds.max[axis]);
        let mut places = Vec::new();
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    let cell = grid.cell_box([x, y, z]).padded(pad);
                    if self.shapes.overlaps(id, &cell) {
                        let (block, bit) = grid.place([x, y, z]);
                        places.push((((block as u64) << 6 | u64::from(bit)) << 32) | u64::from(id));
                    }
                }
            }
        }
        places
    }

    /// The nested grid of a crowded cell, if it separates the primitives.
    fn nested(
        &self,
        grid: &SubGrid,
        place: u32,
        ids: &[u32],
        level: u32,
        levels: u32,
    ) -> Option<Cells> {
        if level == levels || ids.len() <= CROWDED {
            return None;
        }
        let (block, bit) = (place >> 6, place & 63);
        let [x, y, _] = grid.blocks;
        let index = [
            block % x * 4 + bit % 4,
            block / x % y * 4 + bit / 4 % 4,
            block / x / y * 4 + bit / 16,
        ];
        let region = grid.cell_box(index);
        if region.size().max_element() < 2.0 * self.room.smallest_cell() {
            return None;
        }
        let cells = self.cells(ids, &region, level + 1, levels)?;
        let filled = cells.offsets.len() - 1;
        // If most primitives are in most cells, nothing is gained.
        let crowded = cells.references() * 2 > ids.len() * filled;
        (filled > 1 && !crowded).then_some(cells)
    }
}

impl Cells {
    fn references(&self) -> usize {
        let nested: usize = self.nested.iter().map(|(_, n)| n.references()).sum();
        self.ids.len() - self.nested.len() + nested
    }
}
