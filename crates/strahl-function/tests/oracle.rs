//! Values that POV-Ray 3.7 gives for expressions in `function(x, y, z) { }` at `<1.5, -2.5, 3.25>`, as printed by
//! `#debug str(f(1.5, -2.5, 3.25), 0, 17)`.

#![allow(
    clippy::excessive_precision,
    clippy::approx_constant,
    reason = "the digits are those that POV-Ray prints"
)]

use strahl_function::{Expr, Graph, Workspace};

type Build = fn(&mut Graph, [Expr; 3]) -> Expr;

/// NaN, made as in the measurements: 0 / (x - 1.5).
fn nan(g: &mut Graph, x: Expr) -> Expr {
    let (zero, c) = (g.constant(0.0), g.constant(1.5));
    let d = g.sub(x, c);
    g.div(zero, d)
}

/// A number that is not folded: `x * (number / 1.5)` would round, so `number + (x - 1.5)`, which is exact.
fn n(g: &mut Graph, number: f64) -> Expr {
    let x = g.parameter("x");
    let c = g.constant(1.5);
    let zero = g.sub(x, c);
    let number = g.constant(number);
    g.add(number, zero)
}

fn two(g: &mut Graph, op: fn(&mut Graph, Expr, Expr) -> Expr, a: f64, b: f64) -> Expr {
    let (a, b) = (n(g, a), n(g, b));
    op(g, a, b)
}

fn with_nan(g: &mut Graph, op: fn(&mut Graph, Expr, Expr) -> Expr, first: bool) -> Expr {
    let x = g.parameter("x");
    let (q, one) = (nan(g, x), n(g, 1.0));
    if first { op(g, q, one) } else { op(g, one, q) }
}

const INF: f64 = f64::INFINITY;
const NAN: f64 = f64::NAN;

