//! Reads OpenEXR files with all their channels and texts, such as the tiles of a picture.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufReader, Cursor, ErrorKind};
use std::path::Path;

use ::exr::block::reader::Reader;
use ::exr::image::read::read;
use ::exr::image::{AnyChannels, FlatSamples, Image, Layer};
use ::exr::meta::MetaData;
use ::exr::meta::attribute::AttributeValue;
use ::exr::meta::header::Header;
use ::exr::prelude::{ReadChannels, ReadLayers};

use super::super::texture::check_size;
use super::super::{ImageError, LayerData, Window};
use super::{PREFIX, Source, headers};

/// What the header of an OpenEXR file says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExrHeader {
    /// Columns of the full picture, which is the display window.
    pub width: u32,
    /// Rows of the full picture.
    pub height: u32,
    /// The part of the full picture that the file has: the data window.
    pub window: Window,
    /// The metadata that a [`super::super::Picture`] was written with.
    pub metadata: BTreeMap<String, String>,
}

/// An OpenEXR file: one part, all channels.
#[derive(Clone, Debug, PartialEq)]
pub struct ExrFile {
    /// What its header says.
    pub header: ExrHeader,
    /// The samples of each channel by its full name (`R`, `depth.Z`), row by row. Halves are widened.
    pub channels: BTreeMap<String, LayerData>,
}

/// Reads an OpenEXR file of one part whose display window begins at 0,0, as all files of this program do.
///
/// # Errors
/// [`ImageError`]: the file can't be read, is damaged or cut off, or is another kind of OpenEXR file.
pub fn read_exr(path: impl AsRef<Path>) -> Result<ExrFile, ImageError> {
    let path = path.as_ref();
    let bytes = fs::read(path).map_err(|error| unreadable(path, &error))?;
    let name = path.display().to_string();
    decode(&bytes, &name).map_err(|problem| problem.of(path))
}

/// Reads the header of a file that [`read_exr`] would read, and its last rows: a file that was cut off is noticed, one whose samples were
/// changed is not.
///
/// # Errors
/// As for [`read_exr`].
pub fn read_exr_header(path: impl AsRef<Path>) -> Result<ExrHeader, ImageError> {
    let path = path.as_ref();
    let file = File::open(path).map_err(|error| unreadable(path, &error))?;
    header_and_end(&mut BufReader::new(file)).map_err(|problem| problem.of(path))
}

fn unreadable(path: &Path, error: &io::Error) -> ImageError {
    let reason = match error.kind() {
        ErrorKind::NotFound => "there is no such file".to_owned(),
        _ => error.to_string(),
    };
    Problem::Exr(reason).of(path)
}

enum Problem {
    Exr(String),
    Size(ImageError),
}

impl From<::exr::error::Error> for Problem {
    fn from(error: ::exr::error::Error) -> Self {
        Self::Exr(error.to_string())
    }
}

impl Problem {
    fn of(self, path: &Path) -> ImageError {
        match self {
            Self::Exr(reason) => ImageError::Exr {
                path: path.to_owned(),
                reason,
            },
            Self::Size(error) => error,
        }
    }
}

fn other(what: &str) -> Problem {
    Problem::Exr(what.to_owned())
}

/// The header of the only part.
fn only_part(meta: &MetaData) -> Result<&Header, Problem> {
    match &meta.headers[..] {
        [header] => Ok(header),
        _ => Err(other("it has several parts")),
    }
}

fn header_and_end(file: &mut dyn Source) -> Result<ExrHeader, Problem> {
    let reader = Reader::read_from_buffered(file, false)?;
    let part = only_part(reader.meta_data())?;
    let (header, count) = (header(part)?, part.chunk_count);
    let mut number = 0;
    let last = reader.filter_chunks(false, |_, _, _| {
        number += 1;
        number == count
    })?;
    for chunk in last {
        chunk?;
    }
    Ok(header)
}

