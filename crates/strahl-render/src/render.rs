use crate::camera::PrimaryRays;
use crate::film::{Film, FilmError, PixelInfo, Region, try_filled};
use crate::sampling::{Sampling, contrast};
use crate::scene::RenderScene;
use crate::tiles::{TileOrder, tiles};
use crate::trace::{RayCounts, SampleResult, TraceSettings, TreeTracer};
use rayon::prelude::*;
use strahl_accel::TraversalStats;
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
        }
    }
}

/// Hears how far a render is, and may end it. Called from several threads.
pub trait Progress: Sync {
    /// A pass begins; it has this many tiles.
    fn pass(&self, _pass: u32, _of: u32, _tiles: usize) {}

    /// A tile is done; it took this many rays.
    fn tile(&self, _rays: u64) {}

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
    };
    let (wide, all) = job.refined(
        Region {
            x,
            y,
            width: 1,
            height: 1,
        },
        threshold,
        passes,
    )?;
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
}

/// What a tile brings home.
struct TileResult<T> {
    tile: Region,
    values: Vec<T>,
    counts: RayCounts,
    traversal: TraversalStats,
}

/// The samples of a pixel so far.
#[derive(Clone, Copy, Debug)]
struct Samples {
    sum: Color,
    count: u32,
    info: PixelInfo,
    /// The refining passes that looked at it, as bits.
    passes: u32,
}

impl Samples {
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
        mut store: impl FnMut(Region, Vec<T>),
    ) -> Result<(), RenderError> {
        // In batches, so that a large picture does not wait in memory twice.
        const BATCH: usize = 1024;
        let all = tiles(region, self.options.tile_order);
        self.progress
            .pass(pass, 1 + self.options.sampling.passes(), all.len());
        let (scene, options, rays, progress) = (self.scene, self.options, self.rays, self.progress);
        for batch in all.chunks(BATCH) {
            let results: Vec<Option<TileResult<T>>> = batch
                .par_iter()
                .map_init(
                    || PixelTracer {
                        tree: TreeTracer::new(scene, options.trace),
                        rays,
                        options,
                    },
                    |tracer, tile| {
                        (!progress.cancelled()).then(|| {
                            let result = tracer.tile(*tile, &trace);
                            progress.tile(result.counts.total());
                            result
                        })
                    },
                )
                .collect();
            for result in results {
                let result = result.ok_or(RenderError::Cancelled)?;
                self.counts += result.counts;
                self.traversal += result.traversal;
                store(result.tile, result.values);
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
            |tracer, x, y| tracer.pixel(0, x, y),
            |tile, values| {
                for (pixel, samples) in tile.positions().zip(values) {
                    film.set(pixel, samples.mean(), &samples.info);
                }
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
        let black = (Color::BLACK, PixelInfo::new(&SampleResult::NOTHING, 0));
        let mut corners = try_filled(lattice, black)?;
        self.tiles(
            lattice,
            0,
            |tracer, x, y| tracer.corner(x, y),
            |tile, values| {
                for ((x, y), value) in tile.positions().zip(values) {
                    corners[lattice.index(x, y)] = value;
                }
            },
        )?;
        for (x, y) in region.positions() {
            let at = |dx, dy| corners[lattice.index(x + dx, y + dy)];
            let sum = at(0, 0).0 + at(1, 0).0 + at(0, 1).0 + at(1, 1).0;
            film.set((x, y), sum / 4.0, &at(0, 0).1);
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
        let (wide, all) = self.refined(region, threshold, passes)?;
        for (x, y) in region.positions() {
            let samples = &all[wide.index(x, y)];
            film.set((x, y), samples.mean(), &samples.info);
        }
        Ok(())
    }

    /// The samples of a region and the margin around it.
    fn refined(
        &mut self,
        region: Region,
        threshold: f64,
        passes: u32,
    ) -> Result<(Region, Vec<Samples>), RenderError> {
        let (width, height) = (self.options.width, self.options.height);
        let wide = region.grown(passes, width, height);
        let info = PixelInfo::new(&SampleResult::NOTHING, 0);
        let mut all = try_filled(
            wide,
            Samples {
                sum: Color::BLACK,
                count: 0,
                info,
                passes: 0,
            },
        )?;
        self.tiles(
            wide,
            0,
            |tracer, x, y| tracer.pixel(0, x, y),
            |tile, values| {
                for ((x, y), samples) in tile.positions().zip(values) {
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
            self.tiles(part, pass, refine, |tile, values| {
                for ((x, y), more) in tile.positions().zip(values) {
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
    fn set(&mut self, (x, y): (u32, u32), color: Color, info: &PixelInfo) {
        let index = self.region.index(x, y);
        self.pixels[index] = color.to_f32();
        if let Some(list) = &mut self.info {
            list[index] = *info;
        }
    }
}

impl SampleResult {
    const NOTHING: Self = Self {
        color: Color::BLACK,
        first: None,
        depth: 0,
        rays: 0,
    };
}

/// Traces pixels on one thread.
struct PixelTracer<'s> {
    tree: TreeTracer<'s>,
    rays: PrimaryRays,
    options: &'s RenderOptions,
}

impl PixelTracer<'_> {
    fn tile<T>(&mut self, tile: Region, trace: impl Fn(&mut Self, u32, u32) -> T) -> TileResult<T> {
        self.tree.counts = RayCounts::default();
        self.tree.tracer.stats = TraversalStats::default();
        self.tree.tracer.forget_occluders();
        let values = tile.positions().map(|(x, y)| trace(self, x, y)).collect();
        TileResult {
            tile,
            values,
            counts: self.tree.counts,
            traversal: self.tree.tracer.stats,
        }
    }

    /// The samples of one pass of a pixel.
    fn pixel(&mut self, pass: u32, x: u32, y: u32) -> Samples {
        let mut samples: Option<Samples> = None;
        for (dx, dy) in self.options.sampling.places(pass, x, y, self.options.seed) {
            let (color, info) = self.sample(f64::from(x) + dx, f64::from(y) + dy);
            match &mut samples {
                None => {
                    samples = Some(Samples {
                        sum: color,
                        count: 1,
                        info,
                        passes: 0,
                    })
                }
                Some(samples) => {
                    samples.sum += color;
                    samples.count += 1;
                }
            }
        }
        samples.expect("every way of sampling has at least one place in each pixel")
    }

    fn corner(&mut self, x: u32, y: u32) -> (Color, PixelInfo) {
        self.sample(f64::from(x), f64::from(y))
    }

    fn sample(&mut self, x: f64, y: f64) -> (Color, PixelInfo) {
        let before = self.tree.tracer.stats.primitive_tests;
        let sample = self.tree.trace(&self.rays.ray(x, y), &mut ());
        (
            sample.color,
            PixelInfo::new(&sample, self.tree.tracer.stats.primitive_tests - before),
        )
    }
}
