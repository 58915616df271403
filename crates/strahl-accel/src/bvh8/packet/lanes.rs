//! The constants of the rays of a packet side by side, and the test of one child of a node against all of them.

use super::OCTANTS;
use super::hull::Hull;
use crate::bvh8::node::Node;
use crate::bvh8::traverse::Slabs;
use crate::cull::{CullBounds, CullClock, CullLanes, LONGEST_QUICK, MOST_RECIPROCAL, QUICK_SLACK};
use crate::packet::{PACKET, Packet, lanes_of};
use strahl_math::{Interval, Ray};
use strahl_simd::{Isa, Lanes16};

/// All lanes, as bits.
const ALL: u32 = (1 << PACKET) - 1;

/// The constants of the culling test by lane.
pub(super) struct Lanes {
    rd: [Lanes16; 3],
    minus_near: [Lanes16; 3],
    minus_far: [Lanes16; 3],
    t_min: Lanes16,
    /// The upper ends of the ranges.
    far: Lanes16,
    pub(super) clocks: [CullClock; PACKET],
}

/// Rays that [`Lanes::fill`] has made constants for.
pub(super) enum Filled<I: Isa> {
    /// All go in the octant with this number, and have this hull.
    Alike(Hull, usize),
    /// They go in several octants; [`Lanes::hulls`] finds the hull of each.
    Mixed(Directions<I>),
}

/// The octants of rays, and what is needed for their hulls.
pub(super) struct Directions<I: Isa> {
    /// Per axis the rays that go down, as bits.
    down: [u32; 3],
    /// Per axis the least and the greatest summand for planes relative to the hull's point.
    shift: [[I::F32x16; 2]; 3],
}

/// The factor 20u of the error bound of constants relative to a point.
const RELATIVE_SLACK: f64 = 20.0 / (1u64 << 24) as f64;

impl Lanes {
    /// The constants of no rays.
    #[inline(always)]
    pub(super) fn unused() -> Self {
        let nothing = Lanes16([0.0; PACKET]);
        Self {
            rd: [nothing; 3],
            minus_near: [nothing; 3],
            minus_far: [nothing; 3],
            t_min: nothing,
            far: Lanes16([f32::NEG_INFINITY; PACKET]),
            clocks: [CullClock::UNUSED; PACKET],
        }
    }

    /// Computes the constants of all rays at once, side by side in f32; `None` if a ray is not ordinary, as [`crate::cull::QuickLanes`] has it.
    ///
    /// They are those of [`crate::cull::QuickLanes`], where the error bound is derived. Planes relative to a point f are crossed at
    /// `(b - f) r + (f - o) r`. In units of u|r| rounding changes the first product by at most 5|b - f| with what the loop adds, the second by
    /// 6|f - o| and, for o, |o|: together by less than 5B + 7|o| + 11|f|, for which 20(B + |o| + |f|) has room.
    #[inline(always)]
    pub(super) fn fill<I: Isa>(
        &mut self,
        isa: I,
        packet: &Packet<'_>,
        bounds: &CullBounds,
        point: [f32; 3],
    ) -> Option<Filled<I>> {
        let first = packet.rays.get(packet.alive().trailing_zeros() as usize)?;
        let nothing = Lanes16([0.0; PACKET]);
        let (mut origins, mut directions) = ([nothing; 3], [nothing; 3]);
        self.narrow(packet, first, &mut origins, &mut directions);
        if !are_ordinary(isa, &origins, &directions, bounds.near()) {
            return None;
        }
        let (zero, one) = (isa.splat_f32x16(0.0), isa.splat_f32x16(1.0));
        let most = isa.splat_f32x16(MOST_RECIPROCAL as f32);
        let least = isa.sub_f32x16(zero, most);
        let slack = isa.splat_f32x16(QUICK_SLACK as f32);
        let relative_slack = isa.splat_f32x16(RELATIVE_SLACK as f32);
        let margin = isa.splat_f32x16(bounds.margin());
        let t_min = CullClock::UNUSED.t_min(packet.min);
        let mut hull = Hull {
            t_min,
            ..Hull::NOTHING
        };
        let (mut down, mut shift) = ([0; 3], [[zero; 2]; 3]);
        for axis in 0..3 {
            let o = isa.load_f32x16(&origins[axis]);
            let r = isa.div_f32x16(one, isa.load_f32x16(&directions[axis]));
            let r = isa.max_f32x16(isa.min_f32x16(r, most), least);
            down[axis] = isa.lt_f32x16(r, zero);
            let (size, distance) = (isa.abs_f32x16(r), isa.abs_f32x16(o));
            let reach = isa.mul_add_f32x16(distance, slack, margin);
            let e = isa.mul_f32x16(size, reach);
            let minus_o = isa.sub_f32x16(zero, o);
            self.rd[axis] = isa.store_f32x16(r);
            self.minus_near[axis] = isa.store_f32x16(isa.mul_sub_f32x16(minus_o, r, e));
            self.minus_far[axis] = isa.store_f32x16(isa.mul_add_f32x16(minus_o, r, e));
            let f = point[axis];
            let rest = RELATIVE_SLACK * (bounds.max_abs() + f64::from(f.abs()));
            let reach = isa.mul_add_f32x16(distance, relative_slack, isa.splat_f32x16(rest as f32));
            let e = isa.mul_f32x16(size, reach);
            let way = isa.sub_f32x16(isa.splat_f32x16(f), o);
            shift[axis] = [isa.mul_sub_f32x16(way, r, e), isa.mul_add_f32x16(way, r, e)];
            hull.rd[axis] = [isa.smallest_f32x16(r), isa.largest_f32x16(r)];
            hull.shift[axis] = [
                isa.smallest_f32x16(shift[axis][0]),
                isa.largest_f32x16(shift[axis][1]),
            ];
        }
        self.t_min = Lanes16([t_min; PACKET]);
        if down.iter().all(|down| *down == 0 || *down == ALL) {
            let octant = (0..3).fold(0, |octant, axis| octant | (down[axis] as usize & 1) << axis);
            return Some(Filled::Alike(hull, octant));
        }
        Some(Filled::Mixed(Directions { down, shift }))
    }

