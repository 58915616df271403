//! Windows bitmaps: 8 bit sRGB, uncompressed.

use std::io::{self, Write};

use ::image::ExtendedColorType;
use ::image::codecs::bmp::BmpEncoder;

use super::jpeg::io_error;
use super::png::push_samples;
use super::{BitDepth, Picture, WriteOptions};

pub(super) fn encode(
    mut writer: &mut dyn Write,
    picture: &Picture<'_>,
    _options: &WriteOptions,
) -> io::Result<()> {
    let mut codes = Vec::with_capacity(3 * picture.rgb.len());
    push_samples(picture.rgb.as_flattened(), BitDepth::Eight, &mut codes);
    let window = picture.window;
    BmpEncoder::new(&mut writer)
        .encode(&codes, window.width, window.height, ExtendedColorType::Rgb8)
        .map_err(io_error)
}
