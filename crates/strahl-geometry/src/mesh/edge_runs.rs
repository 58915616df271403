use super::axes::other_axes;
use super::inside_map::InsideMap;
use strahl_math::DVec3;

/// The edges of a polygon projected on its principal plane, in a hierarchy of boxes around runs of edges that follow each other.
///
/// Whether a point is inside is the parity of the edges that a half-line from it crosses. A run of edges that lies completely
/// on the side of the half-line need not be opened: the parity of its crossings follows from its two ends. So only the runs
/// whose boxes contain the point are opened, however long or spiky the polygon.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct EdgeRuns {
    /// The axes that are kept.
    axes: [usize; 2],
    /// All rings as one closed line: from each ring's start a bridge leads to the next ring, and from the last one back over all
    /// bridges. Each bridge is there in both directions and so without effect.
    line: Box<[[f64; 2]]>,
    /// Boxes around runs of edges: first of `RUN` edges each, then of `RUN` boxes of the level before each, and so on.
    levels: Box<[Box<[Rect]>]>,
    /// A coarse map, if there are many edges.
    map: Option<InsideMap>,
}

/// More edges than this are worth a map (which takes 1 KiB).
const MAPPED: usize = 32;

/// Edges per run, and runs per longer run.
const RUN: usize = 8;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Rect {
    low: [f64; 2],
    high: [f64; 2],
}

/// The position of a box relative to a point that is known up to an error.
enum Place {
    /// Above, below or behind: a half-line along the first axis certainly does not cross it.
    Aside,
    /// Completely in the direction of the half-line: it is crossed if its ends are above and below.
    Ahead,
    /// Around the point, or too close to decide.
    Here,
}

impl Rect {
    fn of_edge(a: [f64; 2], b: [f64; 2]) -> Self {
        let pick = |k: usize| {
            if a[k] < b[k] {
                (a[k], b[k])
            } else {
                (b[k], a[k])
            }
        };
        let ((x0, x1), (y0, y1)) = (pick(0), pick(1));
        Self {
            low: [x0, y0],
            high: [x1, y1],
        }
    }

    fn union(self, other: &Self) -> Self {
        let lower = |k: usize| {
            if other.low[k] < self.low[k] {
                other.low[k]
            } else {
                self.low[k]
            }
        };
        let upper = |k: usize| {
            if other.high[k] > self.high[k] {
                other.high[k]
            } else {
                self.high[k]
            }
        };
        Self {
            low: [lower(0), lower(1)],
            high: [upper(0), upper(1)],
        }
    }

    #[inline]
    fn place(&self, [x, y]: [f64; 2], error: f64) -> Place {
        if (x - error > self.high[0]) | (y - error > self.high[1]) | (y + error < self.low[1]) {
            Place::Aside
        } else if x + error < self.low[0] {
            Place::Ahead
        } else {
            Place::Here
        }
    }
}

impl EdgeRuns {
    /// Projects the rings and builds the boxes.
    pub(super) fn build<'a>(rings: impl Iterator<Item = &'a [DVec3]>, axis: usize) -> Self {
        let (i, j) = other_axes(axis);
        let mut line = Vec::new();
        let mut starts = Vec::new();
        for ring in rings {
            let Some(first) = ring.first() else { continue };
            line.extend(ring.iter().chain([first]).map(|p| [p[i], p[j]]));
            starts.push([first[i], first[j]]);
        }
        line.extend(starts.into_iter().rev().skip(1));

        let edges: Vec<_> = line
            .windows(2)
            .map(|ends| Rect::of_edge(ends[0], ends[1]))
            .collect();
        let mut levels = vec![boxes_of_runs(&edges)];
        while let Some(last) = levels.last().filter(|last| last.len() > RUN) {
            levels.push(boxes_of_runs(last));
        }
        let mut runs = Self {
            axes: [i, j],
            line: line.into(),
            levels: levels.into(),
            map: None,
        };
        if runs.line.len() > MAPPED {
            runs.map = InsideMap::build(&runs.line, |point| runs.locate_exactly(point, 0.0));
        }
        runs
    }

    /// Whether a point that is known up to `error` in each coordinate is inside, by the even-odd rule; `None` if the error
    /// might change the answer.
    ///
    /// If no edge is nearer than the error, all possible positions of the point are on the same side of all edges. Ties in the
    /// heights of corners need no care then: both edges at a corner see the same height.
    pub(super) fn locate(&self, point: DVec3, error: f64) -> Option<bool> {
        let point = self.axes.map(|k| point[k]);
        if !(error.is_finite() && point[0].is_finite() && point[1].is_finite()) {
            return None;
        }
        if let Some(map) = &self.map
            && let Some(inside) = map.locate(point, error)
        {
            return Some(inside);
        }
        self.locate_exactly(point, error)
    }

    /// The same by the runs alone.
    fn locate_exactly(&self, point: [f64; 2], error: f64) -> Option<bool> {
        let top = self.levels.len().checked_sub(1)?;
        self.odd_crossings(top, 0..self.levels[top].len(), point, error)
    }

    /// The parity of the crossings of some boxes of a level.
    fn odd_crossings(
        &self,
        level: usize,
        boxes: std::ops::Range<usize>,
        point: [f64; 2],
        error: f64,
    ) -> Option<bool> {
        let mut odd = false;
        let first = boxes.start;
        for (index, rect) in (first..).zip(&self.levels[level][boxes]) {
            match rect.place(point, error) {
                Place::Aside => {}
                Place::Ahead => {
                    let edges = RUN.pow(level as u32 + 1);
                    let end = ((index + 1) * edges).min(self.line.len() - 1);
                    odd ^= spans(self.line[index * edges], self.line[end], point);
                }
                Place::Here => {
                    let start = index * RUN;
                    odd ^= match level.checked_sub(1) {
                        Some(below) => {
                            let end = (start + RUN).min(self.levels[below].len());
                            self.odd_crossings(below, start..end, point, error)?
                        }
                        None => {
                            let end = (start + RUN).min(self.line.len() - 1);
                            odd_run(&self.line[start..=end], point, error)?
                        }
                    };
                }
            }
        }
        Some(odd)
    }
}

/// The boxes around runs of boxes.
fn boxes_of_runs(parts: &[Rect]) -> Box<[Rect]> {
    parts
        .chunks(RUN)
        .map(|run| run[1..].iter().fold(run[0], |all, part| all.union(part)))
        .collect()
}

/// Whether one of two points is above the point and one is not.
#[inline]
fn spans(a: [f64; 2], b: [f64; 2], point: [f64; 2]) -> bool {
    (a[1] > point[1]) != (b[1] > point[1])
}

/// The parity of the crossings of a few edges.
#[inline]
fn odd_run(line: &[[f64; 2]], point: [f64; 2], error: f64) -> Option<bool> {
    let mut odd = false;
    for ends in line.windows(2) {
        let (a, b) = (ends[0], ends[1]);
        match Rect::of_edge(a, b).place(point, error) {
            Place::Aside => {}
            Place::Ahead => odd ^= spans(a, b, point),
            Place::Here => {
                let [[ax, ay], [bx, by]] = [a, b].map(|p| [p[0] - point[0], p[1] - point[1]]);
                let cross = ax * by - ay * bx;
                if cross.abs() <= error * ((b[0] - a[0]).abs() + (b[1] - a[1]).abs()) {
                    return None;
                }
                odd ^= spans(a, b, point) && (cross > 0.0) == (by > ay);
            }
        }
    }
    Some(odd)
}
