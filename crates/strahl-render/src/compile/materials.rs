use std::collections::HashMap;
use std::sync::Arc;
use strahl_scene::Object;
use strahl_shade::texture::Texture;
use strahl_shade::{Material, MaterialId, Quality};

/// The materials found so far, each `Arc` once.
#[derive(Debug, Default)]
pub(super) struct MaterialTable {
    list: Vec<Arc<Material>>,
    /// Whether shadow rays pass through each of them.
    transmitting: Vec<bool>,
    known: HashMap<*const Material, MaterialId>,
    default: Option<Arc<Material>>,
    quality: Quality,
    /// Textures as this quality shows them, if they are others.
    textures: HashMap<*const Texture, Option<Arc<Texture>>>,
    /// The materials that others in the list stand for.
    replaced: Vec<Arc<Material>>,
}

// The pointers are keys only, of `Arc`s that the lists keep alive; they are never followed.
impl MaterialTable {
    /// An empty table of materials as pictures of this quality show them.
    pub(super) fn new(quality: Quality) -> Self {
        Self {
            quality,
            ..Self::default()
        }
    }

    /// The number of a material; `None` is the default material.
    pub(super) fn id(&mut self, material: Option<&Arc<Material>>) -> MaterialId {
        let material = match material {
            Some(material) => material,
            None => self
                .default
                .get_or_insert_with(|| Arc::new(Material::default().named("default"))),
        };
        let (list, transmitting, quality) = (&mut self.list, &mut self.transmitting, self.quality);
        let (textures, replaced) = (&mut self.textures, &mut self.replaced);
        *self.known.entry(Arc::as_ptr(material)).or_insert_with(|| {
            let other = material.of_quality(quality, |texture| {
                let known = textures.entry(Arc::as_ptr(texture));
                known
                    .or_insert_with(|| texture.of_quality(quality).map(Arc::new))
                    .clone()
            });
            let shown = match other {
                None => Arc::clone(material),
                Some(other) => {
                    replaced.push(Arc::clone(material));
                    Arc::new(other)
                }
            };
            transmitting.push(material_transmits(&shown));
            list.push(shown);
            MaterialId(list.len() as u32 - 1)
        })
    }

    pub(super) fn get(&self, id: MaterialId) -> &Material {
        &self.list[id.0 as usize]
    }

    /// Whether shadow rays pass through a material.
    pub(super) fn transmits(&self, id: MaterialId) -> bool {
        self.transmitting[id.0 as usize]
    }

    /// The materials, and whether shadow rays pass through each of them.
    pub(super) fn into_lists(self) -> (Vec<Arc<Material>>, Vec<bool>) {
        (self.list, self.transmitting)
    }
}

/// Whether shadow rays pass through the material.
fn material_transmits(material: &Material) -> bool {
    if let Some(texture) = &material.texture {
        let inner = material.inner_texture.as_ref();
        return texture.0.may_transmit() || inner.is_some_and(|t| t.0.may_transmit());
    }
    match &material.pbr {
        None => !material.finish.transmission.is_black(),
        Some(pbr) => pbr.transmission > 0.0 || pbr.alpha_blend,
    }
}

/// Whether rays may start inside of the material. Objects without an `interior` count too: the eye is in the one it gets out of last.
pub(super) fn material_fills(material: &Material) -> bool {
    material.texture.is_some() || !material.thin && material_transmits(material)
}

/// Whether it is seen that a ray is inside of the material, or has left it.
pub(super) fn material_shows(material: &Material) -> bool {
    match material.texture {
        Some(_) => material.interior.is_some(),
        None => {
            let seen = material.eta != 1.0 || !material.absorption.is_black();
            seen && material_fills(material)
        }
    }
}

/// The error in a material's numbers, if there is one.
pub(super) fn material_problem(material: &Material) -> Option<String> {
    let f = &material.finish;
    let colors = [
        ("ambient", f.ambient),
        ("diffuse", f.diffuse),
        ("specular", f.specular),
        ("reflection", f.reflection),
        ("transmission", f.transmission),
        ("emission", f.emission),
        ("absorption", material.absorption),
    ];
    let named = |what: &str| format!("material `{}`: {what}", material.name);
    if let Some((name, _)) = colors.iter().find(|(_, c)| !c.is_finite()) {
        return Some(named(&format!(
            "{name} has a value that is not a finite number"
        )));
    }
    if !(material.eta > 0.0 && material.eta.is_finite()) {
        return Some(named(&format!(
            "the index of refraction must be positive, found {}",
            material.eta
        )));
    }
    if !(f.shininess >= 0.0) {
        return Some(named(&format!(
            "the exponent of the highlight must be 0 or more, found {}",
            f.shininess
        )));
    }
    None
}

/// The material an object has by itself or by inheritance.
pub(super) fn material_of<'a>(
    object: &'a Object,
    inherited: Option<&'a Arc<Material>>,
) -> Option<&'a Arc<Material>> {
    object.material.as_ref().or(inherited)
}
