//! Free-form surfaces met directly against the same surfaces divided into triangles of the size of a pixel: time and memory of strahl.
//!
//! Each picture is made by a process of its own, which is this program again, so that its memory is that of one scene.

use super::shapes::{self, Surface};
use crate::arguments::Arguments;
use crate::bench::median;
use anyhow::{Context, Result, bail};
use nix::sys::resource::{UsageWho, getrusage};
use nix::sys::time::TimeValLike;
use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::Command;
use strahl::prelude::*;

/// Largest mean difference of the two pictures in 8-bit codes: the triangles have no normals but their own.
const BOUND: f64 = 2.0;
/// What comes before a cost in the output of a process.
const COST: &str = "cost ";

/// The head of the table of [`rows`].
pub(super) const HEAD: &str = "\n\
    | surface | triangles | surface s | triangles s | times as long | surface MiB | triangles MiB | times as much |\n\
    |---|---|---|---|---|---|---|---|\n";

/// What a process has used.
#[derive(Clone, Copy)]
struct Cost {
    /// Processor seconds.
    seconds: f64,
    /// The most memory that it had at a time without that of the program's own code, in MiB.
    memory: f64,
    triangles: f64,
}

/// How a surface is rendered.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    Direct,
    Triangles,
    /// The scene without it.
    Nothing,
}

const WAYS: [(&str, Way); 3] = [
    ("surface", Way::Direct),
    ("triangles", Way::Triangles),
    ("nothing", Way::Nothing),
];

/// Measures all surfaces whose names contain `only`, in turns; the rows of the table.
pub(super) fn rows(folder: &Path, runs: usize, size: (u32, u32), only: &str) -> Result<String> {
    let mut rows = String::new();
    for surface in shapes::all().iter().filter(|s| s.name().contains(only)) {
        rows += &row(surface.as_ref(), folder, runs, size)?;
    }
    Ok(rows)
}

fn row(surface: &dyn Surface, folder: &Path, runs: usize, size: (u32, u32)) -> Result<String> {
    let name = surface.name();
    let pictures: Vec<PathBuf> = WAYS
        .iter()
        .map(|(way, _)| folder.join(format!("{}-{way}.png", name.replace([' ', ','], "-"))))
        .collect();
    let mut costs = [vec![], vec![], vec![]];
    for _ in 0..runs {
        for (((way, _), picture), costs) in WAYS.iter().zip(&pictures).zip(&mut costs) {
            costs.push(process(name, way, picture, size)?);
        }
    }
    crate::bench::difference(name, [&pictures[0], &pictures[1]], BOUND)?;
    let middle = |way: usize, of: fn(&Cost) -> f64| {
        let mut all: Vec<f64> = costs[way].iter().map(of).collect();
        median(&mut all)
    };
    let seconds = [0, 1].map(|way| middle(way, |c| c.seconds));
    let memory = [0, 1].map(|way| middle(way, |c| c.memory) - middle(2, |c| c.memory));
    let mut row = String::new();
    writeln!(
        row,
        "| {name} | {} | {:.2} | {:.2} | {:.2} | {:.1} | {:.1} | {:.1} |",
        middle(1, |c| c.triangles),
        seconds[0],
        seconds[1],
        seconds[1] / seconds[0],
        memory[0],
        memory[1],
        memory[1] / memory[0],
    )?;
    Ok(row)
}

/// Renders a surface in a process of its own.
fn process(name: &str, way: &str, picture: &Path, (width, height): (u32, u32)) -> Result<Cost> {
    let output = Command::new(std::env::current_exe()?)
        .args(["bench", "objects", "--one", name, way])
        .arg(picture)
        .arg(format!("{width}x{height}"))
        .output()
        .context("this program cannot run itself")?;
    let log = String::from_utf8_lossy(&output.stdout);
    let numbers: Vec<f64> = log
        .lines()
        .find_map(|line| line.strip_prefix(COST))
        .map(|line| line.split(' ').filter_map(|n| n.parse().ok()).collect())
        .unwrap_or_default();
    let [seconds, memory, triangles] = numbers[..] else {
        bail!(
            "{name}, {way}: no picture: {}",
            String::from_utf8_lossy(&output.stderr)
        );
    };
    Ok(Cost {
        seconds,
        memory,
        triangles,
    })
}

