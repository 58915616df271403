//! The server keeps strangers out, and survives whatever a page sends.

#![allow(
    clippy::unwrap_used,
    reason = "a test that unwraps fails as a test should"
)]

use serde_json::{Value, json};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};
use strahl::prelude::*;
use strahl::{LoadOptions, load_path};
use strahl_view::{Defaults, Request, Served, ViewOptions, serve};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket, client};

const BALL: &str = "camera { location <0, 1, -4> look_at 0 }\nlight_source { <3, 5, -4>, 1 }\nsphere { 0, 1\n  pigment { rgb <1, 0.4, 0> }\n}\nplane { y, -1 pigment { checker rgb 1 rgb 0.2 } }\n";

/// A server for a scene in a temporary folder.
struct Running {
    served: Served,
    folder: tempfile::TempDir,
    thread: Option<std::thread::JoinHandle<()>>,
}

impl Drop for Running {
    fn drop(&mut self) {
        self.served.end();
        if let Some(thread) = self.thread.take() {
            thread.join().unwrap();
        }
    }
}

fn load(request: &Request, stop: &Arc<AtomicBool>) -> strahl::Loaded {
    let mut options = LoadOptions {
        record: true,
        texts: request.texts.clone(),
        stop: Some(Arc::clone(stop)),
        ..LoadOptions::default()
    };
    options.sdl.clock = request.clock;
    load_path(&request.path, options)
}

fn start(text: &str, edit: bool) -> Running {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.pov");
    std::fs::write(&scene, text).unwrap();
    serving(folder, &scene, Some((64, 48)), edit, None)
}

fn serving(
    folder: tempfile::TempDir,
    scene: &Path,
    size: Option<(u32, u32)>,
    edit: bool,
    editor: Option<String>,
) -> Running {
    let options = ViewOptions {
        port: 0,
        scene: Some(scene.to_owned()),
        load: Box::new(load),
        defaults: Defaults {
            size,
            sampling: Sampling::ADAPTIVE,
            seed: 0,
            depth: None,
            cutoff: None,
            max_tree_rays: 1 << 18,
            shading: None,
            accelerator: AcceleratorKind::default(),
            clock: 0.0,
        },
        session: Session::new(Threads::Count(2)).unwrap(),
        edit,
        editor,
    };
    let (said, heard) = mpsc::channel();
    let thread = std::thread::spawn(move || {
        serve(options, &mut |served| said.send(served.clone()).unwrap()).unwrap();
    });
    Running {
        served: heard.recv().unwrap(),
        folder,
        thread: Some(thread),
    }
}

impl Running {
    fn scene(&self) -> PathBuf {
        self.folder.path().join("scene.pov")
    }

    fn host(&self) -> &str {
        let rest = self.served.address.strip_prefix("http://").unwrap();
        rest.split('/').next().unwrap()
    }

    fn token(&self) -> &str {
        self.served.address.split("token=").nth(1).unwrap()
    }

    /// The answer to a request as it is on the wire.
    fn get(&self, path: &str, headers: &[(&str, &str)]) -> String {
        let mut stream = TcpStream::connect(self.host()).unwrap();
        let mut text = format!("GET {path} HTTP/1.1\r\nConnection: close\r\n");
        for (name, value) in headers {
            text.push_str(&format!("{name}: {value}\r\n"));
        }
        stream.write_all(format!("{text}\r\n").as_bytes()).unwrap();
        let mut answer = vec![];
        // A refusal may close the connection early.
        let _ = stream.read_to_end(&mut answer);
        String::from_utf8_lossy(&answer).into_owned()
    }

    fn status(&self, path: &str, headers: &[(&str, &str)]) -> u32 {
        let answer = self.get(path, headers);
        answer
            .split(' ')
            .nth(1)
            .and_then(|s| s.parse().ok())
            .unwrap_or(0)
    }

    fn page(&self) -> Page {
        let stream = TcpStream::connect(self.host()).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(60)))
            .unwrap();
        let address = format!("ws://{}/ws?token={}", self.host(), self.token());
        let (socket, _) = client(address.into_client_request().unwrap(), stream).unwrap();
        let mut page = Page(socket);
        assert_eq!(page.until("hello")["type"], "hello");
        page
    }
}

struct Page(WebSocket<TcpStream>);

impl Page {
    fn send(&mut self, message: Value) {
        self.0.send(Message::text(message.to_string())).unwrap();
    }

