//! Algebraic surfaces: polynomials times the field strength `P0`, limited to -10..=10.
//!
//! The polynomials were found by least squares through values of POV-Ray 3.7 at random points (residuals below 1e-12) and
//! are written in the form in which the surfaces are known.

use super::{Arguments, Formula, Internal, term::Term};

/// Limits a value to `-10..=10`, as POV-Ray does.
pub(super) fn limited<'a, 'g>(value: Term<'a, 'g>) -> Term<'a, 'g> {
    let limit = value.number(10.0);
    value.max(-limit).min(limit)
}

/// POV-Ray gives the cushion for `f_odd`, too.
fn cushion<'a, 'g>(Arguments { x, y, z, .. }: Arguments<'a, 'g>) -> Term<'a, 'g> {
    let (x2, y2, z2) = (x.square(), y.square(), z.square());
    z2 * x2 - z2.square() - z * x2 * 2.0 + z.powi(3) * 2.0 + x2
        - z2
        - (x2 - z).square()
        - y2.square()
        - x2 * y2 * 2.0
        - y2 * z2
        + y2 * z * 2.0
        + y2
}

/// Enneper's surface, as POV-Ray has it: of the equation `a³ = 6b²` with `a = (y²-x²)/2z + 2z²/9 + 2/3` and
/// `b = (y²-x²)/4z - (x²+y²+8z²/9)/4 + 2/9` the terms with the fractions 2/3, 1/4 and 2/9 are missing. Heights below 0.2
/// are divided by 0.2.
fn enneper<'a, 'g>(Arguments { x, y, z, .. }: Arguments<'a, 'g>) -> Term<'a, 'g> {
    let low = -(z.abs() - 0.2);
    let quotient = (y.square() - x.square()).over(low.if_positive(z.number(0.2), z));
    let a = quotient * 0.5 + z.square() * (2.0 / 9.0);
    (quotient * 0.25).square() * 6.0 - a.powi(3)
}

macro_rules! algebraic {
    ($($name:literal, $parameters:literal, $formula:expr;)*) => {
        pub(super) const TABLE: &[Internal] = &[$(
            Internal {
                name: $name,
                parameters: $parameters,
                formula: Formula::Terms(|a| {
                    let polynomial: for<'a, 'g> fn(Arguments<'a, 'g>) -> Term<'a, 'g> = $formula;
                    limited(a.p[0] * polynomial(a))
                }),
            },
        )*];
    };
}

