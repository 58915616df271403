use super::super::node::{Node, Part, list, needed, optional, run, words};
use super::Sort;
use super::Writer;

impl Writer {
    /// Corners around the origin, in turning order.
    fn ring(&mut self, count: usize) -> Vec<[f64; 2]> {
        let turn = self.dice.number(0.0, 1.0);
        let round = |v: f64| (v * 100.0).round() / 100.0;
        (0..count)
            .map(|i| {
                let angle = (i as f64 + turn) * std::f64::consts::TAU / count as f64;
                let r = self.dice.number(0.5, 1.2);
                [round(r * angle.cos()), round(r * angle.sin())]
            })
            .collect()
    }

    /// The points with commas between.
    fn points(points: &[[f64; 2]]) -> Node {
        let parts = points.iter().map(|p| needed(list![",", *p])).collect();
        run(Sort::Other, parts)
    }

    pub(super) fn prism(&mut self) -> Vec<Part> {
        let mut ring = {
            let count = self.dice.between(3, 6);
            self.ring(count)
        };
        let first = ring[0];
        let spline = self.dice.pick(&[
            "linear_spline",
            "linear_spline",
            "quadratic_spline",
            "cubic_spline",
            "",
        ]);
        let last = ring[ring.len() - 1];
        match spline {
            "quadratic_spline" => {
                ring.push(first);
                ring.insert(0, last);
            }
            "cubic_spline" => {
                let second = ring[1];
                ring.push(first);
                ring.push(second);
                ring.insert(0, last);
            }
            _ => ring.push(first),
        }
        let sweep = self
            .dice
            .weighted(&[(60, ""), (20, "linear_sweep"), (25, "conic_sweep")]);
        let (low, high) = match sweep {
            "conic_sweep" => (self.number(0.2, 0.6), self.number(0.7, 1.3)),
            _ => (self.number(-0.9, -0.1), self.number(0.1, 0.9)),
        };
        let count = ring.len() as f64;
        let mut parts = vec![
            needed(words(spline)),
            optional(words(sweep)),
            needed(list![low, ",", high, ",", count]),
            needed(Self::points(&ring)),
        ];
        self.open_or_sturm(&mut parts);
        parts
    }

    fn open_or_sturm(&mut self, parts: &mut Vec<Part>) {
        if self.dice.chance(12) {
            parts.push(optional(words("open")));
        }
        if self.dice.chance(20) {
            parts.push(optional(words("sturm")));
        }
    }

    /// A curve on one side of the y axis.
    fn profile(&mut self, count: usize) -> Vec<[f64; 2]> {
        let step = 2.0 / count as f64;
        (0..count)
            .map(|i| {
                let y = -1.0 + step * i as f64 + self.dice.number(0.0, step * 0.7);
                [self.dice.number(0.15, 1.0), (y * 100.0).round() / 100.0]
            })
            .collect()
    }

    pub(super) fn lathe(&mut self) -> Vec<Part> {
        let spline = self.dice.pick(&[
            "linear_spline",
            "quadratic_spline",
            "cubic_spline",
            "bezier_spline",
        ]);
        let count = match spline {
            "bezier_spline" => 4,
            "linear_spline" => self.dice.between(2, 5),
            _ => self.dice.between(4, 6),
        };
        let points = self.profile(count);
        let mut parts = vec![
            needed(words(spline)),
            needed(list![count as f64]),
            needed(Self::points(&points)),
        ];
        if self.dice.chance(20) {
            parts.push(optional(words("sturm")));
        }
        parts
    }

    pub(super) fn sor(&mut self) -> Vec<Part> {
        let count = self.dice.between(4, 6);
        let points = self.profile(count);
        let mut parts = vec![needed(list![count as f64]), needed(Self::points(&points))];
        self.open_or_sturm(&mut parts);
        parts
    }

    pub(super) fn sphere_sweep(&mut self) -> Vec<Part> {
        let spline =
            self.dice
                .pick(&["linear_spline", "linear_spline", "cubic_spline", "b_spline"]);
        let count = match spline {
            "linear_spline" => self.dice.between(2, 4),
            _ => self.dice.between(4, 5),
        };
        let mut parts = vec![needed(list![spline, count as f64])];
        for _ in 0..count {
            let (place, radius) = (self.point(1.0), self.number(0.15, 0.5));
            parts.push(needed(list![",", place, ",", radius]));
        }
        if self.dice.chance(30) {
            parts.push(optional(words("tolerance 0.0001")));
        }
        parts
    }
}
