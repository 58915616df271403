//! `normal { ... }`

use super::maps::{blends_blocks, numbered};
use super::{modifiers, weight};
use crate::grammar::Thing;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};
use strahl_math::Transform;
use strahl_shade::SharedList;
use strahl_shade::normal::{Facets, NormalKind, PovNormal, SlopeMap};
use strahl_shade::patterns::Pattern;
use strahl_shade::pigment::BlendMap;

/// The source of the perturbation.
enum Chooser {
    /// No perturbation.
    Flat,
    Pattern(Pattern),
    Average,
    /// A kind of normal without a pattern.
    Fixed(NormalKind),
    /// A normal in surface coordinates.
    UvMapped(Box<PovNormal>),
}

/// The use of the pattern's value.
enum Choice {
    /// As a height, or by the pattern's own method for normals.
    Own,
    Slopes(SlopeMap),
    Normals(BlendMap<PovNormal>),
    Blocks(SharedList<PovNormal>),
}

impl Choice {
    /// The choice for a pattern that replaces another one: as in pigments, an existing map remains, and existing normals of blocks
    /// become a map at 0, 1, 2 and so on (measured).
    fn of_pattern(self) -> Self {
        match self {
            Self::Blocks(list) => Self::Normals(numbered(&list)),
            other => other,
        }
    }
}

/// A normal being read: its parts may come in any order.
pub(super) struct Draft {
    chooser: Chooser,
    choice: Choice,
    /// Everything but the kind.
    pub(super) normal: PovNormal,
    /// Whether the pattern perturbs the normal by its own method, and not by its value as a height.
    special: bool,
}

/// A normal without perturbation.
pub(super) fn flat() -> PovNormal {
    PovNormal::new(NormalKind::Average(SharedList::default()))
}

impl From<PovNormal> for Draft {
    fn from(mut normal: PovNormal) -> Self {
        if normal.uv_mapped {
            return Self {
                chooser: Chooser::UvMapped(Box::new(normal)),
                choice: Choice::Own,
                normal: flat(),
                special: false,
            };
        }
        let kind = std::mem::replace(&mut normal.kind, NormalKind::Average(SharedList::default()));
        let (chooser, choice, special) = match kind {
            NormalKind::Bumps => (Chooser::Pattern(Pattern::Bozo), Choice::Own, true),
            NormalKind::Dents => (Chooser::Pattern(Pattern::Dents), Choice::Own, true),
            NormalKind::Wrinkles => (Chooser::Pattern(Pattern::Wrinkles), Choice::Own, true),
            NormalKind::Ripples(sources) => (
                Chooser::Pattern(Pattern::Ripples { sources }),
                Choice::Own,
                true,
            ),
            NormalKind::Waves(sources) => (
                Chooser::Pattern(Pattern::Waves { sources }),
                Choice::Own,
                true,
            ),
            NormalKind::Quilted([control0, control1]) => (
                Chooser::Pattern(Pattern::Quilted { control0, control1 }),
                Choice::Own,
                true,
            ),
            NormalKind::Height(pattern, None) => (Chooser::Pattern(pattern), Choice::Own, false),
            NormalKind::Height(pattern, Some(map)) => {
                (Chooser::Pattern(pattern), Choice::Slopes(map), false)
            }
            NormalKind::Map(pattern, map) => {
                (Chooser::Pattern(pattern), Choice::Normals(map), false)
            }
            NormalKind::Blocks(pattern, list) => {
                (Chooser::Pattern(pattern), Choice::Blocks(list), false)
            }
            NormalKind::Average(members) if members.is_empty() => {
                (Chooser::Flat, Choice::Own, false)
            }
            NormalKind::Average(members) => (
                Chooser::Average,
                Choice::Normals(BlendMap::new(members)),
                false,
            ),
            fixed => (Chooser::Fixed(fixed), Choice::Own, false),
        };
        Self {
            chooser,
            choice,
            normal,
            special,
        }
    }
}

