use super::convex::{End, Span};
use super::{check_finite, point_error};
use crate::blocks::LANES;
use crate::blocks::convex::{FourLines, FourRays, FourSpans};
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Shape, Solid, SurfaceId, SurfacePoint,
};
use strahl_math::error::gamma;
use strahl_math::{Aabb, DMat3, DVec2, DVec3, Interval, Ray, Transform};
use strahl_simd::Isa;

/// A box whose faces are perpendicular to the coordinate axes, called `box` in scenes.
///
/// Facets: 0 and 1 are the faces at the smallest and the largest x, 2 and 3 those of y, 4 and 5 those of z. An edge belongs
/// to the face of the earlier axis. Texture coordinates are POV-Ray's: the six faces unfolded into a cross, four columns of `u` by
/// three rows of `v`. The middle row shows, from left to right, the faces of the smallest x, the largest z, the largest x and the
/// smallest z; below and above the largest z are the faces of the smallest and the largest y.
///
/// Rays are cut by the three pairs of planes (Kay and Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986), in f64 with real
/// divisions. A ray that runs within a face or touches an edge or a corner only does not hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    min: DVec3,
    max: DVec3,
    unfolding: Unfolding,
}

/// A coordinate of the unfolded box: `start` plus a part of the way along an axis, backwards if `scale` is negative.
struct Unfolded {
    start: f64,
    scale: f64,
    axis: usize,
}

impl Unfolded {
    const fn new(start: f64, scale: f64, axis: usize) -> Self {
        Self { start, scale, axis }
    }

    /// The coordinate at a place within a box with these sides, from 0 to 1 along each, and the derivative of the point by it.
    fn at(&self, part: DVec3, sides: &DMat3) -> (f64, DVec3) {
        (
            self.start + part[self.axis] * self.scale,
            sides.col(self.axis) / self.scale,
        )
    }
}

/// How the faces of a box are unfolded to texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unfolding {
    /// The axes along which the box is mirrored first.
    mirrored: [bool; 3],
}

impl Unfolding {
    /// The texture coordinates on a face, with the derivatives of the point by them.
    ///
    /// `face` is the axis across it and whether it is the one at its end; `part` the place within the box, from 0 to 1 along each of
    /// the `sides`, which are vectors.
    pub(crate) fn at(
        self,
        face: (usize, bool),
        mut part: DVec3,
        mut sides: DMat3,
    ) -> (DVec2, DVec3, DVec3) {
        let (axis, at_max) = (face.0, face.1 != self.mirrored[face.0]);
        for (axis, mirrored) in self.mirrored.into_iter().enumerate() {
            if mirrored {
                part[axis] = 1.0 - part[axis];
                *sides.col_mut(axis) *= -1.0;
            }
        }
        let [right, up] = &UNFOLDED[axis][usize::from(at_max)];
        let ((u, dpdu), (v, dpdv)) = (right.at(part, &sides), up.at(part, &sides));
        (DVec2::new(u, v), dpdu, dpdv)
    }
}

/// The `u` and `v` of the faces at the smallest and the largest x, y and z.
const UNFOLDED: [[[Unfolded; 2]; 2]; 3] = {
    const COLUMN: f64 = 1.0 / 4.0;
    const ROW: f64 = 1.0 / 3.0;
    const fn column(start: f64, scale: f64, axis: usize) -> Unfolded {
        Unfolded::new(start * COLUMN, scale * COLUMN, axis)
    }
    const fn row(start: f64, scale: f64, axis: usize) -> Unfolded {
        Unfolded::new(start * ROW, scale * ROW, axis)
    }
    const UP: Unfolded = row(1.0, 1.0, 1);
    [
        [[column(0.0, 1.0, 2), UP], [column(3.0, -1.0, 2), UP]],
        [
            [column(1.0, 1.0, 0), row(0.0, 1.0, 2)],
            [column(1.0, 1.0, 0), row(3.0, -1.0, 2)],
        ],
        [[column(4.0, -1.0, 0), UP], [column(1.0, 1.0, 0), UP]],
    ]
};

