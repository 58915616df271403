use super::Row;
use anyhow::Result;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

/// Pictures with a smaller mean difference, in 8-bit codes, count as the same.
const CLOSE: f64 = 4.0;

/// The largest number of reasons listed.
const REASONS: usize = 25;

/// A scene in one line, for the terminal.
pub(super) fn line(row: &Row) -> String {
    let state = match (row.difference, row.strahl.rendered, row.parses) {
        (Some((mean, _)), ..) => format!("differs by {mean:.2}"),
        (None, true, _) => "rendered by strahl only".to_owned(),
        (None, false, true) => format!("parses only: {}", row.strahl.reason),
        (None, false, false) => row.strahl.reason.clone(),
    };
    format!("{}: {state}", row.scene)
}

/// The summary of all scenes.
pub(super) fn totals(rows: &[Row]) -> String {
    let mut out = String::new();
    let theirs: Vec<&Row> = rows.iter().filter(|r| r.povray.rendered).collect();
    let parse = |rows: &[&Row]| rows.iter().filter(|r| r.parses).count();
    let render = |rows: &[&Row]| rows.iter().filter(|r| r.strahl.rendered).count();
    let is_whole = |r: &&&Row| r.strahl.rendered && r.strahl.lacks.is_empty();
    let whole = |rows: &[&Row]| rows.iter().filter(is_whole).count();
    let close = |rows: &[&Row]| rows.iter().filter(|r| is_close(r)).count();
    let plain: Vec<&Row> = theirs
        .iter()
        .filter(|r| r.marks.is_empty())
        .copied()
        .collect();
    let complete: Vec<&Row> = theirs.iter().filter(is_whole).copied().collect();
    let _ = writeln!(
        out,
        "{} scenes, {} of them rendered by POV-Ray at this size within the time",
        rows.len(),
        theirs.len()
    );
    for (what, rows) in [
        ("of those rendered by POV-Ray", &theirs),
        (
            "of those without radiosity, photons, media, subsurface",
            &plain,
        ),
        ("of those with nothing left out", &complete),
    ] {
        let percent = |n: usize| 100.0 * n as f64 / rows.len().max(1) as f64;
        let counts = [
            ("parse without error", parse(rows)),
            ("are rendered", render(rows)),
            ("are rendered with nothing left out", whole(rows)),
            (
                "are rendered with a mean difference below 4/255",
                close(rows),
            ),
        ];
        let _ = writeln!(out, "{what} ({}):", rows.len());
        for (text, n) in counts {
            let _ = writeln!(out, "  {:5.1} % {text} ({n})", percent(n));
        }
    }
    let apart: Vec<&&Row> = complete.iter().filter(|r| !is_close(r)).collect();
    if !apart.is_empty() {
        let _ = writeln!(out, "differ although nothing is left out:");
    }
    for row in apart {
        let mean = row.difference.map_or(f64::NAN, |(mean, _)| mean);
        let _ = writeln!(out, "  {mean:6.2} {}", row.scene);
    }
    let both: Vec<&Row> = rows.iter().filter(|r| r.difference.is_some()).collect();
    let sum = |seconds: fn(&Row) -> f64| both.iter().map(|r| seconds(r)).sum::<f64>();
    let _ = writeln!(
        out,
        "wall time of the {} scenes rendered by both: POV-Ray {:.1} s, strahl {:.1} s, one thread each",
        both.len(),
        sum(|r| r.povray.seconds),
        sum(|r| r.strahl.seconds)
    );
    list(
        &mut out,
        "first reasons of scenes that are not rendered",
        &reasons(rows),
    );
    list(&mut out, "left out, by number of scenes", &lacks(rows));
    out
}

fn list(out: &mut String, title: &str, lines: &[(String, usize)]) {
    if !lines.is_empty() {
        let _ = writeln!(out, "{title}:");
    }
    for (text, count) in lines.iter().take(REASONS) {
        let _ = writeln!(out, "  {count:4} {text}");
    }
}

fn is_close(row: &Row) -> bool {
    row.difference.is_some_and(|(mean, _)| mean < CLOSE)
}

/// The first reasons without their places, the most frequent first.
fn reasons(rows: &[Row]) -> Vec<(String, usize)> {
    let missing = rows.iter().filter(|r| !r.strahl.rendered);
    counted(missing.map(|row| {
        let reason = row.strahl.reason.as_str();
        reason.rsplit_once(" (").map_or(reason, |(text, _)| text)
    }))
}

/// Features left out, with the number of scenes.
fn lacks(rows: &[Row]) -> Vec<(String, usize)> {
    counted(
        rows.iter()
            .flat_map(|r| &r.strahl.lacks)
            .map(String::as_str),
    )
}

