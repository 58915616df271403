//! Scenes of any size, in the Neutral File Format.

use crate::nff::Scene;
use anyhow::{Context, Result, bail};
use std::f64::consts::TAU;
use strahl::math::DVec3;

/// The sky of all scenes.
const BACKGROUND: &str = "0.08 0.36 0.57";

/// Writes a scene: `sphereflake LEVELS`, `tetra LEVELS`, `crystal SIDE` or `stadium`.
pub(crate) fn generate(what: &str, size: Option<&str>) -> Result<String> {
    let size_up_to = |most: u32| -> Result<u32> {
        let size = size.with_context(|| format!("generate {what} needs a size"))?;
        let size = size.parse()?;
        if size > most {
            bail!("{what} of size {size} is too large for memory; the largest size is {most}");
        }
        Ok(size)
    };
    let levels = || size_up_to(12);
    let mut scene = Scene::default();
    match what {
        "sphereflake" => {
            scene.view(BACKGROUND, [2.1, 1.3, 1.7], [0.0, 0.0, 0.0], 45.0);
            scene.lights(&[[4.0, 3.0, 2.0], [1.0, -4.0, 4.0], [-3.0, 1.0, 5.0]]);
            scene.ground(12.0, -0.5);
            scene.fill("1 0.9 0.7 0.5 0.5 3 0 0");
            scene.flake(DVec3::ZERO, 0.5, DVec3::Z, levels()?);
        }
        "tetra" => {
            scene.view(BACKGROUND, [1.0, -4.0, 1.8], [0.0, 0.0, 0.0], 40.0);
            scene.lights(&[[2.0, -4.0, 6.0]]);
            scene.fill("1 0.2 0.2 1 0 0 0 0");
            let corners = [[1, 1, 1], [-1, -1, 1], [-1, 1, -1], [1, -1, -1]];
            let corners = corners.map(|c| DVec3::from(c.map(f64::from)));
            scene.tetra(corners, levels()?);
        }
        "crystal" => {
            let side = size_up_to(400)?;
            let extent = f64::from(side);
            scene.view(
                BACKGROUND,
                [1.9, 1.3, 1.1].map(|x| x * extent),
                [0.0, 0.0, 0.0],
                40.0,
            );
            scene.lights(&[[3.0, -1.0, 4.0].map(|x| x * extent)]);
            scene.fill("0.9 0.7 0.4 0.8 0 0 0 0");
            scene.crystal(side);
        }
        "stadium" => {
            scene.view(BACKGROUND, [0.0, -3.2, 1.4], [0.0, 0.0, 0.5], 40.0);
            scene.lights(&[[30.0, -80.0, 120.0], [-90.0, 20.0, 60.0]]);
            scene.fill("0.35 0.6 0.3 1 0 0 0 0");
            scene.ground(60.0, 0.0);
            scene.fill("0.7 0.7 0.75 1 0 0 0 0");
            scene.tiers();
            scene.fill("0.9 0.6 0.3 0.7 0.3 20 0 0");
            scene.knot();
        }
        other => {
            bail!("unknown scene `{other}`; known ones are sphereflake, tetra, crystal, stadium")
        }
    }
    Ok(scene.into_text())
}

impl Scene {
    fn ground(&mut self, half: f64, z: f64) {
        if !self.has_fill() {
            self.fill("1 0.75 0.33 0.8 0 0 0 0");
        }
        self.square(half, z);
    }

    /// A sphere that carries nine spheres of a third of its size, six around its equator and three above, and so on.
    fn flake(&mut self, center: DVec3, radius: f64, up: DVec3, levels: u32) {
        self.sphere(center, radius);
        if levels == 0 {
            return;
        }
        let side = up.any_orthonormal_vector();
        let other = up.cross(side);
        let above: [(f64, u32, f64); 2] = [(0.0, 6, 0.0), (0.955, 3, TAU / 12.0)];
        for (elevation, count, turn) in above {
            for i in 0..count {
                let angle = TAU * f64::from(i) / f64::from(count) + turn;
                let out = side * angle.cos() + other * angle.sin();
                let direction = out * elevation.cos() + up * elevation.sin();
                let place = center + direction * (radius * 4.0 / 3.0);
                self.flake(place, radius / 3.0, direction, levels - 1);
            }
        }
    }

