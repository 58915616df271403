//! The pieces of a patch: a tree over its parameters, sixteen pieces in each node.
//!
//! The pieces of a node have boxes along the axes. A leaf has a frame of its own as well, in which it is nearly the unit square: a
//! thin slab, whatever way it lies in space. So few rays get to leaves that they miss, and for nearly all others the frame tells at once
//! that the piece is nearly linear as the ray sees it, and where its hit is, nearly (slabs along the geometry instead of the axes:
//! Woop, Benthin, Wald, Johnson, Tabellion, "Exploiting Local Orientation Similarity for Efficient Ray Traversal of Hair and
//! Fur", High Performance Graphics 2014).

use super::frame::Frame;
use super::hull::{hull, sixteenths};
use super::leaf::{Leaf, LocalRay, NEARLY_LINEAR, Verdict};
use super::net::Net;
use super::piece::{Curving, Piece, Square};
use std::collections::VecDeque;
use std::sync::OnceLock;
use strahl_accel::{SixteenBoxes, SixteenSlabs};
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec3, Interval, Ray};
use strahl_simd::{Isa, Simd, dispatch};

/// So many nodes lie below each other at most; a ray that needs smaller pieces makes them for itself.
const NODES: u8 = 2;
/// Sixteen pieces: the parts of a larger one.
#[derive(Clone, Debug)]
struct Node {
    boxes: SixteenBoxes,
    square: Square,
    /// In the coordinates of the tree.
    curving: Curving<f32>,
    /// The places with leaves, as bits; at others there are nodes.
    leaves: u16,
    /// Those of a node follow each other.
    first_leaf: u32,
    first_node: u32,
}

/// The tree of a patch. It is kept in coordinates `(p - anchor) scale`, in which the patch is nearly as large as 1.
#[derive(Debug)]
pub(super) struct Tree {
    anchor: DVec3,
    /// A power of two.
    scale: f64,
    /// How far the patch may be from what neighbours know of it.
    seam: f64,
    /// The whole patch as a piece.
    whole: Leaf,
    curving: Curving<f32>,
    kind: Kind,
    /// The parts, when the first ray comes that needs them.
    pieces: OnceLock<Pieces>,
}

/// What the whole patch tells as a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// It is never divided.
    Flat,
    /// Of many rays it tells the hit; the parts are made for the others.
    Gentle,
    /// Only the parts are of use.
    Curved,
}

/// Smaller and smaller parts of a patch.
#[derive(Debug, Default)]
struct Pieces {
    /// The root is node 0.
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
}

/// Who is shown the pieces along a ray.
pub(super) trait Visitor {
    /// The range in which hits are still wanted; `None` if the search is over.
    fn range(&self) -> Option<Interval>;
    /// A piece that is nearly linear as the ray sees it: its hit is near this place, in parts of the piece, or there is none.
    fn certain(&mut self, square: Square, start: [f64; 2]);
    /// A piece about which nothing is certain.
    fn uncertain(&mut self, square: Square, curving: &Curving);
}

impl Tree {
    /// The bytes that its pieces take.
    pub(super) fn bytes(&self) -> usize {
        self.pieces.get().map_or(0, |pieces| {
            size_of_val(pieces.nodes.as_slice()) + size_of_val(pieces.leaves.as_slice())
        })
    }

    /// The tree of a net that may be this far from what neighbours know of it.
    pub(super) fn build<const K: usize>(net: &Net<4, K>, seam: f64) -> Self {
        let hull = hull(net);
        let mut tree = Self {
            anchor: hull.min,
            scale: scale(hull.size().max_element()),
            seam,
            whole: Leaf::new([DVec3::ZERO; 3], DVec3::ZERO),
            curving: Curving::NONE,
            kind: Kind::Flat,
            pieces: OnceLock::new(),
        };
        let piece = Piece::new(net, (tree.anchor, tree.scale), seam);
        let (whole, bounds) = piece.leaf();
        tree.curving = piece.curving_of(Square::WHOLE);
        tree.whole = whole;
        if !bounds.is_flat() {
            tree.kind = if bounds.bend < NEARLY_LINEAR {
                Kind::Gentle
            } else {
                Kind::Curved
            };
        }
        tree
    }

    /// The parts of the net.
    fn divide<const K: usize>(&self, net: &Net<4, K>) -> Pieces {
        let mut pieces = Pieces::default();
        // Nodes in the order of their numbers, which are given when they come into the queue.
        let mut queue = VecDeque::from([(*net, Square::WHOLE, self.curving, 1)]);
        while let Some((net, square, curving, depth)) = queue.pop_front() {
            let mut node = Node {
                boxes: SixteenBoxes::EMPTY,
                square,
                curving,
                leaves: 0,
                first_leaf: pieces.leaves.len() as u32,
                first_node: (pieces.nodes.len() + 1 + queue.len()) as u32,
            };
            for (place, part) in sixteenths(&net).as_flattened().iter().enumerate() {
                node.boxes.set(place, &self.local(part));
                let piece = Piece::new(part, (self.anchor, self.scale), self.seam);
                let (leaf, bounds) = piece.leaf();
                if depth == NODES || bounds.is_flat() {
                    node.leaves |= 1 << place;
                    pieces.leaves.push(leaf);
                } else {
                    let square = square.sixteenth(place);
                    queue.push_back((*part, square, piece.curving_of(square), depth + 1));
                }
            }
            pieces.nodes.push(node);
        }
        pieces.nodes.shrink_to_fit();
        pieces.leaves.shrink_to_fit();
        pieces
    }

