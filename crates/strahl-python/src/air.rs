//! What fills the space between objects: fog and rainbows.

use crate::convert::{ColorNumbers, Triple, vector};
use crate::errors;
use crate::textures::Octaves;
use pyo3::prelude::*;
use strahl::math::DVec3;
use strahl::math::noise::NoiseGenerator;
use strahl::prelude::FogKind;
use strahl::scene::{FogTurbulence, Span};
use strahl::shade::ColorFt;
use strahl::shade::pigment::BlendMap;

/// A fog.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Fog(pub(crate) strahl::prelude::Fog);

/// A fog in numbers: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct FogNumbers {
    color: ColorNumbers,
    distance: f64,
    /// Upwards, offset and altitude of ground fog.
    ground: Option<(Triple, f64, f64)>,
    /// Scale, strength and octaves of noise.
    turbulence: Option<(Triple, f64, Octaves)>,
}

fn unit(direction: Triple, name: &str) -> PyResult<DVec3> {
    let unit = vector(direction).normalize_or_zero();
    match unit == DVec3::ZERO {
        true => Err(errors::value(format!("{name} must not be zero"))),
        false => Ok(unit),
    }
}

#[pymethods]
impl Fog {
    #[new]
    fn new(numbers: FogNumbers) -> PyResult<Self> {
        let kind = match numbers.ground {
            None => FogKind::Constant,
            Some((up, offset, altitude)) => FogKind::Ground {
                up: unit(up, "up")?,
                offset,
                altitude,
            },
        };
        let turbulence = numbers
            .turbulence
            .map(|(scale, strength, octaves)| FogTurbulence {
                scale: vector(scale),
                strength,
                octaves: octaves.into(),
                noise: NoiseGenerator::default(),
            });
        Ok(Self(strahl::prelude::Fog {
            kind,
            distance: numbers.distance,
            color: numbers.color.into(),
            turbulence,
            span: Span::NONE,
        }))
    }
}

/// A rainbow.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Rainbow(pub(crate) strahl::prelude::Rainbow);

/// A rainbow in numbers: a dictionary that the Python half makes. Angles are degrees.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct RainbowNumbers {
    direction: Triple,
    up: Triple,
    angle: f64,
    width: f64,
    arc_angle: f64,
    falloff_angle: f64,
    distance: f64,
    colors: Vec<(f64, ColorNumbers)>,
    jitter: f64,
}

#[pymethods]
impl Rainbow {
    #[new]
    fn new(numbers: RainbowNumbers) -> PyResult<Self> {
        let n = numbers;
        let colors = n.colors.into_iter();
        let colors: Vec<(f64, ColorFt)> = colors.map(|(at, color)| (at, color.into())).collect();
        Ok(Self(strahl::prelude::Rainbow {
            direction: unit(n.direction, "direction")?,
            up: unit(n.up, "up")?,
            angle: n.angle,
            width: n.width,
            arc_angle: n.arc_angle,
            falloff_angle: n.falloff_angle,
            distance: n.distance,
            colors: BlendMap::new(colors),
            jitter: n.jitter,
            span: Span::NONE,
        }))
    }
}
