use crate::rounding::{
    above, add_down, add_up, below, div_down, div_up, lower, mul_down, mul_up, or, upper,
};
use strahl_math::det;

/// An interval that certainly contains every value an expression takes, and whether NaN may be among them.
///
/// `min..=max` encloses all values that are numbers (infinities included); `nan` says that some argument may give NaN.
/// `min > max` with `nan` is the interval of an expression that is never a number. All operations round outward, so an
/// enclosure holds for the real number *and* for what the same expression gives when evaluated in f64.
///
/// The sign of a zero at the lower end counts: `+0.0` promises that `-0.0` does not occur, `-0.0` promises nothing. (At the
/// upper end it says nothing.) With it `1 / (x*x + y*y)` is bounded from below on a box around the origin, where f64 division gives `+inf`, never `-inf`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The lower end.
    pub min: f64,
    /// The upper end.
    pub max: f64,
    /// Whether NaN may occur.
    pub nan: bool,
}

/// The software functions of `strahl_math::det` are good to about one unit in the last place (musl's documentation);
/// four are allowed for.
const LIBRARY_ERROR: f64 = 4.0 * f64::EPSILON;
/// `det::pow` multiplies up to six squares and six factors for whole exponents; 64 roundings bound them all.
const POWER_ERROR: f64 = 64.0 * f64::EPSILON;
/// Beyond this magnitude a sine is bounded by -1 and 1 only: its period can't be counted reliably in f64.
const PERIODS: f64 = 1e6;

impl Bounds {
    /// Every number.
    pub const ENTIRE: Self = Self::new(f64::NEG_INFINITY, f64::INFINITY);
    /// Every number and NaN: nothing is known.
    pub const UNKNOWN: Self = Self {
        nan: true,
        ..Self::ENTIRE
    };
    /// NaN only.
    pub const NAN: Self = Self {
        min: f64::INFINITY,
        max: f64::NEG_INFINITY,
        nan: true,
    };
    /// 0 or 1: what a comparison gives when it can't be decided.
    pub const BOOLEAN: Self = Self::new(0.0, 1.0);

    /// The numbers from `min` to `max`, without NaN.
    pub const fn new(min: f64, max: f64) -> Self {
        Self {
            min,
            max,
            nan: false,
        }
    }

    /// A single value, which may be NaN.
    pub fn point(value: f64) -> Self {
        if value.is_nan() {
            Self::NAN
        } else {
            Self::new(value, value)
        }
    }

    /// An argument's range as a caller states it: a lower end of zero admits both zeros, swapped ends or NaN admit all.
    pub fn argument(min: f64, max: f64) -> Self {
        if min <= max {
            Self::new(if min == 0.0 { -0.0 } else { min }, max)
        } else {
            Self::UNKNOWN
        }
    }

    /// Whether `value` is among the values.
    pub fn contains(&self, value: f64) -> bool {
        if value.is_nan() {
            self.nan
        } else {
            self.min <= value && value <= self.max
        }
    }

    /// Whether there is no number among the values.
    pub fn is_empty(&self) -> bool {
        !(self.min <= self.max)
    }

    /// The one number that the interval holds, if it does and NaN is excluded.
    pub fn single(&self) -> Option<f64> {
        (self.min == self.max && !self.nan).then_some(self.max)
    }

    /// The smallest interval around both.
    pub fn hull(self, other: Self) -> Self {
        Self {
            min: lower(self.min, other.min),
            max: upper(self.max, other.max),
            nan: self.nan || other.nan,
        }
    }

    pub(crate) fn with_nan(self, nan: bool) -> Self {
        Self {
            nan: self.nan || nan,
            ..self
        }
    }

    fn is_point(&self) -> bool {
        self.min == self.max
    }

    fn has_zero(&self) -> bool {
        self.min <= 0.0 && self.max >= 0.0
    }

    fn is_unbounded(&self) -> bool {
        self.min == f64::NEG_INFINITY || self.max == f64::INFINITY
    }

