//! The meaning of the codes of a picture file, from its header, or else from the convention of its format.

use std::io::Cursor;

use ::image::ImageFormat as FileFormat;

use super::texture::{EXR_MAGIC, open_picture};

/// The meaning of the codes of a picture file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PictureCodes {
    /// Linear light: files of floating-point numbers.
    Linear,
    /// Codes of sRGB, as the file specifies.
    Srgb,
    /// Linear light to the power of one over this number, as the file specifies.
    Gamma(f64),
    /// Not specified, but files of its format are nearly always sRGB: PNG, JPEG, GIF, BMP, TGA.
    UsuallySrgb,
    /// Specified neither by the file nor by its format: TIFF, PNM.
    Unsaid,
}

/// The meaning of the codes of a picture file; `name` determines the format if the first bytes don't.
///
/// For a PNG file, the chunks sRGB and gAMA are used. Embedded colour profiles are not read.
pub fn picture_codes(bytes: &[u8], name: &str) -> PictureCodes {
    if bytes.starts_with(&EXR_MAGIC) {
        return PictureCodes::Linear;
    }
    let format = open_picture(bytes, name).ok();
    match format.and_then(|reader| reader.format()) {
        Some(FileFormat::Hdr) => PictureCodes::Linear,
        Some(FileFormat::Png) => png_codes(bytes),
        Some(FileFormat::Tiff | FileFormat::Pnm) => PictureCodes::Unsaid,
        _ => PictureCodes::UsuallySrgb,
    }
}

/// The meaning according to the chunks of a PNG file.
fn png_codes(bytes: &[u8]) -> PictureCodes {
    let mut decoder = ::png::Decoder::new(Cursor::new(bytes));
    decoder.set_ignore_text_chunk(true);
    // Decoding the texels reports a broken file.
    let Ok(reader) = decoder.read_info() else {
        return PictureCodes::UsuallySrgb;
    };
    let info = reader.info();
    if info.srgb.is_some() {
        return PictureCodes::Srgb;
    }
    match info.gama_chunk.map(|gamma| f64::from(gamma.into_value())) {
        Some(1.0) => PictureCodes::Linear,
        Some(power) if power > 0.0 => PictureCodes::Gamma(1.0 / power),
        _ => PictureCodes::UsuallySrgb,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn png(change: impl FnOnce(&mut ::png::Encoder<'_, &mut Vec<u8>>)) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut bytes, 1, 1);
        encoder.set_color(::png::ColorType::Grayscale);
        change(&mut encoder);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(&[7]).expect("a texel");
        drop(writer);
        bytes
    }

    #[test]
    fn files_say_what_their_codes_are() {
        let gamma = |value| png(|e| e.set_source_gamma(::png::ScaledFloat::new(value)));
        assert_eq!(picture_codes(&png(|_| ()), "p"), PictureCodes::UsuallySrgb);
        assert_eq!(picture_codes(&gamma(1.0), "p"), PictureCodes::Linear);
        assert_eq!(picture_codes(&gamma(0.5), "p"), PictureCodes::Gamma(2.0));
        assert_eq!(picture_codes(&gamma(0.0), "p"), PictureCodes::UsuallySrgb);
        let srgb = png(|e| e.set_source_srgb(::png::SrgbRenderingIntent::Perceptual));
        assert_eq!(picture_codes(&srgb, "p"), PictureCodes::Srgb);
        let cases = [
            (&b"P5\n1 1\n255\n\x07"[..], "p", PictureCodes::Unsaid),
            (b"#?RADIANCE\n", "p", PictureCodes::Linear),
            (b"GIF89a", "p", PictureCodes::UsuallySrgb),
            (b"\0\0\x02", "p.tga", PictureCodes::UsuallySrgb),
            (&EXR_MAGIC, "p", PictureCodes::Linear),
            (b"nothing", "p", PictureCodes::UsuallySrgb),
        ];
        for (bytes, name, codes) in cases {
            assert_eq!(picture_codes(bytes, name), codes, "{bytes:?}");
        }
    }
}
