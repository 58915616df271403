//! Tubes along helices, spirals and curves.

use super::solids::{cross_section, hypot, length};
use super::{Arguments, Formula, Internal, term::Term};
use std::f64::consts::TAU;

pub(super) const TABLE: &[Internal] = &[
    Internal {
        name: "f_helix1",
        parameters: 7,
        formula: Formula::Terms(helix1),
    },
    Internal {
        name: "f_helix2",
        parameters: 7,
        formula: Formula::Terms(helix2),
    },
    Internal {
        name: "f_helical_torus",
        parameters: 10,
        formula: Formula::Terms(helical_torus),
    },
    Internal {
        name: "f_spiral",
        parameters: 6,
        formula: Formula::Terms(spiral),
    },
    Internal {
        name: "f_polytubes",
        parameters: 6,
        formula: Formula::Terms(polytubes),
    },
];

/// `(a, b)` turned by an angle in radians.
fn turned<'a, 'g>(
    a: Term<'a, 'g>,
    b: Term<'a, 'g>,
    angle: Term<'a, 'g>,
) -> (Term<'a, 'g>, Term<'a, 'g>) {
    let (sin, cos) = (angle.sin(), angle.cos());
    (a * cos - b * sin, a * sin + b * cos)
}

/// The radius of a [cross section](cross_section) after a turn; round ones look the same from all sides.
fn turned_section<'a, 'g>(
    a: Term<'a, 'g>,
    b: Term<'a, 'g>,
    angle: Term<'a, 'g>,
    kind: Term<'a, 'g>,
) -> Term<'a, 'g> {
    if kind.is(1.0) {
        return hypot(a, b);
    }
    let (a, b) = turned(a, b, angle);
    cross_section(a, b, kind)
}

/// Tubes that wind around the y axis at a distance; their section is measured in the plane through the axis.
fn helix1<'a, 'g>(
    Arguments {
        x,
        y,
        z,
        p: [count, period, minor, major, stretch, section, angle, ..],
    }: Arguments<'a, 'g>,
) -> Term<'a, 'g> {
    let r = hypot(x, z);
    let sector = count.number(TAU).over(count);
    let turn = z.atan2(x) + period * y;
    // From the nearest tube, which is in the middle of its sector.
    let from_border = turn - sector * 0.5;
    let along = if angle.is(0.0) || section.is(1.0) {
        // Sections that are not turned are symmetric.
        from_border.triangle(sector)
    } else {
        from_border.folded(sector)
    };
    let height = along.over(period).over(stretch);
    let tube = turned_section(r - major, height, angle.radians(), section);
    tube.min(r + major) - minor
}

/// A column around the y axis, shifted from it, whose section turns as it rises. Its last parameter has no effect.
fn helix2<'a, 'g>(
    Arguments {
        x,
        y,
        z,
        p: [_, period, minor, major, _, section, ..],
    }: Arguments<'a, 'g>,
) -> Term<'a, 'g> {
    let turn = period * y;
    turned_section(
        x - major * turn.cos(),
        z - major * turn.sin(),
        -turn,
        section,
    ) - minor
}

/// Tubes that wind around a ring about the y axis, at a distance from its circle; their surface may wind, too.
fn helical_torus<'a, 'g>(
    Arguments {
        x,
        y,
        z,
        p:
            [
                major,
                around_axis,
                around_ring,
                relief,
                minor,
                distance,
                stretch,
                turns,
                skew,
                twist,
            ],
    }: Arguments<'a, 'g>,
) -> Term<'a, 'g> {
    use std::f64::consts::PI;
    let rho = hypot(x, z);
    let out = rho - major;
    let from_circle = hypot(out, y);
    let (alpha, beta) = (x.atan2(z), out.atan2(y));
    let (winding, full) = (
        around_axis * alpha + around_ring * beta - PI,
        x.number(2.0 * PI),
    );
    let off = from_circle - distance;
    let square = off.square() + stretch * winding.triangle(full).square();
    // The limit of the tubes on the other side of the axis.
    let across = rho + major - distance;
    let section = square.max(x.number(0.0)).sqrt().min(from_circle + distance);
    let wave = (twist * alpha + turns * (skew * winding.folded(full)).atan2(off)).cos();
    let outside = (section - relief * wave).min(across);
    (-square).if_positive(across, outside) - minor
}

/// A tube along a spiral of Archimedes in the plane `y = 0`, cut off by a sphere.
fn spiral<'a, 'g>(
    Arguments {
        x,
        y,
        z,
        p: [distance, thickness, radius, _, _, section, ..],
    }: Arguments<'a, 'g>,
) -> Term<'a, 'g> {
    let turns = (-z).atan2(x) * (1.0 / TAU) + 0.5;
    let across = (hypot(x, z) - distance * turns).triangle(distance);
    let centre = length(x, y, z);
    (cross_section(across, y, section).min(centre) - thickness).max(centre - radius)
}

/// Tubes arranged around the y axis; their distance from it is a polynomial of the height. For a whole number of tubes.
fn polytubes<'a, 'g>(
    Arguments {
        x,
        y,
        z,
        p: [count, a, b, c, d, e, ..],
    }: Arguments<'a, 'g>,
) -> Term<'a, 'g> {
    let distance = a + y * (b + y * (c + y * (d + y * e)));
    // A negative distance is one in the opposite direction.
    let zero = x.number(0.0);
    let opposite = distance.if_positive(zero, x.number(std::f64::consts::PI));
    let angle = (x.atan2(z) + opposite).triangle(count.number(TAU).over(count));
    let (r, distance) = (hypot(x, z), distance.abs());
    hypot(r * angle.cos() - distance, r * angle.sin())
}
