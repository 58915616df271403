//! Lights, cameras, fog and settings: their descriptions, and the messages about them.

use crate::common::{errors, parse_with};
use strahl_math::DVec3;
use strahl_scene::{CsgOp, ObjectKind, Projection, Scene, WorkingSpace};
use strahl_sdl::MemoryHost;
use strahl_shade::{Color, LightKind};

/// The scene and the messages of a text without errors.
fn scene(text: &str) -> (Scene, String) {
    let parsed = parse_with(&mut MemoryHost::new(), text);
    let messages: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
    let messages = messages.join("\n");
    (parsed.scene.expect(&messages), messages)
}

#[test]
fn a_group_of_lights_keeps_its_objects() {
    let (scene, messages) = scene(
        "light_group { light_source { y, rgb 1 } global_lights off sphere { 0, 1 } translate x }",
    );
    let [group] = &scene.objects.0[..] else {
        panic!("one group");
    };
    let ObjectKind::Csg { op, children } = &group.kind else {
        panic!("a group");
    };
    let expected = CsgOp::LightGroup {
        global_lights: false,
        outer_lights: false,
    };
    assert_eq!(*op, expected);
    assert_eq!((children.0.len(), messages.as_str()), (2, ""));
    assert!(group.transform.is_some());
}

#[test]
fn declared_groups_of_lights_take_those_of_the_group_around_them() {
    let (scene, messages) = scene(
        "#declare G = light_group { light_source { y, rgb 1 } sphere { 0, 1 } union { sphere { 0, 1 } sphere { x, 1 } } }
         #declare H = object { G }
         light_group { light_source { x, rgb 1 } H light_group { light_source { z, rgb 1 } sphere { 0, 1 } } }",
    );
    assert_eq!(messages, "");
    let mut outlines = vec![];
    let mut waiting: Vec<_> = scene.objects.0.iter().map(|object| (object, 0)).collect();
    while let Some((object, depth)) = waiting.pop() {
        if let ObjectKind::Csg { op, children } = &object.kind {
            if let CsgOp::LightGroup { outer_lights, .. } = op {
                outlines.push((depth, children.0.len(), *outer_lights));
            }
            waiting.extend(children.0.iter().rev().map(|child| (child, depth + 1)));
        }
    }
    // The union is in a group without lights, whatever the number of copies.
    assert_eq!(
        outlines,
        [(0, 3, false), (1, 3, true), (2, 1, false), (1, 2, false)]
    );
}

#[test]
fn what_is_missing_is_named_and_read_past() {
    let (scene, messages) = scene(
        "global_settings { radiosity { count 50 } photons { count 100 } hf_gray_16 on charset utf8 max_trace_level 7 }
         camera { fisheye location -z aperture 0.4 blur_samples 4, 20 focal_point 0 normal { bumps 0.2 } look_at y angle 60 }
         light_source { y, rgb 1 projected_through { sphere { 0, 1 } } media_interaction off }
         fog { distance 5 rgb 1 turbulence 0.5 turb_depth 0.3 octaves 3 }",
    );
    for word in ["radiosity", "photons", "hf_gray_16"] {
        assert!(messages.contains(word), "{word}: {messages}");
    }
    assert_eq!((scene.settings.max_depth, scene.fogs.len()), (7, 1));
    assert_eq!((scene.lights.len(), scene.groups.len()), (1, 1));
    let mask = scene.lights[0].mask.as_deref().expect("a mask");
    assert_eq!(mask.group.0, 0);
    let turbulence = scene.fogs[0].turbulence.expect("uneven");
    assert_eq!((turbulence.strength, turbulence.octaves.octaves), (0.3, 3));
    let camera = scene.camera.expect("a camera");
    let angle = 60_f64.to_radians();
    assert_eq!(camera.projection, Projection::Fisheye { angle });
    let lens = camera.lens.expect("a lens");
    assert_eq!(
        (lens.aperture, lens.min_samples, lens.max_samples),
        (0.4, 4, 20)
    );
    assert!(camera.normal.is_some());
}

#[test]
fn smooth_within_the_braces_of_a_mesh_camera_interpolates_normals() {
    // As in POV-Ray, which rejects it behind the braces.
    let smooth = |word: &str| {
        let text =
            format!("camera {{ mesh_camera {{ 1 3 mesh {{ triangle {{ 0, x, y }} }} {word} }} }}");
        match scene(&text).0.camera.unwrap().projection {
            Projection::Mesh(mesh) => mesh.smooth,
            other => panic!("{other:?} is not a mesh camera"),
        }
    };
    assert!(smooth("smooth"));
    assert!(!smooth(""));
}

