//! Picture files as textures.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use ::exr::image::read::read;
use ::exr::prelude::{ReadChannels, ReadLayers};
use ::image::{DynamicImage, ImageDecoder, ImageFormat as FileFormat, ImageReader, Limits};
use strahl_shade::image_texture::{ColorSpace, TexelChannels, TexelData, TextureImage};

use super::{ImageError, exr};
use crate::input::kind::{Kind, kind};

/// The most texels of a texture, 2^30.
pub const MAX_TEXELS: u64 = 1 << 30;

/// The most bytes a decoder may ask for: [`MAX_TEXELS`] of four bytes.
const MAX_BYTES: u64 = 4 * MAX_TEXELS;

/// The use of a texture, which determines the meaning of its integer codes. Floating-point files are always linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextureUse {
    /// A colour: codes are sRGB.
    Color,
    /// Normals, roughness, heights, masks: codes are proportional to the value.
    Data,
}

/// Reads a texture file; see [`decode_texture`].
pub fn read_texture(
    path: impl AsRef<Path>,
    texture_use: TextureUse,
) -> Result<TextureImage, ImageError> {
    let path = path.as_ref();
    let bytes = fs::read(path).map_err(|source| ImageError::Read {
        path: path.to_owned(),
        source,
    })?;
    decode_texture(&bytes, &path.display().to_string(), texture_use)
}

/// Decodes a texture: PNG, JPEG, EXR, HDR, TIFF, TGA, BMP, GIF (the first picture) or PNM.
///
/// The format is recognised by the first bytes; TGA, which has no mark, by the extension of `name`. Errors mention `name`.
/// Embedded colour profiles, gamma values and orientations are not applied. NaN becomes 0, infinity the largest number.
/// Textures of more than [`MAX_TEXELS`] texels or more than 4 GiB are rejected before allocation, as are those that exceed the
/// available memory.
pub fn decode_texture(
    bytes: &[u8],
    name: &str,
    texture_use: TextureUse,
) -> Result<TextureImage, ImageError> {
    if bytes.starts_with(&EXR_MAGIC) {
        return decode_exr(bytes, name);
    }
    let reader = open_picture(bytes, name)?;
    let failed = |error: ::image::ImageError| decode_error(name, error);
    let decoder = reader.into_decoder().map_err(failed)?;
    let (width, height) = decoder.dimensions();
    let bytes_per_texel = u64::from(decoder.color_type().bytes_per_pixel());
    check_size(name, width.into(), height.into(), bytes_per_texel)?;
    let picture = DynamicImage::from_decoder(decoder).map_err(failed)?;

    let (channels, data) = texels(picture);
    let color_space = match texture_use {
        TextureUse::Color => ColorSpace::Srgb,
        TextureUse::Data => ColorSpace::Linear,
    };
    build(name, width, height, channels, color_space, data)
}

/// A reader that knows the format: by the first bytes, else by the extension of the name.
pub(super) fn open_picture<'a>(
    bytes: &'a [u8],
    name: &str,
) -> Result<ImageReader<Cursor<&'a [u8]>>, ImageError> {
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| decode_error(name, error))?;
    if reader.format().is_none() {
        if let Some(Kind { what, .. }) = kind(bytes) {
            return Err(decode_error(name, format!("it is {what}")));
        }
        let format = FileFormat::from_path(name).map_err(|_| {
            decode_error(
                name,
                "neither its first bytes nor its name show a picture format",
            )
        })?;
        reader.set_format(format);
    }
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MAX_BYTES);
    reader.limits(limits);
    Ok(reader)
}

/// The samples as the file has them.
fn texels(picture: DynamicImage) -> (TexelChannels, TexelData) {
    use TexelChannels::{Gray, GrayAlpha, Rgb, Rgba};
    match picture {
        DynamicImage::ImageLuma8(p) => (Gray, TexelData::U8(p.into_raw())),
        DynamicImage::ImageLumaA8(p) => (GrayAlpha, TexelData::U8(p.into_raw())),
        DynamicImage::ImageRgb8(p) => (Rgb, TexelData::U8(p.into_raw())),
        DynamicImage::ImageRgba8(p) => (Rgba, TexelData::U8(p.into_raw())),
        DynamicImage::ImageLuma16(p) => (Gray, TexelData::U16(p.into_raw())),
        DynamicImage::ImageLumaA16(p) => (GrayAlpha, TexelData::U16(p.into_raw())),
        DynamicImage::ImageRgb16(p) => (Rgb, TexelData::U16(p.into_raw())),
        DynamicImage::ImageRgba16(p) => (Rgba, TexelData::U16(p.into_raw())),
        DynamicImage::ImageRgb32F(p) => (Rgb, TexelData::F32(p.into_raw())),
        other => (Rgba, TexelData::F32(other.into_rgba32f().into_raw())),
    }
}

/// The first bytes of an OpenEXR file.
pub(super) const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Red, green, blue and, where there is one, alpha of the first part of an OpenEXR file; the texture is its data window.
fn decode_exr(bytes: &[u8], name: &str) -> Result<TextureImage, ImageError> {
    let failed = |error: ::exr::error::Error| decode_error(name, error);
    let meta = exr::headers(bytes).map_err(failed)?;
    for header in &meta.headers {
        let size = header.layer_size;
        check_size(name, size.width() as u64, size.height() as u64, 16)?;
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| (size.width(), vec![0.0_f32; size.area() * 4]),
            |(width, samples), position, (r, g, b, a): (f32, f32, f32, f32)| {
                let start = (position.y() * *width + position.x()) * 4;
                if let Some(texel) = samples.get_mut(start..start + 4) {
                    texel.copy_from_slice(&[r, g, b, a]);
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_buffered(&mut Cursor::new(bytes) as &mut dyn exr::Source)
        .map_err(failed)?;
    let size = image.layer_data.size;
    let (_, samples) = image.layer_data.channel_data.pixels;
    build(
        name,
        size.width() as u32,
        size.height() as u32,
        TexelChannels::Rgba,
        ColorSpace::Linear,
        TexelData::F32(samples),
    )
}

pub(super) fn check_size(
    name: &str,
    width: u64,
    height: u64,
    texel_bytes: u64,
) -> Result<(), ImageError> {
    let limit = MAX_TEXELS.min(MAX_BYTES / texel_bytes.max(1));
    if width.saturating_mul(height) > limit {
        return Err(ImageError::TextureTooLarge {
            name: name.to_owned(),
            width,
            height,
            limit,
        });
    }
    let bytes = width * height * texel_bytes;
    if !strahl_simd::memory::fits(bytes) {
        return Err(ImageError::TextureMemory {
            name: name.to_owned(),
            width,
            height,
            mib: bytes.div_ceil(1 << 20),
        });
    }
    Ok(())
}

fn build(
    name: &str,
    width: u32,
    height: u32,
    channels: TexelChannels,
    color_space: ColorSpace,
    mut data: TexelData,
) -> Result<TextureImage, ImageError> {
    if let TexelData::F32(samples) = &mut data {
        // A single NaN or infinite texel would spread to everything that is filtered or reflected with it.
        for sample in samples {
            if sample.is_nan() {
                *sample = 0.0;
            } else {
                *sample = sample.clamp(f32::MIN, f32::MAX);
            }
        }
    }
    TextureImage::try_new(width, height, channels, color_space, data)
        .map_err(|error| decode_error(name, error))
}

pub(super) fn decode_error(name: &str, reason: impl ToString) -> ImageError {
    ImageError::Decode {
        name: name.to_owned(),
        reason: reason.to_string(),
    }
}
