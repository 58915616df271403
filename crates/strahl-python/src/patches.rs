//! Constructors of free-form surfaces.

use crate::convert::{list, vectors, vectors_2};
use crate::errors;
use crate::object::Object;
use crate::shapes::{Place, object};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use std::sync::Arc;
use strahl::geometry::{
    Nurbs, NurbsBrep, NurbsCurve, NurbsData, Subdivision, SubdivisionData, SubdivisionScheme,
    TrimLoop,
};
use strahl::prelude::{BicubicPatch, DVec3};
use strahl::scene::nurbs_faces;

/// Adds all functions to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(bicubic_patch, module)?)?;
    module.add_function(wrap_pyfunction!(nurbs, module)?)?;
    module.add_function(wrap_pyfunction!(brep, module)?)?;
    module.add_function(wrap_pyfunction!(subdivision, module)?)
}

/// 16 points row by row, and their weights.
#[pyfunction]
fn bicubic_patch(
    points: PyReadonlyArray2<'_, f64>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    place: Place,
) -> PyResult<Object> {
    fn square<T: Copy>(all: &[T]) -> PyResult<[[T; 4]; 4]> {
        let wrong = || errors::value("a patch has 4 x 4 points");
        let (rows, []) = all.as_chunks::<4>() else {
            return Err(wrong());
        };
        rows.try_into().map_err(|_| wrong())
    }
    let points: [[DVec3; 4]; 4] = square(&vectors(&points)?)?;
    let patch = match &weights {
        None => BicubicPatch::try_new(points),
        Some(weights) => BicubicPatch::try_rational(points, square(list(weights)?)?),
    };
    object(Arc::new(patch.map_err(errors::value)?), place)
}

/// A curve in the plane of the parameters: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct CurveNumbers<'py> {
    degree: u32,
    points: PyReadonlyArray2<'py, f64>,
    weights: Vec<f64>,
    knots: Option<Vec<f64>>,
}

impl CurveNumbers<'_> {
    fn curve(self) -> PyResult<NurbsCurve> {
        let mut curve = NurbsCurve::new(self.degree, vectors_2(&self.points)?);
        curve.weights = self.weights;
        if let Some(knots) = self.knots {
            curve.knots = knots;
        }
        Ok(curve)
    }
}

/// Control points in rows of `columns`; knots along both; loops with whether they are holes.
#[pyfunction]
fn nurbs(
    degree: [u32; 2],
    columns: usize,
    points: PyReadonlyArray2<'_, f64>,
    weights: Vec<f64>,
    knots: Option<[Vec<f64>; 2]>,
    loops: Vec<(Vec<CurveNumbers<'_>>, bool)>,
    place: Place,
) -> PyResult<Object> {
    let mut data = NurbsData::new(degree, columns, vectors(&points)?);
    data.weights = weights;
    if let Some(knots) = knots {
        data.knots = knots;
    }
    let trim = |(curves, is_hole): (Vec<CurveNumbers<'_>>, bool)| {
        let curves: PyResult<_> = curves.into_iter().map(CurveNumbers::curve).collect();
        curves.map(|curves| TrimLoop { curves, is_hole })
    };
    let loops = loops.into_iter().map(trim).collect::<PyResult<Vec<_>>>()?;
    let surface = Nurbs::try_trimmed(&data, &loops).map_err(errors::value)?;
    object(Arc::new(surface), place)
}

/// The solid within NURBS surfaces, also transformed ones and unions of them.
#[pyfunction]
fn brep(faces: Vec<Py<Object>>, place: Place) -> PyResult<Object> {
    let mut surfaces = vec![];
    for face in &faces {
        let own = nurbs_faces(&face.get().0.object);
        surfaces.extend(own.map_err(|kind| {
            errors::value(format!("a face must be a nurbs surface, not {kind}"))
        })?);
    }
    let solid = NurbsBrep::try_new(&surfaces).map_err(errors::value)?;
    object(Arc::new(solid), place)
}

/// The control mesh of a subdivision surface: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct SubdivisionNumbers<'py> {
    scheme: String,
    points: PyReadonlyArray2<'py, f64>,
    /// The number of corners of each face.
    sizes: Vec<u32>,
    /// The corners of all faces, one face after the other.
    indices: Vec<u32>,
    /// The ends and the sharpness of each edge.
    creases: Vec<([u32; 2], f64)>,
    corners: Vec<(u32, f64)>,
    /// For each corner of all faces.
    uv: Option<PyReadonlyArray2<'py, f64>>,
}

#[pyfunction]
fn subdivision(numbers: SubdivisionNumbers<'_>, place: Place) -> PyResult<Object> {
    let n = numbers;
    let scheme = match n.scheme.as_str() {
        "catmull-clark" => SubdivisionScheme::CatmullClark,
        "loop" => SubdivisionScheme::Loop,
        other => {
            return Err(errors::value(format!(
                "there is no scheme `{other}`; the schemes are catmull-clark and loop"
            )));
        }
    };
    let data = SubdivisionData {
        scheme,
        points: vectors(&n.points)?,
        sizes: n.sizes,
        indices: n.indices,
        creases: n.creases,
        corners: n.corners,
        uvs: n.uv.as_ref().map_or(Ok(vec![]), vectors_2)?,
    };
    let surface = Subdivision::try_new(&data).map_err(errors::value)?;
    object(Arc::new(surface), place)
}
