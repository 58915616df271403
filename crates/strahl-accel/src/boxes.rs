use strahl_math::error::{round_down_f32, round_up_f32};
use strahl_math::{Aabb, DVec3, Interval, Ray, Vec4, Vec4Swizzles};

/// An axis-aligned box in f32, rounded outwards: it contains the f64 box it was made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Box32 {
    pub(crate) lo: [f32; 3],
    pub(crate) hi: [f32; 3],
}

impl Box32 {
    pub(crate) const EMPTY: Self = Self {
        lo: [f32::INFINITY; 3],
        hi: [f32::NEG_INFINITY; 3],
    };

    pub(crate) fn new(b: &Aabb) -> Self {
        Self {
            lo: b.min.to_array().map(round_down_f32),
            hi: b.max.to_array().map(round_up_f32),
        }
    }

    #[inline]
    pub(crate) fn grow(&mut self, other: &Self) {
        for axis in 0..3 {
            if other.lo[axis] < self.lo[axis] {
                self.lo[axis] = other.lo[axis];
            }
            if other.hi[axis] > self.hi[axis] {
                self.hi[axis] = other.hi[axis];
            }
        }
    }

    #[inline]
    pub(crate) fn half_area(&self) -> f64 {
        let size = |axis: usize| f64::from(self.hi[axis]) - f64::from(self.lo[axis]);
        let (x, y, z) = (size(0), size(1), size(2));
        if x < 0.0 { 0.0 } else { x * y + y * z + z * x }
    }

    pub(crate) fn contains(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.lo[axis] <= other.lo[axis] && self.hi[axis] >= other.hi[axis])
    }

    /// Two boxes in the layout of the culling test.
    pub(crate) fn pair(a: &Self, b: &Self) -> BoxPair {
        std::array::from_fn(|axis| [a.lo[axis], b.lo[axis], a.hi[axis], b.hi[axis]])
    }

    pub(crate) fn to_f64(self) -> Aabb {
        Aabb::new(
            DVec3::from_array(self.lo.map(f64::from)),
            DVec3::from_array(self.hi.map(f64::from)),
        )
    }

    pub(crate) fn max_abs(&self) -> f64 {
        self.lo.iter().chain(&self.hi).fold(0.0, |m, x| {
            if f64::from(x.abs()) > m {
                f64::from(x.abs())
            } else {
                m
            }
        })
    }
}

/// A ray as the culling tests see it: in f32, with all rounding folded into two constants per axis.
///
/// # Why no box is lost
/// The parameter at which the ray crosses the plane `x = b` is `b r - c` with `r = 1/d` and `c = o r`. Let u = 2⁻²⁴. The loop
/// computes `fl(fl(b rd) - ĉ)` with `rd = fl(r)` (error u|br|), one product (u|br|) and one difference (u(|br| + |c|)), and ĉ itself
/// is rounded (u|c|): altogether less than `3u|r|(|b| + |o|)` to first order, `b` being exact. So with
/// `E = 8u|r|(B + |o|)`, B the largest coordinate of any plane, `ĉ = c + E` makes the computed near crossing never later than
/// the true one, and `ĉ = c - E` the far crossing never earlier. The factor 8 instead of 3 also covers hits that a
/// primitive's own rounding puts just outside of its box. (Engine design, section 3.1; there with a fused multiply-add,
/// which the baseline processor does not have.)
///
/// Rays that start far away are first moved to where they enter the structure, in f64, because E grows with |o|. Directions are
/// scaled by a power of two so that their largest component is in `1..2`, which is exact; `t` is scaled with them.
pub(crate) struct CullRay {
    axes: [CullAxis; 3],
    /// What was taken off `t`.
    offset: f64,
    /// The power of two that `t - offset` is multiplied by.
    scale: f64,
    t_min: f32,
}

/// Constants of one axis, the same in all lanes.
#[derive(Clone, Copy, Default)]
struct CullAxis {
    /// 1/d, rounded.
    rd: Vec4,
    /// `c + E`: subtracted for the plane the ray meets first.
    near: Vec4,
    /// `c - E`: subtracted for the plane the ray meets last.
    far: Vec4,
}

