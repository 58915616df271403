use super::convex::start_of;
use super::disc::circle_bounds;
use super::frame::{UvFrame, similarity, turn};
use super::{check_direction, check_finite, check_positive, point_error, unit_vector};
use crate::{
    Crossing, Crossings, GeometryError, PrimHit, Primitive, Scratch, Shape, Side, Solid, SurfaceId,
    SurfacePoint,
};
use std::f64::consts::PI;
use std::ops::ControlFlow;
use strahl_math::error::gamma;
use strahl_math::roots::{Bernstein, Isolated, RootCount, Window, newton};
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray, Transform};

/// A torus: a tube of the minor radius around a circle of the major radius.
///
/// If the minor radius is the larger one (a *spindle* torus) the tube overlaps itself: the shape is then the body that the tube
/// sweeps, like an apple, without the lemon-shaped surface within.
///
/// Texture coordinates: `u` is the angle around the axis, `v` the angle around the tube, 0 at the outer equator and
/// growing towards the axis' tip; both run from 0 to 1. Facets: one, 0. A ray that touches the torus does not hit it.
///
/// A ray is clipped to the torus' own surroundings and measured from there, so that its distance plays no role. The roots of the
/// polynomial of degree 4 are isolated in Bernstein form and then refined on the distance from the circle, which keeps the
/// digits that the polynomial of a thin torus loses.
#[derive(Clone, Debug, PartialEq)]
pub struct Torus {
    center: DVec3,
    axis: DVec3,
    major: f64,
    minor: f64,
    frame: UvFrame,
}

/// The part of a ray near the torus: the point at `s` is `start + s along`, relative to the centre, and its parameter is
/// `t + s t_per_s`; `s` runs over `low..high`.
struct Segment {
    start: DVec3,
    along: DVec3,
    t: f64,
    t_per_s: f64,
    low: f64,
    high: f64,
}

/// A [`Segment`] seen from the axis: at `s` its height over the torus' plane is `height + s climb`, and its distance from the axis
/// is `sqrt(aside² + (way + s speed)²)`, a sum of squares without cancellation.
struct Profile {
    height: f64,
    climb: f64,
    way: f64,
    speed: f64,
    aside2: f64,
    major: f64,
    minor2: f64,
}

impl Profile {
    fn new(torus: &Torus, segment: &Segment) -> Self {
        let (p, e) = (segment.start, segment.along);
        let (height, climb) = (p.dot(torus.axis), e.dot(torus.axis));
        let (p_flat, e_flat) = (p - torus.axis * height, e - torus.axis * climb);
        let speed = e_flat.length();
        let ahead = if speed > 0.0 {
            e_flat / speed
        } else {
            DVec3::ZERO
        };
        let way = p_flat.dot(ahead);
        let aside = p_flat - ahead * way;
        Self {
            height,
            climb,
            way,
            speed,
            aside2: aside.dot(aside),
            major: torus.major,
            minor2: torus.minor * torus.minor,
        }
    }

    /// The squared distance from the circle, less the squared minor radius: negative inside.
    #[inline]
    fn value(&self, s: f64) -> f64 {
        let way = self.way + s * self.speed;
        let off = (self.aside2 + way * way).sqrt() - self.major;
        let height = self.height + s * self.climb;
        off * off + height * height - self.minor2
    }

    /// The same, and the value divided by its derivative.
    #[inline]
    fn value_and_step(&self, s: f64) -> (f64, f64) {
        let way = self.way + s * self.speed;
        let distance = (self.aside2 + way * way).sqrt();
        let off = distance - self.major;
        let height = self.height + s * self.climb;
        let value = off * off + height * height - self.minor2;
        // distance' = way speed / distance
        let slope = 2.0 * (off * way * self.speed + distance * height * self.climb);
        (value, value * distance / slope)
    }
}

/// The events along a ray, in this order.
enum Event {
    /// The ray starts on the surface, and is inside from there on or not.
    Start {
        inside: bool,
    },
    Crossing {
        t: f64,
        enters: bool,
    },
}

