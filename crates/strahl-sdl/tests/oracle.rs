//! Expressions evaluated by POV-Ray 3.7 and by strahl.

use crate::common::{debug, tool};
use std::process::Command;

const SETUP: &str = "
#version 3.7;
global_settings { assumed_gamma 1.0 }
#declare A = array[2][3]{{1, 2, 3}, {4, 5, 6}};
#declare C = color rgbft <0.125, 0.25, 0.375, 0.5, 0.75>;
#declare R = seed(42);
#declare F = function(x, y) { x * y + sin(x) - select(y, 1, 2, 3) + 7 * (x > y) }
#declare L = function(x, y) { 1 | x & y }
#declare G = function { pow(x, 2) + F(y, z) * max(x, y, z) + sum(i, 1, 3, i * x) }
#declare S = spline { natural_spline 0, <0, 1, 2> 1, <2, 3, 1> 3, <1, 1, 1> }
#declare Text = \"Strahl\";
#macro Twice(X) (2 * X) #end
";

/// Floats.
const FLOATS: &[&str] = &[
    "1 + 2 * 3 - 4 / 5",
    "(1 + 2) * (3 - 4) / 5",
    "-2 - -3",
    "10 - 2 - 3",
    "100 / 10 / 5",
    "2 * -3",
    "-(1 + 2)",
    "+5",
    "!0",
    "!3 + 1",
    "(1 < 2)",
    "(2 <= 2)",
    "(1 > 2)",
    "(3 >= 4)",
    "(1 = 1)",
    "(1 != 1)",
    "(1 & 0)",
    "(1 | 0)",
    "(1 | 0 & 0)",
    "(1 < 2 & 3 < 4)",
    "(1 ? 2 : 3)",
    "(0 ? 2 : 3)",
    "(0 ? 2 : 1 ? 4 : 5)",
    "(1e-11 = 0)",
    "(1e-9 = 0)",
    "(1e-11 > 0)",
    "(-1e-11 < 0)",
    "(0 >= 1e-11)",
    "(0 >= 1e-9)",
    "(1 = 1 + 5e-11)",
    "abs(-3.5)",
    "acos(0.3)",
    "acos(-2)",
    "acosh(1.7)",
    "asin(0.3)",
    "asin(2)",
    "asinh(0.7)",
    "atan2(1, -2)",
    "atan2(-1, 0)",
    "atan2(0, -1)",
    "atanh(0.4)",
    "ceil(1.2)",
    "ceil(-1.2)",
    "cos(1)",
    "cosh(1)",
    "degrees(1)",
    "div(7, 2)",
    "div(-7, 2)",
    "exp(1.5)",
    "floor(1.8)",
    "floor(-1.2)",
    "int(2.7)",
    "int(-2.7)",
    "ln(5)",
    "log(5)",
    "max(1, 2, 3)",
    "min(3, 2, 1)",
    "max(-1, -2)",
    "mod(7, 3)",
    "mod(-7, 3)",
    "mod(7.5, -2)",
    "pow(2, 0.5)",
    "pow(2, 10)",
    "pow(-2, 3)",
    "radians(90)",
    "select(-1, 1, 2)",
    "select(0, 1, 2)",
    "select(1, 1, 2)",
    "select(-1, 1, 2, 3)",
    "select(0, 1, 2, 3)",
    "select(1, 1, 2, 3)",
    "sin(1)",
    "sinh(1)",
    "sqrt(2)",
    "tan(1)",
    "tanh(1)",
    "vdot(<1, 2, 3>, <4, 5, 6>)",
    "vlength(<3, 4, 12>)",
    "vlength(2)",
    "bitwise_and(12, 10)",
    "bitwise_or(12, 10)",
    "bitwise_xor(12, 10)",
    "asc(\"A\")",
    "asc(\"\")",
    "strlen(Text)",
    "strcmp(\"a\", \"b\")",
    "strcmp(Text, \"Strahl\")",
    "strcmp(\"a\", \"A\")",
    "strcmp(\"\", \"a\")",
    "strcmp(\"b\", \"abc\")",
    "(Text = \"Strahl\")",
    "(Text < \"Stein\") + 1",
    "val(\"-12.5\")",
    "val(\"3e2\")",
    "dimensions(A)",
    "dimension_size(A, 1)",
    "dimension_size(A, 2)",
    "A[1][2]",
    "A[0.9999999999][0]",
    "C.red",
    "C.green",
    "C.filter",
    "C.transmit",
    "C.gray",
    "<1, 2, 3>.x",
    "<1, 2, 3>.z",
    "(<1, 2, 3> * 2 + x).x",
    "pi",
    "true",
    "off",
    "clock",
    "defined(A)",
    "defined(Nothing)",
    "rand(R)",
    "rand(R)",
    "rand(R) + rand(R)",
    "F(2, 3)",
    "F(-1, -2)",
    "G(1, 2, 3)",
    "L(1, 0)",
    "(1 | 1 & 0)",
    "(0 | 1 & 0 | 1)",
    "(3 > 2 > 1)",
    "(0 = 1 < 2)",
    "G(0.5, -2, 0)",
    "Twice(3) + 1",
    "Twice(1 + 2)",
    "S(0.5).x",
    "S(2).y",
    "S(9).z",
    "S(-1).x",
];

