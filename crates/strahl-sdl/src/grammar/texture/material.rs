use super::{Texture, is_uniform, transform};
use crate::parser::Parser;
use std::sync::Arc;
use strahl_math::Transform;
use strahl_scene::{Object, ObjectKind};
use strahl_shade::interior::Interior;
use strahl_shade::pigment::Pigment;
use strahl_shade::texture::{SharedTexture, Texture as Surface};
use strahl_shade::{Material, SharedList};

/// The number of recent materials with patterns that can be shared.
const RECENT: usize = 16;

/// Whether two surfaces are the same, or have the same colour and finish, which exporters repeat for each object.
fn same_surface(a: &Arc<Surface>, b: &Arc<Surface>) -> bool {
    if Arc::ptr_eq(a, b) {
        return true;
    }
    let (Surface::Plain(a), Surface::Plain(b)) = (&**a, &**b) else {
        return false;
    };
    match (&a.pigment, &b.pigment) {
        (Pigment::Solid(first, _), Pigment::Solid(second, _)) => {
            let same_finish = Arc::ptr_eq(&a.finish, &b.finish) || a.finish == b.finish;
            first == second && a.normal.is_none() && b.normal.is_none() && same_finish
        }
        _ => false,
    }
}

impl PartialEq for Texture {
    /// Patterned textures are equal only if they are the same object.
    fn eq(&self, other: &Self) -> bool {
        let same_inner = match (&self.inner_surface, &other.inner_surface) {
            (None, None) => true,
            (Some(a), Some(b)) => same_surface(a, b),
            _ => false,
        };
        let same_components = match (&self.components, &other.components) {
            (None, None) => true,
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            _ => false,
        };
        same_inner
            && same_components
            && self.interior == other.interior
            && same_surface(&self.surface, &other.surface)
    }
}

impl Texture {
    fn to_material(&self) -> Material {
        let interior = self.whole_interior();
        let (mut outer, mut inner) = (Arc::clone(&self.surface), self.inner_surface.clone());
        // Textures of components are seen from both sides (measured).
        if let Some(components) = &self.components {
            let whole = if self.written {
                Surface::clone(&outer)
            } else {
                missing()
            };
            outer = Arc::new(components.around(whole));
            inner = Some(Arc::clone(&outer));
        }
        Material {
            eta: interior.as_ref().map_or(1.0, |i| i.ior),
            inner_texture: inner.map(SharedTexture),
            interior,
            ..Material::textured(SharedTexture(outer))
        }
    }

    /// The interior, including properties that old scenes write into the finish.
    pub(in crate::grammar) fn whole_interior(&self) -> Option<Arc<Interior>> {
        let finish = &self.top().finish;
        if finish.ior.is_none() && finish.caustics.is_none() {
            return self.interior.clone();
        }
        let mut interior = self.interior.as_deref().copied().unwrap_or_default();
        if let Some(ior) = finish.ior {
            // It replaces the dispersion, too (measured).
            (interior.ior, interior.dispersion) = (ior, 1.0);
        }
        if let Some(exponent) = finish.caustics {
            // There it is the exponent itself (measured).
            interior.caustics = exponent / Interior::CAUSTICS_EXPONENT;
        }
        Some(Arc::new(interior))
    }

    /// Whether the object has an interior but no texture, so that it takes its texture from the object it is a part of, or else
    /// the default.
    pub(in crate::grammar) fn is_bare(&self) -> bool {
        !self.written
            && self.inner_surface.is_none()
            && self.components.is_none()
            && self.interior.is_some()
    }
}

/// Whether a material looks the same everywhere, so that [`placed`] changes nothing.
pub(in crate::grammar) fn is_same_everywhere(material: &Material) -> bool {
    let mut textures = [&material.texture, &material.inner_texture].into_iter();
    textures.all(|texture| texture.as_ref().is_none_or(|t| is_uniform(&t.0)))
}

/// A material after a transformation of its space.
pub(in crate::grammar) fn placed(material: &Material, by: &Transform) -> Material {
    let moved = |texture: &SharedTexture| {
        let mut surface = Surface::clone(&texture.0);
        transform(&mut surface, by);
        SharedTexture(Arc::new(surface))
    };
    let texture = material.texture.as_ref().map(moved);
    let inner_texture = if material.inner_texture == material.texture {
        texture.clone()
    } else {
        material.inner_texture.as_ref().map(moved)
    };
    Material {
        texture,
        inner_texture,
        ..Material::clone(material)
    }
}

