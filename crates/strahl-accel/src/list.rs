use crate::{Accelerator, TraversalStats, Visitor};
use strahl_math::{Aabb, Interval, Ray};

/// No acceleration at all: looks at every primitive for every ray. The reference all others are compared with.
#[derive(Clone, Debug, Default)]
pub struct List {
    ids: Vec<u32>,
}

impl List {
    /// The list of all primitives whose box is not empty.
    pub fn build(bounds: &[Aabb]) -> Self {
        let ids = (0..bounds.len() as u32).filter(|id| !bounds[*id as usize].is_empty());
        Self { ids: ids.collect() }
    }
}

impl Accelerator for List {
    fn name(&self) -> &'static str {
        "list"
    }

    fn traverse<V: Visitor>(
        &self,
        _: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        let mut t_max = range.max;
        for id in &self.ids {
            stats.primitive_tests += 1;
            t_max = visitor.visit(*id, t_max);
            if t_max == f64::NEG_INFINITY {
                return;
            }
        }
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
