use std::ops::ControlFlow;
use strahl_math::error::gamma;
use strahl_math::roots::{Bernstein, FourBernsteins, RootCount, Window, find_root};

/// A polynomial `c[0] + c[1] s + ...` on the whole line `-∞ < s < ∞`, scaled so that its roots of interest are near `|s| <= 1`.
///
/// The line is divided into four pieces: `s < -1`, `-1..0`, `0..1` and `s > 1`, the outer ones in `u = 1/|s|` with the
/// coefficients in reverse. On each the change to Bernstein form loses no digits, and the result does not depend on where a
/// query begins or ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<const N: usize> {
    coefficients: [f64; N],
    /// The number of the last coefficient that is certainly not a rounding error; those above are taken as zero.
    degree: usize,
    /// Bound on the sum of the errors of the coefficients.
    error: f64,
}

/// The ends of the four pieces.
const ENDS: [f64; 5] = [f64::NEG_INFINITY, -1.0, 0.0, 1.0, f64::INFINITY];

/// A simple change of sign.
#[derive(Clone, Copy, Debug)]
pub(super) struct Root {
    /// Its parameter.
    pub(super) s: f64,
    /// From negative to positive.
    pub(super) rising: bool,
    /// An interval that contains it and no other.
    pub(super) stretch: (f64, f64),
}

/// One of the four pieces: a polynomial in `v`, `0..1`.
struct Piece<const N: usize> {
    coefficients: [f64; N],
    /// Whether `v` falls along the line.
    falling: bool,
    /// Whether `s = ±1/v`.
    inverse: bool,
    /// Whether the value is positive where the line enters the piece and where it leaves it.
    ends: (bool, bool),
}

impl<const N: usize> Line<N> {
    /// The polynomial of these coefficients; `error` bounds the sum of their errors, `leading_error(k)` that of the k-th alone.
    ///
    /// Leading coefficients that are rounding errors would cause roots near infinity, so they are dropped.
    pub(super) fn new(
        mut coefficients: [f64; N],
        error: f64,
        leading_error: impl Fn(usize) -> f64,
    ) -> Self {
        let mut degree = 0;
        for (k, c) in coefficients.iter_mut().enumerate().rev() {
            if *c == 0.0 || c.abs() <= leading_error(k) {
                *c = 0.0;
            } else {
                degree = k;
                break;
            }
        }
        Self {
            coefficients,
            degree,
            error,
        }
    }

    /// The same polynomial divided by its known root `s = 0`.
    ///
    /// In front of `s = 0` the quotient has the sign of the polynomial.
    pub(super) fn without_root_at_zero(self) -> Self {
        let mut coefficients = [0.0; N];
        for (to, from) in coefficients
            .iter_mut()
            .zip(self.coefficients.iter().skip(1))
        {
            *to = *from;
        }
        Self {
            coefficients,
            degree: self.degree.saturating_sub(1),
            error: self.error,
        }
    }

    /// Visits the changes of sign, ascending, that lie within the window or whose intervals overlap it.
    ///
    /// Afterwards `window.starts_negative` is the sign at the beginning of the first interval visited.
    pub(super) fn roots(
        &self,
        window: &mut Window,
        mut visit: impl FnMut(Root) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let power = self.pieces();
        let four = FourBernsteins::on_unit_interval(&power, self.error);
        let positive = [
            self.positive_at_infinity(true),
            self.positive_at_one(true),
            self.positive_at_zero(),
            self.positive_at_one(false),
            self.positive_at_infinity(false),
        ];
        for number in 0..4 {
            if ENDS[number + 1] <= window.from {
                continue;
            }
            if ENDS[number] > window.to && window.starts_negative.is_some() {
                return ControlFlow::Break(());
            }
            let ends = (positive[number], positive[number + 1]);
            if four.is_clear(number, ends) {
                window.starts_negative.get_or_insert(!ends.0);
                continue;
            }
            let piece = Piece {
                coefficients: power.map(|four| four[number]),
                falling: number % 2 == 1,
                inverse: number == 0 || number == 3,
                ends,
            };
            piece.roots(four.lane(number), window, &mut visit)?;
        }
        window
            .starts_negative
            .get_or_insert(!self.positive_at_infinity(false));
        ControlFlow::Continue(())
    }

