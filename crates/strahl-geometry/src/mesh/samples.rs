//! Meshes for the tests of this folder, and what their batteries need.

use super::MeshData;
use crate::conformance::Random;
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Solid, SurfaceId, SurfacePoint,
};
use std::collections::HashMap;
use std::sync::Arc;
use strahl_math::{Aabb, DVec3, Interval, Ray, det};

/// The box from -1 to 1, outward.
pub(super) fn cube() -> MeshData {
    let vertices: Vec<_> = (0..8)
        .map(|i| [0, 1, 2].map(|k| if i >> k & 1 == 0 { -1.0 } else { 1.0 }))
        .collect();
    let quads = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    MeshData {
        positions: vertices,
        indices: quads
            .iter()
            .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect(),
        ..MeshData::default()
    }
}

/// A sphere of 8 * 4^levels triangles about the origin, outward, its vertices off the sphere by up to `noise`.
pub(super) fn icosphere(levels: u32, noise: f64) -> MeshData {
    let mut vertices = vec![
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        -DVec3::X,
        -DVec3::Y,
        -DVec3::Z,
    ];
    let mut faces: Vec<[u32; 3]> = vec![
        [0, 1, 2],
        [1, 3, 2],
        [3, 4, 2],
        [4, 0, 2],
        [1, 0, 5],
        [3, 1, 5],
        [4, 3, 5],
        [0, 4, 5],
    ];
    for _ in 0..levels {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                vertices.push((vertices[a as usize] + vertices[b as usize]).normalize());
                vertices.len() as u32 - 1
            })
        };
        faces = faces
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            })
            .collect();
    }
    let mut random = Random::new(3);
    for v in &mut vertices {
        *v *= 1.0 + random.between(-noise, noise);
    }
    MeshData::from_f64(&vertices, faces)
}

/// A torus about the z axis, outward.
pub(crate) fn torus(rings: u32, sides: u32, major: f64, minor: f64) -> MeshData {
    let turn = |i: u32, n: u32| std::f64::consts::TAU * f64::from(i) / f64::from(n);
    let vertices: Vec<_> = (0..rings * sides)
        .map(|i| {
            let (a, b) = (turn(i / sides, rings), turn(i % sides, sides));
            let r = major + minor * det::cos(b);
            DVec3::new(r * det::cos(a), r * det::sin(a), minor * det::sin(b))
        })
        .collect();
    let at = |i: u32, k: u32| (i % rings) * sides + k % sides;
    let faces = (0..rings * sides)
        .map(|i| (i / sides, i % sides))
        .flat_map(|(i, k)| {
            let (a, b, c, d) = (at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1));
            [[a, b, c], [a, c, d]]
        })
        .collect();
    MeshData::from_f64(&vertices, faces)
}

/// `n * n` squares over the unit square, heights random in `0..height`.
pub(super) fn height_field(n: u32, height: f64) -> MeshData {
    let mut random = Random::new(4);
    let part = |i: u32| f64::from(i) / f64::from(n);
    let vertices: Vec<_> = (0..(n + 1) * (n + 1))
        .map(|i| {
            DVec3::new(
                part(i % (n + 1)),
                part(i / (n + 1)),
                random.between(0.0, height),
            )
        })
        .collect();
    let faces = (0..n * n)
        .map(|i| (i / n) * (n + 1) + i % n)
        .flat_map(|a| {
            let (b, c, d) = (a + 1, a + n + 2, a + n + 1);
            [[a, b, c], [a, c, d]]
        })
        .collect();
    MeshData::from_f64(&vertices, faces)
}

/// A shape that is never baked. Meshes round to f32 when they are baked, but the battery allows only for the rounding
/// of f64.
#[derive(Debug)]
pub(super) struct Unbaked(pub(super) Arc<dyn Primitive>);

impl Primitive for Unbaked {
    fn kind(&self) -> &'static str {
        self.0.kind()
    }

    fn validate(&self) -> Result<(), GeometryError> {
        self.0.validate()
    }

    fn bounds(&self) -> Aabb {
        self.0.bounds()
    }

    fn elements(&self) -> u32 {
        self.0.elements()
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        self.0.closest_hit(ray, range, from, scratch)
    }

    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> bool {
        self.0.any_hit(ray, range, from, scratch)
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        self.0.surface_at(ray, hit)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        self.0.as_solid().map(|_| self as &dyn Solid)
    }
}

impl Solid for Unbaked {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        if let Some(solid) = self.0.as_solid() {
            solid.crossings(ray, range, from, scratch, out);
        }
    }

    fn contains(&self, point: DVec3) -> bool {
        self.0.as_solid().is_some_and(|solid| solid.contains(point))
    }
}
