//! A page that is open: its pictures and its questions.

mod files;
mod messages;
mod painting;
mod questions;

use crate::camera::camera_sdl;
use crate::colors::Look;
use crate::export::explanation_page;
use crate::hub::Hub;
use crate::lights::light_sdl;
use crate::pictures::{News, Picture};
use crate::protocol::{Asked, Channel, Curve, LONGEST_TEXT, Settings, Slot};
use crate::scenes::{Compiled, Place};
use crate::texts::pieces;
use crate::walk::walk_json;
use axum::extract::ws::{Message, WebSocket};
use messages::{accelerators, check, key_of, picture_message, scene_message, view_of};
use questions::hover;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;
use strahl::prelude::*;
use strahl::sdl::Texts;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

/// A page that takes no message for so long has gone, also if its connection is open.
const PATIENCE: Duration = Duration::from_secs(60);
/// The most bytes of texts that a page tries instead of files.
const MOST_TEXT: usize = 4 * LONGEST_TEXT;

/// A page.
pub(crate) struct Client {
    hub: Arc<Hub>,
    number: u64,
    socket: WebSocket,
    path: PathBuf,
    /// The name of a scene that is built in.
    name: Option<String>,
    /// The texts that the page tries instead of files.
    texts: Texts,
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
    /// The place of the scene that is wanted.
    place: Option<Place>,
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
        let names = hub.offered.as_ref().map(|scenes| scenes.names());
        let own = |name: &&String| scene.ends_with(Path::new(name.as_str()));
        let name = names.and_then(|names| names.iter().find(own)).cloned();
        Self {
            hub,
            number,
            socket,
            path: scene,
            name,
            texts: Texts::new(),
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
        for slot in self.slots.keys().copied().collect::<Vec<_>>() {
            self.close(slot);
        }
    }

