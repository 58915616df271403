//! The terms of the shading model at a hit, in words.

use super::page::Page;
use super::tally::plural;
use super::writer::{INNER, RAY, Writer};
use strahl::shade::pov_finish::PovFinish;
use strahl::shade::{Color, ShadingModel};
use strahl::tracing::{HitReport, LayerReport, Shading};

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
    let quality = w.scene.settings().quality;
    if !quality.has_reflection() {
        let rest = match layer.finish.conserve_energy {
            true => "kr only weakens kt (conserve_energy)",
            false => "kr = 0",
        };
        return format!("no reflection at quality {quality}: {rest}");
    }
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
