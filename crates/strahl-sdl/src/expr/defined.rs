use crate::keywords::Word;
use crate::parser::{PResult, Parser, Step};
use crate::token::Kind;
use crate::value::Value;

impl Parser<'_> {
    /// `(Name)`, `(Name[i])`, `(Name.Key)`, `(local.Name)`: whether it has a value.
    pub(crate) fn is_defined(&mut self) -> PResult<bool> {
        self.expect(Kind::LeftParen)?;
        let scope = self.raw();
        let qualified = (scope.is(Word::Local) || scope.is(Word::Global))
            && self.raw_ahead(1).kind == Kind::Dot;
        if qualified {
            self.next()?;
            self.next()?;
        }
        let token = self.raw();
        let defined = if token.kind == Kind::Word {
            // Keywords always have a value.
            self.take(token)?;
            true
        } else {
            let symbol = self.asked_name("the name of a variable")?;
            let local = qualified && scope.is(Word::Local);
            match self.scopes.target(symbol, local) {
                Some(mut target) => {
                    while let Kind::LeftBracket | Kind::Dot = self.raw().kind {
                        let step = match (self.scopes.at(&target), self.raw().kind) {
                            (Some(Value::Array(_)), Kind::LeftBracket) => {
                                Step::Index(self.array_index(&target)?)
                            }
                            (_, Kind::LeftBracket) => Step::Key(self.key_in_brackets()?),
                            _ => {
                                self.next()?;
                                Step::Key(self.key()?)
                            }
                        };
                        target.path.push(step);
                    }
                    self.scopes.at(&target).is_some()
                }
                None => {
                    self.skip_to_closing()?;
                    strahl_function::internal::find(self.symbols.text(symbol)).is_some()
                }
            }
        };
        self.expect(Kind::RightParen)?;
        Ok(defined)
    }

    /// Skips all tokens before the matching `)`.
    fn skip_to_closing(&mut self) -> PResult<()> {
        let mut open = 0usize;
        loop {
            let token = self.raw();
            match token.kind {
                Kind::RightParen if open == 0 => return Ok(()),
                Kind::RightParen => open -= 1,
                Kind::LeftParen => open += 1,
                Kind::End | Kind::Directive => return Ok(()),
                _ => {}
            }
            self.take(token)?;
        }
    }
}
