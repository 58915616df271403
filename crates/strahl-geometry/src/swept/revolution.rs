use super::curve::Piece;
use super::meridian::{Arc, ArcPoint, Meridian};
use super::runs::Rect;
use super::spans::{WholeLine, snap};
use crate::primitives::{point_error, turn};
use crate::{Crossing, Crossings, PrimHit, Side, SurfaceId, SurfacePoint};
use std::f64::consts::TAU;
use strahl_math::error::gamma;
use strahl_math::roots::find_root;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray};

/// A meridian rotated about the y axis.
///
/// In the half-plane of radius and height a line is one branch of a hyperbola. With the distance `m` of the line from the axis
/// and `h` along its horizontal part, counted from the place nearest to the axis, a point of the meridian is on it where
/// `h = ±q`, `q = sqrt(r² - m²)`, is where the line has the same height: two functions of the meridian's parameter, one for each half of the
/// line. Neither has the double roots that their product has for level rays, the polynomial of degree 6 of other ray tracers.
/// As radius and height are monotone on every arc, both functions are bounded by their values at the ends of an
/// interval, and their slopes by a few products: bisection finds all roots, with certainty and mostly at once.
///
/// The side of the line on which a joint of two arcs lies is decided by the same numbers for both, so entering and leaving
/// alternate despite rounding.
///
/// Hits have `uv = [s, side]`: the parameter on the arc, and 1 if the outer side is the right of the curve, else -1.
pub(super) struct Revolution<'a>(pub(super) &'a Meridian);

/// A line in the half-plane of the meridian.
struct Line {
    ray: Ray,
    /// Horizontal speed.
    speed: f64,
    /// The position of the origin along the horizontal part.
    start: f64,
    /// The squared distance from the axis.
    m2: f64,
}

/// A point of an arc as a line sees it.
#[derive(Clone, Copy)]
struct Sample {
    s: f64,
    y: f64,
    /// The height over the line, as [`Line::level`] says.
    level: f64,
    /// The distance along the horizontal part from the point nearest to the axis.
    q: f64,
}

impl Sample {
    /// The function whose roots are searched, for the half of the line with this [`Half::climb`].
    #[inline]
    fn value(&self, half: Half) -> f64 {
        self.level - half.climb * self.q
    }

    #[inline]
    fn sign(&self, half: Half) -> bool {
        self.value(half) >= 0.0
    }
}

/// One half of a line.
#[derive(Clone, Copy)]
struct Half {
    /// 1 or -1.
    sign: f64,
    /// The vertical speed away from the place nearest to the axis.
    climb: f64,
}

impl Line {
    fn new(ray: &Ray) -> Self {
        let flat = |v: DVec3| DVec2::new(v.x, v.z);
        let (o, d) = (flat(ray.origin), flat(ray.direction));
        let speed = d.length();
        // A vertical line may be taken to lie in any plane; the one through the axis is best.
        let ahead = if speed > 0.0 {
            d / speed
        } else {
            o.try_normalize().unwrap_or(DVec2::X)
        };
        let m = ahead.perp_dot(o);
        Self {
            ray: *ray,
            speed,
            start: ahead.dot(o),
            m2: m * m,
        }
    }

    /// The height over the line times its horizontal speed, but for the part that depends on `q`.
    fn level(&self, y: f64) -> f64 {
        self.speed * (y - self.ray.origin.y) + self.ray.direction.y * self.start
    }

    fn q(&self, square: f64) -> f64 {
        let q2 = square - self.m2;
        if q2 > 0.0 { q2.sqrt() } else { 0.0 }
    }

    /// Whether the line may pass through a ring of this box.
    fn meets(&self, rect: &Rect) -> bool {
        if rect.max.x < self.m2 {
            return false;
        }
        let dy = self.ray.direction.y;
        let (near, far) = (self.q(rect.min.x) * dy, self.q(rect.max.x) * dy);
        let (low, high) = (self.level(rect.min.y), self.level(rect.max.y));
        let tallest = rect.min.y.abs() + rect.max.y.abs() + self.ray.origin.y.abs();
        let slack = gamma(16) * (self.speed * tallest + (dy * self.start).abs() + far.abs());
        let overlaps = |a: f64, b: f64| {
            let (a, b) = if a < b { (a, b) } else { (b, a) };
            low <= b + slack && a - slack <= high
        };
        overlaps(near, far) || overlaps(-near, -far)
    }

