//! `mesh_camera { ... }`: a camera whose rays start at the faces of meshes.

use crate::grammar::objects::expanded;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use std::collections::HashMap;
use std::sync::Arc;
use strahl_geometry::{Shape, TriangleMesh};
use strahl_math::Transform;
use strahl_scene::{
    CameraFace, CameraFront, CameraMesh, CameraPart, MeshCamera, MeshLayout, Object, ObjectKind,
};

/// A mesh camera being read; `location` and `direction` are outside of its braces.
pub(super) struct MeshDraft {
    layout: MeshLayout,
    smooth: bool,
    meshes: Vec<CameraMesh>,
}

impl MeshDraft {
    pub(super) fn finish(self, offset: f64, reversed: bool, smooth: bool) -> MeshCamera {
        MeshCamera {
            layout: self.layout,
            meshes: self.meshes,
            offset,
            reversed,
            smooth: smooth || self.smooth,
        }
    }
}

impl Parser<'_> {
    /// `{ rays, layout [, distance] meshes }` after `mesh_camera`.
    pub(super) fn mesh_camera(&mut self) -> PResult<MeshDraft> {
        /// More rays per pixel than this are certainly a mistake.
        const MOST: f64 = 65_536.0;
        self.braces(|p| {
            let place = p.place();
            let rays = p.float()?;
            p.comma()?;
            let number = p.float()?;
            p.comma()?;
            if !(1.0..=MOST).contains(&rays) {
                let message = format!("a mesh camera has 1 to {MOST} rays per pixel, not {rays}");
                return Err(p.fail(place, message));
            }
            let layout = match number {
                0.0 => MeshLayout::Each(rays as u32),
                1.0 => MeshLayout::Joined(rays as u32),
                2.0 => MeshLayout::SideBySide,
                3.0 => MeshLayout::ByUv,
                other => {
                    let message = format!(
                        "the distribution of a mesh camera must be 0, 1, 2 or 3, not {other}"
                    );
                    return Err(p.fail(place, message));
                }
            };
            if p.number_follows()? {
                let distance = p.float()?;
                p.comma()?;
                if distance > 0.0 {
                    p.warn_hint(
                        place,
                        "the maximal distance of `mesh_camera` is not supported yet",
                        "its rays see objects at any distance",
                    );
                }
            }
            let mut meshes = vec![];
            let mut collector = Collector::default();
            while let Some(object) = p.object()? {
                let object = expanded(&object, &p.state.shared);
                let (mut mesh, before) = (CameraMesh::default(), collector.count);
                collector.collect(&object, &Transform::IDENTITY, &mut mesh);
                p.spend_elements(collector.count - before)?;
                meshes.push(mesh);
                p.comma()?;
            }
            if meshes.iter().all(CameraMesh::is_empty) {
                return Err(p.fail_hint(
                    place,
                    "this mesh camera has no faces",
                    "name a mesh: `mesh { Name }`",
                ));
            }
            let needed = match layout {
                MeshLayout::Each(rays) => rays as usize,
                _ => 1,
            };
            if meshes.len() < needed {
                let count = meshes.len();
                let message =
                    format!("{needed} rays per pixel need as many meshes, but there are {count}");
                return Err(p.fail(place, message));
            }
            let mut smooth = false;
            p.items("`mesh_camera`", |p, token| {
                if token.is(Word::Smooth) {
                    p.take(token)?;
                    smooth = p.switched()?;
                    return Ok(());
                }
                p.skip_item(token, "`mesh_camera`")
            })?;
            Ok(MeshDraft {
                layout,
                smooth,
                meshes,
            })
        })
    }
}

/// Collects the faces of meshes. Copies of a mesh share its faces.
#[derive(Default)]
struct Collector {
    /// The faces of each mesh in its own space. The shape is kept so that no other mesh gets its address.
    known: HashMap<*const TriangleMesh, (Shape, Arc<[CameraFace]>)>,
    /// The number of these faces.
    count: u64,
}

impl Collector {
    /// Adds the faces of all meshes in an object. The parser limits the nesting of unions.
    fn collect(&mut self, object: &Object, outer: &Transform, into: &mut CameraMesh) {
        let transform = match object.transform.as_deref() {
            Some(inner) => inner.then(outer),
            None => *outer,
        };
        let (shape, mesh): (_, &TriangleMesh) = match &object.kind {
            ObjectKind::Csg { children, .. } => {
                for child in &children.0 {
                    self.collect(child, &transform, into);
                }
                return;
            }
            ObjectKind::Shape(shape @ Shape::TriangleMesh(mesh)) => (shape, mesh),
            ObjectKind::Shape(shape @ Shape::Brep(solid)) => (shape, solid.mesh()),
            _ => return,
        };
        let (_, faces) = self.known.entry(mesh).or_insert_with(|| {
            self.count += u64::from(mesh.triangle_count());
            let faces = (0..mesh.triangle_count()).map(|n| face(mesh, n));
            (shape.clone(), faces.collect())
        });
        into.push(CameraPart {
            faces: Arc::clone(faces),
            transform,
        });
    }
}

/// A face in the space of its mesh.
fn face(mesh: &TriangleMesh, number: u32) -> CameraFace {
    let at = |u: f64, v: f64| mesh.surface_at_element(number, [u, v]).uv;
    CameraFace {
        corners: mesh.corners(number),
        // The normal points to the side from which the corners, as they are written, are in clockwise order, in left-handed
        // space (measured with POV-Ray 3.7).
        front: if mesh.is_exchanged(number) {
            CameraFront::Counterclockwise
        } else {
            CameraFront::Clockwise
        },
        normals: mesh.corner_normals(number),
        uv: Some([at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)]),
    }
}