impl Draft {
    pub(super) fn finish(self) -> PovNormal {
        let kind = match (self.chooser, self.choice) {
            (Chooser::Flat, _) => NormalKind::Average(SharedList::default()),
            (Chooser::Fixed(kind), _) => kind,
            (Chooser::UvMapped(normal), _) => return *normal,
            (Chooser::Average, Choice::Normals(map)) => NormalKind::Average(map.entries),
            (Chooser::Average, _) => NormalKind::Average(SharedList::default()),
            (Chooser::Pattern(pattern), Choice::Normals(map)) => NormalKind::Map(pattern, map),
            (Chooser::Pattern(pattern), Choice::Blocks(list))
                if blends_blocks(&self.normal.modifiers) =>
            {
                NormalKind::Map(pattern, numbered(&list))
            }
            (Chooser::Pattern(pattern), Choice::Blocks(list)) => NormalKind::Blocks(pattern, list),
            (Chooser::Pattern(pattern), choice) => match pattern {
                // These have no height that a slope map could change (as measured).
                Pattern::Bozo if self.special => NormalKind::Bumps,
                Pattern::Dents => NormalKind::Dents,
                Pattern::Wrinkles => NormalKind::Wrinkles,
                Pattern::Ripples { sources } => NormalKind::Ripples(sources),
                Pattern::Waves { sources } => NormalKind::Waves(sources),
                Pattern::Quilted { control0, control1 } => {
                    NormalKind::Quilted([control0, control1])
                }
                pattern => match choice {
                    Choice::Slopes(map) => NormalKind::Height(pattern, Some(map)),
                    _ => NormalKind::Height(pattern, None),
                },
            },
        };
        PovNormal {
            kind,
            ..self.normal
        }
    }
}

/// Transforms a normal, unless it is in surface coordinates.
pub(super) fn transform(normal: &mut PovNormal, by: &Transform) {
    if !normal.uv_mapped {
        modifiers::transform(&mut normal.modifiers.warps, by);
    }
}

/// Sets `no_bump_scale` for the normals of which one is made: it counts for those too (measured).
fn keep_bumps(normal: &mut PovNormal) {
    normal.no_bump_scale = true;
    match &mut normal.kind {
        NormalKind::Map(_, map) => map
            .entries
            .make_mut()
            .iter_mut()
            .for_each(|(_, n)| keep_bumps(n)),
        NormalKind::Blocks(_, normals) => normals.make_mut().iter_mut().for_each(keep_bumps),
        NormalKind::Average(members) => members
            .make_mut()
            .iter_mut()
            .for_each(|(_, n)| keep_bumps(n)),
        _ => {}
    }
}

