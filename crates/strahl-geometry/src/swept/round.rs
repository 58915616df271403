use super::curve::Piece;
use crate::{Crossing, PrimHit, Side, SurfaceId};
use std::ops::ControlFlow;
use strahl_math::error::gamma;
use strahl_math::roots::{Bernstein, RootCount, quadratic};
use strahl_math::{Aabb, DVec3, DVec4, Ray};

/// A piece of a curve of spheres: centre and radius, of degree 1 or 3.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Segment {
    curve: Piece<DVec4>,
    /// A sphere around all spheres.
    middle: DVec3,
    reach: f64,
}

/// A line measured in units of length from its point nearest to the body.
pub(super) struct Line {
    origin: DVec3,
    /// Unit vector.
    ahead: DVec3,
    t: f64,
    t_per_length: f64,
}

impl Line {
    /// `None` for a direction without a length.
    pub(super) fn new(ray: &Ray, center: DVec3) -> Option<Self> {
        let largest = ray.direction.abs().max_element();
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        // Scaled first, so that no square vanishes or overflows.
        let scaled = ray.direction / largest;
        let length = scaled.length();
        let ahead = scaled / length;
        let t_per_length = 1.0 / (length * largest);
        let way = (center - ray.origin).dot(ahead);
        Some(Self {
            origin: ray.origin + ahead * way,
            ahead,
            t: way * t_per_length,
            t_per_length,
        })
    }
}

/// Both ends, six and ten roots, and some for double roots, which may be found in several parts.
const MOST_MARKS: usize = 40;

/// Parameters of a curve at which the state may change: its ends, and roots.
struct Marks {
    list: [f64; MOST_MARKS],
    count: usize,
}

impl Marks {
    fn push(&mut self, s: f64) {
        if let Some(slot) = self.list.get_mut(self.count)
            && (0.0..=1.0).contains(&s)
        {
            *slot = s;
            self.count += 1;
        }
    }

    fn sorted(&mut self) -> &[f64] {
        let list = self.list.get_mut(..self.count).unwrap_or_default();
        insertion_sort(list);
        list
    }
}

/// Sorts a few numbers.
fn insertion_sort(list: &mut [f64]) {
    for end in 1..list.len() {
        for k in (0..end).rev() {
            let (a, b) = (list[k], list[k + 1]);
            if a <= b {
                break;
            }
            (list[k], list[k + 1]) = (b, a);
        }
    }
}

/// The intersection of a line with a moving sphere at one parameter.
#[derive(Clone, Copy)]
struct View {
    /// The position of the centre along the line.
    along: f64,
    /// Half the squared length of the line within the sphere, times two: negative where it misses.
    square: f64,
}

impl Segment {
    pub(super) fn new(curve: Piece<DVec4>) -> Self {
        let points = curve.points();
        let bounds = Aabb::from_points(points.iter().map(|p| p.truncate()));
        let middle = bounds.center();
        let far = |p: &DVec4| (p.truncate() - middle).length() + p.w.abs();
        let reach = points.iter().map(far).fold(0.0, f64::max);
        Self {
            curve,
            middle,
            reach: reach * (1.0 + gamma(16)),
        }
    }

    /// Centre and radius at `s`.
    pub(super) fn at(&self, s: f64) -> DVec4 {
        self.curve.at(s)
    }

    pub(super) fn has_size(&self) -> bool {
        self.curve.points().iter().any(|p| p.w != 0.0)
    }

    /// A box around all spheres: that of the control points' spheres, whose mixtures they are.
    pub(super) fn bounds(&self) -> Aabb {
        let points = self.curve.points().iter();
        let boxes = points.map(|p| {
            let center = p.truncate();
            Aabb::new(center, center).padded(DVec3::splat(p.w.abs()))
        });
        let all = boxes.fold(Aabb::EMPTY, |all, b| all.union(&b));
        all.padded(DVec3::splat(gamma(32) * all.max_abs()))
    }

