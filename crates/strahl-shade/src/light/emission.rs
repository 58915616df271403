//! Light that starts at a light source: what methods that follow light forwards need.

use super::{Light, LightKind, power, smooth_step};
use crate::Color;
use std::f64::consts::PI;
use strahl_math::{DVec3, Ray, det};

/// A ray of light on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emission {
    /// Its direction has length 1.
    pub ray: Ray,
    /// Its power if it stands for the whole light; of `n` rays each has the `n`-th part.
    pub power: Color,
}

impl Light {
    /// The ray of light that two numbers in `[0, 1)` stand for. Numbers that are spread evenly give rays whose power is spread as the
    /// light shines: a light of colour `c` that shines from a point sends the power `c` into each unit of solid angle, and parallel
    /// light sends `c` through each unit of area. So the attenuation with distance is that of space, whatever the light's falloff.
    ///
    /// Parallel light that has no bounds starts outside of the ball around `center`, and only as much of it as meets the ball. Of a
    /// light with an extent every point of the grid sends as much; the grid does not turn and has no jitter.
    ///
    /// `None` if no light goes there, as at the edge of a cone.
    ///
    /// P. Dutré, K. Bala, P. Bekaert, "Advanced Global Illumination", 2006, section 4.6 (emission as a starting point of light paths).
    pub fn emit(&self, (center, radius): (DVec3, f64), u: [f64; 2]) -> Option<Emission> {
        let (offset, u) = self.start(u);
        let (origin, direction, power) = match self.kind {
            LightKind::Point { position } => {
                let direction = around(DVec3::Z, 1.0 - 2.0 * u[0], u[1]);
                (position, direction, self.color * (4.0 * PI))
            }
            LightKind::Spot {
                position,
                direction,
                cos_inner,
                cos_outer,
                tightness,
            } => {
                let edge = cos_inner.min(cos_outer).max(0.0);
                let cosine = 1.0 - u[0] * (1.0 - edge);
                let strength = smooth_step(cos_outer, cos_inner, cosine) * power(cosine, tightness);
                let solid_angle = 2.0 * PI * (1.0 - edge);
                let towards = around(direction, cosine, u[1]);
                (position, towards, self.color * (strength * solid_angle))
            }
            LightKind::Directional { direction } | LightKind::Parallel { direction, .. } => {
                let start = center - direction * radius;
                let area = PI * radius * radius;
                let origin = start + across(direction, radius * u[0].sqrt(), u[1]);
                (origin, direction, self.color * area)
            }
            LightKind::Beam {
                position,
                direction,
                inner,
                outer,
                tightness,
            } => {
                let edge = inner.max(outer);
                if edge.is_infinite() {
                    // It fills the half-space before its plane.
                    let parallel = Self {
                        kind: LightKind::Directional { direction },
                        area: None,
                        ..*self
                    };
                    let ray = parallel.emit((center, radius), u)?;
                    let before = (ray.ray.origin - position).dot(direction);
                    let origin = ray.ray.origin - direction * before.min(0.0);
                    return Some(Emission {
                        ray: Ray::new(origin, direction),
                        ..ray
                    });
                }
                let distance = edge * u[0].sqrt();
                let strength = smooth_step(-outer, -inner, -distance)
                    * power(1.0 - distance / outer, tightness);
                let origin = position + across(direction, distance, u[1]);
                (
                    origin,
                    direction,
                    self.color * (strength * PI * edge * edge),
                )
            }
        };
        (!power.is_black()).then(|| Emission {
            ray: Ray::new(origin + offset, direction),
            power,
        })
    }

    /// The point of an area light at which a ray starts, from the light's centre, and what is left of the numbers.
    fn start(&self, [u, v]: [f64; 2]) -> (DVec3, [f64; 2]) {
        let Some(area) = self.area.filter(|_| !self.is_parallel()) else {
            return (DVec3::ZERO, [u, v]);
        };
        let place = |u: f64, size: u32| {
            let at = u * f64::from(size);
            let index = (at as u32).min(size.saturating_sub(1));
            (index, at - f64::from(index))
        };
        let ((i, u), (j, v)) = (place(u, area.size_1), place(v, area.size_2));
        let still = super::AreaLight {
            jitter: false,
            orient: false,
            ..area
        };
        (still.grid(DVec3::ZERO, DVec3::Z).offset(i, j), [u, v])
    }
}

/// The unit vector that has this cosine with a unit vector, at a part of the whole turn around it.
fn around(axis: DVec3, cosine: f64, turn: f64) -> DVec3 {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    axis * cosine + across(axis, sine, turn)
}

