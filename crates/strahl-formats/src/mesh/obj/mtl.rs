//! Material libraries.
//!
//! | statement | becomes |
//! |---|---|
//! | `Kd`, `Ka`, `Ks`, `Ns`, `Ke` | kd, ka (kd if there is no `Ka`), ks, the highlight's exponent, emitted light |
//! | `illum 0` | the colour Kd without any light |
//! | `illum 1`, `illum 2`, `illum 10` | diffuse only; with highlight |
//! | `illum 3`, `illum 5`, `illum 8` | a reflecting surface, kr = Ks; with 5, scaled by Fresnel's equations for index `Ni` |
//! | `illum 4`, `illum 6`, `illum 7`, `illum 9` | glass of index `Ni` with Fresnel reflection; with 4 and 9 a sheet that does not refract |
//! | `d`, `Tr`, `Tf` | kt = `Tf` · (1 - d); for glass `Tf`, or 1 - d, or everything. kd and ka keep what is not transmitted |
//! | `map_Kd` | the texture of Kd, with `-o`, `-s` and `-clamp`; such a material is shaded as a rough dielectric |
//! | `map_d` of the same file as `map_Kd` | that texture's alpha |
//!
//! Without `illum` a material has a highlight, as with `illum 2`. Other maps are ignored with a warning. Nothing in a library is an
//! error, as a missing one is none: a number that is out of range is clamped if its end has a meaning, and anything else that
//! makes no sense leaves the material as it is, each with a warning.

use crate::image::TextureUse;
use crate::input::bytes::unquoted;
use crate::input::report::Report;
use crate::input::text::{Text, Word, Words, parse_f64};
use crate::input::textures::TextureFiles;
use strahl_scene::{Diagnostic, Severity};
use strahl_shade::image_texture::{Filter, Wrap};
use strahl_shade::{Color, Finish, Material, Pbr, TextureRef, Textures};

/// The statements of one material as they stand.
#[derive(Clone, Debug)]
struct Statements {
    name: String,
    ka: Option<Color>,
    kd: Color,
    ks: Color,
    ke: Color,
    tf: Option<Color>,
    ns: f64,
    ni: f64,
    /// Opacity.
    d: f64,
    illum: u32,
    map_kd: Option<(String, TextureRef)>,
    map_d: Option<String>,
}

impl Statements {
    fn new(name: String) -> Self {
        Self {
            name,
            ka: None,
            kd: Color::gray(0.8),
            ks: Color::BLACK,
            ke: Color::BLACK,
            tf: None,
            ns: 10.0,
            ni: 1.5,
            d: 1.0,
            illum: 2,
            map_kd: None,
            map_d: None,
        }
    }

    fn material(self) -> Material {
        if self.map_kd.is_some() {
            self.textured()
        } else {
            self.classical()
        }
    }

    fn is_glass(&self) -> bool {
        matches!(self.illum, 4 | 6 | 7 | 9)
    }

    fn classical(self) -> Material {
        if self.illum == 0 {
            let finish = Finish {
                emission: self.kd + self.ke,
                ..Finish::BLACK
            };
            return Material::with_finish(finish).named(self.name);
        }
        let (glass, reflecting) = (self.is_glass(), matches!(self.illum, 3 | 5 | 8));
        let passing = Color::gray(1.0 - self.d);
        let transmission = match (glass, self.tf) {
            (true, Some(tf)) => tf,
            (true, None) if self.d < 1.0 => passing,
            (true, None) => Color::WHITE,
            (false, tf) => passing * tf.unwrap_or(Color::WHITE),
        };
        let most = transmission.max_component();
        let kept = if most < 1.0 { 1.0 - most } else { 0.0 };
        let finish = Finish {
            ambient: self.ka.unwrap_or(self.kd) * kept,
            diffuse: self.kd * kept,
            specular: if self.illum == 1 {
                Color::BLACK
            } else {
                self.ks
            },
            shininess: self.ns,
            reflection: match (glass, reflecting) {
                (true, _) => Color::WHITE,
                (_, true) => self.ks,
                _ => Color::BLACK,
            },
            transmission,
            emission: self.ke,
        };
        let fresnel = glass || self.illum == 5;
        Material {
            eta: if fresnel { self.ni } else { 1.0 },
            fresnel,
            thin: matches!(self.illum, 4 | 9),
            ..Material::with_finish(finish).named(self.name)
        }
    }

