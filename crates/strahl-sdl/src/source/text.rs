//! The text of a file: a small one is held in memory, a large one is read in parts as needed.
//!
//! Exported scenes of some hundred megabytes are read once from front to back, and only messages refer to earlier text: holding
//! the whole text took a third of the memory for parsing such a scene, and a tenth of the time.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;
use std::time::SystemTime;

/// Files of at least this many bytes are read in parts.
const LARGE: u64 = 16 << 20;

/// The number of bytes of a large file that are held in memory, unless more are needed at once.
const PART: usize = 1 << 20;

/// How many of these bytes are before the requested ones, since most backward references are short.
const BEHIND: usize = PART / 8;

/// The text of a file.
#[derive(Debug)]
pub(super) struct Text {
    length: usize,
    /// The bytes in memory, and the offset of the first one.
    held: Vec<u8>,
    begin: usize,
    /// The file for the rest; `None` if all of it is in memory.
    file: Option<Large>,
}

/// A file that is only partly in memory.
#[derive(Debug)]
struct Large {
    file: File,
    modified: Option<SystemTime>,
    /// The number of bytes to hold.
    part: usize,
    /// The reason why it can't be read further.
    failed: Option<String>,
}

/// A part of a text.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part<'t> {
    /// Its bytes.
    pub(crate) bytes: &'t [u8],
    /// The offset in the file of the first one.
    pub(crate) begin: usize,
    /// Whether the text ends with it.
    pub(crate) is_last: bool,
}

impl<'t> Part<'t> {
    /// The bytes of the part within a range of the file.
    pub(crate) fn get(&self, range: Range<usize>) -> &'t [u8] {
        let end = range.end.saturating_sub(self.begin).min(self.bytes.len());
        let begin = range.start.saturating_sub(self.begin).min(end);
        self.bytes.get(begin..end).unwrap_or(&[])
    }
}

impl Text {
    pub(super) fn new(bytes: Vec<u8>) -> Self {
        Self {
            length: bytes.len(),
            held: bytes,
            begin: 0,
            file: None,
        }
    }

    /// The text of a regular file, if it is large.
    pub(super) fn large(path: &Path) -> io::Result<Option<Self>> {
        // Checked before opening, because opening a pipe waits for a writer.
        let metadata = std::fs::metadata(path)?;
        if !metadata.is_file() || metadata.len() < LARGE {
            return Ok(None);
        }
        Self::in_parts(path, PART).map(Some)
    }

    /// The text of a file of which this many bytes are held.
    pub(super) fn in_parts(path: &Path, part: usize) -> io::Result<Self> {
        let file = File::open(path)?;
        let metadata = file.metadata()?;
        Ok(Self {
            // Files that exceed the address space exceed the parser's limit anyway.
            length: usize::try_from(metadata.len()).unwrap_or(usize::MAX),
            held: vec![],
            begin: 0,
            file: Some(Large {
                modified: metadata.modified().ok(),
                file,
                part,
                failed: None,
            }),
        })
    }

    pub(super) fn len(&self) -> usize {
        self.length
    }

    /// The reason why the file could not be read to its end.
    pub(super) fn failed(&self) -> Option<&str> {
        self.file.as_ref()?.failed.as_deref()
    }

    /// Whether two texts are certainly equal.
    pub(super) fn is(&self, other: &Self) -> bool {
        match (&self.file, &other.file) {
            (None, None) => self.held == other.held,
            // Files of the same name are equal if the file has not changed.
            (Some(a), Some(b)) => self.length == other.length && a.modified == b.modified,
            _ => false,
        }
    }

    /// All bytes, if they are in memory.
    pub(super) fn in_memory(&self) -> Option<&[u8]> {
        self.file.is_none().then_some(&self.held)
    }

    /// All bytes.
    pub(super) fn into_bytes(mut self) -> io::Result<Vec<u8>> {
        if let Some(mut large) = self.file.take() {
            self.held.clear();
            large.file.rewind()?;
            large.file.read_to_end(&mut self.held)?;
        }
        Ok(self.held)
    }

