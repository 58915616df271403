//! Seams and silhouettes as a camera at a zoom of a million sees them: rays 3.6e-8 units apart, which is the width of a pixel if an angle of
//! 40 degrees over a million is 100 pixels wide and the shape is 5 units away.

use super::{Prism, PrismSweep, SphereSweep, Spline, SweepSpline};
use crate::conformance::Random;
use crate::{Lemon, Ovus, PrimHit, Scratch, Solid};
use strahl_math::{DVec2, DVec3, Interval, Ray, det};

/// The distance of neighbouring rays.
const PIXEL: f64 = 3.6e-8;
/// Rays to each side of the middle one.
const SIDE: i32 = 40;

/// A closed outline with eleven corners, as each kind of spline wants its points.
fn outline(spline: Spline) -> Vec<DVec2> {
    let corner = |k: i32| {
        let angle = f64::from(k) * std::f64::consts::TAU / 11.0;
        let radius = if k.rem_euclid(2) == 0 { 1.0 } else { 0.8 };
        DVec2::new(radius * det::cos(angle), radius * det::sin(angle))
    };
    let corner = |k: i32| corner(k.rem_euclid(11));
    match spline {
        Spline::Linear => (0..=11).map(corner).collect(),
        Spline::Quadratic => (-1..=11).map(corner).collect(),
        Spline::Cubic => (-1..=12).map(corner).collect(),
        Spline::Bezier => (0..11)
            .flat_map(|k| {
                let (a, b) = (corner(k), corner(k + 1));
                let bend = DVec2::new(b.y - a.y, a.x - b.x) * 0.2;
                [a, a + (b - a) * 0.3 + bend, a + (b - a) * 0.6 - bend, b]
            })
            .collect(),
    }
}

fn shapes() -> Vec<(String, Box<dyn Solid>)> {
    let mut all: Vec<(String, Box<dyn Solid>)> = vec![
        (
            "lemon".to_owned(),
            Box::new(Lemon::new(-DVec3::Y, 0.0, DVec3::Y, 0.0, 1.5)),
        ),
        (
            "cut lemon".to_owned(),
            Box::new(Lemon::new(-DVec3::Y, 0.4, DVec3::Y * 0.8, 0.25, 1.3)),
        ),
        ("ovus".to_owned(), Box::new(Ovus::new(0.8, 0.5))),
        (
            "ovus, pointed below".to_owned(),
            Box::new(Ovus::new(0.6, 1.0)),
        ),
    ];
    for spline in [
        Spline::Linear,
        Spline::Quadratic,
        Spline::Cubic,
        Spline::Bezier,
    ] {
        for sweep in [PrismSweep::Linear, PrismSweep::Conic] {
            let prism = Prism::try_new(spline, sweep, [0.4, 1.0], &outline(spline), false);
            let name = format!("prism {spline:?} {sweep:?}");
            all.push((name, Box::new(prism.expect("a prism"))));
        }
    }
    let spheres = [
        (DVec3::new(-1.0, -0.4, 0.1), 0.3),
        (DVec3::new(-0.5, 0.3, -0.2), 0.25),
        (DVec3::new(0.1, 0.1, 0.3), 0.35),
        (DVec3::new(0.6, -0.2, 0.0), 0.2),
        (DVec3::new(0.9, 0.5, -0.1), 0.3),
    ];
    for spline in [
        SweepSpline::Linear,
        SweepSpline::Cubic,
        SweepSpline::BSpline,
    ] {
        let sweep = SphereSweep::try_new(spline, &spheres).expect("a sweep");
        all.push((format!("sphere_sweep {spline:?}"), Box::new(sweep)));
    }
    all
}

fn first(shape: &dyn Solid, ray: &Ray, scratch: &mut Scratch) -> Option<PrimHit> {
    shape.closest_hit(ray, Interval::FORWARD, None, scratch)
}

