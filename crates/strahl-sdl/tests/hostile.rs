//! Malicious texts: each ends soon, with an error that says what is wrong.

use crate::common::{errors, parse_with};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use strahl_sdl::{FolderHost, MemoryHost, Options, Source, parse};

fn limited(text: &str, limit: impl FnOnce(&mut Options)) -> String {
    let mut options = Options::default();
    limit(&mut options);
    let parsed = parse(
        Source::new("test.pov", text),
        &options,
        &mut MemoryHost::new(),
    );
    assert!(parsed.scene.is_none(), "no error in {text}");
    parsed
        .diagnostics
        .iter()
        .map(|d| format!("{d}\n"))
        .collect()
}

#[test]
fn unfinished_texts() {
    assert!(errors("#debug \"abc")[0].contains("this string does not end"));
    assert!(errors("sphere { 0, 1 } /* /* */")[0].contains("this comment does not end"));
    assert!(errors("sphere { 0, 1")[0].contains("found the end of the file"));
    assert!(errors("#if (1) sphere { 0, 1 }")[0].contains("`#if` has no `#end`"));
    assert!(errors("#macro A() ")[0].contains("`#macro` has no `#end`"));
    assert!(errors("#while (0) sphere { 0, 1 }")[0].contains("`#while` has no `#end`"));
    assert!(errors("#end")[0].contains("`#end` does not belong to a block"));
    assert!(errors("}")[0].contains("expected an object"));
    for text in [
        "#",
        "#declare",
        "#macro",
        "#for(",
        "<",
        "(",
        "{",
        "sphere",
        "#switch(1)",
        "#if",
        "\"",
        "#include",
        "\0",
        "#else",
    ] {
        let _ = parse_with(&mut MemoryHost::new(), text);
    }
}

#[test]
fn endless_loops_and_recursion() {
    let steps = |o: &mut Options| o.limits.steps = 100_000;
    assert!(limited("#while (1) #end", steps).contains("seems not to end"));
    assert!(limited("#for (I, 0, 1e300) #end", steps).contains("seems not to end"));
    assert!(limited("#macro A() A() #end A()", steps).contains("nested deeper than 10000 levels"));
    assert!(limited("#macro A(X) A(A(X)) #end A(1)", steps).contains("nested deeper"));
    assert!(limited("#macro A(X) (A(X)) #end #declare B = A(1);", steps).contains("nested deeper"));
}

#[test]
fn a_loop_that_makes_nothing_ends_long_before_one_that_does() {
    let idle = |o: &mut Options| o.limits.idle_steps = 10_000;
    let text = limited("#while (1) #end", idle);
    assert!(text.contains("10000 steps since the last object"), "{text}");
    assert!(text.contains("--limit idle_steps=N"), "{text}");
    let mut options = Options::default();
    options.limits.idle_steps = 10_000;
    let text = "#for (I, 1, 2000) #declare A = I * 2; sphere { A, 1 } #end";
    let parsed = parse(Source::new("x", text), &options, &mut MemoryHost::new());
    assert_eq!(parsed.scene.expect("no errors").objects.0.len(), 2000);
}

#[test]
fn a_scene_that_nobody_wants_any_more_is_read_no_further() {
    let mut options = Options::default();
    (options.limits.steps, options.limits.idle_steps) = (u64::MAX, u64::MAX);
    for text in [
        "#while (1) #end",
        "#declare F = function(x) { sin(x) } #while (1) #declare A = F(F(1)); #end",
    ] {
        let stop = Arc::new(AtomicBool::new(false));
        let timer = Arc::clone(&stop);
        let thread = std::thread::spawn(move || {
            std::thread::sleep(Duration::from_millis(50));
            timer.store(true, Ordering::Relaxed);
        });
        let mut host = FolderHost::new([]).stopped_by(stop);
        let parsed = parse(Source::new("x", text), &options, &mut host);
        assert!(parsed.scene.is_none());
        assert!(parsed.diagnostics[0].message.contains("stopped"), "{text}");
        thread.join().expect("it only sleeps");
    }
}

