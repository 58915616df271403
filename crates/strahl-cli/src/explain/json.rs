use super::{light_name, material_name, object_name, object_place};
use serde_json::{Value, json};
use strahl::math::{DVec3, Ray};
use strahl::shade::Color;
use strahl::tracing::{HitReport, LightTerm, PixelTree, RayNode, RenderScene};

/// The trees of a pixel as JSON. Numbers are written so that reading them back gives the same bits; infinities and NaN, which
/// JSON does not have, are null.
pub(crate) fn json(scene: &RenderScene, pixel: &PixelTree, (x, y): (u32, u32)) -> String {
    let samples: Vec<Value> = pixel
        .samples
        .iter()
        .map(|((sx, sy), tree)| {
            let rays: Vec<Value> = tree
                .nodes
                .iter()
                .map(|node| ray_node(scene, node))
                .collect();
            json!({ "position": [sx, sy], "rays": rays })
        })
        .collect();
    let value = json!({
        "pixel": [x, y],
        "samples": samples,
        "color": color(pixel.color),
        "film": pixel.film,
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
        "lights": node.lights.iter().map(|term| light(scene, term)).collect::<Vec<_>>(),
        "ended": ended,
        "children": node.children,
        "attenuation": color(report.attenuation),
        "local": color(node.local),
        "total": color(node.total),
    })
}

fn hit_value(scene: &RenderScene, hit: &HitReport) -> Value {
    json!({
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
        "fresnel": hit.fresnel,
        "ka_Ia": color(hit.ambient),
        "emission": color(hit.emission),
        "kd": color(hit.diffuse),
        "ks": color(hit.specular),
        "p": hit.shininess,
        "kr": color(hit.reflection),
        "kt": color(hit.transmission),
    })
}

fn light(scene: &RenderScene, term: &LightTerm) -> Value {
    json!({
        "light": light_name(scene, term.light),
        "n_dot_l": term.n_dot_l,
        "shadow_ray": term.shadow_ray.as_ref().map(ray),
        "shadow_rays": term.shadow_rays,
        "visible": color(term.visible),
        "color": color(term.color),
        "kd_n_dot_l": color(term.diffuse),
        "ks_h_dot_n_p": color(term.specular),
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
