//! Complex numbers whose parts are numbers, or vectors of numbers for several orbits at once.

use std::ops::{Add, Div, Mul, Sub};

use strahl_simd::Isa;

/// A number, or several of them that are computed side by side, each with the same roundings.
pub(super) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
}

impl Number for f64 {}

/// Four numbers.
#[derive(Clone, Copy)]
pub(super) struct Four<I: Isa> {
    pub(super) isa: I,
    pub(super) numbers: I::F64x4,
}

impl<I: Isa> Number for Four<I> {}

impl<I: Isa> Four<I> {
    #[inline(always)]
    pub(super) fn load(isa: I, numbers: &[f64; 4]) -> Self {
        let numbers = isa.load(numbers);
        Self { isa, numbers }
    }
}

impl<I: Isa> Add for Four<I> {
    type Output = Self;

    #[inline(always)]
    fn add(self, b: Self) -> Self {
        let numbers = self.isa.add(self.numbers, b.numbers);
        Self { numbers, ..self }
    }
}

impl<I: Isa> Sub for Four<I> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        let numbers = self.isa.sub(self.numbers, b.numbers);
        Self { numbers, ..self }
    }
}

impl<I: Isa> Mul for Four<I> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        let numbers = self.isa.mul(self.numbers, b.numbers);
        Self { numbers, ..self }
    }
}

impl<I: Isa> Div for Four<I> {
    type Output = Self;

    #[inline(always)]
    fn div(self, b: Self) -> Self {
        let numbers = self.isa.div(self.numbers, b.numbers);
        Self { numbers, ..self }
    }
}

/// A point of an orbit with the squares of its coordinates.
#[derive(Clone, Copy)]
pub(super) struct OrbitPoint<N> {
    pub(super) x: N,
    pub(super) y: N,
    pub(super) x2: N,
    pub(super) y2: N,
}

impl<N: Number> OrbitPoint<N> {
    #[inline(always)]
    pub(super) fn new(z: Complex<N>) -> Self {
        Self {
            x: z.x,
            y: z.y,
            x2: z.x * z.x,
            y2: z.y * z.y,
        }
    }

    #[inline(always)]
    pub(super) fn number(self) -> Complex<N> {
        Complex::new(self.x, self.y)
    }

    #[inline(always)]
    pub(super) fn square(self) -> Complex<N> {
        Complex::new(self.x2 - self.y2, (self.x + self.x) * self.y)
    }

    /// The squared distance from a real number.
    #[inline(always)]
    pub(super) fn distance2_from(self, real: N) -> N {
        let x = self.x - real;
        x * x + self.y2
    }
}

/// The complex number x + iy.
#[derive(Clone, Copy)]
pub(super) struct Complex<N> {
    pub(super) x: N,
    pub(super) y: N,
}

impl<N: Number> Complex<N> {
    #[inline(always)]
    pub(super) const fn new(x: N, y: N) -> Self {
        Self { x, y }
    }

    /// The squared absolute value.
    #[inline(always)]
    pub(super) fn norm2(self) -> N {
        self.x * self.x + self.y * self.y
    }

    /// The sum with a finite real number, whose imaginary part is added, too: it makes 0 of -0.
    #[expect(clippy::eq_op, reason = "the zero of any kind of number")]
    #[inline(always)]
    pub(super) fn plus_real(self, b: N) -> Self {
        Self::new(self.x + b, self.y + (b - b))
    }

    /// The difference from a real number.
    #[inline(always)]
    pub(super) fn minus_real(self, b: N) -> Self {
        Self::new(self.x - b, self.y)
    }
}

impl<N: Number> Add for Complex<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::new(self.x + b.x, self.y + b.y)
    }
}

impl<N: Number> Mul for Complex<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self::new(self.x * b.x - self.y * b.y, self.x * b.y + self.y * b.x)
    }
}

impl<N: Number> Mul<N> for Complex<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, b: N) -> Self {
        Self::new(self.x * b, self.y * b)
    }
}

impl<N: Number> Div for Complex<N> {
    type Output = Self;

    #[inline(always)]
    fn div(self, b: Self) -> Self {
        let norm = b.norm2();
        // The product with the conjugate of b.
        let x = self.x * b.x + self.y * b.y;
        let y = self.y * b.x - self.x * b.y;
        Self::new(x / norm, y / norm)
    }
}