/// What such a process does: renders, and prints what it has used.
pub(super) fn one(args: &mut Arguments<'_>) -> Result<()> {
    let (name, way) = (args.value()?, args.value()?);
    let picture = PathBuf::from(args.value()?);
    let size = crate::compare_pov::size(args.value()?)?;
    let surfaces = shapes::all();
    let found = surfaces.iter().find(|s| s.name() == name);
    let surface = found.with_context(|| format!("there is no surface `{name}`"))?;
    let found = WAYS.iter().find(|(known, _)| *known == way);
    let (_, way) = found.with_context(|| format!("there is no way `{way}`"))?;
    let triangles = render(surface.as_ref(), *way, &picture, size)?;
    let usage = getrusage(UsageWho::RUSAGE_SELF)?;
    let time = usage.user_time() + usage.system_time();
    println!(
        "{COST}{} {} {triangles}",
        time.num_microseconds() as f64 * 1e-6,
        (usage.max_rss() - mapped_files()?) as f64 / 1024.0
    );
    Ok(())
}

/// The memory that holds parts of files, in KiB: the program's own code, as far as it was needed.
fn mapped_files() -> Result<i64> {
    let status = std::fs::read_to_string("/proc/self/status").context("there is no /proc")?;
    let field = status
        .lines()
        .find_map(|line| line.strip_prefix("RssFile:"));
    let field = field.and_then(|field| field.trim().strip_suffix(" kB"));
    let field = field.context("/proc/self/status has no RssFile")?;
    Ok(field.parse()?)
}

/// Renders with one thread and one ray for each pixel; returns the number of triangles.
fn render(surface: &dyn Surface, way: Way, picture: &Path, size: (u32, u32)) -> Result<usize> {
    let mut scene = Scene::new()
        .light(Light::point(
            DVec3::new(-20.0, 30.0, 25.0),
            Color::gray(0.9),
        ))
        .light(Light::point(DVec3::new(25.0, 20.0, 5.0), Color::gray(0.3)))
        .add(Plane::new(-3.5 * DVec3::Y, DVec3::Y).material(Material::matte(Color::gray(0.6))))
        .camera(Camera::perspective(EYE, DVec3::ZERO, DVec3::Y, ANGLE));
    let material = Material::shiny(Color::new(0.8, 0.5, 0.2), 0.4, 40.0);
    let mut triangles = 0;
    match way {
        Way::Direct => scene = scene.add(Object::from(surface.shape()?).material(material)),
        Way::Triangles => {
            let mesh = surface.triangles(&|p| pixel(p, size))?;
            triangles = mesh.indices.len();
            let mesh = TriangleMesh::try_new(mesh)?;
            scene = scene.add(Object::from(mesh).material(material));
        }
        Way::Nothing => {}
    }
    let session = Session::new(Threads::Count(1))?;
    let (scene, _warnings) = session.compile(&scene, &CompileOptions::default())?;
    let view = scene.view(size.0, size.1).with_sampling(Sampling::Center);
    let mut to_the_end = |_: &Tile<'_>| ControlFlow::Continue(());
    let outcome = session.render(&view, &Output::default(), &mut to_the_end)?;
    strahl::save(picture, outcome.film(), &WriteOptions::default())?;
    Ok(triangles)
}

/// Where the camera is; it looks at the origin.
const EYE: DVec3 = DVec3::new(3.0, 5.0, 8.0);
/// Its vertical angle.
const ANGLE: f64 = 0.75;

/// The width of a pixel where a point is.
fn pixel(point: DVec3, (_, height): (u32, u32)) -> f64 {
    let depth = (EYE - point).dot(EYE.normalize());
    2.0 * (0.5 * ANGLE).tan() * depth / f64::from(height)
}
