//! `pigment { ... }`

use super::maps::{blends_blocks, color_ft, numbered};
use super::{modifiers, weight};
use crate::grammar::Thing;
use crate::keywords::{Word, WordKind};
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};
use crate::value::Value;
use std::sync::Arc;
use strahl_math::Transform;
use strahl_shade::image_map::ImageMap;
use strahl_shade::patterns::{FractalKind, Modifiers, Pattern, PatternField};
use strahl_shade::pigment::{BlendMap, Pigment};
use strahl_shade::{Color, ColorFt, SharedList};

/// The part of a pigment that selects the colour.
#[derive(Clone)]
enum Chooser {
    /// None: a uniform colour.
    Solid(ColorFt),
    Pattern(Pattern),
    Average,
    Image(Arc<ImageMap>),
    /// The surface coordinates, at which the first pigment of the map is evaluated.
    UvMapped,
}

/// The colours or pigments to select from.
#[derive(Clone)]
enum Choice {
    /// The default map of the pattern with this word, or default colours.
    Default(Option<Word>),
    /// The default map of the pattern of the pigment that is changed.
    Usual(BlendMap<ColorFt>),
    Colors(BlendMap<ColorFt>),
    Pigments(BlendMap<Pigment>),
    Blocks(SharedList<Pigment>),
}

impl Choice {
    /// The map for a pattern that is written without one, with this keyword: the existing map; existing colours of blocks count
    /// as a map at 0, 1, 2 and so on.
    fn of_pattern(self, word: Option<Word>) -> Self {
        match self {
            Self::Default(_) | Self::Usual(_) => Self::Default(word),
            Self::Blocks(list) => Self::Pigments(numbered(&list)),
            map => map,
        }
    }
}

/// A pigment being read: its parts may come in any order.
pub(super) struct Draft {
    chooser: Chooser,
    choice: Choice,
    pub(super) modifiers: Modifiers,
    /// The colour for quick pictures.
    quick: Option<ColorFt>,
}

/// A block pattern with the pigments of its blocks.
fn of_blocks(field: Box<PatternField>, list: SharedList<Pigment>) -> Pigment {
    if blends_blocks(&field.modifiers) {
        return Pigment::PigmentMap(field, numbered(&list));
    }
    Pigment::Blocks(field, list)
}

impl From<Pigment> for Draft {
    fn from(pigment: Pigment) -> Self {
        let draft = |chooser, choice, modifiers| Self {
            chooser,
            choice,
            modifiers,
            quick: None,
        };
        let field = |field: Box<PatternField>, choice| {
            draft(Chooser::Pattern(field.pattern), choice, field.modifiers)
        };
        match pigment {
            Pigment::Solid(color, modifiers) => draft(
                Chooser::Solid(color),
                Choice::Default(None),
                modifiers.map_or_else(Modifiers::default, |modifiers| *modifiers),
            ),
            Pigment::ColorMap(f, map) if is_default_map(&f.pattern, &map) => {
                field(f, Choice::Usual(map))
            }
            Pigment::ColorMap(f, map) => field(f, Choice::Colors(map)),
            Pigment::PigmentMap(f, map) => field(f, Choice::Pigments(map)),
            Pigment::Blocks(f, list) => field(f, Choice::Blocks(list)),
            Pigment::Image(image, modifiers) => {
                draft(Chooser::Image(image), Choice::Default(None), *modifiers)
            }
            Pigment::Average(members, modifiers) => draft(
                Chooser::Average,
                Choice::Pigments(BlendMap::new(members)),
                *modifiers,
            ),
            Pigment::UvMapped(inner) => draft(
                Chooser::UvMapped,
                Choice::Pigments(numbered(&[*inner])),
                Modifiers::default(),
            ),
            Pigment::Quick(color, inner) => Self {
                quick: Some(color),
                ..Self::from(*inner)
            },
        }
    }
}

impl Draft {
    pub(super) fn finish(self) -> Pigment {
        let quick = self.quick;
        let pigment = self.finish_without_quick();
        match quick {
            Some(color) => Pigment::Quick(color, Box::new(pigment)),
            None => pigment,
        }
    }

