use super::curve::Piece;
use super::runs::{Rect, Runs};
use crate::GeometryError;
use crate::blocks::LANES;
use std::ops::{ControlFlow, Range};
use strahl_math::error::gamma;
use strahl_math::roots::{Bernstein, RootCount, newton};
use strahl_math::{DVec2, Interval};
use strahl_simd::{Isa, Simd, dispatch};

/// Closed curves in a plane, made of lines, parabolas and cubics, from which prisms and letters are swept.
///
/// A point is inside if a half-line from it crosses the curves an odd number of times (even-odd rule).
///
/// Built contour by contour with [`OutlineBuilder`]. Outlines are shared: a page of text has few different letters.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    pieces: Box<[Piece<DVec2>]>,
    points: ControlPoints,
    /// For each piece, the first piece of the smooth run that it belongs to.
    smooth: Box<[u32]>,
    runs: Runs,
    /// The largest absolute coordinates.
    reach: DVec2,
    gaps: usize,
}

/// Collects the contours of an [`Outline`].
///
/// ```
/// use strahl_geometry::OutlineBuilder;
/// use strahl_math::DVec2;
///
/// let mut builder = OutlineBuilder::default();
/// builder.move_to(DVec2::new(-1.0, 0.0));
/// builder.line_to(DVec2::new(1.0, 0.0));
/// builder.quadratic_to(DVec2::new(0.0, 2.0), DVec2::new(-1.0, 0.0));
/// assert_eq!(builder.finish().unwrap().piece_count(), 2);
/// ```
#[derive(Clone, Debug, Default)]
pub struct OutlineBuilder {
    pieces: Vec<Piece<DVec2>>,
    /// The first piece of each contour.
    starts: Vec<usize>,
    first: Option<DVec2>,
    last: DVec2,
    gaps: usize,
}

impl OutlineBuilder {
    /// Begins a contour; the one before is closed by a line if it is not closed.
    pub fn move_to(&mut self, point: DVec2) {
        self.close();
        self.starts.push(self.pieces.len());
        self.first = Some(point);
        self.last = point;
    }

    /// A line to the point.
    pub fn line_to(&mut self, point: DVec2) {
        self.piece(Piece::Line([self.last, point]));
    }

    /// A parabola to the point.
    pub fn quadratic_to(&mut self, control: DVec2, point: DVec2) {
        self.piece(Piece::Quadratic([self.last, control, point]));
    }

    /// A cubic to the point.
    pub fn cubic_to(&mut self, control: DVec2, other: DVec2, point: DVec2) {
        self.piece(Piece::Cubic([self.last, control, other, point]));
    }

    /// Appends a piece, which begins at the end of the last one.
    pub(super) fn piece(&mut self, piece: Piece<DVec2>) {
        self.last = piece.end();
        let start = piece.start();
        // A piece that is a point has no direction.
        if piece.points().iter().any(|p| *p != start) {
            self.pieces.push(piece);
        }
    }

    /// Closes the contour, with a line if necessary.
    pub fn close(&mut self) {
        if let Some(first) = self.first.take()
            && first != self.last
        {
            self.gaps += 1;
            self.line_to(first);
        }
    }

    /// The outline; the last contour is closed.
    ///
    /// # Errors
    /// A coordinate is not finite, or there are only points.
    pub fn finish(mut self) -> Result<Outline, GeometryError> {
        self.close();
        let all = self.pieces.iter().flat_map(|piece| piece.points());
        if !all.clone().all(|p| p.is_finite()) {
            let what = "a point of the outline";
            return Err(GeometryError::NotFinite { what });
        }
        if self.pieces.is_empty() {
            return Err(GeometryError::Degenerate {
                what: "outline",
                why: "all its points are the same",
            });
        }
        let reach = all.fold(DVec2::ZERO, |reach, p| reach.max(p.abs()));
        let boxes: Vec<_> = self
            .pieces
            .iter()
            .map(|p| Rect::around(p.points()))
            .collect();
        let ends = self.pieces.iter().map(|piece| {
            [(piece.start(), 0.0), (piece.end(), 1.0)].map(|(p, s)| (p, direction(piece, s)))
        });
        let ends: Vec<[End; 2]> = ends.collect();
        Ok(Outline {
            smooth: smooth_runs(&ends, &self.starts),
            runs: Runs::build(&boxes, LEAF),
            points: ControlPoints::of(&self.pieces),
            pieces: self.pieces.into_boxed_slice(),
            reach,
            gaps: self.gaps,
        })
    }
}

