//! Settings that hold for all of the scene, wherever they stand: POV-Ray reads them when it renders.

use crate::keywords::Word;
use crate::token::{Directive, Kind, Token};

/// What the first chunk of the scene's file sets, outside of branches, loops and macros.
///
/// Scenes include files with patterns before their `global_settings`, so it must be known when those are read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Foreseen {
    /// The last `noise_generator`.
    pub(super) noise_generator: Option<u8>,
    /// The last `number_of_waves`.
    pub(super) number_of_waves: Option<u32>,
}

impl Foreseen {
    pub(crate) fn of(tokens: &[Token]) -> Self {
        let mut foreseen = Self::default();
        let mut blocks = 0_u32;
        // The open braces of `global_settings`, if it is one.
        let mut braces = None;
        for (at, token) in tokens.iter().enumerate() {
            match token.directive() {
                Some(
                    Directive::If
                    | Directive::Ifdef
                    | Directive::Ifndef
                    | Directive::While
                    | Directive::For
                    | Directive::Switch
                    | Directive::Macro,
                ) => blocks += 1,
                Some(Directive::End) => blocks = blocks.saturating_sub(1),
                _ => {}
            }
            if blocks > 0 {
                continue;
            }
            braces = match (token.kind, braces) {
                (_, _) if token.is(Word::GlobalSettings) => Some(0),
                (Kind::LeftBrace, Some(open)) => Some(open + 1),
                (Kind::RightBrace, Some(open @ 2..)) => Some(open - 1),
                (Kind::RightBrace, _) => None,
                (_, braces) => braces,
            };
            if braces != Some(1) {
                continue;
            }
            let number = |most: u32| number(&tokens[at + 1..], most);
            if token.is(Word::NoiseGenerator) {
                foreseen.noise_generator = number(3).map(|n| n as u8);
            } else if token.is(Word::NumberOfWaves) {
                foreseen.number_of_waves = number(10_000);
            }
        }
        foreseen
    }
}

/// The number from 1 to `most` that the tokens begin with, unless it is a part of an expression.
fn number(tokens: &[Token], most: u32) -> Option<u32> {
    let [number, next, ..] = tokens else {
        return None;
    };
    let is_alone = matches!(
        next.kind,
        Kind::Word | Kind::Name | Kind::RightBrace | Kind::Directive
    );
    let value = number.number();
    let is_known = number.kind == Kind::Number && is_alone;
    (is_known && value >= 1.0 && value <= f64::from(most)).then_some(value as u32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lexer::{Lexed, lex};
    use crate::source::Part;
    use crate::symbol::Symbols;

    fn foreseen(text: &str) -> (Option<u8>, Option<u32>) {
        let part = Part {
            bytes: text.as_bytes(),
            begin: 0,
            is_last: true,
        };
        let lexed = lex(&part, 0, usize::MAX, &mut Symbols::new(), Lexed::default());
        let foreseen = Foreseen::of(&lexed.tokens);
        (foreseen.noise_generator, foreseen.number_of_waves)
    }

    #[test]
    fn the_last_settings_outside_of_blocks_are_foreseen() {
        let both = "global_settings { noise_generator 3 radiosity { count 9 } number_of_waves 4 }";
        assert_eq!(foreseen(both), (Some(3), Some(4)));
        for (text, noise) in [
            (
                "global_settings { noise_generator 1 } global_settings { noise_generator 2 }",
                Some(2),
            ),
            ("pigment { bozo noise_generator 1 }", None),
            ("#if (A) global_settings { noise_generator 1 } #end", None),
            (
                "#macro M() #if (A) #end global_settings { noise_generator 1 } #end",
                None,
            ),
            (
                "#if (A) #end global_settings { noise_generator 1 }",
                Some(1),
            ),
            ("global_settings { noise_generator 1 + 1 }", None),
            ("global_settings { noise_generator N }", None),
            ("// global_settings { noise_generator 1 }", None),
            ("global_settings { photons { noise_generator 1 } }", None),
            ("global_settings { noise_generator 1", None),
            ("} global_settings { } noise_generator 1 }", None),
        ] {
            assert_eq!(foreseen(text).0, noise, "{text}");
        }
    }
}
