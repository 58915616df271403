//! Vectors as arrays: the reference of all other levels, and the fallback for targets without them.

use crate::{Isa, Level};

/// The instructions that every processor of the target has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Portable;

/// The smaller of two numbers.
#[inline(always)]
pub(crate) fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger of two numbers.
#[inline(always)]
pub(crate) fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The operations of [`Isa`] on sixteen lanes, for a level whose widest vectors have eight.
macro_rules! pairs_of_eight {
    () => {
        type F32x16 = [Self::F32x8; 2];

        #[inline(always)]
        fn splat_f32x16(self, x: f32) -> Self::F32x16 {
            [self.splat_f32(x); 2]
        }

        #[inline(always)]
        fn load_f32x16(self, lanes: &$crate::Lanes16) -> Self::F32x16 {
            [self.load_half(lanes, 0), self.load_half(lanes, 1)]
        }

        #[inline(always)]
        fn load_words_x16(self, lanes: &[u16; 16]) -> Self::F32x16 {
            let (halves, _) = lanes.as_chunks();
            [self.load_words(&halves[0]), self.load_words(&halves[1])]
        }

        #[inline(always)]
        fn mul_add_f32x16(self, a: Self::F32x16, b: Self::F32x16, c: Self::F32x16) -> Self::F32x16 {
            [
                self.mul_add(a[0], b[0], c[0]),
                self.mul_add(a[1], b[1], c[1]),
            ]
        }

        #[inline(always)]
        fn mul_sub_f32x16(self, a: Self::F32x16, b: Self::F32x16, c: Self::F32x16) -> Self::F32x16 {
            [
                self.mul_sub(a[0], b[0], c[0]),
                self.mul_sub(a[1], b[1], c[1]),
            ]
        }

        #[inline(always)]
        fn mul_f32x16(self, a: Self::F32x16, b: Self::F32x16) -> Self::F32x16 {
            [self.mul_f32(a[0], b[0]), self.mul_f32(a[1], b[1])]
        }

        #[inline(always)]
        fn sub_f32x16(self, a: Self::F32x16, b: Self::F32x16) -> Self::F32x16 {
            [self.sub_f32(a[0], b[0]), self.sub_f32(a[1], b[1])]
        }

        #[inline(always)]
        fn div_f32x16(self, a: Self::F32x16, b: Self::F32x16) -> Self::F32x16 {
            [self.div_f32(a[0], b[0]), self.div_f32(a[1], b[1])]
        }

        #[inline(always)]
        fn store_f32x16(self, v: Self::F32x16) -> $crate::Lanes16 {
            let (low, high) = (self.store_f32(v[0]).0, self.store_f32(v[1]).0);
            let mut all = [0.0; 16];
            all[..8].copy_from_slice(&low);
            all[8..].copy_from_slice(&high);
            $crate::Lanes16(all)
        }

        #[inline(always)]
        fn smallest_f32x16(self, v: Self::F32x16) -> f32 {
            let [a, b, c, d, e, f, g, h] = self.store_f32(self.min_f32(v[0], v[1])).0;
            let smaller = $crate::portable::smaller;
            let (a, c) = (smaller(a, b), smaller(c, d));
            let (e, g) = (smaller(e, f), smaller(g, h));
            smaller(smaller(a, c), smaller(e, g))
        }

        #[inline(always)]
        fn largest_f32x16(self, v: Self::F32x16) -> f32 {
            let [a, b, c, d, e, f, g, h] = self.store_f32(self.max_f32(v[0], v[1])).0;
            let larger = $crate::portable::larger;
            let (a, c) = (larger(a, b), larger(c, d));
            let (e, g) = (larger(e, f), larger(g, h));
            larger(larger(a, c), larger(e, g))
        }

        #[inline(always)]
        fn abs_f32x16(self, a: Self::F32x16) -> Self::F32x16 {
            [self.abs_f32(a[0]), self.abs_f32(a[1])]
        }

        #[inline(always)]
        fn min_f32x16(self, a: Self::F32x16, b: Self::F32x16) -> Self::F32x16 {
            [self.min_f32(a[0], b[0]), self.min_f32(a[1], b[1])]
        }

        #[inline(always)]
        fn max_f32x16(self, a: Self::F32x16, b: Self::F32x16) -> Self::F32x16 {
            [self.max_f32(a[0], b[0]), self.max_f32(a[1], b[1])]
        }

        #[inline(always)]
        fn min_bits_x16(self, a: Self::F32x16, b: Self::F32x16) -> Self::F32x16 {
            [self.min_bits(a[0], b[0]), self.min_bits(a[1], b[1])]
        }

        #[inline(always)]
        fn max_bits_x16(self, a: Self::F32x16, b: Self::F32x16) -> Self::F32x16 {
            [self.max_bits(a[0], b[0]), self.max_bits(a[1], b[1])]
        }

        #[inline(always)]
        fn lt_f32x16(self, a: Self::F32x16, b: Self::F32x16) -> u32 {
            self.lt_f32(a[0], b[0]) | self.lt_f32(a[1], b[1]) << 8
        }

        #[inline(always)]
        fn le_f32x16(self, a: Self::F32x16, b: Self::F32x16) -> u32 {
            self.le_f32(a[0], b[0]) | self.le_f32(a[1], b[1]) << 8
        }
    };
}

