use super::{Loaded, SceneFormat, formats, load_bytes, load_path};
use flate2::{Compression, write::GzEncoder};
use std::io::Write;
use std::path::Path;
use strahl_geometry::Shape;
use strahl_math::DVec3;
use strahl_scene::ObjectKind;

const BALL: &[u8] = b"v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 90\nhither 1\nresolution 64 32\nf 1 1 1 1 0 0 0 0\ns 0 0 0 1\n";

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(vec![], Compression::default());
    encoder.write_all(bytes).expect("in memory");
    encoder.finish().expect("in memory")
}

fn only_message(loaded: &Loaded) -> String {
    assert!(loaded.scene.is_none());
    assert_eq!(loaded.diagnostics.len(), 1);
    loaded.diagnostics[0].to_string()
}

fn nff(bytes: &[u8]) -> Loaded {
    load_bytes(bytes, "a.nff", SceneFormat::Nff, None)
}

#[test]
fn every_format_is_found_by_name_and_by_extension() {
    for info in formats() {
        assert_eq!(info.name.parse(), Ok(info.format));
        assert_eq!(info.format.to_string(), info.name);
        for extension in info.extensions {
            assert_eq!(
                SceneFormat::of_extension(&extension.to_uppercase()),
                Some(info.format)
            );
            assert_eq!(extension.parse(), Ok(info.format));
        }
    }
    let error = "vrml"
        .parse::<SceneFormat>()
        .expect_err("unknown")
        .to_string();
    assert_eq!(
        error,
        "unknown scene format `vrml`; the formats are nff, obj, ply, stl, gltf"
    );
}

#[test]
fn contents_show_their_format() {
    let sniffed = |bytes: &[u8]| SceneFormat::sniff(bytes);
    assert_eq!(sniffed(b"# c\n\nv\nfrom 1 2 3"), Some(SceneFormat::Nff));
    assert_eq!(sniffed(b"b 0.1 0.2 0.3\nv\n"), Some(SceneFormat::Nff));
    assert_eq!(sniffed(b"# c\r\nv 1 2 3\r\n"), Some(SceneFormat::Obj));
    assert_eq!(sniffed(b"mtllib a.mtl\n"), Some(SceneFormat::Obj));
    assert_eq!(sniffed(b"ply\r\nformat ascii 1.0"), Some(SceneFormat::Ply));
    assert_eq!(sniffed(b"solid cube\n"), Some(SceneFormat::Stl));
    assert_eq!(sniffed(b" {\"asset\":{}}"), Some(SceneFormat::Gltf));
    assert_eq!(sniffed(b"glTF\x02\0\0\0"), Some(SceneFormat::Gltf));
    assert_eq!(sniffed(b"GIF89a"), None);
    assert_eq!(sniffed(b""), None);
}

#[test]
fn files_of_other_kinds_are_called_what_they_are() {
    let png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR";
    let gltf = b"glTF\x02\0\0\0\x0c\0\0\0";
    for (format, shown) in [
        (SceneFormat::Nff, "NFF"),
        (SceneFormat::Obj, "OBJ"),
        (SceneFormat::Ply, "PLY"),
        (SceneFormat::Stl, "STL"),
        (SceneFormat::Gltf, "glTF"),
    ] {
        let message = |bytes: &[u8]| only_message(&load_bytes(bytes, "a.x", format, None));
        let expected = format!("error: `a.x` is a PNG picture, and was read as {shown}");
        assert_eq!(message(png), expected);
        let zip = message(b"PK\x03\x04\x14\0\0\0");
        assert!(zip.starts_with("error: `a.x` is a ZIP archive, "), "{zip}");
        assert!(zip.ends_with("= help: unpack it first"), "{zip}");
        if format != SceneFormat::Gltf {
            let other = message(gltf);
            assert!(other.contains("is a binary glTF file, "), "{other}");
            assert!(other.contains("`--scene-format gltf`"), "{other}");
        }
    }
    // Its own kind is no mistake.
    let own = load_bytes(&gltf[..], "a.glb", SceneFormat::Gltf, None);
    assert!(only_message(&own).contains("JSON"));
    // Nor is a binary STL file whose header, which is free, begins like a picture.
    let mut stl = vec![0; 84 + 50];
    stl[..6].copy_from_slice(b"GIF89a");
    stl[80] = 1;
    for (place, value) in [(96 + 12, 1.0_f32), (96 + 28, 1.0)] {
        stl[place..place + 4].copy_from_slice(&value.to_le_bytes());
    }
    let read = load_bytes(stl, "a.stl", SceneFormat::Stl, None);
    assert_eq!(read.scene.expect("a mesh").objects.0.len(), 1);

    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.jpg");
    std::fs::write(&path, b"\xff\xd8\xff\xe0").expect("written");
    let unknown = only_message(&load_path(&path, None));
    assert!(
        unknown.ends_with("a.jpg` is a JPEG picture, not a scene"),
        "{unknown}"
    );
}

