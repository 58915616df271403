//! Whether faces close a volume: each border must be that of another face, too.

use super::boxes::{Bounds, Boxes};
use super::face::Face;
use crate::GeometryError;
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec3};

/// Borders of neighbours may be so far apart, in parts of the shell.
const WIDEST: f64 = 1e-4;
/// The least tolerance, in parts of the shell: above all rounding errors of parameters.
const ROUNDING: f64 = 1e-9;
/// So many roundings of coordinates are less than the tolerance, for shells that are small and far from the origin.
const FAR: u32 = 256;
/// Each piece of a border is compared with its neighbours at so many places.
const SAMPLES: usize = 4;
/// Each piece is searched from the nearest of so many steps.
const STEPS: usize = 8;
/// A place of the same face is another one if its parameters differ by more than this: where a face meets itself.
const ELSEWHERE: f64 = 1e-3;
/// A piece that is shorter than this part of the shell is collapsed: no border.
const COLLAPSED: f64 = 1e-9;

/// A piece of a border with points along it.
struct Piece {
    face: usize,
    curve: usize,
    /// At even steps; none where the face does not reach.
    points: [Option<DVec3>; STEPS + 1],
}

impl Piece {
    fn new(face: usize, curve: usize, own: &Face) -> Self {
        Self {
            face,
            curve,
            points: std::array::from_fn(|k| {
                own.border(curve, k as f64 / STEPS as f64)
                    .map(|(_, point)| point)
            }),
        }
    }

    fn chords(&self) -> impl Iterator<Item = (usize, [DVec3; 2])> {
        let pairs = self.points.windows(2).enumerate();
        pairs.filter_map(|(k, pair)| Some((k, [pair[0]?, pair[1]?])))
    }

    fn length(&self) -> f64 {
        self.chords().map(|(_, [a, b])| (b - a).length()).sum()
    }

    /// A box around what may be nearer than a distance.
    fn bounds(&self, distance: f64) -> Bounds<3> {
        let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let points = self.points.iter().flatten();
        let (low, high) = points.fold(start, |(low, high), p| (low.min(*p), high.max(*p)));
        let longest = self.chords().map(|(_, [a, b])| (b - a).length());
        let pad = DVec3::splat(distance + longest.fold(0.0, f64::max));
        [(low - pad).to_array(), (high + pad).to_array()]
    }

    /// The parameter near which the piece is nearest to a point.
    fn start(&self, point: DVec3) -> f64 {
        let mut best = (f64::INFINITY, 0.5);
        for (k, [a, b]) in self.chords() {
            let along = b - a;
            let s = ((point - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            let s = if s.is_nan() { 0.0 } else { s };
            let distance = (point - (a + along * s)).length();
            if distance < best.0 {
                best = (distance, (k as f64 + s) / STEPS as f64);
            }
        }
        best.1
    }
}

/// How far other faces are from a place of a border: each face that is near, once.
struct Sample {
    piece: usize,
    distances: Vec<f64>,
}

/// The largest distance at which crossings near borders belong to the same edge.
///
/// # Errors
/// A border has no neighbour, or more than one.
pub(super) fn tolerance(faces: &[Face], extent: &Aabb) -> Result<f64, GeometryError> {
    let size = extent.size().length();
    let least = (ROUNDING * size).max(gamma(FAR) * extent.max_abs());
    let limit = (WIDEST * size).max(least);
    let mut pieces = vec![];
    for (number, face) in faces.iter().enumerate() {
        let all = (0..face.curves.len()).map(|curve| Piece::new(number, curve, face));
        pieces.extend(all.filter(|piece| piece.length() > COLLAPSED * size));
    }
    let boxes = Boxes::new(pieces.iter().map(|piece| piece.bounds(limit)).collect());
    let mut samples: Vec<Sample> = vec![];
    let mut widest: f64 = 0.0;
    for (number, piece) in pieces.iter().enumerate() {
        for k in 0..SAMPLES {
            let s = (k as f64 + 0.5) / SAMPLES as f64;
            let Some((place, point)) = faces[piece.face].border(piece.curve, s) else {
                continue;
            };
            let mut near: Vec<(usize, f64)> = vec![];
            boxes.meeting(&[point.to_array(); 2], |other| {
                let other = &pieces[other];
                let found = faces[other.face].nearest_on(other.curve, other.start(point), point);
                let Some((there, distance)) = found else {
                    return;
                };
                let is_same =
                    other.face == piece.face && (there - place).abs().max_element() <= ELSEWHERE;
                if is_same || distance > limit {
                    return;
                }
                match near.iter_mut().find(|(face, _)| *face == other.face) {
                    Some((_, least)) => *least = least.min(distance),
                    None => near.push((other.face, distance)),
                }
            });
            let distances: Vec<f64> = near.iter().map(|(_, distance)| *distance).collect();
            let Some(gap) = distances.iter().copied().reduce(f64::min) else {
                let why = format!("no other face has that border within {limit:.3e}");
                return Err(open(piece.face, point, &why));
            };
            widest = widest.max(gap);
            samples.push(Sample {
                piece: number,
                distances,
            });
        }
    }
    let tolerance = (2.0 * widest).max(least);
    for all in samples.chunk_by(|a, b| a.piece == b.piece) {
        // With the face itself.
        let count =
            |sample: &Sample| 1 + sample.distances.iter().filter(|d| **d <= tolerance).count();
        let odd = all.iter().map(count).filter(|count| count % 2 != 0);
        if 2 * odd.clone().count() > all.len() {
            let piece = &pieces[all[0].piece];
            let middle = faces[piece.face].border(piece.curve, 0.5);
            let point = middle.map_or(DVec3::ZERO, |(_, point)| point);
            let count = odd.max().unwrap_or(0);
            let why = format!("{count} faces have it, and not two");
            return Err(open(piece.face, point, &why));
        }
    }
    Ok(tolerance)
}

fn open(face: usize, point: DVec3, why: &str) -> GeometryError {
    // A few digits are enough to find the place.
    let [x, y, z] = point.to_array().map(|x| x as f32);
    GeometryError::NotClosedAt {
        what: "brep",
        index: face as u64,
        why: format!("face {face} (counted from 0) has a border at <{x}, {y}, {z}>, but {why}"),
    }
}