/// The operations of [`Isa`] lane by lane, for a level whose vectors are arrays.
macro_rules! lane_by_lane {
    () => {
        type F32x8 = [f32; 8];
        type F64x4 = [f64; 4];

        #[inline(always)]
        fn splat_f32(self, x: f32) -> [f32; 8] {
            [x; 8]
        }

        #[inline(always)]
        fn load_f32(self, lanes: &$crate::Lanes8) -> [f32; 8] {
            lanes.0
        }

        #[inline(always)]
        fn load_half(self, lanes: &$crate::Lanes16, half: usize) -> [f32; 8] {
            std::array::from_fn(|i| lanes.0[half % 2 * 8 + i])
        }

        #[inline(always)]
        fn store_f32(self, v: [f32; 8]) -> $crate::Lanes8 {
            $crate::Lanes8(v)
        }

        #[inline(always)]
        fn mul_sub(self, a: [f32; 8], b: [f32; 8], c: [f32; 8]) -> [f32; 8] {
            std::array::from_fn(|i| a[i] * b[i] - c[i])
        }

        #[inline(always)]
        fn mul_add(self, a: [f32; 8], b: [f32; 8], c: [f32; 8]) -> [f32; 8] {
            std::array::from_fn(|i| a[i] * b[i] + c[i])
        }

        #[inline(always)]
        fn min_f32(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
            std::array::from_fn(|i| if a[i] < b[i] { a[i] } else { b[i] })
        }

        #[inline(always)]
        fn max_f32(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
            std::array::from_fn(|i| if a[i] > b[i] { a[i] } else { b[i] })
        }

        #[inline(always)]
        fn min_bits(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
            let bits = |x: f32| x.to_bits() as i32;
            std::array::from_fn(|i| if bits(a[i]) < bits(b[i]) { a[i] } else { b[i] })
        }

        #[inline(always)]
        fn max_bits(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
            let bits = |x: f32| x.to_bits() as i32;
            std::array::from_fn(|i| if bits(a[i]) > bits(b[i]) { a[i] } else { b[i] })
        }

        #[inline(always)]
        fn mul_f32(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
            std::array::from_fn(|i| a[i] * b[i])
        }

        #[inline(always)]
        fn sub_f32(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
            std::array::from_fn(|i| a[i] - b[i])
        }

        #[inline(always)]
        fn div_f32(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
            std::array::from_fn(|i| a[i] / b[i])
        }

        #[inline(always)]
        fn spread<const LANE: usize>(self, a: [f32; 8]) -> [f32; 8] {
            [a[LANE]; 8]
        }

        #[inline(always)]
        fn abs_f32(self, a: [f32; 8]) -> [f32; 8] {
            std::array::from_fn(|i| a[i].abs())
        }

        #[inline(always)]
        fn lt_f32(self, a: [f32; 8], b: [f32; 8]) -> u32 {
            (0..8).fold(0, |mask, i| mask | u32::from(a[i] < b[i]) << i)
        }

        #[inline(always)]
        fn le_f32(self, a: [f32; 8], b: [f32; 8]) -> u32 {
            (0..8).fold(0, |mask, i| mask | u32::from(a[i] <= b[i]) << i)
        }

        #[inline(always)]
        fn prefetch(self, _: *const u8) {}

        #[inline(always)]
        fn load_bytes(self, lanes: &[u8; 8]) -> [f32; 8] {
            lanes.map(f32::from)
        }

        #[inline(always)]
        fn load_words(self, lanes: &[u16; 8]) -> [f32; 8] {
            lanes.map(f32::from)
        }

        #[inline(always)]
        fn splat(self, x: f64) -> [f64; 4] {
            [x; 4]
        }

        #[inline(always)]
        fn load(self, lanes: &[f64; 4]) -> [f64; 4] {
            *lanes
        }

        #[inline(always)]
        fn load_wide(self, lanes: &[f32; 4]) -> [f64; 4] {
            lanes.map(f64::from)
        }

        #[inline(always)]
        fn store(self, v: [f64; 4]) -> [f64; 4] {
            v
        }

        #[inline(always)]
        fn narrow_f32(self, v: [f64; 4]) -> [f32; 8] {
            let [a, b, c, d] = v;
            [a as f32, b as f32, c as f32, d as f32, 0.0, 0.0, 0.0, 0.0]
        }

        #[inline(always)]
        fn narrow(self, v: [f64; 4]) -> [f32; 4] {
            std::array::from_fn(|i| v[i] as f32)
        }

        #[inline(always)]
        fn add(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
            std::array::from_fn(|i| a[i] + b[i])
        }

        #[inline(always)]
        fn sub(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
            std::array::from_fn(|i| a[i] - b[i])
        }

        #[inline(always)]
        fn mul(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
            std::array::from_fn(|i| a[i] * b[i])
        }

        #[inline(always)]
        fn div(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
            std::array::from_fn(|i| a[i] / b[i])
        }

        #[inline(always)]
        fn sqrt(self, a: [f64; 4]) -> [f64; 4] {
            a.map(f64::sqrt)
        }

        #[inline(always)]
        fn abs(self, a: [f64; 4]) -> [f64; 4] {
            std::array::from_fn(|i| a[i].abs())
        }

        #[inline(always)]
        fn floor(self, a: [f64; 4]) -> [f64; 4] {
            std::array::from_fn(|i| a[i].floor())
        }

        #[inline(always)]
        fn min(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
            std::array::from_fn(|i| if a[i] < b[i] { a[i] } else { b[i] })
        }

        #[inline(always)]
        fn max(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
            std::array::from_fn(|i| if a[i] > b[i] { a[i] } else { b[i] })
        }

        #[inline(always)]
        fn choose_le(self, a: [f64; 4], b: [f64; 4], yes: [f64; 4], no: [f64; 4]) -> [f64; 4] {
            std::array::from_fn(|i| if a[i] <= b[i] { yes[i] } else { no[i] })
        }

        #[inline(always)]
        fn le(self, a: [f64; 4], b: [f64; 4]) -> u32 {
            (0..4).fold(0, |mask, i| mask | u32::from(a[i] <= b[i]) << i)
        }

        #[inline(always)]
        fn lt(self, a: [f64; 4], b: [f64; 4]) -> u32 {
            (0..4).fold(0, |mask, i| mask | u32::from(a[i] < b[i]) << i)
        }

        #[inline(always)]
        fn load_columns(self, rows: [&[f64; 4]; 4]) -> [[f64; 4]; 4] {
            std::array::from_fn(|i| std::array::from_fn(|k| rows[k][i]))
        }

        #[inline(always)]
        fn transpose(self, rows: [[f64; 4]; 4]) -> [[f64; 4]; 4] {
            std::array::from_fn(|i| std::array::from_fn(|k| rows[k][i]))
        }
    };
}
#[cfg(target_arch = "x86_64")]
pub(crate) use {lane_by_lane, pairs_of_eight};

impl Isa for Portable {
    const LEVEL: Level = Level::Portable;

    #[inline(always)]
    fn call<R>(self, kernel: impl FnOnce() -> R) -> R {
        kernel()
    }

    lane_by_lane!();
    pairs_of_eight!();
}
