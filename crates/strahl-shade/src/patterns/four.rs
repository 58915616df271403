//! Patterns at four places at once, as the heights of normals want them.

use strahl_math::noise::noise_of_four;
use strahl_math::{DVec3, det};
use strahl_simd::{Isa, Simd, dispatch};

use super::{Modifiers, Pattern, TexturePoint, noisy};

impl Pattern {
    /// Whether four places at once take less time, and the value depends on nothing else of a point.
    pub(crate) fn is_fast_at_four(&self) -> bool {
        matches!(
            self,
            Self::Bozo | Self::Fractal(_) | Self::Granite | Self::Leopard | Self::Wrinkles
        )
    }

    /// [`Pattern::raw`] at four places.
    pub(super) fn raw_of_four(
        &self,
        places: &[DVec3; 4],
        point: &TexturePoint,
        modifiers: &Modifiers,
    ) -> [f64; 4] {
        let noise = modifiers.noise;
        match self {
            Self::Bozo => noise_of_four(&axes(places), noise),
            Self::Fractal(fractal) => {
                let mut values = [0.0; 4];
                fractal.store_values(&places.map(DVec3::truncate), &mut values);
                values
            }
            Self::Granite => noisy::granite_of_four(&axes(places), noise),
            Self::Leopard => leopard_of_four(&axes(places)),
            Self::Pigment(pigment) => pigment.colors_of_four(places, point).map(|c| c.gray()),
            Self::Wrinkles => noisy::wrinkles_of_four(&axes(places), noise),
            _ => places.map(|place| self.raw(place, point, modifiers)),
        }
    }
}

/// The coordinates of four places, axis by axis.
fn axes(places: &[DVec3; 4]) -> [[f64; 4]; 3] {
    [
        places.map(|p| p.x),
        places.map(|p| p.y),
        places.map(|p| p.z),
    ]
}

fn leopard_of_four([x, y, z]: &[[f64; 4]; 3]) -> [f64; 4] {
    let sums = dispatch!(Simd::best(), isa => {
        let sin_x = det::sines(isa, isa.load(x));
        let sin_y = det::sines(isa, isa.load(y));
        let sin_z = det::sines(isa, isa.load(z));
        isa.store(isa.div(isa.add(isa.add(sin_x, sin_y), sin_z), isa.splat(3.0)))
    });
    sums.map(|sum| sum * sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Color;
    use crate::patterns::{Fractal, PatternField};
    use crate::pigment::{BlendMap, Pigment};
    use std::sync::Arc;
    use strahl_math::noise::NoiseGenerator;

    fn ramp(pattern: Pattern) -> Pigment {
        let mut field = PatternField::from(pattern);
        field.modifiers.turbulence = DVec3::splat(0.2);
        let colors = vec![
            (0.1, Color::new(0.1, 0.5, 0.3).into()),
            (0.8, Color::new(0.9, 0.2, 0.7).into()),
        ];
        Pigment::ColorMap(Box::new(field), BlendMap::new(colors))
    }

    fn patterns() -> Vec<Pattern> {
        let pigments = || {
            vec![
                (0.2, ramp(Pattern::Leopard)),
                (0.6, ramp(Pattern::Wrinkles)),
                (0.6, ramp(Pattern::Onion)),
                (0.9, Pigment::Solid(Color::gray(0.3).into(), None)),
            ]
        };
        let map = |pattern: Pattern| {
            let map = Pigment::PigmentMap(pattern.into(), BlendMap::new(pigments()));
            Pattern::Pigment(Arc::new(map))
        };
        vec![
            Pattern::Bozo,
            Pattern::Fractal(Fractal::mandelbrot(20)),
            Pattern::Granite,
            Pattern::Leopard,
            Pattern::Wrinkles,
            Pattern::Onion,
            Pattern::Pigment(Arc::new(ramp(Pattern::Granite))),
            map(Pattern::Bozo),
            map(Pattern::Aoi),
        ]
    }

    #[test]
    fn four_places_at_once_have_the_bits_of_single_ones() {
        let generators = [
            NoiseGenerator::Original,
            NoiseGenerator::RangeCorrected,
            NoiseGenerator::Perlin,
        ];
        for pattern in patterns() {
            for noise in generators {
                let modifiers = Modifiers {
                    noise,
                    ..Modifiers::default()
                };
                for n in 0..300 {
                    let t = f64::from(n);
                    let center = DVec3::new(t * 0.031 - 2.0, 1.0 - t * 0.017, t * 0.71 - 9.0);
                    let far = if n == 7 { 1e300 } else { 0.13 };
                    let ways = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];
                    let places = ways.map(|way| center + way * far);
                    let point = TexturePoint::in_space(center);
                    let four = pattern.raw_of_four(&places, &point, &modifiers);
                    let single = places.map(|place| pattern.raw(place, &point, &modifiers));
                    assert_eq!(
                        four.map(f64::to_bits),
                        single.map(f64::to_bits),
                        "{pattern:?} {center}"
                    );
                }
            }
        }
    }
}