    /// Shows nothing in a slot any more.
    fn close(&mut self, slot: Slot) {
        if let Some(picture) = self.slots.remove(&slot).and_then(|shown| shown.picture) {
            self.hub.pictures.leave(&picture, self.who(slot));
        }
        self.hub.scenes.left();
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
                Some(message) = self.answers.recv() => self.put(message).await?,
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

    async fn put(&mut self, message: Message) -> Result<(), Gone> {
        let sent = tokio::time::timeout(PATIENCE, self.socket.send(message)).await;
        Ok(sent.map_err(|_| Gone)??)
    }

    async fn send(&mut self, value: &Value) -> Result<(), Gone> {
        self.put(Message::Text(value.to_string().into())).await
    }

    async fn complain(&mut self, message: &str) -> Result<(), Gone> {
        self.send(&json!({ "type": "error", "message": message }))
            .await
    }

    async fn hello(&mut self) -> Result<(), Gone> {
        let hub = &self.hub;
        let hello = json!({
            "type": "hello",
            "version": env!("CARGO_PKG_VERSION"),
            "scenes": hub.offered.as_ref().map(|scenes| scenes.names()),
            "edit": hub.edit,
            "editor": hub.editor.is_some(),
            "threads": hub.session.threads(),
            "accelerators": accelerators().collect::<Vec<_>>(),
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
                    .offered
                    .as_ref()
                    .and_then(|scenes| scenes.path(&scene));
                let Some(path) = path else {
                    return self.complain(&format!("there is no scene `{scene}`")).await;
                };
                (self.path, self.name) = (path, Some(scene));
                self.texts.clear();
                self.show_all().await
            }
            Asked::Text { file, text } => match self.try_text(file.as_deref(), text) {
                Ok(()) => self.show_all().await,
                Err(problem) => self.complain(&problem).await,
            },
            Asked::Picture { slot, settings } => {
                if let Err(problem) = check(&settings) {
                    let (kind, message) = ("error", problem);
                    let message = json!({ "type": kind, "slot": slot, "message": message });
                    return self.send(&message).await;
                }
                match self.slots.get_mut(&slot) {
                    Some(shown) => shown.settings = *settings,
                    None => drop(self.slots.insert(slot, Shown::new(*settings))),
                }
                self.show(slot).await
            }
            Asked::Close { slot } => {
                self.close(slot);
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
            Asked::LightText { id, slot, light } => {
                self.ask(id, slot, None, move |_, picture, _| {
                    let light = picture.view.scene().lights().get(light);
                    let light = light.ok_or("there is no such light")?;
                    let none = "the light has no position";
                    let text = light_sdl(light).ok_or(none)?;
                    Ok(json!({ "text": text }))
                })
            }
            Asked::ExportPicture {
                id,
                slot,
                pixels,
                language,
            } => self.export_picture(id, slot, pixels, language),
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
            Asked::Table { id, slot } => self.table(id, slot),
            Asked::Mark {
                id,
                slot,
                file,
                line,
            } => self.mark(id, slot, file, line),
        }
    }

    /// The picture that a part of the page shows.
    fn picture(&self, slot: Slot) -> Option<Arc<Picture>> {
        self.slots.get(&slot)?.picture.clone()
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
        let mut messages = vec![];
        let looks_new = self.update(slot, &mut messages);
        for message in messages {
            self.send(&message).await?;
        }
        match looks_new {
            true => self.whole(slot).await,
            false => Ok(()),
        }
    }

    /// Takes the scene and the picture that a slot asks for. Returns whether the page needs all that there is of the picture.
    fn update(&mut self, slot: Slot, messages: &mut Vec<Value>) -> bool {
        let (who, title) = (self.who(slot), self.title());
        let Some(shown) = self.slots.get_mut(&slot) else {
            return false;
        };
        let settings = &shown.settings;
        let key = key_of(&self.path, &self.texts, settings, &self.hub.defaults);
        // Given up first, so that a scene that is wanted no more need not be read to its end.
        shown.place = None;
        let (compiled, loading, place) = self.hub.scenes.want(&key);
        shown.place = Some(place);
        let told = (compiled.as_ref().map(|c| c.number), loading);
        if shown.told != Some(told) {
            shown.told = Some(told);
            messages.push(scene_message(slot, &title, compiled.as_deref(), loading));
        }
        shown.compiled = compiled.or_else(|| shown.compiled.take());
        let scene = shown
            .compiled
            .as_ref()
            .and_then(|c| Some((c.number, c.scene.as_ref()?, c.camera.as_ref()?)));
        let Some((number, scene, camera)) = scene else {
            return false;
        };
        let view = match view_of(scene, camera, settings, &self.hub) {
            Ok(view) => view,
            Err(problem) => {
                messages.push(json!({ "type": "error", "slot": slot, "message": problem }));
                return false;
            }
        };
        let kind = settings.channel.kind();
        let pictures = &self.hub.pictures;
        let name = format!("{number} {:?}", settings.lights);
        let picture = pictures.follow(&name, &view, kind, who, &self.follower);
        let old = shown.picture.replace(Arc::clone(&picture));
        let is_new = old.as_ref().is_none_or(|old| !Arc::ptr_eq(old, &picture));
        if let Some(old) = old {
            pictures.leave(&old, who);
        }
        if is_new {
            messages.push(picture_message(slot, &picture, camera));
        }
        let look = Look {
            channel: settings.channel,
            gain: settings.exposure.exp2(),
            curve: settings.curve,
            diagonal: scene.diagonal(),
            scale: 0.0,
        };
        let looks_new = is_new || !look.shows_the_same(&shown.look);
        if looks_new {
            shown.look = look;
        }
        looks_new
    }

    /// Sends all that there is of a slot's picture.
    async fn whole(&mut self, slot: Slot) -> Result<(), Gone> {
        let Some(picture) = self.picture(slot) else {
            return Ok(());
        };
        let (begun, end) = {
            let canvas = picture.canvas();
            (canvas.begun, canvas.end.is_some())
        };
        let (who, number, region) = (self.who(slot), picture.number, picture.region());
        if begun || end {
            self.tell(who, number, News::Part { region, step: 1 })
                .await?;
        }
        if end {
            self.tell(who, number, News::End).await?;
        }
        Ok(())
    }
}

impl Shown {
    fn new(settings: Settings) -> Self {
        Self {
            settings,
            told: None,
            compiled: None,
            place: None,
            picture: None,
            look: Look {
                channel: Channel::Color,
                gain: 1.0,
                curve: Curve::Srgb,
                diagonal: 1.0,
                scale: 0.0,
            },
        }
    }
}
