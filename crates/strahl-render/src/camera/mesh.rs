use super::PrimaryRays;
use arrayvec::ArrayVec;
use strahl_accel::PACKET;
use strahl_math::{DVec2, DVec3, Ray};
use strahl_scene::{CameraFace, CameraMesh, MeshCamera, MeshLayout};
use strahl_shade::Color;

impl PrimaryRays {
    /// The mean of the rays from the faces that belong to a position in the picture; black if there are none. `trace` returns the colours of
    /// at most [`PACKET`] rays.
    pub(super) fn mesh_color(
        &self,
        mesh: &MeshCamera,
        x: f64,
        y: f64,
        mut trace: impl FnMut(&[Option<Ray>]) -> ArrayVec<Color, PACKET>,
    ) -> Color {
        let (mut sum, mut count) = (Color::BLACK, 0u32);
        let mut rays = ArrayVec::<Option<Ray>, PACKET>::new();
        let mut trace_all = |rays: &mut ArrayVec<Option<Ray>, PACKET>| {
            for color in trace(rays) {
                sum += color;
                count += 1;
            }
            rays.clear();
        };
        self.visit_mesh_rays(mesh, x, y, &mut |ray| {
            rays.push(Some(ray));
            if rays.is_full() {
                trace_all(&mut rays);
            }
        });
        if !rays.is_empty() {
            trace_all(&mut rays);
        }
        if count == 0 {
            Color::BLACK
        } else {
            sum / f64::from(count)
        }
    }

    /// The ray of a position in the picture, if the camera has no more than one for each; `None` where it sees nothing.
    pub(super) fn mesh_ray(&self, mesh: &MeshCamera, x: f64, y: f64) -> Option<Ray> {
        let mut found = None;
        if has_one_ray(mesh) {
            self.visit_mesh_rays(mesh, x, y, &mut |ray| found = Some(ray));
        }
        found
    }

    /// Visits the rays from the faces that belong to a position in the picture.
    fn visit_mesh_rays(&self, mesh: &MeshCamera, x: f64, y: f64, visit: &mut impl FnMut(Ray)) {
        let (width, height) = (self.width as usize, self.height as usize);
        let column = (x.max(0.0) as usize).min(width.saturating_sub(1));
        let row = (y.max(0.0) as usize).min(height.saturating_sub(1));
        let pixel = row * width + column;
        let mut add = |ray: Option<Ray>| {
            if let Some(ray) = ray {
                visit(ray);
            }
        };
        match mesh.layout {
            MeshLayout::Each(rays) => {
                for faces in mesh.meshes.iter().take(rays as usize) {
                    add(faces.face(pixel).map(|face| mesh.ray_through_middle(&face)));
                }
            }
            MeshLayout::Joined(rays) => {
                for number in 0..rays as usize {
                    let index = pixel + number * width * height;
                    add(mesh
                        .joined(index)
                        .map(|face| mesh.ray_through_middle(&face)));
                }
            }
            MeshLayout::SideBySide => {
                let count = mesh.meshes.len().max(1);
                let part = (width / count).max(1);
                let which = (column / part).min(count - 1);
                let index = row * part + (column - which * part).min(part - 1);
                let face = mesh.meshes.get(which).and_then(|faces| faces.face(index));
                add(face.map(|face| mesh.ray_through_middle(&face)));
            }
            MeshLayout::ByUv => {
                let place = DVec2::new(x / self.width, 1.0 - y / self.height);
                let parts = mesh.meshes.first().map_or(&[][..], CameraMesh::parts);
                let found = parts.iter().find_map(|part| {
                    part.faces.iter().find_map(|face| {
                        let weights = barycentric(face.uv?, place)?;
                        Some(mesh.ray_through(&part.in_world(face), weights))
                    })
                });
                add(found);
            }
        }
    }
}

/// Whether no position in the picture has more than one ray.
pub(super) fn has_one_ray(mesh: &MeshCamera) -> bool {
    match mesh.layout {
        MeshLayout::Each(rays) | MeshLayout::Joined(rays) => rays <= 1,
        MeshLayout::SideBySide | MeshLayout::ByUv => true,
    }
}

/// How a mesh camera derives rays from its faces.
trait FaceRays {
    fn joined(&self, index: usize) -> Option<CameraFace>;
    fn ray_through_middle(&self, face: &CameraFace) -> Ray;
    fn ray_through(&self, face: &CameraFace, weights: [f64; 3]) -> Ray;
    fn leaving(&self, point: DVec3, normal: DVec3) -> Ray;
}

