use super::exit::Leaving;
use super::{Block, Cell, Octree, Traversal, child_box};
use crate::list::visit_all;
use crate::walk::{Mailbox, Room, Walk};
use crate::{Accelerator, Exit, Place, Step, TraversalStats, Visitor};
use strahl_math::{Aabb, Interval, Ray};

impl Accelerator for Octree {
    fn name(&self) -> &'static str {
        "octree"
    }

    #[inline]
    fn traverse<V: Visitor>(
        &self,
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
    ) {
        let t_max = visit_all(self.unbounded.ids(), range.max, visitor, stats);
        if t_max > f64::NEG_INFINITY
            && let Some(room) = &self.room
            && let Some(walk) = Walk::new(ray, range, room)
        {
            let mut walker = Walker {
                octree: self,
                room,
                walk: &walk,
                t_max,
                far: walk.moved.upper(t_max),
                mailbox: Mailbox::new(),
                visitor,
                stats,
            };
            if walk.is_thick(room) {
                walker.thick(self.root, &room.root);
                return;
            }
            match self.traversal {
                Traversal::Parametric => walker.downwards(),
                kind => walker.steps(kind),
            }
        }
    }

    fn bytes(&self) -> usize {
        size_of_val(self.blocks.as_slice())
            + size_of_val(self.ids.as_slice())
            + self.unbounded.bytes()
    }

    /// The leaves, empty ones too.
    fn nodes(&self) -> usize {
        usize::from(self.room.is_some()) + 7 * self.blocks.len()
    }

    fn references(&self) -> usize {
        self.ids.len() + self.unbounded.references()
    }
}

/// A ray on its way through the leaves.
pub(super) struct Walker<'w, V> {
    pub(super) octree: &'w Octree,
    pub(super) room: &'w Room,
    pub(super) walk: &'w Walk,
    t_max: f64,
    /// `t_max` as the walk counts.
    pub(super) far: f64,
    mailbox: Mailbox,
    visitor: &'w mut V,
    stats: &'w mut TraversalStats,
}

impl<V: Visitor> Walker<'_, V> {
    /// Shows the primitives of a leaf to the visitor; returns whether it wants more.
    #[inline(always)]
    pub(super) fn leaf(&mut self, leaf: Cell) -> bool {
        self.stats.node_visits += 1;
        let octree = self.octree;
        let first = leaf.first as usize;
        for id in &octree.ids[first..first + leaf.count as usize] {
            if !octree.plain && !self.mailbox.is_new(*id) {
                continue;
            }
            self.stats.primitive_tests += 1;
            let closest = self.visitor.visit(*id, self.t_max);
            if closest < self.t_max {
                if closest == f64::NEG_INFINITY {
                    return false;
                }
                self.t_max = closest;
                self.far = self.walk.moved.upper(closest);
            }
        }
        true
    }

    /// Looks at all leaves within the margin of a thick ray; returns whether to go on. Not deeper than the tree.
    fn thick(&mut self, cell: Cell, bounds: &Aabb) -> bool {
        if self.walk.meets(bounds, self.far).is_none() {
            return true;
        }
        if cell.is_leaf() {
            return self.leaf(cell);
        }
        let Block { split, children } = self.octree.blocks[cell.first as usize];
        (0..8).all(|child| self.thick(children[child], &child_box(bounds, split, child)))
    }

    /// Tells those who watch.
    pub(super) fn report(
        &mut self,
        place: Place,
        level: u32,
        near: f64,
        far: f64,
        leaving: Option<Leaving>,
    ) {
        let exit = leaving.map(|l| Exit {
            axis: l.axis,
            up: self.walk.up(l.axis),
            region: l.region,
        });
        self.visitor.step(Step {
            place,
            level,
            near: self.walk.original(near),
            far: self.walk.original(far),
            exit,
        });
    }
}
