//! Portable Network Graphics (W3C PNG, third edition): 8 or 16 bit sRGB.

use std::io::{self, Write};

use ::png::chunk::ChunkType;
use ::png::{ColorType, DeflateCompression, Encoder, EncodingError, SrgbRenderingIntent};
use strahl_shade::srgb;

use super::{BitDepth, Picture, WriteOptions};

/// Offset of the picture on a page, a chunk of the PNG extensions 1.5: a region's place in the full picture.
const OFFSET_CHUNK: ChunkType = ChunkType(*b"oFFs");

/// The level of deflate, `1..=9`. Level 2 takes a third of the time of zlib's default, 6; grainy pictures grow by a tenth, clean ones
/// by a quarter.
const COMPRESSION: u8 = 2;

pub(super) fn encode(
    writer: &mut dyn Write,
    picture: &Picture<'_>,
    options: &WriteOptions,
) -> io::Result<()> {
    encode_png(writer, picture, options).map_err(|error| match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    })
}

fn encode_png(
    writer: &mut dyn Write,
    picture: &Picture<'_>,
    options: &WriteOptions,
) -> Result<(), EncodingError> {
    let window = picture.window;
    let mut encoder = Encoder::new(writer, window.width, window.height);
    encoder.set_color(match (options.grayscale, picture.alpha) {
        (false, None) => ColorType::Rgb,
        (false, Some(_)) => ColorType::Rgba,
        (true, None) => ColorType::Grayscale,
        (true, Some(_)) => ColorType::GrayscaleAlpha,
    });
    encoder.set_depth(match options.bit_depth {
        BitDepth::Eight => ::png::BitDepth::Eight,
        BitDepth::Sixteen => ::png::BitDepth::Sixteen,
    });
    encoder.set_deflate_compression(DeflateCompression::Level(COMPRESSION));
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    for (key, value) in picture.metadata_with_region() {
        let keyword = keyword(key);
        if value.is_ascii() {
            encoder.add_text_chunk(keyword, value)?;
        } else {
            encoder.add_itxt_chunk(keyword, value)?;
        }
    }
    let mut writer = encoder.write_header()?;
    if picture.is_region() {
        let mut offset = Vec::with_capacity(9);
        offset.extend(window.x.to_be_bytes());
        offset.extend(window.y.to_be_bytes());
        offset.push(0); // in pixels
        writer.write_chunk(OFFSET_CHUNK, &offset)?;
    }

    let width = window.width as usize;
    let push_row = |y: usize, row: &[[f32; 3]], codes: &mut Vec<u8>| match picture.alpha {
        Some(alpha) => push_straight(row, &alpha[y * width..], options, codes),
        None => push_codes(row, options, codes),
    };
    let rows = picture.rgb.chunks_exact(width).enumerate();
    let mut codes = Vec::new();
    // Row by row: the codes of a large picture need no memory of their own.
    let mut out = writer.stream_writer()?;
    for (y, row) in rows {
        codes.clear();
        push_row(y, row, &mut codes);
        out.write_all(&codes)?;
    }
    out.finish()?;
    writer.finish()
}

/// Appends the sRGB codes of pixels, those of 16 bit with the high byte first, as PNG and PPM store them.
pub(super) fn push_codes(pixels: &[[f32; 3]], options: &WriteOptions, codes: &mut Vec<u8>) {
    if options.grayscale {
        let greys: Vec<f32> = pixels.iter().copied().map(grey).collect();
        push_samples(&greys, options.bit_depth, codes);
    } else {
        push_samples(pixels.as_flattened(), options.bit_depth, codes);
    }
}

/// The grey value of a colour. The weights are those of POV-Ray, measured.
fn grey([red, green, blue]: [f32; 3]) -> f32 {
    0.297 * red + 0.589 * green + 0.114 * blue
}

/// Appends the codes of samples.
pub(super) fn push_samples(samples: &[f32], depth: BitDepth, codes: &mut Vec<u8>) {
    match depth {
        BitDepth::Eight => srgb::push_u8(samples, codes),
        BitDepth::Sixteen => codes.extend(
            samples
                .iter()
                .flat_map(|&sample| srgb::encode_u16(f64::from(sample)).to_be_bytes()),
        ),
    }
}

/// Appends the codes of pixels with alpha. In PNG, colours are straight: not multiplied by alpha.
pub(super) fn push_straight(
    pixels: &[[f32; 3]],
    alpha: &[f32],
    options: &WriteOptions,
    codes: &mut Vec<u8>,
) {
    for (pixel, alpha) in pixels.iter().zip(alpha) {
        let straight = pixel.map(|x| if *alpha > 0.0 { x / alpha } else { 0.0 });
        push_codes(&[straight], options, codes);
        let alpha = f64::from(alpha.clamp(0.0, 1.0));
        match options.bit_depth {
            BitDepth::Eight => codes.push((alpha * 255.0 + 0.5) as u8),
            BitDepth::Sixteen => codes.extend(((alpha * 65535.0 + 0.5) as u16).to_be_bytes()),
        }
    }
}

/// PNG's registered keywords are capitalised.
fn keyword(key: &str) -> String {
    const REGISTERED: [&str; 9] = [
        "Title",
        "Author",
        "Description",
        "Copyright",
        "Software",
        "Disclaimer",
        "Warning",
        "Source",
        "Comment",
    ];
    REGISTERED
        .into_iter()
        .find(|registered| registered.eq_ignore_ascii_case(key))
        .unwrap_or(key)
        .to_owned()
}
