use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::symbol::Symbol;
use crate::token::{Kind, Token};
use crate::value::Value;

impl Parser<'_> {
    /// The value of the name at the position, with the `[i]` and `.Key` after it.
    pub(super) fn variable(&mut self, token: Token) -> PResult<Value> {
        let symbol = self.variable_name(token)?;
        let place = self.place();
        let Some(found) = self.scopes.find(symbol) else {
            return Err(self.undeclared(symbol, place, "a value"));
        };
        let mut value = found.clone();
        loop {
            let next = self.raw();
            value = match (&value, next.kind) {
                (Value::Array(array), Kind::LeftBracket) => {
                    let index = self.index_in(array, false)?;
                    match array.element(index) {
                        Some(element) => element.clone(),
                        None => return Err(self.empty_element(symbol)),
                    }
                }
                (Value::Dictionary(d), Kind::Dot | Kind::LeftBracket) => {
                    let key = if next.kind == Kind::Dot {
                        self.take(next)?;
                        self.key()?
                    } else {
                        self.key_in_brackets()?
                    };
                    match d.get(key) {
                        Some(element) => element.clone(),
                        None => return Err(self.no_such_key(key)),
                    }
                }
                _ => return Ok(value),
            };
        }
    }

    /// A name, possibly with `local.` or `global.` before it.
    fn variable_name(&mut self, token: Token) -> PResult<Symbol> {
        self.take(token)?;
        if token.is(Word::Local) || token.is(Word::Global) {
            self.expect(Kind::Dot)?;
            return self.raw_name("the name of a variable");
        }
        match token.symbol() {
            Some(symbol) => Ok(symbol),
            None => Err(self.unexpected(token, "the name of a variable")),
        }
    }

    fn empty_element(&mut self, array: Symbol) -> crate::parser::Failed {
        let place = self.place();
        let name = self.symbols.text(array).to_owned();
        self.fail_hint(
            place,
            format!("this element of `{name}` has no value yet"),
            format!("set it first: `#declare {name}[...] = ...;`"),
        )
    }

    fn no_such_key(&mut self, key: Symbol) -> crate::parser::Failed {
        let place = self.place();
        let key = self.symbols.text(key).to_owned();
        self.fail(place, format!("the dictionary has no entry `{key}`"))
    }
}
