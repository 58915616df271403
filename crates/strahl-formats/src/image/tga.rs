//! Truevision TGA of 24 bit, or 32 with alpha: 8 bit sRGB, not compressed: some programs can't read runs that go on in the next row, as the encoder writes them.

use std::io::{self, Write};

use ::image::ExtendedColorType;
use ::image::codecs::tga::TgaEncoder;

use super::jpeg::io_error;
use super::png::{push_samples, push_straight};
use super::{BitDepth, Picture, WriteOptions};

pub(super) fn encode(
    writer: &mut dyn Write,
    picture: &Picture<'_>,
    options: &WriteOptions,
) -> io::Result<()> {
    let mut codes = Vec::with_capacity(4 * picture.rgb.len());
    let color = match picture.alpha {
        Some(alpha) => {
            // As in POV-Ray colours are straight, as in PNG.
            let options = WriteOptions {
                bit_depth: BitDepth::Eight,
                ..*options
            };
            push_straight(picture.rgb, alpha, &options, &mut codes);
            ExtendedColorType::Rgba8
        }
        None => {
            push_samples(picture.rgb.as_flattened(), BitDepth::Eight, &mut codes);
            ExtendedColorType::Rgb8
        }
    };
    let window = picture.window;
    TgaEncoder::new(writer)
        .disable_rle()
        .encode(&codes, window.width, window.height, color)
        .map_err(io_error)
}
