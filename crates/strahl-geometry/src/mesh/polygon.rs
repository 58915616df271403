use super::axes::{largest_axis, other_axes};
use super::edge_runs::EdgeRuns;
use super::shear::RayShear;
use crate::primitives::Unfolding;
use crate::{Cuboid, GeometryError, PrimHit, Primitive, Scratch, Shape, SurfaceId, SurfacePoint};
use strahl_math::error::{ROUNDOFF, gamma};
use strahl_math::{Aabb, DMat3, DVec2, DVec3, Interval, Ray, Transform};

/// The largest distance of corners from the polygon's plane, relative to the largest coordinate: 2⁻¹⁶, some thirty times the
/// error of coordinates printed with six digits.
const PLANARITY: f64 = 1.0 / 65_536.0;

/// Polygons with more edges than this have boxes around runs of edges.
const MANY_EDGES: usize = 8;

/// A flat polygon with any number of corners, concave or touching itself if need be, possibly with holes.
///
/// The even-odd rule decides what is inside: an outer ring and hole rings, which may have any orientation, and islands in
/// holes. The front is the side from which the first ring runs counter-clockwise; rays hit it from both sides.
///
/// The plane gives `t`; the corners are then projected *along the ray*, and the edges that cross a half-line from the
/// ray's image are counted, by comparing products. A corner that two polygons share has the same image for both, so exactly one of two
/// neighbours gets a ray along their common edge, whether they lie in one plane or not: there is no crack (where edges
/// meet corner to corner). Before that the hit is projected on the principal plane, where most points are certainly on one side of all
/// edges; the first method decides what is too near an edge to tell there. For polygons with more than 8 edges boxes around runs of
/// edges leave few of them to look at.
///
/// Corners need not be in the plane exactly (see [`Polygon::try_new`]); the plane goes through the first one with the normal
/// of Newell's method, and `position_error` covers how far the others are off it.
///
/// Texture coordinates: the first corner is `(0, 0)`, the second `(1, 0)`, and the last one of the first ring `(0, 1)`, so that they
/// cover a parallelogram once. (Not the last one itself, if it is much closer to the line through the first two than others.)
/// [`Polygon::flat_box`] has those of a box.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// All rings, one after the other.
    corners: Box<[DVec3]>,
    /// Where each ring but the last ends.
    ring_ends: Box<[u32]>,
    /// Unit normal of the front.
    normal: DVec3,
    /// The largest distance of a corner from the plane.
    deviation: f64,
    /// A bound of the sum of the absolute coordinates of all points.
    reach: f64,
    /// The corner with texture coordinates `(0, 1)`.
    up: u32,
    /// The axis along which the normal is longest: that of the principal plane.
    axis: u8,
    /// Whether the first ring runs clockwise as seen from the front, as it does after a mirroring transform.
    flipped: bool,
    /// The flat box that this polygon is, if it has the texture coordinates of one.
    flat_box: Option<FlatBox>,
    pub(super) runs: Option<Box<EdgeRuns>>,
}

/// A box without extent along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct FlatBox {
    axis: u8,
    unfolding: Unfolding,
}

/// Where a ray crosses the plane of a polygon.
#[derive(Clone, Copy, Debug)]
pub struct PlaneHit {
    pub(crate) t: f64,
    /// A bound of its error.
    pub(crate) error: f64,
}

/// The plane and the extent of a polygon.
pub(crate) struct PolygonPlane {
    /// Unit normal of the front.
    pub(crate) normal: DVec3,
    /// A point of the plane.
    pub(crate) corner: DVec3,
    /// The box around the corners.
    pub(crate) bounds: Aabb,
    /// The largest distance of a corner from the plane.
    pub(crate) deviation: f64,
    /// A bound of the sum of the absolute coordinates of all points.
    pub(crate) reach: f64,
}

impl Polygon {
    /// A polygon without holes. The last corner may repeat the first.
    ///
    /// # Errors
    /// A corner is not finite; fewer than three are different; there is no area (or the polygon crosses itself so that
    /// its parts cancel); a corner is off the plane by more than 2⁻¹⁶ of the largest coordinate, which leaves room for numbers
    /// printed with six digits.
    pub fn try_new(corners: &[DVec3]) -> Result<Self, GeometryError> {
        Self::try_with_holes(corners, &[])
    }

