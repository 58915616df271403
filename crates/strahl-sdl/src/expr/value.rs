use crate::keywords::{Word, WordKind};
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};
use crate::value::Value;

impl Parser<'_> {
    /// Any value: the right side of `#declare`, an element of an array, or an argument of a macro.
    ///
    /// # Errors
    /// If there is none.
    pub fn value(&mut self) -> PResult<Value> {
        let token = self.peek()?;
        match token.kind {
            Kind::String => self.string().map(Value::String),
            Kind::Name => self.value_of_name(token),
            Kind::Word => self.value_of_word(token),
            _ => self.expression().map(Value::from),
        }
    }

    fn value_of_name(&mut self, token: Token) -> PResult<Value> {
        let number = match self.quick_number(4) {
            Some(number) => number,
            None => {
                if let Some(symbol) = token.symbol()
                    && !self.declare_internal(symbol)
                {
                    return Err(self.unexpected(token, "a value"));
                }
                let value = self.variable(token)?;
                let number = match value.numeric() {
                    Some(number) => number,
                    None if value.is_callable() && self.raw().kind == Kind::LeftParen => {
                        self.call_value(&value)?
                    }
                    None => return Ok(value),
                };
                // The name may be the first operand of a longer expression.
                let number = self.components_of(number)?;
                match self.stands_alone(4) && number.len() < 5 {
                    true => number,
                    false => self.binary_from(number, 4)?,
                }
            }
        };
        let followed = self.peek_behind()?;
        match followed.word().map(Word::kind) {
            Some(WordKind::Color) => {
                let color = self.color_parts(super::color::opaque(number))?;
                Ok(Value::Vector(crate::value::Vector::rgbft(color)))
            }
            _ => Ok(number.into()),
        }
    }

    fn thing_value(&mut self, token: Token, word: Word) -> PResult<Value> {
        match self.thing(token)? {
            Some(thing) => Ok(Value::Thing(thing)),
            None if self.raw_ahead(1).kind == Kind::LeftBrace => {
                self.take(token)?;
                let (place, text) = (self.place(), word.text());
                self.warn_hint(
                    place,
                    format!("`{text}` is not supported yet and is left out"),
                    "uses of this declaration are left out too",
                );
                self.skip_body()?;
                Ok(Value::Unsupported("a thing that is not supported yet"))
            }
            None => Err(self.unexpected(token, "a value")),
        }
    }

    fn value_of_word(&mut self, token: Token) -> PResult<Value> {
        let Some(word) = token.word() else {
            return Err(self.unexpected(token, "a value"));
        };
        match word.kind() {
            WordKind::StringFunction => self.string().map(Value::String),
            WordKind::Scope => {
                let value = self.variable(token)?;
                match value.numeric() {
                    Some(number) => {
                        let number = self.components_of(number)?;
                        self.binary_from(number, 4).map(Value::from)
                    }
                    None => Ok(value),
                }
            }
            _ if word == Word::Array => {
                self.take(token)?;
                self.nested(Self::array)
            }
            _ if word == Word::Function => {
                self.take(token)?;
                self.nested(Self::function_value)
            }
            _ if word == Word::Spline => {
                self.take(token)?;
                self.nested(Self::spline)
            }
            _ if word == Word::Dictionary => {
                self.take(token)?;
                self.nested(Self::dictionary)
            }
            WordKind::Object | WordKind::Statement | WordKind::Thing => {
                self.thing_value(token, word)
            }
            _ if word == Word::Composite => self.thing_value(token, word),
            _ => self.expression().map(Value::from),
        }
    }
}
