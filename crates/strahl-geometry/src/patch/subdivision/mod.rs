//! Subdivision surfaces, met at their limit.

mod cage;
mod data;
mod node;
mod place;
mod quad;
mod ring;
mod rules;
#[cfg(test)]
mod tests;
mod triangle;

use super::winding::{Pass, Winding};
use crate::primitives::point_error;
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Shape, Solid, SurfaceId, SurfacePoint,
};
use cage::Cage;
use node::{Found, Leaf, Line, Node};
use place::{Place, Spot};
use std::sync::OnceLock;
use strahl_accel::{Accelerator, Bvh2, TraversalStats, Visitor};
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};

pub use data::{SubdivisionData, SubdivisionScheme};

/// A subdivision surface of Catmull and Clark's or Loop's scheme: what a control mesh becomes when it is divided and smoothed
/// without end.
///
/// Rays meet this limit, at any scale; nothing is replaced by triangles. Where the mesh is regular the limit is made of B-splines,
/// which are Bezier patches exactly. Around other vertices (those that have not four faces, or not six triangles in Loop's
/// scheme) there are rings of patches that become smaller towards the vertex, made when rays come there. What is left when they
/// have shrunk to `2^-30` of the faces' size is one patch that lies within the convex hull of the remaining control points, as the
/// limit does: both are closer than `2^-28` of the face to each other. Neighbours have their borders in common to the last bit, so
/// that a ray through a border meets exactly one of them.
///
/// Edges may be creases of any sharpness, vertices may be corners. Edges with one face are the border, which is a cubic
/// B-spline curve of its vertices. A mesh without such edges is a solid: a point is inside if the surface winds around it. Open ones have
/// no inside; their front is the side from which the faces run counter-clockwise.
///
/// Elements are the faces; faces of Catmull and Clark's scheme that have not four corners have an element for each corner. Texture
/// coordinates are interpolated linearly in each element; without any they run from 0 to 1, from the first corner to the second and
/// to the last one.
#[derive(Debug)]
pub struct Subdivision {
    cage: Cage,
    /// The trees of the elements, when the first ray comes.
    nodes: Vec<OnceLock<Box<Node>>>,
    /// Over the elements, relative to the anchor.
    tree: Bvh2,
    anchor: DVec3,
    bounds: Aabb,
    /// Whether the front is the other side, after a mirroring transform.
    is_flipped: bool,
    is_closed: bool,
    /// Whether the normals of a closed surface have to be turned outwards.
    is_inside_out: bool,
}

impl Subdivision {
    /// The limit of this mesh.
    ///
    /// # Errors
    /// There are no faces, or their number of corners is not as [`SubdivisionData`] says; an index has no vertex; a vertex is not finite or
    /// beyond 1e70; a face has a vertex twice; three faces meet at an edge, or two that turn different sides to the front;
    /// more than 1000 faces meet at a vertex; a crease is no edge; a sharpness is negative; all vertices lie on a line.
    pub fn try_new(data: &SubdivisionData) -> Result<Self, GeometryError> {
        Ok(Self::of(Cage::try_new(data)?, false))
    }

    fn of(cage: Cage, is_flipped: bool) -> Self {
        let boxes: Vec<_> = (0..cage.elements())
            .map(|element| node::bounds(&cage.ring(element)))
            .collect();
        let bounds = boxes.iter().fold(Aabb::EMPTY, |all, part| all.union(part));
        let anchor = bounds.min;
        let local: Vec<_> = boxes
            .iter()
            .map(|own| Aabb::new(own.min - anchor, own.max - anchor))
            .collect();
        let mut surface = Self {
            nodes: boxes.iter().map(|_| OnceLock::new()).collect(),
            tree: Bvh2::build(&local),
            anchor,
            bounds,
            is_flipped,
            is_closed: cage.is_closed(),
            is_inside_out: false,
            cage,
        };
        let middle = surface.middle();
        let aims = (0..surface.nodes.len())
            .filter_map(|element| Some(surface.at(element as u32, middle)?[0]));
        surface.is_inside_out = surface.is_closed && surface.finds_inside_out(aims);
        surface
    }

    /// The control mesh.
    pub fn data(&self) -> &SubdivisionData {
        &self.cage.data
    }

