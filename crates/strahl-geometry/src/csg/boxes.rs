use strahl_math::{Aabb, DVec3, Interval, Ray};

/// A ray that is tested against many boxes: divided once, multiplied often.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slabs {
    origin: DVec3,
    direction: DVec3,
    inverse: DVec3,
}

impl Slabs {
    pub(super) fn new(ray: &Ray) -> Self {
        Self {
            origin: ray.origin,
            direction: ray.direction,
            inverse: 1.0 / ray.direction,
        }
    }

    /// The part of the range within a box, conservatively widened as [`Aabb::clip`] does it; `None` if the ray misses.
    pub(super) fn clip(&self, bounds: &Aabb, range: Interval) -> Option<Interval> {
        // A difference, a reciprocal and a product, each within half an ulp: widened by more than their sum.
        const SLACK: f64 = 4.0 * f64::EPSILON;
        let Interval {
            min: mut enter,
            max: mut exit,
        } = range;
        for axis in 0..3 {
            let (o, inverse) = (self.origin[axis], self.inverse[axis]);
            let (low, high) = (bounds.min[axis], bounds.max[axis]);
            if self.direction[axis] == 0.0 {
                if !(low <= o && o <= high) {
                    return None;
                }
                continue;
            }
            let (a, b) = ((low - o) * inverse, (high - o) * inverse);
            let (near, far) = if inverse > 0.0 { (a, b) } else { (b, a) };
            let (near, far) = (near - near.abs() * SLACK, far + far.abs() * SLACK);
            // NaN (an infinite reciprocal, a plane through the origin) clips nothing.
            if near > enter {
                enter = near;
            }
            if far < exit {
                exit = far;
            }
        }
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
