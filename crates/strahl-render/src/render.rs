use crate::camera::PrimaryRays;
use crate::cost::PixelCost;
use crate::film::{Film, FilmError, PixelInfo, Region, try_filled};
use crate::sampling::{Sampling, contrast};
use crate::scene::RenderScene;
use crate::sight::{SQUARE, Sight};
use crate::tiles::{TILE, TileOrder, tiles};
use crate::trace::{RayCounts, SampleResult, TraceSettings, TreeTracer};
use arrayvec::ArrayVec;
use std::sync::atomic::{AtomicUsize, Ordering};
use strahl_accel::{PACKET, TraversalStats};
use strahl_math::Ray;
use strahl_shade::Color;

/// How to render.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOptions {
    /// Width of the whole picture in pixels.
    pub width: u32,
    /// Height of the whole picture in pixels.
    pub height: u32,
    /// The part to render; `None` is all of it. Its pixels are the same as those of the whole picture.
    pub region: Option<Region>,
    /// Where rays go through the pixels.
    pub sampling: Sampling,
    /// Seed of the sampling.
    pub seed: u64,
    /// Number of threads; 0 takes one per processor.
    pub threads: usize,
    /// Order of the tiles.
    pub tile_order: TileOrder,
    /// How trees are grown.
    pub trace: TraceSettings,
    /// Whether to fill [`Film::info`].
    pub info: bool,
    /// Whether to fill [`Rendered::costs`].
    pub costs: bool,
}

impl RenderOptions {
    /// What the scene asks for, at this size, one ray per pixel, on all processors.
    pub fn new(scene: &RenderScene, width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            region: None,
            sampling: Sampling::Center,
            seed: 0,
            threads: 0,
            tile_order: TileOrder::Rows,
            trace: TraceSettings::of(scene),
            info: false,
            costs: false,
        }
    }

    /// Whether rays that lie together are followed together. Costs that are shown are those of rays that are followed one by one.
    fn follows_together(&self, rays: &PrimaryRays) -> bool {
        self.trace.packets && !self.costs && !self.info && rays.is_sharp()
    }

    /// The part of the picture that the film holds.
    fn film_region(&self) -> Region {
        let whole = Region::full(self.width, self.height);
        self.region.unwrap_or(whole)
    }
}

/// Hears how far a render is, and may end it. Called from several threads.
pub trait Progress: Sync {
    /// A pass begins; it has this many tiles.
    fn pass(&self, _pass: u32, _of: u32, _tiles: usize) {}

    /// A tile is done; it took this many rays.
    fn tile(&self, _rays: u64) {}

    /// A clock in nanoseconds, for the time each pixel takes: nothing here reads the clock itself.
    fn now(&self) -> u64 {
        0
    }

    /// Whether to stop at the next tile.
    fn cancelled(&self) -> bool {
        false
    }
}

impl Progress for () {}

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// There can't be such a picture.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// [`Progress::cancelled`] said so.
    #[error("cancelled")]
    Cancelled,
    /// The system gives no threads.
    #[error("cannot start {0} threads: {1}")]
    Threads(usize, String),
}

/// A finished picture with what it cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendered {
    /// The picture.
    pub film: Film,
    /// Rays followed.
    pub rays: RayCounts,
    /// What finding their hits cost.
    pub traversal: TraversalStats,
    /// Threads used.
    pub threads: usize,
    /// What each pixel of the film cost, row by row, if asked for. A picture of corners has the cost of a pixel's top left
    /// corner.
    pub costs: Option<Vec<PixelCost>>,
}

/// Renders a picture.
///
/// # Errors
/// [`RenderError`]: no such picture, no memory, no threads, or cancelled.
pub fn render(
    scene: &RenderScene,
    options: &RenderOptions,
    progress: &dyn Progress,
) -> Result<Rendered, RenderError> {
    let mut film = Film::try_new(options.width, options.height, options.region, options.info)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build()
        .map_err(|e| RenderError::Threads(options.threads, e.to_string()))?;
    let mut job = Job {
        scene,
        options,
        progress,
        rays: PrimaryRays::new(scene.camera(), options.width, options.height),
        counts: RayCounts::default(),
        traversal: TraversalStats::default(),
        costs: match options.costs {
            true => Some(try_filled(film.region, PixelCost::default())?),
            false => None,
        },
    };
    pool.install(|| match options.sampling {
        Sampling::Corners => job.corners(&mut film),
        Sampling::Adaptive { threshold, passes } => job.adaptive(&mut film, threshold, passes),
        Sampling::Center | Sampling::Grid(_) => job.single_pass(&mut film),
    })?;
    let threads = pool.current_num_threads();
    Ok(Rendered {
        film,
        rays: job.counts,
        traversal: job.traversal,
        threads,
        costs: job.costs,
    })
}

