use super::convex::{End, Span};
use super::frame::{UvFrame, similarity, turn};
use super::{check_finite, point_error};
use crate::blocks::convex::{FourLines, FourRays, FourSpans, scaled, sub};
use crate::blocks::dot;
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Shape, Solid, SurfaceId, SurfacePoint,
};
use std::f64::consts::PI;
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform, det};
use strahl_simd::Isa;

/// A sphere.
///
/// A **negative radius** makes a sphere that is seen from inside, as in NFF: the same points, but `n_geom` points to the
/// centre, and it is an open surface, not a [`Solid`].
///
/// Texture coordinates: `u` is the longitude, 0 on the side of +x, growing towards -z (to the right as seen from
/// outside with +y up); `v` is the latitude, 0 at the pole -y, 1 at the pole +y; both run from 0 to 1. Facets: one, 0.
///
/// The ray is solved by the closest approach to the centre instead of by `b² - 4ac`, which loses all digits of small
/// spheres far away (Haines, Günther, Akenine-Möller: "Precision Improvements for Ray/Sphere Intersection", Ray Tracing
/// Gems, 2019). A ray that touches the sphere in a single point does not hit it.
#[derive(Clone, Debug, PartialEq)]
pub struct Sphere {
    center: DVec3,
    radius: f64,
    frame: UvFrame,
}

impl Sphere {
    /// The sphere of a centre and a radius. A negative radius turns the normal inwards.
    pub fn new(center: DVec3, radius: f64) -> Self {
        Self {
            center,
            radius,
            frame: UvFrame::default(),
        }
    }

    /// Like [`Sphere::new`], checked.
    ///
    /// # Errors
    /// The centre or the radius is not finite, or the radius is zero.
    pub fn try_new(center: DVec3, radius: f64) -> Result<Self, GeometryError> {
        let sphere = Self::new(center, radius);
        sphere.validate().map(|()| sphere)
    }

    /// The centre.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// The radius as given, negative for a sphere seen from inside.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Whether a rotation was baked into its texture coordinates.
    pub fn is_turned(&self) -> bool {
        self.frame.is_turned()
    }

    /// The two parameters at which the line crosses the sphere, `near < far`.
    ///
    /// With `f = origin - center` and `F(t) = |f + t d|² - r² = a t² - 2 b t + c`: the discriminant `b² - a c` is
    /// `a (r² - |f + (b/a) d|²)`, the roots are `c / q` and `q / a` with `q = b ± √(b² - a c)` of the larger magnitude.
    #[inline(always)]
    fn roots(&self, ray: &Ray, on_surface: bool) -> Option<(f64, f64)> {
        if on_surface {
            let other = Self::other_root(self.center, ray)?;
            return Some(if other > 0.0 {
                (0.0, other)
            } else {
                (other, 0.0)
            });
        }
        Self::crossings_of(self.center, self.radius.abs(), ray)
    }

    /// The second crossing of the line of a ray that starts on the sphere; `None` for a tangent.
    #[inline(always)]
    pub(crate) fn other_root(center: DVec3, ray: &Ray) -> Option<f64> {
        let d = ray.direction;
        let f = ray.origin - center;
        let b = -f.dot(d);
        let closest_t = b / d.dot(d);
        // c is zero: the roots are 0 and 2b/a. Below its own rounding error the sign of b says nothing: a tangent.
        let other = 2.0 * closest_t;
        let certain = b.abs() > gamma(4) * f.abs().dot(d.abs());
        (certain && other.is_finite()).then_some(other)
    }

    /// The roots for a ray that starts anywhere but on the sphere, whose radius is positive.
    #[inline(always)]
    pub(crate) fn crossings_of(center: DVec3, r: f64, ray: &Ray) -> Option<(f64, f64)> {
        let d = ray.direction;
        let f = ray.origin - center;
        let a = d.dot(d);
        let b = -f.dot(d);
        let closest_t = b / a;
        let closest = f + d * closest_t;
        let discriminant = a * (r * r - closest.dot(closest));
        // Also false if the ray has a NaN, no direction or an infinite coordinate.
        if !(discriminant > 0.0) {
            return None;
        }
        let s = discriminant.sqrt();
        let distance = f.length();
        let c = (distance - r) * (distance + r);
        Some(if b >= 0.0 {
            let q = b + s;
            (c / q, q / a)
        } else {
            let q = b - s;
            (q / a, c / q)
        })
    }

    /// The span in which the line is inside.
    #[inline]
    pub(crate) fn span(&self, ray: &Ray, from: Option<SurfaceId>) -> Option<Span> {
        let end = |t| End { t, facet: 0 };
        self.roots(ray, from.is_some()).map(|(near, far)| Span {
            enter: end(near),
            exit: end(far),
        })
    }

