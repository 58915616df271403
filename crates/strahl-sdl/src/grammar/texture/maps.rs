//! Maps: lists of `[position thing]`, which a pattern's value interpolates. Block lists, from which a pattern chooses.

use crate::grammar::Thing;
use crate::keywords::{Word, WordKind};
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};
use strahl_shade::normal::{PovNormal, SlopeMap};
use strahl_shade::patterns::{Modifiers, Pattern};
use strahl_shade::pigment::{BlendMap, Pigment};
use strahl_shade::texture::Texture;
use strahl_shade::{ColorFt, SharedList};

/// A colour of the language as a colour of the renderer.
pub(super) fn color_ft([r, g, b, filter, transmit]: [f64; 5]) -> ColorFt {
    ColorFt {
        rgb: strahl_shade::Color::new(r, g, b),
        filter,
        transmit,
    }
}

/// Whether a modifier repeats or changes a pattern's values. The values of a block pattern are then no longer indices of blocks,
/// but choose from its blocks as from a map (as measured).
pub(super) fn blends_blocks(modifiers: &Modifiers) -> bool {
    modifiers.frequency != 0.0 || modifiers.wave.is_some()
}

/// The blocks of a block pattern as a map, each at its index.
pub(super) fn numbered<T: Clone>(members: &[T]) -> BlendMap<T> {
    let members = members.iter().enumerate();
    let entries = members.map(|(number, member)| (number as f64, member.clone()));
    BlendMap::new(entries.collect::<SharedList<_>>())
}

