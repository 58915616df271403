use super::buffers::{Buffers, data_uri, decoded, shown};
use crate::image::{TextureUse, decode_texture};
use crate::input::textures::TextureFiles;
use crate::input::{Input, Report};
use gltf_json::Root;
use gltf_json::extensions::material::Material as Extensions;
use gltf_json::extensions::texture::Texture as TextureExtensions;
use gltf_json::material::AlphaMode;
use gltf_json::texture::{Info, MagFilter, WrappingMode};
use gltf_json::validation::Checked;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use strahl_math::det;
use strahl_scene::Diagnostic;
use strahl_shade::image_texture::{Filter, TextureImage, Wrap};
use strahl_shade::{Color, Material, Pbr, Sides, TextureRef, Textures};

/// The smallest transmittance of a volume over its attenuation distance: 0 would need infinite absorption.
const DARKEST: f64 = 1e-6;

/// What the crate has for the `source` of a texture that has none.
const NO_SOURCE: usize = u32::MAX as usize;

/// Creates materials and reads textures, each once.
pub(super) struct Materials<'a> {
    root: &'a Root,
    buffers: &'a Buffers<'a>,
    name: &'a str,
    files: TextureFiles<'a>,
    known: HashMap<usize, Arc<Material>>,
    images: HashMap<(usize, TextureUse), Option<Arc<TextureImage>>>,
    /// The textures without a picture that were reported.
    without_source: HashSet<usize>,
}

/// A reference to a texture, with the transformation of its coordinates.
struct Use {
    texture: usize,
    set: u32,
    uv_map: [f64; 6],
}

impl<'a> Materials<'a> {
    pub(super) fn new(root: &'a Root, buffers: &'a Buffers<'a>, input: &Input<'a>) -> Self {
        Self {
            root,
            buffers,
            name: input.name,
            files: TextureFiles::new(input.folder),
            known: HashMap::new(),
            images: HashMap::new(),
            without_source: HashSet::new(),
        }
    }

    /// The material with this index.
    pub(super) fn get(
        &mut self,
        index: usize,
        report: &mut Report,
    ) -> Result<Arc<Material>, String> {
        if let Some(known) = self.known.get(&index) {
            return Ok(Arc::clone(known));
        }
        let material = Arc::new(
            self.material(index, report)
                .map_err(|e| format!("material {index}: {e}"))?,
        );
        self.known.insert(index, Arc::clone(&material));
        Ok(material)
    }

