//! Regions that polynomials describe are those where the functions are below the threshold.

#![allow(clippy::unwrap_used, reason = "a test that unwraps fails as it should")]

use proptest::prelude::*;
use strahl_function::{Expr, Function, Graph, Region, Terms, Workspace};
use strahl_math::noise::NoiseGenerator;

fn function(build: impl FnOnce(&mut Graph, [Expr; 3]) -> Expr) -> Function {
    let mut graph = Graph::new(["x", "y", "z"]);
    let xyz = graph.xyz();
    let root = build(&mut graph, xyz);
    graph.finish(root).unwrap()
}

fn value(terms: &Terms, point: [f64; 3]) -> f64 {
    let term = |(powers, c): &([u32; 3], f64)| {
        let factors = point.iter().zip(powers);
        factors.fold(*c, |product, (x, n)| product * x.powi(*n as i32))
    };
    terms.iter().map(term).sum()
}

/// Whether a region contains a point, and how near to zero a polynomial is there.
fn contains(region: &Region, point: [f64; 3]) -> (bool, f64) {
    let list = |parts: &[Region]| -> Vec<_> { parts.iter().map(|p| contains(p, point)).collect() };
    let nearest = |parts: &[(bool, f64)]| parts.iter().map(|p| p.1).fold(f64::INFINITY, f64::min);
    match region {
        Region::Negative(terms) => {
            let value = value(terms, point);
            (value < 0.0, value.abs())
        }
        Region::All(parts) => {
            let parts = list(parts);
            (parts.iter().all(|p| p.0), nearest(&parts))
        }
        Region::Any(parts) => {
            let parts = list(parts);
            (parts.iter().any(|p| p.0), nearest(&parts))
        }
    }
}

/// The region below a threshold agrees with the values at points of a lattice around the center.
fn agrees(function: &Function, threshold: f64) -> Result<(), TestCaseError> {
    let center = [0.25, -0.5, 1.0];
    let region = function.region_below(threshold, center);
    let region = region.ok_or_else(|| TestCaseError::fail("there is no region"))?;
    let mut workspace = Workspace::new();
    for number in 0..1000 {
        let offset = [1, 10, 100].map(|n| f64::from(number / n % 10) * 0.43 - 2.0);
        let point = [0, 1, 2].map(|k| center[k] + offset[k]);
        let (is_inside, nearest) = contains(&region, offset);
        let is_below = function.value(&mut workspace, &point) < threshold;
        prop_assert!(
            is_below == is_inside || nearest < 1e-9,
            "{point:?}: {nearest:e}"
        );
    }
    Ok(())
}

/// A random polynomial: products and sums of the coordinates and of numbers.
fn polynomial(graph: &mut Graph, xyz: [Expr; 3], program: &[(u8, f64)]) -> Expr {
    let mut stack = vec![xyz[0]];
    for &(step, number) in program {
        let top = stack[stack.len() - 1];
        let below = stack[stack.len() / 2];
        let next = match step {
            0..3 => xyz[usize::from(step)],
            3 => graph.scaled(top, number),
            4 => graph.offset(top, number),
            5 => graph.add(top, below),
            6 => graph.sub(top, below),
            7 => graph.mul(top, below),
            8 => graph.square(top),
            9 => graph.neg(top),
            _ => graph.powi(top, 3),
        };
        stack.push(next);
    }
    stack[stack.len() - 1]
}

proptest! {
    #[test]
    fn random_polynomials(
        program in prop::collection::vec((0u8..11, -2.0..2.0), 1..12),
        threshold in -2.0..2.0,
    ) {
        let f = function(|g, xyz| polynomial(g, xyz, &program));
        if f.region_below(threshold, [0.25, -0.5, 1.0]).is_some() {
            agrees(&f, threshold)?;
        }
    }
}

#[test]
fn functions_of_polynomials() {
    type Build = fn(&mut Graph, [Expr; 3]) -> Expr;
    let sphere: Build = |g, xyz| {
        let r = g.length(&xyz);
        g.offset(r, -1.0)
    };
    let shell: Build = |g, xyz| {
        let r = g.norm2(&xyz);
        let r = g.offset(r, -2.0);
        let size = g.abs(r);
        let less = g.offset(size, -1.0);
        g.scaled(less, -3.0)
    };
    let both: Build = |g, [x, y, z]| {
        let tube = g.length(&[x, y]);
        let other = g.square(z);
        let least = g.min(&[tube, other]);
        let most = g.max(&[least, x]);
        g.neg(most)
    };
    let clamped: Build = |g, xyz| {
        let r = g.norm2(&xyz);
        let (low, high) = (g.constant(-10.0), g.constant(10.0));
        let above = g.max(&[low, r]);
        g.min(&[above, high])
    };
    let root_within: Build = |g, [x, y, z]| {
        let r = g.length(&[x, y]);
        let square = g.square(r);
        g.sub(square, z)
    };
    for (name, build, threshold) in [
        ("sphere", sphere, 0.5),
        ("shell", shell, 0.3),
        ("both", both, -1.0),
        ("clamped", clamped, 2.0),
        ("root within", root_within, 0.5),
    ] {
        let result = agrees(&function(build), threshold);
        assert!(result.is_ok(), "{name}: {result:?}");
    }
}

/// POV-Ray's functions of algebraic surfaces.
#[test]
fn internal_functions() {
    for (name, parameters) in [
        ("f_kummer_surface_v1", &[1.0][..]),
        ("f_torus2", &[1.0, 1.0, 0.4]),
        ("f_heart", &[1.0]),
        ("f_ellipsoid", &[1.0, 0.7, 1.2]),
        ("f_quartic_saddle", &[1.0]),
    ] {
        let f = function(|g, [x, y, z]| {
            let mut arguments = vec![x, y, z];
            arguments.extend(parameters.iter().map(|p| g.constant(*p)));
            g.internal(name, &arguments, NoiseGenerator::default())
        });
        let result = agrees(&f, 0.25);
        assert!(result.is_ok(), "{name}: {result:?}");
    }
}

#[test]
fn other_functions_have_no_region() {
    type Build = fn(&mut Graph, [Expr; 3]) -> Expr;
    let wave: Build = |g, [x, y, _]| {
        let s = g.sin(x);
        g.add(s, y)
    };
    let high: Build = |g, [x, _, z]| {
        let power = g.powi(x, 13);
        g.add(power, z)
    };
    let constant: Build = |g, _| g.constant(1.0);
    let always: Build = |g, [x, ..]| {
        let limit = g.constant(0.25);
        let root = g.abs(x);
        g.min(&[root, limit])
    };
    let infinite: Build = |g, [x, ..]| {
        let (zero, power) = (g.constant(0.0), g.square(x));
        g.div(power, zero)
    };
    for build in [wave, high, constant, always, infinite] {
        assert_eq!(function(build).region_below(0.5, [0.0; 3]), None);
    }
    let sphere = function(|g, xyz| g.norm2(&xyz));
    assert_eq!(sphere.region_below(f64::NAN, [0.0; 3]), None);
    assert_eq!(sphere.region_below(1.0, [f64::INFINITY, 0.0, 0.0]), None);
}
