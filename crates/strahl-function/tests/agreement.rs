//! All ways to evaluate a function agree: batches and gradients bit by bit with points, bounds by containing them.

#![allow(clippy::unwrap_used, reason = "a test that unwraps fails as it should")]

use proptest::prelude::*;
use strahl_function::{BinaryOp, Bounds, Expr, Function, Graph, UnaryOp, Workspace};

const UNARY: [UnaryOp; 25] = [
    UnaryOp::Neg,
    UnaryOp::Abs,
    UnaryOp::Square,
    UnaryOp::Power(3),
    UnaryOp::Power(6),
    UnaryOp::Sqrt,
    UnaryOp::Floor,
    UnaryOp::Ceil,
    UnaryOp::Trunc,
    UnaryOp::Not,
    UnaryOp::Sin,
    UnaryOp::Cos,
    UnaryOp::Tan,
    UnaryOp::Asin,
    UnaryOp::Acos,
    UnaryOp::Atan,
    UnaryOp::Sinh,
    UnaryOp::Cosh,
    UnaryOp::Tanh,
    UnaryOp::Asinh,
    UnaryOp::Acosh,
    UnaryOp::Atanh,
    UnaryOp::Exp,
    UnaryOp::Ln,
    UnaryOp::Log10,
];
const BINARY: [BinaryOp; 14] = [
    BinaryOp::Add,
    BinaryOp::Sub,
    BinaryOp::Mul,
    BinaryOp::Div,
    BinaryOp::Min,
    BinaryOp::Max,
    BinaryOp::Mod,
    BinaryOp::Pow,
    BinaryOp::Atan2,
    BinaryOp::Less,
    BinaryOp::LessEqual,
    BinaryOp::Equal,
    BinaryOp::And,
    BinaryOp::Or,
];

/// One step of a random program: an operation on values made before.
type Step = (u8, u16, u16, u16, u16);

fn program() -> impl Strategy<Value = Vec<Step>> {
    prop::collection::vec(any::<Step>(), 1..40)
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -3.0..3.0,
        2 => (-4i32..5).prop_map(f64::from),
        1 => -1e6..1e6,
        1 => prop::sample::select(vec![
            0.0, -0.0, 1e-300, -1e-300, 1e300, f64::MAX, 5e-324, 0.5, std::f64::consts::PI,
        ]),
    ]
}

fn build(steps: &[Step], constants: &[f64]) -> Function {
    let mut g = Graph::new(["x", "y", "z"]);
    let mut values: Vec<Expr> = g.xyz().to_vec();
    for &c in constants {
        let e = g.constant(c);
        values.push(e);
    }
    for &(kind, a, b, c, d) in steps {
        let pick = |i: u16| values[usize::from(i) % values.len()];
        let (a, b, c, d) = (pick(a), pick(b), pick(c), pick(d));
        let kind = usize::from(kind) % (UNARY.len() + 2 * BINARY.len() + 3);
        let e = if let Some(&op) = UNARY.get(kind) {
            g.unary(op, a)
        } else if let Some(&op) = BINARY.get((kind - UNARY.len()) / 2) {
            g.binary(op, a, b)
        } else if kind.is_multiple_of(2) {
            g.select(a, b, c, d)
        } else {
            // A short loop whose length and body depend on what there is.
            let i = g.loop_variable();
            let (low, high) = (g.constant(-1.0), g.constant(3.0));
            let limited = g.min(&[b, high]);
            let to = g.max(&[limited, low]);
            let waves = g.mul(c, i);
            let body = g.sin(waves);
            g.sum(i, low, to, body)
        };
        values.push(e);
    }
    let root = *values.last().expect("not empty");
    g.finish(root).expect("small")
}

fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn batches_have_the_bits_of_points(
        steps in program(),
        constants in prop::collection::vec(number(), 3),
        points in prop::collection::vec([number(), number(), number()], 1..40),
    ) {
        let f = build(&steps, &constants);
        let mut ws = Workspace::new();
        let column = |i: usize| points.iter().map(|p| p[i]).collect::<Vec<f64>>();
        let columns = [column(0), column(1), column(2)];
        let mut values = vec![0.0; points.len()];
        f.values(&mut ws, &[&columns[0], &columns[1], &columns[2]], &mut values);
        for (p, v) in points.iter().zip(values) {
            prop_assert!(same(f.value(&mut ws, p), v), "{p:?}");
            prop_assert!(same(f.gradient(&mut ws, p).0, v), "{p:?}");
        }
    }

    #[test]
    fn bounds_contain_the_values(
        steps in program(),
        constants in prop::collection::vec(number(), 3),
        low in [number(), number(), number()],
        size in [0.0..2.0, 0.0..2.0, 0.0..2.0],
        inside in prop::collection::vec([0.0..=1.0, 0.0..=1.0, 0.0..=1.0], 8),
    ) {
        let f = build(&steps, &constants);
        let mut ws = Workspace::new();
        let axis = |i: usize| Bounds::new(low[i], low[i] + size[i]);
        let region = [axis(0), axis(1), axis(2)];
        let bounds = f.bounds(&mut ws, &region);
        for t in inside {
            let p: Vec<f64> = (0..3).map(|i| f64::min(low[i] + t[i] * size[i], region[i].max)).collect();
            let v = f.value(&mut ws, &p);
            prop_assert!(bounds.contains(v), "{v:e} at {p:?} is not in {bounds:?}");
        }
        // A point's bounds contain its value, signs of zero included.
        for p in [low, [0.0, -0.0, low[2]], [-0.0, low[1], 0.0]] {
            let v = f.value(&mut ws, &p);
            let bounds = f.bounds(&mut ws, &p.map(Bounds::point));
            prop_assert!(bounds.contains(v), "{v:e} at {p:?} is not in {bounds:?}");
        }
    }

    #[test]
    fn nothing_panics(
        steps in program(),
        constants in prop::collection::vec(any::<f64>(), 3),
        point in prop::collection::vec(any::<f64>(), 0..5),
        ends in prop::collection::vec((any::<f64>(), any::<f64>()), 0..5),
    ) {
        let f = build(&steps, &constants);
        let mut ws = Workspace::new();
        let v = f.value(&mut ws, &point);
        prop_assert!(same(f.gradient(&mut ws, &point).0, v));
        let region: Vec<Bounds> = ends.iter().map(|&(a, b)| Bounds::new(a, b)).collect();
        f.bounds(&mut ws, &region);
        let columns: Vec<&[f64]> = (0..point.len()).map(|i| &point[i..=i]).collect();
        let mut values = [0.0; 2];
        f.values(&mut ws, &columns, &mut values);
        prop_assert!(same(values[0], v));
    }
}

/// Builds with `x`, `y`, `z` and gives the value, the gradient and central differences.
fn slopes(build: impl Fn(&mut Graph, [Expr; 3]) -> Expr, p: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let mut g = Graph::new(["x", "y", "z"]);
    let xyz = g.xyz();
    let root = build(&mut g, xyz);
    let f = g.finish(root).expect("small");
    let mut ws = Workspace::new();
    let gradient = f.gradient(&mut ws, &p).1;
    let differences = std::array::from_fn(|i| {
        let (mut a, mut b) = (p, p);
        a[i] -= 1e-6;
        b[i] += 1e-6;
        (f.value(&mut ws, &b) - f.value(&mut ws, &a)) / (b[i] - a[i])
    });
    (gradient, differences)
}

#[test]
fn gradients_are_the_limits_of_differences() {
    let p = [0.37, 0.61, 0.83];
    for op in UNARY {
        let scale = if op == UnaryOp::Acosh { 4.0 } else { 1.0 };
        let (gradient, differences) = slopes(
            |g, [x, y, z]| {
                let xy = g.mul(x, y);
                let s = g.add(xy, z);
                let s = g.scaled(s, scale * 0.7);
                g.unary(op, s)
            },
            p,
        );
        for (a, b) in gradient.iter().zip(differences) {
            assert!((a - b).abs() < 1e-7 * (1.0 + b.abs()), "{op:?}: {a} {b}");
        }
    }
    for op in BINARY {
        let (gradient, differences) = slopes(
            |g, [x, y, z]| {
                let a = g.add(x, y);
                let b = g.mul(y, z);
                g.binary(op, a, b)
            },
            p,
        );
        for (a, b) in gradient.iter().zip(differences) {
            assert!((a - b).abs() < 1e-7 * (1.0 + b.abs()), "{op:?}: {a} {b}");
        }
    }
}

#[test]
fn gradients_go_through_loops_and_selects() {
    let (gradient, differences) = slopes(
        |g, [x, y, z]| {
            let i = g.loop_variable();
            let from = g.floor(y);
            let to = g.constant(6.0);
            let ix = g.mul(i, x);
            let s = g.sin(ix);
            let term = g.mul(s, z);
            let series = g.sum(i, from, to, term);
            let negative = g.neg(series);
            g.select_negative(series, negative, series)
        },
        [0.4, 1.3, 2.0],
    );
    for (a, b) in gradient.iter().zip(differences) {
        assert!((a - b).abs() < 1e-7 * (1.0 + b.abs()), "{a} {b}");
    }
}
