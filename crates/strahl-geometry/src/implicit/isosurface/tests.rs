use super::*;
use crate::conformance::Random;
use crate::{Cuboid, Sphere};
use std::sync::Arc;
use strahl_function::{Expr, Graph, ScalarField};
use strahl_math::noise::NoiseGenerator;

fn function(build: impl Fn(&mut Graph, [Expr; 3]) -> Expr) -> Function {
    let mut graph = Graph::new(["x", "y", "z"]);
    let xyz = graph.xyz();
    let root = build(&mut graph, xyz);
    graph.finish(root).unwrap()
}

/// `x² + y² + z²`
fn ball() -> Function {
    function(|g, xyz| g.norm2(&xyz))
}

/// A ball whose value is its distance from the center, half out of the container.
fn distance() -> Function {
    function(|g, xyz| g.length(&xyz))
}

/// `| x² + y² + z² - 1 |`
fn shell() -> Function {
    function(|g, xyz| {
        let square = g.norm2(&xyz);
        let off = g.offset(square, -1.0);
        g.abs(off)
    })
}

/// The smaller one of the distance from an axis and of a paraboloid's polynomial.
fn union() -> Function {
    function(|g, [x, y, z]| {
        let tube = g.length(&[x, y]);
        let bowl = g.norm2(&[x, z]);
        let (tube, bowl) = (g.scaled(tube, 2.0), g.add(bowl, y));
        g.min(&[tube, bowl])
    })
}

fn heart() -> Function {
    function(|g, [x, y, z]| {
        let one = g.constant(1.0);
        g.internal("f_heart", &[x, y, z, one], NoiseGenerator::default())
    })
}

fn gyroid() -> Function {
    function(|g, [x, y, z]| {
        let scaled = [x, y, z].map(|c| g.scaled(c, 4.0));
        let [x, y, z] = scaled;
        let mut term = |a: Expr, b: Expr| {
            let (s, c) = (g.sin(a), g.cos(b));
            g.mul(s, c)
        };
        let terms = [term(x, y), term(y, z), term(z, x)];
        g.total(&terms)
    })
}

fn bumpy() -> Function {
    function(|g, [x, y, z]| {
        let many = [x, y, z].map(|c| g.scaled(c, 5.0));
        let noise = g.internal("f_noise3d", &many, NoiseGenerator::default());
        let r = g.length(&[x, y, z]);
        let noise = g.scaled(noise, 0.4);
        let sum = g.add(r, noise);
        g.offset(sum, -1.0)
    })
}

/// A sum over octaves of noise, coarse enough to be bounded on segments.
fn octaves() -> Function {
    function(|g, [x, y, z]| {
        let parameters = [0.8, 2.0, 4.0, 0.5, 0.8, 2.0].map(|number| g.constant(number));
        let [a, b, c, d, e, f] = parameters;
        g.internal(
            "f_hetero_mf",
            &[x, y, z, a, b, c, d, e, f],
            NoiseGenerator::default(),
        )
    })
}

/// Noise that rounds the point.
fn rounded_noise() -> Function {
    function(|g, [x, y, z]| {
        let [x, y, z] = [x, y, z].map(|c| g.scaled(c, 3.0));
        g.internal("f_noise3d", &[x, y, z], NoiseGenerator::Perlin)
    })
}

fn cube(side: f64) -> Container {
    Container::Box(Cuboid::new(DVec3::splat(-side), DVec3::splat(side)))
}

fn iso(function: Function, container: Container, threshold: f64) -> Isosurface {
    let options = IsosurfaceOptions {
        threshold,
        ..IsosurfaceOptions::default()
    };
    Isosurface::try_new(function, container, options).unwrap()
}

crate::primitive_tests!(whole, || iso(ball(), cube(1.5), 1.0));
crate::primitive_tests!(cut, || iso(ball(), cube(0.8), 1.0));
crate::primitive_tests!(shell_of_polynomials, || iso(shell(), cube(1.0), 0.2));
crate::primitive_tests!(union_of_polynomials, || iso(union(), cube(1.5), 1.0));
crate::primitive_tests!(degree_six, || iso(heart(), cube(1.3), -0.1));
crate::primitive_tests!(in_a_sphere, || iso(
    gyroid(),
    Container::Sphere(Sphere::new(DVec3::new(0.1, 0.0, 0.2), 1.0)),
    0.1
));
crate::primitive_tests!(noisy, || iso(bumpy(), cube(1.1), 0.0));
crate::primitive_tests!(sum_over_octaves, || iso(octaves(), cube(1.0), 0.8));
crate::primitive_tests!(stated_gradient, || sum_with_gradient(Some(5.0)));

