use crate::boxes::BoxPair;
use strahl_math::{Aabb, DVec3, Interval, Ray, Vec4, Vec4Swizzles};
use strahl_simd::Isa;

/// What the culling tests must know about a structure: its box, and the margin of their error bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CullBounds {
    /// The box around everything bounded.
    bounds: Aabb,
    /// B: no plane of the structure is further from the coordinate planes.
    max_abs: f64,
}

impl CullBounds {
    /// The constants of a structure whose boxes all lie inside of `bounds`, which must be bounded.
    pub(crate) fn new(bounds: Aabb) -> Self {
        // A floor keeps the margins far above f32's subnormal numbers, whose absolute rounding the derivation leaves out.
        let max_abs = bounds.max_abs();
        Self {
            bounds,
            max_abs: if max_abs > SMALLEST_EXTENT {
                max_abs
            } else {
                SMALLEST_EXTENT
            },
        }
    }

    /// The box around everything bounded.
    pub(crate) fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    /// B: no plane of the structure is further from the coordinate planes.
    #[inline(always)]
    pub(crate) fn max_abs(&self) -> f64 {
        self.max_abs
    }
}

/// A ray as the culling tests see it: in f32, with all rounding folded into two constants per axis.
///
/// # Why no box is lost
/// The parameter at which the ray crosses the plane `x = b` is `b r - c` with `r = 1/d` and `c = o r`. Let u = 2⁻²⁴. The loop
/// computes `fl(fl(b rd) - ĉ)` with `rd = fl(r)` (error u|br|), one product (u|br|) and one difference (u(|br| + |c|)), and ĉ
/// itself is rounded (u|c|): altogether at most `3u|r|(|b| + |o|)` to first order, `b` being exact; the f64 roundings of r and c
/// are 2⁻²⁹ of that. So with `E = 8u|r|(B + |o|)`, B the largest coordinate of any plane, `ĉ = c + E` makes the computed near
/// crossing never later than the true one, and `ĉ = c - E` the far crossing never earlier. The factor 8 instead of 3 also covers
/// hits that a primitive's own rounding puts just outside of its box. A fused multiply-add rounds once less.
/// (Engine design, section 3.1.)
///
/// E grows with |o|, so a ray that starts far away is first moved to where it enters the structure, in f64. Directions are scaled
/// by a power of two so that their largest component is in `1..2`, which is exact; `t` is scaled with them.
///
/// Boxes end at 2⁶⁴ and scaled directions at 2⁻⁶⁰, so no product overflows and no difference is a NaN: the minima and maxima of
/// the loop mean the same on every processor.
pub(crate) struct CullRay {
    axes: [CullAxis; 3],
    clock: CullClock,
    t_min: f32,
}

/// How the culling tests count `t`.
#[derive(Clone, Copy)]
pub(crate) struct CullClock {
    /// What was taken off `t`.
    offset: f64,
    /// The power of two that `t - offset` is multiplied by.
    scale: f64,
}

impl CullClock {
    /// That of no ray.
    pub(crate) const UNUSED: Self = Self {
        offset: 0.0,
        scale: 1.0,
    };

    /// A lower end of the range: rounded down.
    #[inline(always)]
    pub(crate) fn t_min(&self, t_min: f64) -> f32 {
        let (t_min, error) = rounded((t_min - self.offset) * self.scale);
        t_min - error
    }

    /// An upper end of the range: rounded up.
    #[inline(always)]
    pub(crate) fn t_max(&self, t_max: f64) -> f32 {
        let (t_max, error) = rounded((t_max - self.offset) * self.scale);
        t_max + error
    }
}

/// A ray near a structure, before its constants are made.
pub(crate) struct CullStart {
    origin: DVec3,
    /// Not yet divided by `power`.
    direction: DVec3,
    power: f64,
    /// The part of the error bound that is the same for all axes, without the factor |r|.
    margin: f64,
    pub(crate) clock: CullClock,
}

/// The constants of the three axes, and a fourth that means nothing.
pub(crate) struct CullLanes {
    /// 1/d, rounded.
    pub(crate) rd: [f32; 4],
    /// `-(c + E)`: added for the plane the ray meets first.
    pub(crate) minus_near: [f32; 4],
    /// `-(c - E)`: added for the plane the ray meets last.
    pub(crate) minus_far: [f32; 4],
    /// The axes along which the ray goes down, as bits.
    pub(crate) down: u32,
}