    /// The error of the parameter of a hit: the error of the point on the ray, divided by the speed at which the ray crosses
    /// the surface; near a tangent the error grows to the square root.
    pub(crate) fn t_error(&self, ray: &Ray, t: f64) -> f64 {
        let r = self.radius.abs();
        let f = ray.origin - self.center;
        let speed = ray.direction.length();
        let point = gamma(8) * (ray.origin.length() + self.center.length() + f.length() + r);
        let across = (f + ray.direction * t).dot(ray.direction).abs();
        let straight = point * r / across;
        let tangent = (2.0 * r * point).sqrt() / speed;
        gamma(2) * t.abs()
            + if straight < tangent {
                straight
            } else {
                tangent
            }
    }
}

impl FourLines for Sphere {
    /// As [`Sphere::crossings_of`].
    #[inline(always)]
    fn spans<I: Isa>(&self, isa: I, rays: &FourRays<I>) -> FourSpans {
        let (p, d) = (self.center, rays.direction);
        let center = [isa.splat(p.x), isa.splat(p.y), isa.splat(p.z)];
        let (zero, r) = (isa.splat(0.0), isa.splat(self.radius.abs()));
        let f = sub(isa, rays.origin, center);
        let a = dot(isa, d, d);
        let b = isa.sub(zero, dot(isa, f, d));
        let step = scaled(isa, d, isa.div(b, a));
        let closest = [
            isa.add(f[0], step[0]),
            isa.add(f[1], step[1]),
            isa.add(f[2], step[2]),
        ];
        let below = isa.sub(isa.mul(r, r), dot(isa, closest, closest));
        let discriminant = isa.mul(a, below);
        let met = isa.lt(zero, discriminant);
        let mut out = FourSpans {
            known: 0b1111,
            ..FourSpans::default()
        };
        if met == 0 {
            return out;
        }
        let s = isa.sqrt(discriminant);
        let distance = isa.sqrt(dot(isa, f, f));
        let c = isa.mul(isa.sub(distance, r), isa.add(distance, r));
        let q = isa.choose_le(zero, b, isa.add(b, s), isa.sub(b, s));
        let (one, other) = (isa.div(c, q), isa.div(q, a));
        let (enter, exit) = (
            isa.choose_le(zero, b, one, other),
            isa.choose_le(zero, b, other, one),
        );
        // The own test decides about what is no number.
        out.known &= !met | isa.lt(enter, exit);
        out.met = met & out.known;
        (out.enter, out.exit) = (isa.store(enter), isa.store(exit));
        out
    }
}

impl Primitive for Sphere {
    fn kind(&self) -> &'static str {
        "sphere"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        check_finite("center of the sphere", self.center)?;
        let what = "radius of the sphere";
        if !self.radius.is_finite() {
            return Err(GeometryError::NotFinite { what });
        }
        if self.radius == 0.0 {
            return Err(GeometryError::OutOfRange {
                what,
                expected: "different from 0",
                found: 0.0,
            });
        }
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        let r = DVec3::splat(self.radius.abs());
        let tight = Aabb::new(self.center - r, self.center + r);
        tight.padded(point_error(self.center.abs() + r, self.radius.abs(), 8))
    }

    #[inline]
    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let (near, far) = self.roots(ray, from.is_some())?;
        if range.accepts(near) && (from.is_none() || near != 0.0) {
            return Some(PrimHit::simple(near, 0));
        }
        (range.accepts(far) && (from.is_none() || far != 0.0)).then(|| PrimHit::simple(far, 0))
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let bare = self.bare_surface_at(ray, hit);
        let r = self.radius.abs();
        let outward = if self.radius < 0.0 {
            -bare.n_geom
        } else {
            bare.n_geom
        };
        let axes = self.frame.axes(DVec3::Y);
        let local = axes.transpose() * outward;
        let ring = DVec2::new(local.x, local.y).length();
        let height = local.z.clamp(-1.0, 1.0);
        // At a pole every longitude is correct; that of the seam is used.
        let (east_x, east_y) = if ring > 0.0 {
            (local.x / ring, local.y / ring)
        } else {
            (1.0, 0.0)
        };
        let west = axes.x_axis * east_y - axes.y_axis * east_x;
        let north = axes.z_axis * ring - (axes.x_axis * east_x + axes.y_axis * east_y) * height;
        SurfacePoint {
            uv: DVec2::new(turn(-local.y, local.x), 1.0 - det::acos(height) / PI),
            dpdu: west * (2.0 * PI * r * ring),
            dpdv: north * (PI * r),
            ..bare
        }
    }

    #[inline]
    fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
        let r = self.radius.abs();
        let outward = ((ray.origin - self.center) + ray.direction * hit.t).normalize_or(DVec3::Y);
        let position = self.center + outward * r;
        let n = if self.radius < 0.0 { -outward } else { outward };
        *out = SurfacePoint::bare(position, point_error(position, r, 8), n);
    }

    fn texture_uv(&self, _hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        Some(uv)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        if self.radius < 0.0 { None } else { Some(self) }
    }

    /// Any similarity makes a sphere of a sphere.
    fn baked(&self, map: &Transform) -> Option<Shape> {
        let (scale, orthogonal) = similarity(map)?;
        Some(Shape::Sphere(Self {
            center: map.point_to_world(self.center),
            radius: self.radius * scale,
            frame: self.frame.turned(DVec3::Y, orthogonal),
        }))
    }
}

