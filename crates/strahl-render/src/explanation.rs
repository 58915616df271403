//! The ray trees of a pixel as plain data, with names and places: the one schema of `strahl explain --format json`, of viewers and of
//! other languages.
//!
//! Points, directions and colours are lists of three numbers; colours are linear. In JSON infinities and NaN are null, and numbers read
//! back have the same bits. Fields are named as in the formulas that the documentation explains.

use crate::names::{light_kind, light_position};
use crate::observer::{
    HitReport, LayerReport, Shading, ShadowHit, ShadowReport, SurfaceTerm as Term,
};
use crate::sampling::Sampling;
use crate::scene::RenderScene;
use crate::tree::{LightReport, PixelSample, PixelTree, RayNode};
use serde::Serialize;
use strahl_math::DVec3;
use strahl_shade::{Color, ShadingModel, srgb};

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
    /// `primary`, `reflection` or `transparency`.
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
    /// The trees of pixel `at` of a picture of that size.
    pub fn new(
        scene: &RenderScene,
        at: (u32, u32),
        size: (u32, u32),
        sampling: Sampling,
        tree: &PixelTree,
    ) -> Self {
        let samples = (1..).zip(&tree.samples);
        Self {
            pixel: at.into(),
            size: size.into(),
            sampling: sampling.to_string(),
            places: tree.places,
            samples: samples.map(|(n, s)| Sample::new(scene, n, s)).collect(),
            color: color(tree.color),
            film: tree.film,
            rgb8: tree.film.map(|c| srgb::encode_u8(f64::from(c))),
        }
    }
}

impl Explanation {
    /// As JSON, indented, with the members of objects in the order of their names.
    pub fn to_json(&self) -> String {
        let value = serde_json::to_value(self).expect("all members have names");
        format!("{value:#}")
    }
}

impl Sample {
    fn new(scene: &RenderScene, number: usize, sample: &PixelSample) -> Self {
        let nodes = sample.tree.nodes.iter();
        Self {
            sample: number,
            position: sample.place.into(),
            pass: sample.pass,
            lens_ray: sample.ray,
            color: color(sample.color),
            rays: nodes.map(|node| TreeRay::new(scene, node)).collect(),
        }
    }
}

impl TreeRay {
    fn new(scene: &RenderScene, node: &RayNode) -> Self {
        let report = &node.report;
        let hit = report.hit.as_ref();
        let ended = node.ended.iter().map(|(kind, weight, end)| Ended {
            kind: kind.to_string(),
            weight: *weight,
            reason: end.to_string(),
        });
        let lights = node.lights.iter();
        Self {
            id: report.node,
            parent: (report.node != report.parent).then_some(report.parent),
            kind: report.kind.to_string(),
            depth: report.depth,
            weight: report.weight,
            spectrum: (!report.part.is_white()).then(|| report.part.place()),
            share: color(report.share.factor),
            power: report.share.power,
            ray: Line {
                origin: point(report.ray.origin),
                direction: point(report.ray.direction),
            },
            hit: hit.map(|hit| Hit::new(scene, hit)),
            background: report.background.map(color),
            lights: lights.map(|light| Light::new(scene, hit, light)).collect(),
            ended: ended.collect(),
            children: node.children.clone(),
            medium: report.medium.map(|id| scene.material_name(id.0)),
            attenuation: color(report.attenuation),
            fog: color(report.fog),
            local: color(node.local),
            total: color(node.total),
        }
    }
}

impl Hit {
    fn new(scene: &RenderScene, hit: &HitReport) -> Self {
        Self {
            t: hit.hit.t,
            object: scene.object_name(hit.object),
            object_id: hit.object,
            element: hit.hit.id,
            source: scene.object_place(hit.object, hit.line),
            material: scene.material_name(hit.material.0),
            position: point(hit.position),
            normal: point(hit.n_geom),
            shading_normal: point(hit.n_shade),
            n1: hit.eta_1,
            n2: hit.eta_2,
            cos_theta1: hit.cos_1,
            cos_theta2: hit.cos_2,
            total_reflection: hit.total_reflection,
            ka: color(hit.ka),
            Ia: color(hit.ambient_light),
            ka_Ia: color(hit.ambient),
            emission: color(hit.emission),
            kr: color(hit.reflection),
            kt: color(hit.transmission),
            shading: ShadingData::new(hit),
        }
    }
}

impl ShadingData {
    fn new(hit: &HitReport) -> Self {
        match &hit.shading {
            Shading::Model(model) if model.is_diagnostic() => Self::Diagnostic {
                model: model.to_string(),
            },
            Shading::Model(model) => {
                let highlight = *model != ShadingModel::Lambert;
                Self::Model {
                    model: model.to_string(),
                    fresnel: hit.fresnel,
                    kd: color(hit.diffuse),
                    ks: highlight.then(|| color(hit.specular)),
                    p: highlight.then_some(hit.shininess),
                }
            }
            Shading::Finish { layers, model } => Self::Finish {
                model: "pov-ray finish",
                terms_of: model.map(|model| model.to_string()),
                layers: layers.iter().map(Layer::new).collect(),
            },
        }
    }
}

