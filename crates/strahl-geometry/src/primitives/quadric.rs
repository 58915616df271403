use super::convex::{End, Span, Stay, start_of};
use super::point_error;
use crate::blocks::convex::{FourLines, FourRays, FourSpans, mapped, scaled, sub};
use crate::blocks::dot;
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Shape, Solid, SurfaceId, SurfacePoint,
};
use strahl_math::error::gamma;
use strahl_math::{Aabb, DMat3, DVec2, DVec3, Interval, Ray, Transform};
use strahl_simd::Isa;

/// A quadric: the surface where a polynomial of degree 2 in x, y and z vanishes; inside is where it is not positive.
///
/// `A x² + B y² + C z² + D xy + E xz + F yz + G x + H y + I z + J = 0`: ellipsoids, hyperboloids, paraboloids, endless
/// cylinders and cones, pairs of planes. Changing all signs turns the inside out.
///
/// It has no texture coordinates (`uv` and its derivatives are zero). Facets: one, 0. Ellipsoids have a tight bounding box,
/// all others are unbounded. A ray that touches the surface does not hit it.
///
/// Internally the polynomial is kept about the centre of the quadric, if it has one, and moves with it when a map is baked
/// in, so that small quadrics far from the origin keep their digits. Coefficients that *describe* a small shape far away
/// have lost them already: describe it at the origin and move it.
#[derive(Clone, Debug, PartialEq)]
pub struct Quadric {
    /// The origin of the polynomial's own coordinates.
    origin: DVec3,
    /// The symmetric matrix of the terms of degree 2.
    square: DMat3,
    /// Half the vector of the linear terms.
    half_linear: DVec3,
    /// The constant term.
    constant: f64,
    /// The row sum norm of `square`.
    norm: f64,
}

/// `F(t) = a t² + 2 h t + c` along a ray from a point `p` with the direction `d`.
struct Along {
    p: DVec3,
    d: DVec3,
    a: f64,
    h: f64,
}

impl Quadric {
    /// The quadric of ten coefficients, in the order of the formula above: `[A, B, C, D, E, F, G, H, I, J]`.
    pub fn new(coefficients: [f64; 10]) -> Self {
        let [a, b, c, d, e, f, g, h, i, j] = coefficients;
        let square = DMat3::from_cols(
            DVec3::new(a, 0.5 * d, 0.5 * e),
            DVec3::new(0.5 * d, b, 0.5 * f),
            DVec3::new(0.5 * e, 0.5 * f, c),
        );
        let plain = Self {
            origin: DVec3::ZERO,
            square,
            half_linear: DVec3::new(g, h, i) * 0.5,
            constant: j,
            norm: norm(square),
        };
        plain
            .center()
            .map_or(plain.clone(), |center| plain.about(center))
    }

    /// Like [`Quadric::new`], checked.
    ///
    /// # Errors
    /// A coefficient is not finite, all of A to I are zero, or no point or only one satisfies the equation.
    pub fn try_new(coefficients: [f64; 10]) -> Result<Self, GeometryError> {
        let quadric = Self::new(coefficients);
        quadric.validate().map(|()| quadric)
    }

    /// The ten coefficients about the world's origin, up to rounding.
    pub fn coefficients(&self) -> [f64; 10] {
        let q = self.about(DVec3::ZERO);
        let (m, l) = (q.square, q.half_linear * 2.0);
        let (d, e, f) = (2.0 * m.x_axis.y, 2.0 * m.x_axis.z, 2.0 * m.y_axis.z);
        [
            m.x_axis.x, m.y_axis.y, m.z_axis.z, d, e, f, l.x, l.y, l.z, q.constant,
        ]
    }

    /// The value of the polynomial at a point: negative inside.
    pub fn value(&self, point: DVec3) -> f64 {
        self.value_at(point - self.origin)
    }

    /// Whether xy, xz or yz occur in its polynomial.
    pub fn has_mixed_terms(&self) -> bool {
        let q = self.square;
        q.x_axis.y != 0.0 || q.x_axis.z != 0.0 || q.y_axis.z != 0.0
    }