    /// A part of the text that contains this range, as far as the text goes and is readable.
    pub(super) fn part(&mut self, range: Range<usize>) -> Part<'_> {
        let range = range.start.min(self.length)..range.end.min(self.length);
        if range.start < self.begin || range.end > self.begin + self.held.len() {
            self.read(&range);
        }
        let end = self.begin + self.held.len();
        Part {
            bytes: &self.held,
            begin: self.begin,
            is_last: end >= self.length,
        }
    }

    /// Makes `held` contain a range.
    fn read(&mut self, range: &Range<usize>) {
        let Some(large) = &mut self.file else {
            return;
        };
        let part = large.part;
        let begin = range.start.saturating_sub(BEHIND.min(part / 8));
        let end = range.end.max(begin.saturating_add(part)).min(self.length);
        let held = self.begin..self.begin + self.held.len();
        // The bytes in memory are kept, and reading continues after them.
        if held.contains(&begin) && end >= held.end {
            self.held.drain(..begin - held.start);
        } else {
            self.held.clear();
        }
        self.begin = begin;
        let from = begin + self.held.len();
        let done = large.file.seek(SeekFrom::Start(from as u64)).and_then(|_| {
            (&large.file)
                .take((end - from) as u64)
                .read_to_end(&mut self.held)
        });
        let failure = match done {
            Ok(count) if count < end - from => "it has become shorter while it was read".to_owned(),
            Ok(_) => return,
            Err(error) => error.to_string(),
        };
        large.failed = Some(failure);
        // The file ends here: later requests for more return at once.
        self.length = self.begin + self.held.len();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn parts_hold_what_the_file_holds() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("text");
        let bytes: Vec<u8> = (0..9999u32).map(|i| ((i * i) >> 3) as u8).collect();
        fs::write(&path, &bytes).unwrap();
        let mut text = Text::in_parts(&path, 64).unwrap();
        let mut state = 1usize;
        let mut begin = 0;
        for round in 0..5000 {
            state = state.wrapping_mul(1_103_515_245).wrapping_add(12_345) % (1 << 31);
            // Mostly forward, as a parser reads.
            begin = if round % 50 == 0 {
                state % 11_000
            } else {
                begin + state % 20
            };
            let end = begin + state / 11_000 % 300;
            let part = text.part(begin..end);
            let expected = bytes.get(begin..end.min(bytes.len())).unwrap_or(&[]);
            assert_eq!(part.get(begin..end), expected, "{begin}..{end}");
            assert!(part.bytes.len() <= 64 + 300);
        }
        assert_eq!(text.failed(), None);
        assert!(text.part(0..usize::MAX).is_last);
        assert_eq!(text.into_bytes().unwrap(), bytes);
    }

    #[test]
    fn a_file_cut_off_ends_where_it_does() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("text");
        fs::write(&path, vec![b'x'; 5000]).unwrap();
        let mut text = Text::in_parts(&path, 64).unwrap();
        assert!(!text.part(0..10).is_last);
        fs::write(&path, vec![b'x'; 500]).unwrap();
        let part = text.part(1000..1010);
        assert_eq!((part.get(1000..1010), part.is_last), (&b""[..], true));
        assert!(text.failed().unwrap().contains("shorter"));
        // The rest can still be shown.
        fs::write(&path, vec![b'x'; 1000]).unwrap();
        let mut text = Text::in_parts(&path, 64).unwrap();
        text.part(0..10);
        fs::write(&path, vec![b'x'; 900]).unwrap();
        assert!(text.part(890..950).is_last);
        assert_eq!(text.part(100..103).get(100..103), b"xxx");
        assert_eq!(text.len(), 900);
    }

    #[test]
    fn small_files_and_folders_are_not_read_in_parts() {
        let folder = tempfile::tempdir().unwrap();
        assert!(Text::large(folder.path()).unwrap().is_none());
        let path = folder.path().join("text");
        assert!(Text::large(&path).is_err());
        fs::write(&path, "text").unwrap();
        assert!(Text::large(&path).unwrap().is_none());
    }
}
