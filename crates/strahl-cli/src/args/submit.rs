//! The command lines of `strahl submit`.

use super::render::RenderArgs;
use crate::later::Later;
use clap::{ArgMatches, Args, Command, Error, FromArgMatches, Subcommand};
use std::ops::Deref;
use std::path::PathBuf;

#[derive(Debug, Subcommand)]
pub(crate) enum SubmitCommand {
    /// Write a job folder and submit it to Slurm: an array of tasks, and a merge behind it
    #[command(args_override_self = true)]
    Slurm(Later<Box<SlurmArgs>>),
    /// Write a job folder with a template of Open Job Description, for `openjd run` and AWS Deadline Cloud
    #[command(args_override_self = true)]
    Openjd(Later<Box<OpenjdArgs>>),
    /// Print how far a job is
    Status(StatusArgs),
    /// Submit what is missing of a job
    Resume(ResumeArgs),
    /// Render a part of a job: what the scheduler runs
    Task(TaskArgs),
    /// Make the pictures of a job of its tiles: what the scheduler runs at last
    Merge(MergeJobArgs),
}

/// What is rendered, in which parts.
#[derive(Debug, Args)]
#[command(next_help_heading = "Job")]
pub(crate) struct PartArgs {
    /// Tiles of the picture, or of each frame [default: four for each node for a still, one for a film]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) tiles: Option<u32>,
    /// Number of machines that will work at the same time
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) nodes: u32,
    /// Frames to render, such as 1-48
    #[arg(long, value_name = "A-B", value_parser = parse_frames)]
    pub(crate) frames: Option<(u32, u32)>,
    /// The job folder [default: the picture's name with .job]
    #[arg(long, value_name = "DIR")]
    pub(crate) job: Option<PathBuf>,
    /// Read the scene and its files where they are, instead of copying them into the job folder
    #[arg(long)]
    pub(crate) no_bundle: bool,
    /// Write the job folder, but submit nothing
    #[arg(long)]
    pub(crate) dry_run: bool,
    /// Make a film file of the frames with ffmpeg
    #[arg(long, value_name = "FILE")]
    pub(crate) movie: Option<PathBuf>,
    /// Frames per second of the film file
    #[arg(long, value_name = "N", default_value_t = 24.0, value_parser = parse_rate)]
    pub(crate) movie_rate: f64,
}

/// The options of `render` for a job.
#[derive(Debug)]
pub(crate) struct JobRenderArgs(RenderArgs);

/// Options of `render` that have no meaning for a job, which refuses them; its help does not show them.
const NOT_FOR_JOBS: [&str; 8] = [
    "stats",
    "profile",
    "no_output",
    "tile",
    "region",
    "full_size",
    "resume",
    "allow_write",
];

impl Args for JobRenderArgs {
    fn augment_args(command: Command) -> Command {
        let mut command = RenderArgs::augment_args(command);
        for id in NOT_FOR_JOBS {
            command = command.mut_arg(id, |argument| argument.hide(true));
        }
        command
            .mut_arg("scene", |scene| scene.help("Scene file"))
            .mut_arg("output", |output| {
                output.help("Picture file (see `strahl formats`), or a folder for it [default: the scene's name with .png, in the current folder]")
            })
            .mut_arg("threads", |threads| {
                threads.help("Number of threads that look here where the scene is costly; 0 means one per processor.")
            })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for JobRenderArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        RenderArgs::from_arg_matches(matches).map(Self)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        self.0.update_from_arg_matches(matches)
    }
}

impl Deref for JobRenderArgs {
    type Target = RenderArgs;

    fn deref(&self) -> &RenderArgs {
        &self.0
    }
}