    /// A polygon with holes: rings in the same plane, of either orientation.
    ///
    /// # Errors
    /// As [`Polygon::try_new`], for each ring.
    pub fn try_with_holes(outer: &[DVec3], holes: &[Vec<DVec3>]) -> Result<Self, GeometryError> {
        let mut corners = Vec::with_capacity(outer.len());
        let mut ring_ends = Vec::with_capacity(holes.len());
        for ring in std::iter::once(outer).chain(holes.iter().map(Vec::as_slice)) {
            if !corners.is_empty() {
                ring_ends.push(corners.len() as u32);
            }
            append_ring(ring, &mut corners)?;
        }
        if corners.len() as u64 > u64::from(u32::MAX) {
            return Err(GeometryError::IndexOutOfRange {
                what: "corner",
                index: corners.len() as u64 - 1,
                count: u64::from(u32::MAX),
            });
        }
        let (corners, ring_ends) = (corners.into_boxed_slice(), ring_ends.into_boxed_slice());
        let first_ring = corners
            .len()
            .min(ring_ends.first().map_or(usize::MAX, |&end| end as usize));
        let up = texture_corner(&corners[..first_ring]);
        let polygon = Self::from_parts(corners, ring_ends, up, false).ok_or(GeometryError::Degenerate {
            what: "polygon",
            why: "it has no area: its corners lie on a line, or it crosses itself and its parts cancel",
        })?;
        if polygon.deviation > PLANARITY * polygon.bounds().max_abs() {
            return Err(GeometryError::OutOfRange {
                what: "distance of a corner from the polygon's plane",
                expected: "within 1/65536 of the largest coordinate (split the polygon into triangles)",
                found: polygon.deviation,
            });
        }
        Ok(polygon)
    }

    /// The sheet that a box without extent along an axis (0 to 2) is: a rectangle at the `max` of this axis. Its front shows to larger
    /// coordinates.
    ///
    /// Texture coordinates are those of a [`Cuboid`](crate::Cuboid). A ray sees the face that is turned away from it, as in POV-Ray
    /// (measured): from above the bottom, from below the top.
    ///
    /// # Errors
    /// A corner is not finite, or the box has no extent along another axis.
    pub fn flat_box(cuboid: &Cuboid, axis: usize) -> Result<Self, GeometryError> {
        let (min, max) = (cuboid.min(), cuboid.max());
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let corners = [(false, false), (true, false), (true, true), (false, true)].map(|(s, t)| {
            let mut corner = max;
            corner[u] = if s { max[u] } else { min[u] };
            corner[v] = if t { max[v] } else { min[v] };
            corner
        });
        let mut sheet = Self::try_new(&corners)?;
        sheet.flat_box = Some(FlatBox {
            axis: axis as u8,
            unfolding: cuboid.unfolding(),
        });
        Ok(sheet)
    }

    /// Works out the plane and the runs; `None` if there is no plane.
    fn from_parts(
        corners: Box<[DVec3]>,
        ring_ends: Box<[u32]>,
        up: u32,
        flipped: bool,
    ) -> Option<Self> {
        let mut polygon = Self {
            corners,
            ring_ends,
            normal: DVec3::ZERO,
            deviation: 0.0,
            reach: 0.0,
            up,
            axis: 0,
            flipped,
            flat_box: None,
            runs: None,
        };
        let front = newell_normal(polygon.rings().next()?)?;
        polygon.normal = if flipped { -front } else { front };
        polygon.axis = largest_axis(front) as u8;
        let off_plane = |p: &DVec3| polygon.normal.dot(*p - polygon.corners[0]).abs();
        polygon.deviation = polygon.corners.iter().map(off_plane).fold(0.0, f64::max);
        let largest = polygon
            .corners
            .iter()
            .fold(DVec3::ZERO, |m, p| m.max(p.abs()));
        polygon.reach = largest.element_sum();
        if polygon.corners.len() > MANY_EDGES {
            polygon.runs = Some(Box::new(EdgeRuns::build(
                polygon.rings(),
                polygon.axis.into(),
            )));
        }
        Some(polygon)
    }

