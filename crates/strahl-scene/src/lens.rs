use std::sync::Arc;
use strahl_math::DVec3;

/// A lens, which blurs objects that do not lie in the plane of focus (POV-Ray manual, "Focal Blur").
#[derive(Clone, Debug, PartialEq)]
pub struct Lens {
    /// Four times the radius of the lens, as in POV-Ray.
    pub aperture: f64,
    /// A point of the plane of focus, which is perpendicular to the viewing direction.
    pub focal_point: DVec3,
    /// Fewest rays of a position in the picture.
    pub min_samples: u32,
    /// Most rays of a position in the picture, as POV-Ray counts them: three quarters of them have its error, and more are not traced unless
    /// `min_samples` is more.
    pub max_samples: u32,
    /// The confidence, from 0 to less than 1, that the colours of the rays do not vary more than `variance` allows. It has little
    /// influence.
    pub confidence: f64,
    /// The variance allowed, from 0 to less than 1. The number of rays grows with the standard deviation of their colours times the
    /// square root of `max_samples / variance`, as in POV-Ray.
    pub variance: f64,
    /// The shape of the aperture; a disc without.
    pub bokeh: Option<Arc<Bokeh>>,
}

impl Lens {
    /// The upper limit of `max_samples`.
    pub const MAX_SAMPLES: u32 = 1 << 16;

    /// A round lens with POV-Ray's defaults.
    pub fn new(aperture: f64, focal_point: DVec3, max_samples: u32) -> Self {
        Self {
            aperture,
            focal_point,
            min_samples: if max_samples < 7 { 4 } else { 7 },
            max_samples,
            confidence: 0.9,
            variance: 1.0 / 10_000.0,
            bokeh: None,
        }
    }
}

/// The transmittance of a lens: weights on a square grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Bokeh {
    size: usize,
    /// Sums of the weights up to and with each cell, row by row from the bottom.
    sums: Vec<f64>,
}

impl Bokeh {
    /// Cells along an edge of the lens.
    pub const SIZE: usize = 64;

    /// From the weight at points of the unit square; negative ones count as zero. `None` if no light comes through.
    pub fn new(weight: impl Fn(f64, f64) -> f64) -> Option<Self> {
        let size = Self::SIZE;
        let mut total = 0.0;
        let mut sums = Vec::with_capacity(size * size);
        let center = |cell: usize| (cell as f64 + 0.5) / size as f64;
        for row in 0..size {
            for column in 0..size {
                let value = weight(center(column), center(row));
                if value > 0.0 && value.is_finite() {
                    total += value;
                }
                sums.push(total);
            }
        }
        (total > 0.0).then_some(Self { size, sums })
    }

    /// A point of the square from -1 to 1 for two numbers in `0..1`, with a density proportional to the weights.
    pub fn point(&self, a: f64, b: f64) -> (f64, f64) {
        let total = self.sums.last().copied().unwrap_or(1.0);
        let wanted = a * total;
        let cell = self.sums.partition_point(|sum| *sum <= wanted);
        let cell = cell.min(self.sums.len().saturating_sub(1));
        let before = cell.checked_sub(1).and_then(|c| self.sums.get(c));
        let before = before.copied().unwrap_or(0.0);
        let here = self.sums.get(cell).copied().unwrap_or(total) - before;
        // The rest of the first number chooses the position within the cell.
        let rest = if here > 0.0 {
            (wanted - before) / here
        } else {
            0.5
        };
        let size = self.size as f64;
        let (column, row) = (cell % self.size, cell / self.size);
        let x = (column as f64 + rest.clamp(0.0, 1.0)) / size;
        let y = (row as f64 + b) / size;
        (2.0 * x - 1.0, 2.0 * y - 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_comes_where_the_weights_are() {
        let left = Bokeh::new(|x, _| if x < 0.5 { 1.0 } else { 0.0 }).expect("some light");
        for step in 0..100 {
            let (x, y) = left.point(f64::from(step) / 100.0, 0.25);
            assert!(
                (-1.0..=0.0).contains(&x) && (-1.0..=1.0).contains(&y),
                "{x} {y}"
            );
        }
        assert!(left.point(0.999, 0.5).1 > 0.9);
        assert_eq!(Bokeh::new(|_, _| -1.0), None);
    }
}
