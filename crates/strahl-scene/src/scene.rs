use crate::{Background, Camera, Children, Fog, Group, Settings, SourceMap, Span};
use std::sync::Arc;
use strahl_shade::{Color, Light};

/// A light with its place in the scene file.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneLight {
    /// The light.
    pub light: Light,
    /// Name for ray trees.
    pub name: Option<Arc<str>>,
    /// The place in the scene that made it.
    pub span: Span,
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
    /// Hints for the renderer.
    pub settings: Settings,
    /// The objects.
    pub objects: Children,
    /// Groups that objects instance.
    pub groups: Vec<Group>,
    /// The files the scene was made from.
    pub sources: SourceMap,
}
