//! The film of a scene has the same bits with every accelerator, vector instruction set, number of threads and order of tiles, with
//! packets and without, with any number of rays that go through the stages together: for every scene of the repository, and for the Standard Procedural Databases if they are there (in
//! `shared/data/spd` beside the repository, or in the folder that `STRAHL_SPD` names).
//!
//! Pictures are small; `STRAHL_FULL=256x256 cargo test --release -p strahl --test accelerators` makes them larger.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use strahl::accel::AcceleratorKind;
use strahl::sdl::{Options, Value};
use strahl::tracing::{PACKET, Prepared, RenderOptions, RenderScene, Sampling, TileOrder};
use strahl::{LoadOptions, load_path};

fn accelerators() -> Vec<AcceleratorKind> {
    let variants = [
        "bvh:build=fast",
        "bvh:build=high",
        "spheres:build=agglomerative",
        "octree:traversal=exit-face",
        "octree:traversal=trial-plane",
        "octree:traversal=neighbours",
        "bvh:compact",
        "bvh:compact,simd=scalar",
    ];
    let variants = variants.iter().map(|v| v.parse().expect("an accelerator"));
    // The instruction sets that this processor has.
    let levels = ["scalar", "sse4", "avx2", "avx512"];
    let levels = levels
        .iter()
        .filter_map(|l| format!("bvh:simd={l}").parse().ok());
    AcceleratorKind::ALL
        .iter()
        .copied()
        .chain(variants)
        .chain(levels)
        .collect()
}

/// Size of the pictures.
fn size() -> (u32, u32) {
    let Ok(text) = std::env::var("STRAHL_FULL") else {
        return (24, 18);
    };
    let (w, h) = text.split_once('x').expect("STRAHL_FULL is WIDTHxHEIGHT");
    (w.parse().expect("a width"), h.parse().expect("a height"))
}

/// Compares pictures of a scene in which different numbers of rays go through the stages together.
fn compare_batches(scene: &RenderScene, path: &Path) {
    let (width, height) = size();
    for sampling in [Sampling::Center, Sampling::ADAPTIVE] {
        let picture = |batch: Option<usize>| {
            let mut options = RenderOptions {
                threads: 1,
                sampling,
                ..RenderOptions::new(scene, width, height)
            };
            options.trace.packets = batch.is_some();
            options.trace.batch = batch.unwrap_or(PACKET);
            let done = strahl::render(scene, &options).expect("a picture");
            (done.film.sha256(), done.rays)
        };
        let alone = picture(None);
        for batch in [1, 2, 3, 7, PACKET] {
            assert_eq!(
                picture(Some(batch)),
                alone,
                "{} {sampling} {batch}",
                path.display()
            );
        }
    }
}

/// Compares all combinations for one scene.
fn compare(path: &Path) {
    // Scenes with many parts are rendered with fewer.
    let mut sdl = Options::default();
    sdl.declare = [
        ("Across", 60.0),
        ("Deep", 60.0),
        ("Generations", 2.0),
        ("Balls", 1.0),
    ]
    .map(|(name, value)| (name.to_owned(), Value::Float(value)))
    .to_vec();
    let options = LoadOptions {
        sdl,
        fonts: vec!["/usr/share/fonts".into()],
        ..LoadOptions::default()
    };
    let loaded = load_path(path, options);
    let Some(scene) = loaded.scene else {
        let said = format!("{:?}", loaded.diagnostics);
        // Without fonts there is no text.
        assert!(said.contains("the font `"), "{}: {said}", path.display());
        return;
    };
    let prepared = Prepared::new(&scene).expect("valid");
    let default = prepared.clone().build(AcceleratorKind::default());
    compare_batches(&default, path);
    let (width, height) = size();
    let mut first = None;
    for kind in accelerators() {
        let scene = prepared.clone().build(kind);
        // Only `bvh` traverses packets.
        let ways: &[bool] = match kind {
            AcceleratorKind::Bvh8(_) => &[true, false],
            _ => &[true],
        };
        for (packets, threads) in ways.iter().flat_map(|p| [(*p, 1), (*p, 2)]) {
            for order in [TileOrder::Rows, TileOrder::Center] {
                let mut options = RenderOptions {
                    threads,
                    tile_order: order,
                    ..RenderOptions::new(&scene, width, height)
                };
                options.trace.packets = packets;
                let done = strahl::render(&scene, &options).expect("a picture");
                let got = (done.film.sha256(), done.rays);
                let expected = first.get_or_insert_with(|| got.clone());
                assert_eq!(
                    &got,
                    expected,
                    "{} {kind} {packets} {threads} {order:?}",
                    path.display()
                );
            }
        }
    }
}

/// The files in a folder and its subfolders with this extension.
fn files(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let Ok(entries) = std::fs::read_dir(folder) else {
        return found;
    };
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(files(&path, endings));
        } else if endings.iter().any(|e| path.to_string_lossy().ends_with(e)) {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// [`compare`] for each scene, several at a time.
fn compare_all(scenes: &[PathBuf]) {
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(2, |n| n.get());
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(scene) = scenes.get(next.fetch_add(1, Ordering::Relaxed)) {
                    compare(scene);
                }
            });
        }
    });
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn every_scene_of_the_repository_is_the_same_picture() {
    let scenes = files(&root().join("scenes"), &[".pov", ".nff", ".gltf", ".glb"]);
    assert!(scenes.len() >= 2);
    compare_all(&scenes);
}

#[test]
fn the_procedural_databases_are_the_same_pictures() {
    let folder = std::env::var_os("STRAHL_SPD")
        .map_or_else(|| root().join("../shared/data/spd"), PathBuf::from);
    compare_all(&files(&folder, &[".nff.gz"]));
}
