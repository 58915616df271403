//! Where pixels differ so much that they are refined.

use arrayvec::ArrayVec;
use std::{fmt, str::FromStr};
use strahl_math::det;
use strahl_shade::Color;

/// When and how far pixels are refined: POV-Ray's `+A`, `+R` and `+AG`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refinement {
    /// The sum of the differences of the three channels, as shown, beyond which two places differ; `0..=3`.
    pub threshold: f64,
    /// Samples along a side of a refined pixel, or levels of division plus one; `1..=9`. One is no refinement.
    pub depth: u32,
    /// Channels are compared as `v^(1/gamma)`, negative ones as 0; above 0.
    pub gamma: f64,
}

impl Refinement {
    /// POV-Ray's `+A0.3 +R3 +AG2.5`.
    pub const DEFAULT: Self = Self {
        threshold: 0.3,
        depth: 3,
        gamma: 2.5,
    };

    /// With the threshold that decides in which quadrants of a refined pixel further samples are taken. The default threshold and larger ones stay as they are.
    /// Smaller ones shrink with their square: where no samples are taken, the first one may be wrong by as much, and with small thresholds nothing else
    /// is left of the error (docs/src/notes/speed.md, "Which pixels differ, row by row").
    pub(crate) fn for_quadrants(self) -> Self {
        let share = (self.threshold / Self::DEFAULT.threshold).min(1.0);
        Self {
            threshold: self.threshold * share * share,
            ..self
        }
    }
}

impl Default for Refinement {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// The text has no three numbers in their ranges.
#[derive(Debug)]
pub struct UnknownRefinement;

impl FromStr for Refinement {
    type Err = UnknownRefinement;

    /// `THRESHOLD[,DEPTH[,GAMMA]]`.
    fn from_str(s: &str) -> Result<Self, Self::Err> {
        let mut refinement = Self::DEFAULT;
        let mut parts = s.split(',');
        let mut number = || match parts.next() {
            None => Ok(None),
            Some(part) => part.parse::<f64>().map(Some).map_err(|_| UnknownRefinement),
        };
        refinement.threshold = number()?.unwrap_or(refinement.threshold);
        if let Some(depth) = number()? {
            if !(1.0..=9.0).contains(&depth) || depth.fract() != 0.0 {
                return Err(UnknownRefinement);
            }
            refinement.depth = depth as u32;
        }
        refinement.gamma = number()?.unwrap_or(refinement.gamma);
        let valid = (0.0..=3.0).contains(&refinement.threshold)
            && refinement.gamma > 0.0
            && refinement.gamma.is_finite();
        match valid && number()?.is_none() {
            true => Ok(refinement),
            false => Err(UnknownRefinement),
        }
    }
}

impl fmt::Display for Refinement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.threshold, self.depth)?;
        if self.gamma != Self::DEFAULT.gamma {
            write!(f, ",{}", self.gamma)?;
        }
        Ok(())
    }
}

/// A colour as it is compared: channels raised to `1/gamma`, negative ones 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Compared([f32; 3]);

impl Compared {
    /// The number of colours that [`Compared::batch`] takes.
    pub(crate) const BATCH: usize = 16;

    pub(crate) fn new(color: Color, refinement: &Refinement) -> Self {
        Self::batch(&[color], refinement)[0]
    }

    /// A few colours at a time, with the same bits: powers take most of the time.
    pub(crate) fn batch(
        colors: &[Color],
        refinement: &Refinement,
    ) -> ArrayVec<Self, { Self::BATCH }> {
        let mut powers = ArrayVec::<f64, { 3 * Self::BATCH }>::new();
        powers.extend(colors.iter().flat_map(|color| color.to_array()));
        let positive = |v: &f64| *v > 0.0;
        for v in powers.iter_mut().filter(|v| !positive(v)) {
            *v = 0.0;
        }
        det::pow_all(&mut powers, 1.0 / refinement.gamma);
        let (colors, _) = powers.as_chunks();
        colors.iter().map(|c| Self(c.map(|v| v as f32))).collect()
    }

    /// Whether two colours differ so much that a place between them is looked at.
    pub(crate) fn differs(self, other: Self, refinement: &Refinement) -> bool {
        let [r, g, b] = [0, 1, 2].map(|i| f64::from(self.0[i] - other.0[i]).abs());
        r + g + b > refinement.threshold
    }
}

/// How steep the power is by which colours are compared: whether two of them are surely alike is seen without powers.
///
/// Between a and b the function x^p grows by at most |a - b| times its largest slope there. For p <= 1 this is the slope at the lesser
/// of the two; and it grows by at most |a - b|^p, because it is concave and zero at zero.
pub(crate) struct Slopes {
    /// The largest slope in each step of numbers: from a quarter of a power of two to the next.
    steps: ArrayVec<f64, { Self::STEPS }>,
    /// Colours whose difference has a smaller bound are alike.
    alike: f64,
    /// Colours are alike, too, if no channels differ by more.
    near: f64,
}

