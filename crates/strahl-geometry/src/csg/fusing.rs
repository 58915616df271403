//! How close to each other the crossings of different leaves may be before they could coincide.

use crate::Crossing;
use crate::blocks::convex::FourRays;
use strahl_math::{Interval, Ray};
use strahl_simd::Isa;

/// Decides which crossings coincide: coincident surfaces are hit at parameters that differ by rounding.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fusing {
    /// The parameter at which the ray is as far from its origin as its origin is from that of space.
    scale: f64,
}

impl Fusing {
    /// The largest gap that is ever closed, relative to the magnitudes involved. Error bounds are far below (some 1e-15),
    /// except where a ray grazes a surface; the limit makes lists independent of the range asked for, see [`Fusing::margin`].
    pub(super) const LIMIT: f64 = 1.0 / (1u64 << 20) as f64;

    pub(super) fn new(ray: &Ray) -> Self {
        let scale = ray.origin.abs().max_element() / ray.direction.abs().max_element();
        Self {
            scale: if scale.is_finite() { scale } else { 0.0 },
        }
    }

    /// A bound of the distance between crossings that may be fused with one at `t`. Lists made for a range that is wider by a
    /// few margins equal those of the whole line, clipped.
    pub(super) fn margin(&self, t: f64) -> f64 {
        Self::LIMIT * (t.abs() + self.scale)
    }

    /// Crossings further apart than this certainly don't coincide.
    pub(super) fn gap(&self, a: f64, b: f64) -> f64 {
        2.0 * (self.margin(a) + self.margin(b))
    }

    /// The range, wider by a few margins at both ends.
    pub(super) fn widened(&self, range: Interval) -> Interval {
        Interval::new(
            range.min - 4.0 * self.margin(range.min),
            range.max + 4.0 * self.margin(range.max),
        )
    }

    /// The crossing's error, up to the limit.
    pub(super) fn reach(&self, crossing: &Crossing) -> f64 {
        let margin = self.margin(crossing.hit.t);
        if crossing.t_error < margin {
            crossing.t_error
        } else {
            margin
        }
    }

    pub(super) fn coincide(&self, a: &Crossing, b: &Crossing) -> bool {
        (b.hit.t - a.hit.t).abs() <= self.reach(a) + self.reach(b)
    }
}

/// Two crossings are so close together that they could coincide, or another case that only lists can decide.
#[derive(Clone, Copy, Debug)]
pub(super) struct TooClose;

/// [`Fusing`] for four rays.
pub(super) struct FourFusing<I: Isa> {
    scale: I::F64x4,
}

impl<I: Isa> FourFusing<I> {
    #[inline(always)]
    pub(super) fn new(isa: I, rays: &FourRays<I>) -> Self {
        let [x, y, z] = rays.origin;
        let [u, v, w] = rays.direction;
        let far = isa.max(isa.max(isa.abs(x), isa.abs(y)), isa.abs(z));
        let fast = isa.max(isa.max(isa.abs(u), isa.abs(v)), isa.abs(w));
        let (zero, scale) = (isa.splat(0.0), isa.div(far, fast));
        // No finite number: none.
        Self {
            scale: isa.choose_le(scale, isa.splat(f64::MAX), scale, zero),
        }
    }

    #[inline(always)]
    pub(super) fn margin(&self, isa: I, t: I::F64x4) -> I::F64x4 {
        isa.mul(isa.splat(Fusing::LIMIT), isa.add(isa.abs(t), self.scale))
    }

    #[inline(always)]
    pub(super) fn gap(&self, isa: I, a: I::F64x4, b: I::F64x4) -> I::F64x4 {
        let both = isa.add(self.margin(isa, a), self.margin(isa, b));
        isa.mul(isa.splat(2.0), both)
    }

    /// The lanes in which nothing at `a` could coincide with something at `b`, which is not in front of it. At infinity there are no
    /// crossings.
    #[inline(always)]
    pub(super) fn apart(&self, isa: I, a: I::F64x4, b: I::F64x4) -> u32 {
        isa.lt(self.gap(isa, a, b), isa.sub(b, a))
            | isa.le(a, isa.splat(f64::NEG_INFINITY))
            | isa.le(isa.splat(f64::INFINITY), b)
    }
}
