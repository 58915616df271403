use super::{light_name, material_name, object_name, object_place};
use std::fmt::Write;
use strahl::math::DVec3;
use strahl::shade::Color;
use strahl::tracing::{HitReport, LightTerm, PixelTree, RayNode, RayTree, RenderScene};

/// The trees of a pixel, indented, with all terms. Numbers are printed in full, so that the sums can be checked.
pub(crate) fn text(scene: &RenderScene, pixel: &PixelTree, (x, y): (u32, u32)) -> String {
    let mut out = String::new();
    let count = pixel.samples.len();
    line(
        &mut out,
        0,
        format_args!(
            "pixel {x},{y}: {count} sample{}",
            if count == 1 { "" } else { "s" }
        ),
    );
    for (number, ((sx, sy), tree)) in pixel.samples.iter().enumerate() {
        line(&mut out, 0, format_args!(""));
        line(
            &mut out,
            0,
            format_args!("sample {} at ({sx}, {sy})", number + 1),
        );
        write_tree(&mut out, scene, tree);
    }
    line(&mut out, 0, format_args!(""));
    let mean = if count == 1 {
        ""
    } else {
        ", the mean of the samples"
    };
    line(
        &mut out,
        0,
        format_args!("linear colour {}{mean}", color(pixel.color)),
    );
    let [r, g, b] = pixel.film;
    let _ = write!(out, "in the film   ({r:?}, {g:?}, {b:?})");
    out
}

fn line(out: &mut String, level: usize, text: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = writeln!(out, "{:width$}{text}", "", width = 2 * level);
}

fn write_tree(out: &mut String, scene: &RenderScene, tree: &RayTree) {
    // Depth first with a stack: trees may be thousands of levels deep.
    let mut waiting: Vec<u32> = if tree.nodes.is_empty() {
        vec![]
    } else {
        vec![0]
    };
    while let Some(index) = waiting.pop() {
        let Some(node) = tree.nodes.get(index as usize) else {
            continue;
        };
        waiting.extend(node.children.iter().rev());
        write_node(out, scene, tree, node);
    }
}

fn write_node(out: &mut String, scene: &RenderScene, tree: &RayTree, node: &RayNode) {
    let report = &node.report;
    // Very deep trees would run off any page.
    let level = (report.depth as usize - 1).min(40);
    line(
        out,
        level,
        format_args!(
            "#{} {} ray, depth {}, weight {}",
            report.node, report.kind, report.depth, report.weight
        ),
    );
    let level = level + 1;
    if !report.part.is_white() {
        let place = report.part.place();
        line(
            out,
            level,
            format_args!(
                "light at {place} of the spectrum from red (0) to violet (1), a share of {}",
                color(report.part.share())
            ),
        );
    }
    let ray = &report.ray;
    line(
        out,
        level,
        format_args!(
            "from {} direction {}",
            point(ray.origin),
            point(ray.direction)
        ),
    );
    match &report.hit {
        None => line(
            out,
            level,
            format_args!("hits nothing: background {}", color(node.local)),
        ),
        Some(hit) => write_hit(out, scene, level, hit),
    }
    for light in &node.lights {
        write_light(out, scene, level, light);
    }
    if report.hit.is_some() {
        line(out, level, format_args!("local {}", color(node.local)));
    }
    for (kind, weight, end) in &node.ended {
        line(
            out,
            level,
            format_args!("no {kind} ray: {end} (weight {weight})"),
        );
    }
    for child in &node.children {
        if let Some(child) = tree.nodes.get(*child as usize) {
            let name = match child.report.kind {
                strahl::tracing::RayKind::Reflection => "kr·Xr",
                _ => "kt·Xt",
            };
            let share = child.report.share;
            let product = share.of(child.total);
            let power = if share.power == 1.0 {
                String::new()
            } else {
                format!("^{}", share.power)
            };
            line(
                out,
                level,
                format_args!(
                    "{name}{power} = {} · {}{power} = {} (ray #{})",
                    color(share.factor),
                    color(child.total),
                    color(product),
                    child.report.node
                ),
            );
        }
    }
    if report.attenuation != Color::WHITE {
        line(
            out,
            level,
            format_args!("absorbed on the way: times {}", color(report.attenuation)),
        );
    }
    if report.fog != Color::BLACK {
        line(out, level, format_args!("fog adds {}", color(report.fog)));
    }
    line(out, level, format_args!("total {}", color(node.total)));
}

