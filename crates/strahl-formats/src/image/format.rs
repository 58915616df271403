//! The table of picture formats.

use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::Path;

use super::*;

/// A format pictures are written in; the order is that of [`formats`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ImageFormat {
    /// Portable Network Graphics.
    Png,
    /// OpenEXR.
    Exr,
    /// Radiance RGBE.
    Hdr,
    /// Portable pixmap.
    Ppm,
    /// JPEG, with lossy compression.
    Jpeg,
    /// Windows bitmap.
    Bmp,
    /// Truevision TGA.
    Tga,
}

/// Names and capabilities of a format.
#[derive(Debug)]
pub struct FormatInfo {
    /// The format.
    pub format: ImageFormat,
    /// File name extensions without the dot, the usual one first, lower case.
    pub extensions: &'static [&'static str],
    /// Short name.
    pub name: &'static str,
    /// What it stores, in one line.
    pub description: &'static str,
    /// Whether it stores [`Picture::layers`].
    pub layers: bool,
    /// Whether it stores [`Picture::alpha`].
    pub alpha: bool,
    /// Whether it stores grey values, see [`WriteOptions::grayscale`].
    pub grayscale: bool,
    /// Whether a field of its own keeps a region's place; in the other formats only the metadata does.
    pub regions: bool,
    /// The most pixels in each direction of the full picture.
    pub max_side: u32,
    /// Writes a picture that was checked.
    pub(super) encode: fn(&mut dyn Write, &Picture<'_>, &WriteOptions) -> io::Result<()>,
}

const I32_MAX: u32 = i32::MAX as u32;
const U16_MAX: u32 = u16::MAX as u32;

// The table of picture formats: a new one is one line here and one in the enum.
#[rustfmt::skip]
const FORMATS: &[FormatInfo] = {
    use ImageFormat::*;
    &[
        FormatInfo { format: Png, extensions: &["png"], name: "PNG", description: "8 or 16 bit sRGB, lossless", layers: false, alpha: true, grayscale: true, regions: true, max_side: I32_MAX, encode: png::encode },
        FormatInfo { format: Exr, extensions: &["exr"], name: "OpenEXR", description: "32 bit linear floats, layers, lossless", layers: true, alpha: true, grayscale: false, regions: true, max_side: I32_MAX, encode: exr::encode },
        FormatInfo { format: Hdr, extensions: &["hdr", "pic"], name: "Radiance HDR", description: "linear, 8 bit with a common exponent", layers: false, alpha: false, grayscale: false, regions: false, max_side: I32_MAX, encode: hdr::encode },
        FormatInfo { format: Ppm, extensions: &["ppm", "pnm"], name: "PPM", description: "8 or 16 bit sRGB, uncompressed", layers: false, alpha: false, grayscale: true, regions: false, max_side: I32_MAX, encode: ppm::encode },
        FormatInfo { format: Jpeg, extensions: &["jpg", "jpeg"], name: "JPEG", description: "8 bit sRGB, small, lossy", layers: false, alpha: false, grayscale: false, regions: false, max_side: U16_MAX, encode: jpeg::encode },
        FormatInfo { format: Bmp, extensions: &["bmp"], name: "BMP", description: "8 bit sRGB, uncompressed", layers: false, alpha: false, grayscale: false, regions: false, max_side: U16_MAX, encode: bmp::encode },
        FormatInfo { format: Tga, extensions: &["tga"], name: "TGA", description: "8 bit sRGB, uncompressed", layers: false, alpha: true, grayscale: false, regions: false, max_side: U16_MAX, encode: tga::encode },
    ]
};

/// The formats pictures are written in, the usual one first.
pub fn formats() -> &'static [FormatInfo] {
    FORMATS
}

impl ImageFormat {
    /// The format a file name asks for by its extension, in upper or lower case.
    pub fn from_path(path: impl AsRef<Path>) -> Result<Self, ImageError> {
        let path = path.as_ref();
        let extension = path.extension().map(OsStr::to_string_lossy);
        let found = match &extension {
            None => "it has no extension".to_owned(),
            Some(extension) => {
                let lower = extension.to_ascii_lowercase();
                let known = |info: &&FormatInfo| info.extensions.contains(&lower.as_str());
                if let Some(info) = FORMATS.iter().find(known) {
                    return Ok(info.format);
                }
                format!("`.{extension}` is not known")
            }
        };
        let known: Vec<String> = FORMATS
            .iter()
            .flat_map(|info| info.extensions)
            .map(|extension| format!(".{extension}"))
            .collect();
        Err(ImageError::UnknownFormat {
            path: path.to_owned(),
            found,
            known: known.join(", "),
        })
    }

    /// The format of this name, as [`formats`] has it, or with this extension, in upper or lower case.
    pub fn from_name(name: &str) -> Option<Self> {
        let lower = name.to_ascii_lowercase();
        let known = |info: &&FormatInfo| {
            info.name.eq_ignore_ascii_case(name) || info.extensions.contains(&lower.as_str())
        };
        FORMATS.iter().find(known).map(|info| info.format)
    }

    /// The format's line of the table.
    pub fn info(self) -> &'static FormatInfo {
        // The table has the order of the enum, which a test holds it to.
        &FORMATS[self as usize]
    }

    /// Checks that this format can write the picture.
    pub(super) fn check(self, picture: &Picture<'_>) -> Result<(), ImageError> {
        picture.check()?;
        let info = self.info();
        if picture.width.max(picture.height) > info.max_side {
            return Err(ImageError::TooLarge {
                format: info.name,
                width: picture.width,
                height: picture.height,
                limit: info.max_side,
            });
        }
        if picture.alpha.is_some() && !info.alpha {
            let able = FORMATS.iter().filter(|info| info.alpha);
            let able: Vec<&str> = able.map(|info| info.name).collect();
            return Err(ImageError::AlphaUnsupported {
                format: info.name,
                able: able.join(" or "),
            });
        }
        match picture.layers.first() {
            Some(layer) if !info.layers => {
                let able: Vec<&str> = FORMATS
                    .iter()
                    .filter(|info| info.layers)
                    .map(|info| info.name)
                    .collect();
                Err(ImageError::LayersUnsupported {
                    format: info.name,
                    layer: layer.name.clone(),
                    able: able.join(" or "),
                })
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_format_finds_its_line() {
        for info in formats() {
            assert_eq!(info.format.info().format, info.format);
            for extension in info.extensions {
                assert_eq!(*extension, extension.to_lowercase());
                let name = format!("a.b/picture.{}", extension.to_uppercase());
                assert_eq!(ImageFormat::from_path(name).unwrap(), info.format);
            }
        }
    }

    #[test]
    fn unknown_extensions_are_answered_with_the_known_ones() {
        let message = |path| ImageFormat::from_path(path).unwrap_err().to_string();
        for path in ["picture.webp", "picture", ".png", "png", ""] {
            assert!(message(path).ends_with(
                "end it in one of .png, .exr, .hdr, .pic, .ppm, .pnm, .jpg, .jpeg, .bmp, .tga"
            ));
        }
        assert!(message("picture.webp").contains("`.webp` is not known"));
        assert!(message("png").contains("it has no extension"));
    }
}
