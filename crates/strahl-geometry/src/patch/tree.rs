//! The pieces of a patch: a tree over its parameters, sixteen pieces in each node.
//!
//! The pieces of a node have boxes along the axes. A leaf has a frame of its own as well, in which it is nearly the unit square: a
//! thin slab, whatever way it lies in space. So few rays get to leaves that they miss, and for nearly all others the frame tells at once
//! that the piece is nearly linear as the ray sees it, and where its hit is, nearly (slabs along the geometry instead of the axes:
//! Woop, Benthin, Wald, Johnson, Tabellion, "Exploiting Local Orientation Similarity for Efficient Ray Traversal of Hair and
//! Fur", High Performance Graphics 2014).

use super::frame::Frame;
use super::net::Net;
use std::collections::VecDeque;
use std::sync::OnceLock;
use strahl_accel::{SixteenBoxes, SixteenSlabs};
use strahl_math::error::{gamma, round_up_f32};
use strahl_math::{Aabb, DMat3, DVec3, Interval, Ray};
use strahl_simd::{Isa, Simd, dispatch};

/// How far beyond its piece, in parts of it, a point may be found: neighbours overlap, so that no ray slips through between
/// them.
pub(super) const OVERLAP: f64 = 1.0 / (1u64 << 20) as f64;
/// So many nodes lie below each other at most; a ray that needs smaller pieces makes them for itself.
const NODES: u8 = 2;
/// A piece is a leaf if its derivatives differ from their mean by this part of it at most.
const FLAT: f64 = 0.1;
/// Of a piece whose weights differ more from the one in its middle it isn't known how nearly linear it is.
const UNEVEN: f64 = 0.25;
/// The map of a piece may differ from a linear one by this part at most for Newton's method to be certain.
pub(super) const NEARLY_LINEAR: f64 = 0.35;
/// Pieces whose frame would stretch them more than this are put into a box along the axes.
const MOST_STRETCHED: f64 = 1e6;

/// A square of the parameters: number `(i, j)` of `2^level` by `2^level`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Square {
    pub(super) level: u8,
    pub(super) i: u8,
    pub(super) j: u8,
}

impl Square {
    const WHOLE: Self = Self {
        level: 0,
        i: 0,
        j: 0,
    };

    /// Part number `place` of 4 by 4.
    fn sixteenth(self, place: usize) -> Self {
        Self {
            level: self.level + 2,
            i: self.i << 2 | place as u8 & 3,
            j: self.j << 2 | place as u8 >> 2,
        }
    }
}

/// A piece over a square that is not divided any more: a frame in which it is near the square `-0.5..0.5` by `-0.5..0.5` of the plane
/// `w = 0`.
///
/// The first three lanes of the four vectors are a matrix, column by column, and a vector: `p` is at `columns p + offset` in the
/// frame. The fourth lanes are bounds of the piece in it.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Leaf([[f32; 4]; 4]);

const _: () = assert!(size_of::<Leaf>() == 64);

/// What is known of a piece in the frame of its leaf.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    /// The largest coordinates u and v of its points.
    side: f64,
    /// The largest w of its points.
    height: f64,
    /// How much the derivatives by both parameters together differ from the unit vectors within the plane, at most; infinite if
    /// that is not known.
    bend: f64,
    /// How much they differ from it across the plane.
    tilt: f64,
}

/// Bounds of the lengths of the second derivatives of points, by the parameters of the patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curving<T = f64> {
    pub(super) uu: T,
    pub(super) uv: T,
    pub(super) vv: T,
}

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

/// What a ray means for a leaf.
enum Verdict {
    Missed,
    /// As [`Visitor::certain`].
    Certain([f64; 2]),
    Uncertain,
}

/// The control points of a net of points times their weights, and the weights.
pub(super) fn points<const K: usize>(net: &Net<4, K>) -> impl Iterator<Item = DVec3> + Clone {
    net.points().map(|p| project(*p))
}

