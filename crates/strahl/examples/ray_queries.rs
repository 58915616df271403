//! Times the answers to many rays at once: the nearest hits, and whether something is in the way. `python/benches/rays.py` compares them with
//! those of the Python package.
//!
//! ```sh
//! cargo run --release -p strahl --example ray_queries -- scene.ply rays.f64 7
//! ```
//!
//! The file of rays has six little-endian f64 numbers for each ray: origin and direction. A line with the seconds of each run goes to
//! the standard output for both questions, and the number of rays that hit something.

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;
use strahl::prelude::*;
use strahl::{LoadOptions, load_path};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1);
    let mut path = || {
        arguments
            .next()
            .map(PathBuf::from)
            .ok_or("usage: ray_queries SCENE RAYS RUNS")
    };
    let (scene, rays, runs) = (path()?, path()?, path()?);
    let runs: usize = runs.to_string_lossy().parse()?;
    let rays = read_rays(&std::fs::read(rays)?);

    let session = Session::new(Threads::All)?;
    let (scene, _warnings) = load_path(&scene, LoadOptions::default()).into_scene()?;
    let (scene, _warnings) = session.compile(&scene, &CompileOptions::default())?;

    let mut hits = vec![None; rays.len()];
    let seconds = timed(runs, || {
        session.closest_hits(&scene, &rays, Interval::FORWARD, &mut hits);
    });
    report("intersect", &seconds, hits.iter().flatten().count());

    let mut occluded = vec![false; rays.len()];
    let seconds = timed(runs, || {
        session.occluded(&scene, &rays, Interval::FORWARD, &mut occluded);
    });
    report(
        "occluded",
        &seconds,
        occluded.iter().filter(|o| **o).count(),
    );
    Ok(())
}

fn read_rays(bytes: &[u8]) -> Vec<Ray> {
    let (numbers, _) = bytes.as_chunks::<8>();
    let numbers: Vec<f64> = numbers.iter().map(|b| f64::from_le_bytes(*b)).collect();
    let (rays, _) = numbers.as_chunks::<6>();
    let ray = |&[x, y, z, u, v, w]: &[f64; 6]| Ray::new(DVec3::new(x, y, z), DVec3::new(u, v, w));
    rays.iter().map(ray).collect()
}

/// The seconds of each run; one before them warms up.
fn timed(runs: usize, mut ask: impl FnMut()) -> Vec<f64> {
    ask();
    let run = |_| {
        let start = Instant::now();
        ask();
        start.elapsed().as_secs_f64()
    };
    (0..runs).map(run).collect()
}

#[expect(clippy::print_stdout, reason = "it is a program")]
fn report(question: &str, seconds: &[f64], hits: usize) {
    let seconds: Vec<String> = seconds.iter().map(f64::to_string).collect();
    println!("{question} {hits} {}", seconds.join(" "));
}
