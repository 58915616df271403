//! Accepted and rejected texts: each case was tried in POV-Ray 3.7. Where strahl is more lenient (extra separators, several names
//! in a union), a comment says so.

use crate::common::{debug, errors, parse_with};
use strahl_scene::{CsgOp, Object, ObjectKind, Scene};
use strahl_sdl::{MemoryHost, Stream};

const NAMES: &str = "
    #version 3.7; global_settings { assumed_gamma 1 }
    #declare S = sphere { 0, 1 pigment { rgb x } }
    #declare B = box { -1, 1 }
    #declare P = plane { x, 0 }
    #declare L = light_source { <-5, 0, -5> rgb 1 }
    #declare A = array[2] { S, B }
    #macro M() S #end
";

fn scene(text: &str) -> Scene {
    let parsed = parse_with(&mut MemoryHost::new(), &format!("{NAMES}{text}"));
    let messages: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
    let scene = parsed
        .scene
        .unwrap_or_else(|| panic!("{text}\n{messages:?}"));
    assert!(messages.is_empty(), "{text}\n{messages:?}");
    scene
}

/// The forms of the objects: `sphere`, `union(sphere, box)`.
fn forms(objects: &[Object]) -> String {
    let form = |object: &Object| match &object.kind {
        ObjectKind::Csg { op, children } => format!("{}({})", op.name(), forms(&children.0)),
        ObjectKind::Light(_) => "light".to_owned(),
        ObjectKind::Instance(_) => "instance".to_owned(),
        ObjectKind::Shape(shape) => {
            let text = format!("{shape:?}");
            let end = text
                .find(|c: char| !c.is_alphanumeric())
                .unwrap_or(text.len());
            text[..end].to_lowercase()
        }
    };
    objects.iter().map(form).collect::<Vec<_>>().join(", ")
}

fn read(text: &str) -> String {
    forms(&scene(text).objects.0)
}

#[test]
fn declared_objects_are_taken_without_object() {
    let cases = [
        ("S", "sphere"),
        ("S S", "sphere, sphere"),
        ("S;", "sphere"),
        ("M()", "sphere"),
        ("M(); B", "sphere, cuboid"),
        ("A[1]", "cuboid"),
        ("L", "light"),
        ("#declare T = S; T", "sphere"),
        ("#if (1) S #else B #end", "sphere"),
        ("union { sphere { 0, 1 } S }", "union(sphere, sphere)"),
        (
            "difference { sphere { 0, 1 } B }",
            "difference(sphere, cuboid)",
        ),
        (
            "intersection { B A[0] M() }",
            "intersection(cuboid, sphere, sphere)",
        ),
        ("union { S B translate x }", "union(sphere, cuboid)"),
        ("merge { S, B }", "merge(sphere, cuboid)"),
        ("union { S translate x }", "sphere"),
        ("difference { S }", "sphere"),
        ("sphere { S translate x }", "sphere"),
        ("box { M() translate x }", "sphere"),
        ("torus { #if (1) S #end }", "sphere"),
        ("cone { A[0] }", "sphere"),
        ("light_source { S }", "sphere"),
        ("object { #if (0) S #else B #end }", "cuboid"),
        (
            "sphere { 0, 1 clipped_by { P } }",
            "clipped-by(sphere, plane)",
        ),
        (
            "sphere { 0, 1 clipped_by { B P } }",
            "clipped-by(sphere, cuboid, plane)",
        ),
        (
            "sphere { 0, 1 bounded_by { B } clipped_by { bounded_by } }",
            "clipped-by(sphere, cuboid)",
        ),
        ("light_group { L S }", "light group(light, sphere)"),
        (
            "light_group { S light_source { 0, 1 } B }",
            "light group(sphere, light, cuboid)",
        ),
        ("light_source { 0, 1 looks_like { S } }", ""),
    ];
    for (text, expected) in cases {
        if text.starts_with("light_source { 0") {
            assert_eq!(scene(text).objects.0.len(), 1);
            continue;
        }
        assert_eq!(read(text), expected, "{text}");
    }
}

#[test]
fn a_name_that_stands_by_itself_cannot_be_changed() {
    for text in ["S translate x", "S { translate x }", "S pigment { rgb 1 }"] {
        let found = errors(&format!("{NAMES}{text}"));
        assert!(found[0].contains("write `object { S ... }`"), "{found:?}");
    }
    // An atmosphere is a statement.
    let parsed = parse_with(&mut MemoryHost::new(), &format!("{NAMES} S media {{ }}"));
    assert!(parsed.scene.is_some());
    for text in ["Cam", "F", "T"] {
        let declared = "#declare Cam = camera { } #declare F = 3; #declare T = texture { }";
        let found = errors(&format!("{declared} {text}"));
        assert!(
            found[0].contains("expected an object or a directive"),
            "{found:?}"
        );
    }
}

