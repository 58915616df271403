//! A picture with its additional layers and metadata.

use std::collections::HashSet;

use super::ImageError;

/// A rendered picture, or the rendered region of one.
#[derive(Clone, Debug)]
pub struct Picture<'a> {
    /// Columns of the full picture.
    pub width: u32,
    /// Rows of the full picture.
    pub height: u32,
    /// The part of the full picture that was rendered and is written.
    pub window: Window,
    /// Linear radiance with Rec. 709 primaries of the window's pixels, row by row from the top left.
    pub rgb: &'a [[f32; 3]],
    /// The coverage of each pixel, from 0 to 1; the colours are premultiplied by it. Only formats with [`FormatInfo::alpha`]
    /// accept it; the others reject the picture.
    ///
    /// [`FormatInfo::alpha`]: super::FormatInfo::alpha
    pub alpha: Option<&'a [f32]>,
    /// Further values per pixel: depth, normals, object numbers. Only formats whose [`FormatInfo::layers`] is set
    /// take them; the others refuse the picture rather than drop them.
    ///
    /// [`FormatInfo::layers`]: super::FormatInfo::layers
    pub layers: &'a [Layer],
    /// Keys and values that tell where the picture comes from: software, scene, accelerator, checksum.
    ///
    /// A key has 1 to 79 printable ASCII characters with single spaces inside at most; each occurs once. Values are any
    /// text without NUL.
    pub metadata: Vec<(String, String)>,
}

impl<'a> Picture<'a> {
    /// A full picture without layers and metadata.
    pub fn new(width: u32, height: u32, rgb: &'a [[f32; 3]]) -> Self {
        Self {
            width,
            height,
            window: Window {
                x: 0,
                y: 0,
                width,
                height,
            },
            rgb,
            alpha: None,
            layers: &[],
            metadata: Vec::new(),
        }
    }

    /// Whether only a part of the full picture is there.
    pub fn is_region(&self) -> bool {
        self.window.width != self.width || self.window.height != self.height
    }

    /// The metadata; a region adds a line with its place, for formats that have no field of their own for it.
    pub(super) fn metadata_with_region(&self) -> Vec<(&str, String)> {
        let mut lines: Vec<(&str, String)> = self
            .metadata
            .iter()
            .map(|(key, value)| (key.as_str(), value.clone()))
            .collect();
        if self.is_region() {
            let Window {
                x,
                y,
                width,
                height,
            } = self.window;
            let place = format!("{width}x{height}+{x}+{y} of {}x{}", self.width, self.height);
            lines.push((REGION_KEY, place));
        }
        lines
    }

    /// The metadata as lines of a text header, control characters replaced by spaces.
    pub(super) fn comments(&self) -> String {
        self.metadata_with_region()
            .iter()
            .map(|(key, value)| format!("# {key}: {}\n", value.replace(char::is_control, " ")))
            .collect()
    }

    /// Checks for errors that concern every format.
    pub(super) fn check(&self) -> Result<(), ImageError> {
        let Window {
            x,
            y,
            width,
            height,
        } = self.window;
        if width == 0 || height == 0 {
            return Err(ImageError::Empty { width, height });
        }
        let fits = |start: u32, size: u32, whole: u32| {
            u64::from(start) + u64::from(size) <= u64::from(whole)
        };
        if !fits(x, width, self.width) || !fits(y, height, self.height) {
            return Err(ImageError::invalid(format!(
                "the region of {width} x {height} pixels at ({x}, {y}) leaves the picture of {} x {} pixels",
                self.width, self.height
            )));
        }
        let pixels = u128::from(width) * u128::from(height);
        if self.rgb.len() as u128 != pixels {
            return Err(ImageError::invalid(format!(
                "a picture of {width} x {height} pixels was given {} colours",
                self.rgb.len()
            )));
        }
        if let Some(alpha) = self.alpha
            && alpha.len() as u128 != pixels
        {
            return Err(ImageError::invalid(format!(
                "a picture of {width} x {height} pixels was given {} alpha values",
                alpha.len()
            )));
        }
        self.check_layers(pixels)?;
        self.check_metadata()
    }

