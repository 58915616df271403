//! Reading scenes: bytes to a [`Scene`] and what there is to say about them.
//!
//! [`load_path`] and [`load_bytes`] read every format of the table [`formats`], plain or compressed with gzip. Reading never
//! panics and never ends the process, whatever the bytes are: it returns a scene *and* diagnostics, and no scene if one of
//! them is an error. Memory stays proportional to the file: a count in a header is believed only if the file is
//! long enough for it, and a compressed file may not expand without measure.
//!
//! **Other files** that a scene names (material libraries, buffers, textures) are read only from the scene's own folder and
//! the folders below it, by a relative path without `..`. A scene read from bytes without a folder reads no
//! other file at all.
//!
//! A format that describes surfaces only (OBJ, PLY, STL) leaves camera and lights empty: the renderer frames the objects.

mod detect;
mod gltf;
mod nff;

pub use crate::input::bytes::read_decompressed;
use crate::input::{Folder, Input, Report, bytes};
pub use detect::{FormatInfo, SceneFormat, UnknownSceneFormat, formats};
use std::borrow::Cow;
use std::path::Path;
use strahl_scene::{Diagnostic, Scene};

/// What came out of reading a scene.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene; `None` if a diagnostic is an error.
    pub scene: Option<Scene>,
    /// Errors and warnings, at most about twenty of each.
    pub diagnostics: Vec<Diagnostic>,
    /// The other files that were read, by their paths from the scene's folder.
    pub files: Vec<String>,
}

/// Reads a scene file. Without a `format` the file's extension decides, before it `.gz` is ignored; without a known
/// extension the first bytes decide.
pub fn load_path(path: &Path, format: Option<SceneFormat>) -> Loaded {
    let name = path.display().to_string();
    let bytes = match bytes::read_file(path) {
        Ok(bytes) => bytes,
        Err(problem) => return Loaded::failed(*problem),
    };
    let bytes = match bytes::decompressed(Cow::Borrowed(&bytes), &name) {
        Ok(bytes) => bytes,
        Err(problem) => return Loaded::failed(*problem),
    };
    let format = match format.map_or_else(|| detect::of_file(path, &bytes), Ok) {
        Ok(format) => format,
        Err(problem) => return Loaded::failed(*problem),
    };
    // The folder of `scene.nff` is the empty path, which means the current one.
    read(&bytes, &name, format, path.parent())
}

/// Reads a scene from memory. `display_name` stands for the file in messages; `base_dir` is the folder other files may be
/// read from.
pub fn load_bytes<'a>(
    bytes: impl Into<Cow<'a, [u8]>>,
    display_name: &str,
    format: SceneFormat,
    base_dir: Option<&Path>,
) -> Loaded {
    match bytes::decompressed(bytes.into(), display_name) {
        Ok(bytes) => read(&bytes, display_name, format, base_dir),
        Err(problem) => Loaded::failed(*problem),
    }
}

impl Loaded {
    fn failed(problem: Diagnostic) -> Self {
        Self {
            scene: None,
            diagnostics: vec![problem],
            files: vec![],
        }
    }
}

fn read(bytes: &[u8], name: &str, format: SceneFormat, folder: Option<&Path>) -> Loaded {
    if bytes.is_empty() {
        return Loaded::failed(Diagnostic::error(format!("`{name}` is empty")));
    }
    let mistaken = detect::mistaken(bytes, name, format);
    // A binary STL file may begin with anything, so it is mistaken only if it can't be read.
    let may_begin_so = format == SceneFormat::Stl;
    if let Some(problem) = mistaken.clone().filter(|_| !may_begin_so) {
        return Loaded::failed(problem);
    }
    let mut report = Report::default();
    let folder = folder.map(Folder::new);
    let input = Input {
        bytes,
        name,
        folder: folder.as_ref(),
    };
    let scene = format.info().map(|info| (info.read)(&input, &mut report));
    let (failed, diagnostics) = report.finish();
    if let Some(problem) = mistaken.filter(|_| failed) {
        return Loaded::failed(problem);
    }
    Loaded {
        scene: scene.filter(|_| !failed),
        diagnostics,
        files: folder.map(Folder::into_read).unwrap_or_default(),
    }
}

#[cfg(test)]
mod tests;
