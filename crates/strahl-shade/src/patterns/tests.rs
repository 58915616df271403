//! Values measured with POV-Ray 3.7.0.10: `function { pattern { ... } }` (for block patterns a pigment of the
//! colours `rgb 0, rgb 1, ...`) at twelve points.

#![allow(
    clippy::approx_constant,
    reason = "the numbers are measured, not constants"
)]

use super::*;
use strahl_math::Transform;
use strahl_math::noise::{NoiseGenerator, Turbulence};

const POINTS: [[f64; 3]; 12] = [
    [0.25, 0.5, 0.75],
    [-0.3, 0.2, -0.1],
    [-2.5775, -2.2214, 2.69],
    [0.7313, -0.786, 0.0683],
    [0.9771, -1.3481, -2.1722],
    [1.7282, 1.0222, 0.0743],
    [1.9004, 0.2945, 2.8855],
    [-1.7729, 0.3224, -0.0983],
    [-0.8804, 0.5496, -1.5882],
    [1.8132, 2.204, -2.2274],
    [-0.1976, -1.3371, -2.5013],
    [2.3757, -0.4203, -2.1139],
];

/// A pattern as it is written, as it is built, and its values at [`POINTS`].
fn measured() -> Vec<(&'static str, PatternField, [f64; 12])> {
    let field = |pattern, modifiers| PatternField { pattern, modifiers };
    vec![
        (
            "boxed",
            field(Pattern::Boxed, Modifiers::default()),
            [
                0.25, 0.7, 0.0, 0.214, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
            ],
        ),
        (
            "bozo",
            field(Pattern::Bozo, Modifiers::default()),
            [
                0.556580288,
                0.221474412,
                0.363123329,
                0.498703617,
                0.851393781,
                0.621927864,
                0.667061913,
                0.543456468,
                0.465511447,
                0.460850226,
                0.624928467,
                0.328620973,
            ],
        ),
        (
            "cells",
            field(Pattern::Cells, Modifiers::default()),
            [
                0.711818915,
                0.772366212,
                0.947394257,
                0.0965327462,
                0.538601437,
                0.538596677,
                0.132996031,
                0.624293637,
                0.805112416,
                0.0870772153,
                0.405315419,
                0.861968809,
            ],
        ),
        (
            "cylindrical",
            field(Pattern::Cylindrical, Modifiers::default()),
            [
                0.209430585,
                0.683772234,
                0.0,
                0.265517475,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
            ],
        ),
        (
            "dents",
            field(Pattern::Dents, Modifiers::default()),
            [
                0.172418341,
                0.0108635227,
                0.0478809163,
                0.124030231,
                0.617150977,
                0.240558133,
                0.296823604,
                0.160507114,
                0.100876753,
                0.0978767219,
                0.244056807,
                0.0354883518,
            ],
        ),
        (
            "granite",
            field(Pattern::Granite, Modifiers::default()),
            [
                0.421442084,
                0.140308305,
                0.56797469,
                0.315959011,
                0.412645865,
                0.42469369,
                0.551885264,
                0.378129189,
                0.321736163,
                0.356583072,
                0.420379682,
                0.0715715156,
            ],
        ),
        (
            "leopard",
            field(Pattern::Leopard, Modifiers::default()),
            [
                0.220420315,
                0.00429830121,
                0.0887977417,
                9.05827586e-05,
                0.104753465,
                0.407523329,
                0.246589938,
                0.0643373794,
                0.173193601,
                0.107765511,
                0.346749747,
                0.0362220243,
            ],
        ),
        (
            "marble",
            field(Pattern::Marble, Modifiers::default()),
            [
                0.5, 0.6, 0.84504, 0.5374, 0.0458, 0.54362, 0.19922, 0.45422, 0.2392, 0.37362,
                0.3952, 0.75136,
            ],
        ),
        (
            "onion",
            field(Pattern::Onion, Modifiers::default()),
            [
                0.935414347,
                0.374165739,
                0.337536652,
                0.0757604659,
                0.736887075,
                0.00925074841,
                0.467615991,
                0.804654831,
                0.89724631,
                0.620306755,
                0.843129237,
                0.207674514,
            ],
        ),
        (
            "planar",
            field(Pattern::Planar, Modifiers::default()),
            [
                0.5, 0.8, 0.0, 0.214, 0.0, 0.0, 0.7055, 0.6776, 0.4504, 0.0, 0.0, 0.5797,
            ],
        ),
        (
            "radial",
            field(Pattern::Radial, Modifiers::default()),
            [
                0.801208191,
                0.448791809,
                0.628398616,
                0.985178667,
                0.182714472,
                0.993161709,
                0.842691763,
                0.49118454,
                0.33055911,
                0.141248109,
                0.262547011,
                0.115719768,
            ],
        ),
        (
            "spherical",
            field(Pattern::Spherical, Modifiers::default()),
            [
                0.0645856533,
                0.625834261,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
            ],
        ),
        (
            "wood",
            field(Pattern::Wood, Modifiers::default()),
            [
                0.881966011,
                0.721110255,
                0.805268562,
                0.147160188,
                0.670096265,
                0.0157130203,
                0.153852864,
                0.396068741,
                0.0757105413,
                0.292042018,
                0.703224103,
                0.825145004,
            ],
        ),
        (
            "wrinkles",
            field(Pattern::Wrinkles, Modifiers::default()),
            [
                0.577164619,
                0.188105895,
                0.351430491,
                0.480177687,
                0.869925592,
                0.68945908,
                0.706303815,
                0.530740524,
                0.381626993,
                0.554934301,
                0.656236026,
                0.303500154,
            ],
        ),
        (
            "checker",
            field(Pattern::Checker, Modifiers::default()),
            [0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
        ),
        (
            "brick",
            field(
                Pattern::Brick {
                    size: DVec3::new(8.0, 3.0, 4.5),
                    mortar: 0.5,
                },
                Modifiers::default(),
            ),
            [1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0],
        ),
        (
            "brick brick_size <2,1,1.5> mortar .1",
            field(
                Pattern::Brick {
                    size: DVec3::new(2.0, 1.0, 1.5),
                    mortar: 0.1,
                },
                Modifiers::default(),
            ),
            [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0],
        ),
        (
            "agate",
            field(Pattern::Agate { turbulence: 1.0 }, Modifiers::default()),
            [
                0.97730419,
                0.918294816,
                0.1092324,
                0.985277353,
                0.234277376,
                0.187307269,
                0.575820254,
                0.99997005,
                0.998619707,
                0.540994962,
                0.386788536,
                0.751490902,
            ],
        ),
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
            "gradient <1,2,3>",
            field(
                Pattern::Gradient(DVec3::new(1.0, 2.0, 3.0)),
                Modifiers::default(),
            ),
            [
                0.935414347,
                0.946547752,
                0.280544126,
                0.830075302,
                0.79893659,
                0.0678422921,
                0.978867076,
                0.619687253,
                0.785093847,
                0.876792567,
                0.226997532,
                0.715392115,
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
            "bozo noise_generator 1",
            field(
                Pattern::Bozo,
                Modifiers {
                    noise: NoiseGenerator::Original,
                    ..Modifiers::default()
                },
            ),
            [
                0.583792463,
                0.0,
                0.188866137,
                0.465642043,
                1.0,
                0.717194116,
                0.809331532,
                0.557001275,
                0.397882984,
                0.388367488,
                0.723319599,
                0.118432441,
            ],
        ),
        (
            "bozo noise_generator 3",
            field(
                Pattern::Bozo,
                Modifiers {
                    noise: NoiseGenerator::Perlin,
                    ..Modifiers::default()
                },
            ),
            [
                0.688600536,
                0.409010998,
                0.800938541,
                0.407655189,
                0.617817011,
                0.682824301,
                0.616360945,
                0.468504001,
                0.404178994,
                0.596276948,
                0.586680027,
                0.416967366,
            ],
        ),
        (
            "granite noise_generator 3",
            field(
                Pattern::Granite,
                Modifiers {
                    noise: NoiseGenerator::Perlin,
                    ..Modifiers::default()
                },
            ),
            [
                0.0888779837,
                0.775912693,
                0.647117857,
                0.188042662,
                0.770757734,
                0.405522508,
                0.596819041,
                0.250715938,
                0.228326259,
                0.640188328,
                0.153324105,
                0.391687628,
            ],
        ),
        (
            "wrinkles noise_generator 1",
            field(
                Pattern::Wrinkles,
                Modifiers {
                    noise: NoiseGenerator::Original,
                    ..Modifiers::default()
                },
            ),
            [
                0.547092164,
                0.171009492,
                0.321941639,
                0.448263632,
                0.861933714,
                0.661712075,
                0.678905639,
                0.499706696,
                0.347854742,
                0.525068903,
                0.627801021,
                0.267760518,
            ],
        ),
        (
            "spiral1 3",
            field(Pattern::Spiral1(3.0), Modifiers::default()),
            [
                0.824756864,
                0.45956913,
                0.635561889,
                0.999349036,
                0.415567602,
                0.174352529,
                0.736117738,
                0.264484621,
                0.866394641,
                0.404216247,
                0.439483707,
                0.0698273761,
            ],
        ),
        (
            "spiral2 3",
            field(Pattern::Spiral2(3.0), Modifiers::default()),
            [
                0.586654249,
                0.36141877,
                0.881440903,
                0.293078448,
                0.171267734,
                0.380331098,
                0.220298797,
                0.679053277,
                0.115709636,
                0.60760347,
                0.285395619,
                0.20997524,
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
            "quilted",
            field(
                Pattern::Quilted {
                    control0: 1.0,
                    control1: 1.0,
                },
                Modifiers::default(),
            ),
            [
                0.140460534,
                0.312364701,
                0.151400409,
                0.335647701,
                0.344429253,
                0.421238047,
                0.355785377,
                0.291072001,
                0.154985858,
                0.299455383,
                0.12877599,
                0.181277018,
            ],
        ),
        (
            "quilted control0 .25 control1 .75",
            field(
                Pattern::Quilted {
                    control0: 0.25,
                    control1: 0.75,
                },
                Modifiers::default(),
            ),
            [
                0.0648206458,
                0.188205497,
                0.0690674443,
                0.210174246,
                0.22475191,
                0.304452955,
                0.230390617,
                0.170310514,
                0.0759793118,
                0.173491054,
                0.0585191777,
                0.0915031802,
            ],
        ),
        (
            "ripples",
            field(Pattern::Ripples { sources: 10 }, Modifiers::default()),
            [
                0.298197951,
                0.522351696,
                0.566861428,
                0.333863621,
                0.440073081,
                0.496757347,
                0.629871659,
                0.688343992,
                0.52952294,
                0.367528746,
                0.471954371,
                0.496999519,
            ],
        ),
        (
            "waves",
            field(Pattern::Waves { sources: 10 }, Modifiers::default()),
            [
                0.666863345,
                0.669718098,
                0.463283316,
                0.596478727,
                0.546637014,
                0.614181633,
                0.357400578,
                0.526116787,
                0.688906036,
                0.423822366,
                0.442794753,
                0.471449872,
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
        (
            "crackle",
            field(
                Pattern::Crackle(Crackle {
                    ..Crackle::default()
                }),
                Modifiers::default(),
            ),
            [
                0.221593356,
                0.134887752,
                0.0800496196,
                0.108451715,
                0.0949308159,
                0.11335728,
                0.32389494,
                0.030258704,
                0.357689485,
                0.28103145,
                0.257934871,
                0.194792638,
            ],
        ),
        (
            "crackle solid",
            field(
                Pattern::Crackle(Crackle {
                    solid: true,
                    ..Crackle::default()
                }),
                Modifiers::default(),
            ),
            [
                0.432515687,
                0.4577364,
                0.570989864,
                0.496018494,
                0.621985513,
                0.50309701,
                0.563856171,
                0.500315688,
                0.303845292,
                0.504705968,
                0.538974371,
                0.418649012,
            ],
        ),
        (
            "crackle form <1,0,0>",
            field(
                Pattern::Crackle(Crackle {
                    form: DVec3::X,
                    ..Crackle::default()
                }),
                Modifiers::default(),
            ),
            [
                0.610090853,
                0.563284611,
                0.660408021,
                0.525454319,
                0.531799698,
                0.413935225,
                0.320595665,
                0.591729238,
                0.293629977,
                0.553940929,
                0.571356535,
                0.59613494,
            ],
        ),
        (
            "crackle form <0,.25,.25> metric 1",
            field(
                Pattern::Crackle(Crackle {
                    form: DVec3::new(0.0, 0.25, 0.25),
                    metric: CrackleMetric::from_number(1.0),
                    ..Crackle::default()
                }),
                Modifiers::default(),
            ),
            [
                0.638177555,
                0.539519615,
                0.594902961,
                0.515293845,
                0.601499454,
                0.477902227,
                0.493955847,
                0.510494652,
                0.466290373,
                0.571806237,
                0.625290055,
                0.557395611,
            ],
        ),
        (
            "crackle metric 3 offset .25",
            field(
                Pattern::Crackle(Crackle {
                    metric: CrackleMetric::from_number(3.0),
                    offset: 0.25,
                    ..Crackle::default()
                }),
                Modifiers::default(),
            ),
            [
                0.18355917,
                0.0978558794,
                0.0779862082,
                0.129195942,
                0.0620347044,
                0.0514510868,
                0.257799213,
                0.0836937453,
                0.319265545,
                0.259221797,
                0.249022925,
                0.0893658187,
            ],
        ),
        (
            "hexagon rgb 0 rgb 1 rgb 2",
            field(Pattern::Hexagon, Modifiers::default()),
            [0.0, 0.0, 2.0, 0.0, 0.0, 2.0, 0.0, 1.0, 2.0, 0.0, 2.0, 2.0],
        ),
        (
            "square rgb 0 rgb 1 rgb 2 rgb 3",
            field(Pattern::Square, Modifiers::default()),
            [0.0, 2.0, 3.0, 0.0, 1.0, 3.0, 3.0, 1.0, 3.0, 2.0, 2.0, 1.0],
        ),
        (
            "triangular rgb 0 rgb 1 rgb 2 rgb 3 rgb 4 rgb 5",
            field(Pattern::Triangular, Modifiers::default()),
            [1.0, 3.0, 4.0, 0.0, 2.0, 4.0, 0.0, 1.0, 2.0, 0.0, 4.0, 3.0],
        ),
        (
            "cubic rgb 0 rgb 1 rgb 2 rgb 3 rgb 4 rgb 5",
            field(Pattern::Cubic, Modifiers::default()),
            [2.0, 3.0, 2.0, 4.0, 5.0, 0.0, 2.0, 3.0, 5.0, 5.0, 5.0, 0.0],
        ),
        (
            "mandel 20",
            field(
                Pattern::Fractal(Fractal {
                    ..Fractal::mandelbrot(20)
                }),
                Modifiers::default(),
            ),
            [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.1, 0.15, 0.0, 0.0, 0.0],
        ),
        (
            "mandel 20 exponent 3 exterior 2,.0625 interior 1,1",
            field(
                Pattern::Fractal(Fractal {
                    kind: FractalKind::Power { exponent: 3 },
                    exterior: Exterior::Real(0.0625),
                    interior: FractalInterior::Smallest(1.0),
                    ..Fractal::mandelbrot(20)
                }),
                Modifiers::default(),
            ),
            [
                0.448638072,
                0.360555128,
                0.153477251,
                0.151426714,
                0.786418372,
                0.0920262957,
                0.516829151,
                0.57546257,
                0.313002995,
                0.83444495,
                0.717014015,
                0.907813504,
            ],
        ),
        (
            "julia <.353,.288>,20 interior 1,1",
            field(
                Pattern::Fractal(Fractal {
                    julia: Some(DVec2::new(0.353, 0.288)),
                    interior: FractalInterior::Smallest(1.0),
                    ..Fractal::mandelbrot(20)
                }),
                Modifiers::default(),
            ),
            [
                0.399637664,
                0.319185646,
                0.0,
                0.166177138,
                0.0,
                0.0,
                0.0,
                0.0,
                0.268499955,
                0.0,
                0.05,
                0.0,
            ],
        ),
        (
            "magnet 1 mandel 20 interior 1,.125",
            field(
                Pattern::Fractal(Fractal {
                    kind: FractalKind::Magnet1,
                    interior: FractalInterior::Smallest(0.125),
                    ..Fractal::mandelbrot(20)
                }),
                Modifiers::default(),
            ),
            [
                0.0306603774,
                0.45,
                0.1,
                0.0326575751,
                0.00268799534,
                0.000346602082,
                0.1,
                0.15,
                0.2,
                0.25,
                0.65,
                0.15,
            ],
        ),
        (
            "magnet 2 julia <.5,.25>,20",
            field(
                Pattern::Fractal(Fractal {
                    kind: FractalKind::Magnet2,
                    julia: Some(DVec2::new(0.5, 0.25)),
                    ..Fractal::mandelbrot(20)
                }),
                Modifiers::default(),
            ),
            [1.0, 1.0, 1.0, 1.0, 1.0, 0.15, 0.1, 1.0, 1.0, 1.0, 1.0, 0.3],
        ),
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

#[test]
fn equals_the_measured_values() {
    for (written, field, values) in measured() {
        for (p, expected) in POINTS.iter().zip(values) {
            let point = TexturePoint::in_space(DVec3::from_array(*p));
            let got = field.value(&point);
            if field.pattern.block_count() > Some(2) {
                assert_eq!(field.block(&point), expected as usize, "{written} at {p:?}");
            } else {
                assert!(
                    (got - expected).abs() < 2e-8,
                    "{written} at {p:?}: {got} is not {expected}"
                );
            }
        }
    }
}

#[test]
fn hostile_points_do_not_panic() {
    for (_, field, _) in measured() {
        for x in [f64::NAN, f64::INFINITY, -1e300, 1e300, 1e18, -0.0] {
            for p in [
                DVec3::splat(x),
                DVec3::new(0.5, x, 0.25),
                DVec3::new(x, 0.0, 0.0),
            ] {
                let point = TexturePoint::in_space(p);
                let _ = field.value(&point);
                let block = field.block(&point);
                assert!(block < field.pattern.block_count().unwrap_or(1));
            }
        }
    }
}
