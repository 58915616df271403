//! The search for the points at which a ray meets a patch.
//!
//! Seen along the ray, the patch is a map from two parameters to the plane, and its hits are the parameters that are mapped
//! to the origin. On a piece where the map is nearly linear, so that Newton's method certainly finds its only hit or
//! there is none (the condition of Kantorovich, here from bounds of the derivatives), it is used; other pieces are halved
//! (Nishita, Sederberg, Kakimoto, "Ray tracing trimmed rational surface patches", SIGGRAPH 1990; Martin, Cohen, Fish, Shirley,
//! "Practical ray tracing of trimmed NURBS surfaces", Journal of Graphics Tools 5(1), 2000).

use super::net::{Jet, Net};
use super::tree::{LEVELS, OVERLAP, Piece, Tree, project};
use strahl_math::error::gamma;
use strahl_math::{DVec3, Interval, Ray};

/// The map of a piece may differ from a linear one by this part at most for Newton's method to be certain.
const NEARLY_LINEAR: f64 = 0.35;
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
    along: DVec3,
    across: [DVec3; 2],
    /// The length of its direction.
    length: f64,
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
    fn seen(&self, v: DVec3) -> [f64; 2] {
        self.across.map(|axis| axis.dot(v))
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

    /// How far within the border it lies, in units of its zone; negative outside.
    pub(super) fn margin(&self) -> f64 {
        let side = |x: f64, zone: f64| if x < 0.5 { x / zone } else { (1.0 - x) / zone };
        let [u, v] = [side(self.u, self.zone[0]), side(self.v, self.zone[1])];
        if u < v { u } else { v }
    }
}

/// A rectangle of parameters.
#[derive(Clone, Copy, Debug)]
struct Rectangle {
    from: [f64; 2],
    size: [f64; 2],
}

