//! Names of objects, materials and lights, and their places in the scene's files.

use crate::scene::RenderScene;
use strahl_math::DVec3;
use strahl_shade::{Light, LightKind};

impl RenderScene {
    /// Kind and name of an object: `sphere "ball"`.
    pub fn object_name(&self, object: u32) -> String {
        self.objects.get(object).map_or_else(
            || format!("object {object}"),
            |info| match info.name {
                Some(name) => format!("{} \"{name}\"", info.kind),
                None => info.kind.to_owned(),
            },
        )
    }

    /// The place of an object in the scene's files, as `file:line:column`; `line` is that of a part of it, if known.
    pub fn object_place(&self, object: u32, line: Option<u32>) -> Option<String> {
        let mut span = self.objects.get(object)?.span;
        if let Some(line) = line {
            span.line = line;
            span.column = 0;
        }
        self.sources.locate(span).map(|place| place.to_string())
    }

    /// Name of a material: `material "glass"`, or its number.
    pub fn material_name(&self, material: u32) -> String {
        match self.materials.get(material as usize) {
            Some(m) if !m.name.is_empty() => format!("material \"{}\"", m.name),
            _ => format!("material {material}"),
        }
    }

    /// Number, counted from 1, and name of a light: `light 1 "key"`.
    pub fn light_name(&self, light: u32) -> String {
        let described = self.lights.get(light as usize);
        let number = format!("light {}", light + 1);
        match described.and_then(|l| l.name.as_deref()) {
            Some(name) if name != number => format!("{number} \"{name}\""),
            _ => number,
        }
    }

    /// The place of a light in the scene's files, as `file:line:column`.
    pub fn light_place(&self, light: u32) -> Option<String> {
        let span = self.lights.get(light as usize)?.span;
        self.sources.locate(span).map(|place| place.to_string())
    }
}

/// The kind of a light: `point light`, `area light`, ...
pub fn light_kind(light: &Light) -> &'static str {
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

/// The position of a light (`at`), or the direction of its light if it has no position (`along`).
pub fn light_position(light: &Light) -> (&'static str, DVec3) {
    match light.kind {
        LightKind::Directional { direction } => ("along", direction),
        LightKind::Point { position }
        | LightKind::Spot { position, .. }
        | LightKind::Parallel { position, .. }
        | LightKind::Beam { position, .. } => ("at", position),
        _ => ("at", DVec3::ZERO),
    }
}
