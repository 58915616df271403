//! Real numbers one by one, or four or eight side by side: the same operations, so the same bits.

use std::ops::{Add, Mul, Sub};
use strahl_simd::Isa;

/// A real number, or several that are computed together.
pub(super) trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    /// This number in every lane of the same kind of number as `self`.
    fn like(self, x: f64) -> Self;
    fn sqrt(self) -> Self;
    fn over(self, other: Self) -> Self;
    /// The larger one; of a NaN and a number the second.
    fn larger(self, other: Self) -> Self;
    /// `yes` where this is at most the limit, else (also for NaN) `no`.
    fn choose_le(self, limit: Self, yes: Self, no: Self) -> Self;
    /// Whether this is at most the limit in some lane.
    fn any_le(self, limit: Self) -> bool;
}

impl Real for f64 {
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        self / other
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn choose_le(self, limit: Self, yes: Self, no: Self) -> Self {
        if self <= limit { yes } else { no }
    }
    #[inline(always)]
    fn any_le(self, limit: Self) -> bool {
        self <= limit
    }
}

/// Four numbers in the lanes of a vector.
#[derive(Clone, Copy)]
pub(super) struct Lanes<I: Isa> {
    isa: I,
    vector: I::F64x4,
}

impl<I: Isa> Lanes<I> {
    #[inline(always)]
    pub(super) fn load(isa: I, numbers: &[f64; 4]) -> Self {
        let vector = isa.load(numbers);
        Self { isa, vector }
    }

    /// Four times lanes in which one is 1 and the others are 0: the first one, the second one, ...
    #[inline(always)]
    pub(super) fn unit_lanes(self) -> [Self; 4] {
        [
            Self::load(self.isa, &[1.0, 0.0, 0.0, 0.0]),
            Self::load(self.isa, &[0.0, 1.0, 0.0, 0.0]),
            Self::load(self.isa, &[0.0, 0.0, 1.0, 0.0]),
            Self::load(self.isa, &[0.0, 0.0, 0.0, 1.0]),
        ]
    }

    #[inline(always)]
    pub(super) fn numbers(self) -> [f64; 4] {
        self.isa.store(self.vector)
    }

    #[inline(always)]
    fn with(self, vector: I::F64x4) -> Self {
        Self { vector, ..self }
    }
}

impl<I: Isa> Add for Lanes<I> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with(self.isa.add(self.vector, other.vector))
    }
}

impl<I: Isa> Sub for Lanes<I> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with(self.isa.sub(self.vector, other.vector))
    }
}

impl<I: Isa> Mul for Lanes<I> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.with(self.isa.mul(self.vector, other.vector))
    }
}

impl<I: Isa> Real for Lanes<I> {
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        self.with(self.isa.splat(x))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.with(self.isa.sqrt(self.vector))
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        self.with(self.isa.div(self.vector, other.vector))
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.with(self.isa.max(self.vector, other.vector))
    }
    #[inline(always)]
    fn choose_le(self, limit: Self, yes: Self, no: Self) -> Self {
        let (limit, yes, no) = (limit.vector, yes.vector, no.vector);
        self.with(self.isa.choose_le(self.vector, limit, yes, no))
    }
    #[inline(always)]
    fn any_le(self, limit: Self) -> bool {
        self.isa.le(self.vector, limit.vector) != 0
    }
}

/// Two numbers, or two vectors of them, that are computed side by side.
#[derive(Clone, Copy)]
pub(super) struct Pair<R>(R, R);

impl<I: Isa> Pair<Lanes<I>> {
    #[inline(always)]
    pub(super) fn load(isa: I, &[a, b, c, d, e, f, g, h]: &[f64; 8]) -> Self {
        Self(
            Lanes::load(isa, &[a, b, c, d]),
            Lanes::load(isa, &[e, f, g, h]),
        )
    }

    #[inline(always)]
    pub(super) fn numbers(self) -> [f64; 8] {
        let ([a, b, c, d], [e, f, g, h]) = (self.0.numbers(), self.1.numbers());
        [a, b, c, d, e, f, g, h]
    }
}

impl<R: Real> Add for Pair<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }
}

impl<R: Real> Sub for Pair<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0, self.1 - other.1)
    }
}

impl<R: Real> Mul for Pair<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0, self.1 * other.1)
    }
}

impl<R: Real> Real for Pair<R> {
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        Self(self.0.like(x), self.1.like(x))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        Self(self.0.over(other.0), self.1.over(other.1))
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self(self.0.larger(other.0), self.1.larger(other.1))
    }
    #[inline(always)]
    fn choose_le(self, limit: Self, yes: Self, no: Self) -> Self {
        Self(
            self.0.choose_le(limit.0, yes.0, no.0),
            self.1.choose_le(limit.1, yes.1, no.1),
        )
    }
    #[inline(always)]
    fn any_le(self, limit: Self) -> bool {
        // Without a branch in between.
        self.0.any_le(limit.0) | self.1.any_le(limit.1)
    }
}
