//! The geometry that the builders of accelerators may use beyond boxes.

use super::assemble::Assembled;
use super::cut;
use crate::blocks::LeafClass;
use crate::prim::PrimKind;
use strahl_accel::{Shapes, cut_box};
use strahl_geometry::Shape;
use strahl_math::{Aabb, DVec3};

/// The primitives of a group.
pub(super) struct GroupShapes<'a>(pub(super) &'a Assembled);

/// A primitive, if its builder can use more than its box.
enum Known<'a> {
    Corners([DVec3; 3]),
    Polygon(&'a [DVec3]),
    Ball(DVec3, f64),
    Frustum(Frustum),
    Box(Aabb),
    Nothing,
}

impl GroupShapes<'_> {
    fn known(&self, id: u32) -> Known<'_> {
        let group = self.0;
        match group.prims.at(id).kind() {
            PrimKind::Triangle(mesh, triangle) => {
                Known::Corners(group.meshes[mesh as usize].mesh.corners(triangle))
            }
            PrimKind::Sphere(number) => {
                let sphere = group.spheres.loose(number);
                Known::Ball(sphere.center(), sphere.radius())
            }
            PrimKind::Shape(index) => match &group.shapes[index as usize].shape {
                Shape::Sphere(s) => Known::Ball(s.center(), s.radius().abs()),
                Shape::Cylinder(c) => {
                    Known::Frustum(Frustum([(c.base(), c.radius()), (c.apex(), c.radius())]))
                }
                Shape::Cone(c) => Known::Frustum(Frustum([
                    (c.base(), c.base_radius()),
                    (c.apex(), c.apex_radius()),
                ])),
                Shape::Cuboid(_) => Known::Box(self.bounds(id)),
                Shape::Polygon(p) => {
                    // The outer ring comes first; holes are ignored, which is conservative.
                    p.rings().next().map_or(Known::Nothing, Known::Polygon)
                }
                _ => Known::Nothing,
            },
            PrimKind::Placed(_) | PrimKind::Instance(_) => Known::Nothing,
        }
    }
}

impl Shapes for GroupShapes<'_> {
    fn count(&self) -> usize {
        self.0.prims.len()
    }

    fn bounds(&self, id: u32) -> Aabb {
        self.0.prim_bounds[id as usize]
    }

    fn class(&self, id: u32) -> u8 {
        let group = self.0;
        LeafClass::of(group.prims.at(id), &group.lists()) as u8
    }

    fn overlaps(&self, id: u32, cell: &Aabb) -> bool {
        match self.known(id) {
            Known::Corners(corners) => triangle_meets(&corners, cell),
            Known::Polygon(corners) => polygon_meets(corners, cell),
            Known::Ball(center, radius) => {
                let (nearest, farthest) = distances(center, cell);
                nearest <= radius && radius <= farthest
            }
            Known::Frustum(frustum) => frustum.meets(cell) && !frustum.surrounds(cell),
            Known::Box(b) => {
                let inside = b.min.cmplt(cell.min).all() && cell.max.cmplt(b.max).all();
                !inside
            }
            Known::Nothing => true,
        }
    }

    fn halves(&self, id: u32, part: &Aabb, axis: usize, at: f64) -> [Aabb; 2] {
        match self.known(id) {
            Known::Corners(corners) => cut::halves(&corners, part, axis, at),
            Known::Polygon(corners) => cut::halves(corners, part, axis, at),
            _ => cut_box(part, axis, at),
        }
    }

    fn flat_area(&self, id: u32) -> Option<f64> {
        match self.known(id) {
            Known::Corners(corners) => Some(cut::flat_area(&corners)),
            Known::Polygon(corners) => Some(cut::flat_area(corners)),
            _ => None,
        }
    }

    fn sphere(&self, id: u32) -> Option<(DVec3, f64)> {
        match self.known(id) {
            Known::Corners(corners) => Some(ball_of_triangle(&corners)),
            Known::Polygon(corners) => {
                let center = corners.iter().sum::<DVec3>() / corners.len() as f64;
                Some((center, reach(center, corners)))
            }
            Known::Ball(center, radius) => Some((center, radius)),
            Known::Frustum(frustum) => Some(frustum.ball()),
            Known::Box(_) | Known::Nothing => None,
        }
    }
}

/// The primitives with a flag; the others count as empty.
pub(super) struct Flagged<'a> {
    pub(super) all: GroupShapes<'a>,
    pub(super) flag: u8,
}

