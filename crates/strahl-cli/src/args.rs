use crate::explain::{Chosen, Digits, MostRays};
use crate::later::Later;
use crate::memory::MemoryLimit;
use crate::submit::SubmitCommand;
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use std::path::PathBuf;
use strahl::Format;
use strahl::accel::{AcceleratorKind, Bvh8Parameters, Level, Parameters, UnknownLevel};
use strahl::formats::image::{BitDepth, ImageFormat};
use strahl::geometry::SubdivisionScheme;
use strahl::sdl::{Limits, Word};
use strahl::shade::ShadingModel;
use strahl::tracing::{Region, Sampling, TileOrder};
use strahl_farm::TilePlace;

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
        /// The command
        command: Option<String>,
    },
}

/// The scene and how to read it.
#[derive(Debug, Args)]
pub(crate) struct SceneArgs {
    /// Scene file, or `-` for the standard input
    pub(crate) scene: PathBuf,
    /// Format of the scene, if the file name doesn't show it (see `strahl formats`)
    #[arg(long, alias = "scene-format", value_name = "NAME")]
    pub(crate) format: Option<Format>,
    #[command(flatten)]
    pub(crate) pov: PovArgs,
}

/// Options of scenes in POV-Ray's language.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "POV-Ray scenes")]
pub(crate) struct PovArgs {
    /// Also search include files in this folder, after the scene's folder and the current one; may be given several times
    #[arg(short = 'L', long, value_name = "DIR")]
    pub(crate) library_path: Vec<PathBuf>,
    /// Include this file before the scene begins
    #[arg(long, value_name = "FILE")]
    pub(crate) include: Option<PathBuf>,
    /// Declare a number before the scene begins; may be given several times
    #[arg(long, value_name = "NAME=VALUE", value_parser = parse_declaration)]
    pub(crate) declare: Vec<(String, f64)>,
    /// The value of `clock` [default: 0]
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    pub(crate) clock: Option<f64>,
    /// Let the scene write files into this folder instead of SCENE.out; only `render` writes files of scenes
    #[arg(long, value_name = "DIR")]
    pub(crate) allow_write: Option<PathBuf>,
    /// Change a limit on the resources of a scene, such as `steps=1e11`; error messages name the limits; may be given several
    /// times
    #[arg(long, value_name = "NAME=N", value_parser = parse_limit)]
    pub(crate) limit: Vec<(String, u64)>,
    /// Show the subdivision surfaces that the meshes of an OBJ, PLY, STL or glTF file control, met at their limit
    #[arg(long, value_name = "SCHEME", value_parser = parse_scheme, help_heading = "Meshes")]
    pub(crate) subdivide: Option<SubdivisionScheme>,
    /// Language version of scenes without `#version`, such as 3.7
    #[arg(long, value_name = "VERSION", value_parser = parse_version)]
    pub(crate) language_version: Option<f64>,
}

/// An animation: a scene rendered at several clocks.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Animation of POV-Ray scenes")]
pub(crate) struct AnimationArgs {
    /// Number of the first frame [default: 1]
    #[arg(long, value_name = "N")]
    pub(crate) initial_frame: Option<u32>,
    /// Number of the last frame; makes an animation with numbered pictures
    #[arg(long, value_name = "N")]
    pub(crate) final_frame: Option<u32>,
    /// The clock of the first frame
    #[arg(
        long,
        value_name = "T",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    pub(crate) initial_clock: f64,
    /// The clock of the last frame
    #[arg(
        long,
        value_name = "T",
        default_value_t = 1.0,
        allow_negative_numbers = true
    )]
    pub(crate) final_clock: f64,
    /// Make a loop: the final clock belongs to the frame after the last one, which would look like the first
    #[arg(long)]
    pub(crate) cyclic: bool,
    /// First frame to render; a number from 0.0 to below 1.0 is a fraction of all frames
    #[arg(long, value_name = "N")]
    pub(crate) subset_start_frame: Option<f64>,
    /// Last frame to render; a number from 0.0 to below 1.0 is a fraction of all frames
    #[arg(long, value_name = "N")]
    pub(crate) subset_end_frame: Option<f64>,
    /// Render every Nth frame only
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) frame_step: u32,
}