    /// The image under a function that never decreases and is exact.
    pub(crate) fn map_exact(self, f: impl Fn(f64) -> f64) -> Self {
        if self.is_empty() {
            return self;
        }
        Self {
            min: f(self.min),
            max: f(self.max),
            nan: self.nan,
        }
    }

    /// The image under a library function that never decreases, within its range.
    pub(crate) fn map_rising(self, f: impl Fn(f64) -> f64, range: (f64, f64)) -> Self {
        if self.is_empty() {
            return self;
        }
        Self {
            min: upper(below(f(self.min), LIBRARY_ERROR), range.0),
            max: lower(above(f(self.max), LIBRARY_ERROR), range.1),
            nan: self.nan,
        }
    }

    /// The part within a function's domain; the rest gives NaN.
    pub(crate) fn restrict(self, low: f64, high: f64) -> Self {
        if self.is_empty() || self.max < low || self.min > high {
            return Self::NAN;
        }
        Self {
            min: if self.min < low { low } else { self.min },
            max: if self.max > high { high } else { self.max },
            nan: self.nan || self.min < low || self.max > high,
        }
    }

    pub(crate) fn neg(self) -> Self {
        Self {
            min: if self.max == 0.0 { -0.0 } else { -self.max },
            max: -self.min,
            nan: self.nan,
        }
    }

    pub(crate) fn abs(self) -> Self {
        if self.is_empty() {
            return self;
        }
        let (a, b) = (self.min.abs(), self.max.abs());
        Self {
            min: if self.has_zero() { 0.0 } else { lower(a, b) },
            max: upper(a, b),
            nan: self.nan,
        }
    }

    #[inline]
    pub(crate) fn add(self, other: Self) -> Self {
        // The usual case. The ends of an empty interval are infinite, and so are their sums, or NaN.
        let sums = (self.min + other.min, self.max + other.max);
        if sums.0.abs() < f64::INFINITY && sums.1.abs() < f64::INFINITY {
            return Self {
                min: add_down(self.min, other.min),
                max: add_up(self.max, other.max),
                nan: self.nan || other.nan,
            };
        }
        self.add_infinite(other)
    }

