use crate::leaf::Leaf;
use crate::{Beam, Packet, PacketVisitor};
use strahl_math::{Aabb, DVec3, Interval, Ray};
use strahl_simd::Isa;

/// Tests the primitives that a ray may meet.
pub trait Visitor {
    /// Tests primitive `id`, where only hits with `t <= t_max` count.
    ///
    /// Returns the new `t_max`: unchanged on a miss, the distance of the hit if one was found,
    /// `f64::NEG_INFINITY` to end the traversal at once.
    fn visit(&mut self, id: u32, t_max: f64) -> f64;

    /// Whether the first hit ends the traversal; then children need not be sorted.
    const ANY: bool = false;

    /// Tests all primitives of a leaf of a structure with blocks of slots (see [`Bvh8`](crate::Bvh8)), where only hits with `t
    /// <= t_max` count; returns as [`Visitor::visit`]. Called inside of [`Isa::call`].
    ///
    /// The default visits them one by one.
    #[inline(always)]
    fn visit_leaf<I: Isa>(&mut self, _isa: I, leaf: &Leaf<'_>, mut t_max: f64) -> f64 {
        for id in leaf.ids() {
            t_max = self.visit(*id, t_max);
            if t_max == f64::NEG_INFINITY {
                break;
            }
        }
        t_max
    }

    /// The address of the data of a block that [`Visitor::visit_leaf`] will read, to be prefetched; null to prefetch nothing.
    /// The block need not exist.
    #[inline(always)]
    fn block_address(&self, _block: usize) -> *const u8 {
        std::ptr::null()
    }

    /// Whether [`Visitor::step`] is to be called; if not, it costs nothing.
    const WATCHES: bool = false;

    /// The traversal visits a node or a cell; if it is a leaf, the primitives visited next are in it.
    fn step(&mut self, _step: Step) {}
}

/// A step of a ray's traversal, for visitors that watch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The node or cell visited.
    pub place: Place,
    /// Level in the structure, 0 at the root.
    pub level: u32,
    /// The parameter at which the ray enters; `t` as the visitor counts it, with the margin of conservative culling.
    pub near: f64,
    /// The parameter at which it leaves; infinite where the traversal need not know.
    pub far: f64,
    /// How it leaves, where the traversal computes that.
    pub exit: Option<Exit>,
}

/// A place in a structure.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Place {
    /// An inner node with its box.
    Node(Aabb),
    /// A leaf with its box; primitives visited next are in it.
    Leaf(Aabb),
    /// A bounding sphere (centre and radius) of inner nodes.
    Sphere(DVec3, f64),
    /// A bounding sphere of primitives.
    LeafSphere(DVec3, f64),
    /// A cell of a grid with its indices.
    Cell([u32; 3], Aabb),
    /// Several empty cells skipped in one step.
    Empty(Aabb),
}

/// How a ray leaves a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exit {
    /// The axis its exit face is perpendicular to.
    pub axis: usize,
    /// Whether it leaves towards larger coordinates.
    pub up: bool,
    /// The region of its intersection with the trial exit plane, if that was used: 0 inside the face, 1 to 4 beyond an edge, 5
    /// to 8 beyond a corner.
    pub region: Option<u8>,
}

/// The cost of a traversal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraversalStats {
    /// Nodes (or cells) visited.
    pub node_visits: u64,
    /// Primitives tested.
    pub primitive_tests: u64,
}

impl std::ops::AddAssign for TraversalStats {
    fn add_assign(&mut self, other: Self) {
        self.node_visits += other.node_visits;
        self.primitive_tests += other.primitive_tests;
    }
}

/// A structure over the boxes of primitives `0..n`.
///
/// # Contract
/// [`Accelerator::traverse`] visits every primitive whose box the ray may meet with `range.min < t <= t_max`, in any
/// order, each at most once unless the structure says otherwise, where `t_max` starts at `range.max` and becomes what
/// the visitor returns. It skips others as it can. Boxes may be unbounded; an empty box is never visited.
///
/// Directions may have any finite length but zero. An invalid ray (a coordinate that is not finite, a direction of length zero)
/// does no harm: some primitives are visited, perhaps none.
pub trait Accelerator: Send + Sync {
    /// The name used on the command line and in the statistics.
    fn name(&self) -> &'static str;

    /// Traverses the structure along the ray.
    fn traverse<V: Visitor>(
        &self,
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    );

    /// Traverses the structure along the rays of a packet, as [`Accelerator::traverse`] along each. Returns `false`, having
    /// done nothing, if it does not support packets.
    fn traverse_packet<V: PacketVisitor>(
        &self,
        _packet: &mut Packet<'_>,
        _visitor: &mut V,
        _stats: &mut TraversalStats,
    ) -> bool {
        false
    }

    /// Whether certainly no ray of a beam meets the box of any primitive; `false` from a structure without such a test.
    fn misses(&self, _beam: &Beam) -> bool {
        false
    }

    /// The primitives in the order of the leaves' slots, for [`Visitor::visit_leaf`]; empty if the structure has no slots.
    fn slots(&self) -> &[u32] {
        &[]
    }

    /// Bytes the structure occupies.
    fn bytes(&self) -> usize;

    /// Number of nodes or cells.
    fn nodes(&self) -> usize;

    /// Number of references from leaves to primitives.
    fn references(&self) -> usize;
}
