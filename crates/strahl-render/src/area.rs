//! The grids of area lights: which of their points are needed, and what is known of them.

use crate::trace::bytes;
use strahl_shade::{AreaLight, Color};

/// If the visibilities of the corners of a cell differ by more than this, an adaptive light subdivides the cell: less than a
/// step of an 8-bit channel.
const THRESHOLD: f64 = 1.0 / 256.0;

/// The mean of four colours.
fn mean([a, b, c, d]: [Color; 4]) -> Color {
    ((a + b) + (c + d)) * 0.25
}

/// A rectangle of the grid, corners included.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    i: [u32; 2],
    j: [u32; 2],
    /// How often the grid has been halved to get here.
    level: u32,
}

impl Cell {
    /// The whole grid of a light.
    pub(crate) fn whole(area: &AreaLight) -> Self {
        Self {
            i: [0, area.size_1.saturating_sub(1)],
            j: [0, area.size_2.saturating_sub(1)],
            level: 0,
        }
    }

    /// The points at its corners, row by row.
    pub(crate) fn corners(&self) -> [GridPoint; 4] {
        let ([i0, i1], [j0, j1]) = (self.i, self.j);
        [(i0, j0), (i1, j0), (i0, j1), (i1, j1)].map(|(i, j)| GridPoint { i, j })
    }

    /// Its quarters, if it can be divided.
    pub(crate) fn quarters(&self) -> Option<[Self; 4]> {
        let ([i_low, i_high], i_splits) = halves(self.i);
        let ([j_low, j_high], j_splits) = halves(self.j);
        let quarter = |i, j| Self {
            i,
            j,
            level: self.level + 1,
        };
        (i_splits || j_splits).then(|| {
            [
                quarter(i_low, j_low),
                quarter(i_high, j_low),
                quarter(i_low, j_high),
                quarter(i_high, j_high),
            ]
        })
    }

    /// Whether it is divided in any case.
    fn is_coarse(&self, area: &AreaLight) -> bool {
        area.adaptive.is_none_or(|level| self.level < level)
    }

    /// Calls `visit` with the parts whose corners are certainly needed.
    fn parts(self, area: &AreaLight, visit: &mut impl FnMut(Self)) {
        match self.quarters() {
            Some(quarters) if self.is_coarse(area) => {
                quarters.into_iter().for_each(|q| q.parts(area, visit));
            }
            _ => visit(self),
        }
    }
}

/// Halves an interval of the grid: one with an even number of cells at its middle point, which both halves share, one with an
/// odd number in the gap between its two middle points. An interval of one cell is not divided.
fn halves([low, high]: [u32; 2]) -> ([[u32; 2]; 2], bool) {
    let width = high - low;
    if width <= 1 {
        return ([[low, high]; 2], false);
    }
    let middle = low + width / 2;
    ([[low, middle], [middle + width % 2, high]], true)
}

/// A point of the grid: its place in its row, and its row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GridPoint {
    pub(crate) i: u32,
    pub(crate) j: u32,
}

impl GridPoint {
    /// Its number, row by row.
    #[inline(always)]
    pub(crate) fn number(self, area: &AreaLight) -> usize {
        self.j as usize * area.size_1 as usize + self.i as usize
    }
}

/// What is known of the grids of a few lit points, one after the other.
#[derive(Debug, Default)]
pub(crate) struct Grids {
    /// The points of a grid.
    pub(crate) size: usize,
    /// Which points are needed, for the lit points that receive different light from the first ones.
    pub(crate) needed: Vec<bool>,
    /// The share of the light of a needed point that arrives, once its shadow ray is traced.
    pub(crate) visible: Vec<Color>,
}

impl Grids {
    /// So many grids of so many points, of which nothing is known.
    pub(crate) fn make(&mut self, count: usize, size: usize) {
        self.size = size;
        if self.visible.len() < size * count {
            self.visible.resize(size * count, Color::BLACK);
            self.needed.resize(size * count, false);
        }
    }

    /// Which points of the grid a lit point needs.
    pub(crate) fn needed_by(&mut self, lit: usize) -> &mut [bool] {
        &mut self.needed[lit * self.size..][..self.size]
    }

