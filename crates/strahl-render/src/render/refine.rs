//! Adaptive antialiasing: a first pass over the whole picture, then a second one over the pixels it finds too rough.

use super::{Job, RenderError, RenderOptions, mean_of_corners};
use crate::camera::PrimaryRays;
use crate::film::{Film, PixelInfo, Region, try_filled};
use crate::sampling::{Compared, Refinement, Sample, Sampling, subdivided};
use crate::scene::RenderScene;
use crate::tiles::tiles;
use crate::trace::RayCounts;
use strahl_accel::TraversalStats;
use strahl_shade::Color;

/// Whether the second pass of [`Sampling::Adaptive`] takes more samples of pixel `(x, y)` of the picture.
pub(crate) fn is_refined(
    scene: &RenderScene,
    options: &RenderOptions,
    x: u32,
    y: u32,
) -> Result<bool, RenderError> {
    let Sampling::Adaptive(refinement) = options.sampling else {
        return Ok(false);
    };
    let mut job = Job {
        scene,
        options,
        progress: &(),
        rays: PrimaryRays::new(scene.camera(), options.width, options.height),
        counts: RayCounts::default(),
        traversal: TraversalStats::default(),
        costs: None,
    };
    let pixel = Region {
        x,
        y,
        width: 1,
        height: 1,
    };
    let first = job.centers(pixel, |_, _| {})?;
    Ok(first.rough(&refinement)?[first.region.index(x, y)])
}

/// The colours at the centres of pixels.
struct Centers {
    region: Region,
    samples: Vec<Sample>,
}

impl Centers {
    /// The pixels that differ from the one to the left, right, above or below.
    fn rough(&self, refinement: &Refinement) -> Result<Vec<bool>, RenderError> {
        let region = self.region;
        let mut rough = try_filled(region, false)?;
        if refinement.depth < 2 {
            return Ok(rough);
        }
        if refinement.threshold == 0.0 {
            rough.fill(true);
            return Ok(rough);
        }
        // Neighbours are often equal: then there is nothing to raise to a power.
        let mut last = (Color::BLACK, Compared::new(Color::BLACK, refinement));
        let shown: Vec<Compared> = self
            .samples
            .iter()
            .map(|&Sample { color, .. }| {
                if color != last.0 {
                    last = (color, Compared::new(color, refinement));
                }
                last.1
            })
            .collect();
        let width = region.width as usize;
        for (index, &here) in shown.iter().enumerate() {
            let right = (!(index + 1).is_multiple_of(width)).then_some(index + 1);
            for neighbour in [right, Some(index + width)].into_iter().flatten() {
                let differs = |there: &Compared| here.differs(*there, refinement);
                if shown.get(neighbour).is_some_and(differs) {
                    rough[index] = true;
                    rough[neighbour] = true;
                }
            }
        }
        Ok(rough)
    }
}

impl Job<'_> {
    /// Refines the pixels that differ from a neighbour. That is decided when the first pass is complete, over the region and a margin of one
    /// pixel, so it does not depend on tiles or regions.
    pub(super) fn adaptive(
        &mut self,
        film: &mut Film,
        refinement: &Refinement,
    ) -> Result<(), RenderError> {
        let region = film.region;
        let first = self.centers(region, |tile, infos| film.set_infos(tile, infos))?;
        let center = |x, y| first.samples[first.region.index(x, y)];
        for (x, y) in region.positions() {
            film.set((x, y), center(x, y));
        }
        let rough = first.rough(refinement)?;
        let is_rough = |x, y| rough[first.region.index(x, y)];
        self.second_pass(
            film,
            |tile| tile.positions().any(|(x, y)| is_rough(x, y)),
            |tracer, x, y| {
                is_rough(x, y).then(|| {
                    let mut samples = tracer.pixel(1, x, y);
                    samples.sum += center(x, y).color;
                    samples.clear += center(x, y).clear;
                    samples.count += 1;
                    samples.sample()
                })
            },
        )
    }

    /// Divides the pixels whose corners differ.
    pub(super) fn recursive(
        &mut self,
        film: &mut Film,
        refinement: &Refinement,
    ) -> Result<(), RenderError> {
        let lattice = self.lattice(film)?;
        for (x, y) in film.region.positions() {
            film.set((x, y), mean_of_corners(lattice.around(x, y)));
        }
        self.second_pass(
            film,
            |_| true,
            |tracer, x, y| {
                let corners = lattice.around(x, y);
                // Most pixels have four equal corners.
                corners
                    .iter()
                    .any(|corner| corner.color != corners[0].color)
                    .then(|| {
                        subdivided(corners, refinement, &mut |dx, dy| {
                            tracer.sample(f64::from(x) + dx, f64::from(y) + dy, false)
                        })
                    })
            },
        )
    }

    /// Traces the pixels again for which `trace` has a colour, in the tiles that are `wanted`.
    fn second_pass(
        &mut self,
        film: &mut Film,
        wanted: impl Fn(&Region) -> bool,
        trace: impl Fn(&mut super::PixelTracer<'_>, u32, u32) -> Option<Sample> + Sync,
    ) -> Result<(), RenderError> {
        let mut all = tiles(film.region, self.options.tile_order);
        all.retain(wanted);
        self.tiles(
            &all,
            1,
            |_, _| None,
            trace,
            |result| {
                for (place, color) in result.tile.positions().zip(result.values) {
                    if let Some(color) = color {
                        film.set(place, color);
                    }
                }
            },
        )
    }

    /// The first pass: the centres of the pixels of a region and of those around it. `keep` takes the data of the pixels of a tile.
    fn centers(
        &mut self,
        region: Region,
        mut keep: impl FnMut(Region, &[PixelInfo]) + Send,
    ) -> Result<Centers, RenderError> {
        let region = region.grown(1, self.options.width, self.options.height);
        let mut samples = try_filled(region, Sample::NOTHING)?;
        self.tiles(
            &tiles(region, self.options.tile_order),
            0,
            |tracer, pixels| Some(tracer.blank(pixels)?.sample()),
            |tracer, x, y| tracer.pixel(0, x, y).sample(),
            |result| {
                keep(result.tile, &result.infos);
                for ((x, y), sample) in result.tile.positions().zip(result.values) {
                    samples[region.index(x, y)] = sample;
                }
            },
        )?;
        Ok(Centers { region, samples })
    }
}
