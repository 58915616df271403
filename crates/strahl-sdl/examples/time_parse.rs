//! Parses a scene file and tells how long it took: `cargo run --release -p strahl-sdl --example time_parse -- scene.pov`

use std::io::Write;
use std::time::Instant;
use strahl_sdl::{FolderHost, Options, Source, parse};

fn main() -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    for name in std::env::args().skip(1) {
        let bytes = std::fs::read(&name)?;
        let size = bytes.len() as f64 / 1e6;
        let started = Instant::now();
        let mut host = FolderHost::new([]);
        let parsed = parse(Source::new(&name, bytes), &Options::default(), &mut host);
        let seconds = started.elapsed().as_secs_f64();
        let objects = parsed.scene.as_ref().map_or(0, |s| s.objects.0.len());
        for diagnostic in parsed.diagnostics.iter().take(20) {
            writeln!(out, "{diagnostic}")?;
        }
        writeln!(
            out,
            "{name}: {size:.1} MB, {objects} objects, {seconds:.3} s"
        )?;
    }
    Ok(())
}
