use super::curve::{Piece, range};
use super::outline::{End, smooth_runs};
use super::runs::{Rect, Runs};
use super::sextic::Terms;
use strahl_math::DVec2;
use strahl_math::error::gamma;
use strahl_math::roots::find_root;

/// Most pieces in a leaf of the boxes around them: testing a piece costs little more than testing a box.
const LEAF: usize = 3;

/// A piece of a curve in the half-plane of radius and height, on which both are monotone.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Arc {
    /// The radius, or its square; not negative.
    pub(super) x: Piece<f64>,
    squared: bool,
    /// The height.
    pub(super) y: Piece<f64>,
    /// Whether the surface is visible.
    pub(super) visible: bool,
    /// The texture coordinate along the curve at both ends.
    pub(super) v: [f64; 2],
}

/// A point of an [`Arc`].
#[derive(Clone, Copy)]
pub(super) struct ArcPoint {
    pub(super) y: f64,
    /// The square of the radius.
    pub(super) square: f64,
}

/// The derivatives at a point of an [`Arc`].
#[derive(Clone, Copy)]
pub(super) struct ArcSlope {
    pub(super) y: f64,
    /// That of the square of the radius.
    pub(super) square: f64,
}

impl Arc {
    #[inline]
    pub(super) fn at(&self, s: f64) -> ArcPoint {
        self.point(self.x.at(s), self.y.at(s))
    }

    #[inline]
    pub(super) fn start(&self) -> ArcPoint {
        self.point(self.x.start(), self.y.start())
    }

    #[inline]
    pub(super) fn end(&self) -> ArcPoint {
        self.point(self.x.end(), self.y.end())
    }

    #[inline]
    fn point(&self, x: f64, y: f64) -> ArcPoint {
        let square = if self.squared { x } else { x * x };
        ArcPoint { y, square }
    }

    /// The point and the derivatives at `s`.
    #[inline]
    pub(super) fn at_with_slope(&self, s: f64) -> (ArcPoint, ArcSlope) {
        let (x, dx) = self.x.at_with_slope(s);
        let (y, dy) = self.y.at_with_slope(s);
        let square = if self.squared { dx } else { 2.0 * x * dx };
        (self.point(x, y), ArcSlope { y: dy, square })
    }

    /// Whether the curve is given by the squares of its radii.
    pub(super) fn is_squared(&self) -> bool {
        self.squared
    }

    pub(super) fn radius(&self, s: f64) -> f64 {
        let x = self.x.at(s);
        // Rounding may give a negative number at the axis.
        let x = if x > 0.0 { x } else { 0.0 };
        if self.squared { x.sqrt() } else { x }
    }

    /// A vector to the right of the curve at `s` (radius, height); zero where the curve stands still.
    pub(super) fn right(&self, s: f64) -> DVec2 {
        let (slope, dy) = (self.x.derivative(s), self.y.derivative(s));
        let right = if self.squared {
            // With r' = (r²)' / 2r, times 2r.
            DVec2::new(2.0 * self.radius(s) * dy, -slope)
        } else {
            DVec2::new(dy, -slope)
        };
        let (x, y) = (&self.x, &self.y);
        let chord = DVec2::new(y.end() - y.start(), x.start() - x.end());
        if right.length() > gamma(64) * chord.length() {
            right
        } else {
            chord
        }
    }

    /// Bounds of the derivative of the height over a part of the piece.
    #[inline]
    pub(super) fn dy_range(&self, a: f64, b: f64) -> [f64; 2] {
        self.y.slope_range(a, b)
    }

    /// Bounds of the derivative of the squared radius over a part of the piece.
    #[inline]
    pub(super) fn d_square_range(&self, a: f64, b: f64) -> [f64; 2] {
        let slope = self.x.slope_range(a, b);
        if self.squared {
            return slope;
        }
        let [p, q] = [self.x.at(a), self.x.at(b)];
        let products = [p * slope[0], p * slope[1], q * slope[0], q * slope[1]];
        range(&products.map(|product| 2.0 * product))
    }

