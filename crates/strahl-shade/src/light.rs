mod area;
mod emission;
mod falloff;

pub use area::{AreaGrid, AreaLight};
pub use emission::Emission;
pub use falloff::Falloff;

use crate::Color;
use strahl_math::{DVec3, Interval, Transform, det};

/// The kind of a light: its position and distribution.
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
        /// Cosine of the half angle outside of which there is no light; with `cos_inner` below it the cone ends sharply
        /// at `cos_inner`.
        cos_outer: f64,
        /// The strength is also multiplied by this power of the cosine of the angle; 0 for an even cone.
        tightness: f64,
    },
    /// Parallel light from a plane through a point: what lies behind the plane is lit too, but without shadows.
    Parallel {
        /// A point of the plane.
        position: DVec3,
        /// Unit direction in which the light travels, the normal of the plane.
        direction: DVec3,
    },
    /// Parallel light within a cylinder that begins at a point.
    Beam {
        /// Centre of the beam's beginning.
        position: DVec3,
        /// Unit direction in which the light travels, the axis.
        direction: DVec3,
        /// Distance from the axis up to which the light has its full strength; infinite for light that fills the half-space before its
        /// plane.
        inner: f64,
        /// Distance from the axis beyond which there is no light; with `inner` above it the beam ends sharply at `inner`.
        outer: f64,
        /// The strength at distance `d` is also multiplied by `(1 - d / outer)^tightness`; 0 for an even beam.
        tightness: f64,
    },
}

/// A light source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Its position and distribution.
    pub kind: LightKind,
    /// Its colour times its strength.
    pub color: Color,
    /// The attenuation with distance (directional lights have none).
    pub falloff: Falloff,
    /// Whether objects cast shadows in this light.
    pub casts_shadows: bool,
    /// Whether the light makes highlights.
    pub highlights: bool,
    /// Whether fog attenuates the light on its way to the lit point.
    pub fogged: bool,
    /// Objects closer to the light than this cast no shadow in its light; 0 by default. (Directional lights have no position and
    /// so no clearance.)
    pub clearance: f64,
    /// The extent of an area light, whose centre is the position of `kind`; `None` if it shines from a point.
    pub area: Option<AreaLight>,
}

/// A light as seen from one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// Unit vector towards the light.
    pub l: DVec3,
    /// Direction of the shadow ray: from the point to the light (which is at `t = 1`), or `l` for directional lights.
    pub shadow_direction: DVec3,
    /// The range in which an object casts a shadow; empty if none does.
    pub range: Interval,
    /// The light that arrives without occlusion.
    pub color: Color,
}

impl LightSample {
    /// No light.
    pub const NONE: Self = Self {
        l: DVec3::ZERO,
        shadow_direction: DVec3::ZERO,
        range: Interval::UNTIL_LIGHT,
        color: Color::BLACK,
    };
}

