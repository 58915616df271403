//! The compiled half of the Python package `strahl`: thin functions over the crate `strahl`.
//!
//! The other half, in `python/strahl/`, is what users see. It checks arguments, has the documentation and the types, and calls what is
//! here. Nothing here holds Python's lock while it computes (`work`).

mod air;
mod asked;
mod cameras;
mod combine;
mod convert;
mod errors;
mod film;
mod found;
mod fractals;
mod hits;
mod lights;
mod load;
mod looks;
mod maps;
mod object;
mod patches;
mod queries;
mod scene;
mod sessions;
mod settings;
mod shapes;
mod shelf;
mod textures;
mod work;

use pyo3::prelude::*;

/// The compiled half of the package `strahl`.
#[pymodule]
fn _strahl(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<air::Fog>()?;
    module.add_class::<air::Rainbow>()?;
    module.add_class::<film::Film>()?;
    module.add_class::<hits::Hits>()?;
    module.add_class::<lights::Light>()?;
    module.add_class::<looks::Background>()?;
    module.add_class::<cameras::Camera>()?;
    module.add_class::<looks::Material>()?;
    module.add_class::<maps::Map>()?;
    module.add_class::<object::Object>()?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<textures::Normal>()?;
    module.add_class::<textures::Pattern>()?;
    module.add_class::<textures::Picture>()?;
    module.add_class::<textures::Pigment>()?;
    module.add_class::<textures::Texture>()?;
    module.add_function(wrap_pyfunction!(combine::combined, module)?)?;
    module.add_function(wrap_pyfunction!(explanation_page, module)?)?;
    module.add_function(wrap_pyfunction!(film::encode_png, module)?)?;
    module.add_function(wrap_pyfunction!(load::load, module)?)?;
    module.add_function(wrap_pyfunction!(load::parse, module)?)?;
    module.add_function(wrap_pyfunction!(work::panic_for_tests, module)?)?;
    module.add_function(wrap_pyfunction!(sessions::thread_count, module)?)?;
    fractals::register(module)?;
    patches::register(module)?;
    shapes::register(module)
}

/// The page of a pixel, from the JSON of its explanation.
#[pyfunction]
fn explanation_page(json: &str, pixel: [u32; 2], title: &str, language: &str) -> String {
    strahl_view::page_of_json(json, pixel, title, language)
}
