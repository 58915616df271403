use super::event::{self, Event, Question};
use super::extent::extent;
use super::line::{Line, Root};
use super::terms::{Dual, Terms, Univariate};
use crate::primitives::point_error;
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Solid, SurfaceId, SurfacePoint,
};
use std::ops::ControlFlow;
use strahl_math::error::gamma;
use strahl_math::roots::Window;
use strahl_math::{Aabb, DVec3, Interval, Ray};

/// An algebraic surface: where a polynomial in x, y and z of degree 1 to 35 vanishes; inside is where it is not positive.
///
/// POV-Ray's `cubic`, `quartic`, `poly` and `polynomial`. Changing all signs turns the inside out. A surface that is closed because the
/// terms of the highest degree have one sign everywhere, as those of a torus, or because the powers of single coordinates outweigh the others far away,
/// has a box around it; any other is unbounded as far as its box goes, whatever its shape: put it into an intersection or clip it. It
/// has no texture coordinates (`uv` and its
/// derivatives are zero). Facets: one, 0. A ray that touches the surface without passing through does not hit it.
///
/// The polynomial is restricted to the ray, about the point of the ray that is nearest to the origin, and its roots are isolated on
/// the whole line by sign variations in Bernstein form, so there are no tolerances and no roots are missed but pairs that
/// rounding can't tell from none. Describe a surface about the origin of its space and move it: coefficients that describe a
/// small shape far away have lost its digits already. Not robust to the last digits where sheets of the surface
/// cross or touch each other (there the gradient vanishes), and for degrees above 12 far from the origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial {
    /// The terms in coordinates of the unit `length`, divided by a power of two.
    terms: Terms,
    /// The sum of the magnitudes of the coefficients of each degree.
    sums: Vec<f64>,
    /// The length, a power of two, above which the terms of the highest degree outweigh the others.
    length: f64,
    /// Its reciprocal, also a power of two.
    per_length: f64,
    /// The relative error of a value.
    rounding: f64,
    /// The box around the surface, if it is known to be closed.
    extent: Option<Box<Aabb>>,
}

/// The ray in the polynomial's own units: the point at `s` is `start + s along`, its parameter `t + s t_per_s`.
struct Segment {
    start: DVec3,
    along: DVec3,
    t: f64,
    t_per_s: f64,
}

/// Up to this degree the roots of the polynomial along the ray are as exact as its terms.
const ACCURATE_DEGREE: u32 = 6;

/// The highest degree, POV-Ray's.
const MAX_DEGREE: u32 = 35;

impl Polynomial {
    /// The polynomial of some terms: the powers of x, y and z, and a coefficient. Terms of equal powers are added up.
    pub fn new(terms: impl IntoIterator<Item = ([u32; 3], f64)>) -> Self {
        let plain = Terms::new(terms);
        let degree = plain.degree();
        let mut sums = vec![0.0; degree.min(MAX_DEGREE) as usize + 1];
        for ([x, y, z], c) in plain.iter() {
            if let Some(sum) = sums.get_mut((x + y + z) as usize) {
                *sum += f64::abs(c);
            }
        }
        // From this length on the leading terms outweigh each of the others (after Fujiwara's bound of roots).
        let leading = sums.last().copied().unwrap_or(1.0);
        let mut length = 0.0;
        for (below, sum) in (1..=degree).zip(sums.iter().rev().skip(1)) {
            let reach = strahl_math::det::pow(sum / leading, 1.0 / f64::from(below));
            if reach > length {
                length = reach;
            }
        }
        let (length, leading) = (power_of_two(length * 1.5), power_of_two(leading));
        let scale = |m: u32| (0..degree.saturating_sub(m)).fold(1.0 / leading, |s, _| s / length);
        let scaled = plain
            .iter()
            .map(|(powers @ [x, y, z], c)| (powers, c * scale(x + y + z)));
        let terms = Terms::new(scaled);
        for (m, sum) in sums.iter_mut().enumerate() {
            *sum *= scale(m as u32);
        }
        let reach = |scaled: Aabb| {
            let bounds = Aabb::new(scaled.min * length, scaled.max * length);
            Box::new(bounds.padded(DVec3::splat(gamma(16) * bounds.max_abs())))
        };
        Self {
            extent: extent(&terms, &sums).map(reach),
            rounding: gamma(4 * terms.degree().min(MAX_DEGREE) + 8),
            terms,
            sums,
            length,
            per_length: 1.0 / length,
        }
    }

