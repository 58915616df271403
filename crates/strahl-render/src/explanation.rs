//! The ray trees of a pixel as plain data, with names and places: the one schema of `strahl explain --format json`, of viewers and of
//! other languages.
//!
//! Points, directions and colours are lists of three numbers; colours are linear. In JSON infinities and NaN are null, and numbers read
//! back have the same bits. Fields are named as in the formulas that the documentation explains.

mod reports;

use serde::Serialize;

/// Three numbers.
pub type Triple = [f64; 3];

/// A pixel and all rays that were traced for it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Explanation {
    /// Column and row.
    pub pixel: [u32; 2],
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// Where rays go through the pixels.
    pub sampling: String,
    /// How many places of the picture the samples belong to.
    pub places: u32,
    /// Its samples.
    pub samples: Vec<Sample>,
    /// The linear colour before rounding.
    pub color: Triple,
    /// The colour as it is in the film.
    pub film: [f32; 3],
    /// The colour as sRGB codes of 8 bits.
    pub rgb8: [u8; 3],
}

/// One primary ray and all that came of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sample {
    /// Its number, counted from 1.
    pub sample: usize,
    /// The place in the picture, in pixels.
    pub position: [f64; 2],
    /// The pass of the sampling that asked for it.
    pub pass: u32,
    /// The number of the ray, where a place has several.
    pub lens_ray: Option<u32>,
    /// How often its place counts in the mean of the pixel.
    pub times: u32,
    /// The share of its place in the mean of the pixel.
    pub share: f64,
    /// The linear colour it brings.
    pub color: Triple,
    /// The rays in the order of tracing; the first is the primary ray.
    pub rays: Vec<TreeRay>,
}

/// A ray of a tree.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TreeRay {
    /// Its number in the tree.
    pub id: u32,
    /// The ray that sent it; none for the primary ray.
    pub parent: Option<u32>,
    /// `primary`, `reflection`, `transparency` or `gather`.
    pub kind: String,
    /// Level in the tree, 1 for the primary ray.
    pub depth: u32,
    /// The largest channel of the product of all coefficients on the way to it.
    pub weight: f64,
    /// Its place in the spectrum, if it stands for a part of it.
    pub spectrum: Option<f64>,
    /// The factor with which it contributes to the hit that sent it.
    pub share: Triple,
    /// The exponent that is applied to the radiance before.
    pub power: f64,
    /// The ray.
    pub ray: Line,
    /// The surface it hit.
    pub hit: Option<Hit>,
    /// The colour of the background, if it hit nothing.
    pub background: Option<Triple>,
    /// The lights looked at from the hit.
    pub lights: Vec<Light>,
    /// Light that a method of light transport found at the hit.
    pub gathered: Option<Gathered>,
    /// Rays that were not traced.
    pub ended: Vec<Ended>,
    /// Numbers of the rays it sent.
    pub children: Vec<u32>,
    /// The material of the solid it ran through; none is air.
    pub medium: Option<String>,
    /// The attenuation by the medium it ran through.
    pub attenuation: Triple,
    /// The light that fog and rainbows in front of the hit add.
    pub fog: Triple,
    /// The hit's own contribution.
    pub local: Triple,
    /// The radiance along the ray.
    pub total: Triple,
}

/// Origin and direction of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Line {
    /// Where it starts.
    pub origin: Triple,
    /// How far it moves per unit of `t`.
    pub direction: Triple,
}

/// Light that is neither the hit's own, nor reflected, nor transmitted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Gathered {
    /// The name of the method that found it.
    pub method: String,
    /// The radiance, without that of its rays.
    pub radiance: Triple,
    /// How many rays it asked for.
    pub rays: u32,
}

/// A branch that was not traced.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ended {
    /// `reflection` or `transparency`.
    pub kind: String,
    /// Its weight.
    pub weight: f64,
    /// Why.
    pub reason: String,
}

