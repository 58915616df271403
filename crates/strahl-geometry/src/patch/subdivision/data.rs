//! The description of a subdivision surface, and its checks.

use super::rules::SHARPEST;
use crate::GeometryError;
use crate::patch::bezier::is_on_a_line;
use crate::patch::bicubic::LARGEST;
use std::collections::HashMap;
use strahl_math::{DVec2, DVec3};

/// How the faces of a subdivision surface are divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SubdivisionScheme {
    /// E. Catmull and J. Clark's, for faces of any number of corners, best for quadrilaterals.
    #[default]
    CatmullClark,
    /// C. Loop's, for triangles.
    Loop,
}

/// The control mesh of a subdivision surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SubdivisionData {
    /// The scheme.
    pub scheme: SubdivisionScheme,
    /// The vertices. Those that no face uses are ignored.
    pub points: Vec<DVec3>,
    /// How many corners each face has, from 3 to 10000.
    pub sizes: Vec<u32>,
    /// The vertices of the faces, one face after the other, counter-clockwise seen from the front.
    pub indices: Vec<u32>,
    /// Edges that are creases, by their vertices, with their sharpness: so many levels of subdivision treat them as sharp.
    /// 0 is smooth, 10 and more is sharp for ever. Edges that belong to one face only are always sharp.
    pub creases: Vec<([u32; 2], f64)>,
    /// Vertices that are corners, with their sharpness.
    pub corners: Vec<(u32, f64)>,
    /// Texture coordinates for each entry of `indices`, or none. They are interpolated linearly across each face.
    pub uvs: Vec<DVec2>,
}

/// Faces have at most so many corners, and vertices so many edges. Each takes up to half a megabyte when rays have come
/// everywhere near it.
const MOST_CORNERS: u32 = 10_000;
/// The corners of all faces together.
const MOST_INDICES: usize = 1 << 28;
const WHAT: &str = "the mesh of the subdivision surface";

impl SubdivisionData {
    /// A mesh of these faces without creases.
    pub fn new<F: AsRef<[u32]>>(
        scheme: SubdivisionScheme,
        points: Vec<DVec3>,
        faces: impl IntoIterator<Item = F>,
    ) -> Self {
        let mut data = Self {
            scheme,
            points,
            ..Self::default()
        };
        for face in faces {
            data.sizes.push(face.as_ref().len() as u32);
            data.indices.extend_from_slice(face.as_ref());
        }
        data
    }

    /// Checks everything but how faces fit together.
    pub(super) fn check(&self) -> Result<(), GeometryError> {
        for (index, point) in self.points.iter().enumerate() {
            let index = index as u64;
            if !point.is_finite() {
                let what = "vertex of the subdivision surface";
                return Err(GeometryError::NotFiniteAt { what, index });
            }
            if point.abs().max_element() > LARGEST {
                return Err(GeometryError::OutOfRangeAt {
                    what: "vertex of the subdivision surface",
                    index,
                    expected: "at most 1e70 from the origin",
                    found: point.abs().max_element(),
                });
            }
        }
        self.check_faces()?;
        self.check_sharpness()?;
        if !self.uvs.is_empty() && self.uvs.len() != self.indices.len() {
            return Err(GeometryError::WrongCount {
                what: "texture coordinates of the subdivision surface's corners",
                expected: self.indices.len() as u64,
                found: self.uvs.len() as u64,
            });
        }
        if let Some(index) = self.uvs.iter().position(|uv| !uv.is_finite()) {
            return Err(GeometryError::NotFiniteAt {
                what: "texture coordinate of the subdivision surface",
                index: index as u64,
            });
        }
        let used = self.indices.iter().map(|i| self.points[*i as usize]);
        if is_on_a_line(used) {
            return Err(GeometryError::Degenerate {
                what: "subdivision surface",
                why: "the vertices of its faces lie on a line",
            });
        }
        Ok(())
    }

