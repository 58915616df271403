//! `texture { ... }` and `material { ... }`

use super::layers::layered;
use super::loose::{BLOCKS_SINCE, Loose};
use super::maps::{blends_blocks, numbered};
use super::{Texture, modifiers, top_of, transform, weight};
use crate::grammar::Thing;
use crate::keywords::Word;
use crate::parser::{Failed, PResult, Parser};
use crate::token::{Kind, Token};
use std::sync::Arc;
use strahl_shade::SharedList;
use strahl_shade::normal::PovNormal;
use strahl_shade::patterns::{Modifiers, Pattern, PatternField};
use strahl_shade::pigment::{BlendMap, Pigment};
use strahl_shade::texture::Texture as Surface;

/// The part of a texture that selects between textures.
enum Chooser {
    /// None: there is one texture.
    Single,
    Pattern(Pattern),
    Average,
}

/// The textures to select from.
enum Choice {
    Nothing,
    Map(BlendMap<Surface>),
    Blocks(SharedList<Surface>),
}

/// A texture being read.
struct Draft {
    /// The texture, if there is only one.
    single: Surface,
    chooser: Chooser,
    choice: Choice,
    modifiers: Modifiers,
    /// Of scenes before version 3.0.
    loose: Loose,
}

impl From<Surface> for Draft {
    fn from(texture: Surface) -> Self {
        let patterned = |field: Box<PatternField>, choice| Self {
            single: Surface::default(),
            chooser: Chooser::Pattern(field.pattern),
            choice,
            modifiers: field.modifiers,
            loose: Loose::default(),
        };
        match texture {
            Surface::Map(field, map) => patterned(field, Choice::Map(map)),
            Surface::Blocks(field, list) => patterned(field, Choice::Blocks(list)),
            Surface::Average(members, modifiers) => Self {
                single: Surface::default(),
                chooser: Chooser::Average,
                choice: Choice::Map(BlendMap::new(members)),
                modifiers: *modifiers,
                loose: Loose::default(),
            },
            single => Self {
                single,
                chooser: Chooser::Single,
                choice: Choice::Nothing,
                modifiers: Modifiers::default(),
                loose: Loose::default(),
            },
        }
    }
}

impl Draft {
    fn finish(mut self) -> Surface {
        self.loose.put_into(&mut self.single);
        match (self.chooser, self.choice) {
            (Chooser::Single, _) => self.single,
            (Chooser::Average, Choice::Map(map)) => {
                Surface::Average(map.entries, Box::new(self.modifiers))
            }
            (Chooser::Average, _) => self.single,
            (Chooser::Pattern(pattern), choice) => {
                let field = Box::new(PatternField {
                    pattern,
                    modifiers: self.modifiers,
                });
                match choice {
                    Choice::Map(map) => Surface::Map(field, map),
                    Choice::Blocks(list) if blends_blocks(&field.modifiers) => {
                        Surface::Map(field, numbered(&list))
                    }
                    Choice::Blocks(list) => Surface::Blocks(field, list),
                    Choice::Nothing => self.single,
                }
            }
        }
    }
}

/// The texture on texture coordinates, as `texture { uv_mapping ... }` shows it.
fn on_surface(texture: Surface) -> Surface {
    match texture {
        // Only the pigment's place counts.
        Surface::Plain(mut plain) if plain.normal.is_none() => {
            plain.pigment = match plain.pigment {
                mapped @ Pigment::UvMapped(_) => mapped,
                pigment => Pigment::UvMapped(Box::new(pigment)),
            };
            Surface::Plain(plain)
        }
        Surface::Layered(layers) if !layers.iter().any(has_normal) => {
            let layers = layers.iter().cloned();
            Surface::Layered(layers.map(on_surface).collect())
        }
        mapped @ Surface::UvMapped(_) => mapped,
        other => Surface::UvMapped(Box::new(other)),
    }
}

