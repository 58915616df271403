//! Splines on knots, cut into Bezier curves.

use crate::GeometryError;

/// The highest degree.
pub(super) const HIGHEST: usize = 9;
/// A gap that is at most so wide, in parts of the parameters, is rounding of the file that they are from.
pub(super) const GAP: f64 = 1e-4;
/// Knots are below this size: their differences are finite.
const LARGEST: f64 = 1e100;

/// What messages call the parts of a spline.
#[derive(Clone, Copy, Debug)]
pub(super) struct Names {
    pub(super) degree: &'static str,
    pub(super) knot: &'static str,
    pub(super) knots: &'static str,
    pub(super) points: &'static str,
}

/// The checked knots of a spline of some control points.
#[derive(Clone, Debug)]
pub(super) struct Knots {
    pub(super) degree: usize,
    knots: Vec<f64>,
    /// The number of control points.
    pub(super) count: usize,
}

/// Knots `0, .., 0, 1, 2, .., n, .., n`: those at the ends `degree + 1` times, so that the spline begins and ends at control
/// points, and the others evenly spaced.
pub(super) fn even(degree: usize, count: usize) -> Vec<f64> {
    let last = count.saturating_sub(degree);
    (0..count + degree + 1)
        .map(|i| i.saturating_sub(degree).min(last) as f64)
        .collect()
}

