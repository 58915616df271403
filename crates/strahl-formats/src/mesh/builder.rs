use hashbrown::hash_table::Entry;
use hashbrown::{DefaultHashBuilder, HashTable};
use std::hash::{BuildHasher, Hash};
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
/// The mesh has normals if any vertex has one, and likewise texture coordinates. Vertices without them get the zero vector and
/// the origin; a reader that mixes both ensures that this does not show.
#[derive(Debug, Default)]
pub(crate) struct MeshParts {
    pub(super) positions: Vec<DVec3>,
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) uvs: Vec<[f32; 2]>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) lines: Vec<u32>,
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

/// The key of a vertex: all its data.
pub(crate) trait VertexKey: Copy + Eq + Hash + Send + Sync {
    /// The vertex.
    fn vertex(self) -> Vertex;
}

/// Collects triangles and merges equal corners into one vertex.
#[derive(Debug)]
pub(crate) struct MeshBuilder<K> {
    /// The numbers of the vertices.
    known: HashTable<u32>,
    hasher: DefaultHashBuilder,
    /// In the order of their first corners.
    pub(super) vertices: Vec<K>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) lines: Vec<u32>,
}

impl<K> Default for MeshBuilder<K> {
    fn default() -> Self {
        Self {
            known: HashTable::new(),
            hasher: DefaultHashBuilder::default(),
            vertices: vec![],
            triangles: vec![],
            lines: vec![],
        }
    }
}

impl<K: VertexKey> MeshBuilder<K> {
    /// Adds a triangle, which comes from this line of the file.
    pub(crate) fn triangle(&mut self, corners: [K; 3], line: u32) {
        let [a, b, c] = corners;
        let triangle = [self.vertex(a), self.vertex(b), self.vertex(c)];
        self.triangles.push(triangle);
        self.lines.push(line);
    }

    #[inline]
    fn vertex(&mut self, corner: K) -> u32 {
        let Self {
            known,
            hasher,
            vertices,
            ..
        } = self;
        let hash = hasher.hash_one(corner);
        let entry = known.entry(
            hash,
            |vertex| vertices[*vertex as usize] == corner,
            |vertex| hasher.hash_one(vertices[*vertex as usize]),
        );
        match entry {
            Entry::Occupied(found) => *found.get(),
            Entry::Vacant(free) => {
                // More would take more memory than is reasonable; the mesh is refused then.
                let vertex = u32::try_from(vertices.len()).unwrap_or(u32::MAX);
                free.insert(vertex);
                vertices.push(corner);
                vertex
            }
        }
    }
}