impl Parser<'_> {
    /// `{ ... }` after `normal`, which changes the default normal.
    pub(crate) fn normal_block(&mut self) -> PResult<PovNormal> {
        let base = self.state.default_texture.top().normal.as_deref().cloned();
        self.normal_block_on(base)
    }

    /// `{ ... }` after `normal`, which changes `base` unless it begins with a name.
    pub(super) fn normal_block_on(&mut self, base: Option<PovNormal>) -> PResult<PovNormal> {
        self.braces(|p| p.normal_items(Kind::RightBrace, base))
    }

    /// The items in a normal's braces, or in the brackets of an entry of `normal_map`.
    pub(super) fn normal_items(
        &mut self,
        closing: Kind,
        base: Option<PovNormal>,
    ) -> PResult<PovNormal> {
        let named = self.accept_thing(|thing| match thing {
            Thing::Normal(normal) => Some(normal),
            _ => None,
        })?;
        if self.accept_word(Word::UvMapping)? {
            // What follows is a whole normal of its own (measured).
            let inner = self.nested(|p| p.normal_items(closing, base))?;
            return Ok(PovNormal {
                uv_mapped: true,
                ..inner
            });
        }
        let is_named = named.is_some();
        let base = match named {
            Some(named) => PovNormal::clone(&named),
            None => base.unwrap_or_else(flat),
        };
        if self.peek()?.kind == closing {
            return Ok(base);
        }
        let mut draft = Draft::from(base);
        if is_named {
            self.normal_amount(&mut draft)?;
        }
        self.items_until(closing, "`normal`", |p, token| {
            p.normal_item(&mut draft, token)
        })?;
        let mut normal = draft.finish();
        if normal.no_bump_scale {
            keep_bumps(&mut normal);
        }
        self.weigh(weight::of_normal(&normal))?;
        Ok(normal)
    }

    /// A part of a normal.
    pub(super) fn normal_item(&mut self, draft: &mut Draft, token: Token) -> PResult<()> {
        match token.word() {
            Some(Word::BumpSize) => {
                self.take(token)?;
                draft.normal.amount = self.float()?;
                return Ok(());
            }
            Some(Word::Accuracy) => {
                self.take(token)?;
                draft.normal.accuracy = self.float()?;
                return Ok(());
            }
            Some(Word::NoBumpScale) => {
                self.take(token)?;
                draft.normal.no_bump_scale = self.flag()?;
                return Ok(());
            }
            Some(Word::SlopeMap) => {
                self.take(token)?;
                let SlopeMap(map) = self.slope_map()?;
                draft.choice = Choice::Slopes(SlopeMap(self.in_order(map)));
                return Ok(());
            }
            Some(Word::NormalMap) => {
                self.take(token)?;
                let map = self.normal_map()?;
                draft.choice = Choice::Normals(match &draft.chooser {
                    Chooser::Average => map,
                    _ => self.in_order(map),
                });
                return Ok(());
            }
            Some(Word::Average) => {
                self.take(token)?;
                draft.chooser = Chooser::Average;
                return self.normal_amount(draft);
            }
            Some(Word::BumpMap) => {
                self.take(token)?;
                let (image, size) = self.bump_bitmap()?;
                if let Some(image) = image {
                    draft.chooser = Chooser::Fixed(NormalKind::BumpMap(image));
                }
                draft.choice = Choice::Own;
                if let Some(size) = size {
                    draft.normal.amount = size;
                }
                return self.normal_amount(draft);
            }
            Some(Word::UvMapping) => return Err(self.late_uv_mapping(token, "normal")),
            Some(Word::Facets) => {
                self.take(token)?;
                draft.chooser = Chooser::Fixed(NormalKind::Facets(Facets::default()));
                draft.choice = Choice::Own;
                return self.normal_amount(draft);
            }
            _ => {}
        }
        if let Chooser::Fixed(NormalKind::Facets(facets)) = &mut draft.chooser
            && self.facets_item(facets, token)?
        {
            return Ok(());
        }
        if let Some(pattern) = self.pattern(token)? {
            draft.special = token.is(Word::Bumps);
            let before = match &draft.chooser {
                Chooser::UvMapped(inner) => Choice::Normals(numbered(&[PovNormal {
                    uv_mapped: false,
                    ..PovNormal::clone(inner)
                }])),
                _ => std::mem::replace(&mut draft.choice, Choice::Own),
            };
            draft.choice = Choice::Own;
            self.block_normals(draft, &pattern)?;
            if pattern.block_count().is_none() {
                draft.choice = before.of_pattern();
            }
            modifiers::begin(&mut draft.normal.modifiers, &pattern);
            if let Chooser::Flat = draft.chooser {
                draft.normal.modifiers.noise = self.noise_of(&pattern);
            }
            draft.chooser = Chooser::Pattern(pattern);
            return self.normal_amount(draft);
        }
        let pattern = match &mut draft.chooser {
            Chooser::Pattern(pattern) => Some(pattern),
            _ => None,
        };
        if self.pattern_parameter(pattern, token)?
            || self.pattern_modifier(&mut draft.normal.modifiers, token)?
        {
            return Ok(());
        }
        self.skip_item(token, "`normal`")
    }

    /// The optional number after a pattern: the strength of the perturbation.
    fn normal_amount(&mut self, draft: &mut Draft) -> PResult<()> {
        self.comma()?;
        if self.starts_number()? {
            draft.normal.amount = self.float()?;
        }
        Ok(())
    }

    /// The normals of the blocks of a block pattern, if they follow.
    fn block_normals(&mut self, draft: &mut Draft, pattern: &Pattern) -> PResult<()> {
        let blocks = self.blocks(
            pattern,
            Word::Normal,
            |p| p.normal_amount(draft),
            Self::normal_block,
            |_| flat(),
        )?;
        if let Some(list) = blocks {
            draft.choice = Choice::Blocks(list);
        }
        Ok(())
    }

    /// `coords 1` or `size 0.2` of `facets`.
    fn facets_item(&mut self, facets: &mut Facets, token: Token) -> PResult<bool> {
        let number = match token.word() {
            Some(Word::Coords) => &mut facets.tilt,
            Some(Word::Size) => &mut facets.size,
            _ => return Ok(false),
        };
        self.take(token)?;
        *number = self.float()?;
        Ok(true)
    }
}
