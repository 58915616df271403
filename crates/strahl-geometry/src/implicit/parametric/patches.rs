//! The pieces of a parametric surface: a quadtree over its parameters with boxes in space.

use strahl_math::{Aabb, DVec2};

/// A rectangle of parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    pub(super) min: DVec2,
    pub(super) max: DVec2,
}

impl Rectangle {
    pub(super) fn center(&self) -> DVec2 {
        0.5 * (self.min + self.max)
    }

    pub(super) fn size(&self) -> DVec2 {
        self.max - self.min
    }

    /// The four quarters.
    pub(super) fn quarters(&self) -> [Self; 4] {
        let (a, m, b) = (self.min, self.center(), self.max);
        let at = |u0, v0, u1, v1| Self {
            min: DVec2::new(u0, v0),
            max: DVec2::new(u1, v1),
        };
        [
            at(a.x, a.y, m.x, m.y),
            at(m.x, a.y, b.x, m.y),
            at(a.x, m.y, m.x, b.y),
            at(m.x, m.y, b.x, b.y),
        ]
    }
}

/// A piece of the surface over a rectangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// Its bounds.
    pub(super) bounds: Aabb,
    /// The largest difference of the unit normals at its corners from that in its middle; infinite if there is none.
    pub(super) spread: f64,
}

/// Below this spread a piece is nearly a plane.
const FLAT: f64 = 0.25;

impl Piece {
    /// Whether it is nearly a plane.
    pub(super) fn is_flat(&self) -> bool {
        self.spread < FLAT
    }
}

/// A node of the tree.
#[derive(Clone, Copy, Debug)]
struct Node {
    piece: Piece,
    /// The first of the four children; 0 if there are none.
    children: u32,
}

/// The tree: the root is node 0, the children of a node follow each other.
#[derive(Debug)]
pub(super) struct Patches {
    nodes: Vec<Node>,
}

/// The least and the greatest number of times that rectangles are quartered.
const LEVELS: (u32, u32) = (3, 9);
/// Most pieces examined on one level; the next level is left out if it might have more.
const PIECES: usize = 1 << 16;
/// Most operations of the functions spent on a level: some ten seconds. Expensive functions get fewer pieces.
const OPERATIONS: u64 = 1 << 31;

impl Patches {
    /// Builds the tree of a domain. `examine` returns the piece over a rectangle, or `None` if it is not needed; `cost` is the
    /// number of its operations.
    pub(super) fn build(
        domain: Rectangle,
        cost: u64,
        mut examine: impl FnMut(&Rectangle) -> Option<Piece>,
    ) -> Self {
        let pieces = (OPERATIONS / cost.max(1)).min(PIECES as u64) as usize;
        let nowhere = Node {
            piece: Piece {
                bounds: Aabb::EMPTY,
                spread: 0.0,
            },
            children: 0,
        };
        let node =
            |piece: Option<Piece>| piece.map_or(nowhere, |piece| Node { piece, children: 0 });
        let mut nodes = vec![node(examine(&domain))];
        let mut leaves = vec![(0_usize, domain)];
        for level in 0..LEVELS.1 {
            let wanted = |index: usize| {
                nodes.get(index).is_some_and(|n: &Node| {
                    !n.piece.bounds.is_empty() && (level < LEVELS.0 || !n.piece.is_flat())
                })
            };
            leaves.retain(|&(index, _)| wanted(index));
            if leaves.len() * 4 > pieces {
                break;
            }
            let mut next = Vec::new();
            for (index, rectangle) in leaves {
                let first = nodes.len();
                for (k, quarter) in rectangle.quarters().into_iter().enumerate() {
                    nodes.push(node(examine(&quarter)));
                    next.push((first + k, quarter));
                }
                if let Some(parent) = nodes.get_mut(index) {
                    parent.children = first as u32;
                }
            }
            leaves = next;
        }
        Self { nodes }
    }

    /// The box around all pieces.
    pub(super) fn bounds(&self) -> Aabb {
        self.nodes.first().map_or(Aabb::EMPTY, |n| n.piece.bounds)
    }

    /// Passes the leaves whose boxes pass the test to the visitor.
    pub(super) fn visit(
        &self,
        domain: Rectangle,
        mut meets: impl FnMut(&Aabb) -> bool,
        mut leaf: impl FnMut(&Rectangle, &Piece),
    ) {
        let mut stack = vec![(0_usize, domain)];
        while let Some((index, rectangle)) = stack.pop() {
            let Some(node) = self.nodes.get(index) else {
                continue;
            };
            if node.piece.bounds.is_empty() || !meets(&node.piece.bounds) {
                continue;
            }
            if node.children == 0 {
                leaf(&rectangle, &node.piece);
                continue;
            }
            let quarters = rectangle.quarters().into_iter().enumerate();
            stack.extend(quarters.map(|(k, quarter)| (node.children as usize + k, quarter)));
        }
    }
}