#[test]
fn what_stands_behind_clipping_objects_moves_them_all() {
    let scene = scene("sphere { 0, 1 clipped_by { B P rotate 30 * y translate x } }");
    let ObjectKind::Csg {
        op: CsgOp::Clip,
        children,
    } = &scene.objects.0[0].kind
    else {
        panic!("clipped");
    };
    let maps: Vec<_> = children.0.iter().map(|c| c.transform.is_some()).collect();
    assert_eq!(maps, [false, true, true]);
}

#[test]
fn macros_whose_value_ends_with_a_semicolon() {
    let setup = "
        #macro T() sphere { 0, 1 } #end
        #macro U1() #local X = T(); X #end
        #macro U2() #local X = T(); object { X } #end
        #macro U3() #local X = union { T() T() }; object { X } #end
        #macro F() 3 #end
        #macro V() #local A = F(); sphere { 0, A } #end
    ";
    let cases = [
        ("object { U1() }", "sphere"),
        ("object { U1() translate x }", "sphere"),
        ("object { U2() }", "sphere"),
        ("union { U2() box { 0, 1 } }", "union(sphere, cuboid)"),
        ("union { box { 0, 1 } U1() }", "union(cuboid, sphere)"),
        ("union { V() V() }", "union(sphere, sphere)"),
        ("object { U3() scale 0.5 }", "union(sphere, sphere)"),
        (
            "difference { #local K = T(); object { K } object { K } }",
            "difference(sphere, sphere)",
        ),
        (
            "union { #local K = T() object { K } box { 0, 1 } }",
            "union(sphere, cuboid)",
        ),
        // POV-Ray rejects extra separators; here they are harmless, but no object may vanish.
        (
            "union { ; sphere { 0, 1 }; box { 0, 1 } ; }",
            "union(sphere, cuboid)",
        ),
        ("union { T(); T(); }", "union(sphere, sphere)"),
    ];
    for (text, expected) in cases {
        assert_eq!(read(&format!("{setup}{text}")), expected, "{text}");
    }
}

#[test]
fn what_does_not_belong_in_a_block_is_an_error() {
    let cases = [
        "sphere { 0, 1 location 3 }",
        "sphere { 0, 1 sphere { 0, 1 } }",
        "object { sphere { 0, 1 } sphere { 0, 1 } }",
        "union { sphere { 0, 1 } pigment { rgb 1 } sphere { 0, 1 } }",
        "sphere { 0, 1 finish { location 3 } }",
        "sphere { 0, 1 pigment { rgb x location 3 } }",
        "sphere { 0, 1 normal { location 3 } }",
        "sphere { 0, 1 texture { location 3 } }",
        "sphere { 0, 1 material { ambient 3 } }",
        "sphere { 0, 1 interior { ambient 3 } }",
        "sphere { 0, 1 texture { pigment { color_map { [0 rgb 1] location } } } }",
        "mesh { triangle { 0, x, y } location 3 }",
        "mesh { triangle { 0, x, y pigment { rgb 1 } } }",
        "mesh { }",
        "blob { threshold 1 }",
        "blob { threshold 1 sphere { 0, 1, 1 } box { 0, 1 } }",
        "blob { threshold 1 sphere { 0, 1, 1 interior { ior 1 } } }",
        "isosurface { function { x } location 3 }",
        "camera { location x ambient 3 }",
        "light_source { 0, 1 ambient 3 }",
        "light_source { 0, 1 no_shadow }",
        "light_source { L shadowless }",
        "fog { distance 3 ambient 3 }",
        "sky_sphere { pigment { rgb x } ambient 3 }",
        "rainbow { distance 3 ambient 3 }",
        "global_settings { ambient 3 }",
        "#default { ambient 1 }",
        "#default { sphere { 0, 1 } }",
    ];
    for text in cases {
        let found = errors(&format!("{NAMES}{text}"));
        let said = ["expected", "has no triangles"];
        assert!(
            said.iter().any(|s| found[0].contains(s)),
            "{text}: {found:?}"
        );
        assert_eq!(found.len(), 1, "{text}: {found:?}");
    }
}

