//! Points per second of functions from cheap to dear, point by point, in batches, as intervals and with gradients.
//!
//! `cargo bench -p strahl-function`

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use strahl_function::{Bounds, Expr, Function, Graph, Workspace};

fn function(build: impl Fn(&mut Graph, [Expr; 3]) -> Expr) -> Function {
    let mut g = Graph::new(["x", "y", "z"]);
    let xyz = g.xyz();
    let root = build(&mut g, xyz);
    g.finish(root).expect("the functions here are well formed")
}

/// The distance from a sphere: 8 operations.
fn sphere(g: &mut Graph, [x, y, z]: [Expr; 3]) -> Expr {
    let r = g.length(&[x, y, z]);
    g.offset(r, -1.0)
}

/// A heart of degree six: whole powers and products.
fn heart(g: &mut Graph, [x, y, z]: [Expr; 3]) -> Expr {
    let (x2, y2, z2, z3) = (g.square(x), g.square(y), g.square(z), g.powi(z, 3));
    let double = g.scaled(x2, 2.0);
    let sum = g.total(&[double, y2, z2]);
    let inner = g.offset(sum, -1.0);
    let cube = g.powi(inner, 3);
    let tenth = g.scaled(x2, 0.1);
    let mixed = g.add(tenth, y2);
    let dent = g.mul(mixed, z3);
    g.sub(dent, cube)
}

/// A gyroid with a smooth cut: sines, a minimum, an exponential.
fn gyroid(g: &mut Graph, [x, y, z]: [Expr; 3]) -> Expr {
    let mut term = |a: Expr, b: Expr| {
        let (s, c) = (g.sin(a), g.cos(b));
        g.mul(s, c)
    };
    let terms = [term(x, y), term(y, z), term(z, x)];
    let waves = g.total(&terms);
    let r2 = g.norm2(&[x, y, z]);
    let m = g.neg(r2);
    let fade = g.exp(m);
    g.max(&[waves, fade])
}

/// Ten octaves in a loop.
fn series(g: &mut Graph, [x, y, z]: [Expr; 3]) -> Expr {
    let i = g.loop_variable();
    let (from, to) = (g.constant(1.0), g.constant(10.0));
    let (a, b, c) = (g.mul(i, x), g.mul(i, y), g.mul(i, z));
    let (s, t) = (g.sin(a), g.cos(b));
    let p = g.product(&[s, t, c]);
    let term = g.div(p, i);
    g.sum(i, from, to, term)
}

fn tape(c: &mut Criterion) {
    const POINTS: usize = 4096;
    // A deterministic scatter in -1.5..1.5; the golden ratio's multiples are spread evenly.
    let column = |step: f64| -> Vec<f64> {
        (0..POINTS)
            .map(|i| (i as f64 * step).fract() * 3.0 - 1.5)
            .collect()
    };
    let (x, y, z) = (column(0.618_034), column(0.754_878), column(0.569_840));
    let functions = [
        ("sphere", function(sphere)),
        ("heart", function(heart)),
        ("gyroid", function(gyroid)),
        ("series", function(series)),
    ];
    for (name, f) in functions {
        let mut ws = Workspace::new();
        let mut out = vec![0.0; POINTS];
        let mut group = c.benchmark_group(name);
        group.throughput(Throughput::Elements(POINTS as u64));
        group.bench_function("point", |b| {
            b.iter(|| {
                for i in 0..POINTS {
                    out[i] = f.value(&mut ws, &[x[i], y[i], z[i]]);
                }
                black_box(&out);
            })
        });
        group.bench_function("batch", |b| {
            b.iter(|| {
                f.values(&mut ws, &[&x, &y, &z], &mut out);
                black_box(&out);
            })
        });
        group.bench_function("gradient", |b| {
            b.iter(|| {
                for i in 0..POINTS {
                    out[i] = f.gradient(&mut ws, &[x[i], y[i], z[i]]).1[0];
                }
                black_box(&out);
            })
        });
        group.bench_function("bounds", |b| {
            b.iter(|| {
                for i in 0..POINTS {
                    let side = |v: f64| Bounds::new(v, v + 0.1);
                    out[i] = f.bounds(&mut ws, &[side(x[i]), side(y[i]), side(z[i])]).min;
                }
                black_box(&out);
            })
        });
        group.finish();
    }
}

criterion_group!(benches, tape);
criterion_main!(benches);
