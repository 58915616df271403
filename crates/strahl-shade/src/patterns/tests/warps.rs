//! Warps.

use super::{Measured, field};
use crate::patterns::*;
use strahl_math::Transform;
use strahl_math::noise::Turbulence;

pub(super) fn measured() -> Vec<Measured> {
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
            [
                0.556580288,
                0.384762944,
                0.682097711,
                0.498703617,
                0.851393781,
                0.621927864,
                0.667061913,
                0.448544025,
                0.587303123,
                0.460850226,
                0.36413081,
                0.43715827,
            ],
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
            [
                0.413085501,
                0.659927755,
                0.500555835,
                0.584365258,
                0.763483019,
                0.376320446,
                0.593670669,
                0.594906318,
                0.567078704,
                0.54130004,
                0.769944572,
                0.592889284,
            ],
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
            [
                0.476008392,
                0.172418715,
                0.363123329,
                0.519974928,
                0.851393781,
                0.62337157,
                0.667061913,
                0.543456468,
                0.4655425,
                0.460850226,
                0.624928467,
                0.328620973,
            ],
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
            [
                0.556580288,
                0.220186235,
                0.363123329,
                0.491224842,
                0.851393781,
                0.621927864,
                0.667061913,
                0.565022965,
                0.465511447,
                0.460850226,
                0.624928467,
                0.328620973,
            ],
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
            [
                0.572802472,
                0.413341642,
                0.378809432,
                0.475227229,
                0.511587178,
                0.550482425,
                0.465635462,
                0.423614661,
                0.443344319,
                0.398093667,
                0.500402779,
                0.300477789,
            ],
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
            [
                0.509376845,
                0.60365841,
                0.504062535,
                0.462131107,
                0.303876525,
                0.550643942,
                0.430802055,
                0.651804389,
                0.63639585,
                0.452117853,
                0.315731241,
                0.61090024,
            ],
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
            [
                0.409224888,
                0.578731821,
                0.626441555,
                0.330688604,
                0.501367903,
                0.514402028,
                0.588269469,
                0.379608407,
                0.295343664,
                0.348667488,
                0.52444935,
                0.6016682,
            ],
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
            [
                0.541519381,
                0.455752959,
                0.514014306,
                0.498592361,
                0.701108812,
                0.534642853,
                0.477097968,
                0.531075916,
                0.584665436,
                0.62571685,
                0.639222004,
                0.608349107,
            ],
        ),
    ]
}
