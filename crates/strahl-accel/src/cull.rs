use crate::boxes::BoxPair;
use strahl_math::{Aabb, DVec3, Interval, Ray, Vec4, Vec4Swizzles};
use strahl_simd::{Isa, Lanes8, Portable};

/// The data of a structure that culling tests need: its box, and the margin of their error bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CullBounds {
    /// The box around all bounded primitives.
    bounds: Aabb,
    /// B: the largest absolute coordinate of any plane of the structure.
    max_abs: f64,
    /// Origins with no larger coordinates count as near; negative if none does.
    near: f32,
    /// The part of the error bound of [`QuickLanes`] that is the same for all axes and near rays.
    margin: f32,
}

impl CullBounds {
    /// The constants of a structure whose boxes all lie inside of `bounds`, which must be bounded.
    pub(crate) fn new(bounds: Aabb) -> Self {
        // A floor keeps the margins far above f32's subnormal numbers, whose absolute rounding the derivation leaves out.
        let max_abs = bounds.max_abs();
        let max_abs = if max_abs > SMALLEST_EXTENT {
            max_abs
        } else {
            SMALLEST_EXTENT
        };
        Self {
            bounds,
            max_abs,
            near: if max_abs >= SMALLEST_QUICK {
                (NEAR * max_abs) as f32
            } else {
                -1.0
            },
            margin: (QUICK_SLACK * max_abs) as f32,
        }
    }

    /// The constants of a structure around the origin that reaches this far along every axis, from 2⁻⁶⁴ to 2⁶⁴; origins up to `near`
    /// count as near.
    #[inline(always)]
    pub(crate) fn of_unit(reach: f64, near: f32) -> Self {
        Self {
            bounds: Aabb::new(DVec3::splat(-reach), DVec3::splat(reach)),
            max_abs: reach,
            near,
            margin: (QUICK_SLACK * reach) as f32,
        }
    }

    /// The box around all bounded primitives.
    pub(crate) fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    /// Origins with no larger coordinates count as near; negative if none does.
    #[inline(always)]
    pub(crate) fn near(&self) -> f32 {
        self.near
    }

    /// The part of the error bound of [`QuickLanes`] that is the same for all axes and near rays.
    #[inline(always)]
    pub(crate) fn margin(&self) -> f32 {
        self.margin
    }

    /// B: the largest absolute coordinate of any plane of the structure.
    #[inline(always)]
    pub(crate) fn max_abs(&self) -> f64 {
        self.max_abs
    }
}

/// A ray for culling tests: in f32, with all rounding errors combined into two constants per axis.
///
/// # Why no box is lost
/// The parameter at which the ray crosses the plane `x = b` is `b r - c` with `r = 1/d` and `c = o r`. Let u = 2⁻²⁴. The loop
/// computes `fl(fl(b rd) - ĉ)` with `rd = fl(r)` (error u|br|), one product (u|br|) and one difference (u(|br| + |c|)), and ĉ
/// itself is rounded (u|c|): altogether at most `3u|r|(|b| + |o|)` to first order, `b` being exact; the f64 roundings of r and c
/// are 2⁻²⁹ of that. So with `E = 8u|r|(B + |o|)`, B the largest coordinate of any plane, `ĉ = c + E` makes the computed near
/// crossing never later than the true one, and `ĉ = c - E` the far crossing never earlier. The factor 8 instead of 3 also covers
/// hits that a primitive's own rounding puts just outside of its box. A fused multiply-add rounds once less.
///
/// E grows with |o|, so a ray that starts far away is first moved to where it enters the structure, in f64. Directions are scaled
/// by a power of two so that their largest component is in `1..2`, which is exact; `t` is scaled with them.
///
/// Boxes end at 2⁶⁴ and scaled directions at 2⁻⁶⁰, so no product overflows and no difference is a NaN: the minima and maxima of
/// the loop mean the same on every processor.
///
/// The vector loops compare the bits of the numbers as integers ([`Isa::max_bits`]). The latest start of three slabs and of the range is at 0 or
/// later for rays that begin at 0 or later, and so it is found; the earliest end is found unless it is negative, and then another negative one is, so
/// that the box is left out as it must be. For lines, whose range begins before 0, the start may be too early and the end too late: more boxes
/// are met, and none is lost.
pub(crate) struct CullRay {
    axes: [CullAxis; 3],
    clock: CullClock,
    t_min: f32,
}

