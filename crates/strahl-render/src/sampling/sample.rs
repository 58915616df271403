use std::ops::{Add, Div};
use strahl_shade::Color;

/// The light through a place of the picture, or a mean of such.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    /// A colour of the scene's working space.
    pub(crate) color: Color,
    /// How much of what lies behind the picture shows, `0..=1`; kept for the alpha channel only.
    pub(crate) clear: f64,
}

impl Sample {
    /// Opaque black.
    pub(crate) const BLACK: Self = Self {
        color: Color::BLACK,
        clear: 0.0,
    };
}

impl From<Color> for Sample {
    fn from(color: Color) -> Self {
        Self { color, clear: 0.0 }
    }
}

impl Add for Sample {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            color: self.color + other.color,
            clear: self.clear + other.clear,
        }
    }
}

impl Div<f64> for Sample {
    type Output = Self;

    fn div(self, divisor: f64) -> Self {
        Self {
            color: self.color / divisor,
            clear: self.clear / divisor,
        }
    }
}
