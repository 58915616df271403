use super::names::{
    light_kind, light_name, light_place, light_position, material_name, object_name, object_place,
};
use super::{Chosen, Pixel, Shown};
use serde_json::{Map, Value, json};
use strahl::math::{DVec3, Ray};
use strahl::shade::{Color, ShadingModel};
use strahl::tracing::{
    HitReport, LayerReport, LightReport, RayNode, RenderScene, Shading, ShadowHit, ShadowReport,
    SurfaceTerm,
};

/// The trees of a pixel as JSON. Reading back a number gives the same bits; infinities and NaN, which JSON does not have, are
/// null.
pub(crate) fn json(scene: &RenderScene, pixel: &Pixel<'_>, shown: &Shown) -> String {
    let tree = pixel.tree;
    let chosen = |number: usize| match shown.sample {
        Some(Chosen::One(one)) => one == number + 1,
        _ => true,
    };
    let samples: Vec<Value> = tree
        .samples
        .iter()
        .enumerate()
        .filter(|(number, _)| chosen(*number))
        .map(|(number, sample)| {
            let nodes = sample.tree.nodes.iter();
            let rays: Vec<Value> = nodes.map(|node| ray_node(scene, node)).collect();
            json!({
                "sample": number + 1,
                "position": [sample.place.0, sample.place.1],
                "pass": sample.pass,
                "lens_ray": sample.ray,
                "color": color(sample.color),
                "rays": rays,
            })
        })
        .collect();
    let value = json!({
        "pixel": [pixel.at.0, pixel.at.1],
        "size": [pixel.size.0, pixel.size.1],
        "sampling": pixel.sampling.to_string(),
        "places": tree.places,
        "samples": samples,
        "color": color(tree.color),
        "film": tree.film,
        "rgb8": pixel.codes(),
    });
    format!("{value:#}")
}

fn ray_node(scene: &RenderScene, node: &RayNode) -> Value {
    let report = &node.report;
    let parent = (report.node != report.parent).then_some(report.parent);
    let ended: Vec<Value> = node
        .ended
        .iter()
        .map(|(kind, weight, end)| json!({ "kind": kind.to_string(), "weight": weight, "reason": end.to_string() }))
        .collect();
    json!({
        "id": report.node,
        "parent": parent,
        "kind": report.kind.to_string(),
        "depth": report.depth,
        "weight": report.weight,
        "spectrum": (!report.part.is_white()).then(|| report.part.place()),
        "share": color(report.share.factor),
        "power": report.share.power,
        "ray": ray(&report.ray),
        "hit": report.hit.as_ref().map(|hit| hit_value(scene, hit)),
        "background": report.background.map(color),
        "lights": node.lights.iter().map(|light| light_value(scene, report.hit.as_ref(), light)).collect::<Vec<_>>(),
        "ended": ended,
        "children": node.children,
        "medium": report.medium.map(|id| material_name(scene, id.0)),
        "attenuation": color(report.attenuation),
        "fog": color(report.fog),
        "local": color(node.local),
        "total": color(node.total),
    })
}

fn hit_value(scene: &RenderScene, hit: &HitReport) -> Value {
    let mut value = json!({
        "t": hit.hit.t,
        "object": object_name(scene, hit.object),
        "object_id": hit.object,
        "element": hit.hit.id,
        "source": object_place(scene, hit.object, hit.line),
        "material": material_name(scene, hit.material.0),
        "position": point(hit.position),
        "normal": point(hit.n_geom),
        "shading_normal": point(hit.n_shade),
        "n1": hit.eta_1,
        "n2": hit.eta_2,
        "cos_theta1": hit.cos_1,
        "cos_theta2": hit.cos_2,
        "total_reflection": hit.total_reflection,
        "ka": color(hit.ka),
        "Ia": color(hit.ambient_light),
        "ka_Ia": color(hit.ambient),
        "emission": color(hit.emission),
        "kr": color(hit.reflection),
        "kt": color(hit.transmission),
    });
    let more = match &hit.shading {
        Shading::Model(model) if model.is_diagnostic() => json!({ "model": model.to_string() }),
        Shading::Model(model) => {
            let highlight = *model != ShadingModel::Lambert;
            json!({
                "model": model.to_string(),
                "fresnel": hit.fresnel,
                "kd": color(hit.diffuse),
                "ks": highlight.then(|| color(hit.specular)),
                "p": highlight.then_some(hit.shininess),
            })
        }
        Shading::Finish { layers, model } => json!({
            "model": "pov-ray finish",
            "terms_of": model.map(|model| model.to_string()),
            "layers": layers.iter().map(layer_value).collect::<Vec<_>>(),
        }),
    };
    add(&mut value, more);
    value
}

/// Adds the members of one object to another.
fn add(value: &mut Value, more: Value) {
    let into: Option<&mut Map<_, _>> = value.as_object_mut();
    if let (Some(into), Value::Object(more)) = (into, more) {
        into.extend(more);
    }
}

