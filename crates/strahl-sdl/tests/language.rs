//! Directives, macros, loops and scopes.

use crate::common::{debug, errors, parse_with};
use strahl_sdl::MemoryHost;

/// The values of several floats, by `#debug`.
pub(crate) fn values(setup: &str, expressions: &[&str]) -> Vec<f64> {
    let prints: String = expressions
        .iter()
        .map(|e| format!("#debug concat(str({e}, 0, 15), \" \")\n"))
        .collect();
    let text = debug(&format!("{setup}\n{prints}"));
    text.split_whitespace()
        .map(|w| w.parse().expect("a number"))
        .collect()
}

#[test]
fn branches_and_loops() {
    assert_eq!(debug("#if (1) #debug \"a\" #else #debug \"b\" #end"), "a");
    assert_eq!(
        debug("#if (0) #debug \"a\" #elseif (1) #debug \"b\" #else #debug \"c\" #end"),
        "b"
    );
    assert_eq!(
        debug(
            "#ifdef (A) #debug \"a\" #else #declare A = 1; #end #ifndef (A) #else #debug \"b\" #end"
        ),
        "b"
    );
    assert_eq!(
        debug("#declare I = 0; #while (I < 3) #debug str(I, 0, 0) #declare I = I + 1; #end"),
        "012"
    );
    assert_eq!(
        debug("#for (I, 3, 1, -1) #debug str(I, 0, 0) #end #debug str(I, 0, 0)"),
        "3210"
    );
    assert_eq!(
        debug("#for (I, 0, 1, 0.1) #debug \"x\" #end"),
        "xxxxxxxxxxx"
    );
    assert_eq!(
        debug("#for (I, 1, 9) #if (I > 3) #break #end #debug str(I, 0, 0) #end"),
        "123"
    );
    assert_eq!(debug("#for (I, 2, 1) #debug \"never\" #end"), "");
}

#[test]
fn braces_may_open_in_a_branch_and_close_behind_it() {
    let value = |text: &str| {
        let text = format!("{text} #debug concat(str(max_extent(U).x, 0, 1))");
        assert_eq!(debug(&text), "2.0", "{text}");
    };
    // Open Babel writes this.
    value(
        "#declare T = 1; #ifdef (T) #declare U = merge { #else #declare U = union { #end sphere { x, 1 } }",
    );
    value("#ifdef (T) #declare U = merge { #else #declare U = union { #end sphere { x, 1 } }");
    value("#if (1) #declare U = union { #end sphere { x, 1 } }");
    value("#declare U = union { sphere { x, 1 } #if (1) sphere { 0, 1 } } #else } #end");
    value("#macro Open() union { #end #declare U = Open() sphere { x, 1 } }");
    value("#macro Open() #declare U = union { #end Open() sphere { x, 1 } }");
    value("#macro Close() sphere { 0, 1 } } #end #declare U = union { sphere { x, 1 } Close()");
    value(
        "#switch (2) #case (1) #declare U = sphere { 0, 1 #break #case (2) #declare U = sphere { x, 1 #break #else #declare U = box { 0, 1 #end }",
    );
    value(
        "#declare I = 0; #while (I < 5) #declare I = I + 1; #declare U = union { #break #end sphere { x, 1 } }",
    );
    // A declaration without a semicolon still ends with its branch.
    assert_eq!(
        debug("#if (1) #declare A = 1 #else #declare A = 2 #end #debug str(A, 0, 0)"),
        "1"
    );
}

#[test]
fn switches_fall_through_until_a_break() {
    let switch = |n: i32| {
        debug(&format!(
            "#switch ({n}) #case (1) #debug \"1\" #case (2) #debug \"2\" #break #range (3, 5) #debug \"r\" #else #debug \"e\" #end"
        ))
    };
    assert_eq!(switch(1), "12");
    assert_eq!(switch(2), "2");
    assert_eq!(switch(4), "re");
    assert_eq!(switch(9), "e");
}

