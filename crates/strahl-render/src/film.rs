mod merge;

pub use merge::MergeError;

use crate::trace::SampleResult;
use sha2::{Digest, Sha256};
use strahl_shade::srgb;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Left edge.
    pub x: u32,
    /// Top edge.
    pub y: u32,
    /// Width, at least 1.
    pub width: u32,
    /// Height, at least 1.
    pub height: u32,
}

impl Region {
    /// A whole picture.
    pub const fn full(width: u32, height: u32) -> Self {
        Self {
            x: 0,
            y: 0,
            width,
            height,
        }
    }

    /// Number of pixels.
    pub const fn pixels(&self) -> u64 {
        self.width as u64 * self.height as u64
    }

    /// The region grown by `margin` pixels, clipped to a picture of that size.
    pub(crate) fn grown(&self, margin: u32, width: u32, height: u32) -> Self {
        let (x, y) = (self.x.saturating_sub(margin), self.y.saturating_sub(margin));
        let right = (self.x + self.width).saturating_add(margin).min(width);
        let bottom = (self.y + self.height).saturating_add(margin).min(height);
        Self {
            x,
            y,
            width: right - x,
            height: bottom - y,
        }
    }

    /// Whether a pixel of the picture is in the region.
    pub(crate) const fn contains(&self, x: u32, y: u32) -> bool {
        x >= self.x && y >= self.y && x - self.x < self.width && y - self.y < self.height
    }

    /// Index of a pixel of the picture in the row-major order of this region, which must contain it.
    pub(crate) fn index(&self, x: u32, y: u32) -> usize {
        (y - self.y) as usize * self.width as usize + (x - self.x) as usize
    }
}

/// Data of a pixel besides its colour, from its first sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelInfo {
    /// Distance from the ray's origin; infinite for the background.
    pub depth: f32,
    /// Shading normal towards the viewer; zero for the background.
    pub normal: [f32; 3],
    /// World position; zero for the background.
    pub position: [f32; 3],
    /// Number of the object plus one; 0 for the background.
    pub object: u32,
    /// Number of the material plus one; 0 for the background.
    pub material: u32,
    /// Deepest level of the ray tree.
    pub tree_depth: u32,
    /// Primitive tests of the ray tree.
    pub tests: u32,
}

impl PixelInfo {
    pub(crate) fn new(sample: &SampleResult, tests: u64) -> Self {
        let (tree_depth, tests) = (sample.depth, u32::try_from(tests).unwrap_or(u32::MAX));
        match &sample.first {
            None => Self {
                depth: f32::INFINITY,
                normal: [0.0; 3],
                position: [0.0; 3],
                object: 0,
                material: 0,
                tree_depth,
                tests,
            },
            Some(hit) => Self {
                depth: hit.distance as f32,
                normal: hit.normal.as_vec3().to_array(),
                position: hit.position.as_vec3().to_array(),
                object: hit.object + 1,
                material: hit.material.0 + 1,
                tree_depth,
                tests,
            },
        }
    }
}

/// The linear picture: colours rounded to f32 once.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Width of the whole picture in pixels.
    pub width: u32,
    /// Height of the whole picture in pixels.
    pub height: u32,
    /// The part of the picture that this film holds.
    pub region: Region,
    /// Linear Rec. 709 RGB of the region, row by row from the top.
    pub pixels: Vec<[f32; 3]>,
    /// How much each pixel covers what lies behind the picture, if requested: 1 is opaque. The colours are then multiplied by it.
    pub alpha: Option<Vec<f32>>,
    /// More data of each pixel, if requested.
    pub info: Option<Vec<PixelInfo>>,
}