fn write_hit(out: &mut String, scene: &RenderScene, level: usize, hit: &HitReport) {
    let name = object_name(scene, hit.object);
    let place =
        object_place(scene, hit.object, hit.line).map_or_else(String::new, |p| format!(" ({p})"));
    let material = material_name(scene, hit.material.0);
    line(out, level, format_args!("hits {name}{place}, {material}"));
    line(
        out,
        level,
        format_args!("t {}, position {}", hit.hit.t, point(hit.position)),
    );
    let shading = if hit.n_geom == hit.n_shade {
        String::new()
    } else {
        format!(", shading normal {}", point(hit.n_shade))
    };
    line(
        out,
        level,
        format_args!("normal {}{shading}", point(hit.n_geom)),
    );
    let degrees = |cosine: f64| cosine.clamp(-1.0, 1.0).acos().to_degrees();
    let behind = match hit.cos_2 {
        Some(cos_2) => format!(", θ2 {:.4}°", degrees(cos_2)),
        None => String::new(),
    };
    let fresnel = hit
        .fresnel
        .map_or_else(String::new, |f| format!(", Fresnel F {f}"));
    line(
        out,
        level,
        format_args!(
            "n1 {}, n2 {}, θ1 {:.4}°{behind}{fresnel}",
            hit.eta_1,
            hit.eta_2,
            degrees(hit.cos_1)
        ),
    );
    if !hit.diagnostic {
        line(out, level, format_args!("ka·Ia {}", color(hit.ambient)));
        if !hit.emission.is_black() {
            line(out, level, format_args!("emission {}", color(hit.emission)));
        }
    }
}

fn write_light(out: &mut String, scene: &RenderScene, level: usize, term: &LightTerm) {
    let name = light_name(scene, term.light);
    if !(term.n_dot_l > 0.0) {
        let why = if term.color.is_black() {
            "does not shine here"
        } else {
            "is behind the surface"
        };
        line(
            out,
            level,
            format_args!("{name} {why} (n·l {})", term.n_dot_l),
        );
        return;
    }
    let visible = match term.shadow_ray {
        None => "casts no shadows".to_owned(),
        Some(_) if term.visible.is_black() => "in shadow".to_owned(),
        Some(_) if term.visible == Color::WHITE => "visible".to_owned(),
        Some(_) if term.shadow_rays > 1 => format!("seen to {}", color(term.visible)),
        Some(_) => format!("filtered to {}", color(term.visible)),
    };
    let rays = match term.shadow_rays {
        0 | 1 => String::new(),
        n => format!("s: {n}, the one to the centre"),
    };
    line(
        out,
        level,
        format_args!("{name}: n·l {}, {visible}", term.n_dot_l),
    );
    if let Some(ray) = &term.shadow_ray {
        line(
            out,
            level + 1,
            format_args!(
                "shadow ray{rays} from {} direction {}",
                point(ray.origin),
                point(ray.direction)
            ),
        );
    }
    if !term.visible.is_black() {
        line(
            out,
            level + 1,
            format_args!("kd(n·l) {}", color(term.diffuse)),
        );
        line(
            out,
            level + 1,
            format_args!("ks(h·n)^p {}", color(term.specular)),
        );
    }
}

fn point(p: DVec3) -> String {
    format!("({:?}, {:?}, {:?})", p.x, p.y, p.z)
}

fn color(c: Color) -> String {
    format!("({:?}, {:?}, {:?})", c.r, c.g, c.b)
}
