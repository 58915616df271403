//! The levels of x86-64.
#![expect(
    unsafe_code,
    reason = "vector instructions: the home of the workspace's unsafe code, see the crate's documentation"
)]

use crate::portable::{lane_by_lane, pairs_of_eight};
use crate::{Isa, Lanes8, Lanes16, Level};
use std::arch::x86_64::*;

/// Proof of SSE 4.1. Its vectors are arrays that the compiler splits into two registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sse4(());

/// Proof of AVX2 and FMA.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Avx2(());

/// Proof of AVX-512 F, VL, DQ, BW and everything of [`Avx2`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Avx512(());

impl Sse4 {
    /// The proof, if this processor has it.
    pub fn detect() -> Option<Self> {
        is_x86_feature_detected!("sse4.1").then_some(Self(()))
    }
}

impl Avx2 {
    /// The proof, if this processor has it.
    pub fn detect() -> Option<Self> {
        let found = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt");
        found.then_some(Self(()))
    }
}

impl Avx512 {
    /// The proof, if this processor has it.
    pub fn detect() -> Option<Self> {
        let found = Avx2::detect().is_some()
            && is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512bw");
        found.then_some(Self(()))
    }
}

impl Isa for Sse4 {
    const LEVEL: Level = Level::Sse4;

    #[inline(always)]
    fn call<R>(self, kernel: impl FnOnce() -> R) -> R {
        #[target_feature(enable = "sse4.1")]
        #[inline]
        fn compiled<R>(kernel: impl FnOnce() -> R) -> R {
            kernel()
        }
        // SAFETY: `self` proves the feature.
        unsafe { compiled(kernel) }
    }

    lane_by_lane!();
    pairs_of_eight!();
}

