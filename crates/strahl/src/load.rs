use crate::inputs::{Inputs, digest};
use crate::subdivide::{SubdivideOptions, subdivide};
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use strahl_formats::scene::{self, SceneFormat, read_decompressed};
use strahl_scene::{Diagnostic, Problems, Scene};
use strahl_sdl::{FolderHost, Pinned, Recorder, Source, Stream, Texts, Writing, parse};

/// A format that scenes are loaded from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// POV-Ray's scene description language.
    Pov,
    /// A file format of [`strahl_formats`].
    File(SceneFormat),
}

impl Format {
    /// Name, endings and description of [`Format::Pov`], as in the table of [`strahl_formats::scene::formats`].
    pub const POV: (&'static str, &'static [&'static str], &'static str) =
        ("pov", &["pov"], "POV-Ray's scene description language");

    /// The format given by a file's name, if it has a known extension; a final `.gz` is ignored.
    pub fn of_path(path: &Path) -> Option<Self> {
        let ending = ending(path)?;
        if ending == "pov" {
            return Some(Self::Pov);
        }
        SceneFormat::of_extension(&ending).map(Self::File)
    }
}

/// The ending of a file's name in lower case, without `.gz`.
fn ending(path: &Path) -> Option<String> {
    let of = |p: &Path| Some(p.extension()?.to_string_lossy().to_ascii_lowercase());
    match of(path)?.as_str() {
        "gz" => of(Path::new(path.file_stem()?)),
        other => Some(other.to_owned()),
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pov => f.write_str(Self::POV.0),
            Self::File(format) => format.fmt(f),
        }
    }
}

/// There is no scene format of that name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown scene format `{found}`; the formats are {}", names())]
pub struct UnknownFormat {
    found: String,
}

fn names() -> String {
    let files = scene::formats().iter().map(|info| info.name);
    let all: Vec<&str> = [Format::POV.0].into_iter().chain(files).collect();
    all.join(", ")
}

impl FromStr for Format {
    type Err = UnknownFormat;

    fn from_str(s: &str) -> Result<Self, Self::Err> {
        if s.eq_ignore_ascii_case(Self::POV.0) {
            return Ok(Self::Pov);
        }
        let unknown = |_| UnknownFormat { found: s.into() };
        s.parse().map(Self::File).map_err(unknown)
    }
}

/// Receives the messages of a scene.
pub type Listener = Box<dyn FnMut(Stream, &str) + Send>;

/// What came out of loading a scene.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene; `None` if a diagnostic is an error.
    pub scene: Option<Scene>,
    /// Errors and warnings.
    pub diagnostics: Vec<Diagnostic>,
    /// Everything the scene consists of, if [`LoadOptions::record`] asks for it and it could be read.
    pub inputs: Option<Inputs>,
}

impl Loaded {
    fn failed(problem: Diagnostic) -> Self {
        Self {
            scene: None,
            diagnostics: vec![problem],
            inputs: None,
        }
    }

    /// The scene and the warnings about it.
    ///
    /// # Errors
    /// All errors and warnings, if there is no scene.
    pub fn into_scene(self) -> Result<(Scene, Vec<Diagnostic>), Problems> {
        match self.scene {
            Some(scene) => Ok((scene, self.diagnostics)),
            None => Err(Problems(self.diagnostics)),
        }
    }

    /// What a reader of [`strahl_formats`] has loaded, its meshes replaced by subdivision surfaces if that is asked for.
    fn of_format(mut loaded: scene::Loaded, options: Option<SubdivideOptions>) -> Self {
        if let Some(options) = options
            && let Some(mut scene) = loaded.scene.take()
        {
            let problems = subdivide(&mut scene, options);
            loaded.scene = problems.is_empty().then_some(scene);
            loaded.diagnostics.extend(problems);
        }
        Self {
            scene: loaded.scene,
            diagnostics: loaded.diagnostics,
            inputs: None,
        }
    }
}

