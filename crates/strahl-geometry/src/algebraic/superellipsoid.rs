use super::event::{self, Event, Question};
use super::gauge::{Gauge, GaugeLine};
use crate::blocks::LANES;
use crate::blocks::convex::{FourLines, FourRays, FourSpans, load, scaled};
use crate::primitives::{check_positive, point_error};
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Solid, SurfaceId, SurfacePoint,
};
use std::ops::ControlFlow;
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec3, Interval, Ray};
use strahl_simd::{Isa, select};

/// A superquadric ellipsoid about the origin: `(|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n) <= 1`.
///
/// Ellipsoids with the powers of the sphere replaced: `e` rounds the outline seen along z, `n` that of sections through the z axis. 1 and 1
/// make a sphere, small numbers a box with rounded edges, 2 an octahedron, larger ones stars. It touches the box from -1 to
/// 1 on its axes. No texture coordinates. Facets: one, 0. A ray that touches it does not hit it.
///
/// The gauge of the body (the factor by which it must grow to reach a point; see `Gauge`) is convex along rays if neither
/// number is above 2; Newton's method then comes from the outside and cannot pass the surface. Otherwise the gauge is bounded over
/// intervals until it is monotone on each. Powers are exact to about 1e-15 of the size.
///
/// A. H. Barr, "Superquadrics and angle-preserving transformations", IEEE Computer Graphics and Applications 1 (1981).
#[derive(Clone, Debug, PartialEq)]
pub struct Superellipsoid {
    e: f64,
    n: f64,
    gauge: Gauge,
    /// A cube from minus this to this is inside for certain, if the body is convex.
    core: f64,
}

/// The part of a ray in the box around the body: the point at `s` is `start + s direction`, its parameter `t + s`.
#[derive(Clone, Copy)]
struct Segment {
    start: DVec3,
    direction: DVec3,
    t: f64,
    length: f64,
}

/// Points up to this far away are known well enough to tell whether they are in the core of the body.
const NEAR: f64 = 16.0;

/// Newton's method needs a few steps, at a grazing ray one for each bit.
const MAX_STEPS: u32 = 100;

impl Superellipsoid {
    /// The body of POV-Ray's two numbers.
    pub fn new(e: f64, n: f64) -> Self {
        let gauge = Gauge::new(2.0 / e, 2.0 / n);
        Self {
            e,
            n,
            gauge,
            // The gauge grows with each coordinate, and in proportion to all of them.
            core: (1.0 - 1e-6) / gauge.at_a_corner(),
        }
    }

    /// Like [`Superellipsoid::new`], checked.
    ///
    /// # Errors
    /// A number is not finite or not positive.
    pub fn try_new(e: f64, n: f64) -> Result<Self, GeometryError> {
        let this = Self::new(e, n);
        this.validate().map(|()| this)
    }

    /// The number that shapes the outline seen along z.
    pub fn e(&self) -> f64 {
        self.e
    }

    /// The number that shapes sections through the z axis.
    pub fn n(&self) -> f64 {
        self.n
    }

    /// Whether the body is convex.
    pub(crate) fn is_convex(&self) -> bool {
        self.gauge.is_convex()
    }

    fn segment(&self, ray: &Ray, on_surface: bool) -> Option<Segment> {
        let d = ray.direction;
        if !(ray.origin.is_finite() && d.is_finite()) || d == DVec3::ZERO {
            return None;
        }
        let range = if on_surface {
            Interval::FORWARD
        } else {
            Interval::LINE
        };
        let clip = Aabb::new(DVec3::NEG_ONE, DVec3::ONE).clip(ray, range)?;
        let t = if on_surface { 0.0 } else { clip.min };
        let (start, length) = (ray.origin + d * t, clip.max - t);
        (start.is_finite() && length.is_finite()).then_some(Segment {
            start,
            direction: d,
            t,
            length,
        })
    }

