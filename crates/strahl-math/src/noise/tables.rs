//! The measured tables behind the noise functions, decoded from `tables.bin`.
//!
//! The file holds, little-endian and without gaps: the hash permutation (4096 × u16), the values and gradients
//! (267 × i32, in units of 1e-8), the permutation of the gradient noise (2048 × u16, as measured: 0 occurs twice and 1017
//! never), and its gradients before normalisation (2048 × 3 × i16).

use std::sync::LazyLock;

use crate::DVec3;

const FILE: &[u8; GRADIENTS_AT + 2048 * 6] = include_bytes!("tables.bin");

const R_LEN: usize = 267;
const R_AT: usize = 4096 * 2;
const PERMUTATION_AT: usize = R_AT + R_LEN * 4;
const GRADIENTS_AT: usize = PERMUTATION_AT + 2048 * 2;

const fn u16_at(at: usize) -> u16 {
    u16::from_le_bytes([FILE[at], FILE[at + 1]])
}

static HASH: [u16; 4096] = {
    let mut table = [0; 4096];
    let mut i = 0;
    while i < 4096 {
        table[i] = u16_at(2 * i);
        i += 1;
    }
    table
};

/// The permutation of `0..4096`; the argument is taken modulo 4096.
#[inline(always)]
pub(super) fn hash(i: usize) -> u16 {
    HASH[i & 4095]
}

/// Vectors of which none lies in two cache lines.
#[repr(align(64))]
pub(super) struct InLines<const N: usize>(pub(super) [[f64; 4]; N]);

/// For scalar noise: half the values of 256 corners, and their gradients along x, y and z.
pub(super) static CORNERS: InLines<256> = {
    let mut table = [[0.0; 4]; 256];
    let mut h = 0;
    while h < 256 {
        table[h] = [0.5 * R[h], R[h + 1], R[h + 2], R[h + 3]];
        h += 1;
    }
    InLines(table)
};

/// For vector noise: what its three components have at a corner. Entry `h` has the values of corner `h`, the next three entries the
/// gradients along x, y and z.
pub(super) static SPREAD: InLines<{ R_LEN - 8 }> = {
    let mut table = [[0.0; 4]; R_LEN - 8];
    let mut h = 0;
    while h < R_LEN - 8 {
        table[h] = [R[h], R[h + 4], R[h + 8], 0.0];
        h += 1;
    }
    InLines(table)
};

/// Values and gradients in `-1..=1`, overlapping.
pub(super) static R: [f64; R_LEN] = {
    let mut table = [0.0; R_LEN];
    let mut i = 0;
    while i < R_LEN {
        let at = R_AT + 4 * i;
        let units = i32::from_le_bytes([FILE[at], FILE[at + 1], FILE[at + 2], FILE[at + 3]]);
        // The quotient of two integers is the double nearest to the decimal number.
        table[i] = units as f64 / 1e8;
        i += 1;
    }
    table
};

/// The "permutation" of `0..2048` of the gradient noise.
pub(super) static PERMUTATION: [u16; 2048] = {
    let mut table = [0; 2048];
    let mut i = 0;
    while i < 2048 {
        table[i] = u16_at(PERMUTATION_AT + 2 * i);
        i += 1;
    }
    table
};

/// Unit gradients. Computed on first use, because a square root is not a constant expression.
pub(super) static GRADIENTS: LazyLock<Box<[DVec3]>> = LazyLock::new(|| {
    (0..2048)
        .map(|i| {
            let at = GRADIENTS_AT + 6 * i;
            let [x, y, z] = [at, at + 2, at + 4].map(|at| f64::from(u16_at(at) as i16));
            let v = DVec3::new(x, y, z);
            v / v.length()
        })
        .collect()
});
