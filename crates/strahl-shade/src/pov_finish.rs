//! POV-Ray's finish: how a surface reflects light, as pure functions.
//!
//! Every formula here was found or confirmed by rendering small scenes with POV-Ray 3.7 into 16-bit pictures of gamma 1;
//! the largest difference was 1e-5, the pictures' own step.

mod irid;

use strahl_math::{DVec3, det};

use crate::{Color, ShadingModel, fresnel_dielectric};

pub use irid::{FilmPoint, IridSettings, Iridescence};

/// The specular reflection of a finish (`reflection { min, max ... }`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PovReflection {
    /// Reflectance head on.
    pub min: Color,
    /// Reflectance at grazing angles. `reflection c` has `min = max = c`; with `fresnel`, `reflection { c }` has `min` = 0.
    pub max: Color,
    /// Whether Fresnel's equations lead from `min` to `max` instead of the power `falloff`.
    pub fresnel: bool,
    /// Exponent of `1 - cos θ` in the transition from `min` to `max`.
    pub falloff: f64,
    /// The reflected light is raised to the power of the reciprocal: see [`PovReflection::reflected`].
    pub exponent: f64,
    /// How much the reflection takes on the pigment's colour, `0..=1`.
    pub metallic: f64,
}

impl Default for PovReflection {
    /// None.
    fn default() -> Self {
        Self {
            min: Color::BLACK,
            max: Color::BLACK,
            fresnel: false,
            falloff: 1.0,
            exponent: 1.0,
            metallic: 0.0,
        }
    }
}

impl PovReflection {
    /// A mirror of the same reflectance at all angles.
    pub fn constant(color: Color) -> Self {
        Self {
            min: color,
            max: color,
            ..Self::default()
        }
    }

    /// Whether nothing is ever reflected.
    pub fn is_none(&self) -> bool {
        self.min.is_black() && self.max.is_black()
    }

    /// Whether the reflectance is the same at all angles and for all pigments.
    pub fn is_constant(&self) -> bool {
        self.is_none() || !self.fresnel && self.min == self.max && self.metallic == 0.0
    }

    /// The factor of the radiance from the mirror direction.
    ///
    /// `cos_view` is the cosine between the tilted normal and the direction to the viewer, `pigment` the pigment's colour,
    /// `eta` the index of refraction behind the surface divided by the one before it.
    pub fn reflectance(&self, cos_view: f64, pigment: Color, eta: f64) -> Color {
        if self.is_none() {
            return Color::BLACK;
        }
        let reflectance = self.min + (self.max - self.min) * self.rise(cos_view, eta);
        reflectance * self.tint(cos_view, pigment)
    }

    /// The number by which POV-Ray 3.7 weighs the reflection ray for `adc_bailout` (measured): the largest component of the
    /// reflectance; where it rises with the angle other than by Fresnel's equations, the largest at any angle. `metallic` does
    /// not count.
    pub fn weight(&self, cos_view: f64, eta: f64) -> f64 {
        if self.fresnel {
            let reflectance = self.min + (self.max - self.min) * self.rise(cos_view, eta);
            reflectance.max_component()
        } else {
            self.min.max_component().max(self.max.max_component())
        }
    }

    /// The position of the reflectance between `min` (0) and `max` (1): Fresnel's F, or `(1 - cos θ)^falloff`.
    ///
    /// A tilted normal may face away from the viewer. Then, as in POV-Ray 3.7 (measured), F is 1, and the power is above 1.
    #[inline]
    pub fn rise(&self, cos_view: f64, eta: f64) -> f64 {
        let cos = cos_view.clamp(-1.0, 1.0);
        if self.fresnel {
            if cos < 0.0 {
                return 1.0;
            }
            let sin2 = (1.0 - cos * cos) / (eta * eta);
            if sin2 < 1.0 {
                fresnel_dielectric(1.0, cos, eta, (1.0 - sin2).sqrt())
            } else {
                1.0
            }
        } else if self.min == self.max {
            0.0
        } else {
            det::pow(1.0 - cos, self.falloff)
        }
    }

