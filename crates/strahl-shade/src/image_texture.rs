//! Images as textures: texels in memory, and their lookup by texture coordinates.

use std::fmt;

use strahl_math::DVec2;

use crate::srgb;

/// What happens to texture coordinates outside of `0..1`, per direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The picture is repeated (glTF `REPEAT`).
    #[default]
    Repeat,
    /// The picture is repeated, every second copy mirrored (glTF `MIRRORED_REPEAT`).
    Mirror,
    /// The texels of the edge continue (glTF `CLAMP_TO_EDGE`).
    Clamp,
}

/// How texels are combined to the value at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    /// The texel the point lies in.
    Nearest,
    /// The four texels whose centres surround the point, weighted linearly.
    #[default]
    Bilinear,
}

/// Which samples a texel consists of, in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TexelChannels {
    /// One value for red, green and blue; opaque.
    Gray,
    /// One value for red, green and blue, then alpha.
    GrayAlpha,
    /// Red, green, blue; opaque.
    Rgb,
    /// Red, green, blue, alpha.
    Rgba,
}

impl TexelChannels {
    /// Samples per texel.
    pub const fn count(self) -> usize {
        match self {
            Self::Gray => 1,
            Self::GrayAlpha => 2,
            Self::Rgb => 3,
            Self::Rgba => 4,
        }
    }

    /// Whether the last of them is alpha.
    const fn have_alpha(self) -> bool {
        matches!(self, Self::GrayAlpha | Self::Rgba)
    }
}

/// The samples of a picture, row by row from the top left, texel by texel.
///
/// They stay in the precision of the file: a photograph of 8 bit takes three bytes per texel.
#[derive(Clone, PartialEq)]
pub enum TexelData {
    /// Codes `0..=255`.
    U8(Vec<u8>),
    /// Codes `0..=65535`.
    U16(Vec<u16>),
    /// Linear values; may exceed one.
    F32(Vec<f32>),
}

impl TexelData {
    /// The number of samples.
    pub fn len(&self) -> usize {
        match self {
            Self::U8(samples) => samples.len(),
            Self::U16(samples) => samples.len(),
            Self::F32(samples) => samples.len(),
        }
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The meaning of the integer codes of an image. Alpha is always linear, and so are f32 samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ColorSpace {
    /// Codes of the sRGB transfer function: photographs, painted colours.
    Srgb,
    /// Codes proportional to the value: normals, roughness, heights, masks.
    Linear,
}

/// The samples don't make a picture of the given size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TexelCountMismatch {
    /// Columns asked for.
    pub width: u32,
    /// Rows asked for.
    pub height: u32,
    /// Samples per texel.
    pub channels: usize,
    /// Samples given.
    pub samples: usize,
}

impl fmt::Display for TexelCountMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            width,
            height,
            channels,
            samples,
        } = self;
        write!(
            f,
            "a texture of {width} x {height} texels with {channels} samples each was given {samples} samples; \
             give width * height * channels of them, and at least one texel"
        )
    }
}

impl std::error::Error for TexelCountMismatch {}

/// An image that can be mapped onto surfaces.
///
/// Coordinates follow glTF 2.0 (section 3.8.3): `uv = (0, 0)` is the top left corner of the top left texel, `(1, 1)` the
/// bottom right corner of the bottom right one. Alpha is straight, not premultiplied, and is interpolated independently of the colour.
///
/// There are no mip levels: a picture seen much smaller than it is needs many samples per pixel.
#[derive(Clone, PartialEq)]
pub struct TextureImage {
    width: u32,
    height: u32,
    channels: TexelChannels,
    color_space: ColorSpace,
    data: TexelData,
    /// Whether all texels have an alpha of 1.
    opaque: bool,
}

impl TextureImage {
    /// A texture of the given size, which must not be empty.
    pub fn try_new(
        width: u32,
        height: u32,
        channels: TexelChannels,
        color_space: ColorSpace,
        data: TexelData,
    ) -> Result<Self, TexelCountMismatch> {
        // In u128 no product of the three can overflow.
        let needed = u128::from(width) * u128::from(height) * channels.count() as u128;
        if needed == 0 || needed != data.len() as u128 {
            return Err(TexelCountMismatch {
                width,
                height,
                channels: channels.count(),
                samples: data.len(),
            });
        }
        let mut image = Self {
            width,
            height,
            channels,
            color_space,
            data,
            opaque: true,
        };
        image.opaque = image.has_only_opaque_texels();
        Ok(image)
    }

