//! Trimming: which part of a surface is there, by loops of curves in the plane of its parameters.

use super::spline::{GAP, HIGHEST, Knots, Names, even};
use super::{check_points, check_weights};
use crate::GeometryError;
use strahl_accel::{Accelerator, Bvh2, TraversalStats, Visitor};
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray};

/// A curve in the plane of a surface's parameters: a NURBS curve, of which a line of corners is the simplest.
#[derive(Clone, Debug, PartialEq)]
pub struct NurbsCurve {
    /// From 1 to 9.
    pub degree: u32,
    /// Ascending; as many as control points, and `degree + 1`.
    pub knots: Vec<f64>,
    /// The control points `(u, v)`, in the units of the surface's knots.
    pub points: Vec<DVec2>,
    /// The weights of the control points, greater than 0; none if all are 1.
    pub weights: Vec<f64>,
}

impl NurbsCurve {
    /// A curve of this degree through its first and its last control point, with evenly spaced knots.
    pub fn new(degree: u32, points: Vec<DVec2>) -> Self {
        Self {
            degree,
            knots: even(degree as usize, points.len()),
            points,
            weights: vec![],
        }
    }

    /// The curve from one of its parameters to a larger one.
    ///
    /// # Errors
    /// The curve is not as its fields say, or a parameter is not one of it.
    pub fn between(&self, range: [f64; 2]) -> Result<Self, GeometryError> {
        let (knots, weighted) = self.weighted(|p| p)?;
        if knots.domain() == range {
            return Ok(self.clone());
        }
        let (knots, part) = knots.between(range, &weighted, "parameter of the trimming curve")?;
        let is_rational = !self.weights.is_empty();
        Ok(Self {
            degree: self.degree,
            knots,
            points: part
                .iter()
                .map(|[x, y, w]| DVec2::new(x / w, y / w))
                .collect(),
            weights: part.iter().filter(|_| is_rational).map(|p| p[2]).collect(),
        })
    }

    /// The checked knots, and the control points times their weights, and the weights.
    fn weighted(
        &self,
        inner: impl Fn(DVec2) -> DVec2,
    ) -> Result<(Knots, Vec<Weighted>), GeometryError> {
        let count = self.points.len();
        let knots = Knots::try_new(self.degree, &self.knots, count, &NAMES)?;
        check_points(
            self.points.iter().map(|p| p.extend(0.0)),
            "control point of the trimming curve",
        )?;
        check_weights(
            &self.weights,
            count,
            "weight of the trimming curve",
            "weights of the trimming curve",
        )?;
        let weights = self.weights.iter().copied().chain(std::iter::repeat(1.0));
        let weighted = self.points.iter().zip(weights).map(|(p, w)| {
            let p = inner(*p);
            [p.x * w, p.y * w, w]
        });
        Ok((knots, weighted.collect()))
    }

    /// Straight lines from point to point.
    pub fn polyline(points: Vec<DVec2>) -> Self {
        Self::new(1, points)
    }
}

/// A closed loop of curves, each of which begins where the one before it ends.
#[derive(Clone, Debug, PartialEq)]
pub struct TrimLoop {
    /// The curves.
    pub curves: Vec<NurbsCurve>,
    /// Whether what is within is cut out, so that the whole surface is there outside if there are only such loops. Apart from
    /// that both kinds of loops mean the same: the surface is there where an odd number of loops is around.
    pub is_hole: bool,
}

impl TrimLoop {
    /// A loop of straight lines, the last of which leads back to the first point.
    pub fn polygon(mut points: Vec<DVec2>, is_hole: bool) -> Self {
        if points.first() != points.last() {
            points.extend(points.first().copied());
        }
        Self {
            curves: vec![NurbsCurve::polyline(points)],
            is_hole,
        }
    }
}

const NAMES: Names = Names {
    degree: "degree of the trimming curve",
    knot: "knot of the trimming curve",
    knots: "knots of the trimming curve",
    points: "control points of the trimming curve",
};
/// Curves are halved so often before rays come.
const HALVINGS: u32 = 3;
/// Curves are halved so often at most; then they are shorter than the distance between neighbouring numbers.
const DEPTH: u32 = 64;
/// The pieces of all curves at most.
const MOST_ARCS: usize = 1 << 22;

/// A point of an arc: two coordinates and a weight.
pub(super) type Weighted = [f64; 3];

