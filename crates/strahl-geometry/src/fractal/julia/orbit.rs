//! The orbit of a point: its end, and the derivatives of the end by the point.

use super::complex::{Complex, HypercomplexFunction};
use super::power::{Degree, Number, Powers};
use super::real::{Lanes, Pair, Real};
use super::{JuliaAlgebra, LINE_BATCH, Place, Places, QuaternionFunction};
use std::f64::consts::SQRT_2;
use strahl_math::{DVec3, det};
use strahl_simd::{Isa, Simd, dispatch};

/// A number with four components.
pub(super) type Four = [f64; 4];

/// The square of the length.
pub(super) fn norm2(h: Four) -> f64 {
    (h[0] * h[0] + h[1] * h[1]) + (h[2] * h[2] + h[3] * h[3])
}

/// The part of an estimated distance that is taken where the estimate may be too long.
pub(super) const CAUTION: f64 = 0.5;

/// The slice that is shown: a point of space has the first three components of its number, and this fourth one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slice {
    pub(super) offset: f64,
    /// What the other components are multiplied by.
    pub(super) factors: DVec3,
}

impl Slice {
    /// The number that a point stands for.
    #[inline(always)]
    pub(super) fn number<R: Real>(&self, [x, y, z]: [R; 3]) -> [R; 4] {
        let DVec3 { x: p, y: q, z: r } = self.factors;
        let sum = (x.like(p) * x + y.like(q) * y) + z.like(r) * z;
        [x, y, z, x.like(self.offset) + sum]
    }
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
    /// A bound of the lengths of the numbers whose orbits stay near the origin, at most the bail-out radius.
    ///
    /// For a quaternion `h` the next point is at least `|h|² - |parameter|` or `|h|³ - |parameter|` from the origin; if that is within a radius, `h` is within a
    /// smaller one, and the point before it within one that is smaller still. Of the two complex numbers of a hypercomplex one the squared lengths count by half.
    pub(super) fn reach(&self) -> f64 {
        let length = norm2(self.parameter).sqrt();
        let parts = split(self.parameter).map(|part| part.norm2().sqrt());
        let mut reach = self.exit;
        // It comes near its limit in a few steps.
        for _ in 1..self.points.min(64) {
            let before = match self.algebra {
                JuliaAlgebra::Quaternion(QuaternionFunction::Square) => (reach + length).sqrt(),
                JuliaAlgebra::Quaternion(QuaternionFunction::Cube) => det::cbrt(reach + length),
                // The largest `u + v` with `(u - |p|)² + (v - |q|)² <= 2 reach²`: u and v are the parts' squared lengths, p and q the parts of the parameter.
                JuliaAlgebra::Hypercomplex(HypercomplexFunction::Square) => {
                    (reach + 0.5 * (parts[0] + parts[1])).sqrt()
                }
                JuliaAlgebra::Hypercomplex(HypercomplexFunction::Cube) => {
                    let squares = parts.map(|part| {
                        let longest = det::cbrt(SQRT_2 * reach + part);
                        longest * longest
                    });
                    (0.5 * (squares[0] + squares[1])).sqrt()
                }
                JuliaAlgebra::Hypercomplex(_) => return reach,
            };
            if !(before < reach) {
                break;
            }
            reach = before;
        }
        // The surface is clearly within.
        let wider = reach * (1.0 + 1e-6);
        if wider < self.exit { wider } else { self.exit }
    }

    /// A bound (to first order) of the derivative of [`Place::value`] by the point.
    pub(super) fn slope(&self, start: Four) -> f64 {
        let (r2, slope) = self.follow(start);
        slope * r2.sqrt() / (self.exit * self.exit)
    }

    /// Squares or cubes of quaternions.
    fn quaternion_powers(&self, f: QuaternionFunction) -> Powers<Four> {
        Powers {
            degree: match f {
                QuaternionFunction::Square => Degree::Two,
                QuaternionFunction::Cube => Degree::Three,
            },
            parameter: self.parameter,
            points: self.points,
            exit: self.exit,
        }
    }

