use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_formats::image::{Heights, decode_heights};
use strahl_geometry::HeightField;
use strahl_math::det;

/// `height_field { [type] "file" [gamma g] | function width, height { ... } [water_level y] [smooth] ... }`
pub(super) fn height_field(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let heights = if p.accept_word(Word::Function)? {
            p.height_function()?
        } else {
            p.height_file()?
        };
        let (mut water, mut smooth) = (0.0, false);
        loop {
            if p.accept_word(Word::WaterLevel)? {
                water = p.float()?;
                // In the first version of the language it counts 256ths (measured).
                if p.state.global.versioned && p.version < 2.0 {
                    water /= 256.0;
                }
            } else if p.accept_word(Word::Smooth)? {
                smooth = p.switched()?;
            } else {
                break;
            }
        }
        let Heights {
            width,
            height,
            values,
            ..
        } = heights;
        Ok(HeightField::try_new(width, height, values, water, smooth))
    })
}

impl Parser<'_> {
    /// `[type] "file" [gamma g] [premultiplied on]`
    fn height_file(&mut self) -> PResult<Heights> {
        let (kind, name) = self.picture_name()?;
        let place = self.place();
        let file = self.read_file(&name, place)?;
        let mut heights = match decode_heights(&file.bytes, &name) {
            Ok(heights) => heights,
            Err(error) => return Err(self.fail(place, error.to_string())),
        };
        if kind == Some(Word::Pot) {
            heights = joined(&heights);
        }
        loop {
            if self.accept_word(Word::Gamma)? {
                let decode: Box<dyn Fn(f64) -> f64> = if self.accept_word(Word::Srgb)? {
                    Box::new(strahl_shade::srgb::decode)
                } else {
                    let power = self.float()?;
                    Box::new(move |x| det::pow(x, power))
                };
                // POV-Ray's result for colours and indices is certainly not intended.
                if heights.gray {
                    for value in &mut heights.values {
                        *value = in_16_bits(decode(f64::from(*value) / 65535.0));
                    }
                }
            } else if self.accept_word(Word::Premultiplied)? {
                self.switched()?;
            } else {
                return Ok(heights);
            }
        }
    }

    /// `width, height { ... }` after `function`.
    fn height_function(&mut self) -> PResult<Heights> {
        let mut values = vec![];
        let (width, height) = self.sampled_function(|[r, g, b, _]| {
            // Values outside of the range wrap around (measured); colours count by brightness.
            values.push(if r == g && g == b {
                in_16_bits(r)
            } else {
                let channel = |x: f64| f64::from(in_16_bits(x.clamp(0.0, 1.0)));
                (0.297 * channel(r) + 0.589 * channel(g) + 0.114 * channel(b)) as u16
            });
        })?;
        Ok(Heights {
            width,
            height,
            values,
            gray: true,
        })
    }
}

/// The heights of a picture made with Fractint's continuous potential, whose right half has the lower bytes of the heights in the
/// left half.
fn joined(halves: &Heights) -> Heights {
    let width = halves.width / 2;
    let rows = halves.values.chunks(halves.width.max(1) as usize);
    let values = rows.flat_map(|row| {
        let (high, low) = row.split_at(width as usize);
        high.iter().zip(low).map(|(high, low)| high | low >> 8)
    });
    Heights {
        width,
        values: values.collect(),
        ..*halves
    }
}

/// A height in 16 bits; larger values lose their upper bits.
fn in_16_bits(x: f64) -> u16 {
    // The first cast truncates, and turns NaN into 0.
    (x * 65535.0) as i64 as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_right_half_of_a_potential_has_the_lower_bytes() {
        let halves = Heights {
            width: 4,
            height: 2,
            values: [1, 2, 30, 40, 3, 4, 50, 60]
                .map(|index| index << 8)
                .to_vec(),
            gray: false,
        };
        let whole = joined(&halves);
        let expected = [0x011e, 0x0228, 0x0332, 0x043c];
        assert_eq!((whole.width, whole.height), (2, 2));
        assert_eq!(whole.values, expected);
    }
}