impl Cuboid {
    /// The box between two corners; every coordinate of `min` must be less than that of `max`.
    pub const fn new(min: DVec3, max: DVec3) -> Self {
        let mirrored = [false; 3];
        Self {
            min,
            max,
            unfolding: Unfolding { mirrored },
        }
    }

    /// The same box, with the texture coordinates that it has once it is mirrored along these axes (x, y, z). A second mirroring takes
    /// back the first.
    pub fn with_mirrored_texture(mut self, axes: [bool; 3]) -> Self {
        for (mirrored, too) in self.unfolding.mirrored.iter_mut().zip(axes) {
            *mirrored ^= too;
        }
        self
    }

    pub(crate) const fn unfolding(&self) -> Unfolding {
        self.unfolding
    }

    /// The box with any two opposite corners, in any order.
    pub fn from_corners(a: DVec3, b: DVec3) -> Self {
        Self::new(a.min(b), a.max(b))
    }

    /// Like [`Cuboid::new`], checked.
    ///
    /// # Errors
    /// A corner is not finite, or `min` is not less than `max` on some axis.
    pub fn try_new(min: DVec3, max: DVec3) -> Result<Self, GeometryError> {
        let cuboid = Self::new(min, max);
        cuboid.validate().map(|()| cuboid)
    }

    /// The corner with the smallest coordinates.
    pub const fn min(&self) -> DVec3 {
        self.min
    }

    /// The corner with the largest coordinates.
    pub const fn max(&self) -> DVec3 {
        self.max
    }

    /// The span in which the line is inside. The face the ray starts on is at exactly `t = 0`.
    #[inline]
    pub(crate) fn span(&self, ray: &Ray, from: Option<SurfaceId>) -> Option<Span> {
        let (o, d) = (ray.origin, ray.direction);
        // In registers: a surface is copied as a whole, before the stores of its parts have ended.
        let from = from.map(|surface| surface.facet);
        if d.cmpeq(DVec3::ZERO).any() {
            return self.span_along_faces(ray, from);
        }
        // All axes at once, which is half the work of one after the other.
        let mut at_min = ((self.min - o) / d).to_array();
        let mut at_max = ((self.max - o) / d).to_array();
        if let Some(facet) = from {
            let (axis, high) = (facet as usize / 2, facet % 2 == 1);
            let ends = if high { &mut at_max } else { &mut at_min };
            if let Some(end) = ends.get_mut(axis) {
                *end = 0.0;
            }
        }
        let mut span = Span::LINE;
        let mut valid = true;
        for axis in 0..3 {
            let forward = d[axis] > 0.0;
            let (low, high) = (2 * axis as u32, 2 * axis as u32 + 1);
            let (t, facet) = match forward {
                true => ((at_min[axis], at_max[axis]), (low, high)),
                false => ((at_max[axis], at_min[axis]), (high, low)),
            };
            // As in `Span::cut`: an edge belongs to the facet that was there first, and nothing is before or behind NaN.
            valid &= t.0 <= t.1;
            let (before, behind) = (t.0 > span.enter.t, t.1 < span.exit.t);
            span.enter = End {
                t: if before { t.0 } else { span.enter.t },
                facet: if before { facet.0 } else { span.enter.facet },
            };
            span.exit = End {
                t: if behind { t.1 } else { span.exit.t },
                facet: if behind { facet.1 } else { span.exit.facet },
            };
        }
        (valid && span.enter.t < span.exit.t && span.enter.t.is_finite()).then_some(span)
    }

    /// The error of the parameter of an end of a span.
    pub(crate) fn t_error(&self, ray: &Ray, end: End) -> f64 {
        let axis = (end.facet / 2).min(2) as usize;
        let (o, d) = (ray.origin[axis], ray.direction[axis]);
        let plane = self.min[axis].abs() + self.max[axis].abs();
        gamma(8) * ((o.abs() + plane) / d.abs() + end.t.abs())
    }

