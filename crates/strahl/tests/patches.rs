//! A hundred thousand bicubic patches.
//!
//! It is a test program of its own with a single test, because it measures the memory of the whole process.

use strahl::tracing::{CompileOptions, RenderOptions};
use strahl::{Format, LoadOptions, load_bytes};

/// A carpet of gentle waves: neighbours share the points of their borders.
const SCENE: &str = "#version 3.7; global_settings { assumed_gamma 1 }
    camera { location <0, 40, -60> look_at 0 }
    light_source { <0, 90, -90>, 1 }
    #for (A, 0, 399) #for (B, 0, 249)
      bicubic_patch {
        type 1 flatness 0 u_steps 3 v_steps 3
        #for (J, 0, 3) #for (I, 0, 3) <A - 200 + I/3, 0.3 * sin(0.2 * (3 * A + I + 3 * B + J)), B - 125 + J/3> #end #end
        pigment { rgb 1 }
      }
    #end #end";

/// Peak memory of this process so far, in bytes; `None` where the system does not report it.
fn peak_memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes << 10)
}

/// Measured: 192 MB for the whole process, the text and the description included; and 251 bytes for each patch in the scene's own account,
/// which leaves out the control points.
#[test]
fn a_hundred_thousand_patches_take_a_few_hundred_megabytes() {
    let options = LoadOptions::default();
    let loaded = load_bytes(SCENE.into(), "carpet.pov", Format::Pov, options);
    assert!(loaded.diagnostics.is_empty(), "{:?}", loaded.diagnostics);
    let scene = loaded.scene.expect("a scene");
    let scene = strahl::compile(&scene, &CompileOptions::default()).expect("valid");
    let stats = scene.stats();
    assert_eq!((stats.objects, stats.elements), (100_000, 100_000));
    let bytes = stats.accelerator_bytes + stats.geometry_bytes + stats.object_bytes;
    assert!(bytes < 300 * 100_000, "{stats:?}");
    let film = strahl::render(&scene, &RenderOptions::new(&scene, 32, 24)).expect("a picture");
    // The lower part of the picture is carpet.
    let seen = |row: usize| {
        film.film.pixels[row * 32..][..32]
            .iter()
            .filter(|p| p[1] > 0.0)
            .count()
    };
    let rows: Vec<usize> = (0..24).map(seen).collect();
    assert!(rows[12..].iter().all(|seen| *seen == 32), "{rows:?}");
    if let Some(peak) = peak_memory() {
        assert!(peak < 384 << 20, "{peak}");
    }
}
