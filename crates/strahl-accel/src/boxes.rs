use strahl_math::error::{round_down_f32, round_up_f32};
use strahl_math::{Aabb, Vec4};

/// An axis-aligned box in f32, rounded outwards: it contains the f64 box it was made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Box32 {
    /// The lowest corner; the fourth lane is not used.
    lo: Vec4,
    /// The highest corner; the fourth lane is not used.
    hi: Vec4,
}

/// Two boxes next to each other: per axis the lower planes of both, then the upper planes of both.
pub(crate) type BoxPair = [[f32; 4]; 3];

/// Boxes that reach further than this are treated like unbounded ones: up to here no product of a plane and a reciprocal direction
/// (at most 2⁶⁰) overflows, so the culling tests never meet an infinity or a NaN.
const FARTHEST: f64 = (1u128 << 64) as f64;

impl Box32 {
    pub(crate) const EMPTY: Self = Self {
        lo: Vec4::INFINITY,
        hi: Vec4::NEG_INFINITY,
    };

    /// The smallest f32 box around an f64 box, or `None` if that is empty or too large for f32 culling.
    #[inline]
    pub(crate) fn try_new(b: &Aabb) -> Option<Self> {
        let fits = b.is_bounded() && b.max_abs() <= FARTHEST;
        fits.then(|| Self::around(b))
    }

    /// The smallest f32 box around an f64 box.
    #[inline]
    pub(crate) fn around(b: &Aabb) -> Self {
        let (lo, hi) = (b.min, b.max);
        let down = round_down_f32;
        let up = round_up_f32;
        Self {
            lo: Vec4::new(down(lo.x), down(lo.y), down(lo.z), 0.0),
            hi: Vec4::new(up(hi.x), up(hi.y), up(hi.z), 0.0),
        }
    }

    /// The intersection with another box.
    pub(crate) fn intersection(&self, other: &Self) -> Self {
        Self {
            lo: self.lo.max(other.lo),
            hi: self.hi.min(other.hi),
        }
    }

    /// Enlarges the box to contain another.
    #[inline(always)]
    pub(crate) fn grow(&mut self, other: &Self) {
        self.lo = self.lo.min(other.lo);
        self.hi = self.hi.max(other.hi);
    }

    /// Enlarges the box to contain a point.
    #[inline(always)]
    pub(crate) fn grow_to(&mut self, point: Vec4) {
        self.lo = self.lo.min(point);
        self.hi = self.hi.max(point);
    }

    /// The box with these corners, whose fourth lanes are not used.
    pub(crate) const fn of_corners(lo: Vec4, hi: Vec4) -> Self {
        Self { lo, hi }
    }

    #[inline(always)]
    pub(crate) fn lo(&self) -> Vec4 {
        self.lo
    }

    #[inline(always)]
    pub(crate) fn hi(&self) -> Vec4 {
        self.hi
    }

    /// The corners as arrays, to pick a coordinate whose number is not known at compile time.
    #[inline(always)]
    pub(crate) fn corners(&self) -> (&[f32; 4], &[f32; 4]) {
        (self.lo.as_ref(), self.hi.as_ref())
    }

    #[inline(always)]
    pub(crate) fn size(&self) -> Vec4 {
        self.hi - self.lo
    }

    /// One over the largest extent. In this unit neither the areas of the boxes inside overflow nor do those of small boxes
    /// underflow.
    pub(crate) fn unit(&self) -> f32 {
        (1.0 / self.size().truncate().max_element()).min(f32::MAX)
    }

    /// Twice the centre.
    #[inline(always)]
    pub(crate) fn center(&self) -> Vec4 {
        self.lo + self.hi
    }

    /// Half the surface area; meaningful for boxes that are not empty.
    #[inline(always)]
    pub(crate) fn half_area(&self) -> f64 {
        let size = self.size();
        let (x, y, z) = (f64::from(size.x), f64::from(size.y), f64::from(size.z));
        x * y + y * z + z * x
    }

    /// Whether it is empty.
    pub(crate) fn is_empty(&self) -> bool {
        (0..3).any(|axis| self.lo[axis] > self.hi[axis])
    }

    /// The part within another box; [`Box32::EMPTY`] if there is none.
    pub(crate) fn clipped(&self, other: &Self) -> Self {
        let part = self.intersection(other);
        if part.is_empty() { Self::EMPTY } else { part }
    }

    pub(crate) fn contains(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.lo[axis] <= other.lo[axis] && self.hi[axis] >= other.hi[axis])
    }

    /// Two boxes in the layout of the culling test.
    pub(crate) fn pair(a: &Self, b: &Self) -> BoxPair {
        std::array::from_fn(|axis| [a.lo[axis], b.lo[axis], a.hi[axis], b.hi[axis]])
    }

    /// One of the boxes (0 or 1) of a pair.
    pub(crate) fn of_pair(pair: &BoxPair, which: usize) -> Self {
        let corner = |at: usize| Vec4::new(pair[0][at], pair[1][at], pair[2][at], 0.0);
        Self {
            lo: corner(which),
            hi: corner(which + 2),
        }
    }

    /// The same box in f64, exactly.
    pub(crate) fn to_aabb(self) -> Aabb {
        let corner = |v: Vec4| v.as_dvec4().truncate();
        Aabb::new(corner(self.lo), corner(self.hi))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_math::DVec3;

    #[test]
    fn rounding_is_outwards_and_tight() {
        let b = Aabb::new(DVec3::new(0.1, -0.1, 1.0), DVec3::new(0.3, 0.1, 1.0));
        let rounded = Box32::try_new(&b).expect("bounded").to_aabb();
        for axis in 0..3 {
            assert!(rounded.min[axis] <= b.min[axis] && b.max[axis] <= rounded.max[axis]);
            assert!(b.min[axis] - rounded.min[axis] < 1e-7);
            assert!(rounded.max[axis] - b.max[axis] < 1e-7);
        }
        assert_eq!((rounded.min.z, rounded.max.z), (1.0, 1.0));
    }

    #[test]
    fn what_f32_cannot_cull_is_refused() {
        let up_to = |x: f64| Box32::try_new(&Aabb::new(DVec3::ZERO, DVec3::splat(x)));
        assert!(up_to(FARTHEST).is_some());
        for x in [FARTHEST.next_up(), 1e300, f64::INFINITY, f64::NAN, -1.0] {
            assert!(up_to(x).is_none(), "{x}");
        }
    }

    #[test]
    fn a_pair_gives_its_boxes_back() {
        let new = |a, b| Box32::try_new(&Aabb::new(a, b)).expect("bounded");
        let a = new(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0));
        let b = new(DVec3::NEG_ONE, DVec3::X);
        let pair = Box32::pair(&a, &b);
        assert_eq!(Box32::of_pair(&pair, 0), a);
        assert_eq!(Box32::of_pair(&pair, 1), b);
        let mut both = a;
        both.grow(&b);
        assert!(both.contains(&a) && both.contains(&b) && !a.contains(&b));
        assert_eq!(a.half_area(), 11.0);
    }
}
