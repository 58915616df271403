//! Texts that would fill the memory: each ends in an error, with the default limits before it uses more than a few gigabytes, and
//! with small limits before it uses more than a little.
//!
//! It is a test program of its own with a single test, because it measures the memory of the whole process.

use strahl_sdl::{MemoryHost, Options, Source, parse};

/// Peak memory of this process so far, in bytes; `None` where the system does not report it.
fn peak_memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes << 10)
}

/// Limits none of which allows more than about 100 MB.
fn small() -> Options {
    let mut options = Options::default();
    options.limits.steps = 10_000_000;
    options.limits.array_elements = 1 << 16;
    options.limits.string_bytes = 1 << 20;
    options.limits.all_strings = 1 << 26;
    options.limits.objects = 50_000;
    options.limits.parts = 1 << 19;
    options
}

#[test]
fn nothing_fills_the_memory() {
    let repeated = |head: &str, body: &str| format!("{head} #while (1) {body} #end");
    let cases = [
        // Things with a size given in the scene.
        ("#declare A = array[1000000000];".to_owned(), "elements"),
        ("#declare A = array[16777217];".to_owned(), "elements"),
        ("#declare A = array; #declare A[1e14] = 1;".to_owned(), "elements"),
        ("mesh2 { vertex_vectors { 1e300, <0,0,0> } }".to_owned(), "should have"),
        ("polygon { 1e9, <0,0,0> }".to_owned(), "expected"),
        ("#debug vstr(5, 1, \"a\", 1e9, 1)".to_owned(), "characters"),
        // Things that double repeatedly.
        (repeated("#declare S = \"0123456789\";", "#declare S = concat(S, S);"), "bytes"),
        (
            repeated(
                "#declare P = pigment { rgb 1 }",
                "#declare P = pigment { checker pigment { P } pigment { P } }",
            ),
            "parts",
        ),
        (
            repeated(
                "#declare P = pigment { rgb 1 }",
                "#declare P = pigment { bozo pigment_map { [0 P] [1 P] } }",
            ),
            "parts",
        ),
        (
            repeated(
                "#declare N = normal { bumps }",
                "#declare N = normal { bozo normal_map { [0 N] [1 N] } }",
            ),
            "parts",
        ),
        (
            repeated(
                "#declare T = texture { pigment { rgb 1 } }",
                "#declare T = texture { checker texture { T } texture { T } }",
            ),
            "parts",
        ),
        (
            repeated(
                "#declare T = texture { pigment { rgb 1 } }",
                "#declare T = texture { T } texture { T }",
            ),
            "parts",
        ),
        (
            "#declare A = sphere { 0, 1 } #for (I, 0, 60) \
             #declare A = difference { object { A } object { A translate x } } #end object { A }"
                .to_owned(),
            "objects",
        ),
        (
            "#declare A = union { sphere { 0, 1 } sphere { 1, 1 } } #for (I, 0, 60) \
             #declare A = union { object { A } object { A clipped_by { object { A } } } } #end object { A }"
                .to_owned(),
            "objects",
        ),
        (
            "#declare A = sphere { 0, 1 } #for (I, 0, 60) \
             #declare A = union { object { A } object { A translate x } } #end #debug str(inside(A, x), 0, 0)"
                .to_owned(),
            "objects",
        ),
        // Things that grow without end.
        (repeated("", "sphere { 0, 1 }"), "objects"),
        (format!("union {{ {} }}", repeated("", "sphere { 0, 1 }")), "objects"),
        (format!("mesh {{ {} }}", repeated("", "triangle { 0, x, y }")), "parts"),
        (
            format!("mesh2 {{ vertex_vectors {{ 1e15 {} }} }}", repeated("", ", x")),
            "parts",
        ),
        (format!("polygon {{ 1e15 {} }}", repeated("", ", x, y, z")), "parts"),
        (
            format!("sphere {{ 0, 1 pigment {{ bozo {} }} }}", repeated("", "warp { turbulence 1 }")),
            "parts",
        ),
        (
            format!(
                "sphere {{ 0, 1 pigment {{ bozo color_map {{ {} }} }} }}",
                repeated("", "[0 rgb 1]")
            ),
            "parts",
        ),
        (
            format!(
                "sphere {{ 0, 1 {} }}",
                repeated("", "texture { pigment { bozo } }")
            ),
            "parts",
        ),
        (format!("#declare A = array {{ {} }}", repeated("", "1,")), "elements"),
        (format!("#declare S = spline {{ {} }}", repeated("", "0, x,")), "elements"),
        (
            repeated(
                "#declare A = array; #declare I = 0; #declare S = \"0123456789abcdef\";",
                "#declare A[I] = concat(S, str(I, 0, 0)); #declare I = I + 1; \
                 #declare S = substr(concat(S, S), 1, min(2 * strlen(S), 1000));",
            ),
            "",
        ),
        (
            repeated(
                "#declare D = dictionary; #declare I = 0;",
                "#declare D[str(I, 0, 0)] = I; #declare I = I + 1;",
            ),
            "elements",
        ),
        (repeated("", "light_source { 0, 1 }"), ""),
        (
            "#macro A(X) #local B = array[1000]; A(X + 1) #end A(1)".to_owned(),
            "",
        ),
    ];
    let before = peak_memory();
    for (text, expected) in &cases {
        let parsed = parse(
            Source::new("test.pov", text.as_str()),
            &small(),
            &mut MemoryHost::new(),
        );
        let errors: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
        assert!(
            parsed.scene.is_none() && errors[0].contains(expected),
            "{text}\n{errors:?}"
        );
        if let (Some(before), Some(after)) = (before, peak_memory()) {
            let grown = (after - before) >> 20;
            assert!(grown < 400, "{grown} MB after {text}");
        }
    }
}
