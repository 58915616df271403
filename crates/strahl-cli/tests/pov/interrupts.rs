//! Ctrl-C.
#![cfg(unix)]

use super::common::stderr;
use super::{folder, pictures, write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Starts the program.
fn start(folder: &Path, args: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_strahl"))
        .current_dir(folder)
        .args(args)
        .stdin(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts")
}

/// Sends Ctrl-C to the program; returns its standard error and the seconds until it ended.
fn interrupt(child: Child) -> (String, f64) {
    let start = Instant::now();
    let pid = child.id().to_string();
    let killed = Command::new("kill").args(["-INT", &pid]).status();
    assert!(killed.expect("kill runs").success(), "it ended too early");
    let output = child.wait_with_output().expect("it ends");
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(130), "{said}");
    (said, start.elapsed().as_secs_f64())
}

#[test]
fn ctrl_c_leaves_whole_frames() {
    let folder = folder();
    let f = folder.path();
    let args = ["render", "scene.pov", "+W160", "+H120", "+KFF900", "-GA"];
    let child = start(f, &args);
    let begin = Instant::now();
    while !f.join("scene002.png").exists() && begin.elapsed().as_secs() < 60 {
        std::thread::sleep(Duration::from_millis(5));
    }
    let (said, _) = interrupt(child);
    let names = pictures(f);
    let text = format!(
        "interrupted; {} of 900 frames are complete; --resume",
        names.len()
    );
    assert!(said.contains(&text), "no `{text}` in\n{said}");
    for name in &names {
        let bytes = std::fs::read(f.join(name)).expect("a picture");
        assert!(bytes[bytes.len() - 8..].starts_with(b"IEND"), "{name}");
    }
    // Only the scene and its pictures, no partial files.
    let files = std::fs::read_dir(f).expect("a folder").count();
    assert_eq!(files, names.len() + 1);
}

#[test]
fn ctrl_c_ends_the_middle_of_something_long() {
    let folder = folder();
    let f = folder.path();
    write(
        f,
        "loop.pov",
        "#declare I = 0; #while (I < 1e12) #declare I = I + 1; #end sphere { 0, 1 }",
    );
    // Two mirrors that face each other: ray trees of ten thousand levels, with a thousand shadow rays at each hit.
    let mirrors = "camera { location 0 look_at z } global_settings { adc_bailout 0 }\n\
                   light_source { y/2 rgb 1 area_light x, z, 32, 32 }\n\
                   plane { z, 1 pigment { rgb 1 } finish { reflection 1 } } plane { z, -1 pigment { rgb 1 } finish { reflection 1 } }";
    write(f, "mirrors.pov", mirrors);
    let limits = ["--limit", "steps=1e17", "--limit", "idle_steps=1e17"];
    let deep = ["--max-depth", "10000", "--max-tree-rays", "4000000000"];
    for args in [
        [&["check", "loop.pov"], &limits[..]].concat(),
        [&["render", "loop.pov"], &limits[..]].concat(),
        [&["render", "mirrors.pov", "--size", "2x2"], &deep[..]].concat(),
    ] {
        let child = start(f, &args);
        std::thread::sleep(Duration::from_millis(1500));
        let (said, seconds) = interrupt(child);
        assert!(said.contains("interrupted"), "{args:?}: {said}");
        // One second, plus the delays of a busy machine.
        assert!(seconds < 3.0, "{args:?}: {seconds} s");
    }
    assert!(pictures(f).is_empty());
}
