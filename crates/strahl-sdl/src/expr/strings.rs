use crate::keywords::{Word, WordKind};
use crate::parser::{PResult, Parser, Place};
use crate::source::HostError;
use crate::token::Kind;
use crate::value::Value;
use std::sync::Arc;

impl Parser<'_> {
    /// A string: a literal, the name of one, or a string function.
    ///
    /// # Errors
    /// If there is none.
    pub fn string(&mut self) -> PResult<Arc<str>> {
        let token = self.peek()?;
        match token.kind {
            Kind::String => {
                self.take(token)?;
                Ok(self.string_of(token))
            }
            Kind::Word if token.word().map(Word::kind) == Some(WordKind::StringFunction) => {
                self.take(token)?;
                let place = self.place();
                let word = token.word().unwrap_or(Word::Concat);
                self.nested(|p| p.string_function(word, place))
            }
            Kind::Name => match self.variable(token)? {
                Value::String(text) => Ok(text),
                other => {
                    let place = self.place();
                    Err(self.fail_hint(
                        place,
                        format!("expected a string, found {}", other.describe()),
                        "numbers become strings by `str(value, length, digits)`",
                    ))
                }
            },
            _ => Err(self.unexpected(token, "a string")),
        }
    }

    fn string_function(&mut self, word: Word, place: Place) -> PResult<Arc<str>> {
        if word == Word::InputFileName {
            return Ok(self.scene_name().into());
        }
        self.expect(Kind::LeftParen)?;
        let text = match word {
            Word::Chr => {
                let code = self.full_float()?;
                let c = char::from_u32(code as u32).filter(|_| code >= 0.0);
                match c {
                    Some(c) => c.to_string(),
                    None => return Err(self.fail(place, format!("there is no character {code}"))),
                }
            }
            Word::Concat => {
                let mut text = self.string()?.to_string();
                while self.accept(Kind::Comma)? {
                    text.push_str(&self.string()?);
                    self.check_length(text.len(), place)?;
                }
                text
            }
            Word::Str => {
                let value = self.full_float()?;
                self.comma()?;
                let length = self.full_float()?;
                self.comma()?;
                let digits = self.full_float()?;
                self.formatted(value, length, digits, place)?
            }
            Word::Vstr => self.vstr(place)?,
            Word::Strlwr => self.string()?.to_lowercase(),
            Word::Strupr => self.string()?.to_uppercase(),
            Word::Substr => {
                let text = self.string()?;
                self.comma()?;
                let first = self.full_float()?;
                self.comma()?;
                let count = self.full_float()?;
                let total = text.chars().count() as f64;
                if !(first >= 1.0 && count >= 0.0 && first + count - 1.0 <= total) {
                    let message = format!(
                        "`substr` asks for {count} characters from position {first} of a string with {total}"
                    );
                    return Err(self.fail(place, message));
                }
                text.chars()
                    .skip(first as usize - 1)
                    .take(count as usize)
                    .collect()
            }
            Word::Datetime => self.datetime(place)?,
            _ => {
                let text = word.text();
                return Err(self.fail(
                    place,
                    format!("the function `{text}` is not supported here"),
                ));
            }
        };
        self.check_length(text.len(), place)?;
        self.expect(Kind::RightParen)?;
        Ok(text.into())
    }

    fn check_length(&mut self, bytes: usize, place: Place) -> PResult<()> {
        let limit = self.options.limits.string_bytes;
        if bytes > limit {
            return Err(self.fail_fatally(
                place,
                format!("a string may have {limit} bytes; this one would be longer"),
                "check for a loop that doubles it, or raise the limit: `--limit string_bytes=N`",
            ));
        }
        self.all_strings = self.all_strings.saturating_add(bytes as u64);
        let limit = self.options.limits.all_strings;
        if self.all_strings > limit {
            return Err(self.fail_fatally(
                place,
                format!("all strings of the scene together have more than {limit} bytes"),
                "check for a loop that does not end, or raise the limit: `--limit all_strings=N`",
            ));
        }
        Ok(())
    }

    /// Formats like C's `printf`: at least `length` characters, padded with zeros if it is negative; six digits if `digits` is
    /// negative.
    fn formatted(&mut self, value: f64, length: f64, digits: f64, place: Place) -> PResult<String> {
        /// No float has more digits.
        const MOST: f64 = 1100.0;
        if !(length.abs() <= MOST && digits <= MOST) {
            return Err(self.fail(
                place,
                format!("a number is written with at most {MOST} characters"),
            ));
        }
        let digits = if digits < 0.0 { 6 } else { digits as usize };
        let width = length.abs() as usize;
        Ok(if length < 0.0 {
            format!("{value:0width$.digits$}")
        } else {
            format!("{value:width$.digits$}")
        })
    }

    /// `vstr(count, vector, separator, length, digits)`: 2 to 5 components, whatever the count; missing components are zero, also
    /// those of a single number (measured).
    fn vstr(&mut self, place: Place) -> PResult<String> {
        let count = self.full_float()?;
        self.comma()?;
        let vector = self.as_vector()?;
        self.comma()?;
        let separator = self.string()?;
        self.comma()?;
        let length = self.full_float()?;
        self.comma()?;
        let digits = self.full_float()?;
        let mut text = String::new();
        let components = vector.as_slice().iter().copied();
        let components = components.chain(std::iter::repeat(0.0));
        for (index, component) in components.take((count as usize).clamp(2, 5)).enumerate() {
            if index > 0 {
                text.push_str(&separator);
            }
            text.push_str(&self.formatted(component, length, digits, place)?);
        }
        Ok(text)
    }

    /// `datetime(days, format)`: the conversions of C's `strftime`, in English.
    fn datetime(&mut self, place: Place) -> PResult<String> {
        let days = self.full_float()?;
        let format = if self.accept(Kind::Comma)? {
            self.string()?
        } else {
            "%Y-%m-%d %H:%M:%SZ".into()
        };
        if !(days.abs() < 1e8) {
            return Err(self.fail(place, format!("{days} days after 2000 is not a valid date")));
        }
        Ok(date(days, &format))
    }

    /// Whether a file of this name can be found.
    pub(super) fn exists(&mut self, name: &str, place: Place) -> bool {
        matches!(
            self.find_file(name, place, true),
            Ok(_) | Err(HostError::TooLarge { .. })
        )
    }
}

