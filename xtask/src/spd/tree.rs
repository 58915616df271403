//! A tree whose branches divide in two, after Aono and Kunii.

use crate::nff::Scene;
use strahl::math::DVec3;

/// Length and radius of the trunk, which begins at the origin.
const TRUNK: (f64, f64) = (0.5, 0.09);

/// How much thinner a branch is at its end.
const TAPER: f64 = 0.9;

/// How far the second direction of a branch is turned around it from that of its parent, in degrees.
const DIVERGENCE: f64 = 130.0;

/// The two children of a branch: the angle to its direction in degrees, and length and radius compared with those at its end.
const CHILDREN: [(f64, f64, f64); 2] = [(16.0, 0.87, 0.87), (-38.0, 0.8, 0.7)];

/// The radius of the sphere at the end of a twig, unless the twig is thicker.
const BUD: f64 = 0.014;

/// A tree that divides `size` times: 2^(n+1) - 1 cones and as many spheres, one ground square, seven lights.
pub(super) fn scene(size: u32) -> String {
    let mut scene = Scene::default();
    scene.view("0.45 0.62 0.85", [0.3, -4.5, 1.0], [0.03, 0.0, 1.3], 42.0);
    scene.lights(&[
        [4.0, -5.0, 7.0],
        [-5.0, -4.0, 6.0],
        [0.0, -7.0, 3.0],
        [6.0, 2.0, 8.0],
        [-6.0, 3.0, 9.0],
        [0.0, 0.0, 10.0],
        [3.0, -7.0, 9.0],
    ]);
    scene.fill("0.16 0.3 0.08 0.9 0 0 0 0");
    scene.square(30.0, 0.0);
    scene.fill("0.28 0.13 0.05 0.9 0 0 0 0");
    let (length, radius) = TRUNK;
    let trunk = Branch {
        base: DVec3::ZERO,
        along: DVec3::Z,
        side: DVec3::X,
        length,
        radius,
    };
    let mut buds = vec![];
    trunk.write(size, &mut scene, &mut buds);
    scene.fill("0.2 0.5 0.05 0.9 0 0 0 0");
    for (place, radius) in buds {
        scene.sphere(place, radius);
    }
    scene.into_text()
}

/// A branch with all that grows from it.
struct Branch {
    base: DVec3,
    /// Its direction.
    along: DVec3,
    /// The direction to which its first child bends, perpendicular to its own.
    side: DVec3,
    length: f64,
    /// Its radius at the base.
    radius: f64,
}

impl Branch {
    /// Writes the branch and its children; collects the last spheres, which have another material.
    fn write(&self, size: u32, scene: &mut Scene, buds: &mut Vec<(DVec3, f64)>) {
        let end = self.base + self.along * self.length;
        let end_radius = self.radius * TAPER;
        scene.cone((self.base, self.radius), (end, end_radius));
        if size == 0 {
            buds.push((end, end_radius.max(BUD)));
            return;
        }
        // The sphere covers the ends of the three cones that meet in its centre.
        scene.sphere(end, end_radius);
        for (angle, length, radius) in CHILDREN {
            let (sin, cos) = angle.to_radians().sin_cos();
            let along = (self.along * cos + self.side * sin).normalize();
            let bent = self.side * cos - self.along * sin;
            let (sin, cos) = DIVERGENCE.to_radians().sin_cos();
            let side = bent * cos + along.cross(bent) * sin;
            let child = Self {
                base: end,
                along,
                // What rounding has added along the branch is removed.
                side: (side - along * along.dot(side)).normalize(),
                length: self.length * length,
                radius: end_radius * radius,
            };
            child.write(size - 1, scene, buds);
        }
    }
}