    /// Whether all texels have an alpha of 1.
    pub fn is_opaque(&self) -> bool {
        self.opaque
    }

    fn has_only_opaque_texels(&self) -> bool {
        let count = self.channels.count();
        if !self.channels.have_alpha() {
            return true;
        }
        let mut alphas = (count - 1..self.data.len()).step_by(count);
        match &self.data {
            TexelData::U8(samples) => alphas.all(|i| samples[i] == u8::MAX),
            TexelData::U16(samples) => alphas.all(|i| samples[i] == u16::MAX),
            TexelData::F32(samples) => alphas.all(|i| samples[i] == 1.0),
        }
    }

    /// Columns; at least one.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows; at least one.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The samples of a texel.
    pub fn channels(&self) -> TexelChannels {
        self.channels
    }

    /// The meaning of the codes.
    pub fn color_space(&self) -> ColorSpace {
        self.color_space
    }

    /// The stored samples.
    pub fn data(&self) -> &TexelData {
        &self.data
    }

    /// Applies `curve` to each sample of the colour channels, given as a fraction of the largest code.
    ///
    /// The result is linear. Alpha stays as it is.
    #[must_use]
    pub fn recoded(&self, curve: impl Fn(f64) -> f64) -> Self {
        let recode = |share: f64| curve(share) as f32;
        // There are fewer integer codes than texels, so a table is faster.
        let table = match &self.data {
            TexelData::U8(_) => (0..=u8::MAX)
                .map(|c| recode(f64::from(c) / 255.0))
                .collect(),
            TexelData::U16(_) => (0..=u16::MAX)
                .map(|c| recode(f64::from(c) / 65_535.0))
                .collect(),
            TexelData::F32(_) => Vec::new(),
        };
        let count = self.channels.count();
        let has_alpha = self.channels.have_alpha();
        let sample = |index: usize| {
            if has_alpha && index % count == count - 1 {
                return self.linear_sample(index);
            }
            match &self.data {
                TexelData::U8(samples) => table[usize::from(samples[index])],
                TexelData::U16(samples) => table[usize::from(samples[index])],
                TexelData::F32(samples) => recode(f64::from(samples[index])),
            }
        };
        Self {
            color_space: ColorSpace::Linear,
            data: TexelData::F32((0..self.data.len()).map(sample).collect()),
            ..*self
        }
    }

    /// Converts premultiplied colours to straight ones. Where alpha is 0 they stay as they are.
    #[must_use]
    pub fn straightened(&self) -> Self {
        let texels = (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y)));
        let samples = texels.flat_map(|(x, y)| {
            let [r, g, b, a] = self.fetch(x, y);
            let by = if a > 0.0 { a } else { 1.0 };
            [r / by, g / by, b / by, a]
        });
        Self {
            channels: TexelChannels::Rgba,
            color_space: ColorSpace::Linear,
            data: TexelData::F32(samples.collect()),
            ..*self
        }
    }

    /// Red, green, blue and alpha of the texel in column `x` and row `y`, linear.
    ///
    /// Columns and rows beyond the picture give its last ones.
    pub fn fetch(&self, x: u32, y: u32) -> [f32; 4] {
        let (x, y) = (x.min(self.width - 1), y.min(self.height - 1));
        let first = (y as usize * self.width as usize + x as usize) * self.channels.count();
        let color = |offset| self.color_sample(first + offset);
        let alpha = |offset| self.linear_sample(first + offset);
        match self.channels {
            TexelChannels::Gray => {
                let gray = color(0);
                [gray, gray, gray, 1.0]
            }
            TexelChannels::GrayAlpha => {
                let gray = color(0);
                [gray, gray, gray, alpha(1)]
            }
            TexelChannels::Rgb => [color(0), color(1), color(2), 1.0],
            TexelChannels::Rgba => [color(0), color(1), color(2), alpha(3)],
        }
    }

    /// The linear red, green, blue and alpha at `uv`.
    ///
    /// Deterministic for every `uv`: coordinates beyond 2^52 texels from the origin count as 2^52, NaN as the origin.
    pub fn sample(&self, uv: DVec2, wrap_u: Wrap, wrap_v: Wrap, filter: Filter) -> [f64; 4] {
        let (x, y) = (position(uv.x, self.width), position(uv.y, self.height));
        let texel = |column: f64, row: f64| {
            let column = wrapped(column, self.width, wrap_u);
            let row = wrapped(row, self.height, wrap_v);
            self.fetch(column, row).map(f64::from)
        };
        match filter {
            Filter::Nearest => texel(x.floor(), y.floor()),
            Filter::Bilinear => {
                // Texel centres lie at half-integers: shifted by a half, the texel to the left of the point is the floor.
                let (x, y) = (x - 0.5, y - 0.5);
                let (left, top) = (x.floor(), y.floor());
                let (s, t) = (x - left, y - top);
                let upper = lerp(texel(left, top), texel(left + 1.0, top), s);
                let lower = lerp(texel(left, top + 1.0), texel(left + 1.0, top + 1.0), s);
                lerp(upper, lower, t)
            }
        }
    }

    /// A sample of a colour channel, as linear light.
    fn color_sample(&self, index: usize) -> f32 {
        match (&self.data, self.color_space) {
            (TexelData::U8(samples), ColorSpace::Srgb) => srgb::decode_u8(samples[index]),
            (TexelData::U16(samples), ColorSpace::Srgb) => srgb::decode_u16(samples[index]),
            _ => self.linear_sample(index),
        }
    }

    /// A sample, its code proportional to the value.
    fn linear_sample(&self, index: usize) -> f32 {
        match &self.data {
            TexelData::U8(samples) => f32::from(samples[index]) / 255.0,
            TexelData::U16(samples) => f32::from(samples[index]) / 65_535.0,
            TexelData::F32(samples) => samples[index],
        }
    }
}