    /// Reports the crossings along the ray to the visitor, until it stops.
    fn walk(
        &self,
        ray: &Ray,
        question: &Question,
        visit: &mut dyn FnMut(Event) -> ControlFlow<()>,
    ) {
        let on_surface = question.on_surface;
        let Some(segment) = self.segment(ray, on_surface) else {
            return;
        };
        if !on_surface && self.starts_in_core(ray, question.range.min) {
            // Where the ray has entered the body does not matter.
            if let Some(exit) = self.leave(1.0, &segment) {
                if visit(Event::Start { inside: true }).is_continue() {
                    // The last event.
                    let _ = self.cross(ray, segment.t + exit, false, question, visit);
                }
                return;
            }
        }
        let Segment {
            start,
            direction,
            t,
            length,
        } = segment;
        let mut line = GaugeLine {
            gauge: self.gauge,
            start,
            direction,
            level: 1.0,
            from: 0.0,
            inside: false,
        };
        if on_surface {
            let (value, slope) = self.gauge.along(start, direction);
            // The start of the ray lies on the surface: that root is removed exactly.
            line.level = value;
            line.inside = slope < 0.0;
            line.from = self.blur(slope, direction);
            let inside = line.inside;
            if visit(Event::Start { inside }).is_break() {
                return;
            }
        }
        let mut cross =
            |s: f64, enters: bool| self.cross(ray, t + s, enters, question, &mut *visit);
        // The result only matters while visiting.
        let _ = if self.gauge.is_convex() {
            self.walk_convex(&line, on_surface, &segment, &mut cross)
        } else {
            line.crossings(length, &mut cross)
        };
    }

    /// Reports a crossing.
    #[inline]
    fn cross(
        &self,
        ray: &Ray,
        t: f64,
        enters: bool,
        question: &Question,
        visit: &mut dyn FnMut(Event) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let t_error = if question.errors {
            self.t_error(ray, t)
        } else {
            0.0
        };
        visit(Event::Crossing { t, t_error, enters })
    }

    /// Whether the body is convex and contains this point of a ray so deep inside that no rounding can tell otherwise.
    #[inline]
    fn starts_in_core(&self, ray: &Ray, t: f64) -> bool {
        let way = ray.direction * t;
        let is_near = |v: DVec3| v.abs().max_element() <= NEAR;
        (ray.origin + way).abs().max_element() <= self.core
            && is_near(ray.origin)
            && is_near(way)
            && self.gauge.is_convex()
    }

    /// How far along the segment the ray leaves the body, if it is convex: the steps begin at the segment's end.
    #[inline]
    fn leave(&self, level: f64, segment: &Segment) -> Option<f64> {
        let (direction, length) = (segment.direction, segment.length);
        let end = segment.start + direction * length;
        self.approach(level, end, -direction, length)
            .map(|s| length - s)
    }

    fn walk_convex(
        &self,
        line: &GaugeLine,
        on_surface: bool,
        segment: &Segment,
        cross: &mut impl FnMut(f64, bool) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let (start, direction) = (line.start, line.direction);
        let enter = if on_surface {
            if !line.inside {
                return ControlFlow::Continue(());
            }
            0.0
        } else {
            let Some(enter) = self.approach(1.0, start, direction, segment.length) else {
                return ControlFlow::Continue(());
            };
            cross(enter, true)?;
            enter
        };
        let exit = self.leave(line.level, segment).unwrap_or(enter);
        // A chord shorter than the rounding error has no length. From the surface it ends where rounding no longer hides on
        // which side the ray is.
        let least = enter + line.from;
        cross(if exit > least { exit } else { least }, false)
    }

    /// The distance after which a ray that leaves a point of the surface at this slope is certainly off it.
    fn blur(&self, slope: f64, direction: DVec3) -> f64 {
        let error = 2.0 * self.gauge.error();
        let (straight, tangent) = (error / slope.abs(), error.sqrt() / direction.length());
        if straight < tangent {
            straight
        } else {
            tangent
        }
    }

    /// The distance from a point outside to the surface of this gauge, if it is reached within `length`.
    ///
    /// The gauge is convex: as long as it falls, Newton's steps end before the surface; once it rises, it has been missed.
    fn approach(&self, level: f64, start: DVec3, direction: DVec3, length: f64) -> Option<f64> {
        let mut s = 0.0;
        for _ in 0..MAX_STEPS {
            let point = start + direction * s;
            if self
                .gauge
                .value_without_powers(point)
                .is_some_and(|value| value <= level)
            {
                return Some(s);
            }
            let (value, slope) = self.gauge.along(point, direction);
            if value <= level {
                return Some(s);
            }
            if !(slope < 0.0) {
                return None;
            }
            let next = s + (level - value) / slope;
            if next > length {
                return None;
            }
            if next <= s {
                return Some(s);
            }
            s = next;
        }
        None
    }

    /// The error of the parameter of a crossing.
    fn t_error(&self, ray: &Ray, t: f64) -> f64 {
        let speed = ray.direction.length();
        let slope = self.gauge.along(ray.at(t), ray.direction).1.abs();
        let moved = gamma(8) * (ray.origin.length() + t.abs() * speed);
        let (straight, tangent) = (
            (self.gauge.error() + moved * (slope / speed)) / slope + moved / speed,
            (self.gauge.error() + moved).sqrt() / speed,
        );
        gamma(4) * t.abs()
            + if straight < tangent {
                straight
            } else {
                tangent
            }
    }
}

