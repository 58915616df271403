//! The rays of a square of pixels, side by side.

use super::PrimaryRays;
use crate::film::Region;
use arrayvec::ArrayVec;
use strahl_accel::PACKET;
use strahl_math::{DVec3, Ray};
use strahl_simd::{Simd, dispatch};

impl PrimaryRays {
    /// The chief rays of pixels row by row, through this place in each, with the bits of [`PrimaryRays::ray`]. There are at most [`PACKET`] pixels.
    #[inline(always)]
    pub(crate) fn of_square(
        &self,
        square: Region,
        (dx, dy): (f64, f64),
    ) -> ArrayVec<Option<Ray>, PACKET> {
        let c = &self.camera;
        let mut rays = ArrayVec::new();
        let special = self.is_special();
        let (mut x, mut y, mut count) = ([0.0; PACKET], [0.0; PACKET], 0);
        for row in square.y..square.y + square.height {
            for column in square.x..square.x + square.width {
                let place = (f64::from(column) + dx, f64::from(row) + dy);
                if special {
                    rays.push(self.ray(place.0, place.1));
                } else {
                    (x[count % PACKET], y[count % PACKET]) = place;
                    count += 1;
                }
            }
        }
        if special {
            return rays;
        }
        let mut directions = [[0.0; PACKET]; 3];
        self.find_directions(&x, &y, &mut directions);
        let [dx, dy, dz] = &directions;
        for k in 0..count {
            rays.push(Some(Ray::new(c.eye, DVec3::new(dx[k], dy[k], dz[k]))));
        }
        rays
    }

    /// The unit directions of the chief rays of a perspective camera, axis by axis.
    #[inline(never)]
    fn find_directions(&self, x: &[f64; PACKET], y: &[f64; PACKET], out: &mut [[f64; PACKET]; 3]) {
        let c = &self.camera;
        let (ahead, right, up) = (c.direction, c.right, c.up);
        let (width, height) = (self.width, self.height);
        // Loops over arrays, which the compiler turns into vector instructions of the level.
        dispatch!(Simd::best(), _isa => {
            let [dx, dy, dz] = &mut *out;
            for k in 0..PACKET {
                let (u, v) = (2.0 * x[k] / width - 1.0, 1.0 - 2.0 * y[k] / height);
                let x = ahead.x + (right.x * u + up.x * v);
                let y = ahead.y + (right.y * u + up.y * v);
                let z = ahead.z + (right.z * u + up.z * v);
                let per_length = 1.0 / (x * x + y * y + z * z).sqrt();
                (dx[k], dy[k], dz[k]) = (x * per_length, y * per_length, z * per_length);
            }
        });
    }
}
