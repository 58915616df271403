//! Makes job folders.

use super::status::duration;
use super::word;
use crate::animation::Animation;
use crate::args::submit::PartArgs;
use crate::args::{Cli, RenderArgs};
use crate::input::{Input, Moment, render_options, threads};
use crate::report::{Failure, Reporter};
use crate::target::Target;
use crate::{tile, work};
use clap::parser::ValueSource;
use clap::{ArgMatches, CommandFactory};
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use strahl::Inputs;
use strahl::tracing::{CostMap, CostMeasure, Progress, Region, RenderOptions, estimate};
use strahl_farm::{Bundle, Job, JobFrame, Movie, split};

/// Rays that look where the scene is costly, once for a job, besides those that look for edges: with 4,800 the longest of ten tiles took 1.5 times
/// the mean in two of six scenes.
const LOOKS: f64 = 30_000.0;

/// One ray looks for so many pixels in both directions, at most.
const WIDEST: f64 = 8.0;

/// A tile of a job has at least this many pixels, unless more tiles are asked for.
const LEAST_PIXELS: u64 = 96 * 96;

/// The share of a task that reading the scene may take, before a picture is cut into fewer tiles.
const READING: f64 = 0.05;

/// The most tasks of a job: Slurm's default limit of an array is 1001.
const MOST_TASKS: usize = 1000;

/// Options of `render` that tasks set themselves.
const NOT_FOR_TASKS: [&str; 9] = [
    "scene",
    "output",
    "quiet",
    "bundle",
    "expect",
    "only_frame",
    "now",
    "job_id",
    "threads",
];

/// Options of `render` for the file of the picture, which the merge writes.
const OF_PICTURES: [&str; 4] = ["picture_format", "bit_depth", "grayscale", "jpeg_quality"];

/// The clock for the look: the time of the thread, which other programs on the machine don't disturb, or else the time of day.
struct Clock(Instant);

impl Progress for Clock {
    fn now(&self) -> u64 {
        let time = thread_time().unwrap_or_else(|| self.0.elapsed());
        u64::try_from(time.as_nanos()).unwrap_or(u64::MAX)
    }
}

#[cfg(unix)]
fn thread_time() -> Option<Duration> {
    use nix::time::{ClockId, clock_gettime};
    let time = clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID).ok()?;
    Some(Duration::from(time))
}

#[cfg(not(unix))]
fn thread_time() -> Option<Duration> {
    None
}

/// A job folder that was made.
pub(super) struct Created {
    pub(super) folder: PathBuf,
    pub(super) job: Job,
}

