//! The ray tree of a pixel in words, as JSON and as a graph.

mod dot;
mod json;
mod text;

pub(crate) use dot::dot;
pub(crate) use json::json;
pub(crate) use text::text;

use strahl::tracing::RenderScene;

/// Name and kind of an object: `sphere "ball"`.
fn object_name(scene: &RenderScene, object: u32) -> String {
    scene.objects().get(object).map_or_else(
        || format!("object {object}"),
        |info| match info.name {
            Some(name) => format!("{} \"{name}\"", info.kind),
            None => info.kind.to_owned(),
        },
    )
}

/// The place in the scene that an object comes from.
fn object_place(scene: &RenderScene, object: u32, line: Option<u32>) -> Option<String> {
    let mut span = scene.objects().get(object)?.span;
    if let Some(line) = line {
        span.line = line;
        span.column = 0;
    }
    scene.sources().locate(span).map(|place| place.to_string())
}

/// Name of a material.
fn material_name(scene: &RenderScene, material: u32) -> String {
    match scene.materials().get(material as usize) {
        Some(m) if !m.name.is_empty() => m.name.clone(),
        _ => format!("material {material}"),
    }
}

/// Name of a light.
fn light_name(scene: &RenderScene, light: u32) -> String {
    let described = scene.lights().get(light as usize);
    match described.and_then(|l| l.name.as_deref()) {
        Some(name) => format!("light {} \"{name}\"", light + 1),
        None => format!("light {}", light + 1),
    }
}
