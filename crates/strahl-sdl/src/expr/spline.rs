//! `spline { ... }`: curves through points, as in POV-Ray 3.7 (the formulas were found by experiment, see the tests).

use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::Kind;
use crate::value::{Value, Vector};
use std::sync::Arc;

/// The kind of curve between the points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SplineKind {
    /// Straight.
    Linear,
    /// A parabola through the ends of the interval and the point before it.
    Quadratic,
    /// Cubics with the mean of the neighbouring slopes as tangents; the first and the last point only affect the tangents.
    Cubic,
    /// Cubics with continuous curvature, which is zero at the ends.
    Natural,
}

/// A curve through points, each at its parameter.
#[derive(Clone, Debug)]
pub struct Spline {
    kind: SplineKind,
    /// Points by ascending parameter.
    knots: Vec<(f64, Vector)>,
    /// The second derivatives of the natural spline at each knot.
    curvature: Vec<[f64; 5]>,
}

impl Spline {
    /// A spline through points. Of several at one parameter the last one counts, but a point at the largest parameter of at least two so far
    /// is left out, as in POV-Ray (measured).
    pub fn new(kind: SplineKind, points: impl IntoIterator<Item = (f64, Vector)>) -> Self {
        let mut knots: Vec<(f64, Vector)> = vec![];
        for (t, point) in points {
            let at = knots.partition_point(|(k, _)| *k < t);
            let is_last = knots.len() > 1 && at + 1 == knots.len();
            match knots.get_mut(at) {
                Some(knot) if knot.0 == t && is_last => {}
                Some(knot) if knot.0 == t => knot.1 = point,
                _ => knots.insert(at, (t, point)),
            }
        }
        let len = knots.iter().map(|(_, p)| p.len()).max().unwrap_or(2).max(2);
        for (_, point) in &mut knots {
            *point = point.promoted(len);
        }
        let curvature = match kind {
            SplineKind::Natural => curvature(&knots),
            _ => vec![],
        };
        Self {
            kind,
            knots,
            curvature,
        }
    }

    /// The point at a parameter; beyond the ends it is the end point.
    pub fn at(&self, t: f64) -> Vector {
        let knots = &self.knots;
        let n = knots.len();
        // The first and last point of a cubic spline are not on the curve.
        let (first, last) = match self.kind {
            SplineKind::Cubic if n > 2 => (1, n - 2),
            _ => (0, n.saturating_sub(1)),
        };
        let (Some(begin), Some(end)) = (knots.get(first), knots.get(last)) else {
            return Vector::new(&[0.0, 0.0]);
        };
        if let (SplineKind::Cubic, [(_, a), (_, b)]) = (self.kind, &knots[..]) {
            return a.zip(*b, |a, b| 0.5 * (a + b));
        }
        if !(t > begin.0) {
            return begin.1;
        }
        if t >= end.0 {
            return end.1;
        }
        // `begin < t < end`, so the interval has both ends.
        let right = knots.partition_point(|(k, _)| *k <= t);
        let left = right - 1;
        let ((t0, p0), (t1, p1)) = (knots[left], knots[right]);
        let (width, u) = (t1 - t0, (t - t0) / (t1 - t0));
        match self.kind {
            SplineKind::Linear => p0.zip(p1, |a, b| a + (b - a) * u),
            SplineKind::Quadratic if n < 3 => p0.zip(p1, |a, b| a + (b - a) * u),
            SplineKind::Quadratic => {
                let begin = left.saturating_sub(1);
                parabola([knots[begin], knots[begin + 1], knots[begin + 2]], t)
            }
            SplineKind::Cubic => {
                let slope = |i: usize| {
                    let ((a, p), (b, q)) = (knots[i], knots[i + 1]);
                    q.zip(p, |q, p| (q - p) / (b - a))
                };
                let tangent = |i: usize| slope(i - 1).zip(slope(i), |a, b| 0.5 * (a + b));
                if left == 0 || right + 1 >= n {
                    return p0;
                }
                hermite([p0, p1], [tangent(left), tangent(right)], width, u)
            }
            SplineKind::Natural => {
                let zero = [0.0; 5];
                let m0 = self.curvature.get(left).unwrap_or(&zero);
                let m1 = self.curvature.get(right).unwrap_or(&zero);
                let (a, b) = (1.0 - u, u);
                let (fa, fb) = ((a * a * a - a), (b * b * b - b));
                let mut value = p0.zip(p1, |p, q| a * p + b * q).components();
                for ((v, m0), m1) in value.iter_mut().zip(m0).zip(m1) {
                    *v += (fa * m0 + fb * m1) * (width * width) / 6.0;
                }
                Vector::new(value.get(..p0.len()).unwrap_or(&value))
            }
        }
    }

