//! Speed of single kinds of objects: processor time of strahl and POV-Ray on the same generated scenes, in turns; and time and memory
//! of free-form surfaces against their triangles.

mod limits;
mod scenes;
mod shapes;

use crate::arguments::Arguments;
use crate::bench::{Measured, geometric_mean, median};
use crate::bench_scenes::measure::{Program, Timed, render};
use anyhow::{Result, bail};
use scenes::Scene;
pub(crate) use scenes::{FINE, teapot};
use std::path::Path;

/// Largest mean difference of the two pictures in 8-bit codes: POV-Ray has facets where strahl has patches, and holes where it has terrain.
const BOUND: f64 = 6.0;
/// A program is stopped after so many seconds.
const MOST: f64 = 300.0;

/// `cargo xtask bench objects`: prints and saves a table, one row per scene.
pub(crate) fn run(args: &[&str]) -> Result<()> {
    let (mut runs, mut size, mut only) = (5, (640, 480), "");
    let mut measured = Measured::default();
    let mut args = Arguments::new(args);
    while let Some(option) = args.option() {
        match option {
            "--runs" => runs = args.number()?,
            "--size" => size = crate::compare_pov::size(args.value()?)?,
            "--only" => only = args.value()?,
            "--plain" => measured = Measured::Plain,
            "--program" => measured = Measured::Program(args.value()?.into()),
            "--one" => return limits::one(&mut args),
            other => bail!("unknown option {other}"),
        }
    }
    if runs == 0 {
        bail!("--runs must be at least 1");
    }
    measured.prepare()?;
    let folder = crate::profiled::outputs()?.join("bench-objects");
    std::fs::create_dir_all(&folder)?;
    let (width, height) = size;
    let mut table = format!(
        "Processor seconds of whole processes, one thread, one ray for each pixel, {width}x{height}, medians of {runs} in turns.\n\n\
         | scene | strahl | POV-Ray | faster by | pictures differ by |\n|---|---|---|---|---|\n"
    );
    print!("{table}");
    let mut add = |text: String| {
        print!("{text}");
        table += &text;
    };
    let mut ratios = vec![];
    for scene in scenes::all()?.iter().filter(|s| s.name.contains(only)) {
        let (row, ratio) = one_scene(scene, &folder, runs, size)?;
        add(row);
        ratios.extend(ratio.filter(|_| scene.name != scenes::EMPTY));
    }
    add(format!(
        "| geometric mean | | | {} | |\n",
        geometric_mean(&ratios)
    ));
    let limits = limits::rows(&folder, runs, size, only)?;
    if !limits.is_empty() {
        add(limits::HEAD.to_owned() + &limits);
    }
    let report = folder.join("table.md");
    std::fs::write(&report, table)?;
    println!("saved as {}", report.display());
    Ok(())
}

/// Measures a scene; returns its row, and how many times as fast strahl is. Texts and pictures stay in the folder.
fn one_scene(
    scene: &Scene,
    folder: &Path,
    runs: usize,
    size: (u32, u32),
) -> Result<(String, Option<f64>)> {
    let name = scene.name.replace([' ', ',', '(', ')', '\''], "-");
    let file = |program: Program| folder.join(format!("{name}-{}.pov", program.name()));
    let mut programs = vec![(Program::Strahl, &scene.strahl)];
    programs.extend(scene.povray.as_ref().map(|text| (Program::PovRay, text)));
    for (program, text) in &programs {
        std::fs::write(file(*program), text)?;
    }
    let picture = |program: Program| file(program).with_extension("png");
    let mut times = [vec![], vec![]];
    for _ in 0..runs {
        for ((program, _), times) in programs.iter().zip(&mut times) {
            let (scene_file, picture) = (file(*program), picture(*program));
            match render(*program, &scene_file, &picture, size, program.plain(), MOST)? {
                Timed::Seconds(seconds) => times.push(seconds),
                Timed::Failed(why) => bail!("{}: {}: {why}", scene.name, program.name()),
            }
        }
    }
    let [mut strahl, mut povray] = times;
    let mut ratios: Vec<f64> = strahl.iter().zip(&povray).map(|(a, b)| b / a).collect();
    let time = median(&mut strahl);
    if povray.is_empty() {
        let row = format!("| {} | {time:.2} | - | - | - |\n", scene.name);
        return Ok((row, None));
    }
    let [ours, theirs] = [Program::Strahl, Program::PovRay].map(picture);
    let difference = crate::bench::difference(scene.name, [&ours, &theirs], BOUND)?;
    let ratio = median(&mut ratios);
    let row = format!(
        "| {} | {time:.2} | {:.2} | {ratio:.2} | {difference:.2} |\n",
        scene.name,
        median(&mut povray)
    );
    Ok((row, Some(ratio)))
}
