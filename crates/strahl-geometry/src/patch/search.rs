//! The search for the points at which a ray meets a patch.
//!
//! Seen along the ray, the patch is a map from two parameters to the plane, and its hits are the parameters that are mapped
//! to the origin. On a piece where the map is nearly linear, so that Newton's method certainly finds its only hit or
//! there is none (the condition of Kantorovich, here from bounds of the derivatives), it is used. Pieces that are seen at a low angle
//! are searched through smaller and smaller windows ([`graze`]); where that takes too long, they are halved
//! (Nishita, Sederberg, Kakimoto, "Ray tracing trimmed rational surface patches", SIGGRAPH 1990; Martin, Cohen, Fish, Shirley,
//! "Practical ray tracing of trimmed NURBS surfaces", Journal of Graphics Tools 5(1), 2000).

use super::graze;
use super::net::{Jet, Net, bernstein};
use super::tree::{Curving, NEARLY_LINEAR, OVERLAP, Square, Tree, Visitor, project};
use strahl_math::error::gamma;
use strahl_math::{DVec3, Interval, Ray};
use strahl_simd::{Isa, Simd, dispatch};

/// Newton's method doubles the digits in each round, from one or two.
const ROUNDS: u32 = 16;
/// A step by this part of the piece is the last one: after it the error is its square.
const LAST_STEP: f64 = 1e-8;
/// A ray may halve pieces so often; it needs more only if it lies within the surface.
const HALVINGS: u32 = 2000;
/// A piece that is seen smaller than so many times the rounding error counts as a point.
const POINT: f64 = 1e4;
/// A piece is halved so often at most.
const DEPTH: u32 = 90;

/// A ray with two directions across it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) origin: DVec3,
    /// Its direction, of length 1.
    pub(super) along: DVec3,
    across: [DVec3; 2],
    /// The length of its direction.
    pub(super) length: f64,
}

impl Frame {
    pub(super) fn new(ray: &Ray) -> Option<Self> {
        let length = ray.direction.length();
        let along = ray.direction.try_normalize()?;
        if !(ray.origin.is_finite() && length.is_finite()) {
            return None;
        }
        let first = along.any_orthonormal_vector();
        Some(Self {
            origin: ray.origin,
            along,
            across: [first, along.cross(first)],
            length,
        })
    }

    /// The ray's parameter of a point.
    pub(super) fn t(&self, point: DVec3) -> f64 {
        (point - self.origin).dot(self.along) / self.length
    }

    /// A vector seen along the ray.
    #[inline(always)]
    pub(super) fn seen(&self, v: DVec3) -> [f64; 2] {
        [self.across[0].dot(v), self.across[1].dot(v)]
    }

    /// The ray's parameter of a point on a patch that is seen from its origin, less the last `step` of both parameters: so small that
    /// the derivatives are enough.
    #[inline(always)]
    fn t_of(&self, jet: &Jet<4>, step: [f64; 2]) -> f64 {
        let moved = |k: usize| jet.value[k] - (jet.by_u[k] * step[0] + jet.by_v[k] * step[1]);
        let way = DVec3::new(moved(0), moved(1), moved(2));
        way.dot(self.along) / (moved(3) * self.length)
    }

    /// The patch seen along the ray; for rational ones the numerator, which is zero at the same parameters. It depends on the
    /// ray and each control point alone, so that the common border of two patches is the same in both.
    pub(super) fn view<const K: usize>(&self, net: &Net<4, K>) -> Net<2, K> {
        net.map(|p| self.see(p))
    }

    /// A control point seen along the ray.
    pub(super) fn see(&self, point: &[f64; 4]) -> [f64; 2] {
        self.seen(self.to(point))
    }

    /// The way from the origin to a control point, times its weight. Its rounding error is that of the way, not of the places.
    fn to(&self, [x, y, z, w]: &[f64; 4]) -> DVec3 {
        if *w == 1.0 {
            return DVec3::new(*x, *y, *z) - self.origin;
        }
        (DVec3::new(*x, *y, *z) * (1.0 / *w) - self.origin) * *w
    }
}

