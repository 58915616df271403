use crate::camera::PrimaryRays;
use crate::film::Region;
use crate::render::{RenderError, RenderOptions};
use crate::sampling::Sampling;
use crate::scene::RenderScene;
use crate::tiles::TileOrder;
use crate::trace::TraceSettings;
use crate::transport::{Gather, MediumIntegrator, Transport};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use strahl_scene::Camera;
use strahl_shade::ShadingModel;

/// A compiled scene, seen from somewhere: everything that the pixels of a picture depend on.
///
/// Views share the scene, so they are made and changed without building anything. A picture of a view has the same bits as one of the
/// same description compiled with the view's camera. One thing stays as it was compiled: the lights and the background that a
/// description without camera and lights gets (see [`compile`](crate::compile())), so that objects don't change under a moving camera.
#[derive(Clone, Debug)]
pub struct View {
    scene: Arc<RenderScene>,
    /// The camera.
    pub camera: Camera,
    /// Width of the whole picture in pixels.
    pub width: u32,
    /// Height of the whole picture in pixels.
    pub height: u32,
    /// Where rays go through the pixels.
    pub sampling: Sampling,
    /// Seed of the sampling.
    pub seed: u64,
    /// How ray trees are grown: depth, cutoff, shading model.
    pub trace: TraceSettings,
    /// Methods of light transport besides the trace loop.
    pub transport: Transport,
}

/// What is handed over of a picture, and in what order. None of it changes a pixel.
#[derive(Clone, Debug, Default)]
pub struct Output {
    /// The part to render; `None` is all of it.
    pub region: Option<Region>,
    /// Order of the tiles.
    pub tile_order: TileOrder,
    /// Whether to trace every eighth pixel of every eighth row first, then every fourth, and so on, and antialiasing last. No ray is
    /// traced twice.
    pub coarse_first: bool,
    /// Whether to fill [`Film::info`](crate::Film::info).
    pub info: bool,
    /// Whether to fill [`Film::alpha`](crate::Film::alpha), and to leave the background out of the colours as far as it is see-through.
    pub alpha: bool,
    /// Whether to fill [`Rendered::costs`](crate::Rendered::costs).
    pub costs: bool,
    /// Stops the render when it becomes true, also while nothing is ready for the sink: after the few pixels that each thread is at. The picture can
    /// go on as one that a sink has stopped, once this is false again.
    pub stop: Option<Arc<AtomicBool>>,
    /// A clock in nanoseconds for the time of each pixel in [`Rendered::costs`](crate::Rendered::costs); nothing here reads the clock
    /// itself.
    pub clock: Option<fn() -> u64>,
}

impl RenderScene {
    /// The scene from its own camera with its own settings, one ray per pixel.
    pub fn view(self: &Arc<Self>, width: u32, height: u32) -> View {
        View {
            scene: Arc::clone(self),
            camera: self.camera().clone(),
            width,
            height,
            sampling: Sampling::Center,
            seed: 0,
            trace: TraceSettings::of(self),
            transport: Transport::default(),
        }
    }
}

impl View {
    /// The compiled scene.
    pub const fn scene(&self) -> &Arc<RenderScene> {
        &self.scene
    }

    /// From another camera.
    #[must_use]
    pub fn with_camera(self, camera: Camera) -> Self {
        Self { camera, ..self }
    }

    /// In another size, in pixels.
    #[must_use]
    pub fn with_size(self, width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            ..self
        }
    }

    /// With rays through other places of the pixels.
    #[must_use]
    pub fn with_sampling(self, sampling: Sampling) -> Self {
        Self { sampling, ..self }
    }

    /// With this deepest level of the ray tree; the primary ray is level 1.
    #[must_use]
    pub const fn with_depth(mut self, max_depth: u32) -> Self {
        self.trace.max_depth = max_depth;
        self
    }

    /// Without branches of a smaller weight.
    #[must_use]
    pub const fn with_cutoff(mut self, adc_bailout: f64) -> Self {
        self.trace.adc_bailout = adc_bailout;
        self
    }

    /// With one shading model for all materials, overriding their own.
    #[must_use]
    pub const fn with_shading(mut self, model: ShadingModel) -> Self {
        self.trace.force_shading = Some(model);
        self
    }

    /// With light that this method finds at hits.
    #[must_use]
    pub fn with_gather(mut self, gather: Arc<dyn Gather>) -> Self {
        self.transport.gather = Some(gather);
        self
    }

    /// With a medium along all rays.
    #[must_use]
    pub fn with_medium(mut self, medium: Arc<dyn MediumIntegrator>) -> Self {
        self.transport.medium = Some(medium);
        self
    }

    /// The rays of the camera.
    ///
    /// # Errors
    /// [`RenderError::Camera`] if the camera makes no rays.
    pub fn rays(&self) -> Result<PrimaryRays, RenderError> {
        match self.camera.problem() {
            None => Ok(PrimaryRays::new(&self.camera, self.width, self.height)),
            Some(problem) => Err(RenderError::Camera(problem)),
        }
    }

    /// All options of a picture of it.
    pub(crate) fn options(&self, output: &Output) -> RenderOptions {
        RenderOptions {
            width: self.width,
            height: self.height,
            region: output.region,
            sampling: self.sampling,
            seed: self.seed,
            threads: 0,
            tile_order: output.tile_order,
            coarse_first: output.coarse_first,
            trace: self.trace,
            transport: self.transport.clone(),
            info: output.info,
            costs: output.costs,
            alpha: output.alpha,
        }
    }
}
