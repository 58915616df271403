//! Orbits under squares and cubes: the estimate of the distance to the surface, and proofs that a ball has no surface.
//!
//! Products of quaternions and of complex numbers have the product of the lengths as length. So the square maps the ball of
//! radius `q` around a number of length `r` into a ball of radius `(2 r + q) q`, and the cube into one of `(3 r² + (3 r + q) q) q`;
//! adding the parameter only moves the ball. If all balls of an orbit are within the bail-out radius, the first one is inside of the
//! set; if one of them is beyond it, the first one is outside.

use super::complex::Complex;
use super::real::Real;

/// Orbits are followed up to so many bail-out radii, where it is easier to see how far away the surface is.
const FAR: f64 = 4.0;

/// The power that is iterated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Degree {
    Two,
    Three,
}

/// A number of an algebra: one quaternion, or the two complex numbers that a hypercomplex number is.
pub(super) trait Number: Copy {
    /// What it consists of.
    type Real: Real;
    /// How many parts it has: numbers that are multiplied on their own.
    const PARTS: usize;
    /// By how much a part changes at most if the number changes by 1.
    const PART: f64;
    /// The squared lengths of the parts; the second one is 0 for a quaternion.
    fn squares(self) -> [Self::Real; 2];
    /// The length of a number with parts of these squared lengths, squared.
    fn joint(squares: [Self::Real; 2]) -> Self::Real;
    fn square(self) -> Self;
    fn cube(self) -> Self;
    fn plus(self, other: Self) -> Self;
}

impl<R: Real> Number for [R; 4] {
    type Real = R;
    const PARTS: usize = 1;
    const PART: f64 = 1.0;

    #[inline(always)]
    fn squares(self) -> [R; 2] {
        let [a, b, c, d] = self;
        [(a * a + b * b) + (c * c + d * d), a.like(0.0)]
    }
    #[inline(always)]
    fn joint([a, _]: [R; 2]) -> R {
        a
    }
    /// Of a real part `a` and a vector `v`: `a² - v²` and `2 a v`.
    #[inline(always)]
    fn square(self) -> Self {
        let [a, b, c, d] = self;
        let factor = a.like(2.0) * a;
        let v2 = (b * b + c * c) + d * d;
        [a * a - v2, factor * b, factor * c, factor * d]
    }
    /// `a³ - 3 a v²` and `(3 a² - v²) v`.
    #[inline(always)]
    fn cube(self) -> Self {
        let [a, b, c, d] = self;
        let three = a.like(3.0);
        let v2 = (b * b + c * c) + d * d;
        let factor = three * a * a - v2;
        [a * (a * a - three * v2), factor * b, factor * c, factor * d]
    }
    #[inline(always)]
    fn plus(self, [p, q, r, s]: Self) -> Self {
        let [a, b, c, d] = self;
        [a + p, b + q, c + r, d + s]
    }
}

impl<R: Real> Number for [Complex<R>; 2] {
    type Real = R;
    const PARTS: usize = 2;
    const PART: f64 = std::f64::consts::SQRT_2;

    #[inline(always)]
    fn squares(self) -> [R; 2] {
        [self[0].norm2(), self[1].norm2()]
    }
    #[inline(always)]
    fn joint([a, b]: [R; 2]) -> R {
        a.like(0.5) * (a + b)
    }
    #[inline(always)]
    fn square(self) -> Self {
        [self[0].square(), self[1].square()]
    }
    #[inline(always)]
    fn cube(self) -> Self {
        [self[0].square() * self[0], self[1].square() * self[1]]
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        [self[0] + other[0], self[1] + other[1]]
    }
}

/// The iteration `h -> h² + parameter` or `h -> h³ + parameter`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Powers<N> {
    pub(super) degree: Degree,
    pub(super) parameter: N,
    /// The number of points of an orbit.
    pub(super) points: u32,
    /// The bail-out radius.
    pub(super) exit: f64,
}

