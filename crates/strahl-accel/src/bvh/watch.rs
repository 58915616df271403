//! Tells of the way through the tree. Nodes know nothing of their parents, so this searches for them: slow, and only for those
//! who watch.

use super::Tree;
use super::node::Child;
use crate::{Place, Step, Visitor};
use strahl_math::{Aabb, Interval, Ray};

impl Tree {
    /// Tells that the traversal looks at a node or a leaf.
    pub(super) fn report<V: Visitor>(
        &self,
        ray: &Ray,
        range: Interval,
        child: Child,
        visitor: &mut V,
    ) {
        let mut level = 0;
        let mut bounds = *self.bounds.bounds();
        let mut current = child;
        while let Some((parent, own)) = self.parent(current) {
            if level == 0 {
                bounds = own;
            }
            level += 1;
            current = parent;
        }
        let inside = bounds.clip(ray, range);
        visitor.step(Step {
            place: match child.is_leaf() {
                true => Place::Leaf(bounds),
                false => Place::Node(bounds),
            },
            level,
            // Conservative culling also looks at boxes that the ray passes very closely.
            near: inside.map_or(f64::NAN, |i| i.min),
            far: inside.map_or(f64::NAN, |i| i.max),
            exit: None,
        });
    }

    /// The node a child belongs to, and the child's box.
    fn parent(&self, child: Child) -> Option<(Child, Aabb)> {
        self.nodes.iter().enumerate().find_map(|(index, node)| {
            let side = node.children.iter().position(|c| *c == child)?;
            Some((Child::inner(index), node.bounds(side).to_aabb()))
        })
    }
}