    /// The next message of a type; binary ones are passed over.
    fn until(&mut self, wanted: &str) -> Value {
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(60) {
            if let Message::Text(text) = self.0.read().unwrap() {
                let value: Value = serde_json::from_str(&text).unwrap();
                if value["type"] == wanted {
                    return value;
                }
            }
        }
        panic!("no {wanted}");
    }

    fn ask(&mut self, mut message: Value) -> Result<Value, String> {
        message["id"] = 7.into();
        self.send(message);
        let reply = self.until("reply");
        match reply["problem"].as_str() {
            Some(problem) => Err(problem.to_owned()),
            None => Ok(reply["value"].clone()),
        }
    }

    fn show(&mut self, settings: Value) {
        self.send(json!({ "type": "picture", "slot": "main", "settings": settings }));
    }

    /// Shows the scene, and returns the finished picture as sRGB codes.
    fn picture(&mut self, (width, height): (usize, usize)) -> Vec<u8> {
        let mut codes = vec![0; 3 * width * height];
        loop {
            match self.0.read().unwrap() {
                Message::Binary(bytes) => {
                    let head: Vec<usize> = bytes[..32]
                        .chunks_exact(4)
                        .map(|b| u32::from_le_bytes(b.try_into().unwrap()) as usize)
                        .collect();
                    let [1, _, x, y, w, h, step, _] = head[..] else {
                        panic!("{head:?}");
                    };
                    let columns = w.div_ceil(step);
                    for row in 0..h {
                        for column in 0..w {
                            let from = 32 + 3 * (row / step * columns + column / step);
                            let to = 3 * ((y + row) * width + x + column);
                            codes[to..to + 3].copy_from_slice(&bytes[from..from + 3]);
                        }
                    }
                }
                Message::Text(text) => {
                    let value: Value = serde_json::from_str(&text).unwrap();
                    if value["type"] == "done" {
                        return codes;
                    }
                }
                _ => {}
            }
        }
    }
}

fn expected(path: &Path, settings: impl Fn(View) -> View) -> Vec<u8> {
    let (scene, _) = load_path(path, LoadOptions::default())
        .into_scene()
        .unwrap();
    let session = Session::new(Threads::Count(2)).unwrap();
    let (scene, _) = session.compile(&scene, &CompileOptions::default()).unwrap();
    let view = settings(scene.view(64, 48).with_sampling(Sampling::ADAPTIVE));
    session
        .picture(&view, &Output::default())
        .unwrap()
        .film
        .to_srgb8()
}

#[test]
fn only_those_who_know_the_token_get_anything() {
    let running = start(BALL, false);
    let (host, token) = (running.host(), running.token());
    let page = format!("/?token={token}");
    let script = format!("/app.js?token={token}");
    assert_eq!(running.status(&page, &[("Host", host)]), 200);
    assert_eq!(running.status(&script, &[("Host", host)]), 200);
    for path in [
        "/",
        "/app.js",
        "/ws",
        "/?token=",
        "/?token=0000",
        "/nothing",
    ] {
        assert_eq!(running.status(path, &[("Host", host)]), 403, "{path}");
    }
    let port = host.rsplit(':').next().unwrap();
    let cookie = format!("strahl-{port}={token}");
    assert_eq!(
        running.status("/app.js", &[("Host", host), ("Cookie", &cookie)]),
        200
    );
    let wrong = format!("strahl-{port}=1{}", &token[1..]);
    let is_wrong = wrong != cookie;
    assert!(!is_wrong || running.status("/app.js", &[("Host", host), ("Cookie", &wrong)]) == 403);
    // Another name for this machine, as an attacker's name server could give it, and another page's request.
    for host in ["example.org", "example.org:80", "127.0.0.1.example.org", ""] {
        assert_eq!(running.status(&page, &[("Host", host)]), 403, "{host}");
    }
    let own = format!("http://{host}");
    assert_eq!(
        running.status(&page, &[("Host", host), ("Origin", &own)]),
        200
    );
    // Through a tunnel, the port is another one.
    let tunnel = [
        ("Host", "localhost:9999"),
        ("Origin", "http://localhost:9999"),
    ];
    assert_eq!(running.status(&page, &tunnel), 200);
    for origin in [
        "http://example.org",
        "null",
        "http://127.0.0.1:1",
        "https://localhost",
    ] {
        let headers = [("Host", host), ("Origin", origin)];
        assert_eq!(running.status(&page, &headers), 403, "{origin}");
        // Another page in the same browser could open a WebSocket, with the cookie.
        let upgrade = [
            ("Upgrade", "websocket"),
            ("Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="),
            ("Sec-WebSocket-Version", "13"),
            ("Cookie", cookie.as_str()),
        ];
        let headers = [&headers[..], &upgrade].concat();
        assert_eq!(running.status("/ws", &headers), 403, "{origin}");
    }
}

