//! The common base of grids and octrees: which primitives go into cells, and how the primitives of a cell are visited.

use crate::boxes::Box32;
use crate::list::visit_all;
use crate::walk::{Room, Walk};
use crate::{Exit, List, Place, Shapes, Step, TraversalStats, Visitor};
use strahl_math::{Aabb, Interval, Ray};

/// The data that every structure of cells has.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Base {
    /// The box that is divided, if it is not empty.
    pub(crate) room: Option<Room>,
    /// The primitives that are in no cell: without bounds, or too far away for f32.
    pub(crate) unbounded: List,
    /// The construction of V. Havran's published figures: primitives may be tested repeatedly, and no empty cells are skipped.
    pub(crate) published: bool,
}

impl Base {
    /// The base for some primitives, and those of them that go into cells.
    pub(crate) fn gather(shapes: &dyn Shapes, published: bool) -> (Self, Vec<u32>) {
        let (mut ids, mut unbounded, mut whole) = (Vec::new(), Vec::new(), Aabb::EMPTY);
        for id in 0..shapes.count() as u32 {
            let bounds = shapes.bounds(id);
            if Box32::try_new(&bounds).is_some() {
                ids.push(id);
                whole = whole.union(&bounds);
            } else if !bounds.is_empty() {
                unbounded.push(id);
            }
        }
        let room = (!ids.is_empty()).then(|| match published {
            true => Room::published(whole),
            false => Room::new(whole),
        });
        let base = Self {
            room,
            unbounded: List::of(unbounded),
            published,
        };
        (base, ids)
    }

    /// Visits the primitives that are in no cell, then those of the cells that `walk` finds along the ray.
    #[inline(always)]
    pub(crate) fn search<V: Visitor>(
        &self,
        ray: &Ray,
        range: Interval,
        visitor: &mut V,
        stats: &mut TraversalStats,
        walk: impl FnOnce(Search<'_, V>),
    ) {
        let t_max = visit_all(self.unbounded.ids(), range.max, visitor, stats);
        if t_max > f64::NEG_INFINITY
            && let Some(room) = &self.room
            && let Some(way) = Walk::new(ray, range, room)
        {
            walk(Search {
                room,
                walk: &way,
                far: way.moved.upper(t_max),
                t_max,
                mailbox: Mailbox::new(),
                published: self.published,
                visitor,
                stats,
            });
        }
    }
}

/// A ray on its way through cells, and the state of its search.
pub(crate) struct Search<'w, V> {
    pub(crate) room: &'w Room,
    pub(crate) walk: &'w Walk,
    /// The upper end of the range, in the parameters of the walk.
    pub(crate) far: f64,
    t_max: f64,
    mailbox: Mailbox,
    published: bool,
    visitor: &'w mut V,
    pub(crate) stats: &'w mut TraversalStats,
}

impl<V: Visitor> Search<'_, V> {
    /// Passes the primitives of a cell to the visitor; returns whether it wants more.
    #[inline(always)]
    pub(crate) fn visit(&mut self, ids: &[u32]) -> bool {
        for id in ids {
            if !self.published && !self.mailbox.is_new(*id) {
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

    /// Reports a cell to a visitor that watches.
    pub(crate) fn tell(
        &mut self,
        place: Place,
        level: u32,
        near: f64,
        far: f64,
        exit: Option<Exit>,
    ) {
        self.visitor.step(Step {
            place,
            level,
            near: self.walk.original(near),
            far: self.walk.original(far),
            exit,
        });
    }
}

/// Remembers the primitives visited last, so that one which lies in several cells is not tested again. An inverse mailbox:
/// nothing to clear, and nothing stored with the primitives.
#[derive(Clone, Copy, Debug)]
struct Mailbox {
    last: [u32; Self::SIZE],
    next: usize,
}

impl Mailbox {
    const SIZE: usize = 8;

    fn new() -> Self {
        Self {
            last: [u32::MAX; Self::SIZE],
            next: 0,
        }
    }

    /// Whether this primitive is not among the last ones; it is added to them.
    #[inline(always)]
    fn is_new(&mut self, id: u32) -> bool {
        let mut known = false;
        for other in self.last {
            known |= other == id;
        }
        if !known {
            self.last[self.next] = id;
            self.next = (self.next + 1) % Self::SIZE;
        }
        !known
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mailbox_knows_the_last_eight() {
        let mut mailbox = Mailbox::new();
        assert!((0..8).all(|id| mailbox.is_new(id)));
        assert!((0..8).all(|id| !mailbox.is_new(id)));
        assert!(mailbox.is_new(8) && mailbox.is_new(0) && !mailbox.is_new(2));
    }
}