/// The parameter `t` in the units of the culling tests.
#[derive(Clone, Copy)]
pub(crate) struct CullClock {
    /// Subtracted from `t`.
    offset: f64,
    /// The power of two that `t - offset` is multiplied by.
    scale: f64,
}

impl CullClock {
    /// The parameter unchanged, for rays that are not used.
    pub(crate) const UNUSED: Self = Self {
        offset: 0.0,
        scale: 1.0,
    };

    /// A lower end of the range: rounded down, but not below 0 for rays that begin at 0 or later. Such a ray, moved or not, meets a box
    /// at parameters from 0 on, and the computed end of the box is not before the true one.
    #[inline(always)]
    pub(crate) fn t_min(&self, t_min: f64) -> f32 {
        let (start, error) = rounded((t_min - self.offset) * self.scale);
        let low = start - error;
        if t_min >= 0.0 && low <= 0.0 { 0.0 } else { low }
    }

    /// An upper end of the range: rounded up.
    #[inline(always)]
    pub(crate) fn t_max(&self, t_max: f64) -> f32 {
        let (t_max, error) = rounded((t_max - self.offset) * self.scale);
        t_max + error
    }
}

/// A ray near a structure, before its constants are computed.
pub(crate) struct CullStart {
    origin: DVec3,
    /// Not yet divided by `power`.
    direction: DVec3,
    power: f64,
    /// The part of the error bound that is the same for all axes, without the factor |r|.
    margin: f64,
    pub(crate) clock: CullClock,
}

/// The constants of the three axes, and an unused fourth lane.
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
                // The way to the structure has overflowed, so no finite t reaches it.
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

    /// The constants for planes that are given relative to a point f: per axis the least and the greatest summand, so that the
    /// crossing of a plane b is between `(b - f) r` plus the one and plus the other.
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

/// The constants of the three axes in the first three lanes of vectors.
///
/// # Why no box is lost
/// For most rays they are made in f32: those that start near the structure, along directions whose largest component is between 2⁻²⁰ and
/// 2²⁰, which need no scale. In the terms of [`CullRay`]: o and d are rounded first, so `rd = fl(1/fl(d))` is wrong by 2u|r|, and the
/// constant, fused or not, by at most u|c| for o, 2u|c| for rd, u|c| for the product and u(|c| + E) for the sum with E. The loop adds
/// u|br| for its product and u(|br| + |c| + E) for its difference: altogether at most `u|r|(4|b| + 6|o|)` to first order. E is
/// `12u|r|(B + |o|)`, rounded by less than 6uE; what is left has room for a primitive's own rounding, as there.
///
/// Reciprocals end at 2⁶⁰ too. A ray with a component below 2⁻⁶⁰ moves by less than 2⁻³⁹(B + |o|) along that axis while it crosses the
/// structure, far less than the E of the axis is wide. With B from 2⁻⁶⁴ to 2⁶⁴ no sum is above 2¹²⁷ and no E below 2⁻¹⁰⁵, so the
/// subnormal numbers do not matter.
pub(crate) struct QuickLanes<I: Isa> {
    /// 1/d, rounded.
    pub(crate) rd: I::F32x8,
    /// `-(c + E)`.
    pub(crate) minus_near: I::F32x8,
    /// `-(c - E)`.
    pub(crate) minus_far: I::F32x8,
    /// The axes along which the ray goes down, as bits; the other bits are not used.
    pub(crate) down: u32,
    pub(crate) clock: CullClock,
}

