//! Fonts: TrueType and OpenType files to the outlines of letters.

mod error;
mod substitute;

pub use error::FontError;
pub use substitute::substitutes;

use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::outline::{DrawSettings, OutlineGlyphCollection, OutlinePen};
use skrifa::raw::tables::kern::{Subtable, SubtableKind};
use skrifa::raw::{FileRef, TableProvider};
use skrifa::{FontRef, GlyphId, MetadataProvider};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use strahl_geometry::{Outline, OutlineBuilder};
use strahl_math::DVec2;

/// A font: the outlines of its letters, each made once and shared by all its uses.
///
/// Lengths are in units of the font's em square, so that lines of text are about 1 apart. Of a collection the first font is
/// used. Outlines are unhinted.
#[derive(Debug)]
pub struct Font {
    bytes: Vec<u8>,
    /// The kerning of pairs of glyphs, in units, from those parts of the table `kern` that list pairs.
    pairs: BTreeMap<(u32, u32), i32>,
    glyphs: BTreeMap<u32, Option<Arc<Outline>>>,
    /// Lines that have been laid out, as the same ones often come again and finding the font's tables takes time.
    lines: BTreeMap<String, Vec<Letter>>,
}

/// So many lines are kept.
const LINES: usize = 256;

/// A letter of a line of text.
#[derive(Clone, Debug)]
pub struct Letter {
    /// Its outline about its own origin, which lies on the base line; `None` for letters without one, such as spaces.
    pub outline: Option<Arc<Outline>>,
    /// Where its origin is on the base line.
    pub x: f64,
}

impl Font {
    /// A font from the bytes of its file.
    ///
    /// # Errors
    /// The file is no font, or a table that every font must have is missing or broken.
    pub fn parse(bytes: Vec<u8>) -> Result<Self, FontError> {
        let font = open(&bytes)?;
        let outlines = font.outline_glyphs();
        if outlines.format().is_none() {
            return Err(FontError::NoOutlines);
        }
        units(&font)?;
        let pairs = listed_pairs(&font);
        Ok(Self {
            bytes,
            pairs,
            glyphs: BTreeMap::new(),
            lines: BTreeMap::new(),
        })
    }

    /// Lays out a line of text from x = 0 to the right: every letter is advanced by the width of the one before, corrected by
    /// the font's kerning table (`kern`). A character that the font lacks is shown as its first glyph, usually a box.
    ///
    /// There is no shaping: no ligatures, no right-to-left text.
    ///
    /// # Errors
    /// The outline of a letter is broken.
    pub fn lay_out(&mut self, text: &str) -> Result<Vec<Letter>, FontError> {
        if let Some(known) = self.lines.get(text) {
            return Ok(known.clone());
        }
        let letters = self.lay_out_anew(text)?;
        if self.lines.len() >= LINES {
            self.lines.clear();
        }
        self.lines.insert(text.to_owned(), letters.clone());
        Ok(letters)
    }

    fn lay_out_anew(&mut self, text: &str) -> Result<Vec<Letter>, FontError> {
        let Self {
            bytes,
            pairs,
            glyphs,
            ..
        } = self;
        let font = open(bytes)?;
        let unit = 1.0 / units(&font)?;
        let (charmap, outlines) = (font.charmap(), font.outline_glyphs());
        let metrics = font.glyph_metrics(Size::unscaled(), LocationRef::default());
        let mut letters = vec![];
        let (mut x, mut before) = (0.0, None);
        for character in text.chars() {
            let id = charmap.map(character).unwrap_or(GlyphId::NOTDEF);
            if let Some(before) = before {
                x += f64::from(kerning(&font, pairs, before, id)) * unit;
            }
            let outline = match glyphs.get(&id.to_u32()) {
                Some(known) => known.clone(),
                None => {
                    let made = outline(&outlines, id, unit)?.map(Arc::new);
                    glyphs.insert(id.to_u32(), made.clone());
                    made
                }
            };
            letters.push(Letter { outline, x });
            x += advance(&metrics, id) * unit;
            before = Some(id);
        }
        Ok(letters)
    }
}

/// The font of a file, or the first one of a collection.
fn open(bytes: &[u8]) -> Result<FontRef<'_>, FontError> {
    let broken = |error| FontError::Broken {
        what: "the file",
        error,
    };
    match FileRef::new(bytes).map_err(broken)? {
        FileRef::Font(font) => Ok(font),
        FileRef::Collection(fonts) => fonts.get(0).map_err(broken),
    }
}

