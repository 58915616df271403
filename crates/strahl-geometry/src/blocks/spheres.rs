use super::LANES;
use crate::Sphere;
use strahl_math::{DVec3, Interval, Ray};
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
        radius: [f64::NAN; LANES],
    };

    /// Puts a sphere into a lane.
    pub fn set(&mut self, lane: usize, sphere: &Sphere) {
        for (lanes, x) in self.center.iter_mut().zip(sphere.center().to_array()) {
            lanes[lane] = x;
        }
        self.radius[lane] = sphere.radius().abs();
    }

    /// Which spheres the ray's line crosses, as bits.
    #[inline(always)]
    pub fn candidates<I: Isa>(&self, isa: I, ray: &Ray) -> u32 {
        // The discriminant of `Sphere`, operation by operation.
        let [dx, dy, dz] = ray.direction.to_array();
        let d = [isa.splat(dx), isa.splat(dy), isa.splat(dz)];
        let f = [
            isa.sub(isa.splat(ray.origin.x), isa.load(&self.center[0])),
            isa.sub(isa.splat(ray.origin.y), isa.load(&self.center[1])),
            isa.sub(isa.splat(ray.origin.z), isa.load(&self.center[2])),
        ];
        let a = isa.splat(ray.direction.dot(ray.direction));
        // -(f·d)/a, without the signs: they change no rounding.
        let closest_t = isa.div(dot(isa, f, d), a);
        let closest = [
            isa.sub(f[0], isa.mul(d[0], closest_t)),
            isa.sub(f[1], isa.mul(d[1], closest_t)),
            isa.sub(f[2], isa.mul(d[2], closest_t)),
        ];
        let r = isa.load(&self.radius);
        let square = isa.sub(isa.mul(r, r), dot(isa, closest, closest));
        isa.lt(isa.splat(0.0), isa.mul(a, square))
    }

    /// The first crossing of a lane's sphere in a range.
    #[inline]
    pub fn hit(&self, lane: usize, ray: &Ray, range: Interval) -> Option<f64> {
        let center = DVec3::from_array(self.center.map(|axis| axis[lane]));
        let (near, far) = Sphere::crossings_of(center, self.radius[lane], ray)?;
        if range.accepts(near) {
            return Some(near);
        }
        range.accepts(far).then_some(far)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Primitive, Scratch};
    use strahl_simd::{Simd, dispatch};

    #[test]
    fn candidates_are_exactly_those_the_line_crosses() {
        let mut state = 7u64;
        let mut signed = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let mut hits = 0;
        for _ in 0..20_000 {
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
            for simd in Simd::available() {
                let found = dispatch!(simd, isa => block.candidates(isa, &ray));
                assert_eq!(found & 1, 0, "the empty lane");
                for (lane, s) in spheres.iter().enumerate().skip(1) {
                    let everywhere = Interval::new(f64::NEG_INFINITY, f64::INFINITY);
                    let hit = s.closest_hit(&ray, everywhere, None, &mut Scratch::default());
                    assert_eq!(found >> lane & 1 == 1, hit.is_some());
                    assert_eq!(block.hit(lane, &ray, everywhere), hit.map(|h| h.t));
                    hits += u32::from(hit.is_some());
                }
            }
        }
        assert!(hits > 10_000, "{hits}");
    }
}
