//! Questions of a page, each worked on in a thread of its own.

use super::messages::{key_of, moved};
use super::{Busy, Client, Gone};
use crate::export::{PicturePage, USUAL_TREES};
use crate::hub::Hub;
use crate::pictures::{End, Kind, Picture};
use crate::protocol::{MARKS, Slot, header};
use axum::extract::ws::Message;
use serde_json::{Value, json};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;
use strahl::prelude::*;
use strahl::tracing::PrimaryRays;

/// How many questions of a page are worked on at once.
const MOST_WORK: usize = 8;
/// The most pixels of the picture with which accelerators are compared.
const MOST_MEASURED: f64 = 65536.0;
/// The most primitives for which the list is compared with the others.
const MOST_LISTED: usize = 2000;
/// The most pixels that are chosen for a page.
const MOST_CHOSEN: usize = 1000;
/// The longest answer in bytes.
const LONGEST_ANSWER: usize = 64 << 20;

impl Client {
    /// Answers a question at once.
    pub(super) async fn reply(
        &mut self,
        id: u64,
        answer: Result<Value, String>,
    ) -> Result<(), Gone> {
        self.put(reply(id, answer)).await
    }

    /// Answers a question with a problem.
    fn refuse(&self, id: u64, problem: &str) -> Result<(), Gone> {
        let refusal = reply(id, Err(problem.into()));
        self.answer.send(refusal).map_err(|_| Gone)
    }

    /// Works on a question about a pixel in a thread of its own.
    pub(super) fn ask(
        &self,
        id: u64,
        slot: Slot,
        pixel: Option<(u32, u32)>,
        work: impl FnOnce(&Hub, &Picture, (u32, u32)) -> Result<Value, String> + Send + 'static,
    ) -> Result<(), Gone> {
        let Some(picture) = self.picture(slot) else {
            return self.refuse(id, "there is no picture");
        };
        let at = pixel.unwrap_or_default();
        if at.0 >= picture.view.width || at.1 >= picture.view.height {
            return self.refuse(id, "there is no such pixel");
        }
        self.work(id, move |hub| {
            work(hub, &picture, at).map(|value| reply(id, Ok(value)))
        })
    }

    /// Works on a question in a thread of its own.
    fn work(
        &self,
        id: u64,
        work: impl FnOnce(&Hub) -> Result<Message, String> + Send + 'static,
    ) -> Result<(), Gone> {
        let busy = Busy(Arc::clone(&self.work));
        if self.work.fetch_add(1, Ordering::Relaxed) >= MOST_WORK {
            return self.refuse(id, "too many questions at once");
        }
        let (hub, answer) = (Arc::clone(&self.hub), self.answer.clone());
        let thread = std::thread::Builder::new().name("strahl question".into());
        let spawned = thread.spawn(move || {
            let _busy = busy;
            let outcome = catch_unwind(AssertUnwindSafe(|| work(&hub)));
            let outcome = outcome.unwrap_or_else(|_| Err("strahl failed: please report it".into()));
            // Without a receiver the page has gone.
            let _ = answer.send(outcome.unwrap_or_else(|problem| reply(id, Err(problem))));
        });
        match spawned {
            Ok(_) => Ok(()),
            Err(error) => self.refuse(id, &error.to_string()),
        }
    }

    /// What the picture costs with each accelerator, one ray per pixel and at most [`MOST_MEASURED`] pixels.
    pub(super) fn table(&self, id: u64, slot: Slot) -> Result<(), Gone> {
        let (Some(shown), Some(picture)) = (self.slots.get(&slot), self.picture(slot)) else {
            return self.refuse(id, "there is no picture");
        };
        let settings = &shown.settings;
        let key = key_of(&self.path, &self.texts, settings, &self.hub.defaults);
        let lights = settings.lights.clone();
        let page = self.answer.clone();
        self.work(id, move |hub| {
            let description = hub.scenes.description(&key.request)?;
            let view = &picture.view;
            let pixels = f64::from(view.width) * f64::from(view.height);
            let factor = (MOST_MEASURED / pixels).sqrt().min(1.0);
            let side = |length: u32| ((f64::from(length) * factor) as u32).max(1);
            let (width, height) = (side(view.width), side(view.height));
            let few = view.scene().stats().primitives <= MOST_LISTED;
            let all = AcceleratorKind::ALL.iter();
            let mut rows = vec![];
            for &accelerator in all.filter(|one| few || one.name() != "list") {
                if page.is_closed() {
                    return Err("the page has gone".into());
                }
                let options = CompileOptions { accelerator };
                let start = Instant::now();
                let built = hub.session.compile(&description, &options);
                let (scene, _) = built.map_err(|problems| problems.to_string())?;
                let built = start.elapsed().as_secs_f64();
                let mut measured = moved(&scene, &lights)
                    .view(width, height)
                    .with_camera(view.camera.clone());
                (measured.seed, measured.trace) = (view.seed, view.trace);
                rows.push(row(&hub.session, accelerator, built, &measured)?);
            }
            let answer = json!({ "width": width, "height": height, "rows": rows });
            Ok(reply(id, Ok(answer)))
        })
    }

