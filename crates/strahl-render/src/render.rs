mod pixels;

use crate::camera::PrimaryRays;
use crate::cost::PixelCost;
use crate::film::{Film, FilmError, PixelInfo, Region, try_filled};
use crate::sampling::{Sampling, contrast};
use crate::scene::RenderScene;
use crate::tiles::{TileOrder, tiles};
use crate::trace::{RayCounts, TraceSettings};
use pixels::PixelTracer;
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

/// The refining passes of pixel `(x, y)` of the picture.
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
    /// The refining passes it was part of, as bits.
    passes: u32,
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
        passes: 0,
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

    fn mean(&self) -> Color {
        if self.count == 1 {
            self.sum
        } else {
            self.sum / f64::from(self.count)
        }
    }
}

impl Job<'_> {
    /// Traces the tiles of a region on all threads (see [`PixelTracer::tile`]) and hands each finished tile to `store`.
    fn tiles<T: Clone + Send>(
        &mut self,
        region: Region,
        pass: u32,
        blank: impl Fn(&mut PixelTracer<'_>, u32) -> Option<T> + Sync,
        trace: impl Fn(&mut PixelTracer<'_>, u32, u32) -> T + Sync,
        mut store: impl FnMut(TileResult<T>) + Send,
    ) -> Result<(), RenderError> {
        let all = tiles(region, self.options.tile_order);
        self.progress
            .pass(pass, 1 + self.options.sampling.passes(), all.len());
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
        let region = film.region;
        self.tiles(
            region,
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
        let region = film.region;
        let lattice = Region {
            width: region.width + 1,
            height: region.height + 1,
            ..region
        };
        let mut corners = try_filled(lattice, (Color::BLACK, 0.0))?;
        self.tiles(
            lattice,
            0,
            |tracer, corners| Some((tracer.tree.same_nothing(corners as usize)?, 0.0)),
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
            let four = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
            let color = (four[0].0 + four[1].0 + four[2].0 + four[3].0) / 4.0;
            film.set((x, y), color, four.iter().map(|c| c.1).sum::<f64>() / 4.0);
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
            let samples = &all[wide.index(x, y)];
            film.set((x, y), samples.mean(), samples.clear());
        }
        Ok(())
    }

    /// The samples of a region and the margin around it; `keep` is called with the data of each pixel's first sample.
    fn refined(
        &mut self,
        region: Region,
        threshold: f64,
        passes: u32,
        mut keep: impl FnMut(Region, &[PixelInfo]) + Send,
    ) -> Result<(Region, Vec<Samples>), RenderError> {
        let (width, height) = (self.options.width, self.options.height);
        let wide = region.grown(passes, width, height);
        let mut all = try_filled(wide, Samples::NONE)?;
        self.tiles(
            wide,
            0,
            |tracer, pixels| tracer.blank(pixels),
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
            let blank = |_: &mut PixelTracer<'_>, _| None;
            self.tiles(part, pass, blank, refine, |result| {
                for ((x, y), more) in result.tile.positions().zip(result.values) {
                    if let Some(more) = more {
                        let samples = &mut all[wide.index(x, y)];
                        samples.sum += more.sum;
                        samples.count += more.count;
                        samples.clear += more.clear;
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
    fn set(&mut self, (x, y): (u32, u32), color: Color, clear: f64) {
        let index = self.region.index(x, y);
        self.pixels[index] = color.to_f32();
        if let Some(alpha) = &mut self.alpha {
            alpha[index] = (1.0 - clear) as f32;
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
