use super::*;

fn three() -> Blob {
    Blob::new(
        0.6,
        vec![
            BlobComponent::sphere(DVec3::new(0.75, 0.0, 0.0), 1.0, 1.0),
            BlobComponent::sphere(DVec3::new(-0.375, 0.65, 0.0), 1.0, 1.0),
            BlobComponent::sphere(DVec3::new(-0.375, -0.65, 0.0), 1.0, 1.2),
        ],
    )
}

fn capsules() -> Blob {
    let stretch = Transform::try_scale(DVec3::new(1.4, 0.8, 1.0)).expect("regular");
    Blob::new(
        0.5,
        vec![
            BlobComponent::cylinder(DVec3::NEG_X, DVec3::X, 0.7, 1.0),
            BlobComponent::cylinder(DVec3::NEG_Y, DVec3::Y, 0.5, 0.9)
                .transformed(&Transform::rotate(DVec3::new(1.0, 0.3, 0.2), 0.7).then(&stretch)),
            BlobComponent::sphere(DVec3::new(0.2, 0.3, 0.5), 0.8, -0.7),
            BlobComponent::sphere(DVec3::ZERO, 0.9, 0.8).transformed(&stretch),
        ],
    )
}

/// Components enough for a hierarchy.
fn many(count: u32) -> Blob {
    let mut random = crate::conformance::Random::new(77);
    let components = (0..count).map(|i| {
        let center = random.cube() * 1.2;
        let radius = random.between(0.4, 0.8);
        match i % 5 {
            0 => BlobComponent::cylinder(center, random.cube(), radius, 0.8),
            1 => BlobComponent::sphere(center, radius, -0.5),
            _ => BlobComponent::sphere(center, radius, 1.0),
        }
    });
    Blob::new(0.5, components.collect())
}

crate::primitive_tests!(one_ball, || Blob::new(
    0.5,
    vec![BlobComponent::sphere(DVec3::ZERO, 1.0, 1.0)]
));
crate::primitive_tests!(three_balls, three);
crate::primitive_tests!(stretched_capsules, capsules);
crate::primitive_tests!(forty, || many(40));

/// A single ball is bounded by its own surface, not by its field; overlapping ones are, where they reach furthest.
#[test]
fn boxes_end_near_the_surface() {
    let one = Blob::new(0.25, vec![BlobComponent::sphere(DVec3::X, 2.0, 1.0)]);
    let r = 2.0 * 0.5f64.sqrt();
    assert!((one.bounds().min - (DVec3::X - r)).abs().max_element() < 1e-9);
    assert!((one.bounds().max - (DVec3::X + r)).abs().max_element() < 1e-9);
    assert_eq!(one.reach().size().round(), DVec3::splat(4.0));
    for blob in [three(), capsules(), many(40)] {
        let (tight, reach) = (blob.bounds(), blob.reach());
        assert!(tight.size().cmplt(reach.size()).all() && tight.union(&reach) == reach);
    }
}

fn crossings(shape: &Blob, ray: &Ray) -> Vec<f64> {
    let mut out = Crossings::default();
    shape.crossings(ray, Interval::LINE, None, &mut Scratch::default(), &mut out);
    out.list.iter().map(|c| c.hit.t).collect()
}

#[test]
fn a_single_ball_is_a_sphere() {
    // strength (1 - r²)² = threshold.
    let radius = f64::sqrt(1.0 - f64::sqrt(0.5));
    let blob = Blob::new(1.0, vec![BlobComponent::sphere(DVec3::ONE, 2.0, 2.0)]);
    let found = crossings(&blob, &Ray::new(DVec3::new(1.0, -9.0, 1.0), DVec3::Y));
    assert_eq!(found.len(), 2);
    assert!(
        (found[0] - (10.0 - 2.0 * radius)).abs() < 1e-14,
        "{found:?}"
    );
    assert!(
        (found[1] - (10.0 + 2.0 * radius)).abs() < 1e-14,
        "{found:?}"
    );
}

