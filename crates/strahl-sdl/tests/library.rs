//! The include library: every documented name exists with its kind, and looks as it did when it was compared with POV-Ray (`cargo
//! xtask looks`).

use crate::common::{parse_with, tool};
use crate::plates::{self, Name, Sheet};
use std::collections::{BTreeMap, BTreeSet};
use strahl_render::{CompileOptions, RenderOptions, compile, render};
use strahl_sdl::MemoryHost;

/// Mean colours of POV-Ray's plates, in 8-bit codes; the header ends with the size of a plate.
const MEANS: &str = include_str!("data/looks.tsv");

/// The largest difference of a mean colour from POV-Ray's.
const CLOSE: f64 = 6.0;

/// A statement that uses the name according to its kind in the list.
fn use_of(name: &Name) -> Option<String> {
    let Name { name, kind, .. } = name;
    Some(match *kind {
        "texture" | "pigment" | "finish" | "material" | "interior" | "sky_sphere" | "object"
        | "transform" => format!("#declare Used = {kind} {{ {name} }}\n"),
        "color_map" => {
            format!("#declare Used = pigment {{ bozo color_map {{ {name} }} }}\n")
        }
        "color" => format!("#declare Used = pigment {{ color {name} }}\n"),
        "vector" => format!("#declare Used = vlength(<0, 0, 0> + {name});\n"),
        "float" => format!("#declare Used = {name} + 1;\n"),
        "seed" => format!("#declare Used = rand({name});\n"),
        "macro" | "function" => {
            format!("#ifndef ({name}) #error \"{name} is not declared\" #end\n")
        }
        _ => return None,
    })
}

#[test]
fn names_have_their_kinds() {
    let mut files: BTreeMap<&str, Vec<Name>> = BTreeMap::new();
    for name in plates::all() {
        files.entry(name.file).or_default().push(name);
    }
    assert!(files.len() > 20);
    for (file, names) in files {
        let mut text = format!("global_settings {{ assumed_gamma 1 }}\n#include \"{file}\"\n");
        for name in &names {
            text += &use_of(name).unwrap_or_else(|| panic!("{file}: {name:?}"));
        }
        let parsed = parse_with(&mut MemoryHost::new(), &text);
        let errors = parsed.diagnostics.iter().filter(|d| d.is_error());
        let errors: Vec<String> = errors.map(ToString::to_string).collect();
        assert!(errors.is_empty(), "{file}: {}", errors.join("\n"));
    }
}

/// Scenes use a named colour as a whole pigment, and the pigments of metals as colours.
#[test]
fn colours_of_metals_are_colours() {
    let text = "global_settings { assumed_gamma 1 }
        #include \"metals.inc\"
        #declare A = pigment { P_Copper1 }
        #declare B = pigment { color P_Gold3 * 0.5 }
        #declare C = vlength(CVect2);";
    let parsed = parse_with(&mut MemoryHost::new(), text);
    let errors: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
    assert!(parsed.scene.is_some(), "{}", errors.join("\n"));
}

/// The mean colours of the plates of a sheet.
fn means(sheet: &Sheet, (w, h): (usize, usize)) -> Vec<[f64; 3]> {
    let parsed = parse_with(&mut MemoryHost::new(), &sheet.text);
    let messages: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
    let scene = parsed
        .scene
        .unwrap_or_else(|| panic!("{}", messages.join("\n")));
    let scene = compile(&scene, &CompileOptions::default()).expect("the plates compile");
    let across = w * sheet.columns;
    let options = RenderOptions::new(&scene, across as u32, (h * sheet.rows) as u32);
    let film = render(&scene, &options).expect("the plates render").film;
    let plate = |i: usize| {
        let corner = (i / sheet.columns) * h * across + (i % sheet.columns) * w;
        let mut sum = [0.0; 3];
        for y in 0..h {
            for pixel in &film.pixels[corner + y * across..][..w] {
                for (sum, value) in sum.iter_mut().zip(pixel) {
                    let value = f64::from(*value).clamp(0.0, 1.0);
                    *sum += 255.0 * strahl_shade::srgb::encode(value);
                }
            }
        }
        sum.map(|s| s / (w * h) as f64)
    };
    (0..sheet.names.len()).map(plate).collect()
}