/// A place where the ray meets the patch, perhaps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) t: f64,
    pub(super) u: f64,
    pub(super) v: f64,
    /// 1, or -1 where the patch is seen mirrored; 0 where the search gave up.
    pub(super) sign: i32,
    /// How well `u` and `v` are known, at least as much as pieces overlap.
    pub(super) zone: [f64; 2],
    /// Whether it lies where pieces overlap, so that it may be found twice or may be beyond the border.
    pub(super) is_doubtful: bool,
}

impl Candidate {
    /// The parameters, moved to the border if they are beyond it.
    pub(super) fn place(&self) -> [f64; 2] {
        [self.u.clamp(0.0, 1.0), self.v.clamp(0.0, 1.0)]
    }

    /// Whether it is the same place as another one, found from a neighbouring piece.
    pub(super) fn is_twin(&self, other: &Self) -> bool {
        other.sign == self.sign
            && (other.u - self.u).abs() <= other.zone[0] + self.zone[0]
            && (other.v - self.v).abs() <= other.zone[1] + self.zone[1]
    }

    /// Whether a place is as near to it as its parameters are known.
    pub(super) fn is_about(&self, [u, v]: [f64; 2]) -> bool {
        (self.u - u).abs() <= 2.0 * self.zone[0] && (self.v - v).abs() <= 2.0 * self.zone[1]
    }

    /// How far within the border it lies, in units of its zone; negative outside.
    pub(super) fn margin(&self) -> f64 {
        let side = |x: f64, zone: f64| if x < 0.5 { x / zone } else { (1.0 - x) / zone };
        let [u, v] = [side(self.u, self.zone[0]), side(self.v, self.zone[1])];
        if u < v { u } else { v }
    }
}

/// A rectangle of parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rectangle {
    pub(super) from: [f64; 2],
    pub(super) size: [f64; 2],
}

impl Rectangle {
    fn of(Square { level, i, j }: Square) -> Self {
        let side = 1.0 / f64::from(1_u32 << level);
        Self {
            from: [f64::from(i) * side, f64::from(j) * side],
            size: [side; 2],
        }
    }
}

/// A search with what it has found.
pub(super) struct Search<'a, const K: usize> {
    net: &'a Net<4, K>,
    tree: &'a Tree,
    frame: &'a Frame,
    /// How far the net may be from what neighbours know of it.
    seam: f64,
    halvings: u32,
    keep: Keep<'a>,
    /// What the search is for.
    pub(super) aim: Aim,
}

/// Whether the surface is there at two parameters, which are between 0 and 1; `None` if all of it is.
pub(super) type Keep<'a> = Option<&'a dyn Fn(f64, f64) -> bool>;

/// What a search is for.
pub(super) enum Aim {
    /// The nearest candidate of a range, as long as none is doubtful.
    Nearest {
        range: Interval,
        nearest: Option<Candidate>,
        is_doubtful: bool,
    },
    /// Whether there is a candidate in a range that is not doubtful; ends with the first of either kind.
    Any {
        range: Interval,
        found: bool,
        is_doubtful: bool,
    },
    /// All candidates.
    All(Vec<Candidate>),
}

impl<'a, const K: usize> Search<'a, K> {
    pub(super) fn new(
        net: &'a Net<4, K>,
        tree: &'a Tree,
        frame: &'a Frame,
        keep: Keep<'a>,
        aim: Aim,
    ) -> Self {
        Self {
            net,
            tree,
            frame,
            seam: 0.0,
            halvings: HALVINGS,
            keep,
            aim,
        }
    }

    /// Adds to the rounding error how far the net may be from what neighbours know of it.
    pub(super) fn with_seam(mut self, seam: f64) -> Self {
        self.seam = seam;
        self
    }

    /// Visits the pieces along the ray.
    pub(super) fn run(&mut self) {
        let (net, tree, frame) = (self.net, self.tree, self.frame);
        tree.walk(net, frame, self);
    }