    /// The tint of the reflection by `metallic`, for a surface of this pigment.
    pub fn tint(&self, cos_view: f64, pigment: Color) -> Color {
        metallic_tint(self.metallic, cos_view, pigment)
    }

    /// What a film makes of the reflectance: its factor for light from the mirror direction, to the power of `1 / exponent`
    /// as the light itself.
    pub fn of_film(&self, film: &FilmPoint, cos_view: f64) -> Color {
        self.reflected(Color::WHITE, film.factor(cos_view, cos_view))
    }

    /// The reflected light: `reflectance · light^(1 / exponent)`.
    pub fn reflected(&self, reflectance: Color, light: Color) -> Color {
        if self.exponent == 0.0 {
            Color::BLACK
        } else if self.exponent == 1.0 {
            reflectance * light
        } else {
            let power = 1.0 / self.exponent;
            reflectance * light.map(|x| if x > 0.0 { det::pow(x, power) } else { 0.0 })
        }
    }
}

/// How a surface reflects light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PovFinish {
    /// Share of the scene's ambient light; default 0.1.
    pub ambient: Color,
    /// Emitted light; default 0.
    pub emission: Color,
    /// Diffuse reflectance; default 0.6.
    pub diffuse: f64,
    /// Share of light from behind that a thin sheet scatters to the viewer; default 0.
    pub diffuse_back: f64,
    /// Power of the cosine in diffuse reflection; default 1.
    pub brilliance: f64,
    /// Strength of the Phong highlight; default 0.
    pub phong: f64,
    /// Exponent of the Phong highlight; default 40.
    pub phong_size: f64,
    /// Strength of the highlight by half vectors; default 0.
    pub specular: f64,
    /// Reciprocal of that highlight's exponent; default 0.05.
    pub roughness: f64,
    /// How much highlights take on the pigment's colour, `0..=1`; default 0.
    pub metallic: f64,
    /// Mirror reflection.
    pub reflection: PovReflection,
    /// Whether reflected light is subtracted from the transmitted light.
    pub conserve_energy: bool,
    /// Strength of the random darkening of diffuse light (`crand`); default 0.
    pub crand: f64,
    /// The colours of a thin film (`irid`).
    pub irid: Option<Iridescence>,
    /// Factor of the light from behind, in scenes from before POV-Ray 3.1; default 1.
    pub refraction: f64,
    /// The index of refraction of the object, in such scenes; it replaces that of the interior.
    pub ior: Option<f64>,
    /// The caustics of the object, in such scenes.
    pub caustics: Option<f64>,
}

impl Default for PovFinish {
    /// The finish of POV-Ray's default texture.
    fn default() -> Self {
        Self {
            ambient: Color::gray(0.1),
            emission: Color::BLACK,
            diffuse: 0.6,
            diffuse_back: 0.0,
            brilliance: 1.0,
            phong: 0.0,
            phong_size: 40.0,
            specular: 0.0,
            roughness: 0.05,
            metallic: 0.0,
            reflection: PovReflection::default(),
            conserve_energy: false,
            crand: 0.0,
            irid: None,
            refraction: 1.0,
            ior: None,
            caustics: None,
        }
    }
}

/// The highlights of a finish at one point in one light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PovHighlights {
    /// r·v, the cosine in the term of `phong`; 0 without `phong`.
    pub phong_cos: f64,
    /// `phong (r·v)^phong_size`
    pub phong: f64,
    /// h·n, the cosine in the term of `specular`; 0 without `specular`.
    pub specular_cos: f64,
    /// `specular (h·n)^(1 / roughness)`
    pub specular: f64,
}

impl PovHighlights {
    /// The sum of both.
    #[inline]
    pub fn strength(&self) -> f64 {
        0.0 + self.phong + self.specular
    }
}

/// The colour that metallic highlights and reflections get.
///
/// It is the pigment's colour head on and white at grazing angles, by an empirical function of the angle θ between the
/// normal and the other direction: `1 + metallic (1 - F) (pigment - 1)`, `F = 0.014567225 / (x - 1.12)² - 0.011612903`
/// with `x = 2θ/π`.
fn metallic_tint(metallic: f64, cos: f64, pigment: Color) -> Color {
    if metallic == 0.0 {
        return Color::WHITE;
    }
    let x = det::acos(cos.clamp(-1.0, 1.0)) / std::f64::consts::FRAC_PI_2;
    let d = x - 1.12;
    let f = (0.014_567_225 / (d * d) - 0.011_612_903).clamp(0.0, 1.0);
    Color::WHITE + (pigment - Color::WHITE) * (metallic * (1.0 - f))
}

