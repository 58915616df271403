//! Convex bodies of revolution whose outline is made of circular arcs: eggs and lemons.

use super::convex::{End, Span};
use super::{Lemon, Ovus, point_error};
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Solid, SurfaceId, SurfacePoint,
};
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, det};

/// A part of the outline: an arc about a point on the far side of the axis, or on it, between two heights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arc {
    /// How far the centre of the arc lies beyond the axis; 0 or greater, so that the body is convex.
    pub(super) inset: f64,
    /// The height of that centre.
    pub(super) height: f64,
    pub(super) radius: f64,
    /// The heights between which the arc is the outline; infinite where the body ends with the arc.
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Arc {
    /// The square of half the distance between the points of the axis where the arc, continued, ends: the body of the arc is in the sphere
    /// about its height with this radius. A ball's is the ball itself.
    fn tip_squared(&self) -> f64 {
        (self.radius - self.inset) * (self.radius + self.inset)
    }
}

/// The body: arcs that continue each other, from below. Facets: the arcs in their order, then the caps below and above, where the
/// outline does not end on the axis.
///
/// A line crosses balls (arcs with their centres on the axis) where a quadratic equation says. For the others a convex function of the
/// place on the line is negative inside: both of its zeros are found by Newton's method, which cannot go astray from outside.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ArcBody {
    pub(super) base: DVec3,
    /// A unit vector.
    pub(super) axis: DVec3,
    /// A unit vector across it, where the texture begins.
    pub(super) first: DVec3,
    pub(super) arcs: Vec<Arc>,
    /// Whether caps are seen.
    pub(super) is_capped: bool,
}

/// Newton's method doubles the digits in each round, but near a tangent it gains one only.
const ROUNDS: u32 = 100;

/// A line in terms of the axis. The point at `s` is `start + s along`, relative to the base; its height is `height + s climb`, and the square of its
/// distance from the axis is `miss_squared + spread (s - nearest)²`.
#[derive(Clone, Copy)]
struct Course {
    /// The parameter of the ray at `s = 0`.
    t: f64,
    start: DVec3,
    along: DVec3,
    /// 1 over the square of the length of `along`.
    inverse_square: f64,
    height: f64,
    climb: f64,
    nearest: f64,
    miss_squared: f64,
    spread: f64,
}

impl Course {
    /// `None` for a direction that is zero or not finite.
    fn new(body: &ArcBody, ray: &Ray) -> Option<Self> {
        let along = ray.direction;
        let f = ray.origin - body.base;
        let inverse_square = 1.0 / along.dot(along);
        // The point next to the base, so that errors are of the size of the body and not of the distance.
        let t = -f.dot(along) * inverse_square;
        if !(t.is_finite() && inverse_square > 0.0) {
            return None;
        }
        let start = f + along * t;
        let (height, climb) = (start.dot(body.axis), along.dot(body.axis));
        let across = start - body.axis * height;
        let off = along - body.axis * climb;
        let spread = off.dot(off);
        let nearest = if spread > 0.0 {
            -across.dot(off) / spread
        } else {
            0.0
        };
        let miss = across + off * nearest;
        Some(Self {
            t,
            start,
            along,
            inverse_square,
            height,
            climb,
            nearest,
            miss_squared: miss.dot(miss),
            spread,
        })
    }

    /// The same line from its other end.
    fn reversed(&self) -> Self {
        Self {
            along: -self.along,
            climb: -self.climb,
            nearest: -self.nearest,
            ..*self
        }
    }

    /// The first place in a part of the line that is not outside of an arc.
    fn first(&self, arc: &Arc, [begin, end]: [f64; 2]) -> Option<f64> {
        let widest = arc.radius - arc.inset;
        if self.miss_squared > widest * widest {
            return None;
        }
        let tip_squared = arc.tip_squared();
        let rise = self.height - arc.height;
        let mut s = begin;
        for _ in 0..ROUNDS {
            let height = rise + self.climb * s;
            let v = self.spread * (s - self.nearest);
            let off_squared = self.miss_squared + v * (s - self.nearest);
            let off = off_squared.sqrt();
            // The square of the distance from the centre of the arc, in its half plane, less that of the radius.
            let over = height * height + off_squared + 2.0 * arc.inset * off - tip_squared;
            if over <= 0.0 {
                return Some(s);
            }
            // Half of its derivative; times `off`, to save a division.
            let (over, slope) = if off > 0.0 {
                (
                    over * off,
                    height * self.climb * off + v * (off + arc.inset),
                )
            } else {
                (over, height * self.climb)
            };
            let next = s - 0.5 * over / slope;
            if !(slope < 0.0) || next > end {
                return None;
            }
            if next <= s {
                break;
            }
            s = next;
        }
        Some(s)
    }

