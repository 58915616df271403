//! What many rays have hit, as arrays.

use crate::queries::Asked;
use crate::{convert, work};
use numpy::PyArray1;
use pyo3::prelude::*;
use std::sync::{Arc, OnceLock};
use strahl::prelude::Hit;
use strahl::tracing::{HitSurface, Session};

/// The nearest hits of rays. What is beyond `t` is computed when it is first asked for.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Hits {
    asked: Asked,
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
    fn new(session: &Session, surfaces: &[Option<HitSurface>], hits: &[Option<Hit>]) -> Self {
        const NAN: [f64; 3] = [f64::NAN; 3];
        let list = Lists { session, surfaces };
        let element = |hit: Hit| hit.id.cast_signed();
        Self {
            object: list.of(-1, |s| number(s.object)),
            material: list.of(-1, |s| number(s.material)),
            element: session.list(hits.len(), |i| hits[i].map_or(-1, element)),
            position: list.of(NAN, |s| s.position.to_array()),
            normal: list.of(NAN, |s| s.normal.to_array()),
            shading_normal: list.of(NAN, |s| s.shading_normal.to_array()),
            uv: list.of([f64::NAN; 2], |s| s.uv.to_array()),
        }
    }
}

/// Makes lists of what surfaces have.
struct Lists<'a> {
    session: &'a Session,
    surfaces: &'a [Option<HitSurface>],
}

impl Lists<'_> {
    fn of<T: Copy + Send + Sync>(&self, none: T, of: impl Fn(&HitSurface) -> T + Sync) -> Vec<T> {
        let entry = |i: usize| self.surfaces[i].as_ref().map_or(none, &of);
        self.session.list(self.surfaces.len(), entry)
    }
}

impl Hits {
    pub(crate) fn new(py: Python<'_>, asked: Asked, hits: Vec<Option<Hit>>) -> Self {
        let t = |i: usize| hits[i].map_or(f64::INFINITY, |hit: Hit| hit.t);
        let t = py.detach(|| asked.session.list(hits.len(), t));
        Self {
            t: convert::frozen(py, t),
            asked,
            hits: Arc::new(hits),
            surfaces: OnceLock::new(),
        }
    }

    fn surfaces(&self, py: Python<'_>) -> PyResult<&Surfaces> {
        if let Some(known) = self.surfaces.get() {
            return Ok(known);
        }
        let (scene, rays) = (Arc::clone(&self.asked.scene), Arc::clone(&self.asked.rays));
        let (session, hits) = (self.asked.session.clone(), Arc::clone(&self.hits));
        let columns = work::run(py, move || {
            let mut surfaces = session.list(hits.len(), |_| None);
            session.surfaces(&scene, &rays, &hits, &mut surfaces);
            Columns::new(&session, &surfaces, &hits)
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