#[test]
fn words_of_old_versions_are_read() {
    let read = |text: &str| parse_with(&mut MemoryHost::new(), text).scene.is_some();
    assert!(read("sphere { 0, 1 color red 1 }"));
    assert!(read(
        "sphere { 0, 1 pigment { rgbf <1, 1, 1, 1> } finish { refraction 1 ior 1.5 } }"
    ));
    let filter = "#declare C = color red 1 alpha 0.5; #debug str(C.filter, 0, 1)";
    assert_eq!(debug(filter), "0.5");
}

/// As measured, with any value and in all versions.
#[test]
fn refraction_in_an_interior_has_no_effect() {
    let shape = |version: &str, refraction: &str| {
        let text = format!(
            "#version {version}; sphere {{ 0, 1 pigment {{ rgbt 1 }} interior {{ ior 1.5 {refraction} }} }}"
        );
        let parsed = parse_with(&mut MemoryHost::new(), &text);
        let said: Vec<String> = parsed
            .diagnostics
            .iter()
            .map(|d| d.message.clone())
            .collect();
        let scene = parsed.scene.expect("a scene");
        (format!("{:?}", scene.objects), said)
    };
    for version in ["3.1", "3.7"] {
        let (plain, _) = shape(version, "");
        assert_ne!(shape(version, "ior 1.6").0, plain);
        for value in ["0", "0.5", "1", "1.6", "-1"] {
            let (with, said) = shape(version, &format!("refraction {value}"));
            assert_eq!(with, plain, "{version} {value}");
            assert_eq!(said, ["`refraction` has no effect in an interior"]);
        }
    }
    let found = errors("sphere { 0, 1 interior { refraction x } }");
    assert_eq!(found.len(), 1, "{found:?}");
}

#[test]
fn features_that_are_missing_are_named_in_their_blocks_only() {
    let text =
        "sphere { 0, 1 photons { target } no_radiosity finish { subsurface { translucency 1 } } }";
    let parsed = parse_with(&mut MemoryHost::new(), text);
    let count = parsed.diagnostics.iter().filter(|d| !d.is_error()).count();
    assert!(parsed.scene.is_some() && count >= 1);
    assert!(!errors("camera { photons { target } }").is_empty());
}

