use strahl_math::{Aabb, DVec3, Interval, Ray};

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
        // A difference, a reciprocal and a product, each within half an ulp: widened by more than their sum.
        const SLACK: f64 = 4.0 * f64::EPSILON;
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
