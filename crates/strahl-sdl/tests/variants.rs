//! The scenes of the gallery, rewritten without changing their meaning: they must give the same scene.

use std::path::{Path, PathBuf};
use strahl_sdl::{MemoryHost, Options, Source, parse};

/// The description of a scene without places and names, or its first error.
fn description(host: &mut MemoryHost, text: impl Into<Vec<u8>>) -> Result<String, String> {
    let parsed = parse(Source::new("test.pov", text), &Options::default(), host);
    let Some(mut scene) = parsed.scene else {
        let first = parsed.diagnostics.iter().find(|d| d.is_error());
        return Err(first.map_or(String::new(), ToString::to_string));
    };
    scene.sources = Default::default();
    let text = format!("{scene:?}");
    let text = without(&text, "span: Span {", '}');
    let text = without(&text, "name: Some(\"", ')');
    Ok(text.replace("name: None", ""))
}

/// A text without the parts that begin with `begin` and end with the character `end`.
fn without(text: &str, begin: &str, end: char) -> String {
    let mut pieces = text.split(begin);
    let mut out = pieces.next().unwrap_or("").to_owned();
    for piece in pieces {
        out.push_str(piece.split_once(end).map_or("", |(_, rest)| rest));
    }
    out
}

/// The words, numbers, strings and signs of a scene, without comments; a `#` with its word is one token.
fn tokens(text: &str) -> Vec<&str> {
    let bytes = text.as_bytes();
    let is_name = |b: u8| b.is_ascii_alphanumeric() || b == b'_';
    let until = |from: usize, end: &str| {
        text[from..]
            .find(end)
            .map_or(text.len(), |at| from + at + end.len())
    };
    let mut out = vec![];
    let mut at = 0;
    while at < bytes.len() {
        let next = bytes.get(at + 1).copied().unwrap_or(0);
        let run = |from: usize| from + bytes[from..].iter().take_while(|b| is_name(**b)).count();
        let end = match bytes[at] {
            b if b.is_ascii_whitespace() => {
                at += 1;
                continue;
            }
            b'/' if next == b'/' => {
                at = until(at, "\n");
                continue;
            }
            b'/' if next == b'*' => {
                at = until(at, "*/");
                continue;
            }
            b'"' => until(at + 1, "\""),
            b'#' => run(at + 1),
            b if b.is_ascii_digit() || (b == b'.' && next.is_ascii_digit()) => {
                let mut end = at;
                while bytes.get(end).is_some_and(|b| {
                    is_name(*b)
                        || *b == b'.'
                        || (matches!(*b, b'+' | b'-')
                            && matches!(bytes[end - 1], b'e' | b'E')
                            && end > at)
                }) {
                    end += 1;
                }
                end
            }
            b if is_name(b) => run(at),
            b'<' | b'>' | b'!' if next == b'=' => at + 2,
            b if b.is_ascii() => at + 1,
            _ => at + text[at..].chars().next().map_or(1, char::len_utf8),
        };
        out.push(&text[at..end]);
        at = end;
    }
    out
}

/// The tokens with other blanks and comments between them.
fn spaced(tokens: &[&str]) -> String {
    let between = [
        " ",
        "\n",
        "\t",
        " /* { \" /* } */ */ ",
        " // \" { #end\n",
        "\r\n  ",
        "  ",
    ];
    let mut out = String::from("/* first */");
    for (number, token) in tokens.iter().enumerate() {
        out.push_str(between[(number * 5 + number / 7) % between.len()]);
        out.push_str(token);
    }
    out
}

/// The tokens with as few lines and blanks as possible.
fn dense(tokens: &[&str]) -> String {
    let mut out = String::new();
    for token in tokens {
        let joins = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '#' | '"');
        if out.ends_with(joins) && token.starts_with(joins) {
            out.push(' ');
        }
        out.push_str(token);
    }
    out
}

const OBJECTS: &[&str] = &[
    "sphere",
    "box",
    "union",
    "difference",
    "intersection",
    "merge",
    "object",
    "cone",
    "cylinder",
    "torus",
    "plane",
    "blob",
    "prism",
    "lathe",
    "mesh",
    "mesh2",
    "isosurface",
    "height_field",
    "disc",
    "polygon",
    "sor",
    "superellipsoid",
    "sphere_sweep",
    "parametric",
    "bicubic_patch",
    "nurbs",
    "brep",
    "terrain",
    "mandelbulb",
    "menger",
    "subdivision",
    "ovus",
    "lemon",
    "julia_fractal",
    "quadric",
    "poly",
    "cubic",
    "quartic",
    "polynomial",
    "text",
    "triangle",
];

