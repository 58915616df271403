//! Objects and lights in words.

use super::Digits;
use strahl::tracing::{RenderScene, light_kind, light_position};

/// An object with its place and element: `sphere "ball" (scene.pov:3:1, element 7)`.
pub(crate) fn object_at(
    scene: &RenderScene,
    object: u32,
    line: Option<u32>,
    element: u64,
) -> String {
    let place = scene
        .object_place(object, line)
        .map_or_else(String::new, |p| format!("{p}, "));
    format!("{} ({place}element {element})", scene.object_name(object))
}

/// A light in words: `light 1 "key", point light at (1, 2, 3) (scene.pov:3:1)`.
pub(crate) fn light_at(scene: &RenderScene, light: u32, digits: Digits) -> String {
    let name = scene.light_name(light);
    let Some(described) = scene.lights().get(light as usize) else {
        return name;
    };
    let kind = light_kind(&described.light);
    let (how, place) = light_position(&described.light);
    let source = scene
        .light_place(light)
        .map_or_else(String::new, |p| format!(" ({p})"));
    format!("{name}, {kind} {how} {}{source}", digits.point(place))
}

/// The name of a file without its folders, in a place `folder/file:line`.
pub(crate) fn without_folders(place: &str) -> &str {
    place.rsplit(['/', '\\']).next().unwrap_or(place)
}