/// Vectors of three.
const VECTORS: &[&str] = &[
    "x + 2 * y - z",
    "<1, 2, 3> * <4, 5, 6>",
    "<1, 2, 3> / 2",
    "1 / <1, 2, 4>",
    "-<1, 2, 3>",
    "<1, 2, 3> + 1",
    "2 * <1, 2, 3> * x",
    "vrotate(<1, 2, 3>, <30, 40, 50>)",
    "vrotate(x, 90 * z)",
    "vaxis_rotate(<1, 2, 3>, <1, 1, 1>, 30)",
    "vaxis_rotate(x, 2 * y, -45)",
    "vcross(<1, 2, 3>, <4, 5, 6>)",
    "vnormalize(<1, 2, 3>)",
    "S(0.25)",
    "S(1.75)",
    "rgb <1, 2, 3> * 0.5",
    "rgb 0.5 + x",
    "srgb <0.5, 0.25, 0.02>",
    "vturbulence(2, 0.5, 6, <1.1, 2.2, 3.3>)",
];

/// Strings.
const STRINGS: &[&str] = &[
    "str(pi, 0, 3)",
    "str(pi, 8, 2)",
    "str(-pi, -8, 2)",
    "str(1e10, 0, -1)",
    "str(0.5, 0, 0)",
    "str(1.5, 0, 0)",
    "str(2.5, 0, 0)",
    "str(-0.4, 0, 0)",
    "str(123456789, 3, 1)",
    "vstr(3, <1, 2, 3>, \", \", 0, 2)",
    "vstr(2, <1, 2, 3>, \"\", 5, 1)",
    "vstr(5, C, \"|\", 0, 1)",
    "vstr(1, 5, \",\", 0, 2)",
    "vstr(3, 5, \",\", 0, 2)",
    "vstr(2.9, 5, \",\", 0, 2)",
    "vstr(7, <1, 2>, \",\", 0, 2)",
    "vstr(-3, <1, 2, 3>, \",\", 0, 2)",
    "concat(Text, \"!\", str(1, 0, 0))",
    "substr(Text, 2, 3)",
    "strupr(Text)",
    "strlwr(Text)",
    "chr(65)",
    "datetime(0)",
    "datetime(7000.25, \"%Y %m %d %H %M %S %j %y %% %p %I %a %A %b %B %c %x %X\")",
    "concat(\"a\\tb\", \"\\\\\", \"\\\"\")",
];

#[test]
fn expressions_have_povrays_values() {
    let Some(povray) = tool("povray") else {
        return;
    };
    let mut text = SETUP.to_owned();
    let mut add = |value: String| {
        text.push_str(&format!("#debug concat(\"<<\", {value}, \">>\\n\")\n"));
    };
    FLOATS.iter().for_each(|e| add(format!("str({e}, 0, 11)")));
    STRINGS.iter().for_each(|e| add((*e).to_owned()));
    for expression in VECTORS {
        // POV-Ray accepts colour keywords only at the beginning of a value.
        text.push_str(&format!("#declare V = {expression};\n"));
        text.push_str("#debug concat(\"<<\", vstr(3, V, \",\", 0, 11), \">>\\n\")\n");
    }
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("expressions.pov");
    std::fs::write(&scene, &text).unwrap();
    let run = Command::new(povray)
        .args(["-D", "+W4", "+H4", "-F", "-GS", "-GW", "-GR"])
        .arg(format!("+I{}", scene.display()))
        .current_dir(folder.path())
        .output()
        .unwrap();
    let output = String::from_utf8_lossy(&run.stderr).into_owned();
    let values = |text: &str| -> Vec<String> {
        // POV-Ray breaks long lines after 80 characters; no value here contains a line break.
        let text = text.replace("\n ", " ").replace('\n', "");
        let parts = text.split("<<").skip(1);
        parts
            .filter_map(|p| p.split(">>").next())
            .map(str::to_owned)
            .collect()
    };
    let (expected, found) = (values(&output), values(&debug(&text)));
    let names: Vec<&&str> = FLOATS.iter().chain(STRINGS).chain(VECTORS).collect();
    assert_eq!(expected.len(), names.len(), "{output}");
    let mut wrong = vec![];
    for ((name, expected), found) in names.iter().zip(&expected).zip(&found) {
        // POV-Ray's colours have single precision.
        let tolerance = if name.contains("srgb") { 1e-8 } else { 2e-11 };
        if !same(expected, found, tolerance) {
            wrong.push(format!("{name}: POV-Ray {expected}, here {found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(found.len(), names.len());
}

/// Equal texts, or lists of numbers that differ by no more than the tolerance.
fn same(a: &str, b: &str, tolerance: f64) -> bool {
    let close = |(a, b): (&str, &str)| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= tolerance * (1.0 + a.abs()),
        _ => false,
    };
    a == b
        || a.split(',').count() == b.split(',').count() && a.split(',').zip(b.split(',')).all(close)
}