impl<N> Powers<N> {
    /// The same iteration with a parameter of another kind of number.
    #[inline(always)]
    pub(super) fn of<M>(&self, parameter: M) -> Powers<M> {
        Powers {
            degree: self.degree,
            parameter,
            points: self.points,
            exit: self.exit,
        }
    }
}

impl<N: Number> Powers<N> {
    #[inline(always)]
    fn next(&self, h: N) -> N {
        let power = match self.degree {
            Degree::Two => h.square(),
            Degree::Three => h.cube(),
        };
        power.plus(self.parameter)
    }

    /// The squared length of the first point beyond the bail-out radius, or of the last one; and an estimate of the distance from the
    /// surface: how far the last point that is followed is from the bail-out radius, over a bound of its derivative by the start.
    /// The estimate is negative inside of the set.
    #[inline(always)]
    pub(super) fn estimate(&self, start: N) -> (N::Real, N::Real) {
        let mut h = start;
        let mut squares = h.squares();
        let mut r2 = N::joint(squares);
        let one = r2.like(1.0);
        let exit = r2.like(self.exit);
        let limit = exit * exit;
        let far = r2.like(FAR * FAR) * limit;
        let (four, nine) = (r2.like(4.0), r2.like(9.0));
        let mut slopes = [one, one];
        let mut end = r2;
        for _ in 1..self.points {
            if !r2.any_le(far) {
                break;
            }
            // An index, because iterators and closures are not always inlined into code for a level of instructions.
            for k in 0..N::PARTS {
                let growth = match self.degree {
                    Degree::Two => four * squares[k],
                    Degree::Three => nine * (squares[k] * squares[k]),
                };
                slopes[k] = r2.choose_le(far, slopes[k] * growth, slopes[k]);
            }
            h = self.next(h);
            squares = h.squares();
            // The lanes whose orbit has ended keep its end.
            r2 = r2.choose_le(far, N::joint(squares), r2);
            end = end.choose_le(limit, r2, end);
        }
        let slope = if N::PARTS == 1 {
            slopes[0]
        } else {
            slopes[0].larger(slopes[1])
        };
        (end, (r2.sqrt() - exit).over(slope.sqrt()))
    }
}

impl<N: Number<Real = f64>> Powers<N> {
    /// The squared length of the first point beyond the bail-out radius, or of the last one.
    #[inline(always)]
    pub(super) fn end(&self, start: N) -> f64 {
        let limit = self.exit * self.exit;
        let mut h = start;
        let mut r2 = N::joint(h.squares());
        for _ in 1..self.points {
            // NaN counts as escaped.
            if !(r2 <= limit) {
                break;
            }
            h = self.next(h);
            r2 = N::joint(h.squares());
        }
        r2
    }

    /// Whether the numbers up to this distance from a number are certainly all inside of the set, or all outside.
    #[inline(always)]
    pub(super) fn is_decided(&self, start: N, radius: f64) -> bool {
        let far = FAR * FAR * self.exit * self.exit;
        let mut h = start;
        let mut balls = [N::PART * radius; 2];
        let mut inside = true;
        for n in 1..=self.points {
            let squares = h.squares();
            let r2 = N::joint(squares);
            let r = r2.sqrt();
            let ball = N::joint([balls[0] * balls[0], balls[1] * balls[1]]).sqrt();
            if r - ball > self.exit {
                return true;
            }
            inside &= r + ball < self.exit;
            if n == self.points || !(r2 <= far) {
                break;
            }
            for (ball, r2) in balls.iter_mut().zip(squares) {
                *ball *= match self.degree {
                    Degree::Two => 2.0 * r2.sqrt() + *ball,
                    Degree::Three => 3.0 * r2 + (3.0 * r2.sqrt() + *ball) * *ball,
                };
            }
            h = self.next(h);
        }
        inside
    }
}
