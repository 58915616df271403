//! Trees of a few leaves as tables: which of the leaves contain a ray is a small number, and for each leaf a set of such numbers
//! tells where its surface is visible.

use super::leaf::Leaf;
use super::node::{Kind, Node};
use super::states::MOST;
use super::sweep::Rule;
use super::table::{Operand, Table};
use arrayvec::ArrayVec;

/// More planes of one intersection are searched faster by [`HalfSpaces`](super::half_spaces).
const MOST_PLANES: usize = 3;

/// A tree of a few leaves.
#[derive(Clone, Debug)]
pub(super) struct Small {
    /// Those that are visible, then those that only clip, and of each kind first those that are not complements. If a visible one has its crossings
    /// searched for (a torus, a polynomial), quick solids that clip come before all: they narrow the search.
    pub(super) operands: ArrayVec<Operand, MOST>,
    /// How many operands there are up to the last visible one; those behind it only clip.
    pub(super) through_visible: usize,
    /// Whether it is an intersection of leaves that a line crosses at most twice, or of their complements.
    pub(super) is_intersection: bool,
    /// Whether it is a merge of such leaves, none of them a complement.
    pub(super) is_merge: bool,
}

impl Small {
    /// The tree whose root is the first node, if it is such a tree.
    pub(super) fn of(nodes: &[Node], operands: &[u32], leaves: &[Leaf]) -> Option<Self> {
        let small = leaves.len() <= MOST
            && nodes.iter().all(|node| {
                // Many half-spaces and hierarchies have faster ways of their own.
                let planes = node.half_spaces.as_ref().map_or(0, |planes| planes.len());
                planes <= MOST_PLANES && node.hierarchy.is_none()
            });
        if !small {
            return None;
        }
        // A single leaf is no operation, but the bounds of other shapes often are one, most of them balls.
        if let [leaf] = leaves
            && !leaf.is_convex()
        {
            return None;
        }
        let leaf = |n: u32| &leaves[n as usize];
        if !leaves.iter().all(|l| l.has_stays() || l.is_listed()) {
            return None;
        }
        // The complement of everything is no solid with a first surface of its own.
        if leaves.iter().all(|l| l.negative) {
            return None;
        }
        let mut order = ArrayVec::<u32, MOST>::new();
        let mut waiting = vec![0];
        while let Some(index) = waiting.pop() {
            let node: &Node = nodes.get(index as usize)?;
            match node.kind {
                Kind::Leaf(number) => order.try_push(number).ok()?,
                Kind::Operation(_) => {
                    let own = operands.get(node.first as usize..node.end as usize)?;
                    waiting.extend(own.iter().rev());
                }
            }
        }
        let narrows_first = leaves.iter().any(|l| l.visible && !l.has_stays());
        // Stable: quick ones stay in front.
        order.sort_by_key(|n| {
            let leaf = leaf(*n);
            let narrows = narrows_first && leaf.has_stays() && leaf.is_quick();
            let turn = match leaf.visible {
                false if narrows && !leaf.negative => 0,
                true => 1,
                false => 2,
            };
            (turn, leaf.negative)
        });
        let last_visible = order.iter().rposition(|n| leaf(*n).visible);
        let operands = Table::new(nodes, operands, &order)?.operands(leaves, &order);
        Some(Self {
            through_visible: last_visible.map_or(0, |last| last + 1),
            is_intersection: operands.iter().all(|o| o.required && o.simple),
            is_merge: leaves.iter().all(|l| l.has_stays() && !l.negative)
                && nodes.len() > 1
                && nodes
                    .iter()
                    .all(|node| matches!(node.kind, Kind::Leaf(_) | Kind::Operation(Rule::Merge))),
            operands,
        })
    }

    /// The leaves' numbers.
    pub(super) fn leaf_numbers(&self) -> impl Iterator<Item = u32> {
        self.operands.iter().map(|operand| operand.leaf)
    }
}