    /// The point of the limit at parameters of an element, and its derivatives by them; `None` if there is no such element.
    ///
    /// Parameters run from 0 to 1, from the first corner of the element to the second and to the last one; in Loop's scheme their sum is
    /// at most 1.
    pub fn at(&self, element: u32, uv: DVec2) -> Option<[DVec3; 3]> {
        let within = uv.clamp(DVec2::ZERO, DVec2::ONE).to_array();
        let spot = Spot::at(self.cage.scheme(), within);
        self.node(element).map(|node| node.jet(spot).0)
    }

    /// The bytes that the surface takes in memory. They grow as rays come.
    pub fn bytes(&self) -> usize {
        let nodes = self.nodes.iter().filter_map(|node| node.get());
        size_of::<Self>()
            + size_of_val(self.nodes.as_slice())
            + nodes.map(|node| node.bytes()).sum::<usize>()
            + self.cage.bytes()
            // Two nodes of the tree for each element.
            + 2 * 64 * self.nodes.len()
    }

    /// Parameters in the middle of an element.
    fn middle(&self) -> DVec2 {
        DVec2::splat(match self.cage.scheme() {
            SubdivisionScheme::CatmullClark => 0.5,
            SubdivisionScheme::Loop => 1.0 / 3.0,
        })
    }

    fn node(&self, element: u32) -> Option<&Node> {
        let slot = self.nodes.get(element as usize)?;
        Some(slot.get_or_init(|| Box::new(Node::new(self.cage.ring(element as usize)))))
    }

    /// The hit that was found in a part of an element.
    fn hit(&self, element: u32, place: Place, found: &Found) -> PrimHit {
        let (facet, uv) = place.outer(found.spot).told(self.cage.scheme());
        PrimHit {
            t: found.candidate.t,
            surface: SurfaceId { element, facet },
            uv,
        }
    }

    /// Shows the elements along a ray to the visitor.
    fn walk<V: Visitor>(&self, ray: &Ray, range: Interval, visitor: &mut V) {
        let local = Ray::new(ray.origin - self.anchor, ray.direction);
        self.tree
            .traverse(&local, range, visitor, &mut TraversalStats::default());
    }

    /// Texture coordinates at parameters of an element, with the derivatives of the point by them.
    fn textured(&self, element: u32, [u, v]: [f64; 2], by: [DVec3; 2]) -> (DVec2, [DVec3; 2]) {
        let Some([a, b, c, d]) = self.cage.uvs(element as usize) else {
            return (DVec2::new(u, v), by);
        };
        let (place, along_u, along_v) = match self.cage.scheme() {
            SubdivisionScheme::CatmullClark => {
                let (lower, upper) = (a + (b - a) * u, d + (c - d) * u);
                let along_u = (b - a) * (1.0 - v) + (c - d) * v;
                (lower + (upper - lower) * v, along_u, upper - lower)
            }
            SubdivisionScheme::Loop => (a + (b - a) * u + (c - a) * v, b - a, c - a),
        };
        let determinant = along_u.x * along_v.y - along_u.y * along_v.x;
        let [by_u, by_v] = by;
        let by_x = (by_u * along_v.y - by_v * along_u.y) / determinant;
        let by_y = (by_v * along_u.x - by_u * along_v.x) / determinant;
        if by_x.is_finite() && by_y.is_finite() {
            (place, [by_x, by_y])
        } else {
            (place, [DVec3::ZERO; 2])
        }
    }
}

/// Looks for the nearest hit.
struct Nearest<'a> {
    surface: &'a Subdivision,
    line: Line<'a>,
    range: Interval,
    best: Option<PrimHit>,
}

impl Visitor for Nearest<'_> {
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        let Some(node) = self.surface.node(id) else {
            return t_max;
        };
        let (surface, line, best) = (self.surface, &self.line, &mut self.best);
        let range = best.map_or(self.range, |best| self.range.with_max(best.t));
        let mut ask = |leaf: &Leaf, place: Place, range: Interval| {
            let Some(found) = leaf.nearest(line, range) else {
                return range;
            };
            let found = surface.hit(id, place, &found);
            let key = |hit: &PrimHit| (hit.t, hit.surface.element);
            if best.is_none_or(|best| key(&found) < key(&best)) {
                *best = Some(found);
            }
            range.with_max(found.t)
        };
        node.walk(line, range, Place::WHOLE, &mut ask);
        self.best.map_or(t_max, |best| best.t)
    }
}

/// Looks for any hit.
struct Any<'a> {
    surface: &'a Subdivision,
    line: Line<'a>,
    range: Interval,
    found: bool,
}

