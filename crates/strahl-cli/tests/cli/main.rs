//! Runs the program as users do.

#[path = "../common/mod.rs"]
mod common;
mod errors;
mod explain;
mod factors;
mod lecture;
mod pictures;
mod profile;
mod questions;
mod safety;
mod subdivide;
mod submit;
mod sums;
mod tiles;

use common::{stderr, strahl};
use serde_json::Value;
use std::path::{Path, PathBuf};

const SCENE: &str = "\
b 0.1 0.2 0.4
v
from 0 1 6
at 0 0 0
up 0 1 0
angle 40
hither 0.1
resolution 48 40
l 5 6 7
f 0.9 0.8 0.7 0.7 0.3 20 0 1
s 0 0 0 1
f 1 1 1 0.1 0.1 50 0.8 1.5
s 1.5 0 1 0.6
f 0.4 0.6 0.4 0.9 0 1 0 1
p 4
-4 -1 4
4 -1 4
4 -1 -4
-4 -1 -4
";

fn folder_with_scene() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("scene.nff"), SCENE).expect("writable");
    folder
}

fn stats(folder: &Path, args: &[&str]) -> Value {
    let all = [
        &[
            "render",
            "scene.nff",
            "-o",
            "out.png",
            "--quiet",
            "--stats",
            "stats.json",
        ],
        args,
    ]
    .concat();
    let output = strahl(folder, &all);
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(
        output.stderr.is_empty(),
        "quiet means quiet: {}",
        stderr(&output)
    );
    let bytes = std::fs::read(folder.join("stats.json")).expect("written");
    serde_json::from_slice(&bytes).expect("JSON")
}

/// Runs a command that must fail with one clear message and leave no file behind.
fn fails(folder: &Path, args: &[&str], code: i32, parts: &[&str]) {
    let before = listing(folder);
    let output = strahl(folder, args);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{args:?}: {message}");
    for part in parts {
        assert!(
            message.contains(part),
            "{args:?} should mention {part:?}: {message}"
        );
    }
    assert!(!message.contains("panicked"), "{message}");
    assert_eq!(message.matches("error").count(), 1, "one error: {message}");
    assert_eq!(listing(folder), before, "{args:?} left something behind");
}

fn listing(folder: &Path) -> Vec<PathBuf> {
    let mut names: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("a folder")
        .map(|e| e.expect("readable").path())
        .collect();
    names.sort();
    names
}

/// Prints that a test, or a part of it, did not run.
#[expect(
    clippy::print_stdout,
    reason = "a skipped test must leave a visible line"
)]
fn skipped(why: &str) {
    println!("skipped: {why}");
}

/// A program to compare with; without it the caller skips its test, unless the environment requires all tools.
fn tool(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let found = std::env::split_paths(&path)
        .map(|folder| folder.join(name))
        .find(|p| p.is_file());
    if found.is_none() {
        assert!(
            std::env::var_os("STRAHL_REQUIRE_TOOLS").is_none(),
            "{name} is missing, but required"
        );
        skipped(&format!("{name} is not installed"));
    }
    found
}
