//! The right circular frustum: the common geometry of cylinder and cone.

use super::convex::{End, Span};
use super::disc::circle_bounds;
use super::frame::{UvFrame, similarity, turn};
use super::{check_finite, check_length, plane_t_error, point_error, unit_vector};
use crate::blocks::convex::{FourLines, FourRays, FourSpans, scaled, sub};
use crate::blocks::{LANES, dot};
use crate::{Crossings, GeometryError, PrimHit, SurfaceId, SurfacePoint};
use std::f64::consts::PI;
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};
use strahl_simd::Isa;

/// The curved side.
pub(super) const SIDE: u32 = 0;
/// The cap at the base.
pub(super) const BASE: u32 = 1;
/// The cap at the apex.
pub(super) const APEX: u32 = 2;

/// The points within a radius that changes linearly along an axis, between two planes perpendicular to it.
///
/// The solid is the intersection of two convex sets, a (one-sided, endless) cone and a slab. A ray's span in it is the
/// intersection of its spans in the two, so that side and caps join without gaps and entering and leaving
/// alternate whatever the rounding.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Frustum {
    pub(super) base: DVec3,
    /// Unit vector from the base to the apex.
    pub(super) axis: DVec3,
    pub(super) height: f64,
    pub(super) base_radius: f64,
    /// How much the radius grows per unit of height.
    pub(super) slope: f64,
    pub(super) capped: bool,
    frame: UvFrame,
}

/// A ray in terms of height above the base and distance from the axis.
struct AxisRay {
    height: f64,
    climb: f64,
    across: DVec3,
    sideways: DVec3,
}

/// A point, seen from the axis.
struct Around {
    /// From the centre of the base.
    local: DVec3,
    height: f64,
    /// From the axis to the point, its length and its direction.
    across: DVec3,
    distance: f64,
    out: DVec3,
}

impl Frustum {
    pub(super) fn new(
        base: DVec3,
        base_radius: f64,
        apex: DVec3,
        apex_radius: f64,
        capped: bool,
    ) -> Self {
        let axis = unit_vector(apex - base);
        // Along the unit vector instead of by squares, which under- or overflow.
        let height = (apex - base).dot(axis);
        let slope = (apex_radius - base_radius) / height;
        Self {
            base,
            axis,
            height,
            base_radius,
            slope,
            capped,
            frame: UvFrame::default(),
        }
    }

    pub(super) fn apex(&self) -> DVec3 {
        self.base + self.axis * self.height
    }

    pub(super) fn apex_radius(&self) -> f64 {
        self.base_radius + self.slope * self.height
    }

    /// Checks everything but the radii against each other; `what` names the kind of shape.
    pub(super) fn validate(&self, what: &'static str) -> Result<(), GeometryError> {
        if self.axis == DVec3::ZERO {
            return Err(GeometryError::Degenerate {
                what,
                why: "its base and its apex are the same point",
            });
        }
        check_finite("base point of the shape", self.base)?;
        check_finite("axis of the shape", self.axis * self.height)?;
        check_length("radius at the base", self.base_radius)?;
        // The rounding of the slope must not turn a pointed cone's zero into a negative radius.
        let apex_radius = self.apex_radius();
        let rounding = gamma(4) * self.base_radius;
        check_length(
            "radius at the apex",
            if apex_radius.abs() <= rounding {
                0.0
            } else {
                apex_radius
            },
        )?;
        if self.base_radius == 0.0 && apex_radius <= rounding {
            return Err(GeometryError::Degenerate {
                what,
                why: "both of its radii are 0",
            });
        }
        Ok(())
    }

    pub(super) fn bounds(&self) -> Aabb {
        let apex_radius = self.apex_radius().abs();
        let tight = circle_bounds(self.base, self.axis, self.base_radius).union(&circle_bounds(
            self.apex(),
            self.axis,
            apex_radius,
        ));
        let extent = self.height + self.base_radius + apex_radius;
        tight.padded(point_error(self.base.abs() + extent, extent, 16))
    }

    #[inline]
    fn axis_ray(&self, ray: &Ray) -> AxisRay {
        let f = ray.origin - self.base;
        let (height, climb) = (f.dot(self.axis), ray.direction.dot(self.axis));
        AxisRay {
            height,
            climb,
            across: f - self.axis * height,
            sideways: ray.direction - self.axis * climb,
        }
    }

