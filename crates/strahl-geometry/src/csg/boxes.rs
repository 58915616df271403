use super::fusing::FourFusing;
use crate::blocks::LANES;
use crate::blocks::convex::{FourRays, sub};
use strahl_math::{Aabb, DVec3, Interval, Ray};
use strahl_simd::Isa;

/// What a difference, a reciprocal and a product, each within half an ulp, are widened by: more than their sum.
const SLACK: f64 = 4.0 * f64::EPSILON;

/// A ray that is tested against many boxes: divided once, multiplied often.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slabs {
    origin: DVec3,
    direction: DVec3,
    inverse: DVec3,
    /// Whether a component of the direction is zero, or so small that its reciprocal is infinite.
    is_parallel: bool,
}

impl Slabs {
    pub(super) fn new(ray: &Ray) -> Self {
        let inverse = 1.0 / ray.direction;
        Self {
            origin: ray.origin,
            direction: ray.direction,
            inverse,
            is_parallel: !inverse.is_finite(),
        }
    }

    /// The part of the range within a box, conservatively widened as [`Aabb::clip`] does it; `None` if the ray misses. Empty boxes may
    /// count as met.
    #[inline]
    pub(super) fn clip(&self, bounds: &Aabb, range: Interval) -> Option<Interval> {
        if self.is_parallel {
            return bounds.clip(&Ray::new(self.origin, self.direction), range);
        }
        let a = (bounds.min - self.origin) * self.inverse;
        let b = (bounds.max - self.origin) * self.inverse;
        let smaller = |a: f64, b: f64| if a < b { a } else { b };
        let larger = |a: f64, b: f64| if a > b { a } else { b };
        let near = larger(
            larger(smaller(a.x, b.x), smaller(a.y, b.y)),
            smaller(a.z, b.z),
        );
        let far = smaller(
            smaller(larger(a.x, b.x), larger(a.y, b.y)),
            larger(a.z, b.z),
        );
        let enter = larger(near - near.abs() * SLACK, range.min);
        let exit = smaller(far + far.abs() * SLACK, range.max);
        (enter <= exit).then(|| Interval::new(enter, exit))
    }
}

/// Four rays that are tested against many boxes.
pub(super) struct FourSlabs<I: Isa> {
    origin: [I::F64x4; 3],
    inverse: [I::F64x4; 3],
    /// The parts that matter, a little wider than what is asked.
    min: I::F64x4,
    max: I::F64x4,
    /// The lanes that run along a face of a box.
    parallel: u32,
}

/// As many margins on both sides: more than those by which searches begin before their ranges.
const MARGINS: f64 = 32.0;

impl<I: Isa> FourSlabs<I> {
    #[inline(always)]
    pub(super) fn new(isa: I, rays: &FourRays<I>, min: f64, ends: &[f64; LANES]) -> Self {
        let one = isa.splat(1.0);
        let [x, y, z] = rays.direction;
        let inverse = [isa.div(one, x), isa.div(one, y), isa.div(one, z)];
        let largest = isa.splat(f64::MAX);
        let finite = isa.le(isa.abs(inverse[0]), largest)
            & isa.le(isa.abs(inverse[1]), largest)
            & isa.le(isa.abs(inverse[2]), largest);
        let fusing = FourFusing::new(isa, rays);
        let (min, max, wide) = (isa.splat(min), isa.load(ends), isa.splat(MARGINS));
        Self {
            origin: rays.origin,
            inverse,
            min: isa.sub(min, isa.mul(wide, fusing.margin(isa, min))),
            max: isa.add(max, isa.mul(wide, fusing.margin(isa, max))),
            parallel: !finite & 0b1111,
        }
    }

    /// The lanes, as bits, that may meet a box: all others certainly miss it.
    #[inline(always)]
    pub(super) fn may_meet(&self, isa: I, bounds: &Aabb) -> u32 {
        let slack = isa.splat(SLACK);
        let corner = |v: DVec3| [isa.splat(v.x), isa.splat(v.y), isa.splat(v.z)];
        let (low, high) = (corner(bounds.min), corner(bounds.max));
        let a = times(isa, sub(isa, low, self.origin), self.inverse);
        let b = times(isa, sub(isa, high, self.origin), self.inverse);
        let near = isa.max(
            isa.max(isa.min(a[0], b[0]), isa.min(a[1], b[1])),
            isa.min(a[2], b[2]),
        );
        let far = isa.min(
            isa.min(isa.max(a[0], b[0]), isa.max(a[1], b[1])),
            isa.max(a[2], b[2]),
        );
        let near = isa.sub(near, isa.mul(isa.abs(near), slack));
        let far = isa.add(far, isa.mul(isa.abs(far), slack));
        let missed = isa.lt(far, near) | isa.lt(far, self.min) | isa.lt(self.max, near);
        !missed & 0b1111 | self.parallel
    }
}

#[inline(always)]
fn times<I: Isa>(isa: I, a: [I::F64x4; 3], b: [I::F64x4; 3]) -> [I::F64x4; 3] {
    [
        isa.mul(a[0], b[0]),
        isa.mul(a[1], b[1]),
        isa.mul(a[2], b[2]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;

    #[test]
    fn nothing_is_lost_that_division_finds() {
        let mut random = Random::new(4);
        let (mut met, mut missed) = (0, 0);
        for case in 0..100_000 {
            let (p, q) = (random.cube(), random.cube());
            let b = Aabb::new(p.min(q), p.max(q));
            let mut ray = Ray::new(random.cube() * 1.5, random.direction());
            match case % 4 {
                // Within a face, along an edge, hardly slanted.
                0 => ray.origin.x = b.min.x,
                1 => {
                    ray.direction.y = 0.0;
                    ray.origin.y = b.max.y;
                }
                2 => ray.direction.z *= 1e-300,
                _ => {}
            }
            let range = Interval::new(random.between(-6.0, 0.0), random.between(0.0, 6.0));
            let (ours, exact) = (Slabs::new(&ray).clip(&b, range), b.clip(&ray, range));
            match (ours, exact) {
                (Some(ours), Some(exact)) => {
                    let slack = 1e-14 * (exact.min.abs() + exact.max.abs());
                    assert!(
                        ours.min <= exact.min + slack && exact.max <= ours.max + slack,
                        "{ray:?} {b:?}: {ours:?} {exact:?}"
                    );
                    met += 1;
                }
                (None, None) => missed += 1,
                (ours, exact) => {
                    // Only boxes touched in a point may be decided either way.
                    let found = ours.or(exact).expect("one of them");
                    assert!(
                        found.max - found.min < 1e-13,
                        "{ray:?} {b:?}: {ours:?} {exact:?}"
                    );
                }
            }
        }
        assert!(met > 5_000 && missed > 5_000, "{met} {missed}");
    }
}