impl Layer {
    fn new(layer: &LayerReport) -> Self {
        let f = &layer.finish;
        let r = &f.reflection;
        Self {
            pigment: Pigment {
                rgb: color(layer.color.rgb),
                filter: layer.color.filter,
                transmit: layer.color.transmit,
            },
            normal: point(layer.normal),
            share: layer.share,
            above: color(layer.above),
            C: color(layer.body),
            finish: Finish {
                ambient: color(f.ambient),
                emission: color(f.emission),
                diffuse: f.diffuse,
                diffuse_from_behind: f.diffuse_back,
                brilliance: f.brilliance,
                phong: f.phong,
                phong_size: f.phong_size,
                specular: f.specular,
                roughness: f.roughness,
                metallic: f.metallic,
                crand: f.crand,
                irid: f.irid.map(|irid| Irid {
                    amount: irid.amount,
                    thickness: irid.thickness,
                    turbulence: irid.turbulence,
                }),
                conserve_energy: f.conserve_energy,
                reflection: Reflection {
                    min: color(r.min),
                    max: color(r.max),
                    fresnel: r.fresnel,
                    falloff: r.falloff,
                    exponent: r.exponent,
                    metallic: r.metallic,
                },
            },
            rise: layer.rise,
            fresnel: layer.rise.filter(|_| r.fresnel),
            reflection_film: layer.film.filter(|_| layer.rise.is_some()).map(color),
            reflectance: color(layer.reflectance),
        }
    }
}

impl Light {
    fn new(scene: &RenderScene, hit: Option<&HitReport>, light: &LightReport) -> Self {
        let (term, detail) = (&light.term, &light.detail);
        let described = scene.lights().get(term.light as usize).map(|l| &l.light);
        let place = |wanted: &str| {
            let (how, place) = described.map(light_position)?;
            (how == wanted).then(|| point(place))
        };
        let shading = hit.map(|hit| &hit.shading);
        let terms = detail.terms.iter();
        Self {
            light: scene.light_name(term.light),
            kind: described.map(light_kind),
            position: place("at"),
            direction: place("along"),
            source: scene.light_place(term.light),
            color: described.map(|l| color(l.color)),
            color_here: color(term.color),
            l: detail.l.map(point),
            n_dot_l: term.n_dot_l,
            shadow_rays: detail
                .shadows
                .iter()
                .map(|s| Shadow::new(scene, s))
                .collect(),
            fog: color(detail.fog),
            visible: color(term.visible),
            L: color(detail.arriving),
            makes_highlights: detail.highlights,
            mean_of_points: detail.mean_of,
            terms: terms.map(|term| SurfaceTerm::new(shading, term)).collect(),
            diffuse: color(term.diffuse),
            highlight: color(term.specular),
        }
    }
}

impl SurfaceTerm {
    fn new(shading: Option<&Shading>, term: &Term) -> Self {
        let made_of = match shading {
            Some(Shading::Finish { model, .. }) => {
                let highlights = *model != Some(ShadingModel::Lambert);
                let by_mirror = model.is_none_or(|model| model == ShadingModel::Phong);
                let by_half = model.is_none_or(|model| model == ShadingModel::BlinnPhong);
                Highlight::Finish {
                    phong_cosine: term.r_dot_v.filter(|_| highlights),
                    phong_cosine_is: if by_mirror { "r·v" } else { "h·n" },
                    phong: term.phong,
                    specular_cosine: term.h_dot_n.filter(|_| highlights),
                    specular_cosine_is: if by_half { "h·n" } else { "r·v" },
                    specular: term.specular,
                    tint: color(term.tint),
                    film: term.film.map(color),
                }
            }
            _ => match (term.r_dot_v, term.h_dot_n) {
                (Some(r_dot_v), _) => Highlight::Phong {
                    r_dot_v,
                    r_dot_v_p: term.phong,
                },
                (_, Some(h_dot_n)) => Highlight::Blinn {
                    h_dot_n,
                    h_dot_n_p: term.specular,
                },
                _ => Highlight::None {},
            },
        };
        Self {
            n_dot_l: term.n_dot_l,
            diffuse_factor: term.diffuse_factor,
            grain: term.grain,
            diffuse: color(term.diffuse),
            highlight: color(term.highlight),
            made_of,
        }
    }
}

impl Shadow {
    fn new(scene: &RenderScene, shadow: &ShadowReport) -> Self {
        let met = |met: &ShadowHit| Obstacle {
            t: met.t,
            object: scene.object_name(met.object),
            object_id: met.object,
            element: met.element,
            source: scene.object_place(met.object, met.line),
            blocks: met.blocks,
            filter: color(met.filter),
            medium_before: color(met.absorbed),
        };
        Self {
            origin: point(shadow.ray.origin),
            direction: point(shadow.ray.direction),
            met: shadow.met.iter().map(met).collect(),
            medium_behind: color(shadow.rest),
            beside_mask: shadow.beside_mask,
            visible: color(shadow.visible),
        }
    }
}

fn point(p: DVec3) -> Triple {
    p.to_array()
}

fn color(c: Color) -> Triple {
    c.to_array()
}