    /// Marks the pixels of the objects that a line of the scene has made: those that begin on it, or on the last line before.
    pub(super) fn mark(&self, id: u64, slot: Slot, file: String, line: u32) -> Result<(), Gone> {
        let Some(picture) = self.picture(slot) else {
            return self.refuse(id, "there is no picture");
        };
        self.work(id, move |hub| {
            let scene = picture.view.scene();
            let objects = || {
                (0..scene.objects().len() as u32).filter_map(|n| Some((n, scene.objects().get(n)?)))
            };
            let in_file =
                |span: strahl::scene::Span| scene.sources().name(span.file) == Some(&*file);
            let lines = objects()
                .filter(|(_, o)| in_file(o.span))
                .map(|(_, o)| o.span.line);
            let first = lines.filter(|l| *l <= line && *l > 0).max();
            let first = first.ok_or("no object begins here or before")?;
            let mut made = vec![false; scene.objects().len() + 1];
            for (number, object) in objects() {
                made[number as usize + 1] = in_file(object.span) && object.span.line == first;
            }
            let seen = picture.objects(&hub.session)?;
            let mut message = header(MARKS, picture.number, picture.region(), 1);
            message[28..32].copy_from_slice(&first.to_le_bytes());
            let is_made = |object: &u32| made.get(*object as usize) == Some(&true);
            message.extend(seen.iter().map(|object| u8::from(is_made(object))));
            Ok(Message::Binary(message.into()))
        })
    }

    /// A page with the picture of a slot, its objects and the trees of some of its pixels.
    pub(super) fn export_picture(
        &self,
        id: u64,
        slot: Slot,
        chosen: Vec<[u32; 2]>,
        language: String,
    ) -> Result<(), Gone> {
        if chosen.len() > MOST_CHOSEN {
            return self.refuse(id, "there are too many chosen pixels");
        }
        let (title, texts) = (self.title(), self.scene_texts(slot));
        self.ask(id, slot, None, move |hub, picture, _| {
            let view = &picture.view;
            let pixels = {
                let canvas = picture.canvas();
                let finished = matches!(canvas.end, Some(End::Finished { .. }));
                if !finished || picture.kind != Kind::Color {
                    return Err("there is no finished picture in colour yet".into());
                }
                canvas.pixels.clone()
            };
            let page = PicturePage {
                title: &title,
                language: &language,
                texts: &texts,
                chosen: &chosen,
                trees: USUAL_TREES,
            };
            let html = page.write(&hub.session, view, &pixels)?;
            Ok(json!({ "html": html }))
        })
    }
}

/// What a view costs with an accelerator that was built in so many seconds.
fn row(
    session: &Session,
    accelerator: AcceleratorKind,
    built: f64,
    view: &View,
) -> Result<Value, String> {
    let start = Instant::now();
    let rendered = session.picture(view, &Output::default());
    let rendered = rendered.map_err(|e| e.to_string())?;
    Ok(json!({
        "name": accelerator.name(),
        "build": built,
        "seconds": start.elapsed().as_secs_f64(),
        "rays": rendered.rays.total(),
        "steps": rendered.traversal.node_visits,
        "tests": rendered.traversal.primitive_tests,
        "sha256": rendered.film.sha256(),
    }))
}

fn reply(id: u64, answer: Result<Value, String>) -> Message {
    let value = match answer {
        Ok(value) => json!({ "type": "reply", "id": id, "value": value }),
        Err(problem) => json!({ "type": "reply", "id": id, "problem": problem }),
    };
    let text = value.to_string();
    if text.len() > LONGEST_ANSWER {
        let problem = "the answer is too long: choose a coarser sampling or a smaller depth";
        return reply(id, Err(problem.into()));
    }
    Message::Text(text.into())
}

/// The ray through the centre of a pixel.
fn chief_ray(view: &View, x: u32, y: u32) -> Option<Ray> {
    let rays: PrimaryRays = view.rays().ok()?;
    rays.ray(f64::from(x) + 0.5, f64::from(y) + 0.5)
}

/// What is seen at a pixel.
pub(super) fn hover(hub: &Hub, picture: &Picture, (x, y): (u32, u32)) -> Result<Value, String> {
    let view = &picture.view;
    let linear = {
        let canvas = picture.canvas();
        let index = y as usize * view.width as usize + x as usize;
        canvas.pixels.get(index).copied().unwrap_or_default()
    };
    let codes = linear.map(strahl::shade::srgb::encode_u8);
    let scene = view.scene();
    let ray = chief_ray(view, x, y);
    let mut hits = [None];
    if let Some(ray) = ray {
        hub.session
            .closest_hits(scene, &[ray], Interval::FORWARD, &mut hits);
    }
    let seen = ray.zip(hits[0]).map(|(ray, hit)| {
        let info = scene.describe(&ray, &hit);
        let place = scene.sources().locate(info.span);
        json!({
            "object": scene.object_name(info.object),
            "material": scene.material_name(info.material),
            "t": info.t,
            "position": info.position.to_array(),
            "file": place.as_ref().map(|place| place.file),
            "line": place.as_ref().map(|place| place.span.line),
        })
    });
    Ok(json!({
        "x": x,
        "y": y,
        "linear": linear,
        "rgb8": codes,
        "seen": seen,
    }))
}
