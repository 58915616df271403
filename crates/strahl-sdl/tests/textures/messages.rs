//! The messages about unsupported features and errors.

use super::{PICTURE, scene};
use crate::common::{errors, parse_with};
use strahl_sdl::MemoryHost;

#[test]
fn what_is_not_supported_is_named() {
    for (items, word) in [
        ("pigment { facets }", "facets"),
        ("pigment { tiling 25 }", "tiling 25"),
        ("interior { media { emission 1 } ior 1.5 }", "media"),
    ] {
        let (_, messages) = scene(&format!("sphere {{ 0, 1 {items} }}"));
        assert!(
            messages
                .iter()
                .any(|m| m.contains(word) && m.contains("not supported")),
            "{items}: {messages:?}"
        );
    }
}

#[test]
fn mistakes_have_a_line_and_advice() {
    for (items, parts) in [
        ("pigment { color_map { [0 rgb 1 } }", &["`]`", "1:"][..]),
        ("pigment { gradient x color_map { } }", &["no entries"]),
        ("pigment { Redd }", &["Redd"]),
        ("pigment { chekcer }", &["chekcer", "checker"]),
        ("pigment { image_map { png \"none.png\" } }", &["none.png"]),
        ("pigment { image_map { png \"bad.png\" } }", &["bad.png"]),
        ("pigment { density_file df3 \"none.df3\" }", &["none.df3"]),
        (
            "pigment { density_file \"grid.df3\" }",
            &["`df3` and the name"],
        ),
        (
            "pigment { density_file df3 \"bad.png\" }",
            &["density file"],
        ),
        (
            "pigment { density_file df3 \"grid.df3\" interpolate 3 }",
            &["from 0 to 2"],
        ),
        ("pigment { mandel 0 }", &["whole number"]),
        ("pigment { tiling 28 }", &["from 1 to 27", "28"]),
        (
            "pigment { image_map { ppm \"p.ppm\" transmit 1, 0.5 } }",
            &["no palette", "transmit all"],
        ),
        ("finish { irid { 0.3 thicknes 2 } }", &["thicknes"]),
        (
            "pigment { brick brick_size 0 }",
            &["size in every direction"],
        ),
        ("pigment { bozo warp { repeat 0 } }", &["one axis"]),
        ("pigment { magnet 1 checker }", &["`mandel` or `julia`"]),
        ("interior { ior 0 }", &["must be positive"]),
        (
            "texture { material_map { ppm \"p.ppm\" } }",
            &["at least one texture"],
        ),
        ("pigment { object { 3 } }", &["an object"]),
        ("pigment { bozo warp { foo } }", &["foo"]),
        ("normal { bumps", &["`}`"]),
    ] {
        let text = format!("sphere {{ 0, 1\n {items} }}");
        let mut host = MemoryHost::new()
            .with_file("p.ppm", PICTURE)
            .with_file("bad.png", "no picture")
            .with_file("grid.df3", [0, 1, 0, 1, 0, 1, 200]);
        let parsed = parse_with(&mut host, &text);
        let error = parsed.diagnostics.iter().find(|d| d.is_error());
        let error = error.unwrap_or_else(|| panic!("no error in {items}"));
        let message = error.to_string();
        assert!(error.span.line >= 1, "{items}: {message}");
        for part in parts.iter().filter(|p| **p != "1:") {
            assert!(message.contains(part), "{items}: {message}");
        }
    }
    let parsed = parse_with(
        &mut MemoryHost::new(),
        "sphere { 0, 1 finish { roughness 0 } }",
    );
    let [warning] = &parsed.diagnostics[..] else {
        panic!("{:?}", parsed.diagnostics);
    };
    assert!(!warning.is_error() && warning.message.contains("a roughness of 0"));
    assert!(!errors("sphere { 0, 1 pigment { color_map { [0 rgb 1] 3 } } }").is_empty());
}
