/// A coarse map of a polygon, which decides for most points whether they are inside without testing edges.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct InsideMap {
    low: [f64; 2],
    /// Cells per unit of length.
    scale: [f64; 2],
    /// From the lowest up.
    rows: Box<[Row; SIDE]>,
}

/// Cells along a side.
const SIDE: usize = 64;

/// Cells closer than this to an edge (in cells) count as near it. Points may have an error of half of it; the other half is far
/// above the rounding error here.
const MARGIN: f64 = 0.25;

/// A row of cells, a bit per cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Row {
    /// Whether an edge is in the cell, or closer than the margin.
    near: u64,
    /// Otherwise: whether the cell is inside.
    inside: u64,
}

impl InsideMap {
    /// The map of a closed line; `inside` returns for a point that is not near an edge whether it is inside. `None` if the line
    /// has no extent.
    pub(super) fn build(
        line: &[[f64; 2]],
        inside: impl Fn([f64; 2]) -> Option<bool>,
    ) -> Option<Self> {
        let extreme =
            |k: usize, pick: fn(f64, f64) -> f64| line.iter().map(|p| p[k]).fold(line[0][k], pick);
        let low = [extreme(0, f64::min), extreme(1, f64::min)];
        let high = [extreme(0, f64::max), extreme(1, f64::max)];
        let scale = [0, 1].map(|k| SIDE as f64 / (high[k] - low[k]));
        if !scale.iter().all(|s| s.is_finite()) {
            return None;
        }
        let mut map = Self {
            low,
            scale,
            rows: Box::new([Row::default(); SIDE]),
        };
        for ends in line.windows(2) {
            map.mark(map.place(ends[0]), map.place(ends[1]));
        }
        for row in 0..SIDE {
            map.fill(row, &inside);
        }
        Some(map)
    }

    /// A point in cells.
    #[inline]
    fn place(&self, point: [f64; 2]) -> [f64; 2] {
        [
            (point[0] - self.low[0]) * self.scale[0],
            (point[1] - self.low[1]) * self.scale[1],
        ]
    }

    /// Marks the cells near an edge.
    fn mark(&mut self, a: [f64; 2], b: [f64; 2]) {
        let (a, b) = if a[1] < b[1] { (a, b) } else { (b, a) };
        let slope = (b[0] - a[0]) / (b[1] - a[1]);
        for row in cell(a[1] - MARGIN)..=cell(b[1] + MARGIN) {
            // The part of the edge that is in the row, with its margins.
            let at = |y: f64| {
                let x = a[0] + (y - a[1]) * slope;
                // An edge along the row has no slope.
                if y > a[1] && y < b[1] { Some(x) } else { None }
            };
            let from = at(row as f64 - MARGIN).unwrap_or(a[0]);
            let to = at((row + 1) as f64 + MARGIN).unwrap_or(b[0]);
            let (from, to) = if from < to { (from, to) } else { (to, from) };
            let (first, last) = (cell(from - MARGIN), cell(to + MARGIN));
            self.rows[row].near |= (u64::MAX << first) & (u64::MAX >> (SIDE - 1 - last));
        }
    }

    /// Decides which cells of a row are inside: adjacent cells without an edge are alike.
    fn fill(&mut self, row: usize, inside: &impl Fn([f64; 2]) -> Option<bool>) {
        let mut before = None;
        for column in 0..SIDE {
            let bit = 1 << column;
            if self.rows[row].near & bit != 0 {
                before = None;
                continue;
            }
            let center = [column as f64 + 0.5, row as f64 + 0.5];
            let point = [0, 1].map(|k| self.low[k] + center[k] / self.scale[k]);
            before = before.or_else(|| inside(point));
            match before {
                Some(true) => self.rows[row].inside |= bit,
                Some(false) => {}
                None => self.rows[row].near |= bit,
            }
        }
    }

    /// Whether a point that is known up to `error` in each coordinate is inside; `None` if it may be near an edge, or outside
    /// of the map.
    #[inline]
    pub(super) fn locate(&self, point: [f64; 2], error: f64) -> Option<bool> {
        let [x, y] = self.place(point);
        let side = 0.0..SIDE as f64;
        if !(side.contains(&x) && side.contains(&y)) {
            return None;
        }
        let precise = error * self.scale[0] < 0.5 * MARGIN && error * self.scale[1] < 0.5 * MARGIN;
        let (row, column) = (self.rows[y as usize], x as u32);
        (precise && row.near >> column & 1 == 0).then_some(row.inside >> column & 1 == 1)
    }
}

/// The cell of a coordinate, or the nearest one.
fn cell(x: f64) -> usize {
    (x as usize).min(SIDE - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a point is inside, by all edges.
    fn odd(line: &[[f64; 2]], p: [f64; 2]) -> bool {
        let crossed = line.windows(2).filter(|ends| {
            let ([ax, ay], [bx, by]) = (ends[0], ends[1]);
            (ay > p[1]) != (by > p[1]) && ax + (p[1] - ay) / (by - ay) * (bx - ax) > p[0]
        });
        crossed.count() % 2 == 1
    }

    #[test]
    fn what_the_map_knows_is_true_and_it_knows_most() {
        // A star with spikes between radius 1 and 2, stretched and shifted.
        let mut star: Vec<[f64; 2]> = (0..100)
            .map(|i| {
                let angle = f64::from(i) * std::f64::consts::TAU / 100.0;
                let radius = 1.0 + f64::from(i % 2);
                [
                    3.0 + 10.0 * radius * angle.cos(),
                    radius * angle.sin() - 7.0,
                ]
            })
            .collect();
        star.push(star[0]);
        let map = InsideMap::build(&star, |p| Some(odd(&star, p))).expect("a map");
        let (mut known, mut inside) = (0, 0);
        for i in 0..300 {
            for j in 0..300 {
                let point = [f64::from(i) / 6.0 - 22.0, f64::from(j) / 60.0 - 9.5];
                if let Some(answer) = map.locate(point, 1e-12) {
                    assert_eq!(answer, odd(&star, point), "{point:?}");
                    known += 1;
                    inside += u32::from(answer);
                    // So are all points that it may be.
                    for (dx, dy) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                        let error = 0.1 * 4.0 / 64.0;
                        if map.locate(point, error).is_some() {
                            let near = [point[0] + dx * error, point[1] + dy * error];
                            assert_eq!(answer, odd(&star, near));
                        }
                    }
                }
            }
        }
        assert!(known > 25_000 && inside > 8_000, "{known} {inside}");
        assert_eq!(map.locate([3.0, -7.0], 1e-12), Some(true));
        assert_eq!(map.locate([3.0, -7.0], 1.0), None);
        assert_eq!(map.locate([300.0, -7.0], 0.0), None);
        assert_eq!(map.locate([f64::NAN, -7.0], 0.0), None);
    }

    #[test]
    fn a_line_without_extent_has_no_map() {
        assert_eq!(InsideMap::build(&[[1.0, 2.0], [1.0, 5.0]], |_| None), None);
    }
}