/// The refining passes that look at pixel `(x, y)` of the picture.
pub(crate) fn passes_of_pixel(
    scene: &RenderScene,
    options: &RenderOptions,
    x: u32,
    y: u32,
) -> Result<Vec<u32>, RenderError> {
    let Sampling::Adaptive { threshold, passes } = options.sampling else {
        return Ok(vec![]);
    };
    let rays = PrimaryRays::new(scene.camera(), options.width, options.height);
    let (counts, traversal) = (RayCounts::default(), TraversalStats::default());
    let mut job = Job {
        scene,
        options,
        progress: &(),
        rays,
        counts,
        traversal,
        costs: None,
    };
    let pixel = Region {
        x,
        y,
        width: 1,
        height: 1,
    };
    let (wide, all) = job.refined(pixel, threshold, passes, |_, _| {})?;
    let bits = all[wide.index(x, y)].passes;
    Ok((1..=passes).filter(|pass| bits >> pass & 1 == 1).collect())
}

struct Job<'a> {
    scene: &'a RenderScene,
    options: &'a RenderOptions,
    progress: &'a dyn Progress,
    rays: PrimaryRays,
    counts: RayCounts,
    traversal: TraversalStats,
    /// Of the pixels of the film.
    costs: Option<Vec<PixelCost>>,
}

/// What a tile brings home.
struct TileResult<T> {
    tile: Region,
    values: Vec<T>,
    /// One for each value, if asked for.
    infos: Vec<PixelInfo>,
    /// One for each value, if asked for.
    costs: Vec<PixelCost>,
    counts: RayCounts,
    traversal: TraversalStats,
}

/// The samples of a pixel so far.
#[derive(Clone, Copy, Debug)]
struct Samples {
    sum: Color,
    count: u32,
    /// The refining passes that looked at it, as bits.
    passes: u32,
}

impl Samples {
    const NONE: Self = Self {
        sum: Color::BLACK,
        count: 0,
        passes: 0,
    };

    fn mean(&self) -> Color {
        if self.count == 1 {
            self.sum
        } else {
            self.sum / f64::from(self.count)
        }
    }
}

