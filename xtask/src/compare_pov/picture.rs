use anyhow::{Context, Result, bail};
use png::{ColorType, Decoder, Encoder, Transformations};
use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::Path;

/// A picture as it is displayed: 8-bit codes.
pub(crate) struct Shown {
    width: u32,
    height: u32,
    rgb: Vec<u8>,
}

impl Shown {
    /// A picture of these bytes, row by row.
    pub(crate) fn new(width: u32, height: u32, rgb: Vec<u8>) -> Self {
        Self { width, height, rgb }
    }

    pub(crate) fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// A channel of a pixel; 0 outside of the picture.
    pub(crate) fn code(&self, x: u32, y: u32, channel: usize) -> u8 {
        let at = 3 * (y as usize * self.width as usize + x as usize) + channel;
        self.rgb.get(at).copied().unwrap_or_default()
    }
}

/// Factor by which difference pictures are amplified.
const AMPLIFIED: u32 = 4;

/// Reads a PNG of any kind; alpha is ignored.
pub(crate) fn read(file: &Path) -> Result<Shown> {
    let open = File::open(file).with_context(|| format!("cannot open {}", file.display()))?;
    let mut decoder = Decoder::new(BufReader::new(open));
    decoder.set_transformations(Transformations::normalize_to_color8());
    let mut reader = decoder.read_info()?;
    let size = reader
        .output_buffer_size()
        .context("the picture is too large")?;
    let mut bytes = vec![0; size];
    let info = reader.next_frame(&mut bytes)?;
    bytes.truncate(info.buffer_size());
    let rgb = match info.color_type {
        ColorType::Rgb => bytes,
        ColorType::Rgba => bytes
            .chunks_exact(4)
            .flat_map(|p| [p[0], p[1], p[2]])
            .collect(),
        ColorType::Grayscale => bytes.iter().flat_map(|v| [*v; 3]).collect(),
        ColorType::GrayscaleAlpha => bytes.chunks_exact(2).flat_map(|p| [p[0]; 3]).collect(),
        ColorType::Indexed => bail!("{} has a palette", file.display()),
    };
    Ok(Shown {
        width: info.width,
        height: info.height,
        rgb,
    })
}

impl Shown {
    /// The pixels row by row.
    pub(crate) fn pixels(&self) -> &[[u8; 3]] {
        self.rgb.as_chunks().0
    }
}

/// Mean absolute difference of the channels and its root mean square; `None` for different sizes.
pub(crate) fn compare(a: &Shown, b: &Shown) -> Option<(f64, f64)> {
    if (a.width, a.height) != (b.width, b.height) || a.rgb.is_empty() {
        return None;
    }
    let (mut sum, mut squares) = (0.0, 0.0);
    for (a, b) in a.rgb.iter().zip(&b.rgb) {
        let apart = f64::from(a.abs_diff(*b));
        sum += apart;
        squares += apart * apart;
    }
    let count = a.rgb.len() as f64;
    Some((sum / count, (squares / count).sqrt()))
}

/// Writes the amplified difference as a picture.
pub(crate) fn write_difference(a: &Shown, b: &Shown, file: &Path) -> Result<()> {
    let amplified = |(a, b): (&u8, &u8)| (AMPLIFIED * u32::from(a.abs_diff(*b))).min(255) as u8;
    let rgb = a.rgb.iter().zip(&b.rgb).map(amplified).collect();
    let (width, height) = (a.width, a.height);
    write(&Shown { width, height, rgb }, file)
}

/// Writes a PNG.
pub(crate) fn write(picture: &Shown, file: &Path) -> Result<()> {
    let open = BufWriter::new(File::create(file)?);
    let mut encoder = Encoder::new(open, picture.width, picture.height);
    encoder.set_color(ColorType::Rgb);
    encoder.write_header()?.write_image_data(&picture.rgb)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_means_of_channels() {
        let shown = |rgb: &[u8]| Shown {
            width: 1,
            height: 1,
            rgb: rgb.to_vec(),
        };
        let (a, b) = (shown(&[0, 10, 200]), shown(&[3, 10, 194]));
        assert_eq!(compare(&a, &b), Some((3.0, 15_f64.sqrt())));
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("d.png");
        write_difference(&a, &b, &file).unwrap();
        assert_eq!(read(&file).unwrap().rgb, [12, 0, 24]);
    }
}