/// A point from the point times its weight, and its weight.
pub(super) fn project([x, y, z, w]: [f64; 4]) -> DVec3 {
    let point = DVec3::new(x, y, z);
    // The same, without the time of a division.
    if w == 1.0 { point } else { point / w }
}

/// The box around the control points, widened by what lies beyond the ends of the parameters and by rounding errors.
pub(super) fn hull<const K: usize>(net: &Net<4, K>) -> Aabb {
    let mut tight = Aabb::EMPTY;
    for p in net.rows.as_flattened() {
        let p = project(*p);
        tight = Aabb::new(tight.min.min(p), tight.max.max(p));
    }
    let noise = tight.min.abs().max(tight.max.abs()) * gamma(16 * K as u32);
    tight.padded(tight.size() * (K as f64 * OVERLAP) + noise)
}

/// The sixteen parts of a net, row after row.
fn sixteenths<const K: usize>(net: &Net<4, K>) -> [[Net<4, K>; 4]; 4] {
    let [left, right] = net.halves_u();
    let ([a, b], [c, d]) = (left.halves_u(), right.halves_u());
    let columns = [a, b, c, d];
    let mut parts = [columns; 4];
    for (i, column) in columns.iter().enumerate() {
        let [below, above] = column.halves_v();
        [parts[0][i], parts[1][i]] = below.halves_v();
        [parts[2][i], parts[3][i]] = above.halves_v();
    }
    parts
}

/// A box around a patch, closer than that around its control points.
pub(super) fn bounds<const K: usize>(net: &Net<4, K>) -> Aabb {
    let parts = sixteenths(net);
    let hulls = parts.as_flattened().iter().map(hull);
    hulls.fold(Aabb::EMPTY, |all, hull| all.union(&hull))
}

impl Bounds {
    /// Whether no smaller pieces are needed.
    fn is_flat(&self) -> bool {
        self.bend + self.tilt <= FLAT
    }
}

impl Leaf {
    fn new(columns: [DVec3; 3], offset: DVec3) -> Self {
        let lanes = |v: DVec3| [v.x as f32, v.y as f32, v.z as f32, 0.0];
        let [x, y, z] = columns;
        Self([lanes(x), lanes(y), lanes(z), lanes(offset)])
    }

    /// The matrix and the offset, as they are stored.
    fn map(&self) -> (DMat3, DVec3) {
        let vector = |[x, y, z, _]: [f32; 4]| DVec3::new(x.into(), y.into(), z.into());
        let [x, y, z, offset] = self.0;
        let matrix = DMat3::from_cols(vector(x), vector(y), vector(z));
        (matrix, vector(offset))
    }

    fn set_bounds(&mut self, bounds: &Bounds) {
        let all = [bounds.side, bounds.bend, bounds.tilt, bounds.height];
        for (lanes, bound) in self.0.iter_mut().zip(all) {
            lanes[3] = round_up_f32(bound);
        }
    }

