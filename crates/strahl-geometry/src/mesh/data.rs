use crate::GeometryError;
use strahl_math::{Aabb, DVec3};

/// The data of a mesh, checked by [`TriangleMesh::try_new`](super::TriangleMesh::try_new).
///
/// The lists per vertex have as many entries as `positions`, the lists per face as many as `indices`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshData {
    /// The origin of `positions`. Zero, unless the mesh is small and far away.
    pub anchor: DVec3,
    /// The vertices, kept exactly as they are.
    pub positions: Vec<[f32; 3]>,
    /// The triangles: three vertices each, counter-clockwise as seen from the front.
    pub indices: Vec<[u32; 3]>,
    /// Normals per vertex, of any length, for smooth shading.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Texture coordinates per vertex.
    pub uvs: Option<Vec<[f32; 2]>>,
    /// Material slot per face.
    pub face_materials: Option<Vec<u16>>,
    /// Line of the source file per face.
    pub face_lines: Option<Vec<u32>>,
    /// Whether a face continues the polygon of the one before, which was cut into triangles.
    pub face_continues: Option<Vec<bool>>,
}

impl MeshData {
    /// A mesh without normals and texture from vertices in f64 (`DVec3` or `[f64; 3]`), which are rounded to f32.
    ///
    /// The anchor stays zero, unless the mesh is so small for its place (extent below 1/1024 of the largest coordinate)
    /// that f32 would leave less than 14 bits for its detail; then it is the middle of the mesh. Vertices that
    /// f32 holds exactly are kept exactly.
    pub fn from_f64<V: Copy + Into<DVec3>>(vertices: &[V], indices: Vec<[u32; 3]>) -> Self {
        let points = || vertices.iter().map(|&v| v.into());
        let bounds = Aabb::from_points(points());
        let small = bounds.size().max_element() < bounds.max_abs() / 1024.0;
        let exact = |v: DVec3| v.as_vec3().as_dvec3() == v;
        let anchor = if small && bounds.is_bounded() && !points().all(exact) {
            bounds.center()
        } else {
            DVec3::ZERO
        };
        Self {
            anchor,
            positions: points()
                .map(|v| (v - anchor).as_vec3().to_array())
                .collect(),
            indices,
            ..Self::default()
        }
    }

    /// Checks that the lists have the right lengths, and all numbers are finite.
    pub(super) fn check(&self) -> Result<(), GeometryError> {
        let (vertices, faces) = (self.positions.len() as u64, self.indices.len() as u64);
        if faces == 0 {
            return Err(GeometryError::Degenerate {
                what: "mesh",
                why: "it has no triangles",
            });
        }
        if faces > u64::from(u32::MAX) {
            return Err(GeometryError::IndexOutOfRange {
                what: "triangle",
                index: faces - 1,
                count: u64::from(u32::MAX),
            });
        }
        if let Some(&bad) = self
            .indices
            .iter()
            .flatten()
            .find(|&&i| u64::from(i) >= vertices)
        {
            return Err(GeometryError::IndexOutOfRange {
                what: "vertex",
                index: u64::from(bad),
                count: vertices,
            });
        }
        let length = |what, list: Option<usize>, expected: u64| match list {
            Some(found) if found as u64 != expected => Err(GeometryError::WrongCount {
                what,
                expected,
                found: found as u64,
            }),
            _ => Ok(()),
        };
        length("normals", self.normals.as_ref().map(Vec::len), vertices)?;
        length(
            "texture coordinates",
            self.uvs.as_ref().map(Vec::len),
            vertices,
        )?;
        length(
            "face materials",
            self.face_materials.as_ref().map(Vec::len),
            faces,
        )?;
        length("face lines", self.face_lines.as_ref().map(Vec::len), faces)?;
        length(
            "marks of faces that continue polygons",
            self.face_continues.as_ref().map(Vec::len),
            faces,
        )?;
        if !self.anchor.is_finite() {
            return Err(GeometryError::NotFinite {
                what: "anchor of the mesh",
            });
        }
        check_finite("vertex", &self.positions)?;
        check_finite("normal of vertex", self.normals.as_deref().unwrap_or(&[]))?;
        check_finite(
            "texture coordinate of vertex",
            self.uvs.as_deref().unwrap_or(&[]),
        )
    }
}

/// Finds the first entry of a list that has a NaN or an infinity in it.
pub(super) fn check_finite<const N: usize>(
    what: &'static str,
    list: &[[f32; N]],
) -> Result<(), GeometryError> {
    match list.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
        Some(index) => Err(GeometryError::NotFiniteAt {
            what,
            index: index as u64,
        }),
        None => Ok(()),
    }
}