/// Which light sources may show on a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LightsShown {
    /// None: the surface neither scatters light nor has highlights.
    Nothing,
    /// Those near the direction of a highlight.
    Highlights,
    /// All that shine on it.
    All,
}

impl PovFinish {
    /// The factor that turns `diffuse albedo x` into `diffuse`: `(brilliance + 1) / 2`.
    pub fn diffuse_from_albedo(brilliance: f64) -> f64 {
        0.5 * (brilliance + 1.0)
    }

    /// The factor that turns `phong albedo x` into `phong`: `(phong_size + 1) / 2`.
    pub fn phong_from_albedo(phong_size: f64) -> f64 {
        0.5 * (phong_size + 1.0)
    }

    /// The power of the cosine in the highlight of `specular`: `1 / roughness`, and 0 without roughness (measured).
    fn highlight_power(&self) -> f64 {
        if self.roughness == 0.0 {
            0.0
        } else {
            1.0 / self.roughness
        }
    }

    /// The factor that turns `specular albedo x` into `specular`: `(p + 2) / (4 (2 - 2^(-p/2)))`, `p = 1 / roughness`.
    pub fn specular_from_albedo(roughness: f64) -> f64 {
        let p = 1.0 / roughness;
        (p + 2.0) / (4.0 * (2.0 - det::exp(-0.5 * p * std::f64::consts::LN_2)))
    }

    /// The factor of `light · pigment · opacity` in the diffuse term.
    ///
    /// `cos_light` is the cosine between the tilted normal and the direction to the light. The opacity
    /// `1 - filter - transmit` is [`crate::ColorFt::opacity`].
    #[inline]
    pub fn diffuse_factor(&self, cos_light: f64) -> f64 {
        let (strength, cos) = if cos_light > 0.0 {
            (self.diffuse, cos_light)
        } else {
            (self.diffuse_back, -cos_light)
        };
        if strength == 0.0 {
            0.0
        } else if self.brilliance == 1.0 {
            strength * cos
        } else {
            strength * det::pow(cos, self.brilliance)
        }
    }

    /// The sum of both highlights per unit of light: the factor of the light's colour, independent of the opacity.
    ///
    /// `n` is the tilted unit normal, `to_light` and `to_viewer` are unit vectors away from the surface. Light from behind
    /// (`n·to_light` of 0 or less) is the caller's to leave out: it makes highlights where an object is lit from both sides.
    pub fn highlight(&self, n: DVec3, to_light: DVec3, to_viewer: DVec3, pigment: Color) -> Color {
        if self.phong == 0.0 && self.specular == 0.0 {
            return Color::BLACK;
        }
        let parts = self.highlights(n, to_light, to_viewer, None);
        self.tint(n.dot(to_light), pigment) * parts.strength()
    }

    /// The two highlights separately, without the tint of [`PovFinish::tint`]. A `model` replaces both shapes: around the mirror
    /// direction for [`ShadingModel::Phong`], by half vectors for [`ShadingModel::BlinnPhong`], none for others.
    #[inline]
    pub fn highlights(
        &self,
        n: DVec3,
        to_light: DVec3,
        to_viewer: DVec3,
        model: Option<ShadingModel>,
    ) -> PovHighlights {
        let cosine = |shape| match shape {
            ShadingModel::Phong => crate::reflect(n, to_viewer).dot(to_light),
            ShadingModel::BlinnPhong => {
                let h = to_light + to_viewer;
                cosine_of(n.x, n.y, n.z, h.x, h.y, h.z)
            }
            _ => 0.0,
        };
        let mut parts = PovHighlights::default();
        if self.phong != 0.0 {
            let cos = cosine(model.unwrap_or(ShadingModel::Phong));
            parts.phong_cos = cos;
            parts.phong = self.phong * highlight(cos, self.phong_size);
        }
        if self.specular != 0.0 {
            let cos = cosine(model.unwrap_or(ShadingModel::BlinnPhong));
            parts.specular_cos = cos;
            parts.specular = self.specular * highlight(cos, self.highlight_power());
        }
        parts
    }