#[test]
fn names_look_as_they_were_measured() {
    let mut lines = MEANS.lines();
    let size = lines.next().unwrap().rsplit('\t').next().unwrap();
    let (w, h) = size.split_once('x').unwrap();
    let size = (w.parse().unwrap(), h.parse().unwrap());
    let measured: BTreeMap<&str, Vec<f64>> = lines
        .map(|line| {
            let (name, numbers) = line.split_once('\t').unwrap();
            (
                name,
                numbers.split('\t').map(|n| n.parse().unwrap()).collect(),
            )
        })
        .collect();
    let mut missing: BTreeSet<&str> = measured.keys().copied().collect();
    let mut far = vec![];
    for sheet in plates::sheets(&plates::names()) {
        for (name, mean) in sheet.names.iter().zip(means(&sheet, size)) {
            let title = format!("{}/{}", name.file, name.name);
            missing.remove(title.as_str());
            let theirs = measured
                .get(title.as_str())
                .unwrap_or_else(|| panic!("{title} is not in looks.tsv"));
            let apart = mean.iter().zip(theirs).map(|(a, b)| (a - b).abs());
            let apart = apart.fold(0.0, f64::max);
            if apart > CLOSE {
                far.push(format!(
                    "{title}: {mean:.0?} is {apart:.1} from {theirs:.0?}"
                ));
            }
        }
    }
    assert!(far.is_empty(), "{}", far.join("\n"));
    assert!(missing.is_empty(), "no longer in the library: {missing:?}");
}

/// The red of 8x6 pixels of POV-Ray's pictures: veins and clouds are where POV-Ray's are, not only of their colours.
#[test]
fn clouds_woods_and_stones_are_where_povrays_are() {
    const LOOKS: [(&str, &str, [u8; 48]); 5] = [
        (
            "skies.inc",
            "camera { location 0 angle 90 look_at <0, 0.9, 1> } sky_sphere { S_Cloud5 }",
            [
                188, 163, 159, 171, 194, 195, 161, 161, 161, 204, 161, 179, 194, 162, 158, 139,
                146, 193, 171, 167, 163, 157, 152, 198, 168, 176, 155, 169, 142, 191, 184, 174,
                173, 177, 167, 148, 156, 193, 188, 175, 179, 192, 164, 171, 221, 225, 217, 207,
            ],
        ),
        (
            "woods.inc",
            "plane { -z, 0 texture { T_Wood34 } }",
            [
                166, 159, 186, 157, 153, 186, 186, 174, 141, 167, 179, 172, 163, 178, 166, 144,
                170, 174, 162, 156, 162, 161, 157, 167, 176, 176, 156, 160, 158, 153, 156, 170,
                159, 178, 184, 166, 170, 173, 182, 163, 165, 157, 186, 147, 151, 184, 166, 186,
            ],
        ),
        (
            "woods.inc",
            "plane { -z, 0 texture { T_Wood35 } }",
            [
                191, 185, 214, 203, 206, 184, 215, 190, 214, 195, 203, 210, 214, 203, 217, 213,
                211, 213, 184, 207, 196, 193, 210, 215, 206, 210, 216, 182, 200, 210, 213, 211,
                210, 180, 208, 211, 185, 188, 194, 215, 190, 203, 215, 200, 204, 210, 192, 195,
            ],
        ),
        (
            "stones1.inc",
            "plane { -z, 0 texture { T_Stone9 finish { phong 0 } } }",
            [
                192, 179, 199, 185, 198, 173, 186, 198, 200, 197, 193, 194, 198, 176, 199, 182,
                172, 198, 188, 195, 197, 195, 183, 187, 172, 185, 188, 171, 178, 179, 190, 172,
                202, 184, 179, 182, 199, 182, 181, 194, 183, 193, 187, 195, 191, 194, 198, 201,
            ],
        ),
        (
            "stones2.inc",
            "plane { -z, 0 texture { T_Stone44 } }",
            [
                156, 157, 151, 154, 151, 166, 149, 148, 141, 163, 169, 147, 145, 166, 144, 146,
                153, 158, 150, 161, 166, 153, 140, 161, 151, 163, 158, 150, 147, 136, 152, 167,
                158, 156, 156, 165, 150, 148, 169, 138, 157, 153, 141, 160, 161, 173, 142, 146,
            ],
        ),
    ];
    for (file, objects, theirs) in LOOKS {
        let text = format!(
            "#version 3.7; global_settings {{ assumed_gamma 1 }}
            #include \"colors.inc\"
            #include \"{file}\"
            light_source {{ -1000*z, rgb 1 }}
            camera {{ orthographic location -9*z look_at 0 right 4*x up 3*y }}
            {objects}"
        );
        let parsed = parse_with(&mut MemoryHost::new(), &text);
        let scene = parsed.scene.expect("the scene is read");
        let scene = compile(&scene, &CompileOptions::default()).expect("the scene compiles");
        let film = render(&scene, &RenderOptions::new(&scene, 8, 6))
            .expect("the scene renders")
            .film;
        for (pixel, theirs) in film.pixels.iter().zip(theirs) {
            let ours = 255.0 * strahl_shade::srgb::encode(f64::from(pixel[0]).clamp(0.0, 1.0));
            let apart = (ours - f64::from(theirs)).abs();
            assert!(apart < 4.0, "{objects}: {ours} instead of {theirs}");
        }
    }
}

