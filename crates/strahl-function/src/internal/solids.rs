//! Distances, boxes, blobs, bundles of ellipsoids, grids: the functions that aren't polynomials.

use super::{Arguments, Formula, Internal, term::Term};

/// A row of the table.
macro_rules! solid {
    ($name:literal, $parameters:literal, $formula:expr) => {
        Internal {
            name: $name,
            parameters: $parameters,
            formula: Formula::Terms($formula),
        }
    };
}

pub(super) fn length<'a, 'g>(x: Term<'a, 'g>, y: Term<'a, 'g>, z: Term<'a, 'g>) -> Term<'a, 'g> {
    (x.square() + y.square() + z.square()).sqrt()
}

pub(super) fn hypot<'a, 'g>(x: Term<'a, 'g>, y: Term<'a, 'g>) -> Term<'a, 'g> {
    (x.square() + y.square()).sqrt()
}

/// The squares of three ellipsoids of revolution, one along each axis; `e` flattens them across it.
fn ellipsoids<'a, 'g>(a: Arguments<'a, 'g>, e: Term<'a, 'g>) -> [Term<'a, 'g>; 3] {
    let (x, y, z) = (a.x.square(), a.y.square(), a.z.square());
    [x + e * (y + z), y + e * (x + z), z + e * (x + y)]
}

/// The radius of a cross section: a square for 0, a circle for 1, a diamond for 2, between and beyond them superellipses.
pub(super) fn cross_section<'a, 'g>(
    a: Term<'a, 'g>,
    b: Term<'a, 'g>,
    kind: Term<'a, 'g>,
) -> Term<'a, 'g> {
    let (a, b) = (a.abs(), b.abs());
    let exponent = kind.number(2.0).over(kind);
    let round = (a.pow(exponent) + b.pow(exponent)).pow(kind * 0.5);
    kind.if_zero(a.max(b), round)
}

/// The cell of a hexagonal tiling that `(x, y)` lies in: the distance from its centre as its edges measure it, and the
/// coordinates relative to the centre. The centres of neighbours are `sqrt 3` apart, one is the origin, one on the x axis.
fn hexagon<'a, 'g>(x: Term<'a, 'g>, y: Term<'a, 'g>) -> (Term<'a, 'g>, Term<'a, 'g>, Term<'a, 'g>) {
    let root = x.number(3f64.sqrt());
    let cell = |dx: f64, dy: f64| {
        let (x, y) = ((x - dx).folded(root), (y - dy).folded(root.number(3.0)));
        let radius = x.abs().max(x.abs() * 0.5 + y.abs() * 0.75f64.sqrt());
        (radius, x, y)
    };
    // Two rectangular lattices make the hexagonal one.
    let (a, b) = (cell(0.0, 0.0), cell(0.75f64.sqrt(), 1.5));
    let nearer = a.0 - b.0;
    (
        a.0.min(b.0),
        nearer.if_positive(b.1, a.1),
        nearer.if_positive(b.2, a.2),
    )
}

/// A woven grid of threads.
fn mesh<'a, 'g>(
    Arguments {
        x,
        y,
        z,
        p: [px, pz, width, weave, height, ..],
    }: Arguments<'a, 'g>,
) -> Term<'a, 'g> {
    let pi = std::f64::consts::PI;
    let (u, v) = (x.over(px), z.over(pz));
    // A thread along x goes over and under those along z, one after the other; the nearest is one of two.
    let along_x = |row: Term<'a, 'g>| {
        let middle = weave * (u * pi).cos() * row.parity();
        hypot(width * (z - pz * row), height * (y - middle))
    };
    let along_z = |column: Term<'a, 'g>| {
        let middle = weave * (v * pi).cos() * column.parity();
        hypot(width * (x - px * column), height * (y + middle))
    };
    let (row, column) = (v.floor(), u.floor());
    let threads_x = along_x(row).min(along_x(row + 1.0));
    threads_x.min(along_z(column)).min(along_z(column + 1.0))
}

