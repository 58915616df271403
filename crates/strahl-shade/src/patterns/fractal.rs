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
        // Each iteration has its own loop.
        match self.kind {
            FractalKind::Power { exponent: 2 } => self.follow(point, |z| product(z, z) + c),
            FractalKind::Power { exponent } => self.follow(point, |z| {
                let mut power = z;
                for _ in 1..exponent {
                    power = product(power, z);
                }
                power + c
            }),
            FractalKind::Magnet1 => self.follow(point, |z| magnet_1(z, c)),
            FractalKind::Magnet2 => self.follow(point, |z| magnet_2(z, c)),
        }
    }

    fn is_mandelbrot(&self) -> bool {
        self.julia.is_none() && self.kind == FractalKind::Power { exponent: 2 }
    }

    /// The value at a point, by its orbit under `step`.
    ///
    /// An orbit that returns exactly to one of its points is a cycle from there on, so whole rounds are left out (Brent 1980). Most
    /// orbits of the inside do so long before they are complete.
    #[inline(always)]
    fn follow(&self, point: DVec2, step: impl Fn(DVec2) -> DVec2) -> f64 {
        /// The magnet iterations also end when they have converged to 1.
        const CONVERGED: f64 = 1e-4;
        let magnet = !matches!(self.kind, FractalKind::Power { .. });
        let bailout = if magnet { 1e4 } else { 4.0 };
        // A magnet's Mandelbrot orbit starts at zero, which would always be the smallest.
        let (mut z, mut smallest) = if magnet && self.julia.is_none() {
            (DVec2::ZERO, f64::INFINITY)
        } else {
            (point, point.length_squared())
        };
        let (mut number, mut end) = (0, self.iterations);
        // A point that the orbit may return to, where it was reached, and the steps to the next such point.
        let (mut seen, mut seen_at, mut stretch) = (z, 0, 8);
        while number < end {
            z = step(z);
            let absolute = z.length_squared();
            if absolute < smallest {
                smallest = absolute;
            }
            let converged = magnet && (z - DVec2::X).length_squared() < CONVERGED;
            if !(absolute <= bailout) || converged {
                return self.outside(number, z);
            }
            number += 1;
            if z == seen {
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
            Interior::RealSquared(f) => z.x * z.x * f,
            Interior::ImaginarySquared(f) => z.y * z.y * f,
            Interior::Absolute(f) => z.length() * f,
        }
    }

    fn outside(&self, step: u32, z: DVec2) -> f64 {
        match self.exterior {
            Exterior::Constant(f) => f,
            Exterior::Steps => f64::from(step) / f64::from(self.iterations),
            Exterior::Real(f) => z.x * f,
            Exterior::Imaginary(f) => z.y * f,
            Exterior::RealSquared(f) => z.x * z.x * f,
            Exterior::ImaginarySquared(f) => z.y * z.y * f,
            Exterior::Absolute(f) => z.length() * f,
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

fn magnet_1(z: DVec2, c: DVec2) -> DVec2 {
    let one = DVec2::X;
    let numerator = product(z, z) + c - one;
    let denominator = z * 2.0 + c - one * 2.0;
    let q = quotient(numerator, denominator);
    product(q, q)
}

fn magnet_2(z: DVec2, c: DVec2) -> DVec2 {
    let one = DVec2::X;
    let (c1, c2) = (c - one, c - one * 2.0);
    let c12 = product(c1, c2);
    let z2 = product(z, z);
    let numerator = product(z2, z) + product(c1, z) * 3.0 + c12;
    let denominator = z2 * 3.0 + product(c2, z) * 3.0 + c12 + one;
    let q = quotient(numerator, denominator);
    product(q, q)
}

/// The product of complex numbers.
#[inline]
fn product(a: DVec2, b: DVec2) -> DVec2 {
    DVec2::new(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x)
}

/// The quotient of complex numbers.
#[inline]
fn quotient(a: DVec2, b: DVec2) -> DVec2 {
    product(a, DVec2::new(b.x, -b.y)) / b.length_squared()
}
