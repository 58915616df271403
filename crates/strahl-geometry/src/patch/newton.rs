//! The point at which a ray meets a piece of a patch, by Newton's method.

use super::frame::Frame;
use super::hull::OVERLAP;
use super::net::{Jet, Net, bernstein};
use super::piece::Square;
use strahl_math::DVec3;
use strahl_math::error::gamma;
use strahl_simd::Isa;

/// Newton's method doubles the digits in each round, from one or two.
const ROUNDS: u32 = 16;
/// A step by this part of the piece is the last one: after it the error is its square.
const LAST_STEP: f64 = 1e-8;
/// A place where the ray meets the patch, perhaps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) t: f64,
    pub(super) u: f64,
    pub(super) v: f64,
    /// 1, or -1 where the patch is seen mirrored; 0 where the search gave up.
    pub(super) sign: i32,
    /// How well `u` and `v` are known, at least as much as pieces overlap.
    pub(super) zone: [f64; 2],
    /// Whether it lies where pieces overlap, so that it may be found twice or may be beyond the border.
    pub(super) is_doubtful: bool,
}

impl Candidate {
    /// The parameters, moved to the border if they are beyond it.
    pub(super) fn place(&self) -> [f64; 2] {
        [self.u.clamp(0.0, 1.0), self.v.clamp(0.0, 1.0)]
    }

    /// Whether it is the same place as another one, found from a neighbouring piece.
    pub(super) fn is_twin(&self, other: &Self) -> bool {
        other.sign == self.sign
            && (other.u - self.u).abs() <= other.zone[0] + self.zone[0]
            && (other.v - self.v).abs() <= other.zone[1] + self.zone[1]
    }

    /// Whether a place is as near to it as its parameters are known.
    pub(super) fn is_about(&self, [u, v]: [f64; 2]) -> bool {
        (self.u - u).abs() <= 2.0 * self.zone[0] && (self.v - v).abs() <= 2.0 * self.zone[1]
    }

    /// How far within the border it lies, in units of its zone; negative outside.
    pub(super) fn margin(&self) -> f64 {
        let side = |x: f64, zone: f64| if x < 0.5 { x / zone } else { (1.0 - x) / zone };
        let [u, v] = [side(self.u, self.zone[0]), side(self.v, self.zone[1])];
        if u < v { u } else { v }
    }
}

/// A rectangle of parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rectangle {
    pub(super) from: [f64; 2],
    pub(super) size: [f64; 2],
}

impl Rectangle {
    pub(super) fn of(Square { level, i, j }: Square) -> Self {
        let side = 1.0 / f64::from(1_u32 << level);
        Self {
            from: [f64::from(i) * side, f64::from(j) * side],
            size: [side; 2],
        }
    }
}

/// The control points of a patch as the way from the origin of a ray to them, times their weights, and the weights.
pub(super) type Ways<I, const K: usize> = [[<I as Isa>::F64x4; K]; K];

/// The ways to all control points, and a bound of the rounding error of what is computed from them.
#[inline(always)]
pub(super) fn ways<I: Isa, const K: usize>(
    isa: I,
    net: &Net<4, K>,
    frame: &Frame,
) -> (Ways<I, K>, f64) {
    let zero = isa.splat(0.0);
    let (mut ways, mut largest) = ([[zero; K]; K], zero);
    let o = frame.origin;
    let origin = isa.load(&[o.x, o.y, o.z, 0.0]);
    for (row, own) in net.rows.iter().zip(&mut ways) {
        for (p, way) in row.iter().zip(own) {
            *way = if p[3] == 1.0 {
                isa.sub(isa.load(p), origin)
            } else {
                let DVec3 { x, y, z } = frame.to(p);
                isa.load(&[x, y, z, p[3]])
            };
            largest = isa.max(largest, isa.abs(*way));
        }
    }
    let [x, y, z, _] = isa.store(largest);
    let largest = if x > y { x } else { y };
    let largest = if z > largest { z } else { largest };
    (ways, largest * gamma(4 * K as u32))
}

/// The sum of coefficients times weights.
#[inline(always)]
fn weighted<I: Isa, const K: usize>(isa: I, c: &[I::F64x4; K], w: &[f64; K]) -> I::F64x4 {
    let mut sum = isa.mul(c[0], isa.splat(w[0]));
    for i in 1..K {
        sum = isa.add(sum, isa.mul(c[i], isa.splat(w[i])));
    }
    sum
}

