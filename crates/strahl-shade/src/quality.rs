//! Reduced quality: what quick pictures leave out of textures, materials and lights.

use crate::patterns::{Pattern, PatternField};
use crate::pigment::Pigment;
use crate::texture::Texture;
use crate::{Light, Material};
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

/// How much of a scene its pictures show: a level from 0 to 9, with POV-Ray's meaning (`+Q`, measured).
///
/// | from level | pictures show |
/// |---|---|
/// | 0 | colours as they are, without light |
/// | 2 | ambient, emitted and diffuse light and highlights, all lights unshadowed |
/// | 4 | shadows, those of area lights as of lights at their centres |
/// | 5 | the shadows of area lights |
/// | 6 | full pigments in place of `quick_color`; transparency with refraction, total reflection included |
/// | 8 | reflection; normals of textures (bumps) |
/// | 9 | fog and rainbows: the full quality |
///
/// Patterns of pigments are seen at all levels; at level 0, of layered textures the lowest layer that is not covered. Surfaces are opaque
/// below level 6, but light from light sources passes them as at full quality.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Quality(u8);

impl Quality {
    /// Everything.
    pub const FULL: Self = Self(9);

    /// The quality of a level; levels above 9 are 9.
    pub const fn new(level: u8) -> Self {
        Self(if level > 9 { 9 } else { level })
    }

    /// The level, 0 to 9.
    pub const fn level(self) -> u8 {
        self.0
    }

    /// Whether nothing is left out.
    pub const fn is_full(self) -> bool {
        self.0 >= 9
    }

    /// Whether surfaces show their colours as they are, without light.
    pub const fn is_unlit(self) -> bool {
        self.0 < 2
    }

    /// Whether objects cast shadows.
    pub const fn has_shadows(self) -> bool {
        self.0 >= 4
    }

    /// Whether area lights have an extent.
    pub const fn has_area_lights(self) -> bool {
        self.0 >= 5
    }

    /// Whether the quick colours of pigments take the place of the pigments.
    pub const fn has_quick_colors(self) -> bool {
        self.0 < 6
    }

    /// Whether rays pass through transparent surfaces.
    pub const fn has_transparency(self) -> bool {
        self.0 >= 6
    }

    /// Whether surfaces reflect other objects.
    pub const fn has_reflection(self) -> bool {
        self.0 >= 8
    }

    /// Whether textures tilt normals.
    pub const fn has_normals(self) -> bool {
        self.0 >= 8
    }

    /// Whether there are fog and rainbows.
    pub const fn has_air(self) -> bool {
        self.0 >= 9
    }
}

impl Default for Quality {
    fn default() -> Self {
        Self::FULL
    }
}

impl fmt::Display for Quality {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// The text is no level of quality.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("expected a quality from 0 to 11, found `{0}`")]
pub struct UnknownQuality(String);

impl FromStr for Quality {
    type Err = UnknownQuality;

    /// Reads a level from 0 to 11; as in POV-Ray, 10 and 11 are 9.
    fn from_str(s: &str) -> Result<Self, UnknownQuality> {
        let level = s.parse().ok().filter(|level| *level <= 11);
        level.map(Self::new).ok_or_else(|| UnknownQuality(s.into()))
    }
}

impl Material {
    /// The material as pictures of this quality show it, where that is a material of its own. What rays do at its surface besides is up to who traces
    /// them: reflection and transparency stay, because shadows depend on them.
    ///
    /// `texture` does the same for textures that several materials may share.
    pub fn of_quality(
        &self,
        quality: Quality,
        mut texture: impl FnMut(&Arc<Texture>) -> Option<Arc<Texture>>,
    ) -> Option<Self> {
        let mut of = |shared: &Option<crate::texture::SharedTexture>| {
            let other = texture(&shared.as_ref()?.0)?;
            Some(crate::texture::SharedTexture(other))
        };
        let (outer, inner) = (of(&self.texture), of(&self.inner_texture));
        let is_bumpy = |pbr: &crate::Pbr| pbr.textures.normal.is_some();
        let flattens = !quality.has_normals() && self.pbr.as_deref().is_some_and(is_bumpy);
        if outer.is_none() && inner.is_none() && !flattens {
            return None;
        }
        let mut material = self.clone();
        material.texture = outer.or(material.texture);
        material.inner_texture = inner.or(material.inner_texture);
        if flattens && let Some(pbr) = &mut material.pbr {
            pbr.textures.normal = None;
        }
        Some(material)
    }
}

impl Texture {
    /// The texture as pictures of this quality show it, if it is another one: with quick colours or without, with normals or without.
    pub fn of_quality(&self, quality: Quality) -> Option<Self> {
        if !self.changes(quality) {
            return None;
        }
        let mut texture = self.clone();
        texture.change(quality);
        Some(texture)
    }

