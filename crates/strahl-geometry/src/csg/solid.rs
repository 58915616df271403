use super::CsgNode;
use super::compile::Compiler;
use super::evaluate::Evaluation;
use super::first::{Answer, all_visible, first_visible};
use super::half_spaces::HalfSpaces;
use super::leaf::{Leaf, Next};
use super::packet::Convex;
use super::small::Small;
use super::sweep::Rule;
use crate::primitive::one_by_one;
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Shape, Solid, SurfaceId, SurfacePoint,
};
use std::sync::Arc;
use strahl_accel::Bvh2;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray};

/// A compiled CSG tree: several solids combined into one.
///
/// Surface elements: each leaf takes as many numbers as its shape has elements, in the order of the description;
/// [`Csg::leaf_of`] leads back. Facets and `uv` of a hit are the leaf's own.
///
/// Where surfaces of several leaves coincide, POV-Ray's rules apply: an intersection keeps those that are inside of all other
/// operands, a merge those that are outside of them; whether a surface counts as inside of its own solid depends on the shape. Of
/// several surfaces the last one is visible, in a union the first. So a difference may have a lid: a surface with nothing in
/// front of it or behind it.
///
/// `n_geom` points out of the combined solid, so the normals of subtracted solids are reversed. On inner surfaces it is the
/// leaf's.
///
/// Limits: crossings of different leaves are fused where their error bounds overlap, so spans thinner than rounding vanish;
/// and `contains` asks the leaves point by point, so on the boundary of a subtracted leaf it says "outside".
#[derive(Clone, Debug)]
pub struct Csg {
    /// The root is the first.
    nodes: Vec<Node>,
    /// The operands of all nodes.
    operands: Vec<u32>,
    leaves: Vec<Leaf>,
    /// The different bounds that leaves are seen through.
    bounds: Vec<Bounds>,
    elements: u32,
    /// Whether each leaf has one element.
    one_each: bool,
    /// Whether all leaves are solids.
    closed: bool,
    /// Whether it is an operation on solids that is not nested too deep for recursion.
    shallow: bool,
    /// The tree as a table, if it has few leaves and these are simple.
    small: Option<Box<Small>>,
    /// Its operands, if it is a small intersection of convex solids and of complements of such, or a small union of convex solids.
    convex: Option<Box<Convex>>,
    /// Whether the rays of a packet search it together.
    together: bool,
}

/// Bounds of leaves (`bounded_by`), in the space of the tree: a ray sees the leaves if it meets all of them ([`crate::Bounded`]).
pub(super) type Bounds = Box<[Arc<Csg>]>;

/// The kind of a compiled node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The leaf of this index.
    Leaf(u32),
    /// An operation on operands.
    Operation(Rule),
}

/// The parent of the root.
pub(super) const NO_PARENT: u32 = u32::MAX;

/// Trees that are nested deeper are traversed with an explicit stack.
const SHALLOW: u32 = 24;

/// A compiled node.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) kind: Kind,
    /// The operation whose operand it is.
    pub(super) parent: u32,
    /// Whether it is a shape that is intersected as fast as its box.
    pub(super) quick: bool,
    /// Holds all surfaces of the node ...
    pub(super) bounds: Aabb,
    /// ... and whether everything outside of it is inside of the node.
    pub(super) far: bool,
    /// Operands: `first..core` decide the result where a ray misses their boxes (the positive ones of an intersection),
    /// `core..end` don't matter there (the subtracted ones).
    pub(super) first: u32,
    pub(super) core: u32,
    pub(super) end: u32,
    /// The last ones of `first..core`, if they are half-spaces.
    pub(super) half_spaces: Option<Box<HalfSpaces>>,
    /// Over the boxes of `core..end`, numbered from 0, if they are many.
    pub(super) hierarchy: Option<Box<Bvh2>>,
}

impl Node {
    /// Whether it is a leaf, a union or a merge: whatever is in an operand is in the whole.
    fn only_adds(&self) -> bool {
        !matches!(self.kind, Kind::Operation(Rule::Intersection))
    }
}

impl Csg {
    /// Compiles a tree.
    ///
    /// # Errors
    /// An operation without operands, a leaf with invalid parameters, more than 2³² elements.
    pub fn try_new(tree: CsgNode) -> Result<Self, GeometryError> {
        let mut compiler = Compiler::default();
        compiler.read(tree)?;
        Ok(compiler.finish())
    }

