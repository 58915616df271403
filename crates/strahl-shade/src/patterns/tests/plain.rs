//! Patterns that are formulas.

use super::{Built, field};
use crate::patterns::*;

pub(super) fn built() -> Vec<Built> {
    vec![
        ("boxed", field(Pattern::Boxed, Modifiers::default())),
        (
            "cylindrical",
            field(Pattern::Cylindrical, Modifiers::default()),
        ),
        ("leopard", field(Pattern::Leopard, Modifiers::default())),
        ("marble", field(Pattern::Marble, Modifiers::default())),
        ("onion", field(Pattern::Onion, Modifiers::default())),
        ("planar", field(Pattern::Planar, Modifiers::default())),
        ("radial", field(Pattern::Radial, Modifiers::default())),
        ("spherical", field(Pattern::Spherical, Modifiers::default())),
        ("wood", field(Pattern::Wood, Modifiers::default())),
        (
            "gradient <1,2,3>",
            field(
                Pattern::Gradient(DVec3::new(1.0, 2.0, 3.0)),
                Modifiers::default(),
            ),
        ),
        (
            "spiral1 3",
            field(Pattern::Spiral1(3.0), Modifiers::default()),
        ),
        (
            "spiral2 3",
            field(Pattern::Spiral2(3.0), Modifiers::default()),
        ),
        (
            "quilted",
            field(
                Pattern::Quilted {
                    control0: 1.0,
                    control1: 1.0,
                },
                Modifiers::default(),
            ),
        ),
        (
            "quilted control0 .25 control1 .75",
            field(
                Pattern::Quilted {
                    control0: 0.25,
                    control1: 0.75,
                },
                Modifiers::default(),
            ),
        ),
    ]
}