#[test]
fn every_answer_forbids_foreign_scripts() {
    let running = start(BALL, false);
    for path in ["/".to_owned(), format!("/?token={}", running.token())] {
        let answer = running
            .get(&path, &[("Host", running.host())])
            .to_ascii_lowercase();
        assert!(
            answer.contains("content-security-policy: default-src 'none'"),
            "{answer}"
        );
        assert!(!answer.contains("unsafe-inline") && answer.contains("nosniff"));
    }
}

#[test]
fn paths_lead_to_no_other_files() {
    let running = start(BALL, false);
    std::fs::write(running.folder.path().join("secret.txt"), "secret").unwrap();
    let (host, token) = (running.host(), running.token());
    for path in [
        "/../Cargo.toml",
        "/%2e%2e/Cargo.toml",
        "/..%2fCargo.toml",
        "//etc/passwd",
        "/%2fetc%2fpasswd",
        "/scene.pov",
    ] {
        let status = running.status(&format!("{path}?token={token}"), &[("Host", host)]);
        assert!((400..500).contains(&status), "{path}: {status}");
    }
    let mut page = running.page();
    page.show(json!({}));
    page.until("done");
    let secret = running
        .folder
        .path()
        .join("secret.txt")
        .display()
        .to_string();
    for file in [
        "../secret.txt",
        &secret,
        "/etc/passwd",
        "",
        "scene.pov/../secret.txt",
    ] {
        let source = page.ask(json!({ "type": "source", "file": file }));
        assert!(source.is_err(), "{file}");
    }
    let own = running.scene().display().to_string();
    let source = page.ask(json!({ "type": "source", "file": own })).unwrap();
    assert_eq!(source["text"], BALL);
    // Without --edit nothing is written.
    let saved = page.ask(json!({ "type": "save", "file": own, "text": "" }));
    assert!(saved.is_err_and(|e| e.contains("--edit")));
    assert_eq!(std::fs::read_to_string(running.scene()).unwrap(), BALL);
}

#[test]
fn the_finished_picture_is_that_of_a_session_and_explains_itself() {
    let running = start(BALL, false);
    let mut page = running.page();
    page.show(json!({}));
    assert_eq!(
        page.picture((64, 48)),
        expected(&running.scene(), |view| view)
    );
    page.show(json!({ "depth": 1, "shading": "lambert", "sampling": "center" }));
    let plain = |view: View| {
        view.with_depth(1)
            .with_shading(ShadingModel::Lambert)
            .with_sampling(Sampling::Center)
    };
    assert_eq!(page.picture((64, 48)), expected(&running.scene(), plain));

    let tree = page
        .ask(json!({ "type": "explain", "slot": "main", "x": 32, "y": 24 }))
        .unwrap();
    let seen = page
        .ask(json!({ "type": "hover", "slot": "main", "x": 32, "y": 24 }))
        .unwrap();
    assert_eq!(tree["rgb8"], seen["rgb8"]);
    assert_eq!(seen["seen"]["line"], 3);
    assert!(
        page.ask(json!({ "type": "explain", "slot": "main", "x": 64, "y": 0 }))
            .is_err()
    );
    assert!(
        page.ask(json!({ "type": "explain", "slot": "side", "x": 0, "y": 0 }))
            .is_err()
    );
    let text = page
        .ask(json!({ "type": "camera_text", "slot": "main" }))
        .unwrap();
    assert!(text["text"].as_str().unwrap().starts_with("camera {"));
    let export = json!({ "type": "export", "slot": "main", "x": 32, "y": 24, "language": "de" });
    let html = page.ask(export).unwrap();
    assert!(html["html"].as_str().unwrap().contains("lang=\"de\""));

    // The pixels of the sphere, whose text begins on line 3.
    let file = running.scene().display().to_string();
    page.send(json!({ "type": "mark", "slot": "main", "file": file, "line": 4, "id": 1 }));
    let marks = loop {
        if let Message::Binary(bytes) = page.0.read().unwrap() {
            break bytes;
        }
    };
    assert_eq!((marks.len(), marks[0], marks[28]), (32 + 64 * 48, 3, 3));
    assert_eq!((marks[32], marks[32 + 24 * 64 + 32]), (0, 1));
}

