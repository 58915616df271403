//! Stanford PLY: ASCII, binary little-endian and binary big-endian.
//!
//! The reader is our own: existing crates build a map or a record per element, which takes several times as long as reading the
//! file, and they lose the places that messages should name.
//!
//! Read are `vertex` (`x y z`, `nx ny nz`, texture coordinates as `s t`, `u v`, `texture_u texture_v` or `texture_s
//! texture_t`), `face` (`vertex_indices` or `vertex_index`; polygons are cut into triangles) and `tristrips` (`vertex_indices`
//! with -1 between strips); scalars and lists of any type. Other elements and properties are skipped. Colours of vertices are
//! ignored with a warning: materials don't vary by vertex. So are the texture coordinates of faces that MeshLab writes (`texcoord`). Faces must come after the vertices.
//!
//! Vertices declared `float` are kept as they are, those of other types are rounded to f32 relative to an anchor
//! ([`MeshData::from_f64`](strahl_geometry::MeshData::from_f64)).

mod body;
mod faces;
mod header;
mod positions;
mod source;

use crate::input::Input;
use crate::input::report::{Fallible, Report};
use crate::input::text::Text;
use crate::mesh::object_name;
use body::Body;
use header::{Encoding, Header};
use source::{Ascii, Binary};
use std::sync::Arc;
use strahl_geometry::TriangleMesh;
use strahl_scene::{Diagnostic, Object, Scene};

/// Reads a mesh; errors and warnings go to the report.
pub(crate) fn read(input: &Input<'_>, report: &mut Report) -> Scene {
    let mut scene = Scene::default();
    let text = Text::new(input.bytes, input.name, scene.sources.add(input.name));
    if let Err(problem) = read_mesh(&text, &mut scene, report) {
        report.error(|| *problem);
    }
    scene
}

fn read_mesh(text: &Text<'_>, scene: &mut Scene, report: &mut Report) -> Fallible<()> {
    let header = Header::read(*text)?;
    let name = text.name;
    let mut body = Body::new(&header, name, report)?;
    match header.encoding {
        Encoding::Ascii => body.read(&mut Ascii::new(*text, &header))?,
        Encoding::Binary { big_endian } => {
            body.read(&mut Binary::new(text.bytes, &header, name, big_endian))?
        }
    }
    let data = body.finish();
    if report.has_errors() {
        return Ok(());
    }
    if data.indices.is_empty() {
        return Err(Box::new(
            Diagnostic::error(format!(
                "`{name}` has {} vertices but no faces",
                data.positions.len()
            ))
            .hint("point clouds have no surface that a ray could hit: convert it to a mesh first"),
        ));
    }
    let mesh = TriangleMesh::try_new(data)
        .map_err(|e| Box::new(Diagnostic::error(format!("`{name}`: {e}"))))?;
    scene.objects.0.push(Object {
        name: Some(object_name(name)),
        ..Arc::new(mesh).into()
    });
    Ok(())
}

#[cfg(test)]
mod tests;
