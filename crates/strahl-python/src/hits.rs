//! What many rays have hit, as arrays.

use crate::asked::Asked;
use crate::convert::{self, number};
use crate::found::Found;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use std::sync::OnceLock;
use strahl::tracing::{HitSurface, Session};

/// The nearest hits of rays. What is beyond `t` is computed when it is first asked for.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Hits {
    asked: Asked,
    /// Infinite for a miss.
    t: Py<PyArray1<f64>>,
    count: usize,
    found: Found,
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

impl Columns {
    fn new(session: &Session, surfaces: &[Option<(u64, HitSurface)>]) -> Self {
        const NAN: [f64; 3] = [f64::NAN; 3];
        let list = Lists { session, surfaces };
        Self {
            object: list.of(-1, |s| number(s.object)),
            material: list.of(-1, |s| number(s.material)),
            element: session.list(surfaces.len(), |i| {
                surfaces[i].as_ref().map_or(-1, |(id, _)| id.cast_signed())
            }),
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
    surfaces: &'a [Option<(u64, HitSurface)>],
}

impl Lists<'_> {
    fn of<T: Copy + Send + Sync>(&self, none: T, of: impl Fn(&HitSurface) -> T + Sync) -> Vec<T> {
        let entry = |i: usize| self.surfaces[i].as_ref().map_or(none, |(_, s)| of(s));
        self.session.list(self.surfaces.len(), entry)
    }
}

impl Hits {
    pub(crate) fn new(py: Python<'_>, asked: Asked, t: Vec<f64>, found: Found) -> Self {
        Self {
            asked,
            count: t.len(),
            t: convert::frozen(py, t),
            found,
            surfaces: OnceLock::new(),
        }
    }

    fn surfaces(&self, py: Python<'_>) -> PyResult<&Surfaces> {
        if let Some(known) = self.surfaces.get() {
            return Ok(known);
        }
        let t = self.t.bind(py).readonly();
        let (t, Asked { scene, session }) = (convert::list(&t)?, &self.asked);
        let columns = self.asked.run(py, self.count, |stop| {
            let surface = |i: usize| {
                let (ray, hit) = self.found.get(i, t[i]);
                let is_hit = hit.t.is_finite() && !stop.is_set();
                is_hit.then(|| (hit.id, scene.surface(&ray, &hit)))
            };
            Columns::new(session, &session.list(self.count, surface))
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
        self.count
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
