//! Lights as text of the scene language.

use std::fmt::Write;
use strahl::math::{DVec3, det};
use strahl::scene::SceneLight;
use strahl::shade::{Falloff, Light, LightKind};

/// A light in POV-Ray's language. Rendered with it, a scene is lit in the same way, up to rounding. What the language has no words for is named in a
/// comment. `None` for a light that has no position.
pub fn light_sdl(described: &SceneLight) -> Option<String> {
    let light = &described.light;
    let (position, form) = form(light)?;
    let mut text = format!(
        "light_source {{\n  {}\n  rgb {}\n",
        vector(position),
        vector(DVec3::new(light.color.r, light.color.g, light.color.b))
    );
    let mut line = |item: String| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {item}");
    };
    form.into_iter().for_each(&mut line);
    match light.falloff {
        Falloff::None => {}
        Falloff::Fade { distance, power } => {
            line(format!("fade_distance {distance} fade_power {power}"));
        }
        Falloff::InverseSquare => {
            line("// its strength is divided by the square of the distance".into())
        }
        Falloff::Polynomial([a, b, c]) => line(format!(
            "// its strength is divided by {a} + {b} d + {c} d^2 at the distance d"
        )),
    }
    if let Some(area) = &light.area {
        let (one, two) = (vector(area.axis_1), vector(area.axis_2));
        line(format!(
            "area_light {one}, {two}, {}, {}",
            area.size_1, area.size_2
        ));
        if let Some(level) = area.adaptive {
            line(format!("adaptive {level}"));
        }
        for (is_on, word) in [
            (area.jitter, "jitter"),
            (area.circular, "circular"),
            (area.orient, "orient"),
            (area.illumination, "area_illumination on"),
        ] {
            if is_on {
                line(word.into());
            }
        }
    }
    if light.fogged {
        line("media_attenuation on".into());
    }
    if !light.casts_shadows {
        line("shadowless".into());
    }
    if described.mask.is_some() {
        line("// the object that it is projected_through stays as in the scene".into());
    }
    text.push_str("}\n");
    Some(text)
}

/// The position of a light, and the words for its form.
fn form(light: &Light) -> Option<(DVec3, Vec<String>)> {
    let reach = light.area.map_or(1.0, |area| area.reach);
    let at = |position: DVec3, direction: DVec3| {
        format!("point_at {}", vector(position + direction * reach))
    };
    let degrees = |cosine: f64| det::acos(cosine.clamp(-1.0, 1.0)).to_degrees();
    Some(match light.kind {
        LightKind::Point { position } => (position, vec![]),
        LightKind::Parallel {
            position,
            direction,
        } => (position, vec!["parallel".into(), at(position, direction)]),
        LightKind::Spot {
            position,
            direction,
            cos_inner,
            cos_outer,
            tightness,
        } => (
            position,
            vec![
                "spotlight".into(),
                at(position, direction),
                format!(
                    "radius {} falloff {}",
                    degrees(cos_inner),
                    degrees(cos_outer)
                ),
                format!("tightness {tightness}"),
            ],
        ),
        // Light that fills the half-space before its plane.
        LightKind::Beam {
            position,
            direction,
            inner,
            ..
        } if inner.is_infinite() => (
            position,
            vec![
                "spotlight".into(),
                "parallel".into(),
                at(position, direction),
            ],
        ),
        LightKind::Beam {
            position,
            direction,
            inner,
            outer,
            tightness,
        } => (
            position,
            vec![
                "cylinder".into(),
                at(position, direction),
                format!("radius {inner} falloff {outer}"),
                format!("tightness {tightness}"),
            ],
        ),
        _ => return None,
    })
}

fn vector(v: DVec3) -> String {
    format!("<{}, {}, {}>", v.x, v.y, v.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl::prelude::*;
    use strahl::{Format, LoadOptions, load_bytes};

    #[test]
    fn the_text_of_a_light_gives_the_same_light() {
        let session = Session::new(Threads::Count(1)).unwrap();
        let scene = |light: &str| {
            let text = format!(
                "camera {{ location <0, 3, -6> look_at 0 }} sphere {{ 0, 1 pigment {{ rgb <1, 0.5, 0> }} }} plane {{ y, -1 pigment {{ rgb 1 }} }} {light}"
            );
            let loaded = load_bytes(text.into(), "a.pov", Format::Pov, LoadOptions::default());
            loaded.into_scene().unwrap().0
        };
        let picture = |scene: &Scene| {
            let (scene, _) = session.compile(scene, &CompileOptions::default()).unwrap();
            let picture = session.picture(&scene.view(40, 30), &Output::default());
            picture.unwrap().film.to_srgb8()
        };
        for light in [
            "light_source { <4, 5, -6>, rgb <1, 0.9, 0.8> fade_distance 3 fade_power 2 }",
            "light_source { <4, 5, -6>, 1 shadowless }",
            "light_source { <0, 5, -2>, 1 spotlight point_at <0.3, 0, 0> radius 11 falloff 17 tightness 3 }",
            "light_source { <0, 5, -2>, 1 cylinder point_at <0.3, 0, 0> radius 0.4 falloff 1.2 tightness 1 }",
            "light_source { <0, 5, -2>, 1 parallel point_at <1, 0, 0> }",
            "light_source { <0, 5, -2>, 1 spotlight parallel point_at <1, 0, 0> }",
            "light_source { <4, 5, -6>, 1 area_light x, z, 4, 3 adaptive 1 circular orient }",
            "light_source { <4, 5, -6>, 1 parallel point_at <0.5, 0, 0> area_light x, z, 4, 3 area_illumination on media_attenuation on rotate 20*y }",
        ] {
            let first = scene(light);
            let text = light_sdl(&first.lights[0]).unwrap();
            let second = scene(&text);
            let (a, b) = (picture(&first), picture(&second));
            assert!(a.iter().zip(&b).all(|(a, b)| a.abs_diff(*b) <= 1), "{text}");
            assert!(a.iter().any(|code| *code > 60), "{light}");
            let again = light_sdl(&second.lights[0]).unwrap();
            assert_eq!(text.lines().count(), again.lines().count(), "{text}{again}");
        }
    }

    #[test]
    fn what_has_no_words_is_a_comment_and_a_light_without_position_has_no_text() {
        let light = |light: Light| SceneLight {
            light,
            mask: None,
            name: None,
            span: strahl::scene::Span::NONE,
        };
        let point = Light::point(DVec3::ONE, Color::WHITE);
        let text = light_sdl(&light(point.with_falloff(Falloff::InverseSquare))).unwrap();
        assert!(text.contains("// its strength"), "{text}");
        let sun = Light::directional(DVec3::NEG_Y, Color::WHITE);
        assert!(light_sdl(&light(sun)).is_none());
    }
}
