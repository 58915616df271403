use super::Texture;
use crate::parser::Parser;
use std::sync::Arc;
use strahl_math::Transform;
use strahl_scene::{Object, ObjectKind};
use strahl_shade::Material;
use strahl_shade::interior::Interior;
use strahl_shade::pigment::Pigment;
use strahl_shade::texture::{SharedTexture, Texture as Surface};

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
        (Pigment::Solid(first), Pigment::Solid(second)) => {
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
        same_inner && self.interior == other.interior && same_surface(&self.surface, &other.surface)
    }
}

impl Texture {
    fn to_material(&self) -> Material {
        let interior = self.whole_interior();
        Material {
            eta: interior.as_ref().map_or(1.0, |i| i.ior),
            inner_texture: self.inner_surface.clone().map(SharedTexture),
            interior,
            ..Material::textured(SharedTexture(Arc::clone(&self.surface)))
        }
    }

    /// The interior, including properties that old scenes write into the finish.
    pub(in crate::grammar) fn whole_interior(&self) -> Option<Arc<Interior>> {
        let finish = &self.top().finish;
        if finish.ior.is_none() && finish.caustics.is_none() {
            return self.interior.clone();
        }
        let mut interior = self.interior.as_deref().copied().unwrap_or_default();
        interior.ior = finish.ior.unwrap_or(interior.ior);
        interior.caustics = finish.caustics.unwrap_or(interior.caustics);
        Some(Arc::new(interior))
    }

    /// Whether the object has an interior but no texture, so that it takes its texture from the object it is a part of, or else
    /// the default.
    pub(in crate::grammar) fn is_bare(&self) -> bool {
        !self.written && self.inner_surface.is_none() && self.interior.is_some()
    }
}

/// Whether a material has an interior but no texture.
pub(in crate::grammar) fn is_bare(material: &Material) -> bool {
    material.texture.is_none()
}

/// Completes the looks of the parts of a CSG object: parts without a texture get that of the whole, parts without an interior get
/// that of the whole.
pub(in crate::grammar) fn fill_parts(object: &mut Object, whole: &Texture) {
    // Parts that shared a material share the completed one too.
    let mut filled: Vec<(Arc<Material>, Arc<Material>)> = vec![];
    let interior = object.material.as_ref().and_then(|m| m.interior.clone());
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
            if let Some(before) = &child.material {
                let after = if is_bare(before) {
                    (!whole.is_bare()).then(|| {
                        let covered = whole.transformed(&map.inverted());
                        let texture = Texture {
                            interior: before.interior.clone(),
                            ..covered
                        };
                        Arc::new(texture.to_material())
                    })
                } else if let (None, Some(interior)) = (&before.interior, &interior) {
                    let mut known = filled.iter().rev().take(RECENT);
                    Some(match known.find(|(old, _)| Arc::ptr_eq(old, before)) {
                        Some((_, after)) => Arc::clone(after),
                        None => {
                            let after = Arc::new(Material {
                                interior: Some(Arc::clone(interior)),
                                eta: interior.ior,
                                ..Material::clone(before)
                            });
                            filled.push((Arc::clone(before), Arc::clone(&after)));
                            after
                        }
                    })
                } else {
                    None
                };
                if after.is_some() {
                    child.material = after;
                }
            }
            waiting.push((child, map));
        }
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
    /// Whether there are bare materials.
    bare: bool,
}

impl KnownMaterials {
    /// Size of the table of materials with one colour. Small enough that a replaced material is still in the cache when it is
    /// freed.
    const PLAIN: usize = 1 << 10;

    /// Whether a material with an interior but no texture has been created.
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
    let Pigment::Solid(color) = &plain.pigment else {
        return None;
    };
    if texture.inner_surface.is_some() || plain.normal.is_some() {
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
