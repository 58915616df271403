//! Settings of pictures, as the Python half hands them over.

use crate::cameras::Camera;
use crate::errors;
use crate::work::Stop;
use pyo3::prelude::*;
use std::sync::{Arc, LazyLock};
use std::time::Instant;
use strahl::prelude::{AcceleratorKind, Output, Region, RenderScene, Sampling, View};

/// The size of pictures of scenes that don't name one.
pub(crate) const DEFAULT_SIZE: (u32, u32) = (800, 600);

/// What pixels depend on: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct ViewNumbers {
    size: Option<(u32, u32)>,
    sampling: String,
    seed: u64,
    depth: Option<u32>,
    adc_bailout: Option<f64>,
    shading: Option<String>,
    camera: Option<Py<Camera>>,
    pub(crate) threads: Option<usize>,
    accelerator: Option<String>,
}

/// What is handed over of a picture: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct OutputNumbers {
    region: Option<(u32, u32, u32, u32)>,
    layers: bool,
    alpha: bool,
    costs: bool,
    coarse_first: bool,
}

impl ViewNumbers {
    pub(crate) fn accelerator(&self) -> PyResult<Option<AcceleratorKind>> {
        let name = self.accelerator.as_deref();
        name.map(|name| name.parse().map_err(errors::value))
            .transpose()
    }

    pub(crate) fn view(
        &self,
        scene: &Arc<RenderScene>,
        read_with: Option<(u32, u32)>,
    ) -> PyResult<View> {
        let own = scene.settings().size;
        let (width, height) = self.size.or(own).or(read_with).unwrap_or(DEFAULT_SIZE);
        let sampling: Sampling = self.sampling.parse().map_err(errors::value)?;
        let mut view = scene.view(width, height).with_sampling(sampling);
        view.seed = self.seed;
        if let Some(depth) = self.depth {
            if depth == 0 {
                return Err(errors::value("depth must be at least 1"));
            }
            view = view.with_depth(depth);
        }
        if let Some(weight) = self.adc_bailout {
            view = view.with_cutoff(weight);
        }
        if let Some(name) = &self.shading {
            view = view.with_shading(name.parse().map_err(errors::value)?);
        }
        if let Some(camera) = &self.camera {
            view = view.with_camera(camera.get().0.clone());
        }
        Ok(view)
    }
}

/// Nanoseconds since the first call, for the costs of pixels.
fn clock() -> u64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_nanos() as u64
}

impl OutputNumbers {
    pub(crate) fn region(&self) -> Option<Region> {
        self.region.map(|(x, y, width, height)| Region {
            x,
            y,
            width,
            height,
        })
    }

    pub(crate) fn output(&self, stop: &Stop) -> Output {
        Output {
            region: self.region(),
            coarse_first: self.coarse_first,
            info: self.layers,
            alpha: self.alpha,
            costs: self.costs,
            clock: self.costs.then_some(clock as fn() -> u64),
            stop: Some(stop.flag()),
            ..Output::default()
        }
    }
}
