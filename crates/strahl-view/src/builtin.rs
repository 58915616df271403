//! The scenes that are part of the program.

use rust_embed::Embed;
use std::io;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

#[derive(Embed)]
#[folder = "../../scenes/"]
struct Scenes;

/// The scenes that are part of the program, as files in a temporary folder, which is removed with it.
#[derive(Debug)]
pub struct Builtin {
    folder: TempDir,
    names: Vec<String>,
}

impl Builtin {
    /// Writes the scenes into a temporary folder.
    ///
    /// # Errors
    /// Those of writing files.
    pub fn unpack() -> io::Result<Self> {
        let folder = tempfile::Builder::new().prefix("strahl-scenes").tempdir()?;
        let mut names = vec![];
        for name in Scenes::iter() {
            let Some(file) = Scenes::get(&name) else {
                continue;
            };
            let path = folder.path().join(&*name);
            if let Some(parent) = path.parent() {
                std::fs::create_dir_all(parent)?;
            }
            std::fs::write(&path, &file.data)?;
            let shown = ["showcase/", "lecture/", "gallery/"];
            if shown.iter().any(|s| name.starts_with(s)) && name.ends_with(".pov") {
                names.push(name.into_owned());
            }
        }
        names.sort();
        Ok(Self { folder, names })
    }

    /// The names of the scenes: `lecture/01_principle.pov`.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The file of a scene.
    pub fn path(&self, name: &str) -> Option<PathBuf> {
        let known = self.names.iter().any(|n| n == name);
        known.then(|| self.folder.path().join(name))
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_found_by_their_names_and_nothing_else_is() {
        let scenes = Builtin::unpack().unwrap();
        assert!(scenes.names().len() > 100);
        assert!(
            scenes
                .path("lecture/01_principle.pov")
                .is_some_and(|p| p.is_file())
        );
        for bad in ["../secret.pov", "/etc/passwd", "lecture", ""] {
            assert!(scenes.path(bad).is_none(), "{bad}");
        }
        let folder = scenes.folder().to_owned();
        drop(scenes);
        assert!(!folder.exists());
    }
}