impl Visitor for Any<'_> {
    const ANY: bool = true;

    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        let (line, found) = (&self.line, &mut self.found);
        if let Some(node) = self.surface.node(id) {
            let mut ask = |leaf: &Leaf, _: Place, range: Interval| {
                *found = *found || leaf.any(line, range);
                range
            };
            node.walk(line, self.range, Place::WHOLE, &mut ask);
        }
        if self.found { f64::NEG_INFINITY } else { t_max }
    }
}

/// Collects all passes.
struct All<'a> {
    surface: &'a Subdivision,
    line: Line<'a>,
    passes: Vec<Pass>,
}

impl Visitor for All<'_> {
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        let (surface, line, passes) = (self.surface, &self.line, &mut self.passes);
        if let Some(node) = self.surface.node(id) {
            let mut ask = |leaf: &Leaf, place: Place, range: Interval| {
                passes.extend(leaf.all(line).into_iter().map(|found| Pass {
                    hit: surface.hit(id, place, &found),
                    sign: found.candidate.sign,
                }));
                range
            };
            node.walk(line, Interval::LINE, Place::WHOLE, &mut ask);
        }
        t_max
    }
}

impl Primitive for Subdivision {
    fn kind(&self) -> &'static str {
        "subdivision"
    }

    /// The constructors have validated everything.
    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn elements(&self) -> u32 {
        self.nodes.len() as u32
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        _from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let mut visitor = Nearest {
            surface: self,
            line: Line::new(ray)?,
            range,
            best: None,
        };
        self.walk(ray, range, &mut visitor);
        visitor.best
    }

    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        _from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> bool {
        let Some(line) = Line::new(ray) else {
            return false;
        };
        let mut visitor = Any {
            surface: self,
            line,
            range,
            found: false,
        };
        self.walk(ray, range, &mut visitor);
        visitor.found
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let toward = || (-ray.direction).try_normalize().unwrap_or(DVec3::Y);
        let element = hit.surface.element;
        let Some(node) = self.node(element) else {
            return SurfacePoint::bare(ray.at(hit.t), DVec3::ZERO, toward());
        };
        let scheme = self.cage.scheme();
        let spot = Spot::of(scheme, hit.surface.facet, hit.uv);
        let ([position, by_u, by_v], front) = node.jet(spot);
        let is_turned = if self.is_closed {
            self.is_inside_out
        } else {
            self.is_flipped
        };
        let turned = |front: DVec3| if is_turned { -front } else { front };
        let normal = front.map_or_else(toward, turned);
        let (uv, [dpdu, dpdv]) = self.textured(element, spot.uv(scheme), [by_u, by_v]);
        let error = point_error(position, self.bounds.max_abs(), Self::ROUNDINGS);
        let is_usable = dpdu.is_finite() && dpdv.is_finite();
        SurfacePoint {
            uv,
            dpdu: if is_usable { dpdu } else { DVec3::ZERO },
            dpdv: if is_usable { dpdv } else { DVec3::ZERO },
            ..SurfacePoint::bare(position, error, normal)
        }
    }

    fn texture_uv(&self, _hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        Some(uv)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        self.is_closed.then_some(self as &dyn Solid)
    }

    fn baked(&self, map: &Transform) -> Option<Shape> {
        let data = self.cage.mapped(map)?;
        let mapped = Self::of(Cage::try_new(&data).ok()?, self.is_flipped != map.mirrors());
        let (size, far) = (mapped.bounds.size().max_element(), mapped.bounds.max_abs());
        // Far away from the origin the coordinates would lose its shape.
        (size >= far * f64::from(f32::EPSILON)).then(|| mapped.into())
    }
}

impl Winding for Subdivision {
    /// A few for each level, of which there are up to 50, and those of a patch.
    const ROUNDINGS: u32 = 512;

    fn passes(&self, ray: &Ray) -> Vec<Pass> {
        let Some(line) = Line::new(ray) else {
            return vec![];
        };
        let mut all = All {
            surface: self,
            line,
            passes: vec![],
        };
        self.walk(ray, Interval::LINE, &mut all);
        all.passes
    }

    fn is_inside_out(&self) -> bool {
        self.is_inside_out
    }
}

impl Solid for Subdivision {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        self.crossings_by_winding(ray, range, from, out);
    }

    fn contains(&self, point: DVec3) -> bool {
        self.contains_by_winding(point)
    }
}
