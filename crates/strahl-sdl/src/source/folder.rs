use super::fonts::FontFolders;
use super::writing::{Found, Writing, Written};
use super::{Host, HostError, Lookup, Source, Stream};
use std::collections::BTreeMap;
use std::fs;
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::SystemTime;

/// The only files that a scene may read: the path for each way of asking, name in the scene, and name of the file with the name in it
/// (empty for fonts and installed files).
pub type Pinned = BTreeMap<(Lookup, String, String), PathBuf>;

/// Texts that are read instead of files, by the paths under which the files are found.
pub type Texts = BTreeMap<PathBuf, Arc<str>>;

/// Receives the messages of scenes.
type Listener = dyn FnMut(Stream, &str) + Send;

/// Files in folders of the disk.
///
/// A file is searched first in the folder of the file that names it, then in the library folders in order, then where scenes
/// write; files written by the scene itself come before all of these. Scenes may write only where that is allowed, which is
/// nowhere by default. Messages of the scene go to the given function; without one they are dropped.
pub struct FolderHost {
    library: Vec<PathBuf>,
    fonts: FontFolders,
    installed: Vec<PathBuf>,
    written: Written,
    max_file: u64,
    on_message: Option<Box<Listener>>,
    now: Option<f64>,
    pinned: Option<Pinned>,
    texts: Texts,
    stop: Option<Arc<AtomicBool>>,
}

impl std::fmt::Debug for FolderHost {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FolderHost")
            .field("library", &self.library)
            .field("installed", &self.installed)
            .field("written", &self.written)
            .field("max_file", &self.max_file)
            .finish_non_exhaustive()
    }
}

impl FolderHost {
    /// Searches these folders after that of the file with the name.
    pub fn new(library: impl IntoIterator<Item = PathBuf>) -> Self {
        Self {
            library: library.into_iter().collect(),
            fonts: FontFolders::default(),
            installed: vec![],
            written: Written::default(),
            max_file: u64::from(u32::MAX) - 1,
            on_message: None,
            now: None,
            pinned: None,
            texts: Texts::new(),
            stop: None,
        }
    }

    /// Searches these folders and their subfolders for fonts that are not found elsewhere.
    #[must_use]
    pub fn with_fonts(mut self, folders: impl IntoIterator<Item = PathBuf>) -> Self {
        self.fonts = FontFolders::new(folders);
        self
    }

    /// Searches these folders last, after the built-in includes: those of an installed POV-Ray.
    #[must_use]
    pub fn with_installed(mut self, folders: impl IntoIterator<Item = PathBuf>) -> Self {
        self.installed.extend(folders);
        self
    }

    /// Lets scenes write files; their names are relative to the folder. Scenes can't write hidden files, nor files that no scene
    /// has written.
    #[must_use]
    pub fn allow_writing(mut self, place: Writing) -> Self {
        self.written = Written::to(place);
        self
    }

    /// Largest file read, in bytes; at most 4 GiB.
    #[must_use]
    pub fn limit_file_size(mut self, bytes: u64) -> Self {
        self.max_file = self.max_file.min(bytes);
        self
    }

    /// Passes the messages of scenes to a function.
    #[must_use]
    pub fn on_message(mut self, f: impl FnMut(Stream, &str) + Send + 'static) -> Self {
        self.on_message = Some(Box::new(f));
        self
    }

    /// Fixes the value of `now`, in days since the beginning of 2000.
    #[must_use]
    pub fn at_time(mut self, days: f64) -> Self {
        self.now = Some(days);
        self
    }

    /// Reads only these files instead of searching folders: a scene that was recorded by [`super::Recorder`] then reads the same files
    /// on another machine.
    #[must_use]
    pub fn pinned(mut self, files: Pinned) -> Self {
        self.pinned = Some(files);
        self
    }

    /// Reads these texts instead of the files that are found under their paths.
    #[must_use]
    pub fn with_texts(mut self, texts: Texts) -> Self {
        self.texts = texts;
        self
    }

    /// Ends the reading of a scene with an error as soon as this is true.
    #[must_use]
    pub fn stopped_by(mut self, stop: Arc<AtomicBool>) -> Self {
        self.stop = Some(stop);
        self
    }

    /// A pinned file, if files are pinned.
    fn find_pinned(
        &self,
        lookup: Lookup,
        name: &str,
        from: &str,
    ) -> Option<Result<Source, HostError>> {
        let pinned = self.pinned.as_ref()?;
        let not_found = || HostError::NotFound {
            name: name.to_owned(),
            searched: vec!["the bundle".to_owned()],
        };
        let key = (lookup, name.to_owned(), from.to_owned());
        let Some(path) = pinned.get(&key) else {
            return Some(Err(not_found()));
        };
        Some(match self.read(path) {
            Ok(Some(source)) => Ok(source),
            Ok(None) => Err(not_found()),
            Err(error) => Err(error),
        })
    }

