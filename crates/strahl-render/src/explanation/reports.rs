//! From the reports of rays to plain data.

use super::{
    Ended, Explanation, Finish, Gathered, Highlight, Hit, Irid, Layer, Light, Line, Obstacle,
    Pigment, Reflection, Sample, ShadingData, Shadow, SurfaceTerm, TreeRay, Triple,
};
use crate::names::{light_kind, light_position};
use crate::observer::{
    HitReport, LayerReport, Shading, ShadowHit, ShadowReport, SurfaceTerm as Term,
};
use crate::sampling::Sampling;
use crate::scene::RenderScene;
use crate::tree::{LightReport, PixelSample, PixelTree, RayNode};
use strahl_math::DVec3;
use strahl_shade::{Color, ShadingModel, srgb};

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
            rgb8: tree.film.map(srgb::encode_u8),
        }
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
            times: sample.times,
            share: sample.share,
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
            gathered: node.gathered.as_ref().map(|term| Gathered {
                method: term.method.clone(),
                radiance: color(term.radiance),
                rays: term.rays,
            }),
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
