//! The orbit of a point: its end, and the derivatives of the end by the point.

use super::complex::{Complex, HypercomplexFunction};
use super::{JuliaAlgebra, QuaternionFunction};

/// A number with four components.
pub(super) type Four = [f64; 4];

/// The square of the length.
pub(super) fn norm2(h: Four) -> f64 {
    (h[0] * h[0] + h[1] * h[1]) + (h[2] * h[2] + h[3] * h[3])
}

/// The end of an orbit: the first point beyond the bail-out radius, or the last one computed.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    /// The logarithm of the distance from the origin, over that of the bail-out radius: negative inside of the set.
    pub(super) value: f64,
    /// A bound (to first order) of its derivative by the starting point.
    pub(super) slope: f64,
}

/// The rule of an orbit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rule {
    pub(super) algebra: JuliaAlgebra,
    pub(super) parameter: Four,
    /// The number of points of the orbit, including the starting point.
    pub(super) points: u32,
    /// The bail-out radius.
    pub(super) exit: f64,
}

impl Rule {
    /// Computes the orbit of a point.
    pub(super) fn end(&self, start: Four) -> End {
        match self.algebra {
            JuliaAlgebra::Quaternion(f) => {
                let step = |h: Four, slope: f64| {
                    let r = norm2(h).sqrt();
                    match f {
                        QuaternionFunction::Square => (f.value(h), slope * 2.0 * r),
                        QuaternionFunction::Cube => (f.value(h), slope * 3.0 * (r * r)),
                    }
                };
                let add = |h: Four| std::array::from_fn(|k| h[k] + self.parameter[k]);
                self.follow(start, norm2, |h, slope| {
                    let (h, slope) = step(h, slope);
                    (add(h), slope)
                })
            }
            JuliaAlgebra::Hypercomplex(f) => {
                let [p, q] = split(self.parameter);
                // Each of the two complex numbers has its own slope; the larger one bounds that of the whole.
                let mut slopes = [1.0, 1.0];
                self.follow(split(start), joint_norm2, |[a, b], _| {
                    let (fa, fb) = (f.value(a), f.value(b));
                    slopes[0] *= f.slope(a, fa).norm2().sqrt();
                    slopes[1] *= f.slope(b, fb).norm2().sqrt();
                    let larger = if slopes[0] > slopes[1] {
                        slopes[0]
                    } else {
                        slopes[1]
                    };
                    ([fa + p, fb + q], larger)
                })
            }
        }
    }

    fn follow<T: Copy>(
        &self,
        start: T,
        norm2: impl Fn(T) -> f64,
        mut step: impl FnMut(T, f64) -> (T, f64),
    ) -> End {
        let limit = self.exit * self.exit;
        let (mut h, mut slope) = (start, 1.0);
        let mut r2 = norm2(h);
        for _ in 1..self.points {
            // NaN counts as escaped.
            if !(r2 <= limit) {
                break;
            }
            (h, slope) = step(h, slope);
            r2 = norm2(h);
        }
        let value = 0.5 * strahl_math::det::ln(r2 / limit);
        End {
            value: if value.is_nan() { f64::INFINITY } else { value },
            slope: slope / r2.sqrt(),
        }
    }

    /// The gradient of the end's value by the four components of the starting point, at the end or this many points behind it.
    pub(super) fn gradient(&self, start: Four, behind: u32) -> Four {
        match self.algebra {
            JuliaAlgebra::Quaternion(f) => self.quaternion_gradient(f, start, behind),
            JuliaAlgebra::Hypercomplex(f) => self.hypercomplex_gradient(f, start, behind),
        }
    }

    fn quaternion_gradient(&self, f: QuaternionFunction, start: Four, behind: u32) -> Four {
        let limit = self.exit * self.exit;
        let mut h = start;
        // Rows: the derivatives by the components of the starting point.
        let mut rows: [Four; 4] =
            std::array::from_fn(|k| std::array::from_fn(|l| f64::from(u8::from(k == l))));
        let mut step = |h: &mut Four| {
            rows = rows.map(|d| f.derivative(*h, d));
            let next = f.value(*h);
            *h = std::array::from_fn(|k| next[k] + self.parameter[k]);
        };
        for _ in 1..self.points {
            if !(norm2(h) <= limit) {
                break;
            }
            step(&mut h);
        }
        for _ in 0..behind {
            step(&mut h);
        }
        let r2 = norm2(h);
        rows.map(|d| ((h[0] * d[0] + h[1] * d[1]) + (h[2] * d[2] + h[3] * d[3])) / r2)
    }

