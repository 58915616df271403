//! The kinds of queries: the closest hit, any opaque hit, all transmitting hits.

use crate::hit::Hit;
use crate::prim::Prim;
use crate::scene::{Part, RenderGroup};
use strahl_accel::Step;

/// What a search does with the primitives that its ray may hit.
pub(super) trait Query {
    /// Whether primitives with these flags matter.
    fn wants(&self, flags: u8) -> bool;

    /// The part of a group that has all primitives that matter, if there is a separate accelerator for it.
    fn part<'g>(&self, _group: &'g RenderGroup) -> Option<&'g Part> {
        None
    }

    /// Whether the first hit on a primitive with these flags, if it has only one element, can be taken without a filter.
    #[inline(always)]
    fn is_unfiltered(&self, flags: u8) -> bool {
        Self::HAS_FAST_SEARCH && self.is_unfiltered_flat(flags)
    }

    /// The same for a flat primitive, which a ray hits at most once.
    #[inline(always)]
    fn is_unfiltered_flat(&self, flags: u8) -> bool {
        let mixed = flags & (Prim::TRANSMITS | Prim::STOPS) == Prim::TRANSMITS | Prim::STOPS;
        flags & Prim::FILTERED == 0 && !mixed && self.wants(flags)
    }

    /// Takes a hit and returns the new upper end of the range, `-inf` to end the search.
    fn take(&mut self, hit: Hit, t_max: f64) -> f64;

    /// Whether all hits on a primitive matter, not only the first.
    const ALL: bool;

    /// Whether any hit will do.
    const ANY: bool = false;

    /// Whether groups of one kind of primitive are searched in a loop of their own. Each loop is compiled once for each instruction set, so
    /// only the frequent queries have them.
    const HAS_FAST_SEARCH: bool = !Self::ALL && !Self::WATCHES;

    /// Whether [`Query::wants_hit`] tells which hits on a primitive with these flags matter; if not, all of them do.
    #[inline]
    fn chooses(&self, flags: u8) -> bool {
        let both = Prim::TRANSMITS | Prim::STOPS;
        flags & both == both
    }

    /// Whether hits on elements with a transmitting (or opaque) material matter; called only for primitives with both kinds.
    fn wants_hit(&self, transmits: bool) -> bool;

    /// Whether [`Query::tell`] is to be called; if not, it costs nothing.
    const WATCHES: bool = false;

    /// Reports a step of the traversal.
    fn tell(&mut self, _event: WalkEvent) {}
}

/// Finds the closest hit; of several at the same `t` that with the smallest id. It is the closest so far.
pub(super) type Closest = Option<Hit>;

impl Query for Closest {
    const ALL: bool = false;

    fn wants(&self, _: u8) -> bool {
        true
    }

    #[inline]
    fn take(&mut self, hit: Hit, t_max: f64) -> f64 {
        if self.is_none_or(|best| hit.beats(&best)) {
            *self = Some(hit);
            hit.t
        } else {
            t_max
        }
    }

    fn wants_hit(&self, _: bool) -> bool {
        true
    }
}

/// Finds the closest hit for an explanation: on any surface or on opaque ones only, with or without a record of the traversal. Tests are
/// made one by one.
pub(super) struct Watched<'e> {
    pub(super) closest: Closest,
    /// Whether only opaque surfaces count: those that block a shadow ray.
    pub(super) opaque: bool,
    pub(super) events: Option<&'e mut Vec<WalkEvent>>,
}

impl Query for Watched<'_> {
    const ALL: bool = false;
    const WATCHES: bool = true;

    fn wants(&self, flags: u8) -> bool {
        !self.opaque || flags & Prim::STOPS != 0
    }

    fn take(&mut self, hit: Hit, t_max: f64) -> f64 {
        Query::take(&mut self.closest, hit, t_max)
    }

    fn wants_hit(&self, transmits: bool) -> bool {
        !(self.opaque && transmits)
    }

    fn tell(&mut self, event: WalkEvent) {
        if let Some(events) = &mut self.events {
            events.push(event);
        }
    }
}

/// Finds any opaque surface.
#[derive(Clone, Copy)]
pub(super) struct Any {
    /// An element of the primitive found.
    pub(super) found: Option<u64>,
}

impl Any {
    pub(super) const OPAQUE: Self = Self { found: None };
}

impl Query for Any {
    const ALL: bool = false;

    fn wants(&self, flags: u8) -> bool {
        flags & (Prim::STOPS | Prim::TOGETHER) == Prim::STOPS
    }

    fn part<'g>(&self, group: &'g RenderGroup) -> Option<&'g Part> {
        group.stopping.as_deref()
    }

    const ANY: bool = true;

    fn take(&mut self, hit: Hit, _: f64) -> f64 {
        self.found = Some(hit.id);
        f64::NEG_INFINITY
    }

    fn wants_hit(&self, transmits: bool) -> bool {
        !transmits
    }
}

/// Collects all hits on surfaces that may transmit light.
pub(super) struct Transmitting<'h> {
    pub(super) hits: &'h mut Vec<Hit>,
}

impl Query for Transmitting<'_> {
    const ALL: bool = true;

    fn wants(&self, flags: u8) -> bool {
        flags & Prim::TRANSMITS != 0
    }

    fn part<'g>(&self, group: &'g RenderGroup) -> Option<&'g Part> {
        group.transmitting.as_deref()
    }

    fn take(&mut self, hit: Hit, t_max: f64) -> f64 {
        self.hits.push(hit);
        t_max
    }

    /// The opaque surfaces of a tree of both kinds stop the light when it comes to them.
    fn chooses(&self, flags: u8) -> bool {
        let all = Prim::TRANSMITS | Prim::STOPS | Prim::TOGETHER;
        flags & all == Prim::TRANSMITS | Prim::STOPS
    }

    fn wants_hit(&self, transmits: bool) -> bool {
        transmits
    }
}

/// An event of the traversal.
#[derive(Clone, Copy, Debug)]
pub enum WalkEvent {
    /// The accelerator visited a node or a cell; if it is a leaf, the following events belong to it.
    Step(Step),
    /// A primitive was tested.
    Test {
        /// Number of its first element.
        id: u64,
        /// Number of its object.
        object: u32,
        /// The closest hit so far, after the test; `None` if there is none.
        closest: Option<f64>,
        /// Whether the test found that hit.
        found: bool,
    },
    /// An instance was entered; the following events are in its space, whose `t` is the same.
    Enter {
        /// Number of its first element.
        id: u64,
    },
    /// The instance was left.
    Leave,
}
