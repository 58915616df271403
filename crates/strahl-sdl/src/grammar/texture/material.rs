use super::Texture;
use crate::parser::Parser;
use std::sync::Arc;
use strahl_scene::{Object, ObjectKind};
use strahl_shade::Material;
use strahl_shade::interior::Interior;
use strahl_shade::pigment::Pigment;
use strahl_shade::texture::{SharedTexture, Texture as Surface};

/// How many of the last materials with patterns are remembered for sharing.
const RECENT: usize = 16;

/// Whether two surfaces are one, or two of the same colour and finish: exporters write those out at each object.
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
    /// Patterned textures are equal only if they are one and the same.
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
        Material {
            eta: self.interior.as_ref().map_or(1.0, |i| i.ior),
            inner_texture: self.inner_surface.clone().map(SharedTexture),
            interior: self.interior.clone(),
            ..Material::textured(SharedTexture(Arc::clone(&self.surface)))
        }
    }
}

/// Fills the parts of a combined object that have a texture but no interior of their own.
pub(in crate::grammar) fn fill_parts(object: &mut Object, interior: &Arc<Interior>) {
    // Parts that shared a material go on sharing one.
    let mut filled: Vec<(Arc<Material>, Arc<Material>)> = vec![];
    let mut waiting = vec![object];
    while let Some(object) = waiting.pop() {
        let ObjectKind::Csg { children, .. } = &mut object.kind else {
            continue;
        };
        for child in &mut children.0 {
            if let Some(before) = &child.material
                && before.interior.is_none()
            {
                let known = filled.iter().rev().take(RECENT);
                let known = known.into_iter().find(|(old, _)| Arc::ptr_eq(old, before));
                let after = match known {
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
                };
                child.material = Some(after);
            }
            waiting.push(child);
        }
    }
}

/// Materials made so far, by their textures.
#[derive(Debug, Default)]
pub(in crate::grammar) struct KnownMaterials {
    /// The last ones with patterns.
    recent: Vec<(Texture, Arc<Material>)>,
    /// Those with one colour and finish, in a table by hash in which the last one replaces an earlier one. Exported scenes
    /// repeat the same few colours; scenes with a different colour for each object must not pay for a table of all.
    plain: Vec<Option<(u64, Arc<Material>)>>,
}

impl KnownMaterials {
    /// Size of the table of materials with one colour. Small enough that a replaced material is still in the cache when it is
    /// freed.
    const PLAIN: usize = 1 << 10;

    /// The material of a texture.
    fn of(&mut self, texture: &Texture) -> Arc<Material> {
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
