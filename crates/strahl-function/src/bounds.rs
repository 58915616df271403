mod periodic;

use crate::rounding::{
    above, add_down, add_up, below, div_down, div_up, finite_sums, greater, less, lower, mul_down,
    mul_up, or, stepped, upper,
};
pub(crate) use periodic::triangle;
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

    /// Both zeros, if the lower end is a zero.
    pub(crate) fn with_both_zeros(self) -> Self {
        Self {
            min: -(0.0 - self.min),
            ..self
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

    #[inline]
    pub(crate) fn neg(self) -> Self {
        Self {
            // The opposite of either zero is -0.
            min: -(self.max + 0.0),
            max: -self.min,
            nan: self.nan,
        }
    }

    #[inline]
    pub(crate) fn abs(self) -> Self {
        if self.is_empty() {
            return self;
        }
        // At most one end is further from zero than its opposite is.
        let nearest = greater(self.min, -self.max);
        Self {
            min: greater(nearest, 0.0),
            max: greater(self.min.abs(), self.max.abs()),
            nan: self.nan,
        }
    }

    #[inline]
    pub(crate) fn add(self, other: Self) -> Self {
        // The ends of an empty interval are infinite, and so are their sums, or NaN.
        match finite_sums([self.min, self.max], [other.min, other.max]) {
            Some([min, max]) => Self {
                min,
                max,
                nan: self.nan | other.nan,
            },
            None => self.add_any(other),
        }
    }

    /// [`Bounds::add`] in all cases, such as sums that are not finite.
    #[cold]
    #[inline(never)]
    fn add_any(self, other: Self) -> Self {
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

    #[inline]
    pub(crate) fn sub(self, other: Self) -> Self {
        self.add(other.neg())
    }

    #[inline]
    pub(crate) fn mul(self, other: Self) -> Self {
        // The ends of an empty interval are infinite, and so are their products, or NaN.
        if let Some((min, max)) = outer([
            self.min * other.min,
            self.min * other.max,
            self.max * other.min,
            self.max * other.max,
        ]) {
            let nan = self.nan | other.nan;
            return Self { min, max, nan };
        }
        self.mul_any(other)
    }

    /// [`Bounds::mul`] in all cases, such as products that are zero or not finite.
    #[inline(never)]
    fn mul_any(self, other: Self) -> Self {
        if let Some((min, max)) = outer_products(self, other) {
            let nan = self.nan | other.nan;
            return Self { min, max, nan };
        }
        if self.is_empty() || other.is_empty() {
            return Self::NAN;
        }
        let nan =
            self.has_zero() && other.is_unbounded() || other.has_zero() && self.is_unbounded();
        self.corners(other, mul_down, mul_up).with_nan(nan)
    }

    #[inline]
    pub(crate) fn square(self) -> Self {
        let magnitude = self.abs();
        if magnitude.is_empty() {
            return magnitude;
        }
        let (least, most) = (magnitude.min * magnitude.min, magnitude.max * magnitude.max);
        // The neighbours of numbers that are not negative; what is zero or infinite already stays.
        let is_last = magnitude.max == 0.0 || most == f64::INFINITY;
        Self {
            min: f64::from_bits(least.to_bits().saturating_sub(1)),
            max: f64::from_bits(most.to_bits() + u64::from(!is_last)),
            nan: self.nan,
        }
    }

    #[inline]
    pub(crate) fn div(self, other: Self) -> Self {
        // The ends of an empty interval are infinite, and their quotients infinite, zero, or NaN.
        if let (true, Some((min, max))) = (
            other.min > 0.0 || other.max < 0.0,
            outer([
                self.min / other.min,
                self.min / other.max,
                self.max / other.min,
                self.max / other.max,
            ]),
        ) {
            let nan = self.nan | other.nan;
            return Self { min, max, nan };
        }
        self.div_any(other)
    }

    /// [`Bounds::div`] in all cases, such as quotients that are zero or not finite.
    #[inline(never)]
    fn div_any(self, other: Self) -> Self {
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

    /// [`corners`](Self::corners) of a library function that has a value at each of them, in this range and with this relative error.
    fn library_corners(
        self,
        other: Self,
        f: impl Fn(f64, f64) -> f64,
        error: f64,
        (least, most): (f64, f64),
    ) -> Self {
        let at = |a: f64, b: f64| {
            let value = f(a, b);
            let (low, high) = (below(value, error), above(value, error));
            (upper(low, least), lower(high, most))
        };
        let is_single = |x: Self| x.min.to_bits() == x.max.to_bits();
        let along = |b: f64| {
            let (from, to) = (at(self.min, b), at(self.max, b));
            (lower(from.0, to.0), upper(from.1, to.1))
        };
        let (mut min, mut max) = along(other.min);
        if !is_single(other) {
            let (low, high) = along(other.max);
            (min, max) = (lower(min, low), upper(max, high));
        }
        let nan = self.nan || other.nan;
        Self { min, max, nan }
    }

    #[inline]
    pub(crate) fn sqrt(self) -> Self {
        if self.min > 0.0 && !self.is_empty() && self.max < f64::INFINITY {
            return Self {
                min: stepped(self.min.sqrt(), -1),
                max: stepped(self.max.sqrt(), 1),
                nan: self.nan,
            };
        }
        self.sqrt_any()
    }

    /// [`Bounds::sqrt`] in all cases, such as of what is not positive or not finite.
    #[inline(never)]
    fn sqrt_any(self) -> Self {
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
        Self {
            min: power_end(base.min, exponent, base.min < 0.0),
            max: power_end(base.max, exponent, base.max > 0.0),
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
        let whole = exponent.min.ceil() <= exponent.max.floor();
        let negative_zero = self.min == 0.0 && self.min.is_sign_negative() && exponent.min < 0.0;
        if self.min == f64::NEG_INFINITY || whole && negative_zero {
            return Self::UNKNOWN;
        }
        // What is negative has powers with whole exponents only.
        let may_fail = self.min < 0.0;
        let mut powers = if !may_fail {
            self.powers(exponent)
        } else if whole {
            let sizes = self.abs().powers(exponent);
            Self::new(-sizes.max, sizes.max)
        } else {
            let base = self.restrict(-0.0, f64::INFINITY);
            if base.is_empty() && !nan {
                return Self::NAN;
            }
            base.powers(exponent)
        };
        if nan {
            powers = powers.hull(Self::point(1.0));
        }
        powers.with_nan(nan || may_fail)
    }

    /// Bounds of the powers of the absolute values.
    fn powers(self, exponent: Self) -> Self {
        let power = |a: f64, b: f64| det::pow(a.abs(), b);
        self.library_corners(exponent, power, POWER_ERROR, (0.0, f64::INFINITY))
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
            let angles = self.library_corners(x, det::atan2, LIBRARY_ERROR, (-pi, pi));
            return Self { nan, ..angles };
        }
        Self::new(if above_axis { 0.0 } else { -pi }, pi).with_nan(nan)
    }

    /// `if a <= b { a } else { b }`.
    #[inline]
    pub(crate) fn minimum(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return other;
        }
        if self.nan {
            return Self {
                min: lower(self.min, other.min),
                ..other
            };
        }
        Self {
            min: lower(self.min, other.min),
            max: less(other.max, self.max),
            nan: other.nan,
        }
    }

    /// `if a < b { b } else { a }`.
    #[inline]
    pub(crate) fn maximum(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return self;
        }
        Self {
            min: if other.nan {
                self.min
            } else {
                let (a, b) = (greater(self.min, other.min), greater(other.min, self.min));
                // They differ only if both are zero.
                lower(a, b)
            },
            max: upper(self.max, other.max),
            nan: self.nan,
        }
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

/// The least and the largest of rounded products or quotients, rounded outwards, if none of them is zero, infinite or NaN: the usual case, in
/// which rounding the two that count is enough.
#[inline(always)]
fn outer([a, b, c, d]: [f64; 4]) -> Option<(f64, f64)> {
    let size = [a.abs(), b.abs(), c.abs(), d.abs()];
    let sum = (size[0] + size[2]) + (size[1] + size[3]);
    let least = less(less(size[0], size[2]), less(size[1], size[3]));
    // Whatever is not finite shows in the sum.
    if !(sum < f64::INFINITY && least > 0.0) {
        return None;
    }
    Some((
        stepped(less(less(a, b), less(c, d)), -1),
        stepped(greater(greater(a, b), greater(c, d)), 1),
    ))
}

/// The least and the largest of the products of the ends, rounded outwards, if all are finite and none is zero but those with a factor that is.
#[inline(always)]
fn outer_products(a: Bounds, b: Bounds) -> Option<(f64, f64)> {
    let pairs = [
        (a.min, b.min),
        (a.min, b.max),
        (a.max, b.min),
        (a.max, b.max),
    ];
    let (mut sum, mut vanishes) = (0.0, false);
    for (x, y) in pairs {
        sum += (x * y).abs();
        vanishes |= x * y == 0.0 && x != 0.0 && y != 0.0;
    }
    if !(sum < f64::INFINITY) || vanishes {
        return None;
    }
    let [p, q, r, s] = pairs.map(|(x, y)| x * y);
    let (min, max) = (
        lower(lower(p, q), lower(r, s)),
        upper(upper(p, q), upper(r, s)),
    );
    // Products that are zero are exact.
    Some((
        stepped(min, -i64::from(min != 0.0)),
        stepped(max, i64::from(max != 0.0)),
    ))
}

/// An odd power, or one of a positive number, whose products are rounded away from zero or towards it.
fn power_end(x: f64, exponent: u8, is_away: bool) -> f64 {
    if x == 0.0 {
        return x;
    }
    let product = |a: f64, b: f64| {
        let product = a * b;
        match is_away {
            true => product.next_up(),
            // Zero stays.
            false => f64::from_bits(product.to_bits().saturating_sub(1)),
        }
    };
    let (mut result, mut square, mut bits) = (1.0, x.abs(), exponent);
    loop {
        if bits & 1 == 1 {
            result = product(result, square);
        }
        bits >>= 1;
        if bits == 0 {
            return result.copysign(x);
        }
        square = product(square, square);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cmp::Ordering;

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

    /// Intervals between numbers of all magnitudes, and those that are not numbers.
    fn intervals() -> Vec<Bounds> {
        let ends = [
            f64::NEG_INFINITY,
            f64::MIN,
            -3.5,
            -1.0,
            -1e-200,
            -f64::from_bits(1),
            -0.0,
            0.0,
            f64::from_bits(1),
            1e-200,
            0.1,
            1.0,
            2.0,
            7e9,
            f64::MAX,
            f64::INFINITY,
        ];
        let mut intervals = vec![Bounds::NAN];
        for (i, &min) in ends.iter().enumerate() {
            for &max in &ends[i..] {
                intervals.push(Bounds::new(min, max));
                intervals.push(Bounds::new(min, max).with_nan(true));
            }
        }
        intervals
    }

    fn assert_same(ours: Bounds, theirs: Bounds, of: &dyn std::fmt::Debug) {
        let bits = |b: Bounds| (b.min.to_bits(), b.max.to_bits(), b.nan);
        assert_eq!(bits(ours), bits(theirs), "{ours:?} {theirs:?} of {of:?}");
    }

    #[test]
    fn usual_cases_have_the_bits_of_the_general_ones() {
        for a in intervals() {
            for b in intervals() {
                let of = (a, b);
                assert_same(a.add(b), a.add_any(b), &of);
                assert_same(a.sub(b), a.add_any(b.neg()), &of);
                assert_same(a.mul(b), a.mul_any(b), &of);
                assert_same(a.div(b), a.div_any(b), &of);
                if a.is_empty() || b.is_empty() || a.nan || b.nan {
                    continue;
                }
                // A zero at a lower end is negative if one of two is, at an upper end positive.
                let zero = if a.min.is_sign_negative() {
                    a.min
                } else {
                    b.min
                };
                let (min, max) = match a.min.partial_cmp(&b.min) {
                    Some(Ordering::Less) => (a.min, b.min),
                    Some(Ordering::Greater) => (b.min, a.min),
                    _ => (zero, zero),
                };
                let most = if a.max > b.max { b.max } else { a.max };
                assert_same(a.minimum(b), Bounds::new(min, most), &of);
                let zero = if a.max.is_sign_positive() {
                    a.max
                } else {
                    b.max
                };
                let most = match a.max.partial_cmp(&b.max) {
                    Some(Ordering::Less) => b.max,
                    Some(Ordering::Greater) => a.max,
                    _ => zero,
                };
                assert_same(a.maximum(b), Bounds::new(max, most), &of);
            }
        }
    }

    #[test]
    fn powers_of_intervals_have_the_bits_of_products_of_points() {
        for a in intervals() {
            assert_same(a.sqrt(), a.sqrt_any(), &a);
            let size = a.abs();
            if size.is_empty() {
                continue;
            }
            let low = mul_down(size.min, size.min);
            let square = Bounds::new(low, mul_up(size.max, size.max)).with_nan(a.nan);
            assert_same(a.square(), square, &a);
            let most = upper(a.min.abs(), a.max.abs());
            let least = if a.has_zero() {
                0.0
            } else {
                lower(a.min.abs(), a.max.abs())
            };
            assert_same(size, Bounds::new(least, most).with_nan(a.nan), &a);
            for exponent in [3, 4, 7, 64] {
                let end = |x: f64| {
                    let (mut result, mut square) = (Bounds::point(1.0), Bounds::point(x));
                    let mut bits = exponent;
                    while bits > 0 {
                        if bits & 1 == 1 {
                            result = result.mul_any(square);
                        }
                        square = square.mul_any(square);
                        bits >>= 1;
                    }
                    result
                };
                let base = if exponent % 2 == 1 { a } else { size };
                let ends = Bounds::new(end(base.min).min, end(base.max).max).with_nan(a.nan);
                assert_same(a.power(exponent), ends, &(a, exponent));
            }
        }
    }

    #[test]
    fn powers_of_points_are_within_those_of_intervals() {
        let exponents = [
            -2.5, -2.0, -1.0, -0.3, 0.0, 0.4, 0.5, 1.0, 1.7, 2.0, 2.5, 3.0, 65.0, 66.5,
        ];
        let bases = [
            -f64::MAX,
            -9.0,
            -1.0,
            -0.2,
            -1e-200,
            -0.0,
            0.0,
            1e-200,
            0.7,
            1.0,
            5.0,
            f64::MAX,
        ];
        let between = |from: f64, to: f64| {
            [
                from,
                to,
                0.5 * from + 0.5 * to,
                (0.7 * from + 0.3 * to).clamp(from, to),
            ]
        };
        for (i, low) in bases.into_iter().enumerate() {
            for high in bases.into_iter().skip(i) {
                for (k, least) in exponents.into_iter().enumerate() {
                    for most in exponents.into_iter().skip(k) {
                        let (base, exponent) = (Bounds::new(low, high), Bounds::new(least, most));
                        let powers = base.pow(exponent);
                        for x in between(low, high) {
                            for y in between(least, most) {
                                let power = det::pow(x, y);
                                let is_within = if power.is_nan() {
                                    powers.nan
                                } else {
                                    powers.min <= power && power <= powers.max
                                };
                                assert!(
                                    is_within,
                                    "{x} to {y} is {power}: {base:?} {exponent:?} {powers:?}"
                                );
                            }
                        }
                    }
                }
            }
        }
        let fails =
            |low: f64, high: f64, exponent: Bounds| Bounds::new(low, high).pow(exponent).is_empty();
        assert!(fails(-2.0, -1.0, Bounds::point(2.5)) && fails(-2.0, -1.0, Bounds::new(1.2, 1.8)));
        assert!(!fails(-2.0, -1.0, Bounds::new(1.2, 2.0)) && !fails(-2.0, 0.0, Bounds::point(0.5)));
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
