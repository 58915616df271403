use crate::animation::Animation;
use crate::args::RenderArgs;
use crate::input::{DEFAULT_SIZE, Input, LoadTimes, Moment, render_options};
use crate::interrupt;
use crate::progress::Watch;
use crate::report::{Failure, Reporter};
use crate::stats::{RenderTimes, Stats};
use std::path::{Path, PathBuf};
use std::time::Instant;
use strahl::formats::image::{
    ImageFormat, Picture, Window, WriteOptions, write_bytes, write_picture,
};
use strahl::tracing::{Film, RenderError, RenderOptions, RenderScene, Rendered, TileOrder};

/// `strahl render`: from a scene to a picture, or to the pictures of an animation.
pub(crate) fn render(args: &RenderArgs) -> Result<(), Failure> {
    interrupt::listen();
    let output = output_path(args)?;
    let animation = Animation::new(&args.animation)?;
    check_output(args, &output, animation.is_some())?;
    let input = Input::new(
        args.scene.as_deref(),
        args.format,
        &args.pov,
        args.picture.size,
    )?;
    let job = Job {
        args,
        input: &input,
        reporter: Reporter::new(args.quiet),
        start: Instant::now(),
    };
    match animation {
        Some(animation) => job.animation(&animation, &output),
        None => job.still(&output),
    }
}

/// What all pictures of a run share.
struct Job<'a> {
    args: &'a RenderArgs,
    input: &'a Input<'a>,
    reporter: Reporter,
    start: Instant,
}

/// A picture before it is written.
struct Traced {
    scene: RenderScene,
    options: RenderOptions,
    rendered: Rendered,
    times: LoadTimes,
    trace: f64,
}

impl Job<'_> {
    fn still(&self, output: &Path) -> Result<(), Failure> {
        if self.is_complete(output) {
            self.say(&format!("{}: complete already", output.display()));
            return Ok(());
        }
        let watch = Watch::new(self.args.quiet, 1);
        let traced = self.trace(self.input.still(), &watch);
        watch.finish();
        let traced = traced?.ok_or_else(|| Failure::Interrupted("nothing was written".into()))?;
        let write_start = Instant::now();
        self.write(&traced, output)?;
        let write = write_start.elapsed().as_secs_f64();
        self.statistics(&traced, write)?;
        let (film, trace) = (&traced.rendered.film, traced.trace);
        let rays = traced.rendered.rays.total();
        self.say(&format!(
            "{}{}x{}, {rays} rays in {trace:.2} s ({:.2} Mrays/s), {:.2} s in all",
            match self.args.no_output {
                true => String::new(),
                false => format!("{}: ", output.display()),
            },
            film.region.width,
            film.region.height,
            rays as f64 / trace.max(1e-9) / 1e6,
            self.start.elapsed().as_secs_f64(),
        ));
        Ok(())
    }

    fn animation(&self, animation: &Animation, output: &Path) -> Result<(), Failure> {
        if !self.input.is_pov() {
            return Err(Failure::new(format!(
                "{} does not change with the clock: only scenes in POV-Ray's language (.pov) can be animated",
                self.input.name()
            )));
        }
        let all = animation.frames.len();
        let watch = Watch::new(self.args.quiet, all);
        let (mut written, mut kept) = (0, 0);
        for (index, frame) in animation.frames.iter().enumerate() {
            watch.frame(index, *frame);
            let file = animation.file(output, *frame);
            if self.is_complete(&file) {
                kept += 1;
                continue;
            }
            let traced = self.trace(animation.moment(*frame), &watch);
            let traced = traced.inspect_err(|_| {
                watch.finish();
                eprintln!("in frame {frame} of {}", self.input.name());
            })?;
            let Some(traced) = traced else {
                watch.finish();
                return Err(Failure::Interrupted(format!(
                    "{} of {all} frames are complete; --resume goes on with the rest",
                    written + kept
                )));
            };
            self.write(&traced, &file)?;
            written += 1;
        }
        watch.finish();
        let name = |frame: Option<&u32>| match frame {
            Some(frame) => animation.file(output, *frame).display().to_string(),
            None => String::new(),
        };
        let kept = match kept {
            0 => String::new(),
            n => format!(", {n} were complete already"),
        };
        self.say(&format!(
            "{} to {}: {all} frames{kept}, {:.2} s in all",
            name(animation.frames.first()),
            name(animation.frames.last()),
            self.start.elapsed().as_secs_f64(),
        ));
        Ok(())
    }

    fn say(&self, text: &str) {
        if !self.args.quiet {
            eprintln!("{text}");
        }
    }

    /// Whether the picture needs not be rendered again.
    fn is_complete(&self, file: &Path) -> bool {
        self.args.resume && complete(file, self.args.picture.size)
    }

    /// Loads, compiles and renders; `None` if the user pressed Ctrl-C.
    fn trace(&self, moment: Moment, watch: &Watch) -> Result<Option<Traced>, Failure> {
        if interrupt::pressed() {
            return Ok(None);
        }
        let args = self.args;
        let picture = &args.picture;
        let load = || {
            self.input
                .compiled(moment, &args.accelerator, &self.reporter)
        };
        let (scene, times) = watch.suspend(load)?;
        let mut options = render_options(&scene, picture);
        options.region = args.region;
        options.threads = args.threads;
        options.tile_order = TileOrder::from(args.tile_order);
        options.info = args.layers;
        let start = Instant::now();
        let rendered = match strahl::render(&scene, &options, watch) {
            Ok(rendered) => rendered,
            Err(RenderError::Cancelled) => return Ok(None),
            Err(other) => return Err(Failure::new(other)),
        };
        let trace = start.elapsed().as_secs_f64();
        let cut = rendered.rays.cut_trees;
        if cut > 0 {
            watch.suspend(|| {
                eprintln!(
                    "warning: {cut} branches were not followed because their trees had {} rays already; \
                     raise --adc-bailout, lower --max-depth or raise --max-tree-rays",
                    options.trace.max_tree_rays
                );
            });
        }
        Ok(Some(Traced {
            scene,
            options,
            rendered,
            times,
            trace,
        }))
    }

    fn write(&self, traced: &Traced, output: &Path) -> Result<(), Failure> {
        if self.args.no_output {
            return Ok(());
        }
        let film = &traced.rendered.film;
        let mut metadata = strahl::metadata(film);
        metadata.push(("scene".into(), self.input.name()));
        metadata.push(("accelerator".into(), traced.scene.accelerator_name().into()));
        metadata.push(("sampling".into(), traced.options.sampling.to_string()));
        let options = WriteOptions {
            bit_depth: self.args.bit_depth,
            ..WriteOptions::default()
        };
        let layers = strahl::layers(film);
        let picture = strahl::picture(film, &layers, metadata);
        let whole;
        let picture = if self.args.full_size {
            whole = enlarged(film);
            Picture {
                window: Window {
                    x: 0,
                    y: 0,
                    width: film.width,
                    height: film.height,
                },
                rgb: &whole,
                ..picture
            }
        } else {
            picture
        };
        write_picture(output, &picture, &options).map_err(Failure::new)
    }

    fn statistics(&self, traced: &Traced, write: f64) -> Result<(), Failure> {
        let Some(path) = &self.args.stats else {
            return Ok(());
        };
        let sha256 = traced.rendered.film.sha256();
        let times = RenderTimes {
            trace: traced.trace,
            write,
            total: self.start.elapsed().as_secs_f64(),
        };
        let stats = Stats::new(
            &traced.scene,
            &traced.rendered,
            &sha256,
            traced.times,
            times,
        );
        let mut json = serde_json::to_vec_pretty(&stats).map_err(Failure::new)?;
        json.push(b'\n');
        write_bytes(path, &json).map_err(Failure::new)
    }
}

