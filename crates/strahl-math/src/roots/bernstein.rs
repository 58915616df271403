use super::find_root;
use crate::error::{ROUNDOFF, gamma};
use std::ops::{ControlFlow, Deref};

/// A polynomial of degree `N - 1` in Bernstein form on an interval, with a bound on the error of its coefficients.
///
/// In this form the number of sign changes among the coefficients bounds the number of roots in the interval from above, and is
/// even or odd with it (Descartes' rule; Lane and Riesenfeld, "Bounds on a polynomial", BIT 21, 1981). No sign
/// change means no root, which rejects most polynomials after a handful of comparisons; one means one root; otherwise
/// the interval is halved. Coefficients within the error bound count as both signs at once: a claim is made
/// only if it holds for every polynomial within the bound.
///
/// Meant for degrees up to about 12; the change to Bernstein form loses about one digit for every two degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bernstein<const N: usize> {
    coefficients: [f64; N],
    error: f64,
    low: f64,
    high: f64,
}

/// A part of the interval in which a polynomial is or may be zero, found by [`Bernstein::isolate`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Isolated<const N: usize> {
    /// The polynomial on that part.
    piece: Bernstein<N>,
    /// Whether the polynomial is negative at the lower end and positive at the upper; otherwise it is the other way round.
    pub rising: bool,
    /// How many roots there are.
    pub count: RootCount,
}

/// What is known about the number of roots in an [`Isolated`] part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RootCount {
    /// Certainly exactly one.
    One,
    /// An odd number, so close together that rounding can't tell them apart: the polynomial changes its sign.
    Odd,
    /// An even number, perhaps none, so close together that rounding can't tell them apart: the polynomial comes as
    /// near to zero as its error bound and keeps its sign.
    Even,
}

impl<const N: usize> Isolated<N> {
    /// The lower end.
    pub fn low(&self) -> f64 {
        self.piece.low
    }

    /// The upper end.
    pub fn high(&self) -> f64 {
        self.piece.high
    }

    /// A guess of the root: where the control polygon crosses zero, which is close if the interval is short.
    pub fn estimate(&self) -> f64 {
        let Bernstein {
            coefficients,
            low,
            high,
            ..
        } = &self.piece;
        let mut steps = coefficients.windows(2).enumerate();
        let crossing = steps.find_map(|(i, pair)| match *pair {
            [a, b] if (a < 0.0) != (b < 0.0) => Some(i as f64 + a / (a - b)),
            _ => None,
        });
        let s = crossing.unwrap_or(0.0) / N.saturating_sub(1) as f64;
        low + (high - low) * s
    }

    /// The root, as exactly as the coefficients allow; of an even number of roots, a point near them.
    pub fn root(&self) -> f64 {
        let Bernstein { low, high, .. } = self.piece;
        let width = high - low;
        let start = (self.estimate() - low) / width;
        let s = find_root(0.0, 1.0, self.rising, start, |s| {
            self.piece.value_and_slope(s)
        });
        let t = low + width * s;
        // Rounding must not lead out of the interval: neighbouring roots stay in order.
        if t > high { high } else { t }
    }
}

/// The deepest subdivision: after that an interval is narrower than the spacing of f64.
const MAX_DEPTH: u32 = 56;

impl<const N: usize> Bernstein<N> {
    /// The polynomial with these Bernstein coefficients on `low <= t <= high`, each of them off by `error` at most.
    ///
    /// The control points of a Bézier curve, put into a linear function, are such coefficients.
    pub fn new(coefficients: [f64; N], error: f64, low: f64, high: f64) -> Self {
        let finite = coefficients.iter().all(|c| c.is_finite());
        Self {
            coefficients,
            error: if finite {
                error + f64::MIN_POSITIVE
            } else {
                f64::INFINITY
            },
            low,
            high,
        }
    }

