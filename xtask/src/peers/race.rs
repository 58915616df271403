//! Compares the tracing time: the programs take turns on the rays of a batch.

use super::embree::{EmbreeScene, RayHit16};
use super::rays::{Batch, Kind};
use super::{Plan, Table};
use crate::bench::median;
use std::ops::Range;
use std::time::Instant;
use strahl::accel::TraversalStats;
use strahl::prelude::RenderScene;
use strahl::tracing::{Hit, Intersector, PACKET, RayClass};

/// A program and how it traces.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Program {
    Ours,
    /// strahl with packets of sixteen rays.
    OurPackets,
    /// Embree with one of its settings.
    Embree(usize),
    /// Embree with packets of sixteen rays and its first setting.
    EmbreePackets,
}

/// How many times as fast strahl was as Embree.
pub(super) struct Ratios {
    pub(super) kind: Kind,
    pub(super) single: f64,
    pub(super) packets: Option<f64>,
}

/// The results of a program.
#[derive(Clone, Default)]
struct Answers {
    /// The distances of closest hits.
    distances: Vec<f32>,
    /// The number of rays with any hit.
    hits: usize,
    cost: TraversalStats,
}

/// Lets the programs take turns on a batch; returns how many times as fast strahl was as Embree.
pub(super) fn compare(
    name: &str,
    ours: &RenderScene,
    theirs: &[EmbreeScene<'_>],
    batch: &Batch,
    plan: &Plan<'_>,
    table: &mut Table,
) -> Ratios {
    let mut programs = vec![Program::Ours];
    programs.extend((0..theirs.len()).map(Program::Embree));
    if !plan.brief || batch.kind.in_tiles() {
        programs.extend([Program::OurPackets, Program::EmbreePackets]);
    }
    // Packets are packed before timing, because a program that uses Embree would generate them in this form.
    let sixteens: Vec<RayHit16> = batch
        .segments
        .chunks_exact(PACKET)
        .map(RayHit16::of)
        .collect();
    let mut times = vec![vec![]; programs.len()];
    let mut answers = vec![Answers::default(); programs.len()];
    for round in 0..plan.rounds {
        for turn in 0..programs.len() {
            // The order rotates, so that every program runs after every other one.
            let number = (round + turn) % programs.len();
            let start = Instant::now();
            let parts = in_parts(batch.segments.len(), plan.threads, |part| {
                trace(programs[number], ours, theirs, batch, &sixteens, part)
            });
            times[number].push(start.elapsed().as_secs_f64());
            answers[number] = joined(parts);
        }
    }
    let index_of = |program| programs.iter().position(|p| *p == program);
    let answers_of = |program| index_of(program).map(|i| &answers[i]);
    let alone = answers_of(Program::Ours).cloned().unwrap_or_default();
    if let Some(together) = answers_of(Program::OurPackets) {
        assert!(
            alone.hits == together.hits && alone.distances == together.distances,
            "packets find what single rays find"
        );
    }
    let theirs = answers_of(Program::Embree(0)).cloned().unwrap_or_default();
    let close = |a: f32, b: f32| a == b || (a - b).abs() <= 1e-4 * a.abs();
    let pairs = alone.distances.iter().zip(&theirs.distances);
    let differ = alone.hits.abs_diff(theirs.hits) + pairs.filter(|(a, b)| !close(**a, **b)).count();

    let times_of = |program| index_of(program).map(|i| &times[i]);
    let faster = |program, peer| {
        let pairs = times_of(program)?.iter().zip(times_of(peer)?);
        Some(median(&mut pairs.map(|(a, b)| b / a).collect::<Vec<f64>>()))
    };
    let rays = batch.segments.len();
    let speed = |program| {
        let median = times_of(program).map(|t| median(&mut t.clone()));
        median.map_or(String::new(), |m| format!("{:.1}", rays as f64 / 1e6 / m))
    };
    let ratio = faster(Program::Ours, Program::Embree(0)).unwrap_or(f64::NAN);
    let of_packets = faster(Program::OurPackets, Program::EmbreePackets);
    let others = [
        speed(Program::Embree(1)),
        speed(Program::Embree(2)),
        speed(Program::OurPackets),
        speed(Program::EmbreePackets),
        of_packets.map_or(String::new(), |r| format!("{r:.2}")),
    ]
    .join(" | ");
    let per_ray = |n: u64| n as f64 / rays as f64;
    table.line(format!(
        "| {name} | {} | {} | {} | {ratio:.2} | {:.1} | {:.1} | {others} | {differ} of {rays} |",
        batch.kind.name(),
        speed(Program::Ours),
        speed(Program::Embree(0)),
        per_ray(alone.cost.node_visits),
        per_ray(alone.cost.primitive_tests),
    ));
    Ratios {
        kind: batch.kind,
        single: ratio,
        packets: of_packets,
    }
}

/// Runs a job for parts of a list, each in its own thread; parts begin at multiples of the packet size.
fn in_parts<T: Send>(
    count: usize,
    threads: usize,
    job: impl Fn(Range<usize>) -> T + Sync,
) -> Vec<T> {
    if threads == 1 {
        return vec![job(0..count)];
    }
    let size = count.div_ceil(threads).next_multiple_of(PACKET);
    let job = &job;
    std::thread::scope(|scope| {
        let parts = (0..count).step_by(size).map(|start| {
            let part = start..count.min(start + size);
            scope.spawn(move || job(part))
        });
        // All threads must be started before the first is joined.
        let parts: Vec<_> = parts.collect();
        parts
            .into_iter()
            .filter_map(|part| part.join().ok())
            .collect()
    })
}

/// Joins the results of all parts.
fn joined(parts: Vec<Answers>) -> Answers {
    let mut all = Answers::default();
    for part in parts {
        all.distances.extend(part.distances);
        all.hits += part.hits;
        all.cost += part.cost;
    }
    all
}

/// Traces a part of the rays with a program.
fn trace(
    program: Program,
    ours: &RenderScene,
    theirs: &[EmbreeScene<'_>],
    batch: &Batch,
    sixteens: &[RayHit16],
    part: Range<usize>,
) -> Answers {
    let any = batch.kind.any();
    let mut answers = Answers::default();
    let segments = &batch.segments[part.clone()];
    match program {
        Program::Ours => {
            let mut tracer = Intersector::new(ours);
            for (ray, from) in batch.rays(part) {
                if any {
                    answers.hits += usize::from(tracer.any_opaque(ray, batch.range, from));
                } else {
                    let class = RayClass::Secondary;
                    let hit = tracer.closest_hit(ray, batch.range, from, class);
                    answers.distances.push(distance(hit));
                }
            }
            answers.cost = tracer.stats;
        }
        Program::OurPackets => {
            let mut tracer = Intersector::new(ours);
            for first in part.clone().step_by(PACKET) {
                let rays = &batch.rays[first..part.end.min(first + PACKET)];
                let from = std::array::from_fn(|lane| batch.starts.get(first + lane));
                if any {
                    let found = tracer.any_opaques(rays, batch.range, &from);
                    answers.hits += found.count_ones() as usize;
                } else {
                    let mut closest = [None; PACKET];
                    let class = RayClass::Secondary;
                    tracer.closest_hits(rays, batch.range, &from, class, &mut closest);
                    let closest = closest.into_iter().take(rays.len());
                    answers.distances.extend(closest.map(distance));
                }
            }
        }
        Program::Embree(setting) if any => answers.hits = theirs[setting].occluded(segments),
        Program::Embree(setting) => theirs[setting].closest(segments, &mut answers.distances),
        Program::EmbreePackets => {
            let packets = &sixteens[part.start / PACKET..part.end / PACKET];
            std::hint::black_box(theirs[0].packets(packets, any));
        }
    }
    answers
}

/// The distance of a hit as Embree reports it: f32, infinite for none.
fn distance(hit: Option<Hit>) -> f32 {
    hit.map_or(f32::INFINITY, |h| h.t as f32)
}
