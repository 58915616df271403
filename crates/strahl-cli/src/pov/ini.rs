//! POV-Ray's .ini files: `Key=Value` lines, lines of switches, `[sections]`, and comments after `;` or `#`.

use super::settings::Settings;
use super::switches;
use std::path::{Path, PathBuf};

/// The file and the section in a word: `a.ini`, `a.ini[low]`, `a[low]`.
pub(super) fn named(word: &str) -> Option<(PathBuf, Option<String>)> {
    let is_ini = |file: &str| {
        let ending = Path::new(file).extension();
        ending.is_some_and(|e| e.eq_ignore_ascii_case("ini"))
    };
    if let Some((file, section)) = word.strip_suffix(']').and_then(|w| w.split_once('[')) {
        let mut path = PathBuf::from(file);
        if !is_ini(file) {
            path.set_extension("ini");
        }
        return (!file.is_empty()).then(|| (path, Some(section.trim().to_owned())));
    }
    is_ini(word).then(|| (PathBuf::from(word), None))
}

/// The .ini file that a word without an extension means, if there is no other file of this name: `povray rerun`.
pub(super) fn without_ending(word: &str) -> Option<(PathBuf, Option<String>)> {
    let path = Path::new(word);
    if word.is_empty() || word.starts_with(['+', '-']) || path.extension().is_some() {
        return None;
    }
    let file = path.with_extension("ini");
    (!path.exists() && file.is_file()).then_some((file, None))
}

/// Applies the .ini file that `Include_Ini` or a line of another .ini file names. It may also be in that file's folder.
pub(super) fn include(name: &str, settings: &mut Settings) -> Result<(), String> {
    let found = named(name).or_else(|| without_ending(name));
    let (file, section) = found.unwrap_or_else(|| (PathBuf::from(name), None));
    let near = settings.beside().map(|folder| folder.join(&file));
    let near = near.filter(|near| !file.is_file() && near.is_file());
    apply(&near.unwrap_or(file), section.as_deref(), settings)
}

/// Applies a file's settings: those before the first section, then those of the section.
pub(super) fn apply(
    file: &Path,
    section: Option<&str>,
    settings: &mut Settings,
) -> Result<(), String> {
    let shown = file.display();
    let bytes = std::fs::read(file).map_err(|e| format!("cannot read `{shown}`: {e}"))?;
    let text = String::from_utf8_lossy(&bytes);
    let is_this = |open: &PathBuf| open.canonicalize().ok() == file.canonicalize().ok();
    if settings.open.iter().any(is_this) {
        return Err(format!(
            "`{shown}` includes itself, directly or by another file"
        ));
    }
    settings.open.push(file.to_owned());
    let sections = apply_text(&text, &shown.to_string(), section, settings)?;
    settings.open.pop();
    if let Some(s) = section.filter(|s| !sections.iter().any(|l| l.eq_ignore_ascii_case(s))) {
        let has = match sections.is_empty() {
            true => "no sections".to_owned(),
            false => format!("the sections {}", sections.join(", ")),
        };
        let note = format!("`{shown}` has no section [{s}], which is ignored; it has {has}");
        settings.notes.push(note);
    }
    Ok(())
}

/// Applies the lines of a file; returns the names of all its sections.
fn apply_text(
    text: &str,
    shown: &str,
    section: Option<&str>,
    settings: &mut Settings,
) -> Result<Vec<String>, String> {
    let mut sections = vec![];
    let mut applies = true;
    for (number, line) in text.lines().enumerate() {
        let line = without_comment(line).trim();
        if let Some(label) = line.strip_prefix('[').and_then(|l| l.strip_suffix(']')) {
            let label = label.trim();
            applies = section.is_some_and(|s| s.eq_ignore_ascii_case(label));
            sections.push(label.to_owned());
        } else if applies && !line.is_empty() {
            apply_line(line, settings).map_err(|e| format!("{shown}:{}: {e}", number + 1))?;
        }
    }
    Ok(sections)
}

fn apply_line(line: &str, settings: &mut Settings) -> Result<(), String> {
    if line.starts_with(['+', '-']) {
        for word in words(line) {
            switches::apply(&word, settings)?;
        }
        return Ok(());
    }
    match line.split_once('=') {
        Some((key, value)) => settings.set(key.trim(), unquoted(value.trim())),
        None => apply_name(unquoted(line), settings),
    }
}

