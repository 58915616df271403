//! Any bytes read as a scene in POV-Ray's language: no panic, no loop without end, and a scene or an error.

#![no_main]

use libfuzzer_sys::fuzz_target;
use strahl_sdl::{MemoryHost, Options, Source, parse};

fuzz_target!(|data: &[u8]| {
    let mut options = Options::default();
    options.limits.steps = 100_000;
    options.limits.array_elements = 1 << 16;
    options.limits.string_bytes = 1 << 16;
    options.limits.objects = 1 << 16;
    options.limits.depth = 200;
    options.limits.nesting = 200;
    let mut host = MemoryHost::new().with_file("a.inc", data.to_vec());
    let parsed = parse(Source::new("fuzz.pov", data), &options, &mut host);
    let failed = parsed.diagnostics.iter().any(|d| d.is_error());
    assert_eq!(failed, parsed.scene.is_none());
    assert!(parsed.diagnostics.len() < 300);
    for diagnostic in &parsed.diagnostics {
        // Placing a caret must not fail either.
        let _ = diagnostic.to_string();
    }
});
