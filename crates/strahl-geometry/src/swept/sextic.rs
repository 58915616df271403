//! The polynomial of degree 6 that is zero where a line meets an arc, for finding out how many roots there are and where.

use super::curve::Piece;
use super::round::product;
use strahl_math::error::ROUNDOFF;

/// Coefficients of a polynomial of degree 6 in Bernstein form. The last one stands there twice: eight numbers fill whole vectors.
type Eight = [f64; 8];

fn eight(c: [f64; 7]) -> Eight {
    let [a, b, c, d, e, f, g] = c;
    [a, b, c, d, e, f, g, g]
}

/// What a line's polynomial is put together from.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Terms {
    /// The height over the middle of the whole curve.
    height: Eight,
    /// Its square.
    height2: Eight,
    /// The square of the radius.
    radius2: Eight,
    /// The height and the radius, or its square, as powers of the parameter.
    y: [f64; 4],
    x: [f64; 4],
    squared: bool,
}

/// The same curve as powers of its parameter.
fn powers([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [
        a,
        3.0 * (b - a),
        3.0 * ((c - b) - (b - a)),
        (d - a) - 3.0 * (c - b),
    ]
}

/// Value and derivative by Horner's rule.
#[inline]
fn horner([a, b, c, d]: &[f64; 4], s: f64) -> [f64; 2] {
    [
        a + s * (b + s * (c + s * d)),
        b + s * (2.0 * c + s * (3.0 * d)),
    ]
}

impl Terms {
    /// Of a piece whose `x` is the radius or, if `squared`, the radius' square.
    pub(super) fn new(x: &Piece<f64>, squared: bool, y: &Piece<f64>, middle: f64) -> Self {
        let (x, y) = (x.cubic(), y.cubic().map(|y| y - middle));
        let one = [1.0; 4];
        Self {
            height: eight(product(&y, &one)),
            height2: eight(product(&y, &y)),
            radius2: eight(product(&x, if squared { &one } else { &x })),
            y: powers(y),
            x: powers(x),
            squared,
        }
    }

    /// Height over the middle and squared radius, with their derivatives, in fewer operations than by de Casteljau's algorithm.
    #[inline]
    pub(super) fn at(&self, s: f64) -> ([f64; 2], [f64; 2]) {
        let [x, dx] = horner(&self.x, s);
        let square = if self.squared {
            [x, dx]
        } else {
            [x * x, 2.0 * x * dx]
        };
        (horner(&self.y, s), square)
    }

    /// The largest heights and squared radii among the coefficients.
    pub(super) fn reach(&self) -> [f64; 2] {
        let largest = |all: &Eight| all.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
        [largest(&self.height), largest(&self.radius2)]
    }
}

/// `(slope height + level)² + steep² (m² - radius²)` for the points of an arc.
#[derive(Clone, Copy, Debug)]
pub(super) struct Factors {
    pub(super) height2: f64,
    pub(super) height: f64,
    pub(super) radius2: f64,
    pub(super) constant: f64,
    /// A bound of the error of each coefficient.
    pub(super) error: f64,
}

impl Factors {
    /// The value at a point of an arc, as [`Terms::at`] gives it.
    #[inline]
    pub(super) fn value(&self, ([height, _], [square, _]): ([f64; 2], [f64; 2])) -> f64 {
        self.height2 * height * height + self.height * height + self.constant
            - self.radius2 * square
    }
}

/// The polynomial of a line and an arc.
#[derive(Clone, Copy)]
pub(super) struct Sextic {
    c: Eight,
    error: f64,
}

/// What the signs of the coefficients say, see [`Sextic::signs`].
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Signs {
    /// Bit `k` is set if coefficient `k` is negative.
    negative: u32,
}

impl Signs {
    fn changes(self) -> u32 {
        (self.negative ^ (self.negative >> 1)) & 0x3f
    }
}

/// A part of an arc with exactly one root of the polynomial.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Single {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Whether the polynomial is negative at the lower end.
    pub(super) rising: bool,
    /// Where the control polygon crosses zero.
    pub(super) guess: f64,
}