/// Visits the roots along a ray.
///
/// At a root the sign *may* change. Whether it does is decided between the roots, so entering and leaving alternate even if
/// rounding has lost or added a root, and the inner surface of a spindle torus, which has roots too, does not count.
struct Walk<'a, V> {
    torus: &'a Torus,
    segment: Segment,
    profile: Profile,
    on_surface: bool,
    inside: bool,
    /// The last root, until it is known whether the ray is inside behind it.
    pending: Option<f64>,
    visit: V,
}

/// The length of `s` between two roots above which a point between them can be classified before the second root is known
/// exactly.
const CLEAR: f64 = 1.0 / 64.0;

impl<V: FnMut(Event) -> ControlFlow<()>> Walk<'_, V> {
    fn run(mut self) {
        let (coefficients, error) = self.torus.polynomial(&self.segment, &self.profile);
        let Segment { low, high, .. } = self.segment;
        let flow = if self.on_surface {
            // The root at s = 0 is known: without it the polynomial is a cubic.
            let [_, c1, c2, c3, c4] = coefficients;
            // What lies behind the start doesn't matter, unless it is the inner surface of a spindle torus.
            let ring = self.torus.is_ring();
            let low = if ring { 0.0 } else { low };
            let cubic = Bernstein::from_power(&[c1, c2, c3, c4], low, high).with_error(error);
            let mut started = false;
            let mut window = Window {
                from: f64::NEG_INFINITY,
                to: f64::INFINITY,
                starts_negative: None,
            };
            let [first, .., last] = cubic.coefficients().map(|c| c >= 0.0);
            let mut is_first = ring;
            let flow = cubic.isolate_within((first, last), &mut window, &mut |part| {
                if std::mem::take(&mut is_first) {
                    // Before s = 0 the torus' polynomial has the opposite sign of the cubic.
                    self.inside = part.rising == (part.count == RootCount::Even);
                }
                let Some(s) = self.refine(part) else {
                    return ControlFlow::Continue(());
                };
                if s > 0.0 && !started {
                    started = true;
                    self.root(0.0)?;
                }
                self.root(s)
            });
            if started || flow.is_break() {
                flow
            } else {
                self.root(0.0)
            }
        } else {
            // There the segment runs from 0 to 1.
            let quartic = Bernstein::on_unit_interval(&coefficients, error);
            quartic.isolate(&mut |part| self.part(part))
        };
        if flow.is_continue() {
            // The result only matters while visiting.
            let _ = self.settle(None);
        }
    }

    /// The next interval with a root. If it is clear of the last root, its own root is computed only after the visitor has been
    /// told about the last one, and perhaps needs no more.
    fn part<const N: usize>(&mut self, part: &Isolated<N>) -> ControlFlow<()> {
        if self.pending.is_some_and(|last| part.low() - last > CLEAR) {
            self.settle(Some(part.low()))?;
        }
        self.refine(part)
            .map_or(ControlFlow::Continue(()), |s| self.root(s))
    }

    fn root(&mut self, s: f64) -> ControlFlow<()> {
        self.settle(Some(s))?;
        self.pending = Some(s);
        ControlFlow::Continue(())
    }

    /// Decides the state behind the pending root, where there is no root before `next`. Behind the last one is outside.
    fn settle(&mut self, next: Option<f64>) -> ControlFlow<()> {
        let Some(s) = self.pending.take() else {
            return ControlFlow::Continue(());
        };
        let Segment { low, high, .. } = self.segment;
        let rounding = gamma(8) * if high > -low { high } else { -low };
        let inside = match next {
            // A gap within the rounding error does not count.
            Some(next) if next - s <= rounding => self.inside,
            Some(next) => self.profile.value(0.5 * (s + next)) < 0.0,
            None => false,
        };
        let changes = std::mem::replace(&mut self.inside, inside) != inside;
        if self.on_surface && s == 0.0 {
            (self.visit)(Event::Start { inside })
        } else if changes {
            let t = self.segment.t + s * self.segment.t_per_s;
            (self.visit)(Event::Crossing { t, enters: inside })
        } else {
            ControlFlow::Continue(())
        }
    }

    /// The root in an isolating interval: found with the distance from the circle if that changes its sign there, else with the
    /// polynomial if that does.
    ///
    /// At the poles of a spindle torus outer and inner surface meet in a double root, where only the former does.
    fn refine<const N: usize>(&self, part: &Isolated<N>) -> Option<f64> {
        let (torus, profile) = (self.torus, &self.profile);
        let (low, high) = (part.low(), part.high());
        let inside = |s: f64| profile.value(s) < 0.0;
        let (first, last) = if part.count == RootCount::One && torus.is_ring() {
            // Beyond doubt, and there is no inner surface: the distance has the sign of the polynomial, also behind a known root.
            (part.rising, !part.rising)
        } else {
            (inside(low), inside(high))
        };
        if first == last {
            return (part.count != RootCount::Even).then(|| part.root());
        }
        let function = |s: f64| profile.value_and_step(s);
        Some(newton(low, high, first, part.estimate(), function))
    }
}

