//! Normals measured with POV-Ray 3.7.0.10: a plane at z = 0.25, seen from -z, lit from three directions.

use super::*;
use crate::patterns::Wave;
use strahl_math::Transform;

const POINTS: [[f64; 3]; 4] = [
    [0.5, 1.8333333333333333, 0.25],
    [-0.5, 0.8333333333333333, 0.25],
    [-0.8333333333333333, -0.16666666666666652, 0.25],
    [-1.5, -1.1666666666666665, 0.25],
];

fn measured() -> Vec<(&'static str, PovNormal, [[f64; 3]; 4])> {
    vec![
        (
            "bumps .3",
            PovNormal {
                amount: 0.3,
                ..PovNormal::new(NormalKind::Bumps)
            },
            [
                [0.04122, -0.00716, -0.99912],
                [-0.10585, 0.09613, -0.98973],
                [0.01729, -0.17752, -0.98397],
                [0.01774, 0.02344, -0.99957],
            ],
        ),
        (
            "bumps .3 turbulence .25",
            PovNormal {
                amount: 0.3,
                modifiers: Modifiers {
                    turbulence: DVec3::splat(0.25),
                    ..Modifiers::default()
                },
                ..PovNormal::new(NormalKind::Bumps)
            },
            [
                [0.0265, -0.00356, -0.99964],
                [-0.10271, 0.07739, -0.99169],
                [0.04249, -0.16506, -0.98537],
                [0.05058, 0.05968, -0.99694],
            ],
        ),
        (
            "bumps .3 scale <2,3,1.5>",
            PovNormal {
                amount: 0.3,
                modifiers: Modifiers {
                    warps: vec![Warp::Transform(
                        Transform::try_scale(DVec3::new(2.0, 3.0, 1.5)).expect("regular"),
                    )],
                    ..Modifiers::default()
                },
                ..PovNormal::new(NormalKind::Bumps)
            },
            [
                [-0.05915, -0.0086, -0.99821],
                [-0.10198, 0.01108, -0.99472],
                [-0.05246, -0.03188, -0.99811],
                [0.03666, -0.07253, -0.99669],
            ],
        ),
        (
            "bumps .3 scale <2,3,1.5> no_bump_scale",
            PovNormal {
                amount: 0.3,
                modifiers: Modifiers {
                    warps: vec![Warp::Transform(
                        Transform::try_scale(DVec3::new(2.0, 3.0, 1.5)).expect("regular"),
                    )],
                    ..Modifiers::default()
                },
                no_bump_scale: true,
                ..PovNormal::new(NormalKind::Bumps)
            },
            [
                [-0.04053, -0.0059, -0.99916],
                [-0.07129, 0.00775, -0.99743],
                [-0.03597, -0.02187, -0.99911],
                [0.02501, -0.04948, -0.99846],
            ],
        ),
        (
            "bumps .3 rotate z*90",
            PovNormal {
                amount: 0.3,
                modifiers: Modifiers {
                    warps: vec![Warp::Transform(Transform::rotate(
                        DVec3::Z,
                        std::f64::consts::FRAC_PI_2,
                    ))],
                    ..Modifiers::default()
                },
                ..PovNormal::new(NormalKind::Bumps)
            },
            [
                [-0.13702, 0.07479, -0.98774],
                [0.09832, -0.04858, -0.99396],
                [-0.09126, -0.08941, -0.9918],
                [0.05442, -0.03604, -0.99786],
            ],
        ),
        (
            "bumps .3 scale 2 rotate z*90 warp{repeat 2*x} translate y",
            PovNormal {
                amount: 0.3,
                modifiers: Modifiers {
                    warps: vec![
                        Warp::Transform(Transform::try_scale(DVec3::splat(2.0)).expect("regular")),
                        Warp::Transform(Transform::rotate(DVec3::Z, std::f64::consts::FRAC_PI_2)),
                        Warp::Repeat {
                            axis: 0,
                            width: 2.0,
                            offset: DVec3::ZERO,
                            flip: [false; 3],
                        },
                        Warp::Transform(Transform::translate(DVec3::Y)),
                    ],
                    ..Modifiers::default()
                },
                ..PovNormal::new(NormalKind::Bumps)
            },
            [
                [0.06231, 0.00726, -0.99803],
                [0.00105, 0.01486, -0.9999],
                [0.06831, 0.0507, -0.99638],
                [0.14972, 0.02125, -0.9885],
            ],
        ),
        (
            "dents .5",
            PovNormal {
                amount: 0.5,
                ..PovNormal::new(NormalKind::Dents)
            },
            [
                [0.01348, -0.00234, -0.99991],
                [-0.00642, 0.00582, -0.99996],
                [0.00473, -0.04859, -0.99881],
                [0.00424, 0.0056, -0.99997],
            ],
        ),
        (
            "wrinkles .3",
            PovNormal {
                amount: 0.3,
                ..PovNormal::new(NormalKind::Wrinkles)
            },
            [
                [0.11379, 0.01899, -0.99332],
                [0.17802, 0.19418, -0.96468],
                [0.06823, 0.20659, -0.97605],
                [0.118, 0.0825, -0.98958],
            ],
        ),
        (
            "ripples .3 frequency 2 phase .25",
            PovNormal {
                amount: 0.3,
                modifiers: Modifiers {
                    frequency: 2.0,
                    phase: 0.25,
                    ..Modifiers::default()
                },
                ..PovNormal::new(NormalKind::Ripples(10))
            },
            [
                [0.00912, -0.09131, -0.99578],
                [-0.01222, 0.10812, -0.99406],
                [-0.02136, -0.00806, -0.99974],
                [0.04789, 0.02601, -0.99852],
            ],
        ),
        (
            "waves .3",
            PovNormal {
                amount: 0.3,
                ..PovNormal::new(NormalKind::Waves(10))
            },
            [
                [-0.05847, -0.02293, -0.99803],
                [-0.14235, 0.10189, -0.98456],
                [-0.27079, -0.11451, -0.9558],
                [0.03292, 0.07061, -0.99696],
            ],
        ),
        (
            "quilted .5",
            PovNormal {
                amount: 0.5,
                ..PovNormal::new(NormalKind::Quilted([1.0, 1.0]))
            },
            [
                [1e-05, 0.13695, -0.99058],
                [1e-05, 0.13695, -0.99058],
                [-0.14959, 0.14961, -0.97736],
                [1e-05, 0.13695, -0.99058],
            ],
        ),
        (
            "quilted .5 control0 .25 control1 .75",
            PovNormal {
                amount: 0.5,
                ..PovNormal::new(NormalKind::Quilted([0.25, 0.75]))
            },
            [
                [0.0, 0.07371, -0.99728],
                [0.0, 0.07371, -0.99728],
                [-0.09516, 0.09517, -0.9909],
                [0.0, 0.07371, -0.99728],
            ],
        ),
        (
            "bozo .5",
            PovNormal {
                amount: 0.5,
                ..PovNormal::new(NormalKind::Height(Pattern::Bozo, None))
            },
            [
                [0.0075, -0.00628, -0.99995],
                [0.00534, -0.00139, -0.99999],
                [0.00652, 0.01649, -0.99984],
                [-0.01295, 0.00761, -0.99989],
            ],
        ),
        (
            "bozo .5 accuracy .1 sine_wave",
            PovNormal {
                amount: 0.5,
                modifiers: Modifiers {
                    wave: Some(Wave::Sine),
                    ..Modifiers::default()
                },
                accuracy: 0.1,
                ..PovNormal::new(NormalKind::Height(Pattern::Bozo, None))
            },
            [
                [-0.02624, 0.01856, -0.99948],
                [-0.01024, -0.00024, -0.99995],
                [-0.02436, -0.04219, -0.99882],
                [0.03801, -0.02625, -0.99894],
            ],
        ),
        (
            "granite .2 scale 2",
            PovNormal {
                amount: 0.2,
                modifiers: Modifiers {
                    warps: vec![Warp::Transform(
                        Transform::try_scale(DVec3::splat(2.0)).expect("regular"),
                    )],
                    ..Modifiers::default()
                },
                ..PovNormal::new(NormalKind::Height(Pattern::Granite, None))
            },
            [
                [-0.04173, 0.07834, -0.99606],
                [-0.03926, 0.00694, -0.9992],
                [0.00169, 0.08287, -0.99656],
                [-0.06174, -0.04804, -0.99693],
            ],
        ),
        (
            "bozo .5 turbulence .25",
            PovNormal {
                amount: 0.5,
                modifiers: Modifiers {
                    turbulence: DVec3::splat(0.25),
                    ..Modifiers::default()
                },
                ..PovNormal::new(NormalKind::Height(Pattern::Bozo, None))
            },
            [
                [0.00949, -0.00801, -0.99992],
                [0.00665, 0.00366, -0.99998],
                [0.00641, 0.02023, -0.99978],
                [-0.00933, 0.00408, -0.99995],
            ],
        ),
        (
            "bozo .5 slope_map{[0 <0,1>][.25 <.75,-.5>][.5 <.25,2>][1 <1,0>]}",
            PovNormal {
                amount: 0.5,
                ..PovNormal::new(NormalKind::Height(
                    Pattern::Bozo,
                    Some(SlopeMap(BlendMap::new(vec![
                        (0.0, [0.0, 1.0]),
                        (0.25, [0.75, -0.5]),
                        (0.5, [0.25, 2.0]),
                        (1.0, [1.0, 0.0]),
                    ]))),
                ))
            },
            [
                [0.02262, -0.02027, -0.99954],
                [-0.02865, 0.00736, -0.99956],
                [0.02231, 0.05704, -0.99812],
                [-0.0423, 0.02427, -0.99881],
            ],
        ),
        (
            "gradient x normal_map{[0 bumps .3][1 dents .5]} scale 3",
            PovNormal {
                amount: 0.5,
                modifiers: Modifiers {
                    warps: vec![Warp::Transform(
                        Transform::try_scale(DVec3::splat(3.0)).expect("regular"),
                    )],
                    ..Modifiers::default()
                },
                ..PovNormal::new(NormalKind::Map(
                    Pattern::Gradient(DVec3::X),
                    BlendMap::new(vec![
                        (
                            0.0,
                            PovNormal {
                                amount: 0.3,
                                ..PovNormal::new(NormalKind::Bumps)
                            },
                        ),
                        (1.0, PovNormal::new(NormalKind::Dents)),
                    ]),
                ))
            },
            [
                [-0.08947, -0.0004, -0.99599],
                [-0.02899, 0.01044, -0.99953],
                [-0.03397, 0.00583, -0.99941],
                [0.00441, -0.04319, -0.99905],
            ],
        ),
        (
            "average normal_map{[1 bumps .3][2 dents .5]}",
            PovNormal {
                amount: 0.5,
                ..PovNormal::new(NormalKind::Average(
                    vec![
                        (
                            1.0,
                            PovNormal {
                                amount: 0.3,
                                ..PovNormal::new(NormalKind::Bumps)
                            },
                        ),
                        (2.0, PovNormal::new(NormalKind::Dents)),
                    ]
                    .into(),
                ))
            },
            [
                [0.02273, -0.00394, -0.99973],
                [-0.03963, 0.03599, -0.99857],
                [0.00895, -0.09173, -0.99574],
                [0.00873, 0.01155, -0.99989],
            ],
        ),
        (
            "checker normal{bumps .3} normal{dents .5}",
            PovNormal {
                amount: 0.5,
                ..PovNormal::new(NormalKind::Blocks(
                    Pattern::Checker,
                    vec![
                        PovNormal {
                            amount: 0.3,
                            ..PovNormal::new(NormalKind::Bumps)
                        },
                        PovNormal::new(NormalKind::Dents),
                    ]
                    .into(),
                ))
            },
            [
                [0.01348, -0.00234, -0.99991],
                [-0.00642, 0.00582, -0.99996],
                [0.01729, -0.17752, -0.98397],
                [0.01774, 0.02344, -0.99957],
            ],
        ),
    ]
}

#[test]
fn tilts_as_measured() {
    for (written, normal, values) in measured() {
        for (p, expected) in POINTS.iter().zip(values) {
            let point = TexturePoint {
                n_geom: DVec3::NEG_Z,
                n_shade: DVec3::NEG_Z,
                direction: DVec3::Z,
                ..TexturePoint::in_space(DVec3::from_array(*p))
            };
            let got = normal.tilt(&point, DVec3::NEG_Z).normalize();
            let expected = DVec3::from_array(expected);
            assert!(
                (got - expected).length() < 5e-5,
                "{written} at {p:?}: {got} is not {expected}"
            );
        }
    }
}

#[test]
fn hostile_points_give_a_direction_or_the_old_normal() {
    for (written, normal, _) in measured() {
        for x in [f64::NAN, f64::INFINITY, 1e300, -1e18] {
            let point = TexturePoint::in_space(DVec3::new(x, 0.5, x));
            let n = normal.tilt(&point, DVec3::Y).normalize();
            assert!((n.length() - 1.0).abs() < 1e-12, "{written} at {x}: {n}");
        }
    }
}
