use std::fmt::Debug;
use std::ops::{Add, Mul, Sub};
use strahl_math::roots::Bernstein;

/// The coefficients of curves: numbers and vectors.
pub(crate) trait Linear:
    Copy + Debug + PartialEq + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>
{
}

impl<V> Linear for V where
    V: Copy + Debug + PartialEq + Add<Output = V> + Sub<Output = V> + Mul<f64, Output = V>
{
}

/// A piece of a curve as its Bézier control points: from the first at `s = 0` to the last at `s = 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Piece<V> {
    Line([V; 2]),
    Quadratic([V; 3]),
    Cubic([V; 4]),
}

impl<V: Linear> Piece<V> {
    pub(super) fn points(&self) -> &[V] {
        match self {
            Self::Line(p) => p,
            Self::Quadratic(p) => p,
            Self::Cubic(p) => p,
        }
    }

    pub(super) fn start(&self) -> V {
        match *self {
            Self::Line([p, ..]) | Self::Quadratic([p, ..]) | Self::Cubic([p, ..]) => p,
        }
    }

    pub(super) fn end(&self) -> V {
        match *self {
            Self::Line([.., p]) | Self::Quadratic([.., p]) | Self::Cubic([.., p]) => p,
        }
    }

    /// The point at `s`, by de Casteljau's algorithm; exactly the end points at 0 and 1.
    pub(super) fn at(&self, s: f64) -> V {
        let mix = |a: V, b: V| a * (1.0 - s) + b * s;
        match *self {
            Self::Line([a, b]) => mix(a, b),
            Self::Quadratic([a, b, c]) => mix(mix(a, b), mix(b, c)),
            Self::Cubic([a, b, c, d]) => {
                let (ab, bc, cd) = (mix(a, b), mix(b, c), mix(c, d));
                mix(mix(ab, bc), mix(bc, cd))
            }
        }
    }

    /// The derivative at `s`.
    pub(super) fn derivative(&self, s: f64) -> V {
        let mix = |a: V, b: V| a * (1.0 - s) + b * s;
        match *self {
            Self::Line([a, b]) => b - a,
            Self::Quadratic([a, b, c]) => mix(b - a, c - b) * 2.0,
            Self::Cubic([a, b, c, d]) => mix(mix(b - a, c - b), mix(c - b, d - c)) * 3.0,
        }
    }

    /// The point and the derivative at `s`, both from one run of de Casteljau's algorithm.
    #[inline]
    pub(super) fn at_with_slope(&self, s: f64) -> (V, V) {
        let mix = |a: V, b: V| a * (1.0 - s) + b * s;
        match *self {
            Self::Line([a, b]) => (mix(a, b), b - a),
            Self::Quadratic([a, b, c]) => {
                let (ab, bc) = (mix(a, b), mix(b, c));
                (mix(ab, bc), (bc - ab) * 2.0)
            }
            Self::Cubic([a, b, c, d]) => {
                let (ab, bc, cd) = (mix(a, b), mix(b, c), mix(c, d));
                let (abc, bcd) = (mix(ab, bc), mix(bc, cd));
                (mix(abc, bcd), (bcd - abc) * 3.0)
            }
        }
    }

    /// The parts before and behind `s`, each from 0 to 1.
    pub(super) fn split(&self, s: f64) -> (Self, Self) {
        let mix = |a: V, b: V| a * (1.0 - s) + b * s;
        match *self {
            Self::Line([a, b]) => {
                let middle = mix(a, b);
                (Self::Line([a, middle]), Self::Line([middle, b]))
            }
            Self::Quadratic([a, b, c]) => {
                let (ab, bc) = (mix(a, b), mix(b, c));
                let middle = mix(ab, bc);
                (
                    Self::Quadratic([a, ab, middle]),
                    Self::Quadratic([middle, bc, c]),
                )
            }
            Self::Cubic([a, b, c, d]) => {
                let (ab, bc, cd) = (mix(a, b), mix(b, c), mix(c, d));
                let (abc, bcd) = (mix(ab, bc), mix(bc, cd));
                let middle = mix(abc, bcd);
                (
                    Self::Cubic([a, ab, abc, middle]),
                    Self::Cubic([middle, bcd, cd, d]),
                )
            }
        }
    }

