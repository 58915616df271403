//! Films, with their numbers as arrays.

use crate::{convert, errors, work};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use strahl::formats::image::{BitDepth, ImageFormat, Picture, WriteOptions, encode_picture};
use strahl::tracing::{PixelInfo, RayCounts, Rendered};

/// A picture. The pixels are in an array of Python's, everything else is here.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Film {
    /// Without pixels.
    rest: Arc<strahl::tracing::Film>,
    /// Row by row.
    pixels: Py<PyArray1<f32>>,
    rays: RayCounts,
    /// Of the pixels, if they are asked for: tests, steps, rays, depth, nanoseconds.
    costs: Option<Vec<strahl::tracing::PixelCost>>,
}

impl Film {
    pub(crate) fn new(py: Python<'_>, rendered: Rendered) -> Self {
        let mut film = rendered.film;
        let pixels = std::mem::take(&mut film.pixels).into_flattened();
        Self {
            rest: Arc::new(film),
            pixels: convert::frozen(py, pixels),
            rays: rendered.rays,
            costs: rendered.costs,
        }
    }

    /// All of it in one.
    fn whole(&self, py: Python<'_>) -> PyResult<strahl::tracing::Film> {
        let pixels = self.pixels.bind(py).readonly();
        let (pixels, _) = pixels.as_slice().map_err(errors::value)?.as_chunks::<3>();
        Ok(strahl::tracing::Film {
            pixels: pixels.to_vec(),
            ..(*self.rest).clone()
        })
    }

    fn floats<const N: usize>(
        &self,
        py: Python<'_>,
        of: impl Fn(&PixelInfo) -> [f32; N],
    ) -> Option<Py<PyArray1<f32>>> {
        let info = self.rest.info.as_ref()?;
        let all: Vec<[f32; N]> = info.iter().map(of).collect();
        Some(convert::frozen(py, all.into_flattened()))
    }

    fn numbers(&self, py: Python<'_>, of: impl Fn(&PixelInfo) -> i32) -> Option<Py<PyArray1<i32>>> {
        let info = self.rest.info.as_ref()?;
        Some(convert::frozen(py, info.iter().map(of).collect()))
    }
}

/// A number counted from 1, with 0 for none, as one counted from 0, with -1 for none.
fn from_zero(number: u32) -> i32 {
    i32::try_from(i64::from(number) - 1).unwrap_or(i32::MAX)
}

#[pymethods]
impl Film {
    /// Width and height of the whole picture.
    #[getter]
    fn size(&self) -> (u32, u32) {
        (self.rest.width, self.rest.height)
    }

    /// x, y, width and height of the part that the film holds.
    #[getter]
    fn region(&self) -> (u32, u32, u32, u32) {
        let r = self.rest.region;
        (r.x, r.y, r.width, r.height)
    }

    /// Linear RGB, three numbers for each pixel.
    #[getter]
    fn pixels(&self, py: Python<'_>) -> Py<PyArray1<f32>> {
        self.pixels.clone_ref(py)
    }

    #[getter]
    fn alpha(&self, py: Python<'_>) -> Option<Py<PyArray1<f32>>> {
        let alpha = self.rest.alpha.as_ref()?;
        Some(convert::frozen(py, alpha.clone()))
    }

    #[getter]
    fn has_layers(&self) -> bool {
        self.rest.info.is_some()
    }

    fn depth(&self, py: Python<'_>) -> Option<Py<PyArray1<f32>>> {
        self.floats(py, |info| [info.depth])
    }

    fn normal(&self, py: Python<'_>) -> Option<Py<PyArray1<f32>>> {
        self.floats(py, |info| info.normal)
    }

    fn position(&self, py: Python<'_>) -> Option<Py<PyArray1<f32>>> {
        self.floats(py, |info| info.position)
    }

    fn object(&self, py: Python<'_>) -> Option<Py<PyArray1<i32>>> {
        self.numbers(py, |info| from_zero(info.object))
    }

    fn material(&self, py: Python<'_>) -> Option<Py<PyArray1<i32>>> {
        self.numbers(py, |info| from_zero(info.material))
    }

