use super::*;
use crate::conformance::Random;
use crate::{Cuboid, Sphere};
use std::f64::consts::{PI, TAU};
use strahl_function::{Expr, Graph};

fn function(build: impl Fn(&mut Graph, Expr, Expr) -> Expr) -> Function {
    let mut graph = Graph::new(["u", "v"]);
    let (u, v) = (graph.parameter("u"), graph.parameter("v"));
    let root = build(&mut graph, u, v);
    graph.finish(root).unwrap()
}

fn cube(side: f64) -> Container {
    Container::Box(Cuboid::new(DVec3::splat(-side), DVec3::splat(side)))
}

fn surface(functions: [Function; 3], a: DVec2, b: DVec2, container: Container) -> Parametric {
    Parametric::try_new(functions, [a, b], container, ParametricOptions::default()).unwrap()
}

/// A torus of radii 1 and 0.4.
fn torus() -> [Function; 3] {
    let ring = |g: &mut Graph, v: Expr| {
        let c = g.cos(v);
        let c = g.scaled(c, 0.4);
        g.offset(c, 1.0)
    };
    [
        function(|g, u, v| {
            let (r, c) = (ring(g, v), g.cos(u));
            g.mul(r, c)
        }),
        function(|g, _, v| {
            let s = g.sin(v);
            g.scaled(s, 0.4)
        }),
        function(|g, u, v| {
            let (r, s) = (ring(g, v), g.sin(u));
            g.mul(r, s)
        }),
    ]
}

/// A saddle over the unit square.
fn saddle() -> [Function; 3] {
    [
        function(|_, u, _| u),
        function(|g, u, v| g.mul(u, v)),
        function(|_, _, v| v),
    ]
}

crate::primitive_tests!(ring, || surface(
    torus(),
    DVec2::ZERO,
    DVec2::splat(TAU),
    cube(1.5)
));
crate::primitive_tests!(bent, || surface(
    saddle(),
    DVec2::NEG_ONE,
    DVec2::ONE,
    cube(2.0)
));
crate::primitive_tests!(cut, || surface(
    torus(),
    DVec2::ZERO,
    DVec2::new(PI, TAU),
    Container::Sphere(Sphere::new(DVec3::X, 1.0))
));

#[test]
fn hits_are_those_of_the_torus() {
    let ours = surface(torus(), DVec2::ZERO, DVec2::splat(TAU), cube(1.5));
    let theirs = crate::Torus::new(DVec3::ZERO, DVec3::Y, 1.0, 0.4);
    let (mut random, scratch) = (Random::new(9), &mut Scratch::default());
    let mut found = 0;
    for _ in 0..1500 {
        let (from, to) = (random.cube() * 4.0, random.cube());
        let ray = Ray::new(from, to - from);
        let expected = theirs.closest_hit(&ray, Interval::FORWARD, None, scratch);
        let hit = ours.closest_hit(&ray, Interval::FORWARD, None, scratch);
        if let Some(expected) = expected {
            let normal = theirs.surface_at(&ray, &expected).n_geom;
            if normal.dot(ray.direction.normalize()).abs() < 0.05 {
                continue;
            }
            assert!(
                hit.is_some_and(|hit| (hit.t - expected.t).abs() < 1e-10),
                "{ray:?} {hit:?} {expected:?}"
            );
            found += 1;
        }
    }
    assert!(found > 300);
}

#[test]
fn wrong_parameters_are_refused() {
    let make = |a, b, accuracy| {
        let options = ParametricOptions {
            accuracy,
            ..ParametricOptions::default()
        };
        Parametric::try_new(saddle(), [a, b], Container::default(), options)
    };
    assert!(make(DVec2::ZERO, DVec2::ONE, 0.001).is_ok());
    assert!(make(DVec2::ONE, DVec2::ZERO, 0.001).is_ok());
    assert!(matches!(
        make(DVec2::ZERO, DVec2::X, 0.001),
        Err(GeometryError::Degenerate { .. })
    ));
    assert!(matches!(
        make(DVec2::ZERO, DVec2::NAN, 0.001),
        Err(GeometryError::NotFinite { .. })
    ));
    assert!(matches!(
        make(DVec2::ZERO, DVec2::ONE, 0.0),
        Err(GeometryError::OutOfRange { .. })
    ));
}
