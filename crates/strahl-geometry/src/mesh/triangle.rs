use super::shear::{RayShear, intersect_triangle};
use crate::{GeometryError, PrimHit, Primitive, Scratch, Shape, SurfaceId, SurfacePoint};
use std::sync::Arc;
use strahl_math::error::{ROUNDOFF, gamma};
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};

/// A flat triangle.
///
/// Its front is the side from which the corners run counter-clockwise; rays hit it from both sides. `uv` are the barycentric
/// coordinates of the second and the third corner, so `dpdu` and `dpdv` are the edges at the first. A mirroring transform keeps
/// the front where it moves it, not on the side of the right-handed normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    corners: [DVec3; 3],
    /// Whether the front is the other side, after a mirroring transform.
    flipped: bool,
}

impl Triangle {
    /// The triangle with these corners.
    pub const fn new(a: DVec3, b: DVec3, c: DVec3) -> Self {
        Self {
            corners: [a, b, c],
            flipped: false,
        }
    }

    /// Like [`Triangle::new`], checked.
    ///
    /// # Errors
    /// A corner is not finite, or the corners lie on a line (up to the rounding of their coordinates).
    pub fn try_new(a: DVec3, b: DVec3, c: DVec3) -> Result<Self, GeometryError> {
        let triangle = Self::new(a, b, c);
        triangle.validate().map(|()| triangle)
    }

    /// The corners.
    pub const fn corners(&self) -> [DVec3; 3] {
        self.corners
    }

    fn transformed(&self, map: &Transform) -> Self {
        Self {
            corners: self.corners.map(|p| map.point_to_world(p)),
            flipped: self.flipped != map.mirrors(),
        }
    }

    #[inline]
    fn hit(&self, ray: &Ray, range: Interval, from: Option<SurfaceId>) -> Option<PrimHit> {
        if from.is_some() {
            return None; // A ray does not come back to the plane it starts from.
        }
        let [a, b, c] = self.corners;
        let hit = intersect_triangle(&RayShear::new(ray), a, b, c)?;
        range.accepts(hit.t).then(|| PrimHit {
            uv: [hit.u, hit.v],
            ..PrimHit::simple(hit.t, 0)
        })
    }

    /// The surface at barycentric coordinates.
    fn surface(&self, uv: [f64; 2]) -> SurfacePoint {
        let [a, b, c] = self.corners;
        let (position, position_error) = combine(a, b, c, uv);
        let normal = front_normal(a, b, c).unwrap_or_else(|| any_normal(a, b, c));
        let n = if self.flipped { -normal } else { normal };
        SurfacePoint {
            position,
            position_error,
            n_geom: n,
            n_shade: n,
            uv: DVec2::from_array(uv),
            dpdu: b - a,
            dpdv: c - a,
        }
    }
}

impl Primitive for Triangle {
    fn kind(&self) -> &'static str {
        "triangle"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        check_corners(self.corners)
    }

    fn bounds(&self) -> Aabb {
        Aabb::from_points(self.corners)
    }

    #[inline]
    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        self.hit(ray, range, from)
    }

    fn surface_at(&self, _ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        self.surface(hit.uv)
    }

    fn baked(&self, map: &Transform) -> Option<Shape> {
        Some(self.transformed(map).into())
    }
}

/// A triangle with a normal at each corner, which are interpolated for shading, and optional texture coordinates.
///
/// Everything else is as for [`Triangle`]. The normals may have any length and point to either side: the side on which most of
/// them lie counts as the front. Where the interpolated normal then still points to the back (corner normals more than a right
/// angle apart) it is projected onto the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothTriangle {
    flat: Triangle,
    normals: [DVec3; 3],
    uvs: Option<[DVec2; 3]>,
}

impl SmoothTriangle {
    /// The triangle with these corners and their normals, of any length but zero.
    pub const fn new(corners: [DVec3; 3], normals: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        Self {
            flat: Triangle::new(a, b, c),
            normals,
            uvs: None,
        }
    }