impl Torus {
    /// The torus of a centre, an axis of any length, and two radii.
    pub fn new(center: DVec3, axis: DVec3, major: f64, minor: f64) -> Self {
        Self {
            center,
            axis: unit_vector(axis),
            major,
            minor,
            frame: UvFrame::default(),
        }
    }

    /// Like [`Torus::new`], checked.
    ///
    /// # Errors
    /// A value is not finite, the axis is zero, or a radius is not positive.
    pub fn try_new(
        center: DVec3,
        axis: DVec3,
        major: f64,
        minor: f64,
    ) -> Result<Self, GeometryError> {
        let torus = Self::new(center, axis, major, minor);
        torus.validate().map(|()| torus)
    }

    /// The centre.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// The unit vector along the axis.
    pub fn axis(&self) -> DVec3 {
        self.axis
    }

    /// The radius of the circle in the middle of the tube.
    pub fn major(&self) -> f64 {
        self.major
    }

    /// The radius of the tube.
    pub fn minor(&self) -> f64 {
        self.minor
    }

    /// Whether the tube does not overlap itself, so that there is no inner surface.
    fn is_ring(&self) -> bool {
        self.minor < self.major
    }

    /// The squared distance of a point (relative to the centre) from the circle, less the squared minor radius, and its derivative
    /// along a direction. Negative inside.
    #[inline]
    fn value_and_slope(&self, p: DVec3, d: DVec3) -> (f64, f64) {
        let (height, climb) = (p.dot(self.axis), d.dot(self.axis));
        let across = p - self.axis * height;
        let distance = across.length();
        let outward = if distance > 0.0 {
            across.dot(d) / distance
        } else {
            0.0
        };
        let off = distance - self.major;
        (
            off * off + height * height - self.minor * self.minor,
            2.0 * (off * outward + height * climb),
        )
    }

    fn value(&self, p: DVec3) -> f64 {
        self.value_and_slope(p, DVec3::ZERO).0
    }

    /// Clips a ray to the sphere around the torus and to the slab it lies in, both a little larger than needed: outside of the
    /// segment there certainly is no surface.
    fn segment(&self, ray: &Ray, on_surface: bool) -> Option<Segment> {
        let d = ray.direction;
        let f = ray.origin - self.center;
        if !on_surface && self.is_passed(f, d) {
            return None;
        }
        let a = d.dot(d);
        // From the closest approach to the centre on, every length is of the size of the torus.
        let shift = if on_surface { 0.0 } else { -f.dot(d) / a };
        let p = f + d * shift;
        let reach = (self.major + self.minor) * MARGIN;
        let middle = -p.dot(d) / a;
        let nearest = p + d * middle;
        let half = (reach * reach - nearest.dot(nearest)) / a;
        // Also refuses NaN, infinite and zero directions.
        if !(half > 0.0 && half.is_finite()) {
            return None;
        }
        let half = half.sqrt();
        let (mut low, mut high) = (middle - half, middle + half);

        let (height, climb) = (p.dot(self.axis), d.dot(self.axis));
        let lid = self.minor * MARGIN;
        if climb == 0.0 {
            if height.abs() > lid {
                return None;
            }
        } else {
            let (t0, t1) = ((-lid - height) / climb, (lid - height) / climb);
            let (enter, exit) = if t0 < t1 { (t0, t1) } else { (t1, t0) };
            low = if enter > low { enter } else { low };
            high = if exit < high { exit } else { high };
        }
        let length = high - low;
        if !(length > 0.0) {
            return None;
        }
        // A ray that starts on the surface keeps its origin as s = 0, where the known root is.
        let base = if on_surface { 0.0 } else { low };
        Some(Segment {
            start: p + d * base,
            along: d * length,
            t: shift + base,
            t_per_s: length,
            low: (low - base) / length,
            high: (high - base) / length,
        })
    }

