//! Rays aimed exactly at the seams of meshes: none may slip through.

use super::samples::{height_field, icosphere};
use super::{MeshData, TriangleMesh};
use crate::conformance::Random;
use crate::{Primitive, Scratch};
use strahl_math::{DVec3, Interval, Ray, Transform};

/// A corner of the mesh, or a point of an edge: one of its simple fractions or a random one.
fn seam(mesh: &TriangleMesh, random: &mut Random) -> DVec3 {
    let corners = mesh.corners(random.below(mesh.triangle_count().into()) as u32);
    let k = random.below(3) as usize;
    let (a, b) = (corners[k], corners[(k + 1) % 3]);
    match random.below(4) {
        0 => a,
        1 => a + (b - a) * 0.5,
        2 => a + (b - a) * (random.below(8) as f64 / 8.0),
        _ => a + (b - a) * random.between(0.0, 1.0),
    }
}

/// Counts the rays that miss although the surface is all around them or all beneath them.
fn passes(
    mesh: &TriangleMesh,
    rays: usize,
    mut ray_to: impl FnMut(DVec3, &mut Random) -> Ray,
) -> usize {
    let (mut random, mut scratch) = (Random::new(1), Scratch::default());
    (0..rays)
        .filter(|_| {
            let target = seam(mesh, &mut random);
            let ray = ray_to(target, &mut random);
            !mesh.any_hit(&ray, Interval::FORWARD, None, &mut scratch)
        })
        .count()
}

fn from_within(target: DVec3, center: DVec3, random: &mut Random) -> Ray {
    let origin = match random.below(4) {
        0 => center,
        1 => center + (target - center) * random.between(-0.5, 0.5),
        _ => center + random.cube() * 0.4 * (target - center).length(),
    };
    Ray::new(origin, (target - origin) * random.between(0.01, 100.0))
}

#[test]
fn no_ray_leaves_a_closed_mesh_through_its_seams() {
    let mesh = TriangleMesh::try_new(icosphere(2, 0.1)).expect("a mesh");
    let count = passes(&mesh, 500_000, |target, random| {
        from_within(target, DVec3::ZERO, random)
    });
    assert_eq!(count, 0);
}

#[test]
fn no_ray_leaves_a_flat_regular_mesh_through_its_seams() {
    // No noise: many edges lie in coordinate planes, and rays run along them.
    let mesh = TriangleMesh::try_new(icosphere(1, 0.0)).expect("a mesh");
    let count = passes(&mesh, 200_000, |target, random| {
        from_within(target, DVec3::ZERO, random)
    });
    assert_eq!(count, 0);
}

#[test]
fn no_ray_leaves_a_small_mesh_far_away() {
    let center = DVec3::new(1e7, -3e6, 5e6);
    let map = Transform::try_scale(DVec3::splat(1e-3))
        .expect("regular")
        .then(&Transform::translate(center));
    let near = TriangleMesh::try_new(icosphere(1, 0.1)).expect("a mesh");
    let mesh = near.transformed(&map).expect("in range");
    assert_ne!(mesh.anchor(), DVec3::ZERO);
    let count = passes(&mesh, 200_000, |target, random| {
        from_within(target, center, random)
    });
    assert_eq!(count, 0);
}

#[test]
fn no_ray_falls_through_a_height_field() {
    let mesh = TriangleMesh::try_new(height_field(12, 0.3)).expect("a mesh");
    let mut aimed = 0;
    let count = passes(&mesh, 400_000, |target, random| {
        // Into the inner part, steep enough to come out below it.
        let inner = (target * 0.5 + DVec3::new(0.25, 0.25, 0.0)).with_z(target.z);
        let on_the_rim = [target.x, target.y]
            .iter()
            .any(|x| !(0.3..=0.7).contains(x));
        let target = if on_the_rim { inner } else { target };
        aimed += usize::from(!on_the_rim);
        let drift = match random.below(3) {
            0 => DVec3::ZERO,
            _ => random.cube().with_z(0.0) * 0.4,
        };
        let direction = drift - DVec3::Z;
        // From above the highest vertex.
        let height = 0.31 - target.z + random.between(0.0, 0.5);
        Ray::new(target - direction * height, direction)
    });
    assert_eq!(count, 0);
    assert!(aimed > 20_000);
}

#[test]
fn duplicated_vertices_leave_no_crack() {
    let data = icosphere(1, 0.1);
    let exploded = MeshData {
        positions: data
            .indices
            .iter()
            .flatten()
            .map(|&v| data.positions[v as usize])
            .collect(),
        indices: (0..data.indices.len() as u32)
            .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
            .collect(),
        ..MeshData::default()
    };
    let mesh = TriangleMesh::try_new(exploded).expect("a mesh");
    let count = passes(&mesh, 100_000, |target, random| {
        from_within(target, DVec3::ZERO, random)
    });
    assert_eq!(count, 0);
}
