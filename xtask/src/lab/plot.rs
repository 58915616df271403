//! Double-logarithmic plots as SVG.

use std::fmt::Write;

/// The measured points of one curve.
pub(super) struct Series<'a> {
    pub(super) name: &'a str,
    /// `(x, y)`, both above 0, in the order of x.
    pub(super) points: Vec<(f64, f64)>,
}

pub(super) struct Plot<'a> {
    pub(super) title: &'a str,
    pub(super) x_axis: &'a str,
    pub(super) series: &'a [Series<'a>],
}

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 460.0;
/// Left, right, top, bottom of the drawing.
const FRAME: [f64; 4] = [70.0, 590.0, 40.0, 410.0];

/// Colours that differ in lightness as well (Okabe and Ito, 2008).
const COLORS: [&str; 8] = [
    "#000000", "#e69f00", "#56b4e9", "#009e73", "#cc79a7", "#0072b2", "#d55e00", "#999999",
];

/// A logarithmic axis over whole decades.
struct Axis {
    first: i32,
    last: i32,
    from: f64,
    to: f64,
}

impl Axis {
    fn new(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Self {
        let (mut low, mut high) = (f64::INFINITY, 0.0f64);
        for value in values.filter(|v| *v > 0.0 && v.is_finite()) {
            (low, high) = (low.min(value), high.max(value));
        }
        if low > high {
            (low, high) = (1.0, 10.0);
        }
        let first = low.log10().floor() as i32;
        let last = (high.log10().ceil() as i32).max(first + 1);
        Self {
            first,
            last,
            from,
            to,
        }
    }

    fn place(&self, value: f64) -> f64 {
        let part = (value.log10() - f64::from(self.first)) / f64::from(self.last - self.first);
        self.from + (self.to - self.from) * part
    }
}

impl Plot<'_> {
    /// The plot as SVG.
    pub(super) fn svg(&self) -> String {
        let [left, right, top, bottom] = FRAME;
        let points = || self.series.iter().flat_map(|s| s.points.iter());
        let x = Axis::new(points().map(|p| p.0), left, right);
        let y = Axis::new(points().map(|p| p.1), bottom, top);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
             font-family=\"sans-serif\" font-size=\"13\">\n\
             <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#ffffff\"/>\n"
        );
        text(&mut svg, (left + right) / 2.0, 22.0, "middle", self.title);
        text(
            &mut svg,
            (left + right) / 2.0,
            HEIGHT - 12.0,
            "middle",
            self.x_axis,
        );
        for decade in x.first..=x.last {
            let at = x.place(10f64.powi(decade));
            line(&mut svg, (at, top), (at, bottom), "#dddddd");
            text(&mut svg, at, bottom + 18.0, "middle", &power(decade));
        }
        for decade in y.first..=y.last {
            let at = y.place(10f64.powi(decade));
            line(&mut svg, (left, at), (right, at), "#dddddd");
            text(&mut svg, left - 8.0, at + 4.0, "end", &power(decade));
        }
        self.guides(&mut svg, &x, &y);
        let mut labels: Vec<(f64, usize)> = Vec::new();
        for (index, series) in self.series.iter().enumerate() {
            let color = COLORS[index % COLORS.len()];
            let places: Vec<(f64, f64)> = series
                .points
                .iter()
                .map(|p| (x.place(p.0), y.place(p.1)))
                .collect();
            let path: Vec<String> = places
                .iter()
                .map(|(x, y)| format!("{x:.1},{y:.1}"))
                .collect();
            let _ = writeln!(
                svg,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\"/>",
                path.join(" ")
            );
            for (x, y) in &places {
                let _ = writeln!(
                    svg,
                    "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{color}\"/>"
                );
            }
            labels.push((places.last().map_or(top, |p| p.1), index));
        }
        // The names of the curves stand beside their last points, moved apart if they overlap.
        labels.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut free = top;
        for (at, index) in labels {
            let at = at.max(free);
            free = at + 16.0;
            let color = COLORS[index % COLORS.len()];
            let name = self.series[index].name;
            let _ = writeln!(
                svg,
                "<text x=\"{:.1}\" y=\"{:.1}\" fill=\"{color}\">{name}</text>",
                right + 10.0,
                at + 4.0
            );
        }
        svg + "</svg>\n"
    }

    /// A dashed line of slope one, for comparison with linear growth.
    fn guides(&self, svg: &mut String, x: &Axis, y: &Axis) {
        let Some(first) = self.series.first().and_then(|s| s.points.first()) else {
            return;
        };
        let end = 10f64
            .powi(x.last)
            .min(first.0 * 10f64.powi(y.last) / first.1);
        let _ = writeln!(
            svg,
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"#777777\" stroke-dasharray=\"5 4\"/>",
            x.place(first.0),
            y.place(first.1),
            x.place(end),
            y.place(end / first.0 * first.1),
        );
    }
}

fn text(svg: &mut String, x: f64, y: f64, anchor: &str, words: &str) {
    let _ = writeln!(
        svg,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{words}</text>"
    );
}

fn line(svg: &mut String, a: (f64, f64), b: (f64, f64), color: &str) {
    let _ = writeln!(
        svg,
        "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{color}\"/>",
        a.0, a.1, b.0, b.1
    );
}

/// A power of ten as a label.
fn power(decade: i32) -> String {
    match decade {
        -2..=3 => format!("{}", 10f64.powi(decade)),
        4..=5 => format!("{} k", 10f64.powi(decade - 3)),
        6..=8 => format!("{} M", 10f64.powi(decade - 6)),
        _ => format!("1e{decade}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_factors_are_equal_distances() {
        let axis = Axis::new([5.0, 2000.0].into_iter(), 0.0, 400.0);
        assert_eq!((axis.first, axis.last), (0, 4));
        assert!((axis.place(100.0) - 200.0).abs() < 1e-9);
        assert!((axis.place(20.0) - axis.place(2.0) - 100.0).abs() < 1e-9);
    }

    #[test]
    fn a_plot_has_a_line_for_every_series() {
        let series = [
            Series {
                name: "list",
                points: vec![(10.0, 10.0), (1000.0, 1000.0)],
            },
            Series {
                name: "bvh",
                points: vec![(10.0, 4.0), (1000.0, 10.0)],
            },
        ];
        let svg = Plot {
            title: "t",
            x_axis: "n",
            series: &series,
        }
        .svg();
        assert_eq!(svg.matches("<polyline").count(), 2);
        assert!(svg.contains(">list</text>") && svg.ends_with("</svg>\n"));
    }
}
