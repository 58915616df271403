//! The files that scenes may and may not write.

use super::HostError;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The place where a scene may write files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Writing {
    /// Nowhere: writing is an error.
    #[default]
    Nowhere,
    /// In memory: the scene can read the files that it has written; nothing is left of them afterwards.
    Memory,
    /// Within this folder, which exists.
    Folder(PathBuf),
    /// Within this folder, which is created when the first file is written. It must not be a link.
    Own(PathBuf),
}

/// The list of the files that scenes have written into a folder, with checksums, in the form of `sha256sum`.
const LIST: &str = ".strahl-written";

/// The files that a scene writes. A file is kept in memory while it is open and written at once when it is closed.
#[derive(Debug, Default)]
pub(super) struct Written {
    place: Writing,
    /// Files written in memory, or into the folder by this scene (then only the names matter).
    files: Arc<Mutex<BTreeMap<String, Vec<u8>>>>,
}

impl Written {
    pub(super) fn to(place: Writing) -> Self {
        Self {
            place,
            files: Arc::default(),
        }
    }

    fn files(&self) -> MutexGuard<'_, BTreeMap<String, Vec<u8>>> {
        self.files.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The folder, if there is one.
    pub(super) fn folder(&self) -> Option<&Path> {
        match &self.place {
            Writing::Folder(folder) | Writing::Own(folder) => Some(folder),
            Writing::Nowhere | Writing::Memory => None,
        }
    }

    /// A file that this scene has written: its text or its path.
    pub(super) fn find(&self, name: &str) -> Option<Found> {
        let name = plain(name)?;
        let files = self.files();
        let bytes = files.get(&name)?;
        Some(match self.folder() {
            Some(folder) => Found::At(folder.join(name)),
            None => Found::Text(bytes.clone()),
        })
    }

    /// Opens a file.
    pub(super) fn create(
        &self,
        name: &str,
        append: bool,
    ) -> Result<Box<dyn Write + Send>, HostError> {
        let forbidden = |why: &str| HostError::Forbidden {
            name: name.to_owned(),
            why: why.to_owned(),
        };
        let Some(plain) = plain(name) else {
            return Err(forbidden(
                "the name must be relative, without `..`, and no part of it may begin with a dot",
            ));
        };
        let before = match (&self.place, self.folder()) {
            (Writing::Nowhere, _) => return Err(forbidden("no folder is open for writing")),
            (_, None) => self.files().get(&plain).cloned(),
            (place, Some(folder)) => {
                prepare(place, folder).map_err(|why| forbidden(&why))?;
                existing(folder, &plain).map_err(|why| forbidden(&why))?
            }
        };
        let target = self.folder().map(|f| (f.to_owned(), f.join(&plain)));
        Ok(Box::new(Open {
            bytes: before.filter(|_| append).unwrap_or_default(),
            changed: true,
            name: plain,
            target,
            files: Arc::clone(&self.files),
        }))
    }
}

/// A file that a scene has written.
pub(super) enum Found {
    Text(Vec<u8>),
    At(PathBuf),
}

/// The name with slashes, if scenes may use it: relative, without leaving the folder, not hidden.
fn plain(name: &str) -> Option<String> {
    if name.contains(['\\', ':', '\0']) || name.contains(char::is_control) {
        return None;
    }
    let mut parts = vec![];
    for part in Path::new(name).components() {
        match part {
            Component::CurDir => {}
            Component::Normal(part) => {
                let part = part.to_str()?;
                if part.starts_with('.') {
                    return None;
                }
                parts.push(part);
            }
            _ => return None,
        }
    }
    (!parts.is_empty() && !name.ends_with('/')).then(|| parts.join("/"))
}

