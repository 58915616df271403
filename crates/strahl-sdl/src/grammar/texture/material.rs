use super::Texture;
use crate::parser::Parser;
use std::sync::Arc;
use strahl_math::DVec3;
use strahl_scene::{Object, ObjectKind};
use strahl_shade::interior::Interior;
use strahl_shade::patterns::TexturePoint;
use strahl_shade::pigment::Pigment;
use strahl_shade::texture::{SharedTexture, Texture as Surface};
use strahl_shade::{Color, Finish, Material, ShadingModel};

/// How many of the last materials are kept to be shared.
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
            first == second && a.normal.is_none() && b.normal.is_none() && a.finish == b.finish
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
    /// The material, with coefficients of the classical model for who does not evaluate textures: those at the origin.
    fn to_material(&self) -> Material {
        let top = self.top();
        let origin = TexturePoint::in_space(DVec3::ZERO);
        let pigment = top.pigment.color_at(&origin);
        let (color, f) = (pigment.rgb, &top.finish);
        let phong = f.phong > 0.0 && f.specular <= 0.0;
        let (strength, shininess) = if phong {
            (f.phong, f.phong_size)
        } else {
            (f.specular, 1.0 / f.roughness)
        };
        let model = if phong {
            ShadingModel::Phong
        } else {
            ShadingModel::BlinnPhong
        };
        let finish = Finish {
            ambient: color * f.ambient,
            diffuse: color * f.diffuse,
            specular: Color::gray(strength),
            shininess,
            reflection: f.reflection.max,
            emission: color * f.emission,
            ..Finish::BLACK
        };
        Material {
            model: Some(model),
            finish,
            eta: self.interior.map_or(1.0, |i| i.ior),
            texture: Some(SharedTexture(Arc::clone(&self.surface))),
            interior: self.interior,
            ..Material::matte(color)
        }
        .with_transparency(color, pigment.filter, pigment.transmit)
    }
}

/// Fills the parts of a combined object that have a texture but no interior of their own.
pub(in crate::grammar) fn fill_parts(object: &mut Object, interior: Interior) {
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
                            interior: Some(interior),
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

impl Parser<'_> {
    /// The material of a texture; equal textures close to each other share it.
    pub(in crate::grammar) fn material(&mut self, texture: &Texture) -> Arc<Material> {
        let recent = &mut self.state.recent_materials;
        if let Some(found) = recent.iter().position(|(known, _)| known == texture) {
            return Arc::clone(&recent[found].1);
        }
        let material = Arc::new(texture.to_material());
        if recent.len() >= RECENT {
            recent.remove(0);
        }
        recent.push((texture.clone(), Arc::clone(&material)));
        material
    }
}
