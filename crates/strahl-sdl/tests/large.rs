//! Files too large for memory are read in parts, without a visible difference.

use std::fs;
use std::io::Write;
use strahl_sdl::{FolderHost, Options, Source, parse};

/// 18 MB, mostly comments, with objects at both ends.
fn write_scene(path: &std::path::Path) {
    let mut file = std::io::BufWriter::new(fs::File::create(path).expect("a file"));
    let mut line = |text: &str| writeln!(file, "{text}").expect("written");
    line("#declare Radius = 2;");
    line("#macro Ball(X) sphere { <X, 0, 0>, Radius } #end");
    line("sphere { 0, 0 }");
    for _ in 0..300_000 {
        line("// nothing but a comment that makes the file a large one");
    }
    line("Ball(7)");
    line("#include \"same.pov\"");
    line("box { 0, Sise }");
}

#[test]
fn a_large_scene_is_read_while_it_is_parsed() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.pov");
    write_scene(&path);
    fs::write(folder.path().join("same.pov"), "cone { 0, 1, 1, 0 }").expect("written");
    let source = Source::large(&path).expect("opened").expect("large");
    let length = fs::metadata(&path).expect("there").len();
    assert_eq!(source.length() as u64, length);
    let name = path.display().to_string();
    let whole = Source::new(name, fs::read(&path).expect("read"));
    let said = [source, whole].map(|source| {
        let mut host = FolderHost::new([]);
        let parsed = parse(source, &Options::default(), &mut host);
        assert!(parsed.scene.is_none());
        format!("{:?}", parsed.diagnostics)
    });
    assert!(said[0].contains("box { 0, Sise }"), "{}", said[0]);
    assert!(said[0].contains("sphere { 0, 0 }"), "{}", said[0]);
    assert_eq!(said[0], said[1]);
}
