//! Small pictures rendered by POV-Ray 3.7 and here, and how far they are apart.

use super::{parse_with, tool};
use std::path::Path;
use std::process::Command;
use strahl_render::{CompileOptions, RenderOptions, compile, render};
use strahl_sdl::MemoryHost;

/// Width and height in pixels.
const SIZE: (u32, u32) = (64, 48);

/// Linear values of a picture, row by row.
type Pixels = Vec<[f64; 3]>;

/// The pixels of a PPM file with 16 bits per channel: what its header leaves.
fn read_ppm(bytes: &[u8]) -> Pixels {
    let size = SIZE.0 as usize * SIZE.1 as usize * 6;
    assert!(bytes.starts_with(b"P6") && bytes.len() > size);
    let numbers: Vec<f64> = bytes[bytes.len() - size..]
        .chunks_exact(2)
        .map(|b| f64::from(u16::from_be_bytes([b[0], b[1]])) / 65535.0)
        .collect();
    numbers
        .chunks_exact(3)
        .map(|c| [c[0], c[1], c[2]])
        .collect()
}

fn theirs(povray: &Path, folder: &Path, text: &str) -> Pixels {
    let scene = folder.join("scene.pov");
    std::fs::write(&scene, text).expect("writable");
    let (w, h) = SIZE;
    let run = Command::new(povray)
        .current_dir(folder)
        .args([
            "+Iscene.pov",
            "+Oout.ppm",
            "+FP16",
            "-A",
            "-D",
            "-GA",
            "+WT1",
        ])
        .args([
            format!("+W{w}"),
            format!("+H{h}"),
            "File_Gamma=1.0".to_owned(),
        ])
        .output()
        .expect("the program starts");
    let log = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success(), "{text}\n{log}");
    read_ppm(&std::fs::read(folder.join("out.ppm")).expect("a picture"))
}

fn ours(text: &str) -> Pixels {
    let parsed = parse_with(&mut MemoryHost::new(), text);
    let messages: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
    let scene = parsed
        .scene
        .unwrap_or_else(|| panic!("{text}\n{}", messages.join("\n")));
    let scene = compile(&scene, &CompileOptions::default()).expect("a scene");
    let mut options = RenderOptions::new(&scene, SIZE.0, SIZE.1);
    options.threads = 1;
    let film = render(&scene, &options, &()).expect("a picture").film;
    let clipped = |p: &[f32; 3]| p.map(|c| f64::from(c).clamp(0.0, 1.0));
    film.pixels.iter().map(clipped).collect()
}

/// The same of a scene whose colours are the screen's: POV-Ray then writes them as they are.
fn theirs_encoded(povray: &Path, folder: &Path, text: &str) -> Pixels {
    let decoded = |p: [f64; 3]| p.map(strahl_shade::srgb::decode);
    theirs(povray, folder, text)
        .into_iter()
        .map(decoded)
        .collect()
}

/// Renders by both; the mean difference of channels, and the share of pixels with a visible difference.
pub(crate) fn compare(povray: &Path, text: &str) -> (f64, f64) {
    let folder = tempfile::tempdir().expect("a folder");
    let encoded = !text.contains("3.7") && !text.contains("assumed_gamma");
    let read = if encoded { theirs_encoded } else { theirs };
    let (a, b) = (read(povray, folder.path(), text), ours(text));
    assert_eq!(a.len(), b.len());
    let count = a.len() as f64;
    let (mut sum, mut off) = (0.0, 0);
    let mut lit = 0.0;
    for (p, q) in a.iter().zip(&b) {
        let differences = [0, 1, 2].map(|c| (p[c] - q[c]).abs());
        sum += differences.iter().sum::<f64>() / 3.0;
        off += usize::from(differences.iter().any(|d| *d > 4.0 / 255.0));
        lit += p.iter().sum::<f64>();
    }
    assert!(lit > 0.0, "a black picture shows nothing: {text}");
    (sum / count, off as f64 / count)
}

/// All of these must agree but for `most_off` of their pixels.
pub(crate) fn agree(most_off: f64, scenes: &[(&str, String)]) {
    agree_within(0.5 / 255.0, most_off, scenes);
}

/// All of these must agree but for so much on the mean and for `most_off` of their pixels.
pub(crate) fn agree_within(most_mean: f64, most_off: f64, scenes: &[(&str, String)]) {
    let Some(povray) = tool("povray") else {
        return;
    };
    let mut failed = vec![];
    for (name, text) in scenes {
        let (mean, off) = compare(&povray, text);
        if !(mean < most_mean && off <= most_off) {
            failed.push(format!(
                "{name}: mean difference {:.3}/255, {:.2} % of pixels differ visibly",
                mean * 255.0,
                off * 100.0
            ));
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
