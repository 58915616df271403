//! Scenes that pages look at: loaded and compiled once for all of them, and again when a file changes.

use crate::camera_change::only_camera;
use crate::protocol::{LONGEST_TEXT, Said};
use crate::texts::{is_sdl, names_clock};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;
use strahl::prelude::*;
use strahl::scene::{FileId, SourceMap};
use strahl::sdl::Texts;
use strahl::{Inputs, Loaded};
use tokio::sync::watch;

/// A scene as a page wants it.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The scene's file.
    pub path: PathBuf,
    /// Texts to read instead of files: of the scene's own under `path`, of included ones under the paths where they are found.
    pub texts: Texts,
    /// The size of the picture, which a scene may ask for; `None` takes the usual one.
    pub size: Option<(u32, u32)>,
    /// The value of `clock`.
    pub clock: f64,
}

impl Request {
    /// The text to read instead of that of the scene's own file.
    pub fn text(&self) -> Option<&Arc<str>> {
        self.texts.get(&self.path)
    }
}

/// Reads a scene, and adds a camera and lights to a bare mesh. It may end with an error when the flag becomes true: nobody wants the scene then.
pub type LoadScene = Box<dyn Fn(&Request, &Arc<AtomicBool>) -> Loaded + Send + Sync>;

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
    /// Its camera, which may be newer than the scene.
    pub(crate) camera: Option<Camera>,
    pub(crate) said: Vec<Said>,
    /// Whether its texts use `clock`.
    pub(crate) clock: bool,
    /// All files that it was made of, under the names that messages give them; the first one is the scene's own.
    pub(crate) files: Vec<SceneFile>,
    pub(crate) seconds: f64,
    identity: Option<String>,
    /// The identity of all its files but the first.
    others: Option<String>,
    /// The text of the first file.
    text: Option<Arc<str>>,
    /// The warnings of the compiler.
    warned: Vec<Said>,
}

/// A file that a scene was made of.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SceneFile {
    /// Its name in messages and places.
    pub(crate) name: String,
    /// Its path from the root; empty for one that is built in.
    pub(crate) path: PathBuf,
    /// The text of an include file that is built in.
    pub(crate) built_in: Option<&'static str>,
}

impl SceneFile {
    fn new(name: &Path) -> Self {
        Self {
            name: name.display().to_string(),
            path: absolute(name),
            built_in: None,
        }
    }

    /// An include file that is built in, by the name that messages give it.
    fn built_in(name: &str) -> Option<Self> {
        let text = strahl::sdl::built_in(name.strip_prefix("<built in>/")?)?;
        Some(Self {
            name: name.to_owned(),
            path: PathBuf::new(),
            built_in: Some(text),
        })
    }

    /// Where changes of it are seen: its path, and what it leads to if it is a link.
    fn places(&self) -> impl Iterator<Item = PathBuf> {
        let target = self.path.canonicalize().ok();
        let target = target.filter(|target| *target != self.path);
        std::iter::once(self.path.clone()).chain(target)
    }

    /// Whether a page may show it as a text; pictures and fonts are none.
    pub(crate) fn is_text(&self) -> bool {
        const OTHERS: [&str; 20] = [
            "bmp", "dcm", "df3", "exr", "gif", "gz", "hdr", "iff", "jpeg", "jpg", "otf", "pcx",
            "pgm", "png", "ppm", "stl", "tga", "tif", "tiff", "ttf",
        ];
        let ending = self.path.extension().map(|e| e.to_ascii_lowercase());
        !ending.is_some_and(|e| OTHERS.iter().any(|other| e == *other))
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
    /// When the last loading began, and what ends the reading.
    since: Instant,
    stop: Arc<AtomicBool>,
    used: u64,
    /// Held by all who show it.
    place: Place,
}

impl Entry {
    /// Whether somebody shows it.
    fn is_held(&self) -> bool {
        Arc::strong_count(&self.place) > 1
    }

    /// Where changes of the scene's files are seen, as far as they are known.
    fn places(&self) -> Vec<PathBuf> {
        match &self.compiled {
            Some(compiled) => compiled.files.iter().flat_map(SceneFile::places).collect(),
            None => SceneFile::new(&self.key.request.path).places().collect(),
        }
    }

