//! Pigments compared with POV-Ray's.

use super::{PICTURE, color_at, textures};
use crate::common::tool;
use std::process::Command;
use strahl_math::DVec3;

/// Pigments whose values agree with POV-Ray's to the precision of its colours.
const PIGMENTS: &[&str] = &[
    "rgb <0.1, 0.2, 0.3>",
    "color red 0.5 green 0.25 filter 0.125 transmit 0.5",
    "rgbft 0.3",
    "agate",
    "agate agate_turb 0.3 color_map { [0 rgb 0] [1 rgb 1] }",
    "bozo",
    "bozo noise_generator 1",
    "bozo noise_generator 3 turbulence 0.4",
    "bozo turbulence <0.1, 0.5, 0> octaves 3 omega 0.7 lambda 3",
    "bumps color_map { [0.3 rgb x] [0.6 rgb y] }",
    "boxed",
    "brick",
    "brick rgb x, rgb y brick_size <2, 1, 1> mortar 0.15 scale 0.3",
    "cells scale 0.4",
    "checker",
    "checker rgb x rgb y scale 0.3",
    "checker pigment { gradient x } pigment { granite scale 2 } translate 0.2",
    "checker rgb x",
    "crackle",
    "crackle form <1, 0.5, 0> metric 1 offset 0.1 scale 0.5",
    "crackle solid",
    "cubic",
    "cubic rgb x rgb y rgb z rgb 1 rgb 0.5 rgb 0.2",
    "cylindrical",
    "dents",
    "gradient x + y",
    "gradient <1, 2, 3> color_map { [0 0.5 color rgb 0 color rgb x] [0.5 1 color rgb y color rgb z] }",
    "gradient y color_map { [0.2 rgb 0] [0.2 rgb x] [0.2 rgb y] [0.7 rgb 1] }",
    "gradient z frequency 3 phase 0.2 sine_wave",
    "gradient z triangle_wave",
    "gradient z frequency 0 phase 0.3",
    "marble frequency 0 sine_wave",
    "quilted phase 0.3",
    "quilted frequency 2 phase 0.3",
    "gradient z scallop_wave",
    "gradient z cubic_wave",
    "gradient z poly_wave 2.5",
    "gradient x pigment_map { [0.2 rgb x] [0.5 wood scale 0.2] [0.8 Declared rotate 20*z] }",
    "gradient x scale 2 rotate <10, 20, 30> translate <1, 2, 3>",
    "gradient x matrix <1, 0.5, 0, 0, 1, 0, 0, 0.2, 2, 0.1, 0, 0>",
    "gradient x color_map { Map }",
    "granite color_map { [0 rgbt <1, 0, 0, 0.5>] [1 rgbf <0, 1, 0, 0.25>] }",
    "hexagon scale 0.5",
    "hexagon rgb x rgb y rgb z",
    "julia <0.353, 0.288>, 30 interior 1, 1",
    "leopard scale 0.2",
    "magnet 1 mandel 20",
    "magnet 2 julia <0.5, 0.2>, 15 exterior 2, 0.5",
    "mandel 25",
    "mandel 25 exponent 3 exterior 1, 1 interior 4, 0.5",
    "marble",
    "marble turbulence 0.7 color_map { [0 rgb 1] [0.8 rgb 0] [1 rgb x] }",
    "onion",
    "planar",
    "quilted control0 0.3 control1 0.8",
    "radial",
    "radial frequency 6 color_map { [0.5 rgb x] [0.5 rgb y] }",
    "ripples",
    "ripples frequency 2",
    "spherical scale 3",
    "spiral1 3",
    "spiral2 2 turbulence 0.1",
    "spotted turbulence 0.3",
    "square",
    "triangular scale 0.7",
    "waves",
    "wood turbulence 0.2",
    "wrinkles scale 0.4",
    "average pigment_map { [1 rgb x] [2 marble] [0.5 granite scale 0.3] }",
    "pigment_pattern { bozo scale 0.3 } color_map { [0 rgb z] [1 rgb x] }",
    "function { x * y + sin(z) } color_map { [0 rgb 0] [1 rgb <1, 0.5, 0.2>] }",
    "object { sphere { 0, 0.9 } rgb x, rgb y }",
    "Declared",
    "Declared color_map { [0 rgb y] [1 rgb z] }",
    "Declared scale 0.3",
    "Declared gradient x",
    "Mapped gradient x",
    "Mapped agate",
    "Mapped checker",
    "Mixed onion",
    "Plain radial",
    "image_map { function 5, 4 { 3 * x - 1.2 } }",
    "image_map { function 5, 4 { pigment { gradient x color_map { [0 rgb 0.5] [1 rgb <1.5, -0.3, 3>] } } } }",
    "Colors[1]",
    "Pigments[0] translate x",
    "checker rgb x rgb y warp { repeat x offset <0, 0.3, 0> flip y } scale 0.4",
    "gradient y warp { black_hole <0.2, 0.3, 0.1>, 1.5 strength 1.2 falloff 1.5 }",
    "gradient y warp { black_hole <0.4, 0.5, 0.5>, 0.4 inverse repeat <1, 1, 1> }",
    "gradient y warp { turbulence 0.4 octaves 4 } rotate 30 * x",
    "checker rgb x rgb y scale 0.2 warp { spherical orientation y dist_exp 1 }",
    "checker rgb x rgb y scale 0.2 warp { cylindrical }",
    "checker rgb x rgb y scale 0.2 warp { toroidal major_radius 0.5 }",
    "gradient x warp { planar y, 0.3 }",
    "bozo color_map { Map } quick_color rgb 1",
    "image_map { ppm \"p.ppm\" }",
    "image_map { ppm \"p.ppm\" map_type 1 interpolate 2 filter all 0.25 }",
    "image_map { ppm \"p.ppm\" map_type 2 once transmit all 0.5 }",
    "image_map { ppm \"p.ppm\" interpolate 4 } scale 0.7 rotate 20 * y",
    "image_pattern { ppm \"p.ppm\" interpolate 2 } color_map { [0 rgb 0] [1 rgb 1] }",
    "image_map { function 5, 4 { pigment { checker rgb x rgb z scale 0.4 } } }",
];