impl<I: Isa> QuickLanes<I> {
    /// The constants of a ray, or `None` if it certainly misses the structure in `range`.
    #[inline(always)]
    pub(crate) fn new(isa: I, ray: &Ray, range: Interval, structure: &CullBounds) -> Option<Self> {
        let (o, d) = (ray.origin, ray.direction);
        let o = isa.narrow_f32(isa.load(&[o.x, o.y, o.z, 0.0]));
        let d = isa.narrow_f32(isa.load(&[d.x, d.y, d.z, 1.0]));
        let (length, distance) = (isa.abs_f32(d), isa.abs_f32(o));
        // The fourth lane passes; NaN does not.
        let usable = isa.le_f32(length, isa.splat_f32(LONGEST_QUICK))
            & isa.le_f32(distance, isa.splat_f32(structure.near))
            & 15;
        let long = isa.le_f32(isa.splat_f32(1.0 / LONGEST_QUICK), length) & 7;
        if usable != 15 || long == 0 {
            return Self::unusual(isa, ray, range, structure);
        }
        let most = isa.splat_f32(MOST_RECIPROCAL as f32);
        let zero = isa.splat_f32(0.0);
        let r = isa.div_f32(isa.splat_f32(1.0), d);
        let r = isa.max_f32(isa.min_f32(r, most), isa.sub_f32(zero, most));
        let slack = isa.splat_f32(QUICK_SLACK as f32);
        let reach = isa.mul_add(distance, slack, isa.splat_f32(structure.margin));
        let e = isa.mul_f32(isa.abs_f32(r), reach);
        let minus_o = isa.sub_f32(zero, o);
        Some(Self {
            rd: r,
            minus_near: isa.mul_sub(minus_o, r, e),
            minus_far: isa.mul_add(minus_o, r, e),
            down: isa.lt_f32(r, zero),
            clock: CullClock::UNUSED,
        })
    }

    /// The same for rays from far away, for directions that need a scale, and for invalid rays.
    #[inline(always)]
    fn unusual(isa: I, ray: &Ray, range: Interval, structure: &CullBounds) -> Option<Self> {
        let (lanes, clock) = of_unusual(ray, range, structure)?;
        Some(Self {
            rd: isa.load_f32(&eight(lanes.rd)),
            minus_near: isa.load_f32(&eight(lanes.minus_near)),
            minus_far: isa.load_f32(&eight(lanes.minus_far)),
            down: lanes.down,
            clock,
        })
    }
}

/// Four numbers, and zeros.
fn eight([x, y, z, w]: [f32; 4]) -> Lanes8 {
    Lanes8([x, y, z, w, 0.0, 0.0, 0.0, 0.0])
}

