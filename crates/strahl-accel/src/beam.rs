use crate::cull::largest;
use strahl_math::error::round_down_f32;
use strahl_math::{Aabb, DVec3, Ray};

/// A beam: the convex region between four planes that contains many rays, such as all rays through a rectangle of a picture.
///
/// Used to find out that none of the rays hits anything, see [`Accelerator::misses`](crate::Accelerator::misses).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    planes: [Plane; 4],
}

/// A plane with the inside of the beam on the side of its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Plane {
    /// Its absolute components add up to 1.
    normal: DVec3,
    point: DVec3,
}

/// A plane as the culling test uses it: points with `normal · p < offset` are certainly outside.
#[derive(Clone, Copy)]
pub(crate) struct CullPlane {
    pub(crate) normal: [f32; 3],
    pub(crate) offset: f32,
}

/// The margin of the culling test, as a part of B + |p|: 16u with u = 2⁻²⁴.
///
/// B is the largest coordinate of any box, |p| that of the plane's point. The test rounds the normal (error uB) and the offset
/// (u|p|), and multiplies and subtracts three times (6u(B + |p|) without fused operations): 8u(B + |p|) together. The other
/// half covers hits that a primitive's own rounding puts just outside of its box, like the margin of single rays.
const SLACK: f64 = 16.0 / (1u64 << 24) as f64;

impl Beam {
    /// The beam of four rays, in order around it, and of all rays between them: those whose origin and direction are convex
    /// combinations of theirs (a direction of any length). `None` if that has no inside.
    pub fn between(corners: &[Ray; 4]) -> Option<Self> {
        let mut planes = [Plane {
            normal: DVec3::ZERO,
            point: DVec3::ZERO,
        }; 4];
        for (side, plane) in planes.iter_mut().enumerate() {
            let (a, b, across) = (
                &corners[side],
                &corners[(side + 1) % 4],
                &corners[(side + 2) % 4],
            );
            // Two rays from one point span the plane with their directions, parallel rays with a direction and the line between
            // their origins.
            let normal = (b.origin - a.origin + b.direction).cross(a.direction);
            let size = normal.abs().element_sum();
            let inside = normal.dot(across.origin - a.origin + across.direction);
            if !(size > 0.0 && size.is_finite() && inside != 0.0 && inside.is_finite()) {
                return None;
            }
            *plane = Plane {
                normal: normal * (inside.signum() / size),
                point: a.origin,
            };
        }
        Some(Self { planes })
    }

    /// Whether it certainly misses a box.
    pub(crate) fn misses(&self, bounds: &Aabb) -> bool {
        self.planes(bounds.max_abs()).iter().any(|plane| {
            let height = |axis: usize| {
                let n = f64::from(plane.normal[axis]);
                n * if n > 0.0 {
                    bounds.max[axis]
                } else {
                    bounds.min[axis]
                }
            };
            height(0) + height(1) + height(2) < f64::from(plane.offset)
        })
    }

    /// The planes for boxes with coordinates up to `max_abs`.
    pub(crate) fn planes(&self, max_abs: f64) -> [CullPlane; 4] {
        self.planes.map(|Plane { normal, point }| {
            let margin = SLACK * (max_abs + largest(point));
            CullPlane {
                normal: normal.to_array().map(|x| x as f32),
                offset: round_down_f32(normal.dot(point) - margin),
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(eye: DVec3) -> [Ray; 4] {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| Ray::new(eye, DVec3::new(x, y, 2.0)))
    }

    fn cube(center: DVec3) -> Aabb {
        Aabb::new(center - DVec3::splat(0.5), center + DVec3::splat(0.5))
    }

    #[test]
    fn what_is_beside_a_pyramid_is_missed_on_all_sides() {
        let eye = DVec3::new(0.25, -3.0, 7.0);
        for mut corners in [picture(eye), picture(eye)] {
            corners.reverse();
            let beam = Beam::between(&corners).expect("a beam");
            assert!(!beam.misses(&cube(eye + DVec3::Z * 10.0)));
            assert!(!beam.misses(&cube(eye + DVec3::new(5.2, 0.0, 10.0))));
            for aside in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y] {
                assert!(beam.misses(&cube(eye + aside * 6.1 + DVec3::Z * 10.0)));
            }
            assert!(beam.misses(&cube(eye - DVec3::Z * 10.0)));
        }
    }

    #[test]
    fn parallel_rays_make_a_prism() {
        let corners =
            picture(DVec3::ZERO).map(|r| Ray::new(r.direction, DVec3::new(0.0, 1.0, 3.0)));
        let beam = Beam::between(&corners).expect("a beam");
        assert!(!beam.misses(&cube(DVec3::new(0.0, 10.0, 30.0))));
        assert!(!beam.misses(&cube(DVec3::new(1.4, 10.0, 30.0))));
        assert!(beam.misses(&cube(DVec3::new(1.6, 10.0, 30.0))));
        assert!(beam.misses(&cube(DVec3::new(0.0, 0.0, 30.0))));
    }

    #[test]
    fn what_has_no_inside_is_no_beam() {
        let ray = Ray::new(DVec3::ZERO, DVec3::Z);
        assert_eq!(Beam::between(&[ray; 4]), None);
        let nan = Ray::new(DVec3::ZERO, DVec3::splat(f64::NAN));
        assert_eq!(Beam::between(&[nan; 4]), None);
    }
}
