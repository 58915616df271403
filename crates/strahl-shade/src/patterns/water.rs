//! Ripples and waves: circles around a few sources near the origin.

use strahl_math::DVec3;
use strahl_math::noise::dnoise;

use super::Modifiers;
use super::noisy::cycloidal;

/// Source `i`: a random point of the unit sphere.
pub(super) fn source(i: u32) -> DVec3 {
    dnoise(DVec3::new(f64::from(i), 0.0, 0.0)).normalize_or(DVec3::X)
}

/// The spatial frequency of source `i` in waves, `0.01..=1.01`.
///
/// The first ten were measured; the rest are drawn from another stream than POV-Ray's and therefore give other,
/// equally random, waves.
pub(super) fn wave_frequency(i: u32) -> f64 {
    const MEASURED: [u16; 10] = [
        29789, 31130, 13866, 22914, 22255, 32159, 25328, 12801, 7198, 5194,
    ];
    match MEASURED.get(i as usize) {
        Some(&k) => f64::from(k) / 32767.0 + 0.01,
        None => super::random::uniform(i as usize) + 0.01,
    }
}

pub(super) fn ripples(p: DVec3, sources: u32, modifiers: &Modifiers) -> f64 {
    let sum: f64 = (0..sources)
        .map(|i| cycloidal((p - source(i)).length() * modifiers.frequency + modifiers.phase))
        .sum();
    0.5 * (1.0 + sum / f64::from(sources.max(1)))
}

pub(super) fn waves(p: DVec3, sources: u32, modifiers: &Modifiers) -> f64 {
    let sum: f64 = (0..sources)
        .map(|i| {
            let f = wave_frequency(i);
            let length = (p - source(i)).length();
            cycloidal(length * modifiers.frequency * f + modifiers.phase) / f
        })
        .sum();
    0.5 + 0.2 * sum / f64::from(sources.max(1))
}

/// The perturbation of a normal by ripples: away from the sources, by the wave's slope.
pub(crate) fn ripples_tilt(p: DVec3, sources: u32, modifiers: &Modifiers) -> DVec3 {
    tilt(p, sources, |_, length| {
        cycloidal(length * modifiers.frequency + modifiers.phase)
    })
}

/// The perturbation of a normal by waves.
pub(crate) fn waves_tilt(p: DVec3, sources: u32, modifiers: &Modifiers) -> DVec3 {
    tilt(p, sources, |i, length| {
        let f = wave_frequency(i);
        cycloidal(length * modifiers.frequency * f + modifiers.phase) / f
    })
}

/// The mean over the sources of the unit vector from the source times `strength(source, distance)`.
fn tilt(p: DVec3, sources: u32, strength: impl Fn(u32, f64) -> f64) -> DVec3 {
    let sum = (0..sources)
        .map(|i| {
            let from_source = p - source(i);
            let length = from_source.length();
            from_source.normalize_or_zero() * strength(i, length)
        })
        .fold(DVec3::ZERO, |a, b| a + b);
    sum / f64::from(sources.max(1))
}
