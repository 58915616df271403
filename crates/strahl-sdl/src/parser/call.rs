use super::{Entry, PResult, Parser, Step, Target};
use crate::source::Chunk;
use crate::symbol::Symbol;
use crate::token::{Kind, Token};
use crate::value::Value;
use std::sync::Arc;

/// A macro: a slice of the tokens of a file's chunk, with parameters.
#[derive(Debug)]
pub struct Macro {
    pub(crate) name: Symbol,
    pub(crate) parameters: Vec<Parameter>,
    pub(crate) file: Arc<Chunk>,
    /// First token of the body.
    pub(crate) begin: usize,
    /// The `#end`.
    pub(crate) end: usize,
}

/// A parameter of a macro.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parameter {
    pub(crate) symbol: Symbol,
    /// Whether a call may omit it (3.8).
    pub(crate) optional: bool,
}

/// The value of a parameter.
pub(super) enum Argument {
    Value(Value),
    /// The variable itself: assignments to the parameter change the variable.
    Variable(Target),
    Missing,
}

impl Parser<'_> {
    /// Calls a macro: reads its arguments and continues in its body. `name` is the token at the position.
    pub(super) fn call(&mut self, name: Token, called: Arc<Macro>) -> PResult<()> {
        self.take(name)?;
        let from = self.place();
        let mut arguments = std::mem::take(&mut self.arguments);
        self.nested(|p| p.enclosed(|p| p.arguments(&called, &mut arguments)))?;
        let file = Arc::clone(&called.file);
        let entry = Entry::Macro(called.name);
        self.enter_frame(entry, from, file, called.begin, called.end)?;
        for (parameter, argument) in called.parameters.iter().zip(arguments.drain(..)) {
            match argument {
                Argument::Value(value) => self.scopes.bind_value(parameter.symbol, value),
                Argument::Variable(target) => self.scopes.bind_alias(parameter.symbol, target),
                Argument::Missing => {}
            }
        }
        self.arguments = arguments;
        Ok(())
    }

    fn arguments(&mut self, called: &Macro, out: &mut Vec<Argument>) -> PResult<()> {
        self.expect(Kind::LeftParen)?;
        for (index, parameter) in called.parameters.iter().enumerate() {
            let token = self.peek()?;
            let left_out = matches!(token.kind, Kind::Comma | Kind::RightParen);
            if left_out && !parameter.optional {
                return Err(self.wrong_count(called, index));
            }
            out.push(if left_out {
                Argument::Missing
            } else {
                self.argument()?
            });
            self.comma()?;
        }
        if self.accept(Kind::RightParen)? {
            return Ok(());
        }
        let token = self.peek()?;
        let name = self.symbols.text(called.name).to_owned();
        let count = called.parameters.len();
        Err(self.unexpected(
            token,
            &format!("`)`: macro `{name}` has {count} parameters"),
        ))
    }

    fn wrong_count(&mut self, called: &Macro, given: usize) -> super::Failed {
        let name = self.symbols.text(called.name).to_owned();
        let missing = called.parameters.get(given);
        let missing = missing
            .map_or("", |p| self.symbols.text(p.symbol))
            .to_owned();
        let count = called.parameters.len();
        let place = self.place();
        let message = format!("macro `{name}` has {count} parameters, but only {given} are given");
        self.fail_hint(place, message, format!("give a value for `{missing}`"))
    }

    fn argument(&mut self) -> PResult<Argument> {
        let token = self.raw();
        let (begin, depth) = (self.position(), self.frame_depth());
        if let (Kind::Name, Some(symbol)) = (token.kind, token.symbol())
            && let Some(mut target) = self.scopes.target(symbol, false)
        {
            let ends = |t: Token| matches!(t.kind, Kind::Comma | Kind::RightParen);
            if ends(self.raw_ahead(1)) {
                self.take(token)?;
                return Ok(Argument::Variable(target));
            }
            if self.raw_ahead(1).kind == Kind::LeftBracket
                && matches!(self.scopes.at(&target), Some(Value::Array(_)))
            {
                self.take(token)?;
                let index = self.array_index(&target)?;
                if ends(self.raw()) && depth == self.frame_depth() {
                    target.path.push(Step::Index(index));
                    return Ok(Argument::Variable(target));
                }
                // The variable is part of a larger expression.
                self.jump(begin);
            }
        }
        self.value().map(Argument::Value)
    }
}
