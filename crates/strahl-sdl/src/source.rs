//! Reading and writing files, and storing what was read.

use std::io::{self, Write};
use std::path::Path;
use text::Text;

mod chunk;
mod file;
mod folder;
mod fonts;
mod memory;
mod recorder;
mod text;
mod writing;

pub(crate) use chunk::Chunk;
pub(crate) use file::SourceFile;
pub use folder::{FolderHost, Pinned, Texts, present};
pub use memory::MemoryHost;
pub use recorder::{Lookup, Read, Record, Recorder};
pub(crate) use text::Part;
pub use writing::Writing;

/// A scene file to be parsed: UTF-8, UTF-16 or Latin-1.
#[derive(Debug)]
pub struct Source {
    /// Its name as shown to the user; includes are searched first in its folder.
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

    /// A regular file of several megabytes or more, which is read while it is parsed; `None` for smaller or other files.
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

    /// All bytes, if they are in memory.
    fn in_memory(&self) -> Option<&[u8]> {
        self.text.in_memory()
    }

    /// SHA-256 of its bytes.
    ///
    /// # Errors
    /// If the file can't be read.
    pub fn sha256(&self) -> io::Result<[u8; 32]> {
        recorder::digest(self)
    }

    /// Length in bytes.
    pub fn length(&self) -> usize {
        self.text.len()
    }

    /// Converts UTF-16 in either byte order to UTF-8; other texts stay as they are. UTF-16 is recognised by a byte order mark, or
    /// by two ASCII characters at the beginning. Invalid characters become U+FFFD.
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
        /// The name in the scene.
        name: String,
        /// The folders searched, in order.
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
        /// The system's message.
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

/// The parser's access to files, time and output; it does no input or output itself.
pub trait Host: Send {
    /// Reads a file named in a scene.
    ///
    /// `from` is the name (as returned by this function, or of the scene) of the file that contains the name.
    ///
    /// # Errors
    /// [`HostError::NotFound`] makes the parser search the built-in include files.
    fn load(&mut self, name: &str, from: &str) -> Result<Source, HostError>;

    /// Reads a font of the system by the name of its file, without a folder; `None` if there is none. It is called for fonts that
    /// [`Host::load`] does not find.
    ///
    /// # Errors
    /// If the file exists but can't be read.
    fn load_font(&mut self, _file: &str) -> Result<Option<Source>, HostError> {
        Ok(None)
    }

    /// Reads a file that is neither found by [`Host::load`] nor built in, such as a picture of an installed POV-Ray.
    ///
    /// # Errors
    /// [`HostError::NotFound`] if there is no such file.
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

    /// Receives a message of the scene.
    fn message(&mut self, stream: Stream, text: &str);

    /// Whether nobody wants the scene any more. It is asked every few milliseconds, and ends the reading with an error.
    fn stops(&self) -> bool {
        false
    }

    /// The value of `now`: days since the beginning of 2000 in UTC. A fixed value makes scenes reproducible.
    fn now(&mut self) -> f64;
}
