//! Any scene and any rays: every structure, every level of vector instructions and every packet finds the same hits. A third of
//! the scenes are also rendered, for rays that start on objects.

#![no_main]

use libfuzzer_sys::fuzz_target;
use strahl::accel::AcceleratorKind;
use strahl::math::{Interval, Ray};
use strahl::prelude::*;
use strahl::tracing::{Hit, PACKET, Prepared, RayClass, Intersector};

/// Makes choices from the input bytes; zeros when they are used up.
struct Choices<'d>(&'d [u8]);

impl Choices<'_> {
    fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.0.split_first() else {
            return 0;
        };
        self.0 = rest;
        *first
    }

    fn below(&mut self, n: u8) -> usize {
        usize::from(self.byte() % n)
    }

    /// A point on a coarse lattice, where ties are frequent, or anywhere near it.
    fn number(&mut self) -> f64 {
        let b = self.byte();
        let coarse = f64::from(b >> 2) / 8.0 - 4.0;
        match b & 3 {
            3 => coarse + (f64::from(self.byte()) - 127.0) * 1e-9,
            2 => coarse + f64::from(self.byte()) / 1024.0,
            _ => coarse,
        }
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.number(), self.number(), self.number())
    }

    fn solid(&mut self) -> Object {
        let (a, b) = (self.point(), self.point());
        let size = self.number().abs() + 1.0 / 64.0;
        match self.below(5) {
            0 => Cuboid::new(a.min(b), a.max(b) + DVec3::splat(size)).into(),
            1 => Cylinder::new(a, b + DVec3::Y * 0.01, size).into(),
            2 => Cone::new(a, size, b + DVec3::X * 0.01, 0.0).into(),
            3 => Torus::new(DVec3::ZERO, DVec3::Y, size + 0.5, 0.25).into(),
            _ => Sphere::new(a, size).into(),
        }
    }

    /// A patch, perhaps collapsed.
    fn patch(&mut self) -> Object {
        let points = std::array::from_fn(|_| std::array::from_fn(|_| self.point()));
        let weights = std::array::from_fn(|_| {
            std::array::from_fn(|_| [1.0, 1.0, 0.5, 3.0][self.below(4)])
        });
        match BicubicPatch::try_rational(points, weights) {
            Ok(patch) => patch.into(),
            Err(_) => self.solid(),
        }
    }

    fn material(&mut self) -> Material {
        match self.below(4) {
            0 => Material::glass(1.5),
            1 => Material::mirror(Color::gray(0.8)),
            _ => Material::matte(Color::WHITE),
        }
    }

    fn sphere(&mut self) -> Object {
        Sphere::new(self.point(), self.number()).into()
    }

    fn mesh(&mut self) -> Object {
        let data = strahl::geometry::MeshData {
            positions: (0..6).map(|_| self.point().as_vec3().to_array()).collect(),
            indices: (0..5)
                .map(|i| [i % 6, (i + 1) % 6, (i * 2 + 2) % 6])
                .collect(),
            ..Default::default()
        };
        match TriangleMesh::try_new(data) {
            Ok(mesh) => mesh.into(),
            Err(_) => self.solid(),
        }
    }

    fn object(&mut self) -> Object {
        match self.below(9) {
            0 => Triangle::new(self.point(), self.point(), self.point()).into(),
            1 => self.mesh(),
            2 => self.patch(),
            3 => Plane::new(self.point(), DVec3::Y).into(),
            4 => {
                let op = [CsgOp::Union, CsgOp::Difference, CsgOp::Intersection][self.below(3)];
                let count = 2 + self.below(3);
                Object::csg(op, (0..count).map(|_| self.solid()).collect())
            }
            5 => self.solid(),
            _ => self.sphere(),
        }
    }

    /// Objects of all kinds, or of one kind and material, for which there are specialised searches.
    fn scene(&mut self, scale: f64) -> Scene {
        let scaled = Transform::try_scale(DVec3::splat(scale)).expect("a scale that is not 0");
        let (kind, common) = (self.below(6), self.material());
        let mut scene = Scene::new();
        for _ in 0..=self.below(24) {
            let (object, material) = match kind {
                0 => (self.sphere(), common.clone()),
                1 => (self.mesh(), common.clone()),
                _ => (self.object(), self.material()),
            };
            scene = scene.add(object.material(material).transformed(&scaled));
        }
        scene
    }
}

