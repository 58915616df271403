//! Parses scene files and prints the time and the memory for each: `cargo run --release -p strahl-sdl --example time_parse --
//! scene.pov`. `cargo xtask bench parse` compares these numbers with POV-Ray's.

use std::io::Write;
use std::path::Path;
use std::time::Instant;
use strahl_sdl::{FolderHost, Options, Source, parse};

/// Processor seconds of this thread, as Linux reports them; `None` on other systems.
fn cpu_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split(' ').next()?.parse().ok()?;
    Some(nanoseconds / 1e9)
}

/// Peak memory of this process so far, in bytes; `None` where there is no `/proc`.
fn peak_memory() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes * 1024.0)
}

fn main() -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    for name in std::env::args().skip(1) {
        let (started, cpu) = (Instant::now(), cpu_seconds());
        let source = match Source::large(Path::new(&name))? {
            Some(source) => source,
            None => Source::new(&name, std::fs::read(&name)?),
        };
        let size = source.length();
        let mut host = FolderHost::new([]);
        let parsed = parse(source, &Options::default(), &mut host);
        let wall = started.elapsed().as_secs_f64();
        let cpu = cpu_seconds().zip(cpu).map(|(now, then)| now - then);
        let objects = parsed.scene.as_ref().map_or(0, |s| s.objects.0.len());
        for diagnostic in parsed.diagnostics.iter().take(20) {
            writeln!(out, "{diagnostic}")?;
        }
        writeln!(
            out,
            "bytes {size} objects {objects} wall {wall:.4} cpu {:.4} peak {:.0}",
            cpu.unwrap_or(wall),
            peak_memory().unwrap_or(0.0)
        )?;
    }
    Ok(())
}
