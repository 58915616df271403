use super::Tree;
use super::node::Child;
use crate::bvh::watch::BoxTree;
use strahl_math::Aabb;

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
            let (_, bounds) = node.children().find(|(c, _)| *c == child)?;
            Some((Child::inner(index), bounds.to_aabb()))
        })
    }
}