fn layer_value(layer: &LayerReport) -> Value {
    let f = &layer.finish;
    let r = &f.reflection;
    json!({
        "pigment": { "rgb": color(layer.color.rgb), "filter": layer.color.filter, "transmit": layer.color.transmit },
        "normal": point(layer.normal),
        "share": layer.share,
        "above": color(layer.above),
        "C": color(layer.body),
        "finish": {
            "ambient": color(f.ambient),
            "emission": color(f.emission),
            "diffuse": f.diffuse,
            "diffuse_from_behind": f.diffuse_back,
            "brilliance": f.brilliance,
            "phong": f.phong,
            "phong_size": f.phong_size,
            "specular": f.specular,
            "roughness": f.roughness,
            "metallic": f.metallic,
            "crand": f.crand,
            "irid": f.irid.map(|irid| json!({
                "amount": irid.amount,
                "thickness": irid.thickness,
                "turbulence": irid.turbulence,
            })),
            "conserve_energy": f.conserve_energy,
            "reflection": {
                "min": color(r.min),
                "max": color(r.max),
                "fresnel": r.fresnel,
                "falloff": r.falloff,
                "exponent": r.exponent,
                "metallic": r.metallic,
            },
        },
        "rise": layer.rise,
        "fresnel": layer.rise.filter(|_| r.fresnel),
        "reflection_film": layer.film.filter(|_| layer.rise.is_some()).map(color),
        "reflectance": color(layer.reflectance),
    })
}

fn light_value(scene: &RenderScene, hit: Option<&HitReport>, light: &LightReport) -> Value {
    let (term, detail) = (&light.term, &light.detail);
    let described = scene.lights().get(term.light as usize).map(|l| &l.light);
    let shadows: Vec<Value> = detail.shadows.iter().map(|s| shadow(scene, s)).collect();
    let shading = hit.map(|hit| &hit.shading);
    json!({
        "light": light_name(scene, term.light),
        "kind": described.map(light_kind),
        "position": described.map(light_position).filter(|(how, _)| *how == "at").map(|(_, p)| point(p)),
        "direction": described.map(light_position).filter(|(how, _)| *how == "along").map(|(_, p)| point(p)),
        "source": light_place(scene, term.light),
        "color": described.map(|l| color(l.color)),
        "color_here": color(term.color),
        "l": detail.l.map(point),
        "n_dot_l": term.n_dot_l,
        "shadow_rays": shadows,
        "fog": color(detail.fog),
        "visible": color(term.visible),
        "L": color(detail.arriving),
        "makes_highlights": detail.highlights,
        "mean_of_points": detail.mean_of,
        "terms": detail.terms.iter().map(|term| surface_term(shading, term)).collect::<Vec<_>>(),
        "diffuse": color(term.diffuse),
        "highlight": color(term.specular),
    })
}

/// The share of a layer in a light's terms, under the names of the shading model.
fn surface_term(shading: Option<&Shading>, term: &SurfaceTerm) -> Value {
    let mut value = json!({
        "n_dot_l": term.n_dot_l,
        "diffuse_factor": term.diffuse_factor,
        "grain": term.grain,
        "diffuse": color(term.diffuse),
        "highlight": color(term.highlight),
    });
    let more = match shading {
        Some(Shading::Finish { model, .. }) => {
            let highlights = *model != Some(ShadingModel::Lambert);
            let by_mirror = model.is_none_or(|model| model == ShadingModel::Phong);
            let by_half = model.is_none_or(|model| model == ShadingModel::BlinnPhong);
            json!({
                "phong_cosine": term.r_dot_v.filter(|_| highlights),
                "phong_cosine_is": if by_mirror { "r·v" } else { "h·n" },
                "phong": term.phong,
                "specular_cosine": term.h_dot_n.filter(|_| highlights),
                "specular_cosine_is": if by_half { "h·n" } else { "r·v" },
                "specular": term.specular,
                "tint": color(term.tint),
                "film": term.film.map(color),
            })
        }
        _ => match (term.r_dot_v, term.h_dot_n) {
            (Some(cos), _) => json!({ "r_dot_v": cos, "r_dot_v_p": term.phong }),
            (_, Some(cos)) => json!({ "h_dot_n": cos, "h_dot_n_p": term.specular }),
            _ => json!({}),
        },
    };
    add(&mut value, more);
    value
}

fn shadow(scene: &RenderScene, shadow: &ShadowReport) -> Value {
    let met = |met: &ShadowHit| {
        json!({
            "t": met.t,
            "object": object_name(scene, met.object),
            "object_id": met.object,
            "element": met.element,
            "source": object_place(scene, met.object, met.line),
            "blocks": met.blocks,
            "filter": color(met.filter),
            "medium_before": color(met.absorbed),
        })
    };
    json!({
        "origin": point(shadow.ray.origin),
        "direction": point(shadow.ray.direction),
        "met": shadow.met.iter().map(met).collect::<Vec<_>>(),
        "medium_behind": color(shadow.rest),
        "beside_mask": shadow.beside_mask,
        "visible": color(shadow.visible),
    })
}

fn ray(ray: &Ray) -> Value {
    json!({ "origin": point(ray.origin), "direction": point(ray.direction) })
}

fn point(p: DVec3) -> [f64; 3] {
    p.to_array()
}

fn color(c: Color) -> [f64; 3] {
    c.to_array()
}
