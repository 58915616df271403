//! The compiled tree: flat lists of its nodes, operands and leaves, and what is known of them.

use super::clipped::Clipped;
use super::convex::Convex;
use super::leaf::Leaf;
use super::node::{Kind, Node};
use super::small::Small;
use super::sweep::Rule;
use crate::{Crossings, Primitive, Scratch, Shape, SurfaceId};
use std::sync::Arc;
use strahl_accel::Visitor;
use strahl_math::{Interval, Ray};

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
    /// Its parts, if it is an open surface that convex solids clip.
    clipped: Option<Clipped>,
    /// Whether the rays of a packet search it together.
    together: bool,
}

/// Bounds of leaves (`bounded_by`), in the space of the tree: a ray sees the leaves if it meets all of them ([`crate::Bounded`]).
pub(super) type Bounds = Box<[Arc<Csg>]>;

/// Trees that are nested deeper are traversed with an explicit stack.
const SHALLOW: u32 = 24;

/// The most leaves of a tree: what is known of a leaf takes some hundred bytes.
const MOST_LEAVES: usize = 32;

/// One leaf of as many may be of a shape that lists its crossings, which takes much longer than the test of the others.
const LISTED_SHARE: usize = 4;

/// More planes of one intersection are searched faster by [`HalfSpaces`](super::half_spaces).
const MOST_PLANES: usize = 3;

impl Csg {
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
        let clipped = if bounds.is_empty() && !closed {
            Clipped::of(&nodes, &leaves)
        } else {
            None
        };
        Self {
            clipped,
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

    /// Whether trees of these nodes are searched by [`PacketTree`](super::PacketTree).
    fn goes_together(nodes: &[Node], leaves: &[Leaf]) -> bool {
        let listed = leaves.iter().filter(|leaf| leaf.is_listed()).count();
        leaves.len() <= MOST_LEAVES
            && listed * LISTED_SHARE <= leaves.len()
            && leaves
                .iter()
                .all(|leaf| leaf.has_stays() || leaf.is_listed())
            && nodes.iter().all(|node| {
                let planes = node.half_spaces.as_ref().map_or(0, |planes| planes.len());
                planes <= MOST_PLANES && node.kind != Kind::Operation(Rule::Union)
            })
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

    /// Whether all leaves are solids.
    pub(super) fn is_closed(&self) -> bool {
        self.closed
    }

    /// The number of surface elements of all leaves.
    pub(super) fn element_count(&self) -> u32 {
        self.elements
    }

    /// The tree as a table, if it is small.
    pub(super) fn small(&self) -> Option<&Small> {
        self.small.as_deref()
    }

    /// Its operands, if it is a small intersection of convex solids and of complements of such.
    pub(super) fn convex(&self) -> Option<&Convex> {
        self.convex.as_deref()
    }

    /// Its parts, if it is an open surface that convex solids clip.
    pub(super) fn clipped(&self) -> Option<&Clipped> {
        self.clipped.as_ref()
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
}

/// Collects the operands a hierarchy finds.
pub(super) struct Collector<'a> {
    pub(super) csg: &'a Csg,
    pub(super) core: u32,
    pub(super) candidates: &'a mut Vec<u32>,
}

impl Visitor for Collector<'_> {
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        self.candidates.extend(self.csg.operand(self.core + id));
        t_max
    }
}
