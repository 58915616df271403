use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_geometry::{
    HypercomplexFunction as H, Julia, JuliaAlgebra, JuliaOptions, QuaternionFunction,
};

/// `julia_fractal { <parameter> [quaternion | hypercomplex] [function] [max_iteration n] [precision p] [slice <normal>, distance] ... }`
pub(super) fn julia_fractal(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let place = p.place();
        let parameter = p.vector4()?;
        let mut options = JuliaOptions::default();
        let (mut hypercomplex, mut function) = (false, H::Square);
        loop {
            let token = p.peek()?;
            let Some(word) = token.word() else { break };
            if let Some(named) = named(word) {
                p.take(token)?;
                function = named;
                continue;
            }
            match word {
                Word::Quaternion | Word::Hypercomplex => {
                    p.take(token)?;
                    hypercomplex = word == Word::Hypercomplex;
                }
                Word::Pwr => {
                    p.take(token)?;
                    p.expect(crate::token::Kind::LeftParen)?;
                    let re = p.full_float()?;
                    p.comma()?;
                    let im = p.full_float()?;
                    p.expect(crate::token::Kind::RightParen)?;
                    function = H::Power(re, im);
                }
                Word::MaxIteration => {
                    p.take(token)?;
                    // The cast truncates, and turns negative numbers and NaN into 0.
                    options.max_iteration = p.float()? as u32;
                }
                Word::Precision => {
                    p.take(token)?;
                    options.precision = p.float()?;
                }
                Word::Slice => {
                    p.take(token)?;
                    options.slice = p.vector4()?;
                    p.comma()?;
                    options.distance = p.float()?;
                }
                _ => break,
            }
        }
        let algebra = match (hypercomplex, function) {
            // Measured; the other functions are what their names say.
            (true, H::Cube) => {
                p.warn_hint(
                    place,
                    "POV-Ray shows `hypercomplex` with `cube` as it shows `sqr`, and so does strahl",
                    "write `sqr` for this set, or `pwr(3, 0)` for that of cubes",
                );
                JuliaAlgebra::Hypercomplex(H::Square)
            }
            (true, function) => JuliaAlgebra::Hypercomplex(function),
            (false, H::Square) => JuliaAlgebra::Quaternion(QuaternionFunction::Square),
            (false, H::Cube) => JuliaAlgebra::Quaternion(QuaternionFunction::Cube),
            (false, _) => {
                return Err(p.fail_hint(
                    place,
                    "quaternions have only the functions `sqr` and `cube`",
                    "write `hypercomplex`",
                ));
            }
        };
        Ok(Julia::try_new(parameter, algebra, &options))
    })
}

/// The function that a word names.
const fn named(word: Word) -> Option<H> {
    Some(match word {
        Word::Sqr => H::Square,
        Word::Cube => H::Cube,
        Word::Exp => H::Exp,
        Word::Reciprocal => H::Reciprocal,
        Word::Sin => H::Sin,
        Word::Asin => H::Asin,
        Word::Sinh => H::Sinh,
        Word::Asinh => H::Asinh,
        Word::Cos => H::Cos,
        Word::Acos => H::Acos,
        Word::Cosh => H::Cosh,
        Word::Acosh => H::Acosh,
        Word::Tan => H::Tan,
        Word::Atan => H::Atan,
        Word::Tanh => H::Tanh,
        Word::Atanh => H::Atanh,
        Word::Ln => H::Ln,
        _ => return None,
    })
}
