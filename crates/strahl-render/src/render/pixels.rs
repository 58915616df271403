//! Traces the pixels of tiles on one thread.

use super::{RenderOptions, Samples, TileResult};
use crate::activity::Phase;
use crate::beam::{BeamMask, SQUARE};
use crate::camera::PrimaryRays;
use crate::cost::PixelCost;
use crate::film::{PixelInfo, Region};
use crate::observer::RayKind;
use crate::render::Progress;
use crate::sampling::{Division, Refinement, Sample};
use crate::scene::RenderScene;
use crate::trace::{RayCounts, SampleResult, TraceSettings, TreeTracer};
use arrayvec::ArrayVec;
use strahl_accel::{PACKET, TraversalStats};
use strahl_math::Ray;
use strahl_shade::Color;

/// What a ray through the centre of a pixel has seen, and its cost.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// In linear light.
    pub(crate) color: Color,
    pub(crate) cost: PixelCost,
}

/// Rays with the numbers of what they are for.
pub(super) type Packet = ArrayVec<(usize, Option<Ray>), PACKET>;

/// The squares of a tile, row by row.
pub(super) fn squares(tile: Region) -> impl Iterator<Item = Region> {
    let (right, bottom) = (tile.x + tile.width, tile.y + tile.height);
    let rows = (tile.y..bottom).step_by(SQUARE as usize);
    let columns = (tile.x..right).step_by(SQUARE as usize);
    rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
        .map(move |(x, y)| Region {
            x,
            y,
            width: (right - x).min(SQUARE),
            height: (bottom - y).min(SQUARE),
        })
}

/// Fewer samples of a pixel are traced one by one.
const PACKET_SAMPLES_MIN: usize = 4;

/// Traces pixels on one thread.
pub(super) struct PixelTracer<'s> {
    pub(super) tree: TreeTracer<'s>,
    pub(super) rays: &'s PrimaryRays,
    pub(super) options: &'s RenderOptions,
    progress: &'s dyn Progress,
    /// Of the pixels of the tile so far.
    infos: Vec<PixelInfo>,
    /// Deepest level of the trees of the pixel so far.
    depth: u32,
    /// Whether beam culling has shown that no ray of the pixel hits anything.
    pub(super) blind: bool,
    /// Whether neighbouring rays are traced in packets.
    pub(super) together: bool,
    /// Whether positions in the picture have bundles of rays, which share packets with their neighbours.
    pub(super) bundled: bool,
    /// Whether the last tile was left half done, because the render is cancelled.
    left: bool,
}

impl<'s> PixelTracer<'s> {
    /// For one thread.
    pub(super) fn new(
        scene: &'s RenderScene,
        rays: &'s PrimaryRays,
        options: &'s RenderOptions,
        progress: &'s dyn Progress,
    ) -> Self {
        let settings = TraceSettings {
            packets: options.has_packets(),
            ..options.trace
        };
        let mut tree = TreeTracer::new(scene, settings).with_transport(&options.transport);
        if options.alpha {
            tree = tree.with_alpha();
        }
        if let Some(activities) = progress.activities() {
            tree.intersector.slot = activities.slot();
            tree.intersector.slot.enter(Phase::Sampling);
            tree.intersector.slot.ray(RayKind::Primary);
        }
        Self {
            tree,
            rays,
            options,
            progress,
            infos: Vec::new(),
            depth: 0,
            blind: false,
            together: options.follows_together(rays),
            bundled: options.has_packets() && !rays.is_sharp(),
            left: false,
        }
    }

    /// Whether the last tile was left half done, because the render is cancelled. What was traced of it is of no use.
    pub(super) const fn left_tile(&self) -> bool {
        self.left
    }

    /// Whether to leave the tile here: it may take seconds, and nobody wants it any more.
    pub(super) fn leaves(&mut self) -> bool {
        self.left |= self.progress.cancelled();
        self.left
    }
}

