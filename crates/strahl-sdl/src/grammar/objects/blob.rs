use crate::grammar::texture::Components;
use crate::grammar::{Entity, Texture};
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use std::sync::Arc;
use strahl_geometry::{Blob, BlobComponent, Shape};
use strahl_math::DVec3;
use strahl_shade::texture::{Shares, Texture as Surface};

/// The parts of a blob read so far.
struct Draft {
    threshold: f64,
    components: Vec<BlobComponent>,
    /// The index of each component's texture; 0 is that of the whole blob.
    textures: Vec<usize>,
    /// The textures from index 1 on.
    own: Vec<Arc<Surface>>,
}

/// `blob { threshold t sphere { ... } cylinder { ... } component ... }`
///
/// Components may have their own textures and transformations. Where fields overlap, the textures are mixed by field strength.
pub(super) fn blob(p: &mut Parser<'_>) -> PResult<Entity> {
    let mut draft = Draft {
        threshold: 1.0,
        components: vec![],
        textures: vec![],
        own: vec![],
    };
    let mut shape = None;
    let mut entity = p.shape(|p| {
        while p.blob_item(&mut draft)? {
            p.comma()?;
        }
        let components = std::mem::take(&mut draft.components);
        if components.is_empty() {
            let token = p.peek()?;
            let message = format!(
                "expected a component of the blob, found {}",
                p.describe(token)
            );
            let place = p.place_of(token);
            return Err(p.fail_hint(
                place,
                message,
                "write at least one `sphere`, `cylinder` or `component` before all other items but `threshold`",
            ));
        }
        Ok(Blob::try_new(draft.threshold, components).map(|blob| {
            let blob = Arc::new(blob);
            shape = Some(Arc::clone(&blob));
            Shape::Blob(blob)
        }))
    })?;
    if let Some(texture) = &mut entity.texture {
        // A pattern that replaces the colour of a blob behind its braces does not take over its modifiers (measured).
        texture.forget_modifiers_of_color();
    }
    if let Some(blob) = shape
        && !draft.own.is_empty()
    {
        // A default texture does not move with the object.
        let whole = entity.texture.take().unwrap_or_else(|| {
            let back = entity.placement().inverted();
            p.state.default_texture.transformed(&back)
        });
        let shares = ByField {
            blob,
            textures: draft.textures,
        };
        let components = Components {
            shares: Arc::new(shares),
            own: draft.own,
        };
        let texture = Texture {
            components: Some(Arc::new(components)),
            ..whole
        };
        entity.object.material = Some(p.material(&texture));
        entity.texture = Some(texture);
    }
    Ok(entity)
}

impl Parser<'_> {
    /// Reads a component or the threshold; returns `false` if neither follows.
    fn blob_item(&mut self, draft: &mut Draft) -> PResult<bool> {
        let token = self.peek()?;
        match token.word() {
            Some(Word::Threshold) => {
                self.take(token)?;
                draft.threshold = self.float()?;
            }
            Some(Word::Sphere) => {
                self.take(token)?;
                self.braces(|p| {
                    let center = p.vector3()?;
                    let (radius, strength) = p.radius_and_strength()?;
                    let ball = BlobComponent::sphere(center, radius, strength);
                    p.component_items(draft, ball)
                })?;
            }
            Some(Word::Cylinder) => {
                self.take(token)?;
                self.braces(|p| {
                    let first = p.vector3()?;
                    p.comma()?;
                    let second = p.vector3()?;
                    let (radius, strength) = p.radius_and_strength()?;
                    let capsule = BlobComponent::cylinder(first, second, radius, strength);
                    p.component_items(draft, capsule)
                })?;
            }
            // The old syntax of a spherical component.
            Some(Word::Component) => {
                self.take(token)?;
                let strength = self.float()?;
                self.comma()?;
                let radius = self.float()?;
                self.comma()?;
                let center: DVec3 = self.vector3()?;
                draft.textures.push(0);
                draft
                    .components
                    .push(BlobComponent::sphere(center, radius, strength));
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn radius_and_strength(&mut self) -> PResult<(f64, f64)> {
        self.comma()?;
        let radius = self.float()?;
        self.comma()?;
        self.accept_word(Word::Strength)?;
        Ok((radius, self.float()?))
    }

    /// Textures and transformations of a component, up to its closing brace; transformations move the textures before them.
    fn component_items(&mut self, draft: &mut Draft, component: BlobComponent) -> PResult<()> {
        let mut component = component;
        let mut texture: Option<Texture> = None;
        self.items("the component", |p, token| {
            if let Some(map) = p.transformation(token)? {
                component = component.transformed(&map);
                texture = texture.take().map(|texture| texture.transformed(&map));
                return Ok(());
            }
            if matches!(
                token.word(),
                Some(Word::Pigment | Word::Normal | Word::Finish | Word::Texture | Word::UvMapping)
            ) {
                let known = texture.take();
                let mut changed = known.unwrap_or_else(|| p.state.default_texture.clone());
                p.texture_item(&mut changed, token)?;
                texture = Some(changed);
                return Ok(());
            }
            p.skip_item(token, "the component")
        })?;
        draft.components.push(component);
        draft.textures.push(match texture {
            None => 0,
            Some(texture) => {
                draft.own.push(texture.surface);
                draft.own.len()
            }
        });
        Ok(())
    }
}

/// Mixes the textures of a blob by the field strengths of its components.
#[derive(Debug)]
struct ByField {
    blob: Arc<Blob>,
    /// The index of each component's texture.
    textures: Vec<usize>,
}

impl Shares for ByField {
    fn shares_at(&self, point: DVec3, visit: &mut dyn FnMut(usize, f64)) {
        let mut sum = 0.0;
        // The weights of the textures so far. The list is short, because few components reach one point.
        let mut parts: Vec<(usize, f64)> = vec![];
        self.blob.fields_at(point, |component, field, _| {
            let number = self.textures.get(component).copied().unwrap_or_default();
            sum += field.abs();
            match parts.iter_mut().find(|(known, _)| *known == number) {
                Some((_, part)) => *part += field.abs(),
                None => parts.push((number, field.abs())),
            }
        });
        if parts.is_empty() {
            // Rounding has moved the point outside of all fields.
            return visit(0, 1.0);
        }
        for (number, part) in parts {
            visit(number, part / sum);
        }
    }
}