impl fmt::Debug for TextureImage {
    /// Everything but the texels.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TextureImage")
            .field("width", &self.width)
            .field("height", &self.height)
            .field("channels", &self.channels)
            .field("color_space", &self.color_space)
            .finish_non_exhaustive()
    }
}

/// Beyond 2^52 the f64 numbers have no fractions, so texels can't be distinguished anyway.
const FARTHEST: f64 = 4_503_599_627_370_496.0;

/// A texture coordinate in texels from the left or upper edge, finite.
fn position(coordinate: f64, size: u32) -> f64 {
    let position = coordinate * f64::from(size);
    if position.is_nan() {
        0.0
    } else {
        position.clamp(-FARTHEST, FARTHEST)
    }
}

/// The texel that stands at a whole position, which is at most a few texels beyond [`FARTHEST`].
fn wrapped(position: f64, size: u32, wrap: Wrap) -> u32 {
    let (position, size) = (position as i64, i64::from(size));
    let inside = match wrap {
        Wrap::Repeat => position.rem_euclid(size),
        Wrap::Clamp => position.clamp(0, size - 1),
        Wrap::Mirror => {
            let period = position.rem_euclid(2 * size);
            if period < size {
                period
            } else {
                2 * size - 1 - period
            }
        }
    };
    inside as u32
}