/// The film's part in a black picture of the whole size.
fn enlarged(film: &Film) -> Vec<[f32; 3]> {
    let region = film.region;
    let mut whole = vec![[0.0; 3]; film.width as usize * film.height as usize];
    let rows = whole.chunks_exact_mut(film.width.max(1) as usize);
    let rows = rows.skip(region.y as usize);
    let parts = film.pixels.chunks_exact(region.width.max(1) as usize);
    for (row, part) in rows.zip(parts) {
        for (pixel, value) in row.iter_mut().skip(region.x as usize).zip(part) {
            *pixel = *value;
        }
    }
    whole
}

/// Whether a file holds a whole picture: strahl renames pictures into place when they are complete, other programs may not.
fn complete(file: &Path, size: Option<(u32, u32)>) -> bool {
    const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
    let Ok(bytes) = std::fs::read(file) else {
        return false;
    };
    if !bytes.starts_with(PNG) {
        return !bytes.is_empty();
    }
    let number = |at: usize| {
        let bytes = bytes.get(at..at + 4)?;
        Some(u32::from_be_bytes(bytes.try_into().ok()?))
    };
    let is_size = |(w, h)| number(16) == Some(w) && number(20) == Some(h);
    let end = bytes.len().saturating_sub(8);
    bytes[end..].starts_with(b"IEND") && is_size(size.unwrap_or(DEFAULT_SIZE))
}

/// Before the work, not after it: is there such a format, and a folder to write to?
fn check_output(args: &RenderArgs, output: &Path, animated: bool) -> Result<(), Failure> {
    let format = ImageFormat::from_path(output).map_err(Failure::new)?;
    if args.layers && !format.info().layers {
        return Err(Failure::new(format!(
            "--layers needs a format with layers (.exr), but the picture is {}",
            output.display()
        )));
    }
    if animated && args.stats.is_some() {
        return Err(Failure::new(
            "--stats is about one picture: render the frames one by one with --subset-start-frame and --subset-end-frame, \
             or leave it out",
        ));
    }
    for file in [Some(output), args.stats.as_deref()].into_iter().flatten() {
        check_folder(file)?;
    }
    Ok(())
}

/// Where the picture goes.
fn output_path(args: &RenderArgs) -> Result<PathBuf, Failure> {
    if let Some(output) = &args.output {
        return Ok(output.clone());
    }
    let Some(scene) = &args.scene else {
        return Ok(PathBuf::from("demo.png"));
    };
    let name = scene.file_name().filter(|name| *name != "-");
    let Some(name) = name.and_then(|n| n.to_str()) else {
        return Err(Failure::new("where shall the picture go? add -o PICTURE"));
    };
    let stem = name.strip_suffix(".gz").unwrap_or(name);
    let stem = stem.rsplit_once('.').map_or(stem, |(stem, _)| stem);
    Ok(PathBuf::from(format!("{stem}.png")))
}

/// Whether a file's folder exists: cheaper to know before the render than after.
fn check_folder(file: &Path) -> Result<(), Failure> {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
            Err(Failure::new(format!(
                "cannot write {}: there is no folder {}",
                file.display(),
                folder.display()
            )))
        }
        _ => Ok(()),
    }
}