    /// Searches a file in folders, in order.
    fn search(&self, name: &str, folders: &[PathBuf]) -> Result<Source, HostError> {
        // Scenes from Windows use backslashes.
        let names = if name.contains('\\') && !cfg!(windows) {
            vec![name.to_owned(), name.replace('\\', "/")]
        } else {
            vec![name.to_owned()]
        };
        for name in &names {
            for folder in folders {
                let path = folder.join(name);
                if let Some(source) = self.read(&path)? {
                    return Ok(source);
                }
            }
        }
        let show = |folder: &PathBuf| match folder.as_os_str().is_empty() {
            true => "the current folder".to_owned(),
            false => folder.display().to_string(),
        };
        Err(HostError::NotFound {
            name: name.to_owned(),
            searched: folders.iter().map(show).collect(),
        })
    }

    fn read(&self, path: &Path) -> Result<Option<Source>, HostError> {
        let shown = path.display().to_string();
        if let Some(text) = self.texts.get(path) {
            return Ok(Some(Source::new(shown, &**text)));
        }
        let io = |error: std::io::Error| HostError::Io {
            name: shown.clone(),
            message: error.to_string(),
        };
        // Checked before opening, because opening a pipe waits for a writer.
        let metadata = match fs::metadata(path) {
            Ok(metadata) => metadata,
            Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
                return Ok(None);
            }
            Err(e) => return Err(io(e)),
        };
        if metadata.is_dir() {
            return Ok(None);
        }
        if !metadata.is_file() {
            return Err(HostError::Io {
                name: shown,
                message: "this is a device or pipe, not a regular file".to_owned(),
            });
        }
        let limit = self.max_file;
        if metadata.len() > limit {
            return Err(HostError::TooLarge { name: shown, limit });
        }
        if let Some(source) = Source::large(path).map_err(io)? {
            return Ok(Some(source));
        }
        let file = fs::File::open(path).map_err(io)?;
        let mut bytes = Vec::with_capacity(metadata.len() as usize);
        file.take(limit + 1).read_to_end(&mut bytes).map_err(io)?;
        if bytes.len() as u64 > limit {
            return Err(HostError::TooLarge { name: shown, limit });
        }
        Ok(Some(Source::new(shown, bytes)))
    }
}

impl Host for FolderHost {
    fn load(&mut self, name: &str, from: &str) -> Result<Source, HostError> {
        match self.written.find(name) {
            Some(Found::Text(bytes)) => return Ok(Source::new(name, bytes)),
            Some(Found::At(path)) => {
                if let Some(source) = self.read(&path)? {
                    return Ok(source);
                }
            }
            None => {}
        }
        if let Some(found) = self.find_pinned(Lookup::File, name, from) {
            return found;
        }
        let beside = Path::new(from).parent().map(Path::to_path_buf);
        let written = self.written.folder().filter(|f| f.is_dir());
        let all = beside
            .into_iter()
            .chain(self.library.clone())
            .chain(written.map(Path::to_path_buf));
        let mut folders = Vec::<PathBuf>::new();
        for folder in all {
            // The current folder has two names.
            let folder = match folder == Path::new(".") {
                true => PathBuf::new(),
                false => folder,
            };
            if !folders.contains(&folder) {
                folders.push(folder);
            }
        }
        self.search(name, &folders)
    }

    fn load_installed(&mut self, name: &str) -> Result<Source, HostError> {
        if let Some(found) = self.find_pinned(Lookup::Installed, name, "") {
            return found;
        }
        self.search(name, &self.installed)
    }

    fn load_font(&mut self, file: &str) -> Result<Option<Source>, HostError> {
        match self.find_pinned(Lookup::Font, file, "") {
            Some(Err(HostError::NotFound { .. })) => return Ok(None),
            Some(found) => return found.map(Some),
            None => {}
        }
        let Some(path) = self.fonts.find(file) else {
            return Ok(None);
        };
        self.read(&path)
    }

    fn create(&mut self, name: &str, append: bool) -> Result<Box<dyn Write + Send>, HostError> {
        self.written.create(name, append)
    }

    fn message(&mut self, stream: Stream, text: &str) {
        if let Some(f) = &mut self.on_message {
            f(stream, text);
        }
    }

    fn stops(&self) -> bool {
        let stop = self.stop.as_ref();
        stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
    }

    fn now(&mut self) -> f64 {
        self.now.unwrap_or_else(present)
    }
}