/// A straight line in the plane of an outline: the points where `normal . (p - anchor) + offset` is zero.
pub(super) struct Cut {
    pub(super) normal: DVec2,
    pub(super) anchor: DVec2,
    pub(super) offset: f64,
}

/// A crossing of a line with an outline.
pub(super) struct OutlineCrossing {
    pub(super) piece: u32,
    pub(super) s: f64,
    pub(super) point: DVec2,
    /// Whether the curve passes to the side of the line's normal.
    pub(super) rising: bool,
}

impl Cut {
    /// The distance of a point from the line, times the length of the normal, with a sign.
    #[inline(always)]
    fn side(&self, p: DVec2) -> f64 {
        let aside = p - self.anchor;
        self.normal.x * aside.x + self.normal.y * aside.y + self.offset
    }
}

/// So many pieces are in a leaf of the boxes around them: their control points are looked at four at a time.
const LEAF: usize = 12;

/// A leaf has no more control points.
const POINTS: usize = 4 * LEAF;

/// The control points of pieces, coordinate by coordinate. Neighbours share the point in which they meet.
#[derive(Clone, Debug, PartialEq)]
struct ControlPoints {
    x: Box<[f64]>,
    y: Box<[f64]>,
    /// For each point the piece that goes on from there; a number that is none's for the last point of a contour.
    behind: Box<[u32]>,
    /// For each piece the places of its first and last point.
    places: Box<[[u32; 2]]>,
}

impl ControlPoints {
    fn of(pieces: &[Piece<DVec2>]) -> Self {
        let (mut points, mut behind, mut places) = (Vec::<DVec2>::new(), vec![], vec![]);
        for (piece, number) in pieces.iter().zip(0..) {
            let new = match points.last() == piece.points().first() {
                true => &piece.points()[1..],
                false => piece.points(),
            };
            points.extend(new);
            let last = points.len() - 1;
            behind.resize(last, u32::MAX);
            let first = last + 1 - piece.points().len();
            behind[first..].fill(number);
            places.push([first, last].map(|place| place as u32));
        }
        // Groups of four may reach beyond the last one.
        points.extend([DVec2::ZERO; 3]);
        behind.resize(points.len(), u32::MAX);
        Self {
            x: points.iter().map(|p| p.x).collect(),
            y: points.iter().map(|p| p.y).collect(),
            behind: behind.into(),
            places: places.into(),
        }
    }

    /// Stores on which sides of a line the points of these pieces are, at most [`LEAF`]. Returns the place of the first of them, and, as bits from
    /// there on, those whose neighbour behind is on the other side.
    #[inline]
    fn changes(
        &self,
        cut: &Cut,
        pieces: Range<usize>,
        sides: &mut [f64; POINTS],
    ) -> Option<(usize, u64)> {
        let [start, _] = *self.places.get(pieces.start)?;
        let [_, last] = *self.places.get(pieces.end.checked_sub(1)?)?;
        let (start, last) = (start as usize, last as usize);
        let end = start + (last + 1 - start).next_multiple_of(LANES);
        let (x, y) = (self.x.get(start..end)?, self.y.get(start..end)?);
        let above = dispatch!(Simd::best(), isa => find_sides(isa, cut, x, y, sides));
        let pairs = (1 << (last - start)) - 1;
        Some((start, (above ^ above >> 1) & pairs))
    }
}

/// Stores on which sides of a line points are, at most [`POINTS`]; those at or above 0 as bits.
#[inline(always)]
fn find_sides<I: Isa>(isa: I, cut: &Cut, x: &[f64], y: &[f64], sides: &mut [f64; POINTS]) -> u64 {
    let [nx, ny] = cut.normal.to_array().map(|n| isa.splat(n));
    let [ax, ay] = cut.anchor.to_array().map(|a| isa.splat(a));
    let (offset, zero) = (isa.splat(cut.offset), isa.splat(0.0));
    let mut above = 0;
    let fours = x
        .as_chunks::<LANES>()
        .0
        .iter()
        .zip(y.as_chunks::<LANES>().0);
    for (group, ((x, y), out)) in fours.zip(sides.as_chunks_mut::<LANES>().0).enumerate() {
        let (x, y) = (isa.sub(isa.load(x), ax), isa.sub(isa.load(y), ay));
        // In the order of [`Cut::side`].
        let side = isa.add(isa.add(isa.mul(nx, x), isa.mul(ny, y)), offset);
        *out = isa.store(side);
        above |= u64::from(isa.le(zero, side)) << (group * LANES);
    }
    above
}

