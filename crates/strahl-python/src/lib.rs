//! The compiled half of the Python package `strahl`: thin functions over the crate `strahl`.
//!
//! The other half, in `python/strahl/`, is what users see. It checks arguments, has the documentation and the types, and calls what is
//! here. Nothing here holds Python's lock while it computes (`work`).

mod convert;
mod errors;
mod film;
mod found;
mod hits;
mod load;
mod looks;
mod object;
mod patches;
mod queries;
mod scene;
mod sessions;
mod settings;
mod shapes;
mod shelf;
mod work;

use pyo3::prelude::*;

/// The compiled half of the package `strahl`.
#[pymodule]
fn _strahl(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<film::Film>()?;
    module.add_class::<hits::Hits>()?;
    module.add_class::<looks::Background>()?;
    module.add_class::<looks::Camera>()?;
    module.add_class::<looks::Light>()?;
    module.add_class::<looks::Material>()?;
    module.add_class::<object::Object>()?;
    module.add_class::<scene::Scene>()?;
    module.add_function(wrap_pyfunction!(explanation_page, module)?)?;
    module.add_function(wrap_pyfunction!(film::encode_png, module)?)?;
    module.add_function(wrap_pyfunction!(load::load, module)?)?;
    module.add_function(wrap_pyfunction!(load::parse, module)?)?;
    module.add_function(wrap_pyfunction!(work::panic_for_tests, module)?)?;
    module.add_function(wrap_pyfunction!(sessions::thread_count, module)?)?;
    patches::register(module)?;
    shapes::register(module)
}

/// The page of a pixel, from the JSON of its explanation.
#[pyfunction]
fn explanation_page(json: &str, pixel: [u32; 2], title: &str, language: &str) -> String {
    strahl_view::page_of_json(json, pixel, title, language)
}
