use super::curve::Piece;
use super::outline::{End, smooth_runs};
use super::runs::{Rect, Runs};
use strahl_math::DVec2;
use strahl_math::error::gamma;
use strahl_math::roots::{Bernstein, find_root};

/// A piece of a curve in the half-plane of radius and height, on which both are monotone.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Arc {
    /// Bézier coefficients of the radius, or of its square; not negative.
    x: [f64; 4],
    squared: bool,
    /// Bézier coefficients of the height.
    y: [f64; 4],
    /// Whether the surface is visible.
    pub(super) visible: bool,
    /// The texture coordinate along the curve at both ends.
    pub(super) v: [f64; 2],
}

/// A point of an [`Arc`] with derivatives.
#[derive(Clone, Copy)]
pub(super) struct ArcPoint {
    pub(super) y: f64,
    pub(super) dy: f64,
    /// The square of the radius ...
    pub(super) square: f64,
    /// ... and its derivative.
    pub(super) d_square: f64,
}

impl Arc {
    pub(super) fn at(&self, s: f64) -> ArcPoint {
        let (x, y) = (Piece::Cubic(self.x), Piece::Cubic(self.y));
        let (value, slope) = (x.at(s), x.derivative(s));
        let (square, d_square) = if self.squared {
            (value, slope)
        } else {
            (value * value, 2.0 * value * slope)
        };
        ArcPoint {
            y: y.at(s),
            dy: y.derivative(s),
            square,
            d_square,
        }
    }

    /// Whether the curve is given by the squares of its radii.
    pub(super) fn is_squared(&self) -> bool {
        self.squared
    }

    pub(super) fn radius(&self, s: f64) -> f64 {
        let x = Piece::Cubic(self.x).at(s);
        // Rounding may give a negative number at the axis.
        let x = if x > 0.0 { x } else { 0.0 };
        if self.squared { x.sqrt() } else { x }
    }

    /// A vector to the right of the curve at `s` (radius, height); zero where the curve stands still.
    pub(super) fn right(&self, s: f64) -> DVec2 {
        let (slope, dy) = (
            Piece::Cubic(self.x).derivative(s),
            Piece::Cubic(self.y).derivative(s),
        );
        let right = if self.squared {
            // With r' = (r²)' / 2r, times 2r.
            DVec2::new(2.0 * self.radius(s) * dy, -slope)
        } else {
            DVec2::new(dy, -slope)
        };
        let [x0, .., x3] = self.x;
        let [y0, .., y3] = self.y;
        let chord = DVec2::new(y3 - y0, x0 - x3);
        if right.length() > gamma(64) * chord.length() {
            right
        } else {
            chord
        }
    }

    /// Bounds of the derivative of the height over a part of the piece.
    pub(super) fn dy_range(&self, a: f64, b: f64) -> [f64; 2] {
        slope_range(&self.y, a, b)
    }

    /// Bounds of the derivative of the squared radius over a part of the piece.
    pub(super) fn d_square_range(&self, a: f64, b: f64) -> [f64; 2] {
        let slope = slope_range(&self.x, a, b);
        if self.squared {
            return slope;
        }
        let x = Piece::Cubic(self.x);
        let [p, q] = [x.at(a), x.at(b)];
        let products = [p * slope[0], p * slope[1], q * slope[0], q * slope[1]];
        range(products.map(|product| 2.0 * product))
    }

    /// The parameter at which the height is `y`, which it has somewhere.
    pub(super) fn at_height(&self, y: f64) -> f64 {
        let curve = Piece::Cubic(self.y);
        let rising = curve.end() > curve.start();
        find_root(0.0, 1.0, rising, f64::NAN, |s| {
            (curve.at(s) - y, curve.derivative(s))
        })
    }

    /// Box of the squared radius and the height, with room for rounding.
    fn bounds(&self) -> Rect {
        let (x, y) = (range(self.x), range(self.y));
        let square = |x: f64| if self.squared { x } else { x * x };
        let rect = Rect {
            min: DVec2::new(square(if x[0] > 0.0 { x[0] } else { 0.0 }), y[0]),
            max: DVec2::new(square(x[1]), y[1]),
        };
        let room = (rect.min.abs() + rect.max.abs()) * gamma(32);
        Rect {
            min: rect.min - room,
            max: rect.max + room,
        }
    }

    fn end(&self, s: f64) -> End {
        let right = self.right(s);
        let along = DVec2::new(-right.y, right.x);
        (DVec2::new(self.radius(s), self.at(s).y), along)
    }
}

fn range<const N: usize>(values: [f64; N]) -> [f64; 2] {
    values
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &v| {
            [
                if v < low { v } else { low },
                if v > high { v } else { high },
            ]
        })
}

