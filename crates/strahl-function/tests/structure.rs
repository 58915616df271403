//! Graphs: sharing, folding, calls, loops, limits and errors.

#![allow(clippy::unwrap_used, reason = "a test that unwraps fails as it should")]

use std::sync::Arc;
use strahl_function::{
    Bounds, Expr, Function, FunctionError, Graph, ScalarField, Workspace, limits,
};

fn value(f: &Function, arguments: &[f64]) -> f64 {
    f.value(&mut Workspace::new(), arguments)
}

#[test]
fn equal_parts_are_stored_once_and_constants_folded() {
    let mut g = Graph::new(["x", "y"]);
    let (x, y) = (g.parameter("x"), g.parameter("y"));
    let a = g.add(x, y);
    let b = g.add(y, x);
    assert_eq!(a, b);
    let two = g.constant(2.0);
    let four = g.square(two);
    assert_eq!(g.known(four), Some(4.0));
    let product = g.mul(a, b);
    let f = g.finish(product).unwrap();
    assert_eq!(f.size(), 4);
    assert_eq!(value(&f, &[1.0, 2.0]), 9.0);
}

#[test]
fn folding_keeps_signed_zeros() {
    let mut g = Graph::new(["x"]);
    let x = g.parameter("x");
    let zero = g.constant(0.0);
    let sum = g.add(x, zero);
    assert_ne!(sum, x, "-0 + 0 is +0");
    let difference = g.sub(x, zero);
    assert_eq!(difference, x);
    let f = g.finish(sum).expect("small");
    assert_eq!(value(&f, &[-0.0]).to_bits(), 0.0f64.to_bits());
}

#[test]
fn powers_of_a_half_are_roots() {
    let mut g = Graph::new(["x"]);
    let x = g.parameter("x");
    let half = g.constant(0.5);
    let power = g.pow(x, half);
    assert_eq!(power, g.sqrt(x));
    let f = g.finish(power).expect("small");
    assert_eq!(value(&f, &[2.0]), 2f64.sqrt());
    assert!(value(&f, &[-2.0]).is_nan());
}

#[test]
fn u_and_v_are_other_names_of_x_and_y() {
    let mut g = Graph::new(["u", "v"]);
    let (u, x) = (g.parameter("u"), g.parameter("x"));
    assert_eq!(u, x);
    let y = g.parameter("y");
    let sum = g.sub(x, y);
    assert_eq!(value(&g.finish(sum).expect("small"), &[3.0, 1.0]), 2.0);
}

/// The sum of the first `n` powers of a parameter, in a function of its own.
fn powers(unroll: bool) -> Function {
    let mut g = Graph::new(["x", "n"]);
    let (x, n) = (g.parameter("x"), g.parameter("n"));
    let to = if unroll { g.constant(5.0) } else { n };
    let i = g.loop_variable();
    let power = g.pow(x, i);
    let one = g.constant(1.0);
    let sum = g.sum(i, one, to, power);
    g.finish(sum).expect("small")
}

#[test]
fn loops_written_out_have_the_bits_of_loops() {
    let (a, b) = (powers(true), powers(false));
    for x in [0.3, -1.7, 2.5, 0.0] {
        assert_eq!(
            value(&a, &[x, 5.0]).to_bits(),
            value(&b, &[x, 5.0]).to_bits()
        );
    }
}