/// A vector perpendicular to a unit vector, of this length, at a part of the whole turn around it.
fn across(axis: DVec3, length: f64, turn: f64) -> DVec3 {
    let (x, y) = axis.any_orthonormal_pair();
    let angle = 2.0 * PI * turn;
    x * (length * det::cos(angle)) + y * (length * det::sin(angle))
}

#[cfg(test)]
mod tests {
    use super::super::{AreaLight, Falloff};
    use super::*;

    const BALL: (DVec3, f64) = (DVec3::new(1.0, 2.0, -0.5), 3.0);

    /// Rays of a light, each with its part of the power.
    fn rays(light: &Light) -> Vec<Emission> {
        const SIDE: u32 = 400;
        let at = |i: u32| (f64::from(i) + 0.5) / f64::from(SIDE);
        let pairs = (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| [at(i), at(j)]));
        pairs
            .filter_map(|u| light.emit(BALL, u))
            .map(|e| Emission {
                power: e.power / f64::from(SIDE * SIDE),
                ..e
            })
            .collect()
    }

    /// The power that goes through a small disc, per area.
    fn through(rays: &[Emission], center: DVec3, normal: DVec3, radius: f64) -> f64 {
        let power: f64 = rays
            .iter()
            .filter(|e| {
                let t = (center - e.ray.origin).dot(normal) / e.ray.direction.dot(normal);
                t > 0.0 && e.ray.at(t).distance(center) < radius
            })
            .map(|e| e.power.g)
            .sum();
        power / (PI * radius * radius)
    }

    /// The light that arrives at points equals what `illuminate` says, with the square of the distance for lights at a point.
    fn agrees(light: &Light, places: &[DVec3], disc: f64) {
        let rays = rays(light);
        for &place in places {
            let sample = light.illuminate(place).expect("lit");
            let distance = sample.shadow_direction.length();
            let expected = match light.is_parallel() {
                true => sample.color.g,
                false => sample.color.g / (distance * distance),
            };
            let found = through(&rays, place, sample.l, disc);
            assert!(
                (found / expected - 1.0).abs() < 0.05,
                "{:?}: {found} for {expected}",
                light.kind
            );
        }
    }

    #[test]
    fn power_is_spread_as_lights_shine() {
        let color = Color::new(0.0, 2.0, 0.0);
        let position = DVec3::new(0.5, 4.0, 1.0);
        let places = [DVec3::new(1.0, 2.0, 0.5), DVec3::new(0.0, 1.5, 1.5)];
        agrees(&Light::point(position, color), &places, 0.3);
        let mut spot = Light::spot(position, DVec3::new(0.5, 1.0, 1.0), 0.3, 0.7, color);
        agrees(&spot, &[DVec3::new(0.6, 2.0, 1.1)], 0.1);
        if let LightKind::Spot { tightness, .. } = &mut spot.kind {
            *tightness = 5.0;
        }
        agrees(&spot, &[DVec3::new(0.8, 2.0, 1.1)], 0.1);
        let direction = DVec3::new(0.2, -1.0, 0.1).normalize();
        agrees(&Light::directional(direction, color), &places, 0.3);
        let beam = LightKind::Beam {
            position,
            direction,
            inner: 0.4,
            outer: 1.5,
            tightness: 2.0,
        };
        agrees(&Light::new(beam, color), &[DVec3::new(0.9, 2.0, 1.1)], 0.1);
        let whole = LightKind::Beam {
            position,
            direction,
            inner: f64::INFINITY,
            outer: f64::INFINITY,
            tightness: 0.0,
        };
        agrees(&Light::new(whole, color), &places, 0.3);
    }

    #[test]
    fn rays_are_unit_vectors_and_power_is_never_negative() {
        let mut light = Light::spot(DVec3::ZERO, DVec3::Z, 2.0, 0.1, Color::WHITE);
        light = light.with_falloff(Falloff::InverseSquare);
        light.area = Some(AreaLight::new(DVec3::X, DVec3::Y, 3, 2));
        let rays = rays(&light);
        assert!(!rays.is_empty());
        let mut starts: Vec<_> = rays.iter().map(|e| e.ray.origin.to_array()).collect();
        starts.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
        starts.dedup();
        assert_eq!(starts.len(), 6);
        for e in rays {
            assert!((e.ray.direction.length() - 1.0).abs() < 1e-12);
            assert!(e.ray.direction.z >= 0.0 && e.power.r > 0.0);
        }
    }
}
