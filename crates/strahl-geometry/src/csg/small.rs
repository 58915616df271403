//! The visible surfaces of a few convex shapes and quadrics, some of them subtracted: lenses, capped pieces, drilled blocks.
//!
//! These trees are frequent and their rays cheap, so that the general search spends most of its time on its lists. Here the
//! crossings are sorted in place. As in [`first`](super::first), crossings that could coincide are left to the general evaluation,
//! so all three give the same bits.

use super::first::{Answer, start_and_begin};
use super::leaf::Leaf;
use super::solid::{Kind, Node};
use super::sweep::{Fusing, Rule};
use super::timeline::TooClose;
use crate::primitives::convex::Span;
use crate::{PrimHit, SurfaceId};
use arrayvec::ArrayVec;
use std::ops::ControlFlow;
use strahl_math::{Interval, Ray};

/// The most operands.
const MOST: usize = 6;

/// More planes are searched faster by [`HalfSpaces`](super::half_spaces).
const MOST_PLANES: usize = 3;

/// An intersection of leaves that a line crosses at most twice, and of complements of such leaves.
#[derive(Clone, Debug)]
pub(super) struct Flat {
    /// The numbers of the leaves: those that are visible first, and of each kind those that are not complements.
    leaves: ArrayVec<u32, MOST>,
    /// How many are visible; the others only clip.
    visible: usize,
}

/// A crossing that changes whether the ray is inside of an operand.
#[derive(Clone, Copy)]
struct Event {
    t: f64,
    surface: SurfaceId,
    enters: bool,
    visible: bool,
}

impl Flat {
    /// The root of a tree, if it is such an intersection.
    pub(super) fn of(nodes: &[Node], operands: &[u32], leaves: &[Leaf]) -> Option<Self> {
        let root = nodes.first()?;
        // Many half-spaces and hierarchies have faster ways of their own.
        let planes = root.half_spaces.as_ref().map_or(0, |planes| planes.len());
        if root.kind != Kind::Operation(Rule::Intersection)
            || planes > MOST_PLANES
            || root.hierarchy.is_some()
        {
            return None;
        }
        let operands = operands.get(root.first as usize..root.end as usize)?;
        if operands.len() > MOST {
            return None;
        }
        let mut numbers = ArrayVec::<u32, MOST>::new();
        for operand in operands {
            match nodes.get(*operand as usize)?.kind {
                Kind::Leaf(leaf) => numbers.push(leaf),
                Kind::Operation(_) => return None,
            }
        }
        if !numbers.iter().all(|n| leaves[*n as usize].has_stays()) {
            return None;
        }
        // The complement of everything is no solid with a first surface of its own.
        if numbers.iter().all(|n| leaves[*n as usize].negative) {
            return None;
        }
        let leaf = |n: &u32| &leaves[*n as usize];
        // Stable: quick ones stay in front.
        numbers.sort_by_key(|n| (!leaf(n).visible, leaf(n).negative));
        Some(Self {
            visible: numbers.iter().filter(|n| leaf(n).visible).count(),
            leaves: numbers,
        })
    }

    /// Searches the first visible surface with `range.min < t <= range.max`; `from` is the leaf that the ray starts on, and its
    /// surface there; `sees` says whether the ray meets the bounds of a hit's leaf.
    pub(super) fn first_visible(
        &self,
        leaves: &[Leaf],
        ray: &Ray,
        range: Interval,
        from: Option<(u32, SurfaceId)>,
        mut sees: impl FnMut(&PrimHit) -> bool,
    ) -> Answer {
        let mut first = None;
        let sure = self.walk(leaves, ray, range, from, |hit| {
            if !sees(&hit) {
                return ControlFlow::Continue(());
            }
            first = Some(hit);
            ControlFlow::Break(())
        });
        match sure {
            Ok(()) => Answer::Certain(first),
            Err(TooClose) => Answer::Unclear,
        }
    }

    /// Appends all visible surfaces; false if the general evaluation is needed, after some may have been appended.
    pub(super) fn all_visible(
        &self,
        leaves: &[Leaf],
        ray: &Ray,
        range: Interval,
        from: Option<(u32, SurfaceId)>,
        mut sees: impl FnMut(&PrimHit) -> bool,
        out: &mut Vec<PrimHit>,
    ) -> bool {
        let sure = self.walk(leaves, ray, range, from, |hit| {
            if sees(&hit) {
                out.push(hit);
            }
            ControlFlow::Continue(())
        });
        sure.is_ok()
    }