    fn material(&mut self, index: usize, report: &mut Report) -> Result<Material, String> {
        let root = self.root;
        let json = root.materials.get(index).ok_or("it does not exist")?;
        let none = Extensions::default();
        let extensions = json.extensions.as_ref().unwrap_or(&none);
        let metal = &json.pbr_metallic_roughness;

        let [r, g, b, alpha] = metal.base_color_factor.0;
        let base_color = color("the base colour", [r, g, b])?;
        let eta = match extensions.ior.as_ref().map(|e| f64::from(e.ior.0)) {
            None => 1.5,
            // 0 means that everything is reflected, which a very large index does.
            Some(0.0) => 1000.0,
            Some(eta) if eta >= 1.0 && eta.is_finite() => eta,
            Some(eta) => {
                return Err(format!(
                    "its index of refraction must be 0 or at least 1, found {eta}"
                ));
            }
        };
        let head_on = (eta - 1.0) / (eta + 1.0);
        let f0 = match &extensions.specular {
            None => head_on * head_on,
            Some(specular) => {
                let tint =
                    color("the specular colour", specular.specular_color_factor.0)?.max_component();
                unit(head_on * head_on * tint * unit(f64::from(specular.specular_factor.0)))
            }
        };
        let strength = extensions
            .emissive_strength
            .as_ref()
            .map_or(1.0, |e| e.emissive_strength.0);
        let emissive = color(
            "the emitted light",
            json.emissive_factor.0.map(|x| x * strength),
        )?;
        let transmission = extensions
            .transmission
            .as_ref()
            .map_or(0.0, |e| unit(f64::from(e.transmission_factor.0)));
        let Checked::Valid(alpha_mode) = json.alpha_mode else {
            return Err("it has no valid alpha mode".into());
        };
        let cutoff = unit(json.alpha_cutoff.map_or(0.5, |cutoff| f64::from(cutoff.0)));
        let volume = extensions
            .volume
            .as_ref()
            .filter(|v| v.thickness_factor.0 > 0.0);
        let absorption = match volume {
            None => Color::BLACK,
            Some(volume) => {
                let distance = f64::from(volume.attenuation_distance.0);
                if !(distance > 0.0) {
                    return Err(format!(
                        "its attenuation distance must be positive, found {distance}"
                    ));
                }
                color("the attenuation colour", volume.attenuation_color.0)?
                    .map(|c| absorbed(c, distance))
            }
        };

        let info = |info: &Option<Info>| info.as_ref().map(use_of);
        let textures = Textures {
            base_color: self.texture(info(&metal.base_color_texture), TextureUse::Color, report),
            metallic_roughness: self.texture(
                info(&metal.metallic_roughness_texture),
                TextureUse::Data,
                report,
            ),
            normal: self.texture(
                json.normal_texture.as_ref().map(|t| {
                    let transform = t
                        .extensions
                        .as_ref()
                        .and_then(|e| e.others.get("KHR_texture_transform"));
                    plain_use(t.index.value(), t.tex_coord, transform)
                }),
                TextureUse::Data,
                report,
            ),
            emissive: self.texture(info(&json.emissive_texture), TextureUse::Color, report),
            occlusion: self.texture(
                json.occlusion_texture.as_ref().map(|t| {
                    let transform = t
                        .extensions
                        .as_ref()
                        .and_then(|e| e.others.get("KHR_texture_transform"));
                    plain_use(t.index.value(), t.tex_coord, transform)
                }),
                TextureUse::Data,
                report,
            ),
            transmission: self.texture(
                extensions
                    .transmission
                    .as_ref()
                    .and_then(|e| info(&e.transmission_texture)),
                TextureUse::Data,
                report,
            ),
        };
        let ignored =
            extensions.specular.as_ref().is_some_and(|s| {
                s.specular_texture.is_some() || s.specular_color_texture.is_some()
            }) || extensions
                .volume
                .as_ref()
                .is_some_and(|v| v.thickness_texture.is_some());
        if ignored {
            self.warn(
                report,
                "textures of thickness and of the specular extension are ignored",
            );
        }
        let pbr = Pbr {
            base_color,
            alpha: unit(f64::from(alpha)),
            alpha_cutoff: (alpha_mode == AlphaMode::Mask).then_some(cutoff),
            alpha_blend: alpha_mode == AlphaMode::Blend,
            metallic: unit(f64::from(metal.metallic_factor.0)),
            roughness: unit(f64::from(metal.roughness_factor.0)),
            transmission,
            emissive,
            f0,
            normal_scale: json
                .normal_texture
                .as_ref()
                .map_or(1.0, |t| finite_or(f64::from(t.scale), 1.0)),
            unlit: extensions.unlit.is_some(),
            textures,
        };
        Ok(Material {
            name: json
                .name
                .clone()
                .unwrap_or_else(|| format!("material {index}")),
            eta,
            absorption,
            fresnel: true,
            thin: volume.is_none(),
            sides: if json.double_sided || volume.is_some() {
                Sides::Two
            } else {
                Sides::Front
            },
            pbr: Some(Box::new(pbr)),
            ..Material::matte(base_color)
        })
    }

    fn warn(&self, report: &mut Report, what: &'static str) {
        report.count(what, || {
            Diagnostic::warning(format!("`{}`: {what}", self.name))
        });
    }

    /// The texture; `None` with a warning if it can't be read.
    fn texture(
        &mut self,
        found: Option<Use>,
        texture_use: TextureUse,
        report: &mut Report,
    ) -> Option<TextureRef> {
        let found = found?;
        if found.set != 0 {
            self.warn(
                report,
                "a texture for a second set of texture coordinates is ignored",
            );
            return None;
        }
        let texture = self.root.textures.get(found.texture)?;
        let source = texture.source.value();
        if source == NO_SOURCE {
            self.without_source(found.texture, texture.extensions.as_ref(), report);
            return None;
        }
        let image = self.image(source, texture_use, report)?;
        let sampler = texture
            .sampler
            .and_then(|s| self.root.samplers.get(s.value()));
        let wrap = |mode: Option<&Checked<WrappingMode>>| match mode {
            Some(Checked::Valid(WrappingMode::ClampToEdge)) => Wrap::Clamp,
            Some(Checked::Valid(WrappingMode::MirroredRepeat)) => Wrap::Mirror,
            _ => Wrap::Repeat,
        };
        let nearest = sampler
            .is_some_and(|s| matches!(s.mag_filter, Some(Checked::Valid(MagFilter::Nearest))));
        Some(TextureRef {
            image,
            wrap_u: wrap(sampler.map(|s| &s.wrap_s)),
            wrap_v: wrap(sampler.map(|s| &s.wrap_t)),
            filter: if nearest {
                Filter::Nearest
            } else {
                Filter::Bilinear
            },
            uv_map: found.uv_map,
        })
    }

    /// Says, once, that a texture has no picture, or only such of extensions (compressed ones, mostly).
    fn without_source(
        &mut self,
        index: usize,
        extensions: Option<&TextureExtensions>,
        report: &mut Report,
    ) {
        if !self.without_source.insert(index) {
            return;
        }
        let names: Vec<_> = extensions
            .iter()
            .flat_map(|e| e.others.keys())
            .take(10)
            .map(|name| format!("`{}`", shown(name)))
            .collect();
        let why = if names.is_empty() {
            "it has no `source`".to_owned()
        } else {
            let names = names.join(", ");
            format!("it has a picture only by an extension that is not supported: {names}")
        };
        report.warning(|| {
            Diagnostic::warning(format!(
                "`{}`: texture {index} is left out: {why}",
                self.name
            ))
        });
    }

