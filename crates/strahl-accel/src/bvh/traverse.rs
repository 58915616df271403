use super::{Bvh2, MAX_DEPTH, Node};
use crate::boxes::CullRay;
use crate::{Accelerator, TraversalStats, Visitor};
use strahl_math::{Interval, Ray};

impl Accelerator for Bvh2 {
    fn name(&self) -> &'static str {
        "bvh"
    }

    #[inline]
    fn traverse<V: Visitor>(
        &self,
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        let mut t_max = range.max;
        for id in &self.unbounded {
            stats.primitive_tests += 1;
            t_max = visitor.visit(*id, t_max);
            if t_max == f64::NEG_INFINITY {
                return;
            }
        }
        if !self.nodes.is_empty()
            && let Some(cull) = CullRay::new(ray, range, &self.bounds, self.max_abs)
        {
            self.walk(&cull, t_max, visitor, stats);
        }
    }

    fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
            + size_of_val(self.ids.as_slice())
            + size_of_val(self.unbounded.as_slice())
    }

    fn nodes(&self) -> usize {
        self.nodes.len()
    }

    fn references(&self) -> usize {
        self.ids.len() + self.unbounded.len()
    }
}

impl Bvh2 {
    /// Walks the tree, the nearer child first.
    #[inline]
    fn walk<V: Visitor>(
        &self,
        cull: &CullRay,
        mut t_max: f64,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        let mut far = cull.t_max(t_max);
        let mut node = &self.nodes[0];
        let (near, leave) = cull.slab(&node.lo, &node.hi, far);
        stats.node_visits += 1;
        if near > leave {
            return;
        }
        // What is left to visit, with the parameter at which the ray gets there.
        let mut stack = [(0u32, 0.0f32); MAX_DEPTH];
        let mut depth = 0;
        loop {
            if node.count == 0 {
                stats.node_visits += 1;
                let first = node.first as usize;
                let pair: &[Node] = &self.nodes[first..first + 2];
                let (a, b) = (&pair[0], &pair[1]);
                let (near_a, leave_a) = cull.slab(&a.lo, &a.hi, far);
                let (near_b, leave_b) = cull.slab(&b.lo, &b.hi, far);
                match (near_a <= leave_a, near_b <= leave_b) {
                    (true, true) => {
                        let (next, later, later_near) = if near_b < near_a {
                            (b, first, near_a)
                        } else {
                            (a, first + 1, near_b)
                        };
                        stack[depth] = (later as u32, later_near);
                        depth += 1;
                        node = next;
                        continue;
                    }
                    (true, false) => {
                        node = a;
                        continue;
                    }
                    (false, true) => {
                        node = b;
                        continue;
                    }
                    (false, false) => {}
                }
            } else {
                let first = node.first as usize;
                let before = t_max;
                for id in &self.ids[first..first + node.count as usize] {
                    stats.primitive_tests += 1;
                    t_max = visitor.visit(*id, t_max);
                    if t_max == f64::NEG_INFINITY {
                        return;
                    }
                }
                if t_max < before {
                    far = cull.t_max(t_max);
                }
            }
            // A box that starts exactly at the best hit is still visited: ids decide ties.
            loop {
                if depth == 0 {
                    return;
                }
                depth -= 1;
                let (index, near) = stack[depth];
                if near <= far {
                    node = &self.nodes[index as usize];
                    break;
                }
            }
        }
    }
}
