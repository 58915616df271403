//! Truevision TGA of 24 bit: 8 bit sRGB, not compressed: some programs can't read runs that go on in the next row, as the encoder writes them.

use std::io::{self, Write};

use ::image::ExtendedColorType;
use ::image::codecs::tga::TgaEncoder;

use super::jpeg::io_error;
use super::png::push_samples;
use super::{BitDepth, Picture, WriteOptions};

pub(super) fn encode(
    writer: &mut dyn Write,
    picture: &Picture<'_>,
    _options: &WriteOptions,
) -> io::Result<()> {
    let mut codes = Vec::with_capacity(3 * picture.rgb.len());
    push_samples(picture.rgb.as_flattened(), BitDepth::Eight, &mut codes);
    let window = picture.window;
    TgaEncoder::new(writer)
        .disable_rle()
        .encode(&codes, window.width, window.height, ExtendedColorType::Rgb8)
        .map_err(io_error)
}
