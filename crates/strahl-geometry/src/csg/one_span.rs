//! Intersections of convex shapes: a ray is inside of all of them on one span, so their crossings need no list. Complements of
//! convex shapes, what is drilled out, cut holes into the span.

use super::fusing::TooClose;
use super::leaf::Leaf;
use super::query::Query;
use super::small::Small;
use super::states::MOST;
use crate::PrimHit;
use crate::primitives::convex::{Span, Stay};
use arrayvec::ArrayVec;
use std::ops::ControlFlow;
use strahl_math::Interval;

/// An end of the span, or of a hole.
#[derive(Clone, Copy)]
struct End {
    t: f64,
    leaf: u32,
    facet: u32,
    /// The same end of the shape that comes next: the one before where the span begins, the one behind where it ends.
    next: f64,
    /// Whether the ray enters the span or leaves a hole.
    enters: bool,
}

/// The nearest of some ends, and the next one.
#[derive(Clone, Copy)]
struct Nearest {
    t: f64,
    next: f64,
    leaf: u32,
    facet: u32,
}

impl Nearest {
    const NONE: Self = Self {
        t: f64::INFINITY,
        next: f64::INFINITY,
        leaf: 0,
        facet: 0,
    };

    #[inline(always)]
    fn add(&mut self, t: f64, leaf: u32, facet: u32) {
        if t < self.t {
            *self = Self {
                t,
                next: self.t,
                leaf,
                facet,
            };
        } else if t < self.next {
            self.next = t;
        }
    }
}

/// The holes that a ray meets.
type Holes = ArrayVec<(Span, u32), MOST>;

impl Small {
    /// Visits the visible surfaces along the ray until the visitor stops; only for intersections. `start` is the leaf that the ray starts
    /// on, and where the ray is inside of its shape; `None` if it starts elsewhere.
    #[inline(always)]
    pub(super) fn visit_one_span(
        &self,
        leaves: &[Leaf],
        query: &mut Query<'_>,
        start: Option<(u32, Option<Stay>)>,
        visit: &mut impl FnMut(PrimHit) -> ControlFlow<()>,
    ) -> Result<(), TooClose> {
        // The beginning with its sign reversed, so that both ends are the nearest ones.
        let (mut enter, mut exit) = (Nearest::NONE, Nearest::NONE);
        let mut holes = Holes::new();
        let (far, mut may_show) = (query.alive.max, false);
        for (n, number) in self.leaf_numbers().enumerate() {
            // The others only clip, which does not matter if the ray meets no visible surface in the range.
            if n == self.through_visible && !may_show {
                return Ok(());
            }
            let leaf = &leaves[number as usize];
            let own = query.own(number);
            let stay = match start {
                Some((own, stay)) if own == number => stay,
                _ => leaf.stay(query.ray, None),
            };
            let Some(stay) = stay else {
                return Err(TooClose);
            };
            let outside = leaf.negative != stay.outside;
            let alive = query.alive;
            let reaches = |s: &Span| s.exit.t >= alive.min && s.enter.t <= alive.max;
            let Some(span) = stay.span.filter(reaches) else {
                if outside {
                    continue;
                }
                return Ok(());
            };
            for end in [span.enter, span.exit] {
                let left = own.is_some_and(|s| end.t == 0.0 && s.facet == end.facet);
                if query.starts_at(end.t) && !left && end.t.is_finite() {
                    return Err(TooClose);
                }
                may_show |= query.begin < end.t && end.t <= far;
            }
            if outside {
                holes.push((span, number));
                continue;
            }
            enter.add(-span.enter.t, number, span.enter.facet);
            exit.add(span.exit.t, number, span.exit.facet);
            let within = Interval::new(span.enter.t, span.exit.t);
            query.alive = alive.intersection(query.fusing.widened(within));
            if !(query.alive.min <= query.alive.max) {
                return Ok(());
            }
        }
        visit_ends(leaves, query, [enter, exit], &mut holes, visit)
    }
}

