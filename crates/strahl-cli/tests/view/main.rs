//! The viewer in a real browser: Chromium, driven by playwright-core and checked by axe-core (see browser.mjs).

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "tests say what they skip"
)]
#![allow(
    clippy::unwrap_used,
    reason = "a test that unwraps fails as a test should"
)]

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
#[cfg(unix)]
use std::time::{Duration, Instant};

const SCENE: &str = "\
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.2, -5> look_at <0, 0.2, 0> angle 40 }
light_source { <4, 6, -5>, 1 }
#include \"colors.inc\"
#include \"ball.inc\"
sphere {
  <0, 0, 0>, 1
  pigment { rgb Ball }
  finish { diffuse 0.7 specular 0.5 reflection 0.2 }
}
plane { y, -1 pigment { checker rgb 0.9 rgb 0.2 } }
";

/// A program that is ended with the test.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A viewer with these arguments, and its address.
fn viewer(folder: &Path, args: &[&str]) -> (Running, String) {
    let mut view = Running(
        Command::new(env!("CARGO_BIN_EXE_strahl"))
            .arg("view")
            .args(args)
            .current_dir(folder)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap(),
    );
    let mut address = String::new();
    let out = view.0.stdout.take().unwrap();
    BufReader::new(out).read_line(&mut address).unwrap();
    (view, address.trim().to_owned())
}

/// The folder with playwright-core and axe-core, and the browser; `None` if one of them or Node.js is missing.
fn tools() -> Option<(PathBuf, PathBuf)> {
    let target = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/browser");
    let modules = std::env::var_os("STRAHL_PLAYWRIGHT").map_or(target, PathBuf::from);
    let paths = std::env::var_os("PATH")?;
    let program = |name: &str| {
        let files = std::env::split_paths(&paths).map(|folder| folder.join(name));
        files.into_iter().find(|file| file.is_file())
    };
    program("node")?;
    let browser = program("chromium").or_else(|| program("chromium-browser"))?;
    let is_there = |name: &str| modules.join("node_modules").join(name).is_dir();
    (is_there("playwright-core") && is_there("axe-core")).then_some((modules, browser))
}

#[test]
fn the_viewer_works_in_a_browser() {
    let Some((modules, browser)) = tools() else {
        assert!(
            std::env::var_os("STRAHL_REQUIRE_TOOLS").is_none(),
            "node, chromium, playwright-core or axe-core (npm install --prefix target/browser playwright-core axe-core) is missing"
        );
        eprintln!("SKIPPED: node, chromium, playwright-core or axe-core is missing");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("scene.pov"), SCENE).unwrap();
    std::fs::write(at("ball.inc"), "#declare Ball = <1, 0.45, 0.05>;\n").unwrap();
    let strahl = env!("CARGO_BIN_EXE_strahl");
    for (name, more) in [
        ("whole.ppm", [].as_slice()),
        ("depth1.ppm", &["--max-depth", "1"]),
    ] {
        let rendered = Command::new(strahl)
            .args([
                "render",
                "scene.pov",
                "--size",
                "160x120",
                "--quiet",
                "-o",
                name,
            ])
            .args(more)
            .current_dir(folder.path())
            .status();
        assert!(rendered.unwrap().success());
    }
    // An "editor" that leaves a file with the line in its name.
    let editor = ["--edit", "--editor", "cp {file} edited-{line}"];
    let own = [["scene.pov", "--size", "160x120"].as_slice(), &editor].concat();
    let (_own, address) = viewer(folder.path(), &own);
    let (_others, others) = viewer(folder.path(), &["--size", "64x48"]);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/view/browser.mjs");
    let checked = Command::new("node")
        .arg(script)
        .args([&address, &folder.path().display().to_string(), &others])
        .env("STRAHL_PLAYWRIGHT", modules)
        .env("STRAHL_BROWSER", browser)
        .output()
        .unwrap();
    let (said, problems) = (
        String::from_utf8_lossy(&checked.stdout),
        String::from_utf8_lossy(&checked.stderr),
    );
    assert!(checked.status.success(), "{said}\n{problems}");
    println!("{said}");
}

#[cfg(unix)]
#[test]
fn the_viewer_prints_one_line_and_ends_on_signals() {
    for signal in ["-INT", "-TERM"] {
        let folder = tempfile::tempdir().unwrap();
        let mut view = Running(
            Command::new(env!("CARGO_BIN_EXE_strahl"))
                .args(["view", "--port", "0"])
                .env("TMPDIR", folder.path())
                .stdout(Stdio::piped())
                .spawn()
                .unwrap(),
        );
        let mut lines = BufReader::new(view.0.stdout.take().unwrap()).lines();
        let address = lines.next().unwrap().unwrap();
        assert!(address.starts_with("http://127.0.0.1:") && address.contains("/?token="));
        let kill = Command::new("kill")
            .args([signal, &view.0.id().to_string()])
            .status();
        assert!(kill.unwrap().success());
        assert!(view.0.wait().unwrap().success(), "{signal}");
        assert!(lines.next().is_none());
        assert_eq!(
            std::fs::read_dir(folder.path()).unwrap().count(),
            0,
            "nothing is left"
        );
    }
}

