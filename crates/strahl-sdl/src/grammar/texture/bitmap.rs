//! Pictures in textures: `image_map`, `image_pattern`, `bump_map` and `material_map`.

use crate::HostError;
use crate::keywords::Word;
use crate::parser::{PResult, Parser, Place, has_ending};
use crate::token::{Kind, Token};
use std::sync::Arc;
use strahl_formats::image::{
    PictureCodes, TexelNumbers, TextureUse, decode_indices, decode_numbers, decode_texture,
    picture_codes,
};
use strahl_function::Cost;
use strahl_math::DVec3;
use strahl_scene::WorkingSpace;
use strahl_shade::image_map::{ImageMap, Interpolation, MapType};
use strahl_shade::image_texture::{ColorSpace, TexelChannels, TexelData, TextureImage};
use strahl_shade::patterns::{BATCH, TexturePoint};
use strahl_shade::{Color, ColorFt};

/// Stores the red, green, blue and alpha at points, at most [`BATCH`].
type PictureFunction = Box<dyn Fn(&[TexturePoint], &mut [[f64; 4]])>;

/// The name of a picture's file, and where the scene names it.
pub(super) type PictureFile = (String, Place);

/// A picture, and its file if it has one.
type Picture = (Arc<TextureImage>, Option<PictureFile>);

/// The use of a picture, which determines the meaning of its codes if no `gamma` is given.
#[derive(Clone, Copy, PartialEq)]
enum Purpose {
    /// Colours: the file determines the meaning, or else the defaults of its format and the scene's version.
    Color,
    /// Values proportional to the codes.
    Data,
}

/// The conversion from the codes of a file to the scene's numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Recoding {
    /// The space of the codes.
    from: WorkingSpace,
    /// The space of the scene's numbers.
    to: WorkingSpace,
    /// Whether the colours of the file are multiplied by their alpha.
    premultiplied: bool,
}

impl Recoding {
    /// No conversion.
    const NONE: Self = Self {
        from: WorkingSpace::Linear,
        to: WorkingSpace::Linear,
        premultiplied: false,
    };

    /// Converts a picture whose codes were read without conversion.
    fn apply(self, picture: TextureImage) -> TextureImage {
        let picture = if self.from == self.to {
            picture
        } else {
            picture.recoded(|code| self.to.encode(self.from.decode(Color::gray(code))).r)
        };
        if self.premultiplied {
            picture.straightened()
        } else {
            picture
        }
    }
}

/// A decoded picture and the arguments for which it was read, because loops and macros use the same ones repeatedly.
#[derive(Debug)]
pub(in crate::grammar) struct KnownPicture {
    name: String,
    codes: PictureCodes,
    recoding: Recoding,
    image: Arc<TextureImage>,
}

/// The largest number of texels in a function image.
const MAX_FUNCTION_TEXELS: u64 = 1 << 24;

