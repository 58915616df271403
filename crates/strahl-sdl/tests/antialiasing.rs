//! Means over pixels in scenes whose colours are not linear, and what POV-Ray 3.7 makes of the same.

use crate::common::parse_with;
use strahl_render::{CompileOptions, Film, Region, RenderOptions, Sampling, compile, render};
use strahl_sdl::MemoryHost;
use strahl_shade::srgb;

/// A picture of 160x120, or a part of it.
fn film(text: &str, region: Option<Region>, sampling: &str, alpha: bool) -> Film {
    let scene = parse_with(&mut MemoryHost::new(), text).scene;
    let scene = compile(&scene.expect("a scene"), &CompileOptions::default()).expect("compiles");
    let mut options = RenderOptions::new(&scene, 160, 120);
    options.threads = 1;
    options.sampling = sampling.parse::<Sampling>().expect("a sampling");
    options.alpha = alpha;
    options.region = region;
    render(&scene, &options).expect("a picture").film
}

/// One pixel of a picture of 160x120, as PNG files hold it: 8-bit codes, not multiplied by alpha, and alpha.
fn pixel(text: &str, (x, y): (u32, u32), sampling: &str, alpha: bool) -> [u8; 4] {
    let (width, height) = (1, 1);
    let region = Region {
        x,
        y,
        width,
        height,
    };
    let film = film(text, Some(region), sampling, alpha);
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

/// Bright lines, a third of a pixel wide, which rise by a pixel in twenty. The centre of every third pixel or so along a line meets it.
fn lines() -> String {
    format!(
        "{LINEAR}
         camera {{ orthographic location -z look_at 0 right 160*x up 120*y }}
         plane {{ z, 0 pigment {{ gradient y color_map {{ [1/60 rgb 1] [1/60 rgb 0.05] }} scale 20 matrix <1, 0.05, 0, 0, 1, 0, 0, 0, 1, 0, 0.4, 0> }}
                 finish {{ emission 1 ambient 0 diffuse 0 }} }}"
    )
}

#[test]
fn thin_lines_have_no_gaps() {
    let film = film(&lines(), None, "adaptive:0.3,3", false);
    // The light of the lines in each column: six of them, a third of a pixel each.
    let (mut gaps, mut sum) = (0, 0.0);
    for x in 0..160 {
        let column = (0..120).map(|y| f64::from(film.pixels[y * 160 + x][0]) - 0.05);
        let light: f64 = column.sum::<f64>() / (6.0 * 0.95 / 3.0);
        gaps += u32::from(light < 0.7);
        sum += light;
    }
    assert!(gaps < 5 && (sum / 160.0 - 1.0).abs() < 0.05, "{gaps} {sum}");
}

#[test]
fn a_part_of_a_picture_has_the_pixels_of_the_picture() {
    let whole = film(&lines(), None, "adaptive:0.3,3", false);
    for (x, y, width, height) in [(37, 21, 50, 40), (64, 32, 32, 64), (95, 70, 1, 1)] {
        let region = Region {
            x,
            y,
            width,
            height,
        };
        let part = film(&lines(), Some(region), "adaptive:0.3,3", false);
        for row in 0..height {
            let at = |x: u32, y: u32, width: u32| (y * width + x) as usize;
            let (start, own) = (at(x, y + row, 160), at(0, row, width));
            let end = width as usize;
            assert_eq!(
                part.pixels[own..own + end],
                whole.pixels[start..start + end]
            );
        }
    }
}