    /// Whether a line, given by a point relative to the centre and a direction, certainly goes through the hole of the ring: it enters and leaves the
    /// slab in which the torus lies within the cylinder that fills the hole, which is convex.
    #[inline]
    fn is_passed(&self, p: DVec3, d: DVec3) -> bool {
        let size = self.major + self.minor;
        let (height, climb) = (p.dot(self.axis), d.dot(self.axis));
        let per = 1.0 / climb;
        let (middle, half) = (-height * per, self.minor * MARGIN * per);
        let (p, d) = (p - self.axis * height, d - self.axis * climb);
        let (enter, leave) = (p + d * (middle - half), p + d * (middle + half));
        // Coordinates of this size have errors that the margin covers.
        let far = p.abs() + (d * middle).abs();
        let hole = self.major - self.minor - size * (MARGIN - 1.0);
        hole > 0.0
            && enter.length_squared() < hole * hole
            && leave.length_squared() < hole * hole
            && far.max_element() < FAR * size
    }

    /// The polynomial whose roots are the crossings: `(|p|² + R² - r²)² - 4 R² (|p|² - h²)` at `p = start + s along`, with a
    /// bound on the errors of its coefficients.
    fn polynomial(&self, segment: &Segment, profile: &Profile) -> ([f64; 5], f64) {
        let (p, e) = (segment.start, segment.along);
        let Profile {
            way, speed, aside2, ..
        } = *profile;
        let (r2, big) = (self.minor * self.minor, self.major * self.major);
        let (square, mixed) = (e.dot(e), p.dot(e));
        // (R - r)(R + r) keeps the digits of a horn torus' small difference.
        let k = p.dot(p) + (self.major - self.minor) * (self.major + self.minor);
        let coefficients = [
            k * k - 4.0 * big * (aside2 + way * way),
            4.0 * mixed * k - 8.0 * big * (way * speed),
            4.0 * mixed * mixed + 2.0 * square * k - 4.0 * big * (speed * speed),
            4.0 * square * mixed,
            square * square,
        ];
        let far = p.length() + e.length() * segment.low.abs().max(segment.high.abs());
        let q = far * far;
        let magnitude = (q + big + r2) * (q + big + r2) + 4.0 * big * q;
        (coefficients, gamma(16) * magnitude)
    }

    /// Stores the surface at a hit without texture coordinates, and returns the direction away from the axis.
    #[inline]
    fn store_outward(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) -> DVec3 {
        let p = (ray.origin - self.center) + ray.direction * hit.t;
        let height = p.dot(self.axis);
        let across = p - self.axis * height;
        let distance = across.length();
        let outward = if distance > 0.0 {
            across / distance
        } else {
            self.frame.axes(self.axis).x_axis
        };
        // From the nearest point of the circle straight to the surface.
        let n = (outward * (distance - self.major) + self.axis * height).normalize_or(outward);
        let local = outward * self.major + n * self.minor;
        let position = self.center + local;
        let error = point_error(position, self.major + self.minor, 16);
        *out = SurfacePoint::bare(position, error, n);
        outward
    }

    /// Reports the events along the ray to the visitor, until it stops.
    fn walk(&self, ray: &Ray, on_surface: bool, visit: impl FnMut(Event) -> ControlFlow<()>) {
        if let Some(segment) = self.segment(ray, on_surface) {
            Walk {
                torus: self,
                profile: Profile::new(self, &segment),
                segment,
                on_surface,
                inside: false,
                pending: None,
                visit,
            }
            .run();
        }
    }

    /// The error of the parameter of a crossing.
    fn t_error(&self, ray: &Ray, t: f64) -> f64 {
        let p = (ray.origin - self.center) + ray.direction * t;
        let size = self.major + self.minor;
        let reach = ray.origin.length() + self.center.length() + (ray.direction * t).length();
        let point = gamma(16) * (reach + size);
        let slope = self.value_and_slope(p, ray.direction).1.abs();
        let straight = 2.0 * self.minor * point / slope;
        let tangent = (2.0 * size * point).sqrt() / ray.direction.length();
        gamma(4) * t.abs()
            + if straight < tangent {
                straight
            } else {
                tangent
            }
    }
}