/// Applies a line that holds only the name of an .ini file or of a scene.
fn apply_name(name: &str, settings: &mut Settings) -> Result<(), String> {
    if named(name).is_some() {
        return include(name, settings);
    }
    let ending = Path::new(name).extension();
    let is_scene = ending.is_some_and(|e| e.eq_ignore_ascii_case("pov"));
    if is_scene || Path::new(&settings.complete(name)).is_file() {
        return settings.set("Input_File_Name", name);
    }
    Err(format!(
        "`{name}` is neither `Key=Value`, switches such as `+W640 +H480`, nor the name of an .ini file or a scene"
    ))
}

/// The line before a semicolon or `#` outside of quotation marks.
fn without_comment(line: &str) -> &str {
    let mut quoted = false;
    for (at, c) in line.char_indices() {
        match c {
            '"' => quoted = !quoted,
            ';' | '#' if !quoted => return &line[..at],
            _ => {}
        }
    }
    line
}

/// The words of a line. Quotation marks keep spaces within a word and are removed.
fn words(line: &str) -> Vec<String> {
    let (mut out, mut word, mut quoted) = (vec![], String::new(), false);
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            c if c.is_whitespace() && !quoted => out.push(std::mem::take(&mut word)),
            c => word.push(c),
        }
    }
    out.push(word);
    out.retain(|w| !w.is_empty());
    out
}

/// The value without the quotation marks around it.
pub(super) fn unquoted(value: &str) -> &str {
    let inner = |quote| value.strip_prefix(quote)?.strip_suffix(quote);
    inner('"').or_else(|| inner('\'')).unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pov::settings::Own;

    const TEXT: &str = "; a comment\n # Width=20\n#\nWidth = 40 ; another\n+H30 -D +L\"my inc\"\n[Low]\nwidth=4\n[Really High]\n\
                        Height=90\nOutput_File_Name=\"a;b#.png\" # a comment\nInput_File_Name=\"scene.pov\"\r\n";

    fn words_of(section: Option<&str>) -> Result<Vec<String>, String> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.ini");
        std::fs::write(&file, TEXT).unwrap();
        let mut settings = Settings::default();
        apply(&file, section, &mut settings)?;
        let mut words = settings.words(&Own::default())?;
        words.push(settings.input.clone());
        words.retain(|w| !w.is_empty());
        Ok(words)
    }

    #[test]
    fn a_section_adds_to_what_stands_before_the_first() {
        let general = [
            "--size",
            "40x30",
            "--sampling",
            "center",
            "--library-path",
            "my inc",
        ];
        assert_eq!(words_of(None).unwrap(), general);
        assert_eq!(words_of(Some("low")).unwrap()[1], "4x30");
        let high = words_of(Some("really high")).unwrap();
        assert_eq!(high[1], "40x90");
        assert_eq!(high[6..], ["--output", "a;b#.png", "scene.pov"]);
        assert_eq!(words_of(Some("none")).unwrap(), general);
    }

    #[test]
    fn files_are_included() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text);
        write("q.ini", "Width=8\n[x]\nHeight=9\n").unwrap();
        write("loop.ini", "Include_Ini=./loop.ini\n").unwrap();
        let size_of = |text: &str| {
            write("a.ini", text).unwrap();
            let mut settings = Settings::default();
            apply(&folder.path().join("a.ini"), None, &mut settings)?;
            Ok(settings.words(&Own::default())?[1].clone())
        };
        for (text, size) in [
            ("Include_Ini=q.ini", "8x600"),
            ("Include_Ini=\"q[x]\"\nWidth=5", "5x9"),
            ("q.ini[x]\na.pov", "8x9"),
            ("\"q.ini\" ; the size\nHeight=3", "8x3"),
        ] {
            assert_eq!(size_of(text), Ok(size.to_owned()), "{text}");
        }
        for (text, part) in [
            ("loop.ini", "includes itself"),
            ("Include_Ini=none.ini", "a.ini:1: Include_Ini: cannot read"),
            ("nothing", "`nothing` is neither"),
        ] {
            let error: String = size_of(text).unwrap_err();
            assert!(error.contains(part), "{text}: {error}");
        }
    }

    #[test]
    fn names_of_files_and_sections() {
        let is = |word: &str, file: &str, section: Option<&str>| {
            assert_eq!(
                named(word),
                Some((file.into(), section.map(str::to_owned))),
                "{word}"
            );
        };
        is("a/b.ini", "a/b.ini", None);
        is("B.INI", "B.INI", None);
        is("b.ini[Really High]", "b.ini", Some("Really High"));
        is("b[low]", "b.ini", Some("low"));
        for other in ["b.pov", "[x]", "ini"] {
            assert_eq!(named(other), None, "{other}");
        }
    }
}