/// Makes the job folder of a command line; `finish` adds what the scheduler reads.
pub(super) fn create(
    engine: &str,
    parts: &PartArgs,
    args: &RenderArgs,
    words: &[OsString],
    chunk: Option<u32>,
    finish: impl FnOnce(&Job, &Path, &Path) -> Result<(), Failure>,
) -> Result<Created, Failure> {
    let reporter = Reporter::new(args.quiet);
    refuse(args)?;
    let scene = scene_file(args)?;
    let target = Target::of(args)?;
    target.check(args, false)?;
    let Some(output) = target.file() else {
        return Err(Failure::new("a job needs a picture file: -o PICTURE"));
    };
    let output = absolute(output)?;
    let folder = match &parts.job {
        Some(folder) => absolute(folder)?,
        None => output.with_extension("job"),
    };
    if folder.exists() {
        return Err(Failure::new(format!(
            "{} exists already: `strahl submit resume {}` goes on with it, --job DIR names another folder",
            folder.display(),
            word(&folder)
        )));
    }
    let input = target.input(args)?;
    let now = strahl::sdl::present();
    let input = input.recording(true).at_time(Some(now));
    let animation = animation(parts, args, &input)?;
    let picture_words = render_words(engine, words, |id| OF_PICTURES.contains(&id))?;
    let mut words = render_words(engine, words, |id| {
        !NOT_FOR_TASKS.contains(&id) && !OF_PICTURES.contains(&id)
    })?;
    if let (Some((first, last)), None) = (parts.frames, Animation::new(&args.animation, None)?) {
        words.push(format!("--initial-frame={first}"));
        words.push(format!("--final-frame={last}"));
    }

    let moments: Vec<(Option<u32>, Moment)> = match &animation {
        None => vec![(None, input.still())],
        Some(animation) => {
            let frames = animation.frames.iter();
            frames.map(|f| (Some(*f), animation.moment(*f))).collect()
        }
    };
    let mut job = Job::new(tile::VERSION);
    let mut inputs = vec![];
    for (number, moment) in &moments {
        if let Some(number) = number {
            work::doing(format!("reading frame {number}"));
        }
        input.load(*moment, &reporter)?;
        let read = input.inputs()?;
        job.frames.push(JobFrame {
            number: *number,
            scene: read.identity(),
        });
        inputs.push(read);
    }
    input.has_said();
    tell(&inputs, parts, &reporter);
    job.now = inputs.iter().any(|i| i.record.time).then_some(now);
    job.digits = animation.as_ref().map_or(1, Animation::digits);
    let count = match (parts.tiles, &animation) {
        (Some(count), _) => Some(count),
        (None, Some(_)) => Some(1),
        (None, None) => None,
    };
    job.movie = movie(parts, &job)?;
    let Division { tiles, size } = divide(&input, moments[0].1, args, parts, count, &reporter)?;
    job.tiles = tiles.iter().map(Region::to_string).collect();
    job.size = size;
    let least = job.units().div_ceil(MOST_TASKS);
    job.chunk = chunk.unwrap_or(u32::try_from(least).unwrap_or(u32::MAX));
    job.words = words;
    job.picture_words = picture_words;
    job.output = output;
    job.folder = std::env::current_dir().map_err(Failure::new)?;
    reporter.settle()?;

    // The folder gets its name when it is complete.
    let parent = folder.parent().unwrap_or(Path::new("/"));
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let new = parent.join(format!(".{name}.{}", std::process::id()));
    let made = fill(&mut job, &inputs, &scene, &new, &folder, parts, finish);
    let renamed = made.and_then(|()| {
        fs::rename(&new, &folder)
            .map_err(|error| Failure::new(format!("cannot make {}: {error}", folder.display())))
    });
    if let Err(failure) = renamed {
        // The failure is reported; the folder has a name of its own.
        let _ = fs::remove_dir_all(&new);
        return Err(failure);
    }
    Ok(Created { folder, job })
}

/// Writes everything into the new folder, which will be renamed.
fn fill(
    job: &mut Job,
    inputs: &[Inputs],
    scene: &Path,
    new: &Path,
    folder: &Path,
    parts: &PartArgs,
    finish: impl FnOnce(&Job, &Path, &Path) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let failed = |error: std::io::Error| {
        Failure::new(format!(
            "cannot write the job folder {}: {error}",
            folder.display()
        ))
    };
    for part in ["tiles", "state", "log"] {
        fs::create_dir_all(new.join(part)).map_err(failed)?;
    }
    if parts.no_bundle {
        job.scene = absolute(scene)?;
    } else {
        let place = new.join("scene");
        fs::create_dir_all(&place).map_err(failed)?;
        let bundle = Bundle::create(inputs, &place).map_err(failed)?;
        job.scene = Path::new("scene").join(bundle.scene);
        job.bundled = true;
    }
    job.write(new).map_err(Failure::new)?;
    finish(job, new, folder)
}

