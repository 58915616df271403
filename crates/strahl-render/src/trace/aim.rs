//! The lengths of the rays of a batch, and the directions from its points to a light, side by side.

use super::point::{Lanes, Point};
use crate::query::PACKET_MIN;
use strahl_accel::PACKET;
use strahl_math::DVec3;
use strahl_shade::{Light, LightSample};
use strahl_simd::{Simd, dispatch};

/// Vectors, axis by axis.
pub(super) type Vectors = [[f64; PACKET]; 3];

/// Points on surfaces and their shading normals.
#[derive(Debug)]
pub(super) struct Places {
    positions: Vectors,
    normals: Vectors,
}

impl Places {
    /// Room for the places that [`Places::find`] finds.
    pub(super) const NONE: Self = Self {
        positions: [[0.0; PACKET]; 3],
        normals: [[0.0; PACKET]; 3],
    };

    /// Finds those of some lanes, one behind the other.
    #[inline(always)]
    pub(super) fn find(&mut self, points: &[Point<'_>], lanes: &Lanes) {
        for (index, lane) in lanes.iter().enumerate() {
            let surface = &points[*lane].surface;
            put(&mut self.positions, index, surface.resolved.point.position);
            put(&mut self.normals, index, surface.n_shade);
        }
    }
}

/// The lengths of the directions of rays, and their reciprocals.
#[derive(Debug)]
pub(super) struct Speeds {
    lengths: [f64; PACKET],
    reciprocals: [f64; PACKET],
}

impl Speeds {
    /// Those of at most [`PACKET`] rays, with the bits of [`DVec3::length`].
    #[inline]
    pub(super) fn of(points: &[Point<'_>]) -> Self {
        let (mut lengths, mut reciprocals) = ([1.0; PACKET], [1.0; PACKET]);
        if points.len() < PACKET_MIN {
            for (k, point) in points.iter().enumerate() {
                lengths[k] = point.branch.ray.direction.length();
                reciprocals[k] = lengths[k].recip();
            }
        } else {
            for (square, point) in lengths.iter_mut().zip(points) {
                *square = point.branch.ray.direction.length_squared();
            }
            dispatch!(Simd::best(), _isa => {
                for k in 0..PACKET {
                    lengths[k] = lengths[k].sqrt();
                    reciprocals[k] = 1.0 / lengths[k];
                }
            });
        }
        Self {
            lengths,
            reciprocals,
        }
    }

    /// The length and its reciprocal.
    #[inline(always)]
    pub(super) fn get(&self, lane: usize) -> (f64, f64) {
        (self.lengths[lane % PACKET], self.reciprocals[lane % PACKET])
    }
}

/// The directions from places to a light that shines from a point, with the bits of [`Light::illuminate`] at each place.
#[derive(Debug)]
pub(super) struct Directions {
    to_light: Vectors,
    distance: [f64; PACKET],
    /// Unit vectors towards the light.
    l: Vectors,
    n_dot_l: [f64; PACKET],
    /// Where shadow rays end if the light has a clearance, in units of the ways to the light.
    ends: [f64; PACKET],
}

impl Directions {
    /// Room for the directions that [`Directions::find`] finds.
    pub(super) const NONE: Self = Self {
        to_light: [[0.0; PACKET]; 3],
        distance: [0.0; PACKET],
        l: [[0.0; PACKET]; 3],
        n_dot_l: [0.0; PACKET],
        ends: [0.0; PACKET],
    };

    /// Finds those to a light at this position and with this clearance.
    // In place: they have a thousand bytes.
    #[inline]
    pub(super) fn find(&mut self, light: DVec3, clearance: f64, places: &Places) {
        let out = self;
        // Loops over arrays, which the compiler turns into vector instructions of the level.
        dispatch!(Simd::best(), _isa => {
            let ([x, y, z], [nx, ny, nz]) = (&places.positions, &places.normals);
            for k in 0..PACKET {
                let (dx, dy, dz) = (light.x - x[k], light.y - y[k], light.z - z[k]);
                let distance = (dx * dx + dy * dy + dz * dz).sqrt();
                let (lx, ly, lz) = (dx / distance, dy / distance, dz / distance);
                (out.to_light[0][k], out.to_light[1][k], out.to_light[2][k]) = (dx, dy, dz);
                out.distance[k] = distance;
                (out.l[0][k], out.l[1][k], out.l[2][k]) = (lx, ly, lz);
                out.ends[k] = (distance - clearance) / distance;
                out.n_dot_l[k] = nx[k] * lx + ny[k] * ly + nz[k] * lz;
            }
        });
    }

    /// The light at a place, and the cosine between its shading normal and the direction to the light; `None` if the light is there.
    #[inline(always)]
    pub(super) fn sample(&self, light: &Light, index: usize) -> Option<(LightSample, f64)> {
        let k = index % PACKET;
        let (to_light, l) = (get(&self.to_light, k), get(&self.l, k));
        let sample = light.plain_sample(to_light, self.distance[k], l, self.ends[k])?;
        Some((sample, self.n_dot_l[k]))
    }
}

/// Stores a vector at an index.
#[inline(always)]
pub(super) fn put(vectors: &mut Vectors, index: usize, v: DVec3) {
    for (axis, x) in v.to_array().into_iter().enumerate() {
        vectors[axis][index % PACKET] = x;
    }
}

#[inline(always)]
fn get(vectors: &Vectors, index: usize) -> DVec3 {
    DVec3::new(vectors[0][index], vectors[1][index], vectors[2][index])
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_geometry::conformance::Random;
    use strahl_shade::Color;

    #[test]
    fn directions_have_the_bits_of_single_points() {
        let mut random = Random::new(3);
        let mut vector = |size: f64| {
            let mut unit = || 2.0 * random.unit() - 1.0;
            DVec3::new(unit(), unit(), unit()) * size
        };
        for size in [1e-3, 1.0, 1e6, 1e160] {
            let mut light = Light::point(vector(size), Color::new(1.0, 2.0, 3.0));
            light.clearance = 0.1 * size;
            let mut places = Places::NONE;
            for k in 0..PACKET {
                put(&mut places.positions, k, vector(size));
                put(&mut places.normals, k, vector(1.0));
            }
            let at_the_light = light.plain_position().unwrap();
            put(&mut places.positions, 5, at_the_light);
            let mut directions = Directions::NONE;
            directions.find(at_the_light, light.clearance, &places);
            for k in 0..PACKET {
                let (position, normal) = (get(&places.positions, k), get(&places.normals, k));
                let expected = light.illuminate(position).map(|s| (s, normal.dot(s.l)));
                let found = directions.sample(&light, k);
                // As texts, which have all digits: NaN, where distances overflow, differs from itself.
                assert_eq!(format!("{found:?}"), format!("{expected:?}"), "{size} {k}");
            }
        }
    }
}
