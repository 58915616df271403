//! Measures what a page waits for. It takes a quiet machine, so it runs only when it is asked for:
//!
//! ```sh
//! cargo test --release -p strahl-view --test measure -- --ignored --nocapture --test-threads=1
//! ```

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "it prints what it measures, and fails where something is missing"
)]

use serde_json::{Value, json};
use std::net::TcpStream;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};
use strahl::prelude::*;
use strahl::{LoadOptions, load_path};
use strahl_view::{Defaults, Request, Served, ViewOptions, serve};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket, client};

fn start(scene: &Path) -> (Served, std::thread::JoinHandle<()>) {
    let load = |request: &Request, _: &Arc<AtomicBool>| {
        let options = LoadOptions {
            record: true,
            ..LoadOptions::default()
        };
        load_path(&request.path, options)
    };
    let options = ViewOptions {
        port: 0,
        scene: Some(scene.to_owned()),
        load: Box::new(load),
        defaults: Defaults {
            size: Some((800, 600)),
            sampling: Sampling::ADAPTIVE,
            seed: 0,
            depth: None,
            cutoff: None,
            max_tree_rays: 1 << 18,
            shading: None,
            accelerator: AcceleratorKind::default(),
            clock: 0.0,
        },
        session: Session::new(Threads::All).unwrap(),
        edit: false,
        editor: None,
    };
    let (said, heard) = mpsc::channel();
    let thread = std::thread::spawn(move || {
        serve(options, &mut |served| said.send(served.clone()).unwrap()).unwrap();
    });
    (heard.recv().unwrap(), thread)
}

fn page(served: &Served) -> WebSocket<TcpStream> {
    let rest = served.address.strip_prefix("http://").unwrap();
    let (host, token) = rest.split_once("/?token=").unwrap();
    let stream = TcpStream::connect(host).unwrap();
    stream
        .set_read_timeout(Some(Duration::from_secs(120)))
        .unwrap();
    let address = format!("ws://{host}/ws?token={token}");
    client(address.into_client_request().unwrap(), stream)
        .unwrap()
        .0
}

/// The next text message of a type, with its JSON.
fn until(page: &mut WebSocket<TcpStream>, wanted: &str) -> Value {
    loop {
        if let Message::Text(text) = page.read().unwrap() {
            let value: Value = serde_json::from_str(&text).unwrap();
            assert_ne!(value["type"], "error", "{value}");
            if value["type"] == wanted {
                return value;
            }
        }
    }
}

/// Reads until the whole picture is there, coarse or finer.
fn until_covered(page: &mut WebSocket<TcpStream>, picture: u64, pixels: u64) {
    let mut covered = 0;
    while covered < pixels {
        if let Message::Binary(bytes) = page.read().unwrap() {
            let word = |n: usize| {
                u64::from(u32::from_le_bytes(
                    bytes[4 * n..4 * n + 4].try_into().unwrap(),
                ))
            };
            if word(1) == picture {
                covered += word(4) * word(5);
            }
        }
    }
}

fn show(page: &mut WebSocket<TcpStream>, settings: Value) {
    let message = json!({ "type": "picture", "slot": "main", "settings": settings });
    page.send(Message::text(message.to_string())).unwrap();
}

/// Processor time of this process in seconds, of which only Linux tells.
fn processor_time() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let words: Vec<&str> = stat.rsplit(')').next()?.split_whitespace().collect();
    let ticks = words.get(11)?.parse::<f64>().ok()? + words.get(12)?.parse::<f64>().ok()?;
    Some(ticks / 100.0)
}

/// Processor time that something takes; 0 where nobody tells.
fn processor_time_of(what: impl FnOnce()) -> f64 {
    let before = processor_time();
    what();
    match (before, processor_time()) {
        (Some(before), Some(after)) => after - before,
        _ => 0.0,
    }
}

#[test]
#[ignore = "it measures time"]
fn a_picture_of_600000_spheres_comes_at_once_and_the_server_rests() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("spheres.pov");
    let text = "camera { location <0, 60, -140> look_at 0 }\nlight_source { <100, 300, -200>, 1 }\n\
        #declare R = seed(1);\n#declare I = 0;\n#while (I < 600000)\n\
        sphere { <rand(R) - 0.5, rand(R) - 0.5, rand(R) - 0.5> * 100, 0.3 pigment { rgb <1, 0.6, 0.2> } finish { reflection 0.2 } }\n\
        #declare I = I + 1;\n#end\n";
    std::fs::write(&path, text).unwrap();
    let (served, thread) = start(&path);
    let mut first = page(&served);
    let begun = Instant::now();
    show(&mut first, json!({}));
    let picture = until(&mut first, "picture");
    let loaded = begun.elapsed().as_secs_f64();
    let mut coarse = 0.0;
    let alone = processor_time_of(|| {
        until_covered(&mut first, picture["picture"].as_u64().unwrap(), 800 * 600);
        coarse = begun.elapsed().as_secs_f64() - loaded;
        until(&mut first, "done");
    });
    println!(
        "600,000 spheres: loaded in {loaded:.2} s, first whole coarse picture {coarse:.3} s later"
    );

    let mut second = page(&served);
    let shared = processor_time_of(|| {
        show(&mut second, json!({}));
        until(&mut second, "done");
    });
    println!(
        "processor time of the picture: {alone:.2} s for the first page, {shared:.3} s for a second one"
    );
    let idle = processor_time_of(|| std::thread::sleep(Duration::from_secs(5))) / 5.0;
    println!("idle with two pages: {:.2} % of a processor", 100.0 * idle);
    served.end();
    thread.join().unwrap();
    assert!(coarse < 1.0, "a coarse picture within a second");
    assert!(shared < 0.1 * alone + 0.05, "pages share their pictures");
    assert!(idle < 0.05, "the server rests");
}

#[test]
#[ignore = "it measures time"]
fn moving_the_camera_shows_ten_pictures_a_second() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/lecture");
    let mut scenes: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "pov"))
        .collect();
    scenes.sort();
    let mut slow = vec![];
    for scene in scenes {
        let (served, thread) = start(&scene);
        let mut page = page(&served);
        show(&mut page, json!({}));
        let mut camera = until(&mut page, "picture")["camera"].clone();
        until(&mut page, "done");
        let begun = Instant::now();
        let count = 20;
        for _ in 0..count {
            let x = camera["eye"][0].as_f64().unwrap();
            camera["eye"][0] = json!(x + 0.01);
            show(&mut page, json!({ "camera": camera }));
            let number = until(&mut page, "picture")["picture"].as_u64().unwrap();
            until_covered(&mut page, number, 800 * 600);
        }
        let rate = f64::from(count) / begun.elapsed().as_secs_f64();
        let name = scene.file_name().unwrap().display().to_string();
        println!("{name}: {rate:.1} pictures/s");
        if rate < 10.0 {
            slow.push(name);
        }
        served.end();
        thread.join().unwrap();
    }
    assert!(slow.is_empty(), "{slow:?}");
}
