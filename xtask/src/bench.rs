//! Speed against other programs: interleaved runs, medians, ratios.

use crate::arguments::Arguments;
use crate::compare_pov::picture;
use crate::convert;
use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The options for rendering SPD scenes.
const SPD: [&str; 4] = ["--max-depth", "5", "--adc-bailout", "0"];

/// Trace times of the SPD scenes at 512x512, no antialiasing, equal depth, against POV-Ray and Tachyon.
pub(crate) fn spd(args: &[&str]) -> Result<()> {
    let (mut folder, mut runs, mut threads) = (PathBuf::from("../shared/data/spd"), 5, 1);
    let mut args = Arguments::new(args);
    while let Some(option) = args.option() {
        match option {
            "--runs" => runs = args.number()?,
            "--threads" => threads = args.number()?,
            other => folder = PathBuf::from(other),
        }
    }
    if runs == 0 || threads == 0 {
        bail!("--runs and --threads must be at least 1");
    }
    let mut scenes: Vec<PathBuf> = std::fs::read_dir(&folder)
        .with_context(|| format!("cannot read {}", folder.display()))?
        .filter_map(|entry| entry.ok().map(|e| e.path()))
        .filter(|path| path.to_string_lossy().ends_with(".nff.gz"))
        .collect();
    scenes.sort();
    build_strahl()?;
    println!(
        "Trace time in seconds, {threads} thread(s), medians of {runs}; how many times as fast strahl is."
    );
    println!("| scene | strahl | Mrays/s | POV-Ray | faster by | Tachyon | faster by |");
    println!("|---|---|---|---|---|---|---|");
    let (mut povray, mut tachyon) = (vec![], vec![]);
    for scene in &scenes {
        let row = one_scene(scene, runs, threads)?;
        povray.extend(row.povray);
        tachyon.extend(row.tachyon);
    }
    println!(
        "| geometric mean | | | | {} | | {} |",
        geometric_mean(&povray),
        geometric_mean(&tachyon)
    );
    Ok(())
}

/// The geometric mean, formatted for a table.
pub(crate) fn geometric_mean(ratios: &[f64]) -> String {
    let logarithms: f64 = ratios.iter().map(|r| r.ln()).sum();
    match ratios.len() {
        0 => String::new(),
        n => format!("{:.2}", (logarithms / n as f64).exp()),
    }
}

/// How many times as fast strahl is as the other programs on a scene.
struct Faster {
    povray: Option<f64>,
    /// `None` for scenes that Tachyon can't render.
    tachyon: Option<f64>,
}

fn one_scene(scene: &Path, runs: usize, threads: u32) -> Result<Faster> {
    let folder = tempfile::tempdir()?;
    let (pov, dat) = (
        folder.path().join("scene.pov"),
        folder.path().join("scene.dat"),
    );
    convert::to_pov(scene, &pov)?;
    let has_dat = convert::to_dat(scene, &dat).is_ok();
    let (mut ours, mut povray, mut tachyon, mut rays) = (vec![], vec![], vec![], 0.0);
    for _ in 0..runs {
        let (time, count) = run_strahl(scene, &folder.path().join("out.png"), threads, &SPD)?;
        ours.push(time);
        rays = count;
        povray.push(run_povray(&pov, &folder.path().join("pov.png"), threads)?);
        if has_dat {
            tachyon.push(run_tachyon(&dat, folder.path(), threads)?);
        }
    }
    let faster = |theirs: &[f64]| {
        let mut ratios: Vec<f64> = ours.iter().zip(theirs).map(|(a, b)| b / a).collect();
        (!ratios.is_empty()).then(|| median(&mut ratios))
    };
    let faster = Faster {
        povray: faster(&povray),
        tachyon: faster(&tachyon),
    };
    let name = scene
        .file_name()
        .map(|n| n.to_string_lossy().replace(".nff.gz", ""))
        .unwrap_or_default();
    let ours = median(&mut ours);
    let peer = |times: &mut [f64], faster: Option<f64>| match faster {
        Some(faster) => format!("{:.3} | {faster:.2}", median(times)),
        None => "- | -".to_owned(),
    };
    println!(
        "| {name} | {ours:.3} | {:.2} | {} | {} |",
        rays / ours / 1e6,
        peer(&mut povray, faster.povray),
        peer(&mut tachyon, faster.tachyon),
    );
    Ok(faster)
}

/// The median.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// The mean difference of two pictures of a scene in 8-bit codes; an error if it is larger than `most`.
pub(crate) fn difference(scene: &str, pictures: [&Path; 2], most: f64) -> Result<f64> {
    let [ours, theirs] = [picture::read(pictures[0])?, picture::read(pictures[1])?];
    let (difference, _) =
        picture::compare(&ours, &theirs).context("the pictures have different sizes")?;
    if difference > most {
        bail!(
            "{scene}: the pictures differ by {difference:.2} in the mean, more than {most}; look at {} and {}",
            pictures[0].display(),
            pictures[1].display()
        );
    }
    Ok(difference)
}

