//! All accelerators give the same answers.

use crate::hits::{Balls, Hit, answers, hit_box, hit_sphere};
use crate::kinds;
use crate::scenes::{Rng, boxes, ray};
use proptest::prelude::*;
use strahl_accel::{AcceleratorKind, AnyAccelerator, Boxes, Bvh8, List, Shapes};
use strahl_math::{Aabb, DVec3, Interval, Ray};
use strahl_simd::Simd;

/// The factor of the usual number of rays: `STRAHL_BATTERY=20 cargo test --release` traces more than a million for each
/// structure.
pub(crate) fn effort() -> usize {
    let asked = std::env::var("STRAHL_BATTERY").ok();
    asked.map_or(1, |n| n.parse().expect("STRAHL_BATTERY is a number"))
}

/// Compares every accelerator with the list for many rays; returns the numbers of rays and of hits.
fn compare(
    rng: &mut Rng,
    hit: Hit,
    count: usize,
    offset: DVec3,
    scale: f64,
    rays: usize,
) -> (usize, usize) {
    let boxes = boxes(rng, count, offset, scale);
    if boxes.iter().all(|b| !b.is_bounded()) {
        return (0, 0);
    }
    let list = List::build(&boxes);
    let balls = Balls(&boxes);
    // If the primitives are balls, the builders may use that.
    let exact = std::ptr::fn_addr_eq(hit, hit_sphere as Hit);
    let shapes: &dyn Shapes = if exact { &balls } else { &Boxes(&boxes) };
    let mut others: Vec<(AcceleratorKind, AnyAccelerator)> = kinds()
        .into_iter()
        .map(|kind| (kind, AnyAccelerator::build_from(kind, shapes)))
        .collect();
    let classes = Bvh8::build(&boxes, |id| (id % 5 / 2) as u8);
    assert_eq!(classes.validate(&boxes), Ok(()));
    for simd in Simd::available() {
        let wide = classes.clone().with_simd(simd);
        let compact = wide.clone().compacted();
        assert_eq!(compact.validate(&boxes), Ok(()));
        for wide in [wide, compact].map(AnyAccelerator::Bvh8) {
            others.push((AcceleratorKind::default(), wide));
        }
    }
    let (mut compared, mut hits) = (0, 0);
    for _ in 0..rays * effort() {
        let ray = ray(rng, &boxes, offset, scale);
        if ray.direction == DVec3::ZERO || !ray.direction.is_finite() {
            continue;
        }
        let range = match rng.below(5) {
            0 => Interval::UNTIL_LIGHT,
            1 => Interval::new(0.5, 1.0),
            2 => Interval::LINE,
            _ => Interval::FORWARD,
        };
        let expected = answers(&list, hit, &boxes, &ray, range);
        hits += usize::from(expected.1);
        compared += 1;
        for (kind, other) in &others {
            let got = answers(other, hit, &boxes, &ray, range);
            assert_eq!(
                got, expected,
                "{kind} {count} {offset} {scale} {ray:?} {range:?}"
            );
        }
    }
    (compared, hits)
}

#[test]
fn all_accelerators_agree_with_the_list() {
    let mut rng = Rng(1);
    let (mut rays, mut hits) = (0, 0);
    for round in 0..60 {
        let scale = [1.0, 1e-6, 1e6][round % 3];
        let offset = [
            DVec3::ZERO,
            DVec3::new(1e3, -50.0, 7.0),
            DVec3::new(1e9, -1e9, 1e9),
        ][round / 3 % 3]
            * scale;
        let count = [1, 2, 30, 100, 300][round % 5];
        let (r, h) = compare(&mut rng, hit_box, count, offset, scale, 1000);
        rays += r;
        hits += h;
    }
    assert!(rays > 50_000 * effort() && hits > rays / 4, "{rays} {hits}");
}

#[test]
fn they_agree_on_spheres_inside_the_boxes() {
    let mut rng = Rng(5);
    let (mut rays, mut hits) = (0, 0);
    for round in 0..10 {
        let scale = [1.0, 1e-6, 1e6][round % 3];
        let (r, h) = compare(&mut rng, hit_sphere, 100, DVec3::ZERO, scale, 1000);
        rays += r;
        hits += h;
    }
    assert!(rays > 5_000 && hits > rays / 8, "{rays} {hits}");
}