    /// The span within the endless one-sided cone.
    ///
    /// With `x` the vector from the axis and `R` the radius at the ray's height, `F = |x|² - R² = a t² - 2 b t + c` is the square
    /// of the vector `(x, R)` in a Minkowski metric, and the discriminant `b² - a c` is the negative square of the plane
    /// it spans with the direction `(x', R')`: `|R' x - R x'|² - (x × x')²`. None of the large terms of `b²` and
    /// `a c` appear in it.
    #[inline]
    fn side_span(&self, r: &AxisRay, starts_on_side: bool) -> Option<(f64, f64)> {
        let radius = self.base_radius + self.slope * r.height;
        let growth = self.slope * r.climb;
        let a = r.sideways.dot(r.sideways) - growth * growth;
        let b = radius * growth - r.across.dot(r.sideways);
        let distance = r.across.length();

        let (first, second) = if starts_on_side {
            // c is zero: the roots are 0 and 2b/a. Below its own rounding error the sign of b says nothing: a tangent.
            let magnitude = distance * r.sideways.length() + (radius * growth).abs();
            if !(b.abs() > gamma(8) * magnitude) {
                return None;
            }
            (0.0, 2.0 * b / a)
        } else {
            let spread = r.across * growth - r.sideways * radius;
            let twist = self.axis.dot(r.across.cross(r.sideways));
            let discriminant = spread.dot(spread) - twist * twist;
            if a > 0.0 && !(discriminant > 0.0) {
                return None;
            }
            // A line steeper than the side always hits it; at the tip itself rounding may hide that.
            let s = if discriminant > 0.0 {
                discriminant.sqrt()
            } else {
                0.0
            };
            let q = if b >= 0.0 { b + s } else { b - s };
            let c = (distance - radius) * (distance + radius);
            if q == 0.0 && a == 0.0 {
                // Along the axis of a cylinder.
                return (c < 0.0).then_some((f64::NEG_INFINITY, f64::INFINITY));
            }
            if q == 0.0 { (0.0, 0.0) } else { (c / q, q / a) }
        };
        if a > 0.0 {
            // Both ends are on the same half of the double cone; the slab removes those on the wrong half.
            return Some(if first <= second {
                (first, second)
            } else {
                (second, first)
            });
        }
        // Steeper than the side: inside from the single crossing with our half on, in the direction of growing radius.
        if growth > 0.0 {
            let start = if a == 0.0 || first >= second {
                first
            } else {
                second
            };
            (a < 0.0 || b > 0.0).then_some((start, f64::INFINITY))
        } else {
            let end = if a == 0.0 || first <= second {
                first
            } else {
                second
            };
            (a < 0.0 || b < 0.0).then_some((f64::NEG_INFINITY, end))
        }
    }

    /// The span between the two planes.
    #[inline]
    fn slab(&self, r: &AxisRay, from: Option<u32>) -> Option<(End, End)> {
        if r.climb == 0.0 {
            let between = 0.0 < r.height && r.height < self.height;
            let on_cap = matches!(from, Some(BASE | APEX));
            let end = |t| End { t, facet: BASE };
            return (between && !on_cap).then_some((end(f64::NEG_INFINITY), end(f64::INFINITY)));
        }
        let end = |facet, height: f64| End {
            t: if from == Some(facet) {
                0.0
            } else {
                (height - r.height) / r.climb
            },
            facet,
        };
        let (low, high) = (end(BASE, 0.0), end(APEX, self.height));
        Some(if r.climb > 0.0 {
            (low, high)
        } else {
            (high, low)
        })
    }

    /// The span within the solid.
    #[inline]
    pub(super) fn span(&self, ray: &Ray, from: Option<SurfaceId>) -> Option<Span> {
        let from = from.map(|surface| surface.facet);
        let r = self.axis_ray(ray);
        let (first, second) = self.side_span(&r, from == Some(SIDE))?;
        let (enter, exit) = self.slab(&r, from)?;
        let side = |t| End { t, facet: SIDE };
        let span = Span::LINE
            .cut(side(first), side(second))?
            .cut(enter, exit)?;
        // A ray without a direction has not been clipped.
        (span.enter.t.is_finite() || span.exit.t.is_finite()).then_some(span)
    }