    /// The same curve with four control points.
    pub(super) fn cubic(&self) -> [V; 4] {
        match *self {
            Self::Line([a, b]) => [
                a,
                (a * 2.0 + b) * (1.0 / 3.0),
                (a + b * 2.0) * (1.0 / 3.0),
                b,
            ],
            Self::Quadratic([a, b, c]) => [
                a,
                (a + b * 2.0) * (1.0 / 3.0),
                (b * 2.0 + c) * (1.0 / 3.0),
                c,
            ],
            Self::Cubic(points) => points,
        }
    }

    /// The curve whose control points are functions of those of this one.
    pub(super) fn map<W>(&self, f: impl Fn(V) -> W) -> Piece<W> {
        match *self {
            Self::Line(p) => Piece::Line(p.map(f)),
            Self::Quadratic(p) => Piece::Quadratic(p.map(f)),
            Self::Cubic(p) => Piece::Cubic(p.map(f)),
        }
    }
}

impl Piece<f64> {
    /// The parameters within 0..1 at which the value is 0.
    pub(super) fn zeros(&self) -> Vec<f64> {
        match *self {
            Self::Line(c) => roots(c),
            Self::Quadratic(c) => roots(c),
            Self::Cubic(c) => roots(c),
        }
    }

    /// The parameters within 0..1 at which the derivative is 0; none for lines.
    pub(super) fn extrema(&self) -> Vec<f64> {
        match *self {
            Self::Line(_) => vec![],
            Self::Quadratic([a, b, c]) => roots([b - a, c - b]),
            Self::Cubic([a, b, c, d]) => roots([b - a, c - b, d - c]),
        }
    }

    /// Bounds of the derivative on `from..to`: its control points there are its blossom's values.
    #[inline]
    pub(super) fn slope_range(&self, from: f64, to: f64) -> [f64; 2] {
        let mix = |s: f64, a: f64, b: f64| (1.0 - s) * a + s * b;
        match *self {
            Self::Line([a, b]) => [b - a, b - a],
            Self::Quadratic([a, b, c]) => range(&[from, to].map(|s| 2.0 * mix(s, b - a, c - b))),
            Self::Cubic([a, b, c, d]) => {
                let d = [b - a, c - b, d - c];
                let blossom = |u: f64, v: f64| mix(v, mix(u, d[0], d[1]), mix(u, d[1], d[2]));
                let values = [blossom(from, from), blossom(from, to), blossom(to, to)];
                range(&values.map(|slope| 3.0 * slope))
            }
        }
    }
}

/// The roots in 0..1 of the polynomial with these Bernstein coefficients.
fn roots<const N: usize>(coefficients: [f64; N]) -> Vec<f64> {
    let polynomial = Bernstein::new(coefficients, 0.0, 0.0, 1.0);
    polynomial.roots().iter().copied().collect()
}

/// The least and the greatest of the values.
#[inline]
pub(super) fn range(values: &[f64]) -> [f64; 2] {
    values
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &v| {
            [
                if v < low { v } else { low },
                if v > high { v } else { high },
            ]
        })
}

/// How the control points of a `prism` or `lathe` become a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spline {
    /// Straight from point to point.
    Linear,
    /// Parabolas from the second point to the last; where one begins, its slope is that of the line from the point before to the
    /// point after.
    Quadratic,
    /// Cubics from the second point to the last but one, with the slope at each point that of the line between its
    /// neighbours (Catmull and Rom 1974).
    Cubic,
    /// A cubic Bézier curve for every four points.
    Bezier,
}

impl Spline {
    /// How many additional points there are before the first and behind the last point of the curve.
    pub(super) const fn surplus(self) -> (usize, usize) {
        match self {
            Self::Linear | Self::Bezier => (0, 0),
            Self::Quadratic => (1, 0),
            Self::Cubic => (1, 1),
        }
    }

    /// The pieces of a curve; superfluous points (of Bézier curves) are ignored.
    pub(super) fn pieces<V: Linear>(self, points: &[V]) -> Vec<Piece<V>> {
        let straight = |pair: &[V]| match *pair {
            [a, b] => Some(Piece::Line([a, b])),
            _ => None,
        };
        let parabola = |three: &[V]| match *three {
            [before, a, b] => Some(Piece::Quadratic([a, a + (b - before) * 0.25, b])),
            _ => None,
        };
        let cubic = |four: &[V]| match *four {
            [before, a, b, after] => Some(catmull_rom(before, a, b, after)),
            _ => None,
        };
        let bezier = |four: &[V]| match *four {
            [a, b, c, d] => Some(Piece::Cubic([a, b, c, d])),
            _ => None,
        };
        match self {
            Self::Linear => points.windows(2).filter_map(straight).collect(),
            Self::Quadratic => points.windows(3).filter_map(parabola).collect(),
            Self::Cubic => points.windows(4).filter_map(cubic).collect(),
            Self::Bezier => points.chunks(4).filter_map(bezier).collect(),
        }
    }
}

