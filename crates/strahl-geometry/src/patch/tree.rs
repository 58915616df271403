//! The pieces of a patch: a tree over its parameters, sixteen pieces in each node.
//!
//! The pieces of a node have boxes along the axes. A leaf has a frame of its own as well, in which it is nearly the unit square: a
//! thin slab, whatever way it lies in space. So few rays get to leaves that they miss, and for nearly all others the frame tells at once
//! that the piece is nearly linear as the ray sees it, and where its hit is, nearly (slabs along the geometry instead of the axes:
//! Woop, Benthin, Wald, Johnson, Tabellion, "Exploiting Local Orientation Similarity for Efficient Ray Traversal of Hair and
//! Fur", High Performance Graphics 2014).

use super::frame::Frame;
use super::hull::{hull, sixteenths};
use super::leaf::{Leaf, LocalRay, NEARLY_LINEAR, Question, Verdict};
use super::net::Net;
use super::piece::{Curving, PatchPlace, Piece, Square};
use arrayvec::ArrayVec;
use std::sync::OnceLock;
use strahl_accel::{SixteenBoxes, SixteenSlabs};
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec3, Interval, Ray};
use strahl_simd::{Isa, Simd, dispatch};

/// So many nodes lie below each other at most: one of the whole patch and those of its parts. A ray that needs smaller pieces makes them for itself.
const NODES: u8 = 2;
/// Sixteen pieces: the parts of a larger one.
#[derive(Debug)]
struct Node {
    boxes: SixteenBoxes,
    square: Square,
    /// In the coordinates of the tree.
    curving: Curving<f32>,
    /// The places with leaves, as bits; at others there are nodes.
    leaf_places: u16,
    leaves: Box<[Leaf]>,
    /// Each from when the first ray comes that needs it.
    nodes: Box<[OnceLock<Box<Self>>]>,
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
    parts: OnceLock<Box<Node>>,
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

/// Who is shown the pieces along a ray.
pub(super) trait Visitor {
    /// The range in which hits are still wanted; `None` if the search is over.
    fn range(&self) -> Option<Interval>;
    /// Whether any hit will do.
    fn wants_any(&self) -> bool;
    /// There is a hit in the range. Only told those who want any.
    fn met(&mut self);
    /// A piece that is nearly linear as the ray sees it: its hit is near this place, in parts of the piece, or there is none.
    fn certain(&mut self, square: Square, start: [f64; 2]);
    /// A piece about which nothing is certain.
    fn uncertain(&mut self, square: Square, curving: &Curving);
}

impl Tree {
    /// The bytes that it takes, so far.
    pub(super) fn bytes(&self) -> usize {
        size_of::<Self>() + self.parts.get().map_or(0, |node| node.bytes())
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
            parts: OnceLock::new(),
        };
        let piece = tree.piece(net);
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

    /// The node of a part of the net.
    fn node<const K: usize>(&self, part: &Net<4, K>, square: Square) -> Node {
        let mut boxes = SixteenBoxes::EMPTY;
        let (mut leaf_places, mut leaves) = (0, ArrayVec::<Leaf, 16>::new());
        let is_last = square.level + 2 == 2 * NODES;
        for (place, part) in sixteenths(part).as_flattened().iter().enumerate() {
            boxes.set(place, &self.local(part));
            let (leaf, bounds) = self.piece(part).leaf();
            if is_last || bounds.is_flat() {
                leaf_places |= 1 << place;
                leaves.push(leaf);
            }
        }
        Node {
            boxes,
            square,
            curving: self.piece(part).curving_of(square),
            leaf_places,
            nodes: (leaves.len()..16).map(|_| OnceLock::new()).collect(),
            leaves: leaves.iter().copied().collect(),
        }
    }

    /// A part of the net as a piece.
    fn piece<const K: usize>(&self, part: &Net<4, K>) -> Piece<K> {
        Piece::new(part, (self.anchor, self.scale), self.seam)
    }