    fn value_at(&self, p: DVec3) -> f64 {
        p.dot(self.square * p + self.half_linear * 2.0) + self.constant
    }

    /// The sum of the magnitudes of the terms of [`Quadric::value_at`], the measure of its rounding error.
    fn magnitude_at(&self, p: DVec3) -> f64 {
        let p = p.abs();
        p.dot(magnitudes(self.square) * p + self.half_linear.abs() * 2.0) + self.constant.abs()
    }

    /// Half the gradient.
    fn half_gradient_at(&self, p: DVec3) -> DVec3 {
        self.square * p + self.half_linear
    }

    /// The same polynomial in coordinates about another point.
    fn about(&self, point: DVec3) -> Self {
        let p = point - self.origin;
        Self {
            origin: point,
            half_linear: self.half_gradient_at(p),
            constant: self.value_at(p),
            ..*self
        }
    }

    /// The point where the gradient vanishes, if there is only one and rounding does not blur it.
    fn center(&self) -> Option<DVec3> {
        let inverse = self.well_conditioned_inverse()?;
        Some(self.origin - inverse * self.half_linear).filter(|center| center.is_finite())
    }

    fn well_conditioned_inverse(&self) -> Option<DMat3> {
        let inverse = self.square.inverse();
        let condition = self.norm * norm(inverse);
        // Beyond this the inverse has lost more than half of its digits.
        (condition < 1e8).then_some(inverse)
    }

    /// The box around the inside, if it is an ellipsoid: with `F = xᵀ Q x - k` the support along axis i is `√(k (Q⁻¹)ᵢᵢ)`.
    fn ellipsoid_bounds(&self) -> Option<Aabb> {
        let q = self.square;
        let inverse = self.well_conditioned_inverse()?;
        // Positive definite by Sylvester's criterion.
        let minor = q.x_axis.x * q.y_axis.y - q.x_axis.y * q.x_axis.y;
        if !(q.x_axis.x > 0.0 && minor > 0.0 && q.determinant() > 0.0) {
            return None;
        }
        let centered = self.about(self.origin - inverse * self.half_linear);
        let level = -centered.constant;
        let diagonal = DVec3::new(inverse.x_axis.x, inverse.y_axis.y, inverse.z_axis.z);
        if !(level > 0.0 && diagonal.cmpgt(DVec3::ZERO).all()) {
            return None;
        }
        let reach = DVec3::new(
            (level * diagonal.x).sqrt(),
            (level * diagonal.y).sqrt(),
            (level * diagonal.z).sqrt(),
        );
        let tight = Aabb::new(centered.origin - reach, centered.origin + reach);
        // The inverse is uncertain by the condition number, the level by the cancellation in the constant.
        let condition = self.norm * norm(inverse);
        let blur = gamma(64)
            * condition
            * (1.0 + self.magnitude_at(centered.origin - self.origin) / level);
        let extent = reach.max_element();
        let padding =
            point_error(centered.origin.abs() + extent, extent, 8) + DVec3::splat(extent * blur);
        tight.is_bounded().then(|| tight.padded(padding))
    }

    fn along(&self, p: DVec3, d: DVec3) -> Along {
        let a = d.dot(self.square * d);
        let h = self.half_gradient_at(p).dot(d);
        Along { p, d, a, h }
    }

    /// More than the rounding error of `a` for a direction of length 1: the row sum norm bounds the sum of the magnitudes of the terms.
    fn error_of_bend(&self) -> f64 {
        gamma(16) * self.norm
    }

    /// Whether `a` is not larger than its rounding error, given the square of the length of the direction.
    #[inline]
    fn is_straight(&self, along: &Along, length_squared: f64) -> bool {
        let Along { a, d, .. } = *along;
        let error = || gamma(8) * d.abs().dot(magnitudes(self.square) * d.abs());
        !(a.abs() > self.error_of_bend() * length_squared) && a.abs() <= error()
    }