    /// Whether it is being read for much longer than it took the last time, as a loop that doesn't end is. (A scene that changes more often than
    /// it can be read is shown now and then.)
    fn is_overdue(&self) -> bool {
        let last = self.compiled.as_ref().map_or(0.0, |c| c.seconds);
        self.loading && self.since.elapsed().as_secs_f64() > last + OVERDUE
    }

    /// Ends the reading of a scene that nobody shows any more.
    fn stop_unwanted(&self) {
        if self.loading && !self.is_held() {
            self.stop.store(true, Ordering::Relaxed);
        }
    }
}

/// Keeps a scene from being forgotten, as long as somebody holds it.
pub(crate) type Place = Arc<()>;

/// How many scenes are kept, if not more of them are shown.
const KEPT: usize = 4;
/// By so many seconds a scene may be read longer than the last time, before a changed file makes it begin again.
const OVERDUE: f64 = 1.0;
/// How many scenes are loaded at the same time. A page that asks for a new one with every movement of a slider waits for its last one, not for
/// all of them.
const MOST_LOADING: usize = 2;

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

    /// The scene, if it is loaded, and whether it is being loaded. If it is neither, or a file has changed, the loading begins. Those who hold its
    /// place find it again: scenes that are shown don't drive each other out.
    pub(crate) fn want(self: &Arc<Self>, key: &Key) -> (Option<Arc<Compiled>>, bool, Place) {
        let mut entries = self.entries();
        let now = self.numbers.fetch_add(1, Ordering::Relaxed);
        let mut others = entries.iter().map(|entry| &entry.key.request.path);
        let is_new_file = !others.any(|path| *path == key.request.path);
        let index = entries.iter().position(|entry| entry.key == *key);
        let index = index.unwrap_or_else(|| {
            while entries.len() >= KEPT {
                let is_idle = |entry: &Entry| !entry.loading && !entry.is_held();
                let idle = entries.iter().enumerate().filter(|(_, e)| is_idle(e));
                let Some((oldest, _)) = idle.min_by_key(|(_, e)| e.used) else {
                    break;
                };
                entries.remove(oldest);
            }
            entries.push(Entry {
                key: key.clone(),
                compiled: None,
                loading: false,
                stale: true,
                since: Instant::now(),
                stop: Arc::default(),
                used: now,
                place: Place::default(),
            });
            entries.len() - 1
        });
        let others = entries.iter().enumerate().filter(|(n, _)| *n != index);
        others.for_each(|(_, entry)| entry.stop_unwanted());
        // Those that have to wait are asked for again when one is loaded.
        let room = entries.iter().filter(|entry| entry.loading).count() < MOST_LOADING;
        let entry = &mut entries[index];
        entry.used = now;
        if entry.stale && !entry.loading && room {
            (entry.loading, entry.stale) = (true, false);
            (entry.since, entry.stop) = (Instant::now(), Arc::default());
            let (this, key) = (Arc::clone(self), key.clone());
            let thread = std::thread::Builder::new().name("strahl load".into());
            if thread.spawn(move || this.load(&key)).is_err() {
                (entry.loading, entry.stale) = (false, true);
            }
        }
        let wanted = (
            entry.compiled.clone(),
            entry.loading || entry.stale,
            Arc::clone(&entry.place),
        );
        drop(entries);
        if is_new_file {
            // It is watched while it is read for the first time.
            self.changed();
        }
        wanted
    }

    /// Somebody shows a scene no more.
    pub(crate) fn left(&self) {
        self.entries().iter().for_each(Entry::stop_unwanted);
    }

    /// Files have changed: scenes made of them are to be loaded again. A scene with errors may wait for any new file.
    pub(crate) fn files_changed(&self, changed: &[PathBuf]) {
        let mut any = false;
        for entry in self.entries().iter_mut() {
            let known = entry.compiled.as_ref();
            let waits = known.is_none_or(|compiled| compiled.scene.is_none());
            let is_own = entry.places().iter().any(|place| changed.contains(place));
            if is_own && entry.is_overdue() {
                entry.stop.store(true, Ordering::Relaxed);
            }
            entry.stale |= waits || is_own;
            any |= waits || is_own;
        }
        if any {
            self.changed();
        }
    }

