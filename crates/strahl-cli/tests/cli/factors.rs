//! Multiplies and adds up the numbers that `explain --format json` prints.

use serde_json::Value;

type Triple = [f64; 3];

fn number(v: &Value) -> f64 {
    v.as_f64().unwrap_or_else(|| panic!("a number: {v}"))
}

fn triple(v: &Value) -> Triple {
    std::array::from_fn(|i| number(&v[i]))
}

fn list(v: &Value) -> &[Value] {
    v.as_array().map_or(&[], Vec::as_slice)
}

fn times(a: Triple, b: Triple) -> Triple {
    std::array::from_fn(|i| a[i] * b[i])
}

fn scaled(a: Triple, k: f64) -> Triple {
    a.map(|x| x * k)
}

fn plus(a: Triple, b: Triple) -> Triple {
    std::array::from_fn(|i| a[i] + b[i])
}

const NONE: Triple = [0.0; 3];
const ALL: Triple = [1.0; 3];

/// For numbers from platform functions, whose last bits may differ.
fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * (1.0 + a.abs())
}

/// Checks every factor of every ray against its product, to the last bit; returns the kinds of things it found.
pub(crate) fn check(json: &Value) -> Vec<String> {
    let mut seen = Vec::new();
    // The sum of each place, the number of its rays, and the share of the place in the mean.
    let mut means: Vec<(Value, Triple, f64, f64)> = Vec::new();
    for sample in list(&json["samples"]) {
        let rays = list(&sample["rays"]);
        if sample["lens_ray"].is_number() {
            seen.push("lens".to_owned());
        }
        for ray in rays {
            seen.push(ray["kind"].as_str().expect("a word").to_owned());
            check_ray(ray, rays, &mut seen);
        }
        // The colours of linear scenes are the totals themselves.
        if let Some(first) = rays.first() {
            assert_eq!(first["total"], sample["color"], "a linear scene");
        }
        match means.last_mut() {
            Some((position, sum, count, _)) if *position == sample["position"] => {
                *sum = plus(*sum, triple(&sample["color"]));
                *count += 1.0;
            }
            _ => {
                let share = number(&sample["share"]);
                means.push((
                    sample["position"].clone(),
                    triple(&sample["color"]),
                    1.0,
                    share,
                ));
            }
        }
    }
    let mut mean = NONE;
    for (_, sum, count, share) in &means {
        mean = plus(mean, sum.map(|x| x / count * share));
    }
    for (a, b) in mean.iter().zip(triple(&json["color"])) {
        assert!(close(*a, b), "{a} is not {b}");
    }
    seen.sort();
    seen.dedup();
    seen
}

fn check_ray(ray: &Value, rays: &[Value], seen: &mut Vec<String>) {
    let mut sum = match &ray["background"] {
        Value::Null => local(ray, seen),
        background => triple(background),
    };
    assert_eq!(sum, triple(&ray["local"]), "local of {ray:#}");
    let (mut reflected, mut transmitted) = (NONE, NONE);
    // Branches are added in reverse order.
    for child in list(&ray["children"]).iter().rev() {
        let child = &rays[child.as_u64().expect("a number") as usize];
        let (share, power) = (triple(&child["share"]), number(&child["power"]));
        let mut light = triple(&child["total"]);
        if power != 1.0 {
            light = light.map(|x| if x > 0.0 { x.powf(power) } else { 0.0 });
        }
        let taken = times(share, light);
        match child["kind"].as_str() {
            Some("reflection") => reflected = plus(reflected, taken),
            _ => transmitted = plus(transmitted, taken),
        }
        if power != 1.0 {
            seen.push("exponent".to_owned());
            return;
        }
    }
    sum = plus(plus(sum, reflected), transmitted);
    sum = times(sum, triple(&ray["attenuation"]));
    let fog = triple(&ray["fog"]);
    if fog != NONE {
        seen.push("fog".to_owned());
        sum = plus(sum, fog);
    }
    assert_eq!(sum, triple(&ray["total"]), "total of {ray:#}");
}

