use crate::{Crossing, Crossings, Side};
use strahl_math::{Interval, Ray};

/// How a node combines its operands. There is no difference and no inverse: those have been pushed down to the leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// Inside of any; inner surfaces stay.
    Union,
    /// Inside of any.
    Merge,
    /// Inside of all.
    Intersection,
}

impl Rule {
    /// The neutral operand: true (everything) for intersections, false (nothing) for unions.
    pub(super) fn neutral(self) -> bool {
        self == Self::Intersection
    }
}

/// Decides which crossings coincide: coincident surfaces are hit at parameters that differ by rounding.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fusing {
    /// The parameter at which the ray is as far from its origin as its origin is from that of space.
    scale: f64,
}

impl Fusing {
    /// The largest gap that is ever closed, relative to the magnitudes involved. Error bounds are far below (some 1e-15),
    /// except where a ray grazes a surface; the limit makes lists independent of the range asked for, see [`Fusing::margin`].
    const LIMIT: f64 = 1.0 / (1u64 << 20) as f64;

    pub(super) fn new(ray: &Ray) -> Self {
        let scale = ray.origin.abs().max_element() / ray.direction.abs().max_element();
        Self {
            scale: if scale.is_finite() { scale } else { 0.0 },
        }
    }

    /// A bound of the distance between crossings that may be fused with one at `t`. Lists made for a range that is wider by a
    /// few margins equal those of the whole line, clipped.
    pub(super) fn margin(&self, t: f64) -> f64 {
        Self::LIMIT * (t.abs() + self.scale)
    }

    /// Crossings further apart than this certainly don't coincide.
    pub(super) fn gap(&self, a: f64, b: f64) -> f64 {
        2.0 * (self.margin(a) + self.margin(b))
    }

    /// The range, wider by a few margins at both ends.
    pub(super) fn widened(&self, range: Interval) -> Interval {
        Interval::new(
            range.min - 4.0 * self.margin(range.min),
            range.max + 4.0 * self.margin(range.max),
        )
    }

    /// The crossing's error, up to the limit.
    pub(super) fn reach(&self, crossing: &Crossing) -> f64 {
        let margin = self.margin(crossing.hit.t);
        if crossing.t_error < margin {
            crossing.t_error
        } else {
            margin
        }
    }

    fn coincide(&self, a: &Crossing, b: &Crossing) -> bool {
        (b.hit.t - a.hit.t).abs() <= self.reach(a) + self.reach(b)
    }
}

/// A crossing of one operand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Event {
    pub(super) crossing: Crossing,
    /// The number of the operand.
    pub(super) slot: u32,
}

/// An operand during a sweep.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slot {
    /// Whether the ray is inside of it.
    pub(super) inside: bool,
    /// The group of coincident crossings it took part in last; 0 for none.
    group: u32,
}

impl Slot {
    pub(super) fn new(inside: bool) -> Self {
        Self { inside, group: 0 }
    }
}

/// Sorts the crossings of all operands along the ray.
pub(super) fn sort(events: &mut [Event]) {
    events.sort_unstable_by(|a, b| {
        let (s, t) = (&a.crossing.hit, &b.crossing.hit);
        s.t.total_cmp(&t.t)
            .then_with(|| a.slot.cmp(&b.slot))
            .then_with(|| s.surface.element.cmp(&t.surface.element))
            .then_with(|| s.surface.facet.cmp(&t.surface.facet))
    });
}

/// Combines the operands' sorted crossings into those of the node. `always_inside` says that there is one more operand, which
/// the ray never leaves.
///
/// Coincident crossings of different operands are one event: all operands change their states, then the result is computed. So
/// spans without thickness vanish, and of coincident faces the one with the smallest element number counts.
pub(super) fn sweep(
    rule: Rule,
    events: &[Event],
    slots: &mut [Slot],
    always_inside: bool,
    fusing: &Fusing,
    out: &mut Crossings,
) {
    let total = slots.len() + usize::from(always_inside);
    let holds = |count: usize| match rule {
        Rule::Union | Rule::Merge => count > 0,
        Rule::Intersection => count == total,
    };
    let mut count = usize::from(always_inside) + slots.iter().filter(|slot| slot.inside).count();
    out.inside_at_start = holds(count);

    let (mut rest, mut group) = (events, 0);
    while let Some(first) = rest.first() {
        // The group: the crossings that coincide with its first one, one per operand (an operand's own list is already in
        // order, however close its crossings are).
        group += 1;
        let before = count;
        let mut length = 0;
        for event in rest {
            let Some(slot) = slots.get_mut(event.slot as usize) else {
                break;
            };
            if slot.group == group || !fusing.coincide(&first.crossing, &event.crossing) {
                break;
            }
            slot.group = group;
            length += 1;
            match event.crossing.side {
                Side::Enter if !slot.inside => {
                    slot.inside = true;
                    count += 1;
                }
                Side::Exit if slot.inside => {
                    slot.inside = false;
                    count -= 1;
                }
                _ => {}
            }
        }
        // A group is never empty; the bound only guards against an event of an unknown operand.
        let (members, later) = rest.split_at(if length > 0 { length } else { 1 });
        rest = later;

        let chosen = match (holds(before), holds(count)) {
            (false, true) => choose(members, Side::Enter),
            (true, false) => choose(members, Side::Exit),
            (_, _) => choose_inner(rule, members, slots, before, count, total),
        };
        out.list.extend(chosen);
    }
}

/// The crossing that represents a change of the result: one that changes in the same direction, visible if there is one, of the
/// smallest element.
fn choose(members: &[Event], side: Side) -> Option<Crossing> {
    members
        .iter()
        .map(|event| &event.crossing)
        .min_by_key(|c| {
            (
                c.side != side,
                !c.visible,
                c.surface().element,
                c.surface().facet,
            )
        })
        .map(|c| Crossing { side, ..*c })
}

/// The inner surface that is kept where the result does not change, if there is one.
fn choose_inner(
    rule: Rule,
    members: &[Event],
    slots: &[Slot],
    before: usize,
    after: usize,
    total: usize,
) -> Option<Crossing> {
    let stays = |event: &&Event| {
        let inner = event.crossing.side == Side::Inner;
        let own = slots
            .get(event.slot as usize)
            .is_some_and(|slot| slot.inside);
        // The number of *other* operands that contain the ray, on either side.
        let others_before = before.saturating_sub(usize::from(inner && own));
        let others_after = after.saturating_sub(usize::from(inner && own));
        event.crossing.visible
            && match rule {
                Rule::Union => true,
                Rule::Merge => inner && others_before == 0 && others_after == 0,
                // Inside or on the boundary of all others.
                Rule::Intersection => {
                    inner && (others_before + 1 == total || others_after + 1 == total)
                }
            }
    };
    members
        .iter()
        .filter(stays)
        .map(|event| &event.crossing)
        .min_by_key(|c| (c.surface().element, c.surface().facet))
        .map(|c| Crossing {
            side: Side::Inner,
            ..*c
        })
}
