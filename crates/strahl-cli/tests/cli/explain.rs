//! `strahl explain`: every factor it prints is the one used, under its own name.

use super::factors::check;
use super::{folder_with_scene, stderr, strahl, tool};
use serde_json::Value;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

pub(super) fn text(folder: &Path, args: &[&str]) -> String {
    let output = strahl(folder, &[&["explain"], args].concat());
    assert!(output.status.success(), "{args:?}: {}", stderr(&output));
    String::from_utf8(output.stdout).expect("text")
}

/// Text without its line breaks.
fn flat(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

pub(super) fn json(folder: &Path, args: &[&str]) -> Value {
    let json = text(folder, &[args, &["--format", "json"]].concat());
    serde_json::from_str(&json).expect("JSON")
}

/// A scene in POV-Ray's language in a folder of its own.
pub(super) fn pov(objects: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = format!(
        "#version 3.7;\nglobal_settings {{ assumed_gamma 1 }}\ncamera {{ location -5*z look_at 0 }}\n{objects}\n"
    );
    std::fs::write(folder.path().join("scene.pov"), scene).expect("writable");
    folder
}

/// The middle pixel of a small picture with one ray per pixel.
pub(super) const MIDDLE: [&str; 7] = [
    "scene.pov",
    "--size",
    "40x30",
    "--sampling",
    "center",
    "--pixel",
    "22,13",
];

#[test]
fn explain_prints_a_tree_that_sums_up_to_the_pixel() {
    let folder = folder_with_scene();
    let args = ["scene.nff", "--pixel", "24,20", "--sampling", "center"];
    let printed = text(folder.path(), &args);
    for part in [
        "pixel 24,20 of 48x40: (",
        "in 8 bits, linear colour (",
        "adds to the sample",
        "#0 primary ray, level 1, weight 1",
        "scene.nff:11, element 0)",
        "shading model phong: ka Ia + Σ L (kd (n·l) + ks (r·v)^p)",
        "ks = (0.3, 0.3, 0.3), p = 20",
        "light 1, point light at (5, 6, 7) (scene.nff:9)",
        "kd · L · (n·l) = (",
        "ks · L · (r·v)^p = (",
        "kr · Xr = (",
    ] {
        assert!(printed.contains(part), "{part}: {printed}");
    }
    let widest = printed.lines().map(|l| l.chars().count()).max();
    assert!(widest <= Some(100), "{printed}");
    let json = json(folder.path(), &args);
    check(&json);
    assert_eq!(json["samples"][0]["rays"][0]["total"], json["color"]);
    for i in 0..3 {
        let (color, film) = (json["color"][i].as_f64(), json["film"][i].as_f64());
        assert_eq!(
            color.expect("a number") as f32,
            film.expect("a number") as f32
        );
    }
    let all = [&["explain"], &args[..], &["--format", "dot"]].concat();
    let dot = strahl(folder.path(), &all);
    let dot = String::from_utf8(dot.stdout).expect("text");
    assert!(dot.starts_with("digraph") && dot.trim_end().ends_with('}'));
    if let Some(program) = tool("dot") {
        let mut child = Command::new(program)
            .args(["-Tsvg", "-o", "tree.svg"])
            .current_dir(folder.path())
            .stdin(Stdio::piped())
            .spawn()
            .expect("starts");
        child
            .stdin
            .take()
            .expect("piped")
            .write_all(dot.as_bytes())
            .expect("read");
        assert!(child.wait().expect("ends").success());
    }
}

/// JSON showed ks = 0 and p = 1 beside a non-zero highlight, and both forms named ks(h·n)^p for Phong's model.
#[test]
fn terms_bear_the_names_of_the_model_in_force() {
    let folder = folder_with_scene();
    let args = ["scene.nff", "--pixel", "24,20", "--sampling", "center"];
    for (model, named, other) in [
        ("phong", "ks · L · (r·v)^p", "(h·n)"),
        ("blinn-phong", "ks · L · (h·n)^p", "(r·v)"),
        ("lambert", "kd · L · (n·l)", "ks"),
    ] {
        let args = [&args[..], &["--shading", model]].concat();
        let printed = text(folder.path(), &args);
        assert!(
            printed.contains(&format!("shading model {model}")),
            "{printed}"
        );
        assert!(
            printed.contains(named) && !printed.contains(other),
            "{printed}"
        );
        assert!(check(&json(folder.path(), &args)).contains(&model.to_owned()));
    }
    let folder = pov("light_source { <3, 5, -6>, rgb 1 }
        sphere { 0, 1 pigment { rgb <1, .5, .2> }
          finish { ambient .1 diffuse .6 brilliance 2 phong .4 phong_size 20 specular .3 roughness .05 metallic } }");
    let printed = flat(&text(folder.path(), &MIDDLE));
    for part in [
        "POV-Ray's finish, 1 layer",
        "finish ambient 0.1, diffuse 0.6, brilliance 2, phong 0.4, phong_size 20",
        "diffuse · (n·l)^brilliance · C · L = 0.6 ·",
        "phong · (r·v)^phong_size = 0.4 ·",
        "specular · (h·n)^(1/roughness) = 0.3 ·",
        "highlight = (phong + specular) · metallic · L =",
    ] {
        assert!(printed.contains(part), "{part}: {printed}");
    }
    assert!(!printed.contains("ks"), "{printed}");
    let hit = &json(folder.path(), &MIDDLE)["samples"][0]["rays"][0]["hit"];
    assert_eq!(hit["model"], "pov-ray finish");
    assert!(hit.get("ks").is_none() && hit.get("p").is_none(), "{hit}");
}

/// `--shading` had no effect on POV-Ray's textures.
#[test]
fn a_shading_model_takes_the_place_of_a_finish() {
    let folder = pov("light_source { <3, 5, -6>, rgb 1 }
        sphere { 0, 1 pigment { rgb 1 } finish { ambient 0 diffuse .5 brilliance 3 phong .4 specular .3 } }");
    let mut totals = Vec::new();
    for (model, part) in [
        ("lambert", "diffuse · (n·l) · C · L"),
        ("phong", "specular · (r·v)^(1/roughness)"),
        ("blinn-phong", "phong · (h·n)^phong_size"),
    ] {
        let args = [&MIDDLE[..], &["--shading", model]].concat();
        let printed = text(folder.path(), &args);
        assert!(printed.contains(part), "{part}: {printed}");
        assert_eq!(
            printed.contains("highlight"),
            model != "lambert",
            "{printed}"
        );
        let json = json(folder.path(), &args);
        check(&json);
        totals.push(json["color"].to_string());
    }
    totals.push(json(folder.path(), &MIDDLE)["color"].to_string());
    totals.sort();
    totals.dedup();
    assert_eq!(totals.len(), 4, "{totals:?}");
}

/// Total reflection was not mentioned with Fresnel's equations.
#[test]
fn total_reflection_is_said_with_and_without_fresnel() {
    for finish in [
        "reflection { 0, 1 fresnel on } conserve_energy",
        "reflection { 0, 1 fresnel on }",
        "reflection .1",
    ] {
        // The ray hits the inside of the glass at an angle of 57 degrees.
        let folder = pov(&format!(
            "plane {{ y, 0 rotate 30*x pigment {{ rgbf 1 }} finish {{ {finish} }} interior {{ ior 1.5 }} }}"
        ));
        let printed = text(folder.path(), &MIDDLE);
        assert!(
            printed.contains("total internal reflection: sin θ2 = n1/n2 · sin θ1 = 1."),
            "{finish}: {printed}"
        );
        let seen = check(&json(folder.path(), &MIDDLE));
        assert!(
            seen.contains(&"total reflection".to_owned()),
            "{finish}: {seen:?}"
        );
    }
}

#[test]
fn shadows_say_what_casts_them() {
    let folder = pov("light_source { <0, 0, -20>, rgb 1 }
plane { z, 0 pigment { rgb 1 } }
#declare Lid = disc { <0, 0, -6>, z, 2 }
object { Lid pigment { rgb 1 } }");
    let printed = text(folder.path(), &MIDDLE);
    let blocker = "is blocked by disc \"Lid\" (scene.pov:7:1, element 1) at t = 0.3";
    assert!(printed.contains(blocker), "{printed}");
    assert!(
        printed.contains("light 1, point light at (0, 0, -20) (scene.pov:4:1)"),
        "{printed}"
    );
    let met = &json(folder.path(), &MIDDLE)["samples"][0]["rays"][0]["lights"][0]["shadow_rays"][0]
        ["met"][0];
    assert_eq!(
        (&met["blocks"], &met["element"]),
        (&Value::Bool(true), &Value::from(1))
    );
}

/// The trees of all samples were printed, thousands of lines for a pixel on an edge.
#[test]
fn a_pixel_of_many_samples_is_summed_up() {
    let folder = folder_with_scene();
    let args = ["scene.nff", "--pixel", "24,20", "--sampling", "4x4"];
    let printed = text(folder.path(), &args);
    assert!(printed.starts_with("pixel 24,20 of 48x40: ("), "{printed}");
    assert!(printed.contains("16 samples (4x4): "), "{printed}");
    assert!(
        printed.contains("`--sample N`") && !printed.contains("#0"),
        "{printed}"
    );
    assert!(printed.lines().count() < 30, "{printed}");
    let one = text(folder.path(), &[&args[..], &["--sample", "7"]].concat());
    assert!(
        one.contains("sample 7 at (") && !one.contains("sample 8 at ("),
        "{one}"
    );
    assert_eq!(one.matches("#0 primary ray").count(), 1);
    let all = text(folder.path(), &[&args[..], &["--sample", "all"]].concat());
    assert_eq!(all.matches("#0 primary ray").count(), 16);
    let every = json(folder.path(), &args);
    check(&every);
    assert_eq!(every["samples"].as_array().map(Vec::len), Some(16));
    let seventh = json(folder.path(), &[&args[..], &["--sample", "7"]].concat());
    assert_eq!(seventh["samples"][0], every["samples"][6]);
    let wrong = [&["explain"], &args[..], &["--sample", "17"]].concat();
    let wrong = strahl(folder.path(), &wrong);
    assert_eq!(wrong.status.code(), Some(1));
    assert!(stderr(&wrong).contains("no sample 17") && stderr(&wrong).contains("has 16"));
}

/// A pixel that is divided where its corners differ is not the plain mean of its samples.
#[test]
fn samples_of_divided_pixels_have_their_share() {
    let folder = pov("camera { orthographic location -5*z look_at 0 right 4*x up 3*y }
        plane { z, 0 pigment { gradient x color_map { [0 rgb 0] [.26 rgb 0] [.26 rgb 1] [1 rgb 1] } scale 4 translate 1.97*x } finish { ambient 1 diffuse 0 } }");
    let args = [
        "scene.pov",
        "--size",
        "4x3",
        "--sampling",
        "recursive",
        "--pixel",
        "3,1",
    ];
    // The left half is one square of 1, the right one has a left half of 1 and a right one of 1/2.
    let printed = json(folder.path(), &args);
    assert_eq!(printed["color"][0], 0.875);
    assert_eq!(printed["samples"].as_array().map(Vec::len), Some(18));
    check(&printed);
    let table = text(folder.path(), &args);
    for row in table
        .lines()
        .filter(|line| line.contains("plane scene.pov"))
    {
        let (_, share) = row.split_once(", counts ").expect("a share");
        let (above, below) = share.split_once('/').expect("a fraction");
        let share = above.parse::<f64>().unwrap() / below.parse::<f64>().unwrap();
        let number: usize = row.split_whitespace().next().unwrap().parse().unwrap();
        assert_eq!(printed["samples"][number - 1]["share"], share, "{row}");
    }
    assert_eq!(table.matches(", counts ").count(), 18, "{table}");
    let one = text(folder.path(), &[&args[..], &["--sample", "1"]].concat());
    assert!(one.contains("sample 1 at (3, 1), counts 1/"), "{one}");
}

#[test]
fn rays_through_a_lens_are_counted_as_samples() {
    let folder = pov("light_source { <4, 6, -5>, 1 } plane { y, 0 pigment { checker rgb .9 rgb .2 } }
        camera { location <0, 1, -6> look_at .5*y angle 40 aperture .6 focal_point .5*y blur_samples 7 }");
    let args = [
        "scene.pov",
        "--size",
        "40x30",
        "--pixel",
        "24,16",
        "--sampling",
    ];
    let with = |words: &[&str]| flat(&text(folder.path(), &[&args[..], words].concat()));
    let center = with(&["center"]);
    assert!(
        center.contains("7 samples (center, 7 rays through the lens for 1 place): "),
        "{center}"
    );
    assert!(center.contains("`--sample N`") && !center.contains("`--sampling center`"));
    let four = with(&["2x2"]);
    assert!(
        four.contains("28 samples (2x2, 28 rays through the lens for 4 places): ")
            && four.contains("`--sampling center` looks at one place only"),
        "{four}"
    );
    // The trees that follow need no advice how to see them.
    let all = with(&["center", "--sample", "all"]);
    assert!(
        all.contains("first hit") && !all.contains("`--sample N`"),
        "{all}"
    );
}

#[test]
fn numbers_have_the_digits_asked_for() {
    let folder = folder_with_scene();
    let args = ["scene.nff", "--pixel", "24,20", "--sampling", "center"];
    let longest = |digits: &str| {
        let printed = text(folder.path(), &[&args[..], &["--digits", digits]].concat());
        let numbers = printed.split(|c: char| !(c.is_ascii_digit() || c == '.'));
        let decimals = numbers
            .filter_map(|n| n.split_once('.'))
            .map(|(_, d)| d.len());
        decimals.max().expect("a number")
    };
    assert!((3..=7).contains(&longest("3")));
    assert!(longest("full") >= 16);
    let default = text(folder.path(), &args);
    assert_eq!(
        default,
        text(folder.path(), &[&args[..], &["--digits", "6"]].concat())
    );
    // The numbers printed in full are the same as in JSON.
    let full = text(folder.path(), &[&args[..], &["--digits", "full"]].concat());
    let color = json(folder.path(), &args)["color"][0].to_string();
    assert!(
        full.contains(&format!("linear colour ({color}, ")),
        "{color}: {full}"
    );
}

/// A deep tree in glass has hundreds of rays; only those with the largest contributions are shown.
#[test]
fn large_trees_show_the_rays_that_add_most() {
    let folder = pov("light_source { <3, 5, -6>, rgb 1 } background { rgb <.4, .6, .8> }
        #for (I, 0, 4) sphere { I*z, 1.5 - .2*I pigment { rgbf .95 } finish { reflection .2 } interior { ior 1.3 + .1*I } } #end");
    let args = [&MIDDLE[..], &["--max-depth", "12", "--adc-bailout", "0"]].concat();
    let printed = text(folder.path(), &args);
    let paragraphs = |text: &str| text.matches(", level ").count();
    assert!((20..=60).contains(&paragraphs(&printed)), "{printed}");
    assert!(printed.contains("more rays that add (") && printed.contains("`--rays all`"));
    let all = text(folder.path(), &[&args[..], &["--rays", "all"]].concat());
    assert!(paragraphs(&all) > 100 && !all.contains("more rays"));
    check(&json(folder.path(), &args));
}

/// The example pixels of README and book have a reflection and a refraction, and the page shows the actual output.
#[test]
fn the_pixels_of_the_documents_have_a_reflection_and_a_refraction() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let book = include_str!("../../../../docs/src/explain.md");
    for (page, text_of_page) in [
        ("README.md", include_str!("../../../../README.md")),
        ("explain.md", book),
    ] {
        let mut commands = 0;
        for rest in text_of_page.split("strahl explain ").skip(1) {
            let command = rest.split(['\n', '`', '|']).next().expect("a command");
            if !command.contains("--pixel") {
                continue;
            }
            commands += 1;
            let mut words: Vec<&str> = command.split_whitespace().collect();
            if let Some(dot) = words.iter().position(|w| *w == "--format") {
                words.truncate(dot);
            }
            let seen = check(&json(&repository, &words));
            for kind in ["reflection", "transparency"] {
                assert!(
                    seen.contains(&kind.to_owned()),
                    "{page}: {command}: {seen:?}"
                );
            }
        }
        assert!(commands > 0, "{page} has no command");
    }
    let command = "scenes/spheres.nff --pixel 330,210 --sampling center";
    let words: Vec<&str> = command.split(' ').collect();
    let printed = text(&repository, &words);
    let shown: Vec<&str> = book.split("```text\n").skip(1).collect();
    for block in &shown[..2] {
        let block = block.split("\n```").next().expect("a block");
        assert!(
            printed.contains(block),
            "not printed:\n{block}\n---\n{printed}"
        );
    }
}

/// The program prints what the library builds: one schema.
#[test]
fn json_is_the_librarys() {
    let folder = pov(
        "light_source { <3, 5, -6> 1 }
         light_source { <-3, 5, -6> rgb 0.5 area_light x, y, 2, 2 }
         sphere { 0, 1 pigment { rgbf <0.9, 0.5, 0.5, 0.6> } finish { phong 0.6 reflection { 0.1, 0.4 fresnel } } interior { ior 1.3 } }
         plane { y, -1 pigment { checker } finish { specular 0.3 roughness 0.02 } }",
    );
    let path = folder.path().join("scene.pov");
    for sampling in ["center", "2x2", "adaptive", "recursive"] {
        let args = [
            "scene.pov",
            "--size",
            "40x30",
            "--sampling",
            sampling,
            "--pixel",
            "17,16",
        ];
        let printed = text(folder.path(), &[&args[..], &["--format", "json"]].concat());
        let session = strahl::Session::new(strahl::Threads::Count(1)).expect("a thread");
        let mut options = strahl::LoadOptions::default();
        (options.sdl.image_width, options.sdl.image_height) = (40, 30);
        let loaded = strahl::load_path(&path, options).scene.expect("a scene");
        let (scene, _) = session
            .compile(&loaded, &Default::default())
            .expect("valid");
        let view = scene
            .view(40, 30)
            .with_sampling(sampling.parse().expect("a sampling"));
        let explained = session.explain(&view, 17, 16).expect("a pixel").to_json();
        // The program names files as it was given them.
        let without_places = |json: &str| -> String {
            json.lines()
                .filter(|line| !line.contains("\"source\""))
                .collect()
        };
        assert_eq!(
            without_places(&printed),
            without_places(&explained),
            "{sampling}"
        );
        assert!(printed.contains("\"source\": \"scene.pov:"));
    }
}

/// One pixel, or the whole picture with the trees of some pixels, as a page that needs nothing else.
#[test]
fn pages_have_everything_in_them() {
    let folder = pov("sphere { 0, 1 pigment { rgb x } } light_source { -9*z, 1 }");
    let page = |args: &[&str]| {
        let all = ["scene.pov", "--size", "40x30", "--format", "html"];
        text(folder.path(), &[&all, args].concat())
    };
    let pixel = page(&["--pixel", "22,13"]);
    assert!(pixel.contains("\"pixel\":[22,13]") && !pixel.contains("base64,"));
    let picture = page(&["--trees", "6"]);
    assert!(picture.contains("data:image/png;base64,") && picture.contains("rgb x"));
    let trees = picture.matches("\"pixel\":[").count();
    assert!((3..=6).contains(&trees), "{trees}");
    for html in [pixel, picture] {
        assert!(html.starts_with("<!doctype html>") && html.contains("scene.pov"));
        assert!(!html.contains("src=\"") && !html.contains("href=\""));
    }
    let output = strahl(folder.path(), &["explain", "scene.pov"]);
    assert!(!output.status.success());
    assert!(stderr(&output).contains("--pixel X,Y"));
}

/// Surfaces and fractals: the name of the object, its line, and a hit on it. The ones that are given a height are met there.
#[test]
fn hits_of_surfaces_and_fractals_are_explained() {
    let rows = [
        (
            "bicubic_patch",
            "bicubic_patch { type 1 flatness 0 u_steps 3 v_steps 3
               #for (J, 0, 3) #for (I, 0, 3) <I - 1.5, J - 1.5, 0> #end #end }",
            Some(0.0),
        ),
        (
            "nurbs",
            "nurbs { degree 1 row { <-1, -1, 0.5>, <1, -1, 0.5> } row { <-1, 1, 0.5>, <1, 1, 0.5> } }",
            Some(0.5),
        ),
        (
            "brep",
            "brep { #for (K, 0, 5) #local N = mod(K, 3); nurbs { degree 1 #for (J, 0, 1) row { #for (I, 0, 1)
               #local P = <I - 0.5, J - 0.5, floor(K / 3) - 0.5>; (N = 0 ? P : N = 1 ? <P.z, P.x, P.y> : <P.y, P.z, P.x>) #end } #end } #end }",
            Some(-0.5),
        ),
        (
            "subdivision",
            "subdivision { points { <-1, -1, 0>, <1, -1, 0>, <1, 1, 0>, <-1, 1, 0> } face { 0, 1, 2, 3 } }",
            Some(0.0),
        ),
        (
            "terrain",
            "terrain { extent <-3, -3>, <3, 3> rotate -60*x }",
            None,
        ),
        ("mandelbulb", "mandelbulb { 8 }", None),
        (
            "menger",
            "menger { <-0.2, -0.2, -1>, <2.8, 2.8, 2>, 1 }",
            Some(-1.0),
        ),
    ];
    for (number, (kind, object, height)) in rows.into_iter().enumerate() {
        // The line of the first is the fourth.
        let lines = "\n".repeat(number);
        let folder = pov(&format!("{lines}{object}\nlight_source {{ -9*z, 1 }}"));
        let place = format!("scene.pov:{}:1", 4 + number);
        let printed = text(folder.path(), &MIDDLE);
        let expected = format!("hits {kind} ({place}, element ");
        assert!(printed.contains(&expected), "{expected}: {printed}");
        let json = json(folder.path(), &MIDDLE);
        let ray = &json["samples"][0]["rays"][0];
        let hit = &ray["hit"];
        assert_eq!(
            (&hit["object"], &hit["source"]),
            (&kind.into(), &place.as_str().into())
        );
        let vector = |v: &Value| [0, 1, 2].map(|i| v[i].as_f64().expect("a number"));
        let [normal, point] = ["normal", "position"].map(|key| vector(&hit[key]));
        let [origin, direction] = ["origin", "direction"].map(|key| vector(&ray["ray"][key]));
        let t = hit["t"].as_f64().expect("a number");
        for i in 0..3 {
            assert!(
                (origin[i] + t * direction[i] - point[i]).abs() < 1e-9,
                "{kind}: {hit}"
            );
        }
        let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        assert!(
            (dot(normal, normal) - 1.0).abs() < 1e-9,
            "{kind}: {normal:?}"
        );
        assert!(dot(normal, direction) < 0.0, "{kind}: {normal:?}");
        if let Some(height) = height {
            assert!((point[2] - height).abs() < 1e-9, "{kind}: {point:?}");
        }
    }
}
