//! The film has the same bits whatever accelerator, threads, tile order and regions made it.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::common::{compiled, every_shape, glass_and_mirrors, patches, rendered};
use strahl_accel::AcceleratorKind;
use strahl_geometry::Primitive;
use strahl_math::{DVec3, Transform};
use strahl_render::{CompileOptions, Refinement, Region, Sampling, TileOrder, compile};
use strahl_scene::{
    Camera, CameraFace, CameraFront, CameraMesh, CameraPart, Lens, MeshCamera, MeshLayout,
    ObjectKind, Projection, Scene,
};

const SAMPLINGS: [Sampling; 5] = [
    Sampling::Center,
    Sampling::Corners,
    Sampling::Grid(2),
    Sampling::Adaptive(Refinement {
        threshold: 0.05,
        ..Refinement::DEFAULT
    }),
    Sampling::Recursive(Refinement {
        threshold: 0.05,
        ..Refinement::DEFAULT
    }),
];

/// Every accelerator, the octree with each of its traversals.
fn accelerators() -> Vec<AcceleratorKind> {
    let variants = [
        "spheres:build=agglomerative",
        "grid:density=1",
        "octree:split=centre,traversal=exit-face",
        "octree:traversal=trial-plane",
        "octree:traversal=neighbours",
    ];
    let variants = variants.iter().map(|v| v.parse().expect("an accelerator"));
    AcceleratorKind::ALL
        .iter()
        .copied()
        .chain(variants)
        .collect()
}

#[test]
fn all_accelerators_give_the_same_bits() {
    for scene in [glass_and_mirrors(), every_shape(), patches()] {
        let mut hashes = Vec::new();
        for accelerator in accelerators() {
            let scene = compile(&scene, &CompileOptions { accelerator }).expect("valid");
            for (threads, order) in [(1, TileOrder::Rows), (2, TileOrder::Reverse)] {
                let picture = rendered(&scene, |o| {
                    o.sampling = Sampling::Grid(2);
                    (o.threads, o.tile_order) = (threads, order);
                });
                hashes.push((accelerator.to_string(), picture.film.sha256(), picture.rays));
            }
        }
        assert!(hashes.len() >= 20);
        for other in &hashes[1..] {
            assert_eq!(
                (&hashes[0].1, hashes[0].2),
                (&other.1, other.2),
                "{} and {}",
                hashes[0].0,
                other.0
            );
        }
    }
}

/// Every shape, without those so far away that every ray tests them.
fn near_shapes() -> Scene {
    let mut shapes = every_shape();
    shapes
        .objects
        .0
        .retain(|o| o.name.as_deref() != Some("tiny"));
    shapes
}

#[test]
fn beams_change_nothing_but_the_work() {
    // Parallel rays before one colour, and rays from one point before a sky.
    let mut shapes = near_shapes();
    // Endless things are seen everywhere.
    shapes
        .objects
        .0
        .retain(|o| !matches!(&o.kind, ObjectKind::Shape(shape) if !shape.bounds().is_bounded()));
    for scene in [shapes, glass_and_mirrors()] {
        let scene = compiled(&scene);
        for sampling in SAMPLINGS {
            let [with, without] = [true, false].map(|beams| {
                rendered(&scene, |o| {
                    (o.width, o.height) = (150, 110);
                    (o.sampling, o.trace.beams) = (sampling, beams);
                })
            });
            assert!(with.film == without.film && with.rays == without.rays);
            let [with, without] = [with, without].map(|r| r.traversal.node_visits);
            assert!(with < without, "{with} of {without}, {sampling}");
        }
    }
}

#[test]
fn packets_change_nothing() {
    for scene in [every_shape(), glass_and_mirrors()] {
        let scene = compiled(&scene);
        for sampling in SAMPLINGS.into_iter().chain([Sampling::Grid(3)]) {
            let [with, without] = [true, false].map(|packets| {
                rendered(&scene, |o| {
                    (o.width, o.height) = (150, 111);
                    (o.sampling, o.trace.packets) = (sampling, packets);
                })
            });
            assert!(
                with.film == without.film && with.rays == without.rays,
                "{sampling}"
            );
            assert_ne!(with.traversal, without.traversal, "{sampling}");
        }
    }
}

/// Sixteen trees in one batch: a tree is cut where it would be cut alone.
#[test]
fn trees_in_packets_are_cut_as_single_ones() {
    let scene = compiled(&glass_and_mirrors());
    for limit in [2, 5, 9, 40] {
        let [with, without] = [true, false].map(|packets| {
            rendered(&scene, |o| {
                (o.width, o.height) = (90, 61);
                (o.trace.max_tree_rays, o.trace.packets) = (limit, packets);
            })
        });
        assert!(
            with.film == without.film && with.rays == without.rays,
            "{limit}"
        );
        assert!(with.rays.cut_trees > 0, "{:?}", with.rays);
    }
}

