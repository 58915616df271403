//! The hull of a packet: intervals that contain the constants of each ray, and the test of all children of a node against them.

use crate::bvh8::node::Node;
use crate::bvh8::traverse::sides;
use strahl_simd::Isa;

/// Bounds of the constants of all lanes.
#[derive(Clone, Copy)]
pub(super) struct Hull {
    pub(super) rd: [[f32; 2]; 3],
    /// The summand for planes relative to the hull's point.
    pub(super) shift: [[f32; 2]; 3],
    pub(super) t_min: f32,
}

impl Hull {
    pub(super) const NOTHING: Self = Self {
        rd: [[f32::INFINITY, f32::NEG_INFINITY]; 3],
        shift: [[f32::INFINITY, f32::NEG_INFINITY]; 3],
        t_min: f32::INFINITY,
    };

    #[inline(always)]
    pub(super) fn grow(&mut self, rd: &[f32; 4], shift: &[[f32; 4]; 2], t_min: f32) {
        for axis in 0..3 {
            grow(&mut self.rd[axis], rd[axis], rd[axis]);
            grow(&mut self.shift[axis], shift[0][axis], shift[1][axis]);
        }
        self.t_min = self.t_min.min(t_min);
    }
}

#[inline(always)]
fn grow(range: &mut [f32; 2], low: f32, high: f32) {
    range[0] = if low < range[0] { low } else { range[0] };
    range[1] = if high > range[1] { high } else { range[1] };
}

/// Both ends of a range in vectors.
#[inline(always)]
fn pair<I: Isa>(isa: I, [low, high]: [f32; 2]) -> [I::F32x8; 2] {
    [isa.splat_f32(low), isa.splat_f32(high)]
}

/// The constants of a hull in vectors.
pub(super) struct HullSlabs<I: Isa> {
    point: [I::F32x8; 3],
    rd: [[I::F32x8; 2]; 3],
    shift: [[I::F32x8; 2]; 3],
    t_min: I::F32x8,
    /// Per axis which of the two planes the rays cross first.
    pub(super) first: [usize; 3],
}

impl<I: Isa> HullSlabs<I> {
    #[inline(always)]
    pub(super) fn new(isa: I, hull: &Hull, point: [f32; 3], octant: usize) -> Self {
        let ([rx, ry, rz], [sx, sy, sz]) = (hull.rd, hull.shift);
        Self {
            point: [
                isa.splat_f32(point[0]),
                isa.splat_f32(point[1]),
                isa.splat_f32(point[2]),
            ],
            rd: [pair(isa, rx), pair(isa, ry), pair(isa, rz)],
            shift: [pair(isa, sx), pair(isa, sy), pair(isa, sz)],
            t_min: isa.splat_f32(hull.t_min),
            first: sides(octant as u32),
        }
    }

    /// A lower bound of the parameters at which rays cross the first planes of an axis.
    #[inline(always)]
    fn near(&self, isa: I, node: &Node, k: usize) -> I::F32x8 {
        let planes = isa.load_f32(&node.planes[2 * k + self.first[k]]);
        let q = isa.sub_f32(planes, self.point[k]);
        let [low, high] = self.rd[k];
        isa.min_f32(
            isa.mul_add(q, low, self.shift[k][0]),
            isa.mul_add(q, high, self.shift[k][0]),
        )
    }

    /// An upper bound of the parameters at which rays cross the last planes of an axis.
    #[inline(always)]
    fn far(&self, isa: I, node: &Node, k: usize) -> I::F32x8 {
        let planes = isa.load_f32(&node.planes[2 * k + 1 - self.first[k]]);
        let q = isa.sub_f32(planes, self.point[k]);
        let [low, high] = self.rd[k];
        isa.max_f32(
            isa.mul_add(q, low, self.shift[k][1]),
            isa.mul_add(q, high, self.shift[k][1]),
        )
    }

    /// A lower bound of the parameters at which rays enter the children's boxes, and the children that a ray may meet.
    #[inline(always)]
    pub(super) fn enter(&self, isa: I, node: &Node, farthest: f32) -> (I::F32x8, u32) {
        let (x, y, z) = (
            self.near(isa, node, 0),
            self.near(isa, node, 1),
            self.near(isa, node, 2),
        );
        let enter = isa.max_bits(isa.max_bits(x, y), isa.max_bits(z, self.t_min));
        let (x, y, z) = (
            self.far(isa, node, 0),
            self.far(isa, node, 1),
            self.far(isa, node, 2),
        );
        let farthest = isa.splat_f32(farthest);
        let leave = isa.min_bits(isa.min_bits(x, y), isa.min_bits(z, farthest));
        (enter, isa.le_f32(enter, leave))
    }
}
