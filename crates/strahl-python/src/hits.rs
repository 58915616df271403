//! What many rays have hit, as arrays.

use crate::{convert, work};
use numpy::PyArray1;
use pyo3::prelude::*;
use std::sync::{Arc, OnceLock};
use strahl::prelude::{Hit, Ray, RenderScene};
use strahl::tracing::{HitSurface, Session};

/// The nearest hits of rays. What is beyond `t` is computed when it is first asked for.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Hits {
    scene: Arc<RenderScene>,
    session: Session,
    rays: Arc<Vec<Ray>>,
    hits: Arc<Vec<Option<Hit>>>,
    t: Py<PyArray1<f64>>,
    surfaces: OnceLock<Surfaces>,
}

/// One entry, or row, for each ray.
struct Surfaces {
    object: Py<PyArray1<i32>>,
    material: Py<PyArray1<i32>>,
    element: Py<PyArray1<i64>>,
    position: Py<PyArray1<f64>>,
    normal: Py<PyArray1<f64>>,
    shading_normal: Py<PyArray1<f64>>,
    uv: Py<PyArray1<f64>>,
}

/// The same as plain lists.
struct Columns {
    object: Vec<i32>,
    material: Vec<i32>,
    element: Vec<i64>,
    position: Vec<[f64; 3]>,
    normal: Vec<[f64; 3]>,
    shading_normal: Vec<[f64; 3]>,
    uv: Vec<[f64; 2]>,
}

fn number(of: u32) -> i32 {
    i32::try_from(of).unwrap_or(i32::MAX)
}

impl Columns {
    fn new(surfaces: &[Option<HitSurface>], hits: &[Option<Hit>]) -> Self {
        const NAN: [f64; 3] = [f64::NAN; 3];
        fn list<T>(
            surfaces: &[Option<HitSurface>],
            none: T,
            of: impl Fn(&HitSurface) -> T,
        ) -> Vec<T>
        where
            T: Copy,
        {
            let each = surfaces.iter();
            each.map(|s| s.as_ref().map_or(none, &of)).collect()
        }
        Self {
            object: list(surfaces, -1, |s| number(s.object)),
            material: list(surfaces, -1, |s| number(s.material)),
            element: hits
                .iter()
                .map(|hit| hit.map_or(-1, |hit| hit.id.cast_signed()))
                .collect(),
            position: list(surfaces, NAN, |s| s.position.to_array()),
            normal: list(surfaces, NAN, |s| s.normal.to_array()),
            shading_normal: list(surfaces, NAN, |s| s.shading_normal.to_array()),
            uv: list(surfaces, [f64::NAN; 2], |s| s.uv.to_array()),
        }
    }
}

impl Hits {
    pub(crate) fn new(
        py: Python<'_>,
        scene: Arc<RenderScene>,
        session: Session,
        rays: Arc<Vec<Ray>>,
        hits: Vec<Option<Hit>>,
    ) -> Self {
        let t = hits
            .iter()
            .map(|hit| hit.map_or(f64::INFINITY, |hit| hit.t));
        Self {
            t: convert::frozen(py, t.collect()),
            scene,
            session,
            rays,
            hits: Arc::new(hits),
            surfaces: OnceLock::new(),
        }
    }

    fn surfaces(&self, py: Python<'_>) -> PyResult<&Surfaces> {
        if let Some(known) = self.surfaces.get() {
            return Ok(known);
        }
        let (scene, session) = (Arc::clone(&self.scene), self.session.clone());
        let (rays, hits) = (Arc::clone(&self.rays), Arc::clone(&self.hits));
        let columns = work::run(py, move || {
            let mut surfaces = vec![None; hits.len()];
            session.surfaces(&scene, &rays, &hits, &mut surfaces);
            Columns::new(&surfaces, &hits)
        })?;
        // Another thread may have been faster.
        Ok(self.surfaces.get_or_init(|| Surfaces {
            object: convert::frozen(py, columns.object),
            material: convert::frozen(py, columns.material),
            element: convert::frozen(py, columns.element),
            position: convert::frozen(py, columns.position.into_flattened()),
            normal: convert::frozen(py, columns.normal.into_flattened()),
            shading_normal: convert::frozen(py, columns.shading_normal.into_flattened()),
            uv: convert::frozen(py, columns.uv.into_flattened()),
        }))
    }
}

#[pymethods]
impl Hits {
    fn __len__(&self) -> usize {
        self.hits.len()
    }

    #[getter]
    fn t(&self, py: Python<'_>) -> Py<PyArray1<f64>> {
        self.t.clone_ref(py)
    }

    #[getter]
    fn object(&self, py: Python<'_>) -> PyResult<Py<PyArray1<i32>>> {
        Ok(self.surfaces(py)?.object.clone_ref(py))
    }

    #[getter]
    fn material(&self, py: Python<'_>) -> PyResult<Py<PyArray1<i32>>> {
        Ok(self.surfaces(py)?.material.clone_ref(py))
    }

    #[getter]
    fn element(&self, py: Python<'_>) -> PyResult<Py<PyArray1<i64>>> {
        Ok(self.surfaces(py)?.element.clone_ref(py))
    }

    #[getter]
    fn position(&self, py: Python<'_>) -> PyResult<Py<PyArray1<f64>>> {
        Ok(self.surfaces(py)?.position.clone_ref(py))
    }

    #[getter]
    fn normal(&self, py: Python<'_>) -> PyResult<Py<PyArray1<f64>>> {
        Ok(self.surfaces(py)?.normal.clone_ref(py))
    }

    #[getter]
    fn shading_normal(&self, py: Python<'_>) -> PyResult<Py<PyArray1<f64>>> {
        Ok(self.surfaces(py)?.shading_normal.clone_ref(py))
    }

    #[getter]
    fn uv(&self, py: Python<'_>) -> PyResult<Py<PyArray1<f64>>> {
        Ok(self.surfaces(py)?.uv.clone_ref(py))
    }
}