    fn check_faces(&self) -> Result<(), GeometryError> {
        if self.sizes.is_empty() {
            return Err(GeometryError::Degenerate {
                what: "subdivision surface",
                why: "it has no faces",
            });
        }
        let corners = self.sizes.iter().map(|size| u64::from(*size)).sum::<u64>();
        if corners != self.indices.len() as u64 {
            return Err(GeometryError::WrongCount {
                what: "corners of the subdivision surface's faces",
                expected: corners,
                found: self.indices.len() as u64,
            });
        }
        if self.indices.len() > MOST_INDICES {
            return Err(GeometryError::OutOfRange {
                what: "number of corners of the subdivision surface's faces",
                expected: "at most 268435456",
                found: self.indices.len() as f64,
            });
        }
        let count = self.points.len() as u64;
        if let Some(index) = self.indices.iter().find(|i| u64::from(**i) >= count) {
            return Err(GeometryError::IndexOutOfRange {
                what: "vertex of the subdivision surface",
                index: u64::from(*index),
                count,
            });
        }
        let mut start = 0;
        for (face, size) in self.sizes.iter().enumerate() {
            let expected = match self.scheme {
                SubdivisionScheme::CatmullClark if (3..=MOST_CORNERS).contains(size) => None,
                SubdivisionScheme::CatmullClark => Some("from 3 to 10000"),
                SubdivisionScheme::Loop if *size == 3 => None,
                SubdivisionScheme::Loop => Some("3 for Loop's scheme"),
            };
            if let Some(expected) = expected {
                return Err(GeometryError::OutOfRangeAt {
                    what: "number of corners of the subdivision surface's face",
                    index: face as u64,
                    expected,
                    found: f64::from(*size),
                });
            }
            let corners = &self.indices[start..start + *size as usize];
            start += *size as usize;
            let mut sorted = corners.to_vec();
            sorted.sort_unstable();
            if let Some(pair) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
                return Err(GeometryError::NotASurface {
                    what: WHAT,
                    why: format!(
                        "face {face} has vertex {} twice (both counted from 0)",
                        pair[0]
                    ),
                });
            }
        }
        Ok(())
    }

    fn check_sharpness(&self) -> Result<(), GeometryError> {
        let count = self.points.len() as u64;
        let all = self.creases.iter().map(|(ends, s)| (ends.as_slice(), *s));
        let corners = self
            .corners
            .iter()
            .map(|(v, s)| (std::slice::from_ref(v), *s));
        for (vertices, sharpness) in all.chain(corners) {
            if let Some(index) = vertices.iter().find(|i| u64::from(**i) >= count) {
                return Err(GeometryError::IndexOutOfRange {
                    what: "vertex of a crease or corner of the subdivision surface",
                    index: u64::from(*index),
                    count,
                });
            }
            if sharpness.is_nan() || sharpness < 0.0 {
                return Err(GeometryError::OutOfRange {
                    what: "sharpness of a crease or corner of the subdivision surface",
                    expected: "0 (smooth) or greater, 10 and more for sharp for ever",
                    found: sharpness,
                });
            }
        }
        Ok(())
    }
}

/// No edge.
const NONE: u32 = u32::MAX;

/// How the faces of a checked mesh fit together: half-edges. Half-edge `h` is the side of a face that begins at entry `h` of the
/// indices.
#[derive(Debug)]
pub(super) struct Sides {
    /// The first half-edge of each face; at the end their number.
    pub(super) starts: Vec<u32>,
    pub(super) face: Vec<u32>,
    /// The half-edge of the neighbour, in the opposite direction.
    twin: Vec<u32>,
    /// The sharpness of half-edges; none if there are no creases.
    sharpness: Vec<f64>,
}

fn sharp(value: f64) -> f64 {
    if value >= SHARPEST {
        f64::INFINITY
    } else {
        value
    }
}

/// The sharpness of all vertices that have any.
pub(super) fn corner_sharpness(data: &SubdivisionData) -> HashMap<u32, f64> {
    let all = data.corners.iter().filter(|(_, s)| *s > 0.0);
    all.map(|(v, s)| (*v, sharp(*s))).collect()
}

impl Sides {
    pub(super) fn try_new(data: &SubdivisionData) -> Result<Self, GeometryError> {
        let mut starts = vec![0];
        let mut face = Vec::with_capacity(data.indices.len());
        for (f, size) in data.sizes.iter().enumerate() {
            face.extend(std::iter::repeat_n(f as u32, *size as usize));
            starts.push(face.len() as u32);
        }
        let mut sides = Self {
            starts,
            twin: vec![],
            face,
            sharpness: vec![],
        };
        // All half-edges of an edge follow each other.
        let ends = |h: u32| {
            let (a, b) = (
                data.indices[h as usize],
                data.indices[sides.next(h) as usize],
            );
            (a.min(b), a.max(b))
        };
        let mut order: Vec<u32> = (0..sides.face.len() as u32).collect();
        order.sort_unstable_by_key(|h| (ends(*h), *h));
        let mut twins = vec![NONE; sides.face.len()];
        for group in order.chunk_by(|a, b| ends(*a) == ends(*b)) {
            let [a, b] = match *group {
                [] | [_] => continue,
                [a, b] => [a, b],
                [first, ..] => {
                    let (a, b) = ends(first);
                    return Err(GeometryError::NotASurface {
                        what: WHAT,
                        why: format!(
                            "{} faces meet at the edge between the vertices {a} and {b} (counted from 0), two at most can",
                            group.len()
                        ),
                    });
                }
            };
            if data.indices[a as usize] == data.indices[b as usize] {
                let (p, q) = ends(a);
                return Err(GeometryError::NotASurface {
                    what: WHAT,
                    why: format!(
                        "the faces {} and {} at the edge between the vertices {p} and {q} (counted from 0) turn different sides to the \
                         front: turn the order of the vertices of one of them",
                        sides.face[a as usize], sides.face[b as usize]
                    ),
                });
            }
            twins[a as usize] = b;
            twins[b as usize] = a;
        }
        sides.twin = twins;
        sides.add_creases(data)?;
        Ok(sides)
    }