/// The parts of an arc that hold one root each.
#[derive(Default)]
pub(super) struct Singles {
    list: [Single; 6],
    count: usize,
}

impl Singles {
    pub(super) fn iter(&self) -> impl Iterator<Item = &Single> {
        self.list.iter().take(self.count)
    }

    fn push(&mut self, single: Single) {
        if let Some(slot) = self.list.get_mut(self.count) {
            *slot = single;
            self.count += 1;
        }
    }
}

/// What is known about the roots on an arc.
pub(super) enum Roots {
    None,
    One(Single),
    /// More than one, which [`Sextic::split`] may tell apart.
    Several,
    /// Rounding errors may hide or feign a root.
    Unsure,
}

/// Arcs are halved so many times; roots that are closer together are left to another way to find them.
const DEPTH: u32 = 6;

impl Sextic {
    #[inline]
    pub(super) fn new(terms: &Terms, factors: &Factors) -> Self {
        let mut c = [0.0; 8];
        for (k, c) in c.iter_mut().enumerate() {
            *c = factors.height2 * terms.height2[k]
                + factors.height * terms.height[k]
                + (factors.constant - factors.radius2 * terms.radius2[k]);
        }
        Self {
            c,
            error: factors.error,
        }
    }

    /// The signs of the coefficients; `None` if one is within the error bound (or NaN).
    #[inline]
    fn signs(&self) -> Option<Signs> {
        let mut least = [0.0; 4];
        let mut negative = 0;
        for (k, least) in least.iter_mut().enumerate() {
            let (a, b) = (self.c[k].abs(), self.c[k + 4].abs());
            *least = if a < b { a } else { b };
        }
        for (k, c) in self.c.iter().enumerate() {
            negative |= u32::from(c.is_sign_negative()) << k;
        }
        let sure = least.iter().all(|c| *c > self.error);
        sure.then_some(Signs { negative })
    }

    /// Whether there are roots, by Descartes' rule: no more roots than changes of sign, and as many up to an even number.
    #[inline]
    pub(super) fn roots(&self) -> Roots {
        // Nearly all arcs lie on one side of the line.
        if self.is_beyond() {
            return Roots::None;
        }
        let Some(signs) = self.signs() else {
            return Roots::Unsure;
        };
        match signs.changes().count_ones() {
            0 => Roots::None,
            1 => Roots::One(self.single(signs, 0.0, 1.0)),
            _ => Roots::Several,
        }
    }

    /// Whether all coefficients have the same sign, beyond doubt.
    #[inline]
    fn is_beyond(&self) -> bool {
        let smaller = |a: f64, b: f64| if a < b { a } else { b };
        // Turned so that the first is positive, whose sign is that of all or of no use.
        let side = f64::copysign(1.0, self.c[0]);
        let mut least = [0.0; 4];
        for (k, least) in least.iter_mut().enumerate() {
            *least = smaller(side * self.c[k], side * self.c[k + 4]);
        }
        let [a, b, c, d] = least;
        smaller(smaller(a, c), smaller(b, d)) > self.error
    }

    /// The parts with one root each, which are all roots of an arc with several; `None` if they cannot be told apart.
    #[cold]
    pub(super) fn isolate(&self) -> Option<Singles> {
        let mut found = Singles::default();
        self.split(0.0, 1.0, DEPTH, &mut found)?;
        Some(found)
    }

    fn split(&self, low: f64, high: f64, depth: u32, found: &mut Singles) -> Option<()> {
        let middle = 0.5 * (low + high);
        let (left, right) = self.halves();
        for (part, low, high) in [(left, low, middle), (right, middle, high)] {
            let signs = part.signs()?;
            match signs.changes().count_ones() {
                0 => {}
                1 => found.push(part.single(signs, low, high)),
                _ if depth == 0 => return None,
                _ => part.split(low, high, depth - 1, found)?,
            }
        }
        Some(())
    }

    #[inline]
    fn single(&self, signs: Signs, low: f64, high: f64) -> Single {
        let k = signs.changes().trailing_zeros() as usize;
        let (a, b) = (self.c[k & 7], self.c[(k + 1) & 7]);
        let share = (k as f64 + a / (a - b)) * (1.0 / 6.0);
        Single {
            low,
            high,
            rising: signs.negative & 1 != 0,
            guess: low + (high - low) * share,
        }
    }