/// Visits the ends of a span, the first of which has its sign reversed, as far as the ray meets them, or what holes make of it.
#[inline(always)]
fn visit_ends(
    leaves: &[Leaf],
    query: &mut Query<'_>,
    [enter, exit]: [Nearest; 2],
    holes: &mut Holes,
    visit: &mut impl FnMut(PrimHit) -> ControlFlow<()>,
) -> Result<(), TooClose> {
    let first = End {
        t: -enter.t,
        leaf: enter.leaf,
        facet: enter.facet,
        next: -enter.next,
        enters: true,
    };
    let last = End {
        t: exit.t,
        leaf: exit.leaf,
        facet: exit.facet,
        next: exit.next,
        enters: false,
    };
    let alive = query.alive;
    holes.retain(|(hole, _)| hole.exit.t >= alive.min && hole.enter.t <= alive.max);
    if !holes.is_empty() {
        return visit_around(leaves, query, [first, last], holes, visit);
    }
    if query.close(first.t, last.t) {
        return Err(TooClose);
    }
    for end in [first, last] {
        if query.reaches(end.t) {
            if query.is_double(&end) {
                return Err(TooClose);
            }
            if query
                .shows(&leaves[end.leaf as usize], end.t, end.facet, visit)
                .is_break()
            {
                break;
            }
        }
    }
    Ok(())
}

/// Visits the visible surfaces of the span between two ends that has holes.
#[inline(never)]
fn visit_around(
    leaves: &[Leaf],
    query: &Query<'_>,
    ends: [End; 2],
    holes: &Holes,
    visit: &mut impl FnMut(PrimHit) -> ControlFlow<()>,
) -> Result<(), TooClose> {
    let mut events = ArrayVec::<End, { 2 * MOST + 2 }>::new();
    let mut add = |end: End| {
        // There are a few: the place among them is found by going back.
        if end.t > query.begin && end.t.is_finite() {
            let place = events.iter().rposition(|e| e.t <= end.t);
            events.insert(place.map_or(0, |p| p + 1), end);
        }
    };
    let [first, last] = ends;
    // What the ray is inside of at its beginning: the span, and each of the holes' outsides.
    let starts_in = |from: f64, to: f64| from <= query.begin && query.begin < to;
    let mut inside = usize::from(starts_in(first.t, last.t));
    add(first);
    add(last);
    for (hole, leaf) in holes {
        inside += usize::from(!starts_in(hole.enter.t, hole.exit.t));
        for (end, enters) in [(hole.enter, false), (hole.exit, true)] {
            add(End {
                t: end.t,
                leaf: *leaf,
                facet: end.facet,
                next: if enters {
                    f64::NEG_INFINITY
                } else {
                    f64::INFINITY
                },
                enters,
            });
        }
    }
    let all = 1 + holes.len();
    let followers = events.iter().skip(1).map(|next| next.t);
    for (event, next) in events.iter().zip(followers.chain([f64::INFINITY])) {
        if event.t > query.range.max {
            break;
        }
        if query.is_double(event) || query.close(event.t, next) {
            return Err(TooClose);
        }
        let before = inside == all;
        if event.enters {
            inside += 1;
        } else {
            inside = inside.saturating_sub(1);
        }
        if (inside == all) != before
            && query
                .shows(&leaves[event.leaf as usize], event.t, event.facet, visit)
                .is_break()
        {
            break;
        }
    }
    Ok(())
}

impl Query<'_> {
    /// Whether two parameters, the first one not above the second, are so close that crossings there could coincide; there are none at
    /// infinity.
    #[inline(always)]
    fn close(&self, a: f64, b: f64) -> bool {
        !(b - a > self.fusing.gap(a, b)) && a != f64::NEG_INFINITY && b != f64::INFINITY
    }

    /// Whether an end could coincide with the same end of another shape.
    #[inline(always)]
    fn is_double(&self, end: &End) -> bool {
        match end.enters {
            true => self.close(end.next, end.t),
            false => self.close(end.t, end.next),
        }
    }

    /// Whether a crossing counts.
    #[inline(always)]
    fn reaches(&self, t: f64) -> bool {
        t > self.begin && t <= self.range.max && t.is_finite()
    }
}