    /// Searches a piece that is seen as `part`, and halves it as long as nothing is certain about it; `noise` is a bound of the rounding
    /// error of what is seen.
    fn divide(&mut self, part: &Net<2, K>, noise: f64, rectangle: &Rectangle, depth: u32) {
        let (low, high) = part.extents();
        let extent: [f64; 2] = std::array::from_fn(|k| high[k] - low[k]);
        for k in 0..2 {
            let pad = extent[k] * (K as f64 * OVERLAP) + noise;
            if !(low[k] <= pad && high[k] >= -pad) {
                return;
            }
        }
        if let Some((start, bend)) = certain(part, noise) {
            let slack = 0.5 + 0.5 * bend + 4.0 * OVERLAP;
            // Where the rounding error is large in comparison with the piece, `approach` decides.
            if start.iter().all(|x| (x - 0.5).abs() <= slack)
                || extent.iter().any(|e| *e < POINT * noise)
            {
                self.approach(rectangle, start);
            }
            return;
        }
        let Some(thickness) = thickness(part, noise) else {
            return;
        };
        let is_point = extent.iter().all(|e| *e <= POINT * noise);
        // The ray lies in the surface, or the surface is a line.
        let is_over = thickness <= 4.0 * noise || depth == 0 || self.halvings == 0;
        // What neighbours know of a border decides about slivers, too.
        if is_point || is_over && self.seam > 0.0 {
            self.give_up(rectangle);
            return;
        }
        if is_over {
            return;
        }
        self.halvings -= 1;
        let longer = |most: f64, s: [f64; 2]| {
            let square = s[0] * s[0] + s[1] * s[1];
            if square > most { square } else { most }
        };
        let along_u = part.slopes_u().fold(0.0, longer) >= part.slopes_v().fold(0.0, longer);
        let halves = if along_u {
            part.halves_u()
        } else {
            part.halves_v()
        };
        let axis = usize::from(!along_u);
        let mut half = *rectangle;
        half.size[axis] *= 0.5;
        for part in &halves {
            self.divide(part, noise, &half, depth - 1);
            half.from[axis] += half.size[axis];
        }
    }

    /// Leaves it to the border of the patch whether there is a hit in a rectangle.
    fn give_up(&mut self, rectangle: &Rectangle) {
        let [u, v] = std::array::from_fn(|k| rectangle.from[k] + 0.5 * rectangle.size[k]);
        self.add(Candidate {
            t: self.frame.t(project(self.net.at(u, v))),
            u,
            v,
            sign: 0,
            zone: rectangle.size,
            is_doubtful: true,
        });
    }

    /// Looks for the parameters at which the ray meets the patch, within (nearly) a rectangle.
    fn approach(&mut self, rectangle: &Rectangle, start: [f64; 2]) {
        let (net, frame, seam) = (self.net, self.frame, self.seam);
        let Rectangle { from, size } = rectangle;
        let start = [from[0] + start[0] * size[0], from[1] + start[1] * size[1]];
        let found = dispatch!(Simd::best(), isa => {
            let (ways, noise) = ways(isa, net, frame);
            newton(isa, (&ways, noise + seam), frame, (rectangle, rectangle), start)
        });
        match found {
            Found::Nothing => {}
            Found::Lost => self.give_up(rectangle),
            // What neighbours know of a border decides about slivers.
            Found::Near(_) if seam > 0.0 => self.give_up(rectangle),
            Found::Near(candidate) | Found::Hit(candidate) => self.add(candidate),
        }
    }