impl Job<'_> {
    /// Traces the tiles of a region on all threads and hands each finished tile to `store`.
    fn tiles<T: Send>(
        &mut self,
        region: Region,
        pass: u32,
        trace: impl Fn(&mut PixelTracer<'_>, u32, u32) -> T + Sync,
        mut store: impl FnMut(TileResult<T>),
    ) -> Result<(), RenderError> {
        // In batches, so that a large picture does not wait in memory twice.
        const BATCH: usize = 1024;
        let all = tiles(region, self.options.tile_order);
        self.progress
            .pass(pass, 1 + self.options.sampling.passes(), all.len());
        let (scene, options, progress) = (self.scene, self.options, self.progress);
        let rays = &self.rays;
        for batch in all.chunks(BATCH) {
            // Whoever is free takes the next tile.
            let next = AtomicUsize::new(0);
            let results = rayon::broadcast(|_| {
                let mut tracer = PixelTracer {
                    tree: TreeTracer::new(scene, options.trace),
                    rays,
                    options,
                    progress,
                    infos: Vec::new(),
                    depth: 0,
                    blind: false,
                    ahead: Ahead::default(),
                    together: options.follows_together(rays),
                };
                let mut done = Vec::new();
                while !progress.cancelled() {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    let Some(tile) = batch.get(number) else { break };
                    let result = tracer.tile(*tile, pass, &trace);
                    progress.tile(result.counts.total());
                    done.push((number, result));
                }
                done
            });
            let mut results: Vec<_> = results.into_iter().flatten().collect();
            if results.len() < batch.len() {
                return Err(RenderError::Cancelled);
            }
            results.sort_by_key(|(number, _)| *number);
            for (_, result) in results {
                self.counts += result.counts;
                self.traversal += result.traversal;
                if let Some(all) = &mut self.costs {
                    let film = options.film_region();
                    for ((x, y), cost) in result.tile.positions().zip(&result.costs) {
                        if film.contains(x, y) {
                            all[film.index(x, y)] += *cost;
                        }
                    }
                }
                store(result);
            }
        }
        Ok(())
    }

    /// One pass is the picture.
    fn single_pass(&mut self, film: &mut Film) -> Result<(), RenderError> {
        let region = film.region;
        self.tiles(
            region,
            0,
            |tracer, x, y| tracer.pixel(0, x, y).mean().to_f32(),
            |result| {
                film.set_infos(result.tile, &result.infos);
                film.set_tile(result.tile, &result.values);
            },
        )
    }

    /// The lattice of pixel corners first, then every pixel as the mean of its four.
    fn corners(&mut self, film: &mut Film) -> Result<(), RenderError> {
        let region = film.region;
        let lattice = Region {
            width: region.width + 1,
            height: region.height + 1,
            ..region
        };
        let mut corners = try_filled(lattice, Color::BLACK)?;
        self.tiles(
            lattice,
            0,
            |tracer, x, y| tracer.corner(x, y),
            |result| {
                film.set_infos(result.tile, &result.infos);
                for ((x, y), value) in result.tile.positions().zip(result.values) {
                    corners[lattice.index(x, y)] = value;
                }
            },
        )?;
        for (x, y) in region.positions() {
            let at = |dx, dy| corners[lattice.index(x + dx, y + dy)];
            film.set((x, y), (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) / 4.0);
        }
        Ok(())
    }

    /// Refines the pixels that differ from a neighbour. Decisions are taken between complete passes over the region and a
    /// margin wide enough for all later decisions, so they don't depend on tiles or regions.
    fn adaptive(
        &mut self,
        film: &mut Film,
        threshold: f64,
        passes: u32,
    ) -> Result<(), RenderError> {
        let region = film.region;
        let (wide, all) = self.refined(region, threshold, passes, |tile, infos| {
            film.set_infos(tile, infos);
        })?;
        for (x, y) in region.positions() {
            film.set((x, y), all[wide.index(x, y)].mean());
        }
        Ok(())
    }

    /// The samples of a region and the margin around it; `keep` takes what is known of the first sample of each pixel.
    fn refined(
        &mut self,
        region: Region,
        threshold: f64,
        passes: u32,
        mut keep: impl FnMut(Region, &[PixelInfo]),
    ) -> Result<(Region, Vec<Samples>), RenderError> {
        let (width, height) = (self.options.width, self.options.height);
        let wide = region.grown(passes, width, height);
        let mut all = try_filled(wide, Samples::NONE)?;
        self.tiles(
            wide,
            0,
            |tracer, x, y| tracer.pixel(0, x, y),
            |result| {
                keep(result.tile, &result.infos);
                for ((x, y), samples) in result.tile.positions().zip(result.values) {
                    all[wide.index(x, y)] = samples;
                }
            },
        )?;
        for pass in 1..=passes {
            let part = region.grown(passes - pass, width, height);
            let before = all.clone();
            let mean = |x: u32, y: u32| before[wide.index(x, y)].mean();
            let rough = |x: u32, y: u32| {
                let neighbours = Region {
                    x,
                    y,
                    width: 1,
                    height: 1,
                }
                .grown(1, width, height);
                neighbours
                    .positions()
                    .any(|(nx, ny)| contrast(mean(x, y), mean(nx, ny)) > threshold)
            };
            let refine = |tracer: &mut PixelTracer<'_>, x: u32, y: u32| {
                rough(x, y).then(|| tracer.pixel(pass, x, y))
            };
            self.tiles(part, pass, refine, |result| {
                for ((x, y), more) in result.tile.positions().zip(result.values) {
                    if let Some(more) = more {
                        let samples = &mut all[wide.index(x, y)];
                        samples.sum += more.sum;
                        samples.count += more.count;
                        samples.passes |= 1 << pass;
                    }
                }
            })?;
        }
        Ok((wide, all))
    }
}

