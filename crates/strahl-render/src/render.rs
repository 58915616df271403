mod bundles;
mod crew;
mod pixels;
mod plan;
mod probe;
mod refine;
mod rounds;
mod stage;
#[cfg(test)]
mod tile_tests;
mod work;

pub(crate) use crew::Crew;
pub(crate) use pixels::Seen;
pub(crate) use probe::{PixelProbe, probe_rows};
pub(crate) use refine::refined_quadrants;
pub use work::PixelState;
pub(crate) use work::Work;

use crate::activity::Activities;
use crate::camera::PrimaryRays;
use crate::cost::PixelCost;
use crate::film::{Film, FilmError, PixelInfo, Region};
use crate::sampling::{Sample, Sampling};
use crate::scene::RenderScene;
use crate::tiles::TileOrder;
use crate::trace::{BatchMemory, RayCounts, TraceSettings};
use crate::transport::Transport;
use pixels::PixelTracer;
use strahl_accel::{PACKET, TraversalStats};
use strahl_scene::WorkingSpace;
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
    /// Whether to trace every eighth pixel of every eighth row first, then every fourth, and so on. The picture is the same, and no ray
    /// is traced twice.
    pub coarse_first: bool,
    /// How ray trees are grown.
    pub trace: TraceSettings,
    /// What the trace loop asks besides the scene.
    pub transport: Transport,
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
            coarse_first: false,
            trace: TraceSettings::of(scene),
            transport: Transport::default(),
            info: false,
            costs: false,
            alpha: false,
        }
    }

    /// Whether neighbouring rays are traced in packets. Not where costs are shown, since these are the costs of single rays.
    fn follows_together(&self, rays: &PrimaryRays) -> bool {
        self.has_packets() && rays.is_sharp()
    }

    /// Whether rays may be traced in packets at all: neither costs nor properties of single rays are asked for.
    const fn has_packets(&self) -> bool {
        self.trace.packets && !self.costs && !self.info
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

    /// Where the threads store what they are doing, for a [`Profile`](crate::Profile).
    fn activities(&self) -> Option<&Activities> {
        None
    }

    /// Whether to stop. It is asked every few pixels, so it must be fast; a tile that is left half done is traced again if the render goes on.
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
    /// The camera makes no rays.
    #[error("{0}")]
    Camera(&'static str),
    /// [`Progress::cancelled`] returned true, or [`Output::stop`](crate::Output::stop) was set.
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
    /// What the threads needed for their rays.
    pub batches: BatchMemory,
    /// Threads used.
    pub threads: usize,
    /// The cost of each pixel of the film, row by row, if requested. With `Corners` a pixel has the cost of its top left
    /// corner.
    pub costs: Option<Vec<PixelCost>>,
}

/// Renders a picture with threads of its own; if one is asked for, with the thread that calls. Programs that render several
/// pictures, or look at one on the way, have a [`Session`](crate::Session).
///
/// # Errors
/// [`RenderError`]: no such picture, no memory, or no threads.
pub fn render(scene: &RenderScene, options: &RenderOptions) -> Result<Rendered, RenderError> {
    render_watched(scene, options, &())
}

/// [Renders](render()) a picture, and tells how far it is.
///
/// # Errors
/// [`RenderError`]: no such picture, no memory, no threads, or cancelled.
pub fn render_watched(
    scene: &RenderScene,
    options: &RenderOptions,
    progress: &dyn Progress,
) -> Result<Rendered, RenderError> {
    let mut work = Work::new(options)?;
    // A thread that is started for one short picture takes longer than some pictures.
    let pool = match options.threads {
        1 => None,
        count => Some(
            rayon::ThreadPoolBuilder::new()
                .num_threads(count)
                .build()
                .map_err(|e| RenderError::Threads(count, e.to_string()))?,
        ),
    };
    let crew = Crew {
        scene,
        rays: &PrimaryRays::new(scene.camera(), options.width, options.height),
        pool: pool.as_ref(),
        progress,
    };
    match work.go_on(&crew, None)? {
        true => Ok(work.rendered(crew.threads())),
        false => Err(RenderError::Cancelled),
    }
}

/// The result of a tile.
struct TileResult<T> {
    tile: Region,
    /// The pixels traced; `None` for all of the tile.
    points: Option<Vec<(u32, u32)>>,
    values: Vec<T>,
    /// One for each value, if requested.
    infos: Vec<PixelInfo>,
    /// One for each value, if requested.
    costs: Vec<PixelCost>,
    counts: RayCounts,
    traversal: TraversalStats,
}

impl<T> TileResult<T> {
    /// With other values, which are made of all of these.
    fn with<U>(self, make: impl FnOnce(Vec<T>) -> Vec<U>) -> TileResult<U> {
        TileResult {
            tile: self.tile,
            points: self.points,
            values: make(self.values),
            infos: self.infos,
            costs: self.costs,
            counts: self.counts,
            traversal: self.traversal,
        }
    }

    /// The pixels with a value each.
    fn places(&self) -> Box<dyn Iterator<Item = (u32, u32)> + '_> {
        match &self.points {
            Some(points) => Box::new(points.iter().copied()),
            None => Box::new(self.tile.positions()),
        }
    }
}

