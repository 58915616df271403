//! A cube of spheres at equal distances, joined by cylinders.

use crate::nff::Scene;
use strahl::math::DVec3;

/// The length of the cube's edges; a corner is the origin.
const SIDE: f64 = 12.0;

/// Radii for cells of length one.
const SPHERE: f64 = 0.16;
const CYLINDER: f64 = 0.05;

/// A cube of `size` cells along an edge: (n+1)³ spheres and 3 n (n+1)² cylinders, three lights. All reflect; the ends of the
/// cylinders lie inside of the spheres.
pub(super) fn scene(size: u32) -> String {
    let mut scene = Scene::default();
    scene.view("0.08 0.12 0.2", [16.5, -6.0, 15.5], [6.7, 5.3, 5.1], 51.0);
    scene.lights(&[
        [40.0, -30.0, 60.0],
        [-20.0, -40.0, 30.0],
        [60.0, 10.0, 10.0],
    ]);
    let cell = SIDE / f64::from(size);
    let place = |[x, y, z]: [u32; 3]| DVec3::new(f64::from(x), f64::from(y), f64::from(z)) * cell;
    scene.fill("1 0.45 0.05 0.6 0.4 40 0 0");
    for node in nodes(size) {
        scene.sphere(place(node), SPHERE * cell);
    }
    scene.fill("0.1 0.3 0.6 0.6 0.4 30 0 0");
    for node in nodes(size) {
        for axis in 0..3 {
            let mut next = node;
            next[axis] += 1;
            if next[axis] <= size {
                let end = |node| (place(node), CYLINDER * cell);
                scene.cone(end(node), end(next));
            }
        }
    }
    scene.into_text()
}

/// The places of the spheres, counted along the edges.
fn nodes(size: u32) -> impl Iterator<Item = [u32; 3]> {
    let side = size + 1;
    (0..side * side * side).map(move |i| [i / (side * side), i / side % side, i % side])
}
