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

/// The two cells of a hexagonal tiling of which `(x, y)` lies in one: for each the distance from its centre as its edges measure it, and the
/// sizes of the coordinates relative to the centre. The centres of neighbours are `sqrt 3` apart, one is the origin, one on the x axis.
fn hexagons<'a, 'g>(x: Term<'a, 'g>, y: Term<'a, 'g>) -> [[Term<'a, 'g>; 3]; 2] {
    let root = x.number(3f64.sqrt());
    // Two rectangular lattices make the hexagonal one.
    [(0.0, 0.0), (0.75f64.sqrt(), 1.5)].map(|(dx, dy)| {
        let (x, y) = ((x - dx).triangle(root), (y - dy).triangle(root.number(3.0)));
        [x.max(x * 0.5 + y * 0.75f64.sqrt()), x, y]
    })
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
    let turn = x.number(std::f64::consts::PI);
    // The height of a thread where it crosses the other ones, over and under in turns.
    let wave = |along: Term<'a, 'g>, distance| weave * (along.over(distance) * turn).cos();
    let (wave_x, wave_z) = (wave(x, px), wave(z, pz));
    let thread = |across: Term<'a, 'g>, distance: Term<'a, 'g>, height_above: Term<'a, 'g>| {
        hypot(
            width * across.triangle(distance * 2.0),
            height * height_above,
        )
    };
    // Of the threads along x every second one goes over where its neighbours go under.
    let along_x = thread(z, pz, y - wave_x).min(thread(z - pz, pz, y + wave_x));
    let along_z = thread(x, px, y + wave_z).min(thread(x - px, px, y - wave_z));
    along_x.min(along_z)
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
    solid!("f_hex_x", 1, |Arguments { x, y, .. }| {
        let [[a, ..], [b, ..]] = hexagons(x, y);
        a.min(b)
    }),
    // The distance from three lines through the centre, which go through the centres of all cells in a row: so lines of the other cell are
    // farther away.
    solid!("f_hex_y", 1, |Arguments { x, y, .. }| {
        let [one, other] = hexagons(x, y).map(|[_, x, y]| {
            let (a, b) = (x * 0.75f64.sqrt(), y * 0.5);
            // The sizes of a + b and a - b are the same two for all signs of a and b.
            y.min(a + b).min((a - b).abs())
        });
        one.min(other)
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
