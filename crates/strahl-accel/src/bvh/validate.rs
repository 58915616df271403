use super::{Bvh2, Child, MAX_DEPTH};
use crate::boxes::Box32;
use strahl_math::Aabb;

impl Bvh2 {
    /// Proves what the traversal relies on: indices in range, no deeper than the stack, every box inside its parent's, every
    /// primitive that is not empty in exactly one place and inside the box of its leaf.
    ///
    /// # Errors
    /// The first thing found wrong, in words.
    pub fn validate(&self, bounds: &[Aabb]) -> Result<(), String> {
        let mut seen = vec![0u32; bounds.len()];
        let mut note = |id: u32| match seen.get_mut(id as usize) {
            Some(count) => {
                *count += 1;
                Ok(())
            }
            None => Err(format!("primitive {id} does not exist")),
        };
        for id in &self.unbounded {
            note(*id)?;
        }
        let whole = Box32 {
            lo: self.bounds.min.to_array().map(|x| x as f32),
            hi: self.bounds.max.to_array().map(|x| x as f32),
        };
        let mut waiting: Vec<(Child, Box32, usize)> =
            self.root.map(|root| (root, whole, 1)).into_iter().collect();
        let mut visited = 0;
        while let Some((child, own, depth)) = waiting.pop() {
            let first = child.first as usize;
            if child.count > 0 {
                let end = first + child.count as usize;
                let ids = self
                    .ids
                    .get(first..end)
                    .ok_or(format!("ids {first}..{end} do not exist"))?;
                for id in ids {
                    note(*id)?;
                    if !own.contains(&Box32::new(&bounds[*id as usize])) {
                        return Err(format!("primitive {id} sticks out of its leaf"));
                    }
                }
                continue;
            }
            visited += 1;
            if depth >= MAX_DEPTH || visited > self.nodes.len() {
                return Err(format!("node {first} is on level {depth}"));
            }
            let node = self
                .nodes
                .get(first)
                .ok_or(format!("node {first} does not exist"))?;
            for (side, child) in node.children.iter().enumerate() {
                let inner = node.bounds(side);
                if !own.contains(&inner) {
                    return Err(format!("a child of node {first} sticks out"));
                }
                waiting.push((*child, inner, depth + 1));
            }
        }
        for (id, (count, b)) in seen.iter().zip(bounds).enumerate() {
            let expected = u32::from(!b.is_empty());
            if *count != expected {
                return Err(format!(
                    "primitive {id} is in {count} places, expected {expected}"
                ));
            }
        }
        Ok(())
    }
}