/// POV-Ray's expression, how it is built here, what POV-Ray gives.
const MEASURED: &[(&str, Build, f64)] = &[
    (
        "x+y*z",
        |g, [x, y, z]| {
            let p = g.mul(y, z);
            g.add(x, p)
        },
        -6.625,
    ),
    (
        "x-y-z",
        |g, [x, y, z]| {
            let d = g.sub(x, y);
            g.sub(d, z)
        },
        0.75,
    ),
    (
        "x/y/z",
        |g, [x, y, z]| {
            let q = g.div(x, y);
            g.div(q, z)
        },
        -0.18461538461538460,
    ),
    (
        "-x*y",
        |g, [x, y, _]| {
            let m = g.neg(x);
            g.mul(m, y)
        },
        3.75,
    ),
    ("1/0", |g, _| two(g, Graph::div, 1.0, 0.0), INF),
    ("-1/0", |g, _| two(g, Graph::div, -1.0, 0.0), -INF),
    ("0/0", |g, _| two(g, Graph::div, 0.0, 0.0), NAN),
    ("mod(5,3)", |g, _| two(g, Graph::modulo, 5.0, 3.0), 2.0),
    ("mod(-5,3)", |g, _| two(g, Graph::modulo, -5.0, 3.0), -2.0),
    ("mod(5,-3)", |g, _| two(g, Graph::modulo, 5.0, -3.0), 2.0),
    ("mod(-7.5,2)", |g, _| two(g, Graph::modulo, -7.5, 2.0), -1.5),
    (
        "mod(1e20,3)",
        |g, _| {
            let (a, b) = (g.constant(1e20), n(g, 3.0));
            g.modulo(a, b)
        },
        1.0,
    ),
    ("mod(5,0)", |g, _| two(g, Graph::modulo, 5.0, 0.0), NAN),
    ("mod(N,1)", |g, _| with_nan(g, Graph::modulo, true), NAN),
    ("div(7.9,2)", |g, _| two(g, Graph::int_div, 7.9, 2.0), 3.0),
    (
        "div(-7.9,2)",
        |g, _| two(g, Graph::int_div, -7.9, 2.0),
        -3.0,
    ),
    (
        "int(-2.7)",
        |g, _| {
            let a = n(g, -2.7);
            g.int(a)
        },
        -2.0,
    ),
    (
        "floor(-2.7)",
        |g, _| {
            let a = n(g, -2.7);
            g.floor(a)
        },
        -3.0,
    ),
    (
        "ceil(-2.7)",
        |g, _| {
            let a = n(g, -2.7);
            g.ceil(a)
        },
        -2.0,
    ),
    (
        "floor(1e10+0.5)",
        |g, _| {
            let a = n(g, 1e10 + 0.5);
            g.floor(a)
        },
        1e10,
    ),
    (
        "ceil(1e10+0.5)",
        |g, _| {
            let a = n(g, 1e10 + 0.5);
            g.ceil(a)
        },
        1e10 + 1.0,
    ),
    (
        "sqrt(-1)",
        |g, _| {
            let a = n(g, -1.0);
            g.sqrt(a)
        },
        NAN,
    ),
    (
        "ln(0)",
        |g, _| {
            let a = n(g, 0.0);
            g.ln(a)
        },
        -INF,
    ),
    (
        "ln(-1)",
        |g, _| {
            let a = n(g, -1.0);
            g.ln(a)
        },
        NAN,
    ),
    (
        "ln(10)",
        |g, _| {
            let a = n(g, 10.0);
            g.ln(a)
        },
        2.30258509299404590,
    ),
    (
        "log(0)",
        |g, _| {
            let a = n(g, 0.0);
            g.log(a)
        },
        -INF,
    ),
    ("log(x)", |g, [x, ..]| g.log(x), 0.17609125905568124),
    (
        "log(2)",
        |g, _| {
            let a = n(g, 2.0);
            g.log(a)
        },
        0.30102999566398120,
    ),
    (
        "acos(2)",
        |g, _| {
            let a = n(g, 2.0);
            g.acos(a)
        },
        NAN,
    ),
    (
        "asin(-2)",
        |g, _| {
            let a = n(g, -2.0);
            g.asin(a)
        },
        NAN,
    ),
    (
        "acosh(0.5)",
        |g, _| {
            let a = n(g, 0.5);
            g.acosh(a)
        },
        NAN,
    ),
    ("acosh(x)", |g, [x, ..]| g.acosh(x), 0.96242365011920694),
    ("asinh(y)", |g, [_, y, _]| g.asinh(y), -1.64723114637109580),
    (
        "asinh(1e200)",
        |g, _| {
            let a = g.constant(1e200);
            g.asinh(a)
        },
        461.21016577936910608,
    ),
    (
        "atanh(2)",
        |g, _| {
            let a = n(g, 2.0);
            g.atanh(a)
        },
        NAN,
    ),
    (
        "atanh(0.5*x)",
        |g, [x, ..]| {
            let a = g.scaled(x, 0.5);
            g.atanh(a)
        },
        0.97295507452765662,
    ),
    (
        "atanh(1)",
        |g, _| {
            let a = n(g, 1.0);
            g.atanh(a)
        },
        INF,
    ),
    ("atan(x)", |g, [x, ..]| g.atan(x), 0.98279372324732905),
    ("tan(x)", |g, [x, ..]| g.tan(x), 14.10141994717171876),
    (
        "atan2(y,x)",
        |g, [x, y, _]| g.atan2(y, x),
        -1.03037682652431251,
    ),
    ("atan2(0,0)", |g, _| two(g, Graph::atan2, 0.0, 0.0), 0.0),
    (
        "atan2(0,-1)",
        |g, _| two(g, Graph::atan2, 0.0, -1.0),
        3.14159265358979312,
    ),
    (
        "exp(800)",
        |g, _| {
            let a = n(g, 800.0);
            g.exp(a)
        },
        INF,
    ),
    (
        "exp(-800)",
        |g, _| {
            let a = n(g, -800.0);
            g.exp(a)
        },
        0.0,
    ),
    ("exp(x)", |g, [x, ..]| g.exp(x), 4.48168907033806452),
    ("sinh(x)", |g, [x, ..]| g.sinh(x), 2.12927945509481731),
    ("cosh(x)", |g, [x, ..]| g.cosh(x), 2.35240961524324721),
    ("tanh(x)", |g, [x, ..]| g.tanh(x), 0.90514825364486640),
    (
        "degrees(x)",
        |g, [x, ..]| g.degrees(x),
        85.94366926962348430,
    ),
    ("radians(x)", |g, [x, ..]| g.radians(x), 0.02617993877991494),
    ("pow(y,2)", |g, [_, y, _]| g.powi(y, 2), 6.25),
    ("pow(x,7)", |g, [x, ..]| g.powi(x, 7), 17.0859375),
    (
        "pow(y,0.5)",
        |g, [_, y, _]| {
            let e = n(g, 0.5);
            g.pow(y, e)
        },
        NAN,
    ),
    (
        "pow(y,-1)",
        |g, [_, y, _]| {
            let e = n(g, -1.0);
            g.pow(y, e)
        },
        -0.4,
    ),
    ("pow(0,0)", |g, _| two(g, Graph::pow, 0.0, 0.0), 1.0),
    ("pow(0,-1)", |g, _| two(g, Graph::pow, 0.0, -1.0), INF),
    ("pow(-2,-3)", |g, _| two(g, Graph::pow, -2.0, -3.0), -0.125),
    (
        "pow(-8,1/3)",
        |g, _| two(g, Graph::pow, -8.0, 1.0 / 3.0),
        NAN,
    ),
    (
        "pow(N,0)",
        |g, [x, ..]| {
            let (a, b) = (nan(g, x), n(g, 0.0));
            g.pow(a, b)
        },
        1.0,
    ),
    ("pow(1,N)", |g, _| with_nan(g, Graph::pow, false), 1.0),
    ("min(x,y,z)", |g, xyz| g.min(&xyz), -2.5),
    ("max(x,y,z)", |g, xyz| g.max(&xyz), 3.25),
    (
        "min(N,1)",
        |g, _| with_nan(g, |g, a, b| g.min(&[a, b]), true),
        1.0,
    ),
    (
        "min(1,N)",
        |g, _| with_nan(g, |g, a, b| g.min(&[a, b]), false),
        NAN,
    ),
    (
        "max(N,1)",
        |g, _| with_nan(g, |g, a, b| g.max(&[a, b]), true),
        NAN,
    ),
    (
        "max(1,N)",
        |g, _| with_nan(g, |g, a, b| g.max(&[a, b]), false),
        1.0,
    ),
    (
        "min(2,N,1)",
        |g, [x, ..]| {
            let l = [n(g, 2.0), nan(g, x), n(g, 1.0)];
            g.min(&l)
        },
        1.0,
    ),
    (
        "min(N,2,3)",
        |g, [x, ..]| {
            let l = [nan(g, x), n(g, 2.0), n(g, 3.0)];
            g.min(&l)
        },
        2.0,
    ),
    (
        "select(y,1,2)",
        |g, [_, y, _]| {
            let (a, b) = (n(g, 1.0), n(g, 2.0));
            g.select_negative(y, a, b)
        },
        1.0,
    ),
    (
        "select(0,1,2)",
        |g, _| {
            let (s, a, b) = (n(g, 0.0), n(g, 1.0), n(g, 2.0));
            g.select_negative(s, a, b)
        },
        2.0,
    ),
    (
        "select(x-1.5,10,20,30)",
        |g, _| {
            let (s, a, b, c) = (n(g, 0.0), n(g, 10.0), n(g, 20.0), n(g, 30.0));
            g.select(s, a, b, c)
        },
        20.0,
    ),
    (
        "select(N,1,2)",
        |g, [x, ..]| {
            let (s, a, b) = (nan(g, x), n(g, 1.0), n(g, 2.0));
            g.select_negative(s, a, b)
        },
        2.0,
    ),
    (
        "select(N,1,2,3)",
        |g, [x, ..]| {
            let (s, a, b, c) = (nan(g, x), n(g, 1.0), n(g, 2.0), n(g, 3.0));
            g.select(s, a, b, c)
        },
        3.0,
    ),
    ("x<y", |g, [x, y, _]| g.less(x, y), 0.0),
    ("x>y", |g, [x, y, _]| g.greater(x, y), 1.0),
    (
        "x<=1.5",
        |g, [x, ..]| {
            let c = g.constant(1.5);
            g.less_equal(x, c)
        },
        1.0,
    ),
    (
        "x>=1.5",
        |g, [x, ..]| {
            let c = g.constant(1.5);
            g.greater_equal(x, c)
        },
        1.0,
    ),
    (
        "x=1.5",
        |g, [x, ..]| {
            let c = g.constant(1.5);
            g.equal(x, c)
        },
        1.0,
    ),
    (
        "x=1.5+1e-11",
        |g, [x, ..]| {
            let c = g.constant(1.5 + 1e-11);
            g.equal(x, c)
        },
        0.0,
    ),
    (
        "x!=1.5+1e-11",
        |g, [x, ..]| {
            let c = g.constant(1.5 + 1e-11);
            g.not_equal(x, c)
        },
        1.0,
    ),
    (
        "x<=1.5-1e-11",
        |g, [x, ..]| {
            let c = g.constant(1.5 - 1e-11);
            g.less_equal(x, c)
        },
        0.0,
    ),
    ("N<1", |g, _| with_nan(g, Graph::less, true), 0.0),
    ("N>1", |g, _| with_nan(g, Graph::greater, true), 1.0),
    ("N<=1", |g, _| with_nan(g, Graph::less_equal, true), 0.0),
    ("N>=1", |g, _| with_nan(g, Graph::greater_equal, true), 1.0),
    (
        "N=N",
        |g, [x, ..]| {
            let q = nan(g, x);
            g.equal(q, q)
        },
        0.0,
    ),
    (
        "N!=N",
        |g, [x, ..]| {
            let q = nan(g, x);
            g.not_equal(q, q)
        },
        1.0,
    ),
    ("1<N", |g, _| with_nan(g, Graph::less, false), 0.0),
    ("N&1", |g, _| with_nan(g, Graph::and, true), 1.0),
    ("x&0", |g, _| two(g, Graph::and, 1.5, 0.0), 0.0),
    ("0.5&0.4", |g, _| two(g, Graph::and, 0.5, 0.4), 1.0),
    (
        "1e-20&1",
        |g, _| {
            let (a, b) = (g.constant(1e-20), n(g, 1.0));
            g.and(a, b)
        },
        1.0,
    ),
    ("-3|0", |g, _| two(g, Graph::or, -3.0, 0.0), 1.0),
    ("0|0", |g, _| two(g, Graph::or, 0.0, 0.0), 0.0),
    (
        "sum(i,1,10,i)",
        |g, _| {
            let i = g.loop_variable();
            let (a, b) = (n(g, 1.0), n(g, 10.0));
            g.sum(i, a, b, i)
        },
        55.0,
    ),
    (
        "prod(i,1,5,i)",
        |g, _| {
            let i = g.loop_variable();
            let (a, b) = (n(g, 1.0), n(g, 5.0));
            g.prod(i, a, b, i)
        },
        120.0,
    ),
    (
        "sum(i,1,0,i)",
        |g, _| {
            let i = g.loop_variable();
            let (a, b) = (n(g, 1.0), n(g, 0.0));
            g.sum(i, a, b, i)
        },
        0.0,
    ),
    (
        "prod(i,1,0,i)",
        |g, _| {
            let i = g.loop_variable();
            let (a, b) = (n(g, 1.0), n(g, 0.0));
            g.prod(i, a, b, i)
        },
        1.0,
    ),
    (
        "sum(i,1.7,4.6,i)",
        |g, _| {
            let i = g.loop_variable();
            let (a, b) = (n(g, 1.7), n(g, 4.6));
            g.sum(i, a, b, i)
        },
        8.10000000000000142,
    ),
    (
        "sum(i,-1.5,1,i)",
        |g, _| {
            let i = g.loop_variable();
            let (a, b) = (n(g, -1.5), n(g, 1.0));
            g.sum(i, a, b, i)
        },
        -1.5,
    ),
    (
        "sum(i,N,3,i)",
        |g, [x, ..]| {
            let i = g.loop_variable();
            let (a, b) = (nan(g, x), n(g, 3.0));
            g.sum(i, a, b, i)
        },
        0.0,
    ),
    (
        "sum(i,1,N,i)",
        |g, [x, ..]| {
            let i = g.loop_variable();
            let (a, b) = (n(g, 1.0), nan(g, x));
            g.sum(i, a, b, i)
        },
        0.0,
    ),
    (
        "1/(-(x-1.5))",
        |g, _| {
            let z = n(g, 0.0);
            let m = g.neg(z);
            let one = g.constant(1.0);
            g.div(one, m)
        },
        -INF,
    ),
    (
        "1/max((x-1.5)*y,(x-1.5))",
        |g, [_, y, _]| {
            let z = n(g, 0.0);
            let m = g.mul(z, y);
            let k = g.max(&[m, z]);
            let one = g.constant(1.0);
            g.div(one, k)
        },
        -INF,
    ),
    (
        "1/min((x-1.5)*y,(x-1.5))",
        |g, [_, y, _]| {
            let z = n(g, 0.0);
            let m = g.mul(z, y);
            let k = g.min(&[m, z]);
            let one = g.constant(1.0);
            g.div(one, k)
        },
        -INF,
    ),
    (
        "1/min(x-1.5,(x-1.5)*y)",
        |g, [_, y, _]| {
            let z = n(g, 0.0);
            let m = g.mul(z, y);
            let k = g.min(&[z, m]);
            let one = g.constant(1.0);
            g.div(one, k)
        },
        INF,
    ),
];

#[test]
fn expressions_have_the_values_of_pov_ray() {
    let mut ws = Workspace::new();
    let p = [1.5, -2.5, 3.25];
    for (text, build, expected) in MEASURED {
        let mut g = Graph::new(["x", "y", "z"]);
        let xyz = g.xyz();
        let root = build(&mut g, xyz);
        let f = g.finish(root).unwrap();
        let value = f.value(&mut ws, &p);
        let agrees = if expected.is_finite() {
            (value - expected).abs() <= 1e-15 * expected.abs()
        } else {
            value == *expected || value.is_nan() && expected.is_nan()
        };
        assert!(agrees, "{text}: {value:?}, POV-Ray gives {expected:?}");
    }
}

/// Where this crate differs from POV-Ray on purpose: `int` and `div` have no 32-bit limit.
#[test]
fn whole_numbers_are_not_cut_to_32_bits() {
    let mut g = Graph::new(["x", "y", "z"]);
    let big = n(&mut g, 3e9);
    let whole = g.int(big);
    let f = g.finish(whole).unwrap();
    let value = f.value(&mut Workspace::new(), &[1.5, 0.0, 0.0]);
    assert_eq!(value, 3e9, "POV-Ray gives -2147483648");
}
