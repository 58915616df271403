//! Materials, lights, cameras and backgrounds.

use crate::convert::{Triple, color, vector};
use crate::errors;
use pyo3::prelude::*;
use std::sync::Arc;
use strahl::prelude::{AreaLight, DVec3, Falloff, Lens, Projection, Sides};
use strahl::scene::{SceneLight, Span};
use strahl::shade::{Finish, LightKind};

/// A material; objects share it.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Material(pub(crate) Arc<strahl::prelude::Material>);

/// A material in numbers: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct MaterialNumbers {
    ambient: Triple,
    diffuse: Triple,
    specular: Triple,
    shininess: f64,
    reflection: Triple,
    transmission: Triple,
    emission: Triple,
    ior: f64,
    absorption: Triple,
    fresnel: bool,
    thin: bool,
    one_sided: bool,
    model: Option<String>,
    name: String,
}

#[pymethods]
impl Material {
    #[new]
    fn new(numbers: MaterialNumbers) -> PyResult<Self> {
        let n = numbers;
        let model = n.model.map(|name| name.parse().map_err(errors::value));
        Ok(Self(Arc::new(strahl::prelude::Material {
            name: n.name,
            model: model.transpose()?,
            eta: n.ior,
            absorption: color(n.absorption),
            fresnel: n.fresnel,
            thin: n.thin,
            sides: if n.one_sided {
                Sides::Front
            } else {
                Sides::Two
            },
            ..strahl::prelude::Material::with_finish(Finish {
                ambient: color(n.ambient),
                diffuse: color(n.diffuse),
                specular: color(n.specular),
                shininess: n.shininess,
                reflection: color(n.reflection),
                transmission: color(n.transmission),
                emission: color(n.emission),
            })
        })))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    fn named(&self, name: String) -> Self {
        Self(Arc::new((*self.0).clone().named(name)))
    }
}

/// A light source.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Light(pub(crate) SceneLight);

/// A light in numbers: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct LightNumbers {
    kind: String,
    position: Triple,
    direction: Triple,
    /// Half angles in radians, or radii.
    inner: f64,
    outer: f64,
    tightness: f64,
    color: Triple,
    inverse_square: bool,
    fade: Option<(f64, f64)>,
    shadows: bool,
    highlights: bool,
    area: Option<Area>,
    name: Option<String>,
}

/// The extent of an area light.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Area {
    axis_1: Triple,
    axis_2: Triple,
    size: (u32, u32),
    jitter: bool,
    circular: bool,
    orient: bool,
    adaptive: Option<u32>,
}

#[pymethods]
impl Light {
    #[new]
    fn new(numbers: LightNumbers) -> PyResult<Self> {
        let n = numbers;
        let (position, direction) = (vector(n.position), vector(n.direction).normalize_or_zero());
        if n.kind != "point" && direction == DVec3::ZERO {
            return Err(errors::value("the light needs a direction other than zero"));
        }
        let kind = match n.kind.as_str() {
            "point" => LightKind::Point { position },
            "directional" => LightKind::Directional { direction },
            "spot" => LightKind::Spot {
                position,
                direction,
                cos_inner: strahl::math::det::cos(n.inner),
                cos_outer: strahl::math::det::cos(n.outer),
                tightness: n.tightness,
            },
            "parallel" => LightKind::Parallel {
                position,
                direction,
            },
            "beam" => LightKind::Beam {
                position,
                direction,
                inner: n.inner,
                outer: n.outer,
                tightness: n.tightness,
            },
            other => return Err(errors::value(format!("there is no light `{other}`"))),
        };
        let mut light = strahl::prelude::Light::new(kind, color(n.color));
        light.falloff = match (n.inverse_square, n.fade) {
            (true, _) => Falloff::InverseSquare,
            (false, Some((distance, power))) => Falloff::Fade { distance, power },
            (false, None) => Falloff::None,
        };
        light.casts_shadows = n.shadows;
        light.highlights = n.highlights;
        light.area = n.area.map(|area| AreaLight {
            jitter: area.jitter,
            circular: area.circular,
            orient: area.orient,
            adaptive: area.adaptive,
            ..AreaLight::new(
                vector(area.axis_1),
                vector(area.axis_2),
                area.size.0,
                area.size.1,
            )
        });
        Ok(Self(SceneLight {
            light,
            mask: None,
            name: n.name.map(Into::into),
            span: Span::NONE,
        }))
    }
}

/// A camera.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Camera(pub(crate) strahl::prelude::Camera);

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
        let wide = |projection| {
            strahl::prelude::Camera::looking(eye, look_at - eye, up, 0.5, 0.5, projection)
        };
        let camera = match projection {
            "perspective" => strahl::prelude::Camera::perspective(eye, look_at, up, first),
            "orthographic" => strahl::prelude::Camera::orthographic(eye, look_at, up, first),
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
        let camera = strahl::prelude::Camera { aspect, ..camera };
        match camera.problem() {
            None => Ok(Self(camera)),
            Some(problem) => Err(errors::value(problem)),
        }
    }

    fn focused(&self, aperture: f64, focal_point: Triple, samples: u32) -> Self {
        let lens = Lens::new(aperture, vector(focal_point), samples);
        Self(strahl::prelude::Camera {
            lens: Some(lens),
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

/// What rays see that hit nothing.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Background(pub(crate) strahl::prelude::Background);

#[pymethods]
impl Background {
    #[staticmethod]
    fn solid(of: Triple) -> Self {
        Self(strahl::prelude::Background::Solid(color(of)))
    }

    #[staticmethod]
    fn gradient(bottom: Triple, top: Triple, up: Triple) -> PyResult<Self> {
        let up = vector(up).normalize_or_zero();
        if up == DVec3::ZERO {
            return Err(errors::value("up must not be zero"));
        }
        Ok(Self(strahl::prelude::Background::Gradient {
            up,
            bottom: color(bottom),
            top: color(top),
        }))
    }
}
