//! The search for the points at which a ray meets a patch.
//!
//! Seen along the ray, the patch is a map from two parameters to the plane, and its hits are the parameters that are mapped
//! to the origin. On a piece where the map is nearly linear, so that Newton's method certainly finds its only hit or
//! there is none (the condition of Kantorovich, here from bounds of the derivatives), it is used. Pieces that are seen at a low angle
//! are searched through smaller and smaller windows ([`graze`]); where that takes too long, they are halved
//! (Nishita, Sederberg, Kakimoto, "Ray tracing trimmed rational surface patches", SIGGRAPH 1990; Martin, Cohen, Fish, Shirley,
//! "Practical ray tracing of trimmed NURBS surfaces", Journal of Graphics Tools 5(1), 2000).

use super::frame::Frame;
use super::graze;
use super::hull::{OVERLAP, project};
use super::leaf::NEARLY_LINEAR;
use super::net::Net;
use super::newton::{Candidate, Found, Rectangle, newton, ways};
use super::piece::{Curving, PatchPlace, Square};
use super::tree::{Tree, Visitor};
use strahl_math::Interval;
use strahl_math::error::gamma;
use strahl_simd::{Simd, dispatch};

/// A ray may halve pieces so often; it needs more only if it lies within the surface.
const HALVINGS: u32 = 2000;
/// A piece that is seen smaller than so many times the rounding error counts as a point.
const POINT: f64 = 1e4;
/// A piece is halved so often at most.
const DEPTH: u32 = 90;

/// A search with what it has found.
pub(super) struct Search<'a, const K: usize> {
    net: &'a Net<4, K>,
    tree: &'a Tree,
    frame: &'a Frame,
    /// How far the net may be from what neighbours know of it.
    seam: f64,
    halvings: u32,
    keep: Keep<'a>,
    /// Where the ray starts, if it leaves the patch.
    start: Option<PatchPlace>,
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
            start: None,
            aim,
        }
    }

    /// Leaves the place aside at which the ray starts.
    pub(super) fn from(mut self, start: Option<PatchPlace>) -> Self {
        self.start = start;
        self
    }

    /// Adds to the rounding error how far the net may be from what neighbours know of it.
    pub(super) fn with_seam(mut self, seam: f64) -> Self {
        self.seam = seam;
        self
    }

    /// Visits the pieces along the ray.
    pub(super) fn run(&mut self) {
        let (net, tree, frame) = (self.net, self.tree, self.frame);
        tree.walk(net, (frame, self.start), self);
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

    fn wants_any(&self) -> bool {
        self.keep.is_none() && matches!(self.aim, Aim::Any { .. })
    }

    fn met(&mut self) {
        if let Aim::Any { found, .. } = &mut self.aim {
            *found = true;
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
