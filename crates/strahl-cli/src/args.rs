use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use strahl::accel::AcceleratorKind;
use strahl::formats::image::BitDepth;
use strahl::formats::scene::SceneFormat;
use strahl::shade::ShadingModel;
use strahl::tracing::{Region, Sampling, TileOrder};

/// Exact, explainable, reproducible recursive ray tracing.
#[derive(Debug, Parser)]
#[command(name = "strahl", version, arg_required_else_help = true)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render a scene to a picture
    Render(RenderArgs),
    /// Print the ray tree of a pixel: every ray with its numbers and the line of the scene that caused it
    Explain(ExplainArgs),
    /// Tell what is in a scene
    Info(SceneArgs),
    /// Look for errors in a scene without rendering it
    Check(SceneArgs),
    /// List the scene and picture formats
    Formats,
}

/// The scene and how it is read.
#[derive(Debug, Args)]
pub(crate) struct SceneArgs {
    /// Scene file, or `-` for the standard input
    pub(crate) scene: PathBuf,
    /// Format of the scene, if the file name doesn't tell (see `strahl formats`)
    #[arg(long, alias = "scene-format", value_name = "NAME")]
    pub(crate) format: Option<SceneFormat>,
}

/// What decides the value of a pixel.
#[derive(Debug, Args)]
pub(crate) struct PictureArgs {
    /// Size of the picture in pixels, such as 1280x720 [default: what the scene says, or 800x600]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<(u32, u32)>,
    /// Where rays go through a pixel: center (or none), NxN, adaptive, adaptive:THRESHOLD,PASSES, or corners
    #[arg(long, value_name = "HOW", default_value = "adaptive")]
    pub(crate) sampling: Sampling,
    /// Seed of the sampling
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Deepest level of the ray tree, the primary ray being level 1 [default: what the scene says, or 10]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) max_depth: Option<u32>,
    /// Do not follow rays of a smaller weight; 0 follows all [default: what the scene says, or 1/255]
    #[arg(long, value_name = "WEIGHT", value_parser = parse_weight)]
    pub(crate) adc_bailout: Option<f64>,
    /// Most rays of one tree, shadow rays not counted
    #[arg(long, value_name = "N", default_value_t = strahl::tracing::TraceSettings::MAX_TREE_RAYS)]
    pub(crate) max_tree_rays: u32,
    /// Shading model of everything: lambert, phong, blinn-phong, or to look at the geometry: normals, depth, object-id, uv
    #[arg(long, value_name = "MODEL")]
    pub(crate) shading: Option<ShadingModel>,
    /// Acceleration structure: list or bvh; the picture is the same
    #[arg(long, value_name = "NAME", default_value_t)]
    pub(crate) accelerator: AcceleratorKind,
}

#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Picture file (see `strahl formats`) [default: the scene's name with .png, in the current folder]
    #[arg(short, long, value_name = "PICTURE")]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    /// Render this part of the picture only: left, top, width, height in pixels
    #[arg(long, value_name = "X,Y,WxH", value_parser = parse_region)]
    pub(crate) region: Option<Region>,
    /// Number of threads; 0 takes one per processor
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) threads: usize,
    /// Order of the tiles; the picture is the same
    #[arg(long, value_enum, value_name = "ORDER", default_value_t = Order::Rows)]
    pub(crate) tile_order: Order,
    /// Bits per channel of PNG and PPM pictures
    #[arg(long, value_name = "8|16", default_value = "8", value_parser = parse_bits)]
    pub(crate) bit_depth: BitDepth,
    /// Write depth, normal, position, object, material, tree depth and tests per pixel too (EXR)
    #[arg(long)]
    pub(crate) layers: bool,
    /// Write what was done, counted and timed, as JSON
    #[arg(long, value_name = "FILE")]
    pub(crate) stats: Option<PathBuf>,
    /// Say nothing unless something is wrong
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Order {
    /// From the top left, row by row
    Rows,
    /// From the bottom right
    Reverse,
    /// From the centre outwards
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
pub(crate) struct ExplainArgs {
    /// Scene file, or `-` for the standard input
    pub(crate) scene: PathBuf,
    /// Format of the scene, if the file name doesn't tell (see `strahl formats`)
    #[arg(long, value_name = "NAME")]
    pub(crate) scene_format: Option<SceneFormat>,
    /// The pixel, counted from 0,0 at the top left
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel)]
    pub(crate) pixel: (u32, u32),
    /// How to print it
    #[arg(long, value_enum, value_name = "FORM", default_value_t = ExplainForm::Text)]
    pub(crate) format: ExplainForm,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExplainForm {
    /// For people
    Text,
    /// For programs; all numbers in full
    Json,
    /// For Graphviz
    Dot,
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

fn parse_weight(s: &str) -> Result<f64, String> {
    s.parse()
        .ok()
        .filter(|w| (0.0..=1.0).contains(w))
        .ok_or_else(|| "expected a number from 0 to 1".to_owned())
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