/// Creates the scene's own folder if it does not exist.
fn prepare(place: &Writing, folder: &Path) -> Result<(), String> {
    let shown = folder.display();
    let metadata = match place {
        Writing::Own(_) => fs::symlink_metadata(folder),
        _ => fs::metadata(folder),
    };
    match (metadata, place) {
        (Ok(m), _) if m.is_dir() => Ok(()),
        (Ok(_), _) => Err(format!("`{shown}` exists and is not a folder")),
        (Err(e), Writing::Own(_)) if e.kind() == ErrorKind::NotFound => fs::create_dir(folder)
            .map_err(|e| format!("the folder `{shown}` cannot be created: {e}")),
        (Err(e), _) => Err(format!("`{shown}`: {e}")),
    }
}

/// The content of a file before it is written, if it exists; an error if it must not be written.
fn existing(folder: &Path, name: &str) -> Result<Option<Vec<u8>>, String> {
    let target = folder.join(name);
    let parent = target.parent().unwrap_or(folder);
    let real = |path: &Path| path.canonicalize().map_err(|e| e.to_string());
    // A link within the folder must not lead out of it.
    if !real(parent)?.starts_with(real(folder)?) {
        return Err("a link leads out of the folder".to_owned());
    }
    let metadata = match fs::symlink_metadata(&target) {
        Ok(metadata) => metadata,
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(None),
        Err(e) => return Err(e.to_string()),
    };
    if !metadata.is_file() {
        return Err("something of this name exists that is not a regular file".to_owned());
    }
    let bytes = fs::read(&target).map_err(|e| e.to_string())?;
    if listed(folder, name).as_deref() != Some(checksum(&bytes).as_str()) {
        return Err(
            "a file of this name exists that no scene has written, or that was changed since; \
             remove it, or choose another folder"
                .to_owned(),
        );
    }
    Ok(Some(bytes))
}

/// The checksum of a file in the list.
fn listed(folder: &Path, name: &str) -> Option<String> {
    let list = folder.join(LIST);
    if !fs::symlink_metadata(&list).ok()?.is_file() {
        return None;
    }
    let text = fs::read_to_string(list).ok()?;
    let of_name = |line: &str| {
        let (sum, listed) = line.split_once("  ")?;
        (listed == name).then(|| sum.to_owned())
    };
    text.lines().rev().find_map(of_name)
}

/// Adds a file to the list; the last of several lines with its name counts.
fn list(folder: &Path, name: &str, bytes: &[u8]) -> io::Result<()> {
    let path = folder.join(LIST);
    if fs::symlink_metadata(&path).is_ok_and(|m| !m.is_file()) {
        let problem = format!("`{}` is not a regular file", path.display());
        return Err(io::Error::other(problem));
    }
    let mut file = OpenOptions::new().create(true).append(true).open(path)?;
    writeln!(file, "{}  {name}", checksum(bytes))
}

fn checksum(bytes: &[u8]) -> String {
    Sha256::digest(bytes)
        .iter()
        .fold(String::new(), |mut out, byte| {
            // Writing to a string never fails.
            let _ = write!(out, "{byte:02x}");
            out
        })
}

/// A file that is being written.
struct Open {
    bytes: Vec<u8>,
    /// Whether there are bytes that are not written yet.
    changed: bool,
    name: String,
    /// The folder and the file in it; `None` in memory.
    target: Option<(PathBuf, PathBuf)>,
    files: Arc<Mutex<BTreeMap<String, Vec<u8>>>>,
}

impl Write for Open {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.changed = true;
        self.bytes.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        if !std::mem::take(&mut self.changed) {
            return Ok(());
        }
        let mut kept = vec![];
        match &self.target {
            None => kept.clone_from(&self.bytes),
            Some((folder, file)) => {
                strahl_formats::image::write_bytes(file, &self.bytes).map_err(io::Error::other)?;
                list(folder, &self.name, &self.bytes)?;
            }
        }
        let mut files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        files.insert(self.name.clone(), kept);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn write(written: &Written, name: &str, append: bool, text: &str) -> Result<(), HostError> {
        let mut file = written.create(name, append)?;
        file.write_all(text.as_bytes()).unwrap();
        file.flush().unwrap();
        Ok(())
    }

