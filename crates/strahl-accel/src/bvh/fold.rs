use super::node::Child;
use super::{Bvh2, Tree};

impl Bvh2 {
    /// Folds the tree bottom-up: `leaf` gives the value of a primitive, `join` combines two. `None` for a tree without
    /// primitives.
    ///
    /// Primitives of one leaf are joined one by one; unbounded ones are left out.
    pub(crate) fn fold<T>(&self, leaf: impl Fn(u32) -> T, join: impl Fn(T, T) -> T) -> Option<T> {
        let tree = self.tree.as_ref()?;
        tree.fold(tree.root, &leaf, &join)
    }
}

impl Tree {
    /// Recursion is as deep as the tree.
    fn fold<T>(
        &self,
        child: Child,
        leaf: &impl Fn(u32) -> T,
        join: &impl Fn(T, T) -> T,
    ) -> Option<T> {
        let first = child.first as usize;
        if child.is_leaf() {
            let ids = &self.ids[first..first + child.count as usize];
            return ids.iter().map(|id| leaf(*id)).reduce(join);
        }
        let [a, b] = self.nodes[first].children.map(|c| self.fold(c, leaf, join));
        Some(join(a?, b?))
    }
}
