//! The grammar of scenes: statements, objects, and everything inside their braces.
//!
//! The grammar pulls tokens from the [`Parser`] and does not know whether they come from the file, a macro, a loop or an include.
//! It is table driven: a new object is a file in `objects/` with a function `fn(&mut Parser) -> PResult<Object>`, and a line in
//! the table there. The other tables are [`STATEMENTS`] here, the declarable things in `thing.rs`, and the modifiers of all
//! objects in `objects/modifiers.rs`.

mod background;
mod camera;
mod defaults;
mod entity;
mod fog;
mod foreseen;
mod global_settings;
mod lights;
mod objects;
mod query;
mod rainbow;
mod skip;
mod sky;
mod texture;
mod thing;
mod transform;

pub(crate) use camera::default_camera;
pub use defaults::State;
pub(crate) use defaults::default_items;
pub use entity::{Declared, Entity};
pub(crate) use foreseen::Foreseen;
pub use global_settings::GlobalSettings;
pub(crate) use global_settings::UNVERSIONED;
pub use objects::object_words;
pub use texture::{Texture, inside, pattern_words};
pub use thing::Thing;

use crate::keywords::{Word, WordKind};
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};
use entity::has_no_surface;
use texture::{fill_parts, is_bare};

/// Reads a statement whose keyword is taken.
type StatementParser = fn(&mut Parser<'_>) -> PResult<()>;

/// Statements other than objects.
const STATEMENTS: &[(Word, StatementParser)] = &[
    (Word::Background, background::background),
    (Word::Camera, camera::camera_statement),
    (Word::Fog, fog::fog_statement),
    (Word::GlobalSettings, global_settings::global_settings),
    (Word::LightSource, lights::light_statement),
    (Word::Media, media),
    (Word::Rainbow, rainbow::rainbow_statement),
    (Word::SkySphere, sky::sky_statement),
];

/// `media { ... }` as a statement: the medium outside of all objects.
fn media(p: &mut Parser<'_>) -> PResult<()> {
    p.warn_hint(
        p.place(),
        "`media` is not supported yet and is left out",
        "the picture lacks absorption, scattering and emission of the air",
    );
    p.skip_body()
}

/// A table of functions indexed by keyword.
const fn by_word<F: Copy, const N: usize>(table: [(Word, F); N]) -> [Option<F>; Word::ALL.len()] {
    let mut out = [None; Word::ALL.len()];
    let mut row = 0;
    while row < N {
        out[table[row].0 as usize] = Some(table[row].1);
        row += 1;
    }
    out
}

/// The keywords in such a table.
fn words_of<F>(table: &'static [Option<F>]) -> impl Iterator<Item = Word> {
    let rows = Word::ALL.iter().zip(table);
    rows.filter_map(|((word, _, _), row)| row.as_ref().map(|_| *word))
}

/// Whether a statement can begin with this token, so that parsing can continue here after an error.
pub(crate) fn opens_statement(token: Token) -> bool {
    token
        .word()
        .is_some_and(|word| matches!(word.kind(), WordKind::Object | WordKind::Statement))
}

impl Parser<'_> {
    /// Reads the whole scene; continues after errors with the next statement.
    pub(crate) fn run(&mut self) {
        while !self.is_fatal() {
            self.between_statements(true);
            match self.statement() {
                Ok(true) => {}
                Ok(false) => return self.settle(),
                Err(_) => self.recover(),
            }
        }
    }

    /// One statement; `false` at the end of the scene.
    fn statement(&mut self) -> PResult<bool> {
        let token = self.peek()?;
        self.between_statements(false);
        match token.kind {
            Kind::End => return Ok(false),
            // An extra semicolon is harmless.
            Kind::Semicolon => {
                self.take(token)?;
                return Ok(true);
            }
            Kind::Name => {
                return match self.entity()? {
                    Some(entity) => {
                        self.add(entity);
                        self.no_modifier(token)?;
                        Ok(true)
                    }
                    None => Err(self.unexpected(token, "an object or a directive")),
                };
            }
            Kind::Word => {}
            _ => return Err(self.unexpected(token, "an object or a directive")),
        }
        let Some(word) = token.word() else {
            return Err(self.unexpected(token, "an object or a directive"));
        };
        if self.bare_directive(token)? {
            return Ok(true);
        }
        if let Some((_, parse)) = STATEMENTS.iter().find(|(w, _)| *w == word) {
            self.take(token)?;
            parse(self)?;
        } else if let Some(parse) = self.object_parser(token)? {
            let entity = self.nested(parse)?;
            self.add(entity);
        } else if opens_statement(token) {
            self.leave_out(token)?;
        } else {
            return Err(self.unexpected(token, "an object or a directive"));
        }
        Ok(true)
    }

    /// Checks that no modifier follows the bare name of an object.
    fn no_modifier(&mut self, name: Token) -> PResult<()> {
        let token = self.raw();
        let modifies = token.word().is_some_and(|word| {
            matches!(word.kind(), WordKind::Transformation | WordKind::Thing)
                && STATEMENTS.iter().all(|(statement, _)| *statement != word)
        });
        if !modifies && token.kind != Kind::LeftBrace {
            return Ok(());
        }
        let place = self.place_of(token);
        let found = self.describe(token);
        let name = name
            .symbol()
            .map_or("Name", |symbol| self.symbols.text(symbol));
        let hint = format!("write `object {{ {name} ... }}` to change a declared object");
        Err(self.fail_hint(
            place,
            format!("expected an object or a directive, found {found}"),
            hint,
        ))
    }

    #[inline]
    fn add(&mut self, mut entity: Entity) {
        let object = &mut entity.object;
        if has_no_surface(object) {
            return;
        }
        let uncovered = object.material.as_deref().is_none_or(is_bare);
        if uncovered || self.state.materials.has_bare() {
            // The default texture does not move with the object.
            let mut texture = match &object.transform {
                Some(map) => self
                    .state
                    .default_texture
                    .clone()
                    .transformed(&map.inverted()),
                None => self.state.default_texture.clone(),
            };
            if uncovered {
                texture.written = true;
                texture.interior = object.material.as_ref().and_then(|m| m.interior.clone());
                object.material = Some(self.material(&texture));
            }
            fill_parts(object, &texture);
        }
        self.scene.objects.0.push(entity.object);
    }

    /// Counts objects made or copied against the limit.
    ///
    /// # Errors
    /// If they are too many.
    pub(crate) fn count_objects(&mut self, count: u64) -> PResult<()> {
        self.made_progress();
        self.state.objects = self.state.objects.saturating_add(count);
        let limit = self.options.limits.objects as u64;
        if self.state.objects <= limit {
            return Ok(());
        }
        let place = self.place();
        let message = format!("the scene has more than {limit} objects, counting parts and copies");
        Err(self.fail_fatally(
            place,
            message,
            "check for a loop that does not end or a part that doubles repeatedly, or raise the limit: `--limit objects=N`",
        ))
    }

    /// Counts entries of textures and meshes against a limit of the caller.
    ///
    /// # Errors
    /// If they are too many.
    #[inline]
    pub(crate) fn count_parts(&mut self, count: u64) -> PResult<()> {
        self.made_progress();
        self.state.parts = self.state.parts.saturating_add(count);
        if self.state.parts <= self.options.limits.parts {
            return Ok(());
        }
        let (place, limit) = (self.place(), self.options.limits.parts);
        let message = format!("the textures and meshes of the scene have more than {limit} parts");
        Err(self.fail_fatally(
            place,
            message,
            "check for a loop that does not end or a texture that doubles repeatedly, or raise the limit: `--limit parts=N`",
        ))
    }
}