    /// The polynomial `power[0] + power[1] t + power[2] t² + ...` on `low <= t <= high`.
    ///
    /// The error bound covers the rounding here, with the given coefficients taken as exact or rounded once; add what is
    /// not exact about them by [`Bernstein::with_error`].
    pub fn from_power(power: &[f64; N], low: f64, high: f64) -> Self {
        let width = high - low;
        // Taylor's expansion about `low`, by repeated synthetic division ...
        let mut b = *power;
        if low != 0.0 {
            for i in 0..N {
                for j in (i..N.saturating_sub(1)).rev() {
                    b[j] += low * b[j + 1];
                }
            }
        }
        // ... scaled to the unit interval and divided by the binomial coefficients ...
        let degree = N.saturating_sub(1);
        let (mut scale, mut binomial) = (1.0, 1.0);
        for (k, c) in b.iter_mut().enumerate() {
            *c *= scale / binomial;
            scale *= width;
            binomial = binomial * (degree - k) as f64 / (k + 1) as f64;
        }
        // ... and summed up: b_j = sum over k <= j of C(j,k) / C(n,k) a_k.
        for i in 1..N {
            for j in (i..N).rev() {
                b[j] += b[j - 1];
            }
        }
        // Every intermediate value is bounded by the polynomial of the magnitudes.
        let reach = low.abs() + width.abs();
        let magnitude = power.iter().rev().fold(0.0, |sum, c| sum * reach + c.abs());
        // The smallest normal number stands for what underflows; of what overflows nothing is known.
        let finite = b.iter().all(|c| c.is_finite());
        let error = if finite {
            gamma(6 * N as u32) * magnitude + f64::MIN_POSITIVE
        } else {
            f64::INFINITY
        };
        Self {
            coefficients: b,
            error,
            low,
            high,
        }
    }

    /// The polynomial `power[0] + power[1] s + power[2] s² + ...` on `0 <= s <= 1`, faster than by [`Bernstein::from_power`].
    ///
    /// `error` bounds the sum of the errors of the given coefficients; the rounding here is added to it.
    pub fn on_unit_interval(power: &[f64; N], error: f64) -> Self {
        let degree = N.saturating_sub(1);
        let (mut b, mut binomial, mut magnitude) = (*power, 1.0, 0.0);
        for (k, c) in b.iter_mut().enumerate() {
            magnitude += c.abs();
            *c /= binomial;
            binomial = binomial * (degree - k) as f64 / (k + 1) as f64;
        }
        for i in 1..N {
            for j in (i..N).rev() {
                b[j] += b[j - 1];
            }
        }
        Self {
            coefficients: b,
            error: unit_interval_error::<N>(magnitude, error),
            low: 0.0,
            high: 1.0,
        }
    }

    /// The polynomial seen from the other end: its value at `low + high - t`.
    #[must_use]
    pub fn mirrored(mut self) -> Self {
        self.coefficients.reverse();
        self
    }

    /// The same with an error bound larger by `error`.
    #[must_use]
    pub fn with_error(self, error: f64) -> Self {
        Self {
            error: self.error + error,
            ..self
        }
    }

    /// The coefficients: the first and the last are the values at the ends of the interval.
    pub fn coefficients(&self) -> &[f64; N] {
        &self.coefficients
    }

    /// The bound on the error of each coefficient.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// All roots in the interval, ascending. Roots where the polynomial does not change its sign (it only touches zero) are not
    /// listed.
    pub fn roots(&self) -> Roots<N> {
        let mut roots = Roots {
            t: [0.0; N],
            count: 0,
        };
        let _ = self.isolate(&mut |isolated| {
            if isolated.count == RootCount::Even {
                return ControlFlow::Continue(());
            }
            let Some(slot) = roots.t.get_mut(roots.count) else {
                return ControlFlow::Break(());
            };
            *slot = isolated.root();
            roots.count += 1;
            ControlFlow::Continue(())
        });
        roots
    }