    /// The share of the light of a point that arrives at a lit point; it is known.
    #[inline(always)]
    pub(crate) fn color(&self, area: &AreaLight, lit: usize, point: GridPoint) -> Color {
        self.visible[lit * self.size + point.number(area)]
    }

    /// The colours of the corners of a cell, as a lit point sees them; they are known.
    #[inline(always)]
    pub(crate) fn corner_colors(&self, area: &AreaLight, lit: usize, cell: &Cell) -> [Color; 4] {
        let grid = &self.visible[lit * self.size..][..self.size];
        cell.corners().map(|corner| grid[corner.number(area)])
    }

    /// The mean over a cell, whose points are known as far as they are needed: of its four corners, or of its four quarters if the corners
    /// differ too much. The depth of the recursion is the logarithm of [`AreaLight::MAX_SIZE`].
    pub(crate) fn mean_of(&self, area: &AreaLight, lit: usize, cell: Cell) -> Color {
        let quarters = cell.quarters();
        if quarters.is_none() || !cell.is_coarse(area) {
            let corners = self.corner_colors(area, lit, &cell);
            if quarters.is_none() || !differ(&corners) {
                return mean(corners);
            }
        }
        let quarters = quarters.unwrap_or([cell; 4]);
        mean(quarters.map(|quarter| self.mean_of(area, lit, quarter)))
    }
}

/// What every lit point needs at first.
#[derive(Debug, Default)]
pub(crate) struct FirstRound {
    /// The parts of the grid.
    pub(crate) cells: Vec<Cell>,
    /// Their corners, each once.
    pub(crate) points: Vec<GridPoint>,
    /// Which points of the grid these are.
    pub(crate) needed: Vec<bool>,
}

impl FirstRound {
    pub(crate) fn find(&mut self, area: &AreaLight) {
        self.cells.clear();
        self.points.clear();
        self.needed.clear();
        self.needed
            .resize(area.size_1 as usize * area.size_2 as usize, false);
        Cell::whole(area).parts(area, &mut |cell| {
            self.cells.push(cell);
            for point in cell.corners() {
                if !std::mem::replace(&mut self.needed[point.number(area)], true) {
                    self.points.push(point);
                }
            }
        });
    }
}

/// A point of the grid that a lit point needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted {
    /// The number of the lit point.
    pub(crate) lit: u32,
    pub(crate) point: GridPoint,
}

/// A part of the grid whose corners a lit point needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub(crate) lit: u32,
    pub(crate) cell: Cell,
}

/// The working memory of area lights.
#[derive(Debug, Default)]
pub(crate) struct AreaMemory {
    pub(crate) first: FirstRound,
    pub(crate) grids: Grids,
    /// The parts of this round, and of the next one.
    pub(crate) parts: Vec<Part>,
    pub(crate) next: Vec<Part>,
    /// The points of this round.
    pub(crate) wanted: Vec<Wanted>,
}

impl AreaMemory {
    /// The bytes of its lists.
    pub(crate) fn bytes(&self) -> usize {
        let FirstRound {
            cells,
            points,
            needed,
        } = &self.first;
        let first = bytes(cells) + bytes(points) + bytes(needed);
        let grids = bytes(&self.grids.needed) + bytes(&self.grids.visible);
        first + grids + bytes(&self.parts) + bytes(&self.next) + bytes(&self.wanted)
    }
}

/// Whether the corners of a cell differ so much that it is divided.
pub(crate) fn differ(corners: &[Color; 4]) -> bool {
    let differs = |a: &Color| {
        let difference = *a - corners[0];
        difference.map(f64::abs).max_component() > THRESHOLD
    };
    corners.iter().any(differs)
}

#[cfg(test)]
mod tests {
    use super::halves;

    #[test]
    fn even_stretches_share_their_middle_and_odd_ones_part() {
        assert_eq!(halves([0, 4]), ([[0, 2], [2, 4]], true));
        assert_eq!(halves([0, 5]), ([[0, 2], [3, 5]], true));
        assert_eq!(halves([3, 4]), ([[3, 4], [3, 4]], false));
        assert_eq!(halves([7, 7]), ([[7, 7], [7, 7]], false));
    }
}
