//! Stereolithography triangles, ASCII and binary.
//!
//! A file is binary if its size is what the number of triangles in it demands, whatever it begins with (many binary files begin
//! with `solid`); of the others, those that begin with `solid` and are text are ASCII. Corners with the same coordinates are
//! welded to one vertex, exactly: no tolerance joins what is merely close. The normals in the file are ignored in favour of
//! the corners' order (they agree, or the file is wrong), so is the attribute that some programs keep colours in.
//! Every `solid` of an ASCII file becomes a mesh of its own name.
//!
//! Of ASCII files more is read than there should be: lines of comments (`#`), `color` lines between facets, `end loop` for
//! `endloop`, a Ctrl-Z at the end; and the last `endsolid` may be missing.

use crate::input::Input;
use crate::input::report::{Fallible, Report};
use crate::input::text::{Text, Word, Words, parse_f32};
use crate::mesh::{object_name, polygon_normal};
use hashbrown::HashMap;
use std::sync::Arc;
use strahl_geometry::{MeshData, TriangleMesh};
use strahl_math::DVec3;
use strahl_scene::{Diagnostic, Object, Scene, Severity, Span};

/// Bytes before the triangles, and of a triangle.
const HEADER: usize = 84;
const TRIANGLE: usize = 50;

/// Reads the triangles; errors and warnings go to the report.
pub(crate) fn read(input: &Input<'_>, report: &mut Report) -> Scene {
    let mut scene = Scene::default();
    let expected = input.bytes[..HEADER.min(input.bytes.len())]
        .last_chunk::<4>()
        .filter(|_| input.bytes.len() >= HEADER);
    let expected = expected
        .map(|count| HEADER as u64 + TRIANGLE as u64 * u64::from(u32::from_le_bytes(*count)));
    let size = input.bytes.len() as u64;
    let (text, zeros) = without_padding(input.bytes);
    let text = Text::new(text, input.name, scene.sources.add(input.name));
    let begins_with_solid = begins_with_solid(text.bytes);
    let is_ascii = expected != Some(size) && begins_with_solid && !text.is_binary();
    match expected {
        _ if is_ascii => {
            if zeros > 0 {
                report.warning(|| {
                    Diagnostic::warning(format!("`{}`: {zeros} zero bytes behind the text are ignored", input.name))
                });
            }
            ascii(text, &mut scene, report);
        }
        Some(expected) if size >= expected => {
            if size > expected {
                report.warning(|| {
                    let extra = size - expected;
                    Diagnostic::warning(format!("`{}`: {extra} bytes behind the last triangle are ignored", input.name))
                });
            }
            // Not more than the file has, so it fits.
            binary(input, &input.bytes[HEADER..expected as usize], &mut scene, report);
        }
        Some(_) if !begins_with_solid && !text.is_binary() => report.error(|| {
            Diagnostic::error(format!(
                "`{}` is not an STL file: it is a text whose first word is not `solid`",
                input.name
            ))
        }),
        Some(expected) => report.error(|| {
            let promised = (expected - HEADER as u64) / TRIANGLE as u64;
            let there = (size - HEADER as u64) / TRIANGLE as u64;
            let not_text = if begins_with_solid {
                "it begins with `solid` but is not a text, and as a binary file "
            } else {
                ""
            };
            Diagnostic::error(format!(
                "`{}` is not an STL file, or it is cut off: {not_text}its header says {promised} triangles, but it has room for {there}",
                input.name
            ))
        }),
        None => report.error(|| {
            Diagnostic::error(format!(
                "`{}` is not an STL file: it is no text that begins with `solid`, and is too short for a binary file ({size} bytes)",
                input.name
            ))
        }),
    }
    scene
}

/// Without what some programs fill the last block of a text with: zeros, whose number is returned, and the Ctrl-Z that ends
/// texts of old systems, with the blanks around it.
fn without_padding(bytes: &[u8]) -> (&[u8], usize) {
    let is_zero = |byte: &&u8| **byte == 0;
    let zeros = bytes.iter().rev().take_while(is_zero).count();
    let text = &bytes[..bytes.len() - zeros];
    let is_end = |byte: &&u8| **byte == 0x1a || byte.is_ascii_whitespace();
    let ends = text.iter().rev().take_while(is_end).count();
    (&text[..text.len() - ends], zeros)
}

