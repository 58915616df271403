//! Regular faces of Catmull and Clark's scheme as Bezier patches.
//!
//! On a face whose corners have four faces around them the limit surface is a bicubic B-spline (E. Catmull, J. Clark, "Recursively
//! generated B-spline surfaces on arbitrary topological meshes", Computer-Aided Design 10(6), 1978), so it is a Bezier patch with control
//! points that are means of the corners and their neighbours. At borders and creases the B-spline is continued by reflected
//! points, which is the same as the rules of subdivision there.

use super::ring::Ring;
use crate::patch::net::{Curve, Net};
use strahl_math::DVec3;

/// A control point of weight 1.
pub(super) fn weightless(p: DVec3) -> [f64; 4] {
    [p.x, p.y, p.z, 1.0]
}

/// The border curve along edge `i`. From the other side it is the same, reversed, to the last bit.
pub(super) fn edge_curve(ring: &Ring, i: usize) -> Curve<4, 4> {
    let (a, b) = (ring.corner(i), ring.corner(i + 1));
    let inner = if a.spoke(0).sharpness > 0.0 {
        let near = |p: DVec3, q: DVec3| (p * 2.0 + q) / 3.0;
        [near(a.point(), b.point()), near(b.point(), a.point())]
    } else {
        let across = |p: DVec3, [left, right]: [DVec3; 2]| (left + right) + p * 4.0;
        let first = across(a.point(), [a.spoke_before().point, a.spoke(1).point]);
        let second = across(b.point(), [b.spoke(0).point, b.spoke(2).point]);
        let near = |p: DVec3, q: DVec3| (p * 2.0 + q) / 18.0;
        [near(first, second), near(second, first)]
    };
    let [p, q] = inner;
    [a.place(ring.scheme), p, q, b.place(ring.scheme)].map(weightless)
}

/// The control points of the patch of a face with four corners; the first corner is at `(0, 0)`, the second at `(1, 0)`.
///
/// Beside an irregular corner, where faces are so small that it does not matter, the surface is only close: it has the corner's
/// limit, the neighbours' borders, and is within the hull of the same points.
pub(super) fn net(ring: &Ring) -> Net<4, 4> {
    let corner = |i: usize| ring.corner(i).point();
    let within = |i: usize| {
        let sides = corner(i + 1) + corner(i + 3);
        weightless(((corner(i) * 4.0 + sides * 2.0) + corner(i + 2)) / 9.0)
    };
    let [bottom, right, top, left] = std::array::from_fn(|i| edge_curve(ring, i));
    let rows = [
        bottom,
        [left[2], within(0), within(1), right[1]],
        [left[1], within(3), within(2), right[2]],
        [top[3], top[2], top[1], top[0]],
    ];
    Net { rows }
}

/// The halves of edge `i`, as the smaller faces beyond have them.
pub(super) fn halves(ring: &Ring, children: &[Ring], i: usize) -> [Curve<4, 4>; 2] {
    let next = (i + 1) % ring.corners.len();
    [edge_curve(&children[i], i), edge_curve(&children[next], i)]
}