    /// [`Bounds::add`] where a sum is not finite.
    #[cold]
    fn add_infinite(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self::NAN;
        }
        let opposite = |p: f64, q: f64| p.is_infinite() && q == -p;
        Self {
            min: or(add_down(self.min, other.min), f64::NEG_INFINITY),
            max: or(add_up(self.max, other.max), f64::INFINITY),
            nan: self.nan
                || other.nan
                || opposite(self.min, other.max)
                || opposite(self.max, other.min),
        }
    }

    pub(crate) fn sub(self, other: Self) -> Self {
        self.add(other.neg())
    }

    pub(crate) fn mul(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self::NAN;
        }
        if let Some((min, max)) = self.plain_products(other) {
            let nan = self.nan || other.nan;
            return Self { min, max, nan };
        }
        let nan =
            self.has_zero() && other.is_unbounded() || other.has_zero() && self.is_unbounded();
        self.corners(other, mul_down, mul_up).with_nan(nan)
    }

    /// The least and the largest product of ends, rounded outwards, if none of them is zero, infinite or NaN: the usual case, in which
    /// rounding the two that count is enough.
    #[inline]
    fn plain_products(self, other: Self) -> Option<(f64, f64)> {
        let (a, b) = (self.min * other.min, self.min * other.max);
        let (c, d) = (self.max * other.min, self.max * other.max);
        let plain = |x: f64| x.abs() > 0.0 && x.abs() < f64::INFINITY;
        if !(plain(a) && plain(b) && plain(c) && plain(d)) {
            return None;
        }
        let least = |x: f64, y: f64| if x < y { x } else { y };
        let most = |x: f64, y: f64| if x > y { x } else { y };
        Some((
            least(least(a, b), least(c, d)).next_down(),
            most(most(a, b), most(c, d)).next_up(),
        ))
    }

    pub(crate) fn square(self) -> Self {
        let magnitude = self.abs();
        if magnitude.is_empty() {
            return magnitude;
        }
        Self {
            min: mul_down(magnitude.min, magnitude.min),
            max: mul_up(magnitude.max, magnitude.max),
            nan: self.nan,
        }
    }

    pub(crate) fn div(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self::NAN;
        }
        let nan = self.nan
            || other.nan
            || self.has_zero() && other.has_zero()
            || self.is_unbounded() && other.is_unbounded();
        if !other.has_zero() {
            return self.corners(other, div_down, div_up).with_nan(nan);
        }
        // Dividing by +0 keeps the sign of the dividend; a divisor that may be -0 or negative says nothing.
        let positive = other.min == 0.0 && other.min.is_sign_positive();
        let quotient = if positive && self.min >= 0.0 {
            Self::new(or(div_down(self.min, other.max), 0.0), f64::INFINITY)
        } else if positive && self.max < 0.0 {
            Self::new(f64::NEG_INFINITY, div_up(self.max, other.max))
        } else {
            Self::ENTIRE
        };
        quotient.with_nan(nan)
    }

    /// Bounds of a function that is monotone in each argument by itself: its values at the corners.
    ///
    /// A corner without a value (0 times infinity) lies between its neighbours.
    fn corners(
        self,
        other: Self,
        down: impl Fn(f64, f64) -> f64,
        up: impl Fn(f64, f64) -> f64,
    ) -> Self {
        let mut result = Self::NAN.with_nan(false);
        result.nan = self.nan || other.nan;
        for a in [self.min, self.max] {
            for b in [other.min, other.max] {
                let (low, high) = (down(a, b), up(a, b));
                // 0 * inf and inf / inf: products near that corner reach down to zero.
                result.min = lower(result.min, or(low, -0.0));
                result.max = upper(result.max, or(high, 0.0));
            }
        }
        result
    }

    pub(crate) fn sqrt(self) -> Self {
        let inside = self.restrict(-0.0, f64::INFINITY);
        if inside.is_empty() {
            return inside;
        }
        let (low, high) = (inside.min.sqrt(), inside.max.sqrt());
        Self {
            min: if low == 0.0 { low } else { low.next_down() },
            max: if high == 0.0 { high } else { high.next_up() },
            nan: inside.nan,
        }
    }

    /// `self` to a whole power, multiplied in the order of `det::pow`.
    pub(crate) fn power(self, exponent: u8) -> Self {
        let odd = exponent % 2 == 1;
        let base = if odd { self } else { self.abs() };
        if base.is_empty() {
            return base;
        }
        let end = |x: f64| {
            let mut result = Self::point(1.0);
            let mut square = Self::point(x);
            let mut bits = exponent;
            while bits > 0 {
                if bits & 1 == 1 {
                    result = result.mul(square);
                }
                square = square.square();
                bits >>= 1;
            }
            result
        };
        Self {
            min: end(base.min).min,
            max: end(base.max).max,
            nan: self.nan,
        }
    }

    pub(crate) fn pow(self, exponent: Self) -> Self {
        if let Some(whole) = exponent.single()
            && (0.0..=64.0).contains(&whole)
            && whole == whole.trunc()
        {
            // The cast is exact: a whole number from 0 to 64. NaN to the power of zero is one.
            return if whole == 0.0 {
                Self::point(1.0)
            } else {
                self.power(whole as u8)
            };
        }
        // 1 to any power and any base to the power 0 are 1, even for NaN.
        let nan = self.nan || exponent.nan;
        if self.is_empty() || exponent.is_empty() {
            return Self::point(1.0).with_nan(true);
        }
        let negative_zero = self.min == 0.0 && self.min.is_sign_negative() && exponent.min < 0.0;
        if self.min < 0.0 || negative_zero {
            return Self::UNKNOWN;
        }
        let down = |a: f64, b: f64| upper(below(det::pow(a.abs(), b), POWER_ERROR), 0.0);
        let up = |a: f64, b: f64| above(det::pow(a.abs(), b), POWER_ERROR);
        let powers = self.corners(exponent, down, up);
        if nan {
            powers.hull(Self::point(1.0)).with_nan(true)
        } else {
            powers
        }
    }

    /// The remainder of truncated division, with the sign of the dividend.
    pub(crate) fn remainder(self, divisor: Self) -> Self {
        if self.is_empty() || divisor.is_empty() {
            return Self::NAN;
        }
        let nan = self.nan || divisor.nan || divisor.has_zero() || self.is_unbounded();
        let same_sign = self.min >= 0.0 || self.max <= 0.0;
        if let Some(d) = divisor.single() {
            let (low, high) = (self.min % d, self.max % d);
            let short = add_up(self.max, -self.min) < d.abs();
            if short && same_sign && low <= high {
                return Self::new(if low == 0.0 { -0.0 } else { low }, high).with_nan(nan);
            }
        }
        let magnitude = lower(divisor.abs().max, self.abs().max);
        Self {
            min: if self.min < 0.0 { -magnitude } else { -0.0 },
            max: if self.max > 0.0 { magnitude } else { 0.0 },
            nan,
        }
    }

    /// Bounds of `det::sin` (`phase` 0) and `det::cos` (`phase` 0.25: a quarter turn ahead).
    pub(crate) fn wave(self, f: impl Fn(f64) -> f64, phase: f64) -> Self {
        if self.is_empty() {
            return self;
        }
        let full = Self::new(-1.0, 1.0).with_nan(self.nan || self.is_unbounded());
        if !(self.min > -PERIODS && self.max < PERIODS) {
            return full;
        }
        // In turns after a maximum; the margin exceeds every rounding up to PERIODS.
        let (from, to) = (
            self.min / std::f64::consts::TAU + phase - 0.25 - 1e-9,
            self.max / std::f64::consts::TAU + phase - 0.25 + 1e-9,
        );
        let (a, b) = (f(self.min), f(self.max));
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
            self.min / std::f64::consts::PI + 0.5 - 1e-9,
            self.max / std::f64::consts::PI + 0.5 + 1e-9,
        );
        let counted = self.min > -PERIODS && self.max < PERIODS;
        if counted && from.floor() == to.floor() {
            self.map_rising(det::tan, (f64::NEG_INFINITY, f64::INFINITY))
        } else {
            Self::ENTIRE.with_nan(self.nan || self.is_unbounded())
        }
    }

    /// The angle of `(x, self)`.
    pub(crate) fn atan2(self, x: Self) -> Self {
        use std::f64::consts::PI;
        if self.is_empty() || x.is_empty() {
            return Self::NAN;
        }
        let nan = self.nan || x.nan;
        let above_axis = self.min >= 0.0 && self.min.is_sign_positive();
        // Away from the origin and the cut along the negative x axis the corners of the box bound its angles.
        let clear = self.min > 0.0 || self.max < 0.0 || x.min > 0.0 || above_axis && x.max < 0.0;
        let pi = PI.next_up();
        if clear {
            let down = |a, b| upper(below(det::atan2(a, b), LIBRARY_ERROR), -pi);
            let up = |a, b| lower(above(det::atan2(a, b), LIBRARY_ERROR), pi);
            let angles = self.corners(x, down, up);
            return Self { nan, ..angles };
        }
        Self::new(if above_axis { 0.0 } else { -pi }, pi).with_nan(nan)
    }

    /// `if a <= b { a } else { b }`.
    pub(crate) fn minimum(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return other;
        }
        Self {
            min: lower(self.min, other.min),
            max: if self.nan || self.max > other.max {
                other.max
            } else {
                self.max
            },
            nan: other.nan,
        }
        .hull_if(self.nan, other)
    }

    /// `if a < b { b } else { a }`.
    pub(crate) fn maximum(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return self;
        }
        Self {
            min: if other.nan || self.min > other.min {
                self.min
            } else if self.min < other.min {
                other.min
            } else {
                lower(self.min, other.min)
            },
            max: upper(self.max, other.max),
            nan: self.nan,
        }
    }

    fn hull_if(self, condition: bool, other: Self) -> Self {
        if condition { self.hull(other) } else { self }
    }

    pub(crate) fn less(self, other: Self, or_equal: bool) -> Self {
        let surely = |a: f64, b: f64| if or_equal { a <= b } else { a < b };
        let nan = self.nan || other.nan;
        if self.is_empty() || other.is_empty() || !surely(self.min, other.max) {
            Self::point(0.0)
        } else if surely(self.max, other.min) && !nan {
            Self::point(1.0)
        } else {
            Self::BOOLEAN
        }
    }

    pub(crate) fn equal(self, other: Self) -> Self {
        let apart = !(self.min <= other.max && other.min <= self.max);
        if self.is_empty() || other.is_empty() || apart {
            Self::point(0.0)
        } else if self.is_point() && other.is_point() && !self.nan && !other.nan {
            Self::point(1.0)
        } else {
            Self::BOOLEAN
        }
    }

    /// Whether the value counts as true (anything but zero): `Some` where that is certain.
    pub(crate) fn truth(self) -> Option<bool> {
        if self.is_empty() || !self.has_zero() {
            Some(true)
        } else if self.is_point() && !self.nan {
            Some(false)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_sums_are_not_widened() {
        let sum = Bounds::new(1.0, 2.0).add(Bounds::new(0.5, 0.25 + 1.0));
        assert_eq!((sum.min, sum.max), (1.5, 3.25));
        let inexact = Bounds::point(0.1).add(Bounds::point(0.2));
        assert!(inexact.min < inexact.max && inexact.contains(0.1 + 0.2));
    }

    #[test]
    fn a_sum_of_squares_is_not_negative_so_its_inverse_is_bounded_below() {
        let x = Bounds::argument(-1.0, 1.0);
        let r2 = x.square().add(x.square());
        assert_eq!(r2.min.to_bits(), 0.0f64.to_bits());
        let inverse = Bounds::point(1.0).div(r2);
        assert!(inverse.min > 0.49 && inverse.max == f64::INFINITY && !inverse.nan);
        assert_eq!(
            Bounds::point(1.0).div(Bounds::argument(0.0, 1.0)).min,
            f64::NEG_INFINITY
        );
    }

    #[test]
    fn plain_products_are_those_of_all_corners() {
        let ends = [
            -1e300,
            -3.5,
            -1.0,
            -1e-200,
            -0.0,
            0.0,
            1e-200,
            0.1,
            2.0,
            7e9,
            1e300,
            f64::INFINITY,
        ];
        let mut intervals = vec![];
        for (i, &min) in ends.iter().enumerate() {
            for &max in &ends[i..] {
                intervals.push(Bounds::new(min, max));
                intervals.push(Bounds::new(min, max).with_nan(true));
            }
        }
        let mut plain = 0;
        for &a in &intervals {
            for &b in &intervals {
                if let Some((min, max)) = a.plain_products(b) {
                    let all = a.corners(b, mul_down, mul_up);
                    let same =
                        min.to_bits() == all.min.to_bits() && max.to_bits() == all.max.to_bits();
                    assert!(same, "{a:?} {b:?} {all:?}");
                    plain += 1;
                }
            }
        }
        assert!(plain > 4_000, "{plain}");
    }

    #[test]
    fn domain_errors_show_as_nan() {
        assert!(Bounds::new(-1.0, 4.0).sqrt().nan);
        assert!(!Bounds::new(0.0, 4.0).sqrt().nan);
        assert!(Bounds::new(-2.0, -1.0).sqrt().is_empty());
        assert!(Bounds::new(0.0, 1.0).mul(Bounds::ENTIRE).nan);
    }

    #[test]
    fn the_minimum_of_nan_and_a_number_is_the_number() {
        let may_fail = Bounds::new(0.0, 1.0).with_nan(true);
        let other = Bounds::new(5.0, 6.0);
        assert_eq!(may_fail.minimum(other).max, 6.0);
        assert!(!may_fail.minimum(other).nan);
        assert!(other.minimum(may_fail).nan);
    }
}
