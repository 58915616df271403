//! Rays from one face of four meshes at once: copies of one mesh, moved a little each, as cameras have them that take many rays for a pixel.

use super::{MeshCamera, MeshLayout, NextRays};
use std::sync::Arc;
use strahl_math::{DVec3, Ray};
use strahl_scene::{CameraFace, CameraFront, CameraPart};
use strahl_simd::{Isa, Simd, dispatch};

/// Three coordinates of four vectors.
type Vectors<I> = [<I as Isa>::F64x4; 3];

/// Four meshes that share their faces.
#[derive(Clone, Debug)]
pub(in crate::camera) struct FourFaces {
    faces: Arc<[CameraFace]>,
    /// The columns of the maps to the world, and the translations.
    columns: [[[f64; 4]; 3]; 3],
    translation: [[f64; 4]; 3],
}

impl FourFaces {
    /// For each four meshes of a camera; `None` where they don't share their faces.
    pub(in crate::camera) fn of(mesh: &MeshCamera) -> Vec<Option<Self>> {
        if !matches!(mesh.layout, MeshLayout::Each(_)) {
            return vec![];
        }
        let (fours, _) = mesh.meshes.as_chunks::<4>();
        let parts = fours.iter().map(|four| four.each_ref().map(|m| m.parts()));
        parts
            .map(|parts| match parts {
                [[a], [b], [c], [d]] => Self::new([a, b, c, d]),
                _ => None,
            })
            .collect()
    }

    fn new(parts: [&CameraPart; 4]) -> Option<Self> {
        let faces = &parts[0].faces;
        let shared = parts.iter().all(|part| Arc::ptr_eq(&part.faces, faces));
        let lanes = |vector: &dyn Fn(&CameraPart) -> DVec3| {
            let four = parts.map(vector);
            [0, 1, 2].map(|axis| four.map(|v| v[axis]))
        };
        shared.then(|| Self {
            faces: Arc::clone(faces),
            columns: [0, 1, 2].map(|n| lanes(&|part| part.transform.linear().col(n))),
            translation: lanes(&|part| part.transform.translation()),
        })
    }

    /// Appends the rays from the middle of a face, with the bits of single ones; none if there are fewer faces.
    pub(super) fn push(&self, mesh: &MeshCamera, face: usize, rays: &mut NextRays) {
        if let Some(face) = self.faces.get(face) {
            dispatch!(Simd::best(), isa => self.push_with(isa, mesh, face, rays));
        }
    }

    #[inline(always)]
    fn push_with<I: Isa>(&self, isa: I, mesh: &MeshCamera, face: &CameraFace, rays: &mut NextRays) {
        let corners = [
            self.in_world(isa, face.corners[0]),
            self.in_world(isa, face.corners[1]),
            self.in_world(isa, face.corners[2]),
        ];
        let normal = normal(isa, corners, face.front);
        let (mut origins, mut directions) = ([[0.0; 4]; 3], [[0.0; 4]; 3]);
        for axis in 0..3 {
            let [a, b, c] = [corners[0][axis], corners[1][axis], corners[2][axis]];
            let middle = isa.div(isa.add(isa.add(a, b), c), isa.splat(3.0));
            let offset = isa.mul(normal[axis], isa.splat(mesh.offset));
            origins[axis] = isa.store(isa.add(middle, offset));
            directions[axis] = isa.store(match mesh.reversed {
                true => negated(isa, normal[axis]),
                false => normal[axis],
            });
        }
        for lane in 0..4 {
            let origin = DVec3::new(origins[0][lane], origins[1][lane], origins[2][lane]);
            let [x, y, z] = [
                directions[0][lane],
                directions[1][lane],
                directions[2][lane],
            ];
            rays.push(Some(Ray::new(origin, DVec3::new(x, y, z))));
        }
    }

    /// A corner of the face of each mesh.
    #[inline(always)]
    fn in_world<I: Isa>(&self, isa: I, corner: DVec3) -> Vectors<I> {
        let [x, y, z] = [
            isa.splat(corner.x),
            isa.splat(corner.y),
            isa.splat(corner.z),
        ];
        let mut point = [isa.splat(0.0); 3];
        for (axis, point) in point.iter_mut().enumerate() {
            let x = isa.mul(isa.load(&self.columns[0][axis]), x);
            let y = isa.mul(isa.load(&self.columns[1][axis]), y);
            let z = isa.mul(isa.load(&self.columns[2][axis]), z);
            let turned = isa.add(isa.add(x, y), z);
            *point = isa.add(turned, isa.load(&self.translation[axis]));
        }
        point
    }
}

/// The unit normals of four planes; z where the corners are on a line.
#[inline(always)]
fn normal<I: Isa>(isa: I, [a, b, c]: [Vectors<I>; 3], front: CameraFront) -> Vectors<I> {
    let zero = isa.splat(0.0);
    let (mut u, mut v) = ([zero; 3], [zero; 3]);
    for axis in 0..3 {
        u[axis] = isa.sub(c[axis], a[axis]);
        v[axis] = isa.sub(b[axis], a[axis]);
    }
    // Their cross product.
    let mut normal = [
        isa.sub(isa.mul(u[1], v[2]), isa.mul(v[1], u[2])),
        isa.sub(isa.mul(u[2], v[0]), isa.mul(v[2], u[0])),
        isa.sub(isa.mul(u[0], v[1]), isa.mul(v[0], u[1])),
    ];
    let [x, y, z] = normal;
    let squares = isa.add(isa.add(isa.mul(x, x), isa.mul(y, y)), isa.mul(z, z));
    let inverse = isa.div(isa.splat(1.0), isa.sqrt(squares));
    for (axis, n) in normal.iter_mut().enumerate() {
        let other = isa.splat(DVec3::Z[axis]);
        let unit = isa.choose_le(inverse, isa.splat(f64::MAX), isa.mul(*n, inverse), other);
        let unit = isa.choose_le(inverse, zero, other, unit);
        *n = match front {
            CameraFront::Clockwise => unit,
            CameraFront::Counterclockwise => negated(isa, unit),
        };
    }
    normal
}

#[inline(always)]
fn negated<I: Isa>(isa: I, v: I::F64x4) -> I::F64x4 {
    isa.mul(v, isa.splat(-1.0))
}