    /// Like [`Polynomial::new`], checked.
    ///
    /// # Errors
    /// A coefficient is not finite, the polynomial is constant, or its degree is above 35.
    pub fn try_new(
        terms: impl IntoIterator<Item = ([u32; 3], f64)>,
    ) -> Result<Self, GeometryError> {
        let polynomial = Self::new(terms);
        polynomial.validate().map(|()| polynomial)
    }

    /// The polynomial of a list of all coefficients up to a degree, in the order of POV-Ray's `poly`: by falling powers of
    /// x, then of y, then of z (`x²  xy  xz  x  y²  yz  y  z²  z  1`).
    ///
    /// # Errors
    /// Those of [`Polynomial::try_new`], or the list is longer or shorter than [`Polynomial::coefficient_count`].
    pub fn try_from_list(degree: u32, coefficients: &[f64]) -> Result<Self, GeometryError> {
        check_degree(degree)?;
        let expected = Self::coefficient_count(degree);
        if coefficients.len() != expected {
            return Err(GeometryError::WrongCount {
                what: "coefficients of the polynomial",
                expected: expected as u64,
                found: coefficients.len() as u64,
            });
        }
        let powers = (0..=degree).rev().flat_map(move |x| {
            let rest = degree - x;
            (0..=rest)
                .rev()
                .flat_map(move |y| (0..=rest - y).rev().map(move |z| [x, y, z]))
        });
        Self::try_new(powers.zip(coefficients.iter().copied()))
    }

    /// How many coefficients a polynomial of a degree up to 35 in x, y and z has: `(n + 1)(n + 2)(n + 3) / 6`.
    pub const fn coefficient_count(degree: u32) -> usize {
        let n = degree as usize;
        (n + 1) * (n + 2) * (n + 3) / 6
    }

    /// The total degree.
    pub fn degree(&self) -> u32 {
        self.terms.degree()
    }

    /// A multiple of the polynomial's value at a point: negative inside, positive outside.
    pub fn value(&self, point: DVec3) -> f64 {
        let p = point * self.per_length;
        self.terms.evaluate(p.x, p.y, p.z)
    }

    /// The distance of a point from the surface, in first order.
    pub(crate) fn distance(&self, point: DVec3) -> f64 {
        let Dual { value, gradient } = self.dual(point * self.per_length);
        let steepness = gradient.length();
        if steepness > 0.0 {
            value.abs() / steepness * self.length
        } else {
            f64::INFINITY
        }
    }

    fn dual(&self, p: DVec3) -> Dual {
        self.terms
            .evaluate((p.x, DVec3::X), (p.y, DVec3::Y), (p.z, DVec3::Z))
    }

    /// A bound on the rounding error of the value where no coordinate (in the polynomial's units) is larger than `reach`.
    fn value_error(&self, reach: f64) -> f64 {
        let magnitude = self.sums.iter().rev().fold(0.0, |m, sum| m * reach + sum);
        self.rounding * magnitude
    }

    /// The ray relative to its point nearest to the origin, where the terms are smallest; for a ray that starts on the surface
    /// relative to its start, where the known root is.
    fn segment(&self, ray: &Ray, on_surface: bool) -> Option<Segment> {
        let (o, d) = (
            ray.origin * self.per_length,
            ray.direction * self.per_length,
        );
        let square = d.length_squared();
        let t = if on_surface { 0.0 } else { -o.dot(d) / square };
        let start = o + d * t;
        let t_per_s = (start.length() + 1.0) / square.sqrt();
        let along = d * t_per_s;
        // Also refuses NaN, infinite and zero directions.
        (start.is_finite() && along.is_finite() && t_per_s > 0.0).then_some(Segment {
            start,
            along,
            t,
            t_per_s,
        })
    }