#[test]
fn nothing_leaks_out_of_a_declaration_without_semicolon() {
    assert_eq!(
        debug("#declare I = 0; #while (I < 3) #debug str(I, 0, 0) #declare I = I + 1 #end"),
        "012"
    );
    assert_eq!(
        debug("#macro M(P) #declare P = P + 1 #end #declare Q = 1; M(Q) #debug str(Q, 0, 0)"),
        "2"
    );
    assert_eq!(
        debug("#if (1) #declare A = 1 #else #declare A = 2 #end #debug str(A, 0, 0)"),
        "1"
    );
}

#[test]
fn macros_see_their_callers_names_and_change_variables_given() {
    // All values were measured with POV-Ray 3.7.
    let outer =
        "#macro Inner() #debug str(L, 0, 0) #end #macro Outer() #local L = 7; Inner() #end Outer()";
    assert_eq!(debug(outer), "7");
    assert_eq!(
        debug("#macro M(P) #declare P = 99; #end #declare Q = 5; M(Q) #debug str(Q, 0, 0)"),
        "99"
    );
    assert_eq!(
        debug("#macro M(P) #local P = 77; #end #declare Q = 5; M(Q) #debug str(Q, 0, 0)"),
        "77"
    );
    assert_eq!(
        debug(
            "#macro M(P) #declare P = 9; #end #declare A = array[2]{1, 2}; M(A[1]) #debug str(A[1], 0, 0)"
        ),
        "9"
    );
    assert_eq!(
        debug(
            "#macro M(P) #declare P = P + 1; #debug str(P, 0, 0) #end #declare Q = 3; M(Q + 0) #debug str(Q, 0, 0)"
        ),
        "43"
    );
    assert_eq!(
        debug(
            "#macro M() #local X = 1; #declare X = 2; #debug str(X, 0, 0) #end M() #ifdef (X) #debug \"global\" #end"
        ),
        "2"
    );
    let inner = "#macro I() #declare L = 8; #end #macro O() #local L = 7; I() #debug str(L, 0, 0) #end O() #ifdef (L) #debug \"global\" #end";
    assert_eq!(debug(inner), "8");
}

#[test]
fn locals_that_hold_what_a_macro_made_end_with_their_macro() {
    // The value is stored while the scope of the inner call is still open, and must not outlive that of the outer call.
    let text = "
        #macro Nest(N)
          #if (N < 3) #local Inner = Nest(N + 1) concat(\"(\", Inner, str(N, 0, 0), \")\") #else \"x\" #end
        #end
        #debug Nest(0)
        #ifdef (Inner) #debug \" leak\" #end";
    assert_eq!(debug(text), "(((x2)1)0)");
}

#[test]
fn macros_are_tokens() {
    assert_eq!(
        values(
            "#macro Three() 3 #end #macro Sum(A, B) (A + B) #end",
            &["Three() + 1", "2 * Sum(1, Sum(2, 3))"]
        ),
        [4.0, 12.0]
    );
    let text = "#macro Open() sphere { 0, #end #macro Close() 1 } #end Open() Close() Open() 2 }";
    let parsed = parse_with(&mut MemoryHost::new(), text);
    assert_eq!(parsed.scene.unwrap().objects.0.len(), 2);
    let factorial = "#macro F(N) #if (N < 2) 1 #else (N * F(N - 1)) #end #end";
    assert_eq!(values(factorial, &["F(10)"]), [3_628_800.0]);
    let deep = "#macro R(N) #if (N > 0) R(N - 1) #end #end R(5000)";
    assert_eq!(debug(deep), "");
}

#[test]
fn optional_parameters() {
    let text = "#macro M(A, optional B) #ifdef (local.B) #debug str(A + B, 0, 0) #else #debug str(A, 0, 0) #end #end M(1) M(1, 2) M(1,)";
    assert_eq!(debug(text), "131");
}