/// The surface that a ray hit.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[allow(non_snake_case, reason = "named as in the formulas")]
pub struct Hit {
    /// Ray parameter.
    pub t: f64,
    /// Kind and name of the object.
    pub object: String,
    /// Its number.
    pub object_id: u32,
    /// Number of the element.
    pub element: u64,
    /// The place in the scene's files: `file:line:column`.
    pub source: Option<String>,
    /// The material.
    pub material: String,
    /// World position.
    pub position: Triple,
    /// Unit normal of the surface, on the side of the ray.
    pub normal: Triple,
    /// Unit normal for shading, on the side of the ray.
    pub shading_normal: Triple,
    /// Index of refraction on the side of the ray.
    pub n1: f64,
    /// Index of refraction behind the surface.
    pub n2: f64,
    /// Cosine of the angle of incidence.
    pub cos_theta1: f64,
    /// Cosine of the angle of refraction.
    pub cos_theta2: Option<f64>,
    /// Whether Snell's law has no solution.
    pub total_reflection: bool,
    /// The ambient coefficient.
    pub ka: Triple,
    /// The ambient light.
    pub Ia: Triple,
    /// Their product.
    pub ka_Ia: Triple,
    /// Light that the surface emits.
    pub emission: Triple,
    /// The coefficient of reflection.
    pub kr: Triple,
    /// The coefficient of transparency.
    pub kt: Triple,
    /// The shading model or the finishes.
    #[serde(flatten)]
    pub shading: ShadingData,
}

/// How a surface is shaded.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum ShadingData {
    /// A picture of one quantity, such as normals.
    Diagnostic {
        /// Its name.
        model: String,
    },
    /// A shading model.
    Model {
        /// Its name.
        model: String,
        /// Fresnel's reflectance, if the material asks for it.
        fresnel: Option<f64>,
        /// The diffuse coefficient.
        kd: Triple,
        /// The coefficient of highlights; none without.
        ks: Option<Triple>,
        /// The exponent of highlights; none without.
        p: Option<f64>,
    },
    /// POV-Ray's finishes.
    Finish {
        /// `pov-ray finish`.
        model: &'static str,
        /// The shading model whose terms are shown, if one was asked for.
        terms_of: Option<String>,
        /// The layers of the texture.
        layers: Vec<Layer>,
    },
}

/// A layer of a POV-Ray texture.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[allow(non_snake_case, reason = "named as in the formulas")]
pub struct Layer {
    /// The colour.
    pub pigment: Pigment,
    /// The tilted unit normal, on the side of the ray.
    pub normal: Triple,
    /// The share where textures are blended.
    pub share: f64,
    /// What the layers above let pass.
    pub above: Triple,
    /// What ambient, emission and diffuse are multiplied by.
    pub C: Triple,
    /// The finish.
    pub finish: Finish,
    /// How far the reflection has come from `min` to `max`.
    pub rise: Option<f64>,
    /// The same, if it is Fresnel's.
    pub fresnel: Option<f64>,
    /// The factor of a thin film for light from the mirror direction.
    pub reflection_film: Option<Triple>,
    /// The share of the light from the mirror direction that is reflected.
    pub reflectance: Triple,
}

/// A colour with `filter` and `transmit`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pigment {
    /// The colour.
    pub rgb: Triple,
    /// What passes with this colour.
    pub filter: f64,
    /// What passes unchanged.
    pub transmit: f64,
}

/// A POV-Ray finish, with the words of its language.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the words of POV-Ray's language")]
pub struct Finish {
    pub ambient: Triple,
    pub emission: Triple,
    pub diffuse: f64,
    pub diffuse_from_behind: f64,
    pub brilliance: f64,
    pub phong: f64,
    pub phong_size: f64,
    pub specular: f64,
    pub roughness: f64,
    pub metallic: f64,
    pub crand: f64,
    pub irid: Option<Irid>,
    pub conserve_energy: bool,
    pub reflection: Reflection,
}

/// A thin film.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the words of POV-Ray's language")]
pub struct Irid {
    pub amount: f64,
    pub thickness: f64,
    pub turbulence: f64,
}

/// The reflection of a finish.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the words of POV-Ray's language")]
pub struct Reflection {
    pub min: Triple,
    pub max: Triple,
    pub fresnel: bool,
    pub falloff: f64,
    pub exponent: f64,
    pub metallic: f64,
}

