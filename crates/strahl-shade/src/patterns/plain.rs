//! Patterns that are a plain formula.

use strahl_math::{DVec3, det};

use super::modifiers::triangle;
use super::{Modifiers, TexturePoint};

/// 1 at zero, falling to 0 at distance 1.
fn fading(distance: f64) -> f64 {
    if distance < 1.0 { 1.0 - distance } else { 0.0 }
}

pub(super) fn boxed(p: DVec3) -> f64 {
    fading(p.abs().max_element())
}

pub(super) fn cylindrical(p: DVec3) -> f64 {
    fading((p.x * p.x + p.z * p.z).sqrt())
}

pub(super) fn planar(p: DVec3) -> f64 {
    fading(p.y.abs())
}

pub(super) fn spherical(p: DVec3) -> f64 {
    fading(p.length())
}

/// Values above 1 are taken modulo 1 here, exactly; [`Modifiers::shape`] deals with the rest.
pub(super) fn wrapped(x: f64) -> f64 {
    if x > 1.0 { fraction(x) } else { x }
}

/// `x % 1.0` of a number that is not negative, with the same bits.
fn fraction(x: f64) -> f64 {
    /// Numbers from here on take the library's function, which is slow.
    const FAR: f64 = (1u64 << 32) as f64;
    if x < FAR {
        x - f64::from(x as u32)
    } else {
        x % 1.0
    }
}

pub(super) fn gradient(p: DVec3, direction: DVec3) -> f64 {
    wrapped(p.dot(direction.normalize_or_zero()))
}

pub(super) fn leopard(p: DVec3) -> f64 {
    let s = (det::sin(p.x) + det::sin(p.y) + det::sin(p.z)) / 3.0;
    s * s
}

pub(super) fn onion(p: DVec3) -> f64 {
    fraction(p.length())
}

/// The angle around the y axis in turns, `1/4..=5/4`; 1/4 near the axis (measured).
pub(super) fn radial(p: DVec3) -> f64 {
    use std::f64::consts::{PI, TAU};
    if p.x.abs() < 0.001 && p.z.abs() < 0.001 {
        return 0.25;
    }
    0.25 + (det::atan2(p.x, p.z) + PI) / TAU
}

/// The angle around the z axis in turns, `0..1`, from the negative y axis; 0 on the axis (measured).
fn turn(p: DVec3) -> f64 {
    if p.x == 0.0 && p.y == 0.0 {
        return 0.0;
    }
    let turn = 0.25 + det::atan2(p.y, p.x) / std::f64::consts::TAU;
    if turn < 0.0 { turn + 1.0 } else { turn }
}

/// Besides moving the point, the turbulence of the spirals shifts the value.
fn spiral_shift(p: DVec3, modifiers: &Modifiers) -> f64 {
    let strength = modifiers.turbulence.x;
    if strength == 0.0 {
        0.0
    } else {
        strength * modifiers.octaves.scalar(p, modifiers.noise)
    }
}

pub(super) fn spiral1(p: DVec3, arms: f64, modifiers: &Modifiers) -> f64 {
    let r = (p.x * p.x + p.y * p.y).sqrt();
    p.z + r + arms * turn(p) + spiral_shift(p, modifiers)
}

pub(super) fn spiral2(p: DVec3, arms: f64, modifiers: &Modifiers) -> f64 {
    let r = (p.x * p.x + p.y * p.y).sqrt();
    triangle(spiral1(p, arms, modifiers)) + triangle(r)
}

/// The cubic Bézier profile of a cushion, with ordinates 0, c₀, c₁, 1 over the distance `t` from its middle.
fn cushion(t: f64, [c0, c1]: [f64; 2]) -> f64 {
    let s = 1.0 - t;
    t * (3.0 * s * (c0 * s + c1 * t) + t * t)
}

/// From the middle of the unit cube around `p` to `p`.
fn from_middle(p: DVec3) -> DVec3 {
    p - p.floor() - DVec3::splat(0.5)
}

/// 2/√3: the reciprocal of the distance of a unit cube's corners from its middle.
const CUSHION_SCALE: f64 = 1.154_700_538_379_251_5;

/// The cushion's profile times the mean of the distances along the axes, scaled to 1 at the cube's corners.
pub(super) fn quilted(p: DVec3, controls: [f64; 2]) -> f64 {
    let v = from_middle(p);
    let mean = (v.x.abs() + v.y.abs() + v.z.abs()) / 3.0;
    cushion(v.length(), controls) * mean * CUSHION_SCALE
}

/// Where cushions tilt a normal: outwards, by their profile.
pub(crate) fn quilted_tilt(p: DVec3, controls: [f64; 2]) -> DVec3 {
    let v = from_middle(p);
    v * (cushion(v.length(), controls) * CUSHION_SCALE)
}

/// What the slope pattern compares the normal with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SlopeReference {
    /// A direction; its length is the weight of the slope against [`Altitude`].
    Direction(DVec3),
    /// The direction towards a point.
    Point(DVec3),
}

/// The gradient mixed into the slope pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Altitude {
    /// Direction of the gradient; its length is its weight.
    pub direction: DVec3,
    /// The heights that become 0 and 1; equal values mean 0 and 1.
    pub range: [f64; 2],
}

/// `x` with `range` carried to `0..1`.
fn rescaled(x: f64, [low, high]: [f64; 2]) -> f64 {
    if high == low {
        x
    } else {
        (x - low) / (high - low)
    }
}

/// `1 - angle/π` for the angle between a normal and a direction: 1 along, 1/2 across, 0 against. A normal that is not of unit
/// length is taken as it is (measured).
fn alignment(n: DVec3, direction: DVec3) -> f64 {
    let cos = n.dot(direction.normalize_or_zero());
    1.0 - det::acos(cos.clamp(-1.0, 1.0)) / std::f64::consts::PI
}

/// 0 where there is no surface (measured).
pub(super) fn aoi(point: &TexturePoint) -> f64 {
    if point.n_shade == DVec3::ZERO {
        return 0.0;
    }
    alignment(point.n_shade.normalize_or_zero(), -point.direction)
}

/// The normal is the surface's, whatever transformation the pattern has; the altitude is that of the moved point `p`. 0 where there is no surface
/// (measured).
pub(super) fn slope(
    p: DVec3,
    point: &TexturePoint,
    reference: &SlopeReference,
    range: [f64; 2],
    altitude: Option<&Altitude>,
) -> f64 {
    if point.n_shade == DVec3::ZERO {
        return 0.0;
    }
    let direction = match reference {
        SlopeReference::Direction(direction) => *direction,
        SlopeReference::Point(target) => *target - point.surface,
    };
    let mut value = rescaled(alignment(point.n_shade, direction), range);
    if let Some(altitude) = altitude {
        let (a, b) = (direction.length(), altitude.direction.length());
        let height = p.dot(altitude.direction.normalize_or_zero());
        let height = rescaled(height, altitude.range);
        if a + b > 0.0 {
            value = (a * value + b * height) / (a + b);
        }
    }
    // Values beside the ranges begin again before `frequency` counts (measured).
    if (0.0..=1.0).contains(&value) {
        value
    } else {
        value - value.floor()
    }
}