impl Parser<'_> {
    /// The braces of `image_map`; `None` for an unsupported picture.
    pub(super) fn color_bitmap(&mut self) -> PResult<Option<Arc<ImageMap>>> {
        self.bitmap(|p| p.picture_file(Purpose::Color), |_, _, _| Ok(false))
    }

    /// The braces of `image_pattern`.
    pub(super) fn pattern_bitmap(&mut self) -> PResult<Arc<ImageMap>> {
        let image = self.bitmap(|p| p.picture_file(Purpose::Data), |_, _, _| Ok(false))?;
        Ok(image.unwrap_or_else(|| Arc::new(ImageMap::new(blank()))))
    }

    /// The braces of `bump_map`, with the `bump_size` in them.
    pub(super) fn bump_bitmap(&mut self) -> PResult<(Option<Arc<ImageMap>>, Option<f64>)> {
        let (mut size, mut by_index, mut file) = (None, false, None);
        let image = self.bitmap(
            |p| {
                let picture = p.picture_file(Purpose::Data)?;
                file = picture.as_ref().and_then(|(_, file)| file.clone());
                Ok(picture)
            },
            |p, _, token| {
                match token.word() {
                    Some(Word::BumpSize) => {
                        p.take(token)?;
                        size = Some(p.float()?);
                    }
                    Some(word @ (Word::UseIndex | Word::UseColor | Word::UseColour)) => {
                        p.take(token)?;
                        by_index = word == Word::UseIndex;
                    }
                    _ => return Ok(false),
                }
                Ok(true)
            },
        )?;
        let (Some(map), true, Some(file)) = (&image, by_index, file) else {
            return Ok((image, size));
        };
        Ok(match self.heights_by_index(file)? {
            Some(heights) => {
                // The cubic interpolation limits values to 1, as colours need it.
                let interpolation = match map.interpolation {
                    Interpolation::Bicubic => Interpolation::Bilinear,
                    other => other,
                };
                let map = ImageMap {
                    image: Arc::new(heights),
                    interpolation,
                    palette: None,
                    filter_all: 0.0,
                    transmit_all: 0.0,
                    ..ImageMap::clone(map)
                };
                (Some(Arc::new(map)), size)
            }
            None => (image, size),
        })
    }

    /// The heights of a picture with `use_index`; `None` if it has no palette, for which POV-Ray uses its colours.
    ///
    /// The height is the number of the entry in the palette, from 0 to 255, whatever the size of the palette (measured); the
    /// height of colours goes from 0 to 1 only.
    fn heights_by_index(&mut self, file: PictureFile) -> PResult<Option<TextureImage>> {
        let (name, place) = file;
        let file = self.read_file(&name, place)?;
        let indexed = match decode_indices(&file.bytes, &name) {
            Ok(Some(indexed)) => indexed,
            Ok(None) => return Ok(None),
            Err(error) => return Err(self.fail(place, error.to_string())),
        };
        let heights = indexed.indices.iter().map(|index| f32::from(*index));
        let image = TextureImage::try_new(
            indexed.width,
            indexed.height,
            TexelChannels::Gray,
            ColorSpace::Linear,
            TexelData::F32(heights.collect()),
        );
        match image {
            Ok(image) => Ok(Some(image)),
            Err(error) => Err(self.fail(place, error.to_string())),
        }
    }

    /// The braces of `material_map`; `other` reads items that do not belong to the picture.
    pub(super) fn material_bitmap(
        &mut self,
        mut other: impl FnMut(&mut Self, Token) -> PResult<bool>,
    ) -> PResult<Option<Arc<ImageMap>>> {
        self.bitmap(Self::codes_file, |p, _, token| other(p, token))
    }

    /// `[type] "file"`: the code of each texel, as red. For pictures with a palette it is the index, for others red or grey.
    fn codes_file(&mut self) -> PResult<Option<Picture>> {
        let (_, name) = self.picture_name()?;
        let place = self.place();
        let file = self.read_file(&name, place)?;
        let TexelNumbers {
            width,
            height,
            numbers,
        } = match decode_numbers(&file.bytes, &name) {
            Ok(found) => found,
            Err(error) => return Err(self.fail(place, error.to_string())),
        };
        let image = TextureImage::try_new(
            width,
            height,
            TexelChannels::Gray,
            ColorSpace::Linear,
            TexelData::U8(numbers),
        );
        match image {
            Ok(image) => Ok(Some((Arc::new(image), Some((name, place))))),
            Err(error) => Err(self.fail(place, error.to_string())),
        }
    }

    fn bitmap(
        &mut self,
        picture_file: impl FnOnce(&mut Self) -> PResult<Option<Picture>>,
        mut other: impl FnMut(&mut Self, &mut ImageMap, Token) -> PResult<bool>,
    ) -> PResult<Option<Arc<ImageMap>>> {
        self.braces(|p| {
            let token = p.peek()?;
            let image = if token.is(Word::Function) {
                p.take(token)?;
                Some((p.function_picture()?, None))
            } else {
                picture_file(p)?
            };
            let supported = image.is_some();
            let (image, file) = image.unzip();
            let file = file.flatten();
            let mut map = ImageMap::new(image.unwrap_or_else(blank));
            p.items("the picture", |p, token| {
                if other(p, &mut map, token)? || p.bitmap_item(&mut map, file.as_ref(), token)? {
                    return Ok(());
                }
                p.skip_item(token, "the picture")
            })?;
            Ok(supported.then(|| Arc::new(map)))
        })
    }

    /// `[type] "file"`. As in POV-Ray (measured) the ending of the type is added to a name without one, unless there is a file of that name.
    pub(in crate::grammar) fn picture_name(&mut self) -> PResult<(Option<Word>, String)> {
        let kind = self.picture_type()?;
        let name = self.file_name()?;
        let place = self.place();
        let (Some(word), false) = (kind, has_ending(&name)) else {
            return Ok((kind, name));
        };
        match self.look_for_file(&name, place)? {
            Err(HostError::NotFound { .. }) => {
                let ending = if word == Word::Jpeg {
                    "jpg"
                } else {
                    word.text()
                };
                Ok((kind, format!("{name}.{ending}")))
            }
            _ => Ok((kind, name)),
        }
    }

    /// The type of a picture file, if one follows. Up to POV-Ray 1.0 the directions of the picture's sides stood in front of it.
    fn picture_type(&mut self) -> PResult<Option<Word>> {
        let mut token = self.peek()?;
        if token.kind == Kind::Less {
            let place = self.place_of(token);
            // Newer versions of the language read `1 -1` as 0.
            let sides = self.vector3()?;
            if sides != DVec3::new(1.0, -1.0, 0.0) && sides != DVec3::ZERO {
                self.warn_hint(
                    place,
                    "the directions of the picture's sides are ignored",
                    "write `rotate` behind the picture",
                );
            }
            token = self.peek()?;
        }
        let kind = token.word().filter(|word| {
            matches!(
                word,
                Word::Bmp
                    | Word::Exr
                    | Word::Gif
                    | Word::Hdr
                    | Word::Iff
                    | Word::Jpeg
                    | Word::Pgm
                    | Word::Png
                    | Word::Pot
                    | Word::Ppm
                    | Word::Sys
                    | Word::Tga
                    | Word::Tiff
            )
        });
        if kind.is_some() {
            self.take(token)?;
        }
        Ok(kind)
    }

    /// `[type] "file" [gamma g] [premultiplied on]`
    fn picture_file(&mut self, purpose: Purpose) -> PResult<Option<Picture>> {
        let (kind, name) = self.picture_name()?;
        let place = self.place();
        let (mut gamma, mut premultiplied) = (None, false);
        loop {
            let token = self.peek()?;
            match token.word() {
                Some(Word::Gamma) => {
                    self.take(token)?;
                    gamma = Some(self.transfer_function("gamma")?);
                }
                Some(Word::Premultiplied) => {
                    self.take(token)?;
                    premultiplied = self.flag()?;
                }
                _ => break,
            }
        }
        if kind == Some(Word::Iff) {
            self.warn_hint(
                place,
                "pictures of type `iff` are not supported",
                "convert the picture to PNG",
            );
            return Ok(None);
        }
        let mut known = self.state.pictures.iter();
        let known = known.find(|k| k.name == name).map(|k| k.codes);
        let mut file = None;
        let codes = match known {
            Some(codes) => codes,
            None => {
                let file = file.insert(self.read_file(&name, place)?);
                picture_codes(&file.bytes, &name)
            }
        };
        let recoding = Recoding {
            premultiplied,
            ..self.recoding(purpose, gamma, codes)
        };
        let mut known = self.state.pictures.iter();
        if let Some(known) = known.find(|k| k.name == name && k.recoding == recoding) {
            return Ok(Some((Arc::clone(&known.image), Some((name, place)))));
        }
        let from_srgb = Recoding {
            from: WorkingSpace::Srgb,
            ..Recoding::NONE
        };
        // The decoder converts sRGB itself, but only for integer codes.
        let usual = recoding == from_srgb && codes != PictureCodes::Linear;
        // Photographs keep the size they have in the file.
        let texture_use = if usual {
            TextureUse::Color
        } else {
            TextureUse::Data
        };
        let file = match file {
            Some(file) => file,
            None => self.read_file(&name, place)?,
        };
        let image = match decode_texture(&file.bytes, &name, texture_use) {
            Ok(image) if usual => Arc::new(image),
            Ok(image) => Arc::new(recoding.apply(image)),
            Err(error) => return Err(self.fail(place, error.to_string())),
        };
        self.state.pictures.push(KnownPicture {
            name: name.clone(),
            codes,
            recoding,
            image: Arc::clone(&image),
        });
        Ok(Some((image, Some((name, place)))))
    }

    /// The conversion from the codes of a picture to numbers, according to the picture's `gamma`, its file, the scene's version
    /// and `assumed_gamma` so far (measured with all formats under versions 3.0 to 3.7).
    fn recoding(
        &self,
        purpose: Purpose,
        gamma: Option<WorkingSpace>,
        codes: PictureCodes,
    ) -> Recoding {
        let (old, assumed) = (self.before_3_7(), self.state.global.working_space);
        // Data, and pictures in scenes older than `assumed_gamma`, use the codes as numbers; a `gamma` is only a power.
        if purpose == Purpose::Data || old && assumed.is_none() {
            return Recoding {
                from: gamma.unwrap_or(WorkingSpace::Linear),
                ..Recoding::NONE
            };
        }
        let to = assumed.unwrap_or(WorkingSpace::Linear);
        let said = match codes {
            PictureCodes::Linear => Some(WorkingSpace::Linear),
            PictureCodes::Srgb => Some(WorkingSpace::Srgb),
            PictureCodes::Gamma(gamma) => Some(WorkingSpace::Gamma(gamma)),
            PictureCodes::UsuallySrgb => (!old).then_some(WorkingSpace::Srgb),
            PictureCodes::Unsaid => None,
        };
        Recoding {
            from: gamma.or(said).unwrap_or(to),
            to,
            premultiplied: false,
        }
    }

    /// `width, height { function }` after `function`: a picture with 16 bits per channel.
    fn function_picture(&mut self) -> PResult<Arc<TextureImage>> {
        let place = self.place();
        let mut samples = vec![];
        let (width, height) =
            self.sampled_function(|texel| samples.extend(texel.map(in_16_bits)))?;
        let made = TextureImage::try_new(
            width,
            height,
            TexelChannels::Rgba,
            ColorSpace::Linear,
            TexelData::F32(samples),
        );
        made.map(Arc::new)
            .map_err(|error| self.fail(place, error.to_string()))
    }

    /// `width, height { function }` after `function`: its values as red, green, blue and alpha, row by row over the unit square,
    /// whose corners are the corner texels; y points down (measured).
    pub(in crate::grammar) fn sampled_function(
        &mut self,
        mut take: impl FnMut([f64; 4]),
    ) -> PResult<(u32, u32)> {
        let place = self.place();
        let width = self.whole(1, 1 << 20)?;
        self.comma()?;
        let height = self.whole(1, 1 << 20)?;
        if u64::from(width) * u64::from(height) > MAX_FUNCTION_TEXELS {
            let message = format!("a picture of {width} x {height} texels is too large here");
            return Err(self.fail(place, message));
        }
        let (store, cost) = self.picture_function()?;
        let texels = u64::from(width) * u64::from(height);
        self.spend(texels.saturating_mul(cost.operations))?;
        let mut points = Vec::with_capacity(BATCH);
        let mut found = [[0.0; 4]; BATCH];
        for row in 0..height {
            for first in (0..width).step_by(BATCH) {
                let columns = first..width.min(first + BATCH as u32);
                points.clear();
                points.extend(columns.map(|column| {
                    let p = DVec3::new(share(column, width), share(row, height), 0.0);
                    TexturePoint::in_space(p)
                }));
                let found = &mut found[..points.len()];
                store(&points, found);
                found.iter().for_each(|texel| take(*texel));
            }
        }
        Ok((width, height))
    }

    /// The function of a picture made by `{ pigment ... }`, `{ pattern ... }` or a formula, as red, green, blue and alpha, and
    /// the cost of a texel.
    fn picture_function(&mut self) -> PResult<(PictureFunction, Cost)> {
        use strahl_function::ScalarField;
        use strahl_shade::patterns::PatternField;
        let store_gray = |values: &[f64], out: &mut [[f64; 4]]| {
            for (texel, value) in out.iter_mut().zip(values) {
                *texel = [*value, *value, *value, 1.0];
            }
        };
        let inner = self.peek_into_braces()?;
        if inner.is(Word::Pigment) {
            let pigment = self.braces(|p| {
                p.next()?;
                p.free_pigment_block()
            })?;
            let cost = pigment.cost();
            let store = move |points: &[TexturePoint], out: &mut [[f64; 4]]| {
                let mut colors = [ColorFt::default(); BATCH];
                let colors = &mut colors[..points.len()];
                pigment.store_colors(points, colors);
                for (texel, color) in out.iter_mut().zip(colors) {
                    *texel = [color.rgb.r, color.rgb.g, color.rgb.b, 1.0 - color.transmit];
                }
            };
            return Ok((Box::new(store), cost));
        }
        if inner.is(Word::Pattern) {
            let field: PatternField = self.braces(|p| {
                p.next()?;
                p.pattern_block()
            })?;
            let cost = field.cost();
            let store = move |points: &[TexturePoint], out: &mut [[f64; 4]]| {
                let mut values = [0.0; BATCH];
                field.store_values_at(points, &mut values[..points.len()]);
                store_gray(&values, out);
            };
            return Ok((Box::new(store), cost));
        }
        let function = self.nested(Self::function)?;
        let cost = ScalarField::cost(&function);
        let store = move |points: &[TexturePoint], out: &mut [[f64; 4]]| {
            let mut columns = [[0.0; BATCH]; 3];
            for (lane, point) in points.iter().enumerate() {
                for (column, x) in columns.iter_mut().zip(point.position.to_array()) {
                    column[lane] = x;
                }
            }
            let [x, y, z] = columns.each_ref().map(|column| &column[..points.len()]);
            let mut values = [0.0; BATCH];
            ScalarField::store_values(&function, &[x, y, z], &mut values[..points.len()]);
            store_gray(&values, out);
        };
        Ok((Box::new(store), cost))
    }

    fn bitmap_item(
        &mut self,
        map: &mut ImageMap,
        file: Option<&PictureFile>,
        token: Token,
    ) -> PResult<bool> {
        let place = self.place_of(token);
        match token.word() {
            Some(Word::MapType) => {
                self.take(token)?;
                let number = self.whole(0, 7)?;
                match MapType::from_number(number) {
                    Some(map_type) => map.map_type = map_type,
                    None => self.warn_hint(
                        place,
                        format!("map_type {number} is not supported and counts as 0"),
                        "supported are 0 (planar), 1 (spherical), 2 (cylindrical) and 5 (toroidal)",
                    ),
                }
            }
            Some(Word::Interpolate) => {
                self.take(token)?;
                map.interpolation = match self.whole(0, 4)? {
                    0 | 1 => Interpolation::Nearest,
                    4 => Interpolation::NormalizedDistance,
                    2 => Interpolation::Bilinear,
                    _ => Interpolation::Bicubic,
                };
            }
            Some(Word::Once) => {
                self.take(token)?;
                map.once = self.flag()?;
            }
            Some(Word::UseAlpha) => {
                self.take(token)?;
                map.use_alpha = true;
            }
            Some(Word::UseColor | Word::UseColour) => {
                self.take(token)?;
                map.use_alpha = false;
            }
            // It counts in a `bump_map` only (measured).
            Some(Word::UseIndex) => self.take(token)?,
            Some(word @ (Word::Filter | Word::Transmit)) => {
                self.take(token)?;
                self.picture_transparency(map, file, word)?;
            }
            _ => return Ok(false),
        }
        // A separator between items in old scenes.
        if self.peek()?.kind == Kind::Comma {
            self.comma()?;
        }
        Ok(true)
    }
}

/// The position of a texel among `count`, from 0 to 1.
fn share(index: u32, count: u32) -> f64 {
    if count > 1 {
        f64::from(index) / f64::from(count - 1)
    } else {
        0.0
    }
}

/// A value as stored in a picture with 16 bits per channel, as function images are: values outside of 0 to 1 lose their higher
/// bits (measured).
fn in_16_bits(x: f64) -> f32 {
    // The cast truncates and saturates.
    let code = ((x * 65_535.0) as i64).rem_euclid(65_536);
    (code as f64 / 65_535.0) as f32
}

/// The replacement for an unsupported picture: one grey texel.
fn blank() -> Arc<TextureImage> {
    use std::sync::LazyLock;
    static BLANK: LazyLock<Option<Arc<TextureImage>>> = LazyLock::new(|| {
        let data = TexelData::U8(vec![128]);
        TextureImage::try_new(1, 1, TexelChannels::Gray, ColorSpace::Srgb, data)
            .ok()
            .map(Arc::new)
    });
    BLANK
        .as_ref()
        .map(Arc::clone)
        .expect("one sample is a picture of one texel")
}
