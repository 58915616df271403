//! Speed against other programs: interleaved runs, medians, ratios.

use crate::pov;
use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Trace times of the SPD scenes at 512x512, one thread, no antialiasing, equal depth, against POV-Ray.
pub(crate) fn spd(args: &[&str]) -> Result<()> {
    let (mut folder, mut runs) = (PathBuf::from("../shared/data/spd"), 5);
    let mut rest = args.iter();
    while let Some(arg) = rest.next() {
        match *arg {
            "--runs" => runs = rest.next().context("--runs needs a number")?.parse()?,
            other => folder = PathBuf::from(other),
        }
    }
    if runs == 0 {
        bail!("--runs must be at least 1");
    }
    let mut scenes: Vec<PathBuf> = std::fs::read_dir(&folder)
        .with_context(|| format!("cannot read {}", folder.display()))?
        .filter_map(|entry| entry.ok().map(|e| e.path()))
        .filter(|path| path.to_string_lossy().ends_with(".nff.gz"))
        .collect();
    scenes.sort();
    build_strahl()?;
    println!("| scene | strahl s | Mrays/s | POV-Ray s | strahl is faster by |");
    println!("|---|---|---|---|---|");
    let mut product = 1.0;
    for scene in &scenes {
        let ratio = one_scene(scene, runs)?;
        product *= ratio;
    }
    if !scenes.is_empty() {
        println!(
            "| geometric mean | | | | {:.2} |",
            product.powf(1.0 / scenes.len() as f64)
        );
    }
    Ok(())
}

fn one_scene(scene: &Path, runs: usize) -> Result<f64> {
    let folder = tempfile::tempdir()?;
    let pov_scene = folder.path().join("scene.pov");
    pov::convert(scene, &pov_scene)?;
    let (mut ours, mut theirs, mut rays) = (vec![], vec![], 0.0);
    for _ in 0..runs {
        let (time, count) = run_strahl(scene, folder.path())?;
        ours.push(time);
        rays = count;
        theirs.push(run_povray(&pov_scene, folder.path())?);
    }
    let mut ratios: Vec<f64> = ours.iter().zip(&theirs).map(|(a, b)| b / a).collect();
    let (ours, theirs, ratio) = (median(&mut ours), median(&mut theirs), median(&mut ratios));
    let name = scene
        .file_name()
        .map(|n| n.to_string_lossy().replace(".nff.gz", ""))
        .unwrap_or_default();
    println!(
        "| {name} | {ours:.3} | {:.2} | {theirs:.3} | {ratio:.2} |",
        rays / ours / 1e6
    );
    Ok(ratio)
}

/// The middle one of several values.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
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

/// The release binary beside this program.
pub(crate) fn strahl_binary() -> Result<PathBuf> {
    let own = std::env::current_exe()?;
    Ok(own
        .parent()
        .context("this program lies in a folder")?
        .join("strahl"))
}

fn run_strahl(scene: &Path, folder: &Path) -> Result<(f64, f64)> {
    let stats = folder.join("stats.json");
    let status = Command::new(strahl_binary()?)
        .arg("render")
        .arg(scene)
        .args([
            "--size",
            "512x512",
            "--sampling",
            "center",
            "--max-depth",
            "5",
            "--adc-bailout",
            "0",
        ])
        .args(["--threads", "1", "--quiet", "--output"])
        .arg(folder.join("out.png"))
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

fn run_povray(scene: &Path, folder: &Path) -> Result<f64> {
    let output = Command::new("povray")
        .arg(format!("+I{}", scene.display()))
        .arg(format!("+O{}", folder.join("pov.png").display()))
        .args(["+W512", "+H512", "+WT1", "-A", "-D"])
        .output()
        .context("cannot run povray (Debian package povray)")?;
    let log = String::from_utf8_lossy(&output.stderr);
    // "Trace Time:       0 hours  0 minutes  0 seconds (0.605 seconds)"
    let line = log
        .lines()
        .rfind(|l| l.trim_start().starts_with("Trace Time"));
    let seconds = line
        .and_then(|l| l.rsplit_once('('))
        .and_then(|(_, s)| s.split(' ').next()?.parse().ok());
    seconds.with_context(|| format!("povray printed no trace time:\n{log}"))
}