    /// Whether `h` is not larger than its rounding error.
    fn is_level(&self, along: &Along) -> bool {
        let Along { p, d, h, .. } = *along;
        let terms = magnitudes(self.square) * p.abs() + self.half_linear.abs();
        h.abs() <= gamma(8) * terms.dot(d.abs())
    }

    /// The parameters of the crossings, ascending, and whether the ray is inside before the first one.
    ///
    /// The polynomial is set up about the point of the ray nearest to the quadric's own origin: there the terms are of the
    /// size of the quadric, wherever the ray starts.
    fn roots(&self, ray: &Ray, on_surface: bool) -> (Roots, bool) {
        let d = ray.direction;
        let start = ray.origin - self.origin;
        let none = |inside| {
            (
                Roots {
                    t: [0.0; 2],
                    count: 0,
                },
                inside,
            )
        };
        if !(start.is_finite() && d.is_finite()) || d == DVec3::ZERO {
            return none(false);
        }
        if on_surface {
            let along = self.along(start, d);
            let Along { a, h, .. } = along;
            let is_straight = self.is_straight(&along, d.length_squared());
            if self.is_level(&along) {
                // A tangent: leaves inwards where the surface bends away from it.
                return none(a < 0.0 && !is_straight);
            }
            let other = -2.0 * h / a;
            if is_straight || !other.is_finite() {
                return (
                    Roots {
                        t: [0.0; 2],
                        count: 1,
                    },
                    h > 0.0,
                );
            }
            let t = if other < 0.0 {
                [other, 0.0]
            } else {
                [0.0, other]
            };
            return (Roots { t, count: 2 }, a < 0.0);
        }
        let length_squared = d.length_squared();
        let shift = -start.dot(d) / length_squared;
        let shift = if shift.is_finite() { shift } else { 0.0 };
        let p = start + d * shift;
        let along = self.along(p, d);
        let Along { a, h, .. } = along;
        let c = self.value_at(p);
        // A leading coefficient below its rounding error would cause a second crossing near infinity.
        if self.is_straight(&along, length_squared) {
            if self.is_level(&along) {
                return none(c < 0.0);
            }
            let t = shift - c / (2.0 * h);
            return (
                Roots {
                    t: [t; 2],
                    count: 1,
                },
                h > 0.0,
            );
        }
        let discriminant = h * h - a * c;
        if !(discriminant > 0.0) {
            return none(a < 0.0);
        }
        let s = discriminant.sqrt();
        let q = if h >= 0.0 { -h - s } else { -h + s };
        let (t0, t1) = (shift + q / a, shift + c / q);
        (
            Roots {
                t: if t0 <= t1 { [t0, t1] } else { [t1, t0] },
                count: 2,
            },
            a < 0.0,
        )
    }

    /// Where four lines cross the surface that don't start on it, as [`Quadric::roots`]; and the lanes, as bits, that are inside between the two
    /// crossings, and not outside. Nothing is known of lines that may cross it only once.
    #[inline(always)]
    pub(crate) fn four_roots<I: Isa>(&self, isa: I, rays: &FourRays<I>) -> (FourSpans, u32) {
        let d = rays.direction;
        let three = |v: DVec3| [isa.splat(v.x), isa.splat(v.y), isa.splat(v.z)];
        let start = sub(isa, rays.origin, three(self.origin));
        let length_squared = dot(isa, d, d);
        let minus = isa.splat(-0.0);
        let shift = isa.div(isa.sub(minus, dot(isa, start, d)), length_squared);
        let p = add(isa, start, scaled(isa, d, shift));
        let a = dot(isa, d, mapped(isa, self.square, d));
        let bent = mapped(isa, self.square, p);
        let h = dot(isa, add(isa, bent, three(self.half_linear)), d);
        let value = dot(isa, p, add(isa, bent, three(self.half_linear * 2.0)));
        let c = isa.add(value, isa.splat(self.constant));
        let error = isa.mul(isa.splat(self.error_of_bend()), length_squared);
        let is_finite = isa.le(isa.abs(shift), isa.splat(f64::MAX));
        let zero = isa.splat(0.0);
        let discriminant = isa.sub(isa.mul(h, h), isa.mul(a, c));
        let met = isa.lt(zero, discriminant);
        let inside_between = isa.lt(zero, a);
        let mut out = FourSpans {
            known: is_finite & isa.lt(error, isa.abs(a)),
            ..FourSpans::default()
        };
        if met == 0 {
            return (out, inside_between);
        }
        let s = isa.sqrt(discriminant);
        let less = isa.sub(minus, h);
        let q = isa.choose_le(zero, h, isa.sub(less, s), isa.add(less, s));
        let t0 = isa.add(shift, isa.div(q, a));
        let t1 = isa.add(shift, isa.div(c, q));
        let (enter, exit) = (isa.choose_le(t0, t1, t0, t1), isa.choose_le(t0, t1, t1, t0));
        // The own test decides about what is no number.
        out.known &= !met | isa.lt(enter, exit);
        out.met = met & out.known;
        (out.enter, out.exit) = (isa.store(enter), isa.store(exit));
        (out, inside_between)
    }

