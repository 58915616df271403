use crate::{
    Background, Camera, Children, Fog, Group, GroupId, Rainbow, Settings, SourceMap, Span,
};
use std::sync::Arc;
use strahl_math::Transform;
use strahl_shade::{Color, Light};

/// What light has to cross to shine on anything (POV-Ray's `projected_through`): a point is lit if its shadow ray meets the
/// surface of the mask, and nothing beyond the nearest such place is in the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightMask {
    /// The mask, which cannot be seen: a group of the scene's.
    pub group: GroupId,
    /// Where it is.
    pub transform: Transform,
}

/// A light with its place in the scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneLight {
    /// The light.
    pub light: Light,
    /// What the light has to cross.
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

/// A whole scene: what there is to see, from where, in which light.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The camera; without one the renderer frames the objects.
    pub camera: Option<Camera>,
    /// The lights. A scene without camera and lights gets a key and a fill light; one with a camera but no lights is lit
    /// by ambient and emitted light only.
    pub lights: Vec<SceneLight>,
    /// Ia, the ambient light; `None` is unit white in scenes with lights of their own scaled by 0.1.
    pub ambient: Option<Color>,
    /// What rays see that hit nothing; `None` is black, or a soft gradient behind objects framed by the renderer.
    pub background: Option<Background>,
    /// Fogs; each fills all space outside of solid things.
    pub fogs: Vec<Fog>,
    /// Rainbows, before the background or everything.
    pub rainbows: Vec<Rainbow>,
    /// Hints for the renderer.
    pub settings: Settings,
    /// The objects.
    pub objects: Children,
    /// Groups that objects instance.
    pub groups: Vec<Group>,
    /// The files the scene was made from.
    pub sources: SourceMap,
}