#[test]
fn a_changed_file_is_rendered_and_errors_keep_the_last_picture() {
    let running = start(BALL, true);
    let mut page = running.page();
    page.show(json!({}));
    let first = page.picture((64, 48));
    let changed = BALL.replace("sphere { 0, 1", "sphere { 0, 1.3");
    std::fs::write(running.scene(), &changed).unwrap();
    let second = page.picture((64, 48));
    assert_ne!(first, second);
    assert_eq!(second, expected(&running.scene(), |view| view));

    std::fs::write(
        running.scene(),
        BALL.replace("sphere { 0, 1", "sphere { 0, Radius"),
    )
    .unwrap();
    let scene = loop {
        let scene = page.until("scene");
        if scene["loading"] == false && scene["stats"].is_null() {
            break scene;
        }
    };
    let said = &scene["said"][0];
    assert_eq!(
        (&said["severity"], &said["line"]),
        (&json!("error"), &json!(3))
    );
    let tree = page.ask(json!({ "type": "explain", "slot": "main", "x": 32, "y": 24 }));
    assert!(tree.is_ok(), "the last good picture can still be asked");

    // The page writes the file, and the picture comes back.
    let file = running.scene().display().to_string();
    page.send(json!({ "type": "save", "file": file, "text": BALL, "id": 2 }));
    assert_eq!(page.picture((64, 48)), first);
    // A file that disappears is an error, and one that comes back is read.
    std::fs::remove_file(running.scene()).unwrap();
    loop {
        let scene = page.until("scene");
        if scene["loading"] == false && scene["stats"].is_null() {
            break;
        }
    }
    std::fs::write(running.scene(), &changed).unwrap();
    assert_eq!(page.picture((64, 48)), second);
}

#[cfg(unix)]
#[test]
fn the_authors_editor_gets_the_file_and_the_line() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, seen) = (folder.path().join("scene.pov"), folder.path().join("at-3"));
    std::fs::write(&scene, BALL).unwrap();
    let editor = format!("cp {{file}} {}/at-{{line}}", folder.path().display());
    let running = serving(folder, &scene, Some((64, 48)), false, Some(editor));
    let mut page = running.page();
    page.show(json!({}));
    page.until("done");
    let edit = |file: &str| json!({ "type": "edit", "file": file, "line": 3 });
    assert!(page.ask(edit("/etc/passwd")).is_err());
    page.ask(edit(&scene.display().to_string())).unwrap();
    let start = Instant::now();
    while std::fs::read_to_string(&seen).ok().as_deref() != Some(BALL) {
        assert!(start.elapsed() < Duration::from_secs(30));
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn a_changed_image_is_rendered() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, image) = (folder.path().join("scene.pov"), folder.path().join("a.ppm"));
    let text = "camera { location -3*z look_at 0 }\nbox { -1, 1 pigment { image_map { ppm \"a.ppm\" } translate -0.5 scale 2 } finish { ambient 1 diffuse 0 } }\n";
    std::fs::write(&scene, text).unwrap();
    std::fs::write(&image, "P3 1 1 255 255 0 0\n").unwrap();
    let running = serving(folder, &scene, Some((64, 48)), false, None);
    let mut page = running.page();
    page.show(json!({}));
    let middle = 3 * (24 * 64 + 32);
    assert_eq!(page.picture((64, 48))[middle..middle + 3], [255, 0, 0]);
    std::fs::write(&image, "P3 1 1 255 0 0 255\n").unwrap();
    assert_eq!(page.picture((64, 48))[middle..middle + 3], [0, 0, 255]);
}

#[test]
fn a_text_of_the_page_is_tried_and_not_written() {
    let running = start(BALL, false);
    let mut page = running.page();
    page.show(json!({}));
    let first = page.picture((64, 48));
    page.send(
        json!({ "type": "text", "text": BALL.replace("rgb <1, 0.4, 0>", "rgb <0, 0.4, 1>") }),
    );
    assert_ne!(page.picture((64, 48)), first);
    assert_eq!(std::fs::read_to_string(running.scene()).unwrap(), BALL);
}

