use crate::interior::Interior;
use crate::texture::SharedTexture;
use crate::{Color, Pbr, ShadingModel};
use std::borrow::Cow;
use std::sync::{Arc, LazyLock};
use strahl_math::{DVec2, det};

/// Index of a material in the scene's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialId(pub u32);

/// The sides from which a surface exists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sides {
    /// Seen from both sides; the normal is turned towards the viewer.
    #[default]
    Two,
    /// Rays that meet the back (d·n > 0) pass as if nothing were there.
    Front,
}

/// The coefficients of the classical model at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finish {
    /// ka: reflectance of the ambient light.
    pub ambient: Color,
    /// kd: diffuse reflectance.
    pub diffuse: Color,
    /// ks: strength of the highlight.
    pub specular: Color,
    /// p: exponent of the highlight, `>= 0`.
    pub shininess: f64,
    /// kr: factor of the radiance from the reflected direction.
    pub reflection: Color,
    /// kt: factor of the radiance from the transparency direction; also the transmittance for shadow rays.
    pub transmission: Color,
    /// Light the surface emits itself.
    pub emission: Color,
}

impl Finish {
    /// Black, reflecting nothing.
    pub const BLACK: Self = Self {
        ambient: Color::BLACK,
        diffuse: Color::BLACK,
        specular: Color::BLACK,
        shininess: 1.0,
        reflection: Color::BLACK,
        transmission: Color::BLACK,
        emission: Color::BLACK,
    };
}

/// The material of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name for messages and ray trees; may be empty.
    pub name: String,
    /// Shading model; `None` takes the scene's.
    pub model: Option<ShadingModel>,
    /// The coefficients, unless `texture` or `pbr` gives them point by point.
    pub finish: Arc<Finish>,
    /// η, the index of refraction of the inside; 1 lets rays pass straight.
    pub eta: f64,
    /// Absorption inside per unit length (Beer-Lambert): a path of length s keeps `exp(-absorption s)`.
    pub absorption: Color,
    /// Whether Fresnel's equations divide the light between reflection and transparency: `kr` and `kt` are then multiplied by F
    /// and 1-F.
    pub fresnel: bool,
    /// Whether the surface is a sheet without an inside: transparency rays pass straight, and `eta` only sets what Fresnel's
    /// equations reflect.
    pub thin: bool,
    /// From which sides the surface exists.
    pub sides: Sides,
    /// A physically based description (glTF's) from which the coefficients follow, possibly by textures.
    pub pbr: Option<Box<Pbr>>,
    /// A texture in POV-Ray's sense, which takes the place of `model`, `finish`, `fresnel` and `pbr`. Its space is that of the
    /// object that has the material, before that object's own transformation: it moves with the object.
    pub texture: Option<SharedTexture>,
    /// The texture seen by rays from inside, if it is another one (`interior_texture`).
    pub inner_texture: Option<SharedTexture>,
    /// The attenuation inside as given by POV-Ray's `interior`, which takes the place of `absorption`; `eta` still counts.
    pub interior: Option<Arc<Interior>>,
}

/// A material evaluated at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialPoint<'m> {
    /// The coefficients; `reflection` is the part of kr that does not depend on the angle. Borrowed where they are the same
    /// everywhere.
    pub finish: Cow<'m, Finish>,
    /// The part of kr that Fresnel's F scales.
    pub fresnel_reflection: Color,
    /// Whether Fresnel's equations apply: kt is scaled by 1-F.
    pub fresnel: bool,
    /// The opacity by the alpha channel: below 1/2 in alpha-mask mode there is no surface at all.
    pub opacity: f64,
}

impl<'m> MaterialPoint<'m> {
    /// The same coefficients everywhere; with `fresnel`, all of kr depends on the angle.
    #[inline]
    pub fn classical(finish: &'m Finish, fresnel: bool) -> Self {
        if !fresnel {
            return Self {
                finish: Cow::Borrowed(finish),
                fresnel_reflection: Color::BLACK,
                fresnel,
                opacity: 1.0,
            };
        }
        let fresnel_reflection = finish.reflection;
        let finish = Finish {
            reflection: Color::BLACK,
            ..*finish
        };
        Self {
            finish: Cow::Owned(finish),
            fresnel_reflection,
            fresnel,
            opacity: 1.0,
        }
    }
}

impl Default for Material {
    /// Matte light grey.
    fn default() -> Self {
        Self::matte(Color::gray(0.8))
    }
}

impl Material {
    /// The texture seen by rays from outside or from inside, if the material has one.
    pub fn texture_seen(&self, from_outside: bool) -> Option<&SharedTexture> {
        match &self.inner_texture {
            Some(inner) if !from_outside => Some(inner),
            _ => self.texture.as_ref(),
        }
    }

    /// A surface that a texture describes. Small, because a scene may have one for each of a million objects.
    pub fn textured(texture: impl Into<SharedTexture>) -> Self {
        static BLACK: LazyLock<Arc<Finish>> = LazyLock::new(|| Arc::new(Finish::BLACK));
        Self {
            texture: Some(texture.into()),
            ..Self::with_finish(Arc::clone(&BLACK))
        }
    }

