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
mod view;

use super::elements::{self, ElementTree, Elements, Front};
use super::winding::{Pass, Winding};
use crate::primitives::point_error;
use crate::{GeometryError, PrimHit, Primitive, Scratch, Shape, Solid, SurfaceId, SurfacePoint};
use cage::Cage;
use node::{Found, Leaf, Line, Node};
use place::{Place, Spot};
use std::sync::OnceLock;
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
/// Edges may be creases of any sharpness, vertices may be corners. A vertex in which faces touch that have no edge there in common is a sharp
/// corner of all of them. Edges with one face are the border, which is a cubic
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
    nodes: Vec<OnceLock<Node>>,
    /// Over the elements.
    tree: ElementTree,
    front: Front,
}

impl Subdivision {
    /// The limit of this mesh.
    ///
    /// # Errors
    /// There are no faces, or their number of corners is not as [`SubdivisionData`] says; an index has no vertex; a vertex is not finite or
    /// beyond 1e70; a face has a vertex twice; three faces meet at an edge, or two that turn different sides to the front;
    /// more than 10000 faces meet at a vertex; a crease is no edge; a sharpness is negative; all vertices lie on a line.
    pub fn try_new(data: &SubdivisionData) -> Result<Self, GeometryError> {
        Ok(Self::of(Cage::try_new(data)?, false))
    }

    fn of(cage: Cage, is_flipped: bool) -> Self {
        let boxes: Vec<_> = (0..cage.elements())
            .map(|element| node::bounds(&cage.ring(element)))
            .collect();
        let mut surface = Self {
            nodes: boxes.iter().map(|_| OnceLock::new()).collect(),
            tree: ElementTree::new(&boxes),
            front: Front {
                is_flipped,
                is_closed: cage.is_closed(),
                is_inside_out: false,
            },
            cage,
        };
        let middle = surface.middle();
        let aims = (0..surface.nodes.len())
            .filter_map(|element| Some(surface.at(element as u32, middle)?[0]));
        surface.front.is_inside_out = surface.front.is_closed && surface.finds_inside_out(aims);
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
            + self.tree.bytes()
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
        Some(slot.get_or_init(|| Node::new(self.cage.ring(element as usize))))
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

    /// Texture coordinates at parameters of an element, with the derivatives of the point by them.
    fn textured(&self, element: u32, [u, v]: [f64; 2], by: [DVec3; 2]) -> (DVec2, [DVec3; 2]) {
        let Some(corners) = self.cage.uvs(element as usize) else {
            return (DVec2::new(u, v), by);
        };
        match self.cage.scheme() {
            SubdivisionScheme::CatmullClark => elements::bilinear(corners, [u, v], by),
            SubdivisionScheme::Loop => {
                let [a, b, c, _] = corners;
                let along = [b - a, c - a];
                let place = a + along[0] * u + along[1] * v;
                (place, elements::derivatives(along, by))
            }
        }
    }
}

impl Elements for Subdivision {
    type Line<'a> = Line<'a>;

    fn line<'a>(&self, ray: &'a Ray) -> Option<Line<'a>> {
        Line::new(ray)
    }

    fn tree(&self) -> &ElementTree {
        &self.tree
    }

    fn nearest(
        &self,
        id: u32,
        line: &Line<'_>,
        range: Interval,
        _from: Option<SurfaceId>,
    ) -> Option<PrimHit> {
        let mut best: Option<PrimHit> = None;
        let mut ask = |leaf: &Leaf, place: Place, range: Interval| {
            let Some(found) = leaf.nearest(line, range) else {
                return range;
            };
            let found = self.hit(id, place, &found);
            if best.is_none_or(|best| found.t < best.t) {
                best = Some(found);
            }
            range.with_max(found.t)
        };
        self.node(id)?.walk(line, range, Place::WHOLE, &mut ask);
        best
    }

    fn any(&self, id: u32, line: &Line<'_>, range: Interval, _from: Option<SurfaceId>) -> bool {
        let mut found = false;
        let mut ask = |leaf: &Leaf, _: Place, range: Interval| {
            found = leaf.any(line, range);
            match found {
                // Nothing is left to look for.
                true => range.with_max(f64::NEG_INFINITY),
                false => range,
            }
        };
        if let Some(node) = self.node(id) {
            node.walk(line, range, Place::WHOLE, &mut ask);
        }
        found
    }

    fn all(&self, id: u32, line: &Line<'_>, passes: &mut Vec<Pass>) {
        let mut ask = |leaf: &Leaf, place: Place, range: Interval| {
            passes.extend(leaf.all(line).into_iter().map(|found| Pass {
                hit: self.hit(id, place, &found),
                sign: found.candidate.sign,
            }));
            range
        };
        if let Some(node) = self.node(id) {
            node.walk(line, Interval::LINE, Place::WHOLE, &mut ask);
        }
    }
}

impl Winding for Subdivision {
    /// A few for each level, of which there are up to 50, and those of a patch.
    const ROUNDINGS: u32 = 512;

    fn passes(&self, ray: &Ray) -> Vec<Pass> {
        elements::passes(self, ray)
    }

    fn is_inside_out(&self) -> bool {
        self.front.is_inside_out
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
        self.tree.bounds()
    }

    fn elements(&self) -> u32 {
        self.tree.count()
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        elements::nearest(self, ray, range, from)
    }

    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> bool {
        elements::any(self, ray, range, from)
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let element = hit.surface.element;
        let Some(node) = self.node(element) else {
            return SurfacePoint::bare(ray.at(hit.t), DVec3::ZERO, elements::against(ray));
        };
        let scheme = self.cage.scheme();
        let spot = Spot::of(scheme, hit.surface.facet, hit.uv);
        let ([position, by_u, by_v], across) = node.jet(spot);
        let error = point_error(position, self.bounds().max_abs(), Self::ROUNDINGS);
        let bare = SurfacePoint::bare(position, error, self.front.normal(across, ray));
        let (uv, by) = self.textured(element, spot.uv(scheme), [by_u, by_v]);
        elements::textured(bare, uv, by)
    }

    fn texture_uv(&self, _hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        Some(uv)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        self.front.is_closed.then_some(self as &dyn Solid)
    }

    fn baked(&self, map: &Transform) -> Option<Shape> {
        let data = self.cage.mapped(map)?;
        let is_flipped = self.front.is_flipped != map.mirrors();
        let mapped = Self::of(Cage::try_new(&data).ok()?, is_flipped);
        elements::keeps_its_shape(&mapped.bounds()).then(|| mapped.into())
    }
}