impl CullStart {
    /// The ray moved to a structure if that is far away, or `None` if it certainly misses it in `range`.
    #[inline(always)]
    pub(crate) fn new(ray: &Ray, range: Interval, structure: &CullBounds) -> Option<Self> {
        let distance = largest(ray.origin);
        let scaling = Scaling::of(ray.direction)?;
        let scale = scaling.scale;
        let (mut origin, mut offset) = (ray.origin, 0.0);
        let mut margin = SLACK * structure.max_abs;
        if distance > FAR * structure.max_abs {
            if distance == f64::INFINITY {
                return None;
            }
            margin += FAR_SLACK * distance;
            let padded = structure.bounds.padded(DVec3::splat(margin));
            offset = padded.clip(ray, range)?.min;
            origin = ray.at(offset);
            if !(largest(origin) <= FAR * (structure.max_abs + margin)) {
                // The way to the structure has overflowed: no finite t reaches it.
                return None;
            }
        }
        Some(Self {
            origin,
            direction: scaling.direction,
            power: scaling.power,
            margin,
            clock: CullClock { offset, scale },
        })
    }

    /// 1/d for the scaled direction. The division need not wait for the scale, a power of two.
    #[inline(always)]
    fn reciprocal(&self, axis: usize) -> f64 {
        let r = 1.0 / self.direction[axis] * self.power;
        r.clamp(-MOST_RECIPROCAL, MOST_RECIPROCAL)
    }

    /// The origin and 1/d for the scaled direction, axis beside axis.
    #[inline(always)]
    fn vectors<I: Isa>(&self, isa: I) -> (I::F64x4, I::F64x4) {
        let (o, d) = (self.origin, self.direction);
        let o = isa.load(&[o.x, o.y, o.z, 0.0]);
        let d = isa.load(&[d.x, d.y, d.z, 1.0]);
        let most = isa.splat(MOST_RECIPROCAL);
        let r = isa.mul(isa.div(isa.splat(1.0), d), isa.splat(self.power));
        let r = isa.max(isa.min(r, most), isa.splat(-MOST_RECIPROCAL));
        (o, r)
    }

    /// What [`CullRay::new`] computes, axis beside axis.
    #[inline(always)]
    pub(crate) fn lanes<I: Isa>(&self, isa: I) -> CullLanes {
        let (o, r) = self.vectors(isa);
        let zero = isa.splat(0.0);
        let minus_c = isa.mul(isa.sub(zero, o), r);
        let reach = isa.add(
            isa.splat(self.margin),
            isa.mul(isa.splat(SLACK), isa.abs(o)),
        );
        let e = isa.mul(isa.abs(r), reach);
        CullLanes {
            rd: isa.narrow(r),
            minus_near: isa.narrow(isa.sub(minus_c, e)),
            minus_far: isa.narrow(isa.add(minus_c, e)),
            down: isa.lt(r, zero),
        }
    }

    /// The constants for planes that are given relative to a point f: per axis what is added at least and at most, so that
    /// the crossing of a plane b is between `(b - f) r` plus the one and plus the other.
    ///
    /// The crossing is at `(b - f) r - (o - f) r`. Rounded are the difference b - f, the product, their sum, r, and the constant: by
    /// 5u|r|(B + |o| + |f|) at most. The margin is three times that, with room for a primitive's own rounding.
    #[inline(always)]
    pub(crate) fn relative_to<I: Isa>(&self, isa: I, point: &[f64; 4]) -> [[f32; 4]; 2] {
        let (o, r) = self.vectors(isa);
        let f = isa.load(point);
        let minus_c = isa.mul(isa.sub(f, o), r);
        let sizes = isa.add(isa.abs(o), isa.abs(f));
        let reach = isa.add(
            isa.splat(2.0 * self.margin),
            isa.mul(isa.splat(2.0 * SLACK), sizes),
        );
        let e = isa.mul(isa.abs(r), reach);
        [
            isa.narrow(isa.sub(minus_c, e)),
            isa.narrow(isa.add(minus_c, e)),
        ]
    }
}

/// Constants of one axis.
#[derive(Clone, Copy, Default)]
struct CullAxis {
    /// 1/d, rounded.
    rd: f32,
    /// `c + E`: subtracted for the plane the ray meets first.
    near: f32,
    /// `c - E`: subtracted for the plane the ray meets last.
    far: f32,
}

/// Reciprocals of components of a scaled direction end here: 2⁶⁰. While it crosses the structure a ray whose component is smaller
/// moves by less than 2⁻⁵⁷(B + |o|) along that axis, far less than E: it stays in the slab it is in, and so the test sees it.
const MOST_RECIPROCAL: f64 = (1u64 << 60) as f64;

/// The least B: 2⁻⁹⁶.
const SMALLEST_EXTENT: f64 = 1.0 / (1u128 << 96) as f64;

/// The factor 8u of the error bound.
const SLACK: f64 = 8.0 / (1u64 << 24) as f64;

/// Origins further away than this many times B are moved to the structure.
const FAR: f64 = 4.0;

