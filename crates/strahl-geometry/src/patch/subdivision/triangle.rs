//! Regular triangles of Loop's scheme as Bezier patches.
//!
//! On a triangle whose corners have six triangles around them the limit surface is a box spline of degree 4 (C. Loop, "Smooth
//! subdivision surfaces based on triangles", 1987): a triangular Bezier patch, whose control points are means of the corners and their
//! neighbours. The triangle is cut into three quadrilaterals, from each corner to the middle of the two edges and to the
//! centroid. Along them, barycentric coordinates are bilinear functions of two parameters, so each is exactly a patch of degree
//! 4 in both.

use super::quad::weightless;
use super::ring::Ring;
use crate::patch::net::{self, Curve, Net};
use strahl_math::DVec3;

/// The control points of a triangle of degree 4: that with the weights `(4 - i - j, i, j)` of the corners is `[j][i]`.
type Triangle = [[[f64; 4]; 5]; 5];

/// The border curve along edge `i`. From the other side it is the same, reversed, to the last bit.
pub(super) fn edge_curve(ring: &Ring, i: usize) -> Curve<4, 5> {
    let (a, b) = (ring.corner(i), ring.corner(i + 1));
    let (p, q) = (a.place(ring.scheme), b.place(ring.scheme));
    let (c, d) = (a.point(), b.point());
    if a.spoke(0).sharpness > 0.0 {
        // A cubic, elevated.
        let near = |x: DVec3, y: DVec3| (x * 2.0 + y) / 3.0;
        let (first, second) = (near(c, d), near(d, c));
        let end = |x: DVec3, y: DVec3| (x + y * 3.0) * 0.25;
        let middle = (first + second) * 0.5;
        return [p, end(p, first), middle, end(q, second), q].map(weightless);
    }
    // The spokes of `a` and `b` beside the edge, and behind these.
    let near = |x: DVec3, y: DVec3, sides: [[DVec3; 2]; 2]| {
        let [[l, l2], [r, r2]] = sides;
        (((l + r) * 3.0 + (l2 + r2)) + (x * 12.0 + y * 4.0)) / 24.0
    };
    let of_a = [a.aside(0, true), a.aside(0, false)];
    let of_b = [b.aside(1, true), b.aside(1, false)];
    let [[left, _], [right, _]] = of_a;
    let middle = ((c + d) * 8.0 + (left + right) * 4.0) / 24.0;
    [p, near(c, d, of_a), middle, near(d, c, of_b), q].map(weightless)
}

/// The triangle of a face.
fn triangle(ring: &Ring) -> Triangle {
    let point = |i: usize| ring.corner(i).point();
    // Opposite to the face beyond edge `i`.
    let beyond = |i: usize| {
        let (a, b) = (ring.corner(i), ring.corner(i + 1));
        if a.spoke(0).sharpness > 0.0 {
            (a.point() + b.point()) - point(i + 2)
        } else {
            a.spoke_before().point
        }
    };
    let within = |i: usize| {
        let (others, far) = (point(i + 1) + point(i + 2), beyond(i) + beyond(i + 2));
        weightless(((point(i) * 10.0 + others * 6.0) + far) / 24.0)
    };
    let [a, b, c] = std::array::from_fn(|i| edge_curve(ring, i));
    let mut all = [[[0.0; 4]; 5]; 5];
    all[0] = a;
    for k in 0..5 {
        all[k][4 - k] = b[k];
        all[4 - k][0] = c[k];
    }
    all[1][1] = within(0);
    all[1][2] = within(1);
    all[2][1] = within(2);
    all
}

/// Places in a triangle by their barycentric coordinates.
type Place = [f64; 3];

/// The blossom of the triangle at four places (L. Ramshaw, "Blossoming", 1987).
fn blossom(triangle: &Triangle, places: [Place; 4]) -> [f64; 4] {
    let mut points = *triangle;
    for (step, [a, b, c]) in places.into_iter().enumerate() {
        for j in 0..4 - step {
            for i in 0..4 - step - j {
                let (p, q, r) = (points[j][i], points[j][i + 1], points[j + 1][i]);
                points[j][i] = std::array::from_fn(|k| p[k] * a + q[k] * b + r[k] * c);
            }
        }
    }
    let [x, y, z, _] = points[0][0];
    [x, y, z, 1.0]
}

