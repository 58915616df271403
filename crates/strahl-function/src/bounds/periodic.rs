//! Bounds of periodic operations: waves and tangents.

use super::{Bounds, LIBRARY_ERROR};
use crate::rounding::{above, below, lower, upper};
use strahl_math::det;

/// Beyond this magnitude a sine is bounded by -1 and 1 only, and beyond this many periods other waves by their range: periods can't be counted
/// reliably in f64.
const PERIODS: f64 = 1e6;

/// The parts of a period that exceed every rounding of a number of periods up to [`PERIODS`].
const MARGIN: f64 = 1e-9;

impl Bounds {
    /// Bounds of `det::sin` (`phase` 0) and `det::cos` (`phase` 0.25: a quarter turn ahead).
    #[inline]
    pub(crate) fn wave(self, f: impl Fn(f64) -> f64, phase: f64) -> Self {
        self.all_phases()
            .unwrap_or_else(|| self.wave_between(f(self.min), f(self.max), phase))
    }

    /// Bounds of `det::sin` and of `det::cos`.
    #[inline]
    pub(crate) fn waves(self) -> [Self; 2] {
        if let Some(all) = self.all_phases() {
            return [all, all];
        }
        let (from, to) = (det::sin_cos(self.min), det::sin_cos(self.max));
        [
            self.wave_between(from.0, to.0, 0.0),
            self.wave_between(from.1, to.1, 0.25),
        ]
    }

    /// Bounds of sine and cosine that need not be computed.
    #[inline(always)]
    fn all_phases(self) -> Option<Self> {
        if self.is_empty() {
            return Some(self);
        }
        let full = Self::new(-1.0, 1.0).with_nan(self.nan || self.is_unbounded());
        (!(self.min > -PERIODS && self.max < PERIODS)).then_some(full)
    }

    /// [`wave`](Self::wave) with these values at its ends.
    #[inline(always)]
    fn wave_between(self, a: f64, b: f64, phase: f64) -> Self {
        // In turns after a maximum.
        let (from, to) = (
            self.min / std::f64::consts::TAU + phase - 0.25 - MARGIN,
            self.max / std::f64::consts::TAU + phase - 0.25 + MARGIN,
        );
        Self {
            min: if (from + 0.5).floor() < (to + 0.5).floor() {
                -1.0
            } else {
                upper(below(lower(a, b), LIBRARY_ERROR), -1.0)
            },
            max: if from.floor() < to.floor() {
                1.0
            } else {
                lower(above(upper(a, b), LIBRARY_ERROR), 1.0)
            },
            nan: self.nan,
        }
    }

    pub(crate) fn tan(self) -> Self {
        if self.is_empty() {
            return self;
        }
        let (from, to) = (
            self.min / std::f64::consts::PI + 0.5 - MARGIN,
            self.max / std::f64::consts::PI + 0.5 + MARGIN,
        );
        let counted = self.min > -PERIODS && self.max < PERIODS;
        if counted && from.floor() == to.floor() {
            self.map_rising(det::tan, (f64::NEG_INFINITY, f64::INFINITY))
        } else {
            Self::ENTIRE.with_nan(self.nan || self.is_unbounded())
        }
    }

    /// The distance from the nearest multiple of a period, as [`BinaryOp::Triangle`](crate::BinaryOp::Triangle) computes it.
    pub(crate) fn triangle(self, period: Self) -> Self {
        if self.is_empty() || period.is_empty() {
            return Self::NAN;
        }
        let nan = self.nan
            || period.nan
            || self.is_unbounded()
            || period.has_zero()
            || period.is_unbounded();
        let Some(halves) = self.half_periods(period).filter(|_| !nan) else {
            return Self::new(0.0, f64::INFINITY).with_nan(nan);
        };
        let size = period.max.abs();
        // More than the rounding of the product and the difference, and of the number of periods where that decides what is nearest.
        let error = 8.0 * f64::EPSILON * (self.abs().max + size);
        let [from, to] = [self.min, self.max].map(|x| triangle(x, size));
        let meets = |parity: f64| {
            // Whether there is a whole number of half periods of this parity.
            let [low, high] = halves.map(|h| (h - parity) * 0.5);
            low.ceil() <= high.floor()
        };
        Self {
            min: if meets(0.0) {
                0.0
            } else {
                upper(lower(from, to) - error, 0.0)
            },
            max: if meets(1.0) {
                0.5 * size + error
            } else {
                upper(from, to) + error
            },
            nan,
        }
    }

