use super::{Hits, LANES};
use crate::Sphere;
use strahl_math::{Interval, Ray};
use strahl_simd::Isa;

/// The scalar product, added up in the order of the scalar code.
#[inline(always)]
fn dot<I: Isa>(isa: I, p: [I::F64x4; 3], q: [I::F64x4; 3]) -> I::F64x4 {
    let xy = isa.add(isa.mul(p[0], q[0]), isa.mul(p[1], q[1]));
    isa.add(xy, isa.mul(p[2], q[2]))
}

/// Up to four spheres, tested as [`Sphere`] does.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct SphereBlock {
    /// Per axis the centres of all lanes.
    center: [[f64; LANES]; 3],
    /// The radii without their signs.
    radius: [f64; LANES],
}

impl SphereBlock {
    /// No spheres.
    pub const EMPTY: Self = Self {
        center: [[0.0; LANES]; 3],
        // A point: no line crosses it.
        radius: [0.0; LANES],
    };

    /// Puts a sphere into a lane.
    pub fn set(&mut self, lane: usize, sphere: &Sphere) {
        for (lanes, x) in self.center.iter_mut().zip(sphere.center().to_array()) {
            lanes[lane] = x;
        }
        self.radius[lane] = sphere.radius().abs();
    }

    /// Which spheres the ray may meet in a range if it starts on them, as bits, and which it meets if it starts elsewhere, and
    /// where for the first time: what [`Sphere`] finds, operation by operation. The former contain the latter.
    #[inline(always)]
    pub fn hits<I: Isa>(&self, isa: I, ray: &Ray, range: Interval, hits: &mut Hits) -> (u32, u32) {
        let [dx, dy, dz] = ray.direction.to_array();
        let d = [isa.splat(dx), isa.splat(dy), isa.splat(dz)];
        let f = [
            isa.sub(isa.splat(ray.origin.x), isa.load(&self.center[0])),
            isa.sub(isa.splat(ray.origin.y), isa.load(&self.center[1])),
            isa.sub(isa.splat(ray.origin.z), isa.load(&self.center[2])),
        ];
        let a = isa.splat(ray.direction.dot(ray.direction));
        let zero = isa.splat(0.0);
        // Signs change no rounding: `-(f·d)` is what `Sphere` has for b.
        let minus_b = dot(isa, f, d);
        let (r, square) = (isa.load(&self.radius), dot(isa, f, f));
        let r_square = isa.mul(r, r);
        let minus_closest_t = isa.div(minus_b, a);
        let closest = [
            isa.sub(f[0], isa.mul(d[0], minus_closest_t)),
            isa.sub(f[1], isa.mul(d[1], minus_closest_t)),
            isa.sub(f[2], isa.mul(d[2], minus_closest_t)),
        ];
        let discriminant = isa.mul(a, isa.sub(r_square, dot(isa, closest, closest)));
        let crossed = isa.lt(zero, discriminant);
        if crossed == 0 {
            return (0, 0);
        }
        let s = isa.sqrt(discriminant);
        let distance = isa.sqrt(square);
        let c = isa.mul(isa.sub(distance, r), isa.add(distance, r));
        let b = isa.sub(zero, minus_b);
        let q = isa.choose_le(zero, b, isa.add(b, s), isa.sub(b, s));
        let (one, other) = (isa.div(c, q), isa.div(q, a));
        let near = isa.choose_le(zero, b, one, other);
        let far = isa.choose_le(zero, b, other, one);
        let (min, max) = (isa.splat(range.min), isa.splat(range.max));
        let near_inside = isa.lt(min, near) & isa.le(near, max);
        let far_inside = isa.lt(min, far) & isa.le(far, max);
        let found = crossed & (near_inside | far_inside);
        if found != 0 {
            let (near, far) = (isa.store(near), isa.store(far));
            for lane in 0..LANES {
                let is_near = near_inside >> lane & 1 == 1;
                hits.t[lane] = if is_near { near[lane] } else { far[lane] };
            }
        }
        // From its surface a ray meets a sphere again only on the way in.
        let again = if range.min >= 0.0 {
            crossed & isa.lt(zero, b)
        } else {
            crossed
        };
        (again | found, found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Primitive, Scratch, SurfaceId};
    use strahl_math::DVec3;
    use strahl_simd::{Simd, dispatch};

    #[test]
    fn hits_are_those_of_the_single_test() {
        let mut state = 7u64;
        let mut signed = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let mut all = 0;
        for i in 0..20_000 {
            let mut point = || DVec3::new(signed(), signed(), signed());
            let spheres: [Sphere; LANES] = std::array::from_fn(|i| {
                let radius = point().x * [0.9, 1e-6, 1e3, 0.1][i];
                Sphere::new(point(), radius)
            });
            let mut block = SphereBlock::EMPTY;
            for (lane, s) in spheres.iter().enumerate().skip(1) {
                block.set(lane, s);
            }
            // At the rim of one of them, where the discriminant vanishes.
            let target = spheres[2].center() + point() * spheres[2].radius().abs();
            let origin = point() * 3.0;
            let ray = Ray::new(origin, (target - origin) * 0.7);
            let range = match i % 3 {
                0 => Interval::LINE,
                1 => Interval::FORWARD,
                _ => Interval::new(0.9, 1.5),
            };
            for simd in Simd::available() {
                let mut hits = Hits::default();
                let (again, found) =
                    dispatch!(simd, isa => block.hits(isa, &ray, range, &mut hits));
                assert_eq!(again & 1, 0, "the empty lane");
                assert_eq!(found & !again, 0);
                for (lane, s) in spheres.iter().enumerate().skip(1) {
                    let hit = |from| s.closest_hit(&ray, range, from, &mut Scratch::default());
                    let t = (found >> lane & 1 == 1).then_some(hits.t[lane]);
                    assert_eq!(t, hit(None).map(|h| h.t));
                    all += u32::from(t.is_some());
                    let (element, facet) = (0, 0);
                    let from = Some(SurfaceId { element, facet });
                    let everywhere = Interval::LINE;
                    let line = s.closest_hit(&ray, everywhere, None, &mut Scratch::default());
                    assert!(again >> lane & 1 == 1 || line.is_none() || hit(from).is_none());
                }
            }
        }
        assert!(all > 10_000, "{all}");
    }
}
