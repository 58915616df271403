//! A straight line in the half-plane of radius and height.

use super::curve::Piece;
use super::meridian::{Arc, ArcPoint, Meridian};
use super::runs::Rect;
use super::sextic::{Factors, Roots, Sextic, Single, Terms};
use strahl_math::error::gamma;
use strahl_math::roots::{find_root, newton};
use strahl_math::{DVec2, DVec3, Ray};

/// A line in the half-plane of the meridian.
pub(super) struct Line {
    ray: Ray,
    /// Horizontal speed.
    speed: f64,
    /// The position of the origin along the horizontal part.
    start: f64,
    /// The squared distance from the axis.
    m2: f64,
    /// The height in the middle of the meridian.
    middle: f64,
    /// [`Line::level`] there.
    base: f64,
    factors: Factors,
}

/// A point of an arc as a line sees it.
#[derive(Clone, Copy)]
struct Sample {
    s: f64,
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

/// A crossing of a line with an arc.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    pub(super) place: Place,
    /// 1 if the line passes to the right of the curve, else -1.
    pub(super) approach: f64,
}

/// Where a line crosses an arc.
#[derive(Clone, Copy, Debug)]
pub(super) enum Place {
    /// At a parameter of the arc, on this half of the line.
    At { s: f64, half: f64 },
    /// Somewhere in a part.
    Within(Single),
}

impl Half {
    /// A crossing in front of a sample: the slope of the value has the sign of the approach to the right side, on the other half the
    /// other one.
    fn meeting(&self, s: f64, behind: &Sample) -> Meeting {
        let half = self.sign;
        Meeting {
            place: Place::At { s, half },
            approach: if behind.sign(*self) { half } else { -half },
        }
    }
}

impl Line {
    pub(super) fn new(ray: &Ray, meridian: &Meridian) -> Self {
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
        let (m2, start, dy) = (m * m, ahead.dot(o), ray.direction.y);
        let middle = meridian.middle;
        let base = speed * (middle - ray.origin.y) + dy * start;
        let [tallest, widest] = meridian.reach;
        let (far, dy2) = (speed * tallest + base.abs(), dy * dy);
        let factors = Factors {
            height2: speed * speed,
            height: 2.0 * speed * base,
            radius2: dy2,
            constant: base * base + dy2 * m2,
            error: gamma(64) * (far * far + dy2 * (m2 + widest)) + f64::MIN_POSITIVE,
        };
        Self {
            ray: *ray,
            speed,
            start,
            m2,
            middle,
            base,
            factors,
        }
    }

    /// The height over the line times its horizontal speed, but for the part that depends on `q`.
    #[inline]
    fn level(&self, y: f64) -> f64 {
        self.speed * (y - self.middle) + self.base
    }

    fn q(&self, square: f64) -> f64 {
        let q2 = square - self.m2;
        if q2 > 0.0 { q2.sqrt() } else { 0.0 }
    }

    /// Whether the line may pass through a ring of this box: whether somewhere in it `level² = dy²·q²`.
    #[inline]
    pub(super) fn meets(&self, rect: &Rect) -> bool {
        let (low, high) = (self.level(rect.min.y), self.level(rect.max.y));
        let nearest = if low > 0.0 {
            low
        } else if high < 0.0 {
            high
        } else {
            0.0
        };
        let farthest = if -low > high { low } else { high };
        let Factors { radius2, error, .. } = self.factors;
        rect.max.x >= self.m2
            && nearest * nearest <= radius2 * (rect.max.x - self.m2) + error
            && farthest * farthest >= radius2 * (rect.min.x - self.m2) - error
    }

    #[inline]
    fn sample(&self, s: f64, point: ArcPoint) -> Sample {
        Sample {
            s,
            level: self.level(point.y),
            q: self.q(point.square),
        }
    }

    /// Visits all crossings with an arc.
    #[inline]
    pub(super) fn crossings(&self, (arc, terms): (&Arc, &Terms), visit: &mut impl FnMut(Meeting)) {
        let polynomial = Sextic::new(terms, &self.factors);
        let up = self.ray.direction.y > 0.0;
        let mut single = |part: Single| {
            visit(Meeting {
                place: Place::Within(part),
                approach: if part.rising == up { 1.0 } else { -1.0 },
            });
        };
        match polynomial.roots() {
            Roots::None => {}
            Roots::One(part) => single(part),
            Roots::Several => match polynomial.isolate() {
                Some(parts) => parts.iter().for_each(|part| single(*part)),
                None => self.crossings_by_halves(arc, visit),
            },
            Roots::Unsure => self.crossings_by_halves(arc, visit),
        }
    }

    /// Where exactly a crossing is: the arc's and the ray's parameter.
    #[inline]
    pub(super) fn exactly(&self, arc: &Arc, terms: &Terms, place: &Place) -> [f64; 2] {
        let (s, half) = match *place {
            Place::At { s, half } => (s, Some(half)),
            Place::Within(part) => (self.root(terms, &part), None),
        };
        let point = arc.at(s);
        let half = half.unwrap_or_else(|| self.half_at(self.level(point.y)));
        [s, self.parameter(half, point)]
    }

    /// The half of the line that has a height of this level: the one where `dy` times the way from the axis has its sign.
    #[inline]
    fn half_at(&self, level: f64) -> f64 {
        if (level > 0.0) == (self.ray.direction.y > 0.0) {
            1.0
        } else {
            -1.0
        }
    }