    /// De Casteljau's algorithm at the middle.
    fn halves(&self) -> (Self, Self) {
        let [mut left, mut right] = [self.c; 2];
        let largest = self
            .c
            .iter()
            .fold(0.0, |m: f64, c| if c.abs() > m { c.abs() } else { m });
        for (i, corner) in left.iter_mut().enumerate().take(7).skip(1) {
            for j in 0..7 - i {
                right[j] = 0.5 * (right[j] + right[j + 1]);
            }
            *corner = right[0];
        }
        left[7] = left[6];
        right[7] = right[6];
        // Each of the six means rounds once.
        let error = self.error + 6.0 * ROUNDOFF * largest;
        (Self { c: left, error }, Self { c: right, error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;

    /// Random arcs and lines: terms, factors, and the value that the polynomial has to have at a parameter.
    fn examples() -> impl Iterator<Item = (Terms, Factors)> {
        let mut random = Random::new(5);
        (0..3000).map(move |round| {
            let mut four = || std::array::from_fn(|_| random.between(0.0, 1.0));
            let (x, y) = (Piece::Cubic(four()), Piece::Cubic(four()));
            let terms = Terms::new(&x, round % 2 == 0, &y, 0.5);
            let [speed, base, dy, m2] = four();
            let base = base - 0.5;
            let factors = Factors {
                height2: speed * speed,
                height: 2.0 * speed * base,
                radius2: dy * dy,
                constant: base * base + dy * dy * 0.3 * m2,
                error: 1e-14,
            };
            (terms, factors)
        })
    }

    fn value(terms: &Terms, factors: &Factors, s: f64) -> f64 {
        factors.value(terms.at(s))
    }

    #[test]
    fn ends_and_middle_are_values() {
        for (terms, factors) in examples() {
            let polynomial = Sextic::new(&terms, &factors);
            let (left, right) = polynomial.halves();
            for (coefficient, s) in [
                (polynomial.c[0], 0.0),
                (polynomial.c[6], 1.0),
                (polynomial.c[7], 1.0),
                (left.c[7], 0.5),
                (right.c[0], 0.5),
            ] {
                assert!(
                    (coefficient - value(&terms, &factors, s)).abs() < 1e-14,
                    "{s}"
                );
            }
            let ([y, dy], [square, slope]) = terms.at(0.3);
            let ([y2, _], [square2, _]) = terms.at(0.3 + 1e-7);
            assert!(((y2 - y) * 1e7 - dy).abs() < 1e-5);
            assert!(((square2 - square) * 1e7 - slope).abs() < 1e-5);
        }
    }

    #[test]
    fn each_part_has_one_root_and_all_roots_are_in_parts() {
        let mut counts = [0; 5];
        for (terms, factors) in examples() {
            let polynomial = Sextic::new(&terms, &factors);
            let sign = |s: f64| value(&terms, &factors, s) >= 0.0;
            let parts: Vec<Single> = match polynomial.roots() {
                Roots::None => vec![],
                Roots::One(part) => vec![part],
                Roots::Several => match polynomial.isolate() {
                    Some(parts) => parts.iter().copied().collect(),
                    None => continue,
                },
                Roots::Unsure => continue,
            };
            const STEPS: u32 = 640;
            let at = |k: u32| f64::from(k) / f64::from(STEPS);
            let changes: Vec<f64> = (0..STEPS)
                .filter(|k| sign(at(*k)) != sign(at(k + 1)))
                .map(at)
                .collect();
            assert_eq!(changes.len(), parts.len(), "{parts:?}");
            for (part, place) in parts.iter().zip(&changes) {
                assert!(part.low <= *place && *place < part.high);
                assert!(part.low <= part.guess && part.guess <= part.high);
                assert_eq!(part.rising, !sign(part.low));
                assert_ne!(sign(part.low), sign(part.high));
            }
            counts[parts.len()] += 1;
        }
        assert!(counts[..3].iter().all(|count| *count > 50), "{counts:?}");
    }
}
