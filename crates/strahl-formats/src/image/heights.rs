//! Picture files as height fields: the height of each pixel, as POV-Ray computes it.

use std::io::Cursor;

use ::image::codecs::bmp::BmpDecoder;
use ::image::{DynamicImage, ImageDecoder, ImageFormat as FileFormat};

use super::ImageError;
use super::texture::{check_size, decode_error, open_picture};

/// A grid of heights, row by row from the top; 65535 is white, full scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Heights {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` heights.
    pub values: Vec<u16>,
    /// Whether the picture is of greys, so that heights are brightness.
    pub gray: bool,
}

/// The texels of a picture with a palette.
#[derive(Clone, Debug, PartialEq)]
pub struct PaletteIndices {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` positions in the palette, row by row from the top.
    pub indices: Vec<u8>,
    /// Number of colours in the palette.
    pub colors: usize,
}

/// Reads the indices of a PNG, GIF (the first picture) or BMP file; `None` if the picture has no palette.
pub fn decode_indices(bytes: &[u8], name: &str) -> Result<Option<PaletteIndices>, ImageError> {
    match open_picture(bytes, name)?.format() {
        Some(FileFormat::Png) => png_indices(bytes, name),
        Some(FileFormat::Gif) => gif_indices(bytes, name),
        Some(FileFormat::Bmp) => bmp_indices(bytes, name),
        _ => Ok(None),
    }
}

/// Reads the heights of a picture: PNG, JPEG, HDR, TIFF, TGA, BMP, GIF (the first picture) or PNM.
///
/// The height of a pixel depends on the kind of picture, as in POV-Ray 3.7 (measured): for pictures with a palette it is the
/// index, times 256; for greys the value, 8 bits times 257; for 8-bit colours, and floating-point numbers, red is the high and
/// green the low byte; for 16-bit colours it is the brightness. Alpha is ignored.
pub fn decode_heights(bytes: &[u8], name: &str) -> Result<Heights, ImageError> {
    if let Some(indexed) = decode_indices(bytes, name)? {
        let values = indexed.indices.into_iter();
        return Ok(Heights {
            width: indexed.width,
            height: indexed.height,
            values: values.map(|index| two_bytes(index, 0)).collect(),
            gray: false,
        });
    }
    let picture = decode(bytes, name)?;
    let (width, height) = (picture.width(), picture.height());
    let (values, gray) = match picture {
        DynamicImage::ImageLuma8(p) => (p.iter().map(|&v| u16::from(v) * 257).collect(), true),
        DynamicImage::ImageLumaA8(p) => (p.pixels().map(|p| u16::from(p[0]) * 257).collect(), true),
        DynamicImage::ImageLuma16(p) => (p.into_raw(), true),
        DynamicImage::ImageLumaA16(p) => (p.pixels().map(|p| p[0]).collect(), true),
        DynamicImage::ImageRgb8(p) => (
            p.pixels().map(|p| two_bytes(p.0[0], p.0[1])).collect(),
            false,
        ),
        DynamicImage::ImageRgba8(p) => (
            p.pixels().map(|p| two_bytes(p.0[0], p.0[1])).collect(),
            false,
        ),
        DynamicImage::ImageRgb32F(p) => (p.pixels().map(|p| float_bytes(p.0)).collect(), false),
        other => {
            let picture = other.into_rgb32f();
            let gray = |p: [f32; 3]| brightness(p.map(f64::from));
            (picture.pixels().map(|p| gray(p.0)).collect(), false)
        }
    };
    Ok(Heights {
        width,
        height,
        values,
        gray,
    })
}

fn decode(bytes: &[u8], name: &str) -> Result<DynamicImage, ImageError> {
    let decoder = open_picture(bytes, name)?
        .into_decoder()
        .map_err(|error| decode_error(name, error))?;
    let (width, height) = decoder.dimensions();
    let texel = u64::from(decoder.color_type().bytes_per_pixel());
    check_size(name, width.into(), height.into(), texel)?;
    DynamicImage::from_decoder(decoder).map_err(|error| decode_error(name, error))
}

/// The numbers that a picture has instead of colours.
#[derive(Clone, Debug, PartialEq)]
pub struct TexelNumbers {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` numbers, row by row from the top.
    pub numbers: Vec<u8>,
}