impl Outline {
    /// How many lines, parabolas and cubics there are.
    pub fn piece_count(&self) -> usize {
        self.pieces.len()
    }

    /// The number of contours that were not closed, so that a line was added.
    pub fn gaps(&self) -> usize {
        self.gaps
    }

    /// The rectangle around the outline, as its lower left and upper right corner.
    pub fn bounds(&self) -> [DVec2; 2] {
        let Rect { min, max } = self.runs.bounds();
        [min, max]
    }

    /// The largest absolute coordinates.
    pub(super) fn reach(&self) -> DVec2 {
        self.reach
    }

    pub(super) fn piece(&self, index: u32) -> Option<&Piece<DVec2>> {
        self.pieces.get(index as usize)
    }

    /// The first piece of the smooth run that a piece belongs to.
    pub(super) fn smooth_run(&self, piece: u32) -> u32 {
        self.smooth.get(piece as usize).copied().unwrap_or(piece)
    }

    /// Visits the pieces of all leaves whose boxes pass a test, in their order and with the number of the first.
    #[inline(always)]
    pub(super) fn visit_leaves(
        &self,
        test: impl FnMut(&Rect) -> bool,
        mut visit: impl FnMut(usize, &[Piece<DVec2>]),
    ) {
        self.runs.visit_leaves(
            test,
            #[inline(always)]
            |leaf| {
                let first = leaf.start;
                visit(first, self.pieces.get(leaf).unwrap_or_default());
            },
        );
    }

    /// Visits all crossings with a line, piece by piece.
    ///
    /// The side of a joint is decided by the same operations for both pieces that meet there; so a line crosses a contour an even number of
    /// times despite rounding.
    #[inline(always)]
    pub(super) fn crossings(&self, cut: &Cut, mut visit: impl FnMut(&OutlineCrossing)) {
        // Differences, products, sums, and the roundings of normal and offset.
        let far = self.reach + cut.anchor.abs();
        let error = gamma(16) * (cut.normal.abs().dot(far) + cut.offset.abs());
        let width = cut.normal.abs() * 0.5;
        let near = |rect: &Rect| {
            let middle = (rect.min + rect.max) * 0.5;
            cut.side(middle).abs() <= width.dot(rect.max - rect.min) + error
        };
        let mut sides = [0.0; POINTS];
        self.runs.visit_leaves(near, |leaf| {
            let Some((start, mut changes)) = self.points.changes(cut, leaf, &mut sides) else {
                return;
            };
            while changes != 0 {
                let place = start + changes.trailing_zeros() as usize;
                let index = self.points.behind[place];
                let Some(piece) = self.pieces.get(index as usize) else {
                    changes &= changes - 1;
                    continue;
                };
                let [first, last] = self.points.places[index as usize].map(|p| p as usize - start);
                // Those of the piece are done with.
                changes &= !0 << last;
                let mut found = |s: f64, rising: bool| {
                    visit(&OutlineCrossing {
                        piece: index,
                        s,
                        point: piece.at(s),
                        rising,
                    });
                };
                match sides[first..=last] {
                    [a, b] => found(a / (a - b), b >= 0.0),
                    [a, b, c] => roots([a, b, c], error, &mut found),
                    [a, b, c, d] => roots([a, b, c, d], error, &mut found),
                    _ => {}
                }
            }
        });
    }

    /// Whether the point is inside; on the boundary either.
    pub(super) fn contains(&self, point: DVec2) -> bool {
        let cut = Cut {
            normal: DVec2::Y,
            anchor: point,
            offset: 0.0,
        };
        let mut inside = false;
        self.crossings(&cut, |crossing| inside ^= crossing.point.x > point.x);
        inside
    }
}

/// A polynomial in Bernstein form with a way to find the root of one that has opposite signs at 0 and 1, and no other root.
pub(super) trait SingleRoot {
    fn single_root(&self, rising: bool) -> f64;
}

impl SingleRoot for [f64; 3] {
    /// By the formula: `a + 2 h s + c s²`.
    fn single_root(&self, rising: bool) -> f64 {
        let [a, b, end] = *self;
        let (h, c) = (b - a, (a - b) + (end - b));
        let discriminant = h * h - a * c;
        let root = if discriminant > 0.0 {
            discriminant.sqrt()
        } else {
            0.0
        };
        // Half the slope at the root.
        let slope = if rising { root } else { -root };
        // Of the two ways to write it the one without cancellation.
        let s = if (h >= 0.0) == rising {
            -a / (h + slope)
        } else {
            (slope - h) / c
        };
        if s > 0.0 {
            if s < 1.0 { s } else { 1.0 }
        } else {
            0.0
        }
    }
}

