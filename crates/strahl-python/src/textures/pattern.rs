//! Patterns: numbers at points of space, which pigments, normals and textures are made of.

use crate::convert::{Triple, vector};
use crate::errors;
use crate::maps::Map;
use crate::object::Object;
use crate::textures::image::Picture;
use numpy::{PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::prelude::*;
use std::sync::Arc;
use strahl::math::noise::{NoiseGenerator, Turbulence};
use strahl::math::{DVec2, Transform};
use strahl::prelude::PatternField;
use strahl::shade::patterns::{
    Altitude, BlackHole, Crackle, CrackleMetric, DensityCodes, DensityGrid, DensityInterpolation,
    Exterior, Fractal, FractalInterior, FractalKind, Mapping, Modifiers, Pattern as Of,
    SlopeReference, TilingNumber, Warp, Wave,
};

/// A pattern with its modifiers. It never changes.
#[pyclass(frozen, module = "strahl._strahl")]
pub(crate) struct Pattern(pub(crate) PatternField);

/// The slopes of a surface as a pattern: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct Slope {
    direction: Triple,
    towards_point: bool,
    range: [f64; 2],
    altitude: Option<(Triple, [f64; 2])>,
}

/// A fractal of the complex plane: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct FractalNumbers {
    kind: String,
    exponent: u32,
    julia: Option<(f64, f64)>,
    iterations: u32,
    exterior: (u32, f64),
    interior: (u32, f64),
}

