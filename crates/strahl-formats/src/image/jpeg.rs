//! JPEG (ITU T.81, in a JFIF file): small files with lossy compression.

use std::io::{self, Write};

use ::image::ExtendedColorType;
use ::image::codecs::jpeg::{JpegEncoder, PixelDensity};

use super::png::push_samples;
use super::{BitDepth, Picture, WriteOptions};

pub(super) fn encode(
    writer: &mut dyn Write,
    picture: &Picture<'_>,
    options: &WriteOptions,
) -> io::Result<()> {
    let mut codes = Vec::with_capacity(3 * picture.rgb.len());
    push_samples(picture.rgb.as_flattened(), BitDepth::Eight, &mut codes);
    let mut encoder = JpegEncoder::new_with_quality(writer, options.jpeg_quality.clamp(1, 100));
    encoder.set_pixel_density(PixelDensity::dpi(72));
    let window = picture.window;
    encoder
        .encode(&codes, window.width, window.height, ExtendedColorType::Rgb8)
        .map_err(io_error)
}

/// The system's error behind an error of the encoder, if there is one.
pub(super) fn io_error(error: ::image::ImageError) -> io::Error {
    match error {
        ::image::ImageError::IoError(error) => error,
        other => io::Error::other(other),
    }
}
