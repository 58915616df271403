use super::{LANES, dot};
use crate::{PlaneHit, Polygon};
use strahl_math::error::gamma;
use strahl_math::{Interval, Ray};
use strahl_simd::Isa;

/// The parameters at which a ray crosses the planes of four polygons.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlaneHits {
    t: [f64; LANES],
    error: [f64; LANES],
}

impl PlaneHits {
    /// The crossing of the plane of a lane.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> PlaneHit {
        PlaneHit {
            t: self.t[lane],
            error: self.error[lane],
        }
    }
}

/// Up to four polygons, or other primitives beside them. This is not their own test, but one that culls the polygons which a
/// ray certainly misses, which are most.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct PolygonBlock {
    /// Per axis the unit normals of the fronts of all lanes.
    normal: [[f64; LANES]; 3],
    /// Per axis a corner of each.
    corner: [[f64; LANES]; 3],
    /// Per axis the lower ends of the boxes.
    low: [[f64; LANES]; 3],
    /// Per axis the upper ends of the boxes.
    high: [[f64; LANES]; 3],
    /// The largest distances of corners from the planes.
    deviation: [f64; LANES],
    /// The largest sum of absolute coordinates.
    reach: [f64; LANES],
    /// The one-sided lanes, as bits.
    one_sided: u32,
    /// The lanes with primitives other than polygons, which are never culled.
    others: u32,
}

impl PolygonBlock {
    /// No polygons.
    pub const EMPTY: Self = Self {
        // Edge-on to every ray.
        normal: [[0.0; LANES]; 3],
        corner: [[0.0; LANES]; 3],
        low: [[0.0; LANES]; 3],
        high: [[0.0; LANES]; 3],
        deviation: [0.0; LANES],
        reach: [0.0; LANES],
        one_sided: 0,
        others: 0,
    };

    /// Puts a polygon into a lane.
    pub fn set(&mut self, lane: usize, polygon: &Polygon, one_sided: bool) {
        let facts = polygon.plane();
        for axis in 0..3 {
            self.normal[axis][lane] = facts.normal[axis];
            self.corner[axis][lane] = facts.corner[axis];
            self.low[axis][lane] = facts.bounds.min[axis];
            self.high[axis][lane] = facts.bounds.max[axis];
        }
        self.deviation[lane] = facts.deviation;
        self.reach[lane] = facts.reach;
        self.one_sided |= u32::from(one_sided) << lane;
    }

    /// Puts another primitive into a lane, which is never culled.
    pub fn set_other(&mut self, lane: usize) {
        self.others |= 1 << lane;
    }

    /// Whether a lane has a polygon.
    #[inline(always)]
    pub fn is_polygon(&self, lane: usize) -> bool {
        self.others >> lane & 1 == 0
    }

    /// The lanes that the ray may hit in a range, as bits, with the crossings of their planes. [`Polygon`]'s own test certainly
    /// misses all others.
    ///
    /// That test computes t, and its error e, with the same operations. The point at t differs from the one of the polygon that
    /// the ray hits by no more than e times the speed of the ray, in each coordinate; twice that covers the rounding here.
    #[inline(always)]
    pub fn may_hit<I: Isa>(&self, isa: I, ray: &Ray, range: Interval, at: &mut PlaneHits) -> u32 {
        let (o, d) = (ray.origin, ray.direction);
        let direction = [isa.splat(d.x), isa.splat(d.y), isa.splat(d.z)];
        let origin = [isa.splat(o.x), isa.splat(o.y), isa.splat(o.z)];
        let normal = [
            isa.load(&self.normal[0]),
            isa.load(&self.normal[1]),
            isa.load(&self.normal[2]),
        ];
        let way = [
            isa.sub(isa.load(&self.corner[0]), origin[0]),
            isa.sub(isa.load(&self.corner[1]), origin[1]),
            isa.sub(isa.load(&self.corner[2]), origin[2]),
        ];
        let along = dot(isa, normal, direction);
        let t = isa.div(dot(isa, normal, way), along);
        let back = self.one_sided & !isa.lt(along, isa.splat(0.0));
        let mut left = isa.lt(isa.abs(t), isa.splat(f64::INFINITY)) & !back;
        if left == 0 {
            return self.others;
        }
        let speed = isa.splat(d.x.abs() + d.y.abs() + d.z.abs());
        let far = isa.splat(o.x.abs() + o.y.abs() + o.z.abs());
        let reach = isa.add(
            isa.add(far, isa.mul(isa.abs(t), speed)),
            isa.load(&self.reach),
        );
        let off = isa.add(
            isa.load(&self.deviation),
            isa.mul(isa.splat(gamma(64)), reach),
        );
        let e = isa.div(off, isa.abs(along));
        // NaN is kept.
        left &= !isa.lt(isa.add(t, e), isa.splat(range.min));
        left &= !isa.lt(isa.splat(range.max), isa.sub(t, e));
        let slack = isa.mul(isa.mul(e, speed), isa.splat(2.0));
        let x = isa.add(origin[0], isa.mul(direction[0], t));
        left &= !isa.lt(isa.add(x, slack), isa.load(&self.low[0]));
        left &= !isa.lt(isa.load(&self.high[0]), isa.sub(x, slack));
        let y = isa.add(origin[1], isa.mul(direction[1], t));
        left &= !isa.lt(isa.add(y, slack), isa.load(&self.low[1]));
        left &= !isa.lt(isa.load(&self.high[1]), isa.sub(y, slack));
        let z = isa.add(origin[2], isa.mul(direction[2], t));
        left &= !isa.lt(isa.add(z, slack), isa.load(&self.low[2]));
        left &= !isa.lt(isa.load(&self.high[2]), isa.sub(z, slack));
        if left != 0 {
            at.t = isa.store(t);
            at.error = isa.store(e);
        }
        left | self.others
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Primitive, Scratch};
    use strahl_math::DVec3;
    use strahl_simd::{Simd, dispatch};

