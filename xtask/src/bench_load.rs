//! Compares the time to read large files with the time to build the accelerator.

use crate::arguments::Arguments;
use crate::bench::{build_strahl, median, strahl_binary};
use crate::lab;
use anyhow::{Context, Result, bail};
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Reads a landscape of `2 side²` triangles in every format that has meshes or lists of triangles, and two NFF scenes.
pub(crate) fn run(args: &[&str]) -> Result<()> {
    let (mut runs, mut side) = (5, 2236);
    let mut args = Arguments::new(args);
    while let Some(option) = args.option() {
        match option {
            "--runs" => runs = args.number()?,
            "--side" => side = args.number()?,
            other => bail!("unknown option {other}"),
        }
    }
    if runs == 0 || !(1..=10_000).contains(&side) {
        bail!("--runs must be at least 1, --side from 1 to 10000");
    }
    build_strahl()?;
    let binary = strahl_binary()?;
    let folder = binary
        .ancestors()
        .nth(2)
        .context("strahl is not in a folder of target/")?
        .join("bench-load");
    fs::create_dir_all(&folder)?;
    let mut table = String::from(
        "| file | MB | read s | MB/s | build s | read / build |\n|---|---|---|---|---|---|\n",
    );
    for path in scenes(&folder, &Landscape { side }, ["10", "7"])? {
        let megabytes = fs::metadata(&path)?.len() as f64 / 1e6;
        let times: Vec<(f64, f64)> = (0..runs)
            .map(|_| times(&binary, &path))
            .collect::<Result<_>>()?;
        let mut reads: Vec<f64> = times.iter().map(|t| t.0).collect();
        let mut builds: Vec<f64> = times.iter().map(|t| t.1).collect();
        let mut ratios: Vec<f64> = times.iter().map(|(read, build)| read / build).collect();
        let read = median(&mut reads);
        writeln!(
            table,
            "| {} | {megabytes:.0} | {read:.2} | {:.0} | {:.2} | {:.2} |",
            path.file_name().unwrap_or_default().display(),
            megabytes / read,
            median(&mut builds),
            median(&mut ratios),
        )?;
    }
    println!("{table}");
    let report = folder.join("table.md");
    fs::write(&report, table)?;
    println!("saved as {}", report.display());
    Ok(())
}

/// The seconds for reading and for building, as strahl reports them.
fn times(binary: &Path, scene: &Path) -> Result<(f64, f64)> {
    let out = tempfile::tempdir()?;
    let stats = out.path().join("stats.json");
    let status = Command::new(binary)
        .arg("render")
        .arg(scene)
        .args(["--size", "16x16", "--quiet", "-o"])
        .arg(out.path().join("picture.png"))
        .arg("--stats")
        .arg(&stats)
        .status()?;
    if !status.success() {
        bail!("{} does not render", scene.display());
    }
    let stats: serde_json::Value = serde_json::from_slice(&fs::read(stats)?)?;
    let number = |path: &str| {
        let number = stats.pointer(path).and_then(serde_json::Value::as_f64);
        number.with_context(|| format!("the statistics have no {path}"))
    };
    Ok((number("/time_s/load")?, number("/accelerator/build_s")?))
}

/// A landscape of 20,000 triangles in every format, two NFF scenes with some thousands of triangles and spheres; returns the paths.
pub(crate) fn small_scenes(folder: &Path) -> Result<Vec<PathBuf>> {
    scenes(folder, &Landscape { side: 100 }, ["6", "4"])
}

