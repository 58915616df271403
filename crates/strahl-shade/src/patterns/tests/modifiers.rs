//! Waves, frequencies and turbulence.

use super::{Measured, field};
use crate::patterns::*;
use strahl_math::noise::{NoiseGenerator, Turbulence};

pub(super) fn measured() -> Vec<Measured> {
    vec![
        (
            "agate agate_turb .25 turbulence .5 octaves 3",
            field(
                Pattern::Agate { turbulence: 0.25 },
                Modifiers {
                    turbulence: DVec3::splat(0.5),
                    octaves: Turbulence {
                        octaves: 3,
                        ..Turbulence::default()
                    },
                    ..Modifiers::default()
                },
            ),
            [
                0.879239838,
                0.643151844,
                0.504657008,
                0.984228108,
                0.620057306,
                0.965353149,
                0.836094121,
                0.840546105,
                0.999907144,
                0.0839621729,
                0.21584436,
                0.34354274,
            ],
        ),
        (
            "gradient y triangle_wave",
            field(
                Pattern::Gradient(DVec3::Y),
                Modifiers {
                    wave: Some(Wave::Triangle),
                    ..Modifiers::default()
                },
            ),
            [
                1.0, 0.4, 0.44276, 0.428, 0.69618, 0.0444, 0.589, 0.6448, 0.9008, 0.408, 0.67418,
                0.8406,
            ],
        ),
        (
            "gradient y sine_wave",
            field(
                Pattern::Gradient(DVec3::Y),
                Modifiers {
                    wave: Some(Wave::Sine),
                    ..Modifiers::default()
                },
            ),
            [
                0.5,
                0.975528258,
                0.0080624749,
                0.987263436,
                0.0919937447,
                0.569517416,
                0.980582711,
                0.94915191,
                0.346687122,
                0.979260895,
                0.0730083273,
                0.25994949,
            ],
        ),
        (
            "gradient y scallop_wave",
            field(
                Pattern::Gradient(DVec3::Y),
                Modifiers {
                    wave: Some(Wave::Scallop),
                    ..Modifiers::default()
                },
            ),
            [
                1.0,
                0.587785252,
                0.64075847,
                0.62278778,
                0.888266356,
                0.0696868305,
                0.798740534,
                0.848343927,
                0.987884142,
                0.597904983,
                0.871865913,
                0.968817116,
            ],
        ),
        (
            "gradient y cubic_wave",
            field(
                Pattern::Gradient(DVec3::Y),
                Modifiers {
                    wave: Some(Wave::Cubic),
                    ..Modifiers::default()
                },
            ),
            [
                0.5,
                0.104,
                0.874671958,
                0.117787312,
                0.720853853,
                0.0014566379,
                0.209106633,
                0.244803633,
                0.574155952,
                0.107868672,
                0.735717845,
                0.618537477,
            ],
        ),
        (
            "gradient y poly_wave 3",
            field(
                Pattern::Gradient(DVec3::Y),
                Modifiers {
                    wave: Some(Wave::Poly(3.0)),
                    ..Modifiers::default()
                },
            ),
            [
                0.125,
                0.008,
                0.472037678,
                0.009800344,
                0.277053046,
                1.0941048e-05,
                0.0255420586,
                0.0335108234,
                0.166012264,
                0.008489664,
                0.291315579,
                0.194809397,
            ],
        ),
        (
            "gradient y poly_wave .5",
            field(
                Pattern::Gradient(DVec3::Y),
                Modifiers {
                    wave: Some(Wave::Poly(0.5)),
                    ..Modifiers::default()
                },
            ),
            [
                0.707106781,
                0.447213595,
                0.88239447,
                0.46260134,
                0.807409438,
                0.148996644,
                0.542678542,
                0.567802783,
                0.74135012,
                0.451663592,
                0.814192852,
                0.761380325,
            ],
        ),
        (
            "marble ramp_wave",
            field(
                Pattern::Marble,
                Modifiers {
                    wave: Some(Wave::Ramp),
                    ..Modifiers::default()
                },
            ),
            [
                0.25, 0.7, 0.42252, 0.7313, 0.9771, 0.72819, 0.90039, 0.22711, 0.1196, 0.81319,
                0.8024, 0.37568,
            ],
        ),
        (
            "gradient x frequency 2 phase .125",
            field(
                Pattern::Gradient(DVec3::X),
                Modifiers {
                    frequency: 2.0,
                    phase: 0.125,
                    ..Modifiers::default()
                },
            ),
            [
                0.625, 0.525, 0.97005, 0.58759, 0.07918, 0.58139, 0.92579, 0.57923, 0.36421,
                0.75139, 0.7298, 0.8764,
            ],
        ),
        (
            "gradient x frequency -1",
            field(
                Pattern::Gradient(DVec3::X),
                Modifiers {
                    frequency: -1.0,
                    ..Modifiers::default()
                },
            ),
            [
                0.75, 0.3, 0.57748, 0.2687, 0.0229, 0.2718, 0.0996, 0.77289, 0.8804, 0.1868,
                0.1976, 0.6243,
            ],
        ),
        (
            "marble turbulence .5",
            field(
                Pattern::Marble,
                Modifiers {
                    turbulence: DVec3::splat(0.5),
                    ..Modifiers::default()
                },
            ),
            [
                0.361672378,
                0.242360574,
                0.487799894,
                0.400254711,
                0.302095068,
                0.823808476,
                0.797528786,
                0.499537529,
                0.995769577,
                0.729661861,
                0.899322906,
                0.661528505,
            ],
        ),
        (
            "marble turbulence .5 noise_generator 3",
            field(
                Pattern::Marble,
                Modifiers {
                    turbulence: DVec3::splat(0.5),
                    noise: NoiseGenerator::Perlin,
                    ..Modifiers::default()
                },
            ),
            [
                0.377082322,
                0.149833602,
                0.0533137963,
                0.479712454,
                0.948424701,
                0.926978553,
                0.61543075,
                0.68250765,
                0.924702271,
                0.825877069,
                0.700933115,
                0.499902987,
            ],
        ),
        (
            "marble turbulence .5 noise_generator 1",
            field(
                Pattern::Marble,
                Modifiers {
                    turbulence: DVec3::splat(0.5),
                    noise: NoiseGenerator::Original,
                    ..Modifiers::default()
                },
            ),
            [
                0.420916262,
                0.275705592,
                0.522766243,
                0.336855606,
                0.336560109,
                0.769309342,
                0.851318391,
                0.560688359,
                0.928620055,
                0.669672599,
                0.843313592,
                0.732187249,
            ],
        ),
        (
            "wood turbulence <.125,.25,.5>",
            field(
                Pattern::Wood,
                Modifiers {
                    turbulence: DVec3::new(0.125, 0.25, 0.5),
                    ..Modifiers::default()
                },
            ),
            [
                0.0411918251,
                0.706791825,
                0.684831001,
                0.216668219,
                0.0270555356,
                0.373226331,
                0.242060927,
                0.0851928269,
                0.104544135,
                0.821355957,
                0.594309389,
                0.797299955,
            ],
        ),
        (
            "bozo turbulence .5 lambda 3 omega .25 octaves 4",
            field(
                Pattern::Bozo,
                Modifiers {
                    turbulence: DVec3::splat(0.5),
                    octaves: Turbulence {
                        octaves: 4,
                        omega: 0.25,
                        lambda: 3.0,
                    },
                    ..Modifiers::default()
                },
            ),
            [
                0.525476559,
                0.405011085,
                0.389606129,
                0.479092917,
                0.792739387,
                0.609543979,
                0.59725197,
                0.479147593,
                0.436229019,
                0.498130028,
                0.607106311,
                0.430556879,
            ],
        ),
        (
            "spiral1 3 turbulence .125",
            field(
                Pattern::Spiral1(3.0),
                Modifiers {
                    turbulence: DVec3::splat(0.125),
                    ..Modifiers::default()
                },
            ),
            [
                0.626184111,
                0.782284671,
                0.436165142,
                0.858822322,
                0.190232706,
                0.580253902,
                0.474281961,
                0.0228156168,
                0.940938277,
                0.139564066,
                0.224344833,
                0.0535389056,
            ],
        ),
        (
            "spiral2 3 turbulence .125",
            field(
                Pattern::Spiral2(3.0),
                Modifiers {
                    turbulence: DVec3::splat(0.125),
                    ..Modifiers::default()
                },
            ),
            [
                0.894529669,
                0.600746981,
                0.704679527,
                0.0228349759,
                0.539381209,
                0.525822975,
                0.891036687,
                0.817901909,
                0.09377939,
                0.856330399,
                0.424306573,
                0.508270333,
            ],
        ),
        (
            "ripples frequency 2 phase .25",
            field(
                Pattern::Ripples { sources: 10 },
                Modifiers {
                    frequency: 2.0,
                    phase: 0.25,
                    ..Modifiers::default()
                },
            ),
            [
                0.0607585826,
                0.183160672,
                0.222520629,
                0.859694274,
                0.187394636,
                0.20006165,
                0.0363989182,
                0.450660358,
                0.0699394288,
                0.242152378,
                0.279065052,
                0.21461636,
            ],
        ),
        (
            "waves frequency 2 phase .25",
            field(
                Pattern::Waves { sources: 10 },
                Modifiers {
                    frequency: 2.0,
                    phase: 0.25,
                    ..Modifiers::default()
                },
            ),
            [
                0.922210319,
                0.716719579,
                0.194126515,
                0.737886387,
                0.663928727,
                0.212919375,
                0.388207705,
                0.418152656,
                0.223749892,
                0.418572114,
                0.528082777,
                0.321485115,
            ],
        ),
    ]
}
