//! Access to the tree, for benchmarks and tools.

use super::node::Child;
use super::{Bvh8, Tree};
use strahl_math::Aabb;

/// A node or a leaf of a [`Bvh8`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Content<'b> {
    /// A node with its number.
    Node(u32),
    /// The primitives of a leaf.
    Leaf(&'b [u32]),
}

impl Bvh8 {
    /// The root of the tree of all bounded primitives, if there are any, with its box.
    pub fn root(&self) -> Option<(Aabb, Content<'_>)> {
        let tree = self.tree.as_ref()?;
        Some((*tree.bounds.bounds(), tree.content(tree.root)))
    }

    /// The children of a node with their boxes; none if there is no node of that number.
    pub fn children(&self, node: u32) -> impl Iterator<Item = (Aabb, Content<'_>)> {
        self.tree.iter().flat_map(move |tree| {
            let children = tree.nodes.children(node as usize).unwrap_or_default();
            let children = children.into_iter();
            children.map(|(child, bounds)| (bounds.to_aabb(), tree.content(child)))
        })
    }
}

impl Tree {
    fn content(&self, child: Child) -> Content<'_> {
        if child.is_leaf() {
            Content::Leaf(&self.slots[child.parts().slots()])
        } else {
            Content::Node(child.node() as u32)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Accelerator;
    use strahl_math::DVec3;

    #[test]
    fn every_node_and_every_primitive_is_found_once() {
        let at = |i: i32| {
            DVec3::new(
                f64::from(i % 10),
                f64::from(i / 10 % 10),
                f64::from(i / 100),
            )
        };
        let boxes: Vec<Aabb> = (0..1000)
            .map(|i| Aabb::new(at(i), at(i) + DVec3::splat(0.5)))
            .collect();
        let bvh = Bvh8::build(&boxes, |_| 1);
        let mut waiting: Vec<_> = bvh.root().into_iter().collect();
        let (mut nodes, mut found) = (0, vec![]);
        while let Some((bounds, content)) = waiting.pop() {
            match content {
                Content::Node(number) => {
                    nodes += 1;
                    let children: Vec<_> = bvh.children(number).collect();
                    assert!((2..=8).contains(&children.len()));
                    for (inner, _) in &children {
                        assert_eq!(bounds.union(inner), bounds);
                    }
                    waiting.extend(children);
                }
                Content::Leaf(ids) => {
                    for id in ids {
                        assert_eq!(bounds.union(&boxes[*id as usize]), bounds);
                        found.push(*id);
                    }
                }
            }
        }
        found.sort_unstable();
        assert_eq!(nodes, bvh.nodes());
        assert!(found.into_iter().eq(0..1000));
        assert_eq!(bvh.children(nodes as u32).count(), 0);
        assert_eq!(Bvh8::build(&[], |_| 1).root(), None);
    }
}
