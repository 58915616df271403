//! What expressions give where POV-Ray's rules surprise.

use crate::common::{debug, errors};
use crate::language::values;

/// Of POV-Ray 3.7.0.10.
#[test]
fn numbers_that_count_as_zero_are_false() {
    let counted = debug(
        "#declare I = 1; #declare N = 0; #while (I) #declare I = I - 0.1; #declare N = N + 1; #end #debug str(N, 0, 0)",
    );
    assert_eq!(counted, "10");
    let list = [
        "(9.9e-11 ? 1 : 0)",
        "(1.01e-10 ? 1 : 0)",
        "(-1e-11 ? 1 : 0)",
        "(.3 - .1 - .2 ? 1 : 0)",
        "!1e-11",
        "(1e-11 & 1)",
        "(1e-11 | 0)",
    ];
    assert_eq!(values("", &list), [0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    assert_eq!(
        debug("#if (1e-11) #debug \"a\" #else #debug \"b\" #end"),
        "b"
    );
}

/// Of POV-Ray 3.7.0.10.
#[test]
fn vectors_are_compared_component_by_component() {
    for (comparison, measured) in [
        ("(<1, 2, 3> = <1, 2, 3>)", "1 1 1"),
        ("(x != y)", "1 1 0"),
        ("(1 = <1, 2, 3>) + 1", "2 1 1"),
        ("(<1, 2, 3> < <2, 2, 2>)", "1 0 0"),
        ("(2 <= <1, 2, 3>)", "0 1 1"),
        ("!<1e-11, 1, 0>", "1 0 1"),
    ] {
        let text = format!("#declare V = {comparison}; #debug vstr(3, V, \" \", 0, 0)");
        assert_eq!(debug(&text), measured, "{comparison}");
    }
}

#[test]
fn an_undefined_parameter_leaves_the_variable_of_the_caller() {
    let text = "#macro M(A) #undef A #ifdef (A) #debug \"A\" #end #end #declare Q = 1; M(Q) #ifdef (Q) #debug \"Q\" #end";
    assert_eq!(debug(text), "Q");
}

#[test]
fn words_of_later_versions_may_be_names_of_macros() {
    let text = "#macro cmap(V) V*2 #end #macro blend_mode(mixed) mixed #end #debug str(cmap(blend_mode(3)), 0, 0)";
    assert_eq!(debug(text), "6");
}

/// Of POV-Ray 3.7.0.10: wherever it stands.
#[test]
fn inverse_inverts_all_of_a_transformation() {
    let at = |items: &str| {
        values(
            &format!("#declare O = sphere {{ <1, 0, 0>, 1 transform {{ {items} }} }};"),
            &["min_extent(O).x", "min_extent(O).y", "min_extent(O).z"],
        )
    };
    let expected = at("rotate 30*y translate x inverse");
    for items in [
        "inverse rotate 30*y translate x",
        "rotate 30*y inverse translate x",
        "rotate 30*y inverse inverse translate x",
        "translate -x rotate -30*y",
    ] {
        for (found, expected) in at(items).iter().zip(&expected) {
            assert!(
                (found - expected).abs() < 1e-9,
                "{items}: {found} {expected}"
            );
        }
    }
}

/// Of POV-Ray 3.7.0.10.
#[test]
fn components_where_vectors_are_wanted_keep_the_others() {
    let setup = "#declare S = spline { linear_spline 0, <1, 2, 3> 1, <2, 4, 6> }; #declare V2 = <3, 4>; #declare F = 2;
        #declare V3 = <1, 2, 3>; #declare A = array[1] { <3, 4, 5> }; #declare C = rgb <0.1, 0.5, 0.9>; #declare W = V3.y;
        #macro M(Q) Q #end #macro N(Q) Q.y #end";
    for (scalar, measured) in [
        ("V3.y", "2 2 3"),
        ("-V3.y", "-2 2 3"),
        ("<1, 2, 3>.y", "2 2 3"),
        ("S(0).y", "2 2 3"),
        ("A[0].y", "4 4 5"),
        ("V2.y", "4 4 0"),
        ("x.x", "1 0 0"),
        ("C.green*2", "1 0.5 0.9"),
        ("V3.y*V3.z", "6 2 3"),
        ("V3.y/2", "1 2 3"),
        ("V3.y*F", "4 2 3"),
        ("V3.y - 1", "1 2 3"),
        ("F*V3.y", "4 4 4"),
        ("2*V3.y", "4 4 4"),
        ("(V3.y)", "2 2 2"),
        ("max(V3.y, 1)", "2 2 2"),
        ("V3.y + V3", "3 4 5"),
        ("V3 + V3.y", "3 4 5"),
        ("S(0).y*x", "2 0 0"),
        ("W", "2 2 2"),
        ("M(V3.y)", "2 2 2"),
        ("N(V3)", "2 2 3"),
    ] {
        let setup = format!("{setup} #declare O = sphere {{ 0, 1 translate {scalar} }};");
        let list = ["min_extent(O).x", "min_extent(O).y", "min_extent(O).z"];
        let found = values(&setup, &list);
        let measured = measured
            .split(' ')
            .map(|x| x.parse::<f64>().expect("a number"));
        for (found, measured) in found.iter().zip(measured) {
            assert!(
                (found + 1.0 - measured).abs() < 1e-9,
                "{scalar}: {found} {measured}"
            );
        }
    }
    let found = values(
        setup,
        &["vlength(V3.y)", "vdot(V3.y, <1, 1, 1>)", "W", "V3.y"],
    );
    assert_eq!(found, [17f64.sqrt(), 7.0, 2.0, 2.0]);
    assert_eq!(
        debug(&format!("{setup} #debug vstr(3, V3.y, \" \", 0, 0)")),
        "2 2 3"
    );
}

/// Of POV-Ray 3.7.0.10, which keeps extents with the digits of f32.
#[test]
fn extents_are_those_of_povray() {
    let rows = include_str!("data/extents.tsv").lines().skip(1);
    for row in rows {
        let (object, measured) = row.split_once('\t').expect("an object and numbers");
        let setup = format!("#declare O = {object};");
        let list = ["min_extent(O).x", "min_extent(O).y", "min_extent(O).z"];
        let others = ["max_extent(O).x", "max_extent(O).y", "max_extent(O).z"];
        let found = values(&setup, &[list, others].concat());
        let measured = measured
            .split('\t')
            .map(|x| x.parse::<f64>().expect("a number"));
        for (found, measured) in found.iter().zip(measured) {
            let near = 2e-7 * measured.abs().max(1.0);
            assert!(
                (found - measured).abs() <= near,
                "{object}: {found} {measured}"
            );
        }
    }
}

/// Of POV-Ray 3.7.0.10.
#[test]
fn what_macros_and_directives_yield_decides_what_a_function_is() {
    let setup = "#declare Grey = pigment { gradient x color_map { [0 rgb 0] [1 rgb 1] } } #macro P() pigment { Grey } #end
        #macro Of(H) pigment { H } #end #macro Q() pattern { gradient x } #end #macro T() transform { rotate 90*z scale 2 } #end
        #macro S() spline { linear_spline 0, <0, 1, 0> 1, <1, 0, 1> } #end #macro W() #if (1) P() #end #end #macro N() 2*x #end
        #macro Inside(O) function { pigment { object { O color rgb 0 color rgb 1 } } } #end";
    for (function, value, measured) in [
        ("{ P() }", "F(0.3, 0, 0).red", 0.3),
        ("{ Of(Grey) }", "F(0.3, 0, 0).red", 0.3),
        ("{ W() }", "F(0.3, 0, 0).red", 0.3),
        ("{ Q() }", "F(0.3, 0, 0)", 0.3),
        ("{ T() }", "F(0.3, 0.1, 0).x", -0.2),
        ("{ S() }", "F(0.3).y", 0.7),
        ("{ N() + 1 }", "F(0.3, 0, 0)", 1.6),
        (
            "{ #if (1) pattern { gradient x } #else x #end }",
            "F(0.3, 0, 0)",
            0.3,
        ),
        (
            "{ #if (0) pattern { gradient x } #else 2*x #end }",
            "F(0.3, 0, 0)",
            0.6,
        ),
        (
            "{ #local K = 2; pigment { Grey scale K } }",
            "F(0.3, 0, 0).red",
            0.15,
        ),
        (
            "{ #declare G = function { x*3 } pattern { gradient x scale G(1, 0, 0) } }",
            "F(0.3, 0, 0)",
            0.1,
        ),
        (
            "{ #include \"rand.inc\" pigment { Grey } #local K = 1; }",
            "F(0.3, 0, 0).red",
            0.3,
        ),
    ] {
        let setup = format!("{setup} #declare F = function {function}");
        let [found] = values(&setup, &[value])[..] else {
            panic!("one value: {function}");
        };
        assert!((found - measured).abs() < 1e-9, "{function}: {found}");
    }
    let setup = format!("{setup} #declare F = Inside(sphere {{ 0, 1 }})");
    let list = ["F(0.3, 0, 0).red", "F(1.3, 0, 0).red"];
    assert_eq!(values(&setup, &list), [1.0, 0.0]);
}

/// Of POV-Ray 3.7.0.10.
#[test]
fn what_macros_and_directives_yield_decides_what_a_picture_of_a_function_is() {
    let setup = "#include \"functions.inc\" #declare Grey = pigment { gradient x color_map { [0 rgb 0] [1 rgb 1] } }
        #macro P() pigment { Grey } #end #macro Q() pattern { gradient x } #end";
    for (function, measured) in [
        ("{ P() }", 0.5),
        ("{ Q() }", 0.5),
        ("{ #if (1) pigment { Grey } #end }", 0.5),
        ("{ #local K = 2; x/K }", 0.25),
    ] {
        let setup = format!(
            "{setup} #declare Made = pigment {{ image_map {{ function 11, 11 {function} }} }}"
        );
        let [found] = values(&setup, &["eval_pigment(Made, <0.5, 0.5, 0>).red"])[..] else {
            panic!("one value: {function}");
        };
        assert!((found - measured).abs() < 2e-5, "{function}: {found}");
    }
}

/// Of POV-Ray 3.7.0.10, which refuses them.
#[test]
fn functions_of_pigments_have_no_parameters() {
    let setup = "#macro P() pigment { gradient x } #end #declare F = function";
    for rest in ["(x, y, z) { P() }", "{ P() + 1 }"] {
        errors(&format!("{setup} {rest}"));
    }
}

/// Of POV-Ray 3.7.0.10.
#[test]
fn a_color_without_a_colour_is_a_black_value() {
    for (setup, measured) in [
        ("#declare C = color;", "0 0 0 0 0"),
        ("#declare C = colour;", "0 0 0 0 0"),
        ("#declare C = color filter 0.3;", "0 0 0 0.3 0"),
        ("#declare C = color alpha 0.5;", "0 0 0 0.5 0"),
        (
            "#declare A = array[2] { color, color } #declare C = A[1];",
            "0 0 0 0 0",
        ),
        ("#macro M() color #end #declare C = M();", "0 0 0 0 0"),
        (
            "#macro M(P, Q) #declare C = Q; #end M(color, color)",
            "0 0 0 0 0",
        ),
    ] {
        let text = format!("{setup} #debug vstr(5, C, \" \", 0, 1)");
        let found = debug(&text).replace(".0", "");
        assert_eq!(found, measured, "{setup}");
    }
    for setup in ["color Nope", "color \"a\"", "rgb", "color rgb", "color red"] {
        errors(&format!("sphere {{ 0, 1 pigment {{ {setup} }} }}"));
    }
}

/// POV-Ray 3.7.0.10: "Redeclaring functions is not allowed - #undef the function first!"
#[test]
fn a_function_may_be_declared_again() {
    let setup = "#declare F = function { x } #declare F = function { 2*x }";
    assert_eq!(values(setup, &["F(3, 0, 0)"]), [6.0]);
    let setup = "#macro M(K) #local F = function { K*x } #debug str(F(1, 0, 0), 0, 0) #end";
    assert_eq!(debug(&format!("{setup} M(1) M(2)")), "12");
}

/// POV-Ray 3.7.0.10: "No matching } in 'material', material found instead"
#[test]
fn a_material_may_contain_a_material() {
    let text = "#declare M = material { texture { pigment { rgb 1 } } } sphere { 0, 1 material { material { M } } }";
    assert_eq!(debug(text), "");
}