/// How a scene is loaded. All fields but `format`, `subdivide` and `record` matter only to POV-Ray's language.
#[derive(Default)]
pub struct LoadOptions {
    /// The format; `None` detects it from the file's name and content.
    pub format: Option<Format>,
    /// Clock, picture size, declared names, limits.
    pub sdl: strahl_sdl::Options,
    /// Folders where included files are searched after the scene's own; then come the built-in includes.
    pub library: Vec<PathBuf>,
    /// Folders where fonts are searched, with the folders in them, after the others.
    pub fonts: Vec<PathBuf>,
    /// Folders that are searched last; [`povray_folders`] names those of an installed POV-Ray.
    pub installed: Vec<PathBuf>,
    /// The place where the scene may write files; nowhere by default.
    pub writing: Writing,
    /// The only files that the scene may read; `None` searches them in the folders.
    pub pinned: Option<Pinned>,
    /// Texts that are read instead of files, by the paths under which the files are found; that of the scene is the path given to [`load_path`].
    pub texts: Texts,
    /// The value of `now`, in days since the beginning of 2000; `None` is the time of loading.
    pub now: Option<f64>,
    /// Replaces the meshes of a file that is not in POV-Ray's language by the subdivision surfaces that they control.
    pub subdivide: Option<SubdivideOptions>,
    /// Whether to return [`Loaded::inputs`], which takes time to compute.
    pub record: bool,
    /// Receives the output of `#debug` and the like.
    pub on_message: Option<Listener>,
    /// Ends the reading of a scene in POV-Ray's language with an error as soon as this is true.
    pub stop: Option<Arc<AtomicBool>>,
}

impl fmt::Debug for LoadOptions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LoadOptions")
            .field("format", &self.format)
            .field("sdl", &self.sdl)
            .field("library", &self.library)
            .field("fonts", &self.fonts)
            .field("installed", &self.installed)
            .field("writing", &self.writing)
            .finish_non_exhaustive()
    }
}

impl LoadOptions {
    fn parse(self, source: Source) -> Loaded {
        if self.subdivide.is_some() {
            return Loaded::failed(
                Diagnostic::error(format!(
                    "`{}` is in POV-Ray's language, and only meshes of OBJ, PLY, STL and glTF files are subdivided",
                    source.name
                ))
                .hint("write a `subdivision { }` object in the scene"),
            );
        }
        let mut host = FolderHost::new(self.library)
            .with_fonts(self.fonts)
            .with_installed(self.installed)
            .allow_writing(self.writing);
        if let Some(f) = self.on_message {
            host = host.on_message(f);
        }
        if let Some(files) = self.pinned {
            host = host.pinned(files);
        }
        if !self.texts.is_empty() {
            host = host.with_texts(self.texts);
        }
        if let Some(days) = self.now {
            host = host.at_time(days);
        }
        if let Some(stop) = self.stop {
            host = host.stopped_by(stop);
        }
        if !self.record {
            let parsed = parse(source, &self.sdl, &mut host);
            return Loaded {
                scene: parsed.scene,
                diagnostics: parsed.diagnostics,
                inputs: None,
            };
        }
        let (name, sha256) = (source.name.clone(), source.sha256());
        let mut host = Recorder::new(&mut host);
        let parsed = parse(source, &self.sdl, &mut host);
        let record = host.into_record();
        Loaded {
            scene: parsed.scene,
            diagnostics: parsed.diagnostics,
            inputs: sha256.ok().map(|sha256| Inputs {
                scene: name,
                sha256,
                record,
            }),
        }
    }
}

/// The folders where packages of POV-Ray have put its include files, pictures and fonts on this machine.
///
/// The include files of POV-Ray are built into strahl; the rest (pictures, fonts, colour maps of single textures) is taken
/// from an installed POV-Ray where there is one.
pub fn povray_folders() -> Vec<PathBuf> {
    let mut folders = vec![];
    for root in [
        "/usr/local/share",
        "/usr/share",
        "/opt/homebrew/share",
        "/opt/local/share",
    ] {
        for name in ["povray-3.8", "povray-3.7", "povray"] {
            folders.push(PathBuf::from(root).join(name).join("include"));
        }
    }
    folders.retain(|folder| folder.is_dir());
    folders
}