    /// The corners of all rings, one ring after the other.
    pub fn corners(&self) -> &[DVec3] {
        &self.corners
    }

    /// The rings: the outer one, then the holes.
    pub fn rings(&self) -> impl Iterator<Item = &[DVec3]> {
        let all = self.corners.len();
        let ends = self.ring_ends.iter().map(|&end| end as usize);
        let starts = std::iter::once(0).chain(ends.clone());
        // Ends ascend and are no more than `all`.
        starts
            .zip(ends.chain([all]))
            .map(|(start, end)| &self.corners[start..end])
    }

    /// The unit normal of the front.
    pub const fn normal(&self) -> DVec3 {
        self.normal
    }

    /// The data of the culling test.
    pub(crate) fn plane(&self) -> PolygonPlane {
        PolygonPlane {
            normal: self.normal,
            corner: self.corners[0],
            bounds: self.bounds(),
            deviation: self.deviation,
            reach: self.reach,
        }
    }

    /// The ray parameter of the hit, if the ray's line passes through the polygon; `None` also if it certainly is not in the
    /// range.
    #[inline]
    fn pierced_at(&self, ray: &Ray, range: Interval) -> Option<f64> {
        let along = self.normal.dot(ray.direction);
        let first = self.corners[0];
        let t = self.normal.dot(first - ray.origin) / along;
        if !t.is_finite() {
            return None; // Edge-on.
        }
        // A bound of the distance of the point at `t` from the polygon's point, which is within `reach`, and of the error of
        // `t`.
        let reach = l1(ray.origin) + t.abs() * l1(ray.direction) + self.reach;
        let error = (self.deviation + gamma(64) * reach) / along.abs();
        if t + error < range.min || t - error > range.max {
            return None;
        }
        self.pierced_in_plane(ray, PlaneHit { t, error })
    }

    /// The ray parameter of the hit in a range, given the crossing of the ray's line with the plane.
    #[inline]
    pub fn hit_in_plane(&self, ray: &Ray, range: Interval, at: PlaneHit) -> Option<f64> {
        self.pierced_in_plane(ray, at).filter(|t| range.accepts(*t))
    }

    #[inline]
    fn pierced_in_plane(&self, ray: &Ray, at: PlaneHit) -> Option<f64> {
        let t = at.t;
        // The projections along the ray and on the principal plane differ by less than this.
        let error = at.error * l1(ray.direction);
        if let Some(runs) = &self.runs {
            if let Some(inside) = runs.locate(ray.at(t), error) {
                return inside.then_some(t);
            }
        } else if let Some(inside) = self.locate(ray.at(t), error) {
            return if inside {
                self.within_height(ray, t)
            } else {
                None
            };
        }
        if !self.surrounds(&RayShear::new(ray)) {
            return None;
        }
        // Seen nearly edge-on, the `t` of the plane is inexact, but the hit is certainly within the bounds.
        let span = self.bounds().clip(ray, Interval::LINE)?;
        Some(t.clamp(span.min, span.max))
    }

    /// Whether a point of the plane that is known up to `error` in each coordinate is inside, decided in the principal plane;
    /// `None` if the error might change the answer. Otherwise all points within the error are on the same side of the lines
    /// through all edges.
    #[inline]
    fn locate(&self, point: DVec3, error: f64) -> Option<bool> {
        match self.axis {
            0 => self.locate_in::<1, 2>(point, error),
            1 => self.locate_in::<2, 0>(point, error),
            _ => self.locate_in::<0, 1>(point, error),
        }
    }

