//! Fractals.

use super::{Built, field};
use crate::patterns::*;

pub(super) fn built() -> Vec<Built> {
    vec![
        (
            "mandel 20",
            field(
                Pattern::Fractal(Fractal {
                    ..Fractal::mandelbrot(20)
                }),
                Modifiers::default(),
            ),
        ),
        (
            "mandel 20 exponent 3 exterior 2,.0625 interior 1,1",
            field(
                Pattern::Fractal(Fractal {
                    kind: FractalKind::Power { exponent: 3 },
                    exterior: Exterior::Real(0.0625),
                    interior: FractalInterior::Smallest(1.0),
                    ..Fractal::mandelbrot(20)
                }),
                Modifiers::default(),
            ),
        ),
        (
            "julia <.353,.288>,20 interior 1,1",
            field(
                Pattern::Fractal(Fractal {
                    julia: Some(DVec2::new(0.353, 0.288)),
                    interior: FractalInterior::Smallest(1.0),
                    ..Fractal::mandelbrot(20)
                }),
                Modifiers::default(),
            ),
        ),
        (
            "magnet 1 mandel 20 interior 1,.125",
            field(
                Pattern::Fractal(Fractal {
                    kind: FractalKind::Magnet1,
                    interior: FractalInterior::Smallest(0.125),
                    ..Fractal::mandelbrot(20)
                }),
                Modifiers::default(),
            ),
        ),
        (
            "magnet 2 julia <.5,.25>,20",
            field(
                Pattern::Fractal(Fractal {
                    kind: FractalKind::Magnet2,
                    julia: Some(DVec2::new(0.5, 0.25)),
                    ..Fractal::mandelbrot(20)
                }),
                Modifiers::default(),
            ),
        ),
    ]
}

/// The end of the orbit is that of all its steps, although whole rounds of a cycle are left out.
#[test]
fn cycles_are_left_out_exactly() {
    const STEPS: u32 = 3001;
    let mut cycles = 0;
    for step in 0..400 {
        let angle = f64::from(step) * 0.37;
        let point = DVec2::new(angle.cos(), angle.sin()) * (f64::from(step) / 400.0);
        let fractal = Fractal {
            interior: FractalInterior::Real(1.0),
            exterior: Exterior::Real(1.0),
            ..Fractal::mandelbrot(STEPS)
        };
        let (mut z, mut all) = (point, vec![]);
        for _ in 0..STEPS {
            let (x, y) = (z.x * z.x - z.y * z.y, z.x * z.y + z.y * z.x);
            z = DVec2::new(x, y) + point;
            if z.length_squared() > 4.0 {
                break;
            }
            cycles += u32::from(all.len() == 1000 && all.contains(&z));
            all.push(z);
        }
        assert_eq!(fractal.value(point), z.x, "{point}");
    }
    assert!(cycles > 50, "{cycles}");
}

/// The end of an orbit of powers is where it leaves the circle of radius 2, or its last point.
#[test]
fn orbits_end_where_they_leave_the_circle() {
    for (exponent, julia) in [
        (2, None),
        (2, Some(DVec2::new(-0.75, 0.11))),
        (2, Some(DVec2::new(1.9, 0.5))),
        (2, Some(DVec2::new(-2.0, 0.3))),
        (3, None),
        (5, Some(DVec2::new(0.6, -0.4))),
    ] {
        for iterations in [1, 7, 8, 9, 64, 301] {
            let fractal = Fractal {
                kind: FractalKind::Power { exponent },
                julia,
                interior: FractalInterior::Real(1.0),
                exterior: Exterior::Real(1.0),
                ..Fractal::mandelbrot(iterations)
            };
            for i in 0..40 {
                for j in 0..20 {
                    let point = DVec2::new(f64::from(i) / 8.0 - 2.5, f64::from(j) / 8.0 - 1.1);
                    let c = julia.unwrap_or(point);
                    let mut z = point;
                    for _ in 0..iterations {
                        let mut power = z;
                        for _ in 1..exponent {
                            let (a, b) = (power, z);
                            power = DVec2::new(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
                        }
                        z = power + c;
                        if !(z.length_squared() <= 4.0) {
                            break;
                        }
                    }
                    assert_eq!(fractal.value(point), z.x, "{fractal:?} {point}");
                }
            }
        }
    }
}

/// Points that are known to be in the set without their orbit have none that escapes.
#[test]
fn the_largest_parts_of_the_mandelbrot_set_are_inside() {
    let inside = Fractal {
        exterior: Exterior::Constant(0.5),
        ..Fractal::mandelbrot(2000)
    };
    let orbit = Fractal {
        interior: FractalInterior::Smallest(0.0),
        ..inside
    };
    for i in 0..60 {
        for j in 0..40 {
            let point = DVec2::new(f64::from(i) / 25.0 - 1.8, f64::from(j) / 30.0);
            let (known, found) = (inside.value(point), orbit.value(point));
            assert_eq!(known == 1.0, found == 0.0, "{point}");
        }
    }
}
