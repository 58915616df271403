//! Culls the rays of a packet against a block: sixteen rays at once, in f32. The block's own test decides for each ray that is
//! left.
//!
//! u is 2⁻²⁴ here, B the largest coordinate of the primitives, M = B + |o| with the largest origin of the packet.

use super::{Coordinate, LANES, SphereBlock, TriangleBlock};
use crate::RayShear;
use crate::mesh::Axis;
use strahl_accel::PACKET;
use strahl_math::Ray;
use strahl_simd::{Isa, Lanes16};

/// Half a unit in the last place of f32 numbers near 1.
const U: f64 = 1.0 / (1u64 << 24) as f64;

/// The shears of the rays of a packet, side by side, for triangles.
///
/// The image of a corner is `x - s_x z - (o_x - s_x o_z)`, with slopes of at most 1: rounding the corner (u|x|, u|z|), the slope (u|z|),
/// the constant (2uM) and both operations (3uM) makes an error of at most δ = 12uM.
#[derive(Clone, Copy, Debug)]
pub struct PacketShears {
    axes: [Axis; 3],
    slope: [Lanes16; 2],
    /// The image of the origin.
    start: [Lanes16; 2],
    /// 8δ.
    margin: f32,
}

/// Corners in the picture of each ray.
struct Images<I: Isa> {
    x: I::F32x16,
    y: I::F32x16,
}

impl PacketShears {
    /// Those of at most [`PACKET`] rays among primitives with coordinates of up to `max_abs`; `None` if their main directions
    /// differ.
    pub fn new(shears: &[RayShear], max_abs: f64) -> Option<Self> {
        let axes = shears.first()?.axes();
        let mut all = Self {
            axes,
            slope: [Lanes16([0.0; PACKET]); 2],
            start: [Lanes16([0.0; PACKET]); 2],
            margin: 0.0,
        };
        let mut farthest = 0.0;
        for (lane, shear) in shears.iter().enumerate().take(PACKET) {
            if shear.axes()[2] != axes[2] {
                return None;
            }
            let (o, s) = (shear.origin(), shear.slope());
            for k in 0..2 {
                all.slope[k].0[lane] = s[k] as f32;
                all.start[k].0[lane] = (o[k] - s[k] * o[2]) as f32;
            }
            let distance = o[0].abs() + o[1].abs() + o[2].abs();
            // NaN is kept.
            farthest = if distance <= farthest {
                farthest
            } else {
                distance
            };
        }
        all.margin = (8.0 * 12.0 * U * (max_abs + farthest)) as f32;
        Some(all)
    }

    /// The image of one corner of a triangle in all rays.
    #[inline(always)]
    fn image<I: Isa, T: Coordinate>(
        &self,
        isa: I,
        corner: &[[T; LANES]; 3],
        triangle: usize,
    ) -> Images<I> {
        let [i, j, k] = self.axes;
        let along = |axis: Axis| {
            let x: f64 = corner[axis as usize][triangle].into();
            x as f32
        };
        let (x, y, z) = (
            isa.splat_f32x16(along(i)),
            isa.splat_f32x16(along(j)),
            isa.splat_f32x16(along(k)),
        );
        let shift = isa.mul_add_f32x16(
            isa.load_f32x16(&self.slope[0]),
            z,
            isa.load_f32x16(&self.start[0]),
        );
        let x = isa.sub_f32x16(x, shift);
        let shift = isa.mul_add_f32x16(
            isa.load_f32x16(&self.slope[1]),
            z,
            isa.load_f32x16(&self.start[1]),
        );
        Images {
            x,
            y: isa.sub_f32x16(y, shift),
        }
    }
}

/// Twice the area of a triangle with a corner at the ray.
#[inline(always)]
fn edge<I: Isa>(isa: I, p: &Images<I>, q: &Images<I>) -> I::F32x16 {
    isa.mul_sub_f32x16(p.x, q.y, isa.mul_f32x16(p.y, q.x))
}

/// The larger coordinate of two corners' images.
#[inline(always)]
fn reach<I: Isa>(isa: I, p: &Images<I>) -> I::F32x16 {
    isa.max_f32x16(isa.abs_f32x16(p.x), isa.abs_f32x16(p.y))
}

