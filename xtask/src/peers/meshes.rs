//! The test meshes, generated here and the same on every machine.

use anyhow::{Context, Result};
use std::collections::HashMap;
use std::path::Path;
use strahl::geometry::{MeshData, Primitive, Shape, TriangleMesh};
use strahl::math::DVec3;
use strahl::prelude::Scene;
use strahl::scene::ObjectKind;
use strahl::{LoadOptions, load_path};

/// A mesh with shared vertices, and a view of it.
pub(super) struct Mesh {
    pub(super) name: String,
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) indices: Vec<[u32; 3]>,
    pub(super) view: View,
}

impl Mesh {
    /// The scene with this mesh.
    pub(super) fn scene(&self) -> Result<Scene> {
        let data = MeshData {
            positions: self.positions.clone(),
            indices: self.indices.clone(),
            ..MeshData::default()
        };
        Ok(Scene::new().add(TriangleMesh::try_new(data)?))
    }
}

/// The viewpoint and the light of a scene.
#[derive(Clone, Copy)]
pub(super) struct View {
    /// The position of the eye.
    pub(super) eye: DVec3,
    /// The point the eye looks at.
    pub(super) target: DVec3,
    /// The position of the light.
    pub(super) light: DVec3,
}

/// The view of sphereflakes.
pub(super) const FLAKE_VIEW: View = View {
    eye: DVec3::new(2.1, 1.3, 1.7),
    target: DVec3::new(0.0, 0.0, 0.1),
    light: DVec3::new(4.0, 3.0, 2.0),
};

/// The first mesh of a file, seen from the front and lit from above, which suits most scans.
pub(super) fn from_file(path: &str) -> Result<Mesh> {
    let loaded = load_path(Path::new(path), LoadOptions::default());
    let scene = loaded
        .scene
        .with_context(|| format!("{path}: {:?}", loaded.diagnostics))?;
    let mesh = scene
        .objects
        .0
        .iter()
        .find_map(|object| match &object.kind {
            ObjectKind::Shape(Shape::TriangleMesh(mesh)) => Some(mesh),
            _ => None,
        });
    let mesh = mesh.with_context(|| format!("{path} has no mesh"))?;
    let bounds = mesh.bounds();
    let (center, size) = (bounds.center(), bounds.size().length());
    let name = Path::new(path).file_stem().unwrap_or_default();
    Ok(Mesh {
        name: name.to_string_lossy().into_owned(),
        positions: mesh.positions().to_vec(),
        indices: mesh.indices().to_vec(),
        view: View {
            eye: center + DVec3::new(0.2, 0.25, 1.0) * size,
            target: center,
            light: center + DVec3::new(-1.0, 2.0, 1.5) * size,
        },
    })
}

/// SplitMix64.
pub(super) struct Rng(pub(super) u64);

impl Rng {
    /// A number in `0..1`.
    pub(super) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number in `-1..1`.
    fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }
}

/// The sphereflake of the SPD: each sphere carries nine smaller ones. Centres and radii.
pub(super) fn sphereflake(levels: u32) -> Vec<(DVec3, f64)> {
    let mut all = vec![];
    let mut waiting = vec![(DVec3::ZERO, 0.5, DVec3::Z, levels)];
    while let Some((center, radius, up, level)) = waiting.pop() {
        all.push((center, radius));
        if level == 0 {
            continue;
        }
        let x = up.any_orthonormal_vector();
        let y = up.cross(x);
        for i in 0..9 {
            // Six around the equator, three further up.
            let (angle, height): (f64, f64) = if i < 6 {
                (f64::from(i) * 60.0, 0.0)
            } else {
                (f64::from(i - 6) * 120.0 + 30.0, 0.816_496_580_927_726)
            };
            let (sin, cos) = angle.to_radians().sin_cos();
            let ring = (1.0 - height * height).sqrt();
            let out = (x * cos + y * sin) * ring + up * height;
            let small = radius / 3.0;
            waiting.push((center + out * (radius + small), small, out, level - 1));
        }
    }
    all
}

