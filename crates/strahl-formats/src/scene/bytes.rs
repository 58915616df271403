//! Bytes from files and from gzip, within limits.

use flate2::read::MultiGzDecoder;
use std::borrow::Cow;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::{Component, Path, PathBuf};
use strahl_scene::Diagnostic;

/// Most bytes read from something that is no regular file (a pipe) and so has no size of its own.
const PIPE_LIMIT: u64 = 1 << 32;

/// How far a compressed file may expand: this much, and [`MOST_EXPANSION`] times its size. Scenes shrink to a tenth, rarely
/// to a hundredth; gzip's extreme is a thousandth.
const FREE_EXPANSION: u64 = 64 << 20;
const MOST_EXPANSION: u64 = 200;

/// All bytes of a file, or what is in the way.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, Diagnostic> {
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
        return Err(Diagnostic::error(format!(
            "`{name}` is a folder, not a scene file"
        )));
    }
    if metadata.is_file() {
        return fs::read(path).map_err(|e| about(&e));
    }
    let mut bytes = vec![];
    let file = File::open(path).map_err(|e| about(&e))?;
    file.take(PIPE_LIMIT + 1)
        .read_to_end(&mut bytes)
        .map_err(|e| about(&e))?;
    if bytes.len() as u64 > PIPE_LIMIT {
        return Err(Diagnostic::error(format!(
            "`{name}` sends more than {} GiB",
            PIPE_LIMIT >> 30
        ))
        .hint("save it as a file first"));
    }
    Ok(bytes)
}

/// Decompresses what begins like gzip; anything else comes back as it is.
pub(super) fn decompressed<'a>(
    bytes: Cow<'a, [u8]>,
    name: &str,
) -> Result<Cow<'a, [u8]>, Diagnostic> {
    const MAGIC: [u8; 2] = [0x1f, 0x8b];
    if !bytes.starts_with(&MAGIC) {
        return Ok(bytes);
    }
    let limit = FREE_EXPANSION + MOST_EXPANSION * bytes.len() as u64;
    let mut plain = vec![];
    match MultiGzDecoder::new(&*bytes)
        .take(limit + 1)
        .read_to_end(&mut plain)
    {
        Ok(_) if plain.len() as u64 > limit => Err(Diagnostic::error(format!(
            "`{name}`: {} compressed bytes expand to more than {limit}",
            bytes.len()
        ))
        .hint("decompress it with gunzip if this is intended")),
        Ok(_) => Ok(Cow::Owned(plain)),
        Err(e) if e.kind() == ErrorKind::UnexpectedEof => Err(Diagnostic::error(format!(
            "`{name}`: the gzip data ends too early, after {} decompressed bytes",
            plain.len()
        ))
        .hint("the file is cut off: copy or download it again")),
        Err(e) => Err(Diagnostic::error(format!(
            "`{name}`: the gzip data is damaged: {e}"
        ))),
    }
}

/// Reads a file that a scene names, if it lies in the scene's folder or below.
///
/// The check is lexical: `..`, absolute paths and drive letters are refused, symbolic links that the user put there are
/// followed.
pub(crate) fn read_beside(folder: Option<&Path>, relative: &str) -> Result<Vec<u8>, String> {
    let Some(folder) = folder else {
        return Err("the scene has no folder (it was not read from a file)".into());
    };
    // Exporters on Windows write backslashes.
    let relative = relative.replace('\\', "/");
    let inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    if relative.is_empty()
        || relative.contains(['\0', ':'])
        || !Path::new(&relative).components().all(inside)
    {
        return Err(
            "only files in the scene's folder or below are read, by a relative path without `..`"
                .into(),
        );
    }
    let path: PathBuf = folder.join(relative);
    let metadata = fs::metadata(&path).map_err(|e| match e.kind() {
        ErrorKind::NotFound => "there is no such file".to_owned(),
        _ => e.to_string(),
    })?;
    if !metadata.is_file() {
        return Err("it is not a regular file".into());
    }
    fs::read(&path).map_err(|e| e.to_string())
}
