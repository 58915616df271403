use super::{Hits, LANES, dot};
use crate::Sphere;
use strahl_math::{DVec3, Interval, Ray};
use strahl_simd::Isa;

/// Up to four spheres, tested as [`Sphere`] does.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct SphereBlock {
    /// Per axis the centres of all lanes.
    pub(super) center: [[f64; LANES]; 3],
    /// The absolute values of the radii.
    pub(super) radius: [f64; LANES],
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

    /// The sphere of a lane, seen from outside.
    #[inline]
    pub fn sphere(&self, lane: usize) -> Sphere {
        Sphere::new(self.center(lane), self.radius[lane])
    }

    #[inline]
    fn center(&self, lane: usize) -> DVec3 {
        let [x, y, z] = &self.center;
        DVec3::new(x[lane], y[lane], z[lane])
    }

    /// Whether a ray that starts on the sphere of a lane goes inside, and so hits it again.
    #[inline]
    pub fn is_entered(&self, lane: usize, ray: &Ray) -> bool {
        (ray.origin - self.center(lane)).dot(ray.direction) < 0.0
    }

    /// The second hit of a ray that starts on the sphere of a lane, in a range, as [`Sphere`] finds it.
    #[inline]
    pub fn met_again(&self, lane: usize, ray: &Ray, range: Interval) -> Option<f64> {
        let other = Sphere::other_root(self.center(lane), ray)?;
        (range.accepts(other) && other != 0.0).then_some(other)
    }

    /// All hits in a range of a ray that does not start on the sphere of a lane.
    #[inline]
    pub fn all_hits(&self, lane: usize, ray: &Ray, range: Interval) -> [Option<f64>; 2] {
        let center = self.center(lane);
        let Some((near, far)) = Sphere::crossings_of(center, self.radius[lane], ray) else {
            return [None; 2];
        };
        [
            range.accepts(near).then_some(near),
            (range.accepts(far) && near < far).then_some(far),
        ]
    }

    /// The spheres that the ray hits in a range, as bits, and the first hit of each, if it does not start on them: the same
    /// operations as of [`Sphere`].
    #[inline(always)]
    pub fn hits<I: Isa>(&self, isa: I, ray: &Ray, range: Interval, hits: &mut Hits) -> u32 {
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
            return 0;
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
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Primitive, Scratch, SurfaceId};
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
                let found = dispatch!(simd, isa => block.hits(isa, &ray, range, &mut hits));
                assert_eq!(found & 1, 0, "the empty lane");
                for (lane, s) in spheres.iter().enumerate().skip(1) {
                    let hit = s.closest_hit(&ray, range, None, &mut Scratch::default());
                    let t = (found >> lane & 1 == 1).then_some(hits.t[lane]);
                    assert_eq!(t, hit.map(|h| h.t));
                    // One after the other, as by the single test.
                    let (mut one_by_one, mut rest) = (Vec::new(), range);
                    while let Some(hit) = s.closest_hit(&ray, rest, None, &mut Scratch::default()) {
                        one_by_one.push(hit.t);
                        rest.min = hit.t;
                    }
                    let both: Vec<f64> = block
                        .all_hits(lane, &ray, range)
                        .into_iter()
                        .flatten()
                        .collect();
                    assert_eq!(both, one_by_one);
                    all += u32::from(t.is_some());
                }
            }
        }
        assert!(all > 10_000, "{all}");
    }

    #[test]
    fn rays_from_a_sphere_that_graze_it_are_told_apart() {
        let sphere = Sphere::new(DVec3::new(0.3, -0.7, 0.2), 1.3);
        let mut block = SphereBlock::EMPTY;
        block.set(1, &sphere);
        let up = DVec3::new(0.6, 0.0, 0.8);
        let along = DVec3::new(0.8, 0.0, -0.6);
        let from = Some(SurfaceId {
            element: 0,
            facet: 0,
        });
        let mut met = 0;
        for i in -60..60 {
            let angle = 10f64.powi(-(i % 20)) * f64::from(i.signum());
            let ray = Ray::new(sphere.center() + up * 1.3, along - up * angle);
            let hit = sphere.closest_hit(&ray, Interval::FORWARD, from, &mut Scratch::default());
            assert!(hit.is_none() || block.is_entered(1, &ray), "{angle}");
            let again = block.met_again(1, &ray, Interval::FORWARD);
            assert_eq!(again, hit.as_ref().map(|h| h.t), "{angle}");
            assert!(angle >= 0.0 || !block.is_entered(1, &ray) || angle > -1e-15);
            met += u32::from(hit.is_some());
        }
        assert!(met > 40, "{met}");
    }
}