/// Whether a material has an interior but no texture.
pub(in crate::grammar) fn is_bare(material: &Material) -> bool {
    material.texture.is_none()
}

/// The texture of a blob whose components have textures, as long as that of the whole is not known: it paints nothing.
fn missing() -> Surface {
    Surface::Average(SharedList::default(), Box::default())
}

/// The texture with that of the whole where it is missing, which then is missing on both sides; `None` if nothing is missing.
fn filled(texture: &SharedTexture, whole: &Surface) -> Option<SharedTexture> {
    let Surface::Shared(shares, members) = &*texture.0 else {
        return None;
    };
    let is_missing = |t: &Surface| matches!(t, Surface::Average(list, _) if list.is_empty());
    members.first().filter(|first| is_missing(first))?;
    let mut members = members.clone();
    members.make_mut()[0] = whole.clone();
    let surface = Surface::Shared(Arc::clone(shares), members);
    Some(SharedTexture(Arc::new(surface)))
}

/// Completes the looks of an object and of its parts: what has no texture, no interior texture or no interior gets that of the whole.
pub(in crate::grammar) fn fill_parts(object: &mut Object, whole: &Texture) {
    let interior = object.material.as_ref().and_then(|m| m.interior.clone());
    let mut fill = Fill {
        whole,
        interior,
        known: vec![],
    };
    if let Some(before) = &object.material
        && let Some(texture) = &before.texture
        && let Some(texture) = filled(texture, &whole.surface)
    {
        object.material = Some(Arc::new(Material {
            texture: Some(texture.clone()),
            inner_texture: Some(texture),
            ..Material::clone(before)
        }));
    }
    // The transformation from the space of a part to that of the whole.
    let mut waiting = vec![(object, Transform::IDENTITY)];
    while let Some((object, map)) = waiting.pop() {
        let ObjectKind::Csg { children, .. } = &mut object.kind else {
            continue;
        };
        for child in &mut children.0 {
            let map = match child.transform.as_deref() {
                Some(own) => own.then(&map),
                None => map,
            };
            if let Some(before) = &child.material
                && let Some(after) = fill.completed(before, &map)
            {
                child.material = Some(after);
            }
            waiting.push((child, map));
        }
    }
}

/// The look of a whole that its parts are completed by.
struct Fill<'a> {
    whole: &'a Texture,
    interior: Option<Arc<Interior>>,
    /// Materials that got an interior only, before and after: parts that shared a material share the completed one too.
    known: Vec<(Arc<Material>, Arc<Material>)>,
}

impl Fill<'_> {
    /// The completed material of a part in a space that `map` carries to that of the whole; `None` if it is complete.
    fn completed(&mut self, before: &Arc<Material>, map: &Transform) -> Option<Arc<Material>> {
        if is_bare(before) {
            return (!self.whole.is_bare()).then(|| {
                let texture = Texture {
                    interior: before.interior.clone(),
                    ..self.whole.placed(&map.inverted())
                };
                Arc::new(texture.to_material())
            });
        }
        let missing = before
            .texture
            .as_ref()
            .filter(|t| filled(t, &Surface::default()).is_some());
        let inner = self.whole.inner_surface.as_ref();
        let inner = inner.filter(|_| before.inner_texture.is_none());
        let interior = self.interior.clone();
        let interior = interior.filter(|_| before.interior.is_none());
        if missing.is_none() && inner.is_none() {
            return Some(self.with_interior(before, &interior?));
        }
        let mut after = Material::clone(before);
        let whole = self.whole.placed(&map.inverted());
        if let Some(texture) = missing {
            after.texture = filled(texture, &whole.surface);
            after.inner_texture.clone_from(&after.texture);
        }
        if inner.is_some() {
            after.inner_texture = whole.inner_surface.map(SharedTexture);
        }
        if let Some(interior) = interior {
            after.eta = interior.ior;
            after.interior = Some(interior);
        }
        Some(Arc::new(after))
    }

    fn with_interior(&mut self, before: &Arc<Material>, interior: &Arc<Interior>) -> Arc<Material> {
        let mut known = self.known.iter().rev().take(RECENT);
        if let Some((_, after)) = known.find(|(old, _)| Arc::ptr_eq(old, before)) {
            return Arc::clone(after);
        }
        let after = Arc::new(Material {
            interior: Some(Arc::clone(interior)),
            eta: interior.ior,
            ..Material::clone(before)
        });
        self.known.push((Arc::clone(before), Arc::clone(&after)));
        after
    }
}

