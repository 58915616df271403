mod pixels;
mod probe;
mod refine;

pub(crate) use probe::{Probe, Seen, probe_rows};

use crate::camera::PrimaryRays;
use crate::cost::PixelCost;
use crate::film::{Film, FilmError, PixelInfo, Region, try_filled};
use crate::sampling::{Sample, Sampling};
use crate::scene::RenderScene;
use crate::tiles::{TileOrder, tiles};
use crate::trace::{RayCounts, TraceSettings};
use pixels::PixelTracer;
pub(crate) use refine::is_refined;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
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
    /// How ray trees are grown.
    pub trace: TraceSettings,
    /// Whether to fill [`Film::info`].
    pub info: bool,
    /// Whether to fill [`Rendered::costs`].
    pub costs: bool,
    /// Whether to fill [`Film::alpha`], and to leave the background out of the colours as far as it is see-through.
    pub alpha: bool,
}

impl RenderOptions {
    /// The scene's own settings at this size, one ray per pixel, on all processors.
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
            alpha: false,
        }
    }

    /// Whether neighbouring rays are traced in packets. Not where costs are shown, since these are the costs of single rays.
    fn follows_together(&self, rays: &PrimaryRays) -> bool {
        self.trace.packets && !self.costs && !self.info && !self.alpha && rays.is_sharp()
    }

    /// The part of the picture that the film holds.
    fn film_region(&self) -> Region {
        let whole = Region::full(self.width, self.height);
        self.region.unwrap_or(whole)
    }
}

/// Is told the progress of a render, and may cancel it. Called from several threads.
pub trait Progress: Sync {
    /// A pass begins; it has this many tiles.
    fn pass(&self, _pass: u32, _of: u32, _tiles: usize) {}

    /// A tile is done; it took this many rays.
    fn tile(&self, _rays: u64) {}

    /// A clock in nanoseconds, for the time of each pixel: nothing here reads the clock itself.
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
    /// The film can't be made.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// [`Progress::cancelled`] returned true.
    #[error("cancelled")]
    Cancelled,
    /// The system gives no threads.
    #[error("cannot start {0} threads: {1}")]
    Threads(usize, String),
}

/// A finished picture and its cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendered {
    /// The picture.
    pub film: Film,
    /// Rays traced.
    pub rays: RayCounts,
    /// The cost of finding their hits.
    pub traversal: TraversalStats,
    /// Threads used.
    pub threads: usize,
    /// The cost of each pixel of the film, row by row, if requested. With `Corners` a pixel has the cost of its top left
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
    if options.alpha {
        film.alpha = Some(try_filled(film.region, 1.0)?);
    }
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
        Sampling::Adaptive(refinement) => job.adaptive(&mut film, &refinement),
        Sampling::Recursive(refinement) => job.recursive(&mut film, &refinement),
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

/// The result of a tile.
struct TileResult<T> {
    tile: Region,
    values: Vec<T>,
    /// One for each value, if requested.
    infos: Vec<PixelInfo>,
    /// One for each value, if requested.
    costs: Vec<PixelCost>,
    counts: RayCounts,
    traversal: TraversalStats,
}

/// The samples of a pixel so far.
#[derive(Clone, Copy, Debug)]
struct Samples {
    sum: Color,
    count: u32,
    /// The sum of what the samples show of the background, for the alpha channel.
    clear: f64,
}

/// A pixel as the film holds it.
#[derive(Clone, Copy, Debug)]
struct Shown {
    color: [f32; 3],
    alpha: f32,
}

impl Samples {
    const NONE: Self = Self {
        sum: Color::BLACK,
        count: 0,
        clear: 0.0,
    };

    /// What the film holds of the pixel.
    fn shown(&self) -> Shown {
        Shown {
            color: self.mean().to_f32(),
            alpha: (1.0 - self.clear()) as f32,
        }
    }

    /// How much of what lies behind the picture shows.
    fn clear(&self) -> f64 {
        self.clear / f64::from(self.count.max(1))
    }

    /// The mean of the samples.
    fn sample(&self) -> Sample {
        Sample {
            color: self.mean(),
            clear: self.clear(),
        }
    }

    fn mean(&self) -> Color {
        if self.count == 1 {
            self.sum
        } else {
            self.sum / f64::from(self.count)
        }
    }
}

