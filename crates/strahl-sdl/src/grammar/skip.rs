//! Skips features that are not supported.

use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};

/// The blocks in which a word is allowed.
type Blocks = &'static [&'static str];

/// Blocks of patterns.
const PATTERNED: Blocks = &["`pigment`", "`normal`", "`texture`", "`pattern`"];

/// Blocks of patterns in which the words of pattern parameters are unambiguous.
const PARAMETERS: Blocks = &["`pigment`", "`normal`", "`pattern`"];

/// Blocks of maps.
const MAPS: Blocks = &[
    "`color_map`",
    "`pigment_map`",
    "`normal_map`",
    "`texture_map`",
];

/// THE table of features that are skipped with a warning, with the blocks that they belong to. Everything else that cannot be
/// read is an error, because a picture must not lack something silently.
const OPEN: &[(Word, Blocks)] = &[
    // Interiors of versions before 3.1.
    (Word::Caustics, &["`finish`"]),
    (Word::FadeColor, &["`finish`"]),
    (Word::FadeColour, &["`finish`"]),
    (Word::FadeDistance, &["`finish`"]),
    (Word::FadePower, &["`finish`"]),
    (Word::Ior, &["`finish`"]),
    (Word::Refraction, &["`finish`"]),
    (Word::BlendGamma, MAPS),
    (Word::BlendMode, MAPS),
    (Word::Blob, PATTERNED),
    (Word::Camera, &["`#default`"]),
    (Word::Coords, PARAMETERS),
    (Word::Cubic, &["`warp`"]),
    (Word::CutawayTextures, &["the object"]),
    (Word::Density, &["`#default`"]),
    (Word::DensityFile, PATTERNED),
    (Word::Exterior, PARAMETERS),
    (Word::Facets, PATTERNED),
    (Word::Form, PARAMETERS),
    (Word::Fresnel, &["`finish`"]),
    (Word::Interior, PARAMETERS),
    (Word::Interpolate, PARAMETERS),
    (Word::Isosurface, PATTERNED),
    (Word::Media, &["`interior`"]),
    (Word::NoRadiosity, &["the object"]),
    (Word::NumberOfSides, PATTERNED),
    (Word::NumberOfTiles, PATTERNED),
    (Word::Pattern, PARAMETERS),
    (Word::Pavement, PATTERNED),
    (
        Word::Photons,
        &["the object", "`light_source`", "`global_settings`"],
    ),
    (Word::Polarity, &["the object"]),
    (Word::Potential, PATTERNED),
    (Word::Radiosity, &["the object", "`#default`"]),
    (Word::Size, PARAMETERS),
    (Word::Subsurface, &["`finish`"]),
    (Word::Threshold, PATTERNED),
    (Word::Turbulence, &["`black_hole`"]),
    (Word::UseAlpha, &["`finish`"]),
    (Word::UseColor, &["the picture"]),
    (Word::UseColour, &["the picture"]),
    (Word::UseIndex, &["the picture"]),
    (Word::UserDefined, &["`camera`", "`pigment`", "`texture`"]),
];

impl Parser<'_> {
    /// Skips `{ ... }`, but runs the directives inside.
    pub(crate) fn skip_body(&mut self) -> PResult<()> {
        let token = self.expect(Kind::LeftBrace)?;
        let mut open = 1usize;
        while open > 0 {
            let next = self.peek()?;
            match next.kind {
                Kind::LeftBrace => open += 1,
                Kind::RightBrace => open -= 1,
                Kind::End => return Err(self.unexpected(token, "a `}` for this brace")),
                _ => {}
            }
            self.take(next)?;
        }
        Ok(())
    }

    /// Skips an unsupported item: its keyword, then everything up to the next keyword or closing brace, or a block in braces. The
    /// warning says that the picture will lack it.
    ///
    /// # Errors
    /// If the item is not listed for the block in [`OPEN`].
    pub(crate) fn skip_item(&mut self, item: Token, of: &str) -> PResult<()> {
        let is_open = |word: Word| {
            let row = OPEN.iter().find(|(open, _)| *open == word);
            row.is_some_and(|(_, blocks)| blocks.contains(&of))
        };
        if !item.word().is_some_and(is_open) {
            return Err(self.unexpected(item, &format!("an item of {of}, or `}}`")));
        }
        let place = self.place_of(item);
        let found = self.describe(item);
        self.warn(
            place,
            format!("{found} in {of} is not supported yet and is left out"),
        );
        self.take(item)?;
        loop {
            let token = self.peek()?;
            match token.kind {
                Kind::LeftBrace => return self.skip_body(),
                Kind::RightBrace | Kind::End => return Ok(()),
                Kind::Word => {
                    let kind = token.word().map(Word::kind);
                    use crate::keywords::WordKind as W;
                    let value = matches!(
                        kind,
                        Some(
                            W::Constant
                                | W::FloatFunction
                                | W::VectorFunction
                                | W::Color
                                | W::StringFunction
                        )
                    ) || token.is(Word::Df3);
                    if !value {
                        return Ok(());
                    }
                    self.take(token)?;
                }
                _ => self.take(token)?,
            }
        }
    }
}
