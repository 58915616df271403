//! Vectors for kernels: eight and sixteen lanes of f32 for culling, four lanes of f64 for decisions.
//!
//! A kernel is written once, generic over an [`Isa`], and entered through [`Isa::call`], which compiles it for the instructions
//! of that level. Every function in it that holds vectors must be `#[inline(always)]`: others (including closures, hence
//! `array::map` and the like) would be compiled without those instructions, which is correct but many times slower.
//! [`Simd::detect`] finds out at run time what the processor has; [`dispatch!`] picks the instantiation.
//!
//! # The same bits everywhere
//! The f64 vectors offer `+ - * / sqrt` and comparisons only, each rounded as IEEE 754 says, lane by lane: no fused operations, no
//! approximate reciprocals. So their results are those of scalar code on every level. The f32 vectors have a fused
//! multiply-add where the processor does; they are for conservative culling, whose error bounds cover both.
//!
//! # Safety
//! This crate contains nearly all `unsafe` code of the workspace. A value of a level's type ([`Avx2`], [`Avx512`], ...) can
//! only be obtained by detection, so holding one proves that its instructions exist. Every `unsafe` block here relies on that,
//! except those that ask for large pages ([`gather_pages`], [`memory::use_large_pages`]) and those of the allocator with a limit ([`memory`]).

mod level;
pub mod memory;
mod pages;
mod portable;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use level::{Level, Simd, UnknownLevel};
pub use pages::gather_pages;
pub use portable::Portable;
#[cfg(target_arch = "x86_64")]
pub use x86::{Avx2, Avx512, Sse4};

/// Eight f32 next to each other, as kernels load them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub struct Lanes8(pub [f32; 8]);

/// Sixteen f32 next to each other, one for each ray of a packet.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes16(pub [f32; 16]);

