//! Formats of surfaces (OBJ, PLY, STL), and how their faces become meshes.

mod builder;
mod merge;
pub(crate) mod obj;
pub(crate) mod ply;
mod polygon;
pub(crate) mod stl;

use std::sync::Arc;

pub(crate) use builder::{MeshBuilder, MeshParts, Vertex, VertexKey};
pub(crate) use merge::MeshPieces;
pub(crate) use polygon::{NO_AREA, Triangulator, polygon_normal};

/// The warning about vertices with colours, and its hint.
pub(crate) const COLORS_IGNORED: &str = "the colours of the vertices are ignored";
pub(crate) const COLORS_HINT: &str = "materials do not vary from vertex to vertex; a texture does";

/// The name of an object that is a whole file: the file's, without folders.
pub(crate) fn object_name(file: &str) -> Arc<str> {
    Arc::from(file.rsplit(['/', '\\']).next().unwrap_or(file))
}
