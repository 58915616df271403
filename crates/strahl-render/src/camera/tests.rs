use super::*;
use crate::film::Region;

#[test]
fn the_picture_is_not_mirrored() {
    let c = Camera::perspective(DVec3::Z, DVec3::ZERO, DVec3::Y, std::f64::consts::FRAC_PI_2);
    let rays = PrimaryRays::new(&c, 200, 100);
    let direction = |x, y| rays.ray(x, y).expect("a ray").direction;
    let top_left = direction(0.0, 0.0);
    assert!((top_left - DVec3::new(-2.0, 1.0, -1.0).normalize()).length() < 1e-15);
    assert!((direction(100.0, 50.0) - DVec3::NEG_Z).length() < 1e-15);
}

#[test]
fn orthographic_rays_are_parallel() {
    let c = Camera::orthographic(DVec3::Z, DVec3::ZERO, DVec3::Y, 2.0);
    let rays = PrimaryRays::new(&c, 100, 100);
    let ray = |x, y| rays.ray(x, y).expect("a ray");
    let (a, b) = (ray(0.0, 0.0), ray(100.0, 100.0));
    assert_eq!(a.direction, b.direction);
    assert!((a.origin - DVec3::new(-1.0, 1.0, 1.0)).length() < 1e-15);
}

/// Directions of POV-Ray 3.7 at some pixels of a picture of 24 by 16, `right 1.5*x up y`, measured with a sky whose colour
/// shows the direction; three zeros where the camera sees nothing.
#[test]
fn directions_are_those_of_povray() {
    let degrees = |d: f64| d.to_radians();
    let cylinder = |upright, moving| Projection::Cylinder {
        upright,
        moving,
        angle: degrees(120.0),
    };
    let cases: [(Projection, (u32, u32), [f64; 3]); 15] = [
        (
            Projection::Fisheye {
                angle: degrees(220.0),
            },
            (5, 7),
            [-0.997, 0.077, 0.006],
        ),
        (
            Projection::Fisheye {
                angle: degrees(220.0),
            },
            (12, 15),
            [0.065, -0.971, -0.231],
        ),
        (
            Projection::Fisheye {
                angle: degrees(220.0),
            },
            (0, 0),
            [0.0; 3],
        ),
        (
            Projection::UltraWideAngle {
                angle: degrees(120.0),
            },
            (0, 0),
            [-0.750, 0.542, 0.379],
        ),
        (
            Projection::UltraWideAngle {
                angle: degrees(120.0),
            },
            (5, 15),
            [-0.511, -0.579, 0.636],
        ),
        (Projection::Omnimax, (5, 7), [-0.764, 0.325, 0.557]),
        (Projection::Omnimax, (12, 0), [0.051, 0.993, 0.107]),
        (Projection::Omnimax, (5, 15), [0.0; 3]),
        (Projection::Panoramic, (0, 7), [-0.997, 0.066, 0.044]),
        (Projection::Panoramic, (12, 0), [0.010, 0.995, 0.098]),
        (cylinder(true, false), (0, 0), [-0.764, 0.424, 0.487]),
        (cylinder(false, false), (5, 15), [-0.376, -0.770, 0.515]),
        (cylinder(true, true), (5, 0), [-0.537, 0.0, 0.843]),
        (cylinder(false, true), (23, 7), [0.0, 0.065, 0.998]),
        (
            Projection::Spherical {
                horizontal: degrees(200.0),
                vertical: degrees(90.0),
            },
            (0, 15),
            [-0.737, -0.672, -0.075],
        ),
    ];
    for (projection, (x, y), expected) in cases {
        let mut camera = Camera::perspective(DVec3::ZERO, DVec3::Z, DVec3::Y, 1.0);
        camera.right = DVec3::X * 0.75;
        camera.up = DVec3::Y * 0.5;
        camera.direction = DVec3::Z;
        camera.aspect = Some(1.0);
        camera.projection = projection;
        let rays = PrimaryRays::new(&camera, 24, 16);
        let ray = rays.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let found = ray.map_or(DVec3::ZERO, |r| r.direction);
        let error = (found - DVec3::from_array(expected)).length();
        assert!(error < 2e-3, "{:?} {x} {y}: {found}", camera.projection);
    }
}

#[test]
fn moving_eyes_stay_on_the_axis() {
    let mut camera = Camera::perspective(DVec3::ONE, DVec3::ONE + DVec3::Z, DVec3::Y, 1.0);
    camera.projection = Projection::Cylinder {
        upright: true,
        moving: true,
        angle: 1.0,
    };
    camera.up = DVec3::Y * 2.0;
    let rays = PrimaryRays::new(&camera, 10, 10);
    let top = rays.ray(2.0, 0.0).expect("a ray");
    assert!((top.origin - DVec3::new(1.0, 3.0, 1.0)).length() < 1e-15);
    assert_eq!(top.direction.y, 0.0);
}

#[test]
fn a_camera_normal_bends_the_rays() {
    let mut camera = Camera::perspective(DVec3::ZERO, DVec3::Z, DVec3::Y, 1.0);
    let plain = PrimaryRays::new(&camera, 10, 10).ray(3.0, 4.0);
    let bumps = strahl_shade::normal::PovNormal::new(strahl_shade::normal::NormalKind::Bumps);
    camera.normal = Some(std::sync::Arc::new(bumps));
    let bent = PrimaryRays::new(&camera, 10, 10).ray(3.0, 4.0);
    let (plain, bent) = (plain.expect("a ray"), bent.expect("a ray"));
    assert_eq!(plain.origin, bent.origin);
    let apart = (plain.direction - bent.direction).length();
    assert!(
        apart > 1e-4 && (bent.direction.length() - 1.0).abs() < 1e-12,
        "{apart}"
    );
}

#[test]
fn rays_side_by_side_have_the_bits_of_single_ones() {
    let mut camera = Camera::perspective(
        DVec3::new(1.0, -2.0, 0.3),
        DVec3::new(0.1, 0.2, 3.0),
        DVec3::Y,
        1.1,
    );
    let place = (0.25, 0.7);
    for bent in [false, true] {
        if bent {
            camera.projection = Projection::Fisheye { angle: 3.0 };
        }
        let rays = PrimaryRays::new(&camera, 10, 8);
        for (width, height) in [(4, 4), (1, 4), (3, 2)] {
            let square = Region {
                x: 2,
                y: 3,
                width,
                height,
            };
            let pixels = square.positions();
            let ray = |(x, y)| rays.ray(f64::from(x) + place.0, f64::from(y) + place.1);
            let single: Vec<_> = pixels.map(ray).collect();
            assert_eq!(&rays.of_square(square, place)[..], single);
            assert!(single.iter().any(Option::is_some));
        }
    }
}