    fn add(&mut self, candidate: Candidate) {
        // Where a candidate is doubtful, all of them are looked at, whether they are kept or not.
        let [u, v] = candidate.place();
        let is_kept = candidate.is_doubtful || self.keep.is_none_or(|keep| keep(u, v));
        if !is_kept && !matches!(self.aim, Aim::All(_)) {
            return;
        }
        match &mut self.aim {
            Aim::All(list) => list.push(candidate),
            Aim::Any {
                range,
                found,
                is_doubtful,
            } => {
                *is_doubtful |= candidate.is_doubtful;
                *found |= !candidate.is_doubtful && range.accepts(candidate.t);
            }
            Aim::Nearest {
                range,
                nearest,
                is_doubtful,
            } => {
                *is_doubtful |= candidate.is_doubtful;
                if range.accepts(candidate.t) && nearest.is_none_or(|n| candidate.t < n.t) {
                    *nearest = Some(candidate);
                }
            }
        }
    }
}

impl<const K: usize> Visitor for Search<'_, K> {
    fn range(&self) -> Option<Interval> {
        match &self.aim {
            Aim::All(_) => Some(Interval::LINE),
            Aim::Nearest {
                is_doubtful: true, ..
            } => None,
            Aim::Any {
                range,
                found: false,
                is_doubtful: false,
            } => Some(*range),
            Aim::Any { .. } => None,
            Aim::Nearest { range, nearest, .. } => {
                Some(nearest.map_or(*range, |n| range.with_max(n.t)))
            }
        }
    }

    fn certain(&mut self, square: Square, start: [f64; 2]) {
        self.approach(&Rectangle::of(square), start);
    }

    fn uncertain(&mut self, square: Square, curving: &Curving) {
        let (net, frame, seam) = (self.net, self.frame, self.seam);
        let piece = Rectangle::of(square);
        let found = dispatch!(Simd::best(), isa => {
            let (ways, noise) = ways(isa, net, frame);
            graze::search(isa, (&ways, noise + seam), frame, &piece, curving)
        });
        if let Some(found) = found {
            for candidate in found {
                self.add(candidate);
            }
            return;
        }
        let reach = net.points().fold(0.0, |most: f64, p| {
            let size = frame.to(p).abs().max_element();
            if size > most { size } else { most }
        });
        let Square { level, i, j } = square;
        let part = frame
            .view(net)
            .part(u32::from(level), u32::from(i), u32::from(j));
        let noise = reach * gamma(4 * K as u32) + seam;
        self.divide(&part, noise, &piece, DEPTH);
    }
}

/// The control points of a patch as the way from the origin of a ray to them, times their weights, and the weights.
pub(super) type Ways<I, const K: usize> = [[<I as Isa>::F64x4; K]; K];

/// The ways to all control points, and a bound of the rounding error of what is computed from them.
#[inline(always)]
fn ways<I: Isa, const K: usize>(isa: I, net: &Net<4, K>, frame: &Frame) -> (Ways<I, K>, f64) {
    let zero = isa.splat(0.0);
    let (mut ways, mut largest) = ([[zero; K]; K], zero);
    let o = frame.origin;
    let origin = isa.load(&[o.x, o.y, o.z, 0.0]);
    for (row, own) in net.rows.iter().zip(&mut ways) {
        for (p, way) in row.iter().zip(own) {
            *way = if p[3] == 1.0 {
                isa.sub(isa.load(p), origin)
            } else {
                let DVec3 { x, y, z } = frame.to(p);
                isa.load(&[x, y, z, p[3]])
            };
            largest = isa.max(largest, isa.abs(*way));
        }
    }
    let [x, y, z, _] = isa.store(largest);
    let largest = if x > y { x } else { y };
    let largest = if z > largest { z } else { largest };
    (ways, largest * gamma(4 * K as u32))
}

/// The sum of coefficients times weights.
#[inline(always)]
fn weighted<I: Isa, const K: usize>(isa: I, c: &[I::F64x4; K], w: &[f64; K]) -> I::F64x4 {
    let mut sum = isa.mul(c[0], isa.splat(w[0]));
    for i in 1..K {
        sum = isa.add(sum, isa.mul(c[i], isa.splat(w[i])));
    }
    sum
}

