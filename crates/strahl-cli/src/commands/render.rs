use crate::animation::Animation;
use crate::args::RenderArgs;
use crate::input::{DEFAULT_SIZE, Input, Kept, LoadTimes, Moment, render_options, threads};
use crate::profile::{self, Sampler, Seconds};
use crate::progress::Watch;
use crate::report::{Failure, Reporter};
use crate::stats::{RenderTimes, Stats};
use crate::target::Target;
use crate::words::counted;
use crate::{complete, interrupt, output, terminal, tile, work};
use std::rc::Rc;
use std::time::Instant;
use strahl::formats::image::{Picture, Window, WriteOptions};
use strahl::tracing::{Film, RenderError, RenderOptions, RenderScene, Rendered, TileOrder};
use strahl_farm::TileInfo;

/// `strahl render`: renders a scene to a picture, or to the pictures of an animation.
pub(crate) fn run(args: &RenderArgs, reporter: Reporter) -> Result<(), Failure> {
    render_with(args, reporter, &Kept::default())
}

/// `strahl render` with a scene that may be known from an earlier tile of the same picture.
pub(crate) fn render_with(
    args: &RenderArgs,
    reporter: Reporter,
    kept: &Kept,
) -> Result<(), Failure> {
    let animation = Animation::new(&args.animation, args.job.only_frame)?;
    let target = Target::of(args)?;
    target.check(args, animation.is_some())?;
    let input = target.input(args)?;
    let input = match &args.job.bundle {
        // Many tasks would write the same files; in memory the scene can read them again.
        Some(folder) => input.bundled(folder)?,
        None => input.writing()?,
    };
    let input = input.recording(args.tile.is_some()).at_time(args.job.now);
    let threads = threads(args.threads, &reporter);
    reporter.settle()?;
    let job = Job {
        args,
        input: &input,
        reporter,
        target,
        threads,
        kept,
        start: Instant::now(),
    };
    match animation {
        Some(animation) => job.animation(&animation)?,
        None => job.still()?,
    }
    // The picture is written; warnings may still end the program with an exit code.
    job.reporter.settle()
}

/// Data common to all pictures of a run.
struct Job<'a> {
    args: &'a RenderArgs,
    input: &'a Input<'a>,
    reporter: Reporter,
    target: Target,
    threads: usize,
    kept: &'a Kept,
    start: Instant,
}

/// A picture that is not yet written.
struct Traced {
    scene: Rc<RenderScene>,
    options: RenderOptions,
    rendered: Rendered,
    times: LoadTimes,
    trace: f64,
    moment: Moment,
}