/// The structures, with the methods to traverse them.
fn kinds() -> Vec<AcceleratorKind> {
    let more = [
        "octree:traversal=neighbours",
        "bvh:build=fast",
        "bvh:build=high",
        "bvh:simd=scalar",
        "bvh:simd=sse4",
        "bvh:simd=avx2",
    ];
    let more = more.iter().filter_map(|k| k.parse().ok());
    AcceleratorKind::ALL.iter().copied().chain(more).collect()
}

fuzz_target!(|data: &[u8]| {
    let mut choices = Choices(data);
    let scale = [1.0, 1e-3, 1e5][choices.below(3)];
    let mut scene = choices.scene(scale);
    let eye = choices.point() * scale * 2.0;
    let rendered = choices.below(3) == 0;
    if rendered {
        let place = if eye == DVec3::ZERO {
            DVec3::new(5.0, 4.0, 3.0) * scale
        } else {
            eye
        };
        scene = scene
            .camera(Camera::perspective(
                place,
                DVec3::ZERO,
                DVec3::new(0.3, 1.0, 0.2),
                0.9,
            ))
            .light(Light::point(
                choices.point() * scale * 3.0,
                Color::gray(0.7),
            ))
            .light(Light::directional(
                DVec3::new(-0.6, -1.0, 0.3),
                Color::gray(0.5),
            ));
    }
    // A scene with an invalid shape is skipped.
    let Ok(prepared) = Prepared::new(&scene) else {
        return;
    };
    let from_eye = choices.below(2) == 0;
    let mut rays = Vec::new();
    while rays.len() < PACKET {
        let origin = if from_eye {
            eye
        } else {
            choices.point() * scale
        };
        let direction = choices.point() * scale - origin;
        if direction != DVec3::ZERO {
            rays.push(Ray::new(origin, direction));
        } else if choices.0.is_empty() {
            break;
        }
    }
    let range = [Interval::FORWARD, Interval::UNTIL_LIGHT][choices.below(2)];
    type Answers = (Vec<Option<Hit>>, Vec<bool>);
    let mut first: Option<Answers> = None;
    let mut film: Option<(Film, u64)> = None;
    for kind in kinds() {
        let scene = prepared.clone().build(kind);
        let mut tracer = Intersector::new(&scene);
        let class = RayClass::Camera;
        let closest = rays
            .iter()
            .map(|r| tracer.closest_hit(r, range, None, class));
        let closest: Vec<_> = closest.collect();
        let any: Vec<_> = rays
            .iter()
            .map(|r| tracer.any_opaque(r, range, None))
            .collect();
        let mut together = [None; PACKET];
        let nowhere = [None; PACKET];
        tracer.closest_hits(&rays, range, &nowhere, class, &mut together);
        assert_eq!(together[..rays.len()], closest, "{kind}: packets");
        let bits = tracer.any_opaques(&rays, range, &nowhere);
        let told = any
            .iter()
            .enumerate()
            .fold(0, |b, (i, a)| b | u32::from(*a) << i);
        assert_eq!(bits, told, "{kind}: packets, any");
        let answers = (closest, any);
        let expected = first.get_or_insert_with(|| answers.clone());
        assert_eq!(&answers, expected, "{kind}");
        if rendered {
            let mut options = RenderOptions::new(&scene, 8, 8);
            (options.threads, options.trace.max_depth) = (1, 5);
            let picture = strahl::render(&scene, &options).expect("a small picture");
            let found = (picture.film, picture.rays.total());
            let expected = film.get_or_insert_with(|| found.clone());
            assert!(&found == expected, "{kind}: another picture");
        }
    }
});