/// The vectors of AVX2, which with AVX-512 have more registers, up to eight lanes. Comparisons give masks in vectors there too,
/// because AVX-512's mask registers have a higher latency to a branch.
macro_rules! avx {
    () => {
        type F32x8 = __m256;
        type F64x4 = __m256d;

        #[inline(always)]
        fn splat_f32(self, x: f32) -> __m256 {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_set1_ps(x) }
        }

        #[inline(always)]
        fn load_f32(self, lanes: &Lanes8) -> __m256 {
            // SAFETY: `self` proves AVX; the eight floats are there, aligned to 32 bytes by their type.
            unsafe { _mm256_load_ps(lanes.0.as_ptr()) }
        }

        #[inline(always)]
        fn load_half(self, lanes: &Lanes16, half: usize) -> __m256 {
            // SAFETY: `self` proves AVX; both halves are eight floats, aligned to 32 bytes by the type.
            unsafe { _mm256_load_ps(lanes.0.as_ptr().add(half % 2 * 8)) }
        }

        #[inline(always)]
        fn store_f32(self, v: __m256) -> Lanes8 {
            let mut lanes = Lanes8([0.0; 8]);
            // SAFETY: `self` proves AVX; there is room for eight floats, aligned to 32 bytes by their type.
            unsafe { _mm256_store_ps(lanes.0.as_mut_ptr(), v) };
            lanes
        }

        #[inline(always)]
        fn mul_sub(self, a: __m256, b: __m256, c: __m256) -> __m256 {
            // SAFETY: `self` proves FMA.
            unsafe { _mm256_fmsub_ps(a, b, c) }
        }

        #[inline(always)]
        fn mul_add(self, a: __m256, b: __m256, c: __m256) -> __m256 {
            // SAFETY: `self` proves FMA.
            unsafe { _mm256_fmadd_ps(a, b, c) }
        }

        #[inline(always)]
        fn min_f32(self, a: __m256, b: __m256) -> __m256 {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_min_ps(a, b) }
        }

        #[inline(always)]
        fn max_f32(self, a: __m256, b: __m256) -> __m256 {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_max_ps(a, b) }
        }

        #[inline(always)]
        fn min_bits(self, a: __m256, b: __m256) -> __m256 {
            // SAFETY: `self` proves AVX2.
            unsafe {
                let (a, b) = (_mm256_castps_si256(a), _mm256_castps_si256(b));
                _mm256_castsi256_ps(_mm256_min_epi32(a, b))
            }
        }

        #[inline(always)]
        fn max_bits(self, a: __m256, b: __m256) -> __m256 {
            // SAFETY: `self` proves AVX2.
            unsafe {
                let (a, b) = (_mm256_castps_si256(a), _mm256_castps_si256(b));
                _mm256_castsi256_ps(_mm256_max_epi32(a, b))
            }
        }

        #[inline(always)]
        fn mul_f32(self, a: __m256, b: __m256) -> __m256 {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_mul_ps(a, b) }
        }

        #[inline(always)]
        fn sub_f32(self, a: __m256, b: __m256) -> __m256 {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_sub_ps(a, b) }
        }

        #[inline(always)]
        fn div_f32(self, a: __m256, b: __m256) -> __m256 {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_div_ps(a, b) }
        }

        #[inline(always)]
        fn spread<const LANE: usize>(self, a: __m256) -> __m256 {
            // SAFETY: `self` proves AVX2.
            unsafe { _mm256_permutevar8x32_ps(a, _mm256_set1_epi32(LANE as i32)) }
        }

        #[inline(always)]
        fn abs_f32(self, a: __m256) -> __m256 {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), a) }
        }

        #[inline(always)]
        fn prefetch(self, address: *const u8) {
            // SAFETY: every x86-64 processor has SSE; a prefetch of an address that is none does nothing.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(address.cast()) };
        }

        #[inline(always)]
        fn load_bytes(self, lanes: &[u8; 8]) -> __m256 {
            // SAFETY: `self` proves AVX2; the eight bytes are there, and the load needs no alignment.
            unsafe {
                _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64(lanes.as_ptr().cast())))
            }
        }

        #[inline(always)]
        fn load_words(self, lanes: &[u16; 8]) -> __m256 {
            // SAFETY: `self` proves AVX2; the eight integers are there, and the load needs no alignment.
            unsafe {
                _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(_mm_loadu_si128(
                    lanes.as_ptr().cast(),
                )))
            }
        }

        #[inline(always)]
        fn splat(self, x: f64) -> __m256d {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_set1_pd(x) }
        }

        #[inline(always)]
        fn load(self, lanes: &[f64; 4]) -> __m256d {
            // SAFETY: `self` proves AVX; the four numbers are there, and the load needs no alignment.
            unsafe { _mm256_loadu_pd(lanes.as_ptr()) }
        }

        #[inline(always)]
        fn load_wide(self, lanes: &[f32; 4]) -> __m256d {
            // SAFETY: `self` proves AVX; the four numbers are there, and the load needs no alignment.
            unsafe { _mm256_cvtps_pd(_mm_loadu_ps(lanes.as_ptr())) }
        }

        #[inline(always)]
        fn store(self, v: __m256d) -> [f64; 4] {
            let mut lanes = [0.0; 4];
            // SAFETY: `self` proves AVX; there is room for four numbers, and the store needs no alignment.
            unsafe { _mm256_storeu_pd(lanes.as_mut_ptr(), v) };
            lanes
        }

        #[inline(always)]
        fn narrow_f32(self, v: __m256d) -> __m256 {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_zextps128_ps256(_mm256_cvtpd_ps(v)) }
        }

        #[inline(always)]
        fn narrow(self, v: __m256d) -> [f32; 4] {
            let mut lanes = [0.0; 4];
            // SAFETY: `self` proves AVX; there is room for four numbers, and the store needs no alignment.
            unsafe { _mm_storeu_ps(lanes.as_mut_ptr(), _mm256_cvtpd_ps(v)) };
            lanes
        }

        #[inline(always)]
        fn add(self, a: __m256d, b: __m256d) -> __m256d {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_add_pd(a, b) }
        }

        #[inline(always)]
        fn sub(self, a: __m256d, b: __m256d) -> __m256d {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_sub_pd(a, b) }
        }

        #[inline(always)]
        fn mul(self, a: __m256d, b: __m256d) -> __m256d {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_mul_pd(a, b) }
        }

        #[inline(always)]
        fn div(self, a: __m256d, b: __m256d) -> __m256d {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_div_pd(a, b) }
        }

        #[inline(always)]
        fn sqrt(self, a: __m256d) -> __m256d {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_sqrt_pd(a) }
        }

        #[inline(always)]
        fn abs(self, a: __m256d) -> __m256d {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), a) }
        }

        #[inline(always)]
        fn floor(self, a: __m256d) -> __m256d {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_floor_pd(a) }
        }

        #[inline(always)]
        fn min(self, a: __m256d, b: __m256d) -> __m256d {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_min_pd(a, b) }
        }

        #[inline(always)]
        fn max(self, a: __m256d, b: __m256d) -> __m256d {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_max_pd(a, b) }
        }

        #[inline(always)]
        fn choose_le(self, a: __m256d, b: __m256d, yes: __m256d, no: __m256d) -> __m256d {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_blendv_pd(no, yes, _mm256_cmp_pd::<_CMP_LE_OQ>(a, b)) }
        }

        #[inline(always)]
        fn lt_f32(self, a: __m256, b: __m256) -> u32 {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(a, b)) as u32 }
        }

        #[inline(always)]
        fn le_f32(self, a: __m256, b: __m256) -> u32 {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32 }
        }

        #[inline(always)]
        fn le(self, a: __m256d, b: __m256d) -> u32 {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(a, b)) as u32 }
        }

        #[inline(always)]
        fn lt(self, a: __m256d, b: __m256d) -> u32 {
            // SAFETY: `self` proves AVX.
            unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(a, b)) as u32 }
        }

        #[inline(always)]
        fn load_columns(self, [a, b, c, d]: [&[f64; 4]; 4]) -> [__m256d; 4] {
            // SAFETY: `self` proves AVX; each row is four numbers, both halves are read, and the loads need no alignment. To put a half from
            // memory into a register takes no unit that shuffles.
            unsafe {
                let (a, b, c, d) = (a.as_ptr(), b.as_ptr(), c.as_ptr(), d.as_ptr());
                let p = _mm256_loadu2_m128d(c, a);
                let q = _mm256_loadu2_m128d(d, b);
                let r = _mm256_loadu2_m128d(c.add(2), a.add(2));
                let s = _mm256_loadu2_m128d(d.add(2), b.add(2));
                [
                    _mm256_unpacklo_pd(p, q),
                    _mm256_unpackhi_pd(p, q),
                    _mm256_unpacklo_pd(r, s),
                    _mm256_unpackhi_pd(r, s),
                ]
            }
        }

        #[inline(always)]
        fn transpose(self, [a, b, c, d]: [__m256d; 4]) -> [__m256d; 4] {
            // SAFETY: `self` proves AVX.
            unsafe {
                let (p, q) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
                let (r, s) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
                [
                    _mm256_permute2f128_pd::<0x20>(p, r),
                    _mm256_permute2f128_pd::<0x20>(q, s),
                    _mm256_permute2f128_pd::<0x31>(p, r),
                    _mm256_permute2f128_pd::<0x31>(q, s),
                ]
            }
        }
    };
}