    /// What a ray means for the piece, and where it enters the slab is within a range.
    #[inline(always)]
    fn meet<I: Isa>(&self, isa: I, ray: &LocalRay<I>, range: Interval) -> Verdict {
        let [x, y, z, offset] = &self.0;
        let (side, bend) = (f64::from(x[3]), f64::from(y[3]));
        let (tilt, height) = (f64::from(z[3]), f64::from(offset[3]));
        let columns = [isa.load_wide(x), isa.load_wide(y), isa.load_wide(z)];
        let offset = isa.load_wide(offset);
        let origin = isa.add(product(isa, &columns, &ray.origin), offset);
        let direction = product(isa, &columns, &ray.direction);
        let largest = isa.add(
            isa.add(isa.abs(columns[0]), isa.abs(columns[1])),
            isa.add(isa.abs(columns[2]), isa.abs(offset)),
        );
        let pad = isa.mul(largest, ray.noise);
        // Where the ray enters and leaves the slabs of the three axes.
        let reach = isa.add(isa.load(&[side, side, height, f64::INFINITY]), pad);
        let minus_reach = isa.sub(isa.splat(0.0), reach);
        let per = isa.div(isa.splat(1.0), direction);
        let a = isa.mul(isa.sub(minus_reach, origin), per);
        let b = isa.mul(isa.sub(reach, origin), per);
        let (enter, leave) = (isa.store(isa.min(a, b)), isa.store(isa.max(a, b)));
        let (mut near, mut far) = (range.min, range.max);
        for k in 0..3 {
            // Comparisons with NaN, when the ray runs within a side, change nothing.
            if enter[k] > near {
                near = enter[k];
            }
            if leave[k] < far {
                far = leave[k];
            }
        }
        // The ends are a quotient of rounded numbers.
        if near - near.abs() * gamma(8) > far + far.abs() * gamma(8) {
            return Verdict::Missed;
        }
        let (o, d) = (isa.store(origin), isa.store(direction));
        let slope = [d[0] / d[2], d[1] / d[2]];
        let [u, v] = [slope[0].abs(), slope[1].abs()];
        let steepest = if u > v { u } else { v };
        if bend + steepest * tilt < NEARLY_LINEAR {
            return Verdict::Certain([0.5 + o[0] - o[2] * slope[0], 0.5 + o[1] - o[2] * slope[1]]);
        }
        Verdict::Uncertain
    }
}

/// A matrix, given by its columns, times a vector with each coordinate in all lanes.
#[inline(always)]
fn product<I: Isa>(isa: I, columns: &[I::F64x4; 3], v: &[I::F64x4; 3]) -> I::F64x4 {
    isa.add(
        isa.add(isa.mul(columns[0], v[0]), isa.mul(columns[1], v[1])),
        isa.mul(columns[2], v[2]),
    )
}

/// A ray in the coordinates of a tree, each of them in all lanes of a vector.
struct LocalRay<I: Isa> {
    origin: [I::F64x4; 3],
    direction: [I::F64x4; 3],
    /// A bound of rounding errors, per coordinate of a frame.
    noise: I::F64x4,
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
        let piece = Piece::new(net, &tree);
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
                let piece = Piece::new(part, self);
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

impl Curving<f32> {
    const NONE: Self = Self {
        uu: 0.0,
        uv: 0.0,
        vv: 0.0,
    };
}

impl Curving {
    /// Scaled and rounded up; also a little, so that it holds beyond the ends of the parameters.
    fn times(self, factor: f64) -> Curving<f32> {
        let up = |x: f64| round_up_f32(x * factor * (1.0 + 1.0 / 1024.0));
        Curving {
            uu: up(self.uu),
            uv: up(self.uv),
            vv: up(self.vv),
        }
    }
}

/// The power of two that makes a length nearly 1.
fn scale(length: f64) -> f64 {
    let exponent = (length.to_bits() >> 52) as i64 - 1023;
    f64::from_bits(((1023 - exponent.clamp(-1000, 1000)) as u64) << 52)
}

/// A piece in the coordinates of a tree.
struct Piece<const K: usize> {
    points: [[DVec3; K]; K],
    /// In parts of that of the middle.
    weights: [[f64; K]; K],
    /// A bound of the rounding errors of points.
    noise: f64,
}

impl<const K: usize> Piece<K> {
    fn new(part: &Net<4, K>, tree: &Tree) -> Self {
        let (anchor, scale) = (tree.anchor, tree.scale);
        let middle = part.at(0.5, 0.5)[3];
        let mut piece = Self {
            points: [[DVec3::ZERO; K]; K],
            weights: [[1.0; K]; K],
            noise: 0.0,
        };
        let mut largest: f64 = 0.0;
        for (j, row) in part.rows.iter().enumerate() {
            for (i, p) in row.iter().enumerate() {
                let point = project(*p);
                largest = largest.max(point.abs().max_element());
                piece.points[j][i] = (point - anchor) * scale;
                piece.weights[j][i] = p[3] / middle;
            }
        }
        piece.noise = (largest * gamma(16 * K as u32) + tree.seam) * scale;
        piece
    }