/// Why a film can't be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FilmError {
    /// Width or height is zero.
    #[error(
        "a picture of {width} x {height} pixels has no pixels; both numbers must be at least 1"
    )]
    Empty {
        /// Width requested.
        width: u32,
        /// Height requested.
        height: u32,
    },
    /// The region is not within the picture.
    #[error(
        "the region {x},{y} {width}x{height} is not within the picture of {of_width} x {of_height} pixels"
    )]
    RegionOutside {
        /// Left edge.
        x: u32,
        /// Top edge.
        y: u32,
        /// Width.
        width: u32,
        /// Height.
        height: u32,
        /// Width of the picture.
        of_width: u32,
        /// Height of the picture.
        of_height: u32,
    },
    /// A buffer for the picture is not as long as the picture has pixels.
    #[error("the buffer has {found} elements, the picture {expected} pixels")]
    Buffer {
        /// Pixels of the picture.
        expected: u64,
        /// Elements of the buffer.
        found: usize,
    },
    /// There is not enough memory for the film.
    #[error(
        "a picture of {width} x {height} pixels needs {gib:.1} GiB of memory, more than there is or is allowed; \
         make it smaller, or render it in parts with `strahl render --region`"
    )]
    OutOfMemory {
        /// Width of the region.
        width: u32,
        /// Height of the region.
        height: u32,
        /// Memory needed.
        gib: f64,
    },
}

impl Film {
    /// A black film, or why there can't be one.
    ///
    /// [`FilmError`]: no pixels, a region outside of the picture, or not enough memory.
    pub fn try_new(
        width: u32,
        height: u32,
        region: Option<Region>,
        info: bool,
    ) -> Result<Self, FilmError> {
        if width == 0 || height == 0 {
            return Err(FilmError::Empty { width, height });
        }
        let region = region.unwrap_or(Region::full(width, height));
        let inside = |start: u32, length: u32, of: u32| {
            length > 0 && u64::from(start) + u64::from(length) <= u64::from(of)
        };
        if !inside(region.x, region.width, width) || !inside(region.y, region.height, height) {
            let Region {
                x,
                y,
                width: w,
                height: h,
            } = region;
            return Err(FilmError::RegionOutside {
                x,
                y,
                width: w,
                height: h,
                of_width: width,
                of_height: height,
            });
        }
        let none = PixelInfo::new(&SampleResult::NOTHING, 0);
        let pixels = try_filled(region, [0.0; 3])?;
        let alpha = None;
        let info = if info {
            Some(try_filled(region, none)?)
        } else {
            None
        };
        Ok(Self {
            width,
            height,
            region,
            pixels,
            alpha,
            info,
        })
    }

    /// The colour of a pixel of the picture; `None` outside of the region.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[f32; 3]> {
        let r = &self.region;
        r.contains(x, y).then(|| self.pixels[r.index(x, y)])
    }

    /// The part of the film in a region of the picture, as far as the film has it: a film of the same picture. `None` if it has nothing of
    /// it.
    pub fn part(&self, region: Region) -> Option<Self> {
        Some(self.cut(region.intersection(&self.region)?))
    }

    /// A part that lies within the film.
    pub(crate) fn cut(&self, region: Region) -> Self {
        fn cut<T: Copy>(list: &[T], from: Region, region: Region) -> Vec<T> {
            let mut part = Vec::with_capacity(region.pixels() as usize);
            for y in region.y..region.y + region.height {
                let start = from.index(region.x, y);
                part.extend_from_slice(&list[start..start + region.width as usize]);
            }
            part
        }
        let from = self.region;
        Self {
            region,
            pixels: cut(&self.pixels, from, region),
            alpha: self.alpha.as_ref().map(|list| cut(list, from, region)),
            info: self.info.as_ref().map(|list| cut(list, from, region)),
            ..*self
        }
    }

    /// The colours as sRGB codes of 8 bits, three for each pixel, row by row: what a PNG holds. Values outside `0..=1` are clipped.
    pub fn to_srgb8(&self) -> Vec<u8> {
        let mut codes = vec![];
        srgb::push_u8(self.pixels.as_flattened(), &mut codes);
        codes
    }

    /// Copies the colours to their place in a buffer of the whole picture, row by row from the top.
    ///
    /// # Errors
    /// [`FilmError::Buffer`] if the buffer has not one element for each pixel of the picture.
    pub fn write_to(&self, buffer: &mut [[f32; 3]]) -> Result<(), FilmError> {
        let (whole, found) = (Region::full(self.width, self.height), buffer.len());
        if found as u64 != whole.pixels() {
            let expected = whole.pixels();
            return Err(FilmError::Buffer { expected, found });
        }
        let width = self.region.width as usize;
        for (y, row) in (self.region.y..).zip(self.pixels.chunks_exact(width)) {
            let start = whole.index(self.region.x, y);
            buffer[start..start + width].copy_from_slice(row);
        }
        Ok(())
    }

    /// SHA-256 of the pixels (three little-endian f32 each, row by row), in hexadecimal digits: equal exactly if all bits
    /// are.
    pub fn sha256(&self) -> String {
        let mut hasher = Sha256::new();
        let mut bytes = vec![0; self.region.width as usize * size_of::<[f32; 3]>()];
        for row in self.pixels.chunks(self.region.width as usize) {
            let values = bytes.as_chunks_mut().0.iter_mut().zip(row.as_flattened());
            values.for_each(|(four, value)| *four = value.to_le_bytes());
            hasher.update(&bytes);
        }
        hasher
            .finalize()
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect()
    }
}