    /// Whether the line may meet the piece.
    pub(super) fn is_near(&self, line: &Line) -> bool {
        let aside = self.middle - line.origin;
        let along = aside.dot(line.ahead);
        let distance = aside - line.ahead * along;
        let slack = gamma(32) * aside.dot(aside);
        distance.dot(distance) <= self.reach * self.reach + slack
    }

    /// Lists the spans of the line within the piece, each as an entry and an exit.
    pub(super) fn spans(&self, line: &Line, facet: u32, out: &mut Vec<Crossing>) {
        let mut marks = Marks {
            list: [0.0; MOST_MARKS],
            count: 0,
        };
        marks.push(0.0);
        marks.push(1.0);
        let met = match &self.curve {
            Piece::Cubic(points) => mark_cubic(points, line, &mut marks),
            other => mark_line(other.start(), other.end(), line, &mut marks),
        };
        if !met {
            return;
        }
        let view = |s: f64| self.view(line, s);
        let mut span: Option<[(f64, f64); 2]> = None;
        let mut end = |span: &mut Option<[(f64, f64); 2]>| {
            let Some([enter, exit]) = span.take() else {
                return;
            };
            for ((way, s), side) in [(enter, Side::Enter), (exit, Side::Exit)] {
                let surface = SurfaceId { element: 0, facet };
                let hit = PrimHit {
                    t: line.t + way * line.t_per_length,
                    surface,
                    uv: [s, 0.0],
                };
                if !hit.t.is_finite() {
                    return;
                }
                out.push(Crossing::new(hit, 0.0, side));
            }
        };
        let mut last: Option<f64> = None;
        for &s in marks.sorted() {
            // Between two marks the line hits all spheres or none.
            if let Some(last) = last
                && view(0.5 * (last + s)).square < 0.0
            {
                end(&mut span);
            }
            last = Some(s);
            let View { along, square } = view(s);
            // Where the line begins to hit the spheres, rounding may hide that.
            if !(square >= 0.0) && span.is_none() {
                continue;
            }
            let half = if square > 0.0 { square.sqrt() } else { 0.0 };
            let (enter, exit) = ((along - half, s), (along + half, s));
            span = Some(match span {
                None => [enter, exit],
                Some([first, second]) => [
                    if enter.0 < first.0 { enter } else { first },
                    if exit.0 > second.0 { exit } else { second },
                ],
            });
        }
        end(&mut span);
    }

    fn view(&self, line: &Line, s: f64) -> View {
        let sphere = self.at(s);
        let aside = sphere.truncate() - line.origin;
        let along = aside.dot(line.ahead);
        let across = aside - line.ahead * along;
        View {
            along,
            square: sphere.w * sphere.w - across.dot(across),
        }
    }

    /// Whether one of the spheres holds the point.
    pub(super) fn contains(&self, point: DVec3) -> bool {
        let points = self.curve.cubic();
        let away = points.map(|p| p.truncate() - point);
        let square: [f64; 7] = product(&points.map(|p| p.w), &points.map(|p| p.w));
        let distance = dot(&away, &away);
        let depth: [f64; 7] = std::array::from_fn(|k| square[k] - distance[k]);
        if depth[0] >= 0.0 || depth[6] >= 0.0 {
            return true;
        }
        depth.iter().any(|d| *d > 0.0) && !Bernstein::new(depth, 0.0, 0.0, 1.0).roots().is_empty()
    }
}

/// The product of two polynomials in Bernstein form.
pub(super) fn product<const M: usize, const N: usize, const K: usize>(
    a: &[f64; M],
    b: &[f64; N],
) -> [f64; K] {
    let mut out = [0.0; K];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            if let Some(sum) = out.get_mut(i + j) {
                *sum += x * y * binomial(M - 1, i) * binomial(N - 1, j);
            }
        }
    }
    for (k, sum) in out.iter_mut().enumerate() {
        *sum /= binomial(K - 1, k);
    }
    out
}