impl Light {
    /// A light that casts shadows and is not attenuated.
    pub const fn new(kind: LightKind, color: Color) -> Self {
        Self {
            kind,
            color,
            falloff: Falloff::None,
            casts_shadows: true,
            highlights: true,
            fogged: false,
            clearance: 0.0,
            area: None,
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
                tightness: 0.0,
            },
            color,
        )
    }

    /// The same light with attenuation by distance.
    #[must_use]
    pub const fn with_falloff(self, falloff: Falloff) -> Self {
        Self { falloff, ..self }
    }

    /// The same light at another position. Its direction and its extent stay. `None` for a directional light, which has no position.
    #[must_use]
    pub fn moved_to(mut self, to: DVec3) -> Option<Self> {
        match &mut self.kind {
            LightKind::Directional { .. } => return None,
            LightKind::Point { position }
            | LightKind::Spot { position, .. }
            | LightKind::Parallel { position, .. }
            | LightKind::Beam { position, .. } => *position = to,
        }
        Some(self)
    }

    /// The light that arrives at `point` without occlusion; `None` if none does, or the point is at the light.
    // The usual light is inline: a sample that is returned in memory would be loaded before its stores have ended.
    #[inline(always)]
    pub fn illuminate(&self, point: DVec3) -> Option<LightSample> {
        let Some(position) = self.plain_position() else {
            return self.illuminate_by_kind(point);
        };
        let to_light = position - point;
        let distance = to_light.length();
        let end = (distance - self.clearance) / distance;
        self.plain_sample(to_light, distance, to_light / distance, end)
    }

    /// The position of a light that shines from a point, into all directions and at all distances alike.
    #[inline]
    pub fn plain_position(&self) -> Option<DVec3> {
        match (self.kind, self.falloff) {
            (LightKind::Point { position }, Falloff::None) => Some(position),
            _ => None,
        }
    }

    /// [`Light::illuminate`] of a light with a [`Light::plain_position`], which is at this vector from the point, with its length and
    /// its direction. `end` is where the range ends if the light has a [clearance](Light::clearance): the distance less the clearance, divided by the distance.
    #[inline(always)]
    pub fn plain_sample(
        &self,
        to_light: DVec3,
        distance: f64,
        l: DVec3,
        end: f64,
    ) -> Option<LightSample> {
        if !(distance > 0.0) {
            return None;
        }
        Some(LightSample {
            l,
            shadow_direction: to_light,
            range: self.range_to(end),
            color: self.color,
        })
    }

    /// [`Light::illuminate`] for all lights.
    fn illuminate_by_kind(&self, point: DVec3) -> Option<LightSample> {
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
                tightness,
            } => (position, Some((direction, cos_inner, cos_outer, tightness))),
            LightKind::Parallel { .. } | LightKind::Beam { .. } => return self.parallel(point),
        };
        let to_light = position - point;
        let square = to_light.length_squared();
        if let Some((direction, cos_inner, cos_outer, _)) = cone
            && is_beside_cone(-to_light.dot(direction), square, cos_inner.min(cos_outer))
        {
            return None;
        }
        let distance = square.sqrt();
        if !(distance > 0.0) {
            return None;
        }
        let l = to_light / distance;
        let mut strength = self.falloff.at(distance);
        if let Some((direction, cos_inner, cos_outer, tightness)) = cone {
            let cosine = -l.dot(direction);
            strength *= smooth_step(cos_outer, cos_inner, cosine);
            // There is no light behind the plane through the light, however wide the cone is (measured with POV-Ray).
            if strength == 0.0 || cosine <= 0.0 {
                return None;
            }
            strength *= power(cosine, tightness);
        }
        let color = self.color * strength;
        Some(LightSample {
            l,
            shadow_direction: to_light,
            range: self.until_here(distance),
            color,
        })
    }

    /// For a point that [`Light::illuminate`] finds unlit: the sample of a spotlight without light, if other points of its area may light it
    /// (`area_illumination`).
    #[cold]
    pub fn aim(&self, point: DVec3) -> Option<LightSample> {
        let LightKind::Spot { position, .. } = self.kind else {
            return None;
        };
        self.area.as_ref().filter(|area| area.illumination)?;
        let open = Self {
            kind: LightKind::Point { position },
            color: Color::BLACK,
            ..*self
        };
        open.illuminate(point)
    }

    /// The range of t in which objects cast a shadow on a point at this distance, where t = 1 is the light.
    #[inline]
    fn until_here(&self, distance: f64) -> Interval {
        self.range_to((distance - self.clearance) / distance)
    }

    /// The same, given where it ends if the light has a clearance.
    #[inline]
    fn range_to(&self, end: f64) -> Interval {
        if self.clearance > 0.0 {
            Interval::new(0.0, end)
        } else {
            Interval::UNTIL_LIGHT
        }
    }

    /// Whether the light's rays are parallel.
    pub fn is_parallel(&self) -> bool {
        !matches!(self.kind, LightKind::Point { .. } | LightKind::Spot { .. })
    }

    /// Parallel light with a beginning. Its distance is that to the plane it comes from.
    fn parallel(&self, point: DVec3) -> Option<LightSample> {
        let (position, direction, beam) = match self.kind {
            LightKind::Parallel {
                position,
                direction,
            } => (position, direction, None),
            LightKind::Beam {
                position,
                direction,
                inner,
                outer,
                tightness,
            } => (position, direction, Some((inner, outer, tightness))),
            _ => return None,
        };
        let from_light = point - position;
        let distance = from_light.dot(direction);
        let mut strength = self.falloff.at(distance);
        if let Some((inner, outer, tightness)) = beam {
            let radius = (from_light - direction * distance).length();
            // Near the axis the distance is small, while the cosine in a cone is large; hence the reversed sign.
            strength *=
                smooth_step(-outer, -inner, -radius) * power(1.0 - radius / outer, tightness);
            if distance <= 0.0 || !(strength > 0.0) {
                return None;
            }
        }
        let (shadow_direction, range) = if distance > 0.0 {
            (direction * -distance, self.until_here(distance))
        } else {
            (-direction, Interval::new(0.0, 0.0))
        };
        Some(LightSample {
            l: -direction,
            shadow_direction,
            range,
            color: self.color * strength,
        })
    }

    /// The light after a transformation; radii of beams and fading distances stay.
    #[must_use]
    pub fn transformed(&self, t: &Transform) -> Self {
        let turned = |v: DVec3| t.vector_to_world(v).normalize_or(v);
        let mut light = *self;
        match &mut light.kind {
            LightKind::Point { position } => *position = t.point_to_world(*position),
            LightKind::Directional { direction } => *direction = turned(*direction),
            LightKind::Spot {
                position,
                direction,
                ..
            }
            | LightKind::Parallel {
                position,
                direction,
            }
            | LightKind::Beam {
                position,
                direction,
                ..
            } => {
                *position = t.point_to_world(*position);
                *direction = turned(*direction);
            }
        }
        if let Some(area) = &mut light.area {
            area.axis_1 = t.vector_to_world(area.axis_1);
            area.axis_2 = t.vector_to_world(area.axis_2);
            if let LightKind::Parallel { direction, .. } | LightKind::Beam { direction, .. } =
                self.kind
            {
                area.reach = t.vector_to_world(direction * area.reach).length();
            }
        }
        light
    }
}