/// The samples of a pixel so far.
#[derive(Clone, Copy, Debug)]
struct Samples {
    sum: Color,
    count: u32,
    /// The sum of what the samples show of the background, for the alpha channel.
    clear: f64,
}

/// Pixels as the film holds them.
#[derive(Clone, Debug, Default, PartialEq)]
struct Shown {
    colors: Vec<[f32; 3]>,
    /// One for each colour if the film has an alpha channel, otherwise none.
    alphas: Vec<f32>,
}

/// How means of samples become pixels.
#[derive(Clone, Copy, Debug)]
struct Showing {
    /// The space of the means.
    space: WorkingSpace,
    /// Whether the film has an alpha channel.
    alpha: bool,
}

impl Showing {
    fn of(options: &RenderOptions) -> Self {
        Self {
            space: options.trace.space(),
            alpha: options.alpha,
        }
    }

    /// A pixel with the mean of its samples.
    fn one(self, mean: Sample) -> ([f32; 3], f32) {
        let mut color = [[0.0; 3]];
        self.decode_few(&[mean], &mut color);
        (color[0], alpha(&mean))
    }

    /// Pixels with the means of their samples. Means are colours of the scene's working space, as in POV-Ray (measured): where it is not linear,
    /// edges are darker than means of linear light would be.
    fn all(self, means: &[Sample]) -> Shown {
        let colors = match self.space {
            WorkingSpace::Linear => means.iter().map(|mean| mean.color.to_f32()).collect(),
            _ => {
                let mut colors = vec![[0.0; 3]; means.len()];
                for (means, colors) in means.chunks(PACKET).zip(colors.chunks_mut(PACKET)) {
                    self.decode_few(means, colors);
                }
                colors
            }
        };
        let alphas = match self.alpha {
            true => means.iter().map(alpha).collect(),
            false => vec![],
        };
        Shown { colors, alphas }
    }

    /// The colours of at most [`PACKET`] pixels.
    fn decode_few(self, means: &[Sample], colors: &mut [[f32; 3]]) {
        let share = |mean: &Sample| match self.space {
            WorkingSpace::Linear => 1.0,
            _ => covered(mean),
        };
        let mut components = [[0.0; 3]; PACKET];
        for (place, mean) in components.iter_mut().zip(means) {
            *place = (mean.color / share(mean)).to_array();
        }
        let used = &mut components[..means.len().min(PACKET)];
        self.space.decode_components(used.as_flattened_mut());
        for ((color, decoded), mean) in colors.iter_mut().zip(used).zip(means) {
            *color = (Color::from(*decoded) * share(mean)).to_f32();
        }
    }
}

/// How much a pixel covers what lies behind the picture.
fn alpha(mean: &Sample) -> f32 {
    (1.0 - mean.clear) as f32
}

/// The share of a pixel that has its colour: what does not show the background. The colour is that of this share times the share, so it is
/// divided by it to become linear. Light that is added where little is covered, such as highlights on glass, counts as covering as much as it
/// is bright.
fn covered(mean: &Sample) -> f64 {
    if mean.clear == 0.0 {
        return 1.0;
    }
    let share = (1.0 - mean.clear).max(mean.color.max_component().min(1.0));
    if share > 0.0 { share } else { 1.0 }
}

impl Samples {
    const NONE: Self = Self {
        sum: Color::BLACK,
        count: 0,
        clear: 0.0,
    };

