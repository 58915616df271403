//! The box around a closed algebraic surface.
//!
//! Far away the terms of the highest degree decide. With `p = (X, X u, X v)` and `w = R / X` a polynomial of degree n is `X^n` times
//! a polynomial in w, u and v; where that has no zero for `0 <= w <= 1` and `|u|, |v| <= 1`, the surface does not leave the cube of
//! half-edge R through that face. Both it and the polynomial in the cube are bounded by interval arithmetic on ever smaller
//! cells (R. E. Moore, Interval Analysis, 1966).
//!
//! Where the terms of the highest degree vanish in some direction, as those of `x⁴ - x² + y² + z²` do in all of `x = 0`, the sum of three polynomials
//! of one coordinate each may tell that the surface is closed ([`Separate`]).

use super::terms::Terms;
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec3};

/// Surfaces of higher degrees, or with more terms, get no box: bounding them would take too long.
const MOST_TERMS: usize = 64;
const HIGHEST_DEGREE: u32 = 12;

/// Cells are halved along each axis so often: at most, to prove that there is no surface, and in the rounds that shrink the box.
const DEEPEST: u32 = 5;
const COARSE: u32 = 3;
const FINE: u32 = 5;

/// How many cells may be looked at to prove that the surface is closed.
const MOST_CELLS: u32 = 1500;

/// The half-edges of cubes that are tried, in units of the length from which the leading terms outweigh the others.
const CUBES: [f64; 3] = [2.0, 8.0, 32.0];

/// There is another coarse round if the last one left less of an edge than this.
const WORTHWHILE: f64 = 0.9;

/// The least and the largest value of something.
type Range = (f64, f64);

/// A box around the surface where a polynomial vanishes, if it is certain that the surface is closed; `sums` are the sums of the
/// magnitudes of the coefficients of each degree.
pub(super) fn extent(terms: &Terms, sums: &[f64]) -> Option<Aabb> {
    let list: Vec<([u32; 3], f64)> = terms.iter().filter(|(_, c)| *c != 0.0).collect();
    let degree = terms.degree();
    if degree % 2 == 1 || !(2..=HIGHEST_DEGREE).contains(&degree) || list.len() > MOST_TERMS {
        return None;
    }
    let half = CUBES
        .into_iter()
        .find(|half| is_closed(&list, degree, *half))
        .or_else(|| Separate::of(&list, 1.0).half_edge())
        .or_else(|| Separate::of(&list, -1.0).half_edge())?;
    let inside = Inside {
        terms: &list,
        degree,
        sums,
    };
    let mut all = Aabb::new(DVec3::splat(-half), DVec3::splat(half));
    // Coarse rounds as long as they help, then a fine one.
    let mut levels = COARSE;
    loop {
        let mut found = Aabb::EMPTY;
        inside.collect(&all, levels, &mut found);
        if found.is_empty() {
            // There is no surface at all: nothing is ever hit.
            return Some(Aabb::new(DVec3::ZERO, DVec3::ZERO));
        }
        let left = (found.size() / all.size()).min_element();
        all = found;
        if levels == FINE {
            break;
        }
        if !(left < WORTHWHILE) {
            levels = FINE;
        }
    }
    all.is_bounded().then_some(all)
}

/// Whether the polynomial has no zero outside of a cube.
fn is_closed(terms: &[([u32; 3], f64)], degree: u32, half: f64) -> bool {
    let mut sides = [false; 2];
    let mut budget = MOST_CELLS;
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let face = Face {
                terms,
                degree,
                axis,
                sign,
                half,
            };
            let whole = Aabb::new(DVec3::new(0.0, -1.0, -1.0), DVec3::ONE);
            match face.side(&whole, DEEPEST, &mut budget) {
                None => return false,
                Some(positive) => sides[usize::from(positive)] = true,
            }
        }
    }
    // On the whole outside it has one sign.
    sides != [true; 2]
}

/// What is outside of a cube in front of one of its faces, as a polynomial in w, u and v.
struct Face<'a> {
    terms: &'a [([u32; 3], f64)],
    degree: u32,
    axis: usize,
    sign: f64,
    half: f64,
}

impl Face<'_> {
    /// Whether the polynomial is positive in a cell of w, u and v; `None` if it is not known to have one sign.
    fn side(&self, cell: &Aabb, levels: u32, budget: &mut u32) -> Option<bool> {
        *budget = budget.checked_sub(1)?;
        let [w, u, v] = ranges(cell);
        let (mut sum, mut size) = ((0.0, 0.0), 0.0);
        for (powers, c) in self.terms {
            let [i, j, k] = [0, 1, 2].map(|n| powers[(self.axis + n) % 3]);
            let below = self.degree - (i + j + k);
            let sign = if i % 2 == 1 { self.sign } else { 1.0 };
            let c = c * sign / power(self.half, below);
            let term = times(power_of(w, below), times(power_of(u, j), power_of(v, k)));
            sum = plus(sum, times((c, c), term));
            size += c.abs();
        }
        let error = gamma(8 * self.degree + 2 * MOST_TERMS as u32) * size;
        if sum.0 > error {
            return Some(true);
        }
        if sum.1 < -error {
            return Some(false);
        }
        let levels = levels.checked_sub(1)?;
        let mut side = None;
        for part in cell.eighths() {
            let positive = self.side(&part, levels, budget)?;
            if *side.get_or_insert(positive) != positive {
                return None;
            }
        }
        side
    }
}

/// A sum that a polynomial is never below: of a constant and a polynomial in the magnitude of each coordinate.
///
/// A term of several coordinates is not negative if all its powers are even, or it is weighed by `|xⁱ yʲ zᵏ| <= (i |x|ⁿ + j |y|ⁿ + k |z|ⁿ) / n` with
/// `n = i + j + k` (the inequality of arithmetic and geometric means).
struct Separate {
    constant: f64,
    /// For each coordinate, by rising powers; those of power 0 are zero.
    axes: [[f64; HIGHEST_DEGREE as usize + 1]; 3],
}