#[test]
fn macros_of_vmd_and_ase_without_commas() {
    let text = "#macro C(LOC, R COL) sphere { LOC, R pigment { color COL } } #end C(<1, 2, 3>, 0.5 rgb <1, 0, 0>) C(<1, 2, 3>0.5 <1, 0, 0>)";
    let scene = parse_with(&mut MemoryHost::new(), text).scene.unwrap();
    assert_eq!(scene.objects.0.len(), 2);
    let [a, b] = [0, 1].map(|i| scene.objects.0[i].material.clone().unwrap());
    assert_eq!(a, b);
}

#[test]
fn locals_end_with_their_macro_and_file() {
    assert_eq!(
        debug("#macro M() #local A = 1; #end M() #ifdef (A) #debug \"leak\" #end"),
        ""
    );
    let mut host = MemoryHost::new().with_file("a.inc", "#local A = 1; #declare B = A + 1;");
    let text = "#include \"a.inc\" #ifdef (A) #debug \"leak\" #end #debug str(B, 0, 0)";
    assert!(parse_with(&mut host, text).scene.is_some());
    assert_eq!(host.text(strahl_sdl::Stream::Debug), "2");
}

#[test]
fn arrays_dictionaries_and_tuples() {
    let setup = "#declare A = array[2][3]{{1, 2, 3}, {4, 5, 6}}; #declare B = A; #declare B[1][2] = 60;
        #declare G = array; #declare G[2] = 5; #declare D = dictionary { .One: 1, [\"Two\"]: <1, 2, 3> }; #declare D.Three = 3;
        #declare (P, Q) = (1, 2); #declare (P, Q) = (Q, P); #declare N = array mixed [2]{ 1, array[2]{7, 8} };";
    let list = [
        "A[1][2]",
        "B[1][2]",
        "dimensions(A)",
        "dimension_size(A, 2)",
        "dimension_size(G, 1)",
        "G[2]",
        "D.One",
        "D.Two.y",
        "D[\"Three\"]",
        "P",
        "Q",
        "N[1][1]",
    ];
    assert_eq!(
        values(setup, &list),
        [6.0, 60.0, 2.0, 3.0, 3.0, 5.0, 1.0, 2.0, 3.0, 2.0, 1.0, 8.0]
    );
    assert_eq!(
        values(
            "#declare A = array[2]; #declare A[0] = 1;",
            &["defined(A[0])", "defined(A[1])", "defined(Z)"]
        ),
        [1.0, 0.0, 0.0]
    );
    assert_eq!(
        debug("#declare A = 1; #undef A #ifdef (A) #debug \"still\" #end"),
        ""
    );
}

#[test]
fn files_are_written_and_read() {
    let mut host = MemoryHost::new().with_file("data.txt", "1, -2.5, <1, 2, 3>\n\"text\" 4");
    let text = "#fopen W \"out.txt\" write #write (W, \"a\", 1, \" \", <1, 2>) #fclose W
        #fopen W \"out.txt\" append #write (W, \"b\") #fclose W
        #fopen R \"data.txt\" read #read (R, A, B, V, T)
        #ifdef (R) #debug concat(str(A + B + V.z, 0, 1), T) #end
        #read (R, C) #ifndef (R) #debug str(C, 0, 0) #end #fclose R";
    let parsed = parse_with(&mut host, text);
    assert!(parsed.scene.is_some(), "{:#?}", parsed.diagnostics);
    assert_eq!(host.written("out.txt").as_deref(), Some(&b"a1 <1,2> b"[..]));
    assert_eq!(host.text(strahl_sdl::Stream::Debug), "1.5text4");
    assert!(errors("#fopen F \"missing.txt\" read")[0].contains("no file `missing.txt`"));
    assert!(errors("#write (F, 1)")[0].contains("not open for writing"));
}

