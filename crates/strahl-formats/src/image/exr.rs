//! OpenEXR (openexr.com, "OpenEXR File Layout"): linear floats, layers, and regions by data and display window.
//!
//! One part with all channels, layers by their names' prefixes (`N.X`): what every program reads.

mod read;

pub use read::{ExrFile, ExrHeader, read_exr, read_exr_header};

use std::io::{self, Cursor, Read, Seek, Write};

use ::exr::error::Error;
use ::exr::image::write::WritableImage;
use ::exr::image::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer};
use ::exr::io::Tracking;
use ::exr::math::Vec2;
use ::exr::meta::MetaData;
use ::exr::meta::attribute::{AttributeValue, Chromaticities, IntegerBounds, Text};
use ::exr::meta::header::{ImageAttributes, LayerAttributes};
use ::exr::prelude::f16;

use super::{LayerData, Picture, WriteOptions};

/// Where a file is read from. The decoder is compiled for each type that it reads from, so it always gets `&mut dyn Source`.
pub(super) trait Source: Read + Seek {}
impl<S: Read + Seek> Source for S {}

/// The headers of a file; that they fit together is not checked.
pub(super) fn headers(bytes: &[u8]) -> Result<MetaData, Error> {
    let source: &mut dyn Source = &mut Cursor::new(bytes);
    MetaData::read_from_buffered(Tracking::new(source), false)
}

pub(super) fn encode(
    writer: &mut dyn Write,
    picture: &Picture<'_>,
    options: &WriteOptions,
) -> io::Result<()> {
    let window = picture.window;
    let size = |width: u32, height: u32| Vec2(width as usize, height as usize);
    let layer = Layer::new(
        size(window.width, window.height),
        layer_attributes(picture),
        // Rows of 16 in a fixed order: the bytes don't depend on the number of compressing threads.
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels(picture, options).into_iter().collect()),
    );
    let mut attributes = ImageAttributes::new(IntegerBounds::new(
        Vec2(0, 0),
        size(picture.width, picture.height),
    ));
    attributes.chromaticities = Some(REC709);
    let image = Image::new(attributes, layer);

    // The encoder seeks, which a stream can't, and its header is put in order below: the file is made in memory.
    let mut file = Cursor::new(Vec::new());
    image
        .write()
        .to_buffered(&mut file)
        .map_err(|error| match error {
            Error::Io(error) => error,
            other => io::Error::other(other),
        })?;
    let mut file = file.into_inner();
    sort_attributes(&mut file).ok_or_else(|| {
        io::Error::new(
            io::ErrorKind::InvalidData,
            "the encoder's header is malformed",
        )
    })?;
    writer.write_all(&file)
}

/// Rec. 709's primaries and white point, D65.
const REC709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// Begins the names of a picture's metadata.
const PREFIX: &str = "strahl:";

fn layer_attributes(picture: &Picture<'_>) -> LayerAttributes {
    // The format's limit on sides makes the offsets fit.
    let mut attributes = LayerAttributes {
        layer_position: Vec2(picture.window.x as i32, picture.window.y as i32),
        ..LayerAttributes::default()
    };
    for (key, value) in &picture.metadata {
        let value = text(value);
        match key.as_str() {
            "software" => attributes.software_name = Some(value),
            "comment" | "comments" => attributes.comments = Some(value),
            // A prefix of our own keeps clear of the names that mean something to readers.
            _ => {
                let name = text(&format!("{PREFIX}{key}"));
                attributes.other.insert(name, AttributeValue::Text(value));
            }
        }
    }
    attributes
}

/// OpenEXR's texts are UTF-8 bytes.
fn text(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}