    /// Visits the visible surfaces along the ray until the visitor stops.
    #[inline(always)]
    fn walk(
        &self,
        leaves: &[Leaf],
        ray: &Ray,
        range: Interval,
        from: Option<(u32, SurfaceId)>,
        visit: impl FnMut(PrimHit) -> ControlFlow<()>,
    ) -> Result<(), TooClose> {
        let fusing = Fusing::new(ray);
        let (start, begin) = start_and_begin(range, from.is_some(), &fusing);
        if !(start < range.max) {
            return Ok(());
        }
        let range = Interval::new(start, range.max);
        // The part of the ray on which operands matter, a little wider than the operands so far.
        let mut alive = Interval::new(begin, fusing.widened(range).max);
        let far = alive.max;
        let mut events = ArrayVec::<Event, { 2 * MOST }>::new();
        let mut inside = 0;
        for (n, number) in self.leaves.iter().enumerate() {
            // The others only clip, which does not matter if the ray meets no visible surface in the range.
            if n == self.visible && !events.iter().any(|e| e.t <= far) {
                return Ok(());
            }
            let leaf = &leaves[*number as usize];
            let own = from.filter(|(other, _)| other == number);
            let own = own.map(|(_, surface)| surface);
            let Some(stay) = leaf.stay(ray, own) else {
                return Err(TooClose);
            };
            // Whether the operand is what is outside of the span.
            let outside = leaf.negative != stay.outside;
            let reaches = |s: &Span| s.exit.t >= alive.min && s.enter.t <= alive.max;
            let Some(span) = stay.span.filter(reaches) else {
                if !outside {
                    return Ok(());
                }
                inside += 1;
                continue;
            };
            for (end, enters) in [(span.enter, true), (span.exit, false)] {
                let left = own.is_some_and(|s| end.t == 0.0 && s.facet == end.facet);
                if left || end.t.is_infinite() {
                    continue;
                }
                if from.is_some() && end.t.abs() <= fusing.gap(end.t, 0.0) {
                    return Err(TooClose);
                }
                if end.t > begin {
                    let surface = SurfaceId {
                        element: leaf.first_element,
                        facet: end.facet,
                    };
                    let event = Event {
                        t: end.t,
                        surface,
                        enters: enters != outside,
                        visible: leaf.visible,
                    };
                    // There are a few: the place among them is found by going back.
                    let place = events.iter().rposition(|e| e.t <= event.t);
                    events.insert(place.map_or(0, |p| p + 1), event);
                }
            }
            let starts = span.enter.t <= begin && begin < span.exit.t;
            inside += u32::from(starts != outside);
            if !outside {
                let within = Interval::new(span.enter.t, span.exit.t);
                alive = alive.intersection(fusing.widened(within));
                if !(alive.min <= alive.max) {
                    return Ok(());
                }
            }
        }
        self.follow(&events, inside, range, &fusing, visit)
    }

    /// Visits the visible crossings in the range at which the ray enters or leaves all operands; `inside` is the number of operands
    /// that contain it at the beginning.
    #[inline(always)]
    fn follow(
        &self,
        events: &[Event],
        mut inside: u32,
        range: Interval,
        fusing: &Fusing,
        mut visit: impl FnMut(PrimHit) -> ControlFlow<()>,
    ) -> Result<(), TooClose> {
        let all = self.leaves.len() as u32;
        let followers = events.iter().skip(1).map(|next| next.t);
        for (event, next) in events.iter().zip(followers.chain([f64::INFINITY])) {
            if event.t > range.max {
                break;
            }
            if next != f64::INFINITY && !(next - event.t > fusing.gap(event.t, next)) {
                return Err(TooClose);
            }
            let before = inside == all;
            if event.enters {
                inside += 1;
            } else {
                inside = inside.saturating_sub(1);
            }
            if (inside == all) != before && event.visible && event.t > range.min {
                let hit = PrimHit {
                    surface: event.surface,
                    ..PrimHit::simple(event.t, 0)
                };
                if visit(hit).is_break() {
                    break;
                }
            }
        }
        Ok(())
    }
}