/// As POV-Ray's, which `+K0.7` makes less than 0.7.
#[test]
fn the_clock_has_32_bits() {
    let mut options = strahl_sdl::Options::default();
    options.clock = 0.7;
    let mut host = MemoryHost::new();
    let text = "#debug concat(str((clock >= 0.7), 0, 0), str(int(clock * 10), 0, 0), str(clock * 1e9, 0, 0))";
    let source = strahl_sdl::Source::new("test.pov", text);
    let parsed = strahl_sdl::parse(source, &options, &mut host);
    assert!(parsed.scene.is_some(), "{:#?}", parsed.diagnostics);
    assert_eq!(host.text(strahl_sdl::Stream::Debug), "06699999988");
}

/// The numbers of rounds and the values are POV-Ray's.
#[test]
fn a_comma_behind_the_last_value_is_a_round_more() {
    for (file, names, read) in [
        ("1,2,3", "A", "1 2 3 "),
        ("1,2,3,\n", "A", "1 2 3 3 "),
        ("1,2,\n3,4,\n", "A, B", "1,2 3,4 3,4 "),
        ("1,2,3,\n", "A, B", "1,2 3,2 "),
    ] {
        let mut host = MemoryHost::new().with_file("data.txt", file);
        let values = names.replace(", ", ", 0, 0), \",\", str(");
        let text = format!(
            "#fopen F \"data.txt\" read #while (defined(F)) #read (F, {names}) #debug concat(str({values}, 0, 0), \" \") #end"
        );
        let parsed = parse_with(&mut host, &text);
        assert!(parsed.scene.is_some(), "{file}: {:#?}", parsed.diagnostics);
        assert_eq!(host.text(strahl_sdl::Stream::Debug), read, "{file}");
    }
}

/// As POV-Ray 3.7 writes them.
#[test]
fn numbers_in_files_have_six_digits() {
    let mut host = MemoryHost::new();
    let list = "1e5, 1e6, 123456, 999999.5, 0.0001, 0.00001, 1/7*1e-5, 1e15, 1e-100, true, -2.5, 1/3, 123456789, 2000/3";
    let values: String = list.split(", ").map(|v| format!(", {v}, \"|\"")).collect();
    let text = format!(
        "#fopen W \"out.txt\" write #write (W{values}, <1, 2, 3, 4, 1/3>, -0.5*<1, 2>) #fclose W"
    );
    let parsed = parse_with(&mut host, &text);
    assert!(parsed.scene.is_some(), "{:#?}", parsed.diagnostics);
    let written = host.written("out.txt").expect("a file");
    assert_eq!(
        String::from_utf8_lossy(&written),
        "100000|1e+06|123456|1e+06|0.0001|1e-05|1.42857e-06|1e+15|1e-100|1|-2.5|0.333333|1.23457e+08|666.667|\
         <1,2,3,4,0.333333> <-0.5,-1> "
    );
}

#[test]
fn objects_answer_questions() {
    // All values except those of the box and the transformed sphere were measured with POV-Ray 3.7.
    let setup = "#declare S = sphere { <1, 2, 3>, 2 }; #declare P = plane { y, 1 };
        #declare B = object { box { 0, 1 } scale 2 translate 5*x }; #declare N = <0, 0, 0>; #declare M = <1, 1, 1>;
        #declare H = trace(S, <1, 2, -10>, z, N); #declare K = trace(S, <10, 2, -10>, z, M);";
    let list = [
        "H.z",
        "N.z",
        "vlength(K)",
        "vlength(M)",
        "inside(S, <1, 2, 3>)",
        "inside(S, <10, 2, 3>)",
        "inside(P, -y)",
        "min_extent(S).x",
        "max_extent(S).z",
        "min_extent(P).x",
        "max_extent(P).y",
        "trace(B, <-1, 1, 1>, x).x",
        "max_extent(B).x",
        "inside(B, <6, 1, 1>)",
    ];
    let found = values(setup, &list);
    let expected = [
        1.0, -1.0, 0.0, 0.0, 1.0, 0.0, 1.0, -1.0, 5.0, -1e10, 1e10, 5.0, 7.0, 1.0,
    ];
    for ((name, found), expected) in list.iter().zip(found).zip(expected) {
        assert!((found - expected).abs() < 1e-9, "{name}: {found}");
    }
}