impl SingleRoot for [f64; 4] {
    /// By Newton's method.
    fn single_root(&self, rising: bool) -> f64 {
        let [a, b, c, d] = *self;
        // As powers of the parameter.
        let (p, q, r) = (
            3.0 * (b - a),
            3.0 * ((c - b) - (b - a)),
            (d - a) - 3.0 * (c - b),
        );
        // Where the control polygon crosses zero.
        let steps = [[a, b], [b, c], [c, d]].into_iter().zip([0.0, 1.0, 2.0]);
        let crossing = steps.filter(|([from, to], _)| (*from < 0.0) != (*to < 0.0));
        let guess = crossing.fold(0.0, |_, ([from, to], k)| {
            (k + from / (from - to)) * (1.0 / 3.0)
        });
        newton(0.0, 1.0, rising, guess, |s| {
            let value = a + s * (p + s * (q + s * r));
            let slope = p + s * (2.0 * q + s * (3.0 * r));
            (value, value / slope)
        })
    }
}

/// The roots of a polynomial in Bernstein form where it changes its sign.
#[inline]
fn roots<const N: usize>(values: [f64; N], error: f64, found: &mut impl FnMut(f64, bool))
where
    [f64; N]: SingleRoot,
{
    let signs = values.map(|value| value >= 0.0);
    let changes = signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
    if changes == 1 && values.iter().all(|v| v.abs() > error) {
        let rising = values.first().is_some_and(|v| *v < 0.0);
        found(values.single_root(rising), rising);
        return;
    }
    if let [a, b, c] = values[..]
        && changes == 2
        && keep_apart([a, b, c].map(f64::abs), error)
    {
        return;
    }
    let polynomial = Bernstein::new(values, error, 0.0, 1.0);
    let _ = polynomial.isolate(&mut |part| {
        if part.count != RootCount::Even {
            found(part.root(), part.rising);
        }
        ControlFlow::Continue(())
    });
}

/// Whether a parabola has no root although its middle control point lies on the other side than both ends, given their distances and their error.
#[inline]
fn keep_apart([a, b, c]: [f64; 3], error: f64) -> bool {
    let (a, b, c) = (a - error, b + error, c - error);
    // With room for the roundings of the products.
    a > 0.0 && c > 0.0 && b * b < a * c * (1.0 - gamma(8))
}

/// Two pieces belong to one smooth run if the sine of the angle between them is less: 2⁻²⁰, some hundred times the error of a
/// smooth joint whose coordinates are given with eight digits.
const SMOOTH: f64 = 1.0 / 1_048_576.0;

/// An end of a piece: its position, and a vector along the curve.
pub(super) type End = (DVec2, DVec2);

/// For each piece, given by its two ends, the first piece of its smooth run. `starts` has the first piece of each contour; its
/// last run may continue in its first one.
pub(super) fn smooth_runs(pieces: &[[End; 2]], starts: &[usize]) -> Box<[u32]> {
    let mut run: Vec<u32> = (0..pieces.len() as u32).collect();
    let ends = starts.iter().skip(1).copied().chain([pieces.len()]);
    for (&start, end) in starts.iter().zip(ends) {
        let (Some(contour), Some(run)) = (pieces.get(start..end), run.get_mut(start..end)) else {
            continue;
        };
        for (i, pair) in contour.windows(2).enumerate() {
            if let [[_, into], [out, _]] = pair
                && joins_smoothly(*into, *out)
            {
                run[i + 1] = run[i];
            }
        }
        if let ([[out, _], .., [_, into]], [to, .., from]) = (contour, &mut *run)
            && joins_smoothly(*into, *out)
        {
            let (from, to) = (*from, *to);
            run.iter_mut().filter(|r| **r == from).for_each(|r| *r = to);
        }
    }
    run.into_boxed_slice()
}

fn joins_smoothly((end, into): End, (start, out): End) -> bool {
    let sine = into.perp_dot(out);
    end == start && into.dot(out) > 0.0 && sine.abs() <= SMOOTH * into.length() * out.length()
}

