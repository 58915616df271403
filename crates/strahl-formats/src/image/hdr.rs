//! Radiance pictures (Greg Ward, "Real Pixels", Graphics Gems II): three mantissas of 8 bit with a common exponent.
//!
//! Written here and not by the `image` crate, whose encoder takes the exponent from the platform's logarithm, truncates,
//! and has no place for metadata.

use std::io::{self, Write};

use super::{Picture, WriteOptions};

pub(super) fn encode(
    writer: &mut dyn Write,
    picture: &Picture<'_>,
    _options: &WriteOptions,
) -> io::Result<()> {
    let window = picture.window;
    writer.write_all(b"#?RADIANCE\n")?;
    // As comments: a key that happens to be one of Radiance's variables, like EXPOSURE, would change the picture.
    writer.write_all(picture.comments().as_bytes())?;
    writer.write_all(b"FORMAT=32-bit_rle_rgbe\n")?;
    // The chromaticities of Rec. 709 and its white, D65; the format's default white is another one.
    writer.write_all(b"PRIMARIES=0.640 0.330 0.300 0.600 0.150 0.060 0.3127 0.3290\n\n")?;
    writeln!(writer, "-Y {} +X {}", window.height, window.width)?;

    let mut bytes = Vec::new();
    for row in picture.rgb.chunks_exact(window.width as usize) {
        let pixels: Vec<[u8; 4]> = row.iter().map(|&rgb| rgbe(rgb)).collect();
        bytes.clear();
        match u16::try_from(row.len()) {
            Ok(width @ 8..=0x7fff) => {
                let [high, low] = width.to_be_bytes();
                bytes.extend([2, 2, high, low]);
                for component in 0..4 {
                    let plane: Vec<u8> = pixels.iter().map(|pixel| pixel[component]).collect();
                    push_runs(&plane, &mut bytes);
                }
            }
            // Narrower and wider rows can't be compressed.
            _ => bytes.extend(pixels.as_flattened()),
        }
        writer.write_all(&bytes)?;
    }
    Ok(())
}

/// Mantissas and exponent of a colour, the mantissas rounded to the nearest; a mantissa `m` stands for `m * 2^(exponent - 136)`.
///
/// That is how nearly every program reads them. Radiance itself reads `m + 1/2`, and so half a code brighter.
///
/// Negative samples and NaN become 0, as does what lies below the smallest exponent; what lies above the largest one becomes the
/// largest number.
fn rgbe(rgb: [f32; 3]) -> [u8; 4] {
    const LARGEST: f64 = 255.0 * ((1_u128 << 119) as f64);
    let rgb = rgb.map(|sample| {
        let sample = f64::from(sample);
        if sample > LARGEST {
            LARGEST
        } else if sample > 0.0 {
            sample
        } else {
            0.0
        }
    });
    let largest = rgb.iter().fold(0.0, |a, &b| if b > a { b } else { a });
    // The unit of the mantissas is a power of two that makes the largest one 128..=255: the exponent is read from the bits.
    let mut exponent = ((largest.to_bits() >> 52) as i32) - 1023;
    // Below 2^-128 the exponent's code would be that of zero, or less.
    if exponent < -128 {
        return [0; 4];
    }
    let mantissas_at = |exponent: i32| {
        let unit = f64::from_bits(((exponent - 7 + 1023) as u64) << 52);
        rgb.map(|sample| (sample / unit + 0.5).floor())
    };
    let mut mantissas = mantissas_at(exponent);
    if mantissas.contains(&256.0) {
        // Rounding carried into the next power of two; the cap at LARGEST excludes this for the last one.
        exponent += 1;
        mantissas = mantissas_at(exponent);
    }
    let [r, g, b] = mantissas.map(|mantissa| mantissa as u8);
    [r, g, b, (exponent + 129) as u8]
}