impl<T: Coordinate> TriangleBlock<T> {
    /// The rays that may hit one of the first `used` triangles, as bits; all others certainly miss them.
    ///
    /// With R the largest coordinate of the three images, or δ if that is larger, an edge function is wrong by at most 4δR + 2δ² for the
    /// images and 3uR² for its own rounding, less than `(8δ + 8uR) R`. A ray is out if one edge function is certainly positive and
    /// another certainly negative. NaN is never culled.
    #[inline(always)]
    pub fn may_hit<I: Isa>(&self, isa: I, rays: &PacketShears, used: usize) -> u32 {
        let mut met = 0;
        let (margin, zero) = (isa.splat_f32x16(rays.margin), isa.splat_f32x16(0.0));
        let least = isa.splat_f32x16(rays.margin * 0.125);
        let (rounding, tiny) = (
            isa.splat_f32x16((8.0 * U) as f32),
            isa.splat_f32x16(f32::MIN_POSITIVE),
        );
        for triangle in 0..used.min(LANES) {
            let [a, b, c] = &self.corners;
            let a = rays.image(isa, a, triangle);
            let b = rays.image(isa, b, triangle);
            let c = rays.image(isa, c, triangle);
            let (u, v, w) = (edge(isa, &b, &c), edge(isa, &c, &a), edge(isa, &a, &b));
            let (ra, rb, rc) = (reach(isa, &a), reach(isa, &b), reach(isa, &c));
            let r = isa.max_f32x16(isa.max_f32x16(ra, rb), isa.max_f32x16(rc, least));
            let e = isa.mul_add_f32x16(isa.mul_add_f32x16(r, rounding, margin), r, tiny);
            let low = isa.min_f32x16(isa.min_f32x16(u, v), w);
            let high = isa.max_f32x16(isa.max_f32x16(u, v), w);
            let out = isa.lt_f32x16(low, isa.sub_f32x16(zero, e)) & isa.lt_f32x16(e, high);
            met |= !out;
        }
        met
    }
}

/// The lines of the rays of a packet, side by side, for spheres.
///
/// With f the way from the centre to the origin, each coordinate rounded by 3uM, the nearest point of the line is at f - (f·d / d²) d. Its
/// coordinates are wrong by at most δ = 64uM: |f| is at most √3 M, and d, 1/d², the sum and the products are rounded by 10u together.
#[derive(Clone, Copy, Debug)]
pub struct PacketLines {
    origin: [Lanes16; 3],
    direction: [Lanes16; 3],
    /// 1/d².
    inverse: Lanes16,
    /// √3 δ.
    margin: f64,
}

impl PacketLines {
    /// Those of at most [`PACKET`] rays among primitives with coordinates of up to `max_abs`.
    pub fn new(rays: &[Ray], max_abs: f64) -> Self {
        let nothing = Lanes16([0.0; PACKET]);
        let mut all = Self {
            origin: [nothing; 3],
            direction: [nothing; 3],
            inverse: nothing,
            margin: 0.0,
        };
        let mut farthest = 0.0;
        let mut squares = [1.0; PACKET];
        for (lane, ray) in rays.iter().enumerate().take(PACKET) {
            let d = ray.direction;
            for axis in 0..3 {
                all.origin[axis].0[lane] = ray.origin[axis] as f32;
                all.direction[axis].0[lane] = d[axis] as f32;
            }
            squares[lane] = d.dot(d);
            let distance = ray.origin.abs().element_sum();
            // NaN is kept.
            farthest = if distance <= farthest {
                farthest
            } else {
                distance
            };
        }
        // By themselves, as vectors.
        all.inverse = Lanes16(squares.map(|square| (1.0 / square) as f32));
        all.margin = 2.0 * 64.0 * U * (max_abs + farthest);
        all
    }
}

impl SphereBlock {
    /// The rays whose lines may hit one of the first `used` spheres, as bits; all others certainly miss them. NaN is never
    /// culled.
    #[inline(always)]
    pub fn may_hit<I: Isa>(&self, isa: I, rays: &PacketLines, used: usize) -> u32 {
        let mut met = 0;
        let [dx, dy, dz] = [
            isa.load_f32x16(&rays.direction[0]),
            isa.load_f32x16(&rays.direction[1]),
            isa.load_f32x16(&rays.direction[2]),
        ];
        for sphere in 0..used.min(LANES) {
            let [cx, cy, cz] = [
                isa.splat_f32x16(self.center[0][sphere] as f32),
                isa.splat_f32x16(self.center[1][sphere] as f32),
                isa.splat_f32x16(self.center[2][sphere] as f32),
            ];
            let x = isa.sub_f32x16(isa.load_f32x16(&rays.origin[0]), cx);
            let y = isa.sub_f32x16(isa.load_f32x16(&rays.origin[1]), cy);
            let z = isa.sub_f32x16(isa.load_f32x16(&rays.origin[2]), cz);
            let along = isa.mul_f32x16(x, dx);
            let along = isa.mul_add_f32x16(y, dy, along);
            let along = isa.mul_add_f32x16(z, dz, along);
            let along = isa.mul_f32x16(along, isa.load_f32x16(&rays.inverse));
            // The signs of the differences do not matter.
            let x = isa.mul_sub_f32x16(along, dx, x);
            let y = isa.mul_sub_f32x16(along, dy, y);
            let z = isa.mul_sub_f32x16(along, dz, z);
            let square = isa.mul_f32x16(x, x);
            let square = isa.mul_add_f32x16(y, y, square);
            let square = isa.mul_add_f32x16(z, z, square);
            // The sum of the squares is rounded by 4u.
            let reach = self.radius[sphere] + rays.margin;
            let limit = reach * reach * (1.0 + 16.0 * U) + f64::from(f32::MIN_POSITIVE);
            met |= !isa.lt_f32x16(isa.splat_f32x16(limit as f32), square);
        }
        met
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Sphere;
    use crate::blocks::Hits;
    use strahl_math::{DVec3, Interval};
    use strahl_simd::{Simd, dispatch};

    /// Numbers in -1..1.
    struct Signed(u64);

    impl Signed {
        fn next(&mut self) -> f64 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }

        fn point(&mut self) -> DVec3 {
            DVec3::new(self.next(), self.next(), self.next())
        }
    }

