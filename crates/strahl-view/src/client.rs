//! A page that is open: its pictures and its questions.

use crate::camera::camera_sdl;
use crate::colors::{Look, srgb8};
use crate::export::explanation_page;
use crate::pictures::{End, Kind, News, Picture};
use crate::protocol::{
    Asked, COLORS, CameraData, Channel, DEEPEST, LINEAR, LONGEST_SIDE, LONGEST_TEXT, MARKS,
    MOST_PIXELS, Settings, Slot, header,
};
use crate::scenes::{Compiled, Key, Request};
use crate::server::Hub;
use crate::texts::{Text, is_sdl, pieces};
use crate::walk::walk_json;
use axum::extract::ws::{Message, WebSocket};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::io::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use strahl::prelude::*;
use strahl::tracing::PrimaryRays;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

/// The size of pictures for which nobody has another.
const USUAL_SIZE: (u32, u32) = (800, 600);
/// How many questions of a page are worked on at once.
const MOST_WORK: usize = 8;
/// The most pixels whose linear values are sent at once.
const MOST_LINEAR: u64 = 1 << 16;
/// The longest answer in bytes.
const LONGEST_ANSWER: usize = 64 << 20;

/// A page.
pub(crate) struct Client {
    hub: Arc<Hub>,
    number: u64,
    socket: WebSocket,
    path: PathBuf,
    /// The name of a scene that is built in.
    name: Option<String>,
    text: Option<Arc<str>>,
    slots: HashMap<Slot, Shown>,
    news: UnboundedReceiver<(u64, u32, News)>,
    follower: UnboundedSender<(u64, u32, News)>,
    answers: UnboundedReceiver<Message>,
    answer: UnboundedSender<Message>,
    work: Arc<AtomicUsize>,
}

/// A picture on the page.
struct Shown {
    settings: Settings,
    /// What the page knows of the scene: the number of what was compiled, and whether it is being loaded again.
    told: Option<(Option<u64>, bool)>,
    compiled: Option<Arc<Compiled>>,
    picture: Option<Arc<Picture>>,
    look: Look,
}

/// The page has gone.
struct Gone;

impl From<axum::Error> for Gone {
    fn from(_: axum::Error) -> Self {
        Self
    }
}

/// Counts a question that is being worked on.
struct Busy(Arc<AtomicUsize>);

impl Drop for Busy {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Client {
    pub(crate) fn new(hub: Arc<Hub>, number: u64, socket: WebSocket) -> Self {
        let (follower, news) = unbounded_channel();
        let (answer, answers) = unbounded_channel();
        let scene = hub.scene.clone();
        let names = hub.builtin.as_ref().map(|scenes| scenes.names());
        let own = |name: &&String| scene.ends_with(Path::new(name.as_str()));
        let name = names.and_then(|names| names.iter().find(own)).cloned();
        Self {
            hub,
            number,
            socket,
            path: scene,
            name,
            text: None,
            slots: HashMap::new(),
            news,
            follower,
            answers,
            answer,
            work: Arc::default(),
        }
    }

    /// Serves the page until it goes.
    pub(crate) async fn run(mut self) {
        // A page that has gone is no error.
        let _ = self.talk().await;
        for (slot, shown) in std::mem::take(&mut self.slots) {
            if let Some(picture) = &shown.picture {
                self.hub.pictures.leave(picture, self.who(slot));
            }
        }
    }

    async fn talk(&mut self) -> Result<(), Gone> {
        let mut changes = self.hub.scenes.changes();
        self.hello().await?;
        loop {
            tokio::select! {
                message = self.socket.recv() => match message {
                    Some(Ok(Message::Text(text))) => self.asked(&text).await?,
                    Some(Ok(Message::Binary(_))) => self.complain("binary messages have no meaning here").await?,
                    Some(Ok(Message::Ping(_) | Message::Pong(_))) => {}
                    Some(Ok(Message::Close(_)) | Err(_)) | None => return Ok(()),
                },
                Some((who, picture, news)) = self.news.recv() => self.tell(who, picture, news).await?,
                Some(message) = self.answers.recv() => self.socket.send(message).await?,
                Ok(()) = changes.changed() => {
                    for slot in self.slots.keys().copied().collect::<Vec<_>>() {
                        self.show(slot).await?;
                    }
                }
            }
        }
    }

    /// The follower of pictures of a slot.
    fn who(&self, slot: Slot) -> u64 {
        self.number * 4 + slot as u64
    }