    #[inline]
    pub(super) fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
    ) -> Option<PrimHit> {
        self.closest_end(&self.span(ray, from)?, range, from)
    }

    /// The first visible end of a span in a range.
    #[inline]
    fn closest_end(
        &self,
        span: &Span,
        range: Interval,
        from: Option<SurfaceId>,
    ) -> Option<PrimHit> {
        if self.capped {
            return span.closest(range, from);
        }
        // Of an open frustum, only the ends on the side are visible.
        let counts = |end: &End| {
            end.facet == SIDE
                && range.accepts(end.t)
                && end.t.is_finite()
                && !(from.is_some() && end.t == 0.0)
        };
        [span.enter, span.exit]
            .into_iter()
            .find(counts)
            .map(|end| PrimHit::simple(end.t, SIDE))
    }

    pub(super) fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        out: &mut Crossings,
    ) {
        if let Some(span) = self.span(ray, from) {
            let before = out.list.len();
            span.list(range, from, |end| self.t_error(ray, end), out);
            for crossing in out.list.iter_mut().skip(before) {
                crossing.visible = self.capped || crossing.hit.surface.facet == SIDE;
            }
        }
    }

    /// The error of the parameter of a hit: as for the plane, or as for the sphere across the side.
    fn t_error(&self, ray: &Ray, end: End) -> f64 {
        match end.facet {
            BASE => plane_t_error(ray, end.t, self.base, self.axis),
            APEX => plane_t_error(ray, end.t, self.apex(), self.axis),
            _ => {
                let r = self.axis_ray(ray);
                let radius = self.base_radius + self.slope * (r.height + r.climb * end.t);
                let across = r.across + r.sideways * end.t;
                let speed = across.dot(r.sideways) - radius * self.slope * r.climb;
                let steepness = 1.0 + self.slope.abs();
                let magnitude =
                    ray.origin.length() + self.base.length() + (ray.direction * end.t).length();
                let point = gamma(16) * (magnitude + self.base_radius) * steepness;
                let extent = radius.abs() + point;
                let straight = point * extent / speed.abs();
                let tangent = (2.0 * extent * point).sqrt() / r.sideways.length();
                // A line steeper than the side can't graze it, not even at the tip.
                let steeper = (self.slope * r.climb).abs() - r.sideways.length();
                let steep = if steeper > 0.0 {
                    point / steeper
                } else {
                    f64::INFINITY
                };
                let smallest = [tangent, steep]
                    .into_iter()
                    .fold(straight, |a, b| if b < a { b } else { a });
                gamma(2) * end.t.abs() + smallest
            }
        }
    }

    pub(super) fn contains(&self, point: DVec3) -> bool {
        let f = point - self.base;
        let height = f.dot(self.axis);
        let distance = (f - self.axis * height).length();
        0.0 <= height && height <= self.height && distance <= self.base_radius + self.slope * height
    }

    pub(super) fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let Around {
            height,
            distance,
            out,
            ..
        } = self.around(ray, hit);
        let axes = self.frame.axes(self.axis);
        let (x, y) = (out.dot(axes.x_axis), out.dot(axes.y_axis));
        let round = axes.y_axis * x - axes.x_axis * y;
        let (v, dpdv) = match hit.surface.facet {
            BASE => (distance / self.base_radius, out * self.base_radius),
            APEX => (distance / self.apex_radius(), out * self.apex_radius()),
            _ => (
                height / self.height,
                (self.axis + out * self.slope) * self.height,
            ),
        };
        let mut bare = SurfacePoint::UNKNOWN;
        self.store_bare_surface(ray, hit, &mut bare);
        SurfacePoint {
            uv: DVec2::new(turn(y, x), v),
            dpdu: round * (2.0 * PI * distance),
            dpdv,
            ..bare
        }
    }

    pub(super) fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, surface: &mut SurfacePoint) {
        let Around {
            local,
            height,
            across,
            distance,
            out,
        } = self.around(ray, hit);
        let (local, n) = match hit.surface.facet {
            BASE => (across + self.axis * 0.0, -self.axis),
            APEX => (across + self.axis * self.height, self.axis),
            _ => {
                // Back onto the side along its normal, in the plane of axis and point.
                let per_length = 1.0 / (1.0 + self.slope * self.slope).sqrt();
                let off = (distance - (self.base_radius + self.slope * height)) * per_length;
                let n = (out - self.axis * self.slope) * per_length;
                (local - n * off, n)
            }
        };
        let position = self.base + local;
        let error = point_error(position, local.length() + self.base_radius, 16);
        *surface = SurfacePoint::bare(position, error, n);
    }

    /// Where a hit is, seen from the axis.
    #[inline]
    fn around(&self, ray: &Ray, hit: &PrimHit) -> Around {
        let f = ray.origin - self.base;
        let local = f + ray.direction * hit.t;
        let height = local.dot(self.axis);
        let across = local - self.axis * height;
        let distance = across.length();
        Around {
            local,
            height,
            across,
            distance,
            out: if distance > 0.0 {
                across / distance
            } else {
                self.frame.axes(self.axis).x_axis
            },
        }
    }

    /// Any similarity makes a frustum of a frustum.
    pub(super) fn baked(&self, map: &Transform) -> Option<Self> {
        let (scale, orthogonal) = similarity(map)?;
        Some(Self {
            base: map.point_to_world(self.base),
            axis: unit_vector(orthogonal * self.axis),
            height: self.height * scale,
            base_radius: self.base_radius * scale,
            slope: self.slope,
            capped: self.capped,
            frame: self.frame.turned(self.axis, orthogonal),
        })
    }
}

