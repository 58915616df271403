use super::numbered::Numbered;
use strahl_geometry::MeshData;
use strahl_math::DVec3;

/// The key of a vertex: the indices of position, normal and texture coordinates.
type Corner = [u32; 3];

/// No normal, or no texture coordinates.
pub(super) const NONE: u32 = u32::MAX;

/// Collects triangles whose corners refer to positions, normals and texture coordinates independently.
#[derive(Debug, Default)]
pub(super) struct Builder {
    corners: Numbered<Corner>,
    faces: Vec<[u32; 3]>,
}

impl Builder {
    pub(super) fn add(&mut self, triangle: [Corner; 3]) {
        let face = triangle.map(|corner| self.corners.number(corner));
        self.faces.push(face);
    }

    /// The mesh for the lists that the corners refer to. It has normals or texture coordinates if all corners do.
    pub(super) fn finish(
        self,
        positions: &[DVec3],
        normals: &[DVec3],
        uvs: &[[f64; 2]],
    ) -> MeshData {
        let corners = &self.corners.list;
        let vector = |list: &[DVec3], index: u32| list.get(index as usize).copied();
        let vertices: Vec<DVec3> = corners
            .iter()
            .map(|[p, _, _]| vector(positions, *p).unwrap_or_default())
            .collect();
        let normals = corners
            .iter()
            .map(|[_, n, _]| vector(normals, *n).map(|n| n.as_vec3().to_array()))
            .collect();
        let uvs = corners
            .iter()
            .map(|[_, _, uv]| uvs.get(*uv as usize).map(|uv| uv.map(|x| x as f32)))
            .collect();
        MeshData {
            normals,
            uvs,
            ..MeshData::from_f64(&vertices, self.faces)
        }
    }
}
