//! Numbers without sign.

use super::is_name_start;

/// The number at the front of `rest`, which begins with one, and how many bytes it has.
pub(super) fn number(rest: &[u8]) -> (f64, usize) {
    short_decimal(rest).unwrap_or_else(|| {
        let length = number_length(rest).max(1);
        let text = rest.get(..length).and_then(|t| std::str::from_utf8(t).ok());
        // The text has the form of a number, so parsing it cannot fail.
        (text.and_then(|t| t.parse().ok()).unwrap_or(0.0), length)
    })
}

/// How many bytes at the front of `rest` are a number: digits, a point with digits around it, an exponent.
pub(super) fn number_length(rest: &[u8]) -> usize {
    let digits = |from: usize| {
        let rest = rest.get(from..).unwrap_or(&[]);
        rest.iter().take_while(|b| b.is_ascii_digit()).count()
    };
    let mut length = digits(0);
    // `1.x` is the component of a number, not a number with an empty fraction.
    if rest.get(length) == Some(&b'.')
        && !rest
            .get(length + 1)
            .is_some_and(|b| is_name_start(*b) && !matches!(b, b'e' | b'E'))
    {
        length += 1 + digits(length + 1);
    }
    if matches!(rest.get(length), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(rest.get(length + 1), Some(b'+' | b'-')));
        let exponent = digits(length + 1 + sign);
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    length
}

/// A decimal number of at most 19 digits with a value the processor computes exactly: the mantissa and the power of ten are
/// both floats without rounding, so one division rounds correctly (Clinger, "How to read floating point numbers
/// accurately", PLDI 1990). `None` if the number is longer or has an exponent.
fn short_decimal(rest: &[u8]) -> Option<(f64, usize)> {
    const POWERS: [f64; 23] = [
        1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
        1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
    ];
    let mut mantissa = 0u64;
    let whole = digits(rest, &mut mantissa)?;
    let (mut length, mut fraction) = (whole, 0);
    if rest.get(length) == Some(&b'.') {
        fraction = digits(rest.get(length + 1..)?, &mut mantissa)?;
        length += 1 + fraction;
    }
    // A name behind it is an exponent, or a component of a number.
    let joined = rest.get(length).is_some_and(|b| is_name_start(*b));
    // So many digits have not overflown the mantissa.
    if joined || whole + fraction > 19 || mantissa > 1 << 53 {
        return None;
    }
    let power = POWERS.get(fraction)?;
    Some((mantissa as f64 / power, length))
}

/// Reads decimal digits on to a mantissa, modulo 2^64, and gives how many there are; `None` if they are too many.
#[inline]
fn digits(rest: &[u8], mantissa: &mut u64) -> Option<usize> {
    const POWERS: [u64; 9] = [
        1,
        10,
        100,
        1000,
        10_000,
        100_000,
        1_000_000,
        10_000_000,
        100_000_000,
    ];
    let mut count = 0;
    while let Some((window, _)) = rest.get(count..)?.split_first_chunk() {
        let (value, more) = leading_digits(u64::from_le_bytes(*window));
        *mantissa = mantissa
            .wrapping_mul(*POWERS.get(more)?)
            .wrapping_add(value);
        count += more;
        if more < 8 {
            return Some(count);
        }
        if count > 16 {
            return None;
        }
    }
    // Near the end of the text.
    for byte in rest.get(count..)?.iter().take_while(|b| b.is_ascii_digit()) {
        *mantissa = mantissa
            .wrapping_mul(10)
            .wrapping_add(u64::from(byte - b'0'));
        count += 1;
    }
    Some(count)
}

/// The value of the digits at the front of eight bytes, and how many they are, all bytes at once.
#[inline]
fn leading_digits(window: u64) -> (u64, usize) {
    const ZEROS: u64 = 0x3030_3030_3030_3030;
    // The upper bit of each byte that is no digit is set: those above `9` by the sum, those below `0` by the difference. What
    // is carried or borrowed changes only bytes behind the first of them.
    let above = window.wrapping_add(0x4646_4646_4646_4646);
    let below = window.wrapping_sub(ZEROS);
    let count = (((above | below) & 0x8080_8080_8080_8080).trailing_zeros() / 8) as usize;
    if count == 0 {
        return (0, 0);
    }
    // Zeros take the place of the digits that are missing in front.
    let d = below << (64 - 8 * count);
    // Pairs of digits, then all: Lemire, "Quickly parsing eight digits", 2018.
    let pairs = d.wrapping_mul(10).wrapping_add(d >> 8);
    const MASK: u64 = 0x0000_00ff_0000_00ff;
    let first = (pairs & MASK).wrapping_mul(100 + (1_000_000 << 32));
    let second = (pairs >> 16 & MASK).wrapping_mul(1 + (10_000 << 32));
    (first.wrapping_add(second) >> 32, count)
}