#[test]
fn functions_that_would_take_for_ever() {
    let doubled = "#declare F = function(x) { x + 1 }
        #for (I, 1, 200) #declare F = function(x) { F(sin(F(x)) * I) } #end";
    let long_chain = "#declare F = function(x) { x + 1 }
        #for (I, 1, 100000) #declare F = function(x) { sin(F(x)) + I } #end";
    let through_patterns = "#declare F = function { x }
        #for (I, 1, 200) #declare F = function { pattern { function { F(x, y, z) + F(y, x, z) } } } #end";
    let nested_patterns = "#declare F = function { x }
        #for (I, 1, 100000) #declare F = function { pattern { function { F(x, y, z) } } } #end";
    let through_pigments = "#declare F = function { x }
        #for (I, 1, 200) #declare P = function { pigment { average pigment_map {
            [1 function { F(x, y, z) } color_map { [0 rgb 0] [1 rgb 1] }]
            [1 function { F(y, x, z) } color_map { [0 rgb 0] [1 rgb 1] }] } } }
        #declare F = function { P(x, y, z).red } #end";
    let through_objects = "#declare F = function { x - 1 }
        #for (I, 1, 200)
        #declare O = isosurface { function { F(x, y, z) + F(y, x, z) } contained_by { box { -1, 1 } } }
        #declare F = function { pattern { object { O } } } #end";
    for (text, expected) in [
        (doubled, "operations, at most 1048576 are allowed"),
        (through_patterns, "operations, at most"),
        (nested_patterns, "nested more than 128 deep"),
        (through_pigments, "operations, at most"),
        (through_objects, "operations, at most"),
        (
            "#declare F = function(x) { sum(i, 1, 1e5, sum(j, 1, 1e5, sin(x * i * j))) }",
            "--limit function_cost=N",
        ),
        (
            "#declare F = function(x) { prod(i, 1, 1e30, x) }",
            "endlessly many operations",
        ),
    ] {
        let found = errors(text);
        assert!(found[0].contains(expected), "{text}: {}", found[0]);
    }
    let operations = |o: &mut Options| o.limits.function_operations = 1 << 20;
    assert!(limited(long_chain, operations).contains("all functions together have more than"));
    // Loops in functions are bounded by their cost, and calls count as steps.
    let endless = "#declare F = function(x) { sum(i, 1, x, sum(j, 1, x, i * j)) }\n";
    let parsed = parse_with(
        &mut MemoryHost::new(),
        &format!("{endless} #if (F(1e30) = F(1e30)) #error \"a number\" #end"),
    );
    assert!(parsed.scene.is_some(), "{:?}", parsed.diagnostics);
    let steps = |o: &mut Options| o.limits.steps = 2_000_000;
    let text = format!("{endless} #for (I, 1, 1000000) #declare A = F(1e30); #end");
    assert!(limited(&text, steps).contains("seems not to end"));
    let text = "height_field { function 10000, 1000 { prod(i, 1, 100, x * i * 1.01) } }";
    assert!(limited(text, steps).contains("seems not to end"));
}

/// Found by fuzzing: `gray` counted as the beginning of a colour, but was not read as one.
#[test]
fn words_that_begin_nothing_are_no_endless_items() {
    let found = errors("#declare P = pigment { bozo x 1, gray y 2 }");
    assert!(
        found[0].contains("expected a colour, found `gray`"),
        "{found:?}"
    );
}

#[test]
fn deep_nesting() {
    for open in [
        "(",
        "-",
        "union { ",
        "transform { transform ",
        "array[1]{",
        "f(",
        "concat(",
        "!",
        "<1,(",
    ] {
        let text = format!("#declare A = {}", open.repeat(100_000));
        assert!(!errors(&text).is_empty());
    }
    let text = format!("sphere {{ 0, {}1{} }}", "(".repeat(900), ")".repeat(900));
    assert!(parse_with(&mut MemoryHost::new(), &text).scene.is_some());
    assert!(!errors(&"#if (1) ".repeat(100_000)).is_empty());
}

#[test]
fn huge_things() {
    assert!(errors("#declare A = array[1000000000];")[0].contains("more than 16777216 elements"));
    assert!(errors("#declare A = array[100000][100000][100000][100000];")[0].contains("elements"));
    assert!(errors("#declare A = array; #declare A[1e12] = 1;")[0].contains("elements"));
    assert!(errors("#declare A = array[-1];")[0].contains("cannot have -1 elements"));
    assert!(
        errors("#declare S = \"0123456789\"; #while (1) #declare S = concat(S, S); #end")[0]
            .contains("16777216 bytes")
    );
    assert!(
        errors("#declare A = array[1]{0}; #while (1) #declare A[0] = A; #end")[0]
            .contains("more than 100 deep")
    );
    assert!(errors("#debug str(1, 1e9, 0)")[0].contains("characters"));
    let objects = |o: &mut Options| o.limits.objects = 1000;
    assert!(limited("#while (1) sphere { 0, 1 } #end", objects).contains("more than 1000 objects"));
    let messages = |o: &mut Options| o.limits.written_bytes = 1000;
    assert!(
        limited("#while (1) #debug \"spam\" #end", messages).contains("longer than 1000 bytes")
    );
}

