//! Patterns of blocks.

use super::{Built, field};
use crate::patterns::*;

pub(super) fn built() -> Vec<Built> {
    vec![
        ("checker", field(Pattern::Checker, Modifiers::default())),
        (
            "brick",
            field(
                Pattern::Brick {
                    size: DVec3::new(8.0, 3.0, 4.5),
                    mortar: 0.5,
                },
                Modifiers::default(),
            ),
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
        ),
        (
            "hexagon rgb 0 rgb 1 rgb 2",
            field(Pattern::Hexagon, Modifiers::default()),
        ),
        (
            "square rgb 0 rgb 1 rgb 2 rgb 3",
            field(Pattern::Square, Modifiers::default()),
        ),
        (
            "triangular rgb 0 rgb 1 rgb 2 rgb 3 rgb 4 rgb 5",
            field(Pattern::Triangular, Modifiers::default()),
        ),
        (
            "cubic rgb 0 rgb 1 rgb 2 rgb 3 rgb 4 rgb 5",
            field(Pattern::Cubic, Modifiers::default()),
        ),
    ]
}