    /// The box around a piece, in the coordinates of the tree.
    fn local<const K: usize>(&self, part: &Net<4, K>) -> Aabb {
        let Aabb { min, max } = hull(part).padded(DVec3::splat(self.seam));
        let local = |p: DVec3| (p - self.anchor) * self.scale;
        Aabb::new(local(min), local(max))
    }

    /// Shows the pieces along a ray to the visitor, nearly in the order in which the ray enters them.
    pub(super) fn walk<const K: usize>(
        &self,
        net: &Net<4, K>,
        frame: &Frame,
        visitor: &mut dyn Visitor,
    ) {
        let divide = || self.divide(net);
        dispatch!(Simd::best(), isa => self.walk_with(isa, frame, &divide, visitor));
    }

    #[inline(always)]
    fn walk_with<I: Isa>(
        &self,
        isa: I,
        frame: &Frame,
        divide: &dyn Fn() -> Pieces,
        visitor: &mut dyn Visitor,
    ) {
        let per = frame.length * self.scale;
        let is_usable = per > 0.0 && per < f64::INFINITY;
        let local = |range: Interval| {
            if is_usable {
                Interval::new(range.min * per, range.max * per)
            } else {
                Interval::LINE
            }
        };
        let Some(mut range) = visitor.range().map(local) else {
            return;
        };
        let origin = (frame.origin - self.anchor) * self.scale;
        let straight = Ray::new(origin, frame.along);
        let splat = |v: DVec3| [isa.splat(v.x), isa.splat(v.y), isa.splat(v.z)];
        let ray = LocalRay::<I> {
            origin: splat(origin),
            direction: splat(frame.along),
            noise: isa.splat((1.0 + origin.abs().max_element()) * gamma(512)),
        };
        if self.kind != Kind::Curved {
            let verdict = self.whole.meet(isa, &ray, range);
            if self.kind == Kind::Flat || !matches!(verdict, Verdict::Uncertain) {
                show(verdict, Square::WHOLE, &self.curving, self.scale, visitor);
                return;
            }
        }
        let pieces = self.pieces.get_or_init(divide);
        let Some(slabs) = SixteenSlabs::new(isa, &straight, range) else {
            return;
        };
        let mut t_max = slabs.t_max(range.max);
        // A place of a node, and where the ray enters its box.
        let mut stack = [(0_u32, 0.0_f32); 16 * NODES as usize];
        let (mut height, mut number) = (0, 0);
        loop {
            let Some(node) = pieces.nodes.get(number as usize) else {
                return;
            };
            let (near, mut hit) = slabs.enter(isa, &node.boxes, t_max);
            let near = isa.store_f32x16(near).0;
            let base = height;
            while hit != 0 {
                let place = hit.trailing_zeros();
                hit &= hit - 1;
                let near = near[place as usize & 15];
                // The nearest one on top.
                let mut at = height;
                while at > base && stack[at - 1].1 < near {
                    stack[at] = stack[at - 1];
                    at -= 1;
                }
                stack[at] = (number << 4 | place, near);
                height += 1;
            }
            // Leaves, until there is a node.
            number = loop {
                if height == 0 {
                    return;
                }
                height -= 1;
                let (index, near) = stack[height];
                if near > t_max {
                    continue;
                }
                let Some(parent) = pieces.nodes.get(index as usize >> 4) else {
                    return;
                };
                let place = index & 15;
                let before = u32::from(parent.leaves) & ((1 << place) - 1);
                if parent.leaves >> place & 1 == 0 {
                    break parent.first_node + place - before.count_ones();
                }
                let number = parent.first_leaf + before.count_ones();
                let Some(leaf) = pieces.leaves.get(number as usize) else {
                    return;
                };
                let square = parent.square.sixteenth(place as usize);
                let verdict = leaf.meet(isa, &ray, range);
                if show(verdict, square, &parent.curving, self.scale, visitor) {
                    let Some(wanted) = visitor.range() else {
                        return;
                    };
                    range = local(wanted);
                    t_max = slabs.t_max(range.max);
                }
            };
        }
    }
}

/// Shows a leaf to the visitor, unless the ray misses it.
#[inline(always)]
fn show(
    verdict: Verdict,
    square: Square,
    curving: &Curving<f32>,
    scale: f64,
    visitor: &mut dyn Visitor,
) -> bool {
    match verdict {
        Verdict::Missed => return false,
        Verdict::Certain(start) => visitor.certain(square, start),
        Verdict::Uncertain => {
            let unscaled = |length: f32| f64::from(length) / scale;
            let Curving { uu, uv, vv } = curving;
            let (uu, uv, vv) = (unscaled(*uu), unscaled(*uv), unscaled(*vv));
            visitor.uncertain(square, &Curving { uu, uv, vv });
        }
    }
    true
}

/// The power of two that makes a length nearly 1.
fn scale(length: f64) -> f64 {
    let exponent = (length.to_bits() >> 52) as i64 - 1023;
    f64::from_bits(((1023 - exponent.clamp(-1000, 1000)) as u64) << 52)
}