    async fn send(&mut self, value: &Value) -> Result<(), Gone> {
        Ok(self
            .socket
            .send(Message::Text(value.to_string().into()))
            .await?)
    }

    async fn complain(&mut self, message: &str) -> Result<(), Gone> {
        self.send(&json!({ "type": "error", "message": message }))
            .await
    }

    async fn hello(&mut self) -> Result<(), Gone> {
        let hub = &self.hub;
        let accelerators = AcceleratorKind::ALL.iter().map(|kind| kind.name());
        let hello = json!({
            "type": "hello",
            "version": env!("CARGO_PKG_VERSION"),
            "scenes": hub.builtin.as_ref().map(|scenes| scenes.names()),
            "edit": hub.edit,
            "editor": hub.editor.is_some(),
            "threads": hub.session.threads(),
            "accelerators": accelerators.collect::<Vec<_>>(),
            "shading": ShadingModel::ALL.map(|(name, _)| name),
        });
        self.send(&hello).await
    }

    async fn asked(&mut self, text: &str) -> Result<(), Gone> {
        let asked: Asked = match serde_json::from_str(text) {
            Ok(asked) => asked,
            Err(error) => return self.complain(&format!("no such message: {error}")).await,
        };
        match asked {
            Asked::Open { scene } => {
                let path = self
                    .hub
                    .builtin
                    .as_ref()
                    .and_then(|scenes| scenes.path(&scene));
                let Some(path) = path else {
                    return self.complain(&format!("there is no scene `{scene}`")).await;
                };
                (self.path, self.name, self.text) = (path, Some(scene), None);
                self.show_all().await
            }
            Asked::Text { text } => {
                if text.as_ref().is_some_and(|text| text.len() > LONGEST_TEXT) {
                    return self.complain("the text is too long").await;
                }
                self.text = text.map(Arc::from);
                self.show_all().await
            }
            Asked::Picture { slot, settings } => {
                if let Err(problem) = check(&settings) {
                    let (kind, message) = ("error", problem);
                    let message = json!({ "type": kind, "slot": slot, "message": message });
                    return self.send(&message).await;
                }
                match self.slots.get_mut(&slot) {
                    Some(shown) => shown.settings = settings,
                    None => drop(self.slots.insert(slot, Shown::new(settings))),
                }
                self.show(slot).await
            }
            Asked::Close { slot } => {
                if let Some(picture) = self.slots.remove(&slot).and_then(|shown| shown.picture) {
                    self.hub.pictures.leave(&picture, self.who(slot));
                }
                Ok(())
            }
            Asked::Linear { slot, region } => self.linear(slot, region).await,
            Asked::Source { id, file } => {
                let answer = self.source(&file);
                self.reply(id, answer).await
            }
            Asked::Pieces { id, text } => {
                let answer = match text.len() > LONGEST_TEXT {
                    true => Err("the text is too long".into()),
                    false => Ok(json!({ "pieces": pieces(&text) })),
                };
                self.reply(id, answer).await
            }
            Asked::Save { id, file, text } => {
                let answer = self.save(&file, &text);
                self.reply(id, answer).await
            }
            Asked::Edit { id, file, line } => {
                let answer = self.edit(&file, line);
                self.reply(id, answer).await
            }
            Asked::CameraText { id, slot } => self.ask(id, slot, None, |_, picture, _| {
                let view = &picture.view;
                let aspect = f64::from(view.width) / f64::from(view.height);
                let text = camera_sdl(&view.camera, aspect);
                let none = "only perspective and orthographic cameras have such a text";
                text.map(|text| json!({ "text": text })).ok_or(none.into())
            }),
            Asked::Hover { id, slot, x, y } => self.ask(id, slot, Some((x, y)), hover),
            Asked::Explain { id, slot, x, y } => {
                self.ask(id, slot, Some((x, y)), |hub, picture, (x, y)| {
                    let tree = hub.session.explain(&picture.view, x, y);
                    let tree = tree.map_err(|e| e.to_string())?;
                    serde_json::to_value(tree).map_err(|e| e.to_string())
                })
            }
            Asked::Export {
                id,
                slot,
                x,
                y,
                language,
            } => {
                let title = self.title();
                self.ask(id, slot, Some((x, y)), move |hub, picture, (x, y)| {
                    let tree = hub.session.explain(&picture.view, x, y);
                    let tree = tree.map_err(|e| e.to_string())?;
                    let html = explanation_page(&tree, &title, &language);
                    Ok(json!({ "html": html }))
                })
            }
            Asked::Walk { id, slot, ray } => {
                let ray = Ray::new(ray[0].into(), ray[1].into());
                self.ask(id, slot, None, move |_, picture, _| {
                    Ok(walk_json(picture.view.scene(), &ray))
                })
            }
            Asked::Mark {
                id,
                slot,
                file,
                line,
            } => self.mark(id, slot, file, line),
        }
    }

