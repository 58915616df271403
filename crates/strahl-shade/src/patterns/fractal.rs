mod complex;
mod together;

use complex::{Complex, Number, OrbitPoint};
use strahl_math::DVec2;
use strahl_simd::Simd;

/// Which iteration a fractal pattern runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FractalKind {
    /// `z → zᵖ + c`, starting at the point.
    Power {
        /// p, at least 2.
        exponent: u32,
    },
    /// `z → ((z² + c - 1) / (2z + c - 2))²`.
    Magnet1,
    /// `z → ((z³ + 3(c-1)z + (c-1)(c-2)) / (3z² + 3(c-2)z + (c-1)(c-2) + 1))²`.
    Magnet2,
}

/// The value of a point outside of the set, whose orbit escapes after `k` steps at `z`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exterior {
    /// 0: the factor.
    Constant(f64),
    /// 1: `k` divided by the number of iterations.
    Steps,
    /// 2: the real part of z, times the factor.
    Real(f64),
    /// 3: the imaginary part.
    Imaginary(f64),
    /// 4: the squared real part.
    RealSquared(f64),
    /// 5: the squared imaginary part.
    ImaginarySquared(f64),
    /// 6: the absolute value.
    Absolute(f64),
}

impl Exterior {
    /// The value with POV-Ray's number 0 to 6.
    pub const fn from_number(number: u32, factor: f64) -> Option<Self> {
        Some(match number {
            0 => Self::Constant(factor),
            1 => Self::Steps,
            2 => Self::Real(factor),
            3 => Self::Imaginary(factor),
            4 => Self::RealSquared(factor),
            5 => Self::ImaginarySquared(factor),
            6 => Self::Absolute(factor),
            _ => return None,
        })
    }
}

/// The value of a point of the set, whose orbit ends at `z`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Interior {
    /// 0: the factor.
    Constant(f64),
    /// 1: the smallest absolute value of the orbit, times the factor.
    Smallest(f64),
    /// 2: the real part of z, times the factor.
    Real(f64),
    /// 3: the imaginary part.
    Imaginary(f64),
    /// 4: the squared real part.
    RealSquared(f64),
    /// 5: the squared imaginary part.
    ImaginarySquared(f64),
    /// 6: the absolute value. (POV-Ray gives another number here, which is not that of its manual.)
    Absolute(f64),
}

impl Interior {
    /// The value with POV-Ray's number 0 to 6.
    pub const fn from_number(number: u32, factor: f64) -> Option<Self> {
        Some(match number {
            0 => Self::Constant(factor),
            1 => Self::Smallest(factor),
            2 => Self::Real(factor),
            3 => Self::Imaginary(factor),
            4 => Self::RealSquared(factor),
            5 => Self::ImaginarySquared(factor),
            6 => Self::Absolute(factor),
            _ => return None,
        })
    }
}

/// A fractal of the complex plane as a pattern; x is real, y imaginary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fractal {
    /// The iteration.
    pub kind: FractalKind,
    /// The constant of a Julia set; `None` for a Mandelbrot set, where the point itself is the constant.
    pub julia: Option<DVec2>,
    /// The most steps taken.
    pub iterations: u32,
    /// The value outside.
    pub exterior: Exterior,
    /// The value inside.
    pub interior: Interior,
}

impl Fractal {
    /// A Mandelbrot set of exponent 2 as POV-Ray colours it: steps outside, 1 inside.
    pub fn mandelbrot(iterations: u32) -> Self {
        Self {
            kind: FractalKind::Power { exponent: 2 },
            julia: None,
            iterations,
            exterior: Exterior::Steps,
            interior: Interior::Constant(1.0),
        }
    }

    pub(super) fn value(&self, point: DVec2) -> f64 {
        if let Some(value) = self.value_at_once(point) {
            return value;
        }
        let c = self.julia.unwrap_or(point);
        // Each iteration has its own loop. All numbers are single ones: with `c` as a vector compilers move the coordinates of the orbit
        // into one register and out again in each step, and a step takes as long as its chain of operations.
        let (x, y) = (point.x, point.y);
        match self.kind {
            FractalKind::Power { exponent: 2 } => self.follow(Square, x, y, c.x, c.y),
            FractalKind::Power { exponent } => self.follow(Power(exponent), x, y, c.x, c.y),
            FractalKind::Magnet1 => self.follow(Magnet1, x, y, c.x, c.y),
            FractalKind::Magnet2 => self.follow(Magnet2, x, y, c.x, c.y),
        }
    }

    /// Stores the values at several points.
    pub(crate) fn store_values(&self, points: &[DVec2], values: &mut [f64]) {
        together::values(Simd::best(), self, points, values);
    }

    /// The value at a point that needs no orbit.
    #[inline(always)]
    fn value_at_once(&self, point: DVec2) -> Option<f64> {
        match self.interior {
            Interior::Constant(value) if self.is_mandelbrot() && in_largest_parts(point) => {
                Some(value)
            }
            _ => None,
        }
    }

    fn is_mandelbrot(&self) -> bool {
        self.julia.is_none() && self.kind == FractalKind::Power { exponent: 2 }
    }

    fn is_magnet(&self) -> bool {
        !matches!(self.kind, FractalKind::Power { .. })
    }

    /// The squared absolute value from which on orbits escape.
    #[inline(always)]
    fn bailout(&self) -> f64 {
        if self.is_magnet() { 1e4 } else { 4.0 }
    }

    /// Where the orbit of a point starts, and the smallest squared absolute value up to there.
    #[inline(always)]
    fn start(&self, x: f64, y: f64) -> (Complex<f64>, f64) {
        if self.is_magnet() && self.julia.is_none() {
            // A magnet's Mandelbrot orbit starts at zero, which would always be the smallest.
            (Complex::new(0.0, 0.0), f64::INFINITY)
        } else {
            let point = Complex::new(x, y);
            (point, point.norm2())
        }
    }

