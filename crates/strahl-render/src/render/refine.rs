//! Adaptive antialiasing: which pixels the first pass finds too rough.

use super::{Lattice, PixelTracer, RenderError, RenderOptions};
use crate::camera::PrimaryRays;
use crate::film::{Region, try_filled};
use crate::sampling::{Compared, Refinement, Sample, Sampling, Slopes};
use crate::scene::RenderScene;
use crate::tiles::tiles;
use arrayvec::ArrayVec;
use strahl_scene::WorkingSpace;
use strahl_shade::Color;

/// Whether the second pass of [`Sampling::Adaptive`] takes more samples of pixel `(x, y)` of the picture.
pub(crate) fn is_refined(
    scene: &RenderScene,
    rays: &PrimaryRays,
    options: &RenderOptions,
    x: u32,
    y: u32,
) -> Result<bool, RenderError> {
    let Sampling::Adaptive(refinement) = options.sampling else {
        return Ok(false);
    };
    let pixel = Region {
        x,
        y,
        width: 1,
        height: 1,
    };
    let region = pixel.grown(1, options.width, options.height);
    let mut first = Lattice {
        region,
        samples: try_filled(region, Sample::NOTHING)?,
    };
    let mut tracer = PixelTracer::new(scene, rays, options, &());
    for tile in tiles(region, options.tile_order) {
        let result = tracer.centers(tile);
        for (place, sample) in tile.positions().zip(result.values) {
            first.put(place, sample);
        }
    }
    Ok(first.rough(&refinement, options.trace.space())?[first.region.index(x, y)])
}

impl Lattice {
    /// The pixels that differ from the one to the left, right, above or below, in linear light as in POV-Ray (measured).
    pub(super) fn rough(
        &self,
        refinement: &Refinement,
        space: WorkingSpace,
    ) -> Result<Vec<bool>, RenderError> {
        let region = self.region;
        let mut rough = try_filled(region, false)?;
        if refinement.depth < 2 {
            return Ok(rough);
        }
        if refinement.threshold == 0.0 {
            rough.fill(true);
            return Ok(rough);
        }
        let decoded = match space {
            WorkingSpace::Linear => None,
            _ => Some(self.decoded(space)?),
        };
        let color = |index: usize| match &decoded {
            None => self.samples[index].color,
            Some(colors) => colors[index],
        };
        let slopes = Slopes::new(refinement);
        let width = region.width as usize;
        let mut doubtful = Vec::<[usize; 2]>::new();
        for index in 0..self.samples.len() {
            let here = color(index);
            let right = (!(index + 1).is_multiple_of(width)).then_some(index + 1);
            for neighbour in [right, Some(index + width)].into_iter().flatten() {
                let is_there = neighbour < self.samples.len();
                if is_there && !slopes.surely_alike(here, color(neighbour)) {
                    doubtful.push([index, neighbour]);
                }
            }
        }
        for few in doubtful.chunks(Compared::FEW / 2) {
            let colors: ArrayVec<Color, { Compared::FEW }> =
                few.iter().flatten().map(|&index| color(index)).collect();
            let shown = Compared::few(&colors, refinement);
            let (pairs, _) = shown.as_chunks();
            for (&[here, neighbour], [a, b]) in few.iter().zip(pairs) {
                if a.differs(*b, refinement) {
                    rough[here] = true;
                    rough[neighbour] = true;
                }
            }
        }
        Ok(rough)
    }

    /// The colours of the samples in linear light.
    fn decoded(&self, space: WorkingSpace) -> Result<Vec<Color>, RenderError> {
        let mut colors = try_filled(self.region, Color::BLACK)?;
        for (color, sample) in colors.iter_mut().zip(&self.samples) {
            *color = sample.color;
        }
        space.decode_all(&mut colors);
        Ok(colors)
    }
}
