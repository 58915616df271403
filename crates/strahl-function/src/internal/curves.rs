//! Plane algebraic curves, extruded along z or turned about the y axis: the functions with the three SOR parameters.

use super::algebraic::limited;
use super::{Arguments, Formula, Internal, term::Term};

/// The place in the plane of the curve. With `switch` above zero the plane is that of the distance from the y axis, shifted
/// by `offset` and turned by `angle` degrees.
fn plane<'a, 'g>(
    a: Arguments<'a, 'g>,
    switch: Term<'a, 'g>,
    offset: Term<'a, 'g>,
    angle: Term<'a, 'g>,
) -> (Term<'a, 'g>, Term<'a, 'g>) {
    let r = (a.x.square() + a.z.square()).sqrt() - offset;
    let angle = angle.radians();
    let (sin, cos) = (angle.sin(), angle.cos());
    (
        switch.if_positive(r * cos - a.y * sin, a.x),
        switch.if_positive(r * sin + a.y * cos, a.y),
    )
}

/// Curves with the field limit `P1`.
macro_rules! cylinder {
    ($name:literal, $curve:expr) => {
        Internal {
            name: $name,
            parameters: 5,
            formula: Formula::Terms(|a| {
                let [strength, limit, switch, offset, angle, ..] = a.p;
                let curve: for<'a, 'g> fn(Term<'a, 'g>, Term<'a, 'g>) -> Term<'a, 'g> = $curve;
                let (x, y) = plane(a, switch, offset, angle);
                (strength * curve(x, y)).max(-limit).min(limit)
            }),
        }
    };
}

/// Curves with two or three parameters after the field strength.
macro_rules! curve {
    ($name:literal, 2, $curve:expr) => {
        curve!($name, 6, $curve, 3)
    };
    ($name:literal, 3, $curve:expr) => {
        curve!($name, 7, $curve, 4)
    };
    ($name:literal, $parameters:literal, $curve:expr, $sor:literal) => {
        Internal {
            name: $name,
            parameters: $parameters,
            formula: Formula::Terms(|a| {
                let curve: for<'a, 'g> fn(
                    Term<'a, 'g>,
                    Term<'a, 'g>,
                    [Term<'a, 'g>; 3],
                ) -> Term<'a, 'g> = $curve;
                let (x, y) = plane(a, a.p[$sor], a.p[$sor + 1], a.p[$sor + 2]);
                limited(a.p[0] * curve(x, y, [a.p[1], a.p[2], a.p[3]]))
            }),
        }
    };
}

pub(super) const TABLE: &[Internal] = &[
    // A figure of eight; the cube is that of |x|, so that it has both loops.
    cylinder!("f_algbr_cyl1", |x, y| y.square() + x.abs().powi(3)
        - x.square()),
    cylinder!("f_algbr_cyl2", |x, y| {
        -(x.powi(4) * 2.0 - x.square() * y * 3.0 + (y.square() - y).square())
    }),
    cylinder!("f_algbr_cyl3", |x, y| {
        x.square() * y * 2.0 + x * y.square() - x.powi(4) - (x * y).square() - y.square()
    }),
    cylinder!("f_algbr_cyl4", |x, y| {
        y.powi(3) - x.square() * y * 3.0 - (x.square() + y.square()).square()
    }),
    curve!("f_devils_curve_2d", 2, |x, y, [a, b, _]| {
        y.powi(4) - x.powi(4) + (a * x).square() - (b * y).square()
    }),
    curve!("f_folium_surface_2d", 2, |x, y, [a, b, _]| {
        -(y.square() * (x * (b - a * 4.0) + 1.0) + x.square() * (b + 1.0))
    }),
    // The power of b differs from that of the surface in space; measured.
    curve!("f_kampyle_of_eudoxus_2d", 2, |x, y, [a, b, _]| {
        b.square() * x.powi(4) - a * b.powi(3) * x.square() - y.square()
    }),
    curve!("f_lemniscate_of_gerono_2d", 2, |x, y, [a, b, _]| {
        b.square() * ((a * x).square() - x.powi(4)) - y.square()
    }),
    curve!("f_piriform_2d", 3, |x, y, [a, b, c]| {
        c.square() * (a * x.powi(3) + b * x.powi(4)) - y.square()
    }),
    curve!("f_strophoid_2d", 3, |x, y, [a, b, c]| {
        (x - b) * y.square() + c.square() * (a * x.square() + x.powi(3))
    }),
    curve!("f_witch_of_agnesi_2d", 2, |x, y, [a, b, _]| {
        b - y * (a.square() + x.square())
    }),
];
