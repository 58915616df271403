//! Pieces that a ray meets at a low angle, where they are far from linear as the ray sees them.
//!
//! Within a small window of its parameters a piece lies in a thin slab along its tangent plane, as thick as the square of the
//! window (from bounds of the second derivatives). The ray is in that slab only briefly, which makes the window smaller, and so
//! on: this closes in quadratically on a hit, or ends at once where there is none. Windows that don't shrink, since there are two
//! hits, are halved. As soon as the map is nearly linear over a window, Newton's method takes over.

use super::frame::Frame;
use super::hull::OVERLAP;
use super::leaf::NEARLY_LINEAR;
use super::net::Jet;
use super::newton::{Candidate, Found, Rectangle, Ways, jet, newton};
use super::piece::Curving;
use arrayvec::ArrayVec;
use strahl_math::DVec3;
use strahl_math::error::gamma;
use strahl_simd::Isa;

/// So many windows are looked at, at most.
const WINDOWS: u32 = 40;
/// A smaller part of a piece than this is not divided any more.
const SMALLEST: f64 = 1e-7;
/// Tangents with a smaller sine of the angle between them, squared, span no plane.
const COLLINEAR: f64 = 1e-4;
/// A window that shrinks to this part of its area is not halved yet.
const SHRUNK: f64 = 0.5;
/// Windows are larger by this part than they need to be, against rounding.
const SPARE: f64 = 1.0 / 1024.0;

/// The hits of a piece.
pub(super) type Hits = ArrayVec<Candidate, 16>;

/// A rectangle of the parameters, by its middle and half its sides.
#[derive(Clone, Copy, Debug)]
struct Window {
    middle: [f64; 2],
    half: [f64; 2],
}

/// What is known of a window.
enum Verdict {
    /// The ray does not meet the piece there.
    Missed,
    /// There is one hit at most, near this place.
    Certain([f64; 2]),
    /// All hits are in this smaller window.
    Within(Window),
}

/// The hits within a piece, or `None` if there are more windows than it is worthwhile to look at.
#[inline(always)]
pub(super) fn search<I: Isa, const K: usize>(
    isa: I,
    (ways, noise): (&Ways<I, K>, f64),
    frame: &Frame,
    piece: &Rectangle,
    curving: &Curving,
) -> Option<Hits> {
    let half = [
        (0.5 + 2.0 * OVERLAP) * piece.size[0],
        (0.5 + 2.0 * OVERLAP) * piece.size[1],
    ];
    let middle = [
        piece.from[0] + 0.5 * piece.size[0],
        piece.from[1] + 0.5 * piece.size[1],
    ];
    let smallest = [SMALLEST * half[0], SMALLEST * half[1]];
    let mut waiting = ArrayVec::<Window, { WINDOWS as usize + 1 }>::new();
    waiting.push(Window { middle, half });
    let mut found = Hits::new();
    for _ in 0..WINDOWS {
        let Some(window) = waiting.pop() else {
            return Some(found);
        };
        let here = jet(isa, ways, window.middle);
        match window.judge(&here, frame, curving, noise) {
            Verdict::Missed => {}
            Verdict::Certain(start) => {
                let hit = newton(
                    isa,
                    (ways, noise),
                    frame,
                    (&window.rectangle(), piece),
                    start,
                );
                let hit = match hit {
                    Found::Nothing => continue,
                    Found::Hit(hit) => hit,
                    Found::Near(_) | Found::Lost => return None,
                };
                if !found.iter().any(|other| other.is_twin(&hit)) {
                    found.try_push(hit).ok()?;
                }
            }
            Verdict::Within(smaller) => {
                let area = |w: &Window| w.half[0] * w.half[1];
                if smaller.half[0] < smallest[0] && smaller.half[1] < smallest[1] {
                    return None;
                }
                if area(&smaller) < SHRUNK * area(&window) {
                    waiting.push(smaller);
                } else {
                    waiting.extend(smaller.halves(&here));
                }
            }
        }
    }
    None
}

impl Window {
    fn rectangle(&self) -> Rectangle {
        Rectangle {
            from: [self.middle[0] - self.half[0], self.middle[1] - self.half[1]],
            size: [2.0 * self.half[0], 2.0 * self.half[1]],
        }
    }

    /// Both halves across the side that is longer in space.
    #[inline(always)]
    fn halves(&self, here: &Jet<4>) -> [Self; 2] {
        let square = |v: &[f64; 4]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        let u = square(&here.by_u) * (self.half[0] * self.half[0]);
        let v = square(&here.by_v) * (self.half[1] * self.half[1]);
        let axis = usize::from(v > u);
        let [mut a, mut b] = [*self; 2];
        let quarter = 0.5 * self.half[axis];
        let half = quarter * (1.0 + SPARE);
        (a.half[axis], b.half[axis]) = (half, half);
        a.middle[axis] -= quarter;
        b.middle[axis] += quarter;
        [a, b]
    }

