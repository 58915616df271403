//! Arguments of `render` and `merge`.

use super::parse::{parse_bits, parse_picture_format, parse_region};
use super::scene::{AcceleratorArgs, AnimationArgs, PictureArgs, PovArgs};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use strahl::Format;
use strahl::formats::image::{BitDepth, ImageFormat};
use strahl::tracing::{Region, TileOrder};
use strahl_farm::TilePlace;

#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    /// Scene file, or `-` for the standard input [default: a built-in demo scene]
    pub(crate) scene: Option<PathBuf>,
    /// Format of the scene, if the file name doesn't show it (see `strahl formats`)
    #[arg(long, visible_alias = "scene-format", value_name = "NAME")]
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
    /// Write grey values instead of colours (PNG, PPM)
    #[arg(long)]
    pub(crate) grayscale: bool,
    /// Quality of JPEG pictures, from 1 (smallest) to 100
    #[arg(long, value_name = "N", default_value_t = 85, value_parser = clap::value_parser!(u8).range(1..=100))]
    pub(crate) jpeg_quality: u8,
    /// Write an alpha channel, with a transparent background (PNG, TGA, EXR)
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
    /// Write grey values instead of colours (PNG, PPM)
    #[arg(long)]
    pub(crate) grayscale: bool,
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