/// The number that a text begins with, as C's `atof` reads it; 0 if there is none.
pub(super) fn leading_number(text: &str) -> f64 {
    let text = text.trim_start();
    let unsigned = text.strip_prefix(['-', '+']).unwrap_or(text);
    let signed = |size: f64| if text.starts_with('-') { -size } else { size };
    let begins = |word: &str| {
        let start = unsigned.get(..word.len());
        start.is_some_and(|start| start.eq_ignore_ascii_case(word))
    };
    if begins("0x") {
        return signed(leading_hexadecimal(&unsigned[2..]));
    }
    if begins("inf") {
        return signed(f64::INFINITY);
    }
    if begins("nan") {
        return f64::NAN;
    }
    let sign = text.len() - unsigned.len();
    let digits = unsigned.bytes().take_while(|b| b.is_ascii_digit()).count();
    let mut end = digits;
    let tail = &unsigned[end..];
    if let Some(fraction) = tail.strip_prefix('.') {
        end += 1 + fraction.bytes().take_while(u8::is_ascii_digit).count();
    }
    let tail = &unsigned[end..];
    if tail.starts_with(['e', 'E']) {
        let exponent = tail[1..].strip_prefix(['-', '+']).unwrap_or(&tail[1..]);
        let count = exponent.bytes().take_while(u8::is_ascii_digit).count();
        if count > 0 {
            end += tail.len() - exponent.len() + count;
        }
    }
    text[..sign + end].parse().unwrap_or(0.0)
}

/// The same for digits to the base of 16, with an exponent to the base of 2 behind a `p`.
fn leading_hexadecimal(text: &str) -> f64 {
    let (mut value, mut places, mut is_fraction) = (0.0, 0, false);
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        match first.to_digit(16) {
            Some(digit) => {
                value = value * 16.0 + f64::from(digit);
                places += i32::from(is_fraction);
            }
            None if first == '.' && !is_fraction => is_fraction = true,
            None => break,
        }
        rest = &rest[first.len_utf8()..];
    }
    let exponent = rest.strip_prefix(['p', 'P']).map_or(0.0, leading_number);
    value * 2f64.powi(exponent.clamp(-5000.0, 5000.0) as i32 - 4 * places)
}

const DAYS: [&str; 7] = [
    "Sunday",
    "Monday",
    "Tuesday",
    "Wednesday",
    "Thursday",
    "Friday",
    "Saturday",
];

const MONTHS: [&str; 12] = [
    "January",
    "February",
    "March",
    "April",
    "May",
    "June",
    "July",
    "August",
    "September",
    "October",
    "November",
    "December",
];