/// The value and both derivatives, as [`Net::jet`].
#[inline(always)]
pub(super) fn jet<I: Isa, const K: usize>(isa: I, ways: &Ways<I, K>, [u, v]: [f64; 2]) -> Jet<4> {
    let ((bu, su), (bv, sv)) = (bernstein::<K>(u), bernstein::<K>(v));
    let zero = isa.splat(0.0);
    let (mut values, mut slopes) = ([zero; K], [zero; K]);
    for j in 0..K {
        values[j] = weighted(isa, &ways[j], &bu);
        slopes[j] = weighted(isa, &ways[j], &su);
    }
    Jet {
        value: isa.store(weighted(isa, &values, &bv)),
        by_u: isa.store(weighted(isa, &slopes, &bv)),
        by_v: isa.store(weighted(isa, &values, &sv)),
    }
}

/// A number, or the nearer end of a range if it is outside.
#[inline(always)]
fn clamped(x: f64, low: f64, high: f64) -> f64 {
    if x < low {
        low
    } else if x > high {
        high
    } else {
        x
    }
}

/// What Newton's method has found.
pub(super) enum Found {
    /// There is no hit of the piece within (nearly) the window.
    Nothing,
    /// The surface is folded or collapsed there: nothing is known.
    Lost,
    /// It has not come to rest, but it ended in the window: there may be a hit there.
    Near(Candidate),
    /// A hit to the last digits.
    Hit(Candidate),
}

/// Newton's method for the parameters at which a ray meets a patch: those of a hit of the piece, if it has one within (nearly) the
/// window.
#[inline(always)]
pub(super) fn newton<I: Isa, const K: usize>(
    isa: I,
    (ways, noise): (&Ways<I, K>, f64),
    frame: &Frame,
    (window, piece): (&Rectangle, &Rectangle),
    start: [f64; 2],
) -> Found {
    let low = [
        window.from[0] - 0.25 * window.size[0],
        window.from[1] - 0.25 * window.size[1],
    ];
    let high = [
        window.from[0] + 1.25 * window.size[0],
        window.from[1] + 1.25 * window.size[1],
    ];
    let Rectangle { from, size } = *piece;
    let to = [from[0] + size[0], from[1] + size[1]];
    let mut at = [
        clamped(start[0], window.from[0], window.from[0] + window.size[0]),
        clamped(start[1], window.from[1], window.from[1] + window.size[1]),
    ];
    let seen = |v: &[f64; 4]| frame.seen(DVec3::new(v[0], v[1], v[2]));
    for round in 0..ROUNDS {
        let mut jet_here = jet(isa, ways, at);
        let Jet { value, by_u, by_v } = jet_here;
        let (f, a, b) = (seen(&value), seen(&by_u), seen(&by_v));
        let determinant = a[0] * b[1] - a[1] * b[0];
        let mut step = [
            (f[0] * b[1] - f[1] * b[0]) / determinant,
            (f[1] * a[0] - f[0] * a[1]) / determinant,
        ];
        if !(step[0].is_finite() && step[1].is_finite()) {
            return Found::Lost;
        }
        let is_last = step[0].abs() < LAST_STEP * size[0] && step[1].abs() < LAST_STEP * size[1];
        if !is_last {
            // Not far beyond the piece.
            let before = at;
            for k in 0..2 {
                at[k] = clamped(at[k] - step[k], low[k], high[k]);
            }
            // Without a hit in the window it stays where it is held back.
            if round + 1 < ROUNDS && at != before {
                continue;
            }
            (jet_here, step) = (jet(isa, ways, at), [0.0; 2]);
        } else {
            at = [at[0] - step[0], at[1] - step[1]];
        }
        let length = |v: [f64; 2]| (v[0] * v[0] + v[1] * v[1]).sqrt();
        let error = 16.0 * noise / determinant.abs();
        let zone = [
            OVERLAP * size[0] + error * length(b),
            OVERLAP * size[1] + error * length(a),
        ];
        let mut is_doubtful = !is_last;
        for k in 0..2 {
            let (before, after) = (at[k] - from[k], to[k] - at[k]);
            if before < -zone[k] || after < -zone[k] {
                return Found::Nothing;
            }
            // What does not come to rest has no hit in the window, if it gets out of it.
            let rim = zone[k] - OVERLAP * (size[k] - window.size[k]);
            let (before, after) = (
                at[k] - window.from[k],
                window.from[k] + window.size[k] - at[k],
            );
            if !is_last && (before < -rim || after < -rim) {
                return Found::Nothing;
            }
            let (before, after) = (at[k] - from[k], to[k] - at[k]);
            is_doubtful |= before <= zone[k] || after <= zone[k];
        }
        let candidate = Candidate {
            t: frame.t_of(&jet_here, step),
            u: at[0],
            v: at[1],
            sign: if determinant > 0.0 { 1 } else { -1 },
            zone,
            is_doubtful,
        };
        return if is_last {
            Found::Hit(candidate)
        } else {
            Found::Near(candidate)
        };
    }
    Found::Nothing
}