fn scenes(
    folder: &Path,
    landscape: &Landscape,
    [tetra, flake]: [&'static str; 2],
) -> Result<Vec<PathBuf>> {
    type Write<'a> = &'a dyn Fn(&mut BufWriter<File>) -> Result<()>;
    let generated = |what: &'static str, levels: &'static str| {
        move |out: &mut BufWriter<File>| {
            Ok(out.write_all(lab::generate(what, Some(levels))?.as_bytes())?)
        }
    };
    let (tetra, flake) = (generated("tetra", tetra), generated("sphereflake", flake));
    let files: [(&str, Write<'_>); 6] = [
        ("landscape.ply", &|out| landscape.ply(out)),
        ("landscape-ascii.ply", &|out| landscape.ascii(out)),
        ("landscape.obj", &|out| landscape.obj(out)),
        ("landscape.nff", &|out| landscape.nff(out)),
        ("tetra.nff", &tetra),
        ("sphereflake.nff", &flake),
    ];
    files
        .into_iter()
        .map(|(name, write)| {
            let path = folder.join(name);
            let mut out = BufWriter::new(File::create(&path)?);
            write(&mut out)?;
            out.flush()?;
            Ok(path)
        })
        .collect()
}

/// Hills with rough ground, over `side²` squares of two triangles.
struct Landscape {
    side: u32,
}

impl Landscape {
    fn positions(&self) -> impl Iterator<Item = [f32; 3]> {
        let points = self.side + 1;
        (0..points * points).map(move |i| Self::position([i % points, i / points]))
    }

    fn position(at: [u32; 2]) -> [f32; 3] {
        let [x, y] = at.map(f64::from);
        // Pseudorandom bits that are the same in every run.
        let mixed = (at[0] ^ at[1].rotate_left(16)).wrapping_mul(0x9e37_79b1);
        let rough =
            f64::from((mixed ^ mixed >> 15).wrapping_mul(0x85eb_ca6b) >> 12) / f64::from(1 << 20);
        let height = 20.0 * (x / 37.0).sin() * (y / 53.0).cos() + 2.0 * rough;
        [x, y, height].map(|x| ((x * 1e5).round() / 1e6) as f32)
    }

    fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        let (side, points) = (self.side, self.side + 1);
        (0..side * side).flat_map(move |i| {
            let corner = i / side * points + i % side;
            [
                [corner, corner + 1, corner + points + 1],
                [corner, corner + points + 1, corner + points],
            ]
        })
    }

    fn header(&self, out: &mut impl Write, format: &str) -> Result<()> {
        writeln!(out, "ply\nformat {format} 1.0")?;
        writeln!(out, "element vertex {}", self.positions().count())?;
        writeln!(out, "property float x\nproperty float y\nproperty float z")?;
        writeln!(out, "element face {}", self.triangles().count())?;
        writeln!(out, "property list uchar int vertex_indices\nend_header")?;
        Ok(())
    }

    fn ply(&self, out: &mut impl Write) -> Result<()> {
        self.header(out, "binary_little_endian")?;
        for x in self.positions().flatten() {
            out.write_all(&x.to_le_bytes())?;
        }
        for triangle in self.triangles() {
            out.write_all(&[3])?;
            for vertex in triangle {
                out.write_all(&vertex.to_le_bytes())?;
            }
        }
        Ok(())
    }

    fn ascii(&self, out: &mut impl Write) -> Result<()> {
        self.header(out, "ascii")?;
        for [x, y, z] in self.positions() {
            writeln!(out, "{x} {y} {z}")?;
        }
        for [a, b, c] in self.triangles() {
            writeln!(out, "3 {a} {b} {c}")?;
        }
        Ok(())
    }

    fn obj(&self, out: &mut impl Write) -> Result<()> {
        for [x, y, z] in self.positions() {
            writeln!(out, "v {x} {y} {z}")?;
        }
        for triangle in self.triangles() {
            let [a, b, c] = triangle.map(|vertex| vertex + 1);
            writeln!(out, "f {a} {b} {c}")?;
        }
        Ok(())
    }

    fn nff(&self, out: &mut impl Write) -> Result<()> {
        let middle = f64::from(self.side) / 20.0;
        writeln!(
            out,
            "v\nfrom {middle} -{middle} {middle}\nat {middle} {middle} 0\nup 0 0 1\nangle 60\nhither 1\n\
             resolution 512 512\nl {middle} -{middle} {}\nf 0.6 0.5 0.3 1 0 0 0 0",
            3.0 * middle
        )?;
        let points = self.side + 1;
        for triangle in self.triangles() {
            writeln!(out, "p 3")?;
            for vertex in triangle {
                let [x, y, z] = Self::position([vertex % points, vertex / points]);
                writeln!(out, "{x} {y} {z}")?;
            }
        }
        Ok(())
    }
}
