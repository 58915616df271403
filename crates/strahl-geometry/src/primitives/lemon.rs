use super::arcs::{Arc, ArcBody};
use super::{check_finite, check_length, check_positive, unit_vector};
use crate::GeometryError;
use strahl_math::DVec3;

/// A lemon: two ends on an axis, each with a radius, and between them a circular arc turned about the axis.
///
/// The arc bulges; its radius is the inner radius. The least inner radius is that of the sphere through both rims. With equal
/// end radii of 0 the body is the inside of a spindle torus, pointed at both ends. An *open* lemon has no visible caps, but it is still a
/// solid, which ends where the caps would be. Texture coordinates, from 0 to 1: `u` runs around the axis, `v` is the latitude as seen
/// from halfway between the ends. Facets: 0 the side, 1 the cap at the base, 2 the cap at the other end.
#[derive(Clone, Debug, PartialEq)]
pub struct Lemon {
    ends: [DVec3; 2],
    radii: [f64; 2],
    inner: f64,
    pub(super) body: ArcBody,
}

impl Lemon {
    /// The lemon of two ends, the radii there, and the radius of the arc between them; a smaller one than the least counts
    /// as that.
    pub fn new(base: DVec3, base_radius: f64, apex: DVec3, apex_radius: f64, inner: f64) -> Self {
        let length = (apex - base).length();
        let axis = unit_vector(apex - base);
        let [a, b] = [base_radius, apex_radius];
        let least = Self::least_inner_radius(length, a, b);
        // Above the middle of the chord between the rims, in the half plane of the outline, across it.
        let half = 0.5 * ((b - a) * (b - a) + length * length).sqrt();
        let (inset, height, radius) = if inner > least {
            let off = ((inner - half) * (inner + half)).sqrt() / (2.0 * half);
            let inset = off * length - 0.5 * (a + b);
            let inset = if inset > 0.0 { inset } else { 0.0 };
            (inset, 0.5 * length + off * (b - a), inner)
        } else {
            let height = 0.5 * (length + (b - a) * (b + a) / length);
            (0.0, height, least)
        };
        let arc = Arc {
            inset,
            height,
            radius,
            low: 0.0,
            high: length,
        };
        Self {
            ends: [base, apex],
            radii: [base_radius, apex_radius],
            inner,
            body: ArcBody {
                base,
                axis,
                first: axis
                    .try_normalize()
                    .map_or(DVec3::X, |axis| axis.any_orthonormal_vector()),
                arcs: vec![arc],
                is_capped: true,
            },
        }
    }

    /// The same without visible caps.
    #[must_use]
    pub fn open(mut self) -> Self {
        self.body.is_capped = false;
        self
    }

    /// Like [`Lemon::new`], checked.
    ///
    /// # Errors
    /// A value is not finite, a radius of an end is negative, the inner radius is not positive, or both ends are one point.
    pub fn try_new(
        base: DVec3,
        base_radius: f64,
        apex: DVec3,
        apex_radius: f64,
        inner: f64,
    ) -> Result<Self, GeometryError> {
        let lemon = Self::new(base, base_radius, apex, apex_radius, inner);
        lemon.check().map(|()| lemon)
    }

    /// The least inner radius for ends of these radii at a distance: that of the sphere through both rims.
    pub fn least_inner_radius(length: f64, base_radius: f64, apex_radius: f64) -> f64 {
        let (a, b) = (base_radius, apex_radius);
        let height = 0.5 * (length + (b - a) * (b + a) / length);
        (a * a + height * height).sqrt()
    }

    /// See [`crate::Primitive::validate`].
    pub(super) fn check(&self) -> Result<(), GeometryError> {
        for end in self.ends {
            check_finite("end of the lemon", end)?;
        }
        for radius in self.radii {
            check_length("radius of the lemon", radius)?;
        }
        check_positive("inner radius of the lemon", self.inner)?;
        if self.ends[0] == self.ends[1] {
            return Err(GeometryError::Degenerate {
                what: "lemon",
                why: "its two ends are the same point",
            });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;
    use crate::{Primitive, Scratch, Solid};
    use crate::{Sphere, Torus};
    use strahl_math::{Interval, Ray};

    crate::primitive_tests!(pointed, || Lemon::new(-DVec3::Y, 0.0, DVec3::Y, 0.0, 1.5));
    crate::primitive_tests!(cut, || Lemon::new(
        DVec3::new(0.5, 0.2, 0.1),
        0.4,
        DVec3::new(-0.3, 1.0, 0.6),
        0.2,
        1.3
    ));
    crate::primitive_tests!(round, || Lemon::new(DVec3::ZERO, 0.5, DVec3::X, 0.5, 0.1));
    crate::primitive_tests!(open, || Lemon::new(
        DVec3::ZERO,
        0.6,
        DVec3::new(0.2, 1.0, 0.1),
        0.2,
        3.0
    )
    .open());

    #[test]
    fn the_least_lemon_is_a_part_of_a_sphere() {
        let sphere = Sphere::new(DVec3::X * 0.5, 0.5_f64.hypot(0.5));
        let lemon = Lemon::new(DVec3::ZERO, 0.5, DVec3::X, 0.5, 0.1).open();
        let (mut random, scratch, mut found) = (Random::new(5), &mut Scratch::default(), 0);
        for _ in 0..2000 {
            let from = random.cube() * 3.0;
            let ray = Ray::new(from, DVec3::X * 0.5 + random.cube() * 0.6 - from);
            let mut query =
                |shape: &dyn Primitive| shape.closest_hit(&ray, Interval::FORWARD, None, scratch);
            let (ours, theirs) = (query(&lemon), query(&sphere));
            let Some(hit) = theirs else {
                assert_eq!(ours, None);
                continue;
            };
            let x = ray.at(hit.t).x;
            if (0.01..0.99).contains(&x) {
                assert!((ours.unwrap().t - hit.t).abs() < 1e-12, "{ray:?}");
                found += 1;
            }
        }
        assert!(found > 300);
    }

    #[test]
    fn a_pointed_lemon_is_what_is_within_a_spindle_torus() {
        // An arc of radius 1.5 between tips 2 apart.
        let inset = (1.5_f64 * 1.5 - 1.0).sqrt();
        let torus = Torus::new(DVec3::ZERO, DVec3::Y, inset, 1.5);
        let lemon = Lemon::new(-DVec3::Y, 0.0, DVec3::Y, 0.0, 1.5);
        let mut random = Random::new(6);
        let mut inside = 0;
        for _ in 0..2000 {
            let p = random.cube();
            let off = (p.x * p.x + p.z * p.z).sqrt() + inset;
            let within = off * off + p.y * p.y <= 1.5 * 1.5;
            assert_eq!(lemon.contains(p), within, "{p}");
            assert!(!within || torus.contains(p));
            inside += usize::from(within);
        }
        assert!(inside > 50);
    }

    #[test]
    fn impossible_lemons_are_refused() {
        let lemon = |a, end, b, inner| Lemon::try_new(DVec3::ZERO, a, end, b, inner);
        assert!(lemon(0.5, DVec3::X, 0.0, 1.0).is_ok());
        assert!(lemon(-0.5, DVec3::X, 0.0, 1.0).is_err());
        assert!(lemon(0.5, DVec3::ZERO, 0.0, 1.0).is_err());
        assert!(lemon(0.5, DVec3::X, 0.0, -1.0).is_err());
        assert!(lemon(0.5, DVec3::X, f64::INFINITY, 1.0).is_err());
    }
}