    /// The box around a piece, in the coordinates of the tree.
    fn local<const K: usize>(&self, part: &Net<4, K>) -> Aabb {
        let Aabb { min, max } = hull(part).padded(DVec3::splat(self.seam));
        let local = |p: DVec3| (p - self.anchor) * self.scale;
        Aabb::new(local(min), local(max))
    }

    /// Shows the pieces along a ray to the visitor, nearly in the order in which the ray enters them. If the ray starts on the patch, this
    /// place is no hit; the piece around it need not be shown.
    pub(super) fn walk<const K: usize>(
        &self,
        net: &Net<4, K>,
        (frame, start): (&Frame, Option<PatchPlace>),
        visitor: &mut dyn Visitor,
    ) {
        // The node of the whole patch, or of a part.
        let divide = |place: Option<usize>| {
            Box::new(match place {
                None => self.node(net, Square::WHOLE),
                Some(place) => {
                    let parts = sixteenths(net);
                    self.node(&parts.as_flattened()[place], Square::WHOLE.sixteenth(place))
                }
            })
        };
        dispatch!(Simd::best(), isa => self.walk_with(isa, (frame, start), &divide, visitor));
    }

    #[inline(always)]
    fn walk_with<I: Isa>(
        &self,
        isa: I,
        (frame, start): (&Frame, Option<PatchPlace>),
        divide: &dyn Fn(Option<usize>) -> Box<Node>,
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
        let any = visitor.wants_any();
        let question = |square: Square, range: Interval| Question {
            range,
            starts: start.is_some_and(|place| place.is_within(square)),
            any,
        };
        if self.kind != Kind::Curved {
            let verdict = self.whole.meet(isa, &ray, question(Square::WHOLE, range));
            if self.kind == Kind::Flat || !matches!(verdict, Verdict::Uncertain) {
                show(verdict, Square::WHOLE, &self.curving, self.scale, visitor);
                return;
            }
        }
        let mut node: &Node = self.parts.get_or_init(|| divide(None));
        let Some(slabs) = SixteenSlabs::new(isa, &straight, range) else {
            return;
        };
        let mut t_max = slabs.t_max(range.max);
        // Places of nodes, and where the ray enters their boxes: the nearest one is the last.
        let mut stack = ArrayVec::<(&Node, u32, f32), { 16 * NODES as usize }>::new();
        loop {
            let (near, mut hit) = slabs.enter(isa, &node.boxes, t_max);
            let near = isa.store_f32x16(near).0;
            let base = stack.len();
            while hit != 0 {
                let place = hit.trailing_zeros();
                hit &= hit - 1;
                let near = near[place as usize & 15];
                stack.push((node, place, near));
                let mut at = stack.len() - 1;
                while at > base && stack[at - 1].2 < near {
                    stack.swap(at - 1, at);
                    at -= 1;
                }
            }
            // Leaves, until there is a node.
            node = loop {
                let Some((parent, place, near)) = stack.pop() else {
                    return;
                };
                if near > t_max {
                    continue;
                }
                let leaves_before = parent.leaf_places & ((1_u16 << place) - 1);
                let leaves_before = leaves_before.count_ones();
                if parent.leaf_places >> place & 1 == 0 {
                    let Some(part) = parent.nodes.get((place - leaves_before) as usize) else {
                        return;
                    };
                    break part.get_or_init(|| divide(Some(place as usize)));
                }
                let Some(leaf) = parent.leaves.get(leaves_before as usize) else {
                    return;
                };
                let square = parent.square.sixteenth(place as usize);
                let verdict = leaf.meet(isa, &ray, question(square, range));
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

impl Node {
    /// The bytes that it takes, so far.
    fn bytes(&self) -> usize {
        let nodes = self.nodes.iter().filter_map(|node| node.get());
        size_of::<Self>()
            + size_of_val(&*self.leaves)
            + size_of_val(&*self.nodes)
            + nodes.map(|node| node.bytes()).sum::<usize>()
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
        Verdict::Met => visitor.met(),
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