/// Builds the release binary.
pub(crate) fn build_strahl() -> Result<()> {
    let status = Command::new("cargo")
        .args(["build", "--release", "--quiet", "-p", "strahl-cli"])
        .status()?;
    if !status.success() {
        bail!("strahl does not build");
    }
    Ok(())
}

/// The path of the release binary, which lies beside this program.
pub(crate) fn strahl_binary() -> Result<PathBuf> {
    let own = std::env::current_exe()?;
    Ok(own
        .parent()
        .context("the path of this program has no folder")?
        .join("strahl"))
}

/// The program that is measured on scenes.
static INSTALLED: OnceLock<PathBuf> = OnceLock::new();

/// Copies a build of the program, as `cargo install` does, and [uses](use_installed) the copy. A program as the linker has written it takes up to 5 % more
/// processor time on small pictures, because the system keeps its file in smaller pieces.
pub(crate) fn install(program: &Path) -> Result<()> {
    let copy = program.with_file_name("strahl-installed");
    // A new file: the old one would keep its pieces.
    if copy.exists() {
        std::fs::remove_file(&copy)?;
    }
    std::fs::copy(program, &copy).context("cannot copy strahl")?;
    use_installed(copy)
}

/// Makes [`installed_strahl`] return an installed program. Called at most once, as is [`install`].
pub(crate) fn use_installed(program: PathBuf) -> Result<()> {
    if INSTALLED.set(program).is_err() {
        bail!("an installed program was chosen before");
    }
    Ok(())
}

/// The path of the program that is measured on scenes.
pub(crate) fn installed_strahl() -> Result<&'static Path> {
    let program = INSTALLED.get().context("no installed program was chosen")?;
    Ok(program)
}

/// Renders a scene at 512x512 with one ray per pixel; returns the trace time in seconds and the number of rays.
pub(crate) fn run_strahl(
    scene: &Path,
    picture: &Path,
    threads: u32,
    options: &[&str],
) -> Result<(f64, f64)> {
    let stats = picture.with_extension("json");
    let status = Command::new(strahl_binary()?)
        .arg("render")
        .arg(scene)
        .args(["--size", "512x512", "--sampling", "center"])
        .args(options)
        .args(["--threads", &threads.to_string(), "--quiet", "--output"])
        .arg(picture)
        .arg("--stats")
        .arg(&stats)
        .status()
        .context("cannot run strahl")?;
    if !status.success() {
        bail!("strahl failed");
    }
    let stats: Value = serde_json::from_slice(&std::fs::read(stats)?)?;
    let time = stats["time_s"]["trace"].as_f64().context("no trace time")?;
    let rays = ["primary", "shadow", "reflection", "refraction"];
    Ok((
        time,
        rays.iter()
            .filter_map(|kind| stats["rays"][kind].as_f64())
            .sum(),
    ))
}

/// Renders a scene with POV-Ray; returns the trace time in seconds.
pub(crate) fn run_povray(scene: &Path, picture: &Path, threads: u32) -> Result<f64> {
    let output = Command::new("povray")
        .arg(format!("+I{}", scene.display()))
        .arg(format!("+O{}", picture.display()))
        .args(["+W512", "+H512", "-A", "-D", &format!("+WT{threads}")])
        .output()
        .context("cannot run povray (Debian package povray)")?;
    // "Trace Time:       0 hours  0 minutes  0 seconds (0.605 seconds)"
    seconds_in(&output.stderr, "Trace Time", '(').context("povray printed no trace time")
}

fn run_tachyon(scene: &Path, folder: &Path, threads: u32) -> Result<f64> {
    let output = Command::new("tachyon")
        .arg(scene)
        .arg("-o")
        .arg(folder.join("tachyon.tga"))
        // Mirroring in x reverses the winding of the triangles, so their normals must be flipped.
        .args(["-shade_phong", "-normalfixup", "flip", "+V"])
        .args(["-numthreads", &threads.to_string()])
        .output()
        .context("cannot run tachyon (Debian package tachyon)")?;
    // "  Ray Tracing Time:     0.0719 seconds"
    seconds_in(&output.stdout, "Ray Tracing Time", ':').context("tachyon printed no trace time")
}

/// The number of seconds after the character `before`, in the line that begins with `words`.
fn seconds_in(log: &[u8], words: &str, before: char) -> Result<f64> {
    let log = String::from_utf8_lossy(log);
    let line = log
        .lines()
        .rfind(|line| line.trim_start().starts_with(words));
    let seconds = line
        .and_then(|line| line.rsplit_once(before))
        .and_then(|(_, s)| s.split_whitespace().next()?.parse().ok());
    seconds.with_context(|| format!("no line begins with `{words}` in:\n{log}"))
}