/// A vector along the curve at `s`: the derivative, or if that vanishes the direction to points beside it.
pub(super) fn direction(piece: &Piece<DVec2>, s: f64) -> DVec2 {
    let (start, end) = (piece.start(), piece.end());
    let size = piece
        .points()
        .iter()
        .fold(0.0, |m: f64, p| m.max((*p - start).length()));
    let tangent = piece.derivative(s);
    if tangent.length() > gamma(64) * size {
        return tangent;
    }
    let here = piece.at(s);
    // The part of the piece on the longer side of `s`.
    let aside = if s < 0.5 {
        piece.at(s + 1.0 / 1024.0) - here
    } else {
        here - piece.at(s - 1.0 / 1024.0)
    };
    if aside == DVec2::ZERO {
        end - start
    } else {
        aside
    }
}

/// The part of `range` where `origin + t direction` is between `low` and `high`; `None` if there is no such part.
pub(super) fn slab(origin: f64, direction: f64, low: f64, high: f64) -> Option<Interval> {
    if direction == 0.0 {
        return (low <= origin && origin <= high).then_some(Interval::LINE);
    }
    let (a, b) = ((low - origin) / direction, (high - origin) / direction);
    let (min, max) = if a < b { (a, b) } else { (b, a) };
    (min < max).then_some(Interval::new(min, max))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc_with_a_hole() -> Outline {
        let mut builder = OutlineBuilder::default();
        for radius in [1.0, 0.5] {
            // A circle of four cubics, as drawing programs make it.
            let k = 0.552_284_749_831 * radius;
            builder.move_to(DVec2::new(radius, 0.0));
            for quarter in 0..4 {
                let turn = |x: f64, y: f64| match quarter {
                    0 => DVec2::new(x, y),
                    1 => DVec2::new(-y, x),
                    2 => DVec2::new(-x, -y),
                    _ => DVec2::new(y, -x),
                };
                builder.cubic_to(turn(radius, k), turn(k, radius), turn(0.0, radius));
            }
        }
        builder.finish().unwrap()
    }

    #[test]
    fn holes_are_outside() {
        let outline = disc_with_a_hole();
        assert_eq!((outline.piece_count(), outline.gaps()), (8, 0));
        for (x, inside) in [
            (0.0, false),
            (0.49, false),
            (0.51, true),
            (0.99, true),
            (1.01, false),
        ] {
            for angle in 0..64 {
                let (sin, cos) = (f64::from(angle) * 0.1).sin_cos();
                assert_eq!(
                    outline.contains(DVec2::new(x * cos, x * sin)),
                    inside,
                    "{x} {angle}"
                );
            }
        }
    }

    #[test]
    fn smooth_joints_make_one_run() {
        let outline = disc_with_a_hole();
        assert_eq!(*outline.smooth, [0, 0, 0, 0, 4, 4, 4, 4]);
        let mut builder = OutlineBuilder::default();
        builder.move_to(DVec2::ZERO);
        builder.line_to(DVec2::X);
        builder.quadratic_to(DVec2::new(2.0, 0.0), DVec2::new(2.0, 1.0));
        builder.line_to(DVec2::new(2.0, 2.0));
        let outline = builder.finish().unwrap();
        assert_eq!((*outline.smooth).to_vec(), [0, 0, 0, 3]);
        assert_eq!(outline.gaps(), 1);
    }

    #[test]
    fn lines_cross_contours_an_even_number_of_times() {
        let outline = disc_with_a_hole();
        // Through joints, tangent to them, and anywhere.
        for i in 0..2000 {
            let (sin, cos) = (f64::from(i) * 0.01).sin_cos();
            for offset in [0.0, 0.5, 1.0, f64::from(i) * 1e-3] {
                let (mut count, mut balance) = (0, 0);
                let cut = Cut {
                    normal: DVec2::new(cos, sin),
                    anchor: DVec2::ZERO,
                    offset,
                };
                outline.crossings(&cut, |crossing| {
                    count += 1;
                    balance += if crossing.rising { 1 } else { -1 };
                });
                assert!(count % 2 == 0 && balance == 0 && count <= 4, "{i} {offset}");
            }
        }
    }

    #[test]
    fn nothing_but_a_point_is_refused() {
        let mut builder = OutlineBuilder::default();
        builder.move_to(DVec2::ONE);
        builder.line_to(DVec2::ONE);
        assert!(matches!(
            builder.finish(),
            Err(GeometryError::Degenerate { .. })
        ));
        let mut builder = OutlineBuilder::default();
        builder.move_to(DVec2::ONE);
        builder.line_to(DVec2::NAN);
        assert!(matches!(
            builder.finish(),
            Err(GeometryError::NotFinite { .. })
        ));
    }
}
