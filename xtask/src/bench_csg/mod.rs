//! Speed of CSG against POV-Ray: both programs read the same generated scenes and take turns.

mod scenes;

use crate::arguments::Arguments;
use crate::bench::{build_strahl, geometric_mean, median, run_povray, run_strahl, strahl_binary};
use anyhow::{Context, Result, bail};
use scenes::Scene;
use std::fmt::Write as _;
use std::path::Path;

/// Largest mean difference of the two pictures in 8-bit codes: single pixels at edges may differ.
const BOUND: f64 = 0.5;

/// Prints and saves a table of trace times, one row per scene.
pub(crate) fn run(args: &[&str]) -> Result<()> {
    let (mut runs, mut threads, mut only) = (5, 1, "");
    let mut args = Arguments::new(args);
    while let Some(option) = args.option() {
        match option {
            "--runs" => runs = args.number()?,
            "--threads" => threads = args.number()?,
            "--only" => only = args.value()?,
            other => bail!("unknown option {other}"),
        }
    }
    if runs == 0 || threads == 0 {
        bail!("--runs and --threads must be at least 1");
    }
    build_strahl()?;
    let folder = strahl_binary()?
        .ancestors()
        .nth(2)
        .context("strahl is not in target/release")?
        .join("bench-csg");
    std::fs::create_dir_all(&folder)?;
    let mut table = format!(
        "Trace time in seconds, {threads} thread(s), medians of {runs}; how many times as fast strahl is.\n\n\
         | scene | strahl | Mrays/s | POV-Ray | faster by | pictures differ by |\n|---|---|---|---|---|---|\n"
    );
    print!("{table}");
    let mut ratios = vec![];
    for scene in scenes::all().iter().filter(|s| s.name.contains(only)) {
        let row = one_scene(scene, &folder, runs, threads, &mut ratios)?;
        print!("{row}");
        table += &row;
    }
    let last = format!("| geometric mean | | | | {} | |\n", geometric_mean(&ratios));
    print!("{last}");
    table += &last;
    let report = folder.join(format!("table-{threads}.md"));
    std::fs::write(&report, table)?;
    println!("saved as {}", report.display());
    Ok(())
}

/// Measures a scene and returns its row. The scene's text and both pictures stay in the folder.
fn one_scene(
    scene: &Scene,
    folder: &Path,
    runs: usize,
    threads: u32,
    all: &mut Vec<f64>,
) -> Result<String> {
    let name = scene.name.replace([' ', ','], "-");
    let [file, ours, theirs] =
        [".pov", ".png", "-povray.png"].map(|end| folder.join(format!("{name}{end}")));
    std::fs::write(&file, &scene.text)?;
    let (mut strahl, mut povray, mut rays) = (vec![], vec![], 0.0);
    for _ in 0..runs {
        let (time, count) = run_strahl(&file, &ours, threads, &[])?;
        strahl.push(time);
        rays = count;
        povray.push(run_povray(&file, &theirs, threads)?);
    }
    let difference = crate::bench::difference(scene.name, [&ours, &theirs], BOUND)?;
    let mut ratios: Vec<f64> = strahl.iter().zip(&povray).map(|(a, b)| b / a).collect();
    let (ratio, time) = (median(&mut ratios), median(&mut strahl));
    all.push(ratio);
    let mut row = String::new();
    writeln!(
        row,
        "| {} | {time:.3} | {:.2} | {:.3} | {ratio:.2} | {difference:.2} |",
        scene.name,
        rays / time / 1e6,
        median(&mut povray),
    )?;
    Ok(row)
}
