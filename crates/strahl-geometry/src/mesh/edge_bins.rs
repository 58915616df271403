use super::polygon::{largest_axis, other_axes};
use strahl_math::{Aabb, DVec3};

/// The edges of a polygon, projected on its principal plane and sorted into bins by height, so that a point meets only the
/// edges beside it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct EdgeBins {
    /// The axes that are kept: x, and y, along which the bins are stacked.
    axes: [usize; 2],
    /// The box of the projected corners.
    low: [f64; 2],
    high: [f64; 2],
    /// Bins per unit of y.
    density: f64,
    /// How far beyond its own range of y an edge is entered into bins: the largest error that can be dealt with.
    margin: f64,
    /// Where each bin starts in `edges`, and the end of the last.
    starts: Box<[u32]>,
    /// Ends `[ax, ay, bx, by]`, bin by bin.
    edges: Box<[[f64; 4]]>,
    /// The sum of the largest coordinates.
    reach: f64,
}

/// On average an edge is entered into no more bins than this; bins are made larger until it holds.
const ENTRIES_PER_EDGE: usize = 4;

impl EdgeBins {
    /// Sorts the edges of all rings.
    pub(super) fn build<'a>(rings: impl Iterator<Item = &'a [DVec3]>, normal: DVec3) -> Self {
        let (i, j) = other_axes(largest_axis(normal));
        let mut ends: Vec<(DVec3, DVec3)> = Vec::new();
        for ring in rings {
            let next = ring.iter().cycle().skip(1);
            ends.extend(ring.iter().copied().zip(next.copied()));
        }
        let bounds = Aabb::from_points(ends.iter().map(|(a, _)| *a));

        // Stack the bins along the axis on which the edges reach less far, so that fewer of them lie beside a point.
        let climb = |k: usize| {
            let total: f64 = ends.iter().map(|(a, b)| (b[k] - a[k]).abs()).sum();
            total / (bounds.max[k] - bounds.min[k])
        };
        let axes = if climb(i) < climb(j) { [j, i] } else { [i, j] };
        let edges: Vec<[f64; 4]> = ends
            .iter()
            .map(|(a, b)| [a[axes[0]], a[axes[1]], b[axes[0]], b[axes[1]]])
            .collect();

        let height = bounds.max[axes[1]] - bounds.min[axes[1]];
        let mut bins = Self {
            axes,
            low: axes.map(|k| bounds.min[k]),
            high: axes.map(|k| bounds.max[k]),
            density: 0.0,
            margin: height / (1u64 << 20) as f64,
            starts: Box::default(),
            edges: Box::default(),
            reach: bounds.min.abs().max(bounds.max.abs()).element_sum(),
        };
        let mut count = edges.len();
        loop {
            bins.density = count as f64 / height;
            let entries: usize = edges.iter().map(|e| bins.range(e, count).count()).sum();
            if entries <= ENTRIES_PER_EDGE * edges.len() || count <= 1 {
                break;
            }
            count /= 2;
        }
        bins.fill(&edges, count);
        bins
    }

    /// Counting sort of the edges into `count` bins.
    fn fill(&mut self, edges: &[[f64; 4]], count: usize) {
        let mut starts = vec![0u32; count + 1];
        for edge in edges {
            for bin in self.range(edge, count) {
                starts[bin + 1] += 1;
            }
        }
        for bin in 0..count {
            starts[bin + 1] += starts[bin];
        }
        let mut sorted = vec![[0.0; 4]; starts[count] as usize];
        let mut next = starts.clone();
        for edge in edges {
            for bin in self.range(edge, count) {
                sorted[next[bin] as usize] = *edge;
                next[bin] += 1;
            }
        }
        self.starts = starts.into();
        self.edges = sorted.into();
    }

    /// The bins an edge is entered into.
    fn range(&self, [_, ay, _, by]: &[f64; 4], count: usize) -> std::ops::RangeInclusive<usize> {
        let (low, high) = (ay.min(*by) - self.margin, ay.max(*by) + self.margin);
        self.bin(low, count)..=self.bin(high, count)
    }

    /// The bin of a height, which never falls as the height rises; heights out of range get the first or the last one.
    fn bin(&self, y: f64, count: usize) -> usize {
        (((y - self.low[1]) * self.density) as usize).min(count - 1)
    }

    /// The sum of the largest coordinates of the polygon.
    pub(super) const fn reach(&self) -> f64 {
        self.reach
    }

    /// Whether a point that is known up to `error` in each coordinate is inside, by the even-odd rule; `None` if the error
    /// might change the answer.
    ///
    /// If no edge comes nearer than the error, all the places the point may have are on the same side of all edges.
    /// Decisions about the heights of corners need no care then: both edges at a corner see the same height.
    pub(super) fn locate(&self, point: DVec3, error: f64) -> Option<bool> {
        if !(error <= self.margin) {
            return None;
        }
        let [x, y] = self.axes.map(|k| point[k]);
        let outside = |k: usize, p: f64| p + error < self.low[k] || p - error > self.high[k];
        if outside(0, x) || outside(1, y) {
            return Some(false);
        }
        let bin = self.bin(y, self.starts.len() - 1);
        let range = self.starts[bin] as usize..self.starts[bin + 1] as usize;
        let mut odd = false;
        for &[ax, ay, bx, by] in &self.edges[range] {
            let spans = (ay > y) != (by > y);
            let left_of_point = x - error > ax && x - error > bx;
            let above = y + error < ay && y + error < by;
            let below = y - error > ay && y - error > by;
            if left_of_point || above || below {
                continue;
            }
            if x + error < ax && x + error < bx {
                odd ^= spans;
                continue;
            }
            let cross = (ax - x) * (by - y) - (ay - y) * (bx - x);
            if cross.abs() <= error * ((bx - ax).abs() + (by - ay).abs()) {
                return None;
            }
            odd ^= spans && (cross > 0.0) == (by > ay);
        }
        Some(odd)
    }
}