impl Job<'_> {
    /// Traces tiles on all threads (see [`PixelTracer::tile`]) and hands each finished tile to `store`.
    fn tiles<T: Clone + Send>(
        &mut self,
        all: &[Region],
        pass: u32,
        blank: impl Fn(&mut PixelTracer<'_>, u32) -> Option<T> + Sync,
        trace: impl Fn(&mut PixelTracer<'_>, u32, u32) -> T + Sync,
        mut store: impl FnMut(TileResult<T>) + Send,
    ) -> Result<(), RenderError> {
        self.progress
            .pass(pass, self.options.sampling.passes(), all.len());
        let (scene, options, progress) = (self.scene, self.options, self.progress);
        let rays = &self.rays;
        let mut stored = 0;
        let mut take = |result: TileResult<T>| {
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
            stored += 1;
        };
        // A thread that is free takes the next tile. Tiles end in any order; the result does not depend on it.
        let (next, take) = (AtomicUsize::new(0), Mutex::new(&mut take));
        rayon::broadcast(|_| {
            let mut tracer = PixelTracer::new(scene, rays, options, progress);
            while !progress.cancelled() {
                let number = next.fetch_add(1, Ordering::Relaxed);
                let Some(tile) = all.get(number) else { break };
                let result = tracer.tile(*tile, pass, &blank, &trace);
                progress.tile(result.counts.total());
                let mut take = take.lock().unwrap_or_else(PoisonError::into_inner);
                (*take)(result);
            }
        });
        match stored == all.len() {
            true => Ok(()),
            false => Err(RenderError::Cancelled),
        }
    }

    /// Renders with one pass.
    fn single_pass(&mut self, film: &mut Film) -> Result<(), RenderError> {
        self.tiles(
            &tiles(film.region, self.options.tile_order),
            0,
            |tracer, pixels| Some(tracer.blank(pixels)?.shown()),
            |tracer, x, y| tracer.pixel(0, x, y).shown(),
            |result| {
                film.set_infos(result.tile, &result.infos);
                film.set_tile(result.tile, &result.values);
            },
        )
    }

    /// Traces the lattice of pixel corners first, then makes every pixel the mean of its four.
    fn corners(&mut self, film: &mut Film) -> Result<(), RenderError> {
        let lattice = self.lattice(film)?;
        for (x, y) in film.region.positions() {
            film.set((x, y), mean_of_corners(lattice.around(x, y)));
        }
        Ok(())
    }

    /// The colours at the corners of all pixels of the film.
    fn lattice(&mut self, film: &mut Film) -> Result<Lattice, RenderError> {
        let region = Region {
            width: film.region.width + 1,
            height: film.region.height + 1,
            ..film.region
        };
        let mut corners = try_filled(region, Sample::NOTHING)?;
        self.tiles(
            &tiles(region, self.options.tile_order),
            0,
            |tracer, corners| Some(Sample::from(tracer.tree.same_nothing(corners as usize)?)),
            |tracer, x, y| tracer.corner(x, y),
            |result| {
                film.set_infos(result.tile, &result.infos);
                for ((x, y), value) in result.tile.positions().zip(result.values) {
                    corners[region.index(x, y)] = value;
                }
            },
        )?;
        Ok(Lattice { region, corners })
    }
}

/// Colours at the corners of pixels.
struct Lattice {
    region: Region,
    corners: Vec<Sample>,
}

impl Lattice {
    /// The corners of a pixel: top left, top right, bottom left, bottom right.
    fn around(&self, x: u32, y: u32) -> [Sample; 4] {
        let at = |dx, dy| self.corners[self.region.index(x + dx, y + dy)];
        [at(0, 0), at(1, 0), at(0, 1), at(1, 1)]
    }
}

/// A pixel between its corners.
pub(crate) fn mean_of_corners([a, b, c, d]: [Sample; 4]) -> Sample {
    (a + b + c + d) / 4.0
}

impl Region {
    /// The pixels, row by row.
    pub(crate) fn positions(self) -> impl Iterator<Item = (u32, u32)> {
        (self.y..self.y + self.height)
            .flat_map(move |y| (self.x..self.x + self.width).map(move |x| (x, y)))
    }
}

impl Film {
    fn set(&mut self, (x, y): (u32, u32), sample: Sample) {
        let index = self.region.index(x, y);
        self.pixels[index] = sample.color.to_f32();
        if let Some(alpha) = &mut self.alpha {
            alpha[index] = (1.0 - sample.clear) as f32;
        }
    }

    /// Writes the pixels of a tile, which lies in the film.
    fn set_tile(&mut self, tile: Region, values: &[Shown]) {
        let width = tile.width as usize;
        for (y, row) in (tile.y..).zip(values.chunks_exact(width)) {
            let start = self.region.index(tile.x, y);
            for (place, value) in self.pixels[start..start + width].iter_mut().zip(row) {
                *place = value.color;
            }
            if let Some(alpha) = &mut self.alpha {
                for (place, value) in alpha[start..start + width].iter_mut().zip(row) {
                    *place = value.alpha;
                }
            }
        }
    }

    /// Writes the further data of the pixels of a tile, as far as they lie in the film.
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