/// Reads the numbers of a picture's texels, by which `material_map` selects textures, in the formats of [`decode_heights`].
///
/// As in POV-Ray 3.7 (measured) the number is the index in the palette, if there is one, and else red from 0 to 255, truncated; grey of 8 bits
/// is weighted like a colour first, in numbers of 32 bits, so that 84 of the 256 greys are one less.
pub fn decode_numbers(bytes: &[u8], name: &str) -> Result<TexelNumbers, ImageError> {
    if let Some(PaletteIndices {
        width,
        height,
        indices,
        ..
    }) = decode_indices(bytes, name)?
    {
        return Ok(TexelNumbers {
            width,
            height,
            numbers: indices,
        });
    }
    let picture = decode(bytes, name)?;
    let weighted = |v: &u8| {
        let gray = f32::from(*v) / 255.0;
        ((0.297 * gray + 0.589 * gray + 0.114 * gray) * 255.0) as u8
    };
    let reduced = |v: u16| (u32::from(v) * 255 / 65535) as u8;
    let (width, height) = (picture.width(), picture.height());
    let numbers = match picture {
        DynamicImage::ImageLuma8(p) => p.iter().map(weighted).collect(),
        DynamicImage::ImageLumaA8(p) => p.pixels().map(|p| p[0]).collect(),
        DynamicImage::ImageLuma16(p) => p.iter().map(|v| reduced(*v)).collect(),
        DynamicImage::ImageLumaA16(p) => p.pixels().map(|p| reduced(p[0])).collect(),
        DynamicImage::ImageRgb8(p) => p.pixels().map(|p| p[0]).collect(),
        DynamicImage::ImageRgba8(p) => p.pixels().map(|p| p[0]).collect(),
        other => {
            let picture = other.into_rgb32f();
            // The cast saturates and turns NaN into 0. A whole code must not become smaller by rounding.
            let red = |r: f32| (f64::from(r) * 255.0 + 1e-3) as u8;
            picture.pixels().map(|p| red(p.0[0])).collect()
        }
    };
    Ok(TexelNumbers {
        width,
        height,
        numbers,
    })
}

fn two_bytes(high: u8, low: u8) -> u16 {
    u16::from_be_bytes([high, low])
}

/// The height of a floating-point colour: red is the high byte and green the low one, and both may have fractions.
fn float_bytes([r, g, _]: [f32; 3]) -> u16 {
    // The cast saturates and turns NaN into 0.
    (f64::from(r) * (255.0 * 256.0) + f64::from(g) * 255.0) as u16
}

/// The height of a colour of components from 0 to 1.
fn brightness([r, g, b]: [f64; 3]) -> u16 {
    // The cast truncates and turns NaN into 0. A whole code must not become smaller by rounding.
    ((0.297 * r + 0.589 * g + 0.114 * b) * 65535.0 + 1e-3) as u16
}

/// The indices of a PNG file, if it has a palette.
fn png_indices(bytes: &[u8], name: &str) -> Result<Option<PaletteIndices>, ImageError> {
    let failed = |error: ::png::DecodingError| decode_error(name, error);
    let mut decoder = ::png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(::png::Transformations::IDENTITY);
    let header = decoder.read_header_info().map_err(failed)?;
    if header.color_type != ::png::ColorType::Indexed {
        return Ok(None);
    }
    let (width, height, depth) = (header.width, header.height, header.bit_depth as u8);
    check_size(name, width.into(), height.into(), 1)?;
    let mut reader = decoder.read_info().map_err(failed)?;
    let palette = reader.info().palette.as_ref();
    let colors = palette.map_or(0, |palette| palette.len() / 3);
    let size = reader.output_buffer_size().unwrap_or(0);
    let mut packed = vec![0; size];
    let info = reader.next_frame(&mut packed).map_err(failed)?;
    let per_byte = usize::from(8 / depth.clamp(1, 8));
    let rows = packed.chunks(info.line_size.max(1)).take(height as usize);
    let indices = rows.flat_map(|row| {
        let index = move |x: usize| {
            let shift = 8 - depth as usize * (x % per_byte + 1);
            let byte = row.get(x / per_byte).copied().unwrap_or(0);
            byte >> shift & (u8::MAX >> (8 - depth))
        };
        (0..width as usize).map(index)
    });
    Ok(Some(PaletteIndices {
        width,
        height,
        indices: indices.collect(),
        colors,
    }))
}

/// The indices of the first picture of a GIF file, on a screen of index 0.
fn gif_indices(bytes: &[u8], name: &str) -> Result<Option<PaletteIndices>, ImageError> {
    let failed = |error: ::gif::DecodingError| decode_error(name, error);
    let mut options = ::gif::DecodeOptions::new();
    options.set_color_output(::gif::ColorOutput::Indexed);
    let mut reader = options.read_info(Cursor::new(bytes)).map_err(failed)?;
    let (width, height) = (reader.width(), reader.height());
    let mut screen = vec![0; usize::from(width) * usize::from(height)];
    let global = reader
        .global_palette()
        .map_or(0, |palette| palette.len() / 3);
    let frame = reader
        .read_next_frame()
        .map_err(failed)?
        .ok_or_else(|| decode_error(name, "it has no picture"))?;
    let own = frame.palette.as_ref();
    let colors = own.map_or(global, |palette| palette.len() / 3);
    let rows = frame.buffer.chunks(usize::from(frame.width).max(1));
    let left = usize::from(frame.left).min(usize::from(width));
    for (y, row) in rows.enumerate() {
        let start = (usize::from(frame.top) + y) * usize::from(width) + left;
        let room = (usize::from(width) - left).min(row.len());
        if let Some(place) = screen.get_mut(start..start + room) {
            place.copy_from_slice(&row[..room]);
        }
    }
    Ok(Some(PaletteIndices {
        width: width.into(),
        height: height.into(),
        indices: screen,
        colors,
    }))
}