/// The units of the em square's side.
fn units(font: &FontRef<'_>) -> Result<f64, FontError> {
    let head = font.head().map_err(|error| FontError::Broken {
        what: "the table `head`",
        error,
    })?;
    match head.units_per_em() {
        0 => Err(FontError::NoOutlines),
        units => Ok(f64::from(units)),
    }
}

fn advance(metrics: &GlyphMetrics<'_>, id: GlyphId) -> f64 {
    f64::from(metrics.advance_width(id).unwrap_or(0.0))
}

/// The parts of the font's table `kern` that move letters of a horizontal line along it.
fn kerning_tables<'a>(font: &FontRef<'a>) -> impl Iterator<Item = Subtable<'a>> {
    let tables = font.kern().into_iter().flat_map(|kern| kern.subtables());
    tables
        .filter_map(Result::ok)
        .filter(|table| table.is_horizontal() && !table.is_cross_stream() && !table.is_variable())
}

/// The kerning of all pairs that are listed one by one (format 0).
///
/// The list should be sorted, but in some fonts, such as two of POV-Ray's, it isn't, so a binary search would miss pairs. Of a
/// pair that one list has twice the first entry counts; entries of several lists are added.
fn listed_pairs(font: &FontRef<'_>) -> BTreeMap<(u32, u32), i32> {
    let mut all = BTreeMap::new();
    for table in kerning_tables(font) {
        let Ok(SubtableKind::Format0(list)) = table.kind() else {
            continue;
        };
        let mut seen = BTreeSet::new();
        for pair in list.pairs() {
            let key = (
                u32::from(pair.left().to_u16()),
                u32::from(pair.right().to_u16()),
            );
            if seen.insert(key) {
                let sum: &mut i32 = all.entry(key).or_default();
                *sum = sum.saturating_add(i32::from(pair.value()));
            }
        }
    }
    all
}

/// The kerning of two letters, in units: `pairs` and the parts of the table `kern` that have classes of letters.
fn kerning(
    font: &FontRef<'_>,
    pairs: &BTreeMap<(u32, u32), i32>,
    left: GlyphId,
    right: GlyphId,
) -> i32 {
    let key = (left.to_u32(), right.to_u32());
    let listed = pairs.get(&key).copied().unwrap_or(0);
    let classes = kerning_tables(font).filter_map(|table| match table.kind() {
        Ok(SubtableKind::Format2(pairs)) => pairs.kerning(left, right),
        Ok(SubtableKind::Format3(pairs)) => pairs.kerning(left, right),
        _ => None,
    });
    classes.fold(listed, i32::saturating_add)
}

/// The outline of a glyph; `None` if it is empty.
fn outline(
    outlines: &OutlineGlyphCollection<'_>,
    id: GlyphId,
    unit: f64,
) -> Result<Option<Outline>, FontError> {
    let Some(glyph) = outlines.get(id) else {
        return Ok(None);
    };
    let mut pen = Pen {
        builder: OutlineBuilder::default(),
        unit,
        drawn: false,
    };
    let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
    if let Err(error) = glyph.draw(settings, &mut pen) {
        return Err(FontError::Glyph {
            id: id.to_u32(),
            message: error.to_string(),
        });
    }
    // A glyph that consists of points only counts as a space.
    Ok(if pen.drawn {
        pen.builder.finish().ok()
    } else {
        None
    })
}

/// Draws a glyph into an outline.
struct Pen {
    builder: OutlineBuilder,
    unit: f64,
    drawn: bool,
}

impl Pen {
    fn point(&self, x: f32, y: f32) -> DVec2 {
        DVec2::new(f64::from(x) * self.unit, f64::from(y) * self.unit)
    }
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.builder.move_to(self.point(x, y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.drawn = true;
        self.builder.line_to(self.point(x, y));
    }

    fn quad_to(&mut self, cx0: f32, cy0: f32, x: f32, y: f32) {
        self.drawn = true;
        let control = self.point(cx0, cy0);
        self.builder.quadratic_to(control, self.point(x, y));
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        self.drawn = true;
        let (control, other) = (self.point(cx0, cy0), self.point(cx1, cy1));
        self.builder.cubic_to(control, other, self.point(x, y));
    }

    fn close(&mut self) {
        self.builder.close();
    }
}

#[cfg(test)]
mod tests;
