//! Waves, frequencies and turbulence.

use super::{Built, field};
use crate::patterns::*;
use strahl_math::noise::{NoiseGenerator, Turbulence};

pub(super) fn built() -> Vec<Built> {
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
        ),
    ]
}
