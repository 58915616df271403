use super::bounds;
use crate::grammar::Entity;
use crate::grammar::entity::{has_no_surface, is_nothing, transform};
use crate::grammar::texture::fill_parts;
use crate::keywords::{Word, WordKind};
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};
use crate::value::Value;
use strahl_geometry::{GeometryError, Primitive, Shape};
use strahl_scene::{CsgOp, Object, ObjectKind};

/// State between the items of an object, besides the object itself.
#[derive(Default)]
struct Draft {
    /// Whether the texture has changed, so that the material is out of date.
    textured: bool,
    /// The objects of `bounded_by`, for `clipped_by { bounded_by }`.
    bounds: Vec<Object>,
    /// The objects of `clipped_by`, for `bounded_by { clipped_by }`.
    clips: Vec<Object>,
    /// Whether the bounds also clip, so that they hide nothing more.
    bounds_clip: bool,
    /// Whether `split_union off` is given.
    is_whole: bool,
}

impl Parser<'_> {
    /// Reads a simple object: with `f` its parameters after the opening brace, then the modifiers of all objects.
    ///
    /// # Errors
    /// If the text is invalid or a number is not finite.
    pub(crate) fn shape<S: Into<Shape>>(
        &mut self,
        f: impl FnOnce(&mut Self) -> PResult<Result<S, GeometryError>>,
    ) -> PResult<Entity> {
        self.simple(|p| Ok(f(p)?.map(|shape| ObjectKind::Shape(shape.into()))))
    }

    /// Like [`Parser::shape`] for objects that may be several shapes.
    ///
    /// An object without extent is invisible and is left out with a warning; NaN or infinite parameters are an error.
    ///
    /// # Errors
    /// If the text is invalid or a number is not finite.
    pub(super) fn simple(
        &mut self,
        f: impl FnOnce(&mut Self) -> PResult<Result<ObjectKind, GeometryError>>,
    ) -> PResult<Entity> {
        let place = self.place();
        self.braces(|p| {
            let mut entity = match f(p)? {
                Ok(kind) => Object::new(kind).into(),
                Err(
                    error @ (GeometryError::NotFinite { .. } | GeometryError::NotFiniteAt { .. }),
                ) => return Err(p.fail(place, error.to_string())),
                Err(error) => {
                    p.warn_hint(place, error.to_string(), "the object is left out");
                    Entity::nothing()
                }
            };
            entity.object.span = p.span_at(place);
            p.modifiers(&mut entity)?;
            Ok(entity)
        })
    }

    /// Transformations, textures and flags up to the closing brace, in their order: transformations move the textures and
    /// clipping objects before them.
    ///
    /// # Errors
    /// If an item is invalid.
    pub(crate) fn modifiers(&mut self, entity: &mut Entity) -> PResult<()> {
        let mut draft = Draft::default();
        self.items("the object", |p, token| {
            if p.modifier(entity, &mut draft, token)? {
                return Ok(());
            }
            p.skip_item(token, "the object")
        })?;
        if draft.textured
            && let Some(texture) = &entity.texture
        {
            entity.object.material = Some(self.material(texture));
            let fills = texture.whole_interior().is_some() || texture.inner_surface.is_some();
            if fills {
                self.expand_unfilled(&mut entity.object)?;
            }
            if fills || self.state.materials.has_bare() {
                fill_parts(&mut entity.object, texture);
            }
        }
        let object = &mut entity.object;
        if draft.is_whole || !draft.bounds.is_empty() {
            show_parts(object);
        }
        if !draft.bounds_clip {
            let bounds = bounds::deciding(object, draft.bounds, &self.state.shared);
            surround(object, CsgOp::Bound, bounds);
        }
        Ok(())
    }

    fn modifier(&mut self, entity: &mut Entity, draft: &mut Draft, token: Token) -> PResult<bool> {
        if let Some(map) = self.transformation(token)? {
            if token.is(Word::Scale) {
                self.scale_boxes(&mut entity.object, &map)?;
            }
            entity.transform(&map);
            for bound in &mut draft.bounds {
                transform(bound, &map);
            }
            return Ok(true);
        }
        let visibility = &mut entity.object.visibility;
        match token.word() {
            Some(
                Word::Pigment
                | Word::Normal
                | Word::Finish
                | Word::Texture
                | Word::InteriorTexture
                | Word::Interior
                | Word::Material,
            ) => {
                // The item is in the space to which the object has been moved, and so is the default texture, which the object
                // gets only here.
                let moved = entity.object.transform.is_some() && !entity.object.uv_mapped;
                let mut texture = match entity.texture.take() {
                    Some(texture) if moved => texture.transformed(&entity.placement()),
                    Some(texture) => texture,
                    None => self.state.default_texture.clone(),
                };
                self.texture_item(&mut texture, token)?;
                entity.texture = Some(if moved {
                    texture.transformed(&entity.placement().inverted())
                } else {
                    texture
                });
                draft.textured = true;
                return Ok(true);
            }
            Some(Word::UvMapping) => {
                self.take(token)?;
                let mapped = self.flag()?;
                entity.object.uv_mapped = mapped;
                if mapped {
                    self.expand_instances(&mut entity.object)?;
                }
                // The parts of a mesh with several textures are one object.
                let object = &mut entity.object;
                if let ObjectKind::Csg { children, .. } = &mut object.kind {
                    let own = children
                        .0
                        .iter_mut()
                        .filter(|part| part.span == object.span);
                    own.for_each(|part| part.uv_mapped = mapped);
                }
                return Ok(true);
            }
            Some(Word::NoShadow) => visibility.shadow = false,
            Some(Word::NoImage) => visibility.camera = false,
            Some(Word::NoReflection) => visibility.secondary = false,
            Some(Word::DoubleIlluminate) => entity.object.double_illuminated = true,
            Some(Word::GlobalLights) => {
                let ObjectKind::Csg {
                    op: CsgOp::LightGroup { .. },
                    ..
                } = entity.object.kind
                else {
                    return Ok(false);
                };
                self.take(token)?;
                let on = self.switched()?;
                if let ObjectKind::Csg {
                    op: CsgOp::LightGroup { global_lights, .. },
                    ..
                } = &mut entity.object.kind
                {
                    *global_lights = on;
                }
                return Ok(true);
            }
            Some(Word::Inverse) => {
                self.take(token)?;
                invert(&mut entity.object);
                return Ok(true);
            }
            Some(Word::ClippedBy) => {
                self.take(token)?;
                let (clips, named) =
                    self.enclosing("`clipped_by`", Word::BoundedBy, &draft.bounds)?;
                draft.bounds_clip |= named;
                draft.clips.clone_from(&clips);
                surround(&mut entity.object, CsgOp::Clip, clips);
                return Ok(true);
            }
            Some(Word::BoundedBy) => {
                self.take(token)?;
                let (bounds, named) =
                    self.enclosing("`bounded_by`", Word::ClippedBy, &draft.clips)?;
                draft.bounds_clip |= named && draft.bounds.is_empty();
                draft.bounds.extend(bounds);
                return Ok(true);
            }
            Some(Word::Hollow) => entity.object.hollow = Some(true),
            // These select methods of POV-Ray, and have no effect here.
            Some(Word::Hierarchy | Word::SplitUnion | Word::Sturm) => {}
            // A colour in an old scene, for quick previews.
            Some(word) if word.kind() == WordKind::Color => {
                self.warn_hint(
                    self.place_of(token),
                    "a colour of the object itself has no effect",
                    "write `pigment { ... }` around it",
                );
                return self.color().map(|_| true);
            }
            _ => return Ok(false),
        }
        self.take(token)?;
        let on = self.switched()?;
        if token.is(Word::SplitUnion) {
            draft.is_whole = !on;
        }
        if !on {
            let visibility = &mut entity.object.visibility;
            match token.word() {
                Some(Word::NoShadow) => visibility.shadow = true,
                Some(Word::NoImage) => visibility.camera = true,
                Some(Word::NoReflection) => visibility.secondary = true,
                Some(Word::DoubleIlluminate) => entity.object.double_illuminated = false,
                Some(Word::Hollow) => entity.object.hollow = Some(false),
                _ => {}
            }
        }
        Ok(true)
    }

    /// The value of a flag: `on`, `off`, or nothing for `on`.
    ///
    /// # Errors
    /// If the value is invalid.
    pub(in crate::grammar) fn switched(&mut self) -> PResult<bool> {
        Ok(!self.number_follows()? || self.float()? != 0.0)
    }

    /// Whether a number follows, and not the next item.
    pub(in crate::grammar) fn number_follows(&mut self) -> PResult<bool> {
        let token = self.peek()?;
        Ok(match token.kind {
            Kind::Number | Kind::Plus | Kind::Minus | Kind::Bang | Kind::LeftParen => true,
            Kind::Word => token
                .word()
                .is_some_and(|w| matches!(w.kind(), WordKind::Constant | WordKind::FloatFunction)),
            Kind::Name => token.symbol().is_some_and(|symbol| {
                let value = self.scopes.find(symbol);
                matches!(value, Some(Value::Float(_) | Value::Array(_)))
            }),
            _ => false,
        })
    }

    /// The objects in the braces of `clipped_by` or `bounded_by`, or, if the braces name the other keyword, its objects; and whether
    /// they do.
    fn enclosing(
        &mut self,
        what: &str,
        other: Word,
        known: &[Object],
    ) -> PResult<(Vec<Object>, bool)> {
        let place = self.place();
        let mut found = vec![];
        let mut named = false;
        self.braces(|p| {
            if p.accept_word(other)? {
                found = known.to_vec();
                named = true;
                return Ok(());
            }
            found = p.parts()?;
            let mut token = p.peek()?;
            if found.is_empty() {
                return Err(p.unexpected(token, "an object"));
            }
            // Transformations after the objects move all of them.
            while let Some(map) = p.transformation(token)? {
                found.iter_mut().for_each(|object| transform(object, &map));
                token = p.peek()?;
            }
            Ok(())
        })?;
        if found.is_empty() {
            let other = other.text();
            self.warn(
                place,
                format!("there is no `{other}` before this {what}, so it has no effect"),
            );
        }
        Ok((found, named))
    }
}

