use super::fusing::Fusing;
use crate::{Crossing, Crossings, Side};

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
/// Crossings of different operands that coincide are one event: all operands change their states, then the result is determined.
/// [`Group`] decides which of the faces is visible.
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

    let (mut rest, mut number) = (events, 0);
    while let Some(first) = rest.first() {
        // A group: the crossings that coincide with its first one, one per operand (an operand's own list is already in order,
        // however close its crossings are).
        number += 1;
        let before = count;
        let mut length = 0;
        for event in rest {
            let Some(slot) = slots.get_mut(event.slot as usize) else {
                break;
            };
            if slot.group == number || !fusing.coincide(&first.crossing, &event.crossing) {
                break;
            }
            slot.group = number;
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

        let group = Group {
            rule,
            members,
            before,
            after: count,
            total,
            inside_elsewhere: count - members.iter().filter(|e| is_inside(slots, e)).count(),
        };
        out.list.extend(match (holds(before), holds(count)) {
            (false, true) => group.change(Side::Enter),
            (true, false) => group.change(Side::Exit),
            (_, _) => group.inner(slots),
        });
    }
}

/// Whether the ray is inside of an event's operand.
fn is_inside(slots: &[Slot], event: &Event) -> bool {
    slots.get(event.slot as usize).is_some_and(|s| s.inside)
}

/// Crossings of different operands that coincide, one per operand; most groups have a single member.
struct Group<'a> {
    rule: Rule,
    members: &'a [Event],
    /// The number of operands that the ray is inside of before the group and after it ...
    before: usize,
    after: usize,
    /// ... and the number of all operands.
    total: usize,
    /// The number of operands without a member in the group that the ray is inside of.
    inside_elsewhere: usize,
}

impl Group<'_> {
    /// The number of members whose surface counts as inside of its own operand.
    fn closed(&self) -> usize {
        self.members.iter().filter(|e| e.crossing.closed).count()
    }

    /// Whether the operands without a member in the group keep its surfaces.
    fn is_kept_elsewhere(&self) -> bool {
        match self.rule {
            Rule::Union => true,
            Rule::Merge => self.inside_elsewhere == 0,
            Rule::Intersection => self.inside_elsewhere + self.members.len() == self.total,
        }
    }

    /// Whether the other members keep the surface of one member.
    fn stays(&self, crossing: &Crossing, closed: usize) -> bool {
        let others = closed - usize::from(crossing.closed);
        match self.rule {
            Rule::Union => true,
            Rule::Merge => others == 0,
            Rule::Intersection => others + 1 == self.members.len(),
        }
    }

    /// The visible surface that is kept: the last one, in a union the first one.
    fn shown(&self) -> Option<&Crossing> {
        if !self.is_kept_elsewhere() {
            return None;
        }
        let closed = self.closed();
        let crossings = self.members.iter().map(|event| &event.crossing);
        let kept = crossings.filter(|c| c.visible && self.stays(c, closed));
        let number = |c: &&Crossing| (c.surface().element, c.surface().facet);
        match self.rule {
            Rule::Union => kept.min_by_key(number),
            Rule::Merge | Rule::Intersection => kept.max_by_key(number),
        }
    }

    /// A crossing of this group as a crossing of the result.
    fn result(&self, crossing: &Crossing, side: Side) -> Crossing {
        let closed = self.closed();
        Crossing {
            side,
            closed: match self.rule {
                Rule::Union | Rule::Merge => closed + self.inside_elsewhere > 0,
                Rule::Intersection => closed == self.members.len() && self.is_kept_elsewhere(),
            },
            ..*crossing
        }
    }

    /// The crossing at which the result changes. There always is one, even if all surfaces are inside of others that coincide.
    fn change(&self, side: Side) -> Option<Crossing> {
        let chosen = match self.members {
            [alone] => Some(&alone.crossing),
            _ => self.shown().or_else(|| first_of(self.members, side)),
        };
        chosen.map(|crossing| self.result(crossing, side))
    }

    /// The inner surface that is kept where the result does not change, if there is one.
    fn inner(&self, slots: &[Slot]) -> Option<Crossing> {
        let chosen = match self.members {
            [Event { crossing, slot }] => {
                let inside = slots.get(*slot as usize).is_some_and(|s| s.inside);
                self.stays_alone(crossing, inside).then_some(crossing)
            }
            _ => self.shown(),
        };
        chosen.map(|crossing| self.result(crossing, Side::Inner))
    }

    /// Whether the surface of a single member is kept although the result does not change.
    fn stays_alone(&self, crossing: &Crossing, inside: bool) -> bool {
        let inner = crossing.side == Side::Inner;
        // The number of *other* operands that the ray is inside of, on either side.
        let own = usize::from(inner && inside);
        let (before, after) = (
            self.before.saturating_sub(own),
            self.after.saturating_sub(own),
        );
        crossing.visible
            && match self.rule {
                Rule::Union => true,
                Rule::Merge => inner && before == 0 && after == 0,
                Rule::Intersection => {
                    inner && (before + 1 == self.total || after + 1 == self.total)
                }
            }
    }
}

/// The crossing of the smallest element that changes the same way, visible if there is one.
fn first_of(members: &[Event], side: Side) -> Option<&Crossing> {
    let crossings = members.iter().map(|event| &event.crossing);
    crossings.min_by_key(|c| {
        let surface = c.surface();
        (c.side != side, !c.visible, surface.element, surface.facet)
    })
}
