//! A face of a shell: a trimmed surface that is continued a little beyond its border.

use super::super::Nurbs;
use super::super::part::Part;
use super::super::trim::Region;
use super::arc::Arc as Curve;
use super::boxes::Boxes;
use std::sync::Arc;
use strahl_math::{Aabb, DVec2, DVec3};

/// A side that is shorter than this part of the surface is collapsed to a point: it is no border.
const COLLAPSED: f64 = 1e-9;
/// How far from a side a place is looked at to know whether the side is a border of what the loops leave.
const ASIDE: f64 = 1e-6;
/// Places are this much beyond the square of the parameters at most, to count as of its border.
const SLACK: f64 = 1e-9;
/// A surface is continued by this part of a patch at most.
const LONGEST: f64 = 1.0 / 16.0;
/// It is continued so many times further than it need be, since it curves.
const SPARE: f64 = 1.5;
/// Each side of a patch is divided into so many pieces.
const PIECES: usize = 8;
/// Newton's method takes so many steps at most.
const ROUNDS: u32 = 12;

/// A face of the shell.
#[derive(Debug)]
pub(super) struct Face {
    parts: Vec<Part>,
    grid: Grid,
    region: Option<Arc<Region>>,
    /// The pieces of the border: first those of the loops, then those of the four sides.
    pub(super) curves: Vec<Curve>,
    /// How many of them are of loops.
    loops: usize,
    boxes: Boxes<2>,
    /// Which sides are collapsed: those at the ends of u, and of v.
    is_collapsed: [[bool; 2]; 2],
}

/// Which part is where.
#[derive(Debug)]
struct Grid {
    /// The parameters at which parts begin.
    starts: [Vec<f64>; 2],
    /// Row after row.
    parts: Vec<Option<u32>>,
}

impl Grid {
    fn new(parts: &[Part]) -> Self {
        let starts = [0, 1].map(|k| {
            let mut all: Vec<f64> = parts.iter().map(|part| part.from[k]).collect();
            all.sort_by(f64::total_cmp);
            all.dedup();
            all
        });
        let mut grid = Self {
            parts: vec![None; starts[0].len() * starts[1].len()],
            starts,
        };
        for (number, part) in (0..).zip(parts) {
            let cell = grid.cell(part.from);
            if let Some(place) = cell.and_then(|cell| grid.parts.get_mut(cell)) {
                *place = Some(number);
            }
        }
        grid
    }

    fn cell(&self, place: [f64; 2]) -> Option<usize> {
        let [i, j] = [0, 1].map(|k| self.starts[k].partition_point(|s| *s <= place[k]));
        Some(i.checked_sub(1)? + j.checked_sub(1)? * self.starts[0].len())
    }

    fn at(&self, place: [f64; 2]) -> Option<u32> {
        self.parts.get(self.cell(place)?).copied().flatten()
    }
}

/// What a face tells about a place of its surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Standing {
    /// Whether the face is there.
    pub(super) is_on: bool,
    /// How far the border is in space, if it is near.
    pub(super) distance: Option<f64>,
}

impl Face {
    /// The face of a surface, not continued yet.
    pub(super) fn new(surface: &Nurbs) -> Self {
        let size = surface.whole.size().length();
        let parts: Vec<Part> = surface.parts.iter().map(Part::copy).collect();
        let region = surface.trimming.clone();
        let mut curves: Vec<Curve> = vec![];
        if let Some(region) = &region {
            curves.extend(region.arcs().map(Curve::new));
        }
        let mut face = Self {
            grid: Grid::new(&parts),
            parts,
            region,
            loops: curves.len(),
            curves,
            boxes: Boxes::new(vec![]),
            is_collapsed: [[false; 2]; 2],
        };
        for axis in 0..2 {
            for end in 0..2 {
                let side = face.side(axis, end);
                let pieces = side.iter().map(|curve| face.length(curve));
                face.is_collapsed[axis][end] = pieces.sum::<f64>() <= COLLAPSED * size;
                if !face.is_collapsed[axis][end] {
                    face.curves.extend(side);
                }
            }
        }
        face.boxes = Boxes::new(face.curves.iter().map(Curve::bounds).collect());
        face
    }

