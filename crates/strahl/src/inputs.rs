//! Everything that a scene consists of.

use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;
use strahl_sdl::{Lookup, Read, Record};

/// Everything that a scene consists of: its text, the files it has read, and what it did besides.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inputs {
    /// The scene's file, or its name if it has none.
    pub scene: String,
    /// SHA-256 of the scene's text.
    pub sha256: [u8; 32],
    /// The files it has read and written, and whether it has read the time.
    pub record: Record,
}

impl Inputs {
    /// A scene of these files; their names are paths from the scene's folder.
    pub(crate) fn of_files(scene: &Path, files: &[String]) -> io::Result<Self> {
        let folder = scene.parent().unwrap_or(Path::new(""));
        let shown = scene.display().to_string();
        let mut record = Record::default();
        for name in files {
            let path = folder.join(name);
            record.reads.push(Read {
                lookup: Lookup::File,
                name: name.clone(),
                from: shown.clone(),
                found: path.display().to_string(),
                sha256: digest_of(&path)?,
            });
        }
        Ok(Self {
            sha256: digest_of(scene)?,
            scene: shown,
            record,
        })
    }

    /// SHA-256 of the contents of scene and files and of the names by which they are read, in hexadecimal digits: the same wherever the files
    /// are.
    pub fn identity(&self) -> String {
        let mut hasher = Sha256::new();
        hasher.update(self.sha256);
        for read in &self.record.reads {
            let lookup = match read.lookup {
                Lookup::File => b'f',
                Lookup::Font => b't',
                Lookup::Installed => b'i',
            };
            hasher.update([lookup]);
            hasher.update((read.name.len() as u64).to_le_bytes());
            hasher.update(&read.name);
            hasher.update(read.sha256);
        }
        let digest = hasher.finalize();
        digest.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

pub(crate) fn digest(bytes: &[u8]) -> [u8; 32] {
    Sha256::digest(bytes).into()
}

/// SHA-256 of a file.
fn digest_of(path: &Path) -> io::Result<[u8; 32]> {
    let (mut file, mut hasher) = (File::open(path)?, Sha256::new());
    let mut part = vec![0; 1 << 20];
    loop {
        match file.read(&mut part)? {
            0 => return Ok(hasher.finalize().into()),
            count => hasher.update(&part[..count]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Format, LoadOptions, load_bytes, load_path};

    fn options() -> LoadOptions {
        LoadOptions {
            record: true,
            ..LoadOptions::default()
        }
    }

    fn identity(path: &Path) -> String {
        let inputs = load_path(path, options()).inputs;
        inputs.expect("it is asked for").identity()
    }

    #[test]
    fn a_scene_is_the_same_in_another_folder_and_another_one_with_another_include() {
        let (a, b) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let text = "#include \"ball.inc\" #include \"colors.inc\" sphere { 0, R }";
        for folder in [&a, &b] {
            std::fs::write(folder.path().join("scene.pov"), text).unwrap();
            std::fs::write(folder.path().join("ball.inc"), "#declare R = 1;").unwrap();
        }
        let (in_a, in_b) = (a.path().join("scene.pov"), b.path().join("scene.pov"));
        assert_eq!(identity(&in_a), identity(&in_b));
        std::fs::write(b.path().join("ball.inc"), "#declare R = 2;").unwrap();
        assert_ne!(identity(&in_a), identity(&in_b));
    }

    #[test]
    fn materials_beside_a_mesh_belong_to_it() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("m.mtl"), "newmtl red\nKd 1 0 0\n").unwrap();
        std::fs::write(
            at("a.obj"),
            "mtllib m.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        )
        .unwrap();
        let before = identity(&at("a.obj"));
        std::fs::write(at("m.mtl"), "newmtl red\nKd 1 1 0\n").unwrap();
        assert_ne!(identity(&at("a.obj")), before);
    }

    #[test]
    fn time_and_written_files_are_told() {
        let text = "#fopen F \"out.txt\" write #write(F, \"1\") #fclose F sphere { 0, 1 + now }";
        let options = LoadOptions {
            writing: strahl_sdl::Writing::Memory,
            ..options()
        };
        let loaded = load_bytes(text.into(), "scene.pov", Format::Pov, options);
        let record = loaded.inputs.expect("it is asked for").record;
        assert!(record.time && record.writes == ["out.txt"], "{record:?}");
    }
}
