use std::fmt;

/// Index of a file in the [`SourceMap`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FileId(pub u32);

/// A place in a scene file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Span {
    /// The file.
    pub file: FileId,
    /// Line, counted from 1; 0 if there is none (made by a program, or in a binary file).
    pub line: u32,
    /// Column in characters, counted from 1; 0 if unknown.
    pub column: u32,
    /// How many characters it covers; 0 if unknown.
    pub length: u32,
}

impl Span {
    /// No place.
    pub const NONE: Self = Self {
        file: FileId(0),
        line: 0,
        column: 0,
        length: 0,
    };

    /// A whole line of a file.
    pub const fn line(file: FileId, line: u32) -> Self {
        Self {
            file,
            line,
            column: 0,
            length: 0,
        }
    }

    /// Whether this names a place.
    pub const fn is_some(self) -> bool {
        self.line != 0
    }
}

/// The files a scene was made from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SourceMap {
    files: Vec<String>,
}

impl SourceMap {
    /// Adds a file under the name to show, or finds it again.
    pub fn add(&mut self, name: &str) -> FileId {
        let known = self.files.iter().position(|f| f == name);
        let index = known.unwrap_or_else(|| {
            self.files.push(name.to_owned());
            self.files.len() - 1
        });
        FileId(index as u32)
    }

    /// The name of a file; `None` for an id of another scene.
    pub fn name(&self, file: FileId) -> Option<&str> {
        self.files.get(file.0 as usize).map(String::as_str)
    }

    /// The place in words, or `None` for [`Span::NONE`].
    pub fn locate(&self, span: Span) -> Option<Location<'_>> {
        (span.is_some())
            .then(|| self.name(span.file).map(|file| Location { file, span }))
            .flatten()
    }
}

/// A place with the name of its file; displays as `file:line` or `file:line:column`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Location<'a> {
    /// Name of the file.
    pub file: &'a str,
    /// Where in the file.
    pub span: Span,
}

impl fmt::Display for Location<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.file, self.span.line)?;
        if self.span.column > 0 {
            write!(f, ":{}", self.span.column)
        } else {
            Ok(())
        }
    }
}
