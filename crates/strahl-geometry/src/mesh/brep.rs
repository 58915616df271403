use super::closed::{check_closed, sixfold_volume, welded};
use super::pass::pass_triangle;
use super::{MeshData, Polygon, RayShear, TriangleMesh, triangulate};
use crate::{
    Crossing, Crossings, GeometryError, PrimHit, Primitive, Scratch, Shape, Side, Solid, SurfaceId,
    SurfacePoint,
};
use std::sync::Arc;
use strahl_accel::{Accelerator, TraversalStats, Visitor};
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};

/// A solid bounded by triangles: a closed mesh with an inside (boundary representation).
///
/// Closed means: every edge is used as often in one direction as in the other. Vertices at the same position count as one, so
/// texture seams and unindexed triangles do no harm. The normals point outwards; a mesh that is inside out as a whole is
/// reversed. A point is inside if the surface winds around it, so parts may overlap, and shells with the opposite orientation
/// are cavities.
///
/// Elements are the triangles. At an edge or a corner a ray passes through those triangles that it would pass if it were
/// shifted by an infinitely small step, not through all of them, so entering and leaving alternate. Surfaces within the solid
/// (where parts overlap) are [`Side::Inner`]. Where a ray grazes an edge, entry and exit may be so close that rounding
/// exchanges them; then both are `Inner`, because there is no inside between them.
#[derive(Clone, Debug)]
pub struct Brep {
    mesh: TriangleMesh,
}

/// The direction of the ray that [`Solid::contains`] uses: not parallel to anything that occurs in scenes.
const ASKANCE: DVec3 = DVec3::new(0.526_438_109_1, 0.315_904_772_9, 0.789_365_214_7);

impl Brep {
    /// The solid within a closed mesh.
    ///
    /// # Errors
    /// The mesh is not closed or not oriented consistently (the message tells how many edges are unmatched, and which is the
    /// first), or it has no volume.
    pub fn try_new(mesh: TriangleMesh) -> Result<Self, GeometryError> {
        check_closed(&mesh)?;
        let volume = sixfold_volume(&mesh).ok_or(GeometryError::Degenerate {
            what: "brep",
            why: "it encloses no volume",
        })?;
        let mesh = if volume < 0.0 {
            mesh.turned_inside_out()
        } else {
            mesh
        };
        // Not only when the first ray comes.
        mesh.tree();
        Ok(Self { mesh })
    }

    /// The solid within polygons that share their edges. Corners are rounded to f32 (see [`MeshData::from_f64`]) and welded where
    /// they are equal; the triangles of a polygon follow each other, in the order of the polygons.
    ///
    /// # Errors
    /// As [`Brep::try_new`]; or a coordinate is too large for f32.
    pub fn try_from_polygons(polygons: &[Polygon]) -> Result<Self, GeometryError> {
        let (mut vertices, mut indices) = (Vec::new(), Vec::new());
        for polygon in polygons {
            let start = vertices.len() as u32;
            vertices.extend_from_slice(polygon.corners());
            indices.extend(
                triangulate(polygon)
                    .into_iter()
                    .map(|t| t.map(|v| start + v)),
            );
        }
        Self::try_new(TriangleMesh::try_new(welded(MeshData::from_f64(
            &vertices, indices,
        )))?)
    }

    /// The surface.
    pub const fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// Passes all passes of the ray through triangles that `range` accepts to the visitor.
    fn walk<F>(&self, ray: &Ray, range: Interval, from: Option<SurfaceId>, look: F)
    where
        F: FnMut(Pass, f64) -> f64,
    {
        let local = Ray::new(ray.origin - self.mesh.anchor(), ray.direction);
        let mut passes = Passes {
            mesh: &self.mesh,
            shear: RayShear::new(&local),
            range,
            skipped: from.map(|surface| surface.element),
            look,
        };
        self.mesh
            .tree()
            .traverse(&local, range, &mut passes, &mut TraversalStats::default());
    }

