//! Patterns of blocks.

use super::{Measured, field};
use crate::patterns::*;

pub(super) fn measured() -> Vec<Measured> {
    vec![
        (
            "checker",
            field(Pattern::Checker, Modifiers::default()),
            [0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
        ),
        (
            "brick",
            field(
                Pattern::Brick {
                    size: DVec3::new(8.0, 3.0, 4.5),
                    mortar: 0.5,
                },
                Modifiers::default(),
            ),
            [1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0],
        ),
        (
            "brick brick_size <2,1,1.5> mortar .1",
            field(
                Pattern::Brick {
                    size: DVec3::new(2.0, 1.0, 1.5),
                    mortar: 0.1,
                },
                Modifiers::default(),
            ),
            [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0],
        ),
        (
            "hexagon rgb 0 rgb 1 rgb 2",
            field(Pattern::Hexagon, Modifiers::default()),
            [0.0, 0.0, 2.0, 0.0, 0.0, 2.0, 0.0, 1.0, 2.0, 0.0, 2.0, 2.0],
        ),
        (
            "square rgb 0 rgb 1 rgb 2 rgb 3",
            field(Pattern::Square, Modifiers::default()),
            [0.0, 2.0, 3.0, 0.0, 1.0, 3.0, 3.0, 1.0, 3.0, 2.0, 2.0, 1.0],
        ),
        (
            "triangular rgb 0 rgb 1 rgb 2 rgb 3 rgb 4 rgb 5",
            field(Pattern::Triangular, Modifiers::default()),
            [1.0, 3.0, 4.0, 0.0, 2.0, 4.0, 0.0, 1.0, 2.0, 0.0, 4.0, 3.0],
        ),
        (
            "cubic rgb 0 rgb 1 rgb 2 rgb 3 rgb 4 rgb 5",
            field(Pattern::Cubic, Modifiers::default()),
            [2.0, 3.0, 2.0, 4.0, 5.0, 0.0, 2.0, 3.0, 5.0, 5.0, 5.0, 0.0],
        ),
    ]
}