/// Appends bytes as runs of 3 to 127 equal ones (128 + length, byte) and stretches of 1 to 128 others (length, bytes).
fn push_runs(bytes: &[u8], encoded: &mut Vec<u8>) {
    let mut rest = bytes;
    while let Some(&first) = rest.first() {
        let run = run_length(rest, first);
        if run >= 3 {
            encoded.extend([128 + run as u8, first]);
            rest = &rest[run..];
            continue;
        }
        let starts_run = |window: &[u8]| window[0] == window[1] && window[1] == window[2];
        let until_run = rest.windows(3).take(128).position(starts_run);
        let (stretch, after) = rest.split_at(until_run.unwrap_or(rest.len()).min(128));
        encoded.push(stretch.len() as u8);
        encoded.extend(stretch);
        rest = after;
    }
}

/// How many of the first 127 bytes equal `first` in sequence.
fn run_length(bytes: &[u8], first: u8) -> usize {
    bytes
        .iter()
        .take(127)
        .take_while(|&&byte| byte == first)
        .count()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The definition, in arithmetic that is exact.
    fn value([r, g, b, e]: [u8; 4]) -> [f64; 3] {
        let unit = if e == 0 {
            0.0
        } else {
            2_f64.powi(i32::from(e) - 136)
        };
        [r, g, b].map(|mantissa| f64::from(mantissa) * unit)
    }

    #[test]
    fn mantissas_are_the_nearest() {
        let mut x = 1e-30_f32;
        while x < 1e30 {
            for rgb in [
                [x, x / 3.0, 0.0],
                [0.1 * x, x, 0.999 * x],
                [x / 1000.0, x / 7.0, x],
            ] {
                let back = value(rgbe(rgb));
                let largest = f64::from(rgb.iter().copied().fold(0.0, f32::max));
                for (a, b) in rgb.into_iter().zip(back) {
                    assert!(
                        (f64::from(a) - b).abs() <= largest / 256.0,
                        "{rgb:?} {back:?}"
                    );
                }
            }
            x *= 1.07;
        }
    }

    #[test]
    fn codes_of_chosen_colours() {
        assert_eq!(rgbe([1.0, 0.5, 0.25]), [128, 64, 32, 129]);
        assert_eq!(rgbe([0.0; 3]), [0; 4]);
        assert_eq!(rgbe([f32::NAN, -1.0, -0.0]), [0; 4]);
        assert_eq!(rgbe([f32::INFINITY, 0.0, 0.0]), [255, 0, 0, 255]);
        assert_eq!(rgbe([f32::MAX, 0.0, 0.0]), [255, 0, 0, 255]);
        // Rounding carries: 255.9 of 256 is 1.
        assert_eq!(rgbe([255.9 / 256.0, 0.0, 0.0]), [128, 0, 0, 129]);
        assert_eq!(rgbe([f32::MIN_POSITIVE, 0.0, 0.0]), [128, 0, 0, 3]);
        assert_eq!(rgbe([f32::from_bits(1), 0.0, 0.0]), [0; 4]);
    }

    #[test]
    fn runs_decode_to_their_bytes() {
        let mut state = 1_u32;
        let mut random = move |bound: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) % bound
        };
        for _ in 0..300 {
            let mut bytes = Vec::new();
            for _ in 0..random(20) {
                let (count, byte) = (random(300), random(4) as u8);
                if random(2) == 0 {
                    bytes.extend((0..count).map(|_| byte));
                } else {
                    bytes.extend((0..count).map(|i| byte.wrapping_add(i as u8)));
                }
            }
            let mut encoded = Vec::new();
            push_runs(&bytes, &mut encoded);
            let (mut decoded, mut rest) = (Vec::new(), encoded.as_slice());
            while let [length, tail @ ..] = rest {
                let length = usize::from(*length);
                assert_ne!(length, 0);
                if length > 128 {
                    decoded.extend((0..length - 128).map(|_| tail[0]));
                    rest = &tail[1..];
                } else {
                    decoded.extend(&tail[..length]);
                    rest = &tail[length..];
                }
            }
            assert_eq!(decoded, bytes);
        }
    }
}
