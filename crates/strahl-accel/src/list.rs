use crate::{Accelerator, TraversalStats, Visitor};
use strahl_math::{Aabb, Interval, Ray};

/// No acceleration: visits every primitive for every ray. The reference for all other structures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct List {
    ids: Vec<u32>,
}

impl List {
    /// The list of all primitives whose box is not empty, of at most 2³² boxes.
    pub fn build(bounds: &[Aabb]) -> Self {
        let ids = (0..).zip(bounds).filter(|(_, b)| !b.is_empty());
        Self::of(ids.map(|(id, _)| id).collect())
    }

    /// The list of some primitives, for those that a structure cannot sort, such as unbounded ones.
    pub(crate) fn of(ids: Vec<u32>) -> Self {
        Self { ids }
    }

    pub(crate) fn ids(&self) -> &[u32] {
        &self.ids
    }
}

/// Passes primitives to the visitor one by one and returns the new `t_max`; `f64::NEG_INFINITY` if the visitor wants no more.
#[inline(always)]
pub(crate) fn visit_all<V: Visitor>(
    ids: &[u32],
    mut t_max: f64,
    visitor: &mut V,
    stats: &mut TraversalStats,
) -> f64 {
    for id in ids {
        stats.primitive_tests += 1;
        t_max = visitor.visit(*id, t_max);
        if t_max == f64::NEG_INFINITY {
            break;
        }
    }
    t_max
}

impl Accelerator for List {
    fn name(&self) -> &'static str {
        "list"
    }

    #[inline]
    fn traverse<V: Visitor>(
        &self,
        _: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        visit_all(&self.ids, range.max, visitor, stats);
    }

    fn bytes(&self) -> usize {
        size_of_val(self.ids.as_slice())
    }

    fn nodes(&self) -> usize {
        0
    }

    fn references(&self) -> usize {
        self.ids.len()
    }
}
