use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Folders with fonts, listed on first use.
#[derive(Debug, Default)]
pub(super) struct FontFolders {
    roots: Vec<PathBuf>,
    /// Fonts by file name in lower case; of equal names the first one found.
    files: Option<BTreeMap<String, PathBuf>>,
}

/// The nesting depth that is searched; font folders have two or three levels.
const DEPTH: usize = 6;

/// The largest number of directory entries that are read, so that searching a folder with other contents ends.
const ENTRIES: usize = 100_000;

impl FontFolders {
    pub(super) fn new(roots: impl IntoIterator<Item = PathBuf>) -> Self {
        Self {
            roots: roots.into_iter().collect(),
            files: None,
        }
    }

    /// The font with this file name, ignoring case.
    pub(super) fn find(&mut self, file: &str) -> Option<PathBuf> {
        let Self { roots, files } = self;
        let files = files.get_or_insert_with(|| {
            let (mut found, mut left) = (BTreeMap::new(), ENTRIES);
            for root in roots {
                list(root, DEPTH, &mut left, &mut found);
            }
            found
        });
        files.get(&file.to_ascii_lowercase()).cloned()
    }
}

fn list(folder: &Path, depth: usize, left: &mut usize, found: &mut BTreeMap<String, PathBuf>) {
    // A folder that does not exist has no fonts.
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
    // The system lists files in an arbitrary order.
    paths.sort();
    for path in paths {
        let Some(rest) = left.checked_sub(1) else {
            return;
        };
        *left = rest;
        if path.is_dir() {
            if depth > 0 {
                list(&path, depth - 1, left, found);
            }
            continue;
        }
        let name = path.file_name().unwrap_or_default();
        let name = name.to_string_lossy().to_ascii_lowercase();
        let ending = name.rsplit('.').next().unwrap_or_default();
        if matches!(ending, "ttf" | "otf" | "ttc" | "otc") {
            found.entry(name).or_insert(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fonts_are_found_in_any_depth_and_case() {
        let root = tempfile::tempdir().unwrap();
        let deep = root.path().join("truetype/family");
        fs::create_dir_all(&deep).unwrap();
        for file in ["Some-Bold.TTF", "readme.txt"] {
            fs::write(deep.join(file), "").unwrap();
        }
        let missing = root.path().join("missing");
        let mut folders = FontFolders::new([missing, root.path().to_path_buf()]);
        assert_eq!(
            folders.find("some-bold.ttf"),
            Some(deep.join("Some-Bold.TTF"))
        );
        assert_eq!(folders.find("readme.txt"), None);
        assert_eq!(folders.find("other.ttf"), None);
    }
}