/// POV-Ray's extents: inverted letters hang from the circle by their tops, and the spacing is in units of the size.
#[test]
fn circle_text_stands_where_povrays_does() {
    if tool("povray").is_none() {
        return;
    }
    // The font comes with POV-Ray's include files.
    let font = std::fs::read("/usr/share/povray-3.7/include/cyrvetic.ttf").expect("POV-Ray's font");
    let text = r#"
        #include "shapes.inc"
        #declare Hanging = Circle_Text("cyrvetic.ttf", "H", 0.4, 0, 0.01, 1.1, true, Align_Center, -90)
        #declare Low = min_extent(Hanging);
        #declare High = max_extent(Hanging);
        #if (abs(Low.y + 1.39) > 0.015 | abs(High.y + 1.1) > 0.015 | abs(Low.x + High.x) > 0.015)
            #error concat("hanging: ", vstr(3, Low, ", ", 0, 3), " to ", vstr(3, High, ", ", 0, 3))
        #end
        #declare Pair = Circle_Text("cyrvetic.ttf", "HH", 0.4, 0.3, 0.01, 1.1, false, Align_Left, 90)
        #declare High = max_extent(Pair);
        #if (abs(High.x - 0.74) > 0.03)
            #error concat("spaced: ", vstr(3, High, ", ", 0, 3))
        #end"#;
    let mut host = MemoryHost::new().with_file("cyrvetic.ttf", font);
    let parsed = parse_with(&mut host, text);
    let errors = parsed.diagnostics.iter().filter(|d| d.is_error());
    let errors: Vec<String> = errors.map(ToString::to_string).collect();
    assert!(errors.is_empty(), "{}", errors.join("\n"));
}

/// The errors of a scene's text and of the files that it may include.
fn errors_of(text: &str) -> Vec<String> {
    let parsed = parse_with(&mut MemoryHost::new(), text);
    let errors = parsed.diagnostics.iter().filter(|d| d.is_error());
    errors.map(ToString::to_string).collect()
}

/// POV-Ray's numbers, each with the one that the stream gives next.
#[test]
fn numbers_of_distributions_are_povrays() {
    let macros = [
        "Rand_Normal(3, 2, A)",
        "Rand_Student(3, A)",
        "Rand_Student(5, A)",
        "Rand_Chi_Square(3, A)",
        "Rand_F_Dist(2, 5, A)",
    ];
    let seeds = [
        (
            1,
            [
                [2.895287606, 0.665896216],
                [-1.195564007, 0.297774397],
                [0.414795103, 0.625949437],
                [2.501721725, 0.665896216],
                [7.166690622, 0.297774397],
            ],
        ),
        (
            1234,
            [
                [4.560237055, 0.612337817],
                [-0.149533799, 0.194746785],
                [-2.166012507, 0.725293803],
                [5.417099097, 0.612337817],
                [8.667618354, 0.194746785],
            ],
        ),
    ];
    let mut text = String::from("#include \"rand.inc\"\n");
    for (seed, values) in seeds {
        for (number, [value, next]) in macros.iter().zip(values) {
            // The second number of `Rand_Student` goes on with the stream of the first, of which a pair is half used.
            if *number != "Rand_Student(5, A)" {
                text += &format!("#declare A = seed({seed});\n");
            }
            text += &format!(
                "#declare V = {number}; #declare N = rand(A);
                #if (abs(V - {value}) > 1e-8 | abs(N - {next}) > 1e-8)
                    #error concat(\"{number} of {seed}: \", str(V, 0, 9), \" \", str(N, 0, 9))
                #end\n"
            );
        }
    }
    assert_eq!(errors_of(&text), [""; 0]);
}

