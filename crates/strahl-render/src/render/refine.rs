//! Adaptive antialiasing: which pixels the first pass finds too rough.

use super::{Lattice, PixelTracer, RenderError, RenderOptions};
use crate::camera::PrimaryRays;
use crate::film::{Region, try_filled};
use crate::sampling::{Compared, Quadrants, Refinement, Sample, Sampling, Slopes};
use crate::scene::RenderScene;
use crate::tiles::{tiles, whole_tiles};
use arrayvec::ArrayVec;
use strahl_scene::WorkingSpace;
use strahl_shade::Color;

/// How the colours of neighbours are compared: in linear light, as in POV-Ray (measured).
pub(super) struct Comparison<'a> {
    refinement: &'a Refinement,
    slopes: Slopes,
    /// For [`Refinement::for_quadrants`].
    quadrants: Slopes,
    space: WorkingSpace,
}

impl<'a> Comparison<'a> {
    pub(super) fn new(refinement: &'a Refinement, space: WorkingSpace) -> Self {
        Self {
            refinement,
            slopes: Slopes::new(refinement),
            quadrants: Slopes::new(&refinement.for_quadrants()),
            space,
        }
    }

    /// Converts colours of the working space to linear light.
    pub(super) fn decode(&self, colors: &mut [Color]) {
        self.space.decode_all(colors);
    }

    /// Whether each of some pairs of colours in linear light differs.
    pub(super) fn differ(&self, pairs: &[[Color; 2]]) -> Vec<bool> {
        let mut differ = vec![false; pairs.len()];
        let unsure = |n: &usize| !self.slopes.surely_alike(pairs[*n][0], pairs[*n][1]);
        let doubtful: Vec<usize> = (0..pairs.len()).filter(unsure).collect();
        for chunk in doubtful.chunks(Compared::BATCH / 2) {
            let colors: ArrayVec<Color, { Compared::BATCH }> =
                chunk.iter().flat_map(|n| pairs[*n]).collect();
            let shown = Compared::batch(&colors, self.refinement);
            for (n, [a, b]) in chunk.iter().zip(shown.as_chunks().0) {
                differ[*n] = a.differs(*b, self.refinement);
            }
        }
        differ
    }
}

/// The quadrants in which the second pass of [`Sampling::Adaptive`] takes more samples of pixel `(x, y)` of the picture.
pub(crate) fn refined_quadrants(
    scene: &RenderScene,
    rays: &PrimaryRays,
    options: &RenderOptions,
    x: u32,
    y: u32,
) -> Result<Quadrants, RenderError> {
    let Sampling::Adaptive(refinement) = options.sampling else {
        return Ok(Quadrants::NONE);
    };
    if refinement.depth < 2 {
        return Ok(Quadrants::NONE);
    }
    let pixel = Region {
        x,
        y,
        width: 1,
        height: 1,
    };
    let comparison = Comparison::new(&refinement, options.trace.space());
    let mut tracer = PixelTracer::new(scene, rays, options, &());
    let tile = whole_tiles(pixel, options.width, options.height);
    let margin = tile.grown(1, options.width, options.height);
    let mut first = Lattice {
        region: margin,
        samples: try_filled(margin, Sample::BLACK)?,
    };
    for tile in tiles(margin, options.tile_order) {
        let result = tracer.centers(tile);
        for (place, sample) in tile.positions().zip(result.values) {
            first.put(place, sample);
        }
    }
    let rough = first.rough(&comparison)?;
    let result = tracer.refined(
        tile,
        &comparison,
        |x, y| rough[margin.index(x, y)],
        |x, y| first.at(x, y),
    );
    Ok(result.values[tile.index(x, y)].map_or(Quadrants::NONE, |(_, quadrants)| quadrants))
}

impl Lattice {
    /// Of each pixel whose first sample differs from that of the one to the left, right, above or below, the quadrants that lie towards neighbours from
    /// which it may differ by the threshold for quadrants (one of them across a corner); none of the other pixels.
    pub(super) fn rough(&self, comparison: &Comparison<'_>) -> Result<Vec<Quadrants>, RenderError> {
        let Comparison {
            refinement,
            slopes,
            quadrants: in_quadrants,
            space,
        } = comparison;
        let (region, space) = (self.region, *space);
        let mut rough = try_filled(region, Quadrants::NONE)?;
        if refinement.depth < 2 {
            return Ok(rough);
        }
        if refinement.threshold == 0.0 {
            rough.fill(Quadrants::ALL);
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
        let width = region.width as usize;
        let mut doubtful = Vec::<[usize; 2]>::new();
        for start in (0..self.samples.len()).step_by(width) {
            let (end, is_last) = (start + width, start + width == self.samples.len());
            for index in start..end {
                let here = color(index);
                if index + 1 < end && !slopes.surely_alike(here, color(index + 1)) {
                    doubtful.push([index, index + 1]);
                }
                if !is_last && !slopes.surely_alike(here, color(index + width)) {
                    doubtful.push([index, index + width]);
                }
            }
        }
        let pairs: Vec<[Color; 2]> = doubtful.iter().map(|pair| pair.map(color)).collect();
        for (pair, _) in doubtful
            .iter()
            .zip(comparison.differ(&pairs))
            .filter(|(_, d)| *d)
        {
            for index in pair {
                rough[*index] = Quadrants::ALL;
            }
        }
        let all = region.positions().zip(&mut rough);
        for ((x, y), quadrants) in all.filter(|(_, quadrants)| !quadrants.is_none()) {
            let here = color(region.index(x, y));
            // Beyond the edge of the picture there is nothing to differ from.
            *quadrants = Quadrants::towards(|right, down| {
                let (x, y) = (x.wrapping_add_signed(right), y.wrapping_add_signed(down));
                region.contains(x, y) && !in_quadrants.surely_alike(here, color(region.index(x, y)))
            });
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
