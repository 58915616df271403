//! Sums, products and quotients rounded down or up, and the order of numbers that tells zeros apart.

/// The smallest positive number.
const TINY: f64 = f64::from_bits(1);

/// The smaller number, `-0.0` before `+0.0`; neither argument is NaN where it matters.
pub(super) fn lower(a: f64, b: f64) -> f64 {
    if a < b || a == b && a.is_sign_negative() {
        a
    } else {
        b
    }
}

pub(super) fn upper(a: f64, b: f64) -> f64 {
    if a > b || a == b && a.is_sign_positive() {
        a
    } else {
        b
    }
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
