//! Means over pixels in scenes whose colours are not linear, and what POV-Ray 3.7 makes of the same.

mod common;

use common::parse_with;
use strahl_render::{CompileOptions, Region, RenderOptions, Sampling, compile, render};
use strahl_sdl::MemoryHost;
use strahl_shade::srgb;

/// One pixel of a picture of 160x120, as PNG files hold it: 8-bit codes, not multiplied by alpha, and alpha.
fn pixel(text: &str, at: (u32, u32), sampling: &str, alpha: bool) -> [u8; 4] {
    let scene = parse_with(&mut MemoryHost::new(), text).scene;
    let scene = compile(&scene.expect("a scene"), &CompileOptions::default()).expect("compiles");
    let mut options = RenderOptions::new(&scene, 160, 120);
    options.threads = 1;
    options.sampling = sampling.parse::<Sampling>().expect("a sampling");
    options.alpha = alpha;
    let (x, y) = at;
    let (width, height) = (1, 1);
    options.region = Some(Region {
        x,
        y,
        width,
        height,
    });
    let film = render(&scene, &options, &()).expect("a picture").film;
    let alpha = film.alpha.map_or(1.0, |alpha| alpha[0]);
    let [r, g, b] = film.pixels[0].map(|c| srgb::encode_u8(c / alpha));
    [r, g, b, (alpha * 255.0).round() as u8]
}

/// A scene of two greys, with a vertical edge within column 80.
fn edge(settings: &str, left: f64, right: f64) -> String {
    format!(
        "{settings}
         camera {{ orthographic location -z look_at 0 right 4*x up 3*y }}
         plane {{ z, 0 pigment {{ gradient x color_map {{ [0.5 rgb {right}] [0.5 rgb {left}] }} scale 4 translate 0.005*x }}
                 finish {{ emission 1 ambient 0 diffuse 0 }} }}"
    )
}

const GAMMA: &str = "#version 3.7; global_settings { assumed_gamma 2.2 }";
const LINEAR: &str = "#version 3.7; global_settings { assumed_gamma 1 }";

#[test]
fn means_are_those_of_the_scenes_colours() {
    let shade = |settings, sampling| pixel(&edge(settings, 0.9, 0.1), (80, 60), sampling, false)[0];
    // By POV-Ray, with +A0.05 +AM2 +R5.
    assert_eq!(shade(GAMMA, "recursive:0.05,5"), 68);
    assert_eq!(shade(LINEAR, "recursive:0.05,5"), 143);
    // The same share of the pixel, by other ways of sampling.
    assert!(shade(GAMMA, "adaptive:0.05,9").abs_diff(68) < 6);
    assert!(shade(GAMMA, "9x9").abs_diff(68) < 6);
    assert!(shade("", "9x9").abs_diff(68) < 6);
}

#[test]
fn pixels_are_compared_in_linear_light() {
    // By POV-Ray, with +AM2 +R5 and +AM1 +R9 and these thresholds.
    for (threshold, recursive, adaptive) in [(0.12, 131, 131), (0.15, 135, 128)] {
        let shade = |sampling: &str| pixel(&edge(GAMMA, 0.55, 0.5), (80, 60), sampling, false)[0];
        assert_eq!(shade(&format!("recursive:{threshold},5")), recursive);
        assert_eq!(shade(&format!("adaptive:{threshold},9")), adaptive);
    }
}

#[test]
fn what_is_half_covered_keeps_its_colour() {
    let ball = |colour: &str| {
        format!(
            "{GAMMA} background {{ rgbt 1 }} camera {{ orthographic location -z look_at 0 right 4*x up 3*y }}
             sphere {{ <1, 0, 0>, 0.9 pigment {{ {colour} }} finish {{ emission 1 ambient 0 diffuse 0 }} }}"
        )
    };
    // By POV-Ray, with +UA.
    let glass = "rgbt <0.9, 0.5, 0.2, 0.5>";
    assert_eq!(
        pixel(&ball(glass), (120, 41), "center", true),
        [230, 128, 48, 191]
    );
}
