//! A sphereflake whose generations are instances within instances, against the same one with a sphere for every ball.

use std::path::Path;
use strahl::prelude::Scene;
use strahl::shade::srgb;
use strahl::tracing::{CompileOptions, RenderOptions};
use strahl::{Format, LoadOptions, load_bytes};

/// The generations.
const LAST: u32 = 4;

/// The head of both scenes: without a surface that mirrors, so that rounding is not multiplied.
const HEAD: &str = "#version 3.7; global_settings { assumed_gamma 1 }
    camera { location <0.2, 3.2, -5.6> right x*4/3 angle 41 look_at <0, 0.1, 0> }
    light_source { <-6, 9, -5>, rgb 1.2 } background { srgb <0.3, 0.35, 0.45> }
    #macro Around(Child)
      #for (I, 0, 5) object { Child scale 1/3 translate 4/3*y rotate 90*x rotate (60*I + 30)*y } #end
      #for (I, 0, 2) object { Child scale 1/3 translate 4/3*y rotate 35.26*x rotate (120*I)*y } #end
    #end\n";

fn read(text: &str) -> Scene {
    let text = format!(
        "{HEAD}{text} object {{ Flake pigment {{ srgb <0.9, 0.7, 0.4> }} finish {{ ambient 0.1 diffuse 0.6 }} }}"
    );
    let options = LoadOptions::default();
    let loaded = load_bytes(text.into_bytes(), "flake.pov", Format::Pov, options);
    assert!(loaded.diagnostics.is_empty(), "{:?}", loaded.diagnostics);
    loaded.scene.expect("a scene")
}

/// 8-bit codes.
fn picture(scene: &Scene) -> Vec<u8> {
    let scene = strahl::compile(scene, &CompileOptions::default()).expect("valid");
    let options = RenderOptions::new(&scene, 128, 96);
    let film = strahl::render(&scene, &options).expect("a picture");
    let values = film.film.pixels.iter().flatten();
    values
        .map(|v| (srgb::encode(f64::from(*v).clamp(0.0, 1.0)) * 255.0).round() as u8)
        .collect()
}

#[test]
fn a_flake_of_nested_instances_is_stored_small_and_looks_as_if_written_out() {
    let nested = read(&format!(
        "#declare Flake = sphere {{ 0, 1 }}
         #for (G, 1, {LAST}) #declare Flake = union {{ sphere {{ 0, 1 }} Around(Flake) }} #end"
    ));
    // A macro writes every ball anew.
    let flat = read(&format!(
        "#macro Grown(N)
           #if (N = 0) sphere {{ 0, 1 }} #else
             union {{
               sphere {{ 0, 1 }}
               #for (I, 0, 5) object {{ Grown(N - 1) scale 1/3 translate 4/3*y rotate 90*x rotate (60*I + 30)*y }} #end
               #for (I, 0, 2) object {{ Grown(N - 1) scale 1/3 translate 4/3*y rotate 35.26*x rotate (120*I)*y }} #end
             }}
           #end
         #end
         #declare Flake = Grown({LAST})"
    ));
    let size = |scene: &Scene| format!("{scene:?}").len();
    // One generation less, because the smaller ones are copied into its group.
    assert!(
        size(&nested) * 8 < size(&flat),
        "{} {}",
        size(&nested),
        size(&flat)
    );
    let (nested, flat) = (picture(&nested), picture(&flat));
    let lit = flat.iter().filter(|code| **code > 200).count();
    assert!(lit > 300, "{lit}");
    assert!(nested == flat, "the pictures differ");
}

/// The scene of the showcase, with all of its ten generations: 1 + 9 + ... + 9^10 balls. Measured: 1.9 MB compiled, most of it
/// for the balls of the last five generations, which are one group, and 27 MB for the whole program that renders it.
#[test]
fn a_flake_of_billions_of_balls_is_compiled_in_two_megabytes() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/showcase/billions.pov");
    let loaded = strahl::load_path(&path, LoadOptions::default());
    assert!(loaded.diagnostics.is_empty(), "{:?}", loaded.diagnostics);
    let scene = loaded.scene.expect("a scene");
    let scene = strahl::compile(&scene, &CompileOptions::default()).expect("valid");
    let balls = (9_u64.pow(11) - 1) / 8;
    assert!(balls > 1_000_000_000);
    let stats = scene.stats();
    assert_eq!(stats.elements, balls);
    let bytes = stats.accelerator_bytes + stats.geometry_bytes + stats.object_bytes;
    assert!(bytes < 1 << 21, "{bytes}: {stats:?}");
    let film = strahl::render(&scene, &RenderOptions::new(&scene, 32, 24)).expect("a picture");
    let hits = film.rays.primary_hit;
    assert!(hits > 32 * 24 / 2, "{hits}");
    // With the other test of this program, which writes its balls out.
    if let Some(peak) = peak_memory() {
        assert!(peak < 1 << 30, "{peak}");
    }
}

/// Peak memory of this process so far, in bytes; `None` where the system does not report it.
fn peak_memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes << 10)
}