#[test]
fn nested_loops_see_outer_variables_and_calls_keep_theirs_apart() {
    // sum(i, 1, n, sum(j, 1, i, j * x)), called twice within another loop.
    let mut g = Graph::new(["x", "n"]);
    let (x, n, one) = (g.parameter("x"), g.parameter("n"), g.constant(1.0));
    let (i, j) = (g.loop_variable(), g.loop_variable());
    let jx = g.mul(j, x);
    let inner = g.sum(j, one, i, jx);
    let outer = g.sum(i, one, n, inner);
    let f = g.finish(outer).unwrap();
    assert_eq!(value(&f, &[1.5, 3.0]), 15.0);

    let mut g = Graph::new(["n"]);
    let (n, one) = (g.parameter("n"), g.constant(1.0));
    let k = g.loop_variable();
    let inner = g.call(&f, &[k, k]);
    let other = g.call(&f, &[one, n]);
    let term = g.add(inner, other);
    let root = g.sum(k, one, n, term);
    let h = g.finish(root).unwrap();
    let s = |n: i32| (1..=n).map(|i| i * (i + 1) / 2).sum::<i32>();
    let expected: i32 = (1..=4).map(|k| k * s(k) + s(4)).sum();
    assert_eq!(value(&h, &[4.0]), f64::from(expected));
    let mut ws = Workspace::new();
    let four = Bounds::point(4.0);
    assert!(h.bounds(&mut ws, &[four]).contains(f64::from(expected)));
    // Lanes leave the loop at different rounds.
    let n: Vec<f64> = (0..23).map(|i| f64::from(i % 7) - 0.5).collect();
    let mut values = vec![0.0; n.len()];
    h.values(&mut ws, &[&n], &mut values);
    for (n, v) in n.iter().zip(values) {
        assert_eq!(h.value(&mut ws, &[*n]), v, "{n}");
    }
}

#[test]
fn a_loop_that_does_not_end_is_nan() {
    let f = powers(false);
    assert!(value(&f, &[1.0, 1e300]).is_nan());
    assert_eq!(value(&f, &[1.0, f64::NAN]), 0.0);
}

/// `sum(i, 1, n, sum(j, 1, i * m, j))`
fn triangle() -> Function {
    let mut g = Graph::new(["n", "m"]);
    let (n, m, one) = (g.parameter("n"), g.parameter("m"), g.constant(1.0));
    let (i, j) = (g.loop_variable(), g.loop_variable());
    let to = g.mul(i, m);
    let inner = g.sum(j, one, to, j);
    let root = g.sum(i, one, n, inner);
    g.finish(root).unwrap()
}

#[test]
fn loops_take_no_more_than_allowed_and_batches_have_the_bits_of_points() {
    let f = triangle();
    let points = [
        [3.0, 2.0],
        [3.0, 1e300],
        [0.0, 1e300],
        [1e9, 0.0],
        [900.0, 1.0],
        [2000.0, 2000.0],
        [f64::NAN, 1.0],
        [1.0, f64::INFINITY],
    ];
    // Each point beside others that take longer, shorter, or for ever.
    let n: Vec<f64> = (0..40).map(|i| points[i % 8][0]).collect();
    let m: Vec<f64> = (0..40).map(|i| points[i * 7 / 5 % 8][1]).collect();
    let mut ws = Workspace::new();
    let mut values = vec![0.0; n.len()];
    f.values(&mut ws, &[&n, &m], &mut values);
    let mut without_end = 0;
    for ((n, m), v) in n.iter().zip(&m).zip(values) {
        let spent = ws.spent();
        let alone = f.value(&mut ws, &[*n, *m]);
        assert!(ws.spent() - spent <= limits::COST);
        assert_eq!(alone.to_bits(), v.to_bits(), "{n} {m}");
        assert_eq!(
            alone.to_bits(),
            f.gradient(&mut ws, &[*n, *m]).0.to_bits(),
            "{n} {m}"
        );
        let bounds = f.bounds(&mut ws, &[Bounds::point(*n), Bounds::point(*m)]);
        assert!(bounds.contains(alone) || alone.is_nan() && bounds.nan);
        without_end += usize::from(alone.is_nan());
    }
    assert!((5..35).contains(&without_end), "{without_end}");
}