    /// Like [`SmoothTriangle::new`], checked.
    ///
    /// # Errors
    /// As [`Triangle::try_new`]; or a normal is not finite or zero.
    pub fn try_new(corners: [DVec3; 3], normals: [DVec3; 3]) -> Result<Self, GeometryError> {
        let triangle = Self::new(corners, normals);
        triangle.validate().map(|()| triangle)
    }

    /// With texture coordinates at the corners.
    #[must_use]
    pub const fn with_uvs(self, uvs: [DVec2; 3]) -> Self {
        Self {
            uvs: Some(uvs),
            ..self
        }
    }

    /// The corners.
    pub const fn corners(&self) -> [DVec3; 3] {
        self.flat.corners
    }

    /// The normals at the corners, as given.
    pub const fn normals(&self) -> [DVec3; 3] {
        self.normals
    }
}

impl Primitive for SmoothTriangle {
    fn kind(&self) -> &'static str {
        "smooth_triangle"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        self.flat.validate()?;
        for n in self.normals {
            if !n.is_finite() {
                return Err(GeometryError::NotFinite {
                    what: "normal of the smooth triangle",
                });
            }
            if n == DVec3::ZERO {
                return Err(GeometryError::OutOfRange {
                    what: "normal of the smooth triangle",
                    expected: "a vector that is not zero",
                    found: 0.0,
                });
            }
        }
        let uvs = self.uvs.unwrap_or_default();
        if uvs.iter().any(|uv| !uv.is_finite()) {
            return Err(GeometryError::NotFinite {
                what: "texture coordinate of the smooth triangle",
            });
        }
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        self.flat.bounds()
    }

    #[inline]
    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        self.flat.hit(ray, range, from)
    }

    fn surface_at(&self, _ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let mut point = self.flat.surface(hit.uv);
        point.n_shade = smooth_normal(self.normals, hit.uv, point.n_geom);
        if let Some(uvs) = self.uvs {
            apply_uvs(&mut point, uvs, hit.uv);
        }
        point
    }

    fn baked(&self, map: &Transform) -> Option<Shape> {
        let mapped = Self {
            flat: self.flat.transformed(map),
            // With their new lengths, not normalised, so that interpolation and map may be exchanged.
            normals: self.normals.map(|n| map.normal_to_world(n)),
            uvs: self.uvs,
        };
        Some(Arc::new(mapped).into())
    }
}

/// Checks the corners of a single triangle: finite, and not on a line.
fn check_corners(corners: [DVec3; 3]) -> Result<(), GeometryError> {
    if corners.iter().any(|p| !p.is_finite()) {
        return Err(GeometryError::NotFinite {
            what: "corner of the triangle",
        });
    }
    let [a, b, c] = corners;
    let (ab, ac) = (b - a, c - a);
    let longest = ab.length().max(ac.length()).max((c - b).length());
    let size = Aabb::from_points(corners).max_abs();
    let height = ab.cross(ac).length() / longest;
    // No height, or one within the rounding error of the coordinates.
    if !(height > gamma(4) * size) {
        return Err(GeometryError::Degenerate {
            what: "triangle",
            why: "its corners lie on a line",
        });
    }
    Ok(())
}

/// The unit normal by the right-hand rule; `None` if the triangle has no area.
pub(super) fn front_normal(a: DVec3, b: DVec3, c: DVec3) -> Option<DVec3> {
    let edges = [b - a, c - b, a - c];
    let size = edges
        .iter()
        .fold(0.0, |m: f64, e| m.max(e.abs().max_element()));
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    // The cross product of the two shorter edges loses the fewest digits; tiny and huge ones are scaled, so that its square
    // does not leave the range of f64.
    let edges = if (1e-70..1e70).contains(&size) {
        edges
    } else {
        edges.map(|e| e / size)
    };
    let squares = edges.map(|e| e.dot(e));
    let longest = if squares[0] >= squares[1] && squares[0] >= squares[2] {
        0
    } else if squares[1] >= squares[2] {
        1
    } else {
        2
    };
    let n = edges[(longest + 1) % 3].cross(edges[(longest + 2) % 3]);
    let length = n.length();
    (length > 0.0).then(|| n / length)
}

