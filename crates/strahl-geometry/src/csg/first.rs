//! The first visible surface, or all of them, without lists of crossings.
//!
//! If only the first hit is wanted, the lists need not be combined node by node. The sorted crossings of all leaves are enough:
//! each changes the state of its leaf, which may change that of the operation above, and so on; the first crossing that changes
//! the root is the answer. This is correct as long as no two crossings are so close together that they could coincide
//! ([`Fusing`](super::fusing::Fusing)). If they are, this search gives up and the general one decides; so both give the same bits.
//!
//! Operands that don't matter are skipped: those whose boxes the ray misses, those that begin behind the first surface found
//! without them, and all others of an intersection once nothing is left of it. (`course` decides that, `timeline` sorts.)

use super::compiled::Csg;
use super::course::Sum;
use super::fusing::TooClose;
use super::node::{Kind, Node};
use super::search::{Lists, Search};
use super::sweep::Rule;
use super::timeline::State;
use crate::{PrimHit, Scratch, SurfaceId};
use strahl_math::{Interval, Ray};

/// The result of this search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Answer {
    /// The first visible hit, or none.
    Certain(Option<PrimHit>),
    /// Unknown: crossings are too close together.
    Unclear,
}

/// Searches the first visible surface with `range.min < t <= range.max` of a tree of solids that is not too deep.
pub(super) fn first_visible(
    csg: &Csg,
    ray: &Ray,
    range: Interval,
    from: Option<SurfaceId>,
    lists: &mut Lists,
    scratch: &mut Scratch,
) -> Answer {
    let Some(mut search) = Search::new(csg, ray, range, from, lists, scratch) else {
        return Answer::Certain(None);
    };
    match search.run() {
        Ok(found) => Answer::Certain(found),
        Err(TooClose) => Answer::Unclear,
    }
}

/// Appends all visible surfaces with `range.min < t <= range.max` of such a tree, ascending in `t`: those that [`first_visible`] finds one
/// after the other. Fails if crossings are too close together; `out` may have some surfaces more then.
pub(super) fn all_visible(
    csg: &Csg,
    ray: &Ray,
    range: Interval,
    from: Option<SurfaceId>,
    lists: &mut Lists,
    scratch: &mut Scratch,
    out: &mut Vec<PrimHit>,
) -> Result<(), TooClose> {
    match Search::new(csg, ray, range, from, lists, scratch) {
        None => Ok(()),
        Some(mut search) => search.run_to_the_end(out),
    }
}

impl Search<'_> {
    /// Combines all operands and appends what is visible.
    fn run_to_the_end(&mut self, out: &mut Vec<PrimHit>) -> Result<(), TooClose> {
        let csg = self.csg;
        let Some((root, Kind::Operation(rule))) = csg.node(0).map(|root| (root, root.kind)) else {
            return Err(TooClose);
        };
        if rule == Rule::Intersection && self.leaves_for_good(root) {
            return Ok(());
        }
        let range = Interval::new(self.begin, self.fusing.widened(self.range).max);
        let mut sum = Sum::new(rule, range);
        if self.core(0, root, &mut sum)? {
            return Ok(());
        }
        let alive = sum.alive;
        if self.rest(0, root, Interval::LINE, alive, &mut sum)? {
            return Ok(());
        }
        self.visit_seen(sum.state, |hit| {
            out.push(hit);
            true
        })
    }

    /// Goes along the ray from this state of the root to what is visible, until `take` returns false.
    fn visit_seen(
        &mut self,
        state: State,
        take: impl FnMut(PrimHit) -> bool,
    ) -> Result<(), TooClose> {
        let (csg, ray) = (self.csg, self.ray);
        let timeline = &mut self.lists.timeline;
        timeline.set_state(0, state);
        let scratch = &mut *self.scratch;
        let sees = |element| csg.is_seen(element, ray, scratch);
        timeline.visit_seen(csg, self.range, &self.fusing, sees, take)
    }
}

impl Search<'_> {
    /// Visits the root's operands from near to far, until those that begin later can't change the result.
    fn run(&mut self) -> Result<Option<PrimHit>, TooClose> {
        let csg = self.csg;
        let Some((root, Kind::Operation(rule))) = csg.node(0).map(|root| (root, root.kind)) else {
            return Err(TooClose);
        };
        if rule == Rule::Intersection && self.leaves_for_good(root) {
            return Ok(None);
        }
        let range = Interval::new(self.begin, self.fusing.widened(self.range).max);
        let mut sum = Sum::new(rule, range);
        if self.core(0, root, &mut sum)? {
            return Ok(None);
        }
        let alive = sum.alive;
        let mut window = Interval::LINE;
        let mut step = 0.0;
        if rule == Rule::Intersection {
            // Nothing is visible before this.
            let first = if alive.min > self.range.min {
                alive.min
            } else {
                self.range.min
            };
            step = 8.0 * self.fusing.gap(first, first);
            if step.is_finite() {
                window.max = first + step;
            }
        }
        loop {
            if self.rest(0, root, window, alive, &mut sum)? {
                return Ok(None);
            }
            let mut found: Option<PrimHit> = None;
            self.visit_seen(sum.state, |hit| {
                found = Some(hit);
                false
            })?;
            let known = found.map_or(f64::INFINITY, |hit| hit.t + self.fusing.gap(hit.t, hit.t));
            if known <= window.max || alive.max <= window.max {
                return Ok(found);
            }
            // At least twice as far as the last time.
            let far = window.max + 2.0 * step;
            window = Interval::new(window.max, if known > far { known } else { far });
            step = window.max - window.min;
        }
    }

    /// Whether the ray starts on a leaf that is an operand of the root, and leaves it for good.
    #[inline]
    fn leaves_for_good(&self, root: &Node) -> bool {
        let (csg, Some((own, surface))) = (self.csg, self.from) else {
            return false;
        };
        let Some(leaf) = csg.leaf(own).filter(|leaf| leaf.has_stays()) else {
            return false;
        };
        let mut kinds =
            (root.first..root.core).filter_map(|i| Some(csg.node(csg.operand(i)?)?.kind));
        kinds.any(|kind| matches!(kind, Kind::Leaf(number) if number == own))
            && leaf
                .stay(self.ray, Some(surface))
                .is_some_and(|stay| leaf.is_left_for_good(&stay, surface))
    }
}
