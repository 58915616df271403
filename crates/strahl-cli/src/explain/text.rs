use super::lights::write_light;
use super::names::object_at;
use super::page::Page;
use super::summary::{counted, write_outline, write_pixel, write_samples};
use super::tally::Tally;
use super::terms::write_shading;
use super::writer::{RAY, Writer};
use super::{Chosen, Digits, Pixel, Shown};
use strahl::math::det;
use strahl::shade::{Color, Quality};
use strahl::tracing::{
    BranchEnd, HitReport, PixelSample, RayKind, RayNode, RayTree, RenderScene, Shading,
};

/// The trees of a pixel as text: the pixel, the outline of the tree, and all terms of every ray.
pub(crate) fn text(scene: &RenderScene, pixel: &Pixel<'_>, shown: &Shown) -> String {
    let mut page = Page::default();
    let digits = shown.digits;
    write_pixel(&mut page, pixel, digits);
    if let Some(line) = left_out(scene.settings().quality) {
        page.line(0, &line);
    }
    let samples = &pixel.tree.samples;
    let chosen: Vec<usize> = match shown.sample {
        Some(Chosen::All) => (0..samples.len()).collect(),
        Some(Chosen::One(number)) => vec![number - 1],
        None if samples.len() == 1 => vec![0],
        None => vec![],
    };
    if samples.len() != 1 && chosen.len() != 1 {
        write_samples(&mut page, scene, pixel, shown);
    }
    for number in chosen {
        let Some(sample) = samples.get(number) else {
            continue;
        };
        page.gap();
        if samples.len() != 1 {
            page.line(0, &heading(number, sample, pixel, digits));
            page.gap();
        }
        write_sample(&mut page, scene, sample, shown);
    }
    page.finish()
}

/// What pictures of a reduced quality don't show.
fn left_out(quality: Quality) -> Option<String> {
    let all = [
        (!quality.is_unlit(), "light"),
        (quality.has_shadows(), "shadows"),
        (quality.has_area_lights(), "the extent of lights"),
        (
            !quality.has_quick_colors(),
            "pigments that have a quick_color",
        ),
        (quality.has_transparency(), "transparency"),
        (quality.has_reflection(), "reflection"),
        (quality.has_normals(), "normals of textures"),
        (quality.has_air(), "fog and rainbows"),
    ];
    let left: Vec<&str> = all
        .into_iter()
        .filter(|(shown, _)| !shown)
        .map(|(_, what)| what)
        .collect();
    (!left.is_empty()).then(|| format!("quality {quality} leaves out: {}", left.join(", ")))
}

fn heading(number: usize, sample: &PixelSample, pixel: &Pixel<'_>, digits: Digits) -> String {
    let (x, y) = sample.place;
    let ray = sample
        .ray
        .map_or_else(String::new, |k| format!(", ray {} through the lens", k + 1));
    format!(
        "sample {} at ({}, {}){ray}{}",
        number + 1,
        digits.number(x),
        digits.number(y),
        counted(sample, pixel)
    )
}

fn write_sample(page: &mut Page, scene: &RenderScene, sample: &PixelSample, shown: &Shown) {
    let tree = &sample.tree;
    let tally = Tally::of(tree);
    let visible = tally.shown(tree, shown.rays.unwrap_or(usize::MAX));
    write_outline(page, scene, tree, &tally, &visible);
    // Depth first with a stack: trees may be thousands of levels deep.
    let mut waiting: Vec<u32> = match tree.nodes.is_empty() {
        true => vec![],
        false => vec![0],
    };
    let writer = Writer {
        scene,
        digits: shown.digits,
    };
    while let Some(index) = waiting.pop() {
        let Some(node) = tree.nodes.get(index as usize) else {
            continue;
        };
        waiting.extend(node.children.iter().rev());
        if visible.get(index as usize) == Some(&true) {
            page.gap();
            writer.node(page, tree, node);
        }
    }
    let digits = shown.digits;
    if let Some(root) = tree.nodes.first()
        && root.total != sample.color
    {
        page.gap();
        page.line(
            0,
            &format!(
                "The scene's colours are not linear (assumed_gamma): {} is the linear colour {}",
                digits.color(root.total),
                digits.color(sample.color)
            ),
        );
    }
}

