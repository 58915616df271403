//! The terms of the shading model at a hit, in words.

use super::names::{light_at, object_at};
use super::page::Page;
use super::tally::plural;
use super::text::{RAY, Writer};
use strahl::math::DVec3;
use strahl::shade::pov_finish::PovFinish;
use strahl::shade::{Color, ShadingModel};
use strahl::tracing::{HitReport, LayerReport, LightReport, Shading, ShadowReport, SurfaceTerm};

/// Indentation of the lines of a light or a layer.
const INNER: usize = RAY + 2;

/// Writes the model and its coefficients, ambient light and emission.
pub(super) fn write_shading(w: &Writer<'_>, page: &mut Page, hit: &HitReport) {
    let d = w.digits;
    match &hit.shading {
        Shading::Model(model) if model.is_diagnostic() => {
            page.line(
                RAY,
                &format!("shading model {model}: {}", diagnostic(*model)),
            );
            return;
        }
        Shading::Model(model) => {
            let highlight = match model {
                ShadingModel::Phong => " + ks (r·v)^p",
                ShadingModel::BlinnPhong => " + ks (h·n)^p",
                _ => "",
            };
            page.line(
                RAY,
                &format!("shading model {model}: ka Ia + Σ L (kd (n·l){highlight})"),
            );
            let mut coefficients =
                format!("ka = {}, kd = {}", d.color(hit.ka), d.color(hit.diffuse));
            if !highlight.is_empty() {
                coefficients.push_str(&format!(
                    ", ks = {}, p = {}",
                    d.color(hit.specular),
                    d.number(hit.shininess)
                ));
            }
            page.line(INNER, &coefficients);
            if let Some(f) = hit.fresnel {
                page.line(INNER, &format!("Fresnel's F = {}", d.number(f)));
            }
            let divides = !hit.reflection.is_black() || !hit.transmission.is_black();
            if divides {
                let (kr, kt) = (d.color(hit.reflection), d.color(hit.transmission));
                page.line(INNER, &format!("kr = {kr}, kt = {kt}"));
            }
        }
        Shading::Finish { layers, model } => {
            let count = layers.len() as u32;
            let by = model.map_or_else(String::new, |model| {
                format!(", with the terms of --shading {model}")
            });
            page.line(
                RAY,
                &format!(
                    "POV-Ray's finish, {count} {}{by}",
                    plural(count, "layer", "layers, the uppermost first")
                ),
            );
            for (number, layer) in layers.iter().enumerate() {
                write_layer(w, page, layer, (count > 1).then_some(number + 1), *model);
            }
            if let Some(line) = divided(w, hit, layers) {
                page.line(INNER, &line);
            }
        }
    }
    page.line(
        RAY,
        &format!(
            "ambient = ka · Ia = {} · {} = {}",
            d.color(hit.ka),
            d.color(hit.ambient_light),
            d.color(hit.ambient)
        ),
    );
    if !hit.emission.is_black() {
        page.line(RAY, &format!("emission = {}", d.color(hit.emission)));
    }
}

fn diagnostic(model: ShadingModel) -> &'static str {
    match model {
        ShadingModel::Normals => "the normal n/2 + 1/2 as a colour",
        ShadingModel::Depth => "the distance from the eye, t / (t + diagonal of the scene)",
        ShadingModel::ObjectId => "a colour for each object",
        _ => "the texture coordinates u and v as red and green",
    }
}

/// Writes the colour of a layer, its finish, and the coefficients derived from them.
fn write_layer(
    w: &Writer<'_>,
    page: &mut Page,
    layer: &LayerReport,
    number: Option<usize>,
    model: Option<ShadingModel>,
) {
    let d = w.digits;
    let color = layer.color;
    let mut pigment = format!("pigment rgb {}", d.color(color.rgb));
    for (name, value) in [("filter", color.filter), ("transmit", color.transmit)] {
        if value != 0.0 {
            pigment.push_str(&format!(", {name} {}", d.number(value)));
        }
    }
    let name = number.map_or_else(String::new, |n| format!("layer {n}: "));
    page.line(
        INNER,
        &format!(
            "{name}{pigment}; finish {}",
            finish(w, &layer.finish, model)
        ),
    );
    if layer.share != 1.0 || layer.above != Color::WHITE {
        page.line(
            INNER,
            &format!(
                "a share of {} of the surface; the layers above transmit {}",
                d.number(layer.share),
                d.color(layer.above)
            ),
        );
    }
    let mut factors = vec!["rgb"];
    if color.opacity() != 1.0 {
        factors.push("(1 - filter - transmit)");
    }
    if layer.above != Color::WHITE {
        factors.push("passed from above");
    }
    if layer.share != 1.0 {
        factors.push("share");
    }
    page.line(
        INNER,
        &format!(
            "C = {} = {}, ka = ambient · C",
            factors.join(" · "),
            d.color(layer.body)
        ),
    );
    if let Some(rise) = layer.rise {
        page.line(INNER, &reflection(w, layer, rise));
    }
}

