//! `finish { ... }`

use crate::grammar::Thing;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};
use std::sync::Arc;
use strahl_shade::Color;
use strahl_shade::pov_finish::{Iridescence, PovFinish, PovReflection};

/// Which strengths are given as `albedo`, the fraction of all light that is reflected; they depend on items that may follow.
#[derive(Default)]
pub(super) struct Albedo {
    diffuse: bool,
    phong: bool,
    specular: bool,
}

impl Parser<'_> {
    /// `{ ... }` after `finish`, which changes the default finish.
    pub(crate) fn finish_block(&mut self) -> PResult<Arc<PovFinish>> {
        let base = Arc::clone(&self.state.default_texture.top().finish);
        self.finish_block_on(base)
    }

    /// `{ ... }` after `finish`, which changes `base` unless it begins with a name. Consecutive equal finishes are shared.
    pub(super) fn finish_block_on(&mut self, base: Arc<PovFinish>) -> PResult<Arc<PovFinish>> {
        self.braces(|p| {
            let named = p.accept_thing(|thing| match thing {
                Thing::Finish(finish) => Some(finish),
                _ => None,
            })?;
            let base = named.unwrap_or(base);
            if p.peek()?.kind == Kind::RightBrace {
                return Ok(base);
            }
            let mut finish = *base;
            let mut albedo = Albedo::default();
            p.items("`finish`", |p, token| {
                p.finish_item(&mut finish, &mut albedo, token)
            })?;
            if albedo.diffuse {
                finish.diffuse *= PovFinish::diffuse_from_albedo(finish.brilliance);
            }
            if albedo.phong {
                finish.phong *= PovFinish::phong_from_albedo(finish.phong_size);
            }
            if albedo.specular {
                finish.specular *= PovFinish::specular_from_albedo(finish.roughness);
            }
            let last = &mut p.state.last_finish;
            if **last != finish {
                *last = Arc::new(finish);
            }
            Ok(Arc::clone(last))
        })
    }

    /// A part of a finish.
    pub(super) fn finish_item(
        &mut self,
        finish: &mut PovFinish,
        albedo: &mut Albedo,
        token: Token,
    ) -> PResult<()> {
        let Some(word) = token.word() else {
            return self.skip_item(token, "`finish`");
        };
        match word {
            Word::Ambient => finish.ambient = self.finish_color(token)?,
            Word::Emission => finish.emission = self.finish_color(token)?,
            Word::Diffuse => {
                self.take(token)?;
                albedo.diffuse = self.accept_word(Word::Albedo)?;
                finish.diffuse = self.strength()?;
                self.comma()?;
                // Without a second number the back is dark, whatever was said before.
                finish.diffuse_back = match self.starts_number()? {
                    true => self.strength()?,
                    false => 0.0,
                };
            }
            Word::Brilliance => finish.brilliance = self.finish_float(token)?,
            Word::Phong => {
                self.take(token)?;
                albedo.phong = self.accept_word(Word::Albedo)?;
                finish.phong = self.strength()?;
            }
            Word::PhongSize => finish.phong_size = self.finish_float(token)?,
            Word::Specular => {
                self.take(token)?;
                albedo.specular = self.accept_word(Word::Albedo)?;
                finish.specular = self.strength()?;
            }
            Word::Roughness => {
                finish.roughness = self.finish_float(token)?;
                if !(finish.roughness > 0.0) {
                    let place = self.place();
                    self.warn_hint(
                        place,
                        format!(
                            "with a roughness of {} the highlight is everywhere",
                            finish.roughness
                        ),
                        "0.001 is very smooth, 1 very rough",
                    );
                }
            }
            Word::Metallic => {
                self.take(token)?;
                finish.metallic = self.optional_float(1.0)?.max(0.0);
            }
            Word::Reflection => {
                self.take(token)?;
                self.reflection(&mut finish.reflection)?;
            }
            Word::ReflectionExponent => {
                finish.reflection.exponent = self.finish_float(token)?;
            }
            Word::ConserveEnergy => {
                self.take(token)?;
                finish.conserve_energy = self.flag()?;
            }
            Word::Irid => {
                self.take(token)?;
                finish.irid = Some(self.irid()?);
            }
            Word::Crand => {
                self.take(token)?;
                finish.crand = self.strength()?;
            }
            // Since version 3.1 it belongs to `interior`; before, it has an effect here.
            Word::Ior => {
                self.take(token)?;
                finish.ior = Some(self.positive("the index of refraction")?);
            }
            Word::Refraction => finish.refraction = self.finish_float(token)?,
            Word::Caustics => finish.caustics = Some(self.finish_float(token)?),
            _ => return self.skip_item(token, "`finish`"),
        }
        Ok(())
    }

    fn finish_float(&mut self, word: Token) -> PResult<f64> {
        self.take(word)?;
        self.float()
    }

    /// The strength of a part of the finish. Negative ones count as 0, as in POV-Ray (measured); PyMOL writes `phong -1`.
    fn strength(&mut self) -> PResult<f64> {
        Ok(self.float()?.max(0.0))
    }

    fn finish_color(&mut self, word: Token) -> PResult<Color> {
        self.take(word)?;
        self.plain_color()
    }

    /// `{ amount thickness T turbulence V }`
    fn irid(&mut self) -> PResult<Iridescence> {
        self.braces(|p| {
            let mut irid = Iridescence {
                amount: p.strength()?,
                thickness: 0.0,
                turbulence: 0.0,
            };
            p.items("`irid`", |p, token| {
                match token.word() {
                    Some(Word::Thickness) => irid.thickness = p.finish_float(token)?,
                    Some(Word::Turbulence) => irid.turbulence = p.finish_float(token)?,
                    _ => return p.skip_item(token, "`irid`"),
                }
                Ok(())
            })?;
            Ok(irid)
        })
    }

    /// A number, if one follows.
    fn optional_float(&mut self, otherwise: f64) -> PResult<f64> {
        if self.starts_number()? {
            self.float()
        } else {
            Ok(otherwise)
        }
    }

    /// A colour without its transparency.
    pub(super) fn plain_color(&mut self) -> PResult<Color> {
        let [r, g, b, ..] = self.color()?;
        Ok(Color::new(r, g, b))
    }

    /// A colour, or `{ [min,] max ... }`.
    fn reflection(&mut self, reflection: &mut PovReflection) -> PResult<()> {
        if self.peek()?.kind != Kind::LeftBrace {
            let color = self.plain_color()?;
            (reflection.min, reflection.max) = (color, color);
            return Ok(());
        }
        self.braces(|p| {
            let first = p.plain_color()?;
            p.comma()?;
            let token = p.peek()?;
            let second = if p.starts_color(token) {
                Some(p.plain_color()?)
            } else {
                None
            };
            p.items("`reflection`", |p, token| {
                match token.word() {
                    Some(Word::Fresnel) => {
                        p.take(token)?;
                        reflection.fresnel = p.flag()?;
                    }
                    Some(Word::Falloff) => reflection.falloff = p.finish_float(token)?,
                    Some(Word::Exponent) => reflection.exponent = p.finish_float(token)?,
                    Some(Word::Metallic) => {
                        p.take(token)?;
                        reflection.metallic = p.optional_float(1.0)?;
                    }
                    _ => return p.skip_item(token, "`reflection`"),
                }
                Ok(())
            })?;
            // With Fresnel's equations, a single colour is the reflection at grazing angles.
            (reflection.min, reflection.max) = match second {
                Some(max) => (first, max),
                None if reflection.fresnel => (Color::BLACK, first),
                None => (first, first),
            };
            Ok(())
        })
    }
}