    /// The same in the plane of two axes.
    #[inline]
    fn locate_in<const I: usize, const J: usize>(&self, point: DVec3, error: f64) -> Option<bool> {
        let at = point.to_array();
        let (x, y) = (at[I], at[J]);
        let (mut odd, mut certain) = (false, true);
        let mut look = |ring: &[DVec3]| {
            let Some(last) = ring.last().map(DVec3::to_array) else {
                return;
            };
            let (mut ax, mut ay) = (last[I] - x, last[J] - y);
            // No early exit: which edge is crossed or near can't be predicted.
            for corner in ring {
                let corner = corner.to_array();
                let (bx, by) = (corner[I] - x, corner[J] - y);
                let cross = ax * by - ay * bx;
                certain &= cross.abs() > error * ((bx - ax).abs() + (by - ay).abs());
                odd ^= ((ay > 0.0) != (by > 0.0)) & ((cross > 0.0) == (by > ay));
                (ax, ay) = (bx, by);
            }
        };
        if self.ring_ends.is_empty() {
            look(&self.corners);
        } else {
            self.rings().for_each(look);
        }
        certain.then_some(odd)
    }

    /// The `t` within the bounds, as [`Aabb::clip`] finds them, that is closest to `t`, for a hit that is certainly inside in
    /// the principal plane: the rounding of `t` may have moved it out along the third axis only.
    #[inline]
    fn within_height(&self, ray: &Ray, t: f64) -> Option<f64> {
        let k = usize::from(self.axis);
        let height = |p: &DVec3| AsRef::<[f64; 3]>::as_ref(p)[k];
        let (mut low, mut high) = (height(&self.corners[0]), height(&self.corners[0]));
        for corner in &self.corners[1..] {
            let h = height(corner);
            low = if h < low { h } else { low };
            high = if h > high { h } else { high };
        }
        let span = Aabb::clip_axis([low, high], ray.origin[k], ray.direction[k], Interval::LINE)?;
        (span.min <= span.max).then(|| t.clamp(span.min, span.max))
    }

    /// Whether the ray's line passes through the polygon, decided in the ray's projection.
    #[inline]
    fn surrounds(&self, shear: &RayShear) -> bool {
        let mut odd = false;
        for ring in self.rings() {
            let Some(last) = ring.last() else { continue };
            let mut a = shear.apply(last);
            for corner in ring {
                let b = shear.apply(corner);
                odd ^= crosses_half_axis(a, b);
                a = b;
            }
        }
        odd
    }
}

impl Primitive for Polygon {
    fn kind(&self) -> &'static str {
        "polygon"
    }

    /// [`Polygon::try_new`] has validated everything.
    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        Aabb::from_points(self.corners.iter().copied())
    }

    #[inline]
    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        if from.is_some() {
            return None; // A ray does not come back to the plane it starts from.
        }
        let t = self.pierced_at(ray, range)?;
        range.accepts(t).then_some(PrimHit::simple(t, 0))
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let bare = self.bare_surface_at(ray, hit);
        let origin = self.corners[0];
        // Coordinates with respect to two sides, solved in the principal plane.
        let (i, j) = other_axes(self.axis.into());
        let (right, up) = (
            self.corners[1] - origin,
            self.corners[self.up as usize] - origin,
        );
        let area = right[i] * up[j] - right[j] * up[i];
        let p = bare.position - origin;
        let uv = DVec2::new(
            p[i] * up[j] - p[j] * up[i],
            right[i] * p[j] - right[j] * p[i],
        ) / area;
        let (uv, dpdu, dpdv) = match self.flat_box {
            None => (uv, right, up),
            Some(FlatBox { axis, unfolding }) => {
                let axis = usize::from(axis);
                let part = cyclic(axis, [0.0, uv.x, uv.y]);
                let [x, y, z] = cyclic(axis, [DVec3::ZERO, right, up]);
                let at_max = self.normal.dot(ray.direction) > 0.0;
                let (part, sides) = (DVec3::from_array(part), DMat3::from_cols(x, y, z));
                unfolding.at((axis, at_max), part, sides)
            }
        };
        SurfacePoint {
            uv,
            dpdu,
            dpdv,
            ..bare
        }
    }

    fn texture_uv(&self, _hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        self.flat_box.map(|_| uv)
    }

    fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
        let n = self.normal;
        let at = ray.at(hit.t);
        let aside = at - self.corners[0];
        let position = at - n * n.dot(aside);
        let noise = gamma(8) * n.abs().dot(aside.abs()) + self.deviation;
        let error = n.abs() * noise + position.abs() * (2.0 * ROUNDOFF);
        *out = SurfacePoint::bare(position, error, n);
    }

    fn baked(&self, map: &Transform) -> Option<Shape> {
        let corners = self
            .corners
            .iter()
            .map(|&p| map.point_to_world(p))
            .collect();
        let flipped = self.flipped != map.mirrors();
        let mut baked = Self::from_parts(corners, self.ring_ends.clone(), self.up, flipped)?;
        baked.flat_box = self.flat_box;
        Some(baked.into())
    }
}