    /// The same points with another kind of curve.
    fn with_kind(&self, kind: SplineKind) -> Self {
        Self::new(kind, self.knots.iter().copied())
    }
}

/// Lagrange's parabola through three points.
fn parabola(points: [(f64, Vector); 3], t: f64) -> Vector {
    let [(a, p), (b, q), (c, r)] = points;
    let wa = (t - b) * (t - c) / ((a - b) * (a - c));
    let wb = (t - a) * (t - c) / ((b - a) * (b - c));
    let wc = (t - a) * (t - b) / ((c - a) * (c - b));
    p.map(|x| x * wa)
        .zip(q, |x, y| x + y * wb)
        .zip(r, |x, y| x + y * wc)
}

/// The cubic Hermite curve with these ends and tangents.
fn hermite(ends: [Vector; 2], tangents: [Vector; 2], width: f64, u: f64) -> Vector {
    let (u2, u3) = (u * u, u * u * u);
    let h00 = 2.0 * u3 - 3.0 * u2 + 1.0;
    let h10 = (u3 - 2.0 * u2 + u) * width;
    let h01 = 3.0 * u2 - 2.0 * u3;
    let h11 = (u3 - u2) * width;
    let [p, q] = ends;
    let [m, n] = tangents;
    p.map(|x| x * h00)
        .zip(m, |x, y| x + y * h10)
        .zip(q, |x, y| x + y * h01)
        .zip(n, |x, y| x + y * h11)
}

/// Second derivatives of the natural spline: the tridiagonal system of its continuous slopes, by Thomas' algorithm (Press et
/// al., Numerical Recipes, section 3.3).
fn curvature(knots: &[(f64, Vector)]) -> Vec<[f64; 5]> {
    let n = knots.len();
    let mut second = vec![[0.0; 5]; n];
    let mut factors = vec![0.0; n];
    let mut rest = vec![[0.0; 5]; n];
    for i in 1..n.saturating_sub(1) {
        let ((t0, p0), (t1, p1), (t2, p2)) = (knots[i - 1], knots[i], knots[i + 1]);
        let sigma = (t1 - t0) / (t2 - t0);
        let pivot = sigma * factors[i - 1] + 2.0;
        factors[i] = (sigma - 1.0) / pivot;
        let (p0, p1, p2) = (p0.components(), p1.components(), p2.components());
        for c in 0..5 {
            let bend = (p2[c] - p1[c]) / (t2 - t1) - (p1[c] - p0[c]) / (t1 - t0);
            rest[i][c] = (6.0 * bend / (t2 - t0) - sigma * rest[i - 1][c]) / pivot;
        }
    }
    for i in (1..n.saturating_sub(1)).rev() {
        for c in 0..5 {
            second[i][c] = factors[i] * second[i + 1][c] + rest[i][c];
        }
    }
    second
}

/// Whether a value is a spline or an array of such, as its first element tells.
fn holds_splines(value: &Value) -> bool {
    match value {
        Value::Spline(_) => true,
        Value::Array(array) => array
            .elements()
            .iter()
            .flatten()
            .next()
            .is_some_and(holds_splines),
        _ => false,
    }
}

fn kind_of(word: Option<Word>) -> Option<SplineKind> {
    Some(match word? {
        Word::LinearSpline => SplineKind::Linear,
        Word::QuadraticSpline => SplineKind::Quadratic,
        Word::CubicSpline => SplineKind::Cubic,
        Word::NaturalSpline => SplineKind::Natural,
        _ => return None,
    })
}