/// POV-Ray's boxes: those that are confined to the screen move evenly from gap to gap, and their middle is on the screen.
#[test]
fn screen_objects_stand_where_povrays_do() {
    let cases = [
        ("<0.5, 0.9>", "true", "<-0.125, 0.159, 0.995>"),
        ("<0, 0>", "true", "<-0.646667, -0.48, 0.995>"),
        ("<1, 1>", "true", "<0.396667, 0.23, 0.995>"),
        ("<-0.5, 2>", "true", "<-1.168333, 0.94, 0.995>"),
        ("<0.25, 0.75>", "false", "<-0.433333, 0.05, 1>"),
    ];
    let mut text = String::from(
        "#include \"screen.inc\" Set_Camera_Aspect(4, 3) #declare B = box { <-0.1, -0.2, 0>, <0.15, 0.05, 0.01> }",
    );
    for (place, confine, low) in cases {
        text += &format!(
            "#declare O = object {{ Screen_Object(B, {place}, <0.02, 0.02>, {confine}, 0.01) }}
            #if (vlength(min_extent(O)/0.01 - {low}) > 1e-5) #error concat(\"{place}: \", vstr(3, min_extent(O)/0.01, \", \", 0, 6)) #end\n"
        );
    }
    assert_eq!(errors_of(&text), [""; 0]);
}

/// Where POV-Ray's rays meet the height fields of `shapes.inc`, and the normals there.
#[test]
fn height_fields_of_shapes_inc_are_povrays_meshes() {
    let cases = [
        (
            "HF_Square(F, 0, 0, <4, 5>, 1, \"\", <-1, -0.2, -1>, <1, 0.8, 1.5>)",
            1,
            "<0.199289, 0.250266, -0.098914>",
            "<-0.21191, 0.97729, 0.00135>",
        ),
        (
            "HF_Sphere(F, 1, 0, <6, 5>, 1, \"\", <0.1, 0.2, 0>, 1, 0.5)",
            0,
            "<-0.089906, 1.216352, -0.293270>",
            "<0.63527, 0.70504, -0.31520>",
        ),
        (
            "HF_Sphere(F, 1, 0, <6, 5>, 1, \"\", <0.1, 0.2, 0>, 1, 0.5)",
            2,
            "<0.597016, -0.030080, 0.448930>",
            "<0.75806, -0.32832, 0.56351>",
        ),
        (
            "HF_Cylinder(F, 0, 0, <6, 4>, 0, \"\", -<0.2, 1, 0.1>, <0.1, 1, 0.3>, 0.8, 0.3)",
            1,
            "<-0.321393, 0.444802, 0.696340>",
            "<-0.50465, -0.28391, 0.81531>",
        ),
        (
            "HF_Torus(F, 1, 0, <7, 6>, 1, \"\", 1, 0.5, 0.2)",
            1,
            "<-0.415247, 0.479867, 0.839687>",
            "<0.07041, 0.99752, 0.00101>",
        ),
        (
            "HF_Torus(F, 1, 0, <7, 6>, 1, \"\", 1, 0.5, 0.2)",
            2,
            "<0.884971, -0.233222, 0.847068>",
            "<0.60394, -0.57379, 0.55320>",
        ),
    ];
    let mut text = String::from(
        "#include \"shapes.inc\"
        #declare F = function(x, y, z) { sin(3*x)*0.3 + cos(5*y + 1)*0.3 + x*y*z*z/5 }\n",
    );
    for (object, turn, place, normal) in cases {
        text += &format!(
            "#declare N = <0, 0, 0>; #declare D = vrotate(<0.3, -1, 0.2>, {turn}*<70, 0, 40>);
            #declare O = object {{ {object} }}
            #declare P = trace(O, <0.2, 0.25, -0.1> - 5*D, D, N);
            #if (vlength(P - {place}) > 2e-6 | vlength(N - {normal}) > 2e-5)
                #error concat(\"{turn} {place}: \", vstr(3, P, \", \", 0, 6), \" \", vstr(3, N, \", \", 0, 5))
            #end\n"
        );
    }
    // A mesh in a file, included.
    text += "HF_Square(F, 0, 1, <4, 5>, 1, \"mesh.txt\", <-1, -0.2, -1>, <1, 0.8, 1.5>)
        #declare O =
        #include \"mesh.txt\"
        #declare P = trace(O, <0.2, 5, -0.1>, -y);
        #declare O = HF_Square(F, 0, 1, <4, 5>, 1, \"\", <-1, -0.2, -1>, <1, 0.8, 1.5>)
        #declare Q = trace(O, <0.2, 5, -0.1>, -y);
        #if (vlength(P - Q) > 1e-5) #error \"the mesh in the file is another\" #end\n";
    assert_eq!(errors_of(&text), [""; 0]);
}
