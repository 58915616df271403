mod fours;

use super::PrimaryRays;
use super::bundle::{NextRays, RayBundle};
pub(super) use fours::FourFaces;
use strahl_accel::PACKET;
use strahl_math::{DVec2, DVec3, Ray};
use strahl_scene::{CameraFace, CameraMesh, CameraPart, MeshCamera, MeshLayout};

impl PrimaryRays {
    /// Appends rays from the faces that belong to a position in the picture, until there are as many as a packet has.
    pub(super) fn more_of_mesh(
        &self,
        mesh: &MeshCamera,
        bundle: &mut RayBundle,
        rays: &mut NextRays,
    ) {
        let pixel = self.pixel(bundle.at);
        let end = most_rays(mesh);
        while rays.len() < PACKET && bundle.next < end {
            let number = bundle.next;
            if number.is_multiple_of(4)
                && rays.len() + 4 <= PACKET
                && number + 4 <= end
                && let Some(Some(four)) = self.fours.get(number as usize / 4)
            {
                four.push(mesh, pixel, rays);
                bundle.next += 4;
                continue;
            }
            rays.extend(self.mesh_ray(mesh, bundle.at, number).map(Some));
            bundle.next += 1;
        }
    }

    /// The number of the pixel of a position, counted row by row.
    fn pixel(&self, (x, y): (f64, f64)) -> usize {
        let (width, height) = (self.width as usize, self.height as usize);
        let column = (x.max(0.0) as usize).min(width.saturating_sub(1));
        let row = (y.max(0.0) as usize).min(height.saturating_sub(1));
        row * width + column
    }

    /// One of the rays of a position in the picture; `None` where it sees nothing.
    pub(super) fn mesh_ray(
        &self,
        mesh: &MeshCamera,
        (x, y): (f64, f64),
        number: u32,
    ) -> Option<Ray> {
        if number >= most_rays(mesh) {
            return None;
        }
        let pixel = self.pixel((x, y));
        let (part, face) = match mesh.layout {
            MeshLayout::Each(_) => mesh.meshes.get(number as usize)?.find(pixel)?,
            MeshLayout::Joined(_) => {
                let picture = self.width as usize * self.height as usize;
                mesh.joined(pixel + number as usize * picture)?
            }
            MeshLayout::SideBySide => {
                let width = (self.width as usize).max(1);
                let (row, column) = (pixel / width, pixel % width);
                let count = mesh.meshes.len().max(1);
                let share = (width / count).max(1);
                let which = (column / share).min(count - 1);
                let index = row * share + (column - which * share).min(share - 1);
                mesh.meshes.get(which)?.find(index)?
            }
            MeshLayout::ByUv => {
                let place = DVec2::new(x / self.width, 1.0 - y / self.height);
                let parts = mesh.meshes.first().map_or(&[][..], CameraMesh::parts);
                return parts.iter().find_map(|part| {
                    part.faces.iter().find_map(|face| {
                        let weights = barycentric(face.uv?, place)?;
                        Some(mesh.ray_through(&part.in_world(face), weights))
                    })
                });
            }
        };
        Some(mesh.ray_through_middle(part, face))
    }
}

/// Whether positions in the picture may have more than one ray.
pub(super) fn has_many_rays(mesh: &MeshCamera) -> bool {
    most_rays(mesh) > 1
}

/// The most rays of a position in the picture.
fn most_rays(mesh: &MeshCamera) -> u32 {
    match mesh.layout {
        MeshLayout::Each(rays) => rays.min(mesh.meshes.len() as u32),
        MeshLayout::Joined(rays) => rays,
        MeshLayout::SideBySide | MeshLayout::ByUv => 1,
    }
}

/// How a mesh camera derives rays from its faces.
trait FaceRays {
    fn joined(&self, index: usize) -> Option<(&CameraPart, &CameraFace)>;
    fn ray_through_middle(&self, part: &CameraPart, face: &CameraFace) -> Ray;
    fn ray_through(&self, face: &CameraFace, weights: [f64; 3]) -> Ray;
    fn leaving(&self, point: DVec3, normal: DVec3) -> Ray;
}

impl FaceRays for MeshCamera {
    /// A face and its part, with the faces of all meshes numbered consecutively.
    fn joined(&self, mut index: usize) -> Option<(&CameraPart, &CameraFace)> {
        for faces in &self.meshes {
            match index.checked_sub(faces.len()) {
                None => return faces.find(index),
                Some(rest) => index = rest,
            }
        }
        None
    }

    fn ray_through_middle(&self, part: &CameraPart, face: &CameraFace) -> Ray {
        let corners = part.corners_in_world(face);
        let [a, b, c] = corners;
        self.leaving((a + b + c) / 3.0, face.front.normal(corners))
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
    use strahl_scene::{Camera, CameraFront, Projection};
    use strahl_shade::Color;

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
        assert_eq!((moved.len(), moved.find(4)), (4, None));
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

    /// Eight copies of a mesh with usual faces and with corners on a line.
    fn copies(reversed: bool) -> PrimaryRays {
        let faces: Arc<[CameraFace]> = (0..6)
            .map(|n| {
                let mut face = face(f64::from(n) * 0.7);
                face.corners[2].z = f64::from(n) - 1.5;
                match n {
                    1 => face.front = CameraFront::Clockwise,
                    4 => face.corners[1] = face.corners[0],
                    5 => face.corners[0].y = f64::NAN,
                    _ => {}
                }
                face
            })
            .collect();
        let meshes = (0..8).map(|n| {
            let turn = Transform::rotate(DVec3::new(1.0, 2.0, -0.5), f64::from(n) * 0.3);
            let mut mesh = CameraMesh::default();
            mesh.push(CameraPart {
                faces: Arc::clone(&faces),
                transform: turn.then(&Transform::translate(DVec3::ONE * f64::from(n))),
            });
            mesh
        });
        let mut camera = Camera::perspective(DVec3::ZERO, DVec3::Z, DVec3::Y, 1.0);
        camera.projection = Projection::Mesh(Arc::new(MeshCamera {
            layout: MeshLayout::Each(8),
            meshes: meshes.collect(),
            offset: 0.01,
            reversed,
            smooth: false,
        }));
        PrimaryRays::new(&camera, 3, 2)
    }

    #[test]
    fn four_rays_at_once_have_the_bits_of_single_ones() {
        let bits = |v: DVec3| {
            v.to_array()
                .map(|x| if x.is_nan() { 0 } else { x.to_bits() })
        };
        for reversed in [false, true] {
            let fours = copies(reversed);
            assert!(fours.fours.len() == 2 && fours.fours.iter().all(Option::is_some));
            let mut singles = fours.clone();
            singles.fours.clear();
            for pixel in 0..6 {
                let at = (f64::from(pixel % 3) + 0.5, f64::from(pixel / 3) + 0.5);
                let [a, b] = [&fours, &singles].map(|rays| {
                    let mut next = NextRays::new();
                    rays.more(&mut rays.bundle(at.0, at.1), &mut next);
                    let next = next.iter().flatten();
                    next.map(|ray| (bits(ray.origin), bits(ray.direction)))
                        .collect::<Vec<_>>()
                });
                assert!(a == b && a.len() == 8, "{pixel}");
            }
        }
    }
}
