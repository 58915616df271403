//! The sRGB transfer function of IEC 61966-2-1:1999: between linear light and the codes pictures are stored in.
//!
//! With linear light `L` and encoded value `V`, both in `0..=1`:
//! `V = 12.92 L` for `L <= 0.0031308`, else `V = 1.055 L^(1/2.4) - 0.055`, and
//! `L = V / 12.92` for `V <= 0.04045`, else `L = ((V + 0.055) / 1.055)^2.4`.
//! The powers are [`strahl_math::det::pow`], so that a code is the same on every machine.

use std::sync::LazyLock;

use strahl_math::det;

/// The encoded value from which on [`decode`] follows a curve.
const CURVE: f64 = 0.040_45;

/// The number of values that [`decode_all`] takes at a time.
const FEW: usize = 48;

/// The encoded value of linear light; below zero the function continues with its straight line, above one with its curve.
pub fn encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * det::pow(linear, 1.0 / 2.4) - 0.055
    }
}

/// The linear light of an encoded value: the inverse of [`encode`].
///
/// The standard's rounded constants leave a step of about 1e-7 where line and curve meet.
pub fn decode(encoded: f64) -> f64 {
    if encoded <= CURVE {
        encoded / 12.92
    } else {
        det::pow((encoded + 0.055) / 1.055, 2.4)
    }
}

/// [`decode`] for many values at a time, with the same bits.
pub fn decode_all(values: &mut [f64]) {
    for few in values.chunks_mut(FEW) {
        let mut powers = [1.0; FEW];
        for (power, value) in powers.iter_mut().zip(few.iter()) {
            if *value > CURVE {
                *power = (*value + 0.055) / 1.055;
            }
        }
        det::pow_all(&mut powers, 2.4);
        for (value, power) in few.iter_mut().zip(powers) {
            *value = if *value > CURVE {
                power
            } else {
                decode(*value)
            };
        }
    }
}

/// The 8-bit code of linear light: clamped to `0..=1`, encoded, rounded half up; NaN is 0.
///
/// Each code begins at the single precision number nearest to the light of the encoded value halfway to the code before. So an encoded value that lies exactly
/// halfway, such as 0.3, gets the upper code, although its light was rounded.
#[inline]
pub fn encode_u8(linear: f32) -> u8 {
    Codes::get().of(linear)
}

/// Appends [`encode_u8`] of each sample of linear light.
pub fn push_u8(linear: &[f32], codes: &mut Vec<u8>) {
    let table = Codes::get();
    codes.reserve(linear.len());
    let (blocks, rest) = linear.as_chunks();
    for block in blocks {
        codes.extend_from_slice(&table.of_block(block));
    }
    codes.extend(rest.iter().map(|x| table.of(*x)));
}

/// The number of samples that are looked up together.
const BLOCK: usize = 32;

/// Codes by the leading bits of a number: the number of powers of two below 1 that are told apart, and of parts of each. At most
/// one code begins within a part.
const OCTAVES: usize = 16;
const PARTS: usize = 128;

/// The 8-bit codes, found without a power.
struct Codes {
    /// For each part of each octave from 2⁻¹⁶ to 1, what is added to a number's bits below those of the part: their sum has the code above
    /// these bits. It is the code of the part's smallest number, plus what makes a number carry over from which on the next code begins.
    codes: [u32; OCTAVES * PARTS],
}