/// The part of the unit square that loops cut out. Its curves are in units of the surface: parameters from 0 to 1.
#[derive(Debug)]
pub(super) struct Region {
    /// The control points of all arcs, which are Bezier curves.
    points: Vec<Weighted>,
    /// The number of the first control point of each arc; at the end their count.
    arcs: Vec<u32>,
    tree: Bvh2,
    /// Whether the border of the square counts as a loop.
    is_all: bool,
}

/// What is made of the loops before there is a tree.
struct Builder {
    domain: [[f64; 2]; 2],
    points: Vec<Weighted>,
    arcs: Vec<u32>,
}

impl Region {
    /// The region of a surface with parameters of these ranges.
    pub(super) fn try_new(
        loops: &[TrimLoop],
        domain: [[f64; 2]; 2],
    ) -> Result<Self, GeometryError> {
        let mut builder = Builder {
            domain,
            points: vec![],
            arcs: vec![0],
        };
        for (number, one) in loops.iter().enumerate() {
            builder.add(number, one)?;
        }
        let Builder { points, arcs, .. } = builder;
        let mut region = Self {
            points,
            arcs,
            tree: Bvh2::build(&[]),
            is_all: loops.iter().all(|l| l.is_hole),
        };
        let boxes: Vec<_> = region.boxes().collect();
        // Rays run along the first axis with a third coordinate of 0.
        let thick = |[low, high]: &[DVec2; 2]| Aabb::new(low.extend(-1.0), high.extend(1.0));
        region.tree = Bvh2::build(&boxes.iter().map(thick).collect::<Vec<_>>());
        Ok(region)
    }

    fn arc(&self, number: usize) -> &[Weighted] {
        let end = |k: usize| self.arcs.get(k).map_or(0, |k| *k as usize);
        self.points.get(end(number)..end(number + 1)).unwrap_or(&[])
    }

    /// All arcs: control points, which are places and weights.
    pub(super) fn arcs(&self) -> impl Iterator<Item = &[Weighted]> {
        (0..self.arcs.len() - 1).map(|k| self.arc(k))
    }

    /// The boxes of all arcs.
    pub(super) fn boxes(&self) -> impl Iterator<Item = [DVec2; 2]> {
        (0..self.arcs.len() - 1).map(|k| {
            let points = self.arc(k).iter().map(|p| DVec2::new(p[0], p[1]));
            points.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], p| {
                [low.min(p), high.max(p)]
            })
        })
    }

    /// Whether a point is within an odd number of loops.
    ///
    /// The half line from it along the first axis is crossed an odd number of times by these. All decisions are comparisons
    /// of coordinates, and curves share their ends, so no crossing is counted twice or never.
    pub(super) fn contains(&self, point: [f64; 2]) -> bool {
        let mut count = Count {
            region: self,
            point,
            crossings: 0,
        };
        let ray = Ray::new(DVec3::new(point[0], point[1], 0.0), DVec3::X);
        self.tree.traverse(
            &ray,
            Interval::FORWARD,
            &mut count,
            &mut TraversalStats::default(),
        );
        (count.crossings % 2 != 0) != self.is_all
    }
}

impl Builder {
    fn add(&mut self, number: usize, one: &TrimLoop) -> Result<(), GeometryError> {
        let [[u0, u1], [v0, v1]] = self.domain;
        let inner = |p: DVec2| DVec2::new((p.x - u0) / (u1 - u0), (p.y - v0) / (v1 - v0));
        let mut ends: Option<[DVec2; 2]> = None;
        for (place, curve) in one.curves.iter().enumerate() {
            let arcs = bezier(curve, inner)?;
            let Some((first, last)) = arcs.first().zip(arcs.last()) else {
                continue;
            };
            let (first, last) = (end(first.first()), end(last.last()));
            if let Some([_, before]) = ends {
                self.join(before, first, || {
                    format!("curve {place} of trim loop {number} (counted from 0) does not begin where the one before ends")
                })?;
            }
            ends = Some([ends.map_or(first, |[start, _]| start), last]);
            for arc in &arcs {
                self.push(arc)?;
            }
        }
        let Some([first, last]) = ends else {
            return Err(GeometryError::Degenerate {
                what: "trim loop",
                why: "it has no curves",
            });
        };
        self.join(last, first, || {
            format!("trim loop {number} (counted from 0) does not end where it begins")
        })
    }

    fn push(&mut self, arc: &[Weighted]) -> Result<(), GeometryError> {
        if self.arcs.len() > MOST_ARCS {
            return Err(GeometryError::OutOfRange {
                what: "number of pieces of the trimming curves",
                expected: "at most 4194304",
                found: self.arcs.len() as f64,
            });
        }
        self.points.extend_from_slice(arc);
        self.arcs.push(self.points.len() as u32);
        Ok(())
    }