    /// Answers a question at once.
    async fn reply(&mut self, id: u64, answer: Result<Value, String>) -> Result<(), Gone> {
        let message = reply(id, answer);
        Ok(self.socket.send(message).await?)
    }

    /// Works on a question about a pixel in a thread of its own.
    fn ask(
        &self,
        id: u64,
        slot: Slot,
        pixel: Option<(u32, u32)>,
        work: impl FnOnce(&Hub, &Picture, (u32, u32)) -> Result<Value, String> + Send + 'static,
    ) -> Result<(), Gone> {
        let picture = self
            .slots
            .get(&slot)
            .and_then(|shown| shown.picture.clone());
        let Some(picture) = picture else {
            let none = reply(id, Err("there is no picture".into()));
            return self.answer.send(none).map_err(|_| Gone);
        };
        let at = pixel.unwrap_or_default();
        if at.0 >= picture.view.width || at.1 >= picture.view.height {
            let none = reply(id, Err("there is no such pixel".into()));
            return self.answer.send(none).map_err(|_| Gone);
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
            let refused = reply(id, Err("too many questions at once".into()));
            return self.answer.send(refused).map_err(|_| Gone);
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
            Err(error) => {
                let failed = reply(id, Err(error.to_string()));
                self.answer.send(failed).map_err(|_| Gone)
            }
        }
    }

    /// The name of the scene.
    fn title(&self) -> String {
        match &self.name {
            Some(name) => name.clone(),
            None => self.path.display().to_string(),
        }
    }

    async fn show_all(&mut self) -> Result<(), Gone> {
        for slot in self.slots.keys().copied().collect::<Vec<_>>() {
            self.show(slot).await?;
        }
        Ok(())
    }

    /// Brings a slot up to date: its scene, then its picture.
    async fn show(&mut self, slot: Slot) -> Result<(), Gone> {
        let (who, title) = (self.who(slot), self.title());
        let Some(shown) = self.slots.get_mut(&slot) else {
            return Ok(());
        };
        let defaults = &self.hub.defaults;
        let settings = &shown.settings;
        let named = settings.accelerator.as_ref();
        let accelerator = named.and_then(|name| name.parse().ok());
        let key = Key {
            request: Request {
                path: self.path.clone(),
                text: self.text.clone(),
                size: settings.size.map(Into::into).or(defaults.size),
                clock: settings.clock.unwrap_or(defaults.clock),
            },
            accelerator: accelerator.unwrap_or(defaults.accelerator),
        };
        let (compiled, loading) = self.hub.scenes.want(&key);
        let told = (compiled.as_ref().map(|c| c.number), loading);
        let mut messages = vec![];
        if shown.told != Some(told) {
            shown.told = Some(told);
            messages.push(scene_message(slot, &title, compiled.as_deref(), loading));
        }
        shown.compiled = compiled.or_else(|| shown.compiled.take());
        let scene = shown
            .compiled
            .as_ref()
            .and_then(|c| Some((c.number, c.scene.as_ref()?)));
        let mut whole = None;
        if let Some((number, scene)) = scene {
            let view = view_of(scene, settings, &self.hub);
            let kind = settings.channel.kind();
            let pictures = &self.hub.pictures;
            let picture = pictures.follow(number, &view, kind, who, &self.follower);
            let is_new = shown
                .picture
                .as_ref()
                .is_none_or(|old| !Arc::ptr_eq(old, &picture));
            if let Some(old) = shown.picture.replace(Arc::clone(&picture)) {
                pictures.leave(&old, who);
            }
            let look = Look {
                channel: settings.channel,
                gain: settings.exposure.exp2(),
                diagonal: scene.diagonal(),
                scale: 0.0,
            };
            if is_new {
                messages.push(picture_message(slot, &picture));
            }
            let changed = shown.look.channel != look.channel || shown.look.gain != look.gain;
            if is_new || changed {
                shown.look = look;
                let canvas = picture.canvas();
                let (begun, end) = (canvas.begun, canvas.end.is_some());
                drop(canvas);
                whole = (begun || end).then_some((Arc::clone(&picture), end));
            }
        }
        for message in messages {
            self.send(&message).await?;
        }
        if let Some((picture, end)) = whole {
            let (number, region) = (picture.number, picture.region());
            self.tell(who, number, News::Part { region, step: 1 })
                .await?;
            if end {
                self.tell(who, number, News::End).await?;
            }
        }
        Ok(())
    }

