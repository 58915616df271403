//! Names of objects, materials and lights.

use super::Digits;
use strahl::shade::{Light, LightKind};
use strahl::tracing::RenderScene;

/// Name and kind of an object: `sphere "ball"`.
pub(crate) fn object_name(scene: &RenderScene, object: u32) -> String {
    scene.objects().get(object).map_or_else(
        || format!("object {object}"),
        |info| match info.name {
            Some(name) => format!("{} \"{name}\"", info.kind),
            None => info.kind.to_owned(),
        },
    )
}

/// The place of an object in the scene file, as `file:line:column`.
pub(crate) fn object_place(scene: &RenderScene, object: u32, line: Option<u32>) -> Option<String> {
    let mut span = scene.objects().get(object)?.span;
    if let Some(line) = line {
        span.line = line;
        span.column = 0;
    }
    scene.sources().locate(span).map(|place| place.to_string())
}

/// An object with its place and element: `sphere "ball" (scene.pov:3:1, element 7)`.
pub(crate) fn object_at(
    scene: &RenderScene,
    object: u32,
    line: Option<u32>,
    element: u64,
) -> String {
    let place = object_place(scene, object, line).map_or_else(String::new, |p| format!("{p}, "));
    format!("{} ({place}element {element})", object_name(scene, object))
}

/// Name of a material.
pub(crate) fn material_name(scene: &RenderScene, material: u32) -> String {
    match scene.materials().get(material as usize) {
        Some(m) if !m.name.is_empty() => format!("material \"{}\"", m.name),
        _ => format!("material {material}"),
    }
}

/// Name of a light.
pub(crate) fn light_name(scene: &RenderScene, light: u32) -> String {
    let described = scene.lights().get(light as usize);
    let number = format!("light {}", light + 1);
    match described.and_then(|l| l.name.as_deref()) {
        Some(name) if name != number => format!("{number} \"{name}\""),
        _ => number,
    }
}

/// The place of a light in the scene file.
pub(crate) fn light_place(scene: &RenderScene, light: u32) -> Option<String> {
    let span = scene.lights().get(light as usize)?.span;
    scene.sources().locate(span).map(|place| place.to_string())
}

/// The kind of a light.
pub(crate) fn light_kind(light: &Light) -> &'static str {
    match light.kind {
        LightKind::Point { .. } if light.area.is_some() => "area light",
        LightKind::Point { .. } => "point light",
        LightKind::Spot { .. } => "spot light",
        LightKind::Directional { .. } | LightKind::Parallel { .. } => "parallel light",
        LightKind::Beam { inner, .. } if inner.is_infinite() => "parallel light",
        LightKind::Beam { .. } => "cylindrical light",
        _ => "light",
    }
}

/// The position of a light, or the direction of its light if it has no position.
pub(crate) fn light_position(light: &Light) -> (&'static str, strahl::math::DVec3) {
    match light.kind {
        LightKind::Directional { direction } => ("along", direction),
        LightKind::Point { position }
        | LightKind::Spot { position, .. }
        | LightKind::Parallel { position, .. }
        | LightKind::Beam { position, .. } => ("at", position),
        _ => ("at", strahl::math::DVec3::ZERO),
    }
}

/// A light in words: `light 1 "key", point light at (1, 2, 3) (scene.pov:3:1)`.
pub(crate) fn light_at(scene: &RenderScene, light: u32, digits: Digits) -> String {
    let name = light_name(scene, light);
    let Some(described) = scene.lights().get(light as usize) else {
        return name;
    };
    let kind = light_kind(&described.light);
    let (how, place) = light_position(&described.light);
    let source = light_place(scene, light).map_or_else(String::new, |p| format!(" ({p})"));
    format!("{name}, {kind} {how} {}{source}", digits.point(place))
}

/// The name of a file without its folders, in a place `folder/file:line`.
pub(crate) fn without_folders(place: &str) -> &str {
    place.rsplit(['/', '\\']).next().unwrap_or(place)
}
