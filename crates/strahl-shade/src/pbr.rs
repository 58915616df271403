use crate::image_texture::{Filter, TextureImage, Wrap};
use crate::{Color, Finish, MaterialPoint};
use std::borrow::Cow;
use std::sync::Arc;
use strahl_math::{DVec2, DVec3};

/// A texture with its sampling parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureRef {
    /// The image.
    pub image: Arc<TextureImage>,
    /// What happens left of 0 and right of 1.
    pub wrap_u: Wrap,
    /// What happens above 0 and below 1.
    pub wrap_v: Wrap,
    /// Interpolation between texels.
    pub filter: Filter,
    /// Affine map of the texture coordinates: `(m₀ u + m₁ v + m₂, m₃ u + m₄ v + m₅)`.
    pub uv_map: [f64; 6],
}

impl TextureRef {
    /// Linear RGBA at texture coordinates.
    pub fn sample(&self, uv: DVec2) -> [f64; 4] {
        let m = self.uv_map;
        let mapped = DVec2::new(
            m[0] * uv.x + m[1] * uv.y + m[2],
            m[3] * uv.x + m[4] * uv.y + m[5],
        );
        self.image
            .sample(mapped, self.wrap_u, self.wrap_v, self.filter)
    }
}

/// The textures of a physically based material; each multiplies its factor.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Textures {
    /// Base colour and alpha.
    pub base_color: Option<TextureRef>,
    /// Roughness in green, metalness in blue.
    pub metallic_roughness: Option<TextureRef>,
    /// Tangent-space normals.
    pub normal: Option<TextureRef>,
    /// Emitted light.
    pub emissive: Option<TextureRef>,
    /// Ambient occlusion in red.
    pub occlusion: Option<TextureRef>,
    /// Transmission in red.
    pub transmission: Option<TextureRef>,
}

/// glTF 2.0's metallic-roughness material, translated to the classical coefficients point by point.
///
/// | classical | from |
/// |---|---|
/// | kd, ka | base colour · ((1 - metalness) · (1 - transmission) + metalness · (1 - (1 - roughness)²)) |
/// | kr | metals: base colour · (1 - roughness)²; dielectrics: (1 - roughness)², times Fresnel's F |
/// | kt | base colour · transmission · (1 - metalness), times 1 - F |
/// | ks, p | highlight of strength F₀ scaled to the exponent `2/α² - 2`, α = roughness² |
///
/// A classical ray tracer has no blurred reflection, so rough surfaces reflect less instead: `(1 - roughness)²` is 1 for a
/// mirror and fades out where the reflection would be a blur. What a rough metal does not reflect it scatters: kd + kr is the base
/// colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Pbr {
    /// Base colour factor, linear.
    pub base_color: Color,
    /// Alpha factor.
    pub alpha: f64,
    /// Alpha below which there is no surface (mask mode); `None` if alpha is not a mask.
    pub alpha_cutoff: Option<f64>,
    /// Whether alpha mixes with what is behind (blend mode).
    pub alpha_blend: bool,
    /// Metalness, `0..=1`.
    pub metallic: f64,
    /// Perceptual roughness, `0..=1`.
    pub roughness: f64,
    /// Share of transmitted light, `0..=1`.
    pub transmission: f64,
    /// Emitted radiance.
    pub emissive: Color,
    /// Reflectance of dielectrics head on, from the index of refraction: `((η-1)/(η+1))²`.
    pub f0: f64,
    /// Scale of the tangent-space normals' x and y.
    pub normal_scale: f64,
    /// Shows the base colour itself, without any light.
    pub unlit: bool,
    /// The textures.
    pub textures: Textures,
}