    fn finish_without_quick(self) -> Pigment {
        let Self {
            chooser,
            choice,
            modifiers,
            ..
        } = self;
        match chooser {
            Chooser::Solid(color) => {
                let kept = (modifiers != Modifiers::default()).then(|| Box::new(modifiers));
                Pigment::Solid(color, kept)
            }
            Chooser::Image(image) => Pigment::Image(image, Box::new(modifiers)),
            Chooser::Average => {
                let members = match choice {
                    Choice::Pigments(map) => map.entries,
                    _ => SharedList::default(),
                };
                Pigment::Average(members, Box::new(modifiers))
            }
            Chooser::Pattern(pattern) => {
                let field = Box::new(PatternField { pattern, modifiers });
                match choice {
                    Choice::Colors(map) | Choice::Usual(map) => Pigment::ColorMap(field, map),
                    Choice::Pigments(map) => Pigment::PigmentMap(field, map),
                    Choice::Blocks(list) => of_blocks(field, list),
                    Choice::Default(word) => match default_blocks(&field.pattern) {
                        Some(list) => of_blocks(field, list),
                        None => {
                            let map = default_map(&field.pattern, word);
                            Pigment::ColorMap(field, map)
                        }
                    },
                }
            }
            Chooser::UvMapped => match choice {
                Choice::Pigments(map) => match map.entries.first() {
                    Some((_, first)) => Pigment::UvMapped(Box::new(first.clone())),
                    None => Pigment::default(),
                },
                Choice::Colors(map) => match map.entries.first() {
                    Some((_, first)) => Pigment::from(*first),
                    None => Pigment::default(),
                },
                Choice::Default(_) | Choice::Usual(_) | Choice::Blocks(_) => Pigment::default(),
            },
        }
    }
}

const fn rgb(r: f64, g: f64, b: f64) -> ColorFt {
    ColorFt::opaque(Color::new(r, g, b))
}

const RED: ColorFt = rgb(1.0, 0.0, 0.0);
const GREEN: ColorFt = rgb(0.0, 1.0, 0.0);
const BLUE: ColorFt = rgb(0.0, 0.0, 1.0);
const YELLOW: ColorFt = rgb(1.0, 1.0, 0.0);
const CYAN: ColorFt = rgb(0.0, 1.0, 1.0);
const MAGENTA: ColorFt = rgb(1.0, 0.0, 1.0);
const WHITE: ColorFt = rgb(1.0, 1.0, 1.0);
const BLACK: ColorFt = rgb(0.0, 0.0, 0.0);

/// The default colours of the blocks of a block pattern; measured with POV-Ray 3.7.
fn default_colors(pattern: &Pattern) -> Option<&'static [ColorFt]> {
    const BRICK: [ColorFt; 2] = [rgb(0.5, 0.5, 0.5), rgb(0.6, 0.15, 0.15)];
    Some(match pattern {
        Pattern::Brick { .. } => &BRICK,
        Pattern::Checker | Pattern::Object(_) => &[BLUE, GREEN],
        Pattern::Hexagon => &[BLUE, GREEN, RED],
        Pattern::Square => &[RED, GREEN, BLUE, YELLOW],
        Pattern::Cubic | Pattern::Triangular => &[RED, GREEN, BLUE, YELLOW, CYAN, MAGENTA],
        _ => return None,
    })
}

fn default_blocks(pattern: &Pattern) -> Option<SharedList<Pigment>> {
    let colors = default_colors(pattern)?;
    Some(colors.iter().copied().map(Pigment::from).collect())
}