    /// Sets the ends of the ranges of the rays, and their origins and directions by axis. Lanes without a ray repeat one, so that they don't change the hull.
    #[inline(always)]
    fn narrow(
        &mut self,
        packet: &Packet<'_>,
        first: &Ray,
        origins: &mut [Lanes16; 3],
        directions: &mut [Lanes16; 3],
    ) {
        for lane in 0..PACKET {
            let t_max = packet.t_max[lane];
            let ray = match packet.rays.get(lane) {
                Some(ray) if t_max > f64::NEG_INFINITY => {
                    self.far.0[lane] = CullClock::UNUSED.t_max(t_max);
                    ray
                }
                _ => first,
            };
            for axis in 0..3 {
                origins[axis].0[lane] = ray.origin[axis] as f32;
                directions[axis].0[lane] = ray.direction[axis] as f32;
            }
        }
    }

    /// By octant the hull of those of some rays that go in it, and these rays.
    #[inline(always)]
    pub(super) fn hulls<I: Isa>(
        &self,
        isa: I,
        directions: &Directions<I>,
        rays: u32,
    ) -> ([Hull; OCTANTS], [u32; OCTANTS]) {
        let mut hulls = [Hull::NOTHING; OCTANTS];
        let mut members = [0; OCTANTS];
        let [x, y, z] = directions
            .shift
            .map(|ends| ends.map(|end| isa.store_f32x16(end)));
        for lane in lanes_of(rays) {
            let octant = (0..3).fold(0, |octant, axis| {
                octant | (directions.down[axis] as usize >> lane & 1) << axis
            });
            let shift = [0, 1].map(|end| [x[end].0[lane], y[end].0[lane], z[end].0[lane], 0.0]);
            hulls[octant].grow(&of_lane(&self.rd, lane), &shift, self.t_min.0[lane]);
            members[octant] |= 1 << lane;
        }
        (hulls, members)
    }

    /// Sets the constants of a single ray of any kind.
    #[inline(always)]
    pub(super) fn set(
        &mut self,
        lane: usize,
        constants: &CullLanes,
        clock: CullClock,
        range: Interval,
    ) {
        for axis in 0..3 {
            self.rd[axis].0[lane] = constants.rd[axis];
            self.minus_near[axis].0[lane] = constants.minus_near[axis];
            self.minus_far[axis].0[lane] = constants.minus_far[axis];
        }
        self.t_min.0[lane] = clock.t_min(range.min);
        self.far.0[lane] = clock.t_max(range.max);
        self.clocks[lane] = clock;
    }

