//! Top-down traversal.

use super::traverse::Walker;
use super::{Cell, child_box};
use crate::{Place, Visitor};
use strahl_math::Aabb;

/// The parameters at which a ray crosses the first and the last plane of a cell along each axis.
#[derive(Clone, Copy)]
struct Crossings {
    first: [f64; 3],
    last: [f64; 3],
}

impl<V: Visitor> Walker<'_, V> {
    /// Traverses the tree top-down: in every cell the crossings of its planes and of the planes that divide it give the order
    /// of the children. (Revelles, Ureña, Lastra: An efficient parametric algorithm for octree traversal, 2000; Gargantini and
    /// Atkinson, 1993.)
    pub(super) fn downwards(&mut self) {
        let (walk, root) = (self.search.walk, self.search.room.root);
        let mut crossings = Crossings {
            first: [f64::NEG_INFINITY; 3],
            last: [f64::INFINITY; 3],
        };
        let mut mirror = 0;
        for axis in 0..3 {
            let up = walk.up(axis);
            mirror |= usize::from(!up) << axis;
            if walk.moved.direction[axis] != 0.0 {
                let (first, last) = match up {
                    true => (root.min[axis], root.max[axis]),
                    false => (root.max[axis], root.min[axis]),
                };
                crossings.first[axis] = walk.cross(axis, first);
                crossings.last[axis] = walk.cross(axis, last);
            }
        }
        self.cell(self.octree.root, &crossings, mirror, &root, 0);
    }

    /// Traverses a cell; returns whether to continue. `mirror` has a bit for each axis along which the ray goes down, where the
    /// children come in the opposite order. The box is only needed for reports.
    fn cell(
        &mut self,
        cell: Cell,
        at: &Crossings,
        mirror: usize,
        bounds: &Aabb,
        level: u32,
    ) -> bool {
        if cell.is_leaf() {
            if V::WATCHES {
                let (near, far) = (largest(at.first), at.last[smallest(at.last)]);
                let near = if near > self.search.walk.near {
                    near
                } else {
                    self.search.walk.near
                };
                self.report(Place::Leaf(*bounds), level, near, far, None);
            }
            return self.leaf(cell);
        }
        let octree = self.octree;
        let block = &octree.blocks[cell.first as usize];
        let middle = [0, 1, 2].map(|axis| self.middle(axis, block.split[axis]));
        let near = largest(at.first);
        let near = if near > self.search.walk.near {
            near
        } else {
            self.search.walk.near
        };
        // A bit for each dividing plane that the ray has crossed, updated from child to child.
        let mut crossed = 0;
        for (axis, middle) in middle.iter().enumerate() {
            crossed |= usize::from(*middle <= near) << axis;
        }
        loop {
            let mut part = *at;
            for (axis, middle) in middle.iter().enumerate() {
                if crossed >> axis & 1 == 1 {
                    part.first[axis] = *middle;
                } else {
                    part.last[axis] = *middle;
                }
            }
            let axis = smallest(part.last);
            let left = part.last[axis];
            let child = crossed ^ mirror;
            let inner = match V::WATCHES {
                true => child_box(bounds, block.split, child),
                false => *bounds,
            };
            // A primitive hit exactly at the crossing may be listed in the next child only.
            if !self.cell(block.children[child], &part, mirror, &inner, level + 1)
                || self.search.far < left
            {
                return false;
            }
            if crossed >> axis & 1 == 1 {
                return true;
            }
            crossed |= 1 << axis;
        }
    }

    /// The parameter at which the ray crosses a dividing plane; a parallel ray stays on one side.
    #[inline(always)]
    fn middle(&self, axis: usize, plane: f64) -> f64 {
        if self.search.walk.moved.direction[axis] != 0.0 {
            self.search.walk.cross(axis, plane)
        } else if self.search.walk.moved.origin[axis] >= plane {
            f64::NEG_INFINITY
        } else {
            f64::INFINITY
        }
    }
}

#[inline(always)]
fn largest(t: [f64; 3]) -> f64 {
    let m = if t[1] > t[0] { t[1] } else { t[0] };
    if t[2] > m { t[2] } else { m }
}

/// The axis of the smallest; of equal ones the first.
#[inline(always)]
fn smallest(t: [f64; 3]) -> usize {
    let axis = usize::from(t[1] < t[0]);
    if t[2] < t[axis] { 2 } else { axis }
}
