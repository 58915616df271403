use crate::Color;
use strahl_math::{DVec3, Interval, det};

/// How a light weakens with the distance `d` to it.
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
    /// The factor at distance `d > 0`.
    pub fn at(self, d: f64) -> f64 {
        match self {
            Self::None => 1.0,
            Self::InverseSquare => 1.0 / (d * d),
            Self::Fade { distance, power } => 2.0 / (1.0 + det::pow(d / distance, power)),
            Self::Polynomial([c0, c1, c2]) => 1.0 / (c0 + d * (c1 + d * c2)),
        }
    }
}

/// Where a light is and where it shines.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LightKind {
    /// Shines from a point into all directions.
    Point {
        /// World position.
        position: DVec3,
    },
    /// Parallel light from infinitely far away.
    Directional {
        /// Unit direction in which the light travels.
        direction: DVec3,
    },
    /// Shines from a point into a cone.
    Spot {
        /// World position.
        position: DVec3,
        /// Unit direction of the cone's axis, away from the light.
        direction: DVec3,
        /// Cosine of the half angle within which the light has its full strength.
        cos_inner: f64,
        /// Cosine of the half angle outside of which there is no light; at most `cos_inner`.
        cos_outer: f64,
    },
}

/// A light source without extent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it is.
    pub kind: LightKind,
    /// Its colour times its strength.
    pub color: Color,
    /// How it weakens with distance (directional lights don't).
    pub falloff: Falloff,
    /// Whether objects cast shadows in this light.
    pub casts_shadows: bool,
}

/// A light as seen from one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit vector towards the light.
    pub l: DVec3,
    /// Direction of the shadow ray: from the point to the light (which is at `t = 1`), or `l` for directional lights.
    pub shadow_direction: DVec3,
    /// The range in which an object casts a shadow.
    pub range: Interval,
    /// The light that arrives if nothing is in between.
    pub color: Color,
}

impl Light {
    /// A light that casts shadows and does not weaken.
    pub const fn new(kind: LightKind, color: Color) -> Self {
        Self {
            kind,
            color,
            falloff: Falloff::None,
            casts_shadows: true,
        }
    }

    /// A point light.
    pub const fn point(position: DVec3, color: Color) -> Self {
        Self::new(LightKind::Point { position }, color)
    }

    /// Parallel light travelling along `direction` (any length but zero).
    pub fn directional(direction: DVec3, color: Color) -> Self {
        Self::new(
            LightKind::Directional {
                direction: direction.normalize_or(DVec3::NEG_Z),
            },
            color,
        )
    }

    /// A spot light at `position` shining towards `target`, with half angles in radians: full strength within `inner`,
    /// none outside of `outer`.
    pub fn spot(position: DVec3, target: DVec3, inner: f64, outer: f64, color: Color) -> Self {
        let direction = (target - position).normalize_or(DVec3::NEG_Z);
        let (cos_inner, cos_outer) = (det::cos(inner), det::cos(outer));
        Self::new(
            LightKind::Spot {
                position,
                direction,
                cos_inner,
                cos_outer,
            },
            color,
        )
    }

    /// The same light, weakening with distance.
    #[must_use]
    pub const fn with_falloff(self, falloff: Falloff) -> Self {
        Self { falloff, ..self }
    }

    /// What of the light arrives at `point` if nothing is in between; `None` if none does, or the point is at the light.
    #[inline]
    pub fn illuminate(&self, point: DVec3) -> Option<LightSample> {
        let (position, cone) = match self.kind {
            LightKind::Directional { direction } => {
                let l = -direction;
                let (range, color) = (Interval::FORWARD, self.color);
                return Some(LightSample {
                    l,
                    shadow_direction: l,
                    range,
                    color,
                });
            }
            LightKind::Point { position } => (position, None),
            LightKind::Spot {
                position,
                direction,
                cos_inner,
                cos_outer,
            } => (position, Some((direction, cos_inner, cos_outer))),
        };
        let to_light = position - point;
        let distance = to_light.length();
        if !(distance > 0.0) {
            return None;
        }
        let l = to_light / distance;
        let mut strength = self.falloff.at(distance);
        if let Some((direction, cos_inner, cos_outer)) = cone {
            strength *= smooth_step(cos_outer, cos_inner, -l.dot(direction));
            if strength == 0.0 {
                return None;
            }
        }
        let color = self.color * strength;
        Some(LightSample {
            l,
            shadow_direction: to_light,
            range: Interval::UNTIL_LIGHT,
            color,
        })
    }
}

/// 0 up to `low`, 1 from `high`, `3x² - 2x³` in between.
fn smooth_step(low: f64, high: f64, x: f64) -> f64 {
    if x >= high {
        1.0
    } else if x <= low {
        0.0
    } else {
        let s = (x - low) / (high - low);
        s * s * (3.0 - 2.0 * s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_light_is_at_t_equal_one() {
        let light = Light::point(DVec3::new(1.0, 2.0, 3.0), Color::WHITE);
        let p = DVec3::new(-1.0, 0.5, 0.25);
        let s = light.illuminate(p).expect("lit");
        assert_eq!(p + s.shadow_direction, DVec3::new(1.0, 2.0, 3.0));
        assert!(!s.range.accepts(1.0));
        assert!(light.illuminate(DVec3::new(1.0, 2.0, 3.0)).is_none());
    }

    #[test]
    fn a_spot_is_full_inside_and_dark_outside() {
        let light = Light::spot(DVec3::ZERO, DVec3::NEG_Z, 0.2, 0.4, Color::WHITE);
        let at = |a: f64| light.illuminate(DVec3::new(a.sin(), 0.0, -a.cos()));
        assert_eq!(at(0.1).expect("lit").color, Color::WHITE);
        let edge = at(0.3).expect("lit").color.r;
        assert!(edge > 0.1 && edge < 0.9);
        assert!(at(0.41).is_none() && at(3.0).is_none());
    }

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
