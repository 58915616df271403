//! The internal functions against values measured with POV-Ray 3.7.

#![allow(clippy::unwrap_used, reason = "a test that unwraps fails as it should")]

use std::collections::BTreeMap;
use strahl_function::{Bounds, Function, FunctionError, Graph, Workspace, internal};
use strahl_math::noise::NoiseGenerator;

/// A function of the point with fixed parameters.
fn at(name: &str, parameters: &[f64]) -> Result<Function, FunctionError> {
    let mut g = Graph::new(["x", "y", "z"]);
    let mut arguments = g.xyz().to_vec();
    for &p in parameters {
        arguments.push(g.constant(p));
    }
    let root = g.internal(name, &arguments, NoiseGenerator::default());
    g.finish(root)
}

/// A function of the point and the parameters.
fn open(name: &str, parameters: usize) -> Result<Function, FunctionError> {
    let names = (0..3 + parameters).map(|i| match i {
        0 => "x".to_owned(),
        1 => "y".to_owned(),
        2 => "z".to_owned(),
        i => format!("p{}", i - 3),
    });
    let mut g = Graph::new(names);
    let arguments: Vec<_> = g.parameters().to_vec();
    let arguments: Vec<_> = arguments.iter().map(|n| g.parameter(n)).collect();
    let root = g.internal(name, &arguments, NoiseGenerator::default());
    g.finish(root)
}

struct Row<'a> {
    name: &'a str,
    arguments: Vec<f64>,
    value: f64,
}

fn measured() -> Vec<Row<'static>> {
    include_str!("data/internal.txt")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let (call, value) = line.split_once('=').unwrap_or((line, "nan"));
            let mut words = call.split_whitespace();
            let name = words.next().unwrap_or_default();
            let number = |w: &str| w.parse().unwrap_or(f64::NAN);
            Row {
                name,
                arguments: words.map(number).collect(),
                value: number(value.trim()),
            }
        })
        .collect()
}

#[test]
fn values_are_those_of_pov_ray() {
    let mut ws = Workspace::new();
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    let mut wrong = Vec::new();
    for row in measured() {
        let parameters = &row.arguments[3..];
        let fixed = at(row.name, parameters).unwrap();
        let value = fixed.value(&mut ws, &row.arguments[..3]);
        if !((value - row.value).abs() <= 1e-9 * row.value.abs().max(1.0)) {
            wrong.push(format!(
                "{} {:?}: {value}, POV-Ray gives {}",
                row.name, row.arguments, row.value
            ));
        }
        *seen.entry(row.name).or_default() += 1;
        let point: Vec<Bounds> = row.arguments[..3]
            .iter()
            .map(|&a| Bounds::point(a))
            .collect();
        let bounds = fixed.bounds(&mut ws, &point);
        assert!(bounds.contains(value), "{} {:?}", row.name, row.arguments);
        assert_eq!(
            fixed.gradient(&mut ws, &row.arguments[..3]).0.to_bits(),
            value.to_bits()
        );
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for f in internal::all().filter(|f| f.is_supported()) {
        let rows = seen.get(f.name).copied().unwrap_or(0);
        assert!(rows >= 8, "{} is measured at {rows} points", f.name);
    }
}

#[test]
fn parameters_may_be_variables() {
    let mut ws = Workspace::new();
    for row in measured() {
        // Loops over octaves and tubes need known counts.
        let Ok(f) = open(row.name, row.arguments.len() - 3) else {
            continue;
        };
        let value = f.value(&mut ws, &row.arguments);
        assert!(
            (value - row.value).abs() <= 1e-9 * row.value.abs().max(1.0),
            "{} {:?}: {value}, POV-Ray gives {}",
            row.name,
            row.arguments,
            row.value
        );
    }
}

#[test]
fn bounds_contain_values_around_the_measured_points() {
    let mut ws = Workspace::new();
    for row in measured() {
        let f = at(row.name, &row.arguments[3..]).unwrap();
        let region: Vec<Bounds> = row.arguments[..3]
            .iter()
            .map(|&a| Bounds::new(a - 0.3, a + 0.2))
            .collect();
        let bounds = f.bounds(&mut ws, &region);
        for i in 0..27 {
            let step = |k: i32| f64::from(i / k % 3) / 2.0;
            let p: Vec<f64> = region
                .iter()
                .zip([1, 3, 9])
                .map(|(b, k)| f64::min(b.min + step(k) * (b.max - b.min), b.max))
                .collect();
            let value = f.value(&mut ws, &p);
            assert!(
                bounds.contains(value),
                "{} {p:?}: {value} is not in {bounds:?}",
                row.name
            );
        }
    }
}

#[test]
fn wrong_names_and_counts_are_reported() {
    let error = at("f_sphrere", &[1.0]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "there is no internal function `f_sphrere`; did you mean `f_sphere`?"
    );
    let error = at("f_sphere", &[]).unwrap_err();
    assert_eq!(error.to_string(), "f_sphere takes 4 arguments, found 3");
    for f in internal::all().filter(|f| !f.is_supported()) {
        let error = at(f.name, &vec![1.0; f.parameters]).unwrap_err();
        assert!(matches!(error, FunctionError::UnsupportedInternal { .. }));
    }
}

#[test]
fn no_name_is_given_twice() {
    let mut names: Vec<&str> = internal::all().map(|f| f.name).collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|w| w[0] != w[1]));
}
