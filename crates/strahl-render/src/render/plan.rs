//! The passes of a picture.

use super::RenderOptions;
use crate::film::Region;
use crate::sampling::{Refinement, Sampling};
use crate::sink::Pass;
use crate::tiles::TILE;

/// What a pass does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Stage {
    /// Traces all samples of each pixel.
    Pixels,
    /// Traces the first sample of each pixel whose column and row, counted from those of the film, are multiples of `step`, as far as no
    /// pass before has.
    First { step: u32 },
    /// Traces the other samples of each pixel.
    Rest,
    /// Traces more samples of pixels that differ from their neighbours.
    Refine(Refinement),
    /// Traces rays through corners of pixels, as [`Stage::First`] does through pixels.
    Corners { step: u32 },
    /// Divides the pixels whose corners differ.
    Divide(Refinement),
}

/// The step of the first of the coarse passes; each halves it.
const COARSEST: u32 = 8;

impl Stage {
    /// The stages of a picture.
    pub(super) fn all(options: &RenderOptions) -> Vec<Self> {
        let steps = || {
            let coarsest = if options.coarse_first { COARSEST } else { 1 };
            (0..=coarsest.ilog2()).rev().map(|power| 1 << power)
        };
        let first = || steps().map(|step| Self::First { step });
        let corners = || steps().map(|step| Self::Corners { step });
        match options.sampling {
            Sampling::Adaptive(r) => first().chain([Self::Refine(r)]).collect(),
            Sampling::Corners => corners().collect(),
            Sampling::Recursive(r) => corners().chain([Self::Divide(r)]).collect(),
            _ if !options.coarse_first => vec![Self::Pixels],
            Sampling::Center | Sampling::Grid(0 | 1) => first().collect(),
            Sampling::Grid(_) => first().chain([Self::Rest]).collect(),
        }
    }

    /// The description of the stage with this number.
    pub(super) fn pass(stages: &[Self], number: usize) -> Pass {
        let stage = stages.get(number).copied().unwrap_or(Self::Pixels);
        let (step, refines) = match stage {
            Self::First { step } | Self::Corners { step } => (step, false),
            Self::Pixels => (1, false),
            Self::Rest | Self::Refine(_) | Self::Divide(_) => (1, true),
        };
        Pass {
            number: number as u32,
            of: stages.len() as u32,
            step,
            refines,
        }
    }
}

/// Edge length of the tiles of a pass, in pixels: coarse passes have larger ones, so that a tile is not too little work.
pub(super) const fn edge(step: u32) -> u32 {
    let edge = step * 16;
    if edge > TILE { edge } else { TILE }
}

/// Pixels along a side of the squares in which points are listed, in steps: rays of a packet are close to each other.
const SQUARE: u32 = 4;

/// The points of a tile on the lattice of this step that starts at `origin`, without those on the lattice `known` of a pass before.
pub(super) fn points(
    tile: Region,
    origin: (u32, u32),
    step: u32,
    known: Option<u32>,
) -> Vec<(u32, u32)> {
    let is_on =
        |at: u32, origin: u32, step: u32| at >= origin && (at - origin).is_multiple_of(step);
    // At full resolution margins before the origin belong to the lattice too.
    let along = |start: u32, length: u32, origin: u32| -> Vec<u32> {
        (start..start + length)
            .filter(|at| step == 1 || is_on(*at, origin, step))
            .collect()
    };
    let columns = along(tile.x, tile.width, origin.0);
    let rows = along(tile.y, tile.height, origin.1);
    let mut points = Vec::with_capacity(columns.len() * rows.len());
    for rows in rows.chunks(SQUARE as usize) {
        for columns in columns.chunks(SQUARE as usize) {
            for y in rows {
                for x in columns {
                    let traced = |k: u32| is_on(*x, origin.0, k) && is_on(*y, origin.1, k);
                    if !known.is_some_and(traced) {
                        points.push((*x, *y));
                    }
                }
            }
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lattices_have_every_pixel_once() {
        let region = Region {
            x: 6,
            y: 2,
            width: 45,
            height: 39,
        };
        // The film begins one pixel further in, as where neighbours are compared.
        let origin = (7, 3);
        let mut seen = vec![0; 45 * 39];
        for (step, known) in [(8, None), (4, Some(8)), (2, Some(4)), (1, Some(2))] {
            for tile in crate::tiles::tiles_of(region, edge(step), Default::default()) {
                for (x, y) in points(tile, origin, step, known) {
                    assert!(tile.contains(x, y));
                    seen[region.index(x, y)] += 1;
                }
            }
        }
        assert!(seen.iter().all(|n| *n == 1), "{seen:?}");
    }
}