impl Job<'_> {
    fn still(&self) -> Result<(), Failure> {
        let target = &self.target;
        if self.is_complete(target, self.input.still())? {
            self.reporter
                .say(&format!("{}: complete already", target.shown()));
            return Ok(());
        }
        interrupt::would_lose("no picture was written");
        let mut watch = Watch::new(self.args.quiet, 1);
        let sampler = self.args.profile.is_some().then(Sampler::start);
        watch.activities = sampler.as_ref().map(Sampler::activities);
        let traced = self.trace(self.input.still(), &watch)?;
        let write_start = Instant::now();
        self.write(&traced, target)?;
        let write = write_start.elapsed().as_secs_f64();
        watch.finish();
        self.statistics(&traced, write)?;
        if let (Some(sampler), Some(file)) = (sampler, &self.args.profile) {
            let seconds = Seconds {
                load: traced.times.load,
                compile: traced.times.compile,
                trace: traced.trace,
                write,
            };
            let report = sampler.report(&traced.scene);
            let threads = traced.rendered.threads;
            profile::write(
                &report,
                &self.input.name(),
                (threads, seconds),
                file.as_deref(),
            )?;
        }
        let (film, trace) = (&traced.rendered.film, traced.trace);
        let rays = traced.rendered.rays.total();
        self.reporter.say(&format!(
            "{}{}x{}, {rays} rays in {trace:.2} s ({:.2} Mrays/s), {:.2} s in all",
            match self.args.no_output {
                true => String::new(),
                false => format!("{}: ", target.shown()),
            },
            film.region.width,
            film.region.height,
            rays as f64 / trace.max(1e-9) / 1e6,
            self.start.elapsed().as_secs_f64(),
        ));
        Ok(())
    }

    fn animation(&self, animation: &Animation) -> Result<(), Failure> {
        if !self.input.is_pov() {
            return Err(Failure::new(format!(
                "{} does not change with the clock: only scenes in POV-Ray's language (.pov) can be animated",
                self.input.name()
            )));
        }
        let all = animation.frames.len();
        let mut watch = Watch::new(self.args.quiet, all);
        let (mut written, mut kept) = (0, 0);
        for (index, frame) in animation.frames.iter().enumerate() {
            interrupt::would_lose(format!(
                "{} of {all} frames are complete; --resume renders the rest",
                written + kept
            ));
            watch.frame(index, *frame);
            let target = match self.args.job.only_frame {
                // The file of a job's part has its number already.
                Some(_) => self.target.clone(),
                None => self.target.of_frame(animation, *frame),
            };
            if self.is_complete(&target, animation.moment(*frame))? {
                kept += 1;
                continue;
            }
            let traced = self.trace(animation.moment(*frame), &watch);
            let done = traced.and_then(|traced| self.write(&traced, &target));
            done.inspect_err(|failure| {
                if !matches!(failure, Failure::Interrupted) {
                    let name = self.input.name();
                    terminal::line(&format!("in frame {frame} of {name}"));
                }
            })?;
            written += 1;
        }
        watch.finish();
        let name = |frame: Option<&u32>| match frame {
            Some(frame) => self.target.of_frame(animation, *frame).shown(),
            None => String::new(),
        };
        let kept = match kept {
            0 => String::new(),
            1 => ", 1 was complete already".to_owned(),
            n => format!(", {n} were complete already"),
        };
        self.reporter.say(&format!(
            "{} to {}: {}{kept}, {:.2} s in all",
            name(animation.frames.first()),
            name(animation.frames.last()),
            counted(all as u64, "frame"),
            self.start.elapsed().as_secs_f64(),
        ));
        Ok(())
    }

    /// Whether the picture exists and need not be rendered again.
    fn is_complete(&self, target: &Target, moment: Moment) -> Result<bool, Failure> {
        match target.file() {
            Some(file) if self.args.resume && file.is_file() => {
                let size = self.size_of_file(moment)?;
                Ok(complete::is_complete(file, target.format(), size))
            }
            _ => Ok(false),
        }
    }

    /// The size of the picture that will be written.
    fn size_of_file(&self, moment: Moment) -> Result<(u32, u32), Failure> {
        let args = self.args;
        match (args.region, args.picture.size) {
            (Some(region), _) if !args.full_size => Ok((region.width, region.height)),
            (_, Some(size)) => Ok(size),
            // No scene in POV-Ray's language has a size of its own.
            _ if self.input.is_pov() => Ok(DEFAULT_SIZE),
            _ => {
                let scene = self.input.load(moment, &self.reporter)?;
                // If the picture is not complete, the scene is read once more.
                Ok(scene.settings.size.unwrap_or(DEFAULT_SIZE))
            }
        }
    }

    /// Loads, compiles and renders.
    fn trace(&self, moment: Moment, watch: &Watch) -> Result<Traced, Failure> {
        if interrupt::pressed() {
            return Err(Failure::Interrupted);
        }
        let args = self.args;
        let picture = &args.picture;
        let (scene, times) =
            self.input
                .shared(moment, &args.accelerator, &self.reporter, self.kept)?;
        let mut options = render_options(&scene, picture);
        options.region = args.region;
        options.threads = self.threads;
        options.tile_order = TileOrder::from(args.tile_order);
        options.info = args.layers;
        options.alpha = args.alpha;
        if let Some(place) = args.tile {
            self.expect()?;
            if args.job.now.is_none() && self.input.inputs()?.record.time {
                self.reporter.warn(
                    "the scene reads the time (`now`), which differs from tile to tile: pass a number with --declare instead",
                );
            }
            work::doing("looking where the scene is costly");
            options.region = Some(tile::region(&scene, &options, place)?);
        }
        let start = Instant::now();
        let rendered = match strahl::render_watched(&scene, &options, watch) {
            Ok(rendered) => rendered,
            Err(RenderError::Cancelled) => return Err(Failure::Interrupted),
            Err(other) => return Err(Failure::new(other)),
        };
        let trace = start.elapsed().as_secs_f64();
        let cut = rendered.rays.cut_trees;
        if cut > 0 {
            self.reporter.warn(&format!(
                "{cut} branches were not followed because their trees had {} rays already; \
                 raise --adc-bailout, lower --max-depth or raise --max-tree-rays",
                options.trace.max_tree_rays
            ));
        }
        Ok(Traced {
            scene,
            options,
            rendered,
            times,
            trace,
            moment,
        })
    }

    /// Checks that the scene of a job is still the one that was submitted.
    fn expect(&self) -> Result<(), Failure> {
        let Some(expected) = &self.args.job.expect else {
            return Ok(());
        };
        match self.input.inputs()?.identity() == *expected {
            true => Ok(()),
            false => Err(Failure::new(format!(
                "{} or a file it reads has changed since the job was submitted: submit it again",
                self.input.name()
            ))),
        }
    }

    fn write(&self, traced: &Traced, target: &Target) -> Result<(), Failure> {
        if self.args.no_output {
            return Ok(());
        }
        work::doing(format!("writing {}", target.shown()));
        let film = &traced.rendered.film;
        let notes = [
            ("scene".to_owned(), self.input.name()),
            (
                "accelerator".to_owned(),
                traced.scene.accelerator_name().into(),
            ),
            ("sampling".to_owned(), traced.options.sampling.to_string()),
        ];
        if let (Some(place), Some(file)) = (self.args.tile, target.file()) {
            let info = TileInfo {
                number: place.number,
                count: place.count,
                scene: self.input.inputs()?.identity(),
                settings: tile::settings(self.args, &traced.options, traced.moment),
                version: tile::VERSION.to_owned(),
                notes: notes.into(),
                rays: tile::rays(&traced.rendered.rays),
            };
            return tile::write(film, info, file);
        }
        let mut metadata = strahl::metadata();
        metadata.extend(notes);
        let options = WriteOptions {
            bit_depth: self.args.bit_depth,
            grayscale: self.args.grayscale,
            jpeg_quality: self.args.jpeg_quality,
            ..WriteOptions::default()
        };
        let layers = strahl::layers(film);
        let picture = strahl::picture(film, &layers, metadata);
        let (whole, whole_alpha);
        let picture = if self.args.full_size {
            whole = enlarged(film, &film.pixels, [0.0; 3]);
            let alpha = film.alpha.as_ref();
            whole_alpha = alpha.map(|alpha| enlarged(film, alpha, 0.0));
            Picture {
                window: Window {
                    x: 0,
                    y: 0,
                    width: film.width,
                    height: film.height,
                },
                rgb: &whole,
                alpha: whole_alpha.as_deref(),
                ..picture
            }
        } else {
            picture
        };
        target.write(&picture, &options)
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
            &traced.options.trace,
            &sha256,
            traced.times,
            times,
        );
        output::json(path, &stats)
    }
}

/// Puts the values of the film's region into a picture of the full size.
fn enlarged<T: Copy>(film: &Film, values: &[T], outside: T) -> Vec<T> {
    let region = film.region;
    let mut whole = vec![outside; film.width as usize * film.height as usize];
    let rows = whole.chunks_exact_mut(film.width.max(1) as usize);
    let rows = rows.skip(region.y as usize);
    let parts = values.chunks_exact(region.width.max(1) as usize);
    for (row, part) in rows.zip(parts) {
        for (pixel, value) in row.iter_mut().skip(region.x as usize).zip(part) {
            *pixel = *value;
        }
    }
    whole
}
