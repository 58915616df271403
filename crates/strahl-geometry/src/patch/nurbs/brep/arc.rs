//! Pieces of the borders of faces, as curves in the plane of their parameters.

use super::super::spline::HIGHEST;
use super::super::trim::Weighted;
use super::boxes::Bounds;
use strahl_math::DVec2;

/// A curve is divided so often at most where it is near.
const DEPTH: u32 = 48;
/// A piece that leaves its chord by less than this part of the distance asked for counts as its chord.
const FLAT: f64 = 1.0 / 1024.0;

/// A Bezier curve of places with weights.
#[derive(Clone, Debug)]
pub(super) struct Arc {
    points: Vec<Weighted>,
}

/// Control points with weights that are multiplied into them.
type Row = [Weighted; HIGHEST + 1];

impl Arc {
    pub(super) fn new(points: &[Weighted]) -> Self {
        Self {
            points: points[..points.len().min(HIGHEST + 1)].to_vec(),
        }
    }

    pub(super) fn line(from: DVec2, to: DVec2) -> Self {
        Self {
            points: vec![[from.x, from.y, 1.0], [to.x, to.y, 1.0]],
        }
    }

    pub(super) fn bounds(&self) -> Bounds<2> {
        let start = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        self.points.iter().fold(start, |[low, high], p| {
            [
                [low[0].min(p[0]), low[1].min(p[1])],
                [high[0].max(p[0]), high[1].max(p[1])],
            ]
        })
    }

    fn row(&self, map: impl Fn(DVec2) -> DVec2) -> Row {
        let mut row = [[0.0; 3]; HIGHEST + 1];
        for (place, [x, y, w]) in row.iter_mut().zip(&self.points) {
            let p = map(DVec2::new(*x, *y));
            *place = [p.x * w, p.y * w, *w];
        }
        row
    }

    /// The place at a parameter from 0 to 1, and its derivative.
    pub(super) fn at(&self, s: f64) -> [DVec2; 2] {
        let count = self.points.len();
        let mut row = self.row(|p| p);
        for left in (2..count).rev() {
            for i in 0..left {
                row[i] = std::array::from_fn(|k| row[i][k] * (1.0 - s) + row[i + 1][k] * s);
            }
        }
        let place = |p: &Weighted| DVec2::new(p[0], p[1]) / p[2];
        let (a, b) = (place(&row[0]), place(&row[1.min(count - 1)]));
        let (v, w) = (row[0][2], row[1.min(count - 1)][2]);
        let weight = v * (1.0 - s) + w * s;
        // The last step of de Casteljau's scheme, for a rational curve.
        let at = a * (v * (1.0 - s) / weight) + b * (w * s / weight);
        let degree = (count - 1) as f64;
        [at, (b - a) * (degree * v * w / (weight * weight))]
    }

    /// How far the curve is from the origin of a map of the plane, if that is less than `most`.
    pub(super) fn distance(&self, map: impl Fn(DVec2) -> DVec2, most: f64) -> f64 {
        nearest(&self.row(map), self.points.len(), most, most * FLAT, DEPTH)
    }
}

fn nearest(row: &Row, count: usize, most: f64, flat: f64, depth: u32) -> f64 {
    let place = |i: usize| DVec2::new(row[i][0], row[i][1]) / row[i][2];
    let (mut low, mut high) = (place(0), place(0));
    for i in 1..count {
        (low, high) = (low.min(place(i)), high.max(place(i)));
    }
    if low.max(-high).max(DVec2::ZERO).length() >= most {
        return most;
    }
    let (from, to) = (place(0), place(count - 1));
    let along = to - from;
    let square = along.length_squared();
    let chord = |p: DVec2| {
        let s = ((p - from).dot(along) / square).clamp(0.0, 1.0);
        // Without a length it is its first end.
        let foot = if s.is_nan() { from } else { from + along * s };
        (p - foot).length()
    };
    if depth == 0 || (1..count - 1).all(|i| chord(place(i)) <= flat) {
        return chord(DVec2::ZERO).min(most);
    }
    let (mut left, mut right, mut middle) = (*row, *row, *row);
    for step in 1..count {
        for i in 0..count - step {
            middle[i] = std::array::from_fn(|k| 0.5 * (middle[i][k] + middle[i + 1][k]));
        }
        left[step] = middle[0];
        right[count - 1 - step] = middle[count - 1 - step];
    }
    let most = nearest(&left, count, most, flat, depth - 1);
    nearest(&right, count, most, flat, depth - 1)
}

#[cfg(test)]
mod tests {
    use super::Arc;
    use std::f64::consts::FRAC_1_SQRT_2;
    use strahl_math::DVec2;

    #[test]
    fn a_quarter_of_a_circle_is_as_far_as_it_is() {
        let arc = Arc::new(&[[1.0, 0.0, 1.0], [1.0, 1.0, FRAC_1_SQRT_2], [0.0, 1.0, 1.0]]);
        for k in 0..=20 {
            let s = f64::from(k) / 20.0;
            let [at, by] = arc.at(s);
            assert!((at.length() - 1.0).abs() < 1e-15);
            assert!(at.dot(by).abs() < 1e-14, "{by}");
            let step = 1e-6;
            let numeric = (arc.at(s + step)[0] - arc.at(s - step)[0]) / (2.0 * step);
            assert!((numeric - by).length() < 1e-8);
            for r in [0.9, 1.0, 1.1] {
                let found = arc.distance(|p| p - at * r, 0.5);
                assert!((found - (r - 1.0).abs()).abs() < 1e-3, "{found} {r}");
            }
        }
        assert_eq!(arc.distance(|p| p, 0.5), 0.5);
        assert_eq!(arc.distance(|p| p - DVec2::splat(5.0), 0.5), 0.5);
    }
}
