//! Reports the traversal of a tree of boxes to a visitor that watches. Nodes don't store their parents, so they are searched
//! for: slow, but only done for such visitors.

use super::Tree;
use super::node::Child;
use crate::{Place, Step, Visitor};
use strahl_math::{Aabb, Interval, Ray};

/// A tree in which the box of a child is stored in its parent.
pub(crate) trait BoxTree {
    /// A node or a leaf.
    type Child: Copy;

    /// The box of the root.
    fn whole(&self) -> &Aabb;

    /// Whether a child is a leaf.
    fn is_leaf(child: Self::Child) -> bool;

    /// The parent of a child, and the child's box; `None` for the root.
    fn parent(&self, child: Self::Child) -> Option<(Self::Child, Aabb)>;

    /// Reports that the traversal visits a node or a leaf.
    fn report<V: Visitor>(&self, ray: &Ray, range: Interval, child: Self::Child, visitor: &mut V) {
        let (mut level, mut bounds, mut current) = (0, *self.whole(), child);
        while let Some((parent, own)) = self.parent(current) {
            if level == 0 {
                bounds = own;
            }
            level += 1;
            current = parent;
        }
        let inside = bounds.clip(ray, range);
        visitor.step(Step {
            place: match Self::is_leaf(child) {
                true => Place::Leaf(bounds),
                false => Place::Node(bounds),
            },
            level,
            // Conservative culling also visits boxes that the ray narrowly misses.
            near: inside.map_or(f64::NAN, |i| i.min),
            far: inside.map_or(f64::NAN, |i| i.max),
            exit: None,
        });
    }
}

impl BoxTree for Tree {
    type Child = Child;

    fn whole(&self) -> &Aabb {
        self.bounds.bounds()
    }

    fn is_leaf(child: Child) -> bool {
        child.is_leaf()
    }

    fn parent(&self, child: Child) -> Option<(Child, Aabb)> {
        self.nodes.iter().enumerate().find_map(|(index, node)| {
            let side = node.children.iter().position(|c| *c == child)?;
            Some((Child::inner(index), node.bounds(side).to_aabb()))
        })
    }
}