/// Not inlined where the constants of most rays are made.
#[cold]
#[inline(never)]
fn of_unusual(
    ray: &Ray,
    range: Interval,
    structure: &CullBounds,
) -> Option<(CullLanes, CullClock)> {
    let start = CullStart::new(ray, range, structure)?;
    Some((start.lanes(Portable), start.clock))
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
pub(crate) const MOST_RECIPROCAL: f64 = (1u64 << 60) as f64;

/// The least B: 2⁻⁹⁶.
const SMALLEST_EXTENT: f64 = 1.0 / (1u128 << 96) as f64;

/// Directions with a larger component are scaled.
pub(crate) const LONGEST_QUICK: f32 = (1u32 << 20) as f32;

/// Structures with a smaller B have no quick rays: 2⁻⁶⁴.
const SMALLEST_QUICK: f64 = 1.0 / (1u128 << 64) as f64;

/// The factor 12u of the error bound of [`QuickLanes`].
pub(crate) const QUICK_SLACK: f64 = 12.0 / (1u64 << 24) as f64;

/// The factor 8u of the error bound.
const SLACK: f64 = 8.0 / (1u64 << 24) as f64;

/// Origins further away than this many times B are moved to the structure.
const FAR: f64 = 4.0;

/// Origins no further away than this many times B are ordinary for [`QuickLanes`]: boxes grow by at most 12u times that, 5e-5 of B. Many
/// eyes and lights are further than [`FAR`] from what they look at.
pub(crate) const NEAR: f64 = 64.0;

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

    /// An upper end of the range for culling tests: rounded up.
    #[inline]
    pub(crate) fn t_max(&self, t_max: f64) -> f32 {
        self.clock.t_max(t_max)
    }

    /// The parameters at which the ray enters two boxes, and the boxes that it may meet (bits 0 and 1).
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
    // Adding positive numbers gives NaN only if one of them is NaN.
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

/// A bound of `t` in f32, generously enlarged by the rounding errors of `t` itself, of the difference and the product that it
/// is computed from, and of the sum that it is compared with.
#[inline]
pub(crate) fn rounded(t: f64) -> (f32, f32) {
    let t = t as f32;
    (t, t.abs() * (2.0 * f32::EPSILON) + f32::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_simd::{Simd, dispatch};

    /// Numbers in 0..1.
    struct Unit(u64);

    impl Unit {
        fn next(&mut self) -> f64 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (self.0 >> 11) as f64 / (1u64 << 53) as f64
        }

        /// In -1..1, and some of them very small.
        fn signed(&mut self) -> f64 {
            let small = [1.0, 1.0, 1e-3, 1e-9, 1e-30][(self.next() * 5.0) as usize];
            (2.0 * self.next() - 1.0) * small
        }

        fn point(&mut self) -> DVec3 {
            DVec3::new(self.signed(), self.signed(), self.signed())
        }
    }

    /// The constants of the first three lanes: 1/d, and what is added for near and for far planes.
    fn constants(simd: Simd, ray: &Ray, structure: &CullBounds) -> Option<[[f32; 8]; 3]> {
        dispatch!(simd, isa => {
            QuickLanes::new(isa, ray, Interval::LINE, structure).map(|lanes| [
                isa.store_f32(lanes.rd).0,
                isa.store_f32(lanes.minus_near).0,
                isa.store_f32(lanes.minus_far).0,
            ])
        })
    }

    #[test]
    fn near_crossings_are_never_late_nor_far_ones_early() {
        let mut unit = Unit(7);
        let mut checked = 0;
        for round in 0..40_000 {
            let extent = [1.0, 1e-9, 1e6, 1e18, 2e-19][round % 5];
            let structure = CullBounds::new(Aabb::new(DVec3::splat(-extent), DVec3::splat(extent)));
            let length = [1.0, 1e-5, 9e5, 0.1][round / 5 % 4];
            let ray = Ray::new(
                unit.point() * extent * [0.9, 3.9][round % 2],
                unit.point() * length,
            );
            let clock_is_plain = (1e-6..1e6).contains(&ray.direction.abs().max_element());
            for simd in Simd::available() {
                let Some([rd, near, far]) = constants(simd, &ray, &structure) else {
                    panic!("{ray:?} is near");
                };
                for axis in (0..3).filter(|_| clock_is_plain) {
                    let (o, d) = (ray.origin[axis], ray.direction[axis]);
                    // A plane anywhere, and those beside the origin.
                    let beside = o as f32;
                    let planes = [
                        (unit.signed() * extent) as f32,
                        beside,
                        beside.next_up(),
                        beside.next_down(),
                    ];
                    for b in planes.into_iter().filter(|b| f64::from(b.abs()) <= extent) {
                        let distance = f64::from(b) - o;
                        let t = distance / d;
                        let (fused, twice) =
                            (b.mul_add(rd[axis], near[axis]), b * rd[axis] + near[axis]);
                        let (late, last) =
                            (b.mul_add(rd[axis], far[axis]), b * rd[axis] + far[axis]);
                        if d.abs() >= 1.0 / MOST_RECIPROCAL {
                            assert!(
                                f64::from(fused) <= t && f64::from(twice) <= t,
                                "{ray:?} {b}"
                            );
                            assert!(f64::from(late) >= t && f64::from(last) >= t, "{ray:?} {b}");
                            checked += 1;
                        } else if distance.abs() <= 2.0 * f64::from(f32::EPSILON) * o.abs() {
                            // Beside the plane all the way, as far as the structure reaches.
                            let way = 8.0 * extent / f64::from(1.0 / LONGEST_QUICK);
                            assert!(f64::from(fused) <= -way && f64::from(twice) <= -way);
                            assert!(f64::from(late) >= way && f64::from(last) >= way);
                            checked += 1;
                        }
                    }
                }
            }
        }
        assert!(checked > 400_000, "{checked}");
    }

    #[test]
    fn rays_that_are_none_and_far_ones_are_told_apart() {
        let structure = CullBounds::new(Aabb::new(DVec3::ZERO, DVec3::ONE));
        let simd = Simd::detect();
        let none = [
            Ray::new(DVec3::ZERO, DVec3::ZERO),
            Ray::new(DVec3::splat(f64::NAN), DVec3::X),
            Ray::new(DVec3::ZERO, DVec3::new(f64::INFINITY, 0.0, 0.0)),
            Ray::new(DVec3::ZERO, DVec3::new(1.0, f64::NAN, 0.0)),
            // From far away, past it.
            Ray::new(DVec3::splat(1e6), DVec3::X),
        ];
        for ray in none {
            assert_eq!(constants(simd, &ray, &structure), None, "{ray:?}");
        }
        for ray in [
            Ray::new(DVec3::splat(-1e9), DVec3::ONE),
            Ray::new(DVec3::ZERO, DVec3::X * 1e-200),
            Ray::new(DVec3::ZERO, DVec3::X * 1e200),
        ] {
            assert!(constants(simd, &ray, &structure).is_some(), "{ray:?}");
        }
    }
}
