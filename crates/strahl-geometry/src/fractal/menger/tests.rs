use super::*;
use crate::Cuboid;
use crate::conformance::Random;

fn sponge(level: u32) -> Menger {
    Menger::try_new(DVec3::NEG_ONE, DVec3::ONE, level).expect("a sponge")
}

crate::primitive_tests!(one_box, || sponge(0));
crate::primitive_tests!(first, || sponge(1));
crate::primitive_tests!(third, || sponge(3));
crate::primitive_tests!(tall, || Menger::try_new(
    DVec3::new(-0.3, -1.0, 0.2),
    DVec3::new(0.4, 1.1, 1.0),
    2
)
.expect("a sponge"));

/// The cells of a level as boxes.
fn boxes(level: u32) -> Vec<Cuboid> {
    let mut cells = vec![[0_u64; 3]];
    for _ in 0..level {
        cells = cells
            .iter()
            .flat_map(|cell| children().map(|c| [0, 1, 2].map(|k| 3 * cell[k] + c[k])))
            .collect();
    }
    let sponge = sponge(level);
    let corner = |cell: [u64; 3], by: u64| {
        DVec3::from_array([0, 1, 2].map(|k| sponge.plane(k, cell[k] + by, level)))
    };
    cells
        .into_iter()
        .map(|cell| Cuboid::new(corner(cell, 0), corner(cell, 1)))
        .collect()
}

#[test]
fn it_is_the_union_of_its_boxes() {
    let mut random = Random::new(3);
    let mut scratch = Scratch::default();
    for level in [1, 2] {
        let (sponge, boxes) = (sponge(level), boxes(level));
        assert_eq!(boxes.len(), 20_usize.pow(level));
        for _ in 0..2000 {
            let ray = Ray::new(random.cube() * 3.0, random.direction());
            let hit = sponge.closest_hit(&ray, Interval::FORWARD, None, &mut scratch);
            let inside = boxes.iter().any(|b| b.contains(ray.origin));
            assert_eq!(sponge.contains(ray.origin), inside, "{ray:?}");
            if inside {
                continue;
            }
            let nearest = boxes
                .iter()
                .filter_map(|b| b.closest_hit(&ray, Interval::FORWARD, None, &mut scratch))
                .map(|hit| hit.t)
                .fold(f64::INFINITY, f64::min);
            let found = hit.map_or(f64::INFINITY, |hit| hit.t);
            let off = (found - nearest).abs();
            assert!(found == nearest || off < 1e-14, "{ray:?} {found} {nearest}");
        }
    }
}

#[test]
fn planes_are_the_same_numbers_on_all_levels() {
    let sponge = Menger::try_new(DVec3::new(-0.1, 0.3, 7.0), DVec3::new(0.7, 1e3, 7.1), 20);
    let sponge = sponge.expect("a sponge");
    let mut random = Random::new(5);
    for _ in 0..5000 {
        let level = 1 + random.below(10) as u32;
        let deeper = level + random.below(u64::from(20 - level)) as u32;
        let k = random.below(3_u64.pow(level) + 1);
        for axis in 0..3 {
            let here = sponge.plane(axis, k, level);
            let there = sponge.plane(axis, k * 3_u64.pow(deeper - level), deeper);
            assert_eq!(
                here.to_bits(),
                there.to_bits(),
                "{axis} {k} {level} {deeper}"
            );
        }
    }
}

#[test]
fn the_deepest_sponge_has_its_volume_and_thin_walls() {
    let mut random = Random::new(9);
    // Of each level 20 of 27 parts are left.
    let sponge = sponge(6);
    let inside = (0..20_000)
        .filter(|_| sponge.contains(random.cube()))
        .count();
    let share = (20.0_f64 / 27.0).powi(6);
    assert!((inside as f64 / 20_000.0 - share).abs() < 0.015, "{inside}");

    let deep = self::sponge(20);
    let mut scratch = Scratch::default();
    let mut hits = 0;
    for _ in 0..2000 {
        let target = random.cube();
        let ray = Ray::new(target - random.direction() * 4.0, DVec3::ZERO);
        let ray = Ray::new(ray.origin, target - ray.origin);
        let Some(hit) = deep.closest_hit(&ray, Interval::FORWARD, None, &mut scratch) else {
            continue;
        };
        hits += 1;
        // A cell of the last level is 6e-10 wide; before the hit it is empty, behind it is not.
        let normal = deep.surface_at(&ray, &hit).n_geom;
        let point = deep.surface_at(&ray, &hit).position;
        assert!(deep.contains(point - normal * 1e-10), "{ray:?} {hit:?}");
        assert!(!deep.contains(point + normal * 1e-10), "{ray:?} {hit:?}");
        assert!(deep.contains(point), "{ray:?} {hit:?}");
    }
    assert!(hits > 1500, "{hits}");
}

#[test]
fn a_ray_that_starts_on_a_face_leaves_that_face_only() {
    let sponge = sponge(2);
    let mut scratch = Scratch::default();
    // Through the front face, beside the hole: the next face is the back of the same box.
    let ray = Ray::new(DVec3::new(-0.95, -0.95, -3.0), DVec3::Z);
    let mut all = vec![];
    sponge.all_hits(&ray, Interval::FORWARD, None, &mut scratch, &mut all);
    let expected: Vec<f64> = vec![2.0, 4.0];
    assert_eq!(all.iter().map(|hit| hit.t).collect::<Vec<_>>(), expected);
    let first = all[0];
    for off in [-1e-15, 0.0, 1e-15] {
        let inwards = Ray::new(DVec3::new(-0.95, -0.95, -1.0 + off), DVec3::Z);
        let from = Some(first.surface);
        let hit = sponge.closest_hit(&inwards, Interval::FORWARD, from, &mut scratch);
        assert!((hit.expect("the back").t - 2.0).abs() < 1e-14);
        let outwards = Ray::new(inwards.origin, -DVec3::Z);
        let hit = sponge.closest_hit(&outwards, Interval::FORWARD, from, &mut scratch);
        assert_eq!(hit, None);
    }
}

#[test]
fn what_is_no_sponge_is_refused() {
    let make = |corner: DVec3, level| Menger::try_new(corner, DVec3::ZERO, level);
    assert!(make(DVec3::ONE, 20).is_ok());
    assert!(make(DVec3::ONE, 21).is_err());
    assert!(make(DVec3::new(1.0, 0.0, 1.0), 2).is_err());
    assert!(make(DVec3::splat(f64::NAN), 2).is_err());
    assert!(make(DVec3::splat(f64::INFINITY), 2).is_err());
}