#[test]
fn a_declaration_ends_where_the_next_directive_begins() {
    let cases = [
        (
            "#declare A = .4\n#declare B = A\n#if (A < 1) #debug \"yes\" #end\n#debug str(B, 0, 1)",
            "yes0.4",
        ),
        (
            "#declare A = 0\n#declare N = 0\n#while (A < 3) #declare N = N + A #declare A = A + 1 #end #debug str(N, 0, 0)",
            "3",
        ),
        ("#declare A = .4 #if (A < 1) #debug \"yes\" #end", "yes"),
        (
            "#declare A = .4 #declare D = A + 1 #declare V = <A, D, 1> #declare W = V + x #debug vstr(3, W, \" \", 0, 1)",
            "1.4 1.4 1.0",
        ),
        (
            "#declare K = color rgb <1, 2, 3> #declare J = K * 2 #declare G = -J #declare H = G.green #debug str(H, 0, 0)",
            "-4",
        ),
        (
            "#declare S = \"a\" #declare T = concat(S, \"b\") #debug T",
            "ab",
        ),
        (
            "#declare A = 1 #switch (A) #case (1) #declare R = A #break #else #declare R = 7 #end #debug str(R, 0, 0)",
            "1",
        ),
        (
            "#macro One() 1 #end #declare A = One() #declare C = A + One() #if (C = 2) #debug \"two\" #end",
            "two",
        ),
        (
            "#macro Q(X) #debug str(X, 0, 0) #end #declare A = 1 -1 Q(A)",
            "0",
        ),
        (
            "#macro F(N) #if (N < 2) 1 #else N * F(N - 1) #end #end #declare A = F(5) #declare C = A #debug str(C, 0, 0)",
            "120",
        ),
        (
            "#declare A = (1 #if (1) + 2 #end); #debug str(A, 0, 0)",
            "3",
        ),
        (
            "#declare A = <1, #if (1) 2 #end, 3>; #debug str(A.y, 0, 0)",
            "2",
        ),
        (
            "#declare A = 1 + #declare C = 5; 2; #debug str(A, 0, 0)",
            "3",
        ),
        (
            "#declare A = #if (1) 1 #else 2 #end; #debug str(A, 0, 0)",
            "1",
        ),
        (
            "#macro M() #declare A = 1 #end M() #debug str(A, 0, 0)",
            "1",
        ),
        (
            "#declare A = array[2] { 1, 2 } #declare A[0] = A[1] #declare B = A #debug str(B[0], 0, 0)",
            "2",
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(debug(text), expected, "{text}");
    }
}

#[test]
fn numbers_of_a_colour_beyond_its_word_are_filter_and_transmit() {
    let parts = |color: &str, setup: &str| {
        debug(&format!(
            "{setup} #declare Red1 = rgbft <.9, .1, .2, .3, .4>; #declare K = {color};
             #debug concat(str(K.red, 0, 2), str(K.green, 0, 2), str(K.blue, 0, 2), str(K.filter, 0, 2), str(K.transmit, 0, 2))"
        ))
    };
    let gamma = "#version 3.7; global_settings { assumed_gamma 1 }";
    let cases = [
        ("rgb <.1, .2>", "0.100.200.000.000.00"),
        ("rgb <.1, .2, .3, .4>", "0.100.200.300.400.00"),
        ("rgb <.1, .2, .3, .4, .5>", "0.100.200.300.400.50"),
        ("color rgb <.1, .2, .3, .4, .5>", "0.100.200.300.400.50"),
        ("rgbf <.1, .2, .3>", "0.100.200.300.000.00"),
        ("rgbf <.1, .2, .3, .4, .5>", "0.100.200.300.400.50"),
        ("rgbt <.1, .2, .3, .4, .5>", "0.100.200.300.000.40"),
        ("rgbft <.1, .2, .3, .4>", "0.100.200.300.400.00"),
        ("rgb .5", "0.500.500.500.000.00"),
        ("rgbf .5", "0.500.500.500.500.00"),
        ("rgbt .5", "0.500.500.500.000.50"),
        ("rgbft .5", "0.500.500.500.500.50"),
        ("rgb Red1", "0.900.100.200.300.40"),
        ("rgb 1 - Red1", "0.100.900.800.700.60"),
        ("rgb Red1 * .5", "0.450.050.100.150.20"),
        ("rgb <.5, .2, .3, .4> filter .1", "0.500.200.300.100.00"),
        ("srgb <.5, .2, .3, .4, .6>", "0.210.030.070.400.60"),
        ("srgbf <.5, .2, .3, .4, .6>", "0.210.030.070.400.60"),
        ("srgbt <.5, .2, .3, .4>", "0.210.030.070.000.40"),
    ];
    for (color, expected) in cases {
        assert_eq!(parts(color, gamma), expected, "{color}");
    }
    // `srgb` converts to the numbers with which the scene computes.
    let with = |gamma: &str| {
        parts(
            "srgb <.5, .2, .3>",
            &format!("#version 3.7; global_settings {{ assumed_gamma {gamma} }}"),
        )
    };
    assert_eq!(with("2.2"), "0.500.210.300.000.00");
    assert_eq!(with("1.8"), "0.420.150.230.000.00");
    assert_eq!(with("srgb"), "0.500.200.300.000.00");
}

#[test]
fn line_ends_and_wide_characters() {
    let text = "// a comment\n#declare A = 1; // another\n#debug concat(\"\u{e9}\", str(A, 0, 0)) // last\nsphere { 0, 1 }\n";
    let read = |bytes: Vec<u8>| {
        let mut host = MemoryHost::new();
        let source = strahl_sdl::Source::new("a.pov", bytes);
        let parsed = strahl_sdl::parse(source, &strahl_sdl::Options::default(), &mut host);
        let scene = parsed
            .scene
            .unwrap_or_else(|| panic!("{:?}", parsed.diagnostics));
        assert_eq!(scene.objects.0[0].span.line, 4);
        assert_eq!(
            (
                scene.objects.0[0].span.column,
                scene.objects.0[0].span.length
            ),
            (1, 6)
        );
        host.text(Stream::Debug)
    };
    let wide = |text: &str, mark: bool, bytes: fn(u16) -> [u8; 2]| {
        let mark = mark.then_some(0xfeff);
        let units = mark.into_iter().chain(text.encode_utf16());
        units.flat_map(bytes).collect::<Vec<u8>>()
    };
    for end in ["\n", "\r\n", "\r"] {
        let text = text.replace('\n', end);
        assert_eq!(read(text.clone().into_bytes()), "\u{e9}1", "{end:?}");
        assert_eq!(read([b"\xef\xbb\xbf", text.as_bytes()].concat()), "\u{e9}1");
        for mark in [true, false] {
            assert_eq!(
                read(wide(&text, mark, u16::to_le_bytes)),
                "\u{e9}1",
                "{end:?}"
            );
            assert_eq!(
                read(wide(&text, mark, u16::to_be_bytes)),
                "\u{e9}1",
                "{end:?}"
            );
        }
    }
    // Included files and data files are converted too.
    let mut host = MemoryHost::new()
        .with_file(
            "a.inc",
            wide("#declare A = 7;\r// end", true, u16::to_le_bytes),
        )
        .with_file("a.txt", wide("8, \"\u{3b1}\"", true, u16::to_be_bytes));
    let text = "#include \"a.inc\" #include \"a.inc\" #fopen F \"a.txt\" read #read (F, B, C) #debug concat(str(A + B, 0, 0), C)";
    assert!(parse_with(&mut host, text).diagnostics.is_empty());
    assert_eq!(host.text(Stream::Debug), "15\u{3b1}");
}

#[test]
fn functions_call_elements_of_arrays_and_take_heights_of_pigments() {
    let cases = [
        (
            "#declare F = array[2] { function(x, y) { x + y }, function(x, y) { x * y } } #declare G = function(x, y) { F[1](x, y) }",
            "G(3, 4)",
            "12.00000",
        ),
        (
            "#declare F = array[2] { function(x, y) { x + y }, function(x, y) { x * y } } #declare I = 0; #declare G = function(x, y) { F[I](x, y) + F[I + 1](y, y) }",
            "G(3, 4)",
            "23.00000",
        ),
        (
            "#declare F = array[1][2] { { function(x) { x }, function(x) { 2 * x } } } #declare G = function(x) { F[0][1](x) + 1 }",
            "G(3)",
            "7.00000",
        ),
        (
            "#declare A = array[2] { 3, 5 } #declare G = function(x) { A[1] * x }",
            "G(3)",
            "15.00000",
        ),
        (
            "#declare P = function { pigment { gradient x color_map { [0 rgb <.1, .2, .3>] [1 rgb <.5, .6, .7>] } } } #declare G = function(x, y, z) { P(x, y, z).hf }",
            "G(.3, .4, .5)",
            "0.22039",
        ),
    ];
    for (setup, call, expected) in cases {
        assert_eq!(
            debug(&format!("{setup} #debug str({call}, 0, 5)")),
            expected,
            "{setup}"
        );
    }
    let found = errors("#declare A = array[1] { \"x\" } #declare G = function(x) { A[0] }");
    assert!(
        found[0].contains("expected a number or a function"),
        "{found:?}"
    );
}

#[test]
fn rays_without_direction_meet_nothing() {
    let text =
        "#declare S = sphere { 0, 1 } #declare N = x; #declare H = trace(S, -5 * z, <0, 0, 0>, N);
        #debug concat(vstr(3, H, \" \", 0, 0), vstr(3, N, \" \", 0, 0))";
    assert_eq!(debug(text), "0 0 00 0 0");
}

#[test]
fn a_hash_without_a_directive_does_nothing() {
    let read = |text: &str| {
        let parsed = parse_with(&mut MemoryHost::new(), text);
        let messages: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
        let scene = parsed
            .scene
            .unwrap_or_else(|| panic!("{text}\n{messages:?}"));
        (scene.objects.0.len(), scene.settings.max_depth)
    };
    for text in [
        "#\nsphere { 0, 1 }",
        "#\n#\nsphere { 0, 1 }",
        "# sphere { 0, 1 }",
        "#sphere { 0, 1 }",
        "#declare S = sphere { 0, 1 }\n#\nS",
        "sphere { 0, 1 #\n }",
        "#\ndeclare S = sphere { 0, 1 } S",
    ] {
        assert_eq!(read(text).0, 1, "{text}");
    }
    assert_eq!(
        read("#max_trace_level 7 #max_intersections 9\nsphere { 0, 1 }"),
        (1, 7)
    );
    let found = errors("#delcare A = 1;");
    assert!(found[0].contains("did you mean `#declare`?"), "{found:?}");
}

#[test]
fn boxes_go_on_for_ever_where_one_corner_is_infinite() {
    let objects = |text: &str| {
        let parsed = parse_with(&mut MemoryHost::new(), text);
        parsed.scene.map(|scene| scene.objects.0.len())
    };
    assert_eq!(objects("box { -1, <1 / 0, 1, 1> }"), Some(1));
    assert_eq!(
        objects("box { -1, <1e400, 1, 1> scale 0.5 rotate 20 * y }"),
        Some(1)
    );
    // As in POV-Ray, these are invisible.
    assert_eq!(objects("box { <-1 / 0, -1, -1>, <1 / 0, 1, 1> }"), Some(0));
}

#[test]
fn a_capital_letter_means_a_name() {
    let found = errors("sphere { 0, 1 pigment { Redd } }");
    assert!(
        found[0].contains("did you mean `Red`? It is declared in colors.inc: write `#include \"colors.inc\"` first"),
        "{found:?}"
    );
    let found = errors("#include \"colors.inc\" sphere { 0, 1 pigment { Redd } }");
    assert!(found[0].contains("did you mean `Red`?"), "{found:?}");
    assert!(!found[0].contains("write"), "{found:?}");
    let found = errors("sphere { 0, 1 pigmnet { rgb 1 } }");
    assert!(found[0].contains("did you mean `pigment`?"), "{found:?}");
}

#[test]
fn loops_need_a_step() {
    let found = errors("#for (I, 0, 1, 0) #debug \"x\" #end");
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("must not be 0"), "{found:?}");
    for head in [
        "#if (",
        "#while (x",
        "#switch (\"a\")",
        "#ifdef (1)",
        "#macro (x)",
    ] {
        let found = errors(&format!(
            "{head} #declare A = 1; #else sphere {{ }} #end sphere {{ 0, 1 }}"
        ));
        assert_eq!(found.len(), 1, "{head}: {found:?}");
    }
    assert_eq!(debug("#for (I, 0, 3, 1e400) #debug \"x\" #end"), "x");
    assert_eq!(
        debug("#for (I, 0, 3, -1) #debug \"x\" #end #debug str(I, 0, 0)"),
        "0"
    );
}