impl Codes {
    fn get() -> &'static Self {
        static CODES: LazyLock<Codes> = LazyLock::new(Codes::new);
        &CODES
    }

    fn new() -> Self {
        let mut middles: [f64; 255] = std::array::from_fn(|code| (code as f64 + 0.5) / 255.0);
        decode_all(&mut middles);
        // The bits of positive numbers are in the order of the numbers.
        let mut starts = middles
            .into_iter()
            .map(|middle| (middle as f32).to_bits())
            .peekable();
        let mut code = 0;
        let codes = std::array::from_fn(|index| {
            let first = Self::ORIGIN + ((index as u32) << Self::SHIFT);
            while starts.next_if(|start| *start <= first).is_some() {
                code += 1;
            }
            let ahead = starts.peek().map_or(u32::MAX, |start| start - first);
            (code << Self::SHIFT) + (1u32 << Self::SHIFT).saturating_sub(ahead)
        });
        Self { codes }
    }

    /// The bits below those that number a part.
    const SHIFT: u32 = 23 - PARTS.ilog2();
    /// The bits of 2⁻¹⁶, whose code is 0.
    const ORIGIN: u32 = (127 - OCTAVES as u32) << 23;

    /// The bits of the number nearest to a sample that the table has, above [`Codes::ORIGIN`].
    #[inline(always)]
    fn place(linear: f32) -> u32 {
        // In this order NaN becomes the smallest number, too.
        let within = linear
            .max(f32::from_bits(Self::ORIGIN))
            .min(1.0f32.next_down());
        within.to_bits() - Self::ORIGIN
    }

    #[inline(always)]
    fn at(&self, place: u32) -> u8 {
        // The remainder is there for the compiler, which then leaves out a comparison.
        let index = (place >> Self::SHIFT) as usize % (OCTAVES * PARTS);
        let below = place % (1 << Self::SHIFT);
        ((self.codes[index] + below) >> Self::SHIFT) as u8
    }

    #[inline]
    fn of(&self, linear: f32) -> u8 {
        self.at(Self::place(linear))
    }

    /// The codes of a block of samples.
    #[inline]
    fn of_block(&self, linear: &[f32; BLOCK]) -> [u8; BLOCK] {
        // First all places, which vector instructions find, then their codes.
        let mut places = [0; BLOCK];
        for (place, x) in places.iter_mut().zip(linear) {
            *place = Self::place(*x);
        }
        places.map(|place| self.at(place))
    }
}

/// The 16-bit code of linear light: clamped to `0..=1`, encoded, rounded half up; NaN is 0.
pub fn encode_u16(linear: f64) -> u16 {
    quantize(linear, 65_535.0) as u16
}

/// The linear light of an 8-bit code.
pub fn decode_u8(code: u8) -> f32 {
    static TABLE: LazyLock<[f32; 256]> =
        LazyLock::new(|| std::array::from_fn(|code| decode(code as f64 / 255.0) as f32));
    TABLE[usize::from(code)]
}

/// The linear light of a 16-bit code.
pub fn decode_u16(code: u16) -> f32 {
    static TABLE: LazyLock<Vec<f32>> = LazyLock::new(|| {
        (0..=u16::MAX)
            .map(|code| decode(f64::from(code) / 65_535.0) as f32)
            .collect()
    });
    TABLE[usize::from(code)]
}