impl Shapes for Flagged<'_> {
    fn count(&self) -> usize {
        self.all.count()
    }

    fn bounds(&self, id: u32) -> Aabb {
        if self.all.0.prims.at(id).flags & self.flag == 0 {
            return Aabb::EMPTY;
        }
        self.all.bounds(id)
    }

    fn class(&self, id: u32) -> u8 {
        self.all.class(id)
    }

    fn overlaps(&self, id: u32, cell: &Aabb) -> bool {
        self.all.overlaps(id, cell)
    }

    fn halves(&self, id: u32, part: &Aabb, axis: usize, at: f64) -> [Aabb; 2] {
        self.all.halves(id, part, axis, at)
    }

    fn flat_area(&self, id: u32) -> Option<f64> {
        self.all.flat_area(id)
    }

    fn sphere(&self, id: u32) -> Option<(DVec3, f64)> {
        self.all.sphere(id)
    }
}

/// Distances of a point from the nearest and the farthest point of a box.
fn distances(p: DVec3, b: &Aabb) -> (f64, f64) {
    let (below, above) = (b.min - p, p - b.max);
    let nearest = below.max(above).max(DVec3::ZERO);
    let farthest = below.abs().max(above.abs());
    (nearest.length(), farthest.length())
}

/// Whether a triangle meets a box: none of the axes separates them, neither the normals of the two nor the products of their
/// edges (Akenine-Möller: Fast 3D triangle-box overlap testing, 2001). The accelerators pad the boxes by more than the rounding
/// error here.
fn triangle_meets(corners: &[DVec3; 3], cell: &Aabb) -> bool {
    let (center, half) = (cell.center(), cell.size() * 0.5);
    let v = corners.map(|c| c - center);
    let edges = [v[1] - v[0], v[2] - v[1], v[0] - v[2]];
    let separates = |axis: DVec3| {
        let [a, b, c] = v.map(|v| v.dot(axis));
        let reach = half.dot(axis.abs());
        a.min(b).min(c) > reach || a.max(b).max(c) < -reach
    };
    let units = [DVec3::X, DVec3::Y, DVec3::Z];
    !(units.into_iter().any(separates)
        || separates(edges[0].cross(edges[1]))
        || units
            .into_iter()
            .any(|unit| edges.into_iter().any(|edge| separates(unit.cross(edge)))))
}

/// Whether a flat polygon meets a box: clipped by the six planes it is not empty. A polygon that is not convex may leave an
/// empty bridge, which is conservative. (Sutherland and Hodgman: Reentrant polygon clipping, 1974.)
fn polygon_meets(corners: &[DVec3], cell: &Aabb) -> bool {
    let mut left = corners.to_vec();
    let mut next = Vec::with_capacity(left.len() + 6);
    for axis in 0..3 {
        for (plane, sign) in [(cell.min[axis], 1.0), (cell.max[axis], -1.0)] {
            let height = |p: &DVec3| (p[axis] - plane) * sign;
            next.clear();
            for (i, b) in left.iter().enumerate() {
                let a = &left[(i + left.len() - 1) % left.len()];
                let (ha, hb) = (height(a), height(b));
                if (ha < 0.0) != (hb < 0.0) {
                    next.push(*a + (*b - *a) * (ha / (ha - hb)));
                }
                if hb >= 0.0 {
                    next.push(*b);
                }
            }
            std::mem::swap(&mut left, &mut next);
        }
    }
    !left.is_empty()
}

/// The convex hull of two discs perpendicular to a common axis, given by centre and radius: a cylinder or a cone.
struct Frustum([(DVec3, f64); 2]);

impl Frustum {
    fn axis(&self) -> DVec3 {
        let [(base, _), (apex, _)] = self.0;
        apex - base
    }