    /// Sixteen rays close to each other, towards the targets or just beside them.
    fn rays(random: &mut Signed, targets: &[DVec3], scale: f64) -> Vec<Ray> {
        let eye = random.point() * scale * 3.0;
        (0..PACKET)
            .map(|lane| {
                let beside = random.point() * scale * [0.0, 1e-7, 1e-3][lane % 3];
                let target = targets[lane % targets.len()] + beside;
                Ray::new(eye + random.point() * scale * 0.1, (target - eye) * 0.7)
            })
            .collect()
    }

    #[test]
    fn no_ray_that_hits_a_triangle_is_left_out() {
        let mut random = Signed(3);
        let (mut hits, mut out) = (0, 0);
        for round in 0..6000 {
            let scale = [1.0, 1e-30, 1e6, 1e18, 1e25][round % 5];
            let size = [1.0, 0.01, 1e-4][round / 5 % 3];
            let place = random.point();
            let corners: [[DVec3; 3]; LANES] = std::array::from_fn(|_| {
                std::array::from_fn(|_| {
                    let p = (place + random.point() * size) * scale;
                    p.as_vec3().as_dvec3()
                })
            });
            let mut block = TriangleBlock::<f32>::EMPTY;
            for (lane, t) in corners.iter().enumerate().skip(1) {
                block.set(lane - 1, t.map(|p| p.as_vec3().to_array()));
            }
            let [a, b, c] = corners[1];
            let rays = rays(&mut random, &[a, (a + b) / 2.0, (a + b + c) / 3.0], scale);
            let shears: Vec<RayShear> = rays.iter().map(RayShear::new).collect();
            let Some(culls) = PacketShears::new(&shears, scale * 2.0) else {
                continue;
            };
            for simd in Simd::available() {
                let met = dispatch!(simd, isa => block.may_hit(isa, &culls, LANES - 1));
                for (lane, shear) in shears.iter().enumerate() {
                    let found = dispatch!(simd, isa =>
                        block.hits(isa, shear, Interval::LINE, &mut Hits::default()));
                    assert!(found == 0 || met >> lane & 1 == 1, "{round} {lane}");
                    hits += u32::from(found != 0);
                    out += u32::from(met >> lane & 1 == 0);
                }
            }
        }
        let levels = Simd::available().len() as u32;
        assert!(
            hits > 12_000 * levels && out > 5_000 * levels,
            "{hits} hits, {out} out at {levels} levels"
        );
    }

    #[test]
    fn no_ray_that_hits_a_sphere_is_left_out() {
        let mut random = Signed(4);
        let (mut hits, mut out) = (0, 0);
        for round in 0..6000 {
            let scale = [1.0, 1e-12, 1e6, 1e15][round % 4];
            let size = [1.0, 0.01, 1e-4][round / 4 % 3] * scale;
            let mut block = SphereBlock::EMPTY;
            let mut targets = vec![];
            for lane in 0..LANES - 1 {
                let (center, radius) = (random.point() * scale, size * random.next().abs());
                block.set(lane, &Sphere::new(center, radius));
                // At the rim, where the line touches.
                targets.push(center + random.point().normalize() * radius);
            }
            let rays = rays(&mut random, &targets, scale);
            let culls = PacketLines::new(&rays, scale * 3.0);
            for simd in Simd::available() {
                let met = dispatch!(simd, isa => block.may_hit(isa, &culls, LANES - 1));
                for (lane, ray) in rays.iter().enumerate() {
                    let found = dispatch!(simd, isa =>
                        block.hits(isa, ray, Interval::LINE, &mut Hits::default()));
                    assert!(found == 0 || met >> lane & 1 == 1, "{round} {lane}");
                    hits += u32::from(found != 0);
                    out += u32::from(met >> lane & 1 == 0);
                }
            }
        }
        assert!(hits > 50_000 && out > 20_000, "{hits} hits, {out} out");
    }
}