/// Rounding errors of a ray that is moved from far away, per |o|: those of the move (a product and a sum per coordinate), and
/// those that a primitive makes that does not move the ray.
const FAR_SLACK: f64 = 32.0 * f64::EPSILON;

impl CullRay {
    /// The constants for a structure, or `None` if the ray certainly misses it in `range`.
    ///
    /// A ray with a coordinate that is not finite, or without a direction, meets nothing.
    #[inline(always)]
    pub(crate) fn new(ray: &Ray, range: Interval, structure: &CullBounds) -> Option<Self> {
        let start = CullStart::new(ray, range, structure)?;
        let mut axes = [CullAxis::default(); 3];
        for (axis, constants) in axes.iter_mut().enumerate() {
            let (r, o) = (start.reciprocal(axis), start.origin[axis]);
            let (c, e) = (o * r, r.abs() * (start.margin + SLACK * o.abs()));
            *constants = CullAxis {
                rd: r as f32,
                near: (c + e) as f32,
                far: (c - e) as f32,
            };
        }
        let clock = start.clock;
        Some(Self {
            axes,
            clock,
            t_min: clock.t_min(range.min),
        })
    }

    /// An upper end of the range as the culling tests compare it: rounded up.
    #[inline]
    pub(crate) fn t_max(&self, t_max: f64) -> f32 {
        self.clock.t_max(t_max)
    }

    /// Where the ray enters two boxes, and which of them it may meet (bits 0 and 1).
    #[inline(always)]
    pub(crate) fn enter(&self, pair: &BoxPair, t_max: f32) -> ([f32; 2], u32) {
        let (mut near, mut far) = (Vec4::splat(self.t_min), Vec4::splat(t_max));
        for (planes, axis) in pair.iter().zip(&self.axes) {
            let crossed = Vec4::from_array(*planes) * Vec4::splat(axis.rd);
            let other = crossed.zwxy();
            near = (crossed.min(other) - Vec4::splat(axis.near)).max(near);
            far = (crossed.max(other) - Vec4::splat(axis.far)).min(far);
        }
        ([near.x, near.y], near.cmple(far).bitmask() & 3)
    }
}

/// The largest absolute component; infinite if any is infinite or NaN.
#[inline]
pub(crate) fn largest(v: DVec3) -> f64 {
    let v = v.abs();
    let m = if v.y > v.x { v.y } else { v.x };
    let m = if v.z > m { v.z } else { m };
    // Positive numbers make no NaN of their own.
    if (v.x + v.y + v.z).is_nan() {
        f64::INFINITY
    } else {
        m
    }
}

/// A direction with the power of two that brings its largest component into `1..2` by division.
struct Scaling {
    /// The direction, or, if it is very short, [`LIFT`] times it.
    direction: DVec3,
    /// The power for that.
    power: f64,
    /// The power for the direction itself.
    scale: f64,
}

/// Directions shorter than this are lifted, exactly: of others only components that are negligible have reciprocals beyond the
/// range of f64. 2⁻⁹⁶⁰.
const SHORT: f64 = f64::MIN_POSITIVE * (1u64 << 62) as f64;

const LIFT: f64 = (1u64 << 54) as f64;

impl Scaling {
    /// `None` for no direction and for what is not finite.
    #[inline(always)]
    fn of(direction: DVec3) -> Option<Self> {
        let length = largest(direction);
        if (SHORT..=f64::MAX).contains(&length) {
            let power = power_of_two(length);
            return Some(Self {
                direction,
                power,
                scale: power,
            });
        }
        Self::unusual(direction, length)
    }

    #[cold]
    fn unusual(direction: DVec3, length: f64) -> Option<Self> {
        let power = power_of_two(length * LIFT);
        (length > 0.0 && length < f64::INFINITY).then(|| Self {
            direction: direction * LIFT,
            power,
            scale: power / LIFT,
        })
    }
}

/// The direction divided by a power of two that brings its largest component into `1..2`, and that power; `None` for zero
/// and for what is not finite.
#[inline]
pub(crate) fn scaled(direction: DVec3) -> Option<(DVec3, f64)> {
    let s = Scaling::of(direction)?;
    // The power is exact, and so is the quotient but for components that are negligible.
    Some((s.direction / s.power, s.scale))
}

/// The largest power of two that is not above a normal number: its exponent alone.
#[inline]
fn power_of_two(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & f64::INFINITY.to_bits())
}

/// A bound of `t` in f32 and what its rounding may have changed at most, generously: `t` itself, the difference and the
/// product it comes from, and the sum that this is added by.
#[inline]
pub(crate) fn rounded(t: f64) -> (f32, f32) {
    let t = t as f32;
    (t, t.abs() * (2.0 * f32::EPSILON) + f32::MIN_POSITIVE)
}