/// A light, as a hit sees it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[allow(non_snake_case, reason = "named as in the formulas")]
pub struct Light {
    /// Number, counted from 1, and name.
    pub light: String,
    /// Its kind.
    pub kind: Option<&'static str>,
    /// Its position, if it has one.
    pub position: Option<Triple>,
    /// The direction of its light, if it has no position.
    pub direction: Option<Triple>,
    /// The place in the scene's files.
    pub source: Option<String>,
    /// Its colour.
    pub color: Option<Triple>,
    /// Its colour at the point: spot lights and fading change it.
    pub color_here: Triple,
    /// Unit vector towards it; none where it does not shine.
    pub l: Option<Triple>,
    /// n·l.
    pub n_dot_l: f64,
    /// The shadow rays.
    pub shadow_rays: Vec<Shadow>,
    /// What fog leaves of its light.
    pub fog: Triple,
    /// What shadow rays leave of its light.
    pub visible: Triple,
    /// What arrives.
    pub L: Triple,
    /// Whether it makes highlights.
    pub makes_highlights: bool,
    /// Of how many points of the light the terms are the mean.
    pub mean_of_points: Option<u32>,
    /// What each layer makes of it.
    pub terms: Vec<SurfaceTerm>,
    /// The diffuse part of what is seen.
    pub diffuse: Triple,
    /// The highlights.
    pub highlight: Triple,
}

/// What a surface, or a layer, makes of one light.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurfaceTerm {
    /// n·l, at the layer's normal.
    pub n_dot_l: f64,
    /// What the diffuse term takes of the light, without the colour.
    pub diffuse_factor: f64,
    /// What `crand` takes from it.
    pub grain: f64,
    /// The diffuse part of what is seen.
    pub diffuse: Triple,
    /// The highlights.
    pub highlight: Triple,
    /// What the highlights are made of.
    #[serde(flatten)]
    pub made_of: Highlight,
}

/// What highlights are made of, under the names of the shading model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Highlight {
    /// Those of POV-Ray's finishes.
    Finish {
        /// The cosine of `phong`.
        phong_cosine: Option<f64>,
        /// Between what: `r·v` or `h·n`.
        phong_cosine_is: &'static str,
        /// The highlight per unit of light.
        phong: f64,
        /// The cosine of `specular`.
        specular_cosine: Option<f64>,
        /// Between what: `h·n` or `r·v`.
        specular_cosine_is: &'static str,
        /// The highlight per unit of light.
        specular: f64,
        /// The colour that `metallic` gives.
        tint: Triple,
        /// The factor of a thin film.
        film: Option<Triple>,
    },
    /// Around the mirror direction.
    Phong {
        /// r·v.
        r_dot_v: f64,
        /// `(r·v)^p`.
        r_dot_v_p: f64,
    },
    /// By half vectors.
    Blinn {
        /// h·n.
        h_dot_n: f64,
        /// `(h·n)^p`.
        h_dot_n_p: f64,
    },
    /// There are none.
    None {},
}

/// A shadow ray.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Shadow {
    /// Where it starts.
    pub origin: Triple,
    /// The light is at `t = 1`, unless it is infinitely far away.
    pub direction: Triple,
    /// What it met.
    pub met: Vec<Obstacle>,
    /// What the medium behind the last of them keeps.
    pub medium_behind: Triple,
    /// Whether the light has to cross an object on its way and does not.
    pub beside_mask: bool,
    /// What arrives.
    pub visible: Triple,
}

/// Something in the way of a shadow ray.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Obstacle {
    /// Ray parameter.
    pub t: f64,
    /// Kind and name of the object.
    pub object: String,
    /// Its number.
    pub object_id: u32,
    /// Number of the element.
    pub element: u64,
    /// The place in the scene's files.
    pub source: Option<String>,
    /// Whether it lets nothing through.
    pub blocks: bool,
    /// What its surface lets through.
    pub filter: Triple,
    /// What the medium in front of it keeps.
    pub medium_before: Triple,
}

impl Explanation {
    /// As JSON, indented, with the members of objects in the order of their names.
    pub fn to_json(&self) -> String {
        let value = serde_json::to_value(self).expect("all members have names");
        format!("{value:#}")
    }
}
