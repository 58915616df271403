//! The scenes that are part of the program.

use rust_embed::Embed;
use std::io;
use std::path::PathBuf;
use tempfile::TempDir;

#[derive(Embed)]
#[folder = "../../scenes/"]
struct Scenes;

/// The scenes that are part of the program, as files in a temporary folder, which is removed with it.
#[derive(Debug)]
pub(crate) struct Builtin {
    folder: TempDir,
    names: Vec<String>,
}

impl Builtin {
    /// Writes the scenes into a temporary folder.
    ///
    /// # Errors
    /// Those of writing files.
    pub(crate) fn unpack() -> io::Result<Self> {
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

    /// The scenes that pages may ask for. It doesn't keep their files.
    pub(crate) fn offered(&self) -> Offered {
        Offered {
            folder: self.folder.path().to_owned(),
            names: self.names.clone(),
        }
    }
}

/// Scenes that pages may ask for.
#[derive(Clone, Debug)]
pub(crate) struct Offered {
    folder: PathBuf,
    names: Vec<String>,
}

impl Offered {
    /// The names of the scenes: `lecture/01_principle.pov`.
    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }

    /// The file of a scene.
    pub(crate) fn path(&self, name: &str) -> Option<PathBuf> {
        let known = self.names.iter().any(|n| n == name);
        known.then(|| self.folder.join(name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_found_by_their_names_and_nothing_else_is() {
        let scenes = Builtin::unpack().unwrap();
        let offered = scenes.offered();
        assert!(offered.names().len() > 100);
        let first = offered.path("lecture/01_principle.pov").unwrap();
        assert!(first.is_file());
        for bad in ["../secret.pov", "/etc/passwd", "lecture", ""] {
            assert!(offered.path(bad).is_none(), "{bad}");
        }
        // Who knows of the scenes doesn't keep them.
        drop(scenes);
        assert!(!first.exists());
    }
}
