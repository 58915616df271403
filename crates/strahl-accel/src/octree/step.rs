//! Leaf-to-leaf traversal.

use super::exit::{Leaving, by_three_faces, by_trial_plane, exit_plane, trial_axis};
use super::traverse::Walker;
use super::{Cell, MOST_LEVELS, Traversal, child_box};
use crate::walk::clamp;
use crate::{Place, Visitor};
use strahl_math::{Aabb, DVec3};

/// A cell on the path from the root to a leaf.
#[derive(Clone, Copy)]
struct Ancestor {
    cell: Cell,
    bounds: Aabb,
    /// Which child of its parent it is.
    octant: usize,
}

impl<V: Visitor> Walker<'_, V> {
    /// Walks from leaf to leaf. (Glassner: Space subdivision for fast ray tracing, 1984; with neighbours: Samet, Implementing
    /// ray tracing with octrees and neighbor finding, 1989.)
    ///
    /// No point "slightly behind the face" is needed: on its plane the ray's direction decides which side is meant. The
    /// coordinates never go backwards, so every step makes progress.
    pub(super) fn steps(&mut self, kind: Traversal) {
        let (walk, root) = (self.search.walk, self.search.room.root);
        let trial = trial_axis(walk);
        let mut point = walk.at_within(walk.near, &root);
        let start = Ancestor {
            cell: self.octree.root,
            bounds: root,
            octant: 0,
        };
        let mut path = [start; MOST_LEVELS as usize + 1];
        let (mut level, mut entered) = (0, walk.near);
        loop {
            level = self.descend(&mut path, level, point);
            let leaf = path[level];
            let leaving = match kind {
                Traversal::TrialPlane => by_trial_plane(walk, &leaf.bounds, trial),
                _ => by_three_faces(walk, &leaf.bounds),
            };
            if V::WATCHES {
                let (place, level) = (Place::Leaf(leaf.bounds), level as u32);
                self.report(place, level, entered, leaving.t, Some(leaving));
            }
            // A primitive hit exactly at the crossing may be listed in the next leaf only.
            if !self.leaf(leaf.cell) || self.search.far < leaving.t {
                return;
            }
            let plane = exit_plane(walk, &leaf.bounds, leaving.axis);
            if plane == exit_plane(walk, &root, leaving.axis) {
                return;
            }
            self.advance(&mut point, &leaf.bounds, &leaving, plane);
            entered = leaving.t;
            level = match kind {
                Traversal::Neighbours => self.nearest_ancestor(&path, level, leaving.axis),
                _ => 0,
            };
        }
    }

    /// Descends from a cell of the path to the leaf that contains a point; returns its level.
    #[inline(always)]
    fn descend(
        &mut self,
        path: &mut [Ancestor; MOST_LEVELS as usize + 1],
        mut level: usize,
        point: DVec3,
    ) -> usize {
        let up = [0, 1, 2].map(|axis| self.search.walk.up(axis));
        while !path[level].cell.is_leaf() && level < MOST_LEVELS as usize {
            let parent = path[level];
            let block = &self.octree.blocks[parent.cell.first as usize];
            let mut octant = 0;
            for axis in 0..3 {
                let (p, split) = (point[axis], block.split[axis]);
                let above = if up[axis] { p >= split } else { p > split };
                octant |= usize::from(above) << axis;
            }
            level += 1;
            path[level] = Ancestor {
                cell: block.children[octant],
                bounds: child_box(&parent.bounds, block.split, octant),
                octant,
            };
        }
        level
    }

    /// Moves a point of the ray to the exit from a leaf: exactly onto the plane, and never backwards.
    #[inline(always)]
    fn advance(&self, point: &mut DVec3, leaf: &Aabb, leaving: &Leaving, plane: f64) {
        let p = self.search.walk.moved.at(leaving.t);
        for axis in 0..3 {
            point[axis] = if axis == leaving.axis {
                plane
            } else if self.search.walk.up(axis) {
                clamp(p[axis], point[axis], leaf.max[axis])
            } else {
                clamp(p[axis], leaf.min[axis], point[axis])
            };
        }
    }

    /// The level of the nearest ancestor that the ray does not leave through the same face.
    #[inline(always)]
    fn nearest_ancestor(
        &self,
        path: &[Ancestor; MOST_LEVELS as usize + 1],
        mut level: usize,
        axis: usize,
    ) -> usize {
        let far_side = usize::from(self.search.walk.up(axis));
        while level > 0 && path[level].octant >> axis & 1 == far_side {
            level -= 1;
        }
        level.saturating_sub(1)
    }
}