/// The curve between two places.
fn line(triangle: &Triangle, from: Place, to: Place) -> Curve<4, 5> {
    std::array::from_fn(|i| {
        blossom(
            triangle,
            std::array::from_fn(|k| if k < i { to } else { from }),
        )
    })
}

/// The part from a corner (`places[0]`) to the middle of the edge after it, to the centroid, to the middle of the edge
/// before it.
fn part(triangle: &Triangle, [q00, q10, q11, q01]: [Place; 4]) -> Net<4, 5> {
    const CHOOSE: [f64; 5] = [1.0, 4.0, 6.0, 4.0, 1.0];
    const FACTORIAL: [f64; 5] = [1.0, 1.0, 2.0, 6.0, 24.0];
    let point = |i: usize, j: usize| {
        let mut sum = DVec3::ZERO;
        // So many of the four places have both parameters.
        for both in (i + j).saturating_sub(4)..=i.min(j) {
            let counts = [4 + both - i - j, i - both, both, j - both];
            let mut places = [q00; 4];
            let mut at = 0;
            for (place, count) in [q00, q10, q11, q01].into_iter().zip(counts) {
                for _ in 0..count {
                    places[at] = place;
                    at += 1;
                }
            }
            let ways = counts.iter().fold(24.0, |ways, n| ways / FACTORIAL[*n]);
            let [x, y, z, _] = blossom(triangle, places);
            sum += DVec3::new(x, y, z) * ways;
        }
        weightless(sum / (CHOOSE[i] * CHOOSE[j]))
    };
    Net {
        rows: std::array::from_fn(|j| std::array::from_fn(|i| point(i, j))),
    }
}

/// The three patches of a face: patch `i` has corner `i` at `(0, 0)` and the middle of the edge after it at `(1, 0)`.
///
/// Beside an irregular corner, where faces are so small that it does not matter, the surface is only close: it has the corner's
/// limit, the neighbours' borders, and is within the hull of the same points.
pub(super) fn nets(ring: &Ring) -> [Net<4, 5>; 3] {
    let triangle = triangle(ring);
    let edges: [_; 3] = std::array::from_fn(|i| net::halves(&edge_curve(ring, i)));
    let corner = |i: usize| -> Place { std::array::from_fn(|k| f64::from(u8::from(k == i % 3))) };
    let middle =
        |i: usize| -> Place { std::array::from_fn(|k| if k == (i + 2) % 3 { 0.0 } else { 0.5 }) };
    let third = 1.0 / 3.0;
    let center = [third; 3];
    // From the middle of each edge to the centroid.
    let mut inner: [Curve<4, 5>; 3] = std::array::from_fn(|i| line(&triangle, middle(i), center));
    let centroid = blossom(&triangle, [center; 4]);
    for (curve, [half, _]) in inner.iter_mut().zip(&edges) {
        curve[0] = half[4];
        curve[4] = centroid;
    }
    std::array::from_fn(|i| {
        let before = (i + 2) % 3;
        let mut net = part(&triangle, [corner(i), middle(i), center, middle(before)]);
        // Borders as the neighbours have them.
        net.rows[0] = edges[i][0];
        for k in 0..5 {
            net.rows[k][0] = edges[before][1][4 - k];
            net.rows[k][4] = inner[i][k];
            net.rows[4][k] = inner[before][k];
        }
        net
    })
}

/// The halves of the part of edge `i` next to its beginning (0) or its end (1), as the smaller faces beyond have them.
pub(super) fn halves(children: &[Ring], i: usize, end: usize) -> [Curve<4, 5>; 2] {
    let child = (i + end) % 3;
    net::halves(&edge_curve(&children[child], i))
}
