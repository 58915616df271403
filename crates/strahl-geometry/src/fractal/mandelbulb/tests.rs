use super::*;
use crate::conformance::Random;

fn bulb(power: u32, iterations: u32) -> Mandelbulb {
    Mandelbulb::try_new(power, None, iterations, 20.0).expect("a mandelbulb")
}

// Few iterations: more have folds that are closer to each other, and bend more, than the battery's steps allow.
crate::primitive_tests!(eight, || bulb(8, 1));
crate::primitive_tests!(two, || bulb(2, 3));
crate::primitive_tests!(three, || bulb(3, 2));
crate::primitive_tests!(julia_of_three, || Mandelbulb::try_new(
    3,
    Some(DVec3::new(0.5, 0.2, -0.3)),
    2,
    20.0
)
.expect("a Julia set"));

#[test]
fn all_points_of_a_decided_ball_are_on_the_same_side() {
    let mut random = Random::new(4);
    for set in [
        bulb(2, 6),
        bulb(8, 6),
        Mandelbulb::try_new(5, Some(DVec3::new(0.4, -0.3, 0.5)), 6, 20.0).expect("a Julia set"),
    ] {
        let (mut inside, mut outside) = (0, 0);
        for _ in 0..4000 {
            let center = random.cube() * set.search.radius;
            let radius = random.magnitude(-3.0, -1.0);
            if !set.is_decided(center, radius) {
                continue;
            }
            let is_in = set.value(center) < 0.0;
            *if is_in { &mut inside } else { &mut outside } += 1;
            for _ in 0..60 {
                let p = center + random.direction() * radius * random.unit();
                assert_eq!(set.value(p) < 0.0, is_in, "{set:?} {center} {radius} {p}");
            }
        }
        assert!(inside > 30 && outside > 500, "{inside} {outside}");
    }
}

#[test]
fn the_sets_shrink_and_know_famous_points() {
    let mut random = Random::new(5);
    for power in [2, 3, 8] {
        let sets = [1, 2, 4, 8].map(|iterations| bulb(power, iterations));
        for _ in 0..5000 {
            let p = random.cube() * 1.3;
            let inside: Vec<bool> = sets.iter().map(|set| set.contains(p)).collect();
            assert!(
                inside.windows(2).all(|pair| pair[0] || !pair[1]),
                "{p} {inside:?}"
            );
        }
        assert!(sets[3].contains(DVec3::ZERO));
    }
    // On the z axis the square is that of the complex numbers: -2 is the end of the Mandelbrot set, 1/4 its cusp.
    let many = bulb(2, 60);
    for (z, inside) in [(-2.01, false), (-1.99, true), (0.24, true), (0.3, false)] {
        assert_eq!(many.contains(DVec3::Z * z), inside, "{z}");
    }
}

#[test]
fn no_part_is_missed_that_small_steps_find() {
    let set = Mandelbulb::try_new(8, None, 4, 200.0).expect("a mandelbulb");
    let (mut random, mut scratch) = (Random::new(6), Scratch::default());
    let (mut compared, mut later) = (0, 0);
    for _ in 0..200 {
        let ray = Ray::new(random.direction() * 2.0, DVec3::ZERO);
        let ray = Ray::new(ray.origin, random.cube() * 0.9 - ray.origin);
        let hit = set.closest_hit(&ray, Interval::FORWARD, None, &mut scratch);
        let first = (0..20_000_u32)
            .map(|k| f64::from(k) / 10_000.0)
            // Two steps are longer than the least step of the search.
            .find(|t| set.contains(ray.at(*t)) && set.contains(ray.at(t + 1e-4)));
        if let Some(first) = first {
            compared += 1;
            let found = hit.map_or(f64::INFINITY, |hit| hit.t);
            later += usize::from(found > first);
        }
    }
    assert!(compared > 150 && later == 0, "{later} of {compared}");
}

#[test]
fn what_is_no_mandelbulb_is_refused() {
    let make =
        |power, parameter, iterations| Mandelbulb::try_new(power, parameter, iterations, 20.0);
    assert!(make(8, None, 8).is_ok());
    assert!(make(1, None, 8).is_err());
    assert!(make(17, None, 8).is_err());
    assert!(make(8, None, 0).is_err());
    assert!(make(8, Some(DVec3::NAN), 8).is_err());
}
