//! Materials and backgrounds.

use crate::convert::{Triple, color, vector};
use crate::errors;
use crate::textures::{InteriorNumbers, Pigment, Texture};
use pyo3::prelude::*;
use std::sync::Arc;
use strahl::math::Transform;
use strahl::prelude::{DVec3, Sides, SkySphere};
use strahl::shade::Finish;
use strahl::shade::texture::SharedTexture;

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

    /// A material with a texture, and another one seen from inside.
    #[staticmethod]
    fn textured(texture: &Texture, inner: Option<&Texture>, name: String) -> Self {
        let shared = |texture: &Texture| SharedTexture(Arc::clone(&texture.0));
        Self(Arc::new(strahl::prelude::Material {
            name,
            inner_texture: inner.map(shared),
            ..strahl::prelude::Material::textured(shared(texture))
        }))
    }

    fn with_interior(&self, interior: InteriorNumbers) -> Self {
        let interior = strahl::prelude::Interior::from(interior);
        Self(Arc::new(strahl::prelude::Material {
            eta: interior.ior,
            interior: Some(Arc::new(interior)),
            ..(*self.0).clone()
        }))
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

    /// Layers of pigments by direction, the lowest first.
    #[staticmethod]
    fn sky(layers: Vec<Py<Pigment>>, emission: Triple, behind: Triple) -> Self {
        let layers = layers.iter().map(|layer| layer.get().0.clone()).collect();
        Self(strahl::prelude::Background::Sky(Arc::new(SkySphere {
            layers,
            transform: Transform::IDENTITY,
            emission: color(emission),
            behind: color(behind),
            tints_layers: true,
        })))
    }
}
