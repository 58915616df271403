use super::exit::Leaving;
use super::{Block, Cell, Octree, Traversal, child_box};
use crate::cells::Search;
use crate::{Accelerator, Exit, Place, TraversalStats, Visitor};
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
        self.base.search(ray, range, visitor, stats, |search| {
            let (walk, room) = (search.walk, search.room);
            let mut walker = Walker {
                octree: self,
                search,
            };
            if walk.is_thick(room) {
                walker.thick(self.root, &room.root);
                return;
            }
            match self.traversal {
                Traversal::Parametric => walker.downwards(),
                kind => walker.steps(kind),
            }
        });
    }

    fn bytes(&self) -> usize {
        size_of_val(self.blocks.as_slice())
            + size_of_val(self.ids.as_slice())
            + self.base.unbounded.bytes()
    }

    /// The number of leaves, including empty ones.
    fn nodes(&self) -> usize {
        usize::from(self.base.room.is_some()) + 7 * self.blocks.len()
    }

    fn references(&self) -> usize {
        self.ids.len() + self.base.unbounded.references()
    }
}

/// A ray on its way through the leaves.
pub(super) struct Walker<'w, V> {
    pub(super) octree: &'w Octree,
    pub(super) search: Search<'w, V>,
}

impl<V: Visitor> Walker<'_, V> {
    /// Passes the primitives of a leaf to the visitor; returns whether it wants more.
    #[inline(always)]
    pub(super) fn leaf(&mut self, leaf: Cell) -> bool {
        self.search.stats.node_visits += 1;
        let first = leaf.first as usize;
        self.search
            .visit(&self.octree.ids[first..first + leaf.count as usize])
    }

    /// Visits all leaves within the margin of a thick ray; returns whether to continue. Recursion is as deep as the tree.
    fn thick(&mut self, cell: Cell, bounds: &Aabb) -> bool {
        if self.search.walk.meets(bounds, self.search.far).is_none() {
            return true;
        }
        if cell.is_leaf() {
            return self.leaf(cell);
        }
        let Block { split, children } = self.octree.blocks[cell.first as usize];
        (0..8).all(|child| self.thick(children[child], &child_box(bounds, split, child)))
    }

    /// Reports to a visitor that watches.
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
            up: self.search.walk.up(l.axis),
            region: l.region,
        });
        self.search.tell(place, level, near, far, exit);
    }
}
