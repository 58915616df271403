use super::net::{Jet, Net};
use strahl_math::{DVec3, Ray};

/// A ray with two directions across it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) origin: DVec3,
    /// Its direction, of length 1.
    pub(super) along: DVec3,
    across: [DVec3; 2],
    /// The length of its direction.
    pub(super) length: f64,
}

impl Frame {
    pub(super) fn new(ray: &Ray) -> Option<Self> {
        let length = ray.direction.length();
        let along = ray.direction.try_normalize()?;
        if !(ray.origin.is_finite() && length.is_finite()) {
            return None;
        }
        let first = along.any_orthonormal_vector();
        Some(Self {
            origin: ray.origin,
            along,
            across: [first, along.cross(first)],
            length,
        })
    }

    /// The ray's parameter of a point.
    pub(super) fn t(&self, point: DVec3) -> f64 {
        (point - self.origin).dot(self.along) / self.length
    }

    /// A vector seen along the ray.
    #[inline(always)]
    pub(super) fn seen(&self, v: DVec3) -> [f64; 2] {
        [self.across[0].dot(v), self.across[1].dot(v)]
    }

    /// The ray's parameter of a point on a patch that is seen from its origin, less the last `step` of both parameters: so small that
    /// the derivatives are enough.
    #[inline(always)]
    pub(super) fn t_of(&self, jet: &Jet<4>, step: [f64; 2]) -> f64 {
        let moved = |k: usize| jet.value[k] - (jet.by_u[k] * step[0] + jet.by_v[k] * step[1]);
        let way = DVec3::new(moved(0), moved(1), moved(2));
        way.dot(self.along) / (moved(3) * self.length)
    }

    /// The patch seen along the ray; for rational ones the numerator, which is zero at the same parameters. It depends on the
    /// ray and each control point alone, so that the common border of two patches is the same in both.
    pub(super) fn view<const K: usize>(&self, net: &Net<4, K>) -> Net<2, K> {
        net.map(|p| self.see(p))
    }

    /// A control point seen along the ray.
    pub(super) fn see(&self, point: &[f64; 4]) -> [f64; 2] {
        self.seen(self.to(point))
    }

    /// The way from the origin to a control point, times its weight. Its rounding error is that of the way, not of the places.
    pub(super) fn to(&self, [x, y, z, w]: &[f64; 4]) -> DVec3 {
        if *w == 1.0 {
            return DVec3::new(*x, *y, *z) - self.origin;
        }
        (DVec3::new(*x, *y, *z) * (1.0 / *w) - self.origin) * *w
    }
}