    /// Adds a sample.
    fn add(&mut self, sample: Sample) {
        self.sum += sample.color;
        self.clear += sample.clear;
        self.count += 1;
    }

    /// With one sample more.
    fn with(mut self, sample: Sample) -> Self {
        self.add(sample);
        self
    }

    /// With others.
    fn plus(mut self, other: Self) -> Self {
        self.sum += other.sum;
        self.clear += other.clear;
        self.count += other.count;
        self
    }

    /// With a sample that counts several times.
    fn with_many(mut self, sample: Sample, times: u32) -> Self {
        self.sum += sample.color * f64::from(times);
        self.clear += sample.clear * f64::from(times);
        self.count += times;
        self
    }

    /// How much of what lies behind the picture shows.
    fn clear(&self) -> f64 {
        if self.count <= 1 {
            self.clear
        } else {
            self.clear / f64::from(self.count)
        }
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

/// Samples of a rectangle of pixels, or of the corners of pixels.
#[derive(Clone, Debug, PartialEq)]
struct Lattice {
    region: Region,
    samples: Vec<Sample>,
}

impl Lattice {
    fn at(&self, x: u32, y: u32) -> Sample {
        self.samples[self.region.index(x, y)]
    }

    fn put(&mut self, (x, y): (u32, u32), sample: Sample) {
        let index = self.region.index(x, y);
        self.samples[index] = sample;
    }

    /// Writes the samples of a tile, which lies in the lattice.
    fn put_tile(&mut self, tile: Region, samples: &[Sample]) {
        let width = tile.width as usize;
        for (y, row) in (tile.y..).zip(samples.chunks_exact(width)) {
            let start = self.region.index(tile.x, y);
            self.samples[start..start + width].copy_from_slice(row);
        }
    }

    /// The corners of a pixel: top left, top right, bottom left, bottom right.
    fn around(&self, x: u32, y: u32) -> [Sample; 4] {
        let at = |dx, dy| self.at(x + dx, y + dy);
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
    /// Writes the pixels of a tile, as far as they lie in the film.
    fn set_tile(&mut self, tile: Region, shown: &Shown) {
        let Some(part) = tile.intersection(&self.region) else {
            return;
        };
        let width = part.width as usize;
        for y in part.y..part.y + part.height {
            let (from, to) = (tile.index(part.x, y), self.region.index(part.x, y));
            self.pixels[to..to + width].copy_from_slice(&shown.colors[from..from + width]);
            if let Some(alpha) = &mut self.alpha {
                alpha[to..to + width].copy_from_slice(&shown.alphas[from..from + width]);
            }
        }
    }

    /// Writes the pixels of a tile that have a new value, as far as they lie in the film.
    fn set_some(&mut self, tile: Region, values: &[Option<Sample>], showing: Showing) {
        let means: Vec<Sample> = values.iter().flatten().copied().collect();
        let shown = showing.all(&means);
        let places = tile.positions().zip(values);
        let places = places.filter_map(|(place, value)| value.map(|_| place));
        for (number, (x, y)) in places.enumerate() {
            if self.region.contains(x, y) {
                let index = self.region.index(x, y);
                self.pixels[index] = shown.colors[number];
                if let Some(alpha) = &mut self.alpha {
                    alpha[index] = shown.alphas[number];
                }
            }
        }
    }

    /// Shows a sample in all pixels of a block, as far as they lie in the film.
    fn fill(&mut self, block: Region, (color, alpha): ([f32; 3], f32)) {
        let Some(block) = block.intersection(&self.region) else {
            return;
        };
        let width = block.width as usize;
        for y in block.y..block.y + block.height {
            let start = self.region.index(block.x, y);
            self.pixels[start..start + width].fill(color);
            if let Some(alphas) = &mut self.alpha {
                alphas[start..start + width].fill(alpha);
            }
        }
    }

    /// Writes the further data of the pixels of a tile, as far as they lie in the film.
    fn set_infos<T>(&mut self, result: &TileResult<T>) {
        if let Some(list) = &mut self.info {
            for ((x, y), info) in result.places().zip(&result.infos) {
                if self.region.contains(x, y) {
                    list[self.region.index(x, y)] = *info;
                }
            }
        }
    }
}
