//! Texts that mean no good: each ends soon, with an error that says what is wrong.

mod common;

use common::{errors, parse_with};
use strahl_sdl::{MemoryHost, Options, Source, parse};

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
    assert!(errors("sphere { 0, 1")[0].contains("found the end"));
    assert!(errors("#if (1) sphere { 0, 1 }")[0].contains("`#if` has no `#end`"));
    assert!(errors("#macro A() ")[0].contains("`#macro` has no `#end`"));
    assert!(errors("#while (0) sphere { 0, 1 }")[0].contains("`#while` has no `#end`"));
    assert!(errors("#end")[0].contains("`#end` without a block"));
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
    assert!(errors("#declare A = array[1000000000];")[0].contains("more than 134217728 elements"));
    assert!(errors("#declare A = array[100000][100000][100000][100000];")[0].contains("elements"));
    assert!(errors("#declare A = array; #declare A[1e12] = 1;")[0].contains("elements"));
    assert!(errors("#declare A = array[-1];")[0].contains("cannot have -1 elements"));
    assert!(
        errors("#declare S = \"0123456789\"; #while (1) #declare S = concat(S, S); #end")[0]
            .contains("16777216 bytes")
    );
    assert!(
        errors("#declare A = array[1]{0}; #while (1) #declare A[0] = A; #end")[0]
            .contains("at most 100 deep")
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

/// Words of the language in any order reach further into the parser than bytes do.
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