pub(super) const TABLE: &[Internal] = &[
    solid!("f_r", 0, |Arguments { x, y, z, .. }| length(x, y, z)),
    solid!("f_ph", 0, |Arguments { x, y, z, .. }| hypot(x, z).atan2(y)),
    solid!("f_th", 0, |Arguments { x, z, .. }| x.atan2(z)),
    solid!("f_sphere", 1, |Arguments { x, y, z, p, .. }| length(
        x, y, z
    ) - p[0]),
    solid!("f_ellipsoid", 3, |Arguments {
                                  x,
                                  y,
                                  z,
                                  p: [a, b, c, ..],
                              }| {
        length(a * x, b * y, c * z)
    }),
    solid!("f_torus", 2, |Arguments {
                              x,
                              y,
                              z,
                              p: [major, minor, ..],
                          }| {
        hypot(hypot(x, z) - major, y) - minor
    }),
    solid!(
        "f_superellipsoid",
        2,
        |Arguments {
             x,
             y,
             z,
             p: [east, north, ..],
         }| {
            let two = x.number(2.0);
            let (e, n) = (two.over(east), two.over(north));
            let ring = (x.abs().pow(e) + y.abs().pow(e)).pow(east.over(north));
            -((ring + z.abs().pow(n)).pow(north * 0.5) - 1.0)
        }
    ),
    // POV-Ray's box is larger by a millionth.
    solid!("f_rounded_box", 4, |Arguments {
                                    x,
                                    y,
                                    z,
                                    p: [radius, a, b, c, ..],
                                }| {
        let zero = x.number(0.0);
        let outside =
            [(x, a), (y, b), (z, c)].map(|(v, size)| (v.abs() - (size - radius)).max(zero));
        length(outside[0], outside[1], outside[2]) - radius - 1e-6
    }),
    solid!("f_blob", 5, |Arguments {
                             x,
                             y,
                             z,
                             p: [distance, s1, w1, s2, w2, ..],
                         }| {
        let half = distance * 0.5;
        let side = y.square() + z.square();
        let zero = x.number(0.0);
        let parts = [(x + half, s1, w1), (x - half, s2, w2)].map(|(x, strength, w)| {
            strength
                * (-((x.square() + side) * w.square()) + 1.0)
                    .max(zero)
                    .square()
        });
        -(parts[0] + parts[1])
    }),
    solid!("f_blob2", 4, |Arguments {
                              x,
                              y,
                              z,
                              p: [distance, w, strength, threshold, ..],
                          }| {
        let side = y.square() + z.square();
        let near = (-(w * (x.square() + side))).exp();
        let far = (-(w * ((x - distance).square() + side))).exp();
        threshold - strength * (near + far)
    }),
    solid!("f_cross_ellipsoids", 4, |a| {
        let [e, w, strength, threshold, ..] = a.p;
        let [x, y, z] = ellipsoids(a, e).map(|q| (-(w * q)).exp());
        threshold - strength * x.max(y).max(z)
    }),
    solid!("f_isect_ellipsoids", 4, |a| {
        let [e, w, strength, threshold, ..] = a.p;
        let [x, y, z] = ellipsoids(a, e).map(|q| (-(w * q)).exp());
        threshold - strength * x.min(y).min(z)
    }),
    solid!("f_flange_cover", 4, |a| {
        let [e, w, strength, threshold, ..] = a.p;
        let [x, y, z] = ellipsoids(a, e).map(|q| (-(w * q)).exp());
        threshold - strength * (x + y + z)
    }),
    solid!("f_spikes", 5, |a| {
        let [e, hollow, size, roundness, fatness, ..] = a.p;
        let [x, y, z] = ellipsoids(a, e).map(|q| (-(hollow * q)).exp());
        let ball = (-(roundness * (a.x.square() + a.y.square() + a.z.square()))).exp();
        size * (x + y + z - fatness * ball)
    }),
    solid!("f_spikes_2d", 4, |Arguments {
                                  x,
                                  y,
                                  z,
                                  p: [height, fx, fz, fall, ..],
                              }| {
        let fade = (-(fall * (x.square() + z.square()))).exp();
        y - height * (fx * x).cos() * (fz * z).cos() * fade
    }),
    // The density of a d orbital; POV-Ray's constant for 4/3.
    solid!("f_quantum", 1, |Arguments { x, y, z, .. }| {
        let angular = y.square() * 2.0 - x.square() - z.square();
        -(angular.square() * (length(x, y, z) * -1.33333332).exp() * 1.6 - 1.2)
    }),
    // Half of a torus that thins out towards one end, with a ball for a head.
    solid!("f_comma", 1, |Arguments {
                              x,
                              y,
                              z,
                              p: [scale, ..],
                          }| {
        let half = scale * 0.5;
        let head = length(x - half, y, z) - half;
        let ring = hypot(hypot(x + scale * 0.25, z) - scale * 0.75, y);
        let thickness = half * (z.atan2(x) * 0.5).cos();
        head.min((ring - thickness).max(-z))
    }),
    solid!("f_hex_x", 1, |Arguments { x, y, .. }| hexagon(x, y).0),
    solid!("f_hex_y", 1, |Arguments { x, y, .. }| {
        let (_, x, y) = hexagon(x, y);
        let (a, b) = (x * 0.75f64.sqrt(), y * 0.5);
        y.abs().min((a + b).abs()).min((a - b).abs())
    }),
    solid!("f_mesh1", 5, mesh),
    solid!("f_poly4", 5, |Arguments {
                              x,
                              y,
                              z,
                              p: [a, b, c, d, e, ..],
                          }| {
        hypot(x, z) - (a + y * (b + y * (c + y * (d + y * e))))
    }),
    solid!("f_sine_wave", 0, |Arguments { x, y, z, .. }| {
        y * (x * z * std::f64::consts::PI).sin()
    }),
    solid!("f_scallop_wave", 0, |Arguments { x, y, z, .. }| {
        (y * (x * z * std::f64::consts::PI).sin()).abs()
    }),
];