impl Pbr {
    /// The classical coefficients at `uv`.
    pub fn at(&self, uv: DVec2) -> MaterialPoint<'static> {
        let sample =
            |texture: &Option<TextureRef>| texture.as_ref().map_or([1.0; 4], |t| t.sample(uv));
        let tex = &self.textures;
        let [r, g, b, a] = sample(&tex.base_color);
        let base = self.base_color * Color::new(r, g, b);
        let alpha = self.alpha * a;
        let opacity = match self.alpha_cutoff {
            Some(cutoff) if alpha < cutoff => 0.0,
            _ => 1.0,
        };
        let [_, rough, metal, _] = sample(&tex.metallic_roughness);
        let metallic = self.metallic * metal;
        let roughness = self.roughness * rough;
        let transmission = self.transmission * sample(&tex.transmission)[0] * (1.0 - metallic);
        let emission = {
            let [r, g, b, _] = sample(&tex.emissive);
            self.emissive * Color::new(r, g, b)
        };
        if self.unlit {
            let finish = Finish {
                emission: base + emission,
                ..Finish::BLACK
            };
            return MaterialPoint {
                finish: Cow::Owned(finish),
                fresnel_reflection: Color::BLACK,
                fresnel: false,
                opacity,
            };
        }
        let blend = if self.alpha_blend { alpha } else { 1.0 };
        let gloss = (1.0 - roughness) * (1.0 - roughness);
        let scattered = (1.0 - metallic) * (1.0 - transmission) + metallic * (1.0 - gloss);
        let diffuse = base * (scattered * blend);
        let metal_color = base * metallic;
        let alpha_2 = {
            let a = roughness * roughness;
            let a = if a > 0.02 { a } else { 0.02 };
            a * a
        };
        let shininess = 2.0 / alpha_2 - 2.0;
        // Normalisation of Blinn-Phong, (p + 2) / 8, tamed so that mirrors don't get white-hot lights.
        let strength = {
            let s = (shininess + 2.0) / 8.0;
            if s < 4.0 { s } else { 4.0 }
        };
        let finish = Finish {
            ambient: diffuse * sample(&tex.occlusion)[0],
            diffuse,
            specular: (Color::gray(self.f0) * (1.0 - metallic) + metal_color) * (strength * blend),
            shininess,
            reflection: metal_color * (gloss * blend),
            transmission: base * transmission * blend + Color::gray(1.0 - blend),
            emission,
        };
        // A metal's colour is its own F₀; Fresnel's equations scale the dielectric part.
        let fresnel_reflection = Color::gray((1.0 - metallic) * gloss * blend);
        MaterialPoint {
            finish: Cow::Owned(finish),
            fresnel_reflection,
            fresnel: true,
            opacity,
        }
    }

    /// The shading normal of the normal map at `uv`, from an orthonormal-ish frame: tangent along `dpdu`, normal `n`.
    /// Falls back to `n` where there is no map or no tangent.
    pub fn shading_normal(&self, uv: DVec2, n: DVec3, dpdu: DVec3, dpdv: DVec3) -> DVec3 {
        let Some(texture) = &self.textures.normal else {
            return n;
        };
        let tangent = dpdu - n * n.dot(dpdu);
        let length = tangent.length();
        if !(length > 0.0) || !length.is_finite() {
            return n;
        }
        let tangent = tangent / length;
        let bitangent = n.cross(tangent);
        // glTF's v grows downwards and its green channel points up: against dpdv.
        let handedness = if bitangent.dot(dpdv) > 0.0 { -1.0 } else { 1.0 };
        let [x, y, z, _] = texture.sample(uv);
        let (x, y) = (
            (x * 2.0 - 1.0) * self.normal_scale,
            (y * 2.0 - 1.0) * self.normal_scale,
        );
        let mapped = tangent * x + bitangent * (y * handedness) + n * (z * 2.0 - 1.0);
        let length = mapped.length();
        if length > 0.0 { mapped / length } else { n }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn metal(roughness: f64) -> Finish {
        let pbr = Pbr {
            base_color: Color::new(0.9, 0.6, 0.2),
            alpha: 1.0,
            alpha_cutoff: None,
            alpha_blend: false,
            metallic: 1.0,
            roughness,
            transmission: 0.0,
            emissive: Color::BLACK,
            f0: 0.04,
            normal_scale: 1.0,
            unlit: false,
            textures: Textures::default(),
        };
        pbr.at(DVec2::ZERO).finish.into_owned()
    }

    #[test]
    fn a_metal_reflects_or_scatters_its_colour() {
        assert_eq!(metal(0.0).reflection, Color::new(0.9, 0.6, 0.2));
        assert!(metal(0.0).diffuse.is_black());
        assert_eq!(metal(1.0).diffuse, Color::new(0.9, 0.6, 0.2));
        for roughness in [0.1, 0.5, 0.9] {
            let f = metal(roughness);
            assert!(((f.diffuse + f.reflection).g - 0.6).abs() < 1e-15);
        }
    }
}