    /// The matrix that maps the mean derivatives to the unit vectors of the plane, and the normal of both, as long as they are, to the
    /// third one; column by column.
    fn columns(&self) -> [DVec3; 3] {
        let last = K - 1;
        let (mut by_u, mut by_v) = (DVec3::ZERO, DVec3::ZERO);
        for k in 0..K {
            by_u += self.points[k][last] - self.points[k][0];
            by_v += self.points[last][k] - self.points[0][k];
        }
        let (by_u, by_v) = (by_u / K as f64, by_v / K as f64);
        let normal = by_u.cross(by_v);
        let size = normal.length().sqrt();
        let normal = normal / size;
        let inverse = DMat3::from_cols(by_u, by_v, normal).inverse();
        let columns = [inverse.x_axis, inverse.y_axis, inverse.z_axis];
        let size = by_u.length().max(by_v.length());
        if columns.iter().all(|c| c.length() * size < MOST_STRETCHED) {
            return columns;
        }
        // Nearly a line or a point: along the axes, of the size of the piece.
        let all = Aabb::from_points(self.points.as_flattened().iter().copied());
        let size = all.size().max_element();
        let per = if size > self.noise { 1.0 / size } else { 1.0 };
        DVec3::AXES.map(|axis| axis * per)
    }

    /// The piece as a leaf.
    fn leaf(&self) -> (Leaf, Bounds) {
        let columns = self.columns();
        // As they are stored, and so the frame is exact.
        let mut leaf = Leaf::new(columns, DVec3::ZERO);
        let (matrix, _) = leaf.map();
        let mut framed = self.points;
        for p in framed.as_flattened_mut() {
            *p = matrix * *p;
        }
        let (low, high) = extent(&framed);
        leaf = Leaf::new(columns, -0.5 * (low + high));
        let (_, offset) = leaf.map();
        for p in framed.as_flattened_mut() {
            *p += offset;
        }
        let bounds = self.bounds(&leaf, framed);
        leaf.set_bounds(&bounds);
        (leaf, bounds)
    }

    /// What is known of the piece in the frame of a leaf, where its points are these.
    fn bounds(&self, leaf: &Leaf, mut framed: [[DVec3; K]; K]) -> Bounds {
        let (matrix, offset) = leaf.map();
        let (low, high) = extent(&framed);
        let sums = matrix.x_axis.abs() + matrix.y_axis.abs() + matrix.z_axis.abs();
        let noise = (sums + offset.abs()) * (self.noise + gamma(16));
        let beyond = (high - low) * (K as f64 * OVERLAP) + noise;
        let reach = low.abs().max(high.abs()) + beyond;
        let side = reach.x.max(reach.y);
        let mut bounds = Bounds {
            side,
            height: reach.z,
            bend: f64::INFINITY,
            tilt: f64::INFINITY,
        };
        let uneven = self.uneven();
        if !(side < 1.0 && uneven.weight < UNEVEN) {
            return bounds;
        }
        // The derivatives of the numerators, which are points times weights in the frame.
        let (mut off_u, mut off_v) = (DVec3::ZERO, DVec3::ZERO);
        let degree = (K - 1) as f64;
        let weights = self.weights.as_flattened();
        for (p, w) in framed.as_flattened_mut().iter_mut().zip(weights) {
            *p *= *w;
        }
        let at = |j: usize, i: usize| framed[j][i];
        for a in 0..K {
            for b in 1..K {
                off_u = off_u.max(((at(a, b) - at(a, b - 1)) * degree - DVec3::X).abs());
                off_v = off_v.max(((at(b, a) - at(b - 1, a)) * degree - DVec3::Y).abs());
            }
        }
        // Those of the points differ from these by what the weights differ from 1 and change, as points are within the unit square.
        let off = off_u + off_v + noise;
        let least = 1.0 - uneven.weight;
        let along = off.x.max(off.y) + uneven.weight + uneven.slope;
        bounds.bend = along / least;
        bounds.tilt = (off.z + reach.z * uneven.slope) / least;
        bounds
    }