#[test]
fn behind_a_loop_of_unknown_length_nothing_is_sure() {
    // sum(i, 1, n, i) * 0 + sum(j, 1, 3 m, j): where the first one takes all, the second is not a number.
    let mut g = Graph::new(["n", "m"]);
    let (n, m, one) = (g.parameter("n"), g.parameter("m"), g.constant(1.0));
    let (i, j) = (g.loop_variable(), g.loop_variable());
    let first = g.sum(i, one, n, i);
    let first = g.less(first, one);
    let second = g.sum(j, one, m, j);
    let root = g.add(first, second);
    let f = g.finish(root).unwrap();
    let mut ws = Workspace::new();
    assert!(f.value(&mut ws, &[1e9, 2.0]).is_nan());
    let b = f.bounds(&mut ws, &[Bounds::new(1.0, 1e9), Bounds::point(2.0)]);
    assert!(b.nan);
}

#[test]
fn what_would_take_for_ever_is_an_error() {
    let mut g = Graph::new(["x"]);
    let x = g.parameter("x");
    let e = g.sin(x);
    let mut f = g.finish(e).unwrap();
    let mut rounds = 0;
    let error = loop {
        let mut g = Graph::new(["x"]);
        let x = g.parameter("x");
        let inner = g.call(&f, &[x]);
        let shifted = g.offset(inner, f64::from(rounds));
        let outer = g.call(&f, &[shifted]);
        match g.finish(outer) {
            Ok(next) => f = next,
            Err(error) => break error,
        }
        rounds += 1;
        assert!(rounds < 100);
    };
    assert!(matches!(error, FunctionError::TooCostly { .. }), "{error}");
    assert!(f.cost() > limits::COST / 4 && f.cost() <= limits::COST);

    for (to, allowed, good) in [
        (1e9, limits::COST, false),
        (f64::INFINITY, u64::MAX, false),
        (1e5, limits::COST, true),
        (1e5, 1000, false),
    ] {
        let mut g = Graph::new(["x"]);
        g.allow(allowed);
        let (x, one, to) = (g.parameter("x"), g.constant(1.0), g.constant(to));
        let i = g.loop_variable();
        let body = g.mul(x, i);
        let e = g.sum(i, one, to, body);
        match g.finish(e) {
            Ok(f) => assert!(good && f.value(&mut Workspace::new(), &[1.0]) == 5_000_050_000.0),
            Err(error) => assert!(!good, "{error}"),
        }
    }
}

#[test]
fn building_the_same_again_and_again_has_an_end() {
    let mut g = Graph::new(["x"]);
    let mut e = g.parameter("x");
    for _ in 0..1000 {
        e = g.sin(e);
    }
    let f = g.finish(e).unwrap();
    let mut g = Graph::new(["x"]);
    let x = g.parameter("x");
    for _ in 0..10_000_000 / 1000 {
        e = g.call(&f, &[x]);
    }
    assert!(matches!(g.failure(), Some(FunctionError::TooLarge { .. })));
    assert!(g.finish(e).is_err());
}

/// A function seen as a field only.
#[derive(Debug)]
struct Opaque(Function);

impl ScalarField for Opaque {
    fn arity(&self) -> usize {
        1
    }

    fn value(&self, arguments: &[f64]) -> f64 {
        ScalarField::value(&self.0, arguments)
    }

    fn cost(&self) -> strahl_function::Cost {
        ScalarField::cost(&self.0)
    }
}

#[test]
fn fields_within_fields_are_counted() {
    let around = |f: &Function, twice: bool| {
        let field: Arc<dyn ScalarField> = Arc::new(Opaque(f.clone()));
        let mut g = Graph::new(["x"]);
        let x = g.parameter("x");
        let mut e = g.field(&field, &[x]);
        if twice {
            let y = g.sin(e);
            e = g.field(&field, &[y]);
        }
        g.finish(e)
    };
    let mut g = Graph::new(["x"]);
    let x = g.parameter("x");
    let e = g.sin(x);
    let start = g.finish(e).unwrap();
    let until_error = |twice: bool| {
        let mut f = start.clone();
        for _ in 0..1000 {
            match around(&f, twice) {
                Ok(next) => f = next,
                Err(error) => return error,
            }
        }
        panic!("no error");
    };
    assert!(matches!(until_error(false), FunctionError::TooDeep { .. }));
    assert!(matches!(until_error(true), FunctionError::TooCostly { .. }));
}

