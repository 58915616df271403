//! Numbers and counts in words.

use strahl::math::DVec3;

/// A count with its noun, such as `1 step` and `2 steps`.
pub(crate) fn counted(count: u64, noun: &str) -> String {
    let s = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{s}")
}

/// A number with six decimals, and no sign if all digits are zeros.
pub(crate) fn fixed(x: f64) -> String {
    let text = format!("{x:.6}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|c| matches!(c, b'0' | b'.')) => digits.to_owned(),
        _ => text,
    }
}

/// A point or direction.
pub(crate) fn triple(p: DVec3) -> String {
    format!("({}, {}, {})", fixed(p.x), fixed(p.y), fixed(p.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_have_no_sign() {
        let text = triple(DVec3::new(-0.0, -1e-9, -1.5));
        assert_eq!(text, "(0.000000, 0.000000, -1.500000)");
        assert_eq!(fixed(f64::NEG_INFINITY), "-inf");
    }

    #[test]
    fn one_is_singular() {
        assert_eq!(
            [0, 1, 2].map(|n| counted(n, "test")),
            ["0 tests", "1 test", "2 tests"]
        );
    }
}
