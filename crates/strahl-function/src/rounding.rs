//! Sums, products and quotients rounded down or up, and the order of numbers that tells zeros apart.

/// The smallest positive number.
const TINY: f64 = f64::from_bits(1);

/// The smaller number; the second one of equal ones.
#[inline(always)]
pub(super) fn less(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger number; the second one of equal ones.
#[inline(always)]
pub(super) fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The smaller number, `-0.0` before `+0.0`; neither argument is NaN where it matters.
#[inline(always)]
pub(super) fn lower(a: f64, b: f64) -> f64 {
    // These are the same bits, but for zeros, of which either is negative if one is.
    f64::from_bits(less(a, b).to_bits() | less(b, a).to_bits())
}

/// The larger number, `+0.0` after `-0.0`.
#[inline(always)]
pub(super) fn upper(a: f64, b: f64) -> f64 {
    f64::from_bits(greater(a, b).to_bits() & greater(b, a).to_bits())
}

/// `x`, or `otherwise` if it is NaN.
pub(super) fn or(x: f64, otherwise: f64) -> f64 {
    if x.is_nan() { otherwise } else { x }
}

pub(super) fn below(x: f64, error: f64) -> f64 {
    or(x - x.abs() * error, x).next_down()
}

pub(super) fn above(x: f64, error: f64) -> f64 {
    or(x + x.abs() * error, x).next_up()
}

/// The rounding error of `sum = a + b`, exactly (Knuth's TwoSum); NaN at infinities.
#[inline(always)]
pub(super) fn sum_error(a: f64, b: f64, sum: f64) -> f64 {
    let part = sum - a;
    (a - (sum - part)) + (b - part)
}

pub(super) fn add_down(a: f64, b: f64) -> f64 {
    let sum = a + b;
    if sum_error(a, b, sum) >= 0.0 {
        sum
    } else {
        sum.next_down()
    }
}

pub(super) fn add_up(a: f64, b: f64) -> f64 {
    let sum = a + b;
    if sum_error(a, b, sum) <= 0.0 {
        sum
    } else {
        sum.next_up()
    }
}

/// [`f64::next_up`] of a number that is neither infinite nor zero, without its cases; [`f64::next_down`] with a count of -1, and the
/// number itself with 0.
#[inline(always)]
pub(super) fn stepped(x: f64, count: i64) -> f64 {
    // The bits of negative numbers count downwards.
    let sign = (x.to_bits() as i64 >> 63) | 1;
    f64::from_bits(x.to_bits().wrapping_add((sign * count) as u64))
}

/// [`add_down`] of the first numbers of two pairs and [`add_up`] of the second ones, unless a sum is not finite.
#[inline(always)]
pub(super) fn finite_sums(a: [f64; 2], b: [f64; 2]) -> Option<[f64; 2]> {
    let sum = [a[0] + b[0], a[1] + b[1]];
    let error = [sum_error(a[0], b[0], sum[0]), sum_error(a[1], b[1], sum[1])];
    if error[0].is_nan() || error[1].is_nan() {
        return None;
    }
    // A sum that is zero is exact.
    Some([
        stepped(sum[0], -i64::from(error[0] < 0.0)),
        stepped(sum[1], i64::from(error[1] > 0.0)),
    ])
}

/// One step down from a rounded product or quotient; a zero that is exact, or positive before it underflowed, stays.
pub(super) fn step_down(value: f64, exact: bool) -> f64 {
    if value != 0.0 {
        value.next_down()
    } else if exact || value.is_sign_positive() {
        value
    } else {
        -TINY
    }
}

pub(super) fn step_up(value: f64, exact: bool) -> f64 {
    if value != 0.0 {
        value.next_up()
    } else if exact || value.is_sign_negative() {
        value
    } else {
        TINY
    }
}

pub(super) fn mul_down(a: f64, b: f64) -> f64 {
    step_down(a * b, a == 0.0 || b == 0.0)
}

pub(super) fn mul_up(a: f64, b: f64) -> f64 {
    step_up(a * b, a == 0.0 || b == 0.0)
}

pub(super) fn div_down(a: f64, b: f64) -> f64 {
    step_down(a / b, a == 0.0 || b.is_infinite())
}

pub(super) fn div_up(a: f64, b: f64) -> f64 {
    step_up(a / b, a == 0.0 || b.is_infinite())
}