/// The vectors of one level. Values of implementing types are proofs that the instructions exist.
///
/// Masks have one bit per lane, the first lane in bit 0.
pub trait Isa: Copy + Send + Sync + 'static {
    /// Eight lanes of f32.
    type F32x8: Copy;
    /// Sixteen lanes of f32.
    type F32x16: Copy;
    /// Four lanes of f64.
    type F64x4: Copy;

    /// Which level this is.
    const LEVEL: Level;

    /// Runs a kernel compiled for this level: everything `#[inline(always)]` in it uses its instructions.
    fn call<R>(self, kernel: impl FnOnce() -> R) -> R;

    /// The same number in all lanes.
    fn splat_f32(self, x: f32) -> Self::F32x8;
    /// Eight numbers from memory.
    fn load_f32(self, lanes: &Lanes8) -> Self::F32x8;
    /// To an array.
    fn store_f32(self, v: Self::F32x8) -> Lanes8;
    /// `a b - c`, rounded once or twice: for culling only.
    fn mul_sub(self, a: Self::F32x8, b: Self::F32x8, c: Self::F32x8) -> Self::F32x8;
    /// `a b + c`, rounded once or twice: for culling only.
    fn mul_add(self, a: Self::F32x8, b: Self::F32x8, c: Self::F32x8) -> Self::F32x8;
    /// The smaller number in each lane; neither may be NaN.
    fn min_f32(self, a: Self::F32x8, b: Self::F32x8) -> Self::F32x8;
    /// The larger number in each lane; neither may be NaN.
    fn max_f32(self, a: Self::F32x8, b: Self::F32x8) -> Self::F32x8;
    /// The number in each lane whose bits are the smaller signed integer: that is the smaller number if one of them is positive,
    /// and the larger of two negative ones. Integers are compared in one cycle where numbers take four.
    fn min_bits(self, a: Self::F32x8, b: Self::F32x8) -> Self::F32x8;
    /// The number in each lane whose bits are the larger signed integer: that is the larger number if one of them is positive,
    /// and the smaller of two negative ones.
    fn max_bits(self, a: Self::F32x8, b: Self::F32x8) -> Self::F32x8;
    /// `a b`.
    fn mul_f32(self, a: Self::F32x8, b: Self::F32x8) -> Self::F32x8;
    /// `a - b`.
    fn sub_f32(self, a: Self::F32x8, b: Self::F32x8) -> Self::F32x8;
    /// `a / b`.
    fn div_f32(self, a: Self::F32x8, b: Self::F32x8) -> Self::F32x8;
    /// One lane in all lanes.
    fn spread<const LANE: usize>(self, a: Self::F32x8) -> Self::F32x8;
    /// The absolute values.
    fn abs_f32(self, a: Self::F32x8) -> Self::F32x8;
    /// The lanes where `a < b`; false for NaN.
    fn lt_f32(self, a: Self::F32x8, b: Self::F32x8) -> u32;
    /// The lanes where `a <= b`; false for NaN.
    fn le_f32(self, a: Self::F32x8, b: Self::F32x8) -> u32;

    /// Prefetches the memory at an address, which may be any.
    fn prefetch(self, address: *const u8);

    /// Eight bytes from memory, converted exactly.
    fn load_bytes(self, lanes: &[u8; 8]) -> Self::F32x8;
    /// Eight integers of sixteen bits from memory, converted exactly.
    fn load_words(self, lanes: &[u16; 8]) -> Self::F32x8;

    /// The same number in all lanes.
    fn splat_f32x16(self, x: f32) -> Self::F32x16;
    /// The first or the second eight of sixteen numbers from memory.
    fn load_half(self, lanes: &Lanes16, half: usize) -> Self::F32x8;
    /// Sixteen integers of sixteen bits from memory, converted exactly.
    fn load_words_x16(self, lanes: &[u16; 16]) -> Self::F32x16;
    /// Sixteen numbers from memory.
    fn load_f32x16(self, lanes: &Lanes16) -> Self::F32x16;
    /// `a b + c`, rounded once or twice: for culling only.
    fn mul_add_f32x16(self, a: Self::F32x16, b: Self::F32x16, c: Self::F32x16) -> Self::F32x16;
    /// `a b - c`, rounded once or twice: for culling only.
    fn mul_sub_f32x16(self, a: Self::F32x16, b: Self::F32x16, c: Self::F32x16) -> Self::F32x16;
    /// `a b`.
    fn mul_f32x16(self, a: Self::F32x16, b: Self::F32x16) -> Self::F32x16;
    /// `a - b`.
    fn sub_f32x16(self, a: Self::F32x16, b: Self::F32x16) -> Self::F32x16;
    /// `a / b`.
    fn div_f32x16(self, a: Self::F32x16, b: Self::F32x16) -> Self::F32x16;
    /// To an array.
    fn store_f32x16(self, v: Self::F32x16) -> Lanes16;
    /// The smallest lane; none may be NaN.
    fn smallest_f32x16(self, v: Self::F32x16) -> f32;
    /// The largest lane; none may be NaN.
    fn largest_f32x16(self, v: Self::F32x16) -> f32;
    /// The absolute values.
    fn abs_f32x16(self, a: Self::F32x16) -> Self::F32x16;
    /// The smaller number in each lane; neither may be NaN.
    fn min_f32x16(self, a: Self::F32x16, b: Self::F32x16) -> Self::F32x16;
    /// The larger number in each lane; neither may be NaN.
    fn max_f32x16(self, a: Self::F32x16, b: Self::F32x16) -> Self::F32x16;
    /// As [`Isa::min_bits`].
    fn min_bits_x16(self, a: Self::F32x16, b: Self::F32x16) -> Self::F32x16;
    /// As [`Isa::max_bits`].
    fn max_bits_x16(self, a: Self::F32x16, b: Self::F32x16) -> Self::F32x16;
    /// The lanes where `a < b`; false for NaN.
    fn lt_f32x16(self, a: Self::F32x16, b: Self::F32x16) -> u32;
    /// The lanes where `a <= b`; false for NaN.
    fn le_f32x16(self, a: Self::F32x16, b: Self::F32x16) -> u32;

    /// The same number in all lanes.
    fn splat(self, x: f64) -> Self::F64x4;
    /// Four numbers from memory.
    fn load(self, lanes: &[f64; 4]) -> Self::F64x4;
    /// Four f32 from memory, converted exactly.
    fn load_wide(self, lanes: &[f32; 4]) -> Self::F64x4;
    /// To an array.
    fn store(self, v: Self::F64x4) -> [f64; 4];
    /// As the first four lanes of f32, rounded to the nearest; the others are zeros.
    fn narrow_f32(self, v: Self::F64x4) -> Self::F32x8;
    /// To an array of f32, rounded to the nearest.
    fn narrow(self, v: Self::F64x4) -> [f32; 4];
    /// `a + b`.
    fn add(self, a: Self::F64x4, b: Self::F64x4) -> Self::F64x4;
    /// `a - b`.
    fn sub(self, a: Self::F64x4, b: Self::F64x4) -> Self::F64x4;
    /// `a b`.
    fn mul(self, a: Self::F64x4, b: Self::F64x4) -> Self::F64x4;
    /// `a / b`.
    fn div(self, a: Self::F64x4, b: Self::F64x4) -> Self::F64x4;
    /// The square root.
    fn sqrt(self, a: Self::F64x4) -> Self::F64x4;
    /// The absolute values.
    fn abs(self, a: Self::F64x4) -> Self::F64x4;
    /// The greatest whole numbers that are not above the lanes.
    fn floor(self, a: Self::F64x4) -> Self::F64x4;
    /// The smaller number in each lane; of a NaN and a number, and of equal numbers, the second.
    fn min(self, a: Self::F64x4, b: Self::F64x4) -> Self::F64x4;
    /// The larger number in each lane; of a NaN and a number, and of equal numbers, the second.
    fn max(self, a: Self::F64x4, b: Self::F64x4) -> Self::F64x4;
    /// `yes` where `a <= b`, else `no`.
    fn choose_le(
        self,
        a: Self::F64x4,
        b: Self::F64x4,
        yes: Self::F64x4,
        no: Self::F64x4,
    ) -> Self::F64x4;
    /// The lanes where `a <= b`; false for NaN.
    fn le(self, a: Self::F64x4, b: Self::F64x4) -> u32;
    /// The lanes where `a < b`; false for NaN.
    fn lt(self, a: Self::F64x4, b: Self::F64x4) -> u32;
    /// The columns of a matrix whose rows are in memory.
    fn load_columns(self, rows: [&[f64; 4]; 4]) -> [Self::F64x4; 4];
    /// The columns of a matrix that is given by its rows.
    fn transpose(self, rows: [Self::F64x4; 4]) -> [Self::F64x4; 4];
}

