//! The visible surfaces of trees of a few leaves: lenses, glasses, drilled blocks, capped pieces.
//!
//! These trees are frequent and their rays cheap, so that the general search spends most of its time on its lists and on going
//! through the tree. Here the tree is a table: which of its leaves contain the ray is a small number, and for each leaf a set of
//! such numbers tells where its surface is visible. The crossings of all leaves are sorted in place. As in
//! [`first`](super::first), crossings that could coincide are left to the general evaluation, so all three give the same bits.

use super::boxes::Slabs;
use super::first::Answer;
use super::fusing::TooClose;
use super::leaf::Leaf;
use super::query::Query;
use super::small::Small;
use super::states::States;
use crate::primitives::convex::Span;
use crate::{PrimHit, Scratch, Side, SurfaceId};
use arrayvec::ArrayVec;
use std::ops::ControlFlow;
use strahl_math::{Interval, Ray};

/// The most crossings of a ray; with more the general search decides.
const CROSSINGS: usize = 24;

/// A crossing of a leaf's surface.
#[derive(Clone, Copy)]
struct Event {
    t: f64,
    surface: SurfaceId,
    operand: u8,
    /// One plus the index of the hit's coordinates; 0 if they are zero.
    uv: u8,
    visible: bool,
}

/// The crossings along the ray, and the state where the ray begins.
#[derive(Default)]
struct Events {
    list: ArrayVec<Event, CROSSINGS>,
    uvs: ArrayVec<[f64; 2], CROSSINGS>,
    /// The bits of the leaves that contain the ray at its beginning.
    state: u8,
}

