//! Traces the pixels of tiles on one thread.

use super::probe::Seen;
use super::{RenderOptions, Samples, TileResult};
use crate::activity::Phase;
use crate::camera::PrimaryRays;
use crate::cost::PixelCost;
use crate::coverage::Coverage;
use crate::film::{PixelInfo, Region};
use crate::observer::RayKind;
use crate::render::Progress;
use crate::sampling::Sample;
use crate::scene::RenderScene;
use crate::sight::{SQUARE, Sight};
use crate::tiles::TILE;
use crate::trace::{RayCounts, SampleResult, TreeTracer};
use arrayvec::ArrayVec;
use strahl_accel::{PACKET, TraversalStats};
use strahl_math::Ray;
use strahl_shade::Color;

/// Colours of four rows of a tile, traced in packets before the pixels are visited.
#[derive(Default)]
struct Ahead {
    x: u32,
    y: u32,
    /// Row by row, as wide as a tile.
    colors: Vec<Option<Color>>,
}

impl Ahead {
    /// Begins with empty rows from this position on.
    fn start(&mut self, x: u32, y: u32) {
        (self.x, self.y) = (x, y);
        self.colors.clear();
    }

    fn index(&self, x: u32, y: u32) -> usize {
        ((y.wrapping_sub(self.y)).wrapping_mul(TILE)).wrapping_add(x.wrapping_sub(self.x)) as usize
    }

    fn put(&mut self, x: u32, y: u32, color: Color) {
        let index = self.index(x, y);
        if self.colors.is_empty() {
            self.colors.resize((TILE * SQUARE) as usize, None);
        }
        if let Some(place) = self.colors.get_mut(index) {
            *place = Some(color);
        }
    }

    /// The colour of a pixel, if it was traced in a packet; it is removed.
    fn take(&mut self, x: u32, y: u32) -> Option<Color> {
        let index = self.index(x, y);
        self.colors.get_mut(index)?.take()
    }
}

/// Fewer samples of a pixel are traced one by one.
const FEW: usize = 4;

/// Traces pixels on one thread.
pub(super) struct PixelTracer<'s> {
    pub(super) tree: TreeTracer<'s>,
    rays: &'s PrimaryRays,
    options: &'s RenderOptions,
    progress: &'s dyn Progress,
    /// Of the pixels of the tile so far.
    infos: Vec<PixelInfo>,
    /// Deepest level of the trees of the pixel so far.
    depth: u32,
    /// Whether beam culling has shown that no ray of the pixel hits anything.
    blind: bool,
    /// Whether neighbouring rays are traced in packets.
    together: bool,
    /// Colours traced in packets.
    ahead: Ahead,
    /// For the alpha channel: what the last sample showed of the background.
    coverage: Option<Coverage>,
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
        let mut tree = TreeTracer::new(scene, options.trace);
        if let Some(activities) = progress.activities() {
            tree.tracer.slot = activities.slot();
            tree.tracer.slot.enter(Phase::Sampling);
            tree.tracer.slot.ray(RayKind::Primary);
        }
        Self {
            tree,
            rays,
            options,
            progress,
            infos: Vec::new(),
            depth: 0,
            blind: false,
            ahead: Ahead::default(),
            coverage: options
                .alpha
                .then(|| Coverage::new(scene.background.clone(), scene.background_alpha)),
            together: options.follows_together(rays),
            left: false,
        }
    }

    /// Whether the last tile was left half done, because the render is cancelled. What was traced of it is of no use.
    pub(super) const fn left_tile(&self) -> bool {
        self.left
    }

    /// Whether to leave the tile here: it may take seconds, and nobody wants it any more.
    fn leaves(&mut self) -> bool {
        self.left |= self.progress.cancelled();
        self.left
    }
}

impl Drop for PixelTracer<'_> {
    fn drop(&mut self) {
        self.tree.tracer.slot.idle();
    }
}