    #[test]
    fn names_stay_in_the_folder_and_in_sight() {
        assert_eq!(plain("./a/b.inc").as_deref(), Some("a/b.inc"));
        for bad in [
            "",
            ".",
            "a/",
            "/a",
            "../a",
            "a/../../b",
            ".bashrc",
            "a/.git/x",
            "a\\b",
            "C:a",
            "a\nb",
        ] {
            assert_eq!(plain(bad), None, "{bad:?}");
        }
    }

    #[test]
    fn nothing_is_overwritten_that_scenes_have_not_written() {
        let root = tempfile::tempdir().unwrap();
        let at = |name: &str| root.path().join(name);
        fs::write(at("scene.pov"), "mine").unwrap();
        let written = Written::to(Writing::Folder(root.path().to_owned()));
        for name in ["scene.pov", "./scene.pov", LIST] {
            assert!(write(&written, name, false, "x").is_err(), "{name}");
            assert!(write(&written, name, true, "x").is_err(), "{name}");
        }
        assert_eq!(fs::read(at("scene.pov")).unwrap(), b"mine");
        write(&written, "a.txt", false, "1").unwrap();
        // Another run recognises the file by its checksum.
        let again = Written::to(Writing::Folder(root.path().to_owned()));
        write(&again, "a.txt", true, "2").unwrap();
        assert_eq!(fs::read(at("a.txt")).unwrap(), b"12");
        write(&again, "a.txt", false, "3").unwrap();
        assert_eq!(fs::read(at("a.txt")).unwrap(), b"3");
        // A file that the user has changed must not be overwritten.
        fs::write(at("a.txt"), "mine").unwrap();
        assert!(write(&again, "a.txt", false, "4").is_err());
        assert_eq!(fs::read(at("a.txt")).unwrap(), b"mine");
    }

    #[test]
    fn a_file_is_there_entirely_or_not_at_all() {
        let root = tempfile::tempdir().unwrap();
        let own = root.path().join("scene.out");
        let written = Written::to(Writing::Own(own.clone()));
        let mut file = written.create("a.txt", false).unwrap();
        file.write_all(b"beginning").unwrap();
        assert!(!own.join("a.txt").exists() && written.find("a.txt").is_none());
        file.flush().unwrap();
        assert_eq!(fs::read(own.join("a.txt")).unwrap(), b"beginning");
        assert!(matches!(written.find("./a.txt"), Some(Found::At(_))));
    }

    #[test]
    fn memory_leaves_nothing_behind() {
        let written = Written::to(Writing::Memory);
        write(&written, "a.txt", false, "1").unwrap();
        write(&written, "a.txt", true, "2").unwrap();
        assert!(matches!(written.find("a.txt"), Some(Found::Text(t)) if t == b"12"));
        assert!(write(&Written::default(), "a.txt", false, "1").is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_lead_nowhere() {
        use std::os::unix::fs::symlink;
        let root = tempfile::tempdir().unwrap();
        let (inside, outside) = (root.path().join("inside"), root.path().join("outside"));
        fs::create_dir(&inside).unwrap();
        fs::create_dir(&outside).unwrap();
        symlink(&outside, inside.join("out")).unwrap();
        symlink(outside.join("b.txt"), inside.join("link")).unwrap();
        let written = Written::to(Writing::Folder(inside.clone()));
        for name in ["out/b.txt", "link"] {
            assert!(write(&written, name, false, "x").is_err(), "{name}");
        }
        // Neither the list nor the scene's own folder may be a link.
        symlink(outside.join("list"), inside.join(LIST)).unwrap();
        let mut file = written.create("a.txt", false).unwrap();
        assert!(file.flush().is_err());
        symlink(&outside, root.path().join("scene.out")).unwrap();
        let own = Written::to(Writing::Own(root.path().join("scene.out")));
        assert!(write(&own, "a.txt", false, "x").is_err());
        assert_eq!(fs::read_dir(&outside).unwrap().count(), 0);
    }
}