/// Days since the beginning of 2000, in the proleptic Gregorian calendar (Howard Hinnant, "chrono-compatible low-level date
/// algorithms", `civil_from_days`).
fn date(days: f64, format: &str) -> String {
    let whole = days.floor();
    let seconds = ((days - whole) * 86_400.0) as u32;
    // Days since 0000-03-01.
    let z = whole as i64 + 730_425;
    let era = z.div_euclid(146_097);
    let day_of_era = z.rem_euclid(146_097);
    let year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let m = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * m + 2) / 5 + 1;
    let month = if m < 10 { m + 3 } else { m - 9 };
    let year = year_of_era + era * 400 + i64::from(month <= 2);
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    // The year of the algorithm begins in March.
    let since_january = if month <= 2 {
        day_of_year - 305
    } else {
        day_of_year + 60 + i64::from(leap)
    };
    // The first day of 2000 was a Saturday.
    let weekday = (whole as i64 + 6).rem_euclid(7);
    let name = |names: &[&'static str], index: i64| {
        let index = usize::try_from(index).unwrap_or(0);
        names.get(index).copied().unwrap_or("")
    };
    let short = |text: &'static str| text.get(..3).unwrap_or(text);
    let (month_name, day_name) = (name(&MONTHS, month - 1), name(&DAYS, weekday));
    let clock = format!(
        "{:02}:{:02}:{:02}",
        seconds / 3600,
        seconds / 60 % 60,
        seconds % 60
    );
    let mut out = String::new();
    let mut chars = format.chars();
    while let Some(c) = chars.next() {
        if c != '%' {
            out.push(c);
            continue;
        }
        match chars.next() {
            Some('Y') => out.push_str(&year.to_string()),
            Some('y') => out.push_str(&format!("{:02}", year.rem_euclid(100))),
            Some('m') => out.push_str(&format!("{month:02}")),
            Some('d') => out.push_str(&format!("{day:02}")),
            Some('H') => out.push_str(&format!("{:02}", seconds / 3600)),
            Some('M') => out.push_str(&format!("{:02}", seconds / 60 % 60)),
            Some('S') => out.push_str(&format!("{:02}", seconds % 60)),
            Some('I') => out.push_str(&format!("{:02}", (seconds / 3600 + 11) % 12 + 1)),
            Some('p') => out.push_str(if seconds < 43_200 { "AM" } else { "PM" }),
            Some('j') => out.push_str(&format!("{since_january:03}")),
            Some('w') => out.push_str(&weekday.to_string()),
            Some('A') => out.push_str(day_name),
            Some('a') => out.push_str(short(day_name)),
            Some('B') => out.push_str(month_name),
            Some('b') => out.push_str(short(month_name)),
            Some('X') => out.push_str(&clock),
            Some('x') => {
                let year = year.rem_euclid(100);
                out.push_str(&format!("{month:02}/{day:02}/{year:02}"));
            }
            Some('c') => {
                let (weekday, month) = (short(day_name), short(month_name));
                out.push_str(&format!("{weekday} {month} {day:2} {clock} {year}"));
            }
            Some('%') => out.push('%'),
            Some(other) => {
                out.push('%');
                out.push(other);
            }
            None => out.push('%'),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_at_the_front_of_a_text() {
        for (text, expected) in [
            ("1.5e2", 150.0),
            ("  -3.25abc", -3.25),
            ("12e", 12.0),
            ("1e+", 1.0),
            ("abc", 0.0),
            ("", 0.0),
            (".5", 0.5),
            ("5.", 5.0),
            ("0x1F", 31.0),
            ("-0X10", -16.0),
            ("0x1p4", 16.0),
            ("0x.8z", 0.5),
            ("0x", 0.0),
            ("-Infinity", f64::NEG_INFINITY),
        ] {
            assert_eq!(leading_number(text), expected, "{text}");
        }
    }

    #[test]
    fn dates() {
        assert_eq!(date(0.0, "%Y-%m-%d %H:%M:%S"), "2000-01-01 00:00:00");
        assert_eq!(date(59.5, "%d.%m.%y %H%%%M"), "29.02.00 12%00");
        assert_eq!(date(-1.0, "%Y-%m-%d"), "1999-12-31");
        assert_eq!(date(9000.0, "%Y-%m-%d"), "2024-08-22");
        // As POV-Ray 3.7 writes them.
        let all = "%j %p %I %a %A %b %B|%c|%x %X";
        let expected =
            "061 AM 06 Sat Saturday Mar March|Sat Mar  2 06:00:00 2019|03/02/19 06:00:00";
        assert_eq!(date(7000.25, all), expected);
        assert_eq!(date(0.75, "%j %p %I %w"), "001 PM 06 6");
        assert_eq!(date(59.0 + 306.0, "%j"), "366");
    }
}