impl Isa for Avx2 {
    const LEVEL: Level = Level::Avx2;

    #[inline(always)]
    fn call<R>(self, kernel: impl FnOnce() -> R) -> R {
        #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
        #[inline]
        fn compiled<R>(kernel: impl FnOnce() -> R) -> R {
            kernel()
        }
        // SAFETY: `self` proves the features.
        unsafe { compiled(kernel) }
    }

    avx!();
    pairs_of_eight!();
}

impl Isa for Avx512 {
    const LEVEL: Level = Level::Avx512;

    #[inline(always)]
    fn call<R>(self, kernel: impl FnOnce() -> R) -> R {
        #[target_feature(
            enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma,bmi1,bmi2,lzcnt,popcnt"
        )]
        #[inline]
        fn compiled<R>(kernel: impl FnOnce() -> R) -> R {
            kernel()
        }
        // SAFETY: `self` proves the features.
        unsafe { compiled(kernel) }
    }

    avx!();

    type F32x16 = __m512;

    #[inline(always)]
    fn splat_f32x16(self, x: f32) -> __m512 {
        // SAFETY: `self` proves AVX-512.
        unsafe { _mm512_set1_ps(x) }
    }

    #[inline(always)]
    fn load_f32x16(self, lanes: &Lanes16) -> __m512 {
        // SAFETY: `self` proves AVX-512; the sixteen floats are there, aligned to 64 bytes by their type.
        unsafe { _mm512_load_ps(lanes.0.as_ptr()) }
    }

    #[inline(always)]
    fn load_words_x16(self, lanes: &[u16; 16]) -> __m512 {
        // SAFETY: `self` proves AVX-512; the sixteen integers are there, and the load needs no alignment.
        unsafe {
            _mm512_cvtepi32_ps(_mm512_cvtepu16_epi32(_mm256_loadu_si256(
                lanes.as_ptr().cast(),
            )))
        }
    }

    #[inline(always)]
    fn mul_add_f32x16(self, a: __m512, b: __m512, c: __m512) -> __m512 {
        // SAFETY: `self` proves AVX-512.
        unsafe { _mm512_fmadd_ps(a, b, c) }
    }

    #[inline(always)]
    fn mul_sub_f32x16(self, a: __m512, b: __m512, c: __m512) -> __m512 {
        // SAFETY: `self` proves AVX-512.
        unsafe { _mm512_fmsub_ps(a, b, c) }
    }

    #[inline(always)]
    fn mul_f32x16(self, a: __m512, b: __m512) -> __m512 {
        // SAFETY: `self` proves AVX-512.
        unsafe { _mm512_mul_ps(a, b) }
    }

    #[inline(always)]
    fn sub_f32x16(self, a: __m512, b: __m512) -> __m512 {
        // SAFETY: `self` proves AVX-512.
        unsafe { _mm512_sub_ps(a, b) }
    }

    #[inline(always)]
    fn div_f32x16(self, a: __m512, b: __m512) -> __m512 {
        // SAFETY: `self` proves AVX-512.
        unsafe { _mm512_div_ps(a, b) }
    }

    #[inline(always)]
    fn store_f32x16(self, v: __m512) -> Lanes16 {
        let mut lanes = Lanes16([0.0; 16]);
        // SAFETY: `self` proves AVX-512; there is room for sixteen floats, aligned to 64 bytes by their type.
        unsafe { _mm512_store_ps(lanes.0.as_mut_ptr(), v) };
        lanes
    }

    #[inline(always)]
    fn smallest_f32x16(self, v: __m512) -> f32 {
        // SAFETY: `self` proves AVX-512.
        unsafe { _mm512_reduce_min_ps(v) }
    }

    #[inline(always)]
    fn largest_f32x16(self, v: __m512) -> f32 {
        // SAFETY: `self` proves AVX-512.
        unsafe { _mm512_reduce_max_ps(v) }
    }

    #[inline(always)]
    fn abs_f32x16(self, a: __m512) -> __m512 {
        // SAFETY: `self` proves AVX-512.
        unsafe { _mm512_abs_ps(a) }
    }

    #[inline(always)]
    fn min_f32x16(self, a: __m512, b: __m512) -> __m512 {
        // SAFETY: `self` proves AVX-512.
        unsafe { _mm512_min_ps(a, b) }
    }

    #[inline(always)]
    fn max_f32x16(self, a: __m512, b: __m512) -> __m512 {
        // SAFETY: `self` proves AVX-512.
        unsafe { _mm512_max_ps(a, b) }
    }

    #[inline(always)]
    fn min_bits_x16(self, a: __m512, b: __m512) -> __m512 {
        // SAFETY: `self` proves AVX-512.
        unsafe {
            let (a, b) = (_mm512_castps_si512(a), _mm512_castps_si512(b));
            _mm512_castsi512_ps(_mm512_min_epi32(a, b))
        }
    }

    #[inline(always)]
    fn max_bits_x16(self, a: __m512, b: __m512) -> __m512 {
        // SAFETY: `self` proves AVX-512.
        unsafe {
            let (a, b) = (_mm512_castps_si512(a), _mm512_castps_si512(b));
            _mm512_castsi512_ps(_mm512_max_epi32(a, b))
        }
    }

    #[inline(always)]
    fn lt_f32x16(self, a: __m512, b: __m512) -> u32 {
        // SAFETY: `self` proves AVX-512.
        unsafe { u32::from(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b)) }
    }

    #[inline(always)]
    fn le_f32x16(self, a: __m512, b: __m512) -> u32 {
        // SAFETY: `self` proves AVX-512.
        unsafe { u32::from(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b)) }
    }
}
