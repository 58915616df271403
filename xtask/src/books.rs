//! Tests of what the repository's books say of its files.

use std::fs;
use std::path::{Path, PathBuf};

/// Files that stand for whatever somebody adds.
const PLACEHOLDERS: &[&str] = &[
    "<family>/x.rs",
    "commands/x.rs",
    "image/x.rs",
    "objects/x.rs",
    "patterns/x.rs",
    "scene/x.rs",
    "strahl-accel/src/x.rs",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Adds the files with this ending below a folder.
fn add_files(folder: &Path, ending: &str, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            add_files(&path, ending, files);
        } else if path.extension().is_some_and(|e| e == ending) {
            files.push(path);
        }
    }
}

/// The books: what people read to find their way.
fn books() -> Vec<PathBuf> {
    let mut books = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"]
        .map(|name| root().join(name))
        .to_vec();
    add_files(&root().join("docs/src"), "md", &mut books);
    books
}

/// The source files of the workspace.
fn sources() -> Vec<PathBuf> {
    let mut sources = Vec::new();
    for folder in ["crates", "xtask/src", "fuzz/fuzz_targets"] {
        add_files(&root().join(folder), "rs", &mut sources);
    }
    sources
}

/// The names of source files in a text.
fn source_files(text: &str) -> impl Iterator<Item = &str> {
    let is_part = |c: char| c.is_alphanumeric() || "_-./<>".contains(c);
    let words = text.split(move |c| !is_part(c));
    words
        .map(|word| word.trim_end_matches('.'))
        .filter(|word| word.ends_with(".rs"))
}

#[test]
fn source_files_that_books_name_exist() {
    let sources = sources();
    let (mut named, mut missing) = (0, Vec::new());
    for book in books() {
        let text = fs::read_to_string(&book).unwrap();
        for name in source_files(&text) {
            named += 1;
            let exists = sources.iter().any(|path| path.ends_with(name));
            let stands_for = PLACEHOLDERS.iter().any(|p| Path::new(name).ends_with(p));
            if !exists && !stands_for {
                missing.push(format!("{}: {name}", book.display()));
            }
        }
    }
    assert!(named > 50, "only {named} names were found");
    assert!(missing.is_empty(), "these files don't exist: {missing:#?}");
}