    /// Finds the parts of the interval in which the polynomial is or may be zero, in ascending order; `visit` may end the
    /// search.
    ///
    /// # Errors
    /// `Break` if the visitor said so.
    pub fn isolate(
        &self,
        visit: &mut impl FnMut(&Isolated<N>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let (Some(first), Some(last)) = (self.coefficients.first(), self.coefficients.last())
        else {
            return ControlFlow::Continue(());
        };
        let mut search = Search {
            from: f64::NEG_INFINITY,
            to: f64::INFINITY,
            starts_negative: None,
            visit,
        };
        search.run(self, *first >= 0.0, *last >= 0.0, 0)
    }

    /// Like [`Bernstein::isolate`], but passes over what lies before `window.from` or behind `window.to`, and takes the signs at the two
    /// ends of the interval from the caller (`true` for positive), so that pieces of a larger function agree where they meet.
    ///
    /// What is visited does not depend on the window in any bit; parts that reach into it are visited as a whole. If
    /// `window.starts_negative` is `None`, it becomes the sign of the polynomial at the lower end of the first part that was not
    /// passed over, whether there is a root in it or not.
    ///
    /// # Errors
    /// `Break` if the visitor said so, or the end of the window has been passed.
    pub fn isolate_within(
        &self,
        (first, last): (bool, bool),
        window: &mut Window,
        visit: &mut impl FnMut(&Isolated<N>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut search = Search {
            from: window.from,
            to: window.to,
            starts_negative: window.starts_negative,
            visit,
        };
        let flow = search.run(self, first, last, 0);
        window.starts_negative = search.starts_negative;
        flow
    }

    /// The smallest and the largest number of sign changes that the coefficients may have, given their errors.
    fn variations(&self, first: bool, last: bool) -> (u32, u32) {
        let inner = self
            .coefficients
            .get(1..N.saturating_sub(1))
            .unwrap_or_default();
        let (mut fewest, mut most, mut sign, mut unsure) = (0, 0, first, 0);
        // A run of `unsure` coefficients between two signs can alternate as often as its length and the parity allow.
        let mut close = |next: bool, unsure: u32| {
            let changes = u32::from(next != sign);
            fewest += changes;
            most += if unsure.is_multiple_of(2) {
                unsure + changes
            } else {
                unsure + 1 - changes
            };
            sign = next;
        };
        for c in inner {
            if c.abs() > self.error {
                close(*c > 0.0, unsure);
                unsure = 0;
            } else {
                unsure += 1;
            }
        }
        close(last, unsure);
        (fewest, most)
    }

    /// De Casteljau's algorithm at the middle of the interval.
    fn halves(&self, middle: f64) -> (Self, Self) {
        let mut right = self.coefficients;
        let mut left = right;
        let mut largest = 0.0;
        for c in right {
            if c.abs() > largest {
                largest = c.abs();
            }
        }
        for (i, corner) in left.iter_mut().enumerate().skip(1) {
            for j in 0..N - i {
                right[j] = 0.5 * (right[j] + right[j + 1]);
            }
            *corner = right[0];
        }
        // Each of the N - 1 means rounds once.
        let error = self.error + N as f64 * ROUNDOFF * largest;
        (
            Self {
                coefficients: left,
                error,
                high: middle,
                ..*self
            },
            Self {
                coefficients: right,
                error,
                low: middle,
                ..*self
            },
        )
    }

    /// Value and derivative with respect to `s`, where `s` runs from 0 to 1 over the interval.
    fn value_and_slope(&self, s: f64) -> (f64, f64) {
        let mut b = self.coefficients;
        let r = 1.0 - s;
        let mut slope = 0.0;
        for i in 1..N {
            if i == N - 1 {
                slope = (b[1] - b[0]) * i as f64;
            }
            for j in 0..N - i {
                b[j] = r * b[j] + s * b[j + 1];
            }
        }
        (b.first().copied().unwrap_or(0.0), slope)
    }
}

/// Four polynomials side by side, each in Bernstein form on `0 <= s <= 1`: whether they have roots is found out in less time than
/// one by one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FourBernsteins<const N: usize> {
    coefficients: [[f64; 4]; N],
    error: [f64; 4],
    /// The least and the greatest of the coefficients but the first and the last.
    least: [f64; 4],
    greatest: [f64; 4],
}

impl<const N: usize> FourBernsteins<N> {
    /// As [`Bernstein::on_unit_interval`] makes them of four polynomials with the same bound on their errors, in the same bits.
    #[inline]
    pub fn on_unit_interval(power: &[[f64; 4]; N], error: f64) -> Self {
        let degree = N.saturating_sub(1);
        let (mut b, mut binomial, mut magnitude) = (*power, 1.0, [0.0; 4]);
        for (k, four) in b.iter_mut().enumerate() {
            for lane in 0..4 {
                magnitude[lane] += four[lane].abs();
                four[lane] /= binomial;
            }
            binomial = binomial * (degree - k) as f64 / (k + 1) as f64;
        }
        for i in 1..N {
            for j in (i..N).rev() {
                let before = b[j - 1];
                for (c, before) in b[j].iter_mut().zip(before) {
                    *c += before;
                }
            }
        }
        let (mut least, mut greatest) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
        for four in b.get(1..degree).unwrap_or_default() {
            for lane in 0..4 {
                let c = four[lane];
                least[lane] = if c < least[lane] { c } else { least[lane] };
                greatest[lane] = if c > greatest[lane] {
                    c
                } else {
                    greatest[lane]
                };
            }
        }
        Self {
            coefficients: b,
            error: magnitude.map(|magnitude| unit_interval_error::<N>(magnitude, error)),
            least,
            greatest,
        }
    }