    /// The rays that may meet the box of a child.
    #[inline(always)]
    pub(super) fn enter<I: Isa>(
        &self,
        isa: I,
        node: &Node,
        child: usize,
        first: [usize; 3],
    ) -> u32 {
        let [x, y, z] = [
            self.crossed(isa, node, child, 0, first[0], &self.minus_near),
            self.crossed(isa, node, child, 1, 2 + first[1], &self.minus_near),
            self.crossed(isa, node, child, 2, 4 + first[2], &self.minus_near),
        ];
        let t_min = isa.load_f32x16(&self.t_min);
        let enter = isa.max_bits_x16(isa.max_bits_x16(x, y), isa.max_bits_x16(z, t_min));
        let [x, y, z] = [
            self.crossed(isa, node, child, 0, 1 - first[0], &self.minus_far),
            self.crossed(isa, node, child, 1, 3 - first[1], &self.minus_far),
            self.crossed(isa, node, child, 2, 5 - first[2], &self.minus_far),
        ];
        let far = isa.load_f32x16(&self.far);
        let leave = isa.min_bits_x16(isa.min_bits_x16(x, y), isa.min_bits_x16(z, far));
        isa.le_f32x16(enter, leave)
    }

    /// Where the rays cross a plane of a child.
    #[inline(always)]
    fn crossed<I: Isa>(
        &self,
        isa: I,
        node: &Node,
        child: usize,
        axis: usize,
        plane: usize,
        shift: &[Lanes16; 3],
    ) -> I::F32x16 {
        let plane = isa.splat_f32x16(node.planes[plane].0[child]);
        let rd = isa.load_f32x16(&self.rd[axis]);
        isa.mul_add_f32x16(plane, rd, isa.load_f32x16(&shift[axis]))
    }

    /// The constants of a single ray.
    #[inline(always)]
    pub(super) fn slabs<I: Isa>(&self, isa: I, lane: usize, octant: usize) -> Slabs<I> {
        let constants = CullLanes {
            rd: of_lane(&self.rd, lane),
            minus_near: of_lane(&self.minus_near, lane),
            minus_far: of_lane(&self.minus_far, lane),
            down: octant as u32,
        };
        Slabs::of(isa, &constants, self.t_min.0[lane])
    }

    /// Shortens the ray of a lane after a hit.
    #[inline(always)]
    pub(super) fn lower(&mut self, lane: usize, t_max: f64) {
        let far = if t_max == f64::NEG_INFINITY {
            f32::NEG_INFINITY
        } else {
            self.clocks[lane].t_max(t_max)
        };
        self.far.0[lane] = far;
    }

    /// The largest upper end of the ranges of some rays.
    #[inline(always)]
    pub(super) fn farthest(&self, lanes: u32) -> f32 {
        lanes_of(lanes).fold(f32::NEG_INFINITY, |most, lane| {
            let far = self.far.0[lane];
            if far > most { far } else { most }
        })
    }
}

/// The numbers of one lane.
#[inline(always)]
fn of_lane(axes: &[Lanes16; 3], lane: usize) -> [f32; 4] {
    [axes[0].0[lane], axes[1].0[lane], axes[2].0[lane], 0.0]
}

/// Whether all rays start near the structure and need no scale.
#[inline(always)]
fn are_ordinary<I: Isa>(
    isa: I,
    origins: &[Lanes16; 3],
    directions: &[Lanes16; 3],
    near: f32,
) -> bool {
    let near = isa.splat_f32x16(near);
    let (longest, shortest) = (
        isa.splat_f32x16(LONGEST_QUICK),
        isa.splat_f32x16(1.0 / LONGEST_QUICK),
    );
    let (mut usable, mut long) = (ALL, 0);
    for axis in 0..3 {
        let distance = isa.abs_f32x16(isa.load_f32x16(&origins[axis]));
        let length = isa.abs_f32x16(isa.load_f32x16(&directions[axis]));
        usable &= isa.le_f32x16(distance, near) & isa.le_f32x16(length, longest);
        long |= isa.le_f32x16(shortest, length);
    }
    usable & long == ALL
}