    /// Bounds of the ray's parameter at a crossing.
    #[inline]
    pub(super) fn about(&self, arc: &Arc, place: &Place) -> [f64; 2] {
        let part = match *place {
            Place::At { s, half } => return [self.parameter(half, arc.at(s)); 2],
            Place::Within(part) => part,
        };
        let at = |s: f64| match s {
            0.0 => arc.start(),
            1.0 => arc.end(),
            _ => arc.at(s),
        };
        let (a, b) = (at(part.low), at(part.high));
        // As the parameter is computed in the end, with room for what rounding does to it and to monotony.
        let dy = self.ray.direction.y;
        let (from, to, room, speed) = if dy.abs() > self.speed {
            let oy = self.ray.origin.y;
            let room = gamma(32) * (a.y.abs() + b.y.abs() + oy.abs());
            (a.y - oy, b.y - oy, room, dy)
        } else {
            let (near, far) = sorted(a.square, b.square);
            let (near, far) = (
                self.q(near * (1.0 - gamma(32))),
                self.q(far * (1.0 + gamma(32))),
            );
            let (low, high) = sorted(self.level(a.y), self.level(b.y));
            let unsure = gamma(32) * (self.base.abs() + high - low);
            let (from, to) = if low > unsure || high < -unsure {
                let half = self.half_at(low);
                (half * near, half * far)
            } else {
                (-far, far)
            };
            let room = gamma(32) * (far + self.start.abs());
            (from - self.start, to - self.start, room, self.speed)
        };
        let (low, high) = sorted(from / speed, to / speed);
        let room = room / speed.abs();
        let bounds = [low - room, high + room];
        if bounds[0] <= bounds[1] {
            bounds
        } else {
            [f64::NEG_INFINITY, f64::INFINITY]
        }
    }

    /// A length of the ray's parameter in which it goes no farther than this.
    #[inline]
    pub(super) fn time_of(&self, distance: f64) -> f64 {
        distance / (self.speed + self.ray.direction.y.abs())
    }

    /// Whether a crossing certainly is at a parameter of the ray that is no larger than `near`: whether the line is on different
    /// sides of the arc at the two heights that it has there. Only for arcs whose height grows evenly.
    #[inline]
    pub(super) fn certainly_crosses(
        &self,
        arc: &Arc,
        terms: &Terms,
        place: &Place,
        near: f64,
    ) -> bool {
        let (Place::Within(part), Piece::Line([from, to])) = (place, arc.y) else {
            return false;
        };
        let Ray { origin, direction } = self.ray;
        let per_height = 1.0 / (to - from);
        let start = (origin.y - from) * per_height;
        let step = near * direction.y * per_height;
        let is_here = |s: f64| part.low < s && s < part.high;
        let (a, b) = (start - step.abs(), start + step.abs());
        let value = |s: f64| self.factors.value(terms.at(s));
        // Beyond the rounding errors of the coefficients and of the value.
        let unsure = 2.0 * self.factors.error;
        let rising = if part.rising { 1.0 } else { -1.0 };
        is_here(a) && is_here(b) && rising * value(a) < -unsure && rising * value(b) > unsure
    }

    /// The root in a part of an arc that has one.
    ///
    /// Newton's method on the half of the line that is on the same side: `|level| - |dy| q` has the sign and the root of the
    /// polynomial, but neither squares nor double roots.
    fn root(&self, terms: &Terms, part: &Single) -> f64 {
        let Single {
            low,
            high,
            rising,
            guess,
        } = *part;
        let steep = self.ray.direction.y.abs();
        newton(low, high, rising, guess, |s| {
            let ([height, climb], [square, spread]) = terms.at(s);
            let (level, rise) = (self.speed * height + self.base, self.speed * climb);
            let q2 = square - self.m2;
            if q2 > 0.0 {
                let q = q2.sqrt();
                let rise = if level < 0.0 { -rise } else { rise };
                let value = level.abs() - steep * q;
                // The slope is rise - steep·(r²)' / 2q.
                (value, value * (2.0 * q) / (2.0 * q * rise - steep * spread))
            } else {
                // Nearer to the axis than the line: the polynomial itself.
                let value = level * level - steep * steep * q2;
                let slope = 2.0 * level * rise - steep * steep * spread;
                (value, value / slope)
            }
        })
    }

    /// All crossings with an arc of either half of the line, for lines whose polynomial has roots too close to each other or to an
    /// end of the arc.
    #[cold]
    fn crossings_by_halves(&self, arc: &Arc, visit: &mut impl FnMut(Meeting)) {
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
        let tallest = self.base.abs() + a.level.abs() + b.level.abs();
        let noise = gamma(16) * (tallest + dy.abs() * (a.q + b.q));
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
        visit: &mut impl FnMut(Meeting),
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
                visit(half.meeting(self.refine(arc, half, a, b), b));
            }
            return;
        }
        let s = 0.5 * (a.s + b.s);
        let steepest = if -low > high { -low } else { high };
        // If the change in between is less than the rounding error, only the ends count. (NaN compares as less, too.)
        let worth = steepest * (b.s - a.s) > noise;
        if !(worth && a.s < s && s < b.s) {
            if change {
                visit(half.meeting(s, b));
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
