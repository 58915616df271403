//! Where the rays of a batch leave their surfaces, side by side.

use super::aim::{Vectors, put};
use super::point::{Lanes, Point};
use crate::query::PACKET_MIN;
use strahl_accel::PACKET;
use strahl_math::{DVec3, error};
use strahl_simd::{Simd, dispatch};

/// Finds where rays towards the viewer's side of surfaces start.
#[inline]
pub(super) fn find_starts(points: &mut [Point<'_>], lanes: &Lanes) {
    if lanes.len() < PACKET_MIN {
        for lane in lanes {
            let Point { surface, hit, .. } = &mut points[*lane];
            surface.find_start(hit);
        }
        return;
    }
    let mut at: [Vectors; 3] = [[[0.0; PACKET]; 3]; 3];
    let [positions, errors, normals] = &mut at;
    for (index, lane) in lanes.iter().enumerate() {
        let surface = &points[*lane].surface;
        let point = &surface.resolved.point;
        put(positions, index, point.position);
        put(errors, index, point.position_error);
        put(normals, index, surface.n_geom);
    }
    // Loops over arrays, which the compiler turns into vector instructions of the level.
    dispatch!(Simd::best(), _isa => {
        let ([x, y, z], [ex, ey, ez], [nx, ny, nz]) = (positions, &*errors, &*normals);
        for k in 0..PACKET {
            let distance = nx[k].abs() * ex[k] + ny[k].abs() * ey[k] + nz[k].abs() * ez[k];
            x[k] = error::next_along(x[k] + nx[k] * distance, nx[k]);
            y[k] = error::next_along(y[k] + ny[k] * distance, ny[k]);
            z[k] = error::next_along(z[k] + nz[k] * distance, nz[k]);
        }
    });
    let [x, y, z] = &at[0];
    for (index, lane) in lanes.iter().enumerate() {
        let Point { surface, hit, .. } = &mut points[*lane];
        let k = index % PACKET;
        surface.put_start(hit, DVec3::new(x[k], y[k], z[k]));
    }
}