fn local(ray: &Value, seen: &mut Vec<String>) -> Triple {
    let hit = &ray["hit"];
    seen.push(hit["model"].as_str().expect("a model").to_owned());
    if hit["total_reflection"] == true {
        seen.push("total reflection".to_owned());
    }
    if hit.get("kd").is_none() && hit.get("layers").is_none() {
        return triple(&ray["local"]);
    }
    let ambient = times(triple(&hit["ka"]), triple(&hit["Ia"]));
    assert_eq!(ambient, triple(&hit["ka_Ia"]));
    let mut ka = NONE;
    for layer in list(&hit["layers"]) {
        check_layer(layer, seen);
        ka = plus(
            ka,
            times(triple(&layer["C"]), triple(&layer["finish"]["ambient"])),
        );
    }
    if hit.get("layers").is_some() {
        assert_eq!(ka, triple(&hit["ka"]));
    }
    let mut local = plus(ambient, triple(&hit["emission"]));
    for light in list(&ray["lights"]) {
        check_light(hit, light, seen);
        local = plus(
            local,
            plus(triple(&light["diffuse"]), triple(&light["highlight"])),
        );
    }
    let grainy = |layer: &&Value| number(&layer["finish"]["crand"]) != 0.0;
    if list(&hit["layers"]).iter().any(|layer| grainy(&layer)) {
        seen.push("crand".to_owned());
        local = local.map(|x| if x > 0.0 { x } else { 0.0 });
    }
    local
}

fn check_layer(layer: &Value, seen: &mut Vec<String>) {
    let pigment = &layer["pigment"];
    let opacity = 1.0 - number(&pigment["filter"]) - number(&pigment["transmit"]);
    let body = times(triple(&pigment["rgb"]), triple(&layer["above"]));
    let body = scaled(body, number(&layer["share"]) * opacity);
    assert_eq!(body, triple(&layer["C"]), "C of {layer:#}");
    let reflection = &layer["finish"]["reflection"];
    if let Some(rise) = layer["rise"].as_f64() {
        seen.push("reflection".to_owned());
        let (min, max) = (triple(&reflection["min"]), triple(&reflection["max"]));
        let kr: Triple = std::array::from_fn(|i| min[i] + (max[i] - min[i]) * rise);
        let film = &layer["reflection_film"];
        let kr = match film.is_null() {
            true => kr,
            false => times(kr, triple(film)),
        };
        let plain = film.is_null() || number(&reflection["exponent"]) == 1.0;
        if plain && number(&reflection["metallic"]) == 0.0 {
            assert_eq!(kr, triple(&layer["reflectance"]));
        }
    }
    if layer["fresnel"].is_number() {
        seen.push("fresnel".to_owned());
    }
}

fn check_light(hit: &Value, light: &Value, seen: &mut Vec<String>) {
    for shadow in list(&light["shadow_rays"]) {
        let mut visible = ALL;
        for met in list(&shadow["met"]) {
            visible = times(visible, triple(&met["filter"]));
            visible = times(visible, triple(&met["medium_before"]));
            let what = if met["blocks"] == true {
                "blocked"
            } else {
                "weakened"
            };
            seen.push(what.to_owned());
        }
        visible = times(visible, triple(&shadow["medium_behind"]));
        if shadow["beside_mask"] == true {
            seen.push("beside mask".to_owned());
            visible = NONE;
        }
        assert_eq!(visible, triple(&shadow["visible"]), "{shadow:#}");
    }
    let visible = triple(&light["visible"]);
    match list(&light["shadow_rays"]) {
        [] => {}
        [only] => assert_eq!(
            times(triple(&only["visible"]), triple(&light["fog"])),
            visible
        ),
        _ => seen.push("area".to_owned()),
    }
    let arriving = triple(&light["L"]);
    if light["l"].is_array() {
        assert_eq!(times(triple(&light["color_here"]), visible), arriving);
    }
    if light["mean_of_points"].is_number() {
        seen.push("area_illumination".to_owned());
        return;
    }
    let (mut diffuse, mut highlight) = (NONE, NONE);
    for (number, term) in list(&light["terms"]).iter().enumerate() {
        match hit.get("layers") {
            Some(layers) => check_finish_term(hit, &layers[number], light, term, seen),
            None => check_term(hit, light, term),
        }
        diffuse = plus(diffuse, triple(&term["diffuse"]));
        highlight = plus(highlight, triple(&term["highlight"]));
    }
    assert_eq!(diffuse, triple(&light["diffuse"]));
    assert_eq!(highlight, triple(&light["highlight"]));
}