impl Small {
    /// Searches the first visible surface with `range.min < t <= range.max`; `from` is the leaf that the ray starts on, and its
    /// surface there; `sees` says whether the ray meets the bounds of a hit's leaf.
    pub(super) fn first_visible(
        &self,
        leaves: &[Leaf],
        ray: &Ray,
        range: Interval,
        from: Option<(u32, SurfaceId)>,
        scratch: &mut Scratch,
        sees: impl Fn(&PrimHit, &mut Scratch) -> bool,
    ) -> Answer {
        let mut first = None;
        let sure = self.walk(leaves, ray, range, from, scratch, |hit, scratch| {
            if !sees(&hit, scratch) {
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

    /// Appends all visible surfaces; fails if the general evaluation is needed, after some may have been appended.
    #[expect(
        clippy::too_many_arguments,
        reason = "a query and where its results go"
    )]
    pub(super) fn all_visible(
        &self,
        leaves: &[Leaf],
        ray: &Ray,
        range: Interval,
        from: Option<(u32, SurfaceId)>,
        scratch: &mut Scratch,
        sees: impl Fn(&PrimHit, &mut Scratch) -> bool,
        out: &mut Vec<PrimHit>,
    ) -> Result<(), TooClose> {
        self.walk(leaves, ray, range, from, scratch, |hit, scratch| {
            if sees(&hit, scratch) {
                out.push(hit);
            }
            ControlFlow::Continue(())
        })
    }

    /// Visits the visible surfaces along the ray until the visitor stops.
    #[inline(always)]
    fn walk(
        &self,
        leaves: &[Leaf],
        ray: &Ray,
        range: Interval,
        from: Option<(u32, SurfaceId)>,
        scratch: &mut Scratch,
        mut visit: impl FnMut(PrimHit, &mut Scratch) -> ControlFlow<()>,
    ) -> Result<(), TooClose> {
        let mut start = None;
        if self.is_intersection
            && let Some((number, surface)) = from
        {
            let leaf = &leaves[number as usize];
            let stay = leaf.stay(ray, Some(surface));
            let alone = self.through_visible == 1 && leaf.visible;
            // Most rays from surfaces: nothing else is worked out for them.
            if stay.is_some_and(|stay| {
                leaf.is_left_for_good(&stay, surface) || alone && stay.is_crossed_once(surface)
            }) {
                return Ok(());
            }
            start = Some((number, stay));
        }
        let Some(mut query) = Query::new(ray, range, from) else {
            return Ok(());
        };
        if self.is_intersection {
            let mut visit = |hit| visit(hit, scratch);
            return self.visit_one_span(leaves, &mut query, start, &mut visit);
        }
        if self.is_merge {
            return self.visit_merged(leaves, &query, None, &mut |hit| visit(hit, scratch));
        }
        let far = query.alive.max;
        let mut slabs = None;
        let mut events = Events::default();
        let mut possible = States::ALL;
        for (bit, operand) in self.operands.iter().enumerate() {
            // The others only clip, which does not matter if the ray meets no visible surface in the range.
            if bit == self.through_visible && !events.may_show(far) {
                return Ok(());
            }
            if !operand.matters.meets(possible) {
                continue;
            }
            let (leaf, own) = (&leaves[operand.leaf as usize], query.own(operand.leaf));
            let misses = |slabs: &Slabs| slabs.clip(&leaf.bounds, query.alive).is_none();
            let course = if !operand.quick && misses(slabs.get_or_insert_with(|| Slabs::new(ray))) {
                Course::Constant(leaf.negative)
            } else if operand.simple {
                query.cross(leaf, own, bit, &mut events)?
            } else {
                query.cross_listed(leaf, own, bit, scratch, &mut events)?
            };
            match course {
                Course::Constant(false) if operand.required => return Ok(()),
                Course::Constant(inside) => {
                    possible = possible & States::with(bit, inside);
                    events.state |= u8::from(inside) << bit;
                }
                Course::Varies { inside, within } => {
                    events.state |= u8::from(inside) << bit;
                    if operand.required {
                        query.alive = query.alive.intersection(query.fusing.widened(within));
                        if !(query.alive.min <= query.alive.max) {
                            return Ok(());
                        }
                    }
                }
            }
        }
        self.follow(&events, &query, scratch, visit)
    }

    /// Visits the visible crossings in the range.
    #[inline(always)]
    fn follow(
        &self,
        events: &Events,
        query: &Query<'_>,
        scratch: &mut Scratch,
        mut visit: impl FnMut(PrimHit, &mut Scratch) -> ControlFlow<()>,
    ) -> Result<(), TooClose> {
        let Query { range, fusing, .. } = query;
        let mut state = events.state;
        let followers = events.list.iter().skip(1).map(|next| next.t);
        for (event, next) in events.list.iter().zip(followers.chain([f64::INFINITY])) {
            if event.t > range.max {
                break;
            }
            if next != f64::INFINITY && !(next - event.t > fusing.gap(event.t, next)) {
                return Err(TooClose);
            }
            let operand = &self.operands[usize::from(event.operand)];
            let seen = operand.seen.contains(state) && event.visible && event.t > range.min;
            state ^= 1 << event.operand;
            if seen {
                let uv = events.uvs.get(usize::from(event.uv).wrapping_sub(1));
                let hit = PrimHit {
                    t: event.t,
                    surface: event.surface,
                    uv: uv.copied().unwrap_or_default(),
                };
                if visit(hit, scratch).is_break() {
                    break;
                }
            }
        }
        Ok(())
    }
}

/// The states of a leaf along the relevant part of the ray.
enum Course {
    /// The same everywhere.
    Constant(bool),
    /// The state where the ray begins, and the interval in which it may be inside.
    Varies { inside: bool, within: Interval },
}

impl Query<'_> {
    /// Adds the crossings of a leaf that a line crosses at most twice.
    #[inline(always)]
    fn cross(
        &self,
        leaf: &Leaf,
        own: Option<SurfaceId>,
        bit: usize,
        events: &mut Events,
    ) -> Result<Course, TooClose> {
        let Some(stay) = leaf.stay(self.ray, own) else {
            return Err(TooClose);
        };
        // Whether the operand is what is outside of the span.
        let outside = leaf.negative != stay.outside;
        let reaches = |s: &Span| s.exit.t >= self.alive.min && s.enter.t <= self.alive.max;
        let Some(span) = stay.span.filter(reaches) else {
            return Ok(Course::Constant(outside));
        };
        for end in [span.enter, span.exit] {
            let left = own.is_some_and(|s| end.t == 0.0 && s.facet == end.facet);
            if left || end.t.is_infinite() {
                continue;
            }
            self.check_start(end.t)?;
            if end.t > self.begin {
                let surface = SurfaceId {
                    element: leaf.first_element,
                    facet: end.facet,
                };
                events.insert(end.t, surface, bit, 0, leaf.visible)?;
            }
        }
        let starts = span.enter.t <= self.begin && self.begin < span.exit.t;
        Ok(Course::Varies {
            inside: starts != outside,
            within: match outside {
                true => Interval::LINE,
                false => Interval::new(span.enter.t, span.exit.t),
            },
        })
    }

    /// The same for a shape that is crossed more often.
    #[inline(never)]
    fn cross_listed(
        &self,
        leaf: &Leaf,
        own: Option<SurfaceId>,
        bit: usize,
        scratch: &mut Scratch,
        events: &mut Events,
    ) -> Result<Course, TooClose> {
        let mut list = scratch.take();
        leaf.bare_crossings(self.ray, self.alive, own, scratch, &mut list);
        let mut inside = list.inside_at_start;
        let mut varies = false;
        let mut result = Ok(());
        for crossing in &list.list {
            let t = crossing.hit.t;
            result = result.and_then(|()| self.check_start(t));
            if crossing.side == Side::Inner {
                result = Err(TooClose);
            } else if t > self.begin {
                varies = true;
                let uv = events.uv_index(crossing.hit.uv);
                let added = uv.and_then(|uv| {
                    events.insert(t, crossing.hit.surface, bit, uv, crossing.visible)
                });
                result = result.and(added);
            } else {
                inside = crossing.side == Side::Enter;
            }
        }
        scratch.give(list);
        result?;
        Ok(match varies {
            false => Course::Constant(inside),
            true => Course::Varies {
                inside,
                within: Interval::LINE,
            },
        })
    }

    /// Fails for crossings that could coincide with the surface that the ray leaves.
    #[inline]
    fn check_start(&self, t: f64) -> Result<(), TooClose> {
        match self.starts_at(t) {
            true => Err(TooClose),
            false => Ok(()),
        }
    }
}

impl Events {
    /// Whether a crossing of a visible surface lies in front of `far`.
    #[inline]
    fn may_show(&self, far: f64) -> bool {
        self.list.iter().any(|e| e.visible && e.t <= far)
    }

    /// Adds a crossing behind those that are not further away.
    #[inline]
    fn insert(
        &mut self,
        t: f64,
        surface: SurfaceId,
        operand: usize,
        uv: u8,
        visible: bool,
    ) -> Result<(), TooClose> {
        let event = Event {
            t,
            surface,
            operand: operand as u8,
            uv,
            visible,
        };
        if self.list.is_full() {
            return Err(TooClose);
        }
        // There are a few: the place among them is found by going back.
        let place = self.list.iter().rposition(|e| e.t <= t);
        self.list.insert(place.map_or(0, |p| p + 1), event);
        Ok(())
    }

    /// Keeps the coordinates of a hit; one plus their index, or 0 for zeros.
    fn uv_index(&mut self, uv: [f64; 2]) -> Result<u8, TooClose> {
        if uv == [0.0; 2] {
            return Ok(0);
        }
        self.uvs.try_push(uv).map_err(|_| TooClose)?;
        Ok(self.uvs.len() as u8)
    }
}
