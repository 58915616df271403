//! Patterns made of noise.

use strahl_math::noise::{NoiseGenerator, noise, pattern_octaves, pattern_octaves_of_four};
use strahl_math::{DVec3, det};

use super::Modifiers;

/// `sin 2πx`.
pub(super) fn cycloidal(x: f64) -> f64 {
    det::sin(std::f64::consts::TAU * x)
}

pub(super) fn agate(p: DVec3, strength: f64, modifiers: &Modifiers) -> f64 {
    let stirred = strength * modifiers.octaves.scalar(p, modifiers.noise);
    let wave = 0.5 * (cycloidal(1.3 * stirred + 1.1 * p.z) + 1.0);
    det::pow(wave.clamp(0.0, 1.0), 0.77)
}

pub(super) fn dents(p: DVec3, generator: NoiseGenerator) -> f64 {
    let n = noise(p, generator);
    n * n * n
}

pub(super) fn granite(p: DVec3, generator: NoiseGenerator) -> f64 {
    let octaves: [f64; 6] = pattern_octaves(p, 4.0, generator);
    let mut frequency = 1.0;
    let mut sum = 0.0;
    for value in octaves {
        sum += (0.5 - value).abs() / frequency;
        frequency *= 2.0;
    }
    sum
}

pub(super) fn marble(p: DVec3, modifiers: &Modifiers) -> f64 {
    let strength = modifiers.turbulence.x;
    if strength == 0.0 {
        p.x
    } else {
        p.x + strength * modifiers.octaves.scalar(p, modifiers.noise)
    }
}

pub(super) fn wood(p: DVec3, modifiers: &Modifiers) -> f64 {
    let amount = modifiers.turbulence;
    if amount == DVec3::ZERO {
        return (p.x * p.x + p.y * p.y).sqrt();
    }
    let t = modifiers.octaves.vector(p);
    let x = p.x + cycloidal((p.x + t.x) * amount.x);
    let y = p.y + cycloidal((p.y + t.y) * amount.y);
    (x * x + y * y).sqrt()
}

pub(super) fn wrinkles(p: DVec3, generator: NoiseGenerator) -> f64 {
    let octaves: [f64; 10] = pattern_octaves(p, 1.0, generator);
    let mut frequency = 1.0;
    let mut sum = 0.0;
    for value in octaves {
        sum += value / frequency;
        frequency *= 2.0;
    }
    0.5 * sum
}

/// [`granite`] at four places, given axis by axis.
pub(super) fn granite_of_four(places: &[[f64; 4]; 3], generator: NoiseGenerator) -> [f64; 4] {
    let octaves: [_; 6] = pattern_octaves_of_four(places, 4.0, generator);
    sum_of_octaves(octaves, |value| (0.5 - value).abs())
}

/// [`wrinkles`] at four places, given axis by axis.
pub(super) fn wrinkles_of_four(places: &[[f64; 4]; 3], generator: NoiseGenerator) -> [f64; 4] {
    let octaves: [_; 10] = pattern_octaves_of_four(places, 1.0, generator);
    sum_of_octaves(octaves, |value| value).map(|sum| 0.5 * sum)
}

/// The sum over octaves of what they add, each half as strong as the one before.
fn sum_of_octaves<const N: usize>(octaves: [[f64; 4]; N], addend: impl Fn(f64) -> f64) -> [f64; 4] {
    let mut frequency = 1.0;
    let mut sums = [0.0; 4];
    for values in octaves {
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum += addend(value) / frequency;
        }
        frequency *= 2.0;
    }
    sums
}
