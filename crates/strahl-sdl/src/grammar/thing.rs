use super::{Declared, Texture, by_word};
use crate::expr::PigmentFunction;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};
use crate::value::Value;
use std::sync::Arc;
use strahl_math::Transform;
use strahl_scene::{Camera, Fog, Rainbow, SkySphere};
use strahl_shade::ColorFt;
use strahl_shade::interior::Interior;
use strahl_shade::normal::PovNormal;
use strahl_shade::pigment::{BlendMap, Pigment};
use strahl_shade::pov_finish::PovFinish;
use strahl_shade::texture::Texture as Surface;

macro_rules! things {
    ($($kind:ident($payload:ty) $text:literal)*) => {
        /// The value of a name other than numbers, strings and arrays: each kind with its typed payload.
        #[derive(Clone, Debug)]
        pub enum Thing {
            $(#[doc = $text] $kind(Arc<$payload>),)*
        }

        impl Thing {
            /// Its kind in words, for messages.
            pub fn describe(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => $text,)*
                }
            }
        }
    };
}

things! {
    Camera(Camera) "a camera"
    ColorMap(BlendMap<ColorFt>) "a colour map"
    Finish(PovFinish) "a finish"
    Fog(Fog) "a fog"
    Interior(Interior) "an interior"
    Material(Texture) "a material"
    Normal(PovNormal) "a normal"
    NormalMap(BlendMap<PovNormal>) "a normal map"
    Object(Declared) "an object"
    Pigment(Pigment) "a pigment"
    PigmentFunction(PigmentFunction) "a function made of a pigment"
    PigmentMap(BlendMap<Pigment>) "a pigment map"
    Rainbow(Rainbow) "a rainbow"
    SkySphere(SkySphere) "a sky sphere"
    SlopeMap(BlendMap<[f64; 2]>) "a slope map"
    Texture(Surface) "a texture"
    TextureMap(BlendMap<Surface>) "a texture map"
    Transform(Transform) "a transformation"
    TransformFunction(Transform) "a function made of a transformation"
}

/// Reads a thing; its keyword is taken.
type ThingParser = fn(&mut Parser<'_>) -> PResult<Thing>;

/// The things, other than objects, that can be on the right of `#declare`.
static THINGS: [Option<ThingParser>; Word::ALL.len()] = by_word::<ThingParser, _>([
    (Word::Camera, |p| Ok(Thing::Camera(Arc::new(p.camera()?)))),
    (Word::ColorMap, color_map),
    (Word::ColourMap, color_map),
    (Word::Finish, |p| Ok(Thing::Finish(p.finish_block()?))),
    (Word::Fog, |p| Ok(Thing::Fog(Arc::new(p.fog()?)))),
    (Word::Interior, |p| {
        Ok(Thing::Interior(Arc::new(p.interior_block(None)?)))
    }),
    (Word::Material, |p| {
        Ok(Thing::Material(Arc::new(p.declared_material()?)))
    }),
    (Word::Normal, |p| {
        Ok(Thing::Normal(Arc::new(p.normal_block()?)))
    }),
    (Word::NormalMap, |p| {
        Ok(Thing::NormalMap(Arc::new(p.normal_map()?)))
    }),
    (Word::Pigment, |p| {
        Ok(Thing::Pigment(Arc::new(p.pigment_block()?)))
    }),
    (Word::PigmentMap, |p| {
        Ok(Thing::PigmentMap(Arc::new(p.pigment_map()?)))
    }),
    (Word::Rainbow, |p| {
        Ok(Thing::Rainbow(Arc::new(p.rainbow()?)))
    }),
    (Word::SkySphere, |p| {
        Ok(Thing::SkySphere(Arc::new(p.sky_sphere()?)))
    }),
    (Word::SlopeMap, |p| {
        Ok(Thing::SlopeMap(Arc::new(p.slope_map()?.0)))
    }),
    (Word::Texture, |p| p.declared_texture().map(Thing::Texture)),
    (Word::TextureMap, |p| {
        Ok(Thing::TextureMap(Arc::new(p.texture_map()?)))
    }),
    (Word::Transform, |p| {
        Ok(Thing::Transform(Arc::new(p.transform_block()?)))
    }),
]);

fn color_map(p: &mut Parser<'_>) -> PResult<Thing> {
    Ok(Thing::ColorMap(Arc::new(p.color_map()?)))
}

impl Parser<'_> {
    /// Reads a thing that is written out (`sphere { ... }`, `texture { ... }`), if one follows.
    ///
    /// # Errors
    /// If the thing is invalid.
    pub(crate) fn thing(&mut self, token: Token) -> PResult<Option<Thing>> {
        let word = token.word().map_or(usize::MAX, |w| w as usize);
        if let Some(parse) = THINGS.get(word).copied().flatten() {
            self.take(token)?;
            return self.nested(parse).map(Some);
        }
        let entity = self.entity()?;
        let declared = entity.map(|e| Declared::new(e, &self.state.shared));
        Ok(declared.map(|d| Thing::Object(Arc::new(d))))
    }

    /// Takes the name of a thing of one kind, if one follows, and returns the thing.
    ///
    /// # Errors
    /// If a directive before it fails.
    pub(crate) fn accept_thing<T>(
        &mut self,
        pick: impl FnOnce(&Thing) -> Option<&Arc<T>>,
    ) -> PResult<Option<Arc<T>>> {
        let token = self.peek()?;
        let (Kind::Name, Some(symbol)) = (token.kind, token.symbol()) else {
            return Ok(None);
        };
        let found = match self.scopes.find(symbol) {
            Some(Value::Thing(thing)) => pick(thing).cloned(),
            Some(Value::Array(_) | Value::Dictionary(_)) => {
                let place = self.place_of(token);
                let value = self.value()?;
                return match &value {
                    Value::Thing(thing) => match pick(thing) {
                        Some(found) => Ok(Some(Arc::clone(found))),
                        None => Err(self.fail(
                            place,
                            format!(
                                "this element is {} and cannot be used here",
                                thing.describe()
                            ),
                        )),
                    },
                    other => Err(self.fail(
                        place,
                        format!(
                            "this element is {} and cannot be used here",
                            other.describe()
                        ),
                    )),
                };
            }
            _ => None,
        };
        if found.is_some() {
            self.take(token)?;
        }
        Ok(found)
    }
}