/// The film file of a job with these frames.
fn movie(parts: &PartArgs, job: &Job) -> Result<Option<Movie>, Failure> {
    let Some(file) = &parts.movie else {
        return Ok(None);
    };
    let numbers: Vec<u32> = job.frames.iter().filter_map(|frame| frame.number).collect();
    if numbers.is_empty() {
        return Err(Failure::new("--movie needs a film: add --frames A-B"));
    }
    if numbers.windows(2).any(|pair| pair[1] != pair[0] + 1) {
        return Err(Failure::new(
            "--movie needs consecutive frames, but some are left out (--frame-step)",
        ));
    }
    Ok(Some(Movie {
        file: absolute(file)?,
        rate: parts.movie_rate,
    }))
}

/// Refuses options that have no meaning for a job.
fn refuse(args: &RenderArgs) -> Result<(), Failure> {
    let options = [
        ("--stats", args.stats.is_some()),
        ("--profile", args.profile.is_some()),
        ("--no-output", args.no_output),
        ("--tile", args.tile.is_some()),
        ("--region", args.region.is_some()),
        ("--resume", args.resume),
        ("--allow-write", args.pov.allow_write.is_some()),
    ];
    match options.iter().find(|(_, given)| *given) {
        Some((option, _)) => Err(Failure::new(format!("{option} has no meaning for a job"))),
        None => Ok(()),
    }
}

fn scene_file(args: &RenderArgs) -> Result<PathBuf, Failure> {
    match &args.scene {
        Some(scene) if scene.as_os_str() != "-" => Ok(scene.clone()),
        _ => Err(Failure::new(
            "a job needs a scene file: strahl submit slurm SCENE -o PICTURE",
        )),
    }
}

fn absolute(path: &Path) -> Result<PathBuf, Failure> {
    std::path::absolute(path).map_err(Failure::new)
}

/// The frames, as POV-Ray's options or `--frames` say.
fn animation(
    parts: &PartArgs,
    args: &RenderArgs,
    input: &Input<'_>,
) -> Result<Option<Animation>, Failure> {
    let mut animation = Animation::new(&args.animation, None)?;
    if let Some((first, last)) = parts.frames {
        animation = Some(match animation {
            None => Animation::range(&args.animation, first, last)?,
            Some(mut all) => {
                all.frames.retain(|frame| (first..=last).contains(frame));
                if all.frames.is_empty() {
                    return Err(Failure::new(format!(
                        "the animation has no frame from {first} to {last}"
                    )));
                }
                all
            }
        });
    }
    if animation.is_some() && !input.is_pov() {
        return Err(Failure::new(format!(
            "{} does not change with the clock: only scenes in POV-Ray's language (.pov) can be animated",
            input.name()
        )));
    }
    Ok(animation)
}

/// The wanted options of `render` among the words of the command line.
fn render_words(
    engine: &str,
    words: &[OsString],
    wanted: impl Fn(&str) -> bool,
) -> Result<Vec<String>, Failure> {
    let command = Cli::command();
    let matches = command
        .clone()
        .try_get_matches_from(words)
        .map_err(Failure::new)?;
    let ours: Option<&ArgMatches> = matches
        .subcommand_matches("submit")
        .and_then(|submit| submit.subcommand_matches(engine));
    let (Some(ours), Some(render)) = (ours, command.find_subcommand("render")) else {
        return Ok(vec![]);
    };
    let mut all = vec![];
    for argument in render.get_arguments() {
        let (id, Some(long)) = (argument.get_id().as_str(), argument.get_long()) else {
            continue;
        };
        if !wanted(id) || ours.value_source(id) != Some(ValueSource::CommandLine) {
            continue;
        }
        if !argument.get_action().takes_values() {
            all.push(format!("--{long}"));
            continue;
        }
        for value in ours.get_raw(id).into_iter().flatten() {
            let value = value.to_str().ok_or_else(|| {
                Failure::new(format!("--{long} is not UTF-8, which a job can't keep"))
            })?;
            all.push(format!("--{long}={value}"));
        }
    }
    Ok(all)
}