algebraic! {
    // `(x² + z²) a y - (x² + y² + z²)²`: y axis of symmetry.
    "f_bifolia", 2, |Arguments { x, y, z, p: [_, a, ..] }| {
        a * y * (x.square() + z.square()) - (x.square() + y.square() + z.square()).square()
    };
    // The bicorn `(r² + 2ay - a²)² = y²(a² - r²)` turned about the y axis.
    "f_bicorn", 2, |Arguments { x, y, z, p: [_, a, ..] }| {
        let r2 = x.square() + z.square();
        y.square() * (a.square() - r2) - (r2 + a * y * 2.0 - a.square()).square()
    };
    // Boy's surface after Apéry. The "scale" multiplies the value.
    "f_boy_surface", 2, |Arguments { x, y, z, p: [_, scale, ..] }| {
        let (r2, z2) = (x.square() + y.square(), z.square());
        let w = -z + 1.0;
        let q = w * z;
        let sqrt2 = std::f64::consts::SQRT_2;
        let inner = r2.square() * 27.0 - r2 * z2 * 24.0
            + y * z * (y.square() - x.square() * 3.0) * (36.0 * sqrt2)
            + z2.square() * 4.0;
        let outer = r2.square() * -81.0 - r2 * z2 * 72.0
            + x * z * (x.square() - y.square() * 3.0) * (108.0 * sqrt2)
            + z2.square() * 4.0;
        let polynomial = q.powi(3) * 64.0 - q.square() * (r2 * 3.0 + z2 * 2.0) * 48.0
            + q * inner * 12.0
            + (r2 * 9.0 - z2 * 2.0) * outer;
        polynomial * scale
    };
    "f_crossed_trough", 1, |Arguments { x, y, z, .. }| x.square() * z.square() - y;
    "f_cubic_saddle", 1, |Arguments { x, y, z, .. }| y.powi(3) - x.powi(3) + z;
    "f_cushion", 1, cushion;
    "f_devils_curve", 1, |Arguments { x, y, z, .. }| {
        y.powi(4) - (x.square() + z.square()).square() + x.square() * 0.36 - y.square() * 0.25
    };
    // The inversion of a torus about the y axis in a sphere of radius `k`.
    //
    // POV-Ray's polynomial differs from that of the inversion in one coefficient, that of `y |p|²`; the last line here.
    "f_dupin_cyclid", 6, |Arguments { x, y, z, p: [_, major, minor, a, b, k, ..] }| {
        let q = x.square() + y.square() + z.square();
        let gap = major.square() - minor.square();
        let d = a.square() + b.square() + gap;
        let k2 = k.square();
        (major * 2.0).square() * ((k2 * x - a * q).square() + (k2 * z).square())
            - (k2.square() - k2 * (a * x + b * y) * 2.0 + d * q).square()
            - k2 * b * gap * y * q * 8.0
    };
    "f_enneper", 1, enneper;
    "f_folium_surface", 3, |Arguments { x, y, z, p: [_, a, b, ..] }| {
        (y.square() + z.square()) * (x * (b - a * 4.0) + 1.0) + x.square() * (b + 1.0)
    };
    "f_glob", 1, |Arguments { x, y, z, .. }| {
        (x.powi(5) + x.powi(4)) * 0.5 - (y.square() + z.square())
    };
    "f_heart", 1, |Arguments { x, y, z, .. }| {
        let inner = x.square() * 2.0 + y.square() + z.square() - 1.0;
        (x.square() * 0.1 + y.square()) * z.powi(3) - inner.powi(3)
    };
    "f_hunt_surface", 1, |Arguments { x, y, z, .. }| {
        let (x2, y2, z2) = (x.square(), y.square(), z.square());
        -((x2 + y2 + z2 - 13.0).powi(3) * 4.0 + (x2 * 3.0 + y2 - z2 * 4.0 - 12.0).square() * 27.0)
    };
    "f_hyperbolic_torus", 3, |Arguments { x, y, z, p: [_, major, minor, ..] }| {
        let (r2, s2) = (major.square(), minor.square());
        let q = x.square() - z.square();
        -(q.square() + x.square() * y.square() * 2.0 - y.square() * z.square() * 2.0 + y.powi(4)
            - (r2 + s2) * q * 2.0 + (r2 - s2) * y.square() * 2.0 + (r2 - s2).square())
    };
    "f_kampyle_of_eudoxus", 3, |Arguments { x, y, z, p: [_, a, b, ..] }| {
        b.square() * (x.powi(4) - (a * x).square()) - (y.square() + z.square())
    };
    "f_klein_bottle", 1, |Arguments { x, y, z, .. }| {
        let q = x.square() + y.square() + z.square() - 1.0;
        let b = q - y * 2.0;
        -((q + y * 2.0) * (b.square() - z.square() * 8.0) + x * z * b * 16.0)
    };
    "f_kummer_surface_v1", 1, |Arguments { x, y, z, .. }| {
        let (x2, y2, z2) = (x.square(), y.square(), z.square());
        -(x2.square() + y2.square() + z2.square()
            - (x2 + y2 + z2) - (x2 * y2 + y2 * z2 + z2 * x2) + 1.0)
    };
    "f_kummer_surface_v2", 4, |Arguments { x, y, z, p: [_, a, b, c, ..] }| {
        let (x2, y2, z2) = (x.square(), y.square(), z.square());
        -(x2.square() + y2.square() + z2.square()
            + a * (x2 + y2 + z2) + b * (x2 * y2 + y2 * z2 + z2 * x2) + c * x * y * z - 1.0)
    };
    "f_lemniscate_of_gerono", 1, |Arguments { x, y, z, .. }| {
        x.square() - x.powi(4) - y.square() - z.square()
    };
    "f_mitre", 1, |Arguments { x, y, z, .. }| {
        let (x2, y2, z2) = (x.square(), y.square(), z.square());
        y2 * (-(y2 + z2) + 1.0) - x2 * (x2 + y2 + z2) * 4.0
    };
    "f_nodal_cubic", 1, |Arguments { y, z, .. }| y * z * 6.0 - y.powi(3) - z.powi(3);
    "f_odd", 1, cushion;
    "f_ovals_of_cassini", 4, |Arguments { x, y, z, p: [_, a, b, c, ..] }| {
        let r2 = x.square() + z.square();
        c * a.square() * r2 + b.square() - (r2 + y.square() + a.square()).square()
    };
    "f_paraboloid", 1, |Arguments { x, y, z, .. }| y - (x.square() + z.square());
    "f_parabolic_torus", 3, |Arguments { x, y, z, p: [_, major, minor, ..] }| {
        let (r2, s2) = (major.square(), minor.square());
        -((x.square() + y.square() - z).square() + (r2 + s2) * (z - x.square())
            + (r2 - s2) * y.square() + (r2 - s2).square())
    };
    "f_pillow", 1, |Arguments { x, y, z, .. }| {
        x.powi(4) + y.powi(4) + z.powi(4) - (x.square() + y.square() + z.square())
    };
    "f_piriform", 1, |Arguments { x, y, z, .. }| {
        x.powi(4) - x.powi(3) + y.square() + z.square()
    };
    "f_quartic_paraboloid", 1, |Arguments { x, y, z, .. }| y - (x.powi(4) + z.powi(4));
    "f_quartic_saddle", 1, |Arguments { x, y, z, .. }| y + z.powi(4) - x.powi(4);
    "f_quartic_cylinder", 3, |Arguments { x, y, z, p: [_, a, b, ..] }| {
        (a * b).square() - (x.square() + z.square()) * (y.square() + b.square())
    };
    "f_steiners_roman", 1, |Arguments { x, y, z, .. }| {
        let (x2, y2, z2) = (x.square(), y.square(), z.square());
        -(x2 * y2 + y2 * z2 + z2 * x2 + x * y * z)
    };
    "f_strophoid", 4, |Arguments { x, y, z, p: [_, a, b, c, ..] }| {
        (x - b) * (y.square() + z.square()) + c.square() * (x.square() * a + x.powi(3))
    };
    "f_torus2", 3, |Arguments { x, y, z, p: [_, major, minor, ..] }| {
        // The quartic of the torus: (|p|² + R² - r²)² = 4 R² (x² + z²).
        let q = x.square() + y.square() + z.square() + major.square() - minor.square();
        (major * 2.0).square() * (x.square() + z.square()) - q.square()
    };
    "f_torus_gumdrop", 1, |Arguments { x, y, z, .. }| {
        let (x2, r2) = (x.square(), y.square() + z.square());
        -((x2.square() + r2.square()) * 4.0 + x2 * r2 * 17.0 - (x2 + r2) * 20.0 + 17.0)
    };
    "f_umbrella", 1, |Arguments { x, y, z, .. }| y * z.square() - x.square();
    "f_witch_of_agnesi", 2, |Arguments { x, y, z, p: [_, a, ..] }| {
        a - y * (a + x.square() + z.square())
    };
}
