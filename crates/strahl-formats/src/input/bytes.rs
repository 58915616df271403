//! Bytes from files and from gzip, within limits.

use super::Fallible;
use flate2::read::MultiGzDecoder;
use memmap2::Mmap;
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::ops::Deref;
use std::path::{Component, Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use strahl_scene::Diagnostic;

/// Most bytes read from a pipe or device, which has no size.
const PIPE_LIMIT: u64 = 1 << 32;

/// Files from this size on are mapped: smaller ones are read as fast.
const MAPPED: u64 = 16 << 20;

/// How far a compressed file may expand: this much, and [`MOST_EXPANSION`] times its size. Scenes are compressed to a tenth,
/// rarely to a hundredth; gzip's extreme is a thousandth.
const FREE_EXPANSION: u64 = 64 << 20;
const MOST_EXPANSION: u64 = 200;

/// All bytes of a file, decompressed if it begins like gzip: for readers of formats outside of this crate.
///
/// # Errors
/// The reason why it can't be read: no such file, no permission, damaged gzip data, or data that expands too much.
pub fn read_decompressed(path: &Path) -> Result<Vec<u8>, Box<Diagnostic>> {
    let name = path.display().to_string();
    match read_file(path)? {
        FileBytes::Read(bytes) => Ok(decompressed(Cow::Owned(bytes), &name)?.into_owned()),
        FileBytes::Mapped(bytes) => Ok(decompressed(Cow::Borrowed(&bytes), &name)?.into_owned()),
    }
}

/// The bytes of a file.
pub(crate) enum FileBytes {
    Read(Vec<u8>),
    Mapped(Mmap),
}

impl Deref for FileBytes {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        match self {
            Self::Read(bytes) => bytes,
            Self::Mapped(bytes) => bytes,
        }
    }
}

/// All bytes of a file, or the reason why it can't be read.
pub(crate) fn read_file(path: &Path) -> Fallible<FileBytes> {
    let name = path.display();
    let about = |e: &io::Error| match e.kind() {
        ErrorKind::NotFound => Diagnostic::error(format!("there is no file `{name}`")),
        ErrorKind::PermissionDenied => {
            Diagnostic::error(format!("`{name}` may not be read: permission denied"))
        }
        _ => Diagnostic::error(format!("cannot read `{name}`: {e}")),
    };
    let metadata = fs::metadata(path).map_err(|e| about(&e))?;
    if metadata.is_dir() {
        let problem = format!("`{name}` is a folder, not a scene file");
        return Err(Box::new(Diagnostic::error(problem)));
    }
    if metadata.is_file() {
        if metadata.len() >= MAPPED
            && let Some(mapped) = map(path)
        {
            return Ok(FileBytes::Mapped(mapped));
        }
        return Ok(FileBytes::Read(fs::read(path).map_err(|e| about(&e))?));
    }
    let mut bytes = vec![];
    let file = File::open(path).map_err(|e| about(&e))?;
    file.take(PIPE_LIMIT + 1)
        .read_to_end(&mut bytes)
        .map_err(|e| about(&e))?;
    if bytes.len() as u64 > PIPE_LIMIT {
        let problem = format!("`{name}` sends more than {} GiB", PIPE_LIMIT >> 30);
        return Err(Box::new(
            Diagnostic::error(problem).hint("save it as a file first"),
        ));
    }
    Ok(FileBytes::Read(bytes))
}

/// Maps a file into memory, which takes no time for what the system has cached, and no memory of ours.
///
/// `None` if the system can't.
#[allow(
    unsafe_code,
    reason = "copying half a gigabyte takes 0.3 s, mapping it takes no time"
)]
fn map(path: &Path) -> Option<Mmap> {
    let file = File::open(path).ok()?;
    // SAFETY: The map is only read from. Whoever writes into a file while it is being loaded gets a scene of what was there
    // at one time or another, and whoever cuts it off ends the program with a signal, as with any mapped file; programs that
    // save by renaming, as ours do, disturb nothing. No reader relies on bytes being the same when they are read again
    // but within one word, where `str` is checked and parsed at once.
    unsafe { Mmap::map(&file) }.ok()
}

/// Reads to the end, or until the memory is full.
fn read_within_memory(from: &mut impl Read, bytes: &mut Vec<u8>) -> io::Result<()> {
    const MOST: usize = 64 << 20;
    loop {
        if bytes.len() == bytes.capacity() {
            let more = bytes.len().clamp(1 << 16, MOST);
            // Growing may need both the old place and the new one.
            if !strahl_simd::memory::fits((bytes.len() + more) as u64) {
                return Err(ErrorKind::OutOfMemory.into());
            }
            bytes.reserve_exact(more);
        }
        let room = bytes.capacity() - bytes.len();
        if from.take(room as u64).read_to_end(bytes)? == 0 {
            return Ok(());
        }
    }
}

