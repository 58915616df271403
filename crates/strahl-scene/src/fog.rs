use crate::Span;
use strahl_math::noise::{NoiseGenerator, Turbulence};
use strahl_math::{DVec3, det};
use strahl_shade::{Color, ColorFt};

/// The density of a fog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FogKind {
    /// The same density everywhere.
    Constant,
    /// Density 1 up to a height `offset`, above it `1 / (1 + (h / altitude)²)` at a height `h` above the offset.
    Ground {
        /// Unit vector that points up.
        up: DVec3,
        /// Height, along `up`, below which the density is 1.
        offset: f64,
        /// Height above the offset where the density is one half; with 0 (or less) there is no fog above the offset.
        altitude: f64,
    },
}

/// Noise that makes fog thinner in places (POV-Ray's model, which was measured).
///
/// A ray of length `l` with the point `m` in its middle has the optical depth `τ (1 - exp(-l / distance) · min(1, strength ·
/// n))` with the scalar turbulence `n` at `scale · m`: the effect vanishes for long rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FogTurbulence {
    /// Scales the points, coordinate by coordinate.
    pub scale: DVec3,
    /// The weight of the noise.
    pub strength: f64,
    /// The octaves of the noise.
    pub octaves: Turbulence,
    /// The noise.
    pub noise: NoiseGenerator,
}

impl FogTurbulence {
    /// The factor of the optical depth of a ray whose length is `length` times the fog's distance.
    fn thinning(&self, middle: DVec3, length: f64) -> f64 {
        let thin = det::exp(-length);
        // Infinite rays have no middle.
        if thin == 0.0 {
            return 1.0;
        }
        let n = self.strength * self.octaves.scalar(middle * self.scale, self.noise);
        1.0 - thin * if n < 1.0 { n } else { 1.0 }
    }
}

/// Fog that fills the space between objects: it attenuates the light from behind and adds its own colour (POV-Ray's model,
/// whose formulas were measured).
///
/// With the optical depth `τ` of a ray (its length, weighted by density, over `distance`), the share of light that passes is
/// `T = max(exp(-τ), transmit)`, tinted by `1 - filter + filter·colour`; the fog adds `(1 - T)·colour`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// Density.
    pub kind: FogKind,
    /// Length on which fog of density 1 lets `1/e` pass; positive.
    pub distance: f64,
    /// Its colour, its tint (`filter`) and the least transmittance (`transmit`).
    pub color: ColorFt,
    /// Makes it uneven.
    pub turbulence: Option<FogTurbulence>,
    /// The place in the scene that made it.
    pub span: Span,
}

impl Fog {
    /// The optical depth of a ray from `origin` in the unit direction `direction` of this length, which may be infinite.
    pub fn depth(&self, origin: DVec3, direction: DVec3, length: f64) -> f64 {
        let way = match self.kind {
            FogKind::Constant => length,
            FogKind::Ground {
                up,
                offset,
                altitude,
            } => ground(altitude, origin.dot(up) - offset, direction.dot(up), length),
        };
        let depth = way / self.distance;
        match &self.turbulence {
            None => depth,
            Some(turbulence) => {
                let middle = origin + direction * (0.5 * length);
                depth * turbulence.thinning(middle, length / self.distance)
            }
        }
    }

    /// The attenuation of the light from behind by fog of this optical depth, per channel, and the light the fog adds.
    pub fn at_depth(&self, depth: f64) -> (Color, Color) {
        let thin = det::exp(-depth);
        let passes = if thin > self.color.transmit {
            thin
        } else {
            self.color.transmit
        };
        let filter = self.color.filter;
        let tint = Color::gray(1.0 - filter) + self.color.rgb * filter;
        (tint * passes, self.color.rgb * (1.0 - passes))
    }
}

