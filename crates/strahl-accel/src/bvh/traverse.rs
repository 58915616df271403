use super::node::Child;
use super::watch::BoxTree;
use super::{Bvh2, MAX_DEPTH, Tree};
use crate::cull::CullRay;
use crate::list::visit_all;
use crate::{Accelerator, TraversalStats, Visitor};
use strahl_math::{Interval, Ray};

impl Accelerator for Bvh2 {
    fn name(&self) -> &'static str {
        "bvh2"
    }

    #[inline]
    fn traverse<V: Visitor>(
        &self,
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        let t_max = visit_all(self.unbounded.ids(), range.max, visitor, stats);
        if t_max > f64::NEG_INFINITY
            && let Some(tree) = &self.tree
            && let Some(cull) = CullRay::new(ray, range, &tree.bounds)
        {
            tree.walk(ray, range.with_max(t_max), &cull, visitor, stats);
        }
    }

    fn bytes(&self) -> usize {
        let tree = self.tree.as_ref().map_or(0, |t| {
            size_of_val(t.nodes.as_slice()) + size_of_val(t.ids.as_slice())
        });
        tree + self.unbounded.bytes()
    }

    fn nodes(&self) -> usize {
        self.tree.as_ref().map_or(0, |t| t.nodes.len())
    }

    fn references(&self) -> usize {
        self.tree.as_ref().map_or(0, |t| t.ids.len()) + self.unbounded.references()
    }
}

impl Tree {
    /// Traverses the tree, the nearer child first.
    #[inline]
    fn walk<V: Visitor>(
        &self,
        ray: &Ray,
        range: Interval,
        cull: &CullRay,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        let mut t_max = range.max;
        let mut far = cull.t_max(t_max);
        let mut current = self.root;
        // The children still to visit, with the parameter at which the ray enters them: at most one of each level.
        let mut stack = [(Child::default(), 0.0f32); MAX_DEPTH];
        let mut depth = 0;
        loop {
            if V::WATCHES {
                self.report(ray, range.with_max(t_max), current, visitor);
            }
            if !current.is_leaf() {
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
                let ids = &self.ids[first..first + current.count as usize];
                let closest = visit_all(ids, t_max, visitor, stats);
                if closest < t_max {
                    if closest == f64::NEG_INFINITY {
                        return;
                    }
                    t_max = closest;
                    far = cull.t_max(t_max);
                }
            }
            // A box that starts exactly at the closest hit is still visited: ids decide ties.
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