/// A sum over octaves with a stated gradient.
fn sum_with_gradient(max_gradient: Option<f64>) -> Isosurface {
    let options = IsosurfaceOptions {
        threshold: 0.8,
        max_gradient,
        ..IsosurfaceOptions::default()
    };
    Isosurface::try_new(octaves(), cube(1.0), options).unwrap()
}

fn trusts_gradient(surface: &Isosurface) -> bool {
    with_workspace(|workspace| surface.trusts_gradient(workspace))
}

fn hits(surface: &Isosurface, origin: DVec3, direction: DVec3) -> Vec<(f64, u32)> {
    let mut out = Crossings::default();
    let ray = Ray::new(origin, direction);
    surface.crossings(
        &ray,
        Interval::LINE,
        None,
        &mut Scratch::default(),
        &mut out,
    );
    out.list
        .iter()
        .map(|c| (c.hit.t, c.hit.surface.facet))
        .collect()
}

#[test]
fn crossings_are_those_of_the_sphere() {
    let surface = iso(ball(), cube(1.5), 1.0);
    let sphere = Sphere::new(DVec3::ZERO, 1.0);
    let (mut random, mut scratch) = (Random::new(3), Scratch::default());
    let mut found = 0;
    for _ in 0..2000 {
        let (from, to) = (random.cube() * 4.0, random.cube());
        let ray = Ray::new(from, to - from);
        let ours = surface.closest_hit(&ray, Interval::FORWARD, None, &mut scratch);
        let theirs = sphere.closest_hit(&ray, Interval::FORWARD, None, &mut scratch);
        let chord = theirs.map_or(0.0, |hit| {
            ray.direction
                .normalize()
                .dot(sphere.surface_at(&ray, &hit).n_geom)
                .abs()
        });
        if chord < 0.05 {
            continue;
        }
        let (ours, theirs) = (ours.unwrap().t, theirs.unwrap().t);
        assert!((ours - theirs).abs() < 1e-13, "{ray:?} {ours} {theirs}");
        found += 1;
    }
    assert!(found > 500);
}

#[test]
fn rays_from_within_know_the_side_on_which_they_start() {
    let surface = iso(ball(), cube(1.5), 1.0);
    let (mut random, mut scratch) = (Random::new(5), Scratch::default());
    for _ in 0..500 {
        let (from, to) = (random.cube() * 1.4, random.cube() * 1.4);
        let ray = Ray::new(from, to - from);
        let mut out = Crossings::default();
        surface.crossings(&ray, Interval::FORWARD, None, &mut scratch, &mut out);
        assert_eq!(out.inside_at_start, from.length() < 1.0, "{from}");
    }
}

/// The same surface, searched although polynomials decide.
fn searched(surface: &Isosurface) -> Isosurface {
    let (function, container) = (surface.function.clone(), surface.container.clone());
    let mut other = Isosurface::try_new(function, container, surface.options.clone()).unwrap();
    other.decision = OnceLock::from(None);
    other
}

fn decides(surface: &Isosurface) -> bool {
    with_workspace(|workspace| surface.find_decision(workspace).is_some())
}

#[test]
fn polynomials_are_solved_where_a_search_finds_crossings() {
    let turned_out = function(|g, xyz| {
        let square = g.norm2(&xyz);
        g.neg(square)
    });
    for (function, container, threshold) in [
        (ball(), cube(0.8), 1.0),
        (distance(), cube(0.9), 1.0),
        (turned_out, cube(1.1), -1.0),
        (shell(), cube(1.0), 0.2),
        (union(), cube(1.5), 1.0),
        (heart(), cube(1.3), -0.1),
    ] {
        let solved = iso(function, container, threshold);
        assert!(decides(&solved), "{solved:?}");
        let searched = searched(&solved);
        let mut random = Random::new(11);
        let (mut crossings, mut others) = (0, 0);
        for _ in 0..2000 {
            let (from, to) = (random.cube() * 3.0, random.cube());
            let (ours, theirs) = [&solved, &searched]
                .map(|surface| hits(surface, from, to - from))
                .into();
            crossings += theirs.len();
            let near = |(a, b): (&(f64, u32), &(f64, u32))| a.1 == b.1 && (a.0 - b.0).abs() <= 1e-7;
            // Lines that touch the surface.
            let agrees = ours.len() == theirs.len() && ours.iter().zip(&theirs).all(near);
            others += u32::from(!agrees);
        }
        assert!(
            crossings > 1000 && others <= 4,
            "{crossings} {others} {solved:?}"
        );
    }
}

