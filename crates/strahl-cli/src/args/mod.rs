//! The command line: commands and their arguments.

mod parse;
mod questions;
mod render;
mod scene;
pub(crate) mod submit;
mod tips;

pub(crate) use questions::*;
pub(crate) use render::*;
pub(crate) use scene::*;
pub(crate) use tips::explained;

use crate::later::Later;
use crate::memory::MemoryLimit;
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use submit::SubmitCommand;

/// Exact, explainable, reproducible recursive ray tracing.
#[derive(Debug, Parser)]
#[command(
    name = "strahl",
    version,
    long_version = env!("STRAHL_BUILD"),
    arg_required_else_help = true,
    after_help = "`strahl scene.pov` and POV-Ray's command lines, such as `strahl +Iscene.pov +W640 +H480`, work without `render`."
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
    #[command(flatten)]
    pub(crate) guard: GuardArgs,
}

/// Options that protect the machine and the user.
#[derive(Debug, Args)]
pub(crate) struct GuardArgs {
    /// Largest memory to use, such as 500M, 8G or 50% of the machine's; `none` for no limit
    #[arg(
        long,
        global = true,
        value_name = "BYTES",
        default_value = "90%",
        help_heading = "Safety"
    )]
    pub(crate) max_memory: MemoryLimit,
    /// Treat warnings and unsupported features as errors, and end with exit code 3
    #[arg(long, global = true, help_heading = "Safety")]
    pub(crate) strict: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene to a picture
    #[command(args_override_self = true)]
    Render(Box<RenderArgs>),
    /// Show a scene in the browser: the picture while it is rendered, and the ray tree of every pixel that is clicked
    View(Later<Box<ViewArgs>>),
    /// Print the ray tree of a pixel: every ray with its numbers and the line of the scene that caused it
    Explain(Later<ExplainArgs>),
    /// Render with every accelerator: prints a table of their costs, and checks that the pictures are the same
    Compare(Later<CompareArgs>),
    /// Draw the cost of each pixel
    Heatmap(Later<HeatmapArgs>),
    /// Follow the ray of a pixel through an accelerator: every cell, sphere or node with its tests
    TraceRay(Later<TraceRayArgs>),
    /// Put the tiles of a picture together
    Merge(Later<MergeArgs>),
    /// Give a picture or a film to a cluster or render farm
    #[command(subcommand)]
    Submit(SubmitCommand),
    /// Print the contents of a scene: objects, bounds, lights, camera, memory
    Info(Later<SceneArgs>),
    /// Look for errors in a scene without rendering it
    Check(Later<CheckArgs>),
    /// List scene formats, picture formats and accelerators
    Formats,
    /// Print a completion script for a shell: `strahl completions bash > ~/.local/share/bash-completion/completions/strahl`
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the manual page of strahl, or of a command: `strahl man render | man -l -`
    Man {
        /// The command, such as render or submit slurm
        command: Vec<String>,
    },
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