    /// Squares or cubes of hypercomplex numbers, if the function is one of them.
    fn hypercomplex_powers(&self, f: HypercomplexFunction) -> Option<Powers<[Complex; 2]>> {
        let degree = match f {
            HypercomplexFunction::Square => Degree::Two,
            HypercomplexFunction::Cube => Degree::Three,
            _ => return None,
        };
        Some(Powers {
            degree,
            parameter: split(self.parameter),
            points: self.points,
            exit: self.exit,
        })
    }

    /// The [`Place::value`] of a point. Its orbit ends with the first number beyond the bail-out radius, or the last one computed.
    pub(super) fn value(&self, start: Four) -> f64 {
        self.value_of(match self.algebra {
            JuliaAlgebra::Quaternion(f) => self.quaternion_powers(f).end(start),
            JuliaAlgebra::Hypercomplex(f) => match self.hypercomplex_powers(f) {
                Some(powers) => powers.end(split(start)),
                None => self.follow(start).0,
            },
        })
    }

    fn value_of(&self, r2: f64) -> f64 {
        let value = 0.5 * (r2 / (self.exit * self.exit) - 1.0);
        if value.is_nan() { f64::INFINITY } else { value }
    }

    /// How a point lies to the surface.
    pub(super) fn place(&self, start: Four) -> Place {
        let powers = match self.algebra {
            JuliaAlgebra::Quaternion(f) => Some(self.quaternion_powers(f).estimate(start)),
            JuliaAlgebra::Hypercomplex(f) => self
                .hypercomplex_powers(f)
                .map(|powers| powers.estimate(split(start))),
        };
        let (value, reach) = powers.map_or_else(
            || {
                let (r2, slope) = self.follow(start);
                // The logarithm of the end's length is more like a straight line than the length.
                let log = 0.5 * det::ln(r2 / (self.exit * self.exit));
                let value = 0.5 * (r2 / (self.exit * self.exit) - 1.0);
                (value, CAUTION * log.abs() * r2.sqrt() / slope)
            },
            |estimate| self.estimated(estimate),
        );
        place_of(value, reach)
    }

    /// Stores how points of a line, given by its origin and its direction, lie to the surface; computed side by side, with the same
    /// bits as one by one; only for squares and cubes, else it does nothing and returns `false`.
    pub(super) fn store_places(
        &self,
        slice: &Slice,
        [origin, direction]: [[f64; 3]; 2],
        s: &[f64; LINE_BATCH],
        out: &mut Places,
    ) -> bool {
        match self.algebra {
            JuliaAlgebra::Quaternion(f) => {
                let powers = self.quaternion_powers(f);
                dispatch!(Simd::best(), isa => {
                    let s = Pair::load(isa, s);
                    let start = slice.number(points_at(origin, direction, s));
                    let [a, b, c, d] = self.parameter;
                    let powers = powers.of([s.like(a), s.like(b), s.like(c), s.like(d)]);
                    self.store_estimated(powers.estimate(start), out);
                });
            }
            JuliaAlgebra::Hypercomplex(f) => {
                let Some(powers) = self.hypercomplex_powers(f) else {
                    return false;
                };
                dispatch!(Simd::best(), isa => {
                    let s = Pair::load(isa, s);
                    let start = slice.number(points_at(origin, direction, s));
                    let [a, b, c, d] = self.parameter;
                    let powers = powers.of(split([s.like(a), s.like(b), s.like(c), s.like(d)]));
                    self.store_estimated(powers.estimate(split(start)), out);
                });
            }
        }
        true
    }

    /// Stores what [`place_of`] makes of [estimates](Self::estimated).
    #[inline(always)]
    fn store_estimated<I: Isa>(
        &self,
        estimate: (Pair<Lanes<I>>, Pair<Lanes<I>>),
        out: &mut Places,
    ) {
        let (value, reach) = self.estimated(estimate);
        // What is not a number is not at most anything; reaches are never negative.
        let infinite = value.like(f64::INFINITY);
        out.values = value.choose_le(infinite, value, infinite).numbers();
        out.reaches = reach
            .choose_le(reach.like(f64::MAX), reach, reach.like(0.0))
            .numbers();
    }

