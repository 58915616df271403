use super::{Chosen, Digits, Pixel, Shown};
use std::fmt::Write;
use strahl::shade::Color;
use strahl::tracing::{RayKind, RayNode, RenderScene};

/// The tree of a pixel as a graph for Graphviz: rays that hit something are boxes filled with the colour they return, shadow rays
/// are small ellipses. Of several samples it shows the first, unless the user chooses others.
pub(crate) fn dot(scene: &RenderScene, pixel: &Pixel<'_>, shown: &Shown) -> String {
    let mut out = String::new();
    let (x, y) = pixel.at;
    let chosen = |sample: usize| match shown.sample {
        Some(Chosen::All) => true,
        Some(Chosen::One(number)) => sample + 1 == number,
        None => sample == 0,
    };
    // Writing to a string cannot fail.
    let _ = writeln!(
        out,
        "digraph \"pixel {x},{y}\" {{\n  node [shape=box, style=filled, fontname=\"sans-serif\"];"
    );
    let samples = pixel.tree.samples.iter().enumerate();
    for (number, sample) in samples.filter(|(number, _)| chosen(*number)) {
        for node in &sample.tree.nodes {
            write_node(&mut out, scene, number, node, shown.digits);
        }
    }
    out.push('}');
    out
}

fn write_node(
    out: &mut String,
    scene: &RenderScene,
    sample: usize,
    node: &RayNode,
    digits: Digits,
) {
    let report = &node.report;
    let id = format!("s{sample}r{}", report.node);
    let what = match &report.hit {
        None => "background".to_owned(),
        Some(hit) => {
            let place = scene
                .object_place(hit.object, hit.line)
                .map_or_else(String::new, |p| format!("\n{p}"));
            format!(
                "{}{place}\nt = {}",
                scene.object_name(hit.object),
                digits.number(hit.hit.t)
            )
        }
    };
    let label = format!(
        "#{} {}\n{what}\n({:.4}, {:.4}, {:.4})",
        report.node, report.kind, node.total.r, node.total.g, node.total.b
    );
    let (fill, ink) = shown(node.total);
    let _ = writeln!(
        out,
        "  {id} [label=\"{}\", fillcolor=\"{fill}\", fontcolor={ink}];",
        escaped(&label)
    );
    if report.node != report.parent {
        let style = if report.kind == RayKind::Reflection {
            "solid"
        } else {
            "dashed"
        };
        let label = format!("{}\nweight {:.4}", report.kind, report.weight);
        let _ = writeln!(
            out,
            "  s{sample}r{} -> {id} [label=\"{}\", style={style}];",
            report.parent,
            escaped(&label)
        );
    }
    for light in &node.lights {
        let term = &light.term;
        if term.shadow_ray.is_none() {
            continue;
        }
        let light_id = format!("{id}l{}", term.light);
        let blocker = light
            .detail
            .shadows
            .iter()
            .flat_map(|s| &s.met)
            .find(|m| m.blocks);
        let seen = match blocker {
            _ if !term.visible.is_black() => "lit".to_owned(),
            Some(met) => format!("blocked by {}", scene.object_name(met.object)),
            None => "in shadow".to_owned(),
        };
        let (fill, ink) = shown(term.diffuse + term.specular);
        let label = format!("{}\n{seen}", scene.light_name(term.light));
        let _ = writeln!(
            out,
            "  {light_id} [label=\"{}\", shape=ellipse, fillcolor=\"{fill}\", fontcolor={ink}];\n  {id} -> {light_id} \
             [label=\"shadow\", style=dotted];",
            escaped(&label)
        );
    }
    for (number, (kind, weight, end)) in node.ended.iter().enumerate() {
        let label = format!("no {kind} ray:\n{end}\nweight {weight:.4}");
        let _ = writeln!(
            out,
            "  {id}e{number} [label=\"{}\", shape=plaintext, style=solid];\n  {id} -> {id}e{number};",
            escaped(&label)
        );
    }
}

/// A linear colour as a fill colour (gamma 2 is close enough for a box), and black or white for readable text on it.
fn shown(c: Color) -> (String, &'static str) {
    let code = |v: f64| (v.clamp(0.0, 1.0).sqrt() * 255.0) as u8;
    let ink = if 0.2 * c.r + 0.7 * c.g + 0.1 * c.b > 0.2 {
        "black"
    } else {
        "white"
    };
    (
        format!("#{:02x}{:02x}{:02x}", code(c.r), code(c.g), code(c.b)),
        ink,
    )
}

fn escaped(s: &str) -> String {
    s.replace('\\', "\\\\")
        .replace('"', "\\\"")
        .replace('\n', "\\n")
}