/// Clips an object without a cap, or bounds it; the others are in the space of its parent.
pub(super) fn surround(object: &mut Object, op: CsgOp, mut others: Vec<Object>) {
    if op == CsgOp::Clip && others.iter().any(is_nothing) {
        object.kind = Object::csg(CsgOp::Union, vec![]).kind;
    }
    others.retain(|other| !has_no_surface(other));
    if others.is_empty() || has_no_surface(object) {
        return;
    }
    let back = object.transform.as_deref().map(|t| t.inverted());
    wrap(object, op);
    if let ObjectKind::Csg { children, .. } = &mut object.kind {
        children.0.extend(others.into_iter().map(|mut other| {
            if let Some(back) = &back {
                transform(&mut other, back);
            }
            other
        }));
    }
}

/// Swaps inside and outside; surfaces without an inside stay as they are.
fn invert(object: &mut Object) {
    if let ObjectKind::Csg { op, children } = &mut object.kind
        && children.0.is_empty()
    {
        *op = match op {
            CsgOp::Inverse => CsgOp::Union,
            _ => CsgOp::Inverse,
        };
        return;
    }
    let is_open =
        |kind: &ObjectKind| matches!(kind, ObjectKind::Shape(shape) if shape.as_solid().is_none());
    let open = match &object.kind {
        // A mesh of several textures, above all.
        ObjectKind::Csg {
            op: CsgOp::Union,
            children,
        } => children.0.iter().all(|part| is_open(&part.kind)),
        kind => is_open(kind),
    };
    if !open {
        wrap(object, CsgOp::Inverse);
    }
}

