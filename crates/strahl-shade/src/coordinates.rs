//! Which textures use the surface's own coordinates (`uv_mapping`): for the others these need not be computed.

use crate::Material;
use crate::normal::{NormalKind, PovNormal};
use crate::patterns::{Pattern, PatternField};
use crate::pigment::Pigment;
use crate::texture::Texture;

impl Material {
    /// Whether the material uses texture coordinates.
    pub fn uses_uv(&self) -> bool {
        let textures = [&self.texture, &self.inner_texture];
        self.pbr.is_some() || textures.into_iter().flatten().any(|t| t.0.uses_uv())
    }
}

impl Texture {
    /// Whether the texture uses texture coordinates somewhere.
    pub fn uses_uv(&self) -> bool {
        match self {
            Self::Plain(plain) => {
                plain.pigment.uses_uv() || plain.normal.as_ref().is_some_and(|n| n.uses_uv())
            }
            Self::Layered(textures)
            | Self::MaterialMap(_, _, textures)
            | Self::Shared(_, textures) => textures.iter().any(Self::uses_uv),
            Self::Map(field, map) => {
                field.uses_uv() || map.entries.iter().any(|(_, t)| t.uses_uv())
            }
            Self::Blocks(field, textures) => field.uses_uv() || textures.iter().any(Self::uses_uv),
            Self::Average(members, _) => members.iter().any(|(_, t)| t.uses_uv()),
            Self::Transformed(_, inner) => inner.uses_uv(),
            Self::UvMapped(_) => true,
        }
    }
}

impl Pigment {
    /// Whether the pigment uses texture coordinates somewhere.
    pub fn uses_uv(&self) -> bool {
        match self {
            Self::Solid(..) | Self::Image(..) => false,
            Self::ColorMap(field, _) => field.uses_uv(),
            Self::PigmentMap(field, map) => {
                field.uses_uv() || map.entries.iter().any(|(_, p)| p.uses_uv())
            }
            Self::Blocks(field, pigments) => field.uses_uv() || pigments.iter().any(Self::uses_uv),
            Self::Average(members, _) => members.iter().any(|(_, p)| p.uses_uv()),
            Self::UvMapped(_) => true,
            Self::Quick(_, pigment) => pigment.uses_uv(),
        }
    }
}

impl PovNormal {
    fn uses_uv(&self) -> bool {
        self.uv_mapped || self.kind.uses_uv()
    }
}

impl NormalKind {
    fn uses_uv(&self) -> bool {
        match self {
            Self::Height(pattern, _) => pattern.uses_uv(),
            Self::Map(pattern, map) => {
                pattern.uses_uv() || map.entries.iter().any(|(_, n)| n.uses_uv())
            }
            Self::Blocks(pattern, normals) => {
                pattern.uses_uv() || normals.iter().any(PovNormal::uses_uv)
            }
            Self::Average(members) => members.iter().any(|(_, n)| n.uses_uv()),
            Self::Bumps
            | Self::Dents
            | Self::Wrinkles
            | Self::Ripples(_)
            | Self::Waves(_)
            | Self::Quilted(_)
            | Self::Facets(_)
            | Self::BumpMap(_) => false,
        }
    }
}

impl PatternField {
    fn uses_uv(&self) -> bool {
        self.pattern.uses_uv()
    }
}

impl Pattern {
    /// Functions know only the place.
    fn uses_uv(&self) -> bool {
        matches!(self, Self::Pigment(pigment) if pigment.uses_uv())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ColorFt;
    use crate::pigment::BlendMap;
    use crate::texture::PlainTexture;
    use std::sync::Arc;

    fn texture(pigment: Pigment, normal: Option<PovNormal>) -> Texture {
        PlainTexture {
            pigment,
            normal: normal.map(Box::new),
            ..PlainTexture::default()
        }
        .into()
    }

    #[test]
    fn coordinates_are_found_wherever_they_are_used() {
        let mapped = || Pigment::UvMapped(Box::default());
        let plain = texture(Pigment::default(), None);
        assert!(!Material::textured(plain.clone()).uses_uv());
        let height = NormalKind::Height(Pattern::Pigment(Arc::new(mapped())), None);
        let in_map = BlendMap::new(vec![(0.0, Pigment::default()), (1.0, mapped())]);
        let users = [
            texture(mapped(), None),
            texture(Pigment::PigmentMap(Pattern::Bozo.into(), in_map), None),
            texture(
                Pigment::ColorMap(
                    Pattern::Pigment(Arc::new(mapped())).into(),
                    BlendMap::new(vec![(0.0, ColorFt::default())]),
                ),
                None,
            ),
            texture(Pigment::default(), Some(PovNormal::new(height))),
            Texture::Layered(vec![plain.clone(), texture(mapped(), None)].into()),
            Texture::UvMapped(Box::new(plain)),
        ];
        for user in users {
            assert!(Material::textured(user.clone()).uses_uv(), "{user:?}");
        }
    }
}
