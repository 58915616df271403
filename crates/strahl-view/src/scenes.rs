//! Scenes that pages look at: loaded and compiled once for all of them, and again when a file changes.

use crate::protocol::Said;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;
use strahl::prelude::*;
use strahl::{Inputs, Loaded};
use tokio::sync::watch;

/// A scene as a page wants it.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The scene's file.
    pub path: PathBuf,
    /// The text to read instead of the file's.
    pub text: Option<Arc<str>>,
    /// The size of the picture, which a scene may ask for; `None` takes the usual one.
    pub size: Option<(u32, u32)>,
    /// The value of `clock`.
    pub clock: f64,
}

/// Reads a scene, and adds a camera and lights to a bare mesh.
pub type LoadScene = Box<dyn Fn(&Request) -> Loaded + Send + Sync>;

/// A request with the accelerator to build.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Key {
    pub(crate) request: Request,
    pub(crate) accelerator: AcceleratorKind,
}

/// What came of a request.
#[derive(Debug)]
pub(crate) struct Compiled {
    /// A number that no other scene has.
    pub(crate) number: u64,
    /// The scene, if there were no errors.
    pub(crate) scene: Option<Arc<RenderScene>>,
    pub(crate) said: Vec<Said>,
    /// All files that it was made of, under the names that messages give them; the first one is the scene's own.
    pub(crate) files: Vec<SceneFile>,
    pub(crate) seconds: f64,
    identity: Option<String>,
}

/// A file that a scene was made of.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SceneFile {
    /// Its name in messages and places.
    pub(crate) name: String,
    pub(crate) path: PathBuf,
}

impl SceneFile {
    fn new(name: &Path) -> Self {
        Self {
            name: name.display().to_string(),
            path: absolute(name),
        }
    }
}

/// A scene that is loaded, or being loaded.
#[derive(Debug)]
struct Entry {
    key: Key,
    compiled: Option<Arc<Compiled>>,
    loading: bool,
    /// Whether a file has changed since the loading began.
    stale: bool,
    used: u64,
}

/// How many scenes are kept.
const KEPT: usize = 4;

/// The scenes.
pub(crate) struct Scenes {
    session: Session,
    load: LoadScene,
    entries: Mutex<Vec<Entry>>,
    /// Counts changes, and wakes those who wait for one.
    changes: watch::Sender<u64>,
    numbers: AtomicU64,
}

impl Scenes {
    pub(crate) fn new(session: Session, load: LoadScene) -> Arc<Self> {
        Arc::new(Self {
            session,
            load,
            entries: Mutex::default(),
            changes: watch::Sender::new(0),
            numbers: AtomicU64::new(1),
        })
    }

    fn entries(&self) -> MutexGuard<'_, Vec<Entry>> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Wakes after every change of a scene.
    pub(crate) fn changes(&self) -> watch::Receiver<u64> {
        self.changes.subscribe()
    }

    fn changed(&self) {
        self.changes.send_modify(|count| *count += 1);
    }

    /// The scene, if it is loaded, and whether it is being loaded. If it is neither, or a file has changed, the loading begins.
    pub(crate) fn want(self: &Arc<Self>, key: &Key) -> (Option<Arc<Compiled>>, bool) {
        let mut entries = self.entries();
        let now = self.numbers.fetch_add(1, Ordering::Relaxed);
        let index = entries.iter().position(|entry| entry.key == *key);
        let index = index.unwrap_or_else(|| {
            if entries.len() >= KEPT {
                let idle = entries.iter().enumerate().filter(|(_, e)| !e.loading);
                let oldest = idle.min_by_key(|(_, e)| e.used).map(|(index, _)| index);
                if let Some(oldest) = oldest {
                    entries.remove(oldest);
                }
            }
            entries.push(Entry {
                key: key.clone(),
                compiled: None,
                loading: false,
                stale: true,
                used: now,
            });
            entries.len() - 1
        });
        let entry = &mut entries[index];
        entry.used = now;
        if entry.stale && !entry.loading {
            (entry.loading, entry.stale) = (true, false);
            let (this, key) = (Arc::clone(self), key.clone());
            let thread = std::thread::Builder::new().name("strahl load".into());
            if thread.spawn(move || this.load(&key)).is_err() {
                (entry.loading, entry.stale) = (false, true);
            }
        }
        (entry.compiled.clone(), entry.loading)
    }