#[test]
fn deep_expressions_need_no_deep_stack() {
    let mut g = Graph::new(["x"]);
    let x = g.parameter("x");
    let mut e = x;
    for _ in 0..200_000 {
        e = g.sin(e);
        e = g.add(e, x);
    }
    let f = g.finish(e).unwrap();
    assert!(value(&f, &[0.5]).is_finite());
    let mut ws = Workspace::new();
    assert!(!f.bounds(&mut ws, &[Bounds::new(0.0, 1.0)]).is_empty());
}

#[test]
fn a_graph_that_is_too_large_is_an_error() {
    let mut g = Graph::new(["x"]);
    let mut e = g.parameter("x");
    for _ in 0..=limits::NODES {
        e = g.exp(e);
    }
    assert_eq!(
        g.finish(e).unwrap_err(),
        FunctionError::TooLarge {
            limit: limits::NODES
        }
    );
}

#[test]
fn calls_that_double_stay_small() {
    // f(x) = g(x) + g(x + 1), thirty times: a billion terms if it were written out.
    let mut g = Graph::new(["x"]);
    let x = g.parameter("x");
    let e = g.sin(x);
    let mut f = g.finish(e).unwrap();
    for round in 0..14 {
        let mut g = Graph::new(["x"]);
        let x = g.parameter("x");
        let shifted = g.scaled(x, 1.0 + f64::from(round) / 7.0);
        let (a, b) = (g.call(&f, &[x]), g.call(&f, &[shifted]));
        let sum = g.add(a, b);
        f = g.finish(sum).expect("small");
        assert!(f.size() <= 4 * limits::INLINE);
    }
    let mut ws = Workspace::new();
    let v = f.value(&mut ws, &[0.25]);
    let mut out = [0.0];
    f.values(&mut ws, &[&[0.25]], &mut out);
    assert_eq!(v.to_bits(), out[0].to_bits());
    assert_eq!(v.to_bits(), f.gradient(&mut ws, &[0.25]).0.to_bits());
    assert!(f.bounds(&mut ws, &[Bounds::point(0.25)]).contains(v));
}

#[test]
fn loops_nested_too_deep_are_an_error() {
    let mut g = Graph::new(["n"]);
    let (n, one) = (g.parameter("n"), g.constant(1.0));
    let mut e = n;
    for _ in 0..10_000 {
        let i = g.loop_variable();
        let body = g.mul(e, i);
        e = g.sum(i, one, n, body);
    }
    assert!(matches!(
        g.finish(e).unwrap_err(),
        FunctionError::TooDeep { .. }
    ));
}

#[test]
fn what_is_wrong_is_said() {
    let mut g = Graph::new(["x", "x"]);
    let e = g.parameter("x");
    assert!(matches!(
        g.finish(e).unwrap_err(),
        FunctionError::DuplicateParameter { .. }
    ));

    let mut g = Graph::new(["a", "b"]);
    let e = g.parameter("c");
    let error = g.finish(e).unwrap_err();
    assert_eq!(
        error.to_string(),
        "`c` is not a parameter of the function, which has a, b"
    );

    let mut g = Graph::new(["x"]);
    let i = g.loop_variable();
    let e = g.sin(i);
    assert_eq!(g.finish(e).unwrap_err(), FunctionError::UnboundVariable);

    let mut other = Graph::new(["x"]);
    let mut far = other.parameter("x");
    for _ in 0..10 {
        far = other.sin(far);
    }
    let mut g = Graph::new(["x"]);
    let e = g.cos(far);
    assert_eq!(g.finish(e).unwrap_err(), FunctionError::ForeignExpression);
    let g = Graph::new(["x"]);
    assert_eq!(g.finish(far).unwrap_err(), FunctionError::ForeignExpression);

    let f = powers(false);
    let mut g = Graph::new(["x"]);
    let x = g.parameter("x");
    let e = g.call(&f, &[x]);
    assert!(matches!(
        g.finish(e).unwrap_err(),
        FunctionError::ArgumentCount {
            expected: 2,
            found: 1,
            ..
        }
    ));

    let many: Vec<String> = (0..57).map(|i| format!("p{i}")).collect();
    let mut g = Graph::new(many);
    let e = g.constant(0.0);
    assert!(matches!(
        g.finish(e).unwrap_err(),
        FunctionError::TooManyParameters { found: 57, .. }
    ));
}

