use super::faces::{Counts, RawCorner};
use crate::input::ahead::{Piece, Statements, read_statements};
use crate::input::report::Fallible;
use crate::input::text::{NumberError, Text, Word, Words, parse_f64};
use std::sync::Arc;
use strahl_math::{DVec2, DVec3};
use strahl_scene::Diagnostic;

/// The content of statements, one after the other.
#[derive(Debug, Default)]
pub(super) struct Block {
    /// The byte at which the first of them begins.
    pub(super) start: usize,
    pub(super) positions: Vec<DVec3>,
    /// The weights of positions that have one other than 1, by their places in the list.
    pub(super) weights: Vec<(u32, f64)>,
    pub(super) uvs: Vec<DVec2>,
    pub(super) normals: Vec<DVec3>,
    /// Of all faces.
    pub(super) corners: Vec<RawCorner>,
    pub(super) steps: Vec<Step>,
    /// The first position that has a colour.
    pub(super) color: Option<Box<Place>>,
    /// The lengths of the lists at the last face.
    counts: Counts,
}

/// A statement that is not an entry of a list. Nearly all are faces, so faces are small.
#[derive(Debug)]
pub(super) enum Step {
    /// The lengths of the lists for the following faces.
    Counts(Box<Counts>),
    Face(Face),
    Object(Arc<str>),
    Group(Arc<str>),
    Material(Arc<str>),
    Smoothing(u32),
    Libraries(Arc<str>, Box<Place>),
    /// A statement about free-form geometry, which depends on those before it.
    FreeForm(Box<Place>),
    /// With the reason.
    Ignored(&'static str, Box<Place>),
}

/// Where a statement begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) start: usize,
    pub(super) length: usize,
    pub(super) line: u32,
}

impl Place {
    fn of(word: &Word<'_>) -> Box<Self> {
        Box::new(Self {
            start: word.start,
            length: word.bytes.len(),
            line: word.line,
        })
    }
}

/// A face; its corners are behind those of the face before it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// From the start of the block.
    pub(super) start: u32,
    pub(super) line: u32,
    pub(super) corners: u32,
}

impl Block {
    /// A block of statements from this byte on.
    pub(super) fn from(start: usize) -> Self {
        Self {
            start,
            ..Self::default()
        }
    }

    /// Records the lengths of the lists, if they have grown since the last face.
    fn count(&mut self) {
        let counts = Counts {
            positions: self.positions.len(),
            uvs: self.uvs.len(),
            normals: self.normals.len(),
        };
        if self.counts != counts {
            self.counts = counts;
            self.steps.push(Step::Counts(Box::new(counts)));
        }
    }
}

/// Parses statements without knowing those before them.
pub(super) struct Parser<'a> {
    pub(super) text: Text<'a>,
    pub(super) words: Words<'a>,
    /// The result so far.
    pub(super) block: Block,
}

/// Parses the statements that begin before `end`, up to the first erroneous one.
pub(super) fn read_ahead<'a>(
    text: Text<'a>,
    words: Words<'a>,
    end: usize,
) -> Option<Piece<'a, Block>> {
    let mut parser = Parser {
        text,
        words,
        block: Block::default(),
    };
    parser.words.advance();
    parser.block = Block::from(parser.words.position());
    let (start, rest) = read_statements(&mut parser, end)?;
    Some(Piece {
        start,
        content: parser.block,
        rest,
    })
}

impl<'a> Statements<'a> for Parser<'a> {
    fn words(&mut self) -> &mut Words<'a> {
        &mut self.words
    }

    /// It ends with its line.
    fn statement(&mut self) -> Fallible<()> {
        let Some(word) = self.words.next() else {
            return Ok(());
        };
        let done = self.say(&word);
        self.words.skip_line();
        done
    }
}

impl<'a> Parser<'a> {
    /// Parses a statement again.
    pub(super) fn at(text: Text<'a>, place: &Place) -> Self {
        Self {
            text,
            words: text.words(place.start, place.line).with_continuation(),
            block: Block::default(),
        }
    }

    fn say(&mut self, word: &Word<'_>) -> Fallible<()> {
        let step = match word.bytes {
            b"v" => {
                let position = self.point()?;
                self.weight(word);
                self.block.positions.push(position);
                if position.is_finite() {
                    return Ok(());
                }
                ignored(
                    word,
                    "the position of a vertex is not a finite number: no face may use it",
                )
            }
            b"vn" => {
                let normal = self.point()?;
                if normal.is_finite() {
                    self.block.normals.push(normal);
                    return Ok(());
                }
                self.block.normals.push(DVec3::ZERO);
                ignored(word, "a normal that is not finite counts as none")
            }
            b"vt" => {
                let u = self.any_number("u")?;
                let v = if self.words.peek_in_line().is_some() {
                    self.any_number("v")?
                } else {
                    0.0
                };
                let uv = DVec2::new(u, 1.0 - v);
                // Meshes keep them in single precision.
                if uv.as_vec2().is_finite() {
                    self.block.uvs.push(uv);
                    return Ok(());
                }
                self.block.uvs.push(DVec2::ZERO);
                ignored(
                    word,
                    "texture coordinates that are not finite count as none",
                )
            }
            // `fo` is the old name of a face.
            b"f" | b"fo" => {
                let before = self.block.corners.len();
                let face = self.face(word);
                let has_face = matches!(face, Ok(Some(_)));
                if !has_face {
                    self.block.corners.truncate(before);
                }
                match face? {
                    Some(face) => {
                        self.block.count();
                        Step::Face(face)
                    }
                    None => ignored(word, "the face is left out: it has less than three corners"),
                }
            }
            b"o" => Step::Object(self.rest()),
            b"g" => Step::Group(self.rest()),
            b"usemtl" => Step::Material(self.rest()),
            b"s" => self.smoothing_group(word),
            b"mtllib" => Step::Libraries(self.rest(), Place::of(word)),
            b"l" => ignored(word, "lines (`l`) are ignored: they have no surface"),
            b"p" => ignored(word, "points (`p`) are ignored: they have no surface"),
            b"vp" | b"cstype" | b"deg" | b"curv" | b"curv2" | b"surf" | b"parm" | b"trim"
            | b"hole" | b"scrv" | b"sp" | b"end" | b"con" => {
                self.block.count();
                Step::FreeForm(Place::of(word))
            }
            // Of types of surfaces that are not read, and hints for displays.
            b"bmat" | b"step" | b"mg" | b"bevel" | b"c_interp" | b"d_interp" | b"lod"
            | b"ctech" | b"stech" | b"shadow_obj" | b"trace_obj" | b"maplib" | b"usemap" => {
                return Ok(());
            }
            _ => ignored(word, "an unknown statement is ignored"),
        };
        self.block.steps.push(step);
        Ok(())
    }

