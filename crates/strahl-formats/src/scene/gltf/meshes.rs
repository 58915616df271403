use super::accessor::Elements;
use super::buffers::Buffers;
use super::materials::Materials;
use crate::input::{Input, Report};
use crate::mesh::polygon_normal;
use gltf_json::Root;
use gltf_json::accessor::Type;
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;
use std::collections::HashMap;
use std::sync::Arc;
use strahl_geometry::{MeshData, TriangleMesh};
use strahl_math::DVec3;
use strahl_scene::{Diagnostic, Object};

/// Limits of the corners of all primitives together: this many, plus [`CORNERS_PER_BYTE`] for each byte of the buffers. Real
/// files use at least a byte per corner; the limit stops files in which thousands of primitives share an accessor from filling
/// the memory.
const FREE_CORNERS: u64 = 1 << 24;
const CORNERS_PER_BYTE: u64 = 4;

/// Turns primitives into objects.
pub(super) struct Meshes<'a> {
    root: &'a Root,
    buffers: &'a Buffers<'a>,
    name: &'a str,
    corners_left: u64,
}

impl<'a> Meshes<'a> {
    pub(super) fn new(root: &'a Root, buffers: &'a Buffers<'a>, input: &Input<'a>) -> Self {
        let corners_left =
            FREE_CORNERS.saturating_add(buffers.total().saturating_mul(CORNERS_PER_BYTE));
        Self {
            root,
            buffers,
            name: input.name,
            corners_left,
        }
    }

    /// The objects of a mesh, in its own space.
    pub(super) fn objects(
        &mut self,
        mesh: usize,
        materials: &mut Materials<'_>,
        report: &mut Report,
    ) -> Result<Vec<Object>, String> {
        let mut objects = vec![];
        let Some(json) = self.root.meshes.get(mesh) else {
            return Ok(objects);
        };
        let name = json.name.clone().unwrap_or_else(|| format!("mesh {mesh}"));
        for (i, primitive) in json.primitives.iter().enumerate() {
            let shape = self
                .primitive(primitive, report)
                .map_err(|e| format!("primitive {i} of mesh {mesh}: {e}"))?;
            let Some(shape) = shape else { continue };
            let name = if json.primitives.len() > 1 {
                format!("{name} ({i})")
            } else {
                name.clone()
            };
            let material = primitive
                .material
                .map(|m| materials.get(m.value(), report))
                .transpose()?;
            objects.push(Object {
                name: Some(name.into()),
                material,
                ..shape.into()
            });
        }
        Ok(objects)
    }

    fn warn(&self, report: &mut Report, what: &'static str) {
        report.count(what, || {
            Diagnostic::warning(format!("`{}`: {what}", self.name))
        });
    }

    /// A warning about many vertices, of which the first is named by its number in the file.
    fn warn_of(&self, report: &mut Report, what: &'static str, vertex: usize) {
        report.count(what, || {
            Diagnostic::warning(format!("`{}`: {what}, as of vertex {vertex}", self.name))
        });
    }

    fn primitive(
        &mut self,
        primitive: &Primitive,
        report: &mut Report,
    ) -> Result<Option<Arc<TriangleMesh>>, String> {
        let Checked::Valid(mode) = primitive.mode else {
            return Err("it has no valid mode".into());
        };
        if matches!(
            mode,
            Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip
        ) {
            self.warn(report, "points and lines are ignored: they have no surface");
            return Ok(None);
        }
        if primitive
            .targets
            .as_ref()
            .is_some_and(|targets| !targets.is_empty())
        {
            self.warn(
                report,
                "morph targets are ignored: the mesh has its rest pose",
            );
        }
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let Some(positions) = attribute(Semantic::Positions) else {
            self.warn(report, "a primitive without positions is ignored");
            return Ok(None);
        };
        if attribute(Semantic::Colors(0)).is_some() {
            self.warn(report, "the colours of vertices are ignored");
        }
        let read = |accessor, kind| Elements::new(self.root, self.buffers, accessor, kind);
        let positions = read(positions, Type::Vec3)?;
        let same_count = |elements: Elements<'a>, what: &str| {
            let (found, expected) = (elements.count, positions.count);
            if found == expected {
                Ok(elements)
            } else {
                Err(format!(
                    "there are {found} {what}, but {expected} positions"
                ))
            }
        };
        let normals = attribute(Semantic::Normals)
            .map(|a| read(a, Type::Vec3).and_then(|e| same_count(e, "normals")))
            .transpose()?;
        let uvs = attribute(Semantic::TexCoords(0))
            .map(|a| read(a, Type::Vec2).and_then(|e| same_count(e, "texture coordinates")))
            .transpose()?;
        let indices = primitive
            .indices
            .map(|a| read(a, Type::Scalar))
            .transpose()?;
        if indices
            .as_ref()
            .is_some_and(|elements| !elements.can_be_indices())
        {
            return Err("its indices are not of an unsigned integer type".into());
        }

