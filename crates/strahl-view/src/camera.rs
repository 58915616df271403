//! Cameras as text of the scene language.

use std::fmt::Write;
use strahl::math::DVec3;
use strahl::prelude::{Camera, Projection};

/// A camera in POV-Ray's language, for pictures of this ratio of width to height. Rendered with it, a scene gives the same view. `None` for
/// cameras other than perspective and orthographic ones.
pub fn camera_sdl(camera: &Camera, aspect: f64) -> Option<String> {
    let word = match camera.projection {
        Projection::Perspective => "perspective",
        Projection::Orthographic => "orthographic",
        _ => return None,
    };
    let aspect = camera.aspect.unwrap_or(aspect);
    let vector = |v: DVec3| format!("<{}, {}, {}>", v.x, v.y, v.z);
    let mut text = format!("camera {{\n  {word}\n");
    for (name, value) in [
        ("location", camera.eye),
        ("direction", camera.direction),
        ("right", camera.right * 2.0 * aspect),
        ("up", camera.up * 2.0),
    ] {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {name} {}", vector(value));
    }
    text.push_str("}\n");
    Some(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl::prelude::*;
    use strahl::{Format, LoadOptions, load_bytes};

    #[test]
    fn the_text_of_a_camera_gives_the_same_view() {
        let objects = "light_source { <4, 5, -6>, 1 } sphere { 0, 1 pigment { rgb <1, 0.5, 0> } } box { <1, 0, 1>, 2 pigment { rgb 1 } }";
        for camera in [
            Camera::perspective(DVec3::new(3.0, 2.0, -5.0), DVec3::ZERO, DVec3::Y, 0.7),
            Camera::orthographic(DVec3::new(3.0, 2.0, -5.0), DVec3::ZERO, DVec3::Y, 4.0),
        ] {
            let session = Session::new(Threads::Count(1)).unwrap();
            let picture = |text: String, camera: Option<Camera>| {
                let loaded = load_bytes(text.into(), "a.pov", Format::Pov, LoadOptions::default());
                let (scene, _) = loaded.into_scene().unwrap();
                let (scene, _) = session.compile(&scene, &CompileOptions::default()).unwrap();
                let view = scene.view(40, 30);
                let view = match camera {
                    Some(camera) => view.with_camera(camera),
                    None => view,
                };
                session
                    .picture(&view, &Output::default())
                    .unwrap()
                    .film
                    .to_srgb8()
            };
            let sdl = camera_sdl(&camera, 40.0 / 30.0).unwrap();
            let expected = picture(format!("camera {{ location 9 }} {objects}"), Some(camera));
            let found = picture(format!("{sdl} {objects}"), None);
            let different = expected
                .iter()
                .zip(&found)
                .filter(|(a, b)| a.abs_diff(**b) > 1);
            assert!(different.count() < 9, "{sdl}");
            assert!(expected.iter().any(|c| *c > 100));
        }
    }
}