impl Knots {
    pub(super) fn try_new(
        degree: u32,
        knots: &[f64],
        count: usize,
        names: &Names,
    ) -> Result<Self, GeometryError> {
        let what = names.knot;
        let degree = usize::try_from(degree).unwrap_or(usize::MAX);
        if !(1..=HIGHEST).contains(&degree) {
            return Err(GeometryError::OutOfRange {
                what: names.degree,
                expected: "from 1 to 9",
                found: degree as f64,
            });
        }
        if count <= degree {
            return Err(GeometryError::WrongCount {
                what: names.points,
                expected: degree as u64 + 1,
                found: count as u64,
            });
        }
        if knots.len() != count + degree + 1 {
            return Err(GeometryError::WrongCount {
                what: names.knots,
                expected: (count + degree + 1) as u64,
                found: knots.len() as u64,
            });
        }
        let wrong = |index: usize, expected: &'static str| GeometryError::OutOfRangeAt {
            what,
            index: index as u64,
            expected,
            found: knots.get(index).copied().unwrap_or(f64::NAN),
        };
        for (index, knot) in knots.iter().enumerate() {
            if !knot.is_finite() {
                let index = index as u64;
                return Err(GeometryError::NotFiniteAt { what, index });
            }
            if knot.abs() > LARGEST {
                return Err(wrong(index, "at most 1e100"));
            }
            if index > 0 && knot < &knots[index - 1] {
                return Err(wrong(index, "at least as large as the one before"));
            }
        }
        let all = Self {
            degree,
            knots: knots.to_vec(),
            count,
        };
        let [from, to] = all.domain();
        if from == to {
            return Err(wrong(
                count,
                "larger than the knot with which the surface begins",
            ));
        }
        // A knot within that occurs more often would tear the spline apart.
        for index in degree + 1..count.saturating_sub(degree) + 1 {
            let is_inside = knots[index] > from && knots[index] < to;
            if is_inside && knots.get(index + degree) == Some(&knots[index]) {
                return Err(wrong(
                    index,
                    "repeated at most as often as the degree says, between the ends",
                ));
            }
        }
        Ok(all)
    }

    /// The first and the last parameter.
    pub(super) fn domain(&self) -> [f64; 2] {
        [self.knots[self.degree], self.knots[self.count]]
    }

    /// The numbers of the knots at which pieces begin.
    fn spans(&self) -> impl Iterator<Item = usize> {
        (self.degree..self.count).filter(|k| self.knots[*k] < self.knots[*k + 1])
    }

    /// The parameters between the pieces, from 0 to 1: one more than there are pieces.
    pub(super) fn breaks(&self) -> Vec<f64> {
        let [from, to] = self.domain();
        let mut all: Vec<f64> = self
            .spans()
            .map(|k| (self.knots[k] - from) / (to - from))
            .collect();
        all.push(1.0);
        all
    }

    /// The control points of the Bezier curves that the spline is made of; those of neighbours have one point in common. There
    /// are as many as pieces times the degree, and one.
    ///
    /// The reversed spline gives the reversed points to the last bit, if differences of its knots are exact.
    pub(super) fn bezier<const N: usize>(&self, points: &[[f64; N]]) -> Vec<[f64; N]> {
        let mut out = self.one_way(points);
        let reversed = Self {
            knots: self.knots.iter().rev().map(|k| -k).collect(),
            ..*self
        };
        let back: Vec<_> = points.iter().rev().copied().collect();
        for (a, b) in out.iter_mut().zip(reversed.one_way(&back).iter().rev()) {
            *a = std::array::from_fn(|k| 0.5 * (a[k] + b[k]));
        }
        out
    }

    fn one_way<const N: usize>(&self, points: &[[f64; N]]) -> Vec<[f64; N]> {
        let d = self.degree;
        let mut out = Vec::new();
        for k in self.spans() {
            let (a, b) = (self.knots[k], self.knots[k + 1]);
            for j in usize::from(!out.is_empty())..=d {
                out.push(self.blossom(k, points, |r| if r < d - j { a } else { b }));
            }
        }
        out
    }

    /// The spline from one parameter to another, with its knots: it begins and ends at its outer control points.
    ///
    /// Ends that are a little outside are moved to those of the spline: files are written with a few digits.
    pub(super) fn between<const N: usize>(
        &self,
        range: [f64; 2],
        points: &[[f64; N]],
        what: &'static str,
    ) -> Result<(Vec<f64>, Vec<[f64; N]>), GeometryError> {
        let [first, last] = self.domain();
        let slack = (last - first) * GAP;
        let near = |x: f64| {
            let end = if x < first { first } else { last };
            if (first..=last).contains(&x) {
                Some(x)
            } else {
                ((x - end).abs() <= slack).then_some(end)
            }
        };
        let [from, to] = range.map(near);
        let (Some(from), Some(to)) = (from, to) else {
            return Err(GeometryError::OutOfRange {
                what,
                expected: "between its first and its last parameter",
                found: if from.is_some() { range[1] } else { range[0] },
            });
        };
        if from >= to {
            return Err(GeometryError::OutOfRange {
                what,
                expected: "larger than the one before",
                found: range[1],
            });
        }
        let d = self.degree;
        let mut knots = vec![from; d + 1];
        knots.extend(self.knots.iter().filter(|k| **k > from && **k < to));
        knots.extend(std::iter::repeat_n(to, d + 1));
        let count = knots.len() - d - 1;
        let part = (0..count).map(|i| {
            // A span that this point belongs to, and the piece it lies in.
            let span = (i.max(d)..count).find(|j| knots[*j] < knots[*j + 1]);
            let span = span.unwrap_or(d);
            let middle = 0.5 * (knots[span] + knots[span + 1]);
            let piece = self.spans().take_while(|k| self.knots[*k] <= middle).last();
            self.blossom(piece.unwrap_or(d), points, |r| knots[i + 1 + r])
        });
        let part = part.collect();
        Ok((knots, part))
    }

    /// The polar form of piece `k` at the parameters `at(0), .., at(degree - 1)` (L. Ramshaw, "Blossoms are polar forms",
    /// Computer Aided Geometric Design 6, 1989).
    fn blossom<const N: usize>(
        &self,
        k: usize,
        points: &[[f64; N]],
        at: impl Fn(usize) -> f64,
    ) -> [f64; N] {
        let d = self.degree;
        let mut local = [[0.0; N]; HIGHEST + 1];
        local[..=d].copy_from_slice(&points[k - d..=k]);
        for r in 1..=d {
            let t = at(r - 1);
            for i in (r..=d).rev() {
                let knot = k - d + i;
                let (low, high) = (self.knots[knot], self.knots[knot + d + 1 - r]);
                // Exactly a control point at the ends.
                if t == low {
                    local[i] = local[i - 1];
                } else if t != high {
                    let (a, b) = (local[i - 1], local[i]);
                    local[i] = std::array::from_fn(|n| {
                        ((high - t) * a[n] + (t - low) * b[n]) / (high - low)
                    });
                }
            }
        }
        local[d]
    }
}