    /// The parameter at which the height is `y`, which it has somewhere.
    pub(super) fn at_height(&self, y: f64) -> f64 {
        let rising = self.y.end() > self.y.start();
        find_root(0.0, 1.0, rising, f64::NAN, |s| {
            let (height, slope) = self.y.at_with_slope(s);
            (height - y, slope)
        })
    }

    /// Box of the squared radius and the height, with room for rounding.
    fn bounds(&self) -> Rect {
        let (x, y) = (range(self.x.points()), range(self.y.points()));
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

    /// What polynomials of lines are made of.
    fn terms(&self, middle: f64) -> Terms {
        Terms::new(&self.x, self.squared, &self.y, middle)
    }

    /// The place and the direction at a parameter.
    fn tangent(&self, s: f64) -> End {
        let right = self.right(s);
        let along = DVec2::new(-right.y, right.x);
        (DVec2::new(self.radius(s), self.y.at(s)), along)
    }
}

/// A curve that is rotated about the axis: closed contours of arcs, some of which are invisible.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Meridian {
    pub(super) arcs: Box<[Arc]>,
    /// For each arc, the first arc of its smooth run.
    pub(super) smooth: Box<[u32]>,
    /// Boxes of squared radius and height.
    pub(super) runs: Runs,
    /// For each arc, its part of the polynomials that lines make with it.
    pub(super) terms: Box<[Terms]>,
    /// The height in the middle.
    pub(super) middle: f64,
    /// The largest height over the middle and the largest squared radius of all control points.
    pub(super) reach: [f64; 2],
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

    /// Appends a piece of the curve (radius, height). The radius may have either sign: the other half of the plane is the same.
    pub(super) fn piece(&mut self, piece: &Piece<DVec2>, visible: bool, v: [f64; 2]) {
        let (x, y) = (piece.map(|p| p.x), piece.map(|p| p.y));
        self.monotone(x, y, false, visible, v);
    }

    /// Appends a piece of the curve that is given by the square of its radius; where that is negative there is nothing.
    pub(super) fn squared_piece(&mut self, square: Piece<f64>, y: Piece<f64>, v: [f64; 2]) {
        self.monotone(square, y, true, true, v);
    }

    /// Splits a piece where radius or height have an extremum and where it meets the axis.
    fn monotone(
        &mut self,
        mut x: Piece<f64>,
        mut y: Piece<f64>,
        squared: bool,
        visible: bool,
        v: [f64; 2],
    ) {
        let mut cuts = vec![0.0];
        cuts.extend(x.extrema());
        cuts.extend(y.extrema());
        cuts.extend(x.zeros());
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
            let (xs, ys) = (x.split(s), y.split(s));
            let (head_x, head_y) = if last { (x, y) } else { (xs.0, ys.0) };
            (x, y) = (xs.1, ys.1);
            self.arc(head_x, head_y, squared, visible, [at(from), at(to)]);
        }
    }

    fn arc(&mut self, mut x: Piece<f64>, y: Piece<f64>, squared: bool, visible: bool, v: [f64; 2]) {
        if x.start() + x.end() < 0.0 {
            if squared {
                return; // A negative square: there is nothing.
            }
            x = x.map(|x| -x);
        }
        let all = |piece: &Piece<f64>, value: f64| piece.points().iter().all(|p| *p == value);
        let still = all(&x, x.start()) && all(&y, y.start());
        if still || all(&x, 0.0) {
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
            .map(|arc| [arc.tangent(0.0), arc.tangent(1.0)])
            .collect();
        let boxes: Vec<_> = self.arcs.iter().map(Arc::bounds).collect();
        let runs = Runs::build(&boxes, LEAF);
        let Rect { min, max } = runs.bounds();
        let middle = 0.5 * (min.y + max.y);
        let terms = self.arcs.iter().map(|arc| arc.terms(middle));
        let terms: Box<[Terms]> = terms.collect();
        let reach = terms.iter().map(Terms::reach);
        let reach = reach.fold([0.0; 2], |[h, r]: [f64; 2], [y, x]| [h.max(y), r.max(x)]);
        Meridian {
            smooth: smooth_runs(&ends, &self.starts),
            runs,
            arcs: self.arcs.into_boxed_slice(),
            terms,
            middle,
            reach,
        }
    }
}