#[test]
fn texts_of_included_files_are_tried_and_those_that_are_built_in_are_shown() {
    let running = start(
        "#include \"colors.inc\"\n#include \"ball.inc\"\ncamera { location <0, 1, -4> look_at 0 }\nlight_source { <3, 5, -4>, 1 }\nsphere { 0, Size pigment { Red } }\n",
        true,
    );
    let include = running.folder.path().join("ball.inc");
    std::fs::write(&include, "#declare Size = 1;\n").unwrap();
    let mut page = running.page();
    page.show(json!({}));
    let scene = loop {
        let scene = page.until("scene");
        if scene["loading"] == false && !scene["stats"].is_null() {
            break scene;
        }
    };
    let first = page.picture((64, 48));
    let files = scene["files"].as_array().unwrap();
    let names: Vec<&str> = files.iter().map(|f| f["name"].as_str().unwrap()).collect();
    let (own, ball) = (names[0].to_owned(), include.display().to_string());
    assert!(names.contains(&&*ball), "{names:?}");
    let colors = files.iter().find(|file| file["built_in"] == true).unwrap();
    let colors = colors["name"].as_str().unwrap();
    assert!(colors.ends_with("colors.inc"), "{names:?}");
    let text = page
        .ask(json!({ "type": "source", "file": colors }))
        .unwrap();
    assert!(text["text"].as_str().unwrap().contains("Red"));
    for message in [
        json!({ "type": "save", "file": colors, "text": "" }),
        json!({ "type": "edit", "file": colors, "line": 1 }),
    ] {
        assert!(page.ask(message).is_err());
    }
    page.send(json!({ "type": "text", "file": colors, "text": "" }));
    assert!(
        page.until("error")["message"]
            .as_str()
            .unwrap()
            .contains("part of strahl")
    );
    page.send(json!({ "type": "text", "file": "/etc/passwd", "text": "" }));
    page.until("error");

    page.send(json!({ "type": "text", "file": ball, "text": "#declare Size = 0.5;" }));
    let small = page.picture((64, 48));
    assert_ne!(small, first);
    let text = page.ask(json!({ "type": "source", "file": ball })).unwrap();
    assert_eq!(text["text"], "#declare Size = 0.5;");
    assert_eq!(
        std::fs::read_to_string(&include).unwrap(),
        "#declare Size = 1;\n"
    );
    // Two texts at once, then only the other one.
    let blue = std::fs::read_to_string(running.scene())
        .unwrap()
        .replace("Red", "Blue");
    page.send(json!({ "type": "text", "file": own, "text": blue }));
    let both = page.picture((64, 48));
    assert!(both != small && both != first);
    page.send(json!({ "type": "text", "file": ball, "text": null }));
    let large = page.picture((64, 48));
    assert!(large != both && large != first);
    page.send(json!({ "type": "text" }));
    assert_eq!(page.picture((64, 48)), first);
    // A text that is written is tried no more.
    page.send(json!({ "type": "text", "file": ball, "text": "#declare Size = 0.5;" }));
    assert_eq!(page.picture((64, 48)), small);
    page.send(
        json!({ "type": "save", "file": ball, "text": "#declare Size = 0.5; // small", "id": 3 }),
    );
    page.until("reply");
    assert_eq!(
        std::fs::read_to_string(&include).unwrap(),
        "#declare Size = 0.5; // small"
    );
    page.send(json!({ "type": "text", "file": own, "text": "x".repeat(2 << 20) }));
    assert_eq!(page.until("error")["message"], "the text is too long");
}

/// A loop without end in a scene that was never read before: correcting it shows the scene, without an error in between.
#[test]
fn a_scene_that_changes_while_it_is_read_for_the_first_time_is_read_again() {
    let running = start("#while (1) #end", false);
    let mut page = running.page();
    page.show(json!({}));
    assert_eq!(page.until("scene")["loading"], true);
    std::thread::sleep(Duration::from_millis(1500));
    std::fs::write(running.scene(), BALL).unwrap();
    loop {
        let scene = page.until("scene");
        if !scene["stats"].is_null() {
            break;
        }
        assert!(scene["said"].is_null(), "{scene}");
    }
    page.until("done");
}