/// Every file in the folder is built in and is read without errors, except for unsupported features and missing includes.
/// there yet.
#[test]
fn built_in_files_are_read_without_errors() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("include");
    let mut files: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .filter_map(|entry| entry.unwrap().file_name().into_string().ok())
        .filter(|name| name.ends_with(".inc"))
        .collect();
    files.sort();
    assert!(files.len() > 10);
    for file in files {
        let text = format!("global_settings {{ assumed_gamma 1 }} #include \"{file}\"");
        let parsed = parse_with(&mut MemoryHost::new(), &text);
        let errors = parsed.diagnostics.iter().filter(|d| d.is_error());
        let errors: Vec<String> = errors
            .map(ToString::to_string)
            .filter(|text| {
                !text.contains("not supported yet") && !text.contains("there is no file")
            })
            .collect();
        assert!(errors.is_empty(), "{file}: {}", errors.join("\n"));
    }
}

#[test]
fn internal_functions_need_no_include() {
    let list = ["f_sphere(3, 0, 4, 1)", "F(0, 3, 4)", "defined(f_torus)"];
    let setup = "#declare F = function { f_sphere(x, y, z, 2) + 1 }";
    assert_eq!(values(setup, &list), [4.0, 4.0, 1.0]);
    assert_eq!(values("#include \"functions.inc\"", &list[..1]), [4.0]);
}

/// The values are POV-Ray's (measured).
#[test]
fn functions_know_x_as_u_and_y_as_v() {
    let setup = "
        #declare A = function(u, v) { x + y * v }
        #declare B = function(x, v, z) { u + y * v + z }
        #declare C = function { u + 10 * v }
        #declare D = function(k, y) { v * 10 + u }
        #declare E = function(k1, k2, z, y) { x + y * z + k1 * y + k2 }";
    let list = [
        "A(2, 3)",
        "B(2, 3, 5)",
        "C(7, 8, 9)",
        "D(7, 8)",
        "E(2, 3, 5, 7)",
    ];
    assert_eq!(values(setup, &list), [11.0, 16.0, 87.0, 80.0, 52.0]);
    let found = errors("#declare F = function { pow(x, 0.5, 2) }");
    assert!(found[0].contains("takes 2 arguments, found 3"), "{found:?}");
    let found = errors("#declare F = function(k) { k * t }");
    assert!(
        found[0].contains("`t` is not a parameter of this function"),
        "{found:?}"
    );
}

#[test]
fn a_name_from_an_include_not_included_is_recognised() {
    let found = errors("background { color Firebrick }");
    assert!(
        found[0].contains("write `#include \"colors.inc\"` first"),
        "{found:?}"
    );
}

#[test]
fn the_closest_name_of_all_includes_is_proposed() {
    let text = "#include \"glass.inc\"\nsphere { 0, 1 texture { Ruby_Glas } }";
    let found = errors(text);
    let expected = "did you mean `Ruby_Glass`? It is declared in textures.inc: write `#include \"textures.inc\"` first";
    assert!(found[0].contains(expected), "{found:?}");
    let found = errors("#include \"textures.inc\"\nsphere { 0, 1 texture { Ruby_Glas } }");
    assert!(found[0].contains("did you mean `Ruby_Glass`?"), "{found:?}");
}

#[test]
fn a_texture_within_a_texture_is_an_error() {
    for inner in [
        "texture { }",
        "pigment { rgb 1 } texture { pigment { rgb 1 } }",
    ] {
        let found = errors(&format!("sphere {{ 0, 1 texture {{ {inner} }} }}"));
        assert!(
            found[0].contains("a texture cannot contain a texture"),
            "{found:?}"
        );
    }
}

