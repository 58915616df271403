use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_function::Function;
use strahl_geometry::{Container, Parametric, ParametricOptions};
use strahl_math::DVec2;

/// `parametric { function { x(u, v) }, function { ... }, function { ... } <u1, v1>, <u2, v2> [contained_by { ... }] [accuracy a] ... }`
///
/// `precompute` is read and ignored; `max_gradient` matters only for functions that call patterns.
pub(super) fn parametric(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let x = p.function_of_uv()?;
        let y = p.function_of_uv()?;
        let z = p.function_of_uv()?;
        let from = DVec2::from_array(p.vector2()?);
        p.comma()?;
        let to = DVec2::from_array(p.vector2()?);
        p.comma()?;
        let mut container = Container::default();
        let mut options = ParametricOptions::default();
        loop {
            let token = p.peek()?;
            let Some(word) = token.word() else { break };
            match word {
                Word::ContainedBy => {
                    p.take(token)?;
                    container = p.container()?;
                }
                Word::Accuracy => {
                    p.take(token)?;
                    options.accuracy = p.float()?;
                }
                Word::MaxGradient => {
                    p.take(token)?;
                    options.max_gradient = p.float()?;
                }
                Word::Precompute => {
                    p.take(token)?;
                    p.float()?;
                    p.comma()?;
                    for axis in [Word::X, Word::Y, Word::Z] {
                        p.accept_word(axis)?;
                        p.comma()?;
                    }
                }
                _ => break,
            }
        }
        Ok(Parametric::try_new(
            [x, y, z],
            [from, to],
            container,
            options,
        ))
    })
}

impl Parser<'_> {
    /// `function { ... }` of `u` and `v`, and an optional comma.
    fn function_of_uv(&mut self) -> PResult<Function> {
        let token = self.peek()?;
        if !token.is(Word::Function) {
            return Err(self.unexpected(token, "`function`"));
        }
        self.take(token)?;
        let function = self.function_of(&[(Word::U, "u"), (Word::V, "v")])?;
        self.comma()?;
        Ok(function)
    }
}