/// The value and both derivatives, as [`Net::jet`].
#[inline(always)]
pub(super) fn jet<I: Isa, const K: usize>(isa: I, ways: &Ways<I, K>, [u, v]: [f64; 2]) -> Jet<4> {
    let ((bu, su), (bv, sv)) = (bernstein::<K>(u), bernstein::<K>(v));
    let zero = isa.splat(0.0);
    let (mut values, mut slopes) = ([zero; K], [zero; K]);
    for j in 0..K {
        values[j] = weighted(isa, &ways[j], &bu);
        slopes[j] = weighted(isa, &ways[j], &su);
    }
    Jet {
        value: isa.store(weighted(isa, &values, &bv)),
        by_u: isa.store(weighted(isa, &slopes, &bv)),
        by_v: isa.store(weighted(isa, &values, &sv)),
    }
}

/// A number, or the nearer end of a range if it is outside.
#[inline(always)]
fn clamped(x: f64, low: f64, high: f64) -> f64 {
    if x < low {
        low
    } else if x > high {
        high
    } else {
        x
    }
}

/// What Newton's method has found.
pub(super) enum Found {
    /// There is no hit of the piece within (nearly) the window.
    Nothing,
    /// The surface is folded or collapsed there: nothing is known.
    Lost,
    /// It has not come to rest, but it ended in the window: there may be a hit there.
    Near(Candidate),
    /// A hit to the last digits.
    Hit(Candidate),
}

/// Newton's method for the parameters at which a ray meets a patch: those of a hit of the piece, if it has one within (nearly) the
/// window.
#[inline(always)]
pub(super) fn newton<I: Isa, const K: usize>(
    isa: I,
    (ways, noise): (&Ways<I, K>, f64),
    frame: &Frame,
    (window, piece): (&Rectangle, &Rectangle),
    start: [f64; 2],
) -> Found {
    let low = [
        window.from[0] - 0.25 * window.size[0],
        window.from[1] - 0.25 * window.size[1],
    ];
    let high = [
        window.from[0] + 1.25 * window.size[0],
        window.from[1] + 1.25 * window.size[1],
    ];
    let Rectangle { from, size } = *piece;
    let to = [from[0] + size[0], from[1] + size[1]];
    let mut at = [
        clamped(start[0], window.from[0], window.from[0] + window.size[0]),
        clamped(start[1], window.from[1], window.from[1] + window.size[1]),
    ];
    let seen = |v: &[f64; 4]| frame.seen(DVec3::new(v[0], v[1], v[2]));
    for round in 0..ROUNDS {
        let mut jet_here = jet(isa, ways, at);
        let Jet { value, by_u, by_v } = jet_here;
        let (f, a, b) = (seen(&value), seen(&by_u), seen(&by_v));
        let determinant = a[0] * b[1] - a[1] * b[0];
        let mut step = [
            (f[0] * b[1] - f[1] * b[0]) / determinant,
            (f[1] * a[0] - f[0] * a[1]) / determinant,
        ];
        if !(step[0].is_finite() && step[1].is_finite()) {
            return Found::Lost;
        }
        let is_last = step[0].abs() < LAST_STEP * size[0] && step[1].abs() < LAST_STEP * size[1];
        if !is_last {
            // Not far beyond the piece.
            let before = at;
            for k in 0..2 {
                at[k] = clamped(at[k] - step[k], low[k], high[k]);
            }
            // Without a hit in the window it stays where it is held back.
            if round + 1 < ROUNDS && at != before {
                continue;
            }
            (jet_here, step) = (jet(isa, ways, at), [0.0; 2]);
        } else {
            at = [at[0] - step[0], at[1] - step[1]];
        }
        let length = |v: [f64; 2]| (v[0] * v[0] + v[1] * v[1]).sqrt();
        let error = 16.0 * noise / determinant.abs();
        let zone = [
            OVERLAP * size[0] + error * length(b),
            OVERLAP * size[1] + error * length(a),
        ];
        let mut is_doubtful = !is_last;
        for k in 0..2 {
            let (before, after) = (at[k] - from[k], to[k] - at[k]);
            if before < -zone[k] || after < -zone[k] {
                return Found::Nothing;
            }
            // What does not come to rest has no hit in the window, if it gets out of it.
            let rim = zone[k] - OVERLAP * (size[k] - window.size[k]);
            let (before, after) = (
                at[k] - window.from[k],
                window.from[k] + window.size[k] - at[k],
            );
            if !is_last && (before < -rim || after < -rim) {
                return Found::Nothing;
            }
            let (before, after) = (at[k] - from[k], to[k] - at[k]);
            is_doubtful |= before <= zone[k] || after <= zone[k];
        }
        let candidate = Candidate {
            t: frame.t_of(&jet_here, step),
            u: at[0],
            v: at[1],
            sign: if determinant > 0.0 { 1 } else { -1 },
            zone,
            is_doubtful,
        };
        return if is_last {
            Found::Hit(candidate)
        } else {
            Found::Near(candidate)
        };
    }
    Found::Nothing
}