    /// Files have changed: scenes made of them are to be loaded again. A scene with errors may wait for any new file.
    pub(crate) fn files_changed(&self, changed: &[PathBuf]) {
        let mut any = false;
        for entry in self.entries().iter_mut() {
            let hit = entry.compiled.as_ref().is_none_or(|compiled| {
                compiled.scene.is_none()
                    || compiled
                        .files
                        .iter()
                        .any(|file| changed.contains(&file.path))
            });
            entry.stale |= hit;
            any |= hit;
        }
        if any {
            self.changed();
        }
    }

    /// The files of all scenes.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let entries = self.entries();
        let compiled = entries.iter().filter_map(|entry| entry.compiled.as_ref());
        let mut all: Vec<PathBuf> = compiled
            .flat_map(|c| c.files.iter().map(|file| file.path.clone()))
            .collect();
        all.sort();
        all.dedup();
        all
    }

    fn load(&self, key: &Key) {
        let before = {
            let entries = self.entries();
            let entry = entries.iter().find(|entry| entry.key == *key);
            entry.and_then(|entry| entry.compiled.clone())
        };
        let outcome = catch_unwind(AssertUnwindSafe(|| self.compile(key, before.as_deref())));
        let compiled = match outcome {
            Ok(Some(compiled)) => Some(Arc::new(compiled)),
            // Nothing has changed.
            Ok(None) => before,
            Err(_) => Some(Arc::new(Compiled {
                number: self.numbers.fetch_add(1, Ordering::Relaxed),
                scene: None,
                said: vec![Said::of(
                    &Diagnostic::error("strahl failed while it read this scene")
                        .hint("this is an error of strahl, not of the scene: please report it"),
                    None,
                )],
                files: vec![SceneFile::new(&key.request.path)],
                seconds: 0.0,
                identity: None,
            })),
        };
        if let Some(entry) = self.entries().iter_mut().find(|entry| entry.key == *key) {
            entry.compiled = compiled;
            entry.loading = false;
        }
        self.changed();
    }

    /// Loads and compiles; `None` if the scene consists of the same as `before`.
    fn compile(&self, key: &Key, before: Option<&Compiled>) -> Option<Compiled> {
        let start = Instant::now();
        let Loaded {
            scene,
            diagnostics,
            inputs,
        } = (self.load)(&key.request);
        let identity = inputs.as_ref().map(Inputs::identity);
        let same =
            before.is_some_and(|before| before.scene.is_some() && before.identity == identity);
        if same && identity.is_some() {
            return None;
        }
        let sources = scene.as_ref().map(|scene| scene.sources.clone());
        let mut said: Vec<Said> = diagnostics
            .iter()
            .map(|diagnostic| Said::of(diagnostic, sources.as_ref()))
            .collect();
        let mut compiled = None;
        if let Some(scene) = scene {
            let options = CompileOptions {
                accelerator: key.accelerator,
            };
            let more = match self.session.compile(&scene, &options) {
                Ok((scene, warnings)) => {
                    compiled = Some(scene);
                    warnings
                }
                Err(problems) => problems.0,
            };
            said.extend(more.iter().map(|d| Said::of(d, sources.as_ref())));
        }
        said.truncate(200);
        Some(Compiled {
            number: self.numbers.fetch_add(1, Ordering::Relaxed),
            scene: compiled,
            said,
            files: files(&key.request.path, inputs.as_ref()),
            seconds: start.elapsed().as_secs_f64(),
            identity,
        })
    }
}

/// The files that a scene was made of.
fn files(scene: &Path, inputs: Option<&Inputs>) -> Vec<SceneFile> {
    let mut files = vec![SceneFile::new(scene)];
    for read in inputs.iter().flat_map(|inputs| &inputs.record.reads) {
        let path = Path::new(&read.found);
        // Those that are built in have no file.
        if path.is_file() {
            let file = SceneFile::new(path);
            if !files.contains(&file) {
                files.push(file);
            }
        }
    }
    files
}

/// A path that begins at the root, as watchers report it.
pub(crate) fn absolute(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    match (folder.canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => std::path::absolute(path).unwrap_or_else(|_| path.to_owned()),
    }
}