/// A signal that comes before the server listens ends it as well, and leaves nothing of the scenes that it has unpacked.
#[cfg(unix)]
#[test]
fn a_signal_at_the_beginning_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut view = Running(
        Command::new(env!("CARGO_BIN_EXE_strahl"))
            .args(["view", "--port", "0"])
            .env("TMPDIR", folder.path())
            .stdout(Stdio::null())
            .spawn()
            .unwrap(),
    );
    let begun = Instant::now();
    while std::fs::read_dir(folder.path()).unwrap().count() == 0 {
        assert!(begun.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_micros(200));
    }
    let kill = Command::new("kill").arg(view.0.id().to_string()).status();
    assert!(kill.unwrap().success());
    assert!(view.0.wait().unwrap().success());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// A large picture, a loop without end, a question of a page: none of them is waited for, and nothing is left.
#[cfg(unix)]
#[test]
fn a_signal_ends_the_viewer_whatever_it_is_doing() {
    let folder = tempfile::tempdir().unwrap();
    let temporary = folder.path().join("temporary");
    std::fs::create_dir(&temporary).unwrap();
    std::fs::write(folder.path().join("loop.pov"), "#while (1) #end\n").unwrap();
    let large = r#"{ "type": "picture", "slot": "main", "settings": { "size": [4000, 4000] } }"#;
    let usual = r#"{ "type": "picture", "slot": "main" }"#;
    let table = r#"{ "type": "table", "slot": "main", "id": 1 }"#;
    for (scene, picture, question, signal) in [
        (None, large, None, "-INT"),
        (Some("loop.pov"), usual, None, "-TERM"),
        (None, usual, Some(table), "-TERM"),
        (None, usual, Some(table), "-INT"),
    ] {
        let mut view = Running(
            Command::new(env!("CARGO_BIN_EXE_strahl"))
                .args(["view", "--port", "0"])
                .args(scene)
                .current_dir(folder.path())
                .env("TMPDIR", &temporary)
                .stdout(Stdio::piped())
                .spawn()
                .unwrap(),
        );
        let mut address = String::new();
        let out = view.0.stdout.take().unwrap();
        BufReader::new(out).read_line(&mut address).unwrap();
        let socket = address.trim().replace("http:", "ws:").replace("/?", "/ws?");
        let (mut page, _) = tungstenite::connect(socket).unwrap();
        page.send(picture.into()).unwrap();
        let wanted = match scene {
            Some(_) => r#""loading":true"#,
            None => r#""type":"picture""#,
        };
        while !page
            .read()
            .unwrap()
            .to_text()
            .is_ok_and(|text| text.contains(wanted))
        {}
        if let Some(question) = question {
            page.send(question.into()).unwrap();
        }
        // It is in the middle of it.
        std::thread::sleep(Duration::from_millis(300));
        let begun = Instant::now();
        let kill = Command::new("kill")
            .args([signal, &view.0.id().to_string()])
            .status();
        assert!(kill.unwrap().success());
        assert!(view.0.wait().unwrap().success());
        assert!(
            begun.elapsed() < Duration::from_secs(3),
            "{picture} {signal}"
        );
        assert_eq!(std::fs::read_dir(&temporary).unwrap().count(), 0);
    }
}

/// The program that opens pages gets the address that is printed.
#[cfg(target_os = "linux")]
#[test]
fn the_page_is_opened_in_the_browser() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("scene.pov"), SCENE).unwrap();
    // Renamed when it is complete.
    let script = "#!/bin/sh\nprintf %s \"$1\" > part && mv part opened\n";
    std::fs::write(at("xdg-open"), script).unwrap();
    std::fs::set_permissions(at("xdg-open"), PermissionsExt::from_mode(0o755)).unwrap();
    let mut paths = vec![folder.path().to_owned()];
    paths.extend(std::env::split_paths(&std::env::var_os("PATH").unwrap()));
    let mut view = Running(
        Command::new(env!("CARGO_BIN_EXE_strahl"))
            .args(["view", "scene.pov", "--open"])
            .current_dir(folder.path())
            .env("PATH", std::env::join_paths(paths).unwrap())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap(),
    );
    let mut address = String::new();
    let out = view.0.stdout.take().unwrap();
    BufReader::new(out).read_line(&mut address).unwrap();
    let begun = Instant::now();
    while !at("opened").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(5));
    }
    let opened = std::fs::read_to_string(at("opened")).unwrap();
    assert_eq!(opened, address.trim());
}

#[test]
fn a_port_that_is_taken_is_an_error() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let out = Command::new(env!("CARGO_BIN_EXE_strahl"))
        .args(["view", "--port", &port])
        .output()
        .unwrap();
    assert!(!out.status.success() && out.stdout.is_empty());
    assert!(String::from_utf8_lossy(&out.stderr).contains(&format!("127.0.0.1:{port}")));
}

#[test]
fn a_missing_scene_is_an_error() {
    let out = Command::new(env!("CARGO_BIN_EXE_strahl"))
        .args(["view", "nowhere.pov"])
        .output()
        .unwrap();
    assert!(!out.status.success());
    assert!(String::from_utf8_lossy(&out.stderr).contains("nowhere.pov"));
}