/// Materials created so far, by their textures.
#[derive(Debug, Default)]
pub(in crate::grammar) struct KnownMaterials {
    /// The most recent ones with patterns.
    recent: Vec<(Texture, Arc<Material>)>,
    /// Materials with one colour and finish, in a hash table in which a newer one replaces an older one. Exported scenes repeat
    /// the same few colours; scenes with a different colour for each object need no table of all of them.
    plain: Vec<Option<(u64, Arc<Material>)>>,
    /// Whether there are materials that a whole completes: bare ones, and blobs with textures of components only.
    bare: bool,
}

impl KnownMaterials {
    /// Size of the table of materials with one colour. Small enough that a replaced material is still in the cache when it is
    /// freed.
    const PLAIN: usize = 1 << 10;

    /// Whether a material that a whole completes has been created: one with an interior but no texture, or of a blob with textures of
    /// components only.
    pub(in crate::grammar) const fn has_bare(&self) -> bool {
        self.bare
    }

    /// The material of a texture.
    fn of(&mut self, texture: &Texture) -> Arc<Material> {
        if texture.is_bare() {
            self.bare = true;
            return Arc::new(Material {
                texture: None,
                ..texture.to_material()
            });
        }
        self.bare |= texture.components.is_some() && !texture.written;
        match plain_hash(texture) {
            Some(hash) => self.of_plain(texture, hash),
            None => self.of_pattern(texture),
        }
    }

    fn of_plain(&mut self, texture: &Texture, hash: u64) -> Arc<Material> {
        if self.plain.is_empty() {
            self.plain.resize(Self::PLAIN, None);
        }
        let index = hash as usize % Self::PLAIN;
        if let Some(Some((known, material))) = self.plain.get(index)
            && *known == hash
            && material.interior == texture.interior
            && let Some(SharedTexture(surface)) = &material.texture
            && same_surface(surface, &texture.surface)
        {
            return Arc::clone(material);
        }
        let material = Arc::new(texture.to_material());
        if let Some(slot) = self.plain.get_mut(index) {
            *slot = Some((hash, Arc::clone(&material)));
        }
        material
    }

    fn of_pattern(&mut self, texture: &Texture) -> Arc<Material> {
        if let Some((_, material)) = self.recent.iter().find(|(known, _)| known == texture) {
            return Arc::clone(material);
        }
        let material = Arc::new(texture.to_material());
        if self.recent.len() >= RECENT {
            self.recent.remove(0);
        }
        self.recent.push((texture.clone(), Arc::clone(&material)));
        material
    }
}

/// A hash of the properties in which materials of one colour and finish usually differ; `None` for other textures.
fn plain_hash(texture: &Texture) -> Option<u64> {
    /// 2^64 divided by the golden ratio: the upper bits of the product depend on all lower ones.
    const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
    let Surface::Plain(plain) = &*texture.surface else {
        return None;
    };
    let Pigment::Solid(color, _) = &plain.pigment else {
        return None;
    };
    let is_more = texture.inner_surface.is_some() || texture.components.is_some();
    if is_more || plain.normal.is_some() {
        return None;
    }
    let (rgb, finish) = (&color.rgb, &plain.finish);
    let numbers = [
        rgb.r,
        rgb.g,
        rgb.b,
        color.filter,
        color.transmit,
        finish.ambient.r,
        finish.diffuse,
        finish.phong,
        finish.specular,
        finish.reflection.max.r,
    ];
    let mix = |hash: u64, x: f64| (hash.rotate_left(5) ^ x.to_bits()).wrapping_mul(FACTOR);
    Some(numbers.into_iter().fold(0, mix) >> 32)
}

impl Parser<'_> {
    /// The material of a texture; equal textures share it, unless they have patterns and are far apart.
    pub(in crate::grammar) fn material(&mut self, texture: &Texture) -> Arc<Material> {
        self.state.materials.of(texture)
    }
}