fn dot(a: &[DVec3; 4], b: &[DVec3; 4]) -> [f64; 7] {
    let part = |f: fn(DVec3) -> f64| product::<4, 4, 7>(&a.map(f), &b.map(f));
    let (x, y, z) = (part(|v| v.x), part(|v| v.y), part(|v| v.z));
    std::array::from_fn(|k| x[k] + y[k] + z[k])
}

/// Binomial coefficients up to degree 15. Computing them for each ray took two fifths of the time of a cubic sweep.
const BINOMIALS: [[f64; 16]; 16] = {
    let mut rows = [[0.0; 16]; 16];
    let mut n = 0;
    while n < 16 {
        rows[n][0] = 1.0;
        let mut k = 1;
        while k <= n {
            rows[n][k] = rows[n - 1][k - 1] + rows[n - 1][k];
            k += 1;
        }
        n += 1;
    }
    rows
};

fn binomial(n: usize, k: usize) -> f64 {
    BINOMIALS[n][k]
}

/// The derivative in Bernstein form.
fn derivative<const N: usize, const K: usize>(c: &[f64; N]) -> [f64; K] {
    let degree = N.saturating_sub(1) as f64;
    std::array::from_fn(|k| match (c.get(k), c.get(k + 1)) {
        (Some(a), Some(b)) => (b - a) * degree,
        _ => 0.0,
    })
}

/// Marks where the line begins or ceases to hit the spheres, and where the hits reverse their direction. `false` if it hits
/// none.
fn mark_cubic(points: &[DVec4; 4], line: &Line, marks: &mut Marks) -> bool {
    let aside = points.map(|p| p.truncate() - line.origin);
    let along = aside.map(|p| p.dot(line.ahead));
    let mut across = aside;
    for (p, way) in across.iter_mut().zip(along) {
        *p -= line.ahead * way;
    }
    let radius = points.map(|p| p.w);
    let (big, distance) = (product::<4, 4, 7>(&radius, &radius), dot(&across, &across));
    let square: [f64; 7] = std::array::from_fn(|k| big[k] - distance[k]);
    let size = aside.iter().zip(radius).fold(0.0, |size: f64, (p, r)| {
        let far = p.length() + r.abs();
        if far > size { far } else { size }
    });
    let error = gamma(32) * size * size;
    if square.iter().all(|c| *c < -error) {
        return false;
    }
    for s in Bernstein::new(square, error, 0.0, 1.0).roots().iter() {
        marks.push(*s);
    }
    // Where (along ± sqrt(square))' = 0: 4 along'² square = square'².
    let (a, q): ([f64; 3], [f64; 6]) = (derivative(&along), derivative(&square));
    let a2: [f64; 5] = product(&a, &a);
    let (left, right): ([f64; 11], [f64; 11]) = (product(&a2, &square), product(&q, &q));
    let turning: [f64; 11] = std::array::from_fn(|k| 4.0 * left[k] - right[k]);
    let scale = size * size * size * size;
    let polynomial = Bernstein::new(turning, gamma(64) * scale, 0.0, 1.0);
    let _ = polynomial.isolate(&mut |part| {
        let s = match part.count {
            // Rays across the curve have double roots, where both points of the line turn at once. These parts are so short that their
            // middles are near enough, and take far less time. A mark too many does no harm: it stands for a sphere.
            RootCount::Even => 0.5 * (part.low() + part.high()),
            _ => part.root(),
        };
        marks.push(polished(&along, &square, s));
        ControlFlow::Continue(())
    });
    true
}