/// The length of a ray weighted by the density of ground fog: it begins at height `h`, rises by `slope` per unit length.
fn ground(altitude: f64, h: f64, slope: f64, length: f64) -> f64 {
    let density = |h: f64| {
        if h <= 0.0 {
            1.0
        } else if altitude > 0.0 {
            1.0 / (1.0 + (h / altitude) * (h / altitude))
        } else {
            0.0
        }
    };
    // The integral of the density from 0 to h.
    let integral = |h: f64| {
        if h <= 0.0 {
            h
        } else if altitude > 0.0 {
            altitude * det::atan(h / altitude)
        } else {
            0.0
        }
    };
    let rise = slope * length;
    // Over a small rise the difference of integrals would cancel, and the density hardly changes.
    let scale = h.abs() + altitude.abs();
    if rise.is_nan() || rise.abs() <= 1e-7 * scale {
        let middle = density(h + if rise.is_finite() { 0.5 * rise } else { 0.0 });
        return if middle == 0.0 { 0.0 } else { middle * length };
    }
    (integral(h + rise) - integral(h)) / slope
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fog(altitude: f64) -> Fog {
        Fog {
            kind: FogKind::Ground {
                up: DVec3::Y,
                offset: 1.0,
                altitude,
            },
            distance: 8.0,
            color: ColorFt::opaque(Color::new(0.0, 0.0, 1.0)),
            turbulence: None,
            span: Span::NONE,
        }
    }

    fn passes(fog: &Fog, from: DVec3, to: DVec3) -> f64 {
        let way = to - from;
        let depth = fog.depth(from, way.normalize(), way.length());
        1.0 - fog.at_depth(depth).1.b
    }

    /// Measured with POV-Ray 3.7, 16 bits per channel.
    #[test]
    fn ground_fog_is_as_measured() {
        let f = fog(0.5);
        for (y0, y1, added) in [
            (2.0, 2.0, 0.11748),
            (3.0, 3.0, 0.03609),
            (0.5, 0.5, 0.46474),
            (0.0, 3.0, 0.33236),
            (3.0, 0.0, 0.33236),
            (-3.0, -1.0, 0.48991),
            (4.0, 1.5, 0.08302),
        ] {
            let (a, b) = (DVec3::new(0.0, y0, 0.0), DVec3::new(0.0, y1, 5.0));
            let got = 1.0 - passes(&f, a, b);
            assert!((got - added).abs() < 4e-5, "{y0} to {y1}: {got}");
        }
        let level = |y: f64| passes(&fog(0.0), DVec3::Y * y, DVec3::new(0.0, y, 5.0));
        assert_eq!(level(1.5), 1.0);
        assert!((level(0.5) - 0.53526).abs() < 2e-5);
    }

    /// Rays along z at x = 0, 1, 2, as measured with POV-Ray 3.7 with `octaves 1 turb_depth 0.5` and `turbulence 0.5`: the
    /// factor of the depth.
    #[test]
    fn turbulence_thins_fog_as_measured() {
        let measured = [
            (FogKind::Constant, 0.0, 0.0, [0.8043, 0.8229, 0.7883]),
            (fog(1.0).kind, 2.0, 0.0, [0.9179, 0.8596, 0.8176]),
            (fog(1.0).kind, 0.0, 0.3, [0.7506, 0.8334, 0.8855]),
            (fog(0.5).kind, 3.0, -0.6, [0.8411, 0.8553, 0.8743]),
        ];
        for (kind, height, slope, factors) in measured {
            let even = Fog {
                kind,
                distance: 10.0,
                ..fog(1.0)
            };
            let uneven = Fog {
                turbulence: Some(FogTurbulence {
                    scale: DVec3::splat(0.5),
                    strength: 0.5,
                    octaves: Turbulence {
                        octaves: 1,
                        ..Turbulence::default()
                    },
                    noise: NoiseGenerator::RangeCorrected,
                }),
                ..even
            };
            for (x, factor) in [0.0, 1.0, 2.0].into_iter().zip(factors) {
                let from = DVec3::new(x, height, -5.0);
                let way = DVec3::new(0.0, slope * 5.0, 5.0);
                let depth = |f: &Fog| f.depth(from, way.normalize(), way.length());
                let got = depth(&uneven) / depth(&even);
                assert!((got - factor).abs() < 3e-4, "{kind:?} at {x}: {got}");
            }
            assert_eq!(
                uneven.depth(DVec3::ZERO, DVec3::X, f64::INFINITY),
                f64::INFINITY
            );
        }
    }

    #[test]
    fn endless_rays_have_a_depth() {
        let f = fog(0.5);
        let up = f.depth(DVec3::Y * 2.0, DVec3::Y, f64::INFINITY) * 8.0;
        assert!((up - 0.231_823_8).abs() < 1e-6, "{up}");
        for direction in [DVec3::X, DVec3::NEG_Y] {
            let depth = f.depth(DVec3::Y * 2.0, direction, f64::INFINITY);
            assert_eq!(depth, f64::INFINITY);
            assert_eq!(f.at_depth(depth).0, Color::BLACK);
        }
        assert_eq!(fog(0.0).depth(DVec3::Y * 2.0, DVec3::X, f64::INFINITY), 0.0);
        assert_eq!(fog(0.0).depth(DVec3::Y * 2.0, DVec3::Y, f64::INFINITY), 0.0);
    }

    #[test]
    fn filter_tints_and_transmit_keeps() {
        let rgb = Color::new(0.2, 0.4, 1.0);
        let mut f = fog(0.0);
        f.kind = FogKind::Constant;
        f.color = ColorFt {
            rgb,
            filter: 0.5,
            transmit: 0.2,
        };
        let (keeps, adds) = f.at_depth(f.depth(DVec3::ZERO, DVec3::X, f64::INFINITY));
        let seen = keeps * Color::new(0.3, 0.6, 0.1) + adds;
        let measured = [0.196, 0.404, 0.82];
        for (a, b) in seen.to_array().iter().zip(measured) {
            assert!((a - b).abs() < 1e-12, "{seen:?}");
        }
    }
}