    /// Whether it may meet a box: none of the directions tried separates them. These are the axis and normals of the side: the
    /// one towards the box, and those perpendicular to an edge of the box. The normals of the box are left out, because the
    /// accelerators have compared the boxes.
    fn meets(&self, cell: &Aabb) -> bool {
        let axis = self.axis().normalize_or_zero();
        let (center, half) = (cell.center(), cell.size() * 0.5);
        let separates = |direction: DVec3| {
            let reach = half.dot(direction.abs());
            let across = (direction - axis * axis.dot(direction)).length();
            let discs = self.0.map(|(at, radius)| {
                let (middle, radius) = ((at - center).dot(direction), radius * across);
                (middle - radius, middle + radius)
            });
            discs.iter().all(|(low, _)| *low > reach)
                || discs.iter().all(|(_, high)| *high < -reach)
        };
        let [(base, base_radius), (_, apex_radius)] = self.0;
        let away = center - base;
        let out = (away - axis * axis.dot(away)).normalize_or_zero();
        let [x, y, z] =
            [DVec3::X, DVec3::Y, DVec3::Z].map(|edge| edge.cross(axis).normalize_or_zero());
        let (length, narrower) = (self.axis().length(), base_radius - apex_radius);
        let side = |across: DVec3| across * length + axis * narrower;
        let mut sides = [out, x, -x, y, -y, z, -z].into_iter().map(side);
        !(separates(axis) || sides.any(separates))
    }

    /// Whether a box certainly lies inside: all its corners do, and it contains no part of the surface.
    fn surrounds(&self, cell: &Aabb) -> bool {
        let [(base, base_radius), (_, apex_radius)] = self.0;
        let axis = self.axis();
        let square = axis.length_squared();
        cell.corners().into_iter().all(|corner| {
            let away = corner - base;
            let height = away.dot(axis) / square;
            let from_axis = (away - axis * height).length();
            0.0 < height
                && height < 1.0
                && from_axis < base_radius + height * (apex_radius - base_radius)
        })
    }

    /// The smallest ball around both discs.
    fn ball(&self) -> (DVec3, f64) {
        let [(base, base_radius), (apex, apex_radius)] = self.0;
        let square = self.axis().length_squared();
        let wider = (apex_radius * apex_radius - base_radius * base_radius) / square;
        let center = base + self.axis() * (0.5 * (1.0 + wider)).clamp(0.0, 1.0);
        let to_rim =
            |at: DVec3, radius: f64| ((at - center).length_squared() + radius * radius).sqrt();
        let (a, b) = (to_rim(base, base_radius), to_rim(apex, apex_radius));
        let radius = if a > b { a } else { b };
        (center, radius * (1.0 + 8.0 * f64::EPSILON))
    }
}

/// The smallest ball around a triangle: around its longest edge, or through its corners.
fn ball_of_triangle(corners: &[DVec3; 3]) -> (DVec3, f64) {
    let mut best = (DVec3::ZERO, f64::INFINITY);
    let [a, b, c] = *corners;
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let through = normal.cross(ab) * ac.length_squared() + ac.cross(normal) * ab.length_squared();
    let centers = [
        (a + b) * 0.5,
        (b + c) * 0.5,
        (c + a) * 0.5,
        a + through / (2.0 * normal.length_squared()),
    ];
    for center in centers {
        let radius = reach(center, corners);
        // Without an area the last centre is NaN, and NaN is not less.
        if radius < best.1 {
            best = (center, radius);
        }
    }
    best
}

