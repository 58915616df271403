//! What each stage of a picture traces, and what it stores.

use super::crew::{Ended, Turn};
use super::plan::points;
use super::refine::Comparison;
use super::{Lattice, Showing, Shown, TileResult, mean_of_corners};
use crate::film::{Film, Region};
use crate::sampling::{Quadrants, Refinement};

impl Turn<'_, '_> {
    fn showing(&self) -> Showing {
        Showing::of(self.options)
    }

    /// The first pixel of the film, where lattices begin.
    fn origin(&self) -> (u32, u32) {
        (self.canvas.film.region.x, self.canvas.film.region.y)
    }

    /// All samples of each pixel.
    pub(super) fn pixels(self) -> Ended {
        let showing = self.showing();
        self.trace(
            |tracer, tile| {
                let means = tracer.centers(tile);
                means.with(|means| vec![showing.all(&means)])
            },
            set_tiles,
        )
    }

    /// The first sample of each pixel, which later stages need.
    pub(super) fn first(self, lattice: &mut Lattice) -> Ended {
        let showing = self.showing();
        self.trace(
            |tracer, tile| {
                tracer.centers(tile).with(|samples| {
                    let shown = showing.all(&samples);
                    vec![(samples, shown)]
                })
            },
            |film, result, _| {
                for (samples, shown) in &result.values {
                    lattice.put_tile(result.tile, samples);
                    film.set_tile(result.tile, shown);
                }
            },
        )
    }

    /// The first samples of some pixels, or the samples of some corners; each is shown in a block of pixels.
    pub(super) fn coarse(
        self,
        step: u32,
        known: Option<u32>,
        corners: bool,
        mut lattice: Option<&mut Lattice>,
    ) -> Ended {
        let (showing, origin) = (self.showing(), self.origin());
        self.trace(
            |tracer, tile| tracer.points(tile, points(tile, origin, step, known), corners),
            |film, result, _| {
                for (place, sample) in result.places().zip(&result.values) {
                    if let Some(lattice) = &mut lattice {
                        lattice.put(place, *sample);
                    }
                    film.fill(block(place, step), showing.one(*sample));
                }
            },
        )
    }

    /// The corners of all pixels that are not known yet; a pixel is shown as the mean of its corners.
    pub(super) fn corners(self, known: Option<u32>, lattice: &mut Lattice) -> Ended {
        let (showing, origin) = (self.showing(), self.origin());
        self.trace(
            |tracer, tile| match known {
                Some(_) => tracer.points(tile, points(tile, origin, 1, known), true),
                None => tracer.first_pass(
                    tile,
                    |tracer, corners| tracer.tree.uniform_miss(corners as usize),
                    |tracer, x, y| tracer.corner(x, y),
                    |sample| sample,
                ),
            },
            |film, result, ready| {
                for (place, sample) in result.places().zip(&result.values) {
                    lattice.put(place, *sample);
                }
                for part in ready {
                    let means = part
                        .positions()
                        .map(|(x, y)| mean_of_corners(lattice.around(x, y)));
                    film.set_tile(*part, &showing.all(&means.collect::<Vec<_>>()));
                }
            },
        )
    }

    /// The samples of each pixel but the first, which is known.
    pub(super) fn rest(self, first: &Lattice) -> Ended {
        let showing = self.showing();
        self.trace(
            |tracer, tile| {
                let means = tracer.tile(
                    tile,
                    |_, _| None,
                    |tracer, x, y| tracer.remaining(first.at(x, y), x, y).sample(),
                );
                means.with(|means| vec![showing.all(&means)])
            },
            set_tiles,
        )
    }

    /// More samples of the pixels that differ from their neighbours; `rough` says which, for the pixels of the lattice.
    pub(super) fn refine(
        self,
        refinement: &Refinement,
        first: &Lattice,
        rough: &[Quadrants],
    ) -> Ended {
        let showing = self.showing();
        let comparison = Comparison::new(refinement, showing.space);
        let quadrants = |x, y| rough[first.region.index(x, y)];
        self.trace(
            |tracer, tile| {
                let pixels = tracer.refined(tile, &comparison, quadrants, |x, y| first.at(x, y));
                pixels.with(|pixels| {
                    let mean = |(mean, _)| mean;
                    pixels.into_iter().map(|pixel| pixel.map(mean)).collect()
                })
            },
            |film, result, _| film.set_some(result.tile, &result.values, showing),
        )
    }

    /// Divides the pixels whose corners differ.
    pub(super) fn divide(self, refinement: &Refinement, corners: &Lattice) -> Ended {
        let showing = self.showing();
        self.trace(
            |tracer, tile| tracer.divided(tile, refinement, |x, y| corners.around(x, y)),
            |film, result, _| film.set_some(result.tile, &result.values, showing),
        )
    }
}

/// The pixels that a sample of this step shows.
fn block((x, y): (u32, u32), step: u32) -> Region {
    Region {
        x,
        y,
        width: step,
        height: step,
    }
}

/// Writes the pixels of a tile.
fn set_tiles(film: &mut Film, result: TileResult<Shown>, _: &[Region]) {
    for shown in &result.values {
        film.set_tile(result.tile, shown);
    }
}