    /// A tetrahedron of four tetrahedra of half its size, and so on; the smallest have faces.
    fn tetra(&mut self, corners: [DVec3; 4], levels: u32) {
        if levels == 0 {
            for face in [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]] {
                self.polygon(&face.map(|i| corners[i]));
            }
            return;
        }
        for corner in corners {
            self.tetra(corners.map(|c| (c + corner) * 0.5), levels - 1);
        }
    }

    /// Equal spheres at equal distances: a scene filled as evenly as possible.
    fn crystal(&mut self, side: u32) {
        let middle = (f64::from(side) - 1.0) / 2.0;
        let along = |i: u32| f64::from(i) - middle;
        for x in 0..side {
            for y in 0..side {
                for z in 0..side {
                    self.sphere(DVec3::new(along(x), along(y), along(z)), 0.35);
                }
            }
        }
    }

    /// Rows of seats all around the small object in the middle.
    fn tiers(&mut self) {
        const SECTORS: u32 = 72;
        for row in 0..24 {
            let (r, z) = (60.0 + 1.5 * f64::from(row), 0.8 * f64::from(row));
            for sector in 0..SECTORS {
                let at = |sector: u32, r: f64, z: f64| {
                    let angle = TAU * f64::from(sector) / f64::from(SECTORS);
                    DVec3::new(r * angle.cos(), 0.8 * r * angle.sin(), z)
                };
                let (a, b) = (sector, sector + 1);
                self.polygon(&[
                    at(a, r, z),
                    at(a, r, z + 0.8),
                    at(b, r, z + 0.8),
                    at(b, r, z),
                ]);
                let (near, far, top) = (r, r + 1.5, z + 0.8);
                self.polygon(&[
                    at(a, near, top),
                    at(a, far, top),
                    at(b, far, top),
                    at(b, near, top),
                ]);
            }
        }
    }

    /// A small knotted tube of 16,384 triangles in the middle: the teapot in the stadium.
    fn knot(&mut self) {
        const AROUND: u32 = 512;
        const ACROSS: u32 = 16;
        let path = |u: f64| {
            let r = 0.3 + 0.12 * (3.0 * u).cos();
            DVec3::new(
                r * (2.0 * u).cos(),
                r * (2.0 * u).sin(),
                0.5 + 0.15 * (3.0 * u).sin(),
            )
        };
        let point = |i: u32, j: u32| {
            let (u, v) = (
                TAU * f64::from(i % AROUND) / f64::from(AROUND),
                TAU * f64::from(j % ACROSS) / f64::from(ACROSS),
            );
            let along = (path(u + 1e-4) - path(u - 1e-4)).normalize();
            let side = along.cross(DVec3::Z).normalize();
            path(u) + (side * v.cos() + side.cross(along) * v.sin()) * 0.06
        };
        for i in 0..AROUND {
            for j in 0..ACROSS {
                let [a, b, c, d] = [
                    point(i, j),
                    point(i + 1, j),
                    point(i + 1, j + 1),
                    point(i, j + 1),
                ];
                self.polygon(&[a, b, c]);
                self.polygon(&[a, c, d]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::generate;

    #[test]
    fn scenes_have_the_sizes_of_the_series() {
        let count = |what, levels, word: &str| {
            let scene = generate(what, levels).expect("a scene");
            scene.lines().filter(|l| l.starts_with(word)).count()
        };
        assert_eq!(count("sphereflake", Some("3"), "s "), 820);
        assert_eq!(count("sphereflake", Some("4"), "s "), 7381);
        assert_eq!(count("tetra", Some("5"), "p "), 4096);
        assert!(count("stadium", None, "p ") > 16_384);
        assert!(generate("sphereflake", None).is_err() && generate("cube", None).is_err());
    }
}