    /// A line over the gap between two ends, which must be short.
    fn join(
        &mut self,
        from: DVec2,
        to: DVec2,
        why: impl FnOnce() -> String,
    ) -> Result<(), GeometryError> {
        if from == to {
            return Ok(());
        }
        if (to - from).abs().max_element() > GAP {
            return Err(GeometryError::NotClosed {
                what: "the NURBS surface's trimming",
                why: why(),
            });
        }
        self.push(&[[from.x, from.y, 1.0], [to.x, to.y, 1.0]])
    }
}

/// The place of the first or the last point of an arc.
fn end(point: Option<&Weighted>) -> DVec2 {
    point.map_or(DVec2::ZERO, |[x, y, _]| DVec2::new(*x, *y))
}

/// A curve as short Bezier curves.
fn bezier(
    curve: &NurbsCurve,
    inner: impl Fn(DVec2) -> DVec2,
) -> Result<Vec<Vec<Weighted>>, GeometryError> {
    let (knots, weighted) = curve.weighted(inner)?;
    let degree = knots.degree;
    let mut arcs: Vec<Vec<Weighted>> = vec![];
    let all = knots.bezier(&weighted);
    for piece in 0..(all.len() - 1) / degree {
        arcs.push(all[piece * degree..=(piece + 1) * degree].to_vec());
    }
    if degree > 1 {
        for _ in 0..HALVINGS {
            arcs = arcs.iter().flat_map(|arc| split(arc)).collect();
        }
    }
    for [x, y, w] in arcs.iter_mut().flatten() {
        *x /= *w;
        *y /= *w;
    }
    Ok(arcs)
}

/// Both halves of a curve of points times their weights, and the weights.
pub(super) fn split(arc: &[Weighted]) -> [Vec<Weighted>; 2] {
    let mut row = arc.to_vec();
    let (mut left, mut right) = (arc.to_vec(), arc.to_vec());
    let count = arc.len();
    for step in 1..count {
        for i in 0..count - step {
            row[i] = std::array::from_fn(|k| 0.5 * (row[i][k] + row[i + 1][k]));
        }
        left[step] = row[0];
        right[count - 1 - step] = row[count - 1 - step];
    }
    [left, right]
}

/// Counts the crossings of the half line from a point along the first axis.
struct Count<'a> {
    region: &'a Region,
    point: [f64; 2],
    crossings: i32,
}

impl Visitor for Count<'_> {
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        let mut curve = [[0.0; 2]; HIGHEST + 1];
        let arc = self.region.arc(id as usize);
        // Signs are those of the differences of coordinates, whatever the weight.
        for (place, [x, y, w]) in curve.iter_mut().zip(arc) {
            *place = [(x - self.point[0]) * w, (y - self.point[1]) * w];
        }
        if let Some(curve) = curve.get(..arc.len()) {
            self.crossings += crossings(curve, DEPTH);
        }
        t_max
    }
}

/// How often a curve crosses the positive first axis upwards, less how often it does so downwards.
fn crossings(curve: &[[f64; 2]], depth: u32) -> i32 {
    let is_above = |p: &[f64; 2]| p[1] >= 0.0;
    let above = curve.iter().filter(|p| is_above(p)).count();
    let right = curve.iter().filter(|p| p[0] > 0.0).count();
    let Some((from, to)) = curve.first().zip(curve.last()) else {
        return 0;
    };
    if above == 0 || above == curve.len() || right == 0 {
        return 0;
    }
    let change = i32::from(is_above(to)) - i32::from(is_above(from));
    if right == curve.len() {
        return change;
    }
    if depth > 0 && curve.len() > 2 {
        let count = curve.len();
        let mut row = [[0.0; 2]; HIGHEST + 1];
        row[..count].copy_from_slice(curve);
        let (mut left, mut right) = (row, row);
        for step in 1..count {
            for i in 0..count - step {
                row[i] = [0, 1].map(|k| 0.5 * (row[i][k] + row[i + 1][k]));
            }
            left[step] = row[0];
            right[count - 1 - step] = row[count - 1 - step];
        }
        return crossings(&left[..count], depth - 1) + crossings(&right[..count], depth - 1);
    }
    // The sign of the place at which the chord crosses the axis.
    let place = from[0] * to[1] - to[0] * from[1];
    if (place > 0.0) == (to[1] > from[1]) && place != 0.0 {
        change
    } else {
        0
    }
}
