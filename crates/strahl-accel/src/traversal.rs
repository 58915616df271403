use strahl_math::{Interval, Ray};

/// What is done with the primitives a ray may meet.
pub trait Visitor {
    /// Looks at primitive `id`, knowing that only `t <= t_max` is still of interest.
    ///
    /// Returns the new `t_max`: unchanged on a miss, the distance of the hit if one was found,
    /// `f64::NEG_INFINITY` to end the traversal at once.
    fn visit(&mut self, id: u32, t_max: f64) -> f64;
}

/// What a traversal cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraversalStats {
    /// Nodes (or cells) looked at.
    pub node_visits: u64,
    /// Primitives looked at.
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
/// Directions may have any finite length but zero. A ray that is none (a coordinate that is not finite, no direction) does no
/// harm: some primitives are visited, perhaps none.
pub trait Accelerator: Send + Sync {
    /// The name used on the command line and in the statistics.
    fn name(&self) -> &'static str;

    /// Walks the structure along the ray.
    fn traverse<V: Visitor>(
        &self,
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    );

    /// Bytes the structure occupies.
    fn bytes(&self) -> usize;

    /// Number of nodes or cells.
    fn nodes(&self) -> usize;

    /// Number of references from leaves to primitives.
    fn references(&self) -> usize;
}
