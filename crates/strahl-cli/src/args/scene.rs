//! What all commands that read a scene take.

use super::parse::{parse_declaration, parse_limit, parse_size, parse_version, parse_weight};
use clap::Args;
use std::path::PathBuf;
use strahl::Format;
use strahl::SubdivideOptions;
use strahl::accel::{AcceleratorKind, Bvh8Parameters, Level, Parameters, UnknownLevel};
use strahl::shade::{Quality, ShadingModel};
use strahl::tracing::Sampling;

/// The scene and how to read it.
#[derive(Debug, Args)]
pub(crate) struct SceneArgs {
    /// Scene file, or `-` for the standard input
    pub(crate) scene: PathBuf,
    /// Format of the scene, if the file name doesn't show it (see `strahl formats`)
    #[arg(long, visible_alias = "scene-format", value_name = "NAME")]
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
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub(crate) clock: Option<f64>,
    /// Let the scene write files into this folder instead of SCENE.out; only `render` writes files of scenes
    #[arg(long, value_name = "DIR")]
    pub(crate) allow_write: Option<PathBuf>,
    /// Change a limit on the resources of a scene, such as `steps=1e11`; error messages name the limits; may be given several
    /// times
    #[arg(long, value_name = "NAME=N", value_parser = parse_limit)]
    pub(crate) limit: Vec<(String, u64)>,
    /// Show the subdivision surfaces that the meshes of an OBJ, PLY, STL or glTF file control, met at their limit: `catmull-clark` or
    /// `loop`; with `:crease=DEGREES` edges are sharp where faces meet at more than this angle
    #[arg(long, value_name = "SCHEME", help_heading = "Meshes")]
    pub(crate) subdivide: Option<SubdivideOptions>,
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
        allow_hyphen_values = true
    )]
    pub(crate) initial_clock: f64,
    /// The clock of the last frame
    #[arg(
        long,
        value_name = "T",
        default_value_t = 1.0,
        allow_hyphen_values = true
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
    #[arg(long, alias = "depth", value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
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
    /// How much the picture shows, as with +Q of POV-Ray: from 2 ambient and diffuse light and highlights, from 4 shadows, from 5 those of area lights,
    /// from 6 pigments without quick_color and transparency, from 8 reflection and normals, from 9 everything [default: 9]
    #[arg(long, value_name = "N")]
    pub(crate) quality: Option<Quality>,
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