    fn hypercomplex_gradient(&self, f: HypercomplexFunction, start: Four, behind: u32) -> Four {
        let limit = self.exit * self.exit;
        let [p, q] = split(self.parameter);
        let [mut a, mut b] = split(start);
        let (mut da, mut db) = (Complex::new(1.0, 0.0), Complex::new(1.0, 0.0));
        let mut step = |a: &mut Complex, b: &mut Complex| {
            let (fa, fb) = (f.value(*a), f.value(*b));
            (da, db) = (da * f.slope(*a, fa), db * f.slope(*b, fb));
            (*a, *b) = (fa + p, fb + q);
        };
        for _ in 1..self.points {
            if !(joint_norm2([a, b]) <= limit) {
                break;
            }
            step(&mut a, &mut b);
        }
        for _ in 0..behind {
            step(&mut a, &mut b);
        }
        // The gradient of |a|²/2 by the real and imaginary part of its start is a conj(a'); so for b.
        let (ga, gb) = (a * da.conjugate(), b * db.conjugate());
        let scale = 0.5 / joint_norm2([a, b]);
        [ga.re + gb.re, ga.im + gb.im, gb.im - ga.im, ga.re - gb.re].map(|g| g * scale)
    }
}

impl QuaternionFunction {
    /// A real part `a` and a vector `v`: the square is `a² - v²` and `2 a v`, the cube `a³ - 3 a v²` and `(3 a² - v²) v`.
    fn value(self, [a, b, c, d]: Four) -> Four {
        let v2 = (b * b + c * c) + d * d;
        let (real, factor) = match self {
            Self::Square => (a * a - v2, 2.0 * a),
            Self::Cube => (a * (a * a - 3.0 * v2), 3.0 * a * a - v2),
        };
        [real, factor * b, factor * c, factor * d]
    }

    /// The derivative at a point along a direction.
    fn derivative(self, [a, b, c, d]: Four, [da, db, dc, dd]: Four) -> Four {
        let v2 = (b * b + c * c) + d * d;
        let dv2 = 2.0 * ((b * db + c * dc) + d * dd);
        let (real, factor, dfactor) = match self {
            Self::Square => (2.0 * a * da - dv2, 2.0 * a, 2.0 * da),
            Self::Cube => (
                3.0 * (a * a - v2) * da - 3.0 * a * dv2,
                3.0 * a * a - v2,
                6.0 * a * da - dv2,
            ),
        };
        let component = |x: f64, dx: f64| factor * dx + dfactor * x;
        [real, component(b, db), component(c, dc), component(d, dd)]
    }
}

/// A hypercomplex number as two complex ones. With `ij = k`, `ii = jj = -1` and commuting units `kk = 1`, so the numbers
/// `(1 ± k) / 2` are idempotent and split the algebra: `h -> (x + w + i (y - z), x - w + i (y + z))` respects sums and
/// products.
fn split([x, y, z, w]: Four) -> [Complex; 2] {
    [Complex::new(x + w, y - z), Complex::new(x - w, y + z)]
}

/// The squared length of the hypercomplex number.
fn joint_norm2([a, b]: [Complex; 2]) -> f64 {
    0.5 * (a.norm2() + b.norm2())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradients_are_differences_and_slopes_bound_them() {
        let algebras = [
            JuliaAlgebra::Quaternion(QuaternionFunction::Square),
            JuliaAlgebra::Quaternion(QuaternionFunction::Cube),
            JuliaAlgebra::Hypercomplex(HypercomplexFunction::Square),
            JuliaAlgebra::Hypercomplex(HypercomplexFunction::Sin),
        ];
        for algebra in algebras {
            let rule = Rule {
                algebra,
                parameter: [-0.083, 0.1, -0.53, -0.025],
                points: 4,
                exit: 4.0,
            };
            let start = [0.3, -0.2, 0.25, 0.1];
            let (gradient, end) = (rule.gradient(start, 0), rule.end(start));
            for k in 0..4 {
                let moved = |by: f64| {
                    let mut p = start;
                    p[k] += by;
                    rule.end(p).value
                };
                let difference = (moved(1e-5) - moved(-1e-5)) / 2e-5;
                assert!(
                    (difference - gradient[k]).abs() < 1e-7,
                    "{algebra:?} {k} {difference} {gradient:?}"
                );
            }
            assert!(norm2(gradient).sqrt() <= end.slope * 1.5, "{algebra:?}");
        }
    }
}