/// The default map of a pattern, for most from black to white; measured with POV-Ray 3.7.
fn default_map(pattern: &Pattern, word: Option<Word>) -> BlendMap<ColorFt> {
    const AGATE: &[(f64, ColorFt)] = &[
        (0.0, WHITE),
        (0.5, rgb(0.95, 0.75, 0.5)),
        (0.5, rgb(0.9, 0.7, 0.5)),
        (0.6, rgb(0.9, 0.7, 0.4)),
        (0.6, rgb(1.0, 0.7, 0.4)),
        (1.0, rgb(0.6, 0.3, 0.0)),
    ];
    const BOZO: &[(f64, ColorFt)] = &[
        (0.4, WHITE),
        (0.4, GREEN),
        (0.6, GREEN),
        (0.6, BLUE),
        (0.8, BLUE),
        (0.8, RED),
    ];
    const MANDEL: &[(f64, ColorFt)] = &[
        (0.001, BLACK),
        (0.001, CYAN),
        (0.012, YELLOW),
        (0.015, MAGENTA),
        (0.1, CYAN),
    ];
    const MARBLE: &[(f64, ColorFt)] = &[
        (0.0, rgb(0.9, 0.8, 0.8)),
        (0.9, rgb(0.9, 0.08, 0.08)),
        (0.9, BLACK),
    ];
    const RADIAL: &[(f64, ColorFt)] =
        &[(0.0, CYAN), (0.333, YELLOW), (0.666, MAGENTA), (1.0, CYAN)];
    const WOOD: &[(f64, ColorFt)] = &[
        (0.6, rgb(0.666, 0.312, 0.2)),
        (0.6, rgb(0.4, 0.1333, 0.066)),
    ];
    // Fractals with other exponents have another map.
    let is_quadratic = matches!(
        pattern,
        Pattern::Fractal(fractal) if fractal.kind == FractalKind::Power { exponent: 2 }
    );
    const GRAY: &[(f64, ColorFt)] = &[(0.0, BLACK), (1.0, WHITE)];
    BlendMap::new(
        match word {
            Some(Word::Agate) => AGATE,
            Some(Word::Bozo) => BOZO,
            Some(Word::Mandel) if is_quadratic => MANDEL,
            Some(Word::Marble) => MARBLE,
            Some(Word::Radial) => RADIAL,
            Some(Word::Wood) => WOOD,
            _ => GRAY,
        }
        .to_vec(),
    )
}

/// Whether a map is the default map of a pattern.
fn is_default_map(pattern: &Pattern, map: &BlendMap<ColorFt>) -> bool {
    let words = [
        Word::Agate,
        Word::Bozo,
        Word::Mandel,
        Word::Marble,
        Word::Radial,
        Word::Wood,
    ];
    let mut words = words.into_iter().map(Some).chain([None]);
    words.any(|word| *map == default_map(pattern, word))
}

/// Transforms a pigment, unless it is in surface coordinates.
pub(super) fn transform(pigment: &mut Pigment, by: &Transform) {
    match pigment {
        Pigment::UvMapped(_) => {}
        Pigment::Quick(_, inner) => transform(inner, by),
        Pigment::Solid(_, kept) => {
            let kept = kept.get_or_insert_with(Box::default);
            modifiers::transform(&mut kept.warps, by);
        }
        Pigment::ColorMap(field, _) | Pigment::PigmentMap(field, _) | Pigment::Blocks(field, _) => {
            modifiers::transform(&mut field.modifiers.warps, by)
        }
        Pigment::Image(_, modifiers) | Pigment::Average(_, modifiers) => {
            modifiers::transform(&mut modifiers.warps, by);
        }
    }
}

