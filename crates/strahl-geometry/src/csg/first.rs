//! The first visible surface, without lists of crossings.
//!
//! Who only wants to know what a ray meets first need not combine lists node by node. The crossings of all leaves, sorted, tell
//! it: each changes the state of its leaf, which may change that of the operation above, and so on; the first that reaches the
//! root is the answer. That is right as long as no two crossings are so close together that they could be one ([`Fusing`]).
//! Where they are, this way gives up, and the general one decides; so both give the same bits.
//!
//! What can be left out is left out: operands whose boxes the ray misses, or that begin behind the first surface found without
//! them; all others of an intersection, once nothing is left of it. (`course` decides that, `timeline` sorts.)

use super::Csg;
use super::boxes::Slabs;
use super::course::Course;
use super::solid::NO_PARENT;
use super::sweep::Fusing;
use super::timeline::{Timeline, TooClose};
use crate::{PrimHit, Scratch, SurfaceId};
use strahl_math::{Interval, Ray};

/// What this way has found out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Answer {
    /// The first visible hit, or that there is none.
    Certain(Option<PrimHit>),
    /// Nothing: crossings are too close together.
    Unclear,
}

/// The lists of a search, kept from ray to ray.
#[derive(Debug, Default)]
pub(super) struct Lists {
    pub(super) timeline: Timeline,
    /// What hierarchies have found, operation by operation.
    pub(super) candidates: Vec<u32>,
}

/// One ray, looking for the first surface of one tree.
pub(super) struct Search<'a> {
    pub(super) csg: &'a Csg,
    pub(super) ray: &'a Ray,
    pub(super) slabs: Slabs,
    /// The leaf on which the ray starts, and its surface there.
    pub(super) from: Option<(u32, SurfaceId)>,
    pub(super) fusing: Fusing,
    /// What is asked for.
    pub(super) range: Interval,
    /// Where the timeline begins: a little before the range, so that crossings on both sides of its start are told apart; but not
    /// behind the surface that the ray leaves.
    pub(super) begin: f64,
    /// Operands that begin behind this are left out; `None` until the root knows where the first surface can be ...
    pub(super) horizon: Option<f64>,
    /// ... and this is where the first of them may begin.
    pub(super) left_out: f64,
    pub(super) lists: &'a mut Lists,
    pub(super) scratch: &'a mut Scratch,
}

/// Looks for the first visible surface with `range.min < t <= range.max` of a tree that is made of solids, and not too deep.
pub(super) fn first_visible(
    csg: &Csg,
    ray: &Ray,
    range: Interval,
    from: Option<SurfaceId>,
    lists: &mut Lists,
    scratch: &mut Scratch,
) -> Answer {
    let start = if from.is_some() && range.min < 0.0 {
        0.0
    } else {
        range.min
    };
    if !(start < range.max) {
        return Answer::Certain(None);
    }
    let fusing = Fusing::new(ray);
    let before = start - 4.0 * fusing.gap(start, start);
    let mut search = Search {
        csg,
        ray,
        slabs: Slabs::new(ray),
        from: from.map(|surface| {
            let (leaf, element) = csg.leaf_of(surface.element);
            (leaf as u32, SurfaceId { element, ..surface })
        }),
        fusing,
        range: Interval::new(start, range.max),
        begin: if from.is_some() && before < 0.0 {
            0.0
        } else {
            before
        },
        horizon: None,
        left_out: f64::INFINITY,
        lists,
        scratch,
    };
    // First with what begins before the first surface there can be, then with what begins before the one found, then with all.
    for pass in 0..3 {
        let found = match search.pass() {
            Ok(found) => found,
            Err(TooClose) => return Answer::Unclear,
        };
        let known = found.map(|hit| hit.t + search.fusing.gap(hit.t, hit.t));
        let all = search.left_out == f64::INFINITY;
        if all || known.is_some_and(|known| known < search.left_out) {
            return Answer::Certain(found);
        }
        search.horizon = known.filter(|_| pass == 0).or(Some(f64::INFINITY));
    }
    Answer::Unclear
}

impl Search<'_> {
    /// The first visible surface of what begins before the horizon.
    fn pass(&mut self) -> Result<Option<PrimHit>, TooClose> {
        self.lists.timeline.clear(self.csg.node_count());
        self.lists.candidates.clear();
        self.left_out = f64::INFINITY;
        let range = Interval::new(self.begin, self.fusing.widened(self.range).max);
        match self.course(0, NO_PARENT, range)? {
            Course::Constant(_) => Ok(None),
            Course::Varies { .. } => {
                let timeline = &mut self.lists.timeline;
                timeline.first_seen(self.csg, self.range, &self.fusing)
            }
        }
    }

    /// Notes that what begins here has been left out.
    pub(super) fn leave_out(&mut self, begin: f64) {
        if begin < self.left_out {
            self.left_out = begin;
        }
    }

    /// The surface the ray starts on, if it is this leaf's.
    pub(super) fn start_on(&self, leaf: u32) -> Option<SurfaceId> {
        let (other, surface) = self.from?;
        (other == leaf).then_some(surface)
    }

    /// Refuses crossings that could be one with the surface that the ray leaves.
    pub(super) fn check_start(&self, t: f64) -> Result<(), TooClose> {
        if self.from.is_none() || t.abs() > self.fusing.gap(t, 0.0) {
            Ok(())
        } else {
            Err(TooClose)
        }
    }
}