/// The densities of a grid along z, y and x, as NumPy has them.
#[derive(FromPyObject)]
enum Densities<'py> {
    Byte(PyReadonlyArray3<'py, u8>),
    Short(PyReadonlyArray3<'py, u16>),
    Long(PyReadonlyArray3<'py, u32>),
}

impl Densities<'_> {
    fn grid(&self) -> PyResult<DensityGrid> {
        let (shape, codes) = match self {
            Self::Byte(array) => (
                array.shape(),
                DensityCodes::U8(array.as_slice().map_err(errors::value)?.to_vec()),
            ),
            Self::Short(array) => (
                array.shape(),
                DensityCodes::U16(array.as_slice().map_err(errors::value)?.to_vec()),
            ),
            Self::Long(array) => (
                array.shape(),
                DensityCodes::U32(array.as_slice().map_err(errors::value)?.to_vec()),
            ),
        };
        let most = || errors::value("a grid has at most 65535 values in each direction");
        let side = |length: usize| u16::try_from(length).map_err(|_| most());
        let &[z, y, x] = shape else {
            return Err(errors::value("densities lie along z, y and x"));
        };
        DensityGrid::try_new([side(x)?, side(y)?, side(z)?], codes).ok_or_else(most)
    }
}

/// Octaves of noise: their number, and how frequency and strength change from one to the next.
#[derive(FromPyObject)]
pub(crate) struct Octaves(u32, f64, f64);

impl From<Octaves> for Turbulence {
    fn from(Octaves(octaves, lambda, omega): Octaves) -> Self {
        Self {
            octaves,
            omega,
            lambda,
        }
    }
}

/// Adds a transformation after others; those in a row are combined, as in POV-Ray's language.
pub(super) fn transform(modifiers: &mut Modifiers, by: &Transform) {
    match modifiers.warps.last_mut() {
        Some(Warp::Transform(last)) => *last = last.then(by),
        _ => modifiers.warps.push(Warp::Transform(*by)),
    }
}

impl Pattern {
    pub(super) fn of(pattern: Of) -> Self {
        let mut field = PatternField::from(pattern);
        // Numbers of blocks and grey values are taken as they are, as in POV-Ray's language.
        if field.pattern.block_count().is_some() || matches!(field.pattern, Of::Image(_)) {
            field.modifiers.frequency = 0.0;
        }
        Self(field)
    }

    fn with(&self, change: impl FnOnce(&mut Modifiers)) -> Self {
        let mut field = self.0.clone();
        change(&mut field.modifiers);
        Self(field)
    }

    fn warped(&self, warp: Warp) -> Self {
        self.with(|modifiers| modifiers.warps.push(warp))
    }
}

#[pymethods]
impl Pattern {
    /// A pattern without parameters.
    #[staticmethod]
    fn named(name: &str) -> PyResult<Self> {
        Ok(Self::of(match name {
            "aoi" => Of::Aoi,
            "boxed" => Of::Boxed,
            "bozo" | "bumps" => Of::Bozo,
            "cells" => Of::Cells,
            "checker" => Of::Checker,
            "cubic" => Of::Cubic,
            "cylindrical" => Of::Cylindrical,
            "dents" => Of::Dents,
            "granite" => Of::Granite,
            "hexagon" => Of::Hexagon,
            "leopard" => Of::Leopard,
            "marble" => Of::Marble,
            "onion" => Of::Onion,
            "planar" => Of::Planar,
            "radial" => Of::Radial,
            "spherical" => Of::Spherical,
            "square" => Of::Square,
            "triangular" => Of::Triangular,
            "wood" => Of::Wood,
            "wrinkles" => Of::Wrinkles,
            other => return Err(errors::value(format!("there is no pattern `{other}`"))),
        }))
    }

    #[staticmethod]
    fn agate(turbulence: f64) -> Self {
        Self::of(Of::Agate { turbulence })
    }

    #[staticmethod]
    fn brick(size: Triple, mortar: f64) -> Self {
        let size = vector(size);
        Self::of(Of::Brick { size, mortar })
    }

    #[staticmethod]
    fn crackle(form: Triple, metric: f64, offset: f64, solid: bool) -> Self {
        Self::of(Of::Crackle(Crackle {
            form: vector(form),
            metric: CrackleMetric::from_number(metric),
            offset,
            solid,
        }))
    }

    #[staticmethod]
    fn fractal(numbers: FractalNumbers) -> PyResult<Self> {
        let n = numbers;
        let kind = match n.kind.as_str() {
            "power" => FractalKind::Power {
                exponent: n.exponent,
            },
            "magnet1" => FractalKind::Magnet1,
            "magnet2" => FractalKind::Magnet2,
            other => return Err(errors::value(format!("there is no fractal `{other}`"))),
        };
        let exterior = Exterior::from_number(n.exterior.0, n.exterior.1);
        let interior = FractalInterior::from_number(n.interior.0, n.interior.1);
        let unknown = || errors::value("exterior and interior have the kinds 0 to 6");
        Ok(Self::of(Of::Fractal(Fractal {
            kind,
            julia: n.julia.map(|(re, im)| DVec2::new(re, im)),
            iterations: n.iterations,
            exterior: exterior.ok_or_else(unknown)?,
            interior: interior.ok_or_else(unknown)?,
        })))
    }

    #[staticmethod]
    fn density(values: Densities<'_>, interpolation: &str) -> PyResult<Self> {
        let interpolation = match interpolation {
            "nearest" => DensityInterpolation::Nearest,
            "trilinear" => DensityInterpolation::Trilinear,
            "tricubic" => DensityInterpolation::Tricubic,
            other => {
                return Err(errors::value(format!(
                    "there is no interpolation `{other}`"
                )));
            }
        };
        let grid = values.grid()?;
        Ok(Self::of(Of::Density(Arc::new(grid), interpolation)))
    }

    #[staticmethod]
    fn gradient(direction: Triple) -> Self {
        Self::of(Of::Gradient(vector(direction)))
    }

    #[staticmethod]
    fn image(picture: &Picture) -> Self {
        Self::of(Of::Image(Arc::clone(&picture.0)))
    }

    #[staticmethod]
    fn object(object: &Object) -> Self {
        Self::of(Of::Object(strahl::sdl::inside(&object.0.object)))
    }

    #[staticmethod]
    fn quilted(control0: f64, control1: f64) -> Self {
        Self::of(Of::Quilted { control0, control1 })
    }

    #[staticmethod]
    fn ripples(sources: u32) -> Self {
        Self::of(Of::Ripples { sources })
    }

    #[staticmethod]
    fn waves(sources: u32) -> Self {
        Self::of(Of::Waves { sources })
    }

    #[staticmethod]
    fn slope(numbers: Slope) -> Self {
        let direction = vector(numbers.direction);
        Self::of(Of::Slope {
            reference: match numbers.towards_point {
                true => SlopeReference::Point(direction),
                false => SlopeReference::Direction(direction),
            },
            range: numbers.range,
            altitude: numbers.altitude.map(|(direction, range)| Altitude {
                direction: vector(direction),
                range,
            }),
        })
    }

    #[staticmethod]
    fn spiral(arms: f64, double: bool) -> Self {
        Self::of(match double {
            true => Of::Spiral2(arms),
            false => Of::Spiral1(arms),
        })
    }

    #[staticmethod]
    fn tiling(number: u32) -> PyResult<Self> {
        match TilingNumber::try_new(number) {
            Some(number) => Ok(Self::of(Of::Tiling(number))),
            None => Err(errors::value(format!("there is no tiling {number}"))),
        }
    }

    /// The number of blocks; `None` for continuous values.
    #[getter]
    fn blocks(&self) -> Option<usize> {
        self.0.pattern.block_count()
    }

    fn transformed(&self, map: &Map) -> Self {
        self.with(|modifiers| transform(modifiers, &map.0))
    }

    fn turbulence(&self, amount: Triple, octaves: Octaves) -> Self {
        self.with(|modifiers| {
            modifiers.turbulence = vector(amount);
            modifiers.octaves = octaves.into();
        })
    }

    fn frequency(&self, frequency: f64, phase: f64) -> Self {
        self.with(|modifiers| (modifiers.frequency, modifiers.phase) = (frequency, phase))
    }

    fn wave(&self, name: &str, exponent: f64) -> PyResult<Self> {
        let wave = match name {
            "ramp" => Wave::Ramp,
            "triangle" => Wave::Triangle,
            "sine" => Wave::Sine,
            "scallop" => Wave::Scallop,
            "cubic" => Wave::Cubic,
            "poly" => Wave::Poly(exponent),
            other => return Err(errors::value(format!("there is no wave `{other}`"))),
        };
        Ok(self.with(|modifiers| modifiers.wave = Some(wave)))
    }

    fn noise(&self, generator: u32) -> PyResult<Self> {
        let Some(noise) = NoiseGenerator::from_number(generator) else {
            return Err(errors::value("the noise generators are 1, 2 and 3"));
        };
        Ok(self.with(|modifiers| modifiers.noise = noise))
    }

    fn repeated(&self, axis: usize, width: f64, offset: Triple, flip: [bool; 3]) -> Self {
        self.warped(Warp::Repeat {
            axis,
            width,
            offset: vector(offset),
            flip,
        })
    }

    /// `blocks` are the edges of blocks with a hole each, and how far their holes are moved.
    fn drawn_in(
        &self,
        center: Triple,
        radius: f64,
        strength: f64,
        falloff: f64,
        inverse: bool,
        blocks: (Triple, Triple),
    ) -> Self {
        let (repeat, turbulence) = blocks;
        self.warped(Warp::BlackHole(BlackHole {
            center: vector(center),
            radius,
            strength,
            falloff,
            inverse,
            repeat: vector(repeat),
            turbulence: vector(turbulence),
        }))
    }

    fn stirred(&self, amount: Triple, octaves: Octaves) -> Self {
        self.warped(Warp::Turbulence {
            amount: vector(amount),
            octaves: octaves.into(),
        })
    }

    /// Around the y axis, the origin, a circle of this radius, or a cube.
    fn wrapped(
        &self,
        around: &str,
        orientation: Triple,
        exponent: f64,
        radius: f64,
    ) -> PyResult<Self> {
        let mapping = match around {
            "cubic" => return Ok(self.warped(Warp::Cubic)),
            "cylindrical" => Mapping::Cylindrical,
            "spherical" => Mapping::Spherical,
            "toroidal" => Mapping::Toroidal(radius),
            other => return Err(errors::value(format!("there is no mapping `{other}`"))),
        };
        Ok(self.warped(Warp::Mapping {
            mapping,
            orientation: vector(orientation).normalize(),
            distance_exponent: exponent,
        }))
    }

    fn flattened(&self, orientation: Triple, distance: f64) -> Self {
        self.warped(Warp::Planar {
            orientation: vector(orientation).normalize(),
            distance,
        })
    }
}