/// Makes the parts of a union visible to camera and shadow rays, at any depth: in a union that is not split (one with `bounded_by` or
/// `split_union off`) POV-Ray ignores `no_image` and `no_shadow` of parts, unless all parts have `no_shadow` (measured).
fn show_parts(object: &mut Object) {
    let ObjectKind::Csg {
        op: CsgOp::Union,
        children,
    } = &mut object.kind
    else {
        return;
    };
    let casts_shadows = children.0.iter().any(|part| part.visibility.shadow);
    object.visibility.shadow &= casts_shadows;
    let mut waiting: Vec<&mut Object> = children.0.iter_mut().collect();
    while let Some(part) = waiting.pop() {
        part.visibility.camera = true;
        part.visibility.shadow |= casts_shadows;
        if let ObjectKind::Csg { children, .. } = &mut part.kind {
            waiting.extend(children.0.iter_mut());
        }
    }
}

/// Wraps an operation around the kind of an object; its other properties stay.
fn wrap(object: &mut Object, op: CsgOp) {
    let nothing = Object::csg(CsgOp::Union, vec![]).kind;
    let mut inner = Object::new(std::mem::replace(&mut object.kind, nothing));
    inner.span = object.span;
    object.kind = Object::csg(op, vec![inner]).kind;
}
