//! Small pictures rendered by POV-Ray 3.7 and by strahl, and their differences.

use super::{each, parse_with, tool};
use std::path::Path;
use std::process::Command;
use strahl_render::{CompileOptions, RenderOptions, compile, render};
use strahl_sdl::MemoryHost;
use strahl_shade::Quality;

/// Width and height in pixels.
pub(crate) const SIZE: (u32, u32) = (64, 48);

/// Linear values of a picture, row by row.
pub(crate) type Pixels = Vec<[f64; 3]>;

/// The pixels of a PPM file with 16 bits per channel.
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

fn theirs(povray: &Path, folder: &Path, text: &str, quality: u8) -> Result<Pixels, String> {
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
            format!("+Q{quality}"),
            "File_Gamma=1.0".to_owned(),
        ])
        .output()
        .expect("the program starts");
    if !run.status.success() {
        let log = String::from_utf8_lossy(&run.stderr);
        return Err(format!("{text}\n{log}"));
    }
    let bytes = std::fs::read(folder.join("out.ppm")).expect("a picture");
    Ok(read_ppm(&bytes))
}

fn ours(text: &str, quality: u8) -> Result<Pixels, String> {
    let parsed = parse_with(&mut MemoryHost::new(), text);
    let messages: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
    let mut scene = parsed
        .scene
        .ok_or_else(|| format!("{text}\n{}", messages.join("\n")))?;
    scene.settings.quality = Quality::new(quality);
    let scene = compile(&scene, &CompileOptions::default()).map_err(|e| format!("{e:?}"))?;
    let mut options = RenderOptions::new(&scene, SIZE.0, SIZE.1);
    options.threads = 1;
    let film = render(&scene, &options).expect("a picture").film;
    let clipped = |p: &[f32; 3]| p.map(|c| f64::from(c).clamp(0.0, 1.0));
    Ok(film.pixels.iter().map(clipped).collect())
}

/// The pictures of a scene by POV-Ray and by strahl, in linear values.
///
/// # Errors
/// If one of the programs doesn't render it.
pub(crate) fn pair(povray: &Path, text: &str) -> Result<(Pixels, Pixels), String> {
    pair_at(povray, text, 9)
}

/// The same at a level of quality.
fn pair_at(povray: &Path, text: &str, quality: u8) -> Result<(Pixels, Pixels), String> {
    let folder = tempfile::tempdir().expect("a folder");
    let mut theirs = theirs(povray, folder.path(), text, quality)?;
    // Without a gamma, a scene's colours are those of the display; POV-Ray writes them unchanged.
    if !text.contains("3.7") && !text.contains("assumed_gamma") {
        for pixel in &mut theirs {
            *pixel = pixel.map(strahl_shade::srgb::decode);
        }
    }
    Ok((theirs, ours(text, quality)?))
}

/// Renders a scene with both programs; returns the mean difference of the channels and the share of pixels with a visible
/// difference.
pub(crate) fn compare(povray: &Path, text: &str) -> (f64, f64) {
    compare_at(povray, text, 9)
}

fn compare_at(povray: &Path, text: &str, quality: u8) -> (f64, f64) {
    let (a, b) = pair_at(povray, text, quality).unwrap_or_else(|why| panic!("{why}"));
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

/// Checks that the pictures of all scenes agree, except for a share `most_off` of their pixels.
pub(crate) fn agree(most_off: f64, scenes: &[(&str, String)]) {
    agree_within(0.5 / 255.0, most_off, scenes);
}

/// Checks that the pictures of all scenes have at most a mean difference `most_mean` and a share `most_off` of visibly different
/// pixels.
pub(crate) fn agree_within(most_mean: f64, most_off: f64, scenes: &[(&str, String)]) {
    agree_all(most_mean, most_off, 9, scenes);
}

/// The same as [`agree`] at a level of quality.
pub(crate) fn agree_at(quality: u8, most_off: f64, scenes: &[(&str, String)]) {
    agree_all(0.5 / 255.0, most_off, quality, scenes);
}

fn agree_all(most_mean: f64, most_off: f64, quality: u8, scenes: &[(&str, String)]) {
    let Some(povray) = tool("povray") else {
        return;
    };
    let failed = each(scenes, |(name, text)| {
        let (mean, off) = compare_at(&povray, text, quality);
        let agrees = mean < most_mean && off <= most_off;
        (!agrees).then(|| {
            format!(
                "{name} at quality {quality}: mean difference {:.3}/255, {:.2} % of pixels differ visibly",
                mean * 255.0,
                off * 100.0
            )
        })
    });
    let failed: Vec<String> = failed.into_iter().flatten().collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
