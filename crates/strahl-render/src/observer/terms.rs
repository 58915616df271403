//! The factors of what is seen at a hit: which model shaded it, and what each light's terms are made of.

use strahl_math::{DVec3, Ray};
use strahl_shade::pov_finish::PovFinish;
use strahl_shade::{Color, ColorFt, ShadingModel};

/// How a hit turns light into colour.
#[derive(Clone, Debug, PartialEq)]
pub enum Shading {
    /// By coefficients and a shading model; diagnostic models show a property of the hit instead.
    Model(ShadingModel),
    /// By the finishes of a POV-Ray texture.
    Finish {
        /// The layers: stack by stack, from the top to the bottom.
        layers: Vec<LayerReport>,
        /// The shading model that takes the place of the finishes' own highlights and of `brilliance`, if one was asked for.
        model: Option<ShadingModel>,
    },
}

/// One layer of a POV-Ray texture at a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerReport {
    /// The pigment's colour, with `filter` and `transmit`.
    pub color: ColorFt,
    /// The tilted unit normal, on the side of the ray.
    pub normal: DVec3,
    /// The finish.
    pub finish: PovFinish,
    /// The share of the layer's stack where textures are blended.
    pub share: f64,
    /// What the layers above let pass.
    pub above: Color,
    /// What ambient, emission and diffuse are multiplied by: `rgb · above · (share · (1 - filter - transmit))`.
    pub body: Color,
    /// How far the reflection has come from `min` to `max`: Fresnel's F or `(1 - cos θ)^falloff`; `None` without reflection.
    pub rise: Option<f64>,
    /// The factor of a thin film (`irid`) for light from the mirror direction.
    pub film: Option<Color>,
    /// The share of the light from the mirror direction that is reflected.
    pub reflectance: Color,
}

/// What a light's terms at a hit are made of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LightDetail {
    /// Unit vector towards the light; `None` where it does not shine.
    pub l: Option<DVec3>,
    /// The shadow rays: one, or one for each point of a light with an extent that was needed.
    pub shadows: Vec<ShadowReport>,
    /// What fog leaves of the light on its way.
    pub fog: Color,
    /// What arrives: the light's colour at the point times what is visible of it.
    pub arriving: Color,
    /// Of how many points of the light the terms are the mean, where each of them shades by itself; `terms` is empty then.
    pub mean_of: Option<u32>,
    /// Whether the light makes highlights.
    pub highlights: bool,
    /// The terms: one, or one for each layer of a texture.
    pub terms: Vec<SurfaceTerm>,
}

/// What a surface, or a layer of its texture, makes of one light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceTerm {
    /// n·l, at the layer's normal.
    pub n_dot_l: f64,
    /// What the diffuse term takes of the light, without the colour: `n·l`, for finishes `diffuse (n·l)^brilliance`.
    pub diffuse_factor: f64,
    /// What `crand` takes from that factor. It counts with the layer's whole colour, also where the layer is transparent.
    pub grain: f64,
    /// r·v, where there is a highlight around the mirror direction.
    pub r_dot_v: Option<f64>,
    /// h·n, where there is a highlight by half vectors.
    pub h_dot_n: Option<f64>,
    /// The highlight around the mirror direction per unit of light: `(r·v)^p`, for finishes `phong (r·v)^phong_size`.
    pub phong: f64,
    /// The highlight by half vectors per unit of light: `(h·n)^p`, for finishes `specular (h·n)^(1/roughness)`.
    pub specular: f64,
    /// The colour `metallic` gives the highlights of a finish.
    pub tint: Color,
    /// The factor of a thin film (`irid`), which both parts contain.
    pub film: Option<Color>,
    /// The diffuse part of what is seen.
    pub diffuse: Color,
    /// The highlights.
    pub highlight: Color,
}

/// A shadow ray and what it met.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowReport {
    /// The ray; the light is at `t = 1` unless it is infinitely far away.
    pub ray: Ray,
    /// What it met, from the lit point on: one thing that blocks it, or all that weakens the light.
    pub met: Vec<ShadowHit>,
    /// What the medium behind the last of them keeps.
    pub rest: Color,
    /// What arrives: the product of all that is kept.
    pub visible: Color,
    /// Whether the light has to cross an object on its way and does not.
    pub beside_mask: bool,
}

/// Something in the way of a shadow ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowHit {
    /// Ray parameter.
    pub t: f64,
    /// Number of the element.
    pub element: u64,
    /// Number of the object.
    pub object: u32,
    /// The line of the scene file that made this face, where faces of a mesh know it.
    pub line: Option<u32>,
    /// Whether it lets nothing through, ever.
    pub blocks: bool,
    /// What its surface lets through.
    pub filter: Color,
    /// What the medium in front of it keeps.
    pub absorbed: Color,
}
