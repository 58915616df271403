//! Reports the comparison: a page with all plates, tables, and the numbers that the test checks.

use super::Look;
use crate::plates::{FILES, Name};
use anyhow::Result;
use std::fmt::Write;
use std::path::Path;

/// Mean colours with a smaller difference, in 8-bit codes, count as the same look.
const CLOSE: f64 = 6.0;

/// Where a plate lies below the folder of the report.
pub(super) fn image(name: &Name, who: &str) -> String {
    let file = name.file.trim_end_matches(".inc");
    format!("images/{file}-{}-{who}.png", name.name)
}

/// A line for each name, the largest differences last.
pub(super) fn lines(looks: &[Look]) -> String {
    let mut order: Vec<&Look> = looks.iter().collect();
    order.sort_by(|a, b| score(a).total_cmp(&score(b)));
    let mut out = String::from("  mean   hist blocks pixels  file             name\n");
    for look in order {
        let d = look.distance;
        let _ = writeln!(
            out,
            "{:6.2} {:6.2} {:6.2} {:6.2}  {:16} {}",
            d.mean, d.histogram, d.blocks, d.pixels, look.name.file, look.name.name
        );
    }
    out
}

fn score(look: &Look) -> f64 {
    let d = look.distance;
    d.mean.max(d.histogram).max(d.blocks)
}

/// A Markdown table with a row for each file.
pub(super) fn summary(looks: &[Look]) -> String {
    let mut out = String::from(
        "| file | names | mean within 6/255 | same pixels (within 1/255) | largest mean | largest histogram | largest blocks |\n|---|---|---|---|---|---|---|\n",
    );
    let mut row = |title: &str, looks: &[&Look]| {
        let most = |value: fn(&Look) -> f64| looks.iter().map(|l| value(l)).fold(0.0, f64::max);
        let count = |is: fn(&Look) -> bool| looks.iter().filter(|l| is(l)).count();
        let _ = writeln!(
            out,
            "| {title} | {} | {} | {} | {:.1} | {:.1} | {:.1} |",
            looks.len(),
            count(|l| l.distance.mean <= CLOSE),
            count(|l| l.distance.pixels <= 1.0),
            most(|l| l.distance.mean),
            most(|l| l.distance.histogram),
            most(|l| l.distance.blocks)
        );
    };
    for file in FILES {
        let of: Vec<&Look> = looks.iter().filter(|l| l.name.file == file).collect();
        if !of.is_empty() {
            row(file, &of);
        }
    }
    row("all", &looks.iter().collect::<Vec<_>>());
    out
}

/// Writes the tables into a page of the manual: the text before the mark stays, the rest is replaced.
pub(super) fn write_table(looks: &[Look], file: &Path) -> Result<()> {
    const MARK: &str = "<!-- looks: written by cargo xtask looks --table -->\n";
    let old = std::fs::read_to_string(file).unwrap_or_default();
    let head = old.split(MARK).next().unwrap_or_default();
    let mut out = format!("{head}{MARK}\n{}", summary(looks));
    for title in FILES {
        let mut of: Vec<&Look> = looks.iter().filter(|l| l.name.file == title).collect();
        let same = of.len();
        of.retain(|l| l.distance.pixels > 1.0);
        let same = same - of.len();
        if of.is_empty() {
            continue;
        }
        of.sort_by(|a, b| score(b).total_cmp(&score(a)));
        writeln!(
            out,
            "\n## {title}\n\n{same} names have the same pixels. The others:\n\n| name | kind | mean | histogram | blocks | pixels |\n|---|---|---|---|---|---|"
        )?;
        for look in of {
            let d = look.distance;
            writeln!(
                out,
                "| `{}` | {} | {:.1} | {:.1} | {:.1} | {:.1} |",
                look.name.name, look.name.kind, d.mean, d.histogram, d.blocks, d.pixels
            )?;
        }
    }
    Ok(std::fs::write(file, out)?)
}

/// Writes the mean colours of POV-Ray's plates.
pub(super) fn write_means(looks: &[Look], cell: (u32, u32), file: &Path) -> Result<()> {
    let mut out = format!("name\tred\tgreen\tblue\t{}x{}\n", cell.0, cell.1);
    for look in looks {
        let [r, g, b] = look.theirs.mean();
        writeln!(
            out,
            "{}/{}\t{r:.1}\t{g:.1}\t{b:.1}",
            look.name.file, look.name.name
        )?;
    }
    Ok(std::fs::write(file, out)?)
}

const HEAD: &str =
    "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>looks of the include library</title>
<style>
body { font: 14px sans-serif; margin: 2em; }
figure { display: inline-block; margin: 6px; width: 200px; font-size: 12px; }
img { width: 96px; image-rendering: pixelated; }
.far { color: #a00; }
</style>
<h1>Looks of the include library: POV-Ray, strahl</h1>
<p>The numbers are the distances of means, histograms, means of blocks and pixels, in 8-bit codes.</p>
";

/// All plates side by side, the largest differences of a file first.
pub(super) fn write_html(looks: &[Look], file: &Path) -> Result<()> {
    let mut out = String::from(HEAD);
    for title in FILES {
        let mut of: Vec<&Look> = looks.iter().filter(|l| l.name.file == title).collect();
        if of.is_empty() {
            continue;
        }
        of.sort_by(|a, b| score(b).total_cmp(&score(a)));
        writeln!(out, "<h2>{title}</h2>")?;
        for look in of {
            let d = look.distance;
            let far = if d.mean > CLOSE { " class=\"far\"" } else { "" };
            writeln!(
                out,
                "<figure{far}><img src=\"{}\" alt=\"POV-Ray\"><img src=\"{}\" alt=\"strahl\"><br>{}: {:.1} {:.1} {:.1} {:.1}</figure>",
                image(&look.name, "povray"),
                image(&look.name, "strahl"),
                look.name.name,
                d.mean,
                d.histogram,
                d.blocks,
                d.pixels
            )?;
        }
    }
    out.push_str("</html>\n");
    Ok(std::fs::write(file, out)?)
}
