//! Constructors of fractals.

use crate::convert::{Triple, vector};
use crate::errors;
use crate::object::Object;
use crate::shapes::{Place, object};
use pyo3::prelude::*;
use std::sync::Arc;
use strahl::geometry::{
    HypercomplexFunction, Julia, JuliaAlgebra, JuliaOptions, QuaternionFunction,
};
use strahl::math::DVec2;
use strahl::math::noise::NoiseGenerator;
use strahl::prelude::{Mandelbulb, Menger, Terrain, TerrainDetail, TerrainKind, TerrainOptions};

/// Adds all functions to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(julia, module)?)?;
    module.add_function(wrap_pyfunction!(mandelbulb, module)?)?;
    module.add_function(wrap_pyfunction!(menger, module)?)?;
    module.add_function(wrap_pyfunction!(terrain, module)?)
}

/// A function of hypercomplex numbers; `exponent` is that of `pwr`.
fn hypercomplex(function: &str, exponent: (f64, f64)) -> Option<HypercomplexFunction> {
    use HypercomplexFunction as Of;
    Some(match function {
        "sqr" => Of::Square,
        "cube" => Of::Cube,
        "exp" => Of::Exp,
        "reciprocal" => Of::Reciprocal,
        "sin" => Of::Sin,
        "asin" => Of::Asin,
        "sinh" => Of::Sinh,
        "asinh" => Of::Asinh,
        "cos" => Of::Cos,
        "acos" => Of::Acos,
        "cosh" => Of::Cosh,
        "acosh" => Of::Acosh,
        "tan" => Of::Tan,
        "atan" => Of::Atan,
        "tanh" => Of::Tanh,
        "atanh" => Of::Atanh,
        "ln" => Of::Ln,
        "pwr" => Of::Power(exponent.0, exponent.1),
        _ => return None,
    })
}

/// A Julia set in numbers: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct JuliaNumbers {
    parameter: [f64; 4],
    algebra: String,
    function: String,
    exponent: (f64, f64),
    max_iteration: u32,
    precision: f64,
    slice: [f64; 4],
    distance: f64,
}

#[pyfunction]
fn julia(numbers: JuliaNumbers, place: Place) -> PyResult<Object> {
    let n = numbers;
    let algebra = match (n.algebra.as_str(), n.function.as_str()) {
        ("quaternion", "sqr") => Some(JuliaAlgebra::Quaternion(QuaternionFunction::Square)),
        ("quaternion", "cube") => Some(JuliaAlgebra::Quaternion(QuaternionFunction::Cube)),
        ("hypercomplex", name) => hypercomplex(name, n.exponent).map(JuliaAlgebra::Hypercomplex),
        _ => None,
    };
    let Some(algebra) = algebra else {
        return Err(errors::value(format!(
            "there is no function `{}` of {} numbers",
            n.function, n.algebra
        )));
    };
    let options = JuliaOptions {
        max_iteration: n.max_iteration,
        precision: n.precision,
        slice: n.slice,
        distance: n.distance,
    };
    let julia = Julia::try_new(n.parameter, algebra, &options).map_err(errors::value)?;
    object(Arc::new(julia), place)
}

#[pyfunction]
fn mandelbulb(
    power: u32,
    parameter: Option<Triple>,
    max_iteration: u32,
    precision: f64,
    place: Place,
) -> PyResult<Object> {
    let bulb = Mandelbulb::try_new(power, parameter.map(vector), max_iteration, precision);
    object(Arc::new(bulb.map_err(errors::value)?), place)
}

#[pyfunction]
fn menger(corner: Triple, opposite: Triple, level: u32, place: Place) -> PyResult<Object> {
    let sponge = Menger::try_new(vector(corner), vector(opposite), level);
    object(Arc::new(sponge.map_err(errors::value)?), place)
}

/// A terrain in numbers: a dictionary that the Python half makes.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
struct TerrainNumbers {
    kind: String,
    h: f64,
    lacunarity: f64,
    octaves: f64,
    offset: f64,
    gain: f64,
    noise: u32,
    extent: Option<[[f64; 2]; 2]>,
    detail: Option<(Triple, f64)>,
}

#[pyfunction]
fn terrain(numbers: TerrainNumbers, place: Place) -> PyResult<Object> {
    let n = numbers;
    let kind = match n.kind.as_str() {
        "fbm" => TerrainKind::Fbm,
        "hetero" => TerrainKind::Hetero,
        "ridged" => TerrainKind::Ridged,
        other => {
            return Err(errors::value(format!(
                "there is no terrain `{other}`; the kinds are fbm, hetero and ridged"
            )));
        }
    };
    let Some(generator) = NoiseGenerator::from_number(n.noise) else {
        return Err(errors::value("the noise generators are 1, 2 and 3"));
    };
    let terrain = Terrain::try_new(&TerrainOptions {
        kind,
        h: n.h,
        lacunarity: n.lacunarity,
        octaves: n.octaves,
        offset: n.offset,
        gain: n.gain,
        generator,
        extent: n.extent.map(|corners| corners.map(DVec2::from_array)),
        detail: n.detail.map(|(viewpoint, angle)| TerrainDetail {
            viewpoint: vector(viewpoint),
            angle,
        }),
    });
    object(Arc::new(terrain.map_err(errors::value)?), place)
}
