use super::vertices::{Key, Link, NormalKey, Vertices};
use crate::input::report::Report;
use crate::input::text::{Text, Word};
use crate::mesh::{MeshParts, Triangulator, Vertex, object_name, polygon_normal};
use std::collections::HashMap;
use std::ops::Add;
use std::sync::Arc;
use strahl_math::{DVec2, DVec3, decimal, det};
use strahl_scene::{Diagnostic, Object, Span};

/// A corner of a face: places in the lists of positions, texture coordinates and normals, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Corner {
    position: u32,
    uv: Option<u32>,
    normal: Option<u32>,
}

/// How many entries the lists have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    pub(super) positions: usize,
    pub(super) uvs: usize,
    pub(super) normals: usize,
}

impl Add for Counts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            positions: self.positions + other.positions,
            uvs: self.uvs + other.uvs,
            normals: self.normals + other.normals,
        }
    }
}

/// The numbers of a corner as written: from 1 on, or backwards from the end. 0 means none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct RawCorner {
    position: i32,
    uv: i32,
    normal: i32,
}

/// Stands for a number that is out of range for any list.
const NO_ENTRY: i32 = i32::MIN;

impl RawCorner {
    /// `v`
    #[inline]
    pub(super) fn plain(position: i32) -> Self {
        Self {
            position: if position == 0 { NO_ENTRY } else { position },
            uv: 0,
            normal: 0,
        }
    }

    /// Reads `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    pub(super) fn parse(word: &[u8]) -> Result<Self, String> {
        let numbers = numbers(word)?;
        let small = |number: Option<i64>| match number {
            None => 0,
            Some(0) => NO_ENTRY,
            Some(number) => i32::try_from(number).unwrap_or(NO_ENTRY),
        };
        let [position, uv, normal] = numbers.map(small);
        Ok(Self {
            position,
            uv,
            normal,
        })
    }

    /// The place of the position alone, or what is wrong with it.
    pub(super) fn position_of(&self, word: &Word<'_>, counts: &Counts) -> Result<u32, String> {
        match entry(self.position, counts.positions) {
            Some(place) => Ok(place),
            None => Err(check_corner(word.bytes, counts).err().unwrap_or_default()),
        }
    }

    /// Finds the entries, given the current lengths of the lists.
    #[inline]
    pub(super) fn resolve(&self, counts: &Counts) -> Option<Corner> {
        let optional = |number, count| match number {
            0 => Some(None),
            _ => entry(number, count).map(Some),
        };
        Some(Corner {
            position: entry(self.position, counts.positions)?,
            uv: optional(self.uv, counts.uvs)?,
            normal: optional(self.normal, counts.normals)?,
        })
    }
}

/// An index into a list of `count` entries, if there is such an entry.
#[inline]
pub(super) fn entry(number: i32, count: usize) -> Option<u32> {
    let index = match number {
        NO_ENTRY => return None,
        1.. => number as usize - 1,
        _ => count.checked_sub(number.unsigned_abs() as usize)?,
    };
    u32::try_from(index).ok().filter(|_| index < count)
}

/// The numbers of position, texture coordinates and normal.
fn numbers(word: &[u8]) -> Result<[Option<i64>; 3], String> {
    let mut parts = word.split(|b| *b == b'/');
    let position = parts.next().unwrap_or_default();
    let uv = parts.next().filter(|part| !part.is_empty());
    let normal = parts.next().filter(|part| !part.is_empty());
    if position.is_empty() || parts.next().is_some() {
        let found = String::from_utf8_lossy(&word[..word.len().min(40)]);
        return Err(format!(
            "expected a corner such as `1`, `1/2`, `1//3` or `1/2/3`, found `{found}`"
        ));
    }
    Ok([
        Some(whole_number(position, VERTEX)?),
        uv.map(|part| whole_number(part, UV)).transpose()?,
        normal.map(|part| whole_number(part, NORMAL)).transpose()?,
    ])
}

/// Explains the error in a corner, given the current lengths of the lists.
pub(super) fn check_corner(word: &[u8], counts: &Counts) -> Result<(), String> {
    let counts = [counts.positions, counts.uvs, counts.normals];
    for ((number, count), what) in numbers(word)?
        .into_iter()
        .zip(counts)
        .zip([VERTEX, UV, NORMAL])
    {
        match number {
            Some(0) => return Err(format!("{what} 0 does not exist: OBJ counts from 1")),
            Some(n)
                if i32::try_from(n)
                    .ok()
                    .and_then(|n| entry(n, count))
                    .is_none() =>
            {
                return Err(format!(
                    "{what} {n} does not exist: there are {count} so far"
                ));
            }
            _ => {}
        }
    }
    Ok(())
}

const VERTEX: &str = "vertex";
const UV: &str = "texture coordinate";
const NORMAL: &str = "normal";

fn whole_number(part: &[u8], what: &str) -> Result<i64, String> {
    let mut number = 0;
    if (1..19).contains(&part.len())
        && decimal::digits(part, &mut number) == Some(part.len())
        && let Ok(number) = i64::try_from(number)
    {
        return Ok(number);
    }
    let number = std::str::from_utf8(part).ok().and_then(|n| n.parse().ok());
    number.ok_or_else(|| {
        let found = String::from_utf8_lossy(&part[..part.len().min(40)]);
        format!("expected the number of a {what}, found `{found}`")
    })
}

/// The key of a mesh.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct PartKey {
    pub(super) object: Arc<str>,
    pub(super) group: Arc<str>,
    pub(super) material: Arc<str>,
}

