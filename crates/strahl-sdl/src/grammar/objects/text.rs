use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{Data, PResult, Parser, Place};
use crate::source::HostError;
use strahl_formats::font::{Font, substitutes};
use strahl_geometry::{GeometryError, Glyph};
use strahl_math::DVec3;
use strahl_scene::{CsgOp, Object, ObjectKind};

/// A font that has been read; texts often use the same one.
#[derive(Debug)]
pub(in crate::grammar) struct KnownFont {
    name: String,
    font: Font,
}

/// The fonts of `internal` by number; other numbers mean the first.
const INTERNAL: [&str; 4] = ["povlogo.ttf", "timrom.ttf", "cyrvetic.ttf", "crystal.ttf"];

/// `text { ttf "file" "text" thickness, offset }`, or `internal number` instead of the file.
pub(super) fn text(p: &mut Parser<'_>) -> PResult<Entity> {
    p.simple(|p| {
        let token = p.peek()?;
        let name = match token.word() {
            Some(Word::Ttf) => {
                p.take(token)?;
                p.file_name()?
            }
            Some(Word::Internal) => {
                p.take(token)?;
                // Numbers outside of the list, and NaN, mean the first font.
                let number = p.float()? as usize;
                INTERNAL.get(number).unwrap_or(&INTERNAL[0]).to_string()
            }
            _ => return Err(p.unexpected(token, "`ttf` or `internal`")),
        };
        let place = p.place();
        p.comma()?;
        let line = p.string()?;
        p.comma()?;
        let thickness = p.float()?;
        p.comma()?;
        let offset = p.vector3()?;
        let font = p.font(&name, place)?;
        let letters = match p.state.fonts.get_mut(font).map(|f| f.font.lay_out(&line)) {
            Some(Ok(letters)) => letters,
            Some(Err(error)) => return Err(p.fail(place, format!("`{name}`: {error}"))),
            None => vec![],
        };
        // In POV-Ray, a text starts with the leftmost point of its first letter, wherever the font puts that.
        let first = letters.first().and_then(|letter| letter.outline.as_ref());
        let left = first.map_or(0.0, |outline| outline.bounds()[0].x);
        let mut glyphs = vec![];
        for (index, letter) in letters.into_iter().enumerate() {
            let Some(outline) = letter.outline else {
                continue;
            };
            let origin = DVec3::X * (letter.x - left) + offset * index as f64;
            match Glyph::try_new(outline, origin, thickness) {
                Ok(glyph) => glyphs.push(glyph),
                Err(error) => return Ok(Err::<_, GeometryError>(error)),
            }
        }
        let span = p.span_at(place);
        let objects = glyphs.into_iter().map(|glyph| {
            let mut object = Object::from(glyph);
            object.span = span;
            object
        });
        let mut objects: Vec<_> = objects.collect();
        Ok(Ok(match objects.pop() {
            // A single letter needs no union around it.
            Some(Object {
                kind: kind @ ObjectKind::Shape(_),
                ..
            }) if objects.is_empty() => kind,
            last => {
                objects.extend(last);
                Object::csg(CsgOp::Union, objects).kind
            }
        }))
    })
}

impl Parser<'_> {
    /// The index of the known font that a scene names, or of a font that replaces it.
    fn font(&mut self, name: &str, place: Place) -> PResult<usize> {
        if let Some(known) = self.state.fonts.iter().position(|f| f.name == name) {
            return Ok(known);
        }
        let file = self.font_file(name, place)?;
        let font = match Font::parse(file.bytes) {
            Ok(font) => font,
            Err(error) => return Err(self.fail(place, format!("`{}`: {error}", file.name))),
        };
        self.state.fonts.push(KnownFont {
            name: name.to_owned(),
            font,
        });
        Ok(self.state.fonts.len() - 1)
    }

    /// Searches a font: under its name in all file folders, then among the system's fonts, then a similar one.
    fn font_file(&mut self, name: &str, place: Place) -> PResult<Data> {
        let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
        // The extension may be omitted.
        let mut endings = vec![""];
        if !file.contains('.') {
            endings.extend([".ttf", ".ttc", ".otf"]);
        }
        let mut searched = vec![];
        for ending in &endings {
            match self.look_for_file(&format!("{name}{ending}"), place)? {
                Ok(found) => return Ok(found),
                Err(HostError::NotFound { searched: here, .. }) => searched = here,
                Err(error) => return Err(self.fail(place, error.to_string())),
            }
        }
        for ending in &endings {
            if let Some(found) = self.system_font(&format!("{file}{ending}"), place)? {
                return Ok(found);
            }
        }
        for other in substitutes(file) {
            if let Some(found) = self.system_font(other, place)? {
                self.warn_hint(
                    place,
                    format!("the font `{name}` was not found; {other} replaces it"),
                    "letters will look and be spaced differently; name its folder with `--library-path`",
                );
                return Ok(found);
            }
        }
        let searched = searched.join(", ");
        let message = format!("the font `{name}` was not found (searched in: {searched})");
        Err(self.fail_hint(
            place,
            message,
            "put it beside the scene, or name its folder with `--library-path`; POV-Ray's fonts come with its include files",
        ))
    }
}