    fn changes(&self, quality: Quality) -> bool {
        let in_map = |texture: &Self| texture.changes(quality);
        match self {
            Self::Plain(plain) => {
                plain.pigment.has_quick() || plain.normal.is_some() && !quality.has_normals()
            }
            Self::Layered(list) | Self::MaterialMap(_, _, list) | Self::Shared(_, list) => {
                list.iter().any(in_map)
            }
            Self::Map(field, map) => {
                field.has_quick() || map.entries.iter().any(|(_, texture)| in_map(texture))
            }
            Self::Blocks(field, list) => field.has_quick() || list.iter().any(in_map),
            Self::Average(list, _) => list.iter().any(|(_, texture)| in_map(texture)),
            Self::Transformed(_, inner) | Self::UvMapped(inner) => in_map(inner),
        }
    }

    fn change(&mut self, quality: Quality) {
        let quick = quality.has_quick_colors();
        match self {
            Self::Plain(plain) => {
                plain.pigment.change(quick);
                if !quality.has_normals() {
                    plain.normal = None;
                }
            }
            Self::Layered(list) | Self::MaterialMap(_, _, list) | Self::Shared(_, list) => {
                list.make_mut()
                    .iter_mut()
                    .for_each(|texture| texture.change(quality));
            }
            Self::Map(field, map) => {
                field.change(quick);
                let entries = map.entries.make_mut().iter_mut();
                entries.for_each(|(_, texture)| texture.change(quality));
            }
            Self::Blocks(field, list) => {
                field.change(quick);
                list.make_mut()
                    .iter_mut()
                    .for_each(|texture| texture.change(quality));
            }
            Self::Average(list, _) => {
                let entries = list.make_mut().iter_mut();
                entries.for_each(|(_, texture)| texture.change(quality));
            }
            Self::Transformed(_, inner) | Self::UvMapped(inner) => inner.change(quality),
        }
    }
}

impl Pigment {
    /// The pigment as pictures of this quality show it, if it is another one: with quick colours or without.
    pub fn of_quality(&self, quality: Quality) -> Option<Self> {
        if !self.has_quick() {
            return None;
        }
        let mut pigment = self.clone();
        pigment.change(quality.has_quick_colors());
        Some(pigment)
    }

    /// Whether there is a quick colour in it.
    fn has_quick(&self) -> bool {
        match self {
            Self::Quick(..) => true,
            Self::Solid(..) | Self::Image(..) => false,
            Self::ColorMap(field, _) => field.has_quick(),
            Self::PigmentMap(field, map) => {
                field.has_quick() || map.entries.iter().any(|(_, p)| p.has_quick())
            }
            Self::Blocks(field, list) => field.has_quick() || list.iter().any(Self::has_quick),
            Self::Average(list, _) => list.iter().any(|(_, p)| p.has_quick()),
            Self::UvMapped(inner) => inner.has_quick(),
        }
    }

    /// Replaces pigments with a quick colour by that colour, or else by what they are without it.
    fn change(&mut self, quick: bool) {
        match self {
            Self::Quick(color, _) if quick => *self = Self::Solid(*color, None),
            Self::Quick(_, inner) => {
                inner.change(quick);
                *self = std::mem::take(&mut **inner);
            }
            Self::Solid(..) | Self::Image(..) => {}
            Self::ColorMap(field, _) => field.change(quick),
            Self::PigmentMap(field, map) => {
                field.change(quick);
                map.entries
                    .make_mut()
                    .iter_mut()
                    .for_each(|(_, p)| p.change(quick));
            }
            Self::Blocks(field, list) => {
                field.change(quick);
                list.make_mut().iter_mut().for_each(|p| p.change(quick));
            }
            Self::Average(list, _) => list
                .make_mut()
                .iter_mut()
                .for_each(|(_, p)| p.change(quick)),
            Self::UvMapped(inner) => inner.change(quick),
        }
    }
}

impl PatternField {
    fn has_quick(&self) -> bool {
        matches!(&self.pattern, Pattern::Pigment(pigment) if pigment.has_quick())
    }

    fn change(&mut self, quick: bool) {
        if let Pattern::Pigment(pigment) = &mut self.pattern
            && pigment.has_quick()
        {
            Arc::make_mut(pigment).change(quick);
        }
    }
}

impl Light {
    /// The light as pictures of this quality show it.
    #[must_use]
    pub fn of_quality(mut self, quality: Quality) -> Self {
        if !quality.has_area_lights() {
            self.area = None;
        }
        self.casts_shadows &= quality.has_shadows();
        self
    }
}

#[cfg(test)]
mod tests;