impl FaceRays for MeshCamera {
    /// A face, with the faces of all meshes numbered consecutively.
    fn joined(&self, mut index: usize) -> Option<CameraFace> {
        for faces in &self.meshes {
            match index.checked_sub(faces.len()) {
                None => return faces.face(index),
                Some(rest) => index = rest,
            }
        }
        None
    }

    fn ray_through_middle(&self, face: &CameraFace) -> Ray {
        let [a, b, c] = face.corners;
        self.leaving((a + b + c) / 3.0, face.normal())
    }

    fn ray_through(&self, face: &CameraFace, [wa, wb, wc]: [f64; 3]) -> Ray {
        let [a, b, c] = face.corners;
        let normal = match face.normals {
            Some([na, nb, nc]) if self.smooth => {
                (na * wa + nb * wb + nc * wc).normalize_or(face.normal())
            }
            _ => face.normal(),
        };
        self.leaving(a * wa + b * wb + c * wc, normal)
    }

    fn leaving(&self, point: DVec3, normal: DVec3) -> Ray {
        let direction = if self.reversed { -normal } else { normal };
        Ray::new(point + normal * self.offset, direction)
    }
}

/// The weights of the corners of a triangle at a point of it; `None` outside.
fn barycentric([a, b, c]: [DVec2; 3], p: DVec2) -> Option<[f64; 3]> {
    let cross = |u: DVec2, v: DVec2| u.x * v.y - u.y * v.x;
    let area = cross(b - a, c - a);
    if area == 0.0 {
        return None;
    }
    let wb = cross(p - a, c - a) / area;
    let wc = cross(b - a, p - a) / area;
    let wa = 1.0 - wb - wc;
    (wa >= 0.0 && wb >= 0.0 && wc >= 0.0).then_some([wa, wb, wc])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use strahl_math::Transform;
    use strahl_scene::{Camera, CameraFront, CameraPart, Projection};

    fn face(x: f64) -> CameraFace {
        let corner = |dx: f64, dy: f64| DVec3::new(x + dx, dy, 0.0);
        let uv = |u: f64, v: f64| DVec2::new(u, v);
        CameraFace {
            corners: [corner(0.0, 0.0), corner(3.0, 0.0), corner(0.0, 3.0)],
            front: CameraFront::Counterclockwise,
            normals: None,
            uv: Some([uv(0.0, 0.0), uv(1.0, 0.0), uv(0.0, 1.0)]),
        }
    }

    fn origins(layout: MeshLayout, place: (f64, f64)) -> Vec<DVec3> {
        let faces: Vec<CameraFace> = (0..4).map(|n| face(10.0 * f64::from(n))).collect();
        // The second mesh is the first one, moved, and its last two faces are a part of their own.
        let part = |range: std::ops::Range<usize>| CameraPart {
            faces: faces[range].into(),
            transform: Transform::translate(DVec3::X * 100.0),
        };
        let mut moved = CameraMesh::default();
        moved.push(part(0..2));
        moved.push(part(2..4));
        assert_eq!((moved.len(), moved.face(4)), (4, None));
        let meshes = vec![CameraMesh::from(faces.clone()), moved];
        let mesh = MeshCamera {
            layout,
            meshes,
            offset: 0.5,
            reversed: true,
            smooth: false,
        };
        let mut camera = Camera::perspective(DVec3::ZERO, DVec3::Z, DVec3::Y, 1.0);
        camera.projection = Projection::Mesh(Arc::new(mesh));
        let mut found = vec![];
        let rays = PrimaryRays::new(&camera, 2, 2);
        rays.color(place.0, place.1, |ray| {
            assert_eq!(ray.direction, DVec3::NEG_Z);
            found.push(ray.origin);
            Color::WHITE
        });
        found
    }

    #[test]
    fn pixels_have_their_faces() {
        let at = |x: f64| DVec3::new(x, 1.0, 0.5);
        let first_of_second_row = (0.5, 1.5);
        let find = |layout| origins(layout, first_of_second_row);
        assert_eq!(find(MeshLayout::Each(2)), [at(21.0), at(121.0)]);
        assert_eq!(find(MeshLayout::Each(1)), [at(21.0)]);
        assert_eq!(find(MeshLayout::Joined(2)), [at(21.0), at(121.0)]);
        assert_eq!(find(MeshLayout::SideBySide), [at(11.0)]);
        assert_eq!(origins(MeshLayout::SideBySide, (1.5, 0.5)), [at(101.0)]);
        // The lower left quarter of the picture.
        assert_eq!(find(MeshLayout::ByUv), [DVec3::new(0.75, 0.75, 0.5)]);
        assert_eq!(origins(MeshLayout::ByUv, (1.9, 0.1)), []);
    }
}