    /// A bound on the error of `t` where the ray passes through a triangle.
    fn t_error(&self, ray: &Ray, triangle: u32, t: f64) -> f64 {
        let [a, b, c] = self.mesh.local_corners(triangle);
        let origin = ray.origin - self.mesh.anchor();
        // The images of the corners have an error of a few roundings of the coordinates; the normal converts it to depth.
        let normal = (b - a).cross(c - a);
        let coordinates =
            origin.abs() + a.abs().max(b.abs()).max(c.abs()) + (ray.direction * t).abs();
        let sloped = gamma(8) * normal.abs().dot(coordinates) / normal.dot(ray.direction).abs();
        // Along the ray a hit never leaves the triangle.
        let depths = [a, b, c].map(|p| (p - origin).dot(ray.direction));
        let deepest = depths.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let nearest = depths.into_iter().fold(f64::INFINITY, f64::min);
        let whole = (deepest - nearest) / ray.direction.length_squared();
        let error = if sloped < whole { sloped } else { whole };
        error + gamma(8) * t.abs()
    }
}

/// One pass of a ray through a triangle.
#[derive(Clone, Copy)]
struct Pass {
    hit: PrimHit,
    enters: bool,
}

/// Tests triangles and calls `look` with each pass; it returns the `t` up to which further ones matter.
struct Passes<'a, F> {
    mesh: &'a TriangleMesh,
    /// Relative to the mesh's anchor.
    shear: RayShear,
    range: Interval,
    skipped: Option<u32>,
    look: F,
}

impl<F: FnMut(Pass, f64) -> f64> Visitor for Passes<'_, F> {
    #[inline]
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        if self.skipped == Some(id) {
            return t_max;
        }
        let [a, b, c] = self.mesh.sheared_corners(id, &self.shear);
        match pass_triangle(&self.shear, a, b, c) {
            Some((hit, front)) if self.range.accepts(hit.t) => {
                let surface = SurfaceId {
                    element: id,
                    facet: 0,
                };
                let hit = PrimHit {
                    t: hit.t,
                    surface,
                    uv: [hit.u, hit.v],
                };
                let enters = front != self.mesh.fronts_are_clockwise();
                (self.look)(Pass { hit, enters }, t_max)
            }
            _ => t_max,
        }
    }
}

impl Primitive for Brep {
    fn kind(&self) -> &'static str {
        "brep"
    }

    /// [`Brep::try_new`] has validated everything.
    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        self.mesh.bounds()
    }

    fn elements(&self) -> u32 {
        self.mesh.elements()
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let mut best: Option<PrimHit> = None;
        self.walk(ray, range, from, |Pass { hit, .. }, t_max| {
            let key = |hit: &PrimHit| (hit.t, hit.surface.element);
            if best.is_none_or(|best| key(&hit) < key(&best)) {
                best = Some(hit);
                hit.t
            } else {
                t_max
            }
        });
        best
    }

    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> bool {
        let mut found = false;
        self.walk(ray, range, from, |_, _| {
            found = true;
            f64::NEG_INFINITY
        });
        found
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        self.mesh.surface_at(ray, hit)
    }

    fn texture_uv(&self, hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        self.mesh.texture_uv(hit, uv)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }

    /// Any map will do, within the rounding of f32 (see [`TriangleMesh::transformed`]).
    fn baked(&self, map: &Transform) -> Option<Shape> {
        let brep = Self::try_new(self.mesh.transformed(map).ok()?).ok()?;
        Some(Arc::new(brep).into())
    }
}

impl Solid for Brep {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let min = if from.is_some() && range.min < 0.0 {
            0.0
        } else {
            range.min
        };
        // The crossings behind the end are needed, too: they show how often the surface winds around the start.
        let mut start = 0;
        self.walk(
            ray,
            Interval::new(min, f64::INFINITY),
            from,
            |Pass { hit, enters }, t_max| {
                start += if enters { -1 } else { 1 };
                if hit.t <= range.max {
                    let side = if enters { Side::Enter } else { Side::Exit };
                    out.list.push(Crossing::new(hit, 0.0, side));
                }
                t_max
            },
        );
        out.list.sort_unstable_by(|a, b| {
            let key = |c: &Crossing| (c.hit.t, c.hit.surface.element);
            key(a)
                .partial_cmp(&key(b))
                .unwrap_or(std::cmp::Ordering::Equal)
        });

