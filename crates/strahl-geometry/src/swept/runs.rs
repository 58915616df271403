use std::ops::Range;
use strahl_math::DVec2;

/// An upright rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rect {
    pub(super) min: DVec2,
    pub(super) max: DVec2,
}

impl Rect {
    /// The empty rectangle.
    pub(super) const EMPTY: Self = Self {
        min: DVec2::INFINITY,
        max: DVec2::NEG_INFINITY,
    };

    pub(super) fn around(points: &[DVec2]) -> Self {
        points.iter().fold(Self::EMPTY, |rect, &p| Self {
            min: rect.min.min(p),
            max: rect.max.max(p),
        })
    }

    pub(super) fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }
}

/// Boxes around runs of the pieces of a curve, run within run.
///
/// Neighbours along a curve are neighbours in the plane, so halving the list of pieces again and again makes a good hierarchy
/// without any sorting. The nodes stand in the order in which they are visited: one whose box is missed is left by a jump.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Runs {
    nodes: Box<[Node]>,
}

#[derive(Clone, Debug, PartialEq)]
struct Node {
    bounds: Rect,
    /// The first node that is not below this one.
    next: u32,
    /// The pieces of a leaf; empty for inner nodes.
    first: u32,
    count: u32,
}

impl Runs {
    /// Over pieces with these boxes, at most `leaf` of them in a leaf.
    pub(super) fn build(boxes: &[Rect], leaf: usize) -> Self {
        let mut nodes = vec![];
        // Halving `n` pieces goes no deeper than the bits of `n`.
        append(boxes, leaf, 0, &mut nodes);
        Self {
            nodes: nodes.into_boxed_slice(),
        }
    }

    /// The box around all pieces.
    pub(super) fn bounds(&self) -> Rect {
        self.nodes.first().map_or(Rect::EMPTY, |root| root.bounds)
    }

    /// Visits the pieces of all leaves whose boxes pass the test, in order.
    #[inline]
    pub(super) fn visit(&self, test: impl FnMut(&Rect) -> bool, visit: impl FnMut(usize)) {
        let mut visit = visit;
        self.visit_leaves(test, |pieces| pieces.for_each(&mut visit));
    }

    /// Visits the leaves whose boxes pass the test, in order, each as its pieces.
    #[inline(always)]
    pub(super) fn visit_leaves(
        &self,
        mut test: impl FnMut(&Rect) -> bool,
        mut visit: impl FnMut(Range<usize>),
    ) {
        let mut index = 0;
        while let Some(node) = self.nodes.get(index) {
            if !test(&node.bounds) {
                index = node.next as usize;
                continue;
            }
            if node.count > 0 {
                let first = node.first as usize;
                visit(first..first + node.count as usize);
            }
            index += 1;
        }
    }
}

fn append(boxes: &[Rect], most: usize, first: usize, nodes: &mut Vec<Node>) {
    let bounds = boxes.iter().fold(Rect::EMPTY, |all, b| all.union(b));
    let leaf = boxes.len() <= most;
    let place = nodes.len();
    nodes.push(Node {
        bounds,
        next: 0,
        first: first as u32,
        count: if leaf { boxes.len() as u32 } else { 0 },
    });
    if !leaf {
        let (left, right) = boxes.split_at(boxes.len() / 2);
        append(left, most, first, nodes);
        append(right, most, first + left.len(), nodes);
    }
    let next = nodes.len() as u32;
    if let Some(node) = nodes.get_mut(place) {
        node.next = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_piece_whose_box_passes_is_visited_once_and_in_order() {
        for count in [0, 1, 3, 4, 17, 100] {
            let boxes: Vec<_> = (0..count)
                .map(|i| {
                    Rect::around(&[DVec2::splat(f64::from(i)), DVec2::splat(f64::from(i) + 0.9)])
                })
                .collect();
            let runs = Runs::build(&boxes, 3);
            let (mut all, mut some) = (vec![], vec![]);
            runs.visit(|_| true, |i| all.push(i));
            assert_eq!(all, (0..count as usize).collect::<Vec<_>>());
            runs.visit(|b| b.min.x <= 10.5 && 10.5 <= b.max.x, |i| some.push(i));
            assert_eq!(some.contains(&10), count > 10);
            assert!(some.len() <= 3);
        }
    }
}