/// Options that affect the value of a pixel.
#[derive(Clone, Debug, Args)]
pub(crate) struct PictureArgs {
    /// Size of the picture in pixels, such as 1280x720 [default: the scene's size, or 800x600]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<(u32, u32)>,
    /// Positions of the rays in a pixel: center (or none), NxN, adaptive:THRESHOLD,DEPTH (+A0.3 +R3), recursive:THRESHOLD,DEPTH
    /// (+AM2), or corners [default: adaptive; for heat maps center]
    #[arg(long, value_name = "HOW")]
    pub(crate) sampling: Option<Sampling>,
    /// Seed of the random sampling
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Largest depth of the ray tree, where primary rays have depth 1 [default: the scene's depth, or 10]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) max_depth: Option<u32>,
    /// Do not follow rays with a weight below this; 0 follows all [default: the scene's value, or 1/255]
    #[arg(long, value_name = "WEIGHT", value_parser = parse_weight)]
    pub(crate) adc_bailout: Option<f64>,
    /// Largest number of rays in a ray tree, without shadow rays
    #[arg(long, value_name = "N", default_value_t = strahl::tracing::TraceSettings::MAX_TREE_RAYS)]
    pub(crate) max_tree_rays: u32,
    /// Trace every ray by itself, instead of in packets with those of neighbouring pixels; the picture is the same
    #[arg(long)]
    pub(crate) no_packets: bool,
    /// Shading model of all objects: lambert, phong or blinn-phong; or, to inspect the geometry, normals, depth, object-id or uv
    #[arg(long, value_name = "MODEL")]
    pub(crate) shading: Option<ShadingModel>,
}

/// The acceleration structure.
#[derive(Clone, Debug, Args)]
pub(crate) struct AcceleratorArgs {
    /// Acceleration structure with its parameters, such as bvh, grid:density=4 or octree:traversal=trial-plane (see
    /// `strahl formats`); the picture is the same
    #[arg(long, value_name = "NAME[:PARAMETER=VALUE,...]", default_value_t)]
    accelerator: AcceleratorKind,
    /// Vector instructions to use instead of the processor's best: scalar, sse4, avx2 or avx512; the picture is the same
    #[arg(long, value_name = "LEVEL", value_parser = parse_simd)]
    simd: Option<Level>,
}

impl AcceleratorArgs {
    /// The accelerator with the chosen instructions.
    pub(crate) fn kind(&self) -> AcceleratorKind {
        match self.simd {
            Some(level) => self.accelerator.with_simd(level),
            None => self.accelerator,
        }
    }
}

/// Parses an instruction set that this processor has.
fn parse_simd(text: &str) -> Result<Level, String> {
    let level: Level = text.parse().map_err(|e: UnknownLevel| e.to_string())?;
    Bvh8Parameters {
        simd: Some(level),
        ..Bvh8Parameters::DEFAULT
    }
    .check()?;
    Ok(level)
}

#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    /// Scene file, or `-` for the standard input [default: a built-in demo scene]
    pub(crate) scene: Option<PathBuf>,
    /// Format of the scene, if the file name doesn't show it (see `strahl formats`)
    #[arg(long, alias = "scene-format", value_name = "NAME")]
    pub(crate) format: Option<Format>,
    /// Picture file (see `strahl formats`), a folder for it, or `-` for the standard output [default: the scene's name with .png, in
    /// the current folder]
    #[arg(short, long, value_name = "PICTURE")]
    pub(crate) output: Option<PathBuf>,
    /// Format of the picture, if its file name doesn't show it [default: png]
    #[arg(long, value_name = "NAME", value_parser = parse_picture_format)]
    pub(crate) picture_format: Option<ImageFormat>,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    #[command(flatten)]
    pub(crate) accelerator: AcceleratorArgs,
    /// Render only this part of the picture: left, top, width, height in pixels
    #[arg(long, value_name = "X,Y,WxH", value_parser = parse_region)]
    pub(crate) region: Option<Region>,
    /// Render tile K of N and write it as an EXR file for `strahl merge`; all N are of about equal cost
    #[arg(long, value_name = "K/N", conflicts_with_all = ["region", "full_size", "resume"])]
    pub(crate) tile: Option<TilePlace>,
    /// With --region: write a picture of the full size, black outside of the region
    #[arg(long, requires = "region", conflicts_with = "layers")]
    pub(crate) full_size: bool,
    /// Number of threads, at most one per processor; 0 means one per processor
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) threads: usize,
    /// Order of the tiles; the picture is the same
    #[arg(long, value_enum, value_name = "ORDER", default_value_t = Order::Rows)]
    pub(crate) tile_order: Order,
    /// Bits per channel of PNG and PPM pictures
    #[arg(long, value_name = "8|16", default_value = "8", value_parser = parse_bits)]
    pub(crate) bit_depth: BitDepth,
    /// Quality of JPEG pictures, from 1 (smallest) to 100
    #[arg(long, value_name = "N", default_value_t = 85, value_parser = clap::value_parser!(u8).range(1..=100))]
    pub(crate) jpeg_quality: u8,
    /// Write an alpha channel, with a transparent background (PNG, EXR)
    #[arg(long)]
    pub(crate) alpha: bool,
    /// Also write depth, normal, position, object, material, tree depth and tests of each pixel (EXR)
    #[arg(long)]
    pub(crate) layers: bool,
    /// Write statistics (counts and times) as JSON; `-` is the standard output
    #[arg(long, value_name = "FILE")]
    pub(crate) stats: Option<PathBuf>,
    /// Tell what the time went into, by object, texture, light, ...: as a table, or as JSON in a file (`-` is the standard output)
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true)]
    #[expect(
        clippy::option_option,
        reason = "without a file the profile is a table on the terminal"
    )]
    pub(crate) profile: Option<Option<PathBuf>>,
    /// Render, but write no picture
    #[arg(long)]
    pub(crate) no_output: bool,
    /// Keep pictures that are complete, such as those of an interrupted animation
    #[arg(long)]
    pub(crate) resume: bool,
    /// Print only errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
    #[command(flatten)]
    pub(crate) pov: PovArgs,
    #[command(flatten)]
    pub(crate) animation: AnimationArgs,
    #[command(flatten)]
    pub(crate) job: JobArgs,
}