    /// Where the line is inside.
    pub(crate) fn stay(&self, ray: &Ray, from: Option<SurfaceId>) -> Stay {
        let (roots, inside_before) = self.roots(ray, from.is_some());
        let [first, second] = roots.t.map(|t| End { t, facet: 0 });
        let span = match roots.count {
            0 => inside_before.then_some(Span::LINE),
            1 if inside_before => Some(Span {
                exit: first,
                ..Span::LINE
            }),
            1 => Some(Span {
                enter: first,
                ..Span::LINE
            }),
            _ => Some(Span {
                enter: first,
                exit: second,
            }),
        };
        Stay {
            span,
            outside: roots.count == 2 && inside_before,
        }
    }

    /// The error of the parameter of a crossing: the error of the value divided by its slope along the ray; near a tangent the
    /// error grows to the square root.
    fn t_error(&self, ray: &Ray, t: f64) -> f64 {
        let p = (ray.origin - self.origin) + ray.direction * t;
        let Along { a, h, .. } = self.along(p, ray.direction);
        let moved =
            gamma(8) * (ray.origin.length() + self.origin.length() + (ray.direction * t).length());
        let gradient = 2.0 * self.half_gradient_at(p).length() + self.norm * moved;
        let value = gamma(16) * self.magnitude_at(p) + gradient * moved;
        let (straight, tangent) = (value / (2.0 * h.abs()), (value / a.abs()).sqrt());
        let error = if straight < tangent || !tangent.is_finite() {
            straight
        } else {
            tangent
        };
        gamma(4) * t.abs() + error
    }
}

#[inline(always)]
fn add<I: Isa>(isa: I, a: [I::F64x4; 3], b: [I::F64x4; 3]) -> [I::F64x4; 3] {
    [
        isa.add(a[0], b[0]),
        isa.add(a[1], b[1]),
        isa.add(a[2], b[2]),
    ]
}

impl FourLines for Quadric {
    /// The spans are those between two crossings, inside or outside: both ends of either are hits.
    #[inline(always)]
    fn spans<I: Isa>(&self, isa: I, rays: &FourRays<I>) -> FourSpans {
        self.four_roots(isa, rays).0
    }
}

/// Up to two parameters.
struct Roots {
    t: [f64; 2],
    count: usize,
}

impl Roots {
    fn iter(&self) -> impl Iterator<Item = f64> {
        self.t.into_iter().take(self.count)
    }
}

fn magnitudes(m: DMat3) -> DMat3 {
    DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs())
}

/// The row sum norm.
fn norm(m: DMat3) -> f64 {
    (magnitudes(m) * DVec3::ONE).max_element()
}

