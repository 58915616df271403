use crate::cull::{CullBounds, largest, scaled};
use strahl_math::{DVec3, Interval, Ray};

/// A ray for grids, octrees and spheres: in f64, its direction scaled and its origin near the structure.
///
/// Directions are scaled by a power of two so that their largest component is in `1..2`; a ray that starts far away is first
/// moved to where it enters the structure. `t` here is `(t - offset) scale` of the original ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moved {
    pub(crate) origin: DVec3,
    pub(crate) direction: DVec3,
    pub(crate) range: Interval,
    /// A bound of the rounding errors of moving the ray, and of primitives that do not move it.
    pub(crate) margin: f64,
    offset: f64,
    scale: f64,
}

/// Origins further away than this many times B are moved to the structure.
pub(crate) const FAR: f64 = 4.0;

/// Rounding errors of a ray that is moved, per |o|: see the same constant of the culling rays.
const FAR_SLACK: f64 = 32.0 * f64::EPSILON;

impl Moved {
    /// The ray, or `None` if it certainly misses the structure in `range`. One with a coordinate that is not finite, or
    /// without a direction, meets nothing.
    #[inline(always)]
    pub(crate) fn new(ray: &Ray, range: Interval, structure: &CullBounds) -> Option<Self> {
        let distance = largest(ray.origin);
        let (direction, scale) = scaled(ray.direction)?;
        let (mut origin, mut offset, mut margin) = (ray.origin, 0.0, 0.0);
        let max_abs = structure.max_abs();
        if distance > FAR * max_abs {
            if distance == f64::INFINITY {
                return None;
            }
            margin = FAR_SLACK * distance;
            let padded = structure
                .bounds()
                .padded(DVec3::splat(margin + SLACK * max_abs));
            offset = padded.clip(ray, range)?.min;
            origin = ray.at(offset);
            if !(largest(origin) <= FAR * (max_abs + margin)) {
                // The way to the structure has overflowed: no finite t reaches it.
                return None;
            }
        }
        let mut moved = Self {
            origin,
            direction,
            range,
            margin,
            offset,
            scale,
        };
        let min = -moved.scaled_up(-(range.min - offset));
        moved.range = Interval::new(min, moved.upper(range.max));
        Some(moved)
    }

    /// The upper end of a range of the original ray, in this ray's parameters: rounded up.
    #[inline(always)]
    pub(crate) fn upper(&self, t: f64) -> f64 {
        self.scaled_up(t - self.offset)
    }

    #[inline(always)]
    fn scaled_up(&self, t: f64) -> f64 {
        let t = t * self.scale;
        // One rounding of a difference and, where numbers are subnormal, one of the product.
        if t.is_finite() {
            t + (t.abs() * (4.0 * f64::EPSILON) + f64::MIN_POSITIVE)
        } else {
            t
        }
    }

    /// The `t` of the original ray.
    pub(crate) fn original(&self, t: f64) -> f64 {
        t / self.scale + self.offset
    }

    /// A point of the ray.
    #[inline(always)]
    pub(crate) fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}

/// 8u, u the roundoff of f32: hits may lie outside of their primitives' boxes by this part of the coordinates.
pub(crate) const SLACK: f64 = 8.0 / (1u64 << 24) as f64;