    /// Textures exist in the metallic-roughness model only. Its roughness follows from the exponent of the highlight by
    /// `Ns = 2/α² - 2`, α = roughness²; an index of 1 keeps what is not `illum 3` and above from reflecting.
    fn textured(self) -> Material {
        let reflects = self.illum >= 3 && self.illum != 10;
        let eta = if reflects { self.ni } else { 1.0 };
        let head_on = (eta - 1.0) / (eta + 1.0);
        let roughness = (2.0 / (self.ns + 2.0)).sqrt().sqrt();
        let same = |(map, _): &(String, TextureRef)| self.map_d.as_ref() == Some(map);
        let has_alpha = self.map_kd.as_ref().is_some_and(same);
        let transmission = if self.is_glass() {
            self.tf.unwrap_or(Color::WHITE).max_component()
        } else {
            0.0
        };
        let pbr = Pbr {
            base_color: self.kd,
            alpha: self.d,
            alpha_cutoff: None,
            alpha_blend: has_alpha || self.d < 1.0,
            metallic: 0.0,
            roughness: unit(roughness),
            transmission: unit(transmission),
            emissive: self.ke,
            f0: if reflects {
                head_on * head_on
            } else {
                unit(self.ks.max_component()) * 0.04
            },
            normal_scale: 1.0,
            unlit: self.illum == 0,
            textures: Textures {
                base_color: self.map_kd.map(|(_, texture)| texture),
                ..Textures::default()
            },
        };
        Material {
            name: self.name,
            eta,
            thin: matches!(self.illum, 4 | 9),
            pbr: Some(Box::new(pbr)),
            ..Material::matte(self.kd)
        }
    }
}

/// Into `0..=1`.
fn unit(x: f64) -> f64 {
    if x > 1.0 {
        1.0
    } else if x > 0.0 {
        x
    } else {
        0.0
    }
}

/// Reads a library; what is wrong goes to the report.
pub(super) fn read(
    text: Text<'_>,
    textures: &mut TextureFiles<'_>,
    report: &mut Report,
) -> Vec<Material> {
    if text.refuse_binary("a material library", report) {
        return vec![];
    }
    let mut reader = Reader {
        text,
        words: text.words(0, 1).with_continuation(),
        textures,
        report,
        materials: vec![],
    };
    while let Some(word) = reader.words.next() {
        reader.statement(&word);
        reader.words.skip_line();
    }
    reader
        .materials
        .into_iter()
        .map(Statements::material)
        .collect()
}

struct Reader<'a, 'r, 'f> {
    text: Text<'a>,
    words: Words<'a>,
    textures: &'r mut TextureFiles<'f>,
    report: &'r mut Report,
    materials: Vec<Statements>,
}

impl<'a> Reader<'a, '_, '_> {
    fn statement(&mut self, word: &Word<'_>) {
        if word.bytes == b"newmtl" {
            let name = String::from_utf8_lossy(self.words.skip_line().trim_ascii()).into_owned();
            self.materials.push(Statements::new(name));
            return;
        }
        let Some(mut material) = self.materials.pop() else {
            let what = "what comes before the first `newmtl` is ignored";
            self.count(what, word, || what.to_owned());
            return;
        };
        self.property(word, &mut material);
        self.materials.push(material);
    }

    /// A warning about a word, counted by its key.
    fn count(&mut self, key: &'static str, word: &Word<'_>, what: impl FnOnce() -> String) {
        let text = self.text;
        self.report
            .count(key, || text.at(word, Diagnostic::warning(what())));
    }

