use super::array::{MAX_DEPTH, depth_of};
use crate::parser::{PResult, Parser};
use crate::symbol::Symbol;
use crate::token::Kind;
use crate::value::Value;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Values by name (3.8).
#[derive(Clone, Debug, Default)]
pub struct Dictionary {
    entries: BTreeMap<Symbol, Value>,
    depth: u16,
}

impl Dictionary {
    /// The value of a key.
    pub fn get(&self, key: Symbol) -> Option<&Value> {
        self.entries.get(&key)
    }

    pub(crate) fn get_mut(&mut self, key: Symbol) -> Option<&mut Value> {
        self.entries.get_mut(&key)
    }

    /// Sets a value; `false` if containers would be nested too deep.
    pub(crate) fn set(&mut self, key: Symbol, value: Value) -> bool {
        let depth = depth_of(&value);
        if depth >= MAX_DEPTH {
            return false;
        }
        self.depth = self.depth.max(depth + 1);
        self.entries.insert(key, value);
        true
    }

    pub(crate) fn remove(&mut self, key: Symbol) {
        self.entries.remove(&key);
    }

    pub(super) fn depth(&self) -> u16 {
        self.depth.max(1)
    }
}

impl Parser<'_> {
    /// `dictionary { .Key: value, ["Key"]: value }`, whose keyword is taken.
    pub(super) fn dictionary(&mut self) -> PResult<Value> {
        let mut entries = Dictionary::default();
        // `peek` would run a directive that follows.
        if self.raw().kind == Kind::LeftBrace {
            self.braces(|p| {
                while p.peek()?.kind != Kind::RightBrace {
                    let place = p.place();
                    let key = if p.accept(Kind::Dot)? {
                        p.key()?
                    } else {
                        p.key_in_brackets()?
                    };
                    p.expect(Kind::Colon)?;
                    p.spend_elements(1)?;
                    let value = p.value()?;
                    if !entries.set(key, value) {
                        return Err(p.fail(place, "dictionaries are nested too deep"));
                    }
                    p.comma()?;
                }
                Ok(())
            })?;
        }
        Ok(Value::Dictionary(Arc::new(entries)))
    }

    /// The key after a `.`: any name or keyword.
    pub(crate) fn key(&mut self) -> PResult<Symbol> {
        let token = self.raw();
        match token.symbol() {
            Some(symbol) => {
                self.take_unused(token);
                Ok(symbol)
            }
            None => Err(self.unexpected(token, "the key of a dictionary")),
        }
    }

    /// `["Key"]`
    pub(crate) fn key_in_brackets(&mut self) -> PResult<Symbol> {
        self.expect(Kind::LeftBracket)?;
        let text = self.nested(Self::string)?;
        self.expect(Kind::RightBracket)?;
        self.spend_elements(1)?;
        Ok(self.symbols.intern(text.as_bytes()))
    }
}