impl Parser<'_> {
    /// `{ ... }` after `pigment`, which changes the default pigment.
    pub(crate) fn pigment_block(&mut self) -> PResult<Pigment> {
        let base = self.default_pigment();
        self.pigment_block_on(base)
    }

    /// `{ ... }` after `pigment` where it is not the look of an object (skies, functions, pictures, patterns): `#default` does not count
    /// there (measured).
    pub(crate) fn free_pigment_block(&mut self) -> PResult<Pigment> {
        self.pigment_block_on(Pigment::default())
    }

    /// `{ ... }` after `pigment`, which changes `base` unless it begins with a name.
    pub(super) fn pigment_block_on(&mut self, base: Pigment) -> PResult<Pigment> {
        self.braces(|p| p.pigment_items(Kind::RightBrace, base))
    }

    /// The items in a pigment's braces, or in the brackets of an entry of `pigment_map`.
    pub(super) fn pigment_items(&mut self, closing: Kind, base: Pigment) -> PResult<Pigment> {
        let named = self.named_pigment()?;
        if self.accept_word(Word::UvMapping)? {
            // What follows is a whole pigment of its own (measured).
            let inner = self.nested(|p| p.pigment_items(closing, base))?;
            return Ok(Pigment::UvMapped(Box::new(inner)));
        }
        let base = named.unwrap_or(base);
        // Most pigments are a single name or colour.
        let token = self.peek()?;
        if token.kind == closing {
            return Ok(base);
        }
        let base = match base {
            Pigment::Solid(_, kept)
                if token.word().is_some_and(|w| w.kind() == WordKind::Color) =>
            {
                let color = Pigment::Solid(color_ft(self.color()?), kept);
                if self.peek()?.kind == closing {
                    return Ok(color);
                }
                color
            }
            other => other,
        };
        let mut draft = Draft::from(base);
        self.items_until(closing, "`pigment`", |p, token| {
            p.pigment_item(&mut draft, token)
        })?;
        let pigment = draft.finish();
        self.weigh(weight::of_pigment(&pigment))?;
        self.check_cost(&pigment)?;
        Ok(pigment)
    }

    /// The pigment or colour of a name or an element of an array, if one follows.
    fn named_pigment(&mut self) -> PResult<Option<Pigment>> {
        let token = self.peek()?;
        let value = match token.kind {
            Kind::Name => token.symbol().and_then(|s| self.scopes.find(s)),
            _ => None,
        };
        match value {
            Some(Value::Thing(Thing::Pigment(pigment))) => {
                let pigment = Pigment::clone(pigment);
                self.take(token)?;
                Ok(Some(pigment))
            }
            Some(Value::Array(_) | Value::Dictionary(_)) => {
                let place = self.place_of(token);
                let value = self.value()?;
                match (&value, value.numeric()) {
                    (_, Some(color)) => {
                        let color = self.color_from(color)?;
                        Ok(Some(color_ft(color).into()))
                    }
                    (Value::Thing(Thing::Pigment(pigment)), _) => Ok(Some(Pigment::clone(pigment))),
                    _ => {
                        let message =
                            format!("expected a pigment or colour, found {}", value.describe());
                        Err(self.fail(place, message))
                    }
                }
            }
            _ => Ok(None),
        }
    }

    /// The pigment that `#default` has set.
    pub(super) fn default_pigment(&self) -> Pigment {
        self.state.default_texture.top().pigment.clone()
    }

    /// A part of a pigment.
    pub(super) fn pigment_item(&mut self, draft: &mut Draft, token: Token) -> PResult<()> {
        match token.word() {
            Some(Word::ColorMap | Word::ColourMap) => {
                self.take(token)?;
                let map = self.color_map()?;
                draft.choice = match &draft.chooser {
                    // The average of colours is an average of uniform pigments.
                    Chooser::Average => Choice::Pigments(BlendMap::new(
                        map.entries
                            .iter()
                            .map(|(weight, color)| (*weight, (*color).into()))
                            .collect::<SharedList<_>>(),
                    )),
                    _ => Choice::Colors(self.in_order(map)),
                };
                return Ok(());
            }
            Some(Word::PigmentMap) => {
                self.take(token)?;
                let map = self.pigment_map()?;
                draft.choice = Choice::Pigments(match &draft.chooser {
                    Chooser::Average => map,
                    _ => self.in_order(map),
                });
                return Ok(());
            }
            Some(Word::ImageMap) => {
                self.take(token)?;
                draft.chooser = match self.color_bitmap()? {
                    Some(image) => Chooser::Image(image),
                    None => Chooser::Solid(WHITE),
                };
                modifiers::begin_as_it_is(&mut draft.modifiers);
                return Ok(());
            }
            Some(Word::Average) => {
                self.take(token)?;
                draft.chooser = Chooser::Average;
                return Ok(());
            }
            Some(Word::QuickColor | Word::QuickColour) => {
                self.take(token)?;
                draft.quick = Some(color_ft(self.color()?));
                return Ok(());
            }
            Some(Word::UvMapping) => return Err(self.late_uv_mapping(token, "pigment")),
            _ => {}
        }
        if let Some(pattern) = self.pattern(token)? {
            draft.choice = match self.block_pigments(&pattern)? {
                Some(list) => Choice::Blocks(list),
                None if pattern.block_count().is_some() => Choice::Default(token.word()),
                None => std::mem::replace(&mut draft.choice, Choice::Default(None))
                    .of_pattern(token.word()),
            };
            if let Chooser::Solid(_) = draft.chooser {
                draft.modifiers.noise = self.noise_of(&pattern);
            }
            modifiers::begin(&mut draft.modifiers, &pattern);
            draft.chooser = Chooser::Pattern(pattern);
            return Ok(());
        }
        let pattern = match &mut draft.chooser {
            Chooser::Pattern(pattern) => Some(pattern),
            _ => None,
        };
        if self.pattern_parameter(pattern, token)?
            || self.pattern_modifier(&mut draft.modifiers, token)?
        {
            return Ok(());
        }
        if self.starts_color(token) {
            draft.chooser = Chooser::Solid(color_ft(self.color()?));
            return Ok(());
        }
        self.skip_item(token, "`pigment`")
    }

    /// The colours or pigments for the blocks of a block pattern; `None` if none follow.
    fn block_pigments(&mut self, pattern: &Pattern) -> PResult<Option<SharedList<Pigment>>> {
        let Some(count) = pattern.block_count() else {
            return Ok(None);
        };
        let mut list = vec![];
        let mut pigments = false;
        while list.len() < count {
            let comma = self.peek()?;
            if comma.kind == Kind::Comma {
                self.take(comma)?;
            }
            let token = self.peek()?;
            if token.is(Word::Pigment) {
                self.take(token)?;
                pigments = true;
                list.push(self.nested(Self::pigment_block)?);
            } else if self.starts_color(token) {
                list.push(color_ft(self.color()?).into());
            } else {
                break;
            }
        }
        if matches!(pattern, Pattern::Object(_)) {
            self.object_list_end(&mut list)?;
        }
        if list.is_empty() {
            return Ok(None);
        }
        // Missing colours are the pattern's defaults, missing pigments the default pigment.
        if pigments {
            let default = self.default_pigment();
            list.resize(count, default);
        } else if let Some(defaults) = default_blocks(pattern) {
            list.extend(defaults.iter().skip(list.len()).cloned());
        }
        Ok(Some(list.into()))
    }

    /// The closing brace after the object and colours of an object pattern; colours may also follow it.
    fn object_list_end(&mut self, list: &mut Vec<Pigment>) -> PResult<()> {
        self.expect(Kind::RightBrace)?;
        while list.len() < 2 {
            self.comma()?;
            let token = self.peek()?;
            if token.is(Word::Pigment) {
                self.take(token)?;
                list.push(self.nested(Self::pigment_block)?);
            } else if self.starts_color(token) {
                list.push(color_ft(self.color()?).into());
            } else {
                break;
            }
        }
        Ok(())
    }

    /// Whether a colour begins with this token.
    pub(super) fn starts_color(&self, token: Token) -> bool {
        use WordKind as W;
        match token.kind {
            Kind::Number | Kind::Less | Kind::Minus | Kind::Plus | Kind::LeftParen => true,
            Kind::Word => token.word().is_some_and(|word| {
                matches!(
                    word.kind(),
                    W::Color | W::Constant | W::FloatFunction | W::VectorFunction
                )
            }),
            Kind::Name => {
                let value = token.symbol().and_then(|s| self.scopes.find(s));
                // An undeclared name may be a misspelt colour, which the expression reports best.
                value.is_none_or(|v| {
                    v.numeric().is_some()
                        || v.is_callable()
                        || matches!(v, Value::Array(_) | Value::Dictionary(_))
                })
            }
            _ => false,
        }
    }
}
