//! Iridescence (`irid`): the colours of light that a thin transparent film reflects at both of its sides.
//!
//! The two parts of the light interfere: their paths differ by `t (n·l + n·v)` for a film of thickness `t`. All formulas were
//! found by rendering single pixels with POV-Ray 3.7; they agree with its 16-bit pictures to 1e-5.

use strahl_math::noise::{NoiseGenerator, Turbulence};
use strahl_math::{DVec3, det};

use crate::Color;

/// `irid { amount thickness T turbulence V }` of a finish.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iridescence {
    /// How much of the light interferes; negative light results above 1.
    pub amount: f64,
    /// The thickness of the film, in the unit of the wavelengths; default 0.
    pub thickness: f64,
    /// How much turbulence changes the thickness; default 0.
    pub turbulence: f64,
}

/// What a scene says about all its films.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IridSettings {
    /// The wavelengths of red, green and blue (`irid_wavelength`).
    pub wavelength: Color,
    /// The noise of the turbulence.
    pub noise: NoiseGenerator,
}

impl Default for IridSettings {
    /// POV-Ray's wavelengths.
    fn default() -> Self {
        Self {
            wavelength: Color::new(0.7, 0.52, 0.48),
            noise: NoiseGenerator::default(),
        }
    }
}

/// The film at one point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmPoint {
    /// How much of the light interferes.
    pub amount: f64,
    /// `2π t / λ` for red, green and blue.
    pub phase: Color,
}

/// The octaves of the thickness' turbulence; those of the texture's patterns don't count (measured).
const OCTAVES: Turbulence = Turbulence {
    octaves: 5,
    omega: 0.5,
    lambda: 2.0,
};

impl Iridescence {
    /// The film at a point of world space, with the thickness `t = T (1 + V (2 s - 1))` for the turbulence `s` there.
    pub fn at(&self, world: DVec3, settings: &IridSettings) -> FilmPoint {
        let mut t = self.thickness;
        if self.turbulence != 0.0 {
            let stirred = 2.0 * OCTAVES.scalar(world, settings.noise) - 1.0;
            t *= 1.0 + self.turbulence * stirred;
        }
        FilmPoint {
            amount: self.amount,
            phase: settings
                .wavelength
                .map(|wavelength| std::f64::consts::TAU * t / wavelength),
        }
    }
}

impl FilmPoint {
    /// The factor of light that arrives at the cosine `n_dot_l` and leaves at `n_dot_v`:
    /// `1 + amount · cos(2π t (|n·l| + |n·v|) / λ)`. The diffuse part, the highlights and the reflection get it.
    pub fn factor(&self, n_dot_l: f64, n_dot_v: f64) -> Color {
        let path = n_dot_l.abs() + n_dot_v.abs();
        self.phase
            .map(|phase| 1.0 + self.amount * det::cos(phase * path))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Color, b: [f64; 3], tolerance: f64) {
        let b = Color::new(b[0], b[1], b[2]);
        let d = (a - b).map(f64::abs).max_component();
        assert!(d <= tolerance, "{a:?} is not {b:?}");
    }

    /// One white pixel each with `diffuse 0.5` under POV-Ray 3.7, divided by `0.5 n·l`.
    #[test]
    fn factors_are_those_measured() {
        let film = |thickness: f64, amount| Iridescence {
            amount,
            thickness,
            turbulence: 0.0,
        };
        let cos60 = 0.5;
        let cases = [
            (1.0, 1.0, 1.0, 1.0, [1.6235, 1.56808, 1.5]),
            (1.0, 0.5, 1.0, 1.0, [1.31176, 1.28404, 1.24998]),
            (0.5, 1.0, 1.0, 1.0, [0.09904, 1.88546, 1.86602]),
            (1.0, 1.0, cos60, 1.0, [1.62348, 1.74852, 1.70712]),
            (1.0, 1.0, cos60, cos60, [0.09908, 1.88548, 1.866]),
            (0.0, 0.5, 1.0, 1.0, [1.5, 1.5, 1.5]),
        ];
        for (thickness, amount, n_dot_l, n_dot_v, expected) in cases {
            let point = film(thickness, amount).at(DVec3::ZERO, &IridSettings::default());
            near(point.factor(n_dot_l, n_dot_v), expected, 1e-4);
        }
    }

    /// `thickness 1 turbulence 1` along `<x, 0.37, 0.22>`, the thickness found from POV-Ray's colours.
    #[test]
    fn turbulence_changes_the_thickness_as_measured() {
        let film = Iridescence {
            amount: 1.0,
            thickness: 1.0,
            turbulence: 1.0,
        };
        let settings = IridSettings {
            wavelength: Color::gray(8.0),
            ..IridSettings::default()
        };
        let measured = [
            1.76234, 1.69278, 1.64127, 1.22552, 0.80109, 0.50054, 1.35834, 1.49342, 1.79625,
            1.59301, 1.94349, 1.97563,
        ];
        for (i, expected) in measured.into_iter().enumerate() {
            let x = -1.65 + 0.3 * i as f64;
            let point = film.at(DVec3::new(x, 0.37, 0.22), &settings);
            let thickness = point.phase.r * 8.0 / std::f64::consts::TAU;
            assert!(
                (thickness - expected).abs() < 3e-4,
                "{x}: {thickness}, not {expected}"
            );
        }
    }
}
