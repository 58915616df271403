use strahl_math::det;

/// The attenuation of a light with the distance `d`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Falloff {
    /// Not at all: the classical model.
    #[default]
    None,
    /// `1 / d²`, the physical law: the light's colour is the radiance at distance 1.
    InverseSquare,
    /// `2 / (1 + (d / distance)^power)`: 1 at `distance`, at most 2.
    Fade {
        /// Where the light has its nominal strength; positive.
        distance: f64,
        /// Exponent; 1 and 2 are usual.
        power: f64,
    },
    /// `1 / (c₀ + c₁ d + c₂ d²)`, the model of the rasterisers.
    Polynomial([f64; 3]),
}

impl Falloff {
    /// The factor at distance `d`, which is negative behind the plane that parallel light comes from. There `Fade` takes the power of the negative
    /// number, as POV-Ray does (measured): the light may be stronger, take light away, or be 0 where the power is not a whole number.
    pub fn at(self, d: f64) -> f64 {
        match self {
            Self::None => 1.0,
            Self::InverseSquare => 1.0 / (d * d),
            Self::Fade { distance, power } => {
                let factor = 2.0 / (1.0 + det::pow(d / distance, power));
                if factor.is_nan() { 0.0 } else { factor }
            }
            Self::Polynomial([c0, c1, c2]) => {
                let d = d.abs();
                1.0 / (c0 + d * (c1 + d * c2))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn falloff_laws() {
        assert_eq!(Falloff::InverseSquare.at(2.0), 0.25);
        assert_eq!(
            Falloff::Fade {
                distance: 3.0,
                power: 2.0
            }
            .at(3.0),
            1.0
        );
        assert_eq!(Falloff::Polynomial([1.0, 0.5, 0.25]).at(2.0), 1.0 / 3.0);
    }
}
