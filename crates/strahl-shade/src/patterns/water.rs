//! Ripples and waves: circles around a few sources near the origin. Four sources are computed at once.

use std::borrow::Cow;
use std::sync::LazyLock;

use strahl_math::noise::dnoise;
use strahl_math::{DVec3, det};
use strahl_simd::{Isa, Simd, dispatch};

use super::Modifiers;

/// Source `i`: a random point of the unit sphere.
fn source(i: u32) -> DVec3 {
    dnoise(DVec3::new(f64::from(i), 0.0, 0.0)).normalize_or(DVec3::X)
}

/// The spatial frequency of the waves of source `i`, `0.01..=1.01`.
///
/// The first ten were measured; the rest are drawn from another stream than POV-Ray's and therefore give other,
/// equally random, waves.
fn wave_frequency(i: u32) -> f64 {
    const MEASURED: [u16; 10] = [
        29789, 31130, 13866, 22914, 22255, 32159, 25328, 12801, 7198, 5194,
    ];
    match MEASURED.get(i as usize) {
        Some(&k) => f64::from(k) / 32767.0 + 0.01,
        None => super::random::uniform(i as usize) + 0.01,
    }
}

/// Four sources: the coordinates of their positions, and their spatial frequencies.
#[derive(Clone, Copy)]
struct Sources {
    position: [[f64; 4]; 3],
    frequency: [f64; 4],
}

impl Sources {
    /// Those from number `4 chunk` on.
    fn new(chunk: u32) -> Self {
        let number = |lane: usize| 4 * chunk + lane as u32;
        Self {
            position: std::array::from_fn(|axis| {
                std::array::from_fn(|lane| source(number(lane))[axis])
            }),
            frequency: std::array::from_fn(|lane| wave_frequency(number(lane))),
        }
    }

    /// The same, remembered for the first ones. A scene has ten sources if it doesn't say how many.
    #[inline]
    fn remembered(chunk: u32) -> Cow<'static, Self> {
        static FIRST: LazyLock<[Sources; 8]> =
            LazyLock::new(|| std::array::from_fn(|chunk| Sources::new(chunk as u32)));
        match FIRST.get(chunk as usize) {
            Some(sources) => Cow::Borrowed(sources),
            None => Cow::Owned(Self::new(chunk)),
        }
    }
}

/// How many of the four sources of a chunk there are.
#[inline(always)]
fn lanes(sources: u32, chunk: u32) -> usize {
    (sources - 4 * chunk).min(4) as usize
}

/// How the circles around the sources differ.
#[derive(Clone, Copy, PartialEq)]
enum Water {
    /// All circles have one frequency and one height.
    Ripples,
    /// Each source has its frequency; long waves are high.
    Waves,
}

/// The heights of the circles of four sources at a point, and the unit vectors that lead there from the sources (0 at a source itself).
#[inline(always)]
fn circles<I: Isa>(
    isa: I,
    water: Water,
    sources: &Sources,
    p: DVec3,
    modifiers: &Modifiers,
) -> (I::F64x4, [I::F64x4; 3]) {
    let frequency = isa.splat(modifiers.frequency);
    let mut from_source = [isa.splat(p.x), isa.splat(p.y), isa.splat(p.z)];
    for (d, position) in from_source.iter_mut().zip(&sources.position) {
        *d = isa.sub(*d, isa.load(position));
    }
    let [x, y, z] = from_source;
    let squares = isa.add(isa.add(isa.mul(x, x), isa.mul(y, y)), isa.mul(z, z));
    let length = isa.sqrt(squares);
    let inverse = isa.div(isa.splat(1.0), length);
    let inverse = isa.choose_le(inverse, isa.splat(f64::MAX), inverse, isa.splat(0.0));
    let own = isa.load(&sources.frequency);
    let mut angle = isa.mul(length, frequency);
    if water == Water::Waves {
        angle = isa.mul(angle, own);
    }
    let angle = isa.add(angle, isa.splat(modifiers.phase));
    let mut height = det::sines(isa, isa.mul(isa.splat(std::f64::consts::TAU), angle));
    if water == Water::Waves {
        height = isa.div(height, own);
    }
    let unit = [
        isa.mul(x, inverse),
        isa.mul(y, inverse),
        isa.mul(z, inverse),
    ];
    (height, unit)
}

