//! All scenes of the repository: each must be read without a message, have a picture, and look as in POV-Ray.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use strahl::sdl::{Options, Value};
use strahl::shade::srgb;
use strahl::tracing::CompileOptions;
use strahl::{LoadOptions, load_path};

/// Scenes that look different in POV-Ray 3.7, with the reason.
const DIFFERENT: [(&str, &str); 14] = [
    (
        "patterns/cubic.pov",
        "the pattern is new in version 3.8 of the language",
    ),
    (
        "objects/polynomial.pov",
        "the object is new in version 3.8 of the language",
    ),
    (
        "objects/lemon.pov",
        "the object is new in version 3.8 of the language",
    ),
    (
        "objects/nurbs.pov",
        "the object is an extension of the language",
    ),
    (
        "objects/brep.pov",
        "the object is an extension of the language",
    ),
    (
        "objects/terrain.pov",
        "the object is an extension of the language",
    ),
    (
        "objects/mandelbulb.pov",
        "the object is an extension of the language",
    ),
    (
        "objects/menger.pov",
        "the object is an extension of the language",
    ),
    (
        "objects/subdivision.pov",
        "the object is an extension of the language",
    ),
    (
        "showcase/shell.pov",
        "subdivision surfaces are an extension of the language",
    ),
    (
        "showcase/streamliner.pov",
        "NURBS surfaces are an extension of the language",
    ),
    (
        "objects/parametric.pov",
        "POV-Ray takes minutes, and has holes",
    ),
    ("objects/text.pov", "the font may be another"),
    (
        "09_sphere.pov",
        "POV-Ray loses balls that are 100 million times their radius away",
    ),
];

/// Scenes of many parts that are rendered with fewer: the declarations of their numbers.
const COARSE: [(&str, f64); 4] = [
    ("Across", 40.0),
    ("Deep", 40.0),
    ("Generations", 2.0),
    ("Balls", 1.0),
];

/// Large enough to see whether something is missing.
const SIZE: (u32, u32) = (32, 24);

/// 8-bit codes, row by row.
type Codes = Vec<f64>;

fn scenes() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let (mut folders, mut found) = (vec![root], vec![]);
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder of scenes") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "pov") {
                found.push(path);
            }
        }
    }
    found.sort();
    assert!(found.len() > 100, "only {} scenes", found.len());
    found
}

/// Renders a scene without antialiasing, or returns its problem.
fn ours(scene: &Path) -> Result<Codes, String> {
    let mut sdl = Options::default();
    (sdl.image_width, sdl.image_height) = SIZE;
    sdl.declare = COARSE
        .map(|(name, value)| (name.to_owned(), Value::Float(value)))
        .to_vec();
    let loaded = load_path(
        scene,
        LoadOptions {
            sdl,
            ..LoadOptions::default()
        },
    );
    let mut said: Vec<String> = loaded.diagnostics.iter().map(ToString::to_string).collect();
    if scene.ends_with("text.pov") {
        // Another font replaces POV-Ray's, which may be missing here.
        said.retain(|text| !text.contains("replaces it"));
    } else if scene.to_string_lossy().contains("exporters") {
        // Scenes of exporters may cause advice, but nothing in them may be left out.
        said.retain(|text| text.contains("left out") || text.contains("not supported"));
    }
    if !said.is_empty() {
        return Err(said.join("\n"));
    }
    let scene = loaded.scene.ok_or("there is no scene, and no error")?;
    let scene = strahl::compile(&scene, &CompileOptions::default())
        .map_err(|problems| format!("{problems:?}"))?;
    let options = strahl::tracing::RenderOptions::new(&scene, SIZE.0, SIZE.1);
    let film = strahl::render(&scene, &options).map_err(|e| e.to_string())?;
    let values = film.film.pixels.iter().flatten();
    Ok(values
        .map(|v| (srgb::encode(f64::from(*v).clamp(0.0, 1.0)) * 255.0).round())
        .collect())
}

fn theirs(povray: &Path, scene: &Path) -> Result<Codes, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = folder.path().join("picture.ppm");
    let run = Command::new(povray)
        .current_dir(scene.parent().expect("a scene lies in a folder"))
        .arg(format!(
            "+I{}",
            scene.file_name().expect("a name").to_string_lossy()
        ))
        .arg(format!("+O{}", picture.display()))
        .args([format!("+W{}", SIZE.0), format!("+H{}", SIZE.1)])
        .args(COARSE.map(|(name, value)| format!("Declare={name}={value}")))
        .args(["-A", "-D", "-GA", "+FP", "+WT1"])
        .output()
        .expect("the program starts");
    if !run.status.success() {
        let log = String::from_utf8_lossy(&run.stderr);
        let from = log.find("Error").unwrap_or_default();
        return Err(format!("POV-Ray: {}", &log[from..]));
    }
    let bytes = std::fs::read(picture).expect("a picture");
    let size = (SIZE.0 * SIZE.1 * 3) as usize;
    let codes = bytes[bytes.len() - size..].iter();
    Ok(codes.map(|code| f64::from(*code)).collect())
}

/// Tries all scenes with several threads; returns all problems.
fn try_all(check: impl Fn(&Path) -> Result<(), String> + Sync) -> Vec<String> {
    let scenes = scenes();
    let threads = std::thread::available_parallelism().map_or(2, |n| n.get());
    let mut failed: Vec<String> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|first| {
                let (check, scenes) = (&check, &scenes);
                let own = scenes.iter().skip(first).step_by(threads);
                scope.spawn(move || {
                    own.filter_map(|scene| {
                        // A machine without fonts cannot render text.
                        let said = check(scene).err().filter(|e| !e.contains("the font `"))?;
                        Some(format!("{}: {said}", scene.display()))
                    })
                    .collect::<Vec<_>>()
                })
            })
            .collect();
        let done = workers.into_iter().map(|w| w.join().expect("no panic"));
        done.flatten().collect()
    });
    failed.sort();
    failed
}

#[test]
fn scenes_are_read_without_complaint_and_look_as_povray_shows_them() {
    let povray = tool("povray");
    let failed = try_all(|scene| {
        let ours = ours(scene)?;
        let (least, most) = ours
            .iter()
            .fold((255.0_f64, 0.0_f64), |(a, b), c| (a.min(*c), b.max(*c)));
        if most - least < 40.0 {
            return Err(format!("all codes are between {least} and {most}"));
        }
        let Some(povray) = &povray else {
            return Ok(());
        };
        if DIFFERENT.iter().any(|(name, _)| scene.ends_with(name)) {
            return Ok(());
        }
        let theirs = theirs(povray, scene)?;
        let apart = ours.iter().zip(&theirs).map(|(a, b)| (a - b).abs());
        let mean = apart.sum::<f64>() / ours.len() as f64;
        if mean >= 4.0 {
            return Err(format!("mean difference {mean:.2}/255"));
        }
        Ok(())
    });
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// A program to compare with; without it the caller skips its test, unless the environment requires all tools.
fn tool(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let found = std::env::split_paths(&path)
        .map(|folder| folder.join(name))
        .find(|p| p.is_file());
    if found.is_none() {
        assert!(
            std::env::var_os("STRAHL_REQUIRE_TOOLS").is_none(),
            "{name} is missing, but required"
        );
        let _ = writeln!(std::io::stderr().lock(), "SKIPPED: {name} is not installed");
    }
    found
}
