//! The terms of a light at a hit, in words.

use super::names::{light_at, object_at};
use super::page::Page;
use super::writer::{INNER, RAY, Writer};
use strahl::math::DVec3;
use strahl::shade::{Color, ShadingModel};
use strahl::tracing::{HitReport, LayerReport, LightReport, Shading, ShadowReport, SurfaceTerm};

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
        let reason = match term.n_dot_l > 0.0 {
            true => {
                "it shows on no layer (no diffuse reflection, no highlight that a picture could show)"
            }
            false => "it is behind the surface",
        };
        page.line(INNER, &format!("{n_dot_l}: {reason}"));
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