impl Parser<'_> {
    /// `{ [kind] [Name] t, point ... }` after `spline`.
    pub(super) fn spline(&mut self) -> PResult<Value> {
        let mut kind = SplineKind::Linear;
        let mut points = vec![];
        let place = self.place();
        self.braces(|p| {
            if let Some(named) = p.named_spline()? {
                kind = named.kind;
                points.extend(named.knots.iter().copied());
                p.comma()?;
            }
            if let Some(given) = kind_of(p.peek()?.word()) {
                p.next()?;
                kind = given;
            }
            let copied = points.len();
            let (mut all, mut most) = ([0.0; 5], 2);
            p.items("`spline`", |p, _| {
                p.spend_elements(1)?;
                let t = p.float()?;
                p.comma()?;
                // A number counts as two; components that are not given are those of the entry before, as in POV-Ray (measured).
                let given = p.expression()?;
                let count = given.len().max(2);
                let given = given.promoted(count).components();
                all[..count].copy_from_slice(&given[..count]);
                most = most.max(count);
                points.push((t, Vector::new(&all)));
                Ok(())
            })?;
            for (_, point) in points.iter_mut().skip(copied) {
                *point = point.promoted(most);
            }
            Ok(())
        })?;
        if points.is_empty() {
            return Err(self.fail(place, "a spline needs at least one point"));
        }
        if points.iter().any(|(t, _)| !t.is_finite()) {
            return Err(self.fail(place, "the parameter of a point is not a finite number"));
        }
        Ok(Value::Spline(Arc::new(Spline::new(kind, points))))
    }

    /// The spline of a name or of an element of an array, if one follows.
    fn named_spline(&mut self) -> PResult<Option<Arc<Spline>>> {
        let token = self.peek()?;
        let value = token.symbol().and_then(|s| self.scopes.find(s));
        if !value.is_some_and(holds_splines) {
            return Ok(None);
        }
        let place = self.place_of(token);
        match self.variable(token)? {
            Value::Spline(spline) => Ok(Some(spline)),
            other => {
                let message = format!("expected a spline, found {}", other.describe());
                Err(self.fail(place, message))
            }
        }
    }

    /// `(t)` or `(t, kind)` after the name of a spline.
    pub(super) fn call_spline(&mut self, spline: &Spline) -> PResult<Vector> {
        self.expect(Kind::LeftParen)?;
        let t = self.full_float()?;
        self.comma()?;
        let token = self.peek()?;
        let value = match kind_of(token.word()) {
            Some(kind) => {
                self.take(token)?;
                if kind == spline.kind {
                    spline.at(t)
                } else {
                    spline.with_kind(kind).at(t)
                }
            }
            None => spline.at(t),
        };
        self.expect(Kind::RightParen)?;
        Ok(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x of the spline through (0, 0), (1, 1), (2, 0), (4, 3), (5, 2), printed by POV-Ray 3.7.0.10 with ten digits for
    /// t = -1, -0.5, ... 6.
    #[test]
    fn curves_are_those_of_povray() {
        let measured = [
            (
                SplineKind::Linear,
                "0 0 0 0.5 1 0.5 0 0.75 1.5 2.25 3 2.5 2 2 2",
            ),
            (
                SplineKind::Quadratic,
                "0 0 0 0.75 1 0.75 0 0.125 0.6666666667 1.625 3 2.7083333333 2 2 2",
            ),
            (
                SplineKind::Cubic,
                "1 1 1 1 1 0.46875 0 0.515625 1.5 2.484375 3 3 3 3 3",
            ),
            (
                SplineKind::Natural,
                "0 0 0 0.7581967213 1 0.4754098361 0 0.3865266393 1.3709016393 2.4198258197 3 2.7505122951 2 2 2",
            ),
        ];
        let points = [(0.0, 0.0), (1.0, 1.0), (2.0, 0.0), (4.0, 3.0), (5.0, 2.0)];
        for (kind, values) in measured {
            let knots = points.map(|(t, x)| (t, Vector::new(&[x, x + 1.0])));
            let spline = Spline::new(kind, knots);
            for (step, expected) in values.split(' ').enumerate() {
                let t = -1.0 + 0.5 * step as f64;
                let expected: f64 = expected.parse().unwrap();
                let found = spline.at(t).components()[0];
                assert!(
                    (found - expected).abs() < 1e-10,
                    "{kind:?} {t}: {found} {expected}"
                );
            }
        }
    }

    #[test]
    fn few_points_and_any_order() {
        let at = |kind, points: &[(f64, f64)], t: f64| {
            let knots = points.iter().map(|(t, x)| (*t, Vector::float(*x)));
            Spline::new(kind, knots).at(t).components()[0]
        };
        let three = [(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)];
        assert_eq!(at(SplineKind::Cubic, &three, 0.3), 1.0);
        assert_eq!(at(SplineKind::Quadratic, &three[..2], 0.5), 0.5);
        assert_eq!(at(SplineKind::Natural, &three[..2], 0.5), 0.5);
        assert_eq!(
            at(
                SplineKind::Linear,
                &[(2.0, 0.0), (0.0, 1.0), (1.0, 5.0)],
                0.5
            ),
            3.0
        );
        assert_eq!(at(SplineKind::Cubic, &three[..1], 9.0), 0.0);
        assert_eq!(at(SplineKind::Linear, &three, f64::NAN), 0.0);
    }
}