/// Two boxes next to each other: per axis the lower planes of both, then the upper planes of both.
pub(crate) type BoxPair = [[f32; 4]; 3];

/// Directions smaller than this fraction of the largest component are replaced by it: such a ray crosses no plane that it
/// does not run along within any distance of interest, and E then covers those it does run along.
const SMALLEST_DIRECTION: f64 = 1.0 / (1u64 << 60) as f64;

/// The factor 8u of the error bound.
const SLACK: f64 = 8.0 / (1u64 << 24) as f64;

impl CullRay {
    /// The constants for a structure inside of `bounds`, or `None` if the ray certainly misses them in `range`.
    #[inline]
    pub(crate) fn new(ray: &Ray, range: Interval, bounds: &Aabb, max_abs: f64) -> Option<Self> {
        let length = largest(ray.direction);
        if length == 0.0 {
            return None;
        }
        let (mut origin, mut offset, mut moved) = (ray.origin, 0.0, 0.0);
        // Only worth it if the origin would spoil the bound.
        if largest(origin) > 4.0 * max_abs {
            let clip = bounds.clip(ray, range)?;
            if clip.min > 0.0 && clip.min < f64::INFINITY {
                offset = clip.min;
                origin = ray.at(offset);
                // Rounding of the move: a product and a sum per coordinate.
                moved = 4.0 * f64::EPSILON * (largest(ray.origin) + offset * length);
            }
        }
        let scale = power_of_two(length);
        let shrink = 1.0 / scale;
        let margin = SLACK * max_abs + moved;
        let mut axes = [CullAxis::default(); 3];
        for (axis, constants) in axes.iter_mut().enumerate() {
            let mut d = ray.direction[axis] * shrink;
            if d.abs() < SMALLEST_DIRECTION {
                d = if d < 0.0 {
                    -SMALLEST_DIRECTION
                } else {
                    SMALLEST_DIRECTION
                };
            }
            let (r, o) = (1.0 / d, origin[axis]);
            let (c, e) = (o * r, r.abs() * (margin + SLACK * o.abs()));
            *constants = CullAxis {
                rd: Vec4::splat(r as f32),
                near: Vec4::splat((c + e) as f32),
                far: Vec4::splat((c - e) as f32),
            };
        }
        let t_min = round_down_f32(((range.min - offset) * scale).next_down());
        Some(Self {
            axes,
            offset,
            scale,
            t_min,
        })
    }

    /// An upper end of the range as the culling tests compare it: rounded up.
    #[inline]
    pub(crate) fn t_max(&self, t_max: f64) -> f32 {
        round_up_f32(((t_max - self.offset) * self.scale).next_up())
    }

    /// Where the ray enters two boxes, and which of them it may meet (bits 0 and 1).
    #[inline(always)]
    pub(crate) fn enter(&self, pair: &BoxPair, t_max: f32) -> ([f32; 2], u32) {
        let (mut near, mut far) = (Vec4::splat(self.t_min), Vec4::splat(t_max));
        for (planes, axis) in pair.iter().zip(&self.axes) {
            let crossed = Vec4::from_array(*planes) * axis.rd;
            let other = crossed.zwxy();
            // The first operand's NaN (infinity minus infinity) constrains nothing.
            near = (crossed.min(other) - axis.near).max(near);
            far = (crossed.max(other) - axis.far).min(far);
        }
        ([near.x, near.y], near.cmple(far).bitmask() & 3)
    }
}

/// The largest absolute component.
#[inline]
fn largest(v: DVec3) -> f64 {
    let v = v.abs();
    let m = if v.y > v.x { v.y } else { v.x };
    if v.z > m { v.z } else { m }
}

/// The power of two below or at a positive number: its exponent alone (1 for those whose power has no finite inverse).
#[inline]
fn power_of_two(x: f64) -> f64 {
    let power = f64::from_bits(x.to_bits() & 0x7ff0_0000_0000_0000);
    if power > 1e-300 && power < 1e300 {
        power
    } else {
        1.0
    }
}
