//! Values of arguments that have no type of their own.

use strahl::formats::image::{BitDepth, ImageFormat};
use strahl::sdl::{Limits, Word};
use strahl::tracing::Region;

fn parse_pair(s: &str, separator: char) -> Option<(u32, u32)> {
    let (a, b) = s.split_once(separator)?;
    Some((a.trim().parse().ok()?, b.trim().parse().ok()?))
}

pub(super) fn parse_size(s: &str) -> Result<(u32, u32), String> {
    match parse_pair(s, 'x') {
        None => Err("expected WIDTHxHEIGHT in pixels, such as 1280x720".to_owned()),
        Some((0, _) | (_, 0)) => Err("width and height must be at least 1".to_owned()),
        Some(size) => Ok(size),
    }
}

pub(super) fn parse_pixel(s: &str) -> Result<(u32, u32), String> {
    parse_pair(s, ',').ok_or_else(|| "expected X,Y in pixels, such as 320,200".to_owned())
}

pub(super) fn parse_region(s: &str) -> Result<Region, String> {
    let parsed = s.rsplit_once(',').and_then(|(position, size)| {
        let ((x, y), (width, height)) = (parse_pair(position, ',')?, parse_pair(size, 'x')?);
        Some(Region {
            x,
            y,
            width,
            height,
        })
    });
    parsed.ok_or_else(|| "expected X,Y,WIDTHxHEIGHT in pixels, such as 100,50,64x64".to_owned())
}

pub(super) fn parse_positive(s: &str) -> Result<f64, String> {
    let number = s.parse().ok().filter(|x: &f64| *x > 0.0 && x.is_finite());
    number.ok_or_else(|| "expected a number above 0".to_owned())
}

pub(super) fn parse_weight(s: &str) -> Result<f64, String> {
    s.parse()
        .ok()
        .filter(|w| (0.0..=1.0).contains(w))
        .ok_or_else(|| "expected a number from 0 to 1".to_owned())
}

pub(super) fn parse_declaration(s: &str) -> Result<(String, f64), String> {
    let (name, value) = s
        .split_once('=')
        .ok_or_else(|| "expected NAME=VALUE, such as Detail=2".to_owned())?;
    let (name, value) = (name.trim(), value.trim());
    let mut letters = name.chars();
    let starts = letters
        .next()
        .is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
    if !starts || !letters.all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return Err(format!(
            "`{name}` is not an identifier: use letters, digits and `_`, and no digit first"
        ));
    }
    if Word::ALL.iter().any(|(_, word, _)| *word == name) {
        return Err(format!(
            "`{name}` is a keyword of the language; use a name that begins with a capital letter"
        ));
    }
    let number = value.parse().ok().filter(|v: &f64| v.is_finite());
    number.map(|v| (name.to_owned(), v)).ok_or_else(|| {
        format!("`{value}` is not a number: only numbers can be declared here, such as {name}=2.5")
    })
}

pub(super) fn parse_limit(s: &str) -> Result<(String, u64), String> {
    let (name, value) = s
        .split_once('=')
        .ok_or_else(|| "expected NAME=N, such as steps=1e11".to_owned())?;
    let number = value.parse::<f64>().ok().filter(|v| *v >= 0.0 && *v < 1e18);
    let number = number.ok_or_else(|| format!("`{value}` is not a number from 0 to 1e18"))?;
    if !Limits::default().set(name, number as u64) {
        let known = Limits::NAMES.join(", ");
        return Err(format!(
            "there is no limit `{name}`; the limits are {known}"
        ));
    }
    Ok((name.to_owned(), number as u64))
}

pub(super) fn parse_version(s: &str) -> Result<f64, String> {
    s.parse()
        .ok()
        .filter(|v| (1.0..4.0).contains(v))
        .ok_or_else(|| "expected a version from 1.0 to 3.8, such as 3.7".to_owned())
}

pub(super) fn parse_picture_format(s: &str) -> Result<ImageFormat, String> {
    ImageFormat::from_name(s).ok_or_else(|| {
        let names = strahl::formats::image::formats().iter();
        let names: Vec<&str> = names.map(|info| info.extensions[0]).collect();
        format!("expected one of {}", names.join(", "))
    })
}

pub(super) fn parse_bits(s: &str) -> Result<BitDepth, String> {
    match s {
        "8" => Ok(BitDepth::Eight),
        "16" => Ok(BitDepth::Sixteen),
        _ => Err("expected 8 or 16".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn declarations_are_numbers_with_names_of_their_own() {
        assert_eq!(parse_declaration("A_1 = -2.5"), Ok(("A_1".into(), -2.5)));
        for bad in ["A", "1A=1", "=1", "sphere=1", "A=red", "A=inf", "A-B=1"] {
            assert!(parse_declaration(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn regions_and_sizes() {
        assert_eq!(
            parse_region("100,50,64x32"),
            Ok(Region {
                x: 100,
                y: 50,
                width: 64,
                height: 32
            })
        );
        assert!(
            parse_region("100,50").is_err()
                && parse_size("12").is_err()
                && parse_size("0x10").is_err()
                && parse_size("10x0").is_err()
                && parse_pixel("1x2").is_err()
        );
        assert!(
            parse_weight("-0.1").is_err()
                && parse_weight("nan").is_err()
                && parse_bits("12").is_err()
        );
    }
}
