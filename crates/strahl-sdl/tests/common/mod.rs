//! Functions for several tests; each test uses some of them.
#![allow(dead_code, reason = "each test binary uses a part of this")]

pub(crate) mod pictures;
pub(crate) mod pixel;

use std::path::PathBuf;
use strahl_sdl::{MemoryHost, Options, Parsed, Source, Stream, parse};

/// Parses a text with files in memory.
pub(crate) fn parse_with(host: &mut MemoryHost, text: &str) -> Parsed {
    parse(Source::new("test.pov", text), &Options::default(), host)
}

/// The `#debug` output of a text without errors.
pub(crate) fn debug(text: &str) -> String {
    let mut host = MemoryHost::new();
    let parsed = parse_with(&mut host, text);
    let errors: Vec<String> = parsed.diagnostics.iter().map(ToString::to_string).collect();
    assert!(parsed.scene.is_some(), "{text}\n{}", errors.join("\n"));
    host.text(Stream::Debug)
}

/// The messages of a text with at least one error.
pub(crate) fn errors(text: &str) -> Vec<String> {
    let parsed = parse_with(&mut MemoryHost::new(), text);
    let shown: String = text.chars().take(200).collect();
    assert!(parsed.scene.is_none(), "no error in: {shown}");
    let errors = parsed.diagnostics.iter().filter(|d| d.is_error());
    errors.map(ToString::to_string).collect()
}

/// A program to compare with; without it the caller skips its test, unless the environment requires all tools.
pub(crate) fn tool(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let found = std::env::split_paths(&path)
        .map(|folder| folder.join(name))
        .find(|p| p.is_file());
    if found.is_none() {
        assert!(
            std::env::var_os("STRAHL_REQUIRE_TOOLS").is_none(),
            "{name} is missing, but required"
        );
        use std::io::Write;
        let _ = writeln!(std::io::stderr().lock(), "SKIPPED: {name} is not installed");
    }
    found
}

/// The results of `f` for all items, in order, computed by several threads, because most of the time is spent waiting for other
/// programs.
pub(crate) fn each<T: Sync, R: Send>(items: &[T], f: impl Fn(&T) -> R + Sync) -> Vec<R> {
    const THREADS: usize = 6;
    let part = items.len().div_ceil(THREADS).max(1);
    std::thread::scope(|scope| {
        let f = &f;
        let work = |part| scope.spawn(move || <[T]>::iter(part).map(f).collect::<Vec<R>>());
        let threads: Vec<_> = items.chunks(part).map(work).collect();
        let done = threads.into_iter().map(|t| t.join().expect("no panic"));
        done.flatten().collect()
    })
}
