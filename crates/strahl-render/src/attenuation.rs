//! What fog, rainbows and the insides of objects leave of light.

use crate::media::Crossing;
use crate::scene::RenderScene;
use strahl_math::Ray;
use strahl_shade::{Color, Material, MaterialId};

impl RenderScene {
    /// Whether there is fog or a rainbow.
    pub(crate) fn has_air(&self) -> bool {
        !self.fogs.is_empty() || !self.rainbows.is_empty()
    }

    /// The attenuation of a ray of this length by fogs and rainbows, and the light they add. Fogs lie in front of rainbows;
    /// where several rainbows overlap their mean counts.
    #[cold]
    pub(crate) fn air_along(&self, ray: &Ray, length: f64) -> (Color, Color) {
        let (keeps, adds) = self.fog_along(ray, length);
        let (mut seen, mut kept, mut added) = (0.0, Color::BLACK, Color::BLACK);
        for rainbow in &self.rainbows {
            if let Some((k, a)) = rainbow.along(ray.direction, length) {
                seen += 1.0;
                kept += k;
                added += a;
            }
        }
        if seen == 0.0 {
            return (keeps, adds);
        }
        (keeps * (kept / seen), adds + keeps * (added / seen))
    }

    /// The attenuation of a ray of this length (in world units) by the scene's fogs, and the light they add. As in POV-Ray fogs
    /// don't attenuate each other's colours.
    #[cold]
    pub(crate) fn fog_along(&self, ray: &Ray, length: f64) -> (Color, Color) {
        let direction = ray.direction.normalize_or_zero();
        let (mut keeps, mut adds) = (Color::WHITE, Color::BLACK);
        for fog in &self.fogs {
            let depth = fog.depth(ray.origin, direction, length);
            let (kept, added) = fog.at_depth(depth);
            adds += added;
            keeps *= kept;
        }
        (keeps, adds)
    }
}

impl RenderScene {
    /// What of light is left after a way through the medium around it. That of an object with a texture of POV-Ray's is not
    /// weakened here, but where it leaves the object: see [`crate::surface::Surface::fading`].
    pub(crate) fn absorbed(&self, around: Option<MaterialId>, length: f64) -> Color {
        let Some(id) = around else {
            return Color::WHITE;
        };
        let material = &self.materials[id.0 as usize];
        match Crossing::of(material) {
            Crossing::BySide => material.attenuation(length),
            Crossing::ByTurns => Color::WHITE,
        }
    }

    /// Whether the eye may be in a medium that weakens light which meets nothing.
    pub(crate) fn absorbs_around_the_eye(&self) -> bool {
        let weakens = |m: &Material| !m.absorption.is_black() || m.interior.is_some();
        let mut materials = self.materials.iter();
        self.fills && materials.any(|m| Crossing::of(m) == Crossing::BySide && weakens(m))
    }

    /// What the `interior` of an object leaves of light that gets out of it after a way through it.
    pub(crate) fn faded(&self, inside: MaterialId, length: f64) -> Color {
        self.materials[inside.0 as usize].attenuation(length)
    }

    /// The same for the light of a light source.
    pub(crate) fn faded_shadow(&self, inside: MaterialId, length: f64) -> Color {
        let interior = &self.materials[inside.0 as usize].interior;
        match interior.as_ref().is_none_or(|i| i.fades_shadows()) {
            true => self.faded(inside, length),
            false => Color::WHITE,
        }
    }
}
