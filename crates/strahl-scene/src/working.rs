use strahl_math::det;
use strahl_shade::{Color, srgb};

/// The colour space in which the colours of a scene are given and its light is computed.
///
/// Sums of light are correct in linear space only; the others exist for old scenes (POV-Ray's `assumed_gamma`). Pictures are
/// always linear: the mean of a pixel is decoded at the end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum WorkingSpace {
    /// Linear light.
    #[default]
    Linear,
    /// Codes of sRGB.
    Srgb,
    /// Codes that are linear light to the power of one over this number, which must be positive.
    Gamma(f64),
}

impl WorkingSpace {
    /// Linear light from a colour of this space.
    #[must_use]
    pub fn decode(self, color: Color) -> Color {
        match self {
            Self::Linear => color,
            Self::Srgb => color.map(srgb::decode),
            Self::Gamma(gamma) => color.map(|c| if c > 0.0 { det::pow(c, gamma) } else { c }),
        }
    }

    /// [`WorkingSpace::decode`] for many colours at a time, with the same bits.
    pub fn decode_all(self, colors: &mut [Color]) {
        if self == Self::Linear {
            return;
        }
        for few in colors.chunks_mut(FEW) {
            let mut values = [0.0; 3 * FEW];
            let (places, _) = values.as_chunks_mut::<3>();
            for (place, color) in places.iter_mut().zip(few.iter()) {
                *place = color.to_array();
            }
            let used = &mut values[..3 * few.len()];
            match self {
                Self::Linear => {}
                Self::Srgb => srgb::decode_all(used),
                Self::Gamma(gamma) => gamma_all(used, gamma),
            }
            let (places, _) = values.as_chunks::<3>();
            for (color, [r, g, b]) in few.iter_mut().zip(places) {
                *color = Color::new(*r, *g, *b);
            }
        }
    }

    /// A colour of this space from linear light.
    #[must_use]
    pub fn encode(self, color: Color) -> Color {
        match self {
            Self::Linear => color,
            Self::Srgb => color.map(srgb::encode),
            Self::Gamma(gamma) => color.map(|c| if c > 0.0 { det::pow(c, 1.0 / gamma) } else { c }),
        }
    }
}

/// The number of colours that are decoded at a time.
const FEW: usize = 16;

/// Raises the positive ones of at most three times [`FEW`] values to a power.
fn gamma_all(values: &mut [f64], gamma: f64) {
    let mut powers = [1.0; 3 * FEW];
    for (power, value) in powers.iter_mut().zip(values.iter()) {
        if *value > 0.0 {
            *power = *value;
        }
    }
    det::pow_all(&mut powers, gamma);
    for (value, power) in values.iter_mut().zip(powers) {
        if *value > 0.0 {
            *value = power;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spaces_go_there_and_back() {
        let c = Color::new(0.5, 0.0, 0.02);
        for space in [
            WorkingSpace::Linear,
            WorkingSpace::Srgb,
            WorkingSpace::Gamma(2.2),
        ] {
            let back = space.decode(space.encode(c));
            for (a, b) in back.to_array().iter().zip(c.to_array()) {
                assert!((a - b).abs() < 1e-12, "{space:?}");
            }
        }
        let half = WorkingSpace::Gamma(2.0).decode(Color::gray(0.5));
        assert_eq!(half, Color::gray(0.25));
    }

    #[test]
    fn many_colours_are_decoded_as_single_ones() {
        let color = |i: u32| {
            let x = f64::from(i) * 0.037 - 0.3;
            Color::new(x, x * x, 1.0 / (x + 0.01))
        };
        let colors: Vec<Color> = (0..50).map(color).collect();
        for space in [
            WorkingSpace::Linear,
            WorkingSpace::Srgb,
            WorkingSpace::Gamma(2.2),
            WorkingSpace::Gamma(2.0),
        ] {
            for count in [1, 16, 17, 50] {
                let mut all = colors[..count].to_vec();
                space.decode_all(&mut all);
                for (decoded, color) in all.iter().zip(&colors) {
                    let bits = |c: Color| c.to_array().map(f64::to_bits);
                    assert_eq!(bits(*decoded), bits(space.decode(*color)), "{space:?}");
                }
            }
        }
    }
}
