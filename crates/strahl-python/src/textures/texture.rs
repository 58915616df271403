//! Textures: pigment, normal and finish together.

use crate::convert::{Triple, color};
use crate::errors;
use crate::maps::Map;
use crate::textures::normal::Normal;
use crate::textures::pattern::Pattern;
use crate::textures::pigment::Pigment;
use pyo3::prelude::*;
use std::sync::Arc;
use strahl::prelude::{Interior, PlainTexture, PovFinish, Texture as Of};
use strahl::shade::SharedList;
use strahl::shade::patterns::Pattern as Kind;
use strahl::shade::pigment::BlendMap;
use strahl::shade::pov_finish::{Iridescence, PovReflection};

/// A texture, which materials share. It never changes.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Texture(pub(crate) Arc<Of>);

/// A finish in numbers: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct FinishNumbers {
    ambient: Triple,
    emission: Triple,
    diffuse: f64,
    diffuse_back: f64,
    brilliance: f64,
    phong: f64,
    phong_size: f64,
    specular: f64,
    roughness: f64,
    metallic: f64,
    reflection: (Triple, Triple),
    fresnel: bool,
    reflection_falloff: f64,
    reflection_exponent: f64,
    reflection_metallic: f64,
    conserve_energy: bool,
    crand: f64,
    irid: Option<(f64, f64, f64)>,
}

impl From<FinishNumbers> for PovFinish {
    fn from(n: FinishNumbers) -> Self {
        Self {
            ambient: color(n.ambient),
            emission: color(n.emission),
            diffuse: n.diffuse,
            diffuse_back: n.diffuse_back,
            brilliance: n.brilliance,
            phong: n.phong,
            phong_size: n.phong_size,
            specular: n.specular,
            roughness: n.roughness,
            metallic: n.metallic,
            reflection: PovReflection {
                min: color(n.reflection.0),
                max: color(n.reflection.1),
                fresnel: n.fresnel,
                falloff: n.reflection_falloff,
                exponent: n.reflection_exponent,
                metallic: n.reflection_metallic,
            },
            conserve_energy: n.conserve_energy,
            crand: n.crand,
            irid: n.irid.map(|(amount, thickness, turbulence)| Iridescence {
                amount,
                thickness,
                turbulence,
            }),
            ..Self::default()
        }
    }
}

/// An interior in numbers: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct InteriorNumbers {
    ior: f64,
    fade_distance: f64,
    fade_power: f64,
    fade_color: Triple,
    dispersion: f64,
    dispersion_samples: u16,
    caustics: f64,
}

impl From<InteriorNumbers> for Interior {
    fn from(n: InteriorNumbers) -> Self {
        Self {
            ior: n.ior,
            fade_distance: n.fade_distance,
            fade_power: n.fade_power,
            fade_color: color(n.fade_color),
            dispersion: n.dispersion,
            dispersion_samples: n.dispersion_samples,
            caustics: n.caustics,
        }
    }
}

impl Texture {
    fn of(texture: Of) -> Self {
        Self(Arc::new(texture))
    }
}

fn all(members: &[Py<Texture>]) -> SharedList<Of> {
    let members = members.iter();
    members.map(|texture| (*texture.get().0).clone()).collect()
}

fn members(entries: &[(f64, Py<Texture>)]) -> SharedList<(f64, Of)> {
    let entries = entries.iter();
    entries
        .map(|(number, texture)| (*number, (*texture.get().0).clone()))
        .collect()
}

#[pymethods]
impl Texture {
    #[new]
    fn new(pigment: &Pigment, normal: Option<&Normal>, finish: FinishNumbers) -> Self {
        Self::of(Of::Plain(PlainTexture {
            pigment: pigment.0.clone(),
            normal: normal.map(|normal| Box::new(normal.0.clone())),
            finish: Arc::new(finish.into()),
        }))
    }

    /// Over each other, the lowest first.
    #[staticmethod]
    fn layered(layers: Vec<Py<Self>>) -> Self {
        Self::of(Of::Layered(all(&layers)))
    }

    #[staticmethod]
    fn map(pattern: &Pattern, entries: Vec<(f64, Py<Self>)>) -> Self {
        let map = BlendMap::new(members(&entries));
        Self::of(Of::Map(Box::new(pattern.0.clone()), map))
    }

    #[staticmethod]
    fn blocks(pattern: &Pattern, members: Vec<Py<Self>>) -> Self {
        Self::of(Of::Blocks(Box::new(pattern.0.clone()), all(&members)))
    }

    #[staticmethod]
    fn average(entries: Vec<(f64, Py<Self>)>) -> Self {
        Self::of(Of::Average(members(&entries), Box::default()))
    }

    /// The texture whose number the texel of a picture is.
    #[staticmethod]
    fn picture(pattern: &Pattern, members: Vec<Py<Self>>) -> PyResult<Self> {
        let Kind::Image(image) = &pattern.0.pattern else {
            return Err(errors::value("only patterns of images have texels"));
        };
        let modifiers = Box::new(pattern.0.modifiers.clone());
        let map = Of::MaterialMap(Arc::clone(image), modifiers, all(&members));
        Ok(Self::of(map))
    }

    /// By the texture coordinates of surfaces.
    fn uv_mapped(&self) -> Self {
        Self::of(Of::UvMapped(Box::new((*self.0).clone())))
    }

    fn transformed(&self, map: &Map) -> Self {
        let (map, of) = match &*self.0 {
            Of::Transformed(before, of) => (before.then(&map.0), of.clone()),
            other => (map.0, Box::new(other.clone())),
        };
        Self::of(Of::Transformed(Box::new(map), of))
    }
}