    fn restricted<const N: usize>(&self, segment: &Segment) -> Line<N> {
        let (p, e) = (segment.start, segment.along);
        let along: Univariate<N> = self.terms.evaluate((p.x, e.x), (p.y, e.y), (p.z, e.z));
        let (far, pace) = (p.abs().max_element(), e.abs().max_element());
        Line::new(along.coefficients, self.value_error(far + pace), |k| {
            // The k-th coefficient of the sum of `sums[m] (far + pace s)^m`.
            let (mut total, mut term) = (0.0, (0..k).fold(1.0, |power, _| power * pace));
            for (i, sum) in self.sums.iter().skip(k).enumerate() {
                total += sum * term;
                term *= far * (k + i + 1) as f64 / (i + 1) as f64;
            }
            self.rounding * total
        })
    }

    /// A root, refined with the terms themselves where powers of the length have cost digits of the polynomial along the ray.
    fn polished<const N: usize>(&self, segment: &Segment, line: &Line<N>, root: &Root) -> f64 {
        if self.degree() <= ACCURATE_DEGREE {
            return root.s;
        }
        let Dual { value, gradient } = self.dual(segment.start + segment.along * root.s);
        let step = value / gradient.dot(segment.along);
        let s = root.s - step;
        let (low, high) = root.stretch;
        // A longer step would be a step to another root.
        if step.abs() <= line.root_error(root.s) && low < s && s < high {
            s
        } else {
            root.s
        }
    }

    /// A stretch of the ray, between the ends of `s` -1 and 1; for a ray that starts on the surface from its start on.
    fn segment_within(&self, ray: &Ray, stretch: Interval, on_surface: bool) -> Option<Segment> {
        // A bit longer, so that roots at the ends are not beyond them.
        const LONGER: f64 = 1.0 + 1e-9;
        let (o, d) = (
            ray.origin * self.per_length,
            ray.direction * self.per_length,
        );
        let (t, reach) = if on_surface {
            (0.0, stretch.max)
        } else {
            let half = 0.5 * (stretch.max - stretch.min);
            (stretch.min + half, half)
        };
        let t_per_s = reach * LONGER;
        let (start, along) = (o + d * t, d * t_per_s);
        (start.is_finite() && along.is_finite() && t_per_s > 0.0).then_some(Segment {
            start,
            along,
            t,
            t_per_s,
        })
    }

    /// Reports the crossings along the ray to the visitor, until it stops.
    fn walk(
        &self,
        ray: &Ray,
        question: &Question,
        visit: &mut dyn FnMut(Event) -> ControlFlow<()>,
    ) {
        if let Some(segment) = self.segment(ray, question.on_surface) {
            self.walk_segment(&segment, question, visit);
        }
    }

    /// The same for a stretch of the ray: no coordinate of its points is much larger than the length of the stretch. Crossings before and
    /// behind it may be left out, and those within have the same bits whatever the question's range is.
    pub(crate) fn walk_within(
        &self,
        ray: &Ray,
        stretch: Interval,
        question: &Question,
        visit: &mut dyn FnMut(Event) -> ControlFlow<()>,
    ) {
        if let Some(segment) = self.segment_within(ray, stretch, question.on_surface) {
            self.walk_segment(&segment, question, visit);
        }
    }

    fn walk_segment(
        &self,
        segment: &Segment,
        question: &Question,
        visit: &mut dyn FnMut(Event) -> ControlFlow<()>,
    ) {
        // The result only matters while visiting.
        let _ = match self.degree() {
            0..=3 => self.walk_line::<4>(segment, question, visit),
            4 => self.walk_line::<5>(segment, question, visit),
            5..=6 => self.walk_line::<7>(segment, question, visit),
            7..=12 => self.walk_line::<13>(segment, question, visit),
            13..=24 => self.walk_line::<25>(segment, question, visit),
            _ => self.walk_line::<36>(segment, question, visit),
        };
    }