/// Tells what will be different for a scene that has effects besides its picture.
fn tell(inputs: &[Inputs], parts: &PartArgs, reporter: &Reporter) {
    let written: BTreeSet<&String> = inputs.iter().flat_map(|i| &i.record.writes).collect();
    if !written.is_empty() {
        let names: Vec<&str> = written.into_iter().map(String::as_str).collect();
        let what = names.join(", ");
        reporter.warn(&match parts.no_bundle {
            true => format!("the scene writes files ({what}): several tasks will write them at the same time"),
            false => format!("the scene writes files ({what}): its tasks keep them in memory, and nothing is left of them"),
        });
    }
    if inputs.iter().any(|i| i.record.time) {
        reporter.say("note: the scene reads the time (`now`): all tasks are told the time of this submission");
    }
}

/// How a picture is cut.
struct Division {
    tiles: Vec<Region>,
    size: (u32, u32),
}

/// Cuts the picture into tiles of about equal cost. Tells what tasks will take, as far as the look shows it.
fn divide(
    input: &Input<'_>,
    moment: Moment,
    args: &RenderArgs,
    parts: &PartArgs,
    count: Option<u32>,
    reporter: &Reporter,
) -> Result<Division, Failure> {
    let (scene, times) = input.compiled(moment, &args.accelerator, reporter)?;
    let mut options: RenderOptions = render_options(&scene, &args.picture);
    options.threads = threads(args.threads, reporter);
    let (width, height) = (options.width, options.height);
    let size = (width, height);
    // Also the error for impossible sizes, which is the film's.
    let even = CostMap::even(width, height);
    if count == Some(1) {
        let tiles = split(&even, 1).map_err(Failure::new)?;
        return Ok(Division { tiles, size });
    }
    work::doing("looking where the scene is costly");
    let spacing = (f64::from(width) * f64::from(height) / LOOKS).sqrt();
    let spacing = spacing.clamp(1.0, WIDEST) as u32;
    let clock = Clock(Instant::now());
    let map = estimate(&scene, &options, spacing, CostMeasure::Timed, &clock);
    let map = map.map_err(Failure::new)?;
    let work = map.costs.iter().map(|cost| *cost as f64).sum::<f64>() / 1e9;
    let reading = times.load + times.compile;
    let count = count.unwrap_or_else(|| number_of_tiles(&map, parts.nodes, work, reading));
    let tiles = split(&map, count).map_err(Failure::new)?;
    let each = work / f64::from(count);
    reporter.say(&format!(
        "about {} of processor time for {}; every task also reads and builds the scene, which took {} here",
        duration(each),
        match count {
            1 => "its tile".to_owned(),
            _ => format!("each of {count} tiles"),
        },
        duration(reading)
    ));
    Ok(Division { tiles, size })
}

/// Four tiles for each node, but not so many that reading the scene would take more than a twentieth of each task, as long as every node has one.
fn number_of_tiles(map: &CostMap, nodes: u32, work: f64, reading: f64) -> u32 {
    let pixels = u64::from(map.width) * u64::from(map.height);
    let most = (pixels / LEAST_PIXELS).min(map.costs.len() as u64).max(1);
    // Saturating, as conversions of floats are.
    let affordable = (work * READING / reading.max(1e-9)) as u64;
    let wanted = affordable.clamp(nodes.into(), u64::from(nodes) * 4);
    u32::try_from(wanted.min(most)).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_that_are_slow_to_read_get_fewer_tiles() {
        let map = CostMap::even(1920, 1080);
        let number = |work, reading| number_of_tiles(&map, 10, work, reading);
        assert_eq!(number(100.0, 0.01), 40);
        assert_eq!(number(100.0, 0.25), 20);
        // One for each node in any case.
        assert_eq!(number(100.0, 60.0), 10);
        assert_eq!(number(100.0, 0.0), 40);
        // No tile is smaller than it should be.
        let small = CostMap::even(200, 100);
        assert_eq!(number_of_tiles(&small, 10, 100.0, 0.01), 2);
    }
}