impl Region {
    /// The pixels, row by row.
    pub(crate) fn positions(self) -> impl Iterator<Item = (u32, u32)> {
        (self.y..self.y + self.height)
            .flat_map(move |y| (self.x..self.x + self.width).map(move |x| (x, y)))
    }
}

impl Film {
    fn set(&mut self, (x, y): (u32, u32), color: Color) {
        let index = self.region.index(x, y);
        self.pixels[index] = color.to_f32();
    }

    /// Takes over the pixels of a tile that lies in the film.
    fn set_tile(&mut self, tile: Region, values: &[[f32; 3]]) {
        let width = tile.width as usize;
        for (y, row) in (tile.y..).zip(values.chunks_exact(width)) {
            let start = self.region.index(tile.x, y);
            self.pixels[start..start + width].copy_from_slice(row);
        }
    }

    /// Keeps what is known of the pixels of a tile, as far as they lie in the film.
    fn set_infos(&mut self, tile: Region, infos: &[PixelInfo]) {
        if let Some(list) = &mut self.info {
            for ((x, y), info) in tile.positions().zip(infos) {
                if self.region.contains(x, y) {
                    list[self.region.index(x, y)] = *info;
                }
            }
        }
    }
}

/// What was found out of some rows of a tile before their pixels are looked at.
#[derive(Default)]
struct Ahead {
    x: u32,
    y: u32,
    /// Row by row, each as wide as a tile may be.
    colors: Vec<Option<Color>>,
}

impl Ahead {
    /// Begins with the rows below a place.
    fn start(&mut self, x: u32, y: u32) {
        (self.x, self.y) = (x, y);
        self.colors.clear();
        self.colors.resize((TILE * SQUARE) as usize, None);
    }

    fn index(&self, x: u32, y: u32) -> usize {
        ((y.wrapping_sub(self.y)).wrapping_mul(TILE)).wrapping_add(x.wrapping_sub(self.x)) as usize
    }

    fn put(&mut self, x: u32, y: u32, color: Color) {
        let index = self.index(x, y);
        if let Some(place) = self.colors.get_mut(index) {
            *place = Some(color);
        }
    }

    /// What is known of a pixel, once.
    fn take(&mut self, x: u32, y: u32) -> Option<Color> {
        let index = self.index(x, y);
        self.colors.get_mut(index)?.take()
    }
}

/// Fewer samples of a pixel are followed one by one.
const FEW: usize = 4;

/// Traces pixels on one thread.
struct PixelTracer<'s> {
    tree: TreeTracer<'s>,
    rays: &'s PrimaryRays,
    options: &'s RenderOptions,
    progress: &'s dyn Progress,
    /// Of the pixels of the tile so far.
    infos: Vec<PixelInfo>,
    /// Deepest level of the trees of the pixel so far.
    depth: u32,
    /// Whether no ray of the pixel meets anything.
    blind: bool,
    /// Whether rays that lie together are followed together.
    together: bool,
    /// What was found out before the pixel is looked at.
    ahead: Ahead,
}