    /// The part of the line in the sphere around the body of an arc.
    fn sphere(&self, arc: &Arc, axis: DVec3) -> Option<[f64; 2]> {
        let f = self.start - axis * arc.height;
        let middle = -f.dot(self.along) * self.inverse_square;
        let nearest = f + self.along * middle;
        // A little larger where Newton's method begins at it.
        let larger = if arc.inset == 0.0 { 1.0 } else { 1.0 + 1e-9 };
        let square = (arc.tip_squared() * larger - nearest.dot(nearest)) * self.inverse_square;
        // Also refuses NaN.
        if !(square > 0.0) {
            return None;
        }
        let half = square.sqrt();
        Some([middle - half, middle + half])
    }
}

impl ArcBody {
    /// The distance of a point, relative to the centre of an arc on the axis, from the arc's centre in its half plane.
    fn distance(&self, arc: &Arc, p: DVec3) -> f64 {
        let height = p.dot(self.axis);
        let reach = (p - self.axis * height).length() + arc.inset;
        (reach * reach + height * height).sqrt()
    }

    /// The first place of a line that is inside, and the facet there.
    fn enter(&self, course: &Course) -> Option<End> {
        let last = self.arcs.len() - 1;
        let climbs = course.climb >= 0.0;
        // The line passes the arcs in this order.
        for place in 0..=last {
            let index = if climbs { place } else { last - place };
            let arc = &self.arcs[index];
            let (low, high) = (arc.low - course.height, arc.high - course.height);
            let [begin, end] = if course.climb == 0.0 {
                if !(low <= 0.0 && 0.0 <= high) {
                    continue;
                }
                [f64::NEG_INFINITY, f64::INFINITY]
            } else if climbs {
                [low / course.climb, high / course.climb]
            } else {
                [high / course.climb, low / course.climb]
            };
            let Some([near, far]) = course.sphere(arc, self.axis) else {
                continue;
            };
            let from = if begin > near { begin } else { near };
            let to = if end < far { end } else { far };
            if !(from <= to) {
                continue;
            }
            let s = if arc.inset == 0.0 {
                from
            } else {
                match course.first(arc, [from, to]) {
                    Some(s) => s,
                    None => continue,
                }
            };
            // Where one arc goes over into the next one is no cap.
            let is_cap = place == 0 && s == begin;
            let facet = match (is_cap, climbs) {
                (false, _) => index,
                (true, true) => last + 1,
                (true, false) => last + 2,
            };
            return Some(End {
                t: s,
                facet: facet as u32,
            });
        }
        None
    }

    /// The end of a line at which it enters the body, in parameters of the ray.
    fn near(&self, course: &Course) -> Option<End> {
        let end = self.enter(course)?;
        Some(End {
            t: course.t + end.t,
            ..end
        })
    }

    /// The end at which it leaves.
    fn far(&self, course: &Course) -> Option<End> {
        let end = self.enter(&course.reversed())?;
        Some(End {
            t: course.t - end.t,
            ..end
        })
    }

    /// The end at which a line leaves that enters at `near`. Where it only touches, rounding may hide that it leaves: right behind.
    fn far_behind(&self, course: &Course, near: End) -> End {
        match self.far(course) {
            Some(far) if far.t > near.t => far,
            _ => End {
                t: near.t.next_up(),
                ..near
            },
        }
    }

    /// Whether a facet is a cap below (-1), above (1), or an arc.
    fn cap(&self, facet: u32) -> Option<f64> {
        match facet as usize {
            k if k < self.arcs.len() => None,
            k if k == self.arcs.len() => Some(-1.0),
            _ => Some(1.0),
        }
    }

    fn normal(&self, facet: u32, p: DVec3) -> DVec3 {
        if let Some(sign) = self.cap(facet) {
            return self.axis * sign;
        }
        self.nearest(&self.arc(facet), p).1
    }

    /// The point of an arc's surface next to a point, relative to the base, and the normal there.
    fn nearest(&self, arc: &Arc, p: DVec3) -> (DVec3, DVec3) {
        let height = p.dot(self.axis);
        let across = p - self.axis * height;
        let off = across.length();
        let rise = height - arc.height;
        if !(off > 0.0) {
            let normal = self.axis * if rise < 0.0 { -1.0 } else { 1.0 };
            let tip = arc.tip_squared().max(0.0).sqrt();
            return (self.axis * arc.height + normal * tip, normal);
        }
        let outward = across / off;
        let reach = off + arc.inset;
        let inverse = 1.0 / (reach * reach + rise * rise).sqrt();
        let (reach, rise) = (reach * inverse, rise * inverse);
        let off = reach * arc.radius - arc.inset;
        let off = if off > 0.0 { off } else { 0.0 };
        (
            outward * off + self.axis * (arc.height + rise * arc.radius),
            outward * reach + self.axis * rise,
        )
    }