/// The largest distance of the points from a centre, rounded up.
fn reach(center: DVec3, points: &[DVec3]) -> f64 {
    let mut farthest = 0.0;
    for p in points {
        let distance = (*p - center).length();
        if !(distance <= farthest) {
            farthest = distance;
        }
    }
    farthest * (1.0 + 8.0 * f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn cell(x: f64, y: f64, z: f64) -> Aabb {
        Aabb::new(DVec3::new(x, y, z), DVec3::new(x + 1.0, y + 1.0, z + 1.0))
    }

    /// Points of a triangle or polygon prove that their cells are met; of the other cells most must be missed.
    #[test]
    fn triangles_and_polygons_meet_the_cells_they_have_points_in() {
        let corners = [
            DVec3::new(0.3, 0.2, 0.1),
            DVec3::new(7.7, 2.4, 5.9),
            DVec3::new(2.2, 6.8, 3.3),
        ];
        let mut met = std::collections::BTreeSet::new();
        for i in 0..=400 {
            for j in 0..=400 - i {
                let (u, v) = (f64::from(i) / 400.0, f64::from(j) / 400.0);
                let p = corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v;
                met.insert(p.floor().to_array().map(|x| x as i32));
            }
        }
        let mut found = 0;
        for index in 0..512 {
            let [x, y, z] = [index % 8, index / 8 % 8, index / 64];
            let c = cell(f64::from(x), f64::from(y), f64::from(z));
            let meets = triangle_meets(&corners, &c);
            assert!(meets || !met.contains(&[x, y, z]), "{x} {y} {z}");
            assert_eq!(polygon_meets(&corners, &c), meets, "{x} {y} {z}");
            found += usize::from(meets);
        }
        assert!(found < met.len() + 4, "{found} {}", met.len());
    }

    #[test]
    fn a_ball_is_its_surface() {
        let (near, far) = distances(DVec3::ZERO, &cell(1.0, 1.0, 1.0));
        assert!((near - 3f64.sqrt()).abs() < 1e-15 && (far - 12f64.sqrt()).abs() < 1e-15);
        assert_eq!(distances(DVec3::splat(1.5), &cell(1.0, 1.0, 1.0)).0, 0.0);
    }

    /// Points of the surface prove that their cells are met.
    #[test]
    fn cylinders_and_cones_meet_the_cells_they_have_points_in() {
        for (radii, most) in [([1.5, 1.5], 170), ([2.2, 0.0], 130), ([0.3, 0.4], 60)] {
            let ends = [DVec3::new(2.1, 2.3, 1.9), DVec3::new(5.8, 5.2, 6.1)];
            let frustum = Frustum([(ends[0], radii[0]), (ends[1], radii[1])]);
            let axis = frustum.axis().normalize();
            let u = axis.any_orthonormal_vector();
            let v = axis.cross(u);
            let mut met = std::collections::BTreeSet::new();
            let mut see = |height: f64, part: f64, angle: f64| {
                let radius = (radii[0] + height * (radii[1] - radii[0])) * part;
                let across = (u * angle.cos() + v * angle.sin()) * radius;
                let p = ends[0] + (ends[1] - ends[0]) * height + across;
                met.insert(p.floor().to_array().map(|x| x as i32));
            };
            for i in 0..=200 {
                for j in 0..400 {
                    let (part, angle) = (f64::from(i) / 200.0, f64::from(j) / 400.0 * TAU);
                    see(part, 1.0, angle);
                    see(0.0, part, angle);
                    see(1.0, part, angle);
                }
            }
            let mut found = 0;
            for index in 0..512 {
                let [x, y, z] = [index % 8, index / 8 % 8, index / 64];
                let c = cell(f64::from(x), f64::from(y), f64::from(z));
                let meets = frustum.meets(&c) && !frustum.surrounds(&c);
                assert!(meets || !met.contains(&[x, y, z]), "{radii:?} {x} {y} {z}");
                found += usize::from(meets);
            }
            assert!(
                found < most && found < met.len() + met.len() / 8,
                "{radii:?}: {found} {}",
                met.len()
            );
        }
    }

    #[test]
    fn the_ball_of_a_cone_touches_its_rims() {
        let ball =
            |radii: [f64; 2]| Frustum([(DVec3::ZERO, radii[0]), (DVec3::Y * 4.0, radii[1])]).ball();
        let (center, radius) = ball([3.0, 3.0]);
        assert!(
            (center - DVec3::Y * 2.0).length() < 1e-12 && (radius - 13f64.sqrt()).abs() < 1e-12
        );
        let (center, radius) = ball([2.0, 0.0]);
        assert!((center - DVec3::Y * 1.5).length() < 1e-12 && (radius - 2.5).abs() < 1e-12);
        // A flat one: the wide disc is enough.
        let (center, radius) = ball([9.0, 1.0]);
        assert!(center == DVec3::ZERO && (radius - 9.0).abs() < 1e-12);
    }

    #[test]
    fn the_ball_of_a_triangle_is_the_smallest() {
        let right = [DVec3::ZERO, DVec3::X * 3.0, DVec3::Y * 4.0];
        let (center, radius) = ball_of_triangle(&right);
        assert!(
            (radius - 2.5).abs() < 1e-12 && (center - DVec3::new(1.5, 2.0, 0.0)).length() < 1e-12
        );
        let even = [DVec3::X, DVec3::Y, DVec3::Z];
        let (center, radius) = ball_of_triangle(&even);
        assert!((center - DVec3::splat(1.0 / 3.0)).length() < 1e-12);
        assert!((radius - (2.0f64 / 3.0).sqrt()).abs() < 1e-12);
        let flat = [DVec3::ZERO, DVec3::X, DVec3::X * 4.0];
        assert!((ball_of_triangle(&flat).1 - 2.0).abs() < 1e-12);
    }
}