/// Whether the first word that is not in a comment begins with `solid`.
fn begins_with_solid(bytes: &[u8]) -> bool {
    let mut rest = bytes.trim_ascii_start();
    while rest.starts_with(b"#") {
        let end = rest.iter().position(|b| matches!(b, b'\n' | b'\r'));
        rest = rest[end.unwrap_or(rest.len())..].trim_ascii_start();
    }
    rest.get(..5)
        .is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
}

/// Triangles with welded corners.
#[derive(Debug, Default)]
struct Weld {
    known: HashMap<[u32; 3], u32>,
    data: MeshData,
}

impl Weld {
    /// Adds a triangle; says whether it has an area.
    fn add(&mut self, corners: [[f32; 3]; 3]) -> bool {
        if polygon_normal(&corners.map(|p| DVec3::from_array(p.map(f64::from)))).is_none() {
            return false;
        }
        let triangle = corners.map(|p| {
            let next = self.data.positions.len() as u32;
            // -0 + 0 is +0: the two zeros are one value.
            *self
                .known
                .entry(p.map(|x| (x + 0.0).to_bits()))
                .or_insert_with(|| {
                    self.data.positions.push(p);
                    next
                })
        });
        self.data.indices.push(triangle);
        true
    }

    fn finish(self, name: Arc<str>, span: Span, scene: &mut Scene, report: &mut Report) {
        if self.data.indices.is_empty() {
            return;
        }
        match TriangleMesh::try_new(self.data) {
            Ok(mesh) => scene.objects.0.push(Object {
                name: Some(name),
                span,
                ..Arc::new(mesh).into()
            }),
            Err(problem) => {
                report.error(|| Diagnostic::error(format!("`{name}`: {problem}")).at(span))
            }
        }
    }
}

fn binary(input: &Input<'_>, triangles: &[u8], scene: &mut Scene, report: &mut Report) {
    let name = input.name;
    let mut weld = Weld::default();
    weld.data.indices.reserve_exact(triangles.len() / TRIANGLE);
    for (number, bytes) in triangles.as_chunks::<TRIANGLE>().0.iter().enumerate() {
        let number = number + 1;
        // The normal comes first, then three corners of three numbers.
        let mut numbers = bytes
            .as_chunks::<4>()
            .0
            .iter()
            .skip(3)
            .map(|x| f32::from_le_bytes(*x));
        let corners = [[0; 3]; 3].map(|corner| corner.map(|_| numbers.next().unwrap_or(f32::NAN)));
        if !corners.as_flattened().iter().all(|x| x.is_finite()) {
            report.error(|| {
                let problem = format!(
                    "`{name}`: triangle {number} has a coordinate that is not a finite number"
                );
                Diagnostic::error(problem)
            });
            if report.is_hopeless() {
                return;
            }
        } else if !weld.add(corners) {
            report.count("degenerate", || {
                Diagnostic::warning(format!(
                    "`{name}`: triangle {number} has no area and is left out"
                ))
            });
        }
    }
    weld.finish(object_name(name), Span::NONE, scene, report);
    nothing(input.name, scene, report);
}

fn nothing(name: &str, scene: &Scene, report: &mut Report) {
    if scene.objects.0.is_empty() && !report.has_errors() {
        report.error(|| Diagnostic::error(format!("`{name}` has no triangles")));
    }
}

fn ascii(text: Text<'_>, scene: &mut Scene, report: &mut Report) {
    let mut reader = Ascii {
        text,
        words: text.words(0, 1),
        weld: Weld::default(),
    };
    while let Some(word) = reader.words.next() {
        if !is(&word, "solid") {
            report.error(|| wrong(text, &word, "`solid`"));
            return;
        }
        let name = String::from_utf8_lossy(reader.words.skip_line().trim_ascii()).into_owned();
        let name = if name.is_empty() {
            object_name(text.name)
        } else {
            Arc::from(name)
        };
        if let Err(problem) = reader.solid(report) {
            report.error(|| *problem);
            return;
        }
        std::mem::take(&mut reader.weld).finish(
            name,
            Span::line(text.file, word.line),
            scene,
            report,
        );
    }
    nothing(text.name, scene, report);
}