    #[inline]
    fn sample(&self, s: f64, point: ArcPoint) -> Sample {
        Sample {
            s,
            y: point.y,
            level: self.level(point.y),
            q: self.q(point.square),
        }
    }

    /// All crossings with an arc: parameter, half of the line, whether the value rises.
    #[inline]
    fn roots(&self, arc: &Arc, visit: &mut impl FnMut(f64, f64, bool)) {
        let (first, last) = (arc.start(), arc.end());
        let within = |point: ArcPoint| point.square >= self.m2;
        let (mut low, mut high) = ((0.0, first), (1.0, last));
        match (within(first), within(last)) {
            (false, false) => return,
            (true, true) => {}
            (outer, _) => {
                // Points closer to the axis than the line don't matter.
                let s = find_root(0.0, 1.0, !outer, f64::NAN, |s| {
                    let (point, slope) = arc.at_with_slope(s);
                    (point.square - self.m2, slope.square)
                });
                let point = ArcPoint {
                    square: self.m2,
                    ..arc.at(s)
                };
                if outer {
                    high = (s, point);
                } else {
                    low = (s, point);
                }
            }
        }
        let (a, b) = (self.sample(low.0, low.1), self.sample(high.0, high.1));
        let dy = self.ray.direction.y;
        // The rounding error of the terms of the value.
        let tallest = a.y.abs() + b.y.abs() + self.ray.origin.y.abs();
        let widest = a.q + b.q + self.start.abs();
        let noise = gamma(16) * (self.speed * tallest + dy.abs() * widest);
        for sign in [1.0, -1.0] {
            let climb = sign * dy;
            self.search(arc, Half { sign, climb }, &a, &b, noise, visit);
        }
    }

    fn search(
        &self,
        arc: &Arc,
        half: Half,
        a: &Sample,
        b: &Sample,
        noise: f64,
        visit: &mut impl FnMut(f64, f64, bool),
    ) {
        let change = a.sign(half) != b.sign(half);
        if !change {
            // The two parts of the value are both monotone.
            let (low, high) = sorted(a.level, b.level);
            let (least, most) = sorted(half.climb * a.q, half.climb * b.q);
            if low > most || high < least {
                return;
            }
        }
        let [low, high] = self.slopes(arc, half, a, b);
        if low >= 0.0 || high <= 0.0 {
            if change {
                visit(self.refine(arc, half, a, b), half.sign, b.sign(half));
            }
            return;
        }
        let s = 0.5 * (a.s + b.s);
        let steepest = if -low > high { -low } else { high };
        // If the change in between is less than the rounding error, only the ends count. (NaN compares as less, too.)
        let worth = steepest * (b.s - a.s) > noise;
        if !(worth && a.s < s && s < b.s) {
            if change {
                visit(s, half.sign, b.sign(half));
            }
            return;
        }
        let middle = self.sample(s, arc.at(s));
        if !change && middle.value(half).abs() > steepest * (b.s - a.s) * 0.5 {
            return;
        }
        self.search(arc, half, a, &middle, noise, visit);
        self.search(arc, half, &middle, b, noise, visit);
    }

    /// Bounds of the slope of the value between two samples.
    #[inline]
    fn slopes(&self, arc: &Arc, half: Half, a: &Sample, b: &Sample) -> [f64; 2] {
        let dy = arc.dy_range(a.s, b.s).map(|dy| dy * self.speed);
        if half.climb == 0.0 {
            return dy;
        }
        // q' = (r²)' / 2q.
        let (near, far) = sorted(a.q, b.q);
        let dq = arc.d_square_range(a.s, b.s);
        let over = |slope: f64, small: f64, large: f64| {
            if slope == 0.0 {
                0.0
            } else {
                slope / (2.0 * if slope > 0.0 { large } else { small })
            }
        };
        let dq = [over(dq[0], near, far), over(dq[1], far, near)];
        let (least, most) = sorted(half.climb * dq[0], half.climb * dq[1]);
        [dy[0] - most, dy[1] - least]
    }

