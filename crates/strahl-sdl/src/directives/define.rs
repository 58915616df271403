use crate::keywords::Word;
use crate::parser::{Macro, PResult, Parameter, Parser};
use crate::token::Kind;
use crate::value::Value;
use std::sync::Arc;

impl Parser<'_> {
    /// Runs `#macro Name (parameters)`, whose keyword is taken: stores the position of the body and skips it.
    pub(super) fn define(&mut self, opener: usize) -> PResult<()> {
        let name = self.raw_name("the name of a macro")?;
        let mut parameters = vec![];
        self.expect(Kind::LeftParen)?;
        loop {
            if self.raw_accept(Kind::RightParen)? {
                break;
            }
            let optional = self.raw().is(Word::Optional);
            if optional {
                self.next()?;
            }
            let symbol = self.raw_name("the name of a parameter, or `)`")?;
            parameters.push(Parameter { symbol, optional });
            self.raw_accept(Kind::Comma)?;
        }
        let begin = self.position();
        let end = self.end_of(opener)?;
        self.jump(end + 1);
        let defined = Macro {
            name,
            parameters,
            file: Arc::clone(self.current_file()),
            begin,
            end,
        };
        let target = self
            .scopes
            .target(name, false)
            .unwrap_or_else(|| self.global_target(name));
        self.scopes.store(&target, Value::Macro(Arc::new(defined)));
        Ok(())
    }
}
