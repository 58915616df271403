//! A pyramid of objects with six pentagonal rings each.

use crate::nff::Scene;
use std::f64::consts::{GOLDEN_RATIO, TAU};
use strahl::math::DVec3;

/// The length of the pyramid's base.
const SIDE: f64 = 8.0;

/// Radii for objects at a distance of one. The rings of an object pass each other at 0.0653, and their spheres pass other rings at 0.0840 (see
/// the test), so that nothing touches; nor do neighbours, whose spheres reach 0.488.
pub(super) const RING: f64 = 0.44;
pub(super) const SPHERE: f64 = 0.048;
pub(super) const CYLINDER: f64 = 0.03;

/// A pyramid of `size` layers, with `k` times `k` objects in layer `k`: 5 n (n+1) (2n+1) spheres and as many cylinders, one ground
/// polygon, three lights.
pub(super) fn scene(size: u32) -> String {
    let mut scene = Scene::default();
    scene.view("0.05 0.05 0.1", [5.1, -8.6, 10.2], [0.1, -0.1, 1.05], 43.0);
    scene.lights(&[[8.0, -3.0, 14.0], [-9.0, -6.0, 11.0], [1.0, -12.0, 6.0]]);
    scene.fill("0.16 0.22 0.3 0.9 0 0 0 0");
    // It fills the picture. A larger one would make grids slow, as one that holds everything has few cells in the pyramid.
    scene.square(20.0, 0.0);
    let distance = SIDE / f64::from(size);
    let places = places(size, distance);
    let rings = six_rings().map(|ring| ring.map(|corner| corner * (RING * distance)));
    scene.fill("1 0.5 0.06 0.6 0.4 30 0 0");
    for place in &places {
        for corner in rings.iter().flatten() {
            scene.sphere(*place + *corner, SPHERE * distance);
        }
    }
    scene.fill("0.75 0.1 0.08 0.6 0.4 30 0 0");
    for place in &places {
        for ring in &rings {
            for (i, corner) in ring.iter().enumerate() {
                let next = ring[(i + 1) % ring.len()];
                let end = |corner: DVec3| (*place + corner, CYLINDER * distance);
                scene.cone(end(*corner), end(next));
            }
        }
    }
    scene.into_text()
}

/// The centres of the objects. Each lies over the middle of four of the layer below, at equal distances from all of them.
fn places(size: u32, distance: f64) -> Vec<DVec3> {
    let mut places = vec![];
    for layer in (1..=size).rev() {
        let along = |i: u32| (f64::from(i) - f64::from(layer - 1) / 2.0) * distance;
        let z = (0.5 + f64::from(size - layer) * 0.5_f64.sqrt()) * distance;
        for x in 0..layer {
            for y in 0..layer {
                places.push(DVec3::new(along(x), along(y), z));
            }
        }
    }
    places
}

/// Six linked pentagons around the six axes through opposite faces of a dodecahedron. Their 30 corners are the directions to the
/// middles of its 30 edges.
///
/// The middles of ten edges lie on the great circle around an axis, and each middle lies on two of these circles. A pentagon takes every
/// other one of its circle. With (0, ±1, φ) as axes, ±x is the first corner: half a turn around z maps one to the other. A
/// cyclic exchange of the coordinates gives the other four rings, and the turns of the dodecahedron take every middle once.
pub(super) fn six_rings() -> [[DVec3; 5]; 6] {
    std::array::from_fn(|ring| {
        let sign = if ring % 2 == 0 { 1.0 } else { -1.0 };
        let exchanged = |p: DVec3| match ring / 2 {
            0 => p,
            1 => DVec3::new(p.z, p.x, p.y),
            _ => DVec3::new(p.y, p.z, p.x),
        };
        let axis = exchanged(DVec3::new(0.0, sign, GOLDEN_RATIO)).normalize();
        let first = exchanged(DVec3::X * sign);
        let side = axis.cross(first);
        std::array::from_fn(|i| {
            let angle = TAU * i as f64 / 5.0;
            first * angle.cos() + side * angle.sin()
        })
    })
}