#[test]
fn includes_in_circles() {
    let mut host = MemoryHost::new()
        .with_file("a.inc", "#include \"b.inc\"")
        .with_file("b.inc", "#include \"a.inc\"");
    let parsed = parse_with(&mut host, "#include \"a.inc\"");
    let text = parsed.diagnostics[0].to_string();
    assert!(
        text.contains("includes itself") && text.contains("included at"),
        "{text}"
    );
    assert!(errors("#include \"nothing.inc\"")[0].contains("there is no file `nothing.inc`"));
}

#[test]
fn any_bytes_are_read() {
    let mut state = 1u32;
    for length in 0..300 {
        let bytes: Vec<u8> = (0..length)
            .map(|_| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (state >> 24) as u8
            })
            .collect();
        let mut options = Options::default();
        options.limits.steps = 10_000;
        let _ = parse(Source::new("x", bytes), &options, &mut MemoryHost::new());
    }
}

/// Keywords in random order reach more of the parser than random bytes do.
#[test]
fn words_in_any_order_are_read() {
    const WORDS: &str = "sphere box plane object { } { } ( ) ( ) < > [ ] , ; . + - * / = != <= ? : & | ! 0 1 2.5 1e9 -3 \
        \"s\" \"a.inc\" A B C A B C x y z t rgb rgbt color filter #declare A = #declare B = #local C = #if ( #ifdef ( #else #elseif ( \
        #end #end #end #while ( #for ( A , 0 , 3 ) #switch ( #case ( #range ( #break #macro A ( #macro B ( C ) #include #undef \
        #fopen #read ( #write ( #fclose #version #default #debug array [ dictionary { . function { function ( spline { linear_spline \
        cubic_spline sum ( max ( sin ( rand ( seed ( str ( concat ( vstr ( substr ( defined ( dimension_size ( trace ( inside ( min_extent ( \
        select ( f_sphere ( internal ( pattern pigment texture finish transform camera light_source background global_settings \
        translate rotate scale matrix read write append local. global. optional mixed #local A = array [ 3 ] { 1 , 2 , 3 } ; \
        #declare F = function ( x , y ) { x * y } ; F ( A [ 1 ] A ( B ( .x .red location look_at angle phong reflection";
    let words: Vec<&str> = WORDS.split_whitespace().collect();
    let rounds: u64 = std::env::var("STRAHL_SOUP")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(2000);
    let mut state = 1u64;
    for round in 0..rounds {
        let mut text = String::new();
        for _ in 0..(5 + round % 120) {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let word = (state >> 33) as usize % words.len();
            text.push_str(words[word]);
            text.push(' ');
        }
        let mut options = Options::default();
        options.limits.steps = 20_000;
        options.limits.array_elements = 1 << 16;
        options.limits.string_bytes = 1 << 12;
        let mut host = MemoryHost::new().with_file("a.inc", text.clone());
        let parsed = parse(Source::new("soup.pov", text), &options, &mut host);
        let failed = parsed.diagnostics.iter().any(|d| d.is_error());
        assert_eq!(failed, parsed.scene.is_none());
    }
}

/// A scene built step by step: the object of the last step is not copied by each step.
#[test]
fn drilling_in_a_loop_takes_linear_time() {
    let drilled = |holes: usize| {
        let text = format!(
            "#declare A = box {{ -1, 1 }} #for (I, 1, {holes}) \
             #declare A = difference {{ object {{ A }} cylinder {{ -2*z, 2*z, 0.01 translate x*I/{holes} }} }} #end \
             object {{ A pigment {{ rgb 1 }} }}"
        );
        let mut options = Options::default();
        // Copies would be counted: half the square of the number of holes.
        options.limits.objects = 10 * holes;
        let parsed = parse(
            Source::new("test.pov", text),
            &options,
            &mut MemoryHost::new(),
        );
        let errors: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
        let scene = parsed
            .scene
            .unwrap_or_else(|| panic!("{}", errors.join("\n")));
        assert!(scene.groups.is_empty());
        let (mut shapes, mut waiting) = (0, vec![&scene.objects.0[0]]);
        while let Some(object) = waiting.pop() {
            match &object.kind {
                strahl_scene::ObjectKind::Csg { children, .. } => waiting.extend(&children.0),
                strahl_scene::ObjectKind::Shape(_) => shapes += 1,
                other => panic!("{other:?}"),
            }
        }
        assert_eq!(shapes, holes + 1);
    };
    drilled(10);
    drilled(20_000);
}

