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

/// The body: arcs that continue each other, from below. Facets: the arcs in their order, then the caps below and above, where the
/// outline does not end on the axis.
///
/// Along a line, the distance from the centre of an arc (in the half plane of the outline) is a convex function: both of its
/// crossings with the radius are found by Newton's method, which cannot go astray from outside.
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

/// A part of a line near an arc: the point at `s` is `start + s along`, relative to the centre of the arc on the axis.
struct Chord {
    start: DVec3,
    along: DVec3,
    t: f64,
    half: f64,
}

impl ArcBody {
    /// The distance of a point, relative to the centre of an arc on the axis, from the arc's centre in its half plane; with its
    /// derivative along a direction.
    fn distance(&self, arc: &Arc, p: DVec3, d: DVec3) -> (f64, f64) {
        let (height, climb) = (p.dot(self.axis), d.dot(self.axis));
        let across = p - self.axis * height;
        let off = across.length();
        let outward = if off > 0.0 { across.dot(d) / off } else { 0.0 };
        let reach = off + arc.inset;
        let distance = (reach * reach + height * height).sqrt();
        (distance, (reach * outward + height * climb) / distance)
    }

    /// The first point of a part of a chord that is not outside of an arc. `side` is 1 from the beginning of the part, -1 from its end.
    fn first(&self, arc: &Arc, chord: &Chord, part: [f64; 2], side: f64) -> Option<f64> {
        let [begin, end] = part;
        let (mut s, end) = if side > 0.0 {
            (begin, end)
        } else {
            (-end, -begin)
        };
        let d = chord.along * side;
        for _ in 0..ROUNDS {
            let (distance, slope) = self.distance(arc, chord.start + d * s, d);
            let over = distance - arc.radius;
            if over <= 0.0 {
                return Some(s * side);
            }
            let next = s - over / slope;
            if !(slope < 0.0) || next > end {
                return None;
            }
            if next <= s {
                return Some(s * side);
            }
            s = next;
        }
        Some(s * side)
    }

    fn chord(&self, arc: &Arc, ray: &Ray) -> Option<Chord> {
        let d = ray.direction;
        let f = (ray.origin - self.base) - self.axis * arc.height;
        let t = -f.dot(d) / d.dot(d);
        let start = f + d * t;
        // The sphere around the body of the arc, a little larger.
        let square = (arc.radius - arc.inset) * (arc.radius + arc.inset) * (1.0 + 1e-9);
        let half = ((square - start.dot(start)) / d.dot(d)).sqrt();
        // Also refuses NaN, infinite and zero directions.
        (half > 0.0 && half.is_finite()).then_some(Chord {
            start,
            along: d,
            t,
            half,
        })
    }

    /// The span of a chord that is inside of an arc and between its heights. Newton's method begins at these heights: where the line is inside already,
    /// it ends there.
    fn part(&self, arc: &Arc, chord: &Chord, facet: u32, caps: u32) -> Option<Span> {
        let height = chord.start.dot(self.axis) + arc.height;
        let climb = chord.along.dot(self.axis);
        let slab = if climb == 0.0 {
            if !(arc.low <= height && height <= arc.high) {
                return None;
            }
            [(f64::NEG_INFINITY, facet), (f64::INFINITY, facet)]
        } else {
            let low = ((arc.low - height) / climb, caps);
            let high = ((arc.high - height) / climb, caps + 1);
            if climb > 0.0 {
                [low, high]
            } else {
                [high, low]
            }
        };
        let [(enter, enter_facet), (exit, exit_facet)] = slab;
        let begin = if enter > -chord.half {
            enter
        } else {
            -chord.half
        };
        let end = if exit < chord.half { exit } else { chord.half };
        if !(begin <= end) {
            return None;
        }
        let near = self.first(arc, chord, [begin, end], 1.0)?;
        let far = self.first(arc, chord, [begin, end], -1.0)?;
        let at = |s: f64, slab: f64, slab_facet: u32| End {
            t: chord.t + s,
            facet: if s == slab { slab_facet } else { facet },
        };
        Span::LINE.cut(at(near, enter, enter_facet), at(far, exit, exit_facet))
    }

