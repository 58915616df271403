//! Beam culling: finds the pixels of a tile that see only the background, many at once.

use crate::camera::PrimaryRays;
use crate::film::Region;
use crate::scene::RenderScene;
use crate::tiles::TILE;
use strahl_accel::Accelerator;

/// Pixels along a side of the smallest square that is tested.
pub(crate) const SQUARE: u32 = 4;

/// Squares along a side of a tile.
const SQUARES: u32 = TILE / SQUARE;

const _: () = assert!(SQUARES * SQUARES == u64::BITS);

/// The squares of a tile in which a ray may meet something.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BeamMask {
    x: u32,
    y: u32,
    /// A bit per square, row by row; all of them in a tile with more squares, of which none is culled.
    seen: u64,
}

impl BeamMask {
    /// No square is culled.
    pub(crate) fn all(tile: Region) -> Self {
        Self {
            x: tile.x,
            y: tile.y,
            seen: u64::MAX,
        }
    }

    /// Tests the beam of a tile, then those of its parts.
    pub(crate) fn of(tile: Region, scene: &RenderScene, rays: &PrimaryRays) -> Self {
        if tile.width > TILE || tile.height > TILE {
            return Self::all(tile);
        }
        let culling = BeamCulling { tile, scene, rays };
        let mut seen = 0;
        if culling.sees(0, 0, SQUARES) {
            culling.divide(0, 0, SQUARES, &mut seen);
        }
        Self {
            x: tile.x,
            y: tile.y,
            seen,
        }
    }

    /// Whether the rays of this pixel of the tile, its borders included, certainly meet nothing.
    #[inline]
    pub(crate) fn is_empty(&self, x: u32, y: u32) -> bool {
        let square = (y - self.y) / SQUARE * SQUARES + (x - self.x) / SQUARE;
        self.seen.wrapping_shr(square) & 1 == 0
    }
}

struct BeamCulling<'a> {
    tile: Region,
    scene: &'a RenderScene,
    rays: &'a PrimaryRays,
}

impl BeamCulling<'_> {
    /// Marks the squares of a part, `size` squares wide and high, that may see something, given that the part does.
    fn divide(&self, column: u32, row: u32, size: u32, seen: &mut u64) {
        if size == 1 {
            *seen |= 1 << (row * SQUARES + column);
            return;
        }
        let half = size / 2;
        let quarters =
            [(0, 0), (half, 0), (0, half), (half, half)].map(|(dx, dy)| (column + dx, row + dy));
        let sees = quarters.map(|(column, row)| self.sees(column, row, half));
        // Single squares are tested only near the outlines of objects.
        let outline = half > 2 || sees.contains(&false);
        for ((column, row), _) in quarters.into_iter().zip(sees).filter(|(_, sees)| *sees) {
            if outline {
                self.divide(column, row, half, seen);
            } else {
                mark(column, row, half, seen);
            }
        }
    }

    /// Whether a ray may hit something in a part of the tile.
    fn sees(&self, column: u32, row: u32, size: u32) -> bool {
        let (dx, dy) = (column * SQUARE, row * SQUARE);
        if dx >= self.tile.width || dy >= self.tile.height {
            return false;
        }
        let (x, y) = (f64::from(self.tile.x + dx), f64::from(self.tile.y + dy));
        let side = f64::from(size * SQUARE);
        let beam = self.rays.beam([x, y], [x + side, y + side]);
        let world = &self.scene.groups[0].accelerator;
        beam.is_none_or(|beam| !world.misses(&beam))
    }
}

/// Marks all squares of a part.
fn mark(column: u32, row: u32, size: u32, seen: &mut u64) {
    let line = (1 << size) - 1;
    for row in row..row + size {
        *seen |= line << (row * SQUARES + column);
    }
}
