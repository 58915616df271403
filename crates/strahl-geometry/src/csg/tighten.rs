//! Tighter boxes around intersections of curved and flat parts.
//!
//! An infinite cylinder and two planes are unbounded, but their intersection is bounded. For every part that is a polynomial of
//! degree at most 2 (planes, spheres, quadrics, the sides of cylinders and cones), and for tori and blobs, one can test whether a box is certainly
//! outside of it; and for convex parts that are subtracted, whether it is certainly inside. Such boxes are cut off from each of the six sides by bisection: the bounds begin at the first box along an axis for
//! which no test succeeds (branch and bound; Ratschek and Rokne 1988).

#[cfg(test)]
mod tests;

use super::leaf::Leaf;
use crate::{Shape, Solid};
use strahl_math::{Aabb, DVec3, Transform};

/// A quadratic form of four variables: `pᵀ M p` with `p = (x, y, z, w)`. A point is inside of the part where the form is not
/// positive, with `w = 1`; points with `w = 0` are infinitely far away.
#[derive(Clone, Debug)]
pub(super) struct Form([[f64; 4]; 4]);

/// What an operand of an intersection leaves of space.
#[derive(Debug)]
pub(super) enum Region<'a> {
    /// What is inside of a form.
    Form(Form),
    /// What is inside of a leaf that knows on which side of it boxes are, or outside of it if it is subtracted.
    Sided(&'a Leaf, &'a dyn Solid),
    /// What is outside of a convex leaf.
    Outside(&'a Leaf, &'a dyn Solid),
}

/// A box in the four variables: centre and half widths.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    center: [f64; 4],
    half: [f64; 4],
}

/// Far above the rounding error of a form's value, relative to the sum of the magnitudes of its terms.
const SLACK: f64 = 1e-12;
/// The number of boxes tested for each side of the bounds, in each round.
const BUDGET: u32 = 64;
/// The largest number of rounds; the last one cuts off less than a fifth.
const ROUNDS: u32 = 6;
/// The number of boxes tested for each of six directions to infinity.
const FAR_BUDGET: u32 = 256;
/// The size of the smallest boxes, relative to the bounds found so far.
const FINE: f64 = 1.0 / 64.0;

/// How often boxes are halved around shapes that know on which side of them boxes are.
const LEVELS: u32 = 5;

impl<'a> Region<'a> {
    /// `None` where no box is known to be without it.
    pub(super) fn of(leaf: &'a Leaf) -> Option<Self> {
        let solid = leaf.solid()?;
        match leaf.shape {
            Shape::Torus(_) | Shape::Blob(_) => Some(Self::Sided(leaf, solid)),
            _ if leaf.negative => leaf.is_convex().then_some(Self::Outside(leaf, solid)),
            _ => Form::of(leaf).map(Self::Form),
        }
    }

    /// Whether nothing of it is in a cell.
    pub(super) fn excludes(&self, cell: &Cell) -> bool {
        match self {
            Self::Form(form) => form.excludes(cell),
            Self::Sided(leaf, solid) => cell.bounds().is_some_and(|bounds| {
                let local = leaf.bounds_to_object(&bounds);
                solid.side_of(&local) == Some(leaf.negative)
            }),
            Self::Outside(leaf, solid) => cell.bounds().is_some_and(|bounds| {
                let inside = |corner| solid.contains(leaf.point_to_object(corner));
                bounds.corners().into_iter().all(inside)
            }),
        }
    }

    /// Whether a point is in it, so that no cell around the point is [excluded](Self::excludes).
    fn contains(&self, point: &[f64; 4]) -> bool {
        match self {
            Self::Form(form) => form.contains(point),
            Self::Sided(leaf, _) | Self::Outside(leaf, _) => {
                let [x, y, z, w] = *point;
                w == 1.0 && leaf.contains(DVec3::new(x, y, z))
            }
        }
    }
}