/// The size of the volume to which rays are clipped, relative to the torus. It only has to cover the rounding error of the
/// clipping itself.
const MARGIN: f64 = 1.0 + 1.0 / 1024.0;

/// The largest distance, relative to the torus, whose rounding errors the margin covers by far.
const FAR: f64 = 1e9;

impl Primitive for Torus {
    fn kind(&self) -> &'static str {
        "torus"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        check_finite("center of the torus", self.center)?;
        check_direction("axis of the torus", "torus", self.axis)?;
        check_positive("major radius of the torus", self.major)?;
        check_positive("minor radius of the torus", self.minor)
    }

    fn bounds(&self) -> Aabb {
        let circle = circle_bounds(self.center, self.axis, self.major);
        let size = self.major.abs() + self.minor.abs();
        let rounding = point_error(self.center.abs() + size, size, 16);
        circle.padded(DVec3::splat(self.minor.abs()) + rounding)
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let mut closest = None;
        self.walk(ray, from.is_some(), |event| match event {
            Event::Crossing { t, .. } if range.accepts(t) => {
                closest = Some(PrimHit::simple(t, 0));
                ControlFlow::Break(())
            }
            _ => ControlFlow::Continue(()),
        });
        closest
    }

    fn all_hits(
        &self,
        ray: &Ray,
        mut range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Vec<PrimHit>,
    ) {
        self.walk(ray, from.is_some(), |event| match event {
            Event::Crossing { t, .. } if range.accepts(t) => {
                range.min = t;
                out.push(PrimHit::simple(t, 0));
                ControlFlow::Continue(())
            }
            Event::Crossing { t, .. } if t > range.max => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        });
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let axes = self.frame.axes(self.axis);
        let mut bare = SurfacePoint::UNKNOWN;
        let outward = self.store_outward(ray, hit, &mut bare);
        let n = bare.n_geom;
        let (x, y) = (outward.dot(axes.x_axis), outward.dot(axes.y_axis));
        let (cos, sin) = (n.dot(outward), n.dot(self.axis));
        SurfacePoint {
            uv: DVec2::new(turn(-y, -x), turn(-sin, -cos)),
            dpdu: (axes.y_axis * x - axes.x_axis * y)
                * (2.0 * PI * (self.major + self.minor * cos)),
            dpdv: (self.axis * cos - outward * sin) * (2.0 * PI * self.minor),
            ..bare
        }
    }

    fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
        self.store_outward(ray, hit, out);
    }

    fn texture_uv(&self, _hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        Some(uv)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }

    /// Any similarity makes a torus of a torus.
    fn baked(&self, map: &Transform) -> Option<Shape> {
        let (scale, orthogonal) = similarity(map)?;
        Some(Shape::Torus(Self {
            center: map.point_to_world(self.center),
            axis: unit_vector(orthogonal * self.axis),
            major: self.major * scale,
            minor: self.minor * scale,
            frame: self.frame.turned(self.axis, orthogonal),
        }))
    }
}

