//! Adaptive antialiasing: which pixels the first pass finds too rough.

use super::{Lattice, PixelTracer, RenderError, RenderOptions};
use crate::camera::PrimaryRays;
use crate::film::{Region, try_filled};
use crate::sampling::{Compared, Refinement, Sample, Sampling, Slopes};
use crate::scene::RenderScene;
use crate::tiles::{tiles, whole_tiles};
use arrayvec::ArrayVec;
use strahl_scene::WorkingSpace;
use strahl_shade::Color;

/// How the colours of neighbours are compared: in linear light, as in POV-Ray (measured).
pub(super) struct Comparison<'a> {
    refinement: &'a Refinement,
    slopes: Slopes,
    space: WorkingSpace,
}

impl<'a> Comparison<'a> {
    pub(super) fn new(refinement: &'a Refinement, space: WorkingSpace) -> Self {
        Self {
            refinement,
            slopes: Slopes::new(refinement),
            space,
        }
    }

    /// The pixels of a tile, without a value yet, whose first samples differ from the means of refined neighbours. They get the first sample as their
    /// value. POV-Ray compares with such means of the neighbours to the left and above (measured).
    pub(super) fn want_beside(
        &self,
        tile: Region,
        refined: &[(u32, u32)],
        values: &mut [Option<Sample>],
        first: impl Fn(u32, u32) -> Sample,
    ) -> Vec<(u32, u32)> {
        let mut wanted = Vec::new();
        for &(x, y) in refined {
            let beside = [
                (x.wrapping_sub(1), y),
                (x + 1, y),
                (x, y.wrapping_sub(1)),
                (x, y + 1),
            ];
            let is_open =
                |&(x, y): &(u32, u32)| tile.contains(x, y) && values[tile.index(x, y)].is_none();
            let open: ArrayVec<(u32, u32), 4> = beside.into_iter().filter(is_open).collect();
            let Some(mean) = values[tile.index(x, y)].filter(|_| !open.is_empty()) else {
                continue;
            };
            let mut colors = ArrayVec::<Color, 5>::from_iter([mean.color]);
            colors.extend(open.iter().map(|&(x, y)| first(x, y).color));
            self.space.decode_all(&mut colors);
            for (&(x, y), color) in open.iter().zip(&colors[1..]) {
                if self.differ(colors[0], *color) {
                    values[tile.index(x, y)] = Some(first(x, y));
                    wanted.push((x, y));
                }
            }
        }
        wanted
    }

    fn differ(&self, a: Color, b: Color) -> bool {
        !self.slopes.surely_alike(a, b) && {
            let shown = Compared::few(&[a, b], self.refinement);
            shown[0].differs(shown[1], self.refinement)
        }
    }
}

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
    if refinement.depth < 2 {
        return Ok(false);
    }
    let pixel = Region {
        x,
        y,
        width: 1,
        height: 1,
    };
    let comparison = Comparison::new(&refinement, options.trace.space());
    let mut tracer = PixelTracer::new(scene, rays, options, &());
    // Few pixels decide about most; about the others the whole tile does.
    let tile = whole_tiles(pixel, options.width, options.height);
    for region in [pixel, tile] {
        let margin = region.grown(1, options.width, options.height);
        let mut first = Lattice {
            region: margin,
            samples: try_filled(margin, Sample::NOTHING)?,
        };
        for tile in tiles(margin, options.tile_order) {
            let result = tracer.centers(tile);
            for (place, sample) in tile.positions().zip(result.values) {
                first.put(place, sample);
            }
        }
        let rough = first.rough(&comparison)?;
        let result = tracer.refined(
            region,
            &comparison,
            |x, y| rough[margin.index(x, y)],
            |x, y| first.at(x, y),
        );
        if result.values[region.index(x, y)].is_some() {
            return Ok(true);
        }
    }
    Ok(false)
}

impl Lattice {
    /// The pixels whose first sample differs from that of the one to the left, right, above or below.
    pub(super) fn rough(&self, comparison: &Comparison<'_>) -> Result<Vec<bool>, RenderError> {
        let Comparison {
            refinement,
            slopes,
            space,
        } = comparison;
        let (region, space) = (self.region, *space);
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
