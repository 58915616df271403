use crate::{
    Background, BackgroundAlpha, Camera, Children, Fog, Group, GroupId, Rainbow, Settings,
    SourceMap, Span,
};
use std::sync::Arc;
use strahl_math::Transform;
use strahl_shade::{Color, Light};

/// A group that the light has to pass through (POV-Ray's `projected_through`): a point is lit if its shadow ray hits the
/// surface of the mask. Objects beyond the nearest such hit cast no shadow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightMask {
    /// The invisible mask, a group of the scene.
    pub group: GroupId,
    /// Its position.
    pub transform: Transform,
}

/// A light with its place in the scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneLight {
    /// The light.
    pub light: Light,
    /// The group that the light has to pass through.
    pub mask: Option<Box<LightMask>>,
    /// Name for ray trees.
    pub name: Option<Arc<str>>,
    /// The place in the scene that made it.
    pub span: Span,
}

impl SceneLight {
    /// The light after a transformation, with its mask.
    #[must_use]
    pub fn transformed(&self, map: &Transform) -> Self {
        let mask = self.mask.as_deref().map(|mask| {
            Box::new(LightMask {
                transform: mask.transform.then(map),
                ..*mask
            })
        });
        Self {
            light: self.light.transformed(map),
            mask,
            ..self.clone()
        }
    }
}

/// A whole scene: objects, camera, lights and settings.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The camera; without one the renderer frames the objects.
    pub camera: Option<Camera>,
    /// The lights. A scene without camera and lights gets a key and a fill light; one with a camera but no lights is lit
    /// by ambient and emitted light only.
    pub lights: Vec<SceneLight>,
    /// Ia, the ambient light; `None` is unit white in scenes with lights of their own scaled by 0.1.
    pub ambient: Option<Color>,
    /// The radiance along rays that hit nothing; `None` is black, or a soft gradient behind objects framed by the renderer.
    pub background: Option<Background>,
    /// What an alpha channel makes of the background; all of it is left out if there is no `background`.
    pub background_alpha: BackgroundAlpha,
    /// Fogs; each fills all space outside of solid objects.
    pub fogs: Vec<Fog>,
    /// Rainbows, in front of the background or of all distant objects.
    pub rainbows: Vec<Rainbow>,
    /// Defaults for the renderer.
    pub settings: Settings,
    /// The objects.
    pub objects: Children,
    /// Groups that objects instance.
    pub groups: Vec<Group>,
    /// The files the scene was made from.
    pub sources: SourceMap,
}