/// Bounds of the derivative of a cubic on `a..b`: its control points there are its blossom's values.
fn slope_range(c: &[f64; 4], a: f64, b: f64) -> [f64; 2] {
    let d = [c[1] - c[0], c[2] - c[1], c[3] - c[2]];
    let blossom = |u: f64, v: f64| {
        (1.0 - u) * (1.0 - v) * d[0] + ((1.0 - u) * v + u * (1.0 - v)) * d[1] + u * v * d[2]
    };
    range([blossom(a, a), blossom(a, b), blossom(b, b)].map(|slope| 3.0 * slope))
}

/// A curve that is rotated about the axis: closed contours of arcs, some of which are invisible.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Meridian {
    pub(super) arcs: Box<[Arc]>,
    /// For each arc, the first arc of its smooth run.
    pub(super) smooth: Box<[u32]>,
    /// Boxes of squared radius and height.
    pub(super) runs: Runs,
}

/// Collects the arcs of a [`Meridian`].
#[derive(Debug, Default)]
pub(super) struct MeridianBuilder {
    arcs: Vec<Arc>,
    starts: Vec<usize>,
}

impl MeridianBuilder {
    /// Begins another contour.
    pub(super) fn begin(&mut self) {
        self.starts.push(self.arcs.len());
    }

    /// Appends a piece of the curve, whose `x` is the radius (of either sign: the other half of the plane is the same) or its
    /// square. It is split where radius or height have an extremum and where it meets the axis.
    pub(super) fn piece(
        &mut self,
        piece: &Piece<DVec2>,
        squared: bool,
        visible: bool,
        v: [f64; 2],
    ) {
        let points = piece.cubic();
        let (mut x, mut y) = (points.map(|p| p.x), points.map(|p| p.y));
        let mut cuts = vec![0.0];
        for c in [&x, &y] {
            let slope = [c[1] - c[0], c[2] - c[1], c[3] - c[2]];
            cuts.extend(Bernstein::new(slope, 0.0, 0.0, 1.0).roots().iter());
        }
        cuts.extend(Bernstein::new(x, 0.0, 0.0, 1.0).roots().iter());
        cuts.sort_unstable_by(f64::total_cmp);
        cuts.push(1.0);
        let at = |s: f64| v[0] + (v[1] - v[0]) * s;
        for pair in cuts.windows(2) {
            let &[from, to] = pair else { continue };
            if !(from < to) {
                continue;
            }
            // The next cut, seen from the rest of the piece.
            let s = (to - from) / (1.0 - from);
            let last = to == 1.0;
            let (xs, ys) = (split(&x, s), split(&y, s));
            let (head_x, head_y) = if last { (x, y) } else { (xs.0, ys.0) };
            (x, y) = (xs.1, ys.1);
            self.arc(head_x, head_y, squared, visible, [at(from), at(to)]);
        }
    }

    fn arc(&mut self, mut x: [f64; 4], y: [f64; 4], squared: bool, visible: bool, v: [f64; 2]) {
        let [x0, .., x3] = x;
        if x0 + x3 < 0.0 {
            if squared {
                return; // A negative square: there is nothing.
            }
            x = x.map(|x| -x);
        }
        let still = x.iter().all(|x| *x == x0) && y.iter().all(|h| *h == y[0]);
        if still || x.iter().all(|x| *x == 0.0) {
            return; // A point, or along the axis: no area.
        }
        self.arcs.push(Arc {
            x,
            squared,
            y,
            visible,
            v,
        });
    }

    /// The range of radii of all appended pieces, visible or not.
    pub(super) fn radii(&self) -> [f64; 2] {
        let ends = self
            .arcs
            .iter()
            .flat_map(|arc| [arc.radius(0.0), arc.radius(1.0)]);
        ends.fold([f64::INFINITY, 0.0], |[low, high], r| {
            [
                if r < low { r } else { low },
                if r > high { r } else { high },
            ]
        })
    }

    pub(super) fn finish(self) -> Meridian {
        let ends: Vec<_> = self
            .arcs
            .iter()
            .map(|arc| [arc.end(0.0), arc.end(1.0)])
            .collect();
        let boxes: Vec<_> = self.arcs.iter().map(Arc::bounds).collect();
        Meridian {
            smooth: smooth_runs(&ends, &self.starts),
            runs: Runs::build(&boxes),
            arcs: self.arcs.into_boxed_slice(),
        }
    }
}

/// De Casteljau's algorithm at `s`.
fn split(c: &[f64; 4], s: f64) -> ([f64; 4], [f64; 4]) {
    let mix = |a: f64, b: f64| a * (1.0 - s) + b * s;
    let (ab, bc, cd) = (mix(c[0], c[1]), mix(c[1], c[2]), mix(c[2], c[3]));
    let (abc, bcd) = (mix(ab, bc), mix(bc, cd));
    let middle = mix(abc, bcd);
    ([c[0], ab, abc, middle], [middle, bcd, cd, c[3]])
}
