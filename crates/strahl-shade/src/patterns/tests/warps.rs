//! Warps.

use super::{Built, field};
use crate::patterns::*;
use strahl_math::Transform;
use strahl_math::noise::Turbulence;

pub(super) fn built() -> Vec<Built> {
    vec![
        (
            "bozo warp{repeat 2*x flip <1,1,0> offset <.125,.25,.5>}",
            field(
                Pattern::Bozo,
                Modifiers {
                    warps: vec![Warp::Repeat {
                        axis: 0,
                        width: 2.0,
                        offset: DVec3::new(0.125, 0.25, 0.5),
                        flip: [true, true, false],
                    }],
                    ..Modifiers::default()
                },
            ),
        ),
        (
            "bozo translate 1.5*x scale 2 warp{turbulence .25 octaves 4 omega .5 lambda 3}",
            field(
                Pattern::Bozo,
                Modifiers {
                    warps: vec![
                        Warp::Transform(Transform::translate(DVec3::new(1.5, 0.0, 0.0))),
                        Warp::Transform(Transform::try_scale(DVec3::splat(2.0)).expect("regular")),
                        Warp::Turbulence {
                            amount: DVec3::splat(0.25),
                            octaves: Turbulence {
                                octaves: 4,
                                omega: 0.5,
                                lambda: 3.0,
                            },
                        },
                    ],
                    ..Modifiers::default()
                },
            ),
        ),
        (
            "bozo warp{black_hole <.25,.5,0>,2 strength 1.5 falloff 3 inverse}",
            field(
                Pattern::Bozo,
                Modifiers {
                    warps: vec![Warp::BlackHole(BlackHole {
                        strength: 1.5,
                        falloff: 3.0,
                        inverse: true,
                        ..BlackHole::new(DVec3::new(0.25, 0.5, 0.0), 2.0)
                    })],
                    ..Modifiers::default()
                },
            ),
        ),
        (
            "bozo warp{black_hole <.5,.5,0>,.5 repeat <1,1.5,0>}",
            field(
                Pattern::Bozo,
                Modifiers {
                    warps: vec![Warp::BlackHole(BlackHole {
                        repeat: DVec3::new(1.0, 1.5, 0.0),
                        ..BlackHole::new(DVec3::new(0.5, 0.5, 0.0), 0.5)
                    })],
                    ..Modifiers::default()
                },
            ),
        ),
        (
            "bozo warp{black_hole <.5,.6,.7>,.45 repeat <1,2,3> turbulence <.3,.2,.4>}",
            field(
                Pattern::Bozo,
                Modifiers {
                    warps: vec![Warp::BlackHole(BlackHole {
                        repeat: DVec3::new(1.0, 2.0, 3.0),
                        turbulence: DVec3::new(0.3, 0.2, 0.4),
                        ..BlackHole::new(DVec3::new(0.5, 0.6, 0.7), 0.45)
                    })],
                    ..Modifiers::default()
                },
            ),
        ),
        (
            "bozo warp{black_hole <.5,.5,0>,.9 repeat <0,0,0> turbulence <.3,.2,.4>}",
            field(
                Pattern::Bozo,
                Modifiers {
                    warps: vec![Warp::BlackHole(BlackHole {
                        turbulence: DVec3::new(0.3, 0.2, 0.4),
                        ..BlackHole::new(DVec3::new(0.5, 0.5, 0.0), 0.9)
                    })],
                    ..Modifiers::default()
                },
            ),
        ),
        (
            "bozo warp{cubic}",
            field(
                Pattern::Bozo,
                Modifiers {
                    warps: vec![Warp::Cubic],
                    ..Modifiers::default()
                },
            ),
        ),
        (
            "bozo warp{cylindrical}",
            field(
                Pattern::Bozo,
                Modifiers {
                    warps: vec![Warp::Mapping {
                        mapping: Mapping::Cylindrical,
                        orientation: DVec3::Z,
                        distance_exponent: 0.0,
                    }],
                    ..Modifiers::default()
                },
            ),
        ),
        (
            "bozo warp{spherical orientation y dist_exp 1}",
            field(
                Pattern::Bozo,
                Modifiers {
                    warps: vec![Warp::Mapping {
                        mapping: Mapping::Spherical,
                        orientation: DVec3::Y,
                        distance_exponent: 1.0,
                    }],
                    ..Modifiers::default()
                },
            ),
        ),
        (
            "bozo warp{toroidal orientation <.6,0,.8> major_radius 2}",
            field(
                Pattern::Bozo,
                Modifiers {
                    warps: vec![Warp::Mapping {
                        mapping: Mapping::Toroidal(2.0),
                        orientation: DVec3::new(0.6, 0.0, 0.8),
                        distance_exponent: 0.0,
                    }],
                    ..Modifiers::default()
                },
            ),
        ),
        (
            "bozo warp{planar y,.25}",
            field(
                Pattern::Bozo,
                Modifiers {
                    warps: vec![Warp::Planar {
                        orientation: DVec3::Y,
                        distance: 0.25,
                    }],
                    ..Modifiers::default()
                },
            ),
        ),
    ]
}

/// With falloff 0 every point within moves, so the border is seen: that of the distance, though most points are decided by its square.
#[test]
fn black_holes_end_where_the_distance_is_the_radius() {
    let mut counts = [0; 2];
    for k in 0..400_u32 {
        let radius = 0.3 + f64::from(k) * 0.0137;
        let hole = BlackHole {
            falloff: 0.0,
            ..BlackHole::new(DVec3::new(0.0, 0.5, 0.0), radius)
        };
        let mut x = radius * 0.8;
        let y = (radius * radius - x * x).sqrt();
        for _ in 0..8 {
            x = x.next_down();
        }
        for _ in 0..16 {
            x = x.next_up();
            let p = DVec3::new(x, 0.5 + y, 0.0);
            let within = (p - hole.center).length() < radius;
            assert_eq!(Warp::BlackHole(hole).apply(p) != p, within, "{radius} {x}");
            counts[usize::from(within)] += 1;
        }
    }
    assert!(counts.iter().all(|count| *count > 1000), "{counts:?}");
    // Also where the squares are no numbers to go by.
    for radius in [1e-170, 1e160, 0.0, -1.0, f64::NAN] {
        for x in [1e-171, 1e-169, 1e159, 0.5, 0.0] {
            let hole = BlackHole {
                falloff: 0.0,
                ..BlackHole::new(DVec3::Y, radius)
            };
            let p = DVec3::new(x, 1.0, 0.0);
            let within = (p - hole.center).length() < radius && x != 0.0;
            assert_eq!(Warp::BlackHole(hole).apply(p) != p, within, "{radius} {x}");
        }
    }
}
