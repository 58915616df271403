//! The operands of small trees of convex solids, in the order in which the rays of a packet meet them.

use super::leaf::Leaf;
use super::states::MOST;
use arrayvec::ArrayVec;

/// The operands of an intersection of convex solids, quadrics and complements of such, or of a union or merge of convex solids and quadrics.
#[derive(Clone, Debug)]
pub(super) struct Convex {
    /// The leaves' numbers, complements last.
    pub(super) leaves: ArrayVec<u32, MOST>,
    /// The number of those that are no complements.
    pub(super) positive: usize,
    /// Whether a point is in the tree if it is in any of them.
    pub(super) any: bool,
}

impl Convex {
    /// The operands of an intersection, among these leaves; `None` if one is neither a convex solid or a quadric nor the complement of one.
    pub(super) fn of(leaves: &[Leaf]) -> Option<Self> {
        Self::of_operands(leaves, false)
    }

    /// The operands of a tree of nothing but unions and merges; `None` if one is neither a convex solid nor a quadric.
    pub(super) fn of_union(leaves: &[Leaf]) -> Option<Self> {
        let operands = Self::of_operands(leaves, true)?;
        (operands.positive == leaves.len()).then_some(operands)
    }

    fn of_operands(leaves: &[Leaf], any: bool) -> Option<Self> {
        if !leaves.iter().all(Leaf::has_stays) {
            return None;
        }
        let mut order = ArrayVec::<u32, MOST>::new();
        for number in 0..leaves.len() {
            order.try_push(number as u32).ok()?;
        }
        order.sort_by_key(|number| leaves[*number as usize].negative);
        let positive = leaves.iter().filter(|leaf| !leaf.negative).count();
        (positive > 0).then_some(Self {
            leaves: order,
            positive,
            any,
        })
    }
}