impl Form {
    /// The form that contains a leaf's inside (or, if it is open, its surface); `None` for other shapes and for complements.
    pub(super) fn of(leaf: &Leaf) -> Option<Self> {
        if leaf.negative {
            return None;
        }
        let form = match &leaf.shape {
            Shape::Plane(plane) => Self::linear(plane.normal(), plane.normal().dot(plane.point())),
            Shape::Sphere(sphere) if !sphere.is_turned() => {
                let (c, r) = (sphere.center(), sphere.radius());
                Self::quadratic(
                    [1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
                    -c,
                    c.length_squared() - r * r,
                )
            }
            Shape::Quadric(quadric) => {
                let [a, b, c, d, e, f, g, h, i, j] = quadric.coefficients();
                Self::quadratic([a, b, c, d, e, f], DVec3::new(g, h, i) * 0.5, j)
            }
            Shape::Cylinder(cylinder) => {
                let r = cylinder.radius();
                Self::mantle(cylinder.base(), r, cylinder.apex(), r)
            }
            Shape::Cone(cone) => {
                let (r0, r1) = (cone.base_radius(), cone.apex_radius());
                Self::mantle(cone.base(), r0, cone.apex(), r1)
            }
            _ => return None,
        };
        let form = match leaf.map() {
            None => form,
            Some(map) => form.moved(map),
        };
        form.0
            .as_flattened()
            .iter()
            .all(|v| v.is_finite())
            .then_some(form)
    }

    /// `n·x - d`, times w.
    fn linear(n: DVec3, d: f64) -> Self {
        Self::quadratic([0.0; 6], n * 0.5, -d)
    }

    /// `A x² + B y² + C z² + D xy + E xz + F yz + 2 l·x w + k w²`.
    fn quadratic([a, b, c, d, e, f]: [f64; 6], l: DVec3, k: f64) -> Self {
        let (d, e, f) = (0.5 * d, 0.5 * e, 0.5 * f);
        Self([
            [a, d, e, l.x],
            [d, b, f, l.y],
            [e, f, c, l.z],
            [l.x, l.y, l.z, k],
        ])
    }

    /// The double cone or cylinder through two circles around an axis: `|x - p|² - ((x - p)·u)² - (r0 + s (x - p)·u)²` with the unit vector u
    /// of the axis.
    fn mantle(p: DVec3, r0: f64, q: DVec3, r1: f64) -> Self {
        let length = (q - p).length();
        let u = (q - p) / length;
        let slope = (r1 - r0) / length;
        let k = 1.0 + slope * slope;
        // About p: xᵀ (1 - k u uᵀ) x - 2 r0 s u·x - r0².
        let (d, e, f) = (
            -2.0 * k * u.x * u.y,
            -2.0 * k * u.x * u.z,
            -2.0 * k * u.y * u.z,
        );
        let [a, b, c] = [
            1.0 - k * u.x * u.x,
            1.0 - k * u.y * u.y,
            1.0 - k * u.z * u.z,
        ];
        let about_p = Self::quadratic([a, b, c, d, e, f], u * (-r0 * slope), -r0 * r0);
        about_p.substituted(&[
            [1.0, 0.0, 0.0, -p.x],
            [0.0, 1.0, 0.0, -p.y],
            [0.0, 0.0, 1.0, -p.z],
            [0.0, 0.0, 0.0, 1.0],
        ])
    }

    /// The form of a part after a transformation.
    fn moved(&self, map: &Transform) -> Self {
        let origin = map.point_to_object(DVec3::ZERO);
        let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| map.vector_to_object(axis));
        self.substituted(&[
            [x.x, y.x, z.x, origin.x],
            [x.y, y.y, z.y, origin.y],
            [x.z, y.z, z.z, origin.z],
            [0.0, 0.0, 0.0, 1.0],
        ])
    }

    /// `Bᵀ M B`.
    fn substituted(&self, b: &[[f64; 4]; 4]) -> Self {
        let product = |i: usize, j: usize| -> f64 {
            let terms = (0..16).map(|n| b[n / 4][i] * self.0[n / 4][n % 4] * b[n % 4][j]);
            terms.sum()
        };
        Self(std::array::from_fn(|i| {
            std::array::from_fn(|j| product(i, j))
        }))
    }

    /// This form minus another one, plus a constant.
    pub(super) fn minus(&self, other: &Self, constant: f64) -> Self {
        let mut result = self.clone();
        let all = result.0.as_flattened_mut().iter_mut();
        for (a, b) in all.zip(other.0.as_flattened()) {
            *a -= b;
        }
        result.0[3][3] += constant;
        result
    }

    /// Whether the form is positive in the whole cell.
    pub(super) fn excludes(&self, cell: &Cell) -> bool {
        self.excludes_by_terms(cell) || self.excludes_about_the_center(cell)
    }