    fn check_layers(&self, pixels: u128) -> Result<(), ImageError> {
        let mut names = HashSet::from(["R", "G", "B", "A"].map(String::from));
        for layer in self.layers {
            let (count, samples) = (layer.channels.len(), layer.data.len());
            if count == 0 || samples as u128 != pixels * count as u128 {
                return Err(ImageError::invalid(format!(
                    "layer `{}` has {count} channels and {samples} samples where {pixels} pixels need one sample per channel",
                    layer.name
                )));
            }
            for channel in &layer.channels {
                let name = layer.channel_name(channel);
                // OpenEXR's short names hold 31 bytes.
                let printable = name.bytes().all(|byte| byte.is_ascii_graphic());
                if channel.is_empty() || name.len() > 31 || !printable {
                    return Err(ImageError::invalid(format!(
                        "`{name}` is not a valid channel name: it needs 1 to 31 printable ASCII characters without spaces"
                    )));
                }
                if names.contains(&name) {
                    return Err(ImageError::invalid(format!(
                        "two channels are called `{name}`: name the layers differently"
                    )));
                }
                names.insert(name);
            }
        }
        Ok(())
    }

    fn check_metadata(&self) -> Result<(), ImageError> {
        let mut keys = HashSet::from([REGION_KEY]);
        for (key, value) in &self.metadata {
            // PNG's rule for keywords.
            let legal = key.bytes().all(|byte| (b' '..=b'~').contains(&byte));
            let spaced = key.trim() != key || key.contains("  ");
            if key.is_empty() || key.len() > 79 || !legal || spaced {
                return Err(ImageError::invalid(format!(
                    "`{}` is not a valid metadata key: it needs 1 to 79 printable ASCII characters, single spaces inside",
                    key.escape_debug()
                )));
            }
            if !keys.insert(key) {
                return Err(ImageError::invalid(format!(
                    "the metadata key `{key}` is given twice, or is the writer's own"
                )));
            }
            if value.contains('\0') {
                return Err(ImageError::invalid(format!(
                    "the metadata value of `{key}` contains a NUL character"
                )));
            }
        }
        Ok(())
    }
}

/// The metadata key of a region's place.
const REGION_KEY: &str = "region";

/// A rectangle of pixels within the full picture; column and row count from the top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// Further values of the window's pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Name, the first part of the channels' names in the file (`depth`, `N`); empty for channels of the picture itself.
    pub name: String,
    /// Names of the samples of a pixel: `R G B`, `X Y Z`, `Z`, `id`.
    pub channels: Vec<String>,
    /// The samples, pixel by pixel like the picture, one per channel each.
    pub data: LayerData,
}

impl Layer {
    /// The full name of a channel: `depth.Z`.
    pub(super) fn channel_name(&self, channel: &str) -> String {
        if self.name.is_empty() {
            channel.to_owned()
        } else {
            format!("{}.{channel}", self.name)
        }
    }
}

/// The samples of a layer.
#[derive(Clone, Debug, PartialEq)]
pub enum LayerData {
    /// Measures: depth, normals, positions, radiance.
    F32(Vec<f32>),
    /// Numbers of things: objects, materials, counts.
    U32(Vec<u32>),
}

impl LayerData {
    /// The number of samples.
    pub fn len(&self) -> usize {
        match self {
            Self::F32(samples) => samples.len(),
            Self::U32(samples) => samples.len(),
        }
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Bits per sample of PNG and PPM pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BitDepth {
    /// 256 codes.
    #[default]
    Eight,
    /// 65536 codes.
    Sixteen,
}

/// Choices of a format; a format ignores those it hasn't.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WriteOptions {
    /// Bits per sample of PNG and PPM.
    pub bit_depth: BitDepth,
    /// Stores grey values instead of colours: PNG and PPM, see [`FormatInfo::grayscale`]. The grey of a colour is 0.297 R + 0.589 G + 0.114 B
    /// of the linear values, as in POV-Ray.
    ///
    /// [`FormatInfo::grayscale`]: super::FormatInfo::grayscale
    pub grayscale: bool,
    /// Stores the colours of EXR as 16-bit floats, which keep 11 bits and reach 65504; larger values become 65504.
    /// Layers keep 32 bits.
    pub half: bool,
    /// Quality of JPEG, from 1 (smallest) to 100; the default is 85, as in POV-Ray.
    pub jpeg_quality: u8,
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self {
            bit_depth: BitDepth::Eight,
            grayscale: false,
            half: false,
            jpeg_quality: 85,
        }
    }
}
