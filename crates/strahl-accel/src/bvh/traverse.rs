use super::{Bvh2, Child, MAX_DEPTH};
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
        if let Some(root) = self.root
            && let Some(cull) = CullRay::new(ray, range, &self.bounds, self.max_abs)
        {
            self.walk(root, &cull, t_max, visitor, stats);
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
        root: Child,
        cull: &CullRay,
        mut t_max: f64,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        let mut far = cull.t_max(t_max);
        let mut current = root;
        // What is left to visit, with the parameter at which the ray gets there.
        let mut stack = [(Child::default(), 0.0f32); MAX_DEPTH];
        let mut depth = 0;
        loop {
            if current.count == 0 {
                stats.node_visits += 1;
                let node = &self.nodes[current.first as usize];
                let (near, hit) = cull.enter(&node.boxes, far);
                match hit {
                    0 => {}
                    1 => {
                        current = node.children[0];
                        continue;
                    }
                    2 => {
                        current = node.children[1];
                        continue;
                    }
                    _ => {
                        let later = usize::from(near[0] <= near[1]);
                        stack[depth] = (node.children[later], near[later]);
                        depth += 1;
                        current = node.children[1 - later];
                        continue;
                    }
                }
            } else {
                let first = current.first as usize;
                let before = t_max;
                for id in &self.ids[first..first + current.count as usize] {
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
                let (child, near) = stack[depth];
                if near <= far {
                    current = child;
                    break;
                }
            }
        }
    }
}