    /// The root between two samples of different signs, between which the value is monotone.
    fn refine(&self, arc: &Arc, half: Half, a: &Sample, b: &Sample) -> f64 {
        let guess = self.straight_root(arc, half, a, b).unwrap_or_else(|| {
            let (from, to) = (a.value(half), b.value(half));
            a.s + (b.s - a.s) * (from / (from - to))
        });
        find_root(a.s, b.s, b.sign(half), guess, |s| {
            let (point, slope) = arc.at_with_slope(s);
            let sample = self.sample(s, point);
            // If q is 0 the slope is NaN, and the interval is halved.
            let dq = half.climb * (slope.square / (2.0 * sample.q));
            (sample.value(half), slope.y * self.speed - dq)
        })
    }

    /// The root as far as a formula gives it, for straight arcs: the line crosses a cone, `level² = dy²·q²`.
    #[inline]
    fn straight_root(&self, arc: &Arc, half: Half, a: &Sample, b: &Sample) -> Option<f64> {
        let (Piece::Line([x0, x1]), Piece::Line([y0, y1])) = (arc.x, arc.y) else {
            return None;
        };
        if arc.is_squared() {
            return None;
        }
        let (level, rise) = (self.level(y0), self.speed * (y1 - y0));
        let (wide, grow) = (half.climb * x0, half.climb * (x1 - x0));
        let m = half.climb * half.climb * self.m2;
        // rise·s + level is squared on one side, grow·s + wide on the other.
        let square = rise * rise - grow * grow;
        let linear = rise * level - grow * wide;
        let constant = level * level - wide * wide + m;
        let root = (linear * linear - square * constant).sqrt();
        let sum = -(linear + if linear < 0.0 { -root } else { root });
        let is_here =
            |s: &f64| a.s < *s && *s < b.s && ((level + rise * s) * half.climb).is_sign_positive();
        [sum / square, constant / sum].into_iter().find(is_here)
    }

    /// The ray's parameter at a point of the meridian that is on the line.
    fn parameter(&self, half: f64, point: ArcPoint) -> f64 {
        let dy = self.ray.direction.y;
        if dy.abs() > self.speed {
            (point.y - self.ray.origin.y) / dy
        } else {
            (half * self.q(point.square) - self.start) / self.speed
        }
    }
}

fn sorted(a: f64, b: f64) -> (f64, f64) {
    if a < b { (a, b) } else { (b, a) }
}

