use super::Csg;
use super::solid::Kind;
use super::sweep::{Fusing, Rule};
use crate::PrimHit;
use strahl_math::Interval;

/// Two crossings are so close together that they could be one, or another thing that only lists can decide.
#[derive(Clone, Copy, Debug)]
pub(super) struct TooClose;

/// A crossing of an operand that is not combined of others.
#[derive(Clone, Copy, Debug)]
struct Event {
    t: f64,
    /// The operation whose operand changes its state.
    parent: u32,
    /// Among the hits.
    hit: u32,
    enters: bool,
    visible: bool,
}

/// Of how many operands the ray is inside, and of how many that may change.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct State {
    pub(super) inside: u32,
    pub(super) total: u32,
}

impl State {
    pub(super) fn holds(self, rule: Rule) -> bool {
        match rule {
            Rule::Union | Rule::Merge => self.inside > 0,
            Rule::Intersection => self.inside == self.total,
        }
    }
}

/// The crossings of all leaves of a tree with one ray, and the states of its operations: where the ray starts, then further on.
#[derive(Debug, Default)]
pub(super) struct Timeline {
    events: Vec<Event>,
    hits: Vec<PrimHit>,
    /// One for each node; those of leaves and of what has no event are not used.
    states: Vec<State>,
}

impl Timeline {
    /// Forgets all events. There is room for the states of `nodes` nodes then.
    pub(super) fn clear(&mut self, nodes: usize) {
        self.events.clear();
        self.hits.clear();
        if self.states.len() < nodes {
            self.states.resize(nodes, State::default());
        }
    }

    pub(super) fn len(&self) -> usize {
        self.events.len()
    }

    /// Forgets all but the first events.
    pub(super) fn truncate(&mut self, len: usize) {
        self.events.truncate(len);
        self.hits.truncate(len);
    }

    /// The state of an operation where the ray starts.
    pub(super) fn set_state(&mut self, node: u32, state: State) {
        if let Some(place) = self.states.get_mut(node as usize) {
            *place = state;
        }
    }

    /// Adds a crossing of an operand of `parent`.
    pub(super) fn push(&mut self, hit: PrimHit, parent: u32, enters: bool, visible: bool) {
        self.events.push(Event {
            t: hit.t,
            parent,
            hit: self.hits.len() as u32,
            enters,
            visible,
        });
        self.hits.push(hit);
    }

    /// Goes along the ray until a crossing in the range is seen from outside of the tree.
    pub(super) fn first_seen(
        &mut self,
        csg: &Csg,
        range: Interval,
        fusing: &Fusing,
    ) -> Result<Option<PrimHit>, TooClose> {
        self.events.sort_unstable_by(|a, b| a.t.total_cmp(&b.t));
        let Self {
            events,
            hits,
            states,
        } = self;
        let followers = events.iter().skip(1).map(|next| next.t);
        let followers = followers.chain([f64::INFINITY]);
        for (event, next) in events.iter().zip(followers) {
            if event.t > range.max {
                break;
            }
            if !(next - event.t > fusing.gap(event.t, next)) && next != f64::INFINITY {
                return Err(TooClose);
            }
            if event.is_seen(csg, states) && event.t > range.min {
                return Ok(hits.get(event.hit as usize).copied());
            }
        }
        Ok(None)
    }
}

impl Event {
    /// Changes the states of the operations above, and tells whether the crossing is seen from outside of the root.
    fn is_seen(&self, csg: &Csg, states: &mut [State]) -> bool {
        let (mut index, mut inner) = (self.parent, false);
        // The root's parent is no node.
        while let (Some(node), Some(state)) = (csg.node(index), states.get_mut(index as usize)) {
            let Kind::Operation(rule) = node.kind else {
                return false;
            };
            if inner {
                // The ray is inside of the operand this surface is in. It stays by the rules of `sweep`.
                let stays = match rule {
                    Rule::Union => true,
                    Rule::Merge => state.inside == 1,
                    Rule::Intersection => state.inside == state.total,
                };
                if !stays {
                    return false;
                }
            } else {
                let before = state.holds(rule);
                if self.enters {
                    state.inside += 1;
                } else {
                    state.inside = state.inside.saturating_sub(1);
                }
                if state.holds(rule) == before {
                    if rule != Rule::Union {
                        return false;
                    }
                    inner = true;
                }
            }
            index = node.parent;
        }
        self.visible
    }
}
