use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::Kind;

/// How a surface takes light.
#[derive(Clone, Debug, PartialEq)]
pub struct Finish {
    /// Share of the ambient light, per colour.
    pub ambient: [f64; 3],
    /// Share of the light from light sources.
    pub diffuse: f64,
    /// Strength of Phong's highlight.
    pub phong: f64,
    /// Its exponent.
    pub phong_size: f64,
    /// Strength of the highlight around the halfway vector.
    pub specular: f64,
    /// Its exponent is one over this.
    pub roughness: f64,
    /// Share of the light from the reflected direction, per colour.
    pub reflection: [f64; 3],
    /// Light the surface emits, per colour.
    pub emission: [f64; 3],
}

impl Default for Finish {
    fn default() -> Self {
        Self {
            ambient: [0.1; 3],
            diffuse: 0.6,
            phong: 0.0,
            phong_size: 40.0,
            specular: 0.0,
            roughness: 0.05,
            reflection: [0.0; 3],
            emission: [0.0; 3],
        }
    }
}

impl Parser<'_> {
    /// `{ ... }` behind `finish`.
    pub(crate) fn finish_block(&mut self) -> PResult<Finish> {
        let mut finish = self.state.default_texture.finish.clone();
        self.braces(|p| {
            let named = p.accept_thing(|thing| match thing {
                crate::grammar::Thing::Finish(finish) => Some(finish),
                _ => None,
            })?;
            if let Some(named) = named {
                finish = Finish::clone(&named);
            }
            p.items("`finish`", |p, token| {
                match token.word() {
                    Some(Word::Ambient) => finish.ambient = p.finish_color()?,
                    Some(Word::Emission) => finish.emission = p.finish_color()?,
                    Some(Word::Diffuse) => finish.diffuse = p.finish_float()?,
                    Some(Word::Phong) => finish.phong = p.finish_float()?,
                    Some(Word::PhongSize) => finish.phong_size = p.finish_float()?,
                    Some(Word::Specular) => finish.specular = p.finish_float()?,
                    Some(Word::Roughness) => {
                        finish.roughness = p.finish_float()?;
                        if !(finish.roughness > 0.0) {
                            let place = p.place();
                            return Err(p.fail(place, "roughness must be positive"));
                        }
                    }
                    Some(Word::Reflection) => {
                        p.take(token)?;
                        finish.reflection = p.reflection()?;
                    }
                    _ => return p.skip_item(token, "`finish`"),
                }
                Ok(())
            })
        })?;
        Ok(finish)
    }

    fn finish_float(&mut self) -> PResult<f64> {
        self.next()?;
        self.float()
    }

    fn finish_color(&mut self) -> PResult<[f64; 3]> {
        self.next()?;
        self.color().map(|[r, g, b, ..]| [r, g, b])
    }

    /// A colour, or `{ [min,] max ... }`: the largest reflection counts.
    fn reflection(&mut self) -> PResult<[f64; 3]> {
        if self.peek()?.kind != Kind::LeftBrace {
            return self.color().map(|[r, g, b, ..]| [r, g, b]);
        }
        self.braces(|p| {
            let mut color = p.color()?;
            p.comma()?;
            let token = p.peek()?;
            if token.kind != Kind::RightBrace && token.kind != Kind::Word {
                color = p.color()?;
            }
            p.items("`reflection`", |p, token| {
                p.skip_item(token, "`reflection`")
            })?;
            let [r, g, b, ..] = color;
            Ok([r, g, b])
        })
    }
}
