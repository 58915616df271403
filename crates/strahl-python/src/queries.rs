//! Questions about many rays at once.

use crate::convert::contiguous;
use crate::{errors, work};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use std::sync::Arc;
use strahl::prelude::{DVec3, Ray, RenderScene};
use strahl::tracing::Session;

/// Rays between looks at the signals.
const CHUNK: usize = 1 << 18;

/// Rays in a scene, and the threads that answer.
pub(crate) struct Asked {
    pub(crate) scene: Arc<RenderScene>,
    pub(crate) session: Session,
    pub(crate) rays: Arc<Vec<Ray>>,
}

impl Asked {
    pub(crate) fn new(
        py: Python<'_>,
        scene: Arc<RenderScene>,
        session: Session,
        origins: &PyReadonlyArray2<'_, f64>,
        directions: &PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Self> {
        let (origins, directions) = (contiguous(origins)?, contiguous(directions)?);
        if origins.len() != directions.len() {
            return Err(errors::value("there must be as many origins as directions"));
        }
        let (origins, _) = origins.as_chunks::<3>();
        let (directions, _) = directions.as_chunks::<3>();
        let vector = DVec3::from_array;
        let ray = |i: usize| Ray::new(vector(origins[i]), vector(directions[i]));
        let rays = py.detach(|| session.list(origins.len(), ray));
        Ok(Self {
            scene,
            session,
            rays: Arc::new(rays),
        })
    }

    /// An answer for each ray. `answer` gets them in parts, between which Ctrl-C can end it.
    pub(crate) fn ask<T: Copy + Send + Sync + 'static>(
        &self,
        py: Python<'_>,
        none: T,
        answer: impl Fn(&Session, &RenderScene, &[Ray], &mut [T]) + Send + 'static,
    ) -> PyResult<Vec<T>> {
        let (scene, rays) = (Arc::clone(&self.scene), Arc::clone(&self.rays));
        let session = self.session.clone();
        let all = move |stop: &work::Stop| {
            let mut answers = session.list(rays.len(), |_| none);
            for (rays, answers) in rays.chunks(CHUNK).zip(answers.chunks_mut(CHUNK)) {
                if !stop.is_set() {
                    answer(&session, &scene, rays, answers);
                }
            }
            answers
        };
        work::run_with(py, all, |_| Ok(()))
    }
}