    /// [`Cuboid::span`] of rays that are parallel to a face.
    #[inline(never)]
    fn span_along_faces(&self, ray: &Ray, from: Option<u32>) -> Option<Span> {
        let mut span = Span::LINE;
        for axis in 0..3 {
            let (o, d) = (ray.origin[axis], ray.direction[axis]);
            let (low, high) = (2 * axis as u32, 2 * axis as u32 + 1);
            let starts_on = |facet| from == Some(facet);
            if d == 0.0 {
                // A ray within a face is outside; NaN is never between.
                let between = self.min[axis] < o && o < self.max[axis];
                if !between || starts_on(low) || starts_on(high) {
                    return None;
                }
                continue;
            }
            let end = |facet, plane: f64| End {
                t: if starts_on(facet) {
                    0.0
                } else {
                    (plane - o) / d
                },
                facet,
            };
            let (at_min, at_max) = (end(low, self.min[axis]), end(high, self.max[axis]));
            let (enter, exit) = if d > 0.0 {
                (at_min, at_max)
            } else {
                (at_max, at_min)
            };
            span = span.cut(enter, exit)?;
        }
        // A ray without a direction has not been clipped.
        span.enter.t.is_finite().then_some(span)
    }
}

/// The axis across the face of a hit, and whether it is the face at its end.
fn face(hit: &PrimHit) -> (usize, bool) {
    let facet = hit.surface.facet;
    ((facet / 2).min(2) as usize, facet % 2 == 1)
}

impl Primitive for Cuboid {
    fn kind(&self) -> &'static str {
        "box"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        check_finite("first corner of the box", self.min)?;
        check_finite("second corner of the box", self.max)?;
        if self.min.cmplt(self.max).all() {
            return Ok(());
        }
        Err(GeometryError::Degenerate {
            what: "box",
            why: "its first corner is not below its second on every axis",
        })
    }

    fn bounds(&self) -> Aabb {
        Aabb::new(self.min, self.max)
    }

    #[inline]
    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        self.span(ray, from)?.closest(range, from)
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let bare = self.bare_surface_at(ray, hit);
        let size = self.max - self.min;
        let part = (bare.position - self.min) / size;
        let sides = DMat3::from_diagonal(size);
        let (uv, dpdu, dpdv) = self.unfolding.at(face(hit), part, sides);
        SurfacePoint {
            uv,
            dpdu,
            dpdv,
            ..bare
        }
    }

    fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
        let (axis, at_max) = face(hit);
        // Exactly on the plane; the other coordinates are clamped, so that rounding does not move them off the face.
        let mut position = ray.at(hit.t).clamp(self.min, self.max);
        position[axis] = if at_max {
            self.max[axis]
        } else {
            self.min[axis]
        };
        let mut n = DVec3::ZERO;
        n[axis] = if at_max { 1.0 } else { -1.0 };
        *out = SurfacePoint::bare(position, point_error(position, 0.0, 1), n);
    }

    fn texture_uv(&self, _hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        Some(uv)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }

    /// A shift or a scaling along the axes makes a box of a box. A mirror would exchange facets and turn the texture
    /// round, so it does not count.
    fn baked(&self, map: &Transform) -> Option<Shape> {
        let m = map.linear();
        let scale = DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z);
        let along_the_axes = m == DMat3::from_diagonal(scale) && scale.cmpgt(DVec3::ZERO).all();
        let baked = Self {
            min: map.point_to_world(self.min),
            max: map.point_to_world(self.max),
            ..*self
        };
        along_the_axes.then(|| baked.into())
    }
}

