//! Scenes that pages look at: loaded and compiled once for all of them, and again when a file changes.

use crate::camera_change::only_camera;
use crate::protocol::{LONGEST_TEXT, Said};
use crate::texts::{is_sdl, names_clock};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
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
    used: u64,
    /// Held by all who show it.
    place: Place,
}

/// Keeps a scene from being forgotten, as long as somebody holds it.
pub(crate) type Place = Arc<()>;

/// How many scenes are kept, if not more of them are shown.
const KEPT: usize = 4;
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
        let index = entries.iter().position(|entry| entry.key == *key);
        let index = index.unwrap_or_else(|| {
            while entries.len() >= KEPT {
                let is_idle =
                    |entry: &Entry| !entry.loading && Arc::strong_count(&entry.place) == 1;
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
                used: now,
                place: Place::default(),
            });
            entries.len() - 1
        });
        // Those that have to wait are asked for again when one is loaded.
        let room = entries.iter().filter(|entry| entry.loading).count() < MOST_LOADING;
        let entry = &mut entries[index];
        entry.used = now;
        if entry.stale && !entry.loading && room {
            (entry.loading, entry.stale) = (true, false);
            let (this, key) = (Arc::clone(self), key.clone());
            let thread = std::thread::Builder::new().name("strahl load".into());
            if thread.spawn(move || this.load(&key)).is_err() {
                (entry.loading, entry.stale) = (false, true);
            }
        }
        (
            entry.compiled.clone(),
            entry.loading || entry.stale,
            Arc::clone(&entry.place),
        )
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

    /// Reads a scene for something else than a picture on a page.
    ///
    /// # Errors
    /// The first error of the scene.
    pub(crate) fn description(&self, request: &Request) -> Result<Scene, String> {
        let loaded = (self.load)(request);
        let first = || loaded.diagnostics.first().map(|d| d.message.clone());
        let problem = first().unwrap_or_else(|| "the scene cannot be read".into());
        loaded.scene.ok_or(problem)
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
        let (before, similar) = {
            let entries = self.entries();
            let entry = entries.iter().find(|entry| entry.key == *key);
            let before = entry.and_then(|entry| entry.compiled.clone());
            let alike = |other: &Key| {
                let request = Request {
                    texts: key.request.texts.clone(),
                    ..other.request.clone()
                };
                request == key.request && other.accelerator == key.accelerator
            };
            // The newest one that differs in nothing but its text.
            let similar = entries
                .iter()
                .filter(|entry| alike(&entry.key))
                .filter_map(|entry| entry.compiled.clone())
                .filter(|compiled| compiled.scene.is_some())
                .max_by_key(|compiled| compiled.number);
            (before, similar)
        };
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            self.compile(key, before.as_deref(), similar.as_deref())
        }));
        let compiled = match outcome {
            Ok(Some(compiled)) => Some(Arc::new(compiled)),
            // Nothing has changed.
            Ok(None) => before,
            Err(_) => Some(Arc::new(Compiled {
                number: self.numbers.fetch_add(1, Ordering::Relaxed),
                scene: None,
                camera: None,
                clock: false,
                said: vec![Said::of(
                    &Diagnostic::error("strahl failed while it read this scene")
                        .hint("this is an error of strahl, not of the scene: please report it"),
                    None,
                )],
                files: vec![SceneFile::new(&key.request.path)],
                seconds: 0.0,
                identity: None,
                others: None,
                text: None,
                warned: vec![],
            })),
        };
        if let Some(entry) = self.entries().iter_mut().find(|entry| entry.key == *key) {
            entry.compiled = compiled;
            entry.loading = false;
        }
        self.changed();
    }

    /// Loads and compiles; `None` if the scene consists of the same as `before`. Nothing is built if the scene differs from `similar` in
    /// nothing but its camera.
    fn compile(
        &self,
        key: &Key,
        before: Option<&Compiled>,
        similar: Option<&Compiled>,
    ) -> Option<Compiled> {
        let start = Instant::now();
        let text = text_of(&key.request);
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
        let mut said: Vec<Said> = diagnostics
            .iter()
            .map(|diagnostic| Said::of(diagnostic, sources.as_ref()))
            .collect();
        let mut compiled = None;
        let mut camera = None;
        let mut warned = vec![];
        let known = scene.as_ref().and_then(|scene| scene.camera.clone());
        let known = known.filter(|camera| camera.problem().is_none());
        if let (Some(kept), Some(known)) = (kept, known) {
            compiled = kept.scene.clone();
            camera = Some(known);
            warned = kept.warned.clone();
        } else if let Some(scene) = scene {
            let options = CompileOptions {
                accelerator: key.accelerator,
            };
            let more = match self.session.compile(&scene, &options) {
                Ok((scene, warnings)) => {
                    camera = Some(scene.camera().clone());
                    compiled = Some(scene);
                    warnings
                }
                Err(problems) => problems.0,
            };
            warned = more.iter().map(|d| Said::of(d, sources.as_ref())).collect();
        }
        said.extend(warned.iter().cloned());
        said.truncate(200);
        let clock = uses_clock(&key.request, text.as_deref(), &files);
        Some(Compiled {
            number: self.numbers.fetch_add(1, Ordering::Relaxed),
            scene: compiled,
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

    fn load(request: &Request) -> Loaded {
        let options = LoadOptions {
            record: true,
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
        let counting = move |request: &Request| {
            loads.fetch_add(1, Ordering::Relaxed);
            load(request)
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