    /// What the point and the derivatives in the middle tell of the window, in the coordinates of the ray's origin.
    #[inline(always)]
    fn judge(&self, here: &Jet<4>, frame: &Frame, curving: &Curving, noise: f64) -> Verdict {
        let vector = |v: &[f64; 4]| DVec3::new(v[0], v[1], v[2]);
        let [hu, hv] = self.half;
        let per = 1.0 / here.value[3];
        let point = vector(&here.value) * per;
        let (grow_u, grow_v) = (here.by_u[3] * per * hu, here.by_v[3] * per * hv);
        // The derivatives by parameters that run from -1 to 1 in the window.
        let a = vector(&here.by_u) * (per * hu) - point * grow_u;
        let b = vector(&here.by_v) * (per * hv) - point * grow_v;
        let (uu, uv, vv) = (
            curving.uu * hu * hu,
            curving.uv * hu * hv,
            curving.vv * hv * hv,
        );
        // What a tangent plane makes of rounding errors, whose tangents may be nearly parallel.
        let noise = 64.0 * noise * per.abs();
        // How far points may be from the tangent plane, and derivatives from those in the middle.
        let off = 0.5 * (uu + vv) + uv + noise;
        let change = (uu + uv) + (uv + vv) + 2.0 * noise;
        let (seen_a, seen_b) = (frame.seen(a), frame.seen(b));
        let determinant = seen_a[0] * seen_b[1] - seen_a[1] * seen_b[0];
        let square = |v: [f64; 2]| v[0] * v[0] + v[1] * v[1];
        let longest = {
            let (p, q) = (square(seen_a), square(seen_b));
            (if p > q { p } else { q }).sqrt()
        };
        let weights = 2.0 * (grow_u.abs() + grow_v.abs());
        if longest * change < (NEARLY_LINEAR - weights) * determinant.abs() {
            let f = frame.seen(point);
            let x = (f[1] * seen_b[0] - f[0] * seen_b[1]) / determinant;
            let y = (f[0] * seen_a[1] - f[1] * seen_a[0]) / determinant;
            return Verdict::Certain([self.middle[0] + x * hu, self.middle[1] + y * hv]);
        }
        self.clipped(point, [a, b], off, frame)
    }

    /// The part of the window in which the ray may meet the patch: near the plane through a point and along two derivatives, from which the
    /// patch is at most `off` away.
    #[inline(always)]
    fn clipped(&self, point: DVec3, [a, b]: [DVec3; 2], off: f64, frame: &Frame) -> Verdict {
        let normal = a.cross(b);
        let (nn, aa, bb) = (
            normal.length_squared(),
            a.length_squared(),
            b.length_squared(),
        );
        if !(nn > COLLINEAR * (aa * bb)) {
            // Near a point or a line: within a ball.
            let aside = point - frame.along * point.dot(frame.along);
            let reach = aa.sqrt() + bb.sqrt() + off;
            return if aside.length() > reach * (1.0 + SPARE) {
                Verdict::Missed
            } else {
                Verdict::Within(*self)
            };
        }
        // Vectors that measure how far a point is along a, along b and from the plane.
        let length = nn.sqrt();
        let dual = [b.cross(normal) / nn, normal.cross(a) / nn, normal / length];
        let off_a = off * (bb.sqrt() / length);
        let off_b = off * (aa.sqrt() / length);
        let reach = [1.0 + off_a, 1.0 + off_b, off];
        let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
        let (mut from, mut rate) = ([0.0; 3], [0.0; 3]);
        for k in 0..3 {
            from[k] = -dual[k].dot(point);
            rate[k] = dual[k].dot(frame.along);
            let per = 1.0 / rate[k];
            let reach = reach[k] * (1.0 + SPARE);
            let (p, q) = ((-reach - from[k]) * per, (reach - from[k]) * per);
            let (p, q) = if p < q { (p, q) } else { (q, p) };
            // Comparisons with NaN, when the ray runs within a side, change nothing.
            if p > near {
                near = p;
            }
            if q < far {
                far = q;
            }
        }
        if near - near.abs() * gamma(16) > far + far.abs() * gamma(16) {
            return Verdict::Missed;
        }
        let mut smaller = *self;
        for (k, off) in [off_a, off_b].into_iter().enumerate() {
            let (p, q) = (from[k] + rate[k] * near, from[k] + rate[k] * far);
            let (p, q) = if p < q { (p, q) } else { (q, p) };
            let spare = off + SPARE * (q - p);
            let low = if p - spare > -1.0 { p - spare } else { -1.0 };
            let high = if q + spare < 1.0 { q + spare } else { 1.0 };
            if low > high {
                return Verdict::Missed;
            }
            smaller.middle[k] += self.half[k] * (0.5 * (low + high));
            smaller.half[k] *= 0.5 * (high - low);
        }
        Verdict::Within(smaller)
    }
}