    /// Reads a scene for something else than a picture on a page.
    ///
    /// # Errors
    /// The first error of the scene.
    pub(crate) fn description(&self, request: &Request) -> Result<Scene, String> {
        let loaded = (self.load)(request, &Arc::default());
        let first = || loaded.diagnostics.first().map(|d| d.message.clone());
        let problem = first().unwrap_or_else(|| "the scene cannot be read".into());
        loaded.scene.ok_or(problem)
    }

    /// The files of all scenes, and what those that are links lead to.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        let entries = self.entries();
        let mut all: Vec<PathBuf> = entries.iter().flat_map(Entry::places).collect();
        all.sort();
        all.dedup();
        all
    }

    fn load(&self, key: &Key) {
        let (before, similar, stop) = self.known(key);
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            self.compile(key, before.as_deref(), similar.as_deref(), &stop)
        }));
        let mut stopped = false;
        let compiled = match outcome {
            // What was stopped tells nothing about the scene. It is loaded again if somebody wants it.
            Ok(Some(compiled)) if compiled.scene.is_none() && stop.load(Ordering::Relaxed) => {
                stopped = true;
                before
            }
            Ok(Some(compiled)) => Some(Arc::new(compiled)),
            // Nothing has changed.
            Ok(None) => before,
            Err(_) => Some(Arc::new(self.failed(&key.request.path))),
        };
        if let Some(entry) = self.entries().iter_mut().find(|entry| entry.key == *key) {
            entry.compiled = compiled;
            entry.loading = false;
            entry.stale |= stopped;
        }
        self.changed();
    }

    /// What is known before a scene is loaded: what came of it the last time, the newest scene that differs from it in nothing but its texts, and
    /// what stops the reading.
    fn known(
        &self,
        key: &Key,
    ) -> (
        Option<Arc<Compiled>>,
        Option<Arc<Compiled>>,
        Arc<AtomicBool>,
    ) {
        let entries = self.entries();
        let entry = entries.iter().find(|entry| entry.key == *key);
        let before = entry.and_then(|entry| entry.compiled.clone());
        let stop = entry.map(|entry| Arc::clone(&entry.stop));
        let alike = |other: &Key| {
            let request = Request {
                texts: key.request.texts.clone(),
                ..other.request.clone()
            };
            request == key.request && other.accelerator == key.accelerator
        };
        let similar = entries
            .iter()
            .filter(|entry| alike(&entry.key))
            .filter_map(|entry| entry.compiled.clone())
            .filter(|compiled| compiled.scene.is_some())
            .max_by_key(|compiled| compiled.number);
        (before, similar, stop.unwrap_or_default())
    }

    /// What came of a scene during whose reading strahl has panicked.
    fn failed(&self, path: &Path) -> Compiled {
        let message = Diagnostic::error("strahl failed while it read this scene")
            .hint("this is an error of strahl, not of the scene: please report it");
        Compiled {
            number: self.numbers.fetch_add(1, Ordering::Relaxed),
            scene: None,
            camera: None,
            clock: false,
            said: vec![Said::of(&message, None)],
            files: vec![SceneFile::new(path)],
            seconds: 0.0,
            identity: None,
            others: None,
            text: None,
            warned: vec![],
        }
    }

    /// Loads and compiles; `None` if the scene consists of the same as `before`. Nothing is built if the scene differs from `similar` in
    /// nothing but its camera.
    fn compile(
        &self,
        key: &Key,
        before: Option<&Compiled>,
        similar: Option<&Compiled>,
        stop: &Arc<AtomicBool>,
    ) -> Option<Compiled> {
        let start = Instant::now();
        let text = text_of(&key.request);
        let Loaded {
            scene,
            diagnostics,
            inputs,
        } = (self.load)(&key.request, stop);
        let identity = inputs.as_ref().map(Inputs::identity);
        let same =
            before.is_some_and(|before| before.scene.is_some() && before.identity == identity);
        if same && identity.is_some() {
            return None;
        }
        let others = inputs.as_ref().map(|inputs| {
            let mut others = inputs.clone();
            others.sha256 = [0; 32];
            others.identity()
        });
        // Nothing is known of a text that has changed while it was read.
        let text = text.filter(|text| text_of(&key.request).as_ref() == Some(text));
        let kept = similar.filter(|similar| {
            let texts = text.as_ref().zip(similar.text.as_ref());
            others.is_some()
                && similar.others == others
                && texts.is_some_and(|(new, old)| only_camera(old, new))
        });
        let sources = scene.as_ref().map(|scene| scene.sources.clone());
        let mut files = files(&key.request.path, inputs.as_ref());
        match (&sources, before) {
            (Some(sources), _) => files.extend(built_in(sources)),
            // Those of a scene with errors are not known.
            (None, Some(before)) => {
                let known = before.files.iter().filter(|file| file.built_in.is_some());
                files.extend(known.cloned());
            }
            (None, None) => {}
        }
        let Built {
            scene,
            camera,
            warned,
        } = scene.map_or_else(Built::default, |scene| {
            self.build(scene, key.accelerator, kept)
        });
        let told = diagnostics.iter();
        let mut said: Vec<Said> = told.map(|d| Said::of(d, sources.as_ref())).collect();
        said.extend(warned.iter().cloned());
        said.truncate(200);
        let clock = uses_clock(&key.request, text.as_deref(), &files);
        Some(Compiled {
            number: self.numbers.fetch_add(1, Ordering::Relaxed),
            scene,
            camera,
            said,
            clock,
            files,
            seconds: start.elapsed().as_secs_f64(),
            identity,
            others,
            text,
            warned,
        })
    }

    /// Builds a description, or takes what is `kept` of one that differs from it in nothing but the camera.
    fn build(&self, scene: Scene, accelerator: AcceleratorKind, kept: Option<&Compiled>) -> Built {
        let camera = scene.camera.as_ref();
        let camera = camera.filter(|camera| camera.problem().is_none());
        if let (Some(kept), Some(camera)) = (kept, camera) {
            return Built {
                scene: kept.scene.clone(),
                camera: Some(camera.clone()),
                warned: kept.warned.clone(),
            };
        }
        let told = |all: &[Diagnostic]| {
            let all = all.iter().map(|d| Said::of(d, Some(&scene.sources)));
            all.collect()
        };
        match self
            .session
            .compile(&scene, &CompileOptions { accelerator })
        {
            Ok((built, warnings)) => Built {
                camera: Some(built.camera().clone()),
                scene: Some(built),
                warned: told(&warnings),
            },
            Err(problems) => Built {
                warned: told(&problems.0),
                ..Built::default()
            },
        }
    }
}