    /// Which light of light sources may show on a layer whose colour times opacity is `body`.
    #[inline]
    pub fn lights_shown(&self, body: Color) -> LightsShown {
        if self.scatters(body) {
            LightsShown::All
        } else if self.phong != 0.0 || self.specular != 0.0 {
            LightsShown::Highlights
        } else {
            LightsShown::Nothing
        }
    }

    /// Whether such a layer may scatter light.
    #[inline]
    fn scatters(&self, body: Color) -> bool {
        let scatters = self.diffuse != 0.0 || self.diffuse_back != 0.0;
        // Grain takes the colour without its opacity.
        scatters && (!body.is_black() || self.crand != 0.0)
    }

    /// The same for light from the direction `to_light`: what shows nothing but highlights, such as glass, shows few lights; `false` is certain.
    #[inline]
    pub fn shows_light_from(
        &self,
        body: Color,
        n: DVec3,
        to_light: DVec3,
        to_viewer: DVec3,
    ) -> bool {
        self.scatters(body)
            || self.phong != 0.0 && {
                let cos = crate::reflect(n, to_viewer).dot(to_light);
                !highlight_vanishes(cos, self.phong_size)
            }
            || self.specular != 0.0 && {
                let h = to_light + to_viewer;
                let cos = cosine_of(n.x, n.y, n.z, h.x, h.y, h.z);
                !highlight_vanishes(cos, self.highlight_power())
            }
    }

    /// The tint of highlights by `metallic`, for a surface of this pigment.
    #[inline]
    pub fn tint(&self, cos_light: f64, pigment: Color) -> Color {
        metallic_tint(self.metallic, cos_light, pigment)
    }

    /// The amount that `crand` subtracts from each channel of the surface's diffuse light at a position.
    ///
    /// POV-Ray draws a random number per pixel; here it depends on the position alone, so that the same scene gives the same
    /// picture.
    pub fn grain(&self, place: DVec3) -> f64 {
        if self.crand == 0.0 {
            return 0.0;
        }
        // splitmix64's mixing function (Steele et al., OOPSLA 2014) over the bits of the coordinates.
        let mix = |mut z: u64| {
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^ (z >> 31)
        };
        let hash = place
            .to_array()
            .iter()
            .fold(0x9e37_79b9_7f4a_7c15, |h: u64, x| {
                mix(h.wrapping_add(x.to_bits()))
            });
        self.crand * ((hash >> 11) as f64 / (1u64 << 53) as f64)
    }
}

/// A power of a cosine; 0 where the cosine isn't above zero, and where [`highlight_vanishes`].
#[inline]
fn highlight(cos: f64, power: f64) -> f64 {
    match highlight_vanishes(cos, power) {
        true => 0.0,
        false => det::pow(cos, power),
    }
}

/// Whether a highlight is left out: its cosine isn't above zero, or the power of the cosine is less than 2⁻²⁴⁹, which no picture can show.
///
/// No power is needed to tell: ln x < 2 (x - 1) / (x + 1) for 0 < x < 1.
#[inline]
fn highlight_vanishes(cos: f64, power: f64) -> bool {
    /// 249 ln 2, rounded up.
    const DEPTH: f64 = 173.0;
    cos.is_nan() || cos <= 0.0 || power * (2.0 * (1.0 - cos)) > DEPTH * (1.0 + cos)
}

/// The cosine between a unit vector and another vector; 0 if that is zero.
// Not inline: the square root and the division would be taken out of the loop over layers, for surfaces without highlights too. In
// numbers: vectors would be stored and loaded in parts of other sizes.
#[inline(never)]
fn cosine_of(nx: f64, ny: f64, nz: f64, x: f64, y: f64, z: f64) -> f64 {
    DVec3::new(nx, ny, nz).dot(DVec3::new(x, y, z).normalize_or_zero())
}

#[cfg(test)]
mod tests;