    /// The pieces of the side at the begin or the end of u or v.
    fn side(&self, axis: usize, end: usize) -> Vec<Curve> {
        let mut stops = self.grid.starts[1 - axis].clone();
        stops.push(1.0);
        let mut pieces = vec![];
        for stop in stops.windows(2) {
            let place = |k: usize| {
                let s = k as f64 / PIECES as f64;
                let x = stop[0] * (1.0 - s) + stop[1] * s;
                if axis == 0 {
                    DVec2::new(end as f64, x)
                } else {
                    DVec2::new(x, end as f64)
                }
            };
            pieces.extend((0..PIECES).map(|k| Curve::line(place(k), place(k + 1))));
        }
        pieces
    }

    /// How long a short curve is in space, where there is a surface.
    fn length(&self, curve: &Curve) -> f64 {
        let ends = [0.0, 0.5, 1.0].map(|s| self.jet(curve.at(s)[0]).map(|jet| jet[0]));
        let way = |pair: &[Option<DVec3>]| match pair {
            [Some(a), Some(b)] => (*b - *a).length(),
            _ => 0.0,
        };
        ends.windows(2).map(way).sum()
    }

    /// A box around the border and the parts that are not trimmed: what is cut away does not count.
    pub(super) fn extent(&self) -> Aabb {
        let whole = self.parts.iter().filter(|part| !part.is_trimmed);
        let whole = whole.map(|part| part.patch.bounds());
        let curves = 0..self.curves.len();
        let border = curves.flat_map(|curve| [0.0, 0.5, 1.0].map(|s| self.border(curve, s)));
        let border = border.flatten().map(|(_, point)| Aabb::new(point, point));
        whole
            .chain(border)
            .fold(Aabb::EMPTY, |all, own| all.union(&own))
    }

    pub(super) fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// The point and its derivatives by the parameters of the surface, in a part.
    pub(super) fn jet_in(&self, part: &Part, local: [f64; 2]) -> [DVec3; 3] {
        let [point, by_u, by_v] = part.patch.jet(local[0], local[1]);
        let [across, up] = [0, 1].map(|k| part.to[k] - part.from[k]);
        [point, by_u / across, by_v / up]
    }

    /// The number of the part at a place, and its own parameters there.
    pub(super) fn locate(&self, place: DVec2) -> Option<(usize, [f64; 2])> {
        let number = self.grid.at(place.to_array())? as usize;
        let part = self.parts.get(number)?;
        let local = [0, 1].map(|k| (place[k] - part.from[k]) / (part.to[k] - part.from[k]));
        Some((number, local))
    }

    /// The point and its derivatives at a place, if there is a surface.
    fn jet(&self, place: DVec2) -> Option<[DVec3; 3]> {
        let (number, local) = self.locate(place)?;
        Some(self.jet_in(&self.parts[number], local))
    }

    /// Whether what the loops leave reaches the side of the surface at a place.
    fn reaches_side(&self, place: DVec2) -> bool {
        let inner = place.clamp(DVec2::splat(ASIDE), DVec2::splat(1.0 - ASIDE));
        let region = self.region.as_ref();
        region.is_none_or(|region| region.contains(inner.to_array()))
    }

    /// The place and the point of a piece of the border at a parameter from 0 to 1, unless the face does not reach it.
    pub(super) fn border(&self, curve: usize, s: f64) -> Option<(DVec2, DVec3)> {
        let place = self.curves.get(curve)?.at(s)[0];
        let inner = place.clamp(DVec2::ZERO, DVec2::ONE);
        if (place - inner).abs().max_element() > SLACK {
            return None;
        }
        if curve >= self.loops && !self.reaches_side(inner) {
            return None;
        }
        Some((inner, self.jet(inner)?[0]))
    }

    /// The nearest place of a piece of the border to a point, and how far it is: by Newton's method from the parameter `start`.
    pub(super) fn nearest_on(
        &self,
        curve: usize,
        start: f64,
        point: DVec3,
    ) -> Option<(DVec2, f64)> {
        let (mut s, mut best) = (start, None);
        for _ in 0..ROUNDS {
            let [place, by] = self.curves.get(curve)?.at(s);
            let inner = place.clamp(DVec2::ZERO, DVec2::ONE);
            if (place - inner).abs().max_element() > SLACK {
                break;
            }
            let [at, by_u, by_v] = self.jet(inner)?;
            let way = point - at;
            let distance = way.length();
            if best.is_none_or(|(_, least)| distance < least) {
                best = Some((inner, distance));
            }
            let along = by_u * by.x + by_v * by.y;
            let next = (s + way.dot(along) / along.length_squared()).clamp(0.0, 1.0);
            if !next.is_finite() || next == s {
                break;
            }
            s = next;
        }
        best.filter(|(place, _)| curve < self.loops || self.reaches_side(*place))
    }

