use crate::DVec3;

/// A half-line `origin + t * direction`.
///
/// The direction need not be a unit vector, and it is **never renormalised** when a ray enters a transformed space:
/// `t` is one parameter, common to every space the ray passes through. Shadow rays rely on it too: their direction
/// reaches from the surface to the light, so the light is at `t = 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where the ray starts (`t = 0`).
    pub origin: DVec3,
    /// How far the ray moves per unit of `t`; any non-zero finite length.
    pub direction: DVec3,
}

impl Ray {
    /// A ray from `origin` along `direction`.
    pub const fn new(origin: DVec3, direction: DVec3) -> Self {
        Self { origin, direction }
    }

    /// The point at parameter `t`.
    #[inline]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}
