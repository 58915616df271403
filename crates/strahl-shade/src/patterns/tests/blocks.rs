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

/// Of POV-Ray 3.7.0.10: `function { pattern { checker } }` and so on, a little in front of the borders and behind them.
#[test]
fn borders_belong_to_the_block_behind_them() {
    let value = |pattern: &Pattern, p: [f64; 3]| {
        let place = DVec3::from_array(p);
        PatternField::from(pattern.clone()).value(&TexturePoint::in_space(place))
    };
    let brick = Pattern::Brick {
        size: DVec3::new(8.0, 3.0, 4.5),
        mortar: 0.5,
    };
    for (off, behind) in [(-1.1e-10, false), (-0.9e-10, true), (0.0, true)] {
        let (block, shade) = if behind { (1.0, 5.525) } else { (0.0, 0.892) };
        let checker = |p: [f64; 3]| value(&Pattern::Checker, p);
        assert_eq!(checker([3.0 + off, 0.5, 0.5]), block);
        assert_eq!(checker([0.5, 3.0 + off, 0.5]), block);
        assert_eq!(checker([-3.0 + off, 0.5, 0.5]), block);
        assert_eq!(checker([off, 0.5, 0.5]), 1.0 - block);
        let cell = 9.0 * value(&Pattern::Cells, [3.0 + off, 0.5, 0.5]);
        assert!((cell - shade).abs() < 6e-4, "{cell}");
        // The mortar ends each brick.
        assert_eq!(value(&brick, [1.0, 3.0 + off, 1.0]), block);
        assert_eq!(value(&brick, [1.0, 2.5 + off, 1.0]), 1.0 - block);
        assert_eq!(value(&brick, [3.5 + off, 4.0, 1.0]), 1.0 - block);
    }
}