/// A unit vector perpendicular to a triangle without area, so that there is always a result.
pub(super) fn any_normal(a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    [b - a, c - a]
        .into_iter()
        .filter_map(DVec3::try_normalize)
        .map(|e| e.any_orthonormal_vector())
        .next()
        .unwrap_or(DVec3::Z)
}

/// The point with barycentric coordinates `uv`, and a bound on its distance from the triangle's plane.
#[inline]
pub(crate) fn combine(a: DVec3, b: DVec3, c: DVec3, [u, v]: [f64; 2]) -> (DVec3, DVec3) {
    let (along_b, along_c) = ((b - a) * u, (c - a) * v);
    let position = a + (along_b + along_c);
    // Edge, product and sum are rounded on the way to the offset, then the point itself.
    let error = (along_b.abs() + along_c.abs()) * gamma(4) + position.abs() * (2.0 * ROUNDOFF);
    (position, error)
}

/// The interpolated unit normal, on the side of `n_geom` (see [`SmoothTriangle`]).
pub(super) fn smooth_normal(normals: [DVec3; 3], [u, v]: [f64; 2], n_geom: DVec3) -> DVec3 {
    let [a, b, c] = normals;
    let n = a * (1.0 - u - v) + b * u + c * v;
    let front = (a + b + c).dot(n_geom) >= 0.0;
    let Some(n) = (if front { n } else { -n }).try_normalize() else {
        return n_geom;
    };
    let above = n.dot(n_geom);
    if above >= 0.0 {
        return n;
    }
    (n - n_geom * above).try_normalize().unwrap_or(n_geom)
}