    #[test]
    fn no_polygon_that_a_ray_meets_is_left_out() {
        let mut state = 5u64;
        let mut signed = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let (mut met, mut out) = (0, 0);
        for round in 0..20_000 {
            let mut point = || DVec3::new(signed(), signed(), signed());
            let (scale, size) = (
                [1.0, 1e6, 1e-9, 1.0][round % 4],
                [1.0, 0.01, 1e3][round % 3],
            );
            let (place, a, b) = (point(), point() * size, point() * size);
            // Some lie in a plane of two axes.
            let (a, b) = match round % 5 {
                0 => (DVec3::new(a.x, 0.0, a.z), DVec3::new(b.x, 0.0, b.z)),
                _ => (a, b),
            };
            let corners = [place, place + a, place + a + b, place + b].map(|p| p * scale);
            let Ok(polygon) = Polygon::try_new(&corners[..3 + round % 2]) else {
                continue;
            };
            // Through the middle, edges and corners, and just beside; towards it or nearly along its plane.
            let target = corners[0] + (a * [0.3, 0.0, 0.5, 1.0][round / 2 % 4] + b * 0.5) * scale;
            let beside = point() * scale * [0.0, 1e-15, 1e-7, 0.5][round / 8 % 4];
            let along = point() * [1.0, 1e-3, 1e-9, 0.0][round / 32 % 4];
            let direction = (a * 0.7 - b * 0.2 + along * size) * scale;
            let ray = Ray::new(target + beside - direction * 1.5, direction);
            let one_sided = round % 7 == 0;
            let mut block = PolygonBlock::EMPTY;
            block.set(round % LANES, &polygon, one_sided);
            block.set_other((round + 1) % LANES);
            let range = [Interval::FORWARD, Interval::LINE, Interval::new(0.5, 1.5)][round % 3];
            let hit = polygon.closest_hit(&ray, range, None, &mut Scratch::default());
            let front = polygon.normal().dot(ray.direction) < 0.0;
            for simd in Simd::available() {
                let mut at = PlaneHits::default();
                let left = dispatch!(simd, isa => block.may_hit(isa, &ray, range, &mut at));
                assert_eq!(left & !(1 << (round % LANES)), 1 << ((round + 1) % LANES));
                let is_left = left >> (round % LANES) & 1 == 1;
                if one_sided && !front {
                    assert!(!is_left);
                } else {
                    let found =
                        is_left.then(|| polygon.hit_in_plane(&ray, range, at.lane(round % LANES)));
                    assert_eq!(found.flatten(), hit.map(|h| h.t), "{round}");
                }
                met += u32::from(hit.is_some());
                out += u32::from(!is_left);
            }
        }
        assert!(met > 5_000 && out > 5_000, "{met} met, {out} left out");
    }
}