#[test]
fn errors_name_the_place_and_the_way_there() {
    let found = errors("#macro Ball(R)\n  sphere { 0, Radius }\n#end\nBall(1)\n");
    assert_eq!(found.len(), 1);
    let expected = "error: expected a number or vector, found the undeclared name `Radius`\n --> test.pov:2:15\n  |\n2 |   \
                    sphere { 0, Radius }\n  |               ^^^^^^\n  = in macro `Ball`, called at test.pov:4:1\n  = help: did you mean `radius`?";
    assert_eq!(found[0], expected);
}

#[test]
fn several_errors_are_found_in_one_run() {
    let text = "sphere { 0, }\nbox { 0, 1 }\nshpere { 0, 1 }\nplane { y, foo }\n#declare A = ;\nsphere { 0, 1 }\n#iff (1)\n";
    let found = errors(text);
    let lines: Vec<&str> = found
        .iter()
        .filter_map(|e| e.split("test.pov:").nth(1))
        .collect();
    let lines: Vec<&str> = lines.iter().filter_map(|l| l.split(':').next()).collect();
    assert_eq!(lines, ["1", "3", "4", "5", "7"]);
    assert!(found[1].contains("did you mean `sphere`?"));
}

#[test]
fn a_warning_at_many_places_is_shown_three_times() {
    let text = "sphere { 0, 1 radiosity { importance 1 } }\n".repeat(300);
    let parsed = parse_with(&mut MemoryHost::default(), &text);
    assert_eq!(parsed.diagnostics.len(), 3);
    assert_eq!(parsed.diagnostics[2].hints, ["the same at 297 more places"]);
    // In a loop it is one place.
    let text = format!(
        "#for (I, 1, 300) {} #end",
        text.lines().next().expect("a line")
    );
    let parsed = parse_with(&mut MemoryHost::default(), &text);
    assert_eq!(parsed.diagnostics.len(), 1);
}

#[test]
fn an_error_in_a_loop_is_told_once() {
    let found = errors("#for (I, 1, 100) sphere { 0, Nope } #end");
    assert_eq!(found.len(), 1, "{found:#?}");
    assert_eq!(
        errors("object { #for (I, 1, 100) sphere { 0, Nope } #end }").len(),
        1
    );
}

#[test]
fn an_array_may_be_followed_by_a_directive_that_fills_it() {
    let text = "#declare A = array[2]\n#declare A[0] = 1;\n#declare A[1] = 2;\n#debug str(A[0] + A[1], 0, 0)";
    assert_eq!(debug(text), "3");
}

#[test]
fn strings_are_compared() {
    let setup = "#declare S = \"ab\"; #declare A = array[1] { \"x\" }";
    let found = values(
        setup,
        &[
            "(S = \"ab\")",
            "(S != \"\")",
            "(\"a\" < \"b\")",
            "(\"a\" >= \"b\")",
            "(concat(S, \"\") = S ? 3 : 4)",
            "(A[0] = \"x\") + 2",
        ],
    );
    assert_eq!(found, [1.0, 1.0, 1.0, 0.0, 3.0, 3.0]);
    assert!(errors("#declare A = \"a\" + 1;")[0].contains("expected"));
    assert!(errors("sphere { \"a\", 1 }")[0].contains("the string \"a\""));
}

#[test]
fn a_comma_may_follow_the_last_component() {
    let found = values("#declare V = <1, 2, 3,> + <1, 1,>;", &["V.x", "V.y", "V.z"]);
    assert_eq!(found, [2.0, 3.0, 3.0]);
    assert!(!errors("#declare V = <1,>;").is_empty());
}

