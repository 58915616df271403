//! Arguments of the commands that ask about a scene.

use super::parse::{parse_pixel, parse_positive, parse_size};
use super::scene::{AcceleratorArgs, PictureArgs, PovArgs, SceneArgs};
use crate::explain::{Chosen, Digits, MostRays};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use strahl::Format;
use strahl::accel::AcceleratorKind;

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// Scene files, or `-` for the standard input
    #[arg(required = true, value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,
    /// Format of the scenes, if the file names don't show it (see `strahl formats`)
    #[arg(long, visible_alias = "scene-format", value_name = "NAME")]
    pub(crate) format: Option<Format>,
    /// Print JSON: one object with all diagnostics for each scene
    #[arg(long)]
    pub(crate) json: bool,
    /// Check only the text, not whether the scene can be rendered
    #[arg(long)]
    pub(crate) syntax: bool,
    #[command(flatten)]
    pub(crate) pov: PovArgs,
}

#[derive(Debug, Args)]
pub(crate) struct ExplainArgs {
    /// Scene file, or `-` for the standard input
    pub(crate) scene: PathBuf,
    /// Format of the scene, if the file name doesn't show it (see `strahl formats`)
    #[arg(long, value_name = "NAME")]
    pub(crate) scene_format: Option<Format>,
    /// The pixel, counted from 0,0 at the top left; `--format html` without it makes a page of the whole picture
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel)]
    pub(crate) pixel: Option<(u32, u32)>,
    /// Number of pixels with their trees in the page of a whole picture
    #[arg(long, value_name = "N", default_value_t = strahl_view::USUAL_TREES, conflicts_with = "pixel")]
    pub(crate) trees: usize,
    /// Form of the output
    #[arg(long, value_enum, value_name = "FORM", default_value_t = ExplainForm::Text)]
    pub(crate) format: ExplainForm,
    /// Significant digits of numbers in text and graph, or `full` for enough digits to read back the same bits; JSON is always
    /// exact
    #[arg(long, value_name = "N|full", default_value = "6")]
    pub(crate) digits: Digits,
    /// Show the tree of this sample, counted from 1, or of `all`, if a pixel has several [default: a table of the samples in
    /// text, all in JSON, the first in the graph]
    #[arg(long, value_name = "N|all")]
    pub(crate) sample: Option<Chosen>,
    /// Largest number of rays shown in text, those that add most to the pixel with the rays that lead to them, or `all`
    #[arg(long, value_name = "N|all", default_value = "40")]
    pub(crate) rays: MostRays,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) accelerator: AcceleratorArgs,
    #[command(flatten)]
    pub(crate) pov: PovArgs,
}

#[derive(Clone, Debug, Args)]
pub(crate) struct ViewArgs {
    /// Scene file [default: a choice of the scenes that are built in]
    pub(crate) scene: Option<PathBuf>,
    /// Format of the scene, if the file name doesn't show it (see `strahl formats`)
    #[arg(long, visible_alias = "scene-format", value_name = "NAME")]
    pub(crate) format: Option<Format>,
    /// Port on 127.0.0.1; 0 takes a free one
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) port: u16,
    /// Open the page in the browser
    #[arg(long)]
    pub(crate) open: bool,
    /// Let the page write the scene's files
    #[arg(long)]
    pub(crate) edit: bool,
    /// Program that opens a line of the scene, with {file} and {line} in its arguments; without them it gets `+LINE FILE`
    #[arg(long, value_name = "COMMAND")]
    pub(crate) editor: Option<String>,
    /// Number of threads, at most one per processor; 0 means one per processor
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) threads: usize,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) accelerator: AcceleratorArgs,
    #[command(flatten)]
    pub(crate) pov: PovArgs,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExplainForm {
    /// Text for people
    Text,
    /// JSON for programs; all numbers are exact
    Json,
    /// A graph for Graphviz
    Dot,
    /// A page for browsers, with everything in it
    Html,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    /// Accelerator to compare; may be given several times [default: all, the octree with each of its traversals]
    #[arg(long = "with", value_name = "NAME[:PARAMETER=VALUE,...]")]
    pub(crate) with: Vec<AcceleratorKind>,
    /// Number of threads; 0 means one per processor
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) threads: usize,
    /// Number of runs of each accelerator, in turns; the median time counts
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=99))]
    pub(crate) runs: u32,
    /// Search the whole scene for every shadow ray, as published figures do, instead of first testing the last object that
    /// blocked this light
    #[arg(long)]
    pub(crate) no_shadow_cache: bool,
    /// Print JSON
    #[arg(long, conflicts_with = "csv")]
    pub(crate) json: bool,
    /// Print comma-separated values
    #[arg(long)]
    pub(crate) csv: bool,
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
}

#[derive(Debug, Args)]
pub(crate) struct HeatmapArgs {
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) accelerator: AcceleratorArgs,
    /// Cost to draw
    #[arg(long, value_enum, value_name = "METRIC", default_value_t = Metric::Tests)]
    pub(crate) metric: Metric,
    /// Value of the brightest colour, for comparing pictures; larger values get the same colour [default: the largest value of
    /// all but one in a thousand pixels]
    #[arg(long, value_name = "MAX", value_parser = parse_positive)]
    pub(crate) scale: Option<f64>,
    /// Picture file; an EXR file also has the values as the layer `cost`
    #[arg(short, long, value_name = "PICTURE")]
    pub(crate) output: PathBuf,
    /// Number of threads; 0 means one per processor
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) threads: usize,
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
}

/// A cost of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Metric {
    /// Primitives tested
    Tests,
    /// Nodes and cells visited
    Steps,
    /// Microseconds
    Time,
    /// Levels of the ray tree
    Depth,
    /// Rays, shadow rays included
    Rays,
}

#[derive(Debug, Args)]
pub(crate) struct TraceRayArgs {
    /// The pixel, counted from 0,0 at the top left; the ray goes through its centre
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel)]
    pub(crate) pixel: (u32, u32),
    /// Size of the picture in pixels, such as 1280x720 [default: the scene's size, or 800x600]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<(u32, u32)>,
    #[command(flatten)]
    pub(crate) accelerator: AcceleratorArgs,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
}
