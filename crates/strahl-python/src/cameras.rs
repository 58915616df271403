//! Cameras.

use crate::convert::{Triple, contiguous, vector, vectors, vectors_2};
use crate::errors;
use crate::textures::Normal;
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use std::sync::Arc;
use strahl::prelude::{Camera as Of, DVec3, Lens, Projection};
use strahl::scene::{Bokeh, CameraFace, CameraFront, MeshCamera, MeshLayout};

/// A camera.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Camera(pub(crate) Of);

/// A lens in numbers: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct LensNumbers<'py> {
    aperture: f64,
    focal_point: Triple,
    /// The least and the most.
    samples: (u32, u32),
    confidence: f64,
    variance: f64,
    /// As many rows as columns, of weights.
    bokeh: Option<PyReadonlyArray2<'py, f64>>,
}

/// What the corners of a face have.
fn of_corners<T: Copy>(row: &[u32; 3], all: &[T]) -> [T; 3] {
    row.map(|number| all[number as usize])
}

#[pymethods]
impl Camera {
    /// `numbers` are angles in radians, or the height of an orthographic view; a cylinder is upright or not, and the eye moves along it or not.
    #[new]
    fn new(
        projection: &str,
        eye: Triple,
        look_at: Triple,
        up: Triple,
        numbers: (f64, f64),
        aspect: Option<f64>,
        cylinder: (bool, bool),
    ) -> PyResult<Self> {
        let (eye, look_at, up) = (vector(eye), vector(look_at), vector(up));
        let (first, second) = numbers;
        let (upright, moving) = cylinder;
        let wide = |projection| Of::looking(eye, look_at - eye, up, 0.5, 0.5, projection);
        let camera = match projection {
            "perspective" => Of::perspective(eye, look_at, up, first),
            "orthographic" => Of::orthographic(eye, look_at, up, first),
            "fisheye" => wide(Projection::Fisheye { angle: first }),
            "ultra_wide_angle" => wide(Projection::UltraWideAngle { angle: first }),
            "omnimax" => wide(Projection::Omnimax),
            "panoramic" => wide(Projection::Panoramic),
            "spherical" => wide(Projection::Spherical {
                horizontal: first,
                vertical: second,
            }),
            "cylinder" => wide(Projection::Cylinder {
                upright,
                moving,
                angle: first,
            }),
            other => return Err(errors::value(format!("there is no projection `{other}`"))),
        };
        let camera = Of { aspect, ..camera };
        match camera.problem() {
            None => Ok(Self(camera)),
            Some(problem) => Err(errors::value(problem)),
        }
    }

    /// Rays from the faces of a mesh, along their normals: a pixel for each, or by texture coordinates (with normals at the corners, if there are any).
    #[staticmethod]
    fn mesh(
        vertices: PyReadonlyArray2<'_, f64>,
        faces: PyReadonlyArray2<'_, u32>,
        normals: Option<PyReadonlyArray2<'_, f64>>,
        uv: Option<PyReadonlyArray2<'_, f64>>,
        offset: f64,
        reversed: bool,
    ) -> PyResult<Self> {
        let corners = vectors(&vertices)?;
        let normals = normals.as_ref().map(vectors).transpose()?;
        let uvs = uv.as_ref().map(vectors_2).transpose()?;
        let (rows, _) = contiguous(&faces)?.as_chunks::<3>();
        let face = |row: &[u32; 3]| CameraFace {
            corners: of_corners(row, &corners),
            front: CameraFront::Counterclockwise,
            normals: normals.as_ref().map(|all| of_corners(row, all)),
            uv: uvs.as_ref().map(|all| of_corners(row, all)),
        };
        let known = [
            Some(corners.len()),
            normals.as_ref().map(Vec::len),
            uvs.as_ref().map(Vec::len),
        ];
        let least = known.into_iter().flatten().min().unwrap_or(0);
        if rows.is_empty() || rows.as_flattened().iter().any(|n| *n as usize >= least) {
            return Err(errors::value("faces must have vertices that there are"));
        }
        let faces: Vec<CameraFace> = rows.iter().map(face).collect();
        let projection = Projection::Mesh(Arc::new(MeshCamera {
            layout: match uvs {
                None => MeshLayout::Each(1),
                Some(_) => MeshLayout::ByUv,
            },
            meshes: vec![faces.into()],
            offset,
            reversed,
            smooth: normals.is_some(),
        }));
        let (eye, up) = (DVec3::ZERO, DVec3::Y);
        Ok(Self(Of::looking(
            eye,
            DVec3::NEG_Z,
            up,
            0.5,
            0.5,
            projection,
        )))
    }

    fn focused(&self, lens: LensNumbers) -> PyResult<Self> {
        let bokeh = match &lens.bokeh {
            None => None,
            Some(weights) => {
                let (list, side) = (contiguous(weights)?, weights.shape()[0]);
                let cell = |at: f64| ((at * side as f64) as usize).min(side - 1);
                // The first row is the top.
                let bokeh = Bokeh::new(|x, y| list[cell(1.0 - y) * side + cell(x)]);
                Some(Arc::new(bokeh.ok_or_else(|| {
                    errors::value("bokeh must have a positive number at least")
                })?))
            }
        };
        Ok(Self(Of {
            lens: Some(Lens {
                min_samples: lens.samples.0,
                confidence: lens.confidence,
                variance: lens.variance,
                bokeh,
                ..Lens::new(lens.aperture, vector(lens.focal_point), lens.samples.1)
            }),
            ..self.0.clone()
        }))
    }

    /// With a normal that tilts the rays.
    fn rippled(&self, normal: &Normal) -> Self {
        Self(Of {
            normal: Some(Arc::new(normal.0.clone())),
            ..self.0.clone()
        })
    }

    #[getter]
    fn projection(&self) -> &'static str {
        self.0.projection.name()
    }

    #[getter]
    fn eye(&self) -> (f64, f64, f64) {
        self.0.eye.into()
    }

    #[getter]
    fn direction(&self) -> (f64, f64, f64) {
        self.0.direction.into()
    }

    #[getter]
    fn right(&self) -> (f64, f64, f64) {
        self.0.right.into()
    }

    #[getter]
    fn up(&self) -> (f64, f64, f64) {
        self.0.up.into()
    }
}