impl PartKey {
    /// The name of its object.
    pub(super) fn name(&self, text: Text<'_>) -> Arc<str> {
        match (&*self.object, &*self.group) {
            ("", "") => object_name(text.name),
            (_, "") => Arc::clone(&self.object),
            ("", _) => Arc::clone(&self.group),
            (object, group) if object == group => Arc::clone(&self.object),
            (object, group) => Arc::from(format!("{object}/{group}")),
        }
    }
}

#[derive(Debug, Default)]
struct Part {
    mesh: MeshParts,
    links: Vec<Link>,
    /// Vertices that wait for the normal of a position in a smoothing group.
    waiting: Vec<(u32, (u32, u32))>,
}

/// The lists of the file and the meshes made from them.
#[derive(Debug, Default)]
pub(super) struct Faces {
    pub(super) positions: Vec<DVec3>,
    pub(super) uvs: Vec<DVec2>,
    pub(super) normals: Vec<DVec3>,
    /// The corners of the current face.
    pub(super) corners: Vec<Corner>,
    vertices: Vertices,
    parts: Vec<(PartKey, Part)>,
    index: HashMap<PartKey, usize>,
    /// The last part used.
    last: usize,
    /// Sums of normals by position and smoothing group.
    sums: HashMap<(u32, u32), DVec3>,
    triangulator: Triangulator,
    points: Vec<DVec3>,
    cut: Vec<[u32; 3]>,
}

impl Faces {
    pub(super) fn counts(&self) -> Counts {
        Counts {
            positions: self.positions.len(),
            uvs: self.uvs.len(),
            normals: self.normals.len(),
        }
    }

    /// Adds the face in `corners`, or returns why it is left out.
    pub(super) fn add(
        &mut self,
        key: &PartKey,
        smoothing: u32,
        line: u32,
    ) -> Result<(), &'static str> {
        self.points.clear();
        self.points.extend(
            self.corners
                .iter()
                .map(|c| self.positions[c.position as usize]),
        );
        self.cut.clear();
        self.triangulator.triangulate(&self.points, &mut self.cut)?;
        let smooth = smoothing > 0 && self.corners.iter().any(|c| c.normal.is_none());
        if smooth {
            self.add_to_sums(smoothing);
        }
        let part = self.part(key);
        let Self {
            parts,
            corners,
            positions,
            uvs,
            normals,
            cut,
            vertices: known,
            ..
        } = self;
        let Part {
            mesh,
            links,
            waiting,
        } = &mut parts[part].1;
        for triangle in cut.iter() {
            let vertices = triangle.map(|i| {
                let corner = corners[i as usize];
                let normal_key = match corner.normal {
                    Some(normal) => NormalKey::Given(normal),
                    None if smoothing > 0 => NormalKey::Group(smoothing),
                    None => NormalKey::Flat,
                };
                let key = Key {
                    uv: corner.uv,
                    normal: normal_key,
                };
                known.find(part as u32, corner.position, key, links, || {
                    let vertex = mesh.push(Vertex {
                        position: positions[corner.position as usize],
                        uv: corner.uv.map(|i| uvs[i as usize]),
                        normal: match normal_key {
                            NormalKey::Flat => None,
                            NormalKey::Given(i) => Some(normals[i as usize].normalize_or_zero()),
                            NormalKey::Group(_) => Some(DVec3::ZERO),
                        },
                    });
                    if matches!(normal_key, NormalKey::Group(_)) {
                        waiting.push((vertex, (corner.position, smoothing)));
                    }
                    vertex
                })
            });
            mesh.triangle(vertices, line);
        }
        Ok(())
    }

    /// The first of the face's corners whose position is not finite, and that position's place in the list.
    #[cold]
    pub(super) fn not_finite(&self) -> Option<(usize, u32)> {
        let mut corners = self.corners.iter().map(|c| c.position).enumerate();
        corners.find(|(_, position)| !self.positions[*position as usize].is_finite())
    }

    /// Adds the face's normal to those of its corners, weighted by the angles.
    fn add_to_sums(&mut self, smoothing: u32) {
        let Some(normal) = polygon_normal(&self.points).and_then(DVec3::try_normalize) else {
            return;
        };
        let count = self.points.len();
        for (i, corner) in self.corners.iter().enumerate() {
            let (here, after, before) = (
                self.points[i],
                self.points[(i + 1) % count],
                self.points[(i + count - 1) % count],
            );
            let (a, b) = (after - here, before - here);
            let angle = det::atan2(a.cross(b).length(), a.dot(b));
            *self.sums.entry((corner.position, smoothing)).or_default() += normal * angle;
        }
    }

    fn part(&mut self, key: &PartKey) -> usize {
        if self
            .parts
            .get(self.last)
            .is_none_or(|(last, _)| last != key)
        {
            self.last = *self.index.entry(key.clone()).or_insert_with(|| {
                self.parts.push((key.clone(), Part::default()));
                self.parts.len() - 1
            });
        }
        self.last
    }

    /// The objects, each with the name of its material.
    pub(super) fn finish(self, text: Text<'_>, report: &mut Report) -> Vec<(Object, Arc<str>)> {
        let Self { parts, sums, .. } = self;
        let mut objects = vec![];
        for (key, part) in parts {
            let Part {
                mut mesh, waiting, ..
            } = part;
            for (vertex, place) in waiting {
                let sum = sums.get(&place).copied().unwrap_or_default();
                mesh.set_normal(vertex, sum.normalize_or_zero());
            }
            let Some((line, mesh)) = mesh.finish() else {
                continue;
            };
            let span = Span::line(text.file, line);
            let name = key.name(text);
            match mesh {
                Ok(mesh) => objects.push((
                    Object {
                        name: Some(name),
                        span,
                        ..mesh.into()
                    },
                    key.material,
                )),
                Err(problem) => {
                    report.error(|| Diagnostic::error(format!("`{name}`: {problem}")).at(span))
                }
            }
        }
        objects
    }
}