impl Revolution<'_> {
    pub(super) fn bounds(&self) -> Aabb {
        let Rect { min, max } = self.0.runs.bounds();
        let r = max.x.sqrt();
        Aabb::new(DVec3::new(-r, min.y, -r), DVec3::new(r, max.y, r))
    }

    fn arc(&self, hit: &PrimHit) -> Option<&Arc> {
        self.0.arcs.get(hit.surface.facet as usize)
    }

    /// The direction away from the axis at a hit (x, z).
    fn outward(ray: &Ray, hit: &PrimHit) -> DVec2 {
        let at = ray.at(hit.t);
        let flat = DVec2::new(at.x, at.z);
        let largest = flat.abs().max_element();
        if largest > 0.0 && largest.is_finite() {
            (flat / largest).normalize()
        } else {
            DVec2::X
        }
    }

    /// The surface at a hit, with texture coordinates: `u` once around the axis, `v` as the arc says.
    pub(super) fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let outward = Self::outward(ray, hit);
        let [s, _] = hit.uv;
        let arc = self.arc(hit);
        let (r, y) = arc.map_or((0.0, 0.0), |arc| (arc.radius(s), arc.y.at(s)));
        let position = DVec3::new(outward.x * r, y, outward.y * r);
        let extent = self.bounds().max_abs();
        let normal = self.normal(ray, hit);
        let bare = SurfacePoint::bare(position, point_error(position, extent, 32), normal);
        let Some(arc) = arc else { return bare };
        let [from, to] = arc.v;
        let right = arc.right(s);
        // Along the curve, per unit of `v`.
        let along = DVec2::new(-right.y, right.x);
        let scale = if from == to { 0.0 } else { 1.0 / (to - from) };
        let speed = if arc.is_squared() && r > 0.0 {
            0.5 / r
        } else {
            1.0
        };
        let along = along * (scale * speed);
        SurfacePoint {
            uv: DVec2::new(turn(outward.y, outward.x), from + (to - from) * s),
            dpdu: DVec3::new(-outward.y, 0.0, outward.x) * (TAU * r),
            dpdv: DVec3::new(outward.x * along.x, along.y, outward.y * along.x),
            ..bare
        }
    }

    /// Whether a line away from the axis crosses the meridian an odd number of times.
    pub(super) fn contains(&self, point: DVec3) -> bool {
        let square = point.x * point.x + point.z * point.z;
        let mut inside = false;
        self.0.runs.visit(
            |rect| rect.max.x >= square && rect.min.y <= point.y && point.y <= rect.max.y,
            |index| {
                let Some(arc) = self.0.arcs.get(index) else {
                    return;
                };
                if (arc.y.start() >= point.y) != (arc.y.end() >= point.y) {
                    inside ^= arc.at(arc.at_height(point.y)).square > square;
                }
            },
        );
        inside
    }
}

impl WholeLine for Revolution<'_> {
    fn walk(&self, ray: &Ray, from: Option<SurfaceId>, list: &mut Crossings) {
        let (o, d) = (ray.origin, ray.direction);
        if !(o.is_finite() && d.is_finite())
            || d == DVec3::ZERO
            || self.bounds().clip(ray, Interval::LINE).is_none()
        {
            return;
        }
        let line = Line::new(ray);
        self.0.runs.visit(
            |rect| line.meets(rect),
            |index| {
                let Some(arc) = self.0.arcs.get(index) else {
                    return;
                };
                line.roots(arc, &mut |s, half, rising| {
                    let t = line.parameter(half, arc.at(s));
                    // The slope of the value has the sign of the approach to the right side, on the other half the other one.
                    let approach = if rising { half } else { -half };
                    let surface = SurfaceId {
                        element: 0,
                        facet: index as u32,
                    };
                    let uv = [s, approach];
                    let hit = PrimHit { t, surface, uv };
                    let mut crossing = Crossing::new(hit, 0.0, Side::Inner);
                    crossing.visible = arc.visible;
                    list.list.push(crossing);
                });
            },
        );
        if let Some(from) = from {
            let run = |facet: u32| self.0.smooth.get(facet as usize);
            let near = |hit: &PrimHit| {
                (run(hit.surface.facet) == run(from.facet)).then(|| self.normal(ray, hit))
            };
            let size = self.bounds().size().max_element();
            snap(&mut list.list, ray, size, near);
        }
        list.list.sort_unstable_by(|a, b| {
            let facets = || a.hit.surface.facet.cmp(&b.hit.surface.facet);
            a.hit.t.total_cmp(&b.hit.t).then_with(facets)
        });
        let mut inside = false;
        for crossing in &mut list.list {
            inside = !inside;
            let [_, approach] = crossing.hit.uv;
            // Entering goes against the outer side.
            crossing.hit.uv[1] = if inside { -approach } else { approach };
            crossing.side = if inside { Side::Enter } else { Side::Exit };
        }
        list.list.retain(|crossing| crossing.hit.t.is_finite());
    }

    fn normal(&self, ray: &Ray, hit: &PrimHit) -> DVec3 {
        let Some(arc) = self.arc(hit) else {
            return DVec3::Y; // A hit of another shape.
        };
        let [s, side] = hit.uv;
        let right = arc.right(s) * side;
        let outward = Self::outward(ray, hit) * right.x;
        DVec3::new(outward.x, right.y, outward.y).normalize_or(DVec3::Y)
    }

    fn reach(&self) -> f64 {
        self.bounds().max_abs()
    }
}