#[derive(Debug, Args)]
pub(crate) struct SlurmArgs {
    #[command(flatten)]
    pub(crate) parts: PartArgs,
    /// Parts rendered by one task of the array [default: one, more if there are over 1000]
    #[arg(long, value_name = "N", help_heading = "Slurm", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) chunk: Option<u32>,
    /// Partition
    #[arg(long, value_name = "NAME", help_heading = "Slurm")]
    pub(crate) partition: Option<String>,
    /// Longest time of a task, such as 30:00
    #[arg(long, value_name = "TIME", help_heading = "Slurm")]
    pub(crate) time: Option<String>,
    /// Memory of a task, such as 8G
    #[arg(long, value_name = "MEM", help_heading = "Slurm")]
    pub(crate) mem: Option<String>,
    /// Processors of a task
    #[arg(long, value_name = "N", default_value_t = 1, help_heading = "Slurm", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) cpus: u32,
    /// A further option of sbatch, such as --sbatch=--account=physics; may be given several times
    #[arg(
        long,
        value_name = "OPTION",
        allow_hyphen_values = true,
        help_heading = "Slurm"
    )]
    pub(crate) sbatch: Vec<String>,
    /// The program on the machines [default: this one]
    #[arg(long, value_name = "FILE", help_heading = "Slurm")]
    pub(crate) program: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) render: JobRenderArgs,
}

#[derive(Debug, Args)]
pub(crate) struct OpenjdArgs {
    #[command(flatten)]
    pub(crate) parts: PartArgs,
    #[command(flatten)]
    pub(crate) render: JobRenderArgs,
}

#[derive(Debug, Args)]
pub(crate) struct StatusArgs {
    /// The job folder
    #[arg(value_name = "JOB")]
    pub(crate) job: PathBuf,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ResumeArgs {
    /// The job folder
    #[arg(value_name = "JOB")]
    pub(crate) job: PathBuf,
    /// Print what would be submitted
    #[arg(long)]
    pub(crate) dry_run: bool,
}

#[derive(Debug, Args)]
pub(crate) struct TaskArgs {
    /// The job folder
    #[arg(value_name = "JOB")]
    pub(crate) job: PathBuf,
    /// The number of the task, from 1
    #[arg(long, value_name = "N", conflicts_with_all = ["frames", "tile"])]
    pub(crate) task: Option<usize>,
    /// Frames, such as 3 or 1-4
    #[arg(long, value_name = "A-B", value_parser = parse_frames)]
    pub(crate) frames: Option<(u32, u32)>,
    /// The number of the tile, from 1 [default: all]
    #[arg(long, value_name = "K")]
    pub(crate) tile: Option<usize>,
    /// Number of threads; 0 means one per processor
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) threads: usize,
    /// Report progress and failures in the words of Open Job Description
    #[arg(long)]
    pub(crate) openjd: bool,
}

#[derive(Debug, Args)]
pub(crate) struct MergeJobArgs {
    /// The job folder
    #[arg(value_name = "JOB")]
    pub(crate) job: PathBuf,
    /// Another folder for the pictures, and the film file, than the one the job was submitted with
    #[arg(long, value_name = "DIR")]
    pub(crate) pictures: Option<PathBuf>,
    /// Report progress and failures in the words of Open Job Description
    #[arg(long)]
    pub(crate) openjd: bool,
}

fn parse_frames(s: &str) -> Result<(u32, u32), String> {
    let (a, b) = s.split_once('-').unwrap_or((s, s));
    let number = |s: &str| s.trim().parse::<u32>().ok();
    match (number(a), number(b)) {
        (Some(a), Some(b)) if a <= b => Ok((a, b)),
        _ => Err("expected a frame or a range of frames, such as 1-48".to_owned()),
    }
}

fn parse_rate(s: &str) -> Result<f64, String> {
    let rate = s.parse().ok().filter(|r: &f64| (0.01..=1000.0).contains(r));
    rate.ok_or_else(|| "expected frames per second, from 0.01 to 1000".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_numbers_or_ranges() {
        assert_eq!(parse_frames("7"), Ok((7, 7)));
        assert_eq!(parse_frames("1-48"), Ok((1, 48)));
        assert!(parse_frames("4-1").is_err() && parse_frames("x").is_err());
        assert!(parse_rate("0").is_err() && parse_rate("nan").is_err());
    }
}
