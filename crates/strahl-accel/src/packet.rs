use crate::leaf::Leaf;
use strahl_math::Ray;
use strahl_simd::Isa;

/// The largest number of rays in a packet.
pub const PACKET: usize = 16;

/// Rays that are traversed together. It pays if they are close to each other: those of neighbouring pixels, or from
/// neighbouring points to one light.
#[derive(Debug)]
pub struct Packet<'r> {
    /// The rays, at most [`PACKET`]; a ray's number is its lane.
    pub rays: &'r [Ray],
    /// The lower end of all ranges: hits at or before it don't count.
    pub min: f64,
    /// By lane the upper end of the range, which the traversal lowers to what the visitor returns. Lanes with
    /// `f64::NEG_INFINITY` are not traced.
    pub t_max: [f64; PACKET],
}

impl Packet<'_> {
    /// The lanes that are traced, as bits.
    #[inline(always)]
    pub fn alive(&self) -> u32 {
        let mut alive = 0;
        for lane in 0..self.rays.len().min(PACKET) {
            alive |= u32::from(self.t_max[lane] > f64::NEG_INFINITY) << lane;
        }
        alive
    }
}

/// Tests the primitives that the rays of a packet may meet: a [`Visitor`](crate::Visitor) for several rays.
pub trait PacketVisitor {
    /// Whether the first hit of a ray ends its search; then children need not be sorted.
    const ANY: bool;

    /// Tests primitive `id` for the ray of a lane, and returns its new `t_max`, as [`Visitor::visit`](crate::Visitor::visit).
    fn visit(&mut self, id: u32, lane: usize, t_max: f64) -> f64;

    /// The same for several lanes, given as bits; `t_max` is changed accordingly. Lanes whose search has ended are left out.
    fn visit_together(&mut self, id: u32, lanes: u32, t_max: &mut [f64; PACKET]) {
        for lane in lanes_of(lanes) {
            if t_max[lane] > f64::NEG_INFINITY {
                t_max[lane] = self.visit(id, lane, t_max[lane]);
            }
        }
    }

    /// Tests all primitives of a leaf for the ray of a lane, as [`Visitor::visit_leaf`](crate::Visitor::visit_leaf).
    fn visit_leaf<I: Isa>(&mut self, isa: I, leaf: &Leaf<'_>, lane: usize, t_max: f64) -> f64;

    /// The same for several lanes, given as bits; `t_max` is changed accordingly.
    #[inline(always)]
    fn visit_leaf_together<I: Isa>(
        &mut self,
        isa: I,
        leaf: &Leaf<'_>,
        lanes: u32,
        t_max: &mut [f64; PACKET],
    ) {
        for lane in lanes_of(lanes) {
            t_max[lane] = self.visit_leaf(isa, leaf, lane, t_max[lane]);
        }
    }
}

/// The lanes of a bit mask, the lowest first.
#[inline(always)]
pub fn lanes_of(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(
        #[inline(always)]
        move || {
            let lane = bits.trailing_zeros() as usize;
            bits &= bits.wrapping_sub(1);
            (lane < PACKET).then_some(lane)
        },
    )
}