    /// Whether one of them certainly has no root, if it counts as positive at the two ends or not: nothing would be visited by
    /// [`Bernstein::isolate_within`].
    #[inline]
    pub fn is_clear(&self, lane: usize, ends: (bool, bool)) -> bool {
        match ends {
            (true, true) => self.least[lane] > self.error[lane],
            (false, false) => self.greatest[lane] < -self.error[lane],
            _ => false,
        }
    }

    /// One of them.
    pub fn lane(&self, lane: usize) -> Bernstein<N> {
        Bernstein {
            coefficients: self.coefficients.map(|four| four[lane]),
            error: self.error[lane],
            low: 0.0,
            high: 1.0,
        }
    }
}

/// The bound on the errors of coefficients that [`Bernstein::on_unit_interval`] has made of coefficients with this sum of magnitudes and
/// this bound. Of what overflows nothing is known.
#[inline]
fn unit_interval_error<const N: usize>(magnitude: f64, error: f64) -> f64 {
    if magnitude.is_finite() {
        error + gamma(4 * N as u32) * magnitude + f64::MIN_POSITIVE
    } else {
        f64::INFINITY
    }
}

/// The part of an interval that roots are looked for in, see [`Bernstein::isolate_within`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// The lower end.
    pub from: f64,
    /// The upper end.
    pub to: f64,
    /// Whether the polynomial is negative where the search began.
    pub starts_negative: Option<bool>,
}

/// A search for roots on its way.
struct Search<'a, V> {
    from: f64,
    to: f64,
    starts_negative: Option<bool>,
    visit: &'a mut V,
}

impl<V> Search<'_, V> {
    /// `first` and `last` are the signs that the two ends count as (true for positive), whatever their error: neighbouring
    /// intervals agree about the point between them, so changes of sign are neither lost nor made up there.
    fn run<const N: usize>(
        &mut self,
        piece: &Bernstein<N>,
        first: bool,
        last: bool,
        depth: u32,
    ) -> ControlFlow<()>
    where
        V: FnMut(&Isolated<N>) -> ControlFlow<()>,
    {
        if piece.high <= self.from {
            return ControlFlow::Continue(());
        }
        if piece.low > self.to && self.starts_negative.is_some() {
            return ControlFlow::Break(());
        }
        let (fewest, most) = piece.variations(first, last);
        let isolated = |count| Isolated {
            piece: *piece,
            rising: last,
            count,
        };
        // Nothing is to be found where nothing is known.
        if most == 0 || !piece.error.is_finite() {
            self.starts_negative.get_or_insert(!first);
            return ControlFlow::Continue(());
        }
        if fewest == 1 && most == 1 {
            self.starts_negative.get_or_insert(!first);
            return (self.visit)(&isolated(RootCount::One));
        }
        let middle = 0.5 * (piece.low + piece.high);
        let undecidable = piece.coefficients.iter().all(|c| c.abs() <= piece.error);
        let splits = depth < MAX_DEPTH && piece.low < middle && middle < piece.high;
        if undecidable || !splits {
            self.starts_negative.get_or_insert(!first);
            let count = if first == last {
                RootCount::Even
            } else {
                RootCount::Odd
            };
            return (self.visit)(&isolated(count));
        }
        let (left, right) = piece.halves(middle);
        let between = right
            .coefficients
            .first()
            .is_some_and(|value| *value >= 0.0);
        self.run(&left, first, between, depth + 1)?;
        self.run(&right, between, last, depth + 1)
    }
}