/// Scales at which f32 underflows, at which products of coordinates overflow f32, and at the limits of f32.
#[test]
fn they_agree_on_scenes_at_the_ends_of_f32() {
    let mut rng = Rng(6);
    let (mut rays, mut hits) = (0, 0);
    for scale in [
        1e-50, 1e-44, 1e-40, 1e-37, 1e-30, 1e-20, 1e15, 1.5e19, 1e25, 1e37, 3e38, 1e50,
    ] {
        let (r, h) = compare(&mut rng, hit_box, 50, DVec3::ZERO, scale, 1000);
        rays += r;
        hits += h;
    }
    assert!(rays > 8_000 && hits > rays / 8, "{rays} {hits}");
}

/// Directions whose length is any power of two, subnormal numbers included.
#[test]
fn they_agree_on_directions_of_any_length() {
    let boxes: Vec<Aabb> = (0..20)
        .map(|i| {
            let corner = DVec3::new(f64::from(i % 5), f64::from(i / 5), 0.0);
            Aabb::new(corner, corner + DVec3::splat(0.75))
        })
        .collect();
    let list = List::build(&boxes);
    let others: Vec<(AcceleratorKind, AnyAccelerator)> = kinds()
        .into_iter()
        .map(|kind| (kind, AnyAccelerator::build(kind, &boxes)))
        .collect();
    let mut hits = 0;
    for exponent in -1070..1023 {
        let length = 2f64.powi(exponent.max(-1000)) * 2f64.powi(exponent.min(-1000) + 1000);
        let ray = Ray::new(
            DVec3::new(-1.0, 0.5, 0.5) * 0.01,
            DVec3::new(1.0, 0.5, 0.125) * length,
        );
        for range in [Interval::FORWARD, Interval::new(0.0, 2.0 / length)] {
            let expected = answers(&list, hit_box, &boxes, &ray, range);
            hits += usize::from(expected.1);
            for (kind, accelerator) in &others {
                let got = answers(accelerator, hit_box, &boxes, &ray, range);
                assert_eq!(got, expected, "{kind} 2^{exponent} {range:?}");
            }
        }
    }
    assert!(hits > 4000, "{hits}");
}

#[test]
fn hostile_rays_are_harmless() {
    let mut rng = Rng(2);
    let boxes = boxes(&mut rng, 100, DVec3::ZERO, 1.0);
    let values = [
        0.0,
        -0.0,
        1.0,
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e308,
        5e-324,
    ];
    for kind in kinds() {
        let accelerator = AnyAccelerator::build(kind, &boxes);
        for _ in 0..5000 {
            let mut any = || {
                DVec3::new(
                    values[rng.below(8)],
                    values[rng.below(8)],
                    values[rng.below(8)],
                )
            };
            let ray = Ray::new(any(), any());
            // It must not panic, and must not find a hit that the list does not find.
            let found = answers(&accelerator, hit_box, &boxes, &ray, Interval::FORWARD);
            if let Some((t, _)) = found.0 {
                assert!(t > 0.0);
            }
        }
    }
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![-2.0..2.0f64, (-8i32..8).prop_map(|i| f64::from(i) / 4.0)]
}

fn point() -> impl Strategy<Value = DVec3> {
    (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

proptest! {
    /// The same on small scenes, with shrinking.
    #[test]
    fn small_scenes_agree_with_the_list(
        corners in prop::collection::vec((point(), point()), 1..12),
        origin in point(),
        direction in point(),
    ) {
        let boxes: Vec<Aabb> = corners.into_iter().map(|(a, b)| Aabb::from_points([a, b])).collect();
        let ray = Ray::new(origin, direction);
        prop_assume!(direction != DVec3::ZERO);
        let expected = answers(&List::build(&boxes), hit_box, &boxes, &ray, Interval::FORWARD);
        for kind in kinds() {
            let got = answers(&AnyAccelerator::build(kind, &boxes), hit_box, &boxes, &ray, Interval::FORWARD);
            prop_assert_eq!(got, expected, "{}", kind);
        }
    }
}
