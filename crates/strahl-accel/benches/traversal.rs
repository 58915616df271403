//! The cost of accelerators over random balls: building, and rays of every kind.
//!
//! `cargo bench -p strahl-accel` runs all; `cargo bench -p strahl-accel -- 7k/bvh` one accelerator on one scene.
//! Rays are measured in batches of 65 536, so a throughput of 1 Melem/s is a million rays per second.

use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use std::{hint::black_box, time::Duration};
use strahl_accel::{Accelerator, AcceleratorKind, AnyAccelerator, TraversalStats, Visitor};
use strahl_math::{Aabb, DVec3, Interval, Ray};

/// Rays per batch: 256 x 256 pixels.
const SIDE: usize = 256;

/// SplitMix64.
struct Rng(u64);

impl Rng {
    /// In `-1..1`.
    fn signed(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }
}

struct Ball {
    center: DVec3,
    radius: f64,
}

impl Ball {
    fn bounds(&self) -> Aabb {
        let radius = DVec3::splat(self.radius);
        Aabb::new(self.center - radius, self.center + radius)
    }

    fn hit(&self, ray: &Ray, range: Interval) -> Option<f64> {
        let to_center = self.center - ray.origin;
        let square = ray.direction.length_squared();
        let middle = to_center.dot(ray.direction) / square;
        let aside = to_center - ray.direction * middle;
        let rest = self.radius * self.radius - aside.length_squared();
        if rest < 0.0 {
            return None;
        }
        let half = (rest / square).sqrt();
        [middle - half, middle + half]
            .into_iter()
            .find(|t| range.accepts(*t))
    }
}

/// A query with a ray, and its answer.
struct Query<'a> {
    balls: &'a [Ball],
    ray: &'a Ray,
    range: Interval,
    /// Whether the query is for any hit.
    any: bool,
    found: Option<f64>,
}

impl Visitor for Query<'_> {
    #[inline]
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        let range = self.range.with_max(t_max);
        match self.balls[id as usize].hit(self.ray, range) {
            Some(t) => {
                self.found = Some(t);
                if self.any { f64::NEG_INFINITY } else { t }
            }
            None => t_max,
        }
    }
}

/// Rays of one kind.
struct Workload {
    name: &'static str,
    rays: Vec<Ray>,
    range: Interval,
    any: bool,
}

/// Balls of about equal size, filling a cube.
fn random_balls(count: usize) -> Vec<Ball> {
    let mut rng = Rng(7);
    let radius = 0.25 / (count as f64).cbrt();
    (0..count)
        .map(|_| Ball {
            center: rng.point(),
            radius: radius * (0.5 + 2.0 * rng.signed().abs()),
        })
        .collect()
}

fn trace(
    accelerator: &AnyAccelerator,
    balls: &[Ball],
    ray: &Ray,
    range: Interval,
    any: bool,
) -> Option<f64> {
    let mut query = Query {
        balls,
        ray,
        range,
        any,
        found: None,
    };
    accelerator.traverse(ray, range, &mut query, &mut TraversalStats::default());
    query.found
}

/// Rays from an eye through pixels, and the rays that start at their hits.
fn workloads(accelerator: &AnyAccelerator, balls: &[Ball]) -> [Workload; 5] {
    let mut rng = Rng(8);
    let primary: Vec<Ray> = (0..SIDE * SIDE)
        .map(|i| {
            let at = |i: usize| i as f64 / SIDE as f64 * 2.4 - 1.2;
            let direction = DVec3::new(at(i % SIDE), at(i / SIDE), -2.5);
            Ray::new(DVec3::new(0.3, 0.4, 3.5), direction.normalize())
        })
        .collect();
    let points: Vec<DVec3> = primary
        .iter()
        .filter_map(|ray| {
            trace(accelerator, balls, ray, Interval::FORWARD, false).map(|t| ray.at(t))
        })
        .collect();
    // As many rays of each kind, so that the figures are comparable.
    let mut from_points = |to: &mut dyn FnMut(DVec3, DVec3) -> DVec3| -> Vec<Ray> {
        let starts = points.iter().cycle().take(SIDE * SIDE);
        starts.map(|p| Ray::new(*p, to(*p, rng.point()))).collect()
    };
    let diffuse = from_points(&mut |_, random| random);
    let short = from_points(&mut |_, random| random * 0.02);
    let shadow = from_points(&mut |p, _| DVec3::new(3.0, 5.0, 4.0) - p);
    let past = from_points(&mut |_, random| random.with_y(0.3));
    let past = past
        .into_iter()
        .map(|r| Ray::new(r.origin + DVec3::Y * 3.5, r.direction));
    // Starts slightly off the surface.
    let leaving = Interval::new(1e-9, 1.0);
    let workload = |name, rays, range, any| Workload {
        name,
        rays,
        range,
        any,
    };
    [
        workload("primary", primary, Interval::FORWARD, false),
        workload("diffuse", diffuse, leaving.with_max(f64::INFINITY), false),
        workload("shadow", shadow, leaving, true),
        workload("short", short, leaving, true),
        workload("miss", past.collect(), Interval::FORWARD, false),
    ]
}

fn traversal(c: &mut Criterion) {
    for (scene, count) in [("7k", 7000), ("600k", 600_000)] {
        let balls = random_balls(count);
        let bounds: Vec<Aabb> = balls.iter().map(Ball::bounds).collect();
        for kind in AcceleratorKind::ALL {
            if matches!(kind, AcceleratorKind::List(_)) {
                // It would take minutes and show nothing new.
                continue;
            }
            let mut group = c.benchmark_group(format!("{scene}/{kind}"));
            group
                .sample_size(10)
                .sampling_mode(SamplingMode::Flat)
                .measurement_time(Duration::from_secs(2))
                .warm_up_time(Duration::from_millis(300));
            group.throughput(Throughput::Elements(count as u64));
            group.bench_function("build", |b| {
                b.iter(|| AnyAccelerator::build(*kind, black_box(&bounds)));
            });
            let accelerator = AnyAccelerator::build(*kind, &bounds);
            for work in workloads(&accelerator, &balls) {
                group.throughput(Throughput::Elements(work.rays.len() as u64));
                group.bench_function(work.name, |b| {
                    b.iter(|| {
                        let hits = work.rays.iter().filter(|ray| {
                            trace(&accelerator, &balls, ray, work.range, work.any).is_some()
                        });
                        hits.count()
                    });
                });
            }
            group.finish();
        }
    }
}

criterion_group!(benches, traversal);
criterion_main!(benches);