struct Ascii<'a> {
    text: Text<'a>,
    words: Words<'a>,
    weld: Weld,
}

impl<'a> Ascii<'a> {
    /// Reads facets until `endsolid`.
    fn solid(&mut self, report: &mut Report) -> Fallible<()> {
        loop {
            let Some(word) = self.words.next() else {
                let problem = self.words.expected("`facet` or `endsolid`");
                if self.weld.data.indices.is_empty() {
                    return Err(Box::new(problem));
                }
                // All facets are complete.
                report.warning(|| Diagnostic {
                    severity: Severity::Warning,
                    message: "`endsolid` is missing at the end of the file".into(),
                    ..problem
                });
                return Ok(());
            };
            if self.ends(&word, "solid") {
                self.words.skip_line();
                return Ok(());
            }
            if is(&word, "color") {
                self.words.skip_line();
                let text = self.text;
                report.count("color", || {
                    text.at(&word, Diagnostic::warning("colours are ignored"))
                });
                continue;
            }
            if !is(&word, "facet") {
                return Err(Box::new(wrong(self.text, &word, "`facet` or `endsolid`")));
            }
            // The normal may be anything, even `nan`.
            self.words.skip_line();
            self.expect("outer")?;
            self.expect("loop")?;
            let mut corners = [[0.0; 3]; 3];
            for corner in &mut corners {
                self.expect("vertex")?;
                for coordinate in corner {
                    *coordinate = self.number()?;
                }
            }
            self.expect_end("loop")?;
            self.expect_end("facet")?;
            if self.weld.add(corners) {
                self.weld
                    .data
                    .face_lines
                    .get_or_insert_default()
                    .push(word.line);
            } else {
                let text = self.text;
                report.count("degenerate", || {
                    text.at(
                        &word,
                        Diagnostic::warning("the triangle has no area and is left out"),
                    )
                });
            }
        }
    }

    /// Whether a word is `endloop`, `endfacet` or `endsolid`, which some programs write as two words: the second is taken, too.
    fn ends(&mut self, word: &Word<'_>, what: &str) -> bool {
        let glued = word.bytes.len() == 3 + what.len()
            && word.bytes[..3].eq_ignore_ascii_case(b"end")
            && word.bytes[3..].eq_ignore_ascii_case(what.as_bytes());
        let apart = !glued
            && is(word, "end")
            && self
                .words
                .peek_in_line()
                .is_some_and(|next| is(&next, what));
        if apart {
            self.words.next();
        }
        glued || apart
    }

    fn expect_end(&mut self, of: &str) -> Fallible<()> {
        let what = format!("`end{of}`");
        match self.words.next() {
            Some(word) if self.ends(&word, of) => Ok(()),
            Some(word) => Err(Box::new(wrong(self.text, &word, &what))),
            None => Err(Box::new(self.words.expected(&what))),
        }
    }

    fn expect(&mut self, keyword: &str) -> Fallible<()> {
        let what = format!("`{keyword}`");
        match self.words.next() {
            Some(word) if is(&word, keyword) => Ok(()),
            Some(word) => Err(Box::new(wrong(self.text, &word, &what))),
            None => Err(Box::new(self.words.expected(&what))),
        }
    }

    fn number(&mut self) -> Fallible<f32> {
        let what = "a coordinate";
        let word: Word<'a> = self
            .words
            .next()
            .ok_or_else(|| Box::new(self.words.expected(what)))?;
        parse_f32(word.bytes).map_err(|e| Box::new(self.text.at(&word, e.describe(&word, what))))
    }
}

fn is(word: &Word<'_>, keyword: &str) -> bool {
    word.bytes.eq_ignore_ascii_case(keyword.as_bytes())
}

fn wrong(text: Text<'_>, word: &Word<'_>, expected: &str) -> Diagnostic {
    text.at(
        word,
        Diagnostic::error(format!("expected {expected}, found `{}`", word.shown())),
    )
}

#[cfg(test)]
mod tests;
