//! The pieces of a patch: a quadtree over its parameters with boxes in space.

use super::net::Net;
use strahl_math::error::{gamma, round_down_f32, round_up_f32};
use strahl_math::{Aabb, DVec3};

/// How far beyond its piece, in parts of it, a point may be found: neighbours overlap, so that no ray slips through between
/// them.
pub(super) const OVERLAP: f64 = 1.0 / (1u64 << 20) as f64;
/// Pieces are quartered so often at most; a ray that needs smaller ones makes them for itself.
pub(super) const LEVELS: u8 = 4;
/// A piece is flat if its derivatives differ from their middle by this part of it at most.
const FLAT: f64 = 0.1;

/// A piece of a patch over a square of its parameters. All vectors are relative to the anchor of the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) low: [f32; 3],
    pub(super) high: [f32; 3],
    /// The first of its four quarters; 0 if there are none.
    pub(super) first: u32,
    /// It is the square number `(i, j)` of `2^level` by `2^level`.
    pub(super) level: u8,
    pub(super) i: u8,
    pub(super) j: u8,
    /// The point in its middle.
    pub(super) middle: [f32; 3],
    /// The middle of all its derivatives, by parameters that run from 0 to 1 within the piece.
    pub(super) by_u: [f32; 3],
    pub(super) by_v: [f32; 3],
    /// The largest differences of derivatives from these; infinite if they are not known.
    pub(super) spread_u: f32,
    pub(super) spread_v: f32,
}

/// The tree: the root is piece 0, the quarters of a piece follow each other.
#[derive(Debug)]
pub(super) struct Tree {
    pub(super) anchor: DVec3,
    /// The diagonal of the box around the control points.
    pub(super) size: f64,
    /// A bound of the rounding error of `middle`.
    pub(super) blur: f64,
    pub(super) pieces: Vec<Piece>,
}

/// The control points of a net of points times their weights, and the weights.
pub(super) fn points<const K: usize>(net: &Net<4, K>) -> impl Iterator<Item = DVec3> + Clone {
    net.points().map(|p| project(*p))
}

/// A point from the point times its weight, and its weight.
pub(super) fn project([x, y, z, w]: [f64; 4]) -> DVec3 {
    DVec3::new(x, y, z) / w
}

/// The box around the control points, widened by what lies beyond the ends of the parameters and by rounding errors.
pub(super) fn hull<const K: usize>(net: &Net<4, K>) -> Aabb {
    let tight = Aabb::from_points(points(net));
    let noise = tight.min.abs().max(tight.max.abs()) * gamma(16 * K as u32);
    tight.padded(tight.size() * (K as f64 * OVERLAP) + noise)
}

/// A box around a patch, closer than that around its control points.
pub(super) fn bounds<const K: usize>(net: &Net<4, K>) -> Aabb {
    let quarters = |net: &Net<4, K>| {
        let halves = net.halves_u();
        halves.map(|half| half.halves_v())
    };
    let mut all = Aabb::EMPTY;
    for quarter in quarters(net).as_flattened() {
        for part in quarters(quarter).as_flattened() {
            all = all.union(&hull(part));
        }
    }
    all
}

/// The middle of vectors, and how far they are from it at most.
fn middle(vectors: impl Iterator<Item = [f64; 4]> + Clone, is_rational: bool) -> ([f32; 3], f32) {
    if is_rational {
        return ([0.0; 3], f32::INFINITY);
    }
    let all = vectors.map(|[x, y, z, _]| DVec3::new(x, y, z));
    let middle = Aabb::from_points(all.clone()).center().as_vec3();
    let spread = all.fold(0.0, |most: f64, v| {
        most.max((v - middle.as_dvec3()).length())
    });
    (middle.to_array(), round_up_f32(spread * (1.0 + gamma(16))))
}

impl Tree {
    /// The bytes that its pieces take.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.pieces.as_slice())
    }

    pub(super) fn build<const K: usize>(net: &Net<4, K>, is_rational: bool) -> Self {
        let anchor = bounds(net).min;
        let size = hull(net).size().length();
        let mut tree = Self {
            anchor,
            size,
            blur: size * f64::from(f32::EPSILON),
            pieces: vec![],
        };
        let root = tree.piece(net, is_rational, (0, 0, 0));
        tree.pieces.push(root);
        tree.divide(0, net, is_rational);
        tree
    }

    fn piece<const K: usize>(
        &self,
        net: &Net<4, K>,
        is_rational: bool,
        (level, i, j): (u8, u8, u8),
    ) -> Piece {
        let hull = hull(net);
        let (by_u, spread_u) = middle(net.slopes_u(), is_rational);
        let (by_v, spread_v) = middle(net.slopes_v(), is_rational);
        let center = project(net.at(0.5, 0.5)) - self.anchor;
        Piece {
            low: (hull.min - self.anchor).to_array().map(round_down_f32),
            high: (hull.max - self.anchor).to_array().map(round_up_f32),
            first: 0,
            level,
            i,
            j,
            middle: center.as_vec3().to_array(),
            by_u,
            by_v,
            spread_u,
            spread_v,
        }
    }

    fn divide<const K: usize>(&mut self, index: usize, net: &Net<4, K>, is_rational: bool) {
        let first = self.pieces.len();
        let Some(piece) = self.pieces.get_mut(index) else {
            return;
        };
        let length = |v: [f32; 3]| DVec3::from_array(v.map(f64::from)).length();
        let (u, v) = (length(piece.by_u), length(piece.by_v));
        let is_flat = f64::from(piece.spread_u) * v + f64::from(piece.spread_v) * u <= FLAT * u * v;
        if piece.level == LEVELS || is_flat {
            return;
        }
        piece.first = first as u32;
        let (level, i, j) = (piece.level + 1, 2 * piece.i, 2 * piece.j);
        let [left, right] = net.halves_u();
        let ([a, c], [b, d]) = (left.halves_v(), right.halves_v());
        let quarters = [(a, 0, 0), (b, 1, 0), (c, 0, 1), (d, 1, 1)];
        for (net, x, y) in &quarters {
            let piece = self.piece(net, is_rational, (level, i + x, j + y));
            self.pieces.push(piece);
        }
        for (k, (net, ..)) in quarters.iter().enumerate() {
            self.divide(first + k, net, is_rational);
        }
    }
}