/// A list with one value for each pixel, or the error that there is no memory for it.
pub(crate) fn try_filled<T: Clone>(region: Region, value: T) -> Result<Vec<T>, FilmError> {
    let mut list = Vec::new();
    let out_of_memory = || FilmError::OutOfMemory {
        width: region.width,
        height: region.height,
        gib: region.pixels() as f64 * size_of::<T>() as f64 / (1u64 << 30) as f64,
    };
    let count = usize::try_from(region.pixels()).map_err(|_| out_of_memory())?;
    let bytes = region.pixels().saturating_mul(size_of::<T>() as u64);
    if !strahl_simd::memory::fits(bytes) {
        return Err(out_of_memory());
    }
    list.try_reserve_exact(count).map_err(|_| out_of_memory())?;
    list.resize(count, value);
    Ok(list)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impossible_pictures_are_named() {
        let message = |r: Result<Film, FilmError>| r.expect_err("impossible").to_string();
        assert!(message(Film::try_new(0, 5, None, false)).contains("0 x 5"));
        let outside = Region {
            x: 5,
            y: 0,
            width: 6,
            height: 1,
        };
        assert!(message(Film::try_new(10, 10, Some(outside), false)).contains("5,0 6x1"));
        let huge = message(Film::try_new(u32::MAX, u32::MAX, None, false));
        assert!(huge.contains("GiB") && huge.contains("--region"));
    }

    #[test]
    fn the_hash_sees_every_bit() {
        let mut film = Film::try_new(3, 2, None, false).expect("small");
        let before = film.sha256();
        assert_eq!(before.len(), 64);
        film.pixels[5][2] = f32::from_bits(1);
        assert_ne!(film.sha256(), before);
    }

    #[test]
    fn parts_go_back_to_their_place() {
        let mut film = Film::try_new(5, 4, None, true).expect("small");
        for (number, pixel) in film.pixels.iter_mut().enumerate() {
            *pixel = [number as f32, 0.5, 2.0];
        }
        let region = |x, y, width, height| Region {
            x,
            y,
            width,
            height,
        };
        let part = film.part(region(3, 1, 9, 2)).expect("in the film");
        assert_eq!(part.region, region(3, 1, 2, 2));
        assert_eq!((part.width, part.height), (5, 4));
        let numbers: Vec<f32> = part.pixels.iter().map(|p| p[0]).collect();
        assert_eq!(numbers, [8.0, 9.0, 13.0, 14.0]);
        assert_eq!(part.info.as_ref().map(Vec::len), Some(4));
        assert_eq!(film.part(region(5, 0, 1, 1)), None);
        let mut buffer = vec![[-1.0; 3]; 20];
        part.write_to(&mut buffer).expect("as large");
        assert_eq!((buffer[13], buffer[12]), (film.pixels[13], [-1.0; 3]));
        let short = part.write_to(&mut buffer[1..]).expect_err("too short");
        assert!(short.to_string().contains("19 elements"));
        assert_eq!(part.to_srgb8()[..6], [255, 188, 255, 255, 188, 255]);
    }
}
