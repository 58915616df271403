//! Fast parsing of decimal numbers, eight digits at a time.

/// The value of the digits at the front of `rest`, perhaps with a point within or behind them or in front, and how many bytes they
/// are: the nearest float. `None` if there is no digit, or if the number is longer than the processor computes exactly.
///
/// Mantissa and power of ten are both floats without rounding, so one division rounds correctly (Clinger, "How to read
/// floating point numbers accurately", PLDI 1990).
#[inline]
pub fn short(rest: &[u8]) -> Option<(f64, usize)> {
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
    // Up to 19 digits don't overflow the mantissa.
    if !(1..=19).contains(&(whole + fraction)) || mantissa > 1 << 53 {
        return None;
    }
    let power = POWERS.get(fraction)?;
    Some((mantissa as f64 / power, length))
}

/// Reads decimal digits on to a number, modulo 2^64, and gives how many there are; `None` if they are more than some twenty.
#[inline]
pub fn digits(rest: &[u8], mantissa: &mut u64) -> Option<usize> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_numbers_are_the_nearest_floats() {
        let mut state = 1u64;
        for round in 0..50_000 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let digits = (state >> 60) as usize;
            let text = format!("{:.*}", digits, (state >> 11) as f64 / 1e12);
            let text = if round % 2 == 0 {
                text
            } else {
                text + " 12345678"
            };
            let number = text.split(' ').next().unwrap();
            if let Some((value, length)) = short(text.as_bytes()) {
                assert_eq!((value, length), (number.parse().unwrap(), number.len()));
            } else {
                assert!(number.len() > 16, "{number}");
            }
        }
    }

    #[test]
    fn what_is_no_short_number() {
        for text in [
            "",
            ".",
            "-1",
            "x",
            "12345678901234567890",
            "9007199254740993",
        ] {
            assert_eq!(short(text.as_bytes()), None, "{text}");
        }
        assert_eq!(short(b".5e3"), Some((0.5, 2)));
        assert_eq!(short(b"7."), Some((7.0, 2)));
        let mut number = 0;
        assert_eq!(digits(b"123456789/4", &mut number), Some(9));
        assert_eq!(number, 123_456_789);
    }
}
