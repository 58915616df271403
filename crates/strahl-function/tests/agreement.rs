//! All ways to evaluate a function agree: batches and gradients bit by bit with points, bounds by containing them.

#![allow(clippy::unwrap_used, reason = "a test that unwraps fails as it should")]

use proptest::prelude::*;
use strahl_function::{BinaryOp, Bounds, Expr, Function, Graph, Rates, UnaryOp, Workspace};

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
const BINARY: [BinaryOp; 15] = [
    BinaryOp::Add,
    BinaryOp::Sub,
    BinaryOp::Mul,
    BinaryOp::Div,
    BinaryOp::Min,
    BinaryOp::Max,
    BinaryOp::Mod,
    BinaryOp::Triangle,
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

fn rate() -> impl Strategy<Value = f64> {
    prop_oneof![3 => -1.0..1.0, 1 => prop::sample::select(vec![-1.0, 0.0, 1e-3])]
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
    fn values_change_as_fast_as_their_rates_say(
        steps in program(),
        constants in prop::collection::vec(number(), 3),
        start in [number(), number(), number()],
        way in [rate(), rate(), rate()],
        length in prop::sample::select(vec![1e-6, 1e-3, 0.03, 0.5]),
        inside in prop::collection::vec(0.0..=1.0, 6),
    ) {
        let f = build(&steps, &constants);
        let mut ws = Workspace::new();
        // Around the exact point of the line.
        let at = |s: f64| [0, 1, 2].map(|i| {
            let step = way[i] * s;
            let x = start[i] + step;
            if step == 0.0 {
                Bounds::point(x)
            } else {
                Bounds::new(x.next_down().next_down(), x.next_up().next_up())
            }
        });
        let (first, last) = (at(0.0), at(length));
        let region = [0, 1, 2].map(|i| first[i].hull(last[i]));
        let (values, rate) = f.rate(&mut ws, &region, &way);
        prop_assert_eq!(values, f.bounds(&mut ws, &region));
        if rate.nan {
            return Ok(());
        }
        let mut before: Option<(f64, Bounds)> = None;
        let mut places: Vec<f64> = inside.iter().map(|t| t * length).collect();
        places.sort_by(f64::total_cmp);
        for s in places {
            let value = f.bounds(&mut ws, &at(s));
            prop_assert!(!value.nan, "no number at {s}");
            if let Some((s0, v0)) = before {
                let (low, high) = (rate.min * (s - s0), rate.max * (s - s0));
                // The true change is between these.
                let (least, most) = (value.min - v0.max, value.max - v0.min);
                let room = 1e-14 * (least.abs() + most.abs() + v0.max.abs()) + 1e-300;
                // Infinite values that don't change have no difference.
                prop_assert!(!(least - room > high), "{least:e} {high:e} {rate:?}");
                prop_assert!(!(most + room < low), "{most:e} {low:e} {rate:?}");
            }
            before = Some((s, value));
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
        f.rate(&mut ws, &region, &point);
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
fn rates_tell_where_a_function_is_monotone() {
    let rate = |build: &dyn Fn(&mut Graph, [Expr; 3]) -> Expr, from: f64, to: f64| {
        let mut g = Graph::new(["x", "y", "z"]);
        let xyz = g.xyz();
        let root = build(&mut g, xyz);
        let f = g.finish(root).unwrap();
        assert_eq!(f.rates(), Rates::OfBoxes);
        let still = Bounds::point(0.5);
        let region = [Bounds::new(from, to), still, still];
        f.rate(&mut Workspace::new(), &region, &[1.0, 0.0, 0.0]).1
    };
    let wave = |g: &mut Graph, [x, _, _]: [Expr; 3]| g.sin(x);
    let rising = rate(&wave, -1.0, 1.0);
    assert!(rising.min > 0.5 && rising.max < 1.01, "{rising:?}");
    assert!(rate(&wave, 1.0, 2.0).min < 0.0);
    let corner = |g: &mut Graph, [x, y, _]: [Expr; 3]| {
        let larger = g.max(&[x, y]);
        g.sub(larger, x)
    };
    let level = rate(&corner, 0.6, 1.0);
    assert!(level.min >= -1e-9 && level.max <= 1e-9, "{level:?}");
    assert!(rate(&corner, 0.0, 0.4).max < -0.9);
    // What jumps has no rate, unless it does not jump here.
    let steps = |g: &mut Graph, [x, _, _]: [Expr; 3]| g.floor(x);
    assert!(rate(&steps, 0.5, 1.5).nan);
    assert_eq!(rate(&steps, 1.25, 1.5), Bounds::new(0.0, 0.0));
    let pole = |g: &mut Graph, [x, _, _]: [Expr; 3]| g.tan(x);
    assert!(rate(&pole, 1.0, 2.0).nan);
    let turn = |g: &mut Graph, [x, y, _]: [Expr; 3]| {
        let less = g.offset(y, -1.0);
        g.atan2(x, less)
    };
    assert!(rate(&turn, -0.1, 0.1).nan);
    assert!(rate(&turn, 0.1, 0.2).max < 0.0);
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