#[derive(Debug)]
struct Product;

impl ScalarField for Product {
    fn value(&self, p: &[f64]) -> f64 {
        p[0] * p[1] * p[2]
    }
}

#[test]
fn functions_that_do_the_same_are_equal() {
    let build = |constant: f64, field: &Arc<dyn ScalarField>| {
        let mut g = Graph::new(["x"]);
        let x = g.parameter("x");
        let scaled = g.scaled(x, constant);
        let read = g.field(field, &[scaled]);
        let sum = g.add(read, x);
        g.finish(sum).unwrap()
    };
    let field: Arc<dyn ScalarField> = Arc::new(build_square());
    let other: Arc<dyn ScalarField> = Arc::new(build_square());
    let f = build(2.0, &field);
    assert_eq!(f, f.clone());
    assert_eq!(f, build(2.0, &field));
    assert_ne!(f, build(3.0, &field));
    // What another field does is not known.
    assert_ne!(f, build(2.0, &other));
}

#[test]
fn functions_may_have_hundreds_of_registers() {
    // Every term has a constant of its own.
    let mut g = Graph::new(["x"]);
    let x = g.parameter("x");
    let terms: Vec<Expr> = (1..=600).map(|k| g.scaled(x, 1.0 / f64::from(k))).collect();
    let sum = g.total(&terms);
    let f = g.finish(sum).unwrap();
    let expected = (2..=600).fold(3.0, |sum, k| sum + 3.0 * (1.0 / f64::from(k)));
    assert_eq!(value(&f, &[3.0]), expected);
    let mut ws = Workspace::new();
    let mut values = [0.0; 2];
    f.values(&mut ws, &[&[3.0; 2]], &mut values);
    assert_eq!(values, [expected; 2]);
    let bounds = f.bounds(&mut ws, &[Bounds::point(3.0)]);
    assert!(bounds.contains(expected) && bounds.max - bounds.min < 1e-10);
    assert_eq!(f.gradient(&mut ws, &[3.0]).0, expected);
    assert!(f.rate(&mut ws, &[Bounds::point(3.0)], &[1.0]).1.min > 6.0);
}

fn build_square() -> Function {
    let mut g = Graph::new(["x"]);
    let x = g.parameter("x");
    let square = g.square(x);
    g.finish(square).unwrap()
}

#[test]
fn fields_are_called_from_all_domains() {
    let field: Arc<dyn ScalarField> = Arc::new(Product);
    let mut g = Graph::new(["x", "y", "z"]);
    let [x, y, z] = g.xyz();
    let e: Expr = g.field(&field, &[y, z, x]);
    let twice = g.add(e, e);
    let f = g.finish(twice).unwrap();
    let mut ws = Workspace::new();
    let p = [2.0, 3.0, 5.0];
    assert_eq!(f.value(&mut ws, &p), 60.0);
    let (v, gradient) = f.gradient(&mut ws, &p);
    assert_eq!(v, 60.0);
    for (a, b) in gradient.iter().zip([30.0, 20.0, 12.0]) {
        assert!((a - b).abs() < 1e-8, "{a} {b}");
    }
    assert!(f.bounds(&mut ws, &p.map(Bounds::point)).contains(60.0));
    let mut values = [0.0; 3];
    f.values(&mut ws, &[&[2.0; 3], &[3.0; 3], &[5.0; 3]], &mut values);
    assert_eq!(values, [60.0; 3]);

    let mut g = Graph::new(["x"]);
    let x = g.parameter("x");
    let e = g.field(&field, &[x]);
    assert!(matches!(
        g.finish(e).unwrap_err(),
        FunctionError::ArgumentCount { .. }
    ));
}
