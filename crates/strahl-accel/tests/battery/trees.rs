//! The construction of the hierarchies of boxes.

use crate::hits::{Closest, Thin, answers, hit_box};
use crate::scenes::{Rng, boxes, ray};
use strahl_accel::{
    Accelerator, AcceleratorKind, AnyAccelerator, Build, BuildOptions, Bvh2, Bvh8, Bvh8Parameters,
    List, Parameters, TraversalStats,
};
use strahl_math::{Aabb, DVec3, Interval, Ray};

/// The wide tree of each builder, with primitives of three classes.
fn wide(boxes: &[Aabb]) -> Vec<Bvh8> {
    let build = |build: &Build| {
        let parameters = Bvh8Parameters {
            build: *build,
            ..Bvh8Parameters::DEFAULT
        };
        Bvh8::build_with(boxes, |id| (id % 3) as u8, &parameters)
    };
    Build::ALL.iter().map(build).collect()
}

/// The wide tree over primitives that the builders treat as thin and split.
fn cut(boxes: &[Aabb]) -> Vec<Bvh8> {
    let build = |build: &Build| {
        let parameters = Bvh8Parameters {
            build: *build,
            ..Bvh8Parameters::DEFAULT
        };
        match AnyAccelerator::build_from(AcceleratorKind::Bvh8(parameters), &Thin(boxes)) {
            AnyAccelerator::Bvh8(bvh) => bvh,
            other => panic!("built {}", other.name()),
        }
    };
    Build::ALL.iter().map(build).collect()
}

#[test]
fn thin_primitives_are_in_several_leaves() {
    let mut rng = Rng(12);
    let boxes = boxes(&mut rng, 3000, DVec3::ZERO, 1.0);
    let list = List::build(&boxes);
    let [default, fast, high] = <[Bvh8; 3]>::try_from(cut(&boxes)).expect("three builders");
    for bvh in [&default, &fast, &high] {
        assert_eq!(bvh.validate(&boxes), Ok(()));
    }
    let whole = fast.references();
    assert!(default.references() > whole + whole / 8);
    assert!(default.references() <= whole + whole * 3 / 10);
    assert!(high.references() > default.references());
    assert!(high.references() <= 3 * whole);
    for _ in 0..1000 {
        let ray = ray(&mut rng, &boxes, DVec3::ZERO, 1.0);
        if ray.direction == DVec3::ZERO {
            continue;
        }
        let expected = answers(&list, hit_box, &boxes, &ray, Interval::FORWARD);
        for bvh in [&default, &high] {
            let got = answers(bvh, hit_box, &boxes, &ray, Interval::FORWARD);
            assert_eq!(got, expected, "{ray:?}");
        }
    }
}

#[test]
fn options_change_the_tree_and_not_the_answers() {
    let mut rng = Rng(8);
    let boxes = boxes(&mut rng, 2000, DVec3::ZERO, 1.0);
    let list = List::build(&boxes);
    let rays: Vec<Ray> = (0..500)
        .map(|_| ray(&mut rng, &boxes, DVec3::ZERO, 1.0))
        .collect();
    let mut nodes = Vec::new();
    for (max_leaf_size, primitive_cost) in
        [(0, 1.0), (1, 1.0), (4, 0.1), (1000, 0.01), (8, f64::NAN)]
    {
        let options = BuildOptions {
            max_leaf_size,
            primitive_cost,
        };
        let bvh = Bvh2::build_with(&boxes, &options);
        assert_eq!(bvh.validate(&boxes), Ok(()));
        nodes.push(bvh.nodes());
        for ray in rays.iter().filter(|r| r.direction != DVec3::ZERO) {
            let [expected, got] = [
                answers(&list, hit_box, &boxes, ray, Interval::FORWARD),
                answers(&bvh, hit_box, &boxes, ray, Interval::FORWARD),
            ];
            assert_eq!(got, expected, "{options:?} {ray:?}");
        }
    }
    // Leaves of one primitive: a node for every two subtrees.
    assert_eq!(nodes[..2], [1997, 1997]);
    assert!(nodes[2] < 1997 / 2 && nodes[3] < 50, "{nodes:?}");
}

#[test]
fn degenerate_builds_are_valid() {
    let point = Aabb::new(DVec3::ONE, DVec3::ONE);
    let same = vec![point; 100_000];
    let line: Vec<Aabb> = (0..5000)
        .map(|i| {
            let p = DVec3::X * 2f64.powi(i % 250 - 125);
            Aabb::new(p, p)
        })
        .collect();
    // At the limit of culling in f32, and very small.
    let far = 2f64.powi(64);
    let extremes = [far, -far, far * 0.1, 1e-40, -1e-40, 0.0]
        .map(|x| Aabb::new(DVec3::splat(x * 0.999), DVec3::splat(x)).union(&point));
    for boxes in [
        extremes.to_vec(),
        vec![],
        vec![Aabb::EMPTY; 3],
        vec![Aabb::EVERYTHING; 3],
        vec![point],
        same,
        line,
    ] {
        let bvh = Bvh2::build(&boxes);
        assert_eq!(bvh.validate(&boxes), Ok(()));
        let expected = boxes.iter().filter(|b| !b.is_empty()).count();
        assert_eq!(bvh.references(), expected);
        for wide in wide(&boxes) {
            assert_eq!(wide.validate(&boxes), Ok(()));
            assert_eq!(wide.references(), expected);
            assert_eq!(wide.compacted().validate(&boxes), Ok(()));
        }
        for cut in cut(&boxes) {
            assert_eq!(cut.validate(&boxes), Ok(()));
            assert!(cut.references() >= expected);
        }
    }
}

#[test]
fn the_tree_does_not_depend_on_the_number_of_threads() {
    let boxes = boxes(&mut Rng(3), 30_000, DVec3::ZERO, 1.0);
    let build = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        pool.install(|| (Bvh2::build(&boxes), wide(&boxes), cut(&boxes)))
    };
    let one = build(1);
    assert_eq!(one.0.validate(&boxes), Ok(()));
    assert!(one.0.nodes() > 10_000);
    for wide in &one.1 {
        assert_eq!(wide.validate(&boxes), Ok(()));
        assert!(wide.nodes() > 1000);
    }
    for threads in [2, 5] {
        // The tree is too long to print.
        assert!(build(threads) == one, "{threads} threads");
    }
}

#[test]
fn the_hierarchy_saves_work() {
    let mut rng = Rng(4);
    let boxes: Vec<Aabb> = (0..10_000)
        .map(|_| {
            let p = rng.point();
            Aabb::new(p, p + DVec3::splat(0.01))
        })
        .collect();
    let bvh = Bvh2::build(&boxes);
    let mut stats = TraversalStats::default();
    let rays = 1000;
    for _ in 0..rays {
        let ray = Ray::new(rng.point() * 3.0, rng.point());
        let mut closest = Closest {
            hit: hit_box,
            boxes: &boxes,
            ray,
            t_min: 0.0,
            best: None,
        };
        bvh.traverse(&ray, Interval::FORWARD, &mut closest, &mut stats);
    }
    assert!(
        stats.primitive_tests < 20 * rays && stats.node_visits < 60 * rays,
        "{stats:?}"
    );
}
