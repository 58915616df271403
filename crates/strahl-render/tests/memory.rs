//! What large scenes take in memory, by the scene's own account.

use std::sync::Arc;
use strahl_geometry::{MeshData, Sphere, TriangleMesh};
use strahl_math::DVec3;
use strahl_render::{CompileOptions, RenderScene, SceneStats, compile};
use strahl_scene::{Object, Scene};

const MANY: u32 = 100_000;

fn compiled(objects: impl Iterator<Item = Object>, accelerator: &str) -> RenderScene {
    let mut scene = Scene::new();
    scene.objects.0.extend(objects);
    let accelerator = accelerator.parse().expect("an accelerator");
    compile(&scene, &CompileOptions { accelerator }).expect("valid")
}

/// A point of a cloud that never repeats.
fn point(i: u32) -> DVec3 {
    let part = |factor: f64| (f64::from(i) * factor).fract();
    DVec3::new(
        part(0.754_877_666),
        part(0.569_840_291),
        part(0.437_159_709),
    )
}

fn bytes_each(stats: &SceneStats) -> f64 {
    let all = stats.accelerator_bytes + stats.geometry_bytes + stats.object_bytes;
    all as f64 / stats.primitives as f64
}

/// A bumpy sheet.
fn sheet() -> TriangleMesh {
    let side = f64::from(MANY / 2).sqrt().ceil() as u32;
    let vertices: Vec<DVec3> = (0..=side)
        .flat_map(|j| (0..=side).map(move |i| (i, j)))
        .map(|(i, j)| DVec3::new(f64::from(i), point(i * 977 + j).y * 2.0, f64::from(j)))
        .collect();
    let indices = (0..side * side)
        .flat_map(|n| {
            let a = n / side * (side + 1) + n % side;
            let b = a + side + 1;
            [[a, a + 1, b], [b, a + 1, b + 1]]
        })
        .collect();
    TriangleMesh::try_new(MeshData::from_f64(&vertices, indices)).expect("a mesh")
}

#[test]
fn a_sphere_takes_at_most_64_bytes() {
    let spheres = || (0..MANY).map(|i| Object::from(Sphere::new(point(i), 0.005)));
    let scene = compiled(spheres(), "bvh");
    let stats = scene.stats();
    assert_eq!(stats.primitives, MANY as usize);
    assert!(
        bytes_each(&stats) <= 64.0,
        "{}: {stats:?}",
        bytes_each(&stats)
    );
    let stats = compiled(spheres(), "bvh:compact").stats();
    assert!(
        bytes_each(&stats) <= 54.0,
        "{}: {stats:?}",
        bytes_each(&stats)
    );
}

#[test]
fn a_triangle_takes_at_most_70_bytes_beside_its_mesh() {
    let mesh = Arc::new(sheet());
    let object = || std::iter::once(Object::from(Arc::clone(&mesh)));
    for (accelerator, most) in [("bvh", 70.0), ("bvh:compact", 35.0)] {
        let mut stats = compiled(object(), accelerator).stats();
        assert!(stats.primitives >= MANY as usize);
        stats.geometry_bytes -= mesh.bytes();
        let each = bytes_each(&stats);
        assert!(each <= most, "{accelerator}: {each}: {stats:?}");
    }
}
