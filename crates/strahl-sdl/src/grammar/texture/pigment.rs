use crate::keywords::WordKind;
use crate::parser::{PResult, Parser};
use crate::token::Kind;

/// The colour of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Pigment {
    /// Red, green, blue, filter, transmit.
    pub color: [f64; 5],
}

impl Default for Pigment {
    /// Black, as the language has it.
    fn default() -> Self {
        Self { color: [0.0; 5] }
    }
}

impl Parser<'_> {
    /// `{ ... }` behind `pigment`.
    pub(crate) fn pigment_block(&mut self) -> PResult<Pigment> {
        let mut pigment = self.state.default_texture.pigment.clone();
        self.braces(|p| {
            let named = p.accept_thing(|thing| match thing {
                crate::grammar::Thing::Pigment(pigment) => Some(pigment),
                _ => None,
            })?;
            if let Some(named) = named {
                pigment = Pigment::clone(&named);
            }
            p.items("`pigment`", |p, token| {
                let color = match token.kind {
                    Kind::Word => token.word().is_some_and(|w| w.kind() == WordKind::Color),
                    Kind::Name | Kind::Less | Kind::Number => true,
                    _ => false,
                };
                if color {
                    pigment.color = p.color()?;
                    return Ok(());
                }
                if p.transformation(token)?.is_some() {
                    return Ok(());
                }
                p.skip_item(token, "`pigment`")
            })
        })?;
        Ok(pigment)
    }
}