#[test]
fn heights_of_a_sor_grow() {
    let text = "sor { 5, <.1, 0>, <.2, .5>, <.3, .5>, <.4, .5>, <.5, 1> }";
    let errors = errors(text);
    assert_eq!(errors.len(), 1, "{errors:?}");
    assert!(errors[0].contains("must grow"), "{errors:?}");
}

const DOTS: &[u8] = b"P6\n2 2\n255\n\xff\0\0\x0a\x0b\x0c\x20\x30\x40\x80\x80\x80";

/// Names of files without an ending, and the directions of pictures that POV-Ray 1.0 had.
#[test]
fn endings_of_files_are_added() {
    let read = |text: &str| {
        let mut host = MemoryHost::new()
            .with_file("dot.ppm", DOTS)
            .with_file("mine.inc", b"#declare Mine = sphere { 0, 1 }")
            .with_file("plain", b"#declare Plain = sphere { 0, 1 }");
        let parsed = parse_with(&mut host, &format!("#version 3.7; {text}"));
        let messages = parsed.diagnostics.iter().map(ToString::to_string);
        (parsed.scene.is_some(), messages.collect::<Vec<_>>())
    };
    for text in [
        "#include \"mine\" object { Mine }",
        "#include \"plain\" object { Plain }",
        "#include \"colors\" sphere { 0, 1 pigment { Red } }",
        "sphere { 0, 1 pigment { image_map { ppm \"dot\" } } }",
        "sphere { 0, 1 pigment { image_map { <1 -1 0> ppm \"dot.ppm\" once } } }",
        "height_field { ppm \"dot\" }",
    ] {
        let (done, messages) = read(text);
        assert!(done && messages.is_empty(), "{text}\n{messages:?}");
    }
    let (_, messages) =
        read("sphere { 0, 1 pigment { image_map { <1, 0, -1> ppm \"dot.ppm\" } } }");
    assert!(messages[0].contains("directions"), "{messages:?}");
    let (done, messages) = read("#include \"nothing\"");
    assert!(!done && messages[0].contains("`nothing`"), "{messages:?}");
}

/// The first version of the language counts water levels in 256ths.
#[test]
fn old_water_levels_are_whole_numbers() {
    let shape = |version: &str, level: &str| {
        let mut host = MemoryHost::new().with_file("dot.ppm", DOTS);
        let text =
            format!("#version {version}; height_field {{ ppm \"dot.ppm\" water_level {level} }}");
        let scene = parse_with(&mut host, &text).scene.expect("a scene");
        format!("{:?}", scene.objects.0[0].kind)
    };
    assert_eq!(shape("1.0", "64"), shape("3.1", "0.25"));
    assert_eq!(shape("2.0", "0.25"), shape("3.7", "0.25"));
}