    /// Passes news of a picture on to the page.
    async fn tell(&mut self, who: u64, number: u32, news: News) -> Result<(), Gone> {
        let shown = self
            .slots
            .iter_mut()
            .find(|(slot, _)| self.number * 4 + **slot as u64 == who);
        let Some((&slot, shown)) = shown else {
            return Ok(());
        };
        let Some(picture) = shown.picture.clone().filter(|p| p.number == number) else {
            return Ok(());
        };
        let channel = shown.look.channel;
        // The scale of counts is known at the end.
        let counts =
            picture.kind == Kind::Costs || matches!(channel, Channel::Levels | Channel::Tests);
        match news {
            News::Part { .. } if counts => Ok(()),
            News::Part { region, step } => {
                let look = shown.look;
                self.part(&picture, region, step, &look).await
            }
            News::End => {
                if counts {
                    shown.look.scale = channel.scale(&picture);
                    let look = shown.look;
                    self.part(&picture, picture.region(), 1, &look).await?;
                }
                let end = picture.canvas().end.clone();
                let scale = self.slots.get(&slot).map(|shown| shown.look.scale);
                let message = match end {
                    Some(End::Finished {
                        seconds,
                        rays,
                        sha256,
                    }) => json!({
                        "type": "done", "slot": slot, "picture": number, "seconds": seconds, "rays": rays, "sha256": sha256, "scale": scale,
                    }),
                    Some(End::Failed(message)) => {
                        json!({ "type": "error", "slot": slot, "message": message })
                    }
                    None => return Ok(()),
                };
                self.send(&message).await
            }
        }
    }

    /// Sends the colours of a part of a picture.
    async fn part(
        &mut self,
        picture: &Picture,
        region: Region,
        step: u32,
        look: &Look,
    ) -> Result<(), Gone> {
        let mut message = header(COLORS, picture.number, region, step);
        message.extend(srgb8(picture, region, step, look));
        Ok(self.socket.send(Message::Binary(message.into())).await?)
    }

    async fn linear(&mut self, slot: Slot, [x, y, width, height]: [u32; 4]) -> Result<(), Gone> {
        let picture = self
            .slots
            .get(&slot)
            .and_then(|shown| shown.picture.clone());
        let asked = Region {
            x,
            y,
            width: width.min(LONGEST_SIDE),
            height: height.min(LONGEST_SIDE),
        };
        let fits = x < LONGEST_SIDE && y < LONGEST_SIDE;
        let region = picture
            .as_ref()
            .filter(|_| fits)
            .and_then(|p| p.region().intersection(&asked));
        let (Some(picture), Some(region)) = (picture, region) else {
            return self.complain("there is no such part of the picture").await;
        };
        if region.pixels() > MOST_LINEAR {
            return self.complain("the part of the picture is too large").await;
        }
        let mut message = header(LINEAR, picture.number, region, 1);
        {
            let canvas = picture.canvas();
            for y in region.y..region.y + region.height {
                let start = y as usize * picture.view.width as usize + region.x as usize;
                let row = canvas.pixels.get(start..start + region.width as usize);
                for value in row.unwrap_or_default().as_flattened() {
                    message.extend(value.to_le_bytes());
                }
            }
        }
        Ok(self.socket.send(Message::Binary(message.into())).await?)
    }

    /// The path of a file of the scene; no other file is read or written.
    fn file(&self, name: &str) -> Result<PathBuf, String> {
        let compiled = self
            .slots
            .values()
            .filter_map(|shown| shown.compiled.as_ref());
        let mut files = compiled.flat_map(|compiled| &compiled.files);
        let known = files.find(|file| file.name == name);
        known
            .map(|file| file.path.clone())
            .ok_or_else(|| format!("the scene has no file `{name}`"))
    }