/// The items of a finish that have an effect, by their names in the language.
fn finish(w: &Writer<'_>, f: &PovFinish, model: Option<ShadingModel>) -> String {
    let d = w.digits;
    let mut items = vec![format!("ambient {}", d.gray_or_color(f.ambient))];
    let mut item = |shown: bool, name: &str, value: f64| {
        if shown {
            items.push(format!("{name} {}", d.number(value)));
        }
    };
    let plain = PovFinish::default();
    item(true, "diffuse", f.diffuse);
    item(f.diffuse_back != 0.0, "diffuse from behind", f.diffuse_back);
    item(
        f.brilliance != plain.brilliance && model.is_none(),
        "brilliance",
        f.brilliance,
    );
    item(f.phong != 0.0, "phong", f.phong);
    item(f.phong != 0.0, "phong_size", f.phong_size);
    item(f.specular != 0.0, "specular", f.specular);
    item(f.specular != 0.0, "roughness", f.roughness);
    item(f.metallic != 0.0, "metallic", f.metallic);
    item(f.crand != 0.0, "crand", f.crand);
    if let Some(irid) = f.irid {
        let mut parts = vec![d.number(irid.amount)];
        parts.push(format!("thickness {}", d.number(irid.thickness)));
        if irid.turbulence != 0.0 {
            parts.push(format!("turbulence {}", d.number(irid.turbulence)));
        }
        items.push(format!("irid {{ {} }}", parts.join(" ")));
    }
    if !f.emission.is_black() {
        items.push(format!("emission {}", d.gray_or_color(f.emission)));
    }
    let r = &f.reflection;
    if !r.is_none() {
        let mut parts = vec![d.gray_or_color(r.min)];
        if r.min != r.max {
            parts.push(d.gray_or_color(r.max));
        }
        if r.fresnel {
            parts.push("fresnel".to_owned());
        } else if r.min != r.max && r.falloff != 1.0 {
            parts.push(format!("falloff {}", d.number(r.falloff)));
        }
        if r.exponent != 1.0 {
            parts.push(format!("exponent {}", d.number(r.exponent)));
        }
        if r.metallic != 0.0 {
            parts.push(format!("metallic {}", d.number(r.metallic)));
        }
        items.push(format!("reflection {{ {} }}", parts.join(" ")));
        if f.conserve_energy {
            items.push("conserve_energy".to_owned());
        }
    }
    items.join(", ")
}

/// How the surface as a whole splits light into reflection and transmission, if it does.
fn divided(w: &Writer<'_>, hit: &HitReport, layers: &[LayerReport]) -> Option<String> {
    let d = w.digits;
    let (kr, kt) = (d.color(hit.reflection), d.color(hit.transmission));
    if hit.total_reflection {
        return Some(format!("total internal reflection: kr = {kr}, kt = {kt}"));
    }
    match layers {
        [layer] if !hit.transmission.is_black() => {
            let left = match layer.finish.conserve_energy && layer.rise.is_some() {
                true => " · (1 - kr)",
                false => "",
            };
            Some(
                match (layer.color.filter != 0.0, layer.color.transmit != 0.0) {
                    (true, false) => format!("kt = rgb · filter{left} = {kt}"),
                    (false, _) => format!("kt = transmit{left} = {kt}"),
                    _ if left.is_empty() => format!("kt = rgb · filter + transmit = {kt}"),
                    _ => format!("kt = (rgb · filter + transmit){left} = {kt}"),
                },
            )
        }
        [_] => None,
        _ if hit.reflection.is_black() && hit.transmission.is_black() => None,
        _ => Some(format!("all layers: kr = {kr}, kt = {kt}")),
    }
}