    /// Bounds of the derivative of [`triangle`](Self::triangle), whose corners have all in between; `None` if the period is not one number.
    pub(crate) fn triangle_slope(self, period: Self) -> Option<Self> {
        let [from, to] = self.half_periods(period)?.map(f64::floor);
        Some(if from != to {
            Self::new(-1.0, 1.0)
        } else if from * 0.5 == (from * 0.5).floor() {
            Self::new(1.0, 1.0)
        } else {
            Self::new(-1.0, -1.0)
        })
    }

    /// Both ends in half periods, and a little beyond; `None` if they can't be counted or the period is not one number.
    fn half_periods(self, period: Self) -> Option<[f64; 2]> {
        let half = 0.5 * period.single()?.abs();
        let (from, to) = (self.min / half - MARGIN, self.max / half + MARGIN);
        (from > -PERIODS && to < PERIODS).then_some([from, to])
    }
}

/// The distance of a number from the nearest multiple of a period.
pub(crate) fn triangle(x: f64, period: f64) -> f64 {
    (x - period * (x / period + 0.5).floor()).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_of_triangles_are_tight_and_enclose_all_values() {
        for period in [0.2, 1.0, -3.0, 1e-3] {
            for step in 0..400 {
                let size = f64::abs(period);
                let from = (f64::from(step) * 0.0173 - 3.1) * size;
                let to = from + f64::from(step % 23) * 0.037 * size;
                let bounds = Bounds::new(from, to).triangle(Bounds::point(period));
                let slope = Bounds::new(from, to).triangle_slope(Bounds::point(period));
                let values: Vec<f64> = (0..=200)
                    .map(|i| triangle(from + (to - from) * f64::from(i) / 200.0, period))
                    .collect();
                let least = values.iter().copied().fold(f64::INFINITY, f64::min);
                let most = values.iter().copied().fold(0.0, f64::max);
                assert!(bounds.min <= least && bounds.max >= most, "{bounds:?}");
                // Corners lie between the values that are compared.
                let gap = (to - from) / 200.0 + 1e-12;
                assert!(
                    bounds.min >= least - gap && bounds.max <= most + gap,
                    "{bounds:?}"
                );
                let slope = slope.expect("the period is known");
                for pair in values.windows(2) {
                    let rise = (pair[1] - pair[0]) / ((to - from) / 200.0);
                    let is_known = to == from || slope.contains(rise.round());
                    assert!(is_known, "{from} {to}: {rise} {slope:?}");
                }
            }
        }
    }

    #[test]
    fn triangles_of_what_cannot_be_counted_are_not_negative() {
        let (one, all) = (Bounds::point(1.0), Bounds::ENTIRE);
        for (a, period, nan) in [
            (all, one, true),
            (Bounds::new(0.0, 1e9), one, false),
            (one, Bounds::new(-1.0, 1.0), true),
            (one, Bounds::new(1.0, 2.0), false),
            (one, Bounds::point(0.0), true),
            (one, Bounds::point(f64::INFINITY), true),
        ] {
            let bounds = a.triangle(period);
            assert_eq!((bounds.min, bounds.nan), (0.0, nan), "{a:?} {period:?}");
        }
        assert!(Bounds::NAN.triangle(one).is_empty());
        assert_eq!(one.triangle_slope(Bounds::new(1.0, 2.0)), None);
    }
}
