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
