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

    /// The sum over coordinates and offset that [`CrackleMetric::distance_of`] converts to a distance. It grows with the
    /// distance; for non-positive powers it is the distance itself.
    fn measure(self, v: DVec3, offset: f64) -> f64 {
        match self {
            Self::Manhattan => v.x.abs() + v.y.abs() + v.z.abs() + offset,
            Self::Euclidean => v.length_squared() + offset * offset,
            Self::Power(m) => {
                let power = |x: f64| det::pow(x.abs(), m);
                let sum = power(v.x) + power(v.y) + power(v.z) + power(offset);
                if m > 0.0 { sum } else { det::pow(sum, 1.0 / m) }
            }
        }
    }

    fn distance_of(self, measure: f64) -> f64 {
        match self {
            Self::Manhattan => measure,
            Self::Euclidean => measure.sqrt(),
            Self::Power(m) if m > 0.0 => det::pow(measure, 1.0 / m),
            Self::Power(_) => measure,
        }
    }

    /// The contribution of one coordinate to the measure.
    fn part(self, x: f64) -> f64 {
        match self {
            Self::Manhattan => x.abs(),
            Self::Euclidean => x * x,
            Self::Power(m) => det::pow(x.abs(), m),
        }
    }

    /// Whether larger coordinates never give a smaller distance.
    fn is_monotone(self) -> bool {
        match self {
            Self::Manhattan | Self::Euclidean => true,
            Self::Power(m) => m > 0.0,
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

/// The 5³ cubes around a cube, except those that are two cubes away in more than one direction, the nearest first.
const NEIGHBOURS: [[i64; 3]; 81] = {
    let mut all = [[0; 3]; 81];
    let (mut count, mut square) = (0, 0);
    while square <= 6 {
        let mut n = 0;
        while n < 125 {
            let d = [n / 25 - 2, n / 5 % 5 - 2, n % 5 - 2];
            let squares = [d[0] * d[0], d[1] * d[1], d[2] * d[2]];
            let far = squares[0] / 4 + squares[1] / 4 + squares[2] / 4;
            if far < 2 && squares[0] + squares[1] + squares[2] == square {
                all[count] = d;
                count += 1;
            }
            n += 1;
        }
        square += 1;
    }
    all
};

impl Crackle {
    /// The value at `p`, cut off at 0 and 1.
    ///
    /// The nearest points are searched in the [`NEIGHBOURS`] of the cube of `p`. Cubes farther away than the nearest points
    /// found so far (one to three, as `form` needs) are skipped; usually these are all cubes two cubes away.
    pub(super) fn value(&self, p: DVec3, generator: NoiseGenerator) -> f64 {
        let home = cell(p);
        let fraction = (p - p.floor()).to_array();
        // The contributions of the gaps between p and the cubes along each axis.
        let gaps =
            fraction.map(|f| [f + 1.0, f, 0.0, 1.0 - f, 2.0 - f].map(|g| self.metric.part(g)));
        let rest = self.metric.measure(DVec3::ZERO, self.offset);
        let counting = match self.form {
            _ if self.solid => 1,
            form if form.z != 0.0 => 3,
            form if form.y != 0.0 => 2,
            _ => 1,
        };
        // Rounding errors must not make a cube appear farther away than it is.
        let slack = if self.metric.is_monotone() {
            1.0 - 1e-12
        } else {
            0.0
        };
        let mut nearest = [f64::INFINITY; 3];
        let mut center = p;
        for d in NEIGHBOURS {
            let gap = (0..3).map(|axis| gaps[axis][(d[axis] + 2) as usize]);
            if (gap.sum::<f64>() + rest) * slack > nearest[counting - 1] {
                continue;
            }
            let cell: [i64; 3] = std::array::from_fn(|axis| home[axis].wrapping_add(d[axis]));
            let h = lattice_hash(cell);
            let corner = DVec3::from_array(cell.map(|c| c as f64));
            let place = corner + DVec3::new(uniform(h), uniform(h + 1), uniform(h + 2));
            let measure = self.metric.measure(p - place, self.offset);
            if measure < nearest[0] {
                nearest = [measure, nearest[0], nearest[1]];
                center = place;
            } else if measure < nearest[1] {
                nearest = [nearest[0], measure, nearest[1]];
            } else if measure < nearest[2] {
                nearest[2] = measure;
            }
        }
        if self.solid {
            return noise(center, generator);
        }
        let mut distances = DVec3::ZERO;
        for (i, measure) in nearest.into_iter().enumerate().take(counting) {
            distances[i] = self.metric.distance_of(measure);
        }
        distances.dot(self.form).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The value from all cubes, without skipping.
    fn slowly(crackle: &Crackle, p: DVec3) -> f64 {
        let mut all: Vec<f64> = NEIGHBOURS
            .iter()
            .map(|d| {
                let home = cell(p);
                let cell: [i64; 3] = std::array::from_fn(|axis| home[axis] + d[axis]);
                let h = lattice_hash(cell);
                let place = DVec3::from_array(cell.map(|c| c as f64))
                    + DVec3::new(uniform(h), uniform(h + 1), uniform(h + 2));
                let metric = crackle.metric;
                metric.distance_of(metric.measure(p - place, crackle.offset))
            })
            .collect();
        all.sort_by(f64::total_cmp);
        let form = crackle.form;
        (all[0] * form.x + all[1] * form.y + all[2] * form.z).clamp(0.0, 1.0)
    }

    #[test]
    fn cubes_passed_over_don_t_matter() {
        for metric in [1.0, 2.0, 0.5, 1.5, 3.0, 20.0, -1.0] {
            for form in [
                DVec3::new(-1.0, 1.0, 0.0),
                DVec3::X,
                DVec3::new(0.3, -0.2, 0.4),
            ] {
                let crackle = Crackle {
                    form,
                    metric: CrackleMetric::from_number(metric),
                    offset: 0.25,
                    solid: false,
                };
                for i in 0..200 {
                    let t = f64::from(i);
                    let p = DVec3::new(t * 0.731 - 40.0, t * 0.317 + 3.0, 9.0 - t * 0.613);
                    let value = crackle.value(p, NoiseGenerator::RangeCorrected);
                    assert_eq!(value, slowly(&crackle, p), "{metric} {form} {p}");
                }
            }
        }
    }

    #[test]
    fn neighbours_are_81_different_cubes() {
        let all: std::collections::BTreeSet<_> = NEIGHBOURS.into_iter().collect();
        assert_eq!(all.len(), 81);
        assert_eq!(NEIGHBOURS[0], [0, 0, 0]);
    }
}