impl Parser<'_> {
    /// `{ ... }` after `color_map`.
    pub(crate) fn color_map(&mut self) -> PResult<BlendMap<ColorFt>> {
        self.blend_map(
            "`color_map`",
            |thing| match thing {
                Thing::ColorMap(map) => Some(map),
                _ => None,
            },
            Self::color_entry,
        )
    }

    /// `{ ... }` after `pigment_map`.
    pub(crate) fn pigment_map(&mut self) -> PResult<BlendMap<Pigment>> {
        self.blend_map(
            "`pigment_map`",
            |thing| match thing {
                Thing::PigmentMap(map) => Some(map),
                _ => None,
            },
            |p, at, entries| {
                let base = p.default_pigment();
                let pigment = p.nested(|p| p.pigment_items(Kind::RightBracket, base))?;
                entries.push((at, pigment));
                Ok(())
            },
        )
    }

    /// `{ ... }` after `normal_map`.
    pub(crate) fn normal_map(&mut self) -> PResult<BlendMap<PovNormal>> {
        self.blend_map(
            "`normal_map`",
            |thing| match thing {
                Thing::NormalMap(map) => Some(map),
                _ => None,
            },
            |p, at, entries| {
                // Entries change the default normal, as `normal { }` does.
                let base = p.state.default_texture.top().normal.as_deref().cloned();
                let normal = p.nested(|p| p.normal_items(Kind::RightBracket, base))?;
                entries.push((at, normal));
                Ok(())
            },
        )
    }

    /// `{ ... }` after `texture_map`.
    pub(crate) fn texture_map(&mut self) -> PResult<BlendMap<Texture>> {
        self.blend_map(
            "`texture_map`",
            |thing| match thing {
                Thing::TextureMap(map) => Some(map),
                _ => None,
            },
            |p, at, entries| {
                let texture = p.nested(|p| p.texture_items(Kind::RightBracket))?;
                entries.push((at, texture));
                Ok(())
            },
        )
    }

    /// `{ ... }` after `slope_map`.
    pub(crate) fn slope_map(&mut self) -> PResult<SlopeMap> {
        let map = self.blend_map(
            "`slope_map`",
            |thing| match thing {
                Thing::SlopeMap(map) => Some(map),
                _ => None,
            },
            |p, at, entries| {
                entries.push((at, p.vector2()?));
                Ok(())
            },
        )?;
        Ok(SlopeMap(map))
    }

    /// The name of a map, or entries `[position ...]`, whose part after the position is read by `entry`.
    fn blend_map<T: Clone>(
        &mut self,
        what: &str,
        pick: impl Fn(&Thing) -> Option<&std::sync::Arc<BlendMap<T>>>,
        mut entry: impl FnMut(&mut Self, f64, &mut Vec<(f64, T)>) -> PResult<()>,
    ) -> PResult<BlendMap<T>> {
        self.braces(|p| {
            let place = p.place();
            let named = p.accept_thing(pick)?;
            let mut entries = Vec::new();
            p.items(what, |p, token| {
                if token.is(Word::BlendMode) || token.is(Word::BlendGamma) {
                    return p.skip_item(token, what);
                }
                if token.kind != Kind::LeftBracket {
                    return Err(p.unexpected(token, "`[` before an entry of the map, or `}`"));
                }
                p.take(token)?;
                p.count_parts(1)?;
                // The weights of `average` may be omitted.
                let at = if p.starts_number()? { p.float()? } else { 1.0 };
                p.comma()?;
                entry(p, at, &mut entries)?;
                p.expect(Kind::RightBracket)?;
                Ok(())
            })?;
            match named {
                Some(map) if entries.is_empty() => Ok((*map).clone()),
                Some(map) => Ok(BlendMap::new([&*map.entries, &entries].concat())),
                None if entries.is_empty() => {
                    Err(p.fail(place, format!("this {what} has no entries")))
                }
                None => Ok(BlendMap::new(entries)),
            }
        })
    }

    /// `color]`, or in the oldest syntax `end color color]`.
    fn color_entry(&mut self, at: f64, entries: &mut Vec<(f64, ColorFt)>) -> PResult<()> {
        let begins_color = |token: Token| token.word().is_some_and(|w| w.kind() == WordKind::Color);
        if begins_color(self.peek()?) {
            let color = self.color()?;
            entries.push((at, color_ft(color)));
            return Ok(());
        }
        let value = self.expression()?;
        let next = self.peek()?;
        let part = matches!(next.word(), Some(Word::Filter | Word::Transmit));
        match value.as_float() {
            Some(end) if next.kind != Kind::RightBracket && !part => {
                self.comma()?;
                let first = self.color()?;
                self.comma()?;
                let second = self.color()?;
                entries.push((at, color_ft(first)));
                entries.push((end, color_ft(second)));
            }
            _ => {
                let color = self.color_from(value)?;
                entries.push((at, color_ft(color)));
            }
        }
        Ok(())
    }

    /// The map, with a warning if its positions decrease; a position that is not a number becomes that before it.
    pub(super) fn in_order<T: Clone>(&mut self, mut map: BlendMap<T>) -> BlendMap<T> {
        let unknown = map.entries.iter().any(|(at, _)| at.is_nan());
        let falls = unknown || !map.entries.is_sorted_by_key(|(at, _)| *at);
        if unknown {
            let mut before = f64::NEG_INFINITY;
            for (at, _) in map.entries.make_mut() {
                if at.is_nan() {
                    *at = before;
                }
                before = *at;
            }
        }
        if falls {
            let place = self.place();
            self.warn_hint(
                place,
                "the positions in this map decrease",
                "write the entries from the smallest position to the largest",
            );
        }
        map
    }

    /// The blocks of a block pattern, each after a keyword and perhaps items read by `between`; `None` if the pattern has no
    /// blocks or none follow. Missing blocks at the end are filled in.
    pub(super) fn blocks<T: Clone>(
        &mut self,
        pattern: &Pattern,
        word: Word,
        mut between: impl FnMut(&mut Self) -> PResult<()>,
        mut block: impl FnMut(&mut Self) -> PResult<T>,
        missing: impl FnOnce(&Self) -> T,
    ) -> PResult<Option<SharedList<T>>> {
        let Some(count) = pattern.block_count() else {
            return Ok(None);
        };
        // The closing brace of an object pattern is after the object or after the blocks.
        let mut closed = !matches!(pattern, Pattern::Object(_));
        let mut list = vec![];
        while list.len() < count {
            between(self)?;
            let token = self.peek()?;
            if token.is(word) {
                self.take(token)?;
                list.push(self.nested(&mut block)?);
            } else if token.kind == Kind::RightBrace && !closed {
                self.take(token)?;
                closed = true;
            } else {
                break;
            }
        }
        if !closed {
            self.expect(Kind::RightBrace)?;
        }
        if list.is_empty() {
            return Ok(None);
        }
        list.resize(count, missing(self));
        Ok(Some(list.into()))
    }
}