        out.inside_at_start = start > 0;
        let mut winding = start;
        for crossing in &mut out.list {
            let before = winding;
            winding += if crossing.side == Side::Enter { 1 } else { -1 };
            crossing.side = match (before > 0, winding > 0) {
                (false, true) => Side::Enter,
                (true, false) => Side::Exit,
                _ => Side::Inner,
            };
            crossing.t_error = self.t_error(ray, crossing.hit.surface.element, crossing.hit.t);
        }
    }

    fn contains(&self, point: DVec3) -> bool {
        if !self.bounds().contains(point) {
            return false;
        }
        let local = point - self.mesh.anchor();
        let near = gamma(8) * (point.abs().max_element() + self.bounds().max_abs());
        let ray = Ray::new(local, ASKANCE);
        let mut count = Count {
            mesh: &self.mesh,
            point: local,
            near,
            shear: RayShear::new(&ray),
            on_surface: false,
            winding: 0,
        };
        // The triangles that the point may lie on are wanted too.
        let range = Interval::new(-2.0 * near, f64::INFINITY);
        self.mesh
            .tree()
            .traverse(&ray, range, &mut count, &mut TraversalStats::default());
        count.on_surface || count.winding > 0
    }
}

/// Counts how often the surface winds around a point.
struct Count<'a> {
    mesh: &'a TriangleMesh,
    /// Relative to the mesh's anchor, as everything here.
    point: DVec3,
    /// The distance that is zero up to rounding.
    near: f64,
    shear: RayShear,
    on_surface: bool,
    winding: i64,
}

impl Visitor for Count<'_> {
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        let [a, b, c] = self.mesh.local_corners(id);
        let reach = Aabb::from_points([a, b, c]).padded(DVec3::splat(self.near));
        if reach.contains(self.point)
            && (closest_point(self.point, a, b, c) - self.point).length() <= self.near
        {
            self.on_surface = true;
            return f64::NEG_INFINITY;
        }
        let [a, b, c] = [a, b, c].map(|p| self.shear.apply(&p));
        match pass_triangle(&self.shear, a, b, c) {
            Some((hit, front)) if hit.t > 0.0 => {
                let enters = front != self.mesh.fronts_are_clockwise();
                self.winding += if enters { -1 } else { 1 };
            }
            _ => {}
        }
        t_max
    }
}

/// The point of a triangle that is closest to `p`. (Ericson, Real-Time Collision Detection, section 5.1.5.)
fn closest_point(p: DVec3, a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let along = |q: DVec3| (ab.dot(p - q), ac.dot(p - q));
    let ((a1, a2), (b1, b2), (c1, c2)) = (along(a), along(b), along(c));
    // Corners and sides, by the Voronoi region that p is in.
    if a1 <= 0.0 && a2 <= 0.0 {
        return a;
    }
    if b1 >= 0.0 && b2 <= b1 {
        return b;
    }
    if c2 >= 0.0 && c1 <= c2 {
        return c;
    }
    let (of_c, of_b, of_a) = (a1 * b2 - b1 * a2, c1 * a2 - a1 * c2, b1 * c2 - c1 * b2);
    if of_c <= 0.0 && a1 >= 0.0 && b1 <= 0.0 {
        return a + ab * (a1 / (a1 - b1));
    }
    if of_b <= 0.0 && a2 >= 0.0 && c2 <= 0.0 {
        return a + ac * (a2 / (a2 - c2));
    }
    if of_a <= 0.0 && b2 >= b1 && c1 >= c2 {
        return b + (c - b) * ((b2 - b1) / ((b2 - b1) + (c1 - c2)));
    }
    let total = of_a + of_b + of_c;
    a + ab * (of_b / total) + ac * (of_c / total)
}