impl Slopes {
    /// From the least number to 2^16 times one.
    const STEPS: usize = 4 * 32;
    /// Of the numbers of the first step.
    const LEAST: f64 = 1.0 / 65536.0;

    pub(crate) fn new(refinement: &Refinement) -> Self {
        let power = 1.0 / refinement.gamma;
        let mut steps = ArrayVec::new();
        if power <= 1.0 {
            let first = Self::step(Self::LEAST);
            let edges = (first..).map(|step| f64::from_bits(step << 50));
            steps.extend(edges.take(Self::STEPS));
            det::pow_all(&mut steps, power - 1.0);
            for slope in &mut steps {
                *slope *= power;
            }
        }
        // Less than the threshold by more than all rounding errors: compared numbers have single precision.
        let alike = 0.999 * refinement.threshold - 1e-4;
        let near = match power <= 1.0 && alike > 0.0 {
            true => 0.999 * det::pow(alike / 3.0, refinement.gamma),
            false => -1.0,
        };
        Self { steps, alike, near }
    }

    /// The number of the step of a positive number.
    const fn step(v: f64) -> u64 {
        v.to_bits() >> 50
    }

    /// Whether two colours surely don't differ. If not, they may or may not.
    #[inline]
    pub(crate) fn surely_alike(&self, a: Color, b: Color) -> bool {
        let differences = [a.r - b.r, a.g - b.g, a.b - b.b].map(f64::abs);
        differences.iter().all(|d| *d <= self.near) || self.are_alike_by_slopes(a, b)
    }

    fn are_alike_by_slopes(&self, a: Color, b: Color) -> bool {
        let growth = |a: f64, b: f64| {
            if a == b {
                return 0.0;
            }
            let least = a.min(b);
            let from_first = || Self::step(least).checked_sub(Self::step(Self::LEAST));
            let step = (least > 0.0).then(from_first).flatten();
            let slope = step.and_then(|step| self.steps.get(step as usize));
            slope.map_or(f64::INFINITY, |slope| slope * (a - b).abs())
        };
        growth(a.r, b.r) + growth(a.g, b.g) + growth(a.b, b.b) <= self.alike
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// POV-Ray 3.7 refines 0.5 beside 0.7 and not 0.5 beside 0.65, with `+A0.3`; with `+AG1` 0.5 beside 0.61.
    #[test]
    fn greys_differ_where_they_do_in_pov_ray() {
        let differ = |a, b, gamma| {
            let r = Refinement {
                gamma,
                ..Refinement::DEFAULT
            };
            let shown = |v| Compared::new(Color::gray(v), &r);
            shown(a).differs(shown(b), &r)
        };
        assert!(differ(0.5, 0.7, 2.5) && !differ(0.5, 0.65, 2.5));
        assert!(differ(0.5, 0.61, 1.0) && !differ(0.5, 0.59, 1.0));
        assert!(differ(1.0, 3.0, 2.5) && !differ(-3.0, 0.0, 2.5));
    }

    #[test]
    fn quadrants_have_finer_thresholds_below_the_default() {
        let of = |threshold| {
            let refinement = Refinement {
                threshold,
                ..Refinement::DEFAULT
            };
            refinement.for_quadrants().threshold
        };
        assert_eq!([of(0.3), of(1.0), of(0.0)], [0.3, 1.0, 0.0]);
        assert!((of(0.1) - 0.1 / 9.0).abs() < 1e-12);
    }

    /// Colours that are surely alike don't differ, and most that don't differ are surely alike.
    #[test]
    fn slopes_bound_differences() {
        let mut state = 1_u64;
        let mut number = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        for (gamma, threshold) in [(2.5, 0.3), (2.5, 0.01), (1.0, 0.3), (0.5, 0.3), (4.0, 2.0)] {
            let r = Refinement {
                threshold,
                gamma,
                ..Refinement::DEFAULT
            };
            let slopes = Slopes::new(&r);
            let (mut alike, mut surely) = (0, 0);
            for _ in 0..20_000 {
                let scale = det::pow(2.0, 40.0 * number() - 22.0);
                let near = det::pow(2.0, -12.0 * number());
                let [a, c, d]: [f64; 3] = std::array::from_fn(|_| scale * (number() - 0.01));
                let a = Color::new(a, c, d);
                let b = a + Color::new(number(), number(), number()) * (scale * near);
                let differ = Compared::new(a, &r).differs(Compared::new(b, &r), &r);
                assert!(!(slopes.surely_alike(a, b) && differ), "{a:?} {b:?}");
                alike += u32::from(!differ);
                surely += u32::from(slopes.surely_alike(a, b));
                assert!(slopes.surely_alike(a, a));
            }
            assert!(
                gamma < 1.0 || surely > alike / 4,
                "{gamma}: {surely} of {alike}"
            );
        }
    }
}
