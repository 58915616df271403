use crate::args::{AcceleratorArgs, PictureArgs, PovArgs, SceneArgs};
use crate::fonts::font_folders;
use crate::report::{Failure, Reporter};
use crate::work;
use std::cell::{Cell, RefCell};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;
use strahl::formats::scene::SceneFormat;
use strahl::math::DVec3;
use strahl::scene::Scene;
use strahl::sdl::{Frame, Pinned, Stream, Texts, Value, Writing};
use strahl::shade::Quality;
use strahl::tracing::{Prepared, RenderOptions, RenderScene, Sampling};
use strahl::{Format, Inputs, LoadOptions, Loaded, load_bytes, load_path};
use strahl_farm::Bundle;

/// The picture size of scenes that don't set one.
pub(crate) const DEFAULT_SIZE: (u32, u32) = (800, 600);

/// The scene that is rendered if the user names none.
const DEMO: &str = include_str!("../../../scenes/demo.pov");

/// Seconds for each phase.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LoadTimes {
    pub(crate) load: f64,
    pub(crate) compile: f64,
    /// The part of `compile` for building acceleration structures.
    pub(crate) build: f64,
}

/// The source of a scene's text.
#[derive(Debug)]
enum Place {
    File(PathBuf),
    Text {
        name: String,
        format: Format,
        bytes: Vec<u8>,
    },
}

/// The scene of a command line, and how to read it. Every command reads its scenes through this.
#[derive(Debug)]
pub(crate) struct Input<'a> {
    place: Place,
    format: Option<Format>,
    pov: &'a PovArgs,
    size: (u32, u32),
    /// Whether the scene may write files; otherwise it writes into memory.
    writes: bool,
    /// Whether the scene was a bare mesh, which gets a ground, a camera and lights.
    staged: Cell<bool>,
    /// Whether the scene's messages have been printed.
    said: Cell<bool>,
    /// Whether to keep what the scene consists of.
    records: bool,
    now: Option<f64>,
    quality: Quality,
    /// The files that the scene may read, if it is bundled.
    pinned: Option<Pinned>,
    /// Texts that are read instead of files.
    texts: Texts,
    /// Ends the reading when it becomes true.
    stop: Option<Arc<AtomicBool>>,
    inputs: RefCell<Option<Inputs>>,
}

/// The scene that was compiled last, with the moment it was read at. Tiles of one picture that one task renders share it.
#[derive(Debug, Default)]
pub(crate) struct Kept(RefCell<Option<KeptScene>>);

#[derive(Clone, Debug)]
struct KeptScene {
    moment: Moment,
    scene: Rc<RenderScene>,
    inputs: Option<Inputs>,
}

/// The moment of an animation at which a scene is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Moment {
    pub(crate) clock: f64,
    pub(crate) frame: Frame,
}

impl<'a> Input<'a> {
    /// Locates the scene; reads it if it comes from the standard input.
    pub(crate) fn new(
        scene: Option<&Path>,
        format: Option<Format>,
        pov: &'a PovArgs,
        size: Option<(u32, u32)>,
    ) -> Result<Self, Failure> {
        let place = match scene {
            None => Place::Text {
                name: "demo.pov".into(),
                format: Format::Pov,
                bytes: DEMO.into(),
            },
            Some(path) if path.as_os_str() == "-" => {
                let format = format.ok_or_else(|| {
                    Failure::new(
                        "a scene from the standard input needs --scene-format NAME (see `strahl formats`)",
                    )
                })?;
                let mut bytes = Vec::new();
                std::io::stdin()
                    .lock()
                    .read_to_end(&mut bytes)
                    .map_err(|e| Failure::new(format!("cannot read the standard input: {e}")))?;
                Place::Text {
                    name: "<stdin>".into(),
                    format,
                    bytes,
                }
            }
            Some(path) => Place::File(path.to_owned()),
        };
        Ok(Self {
            place,
            format,
            pov,
            size: size.unwrap_or(DEFAULT_SIZE),
            writes: false,
            staged: Cell::new(false),
            said: Cell::new(false),
            records: false,
            now: None,
            quality: Quality::FULL,
            pinned: None,
            texts: Texts::new(),
            stop: None,
            inputs: RefCell::new(None),
        })
    }

    /// Texts to read instead of files.
    pub(crate) fn with_texts(self, texts: Texts) -> Self {
        Self { texts, ..self }
    }

