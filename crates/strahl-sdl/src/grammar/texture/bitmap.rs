//! Pictures in textures: `image_map`, `image_pattern`, `bump_map` and `material_map`.

use crate::keywords::Word;
use crate::parser::{PResult, Parser, Place};
use crate::token::{Kind, Token};
use std::sync::Arc;
use strahl_formats::image::{TextureUse, decode_heights, decode_texture};
use strahl_function::Cost;
use strahl_math::{DVec3, det};
use strahl_shade::image_map::{ImageMap, Interpolation, MapType};
use strahl_shade::image_texture::{ColorSpace, TexelChannels, TexelData, TextureImage};

/// The red, green, blue and alpha at a point.
type PictureFunction = Box<dyn Fn(DVec3) -> [f64; 4]>;

/// How the codes of a file become numbers.
#[derive(Clone, Copy, PartialEq)]
enum Gamma {
    /// As files of colours have them: by sRGB's function.
    Srgb,
    /// In proportion.
    Linear,
    /// By a power.
    Power(f64),
}

/// A picture that has been decoded, and how it was asked for: loops and macros ask again and again.
#[derive(Debug)]
pub(in crate::grammar) struct KnownPicture {
    name: String,
    linear: bool,
    image: Arc<TextureImage>,
}

/// The largest picture made by a function.
const MAX_FUNCTION_TEXELS: u64 = 1 << 24;