impl FourLines for Superellipsoid {
    /// Where the lines enter a convex body: the steps of [`Superellipsoid::approach`], side by side. Where they leave it is not known.
    #[inline(always)]
    fn spans<I: Isa>(&self, isa: I, rays: &FourRays<I>) -> FourSpans {
        let (mut start, mut direction) = ([[0.5; LANES]; 3], [[0.0; LANES]; 3]);
        let (mut t, mut length) = ([0.0; LANES], [0.0; LANES]);
        let (mut out, mut searching) = (FourSpans::default(), 0);
        for (lane, ray) in rays.rays(isa).iter().enumerate() {
            match self.segment(ray, false) {
                None => out.known |= 1 << lane,
                Some(segment) => {
                    searching |= 1 << lane;
                    (t[lane], length[lane]) = (segment.t, segment.length);
                    for axis in 0..3 {
                        start[axis][lane] = segment.start[axis];
                        direction[axis][lane] = segment.direction[axis];
                    }
                }
            }
        }
        let [x, y, z] = load(isa, &start);
        let direction = load(isa, &direction);
        let length = isa.load(&length);
        let (zero, level) = (isa.splat(0.0), isa.splat(1.0));
        let mut s = zero;
        for _ in 0..MAX_STEPS {
            if searching == 0 {
                break;
            }
            let step = scaled(isa, direction, s);
            let point = [
                isa.add(x, step[0]),
                isa.add(y, step[1]),
                isa.add(z, step[2]),
            ];
            let (value, slope, known) = self.gauge.along_four(isa, point, direction);
            searching &= known;
            let next = isa.add(s, isa.div(isa.sub(level, value), slope));
            let arrived = isa.le(value, level);
            let missed = !arrived & (!isa.lt(slope, zero) | isa.lt(length, next));
            let arrived = arrived | !missed & isa.le(next, s);
            out.only_enter |= searching & arrived;
            out.known |= searching & missed;
            searching &= !(arrived | missed);
            s = select(isa, searching, next, s);
        }
        out.met = out.only_enter;
        out.enter = isa.store(isa.add(isa.load(&t), s));
        out
    }
}

impl Primitive for Superellipsoid {
    fn kind(&self) -> &'static str {
        "superellipsoid"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        check_positive("first number (e) of the superellipsoid", self.e)?;
        check_positive("second number (n) of the superellipsoid", self.n)
    }

    fn wants_box(&self) -> bool {
        true
    }

    fn bounds(&self) -> Aabb {
        let reach = DVec3::splat(1.0 + 4.0 * self.gauge.error());
        Aabb::new(-reach, reach)
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
        let p = ray.at(hit.t);
        let (value, gradient) = self.gauge.value_and_gradient(p);
        // The gauge is proportional to the distance from the centre.
        let position = if value > 0.0 { p / value } else { p };
        let error = point_error(position, 1.0, 16) + DVec3::splat(2.0 * self.gauge.error());
        SurfacePoint::bare(position, error, gradient.normalize_or(DVec3::Y))
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }
}

impl Solid for Superellipsoid {
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
        self.gauge.value_and_gradient(point).0 <= 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    crate::primitive_tests!(ball, || Superellipsoid::new(1.0, 1.0));
    crate::primitive_tests!(rounded_box, || Superellipsoid::new(0.2, 0.2));
    crate::primitive_tests!(sharp_box, || Superellipsoid::new(0.1, 0.08));
    crate::primitive_tests!(rounded_cylinder, || Superellipsoid::new(1.0, 0.1));
    crate::primitive_tests!(pillow, || Superellipsoid::new(0.4, 1.4));
    crate::primitive_tests!(octahedron, || Superellipsoid::new(2.0, 2.0));
    /// All checks except those about leaving the surface: near their edges these bodies are thinner than any rounding error.
    #[test]
    fn stars_keep_most_promises() {
        for (e, n) in [(2.5, 2.5), (2.8, 0.5), (0.6, 3.0), (1.0, 2.2)] {
            let subject = crate::conformance::Subject::new(Superellipsoid::new(e, n));
            subject.is_valid();
            subject.hits_lie_on_the_surface();
            subject.normals_agree_with_neighbouring_hits();
            subject.hits_are_inside_the_bounds();
            subject.any_hit_agrees_with_closest_hit();
            subject.ranges_cut_exactly();
            subject.t_scales_with_the_direction();
            subject.crossings_alternate();
            subject.maps_change_nothing();
            subject.hostile_input_is_harmless();
        }
    }