impl Primitive for Quadric {
    fn kind(&self) -> &'static str {
        "quadric"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        let finite =
            self.square.is_finite() && self.half_linear.is_finite() && self.constant.is_finite();
        if !(finite && self.origin.is_finite()) {
            return Err(GeometryError::NotFinite {
                what: "coefficient of the quadric",
            });
        }
        let what = "quadric";
        if self.square == DMat3::ZERO && self.half_linear == DVec3::ZERO {
            return Err(GeometryError::Degenerate {
                what,
                why: "its polynomial is constant",
            });
        }
        let definite = |m: DMat3| {
            let minor = m.x_axis.x * m.y_axis.y - m.x_axis.y * m.x_axis.y;
            m.x_axis.x > 0.0 && minor > 0.0 && m.determinant() > 0.0
        };
        if let Some(center) = self.center() {
            let extremum = self.value(center);
            if (definite(self.square) && extremum >= 0.0)
                || (definite(-self.square) && extremum <= 0.0)
            {
                return Err(GeometryError::Degenerate {
                    what,
                    why: "no surface: its polynomial never changes sign",
                });
            }
        }
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        self.ellipsoid_bounds().unwrap_or(Aabb::EVERYTHING)
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let (roots, _) = self.roots(ray, from.is_some());
        let counts = |t: &f64| range.accepts(*t) && t.is_finite() && (from.is_none() || *t != 0.0);
        roots.iter().find(counts).map(|t| PrimHit::simple(t, 0))
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let p = (ray.origin - self.origin) + ray.direction * hit.t;
        // One Newton step along the gradient: p - F ∇F / |∇F|².
        let half_gradient = self.half_gradient_at(p);
        let step = half_gradient * (0.5 * self.value_at(p) / half_gradient.length_squared());
        let local = if step.is_finite() { p - step } else { p };
        let position = self.origin + local;
        let half_gradient = self.half_gradient_at(local);
        let steepness = half_gradient.length();
        // At the tip of a cone any direction will do.
        let n = half_gradient.normalize_or(DVec3::Y);
        let across = if steepness > 0.0 {
            gamma(8) * self.magnitude_at(local) / steepness
        } else {
            0.0
        };
        SurfacePoint {
            position,
            position_error: point_error(position, local.length(), 4) + DVec3::splat(across),
            n_geom: n,
            n_shade: n,
            uv: DVec2::ZERO,
            dpdu: DVec3::ZERO,
            dpdv: DVec3::ZERO,
        }
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }

    /// Any map makes a quadric of a quadric.
    fn baked(&self, map: &Transform) -> Option<Shape> {
        // F'(p) = F(L⁻¹ p) about the image of the origin.
        let inverse = map.inverted().linear();
        let transposed = inverse.transpose();
        let square = transposed * self.square * inverse;
        let symmetric = (square + square.transpose()) * 0.5;
        Some(Shape::from(Self {
            origin: map.point_to_world(self.origin),
            square: symmetric,
            half_linear: transposed * self.half_linear,
            constant: self.constant,
            norm: norm(symmetric),
        }))
    }
}