/// Parts used several times within one CSG object are copied for each use but the last.
#[test]
fn combined_objects_have_all_their_parts() {
    let text = "#declare Ball = union { #for (I, 1, 20) sphere { I * x, 0.3 } #end } \
        #declare Two = difference { object { Ball } object { Ball translate y } } \
        object { Two } object { Two translate z } object { Ball inverse } \
        intersection { object { Two } object { Ball } }";
    let parsed = parse_with(&mut MemoryHost::new(), text);
    let scene = parsed.scene.unwrap();
    let shapes = |objects: &[strahl_scene::Object]| {
        let mut waiting: Vec<&strahl_scene::Object> = objects.iter().collect();
        let (mut shapes, mut instances) = (0, 0);
        while let Some(object) = waiting.pop() {
            match &object.kind {
                strahl_scene::ObjectKind::Csg { children, .. } => waiting.extend(&children.0),
                strahl_scene::ObjectKind::Shape(_) => shapes += 1,
                strahl_scene::ObjectKind::Instance(_) => instances += 1,
                strahl_scene::ObjectKind::Light(_) => {}
            }
        }
        (shapes, instances)
    };
    for group in &scene.groups {
        assert_eq!(shapes(&group.objects.0).1, 0);
    }
    let each: Vec<_> = scene
        .objects
        .0
        .iter()
        .map(|o| shapes(std::slice::from_ref(o)))
        .collect();
    assert_eq!(each[2..], [(20, 0), (60, 0)]);
    let (drawn, shared) = shapes(&scene.objects.0[..2]);
    assert!(
        (drawn, shared) == (80, 0) || (shared == 2 && scene.groups.len() == 1),
        "{each:?}"
    );
}

#[test]
fn deep_and_endless_things_end_in_an_error() {
    let steps = |o: &mut Options| o.limits.steps = 3_000_000;
    for (text, expected) in [
        ("union { ".repeat(100_000), "nested deeper than 1000"),
        (
            "difference { sphere { 0, 1 } ".repeat(100_000),
            "nested deeper",
        ),
        (
            format!("#declare F = function(x) {{ {}x }}", "(".repeat(100_000)),
            "nested deeper",
        ),
        (
            format!("#declare A = ({}", "1 ? 1 : ".repeat(100_000)),
            "nested deeper",
        ),
        (
            format!(
                "#declare P = pigment {{ {}",
                "bozo pigment_map { [0 ".repeat(100_000)
            ),
            "nested deeper",
        ),
        (
            "#declare P = pigment { rgb 1 } #while (1) \
             #declare P = pigment { bozo pigment_map { [0 P] } } #end"
                .to_owned(),
            "nested deeper than 100 levels",
        ),
        (
            "#declare T = texture { pigment { rgb 1 } } #while (1) \
             #declare T = texture { bozo texture_map { [0 T] } } #end"
                .to_owned(),
            "nested deeper than 100 levels",
        ),
        (
            "#declare N = normal { bumps } #while (1) \
             #declare N = normal { bozo normal_map { [0 N] } } #end"
                .to_owned(),
            "nested deeper than 100 levels",
        ),
        (
            "#declare F = function(x) { F(x) } #debug str(F(1), 0, 0)".to_owned(),
            "F",
        ),
        (
            "#macro A(N) #if (N > 0) A(N - 1) A(N - 1) #end #end A(1000)".to_owned(),
            "seems not to end",
        ),
        (
            "#macro A() #macro A() A() #end A() #end A()".to_owned(),
            "nested deeper",
        ),
        (
            "#while (1) #declare R = seed(1); #end".to_owned(),
            "seems not to end",
        ),
        ("#declare S = spline { }".to_owned(), "at least one point"),
        (
            "#declare S = spline { cubic_spline 1e400, x }".to_owned(),
            "not a finite number",
        ),
    ] {
        let found = limited(&text, steps);
        let shown: String = text.chars().take(100).collect();
        assert!(found.contains(expected), "{shown}\n{found}");
        assert!(found.len() < 100_000, "{shown}");
    }
}