/// The formula of a layer's kr.
fn reflection(w: &Writer<'_>, layer: &LayerReport, rise: f64) -> String {
    let d = w.digits;
    let r = &layer.finish.reflection;
    let tint = if r.metallic == 0.0 {
        ""
    } else {
        " · metallic"
    };
    let share = if layer.share == 1.0 { "" } else { " · share" };
    let film = match layer.film {
        None => String::new(),
        Some(factor) if r.exponent == 1.0 => format!(" · irid {}", d.color(factor)),
        Some(factor) => format!(" · irid {}^(1/exponent)", d.color(factor)),
    };
    let kr = d.color(layer.reflectance * layer.share);
    if r.min == r.max {
        return format!("kr = reflection{tint}{film}{share} = {kr}");
    }
    let (name, value) = if r.fresnel {
        ("F".to_owned(), format!("Fresnel's F = {}", d.number(rise)))
    } else {
        let power = match r.falloff == 1.0 {
            true => String::new(),
            false => format!("^{}", d.number(r.falloff)),
        };
        (
            "f".to_owned(),
            format!("f = (1 - cos θ1){power} = {}", d.number(rise)),
        )
    };
    format!("{value}, kr = (min + (max - min) · {name}){tint}{film}{share} = {kr}")
}

/// Writes a light at a hit: its position, the shadow rays, and its terms.
pub(super) fn write_light(w: &Writer<'_>, page: &mut Page, hit: &HitReport, light: &LightReport) {
    let (d, term, detail) = (w.digits, &light.term, &light.detail);
    page.line(RAY, &light_at(w.scene, term.light, d));
    let Some(l) = detail.l else {
        page.line(INNER, "does not shine here");
        return;
    };
    let n_dot_l = format!("l = {}, n·l = {}", d.point(l), d.number(term.n_dot_l));
    if term.shadow_ray.is_none() && term.visible.is_black() {
        page.line(INNER, &format!("{n_dot_l}: it is behind the surface"));
        return;
    }
    page.line(INNER, &n_dot_l);
    let described = w.scene.lights().get(term.light as usize);
    if term.shadow_ray.is_none() {
        let why = match described.is_some_and(|l| l.light.casts_shadows) {
            true => "nothing is in front of the light here",
            false => "this light casts no shadows",
        };
        page.line(INNER, &format!("no shadow ray: {why}"));
    }
    match detail.shadows.as_slice() {
        [] => {}
        [shadow] if described.is_none_or(|l| l.light.area.is_none()) => {
            write_shadow(w, page, shadow);
        }
        shadows => write_shadows(w, page, shadows, term.visible),
    }
    if detail.fog != Color::WHITE {
        page.line(INNER, &format!("fog keeps {} of it", d.color(detail.fog)));
    }
    if term.visible.is_black() {
        return;
    }
    let shines = described.map_or(term.color, |l| l.light.color);
    let mut arriving = format!("L = {}", d.color(detail.arriving));
    if shines != detail.arriving {
        let here = match shines == term.color {
            true => "its colour".to_owned(),
            false => format!(
                "its colour here, {} of {},",
                d.color(term.color),
                d.color(shines)
            ),
        };
        let visible = match term.visible == Color::WHITE {
            true => String::new(),
            false => format!(" · visible {}", d.color(term.visible)),
        };
        arriving.push_str(&format!(" = {here}{visible}"));
        if shines == term.color {
            arriving = format!(
                "L = colour · visible = {} · {} = {}",
                d.color(term.color),
                d.color(term.visible),
                d.color(detail.arriving)
            );
        }
    }
    page.line(INNER, &arriving);
    if let Some(count) = detail.mean_of {
        page.line(
            INNER,
            &format!(
                "each of its {count} points is shaded by itself; the means are diffuse {}, highlight {}",
                d.color(term.diffuse),
                d.color(term.specular)
            ),
        );
        return;
    }
    match &hit.shading {
        Shading::Model(model) => {
            for term in &detail.terms {
                write_terms(w, page, hit, *model, term, detail.arriving);
            }
        }
        Shading::Finish { layers, model } => {
            for (number, (layer, term)) in layers.iter().zip(&detail.terms).enumerate() {
                let name = match layers.len() {
                    1 => String::new(),
                    _ => format!("layer {}: ", number + 1),
                };
                write_finish_terms(w, page, &name, layer, *model, term, detail.arriving);
            }
            if layers.len() > 1 {
                page.line(
                    INNER,
                    &format!(
                        "all layers: diffuse {}, highlight {}",
                        d.color(term.diffuse),
                        d.color(term.specular)
                    ),
                );
            }
        }
    }
    if !detail.highlights {
        page.line(INNER, "this light causes no highlights");
    }
}