    pub(super) fn from_parts(
        nodes: Vec<Node>,
        operands: Vec<u32>,
        (leaves, bounds): (Vec<Leaf>, Vec<Bounds>),
        elements: u32,
        closed: bool,
    ) -> Self {
        let mut depths: Vec<u32> = Vec::with_capacity(nodes.len());
        for node in &nodes {
            // Parents stand before their operands.
            let parent = depths.get(node.parent as usize);
            depths.push(parent.map_or(0, |depth| depth + 1));
        }
        let combined = matches!(nodes.first(), Some(root) if root.kind != Kind::Leaf(0));
        let shallow = closed && combined && depths.iter().all(|depth| *depth <= SHALLOW);
        let small = if shallow || closed && !combined {
            Small::of(&nodes, &operands, &leaves)
        } else {
            None
        };
        let convex = match &small {
            Some(small) if small.is_intersection && combined && bounds.is_empty() => {
                Convex::of(&leaves)
            }
            Some(_) if combined && bounds.is_empty() && nodes.iter().all(Node::only_adds) => {
                Convex::of_union(&leaves)
            }
            _ => None,
        };
        let is_one_span = convex.as_ref().is_some_and(|convex| !convex.any);
        let together = shallow && !is_one_span && Self::goes_together(&nodes, &leaves);
        let mut numbers = leaves.iter().map(|leaf| leaf.first_element).zip(0..);
        let one_each =
            numbers.all(|(first, index)| first == index) && elements as usize == leaves.len();
        Self {
            one_each,
            small: small.map(Box::new),
            convex: convex.map(Box::new),
            together,
            nodes,
            operands,
            leaves,
            bounds,
            elements,
            closed,
            shallow,
        }
    }

    /// The same tree with all planes evaluated one by one.
    #[cfg(test)]
    pub(super) fn without_half_spaces(mut self) -> Self {
        for node in &mut self.nodes {
            node.half_spaces = None;
        }
        self
    }

    /// The number of leaves, counted in the order of the description.
    pub fn leaves(&self) -> usize {
        self.leaves.len()
    }

    /// The leaf that an element number of a hit belongs to, and the element's number within that leaf's shape.
    #[inline]
    pub fn leaf_of(&self, element: u32) -> (usize, u32) {
        if self.one_each && element < self.elements {
            return (element as usize, 0);
        }
        self.leaf_with(element)
    }

    #[inline(never)]
    fn leaf_with(&self, element: u32) -> (usize, u32) {
        let after = self
            .leaves
            .partition_point(|leaf| leaf.first_element <= element);
        let index = after.saturating_sub(1);
        let first = self.leaves.get(index).map_or(0, |leaf| leaf.first_element);
        (index, element - first)
    }

    /// The leaf that a surface belongs to, and the surface with the number of its element in that leaf.
    pub(super) fn leaf_surface(&self, surface: SurfaceId) -> (u32, SurfaceId) {
        let (leaf, element) = self.leaf_of(surface.element);
        (leaf as u32, SurfaceId { element, ..surface })
    }

    /// The caller's number for a leaf; 0 if there is no such leaf.
    pub fn leaf_tag(&self, leaf: usize) -> u32 {
        self.leaves.get(leaf).map_or(0, |leaf| leaf.tag)
    }

    /// The shape of a leaf.
    pub fn leaf_shape(&self, leaf: usize) -> Option<&Shape> {
        self.leaves.get(leaf).map(|leaf| &leaf.shape)
    }

    /// Whether the rays of a packet search it faster together, with a [`PacketTree`](super::PacketTree).
    #[inline]
    pub fn goes_in_packets(&self) -> bool {
        self.together
    }

    /// Whether it is an operation that is not nested too deep for recursion.
    pub(super) fn is_shallow(&self) -> bool {
        self.shallow
    }

    /// The tree as a table, if it is small.
    #[cfg(test)]
    pub(super) fn small(&self) -> Option<&Small> {
        self.small.as_deref()
    }

    /// Its operands, if it is a small intersection of convex solids and of complements of such.
    pub(super) fn convex(&self) -> Option<&Convex> {
        self.convex.as_deref()
    }

    /// The tree as a table, if it is a small merge of leaves that lines cross at most twice.
    #[inline]
    pub(super) fn small_merge(&self) -> Option<&Small> {
        self.small.as_deref().filter(|small| small.is_merge)
    }

    pub(super) fn all_leaves(&self) -> &[Leaf] {
        &self.leaves
    }

    pub(super) fn node_count(&self) -> usize {
        self.nodes.len()
    }

    pub(super) fn node(&self, index: u32) -> Option<&Node> {
        self.nodes.get(index as usize)
    }

    pub(super) fn operand(&self, index: u32) -> Option<u32> {
        self.operands.get(index as usize).copied()
    }

    pub(super) fn leaf(&self, index: u32) -> Option<&Leaf> {
        self.leaves.get(index as usize)
    }

    /// Whether a ray meets all bounds that the leaf of an element is seen through.
    #[inline]
    pub(super) fn is_seen(&self, element: u32, ray: &Ray, scratch: &mut Scratch) -> bool {
        self.bounds.is_empty() || self.meets_bounds(element, ray, scratch)
    }

    fn meets_bounds(&self, element: u32, ray: &Ray, scratch: &mut Scratch) -> bool {
        let (leaf, _) = self.leaf_of(element);
        let number = self.leaves.get(leaf).and_then(|leaf| leaf.seen_through);
        let bounds = number.and_then(|number| self.bounds.get(number as usize));
        bounds.is_none_or(|bounds| {
            bounds
                .iter()
                .all(|bound| bound.any_hit(ray, Interval::FORWARD, None, scratch))
        })
    }