/// Puts `before` and `after` around each object that is a statement; `N` in them is replaced by its number.
fn around(tokens: &[&str], before: &str, after: &str) -> String {
    let mut out = String::new();
    let (mut open, mut count, mut inside) = (0usize, 0, false);
    for (number, token) in tokens.iter().enumerate() {
        let previous = number.checked_sub(1).map_or("", |n| tokens[n]);
        let opens = OBJECTS.contains(token) && tokens.get(number + 1) == Some(&"{");
        if open == 0 && opens && previous != "=" {
            count += 1;
            inside = true;
            out.push_str(&before.replace('N', &count.to_string()));
        }
        out.push_str(token);
        out.push(' ');
        match *token {
            "{" | "(" => open += 1,
            "}" | ")" => open = open.saturating_sub(1),
            _ => {}
        }
        if inside && open == 0 && *token == "}" {
            inside = false;
            out.push_str(&after.replace('N', &count.to_string()));
        }
    }
    out
}

fn files(folder: &Path, out: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).expect("the gallery");
    for entry in entries {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, out);
        } else {
            out.push(path);
        }
    }
    out.sort();
}

#[test]
fn scenes_written_in_other_ways_are_the_same() {
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/gallery");
    let mut all = vec![];
    files(&gallery, &mut all);
    let is_scene = |path: &PathBuf| path.extension().is_some_and(|e| e == "pov");
    let scenes: Vec<PathBuf> = all.iter().filter(|p| is_scene(p)).cloned().collect();
    let host = || {
        all.iter()
            .filter(|p| !is_scene(p))
            .fold(MemoryHost::new(), |host, path| {
                let bytes = std::fs::read(path).expect("readable");
                let name = path
                    .file_name()
                    .expect("a name")
                    .to_string_lossy()
                    .into_owned();
                host.with_file(&format!("../{name}"), bytes.clone())
                    .with_file(&name, bytes)
            })
    };
    let results = crate::common::each(&scenes, |path| {
        let text = std::fs::read_to_string(path).expect("UTF-8");
        let mut host = host();
        let Ok(expected) = description(&mut host, text.clone()) else {
            // Some scenes have errors here, for example a missing font.
            return (0, vec![]);
        };
        let tokens = tokens(&text);
        let wide = |bytes: fn(u16) -> [u8; 2]| {
            let units = std::iter::once(0xfeff).chain(text.encode_utf16());
            units.flat_map(bytes).collect::<Vec<u8>>()
        };
        let variants: Vec<(&str, Vec<u8>)> = vec![
            ("CRLF", text.replace('\n', "\r\n").into()),
            ("CR", text.replace('\n', "\r").into()),
            ("UTF-16 LE", wide(u16::to_le_bytes)),
            ("UTF-16 BE", wide(u16::to_be_bytes)),
            ("spaced", spaced(&tokens).into()),
            ("dense", dense(&tokens).into()),
            ("wrapped", around(&tokens, "object { ", "} ").into()),
            (
                "named",
                around(&tokens, "#declare Variant_N = ", "; object { Variant_N } ").into(),
            ),
            (
                "bare",
                around(&tokens, "#declare Variant_N = ", " Variant_N ").into(),
            ),
            (
                "macro",
                around(&tokens, "#macro Variant_N() ", " #end Variant_N() ").into(),
            ),
            (
                "macro of a name",
                around(
                    &tokens,
                    "#macro Variant_N() #local V = ",
                    "; V #end object { Variant_N() } ",
                )
                .into(),
            ),
            (
                "inline include",
                text.replace(
                    "#include \"../gallery.inc\"",
                    &std::fs::read_to_string(gallery.join("gallery.inc")).expect("UTF-8"),
                )
                .into(),
            ),
        ];
        let failed = variants.into_iter().filter_map(|(kind, bytes)| {
            let why = match description(&mut host, bytes) {
                Ok(found) if found == expected => return None,
                Ok(found) => {
                    let same = found
                        .bytes()
                        .zip(expected.bytes())
                        .take_while(|(a, b)| a == b)
                        .count();
                    let part = |text: &str| {
                        text.chars()
                            .skip(same.saturating_sub(60))
                            .take(160)
                            .collect::<String>()
                    };
                    format!("\n  {}\n  {}", part(&found), part(&expected))
                }
                Err(error) => error,
            };
            Some(format!("{}, {kind}: {why}", path.display()))
        });
        (1, failed.collect::<Vec<_>>())
    });
    let read: usize = results.iter().map(|(read, _)| read).sum();
    let failed: Vec<&String> = results.iter().flat_map(|(_, failed)| failed).collect();
    assert!(read > 100, "only {read} scenes of the gallery are read");
    assert!(
        failed.is_empty(),
        "{} differ, such as\n{}",
        failed.len(),
        failed
            .iter()
            .take(8)
            .map(|f| f.as_str())
            .collect::<Vec<_>>()
            .join("\n")
    );
}
