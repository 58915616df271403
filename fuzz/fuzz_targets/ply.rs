//! Any bytes read as PLY: no panic, no excessive memory, and a scene or an error.

#![no_main]

use libfuzzer_sys::fuzz_target;
use strahl_formats::scene::{SceneFormat, load_bytes};

fuzz_target!(|data: &[u8]| {
    let loaded = load_bytes(data, "fuzz.ply", SceneFormat::Ply, None);
    let failed = loaded.diagnostics.iter().any(|d| d.is_error());
    assert_eq!(failed, loaded.scene.is_none());
    assert!(loaded.diagnostics.len() < 100);
    for diagnostic in &loaded.diagnostics {
        // Placing the caret must not fail either.
        let _ = diagnostic.to_string();
    }
});