/// Writes the terms with kd and ks.
fn write_terms(
    w: &Writer<'_>,
    page: &mut Page,
    hit: &HitReport,
    model: ShadingModel,
    term: &SurfaceTerm,
    arriving: Color,
) {
    let d = w.digits;
    let light = d.color(arriving);
    let n_dot_l = if term.n_dot_l < 0.0 {
        "|n·l|"
    } else {
        "(n·l)"
    };
    page.line(
        INNER,
        &format!(
            "kd · L · {n_dot_l} = {} · {light} · {} = {}",
            d.color(hit.diffuse),
            d.number(term.diffuse_factor),
            d.color(term.diffuse)
        ),
    );
    let (name, cos, value) = match (model, term.r_dot_v, term.h_dot_n) {
        (ShadingModel::Phong, Some(cos), _) => ("r·v", cos, term.phong),
        (_, _, Some(cos)) => ("h·n", cos, term.specular),
        _ => return,
    };
    page.line(
        INNER,
        &format!(
            "ks · L · ({name})^p = {} · {light} · {} = {}",
            d.color(hit.specular),
            power(w, cos, hit.shininess, value),
            d.color(term.highlight)
        ),
    );
}

/// A power with its value; a negative cosine counts as 0.
fn power(w: &Writer<'_>, cos: f64, exponent: f64, value: f64) -> String {
    let d = w.digits;
    if cos > 0.0 {
        format!(
            "{}^{} [{}]",
            d.number(cos),
            d.number(exponent),
            d.number(value)
        )
    } else {
        format!("0 [{} < 0]", d.number(cos))
    }
}

/// Writes the terms of a POV-Ray finish under its names.
fn write_finish_terms(
    w: &Writer<'_>,
    page: &mut Page,
    name: &str,
    layer: &LayerReport,
    model: Option<ShadingModel>,
    term: &SurfaceTerm,
    arriving: Color,
) {
    let d = w.digits;
    let f = &layer.finish;
    let light = d.color(arriving);
    let behind = term.n_dot_l < 0.0;
    let (film, by_film) = match term.film {
        None => ("", String::new()),
        Some(factor) => (" · irid", format!(" · {}", d.color(factor))),
    };
    let (strength, named) = match behind && f.diffuse_back != 0.0 {
        true => (f.diffuse_back, "diffuse from behind"),
        false => (f.diffuse, "diffuse"),
    };
    if strength != 0.0 && term.diffuse_factor != 0.0 {
        let n_dot_l = if behind { "|n·l|" } else { "(n·l)" };
        let cos = d.number(term.n_dot_l.abs());
        let (power, value) = match f.brilliance == 1.0 || model.is_some() {
            true => (String::new(), cos),
            false => (
                "^brilliance".to_owned(),
                format!("{cos}^{}", d.number(f.brilliance)),
            ),
        };
        let (grain, by_grain) = match term.grain == 0.0 {
            true => ("", String::new()),
            false => (
                " - crand · rgb · above · L",
                format!(
                    " - {} · {} · {} · {light}{by_film}",
                    d.number(term.grain),
                    d.color(layer.color.rgb),
                    d.color(layer.above)
                ),
            ),
        };
        page.line(
            INNER,
            &format!(
                "{name}{named} · {n_dot_l}{power} · C · L{film}{grain} = {} · {value} · {} · {light}{by_film}{by_grain} = {}",
                d.number(strength),
                d.color(layer.body),
                d.color(term.diffuse)
            ),
        );
    }
    if model == Some(ShadingModel::Lambert) {
        return;
    }
    let shape = |own: ShadingModel| match model.unwrap_or(own) {
        ShadingModel::Phong => "r·v",
        _ => "h·n",
    };
    let mut parts = Vec::new();
    if let Some(cos) = term.r_dot_v {
        parts.push((
            format!("phong · ({})^phong_size", shape(ShadingModel::Phong)),
            d.number(f.phong),
            power(w, cos, f.phong_size, term.phong / f.phong),
        ));
    }
    if let Some(cos) = term.h_dot_n {
        parts.push((
            format!(
                "specular · ({})^(1/roughness)",
                shape(ShadingModel::BlinnPhong)
            ),
            d.number(f.specular),
            power(w, cos, 1.0 / f.roughness, term.specular / f.specular),
        ));
    }
    let mut others = (String::new(), String::new());
    let mut other = |shown: bool, name: &str, value: String| {
        if shown {
            others.0.push_str(&format!(" · {name}"));
            others.1.push_str(&format!(" · {value}"));
        }
    };
    other(f.metallic != 0.0, "metallic", d.color(term.tint));
    other(
        layer.above != Color::WHITE,
        "passed from above",
        d.color(layer.above),
    );
    other(layer.share != 1.0, "share", d.number(layer.share));
    if let Some(factor) = term.film {
        other(true, "irid", d.color(factor));
    }
    match parts.as_slice() {
        [] => {}
        [(names, strength, power)] => page.line(
            INNER,
            &format!(
                "{name}{names}{} · L = {strength} · {power}{} · {light} = {}",
                others.0,
                others.1,
                d.color(term.highlight)
            ),
        ),
        parts => {
            for ((names, strength, power), value) in parts.iter().zip([term.phong, term.specular]) {
                page.line(
                    INNER,
                    &format!("{name}{names} = {strength} · {power} = {}", d.number(value)),
                );
            }
            page.line(
                INNER,
                &format!(
                    "{name}highlight = (phong + specular){} · L = {}{} · {light} = {}",
                    others.0,
                    d.number(term.phong + term.specular),
                    others.1,
                    d.color(term.highlight)
                ),
            );
        }
    }
}