impl Drop for PixelTracer<'_> {
    fn drop(&mut self) {
        self.tree.intersector.slot.idle();
    }
}

impl PixelTracer<'_> {
    /// The pixels of a tile in the first pass: in packets where each has one place, otherwise with `trace`. `shown` makes a value of a
    /// sample; `blank` is that of [`PixelTracer::tile`].
    pub(super) fn first_pass<T: Clone>(
        &mut self,
        tile: Region,
        blank: impl Fn(&mut Self, u32) -> Option<T>,
        trace: impl Fn(&mut Self, u32, u32) -> T,
        shown: impl Fn(Sample) -> T,
    ) -> TileResult<T> {
        let place = self.options.sampling.common_place(0);
        let Some((dx, dy)) = place.filter(|_| self.together || self.bundled) else {
            return self.tile(tile, blank, trace);
        };
        self.start_tile();
        if self.bundled {
            let pixels: Vec<(u32, u32)> = squares(tile).flat_map(Region::positions).collect();
            let places = pixels
                .iter()
                .map(|&(x, y)| (f64::from(x) + dx, f64::from(y) + dy));
            let mut values = vec![shown(Sample::BLACK); pixels.len()];
            self.means(places, |number, sample| {
                let (x, y) = pixels[number];
                values[tile.index(x, y)] = shown(sample);
            });
            return self.end_tile(tile, None, values, Vec::new());
        }
        let mask = self.beam_mask(tile);
        let mut values = vec![shown(Sample::BLACK); tile.pixels() as usize];
        for square in squares(tile) {
            if self.leaves() {
                break;
            }
            self.blind = mask.is_empty(square.x, square.y);
            if self.blind {
                let same = blank(self, square.pixels() as u32);
                for y in square.y..square.y + square.height {
                    let row = &mut values[tile.index(square.x, y)..][..square.width as usize];
                    match &same {
                        Some(value) => row.fill(value.clone()),
                        None => {
                            for (x, place) in (square.x..).zip(row) {
                                *place = trace(self, x, y);
                            }
                        }
                    }
                }
                continue;
            }
            let rays = self.rays.of_square(square, (dx, dy));
            let samples = self.tree.trace_packet(&rays);
            let width = square.width as usize;
            for (y, samples) in (square.y..).zip(samples.chunks_exact(width)) {
                let row = &mut values[tile.index(square.x, y)..][..width];
                for (place, sample) in row.iter_mut().zip(samples) {
                    *place = shown(*sample);
                }
            }
        }
        self.end_tile(tile, None, values, Vec::new())
    }

    /// Traces the pixels of a tile with `trace`. Where beam culling shows that all pixels of a square see the background,
    /// `blank` is called once with their number and returns the value of each, if it is the same for all.
    pub(super) fn tile<T: Clone>(
        &mut self,
        tile: Region,
        blank: impl Fn(&mut Self, u32) -> Option<T>,
        trace: impl Fn(&mut Self, u32, u32) -> T,
    ) -> TileResult<T> {
        self.start_tile();
        let mut costs = Vec::new();
        let mask = self.beam_mask(tile);
        let mut pixel = |tracer: &mut Self, x: u32, y: u32| {
            if !tracer.options.costs {
                return trace(tracer, x, y);
            }
            let (value, cost) = tracer.measured(|tracer| trace(tracer, x, y));
            costs.push(cost);
            value
        };
        let mut values = Vec::with_capacity(tile.pixels() as usize);
        'tile: for y in tile.y..tile.y + tile.height {
            let end = tile.x + tile.width;
            for left in (tile.x..end).step_by(SQUARE as usize) {
                if self.leaves() {
                    break 'tile;
                }
                let width = (end - left).min(SQUARE);
                self.blind = mask.is_empty(left, y);
                if self.blind
                    && let Some(value) = blank(self, width)
                {
                    values.extend(std::iter::repeat_n(value, width as usize));
                } else {
                    values.extend((left..left + width).map(|x| pixel(self, x, y)));
                }
            }
        }
        self.end_tile(tile, None, values, costs)
    }

    /// The first samples of the pixels of a tile.
    pub(super) fn centers(&mut self, tile: Region) -> TileResult<Sample> {
        self.first_pass(
            tile,
            |tracer, pixels| Some(tracer.blank(pixels)?.sample()),
            |tracer, x, y| tracer.pixel(x, y).sample(),
            |sample| Samples::NONE.with(sample).sample(),
        )
    }

    /// Traces one ray through each of some pixels of a tile: that of its first sample, or that through its top left corner.
    pub(super) fn points(
        &mut self,
        tile: Region,
        points: Vec<(u32, u32)>,
        corners: bool,
    ) -> TileResult<Sample> {
        self.start_tile();
        let mask = self.beam_mask(tile);
        let mut values = vec![Sample::BLACK; points.len()];
        let mut costs = Vec::new();
        let mut packet = Packet::new();
        for (index, &(x, y)) in points.iter().enumerate() {
            if self.leaves() {
                break;
            }
            self.blind = mask.is_empty(x, y);
            let options = self.options;
            let (dx, dy) = match corners {
                true => (0.0, 0.0),
                false => options
                    .sampling
                    .places(0, x, y, options.seed)
                    .next()
                    .unwrap_or((0.5, 0.5)),
            };
            let place = (f64::from(x) + dx, f64::from(y) + dy);
            if self.together && !self.blind {
                packet.push((index, self.rays.ray(place.0, place.1)));
                if packet.is_full() {
                    self.trace_packet(&mut packet, |index, sample| values[index] = sample);
                }
            } else if options.costs {
                let (value, cost) = self.measured(|tracer| tracer.sample(place.0, place.1, true));
                values[index] = value;
                costs.push(cost);
            } else {
                values[index] = self.sample(place.0, place.1, true);
            }
        }
        self.trace_packet(&mut packet, |index, sample| values[index] = sample);
        if !corners {
            for value in &mut values {
                *value = Samples::NONE.with(*value).sample();
            }
        }
        self.end_tile(tile, Some(points), values, costs)
    }

    /// The means of the pixels of a tile that are divided because their corners differ.
    pub(super) fn divided(
        &mut self,
        tile: Region,
        refinement: &Refinement,
        corners: impl Fn(u32, u32) -> [Sample; 4],
    ) -> TileResult<Option<Sample>> {
        self.start_tile();
        let space = self.options.trace.space();
        let mut values = vec![None; tile.pixels() as usize];
        let mut costs = Vec::new();
        let differ = |&(x, y): &(u32, u32)| {
            let corners = corners(x, y);
            corners.iter().any(|c| c.color != corners[0].color)
        };
        // Most pixels have four equal corners.
        let wanted: Vec<(u32, u32)> = tile.positions().filter(differ).collect();
        let mut together = Division::pixels_at_once(refinement);
        if self.options.costs {
            // The cost of a pixel is that of its own rays.
            together = 1;
            costs = vec![PixelCost::default(); values.len()];
        }
        let mask = self.beam_mask(tile);
        for pixels in wanted.chunks(together) {
            let mut division = Division::new(refinement, space);
            for &(x, y) in pixels {
                division.add((x - tile.x, y - tile.y), corners(x, y));
            }
            let (means, cost) = self
                .measured(|tracer| division.means(|places| tracer.samples_in(tile, &mask, places)));
            let Some(means) = means else {
                break;
            };
            for (&(x, y), mean) in pixels.iter().zip(means) {
                values[tile.index(x, y)] = Some(mean);
                if let Some(place) = costs.get_mut(tile.index(x, y)) {
                    *place = cost;
                }
            }
        }
        self.end_tile(tile, None, values, costs)
    }

    /// The samples at places in a tile, given in pixels from its top left corner; `None` if the tile is left.
    fn samples_in(
        &mut self,
        tile: Region,
        mask: &BeamMask,
        places: &[(f64, f64)],
    ) -> Option<Vec<Sample>> {
        let mut samples = vec![Sample::BLACK; places.len()];
        let mut packet = Packet::new();
        for (number, (dx, dy)) in places.iter().enumerate() {
            if number.is_multiple_of(PACKET) && self.leaves() {
                return None;
            }
            let (x, y) = (f64::from(tile.x) + dx, f64::from(tile.y) + dy);
            let last = (tile.x + tile.width - 1, tile.y + tile.height - 1);
            self.blind = mask.is_empty((x as u32).min(last.0), (y as u32).min(last.1));
            if self.together && !self.blind {
                packet.push((number, self.rays.ray(x, y)));
                if packet.is_full() {
                    self.trace_packet(&mut packet, |number, sample| samples[number] = sample);
                }
            } else {
                samples[number] = self.sample(x, y, false);
            }
        }
        self.trace_packet(&mut packet, |number, sample| samples[number] = sample);
        Some(samples)
    }

    /// Traces numbered rays in a packet, which is then empty.
    pub(super) fn trace_packet(&mut self, packet: &mut Packet, mut put: impl FnMut(usize, Sample)) {
        let mut rays = ArrayVec::<Option<Ray>, PACKET>::new();
        rays.extend(packet.iter().map(|(_, ray)| *ray));
        let samples = self.tree.trace_packet(&rays);
        for ((index, _), sample) in packet.drain(..).zip(samples) {
            put(index, *sample);
        }
    }

    /// Forgets what is known of the last tile.
    pub(super) fn start_tile(&mut self) {
        self.tree.counts = RayCounts::default();
        self.tree.intersector.stats = TraversalStats::default();
        self.tree.intersector.forget_occluders();
    }

    pub(super) fn end_tile<T>(
        &mut self,
        tile: Region,
        points: Option<Vec<(u32, u32)>>,
        values: Vec<T>,
        costs: Vec<PixelCost>,
    ) -> TileResult<T> {
        TileResult {
            tile,
            points,
            values,
            costs,
            infos: std::mem::take(&mut self.infos),
            counts: self.tree.counts,
            traversal: self.tree.intersector.stats,
        }
    }

    /// The pixels of a tile that may see something. All of them where costs are shown, since these are the costs of single
    /// rays.
    pub(super) fn beam_mask(&self, tile: Region) -> BeamMask {
        let options = self.options;
        if options.trace.beams && !options.costs && !options.info {
            BeamMask::of(tile, self.tree.intersector.scene, self.rays)
        } else {
            BeamMask::all(tile)
        }
    }

    /// The cost of the tile so far.
    fn spent(&self) -> PixelCost {
        let stats = self.tree.intersector.stats;
        PixelCost {
            tests: stats.primitive_tests,
            steps: stats.node_visits,
            rays: self.tree.counts.total(),
            ..PixelCost::default()
        }
    }

    /// What the ray through the centre of a pixel sees, and its cost.
    pub(super) fn probe(&mut self, x: u32, y: u32) -> Seen {
        let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        let (sample, cost) = self.measured(|tracer| tracer.sample(x, y, false));
        let color = self.options.trace.space().decode(sample.color);
        Seen { color, cost }
    }

    /// The value that `trace` returns, and its cost.
    // Inline: a value that is returned in parts and then loaded as a whole would wait for the stores.
    #[inline(always)]
    pub(super) fn measured<T>(&mut self, trace: impl FnOnce(&mut Self) -> T) -> (T, PixelCost) {
        let (before, start) = (self.spent(), self.progress.now());
        self.depth = 0;
        let value = trace(self);
        let nanoseconds = self.progress.now().saturating_sub(start);
        let after = self.spent();
        let cost = PixelCost {
            tests: after.tests - before.tests,
            steps: after.steps - before.steps,
            rays: after.rays - before.rays,
            depth: self.depth,
            nanoseconds,
        };
        (value, cost)
    }

    /// The samples of each of `pixels` pixels in the first pass, if all of them see the same of the background.
    pub(super) fn blank(&mut self, pixels: u32) -> Option<Samples> {
        let each = self.options.sampling.places(0, 0, 0, 0).len();
        let sample = self.tree.uniform_miss(pixels as usize * each)?;
        let mut samples = Samples::NONE;
        for _ in 0..each {
            samples.add(sample);
        }
        Some(samples)
    }

    /// The samples of a pixel in the first pass.
    // Inline: a value that is returned in parts and then loaded as a whole would wait for the stores.
    #[inline(always)]
    pub(super) fn pixel(&mut self, x: u32, y: u32) -> Samples {
        let mut samples = Samples::NONE;
        let options = self.options;
        let places = options.sampling.places(0, x, y, options.seed);
        if self.together && !self.blind && places.len() >= PACKET_SAMPLES_MIN {
            self.samples_together(x, y, places, &mut samples);
            return samples;
        }
        for (dx, dy) in places {
            let keep = samples.count == 0;
            samples.add(self.sample(f64::from(x) + dx, f64::from(y) + dy, keep));
        }
        samples
    }

    /// All samples of a pixel in the first pass, of which the first is known.
    pub(super) fn remaining(&mut self, first: Sample, x: u32, y: u32) -> Samples {
        let mut samples = Samples::NONE.with(first);
        let options = self.options;
        let places = options.sampling.places(0, x, y, options.seed).skip(1);
        if self.together && !self.blind && places.len() >= PACKET_SAMPLES_MIN {
            self.samples_together(x, y, places, &mut samples);
            return samples;
        }
        for (dx, dy) in places {
            let sample = self.sample(f64::from(x) + dx, f64::from(y) + dy, false);
            samples = samples.with(sample);
        }
        samples
    }

    /// Adds the samples of a pixel, traced in packets.
    fn samples_together(
        &mut self,
        x: u32,
        y: u32,
        places: impl Iterator<Item = (f64, f64)>,
        samples: &mut Samples,
    ) {
        let mut places = places.peekable();
        while places.peek().is_some() {
            let next = places.by_ref().take(PACKET);
            let rays: ArrayVec<Option<Ray>, PACKET> = next
                .map(|(dx, dy)| self.rays.ray(f64::from(x) + dx, f64::from(y) + dy))
                .collect();
            for sample in self.tree.trace_packet(&rays) {
                samples.add(*sample);
            }
        }
    }

    /// The colour at the corner of pixels, and what shows of the background.
    pub(super) fn corner(&mut self, x: u32, y: u32) -> Sample {
        self.sample(f64::from(x), f64::from(y), true)
    }

    /// The radiance at a position in the picture; `keep` says whether to store the hit's other data for the pixel.
    pub(super) fn sample(&mut self, x: f64, y: f64, keep: bool) -> Sample {
        if self.bundled {
            let mut mean = Sample::BLACK;
            self.means([(x, y)].into_iter(), |_, sample| mean = sample);
            return mean;
        }
        let mut clear = (0.0, 0u32);
        let before = self.tree.intersector.stats.primitive_tests;
        let mut first = SampleResult::NOTHING;
        let (tree, depth, blind) = (&mut self.tree, &mut self.depth, self.blind);
        let color = self.rays.color(x, y, |ray| {
            let sample = if blind {
                tree.miss(ray)
            } else {
                tree.trace(ray, &mut ())
            };
            clear = (clear.0 + sample.clear, clear.1 + 1);
            *depth = (*depth).max(sample.depth);
            if first.rays == 0 {
                first = sample;
            }
            sample.color
        });
        if keep && self.options.info {
            let tests = self.tree.intersector.stats.primitive_tests - before;
            self.infos.push(PixelInfo::new(&first, tests));
        }
        Sample {
            color,
            clear: clear.0 / f64::from(clear.1.max(1)),
        }
    }
}