#[test]
fn some_directives_do_without_their_sign() {
    let text = "declare A = 3; version 3.7; default { pigment { rgb 1 } } #debug str(A, 0, 0) # ; sphere { 0, A # }";
    let mut host = MemoryHost::new();
    let parsed = parse_with(&mut host, text);
    assert_eq!(host.text(strahl_sdl::Stream::Debug), "3");
    assert_eq!(parsed.scene.expect("no errors").objects.0.len(), 1);
    let messages: Vec<&str> = parsed
        .diagnostics
        .iter()
        .map(|d| d.message.as_str())
        .collect();
    assert_eq!(messages.len(), 5, "{messages:?}");
    assert!(
        messages.iter().all(|m| m.contains("without")),
        "{messages:?}"
    );
}

#[test]
fn new_words_are_names_once_they_are_declared() {
    let text = "
        #declare prefix = \"a\"; #declare tau = 5; #local obj = array[1] { 7 };
        #macro Twice(mixed, potential) 2 * mixed + potential #end
        #for (suffix, 1, 2) #debug str(suffix, 0, 0) #end
        #debug concat(prefix, str(tau, 0, 0), str(obj[0], 0, 0), str(Twice(3, 4), 0, 0))";
    assert_eq!(debug(text), "12a5710");
    // Before that they have their meaning of 3.8.
    assert_eq!(debug("#debug str(tau, 0, 2)"), "6.28");
    assert_eq!(
        debug("#declare A = dictionary; #declare A.b = 1; #debug str(A.b, 0, 0)"),
        "1"
    );
    assert!(!errors("#declare sphere = 1;").is_empty());
}

#[test]
fn functions_of_splines_and_transformations() {
    let setup = "
        #declare S = function { spline { linear_spline 0, <1, 2, 3> 1, <4, 5, 6, 7> } }
        #declare F = function(q) { S(q).y + S(q).t + S(q).transmit }
        #declare T = function { transform { rotate z * 90 translate <1, 2, 3> } }
        #declare G = function(x, y, z) { T(x, y, z).y + 1 }";
    let found = values(
        setup,
        &[
            "S(0.5).z",
            "F(0.5)",
            "T(1, 0, 0).x",
            "(T(1, 0, 0) * 2).z",
            "G(1, 0, 0)",
        ],
    );
    let expected = [4.5, 7.0, 1.0, 6.0, 4.0];
    let close = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-12;
    assert!(found.iter().zip(&expected).all(close), "{found:?}");
    assert!(
        errors(&format!("{setup} #declare H = function(q) {{ S(q) }}"))[0].contains("component")
    );
    assert!(
        errors(&format!("{setup} #declare H = function(q) {{ T(q).x }}"))[0].contains("arguments")
    );
}

#[test]
fn media_around_everything_are_named_as_missing() {
    let parsed = parse_with(
        &mut MemoryHost::new(),
        "media { scattering { 1, 1 } } sphere { 0, 1 }",
    );
    assert_eq!(parsed.scene.expect("no errors").objects.0.len(), 1);
    assert!(
        parsed.diagnostics[0]
            .message
            .contains("`media` is not supported")
    );
}

#[test]
fn division_by_zero_is_told_and_goes_on() {
    let parsed = parse_with(
        &mut MemoryHost::new(),
        "#declare A = 1 / 0; sphere { 0, 1 }",
    );
    assert_eq!(parsed.scene.expect("no errors").objects.0.len(), 1);
    assert!(parsed.diagnostics[0].message.contains("division by zero"));
}

/// The lines and texts of the warnings of a scene without errors.
fn warnings(text: &str) -> Vec<(u32, String)> {
    let parsed = parse_with(&mut MemoryHost::new(), text);
    assert!(parsed.scene.is_some(), "{:?}", parsed.diagnostics);
    let said = parsed.diagnostics.into_iter();
    said.map(|d| (d.span.line, d.message)).collect()
}