    fn arc(&self, facet: u32) -> Arc {
        const NONE: Arc = Arc {
            inset: 0.0,
            height: 0.0,
            radius: 0.0,
            low: 0.0,
            high: 0.0,
        };
        self.arcs.get(facet as usize).copied().unwrap_or(NONE)
    }

    /// Whether a ray that starts on a facet enters the body there; `None` if it only touches it.
    fn enters(&self, ray: &Ray, from: SurfaceId) -> Option<bool> {
        let normal = self.normal(from.facet, ray.origin - self.base);
        let slope = normal.dot(ray.direction);
        (slope.abs() > gamma(8) * ray.direction.length()).then_some(slope < 0.0)
    }

    /// The span in which a line is inside of the body. For a ray that starts on a facet, the end there is exactly at 0.
    fn span(&self, ray: &Ray, from: Option<SurfaceId>) -> Option<Span> {
        let course = Course::new(self, ray)?;
        let (enter, exit) = match from {
            None => {
                let near = self.near(&course)?;
                (near, self.far_behind(&course, near))
            }
            Some(from) => {
                let start = End {
                    t: 0.0,
                    facet: from.facet,
                };
                if self.enters(ray, from)? {
                    (start, self.far(&course)?)
                } else {
                    (self.near(&course)?, start)
                }
            }
        };
        Span::LINE.cut(enter, exit)
    }

    /// Whether an end of a span is seen.
    fn is_seen(&self, end: End) -> bool {
        self.is_capped || self.cap(end.facet).is_none()
    }

    /// The first end in the range that is seen. An end that is not needed is not computed.
    fn closest(&self, ray: &Ray, range: Interval, from: Option<SurfaceId>) -> Option<PrimHit> {
        let enters = match from {
            None => None,
            Some(from) => Some(self.enters(ray, from)?),
        };
        // A ray that leaves a convex body has it behind itself.
        if enters == Some(false) && range.min >= 0.0 {
            return None;
        }
        let hit = |end: End| {
            let counts = range.accepts(end.t) && self.is_seen(end);
            counts.then(|| PrimHit::simple(end.t, end.facet))
        };
        let course = Course::new(self, ray)?;
        if enters == Some(true) {
            let far = self.far(&course)?;
            return if far.t > 0.0 { hit(far) } else { None };
        }
        let near = self.near(&course)?;
        if enters == Some(false) {
            return if near.t < 0.0 { hit(near) } else { None };
        }
        hit(near).or_else(|| match near.t <= range.max {
            true => hit(self.far_behind(&course, near)),
            false => None,
        })
    }

    /// See [`Solid::crossings`].
    fn crossings(&self, ray: &Ray, range: Interval, from: Option<SurfaceId>, out: &mut Crossings) {
        let Some(span) = self.span(ray, from) else {
            return;
        };
        span.list(range, from, |end| self.t_error(ray, end), out);
        for crossing in &mut out.list {
            let (t, facet) = (crossing.hit.t, crossing.surface().facet);
            crossing.visible = self.is_seen(End { t, facet });
        }
    }

    /// The largest length in it.
    fn extent(&self) -> f64 {
        self.arcs.iter().fold(0.0, |most: f64, arc| {
            most.max(arc.radius + arc.inset + arc.height.abs())
        })
    }

    /// The heights of both ends.
    fn ends(&self) -> [f64; 2] {
        let tip = |arc: &Arc| arc.tip_squared().sqrt();
        let low = self.arcs.first().map_or(0.0, |arc| {
            let end = arc.height - tip(arc);
            if arc.low > end { arc.low } else { end }
        });
        let high = self.arcs.last().map_or(0.0, |arc| {
            let end = arc.height + tip(arc);
            if arc.high < end { arc.high } else { end }
        });
        [low, high]
    }