/// The planes of the picture and of its layers.
fn channels(picture: &Picture<'_>, options: &WriteOptions) -> Vec<AnyChannel<FlatSamples>> {
    let channel = |name: &str, sample_data| AnyChannel {
        name: text(name),
        sample_data,
        // A hint for lossy compression, which isn't used.
        quantize_linearly: false,
        sampling: Vec2(1, 1),
    };
    let mut channels = Vec::new();
    for (component, name) in ["R", "G", "B"].into_iter().enumerate() {
        let samples = picture.rgb.iter().map(|pixel| pixel[component]);
        let samples = if options.half {
            FlatSamples::F16(samples.map(half).collect())
        } else {
            FlatSamples::F32(samples.collect())
        };
        channels.push(channel(name, samples));
    }
    if let Some(alpha) = picture.alpha {
        let samples = alpha.iter().copied();
        let samples = match options.half {
            true => FlatSamples::F16(samples.map(half).collect()),
            false => FlatSamples::F32(samples.collect()),
        };
        channels.push(channel("A", samples));
    }
    for layer in picture.layers {
        let stride = layer.channels.len();
        for (component, name) in layer.channels.iter().enumerate() {
            let samples = match &layer.data {
                LayerData::F32(samples) => FlatSamples::F32(plane(samples, component, stride)),
                LayerData::U32(samples) => FlatSamples::U32(plane(samples, component, stride)),
            };
            channels.push(channel(&layer.channel_name(name), samples));
        }
    }
    channels
}

/// Every `stride`th sample.
fn plane<T: Copy>(samples: &[T], component: usize, stride: usize) -> Vec<T> {
    samples
        .iter()
        .copied()
        .skip(component)
        .step_by(stride)
        .collect()
}

/// The nearest half; finite values beyond its range become its largest ones.
fn half(value: f32) -> f16 {
    let rounded = f16::from_f32(value);
    if value.is_finite() && rounded.is_infinite() {
        f16::MAX.copysign(rounded)
    } else {
        rounded
    }
}

/// Sorts the attributes of a single-part file's header by name.
///
/// The encoder keeps them in a hash map, whose order differs from run to run; the format leaves the order free. Sorting
/// changes no lengths, and so no offset in the file. `None` if the bytes are no such header.
fn sort_attributes(file: &mut [u8]) -> Option<()> {
    const MAGIC_AND_VERSION: usize = 8;
    let mut attributes: Vec<&[u8]> = Vec::new();
    let mut rest = file.get(MAGIC_AND_VERSION..)?;
    // An attribute is its name, its type (both ended by 0), the size of its value and the value; an empty name ends them.
    while *rest.first()? != 0 {
        let name_end = rest.iter().position(|&byte| byte == 0)? + 1;
        let type_length = rest.get(name_end..)?.iter().position(|&byte| byte == 0)? + 1;
        let value_start = name_end + type_length + 4;
        let size = rest.get(value_start - 4..value_start)?.try_into().ok()?;
        let end = value_start.checked_add(u32::from_le_bytes(size) as usize)?;
        attributes.push(rest.get(..end)?);
        rest = rest.get(end..)?;
    }
    // The names differ and end in 0: comparing the bytes compares the names.
    attributes.sort_unstable();
    let sorted = attributes.concat();
    file.get_mut(MAGIC_AND_VERSION..MAGIC_AND_VERSION + sorted.len())?
        .copy_from_slice(&sorted);
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_stay_finite() {
        assert_eq!(half(1e6), f16::MAX);
        assert_eq!(half(-1e6), f16::MIN);
        assert_eq!(half(f32::INFINITY), f16::INFINITY);
        assert!(half(f32::NAN).is_nan());
        assert_eq!(half(0.1).to_f32(), 0.099_975_586);
    }

    #[test]
    fn attributes_are_sorted_in_place() {
        let mut file = b"MAGICVERb\0int\0\x02\0\0\0xyaa\0t\0\0\0\0\0\0pixels".to_vec();
        sort_attributes(&mut file).unwrap();
        assert_eq!(file, b"MAGICVERaa\0t\0\0\0\0\0b\0int\0\x02\0\0\0xy\0pixels");
        // Damaged headers are recognised, not followed.
        for length in 0..30 {
            assert_eq!(sort_attributes(&mut file[..length]), None, "{length}");
        }
        let mut huge = b"MAGICVERb\0int\0\xff\xff\xff\xffxy\0".to_vec();
        assert_eq!(sort_attributes(&mut huge), None);
    }
}