    fn image(
        &mut self,
        index: usize,
        texture_use: TextureUse,
        report: &mut Report,
    ) -> Option<Arc<TextureImage>> {
        if let Some(known) = self.images.get(&(index, texture_use)) {
            return known.clone();
        }
        let image = self.decode(index, texture_use);
        if let Err(why) = &image {
            report.warning(|| {
                Diagnostic::warning(format!("`{}`: image {index} is not read: {why}", self.name))
            });
        }
        let image = image.ok();
        self.images.insert((index, texture_use), image.clone());
        image
    }

    fn decode(
        &mut self,
        index: usize,
        texture_use: TextureUse,
    ) -> Result<Arc<TextureImage>, String> {
        let image = self.root.images.get(index).ok_or("it does not exist")?;
        let decode = |bytes: &[u8]| {
            let name = format!("image {index}");
            decode_texture(bytes, &name, texture_use)
                .map(Arc::new)
                .map_err(|e| e.to_string())
        };
        match (&image.uri, image.buffer_view) {
            (_, Some(view)) => decode(self.buffers.view(view)?.0),
            (Some(uri), None) if uri.starts_with("data:") => decode(&data_uri(uri)?),
            (Some(uri), None) => self
                .files
                .get(&decoded(uri), texture_use)
                .map_err(|why| format!("`{}`: {why}", shown(uri))),
            (None, None) => Err("it has neither a URI nor a buffer view".into()),
        }
    }
}

fn use_of(info: &Info) -> Use {
    let transform = info
        .extensions
        .as_ref()
        .and_then(|e| e.texture_transform.as_ref());
    let map = |t: &gltf_json::extensions::texture::TextureTransform| {
        uv_map(t.offset.0, t.rotation.0, t.scale.0)
    };
    Use {
        texture: info.index.value(),
        set: transform
            .and_then(|t| t.tex_coord)
            .unwrap_or(info.tex_coord),
        uv_map: transform.map_or(uv_map([0.0; 2], 0.0, [1.0; 2]), map),
    }
}

/// The same for normal and occlusion textures, whose extensions the crate leaves as JSON.
fn plain_use(texture: usize, set: u32, transform: Option<&gltf_json::Value>) -> Use {
    let number = |value: Option<&gltf_json::Value>| {
        value.and_then(gltf_json::Value::as_f64).map(|x| x as f32)
    };
    let get = |key: &str| transform.and_then(|t| t.get(key));
    let pair = |key: &str, default: f32| {
        [0, 1].map(|i| number(get(key).and_then(|v| v.get(i))).unwrap_or(default))
    };
    let overriding = get("texCoord")
        .and_then(gltf_json::Value::as_u64)
        .and_then(|set| u32::try_from(set).ok());
    Use {
        texture,
        set: overriding.unwrap_or(set),
        uv_map: uv_map(
            pair("offset", 0.0),
            number(get("rotation")).unwrap_or(0.0),
            pair("scale", 1.0),
        ),
    }
}

/// The map of `KHR_texture_transform`: scale, then rotate counter-clockwise as seen in the picture (whose v points down), then
/// translate.
fn uv_map([ou, ov]: [f32; 2], rotation: f32, [su, sv]: [f32; 2]) -> [f64; 6] {
    let (sin, cos) = (det::sin(f64::from(rotation)), det::cos(f64::from(rotation)));
    let (su, sv) = (f64::from(su), f64::from(sv));
    let map = [
        cos * su,
        sin * sv,
        f64::from(ou),
        -sin * su,
        cos * sv,
        f64::from(ov),
    ];
    if map.iter().all(|x| x.is_finite()) {
        map
    } else {
        [1.0, 0.0, 0.0, 0.0, 1.0, 0.0]
    }
}

/// The absorption per length that leaves the fraction `c` of the light after `distance`.
fn absorbed(c: f64, distance: f64) -> f64 {
    let c = if c > DARKEST { c } else { DARKEST };
    let a = -det::ln(c) / distance;
    if a > 0.0 { a } else { 0.0 }
}

/// Checks a colour of the file.
fn color(what: &str, rgb: [f32; 3]) -> Result<Color, String> {
    let color = Color::from(rgb.map(f64::from));
    if color.is_finite() && color.to_array().iter().all(|x| *x >= 0.0) {
        Ok(color)
    } else {
        Err(format!("{what} must be finite and not negative"))
    }
}

/// Clamps to `0..=1`; NaN becomes 0.
fn unit(x: f64) -> f64 {
    if x > 1.0 {
        1.0
    } else if x > 0.0 {
        x
    } else {
        0.0
    }
}

fn finite_or(x: f64, other: f64) -> f64 {
    if x.is_finite() { x } else { other }
}
