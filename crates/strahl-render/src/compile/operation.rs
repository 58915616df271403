//! The operations of constructive solid geometry.

use strahl_geometry::CsgNode;
use strahl_scene::CsgOp;

/// What is wrong with the number of operands of an operation.
pub(super) fn wrong_count(op: CsgOp, count: usize) -> Option<String> {
    let (right, expected) = match op {
        CsgOp::Inverse => (count == 1, "exactly one object"),
        CsgOp::Clip => (count >= 2, "an object and at least one to clip it by"),
        CsgOp::Bound => (count >= 2, "an object and at least one to bound it by"),
        CsgOp::Union
        | CsgOp::Merge
        | CsgOp::Intersection
        | CsgOp::Difference
        | CsgOp::LightGroup { .. } => (count >= 1, "at least one object"),
    };
    (!right).then(|| format!("{} takes {expected}, found {count}", op.name()))
}

/// The operation without regard to who sees the result.
pub(super) fn combine(op: CsgOp, children: Vec<CsgNode>) -> CsgNode {
    let count = if op == CsgOp::Bound {
        1
    } else {
        children.len()
    };
    let operands = children.into_iter().take(count).collect();
    match op {
        CsgOp::Union | CsgOp::Bound | CsgOp::LightGroup { .. } => CsgNode::Union(operands),
        CsgOp::Merge => CsgNode::Merge(operands),
        CsgOp::Intersection => CsgNode::Intersection(operands),
        CsgOp::Difference => CsgNode::Difference(operands),
        CsgOp::Inverse => CsgNode::Inverse(operands),
        CsgOp::Clip => CsgNode::Clip(operands),
    }
}
