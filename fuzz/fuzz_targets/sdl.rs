//! Any bytes read as a scene in POV-Ray's language: no panic, no infinite loop, and a scene or an error; a scene of a few objects
//! is also compiled, which may end in an error.

#![no_main]

use libfuzzer_sys::fuzz_target;
use strahl_sdl::{MemoryHost, Options, Source, parse};

fuzz_target!(|data: &[u8]| {
    let mut options = Options::default();
    // Small enough for many runs per second, and for distinguishing infinite loops from slow ones.
    options.limits.steps = 5_000;
    options.limits.array_elements = 1 << 12;
    options.limits.string_bytes = 1 << 12;
    options.limits.all_strings = 1 << 16;
    options.limits.objects = 1 << 10;
    options.limits.parts = 1 << 14;
    options.limits.written_bytes = 1 << 16;
    options.limits.depth = 50;
    options.limits.nesting = 50;
    options.limits.function_cost = 1 << 10;
    options.limits.function_operations = 1 << 12;
    // Most inputs would spend their time on finding suggestions for misspelt names.
    options.limits.errors = 5;
    let mut host = MemoryHost::new().with_file("a.inc", data.to_vec());
    let parsed = parse(Source::new("fuzz.pov", data), &options, &mut host);
    let failed = parsed.diagnostics.iter().any(|d| d.is_error());
    assert_eq!(failed, parsed.scene.is_none());
    assert!(parsed.diagnostics.len() < 300);
    for diagnostic in &parsed.diagnostics {
        // Placing the caret must not fail either.
        let _ = diagnostic.to_string();
    }
    if let Some(scene) = &parsed.scene
        && scene.objects.0.len() < 20
    {
        let _ = strahl_render::Prepared::new(scene);
    }
});