/// Up to `N` roots, ascending; dereferences to a slice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roots<const N: usize> {
    t: [f64; N],
    count: usize,
}

impl<const N: usize> Deref for Roots<N> {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        self.t.get(..self.count).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The coefficients of the product of `(t - root)`; exact for few dyadic roots.
    fn expand<const N: usize>(roots: &[f64]) -> [f64; N] {
        let mut power = [0.0; N];
        power[0] = 1.0;
        for (degree, root) in roots.iter().enumerate() {
            for k in (0..=degree + 1).rev() {
                let below = if k > 0 { power[k - 1] } else { 0.0 };
                power[k] = below - root * power[k];
            }
        }
        power
    }

    fn solve<const N: usize>(roots: &[f64], low: f64, high: f64) -> Vec<f64> {
        Bernstein::from_power(&expand::<N>(roots), low, high)
            .roots()
            .to_vec()
    }

    #[test]
    fn simple_polynomials() {
        assert_eq!(solve::<2>(&[0.25], 0.0, 1.0), [0.25]);
        let four = [-2.0, -1.0, 0.75, 3.0];
        for (low, high, expected) in [(-4.0, 4.0, &four[..]), (0.0, 2.0, &four[2..3])] {
            let found = solve::<5>(&four, low, high);
            assert_eq!(found.len(), expected.len());
            assert!(
                found
                    .iter()
                    .zip(expected)
                    .all(|(a, b)| (a - b).abs() < 1e-13),
                "{found:?}"
            );
        }
        assert_eq!(
            solve::<3>(&[0.5, 0.5], 0.0, 1.0),
            [],
            "a double root only touches"
        );
        assert_eq!(
            solve::<4>(&[0.5, 0.5, 0.5], 0.0, 1.0).len(),
            1,
            "a triple root crosses"
        );
    }

    #[test]
    fn polynomials_that_are_none() {
        let solve = |power: [f64; 4]| Bernstein::from_power(&power, 0.0, 1.0).roots().to_vec();
        assert_eq!(solve([0.0; 4]), []);
        assert_eq!(solve([1.0, 0.0, 0.0, 0.0]), []);
        assert_eq!(solve([f64::NAN; 4]), []);
        assert_eq!(solve([1.0, f64::INFINITY, -3.0, 0.0]), []);
        assert_eq!(Bernstein::from_power(&[], 0.0, 1.0).roots().len(), 0);
        assert_eq!(Bernstein::from_power(&[-1.0], 0.0, 1.0).roots().len(), 0);
    }

    #[test]
    fn the_search_can_be_ended() {
        let polynomial = Bernstein::from_power(&expand::<4>(&[0.1, 0.5, 0.8]), 0.0, 1.0);
        let mut found = Vec::new();
        let end = polynomial.isolate(&mut |isolated| {
            assert!(isolated.count == RootCount::One && isolated.low() < isolated.high());
            found.push((isolated.root(), isolated.rising));
            ControlFlow::Break(())
        });
        assert!(
            end.is_break() && found.len() == 1 && (found[0].0 - 0.1).abs() < 1e-15 && found[0].1
        );
    }

    #[test]
    fn near_double_roots_come_in_pairs_or_not_at_all() {
        for exponent in 1..=60 {
            // Exact in f64 for small exponents: 1/4 and 1/4 + 2^-e.
            let gap = 2f64.powi(-exponent);
            let roots = solve::<5>(&[0.25, 0.25 + gap, -1.0, 2.0], 0.0, 1.0);
            if exponent <= 20 {
                assert_eq!(roots.len(), 2, "gap 2^-{exponent}");
                let limit = 1e-15 / gap;
                assert!(
                    (roots[0] - 0.25).abs() < limit && (roots[1] - 0.25 - gap).abs() < limit,
                    "{roots:?}"
                );
            }
            assert!(
                roots.len().is_multiple_of(2),
                "gap 2^-{exponent}: {roots:?}"
            );
            assert!(
                roots.iter().all(|t| (t - 0.25).abs() < 1e-6 + 2.0 * gap),
                "gap 2^-{exponent}: {roots:?}"
            );
        }
    }

