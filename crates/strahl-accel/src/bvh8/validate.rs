use super::node::Child;
use super::{Bvh8, Tree};
use crate::boxes::Box32;
use crate::bvh::validate::Places;
use crate::leaf::NO_PRIMITIVE;
use strahl_math::Aabb;

impl Bvh8 {
    /// Checks everything that the traversal relies on: indices are in range, there are no cycles, every box lies inside that of
    /// the tree, every primitive that is not empty is in one leaf and inside all boxes on the way to it; or in several, whose
    /// boxes cover its own.
    ///
    /// # Errors
    /// The first violation found.
    pub fn validate(&self, bounds: &[Aabb]) -> Result<(), String> {
        let mut places = Places::new(bounds);
        for id in self.apart.ids() {
            places.note(*id)?;
        }
        if let Some(tree) = &self.tree {
            tree.validate(bounds, &mut places)?;
        }
        places.finish()
    }
}

impl Tree {
    /// Checks the tree.
    fn validate(&self, bounds: &[Aabb], places: &mut Places<'_>) -> Result<(), String> {
        let whole = Box32::around(self.bounds.bounds());
        let mut waiting: Vec<(Child, Box32)> = vec![(self.root, whole)];
        let mut visited = 0;
        let mut parts = vec![];
        while let Some((child, own)) = waiting.pop() {
            if child.is_leaf() {
                let slots = child.parts().slots();
                let ids = self.slots.get(slots.clone());
                for id in ids.ok_or_else(|| format!("slots {slots:?} do not exist"))? {
                    if *id == NO_PRIMITIVE {
                        return Err(format!("an empty slot among {slots:?}"));
                    }
                    let whole = bounds.get(*id as usize).and_then(Box32::try_new);
                    let whole =
                        whole.ok_or_else(|| format!("primitive {id} is none for a tree"))?;
                    parts.push((*id, whole.clipped(&own)));
                }
                continue;
            }
            visited += 1;
            let number = child.node();
            if visited > self.nodes.len() {
                return Err(format!("node {number} is in a circle or has two parents"));
            }
            let children = self.nodes.children(number);
            for (child, inner) in children.ok_or_else(|| format!("node {number} does not exist"))? {
                if !whole.contains(&inner) {
                    return Err(format!("a child of node {number} sticks out"));
                }
                // The boxes of compact nodes may be larger than their parent's.
                waiting.push((child, own.intersection(&inner)));
            }
        }
        parts.sort_by_key(|(id, _)| *id);
        for parts in parts.chunk_by(|a, b| a.0 == b.0) {
            let id = parts[0].0;
            places.note(id)?;
            let covered = Box32::try_new(&bounds[id as usize])
                .is_some_and(|whole| (0..3).all(|axis| covers(parts, &whole, axis)));
            if !covered {
                return Err(format!("primitive {id} sticks out of a box around it"));
            }
        }
        Ok(())
    }
}

/// Whether boxes reach from one end of another to the other along an axis, without gaps.
fn covers(parts: &[(u32, Box32)], whole: &Box32, axis: usize) -> bool {
    let mut spans: Vec<(f32, f32)> = parts
        .iter()
        .map(|(_, part)| (part.lo()[axis], part.hi()[axis]))
        .collect();
    spans.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut reached = whole.lo()[axis];
    for (lo, hi) in spans {
        if lo > reached {
            return false;
        }
        reached = if hi > reached { hi } else { reached };
    }
    reached >= whole.hi()[axis]
}
