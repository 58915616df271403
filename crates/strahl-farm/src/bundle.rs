//! A scene with everything it reads, in one folder.

use crate::hex;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use strahl::Inputs;
use strahl::formats::image::write_bytes;
use strahl::sdl::{Lookup, Pinned};

/// How a file of a bundle is found.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
struct Entry {
    /// `file`, `font` or `installed`.
    lookup: String,
    /// The name in the scene.
    name: String,
    /// The file with the name in it: one of the bundle, or the name of a built-in one; empty for fonts and installed files.
    from: String,
    /// The file in the bundle.
    file: String,
}

/// The table of a bundle.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bundle {
    /// The scene's file.
    pub scene: String,
    files: Vec<Entry>,
}

/// The table's name in the bundle's folder.
const TABLE: &str = "bundle.json";

impl Bundle {
    /// Copies a scene and everything it reads (in any of its frames) into a new folder. Files from the scene's folder keep their places,
    /// others go to `elsewhere`.
    ///
    /// # Errors
    /// A file can't be read or written.
    pub fn create(inputs: &[Inputs], to: &Path) -> io::Result<Self> {
        let Some(scene) = inputs.first().map(|inputs| &inputs.scene) else {
            return Ok(Self::default());
        };
        let real = fs::canonicalize(scene)?;
        let home = real.parent().unwrap_or(Path::new("/")).to_path_buf();
        let mut copies = Copies {
            home,
            to: to.to_path_buf(),
            names: BTreeMap::new(),
        };
        let mut bundle = Self {
            scene: copies.copy(scene, "")?,
            files: vec![],
        };
        let reads = inputs.iter().flat_map(|inputs| &inputs.record.reads);
        for read in reads.clone() {
            copies.copy(&read.found, &hex(&read.sha256[..4]))?;
        }
        for read in reads {
            let entry = Entry {
                lookup: lookup_name(read.lookup).to_owned(),
                name: read.name.clone(),
                from: copies.names.get(&read.from).unwrap_or(&read.from).clone(),
                file: copies.names.get(&read.found).cloned().unwrap_or_default(),
            };
            bundle.files.push(entry);
        }
        bundle.files.sort();
        bundle.files.dedup();
        let mut json = serde_json::to_vec_pretty(&bundle)?;
        json.push(b'\n');
        write_bytes(to.join(TABLE), &json).map_err(io::Error::other)?;
        Ok(bundle)
    }

    /// Reads the table of a bundle's folder.
    ///
    /// # Errors
    /// There is none, or it is damaged.
    pub fn read(folder: &Path) -> io::Result<Self> {
        Ok(serde_json::from_slice(&fs::read(folder.join(TABLE))?)?)
    }

    /// The number of files, without the scene.
    pub fn len(&self) -> usize {
        let names: std::collections::BTreeSet<&String> =
            self.files.iter().map(|f| &f.file).collect();
        names.len()
    }

    /// Whether the scene reads no files.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// Where the scene finds its files, if the bundle is in this folder.
    pub fn pinned(&self, folder: &Path) -> Pinned {
        let shown = |file: &str| folder.join(file).display().to_string();
        let own: std::collections::BTreeSet<&str> = self
            .files
            .iter()
            .map(|entry| &*entry.file)
            .chain([&*self.scene])
            .collect();
        let mut pinned = Pinned::new();
        for entry in &self.files {
            let from = match own.contains(&*entry.from) {
                true => shown(&entry.from),
                false => entry.from.clone(),
            };
            let lookup = match &*entry.lookup {
                "font" => Lookup::Font,
                "installed" => Lookup::Installed,
                _ => Lookup::File,
            };
            pinned.insert((lookup, entry.name.clone(), from), folder.join(&entry.file));
        }
        pinned
    }
}

fn lookup_name(lookup: Lookup) -> &'static str {
    match lookup {
        Lookup::File => "file",
        Lookup::Font => "font",
        Lookup::Installed => "installed",
    }
}

/// The files that were copied.
struct Copies {
    /// The scene's folder.
    home: PathBuf,
    to: PathBuf,
    /// Their names in the bundle.
    names: BTreeMap<String, String>,
}

impl Copies {
    fn copy(&mut self, found: &str, hash: &str) -> io::Result<String> {
        if let Some(known) = self.names.get(found) {
            return Ok(known.clone());
        }
        let about = |error: io::Error| io::Error::new(error.kind(), format!("{found}: {error}"));
        let real = fs::canonicalize(found).map_err(about)?;
        let name = match real.strip_prefix(&self.home) {
            Ok(inside) => inside.to_path_buf(),
            Err(_) => {
                let name = real.file_name().unwrap_or_default().to_string_lossy();
                Path::new("elsewhere").join(format!("{hash}-{name}"))
            }
        };
        let to = self.to.join(&name);
        if let Some(folder) = to.parent() {
            fs::create_dir_all(folder)?;
        }
        fs::copy(&real, &to).map_err(about)?;
        let name = name.display().to_string();
        self.names.insert(found.to_owned(), name.clone());
        Ok(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl::{LoadOptions, load_path};

    #[test]
    fn a_bundle_is_read_without_the_files_it_was_made_of() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for name in ["home/parts", "library", "job"] {
            fs::create_dir_all(at(name)).unwrap();
        }
        fs::write(
            at("home/scene.pov"),
            "#include \"parts/a.inc\" #include \"l.inc\" #include \"../other.inc\" #include \"colors.inc\" sphere { 0, A + L + O }",
        )
        .unwrap();
        fs::write(at("home/parts/a.inc"), "#include \"b.inc\"").unwrap();
        fs::write(at("home/parts/b.inc"), "#declare A = 1;").unwrap();
        fs::write(at("library/l.inc"), "#declare L = 2;").unwrap();
        fs::write(at("other.inc"), "#declare O = 3;").unwrap();
        let options = || LoadOptions {
            record: true,
            ..LoadOptions::default()
        };
        let recorded = load_path(
            &at("home/scene.pov"),
            LoadOptions {
                library: vec![at("library")],
                ..options()
            },
        );
        let inputs = recorded.inputs.unwrap();
        assert!(recorded.scene.is_some(), "{:?}", recorded.diagnostics);
        let bundle = Bundle::create(std::slice::from_ref(&inputs), &at("job")).unwrap();
        assert_eq!((&*bundle.scene, bundle.len()), ("scene.pov", 4));
        fs::remove_dir_all(at("home")).unwrap();
        fs::remove_dir_all(at("library")).unwrap();
        fs::rename(at("job"), at("moved")).unwrap();
        let again = load_path(
            &at("moved/scene.pov"),
            LoadOptions {
                pinned: Some(Bundle::read(&at("moved")).unwrap().pinned(&at("moved"))),
                ..options()
            },
        );
        assert!(again.scene.is_some(), "{:?}", again.diagnostics);
        assert_eq!(again.inputs.unwrap().identity(), inputs.identity());
    }
}