/// What a header says, in this program's words.
fn header(part: &Header) -> Result<ExrHeader, Problem> {
    let display = part.shared_attributes.display_window;
    let attributes = &part.own_attributes;
    let position = attributes.layer_position;
    let number = |n: usize| u32::try_from(n).map_err(|_| other("its windows are too large"));
    let (Ok(x), Ok(y)) = (u32::try_from(position.x()), u32::try_from(position.y())) else {
        return Err(other("its data window begins before its display window"));
    };
    if (display.position.x(), display.position.y()) != (0, 0) {
        return Err(other("its display window does not begin at 0,0"));
    }
    let texts = attributes.other.iter();
    let metadata = texts.filter_map(|(name, value)| {
        let name = name.to_string();
        let key = name.strip_prefix(PREFIX)?.to_owned();
        match value {
            AttributeValue::Text(value) => {
                Some((key, String::from_utf8_lossy(value.as_slice()).into_owned()))
            }
            _ => None,
        }
    });
    Ok(ExrHeader {
        width: number(display.size.width())?,
        height: number(display.size.height())?,
        window: Window {
            x,
            y,
            width: number(part.layer_size.width())?,
            height: number(part.layer_size.height())?,
        },
        metadata: metadata.collect(),
    })
}

fn decode(bytes: &[u8], name: &str) -> Result<ExrFile, Problem> {
    let meta = headers(bytes)?;
    let part = only_part(&meta)?;
    let size = part.layer_size;
    let sample_bytes = 4 * part.channels.list.len().max(1) as u64;
    check_size(
        name,
        size.width() as u64,
        size.height() as u64,
        sample_bytes,
    )
    .map_err(Problem::Size)?;
    let image: Image<Layer<AnyChannels<FlatSamples>>> = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(&mut Cursor::new(bytes) as &mut dyn Source)?;
    let layer = image.layer_data;
    let pixels = layer.size.area();
    let mut channels = BTreeMap::new();
    for channel in layer.channel_data.list {
        let data = match channel.sample_data {
            FlatSamples::F16(samples) => {
                LayerData::F32(samples.iter().map(|half| half.to_f32()).collect())
            }
            FlatSamples::F32(samples) => LayerData::F32(samples),
            FlatSamples::U32(samples) => LayerData::U32(samples),
        };
        if data.len() != pixels {
            return Err(other("a channel has not one sample for each pixel"));
        }
        channels.insert(channel.name.to_string(), data);
    }
    Ok(ExrFile {
        header: header(part)?,
        channels,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{Layer, Picture, WriteOptions, write_picture};

    #[test]
    fn what_is_written_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("tile.exr");
        let rgb: Vec<[f32; 3]> = (0..6).map(|i| [i as f32, -0.0, 1e-40]).collect();
        let layers = [
            Layer {
                name: "depth".into(),
                channels: vec!["Z".into()],
                data: LayerData::F32(vec![f32::INFINITY; 6]),
            },
            Layer {
                name: "object".into(),
                channels: vec!["id".into()],
                data: LayerData::U32((0..6).map(|i| u32::MAX - i).collect()),
            },
        ];
        let window = Window {
            x: 4,
            y: 5,
            width: 3,
            height: 2,
        };
        let picture = Picture {
            window,
            layers: &layers,
            alpha: Some(&[0.5; 6]),
            metadata: vec![("tile".into(), "2/3 \u{e9}".into())],
            ..Picture::new(10, 20, &rgb)
        };
        write_picture(&path, &picture, &WriteOptions::default()).unwrap();
        let file = read_exr(&path).unwrap();
        let header = &file.header;
        assert_eq!(
            (header.width, header.height, header.window),
            (10, 20, window)
        );
        assert_eq!(header.metadata["tile"], "2/3 \u{e9}");
        assert_eq!(read_exr_header(&path).unwrap(), *header);
        assert_eq!(file.channels["depth.Z"], layers[0].data);
        assert_eq!(file.channels["object.id"], layers[1].data);
        assert_eq!(file.channels["A"], LayerData::F32(vec![0.5; 6]));
        let LayerData::F32(blue) = &file.channels["B"] else {
            panic!("colours are floats");
        };
        assert!(blue.iter().all(|b| b.to_bits() == 1e-40_f32.to_bits()));
        assert_eq!(file.channels.len(), 6);

        // A file that was cut off anywhere is never read.
        let bytes = fs::read(&path).unwrap();
        for length in (0..bytes.len()).step_by(7) {
            fs::write(&path, &bytes[..length]).unwrap();
            let error = read_exr(&path).unwrap_err().to_string();
            assert!(error.contains("tile.exr"), "{error}");
            assert!(read_exr_header(&path).is_err(), "{length}");
        }
        fs::remove_file(&path).unwrap();
        assert!(read_exr(&path).is_err());
    }
}