    /// Distinct multiples of 1/64 in -1..1, whose products with a degree of up to 7 are exact in f64.
    fn dyadic_roots() -> impl Strategy<Value = Vec<f64>> {
        prop::collection::btree_set(-63i32..=63, 1..=7)
            .prop_map(|set| set.into_iter().map(|k| f64::from(k) / 64.0).collect())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn known_roots_are_found(roots in dyadic_roots(), low in -1.0f64..-0.99, width in 0.5f64..2.0) {
            let high = low + width;
            let polynomial = Bernstein::from_power(&expand::<8>(&roots), low, high);
            let found = polynomial.roots();
            let expected: Vec<f64> = roots.iter().copied().filter(|t| low < *t && *t < high).collect();
            prop_assert_eq!(found.len(), expected.len(), "{:?}", found);
            for (found, expected) in found.iter().zip(&expected) {
                // The error of the value at a root, divided by the slope there.
                let slope: f64 = roots.iter().filter(|t| *t != expected).map(|t| (expected - t).abs()).product();
                let allowed = 2.0 * polynomial.error() / slope;
                prop_assert!((found - expected).abs() <= allowed, "{} {} {}", found, expected, allowed);
            }
        }

        #[test]
        fn signs_alternate_at_every_root(power in prop::array::uniform7(-1.0f64..1.0), low in -3.0f64..0.0, width in 0.1f64..5.0) {
            let polynomial = Bernstein::from_power(&power, low, low + width);
            let value = |t: f64| power.iter().rev().fold(0.0, |sum, c| sum * t + c);
            let roots = polynomial.roots();
            prop_assert!(roots.windows(2).all(|pair| pair[0] <= pair[1]));
            // Between neighbouring roots the sign is constant and opposite to that of the next interval.
            let mut ends = vec![low];
            ends.extend_from_slice(&roots);
            ends.push(low + width);
            let (mut sign, error) = (polynomial.coefficients()[0] >= 0.0, 100.0 * polynomial.error());
            for pair in ends.windows(2) {
                for i in 1..32 {
                    let v = value(pair[0] + (pair[1] - pair[0]) * f64::from(i) / 32.0);
                    prop_assert!(v.abs() <= error || (v > 0.0) == sign, "{} between {:?}", v, pair);
                }
                sign = !sign;
            }
        }

        #[test]
        fn four_side_by_side_are_the_same_as_one_by_one(rows in prop::array::uniform5(prop::array::uniform4(-1.0f64..1.0)), lift in -4.0f64..4.0, error in 0.0f64..0.1) {
            let mut rows = rows;
            rows[0] = rows[0].map(|c| c + lift);
            let four = FourBernsteins::on_unit_interval(&rows, error);
            for lane in 0..4 {
                let one = Bernstein::on_unit_interval(&rows.map(|row| row[lane]), error);
                prop_assert_eq!(four.lane(lane), one);
                for ends in [(false, false), (false, true), (true, false), (true, true)] {
                    let mut window = Window { from: 0.0, to: 1.0, starts_negative: None };
                    let mut visits = 0;
                    let _ = one.isolate_within(ends, &mut window, &mut |_| {
                        visits += 1;
                        ControlFlow::Continue(())
                    });
                    let clear = four.is_clear(lane, ends);
                    prop_assert!(!clear || visits == 0 && window.starts_negative == Some(!ends.0));
                }
            }
        }

        #[test]
        fn wild_coefficients_do_no_harm(power in prop::array::uniform6(prop::num::f64::ANY), low in prop::num::f64::ANY, high in prop::num::f64::ANY) {
            let roots = Bernstein::from_power(&power, low, high).roots();
            prop_assert!(roots.len() <= 6);
        }
    }
}