/// Whether a layer may have a normal of its own.
fn has_normal(layer: &Surface) -> bool {
    !matches!(layer, Surface::Plain(plain) if plain.normal.is_none())
}

impl Parser<'_> {
    /// `{ ... }` after `texture`, as the look of an object.
    pub(crate) fn texture_block(&mut self) -> PResult<Texture> {
        Ok(Texture {
            surface: self.surface_block()?,
            written: true,
            ..Texture::default()
        })
    }

    fn texture_name(&mut self) -> PResult<Option<Arc<Surface>>> {
        self.accept_thing(|thing| match thing {
            Thing::Texture(texture) => Some(texture),
            _ => None,
        })
    }

    /// The name of a texture, as the look of an object.
    pub(crate) fn named_texture(&mut self) -> PResult<Option<Texture>> {
        let named = self.texture_name()?;
        Ok(named.map(|surface| Texture {
            surface,
            written: true,
            ..Texture::default()
        }))
    }

    /// `{ ... }` after `texture` in a declaration; further textures directly after it are layered over it.
    pub(crate) fn declared_texture(&mut self) -> PResult<Arc<Surface>> {
        let mut all = self.surface_block()?;
        while self.raw().is(Word::Texture) {
            self.next()?;
            let upper = self.surface_block()?;
            self.weigh(weight::of_texture(&all))?;
            let (lower, upper) = (Surface::clone(&all), Surface::clone(&upper));
            all = Arc::new(layered(lower, upper));
        }
        self.layers_of_version(&mut all);
        Ok(all)
    }

    /// `{ ... }` after `texture`; a single name is shared, not copied.
    pub(super) fn surface_block(&mut self) -> PResult<Arc<Surface>> {
        self.braces(|p| {
            let named = p.texture_name()?;
            if let Some(named) = &named
                && p.peek()?.kind == Kind::RightBrace
            {
                return Ok(Arc::clone(named));
            }
            p.rest_of_texture(Kind::RightBrace, named).map(Arc::new)
        })
    }

    /// The items in the brackets of an entry of `texture_map`.
    pub(super) fn texture_items(&mut self, closing: Kind) -> PResult<Surface> {
        let named = self.texture_name()?;
        self.rest_of_texture(closing, named)
    }

    fn rest_of_texture(&mut self, closing: Kind, named: Option<Arc<Surface>>) -> PResult<Surface> {
        if named.is_none() && self.accept_word(Word::UvMapping)? {
            return self.nested(|p| p.texture_items(closing)).map(on_surface);
        }
        let base = named.unwrap_or_else(|| Arc::clone(&self.state.default_texture.surface));
        let mut single = Surface::clone(&base);
        // Most textures consist of a pigment and a finish.
        while matches!(single, Surface::Plain(_)) {
            let token = self.peek()?;
            match token.word() {
                Some(Word::Pigment | Word::Normal | Word::Finish) => {
                    self.plain_item(&mut single, token)?;
                }
                _ if token.kind == closing => {
                    self.weigh(weight::of_texture(&single))?;
                    return Ok(single);
                }
                _ => break,
            }
        }
        let mut draft = Draft::from(single);
        self.items_until(closing, "`texture`", |p, token| {
            p.texture_part(&mut draft, token)
        })?;
        let texture = draft.finish();
        self.weigh(weight::of_texture(&texture))?;
        Ok(texture)
    }

    /// The error for `uv_mapping` behind the beginning of a pigment, normal or texture, where POV-Ray rejects it too.
    pub(super) fn late_uv_mapping(&mut self, token: Token, statement: &str) -> Failed {
        self.fail_hint(
            self.place_of(token),
            "`uv_mapping` must come first",
            format!("write it directly behind `{statement} {{`"),
        )
    }

    fn texture_part(&mut self, draft: &mut Draft, token: Token) -> PResult<()> {
        if let Some(by) = self.transformation(token)? {
            transform(&mut draft.single, &by);
            modifiers::transform(&mut draft.modifiers.warps, &by);
            draft.loose.transform(&by);
            return Ok(());
        }
        if self.version < BLOCKS_SINCE {
            if self.loose_item(&mut draft.loose, &mut draft.single, token)? {
                return Ok(());
            }
            draft.loose.put_into(&mut draft.single);
        }
        match token.word() {
            Some(Word::Pigment | Word::Normal | Word::Finish) => {
                return self.plain_item(&mut draft.single, token);
            }
            Some(Word::TextureMap) => {
                self.take(token)?;
                let map = self.texture_map()?;
                draft.choice = Choice::Map(match &draft.chooser {
                    Chooser::Average => map,
                    _ => self.in_order(map),
                });
                return Ok(());
            }
            Some(Word::Average) => {
                self.take(token)?;
                draft.chooser = Chooser::Average;
                return Ok(());
            }
            Some(Word::UvMapping) => return Err(self.late_uv_mapping(token, "texture")),
            Some(Word::Tiles) => {
                self.take(token)?;
                return self.tiles(draft);
            }
            Some(Word::Texture) => {
                return Err(self.fail_hint(
                    self.place_of(token),
                    "a texture cannot contain a texture",
                    "write layered textures one after the other, and textures to choose from in a `texture_map`",
                ));
            }
            Some(Word::MaterialMap) => {
                self.take(token)?;
                return self.material_map(draft);
            }
            // It belongs to the normals in the texture.
            Some(Word::NoBumpScale) => {
                self.take(token)?;
                let switch = self.flag()?;
                if let Some(normal) = top_of(&mut draft.single).and_then(|t| t.normal.as_mut()) {
                    normal.no_bump_scale = switch;
                }
                return Ok(());
            }
            _ => {}
        }
        if let Some(pattern) = self.pattern(token)? {
            self.block_textures(draft, &pattern)?;
            if let Chooser::Single = draft.chooser {
                draft.modifiers.noise = self.noise_of(&pattern);
            }
            modifiers::begin(&mut draft.modifiers, &pattern);
            draft.chooser = Chooser::Pattern(pattern);
            return Ok(());
        }
        if let Chooser::Average = draft.chooser
            && self.pattern_modifier(&mut draft.modifiers, token)?
        {
            return Ok(());
        }
        if let Chooser::Pattern(pattern) = &mut draft.chooser
            && (self.pattern_parameter(Some(pattern), token)?
                || self.pattern_modifier(&mut draft.modifiers, token)?)
        {
            return Ok(());
        }
        if self.named_part(draft)? {
            return Ok(());
        }
        self.skip_item(token, "`texture`")
    }

    /// The name of a pigment, normal or finish directly in a texture, where it replaces that part.
    fn named_part(&mut self, draft: &mut Draft) -> PResult<bool> {
        let found = self.accept_thing(|thing| match thing {
            Thing::Pigment(pigment) => Some(pigment),
            _ => None,
        })?;
        if let (Some(pigment), Some(top)) = (&found, top_of(&mut draft.single)) {
            top.pigment = Pigment::clone(pigment);
            return Ok(true);
        }
        let found = self.accept_thing(|thing| match thing {
            Thing::Normal(normal) => Some(normal),
            _ => None,
        })?;
        if let (Some(normal), Some(top)) = (&found, top_of(&mut draft.single)) {
            top.normal = Some(Box::new(PovNormal::clone(normal)));
            return Ok(true);
        }
        let found = self.accept_thing(|thing| match thing {
            Thing::Finish(finish) => Some(finish),
            _ => None,
        })?;
        if let (Some(finish), Some(top)) = (&found, top_of(&mut draft.single)) {
            top.finish = Arc::clone(finish);
            return Ok(true);
        }
        Ok(false)
    }

    /// The textures of the blocks of a block pattern.
    fn block_textures(&mut self, draft: &mut Draft, pattern: &Pattern) -> PResult<()> {
        let blocks = self.blocks(
            pattern,
            Word::Texture,
            Self::comma,
            |p| p.surface_block().map(|texture| Surface::clone(&texture)),
            |p| Surface::clone(&p.state.default_texture.surface),
        )?;
        if let Some(list) = blocks {
            draft.choice = Choice::Blocks(list);
        }
        Ok(())
    }

    /// `texture {...} tile2 texture {...}` after `tiles`: an old keyword for a checker, whose second colour is the first tile
    /// (measured); braces around it are optional.
    fn tiles(&mut self, draft: &mut Draft) -> PResult<()> {
        if self.peek()?.kind == Kind::LeftBrace {
            return self.braces(|p| p.two_tiles(draft));
        }
        self.two_tiles(draft)
    }

    fn two_tiles(&mut self, draft: &mut Draft) -> PResult<()> {
        let mut list = vec![];
        for is_second in [false, true] {
            if is_second {
                let token = self.peek()?;
                if !self.accept_word(Word::Tile2)? {
                    return Err(self.unexpected(token, "`tile2`"));
                }
            }
            let token = self.peek()?;
            if !self.accept_word(Word::Texture)? {
                return Err(self.unexpected(token, "`texture`"));
            }
            let texture = self.nested(Self::surface_block)?;
            list.push(Surface::clone(&texture));
        }
        list.reverse();
        modifiers::begin(&mut draft.modifiers, &Pattern::Checker);
        draft.chooser = Chooser::Pattern(Pattern::Checker);
        draft.choice = Choice::Blocks(list.into());
        Ok(())
    }

    /// `{ picture textures }` after `material_map`.
    fn material_map(&mut self, draft: &mut Draft) -> PResult<()> {
        let mut list = vec![];
        let place = self.place();
        let image = self.material_bitmap(|p, token| {
            if !token.is(Word::Texture) {
                return Ok(false);
            }
            p.take(token)?;
            let texture = p.nested(Self::surface_block)?;
            list.push(Surface::clone(&texture));
            Ok(true)
        })?;
        if list.is_empty() {
            return Err(self.fail_hint(
                place,
                "`material_map` needs at least one texture",
                "write `texture { ... }` after the picture, one for each value of its texels",
            ));
        }
        draft.single = match image {
            Some(image) => Surface::MaterialMap(image, Box::default(), list.into()),
            None => list.swap_remove(0),
        };
        draft.chooser = Chooser::Single;
        Ok(())
    }

    /// `{ ... }` after `material`, which changes the look of an object: its textures are layered over those of the object, and
    /// its transformations transform them all, except those of the inside (measured).
    pub(crate) fn material_block(&mut self, look: &mut Texture) -> PResult<()> {
        self.braces(|p| {
            let named = p.accept_thing(|thing| match thing {
                Thing::Material(material) => Some(material),
                _ => None,
            })?;
            if let Some(named) = named {
                if named.written {
                    look.cover(p, Arc::clone(&named.surface))?;
                }
                if let Some(inner) = &named.inner_surface {
                    look.cover_inside(p, Arc::clone(inner))?;
                }
                if named.interior.is_some() {
                    look.interior.clone_from(&named.interior);
                }
            }
            p.items("`material`", |p, token| {
                if let Some(by) = p.transformation(token)? {
                    let inside = look.inner_surface.take();
                    *look = look.transformed(&by);
                    look.inner_surface = inside;
                    return Ok(());
                }
                if p.texture_item(look, token)? {
                    return Ok(());
                }
                p.skip_item(token, "`material`")
            })
        })
    }

    /// `{ ... }` after `material` in a declaration.
    pub(crate) fn declared_material(&mut self) -> PResult<Texture> {
        let mut material = Texture {
            written: false,
            ..self.state.default_texture.clone()
        };
        self.material_block(&mut material)?;
        Ok(material)
    }
}