/// A root of the polynomial of degree 10, improved by a step of the secant method on the factor that it belongs to.
fn polished(along: &[f64; 4], square: &[f64; 7], s: f64) -> f64 {
    const STEP: f64 = 1.0 / 65_536.0;
    let turning = |s: f64| {
        let way = Piece::Cubic(*along).derivative(s);
        let (value, slope) = value_and_slope(square, s);
        let root = if value > 0.0 { value.sqrt() } else { 0.0 };
        [2.0 * root * way - slope, 2.0 * root * way + slope]
    };
    let other = if s > 0.5 { s - STEP } else { s + STEP };
    let (here, there) = (turning(s), turning(other));
    let which = usize::from(here[1].abs() < here[0].abs());
    let better = s - here[which] * (other - s) / (there[which] - here[which]);
    let closer = (better - s).abs() < STEP && turning(better)[which].abs() < here[which].abs();
    if closer { better } else { s }
}

/// De Casteljau's algorithm.
fn value_and_slope(c: &[f64; 7], s: f64) -> (f64, f64) {
    let mut b = *c;
    let mut slope = 0.0;
    for left in (1..7).rev() {
        if left == 1 {
            slope = 6.0 * (b[1] - b[0]);
        }
        for j in 0..left {
            b[j] = b[j] * (1.0 - s) + b[j + 1] * s;
        }
    }
    (b[0], slope)
}

/// [`mark_cubic`] for spheres in proportion: both polynomials have degree 2.
fn mark_line(from: DVec4, to: DVec4, line: &Line, marks: &mut Marks) -> bool {
    let aside = from.truncate() - line.origin;
    let step = to - from;
    let (along, climb) = (aside.dot(line.ahead), step.truncate().dot(line.ahead));
    let across = aside - line.ahead * along;
    let drift = step.truncate() - line.ahead * climb;
    // square = a s² + 2 b s + c
    let a = step.w * step.w - drift.dot(drift);
    let b = from.w * step.w - across.dot(drift);
    let c = from.w * from.w - across.dot(across);
    // In Bernstein form: c, c + b, c + 2 b + a. The line misses all spheres where none is positive.
    let error = gamma(32) * (from.w * from.w + aside.dot(aside) + step.dot(step));
    if c < -error && c + b < -error && c + 2.0 * b + a < -error {
        return false;
    }
    let bend = b * b - a * c;
    if let Some((s, t)) = quadratic(a, b, c, bend) {
        marks.push(s);
        marks.push(t);
    }
    // climb² square = (square' / 2)²: with f = a - climb², a f s² + 2 b f s + b² - climb² c = 0.
    let f = step.w * step.w - step.truncate().length_squared();
    let climb2 = climb * climb;
    let turning = (a * f, b * f, b * b - climb2 * c);
    if let Some((s, t)) = quadratic(turning.0, turning.1, turning.2, -f * climb2 * bend) {
        marks.push(s);
        marks.push(t);
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_and_derivatives_of_bernstein_polynomials() {
        let (a, b) = ([0.3, -1.0, 2.0, 0.7], [1.5, 0.2, -0.4]);
        let value = |c: &[f64], s: f64| {
            let n = c.len() - 1;
            let term = |(k, c): (usize, &f64)| {
                c * binomial(n, k) * s.powi(k as i32) * (1.0 - s).powi((n - k) as i32)
            };
            c.iter().enumerate().map(term).sum::<f64>()
        };
        let both: [f64; 6] = product(&a, &b);
        let slope: [f64; 3] = derivative(&a);
        for i in 0..=10 {
            let s = f64::from(i) * 0.1;
            assert!((value(&both, s) - value(&a, s) * value(&b, s)).abs() < 1e-14);
            let difference = (value(&a, s + 1e-6) - value(&a, s - 1e-6)) / 2e-6;
            assert!((value(&slope, s) - difference).abs() < 1e-8);
        }
        let seven = [0.3, -1.0, 2.0, 0.7, 0.1, -0.6, 1.2];
        let (v, d) = value_and_slope(&seven, 0.3);
        assert!((v - value(&seven, 0.3)).abs() < 1e-15);
        assert!((d - value(&derivative::<7, 6>(&seven), 0.3)).abs() < 1e-14);
    }
}
