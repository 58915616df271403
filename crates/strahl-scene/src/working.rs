use strahl_math::det;
use strahl_shade::{Color, srgb};

/// The colour space in which the colours of a scene are given and its light is computed.
///
/// Sums of light are correct in linear space only; the others exist for old scenes (POV-Ray's `assumed_gamma`). Pictures are
/// always linear: the radiance of primary rays is decoded at the end.
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
}