    /// How much weights differ from that in the middle, and the sum of how fast they change by both parameters.
    fn uneven(&self) -> Uneven {
        let all = self.weights.as_flattened().iter();
        if all.clone().all(|w| *w == 1.0) {
            return Uneven {
                weight: 0.0,
                slope: 0.0,
            };
        }
        let weight = all.fold(0.0, |most: f64, w| most.max((w - 1.0).abs()));
        let rates = Rates::of(&self.weights, |w| w.abs());
        let slope = rates.u + rates.v;
        Uneven { weight, slope }
    }

    /// How curved the piece is, which is over a square, by the parameters of the patch.
    fn curving_of(&self, square: Square) -> Curving<f32> {
        let per_side = f64::from(1_u32 << square.level);
        self.curving().times(per_side * per_side)
    }

    /// How curved the piece is, by its own parameters.
    fn curving(&self) -> Curving {
        let all = self.points.as_flattened().iter().copied();
        let center = Aabb::from_points(all).center();
        let (mut points, mut reach, mut least) = (self.points, 0.0_f64, f64::INFINITY);
        for (p, w) in points
            .as_flattened_mut()
            .iter_mut()
            .zip(self.weights.as_flattened())
        {
            *p -= center;
            reach = reach.max(p.length());
            least = least.min(*w);
            *p *= *w;
        }
        let p = Rates::of(&points, |p| p.length());
        let w = Rates::of(&self.weights, |w| w.abs());
        // Of a quotient, from the derivatives of its numerator and of the weight.
        let (u, v) = ((p.u + reach * w.u) / least, (p.v + reach * w.v) / least);
        let noise = self.noise * (4 * K * K) as f64;
        Curving {
            uu: (p.uu + 2.0 * u * w.u + reach * w.uu + noise) / least,
            uv: (p.uv + u * w.v + v * w.u + reach * w.uv + noise) / least,
            vv: (p.vv + 2.0 * v * w.v + reach * w.vv + noise) / least,
        }
    }
}

/// The largest derivatives, of the first and the second order, that a polynomial may have.
struct Rates {
    u: f64,
    v: f64,
    uu: f64,
    uv: f64,
    vv: f64,
}

impl Rates {
    fn of<T, const K: usize>(c: &[[T; K]; K], size: impl Fn(T) -> f64) -> Self
    where
        T: Copy + std::ops::Sub<Output = T>,
    {
        let (once, twice) = ((K - 1) as f64, ((K - 1) * (K - 2)) as f64);
        let mut most = Self {
            u: 0.0,
            v: 0.0,
            uu: 0.0,
            uv: 0.0,
            vv: 0.0,
        };
        let step_u = |j: usize, i: usize| c[j][i] - c[j][i - 1];
        let step_v = |j: usize, i: usize| c[j][i] - c[j - 1][i];
        for a in 0..K {
            for b in 1..K {
                most.u = most.u.max(once * size(step_u(a, b)));
                most.v = most.v.max(once * size(step_v(b, a)));
                if b > 1 {
                    let (uu, vv) = (
                        step_u(a, b) - step_u(a, b - 1),
                        step_v(b, a) - step_v(b - 1, a),
                    );
                    most.uu = most.uu.max(twice * size(uu));
                    most.vv = most.vv.max(twice * size(vv));
                }
                if a > 0 {
                    let uv = step_u(a, b) - step_u(a - 1, b);
                    most.uv = most.uv.max(once * once * size(uv));
                }
            }
        }
        most
    }
}

/// The least and the greatest coordinates of points.
fn extent<const K: usize>(points: &[[DVec3; K]; K]) -> (DVec3, DVec3) {
    let Aabb { min, max } = Aabb::EMPTY;
    let (mut low, mut high) = (min, max);
    for p in points.as_flattened() {
        (low, high) = (low.min(*p), high.max(*p));
    }
    (low, high)
}

/// See [`Piece::uneven`].
struct Uneven {
    weight: f64,
    slope: f64,
}
