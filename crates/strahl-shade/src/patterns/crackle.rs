use strahl_math::noise::{NoiseGenerator, lattice_hash, noise};
use strahl_math::{DVec3, det};

use super::random::uniform;

/// The cell of the unit lattice around `p`.
fn cell(p: DVec3) -> [i64; 3] {
    p.floor().to_array().map(|f| f as i64)
}

/// A random number per unit cube.
pub(super) fn cells(p: DVec3) -> f64 {
    uniform(lattice_hash(cell(p)))
}

/// How crackle measures distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CrackleMetric {
    /// `|x| + |y| + |z|`.
    Manhattan,
    /// `sqrt(x² + y² + z²)`.
    Euclidean,
    /// `(|x|ᵐ + |y|ᵐ + |z|ᵐ)^(1/m)`.
    Power(f64),
}

impl CrackleMetric {
    /// The metric with POV-Ray's number `m`.
    pub fn from_number(m: f64) -> Self {
        if m == 1.0 {
            Self::Manhattan
        } else if m == 2.0 {
            Self::Euclidean
        } else {
            Self::Power(m)
        }
    }

    fn distance(self, v: DVec3, offset: f64) -> f64 {
        match self {
            Self::Manhattan => v.x.abs() + v.y.abs() + v.z.abs() + offset,
            Self::Euclidean => (v.length_squared() + offset * offset).sqrt(),
            Self::Power(m) => {
                let power = |x: f64| det::pow(x.abs(), m);
                det::pow(
                    power(v.x) + power(v.y) + power(v.z) + power(offset),
                    1.0 / m,
                )
            }
        }
    }
}

/// Cellular texture (Worley, "A Cellular Texture Basis Function", SIGGRAPH 1996): each unit cube holds one random point, and
/// the value is a combination of the distances to the nearest three.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crackle {
    /// Factors of the distances to the nearest, second and third nearest point; `<-1, 1, 0>` by default.
    pub form: DVec3,
    /// The metric; Euclidean by default.
    pub metric: CrackleMetric,
    /// Distance along a fourth dimension; 0 by default.
    pub offset: f64,
    /// One value for all that is nearest to the same point.
    pub solid: bool,
}

impl Default for Crackle {
    fn default() -> Self {
        Self {
            form: DVec3::new(-1.0, 1.0, 0.0),
            metric: CrackleMetric::Euclidean,
            offset: 0.0,
            solid: false,
        }
    }
}

impl Crackle {
    /// The value at `p`, cut off at 0 and 1.
    ///
    /// Points are looked for in the 5³ cubes around that of `p` without the corners and edges that lie two cubes off in
    /// more than one direction. All of them matter only to the third distance and to odd metrics.
    pub(super) fn value(&self, p: DVec3, generator: NoiseGenerator) -> f64 {
        let home = cell(p);
        let mut nearest = [f64::INFINITY; 3];
        let mut center = p;
        for dx in -2i64..=2 {
            for dy in -2i64..=2 {
                for dz in -2i64..=2 {
                    let far = [dx, dy, dz].iter().filter(|d| d.abs() == 2).count();
                    if far > 1 {
                        continue;
                    }
                    let [i, j, k] = home;
                    let cell = [i.wrapping_add(dx), j.wrapping_add(dy), k.wrapping_add(dz)];
                    let h = lattice_hash(cell);
                    let corner = DVec3::from_array(cell.map(|c| c as f64));
                    let place = corner + DVec3::new(uniform(h), uniform(h + 1), uniform(h + 2));
                    let d = self.metric.distance(p - place, self.offset);
                    if d < nearest[0] {
                        nearest = [d, nearest[0], nearest[1]];
                        center = place;
                    } else if d < nearest[1] {
                        nearest = [nearest[0], d, nearest[1]];
                    } else if d < nearest[2] {
                        nearest[2] = d;
                    }
                }
            }
        }
        if self.solid {
            return noise(center, generator);
        }
        let value = DVec3::from_array(nearest).dot(self.form);
        value.clamp(0.0, 1.0)
    }
}
