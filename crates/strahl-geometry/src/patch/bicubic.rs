use super::bezier::{Bezier, is_on_a_line};
use super::elements;
use super::frame::Frame;
use super::hull::{points, project};
use super::net::Net;
use super::newton::Candidate;
use super::piece::PatchPlace;
use crate::primitives::point_error;
use crate::{GeometryError, PrimHit, Primitive, Scratch, Shape, SurfaceId, SurfacePoint};
use std::sync::Arc;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};

/// A bicubic Bezier patch, polynomial or rational: the surface
///
/// `S(u, v) = sum w_ij P_ij B_i(u) B_j(v) / sum w_ij B_i(u) B_j(v)` for `u` and `v` from 0 to 1,
///
/// with 4 by 4 control points `P`, positive weights `w` and the Bernstein polynomials `B` of degree 3 (Farin, Curves and Surfaces for
/// CAGD, chapters 14 and 17). It touches the four corner points; its border is made of the four Bezier curves of the outer control points.
///
/// Rays meet the surface itself, at any scale; nothing is replaced by triangles. It is an open surface without an inside. Texture
/// coordinates are `u` and `v`, or are interpolated between those given for the corners. The front is the side to which
/// `dS/dv x dS/du` points. The facet of a hit tells its place to 2⁻¹⁶ of `u` and `v`, so that a ray that leaves it finds other hits only.
///
/// Patches with a common border (the same four control points and weights, in either direction) close tightly: a ray through
/// the border meets exactly one of them, because both decide by the same computation on the curve. Edges and parts may be collapsed to
/// a point: the normal there is that of the surface beside it. Where all of the surface is seen as a line, a ray does not hit
/// it. A mirroring transform keeps the front where it moves it.
#[derive(Debug)]
pub struct BicubicPatch {
    pub(super) bezier: Bezier<4>,
    /// Texture coordinates of the corners `(0, 0)`, `(1, 0)`, `(1, 1)`, `(0, 1)`.
    corners: Option<[DVec2; 4]>,
    /// Whether the front is the other side, after a mirroring transform.
    is_flipped: bool,
}

/// Where a ray starts that leaves a patch.
fn start(from: Option<SurfaceId>) -> Option<PatchPlace> {
    from.map(|from| PatchPlace::of_facet(from.facet))
}

/// Control points are below this size: the products of three of them are finite.
pub(super) const LARGEST: f64 = 1e70;
/// The largest weight is at most so many times the least.
const WEIGHTS: f64 = 1e9;

impl BicubicPatch {
    /// The patch with these control points, `points[v][u]`.
    ///
    /// # Errors
    /// A point is not finite or beyond 1e70, or all points lie on a line.
    pub fn try_new(points: [[DVec3; 4]; 4]) -> Result<Self, GeometryError> {
        Self::try_rational(points, [[1.0; 4]; 4])
    }

    /// The rational patch with these control points and their weights, `points[v][u]`.
    ///
    /// # Errors
    /// As for [`BicubicPatch::try_new`], or a weight is not positive, or one is more than 1e9 times another.
    pub fn try_rational(
        points: [[DVec3; 4]; 4],
        weights: [[f64; 4]; 4],
    ) -> Result<Self, GeometryError> {
        let all = weights.as_flattened();
        for weight in all {
            let what = "weight of the bicubic patch";
            if !weight.is_finite() {
                return Err(GeometryError::NotFinite { what });
            }
            if *weight <= 0.0 {
                return Err(GeometryError::OutOfRange {
                    what,
                    expected: "greater than 0",
                    found: *weight,
                });
            }
        }
        let least = all.iter().copied().fold(f64::INFINITY, f64::min);
        if let Some(found) = all.iter().find(|w| **w > WEIGHTS * least) {
            return Err(GeometryError::OutOfRange {
                what: "weight of the bicubic patch",
                expected: "at most 1e9 times the least one",
                found: *found,
            });
        }
        let patch = Self::new(points, weights);
        patch.validate().map(|()| patch)
    }

    fn new(points: [[DVec3; 4]; 4], weights: [[f64; 4]; 4]) -> Self {
        let rows = std::array::from_fn(|j| {
            std::array::from_fn(|i| {
                let weight: f64 = weights[j][i];
                let point: DVec3 = points[j][i] * weight;
                [point.x, point.y, point.z, weight]
            })
        });
        Self {
            bezier: Bezier::new(Net { rows }),
            corners: None,
            is_flipped: false,
        }
    }

