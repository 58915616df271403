//! Text with lines that fit into a terminal.

use std::fmt::Write;

/// The width of lines in columns, if they can be broken.
const WIDTH: usize = 100;

/// Text under construction.
#[derive(Debug, Default)]
pub(crate) struct Page(String);

impl Page {
    /// Adds a line with an indentation in columns. If it is too long, it is broken before ` · ` and ` = ` or after `, `; the
    /// continuation is indented by four more columns.
    pub(crate) fn line(&mut self, indent: usize, text: &str) {
        let mut rest = text;
        let mut column = indent;
        let mut first = true;
        while !rest.is_empty() {
            let width = WIDTH.saturating_sub(column);
            let cut = match rest.char_indices().nth(width) {
                None => rest.len(),
                Some((end, _)) => last_break(rest, end).unwrap_or(rest.len()),
            };
            let (head, tail) = rest.split_at(cut);
            // Writing to a string cannot fail.
            let _ = writeln!(self.0, "{:column$}{}", "", head.trim_end());
            rest = tail.trim_start();
            if first {
                column += 4;
                first = false;
            }
        }
        if first {
            self.0.push('\n');
        }
    }

    /// Adds a row of a table, which is not broken.
    pub(crate) fn row(&mut self, text: &str) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.0, "{}", text.trim_end());
    }

    /// Adds an empty line.
    pub(crate) fn gap(&mut self) {
        self.0.push('\n');
    }

    /// The text, without the end of the last line.
    pub(crate) fn finish(mut self) -> String {
        while self.0.ends_with('\n') {
            self.0.pop();
        }
        self.0
    }
}

/// The last place before byte `end` where a line may be broken: before an operator of a formula or between the items of a list,
/// but not within parentheses.
fn last_break(text: &str, end: usize) -> Option<usize> {
    let (mut depth, mut best) = (0usize, None);
    // Before a parenthesis, if there is no better place.
    let mut parenthesis = None;
    let (mut before, mut operator) = (' ', false);
    // Whether there is a formula, and not only the name of a value, before the equals sign.
    let mut formula = false;
    for (at, c) in text.char_indices() {
        if at > end {
            break;
        }
        match c {
            '(' => {
                if depth == 0 && before == ' ' && !operator && at > 0 {
                    parenthesis = Some(at);
                }
                depth += 1;
            }
            ')' => depth = depth.saturating_sub(1),
            '·' | '=' | '+' if depth == 0 && before == ' ' && at > 0 => {
                if formula || c != '=' {
                    best = Some(at);
                }
                formula = true;
            }
            ' ' if depth == 0 && matches!(before, ',' | ';' | ':') => {
                best = Some(at);
                formula = false;
            }
            _ => {}
        }
        if c != ' ' {
            operator = matches!(c, '·' | '=' | '+');
        }
        before = c;
    }
    best.or(parenthesis)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_broken_at_operators_only() {
        let mut page = Page::default();
        let triple = "(0.123456, 0.123456, 0.123456)";
        page.line(
            4,
            &format!("kd · L · (n·l) = {triple} · {triple} · 0.123456 = {triple}"),
        );
        page.line(2, "short");
        page.line(2, &format!("hits {}, at t = 12", "x".repeat(86)));
        page.line(2, &format!("is blocked by sphere ({}:1:1)", "x".repeat(80)));
        page.line(0, &"x".repeat(120));
        let text = page.finish();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 8, "{text}");
        assert_eq!(lines[5], "  is blocked by sphere");
        assert_eq!(lines[4], "      at t = 12");
        assert_eq!(lines[1], format!("        = {triple}"));
        assert_eq!(lines[2], "  short");
        assert!(lines[0].chars().count() <= WIDTH && lines[0].ends_with("· 0.123456"));
    }
}