impl FourLines for Cuboid {
    #[inline(always)]
    fn spans<I: Isa>(&self, isa: I, rays: &FourRays<I>) -> FourSpans {
        let zero = isa.splat(0.0);
        let (min, max) = (self.min.to_array(), self.max.to_array());
        let (mut enter, mut exit) = (isa.splat(f64::NEG_INFINITY), isa.splat(f64::INFINITY));
        let (mut along_faces, mut valid) = (0, 0b1111);
        let mut out = FourSpans::default();
        for axis in 0..3 {
            let (o, d) = (rays.origin[axis], rays.direction[axis]);
            along_faces |= isa.le(d, zero) & isa.le(zero, d);
            let at_min = isa.div(isa.sub(isa.splat(min[axis]), o), d);
            let at_max = isa.div(isa.sub(isa.splat(max[axis]), o), d);
            let near = isa.choose_le(d, zero, at_max, at_min);
            let far = isa.choose_le(d, zero, at_min, at_max);
            valid &= isa.le(near, far);
            // An edge belongs to the facet that was there first.
            let (before, behind) = (isa.lt(enter, near), isa.lt(far, exit));
            enter = isa.choose_le(near, enter, enter, near);
            exit = isa.choose_le(exit, far, exit, far);
            let forward = isa.lt(zero, d);
            let (low, high) = (2 * axis as u32, 2 * axis as u32 + 1);
            for lane in 0..LANES {
                let is = |mask: u32| mask >> lane & 1 == 1;
                let (first, last) = if is(forward) {
                    (low, high)
                } else {
                    (high, low)
                };
                if is(before) {
                    out.enter_facet[lane] = first;
                }
                if is(behind) {
                    out.exit_facet[lane] = last;
                }
            }
        }
        out.known = !along_faces & 0b1111;
        let finite =
            isa.lt(isa.splat(f64::NEG_INFINITY), enter) & isa.lt(enter, isa.splat(f64::INFINITY));
        out.met = out.known & valid & isa.lt(enter, exit) & finite;
        (out.enter, out.exit) = (isa.store(enter), isa.store(exit));
        out
    }
}

impl Solid for Cuboid {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let Some(span) = self.span(ray, from) else {
            return;
        };
        span.list(range, from, |end| self.t_error(ray, end), out);
    }

    fn contains(&self, point: DVec3) -> bool {
        self.bounds().contains(point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    crate::primitive_tests!(unit, || Cuboid::new(DVec3::ZERO, DVec3::ONE));
    crate::primitive_tests!(slab, || Cuboid::new(
        DVec3::new(-9.0, 2.0, 1.0),
        DVec3::new(7.0, 2.01, 3.0)
    ));

    fn closest(ray: &Ray, from: Option<u32>) -> Option<(f64, u32)> {
        let from = from.map(|facet| SurfaceId { element: 0, facet });
        Cuboid::new(DVec3::ZERO, DVec3::ONE)
            .closest_hit(ray, Interval::FORWARD, from, &mut Scratch::default())
            .map(|hit| (hit.t, hit.surface.facet))
    }

    #[test]
    fn each_face_has_its_number() {
        let center = DVec3::splat(0.5);
        for (facet, axis) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
            let facet = 2 * facet as u32;
            assert_eq!(closest(&Ray::new(center, -axis), None), Some((0.5, facet)));
            assert_eq!(
                closest(&Ray::new(center, axis), None),
                Some((0.5, facet + 1))
            );
            assert_eq!(
                closest(&Ray::new(center - axis * 2.5, axis), None),
                Some((2.0, facet))
            );
        }
    }

    #[test]
    fn a_ray_within_a_face_misses() {
        assert_eq!(
            closest(&Ray::new(DVec3::new(-1.0, 1.0, 0.5), DVec3::X), None),
            None
        );
        assert_eq!(
            closest(&Ray::new(DVec3::new(-1.0, 0.0, 0.0), DVec3::X), None),
            None
        );
    }

    #[test]
    fn the_face_a_ray_starts_on_is_not_hit_again() {
        // The origin is a little off the face, on the wrong side.
        let origin = DVec3::new(1.0 + 1e-15, 0.5, 0.5);
        assert_eq!(
            closest(&Ray::new(origin, -DVec3::X), Some(1)).map(|hit| hit.1),
            Some(0)
        );
        assert_eq!(
            closest(
                &Ray::new(DVec3::new(1.0 - 1e-15, 0.5, 0.5), DVec3::X),
                Some(1)
            ),
            None
        );
    }

    #[test]
    fn turned_boxes_are_not_baked() {
        let cuboid = Cuboid::new(DVec3::ZERO, DVec3::ONE);
        assert!(cuboid.baked(&Transform::rotate(DVec3::Z, 0.5)).is_none());
        assert!(cuboid.baked(&Transform::translate(DVec3::X)).is_some());
    }

    #[test]
    fn impossible_boxes_are_refused() {
        assert!(matches!(
            Cuboid::try_new(DVec3::ZERO, DVec3::X),
            Err(GeometryError::Degenerate { .. })
        ));
        assert!(
            Cuboid::from_corners(DVec3::ONE, DVec3::ZERO)
                .validate()
                .is_ok()
        );
    }
}