impl Writer<'_> {
    fn node(&self, page: &mut Page, tree: &RayTree, node: &RayNode) {
        let (d, report) = (self.digits, &node.report);
        let parent = match report.node == report.parent {
            true => String::new(),
            false => format!(" of #{}", report.parent),
        };
        page.line(
            0,
            &format!(
                "#{} {} ray{parent}, level {}, weight {}",
                report.node,
                report.kind,
                report.depth,
                d.number(report.weight)
            ),
        );
        if !report.part.is_white() {
            let place = d.number(report.part.place());
            page.line(
                RAY,
                &format!("light at {place} of the spectrum, from 0 (red) to 1 (violet)"),
            );
        }
        page.line(
            RAY,
            &format!(
                "from {}, direction {}",
                d.point(report.ray.origin),
                d.point(report.ray.direction)
            ),
        );
        match &report.hit {
            None => page.line(
                RAY,
                &format!("hits nothing; local = background = {}", d.color(node.local)),
            ),
            Some(hit) => self.hit(page, node, hit),
        }
        for (kind, weight, end) in &node.ended {
            if *end != BranchEnd::TotalReflection {
                let weight = d.number(*weight);
                page.line(RAY, &format!("no {kind} ray: {end} (weight {weight})"));
            }
        }
        self.total(page, tree, node);
    }

    fn hit(&self, page: &mut Page, node: &RayNode, hit: &HitReport) {
        let d = self.digits;
        page.line(
            RAY,
            &format!(
                "hits {}, {}, at t = {}",
                object_at(self.scene, hit.object, hit.line, hit.hit.id),
                self.scene.material_name(hit.material.0),
                d.number(hit.hit.t)
            ),
        );
        let shading = if hit.n_geom == hit.n_shade {
            String::new()
        } else {
            format!(", for shading {}", d.point(hit.n_shade))
        };
        page.line(
            RAY,
            &format!(
                "point {}, normal n = {}{shading}",
                d.point(hit.position),
                d.point(hit.n_geom)
            ),
        );
        self.angles(page, hit);
        write_shading(self, page, hit);
        if let Shading::Model(model) = hit.shading
            && model.is_diagnostic()
        {
            page.line(RAY, &format!("local = {}", d.color(node.local)));
            return;
        }
        for light in &node.lights {
            write_light(self, page, hit, light);
        }
        let mut local = "local = ambient".to_owned();
        if !hit.emission.is_black() {
            local.push_str(" + emission");
        }
        if !node.lights.is_empty() {
            local.push_str(" + lights");
        }
        if let Shading::Finish { layers, .. } = &hit.shading
            && layers.iter().any(|layer| layer.finish.crand != 0.0)
        {
            local.push_str(" (crand: not below 0)");
        }
        page.line(RAY, &format!("{local} = {}", d.color(node.local)));
    }

    /// Writes the indices of refraction and the angles.
    fn angles(&self, page: &mut Page, hit: &HitReport) {
        let d = self.digits;
        let degrees = |cosine: f64| d.number(det::acos(cosine.clamp(-1.0, 1.0)).to_degrees());
        let (n1, n2) = (d.number(hit.eta_1), d.number(hit.eta_2));
        let theta_1 = degrees(hit.cos_1);
        if hit.total_reflection {
            let sin_1 = (1.0 - hit.cos_1 * hit.cos_1).max(0.0).sqrt();
            let sin_2 = d.number(hit.eta_1 / hit.eta_2 * sin_1);
            page.line(RAY, &format!("θ1 = {theta_1}°, n1 = {n1}, n2 = {n2}"));
            let so = match hit.transmission.is_black() {
                true => "so there is no transparency ray",
                false => "but not at the other normals of the blended textures",
            };
            page.line(
                RAY,
                &format!("total internal reflection: sin θ2 = n1/n2 · sin θ1 = {sin_2} > 1, {so}"),
            );
        } else if let Some(cos_2) = hit.cos_2 {
            page.line(
                RAY,
                &format!(
                    "θ1 = {theta_1}°, θ2 = {}°, n1 = {n1}, n2 = {n2}",
                    degrees(cos_2)
                ),
            );
        } else {
            page.line(RAY, &format!("θ1 = {theta_1}°, n1 = {n1}"));
        }
    }

    /// Writes the contributions of the child rays, and the sum.
    fn total(&self, page: &mut Page, tree: &RayTree, node: &RayNode) {
        let (d, report) = (self.digits, &node.report);
        let mut sum = "local".to_owned();
        for child in &node.children {
            let Some(child) = tree.nodes.get(*child as usize) else {
                continue;
            };
            let (k, x, from) = match child.report.kind {
                RayKind::Reflection => ("kr", "Xr", ""),
                _ if report.hit.as_ref().is_some_and(|hit| {
                    child.report.ray.direction.dot(hit.n_geom) > 0.0
                        && !child.report.part.is_white()
                }) =>
                {
                    ("kt", "Xt", ", totally reflected")
                }
                _ => ("kt", "Xt", ""),
            };
            let share = child.report.share;
            let power = match share.power == 1.0 {
                true => String::new(),
                false => format!("^{}", d.number(share.power)),
            };
            page.line(
                RAY,
                &format!(
                    "{k} · {x}{power} = {} · {}{power} = {} from #{}{from}",
                    d.color(share.factor),
                    d.color(child.total),
                    d.color(share.of(child.total)),
                    child.report.node
                ),
            );
            let added = format!(" + {k} · {x}{power}");
            if !sum.ends_with(&added) {
                sum.push_str(&added);
            }
        }
        if report.attenuation != Color::WHITE {
            let medium = self.kept_by(tree, node);
            page.line(
                RAY,
                &format!("kept on the way = {}{medium}", d.color(report.attenuation)),
            );
            sum = match sum.contains('+') {
                true => format!("({sum}) · kept"),
                false => format!("{sum} · kept"),
            };
        }
        if report.fog != Color::BLACK {
            page.line(RAY, &format!("fog = {}", d.color(report.fog)));
            sum.push_str(" + fog");
        }
        page.line(RAY, &format!("total = {sum} = {}", d.color(node.total)));
    }

    /// The attenuation of the light on its way along a ray.
    fn kept_by(&self, tree: &RayTree, node: &RayNode) -> String {
        let (d, report) = (self.digits, &node.report);
        let mut words = Vec::new();
        match report.medium {
            None if report.fog == Color::BLACK => {}
            None => words.push("in the air".to_owned()),
            Some(id) => {
                let hit = report.hit.as_ref();
                let length = hit.map_or(f64::INFINITY, |hit| hit.hit.t);
                words.push(format!(
                    "in {} over a length of {}",
                    self.scene.material_name(id.0),
                    d.number(length * report.ray.direction.length())
                ));
            }
        }
        let parent = tree.nodes.get(report.parent as usize);
        if !report.part.is_white() && parent.is_some_and(|p| p.report.part.is_white()) {
            words.push(format!(
                "this part of the spectrum is {} of the light",
                d.color(report.part.share())
            ));
        }
        match words.is_empty() {
            true => String::new(),
            false => format!(", {}", words.join(", ")),
        }
    }
}