fn counted<'a>(texts: impl Iterator<Item = &'a str>) -> Vec<(String, usize)> {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for text in texts {
        *counts.entry(text).or_default() += 1;
    }
    let mut counts: Vec<_> = counts.into_iter().map(|(t, n)| (t.to_owned(), n)).collect();
    counts.sort_by_key(|(_, n)| std::cmp::Reverse(*n));
    counts
}

/// Writes a table with a line per scene, for programs.
pub(super) fn write_tsv(rows: &[Row], file: &Path) -> Result<()> {
    let mut out = String::from(
        "scene\tparses\trenders\tmean\trms\tpovray_s\tstrahl_s\tleft_out\tmarks\treason\tpovray_reason\n",
    );
    for row in rows {
        let (mean, rms) = match row.difference {
            Some((mean, rms)) => (format!("{mean:.3}"), format!("{rms:.3}")),
            None => (String::new(), String::new()),
        };
        let plain = |text: &str| text.replace(['\t', '\n'], " ");
        writeln!(
            out,
            "{}\t{}\t{}\t{mean}\t{rms}\t{:.2}\t{:.2}\t{}\t{}\t{}\t{}",
            row.scene,
            u8::from(row.parses),
            u8::from(row.strahl.rendered),
            row.povray.seconds,
            row.strahl.seconds,
            row.strahl.lacks.len(),
            row.marks.join(","),
            plain(&row.strahl.reason),
            plain(&row.povray.reason),
        )?;
    }
    Ok(std::fs::write(file, out)?)
}

const HEAD: &str =
    "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>strahl and POV-Ray</title>
<style>
body { font: 14px sans-serif; margin: 2em; }
table { border-collapse: collapse; }
td, th { border-bottom: 1px solid #ccc; padding: 4px 8px; text-align: left; vertical-align: top; }
td.n { text-align: right; }
.close { color: #060; } .far { color: #a00; }
</style>
<h1>strahl and POV-Ray</h1>
";

/// Writes all pictures side by side, the largest differences first, scenes without two pictures at the end.
pub(super) fn write_html(rows: &[Row], size: (u32, u32), file: &Path) -> Result<()> {
    let mut out = String::from(HEAD);
    writeln!(out, "<pre>{}</pre>", escaped(&totals(rows)))?;
    writeln!(
        out,
        "<p>Pictures of {}x{} pixels without antialiasing; the difference is shown four times as large.</p>\n<table>\n\
         <tr><th>scene<th>POV-Ray<th>strahl<th>difference<th>mean<th>RMS<th>POV-Ray s<th>strahl s<th>first message</tr>",
        size.0, size.1
    )?;
    let mut order: Vec<(usize, &Row)> = rows.iter().enumerate().collect();
    let key = |row: &Row| row.difference.map_or(-1.0, |(mean, _)| mean);
    order.sort_by(|(_, a), (_, b)| key(b).total_cmp(&key(a)));
    for (index, row) in order {
        write_row(&mut out, index, row)?;
    }
    out.push_str("</table></html>\n");
    Ok(std::fs::write(file, out)?)
}

fn write_row(out: &mut String, index: usize, row: &Row) -> Result<()> {
    let image = |there: bool, who: &str| match there {
        true => format!("<img loading=\"lazy\" src=\"images/{index:04}-{who}.png\" alt=\"{who}\">"),
        false => String::new(),
    };
    let (mean, rms) = match row.difference {
        Some((mean, rms)) => (format!("{mean:.2}"), format!("{rms:.2}")),
        None => (String::new(), String::new()),
    };
    let class = if is_close(row) { "close" } else { "far" };
    let marks = match row.marks.is_empty() {
        true => String::new(),
        false => format!("<br><i>{}</i>", row.marks.join(", ")),
    };
    let state = match (row.strahl.rendered, row.parses) {
        (true, _) => "",
        (false, true) => "parses only: ",
        (false, false) => "",
    };
    let theirs = match row.povray.reason.as_str() {
        "" => String::new(),
        reason => format!("<br>POV-Ray: {}", escaped(reason)),
    };
    writeln!(
        out,
        "<tr><td>{}{marks}<td>{}<td>{}<td>{}<td class=\"n {class}\">{mean}<td class=\"n\">{rms}\
         <td class=\"n\">{:.2}<td class=\"n\">{:.2}<td>{state}{}{theirs}</tr>",
        escaped(&row.scene),
        image(row.povray.rendered, "povray"),
        image(row.strahl.rendered, "strahl"),
        image(row.difference.is_some(), "difference"),
        row.povray.seconds,
        row.strahl.seconds,
        escaped(&row.strahl.reason),
    )?;
    Ok(())
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
