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
        for few in colors.chunks_mut(FEW / 3) {
            let mut components = [0.0; FEW];
            let (places, _) = components.as_chunks_mut::<3>();
            for (place, color) in places.iter_mut().zip(few.iter()) {
                *place = color.to_array();
            }
            self.decode_components(&mut components[..3 * few.len()]);
            let (places, _) = components.as_chunks::<3>();
            for (color, [r, g, b]) in few.iter_mut().zip(places) {
                *color = Color::new(*r, *g, *b);
            }
        }
    }

    /// [`WorkingSpace::decode`] for the components of many colours, with the same bits.
    pub fn decode_components(self, components: &mut [f64]) {
        match self {
            Self::Linear => {}
            Self::Srgb => srgb::decode_all(components),
            Self::Gamma(gamma) => {
                for few in components.chunks_mut(FEW) {
                    gamma_all(few, gamma);
                }
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

/// The number of components that are decoded at a time.
const FEW: usize = 48;

/// Raises the positive ones of at most [`FEW`] values to a power.
fn gamma_all(values: &mut [f64], gamma: f64) {
    let mut powers = [1.0; FEW];
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
                let components = colors[..count].iter().flat_map(|c| c.to_array());
                let mut components: Vec<f64> = components.collect();
                space.decode_components(&mut components);
                let components = components.as_chunks::<3>().0;
                for ((decoded, components), color) in all.iter().zip(components).zip(&colors) {
                    let bits = |c: [f64; 3]| c.map(f64::to_bits);
                    let expected = bits(space.decode(*color).to_array());
                    assert_eq!(bits(decoded.to_array()), expected, "{space:?}");
                    assert_eq!(bits(*components), expected, "{space:?}");
                }
            }
        }
    }
}