impl Separate {
    /// Below the polynomial times `sign`.
    fn of(terms: &[([u32; 3], f64)], sign: f64) -> Self {
        let mut sum = Self {
            constant: 0.0,
            axes: [[0.0; HIGHEST_DEGREE as usize + 1]; 3],
        };
        for (powers, c) in terms {
            let c = c * sign;
            let degree: u32 = powers.iter().sum();
            if degree == 0 {
                sum.constant += c;
                continue;
            }
            let is_even = powers.iter().all(|power| power % 2 == 0);
            let is_pure = powers.contains(&degree);
            if is_even && c >= 0.0 && !is_pure {
                continue;
            }
            let least = if is_even && c >= 0.0 { c } else { -c.abs() };
            for (axis, power) in sum.axes.iter_mut().zip(powers) {
                axis[degree as usize] += least * f64::from(*power) / f64::from(degree);
            }
        }
        sum
    }

    /// The half-edge of a cube outside of which the sum is positive; `None` if there is none.
    fn half_edge(&self) -> Option<f64> {
        let mut least = [0.0; 3];
        for (least, axis) in least.iter_mut().zip(&self.axes) {
            // Beyond this place it is not negative, and before it not below the sum of its negative terms there.
            let place = last_zero(axis, 0.0)?;
            let negative = |(k, c): (usize, &f64)| power(place, k as u32) * c.min(0.0);
            *least = axis.iter().enumerate().map(negative).sum();
        }
        let all: f64 = least.iter().sum::<f64>() + self.constant;
        let mut half: f64 = 0.0;
        for (least, axis) in least.iter().zip(&self.axes) {
            half = half.max(last_zero(axis, all - least)?);
        }
        // Room for rounding; and no cube without a size.
        Some(if half > 0.0 { 2.0 * half } else { 1.0 }).filter(|half| half.is_finite())
    }
}

/// A place beyond which a polynomial in one variable, plus a constant, is not negative: there the leading term outweighs the negative ones, each of
/// them with an equal part of itself. `None` if the leading coefficient is not positive.
fn last_zero(coefficients: &[f64], constant: f64) -> Option<f64> {
    let (top, leading) = coefficients
        .iter()
        .enumerate()
        .rfind(|(_, c)| **c != 0.0)
        .filter(|(_, c)| **c > 0.0)?;
    let lower = || (coefficients.iter().enumerate().take(top)).filter(|(_, c)| **c < 0.0);
    let negative = lower().map(|(k, c)| (k, *c));
    let negative = negative.chain((constant < 0.0).then_some((0, constant)));
    let parts = lower().count() as f64 + 1.0;
    negative
        .map(|(k, c)| {
            let below = (top - k) as f64;
            strahl_math::det::pow(parts * -c / leading, 1.0 / below)
        })
        .reduce(f64::max)
        .or(Some(0.0))
}

/// The polynomial itself.
struct Inside<'a> {
    terms: &'a [([u32; 3], f64)],
    degree: u32,
    sums: &'a [f64],
}

impl Inside<'_> {
    /// Whether it may be zero somewhere in a cell, or so small that rays may find a zero there.
    fn may_vanish(&self, cell: &Aabb) -> bool {
        let [x, y, z] = ranges(cell);
        let mut sum = (0.0, 0.0);
        for ([i, j, k], c) in self.terms {
            let term = times(power_of(x, *i), times(power_of(y, *j), power_of(z, *k)));
            sum = plus(sum, times((*c, *c), term));
        }
        // The restriction to a ray is as exact as numbers of this size allow.
        let reach = 4.0 * cell.max_abs() + 2.0;
        let size = self.sums.iter().rev().fold(0.0, |m, sum| m * reach + sum);
        let error = gamma(16 * self.degree + 2 * MOST_TERMS as u32) * size;
        !(sum.0 > error || sum.1 < -error)
    }

    /// Adds the cells that may have a part of the surface to a box, down to cells of this many levels.
    fn collect(&self, cell: &Aabb, levels: u32, found: &mut Aabb) {
        if found.union(cell) == *found || !self.may_vanish(cell) {
            return;
        }
        match levels.checked_sub(1) {
            None => *found = found.union(cell),
            Some(levels) => {
                for part in cell.eighths() {
                    self.collect(&part, levels, found);
                }
            }
        }
    }
}

fn ranges(cell: &Aabb) -> [Range; 3] {
    [0, 1, 2].map(|axis| (cell.min[axis], cell.max[axis]))
}

fn plus(a: Range, b: Range) -> Range {
    (a.0 + b.0, a.1 + b.1)
}

fn times(a: Range, b: Range) -> Range {
    let least = |x: f64, y: f64| if x < y { x } else { y };
    let most = |x: f64, y: f64| if x > y { x } else { y };
    let (p, q, r, s) = (a.0 * b.0, a.0 * b.1, a.1 * b.0, a.1 * b.1);
    (
        least(least(p, q), least(r, s)),
        most(most(p, q), most(r, s)),
    )
}

fn power(x: f64, exponent: u32) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * x)
}

/// The powers of the numbers in a range.
fn power_of((low, high): Range, exponent: u32) -> Range {
    let (a, b) = (power(low, exponent), power(high, exponent));
    if exponent % 2 == 1 {
        return (a, b);
    }
    let (least, most) = if a < b { (a, b) } else { (b, a) };
    if exponent > 0 && low < 0.0 && high > 0.0 {
        (0.0, most)
    } else {
        (least, most)
    }
}