/// If a part of a map is nearly linear: where its only zero is, nearly, if it has one, and how far it is from linear.
fn certain<const K: usize>(part: &Net<2, K>, noise: f64) -> Option<([f64; 2], f64)> {
    let count = (K * (K - 1)) as f64;
    let add = |sum: [f64; 2], s: [f64; 2]| [sum[0] + s[0], sum[1] + s[1]];
    let a = part.slopes_u().fold([0.0; 2], add).map(|x| x / count);
    let b = part.slopes_v().fold([0.0; 2], add).map(|x| x / count);
    let per = 1.0 / (a[0] * b[1] - a[1] * b[0]);
    if !per.is_finite() {
        return None;
    }
    // The inverse of the mean derivative makes all derivatives nearly the unit matrix.
    let solved = |s: [f64; 2]| {
        [
            (s[0] * b[1] - s[1] * b[0]) * per,
            (s[1] * a[0] - s[0] * a[1]) * per,
        ]
    };
    let off = |unit: [f64; 2]| {
        move |most: [f64; 2], s: [f64; 2]| {
            let s = solved(s);
            std::array::from_fn(|k| {
                let x = (s[k] - unit[k]).abs();
                if x > most[k] { x } else { most[k] }
            })
        }
    };
    let u = part.slopes_u().fold([0.0; 2], off([1.0, 0.0]));
    let v = part.slopes_v().fold([0.0; 2], off([0.0, 1.0]));
    let size = |v: [f64; 2]| v[0].abs() + v[1].abs();
    let blur = (4 * (K - 1)) as f64 * noise * (size(a) + size(b)) * per.abs();
    let bend = (u[0] + v[0]).max(u[1] + v[1]) + blur;
    (bend < NEARLY_LINEAR).then(|| (solved(part.at(0.5, 0.5)).map(|x| 0.5 - x), bend))
}

/// How far a part reaches across its longest direction, or `None` if the origin is beside it: a surface seen almost from its
/// edge is a narrow strip.
fn thickness<const K: usize>(part: &Net<2, K>, noise: f64) -> Option<f64> {
    let from = part.rows[0][0];
    let square = |d: [f64; 2]| d[0] * d[0] + d[1] * d[1];
    let along = part.points().fold([0.0; 2], |best: [f64; 2], p| {
        let d = [p[0] - from[0], p[1] - from[1]];
        if square(d) > square(best) { d } else { best }
    });
    let length = square(along).sqrt();
    if length == 0.0 {
        return Some(0.0);
    }
    let along = along.map(|x| x / length);
    let across = |p: &[f64; 2]| along[0] * p[1] - along[1] * p[0];
    let (low, high) =
        part.points()
            .map(across)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (
                    if x < low { x } else { low },
                    if x > high { x } else { high },
                )
            });
    let pad = (high - low) * (K as f64 * OVERLAP) + 2.0 * noise;
    (low <= pad && high >= -pad).then_some(high - low)
}