    /// Sets the texture coordinates of the corners, in the order `(0, 0)`, `(1, 0)`, `(1, 1)`, `(0, 1)` of `(u, v)`. Between
    /// them they are interpolated bilinearly.
    ///
    /// # Errors
    /// A coordinate is not finite.
    pub fn with_uv(mut self, corners: [DVec2; 4]) -> Result<Self, GeometryError> {
        if !corners.iter().all(|c| c.is_finite()) {
            return Err(GeometryError::NotFinite {
                what: "texture coordinate of the bicubic patch",
            });
        }
        self.corners = Some(corners);
        Ok(self)
    }

    /// The control points, `points[v][u]`.
    pub fn points(&self) -> [[DVec3; 4]; 4] {
        self.bezier.net.rows.map(|row| row.map(project))
    }

    /// The weights of the control points.
    pub fn weights(&self) -> [[f64; 4]; 4] {
        self.bezier.net.rows.map(|row| row.map(|p| p[3]))
    }

    /// The hit of a candidate, moved to the border if it is beyond.
    fn hit(candidate: &Candidate) -> PrimHit {
        PrimHit {
            t: candidate.t,
            surface: SurfaceId {
                element: 0,
                facet: PatchPlace::of(candidate.place()).facet(),
            },
            uv: candidate.place(),
        }
    }

    /// Texture coordinates with the derivatives of the point by them.
    fn textured(&self, uv: DVec2, by: [DVec3; 2]) -> (DVec2, [DVec3; 2]) {
        match self.corners {
            Some(corners) => elements::bilinear(corners, uv.to_array(), by),
            None => (uv, by),
        }
    }
}

impl Primitive for BicubicPatch {
    fn kind(&self) -> &'static str {
        "bicubic_patch"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        let index = |wanted: fn(&DVec3) -> bool| {
            let place = points(&self.bezier.net).position(|p| wanted(&p));
            place.map(|index| (index as u64, self.points().as_flattened()[index]))
        };
        let what = "control point of the bicubic patch";
        if let Some((index, _)) = index(|p| !p.is_finite()) {
            return Err(GeometryError::NotFiniteAt { what, index });
        }
        if let Some((_, point)) = index(|p| p.abs().max_element() > LARGEST) {
            return Err(GeometryError::OutOfRange {
                what: "coordinate of a control point of the bicubic patch",
                expected: "at most 1e70",
                found: point.abs().max_element(),
            });
        }
        if !is_on_a_line(points(&self.bezier.net)) {
            return Ok(());
        }
        Err(GeometryError::Degenerate {
            what: "bicubic patch",
            why: "its control points lie on a line",
        })
    }

    fn bounds(&self) -> Aabb {
        self.bezier.bounds
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let frame = Frame::new(ray)?;
        let nearest = self.bezier.nearest((&frame, start(from)), range, None);
        nearest.map(|candidate| Self::hit(&candidate))
    }

    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> bool {
        Frame::new(ray).is_some_and(|frame| self.bezier.any((&frame, start(from)), range, None))
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let uv = DVec2::from_array(hit.uv);
        let jet = self.bezier.jet(uv.x, uv.y);
        let normal = self.bezier.normal(uv, jet).map_or_else(
            || elements::against(ray),
            |front| if self.is_flipped { -front } else { front },
        );
        let [position, by_u, by_v] = jet;
        let (uv, [dpdu, dpdv]) = self.textured(uv, [by_u, by_v]);
        let error = point_error(position, self.bezier.bounds.max_abs(), 64);
        SurfacePoint {
            uv,
            dpdu,
            dpdv,
            ..SurfacePoint::bare(position, error, normal)
        }
    }

    fn texture_uv(&self, _hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        Some(uv)
    }

    fn baked(&self, map: &Transform) -> Option<Shape> {
        let points = self.points().map(|row| row.map(|p| map.point_to_world(p)));
        let mut mapped = Self::new(points, self.weights());
        // Far away from the origin the coordinates would lose its shape.
        if !elements::keeps_its_shape(&mapped.bounds()) || mapped.validate().is_err() {
            return None;
        }
        mapped.corners = self.corners;
        mapped.is_flipped = self.is_flipped != map.mirrors();
        Some(Arc::new(mapped).into())
    }
}
