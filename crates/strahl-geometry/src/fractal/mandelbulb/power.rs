//! The powers of points in space: lengths are raised, angles from the z axis and around it are multiplied.
//!
//! With `ρ = √(x² + y²)` and complex numbers `w = z + i ρ` and `v = (x + i y) / ρ`, the power of `(x, y, z)` is
//! `(Im wⁿ Re vⁿ, Im wⁿ Im vⁿ, Re wⁿ)`: products and one square root, no angles.
//!
//! It turns lengths into lengths. In spherical coordinates its derivative is diagonal: `n rⁿ⁻¹` outwards and along meridians, and
//! `n rⁿ⁻¹ |sin nθ / sin θ|` along parallels; the last factor is at most `n`, and at most `1 / sin θ`. So a ball around a point is mapped
//! into a ball, whose radius is bounded by the greatest of these factors in it.

use strahl_math::DVec3;

/// A complex number.
type Complex = (f64, f64);

#[inline(always)]
fn product(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

/// A whole power, at least 1.
#[inline(always)]
fn raised(base: Complex, power: u32) -> Complex {
    let (mut result, mut square, mut bits) = ((1.0, 0.0), base, power);
    loop {
        if bits & 1 == 1 {
            result = product(result, square);
        }
        bits >>= 1;
        if bits == 0 {
            return result;
        }
        square = product(square, square);
    }
}

/// The power of a point; on the z axis the limit.
#[inline(always)]
pub(super) fn power(p: DVec3, n: u32) -> DVec3 {
    let rho = (p.x * p.x + p.y * p.y).sqrt();
    let (z, s) = raised((p.z, rho), n);
    if rho == 0.0 {
        return DVec3::new(0.0, 0.0, z);
    }
    let (c, d) = raised((p.x / rho, p.y / rho), n);
    DVec3::new(s * c, s * d, z)
}

/// The power of a point, and the derivatives of the power in three directions. On the z axis, where the power has a kink, those across it
/// are 0.
pub(super) fn power_with(p: DVec3, n: u32, directions: [DVec3; 3]) -> (DVec3, [DVec3; 3]) {
    let rho = (p.x * p.x + p.y * p.y).sqrt();
    let factor = f64::from(n);
    let before = if n > 1 {
        raised((p.z, rho), n - 1)
    } else {
        (1.0, 0.0)
    };
    let (z, s) = product(before, (p.z, rho));
    let (x, y) = if rho == 0.0 {
        (1.0, 0.0)
    } else {
        (p.x / rho, p.y / rho)
    };
    let (c, d) = raised((x, y), n);
    let derivatives = directions.map(|way| {
        let (out, around) = if rho == 0.0 {
            (0.0, 0.0)
        } else {
            (x * way.x + y * way.y, (x * way.y - y * way.x) / rho)
        };
        let (dz, ds) = product(before, (factor * way.z, factor * out));
        let turned = s * factor * around;
        DVec3::new(ds * c - turned * d, ds * d + turned * c, dz)
    });
    let value = if rho == 0.0 {
        DVec3::new(0.0, 0.0, z)
    } else {
        DVec3::new(s * c, s * d, z)
    };
    (value, derivatives)
}

/// By how much distances grow at most within a ball.
#[inline(always)]
pub(super) fn growth(p: DVec3, n: u32, radius: f64) -> f64 {
    let rho = (p.x * p.x + p.y * p.y).sqrt();
    let r = p.length() + radius;
    let factor = f64::from(n);
    let nearest = rho - radius;
    let around = if nearest * factor > r {
        r / nearest
    } else {
        factor
    };
    let around = if around > 1.0 { around } else { 1.0 };
    let mut power = 1.0;
    for _ in 1..n {
        power *= r;
    }
    factor * power * around
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;
    use strahl_math::det;

    #[test]
    fn powers_multiply_angles() {
        let mut random = Random::new(1);
        for n in 2..=16 {
            for _ in 0..200 {
                let p = random.cube() * 1.2;
                let r = p.length();
                let theta = det::atan2((p.x * p.x + p.y * p.y).sqrt(), p.z);
                let phi = det::atan2(p.y, p.x);
                let k = f64::from(n);
                let expected = DVec3::new(
                    det::sin(k * theta) * det::cos(k * phi),
                    det::sin(k * theta) * det::sin(k * phi),
                    det::cos(k * theta),
                ) * det::pow(r, k);
                let off = (power(p, n) - expected).length();
                assert!(off < 1e-12 * (1.0 + expected.length()), "{n} {p} {off}");
            }
        }
        assert_eq!(power(DVec3::Z * -2.0, 3), DVec3::Z * -8.0);
    }

    #[test]
    fn derivatives_are_differences() {
        let mut random = Random::new(2);
        for n in [2, 3, 8] {
            for _ in 0..200 {
                let p = random.cube();
                if DVec3::new(p.x, p.y, 0.0).length() < 0.05 {
                    continue;
                }
                let (value, derivatives) = power_with(p, n, DVec3::AXES);
                assert!((value - power(p, n)).length() < 1e-13);
                for (axis, found) in DVec3::AXES.into_iter().zip(derivatives) {
                    let step = axis * 1e-6;
                    let difference = (power(p + step, n) - power(p - step, n)) / 2e-6;
                    assert!(
                        (difference - found).length() < 1e-6,
                        "{n} {p} {difference} {found}"
                    );
                }
            }
        }
    }

    #[test]
    fn distances_grow_at_most_as_bounded() {
        let mut random = Random::new(3);
        let mut tightest: f64 = 0.0;
        for n in [2, 3, 5, 8, 16] {
            for _ in 0..3000 {
                let p = random.cube() * 1.1;
                let radius = random.magnitude(-4.0, -0.5);
                let bound = growth(p, n, radius);
                let (a, b) = (
                    random.direction() * radius,
                    random.direction() * radius * random.unit(),
                );
                let grown = (power(p + a, n) - power(p + b, n)).length();
                let share = grown / ((a - b).length() * bound);
                assert!(share <= 1.0 + 1e-9, "{n} {p} {radius} {share}");
                tightest = tightest.max(share);
            }
        }
        assert!(tightest > 0.9, "{tightest}");
    }
}
