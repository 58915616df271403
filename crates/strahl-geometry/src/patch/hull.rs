//! Boxes around nets of control points.

use super::net::Net;
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec3};

/// How far beyond its piece, in parts of it, a point may be found: neighbours overlap, so that no ray slips through between
/// them.
pub(super) const OVERLAP: f64 = 1.0 / (1u64 << 20) as f64;

/// The control points of a net of points times their weights, and the weights.
pub(super) fn points<const K: usize>(net: &Net<4, K>) -> impl Iterator<Item = DVec3> + Clone {
    net.points().map(|p| project(*p))
}

/// A point from the point times its weight, and its weight.
pub(super) fn project([x, y, z, w]: [f64; 4]) -> DVec3 {
    let point = DVec3::new(x, y, z);
    // The same, without the time of a division.
    if w == 1.0 { point } else { point / w }
}

/// The box around the control points, widened by what lies beyond the ends of the parameters and by rounding errors.
pub(super) fn hull<const K: usize>(net: &Net<4, K>) -> Aabb {
    let mut tight = Aabb::EMPTY;
    for p in net.rows.as_flattened() {
        let p = project(*p);
        tight = Aabb::new(tight.min.min(p), tight.max.max(p));
    }
    let noise = tight.min.abs().max(tight.max.abs()) * gamma(16 * K as u32);
    tight.padded(tight.size() * (K as f64 * OVERLAP) + noise)
}

/// The sixteen parts of a net, row after row.
pub(super) fn sixteenths<const K: usize>(net: &Net<4, K>) -> [[Net<4, K>; 4]; 4] {
    let [left, right] = net.halves_u();
    let ([a, b], [c, d]) = (left.halves_u(), right.halves_u());
    let columns = [a, b, c, d];
    let mut parts = [columns; 4];
    for (i, column) in columns.iter().enumerate() {
        let [below, above] = column.halves_v();
        [parts[0][i], parts[1][i]] = below.halves_v();
        [parts[2][i], parts[3][i]] = above.halves_v();
    }
    parts
}

/// A box around a patch, closer than that around its control points.
pub(super) fn bounds<const K: usize>(net: &Net<4, K>) -> Aabb {
    let parts = sixteenths(net);
    let hulls = parts.as_flattened().iter().map(hull);
    hulls.fold(Aabb::EMPTY, |all, hull| all.union(&hull))
}