impl Solid for Torus {
    /// From the distances of the box from the axis and from the plane of the circle.
    fn side_of(&self, cell: &Aabb) -> Option<bool> {
        let (middle, half) = (cell.center() - self.center, cell.size() * 0.5);
        let height = middle.dot(self.axis);
        let along = half.dot(self.axis.abs());
        let from_axis = (middle - self.axis * height).length();
        // The corners come in pairs about the middle.
        let corners = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
        let across = corners.into_iter().fold(0.0, |most: f64, (y, z)| {
            let corner = DVec3::new(half.x, y * half.y, z * half.z);
            most.max((corner - self.axis * corner.dot(self.axis)).length())
        });
        let (near, far) = (from_axis - across, from_axis + across);
        let aside = (near - self.major).max(self.major - far).max(0.0);
        let above = (height.abs() - along).max(0.0);
        let slack =
            gamma(64) * (middle.length() + half.length() + self.center.length() + self.major);
        if aside.hypot(above) > self.minor + slack {
            return Some(false);
        }
        let aside = (far - self.major).max(self.major - near);
        let above = height.abs() + along;
        (aside.hypot(above) < self.minor - slack).then_some(true)
    }

    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let start = start_of(range, from);
        self.walk(ray, from.is_some(), |event| {
            match event {
                Event::Start { inside } => out.inside_at_start = inside,
                Event::Crossing { t, enters } if t <= start => out.inside_at_start = enters,
                Event::Crossing { t, enters } if t <= range.max => {
                    let side = if enters { Side::Enter } else { Side::Exit };
                    let error = match out.without_errors {
                        true => 0.0,
                        false => self.t_error(ray, t),
                    };
                    let hit = PrimHit::simple(t, 0);
                    out.list.push(Crossing::new(hit, error, side));
                }
                Event::Crossing { .. } => return ControlFlow::Break(()),
            }
            ControlFlow::Continue(())
        });
    }

    fn contains(&self, point: DVec3) -> bool {
        self.value(point - self.center) <= 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;

    crate::primitive_tests!(lying, || Torus::new(DVec3::ZERO, DVec3::Y, 1.0, 0.25));
    crate::primitive_tests!(tilted, || Torus::new(
        DVec3::new(3.0, 1.0, -2.0),
        DVec3::new(0.4, 1.0, -0.7),
        2.0,
        0.9
    ));
    crate::primitive_tests!(thin, || Torus::new(
        DVec3::ZERO,
        DVec3::new(0.1, 0.2, 1.0),
        1.0,
        0.02
    ));
    crate::primitive_tests!(horn, || Torus::new(DVec3::ZERO, DVec3::Y, 1.0, 1.0));
    crate::primitive_tests!(spindle, || Torus::new(
        DVec3::ZERO,
        DVec3::new(1.0, 1.0, 0.0),
        0.6,
        1.0
    ));

    #[test]
    fn rays_through_the_hole_pass_and_rays_at_its_rim_hit() {
        let mut random = Random::new(11);
        let mut passed = 0;
        for n in 0..20_000 {
            let minor = [0.3, 0.9, 1e-3, 0.9989, 1.0, 1.5][n % 6];
            let center = DVec3::new(2.0, -1.0, 0.5) * [0.0, 1e4][n % 2];
            let axis = DVec3::new(random.between(-1.0, 1.0), 1.0, random.between(-1.0, 1.0));
            let torus = Torus::new(center, axis, 1.0, minor);
            let (axis, right) = (torus.axis, torus.axis.any_orthonormal_vector());
            let out =
                right * random.between(-1.0, 1.0) + axis.cross(right) * random.between(-1.0, 1.0);
            let out = out.normalize_or(right);
            // From far outside of the rim to far inside, mostly near to it.
            let off = random.between(-1.0, 1.0) * 10_f64.powf(random.between(-6.0, 0.0));
            let at = out * ((1.0 - minor) * (1.0 + off)) + axis * random.between(-0.1, 0.1);
            let tilt = DVec3::new(1.0, 0.0, 1.0) * random.between(-0.3, 0.3);
            let direction = (axis + tilt) * [1.0, 1e-3, -50.0][n % 3];
            let origin = center + at - direction * random.between(0.5, 1e5);
            let ray = Ray::new(origin, direction);
            if !torus.is_passed(ray.origin - center, direction) {
                continue;
            }
            passed += 1;
            assert!(crossings(&torus, &ray).is_empty());
            let middle = -(origin - center).dot(axis) / direction.dot(axis);
            let reach = 2.0 / direction.dot(axis).abs();
            for step in -500..=500 {
                let t = middle + reach * f64::from(step) / 500.0;
                let value = torus.value(ray.at(t) - center);
                assert!(value > 0.0, "{torus:?} {ray:?} {t}: {value}");
            }
        }
        assert!(passed > 200, "{passed}");
    }

    fn crossings(torus: &Torus, ray: &Ray) -> Vec<f64> {
        let mut out = Crossings::default();
        torus.crossings(ray, Interval::LINE, None, &mut Scratch::default(), &mut out);
        out.list.iter().map(|c| c.hit.t).collect()
    }

    fn close(found: &[f64], expected: &[f64]) -> bool {
        found.len() == expected.len()
            && found
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-14)
    }

    #[test]
    fn four_two_and_no_crossings() {
        let torus = Torus::new(DVec3::ZERO, DVec3::Y, 1.0, 0.25);
        let through_both_tubes = crossings(&torus, &Ray::new(DVec3::new(-2.0, 0.0, 0.0), DVec3::X));
        assert!(
            close(&through_both_tubes, &[0.75, 1.25, 2.75, 3.25]),
            "{through_both_tubes:?}"
        );
        let from_above = crossings(&torus, &Ray::new(DVec3::new(1.0, 3.0, 0.0), -DVec3::Y));
        assert!(close(&from_above, &[2.75, 3.25]), "{from_above:?}");
        assert_eq!(
            crossings(&torus, &Ray::new(DVec3::Y * 3.0, -DVec3::Y)),
            [],
            "through the hole"
        );
        assert_eq!(
            crossings(&torus, &Ray::new(DVec3::new(-2.0, 0.26, 0.0), DVec3::X)),
            [],
            "above"
        );
    }

    #[test]
    fn a_spindle_torus_has_no_surface_within() {
        let torus = Torus::new(DVec3::ZERO, DVec3::Y, 0.6, 1.0);
        let across = crossings(&torus, &Ray::new(DVec3::new(-3.0, 0.0, 0.0), DVec3::X));
        assert!(close(&across, &[1.4, 4.6]), "{across:?}");
        assert!(torus.contains(DVec3::ZERO));
        let along_the_axis = crossings(&torus, &Ray::new(DVec3::Y * 3.0, -DVec3::Y));
        assert!(close(&along_the_axis, &[2.2, 3.8]), "{along_the_axis:?}");
    }

    #[test]
    fn distance_does_not_cost_digits_of_the_shape() {
        let torus = Torus::new(DVec3::ZERO, DVec3::Y, 1.0, 1e-3);
        for distance in [1e1, 1e3, 1e5, 1e7] {
            let ray = Ray::new(DVec3::new(-distance, 0.0, 0.0), DVec3::X);
            let hit = torus.closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default());
            let error = hit.map_or(1.0, |hit| (hit.t - (distance - 1.001)).abs());
            assert!(
                error <= distance * 2.0 * f64::EPSILON,
                "{distance}: {error}"
            );
        }
    }

    #[test]
    fn a_start_on_the_surface_sees_the_other_crossings() {
        let torus = Torus::new(DVec3::ZERO, DVec3::Y, 1.0, 0.25);
        let from = Some(SurfaceId {
            element: 0,
            facet: 0,
        });
        let ray = Ray::new(DVec3::new(-1.25, 0.0, 0.0), DVec3::X);
        let mut out = Crossings::default();
        torus.crossings(
            &ray,
            Interval::FORWARD,
            from,
            &mut Scratch::default(),
            &mut out,
        );
        assert!(out.inside_at_start);
        let found: Vec<_> = out.list.iter().map(|c| c.hit.t).collect();
        assert!(close(&found, &[0.5, 2.0, 2.5]), "{found:?}");
        let outward = Ray::new(DVec3::new(-1.25, 0.0, 0.0), -DVec3::X);
        assert!(
            torus
                .closest_hit(&outward, Interval::FORWARD, from, &mut Scratch::default())
                .is_none()
        );
    }

    #[test]
    fn impossible_tori_are_refused() {
        let torus = |axis, major, minor| Torus::try_new(DVec3::ZERO, axis, major, minor);
        assert!(matches!(
            torus(DVec3::ZERO, 1.0, 0.5),
            Err(GeometryError::Degenerate { .. })
        ));
        assert!(matches!(
            torus(DVec3::X, 0.0, 0.5),
            Err(GeometryError::OutOfRange { .. })
        ));
        assert!(matches!(
            torus(DVec3::X, 1.0, -0.5),
            Err(GeometryError::OutOfRange { .. })
        ));
        assert!(matches!(
            torus(DVec3::X, f64::NAN, 0.5),
            Err(GeometryError::NotFinite { .. })
        ));
        assert!(torus(DVec3::X, 0.5, 1.0).is_ok());
    }
}