/// The triangles `0 1 2`, `0 2 3`, ... of a ring of `n` corners, as NFF patches with normals are split.
///
/// Correct for convex rings, and for those that are completely visible from corner 0. The triangles of other concave rings
/// overlap or reach outside; use [`triangulate`](super::triangulate) for those.
pub fn fan_triangles(n: u32) -> impl Iterator<Item = [u32; 3]> {
    (1..n.saturating_sub(1)).map(|i| [0, i, i + 1])
}

/// Whether an edge crosses the positive half of the x axis. The same for both directions of the edge.
///
/// Ends with `y = 0` count as below, and an edge through the origin does not cross: so a point on an edge belongs to
/// one side of it only.
#[inline]
fn crosses_half_axis(a: DVec3, b: DVec3) -> bool {
    if (a.y > 0.0) == (b.y > 0.0) {
        return false;
    }
    let (p, q) = (a.x * b.y, a.y * b.x);
    if b.y > a.y { p > q } else { q > p }
}

/// Appends a ring, without repetitions of a corner in a row.
fn append_ring(ring: &[DVec3], corners: &mut Vec<DVec3>) -> Result<(), GeometryError> {
    let start = corners.len();
    for (index, &corner) in ring.iter().enumerate() {
        if !corner.is_finite() {
            return Err(GeometryError::NotFiniteAt {
                what: "corner of the polygon",
                index: index as u64,
            });
        }
        if corners.len() == start || corners.last() != Some(&corner) {
            corners.push(corner);
        }
    }
    while corners.len() > start + 1 && corners.last() == corners.get(start) {
        corners.pop();
    }
    if corners.len() < start + 3 {
        return Err(GeometryError::Degenerate {
            what: "polygon",
            why: "a ring has fewer than three different corners",
        });
    }
    Ok(())
}

/// The unit normal of a ring by Newell's method (Sutherland, Sproull, Schumacker 1974): the sum of the triangles with corner 0.
fn newell_normal(ring: &[DVec3]) -> Option<DVec3> {
    let first = *ring.first()?;
    let size = ring
        .iter()
        .fold(0.0, |m: f64, p| m.max((*p - first).abs().max_element()));
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    let (mut sum, mut magnitude) = (DVec3::ZERO, 0.0);
    for pair in ring.windows(2) {
        let (a, b) = ((pair[0] - first) / size, (pair[1] - first) / size);
        sum += a.cross(b);
        magnitude += l1(a) * l1(b);
    }
    let length = sum.length();
    // Less area than the coordinates' own rounding could make.
    let coordinate = ring
        .iter()
        .fold(0.0, |m: f64, p| m.max(p.abs().max_element()))
        / size;
    let noise = gamma(4) * (magnitude + coordinate * ring.len() as f64);
    (length > noise).then(|| sum / length)
}

/// The last corner that is at least half as far from the line through the first two as the farthest.
fn texture_corner(ring: &[DVec3]) -> u32 {
    let &[first, second, ..] = ring else { return 0 };
    let height = |p: &DVec3| (second - first).cross(*p - first).length();
    let highest = ring.iter().map(height).fold(0.0, f64::max);
    ring.iter()
        .rposition(|p| height(p) >= 0.5 * highest)
        .unwrap_or(0) as u32
}

/// The values of the x, y and z axes, given those of `axis` and of the two axes that follow it.
fn cyclic<T: Copy>(axis: usize, from_axis: [T; 3]) -> [T; 3] {
    std::array::from_fn(|i| from_axis[(i + 3 - axis) % 3])
}

fn l1(v: DVec3) -> f64 {
    let v = v.abs();
    v.x + v.y + v.z
}