/// A camera with a ray for each pixel from each of seven meshes: copies of one, turned a little, of which the last but one has fewer faces.
fn mesh_camera(camera: &Camera, width: u32, height: u32) -> Camera {
    let pixels = width * height;
    let face = |pixel: u32| {
        let (x, y) = (pixel % width, pixel / width);
        let right = camera.right * (f64::from(x) / f64::from(width) - 0.5);
        let up = camera.up * (0.5 - f64::from(y) / f64::from(height));
        // Perpendicular to a ray from the eye.
        let way = (camera.direction + right + up).normalize();
        let side = way.cross(camera.up) * 0.001;
        let at = camera.eye + way * 0.1;
        CameraFace {
            corners: [at, at + side, at + way.cross(side)],
            front: match pixel % 7 {
                0 => CameraFront::Counterclockwise,
                _ => CameraFront::Clockwise,
            },
            normals: None,
            uv: None,
        }
    };
    let all: Arc<[CameraFace]> = (0..pixels).map(face).collect();
    let meshes = (0..7).map(|n| {
        let faces = match n {
            5 => all[..all.len() / 2].into(),
            _ => Arc::clone(&all),
        };
        let turn = Transform::rotate(DVec3::Y, f64::from(n) * 0.001);
        let move_by = Transform::translate(DVec3::X * f64::from(n) * 0.01);
        let mut mesh = CameraMesh::default();
        mesh.push(CameraPart {
            faces,
            transform: turn.then(&move_by),
        });
        mesh
    });
    let mesh = MeshCamera {
        layout: MeshLayout::Each(7),
        meshes: meshes.collect(),
        offset: 0.001,
        reversed: false,
        smooth: false,
    };
    Camera {
        projection: Projection::Mesh(Arc::new(mesh)),
        ..camera.clone()
    }
}

#[test]
fn packets_of_many_rays_for_a_pixel_change_nothing() {
    let (width, height) = (64, 48);
    let description = near_shapes();
    let sharp = description.camera.as_ref().expect("a camera");
    let mut lens = sharp.clone();
    lens.lens = Some(Lens::new(0.3, sharp.eye + sharp.direction * 4.0, 40));
    for camera in [lens, mesh_camera(sharp, width, height)] {
        let mut description = near_shapes();
        description.camera = Some(camera);
        let scene = compiled(&description);
        for sampling in SAMPLINGS {
            let [with, without] = [true, false].map(|packets| {
                rendered(&scene, |o| {
                    (o.width, o.height) = (width, height);
                    (o.sampling, o.trace.packets) = (sampling, packets);
                })
            });
            assert!(
                with.film == without.film && with.rays == without.rays,
                "{sampling}"
            );
            assert!(with.rays.primary > 6 * 64 * 48, "{:?}", with.rays);
        }
    }
}

/// What is compared is there: each kind of shape has pixels.
#[test]
fn every_shape_is_seen() {
    let scene = compiled(&every_shape());
    let picture = rendered(&scene, |o| {
        (o.width, o.height) = (480, 320);
        o.info = true;
    });
    let mut pixels: BTreeMap<&str, usize> = scene.objects().iter().map(|o| (o.kind, 0)).collect();
    for info in picture.film.info.expect("asked for") {
        if info.object > 0 {
            let kind = scene
                .objects()
                .get(info.object - 1)
                .expect("an object")
                .kind;
            pixels.entry(kind).and_modify(|n| *n += 1);
        }
    }
    assert_eq!(pixels.len(), 13, "{pixels:?}");
    assert!(pixels.values().all(|n| *n > 50), "{pixels:?}");
}

#[test]
fn threads_and_tile_orders_give_the_same_bits() {
    let scene = compiled(&glass_and_mirrors());
    for sampling in SAMPLINGS {
        let reference = rendered(&scene, |o| (o.sampling, o.info) = (sampling, true));
        for threads in [1, 2, 5] {
            for order in [TileOrder::Rows, TileOrder::Reverse, TileOrder::Center] {
                let other = rendered(&scene, |o| {
                    o.sampling = sampling;
                    o.threads = threads;
                    o.tile_order = order;
                    o.info = true;
                });
                assert_eq!(
                    other.film.sha256(),
                    reference.film.sha256(),
                    "{sampling} {threads} {order:?}"
                );
                assert_eq!(other.rays, reference.rays);
                assert_eq!(other.traversal, reference.traversal);
            }
        }
    }
}

#[test]
fn regions_are_cut_out_of_the_whole_picture() {
    let scene = compiled(&glass_and_mirrors());
    for sampling in SAMPLINGS {
        let whole = rendered(&scene, |o| o.sampling = sampling).film;
        for region in [
            Region {
                x: 0,
                y: 0,
                width: 96,
                height: 31,
            },
            Region {
                x: 37,
                y: 11,
                width: 40,
                height: 50,
            },
            Region {
                x: 95,
                y: 63,
                width: 1,
                height: 1,
            },
        ] {
            let part = rendered(&scene, |o| {
                o.sampling = sampling;
                o.region = Some(region);
            });
            for y in region.y..region.y + region.height {
                for x in region.x..region.x + region.width {
                    assert_eq!(
                        part.film.pixel(x, y),
                        whole.pixel(x, y),
                        "{sampling} {region:?} {x},{y}"
                    );
                }
            }
        }
    }
}

#[test]
fn another_seed_is_another_picture() {
    let scene = compiled(&glass_and_mirrors());
    let hash = |seed| {
        rendered(&scene, |o| {
            o.sampling = Sampling::Grid(2);
            o.seed = seed;
        })
        .film
        .sha256()
    };
    assert_ne!(hash(1), hash(2));
}