/// `a + (b - a) t` in each channel: equal texels give exactly their value.
fn lerp(a: [f64; 4], b: [f64; 4], t: f64) -> [f64; 4] {
    std::array::from_fn(|channel| a[channel] + (b[channel] - a[channel]) * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gray(width: u32, height: u32, values: &[f32]) -> TextureImage {
        TextureImage::try_new(
            width,
            height,
            TexelChannels::Gray,
            ColorSpace::Linear,
            TexelData::F32(values.to_vec()),
        )
        .unwrap()
    }

    fn value(image: &TextureImage, u: f64, v: f64, wrap: Wrap, filter: Filter) -> f64 {
        image.sample(DVec2::new(u, v), wrap, wrap, filter)[0]
    }

    #[test]
    fn the_origin_is_the_top_left_corner() {
        let image = gray(2, 2, &[1.0, 2.0, 3.0, 4.0]);
        for (u, v, expected) in [
            (0.0, 0.0, 1.0),
            (0.75, 0.25, 2.0),
            (0.25, 0.75, 3.0),
            (0.99, 0.99, 4.0),
        ] {
            assert_eq!(value(&image, u, v, Wrap::Clamp, Filter::Nearest), expected);
        }
        // Bilinear gives a texel's own value at its centre, the mean of all four in the middle.
        assert_eq!(
            value(&image, 0.75, 0.25, Wrap::Repeat, Filter::Bilinear),
            2.0
        );
        assert_eq!(value(&image, 0.5, 0.5, Wrap::Repeat, Filter::Bilinear), 2.5);
        assert_eq!(
            value(&image, 0.5, 0.25, Wrap::Repeat, Filter::Bilinear),
            1.5
        );
    }

    #[test]
    fn wrapping_at_the_edges() {
        let image = gray(4, 1, &[1.0, 2.0, 3.0, 4.0]);
        let row = |wrap| -> Vec<f64> {
            (-6..10)
                .map(|i| {
                    value(
                        &image,
                        (f64::from(i) + 0.5) / 4.0,
                        0.5,
                        wrap,
                        Filter::Nearest,
                    )
                })
                .collect()
        };
        let expected = |text: &str| -> Vec<f64> {
            text.chars()
                .map(|c| f64::from(c.to_digit(10).unwrap()))
                .collect()
        };
        assert_eq!(row(Wrap::Repeat), expected("3412341234123412"));
        assert_eq!(row(Wrap::Mirror), expected("3443211234432112"));
        assert_eq!(row(Wrap::Clamp), expected("1111111234444444"));
        // Half a texel beyond the left edge, repeat mixes with the right edge, the others with nothing.
        assert_eq!(value(&image, 0.0, 0.5, Wrap::Repeat, Filter::Bilinear), 2.5);
        assert_eq!(value(&image, 0.0, 0.5, Wrap::Mirror, Filter::Bilinear), 1.0);
        assert_eq!(value(&image, 0.0, 0.5, Wrap::Clamp, Filter::Bilinear), 1.0);
        assert_eq!(value(&image, 1.0, 0.5, Wrap::Repeat, Filter::Nearest), 1.0);
        assert_eq!(value(&image, 1.0, 0.5, Wrap::Clamp, Filter::Nearest), 4.0);
    }

    #[test]
    fn the_two_directions_wrap_independently() {
        let image = gray(2, 2, &[1.0, 2.0, 3.0, 4.0]);
        let sample =
            |u, v| image.sample(DVec2::new(u, v), Wrap::Repeat, Wrap::Clamp, Filter::Nearest)[0];
        assert_eq!(sample(1.25, 1.25), 3.0);
        assert_eq!(sample(1.25, -1.0), 1.0);
    }

    #[test]
    fn hostile_coordinates_give_texels() {
        let image = gray(3, 2, &[1.0; 6]);
        let hostile = [
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::MAX,
            f64::MIN,
            1e18,
            -1e18,
            -1e-320,
            -0.0,
        ];
        for u in hostile {
            for v in hostile {
                for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
                    for filter in [Filter::Nearest, Filter::Bilinear] {
                        assert_eq!(value(&image, u, v, wrap, filter), 1.0);
                    }
                }
            }
        }
    }

    #[test]
    fn storage_and_colour_space() {
        let build =
            |channels, space, data| TextureImage::try_new(1, 1, channels, space, data).unwrap();
        let srgb = build(
            TexelChannels::Rgba,
            ColorSpace::Srgb,
            TexelData::U8(vec![0, 188, 255, 128]),
        );
        assert_eq!(
            srgb.fetch(0, 0),
            [0.0, srgb::decode_u8(188), 1.0, 128.0 / 255.0]
        );
        let linear = build(
            TexelChannels::Rgb,
            ColorSpace::Linear,
            TexelData::U8(vec![0, 51, 255]),
        );
        assert_eq!(linear.fetch(7, 9), [0.0, 0.2, 1.0, 1.0]);
        let deep = build(
            TexelChannels::GrayAlpha,
            ColorSpace::Srgb,
            TexelData::U16(vec![65_535, 0]),
        );
        assert_eq!(deep.fetch(0, 0), [1.0, 1.0, 1.0, 0.0]);
        let float = build(
            TexelChannels::Rgb,
            ColorSpace::Srgb,
            TexelData::F32(vec![0.5, 7.0, -1.0]),
        );
        assert_eq!(float.fetch(0, 0), [0.5, 7.0, -1.0, 1.0]);
    }

    #[test]
    fn wrong_counts_are_refused() {
        let build = |width, height, count| {
            TextureImage::try_new(
                width,
                height,
                TexelChannels::Rgb,
                ColorSpace::Srgb,
                TexelData::U8(vec![0; count]),
            )
        };
        assert!(build(2, 3, 18).is_ok());
        for (width, height, count) in [(2, 3, 17), (0, 3, 0), (3, 0, 0), (u32::MAX, u32::MAX, 3)] {
            let error = build(width, height, count).unwrap_err();
            assert_eq!(
                (error.width, error.height, error.samples),
                (width, height, count)
            );
        }
        assert!(
            build(2, 3, 17)
                .unwrap_err()
                .to_string()
                .contains("2 x 3 texels with 3 samples each was given 17")
        );
    }
}