    /// Ends the reading with an error as soon as this is true.
    pub(crate) fn stopped_by(self, stop: Arc<AtomicBool>) -> Self {
        let stop = Some(stop);
        Self { stop, ..self }
    }

    /// Lets the scene write files: into the folder of `--allow-write`, or else into SCENE.out beside the scene.
    pub(crate) fn writing(self) -> Result<Self, Failure> {
        if let Some(folder) = &self.pov.allow_write
            && !folder.is_dir()
        {
            let shown = folder.display();
            return Err(Failure::new(format!(
                "--allow-write: there is no folder {shown}"
            )));
        }
        Ok(Self {
            writes: true,
            ..self
        })
    }

    /// Keeps what the scene consists of for [`Input::inputs`].
    pub(crate) fn recording(self, records: bool) -> Self {
        Self { records, ..self }
    }

    /// Fixes the value of `now`.
    pub(crate) fn at_time(self, now: Option<f64>) -> Self {
        Self { now, ..self }
    }

    /// Leaves out what pictures of this quality don't show; `None` is the full quality.
    pub(crate) fn at_quality(self, quality: Option<Quality>) -> Self {
        Self {
            quality: quality.unwrap_or_default(),
            ..self
        }
    }

    /// Reads only the files of a bundle.
    pub(crate) fn bundled(self, folder: &Path) -> Result<Self, Failure> {
        let bundle = Bundle::read(folder).map_err(|error| {
            let shown = folder.display();
            Failure::new(format!("there is no bundle of a scene in {shown}: {error}"))
        })?;
        Ok(Self {
            pinned: Some(bundle.pinned(folder)),
            ..self
        })
    }

    /// What the scene that was read last consists of.
    pub(crate) fn inputs(&self) -> Result<Inputs, Failure> {
        let inputs = self.inputs.borrow();
        let lost = || {
            let name = self.name();
            Failure::new(format!("{name} has changed while it was read: try again"))
        };
        inputs.clone().ok_or_else(lost)
    }

    /// The scene's file; `None` for other sources.
    pub(crate) fn path(&self) -> Option<&Path> {
        match &self.place {
            Place::File(path) => Some(path),
            Place::Text { .. } => None,
        }
    }

    /// The scene of `check` and `info`.
    pub(crate) fn of(args: &'a SceneArgs) -> Result<Self, Failure> {
        Self::new(Some(&args.scene), args.format, &args.pov, None)
    }

    /// The scene's name as shown to the user.
    pub(crate) fn name(&self) -> String {
        match &self.place {
            Place::File(path) => path.display().to_string(),
            Place::Text { name, .. } => name.clone(),
        }
    }

    /// Whether the scene is in POV-Ray's language, judging by its name.
    pub(crate) fn is_pov(&self) -> bool {
        let format = match &self.place {
            Place::File(path) => self.format.or_else(|| Format::of_path(path)),
            Place::Text { format, .. } => Some(*format),
        };
        format == Some(Format::Pov)
    }

    /// Prints the scene's messages no more, because it was read before.
    pub(crate) fn has_said(&self) {
        self.said.set(true);
    }

    /// Whether the scene had neither camera nor lights, and got a ground, a camera and lights.
    pub(crate) fn is_staged(&self) -> bool {
        self.staged.get()
    }

    /// The up direction of bare meshes: STL files are made for printers, whose beds are the plane of x and y.
    fn up(&self) -> DVec3 {
        let format = match &self.place {
            Place::File(path) => self.format.or_else(|| Format::of_path(path)),
            Place::Text { format, .. } => Some(*format),
        };
        match format {
            Some(Format::File(SceneFormat::Stl)) => DVec3::Z,
            _ => DVec3::Y,
        }
    }

    /// The moment of a single picture. As in POV-Ray, its frame numbers are zero.
    pub(crate) fn still(&self) -> Moment {
        Moment {
            clock: self.pov.clock.unwrap_or(0.0),
            frame: Frame {
                animated: self.pov.clock.is_some(),
                number: 0.0,
                first: 0.0,
                last: 0.0,
                initial_clock: 0.0,
                final_clock: 0.0,
                clock_delta: 0.0,
            },
        }
    }