    /// The span in which a line is inside.
    fn line(&self, ray: &Ray) -> Option<Span> {
        let mut whole: Option<Span> = None;
        let caps = self.arcs.len() as u32;
        for (facet, arc) in self.arcs.iter().enumerate() {
            let facet = facet as u32;
            let Some(chord) = self.chord(arc, ray) else {
                continue;
            };
            let Some(part) = self.part(arc, &chord, facet, caps) else {
                continue;
            };
            whole = Some(match whole {
                None => part,
                Some(so_far) => Span {
                    enter: if part.enter.t < so_far.enter.t {
                        part.enter
                    } else {
                        so_far.enter
                    },
                    exit: if part.exit.t > so_far.exit.t {
                        part.exit
                    } else {
                        so_far.exit
                    },
                },
            });
        }
        whole
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
        let arc = self.arc(facet);
        let height = p.dot(self.axis) - arc.height;
        let across = p - self.axis * p.dot(self.axis);
        let outward = across.normalize_or_zero();
        let normal = outward * (across.length() + arc.inset) + self.axis * height;
        normal.normalize_or(self.axis)
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

    /// The span in which a line is inside of the body. For a ray that starts on a facet, the end there is exactly at 0.
    fn span(&self, ray: &Ray, from: Option<SurfaceId>) -> Option<Span> {
        let span = self.line(ray)?;
        let Some(from) = from else { return Some(span) };
        let start = End {
            t: 0.0,
            facet: from.facet,
        };
        let normal = self.normal(from.facet, ray.origin - self.base);
        let slope = normal.dot(ray.direction);
        if slope.abs() <= gamma(8) * ray.direction.length() {
            return None;
        }
        let span = if slope < 0.0 {
            Span {
                enter: start,
                ..span
            }
        } else {
            Span {
                exit: start,
                ..span
            }
        };
        (span.enter.t < span.exit.t).then_some(span)
    }

    /// Whether an end of a span is seen.
    fn is_seen(&self, end: End) -> bool {
        self.is_capped || self.cap(end.facet).is_none()
    }

    /// The first end in the range that is seen.
    fn closest(&self, ray: &Ray, range: Interval, from: Option<SurfaceId>) -> Option<PrimHit> {
        let span = self.span(ray, from)?;
        let hit = |end: End| {
            let starts = from.is_some_and(|from| end.t == 0.0 && from.facet == end.facet);
            let counts = range.accepts(end.t) && self.is_seen(end) && !starts;
            counts.then(|| PrimHit::simple(end.t, end.facet))
        };
        hit(span.enter).or_else(|| hit(span.exit))
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
        let tip = |arc: &Arc| ((arc.radius - arc.inset) * (arc.radius + arc.inset)).sqrt();
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
        let height = p.dot(self.axis);
        let across = p - self.axis * height;
        let [low, high] = self.ends();
        let local = match self.cap(hit.surface.facet) {
            Some(sign) => across + self.axis * if sign < 0.0 { low } else { high },
            None => {
                let arc = self.arc(hit.surface.facet);
                let off = across.length();
                let (reach, rise) = (off + arc.inset, height - arc.height);
                let scale = arc.radius / (reach * reach + rise * rise).sqrt();
                let off = reach * scale - arc.inset;
                let off = if off > 0.0 { off } else { 0.0 };
                across.normalize_or_zero() * off + self.axis * (arc.height + rise * scale)
            }
        };
        let position = self.base + local;
        let normal = self.normal(hit.surface.facet, p);
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
            arc.low <= height
                && height <= arc.high
                && self.distance(arc, local, DVec3::ZERO).0 <= arc.radius
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
