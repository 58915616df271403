use crate::input::Fallible;
use crate::input::text::{Text, Word, Words};
use strahl_scene::Diagnostic;

/// How the body is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Binary { big_endian: bool },
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes in a binary file.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// One number, or a list of numbers, of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub(super) name: String,
    /// The type of the length, for lists.
    pub(super) length: Option<Scalar>,
    pub(super) scalar: Scalar,
}

/// A kind of rows of the body.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
    /// Where the header says so: start, length and line of the count.
    pub(super) place: (usize, usize, u32),
}

impl Element {
    /// The fewest bytes a row takes. In ASCII: a digit and a blank for every number.
    pub(super) fn smallest_row(&self, encoding: Encoding) -> u64 {
        let size = |p: &Property| match encoding {
            Encoding::Ascii => 2,
            Encoding::Binary { .. } => p.length.unwrap_or(p.scalar).size() as u64,
        };
        self.properties.iter().map(size).sum()
    }
}

/// What the header says.
#[derive(Clone, Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Where the body begins, and in which line.
    pub(super) body: usize,
    pub(super) body_line: u32,
}

impl Header {
    pub(super) fn read(text: Text<'_>) -> Fallible<Self> {
        let mut reader = Reader {
            text,
            words: text.words(0, 1).without_comments(),
            elements: vec![],
            encoding: None,
        };
        match reader.words.next() {
            Some(word) if word.bytes == b"ply" && word.start == 0 => {}
            _ => {
                let problem = format!(
                    "`{}` is not a PLY file: it does not begin with `ply`",
                    text.name
                );
                return Err(Box::new(Diagnostic::error(problem)));
            }
        }
        // A binary body may begin with a line feed, so the header's first line tells how its lines end.
        let line_end: &[u8] = match &text.bytes[3..] {
            [b'\r', b'\n', ..] => b"\r\n",
            [b'\r', ..] => b"\r",
            _ => b"\n",
        };
        loop {
            let Some(word) = reader.words.next() else {
                return Err(Box::new(reader.words.expected("`end_header`")));
            };
            match word.bytes {
                b"comment" | b"obj_info" => {
                    reader.words.skip_line();
                }
                b"format" => reader.format()?,
                b"element" => reader.element()?,
                b"property" => reader.property(&word)?,
                b"end_header" => {
                    let Some(encoding) = reader.encoding else {
                        let problem = Diagnostic::error("the header has no `format` line");
                        return Err(Box::new(text.at(&word, problem)));
                    };
                    let end = reader.words.position();
                    let skip = if text.bytes[end..].starts_with(line_end) {
                        line_end.len()
                    } else {
                        0
                    };
                    return Ok(Self {
                        encoding,
                        elements: reader.elements,
                        body: end + skip,
                        body_line: word.line.saturating_add(u32::from(skip > 0)),
                    });
                }
                _ => {
                    let problem =
                        Diagnostic::error(format!("unknown word `{}` in the header", word.shown()));
                    let hint = "the header has lines of format, comment, obj_info, element, property and end_header";
                    return Err(Box::new(text.at(&word, problem).hint(hint)));
                }
            }
        }
    }
}

struct Reader<'a> {
    text: Text<'a>,
    words: Words<'a>,
    elements: Vec<Element>,
    encoding: Option<Encoding>,
}

impl<'a> Reader<'a> {
    fn format(&mut self) -> Fallible<()> {
        let word = self.word("the encoding")?;
        self.encoding = Some(match word.bytes {
            b"ascii" => Encoding::Ascii,
            b"binary_little_endian" => Encoding::Binary { big_endian: false },
            b"binary_big_endian" => Encoding::Binary { big_endian: true },
            _ => {
                let problem = format!("unknown encoding `{}`", word.shown());
                let hint = "the encodings are ascii, binary_little_endian and binary_big_endian";
                return Err(Box::new(
                    self.text.at(&word, Diagnostic::error(problem)).hint(hint),
                ));
            }
        });
        let version = self.word("the version 1.0")?;
        if version.bytes == b"1.0" {
            return Ok(());
        }
        Err(self.fault(
            &version,
            format!("expected the version 1.0, found `{}`", version.shown()),
        ))
    }

    fn element(&mut self) -> Fallible<()> {
        let name = self.word("the name of the element")?;
        let word = self.word("the number of elements")?;
        let parsed = std::str::from_utf8(word.bytes)
            .ok()
            .and_then(|s| s.parse().ok());
        let Some(count) = parsed else {
            return Err(self.fault(
                &word,
                format!("expected the number of elements, found `{}`", word.shown()),
            ));
        };
        let name = String::from_utf8_lossy(name.bytes).into_owned();
        let place = (word.start, word.bytes.len(), word.line);
        self.elements.push(Element {
            name,
            count,
            properties: vec![],
            place,
        });
        Ok(())
    }

    fn property(&mut self, start: &Word<'a>) -> Fallible<()> {
        let mut kind = self.word("the type of the property")?;
        let mut length = None;
        if kind.bytes == b"list" {
            let word = self.word("the type of the list's length")?;
            let scalar = self.scalar(&word)?;
            if !scalar.is_integer() {
                return Err(self.fault(
                    &word,
                    "the length of a list must be of an integer type".into(),
                ));
            }
            length = Some(scalar);
            kind = self.word("the type of the list's entries")?;
        }
        let scalar = self.scalar(&kind)?;
        let name = self.word("the name of the property")?;
        let property = Property {
            name: String::from_utf8_lossy(name.bytes).into_owned(),
            length,
            scalar,
        };
        match self.elements.last_mut() {
            Some(element) => element.properties.push(property),
            None => {
                return Err(self.fault(start, "`property` comes before the first `element`".into()));
            }
        }
        Ok(())
    }

    fn scalar(&self, word: &Word<'_>) -> Fallible<Scalar> {
        Scalar::named(word.bytes).ok_or_else(|| {
            let hint = "the types are char, uchar, short, ushort, int, uint, float, double and int8, uint8, ... float64";
            let problem = Diagnostic::error(format!("unknown type `{}`", word.shown()));
            Box::new(self.text.at(word, problem).hint(hint))
        })
    }

    fn word(&mut self, what: &str) -> Fallible<Word<'a>> {
        self.words
            .next_in_line()
            .ok_or_else(|| Box::new(self.words.expected_in_line(what)))
    }

    fn fault(&self, word: &Word<'_>, problem: String) -> Box<Diagnostic> {
        Box::new(self.text.at(word, Diagnostic::error(problem)))
    }
}
