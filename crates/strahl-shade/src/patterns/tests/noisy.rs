//! Patterns of noise.

use super::{Built, field};
use crate::patterns::*;
use strahl_math::noise::NoiseGenerator;

pub(super) fn built() -> Vec<Built> {
    vec![
        ("bozo", field(Pattern::Bozo, Modifiers::default())),
        ("cells", field(Pattern::Cells, Modifiers::default())),
        ("dents", field(Pattern::Dents, Modifiers::default())),
        ("granite", field(Pattern::Granite, Modifiers::default())),
        ("wrinkles", field(Pattern::Wrinkles, Modifiers::default())),
        (
            "agate",
            field(Pattern::Agate { turbulence: 1.0 }, Modifiers::default()),
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
        ),
        (
            "ripples",
            field(Pattern::Ripples { sources: 10 }, Modifiers::default()),
        ),
        (
            "waves",
            field(Pattern::Waves { sources: 10 }, Modifiers::default()),
        ),
        (
            "crackle",
            field(
                Pattern::Crackle(Crackle {
                    ..Crackle::default()
                }),
                Modifiers::default(),
            ),
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
        ),
        (
            "crackle form <.5,.2,0> metric 1 offset -.25",
            field(
                Pattern::Crackle(Crackle {
                    form: DVec3::new(0.5, 0.2, 0.0),
                    metric: CrackleMetric::from_number(1.0),
                    offset: -0.25,
                    ..Crackle::default()
                }),
                Modifiers::default(),
            ),
        ),
        (
            "crackle metric 3 offset -.1",
            field(
                Pattern::Crackle(Crackle {
                    metric: CrackleMetric::from_number(3.0),
                    offset: -0.1,
                    ..Crackle::default()
                }),
                Modifiers::default(),
            ),
        ),
    ]
}