/// The cubic from `a` to `b` whose slopes there are those between their neighbours.
pub(super) fn catmull_rom<V: Linear>(before: V, a: V, b: V, after: V) -> Piece<V> {
    const SIXTH: f64 = 1.0 / 6.0;
    Piece::Cubic([a, a + (b - before) * SIXTH, b - (after - a) * SIXTH, b])
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_math::DVec2;

    #[test]
    fn ends_are_exact_and_slopes_are_right() {
        let p = [
            DVec2::new(0.1, 0.7),
            DVec2::new(1.3, -0.2),
            DVec2::new(2.7, 0.9),
            DVec2::new(-0.3, 0.4),
        ];
        let pieces = [
            Piece::Line([p[0], p[1]]),
            Piece::Quadratic([p[0], p[1], p[2]]),
            Piece::Cubic(p),
        ];
        for piece in pieces {
            assert_eq!(piece.at(0.0), piece.start());
            assert_eq!(piece.at(1.0), piece.end());
            let cubic = Piece::Cubic(piece.cubic());
            for i in 0..=8 {
                let s = f64::from(i) / 8.0;
                assert!((cubic.at(s) - piece.at(s)).length() < 1e-15);
                let (point, slope) = piece.at_with_slope(s);
                assert_eq!(point, piece.at(s));
                assert!((slope - piece.derivative(s)).length() < 1e-14);
                let difference = (piece.at(s + 1e-6) - piece.at(s - 1e-6)) / 2e-6;
                assert!((difference - slope).length() < 1e-8);
                let (head, tail) = piece.split(0.3);
                assert!((head.at(s) - piece.at(0.3 * s)).length() < 1e-14);
                assert!((tail.at(s) - piece.at(0.3 + 0.7 * s)).length() < 1e-14);
                let heights = piece.map(|p| p.y);
                let [low, high] = heights.slope_range(0.5 * s, s);
                let middle = heights.derivative(0.7 * s);
                assert!(low <= middle + 1e-14 && middle <= high + 1e-14);
            }
        }
    }

    #[test]
    fn zeros_and_extrema() {
        let parabola = Piece::Quadratic([1.0, -1.25, 1.0]);
        assert_eq!(parabola.extrema(), [0.5]);
        let third = 1.0 / 3.0;
        let zeros = parabola.zeros();
        assert_eq!(zeros.len(), 2);
        assert!((zeros[0] - third).abs() < 1e-15 && (zeros[1] - 2.0 * third).abs() < 1e-15);
        assert_eq!(Piece::Line([-1.0, 3.0]).zeros(), [0.25]);
        assert!(Piece::Line([-1.0, 3.0]).extrema().is_empty());
    }

    #[test]
    fn splines_pass_through_their_points_with_the_slopes_of_their_neighbours() {
        let p = [3.0, 0.0, 6.0, 2.0, 5.0];
        assert_eq!(Spline::Linear.pieces(&p).len(), 4);
        assert_eq!(Spline::Bezier.pieces(&p).len(), 1);
        let parabolas = Spline::Quadratic.pieces(&p);
        assert_eq!(parabolas.len(), 3);
        assert_eq!((parabolas[1].start(), parabolas[1].end()), (6.0, 2.0));
        assert_eq!(parabolas[1].derivative(0.0), 1.0);
        let cubics = Spline::Cubic.pieces(&p);
        assert_eq!(cubics.len(), 2);
        assert_eq!((cubics[0].start(), cubics[0].end()), (0.0, 6.0));
        assert!((cubics[0].derivative(0.0) - 1.5).abs() < 1e-15);
        assert!((cubics[0].derivative(1.0) - 1.0).abs() < 1e-15);
        assert!((cubics[1].derivative(0.0) - 1.0).abs() < 1e-15);
    }
}
