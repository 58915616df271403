//! The size of textures: textures made of copies of each other must end in an error, and not exhaust the machine.

use crate::parser::{PResult, Parser};
use strahl_shade::normal::{NormalKind, PovNormal};
use strahl_shade::pigment::Pigment;
use strahl_shade::texture::Texture;

/// The size of a texture, pigment or normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Weight {
    /// The number of nodes in it, including itself.
    count: u64,
    /// The depth of nesting.
    depth: u32,
}

impl Weight {
    const ONE: Self = Self { count: 1, depth: 1 };

    /// The weight of a node with children of these weights.
    fn around(inner: impl Iterator<Item = Self>) -> Self {
        let sum = inner.fold(Self { count: 0, depth: 0 }, |sum, w| Self {
            count: sum.count.saturating_add(w.count),
            depth: sum.depth.max(w.depth),
        });
        Self {
            count: sum.count.saturating_add(1),
            depth: sum.depth.saturating_add(1),
        }
    }
}

pub(super) fn of_pigment(pigment: &Pigment) -> Weight {
    match pigment {
        Pigment::Solid(..) | Pigment::ColorMap(..) | Pigment::Image(..) => Weight::ONE,
        Pigment::PigmentMap(_, map) => Weight::around(map.entries.iter().map(|e| of_pigment(&e.1))),
        Pigment::Average(list, _) => Weight::around(list.iter().map(|e| of_pigment(&e.1))),
        Pigment::Blocks(_, list) => Weight::around(list.iter().map(of_pigment)),
        Pigment::UvMapped(inner) | Pigment::Quick(_, inner) => {
            Weight::around(std::iter::once(of_pigment(inner)))
        }
    }
}

pub(super) fn of_normal(normal: &PovNormal) -> Weight {
    match &normal.kind {
        NormalKind::Map(_, map) => Weight::around(map.entries.iter().map(|e| of_normal(&e.1))),
        NormalKind::Average(list) => Weight::around(list.iter().map(|e| of_normal(&e.1))),
        NormalKind::Blocks(_, list) => Weight::around(list.iter().map(of_normal)),
        NormalKind::Bumps
        | NormalKind::Dents
        | NormalKind::Wrinkles
        | NormalKind::Ripples(_)
        | NormalKind::Waves(_)
        | NormalKind::Quilted(_)
        | NormalKind::Facets(_)
        | NormalKind::Height(..)
        | NormalKind::BumpMap(_) => Weight::ONE,
    }
}

pub(super) fn of_texture(texture: &Texture) -> Weight {
    match texture {
        Texture::Plain(plain) => {
            let normal = plain.normal.as_deref().map(of_normal);
            Weight::around(std::iter::once(of_pigment(&plain.pigment)).chain(normal))
        }
        Texture::Layered(list)
        | Texture::Blocks(_, list)
        | Texture::MaterialMap(_, _, list)
        | Texture::Shared(_, list) => Weight::around(list.iter().map(of_texture)),
        Texture::Map(_, map) => Weight::around(map.entries.iter().map(|e| of_texture(&e.1))),
        Texture::Average(list, _) => Weight::around(list.iter().map(|e| of_texture(&e.1))),
        Texture::Transformed(_, inner) | Texture::UvMapped(inner) => {
            Weight::around(std::iter::once(of_texture(inner)))
        }
    }
}

impl Parser<'_> {
    /// Counts a weight against the limits.
    ///
    /// # Errors
    /// If it is nested too deep, or all textures together are too large.
    pub(super) fn weigh(&mut self, weight: Weight) -> PResult<()> {
        /// A pigment, normal or texture takes as much memory as this many colours or vectors.
        const SIZE: u64 = 16;
        let limit = self.options.limits.texture_depth;
        if weight.depth > limit {
            let place = self.place();
            return Err(self.fail_hint(
                place,
                format!("textures are nested deeper than {limit} levels"),
                "write the texture in fewer levels, or raise the limit: `--limit texture_depth=N`",
            ));
        }
        // A texture that doubles repeatedly is detected long before it reaches the limit for all textures.
        let limit = self.options.limits.parts >> 11;
        if weight.count > limit {
            let place = self.place();
            return Err(self.fail_fatally(
                place,
                format!("this texture has more than {limit} parts, counting copies"),
                "check for a texture that doubles repeatedly, or raise the limit of all parts: `--limit parts=N`",
            ));
        }
        // A single part is counted with its object.
        if weight.count > 1 {
            self.count_parts(weight.count.saturating_mul(SIZE))?;
        }
        Ok(())
    }

    /// Checks that a colour of a pigment can be computed within the limit of a function.
    ///
    /// # Errors
    /// If its functions take more.
    pub(super) fn check_cost(&mut self, pigment: &Pigment) -> PResult<()> {
        let (cost, limit) = (pigment.cost().operations, self.options.limits.function_cost);
        if cost <= limit {
            return Ok(());
        }
        let place = self.place();
        Err(self.fail_hint(
            place,
            format!(
                "a colour of this pigment takes {cost} operations, at most {limit} are allowed"
            ),
            "simplify its functions and averages, or raise the limit: `--limit function_cost=N`",
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_shade::patterns::Pattern;
    use strahl_shade::pigment::BlendMap;

    #[test]
    fn all_members_count() {
        let solid = Pigment::default();
        let map = BlendMap::new(vec![(0.0, solid.clone()), (1.0, solid.clone())]);
        let two = Pigment::PigmentMap(Pattern::Bozo.into(), map);
        assert_eq!(of_pigment(&two), Weight { count: 3, depth: 2 });
        let outer = Pigment::Blocks(Pattern::Checker.into(), vec![solid, two].into());
        assert_eq!(of_pigment(&outer), Weight { count: 5, depth: 3 });
    }
}