#[test]
fn a_capsule_is_a_cylinder_with_half_balls() {
    let radius = f64::sqrt(1.0 - f64::sqrt(0.5));
    let capsule = BlobComponent::cylinder(DVec3::ZERO, DVec3::X * 3.0, 1.0, 1.0);
    let blob = Blob::new(0.5, vec![capsule]);
    let along = crossings(&blob, &Ray::new(DVec3::X * -5.0, DVec3::X));
    let expected = [5.0 - radius, 8.0 + radius];
    assert!(
        along
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() < 1e-14)
    );
    for x in [0.0, 0.1, 1.7, 3.0] {
        let across = crossings(&blob, &Ray::new(DVec3::new(x, -2.0, 0.0), DVec3::Y));
        let expected = [2.0 - radius, 2.0 + radius];
        assert_eq!(across.len(), 2);
        assert!(
            across
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-14)
        );
    }
}

#[test]
fn the_hierarchy_changes_nothing() {
    let tree = many(30);
    assert!(matches!(tree.index, Index::Tree(_)));
    let list = Blob {
        index: Index::Balls(Balls::around(&tree.components)),
        ..tree.clone()
    };
    let mut random = crate::conformance::Random::new(5);
    for _ in 0..500 {
        let ray = Ray::new(random.cube() * 3.0, random.direction());
        assert_eq!(crossings(&tree, &ray), crossings(&list, &ray), "{ray:?}");
        let p = random.cube() * 2.0;
        assert_eq!(tree.field(p), list.field(p), "{p}");
    }
}

#[test]
fn fields_are_told_apart() {
    let blob = three();
    let mut list = vec![];
    blob.fields_at(DVec3::new(0.75, 0.0, 0.0), |i, field, _| {
        list.push((i, field))
    });
    assert_eq!(list[0], (0, 1.0));
    let sum: f64 = list.iter().map(|(_, field)| field).sum();
    assert_eq!(blob.field(DVec3::new(0.75, 0.0, 0.0)).0, sum);
}

#[test]
fn blobs_without_a_surface_are_refused() {
    let ball = |strength| BlobComponent::sphere(DVec3::ZERO, 1.0, strength);
    let blob = |threshold, components| Blob::try_new(threshold, components).map(|_| ());
    assert!(matches!(
        blob(1.0, vec![ball(0.5), ball(-2.0)]),
        Err(GeometryError::Degenerate { .. })
    ));
    assert!(matches!(
        blob(0.0, vec![ball(0.5)]),
        Err(GeometryError::OutOfRange { .. })
    ));
    assert!(matches!(
        blob(0.1, vec![BlobComponent::sphere(DVec3::ZERO, 0.0, 1.0)]),
        Err(GeometryError::OutOfRange { .. })
    ));
    assert!(matches!(
        blob(0.1, vec![ball(f64::NAN)]),
        Err(GeometryError::NotFinite { .. } | GeometryError::Degenerate { .. })
    ));
    assert_eq!(blob(0.1, vec![ball(1.0)]), Ok(()));
}

#[test]
fn balls_hold_all_that_the_fields_reach() {
    let mut random = crate::conformance::Random::new(78);
    let (mut held, mut met, mut all) = (0, 0, 0);
    for count in 1..=LIST_MAX as u32 {
        for scale in [1e-9, 1.0, 1e9] {
            let stretch = Transform::try_scale(DVec3::new(1.0, 0.6, 1.7) * scale);
            let map = Transform::rotate(random.direction(), 1.0).then(&stretch.expect("regular"));
            let components = many(count).components;
            let components: Vec<_> = components.iter().map(|c| c.transformed(&map)).collect();
            let balls = Balls::around(&components);
            for _ in 0..50 {
                let (point, along) = (random.cube() * 1.5 * scale, random.direction());
                let line = balls.met_by(point, along);
                let place = balls.holding(point);
                for (i, component) in components.iter().enumerate() {
                    let has = |set: u32| set >> i & 1 == 1;
                    let mut chords = 0;
                    let inner = component.inner(point, along);
                    component.stretches(&inner, |_, _| chords += 1);
                    assert!(chords == 0 || has(line), "{component:?} {point} {along}");
                    assert!(component.field(point).0 == 0.0 || has(place));
                    met += u32::from(has(line));
                    held += u32::from(has(place));
                    all += 1;
                }
            }
        }
    }
    assert!(held * 2 < all && met * 3 < all * 2, "{held} {met} {all}");
}
