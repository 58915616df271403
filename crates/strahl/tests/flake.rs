//! A sphereflake whose generations are instances within instances, against the same one with a sphere for every ball.

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
    assert!(
        size(&nested) * 20 < size(&flat),
        "{} {}",
        size(&nested),
        size(&flat)
    );
    let (nested, flat) = (picture(&nested), picture(&flat));
    let lit = flat.iter().filter(|code| **code > 200).count();
    assert!(lit > 300, "{lit}");
    assert!(nested == flat, "the pictures differ");
}
