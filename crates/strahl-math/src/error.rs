//! All tolerances: bounds of rounding errors, all of them multiples of the unit roundoff times a
//! magnitude. Nothing here is an absolute distance, so scenes may be 1e-6 or 1e9 units large.

use crate::DVec3;

/// The unit roundoff of f64: the relative error of one correctly rounded operation.
pub const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Higham's bound on the relative error of `n` chained operations, `n u / (1 - n u)`.
///
/// Accuracy and Stability of Numerical Algorithms, section 3.1.
pub const fn gamma(n: u32) -> f64 {
    let nu = n as f64 * ROUNDOFF;
    nu / (1.0 - nu)
}

/// The largest f32 not above `x` (`-inf` if `x` is below every finite f32; NaN stays NaN).
#[inline]
pub fn round_down_f32(x: f64) -> f32 {
    let y = x as f32;
    moved(y, -i32::from(f64::from(y) > x))
}

/// The smallest f32 not below `x` (`inf` if `x` is above every finite f32; NaN stays NaN).
#[inline]
pub fn round_up_f32(x: f64) -> f32 {
    let y = x as f32;
    moved(y, i32::from(f64::from(y) < x))
}

/// The f32 that is `steps` numbers above another, without a branch, which would be mispredicted half of the time. The two zeros
/// are one step apart, which is compensated by the sign they have after rounding.
#[inline(always)]
fn moved(x: f32, steps: i32) -> f32 {
    // In this order of integers numbers follow each other as they do by size, and back.
    let ordered = |bits: i32| bits ^ (bits >> 31 & i32::MAX);
    let bits = ordered(x.to_bits() as i32).wrapping_add(steps);
    f32::from_bits(ordered(bits) as u32)
}

/// Moves a point off the surface it lies on, just far enough that it is certainly on the chosen side.
///
/// `error` bounds the distance of `position` from the true surface, coordinate by coordinate; `normal` is the unit normal
/// of the side to end up on. The result is rounded away from the surface. (Pharr, Jakob, Humphreys: Physically Based
/// Rendering, 4th ed., section 6.8.6, in f64.)
// Inline: a result that is returned in memory would be copied before its stores have ended.
#[inline(always)]
pub fn offset_origin(position: DVec3, error: DVec3, normal: DVec3) -> DVec3 {
    let distance = normal.abs().dot(error);
    let moved = position + normal * distance;
    DVec3::new(
        next_along(moved.x, normal.x),
        next_along(moved.y, normal.y),
        next_along(moved.z, normal.z),
    )
}

/// The next number above `x` if `n` is positive, the next one below it if `n` is negative, and `x` if `n` is 0 or no number.
// Without branches, so that loops over arrays become vector instructions.
#[inline(always)]
pub fn next_along(x: f64, n: f64) -> f64 {
    // Below x is what is above -x, with the other sign.
    let sign = n.to_bits() & (-0.0f64).to_bits();
    let up = f64::from_bits(x.to_bits() ^ sign) + 0.0;
    let bits = up.to_bits() as i64;
    let next = bits.wrapping_add(bits >> 63 | 1) as u64 ^ sign;
    if (n.abs() > 0.0) & (up < f64::INFINITY) {
        f64::from_bits(next)
    } else {
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outward_rounding_brackets() {
        for x in [0.1, -0.1, 1e300, -1e300, 1.0, 0.0, 1e-50] {
            assert!(
                f64::from(round_down_f32(x)) <= x && x <= f64::from(round_up_f32(x)),
                "{x}"
            );
        }
        assert_eq!(round_up_f32(1.0), 1.0);
    }

    #[test]
    fn the_next_number_along_a_direction() {
        let least = f64::from_bits(1);
        let cases = [
            0.0,
            1.0,
            0.1,
            1e300,
            least,
            f64::MIN_POSITIVE,
            f64::MAX,
            f64::INFINITY,
            f64::NAN,
        ];
        let numbers = || cases.iter().flat_map(|x| [*x, -*x]);
        for (x, n) in numbers().flat_map(|x| numbers().map(move |n| (x, n))) {
            let expected = if n > 0.0 {
                x.next_up()
            } else if n < 0.0 {
                x.next_down()
            } else {
                x
            };
            let found = next_along(x, n);
            assert!(
                found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan(),
                "{x} along {n}: {found}, not {expected}"
            );
        }
    }

    #[test]
    fn outward_rounding_takes_the_next_number_where_the_nearest_is_on_the_other_side() {
        let least = f64::from(f32::from_bits(1));
        let mut all = vec![
            0.0,
            least,
            0.4 * least,
            0.6 * least,
            1e-300,
            1e300,
            f64::INFINITY,
        ];
        all.extend((-60..60).map(|i| 1.1f64.powi(7 * i)));
        all.extend([
            1.0,
            1.0f64.next_up(),
            1.0f64.next_down(),
            f64::from(f32::MAX),
            f64::NAN,
        ]);
        for x in all.into_iter().flat_map(|x| [x, -x]) {
            let nearest = x as f32;
            let (mut down, mut up) = (nearest, nearest);
            if f64::from(nearest) > x {
                down = nearest.next_down();
            }
            if f64::from(nearest) < x {
                up = nearest.next_up();
            }
            assert_eq!(round_down_f32(x).to_bits(), down.to_bits(), "{x}");
            assert_eq!(round_up_f32(x).to_bits(), up.to_bits(), "{x}");
        }
    }

    #[test]
    fn an_offset_origin_is_strictly_on_its_side() {
        let p = DVec3::new(1e9, -3.0, 0.1);
        let n = DVec3::new(0.0, 0.6, -0.8);
        let moved = offset_origin(p, DVec3::splat(1e-15), n);
        assert!((moved - p).dot(n) > 0.0);
        assert_eq!(moved.x, p.x);
    }
}