    /// Tests term by term, which is exact for squares. Points infinitely far away don't count.
    fn excludes_by_terms(&self, cell: &Cell) -> bool {
        let range = |i: usize| (cell.center[i] - cell.half[i], cell.center[i] + cell.half[i]);
        let product = |(a, b): (f64, f64), (c, d): (f64, f64)| {
            let all = [a * c, a * d, b * c, b * d];
            all.into_iter()
                .fold(f64::INFINITY, |low, v| if v < low { v } else { low })
        };
        // The form is S + w L, with S of degree 2 and L of degree 1 in x, y, z.
        let (mut squares, mut linear, mut magnitude) = (0.0, 0.0, 0.0);
        for (i, row) in self.0.iter().take(3).enumerate() {
            let (low, high) = range(i);
            let scaled = |m: f64| {
                if m < 0.0 {
                    (m * high, m * low)
                } else {
                    (m * low, m * high)
                }
            };
            let (nearest, farthest) = match (low > 0.0, high < 0.0) {
                (true, _) => (low * low, high * high),
                (_, true) => (high * high, low * low),
                _ => (0.0, if -low > high { low * low } else { high * high }),
            };
            let square = row[i] * if row[i] < 0.0 { farthest } else { nearest };
            squares += square;
            magnitude += square.abs();
            for (j, m) in row.iter().enumerate().take(3).skip(i + 1) {
                if *m != 0.0 {
                    let term = product(scaled(2.0 * m), range(j));
                    squares += term;
                    magnitude += term.abs();
                }
            }
            linear += scaled(2.0 * row[3]).0;
        }
        let (near, far) = (range(3).0, range(3).1);
        let constant = self.0[3][3];
        linear += if constant < 0.0 {
            constant * far
        } else {
            constant * near
        };
        if near == 0.0 && squares >= 0.0 && squares == magnitude && linear > 0.0 {
            return true;
        }
        let rest = linear * if linear < 0.0 { far } else { near };
        squares + rest > SLACK * (magnitude + rest.abs() + constant.abs() * far * far)
    }

    /// Tests around the centre c: q(c) + 2 (M c)·d + dᵀ M d, with d within the half widths.
    fn excludes_about_the_center(&self, cell: &Cell) -> bool {
        let (mut value, mut reach, mut magnitude) = (0.0, 0.0, 0.0);
        for (i, row) in self.0.iter().enumerate() {
            let (ci, hi) = (cell.center[i], cell.half[i]);
            let (mut product, mut size) = (0.0, 0.0);
            for (j, m) in row.iter().enumerate() {
                let (cj, hj) = (cell.center[j], cell.half[j]);
                product += m * cj;
                size += m.abs() * (cj.abs() + hj);
                // A square is never negative.
                if i != j || *m < 0.0 {
                    reach += m.abs() * hi * hj;
                }
            }
            value += product * ci;
            reach += 2.0 * product.abs() * hi;
            magnitude += size * (ci.abs() + hi);
        }
        value - reach > SLACK * magnitude
    }

    /// Whether a point is inside, or so near that no cell around it is [excluded](Self::excludes).
    fn contains(&self, point: &[f64; 4]) -> bool {
        let (mut value, mut magnitude) = (0.0, 0.0);
        for (row, p) in self.0.iter().zip(point) {
            for (m, q) in row.iter().zip(point) {
                let term = m * p * q;
                value += term;
                magnitude += term.abs();
            }
        }
        value <= 0.5 * SLACK * magnitude
    }
}

impl Cell {
    pub(super) fn of(bounds: &Aabb) -> Self {
        let (c, h) = (
            (bounds.min + bounds.max) * 0.5,
            (bounds.max - bounds.min) * 0.5,
        );
        Self {
            center: [c.x, c.y, c.z, 1.0],
            half: [h.x, h.y, h.z, 0.0],
        }
    }

    /// The box, unless it is infinitely far away.
    fn bounds(&self) -> Option<Aabb> {
        let [x, y, z, w] = self.center;
        let ([a, b, c, d], middle) = (self.half, DVec3::new(x, y, z));
        let half = DVec3::new(a, b, c);
        (w == 1.0 && d == 0.0).then(|| Aabb::new(middle - half, middle + half))
    }