impl Solid for Quadric {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let (roots, inside_before) = self.roots(ray, from.is_some());
        let [first, second] = roots.t;
        let end = |t| End { t, facet: 0 };
        let error = |end: End| self.t_error(ray, end.t);
        let (before, behind) = (
            Span {
                exit: end(first),
                ..Span::LINE
            },
            Span {
                enter: end(if roots.count == 2 { second } else { first }),
                ..Span::LINE
            },
        );
        match (roots.count, inside_before) {
            (2, false) => Span {
                enter: end(first),
                exit: end(second),
            }
            .list(range, from, error, out),
            (2, true) => {
                // Everything but a gap: two spans.
                before.list(range, from, error, out);
                let inside_at_start = out.inside_at_start;
                behind.list(range, from, error, out);
                out.inside_at_start |= inside_at_start;
            }
            (1, true) => before.list(range, from, error, out),
            (1, false) => behind.list(range, from, error, out),
            _ => out.inside_at_start = inside_before && !start_of(range, from).is_nan(),
        }
    }

    fn contains(&self, point: DVec3) -> bool {
        self.value(point) <= 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quadric(coefficients: [f64; 10]) -> Quadric {
        Quadric::try_new(coefficients).expect("has a surface")
    }

    fn ellipsoid() -> Quadric {
        quadric([1.0, 4.0, 0.5, 0.3, -0.2, 0.4, 1.0, -2.0, 0.7, -3.0])
    }

    crate::primitive_tests!(ball, || quadric([
        1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0
    ]));
    crate::primitive_tests!(tilted_ellipsoid, ellipsoid);
    crate::primitive_tests!(everything_but_a_ball, || quadric([
        -1.0, -1.0, -1.0, 0.0, 0.0, 0.0, 0.2, 0.0, 0.0, 1.0
    ]));
    crate::primitive_tests!(one_sheet, || quadric([
        1.0, 1.0, -0.7, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0
    ]));
    crate::primitive_tests!(two_sheets, || quadric([
        1.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.1, 0.0, 0.5
    ]));
    crate::primitive_tests!(paraboloid, || quadric([
        1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0
    ]));
    crate::primitive_tests!(saddle, || quadric([
        1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.2
    ]));
    crate::primitive_tests!(endless_cylinder, || quadric([
        1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0
    ]));
    crate::primitive_tests!(double_cone, || quadric([
        1.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    ]));
    crate::primitive_tests!(half_space, || quadric([
        0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 0.5
    ]));
    crate::primitive_tests!(slab, || quadric([
        1.0, 1.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0
    ]));

    #[test]
    fn the_box_of_an_ellipsoid_is_tight() {
        let shape = ellipsoid();
        let bounds = shape.bounds();
        let center = shape.center().expect("has one");
        for axis in 0..3 {
            // The outermost point along an axis is where the gradient points along it.
            let inverse = shape.square.inverse();
            let touching = inverse * DVec3::AXES[axis];
            let scale = (-shape.value(center) / touching[axis]).sqrt();
            let outermost = center + touching * scale;
            assert!(shape.value(outermost).abs() < 1e-12);
            assert!(
                (bounds.max[axis] - outermost[axis]).abs() < 1e-9
                    && bounds.max[axis] >= outermost[axis]
            );
        }
        assert_eq!(
            quadric([1.0, 1.0, -0.7, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]).bounds(),
            Aabb::EVERYTHING
        );
    }

    #[test]
    fn coefficients_come_back() {
        let given = [1.0, 4.0, 0.5, 0.3, -0.2, 0.4, 1.0, -2.0, 0.7, -3.0];
        for (given, found) in given.into_iter().zip(quadric(given).coefficients()) {
            assert!((given - found).abs() < 1e-14, "{given} {found}");
        }
    }

    #[test]
    fn a_ray_along_the_axis_of_a_paraboloid_crosses_once() {
        let turned = quadric([1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0])
            .baked(&Transform::rotate(DVec3::new(1.0, 0.4, -0.3), 1.0))
            .expect("any map");
        let map = Transform::rotate(DVec3::new(1.0, 0.4, -0.3), 1.0);
        let ray = Ray::new(
            map.point_to_world(DVec3::new(0.5, -1.0, 0.0)),
            map.vector_to_world(DVec3::Y),
        );
        let mut out = Crossings::default();
        let solid = turned.as_solid().expect("a solid");
        solid.crossings(
            &ray,
            Interval::LINE,
            None,
            &mut Scratch::default(),
            &mut out,
        );
        assert_eq!(out.list.len(), 1);
        assert!((out.list[0].hit.t - 1.25).abs() < 1e-14);
    }

    #[test]
    fn quadrics_without_a_surface_are_refused() {
        let try_new = Quadric::try_new;
        assert!(matches!(
            try_new([0.0; 10]),
            Err(GeometryError::Degenerate { .. })
        ));
        let imaginary = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        assert!(matches!(
            try_new(imaginary),
            Err(GeometryError::Degenerate { .. })
        ));
        assert!(matches!(
            try_new(imaginary.map(|c| -c)),
            Err(GeometryError::Degenerate { .. })
        ));
        assert!(matches!(
            try_new([f64::NAN; 10]),
            Err(GeometryError::NotFinite { .. })
        ));
    }
}
