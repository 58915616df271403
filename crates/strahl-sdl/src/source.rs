//! Files: how they are read and written, and what is stored of those read.

use std::io::{self, Write};
use std::path::Path;
use text::Text;

mod chunk;
mod file;
mod folder;
mod fonts;
mod memory;
mod text;
mod writing;

pub(crate) use chunk::Chunk;
pub(crate) use file::SourceFile;
pub use folder::FolderHost;
pub use memory::MemoryHost;
pub(crate) use text::Part;
pub use writing::Writing;

/// A scene file to be parsed: UTF-8, UTF-16 or Latin-1.
#[derive(Debug)]
pub struct Source {
    /// Its name as shown to the user; includes are searched beside it first.
    pub name: String,
    text: Text,
}

impl Source {
    /// A scene from a text in memory.
    pub fn new(name: impl Into<String>, text: impl Into<Vec<u8>>) -> Self {
        Self {
            name: name.into(),
            text: Text::new(text.into()),
        }
    }

    /// A plain file of more than some megabytes, which is read while it is parsed; `None` if it is not so large or not plain.
    ///
    /// # Errors
    /// If the file can't be opened.
    pub fn large(path: &Path) -> io::Result<Option<Self>> {
        let text = Text::large(path)?;
        Ok(text.map(|text| Self {
            name: path.display().to_string(),
            text,
        }))
    }

    /// Length in bytes.
    pub fn length(&self) -> usize {
        self.text.len()
    }

    /// The scene as UTF-8 or Latin-1, if it is UTF-16 in either byte order: with a byte order mark, or without one if its first two
    /// characters are ASCII. What is no character becomes U+FFFD.
    ///
    /// # Errors
    /// If the file can't be read.
    pub(crate) fn narrowed(mut self) -> io::Result<Self> {
        let read: fn([u8; 2]) -> u16 = match *self.text.part(0..4).get(0..4) {
            [0xff, 0xfe, ..] => u16::from_le_bytes,
            [0xfe, 0xff, ..] => u16::from_be_bytes,
            [1..=0x7f, 0, 1..=0x7f, 0] => u16::from_le_bytes,
            [0, 1..=0x7f, 0, 1..=0x7f] => u16::from_be_bytes,
            _ => return Ok(self),
        };
        let bytes = self.text.into_bytes()?;
        let units = bytes
            .chunks(2)
            .map(|pair| read([pair[0], pair.get(1).copied().unwrap_or(0)]));
        let characters =
            char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER));
        let text: String = characters.skip_while(|c| *c == '\u{feff}').collect();
        Ok(Self::new(self.name, text))
    }

    /// Whether it begins with these bytes.
    pub fn starts_with(&mut self, bytes: &[u8]) -> bool {
        self.text.part(0..bytes.len()).bytes.starts_with(bytes)
    }

    /// All bytes.
    ///
    /// # Errors
    /// If the file can't be read.
    pub fn into_bytes(self) -> io::Result<Vec<u8>> {
        self.text.into_bytes()
    }
}

/// The destination of a message: the directive of the same name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stream {
    /// `#debug`
    Debug,
    /// `#render`
    Render,
    /// `#statistics`
    Statistics,
    /// `#warning`; also reported as a diagnostic.
    Warning,
}

/// The reason why a file could not be read or written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum HostError {
    /// There is no such file.
    #[error("there is no file `{name}`")]
    NotFound {
        /// The name asked for.
        name: String,
        /// Where it was searched, in order.
        searched: Vec<String>,
    },
    /// The file is larger than the limit.
    #[error("`{name}` is larger than {limit} bytes")]
    TooLarge {
        /// The file.
        name: String,
        /// The limit.
        limit: u64,
    },
    /// The place is outside of the folders where scenes may write.
    #[error("a scene may not write `{name}`: {why}")]
    Forbidden {
        /// The file.
        name: String,
        /// The rule that forbids it.
        why: String,
    },
    /// The system reports an error.
    #[error("`{name}`: {message}")]
    Io {
        /// The file.
        name: String,
        /// The system's words.
        message: String,
    },
}

impl HostError {
    /// Adds folders that were searched as well.
    pub(crate) fn also(mut self, more: Vec<String>) -> Self {
        if let Self::NotFound { searched, .. } = &mut self {
            searched.extend(more);
        }
        self
    }
}

/// Access of the parser to files, time and output, since it does no input or output by itself.
pub trait Host: Send {
    /// Reads a file that a scene names.
    ///
    /// `from` is the name (as returned by this function, or of the scene) of the file that asks.
    ///
    /// # Errors
    /// [`HostError::NotFound`] lets the parser look among the built-in include files.
    fn load(&mut self, name: &str, from: &str) -> Result<Source, HostError>;

    /// Reads a font of the system by the name of its file, without folder; `None` if there is none. Scenes that name a font get
    /// here when [`Host::load`] does not find it.
    ///
    /// # Errors
    /// If the file is there and can't be read.
    fn load_font(&mut self, _file: &str) -> Result<Option<Source>, HostError> {
        Ok(None)
    }

    /// Reads a file that is neither where [`Host::load`] looks nor built in, such as a picture of an installed POV-Ray.
    ///
    /// # Errors
    /// [`HostError::NotFound`] where nothing of the kind is known.
    fn load_installed(&mut self, name: &str) -> Result<Source, HostError> {
        Err(HostError::NotFound {
            name: name.to_owned(),
            searched: vec![],
        })
    }

    /// Opens a file for `#write`.
    ///
    /// # Errors
    /// If the place is not allowed or the system refuses.
    fn create(&mut self, name: &str, append: bool) -> Result<Box<dyn Write + Send>, HostError>;

    /// Takes a message of the scene.
    fn message(&mut self, stream: Stream, text: &str);

    /// Days since the beginning of 2000 in UTC, the value of `now`; a fixed time makes scenes reproducible.
    fn now(&mut self) -> f64;
}