/// Lines and rules as measured with POV-Ray, which tells a use in a loop once for each round.
#[test]
fn a_deprecated_name_is_told_where_it_is_used() {
    let lines = |text: &str| -> Vec<u32> { warnings(text).iter().map(|w| w.0).collect() };
    let said = warnings("#declare deprecated \"use B\" A = 1;\n#declare B = A;");
    assert_eq!(said, [(2, "`A` is deprecated: use B".to_owned())]);
    let said = warnings("#declare deprecated once A = 1;\n#declare B = 2 * A;\n#declare C = A;");
    let own = "`A` is deprecated: its author advises against using it";
    assert_eq!(said, [(2, own.to_owned())]);
    let said = warnings("#declare deprecated concat(\"a\", \"b\") A = 1;\n#declare B = <1, A, 2>;");
    assert_eq!(said, [(2, "`A` is deprecated: ab".to_owned())]);

    let begin = "#declare deprecated \"old\" A = 1;\n";
    for (text, expected) in [
        ("#declare B = A;\n#declare B = <A, 1>;", &[2, 3][..]),
        (
            "#for (I, 1, 3) #declare B = A; #end\n#declare B = A + 1;",
            &[2, 3],
        ),
        ("#ifdef (A) #end #ifndef (A) #end #if (0) A #end", &[]),
        // A new value is a use and changes nothing, and so is a local name like it.
        ("#declare A = 2;\n#declare B = A;", &[2, 3]),
        ("#undef A\n#declare A = 2;\n#declare B = A;", &[2]),
        // A parameter is told at the call.
        (
            "#macro M(X)\n#declare B = X + X;\n#declare X = 1;\n#end\nM(A)",
            &[6],
        ),
        (
            "#declare F = function(x) { x + A }\n#declare B = F(1);",
            &[2],
        ),
        ("#macro M()\n#local A = 2;\n#declare B = A;\n#end M()", &[3]),
        ("#declare D = dictionary { .A: 1 };\n#declare B = D.A;", &[]),
    ] {
        assert_eq!(lines(&format!("{begin}{text}")), expected, "{text}");
    }
    for (kind, value, used) in [
        ("sphere", "sphere { 0, 1 }", "object { A }"),
        (
            "texture",
            "texture { pigment { rgb 1 } }",
            "sphere { 0, 1 texture { A } }",
        ),
        (
            "pigment",
            "pigment { rgb 1 }",
            "sphere { 0, 1 pigment { A } }",
        ),
        ("colour", "rgb 1;", "sphere { 0, 1 pigment { A } }"),
        ("string", "\"s\"", "#declare B = concat(A, \"x\");"),
        ("array", "array[2] { 1, 2 }", "#declare A[0] = 2;"),
        ("function", "function(x) { x }", "#declare B = A(2);"),
    ] {
        let text = format!("#declare deprecated \"old\" A = {value}\n\n{used}");
        assert_eq!(lines(&text), [3], "{kind}");
    }
    // Only the first declaration of a name counts.
    let known = "#declare A = 1;\n#declare deprecated \"old\" A = 2;\n#declare B = A;";
    assert!(lines(known).is_empty());
    let twice = "#declare deprecated once \"first\" A = 1;\n#declare deprecated \"second\" A = 2;\n#declare B = A;";
    assert_eq!(
        warnings(twice),
        [(2, "`A` is deprecated: first".to_owned())]
    );
}

/// As in POV-Ray (measured), which finds no component then.
#[test]
fn modifiers_of_a_blob_stand_behind_its_components() {
    for text in [
        "blob { sturm sphere { 0, 1, 1 } }",
        "blob { threshold 0.5 hierarchy off sphere { 0, 1, 1 } }",
        "blob { threshold 0.5 pigment { rgb 1 } sphere { 0, 1, 1 } }",
    ] {
        let found = errors(text);
        assert!(
            found.len() == 1 && found[0].contains("expected a component of the blob"),
            "{text}: {found:?}"
        );
    }
    assert_eq!(
        errors("blob { sphere { 0, 1, 1 } sturm sphere { x, 1, 1 } }").len(),
        1
    );
}