    fn tree_depth(&self, py: Python<'_>) -> Option<Py<PyArray1<i32>>> {
        self.numbers(py, |info| convert::number(info.tree_depth))
    }

    fn tests(&self, py: Python<'_>) -> Option<Py<PyArray1<i32>>> {
        self.numbers(py, |info| convert::number(info.tests))
    }

    /// Costs of the pixels by name, if they were asked for.
    fn costs(&self, py: Python<'_>) -> Option<BTreeMap<&'static str, Py<PyArray1<i64>>>> {
        type Of = fn(&strahl::tracing::PixelCost) -> u64;
        let columns: [(&str, Of); 5] = [
            ("tests", |cost| cost.tests),
            ("steps", |cost| cost.steps),
            ("rays", |cost| cost.rays),
            ("depth", |cost| u64::from(cost.depth)),
            ("nanoseconds", |cost| cost.nanoseconds),
        ];
        let costs = self.costs.as_ref()?;
        let column = |of: Of| {
            let values = costs.iter().map(|c| of(c).cast_signed()).collect();
            convert::frozen(py, values)
        };
        Some(columns.map(|(name, of)| (name, column(of))).into())
    }

    /// Number of rays by kind.
    #[getter]
    fn rays(&self) -> BTreeMap<&'static str, u64> {
        let rays = &self.rays;
        BTreeMap::from([
            ("primary", rays.primary),
            ("shadow", rays.shadow),
            ("reflection", rays.reflection),
            ("transparency", rays.refraction),
            ("hits", rays.hits()),
            ("cut_trees", rays.cut_trees),
            ("total", rays.total()),
        ])
    }

    fn sha256(&self, py: Python<'_>) -> PyResult<String> {
        let film = self.whole(py)?;
        work::run(py, move || film.sha256())
    }

    /// sRGB codes of 8 bits, three for each pixel.
    fn to_srgb8(&self, py: Python<'_>) -> PyResult<Py<PyArray1<u8>>> {
        let film = self.whole(py)?;
        let codes = work::run(py, move || film.to_srgb8())?;
        Ok(PyArray1::from_vec(py, codes).unbind())
    }

    fn save(&self, py: Python<'_>, path: PathBuf, bit_depth: Option<u8>) -> PyResult<()> {
        let mut film = self.whole(py)?;
        // Layers are written where the format has them.
        if ImageFormat::from_path(&path).is_ok_and(|format| !format.info().layers) {
            film.info = None;
        }
        let mut options = WriteOptions::default();
        match bit_depth {
            None => {}
            Some(8) => options.bit_depth = BitDepth::Eight,
            Some(16) => options.bit_depth = BitDepth::Sixteen,
            Some(other) => {
                return Err(errors::value(format!(
                    "bit_depth must be 8 or 16, not {other}"
                )));
            }
        }
        work::run(py, move || strahl::save(&path, &film, &options))?
            .map_err(|error| errors::image(&error))
    }

    /// The picture as a PNG file of 8 bits per channel.
    fn png<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let film = self.whole(py)?;
        let bytes = work::run(py, move || {
            let (format, mut bytes) = (ImageFormat::Png, Vec::new());
            let picture = strahl::picture(&film, &[], strahl::metadata());
            encode_picture(&mut bytes, format, &picture, &WriteOptions::default()).map(|()| bytes)
        })?
        .map_err(|error| errors::image(&error))?;
        Ok(PyBytes::new(py, &bytes))
    }
}

/// Linear colours as a PNG file of 8 bits per channel: for pictures in the making.
#[pyfunction]
pub(crate) fn encode_png<'py>(
    py: Python<'py>,
    pixels: PyReadonlyArray2<'py, f32>,
    width: u32,
    height: u32,
) -> PyResult<Bound<'py, PyBytes>> {
    let (pixels, _) = convert::contiguous(&pixels)?.as_chunks::<3>();
    let mut bytes = Vec::new();
    let picture = Picture::new(width, height, pixels);
    let options = WriteOptions::default();
    encode_picture(&mut bytes, ImageFormat::Png, &picture, &options)
        .map_err(|error| errors::image(&error))?;
    Ok(PyBytes::new(py, &bytes))
}