        let corners = indices
            .as_ref()
            .map_or(positions.count, |elements| elements.count);
        let Some(left) = self.corners_left.checked_sub(corners as u64) else {
            return Err(
                "all primitives together have far more corners than the file has bytes".into(),
            );
        };
        self.corners_left = left;
        let corner = |i: usize| {
            indices
                .as_ref()
                .map_or(i as u32, |elements| elements.integer(i))
        };
        let mut vertices = Compact::default();
        let mut triangles = vec![];
        let mut data = MeshData {
            normals: normals.as_ref().map(|_| vec![]),
            uvs: uvs.as_ref().map(|_| vec![]),
            ..MeshData::default()
        };
        for k in 0..triangle_count(mode, corners) {
            let triangle = triangle(mode, k).map(corner);
            if let Some(bad) = triangle.iter().find(|i| **i as usize >= positions.count) {
                return Err(format!(
                    "vertex {bad} is out of range: there are {}, numbered from 0",
                    positions.count
                ));
            }
            let points = triangle.map(|i| positions.get::<3>(i as usize));
            if let Some(bad) = triangle
                .iter()
                .zip(&points)
                .find(|(_, p)| !p.iter().all(|x| x.is_finite()))
            {
                return Err(format!(
                    "the position of vertex {} is not a finite number",
                    bad.0
                ));
            }
            if polygon_normal(&points.map(DVec3::from_array)).is_none() {
                // Strips contain triangles without area on purpose, to turn corners.
                if mode == Mode::Triangles {
                    self.warn(report, "a triangle without area is left out");
                }
                continue;
            }
            triangles.push(triangle.map(|i| vertices.number(i)));
        }
        if mode == Mode::Triangles && corners % 3 != 0 {
            self.warn(
                report,
                "the number of corners is not a multiple of three: the rest is ignored",
            );
        }
        let single = |x: f64| x as f32;
        for &vertex in &vertices.used {
            let vertex = vertex as usize;
            data.positions.push(positions.get::<3>(vertex).map(single));
            if let (Some(list), Some(normals)) = (&mut data.normals, &normals) {
                let normal = normals.get::<3>(vertex).map(single);
                let normal = finite_or_zero(normal).unwrap_or_else(|zero| {
                    self.warn_of(report, "normals that are not finite count as none", vertex);
                    zero
                });
                list.push(normal);
            }
            if let (Some(list), Some(uvs)) = (&mut data.uvs, &uvs) {
                let uv = uvs.get::<2>(vertex).map(single);
                let uv = finite_or_zero(uv).unwrap_or_else(|zero| {
                    let what = "texture coordinates that are not finite count as none";
                    self.warn_of(report, what, vertex);
                    zero
                });
                list.push(uv);
            }
        }
        if triangles.is_empty() {
            return Ok(None);
        }
        data.indices = triangles;
        TriangleMesh::try_new(data)
            .map(|mesh| Some(Arc::new(mesh)))
            .map_err(|e| e.to_string())
    }
}

/// The numbers, or as many zeros if one of them is not finite.
fn finite_or_zero<const N: usize>(numbers: [f32; N]) -> Result<[f32; N], [f32; N]> {
    if numbers.iter().all(|x| x.is_finite()) {
        Ok(numbers)
    } else {
        Err([0.0; N])
    }
}

/// The number of triangles for this number of corners.
fn triangle_count(mode: Mode, corners: usize) -> usize {
    match mode {
        Mode::Triangles => corners / 3,
        _ => corners.saturating_sub(2),
    }
}

/// The corners of a triangle (glTF 2.0, section 3.7.2.1).
fn triangle(mode: Mode, k: usize) -> [usize; 3] {
    match mode {
        Mode::TriangleStrip if k.is_multiple_of(2) => [k, k + 1, k + 2],
        Mode::TriangleStrip => [k, k + 2, k + 1],
        Mode::TriangleFan => [k + 1, k + 2, 0],
        _ => [3 * k, 3 * k + 1, 3 * k + 2],
    }
}

/// Numbers only the used vertices, in the order of first use, because primitives often share a large list.
#[derive(Default)]
struct Compact {
    numbers: HashMap<u32, u32>,
    used: Vec<u32>,
}

impl Compact {
    fn number(&mut self, vertex: u32) -> u32 {
        *self.numbers.entry(vertex).or_insert_with(|| {
            self.used.push(vertex);
            self.used.len() as u32 - 1
        })
    }
}