    /// The error of a root, given a bound on the error of the value near `|s| <= 1`.
    pub(super) fn root_error(&self, s: f64) -> f64 {
        let (mut value, mut slope, mut bend) = (0.0, 0.0, 0.0);
        let (mut power, mut largest) = (1.0, 1.0);
        for c in self.coefficients.iter().rev() {
            bend = bend * s + slope;
            slope = slope * s + value;
            value = value * s + c;
        }
        if s.abs() > 1.0 {
            for _ in 0..self.degree {
                power *= s.abs();
            }
            largest = power;
        }
        let error = self.error * largest;
        let (straight, tangent) = (error / f64::abs(slope), (error / f64::abs(bend)).sqrt());
        let error = if straight < tangent || !tangent.is_finite() {
            straight
        } else {
            tangent
        };
        // If even the second derivative vanishes, half of the digits are assumed to be correct.
        let most = gamma(1).sqrt() * if s.abs() > 1.0 { s.abs() } else { 1.0 };
        if error < most { error } else { most }
    }

    /// The sign of the value at `-1` (`minus`) or `1`: true for positive.
    fn positive_at_one(&self, minus: bool) -> bool {
        let mut sum = 0.0;
        for (k, c) in self.coefficients.iter().enumerate() {
            sum += if minus && k % 2 == 1 { -c } else { *c };
        }
        sum >= 0.0
    }

    fn positive_at_infinity(&self, minus: bool) -> bool {
        let leading = self
            .coefficients
            .get(self.degree)
            .copied()
            .unwrap_or_default();
        (leading >= 0.0) != (minus && self.degree % 2 == 1)
    }

    fn positive_at_zero(&self) -> bool {
        self.coefficients.first().is_some_and(|c| *c >= 0.0)
    }

    /// The coefficients of the four pieces, in `v`: those of the polynomial in `-s` and in `s`, and for the outer pieces in reverse.
    fn pieces(&self) -> [[f64; 4]; N] {
        let mut pieces = [[0.0; 4]; N];
        for (k, (piece, c)) in pieces.iter_mut().zip(&self.coefficients).enumerate() {
            let turned = if k % 2 == 1 { -c } else { *c };
            (piece[1], piece[2]) = (turned, *c);
        }
        let mut reverse = |degree: usize| {
            for k in 0..=degree {
                let [_, turned, c, _] = pieces[degree - k];
                (pieces[k][0], pieces[k][3]) = (turned, c);
            }
        };
        // The loop over all of them is unrolled.
        if self.degree == N - 1 {
            reverse(N - 1);
        } else {
            reverse(self.degree);
        }
        pieces
    }
}

impl<const N: usize> Piece<N> {
    fn roots(
        &self,
        ascending: Bernstein<N>,
        window: &mut Window,
        visit: &mut impl FnMut(Root) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let along = if self.falling {
            ascending.mirrored()
        } else {
            ascending
        };
        let mut local = Window {
            from: self.place(window.from, false),
            to: self.place(window.to, true),
            starts_negative: window.starts_negative,
        };
        let flow = along.isolate_within(self.ends, &mut local, &mut |part| {
            if part.count == RootCount::Even {
                return ControlFlow::Continue(());
            }
            let (low, high, estimate) = if self.falling {
                (1.0 - part.high(), 1.0 - part.low(), 1.0 - part.estimate())
            } else {
                (part.low(), part.high(), part.estimate())
            };
            let rising = part.rising != self.falling;
            let v = find_root(low, high, rising, estimate, |v| self.value_and_slope(v));
            let (a, b) = (self.at(low), self.at(high));
            visit(Root {
                s: self.at(v),
                rising: part.rising,
                stretch: if !self.falling { (a, b) } else { (b, a) },
            })
        });
        window.starts_negative = local.starts_negative;
        flow
    }

    /// The place on the line.
    fn at(&self, v: f64) -> f64 {
        match (self.falling, self.inverse) {
            (false, false) => v,
            (true, false) => -v,
            (false, true) => -1.0 / v,
            (true, true) => 1.0 / v,
        }
    }