#[test]
fn seams_have_no_gaps_and_no_speckles() {
    let mut scratch = Scratch::default();
    for (name, shape) in shapes() {
        let (mut random, mut seams) = (Random::new(11), 0);
        for _ in 0..4000 {
            // Two parallel rays that meet different pieces, and the border between them by halving.
            let bounds = shape.bounds();
            let target = bounds.center() + random.cube() * bounds.size() * 0.5;
            let way = random.direction();
            let aside = way.any_orthonormal_vector() * 0.05;
            let ray = |s: f64| Ray::new(target + aside * s - way * 5.0, way);
            let piece = |s: f64, scratch: &mut Scratch| {
                first(&*shape, &ray(s), scratch).map(|hit| hit.surface)
            };
            let (mut low, mut high) = (0.0, 1.0);
            let (Some(a), Some(b)) = (piece(low, &mut scratch), piece(high, &mut scratch)) else {
                continue;
            };
            if a == b {
                continue;
            }
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                *if piece(middle, &mut scratch) == Some(a) {
                    &mut low
                } else {
                    &mut high
                } = middle;
            }
            let pixel = PIXEL / aside.length();
            let fan: Vec<(i32, f64)> = (-SIDE..=SIDE)
                .filter(|k| *k != 0)
                .filter_map(|k| {
                    let ray = ray(low + f64::from(k) * pixel);
                    let hit = first(&*shape, &ray, &mut scratch)?;
                    let normal = shape.surface_at(&ray, &hit).n_geom;
                    (normal.dot(way).abs() > 0.1).then_some((k, hit.t))
                })
                .collect();
            // The outline of the shape, or a piece seen at a low angle.
            if fan.len() < 2 * SIDE as usize {
                let gaps = fan
                    .windows(2)
                    .filter(|pair| pair[1].0 - pair[0].0 > 2)
                    .count();
                assert!(gaps <= 1, "{name}: {fan:?}");
                continue;
            }
            seams += 1;
            // One jump where a piece hides another; elsewhere depth changes by some pixels at most.
            let jumps = fan
                .windows(2)
                .filter(|pair| (pair[1].1 - pair[0].1).abs() > 40.0 * PIXEL)
                .count();
            assert!(jumps <= 1, "{name}: {jumps} jumps along {way}: {fan:?}");
            for (k, t) in fan {
                let ray = ray(low + f64::from(k) * pixel);
                let (before, behind) = (ray.at(t - 1e-9), ray.at(t + 1e-9));
                let right = !shape.contains(before) && shape.contains(behind);
                assert!(right, "{name}: {ray:?} at {t}, pixel {k}");
            }
        }
        let is_one_piece = name == "lemon";
        assert!(seams > 20 || is_one_piece, "{name}: {seams} seams");
    }
}

#[test]
fn silhouettes_have_one_border() {
    let mut scratch = Scratch::default();
    for (name, shape) in shapes() {
        let (mut random, mut borders) = (Random::new(12), 0);
        for _ in 0..1500 {
            let bounds = shape.bounds();
            let target = bounds.center() + random.cube() * bounds.size() * 0.5;
            let way = random.direction();
            let ray = Ray::new(target - way * 5.0, way);
            let Some(hit) = first(&*shape, &ray, &mut scratch) else {
                continue;
            };
            let surface = shape.surface_at(&ray, &hit);
            let normal = surface.n_geom;
            let along = normal
                .cross(random.direction())
                .normalize_or(normal.any_orthonormal_vector());
            // A little of the ray around the point, from outside of the shape or from within.
            let range = Interval::new(5.0 - 1e-2, 5.0 + 1e-2);
            let fan: Vec<bool> = (-SIDE..=SIDE)
                .map(|k| {
                    let origin = surface.position + normal * (f64::from(k) * PIXEL) - along * 5.0;
                    shape.any_hit(&Ray::new(origin, along), range, None, &mut scratch)
                })
                .collect();
            let changes = fan.windows(2).filter(|pair| pair[0] != pair[1]).count();
            borders += usize::from(changes == 1);
            // Where the surface is nearly flat, the deepest rays are within the shape for the whole range, and meet nothing again.
            let deepest = surface.position - normal * (f64::from(SIDE) * PIXEL);
            let dives = changes == 2 && !fan[0] && shape.contains(deepest);
            assert!(
                changes <= 1 || dives,
                "{name}: {along} at {surface:?}: {fan:?}"
            );
        }
        // Along flat walls no ray is near for long.
        assert!(borders > 20, "{name}: {borders}");
    }
}