/// Sets texture coordinates and their tangents from the values at the corners. `point` has the edges as its tangents.
pub(super) fn apply_uvs(point: &mut SurfacePoint, [a, b, c]: [DVec2; 3], [u, v]: [f64; 2]) {
    let (ab, ac) = (b - a, c - a);
    let (to_b, to_c) = (point.dpdu, point.dpdv);
    point.uv = a + ab * u + ac * v;
    let area = ab.perp_dot(ac);
    (point.dpdu, point.dpdv) = if area == 0.0 {
        (DVec3::ZERO, DVec3::ZERO)
    } else {
        (
            (to_b * ac.y - to_c * ab.y) / area,
            (to_c * ab.x - to_b * ac.x) / area,
        )
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Triangle {
        Triangle::new(DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 4.0)
    }

    fn hit(shape: &impl Primitive, ray: &Ray) -> Option<(PrimHit, SurfacePoint)> {
        let hit = shape.closest_hit(ray, Interval::FORWARD, None, &mut Scratch::default())?;
        Some((hit, shape.surface_at(ray, &hit)))
    }

    #[test]
    fn the_surface_at_a_hit_is_exact() {
        let ray = Ray::new(DVec3::new(0.5, 1.0, 3.0), -DVec3::Z);
        let (hit, point) = hit(&sample(), &ray).expect("a hit");
        assert_eq!((hit.t, hit.uv), (3.0, [0.25, 0.25]));
        assert_eq!(point.position, DVec3::new(0.5, 1.0, 0.0));
        assert_eq!((point.n_geom, point.n_shade), (DVec3::Z, DVec3::Z));
        assert_eq!((point.dpdu, point.dpdv), (DVec3::X * 2.0, DVec3::Y * 4.0));
        assert_eq!(point.position_error.z, 0.0);
    }

    #[test]
    fn a_mirrored_triangle_keeps_its_front() {
        let mirror = Transform::try_scale(DVec3::new(-1.0, 1.0, 1.0)).expect("regular");
        let mirrored = sample().baked(&mirror).expect("any map will do");
        let ray = Ray::new(DVec3::new(-0.5, 1.0, 3.0), -DVec3::Z);
        let (hit, point) = hit(&mirrored, &ray).expect("a hit");
        assert_eq!(point.n_geom, DVec3::Z);
        assert_eq!(hit.uv, [0.25, 0.25]);
    }

    #[test]
    fn degenerate_triangles_are_refused() {
        let (a, b) = (DVec3::splat(0.1), DVec3::new(0.4, 0.7, 1.3));
        for c in [a, b, a + (b - a) * 0.3, a - (b - a) * 1e6] {
            let error = Triangle::try_new(a, b, c).expect_err("on a line");
            assert!(matches!(error, GeometryError::Degenerate { .. }), "{c}");
        }
        assert!(Triangle::try_new(a, b, DVec3::splat(f64::NAN)).is_err());
        assert!(Triangle::try_new(a, b, DVec3::new(0.4, 0.7, 1.300_001)).is_ok());
        let no_normal =
            SmoothTriangle::try_new(sample().corners, [DVec3::Z, DVec3::ZERO, DVec3::Z]);
        assert!(matches!(no_normal, Err(GeometryError::OutOfRange { .. })));
    }

    #[test]
    fn normals_are_interpolated_on_the_front_side() {
        let ray = Ray::new(DVec3::new(0.5, 1.0, 3.0), -DVec3::Z);
        let normals = [
            DVec3::new(-1.0, 0.0, 1.0),
            DVec3::new(1.0, 0.0, 1.0),
            DVec3::Z,
        ];
        for side in [1.0, -1.0] {
            let smooth = SmoothTriangle::new(sample().corners, normals.map(|n| n * side));
            let (_, point) = hit(&smooth, &ray).expect("a hit");
            let expected = DVec3::new(-0.25, 0.0, 1.0).normalize();
            assert!((point.n_shade - expected).length() < 1e-15);
            assert_eq!(point.n_geom, DVec3::Z);
        }
        // Beyond the horizon at one corner only: projected onto the plane there.
        let tilted = [DVec3::new(3.0, 0.0, -1.0), DVec3::Z, DVec3::Z];
        let n = smooth_normal(tilted, [0.0, 0.0], DVec3::Z);
        assert_eq!(n, DVec3::X);
    }

    #[test]
    fn tangents_follow_the_texture() {
        let uvs = [
            DVec2::new(0.0, 1.0),
            DVec2::new(0.0, 0.0),
            DVec2::new(1.0, 1.0),
        ];
        let smooth = SmoothTriangle::new(sample().corners, [DVec3::Z; 3]).with_uvs(uvs);
        let ray = Ray::new(DVec3::new(0.5, 1.0, 3.0), -DVec3::Z);
        let (_, point) = hit(&smooth, &ray).expect("a hit");
        assert_eq!(point.uv, DVec2::new(0.25, 0.75));
        assert_eq!((point.dpdu, point.dpdv), (DVec3::Y * 4.0, DVec3::X * -2.0));
    }

    crate::primitive_tests!(flat, || Triangle::new(
        DVec3::new(-0.3, 0.2, 1.0),
        DVec3::new(1.2, 0.1, -0.4),
        DVec3::new(0.4, 1.5, 0.3)
    ));
    crate::primitive_tests!(smooth, || {
        let corners = sample()
            .corners
            .map(|p| p + DVec3::Z * (0.4 * p.x - 0.2 * p.y));
        let normals = corners.map(|p| p * 0.2 + DVec3::Z);
        SmoothTriangle::new(corners, normals).with_uvs([
            DVec2::ZERO,
            DVec2::new(0.9, 0.1),
            DVec2::new(0.3, 0.8),
        ])
    });
}