    /// The value at a point, by its orbit.
    ///
    /// An orbit that returns exactly to one of its points is a cycle from there on, so whole rounds are left out (Brent 1980). Most
    /// orbits of the inside do so long before they are complete.
    #[inline(never)]
    fn follow<R: Rule>(&self, rule: R, x: f64, y: f64, c_x: f64, c_y: f64) -> f64 {
        let c = Complex::new(c_x, c_y);
        let bailout = self.bailout();
        let (start, mut smallest) = self.start(x, y);
        let mut z = OrbitPoint::new(start);
        let (mut number, mut end) = (0, self.iterations);
        // A point that the orbit may return to, where it was reached, and the steps to the next such point.
        let (mut seen, mut seen_at, mut stretch) = (z, 0, FIRST_STRETCH);
        while number < end {
            z = OrbitPoint::new(rule.step(z, c, 1.0, 2.0, 3.0));
            let absolute = z.x2 + z.y2;
            if absolute < smallest {
                smallest = absolute;
            }
            let converged = R::CONVERGES && z.distance2_from(1.0) < CONVERGED;
            if !(absolute <= bailout) || converged {
                return self.outside(number, z);
            }
            number += 1;
            if z.x == seen.x && z.y == seen.y {
                // All points of the cycle have been visited.
                end = number + (end - number) % (number - seen_at);
            } else if number - seen_at == stretch {
                (seen, seen_at) = (z, number);
                stretch *= 2;
            }
        }
        self.inside(z, smallest)
    }

    fn inside(&self, z: OrbitPoint<f64>, smallest: f64) -> f64 {
        match self.interior {
            Interior::Constant(f) => f,
            Interior::Smallest(f) => smallest.sqrt() * f,
            Interior::Real(f) => z.x * f,
            Interior::Imaginary(f) => z.y * f,
            Interior::RealSquared(f) => z.x2 * f,
            Interior::ImaginarySquared(f) => z.y2 * f,
            Interior::Absolute(f) => (z.x2 + z.y2).sqrt() * f,
        }
    }

    fn outside(&self, step: u32, z: OrbitPoint<f64>) -> f64 {
        match self.exterior {
            Exterior::Constant(f) => f,
            Exterior::Steps => f64::from(step) / f64::from(self.iterations),
            Exterior::Real(f) => z.x * f,
            Exterior::Imaginary(f) => z.y * f,
            Exterior::RealSquared(f) => z.x2 * f,
            Exterior::ImaginarySquared(f) => z.y2 * f,
            Exterior::Absolute(f) => (z.x2 + z.y2).sqrt() * f,
        }
    }
}

/// Whether a point is certainly in the cardioid or the disc to its left, the two largest parts of the Mandelbrot set: farther from
/// their edges than rounding could move an orbit.
fn in_largest_parts(c: DVec2) -> bool {
    const INNER: f64 = 1.0 - 1e-6;
    let (x, y2) = (c.x - 0.25, c.y * c.y);
    let q = x * x + y2;
    let left = c.x + 1.0;
    q * (q + x) < 0.25 * y2 * INNER || left * left + y2 < 0.0625 * INNER
}

/// The steps after which an orbit is first compared with another of its points.
const FIRST_STRETCH: u32 = 8;

/// The magnet iterations also end when they have converged to 1: at less than this squared distance.
const CONVERGED: f64 = 1e-4;

/// The formula of an iteration. It is the same for single numbers and for vectors of them.
trait Rule: Copy {
    /// Whether orbits also end near 1.
    const CONVERGES: bool = false;

    /// The point after `z`; the last numbers are the constants 1, 2 and 3.
    fn step<N: Number>(
        self,
        z: OrbitPoint<N>,
        c: Complex<N>,
        one: N,
        two: N,
        three: N,
    ) -> Complex<N>;
}

#[derive(Clone, Copy)]
struct Square;

#[derive(Clone, Copy)]
struct Power(u32);

#[derive(Clone, Copy)]
struct Magnet1;

#[derive(Clone, Copy)]
struct Magnet2;

impl Rule for Square {
    #[inline(always)]
    fn step<N: Number>(self, z: OrbitPoint<N>, c: Complex<N>, _: N, _: N, _: N) -> Complex<N> {
        z.square() + c
    }
}

impl Rule for Power {
    #[inline(always)]
    fn step<N: Number>(self, z: OrbitPoint<N>, c: Complex<N>, _: N, _: N, _: N) -> Complex<N> {
        let mut power = z.number();
        for _ in 1..self.0 {
            power = power * z.number();
        }
        power + c
    }
}

impl Rule for Magnet1 {
    const CONVERGES: bool = true;

    #[inline(always)]
    fn step<N: Number>(self, z: OrbitPoint<N>, c: Complex<N>, one: N, two: N, _: N) -> Complex<N> {
        let numerator = (z.square() + c).minus_real(one);
        let denominator = (z.number() * two + c).minus_real(two);
        let q = numerator / denominator;
        q * q
    }
}

impl Rule for Magnet2 {
    const CONVERGES: bool = true;

    #[inline(always)]
    fn step<N: Number>(
        self,
        z: OrbitPoint<N>,
        c: Complex<N>,
        one: N,
        two: N,
        three: N,
    ) -> Complex<N> {
        let (c1, c2) = (c.minus_real(one), c.minus_real(two));
        let c12 = c1 * c2;
        let (z, z2) = (z.number(), z.square());
        let numerator = z2 * z + c1 * z * three + c12;
        let denominator = (z2 * three + c2 * z * three + c12).plus_real(one);
        let q = numerator / denominator;
        q * q
    }
}