fn check_term(hit: &Value, light: &Value, term: &Value) {
    let arriving = triple(&light["L"]);
    let cos = number(&light["n_dot_l"]).abs();
    let diffuse = scaled(times(triple(&hit["kd"]), arriving), cos);
    assert_eq!(diffuse, triple(&term["diffuse"]));
    let (cos, power) = match hit["model"].as_str() {
        Some("phong") => (&term["r_dot_v"], &term["r_dot_v_p"]),
        _ => (&term["h_dot_n"], &term["h_dot_n_p"]),
    };
    if !cos.is_number() {
        assert_eq!(triple(&term["highlight"]), NONE, "{term:#}");
        return;
    }
    let expected = number(cos).max(0.0).powf(number(&hit["p"]));
    assert!(close(expected, number(power)), "{term:#}");
    let highlight = scaled(times(triple(&hit["ks"]), arriving), number(power));
    assert_eq!(highlight, triple(&term["highlight"]));
}

fn check_finish_term(
    hit: &Value,
    layer: &Value,
    light: &Value,
    term: &Value,
    seen: &mut Vec<String>,
) {
    let finish = &layer["finish"];
    let mut arriving = triple(&light["L"]);
    if !term["film"].is_null() {
        seen.push("irid".to_owned());
        arriving = times(arriving, triple(&term["film"]));
    }
    let n_dot_l = number(&term["n_dot_l"]);
    let brilliance = match hit["terms_of"].is_null() {
        true => number(&finish["brilliance"]),
        false => 1.0,
    };
    let factor = number(&term["diffuse_factor"]);
    if n_dot_l > 0.0 {
        let expected = number(&finish["diffuse"]) * n_dot_l.powf(brilliance);
        assert!(close(expected, factor), "{expected} {term:#} {layer:#}");
    }
    let mut diffuse = scaled(times(triple(&layer["C"]), arriving), factor);
    let grain = number(&term["grain"]);
    if grain != 0.0 {
        let color = times(triple(&layer["above"]), triple(&layer["pigment"]["rgb"]));
        let loss = scaled(times(color, arriving), grain);
        diffuse = [0, 1, 2].map(|i| diffuse[i] - loss[i]);
    }
    assert_eq!(diffuse, triple(&term["diffuse"]));
    let roughness = number(&finish["roughness"]);
    for (name, exponent) in [
        ("phong", number(&finish["phong_size"])),
        ("specular", 1.0 / roughness),
    ] {
        let cos = &term[format!("{name}_cosine")];
        if cos.is_number() {
            seen.push(name.to_owned());
            let expected = number(&finish[name]) * number(cos).max(0.0).powf(exponent);
            assert!(close(expected, number(&term[name])), "{term:#} {layer:#}");
        }
    }
    let strength = number(&term["phong"]) + number(&term["specular"]);
    let highlight = times(
        triple(&layer["above"]),
        scaled(triple(&term["tint"]), strength),
    );
    let highlight = scaled(times(highlight, arriving), number(&layer["share"]));
    if light["makes_highlights"] == true {
        assert_eq!(highlight, triple(&term["highlight"]), "{term:#} {layer:#}");
    }
}
