//! The interior of a transparent solid.

use strahl_math::det;

use crate::{Color, SpectralPart};

/// The inside of a solid as POV-Ray's `interior` describes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interior {
    /// Index of refraction.
    pub ior: f64,
    /// The distance at which the light is attenuated to a half (or to 1/e, see [`Interior::attenuation`]); 0 is no attenuation.
    pub fade_distance: f64,
    /// The exponent of the attenuation; with 0 it is the same on ways of any length.
    pub fade_power: f64,
    /// The colour of light after an infinite distance; black by default.
    pub fade_color: Color,
    /// Ratio of the indices of refraction for violet and red; 1 is no dispersion.
    pub dispersion: f64,
    /// How many rays show the spectrum where `dispersion` is not 1, at least 2; 7 by default.
    pub dispersion_samples: u16,
    /// How sharply transmitted light is concentrated, in place of real caustics; 0 is not at all. See [`Interior::gathered`].
    pub caustics: f64,
}

impl Default for Interior {
    /// Air: no refraction, no attenuation.
    fn default() -> Self {
        Self {
            ior: 1.0,
            fade_distance: 0.0,
            fade_power: 0.0,
            fade_color: Color::BLACK,
            dispersion: 1.0,
            dispersion_samples: 7,
            caustics: 0.0,
        }
    }
}

impl Interior {
    /// The exponent of the light behind an object with `caustics 1` (measured). In a `finish` POV-Ray takes the number for the exponent.
    pub const CAUSTICS_EXPONENT: f64 = 45.0;

    /// Whether colours are refracted by different angles.
    #[inline]
    pub fn disperses(&self) -> bool {
        self.dispersion != 1.0
    }

    /// The index of refraction for a part of the spectrum: `ior · dispersion^(place - 1/2)` (as measured).
    pub fn ior_of(&self, part: SpectralPart) -> f64 {
        if part.is_white() || !self.disperses() {
            return self.ior;
        }
        self.ior * det::pow(self.dispersion, part.place() - 0.5)
    }

    /// The factor of light that passes a surface on its way to the lit point: `1 + |cos|^(45 caustics)`, with the cosine
    /// between the perturbed normal and the light's direction (as measured).
    pub fn gathered(caustics: f64, cos: f64) -> f64 {
        if caustics > 0.0 {
            1.0 + det::pow(cos.abs(), Self::CAUSTICS_EXPONENT * caustics)
        } else {
            1.0
        }
    }

    /// Whether light of light sources is attenuated on its way through the object: not with a power of 0 (measured).
    pub fn fades_shadows(&self) -> bool {
        self.fade_power > 0.0
    }

    /// The attenuation of light on a path of this length inside.
    ///
    /// With `s = length / fade_distance`: `c + (1 - c) / (1 + s^fade_power)` below a power of 1000, and
    /// `exp(-(1 - c) s)`, the law of Beer and Lambert, from there on. So a power of 0 leaves `(1 + c) / 2` on ways of any length, as in
    /// POV-Ray (measured); without a distance there is no attenuation.
    pub fn attenuation(&self, length: f64) -> Color {
        if !(self.fade_power >= 0.0) || !(self.fade_distance > 0.0) {
            return Color::WHITE;
        }
        let s = length / self.fade_distance;
        if self.fade_power >= 1000.0 {
            self.fade_color.map(|c| det::exp(-(1.0 - c) * s))
        } else {
            let left = 1.0 / (1.0 + det::pow(s, self.fade_power));
            self.fade_color.map(|c| c + (1.0 - c) * left)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equals_the_measured_values() {
        let color = Color::new(0.2, 0.5, 0.8);
        for (fade_power, fade_color, expected) in [
            (2.0, Color::BLACK, [0.2, 0.2, 0.2]),
            (2.0, color, [0.36, 0.6, 0.84]),
            (0.0, Color::BLACK, [0.5, 0.5, 0.5]),
            (0.0, color, [0.6, 0.75, 0.9]),
            (1001.0, Color::BLACK, [0.13533, 0.13533, 0.13533]),
            (1001.0, color, [0.20189, 0.36788, 0.67031]),
        ] {
            let interior = Interior {
                fade_distance: 1.0,
                fade_power,
                fade_color,
                ..Interior::default()
            };
            let got = interior.attenuation(2.0).to_array();
            for (g, e) in got.iter().zip(expected) {
                assert!((g - e).abs() < 2e-5, "{fade_power}: {got:?}");
            }
        }
    }
}