/// Decompresses data that begins like gzip; anything else is returned unchanged.
pub(crate) fn decompressed<'a>(bytes: Cow<'a, [u8]>, name: &str) -> Fallible<Cow<'a, [u8]>> {
    const MAGIC: [u8; 2] = [0x1f, 0x8b];
    if !bytes.starts_with(&MAGIC) {
        return Ok(bytes);
    }
    let limit = FREE_EXPANSION + MOST_EXPANSION * bytes.len() as u64;
    let mut plain = vec![];
    let mut decoder = MultiGzDecoder::new(&*bytes).take(limit + 1);
    let decoded = read_within_memory(&mut decoder, &mut plain);
    let problem = match decoded {
        Err(e) if e.kind() == ErrorKind::OutOfMemory => {
            let (compressed, end) = (bytes.len(), plain.len() >> 20);
            let problem = format!(
                "`{name}`: its {compressed} compressed bytes expand to more than {end} MiB, for which there is not enough memory"
            );
            Diagnostic::error(problem).hint("raise the memory limit, or free some memory")
        }
        Ok(_) if plain.len() as u64 <= limit => return Ok(Cow::Owned(plain)),
        Ok(_) => {
            let compressed = bytes.len();
            let problem =
                format!("`{name}`: {compressed} compressed bytes expand to more than {limit}");
            Diagnostic::error(problem).hint("decompress it with gunzip if this is intended")
        }
        Err(e) if e.kind() == ErrorKind::UnexpectedEof => {
            let end = plain.len();
            let problem =
                format!("`{name}`: the gzip data ends too early, after {end} decompressed bytes");
            Diagnostic::error(problem).hint("the file is cut off: copy or download it again")
        }
        Err(e) => Diagnostic::error(format!("`{name}`: the gzip data is damaged: {e}")),
    };
    Err(Box::new(problem))
}

/// The name of a file without the quotation marks that some programs put around names with blanks.
pub(crate) fn unquoted(name: &str) -> &str {
    let inner = name.strip_prefix('"').and_then(|n| n.strip_suffix('"'));
    inner.filter(|n| !n.contains('"')).unwrap_or(name)
}

/// The path of a file that a scene names, with slashes and without `.`, if it is in the scene's folder or below.
///
/// The check is lexical: `..`, absolute paths and drive letters are refused, symbolic links that the user put there are
/// followed.
pub(crate) fn path_beside(relative: &str) -> Result<String, String> {
    // Exporters on Windows write backslashes.
    let relative = relative.replace('\\', "/");
    let mut parts = vec![];
    let mut inside = !relative.contains(['\0', ':']);
    for part in Path::new(&relative).components() {
        match part {
            Component::Normal(name) => parts.push(name.to_string_lossy()),
            Component::CurDir => {}
            _ => inside = false,
        }
    }
    if parts.is_empty() || !inside {
        return Err(
            "only files in the scene's folder or below are read, by a relative path without `..`"
                .into(),
        );
    }
    Ok(parts.join("/"))
}

/// The folder of a scene, where the files that it names are.
#[derive(Debug)]
pub(crate) struct Folder {
    path: PathBuf,
    /// The files that were read, as the scene names them.
    read: Mutex<BTreeSet<String>>,
}

impl Folder {
    pub(crate) fn new(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            read: Mutex::default(),
        }
    }

    /// The path of a file as shown to the user.
    pub(crate) fn shown(&self, path: &str) -> String {
        self.path.join(path).display().to_string()
    }

    /// The files that were read, in alphabetical order.
    pub(crate) fn into_read(self) -> Vec<String> {
        let read = self.read.into_inner();
        let read = read.unwrap_or_else(PoisonError::into_inner);
        read.into_iter().collect()
    }
}

/// Reads a file that a scene names, by a path from [`path_beside`].
pub(crate) fn read_beside(folder: Option<&Folder>, path: &str) -> Result<Vec<u8>, String> {
    let Some(folder) = folder else {
        return Err("the scene has no folder (it was not read from a file)".into());
    };
    let file = folder.path.join(path);
    let metadata = fs::metadata(&file).map_err(|e| match e.kind() {
        ErrorKind::NotFound => "there is no such file".to_owned(),
        _ => e.to_string(),
    })?;
    if !metadata.is_file() {
        return Err("it is not a regular file".into());
    }
    let bytes = fs::read(&file).map_err(|e| e.to_string())?;
    let mut read = folder.read.lock().unwrap_or_else(PoisonError::into_inner);
    read.insert(path.to_owned());
    Ok(bytes)
}
