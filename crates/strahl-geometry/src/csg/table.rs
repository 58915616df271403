//! The logic of a small tree as sets of states, computed for all states at once.

use super::leaf::Leaf;
use super::node::{Kind, NO_PARENT, Node};
use super::states::{MOST, States};
use super::sweep::Rule;
use arrayvec::ArrayVec;
use std::ops::{BitAnd, BitOr};

/// A leaf of the tree. Its place in the list is its bit in the states.
#[derive(Clone, Debug)]
pub(super) struct Operand {
    pub(super) leaf: u32,
    /// Whether a line crosses it at most twice ([`Leaf::stay`]).
    pub(super) simple: bool,
    /// Whether it is intersected as fast as its box; otherwise its box is tested first.
    pub(super) quick: bool,
    /// Whether nothing is visible where the ray is outside of what it contributes.
    pub(super) required: bool,
    /// The states in which its surface is visible, whether the ray is in front of it or behind it.
    pub(super) seen: States,
    /// The states in which it matters whether the ray is inside of it.
    pub(super) matters: States,
}

/// The tree as sets of states: bit `i` of a state says whether the ray is inside of leaf `order[i]`.
pub(super) struct Table<'a> {
    nodes: &'a [Node],
    operands: &'a [u32],
    /// The node of each leaf.
    places: ArrayVec<u32, MOST>,
    /// For each node the states in which the ray is inside of it.
    holds: Vec<States>,
}

impl<'a> Table<'a> {
    pub(super) fn new(nodes: &'a [Node], operands: &'a [u32], order: &[u32]) -> Option<Self> {
        let mut places = ArrayVec::new();
        for leaf in order {
            let place = nodes
                .iter()
                .position(|node| node.kind == Kind::Leaf(*leaf))?;
            places.try_push(place as u32).ok()?;
        }
        let mut table = Self {
            nodes,
            operands,
            places,
            holds: vec![States::NONE; nodes.len()],
        };
        // Parents come before their operands.
        for (index, node) in nodes.iter().enumerate().rev() {
            table.holds[index] = match node.kind {
                Kind::Leaf(leaf) => {
                    let bit = order.iter().position(|other| *other == leaf)?;
                    States::with(bit, true)
                }
                Kind::Operation(rule) => {
                    let held = table.operands_of(node).map(|operand| table.holds[operand]);
                    match rule {
                        Rule::Intersection => held.fold(States::ALL, BitAnd::bitand),
                        Rule::Union | Rule::Merge => held.fold(States::NONE, BitOr::bitor),
                    }
                }
            };
        }
        Some(table)
    }

    fn operands_of(&self, node: &Node) -> impl Iterator<Item = usize> {
        let own = &self.operands[node.first as usize..node.end as usize];
        own.iter().map(|operand| *operand as usize)
    }

    /// The states in which a crossing of leaf `bit` is visible from outside of the tree; the rules are those of
    /// [`timeline`](super::timeline), for all states at once.
    fn seen(&self, bit: usize) -> States {
        let mut child = self.places[bit];
        // The states in which the crossing changes all nodes so far, and those in which it is an inner surface of a union.
        let (mut changes, mut inner) = (States::ALL, States::NONE);
        loop {
            let parent = self.nodes[child as usize].parent;
            if parent == NO_PARENT {
                return changes | inner;
            }
            let node = &self.nodes[parent as usize];
            let Kind::Operation(rule) = node.kind else {
                return States::NONE;
            };
            let holds = self.holds[parent as usize];
            let changed = holds ^ holds.flipped(bit);
            match rule {
                Rule::Union => inner = inner | changes & !changed,
                Rule::Merge => {
                    let others = self
                        .operands_of(node)
                        .filter(|other| *other != child as usize);
                    let covered = others.fold(States::NONE, |a, b| a | self.holds[b]);
                    inner = inner & !covered;
                }
                Rule::Intersection => inner = inner & holds,
            }
            changes = changes & changed;
            child = parent;
        }
    }

    /// The leaves with their sets, in order.
    pub(super) fn operands(&self, leaves: &[Leaf], order: &[u32]) -> ArrayVec<Operand, MOST> {
        let leaf = |number: u32| &leaves[number as usize];
        let seen: ArrayVec<States, MOST> = (0..order.len())
            .map(|bit| match leaf(order[bit]).visible {
                true => self.seen(bit),
                false => States::NONE,
            })
            .collect();
        let operand = |(bit, number): (usize, &u32)| {
            let outside = States::with(bit, false);
            let changed = seen.iter().map(|s| *s ^ s.flipped(bit));
            let others = seen.iter().enumerate().filter(|(other, _)| *other != bit);
            Operand {
                leaf: *number,
                simple: leaf(*number).has_stays(),
                quick: leaf(*number).is_quick(),
                required: others.clone().all(|(_, seen)| !seen.meets(outside)),
                seen: seen[bit],
                matters: changed.fold(seen[bit], BitOr::bitor),
            }
        };
        order.iter().enumerate().map(operand).collect()
    }
}
