//! Compares the time to build: both programs build the same scene, in turns.

use super::embree::{EmbreeScene, Options, Quality};
use super::{Plan, Table};
use crate::bench::median;
use anyhow::{Context, Result};
use std::fs;
use std::time::Instant;
use strahl::prelude::*;
use strahl::tracing::Prepared;

/// A scene built by both programs.
pub(super) struct Built<'e> {
    pub(super) ours: RenderScene,
    pub(super) theirs: EmbreeScene<'e>,
}

/// Builds a scene with this many primitives with both programs, as often as the plan says.
pub(super) fn race<'e>(
    name: &str,
    scene: &Scene,
    count: usize,
    build: &dyn Fn(Options) -> Result<EmbreeScene<'e>>,
    plan: &Plan<'_>,
    table: &mut Table,
) -> Result<Built<'e>> {
    let medium = Options {
        quality: Quality::Medium,
        robust: false,
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(plan.threads)
        .build()?;
    let prepared = Prepared::new(scene)?;
    let (mut our_times, mut their_times) = (vec![], vec![]);
    let mut built = None;
    for _ in 0..plan.builds {
        // Only one pair is in memory at a time.
        drop(built.take());
        let prepared = prepared.clone();
        let (ours, time) = timed(|| pool.install(|| prepared.build(plan.accelerator)));
        our_times.push(time);
        let (theirs, time) = timed(|| build(medium));
        their_times.push(time);
        let theirs = theirs?;
        built = Some(Built { ours, theirs });
    }
    let built = built.context("--builds must be at least 1")?;
    let (our_time, their_time) = (median(&mut our_times), median(&mut their_times));
    let stats = built.ours.stats();
    table.line(format!(
        "| {name} | build, s | {our_time:.3} | {their_time:.3} | {:.2} | {:.1} + {:.1} bytes each | | | | | | | |",
        their_time / our_time,
        stats.accelerator_bytes as f64 / count as f64,
        stats.geometry_bytes as f64 / count as f64,
    ));
    Ok(built)
}

/// Returns the result of a job and the processor seconds of all its threads; the wall time on systems that don't report them.
fn timed<T>(job: impl FnOnce() -> T) -> (T, f64) {
    let (start, before) = (Instant::now(), processor_time());
    let result = job();
    let took = start.elapsed().as_secs_f64();
    let time = before.zip(processor_time()).map(|(a, b)| b - a);
    (result, time.unwrap_or(took))
}

/// Processor seconds that the threads of this process have used; only Linux reports them.
fn processor_time() -> Option<f64> {
    // Linux updates the time of a running thread when it yields.
    std::thread::yield_now();
    let mut nanoseconds = 0.0;
    for task in fs::read_dir("/proc/self/task").ok()? {
        let text = fs::read_to_string(task.ok()?.path().join("schedstat")).ok()?;
        nanoseconds += text.split(' ').next()?.parse::<f64>().ok()?;
    }
    Some(nanoseconds * 1e-9)
}