/// People keep their files in one folder and link to them from another.
#[cfg(unix)]
#[test]
fn links_are_followed() {
    let folder = tempfile::tempdir().unwrap();
    let kept = folder.path().join("kept");
    std::fs::create_dir(&kept).unwrap();
    let target = kept.join("real.pov");
    std::fs::write(&target, BALL).unwrap();
    let scene = folder.path().join("scene.pov");
    std::os::unix::fs::symlink(&target, &scene).unwrap();
    let running = serving(folder, &scene, Some((64, 48)), true, None);
    let mut page = running.page();
    page.show(json!({}));
    let first = page.picture((64, 48));
    std::fs::write(&target, BALL.replace("0, 1\n", "0, 0.5\n")).unwrap();
    let small = page.picture((64, 48));
    assert_ne!(small, first);
    let file = scene.display().to_string();
    page.send(json!({ "type": "save", "file": file, "text": BALL, "id": 1 }));
    assert_eq!(page.picture((64, 48)), first);
    assert!(scene.is_symlink(), "it is a link still");
    assert_eq!(std::fs::read_to_string(target).unwrap(), BALL);
}

#[test]
fn lights_are_moved_and_written_as_text() {
    let running = start(BALL, false);
    let mut page = running.page();
    page.show(json!({}));
    let first = page.picture((64, 48));
    let moved = json!([{ "light": 0, "position": [-3, 5, -4] }]);
    page.show(json!({ "lights": moved }));
    let second = page.picture((64, 48));
    assert_ne!(first, second);
    let changed = BALL.replace("<3, 5, -4>", "<-3, 5, -4>");
    let text = page
        .ask(json!({ "type": "light_text", "slot": "main", "light": 0 }))
        .unwrap();
    let text = text["text"].as_str().unwrap();
    assert!(text.contains("<-3, 5, -4>"), "{text}");
    // The picture is that of a scene with the light there, and the text is that of the light.
    std::fs::write(running.scene(), &changed).unwrap();
    assert_eq!(second, expected(&running.scene(), |view| view));
    let written = BALL.replace("light_source { <3, 5, -4>, 1 }", text);
    std::fs::write(running.scene(), &written).unwrap();
    assert_eq!(second, expected(&running.scene(), |view| view));
    assert!(
        page.ask(json!({ "type": "light_text", "slot": "main", "light": 7 }))
            .is_err()
    );
    // Lights that don't exist are passed over; too many are refused.
    page.show(json!({ "lights": [{ "light": 70, "position": [0, 0, 0] }] }));
    page.until("picture");
    let many: Vec<Value> = (0..200)
        .map(|n| json!({ "light": n, "position": [0, 0, 0] }))
        .collect();
    page.show(json!({ "lights": many }));
    page.until("error");
}

#[test]
fn a_whole_picture_is_exported() {
    let running = start(BALL, false);
    let mut page = running.page();
    page.show(json!({}));
    page.until("done");
    let ask = json!({ "type": "export_picture", "slot": "main", "pixels": [[5, 6], [900, 0]], "language": "de" });
    let html = page.ask(ask.clone()).unwrap();
    let html = html["html"].as_str().unwrap();
    assert!(html.contains("lang=\"de\"") && html.contains("data:image/png;base64,"));
    assert!(html.contains("\"pixel\":[5,6]") && html.contains("pigment"));
    // Not of a picture of normals, and not with thousands of chosen pixels.
    page.show(json!({ "channel": "normal" }));
    page.until("done");
    assert!(page.ask(ask).is_err());
    let many = vec![[0, 0]; 2000];
    assert!(
        page.ask(
            json!({ "type": "export_picture", "slot": "main", "pixels": many, "language": "en" })
        )
        .is_err()
    );
}

/// A slider asks for a scene with every movement; what counts is the last one.
#[test]
fn a_page_that_asks_for_many_scenes_gets_the_last_one() {
    let running = start(&BALL.replace("sphere { 0, 1", "sphere { clock*x, 1"), false);
    let mut page = running.page();
    for step in 0..300 {
        page.show(json!({ "clock": f64::from(step) / 299.0 }));
    }
    let start = Instant::now();
    let moved = std::fs::read_to_string(running.scene())
        .unwrap()
        .replace("clock*x", "x");
    std::fs::write(running.folder.path().join("moved.pov"), moved).unwrap();
    let wanted = expected(&running.folder.path().join("moved.pov"), |view| view);
    while page.picture((64, 48)) != wanted {
        assert!(start.elapsed() < Duration::from_secs(60));
    }
}