/// The values of `yes` in these lanes, given as bits, else those of `no`.
#[inline(always)]
pub fn select<I: Isa>(isa: I, lanes: u32, yes: I::F64x4, no: I::F64x4) -> I::F64x4 {
    let chosen = isa.load(&CHOSEN[(lanes & 0b1111) as usize]);
    isa.choose_le(isa.splat(1.0), chosen, yes, no)
}

/// Ones in the lanes of a number's bits.
const CHOSEN: [[f64; 4]; 16] = {
    let mut all = [[0.0; 4]; 16];
    let mut bits = 0;
    while bits < 16 {
        let mut lane = 0;
        while lane < 4 {
            all[bits][lane] = (bits >> lane & 1) as f64;
            lane += 1;
        }
        bits += 1;
    }
    all
};

/// Evaluates an expression with the proof of a level, inside of [`Isa::call`].
///
/// `dispatch!(simd, isa => expression)` takes a [`Simd`] and binds `isa` to the [`Isa`] in it.
#[cfg(target_arch = "x86_64")]
#[macro_export]
macro_rules! dispatch {
    ($simd:expr, $isa:ident => $body:expr) => {
        match $simd {
            $crate::Simd::Portable($isa) => $crate::Isa::call(
                $isa,
                #[inline(always)]
                || $body,
            ),
            $crate::Simd::Sse4($isa) => $crate::Isa::call(
                $isa,
                #[inline(always)]
                || $body,
            ),
            $crate::Simd::Avx2($isa) => $crate::Isa::call(
                $isa,
                #[inline(always)]
                || $body,
            ),
            $crate::Simd::Avx512($isa) => $crate::Isa::call(
                $isa,
                #[inline(always)]
                || $body,
            ),
        }
    };
}

/// Evaluates an expression with the proof of a level, inside of [`Isa::call`].
///
/// `dispatch!(simd, isa => expression)` takes a [`Simd`] and binds `isa` to the [`Isa`] in it.
#[cfg(not(target_arch = "x86_64"))]
#[macro_export]
macro_rules! dispatch {
    ($simd:expr, $isa:ident => $body:expr) => {
        match $simd {
            $crate::Simd::Portable($isa) => $crate::Isa::call(
                $isa,
                #[inline(always)]
                || $body,
            ),
        }
    };
}

#[cfg(test)]
mod tests;