    /// A diffuse surface of the given colour, without highlight: kd = ka = colour.
    pub fn matte(color: Color) -> Self {
        Self::with_finish(Arc::new(Finish {
            ambient: color,
            diffuse: color,
            ..Finish::BLACK
        }))
    }

    /// An opaque surface with these coefficients.
    pub fn with_finish(finish: impl Into<Arc<Finish>>) -> Self {
        Self {
            name: String::new(),
            model: None,
            finish: finish.into(),
            eta: 1.0,
            absorption: Color::BLACK,
            fresnel: false,
            thin: false,
            sides: Sides::Two,
            pbr: None,
            texture: None,
            inner_texture: None,
            interior: None,
        }
    }

    /// A diffuse surface with a white highlight of strength `ks` and exponent `shininess`.
    pub fn shiny(color: Color, ks: f64, shininess: f64) -> Self {
        let matte = Self::matte(color);
        let finish = Finish {
            specular: Color::gray(ks),
            shininess,
            ..*matte.finish
        };
        Self {
            finish: Arc::new(finish),
            ..matte
        }
    }

    /// A mirror that reflects `kr` of the light, with a sharp highlight.
    pub fn mirror(kr: Color) -> Self {
        let finish = Finish {
            reflection: kr,
            specular: kr,
            shininess: 200.0,
            ..Finish::BLACK
        };
        Self {
            finish: Arc::new(finish),
            ..Self::matte(Color::BLACK)
        }
    }

    /// Clear glass of index `eta` with Fresnel reflection.
    pub fn glass(eta: f64) -> Self {
        let finish = Finish {
            reflection: Color::WHITE,
            transmission: Color::WHITE,
            specular: Color::gray(0.5),
            shininess: 200.0,
            ..Finish::BLACK
        };
        Self {
            finish: Arc::new(finish),
            eta,
            fresnel: true,
            ..Self::matte(Color::BLACK)
        }
    }

    /// Whether it has holes where its alpha is below a cutoff.
    #[inline]
    pub fn is_masked(&self) -> bool {
        let cutoff = |p: &Pbr| p.alpha_cutoff.is_some();
        self.pbr.as_deref().is_some_and(cutoff)
    }

    /// The attenuation of light on a path of this length inside.
    #[inline]
    pub fn attenuation(&self, length: f64) -> Color {
        match &self.interior {
            None => transmittance(self.absorption, length),
            Some(interior) => interior.attenuation(length),
        }
    }

    /// The same material under a name.
    #[must_use]
    pub fn named(self, name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..self
        }
    }

    /// Sets kr, the share of reflected light.
    #[must_use]
    pub fn with_reflection(mut self, kr: Color) -> Self {
        Arc::make_mut(&mut self.finish).reflection = kr;
        self
    }

    /// Makes the material transparent in POV-Ray's terms: of the light from behind, `filter` passes tinted by `pigment`
    /// and `transmit` passes unchanged; kd and ka are weakened by what passes.
    #[must_use]
    pub fn with_transparency(mut self, pigment: Color, filter: f64, transmit: f64) -> Self {
        let finish = Arc::make_mut(&mut self.finish);
        finish.transmission = pigment * filter + Color::gray(transmit);
        let rest = 1.0 - filter - transmit;
        let rest = if rest > 0.0 { rest } else { 0.0 };
        finish.diffuse = finish.diffuse * rest;
        finish.ambient = finish.ambient * rest;
        self
    }

    /// The coefficients at texture coordinates `uv`.
    #[inline]
    pub fn at(&self, uv: DVec2) -> MaterialPoint<'_> {
        match &self.pbr {
            None => MaterialPoint::classical(&self.finish, self.fresnel),
            Some(pbr) => pbr.at(uv),
        }
    }

    /// Stores [`Material::at`] in `out`.
    // In place, and only what is needed of a borrowed finish: copies of the whole took 1 % of the time.
    #[inline]
    pub fn store_at<'m>(&'m self, uv: DVec2, out: &mut MaterialPoint<'m>) {
        if self.pbr.is_some() || self.fresnel {
            *out = self.at(uv);
            return;
        }
        out.finish = Cow::Borrowed(&self.finish);
        out.fresnel_reflection = Color::BLACK;
        out.fresnel = false;
        out.opacity = 1.0;
    }
}
/// Beer-Lambert: the attenuation of light on a path of this length.
#[inline]
fn transmittance(absorption: Color, length: f64) -> Color {
    if absorption.is_black() {
        return Color::WHITE;
    }
    // On an infinite path a colour that is not absorbed is kept: 0 * inf must not become NaN.
    absorption.map(|a| if a == 0.0 { 1.0 } else { det::exp(-a * length) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_fades_by_length() {
        let glass = Material {
            absorption: Color::new(0.0, 1.0, 2.0),
            ..Material::glass(1.5)
        };
        let t = glass.attenuation(1.5);
        assert_eq!(t.r, 1.0);
        assert!((t.g - (-1.5f64).exp()).abs() < 1e-15 && (t.b - (-3.0f64).exp()).abs() < 1e-15);
        // On an infinite path only colours that are not absorbed are kept.
        assert_eq!(glass.attenuation(f64::INFINITY), Color::new(1.0, 0.0, 0.0));
    }
}