const DECLARED: &str = "
#declare Map = color_map { [0.1 rgb x] [0.4 color rgb <0, 0.5, 0>] [0.9 rgbt <0, 0, 1, 0.5>] }
#declare Declared = pigment { marble turbulence 0.3 scale 0.5 }
#declare Mapped = pigment { bozo color_map { [0 rgb x] [1 rgb y] } scale 0.3 }
#declare Mixed = pigment { bozo pigment_map { [0 rgb x] [1 agate] } }
#declare Plain = pigment { wood }
#declare Colors = array[2] { rgb x, rgb <0.1, 0.2, 0.3> }
#declare Pigments = array[1] { Declared }
";

const POINTS: [DVec3; 5] = [
    DVec3::new(0.31, 0.47, -0.23),
    DVec3::new(-0.81, 0.11, 0.37),
    DVec3::new(0.07, -0.63, 0.91),
    DVec3::new(1.73, 2.29, -3.41),
    DVec3::new(-12.37, 5.61, 8.53),
];

#[test]
fn pigments_have_povrays_colors() {
    let Some(povray) = tool("povray") else {
        return;
    };
    let header = format!("#version 3.7;\nglobal_settings {{ assumed_gamma 1.0 }}\n{DECLARED}");
    let (mut theirs, mut ours) = (header.clone(), header);
    for (i, pigment) in PIGMENTS.iter().enumerate() {
        theirs.push_str(&format!(
            "#declare F{i} = function {{ pigment {{ {pigment} }} }}\n"
        ));
        for p in POINTS {
            theirs.push_str(&format!(
                "#declare C = F{i}({}, {}, {});\n#debug concat(\"<<\", vstr(5, C, \",\", 0, 9), \">>\\n\")\n",
                p.x, p.y, p.z
            ));
        }
        ours.push_str(&format!("sphere {{ 0, 1 pigment {{ {pigment} }} }}\n"));
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("p.ppm"), PICTURE).unwrap();
    std::fs::write(folder.path().join("pigments.pov"), &theirs).unwrap();
    let run = Command::new(povray)
        .args([
            "-D",
            "+W4",
            "+H4",
            "-F",
            "-GS",
            "-GW",
            "-GR",
            "+Ipigments.pov",
        ])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let output = String::from_utf8_lossy(&run.stderr)
        .replace("\n ", "")
        .replace('\n', "");
    let expected: Vec<Vec<f64>> = output
        .split("<<")
        .skip(1)
        .filter_map(|part| part.split(">>").next())
        .map(|list| list.split(',').map(|x| x.trim().parse().unwrap()).collect())
        .collect();
    assert_eq!(expected.len(), PIGMENTS.len() * POINTS.len(), "{output}");
    let found = textures(&ours);
    assert_eq!(found.len(), PIGMENTS.len());
    let mut wrong = vec![];
    for ((texture, name), expected) in found
        .iter()
        .zip(PIGMENTS)
        .zip(expected.chunks(POINTS.len()))
    {
        for (p, expected) in POINTS.iter().zip(expected) {
            let c = color_at(texture, *p);
            let found = [c.rgb.r, c.rgb.g, c.rgb.b, c.filter, c.transmit];
            let error = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
            if error.fold(0.0, f64::max) > 1e-6 {
                wrong.push(format!(
                    "{name} at {p}: POV-Ray {expected:?}, here {found:?}"
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
