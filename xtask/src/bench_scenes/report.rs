//! Tables and a histogram of times.

use super::Row;
use crate::bench::geometric_mean;
use std::fmt::Write as _;

/// Scenes in which both programs need less than this many seconds never count as slower: start-up dominates.
const SHORT: f64 = 0.1;

impl Row {
    fn ratio(&self) -> f64 {
        self.povray / self.strahl
    }

    /// Whether strahl takes longer, and the scene is not too short.
    fn is_slower(&self) -> bool {
        self.ratio() < 1.0 && self.strahl > SHORT
    }
}

pub(super) fn line(row: &Row) -> String {
    let mut line = format!(
        "{}: POV-Ray {:.2} s, strahl {:.2} s, {:.2} times as fast",
        row.scene,
        row.povray,
        row.strahl,
        row.ratio()
    );
    if let Some((povray, strahl)) = row.errors {
        let _ = write!(line, "; error {povray:.2} and {strahl:.2}");
    }
    line
}

/// The table: slower scenes first, then the others, then the totals.
pub(super) fn table(rows: &mut [Row], left_out: usize) -> String {
    rows.sort_by(|a, b| a.ratio().total_cmp(&b.ratio()));
    let mut text =
        String::from("| scene | POV-Ray s | strahl s | times as fast |\n|---|---|---|---|\n");
    for row in rows.iter().filter(|row| row.is_slower()) {
        let _ = writeln!(
            text,
            "| {} | {:.2} | {:.2} | {:.2} |",
            row.scene,
            row.povray,
            row.strahl,
            row.ratio()
        );
    }
    let all = |keep: &dyn Fn(&Row) -> bool| {
        let ratios: Vec<f64> = rows.iter().filter(|r| keep(r)).map(Row::ratio).collect();
        (ratios.len(), geometric_mean(&ratios))
    };
    let (count, mean) = all(&|_| true);
    let (long, long_mean) = all(&|row| row.povray > 1.0);
    let slower = rows.iter().filter(|row| row.is_slower()).count();
    let _ = writeln!(
        text,
        "{count} scenes, {left_out} left out; geometric mean {mean}; {slower} above {SHORT} s are slower; \
         {long} take POV-Ray more than a second: {long_mean}"
    );
    let errors: Vec<(f64, f64)> = rows.iter().filter_map(|row| row.errors).collect();
    if !errors.is_empty() {
        let better = errors
            .iter()
            .filter(|(povray, strahl)| strahl <= povray)
            .count();
        let mean =
            |of: fn(&(f64, f64)) -> f64| errors.iter().map(of).sum::<f64>() / errors.len() as f64;
        let _ = writeln!(
            text,
            "error against converged pictures of {} scenes: POV-Ray {:.2}, strahl {:.2} on average; strahl's is no larger in {better}",
            errors.len(),
            mean(|e| e.0),
            mean(|e| e.1)
        );
    }
    text
}

pub(super) fn tsv(rows: &[Row]) -> String {
    let mut text = String::from("scene\tpovray_s\tstrahl_s\tratio\tpovray_error\tstrahl_error\n");
    for row in rows {
        let errors = row
            .errors
            .map_or_else(|| "\t".to_owned(), |(a, b)| format!("{a:.3}\t{b:.3}"));
        let _ = writeln!(
            text,
            "{}\t{:.3}\t{:.3}\t{:.3}\t{errors}",
            row.scene,
            row.povray,
            row.strahl,
            row.ratio()
        );
    }
    text
}

/// A histogram of the speed ratios, in bars of half an octave.
pub(super) fn histogram(rows: &[Row]) -> String {
    const BARS: usize = 17;
    let bar_of =
        |ratio: f64| ((ratio.log2() * 2.0).floor() + 8.0).clamp(0.0, (BARS - 1) as f64) as usize;
    let mut counts = [0usize; BARS];
    for row in rows {
        counts[bar_of(row.ratio())] += 1;
    }
    let most = counts.iter().copied().max().unwrap_or(0).max(1);
    let mut svg = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 560 260\" font-family=\"sans-serif\" font-size=\"11\">\n",
    );
    let _ = writeln!(
        svg,
        "<text x=\"280\" y=\"16\" text-anchor=\"middle\" font-size=\"13\">POV-Ray's time / strahl's, {} scenes</text>",
        rows.len()
    );
    for (bar, &count) in counts.iter().enumerate() {
        let (x, height) = (20 + 31 * bar, (190 * count).div_ceil(most));
        let color = if bar < 8 { "#b5443c" } else { "#3c7ab5" };
        let _ = writeln!(
            svg,
            "<rect x=\"{x}\" y=\"{}\" width=\"27\" height=\"{height}\" fill=\"{color}\"/>",
            225 - height
        );
        if count > 0 {
            let _ = writeln!(
                svg,
                "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{count}</text>",
                x + 13,
                221 - height
            );
        }
        if bar % 2 == 0 {
            let ratio = 2f64.powi(bar as i32 / 2 - 4);
            let _ = writeln!(
                svg,
                "<text x=\"{x}\" y=\"242\" text-anchor=\"middle\">{ratio}</text>"
            );
        }
    }
    svg.push_str("</svg>\n");
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(povray: f64, strahl: f64) -> Row {
        Row {
            scene: format!("{povray}-{strahl}.pov"),
            povray,
            strahl,
            errors: Some((2.0, 1.5)),
        }
    }

    #[test]
    fn slower_scenes_come_first_and_short_ones_do_not_count() {
        let mut rows = vec![row(4.0, 1.0), row(0.02, 0.08), row(1.0, 2.0), row(1.0, 4.0)];
        let text = table(&mut rows, 3);
        let lines: Vec<&str> = text.lines().collect();
        assert!(
            lines[2].starts_with("| 1-4.pov") && lines[3].starts_with("| 1-2.pov"),
            "{text}"
        );
        assert!(lines[4].starts_with("4 scenes, 3 left out"), "{text}");
        assert!(lines[4].contains("2 above 0.1 s are slower"), "{text}");
        assert!(lines[5].contains("POV-Ray 2.00, strahl 1.50"), "{text}");
        assert_eq!(histogram(&rows).matches("<rect").count(), 17);
    }
}
