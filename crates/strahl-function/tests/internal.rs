//! The internal functions against values measured with POV-Ray 3.7.

#![allow(clippy::unwrap_used, reason = "a test that unwraps fails as it should")]

use std::collections::BTreeMap;
use strahl_function::{
    Bounds, Expr, Function, FunctionError, Graph, Rates, ScalarField, Workspace, internal,
};
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
    for f in internal::all() {
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
fn batches_have_the_bits_of_points() {
    let mut ws = Workspace::new();
    for row in measured() {
        let f = at(row.name, &row.arguments[3..]).unwrap();
        for count in [1, 3, 16, 21] {
            let column = |axis: usize| -> Vec<f64> {
                let place = |k: u32| row.arguments[axis] + 0.37 * f64::from(k);
                (0..count).map(place).collect()
            };
            let columns = [column(0), column(1), column(2)];
            let mut values = vec![0.0; count as usize];
            f.values(&mut ws, &columns.each_ref().map(|c| &c[..]), &mut values);
            let mut fields = vec![0.0; count as usize];
            ScalarField::store_values(&f, &columns.each_ref().map(|c| &c[..]), &mut fields);
            for (k, value) in values.into_iter().enumerate() {
                let p = [columns[0][k], columns[1][k], columns[2][k]];
                let single = f.value(&mut ws, &p);
                let is_same =
                    |x: f64| x.to_bits() == single.to_bits() || x.is_nan() && single.is_nan();
                assert!(is_same(value) && is_same(fields[k]), "{} {p:?}", row.name);
            }
        }
    }
}

#[test]
fn sums_of_octaves_with_other_parameters_than_the_first_are_their_own() {
    let mut ws = Workspace::new();
    let sets = [
        [0.5, 2.0, 6.5, 0.7, 1.0, 2.0],
        [0.5, 2.0, 9.0, 0.7, 1.0, 2.0],
        [0.5, 2.1, 6.5, 0.7, 1.0, 2.0],
        [1.5, 2.0, 6.5, 0.7, 1.0, 1.0],
    ];
    for name in ["f_hetero_mf", "f_ridge", "f_ridged_mf"] {
        let all = open(name, 6).unwrap();
        for set in sets.iter().chain(&sets) {
            let fixed = at(name, set).unwrap();
            let p = [0.3, -1.7, 2.9];
            let arguments: Vec<f64> = p.iter().chain(set).copied().collect();
            let value = fixed.value(&mut ws, &p);
            assert_eq!(value.to_bits(), all.value(&mut ws, &arguments).to_bits());
            let area = p.map(|x| Bounds::argument(x, x + 0.1));
            let mut open_area = area.to_vec();
            open_area.extend(set.map(Bounds::point));
            let bounds = fixed.bounds(&mut ws, &area);
            assert_eq!(bounds, all.bounds(&mut ws, &open_area), "{name} {set:?}");
            let (same, by) = fixed.gradient(&mut ws, &p);
            assert_eq!(value.to_bits(), same.to_bits());
            for (axis, slope) in by.into_iter().enumerate() {
                // As differences are taken.
                let step = 6e-6 * f64::max(p[axis].abs(), 1.0);
                let (mut above, mut below) = (p, p);
                above[axis] += step;
                below[axis] -= step;
                let change = fixed.value(&mut ws, &above) - fixed.value(&mut ws, &below);
                assert_eq!(slope, change / (above[axis] - below[axis]), "{name}");
            }
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
}

#[test]
fn no_name_is_given_twice() {
    let mut names: Vec<&str> = internal::all().map(|f| f.name).collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|w| w[0] != w[1]));
}

#[test]
fn rates_of_noise_bound_its_changes_and_are_narrower_along_segments() {
    let mut ws = Workspace::new();
    let mut seed = 7_u64;
    let mut random = || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut monotone = 0;
    for (name, parameters) in [
        ("f_noise3d", &[][..]),
        ("f_snoise3d", &[]),
        ("f_noise_generator", &[3.0]),
    ] {
        let f = at(name, parameters).unwrap();
        assert_eq!(f.rates(), Rates::OfBoxes, "{name}");
        for _ in 0..300 {
            let start = [0; 3].map(|_| 20.0 * random());
            let way = [0; 3].map(|_| random());
            let length = 0.05 * (1.0 + random());
            let at = |s: f64| [0, 1, 2].map(|i| start[i] + way[i] * s);
            let (first, last) = (at(0.0), at(length));
            let region =
                [0, 1, 2].map(|i| Bounds::new(first[i].min(last[i]), first[i].max(last[i])));
            let (value, rate) = f.rate(&mut ws, &region, &way);
            assert_eq!(value, f.bounds(&mut ws, &region));
            monotone += u32::from(rate.min > 0.0 || rate.max < 0.0);
            for _ in 0..5 {
                let s = 0.5 * (1.0 + random()) * length;
                let change = f.value(&mut ws, &at(s)) - f.value(&mut ws, &first);
                assert!(change >= rate.min * s - 1e-9, "{name} {change} {rate:?}");
                assert!(change <= rate.max * s + 1e-9, "{name} {change} {rate:?}");
            }
        }
    }
    assert!(monotone > 300, "{monotone}");
    let sum = at("f_ridged_mf", &[0.9, 2.1, 3.0, 0.8, 2.0, 2.0]).unwrap();
    assert_eq!(sum.rates(), Rates::OfSegments);
    let [from, to] = [[0.31, 0.22, -0.4], [0.32, 0.21, -0.42]];
    let way = [0.01, -0.01, -0.02];
    let along = sum.rate_along(&mut ws, [&from, &to], &way);
    let region = [0, 1, 2].map(|i| Bounds::new(from[i].min(to[i]), from[i].max(to[i])));
    let (values, rate) = sum.rate(&mut ws, &region, &way);
    assert!(rate.nan && !along.1.nan);
    assert!(2.0 * (along.0.max - along.0.min) < values.max - values.min);
}

#[test]
fn segments_stay_segments_in_linear_functions_only() {
    let narrowness = |build: &dyn Fn(&mut Graph, [Expr; 3]) -> [Expr; 3]| {
        let mut g = Graph::new(["x", "y", "z"]);
        let xyz = g.xyz();
        let arguments = build(&mut g, xyz);
        let root = g.internal("f_noise3d", &arguments, NoiseGenerator::default());
        let f = g.finish(root).unwrap();
        let mut ws = Workspace::new();
        let (from, way) = ([0.1, 0.25, -0.3], [0.02, 0.01, -0.015]);
        let at = |s: f64| [0, 1, 2].map(|i| from[i] + s * way[i]);
        let to = at(1.0);
        let (values, rate) = f.rate_along(&mut ws, [&from, &to], &way);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for i in 0..=100 {
            let value = f.value(&mut ws, &at(f64::from(i) / 100.0));
            assert!(values.contains(value));
            (low, high) = (low.min(value), high.max(value));
        }
        assert!(rate.min <= high - low && rate.max >= low - high);
        (values.max - values.min) / (high - low)
    };
    let linear = narrowness(&|g, [x, y, z]| {
        let (a, b) = (g.scaled(x, 2.5), g.sub(y, z));
        [g.add(a, y), g.offset(b, 0.3), g.neg(z)]
    });
    assert!(linear < 1.2, "{linear}");
    let curved = narrowness(&|g, [x, y, z]| [g.square(x), y, z]);
    assert!(curved > 1.5, "{curved}");
}