/// `floor(encode(linear) * largest + 1/2)` within `0..=largest`.
fn quantize(linear: f64, largest: f64) -> f64 {
    // The comparisons are arranged so that NaN takes the first way out.
    if linear > 0.0 {
        if linear < 1.0 {
            (encode(linear) * largest + 0.5).floor()
        } else {
            largest
        }
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_survives_decoding_and_encoding() {
        for code in 0..=u8::MAX {
            assert_eq!(encode_u8(decode_u8(code)), code);
        }
        for code in 0..=u16::MAX {
            assert_eq!(encode_u16(f64::from(decode_u16(code))), code);
        }
    }

    #[test]
    fn the_search_for_a_code_agrees_with_the_formula() {
        let formula = |x: f32| quantize(f64::from(x), 255.0) as u8;
        for code in 1..=255 {
            let middle = decode((f64::from(code) - 0.5) / 255.0) as f32;
            let [before, after] = [middle.next_down(), middle.next_up()];
            for x in [before, before.next_down(), after, after.next_up()] {
                assert_eq!(encode_u8(x), formula(x), "{x}");
            }
            assert_eq!(f64::from(encode_u8(before)) + 1.0, f64::from(code));
            assert_eq!(f64::from(encode_u8(middle)), f64::from(code));
        }
        let (nan, infinity) = (f32::NAN, f32::INFINITY);
        for x in [nan, -1.0, -0.0, 0.0, 1e-4, 1.0, 2.0, infinity, -infinity] {
            assert_eq!(encode_u8(x), formula(x), "{x}");
        }
        // 255 times 0.1, 0.3, ... lies halfway between two codes.
        for (encoded, code) in [(0.1, 26), (0.3, 77), (0.5, 128), (0.7, 179), (0.9, 230)] {
            assert_eq!(encode_u8(decode(encoded) as f32), code);
        }
        let mut codes = vec![7];
        push_u8(&[0.5, 0.0, 1.0], &mut codes);
        assert_eq!(codes, [7, 188, 0, 255]);
    }

    #[test]
    fn codes_begin_at_their_borders_and_nowhere_else() {
        let code = |encoded: f64| (decode(encoded / 255.0) as f32).to_bits();
        let mut codes = vec![];
        let mut all = |bits: std::ops::Range<u32>, code: u8| {
            for first in bits.clone().step_by(1 << 16) {
                let samples: Vec<f32> = (first..bits.end.min(first + (1 << 16)))
                    .map(f32::from_bits)
                    .collect();
                codes.clear();
                push_u8(&samples, &mut codes);
                assert_eq!(codes.len(), samples.len());
                let wrong = codes.iter().position(|found| *found != code);
                assert_eq!(wrong.map(|index| samples[index]), None, "{code}");
            }
        };
        // All numbers from 2e-5 to a little above 1.
        let mut first = 2e-5f32.to_bits();
        for number in 0..255u8 {
            let end = code(f64::from(number) + 0.5);
            all(first..end, number);
            first = end;
        }
        all(first..1.001f32.to_bits(), 255);
        // Some of the others.
        let others = (0..1 << 16).map(|upper: u32| f32::from_bits(upper << 16 | 0x5A5A));
        for x in others.filter(|x| !(2e-5..1.0).contains(x)) {
            let clipped = if x >= 1.0 { 255 } else { 0 };
            assert_eq!(encode_u8(x), clipped, "{x}");
        }
    }

    #[test]
    fn known_values() {
        // 50 % code value is 21.4 % light; 18 % gray is code 118; both standard figures of the sRGB curve.
        assert!((decode(0.5) - 0.214_041_140_482_232_55).abs() < 1e-15);
        assert_eq!(encode_u8(0.18), 118);
        assert_eq!(encode_u8(0.5), 188);
        assert_eq!(decode_u8(255), 1.0);
        assert_eq!(decode_u8(0), 0.0);
        assert_eq!(decode_u8(10), (10.0 / 255.0 / 12.92) as f32);
    }

    #[test]
    fn codes_switch_half_way_between_their_encoded_values() {
        for code in 0..u8::MAX {
            let boundary = decode((f64::from(code) + 0.5) / 255.0);
            assert_eq!(encode_u8((boundary * (1.0 - 2e-7)) as f32), code);
            assert_eq!(encode_u8((boundary * (1.0 + 2e-7)) as f32), code + 1);
        }
    }

    #[test]
    fn hostile_values_are_clamped() {
        for (linear, code) in [
            (f64::NAN, 0),
            (-0.0, 0),
            (-1.0, 0),
            (f64::NEG_INFINITY, 0),
            (f64::MIN_POSITIVE, 0),
            (1.0, 65_535),
            (1e300, 65_535),
            (f64::INFINITY, 65_535),
        ] {
            assert_eq!(encode_u16(linear), code, "{linear}");
            assert_eq!(u16::from(encode_u8(linear as f32)), code / 257, "{linear}");
        }
    }
}