    /// The two halves along an axis.
    fn bisected(&self, axis: usize) -> [Self; 2] {
        let half = self.half[axis] * 0.5;
        [-half, half].map(|step| {
            let mut part = *self;
            part.half[axis] = half;
            part.center[axis] += step;
            part
        })
    }

    fn low(&self, axis: usize) -> f64 {
        self.center[axis] - self.half[axis]
    }

    /// What boxes are ordered by along an axis.
    fn order(&self, axis: usize) -> (f64, f64) {
        (self.low(axis), -self.half[axis])
    }
}

/// The part of a box that may contain what all regions have in common. It is never larger than the box.
pub(super) fn tightened(bounds: &Aabb, regions: &[Region<'_>]) -> Aabb {
    if regions.is_empty() || bounds.is_empty() {
        return *bounds;
    }
    let mut result = *bounds;
    if !result.is_bounded() {
        let Some(reach) = reach(&result, regions) else {
            return *bounds;
        };
        let all = DVec3::splat(reach);
        result = result.intersection(&Aabb::new(-all, all));
    }
    for _ in 0..ROUNDS {
        let before = result.half_area();
        result = cut(result, regions);
        if !(result.half_area() < 0.8 * before) {
            break;
        }
    }
    // Thin shells have too many boxes outside of them to be cut off one by one.
    if regions
        .iter()
        .any(|region| matches!(region, Region::Sided(..)))
    {
        let mut found = Aabb::EMPTY;
        collect(&result, LEVELS, regions, &mut found);
        if found.is_empty() {
            return found;
        }
        // A surface may lie in the side of a part that begins where another one, left out, ends.
        let slack = 1e-9 * (found.max_abs() + found.size().max_element());
        result = found.padded(DVec3::splat(slack)).intersection(&result);
    }
    result
}

/// Adds the parts of a box that may have something in all regions to another box, down to parts halved so often.
fn collect(part: &Aabb, levels: u32, regions: &[Region<'_>], found: &mut Aabb) {
    let cell = Cell::of(part);
    if found.union(part) == *found || regions.iter().any(|region| region.excludes(&cell)) {
        return;
    }
    match levels.checked_sub(1) {
        None => *found = found.union(part),
        Some(levels) => {
            for eighth in part.eighths() {
                collect(&eighth, levels, regions, found);
            }
        }
    }
}

/// Cuts off the parts outside, from each side.
fn cut(mut result: Aabb, regions: &[Region<'_>]) -> Aabb {
    for axis in 0..3 {
        let cell = Cell::of(&result);
        let Some(low) = first_possible(cell, axis, 1.0, regions) else {
            return Aabb::EMPTY;
        };
        let Some(high) = first_possible(cell, axis, -1.0, regions) else {
            return Aabb::EMPTY;
        };
        let slack = 1e-9 * (low.abs() + high.abs() + (high - low).abs());
        if low - slack > result.min[axis] {
            result.min[axis] = low - slack;
        }
        if high + slack < result.max[axis] {
            result.max[axis] = high + slack;
        }
    }
    result
}

/// Whether one of some places on the lower (`side` 1) or upper (-1) face of a cell is in all regions, so that nothing can be cut off there.
fn reaches_face(cell: &Cell, axis: usize, side: f64, regions: &[Region<'_>]) -> bool {
    let mut place = cell.center;
    place[axis] -= side * cell.half[axis];
    let [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
    (0..9).any(|number| {
        let mut place = place;
        place[a] += (f64::from(number % 3) - 1.0) * 0.75 * cell.half[a];
        place[b] += (f64::from(number / 3) - 1.0) * 0.75 * cell.half[b];
        regions.iter().all(|region| region.contains(&place))
    })
}

/// The coordinate along an axis, seen from below (`side` 1) or above (-1), at which the first box begins that may contain a
/// point; `None` if there is no such box.
fn first_possible(mut cell: Cell, axis: usize, side: f64, regions: &[Region<'_>]) -> Option<f64> {
    if reaches_face(&cell, axis, side, regions) {
        return Some(cell.center[axis] - side * cell.half[axis]);
    }
    // Seen from above everything is mirrored.
    cell.center[axis] *= side;
    let whole = cell.half;
    // The box that begins first is the last one; of several, the largest.
    let mut waiting = vec![cell];
    let mut budget = BUDGET;
    while let Some(cell) = waiting.pop() {
        let mut there = cell;
        there.center[axis] *= side;
        if regions.iter().any(|region| region.excludes(&there)) {
            continue;
        }
        // All boxes around a point that is in all regions stay, so no box begins later than here.
        let mut first = there.center;
        first[axis] = side * cell.low(axis);
        if regions.iter().all(|region| region.contains(&first)) {
            return Some(first[axis]);
        }
        // Across the axis boxes may be coarse: only the distance along the axis matters.
        let widest = (0..3)
            .map(|i| {
                let share = if whole[i] > 0.0 {
                    cell.half[i] / whole[i]
                } else {
                    0.0
                };
                (i, if i == axis { share } else { share * 0.999 })
            })
            .fold(
                (axis, 0.0),
                |best, next| if next.1 > best.1 { next } else { best },
            );
        if budget == 0 || widest.1 <= FINE {
            return Some(side * cell.low(axis));
        }
        budget -= 1;
        for part in cell.bisected(widest.0) {
            let comes_later = |other: &Cell| other.order(axis) > part.order(axis);
            let place = waiting.partition_point(comes_later);
            waiting.insert(place, part);
        }
    }
    None
}

/// Half the side of a cube around the origin outside of which no point is inside of all forms and of the box, if that can be
/// proven.
fn reach(bounds: &Aabb, regions: &[Region<'_>]) -> Option<f64> {
    let form = |region: &Region<'_>| match region {
        Region::Form(form) => Some(form.clone()),
        Region::Sided(..) | Region::Outside(..) => None,
    };
    let mut all: Vec<Form> = regions.iter().filter_map(form).collect();
    let finite = |v: f64| if v.is_finite() { v.abs() } else { 0.0 };
    let corners = bounds
        .min
        .to_array()
        .into_iter()
        .chain(bounds.max.to_array());
    let mut size = corners
        .map(finite)
        .fold(0.0, |a: f64, b| if b > a { b } else { a });
    for Form(m) in &all {
        let square = (0..9).map(|n| m[n / 3][n % 3].abs()).sum::<f64>();
        let linear = (0..3).map(|i| m[i][3].abs()).sum::<f64>();
        // Where the terms of different degrees balance.
        let balance = if square > linear * 1e-6 {
            linear / square + (m[3][3].abs() / square).sqrt()
        } else {
            m[3][3].abs() / linear
        };
        if balance.is_finite() && balance > size {
            size = balance;
        }
    }
    // The finite sides of the box are planes, too.
    for axis in 0..3 {
        let normal = DVec3::AXES[axis];
        for (side, at) in [(-1.0, bounds.min[axis]), (1.0, bounds.max[axis])] {
            if at.is_finite() {
                all.push(Form::linear(normal * side, at * side));
            }
        }
    }
    [4.0, 64.0, 1024.0]
        .into_iter()
        .map(|factor| size * factor)
        .find(|&reach| {
            reach > 0.0
                && (0..6).all(|face| {
                    nothing_beyond(face / 2, 1.0 - 2.0 * f64::from(face as u8 % 2), reach, &all)
                })
        })
}

/// Whether no point is inside of all forms whose coordinate along an axis, seen from a side, exceeds `reach` and the two other
/// coordinates: such points are `(±1, v, u) / w` with v and u in `-1..=1` and w in `0..1/reach`.
fn nothing_beyond(axis: usize, side: f64, reach: f64, forms: &[Form]) -> bool {
    let mut cell = Cell {
        center: [0.0; 4],
        half: [1.0; 4],
    };
    (cell.center[axis], cell.half[axis]) = (side, 0.0);
    (cell.center[3], cell.half[3]) = (0.5 / reach, 0.5 / reach);
    let whole = cell.half;
    let mut waiting = vec![cell];
    let mut budget = FAR_BUDGET;
    while let Some(cell) = waiting.pop() {
        if forms.iter().any(|form| form.excludes(&cell)) {
            continue;
        }
        if budget == 0 {
            return false;
        }
        budget -= 1;
        let share = |i: usize| {
            if whole[i] > 0.0 {
                cell.half[i] / whole[i]
            } else {
                0.0
            }
        };
        // The distance matters less than the direction.
        let share = |i: usize| if i == 3 { 0.25 * share(i) } else { share(i) };
        let widest = (0..4).fold(3, |best, i| if share(i) > share(best) { i } else { best });
        waiting.extend(cell.bisected(widest));
    }
    true
}
