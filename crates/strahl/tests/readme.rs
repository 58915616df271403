//! The Rust program of the README: its copy in `readme/glass.rs` is the same, and runs.
#![allow(clippy::print_stderr, reason = "the program shows its progress")]

include!("readme/glass.rs");

/// A program without what rustfmt does to long lines.
fn on_one_line(program: &str) -> String {
    let words: String = program.split_whitespace().collect();
    words.replace(",)", ")")
}

#[test]
fn the_program_of_the_readme_writes_its_picture() {
    let readme = on_one_line(include_str!("../../../README.md"));
    assert!(readme.contains(&on_one_line(include_str!("readme/glass.rs"))));
    // The program writes to the current folder. No other test runs in this process.
    let folder = tempfile::tempdir().expect("a folder");
    std::env::set_current_dir(&folder).expect("exists");
    main().expect("a picture");
    let written = std::fs::read("glass.png").expect("a file");
    assert_eq!(written[..8], *b"\x89PNG\r\n\x1a\n");
    assert_eq!(written[16..24], [0, 0, 2, 128, 0, 0, 1, 224]);
}