    fn add_creases(&mut self, data: &SubdivisionData) -> Result<(), GeometryError> {
        if data.creases.is_empty() {
            return Ok(());
        }
        let key = |a: u32, b: u32| (a.min(b), a.max(b));
        let mut wanted: HashMap<(u32, u32), (f64, bool)> = HashMap::new();
        for ([a, b], sharpness) in &data.creases {
            wanted.insert(key(*a, *b), (sharp(*sharpness), false));
        }
        let mut all = vec![0.0; self.face.len()];
        for h in 0..self.face.len() as u32 {
            let edge = key(
                data.indices[h as usize],
                data.indices[self.next(h) as usize],
            );
            if let Some((sharpness, is_used)) = wanted.get_mut(&edge) {
                all[h as usize] = *sharpness;
                *is_used = true;
            }
        }
        self.sharpness = all;
        for ([a, b], _) in &data.creases {
            if wanted
                .get(&key(*a, *b))
                .is_some_and(|(_, is_used)| !is_used)
            {
                return Err(GeometryError::NotASurface {
                    what: WHAT,
                    why: format!(
                        "the crease between the vertices {a} and {b} (counted from 0) is not an edge of a face"
                    ),
                });
            }
        }
        Ok(())
    }

    /// The next half-edge of the same face.
    pub(super) fn next(&self, h: u32) -> u32 {
        let face = self.face[h as usize] as usize;
        if h + 1 == self.starts[face + 1] {
            self.starts[face]
        } else {
            h + 1
        }
    }

    /// The one before.
    pub(super) fn previous(&self, h: u32) -> u32 {
        let face = self.face[h as usize] as usize;
        if h == self.starts[face] {
            self.starts[face + 1] - 1
        } else {
            h - 1
        }
    }

    pub(super) fn twin(&self, h: u32) -> Option<u32> {
        Some(self.twin[h as usize]).filter(|t| *t != NONE)
    }

    /// The sharpness of the edge; infinite at the border.
    pub(super) fn sharpness(&self, h: u32) -> f64 {
        if self.twin(h).is_none() {
            return f64::INFINITY;
        }
        self.sharpness.get(h as usize).copied().unwrap_or(0.0)
    }

    /// Whether there is no border.
    pub(super) fn is_closed(&self) -> bool {
        self.twin.iter().all(|t| *t != NONE)
    }

    /// The half-edges that begin at the vertex of `h`, counter-clockwise from `h` on; the gap at a vertex of the border is `None`.
    pub(super) fn around(&self, h: u32) -> Result<Vec<Option<u32>>, GeometryError> {
        let mut all = vec![Some(h)];
        let mut at = h;
        let too_many = |count: usize| GeometryError::OutOfRange {
            what: "number of faces at a vertex of the subdivision surface",
            expected: "at most 10000",
            found: count as f64,
        };
        while let Some(next) = self.twin(self.previous(at)) {
            if next == h {
                return Ok(all);
            }
            all.push(Some(next));
            if all.len() > MOST_CORNERS as usize {
                return Err(too_many(all.len()));
            }
            at = next;
        }
        let mut back = vec![];
        at = h;
        while let Some(twin) = self.twin(at) {
            at = self.next(twin);
            back.push(Some(at));
            if all.len() + back.len() > MOST_CORNERS as usize {
                return Err(too_many(all.len() + back.len()));
            }
        }
        all.push(None);
        all.extend(back.into_iter().rev());
        Ok(all)
    }

    pub(super) fn bytes(&self) -> usize {
        4 * (self.starts.len() + self.face.len() + self.twin.len()) + 8 * self.sharpness.len()
    }
}
