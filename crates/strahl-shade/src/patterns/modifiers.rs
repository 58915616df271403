use strahl_math::noise::{NoiseGenerator, Turbulence};
use strahl_math::{DVec3, det};

use super::Warp;

/// How the value of a pattern runs through `0..=1` over one period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wave {
    /// Straight up, then a jump down.
    Ramp,
    /// Straight up and down again.
    Triangle,
    /// `(1 + sin 2πx) / 2`.
    Sine,
    /// `|sin πx|`.
    Scallop,
    /// `3x² - 2x³`.
    Cubic,
    /// `x` to this power.
    Poly(f64),
}

impl Wave {
    /// The wave form at `x` in `0..=1`.
    pub fn apply(self, x: f64) -> f64 {
        use std::f64::consts::{PI, TAU};
        match self {
            Self::Ramp => x,
            Self::Triangle => triangle(x),
            Self::Sine => 0.5 * (1.0 + det::sin(TAU * x)),
            Self::Scallop => det::sin(PI * x).abs(),
            Self::Cubic => x * x * (3.0 - 2.0 * x),
            Self::Poly(exponent) => det::pow(x, exponent),
        }
    }
}

/// Up from 0 to 1 over the first half of a period of 1, and down again over the second.
pub(super) fn triangle(x: f64) -> f64 {
    let x = x - x.floor();
    if x < 0.5 { 2.0 * x } else { 2.0 - 2.0 * x }
}

/// The period of the values that maps are looked up with.
const PERIOD: f64 = 1.000_01;

/// `x % PERIOD`, with the same bits. The library's function takes 110 instructions.
fn repeated(x: f64) -> f64 {
    /// Numbers from here on take the library's function.
    const FAR: f64 = (1 << 20) as f64;
    /// The period without its last 21 bits, so that products with whole numbers below `FAR` are exact.
    const HIGH: f64 = f64::from_bits(PERIOD.to_bits() >> 21 << 21);
    const LOW: f64 = PERIOD - HIGH;
    let size = x.abs();
    if size < PERIOD {
        return x;
    }
    if !(size < FAR) {
        return x % PERIOD;
    }
    // Both differences are exact: they are multiples of 2^-52 below 2.
    let periods = f64::from((size / PERIOD) as u32);
    let rest = (size - periods * HIGH) - periods * LOW;
    // The quotient was rounded.
    let rest = if rest < 0.0 {
        rest + PERIOD
    } else if rest >= PERIOD {
        rest - PERIOD
    } else {
        rest
    };
    rest.copysign(x)
}

/// Modifiers that apply to any pattern.
#[derive(Clone, Debug, PartialEq)]
pub struct Modifiers {
    /// Warps and transformations in the order they are written; the last is applied to the point first.
    pub warps: Vec<Warp>,
    /// The amplitude of turbulence along each axis; zero is no turbulence.
    pub turbulence: DVec3,
    /// The octaves of `turbulence`, and of the patterns that have a turbulence built in.
    pub octaves: Turbulence,
    /// How often the map is run through over one period of the pattern.
    pub frequency: f64,
    /// Added to the value after multiplication with `frequency`.
    pub phase: f64,
    /// The wave form; `None` takes the pattern's.
    pub wave: Option<Wave>,
    /// The noise used by the pattern. Turbulence always uses the same vector noise.
    pub noise: NoiseGenerator,
}

impl Default for Modifiers {
    /// None of them, and POV-Ray's default of six octaves.
    fn default() -> Self {
        Self {
            warps: Vec::new(),
            turbulence: DVec3::ZERO,
            octaves: Turbulence::default(),
            frequency: 1.0,
            phase: 0.0,
            wave: None,
            noise: NoiseGenerator::default(),
        }
    }
}

impl Modifiers {
    /// The value that a map is looked up with: `value · frequency + phase`, repeated with period 1, bent by the wave form.
    ///
    /// The period is 1.00001, so that a value of exactly 1 doesn't become 0, but a negative remainder is raised by 1:
    /// POV-Ray does so, and values of far-off places therefore differ by 1e-5 from those of a period of 1.
    ///
    /// A frequency of 0 leaves the value as it is, with a period of exactly 1 and without the phase (measured).
    pub fn shape(&self, value: f64, wave: Wave) -> f64 {
        if self.frequency == 0.0 {
            let is_whole = (0.0..=1.0).contains(&value);
            return wave.apply(if is_whole {
                value
            } else {
                value - value.floor()
            });
        }
        let x = repeated(value * self.frequency + self.phase);
        let x = if x < 0.0 { x + 1.0 } else { x };
        wave.apply(x)
    }

    /// The point after warps, transformations and turbulence.
    pub fn moved(&self, p: DVec3) -> DVec3 {
        self.displaced(self.warped(p))
    }

    /// The point after the warps and transformations.
    pub(crate) fn warped(&self, p: DVec3) -> DVec3 {
        self.warps.iter().rev().fold(p, |p, warp| warp.apply(p))
    }

    /// The point after turbulence.
    pub(crate) fn displaced(&self, p: DVec3) -> DVec3 {
        if self.turbulence == DVec3::ZERO {
            p
        } else {
            p + self.turbulence * self.octaves.vector(p)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_values_are_remainders_bit_for_bit() {
        let check = |x: f64| {
            for x in [x.next_down(), x, x.next_up()] {
                for x in [x, -x] {
                    let expected = x % PERIOD;
                    assert_eq!(repeated(x).to_bits(), expected.to_bits(), "{x:e}");
                }
            }
        };
        let mut state = 7u64;
        let mut unit = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        for n in 0..3000 {
            check(f64::from(n) * PERIOD);
            check(f64::from(n));
            check(unit() * 10.0);
            check(unit() * f64::from(1 << (n % 25)));
            check(f64::from(350 * n) * PERIOD);
        }
        for x in [0.0, PERIOD, f64::MIN_POSITIVE, 1e-310, 1e300, f64::MAX] {
            check(x);
        }
        assert!(repeated(f64::NAN).is_nan() && repeated(f64::INFINITY).is_nan());
    }
}