#[test]
fn rays_without_a_direction_and_too_many_pages_are_refused() {
    let running = start(BALL, false);
    let mut page = running.page();
    page.show(json!({}));
    page.until("done");
    for accelerator in ["grid", "octree", "bvh", "spheres"] {
        page.show(json!({ "accelerator": accelerator }));
        page.until("done");
        for ray in [
            [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
            [[0.0, 1e300, 0.0], [1e300, 1e-300, 0.0]],
            [[1e308, 0.0, 0.0], [0.0, 5e-324, 0.0]],
        ] {
            page.ask(json!({ "type": "walk", "slot": "main", "ray": ray }))
                .unwrap();
        }
    }
    let pages: Vec<Page> = (0..63).map(|_| running.page()).collect();
    let host = running.host();
    let upgrade = [
        ("Host", host),
        ("Upgrade", "websocket"),
        ("Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="),
        ("Sec-WebSocket-Version", "13"),
    ];
    let path = format!("/ws?token={}", running.token());
    let status = |running: &Running| {
        let mut stream = TcpStream::connect(running.host()).unwrap();
        let mut text = format!("GET {path} HTTP/1.1\r\nConnection: Upgrade\r\n");
        for (name, value) in upgrade {
            text.push_str(&format!("{name}: {value}\r\n"));
        }
        stream.write_all(format!("{text}\r\n").as_bytes()).unwrap();
        let mut start = [0; 12];
        stream.read_exact(&mut start).unwrap();
        String::from_utf8_lossy(&start[9..]).into_owned()
    };
    assert_eq!(status(&running), "503");
    drop(pages);
    // Their places are free again.
    let start = Instant::now();
    while status(&running) != "101" {
        assert!(start.elapsed() < Duration::from_secs(30));
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn malformed_messages_and_pages_that_disappear_do_no_harm() {
    let running = start(BALL, false);
    let mut page = running.page();
    page.show(json!({}));
    page.until("done");
    let wrong = [
        json!({}),
        json!([]),
        json!({ "type": "nothing" }),
        json!({ "type": "picture", "slot": "main", "settings": { "size": [100000, 100000] } }),
        json!({ "type": "picture", "slot": "main", "settings": { "size": [0, 10] } }),
        json!({ "type": "picture", "slot": "main", "settings": { "size": [-1, 10] } }),
        json!({ "type": "picture", "slot": "main", "settings": { "depth": 4000000000u32 } }),
        json!({ "type": "picture", "slot": "main", "settings": { "depth": 0 } }),
        json!({ "type": "picture", "slot": "main", "settings": { "cutoff": -1 } }),
        json!({ "type": "picture", "slot": "main", "settings": { "sampling": "99999x99999" } }),
        json!({ "type": "picture", "slot": "main", "settings": { "accelerator": "grid:resolution=9999999x1x1x1" } }),
        json!({ "type": "picture", "slot": "main", "settings": { "shading": "bright" } }),
        json!({ "type": "picture", "slot": "main", "settings": { "unknown": 1 } }),
        json!({ "type": "picture", "slot": "other" }),
        json!({ "type": "open", "scene": "../scene.pov" }),
        json!({ "type": "linear", "slot": "main", "region": [4000000000u32, 0, 4000000000u32, 4000000000u32] }),
    ];
    for message in wrong {
        page.send(message.clone());
        assert!(page.until("error")["message"].is_string(), "{message}");
    }
    let zero =
        json!({ "eye": [0, 0, 0], "direction": [0, 0, 0], "right": [0, 0, 0], "up": [0, 0, 0] });
    page.show(json!({ "camera": zero }));
    page.until("error");
    // Good messages with mistakes: whatever is answered, the page goes on.
    let good = [
        json!({ "type": "picture", "slot": "main", "settings": { "depth": 3, "size": [64, 48], "sampling": "2x2", "lights": [{ "light": 0, "position": [1, 2, 3] }] } }),
        json!({ "type": "explain", "slot": "main", "x": 32, "y": 24, "id": 1 }),
        json!({ "type": "hover", "slot": "main", "x": 32, "y": 24, "id": 2 }),
        json!({ "type": "mark", "slot": "main", "file": "scene.pov", "line": 4, "id": 3 }),
        json!({ "type": "linear", "slot": "main", "region": [1, 2, 3, 4] }),
        json!({ "type": "walk", "slot": "main", "ray": [[0, 1, -4], [0, 0, 1]], "id": 4 }),
        json!({ "type": "export", "slot": "main", "x": 3, "y": 4, "language": "de", "id": 5 }),
        json!({ "type": "text", "file": "scene.pov", "text": BALL }),
        json!({ "type": "pieces", "text": BALL, "id": 6 }),
    ];
    let mut state = 11_u64;
    let mut random = |below: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for round in 0..600 {
        let mut text: Vec<char> = good[round % good.len()].to_string().chars().collect();
        for _ in 0..=random(4) {
            let at = random(text.len());
            match random(4) {
                0 => text[at] = char::from(b' ' + random(95) as u8),
                1 => drop(text.remove(at)),
                2 => text.insert(at, text[random(text.len())]),
                _ => text.truncate(at.max(8)),
            }
        }
        let text = String::from_iter(text);
        page.0.send(Message::text(text)).unwrap();
        let id = 1000 + round;
        page.send(json!({ "type": "pieces", "text": "sphere", "id": id }));
        while page.until("reply")["id"] != id {}
    }
    let mut page = running.page();
    page.show(json!({}));
    page.until("done");
    // Random messages, made of pieces of good ones.
    let pieces = [
        "{",
        "}",
        "\"type\"",
        ":",
        "\"picture\"",
        ",",
        "\"slot\"",
        "\"main\"",
        "1e999",
        "-1",
        "null",
        "[",
        "]",
        "\"explain\"",
        "\"x\"",
        "\u{0}",
        "é",
        "\\",
    ];
    let mut state = 7_u64;
    for _ in 0..300 {
        let mut text = String::new();
        for _ in 0..state % 14 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            text.push_str(pieces[(state >> 33) as usize % pieces.len()]);
        }
        state = state.wrapping_add(1);
        page.0.send(Message::text(text)).unwrap();
        page.until("error");
    }
    page.0.send(Message::binary(vec![0, 1, 2])).unwrap();
    page.until("error");
    // Pages that go in the middle of a large picture, and one that sends too much.
    for _ in 0..5 {
        let mut page = running.page();
        page.show(json!({ "size": [2000, 2000] }));
        page.until("picture");
        drop(page);
    }
    let mut loud = running.page();
    let sent = loud.0.send(Message::text("x".repeat(5 << 20)));
    let refused = sent.is_err() || (0..100).any(|_| loud.0.read().is_err());
    assert!(refused, "a message of 5 MiB is refused");
    // The first page still works.
    page.show(json!({}));
    let start = Instant::now();
    page.ask(json!({ "type": "hover", "slot": "main", "x": 1, "y": 1 }))
        .unwrap();
    assert!(start.elapsed() < Duration::from_secs(30));
}

#[test]
fn a_page_that_reads_nothing_stops_nobody_else() {
    let running = start(BALL, false);
    let mut deaf = running.page();
    for depth in 1..=20 {
        deaf.show(json!({ "size": [4000, 4000], "depth": depth, "sampling": "center" }));
    }
    let mut page = running.page();
    page.show(json!({}));
    assert_eq!(
        page.picture((64, 48)),
        expected(&running.scene(), |view| view)
    );
}

#[test]
fn a_scene_may_not_ask_for_a_picture_of_any_size() {
    let folder = tempfile::tempdir().unwrap();
    let huge = "v\nfrom 0 0 -5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 60000 60000\ns 0 0 0 1\n";
    let nff = folder.path().join("huge.nff");
    std::fs::write(&nff, huge).unwrap();
    let (scene, _) = load_path(&nff, LoadOptions::default())
        .into_scene()
        .unwrap();
    assert_eq!(scene.settings.size, Some((60000, 60000)));
    let running = serving(folder, &nff, None, false, None);
    let mut page = running.page();
    page.show(json!({}));
    let message = page.until("error");
    assert!(
        message["message"]
            .as_str()
            .unwrap()
            .contains("60000 x 60000"),
        "{message}"
    );
    page.show(json!({ "size": [40, 30] }));
    page.until("done");
}

/// Two pages that show the same scene have one picture between them, so it is read, built and rendered once. Another setting is another picture.
#[test]
fn two_pages_see_the_same_picture() {
    let running = start(BALL, false);
    let (mut first, mut second) = (running.page(), running.page());
    first.show(json!({}));
    second.show(json!({}));
    let number = first.until("picture")["picture"].clone();
    assert_eq!(second.until("picture")["picture"], number);
    assert_eq!(first.picture((64, 48)), second.picture((64, 48)));
    // One that comes when the picture is finished gets it, too.
    let mut third = running.page();
    third.show(json!({}));
    assert_eq!(third.until("picture")["picture"], number);
    assert_eq!(third.until("done")["picture"], number);
    third.show(json!({ "depth": 1 }));
    assert_ne!(third.until("picture")["picture"], number);
}