    fn walk_line<const N: usize>(
        &self,
        segment: &Segment,
        question: &Question,
        visit: &mut dyn FnMut(Event) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut line = self.restricted::<N>(segment);
        let mut start = question.range.min;
        if question.on_surface {
            line = line.without_root_at_zero();
            if start < 0.0 {
                start = 0.0;
            }
        }
        if start.is_nan() {
            return ControlFlow::Continue(());
        }
        let s_per_t = 1.0 / segment.t_per_s;
        let place = |t: f64, outwards: f64| {
            let s = (t - segment.t) * s_per_t;
            let slack = 8.0 * f64::EPSILON * (t.abs() + segment.t.abs()) * s_per_t;
            if slack.is_finite() {
                s + outwards * slack
            } else {
                s
            }
        };
        let mut window = Window {
            from: place(start, -1.0),
            to: place(question.range.max, 1.0),
            starts_negative: None,
        };
        let (mut inside, mut told, mut first) = (false, false, None);
        let flow = line.roots(&mut window, |root| {
            first.get_or_insert(!root.rising);
            let s = self.polished(segment, &line, &root);
            let t = segment.t + s * segment.t_per_s;
            if t <= start {
                (inside, first) = (!root.rising, Some(root.rising));
                return ControlFlow::Continue(());
            }
            if !std::mem::replace(&mut told, true) {
                visit(Event::Start {
                    inside: root.rising,
                })?;
            }
            visit(Event::Crossing {
                t,
                t_error: if question.errors {
                    gamma(4) * t.abs() + line.root_error(s) * segment.t_per_s
                } else {
                    0.0
                },
                enters: !root.rising,
            })
        });
        if !told {
            if first.is_none() {
                inside = window.starts_negative.unwrap_or_default();
            }
            visit(Event::Start { inside })?;
        }
        flow
    }
}

fn check_degree(degree: u32) -> Result<(), GeometryError> {
    if (1..=MAX_DEGREE).contains(&degree) {
        return Ok(());
    }
    Err(GeometryError::OutOfRange {
        what: "degree of the polynomial",
        expected: "from 1 to 35",
        found: f64::from(degree),
    })
}

/// The largest power of two that is not greater than a positive normal number; 1 for everything else.
fn power_of_two(x: f64) -> f64 {
    if x.is_normal() && x > 0.0 {
        f64::from_bits(x.to_bits() >> 52 << 52)
    } else {
        1.0
    }
}

impl Primitive for Polynomial {
    fn kind(&self) -> &'static str {
        "polynomial"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        if self.terms.iter().any(|(_, c)| !c.is_finite()) {
            return Err(GeometryError::NotFinite {
                what: "coefficient of the polynomial",
            });
        }
        if self.degree() == 0 {
            return Err(GeometryError::Degenerate {
                what: "polynomial",
                why: "it is constant, so it has no surface",
            });
        }
        check_degree(self.degree())
    }

    fn bounds(&self) -> Aabb {
        self.extent.as_deref().copied().unwrap_or(Aabb::EVERYTHING)
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        event::closest(range, from, |question, visit| {
            self.walk(ray, question, visit)
        })
    }

    fn all_hits(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Vec<PrimHit>,
    ) {
        event::all(range, from, out, |question, visit| {
            self.walk(ray, question, visit);
        });
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let p = ray.origin * self.per_length + (ray.direction * self.per_length) * hit.t;
        let Dual { value, gradient } = self.dual(p);
        let size = p.length() + 1.0;
        // One Newton step along the gradient, unless the value is zero within its rounding error.
        let step = gradient * (value / gradient.length_squared());
        let error = self.value_error(p.abs().max_element());
        let (local, gradient) = if value.abs() > error && step.length() < size {
            (p - step, self.dual(p - step).gradient)
        } else {
            (p, gradient)
        };
        let steepness = gradient.length();
        // Where sheets of the surface meet, at most half of the digits are known, and any direction will do.
        let n = gradient.normalize_or(DVec3::Y);
        let (across, most) = (error / steepness, gamma(1).sqrt() * size);
        let across = if across < most { across } else { most };
        let position = local * self.length;
        let position_error = point_error(position, local.length() * self.length, 4)
            + DVec3::splat(across * self.length);
        SurfacePoint::bare(position, position_error, n)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }
}