impl Parser<'_> {
    /// The braces of `image_map`; `None` for a picture that is not supported.
    pub(super) fn color_bitmap(&mut self) -> PResult<Option<Arc<ImageMap>>> {
        self.bitmap(|p| p.picture_file(Gamma::Srgb), |_, _, _| Ok(false))
    }

    /// The braces of `image_pattern`.
    pub(super) fn pattern_bitmap(&mut self) -> PResult<Arc<ImageMap>> {
        let image = self.bitmap(|p| p.picture_file(Gamma::Linear), |_, _, _| Ok(false))?;
        Ok(image.unwrap_or_else(|| Arc::new(ImageMap::new(blank()))))
    }

    /// The braces of `bump_map`, with the `bump_size` in them.
    pub(super) fn bump_bitmap(&mut self) -> PResult<(Option<Arc<ImageMap>>, Option<f64>)> {
        let mut size = None;
        let image = self.bitmap(
            |p| p.picture_file(Gamma::Linear),
            |p, _, token| {
                if !token.is(Word::BumpSize) {
                    return Ok(false);
                }
                p.take(token)?;
                size = Some(p.float()?);
                Ok(true)
            },
        )?;
        Ok((image, size))
    }

    /// The braces of `material_map`; `other` reads what is no matter of the picture.
    pub(super) fn material_bitmap(
        &mut self,
        mut other: impl FnMut(&mut Self, Token) -> PResult<bool>,
    ) -> PResult<Option<Arc<ImageMap>>> {
        self.bitmap(Self::codes_file, |p, _, token| other(p, token))
    }

    /// `[type] "file"`: the code of each texel, as red. It is the index of pictures with a palette, red or the grey of others.
    fn codes_file(&mut self) -> PResult<Option<Arc<TextureImage>>> {
        self.picture_type()?;
        let name = self.file_name()?;
        let place = self.place();
        let file = self.read_file(&name, place)?;
        let codes = match decode_heights(&file.bytes, &name) {
            Ok(codes) => codes,
            Err(error) => return Err(self.fail(place, error.to_string())),
        };
        // Heights have the code in their upper byte.
        let texels = codes.values.iter().map(|value| (value >> 8) as u8);
        let image = TextureImage::try_new(
            codes.width,
            codes.height,
            TexelChannels::Gray,
            ColorSpace::Linear,
            TexelData::U8(texels.collect()),
        );
        match image {
            Ok(image) => Ok(Some(Arc::new(image))),
            Err(error) => Err(self.fail(place, error.to_string())),
        }
    }

    fn bitmap(
        &mut self,
        picture_file: impl FnOnce(&mut Self) -> PResult<Option<Arc<TextureImage>>>,
        mut other: impl FnMut(&mut Self, &mut ImageMap, Token) -> PResult<bool>,
    ) -> PResult<Option<Arc<ImageMap>>> {
        self.braces(|p| {
            let token = p.peek()?;
            let image = if token.is(Word::Function) {
                p.take(token)?;
                Some(p.function_picture()?)
            } else {
                picture_file(p)?
            };
            let supported = image.is_some();
            let mut map = ImageMap::new(image.unwrap_or_else(blank));
            p.items("the picture", |p, token| {
                if p.bitmap_item(&mut map, token)? || other(p, &mut map, token)? {
                    return Ok(());
                }
                p.skip_item(token, "the picture")
            })?;
            Ok(supported.then(|| Arc::new(map)))
        })
    }

    /// The type of a picture file, if it is named.
    pub(in crate::grammar) fn picture_type(&mut self) -> PResult<Option<Word>> {
        let token = self.peek()?;
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
    fn picture_file(&mut self, mut gamma: Gamma) -> PResult<Option<Arc<TextureImage>>> {
        let kind = self.picture_type()?;
        let name = self.file_name()?;
        let place = self.place();
        loop {
            let token = self.peek()?;
            match token.word() {
                Some(Word::Gamma) => {
                    self.take(token)?;
                    gamma = if self.accept_word(Word::Srgb)? {
                        Gamma::Srgb
                    } else {
                        match self.float()? {
                            1.0 => Gamma::Linear,
                            power => Gamma::Power(power),
                        }
                    };
                }
                Some(Word::Premultiplied) => {
                    self.take(token)?;
                    if self.flag()? {
                        self.warn_hint(
                            place,
                            "`premultiplied` is not supported yet and is left out",
                            "half transparent texels will be too dark",
                        );
                    }
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
        self.picture(&name, gamma, place).map(Some)
    }

    fn picture(&mut self, name: &str, gamma: Gamma, place: Place) -> PResult<Arc<TextureImage>> {
        let linear = gamma != Gamma::Srgb;
        let known = self.state.pictures.iter();
        let mut known = known.filter(|k| k.name == name && k.linear == linear);
        let image = match known.next() {
            Some(known) => Arc::clone(&known.image),
            None => {
                let file = self.read_file(name, place)?;
                let texture_use = if linear {
                    TextureUse::Data
                } else {
                    TextureUse::Color
                };
                let image = match decode_texture(&file.bytes, name, texture_use) {
                    Ok(image) => Arc::new(image),
                    Err(error) => return Err(self.fail(place, error.to_string())),
                };
                self.state.pictures.push(KnownPicture {
                    name: name.to_owned(),
                    linear,
                    image: Arc::clone(&image),
                });
                image
            }
        };
        match gamma {
            Gamma::Power(power) => Ok(Arc::new(raised(&image, power))),
            _ => Ok(image),
        }
    }

    /// `width, height { function }` behind `function`: a picture of 16 bits.
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

    /// `width, height { function }` behind `function`: its values, as red, green, blue and alpha, row by row over the unit square,
    /// whose corners are the corner texels; y grows downwards (measured).
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
        let (value, cost) = self.picture_function()?;
        let texels = u64::from(width) * u64::from(height);
        self.spend(texels.saturating_mul(cost.operations))?;
        for row in 0..height {
            for column in 0..width {
                let p = DVec3::new(share(column, width), share(row, height), 0.0);
                take(value(p));
            }
        }
        Ok((width, height))
    }

    /// The red, green, blue and alpha of a picture made by `{ pigment ... }`, `{ pattern ... }` or a formula, and what a texel takes.
    fn picture_function(&mut self) -> PResult<(PictureFunction, Cost)> {
        use strahl_function::ScalarField;
        use strahl_shade::patterns::{PatternField, TexturePoint};
        let inner = self.raw_ahead(1);
        if inner.is(Word::Pigment) {
            let pigment = self.braces(|p| {
                p.next()?;
                p.pigment_block()
            })?;
            let cost = pigment.cost();
            let value = move |p| {
                let color = pigment.color_at(&TexturePoint::in_space(p));
                [color.rgb.r, color.rgb.g, color.rgb.b, 1.0 - color.transmit]
            };
            return Ok((Box::new(value), cost));
        }
        if inner.is(Word::Pattern) {
            let field: PatternField = self.braces(|p| {
                p.next()?;
                p.pattern_block()
            })?;
            let cost = field.cost();
            let value = move |p| {
                let value = field.value(&TexturePoint::in_space(p));
                [value, value, value, 1.0]
            };
            return Ok((Box::new(value), cost));
        }
        let function = self.nested(Self::function)?;
        let cost = ScalarField::cost(&function);
        let value = move |p: DVec3| {
            let value = ScalarField::value(&function, &p.to_array());
            [value, value, value, 1.0]
        };
        Ok((Box::new(value), cost))
    }

    fn bitmap_item(&mut self, map: &mut ImageMap, token: Token) -> PResult<bool> {
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
                        "known are 0 (planar), 1 (spherical), 2 (cylindrical) and 5 (toroidal)",
                    ),
                }
            }
            Some(Word::Interpolate) => {
                self.take(token)?;
                map.interpolation = match self.whole(0, 4)? {
                    0 | 1 => Interpolation::Nearest,
                    4 => Interpolation::NormalizedDistance,
                    2 => Interpolation::Bilinear,
                    _ => {
                        self.warn(
                            place,
                            "bicubic interpolation is not supported yet; bilinear is taken",
                        );
                        Interpolation::Bilinear
                    }
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
            Some(word @ (Word::Filter | Word::Transmit)) => {
                self.take(token)?;
                if self.accept_word(Word::All)? {
                    let amount = self.float()?;
                    if word == Word::Filter {
                        map.filter_all = amount;
                    } else {
                        map.transmit_all = amount;
                    }
                } else {
                    self.float()?;
                    self.comma()?;
                    self.float()?;
                    self.warn_hint(
                        place,
                        format!(
                            "`{}` of single palette entries is not supported yet",
                            word.text()
                        ),
                        "give the picture an alpha channel instead",
                    );
                }
            }
            _ => return Ok(false),
        }
        // What separates the items of old scenes.
        if self.peek()?.kind == Kind::Comma {
            self.comma()?;
        }
        Ok(true)
    }
}

/// The place of a texel among `count`, from 0 to 1.
fn share(index: u32, count: u32) -> f64 {
    if count > 1 {
        f64::from(index) / f64::from(count - 1)
    } else {
        0.0
    }
}

/// A value as a picture of 16 bits holds it, which pictures made by functions are (measured).
fn in_16_bits(x: f64) -> f32 {
    ((x.clamp(0.0, 1.0) * 65_535.0).floor() / 65_535.0) as f32
}

/// What stands for a picture that is not supported: one grey texel.
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

/// A picture with its colours raised to a power.
fn raised(image: &TextureImage, power: f64) -> TextureImage {
    let rows = 0..image.height();
    let texels = rows.flat_map(|y| (0..image.width()).map(move |x| image.fetch(x, y)));
    let samples = texels.flat_map(|[r, g, b, a]| {
        let raise = |x: f32| det::pow(f64::from(x), power) as f32;
        [raise(r), raise(g), raise(b), a]
    });
    TextureImage::try_new(
        image.width(),
        image.height(),
        TexelChannels::Rgba,
        ColorSpace::Linear,
        TexelData::F32(samples.collect()),
    )
    .expect("four samples for each texel")
}