/// The value of `now` at this moment: the days since the beginning of 2000.
pub fn present() -> f64 {
    /// Seconds from 1970 to 2000.
    const EPOCH: f64 = 946_684_800.0;
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    since.map_or(0.0, |d| (d.as_secs_f64() - EPOCH) / 86_400.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_read_instead_of_the_files_found_under_their_paths() {
        let root = tempfile::tempdir().unwrap();
        let at = |name: &str| root.path().join(name);
        fs::write(at("a.inc"), "old").unwrap();
        let from = at("scene.pov").display().to_string();
        let texts = Texts::from([(at("a.inc"), "new".into()), (at("b.inc"), "no file".into())]);
        let mut host = FolderHost::new([]).with_texts(texts);
        let mut read = |name: &str| host.load(name, &from).unwrap().into_bytes().unwrap();
        assert_eq!(read("a.inc"), b"new");
        assert_eq!(read("b.inc"), b"no file");
        assert!(host.load("c.inc", &from).is_err());
    }

    #[test]
    fn pinned_files_are_the_only_ones() {
        let root = tempfile::tempdir().unwrap();
        let at = |name: &str| root.path().join(name);
        for name in ["a.inc", "b.inc", "c.ttf"] {
            fs::write(at(name), name).unwrap();
        }
        let from = at("scene.pov").display().to_string();
        let pin = |lookup, name: &str, from: &str, file| {
            ((lookup, name.to_owned(), from.to_owned()), at(file))
        };
        let mut host = FolderHost::new([root.path().to_path_buf()])
            .with_fonts([root.path().to_path_buf()])
            .pinned(Pinned::from([
                pin(Lookup::File, "x.inc", &from, "b.inc"),
                pin(Lookup::Font, "font.ttf", "", "c.ttf"),
            ]));
        let found = host.load("x.inc", &from).unwrap();
        assert_eq!(found.into_bytes().unwrap(), b"b.inc");
        // It is there, but was not there where the scene was recorded.
        assert!(matches!(
            host.load("a.inc", &from),
            Err(HostError::NotFound { .. })
        ));
        assert!(host.load("x.inc", "other.pov").is_err());
        assert!(host.load_installed("a.inc").is_err());
        assert!(host.load_font("font.ttf").unwrap().is_some());
        assert!(host.load_font("c.ttf").unwrap().is_none());
    }

    #[test]
    fn beside_the_file_first_then_the_libraries() {
        let root = tempfile::tempdir().unwrap();
        for (folder, text) in [("a", "1"), ("b", "2")] {
            fs::create_dir(root.path().join(folder)).unwrap();
            fs::write(root.path().join(folder).join("x.inc"), text).unwrap();
        }
        let mut host = FolderHost::new([root.path().join("b")]);
        let from = root.path().join("a/scene.pov").display().to_string();
        assert_eq!(
            host.load("x.inc", &from).unwrap().into_bytes().unwrap(),
            b"1"
        );
        assert_eq!(host.load("x.inc", "").unwrap().into_bytes().unwrap(), b"2");
        let missing = host.load("y.inc", &from).unwrap_err();
        assert!(matches!(missing, HostError::NotFound { searched, .. } if searched.len() == 2));
        let mut small = FolderHost::new([root.path().join("b")]).limit_file_size(0);
        assert!(matches!(
            small.load("x.inc", ""),
            Err(HostError::TooLarge { .. })
        ));
    }

    #[test]
    fn installed_files_are_another_question() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join("x.inc"), "1").unwrap();
        let mut host = FolderHost::new([]).with_installed([root.path().to_owned()]);
        assert!(host.load("x.inc", "").is_err());
        assert_eq!(
            host.load_installed("x.inc").unwrap().into_bytes().unwrap(),
            b"1"
        );
        assert!(FolderHost::new([]).load_installed("x.inc").is_err());
    }

    #[test]
    fn what_a_scene_writes_it_reads_again() {
        let root = tempfile::tempdir().unwrap();
        let path = |name: &str| root.path().join(name);
        fs::write(path("x.inc"), "the user's").unwrap();
        let from = path("scene.pov").display().to_string();
        for place in [Writing::Memory, Writing::Own(path("scene.out"))] {
            let mut host = FolderHost::new([]).allow_writing(place);
            let text = |host: &mut FolderHost| {
                let source = host.load("x.inc", &from).unwrap();
                source.into_bytes().unwrap()
            };
            assert_eq!(text(&mut host), b"the user's");
            let mut file = host.create("x.inc", false).unwrap();
            file.write_all(b"the scene's").unwrap();
            file.flush().unwrap();
            assert_eq!(text(&mut host), b"the scene's");
        }
        assert_eq!(fs::read(path("x.inc")).unwrap(), b"the user's");
        // A later run finds it where no other file has that name.
        fs::remove_file(path("x.inc")).unwrap();
        let mut host = FolderHost::new([]).allow_writing(Writing::Own(path("scene.out")));
        assert!(host.load("x.inc", &from).is_ok());
        assert!(FolderHost::new([]).load("x.inc", &from).is_err());
    }
}
