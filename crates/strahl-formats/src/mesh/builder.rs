use std::collections::HashMap;
use std::hash::Hash;
use std::sync::Arc;
use strahl_geometry::{GeometryError, MeshData, TriangleMesh};
use strahl_math::{DVec2, DVec3};

/// A vertex of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Vertex {
    pub(crate) position: DVec3,
    pub(crate) normal: Option<DVec3>,
    pub(crate) uv: Option<DVec2>,
}

impl Vertex {
    pub(crate) const fn at(position: DVec3) -> Self {
        Self {
            position,
            normal: None,
            uv: None,
        }
    }
}

/// Gathers vertices and triangles.
///
/// The mesh has normals if any vertex has one, and texture coordinates likewise. Corners that have none then get the
/// zero vector and the origin; a reader that mixes both sees to it that this does not show.
#[derive(Debug, Default)]
pub(crate) struct MeshParts {
    positions: Vec<DVec3>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    triangles: Vec<[u32; 3]>,
    lines: Vec<u32>,
}

impl MeshParts {
    /// Adds a vertex; returns its number.
    ///
    /// Numbers end at `u32::MAX`; a mesh of more vertices takes more memory than is reasonable, and
    /// [`MeshParts::finish`] reports it.
    pub(crate) fn push(&mut self, vertex: Vertex) -> u32 {
        let count = self.positions.len();
        if let Some(n) = vertex.normal {
            self.normals.resize(count, [0.0; 3]);
            self.normals.push(n.as_vec3().to_array());
        }
        if let Some(uv) = vertex.uv {
            self.uvs.resize(count, [0.0; 2]);
            self.uvs.push(uv.as_vec2().to_array());
        }
        self.positions.push(vertex.position);
        u32::try_from(count).unwrap_or(u32::MAX)
    }

    /// Replaces the normal of a vertex that has been made with one.
    pub(crate) fn set_normal(&mut self, vertex: u32, normal: DVec3) {
        if let Some(place) = self.normals.get_mut(vertex as usize) {
            *place = normal.as_vec3().to_array();
        }
    }

    /// Adds a triangle of such vertices, which comes from this line of the file.
    pub(crate) fn triangle(&mut self, vertices: [u32; 3], line: u32) {
        self.triangles.push(vertices);
        self.lines.push(line);
    }

    /// The line of the first triangle and the mesh, if there is any triangle.
    pub(crate) fn finish(self) -> Option<(u32, Result<Arc<TriangleMesh>, GeometryError>)> {
        let Self {
            positions,
            mut normals,
            mut uvs,
            triangles,
            lines,
        } = self;
        let first = *lines.first()?;
        let mut data = MeshData::from_f64(&positions, triangles);
        if !normals.is_empty() {
            normals.resize(positions.len(), [0.0; 3]);
            data.normals = Some(normals);
        }
        if !uvs.is_empty() {
            uvs.resize(positions.len(), [0.0; 2]);
            data.uvs = Some(uvs);
        }
        data.face_lines = Some(lines);
        Some((first, TriangleMesh::try_new(data).map(Arc::new)))
    }
}

/// Gathers triangles whose corners are found again by a key: corners with the same key become one vertex.
#[derive(Debug)]
pub(crate) struct MeshBuilder<K> {
    known: HashMap<K, u32>,
    parts: MeshParts,
}

impl<K> Default for MeshBuilder<K> {
    fn default() -> Self {
        Self {
            known: HashMap::new(),
            parts: MeshParts::default(),
        }
    }
}

impl<K: Eq + Hash> MeshBuilder<K> {
    /// The number of the vertex with this key, which is made if it is new.
    pub(crate) fn vertex(&mut self, key: K, make: impl FnOnce() -> Vertex) -> u32 {
        let Self { known, parts } = self;
        *known.entry(key).or_insert_with(|| parts.push(make()))
    }

    /// Adds a triangle of such vertices, which comes from this line of the file.
    pub(crate) fn triangle(&mut self, vertices: [u32; 3], line: u32) {
        self.parts.triangle(vertices, line);
    }

    /// The line of the first triangle and the mesh, if there is any triangle.
    pub(crate) fn finish(self) -> Option<(u32, Result<Arc<TriangleMesh>, GeometryError>)> {
        drop(self.known);
        self.parts.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_with_one_key_are_one_vertex() {
        let mut mesh = MeshBuilder::default();
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::ONE];
        for (corners, line) in [([0, 1, 2], 7), ([2, 1, 3], 9)] {
            let vertices = corners.map(|i| mesh.vertex(i, || Vertex::at(points[i])));
            mesh.triangle(vertices, line);
        }
        let (line, mesh) = mesh.finish().expect("triangles");
        let mesh = mesh.expect("valid");
        assert_eq!(
            (line, mesh.positions().len(), mesh.triangle_count()),
            (7, 4, 2)
        );
        assert_eq!(mesh.face_line(1), Some(9));
    }

    #[test]
    fn nothing_is_no_mesh() {
        assert!(MeshBuilder::<u32>::default().finish().is_none());
    }
}