impl Solid for Polynomial {
    /// Everything: the inside may be what is outside of a closed surface.
    fn inside_bounds(&self) -> Aabb {
        Aabb::EVERYTHING
    }

    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        event::list(range, from, out, |question, visit| {
            self.walk(ray, question, visit);
        });
    }

    fn contains(&self, point: DVec3) -> bool {
        // Not every polynomial has all coordinates in it.
        !point.is_nan() && self.value(point) <= 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `(x² + y² + z² + R² - r²)² - 4 R² (x² + z²)` with R = 1 and r = 1/4.
    fn torus() -> Polynomial {
        let k = 1.0 - 1.0 / 16.0;
        Polynomial::new([
            ([4, 0, 0], 1.0),
            ([0, 4, 0], 1.0),
            ([0, 0, 4], 1.0),
            ([2, 2, 0], 2.0),
            ([2, 0, 2], 2.0),
            ([0, 2, 2], 2.0),
            ([2, 0, 0], 2.0 * k - 4.0),
            ([0, 2, 0], 2.0 * k),
            ([0, 0, 2], 2.0 * k - 4.0),
            ([0, 0, 0], k * k),
        ])
    }

    /// `x^n + y^n + z^n - 1`.
    fn rounded_cube(n: u32) -> Polynomial {
        let ends = [([n, 0, 0], 1.0), ([0, n, 0], 1.0), ([0, 0, n], 1.0)];
        Polynomial::new(ends.into_iter().chain([([0, 0, 0], -1.0)]))
    }

    crate::primitive_tests!(plane, || Polynomial::new([
        ([1, 0, 0], 1.0),
        ([0, 1, 0], 2.0),
        ([0, 0, 0], -0.5)
    ]));
    crate::primitive_tests!(ball, || rounded_cube(2));
    crate::primitive_tests!(saddle_of_a_monkey, || Polynomial::new([
        ([3, 0, 0], 1.0),
        ([1, 2, 0], -3.0),
        ([0, 0, 1], -1.0)
    ]));
    crate::primitive_tests!(quartic_torus, torus);
    crate::primitive_tests!(piriform, || Polynomial::new([
        ([4, 0, 0], 4.0),
        ([3, 0, 0], -4.0),
        ([0, 2, 0], 1.0),
        ([0, 0, 2], 1.0)
    ]));
    crate::primitive_tests!(six, || rounded_cube(6));
    crate::primitive_tests!(ten, || rounded_cube(10));
    crate::primitive_tests!(twenty, || rounded_cube(20));
    crate::primitive_tests!(thirty_four, || rounded_cube(34));
    crate::primitive_tests!(turned_inside_out, || Polynomial::new([
        ([4, 0, 0], -1.0),
        ([0, 4, 0], -1.0),
        ([0, 0, 2], -1.0),
        ([0, 0, 0], 1.0)
    ]));

    fn crossings(shape: &Polynomial, ray: &Ray) -> Vec<f64> {
        let mut out = Crossings::default();
        shape.crossings(ray, Interval::LINE, None, &mut Scratch::default(), &mut out);
        out.list.iter().map(|c| c.hit.t).collect()
    }

    #[test]
    fn the_torus_is_crossed_where_the_torus_is() {
        let across = crossings(&torus(), &Ray::new(DVec3::new(-2.0, 0.0, 0.0), DVec3::X));
        let expected = [0.75, 1.25, 2.75, 3.25];
        assert_eq!(across.len(), 4);
        assert!(
            across
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-14)
        );
        let hole = Ray::new(DVec3::Y * 3.0, -DVec3::Y);
        assert_eq!(crossings(&torus(), &hole), []);
    }

    #[test]
    fn the_list_is_in_povrays_order() {
        // x² + 2 xy + 3 xz + 4 x + 5 y² + 6 yz + 7 y + 8 z² + 9 z + 10 at (2, 3, 5).
        let list: Vec<f64> = (1..=10).map(f64::from).collect();
        let shape = Polynomial::try_from_list(2, &list).expect("ten");
        let p = DVec3::new(2.0, 3.0, 5.0);
        let expected = 4.0 + 12.0 + 30.0 + 8.0 + 45.0 + 90.0 + 21.0 + 200.0 + 45.0 + 10.0;
        let ratio = shape.value(p) / expected;
        assert_eq!(ratio.to_bits() << 12, 0, "a power of two: {ratio}");
        assert!(Polynomial::try_from_list(2, &list[1..]).is_err());
        assert_eq!(Polynomial::coefficient_count(4), 35);
        assert_eq!(Polynomial::coefficient_count(35), 8436);
    }

    #[test]
    fn roots_far_away_and_nearly_parallel_rays() {
        // y = x³ z: along (1, 0, 1e-9) at height 1 it is crossed at x = 10^(9/4).
        let shape = Polynomial::new([([3, 0, 1], 1.0), ([0, 1, 0], -1.0)]);
        let found = crossings(&shape, &Ray::new(DVec3::Y, DVec3::new(1.0, 0.0, 1e-9)));
        let expected = 1e9f64.sqrt().sqrt();
        assert_eq!(found.len(), 2, "{found:?}");
        assert!((found[1] - expected).abs() < 1e-9 * expected, "{found:?}");
        // In a plane that the surface meets at infinity only.
        assert_eq!(crossings(&shape, &Ray::new(DVec3::Y, DVec3::X)), []);
    }

    #[test]
    fn closed_surfaces_have_tight_boxes() {
        let bounds = torus().bounds();
        let outer = DVec3::new(1.25, 0.25, 1.25);
        let contains = |b: &Aabb, p: DVec3| b.contains(p) && b.contains(-p);
        assert!(contains(&bounds, outer * DVec3::X + DVec3::ZERO));
        assert!(contains(&bounds, outer * DVec3::Z));
        assert!(contains(&bounds, DVec3::new(1.0, 0.25, 0.0)));
        assert!(bounds.max.x < 1.6 && bounds.max.y < 0.6, "{bounds:?}");
        for n in [2, 4, 6, 10] {
            let bounds = rounded_cube(n).bounds();
            assert!(
                contains(&bounds, DVec3::X) && bounds.max_abs() < 1.4,
                "{n} {bounds:?}"
            );
        }
        // Inside out, it is as closed.
        let inverse = Polynomial::new([
            ([4, 0, 0], -1.0),
            ([0, 4, 0], -1.0),
            ([0, 0, 4], -1.0),
            ([0, 0, 0], 1.0),
        ]);
        assert!(inverse.bounds().is_bounded() && !inverse.inside_bounds().is_bounded());
        let open = [
            // A cylinder, a saddle, and one that is open on one side.
            Polynomial::new([([4, 0, 0], 1.0), ([0, 4, 0], 1.0), ([0, 0, 0], -1.0)]),
            Polynomial::new([([2, 0, 0], 1.0), ([0, 2, 0], -1.0), ([0, 0, 1], -1.0)]),
            Polynomial::new([([3, 0, 0], 1.0), ([0, 2, 0], 1.0), ([0, 0, 2], 1.0)]),
        ];
        for shape in open {
            assert!(!shape.bounds().is_bounded(), "{shape:?}");
        }
        // Nothing at all.
        let empty = Polynomial::new([
            ([2, 0, 0], 1.0),
            ([0, 2, 0], 1.0),
            ([0, 0, 2], 1.0),
            ([0, 0, 0], 1.0),
        ]);
        assert!(empty.bounds().max_abs() < 1e-9);
    }

    /// Surfaces that are closed although their terms of the highest degree vanish in some direction: with the corner of the true box.
    #[test]
    fn terms_of_lower_degrees_close_surfaces() {
        for (terms, corner) in [
            // The lemniscate of Gerono, turned about its axis: x⁴ - x² + y² + z².
            (
                vec![
                    ([4, 0, 0], 1.0),
                    ([2, 0, 0], -1.0),
                    ([0, 2, 0], 1.0),
                    ([0, 0, 2], 1.0),
                ],
                DVec3::new(1.0, 0.5, 0.5),
            ),
            // Inside out, and with a mixed term that is nowhere negative.
            (
                vec![
                    ([4, 0, 0], -16.0),
                    ([2, 2, 0], -1.0),
                    ([0, 2, 0], -1.0),
                    ([0, 0, 2], -4.0),
                    ([0, 0, 0], 1.0),
                ],
                DVec3::new(0.5, 1.0, 0.5),
            ),
            // A mixed term that is outweighed: x² + xy + y² + z⁴ = 1.
            (
                vec![
                    ([2, 0, 0], 1.0),
                    ([1, 1, 0], 1.0),
                    ([0, 2, 0], 1.0),
                    ([0, 0, 4], 1.0),
                    ([0, 0, 0], -1.0),
                ],
                DVec3::new(1.1547, 1.1547, 1.0),
            ),
        ] {
            let bounds = Polynomial::new(terms).bounds();
            let wider = corner * 1.4;
            assert!(bounds.contains(corner * (1.0 - 1e-5)), "{bounds:?}");
            assert!(bounds.contains(-corner * (1.0 - 1e-5)), "{bounds:?}");
            assert!(
                bounds.max.cmplt(wider).all() && bounds.min.cmpgt(-wider).all(),
                "{bounds:?}"
            );
        }
        // The mixed term outweighs: a hyperbola.
        let open = [
            ([2, 0, 0], 1.0),
            ([1, 1, 0], 3.0),
            ([0, 2, 0], 1.0),
            ([0, 0, 4], 1.0),
        ];
        assert!(!Polynomial::new(open).bounds().is_bounded());
    }

    /// Whatever rays hit is in the box, also of surfaces made at random.
    #[test]
    fn rays_hit_nothing_outside_of_the_box() {
        let mut random = crate::conformance::Random::new(35);
        let (mut closed, mut hits) = (0, 0);
        for case in 0..60 {
            let n = 2 + 2 * (case % 3);
            let size = strahl_math::det::pow(10.0, random.between(-3.0, 3.0));
            let unit = |power: u32| (0..power).fold(1.0, |product, _| product / size);
            // In half of them the last power is 2, so that the terms of the highest degree do not close them.
            let last = if case % 2 == 0 { n } else { 2 };
            let ends = [([n, 0, 0], n), ([0, n, 0], n), ([0, 0, last], last)];
            let mut terms: Vec<([u32; 3], f64)> = ends
                .map(|(p, power)| (p, random.between(0.5, 2.0) * unit(power)))
                .into();
            for _ in 0..8 {
                let p = [0, 1, 2].map(|_| random.below(u64::from(n / 2)) as u32);
                let degree = p[0] + p[1] + p[2];
                if degree < n {
                    terms.push((p, random.between(-2.0, 2.0) * unit(degree)));
                }
            }
            terms.push(([0, 0, 0], -1.0));
            let shape = Polynomial::new(terms);
            let bounds = shape.bounds();
            if !bounds.is_bounded() {
                continue;
            }
            closed += 1;
            for _ in 0..300 {
                let origin = random.cube() * (6.0 * size);
                let ray = Ray::new(origin, random.cube() * (2.0 * size) - origin);
                for t in crossings(&shape, &ray) {
                    let p = ray.at(t);
                    let slack = DVec3::splat(1e-14 * (origin.length() + size));
                    assert!(bounds.padded(slack).contains(p), "{p} {bounds:?} {shape:?}");
                    hits += 1;
                }
            }
        }
        assert!(closed > 40 && hits > 5000, "{closed} {hits}");
    }

    #[test]
    fn sizes_do_not_matter() {
        for size in [1e-9, 1e-3, 1e3, 1e9] {
            let k = size * size * (1.0 - 1.0 / 16.0);
            let r2 = size * size;
            let shape = Polynomial::new([
                ([4, 0, 0], 1.0),
                ([0, 4, 0], 1.0),
                ([0, 0, 4], 1.0),
                ([2, 2, 0], 2.0),
                ([2, 0, 2], 2.0),
                ([0, 2, 2], 2.0),
                ([2, 0, 0], 2.0 * k - 4.0 * r2),
                ([0, 2, 0], 2.0 * k),
                ([0, 0, 2], 2.0 * k - 4.0 * r2),
                ([0, 0, 0], k * k),
            ]);
            let ray = Ray::new(DVec3::new(-2.0 * size, 0.0, 0.0), DVec3::X);
            let found = crossings(&shape, &ray);
            let expected = [0.75, 1.25, 2.75, 3.25].map(|t| t * size);
            assert_eq!(found.len(), 4, "{size}");
            let close = |(a, b): (&f64, f64)| (a - b).abs() < 1e-13 * size;
            assert!(found.iter().zip(expected).all(close), "{size} {found:?}");
        }
    }

    #[test]
    fn polynomials_without_a_surface_are_refused() {
        assert!(matches!(
            Polynomial::try_new([([0, 0, 0], 1.0)]),
            Err(GeometryError::Degenerate { .. })
        ));
        assert!(matches!(
            Polynomial::try_new([]),
            Err(GeometryError::Degenerate { .. })
        ));
        assert!(matches!(
            Polynomial::try_new([([0, 36, 0], 1.0)]),
            Err(GeometryError::OutOfRange { .. })
        ));
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(matches!(
                Polynomial::try_new([([0, 3, 0], 1.0), ([0, 0, 1], bad)]),
                Err(GeometryError::NotFinite { .. })
            ));
        }
        assert!(Polynomial::try_from_list(99, &[]).is_err());
    }
}