    fn property(&mut self, word: &Word<'_>, material: &mut Statements) {
        match word.bytes {
            b"Ka" => material.ka = self.color(word).or(material.ka),
            b"Kd" => material.kd = self.color(word).unwrap_or(material.kd),
            b"Ks" => material.ks = self.color(word).unwrap_or(material.ks),
            b"Ke" => material.ke = self.color(word).unwrap_or(material.ke),
            b"Tf" => material.tf = self.color(word).or(material.tf),
            b"Ns" => material.ns = self.clamped("Ns", 0.0, f64::MAX).unwrap_or(material.ns),
            b"Ni" => {
                let what = "Ni, the index of refraction,";
                material.ni = self.within(what, 0.001, 1000.0).unwrap_or(material.ni);
            }
            b"d" => {
                if self
                    .words
                    .peek_in_line()
                    .is_some_and(|w| w.bytes == b"-halo")
                {
                    self.words.next_in_line();
                }
                material.d = self.clamped("d", 0.0, 1.0).unwrap_or(material.d);
            }
            b"Tr" => material.d = self.clamped("Tr", 0.0, 1.0).map_or(material.d, |t| 1.0 - t),
            b"illum" => {
                let illum = self.within("illum", 0.0, 10.0).map(|illum| illum as u32);
                material.illum = illum.unwrap_or(material.illum);
            }
            b"map_Kd" => self.diffuse_map(word, material),
            b"map_d" => {
                material.map_d = self
                    .map(word)
                    .map(|(name, _)| name)
                    .or(material.map_d.take())
            }
            b"sharpness" | b"map_aat" => {}
            _ => {
                let key = match word.bytes {
                    b"bump" | b"map_bump" | b"map_Bump" | b"norm" | b"disp" => {
                        "bump maps are ignored"
                    }
                    b"map_Ka" | b"map_Ks" | b"map_Ns" | b"map_Ke" | b"decal" | b"refl" => {
                        "maps other than `map_Kd` and `map_d` are ignored"
                    }
                    _ => "an unknown property of a material is ignored",
                };
                self.count(key, word, || key.to_owned());
            }
        }
        if let (Some(map_d), Some((map_kd, _))) = (&material.map_d, &material.map_kd)
            && map_d != map_kd
        {
            let what = "`map_d` is ignored: it is not the file of `map_Kd`";
            self.count(what, word, || what.to_owned());
        }
    }

    fn diffuse_map(&mut self, word: &Word<'_>, material: &mut Statements) {
        let Some((name, options)) = self.map(word) else {
            return;
        };
        match self.textures.get(&name, TextureUse::Color) {
            Ok(image) => {
                let wrap = if options.clamp {
                    Wrap::Clamp
                } else {
                    Wrap::Repeat
                };
                let ([su, sv], [ou, ov]) = (options.scale, options.offset);
                // The file's v runs upwards, ours downwards: 1 - (s (1 - v) + o).
                let uv_map = [su, 0.0, ou, 0.0, sv, 1.0 - sv - ov];
                let texture = TextureRef {
                    image,
                    wrap_u: wrap,
                    wrap_v: wrap,
                    filter: Filter::Bilinear,
                    uv_map,
                };
                material.map_kd = Some((name, texture));
            }
            Err(why) => self.count("missing texture", word, || {
                format!("the texture `{name}` is not read: {why}")
            }),
        }
    }

    /// The file name of a map, which is the rest of the line, and its options; nothing if there is no name.
    fn map(&mut self, start: &Word<'_>) -> Option<(String, MapOptions)> {
        let mut options = MapOptions {
            scale: [1.0; 2],
            offset: [0.0; 2],
            clamp: false,
        };
        while let Some(option) = self
            .words
            .peek_in_line()
            .filter(|w| w.bytes.starts_with(b"-"))
        {
            self.words.next_in_line();
            match option.bytes {
                b"-s" => self.up_to_three(&mut options.scale),
                b"-o" => self.up_to_three(&mut options.offset),
                b"-t" => self.up_to_three(&mut [0.0; 2]),
                b"-clamp" => {
                    options.clamp = self.words.next_in_line().is_some_and(|w| w.bytes == b"on")
                }
                b"-mm" => {
                    self.words.next_in_line();
                    self.words.next_in_line();
                }
                b"-bm" | b"-boost" | b"-texres" | b"-imfchan" | b"-type" | b"-blendu"
                | b"-blendv" | b"-cc" => {
                    self.words.next_in_line();
                }
                _ => {
                    self.count("unknown option", &option, || {
                        format!(
                            "the unknown option `{}` of a map is ignored",
                            option.shown()
                        )
                    });
                    // Its values, as far as they can be told from a name.
                    self.up_to_three(&mut [0.0; 2]);
                }
            }
        }
        let name = String::from_utf8_lossy(self.words.skip_line().trim_ascii());
        let name = unquoted(&name).to_owned();
        if name.is_empty() {
            let what = "a map without the name of a file is ignored";
            self.count(what, start, || what.to_owned());
            return None;
        }
        Some((name, options))
    }

