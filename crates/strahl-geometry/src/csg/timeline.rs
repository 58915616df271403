use super::compiled::Csg;
use super::fusing::{Fusing, TooClose};
use super::node::Kind;
use super::sweep::Rule;
use crate::{Crossing, PrimHit, Side, SurfaceId};
use strahl_math::Interval;

/// A crossing of an operand that is a leaf.
#[derive(Clone, Copy, Debug)]
struct Event {
    t: f64,
    surface: SurfaceId,
    /// The operation whose operand changes its state.
    parent: u32,
    /// One plus the index of the hit's coordinates; 0 if they are zero.
    uv: u32,
    enters: bool,
    visible: bool,
}

/// The number of operands that contain the ray, and the number that would change the result.
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

/// The crossings of all leaves of a tree with one ray, and the states of its operations: at the start of the ray, then further
/// on.
#[derive(Debug, Default)]
pub(super) struct Timeline {
    events: Vec<Event>,
    uvs: Vec<[f64; 2]>,
    /// The states of operations with crossings at the start of the ray.
    starts: Vec<(u32, State)>,
    /// One for each node.
    states: Vec<State>,
}

impl Timeline {
    /// Clears everything, and makes room for the states of `nodes` nodes.
    pub(super) fn clear(&mut self, nodes: usize) {
        self.events.clear();
        self.uvs.clear();
        self.starts.clear();
        if self.states.len() < nodes {
            self.states.resize(nodes, State::default());
        }
    }

    /// The number of crossings.
    pub(super) fn len(&self) -> usize {
        self.events.len()
    }

    /// Keeps the first crossings only.
    pub(super) fn truncate(&mut self, len: usize) {
        self.events.truncate(len);
    }

    /// Sets the state of an operation at the start of the ray; the last call counts.
    pub(super) fn set_state(&mut self, node: u32, state: State) {
        self.starts.push((node, state));
    }

    /// Adds a crossing of an operand of `parent`.
    #[inline]
    pub(super) fn push(
        &mut self,
        t: f64,
        surface: SurfaceId,
        parent: u32,
        enters: bool,
        visible: bool,
    ) {
        self.events.push(Event {
            t,
            surface,
            parent,
            uv: 0,
            enters,
            visible,
        });
    }

    /// Adds a crossing from a list, which enters or leaves.
    pub(super) fn push_hit(&mut self, crossing: &Crossing, parent: u32) {
        let PrimHit { t, surface, uv } = crossing.hit;
        self.push(
            t,
            surface,
            parent,
            crossing.side == Side::Enter,
            crossing.visible,
        );
        if uv != [0.0; 2] {
            self.uvs.push(uv);
            if let Some(event) = self.events.last_mut() {
                event.uv = self.uvs.len() as u32;
            }
        }
    }

    /// Goes along the ray to the crossings in the range that are visible from outside of the tree, until `take` returns false. `sees` says
    /// whether the ray meets the bounds of the leaf that an element belongs to.
    pub(super) fn visit_seen(
        &mut self,
        csg: &Csg,
        range: Interval,
        fusing: &Fusing,
        mut sees: impl FnMut(u32) -> bool,
        mut take: impl FnMut(PrimHit) -> bool,
    ) -> Result<(), TooClose> {
        self.events.sort_unstable_by(|a, b| a.t.total_cmp(&b.t));
        let Self {
            events,
            uvs,
            starts,
            states,
        } = self;
        for (node, state) in starts {
            if let Some(place) = states.get_mut(*node as usize) {
                *place = *state;
            }
        }
        let followers = events.iter().skip(1).map(|next| next.t);
        let followers = followers.chain([f64::INFINITY]);
        for (event, next) in events.iter().zip(followers) {
            if event.t > range.max {
                break;
            }
            if !(next - event.t > fusing.gap(event.t, next)) && next != f64::INFINITY {
                return Err(TooClose);
            }
            let seen = event.is_seen(csg, states) && event.t > range.min;
            if seen && sees(event.surface.element) {
                let uv = uvs.get((event.uv as usize).wrapping_sub(1));
                let goes_on = take(PrimHit {
                    t: event.t,
                    surface: event.surface,
                    uv: uv.copied().unwrap_or_default(),
                });
                if !goes_on {
                    break;
                }
            }
        }
        Ok(())
    }
}

impl Event {
    /// Updates the states of the operations above, and returns whether the crossing is visible from outside of the root.
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