/// Loads a scene file of any format.
///
/// ```
/// use strahl::{LoadOptions, load_path};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("ball.pov");
/// std::fs::write(&path, "sphere { 0, 1 pigment { rgb <1, 0, 0> } }")?;
/// let loaded = load_path(&path, LoadOptions::default());
/// assert_eq!(loaded.scene.expect("no errors").objects.0.len(), 1);
/// # Ok(())
/// # }
/// ```
pub fn load_path(path: &Path, options: LoadOptions) -> Loaded {
    let failed = Loaded::failed;
    if options.format.is_none() && ending(path).is_some_and(|e| e == "inc") {
        let shown = path.display();
        return failed(
            Diagnostic::error(format!("`{shown}` is an include file, not a scene")).hint(
                "give the .pov file that includes it; `--format pov` reads it as a scene anyway",
            ),
        );
    }
    if let Some(text) = options.texts.get(path) {
        let (bytes, name) = (text.as_bytes().to_vec(), path.display().to_string());
        let format = options.format.or_else(|| Format::of_path(path));
        return load_bytes(bytes, &name, format.unwrap_or(Format::Pov), options);
    }
    match options.format.or_else(|| Format::of_path(path)) {
        Some(Format::Pov) => match open(path) {
            Ok(source) => options.parse(source),
            Err(problem) => failed(*problem),
        },
        Some(Format::File(format)) => {
            with_inputs(scene::load_path(path, Some(format)), path, &options)
        }
        None => {
            let loaded = scene::load_path(path, None);
            let mut loaded = with_inputs(loaded, path, &options);
            // The list of file formats does not include POV-Ray's.
            let of_files: Vec<&str> = scene::formats().iter().map(|info| info.name).collect();
            let hints = loaded.diagnostics.iter_mut().flat_map(|d| &mut d.hints);
            for hint in hints {
                *hint = hint.replace(&of_files.join(", "), &names());
            }
            loaded
        }
    }
}

/// Adds what a scene of another format than POV-Ray's consists of, if that is asked for: its file, and those beside it.
fn with_inputs(loaded: scene::Loaded, path: &Path, options: &LoadOptions) -> Loaded {
    let inputs = match options.record {
        true => Inputs::of_files(path, &loaded.files).ok(),
        false => None,
    };
    Loaded {
        inputs,
        ..Loaded::of_format(loaded, options.subdivide)
    }
}

/// The text of a scene: large ones are read while they are parsed, unless they are compressed.
fn open(path: &Path) -> Result<Source, Box<Diagnostic>> {
    const GZIP: &[u8] = &[0x1f, 0x8b];
    if let Ok(Some(mut source)) = Source::large(path)
        && !source.starts_with(GZIP)
    {
        return Ok(source);
    }
    let bytes = read_decompressed(path)?;
    Ok(Source::new(path.display().to_string(), bytes))
}

/// Loads a scene from memory; `name` stands for the file in messages.
pub fn load_bytes(bytes: Vec<u8>, name: &str, format: Format, options: LoadOptions) -> Loaded {
    match format {
        Format::Pov => options.parse(Source::new(name, bytes)),
        Format::File(format) => {
            let inputs = options.record.then(|| Inputs {
                scene: name.to_owned(),
                sha256: digest(&bytes),
                record: Default::default(),
            });
            Loaded {
                inputs,
                ..Loaded::of_format(
                    scene::load_bytes(bytes, name, format, None),
                    options.subdivide,
                )
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_formats() {
        let of = |name: &str| Format::of_path(Path::new(name));
        assert_eq!(of("a/b.POV"), Some(Format::Pov));
        assert_eq!(of("b.pov.gz"), Some(Format::Pov));
        assert_eq!(of("b.nff"), Some(Format::File(SceneFormat::Nff)));
        assert_eq!(of("b.xyz"), None);
        assert_eq!(of("pov"), None);
        assert_eq!("Pov".parse(), Ok(Format::Pov));
        let unknown = "xyz".parse::<Format>().expect_err("no such format");
        assert!(unknown.to_string().contains("pov, nff"), "{unknown}");
    }

    #[test]
    fn an_include_file_is_no_scene() {
        let loaded = load_path(Path::new("colors.inc"), LoadOptions::default());
        assert!(loaded.diagnostics[0].hints[0].contains(".pov"));
    }
}