impl PixelTracer<'_> {
    /// Traces the pixels of a tile with `trace`. Where beam culling shows that all pixels of a square see the background,
    /// `blank` is called once with their number and returns the value of each, if it is the same for all.
    pub(super) fn tile<T: Clone>(
        &mut self,
        tile: Region,
        pass: u32,
        blank: impl Fn(&mut Self, u32) -> Option<T>,
        trace: impl Fn(&mut Self, u32, u32) -> T,
    ) -> TileResult<T> {
        self.start_tile();
        let mut costs = Vec::new();
        let sight = self.sight(tile);
        self.ahead.colors.clear();
        let mut pixel = |tracer: &mut Self, x: u32, y: u32| {
            if !tracer.options.costs {
                return trace(tracer, x, y);
            }
            let (value, cost) = tracer.measured(|tracer| trace(tracer, x, y));
            costs.push(cost);
            value
        };
        let mut values = Vec::with_capacity(tile.pixels() as usize);
        let place = self.options.sampling.common_place(pass);
        'tile: for y in tile.y..tile.y + tile.height {
            if let Some(place) = place
                && self.together
                && (y - tile.y).is_multiple_of(SQUARE)
            {
                self.look_ahead(tile, y, place, &sight);
            }
            let end = tile.x + tile.width;
            for left in (tile.x..end).step_by(SQUARE as usize) {
                if self.leaves() {
                    break 'tile;
                }
                let width = (end - left).min(SQUARE);
                self.blind = sight.is_empty(left, y);
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
        self.tile(
            tile,
            0,
            |tracer, pixels| Some(tracer.blank(pixels)?.sample()),
            |tracer, x, y| tracer.pixel(0, x, y).sample(),
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
        let small = tile.width <= TILE && tile.height <= TILE;
        let sight = small.then(|| self.sight(tile));
        let mut values = vec![Sample::NOTHING; points.len()];
        let mut costs = Vec::new();
        let mut packet = ArrayVec::<(usize, Option<Ray>), PACKET>::new();
        for (index, &(x, y)) in points.iter().enumerate() {
            if self.leaves() {
                break;
            }
            self.blind = sight.is_some_and(|sight| sight.is_empty(x, y));
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
                    self.trace_packet(&mut packet, &mut values);
                }
            } else if options.costs {
                let (value, cost) = self.measured(|tracer| tracer.sample(place.0, place.1, true));
                values[index] = value;
                costs.push(cost);
            } else {
                values[index] = self.sample(place.0, place.1, true);
            }
        }
        self.trace_packet(&mut packet, &mut values);
        if !corners {
            for value in &mut values {
                *value = Samples::NONE.with(*value).sample();
            }
        }
        self.end_tile(tile, Some(points), values, costs)
    }

    /// Traces numbered rays in a packet, which is then empty.
    fn trace_packet(
        &mut self,
        packet: &mut ArrayVec<(usize, Option<Ray>), PACKET>,
        values: &mut [Sample],
    ) {
        let rays: ArrayVec<Option<Ray>, PACKET> = packet.iter().map(|(_, ray)| *ray).collect();
        let colors = self.tree.trace_packet(&rays);
        for ((index, _), color) in packet.drain(..).zip(colors) {
            values[index] = color.into();
        }
    }

    /// Forgets what is known of the last tile.
    fn start_tile(&mut self) {
        self.tree.counts = RayCounts::default();
        self.tree.tracer.stats = TraversalStats::default();
        self.tree.tracer.forget_occluders();
    }

    fn end_tile<T>(
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
            traversal: self.tree.tracer.stats,
        }
    }

    /// The pixels of a tile that may see something. All of them where costs are shown, since these are the costs of single
    /// rays.
    fn sight(&self, tile: Region) -> Sight {
        let options = self.options;
        if options.trace.beams && !options.costs && !options.info && !options.alpha {
            Sight::of(tile, self.tree.tracer.scene, self.rays)
        } else {
            Sight::all(tile)
        }
    }

    /// The cost of the tile so far.
    fn spent(&self) -> PixelCost {
        let stats = self.tree.tracer.stats;
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
        let color = sample.color;
        Seen { color, cost }
    }

    /// The value that `trace` returns, and its cost.
    // Inline: a value that is returned in parts and then loaded as a whole would wait for the stores.
    #[inline(always)]
    fn measured<T>(&mut self, trace: impl FnOnce(&mut Self) -> T) -> (T, PixelCost) {
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

    /// The samples of each of `pixels` pixels in the first pass, if all of them see the same background colour.
    pub(super) fn blank(&mut self, pixels: u32) -> Option<Samples> {
        let each = self.options.sampling.places(0, 0, 0, 0).len();
        let color = self.tree.same_nothing(pixels as usize * each)?;
        let mut samples = Samples::NONE;
        for _ in 0..each {
            samples.sum += color;
            samples.count += 1;
        }
        Some(samples)
    }

    /// The samples of one pass of a pixel.
    // Inline: a value that is returned in parts and then loaded as a whole would wait for the stores.
    #[inline(always)]
    pub(super) fn pixel(&mut self, pass: u32, x: u32, y: u32) -> Samples {
        let mut samples = Samples::NONE;
        let options = self.options;
        let places = options.sampling.places(pass, x, y, options.seed);
        if let Some(color) = self.ahead.take(x, y) {
            samples.sum += color;
            samples.count += 1;
            return samples;
        }
        if self.together && !self.blind && places.len() >= FEW {
            self.samples_together(x, y, places, &mut samples);
            return samples;
        }
        for (dx, dy) in places {
            let keep = pass == 0 && samples.count == 0;
            let sample = self.sample(f64::from(x) + dx, f64::from(y) + dy, keep);
            samples.sum += sample.color;
            samples.clear += sample.clear;
            samples.count += 1;
        }
        samples
    }

    /// All samples of a pixel in the first pass, of which the first is known.
    pub(super) fn remaining(&mut self, first: Sample, x: u32, y: u32) -> Samples {
        let mut samples = Samples::NONE.with(first);
        let options = self.options;
        let places = options.sampling.places(0, x, y, options.seed).skip(1);
        if self.together && !self.blind && places.len() >= FEW {
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
            let few = places.by_ref().take(PACKET);
            let rays: ArrayVec<Option<Ray>, PACKET> = few
                .map(|(dx, dy)| self.rays.ray(f64::from(x) + dx, f64::from(y) + dy))
                .collect();
            for color in self.tree.trace_packet(&rays) {
                samples.sum += color;
                samples.count += 1;
            }
        }
    }

    /// Traces four rows of a tile in packets, square by square, through the same position in each pixel.
    fn look_ahead(&mut self, tile: Region, y: u32, place: (f64, f64), sight: &Sight) {
        self.ahead.start(tile.x, y);
        let bottom = (tile.y + tile.height).min(y + SQUARE);
        for left in (tile.x..tile.x + tile.width).step_by(SQUARE as usize) {
            if self.leaves() {
                return;
            }
            if sight.is_empty(left, y) {
                continue;
            }
            let square = Region {
                x: left,
                y,
                width: (tile.x + tile.width - left).min(SQUARE),
                height: bottom - y,
            };
            let rays: ArrayVec<Option<Ray>, PACKET> = square
                .positions()
                .map(|(x, y)| {
                    self.rays
                        .ray(f64::from(x) + place.0, f64::from(y) + place.1)
                })
                .collect();
            let colors = self.tree.trace_packet(&rays);
            for ((x, y), color) in square.positions().zip(colors) {
                self.ahead.put(x, y, color);
            }
        }
    }

    /// The colour at the corner of pixels, and what shows of the background.
    pub(super) fn corner(&mut self, x: u32, y: u32) -> Sample {
        if let Some(color) = self.ahead.take(x, y) {
            return color.into();
        }
        self.sample(f64::from(x), f64::from(y), true)
    }

    /// The radiance at a position in the picture; `keep` says whether to store the hit's other data for the pixel.
    pub(super) fn sample(&mut self, x: f64, y: f64, keep: bool) -> Sample {
        if self.options.has_packets() && !self.blind {
            let rays = self.rays;
            if let Some(color) = rays.blurred(x, y, |rays| self.tree.trace_packet(rays)) {
                return color.into();
            }
        }
        let mut clear = (0.0, 0u32);
        let mut coverage = self.coverage.take();
        let before = self.tree.tracer.stats.primitive_tests;
        let mut first = SampleResult::NOTHING;
        let (tree, depth, blind) = (&mut self.tree, &mut self.depth, self.blind);
        let color = self.rays.color(x, y, |ray| {
            let sample = if blind {
                tree.nothing(ray)
            } else if let Some(coverage) = &mut coverage {
                coverage.restart();
                let mut sample = tree.trace(ray, coverage);
                sample.color = tree.decoded(coverage.color);
                clear = (clear.0 + coverage.clear, clear.1 + 1);
                sample
            } else {
                tree.trace(ray, &mut ())
            };
            *depth = (*depth).max(sample.depth);
            if first.rays == 0 {
                first = sample;
            }
            sample.color
        });
        self.coverage = coverage;
        if keep && self.options.info {
            let tests = self.tree.tracer.stats.primitive_tests - before;
            self.infos.push(PixelInfo::new(&first, tests));
        }
        Sample {
            color,
            clear: clear.0 / f64::from(clear.1.max(1)),
        }
    }
}