/// A scene that is built, its camera, and what was said meanwhile.
#[derive(Default)]
struct Built {
    scene: Option<Arc<RenderScene>>,
    camera: Option<Camera>,
    warned: Vec<Said>,
}

/// The text of a scene's own file, if it is one that a page would show.
fn text_of(request: &Request) -> Option<Arc<str>> {
    if let Some(text) = request.text() {
        return Some(Arc::clone(text));
    }
    let size = std::fs::metadata(&request.path).ok()?.len();
    let fits = is_sdl(&request.path) && size <= LONGEST_TEXT as u64;
    let text = fits.then(|| std::fs::read_to_string(&request.path).ok())?;
    text.map(Arc::from)
}

/// Whether the scene's own text, or that of a file that it includes, has the word `clock`.
fn uses_clock(request: &Request, text: Option<&str>, files: &[SceneFile]) -> bool {
    let included = files.iter().skip(1).any(|file| {
        if let Some(text) = request.texts.get(Path::new(&file.name)) {
            return names_clock(text);
        }
        let small = std::fs::metadata(&file.path).is_ok_and(|m| m.len() <= LONGEST_TEXT as u64);
        let ending = file.path.extension().map(|e| e.to_ascii_lowercase());
        small
            && ending.is_some_and(|e| e == "inc" || e == "pov")
            && std::fs::read_to_string(&file.path).is_ok_and(|text| names_clock(&text))
    });
    included || text.is_some_and(names_clock)
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

/// The include files of a scene that are built in.
fn built_in(sources: &SourceMap) -> impl Iterator<Item = SceneFile> {
    (0..)
        .map_while(|number| sources.name(FileId(number)))
        .filter_map(SceneFile::built_in)
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

#[cfg(test)]
mod tests {
    use super::*;
    use strahl::{Format, LoadOptions, load_bytes};

    fn load(request: &Request, stop: &Arc<AtomicBool>) -> Loaded {
        let options = LoadOptions {
            record: true,
            stop: Some(Arc::clone(stop)),
            ..LoadOptions::default()
        };
        let text = request.text().map(|text| &**text).unwrap_or_default();
        load_bytes(text.as_bytes().to_vec(), "a.pov", Format::Pov, options)
    }

    fn compiled(scenes: &Arc<Scenes>, text: &str) -> Arc<Compiled> {
        let key = Key {
            request: Request {
                path: "a.pov".into(),
                texts: Texts::from([("a.pov".into(), text.into())]),
                size: None,
                clock: 0.0,
            },
            accelerator: AcceleratorKind::default(),
        };
        let start = Instant::now();
        loop {
            if let (Some(compiled), false, _) = scenes.want(&key) {
                return compiled;
            }
            assert!(start.elapsed().as_secs() < 60);
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
    }

    #[test]
    fn another_camera_builds_nothing_and_gives_the_same_bits() {
        let session = Session::new(Threads::Count(2)).unwrap();
        let scenes = Scenes::new(session.clone(), Box::new(load));
        let text = |eye: &str, radius: &str| {
            format!(
                "camera {{ location {eye} look_at 0 }}\nlight_source {{ <3, 5, -4>, 1 }}\nsphere {{ 0, {radius} pigment {{ rgb <1, 0.4, 0> }} }}\n"
            )
        };
        let first = compiled(&scenes, &text("<0, 1, -4>", "1"));
        let moved = compiled(&scenes, &text("<1, 1, -5>", "1"));
        let scene = |compiled: &Compiled| Arc::clone(compiled.scene.as_ref().unwrap());
        assert!(Arc::ptr_eq(&scene(&first), &scene(&moved)));
        assert_ne!(first.number, moved.number);
        let bits = |view: View| {
            let picture = session.picture(&view, &Output::default());
            picture.unwrap().film.sha256()
        };
        let camera = moved.camera.clone().unwrap();
        let found = bits(scene(&moved).view(40, 30).with_camera(camera));
        let fresh = load_bytes(
            text("<1, 1, -5>", "1").into(),
            "a.pov",
            Format::Pov,
            LoadOptions::default(),
        );
        let (fresh, _) = fresh.into_scene().unwrap();
        let (fresh, _) = session.compile(&fresh, &CompileOptions::default()).unwrap();
        assert_eq!(found, bits(fresh.view(40, 30)));
        assert_ne!(found, bits(scene(&first).view(40, 30)));
        let other = compiled(&scenes, &text("<1, 1, -5>", "0.5"));
        assert!(!Arc::ptr_eq(&scene(&other), &scene(&moved)));
    }

    /// Each page shows up to three scenes, and asks for all of them whenever one is loaded. When more were shown than were kept, they drove each
    /// other out and were loaded again without end.
    #[test]
    fn scenes_that_are_shown_stay_however_many_there_are() {
        let count = Arc::new(AtomicU64::new(0));
        let loads = Arc::clone(&count);
        let counting = move |request: &Request, stop: &Arc<AtomicBool>| {
            loads.fetch_add(1, Ordering::Relaxed);
            load(request, stop)
        };
        let session = Session::new(Threads::Count(1)).unwrap();
        let scenes = Scenes::new(session, Box::new(counting));
        let key = |clock: u32| Key {
            request: Request {
                path: "a.pov".into(),
                texts: Texts::from([("a.pov".into(), "sphere { 4*z, 1 }".into())]),
                size: None,
                clock: f64::from(clock),
            },
            accelerator: AcceleratorKind::default(),
        };
        let shown = 3 * KEPT as u32;
        let start = Instant::now();
        let mut places: Vec<Place>;
        loop {
            let wanted: Vec<_> = (0..shown).map(|n| scenes.want(&key(n))).collect();
            let ready = wanted.iter().all(|(_, loading, _)| !loading);
            places = wanted.into_iter().map(|(_, _, place)| place).collect();
            if ready {
                break;
            }
            assert!(start.elapsed().as_secs() < 60);
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        assert_eq!(count.load(Ordering::Relaxed), u64::from(shown));
        assert_eq!(places.len(), scenes.entries().len());
        // Those that nobody shows any more make room for the next one.
        places.truncate(1);
        let _ = scenes.want(&key(shown));
        assert_eq!(scenes.entries().len(), KEPT);
        assert!(scenes.entries().iter().any(|entry| entry.key == key(0)));
    }

    /// Whoever writes a loop types its condition before the line that ends it.
    #[test]
    fn a_loop_without_end_stops_when_nobody_wants_it_any_more() {
        let scenes = Scenes::new(
            Session::new(Threads::Count(1)).unwrap(),
            Box::new(move |request: &Request, stop: &Arc<AtomicBool>| {
                let mut options = LoadOptions {
                    record: true,
                    stop: Some(Arc::clone(stop)),
                    ..LoadOptions::default()
                };
                // Only the flag ends it.
                options.sdl.limits.set("steps", u64::MAX);
                options.sdl.limits.set("idle_steps", u64::MAX);
                let text = request.text().unwrap().as_bytes().to_vec();
                load_bytes(text, "a.pov", Format::Pov, options)
            }),
        );
        let key = |text: &str| Key {
            request: Request {
                path: "a.pov".into(),
                texts: Texts::from([("a.pov".into(), text.into())]),
                size: None,
                clock: 0.0,
            },
            accelerator: AcceleratorKind::default(),
        };
        // As many as are loaded at the same time.
        for n in 0..MOST_LOADING {
            let (_, loading, place) = scenes.want(&key(&format!("#while (1) #end // {n}")));
            assert!(loading);
            drop(place);
        }
        let good = key("sphere { 4*z, 1 }");
        let start = Instant::now();
        let _place = loop {
            if let (Some(compiled), false, place) = scenes.want(&good) {
                assert!(compiled.scene.is_some());
                break place;
            }
            assert!(start.elapsed().as_secs() < 30, "they are read on");
            std::thread::sleep(std::time::Duration::from_millis(2));
        };
        assert!(scenes.entries().iter().all(|entry| !entry.loading));
        // One that is in a file, until the file changes.
        let endless = key("#while (1) #end");
        let (_, _, _place) = scenes.want(&endless);
        let is_loading = || {
            let entries = scenes.entries();
            entries
                .iter()
                .any(|entry| entry.key == endless && entry.loading)
        };
        scenes.files_changed(&[absolute(Path::new("a.pov"))]);
        assert!(is_loading(), "it has not been read for long");
        std::thread::sleep(std::time::Duration::from_secs_f64(OVERDUE + 0.1));
        scenes.files_changed(&[absolute(Path::new("b.pov"))]);
        assert!(is_loading(), "another file");
        scenes.files_changed(&[absolute(Path::new("a.pov"))]);
        let start = Instant::now();
        while is_loading() {
            assert!(start.elapsed().as_secs() < 30, "it is read on");
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
    }

    #[test]
    fn a_camera_that_makes_no_rays_is_an_error_still() {
        let session = Session::new(Threads::Count(1)).unwrap();
        let scenes = Scenes::new(session, Box::new(load));
        let text = |right: &str| format!("camera {{ right {right} }}\nsphere {{ 4*z, 1 }}\n");
        assert!(compiled(&scenes, &text("x")).scene.is_some());
        let broken = compiled(&scenes, &text("0*x"));
        assert!(broken.scene.is_none() && !broken.said.is_empty());
    }
}