    /// Reads the scene; returns it with its diagnostics.
    pub(crate) fn read(&self, moment: Moment, quiet: bool) -> Loaded {
        let options = self.options(moment, quiet);
        work::doing(format!("reading {}", self.name()));
        let mut loaded = match &self.place {
            Place::File(path) => load_path(path, options),
            Place::Text {
                name,
                format,
                bytes,
            } => load_bytes(bytes.clone(), name, *format, options),
        };
        if let Some(scene) = &mut loaded.scene {
            scene.settings.quality = self.quality;
        }
        loaded
    }

    fn options(&self, moment: Moment, quiet: bool) -> LoadOptions {
        let mut options = LoadOptions {
            format: self.format,
            library: vec![PathBuf::from(".")],
            fonts: font_folders(),
            installed: strahl::povray_folders(),
            writing: self.place_of_writing(),
            record: self.records,
            now: self.now,
            pinned: self.pinned.clone(),
            texts: self.texts.clone(),
            stop: self.stop.clone(),
            subdivide: self.pov.subdivide,
            on_message: (!quiet).then(|| Box::new(print_message) as _),
            ..LoadOptions::default()
        };
        options.library.extend(self.pov.library_path.clone());
        let sdl = &mut options.sdl;
        sdl.clock = moment.clock;
        sdl.frame = moment.frame;
        (sdl.image_width, sdl.image_height) = self.size;
        sdl.version = self.pov.language_version;
        let header = self.pov.include.as_ref();
        sdl.header = header.map(|file| file.to_string_lossy().into_owned());
        for (name, value) in &self.pov.limit {
            sdl.limits.set(name, *value);
        }
        let declared = self.pov.declare.iter();
        sdl.declare = declared
            .map(|(name, x)| (name.clone(), Value::Float(*x)))
            .collect();
        options
    }

    /// The folder for files that the scene writes: `scene.out` for `scene.pov`. A scene without a file writes into memory.
    fn place_of_writing(&self) -> Writing {
        if !self.writes {
            return Writing::Memory;
        }
        if let Some(folder) = &self.pov.allow_write {
            return Writing::Folder(folder.clone());
        }
        match &self.place {
            Place::File(path) => Writing::Own(path.with_extension("out")),
            Place::Text { .. } => Writing::Nowhere,
        }
    }

    /// Reads the scene without printing anything, and adds ground, camera and lights to a bare mesh.
    pub(crate) fn read_staged(&self, moment: Moment) -> Loaded {
        let mut loaded = self.read(moment, true);
        if let Some(scene) = &mut loaded.scene
            && !self.is_pov()
        {
            self.staged.set(strahl::studio(scene, self.up()));
        }
        loaded
    }

    /// Reads the scene and prints its diagnostics.
    pub(crate) fn load(&self, moment: Moment, reporter: &Reporter) -> Result<Scene, Failure> {
        let mut loaded = self.read(moment, reporter.quiet || self.said.get());
        *self.inputs.borrow_mut() = loaded.inputs.take();
        let failed = reporter.print(&loaded.diagnostics, None);
        match loaded.scene {
            Some(mut scene) if !failed => {
                reporter.settle()?;
                if !self.is_pov() {
                    self.staged.set(strahl::studio(&mut scene, self.up()));
                }
                Ok(scene)
            }
            _ => Err(Failure::Reported),
        }
    }

    /// Reads and compiles the scene, but doesn't build its accelerator.
    pub(crate) fn prepared(
        &self,
        moment: Moment,
        reporter: &Reporter,
    ) -> Result<(Prepared, LoadTimes), Failure> {
        let start = Instant::now();
        let scene = self.load(moment, reporter)?;
        let loaded = Instant::now();
        work::doing(format!("preparing {}", self.name()));
        let prepared = match Prepared::new(&scene) {
            Ok(prepared) => prepared,
            Err(errors) => {
                reporter.print(&errors.0, Some(&scene.sources));
                return Err(Failure::Reported);
            }
        };
        reporter.print(prepared.warnings(), Some(&scene.sources));
        reporter.settle()?;
        drop(scene);
        let times = LoadTimes {
            load: (loaded - start).as_secs_f64(),
            compile: loaded.elapsed().as_secs_f64(),
            build: 0.0,
        };
        Ok((prepared, times))
    }

