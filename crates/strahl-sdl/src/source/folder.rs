use super::fonts::FontFolders;
use super::{Host, HostError, Source, Stream};
use std::fs;
use std::io::{BufWriter, ErrorKind, Read, Write};
use std::path::{Component, Path, PathBuf};
use std::time::SystemTime;

/// Who takes the messages of scenes.
type Listener = dyn FnMut(Stream, &str) + Send;

/// Files in folders of the disk.
///
/// A file is searched beside the file that names it, then in the library folders in order. Scenes write only into the
/// folder allowed, none at first. Messages of the scene go to the function given, or nowhere.
pub struct FolderHost {
    library: Vec<PathBuf>,
    fonts: FontFolders,
    installed: Vec<PathBuf>,
    writable: Option<PathBuf>,
    max_file: u64,
    on_message: Option<Box<Listener>>,
    now: Option<f64>,
}

impl std::fmt::Debug for FolderHost {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FolderHost")
            .field("library", &self.library)
            .field("installed", &self.installed)
            .field("writable", &self.writable)
            .field("max_file", &self.max_file)
            .finish_non_exhaustive()
    }
}

impl FolderHost {
    /// Searches these folders after the one of the file that asks.
    pub fn new(library: impl IntoIterator<Item = PathBuf>) -> Self {
        Self {
            library: library.into_iter().collect(),
            fonts: FontFolders::default(),
            installed: vec![],
            writable: None,
            max_file: u64::from(u32::MAX) - 1,
            on_message: None,
            now: None,
        }
    }

    /// Searches these folders, and the folders in them, for fonts that are not found elsewhere.
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

    /// Lets scenes write files within this folder; the names they give are taken relative to it.
    #[must_use]
    pub fn allow_writing(mut self, folder: impl Into<PathBuf>) -> Self {
        self.writable = Some(folder.into());
        self
    }

    /// Largest file read, in bytes; at most 4 GiB.
    #[must_use]
    pub fn limit_file_size(mut self, bytes: u64) -> Self {
        self.max_file = self.max_file.min(bytes);
        self
    }

    /// Hands the messages of scenes to a function.
    #[must_use]
    pub fn on_message(mut self, f: impl FnMut(Stream, &str) + Send + 'static) -> Self {
        self.on_message = Some(Box::new(f));
        self
    }

    /// Fixes the time that `now` gives, in days since the beginning of 2000.
    #[must_use]
    pub fn at_time(mut self, days: f64) -> Self {
        self.now = Some(days);
        self
    }

    /// Looks for a file in folders, in order.
    fn search(&self, name: &str, folders: &[PathBuf]) -> Result<Source, HostError> {
        // Scenes from Windows write backslashes.
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
        let io = |error: std::io::Error| HostError::Io {
            name: shown.clone(),
            message: error.to_string(),
        };
        // Asked before opening, which waits for a writer where the name is a pipe.
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
                message: "this is a device or pipe, no plain file".to_owned(),
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
        let beside = Path::new(from).parent().map(Path::to_path_buf);
        let folders: Vec<PathBuf> = beside.into_iter().chain(self.library.clone()).collect();
        self.search(name, &folders)
    }

    fn load_installed(&mut self, name: &str) -> Result<Source, HostError> {
        self.search(name, &self.installed)
    }

    fn load_font(&mut self, file: &str) -> Result<Option<Source>, HostError> {
        let Some(path) = self.fonts.find(file) else {
            return Ok(None);
        };
        self.read(&path)
    }

    fn create(&mut self, name: &str, append: bool) -> Result<Box<dyn Write + Send>, HostError> {
        let forbidden = |why: &str| HostError::Forbidden {
            name: name.to_owned(),
            why: why.to_owned(),
        };
        let path = Path::new(name);
        let plain = |c: Component<'_>| matches!(c, Component::Normal(_) | Component::CurDir);
        if !path.components().all(plain) || name.contains('\\') {
            return Err(forbidden(
                "the name must be relative and must not contain `..`",
            ));
        }
        let Some(folder) = &self.writable else {
            return Err(forbidden("no folder is open for writing"));
        };
        let io = |error: std::io::Error| HostError::Io {
            name: name.to_owned(),
            message: error.to_string(),
        };
        let target = folder.join(path);
        // A link inside of the folder must not lead out of it.
        let parent = target.parent().unwrap_or(folder);
        let real = parent.canonicalize().map_err(io)?;
        if !real.starts_with(folder.canonicalize().map_err(io)?) {
            return Err(forbidden("a link leads out of the folder"));
        }
        if fs::symlink_metadata(&target).is_ok_and(|m| !m.is_file()) {
            return Err(forbidden("there is something that is no plain file"));
        }
        let mut options = fs::OpenOptions::new();
        options.create(true).write(true);
        if append {
            options.append(true);
        } else {
            options.truncate(true);
        }
        let file = options.open(&target).map_err(io)?;
        Ok(Box::new(BufWriter::new(file)))
    }

    fn message(&mut self, stream: Stream, text: &str) {
        if let Some(f) = &mut self.on_message {
            f(stream, text);
        }
    }

    fn now(&mut self) -> f64 {
        /// Seconds from 1970 to 2000.
        const EPOCH: f64 = 946_684_800.0;
        self.now.unwrap_or_else(|| {
            let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
            since.map_or(0.0, |d| (d.as_secs_f64() - EPOCH) / 86_400.0)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn nothing_is_written_outside_of_the_folder() {
        let root = tempfile::tempdir().unwrap();
        let inside = root.path().join("inside");
        fs::create_dir(&inside).unwrap();
        let mut host = FolderHost::new([]);
        assert!(matches!(
            host.create("a.txt", false),
            Err(HostError::Forbidden { .. })
        ));
        let mut host = host.allow_writing(&inside);
        let absolute = root.path().join("b.txt").display().to_string();
        for name in ["../b.txt", "c/../../b.txt", absolute.as_str(), "..\\b.txt"] {
            assert!(
                matches!(host.create(name, false), Err(HostError::Forbidden { .. })),
                "{name}"
            );
        }
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(root.path(), inside.join("out")).unwrap();
            std::os::unix::fs::symlink(root.path().join("b.txt"), inside.join("link")).unwrap();
            for name in ["out/b.txt", "link"] {
                assert!(host.create(name, false).is_err(), "{name}");
            }
        }
        assert!(!root.path().join("b.txt").exists());
        host.create("a.txt", false)
            .unwrap()
            .write_all(b"1")
            .unwrap();
        host.create("a.txt", true).unwrap().write_all(b"2").unwrap();
        assert_eq!(fs::read(inside.join("a.txt")).unwrap(), b"12");
    }
}