/// The indices of a BMP file, if it has a palette.
fn bmp_indices(bytes: &[u8], name: &str) -> Result<Option<PaletteIndices>, ImageError> {
    let failed = |error: ::image::ImageError| decode_error(name, error);
    let mut decoder = BmpDecoder::new(Cursor::new(bytes)).map_err(failed)?;
    let Some(palette) = decoder.get_palette().map(<[_]>::len) else {
        return Ok(None);
    };
    // The decoder fills the palette up with black; the header has the number of its colours, 0 for all.
    let said = bytes.get(46..50).and_then(|said| said.try_into().ok());
    let colors = match said.map(u32::from_le_bytes) {
        Some(said @ 1..=255) => palette.min(said as usize),
        _ => palette,
    };
    decoder.set_indexed_color(true);
    let (width, height) = decoder.dimensions();
    check_size(name, width.into(), height.into(), 1)?;
    let mut indices = vec![0; decoder.total_bytes() as usize];
    decoder.read_image(&mut indices).map_err(failed)?;
    Ok(Some(PaletteIndices {
        width,
        height,
        indices,
        colors,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PNG_16: ::png::BitDepth = ::png::BitDepth::Sixteen;

    fn png(color: ::png::ColorType, depth: ::png::BitDepth, width: u32, data: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut bytes, width, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if color == ::png::ColorType::Indexed {
            encoder.set_palette(vec![200; 48]);
        }
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(data).unwrap();
        writer.finish().unwrap();
        bytes
    }

    fn heights(bytes: &[u8]) -> Vec<u16> {
        decode_heights(bytes, "test").unwrap().values
    }

    #[test]
    fn pixels_are_worth_what_they_are_in_povray() {
        use ::png::{BitDepth, ColorType};
        let eight = BitDepth::Eight;
        assert_eq!(
            heights(&png(ColorType::Grayscale, eight, 2, &[10, 255])),
            [2570, 65535]
        );
        assert_eq!(
            heights(&png(ColorType::Grayscale, PNG_16, 1, &[7, 8])),
            [7 * 256 + 8]
        );
        assert_eq!(
            heights(&png(ColorType::Rgb, eight, 1, &[10, 70, 130])),
            [10 * 256 + 70]
        );
        assert_eq!(
            heights(&png(ColorType::Rgba, eight, 1, &[10, 70, 130, 9])),
            [10 * 256 + 70]
        );
        // Red 2573, green 17929, blue 33280 gave 15118.
        let deep = [0x0a, 0x0d, 0x46, 0x09, 0x82, 0x00];
        assert_eq!(heights(&png(ColorType::Rgb, PNG_16, 1, &deep)), [15118]);
        let nibbles = png(ColorType::Indexed, BitDepth::Four, 3, &[0x1f, 0x20]);
        assert_eq!(heights(&nibbles), [256, 15 * 256, 512]);
        assert_eq!(heights(b"P5\n2 1\n255\n\x0a\xff"), [2570, 65535]);
        assert_eq!(heights(b"P6\n1 1\n255\n\x0a\x46\x82"), [2630]);
    }

    #[test]
    fn palettes_of_gif_and_bmp_count_by_index() {
        let mut gif = Vec::new();
        let palette = [[9_u8; 3]; 256].concat();
        let mut encoder = ::gif::Encoder::new(&mut gif, 2, 1, &palette).unwrap();
        let frame = ::gif::Frame::from_indexed_pixels(2, 1, vec![3_u8, 250], None);
        encoder.write_frame(&frame).unwrap();
        drop(encoder);
        assert_eq!(heights(&gif), [3 * 256, 250 * 256]);

        let mut bmp = Vec::new();
        let mut encoder = ::image::codecs::bmp::BmpEncoder::new(&mut bmp);
        let color = ::image::ExtendedColorType::L8;
        encoder
            .encode_with_palette(&[3, 250], 2, 1, color, Some(&[[9; 3]; 256]))
            .unwrap();
        assert_eq!(heights(&bmp), [3 * 256, 250 * 256]);
    }

    #[test]
    fn broken_files_are_errors() {
        for bytes in [
            &b"GIF89a"[..],
            b"\x89PNG\r\n\x1a\nxx",
            b"BM12",
            b"",
            b"P5\n9 9\n255\n",
        ] {
            assert!(decode_heights(bytes, "broken.tga").is_err(), "{bytes:?}");
        }
    }
}