/// Writes a shadow ray and the objects it hits.
fn write_shadow(w: &Writer<'_>, page: &mut Page, shadow: &ShadowReport) {
    let d = w.digits;
    let (from, towards) = (d.point(shadow.ray.origin), d.point(shadow.ray.direction));
    page.line(
        INNER,
        &format!("shadow ray from {from}, direction {towards}"),
    );
    if shadow.beside_mask {
        page.line(
            INNER + 2,
            "does not pass the object of `projected_through`: no light",
        );
        return;
    }
    if shadow.met.is_empty() {
        page.line(INNER + 2, "meets nothing: the light is visible");
    }
    for met in &shadow.met {
        let object = object_at(w.scene, met.object, met.line, met.element);
        let t = d.number(met.t);
        if met.blocks {
            page.line(
                INNER + 2,
                &format!("is blocked by {object} at t = {t}: in shadow"),
            );
            return;
        }
        let medium = kept(w, met.absorbed);
        let filter = d.color(met.filter);
        page.line(
            INNER + 2,
            &format!("passes {object} at t = {t}, which keeps {filter}{medium}"),
        );
    }
    let rest = kept(w, shadow.rest);
    if !shadow.met.is_empty() || !rest.is_empty() {
        page.line(
            INNER + 2,
            &format!("visible = the product = {}{rest}", d.color(shadow.visible)),
        );
    }
}

/// The transmittance of the medium before a surface, if it absorbs light.
fn kept(w: &Writer<'_>, absorbed: Color) -> String {
    if absorbed == Color::WHITE {
        return String::new();
    }
    format!(", the medium before it {}", w.digits.color(absorbed))
}

/// Writes the shadow rays of an area light: how many reach the light, and what blocks the others.
fn write_shadows(w: &Writer<'_>, page: &mut Page, shadows: &[ShadowReport], visible: Color) {
    let d = w.digits;
    let mut free = 0;
    // Objects with the numbers of rays they block and weaken, in order of appearance.
    let mut in_the_way: Vec<(String, u32, u32)> = Vec::new();
    for shadow in shadows {
        if shadow.met.is_empty() {
            free += u32::from(!shadow.beside_mask);
        }
        for met in &shadow.met {
            let object = object_at(w.scene, met.object, met.line, met.element);
            let known = in_the_way.iter().position(|(name, ..)| *name == object);
            let place = known.unwrap_or_else(|| {
                in_the_way.push((object, 0, 0));
                in_the_way.len() - 1
            });
            if let Some((_, blocked, weakened)) = in_the_way.get_mut(place) {
                *(if met.blocks { blocked } else { weakened }) += 1;
            }
        }
    }
    let center: DVec3 = shadows.iter().map(|s| s.ray.direction).sum();
    let towards = d.point((center / shadows.len() as f64).normalize_or_zero());
    page.line(
        INNER,
        &format!(
            "{} shadow rays to points of the light, on average towards {towards}; {free} meet nothing",
            shadows.len()
        ),
    );
    for (object, blocked, weakened) in in_the_way {
        let mut words = Vec::new();
        if blocked > 0 {
            words.push(format!("{blocked} blocked"));
        }
        if weakened > 0 {
            words.push(format!("{weakened} weakened"));
        }
        page.line(INNER + 2, &format!("{} by {object}", words.join(", ")));
    }
    page.line(INNER, &format!("visible = the mean = {}", d.color(visible)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_diagnostic_model_says_what_it_shows() {
        let words: std::collections::BTreeSet<&str> = ShadingModel::ALL
            .into_iter()
            .filter(|(_, model)| model.is_diagnostic())
            .map(|(_, model)| diagnostic(model))
            .collect();
        assert_eq!(words.len(), 4);
    }
}