    fn crossings(shape: &Superellipsoid, ray: &Ray) -> Vec<f64> {
        let mut out = Crossings::default();
        shape.crossings(ray, Interval::LINE, None, &mut Scratch::default(), &mut out);
        out.list.iter().map(|c| c.hit.t).collect()
    }

    #[test]
    fn rays_from_the_core_leave_where_whole_lines_do() {
        for (e, n) in [(0.05, 0.05), (1.0, 1.0), (0.3, 2.0), (2.0, 0.01)] {
            let shape = Superellipsoid::new(e, n);
            let mut from_core = 0;
            for step in 0..2000 {
                let t = f64::from(step);
                let origin = DVec3::new((t * 0.37).sin(), (t * 0.71).cos(), (t * 0.13).sin());
                let direction = DVec3::new((t * 1.1).cos(), (t * 0.9).sin(), (t * 2.3).cos());
                let ray = Ray::new(origin, direction);
                let min = (t * 1.7).sin();
                from_core += u32::from(shape.starts_in_core(&ray, min));
                let (mut line, mut part) = (Crossings::default(), Crossings::default());
                let scratch = &mut Scratch::default();
                shape.crossings(&ray, Interval::LINE, None, scratch, &mut line);
                let range = Interval::new(min, f64::INFINITY);
                shape.crossings(&ray, range, None, scratch, &mut part);
                let at = |c: &crate::Crossing| (c.hit.t, c.side, c.t_error);
                let later = line.list.iter().filter(|c| c.hit.t > min).map(at);
                assert!(later.eq(part.list.iter().map(at)), "{e} {n} {ray:?}");
                let before = line.list.iter().filter(|c| c.hit.t <= min).count();
                assert_eq!(part.inside_at_start, before == 1);
            }
            assert!(from_core > 50, "{e} {n}: {from_core}");
        }
    }

    #[test]
    fn a_sphere_is_a_superellipsoid() {
        let ray = Ray::new(DVec3::new(-5.0, 0.3, -0.4), DVec3::new(2.0, 0.0, 0.0));
        let half = f64::sqrt(1.0 - 0.25);
        let found = crossings(&Superellipsoid::new(1.0, 1.0), &ray);
        assert_eq!(found.len(), 2);
        assert!((found[0] - (5.0 - half) / 2.0).abs() < 1e-15);
        assert!((found[1] - (5.0 + half) / 2.0).abs() < 1e-15);
    }

    #[test]
    fn the_axes_end_at_one() {
        for (e, n) in [(0.1, 0.1), (1.0, 0.3), (2.0, 2.0), (3.0, 0.7), (2.5, 4.0)] {
            for axis in DVec3::AXES {
                let found = crossings(&Superellipsoid::new(e, n), &Ray::new(axis * -3.0, axis));
                assert_eq!(found, [2.0, 4.0], "{e} {n} {axis}");
            }
        }
    }

    #[test]
    fn a_ray_beside_the_centre_crosses_a_star_twice_more() {
        // Through two of the four points of the star |x|^(4/5) + |y|^(4/5) = 1 in the plane z = 0.
        let ray = Ray::new(DVec3::new(-2.0, 0.1, 0.0), DVec3::new(1.0, -0.02, 0.0));
        let star = Superellipsoid::new(2.5, 2.5);
        let found = crossings(&star, &ray);
        assert!(found.len() == 2 || found.len() == 4, "{found:?}");
        for t in found {
            let p = ray.at(t).abs();
            let power = |x| strahl_math::det::pow(x, 0.8);
            assert!((power(p.x) + power(p.y) - 1.0).abs() < 1e-12);
        }
        // Past the centre, across two neighbouring points.
        let ray = Ray::new(DVec3::new(-1.0, 2.1, 0.0), DVec3::new(1.0, -1.0, 0.0));
        assert_eq!(crossings(&star, &ray), []);
        let ray = Ray::new(DVec3::new(-1.0, 1.95, 0.0), DVec3::new(1.0, -1.0, 0.0));
        assert_eq!(crossings(&star, &ray).len(), 4);
    }

    #[test]
    fn numbers_must_be_positive() {
        for (e, n) in [(0.0, 1.0), (1.0, -1.0)] {
            assert!(matches!(
                Superellipsoid::try_new(e, n),
                Err(GeometryError::OutOfRange { .. })
            ));
        }
        assert!(matches!(
            Superellipsoid::try_new(1.0, f64::NAN),
            Err(GeometryError::NotFinite { .. })
        ));
    }
}