    fn source(&self, name: &str) -> Result<Value, String> {
        let path = self.file(name)?;
        let text = match &self.text {
            Some(text) if path == crate::scenes::absolute(&self.path) => {
                Text::new(text.to_string(), is_sdl(&path))
            }
            _ => Text::read(&path)?,
        };
        serde_json::to_value(text).map_err(|e| e.to_string())
    }

    fn save(&mut self, name: &str, text: &str) -> Result<Value, String> {
        if !self.hub.edit {
            return Err("files are written only with `strahl view --edit`".into());
        }
        if text.len() > LONGEST_TEXT {
            return Err("the text is too long".into());
        }
        let path = self.file(name)?;
        let folder = path.parent().unwrap_or(Path::new("."));
        // Never half a file; and the file's permissions stay.
        let write = || -> std::io::Result<()> {
            let mut file = tempfile::NamedTempFile::new_in(folder)?;
            file.write_all(text.as_bytes())?;
            if let Ok(known) = std::fs::metadata(&path) {
                std::fs::set_permissions(file.path(), known.permissions())?;
            }
            file.persist(&path)?;
            Ok(())
        };
        write().map_err(|e| e.to_string())?;
        if path == crate::scenes::absolute(&self.path) {
            self.text = None;
        }
        Ok(json!({}))
    }

    fn edit(&self, name: &str, line: u32) -> Result<Value, String> {
        let editor = self.hub.editor.as_ref();
        let editor = editor.ok_or("start with `strahl view --editor COMMAND`")?;
        let (path, line) = (self.file(name)?.display().to_string(), line.to_string());
        let mut words: Vec<String> = editor
            .split_whitespace()
            .map(|word| word.replace("{file}", &path).replace("{line}", &line))
            .collect();
        if !editor.contains("{file}") {
            words.extend([format!("+{line}"), path]);
        }
        let (program, rest) = words
            .split_first()
            .ok_or("the command of --editor is empty")?;
        let mut child = Command::new(program)
            .args(rest)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .map_err(|e| format!("{program}: {e}"))?;
        // Waits for its end, so that no zombie is left.
        std::thread::spawn(move || child.wait());
        Ok(json!({}))
    }

    /// Marks the pixels of the objects that a line of the scene has made: those that begin on it, or on the last line before.
    fn mark(&self, id: u64, slot: Slot, file: String, line: u32) -> Result<(), Gone> {
        let picture = self
            .slots
            .get(&slot)
            .and_then(|shown| shown.picture.clone());
        let Some(picture) = picture else {
            let none = reply(id, Err("there is no picture".into()));
            return self.answer.send(none).map_err(|_| Gone);
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
            let view = picture
                .view
                .clone()
                .with_sampling(Sampling::Center)
                .with_depth(1);
            let output = Output {
                info: true,
                ..Output::default()
            };
            let film = hub
                .session
                .picture(&view, &output)
                .map_err(|e| e.to_string())?
                .film;
            let mut message = header(MARKS, picture.number, picture.region(), 1);
            message[28..32].copy_from_slice(&first.to_le_bytes());
            let info = film.info.unwrap_or_default();
            message.extend(
                info.iter()
                    .map(|info| u8::from(made.get(info.object as usize) == Some(&true))),
            );
            Ok(Message::Binary(message.into()))
        })
    }
}