/// `base^exponent`; 1 for exponent 0, and 0 for bases that are not positive.
fn power(base: f64, exponent: f64) -> f64 {
    if exponent == 0.0 {
        1.0
    } else if base > 0.0 {
        det::pow(base, exponent)
    } else {
        0.0
    }
}

/// Whether a place is certainly outside of a cone, told without a root: `along` is how far it lies along the axis, `square` its squared distance from
/// the light, and `cos` belongs to the cone's edge.
fn is_beside_cone(along: f64, square: f64, cos: f64) -> bool {
    /// Far above the rounding of all of it.
    const NARROWER: f64 = 1.0 - 1e-9;
    cos > 1e-6 && (along <= 0.0 || along * along < cos * cos * NARROWER * square)
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
    fn places_beside_a_cone_are_those_without_light() {
        for cos in [1e-3, 0.3, 0.99, 1.0 - 1e-8] {
            let edge = f64::acos(cos);
            for off in [-0.1, -1e-3, -1e-6, 1e-6, 1e-3, 0.1, 1.0, 2.0] {
                let (sin, along) = f64::sin_cos(edge + off);
                let square = along * along + sin * sin;
                let cosine = along / square.sqrt();
                let dark = smooth_step(cos, cos.max(0.995), cosine) == 0.0;
                let told = is_beside_cone(along, square, cos);
                assert!(!told || dark, "{cos} {off}");
                assert!(told || off < 1e-4 || edge + off > 3.0, "{cos} {off}");
            }
        }
        // A wide cone reaches behind the plane of the light: the cosine itself decides.
        assert!(!is_beside_cone(-1.0, 1.0, -0.5));
    }

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
    fn what_touches_the_light_casts_no_shadow() {
        let light = Light {
            clearance: 1e-3,
            ..Light::point(DVec3::X * 10.0, Color::WHITE)
        };
        let range = light.illuminate(DVec3::ZERO).expect("lit").range;
        assert!(range.accepts(0.999_89) && !range.accepts(0.999_91));
        let near = light.illuminate(DVec3::X * 9.9995).expect("lit").range;
        assert!(near.is_empty());
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
    fn a_tight_spot_weakens_by_the_power_of_the_cosine() {
        let even = Light::spot(DVec3::ZERO, DVec3::NEG_Z, 1.0, 1.2, Color::WHITE);
        let mut tight = even;
        if let LightKind::Spot { tightness, .. } = &mut tight.kind {
            *tightness = 3.0;
        }
        let p = DVec3::new(0.6, 0.0, -0.8);
        assert_eq!(even.illuminate(p).expect("lit").color, Color::WHITE);
        let c = tight.illuminate(p).expect("lit").color.r;
        assert!((c - 0.8f64.powi(3)).abs() < 1e-15);
    }

    #[test]
    fn parallel_light_comes_from_its_plane() {
        let kind = LightKind::Parallel {
            position: DVec3::new(5.0, 2.0, 0.0),
            direction: DVec3::NEG_Y,
        };
        let light = Light::new(kind, Color::WHITE).with_falloff(Falloff::InverseSquare);
        let s = light.illuminate(DVec3::new(-7.0, 0.0, 3.0)).expect("lit");
        assert_eq!((s.l, s.shadow_direction), (DVec3::Y, DVec3::Y * 2.0));
        assert_eq!(s.color, Color::gray(0.25));
        let behind = light.illuminate(DVec3::new(0.0, 3.0, 0.0)).expect("lit");
        assert!(behind.range.is_empty() && behind.l == DVec3::Y);
    }

    #[test]
    fn a_beam_is_a_cylinder_with_a_beginning() {
        let kind = LightKind::Beam {
            position: DVec3::ZERO,
            direction: DVec3::Z,
            inner: 0.5,
            outer: 1.0,
            tightness: 0.0,
        };
        let light = Light::new(kind, Color::WHITE);
        let at = |x: f64, z: f64| light.illuminate(DVec3::new(x, 0.0, z)).map(|s| s.color.r);
        assert_eq!(at(0.4, 3.0), Some(1.0));
        assert_eq!(at(0.75, 3.0), Some(0.5));
        assert_eq!((at(1.1, 3.0), at(0.0, -1.0)), (None, None));
    }

    #[test]
    fn a_light_moves_with_everything_it_has() {
        let t = Transform::rotate(DVec3::Z, std::f64::consts::FRAC_PI_2)
            .then(&Transform::translate(DVec3::new(0.0, 0.0, 4.0)));
        let mut light = Light::spot(DVec3::X, DVec3::X * 2.0, 0.1, 0.2, Color::WHITE);
        light.area = Some(AreaLight::new(DVec3::X, DVec3::Z, 3, 3));
        let moved = light.transformed(&t);
        let LightKind::Spot {
            position,
            direction,
            ..
        } = moved.kind
        else {
            panic!("still a spot");
        };
        assert!((position - DVec3::new(0.0, 1.0, 4.0)).length() < 1e-15);
        assert!((direction - DVec3::Y).length() < 1e-15);
        assert!((moved.area.expect("kept").axis_1 - DVec3::Y).length() < 1e-15);
    }
}