    /// Makes those crossings of a ray invisible whose leaves it does not see.
    pub(super) fn hide_unseen(&self, list: &mut Crossings, ray: &Ray, scratch: &mut Scratch) {
        if self.bounds.is_empty() {
            return;
        }
        for crossing in &mut list.list {
            let element = crossing.hit.surface.element;
            crossing.visible &= self.meets_bounds(element, ray, scratch);
        }
    }

    fn store_surface(&self, ray: &Ray, hit: &PrimHit, bare: bool, out: &mut SurfacePoint) {
        let (leaf, _) = self.leaf_of(hit.surface.element);
        match self.leaves.get(leaf) {
            Some(leaf) => leaf.store_surface(ray, hit, bare, out),
            // A compiled tree has a leaf.
            None => *out = SurfacePoint::bare(ray.at(hit.t), DVec3::ZERO, DVec3::Z),
        }
    }

    /// Whether the point is inside by the logic of the tree; open leaves have no inside.
    fn contains_point(&self, point: DVec3) -> bool {
        if point.is_nan() {
            return false;
        }
        let mut next = Next::Leaf(0);
        loop {
            let index = match next {
                Next::Answer(answer) => return answer,
                Next::Leaf(index) => index,
            };
            let Some(leaf) = self.leaf(index) else {
                return false;
            };
            next = if leaf.contains(point) {
                leaf.if_inside
            } else {
                leaf.if_outside
            };
        }
    }
}

impl Primitive for Csg {
    fn kind(&self) -> &'static str {
        "csg"
    }

    /// Leaves have been checked by [`Csg::try_new`].
    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    /// The bounds of the tree: those of intersections are intersected, those of subtracted operands don't count.
    fn bounds(&self) -> Aabb {
        match self.node(0) {
            Some(root) if !(self.closed && root.far) => root.bounds,
            _ => Aabb::EVERYTHING,
        }
    }

    fn elements(&self) -> u32 {
        self.elements
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        if let Some(small) = &self.small {
            let from = from.map(|surface| self.leaf_surface(surface));
            let sees = |hit: &PrimHit, scratch: &mut Scratch| {
                self.is_seen(hit.surface.element, ray, scratch)
            };
            let answer = small.first_visible(&self.leaves, ray, range, from, scratch, sees);
            if let Answer::Certain(hit) = answer {
                return hit;
            }
        } else if self.shallow {
            let mut workspace = scratch.take_csg();
            let lists = &mut workspace.first;
            let answer = first_visible(self, ray, range, from, lists, scratch);
            scratch.give_csg(workspace);
            if let Answer::Certain(hit) = answer {
                return hit;
            }
        }
        let mut list = scratch.take();
        Evaluation::run(self, ray, range, from, scratch, &mut list);
        let first = list.list.iter().find(|crossing| crossing.visible);
        let hit = first.map(|crossing| crossing.hit);
        scratch.give(list);
        hit
    }

    fn all_hits(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Vec<PrimHit>,
    ) {
        let before = out.len();
        if let Some(small) = &self.small {
            let from = from.map(|surface| self.leaf_surface(surface));
            let sees = |hit: &PrimHit, scratch: &mut Scratch| {
                self.is_seen(hit.surface.element, ray, scratch)
            };
            let sure = small.all_visible(&self.leaves, ray, range, from, scratch, sees, out);
            if sure.is_ok() {
                return;
            }
            out.truncate(before);
        } else if self.shallow {
            let mut workspace = scratch.take_csg();
            let lists = &mut workspace.first;
            let answer = all_visible(self, ray, range, from, lists, scratch, out);
            scratch.give_csg(workspace);
            if answer.is_ok() {
                return;
            }
            out.truncate(before);
            // Searching several times is faster than listing what is not needed (measured: 0.85 of the time on cutglass.pov).
            return one_by_one(self, ray, range, from, scratch, out);
        }
        let mut list = scratch.take();
        Evaluation::run(self, ray, range, from, scratch, &mut list);
        for crossing in list.list.iter().filter(|crossing| crossing.visible) {
            // Of several at one place the first is met.
            if out[before..]
                .last()
                .is_none_or(|last| last.t < crossing.hit.t)
            {
                out.push(crossing.hit);
            }
        }
        scratch.give(list);
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let mut surface = SurfacePoint::UNKNOWN;
        self.store_surface(ray, hit, false, &mut surface);
        surface
    }

    fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
        self.store_surface(ray, hit, true, out);
    }

    fn texture_uv(&self, hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        let (leaf, _) = self.leaf_of(hit.surface.element);
        self.leaves.get(leaf)?.texture_uv(hit, uv)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        if self.closed { Some(self) } else { None }
    }
}

/// A tree with open parts is no operand of another tree ([`Primitive::as_solid`]), but it contains what its closed parts enclose.
impl Solid for Csg {
    fn inside_bounds(&self) -> Aabb {
        match self.node(0) {
            Some(root) if !root.far => root.bounds,
            _ => Aabb::EVERYTHING,
        }
    }

    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        Evaluation::run(self, ray, range, from, scratch, out);
    }

    fn contains(&self, point: DVec3) -> bool {
        self.contains_point(point)
    }
}
