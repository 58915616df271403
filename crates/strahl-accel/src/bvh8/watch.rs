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
        (0..self.nodes.len()).find_map(|index| {
            let children = self.nodes.children(index)?;
            let (_, bounds) = children.iter().find(|(c, _)| *c == child)?;
            Some((Child::inner(index), bounds.to_aabb()))
        })
    }
}