/// The sum of the heights of the circles around the sources.
fn height(simd: Simd, water: Water, p: DVec3, sources: u32, modifiers: &Modifiers) -> f64 {
    dispatch!(simd, isa => {
        let mut sum = 0.0;
        for chunk in 0..sources.div_ceil(4) {
            let (height, _) = circles(isa, water, &Sources::remembered(chunk), p, modifiers);
            for height in &isa.store(height)[..lanes(sources, chunk)] {
                sum += height;
            }
        }
        sum
    })
}

/// The mean over the sources of the unit vector from the source times the height of its circle.
fn tilt(simd: Simd, water: Water, p: DVec3, sources: u32, modifiers: &Modifiers) -> DVec3 {
    let sum = dispatch!(simd, isa => {
        let zero = isa.splat(0.0);
        let mut sum = zero;
        for chunk in 0..sources.div_ceil(4) {
            let (height, [x, y, z]) = circles(isa, water, &Sources::remembered(chunk), p, modifiers);
            let terms = isa.transpose([isa.mul(x, height), isa.mul(y, height), isa.mul(z, height), zero]);
            for term in &terms[..lanes(sources, chunk)] {
                sum = isa.add(sum, *term);
            }
        }
        isa.store(sum)
    });
    DVec3::new(sum[0], sum[1], sum[2]) / f64::from(sources.max(1))
}

pub(super) fn ripples(p: DVec3, sources: u32, modifiers: &Modifiers) -> f64 {
    let sum = height(Simd::best(), Water::Ripples, p, sources, modifiers);
    0.5 * (1.0 + sum / f64::from(sources.max(1)))
}

pub(super) fn waves(p: DVec3, sources: u32, modifiers: &Modifiers) -> f64 {
    let sum = height(Simd::best(), Water::Waves, p, sources, modifiers);
    0.5 + 0.2 * sum / f64::from(sources.max(1))
}

/// The perturbation of a normal by ripples: away from the sources, by the wave's slope.
pub(crate) fn ripples_tilt(p: DVec3, sources: u32, modifiers: &Modifiers) -> DVec3 {
    tilt(Simd::best(), Water::Ripples, p, sources, modifiers)
}

/// The perturbation of a normal by waves.
pub(crate) fn waves_tilt(p: DVec3, sources: u32, modifiers: &Modifiers) -> DVec3 {
    tilt(Simd::best(), Water::Waves, p, sources, modifiers)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same, source by source.
    fn slowly(water: Water, p: DVec3, sources: u32, modifiers: &Modifiers) -> (f64, DVec3) {
        let (mut sum, mut tilt) = (0.0, DVec3::ZERO);
        for i in 0..sources {
            let (from_source, own) = (p - source(i), wave_frequency(i));
            let length = from_source.length();
            let cycloidal = super::super::noisy::cycloidal;
            let height = match water {
                Water::Ripples => cycloidal(length * modifiers.frequency + modifiers.phase),
                Water::Waves => {
                    cycloidal(length * modifiers.frequency * own + modifiers.phase) / own
                }
            };
            sum += height;
            tilt += from_source.normalize_or_zero() * height;
        }
        (sum, tilt / f64::from(sources.max(1)))
    }

    #[test]
    fn four_sources_at_once_give_the_bits_of_one_after_the_other() {
        for water in [Water::Ripples, Water::Waves] {
            for sources in [0, 1, 3, 4, 10, 35] {
                let modifiers = Modifiers {
                    frequency: 1.7,
                    phase: 0.3,
                    ..Modifiers::default()
                };
                let at_a_source = (0..4).map(source);
                let others = (0..500).map(|i| {
                    let t = f64::from(i);
                    DVec3::new(t * 0.731 - 40.0, t * t * 0.0317, 9.0 - t * 0.613)
                });
                for p in at_a_source.chain(others) {
                    let (sum, push) = slowly(water, p, sources, &modifiers);
                    for simd in Simd::available() {
                        let level = simd.level();
                        let height = height(simd, water, p, sources, &modifiers);
                        assert_eq!(height, sum, "{p}, {level}");
                        let tilt = tilt(simd, water, p, sources, &modifiers);
                        assert_eq!(tilt, push, "{p}, {level}");
                    }
                }
            }
        }
    }
}