#[test]
fn polynomials_do_not_decide_where_they_are_less_exact() {
    // Far from the center of the container the ball is as small as the rounding errors of the powers.
    let power = |far: f64| {
        function(move |g, [x, y, z]| {
            let x = g.offset(x, -far);
            let square = g.norm2(&[x, y, z]);
            g.powi(square, 6)
        })
    };
    assert!(decides(&iso(power(0.0), cube(1.5), 1.0)));
    assert!(!decides(&iso(power(100.0), cube(200.0), 1.0)));
    // Nothing is known of what lines do not meet.
    assert!(!decides(&iso(ball(), cube(1.0), 4.0)));
    // A root of negative numbers.
    let root = function(|g, [x, ..]| g.sqrt(x));
    assert!(!decides(&iso(root, cube(1.0), 0.5)));
    assert!(!decides(&iso(gyroid(), cube(1.0), 0.1)));
}

#[test]
fn sums_over_octaves_are_searched_on_segments_if_they_are_coarse() {
    assert_eq!(iso(octaves(), cube(1.0), 0.8).rates, Rates::OfSegments);
    assert_eq!(iso(octaves(), cube(20.0), 0.8).rates, Rates::Unknown);
}

#[test]
fn rays_that_leave_noise_that_rounds_points_do_not_meet_it_at_once() {
    let surface = iso(rounded_noise(), cube(1.0), 0.5);
    let (mut random, mut scratch) = (Random::new(7), Scratch::default());
    let mut left = 0;
    for _ in 0..1000 {
        let (from, to) = (random.cube() * 4.0, random.cube());
        let ray = Ray::new(from, to - from);
        let Some(hit) = surface.closest_hit(&ray, Interval::FORWARD, None, &mut scratch) else {
            continue;
        };
        let point = surface.surface_at(&ray, &hit);
        if hit.surface != SURFACE {
            continue;
        }
        let mut way = random.cube();
        if way.dot(point.n_geom) < 0.0 {
            way = -way;
        }
        // Along the surface it may be met again.
        if way.dot(point.n_geom) < 0.1 {
            continue;
        }
        let away = Ray::new(point.position, way);
        let again = surface.closest_hit(&away, Interval::FORWARD, Some(SURFACE), &mut scratch);
        assert!(again.is_none_or(|hit| hit.t > 1e-5), "{away:?} {again:?}");
        left += 1;
    }
    assert!(left > 200, "{left}");
}

#[test]
fn steep_thin_sheets_have_no_holes() {
    // A sheet of thickness 0.002 with a gradient of about 1000; POV-Ray's default gradient would lose all of it.
    let sheet = function(|g, [x, y, _]| {
        let wave = g.sin(y);
        let bent = g.sub(x, wave);
        let height = g.abs(bent);
        let steep = g.scaled(height, 1000.0);
        g.offset(steep, -1.0)
    });
    let surface = iso(sheet, cube(1.0), 0.0);
    for i in 0..200 {
        let y = f64::from(i) / 200.0 - 0.5;
        let found = hits(&surface, DVec3::new(-3.0, y, 0.1 * y), DVec3::X);
        assert_eq!(found.len(), 2, "{y}: {found:?}");
        assert!((found[0].0 - (3.0 + strahl_math::det::sin(y) - 0.001)).abs() < 1e-12);
    }
}

#[test]
fn the_container_closes_what_it_cuts_unless_open() {
    let surface = iso(ball(), cube(0.5), 1.0);
    assert_eq!(
        hits(&surface, DVec3::new(-2.0, 0.0, 0.0), DVec3::X).len(),
        2
    );
    let options = IsosurfaceOptions {
        open: true,
        threshold: 1.0,
        ..IsosurfaceOptions::default()
    };
    let open = Isosurface::try_new(ball(), cube(0.5), options).unwrap();
    let ray = Ray::new(DVec3::new(-2.0, 0.0, 0.0), DVec3::X);
    let scratch = &mut Scratch::default();
    assert!(
        open.closest_hit(&ray, Interval::FORWARD, None, scratch)
            .is_none()
    );
    assert!(
        surface
            .closest_hit(&ray, Interval::FORWARD, None, scratch)
            .is_some()
    );
    assert!(open.contains(DVec3::ZERO) && !open.contains(DVec3::X * 0.6));
}

/// A field that reports no bounds.
#[derive(Debug)]
struct Opaque;

impl ScalarField for Opaque {
    fn value(&self, p: &[f64]) -> f64 {
        strahl_math::det::sin(7.0 * p[0])
    }
}

