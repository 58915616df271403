use std::ops::{Add, Div, Mul, Sub};

use strahl_math::DVec2;

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
        if let Interior::Constant(value) = self.interior
            && self.is_mandelbrot()
            && in_largest_parts(point)
        {
            return value;
        }
        let c = self.julia.unwrap_or(point);
        // Each iteration has its own loop. All numbers are single ones: with `c` as a vector compilers move the coordinates of the orbit
        // into one register and out again in each step, and a step takes as long as its chain of operations.
        let (x, y) = (point.x, point.y);
        match self.kind {
            FractalKind::Power { exponent: 2 } => self.square(x, y, c.x, c.y),
            FractalKind::Power { exponent } => self.power(exponent, x, y, c.x, c.y),
            FractalKind::Magnet1 => self.magnet_1(x, y, c.x, c.y),
            FractalKind::Magnet2 => self.magnet_2(x, y, c.x, c.y),
        }
    }

    #[inline(never)]
    fn square(&self, x: f64, y: f64, c_x: f64, c_y: f64) -> f64 {
        self.follow(Complex::new(x, y), |z| z.square() + Complex::new(c_x, c_y))
    }

    #[inline(never)]
    fn power(&self, exponent: u32, x: f64, y: f64, c_x: f64, c_y: f64) -> f64 {
        self.follow(Complex::new(x, y), |z| {
            let mut power = z.number();
            for _ in 1..exponent {
                power = power * z.number();
            }
            power + Complex::new(c_x, c_y)
        })
    }

    #[inline(never)]
    fn magnet_1(&self, x: f64, y: f64, c_x: f64, c_y: f64) -> f64 {
        let c = Complex::new(c_x, c_y);
        self.follow(Complex::new(x, y), |z| {
            let numerator = z.square() + c - Complex::ONE;
            let denominator = z.number() * 2.0 + c - Complex::ONE * 2.0;
            let q = numerator / denominator;
            q * q
        })
    }

    #[inline(never)]
    fn magnet_2(&self, x: f64, y: f64, c_x: f64, c_y: f64) -> f64 {
        let c = Complex::new(c_x, c_y);
        let (c1, c2) = (c - Complex::ONE, c - Complex::ONE * 2.0);
        let c12 = c1 * c2;
        self.follow(Complex::new(x, y), |z| {
            let (z, z2) = (z.number(), z.square());
            let numerator = z2 * z + c1 * z * 3.0 + c12;
            let denominator = z2 * 3.0 + c2 * z * 3.0 + c12 + Complex::ONE;
            let q = numerator / denominator;
            q * q
        })
    }

    fn is_mandelbrot(&self) -> bool {
        self.julia.is_none() && self.kind == FractalKind::Power { exponent: 2 }
    }

    /// The value at a point, by its orbit under `step`.
    ///
    /// An orbit that returns exactly to one of its points is a cycle from there on, so whole rounds are left out (Brent 1980). Most
    /// orbits of the inside do so long before they are complete.
    #[inline(always)]
    fn follow(&self, point: Complex, step: impl Fn(OrbitPoint) -> Complex) -> f64 {
        /// The magnet iterations also end when they have converged to 1.
        const CONVERGED: f64 = 1e-4;
        let magnet = !matches!(self.kind, FractalKind::Power { .. });
        let bailout = if magnet { 1e4 } else { 4.0 };
        // A magnet's Mandelbrot orbit starts at zero, which would always be the smallest.
        let (start, mut smallest) = if magnet && self.julia.is_none() {
            (Complex::new(0.0, 0.0), f64::INFINITY)
        } else {
            (point, point.norm2())
        };
        let mut z = OrbitPoint::new(start);
        let (mut number, mut end) = (0, self.iterations);
        // A point that the orbit may return to, where it was reached, and the steps to the next such point.
        let (mut seen, mut seen_at, mut stretch) = (z, 0, 8);
        while number < end {
            z = OrbitPoint::new(step(z));
            let absolute = z.x2 + z.y2;
            if absolute < smallest {
                smallest = absolute;
            }
            let converged = magnet && (z.number() - Complex::ONE).norm2() < CONVERGED;
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

    fn outside(&self, step: u32, z: OrbitPoint) -> f64 {
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

/// A point of an orbit with the squares of its coordinates.
#[derive(Clone, Copy)]
struct OrbitPoint {
    x: f64,
    y: f64,
    x2: f64,
    y2: f64,
}

impl OrbitPoint {
    #[inline(always)]
    fn new(z: Complex) -> Self {
        Self {
            x: z.x,
            y: z.y,
            x2: z.x * z.x,
            y2: z.y * z.y,
        }
    }

    #[inline(always)]
    fn number(self) -> Complex {
        Complex::new(self.x, self.y)
    }

    #[inline(always)]
    fn square(self) -> Complex {
        Complex::new(self.x2 - self.y2, (self.x + self.x) * self.y)
    }
}

/// The complex number x + iy.
#[derive(Clone, Copy)]
struct Complex {
    x: f64,
    y: f64,
}

impl Complex {
    const ONE: Self = Self::new(1.0, 0.0);

    #[inline(always)]
    const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// The squared absolute value.
    #[inline(always)]
    fn norm2(self) -> f64 {
        self.x * self.x + self.y * self.y
    }
}

impl Add for Complex {
    type Output = Self;

    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::new(self.x + b.x, self.y + b.y)
    }
}

impl Sub for Complex {
    type Output = Self;

    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self::new(self.x - b.x, self.y - b.y)
    }
}

impl Mul for Complex {
    type Output = Self;

    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self::new(self.x * b.x - self.y * b.y, self.x * b.y + self.y * b.x)
    }
}

impl Mul<f64> for Complex {
    type Output = Self;

    #[inline(always)]
    fn mul(self, b: f64) -> Self {
        Self::new(self.x * b, self.y * b)
    }
}

impl Div for Complex {
    type Output = Self;

    #[inline(always)]
    fn div(self, b: Self) -> Self {
        let (q, norm) = (self * Self::new(b.x, -b.y), b.norm2());
        Self::new(q.x / norm, q.y / norm)
    }
}