    /// The place of a hit relative to the base, on the surface, and the surface there without texture coordinates.
    fn bare_surface(&self, ray: &Ray, hit: &PrimHit) -> (DVec3, SurfacePoint) {
        let p = (ray.origin - self.base) + ray.direction * hit.t;
        let (local, normal) = match self.cap(hit.surface.facet) {
            Some(sign) => {
                let [low, high] = self.ends();
                let across = p - self.axis * p.dot(self.axis);
                let height = if sign < 0.0 { low } else { high };
                (across + self.axis * height, self.axis * sign)
            }
            None => self.nearest(&self.arc(hit.surface.facet), p),
        };
        let position = self.base + local;
        let error = point_error(position, self.extent(), 32);
        (local, SurfacePoint::bare(position, error, normal))
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let (local, bare) = self.bare_surface(ray, hit);
        let [low, high] = self.ends();
        // Longitude, and latitude as seen from halfway between the ends.
        let second = self.first.cross(self.axis);
        let around = det::atan2(local.dot(second), local.dot(self.first));
        let turn = around / std::f64::consts::TAU;
        let off = (local - self.axis * local.dot(self.axis)).length();
        let rise = local.dot(self.axis) - 0.5 * (low + high);
        let uv = DVec2::new(
            if turn < 0.0 { turn + 1.0 } else { turn },
            0.5 + det::atan2(rise, off) / std::f64::consts::PI,
        );
        SurfacePoint {
            uv: if uv.is_finite() { uv } else { DVec2::ZERO },
            ..bare
        }
    }

    /// The error of the parameter of an end: that of the point, divided by the speed at which the ray crosses the surface; near a
    /// tangent it grows to the square root.
    fn t_error(&self, ray: &Ray, end: End) -> f64 {
        let extent = self.extent();
        let p = (ray.origin - self.base) + ray.direction * end.t;
        let point = gamma(32) * (ray.origin.length() + self.base.length() + p.length() + extent);
        let across = self.normal(end.facet, p).dot(ray.direction).abs();
        let straight = point / across;
        let tangent = (2.0 * extent * point).sqrt() / ray.direction.length();
        gamma(2) * end.t.abs()
            + if straight < tangent {
                straight
            } else {
                tangent
            }
    }

    fn bounds(&self) -> Aabb {
        let [lowest, highest] = self.ends();
        let mut all = Aabb::EMPTY;
        let side = (DVec3::ONE - self.axis * self.axis).max(DVec3::ZERO);
        let side = DVec3::new(side.x.sqrt(), side.y.sqrt(), side.z.sqrt());
        for arc in &self.arcs {
            let (low, high) = (arc.low.max(lowest), arc.high.min(highest));
            let rise = arc.height.max(low).min(high) - arc.height;
            let off = (arc.radius * arc.radius - rise * rise).sqrt() - arc.inset;
            let half = side * off;
            for height in [low, high] {
                let center = self.base + self.axis * height;
                all = all.union(&Aabb::new(center - half, center + half));
            }
        }
        let largest = all.min.abs().max(all.max.abs());
        all.padded(point_error(largest, self.extent(), 64))
    }

    fn contains(&self, point: DVec3) -> bool {
        let p = point - self.base;
        let height = p.dot(self.axis);
        self.arcs.iter().any(|arc| {
            let local = p - self.axis * arc.height;
            arc.low <= height && height <= arc.high && self.distance(arc, local) <= arc.radius
        })
    }
}

/// Makes a shape with a field `body` and a method `check` a primitive.
macro_rules! made_of_arcs {
    ($shape:ident, $kind:literal) => {
        impl Primitive for $shape {
            fn kind(&self) -> &'static str {
                $kind
            }

            fn validate(&self) -> Result<(), GeometryError> {
                self.check()
            }

            fn wants_box(&self) -> bool {
                true
            }

            fn bounds(&self) -> Aabb {
                self.body.bounds()
            }

            fn closest_hit(
                &self,
                ray: &Ray,
                range: Interval,
                from: Option<SurfaceId>,
                _scratch: &mut Scratch,
            ) -> Option<PrimHit> {
                self.body.closest(ray, range, from)
            }

            fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
                self.body.surface_at(ray, hit)
            }

            fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, surface: &mut SurfacePoint) {
                *surface = self.body.bare_surface(ray, hit).1;
            }

            fn texture_uv(&self, _hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
                Some(uv)
            }

            fn as_solid(&self) -> Option<&dyn Solid> {
                Some(self)
            }
        }

        impl Solid for $shape {
            fn crossings(
                &self,
                ray: &Ray,
                range: Interval,
                from: Option<SurfaceId>,
                _scratch: &mut Scratch,
                out: &mut Crossings,
            ) {
                self.body.crossings(ray, range, from, out);
            }

            fn contains(&self, point: DVec3) -> bool {
                self.body.contains(point)
            }
        }
    };
}

made_of_arcs!(Lemon, "lemon");
made_of_arcs!(Ovus, "ovus");
