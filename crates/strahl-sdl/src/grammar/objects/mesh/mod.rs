//! Triangle meshes: `mesh` and `mesh2`.

mod blend;
mod builder;
mod indexed;
mod numbered;
mod orient;
mod triangles;

pub(super) use indexed::mesh2;
pub(super) use triangles::mesh;

use crate::grammar::{Entity, Texture};
use crate::parser::{PResult, Parser, Place};
use strahl_geometry::{Brep, MeshData, Shape, TriangleMesh};
use strahl_math::DVec3;
use strahl_scene::{CsgOp, Object, ObjectKind};

/// The parts of a mesh read so far, each with one texture, and whether the mesh has an inside.
#[derive(Default)]
struct Parts {
    meshes: Vec<(Option<Texture>, MeshData)>,
    /// The number of triangles without area, which are left out.
    degenerate: usize,
    has_inside: bool,
}

/// Equal textures are searched only among the last ones, so that a texture per triangle does not take quadratic time.
const SEARCHED: usize = 64;

/// The index of a texture in a list; a new one is appended.
fn texture_number(list: &mut Vec<Texture>, texture: Texture) -> usize {
    let first = list.len().saturating_sub(SEARCHED);
    let recent = list.get(first..).unwrap_or(&[]);
    match recent.iter().rposition(|t| *t == texture) {
        Some(found) => first + found,
        None => {
            list.push(texture);
            list.len() - 1
        }
    }
}

/// Whether three corners span an area.
fn has_area([a, b, c]: [DVec3; 3]) -> bool {
    (b - a).cross(c - a) != DVec3::ZERO
}

impl Parser<'_> {
    /// The object of a mesh: one mesh, which is a solid if it is closed and has an `inside_vector`, or a union of meshes with
    /// different textures.
    fn mesh_object(&mut self, parts: Parts, place: Place) -> PResult<Entity> {
        if parts.degenerate > 0 {
            let n = parts.degenerate;
            self.warn(
                place,
                format!("{n} of the mesh's triangles have no area and are left out"),
            );
        }
        let single = parts.meshes.len() == 1;
        if parts.has_inside && parts.meshes.len() > 1 {
            self.warn_hint(
                place,
                "a mesh of several textures, or partly with normals, has no inside",
                "in intersections and differences it is not treated as a solid",
            );
        }
        let mut objects = vec![];
        for (texture, mut data) in parts.meshes {
            let smooth = data.normals.is_some();
            let turns = smooth || (parts.has_inside && single);
            let written = if turns { data.indices.clone() } else { vec![] };
            if parts.has_inside && single {
                orient::orient(&mut data);
            } else {
                orient::turn_to_front(&mut data);
            }
            let exchanged = written.iter().zip(&data.indices).map(|(a, b)| a != b);
            let exchanged = exchanged.collect();
            let mesh = match TriangleMesh::try_new(data) {
                Ok(mesh) => mesh.with_exchanged(exchanged),
                Err(error) => return Err(self.fail(place, error.to_string())),
            };
            let shape = if parts.has_inside && single {
                self.closed_mesh(mesh, place)
            } else {
                // POV-Ray's fronts of flat triangles are the other sides (measured).
                if smooth {
                    mesh
                } else {
                    mesh.turned_inside_out()
                }
                .into()
            };
            let mut object = Object::new(ObjectKind::Shape(shape));
            object.span = self.span_at(place);
            object.material = texture.map(|t| self.material(&t));
            objects.push(object);
        }
        if objects.is_empty() {
            if parts.degenerate > 0 {
                return Ok(Entity::nothing());
            }
            return Err(self.fail(place, "the mesh has no triangles"));
        }
        // The texture of the whole mesh does not replace those of triangles.
        let plain = objects.pop_if(|only| single && only.material.is_none());
        let mut entity = Entity::from(plain.unwrap_or_else(|| Object::csg(CsgOp::Union, objects)));
        entity.object.span = self.span_at(place);
        Ok(entity)
    }

    fn closed_mesh(&mut self, mesh: TriangleMesh, place: Place) -> Shape {
        match Brep::try_new(mesh.clone()) {
            Ok(solid) => solid.into(),
            Err(error) => {
                self.warn_hint(
                    place,
                    error.to_string(),
                    "the mesh has no inside: in intersections and differences it is not treated as a solid",
                );
                mesh.into()
            }
        }
    }
}