    /// Reads and compiles the scene.
    pub(crate) fn compiled(
        &self,
        moment: Moment,
        accelerator: &AcceleratorArgs,
        reporter: &Reporter,
    ) -> Result<(RenderScene, LoadTimes), Failure> {
        let (prepared, mut times) = self.prepared(moment, reporter)?;
        let start = Instant::now();
        work::doing(format!(
            "building the {} of {}",
            accelerator.kind().name(),
            self.name()
        ));
        let compiled = prepared.build(accelerator.kind());
        times.build = start.elapsed().as_secs_f64();
        times.compile += times.build;
        Ok((compiled, times))
    }
}

impl Input<'_> {
    /// As [`Input::compiled`], but takes the scene that is kept if it is that of this moment, and keeps what it has compiled. The scene and the
    /// options must be those of the input that has filled `kept`.
    pub(crate) fn shared(
        &self,
        moment: Moment,
        accelerator: &AcceleratorArgs,
        reporter: &Reporter,
        kept: &Kept,
    ) -> Result<(Rc<RenderScene>, LoadTimes), Failure> {
        // Taken, so that the scene of another moment makes room for this one's.
        let last = kept.0.borrow_mut().take();
        let (known, times) = match last {
            Some(known) if known.moment == moment => {
                *self.inputs.borrow_mut() = known.inputs.clone();
                (known, LoadTimes::default())
            }
            other => {
                drop(other);
                let (scene, times) = self.compiled(moment, accelerator, reporter)?;
                let known = KeptScene {
                    moment,
                    scene: Rc::new(scene),
                    inputs: self.inputs.borrow().clone(),
                };
                (known, times)
            }
        };
        *kept.0.borrow_mut() = Some(known.clone());
        Ok((known.scene, times))
    }
}

/// Prints a message of a scene on the standard error at once; warnings are already among the diagnostics.
fn print_message(stream: Stream, text: &str) {
    if stream != Stream::Warning {
        Reporter::message(text);
    }
}

/// The options that affect the values of pixels.
pub(crate) fn render_options(scene: &RenderScene, args: &PictureArgs) -> RenderOptions {
    let (width, height) = args.size.or(scene.settings().size).unwrap_or(DEFAULT_SIZE);
    let mut options = RenderOptions::new(scene, width, height);
    options.sampling = args.sampling.unwrap_or(Sampling::ADAPTIVE);
    options.seed = args.seed;
    options.trace.max_tree_rays = args.max_tree_rays;
    options.trace.force_shading = args.shading;
    options.trace.packets = !args.no_packets;
    if let Some(depth) = args.max_depth {
        options.trace.max_depth = depth;
    }
    if let Some(weight) = args.adc_bailout {
        options.trace.adc_bailout = weight;
    }
    options
}

/// The number of threads, at most one per processor: more would slow each other down.
pub(crate) fn threads(asked: usize, reporter: &Reporter) -> usize {
    if asked <= 1 {
        return asked;
    }
    let most = std::thread::available_parallelism().map_or(1, usize::from);
    if asked > most {
        let are = if most == 1 { "is" } else { "are" };
        let s = if most == 1 { "" } else { "s" };
        reporter.say(&format!(
            "note: {asked} threads were requested; strahl uses {most}, because there {are} {most} processor{s}"
        ));
        return most;
    }
    asked
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{Cli, Command};
    use clap::Parser;

    #[test]
    fn tiles_of_one_moment_share_the_scene() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("scene.pov");
        std::fs::write(&file, "sphere { clock * x, 1 }").unwrap();
        let cli = Cli::parse_from(["strahl", "render", &file.display().to_string()]);
        let Command::Render(args) = &cli.command else {
            panic!("another command");
        };
        let (reporter, kept) = (Reporter::new(true), Kept::default());
        let load = |clock: f64| {
            let input = Input::new(args.scene.as_deref(), None, &args.pov, None).unwrap();
            let input = input.recording(true);
            let moment = Moment {
                clock,
                ..input.still()
            };
            let accelerator = &args.accelerator;
            let (scene, _) = input.shared(moment, accelerator, &reporter, &kept).unwrap();
            (scene, input.inputs().unwrap().identity())
        };
        let (first, same) = (load(0.0), load(0.0));
        assert!(Rc::ptr_eq(&first.0, &same.0));
        assert_eq!(first.1, same.1);
        let other = load(1.0);
        assert!(!Rc::ptr_eq(&first.0, &other.0));
    }
}