impl FourLines for Frustum {
    #[inline(always)]
    fn spans<I: Isa>(&self, isa: I, rays: &FourRays<I>) -> FourSpans {
        let (p, n) = (self.base, self.axis);
        let base = [isa.splat(p.x), isa.splat(p.y), isa.splat(p.z)];
        let axis = [isa.splat(n.x), isa.splat(n.y), isa.splat(n.z)];
        let zero = isa.splat(0.0);
        // As in `axis_ray`.
        let f = sub(isa, rays.origin, base);
        let (height, climb) = (dot(isa, f, axis), dot(isa, rays.direction, axis));
        let across = sub(isa, f, scaled(isa, axis, height));
        let sideways = sub(isa, rays.direction, scaled(isa, axis, climb));
        // As in `side_span`.
        let slope = isa.splat(self.slope);
        let radius = isa.add(isa.splat(self.base_radius), isa.mul(slope, height));
        let growth = isa.mul(slope, climb);
        let a = isa.sub(dot(isa, sideways, sideways), isa.mul(growth, growth));
        let b = isa.sub(isa.mul(radius, growth), dot(isa, across, sideways));
        let spread = sub(
            isa,
            scaled(isa, across, growth),
            scaled(isa, sideways, radius),
        );
        let [ax, ay, az] = across;
        let [sx, sy, sz] = sideways;
        let turn = [
            isa.sub(isa.mul(ay, sz), isa.mul(sy, az)),
            isa.sub(isa.mul(az, sx), isa.mul(sz, ax)),
            isa.sub(isa.mul(ax, sy), isa.mul(sx, ay)),
        ];
        let twist = dot(isa, axis, turn);
        let discriminant = isa.sub(dot(isa, spread, spread), isa.mul(twist, twist));
        // The own test decides about lines steeper than the side, and along the caps.
        let level = isa.le(climb, zero) & isa.le(zero, climb);
        let mut out = FourSpans {
            known: isa.lt(zero, a) & !level,
            ..FourSpans::default()
        };
        let crossed = out.known & isa.lt(zero, discriminant);
        if crossed == 0 {
            return out;
        }
        let s = isa.sqrt(discriminant);
        let distance = isa.sqrt(dot(isa, across, across));
        let q = isa.choose_le(zero, b, isa.add(b, s), isa.sub(b, s));
        let c = isa.mul(isa.sub(distance, radius), isa.add(distance, radius));
        let (one, other) = (isa.div(c, q), isa.div(q, a));
        let first = isa.choose_le(one, other, one, other);
        let second = isa.choose_le(one, other, other, one);
        // As in `slab` and `Span::cut`.
        let low = isa.div(isa.sub(zero, height), climb);
        let high = isa.div(isa.sub(isa.splat(self.height), height), climb);
        let above = isa.choose_le(climb, zero, high, low);
        let below = isa.choose_le(climb, zero, low, high);
        let enter = isa.choose_le(above, first, first, above);
        let exit = isa.choose_le(second, below, second, below);
        out.met = crossed & isa.lt(first, second) & isa.le(above, below) & isa.lt(enter, exit);
        let (through_cap, out_of_cap) = (isa.lt(first, above), isa.lt(below, second));
        let up = isa.lt(zero, climb);
        (out.enter, out.exit) = (isa.store(enter), isa.store(exit));
        for lane in 0..LANES {
            let is = |mask: u32| mask >> lane & 1 == 1;
            let (first_cap, last_cap) = if is(up) { (BASE, APEX) } else { (APEX, BASE) };
            out.enter_facet[lane] = if is(through_cap) { first_cap } else { SIDE };
            out.exit_facet[lane] = if is(out_of_cap) { last_cap } else { SIDE };
        }
        out
    }

    #[inline]
    fn closest_within(&self, span: &Span, range: Interval) -> Option<PrimHit> {
        let is_finite = span.enter.t.is_finite() || span.exit.t.is_finite();
        self.closest_end(span, range, None).filter(|_| is_finite)
    }
}