    /// Where on the piece, counted `0..1` along the line, a place of the line is, rounded outwards (`up` or down).
    fn place(&self, s: f64, up: bool) -> f64 {
        let along = match (self.falling, self.inverse) {
            (false, false) => s,
            (true, false) => 1.0 + s,
            (false, true) if s < -1.0 => -1.0 / s,
            (true, true) if s > 1.0 => 1.0 - 1.0 / s,
            // Before the piece or behind it: these pieces reach to infinity.
            (false, true) => 1.0,
            (true, true) => 0.0,
        };
        let slack = 4.0 * f64::EPSILON;
        if up { along + slack } else { along - slack }
    }

    fn value_and_slope(&self, v: f64) -> (f64, f64) {
        let (mut value, mut slope) = (0.0, 0.0);
        for c in self.coefficients.iter().rev() {
            slope = slope * v + value;
            value = value * v + c;
        }
        (value, slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The polynomial with these roots, `N - 1` of them.
    fn line<const N: usize>(roots: [f64; N], count: usize) -> Line<N> {
        let mut c = [0.0; N];
        c[0] = 1.0;
        for (degree, root) in roots.iter().take(count).enumerate() {
            for k in (0..=degree + 1).rev() {
                let below = if k > 0 { c[k - 1] } else { 0.0 };
                c[k] = below - root * c[k];
            }
        }
        let sum: f64 = c.iter().map(|c| c.abs()).sum();
        Line::new(c, gamma(8) * sum, |_| gamma(8) * sum * 1e-3)
    }

    fn found<const N: usize>(
        line: &Line<N>,
        from: f64,
        to: f64,
    ) -> (Option<bool>, Vec<(f64, bool)>) {
        let mut window = Window {
            from,
            to,
            starts_negative: None,
        };
        let mut list = vec![];
        let _ = line.roots(&mut window, |root| {
            list.push((root.s, root.rising));
            ControlFlow::Continue(())
        });
        (window.starts_negative, list)
    }

    #[test]
    fn roots_are_found_on_the_whole_line() {
        let roots = [-40.0, -0.5, 0.25, 3.0];
        let line = line::<5>([-40.0, -0.5, 0.25, 3.0, 0.0], 4);
        let (starts_negative, list) = found(&line, f64::NEG_INFINITY, f64::INFINITY);
        assert_eq!(starts_negative, Some(false));
        assert_eq!(list.len(), 4);
        for (i, ((s, rising), expected)) in list.iter().zip(roots).enumerate() {
            assert!(
                (s - expected).abs() < 1e-13 * expected.abs(),
                "{s} {expected}"
            );
            assert_eq!(*rising, i % 2 == 1);
        }
    }

    #[test]
    fn a_window_changes_no_bits() {
        let line = line::<5>([-40.0, -0.5, 0.25, 3.0, 0.0], 4);
        let (_, all) = found(&line, f64::NEG_INFINITY, f64::INFINITY);
        for (from, to) in [(-1e9, 0.0), (-0.6, 0.2), (0.0, 2.0), (2.0, 1e3), (2.9, 3.1)] {
            let (starts_negative, some) = found(&line, from, to);
            assert!(some.iter().all(|root| all.contains(root)), "{some:?}");
            let mut before = starts_negative;
            for (s, rising) in &some {
                assert_eq!(before, Some(*rising), "{from} {to}: {some:?}");
                before = Some(!rising);
                assert!(*s > -41.0);
            }
            let expected = all.iter().filter(|(s, _)| from < *s && *s <= to).count();
            let within = some.iter().filter(|(s, _)| from < *s && *s <= to).count();
            assert_eq!(within, expected, "{from} {to}");
        }
        assert_eq!(found(&line, f64::INFINITY, f64::INFINITY).0, Some(false));
    }

    #[test]
    fn a_known_root_is_divided_out() {
        let line = line::<4>([0.0, 0.5, 2.0, 0.0], 3).without_root_at_zero();
        let (starts_negative, list) = found(&line, 0.0, f64::INFINITY);
        assert_eq!(starts_negative, Some(false));
        assert_eq!(list, [(0.5, false), (2.0, true)]);
    }

    #[test]
    fn constants_have_no_roots() {
        let line = Line::new([-2.0, 0.0, 1e-30], 1e-20, |_| 1e-20);
        assert_eq!(found(&line, -1.0, 1.0), (Some(true), vec![]));
        assert_eq!(found(&line, f64::NEG_INFINITY, f64::INFINITY).1, []);
    }
}
