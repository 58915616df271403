use super::vertices::{Key, Link, Vertices};
use crate::mesh::{MeshParts, Triangulator, Vertex, object_name, polygon_normal};
use crate::scene::report::Report;
use crate::scene::text::Text;
use std::collections::HashMap;
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
#[derive(Clone, Copy, Debug)]
pub(super) struct Counts {
    pub(super) positions: usize,
    pub(super) uvs: usize,
    pub(super) normals: usize,
}

/// Reads `v`, `v/vt`, `v//vn` or `v/vt/vn`.
pub(super) fn corner(word: &[u8], counts: &Counts) -> Result<Corner, String> {
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
    Ok(Corner {
        position: index(position, counts.positions, "vertex")?,
        uv: uv
            .map(|part| index(part, counts.uvs, "texture coordinate"))
            .transpose()?,
        normal: normal
            .map(|part| index(part, counts.normals, "normal"))
            .transpose()?,
    })
}

fn whole_number(part: &[u8]) -> Option<i64> {
    let mut number = 0;
    if (1..19).contains(&part.len()) && decimal::digits(part, &mut number) == Some(part.len()) {
        return i64::try_from(number).ok();
    }
    std::str::from_utf8(part).ok()?.parse().ok()
}

/// An index into a list of `count` entries: counted from 1, or back from the end.
fn index(part: &[u8], count: usize, what: &str) -> Result<u32, String> {
    let Some(number) = whole_number(part) else {
        let found = String::from_utf8_lossy(&part[..part.len().min(40)]);
        return Err(format!("expected the number of a {what}, found `{found}`"));
    };
    let from_zero = if number > 0 {
        usize::try_from(number - 1).ok()
    } else {
        usize::try_from(number.unsigned_abs())
            .ok()
            .filter(|back| *back > 0)
            .and_then(|back| count.checked_sub(back))
    };
    match from_zero
        .filter(|i| *i < count)
        .and_then(|i| u32::try_from(i).ok())
    {
        Some(index) => Ok(index),
        None if number == 0 => Err(format!("{what} 0 does not exist: OBJ counts from 1")),
        None => Err(format!(
            "{what} {number} does not exist: there are {count} so far"
        )),
    }
}

/// What tells one mesh from another.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct PartKey {
    pub(super) object: Arc<str>,
    pub(super) group: Arc<str>,
    pub(super) material: Arc<str>,
}

/// The normal of a vertex of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NormalKey {
    /// None: flat faces.
    Flat,
    /// One of the list.
    Given(u32),
    /// The mean within a smoothing group.
    Group(u32),
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
    /// The face being read.
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

    /// Adds the face in `corners`, or tells why it is left out.
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
            let name = match (&*key.object, &*key.group) {
                ("", "") => object_name(text.name),
                (_, "") => key.object,
                ("", _) => key.group,
                (object, group) if object == group => key.object,
                (object, group) => Arc::from(format!("{object}/{group}")),
            };
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