    /// One to three numbers, of which two are kept.
    fn up_to_three(&mut self, out: &mut [f64; 2]) {
        for i in 0..3 {
            let number = self
                .words
                .peek_in_line()
                .and_then(|w| parse_f64(w.bytes).ok());
            let Some(number) = number else { return };
            self.words.next_in_line();
            if let Some(place) = out.get_mut(i) {
                *place = number;
            }
        }
    }

    /// Three numbers, or one for all; nothing for a spectral curve or CIE XYZ, and what is no colour.
    fn color(&mut self, start: &Word<'_>) -> Option<Color> {
        if self
            .words
            .peek_in_line()
            .is_some_and(|w| matches!(w.bytes, b"spectral" | b"xyz"))
        {
            let what = "colours as spectra or CIE XYZ are ignored";
            self.count(what, start, || what.to_owned());
            return None;
        }
        let what = "a part of a colour";
        let r = self.clamped(what, 0.0, f64::MAX)?;
        if self.words.peek_in_line().is_none() {
            return Some(Color::gray(r));
        }
        Some(Color::new(
            r,
            self.clamped(what, 0.0, f64::MAX)?,
            self.clamped(what, 0.0, f64::MAX)?,
        ))
    }

    /// A number, moved into its range if it is outside.
    fn clamped(&mut self, what: &'static str, least: f64, most: f64) -> Option<f64> {
        let (word, value) = self.number(what)?;
        if value >= least && value <= most {
            return Some(value);
        }
        let end = if value < least { least } else { most };
        self.count(what, &word, || {
            format!("{}: it counts as {end}", outside(what, &word, least, most))
        });
        Some(end)
    }

    /// A number; nothing if it is outside of its range.
    fn within(&mut self, what: &'static str, least: f64, most: f64) -> Option<f64> {
        let (word, value) = self.number(what)?;
        if value >= least && value <= most {
            return Some(value);
        }
        self.count(what, &word, || {
            format!("{}: it is ignored", outside(what, &word, least, most))
        });
        None
    }

    /// A finite number with its word.
    fn number(&mut self, what: &'static str) -> Option<(Word<'a>, f64)> {
        let what = format!("a number ({what})");
        let wrong = |problem: Diagnostic| Diagnostic {
            severity: Severity::Warning,
            message: format!("{}: the statement is ignored", problem.message),
            ..problem
        };
        let Some(word) = self.words.next_uncommented() else {
            let words = &self.words;
            self.report
                .count("no number", || wrong(words.expected_in_line(&what)));
            return None;
        };
        match parse_f64(word.bytes) {
            Ok(value) => Some((word, value)),
            Err(e) => {
                let text = self.text;
                self.report.count("no number", || {
                    wrong(text.at(&word, e.describe(&word, &what)))
                });
                None
            }
        }
    }
}

/// What is wrong with a number that is outside of its range.
fn outside(what: &str, word: &Word<'_>, least: f64, most: f64) -> String {
    let range = if most < f64::MAX {
        format!("between {least} and {most}")
    } else {
        format!("at least {least}")
    };
    format!("{what} must be {range}, found `{}`", word.shown())
}

struct MapOptions {
    scale: [f64; 2],
    offset: [f64; 2],
    clamp: bool,
}