#[test]
fn without_bounds_the_gradient_is_trusted() {
    let field: Arc<dyn ScalarField> = Arc::new(Opaque);
    let waves = function(|g, xyz| g.field(&field, &xyz));
    assert!(!waves.is_bounded());
    let options = IsosurfaceOptions {
        max_gradient: Some(7.0),
        ..IsosurfaceOptions::default()
    };
    let surface = Isosurface::try_new(waves, cube(1.0), options).unwrap();
    let found = hits(&surface, DVec3::new(-3.0, 0.1, 0.2), DVec3::X);
    // Zeros at multiples of pi / 7: from -2 to 2; the wave is negative at the right end, positive at the left.
    let expected: Vec<f64> = (-2..=2)
        .map(|k| 3.0 + f64::from(k) * std::f64::consts::PI / 7.0)
        .collect();
    let inner: Vec<f64> = found.iter().filter(|h| h.1 == 0).map(|h| h.0).collect();
    assert_eq!(inner.len(), expected.len(), "{found:?}");
    assert!(
        inner
            .iter()
            .zip(&expected)
            .all(|(a, b)| (a - b).abs() < 1e-12),
        "{found:?}"
    );
}

#[test]
fn a_stated_gradient_is_trusted_for_sums_unless_slopes_contradict_it() {
    let trusted = |gradient| trusts_gradient(&sum_with_gradient(gradient));
    assert!(!trusted(None));
    assert!(trusted(Some(3.5)) && trusted(Some(5.0)));
    assert!(!trusted(Some(0.5)) && !trusted(Some(50.0)));
    let of = |function, gradient| {
        let options = IsosurfaceOptions {
            max_gradient: Some(gradient),
            ..IsosurfaceOptions::default()
        };
        trusts_gradient(&Isosurface::try_new(function, cube(1.0), options).unwrap())
    };
    // These have bounds that cost little.
    assert!(!of(ball(), 2.0) && !of(bumpy(), 3.0));
}

#[test]
fn what_is_found_by_a_stated_gradient_is_what_is_proven() {
    let (proven, stated) = (sum_with_gradient(None), sum_with_gradient(Some(5.0)));
    let mut random = Random::new(8);
    let (mut found, mut others) = (0, 0);
    for _ in 0..1500 {
        let (from, to) = (random.cube() * 4.0, random.cube());
        let (a, b) = (
            hits(&proven, from, to - from),
            hits(&stated, from, to - from),
        );
        found += a.len();
        let same = a.len() == b.len()
            && a.iter()
                .zip(&b)
                .all(|(a, b)| a.1 == b.1 && (a.0 - b.0).abs() < 1e-12);
        others += u32::from(!same);
    }
    assert!(found > 1000 && others <= 2, "{found} {others}");
}

#[test]
fn what_is_not_a_number_is_outside() {
    // A root of x, which is undefined for negative x.
    let half = function(|g, [x, y, _]| {
        let root = g.sqrt(x);
        let sum = g.add(root, y);
        g.offset(sum, -0.5)
    });
    let surface = iso(half, cube(1.0), 0.0);
    assert!(!surface.contains(DVec3::new(-0.5, -0.9, 0.0)));
    assert!(surface.contains(DVec3::new(0.5, -0.9, 0.0)));
    let found = hits(&surface, DVec3::new(-2.0, -0.5, 0.0), DVec3::X);
    assert!(
        (found[0].0 - 2.0).abs() < 1e-12 && found.len() == 2,
        "{found:?}"
    );
}

#[test]
fn wrong_parameters_are_refused() {
    let make = |accuracy, max_gradient, threshold| {
        let options = IsosurfaceOptions {
            accuracy,
            max_gradient: Some(max_gradient),
            threshold,
            open: false,
        };
        Isosurface::try_new(ball(), Container::default(), options)
    };
    assert!(make(0.001, 1.1, 0.0).is_ok());
    assert!(make(0.0, 1.1, 0.0).is_err());
    assert!(make(0.001, -1.0, 0.0).is_err());
    assert!(make(0.001, 1.1, f64::NAN).is_err());
    let flat = Container::Sphere(Sphere::new(DVec3::ZERO, 0.0));
    assert!(Isosurface::try_new(ball(), flat, IsosurfaceOptions::default()).is_err());
    let mut graph = Graph::new(["u"]);
    let root = graph.constant(1.0);
    let short = graph.finish(root).unwrap();
    assert!(
        Isosurface::try_new(short, Container::default(), IsosurfaceOptions::default()).is_err()
    );
}