impl Solid for Sphere {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        if let Some(span) = self.span(ray, from) {
            span.list(range, from, |end| self.t_error(ray, end.t), out);
        }
    }

    fn contains(&self, point: DVec3) -> bool {
        (point - self.center).length() <= self.radius.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    crate::primitive_tests!(unit, || Sphere::new(DVec3::ZERO, 1.0));
    crate::primitive_tests!(elsewhere, || Sphere::new(DVec3::new(5.0, -3.0, 2.0), 0.3));
    crate::primitive_tests!(from_within, || Sphere::new(DVec3::ZERO, -2.0));

    /// The textbook solution: `b² - 4ac` of the expanded square.
    fn textbook(ray: &Ray, center: DVec3, radius: f64) -> Option<f64> {
        let (d, f) = (ray.direction, ray.origin - center);
        let (a, b, c) = (d.dot(d), 2.0 * f.dot(d), f.dot(f) - radius * radius);
        let discriminant = b * b - 4.0 * a * c;
        (discriminant >= 0.0).then(|| (-b - discriminant.sqrt()) / (2.0 * a))
    }

    #[test]
    fn a_million_radii_away_the_textbook_form_loses_its_digits() {
        let (mut robust_error, mut textbook_error) = (0.0f64, 0.0f64);
        let mut random = crate::conformance::Random::new(1);
        let sphere = Sphere::new(DVec3::ZERO, 1.0);
        for _ in 0..1000 {
            let target = random.direction() * random.unit();
            let toward = random.direction();
            let ray = Ray::new(target - toward * 1e6, toward);
            let off = |t: f64| (ray.at(t).length() - 1.0).abs();
            let hit = sphere
                .closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default())
                .expect("aimed at it");
            robust_error = robust_error.max(off(hit.t));
            textbook_error = textbook_error.max(textbook(&ray, DVec3::ZERO, 1.0).map_or(1.0, off));
        }
        assert!(robust_error < 1e-9, "{robust_error}");
        assert!(
            textbook_error > 1e-5,
            "{textbook_error}: the textbook form is better than its reputation"
        );
    }

    #[test]
    fn a_start_on_the_surface_finds_the_far_side_exactly() {
        let sphere = Sphere::new(DVec3::ZERO, 1.0);
        let from = Some(SurfaceId {
            element: 0,
            facet: 0,
        });
        let hit =
            |ray: &Ray| sphere.closest_hit(ray, Interval::FORWARD, from, &mut Scratch::default());
        let inward = Ray::new(DVec3::X, DVec3::new(-1.0, 1.0, 0.0));
        assert_eq!(hit(&inward).map(|hit| hit.t), Some(1.0));
        assert_eq!(hit(&Ray::new(DVec3::X, DVec3::X)), None);
        assert_eq!(hit(&Ray::new(DVec3::X, DVec3::Y)), None);
    }

    #[test]
    fn a_negative_radius_turns_the_normal_and_is_no_solid() {
        let hollow = Sphere::new(DVec3::ZERO, -2.0);
        let ray = Ray::new(DVec3::ZERO, DVec3::Z);
        let hit = hollow
            .closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default())
            .expect("surrounded");
        assert_eq!(hit.t, 2.0);
        assert_eq!(hollow.surface_at(&ray, &hit).n_geom, -DVec3::Z);
        assert!(hollow.as_solid().is_none() && hollow.validate().is_ok());
    }

    #[test]
    fn impossible_spheres_are_refused() {
        assert!(matches!(
            Sphere::try_new(DVec3::ZERO, 0.0),
            Err(GeometryError::OutOfRange { .. })
        ));
        assert!(matches!(
            Sphere::try_new(DVec3::ZERO, f64::NAN),
            Err(GeometryError::NotFinite { .. })
        ));
        assert!(matches!(
            Sphere::try_new(DVec3::INFINITY, 1.0),
            Err(GeometryError::NotFinite { .. })
        ));
    }
}