#[test]
fn a_byte_order_mark_is_no_part_of_a_text() {
    let folder = tempfile::tempdir().expect("a folder");
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    let stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib a.mtl\nusemtl m\nf 1 2 3\n";
    let mtl = "newmtl m\nKd 1 0 0\n";
    let ball = str::from_utf8(BALL).expect("a text");
    let files = [
        ("a.mtl", mtl),
        ("a.obj", obj),
        ("a.ply", ply),
        ("a.stl", stl),
        ("a.nff", ball),
    ];
    for (name, text) in files {
        std::fs::write(folder.path().join(name), format!("\u{feff}{text}")).expect("written");
    }
    for (name, _) in &files[1..] {
        let loaded = load_path(&folder.path().join(name), None);
        assert_eq!(loaded.diagnostics, [], "{name}");
        let scene = loaded.scene.expect("no errors");
        assert_eq!(scene.objects.0.len(), 1, "{name}");
        if let ObjectKind::Shape(Shape::TriangleMesh(mesh)) = &scene.objects.0[0].kind {
            assert_eq!(mesh.corners(0)[1], DVec3::X, "{name}");
        }
        if *name == "a.obj" {
            assert!(scene.objects.0[0].material.is_some());
        }
    }
    // Columns are counted without it.
    let wrong = load_bytes(
        "\u{feff}v 1 x 3\n".as_bytes(),
        "a.obj",
        SceneFormat::Obj,
        None,
    );
    assert_eq!(wrong.diagnostics[0].span.column, 5);
    assert_eq!(
        SceneFormat::sniff("\u{feff}v 1 2 3\n".as_bytes()),
        Some(SceneFormat::Obj)
    );
}

#[test]
fn compressed_bytes_are_recognised_by_themselves() {
    assert!(nff(BALL).scene.is_some());
    assert!(nff(&gzip(BALL)).scene.is_some());
}

#[test]
fn damaged_compressed_files_are_one_error() {
    let whole = gzip(BALL);
    let cut = only_message(&nff(&whole[..whole.len() - 20]));
    assert!(
        cut.starts_with("error: `a.nff`: the gzip data ends too early"),
        "{cut}"
    );
    let mut broken = whole.clone();
    broken[12] ^= 0xff;
    let broken = only_message(&nff(&broken));
    assert!(
        broken.starts_with("error: `a.nff`: the gzip data "),
        "{broken}"
    );
    assert!(only_message(&nff(&[0x1f, 0x8b])).contains("ends too early"));
}

#[test]
fn a_compressed_bomb_does_not_explode() {
    // 200 MiB of blanks in 200 KiB.
    let bomb = gzip(&vec![b' '; 200 << 20]);
    let message = only_message(&nff(&bomb));
    assert!(
        message.contains("compressed bytes expand to more than"),
        "{message}"
    );
}

#[test]
fn files_that_cannot_be_read_are_one_error() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let load = |p: &Path| only_message(&load_path(p, None));
    assert!(load(&path("missing.nff")).starts_with("error: there is no file `"));
    assert!(load(folder.path()).ends_with("is a folder, not a scene file"));
    std::fs::write(path("empty.nff"), "").expect("written");
    assert!(load(&path("empty.nff")).ends_with("empty.nff` is empty"));
    std::fs::write(path("empty.nff.gz"), gzip(b"")).expect("written");
    assert!(load(&path("empty.nff.gz")).ends_with("empty.nff.gz` is empty"));
    std::fs::write(path("what.xyz"), "hello").expect("written");
    let unknown = load(&path("what.xyz"));
    assert!(
        unknown.contains("unknown ending `.xyz`, and the content does not show its format"),
        "{unknown}"
    );
    assert!(unknown.contains(
        "= help: name the format with `--scene-format`; the formats are nff, obj, ply, stl, gltf"
    ));
    std::fs::write(path("noise.nff"), [0u8, 255, 3, 9, 200, 17]).expect("written");
    assert!(
        load(&path("noise.nff")).contains("noise.nff` is not an NFF scene: it is a binary file")
    );
}

#[test]
fn the_name_decides_before_the_content_and_the_caller_before_both() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["ball.nff", "ball.NFF.gz", "ball.gz", "ball", "ball.txt"] {
        let path = folder.path().join(name);
        let bytes = if name.ends_with("gz") {
            gzip(BALL)
        } else {
            BALL.to_vec()
        };
        std::fs::write(&path, bytes).expect("written");
        assert!(load_path(&path, None).scene.is_some(), "{name}");
        assert!(
            load_path(&path, Some(SceneFormat::Ply)).scene.is_none(),
            "{name}"
        );
    }
}

#[test]
fn the_seeds_of_the_fuzzers_are_scenes() {
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds");
    let mut count = 0;
    for info in formats() {
        for seed in std::fs::read_dir(seeds.join(info.name)).expect("seeds of every format") {
            let path = seed.expect("readable").path();
            let loaded = load_path(&path, None);
            assert!(
                loaded.scene.is_some(),
                "{}: {:?}",
                path.display(),
                loaded.diagnostics
            );
            count += 1;
        }
    }
    assert!(count >= 11);
}