/// The same Bezier curve with `K` control points, which are at least as many as there were.
pub(super) fn elevated<const N: usize, const K: usize>(
    points: impl Iterator<Item = [f64; N]>,
) -> [[f64; N]; K] {
    let mut curve = [[0.0; N]; K];
    let mut count = 0;
    for (place, point) in curve.iter_mut().zip(points) {
        *place = point;
        count += 1;
    }
    for n in count..K {
        let total = n as f64;
        curve[n] = curve[n - 1];
        for i in (1..n).rev() {
            let (a, b) = (curve[i - 1], curve[i]);
            let i_of = i as f64;
            curve[i] = std::array::from_fn(|k| (i_of * a[k] + (total - i_of) * b[k]) / total);
        }
    }
    curve
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;

    const NAMES: Names = Names {
        degree: "degree",
        knot: "knot",
        knots: "knots",
        points: "points",
    };

    /// The value of a B-spline by the definition of its basis (Cox, de Boor 1972).
    fn basis(knots: &[f64], i: usize, degree: usize, t: f64) -> f64 {
        if degree == 0 {
            return f64::from(u8::from(knots[i] <= t && t < knots[i + 1]));
        }
        let part = |low: f64, high: f64, value: f64, up: bool| {
            let share = if up { t - low } else { high - t };
            if high > low {
                share / (high - low) * value
            } else {
                0.0
            }
        };
        part(
            knots[i],
            knots[i + degree],
            basis(knots, i, degree - 1, t),
            true,
        ) + part(
            knots[i + 1],
            knots[i + degree + 1],
            basis(knots, i + 1, degree - 1, t),
            false,
        )
    }

    #[test]
    fn bezier_curves_are_the_spline() {
        let mut random = Random::new(6);
        for round in 0..300 {
            let degree = 1 + round % HIGHEST;
            let count = degree + 1 + random.below(8) as usize;
            let mut knots: Vec<f64> = (0..count + degree + 1)
                .map(|_| random.below(3 * count as u64) as f64 * 0.37)
                .collect();
            knots.sort_by(f64::total_cmp);
            let Ok(spline) = Knots::try_new(degree as u32, &knots, count, &NAMES) else {
                continue;
            };
            let points: Vec<[f64; 2]> = (0..count)
                .map(|_| [random.between(-1.0, 1.0), random.between(-1.0, 1.0)])
                .collect();
            let (breaks, curves) = (spline.breaks(), spline.bezier(&points));
            assert_eq!(curves.len(), (breaks.len() - 1) * degree + 1);
            let [from, to] = spline.domain();
            for (piece, pair) in breaks.windows(2).enumerate() {
                let x = random.unit();
                let t = from + (to - from) * (pair[0] + (pair[1] - pair[0]) * x);
                let own = curves[piece * degree..=(piece + 1) * degree]
                    .iter()
                    .copied();
                let curve: [[f64; 2]; 10] = elevated(own);
                let net = crate::patch::net::Net { rows: [curve; 10] };
                let found = net.at(x, 0.5);
                for k in 0..2 {
                    let expected: f64 = (0..count)
                        .map(|i| basis(&knots, i, degree, t) * points[i][k])
                        .sum();
                    assert!((found[k] - expected).abs() < 1e-11, "{knots:?} {t}");
                }
            }
            let reversed = Knots {
                knots: knots.iter().rev().map(|k| -k).collect(),
                ..spline
            };
            let mut back = points;
            back.reverse();
            let mut other = reversed.bezier(&back);
            other.reverse();
            assert_eq!(other, curves);
        }
    }

    #[test]
    fn bezier_curves_on_their_own_knots_stay_as_they_are() {
        let points: Vec<[f64; 1]> = [0.1, 0.7, -0.3, 1.1, 0.4, 0.9, 0.2].map(|x| [x]).to_vec();
        let knots = [0.1, 0.1, 0.1, 0.1, 0.7, 0.7, 0.7, 1.3, 1.3, 1.3, 1.3];
        let spline = Knots::try_new(3, &knots, 7, &NAMES).unwrap();
        assert_eq!(spline.bezier(&points), points);
        assert_eq!(even(3, 4), [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]);
        assert_eq!(even(2, 4), [0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0]);
    }

    #[test]
    fn bad_knots_are_refused() {
        let of = |degree, knots: &[f64], count| {
            Knots::try_new(degree, knots, count, &NAMES)
                .map(|_| ())
                .unwrap_err()
                .to_string()
        };
        assert_eq!(of(0, &[0.0, 1.0], 1), "degree must be from 1 to 9, found 0");
        assert_eq!(
            of(10, &[0.0, 1.0], 1),
            "degree must be from 1 to 9, found 10"
        );
        assert_eq!(of(3, &[0.0; 7], 3), "3 points given, 4 expected");
        assert_eq!(of(1, &[0.0, 1.0, 2.0], 2), "3 knots given, 4 expected");
        assert_eq!(of(1, &[0.0, 0.0, f64::NAN, 1.0], 2), "knot 2 is not finite");
        assert_eq!(
            of(1, &[0.0, 2.0, 1.0, 1.0], 2),
            "knot 2 must be at least as large as the one before, found 1"
        );
        assert!(of(1, &[0.0, 1.0, 1.0, 2.0], 2).contains("knot 2 must be larger"));
        // Twice within a spline of degree 1, which would have a gap there.
        let torn = of(1, &[0.0, 0.0, 0.5, 0.5, 1.0, 1.0], 4);
        assert!(torn.contains("knot 2 must be repeated at most"), "{torn}");
        assert!(Knots::try_new(2, &[0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0], 5, &NAMES).is_ok());
        // More knots at the ends than needed make control points that don't count.
        assert!(Knots::try_new(1, &[0.0, 0.0, 0.0, 1.0, 1.0], 3, &NAMES).is_ok());
    }
}
