use std::ops::{Add, Mul};

use crate::Color;

/// A colour with transparency, POV-Ray's `rgbft`: of the light from behind, the share `filter` passes tinted by the colour
/// and the share `transmit` passes unchanged. The rest, `1 - filter - transmit`, is how opaque the surface is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ColorFt {
    /// The colour, linear.
    pub rgb: Color,
    /// Share of the light that passes tinted.
    pub filter: f64,
    /// Share of the light that passes unchanged.
    pub transmit: f64,
}

impl ColorFt {
    /// White and completely transparent.
    pub const CLEAR: Self = Self {
        rgb: Color::WHITE,
        filter: 0.0,
        transmit: 1.0,
    };

    /// An opaque colour.
    pub const fn opaque(rgb: Color) -> Self {
        Self {
            rgb,
            filter: 0.0,
            transmit: 0.0,
        }
    }

    /// `1 - filter - transmit`: the share of the surface's own light. Negative if filter and transmit exceed 1 together.
    #[inline]
    pub fn opacity(self) -> f64 {
        1.0 - self.filter - self.transmit
    }

    /// The opacity in scenes from before POV-Ray 3.7 (measured): `1 - filter · max(r, g, b) - transmit`, which may be negative too.
    #[inline]
    pub fn opacity_by_color(self) -> f64 {
        1.0 - (self.filter * self.rgb.max_component() + self.transmit)
    }

    /// The transmittance in each channel: `rgb · filter + transmit`.
    #[inline]
    pub fn attenuation(self) -> Color {
        self.rgb * self.filter + Color::gray(self.transmit)
    }

    /// The grey value `0.297 r + 0.589 g + 0.114 b` POV-Ray reads heights and patterns from.
    #[inline]
    pub fn gray(self) -> f64 {
        self.rgb.gray_value()
    }

    /// `self · (1 - t) + other · t` in all five components.
    #[must_use]
    pub fn lerp(self, other: Self, t: f64) -> Self {
        self * (1.0 - t) + other * t
    }
}

impl From<Color> for ColorFt {
    fn from(rgb: Color) -> Self {
        Self::opaque(rgb)
    }
}

impl Add for ColorFt {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self {
            rgb: self.rgb + o.rgb,
            filter: self.filter + o.filter,
            transmit: self.transmit + o.transmit,
        }
    }
}

impl Mul<f64> for ColorFt {
    type Output = Self;
    fn mul(self, k: f64) -> Self {
        Self {
            rgb: self.rgb * k,
            filter: self.filter * k,
            transmit: self.transmit * k,
        }
    }
}