/// Tessellated spheres, each an octahedron divided `divisions` times.
pub(super) fn tessellated_flake(name: &'static str, levels: u32, divisions: u32) -> Mesh {
    let (unit_points, unit_faces) = sphere(divisions);
    let (mut positions, mut indices) = (vec![], vec![]);
    for (center, radius) in sphereflake(levels) {
        let first = positions.len() as u32;
        positions.extend(
            unit_points
                .iter()
                .map(|p| (center + *p * radius).as_vec3().to_array()),
        );
        indices.extend(unit_faces.iter().map(|f| f.map(|i| i + first)));
    }
    Mesh {
        name: name.to_owned(),
        positions,
        indices,
        view: FLAKE_VIEW,
    }
}

fn sphere(divisions: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut points = vec![
        DVec3::X,
        DVec3::NEG_X,
        DVec3::Y,
        DVec3::NEG_Y,
        DVec3::Z,
        DVec3::NEG_Z,
    ];
    let mut faces = vec![];
    for [x, y, z] in [
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ] {
        faces.push([x, y, z]);
    }
    for _ in 0..divisions {
        let mut middles = HashMap::new();
        let mut finer = vec![];
        for [a, b, c] in faces {
            let mut middle = |i: u32, j: u32| {
                *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    points.push((points[i as usize] + points[j as usize]).normalize());
                    points.len() as u32 - 1
                })
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        faces = finer;
    }
    (points, faces)
}

/// A fractal terrain of `2 n²` triangles by midpoint displacement, n a power of two.
pub(super) fn terrain(name: &'static str, n: usize) -> Mesh {
    let side = n + 1;
    let mut height = vec![0.0f64; side * side];
    let mut rng = Rng(11);
    let (mut step, mut rough) = (n, 0.25);
    while step > 1 {
        let half = step / 2;
        // Middles of squares, then of edges.
        for y in (half..side).step_by(step) {
            for x in (half..side).step_by(step) {
                let at = |dx: usize, dy: usize| height[(y + dy - half) * side + x + dx - half];
                let mean = (at(0, 0) + at(step, 0) + at(0, step) + at(step, step)) / 4.0;
                height[y * side + x] = mean + rng.signed() * rough;
            }
        }
        for y in (0..side).step_by(half) {
            for x in ((y + half) % step..side).step_by(step) {
                let (mut sum, mut count) = (0.0, 0.0);
                for (dx, dy) in [(-1isize, 0isize), (1, 0), (0, -1), (0, 1)] {
                    let (px, py) = (
                        x as isize + dx * half as isize,
                        y as isize + dy * half as isize,
                    );
                    if (0..side as isize).contains(&px) && (0..side as isize).contains(&py) {
                        sum += height[py as usize * side + px as usize];
                        count += 1.0;
                    }
                }
                height[y * side + x] = sum / count + rng.signed() * rough;
            }
        }
        step = half;
        rough *= 0.5;
    }
    let coordinate = |i: usize| 2.0 * i as f64 / n as f64 - 1.0;
    let positions = (0..side * side)
        .map(|i| {
            [
                coordinate(i % side) as f32,
                height[i] as f32,
                coordinate(i / side) as f32,
            ]
        })
        .collect();
    let indices = (0..n * n)
        .flat_map(|i| {
            let corner = (i / n * side + i % n) as u32;
            let below = corner + side as u32;
            [[corner, below, corner + 1], [corner + 1, below, below + 1]]
        })
        .collect();
    Mesh {
        name: name.to_owned(),
        positions,
        indices,
        view: View {
            eye: DVec3::new(0.2, 0.9, 1.6),
            target: DVec3::ZERO,
            light: DVec3::new(3.0, 2.5, 0.5),
        },
    }
}

/// Long thin triangles in all directions.
pub(super) fn soup(name: &'static str, count: u32) -> Mesh {
    let mut rng = Rng(12);
    let (mut positions, mut indices) = (vec![], vec![]);
    for i in 0..count {
        let middle = rng.point();
        let along = rng.point() * 0.2;
        let aside = rng.point() * 0.004;
        for p in [middle - along, middle + along, middle + aside] {
            positions.push(p.as_vec3().to_array());
        }
        indices.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    Mesh {
        name: name.to_owned(),
        positions,
        indices,
        view: View {
            eye: DVec3::new(2.0, 1.5, 2.5),
            target: DVec3::ZERO,
            light: DVec3::new(3.0, 4.0, -1.0),
        },
    }
}