/// A search with what it has found.
pub(super) struct Search<'a, const K: usize> {
    net: &'a Net<4, K>,
    tree: &'a Tree,
    frame: &'a Frame,
    /// The patch seen along the ray, and a bound of its rounding error, when they are needed.
    view: Option<(Net<2, K>, f64)>,
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
            view: None,
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

    /// The range in which hits are still wanted; `None` if the search is over.
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

    /// Visits the pieces along the ray, the nearer ones of four first.
    pub(super) fn run(&mut self) {
        let (tree, frame) = (self.tree, self.frame);
        let origin = frame.origin - tree.anchor;
        let inverse = DVec3::ONE / frame.along;
        // What is seen from the side mixes the rounding errors of all axes.
        let magnitude = frame.origin.abs() + tree.anchor.abs() + DVec3::splat(tree.size);
        let pad = DVec3::splat(magnitude.max_element() * gamma(64));
        let enter = |piece: &Piece, range: Interval| {
            let (mut near, mut far) = (range.min * frame.length, range.max * frame.length);
            for k in 0..3 {
                let low = (f64::from(piece.low[k]) - pad[k] - origin[k]) * inverse[k];
                let high = (f64::from(piece.high[k]) + pad[k] - origin[k]) * inverse[k];
                let (a, b) = if inverse[k] < 0.0 {
                    (high, low)
                } else {
                    (low, high)
                };
                // Comparisons with NaN, when the ray runs within a side, change nothing.
                if a > near {
                    near = a;
                }
                if b < far {
                    far = b;
                }
            }
            (near <= far).then_some(near)
        };
        let blur = tree.blur + pad.length() + self.seam;
        // Three of four quarters wait on each level.
        let mut stack = [(0_u32, 0.0); 3 * LEVELS as usize + 1];
        let mut height = 0;
        let Some(root) = tree.pieces.first() else {
            return;
        };
        if let Some(near) = self.range().and_then(|range| enter(root, range)) {
            stack[0] = (0, near);
            height = 1;
        }
        while height > 0 {
            height -= 1;
            let (index, near) = stack[height];
            let Some(range) = self.range() else { return };
            let Some(piece) = tree.pieces.get(index as usize) else {
                continue;
            };
            if near > range.max * frame.length {
                continue;
            }
            if piece.first == 0 {
                self.piece(piece, blur);
                continue;
            }
            let base = height;
            for index in piece.first..piece.first + 4 {
                let Some(near) = tree
                    .pieces
                    .get(index as usize)
                    .and_then(|p| enter(p, range))
                else {
                    continue;
                };
                // The nearest one on top.
                let mut at = height;
                while at > base && stack[at - 1].1 < near {
                    stack[at] = stack[at - 1];
                    at -= 1;
                }
                stack[at] = (index, near);
                height += 1;
            }
        }
    }

    /// Searches a piece of the tree.
    fn piece(&mut self, piece: &Piece, blur: f64) {
        let frame = self.frame;
        let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
        let side = 1.0 / f64::from(1_u32 << piece.level);
        let rectangle = Rectangle {
            from: [piece.i, piece.j].map(|k| f64::from(k) * side),
            size: [side; 2],
        };
        let (a, b) = (
            frame.seen(vector(piece.by_u)),
            frame.seen(vector(piece.by_v)),
        );
        let determinant = a[0] * b[1] - a[1] * b[0];
        let per = 1.0 / determinant;
        let row_u = (b[0] * b[0] + b[1] * b[1]).sqrt() * per.abs();
        let row_v = (a[0] * a[0] + a[1] * a[1]).sqrt() * per.abs();
        let spread = |spread: f32| f64::from(spread) + self.tree.size * gamma(16);
        let bend = spread(piece.spread_u) * row_u + spread(piece.spread_v) * row_v;
        if bend < NEARLY_LINEAR {
            let f = frame.seen(vector(piece.middle) + (self.tree.anchor - frame.origin));
            let step = [
                (f[0] * b[1] - f[1] * b[0]) * per,
                (f[1] * a[0] - f[0] * a[1]) * per,
            ];
            // The hit is no further from here than this part of the piece, or there is none.
            let reach = 0.5 * bend;
            let slack = 4.0 * OVERLAP;
            let is_near = |step: f64, own: f64, other: f64| {
                let ratio = own / other;
                let ratio = if ratio > 1.0 { ratio } else { 1.0 };
                step.abs() <= 0.5 + reach * ratio + slack + blur * own
            };
            if is_near(step[0], row_u, row_v) && is_near(step[1], row_v, row_u) {
                self.approach(&rectangle, step.map(|x| 0.5 - x));
            }
            return;
        }
        let part = self.view().0.part(
            u32::from(piece.level),
            u32::from(piece.i),
            u32::from(piece.j),
        );
        self.divide(&part, &rectangle, DEPTH);
    }

    fn view(&mut self) -> (Net<2, K>, f64) {
        let (net, frame, seam) = (self.net, self.frame, self.seam);
        *self.view.get_or_insert_with(|| {
            let reach = net.points().fold(0.0, |most: f64, p| {
                let size = frame.to(p).abs().max_element();
                if size > most { size } else { most }
            });
            (frame.view(net), reach * gamma(4 * K as u32) + seam)
        })
    }

    /// Searches a piece that is seen as `part`, and halves it as long as nothing is certain about it.
    fn divide(&mut self, part: &Net<2, K>, rectangle: &Rectangle, depth: u32) {
        let (_, noise) = self.view();
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
            self.divide(part, &half, depth - 1);
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

    /// Newton's method for the parameters at which the ray meets the patch, within (nearly) a rectangle.
    fn approach(&mut self, rectangle: &Rectangle, start: [f64; 2]) {
        let (view, noise) = self.view();
        let Rectangle { from, size } = *rectangle;
        let within = |x: f64, slack: f64, k: usize| {
            let (low, high) = (from[k] - slack, from[k] + size[k] + slack);
            if x < low {
                low
            } else if x > high {
                high
            } else {
                x
            }
        };
        let mut at: [f64; 2] =
            std::array::from_fn(|k| within(from[k] + start[k] * size[k], 0.0, k));
        for round in 0..ROUNDS {
            let Jet { value, by_u, by_v } = view.jet(at[0], at[1]);
            let determinant = by_u[0] * by_v[1] - by_u[1] * by_v[0];
            let step = [
                (value[0] * by_v[1] - value[1] * by_v[0]) / determinant,
                (value[1] * by_u[0] - value[0] * by_u[1]) / determinant,
            ];
            if !(step[0].is_finite() && step[1].is_finite()) {
                self.give_up(rectangle);
                return;
            }
            let is_last =
                step[0].abs() < LAST_STEP * size[0] && step[1].abs() < LAST_STEP * size[1];
            at = std::array::from_fn(|k| {
                let next = at[k] - step[k];
                if is_last {
                    next
                } else {
                    within(next, 0.25 * size[k], k)
                }
            });
            if !(is_last || round + 1 == ROUNDS) {
                continue;
            }
            if !is_last && self.seam > 0.0 {
                self.give_up(rectangle);
                return;
            }
            let length = |v: [f64; 2]| (v[0] * v[0] + v[1] * v[1]).sqrt();
            let error = 16.0 * noise / determinant.abs();
            let zone = [
                OVERLAP * size[0] + error * length(by_v),
                OVERLAP * size[1] + error * length(by_u),
            ];
            let mut is_doubtful = !is_last;
            for k in 0..2 {
                let (before, after) = (at[k] - from[k], from[k] + size[k] - at[k]);
                if before < -zone[k] || after < -zone[k] {
                    return;
                }
                is_doubtful |= before <= zone[k] || after <= zone[k];
            }
            let clamp = |x: f64| x.clamp(0.0, 1.0);
            self.add(Candidate {
                t: self
                    .frame
                    .t(project(self.net.at(clamp(at[0]), clamp(at[1])))),
                u: at[0],
                v: at[1],
                sign: if determinant > 0.0 { 1 } else { -1 },
                zone,
                is_doubtful,
            });
            return;
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