#[test]
fn a_second_assumed_gamma_is_ignored_with_a_warning() {
    let text = "global_settings { assumed_gamma 1 } global_settings { assumed_gamma 2.2 }";
    let (scene, messages) = scene(text);
    assert_eq!(scene.settings.working_space, WorkingSpace::Linear);
    assert!(messages.contains("the first one counts"), "{messages}");
}

#[test]
fn versions_decide_what_numbers_mean() {
    let space = |text: &str| scene(text).0.settings.working_space;
    assert_eq!(space("#version 3.7;"), WorkingSpace::Linear);
    assert_eq!(space("#version 3.6;"), WorkingSpace::Srgb);
    assert_eq!(space(""), WorkingSpace::Srgb);
    assert_eq!(
        space("#version 3.6; global_settings { assumed_gamma 1 }"),
        WorkingSpace::Linear
    );
    let (scene, messages) = scene("#version 3.7; global_settings { assumed_gamma 2.2 }");
    assert_eq!(scene.settings.working_space, WorkingSpace::Gamma(2.2));
    assert_eq!(messages, "");
    assert_eq!(scene.ambient, Some(Color::WHITE));
}

#[test]
fn a_picture_that_is_not_to_be_gray_is_no_matter() {
    let (_, messages) = scene("global_settings { assumed_gamma 1 hf_gray_16 off }");
    assert!(!messages.contains("hf_gray_16"), "{messages}");
    let (_, messages) = scene("global_settings { assumed_gamma 1 hf_gray_16 }");
    assert!(messages.contains("hf_gray_16 has no effect"), "{messages}");
}

#[test]
fn a_max_trace_level_above_256_is_256() {
    let (deep, messages) = scene("global_settings { max_trace_level 300 }");
    assert_eq!(deep.settings.max_depth, 256);
    assert!(messages.contains("at most 256"), "{messages}");
}

#[test]
fn wrong_numbers_are_errors() {
    for (text, message) in [
        ("global_settings { max_trace_level 0 }", "1 to 256"),
        ("global_settings { assumed_gamma 0 }", "must be positive"),
        ("camera { angle 200 }", "between 0 and 180"),
        ("camera { right 0 }", "sees nothing"),
        ("camera { fisheye angle 0 }", "must be positive"),
        ("camera { cylinder 5 }", "1, 2, 3 or 4"),
        ("camera { mesh_camera { 1 4 } }", "0, 1, 2 or 3"),
        ("camera { mesh_camera { 1 0 sphere { 0, 1 } } }", "no faces"),
        ("fog { fog_type 3 }", "fog_type must be 1"),
        (
            "light_source { 0, 1 area_light x, y, 0, 5 }",
            "1 to 1024 points",
        ),
    ] {
        let errors = errors(text);
        assert!(
            errors.iter().any(|e| e.contains(message)),
            "{text}: {errors:?}"
        );
    }
}

#[test]
fn the_last_of_spotlight_cylinder_and_shadowless_counts() {
    let light = |items: &str| {
        let (scene, messages) = scene(&format!("light_source {{ y, rgb 1 {items} }}"));
        assert_eq!(messages, "");
        scene.lights[0].light
    };
    let late = light("spotlight point_at 0 radius 5 shadowless");
    assert!(matches!(late.kind, LightKind::Point { .. }) && !late.casts_shadows);
    let early = light("shadowless cylinder point_at 0");
    assert!(matches!(early.kind, LightKind::Beam { .. }) && early.casts_shadows);
    let parallel = light("parallel point_at 0 shadowless");
    assert!(matches!(parallel.kind, LightKind::Parallel { .. }) && !parallel.casts_shadows);
}

#[test]
fn a_light_that_points_at_itself_shines_everywhere() {
    let (scene, messages) = scene("light_source { y, rgb 1 spotlight point_at y }");
    assert!(matches!(
        scene.lights[0].light.kind,
        LightKind::Point { .. }
    ));
    assert!(messages.contains("points at its own location"));
}

#[test]
fn a_scene_without_camera_is_seen_from_the_origin() {
    let camera = scene("sphere { 0, 1 }").0.camera.expect("a camera");
    assert_eq!((camera.eye, camera.direction), (DVec3::ZERO, DVec3::Z));
    assert_eq!(
        (camera.right, camera.up),
        (DVec3::X * 0.665, DVec3::Y * 0.5)
    );
}
