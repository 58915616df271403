//! Measures how the cost of a ray grows with the size of the scene, for each accelerator.

use super::generate::generate;
use super::plot::{Plot, Series};
use crate::bench::{build_strahl, strahl_binary};
use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// The scenes of the series: name, levels.
const SCENES: [(&str, &[u32]); 2] = [("sphereflake", &[3, 4, 5, 6]), ("tetra", &[5, 6, 7, 8, 9])];

/// The accelerators compared.
const KINDS: [&str; 7] = ["list", "spheres", "bvh2", "bvh", "grid", "grids", "octree"];

const HEADER: &str =
    "scene,primitives,accelerator,build_s,bytes,steps_per_ray,tests_per_ray,us_per_ray";

/// Measures the series and writes the table.
pub(crate) fn measure(output: &Path, size: &str) -> Result<()> {
    build_strahl()?;
    let folder = tempfile::tempdir()?;
    let mut table = format!("{HEADER}\n");
    for (name, levels) in SCENES {
        for level in levels {
            let scene = folder.path().join(format!("{name}{level}.nff"));
            std::fs::write(&scene, generate(name, Some(&level.to_string()))?)?;
            let primitives = primitives(&scene)?;
            eprintln!("{name}: {primitives} primitives");
            let mut command = Command::new(strahl_binary()?);
            command.arg("compare").arg(&scene).args(["--size", size]);
            command.args(["--sampling", "center", "--json", "--runs", "3"]);
            for kind in KINDS {
                command.args(["--with", kind]);
            }
            let done = command.output().context("cannot run strahl")?;
            if !done.status.success() {
                bail!("strahl compare: {}", String::from_utf8_lossy(&done.stderr));
            }
            let rows: Vec<Value> = serde_json::from_slice(&done.stdout)?;
            for row in &rows {
                let number = |key: &str| row[key].as_f64().unwrap_or(f64::NAN);
                table += &format!(
                    "{name},{primitives},{},{:.6},{},{:.4},{:.4},{:.4}\n",
                    row["accelerator"].as_str().unwrap_or_default(),
                    number("build_s"),
                    number("bytes"),
                    number("steps_per_ray"),
                    number("tests_per_ray"),
                    1e6 / number("rays_per_s"),
                );
            }
            // The table is written after every scene, so that a failure on a larger scene loses nothing.
            std::fs::write(output, &table)?;
        }
    }
    Ok(())
}

fn primitives(scene: &Path) -> Result<usize> {
    let text = std::fs::read_to_string(scene)?;
    let statements = text.lines();
    Ok(statements
        .filter(|l| l.starts_with("s ") || l.starts_with("p "))
        .count())
}

/// Draws the table: for each scene a plot of the work per ray and one of the time per ray.
pub(crate) fn plot_growth(table: &Path, folder: &Path) -> Result<()> {
    let text = std::fs::read_to_string(table)
        .with_context(|| format!("cannot read {}", table.display()))?;
    let rows: Vec<Vec<&str>> = text
        .lines()
        .skip(1)
        .map(|l| l.split(',').collect())
        .collect();
    for (scene, _) in SCENES {
        for (file, title, value) in [
            (
                "work",
                "nodes or cells visited + primitives tested, per ray",
                work as Column,
            ),
            ("time", "microseconds per ray", time as Column),
        ] {
            let mut series = Vec::new();
            for kind in KINDS {
                let mut points = Vec::new();
                for row in &rows {
                    if let [of, n, accelerator, ..] = row.as_slice()
                        && *of == scene
                        && *accelerator == kind
                    {
                        points.push((n.parse()?, value(row)?));
                    }
                }
                if !points.is_empty() {
                    series.push(Series { name: kind, points });
                }
            }
            let plot = Plot {
                title: &format!("{scene}: {title}"),
                x_axis: "primitives",
                series: &series,
            };
            let path = folder.join(format!("growth-{scene}-{file}.svg"));
            std::fs::write(&path, plot.svg())
                .with_context(|| format!("cannot write {}", path.display()))?;
        }
    }
    Ok(())
}

/// Reads a number from a row of the table.
type Column = fn(&[&str]) -> Result<f64>;

fn work(row: &[&str]) -> Result<f64> {
    Ok(field(row, 5)? + field(row, 6)?)
}

fn time(row: &[&str]) -> Result<f64> {
    field(row, 7)
}

fn field(row: &[&str], index: usize) -> Result<f64> {
    let text = row.get(index).context("the table has too few columns")?;
    Ok(text.parse()?)
}