impl PixelTracer<'_> {
    fn tile<T>(
        &mut self,
        tile: Region,
        pass: u32,
        trace: impl Fn(&mut Self, u32, u32) -> T,
    ) -> TileResult<T> {
        self.tree.counts = RayCounts::default();
        self.tree.tracer.stats = TraversalStats::default();
        self.tree.tracer.forget_occluders();
        let mut costs = Vec::new();
        let sight = self.sight(tile);
        self.ahead.colors.clear();
        let mut pixel = |tracer: &mut Self, x: u32, y: u32| {
            tracer.blind = sight.is_empty(x, y);
            if !tracer.options.costs {
                return trace(tracer, x, y);
            }
            let (before, start) = (tracer.spent(), tracer.progress.now());
            tracer.depth = 0;
            let value = trace(tracer, x, y);
            let after = tracer.spent();
            costs.push(PixelCost {
                tests: after.tests - before.tests,
                steps: after.steps - before.steps,
                rays: after.rays - before.rays,
                depth: tracer.depth,
                nanoseconds: tracer.progress.now().saturating_sub(start),
            });
            value
        };
        let mut values = Vec::with_capacity(tile.pixels() as usize);
        let place = self.options.sampling.common_place(pass);
        for y in tile.y..tile.y + tile.height {
            if let Some(place) = place
                && self.together
                && (y - tile.y).is_multiple_of(SQUARE)
            {
                self.look_ahead(tile, y, place, &sight);
            }
            values.extend((tile.x..tile.x + tile.width).map(|x| pixel(self, x, y)));
        }
        TileResult {
            tile,
            values,
            costs,
            infos: std::mem::take(&mut self.infos),
            counts: self.tree.counts,
            traversal: self.tree.tracer.stats,
        }
    }

    /// What may be seen of a tile. Costs that are shown are those of rays that are followed one by one.
    fn sight(&self, tile: Region) -> Sight {
        let options = self.options;
        if options.trace.beams && !options.costs && !options.info {
            Sight::of(tile, self.tree.tracer.scene, self.rays)
        } else {
            Sight::all(tile)
        }
    }

    /// What the tile has cost so far.
    fn spent(&self) -> PixelCost {
        let stats = self.tree.tracer.stats;
        PixelCost {
            tests: stats.primitive_tests,
            steps: stats.node_visits,
            rays: self.tree.counts.total(),
            ..PixelCost::default()
        }
    }

    /// The samples of one pass of a pixel.
    // Inline: what is returned in pieces and read as a whole would wait for the stores.
    #[inline(always)]
    fn pixel(&mut self, pass: u32, x: u32, y: u32) -> Samples {
        let mut samples = Samples::NONE;
        let options = self.options;
        let places = options.sampling.places(pass, x, y, options.seed);
        if self.blind
            && let Some(color) = self.tree.same_nothing(places.len())
        {
            for _ in places {
                samples.sum += color;
                samples.count += 1;
            }
            return samples;
        }
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
            samples.sum += self.sample(f64::from(x) + dx, f64::from(y) + dy, keep);
            samples.count += 1;
        }
        samples
    }

    /// Adds the samples of a pixel, which lie close together.
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
            for color in self.follow(&rays) {
                samples.sum += color;
                samples.count += 1;
            }
        }
    }

    /// The colours that rays bring; where the camera sees nothing there is none.
    fn follow(&mut self, rays: &[Option<Ray>]) -> ArrayVec<Color, PACKET> {
        let all: ArrayVec<Ray, PACKET> = rays.iter().copied().flatten().collect();
        let mut colors = self.tree.trace_together(&all).into_iter();
        let each = rays.iter();
        each.map(|ray| ray.and_then(|_| colors.next()).unwrap_or(Color::BLACK))
            .collect()
    }

    /// Finds out the colours of four rows of a tile, in squares of pixels, at the same place in each.
    fn look_ahead(&mut self, tile: Region, y: u32, place: (f64, f64), sight: &Sight) {
        self.ahead.start(tile.x, y);
        let bottom = (tile.y + tile.height).min(y + SQUARE);
        for left in (tile.x..tile.x + tile.width).step_by(SQUARE as usize) {
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
            let colors = self.follow(&rays);
            for ((x, y), color) in square.positions().zip(colors) {
                self.ahead.put(x, y, color);
            }
        }
    }

    fn corner(&mut self, x: u32, y: u32) -> Color {
        if self.blind
            && let Some(color) = self.tree.same_nothing(1)
        {
            return color;
        }
        if let Some(color) = self.ahead.take(x, y) {
            return color;
        }
        self.sample(f64::from(x), f64::from(y), true)
    }

    /// The light that comes through a place of the picture; `keep` says whether it stands for its pixel's other data.
    fn sample(&mut self, x: f64, y: f64, keep: bool) -> Color {
        let before = self.tree.tracer.stats.primitive_tests;
        let mut first = SampleResult::NOTHING;
        let (tree, depth, blind) = (&mut self.tree, &mut self.depth, self.blind);
        let color = self.rays.color(x, y, |ray| {
            let sample = if blind {
                tree.nothing(ray)
            } else {
                tree.trace(ray, &mut ())
            };
            *depth = (*depth).max(sample.depth);
            if first.rays == 0 {
                first = sample;
            }
            sample.color
        });
        if keep && self.options.info {
            let tests = self.tree.tracer.stats.primitive_tests - before;
            self.infos.push(PixelInfo::new(&first, tests));
        }
        color
    }
}