impl Shown {
    fn new(settings: Settings) -> Self {
        Self {
            settings,
            told: None,
            compiled: None,
            picture: None,
            look: Look {
                channel: Channel::Color,
                gain: 1.0,
                diagonal: 1.0,
                scale: 0.0,
            },
        }
    }
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

/// Whether settings of a page make sense.
fn check(settings: &Settings) -> Result<(), String> {
    if let Some([width, height]) = settings.size {
        let pixels = u64::from(width) * u64::from(height);
        let sides = 1..=LONGEST_SIDE;
        if !(sides.contains(&width) && sides.contains(&height) && pixels <= MOST_PIXELS) {
            return Err(format!(
                "pictures have at most {LONGEST_SIDE} pixels a side, and {MOST_PIXELS} in all"
            ));
        }
    }
    if settings
        .depth
        .is_some_and(|depth| !(1..=DEEPEST).contains(&depth))
    {
        return Err(format!("the depth is a number from 1 to {DEEPEST}"));
    }
    if settings
        .cutoff
        .is_some_and(|cutoff| !(0.0..=1.0).contains(&cutoff))
    {
        return Err("the cutoff is a number from 0 to 1".into());
    }
    if !(-30.0..=30.0).contains(&settings.exposure) {
        return Err("the exposure is a number from -30 to 30".into());
    }
    if let Some(sampling) = &settings.sampling {
        sampling.parse::<Sampling>().map_err(|e| e.to_string())?;
    }
    if let Some(shading) = &settings.shading {
        shading.parse::<ShadingModel>().map_err(|e| e.to_string())?;
    }
    if let Some(accelerator) = &settings.accelerator {
        // Without parameters: a page may not ask for a grid of any size.
        let mut all = AcceleratorKind::ALL.iter();
        if !all.any(|kind| kind.name() == accelerator) {
            return Err(format!("there is no accelerator `{accelerator}`"));
        }
    }
    if settings.clock.is_some_and(|clock| !clock.is_finite()) {
        return Err("the clock is a number".into());
    }
    Ok(())
}

/// The view that settings ask for. They have been checked.
fn view_of(scene: &Arc<RenderScene>, settings: &Settings, hub: &Hub) -> View {
    let defaults = &hub.defaults;
    let size = settings.size.map(Into::into).or(defaults.size);
    let (width, height) = size.or(scene.settings().size).unwrap_or(USUAL_SIZE);
    let mut view = scene.view(width, height);
    let sampling = settings.sampling.as_ref().and_then(|s| s.parse().ok());
    view.sampling = sampling.unwrap_or(defaults.sampling);
    if settings.channel.kind() != Kind::Color {
        // One ray per pixel shows its values.
        view.sampling = Sampling::Center;
    }
    view.seed = defaults.seed;
    view.trace.max_tree_rays = defaults.max_tree_rays;
    let shading = settings.shading.as_ref().and_then(|s| s.parse().ok());
    view.trace.force_shading = shading.or(defaults.shading);
    if let Some(depth) = settings.depth.or(defaults.depth) {
        view.trace.max_depth = depth;
    }
    if let Some(cutoff) = settings.cutoff.or(defaults.cutoff) {
        view.trace.adc_bailout = cutoff;
    }
    if let Some(camera) = &settings.camera {
        view.camera = camera.apply(&view.camera);
    }
    view
}

fn scene_message(slot: Slot, title: &str, compiled: Option<&Compiled>, loading: bool) -> Value {
    let files = compiled.map_or(&[][..], |compiled| &compiled.files);
    let stats = compiled.and_then(|compiled| {
        let scene = compiled.scene.as_ref()?;
        let (stats, bounds) = (scene.stats(), scene.bounds());
        Some(json!({
            "objects": scene.objects().len(),
            "primitives": stats.primitives,
            "lights": scene.lights().len(),
            "accelerator": scene.accelerator_name(),
            "low": bounds.min.to_array(),
            "high": bounds.max.to_array(),
        }))
    });
    json!({
        "type": "scene",
        "slot": slot,
        "name": title,
        "number": compiled.map(|compiled| compiled.number),
        "loading": loading,
        "said": compiled.map(|compiled| &compiled.said),
        "files": files.iter().map(|file| &file.name).collect::<Vec<_>>(),
        "seconds": compiled.map(|compiled| compiled.seconds),
        "stats": stats,
    })
}

fn picture_message(slot: Slot, picture: &Picture) -> Value {
    let view = &picture.view;
    json!({
        "type": "picture",
        "slot": slot,
        "picture": picture.number,
        "width": view.width,
        "height": view.height,
        "sampling": view.sampling.to_string(),
        "depth": view.trace.max_depth,
        "cutoff": view.trace.adc_bailout,
        "camera": CameraData::of(&view.camera),
        "own_camera": CameraData::of(view.scene().camera()),
        "aspect": view.camera.aspect,
    })
}

/// The ray through the centre of a pixel.
fn chief_ray(view: &View, x: u32, y: u32) -> Option<Ray> {
    let rays: PrimaryRays = view.rays().ok()?;
    rays.ray(f64::from(x) + 0.5, f64::from(y) + 0.5)
}

/// What is seen at a pixel.
fn hover(hub: &Hub, picture: &Picture, (x, y): (u32, u32)) -> Result<Value, String> {
    let view = &picture.view;
    let linear = {
        let canvas = picture.canvas();
        let index = y as usize * view.width as usize + x as usize;
        canvas.pixels.get(index).copied().unwrap_or_default()
    };
    let codes = linear.map(|c| strahl::shade::srgb::encode_u8(f64::from(c)));
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
