use super::{Bvh2, MAX_DEPTH};
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
        let mut waiting = if self.nodes.is_empty() {
            vec![]
        } else {
            vec![(0usize, 1usize)]
        };
        let mut visited = 0;
        while let Some((index, depth)) = waiting.pop() {
            visited += 1;
            if depth > MAX_DEPTH || visited > self.nodes.len() {
                return Err(format!("node {index} is on level {depth}"));
            }
            let node = &self.nodes[index];
            let own = Box32 {
                lo: node.lo,
                hi: node.hi,
            };
            let first = node.first as usize;
            if node.count == 0 {
                let pair = self
                    .nodes
                    .get(first..first + 2)
                    .ok_or(format!("node {index} has no children"))?;
                for (offset, child) in pair.iter().enumerate() {
                    if !own.contains(&Box32 {
                        lo: child.lo,
                        hi: child.hi,
                    }) {
                        return Err(format!("a child of node {index} sticks out"));
                    }
                    waiting.push((first + offset, depth + 1));
                }
                continue;
            }
            let ids = self
                .ids
                .get(first..first + node.count as usize)
                .ok_or(format!("leaf {index} is out of range"))?;
            for id in ids {
                note(*id)?;
                if !own.contains(&Box32::new(&bounds[*id as usize])) {
                    return Err(format!("primitive {id} sticks out of its leaf"));
                }
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