/// What tasks of a job tell `render`; users have no need of them.
#[derive(Debug, Default, Args)]
pub(crate) struct JobArgs {
    /// Read only the files of the bundle in this folder
    #[arg(long, value_name = "DIR", hide = true)]
    pub(crate) bundle: Option<PathBuf>,
    /// Render only if the scene has this identity
    #[arg(long, value_name = "SHA256", hide = true)]
    pub(crate) expect: Option<String>,
    /// Render only this frame of the animation
    #[arg(long, value_name = "N", hide = true)]
    pub(crate) only_frame: Option<u32>,
    /// The value of `now`, in days since the beginning of 2000
    #[arg(long, value_name = "DAYS", hide = true)]
    pub(crate) now: Option<f64>,
    /// The job that a tile belongs to
    #[arg(long, value_name = "ID", hide = true)]
    pub(crate) job_id: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct MergeArgs {
    /// The files of all tiles of a picture, in any order
    #[arg(required = true, value_name = "TILE")]
    pub(crate) tiles: Vec<PathBuf>,
    /// Picture file (see `strahl formats`), or `-` for the standard output
    #[arg(short, long, value_name = "PICTURE")]
    pub(crate) output: PathBuf,
    /// Format of the picture, if its file name doesn't show it [default: png]
    #[arg(long, value_name = "NAME", value_parser = parse_picture_format)]
    pub(crate) picture_format: Option<ImageFormat>,
    /// Bits per channel of PNG and PPM pictures
    #[arg(long, value_name = "8|16", default_value = "8", value_parser = parse_bits)]
    pub(crate) bit_depth: BitDepth,
    /// Quality of JPEG pictures, from 1 (smallest) to 100
    #[arg(long, value_name = "N", default_value_t = 85, value_parser = clap::value_parser!(u8).range(1..=100))]
    pub(crate) jpeg_quality: u8,
    /// Write statistics (size and SHA-256 of the film, sums of the counts of the tiles) as JSON; `-` is the standard output
    #[arg(long, value_name = "FILE")]
    pub(crate) stats: Option<PathBuf>,
    /// Print only errors
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Order {
    /// From the top left, row by row
    Rows,
    /// From the bottom right
    Reverse,
    /// From the centre outward
    Center,
}

impl From<Order> for TileOrder {
    fn from(order: Order) -> Self {
        match order {
            Order::Rows => Self::Rows,
            Order::Reverse => Self::Reverse,
            Order::Center => Self::Center,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// Scene files, or `-` for the standard input
    #[arg(required = true, value_name = "SCENE")]
    pub(crate) scenes: Vec<PathBuf>,
    /// Format of the scenes, if the file names don't show it (see `strahl formats`)
    #[arg(long, alias = "scene-format", value_name = "NAME")]
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
    #[arg(long, alias = "scene-format", value_name = "NAME")]
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

fn parse_pair(s: &str, separator: char) -> Option<(u32, u32)> {
    let (a, b) = s.split_once(separator)?;
    Some((a.trim().parse().ok()?, b.trim().parse().ok()?))
}

fn parse_size(s: &str) -> Result<(u32, u32), String> {
    parse_pair(s, 'x').ok_or_else(|| "expected WIDTHxHEIGHT in pixels, such as 1280x720".to_owned())
}

fn parse_pixel(s: &str) -> Result<(u32, u32), String> {
    parse_pair(s, ',').ok_or_else(|| "expected X,Y in pixels, such as 320,200".to_owned())
}

fn parse_region(s: &str) -> Result<Region, String> {
    let parsed = s.rsplit_once(',').and_then(|(position, size)| {
        let ((x, y), (width, height)) = (parse_pair(position, ',')?, parse_pair(size, 'x')?);
        Some(Region {
            x,
            y,
            width,
            height,
        })
    });
    parsed.ok_or_else(|| "expected X,Y,WIDTHxHEIGHT in pixels, such as 100,50,64x64".to_owned())
}

fn parse_positive(s: &str) -> Result<f64, String> {
    let number = s.parse().ok().filter(|x: &f64| *x > 0.0 && x.is_finite());
    number.ok_or_else(|| "expected a number above 0".to_owned())
}

fn parse_weight(s: &str) -> Result<f64, String> {
    s.parse()
        .ok()
        .filter(|w| (0.0..=1.0).contains(w))
        .ok_or_else(|| "expected a number from 0 to 1".to_owned())
}

fn parse_declaration(s: &str) -> Result<(String, f64), String> {
    let (name, value) = s
        .split_once('=')
        .ok_or_else(|| "expected NAME=VALUE, such as Detail=2".to_owned())?;
    let (name, value) = (name.trim(), value.trim());
    let mut letters = name.chars();
    let starts = letters
        .next()
        .is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
    if !starts || !letters.all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return Err(format!(
            "`{name}` is not an identifier: use letters, digits and `_`, and no digit first"
        ));
    }
    if Word::ALL.iter().any(|(_, word, _)| *word == name) {
        return Err(format!(
            "`{name}` is a keyword of the language; use a name that begins with a capital letter"
        ));
    }
    let number = value.parse().ok().filter(|v: &f64| v.is_finite());
    number.map(|v| (name.to_owned(), v)).ok_or_else(|| {
        format!("`{value}` is not a number: only numbers can be declared here, such as {name}=2.5")
    })
}

fn parse_scheme(s: &str) -> Result<SubdivisionScheme, String> {
    match s {
        "catmull-clark" => Ok(SubdivisionScheme::CatmullClark),
        "loop" => Ok(SubdivisionScheme::Loop),
        _ => Err("the schemes are `catmull-clark` and `loop`".to_owned()),
    }
}

fn parse_limit(s: &str) -> Result<(String, u64), String> {
    let (name, value) = s
        .split_once('=')
        .ok_or_else(|| "expected NAME=N, such as steps=1e11".to_owned())?;
    let number = value.parse::<f64>().ok().filter(|v| *v >= 0.0 && *v < 1e18);
    let number = number.ok_or_else(|| format!("`{value}` is not a number from 0 to 1e18"))?;
    if !Limits::default().set(name, number as u64) {
        let known = Limits::NAMES.join(", ");
        return Err(format!(
            "there is no limit `{name}`; the limits are {known}"
        ));
    }
    Ok((name.to_owned(), number as u64))
}

fn parse_version(s: &str) -> Result<f64, String> {
    s.parse()
        .ok()
        .filter(|v| (1.0..4.0).contains(v))
        .ok_or_else(|| "expected a version from 1.0 to 3.8, such as 3.7".to_owned())
}

fn parse_picture_format(s: &str) -> Result<ImageFormat, String> {
    ImageFormat::from_name(s).ok_or_else(|| {
        let names = strahl::formats::image::formats().iter();
        let names: Vec<&str> = names.map(|info| info.extensions[0]).collect();
        format!("expected one of {}", names.join(", "))
    })
}

fn parse_bits(s: &str) -> Result<BitDepth, String> {
    match s {
        "8" => Ok(BitDepth::Eight),
        "16" => Ok(BitDepth::Sixteen),
        _ => Err("expected 8 or 16".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn declarations_are_numbers_with_names_of_their_own() {
        assert_eq!(parse_declaration("A_1 = -2.5"), Ok(("A_1".into(), -2.5)));
        for bad in ["A", "1A=1", "=1", "sphere=1", "A=red", "A=inf", "A-B=1"] {
            assert!(parse_declaration(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn regions_and_sizes() {
        assert_eq!(
            parse_region("100,50,64x32"),
            Ok(Region {
                x: 100,
                y: 50,
                width: 64,
                height: 32
            })
        );
        assert!(
            parse_region("100,50").is_err()
                && parse_size("12").is_err()
                && parse_pixel("1x2").is_err()
        );
        assert!(
            parse_weight("-0.1").is_err()
                && parse_weight("nan").is_err()
                && parse_bits("12").is_err()
        );
    }
}