    /// The value and the reach of the place with this end of the orbit and this estimated distance.
    #[inline(always)]
    fn estimated<R: Real>(&self, (r2, distance): (R, R)) -> (R, R) {
        let limit = r2.like(self.exit * self.exit);
        let value = r2.like(0.5) * (r2.over(limit) - r2.like(1.0));
        // Towards the surface the length shrinks ever more slowly, so from outside the estimate is rather too short. Inside of the set,
        // where lengths grow ever faster, half of it is taken.
        let within = r2.like(-CAUTION) * distance;
        (value, distance.choose_le(r2.like(0.0), within, distance))
    }

    /// Whether the numbers up to this distance from a number are all inside of the set or all outside: proven for squares and
    /// cubes, by the estimate for other functions.
    pub(super) fn is_decided(&self, start: Four, radius: f64) -> bool {
        match self.algebra {
            JuliaAlgebra::Quaternion(f) => self.quaternion_powers(f).is_decided(start, radius),
            JuliaAlgebra::Hypercomplex(f) => match self.hypercomplex_powers(f) {
                Some(powers) => powers.is_decided(split(start), radius),
                None => self.place(start).reach > radius,
            },
        }
    }

    /// The squared length of the end of an orbit, and the bound of the end's derivative.
    fn follow(&self, start: Four) -> (f64, f64) {
        match self.algebra {
            JuliaAlgebra::Quaternion(f) => self.follow_with(start, norm2, |h, slope| {
                let r2 = norm2(h);
                match f {
                    QuaternionFunction::Square => {
                        (f.value(h).plus(self.parameter), slope * 2.0 * r2.sqrt())
                    }
                    QuaternionFunction::Cube => (f.value(h).plus(self.parameter), slope * 3.0 * r2),
                }
            }),
            JuliaAlgebra::Hypercomplex(f) => {
                let [p, q] = split(self.parameter);
                // Each of the two complex numbers has its own slope; the larger one bounds that of the whole.
                let mut slopes = [1.0, 1.0];
                self.follow_with(split(start), joint_norm2, |[a, b], _| {
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

    fn follow_with<T: Copy>(
        &self,
        start: T,
        norm2: impl Fn(T) -> f64,
        mut step: impl FnMut(T, f64) -> (T, f64),
    ) -> (f64, f64) {
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
        (r2, slope)
    }

    /// The gradient of the end's value by the four components of the starting point, at the end or this many points behind it.
    pub(super) fn gradient(&self, start: Four, behind: u32) -> Four {
        match self.algebra {
            JuliaAlgebra::Quaternion(f) => self.quaternion_gradient(f, start, behind),
            JuliaAlgebra::Hypercomplex(f) => self.hypercomplex_gradient(f, start, behind),
        }
    }

    fn quaternion_gradient(&self, f: QuaternionFunction, start: Four, behind: u32) -> Four {
        dispatch!(Simd::best(), isa => {
            let zero = Lanes::load(isa, &[0.0; 4]);
            self.gradient_in_lanes(f, zero, start, behind).numbers()
        })
    }

    /// The gradient by the four components of the starting point, each in its lane; `zero` tells in which kind of lanes.
    #[inline(always)]
    fn gradient_in_lanes<I: Isa>(
        &self,
        f: QuaternionFunction,
        zero: Lanes<I>,
        [a, b, c, d]: Four,
        behind: u32,
    ) -> Lanes<I> {
        let limit = zero.like(self.exit * self.exit);
        let [p, q, r, s] = self.parameter;
        let parameter = [zero.like(p), zero.like(q), zero.like(r), zero.like(s)];
        let mut h = [zero.like(a), zero.like(b), zero.like(c), zero.like(d)];
        // The derivatives of the four components.
        let mut rows = zero.unit_lanes();
        let (mut left, mut rest) = (self.points.saturating_sub(1), behind);
        loop {
            let escaped =
                !((h[0] * h[0] + h[1] * h[1]) + (h[2] * h[2] + h[3] * h[3])).any_le(limit);
            if left == 0 || escaped {
                left = 0;
                if rest == 0 {
                    break;
                }
                rest -= 1;
            } else {
                left -= 1;
            }
            rows = f.derivative(h, rows);
            h = f.value(h).plus(parameter);
        }
        ((h[0] * rows[0] + h[1] * rows[1]) + (h[2] * rows[2] + h[3] * rows[3])).over(limit)
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
        let scale = 0.5 / limit;
        [ga.re + gb.re, ga.im + gb.im, gb.im - ga.im, ga.re - gb.re].map(|g| g * scale)
    }
}

impl QuaternionFunction {
    /// A real part `a` and a vector `v`: the square is `a² - v²` and `2 a v`, the cube `a³ - 3 a v²` and `(3 a² - v²) v`.
    #[inline(always)]
    fn value<R: Real>(self, h: [R; 4]) -> [R; 4] {
        match self {
            Self::Square => h.square(),
            Self::Cube => h.cube(),
        }
    }

    /// The derivative at a point along a direction.
    #[inline(always)]
    fn derivative<R: Real>(self, [a, b, c, d]: [R; 4], [da, db, dc, dd]: [R; 4]) -> [R; 4] {
        let (two, three) = (a.like(2.0), a.like(3.0));
        let v2 = (b * b + c * c) + d * d;
        let dv2 = two * ((b * db + c * dc) + d * dd);
        let (real, factor, dfactor) = match self {
            Self::Square => (two * a * da - dv2, two * a, two * da),
            Self::Cube => (
                three * (a * a - v2) * da - three * a * dv2,
                three * a * a - v2,
                a.like(6.0) * a * da - dv2,
            ),
        };
        [
            real,
            factor * db + dfactor * b,
            factor * dc + dfactor * c,
            factor * dd + dfactor * d,
        ]
    }
}

/// The place with this value and this reach.
#[inline(always)]
fn place_of(value: f64, reach: f64) -> Place {
    Place {
        value: if value.is_nan() { f64::INFINITY } else { value },
        // At poles there is no estimate.
        reach: if reach.is_finite() { reach } else { 0.0 },
    }
}

/// The points of a line at several parameters.
#[inline(always)]
fn points_at<R: Real>(origin: [f64; 3], direction: [f64; 3], s: R) -> [R; 3] {
    let [x, y, z] = origin;
    let [dx, dy, dz] = direction;
    [
        s.like(x) + s.like(dx) * s,
        s.like(y) + s.like(dy) * s,
        s.like(z) + s.like(dz) * s,
    ]
}

/// A hypercomplex number as two complex ones. With `ij = k`, `ii = jj = -1` and commuting units `kk = 1`, so the numbers
/// `(1 ± k) / 2` are idempotent and split the algebra: `h -> (x + w + i (y - z), x - w + i (y + z))` respects sums and
/// products.
#[inline(always)]
fn split<R: Real>([x, y, z, w]: [R; 4]) -> [Complex<R>; 2] {
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
            let (gradient, slope) = (rule.gradient(start, 0), rule.slope(start));
            for k in 0..4 {
                let moved = |by: f64| {
                    let mut p = start;
                    p[k] += by;
                    rule.value(p)
                };
                let difference = (moved(1e-5) - moved(-1e-5)) / 2e-5;
                assert!(
                    (difference - gradient[k]).abs() < 1e-7,
                    "{algebra:?} {k} {difference} {gradient:?}"
                );
            }
            assert!(norm2(gradient).sqrt() <= slope * 1.5, "{algebra:?}");
        }
    }

    #[test]
    fn all_points_of_a_decided_ball_are_on_the_same_side() {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for algebra in [
            JuliaAlgebra::Quaternion(QuaternionFunction::Square),
            JuliaAlgebra::Quaternion(QuaternionFunction::Cube),
            JuliaAlgebra::Hypercomplex(HypercomplexFunction::Square),
            JuliaAlgebra::Hypercomplex(HypercomplexFunction::Cube),
        ] {
            let quaternion = matches!(algebra, JuliaAlgebra::Quaternion(_));
            let rule = Rule {
                algebra,
                parameter: [0.2, 0.1, 0.5, -0.2],
                points: 7,
                exit: if quaternion { 1.6 } else { 4.0 },
            };
            let (mut inside, mut outside) = (0, 0);
            for _ in 0..2000 {
                let start: Four = std::array::from_fn(|_| 1.2 * random());
                let radius = 0.05;
                if !rule.is_decided(start, radius) {
                    continue;
                }
                let value = rule.value(start);
                *if value < 0.0 {
                    &mut inside
                } else {
                    &mut outside
                } += 1;
                for _ in 0..100 {
                    let way: Four = std::array::from_fn(|_| random());
                    let scale = 0.999 * radius / norm2(way).sqrt();
                    let moved = std::array::from_fn(|k| start[k] + scale * way[k]);
                    let same = (rule.value(moved) < 0.0) == (value < 0.0);
                    assert!(same, "{algebra:?} {start:?} {way:?}");
                }
            }
            assert!(
                inside > 10 && outside > 500,
                "{algebra:?} {inside} {outside}"
            );
        }
    }

    #[test]
    fn places_together_are_those_of_single_points() {
        let algebras = [
            JuliaAlgebra::Quaternion(QuaternionFunction::Square),
            JuliaAlgebra::Quaternion(QuaternionFunction::Cube),
            JuliaAlgebra::Hypercomplex(HypercomplexFunction::Square),
            JuliaAlgebra::Hypercomplex(HypercomplexFunction::Cube),
        ];
        let slice = Slice {
            offset: 0.1,
            factors: DVec3::new(0.1, -0.3, 0.2),
        };
        for algebra in algebras {
            let rule = Rule {
                algebra,
                parameter: [-0.083, 0.1, -0.53, -0.025],
                points: 8,
                exit: 1.6,
            };
            for n in 0..500 {
                // From the middle of the set, whose orbits are long, to far outside, where they end at once.
                let line = [[0.3, -0.2, 0.1], [0.7, -0.2, 0.25]];
                let s = [0, 37, 74, 111, 5, 60, 120, 30].map(|k| f64::from(n + k) * 0.005);
                let mut places = Places::default();
                assert!(rule.store_places(&slice, line, &s, &mut places));
                let found = places.values.iter().zip(places.reaches);
                for (s, (value, reach)) in s.into_iter().zip(found) {
                    let alone = rule.place(slice.number(points_at(line[0], line[1], s)));
                    assert_eq!(value.to_bits(), alone.value.to_bits(), "{algebra:?}");
                    assert_eq!(reach.to_bits(), alone.reach.to_bits(), "{algebra:?}");
                }
            }
        }
        let sine = JuliaAlgebra::Hypercomplex(HypercomplexFunction::Sin);
        let rule = Rule {
            algebra: sine,
            parameter: [0.1; 4],
            points: 8,
            exit: 4.0,
        };
        assert!(!rule.store_places(
            &slice,
            [[0.1; 3]; 2],
            &[0.1; LINE_BATCH],
            &mut Places::default()
        ));
    }

    #[test]
    fn powers_have_the_values_of_the_functions() {
        let start = [0.3, -0.2, 0.25, 0.1];
        for f in [QuaternionFunction::Square, QuaternionFunction::Cube] {
            let algebra = JuliaAlgebra::Quaternion(f);
            let rule = Rule {
                algebra,
                parameter: [-0.083, 0.1, -0.53, -0.025],
                points: 6,
                exit: 4.0,
            };
            let value = rule.value_of(rule.follow(start).0);
            assert_eq!(rule.value(start).to_bits(), value.to_bits());
            assert_eq!(rule.place(start).value.to_bits(), value.to_bits());
        }
    }
}
