use super::{Bvh2, MAX_DEPTH, Tree};
use crate::boxes::Box32;
use strahl_math::Aabb;

impl Bvh2 {
    /// Checks everything that the traversal relies on: indices are in range, the tree is not deeper than the stack, every box
    /// lies inside its parent's, every primitive that is not empty is in exactly one leaf and inside its box.
    ///
    /// # Errors
    /// The first violation found.
    pub fn validate(&self, bounds: &[Aabb]) -> Result<(), String> {
        let mut places = Places::new(bounds);
        for id in self.unbounded.ids() {
            places.note(*id)?;
        }
        if let Some(tree) = &self.tree {
            tree.validate(bounds, &mut places)?;
        }
        places.finish()
    }
}

/// The number of leaves in which each primitive was found.
pub(crate) struct Places<'a> {
    seen: Vec<u32>,
    bounds: &'a [Aabb],
}

impl<'a> Places<'a> {
    pub(crate) fn new(bounds: &'a [Aabb]) -> Self {
        let seen = vec![0; bounds.len()];
        Self { seen, bounds }
    }

    /// Counts a primitive.
    pub(crate) fn note(&mut self, id: u32) -> Result<(), String> {
        let count = self.seen.get_mut(id as usize);
        *count.ok_or_else(|| format!("primitive {id} does not exist"))? += 1;
        Ok(())
    }

    /// Whether each primitive was found once, and empty ones never.
    pub(crate) fn finish(self) -> Result<(), String> {
        for (id, (count, b)) in self.seen.iter().zip(self.bounds).enumerate() {
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

impl Tree {
    /// Checks the tree.
    fn validate(&self, bounds: &[Aabb], places: &mut Places<'_>) -> Result<(), String> {
        let whole = Box32::try_new(self.bounds.bounds()).ok_or("the tree has no bounds")?;
        let mut waiting = vec![(self.root, whole, 0)];
        let mut visited = 0;
        while let Some((child, own, depth)) = waiting.pop() {
            let first = child.first as usize;
            if child.is_leaf() {
                let end = first + child.count as usize;
                let ids = self
                    .ids
                    .get(first..end)
                    .ok_or_else(|| format!("ids {first}..{end} do not exist"))?;
                for id in ids {
                    places.note(*id)?;
                    let inside =
                        Box32::try_new(&bounds[*id as usize]).is_some_and(|b| own.contains(&b));
                    if !inside {
                        return Err(format!("primitive {id} sticks out of its leaf"));
                    }
                }
                continue;
            }
            visited += 1;
            if visited > self.nodes.len() {
                return Err(format!("node {first} is in a circle or has two parents"));
            }
            if depth >= MAX_DEPTH {
                return Err(format!("node {first} is on level {depth}"));
            }
            let node = self
                .nodes
                .get(first)
                .ok_or_else(|| format!("node {first} does not exist"))?;
            for (side, child) in node.children.iter().enumerate() {
                let inner = node.bounds(side);
                if !own.contains(&inner) {
                    return Err(format!("a child of node {first} sticks out"));
                }
                waiting.push((*child, inner, depth + 1));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::node::Child;
    use super::*;
    use strahl_math::DVec3;

    fn row(n: u32) -> (Vec<Aabb>, Bvh2) {
        let boxes: Vec<Aabb> = (0..n)
            .map(|i| {
                let corner = DVec3::X * f64::from(2 * i);
                Aabb::new(corner, corner + DVec3::ONE)
            })
            .collect();
        let bvh = Bvh2::build(&boxes);
        (boxes, bvh)
    }

    /// The error message for a tree after one change to it.
    fn complaint(spoil: impl FnOnce(&mut Tree)) -> String {
        let (boxes, mut bvh) = row(100);
        assert_eq!(bvh.validate(&boxes), Ok(()));
        spoil(bvh.tree.as_mut().expect("bounded boxes"));
        bvh.validate(&boxes).expect_err("spoiled")
    }

    #[test]
    fn every_kind_of_damage_is_found() {
        let leaf = |t: &Tree| {
            (0..t.nodes.len())
                .find(|n| t.nodes[*n].children[0].is_leaf())
                .expect("a leaf")
        };
        for (expected, found) in [
            ("does not exist", complaint(|t| t.ids[3] = 100)),
            ("sticks out of its leaf", complaint(|t| t.ids.swap(0, 99))),
            ("sticks out", complaint(|t| t.nodes[0].boxes[0][0] -= 1.0)),
            ("sticks out", complaint(|t| t.nodes[1].boxes[1][3] += 1.0)),
            (
                "is on level",
                complaint(|t| {
                    let whole = Box32::try_new(t.bounds.bounds()).expect("bounded");
                    t.nodes[0].boxes = Box32::pair(&whole, &whole);
                    t.nodes[0].children = [Child::inner(0); 2];
                }),
            ),
            (
                "do not exist",
                complaint(|t| {
                    let n = leaf(t);
                    t.nodes[n].children[0].count = 1000;
                }),
            ),
            (
                "places",
                complaint(|t| {
                    let n = leaf(t);
                    t.nodes[n].children[1] = t.nodes[n].children[0];
                    let own = t.nodes[n].boxes.map(|p| [p[0], p[0], p[2], p[2]]);
                    t.nodes[n].boxes = own;
                }),
            ),
        ] {
            assert!(
                found.contains(expected),
                "expected `{expected}`, found `{found}`"
            );
        }
    }

    #[test]
    fn boxes_of_another_scene_do_not_fit() {
        let (_, bvh) = row(100);
        assert!(bvh.validate(&row(99).0).is_err());
        assert!(bvh.validate(&row(101).0).is_err());
    }
}