#[test]
fn numbers_out_of_all_bounds() {
    for text in [
        "sphere { 1e308 * 1e308, 1 }",
        "sphere { 0, 1e400 }",
        "sphere { (1e400 - 1e400) * x, 1 }",
        "plane { y, 1e400 }",
        "cylinder { 0, 1e400 * x, 1 }",
        "cone { 0, 1e400, x, 1 }",
        "torus { 1e400, 1 }",
        "triangle { 0, x, 1e400 * y }",
        "polygon { 4, <0, 0>, <1e400, 0>, <0, 1>, <0, 0> }",
        "sphere { 0, 1 translate 1e400 }",
        "sphere { 0, 1 scale 1e400 }",
    ] {
        assert!(!errors(text).is_empty(), "{text}");
    }
    // These are only semantically wrong.
    for text in [
        "sphere { 0, 1 pigment { rgb 1e400 } finish { phong_size 1e400 roughness 0 } }",
        "#debug str(pow(10, 400) - pow(10, 400), 0, 3)",
        "sphere { 0, 1 rotate 1e300 }",
        "#declare A = mod(1e300, 3e-300) + int(1e300) + div(1e300, 3);",
        "camera { location 1e300 look_at 0 }",
    ] {
        let _ = parse_with(&mut MemoryHost::new(), text);
    }
}

#[test]
fn bytes_that_are_no_text() {
    let read = |bytes: Vec<u8>| {
        let parsed = parse(
            Source::new("test.pov", bytes),
            &Options::default(),
            &mut MemoryHost::new(),
        );
        let errors: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
        (parsed.scene.is_some(), errors)
    };
    // Zero bytes are blanks; invalid UTF-8 in strings is read as Latin-1.
    assert_eq!(read(vec![0; 1_000_000]), (true, vec![]));
    assert_eq!(
        read(b"#debug \"\xff\xfe\xe9\" sphere { 0, 1 }".to_vec()),
        (true, vec![])
    );
    assert_eq!(
        read(b"\xef\xbb\xbfsphere { 0, 1 }".to_vec()),
        (true, vec![])
    );
    let (sound, errors) = read(b"sphere { 0, \xff }".to_vec());
    assert!(!sound && errors[0].contains("the byte 0xff"), "{errors:?}");
    let (sound, errors) = read(b"}".repeat(3_000_000));
    assert!(!sound && errors.len() <= 20, "{}", errors.len());
}

#[test]
fn a_scene_in_one_line_of_many_megabytes() {
    let text = format!(
        "{} sphere {{ 0, Q }} {}",
        "sphere{0,1}".repeat(200_000),
        "sphere{0,R}".repeat(200_000)
    );
    let found = errors(&text);
    assert!(found.len() <= 20, "{}", found.len());
    for (error, name) in found.iter().zip(["Q", "R"]) {
        assert!(
            error.contains(&format!("the undeclared name `{name}`")),
            "{error}"
        );
        assert!(error.len() < 1000, "{error}");
    }
    let column = "sphere{0,1}".len() * 200_000 + " sphere { 0, ".len() + 1;
    assert!(
        found[0].contains(&format!("test.pov:1:{column}")),
        "{}",
        found[0]
    );
    // The caret is below the name.
    let lines: Vec<&str> = found[0].lines().collect();
    assert_eq!(lines[3].find('Q'), lines[4].find('^'), "{}", found[0]);
    let long = errors(&format!("sphere {{ 0, {} }}", "A".repeat(5_000_000)));
    assert!(long[0].len() < 2000, "{}", long[0].len());
}

#[test]
#[cfg(unix)]
fn only_plain_files_are_read_and_only_allowed_ones_written() {
    use strahl_sdl::FolderHost;
    let root = tempfile::tempdir().unwrap();
    let path = |name: &str| root.path().join(name).display().to_string();
    let fifo = path("fifo");
    let made = std::process::Command::new("mkfifo").arg(&fifo).status();
    let folder = root.path().display();
    let mut texts = vec![
        format!("#fopen F \"{folder}\" read"),
        format!("#include \"{folder}\""),
        "#fopen F \"/dev/zero\" read".to_owned(),
        "#include \"/dev/zero\"".to_owned(),
        "sphere { 0, 1 pigment { image_map { png \"/dev/zero\" } } }".to_owned(),
        format!("#fopen F \"{}\" write", path("out")),
        "#fopen F \"../out\" append".to_owned(),
        "#fopen F \"out\" write".to_owned(),
        "#fopen F \"large\" read".to_owned(),
    ];
    if made.is_ok_and(|status| status.success()) {
        texts.push(format!("#fopen F \"{fifo}\" read"));
        texts.push(format!("#include \"{fifo}\""));
    }
    let large = std::fs::File::create(root.path().join("large")).unwrap();
    // A sparse file, which takes no space on the disk.
    large.set_len(1 << 40).unwrap();
    for text in texts {
        let mut host = FolderHost::new([root.path().to_path_buf()]);
        let parsed = parse(
            Source::new("test.pov", text.as_str()),
            &Options::default(),
            &mut host,
        );
        assert!(parsed.diagnostics.iter().any(|d| d.is_error()), "{text}");
    }
    assert!(!root.path().join("out").exists());
}
