use super::*;

fn julia(algebra: JuliaAlgebra, max_iteration: u32) -> Julia {
    let options = JuliaOptions {
        max_iteration,
        ..JuliaOptions::default()
    };
    Julia::try_new([-0.083, 0.0, -0.83, -0.025], algebra, &options).unwrap()
}

const QUATERNION: JuliaAlgebra = JuliaAlgebra::Quaternion(QuaternionFunction::Square);
const CUBE: JuliaAlgebra = JuliaAlgebra::Quaternion(QuaternionFunction::Cube);
const HYPERCOMPLEX: JuliaAlgebra = JuliaAlgebra::Hypercomplex(HypercomplexFunction::Square);

crate::primitive_tests!(quaternion, || julia(QUATERNION, 6));
crate::primitive_tests!(cubed, || julia(CUBE, 4));
crate::primitive_tests!(hypercomplex, || julia(HYPERCOMPLEX, 5));

#[test]
fn no_number_of_the_set_is_beyond_its_reach() {
    let mut random = crate::conformance::Random::new(3);
    let (mut inside, mut longest) = (0, 0.0f64);
    for algebra in [
        QUATERNION,
        CUBE,
        HYPERCOMPLEX,
        JuliaAlgebra::Hypercomplex(HypercomplexFunction::Cube),
    ] {
        for points in [1, 2, 3, 8] {
            let set = julia(algebra, points);
            let reach = set.rule.reach();
            assert!(points == 1 || reach < 0.95 * set.rule.exit, "{algebra:?}");
            for _ in 0..20_000 {
                let number = std::array::from_fn(|_| (2.0 * random.unit() - 1.0) * set.rule.exit);
                if norm2(number) <= set.rule.exit * set.rule.exit && set.rule.value(number) <= 0.0 {
                    let length = norm2(number).sqrt() / reach;
                    assert!(length < 1.0, "{algebra:?} {points} {number:?}");
                    if points > 1 {
                        longest = longest.max(length);
                    }
                    inside += 1;
                }
            }
        }
    }
    assert!(inside > 20_000 && longest > 0.9, "{inside} {longest}");
}

/// The points at which a line of 4001 points enters and leaves the inside.
fn changes(set: &Julia, from: DVec3, to: DVec3) -> Vec<u32> {
    let mut inside = false;
    let mut found = vec![];
    for k in 0..=4000 {
        let now = set.contains(from + (to - from) * (f64::from(k) / 4000.0));
        if now != inside {
            found.push(k);
        }
        inside = now;
    }
    found
}

#[test]
fn the_inside_is_that_of_povray() {
    // Scanned in POV-Ray 3.7 with its function `inside`.
    let line = |set: &Julia| changes(set, DVec3::new(-2.0, 0.1, 0.1), DVec3::new(2.0, 0.1, 0.1));
    for (algebra, points, expected) in [
        (QUATERNION, 1, [171, 3830]),
        (QUATERNION, 2, [750, 3353]),
        (QUATERNION, 5, [1544, 2543]),
        (QUATERNION, 8, [1623, 2369]),
        (CUBE, 2, [801, 3238]),
        (CUBE, 5, [1314, 2768]),
    ] {
        assert_eq!(
            line(&julia(algebra, points)),
            expected,
            "{algebra:?} {points}"
        );
    }
    let options = JuliaOptions {
        max_iteration: 7,
        slice: [0.1, 0.2, 0.3, 0.8],
        distance: 0.1,
        ..JuliaOptions::default()
    };
    let cut = |algebra| {
        let set = Julia::try_new([-0.083, 0.0, -0.83, -0.025], algebra, &options).unwrap();
        changes(
            &set,
            DVec3::new(-2.0, 0.05, 0.1),
            DVec3::new(2.0, 0.05, 0.1),
        )
    };
    assert_eq!(cut(HYPERCOMPLEX), [1677, 2437]);
    assert_eq!(cut(QUATERNION), [1590, 2370]);
}

#[test]
fn with_one_point_the_ball_is_all_there_is_and_unseen() {
    let set = julia(QUATERNION, 1);
    let ray = Ray::new(DVec3::new(-5.0, 0.1, 0.1), DVec3::X);
    let scratch = &mut Scratch::default();
    assert!(
        set.closest_hit(&ray, Interval::FORWARD, None, scratch)
            .is_none()
    );
    let mut out = Crossings::default();
    set.crossings(&ray, Interval::LINE, None, scratch, &mut out);
    assert_eq!(out.list.len(), 2);
}

#[test]
fn what_is_no_julia_set_is_refused() {
    let make = |options: JuliaOptions| Julia::try_new([0.0; 4], QUATERNION, &options);
    assert!(make(JuliaOptions::default()).is_ok());
    let flat = JuliaOptions {
        slice: [1.0, 0.0, 0.0, 0.0],
        ..JuliaOptions::default()
    };
    assert!(matches!(make(flat), Err(GeometryError::Degenerate { .. })));
    let none = JuliaOptions {
        max_iteration: 0,
        ..JuliaOptions::default()
    };
    assert!(matches!(make(none), Err(GeometryError::OutOfRange { .. })));
    assert!(Julia::try_new([f64::NAN; 4], QUATERNION, &JuliaOptions::default()).is_err());
}
