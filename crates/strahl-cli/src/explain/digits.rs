//! Formatting of numbers.

use std::str::FromStr;
use strahl::math::DVec3;
use strahl::shade::Color;

/// The number of digits to print.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Digits {
    /// This many significant digits.
    Significant(usize),
    /// As many digits as are needed to read back the same bits.
    Full,
}

impl Digits {
    /// A number, with an exponent if that is shorter.
    pub(crate) fn number(self, x: f64) -> String {
        let Self::Significant(digits) = self else {
            return format!("{x:?}");
        };
        if x == 0.0 || !x.is_finite() {
            // Adding 0 removes the sign of a zero.
            return format!("{}", x + 0.0);
        }
        let scientific = format!("{x:.*e}", digits.saturating_sub(1));
        let Some((mantissa, exponent)) = scientific.split_once('e') else {
            return scientific;
        };
        let exponent: i64 = exponent.parse().unwrap_or(0);
        if exponent < -5 || exponent >= 9.max(digits as i64) {
            return format!("{}e{exponent}", trimmed(mantissa));
        }
        let decimals = (digits as i64 - 1 - exponent).max(0);
        trimmed(&format!("{x:.*}", decimals as usize)).to_owned()
    }

    /// Three numbers in parentheses.
    pub(crate) fn triple(self, [x, y, z]: [f64; 3]) -> String {
        let [x, y, z] = [x, y, z].map(|v| self.number(v));
        format!("({x}, {y}, {z})")
    }

    /// A colour.
    pub(crate) fn color(self, c: Color) -> String {
        self.triple(c.to_array())
    }

    /// A point or a direction.
    pub(crate) fn point(self, p: DVec3) -> String {
        self.triple(p.to_array())
    }

    /// A colour, as one number if its components are equal.
    pub(crate) fn gray_or_color(self, c: Color) -> String {
        if c == Color::gray(c.r) {
            self.number(c.r)
        } else {
            self.color(c)
        }
    }
}

/// Removes trailing zeros behind the point.
fn trimmed(number: &str) -> &str {
    if number.contains('.') {
        number.trim_end_matches('0').trim_end_matches('.')
    } else {
        number
    }
}

impl FromStr for Digits {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        match s.parse() {
            _ if s == "full" => Ok(Self::Full),
            Ok(digits @ 1..=17) => Ok(Self::Significant(digits)),
            _ => Err("expected a number of digits from 1 to 17, or `full`".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_as_many_digits_as_asked_for() {
        let six = Digits::Significant(6);
        for (x, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (0.1 + 0.2, "0.3"),
            (-2.0 / 3.0, "-0.666667"),
            (1234567.8, "1234568"),
            (1e9, "1e9"),
            (1.23456789e-6, "1.23457e-6"),
            (0.0001, "0.0001"),
            (999999.96, "1000000"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(six.number(x), text);
        }
        assert_eq!(Digits::Significant(2).number(0.126), "0.13");
        assert_eq!(Digits::Full.number(0.1 + 0.2), "0.30000000000000004");
        assert_eq!(Digits::Full.number(1.0), "1.0");
        assert_eq!(six.gray_or_color(Color::gray(0.5)), "0.5");
        assert_eq!(six.gray_or_color(Color::new(1.0, 0.5, 0.0)), "(1, 0.5, 0)");
    }

    #[test]
    fn the_option_takes_a_number_or_full() {
        assert_eq!("full".parse(), Ok(Digits::Full));
        assert_eq!("9".parse(), Ok(Digits::Significant(9)));
        for bad in ["0", "18", "-1", "all", ""] {
            assert!(bad.parse::<Digits>().is_err(), "{bad}");
        }
    }
}