    /// A face, unless it has less than three corners.
    fn face(&mut self, start: &Word<'_>) -> Fallible<Option<Face>> {
        let before = self.block.corners.len();
        loop {
            // Most corners are plain numbers.
            if let Some(position) = self.words.short_integer_in_line() {
                self.block.corners.push(RawCorner::plain(position));
                continue;
            }
            let Some(mut word) = self.words.next_in_line() else {
                break;
            };
            let corner = RawCorner::parse(word.bytes)
                // Nearly no word ends with a comment, so none is looked for before.
                .or_else(|_| {
                    word = self.words.uncommented(word);
                    RawCorner::parse(word.bytes)
                })
                .map_err(|problem| self.text.at(&word, Diagnostic::error(problem)))?;
            self.block.corners.push(corner);
        }
        let corners = self.block.corners.len() - before;
        if corners < 3 {
            return Ok(None);
        }
        let small = |n: usize| {
            u32::try_from(n).map_err(|_| {
                let problem = "the face, or what is before it, is longer than 4 GiB";
                Box::new(self.text.at(start, Diagnostic::error(problem)))
            })
        };
        Ok(Some(Face {
            start: small(start.start - self.block.start)?,
            line: start.line,
            corners: small(corners)?,
        }))
    }

    fn smoothing_group(&mut self, start: &Word<'_>) -> Step {
        let word = self.words.next_uncommented();
        let group = word.and_then(|word| match word.bytes {
            b"off" => Some(0),
            b"on" => Some(1),
            number => std::str::from_utf8(number).ok()?.parse().ok(),
        });
        match group {
            Some(group) => Step::Smoothing(group),
            None => ignored(
                start,
                "a smoothing group is ignored: it is neither `off` nor a number from 0 to 4294967295",
            ),
        }
    }

    /// The rest of the line as a name.
    fn rest(&mut self) -> Arc<str> {
        let rest = self.words.skip_line();
        Arc::from(String::from_utf8_lossy(rest.trim_ascii()))
    }

    fn point(&mut self) -> Fallible<DVec3> {
        Ok(DVec3::new(
            self.any_number("x")?,
            self.any_number("y")?,
            self.any_number("z")?,
        ))
    }

    /// Takes the weight behind the point of a statement, if a single number follows; more of them are a colour.
    fn weight(&mut self, start: &Word<'_>) {
        if self.words.peek_in_line().is_none() {
            return;
        }
        let mut ahead = self.words.clone();
        let Some(word) = ahead.next_uncommented() else {
            return;
        };
        if ahead.peek_in_line().is_some() {
            self.block.color.get_or_insert_with(|| Place::of(start));
        } else if let Ok(weight) = parse_f64(word.bytes)
            && weight != 1.0
            && let Ok(place) = u32::try_from(self.block.positions.len())
        {
            self.block.weights.push((place, weight));
        }
    }

    /// A number, or this one at the end of the line.
    pub(super) fn optional_number(&mut self, otherwise: f64) -> Fallible<f64> {
        match self.words.peek_in_line() {
            Some(_) => self.number("or the end of the line"),
            None => Ok(otherwise),
        }
    }

    /// A finite number.
    pub(super) fn number(&mut self, what: &str) -> Fallible<f64> {
        if let Some(number) = self.words.short_number_in_line() {
            return Ok(number);
        }
        let word = self.number_word(what)?;
        parse_f64(word.bytes).map_err(|e| self.no_number(&word, e, what))
    }

    /// A number; NaN for one that is not finite.
    fn any_number(&mut self, what: &str) -> Fallible<f64> {
        if let Some(number) = self.words.short_number_in_line() {
            return Ok(number);
        }
        let word = self.number_word(what)?;
        match parse_f64(word.bytes) {
            Ok(number) => Ok(number),
            Err(NumberError::NotFinite) => Ok(f64::NAN),
            Err(e) => Err(self.no_number(&word, e, what)),
        }
    }

    fn number_word(&mut self, what: &str) -> Fallible<Word<'a>> {
        self.words
            .next_uncommented()
            .ok_or_else(|| Box::new(self.words.expected_in_line(&format!("a number ({what})"))))
    }

    #[cold]
    fn no_number(&self, word: &Word<'_>, error: NumberError, what: &str) -> Box<Diagnostic> {
        let problem = error.describe(word, &format!("a number ({what})"));
        Box::new(self.text.at(word, problem))
    }
}

fn ignored(word: &Word<'_>, what: &'static str) -> Step {
    Step::Ignored(what, Place::of(word))
}
