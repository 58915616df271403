//! Unsigned numbers.

use super::is_name_start;
use strahl_math::decimal;

/// The number at the front of `rest` and its length in bytes.
pub(super) fn number(rest: &[u8]) -> (f64, usize) {
    let short = decimal::short(rest);
    // A name right after it is an exponent, or a component of the number.
    let short = short.filter(|(_, length)| !rest.get(*length).is_some_and(|b| is_name_start(*b)));
    short.unwrap_or_else(|| {
        let length = number_length(rest).max(1);
        let text = rest.get(..length).and_then(|t| std::str::from_utf8(t).ok());
        // The text has the form of a number, so parsing it cannot fail.
        (text.and_then(|t| t.parse().ok()).unwrap_or(0.0), length)
    })
}

/// The length in bytes of the number at the front of `rest`: digits, a point with digits around it, an exponent.
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
