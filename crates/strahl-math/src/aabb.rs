use crate::{DVec3, Interval, Ray};

/// An axis-aligned bounding box in f64, possibly empty (`min > max`) or unbounded (infinite coordinates).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the smallest coordinates.
    pub min: DVec3,
    /// The corner with the largest coordinates.
    pub max: DVec3,
}

impl Aabb {
    /// The box that contains nothing: the neutral element of [`Aabb::union`].
    pub const EMPTY: Self = Self {
        min: DVec3::INFINITY,
        max: DVec3::NEG_INFINITY,
    };
    /// All of space.
    pub const EVERYTHING: Self = Self {
        min: DVec3::NEG_INFINITY,
        max: DVec3::INFINITY,
    };

    /// The box between two corners; each coordinate of `min` must not exceed that of `max`.
    pub const fn new(min: DVec3, max: DVec3) -> Self {
        Self { min, max }
    }

    /// The smallest box around some points; empty for no points.
    pub fn from_points(points: impl IntoIterator<Item = DVec3>) -> Self {
        points
            .into_iter()
            .fold(Self::EMPTY, |b, p| Self::new(b.min.min(p), b.max.max(p)))
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self::new(self.min.min(other.min), self.max.max(other.max))
    }

    /// The intersection of both boxes; empty if they are apart.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        let b = Self::new(self.min.max(other.min), self.max.min(other.max));
        if b.is_empty() { Self::EMPTY } else { b }
    }

    /// Whether no point is inside.
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y && self.min.z <= self.max.z)
    }

    /// Whether the box is non-empty and all its coordinates are finite.
    pub fn is_bounded(&self) -> bool {
        !self.is_empty() && self.min.is_finite() && self.max.is_finite()
    }

    /// Whether the point is inside or on the boundary.
    pub fn contains(&self, p: DVec3) -> bool {
        self.min.cmple(p).all() && self.max.cmpge(p).all()
    }

    /// The box grown by `margin` on every side.
    #[must_use]
    pub fn padded(&self, margin: DVec3) -> Self {
        Self::new(self.min - margin, self.max + margin)
    }

    /// The centre; meaningful for bounded boxes.
    pub fn center(&self) -> DVec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// The eight parts of the box, halved along each axis; meaningful for bounded boxes. Part `i + 2 j + 4 k` is the lower (0) or the upper (1) one along
    /// x, y and z.
    pub fn eighths(&self) -> [Self; 8] {
        let (low, middle, high) = (self.min, self.center(), self.max);
        std::array::from_fn(|part| {
            let pick = |a: DVec3, b: DVec3| {
                DVec3::from_array([0, 1, 2].map(|axis| match part >> axis & 1 {
                    0 => a[axis],
                    _ => b[axis],
                }))
            };
            Self::new(pick(low, middle), pick(middle, high))
        })
    }

    /// The edge lengths; negative if empty.
    pub fn size(&self) -> DVec3 {
        self.max - self.min
    }

    /// Half the surface area; 0 for an empty box.
    pub fn half_area(&self) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let s = self.size();
        s.x * s.y + s.y * s.z + s.z * s.x
    }

    /// The largest absolute coordinate; 0 for an empty box.
    pub fn max_abs(&self) -> f64 {
        if self.is_empty() {
            0.0
        } else {
            self.min.abs().max(self.max.abs()).max_element()
        }
    }

    /// The eight corners.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let pick = |axis: usize| {
                if i >> axis & 1 == 0 {
                    self.min[axis]
                } else {
                    self.max[axis]
                }
            };
            DVec3::new(pick(0), pick(1), pick(2))
        })
    }

    /// The range of parameters for which the ray is inside the box, conservatively widened by the rounding errors of this
    /// computation; `None` if the ray misses.
    ///
    /// This clips in f64, to move the origin of rays near a structure. It is not the culling test of the accelerators.
    pub fn clip(&self, ray: &Ray, range: Interval) -> Option<Interval> {
        let mut inside = range;
        for axis in 0..3 {
            let planes = [self.min[axis], self.max[axis]];
            inside = Self::clip_axis(planes, ray.origin[axis], ray.direction[axis], inside)?;
        }
        (inside.min <= inside.max).then_some(inside)
    }

    /// Of the distances of an origin from 0, that much is added to boxes by [`Aabb::may_be_met`]: 2⁻⁴⁰.
    pub const MARGIN_OF_ORIGIN: f64 = 1.0 / (1_u64 << 40) as f64;

    /// By how much [`Aabb::may_be_met`] widens the box for a ray from an origin: by 2⁻²⁰ of its largest side as well.
    #[inline]
    pub fn margin(&self, origin: DVec3) -> DVec3 {
        const OF_SIZE: f64 = 1.0 / 1_048_576.0;
        let size = (self.max - self.min).max_element();
        DVec3::splat(size * OF_SIZE) + origin.abs() * Self::MARGIN_OF_ORIGIN
    }

    /// Whether the ray may meet the box in the range. The box is widened by far more than all rounding errors of points on a surface in it
    /// ([`Aabb::margin`]), so that a ray which does not meet it meets nothing in it.
    #[inline]
    pub fn may_be_met(&self, ray: &Ray, range: Interval) -> bool {
        let margin = self.margin(ray.origin);
        let inverse = DVec3::ONE / ray.direction;
        let a = (self.min - margin - ray.origin) * inverse;
        let b = (self.max + margin - ray.origin) * inverse;
        // A product of 0 and infinity, not a number, comes from an origin on the widened border, outside of the box.
        let (mut near, mut far) = (range.min, range.max);
        for axis in 0..3 {
            let (a, b) = (a[axis], b[axis]);
            let (first, last) = if a < b { (a, b) } else { (b, a) };
            near = if first > near { first } else { near };
            far = if last < far { last } else { far };
        }
        near <= far
    }

    /// [`Aabb::clip`] for one axis: the part of the range (perhaps empty) where `o + t d` is between two planes; `None` if it never is.
    #[inline]
    pub fn clip_axis([low, high]: [f64; 2], o: f64, d: f64, range: Interval) -> Option<Interval> {
        if d == 0.0 {
            return (low <= o && o <= high).then_some(range);
        }
        let (a, b) = ((low - o) / d, (high - o) / d);
        let (near, far) = if a < b { (a, b) } else { (b, a) };
        // Two roundings (difference, quotient), each within half an ulp: widen by two ulps.
        let near = near - near.abs() * f64::EPSILON * 2.0;
        let far = far + far.abs() * f64::EPSILON * 2.0;
        Some(Interval::new(
            if near > range.min { near } else { range.min },
            if far < range.max { far } else { range.max },
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eighths_make_up_the_box() {
        let whole = Aabb::new(DVec3::new(-1.0, 0.0, 2.0), DVec3::new(1.0, 4.0, 8.0));
        let parts = whole.eighths();
        assert_eq!(parts[5].min, DVec3::new(0.0, 0.0, 5.0));
        assert_eq!(parts[5].max, DVec3::new(1.0, 2.0, 8.0));
        assert_eq!(
            parts.iter().fold(Aabb::EMPTY, |b, part| b.union(part)),
            whole
        );
    }

    #[test]
    fn an_empty_box_is_the_neutral_element() {
        let b = Aabb::new(DVec3::ZERO, DVec3::ONE);
        assert_eq!(Aabb::EMPTY.union(&b), b);
        assert!(
            Aabb::EMPTY.is_empty() && !Aabb::EMPTY.is_bounded() && Aabb::EMPTY.half_area() == 0.0
        );
        assert!(!Aabb::EVERYTHING.is_bounded());
    }

    #[test]
    fn clip_handles_rays_in_a_face_and_parallel_rays() {
        let b = Aabb::new(DVec3::ZERO, DVec3::ONE);
        let in_face = Ray::new(DVec3::new(0.0, 0.5, -1.0), DVec3::Z);
        let clipped = b.clip(&in_face, Interval::FORWARD).expect("touches");
        assert!((clipped.min - 1.0).abs() < 1e-12 && (clipped.max - 2.0).abs() < 1e-12);
        let outside = Ray::new(DVec3::new(-0.1, 0.5, -1.0), DVec3::Z);
        assert_eq!(b.clip(&outside, Interval::FORWARD), None);
        assert!(Aabb::EVERYTHING.clip(&outside, Interval::FORWARD).is_some());
    }

    #[test]
    fn a_ray_that_meets_a_point_of_a_box_may_meet_the_box() {
        let mut state = 7_u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        let mut missed = 0;
        for round in 0..20_000 {
            let mut point = |size: f64| DVec3::new(random(), random(), random()) * size;
            let (a, b) = (point(1.0), point(1.0));
            let all = Aabb::from_points([a, b]);
            let mut direction = point([1.0, 1e-9, 1e9][round % 3]);
            // Within a face, and along an axis.
            direction[round % 5 % 3] *= f64::from(u8::from(round % 4 != 0));
            let way = point(1.0).x.abs() * 1e3;
            let part = point(0.5) + 0.5;
            let mut inside = a + (b - a) * part;
            inside[round % 3] = if round % 2 == 0 {
                a[round % 3]
            } else {
                inside[round % 3]
            };
            let t = way / direction.length();
            let ray = Ray::new(inside - direction * t, direction);
            let near = Interval::new(0.999 * t, 1.001 * t);
            for range in [Interval::FORWARD, Interval::LINE, near] {
                assert!(all.may_be_met(&ray, range), "{round} {ray:?} {all:?}");
            }
            let behind = Interval::new(-2.0 * t, -t);
            assert!(way < 4.0 || !all.may_be_met(&ray, behind), "{round}");
            let beside = Ray::new(ray.origin + DVec3::splat(2.1), direction);
            missed += u32::from(!all.may_be_met(&beside, Interval::LINE));
        }
        assert!(missed > 10_000, "{missed}");
    }

    #[test]
    fn corners_are_all_different() {
        let corners = Aabb::new(DVec3::ZERO, DVec3::ONE).corners();
        for (i, a) in corners.iter().enumerate() {
            assert!(corners[..i].iter().all(|b| a != b));
        }
    }
}
