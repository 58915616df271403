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

/// Most pieces in a leaf: testing their control points costs little more than testing a box.
const LEAF: usize = 3;

impl Runs {
    /// Over pieces with these boxes.
    pub(super) fn build(boxes: &[Rect]) -> Self {
        let mut nodes = vec![];
        // Halving `n` pieces goes no deeper than the bits of `n`.
        append(boxes, 0, &mut nodes);
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
    pub(super) fn visit(&self, mut test: impl FnMut(&Rect) -> bool, mut visit: impl FnMut(usize)) {
        let mut index = 0;
        while let Some(node) = self.nodes.get(index) {
            if !test(&node.bounds) {
                index = node.next as usize;
                continue;
            }
            let first = node.first as usize;
            for piece in first..first + node.count as usize {
                visit(piece);
            }
            index += 1;
        }
    }
}

fn append(boxes: &[Rect], first: usize, nodes: &mut Vec<Node>) {
    let bounds = boxes.iter().fold(Rect::EMPTY, |all, b| all.union(b));
    let leaf = boxes.len() <= LEAF;
    let place = nodes.len();
    nodes.push(Node {
        bounds,
        next: 0,
        first: first as u32,
        count: if leaf { boxes.len() as u32 } else { 0 },
    });
    if !leaf {
        let (left, right) = boxes.split_at(boxes.len() / 2);
        append(left, first, nodes);
        append(right, first + left.len(), nodes);
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
            let runs = Runs::build(&boxes);
            let (mut all, mut some) = (vec![], vec![]);
            runs.visit(|_| true, |i| all.push(i));
            assert_eq!(all, (0..count as usize).collect::<Vec<_>>());
            runs.visit(|b| b.min.x <= 10.5 && 10.5 <= b.max.x, |i| some.push(i));
            assert_eq!(some.contains(&10), count > 10);
            assert!(some.len() <= LEAF);
        }
    }
}
