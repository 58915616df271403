//! Fractals.

use super::{Measured, field};
use crate::patterns::*;

pub(super) fn measured() -> Vec<Measured> {
    vec![
        (
            "mandel 20",
            field(
                Pattern::Fractal(Fractal {
                    ..Fractal::mandelbrot(20)
                }),
                Modifiers::default(),
            ),
            [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.1, 0.15, 0.0, 0.0, 0.0],
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
            [
                0.448638072,
                0.360555128,
                0.153477251,
                0.151426714,
                0.786418372,
                0.0920262957,
                0.516829151,
                0.57546257,
                0.313002995,
                0.83444495,
                0.717014015,
                0.907813504,
            ],
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
            [
                0.399637664,
                0.319185646,
                0.0,
                0.166177138,
                0.0,
                0.0,
                0.0,
                0.0,
                0.268499955,
                0.0,
                0.05,
                0.0,
            ],
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
            [
                0.0306603774,
                0.45,
                0.1,
                0.0326575751,
                0.00268799534,
                0.000346602082,
                0.1,
                0.15,
                0.2,
                0.25,
                0.65,
                0.15,
            ],
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
            [1.0, 1.0, 1.0, 1.0, 1.0, 0.15, 0.1, 1.0, 1.0, 1.0, 1.0, 0.3],
        ),
    ]
}
