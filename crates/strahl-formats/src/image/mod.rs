//! Writing pictures and reading textures.
//!
//! [`write_picture`] writes a rendered [`Picture`] in the format its file name asks for; [`formats`] is the table of formats,
//! one line each. [`read_texture`] reads picture files as textures. [`compare`] tells how far two pictures are apart.
//!
//! The same picture gives the same bytes, on every machine.
//!
//! # Example
//!
//! ```
//! use strahl_formats::image::{ImageFormat, Picture, WriteOptions, encode_picture};
//!
//! let rgb = [[0.0, 0.2, 1.0]; 6];
//! let picture = Picture::new(3, 2, &rgb);
//! let format = ImageFormat::from_path("sky.png")?;
//! let mut bytes = Vec::new();
//! encode_picture(&mut bytes, format, &picture, &WriteOptions::default())?;
//! assert!(bytes.starts_with(b"\x89PNG"));
//! # Ok::<(), strahl_formats::image::ImageError>(())
//! ```

mod bmp;
mod diff;
mod error;
mod exr;
mod format;
mod gamma;
mod hdr;
mod heights;
mod jpeg;
mod picture;
mod png;
mod ppm;
#[cfg(test)]
mod tests;
mod texture;
mod tga;
mod write;

pub use diff::{Difference, compare};
pub use error::ImageError;
pub use exr::{ExrFile, ExrHeader, read_exr, read_exr_header};
pub use format::{FormatInfo, ImageFormat, formats};
pub use gamma::{PictureCodes, picture_codes};
pub use heights::{
    Heights, PaletteIndices, TexelNumbers, decode_heights, decode_indices, decode_numbers,
};
pub use picture::{BitDepth, Layer, LayerData, Picture, Window, WriteOptions};
pub use texture::{MAX_TEXELS, TextureUse, decode_texture, read_texture};
pub use write::{encode_picture, write_bytes, write_file, write_picture};