    /// Continues the surface beyond its sides, at least as far as this in space unless it is too short.
    pub(super) fn continue_by(&mut self, reach: f64) {
        let by: [[f64; 2]; 2] = std::array::from_fn(|axis| {
            std::array::from_fn(|end| {
                if self.is_collapsed[axis][end] {
                    0.0
                } else {
                    self.beyond(axis, end, reach)
                }
            })
        });
        let continued = |part: &Part| {
            let size = [0, 1].map(|k| part.to[k] - part.from[k]);
            let (mut from, mut to) = (part.from, part.to);
            let mut parts = [[0.0; 2]; 2];
            for k in 0..2 {
                if part.from[k] == 0.0 {
                    from[k] -= by[k][0];
                    parts[k][0] = by[k][0] / size[k];
                }
                if part.to[k] == 1.0 {
                    to[k] += by[k][1];
                    parts[k][1] = by[k][1] / size[k];
                }
            }
            let patch = part.patch.extended(parts)?;
            Some(Part {
                patch,
                from,
                to,
                ..*part
            })
        };
        // All parts or none, so that they still fit together.
        if let Some(parts) = self.parts.iter().map(continued).collect() {
            self.parts = parts;
        }
    }

    /// By how much of its parameter the surface is continued beyond a side.
    fn beyond(&self, axis: usize, end: usize, reach: f64) -> f64 {
        let middles = self.side(axis, end).into_iter().map(|c| c.at(0.5)[0]);
        let speeds = middles.filter_map(|place| Some(self.jet(place)?[1 + axis].length()));
        let slowest = speeds.fold(f64::INFINITY, f64::min);
        let at_side = |part: &&Part| {
            if end == 0 {
                part.from[axis] == 0.0
            } else {
                part.to[axis] == 1.0
            }
        };
        let sizes = self.parts.iter().filter(at_side);
        let size = sizes
            .map(|part| part.to[axis] - part.from[axis])
            .fold(1.0, f64::min);
        let by = SPARE * reach / slowest;
        by.min(LONGEST * size)
    }

    /// What is known of a place of part `number`, where the border matters up to this distance.
    pub(super) fn standing(&self, number: usize, local: [f64; 2], reach: f64) -> Standing {
        let Some(part) = self.parts.get(number) else {
            return Standing {
                is_on: false,
                distance: None,
            };
        };
        let place = DVec2::from_array(part.place(local));
        let is_in_square = place.min_element() >= 0.0 && place.max_element() <= 1.0;
        let is_left = match &self.region {
            Some(region) if part.is_trimmed => region.contains(place.to_array()),
            _ => true,
        };
        // Lengths in space of small steps in the plane of the parameters.
        let [_, by_u, by_v] = self.jet_in(part, local);
        let (a, b, c) = (by_u.dot(by_u), by_u.dot(by_v), by_v.dot(by_v));
        let determinant = (a * c - b * b).max(0.0);
        let width = |other: f64| {
            let w = reach * (other / determinant).sqrt();
            // Where the surface is collapsed, all of the border may be near.
            if w < 1.0 { w } else { 1.0 }
        };
        let half = DVec2::new(width(c), width(a));
        let in_space = |p: DVec2| {
            let d = p - place;
            let ((x, y), (long, short)) = if a >= c {
                ((d.x, d.y), (a, c))
            } else {
                ((d.y, d.x), (c, a))
            };
            if long == 0.0 || short.is_nan() {
                return DVec2::ZERO;
            }
            let root = long.sqrt();
            DVec2::new(x * root + y * (b / root), y * (determinant / long).sqrt())
        };
        let mut least = reach;
        let mut reaches_side = None;
        let near = [(place - half).to_array(), (place + half).to_array()];
        self.boxes.meeting(&near, |k| {
            let counts =
                k < self.loops || *reaches_side.get_or_insert_with(|| self.reaches_side(place));
            if counts {
                least = self.curves[k].distance(in_space, least);
            }
        });
        Standing {
            is_on: is_in_square && is_left,
            distance: (least < reach).then_some(least),
        }
    }
}
