//! Reduced quality: one pixel of small scenes with the values that POV-Ray 3.7 gives it at each level, and pictures of both programs.

use crate::common::parse_with;
use crate::common::pictures::agree_at;
use strahl_render::{CompileOptions, RayKind, RenderOptions, compile, explain, render};
use strahl_sdl::MemoryHost;
use strahl_shade::Quality;

/// Case, the values of POV-Ray 3.7.0.10 (linear red, green and blue) at some levels, and the scene.
const CASES: &str = include_str!("data/quality.tsv");

fn shown(text: &str, level: u8) -> [f64; 3] {
    let parsed = parse_with(&mut MemoryHost::new(), text);
    let mut scene = parsed
        .scene
        .unwrap_or_else(|| panic!("{text}: {:?}", parsed.diagnostics));
    scene.settings.quality = Quality::new(level);
    let scene = compile(&scene, &CompileOptions::default()).expect("a valid scene");
    let mut options = RenderOptions::new(&scene, 1, 1);
    options.threads = 1;
    let film = render(&scene, &options).expect("a picture").film;
    let tree = explain(&scene, &options, 0, 0).expect("a pixel");
    let told = tree.samples[0].color.to_array();
    let pixel = film.pixels[0].map(f64::from);
    for (a, b) in pixel.iter().zip(told) {
        assert!((a - b).abs() < 1e-6, "{text}: {pixel:?} is not {told:?}");
    }
    if level < 6 {
        let nodes = &tree.samples[0].tree.nodes;
        assert!(
            nodes
                .iter()
                .all(|node| node.report.kind == RayKind::Primary)
        );
    }
    pixel.map(|c| c.clamp(0.0, 1.0))
}

#[test]
fn pixels_are_those_of_povray_at_all_levels() {
    let mut rows = CASES.lines().map(|row| row.split('\t').collect::<Vec<_>>());
    let header = rows.next().expect("a header");
    let levels: Vec<u8> = header[1..header.len() - 1]
        .iter()
        .map(|level| level.parse().expect("a level"))
        .collect();
    let mut wrong = vec![];
    for row in rows {
        let (name, text) = (row[0], row[row.len() - 1]);
        for level in 0..=9 {
            let column = levels.iter().rposition(|l| *l <= level).expect("level 0");
            let theirs = row[1 + column]
                .split(' ')
                .map(|c| c.parse::<f64>().expect("a number"));
            let ours = shown(text, level);
            if ours.iter().zip(theirs).any(|(a, b)| (a - b).abs() > 1e-3) {
                wrong.push(format!(
                    "{name}, {level}: {ours:.4?} is not {}",
                    row[1 + column]
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Objects of many kinds under several lights.
const MANY: &str = "
#version 3.7; global_settings { assumed_gamma 1 }
camera { location <0, 3, -8> look_at <0, 0.6, 0> angle 40 }
light_source { <-6, 9, -7>, <1, 0.9, 0.8> * 0.7 area_light 3*x, 3*z, 4, 4 }
light_source { <8, 6, -3>, <0.3, 0.4, 0.6> spotlight radius 12 falloff 20 point_at 0 }
sky_sphere { pigment { gradient y color_map { [0 rgb <0.8, 0.9, 1>] [1 rgb <0.2, 0.4, 0.9>] } } }
fog { fog_type 2 distance 40 fog_offset 0 fog_alt 1 rgb <0.8, 0.8, 0.9> }
plane { y, 0 pigment { checker rgb <0.9, 0.9, 0.7> rgb <0.3, 0.4, 0.3> quick_color rgb <0.5, 0.5, 0.4> } finish { reflection 0.2 } normal { bumps 0.3 scale 0.3 } }
sphere { <-1.7, 1, 0>, 1 pigment { rgbf <1, 0.9, 0.8, 0.9> } finish { diffuse 0.2 reflection 0.1 specular 0.6 } interior { ior 1.4 fade_distance 2 fade_power 1 } }
difference {
  box { <-0.6, 0, -0.6>, <0.6, 1.2, 0.6> texture { granite texture_map { [0.3 pigment { rgb <0.7, 0.2, 0.1> }] [0.6 pigment { marble quick_color rgb <0.9, 0.6, 0.1> } normal { dents 2 scale 0.2 }] } scale 0.4 } }
  cylinder { -2*z, 2*z, 0.35 translate 0.7*y texture { pigment { rgb <0.1, 0.4, 0.7> } } texture { pigment { radial frequency 8 color_map { [0.5 rgbt 1] [0.5 rgb 1] } rotate 90*x } } }
  rotate 25*y translate <0.4, 0, 0.5>
}
torus { 0.5, 0.2 rotate 60*x translate <2, 0.9, 0.2> pigment { rgb <0.8, 0.7, 0.2> } finish { ambient 0.1 diffuse 0.4 metallic phong 0.8 reflection { 0.1, 0.6 falloff 2 } } }
";

#[test]
fn pictures_are_those_of_povray_at_all_levels() {
    for level in 0..=9 {
        agree_at(level, 0.02, &[("many objects", MANY.to_owned())]);
    }
}
