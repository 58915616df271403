//! Rays aimed exactly at the borders of patches: none may slip through, none may meet two patches.

use super::tests::{Points, hits, in_parts};
use super::*;
use crate::Primitive;
use crate::conformance::Random;
use strahl_math::{DVec3, Interval, Ray};

/// A closed surface like a pillow or a ball: rings of patches around an axis, with both ends collapsed, out of round. Every other
/// patch has its parameters turned, so that common borders run in different directions.
fn ball(rings: usize, around: usize, random: &mut Random) -> Vec<BicubicPatch> {
    let mut grid = vec![vec![DVec3::ZERO; 3 * around]; 3 * rings + 1];
    for (j, row) in grid.iter_mut().enumerate() {
        let latitude = std::f64::consts::PI * (j as f64 / (3 * rings) as f64 - 0.5);
        let end = j == 0 || j == 3 * rings;
        for (i, p) in row.iter_mut().enumerate() {
            let longitude = std::f64::consts::TAU * i as f64 / (3 * around) as f64;
            let on_sphere = DVec3::new(
                latitude.cos() * longitude.cos(),
                latitude.sin(),
                latitude.cos() * longitude.sin(),
            );
            *p = on_sphere + random.cube() * 0.05;
            if end {
                *p = DVec3::new(0.02, latitude.sin(), -0.03);
            }
        }
    }
    let mut patches = vec![];
    for ring in 0..rings {
        for k in 0..around {
            let at = |j: usize, i: usize| grid[3 * ring + j][(3 * k + i) % (3 * around)];
            let points: Points = std::array::from_fn(|j| {
                std::array::from_fn(|i| match (ring + k) % 4 {
                    0 => at(j, i),
                    1 => at(i, j),
                    2 => at(3 - j, i),
                    _ => at(3 - i, 3 - j),
                })
            });
            patches.push(BicubicPatch::try_new(points).unwrap());
        }
    }
    patches
}

/// A border point of a patch: a corner, a simple fraction or anything.
fn border_point(patch: &BicubicPatch, random: &mut Random) -> [f64; 2] {
    let x = match random.below(4) {
        0 => 0.0,
        1 => 0.5,
        2 => random.below(8) as f64 / 8.0,
        _ => random.unit(),
    };
    let _ = patch;
    match random.below(4) {
        0 => [x, 0.0],
        1 => [1.0, x],
        2 => [x, 1.0],
        _ => [0.0, x],
    }
}

/// Rays from within and through a closed surface, aimed at borders to the last bit. A ray from within leaves the surface
/// an odd number of times, the whole line an even number of times; the sum with signs is exactly that of the winding
/// numbers.
fn shoot(rays: usize, seed: u64) -> [usize; 3] {
    let mut random = Random::new(seed);
    let mut wrong = [0; 3];
    let mut patches = vec![];
    for round in 0..rays {
        if round % 20_000 == 0 {
            patches = ball(2 + (round / 20_000 + seed as usize) % 2, 3, &mut random);
        }
        let patch = &patches[random.below(patches.len() as u64) as usize];
        let [u, v] = border_point(patch, &mut random);
        let [target, ..] = patch.bezier.jet(u, v);
        let origin = match random.below(3) {
            0 => DVec3::ZERO,
            _ => random.cube() * 0.3,
        };
        let direction = (target - origin) * random.between(0.1, 10.0);
        let ray = Ray::new(origin, direction);
        let mut near = 0;
        let (mut forward, mut line) = (0, 0);
        for patch in &patches {
            let bounds = patch.bounds();
            if bounds
                .padded(DVec3::splat(1e-6))
                .clip(&ray, Interval::LINE)
                .is_none()
            {
                continue;
            }
            for hit in hits(patch, &ray) {
                line += 1;
                forward += usize::from(hit.t > 0.0);
                let off = (ray.at(hit.t) - target).length();
                near += usize::from(off < 1e-7);
            }
        }
        // A crack, a double hit, an odd line.
        wrong[0] += usize::from(near == 0);
        wrong[1] += usize::from(near > 1 && near % 2 == 0 || forward % 2 == 0);
        wrong[2] += usize::from(line % 2 == 1);
    }
    wrong
}

#[test]
fn no_ray_slips_through_a_border_or_meets_two_patches() {
    assert_eq!(in_parts(100_000, 1, shoot), [0; 3]);
}

/// The long version, for releases: 10^7 rays on all processors, 100 minutes of processor time. Passed on 2026-11-29.
#[test]
#[ignore = "takes more than an hour; run it with --ignored"]
fn no_ray_of_ten_millions_slips_through_a_border() {
    assert_eq!(in_parts(10_000_000, 2, shoot), [0; 3]);
}
