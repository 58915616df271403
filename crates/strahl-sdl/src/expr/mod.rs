//! Expressions, evaluated directly from the tokens.
//!
//! Where the language expects a number, it accepts a *numeric* expression (`+ - * /`); comparisons, `&`, `|` and `?:` are allowed
//! only in parentheses, so that `>` can end a vector.

mod access;
mod array;
mod color;
mod components;
mod defined;
mod dictionary;
mod float_functions;
mod function;
mod quick;
mod random;
mod spline;
mod strings;
mod texture_function;
mod value;
mod vector_field;
mod vector_functions;

pub use array::Array;
pub(crate) use components::Members;
pub use dictionary::Dictionary;
pub use spline::{Spline, SplineKind};
pub use texture_function::PigmentFunction;
pub(crate) use vector_functions::rotation;

use crate::grammar::Thing;
use crate::keywords::{Word, WordKind};
use crate::parser::{PResult, Parser, Place};
use crate::token::{Kind, Token};
use crate::value::{Value, Vector};
use strahl_math::DVec3;

/// Numbers closer than this count as equal in comparisons; measured with POV-Ray 3.7.
const EPSILON: f64 = 1e-10;

/// The version from which on operators need no parentheses. Before it `<1 -2 3>` has three components; measured
/// with POV-Ray 3.7.
const OPERATORS_SINCE: f64 = 1.5;

/// The precedence of an operator; 0 for other tokens. `&` and `|` have the same precedence, measured with POV-Ray 3.7 (but not
/// in functions).
const fn precedence(kind: Kind) -> u8 {
    match kind {
        Kind::Bar | Kind::Ampersand => 1,
        Kind::Less
        | Kind::LessEqual
        | Kind::Greater
        | Kind::GreaterEqual
        | Kind::Equal
        | Kind::NotEqual => 3,
        Kind::Plus | Kind::Minus => 4,
        Kind::Star | Kind::Slash => 5,
        _ => 0,
    }
}

/// Whether an operand certainly ends before a token of this kind: no component, index or argument can follow.
const fn ends_operand(after: Kind) -> bool {
    matches!(
        after,
        Kind::Comma
            | Kind::Greater
            | Kind::RightBrace
            | Kind::RightParen
            | Kind::RightBracket
            | Kind::Semicolon
            | Kind::Word
            | Kind::Plus
            | Kind::Minus
            | Kind::Star
            | Kind::Slash
    )
}

/// Equality as the language compares numbers.
pub(crate) fn equal(a: f64, b: f64) -> bool {
    (a - b).abs() < EPSILON || a == b
}

/// Whether a number counts as true: what counts as equal to 0 is false, as in POV-Ray (measured).
pub(crate) fn is_true(x: f64) -> bool {
    !equal(x, 0.0)
}

fn truth(b: bool) -> f64 {
    if b { 1.0 } else { 0.0 }
}

impl Parser<'_> {
    /// A float.
    ///
    /// # Errors
    /// If there is no numeric expression, or it is a vector.
    #[inline]
    pub fn float(&mut self) -> PResult<f64> {
        if let Some(x) = self.lone_number() {
            return Ok(x);
        }
        if let Some(x) = self.quick(4) {
            return Ok(x);
        }
        let token = self.peek()?;
        let place = self.place_of(token);
        let value = self.expression()?;
        self.as_float(value, place)
    }

    /// A vector of three components; a float stands for three equal ones.
    ///
    /// # Errors
    /// If there is no numeric expression.
    #[inline]
    pub fn vector3(&mut self) -> PResult<DVec3> {
        Ok(match self.lone_vector() {
            // Missing components are zero.
            Some(([x, y, z, ..], _)) => DVec3::new(x, y, z),
            None => self.as_vector()?.to_dvec3(),
        })
    }

    /// A vector of two components; a float stands for two equal ones.
    ///
    /// # Errors
    /// If there is no numeric expression.
    pub fn vector2(&mut self) -> PResult<[f64; 2]> {
        let [u, v, ..] = self.expression()?.promoted(2).components();
        Ok([u, v])
    }

    /// A vector of four components; a float stands for four equal ones.
    ///
    /// # Errors
    /// If there is no numeric expression.
    pub fn vector4(&mut self) -> PResult<[f64; 4]> {
        let [x, y, z, w, ..] = self.expression()?.promoted(4).components();
        Ok([x, y, z, w])
    }

    /// A number of any kind: float, vector or colour.
    ///
    /// # Errors
    /// If there is no numeric expression.
    #[inline]
    pub fn expression(&mut self) -> PResult<Vector> {
        if let Some((components, count)) = self.lone_vector() {
            return Ok(Vector::of(components, count));
        }
        if let Some(number) = self.quick_number(4) {
            return Ok(number);
        }
        if self.stands_alone(4) {
            return self.factor();
        }
        self.binary(4)
    }

    /// A number of any kind in a colour, where operators are allowed in all versions.
    fn calculation(&mut self) -> PResult<Vector> {
        if self.stands_alone(4) {
            return self.binary(4);
        }
        self.expression()
    }

    /// An expression in parentheses, with comparisons, logic and `?:`.
    ///
    /// # Errors
    /// If there is no such expression.
    pub fn full_expression(&mut self) -> PResult<Vector> {
        if let Some(x) = self.quick(1) {
            return Ok(Vector::float(x));
        }
        let condition = self.binary(1)?;
        if self.peek()?.kind != Kind::Question {
            return Ok(condition);
        }
        let place = self.place();
        self.next()?;
        let yes = self.nested(Self::full_expression)?;
        self.expect(Kind::Colon)?;
        let no = self.nested(Self::full_expression)?;
        let holds = is_true(self.as_float(condition, place)?);
        Ok(if holds { yes } else { no })
    }

    /// A number, or the name of a float.
    #[inline]
    fn plain_float(&self, token: Token) -> Option<f64> {
        match token.kind {
            Kind::Number => Some(f64::from_bits(token.bits)),
            Kind::Name => match self.scopes.find_plain(token.symbol()?) {
                Some(Value::Float(x)) => Some(*x),
                _ => None,
            },
            _ => None,
        }
    }

    #[inline]
    fn binary(&mut self, weakest: u8) -> PResult<Vector> {
        let left = self.factor()?;
        self.binary_from(left, weakest)
    }

    /// Continues an expression whose first operand is known.
    fn binary_from(&mut self, mut left: Vector, weakest: u8) -> PResult<Vector> {
        loop {
            let token = self.peek_behind()?;
            let binds = precedence(token.kind);
            if binds < weakest || binds == 0 {
                return Ok(left);
            }
            self.take(token)?;
            let place = self.place();
            let right = if binds == 5 {
                self.factor()?
            } else {
                self.binary(binds + 1)?
            };
            left = match (token.kind, left.as_float(), right.as_float()) {
                (Kind::Plus, Some(a), Some(b)) => Vector::float(a + b),
                (Kind::Minus, Some(a), Some(b)) => Vector::float(a - b),
                (Kind::Star, Some(a), Some(b)) => Vector::float(a * b),
                _ => self.combine(token.kind, left, right, place)?,
            };
        }
    }

    fn combine(&mut self, operator: Kind, a: Vector, b: Vector, place: Place) -> PResult<Vector> {
        Ok(match operator {
            Kind::Plus => a.zip(b, |x, y| x + y),
            Kind::Minus => a.zip(b, |x, y| x - y),
            Kind::Star => a.zip(b, |x, y| x * y),
            Kind::Slash => {
                let divisor = b.promoted(a.len().max(b.len()));
                if divisor.as_slice().contains(&0.0) {
                    self.warn_hint(
                        place,
                        "division by zero gives infinity, as in POV-Ray",
                        "most objects cannot have an infinite size or place; test the divisor with `#if` first",
                    );
                }
                // Of any number, also of 0 and of negative ones (measured).
                a.zip(b, |x, y| if y == 0.0 { f64::INFINITY } else { x / y })
            }
            Kind::Ampersand => a.zip(b, |x, y| truth(is_true(x) && is_true(y))),
            Kind::Bar => a.zip(b, |x, y| truth(is_true(x) || is_true(y))),
            // Component by component, as in POV-Ray (measured).
            _ => a.zip(b, |x, y| {
                let same = equal(x, y);
                truth(match operator {
                    Kind::Equal => same,
                    Kind::NotEqual => !same,
                    Kind::Less => x < y,
                    Kind::Greater => x > y,
                    Kind::LessEqual => x < y || same,
                    _ => x > y || same,
                })
            }),
        })
    }

    #[inline]
    fn operand(&mut self) -> PResult<Vector> {
        // Most operands are plain floats with no macro or directive around them.
        if let Some(x) = self.plain_float(self.raw())
            && ends_operand(self.raw_ahead(1).kind)
        {
            self.jump(self.position() + 1);
            return Ok(Vector::float(x));
        }
        let token = self.peek()?;
        match token.kind {
            Kind::Number => {
                self.take(token)?;
                self.components_of(Vector::float(token.number()))
            }
            Kind::Less => {
                let vector = self.vector_literal(token)?;
                self.components_of(vector)
            }
            Kind::Minus => {
                self.take(token)?;
                Ok(self.nested_end(Self::factor)?.map(|x| -x))
            }
            Kind::Plus => {
                self.take(token)?;
                self.nested_end(Self::factor)
            }
            Kind::Bang => {
                self.take(token)?;
                Ok(self.nested_end(Self::factor)?.map(|x| truth(!is_true(x))))
            }
            Kind::LeftParen => {
                self.take(token)?;
                let value = self.nested(Self::full_expression)?;
                self.expect(Kind::RightParen)?;
                self.components_of(value)
            }
            Kind::Name => self.name_in_expression(token),
            Kind::Word => self.word_in_expression(token),
            Kind::String if precedence(self.raw_ahead(1).kind) == 3 => {
                let text = self.string()?;
                self.compared(&text)
            }
            _ => Err(self.unexpected(token, "a number or vector")),
        }
    }

    /// `= string` and other comparisons after a string: a truth value.
    fn compared(&mut self, left: &str) -> PResult<Vector> {
        let token = self.peek()?;
        if precedence(token.kind) != 3 {
            return Err(self.unexpected(token, "a comparison of the string before it"));
        }
        self.take(token)?;
        let right = self.string()?;
        let order = left.as_bytes().cmp(right.as_bytes());
        Ok(Vector::float(truth(match token.kind {
            Kind::Equal => order.is_eq(),
            Kind::NotEqual => order.is_ne(),
            Kind::Less => order.is_lt(),
            Kind::Greater => order.is_gt(),
            Kind::LessEqual => order.is_le(),
            _ => order.is_ge(),
        })))
    }

    /// `<a, b, ...>` with two to five components.
    #[inline]
    fn vector_literal(&mut self, open: Token) -> PResult<Vector> {
        self.take(open)?;
        let place = self.place();
        let mut numbers = [0.0; 5];
        let mut count = 0;
        self.nested(|p| {
            loop {
                let number = p.float()?;
                match numbers.get_mut(count) {
                    Some(slot) => *slot = number,
                    None => return Err(p.fail(place, "a vector has at most 5 components")),
                }
                count += 1;
                let token = p.peek()?;
                match token.kind {
                    Kind::Comma => {
                        p.take(token)?;
                        // A comma after the last component is allowed.
                        let token = p.peek()?;
                        if token.kind == Kind::Greater {
                            return p.take(token);
                        }
                    }
                    Kind::Greater => return p.take(token),
                    _ => {}
                }
            }
        })?;
        if count < 2 {
            return Err(self.fail(place, "a vector has at least 2 components"));
        }
        Ok(Vector::new(numbers.get(..count).unwrap_or(&numbers)))
    }

    fn name_in_expression(&mut self, token: Token) -> PResult<Vector> {
        let place = self.place_of(token);
        let simple = !matches!(self.raw_ahead(1).kind, Kind::Dot | Kind::LeftBracket);
        if simple && let Some(symbol) = token.symbol() {
            let number = self.scopes.find(symbol).and_then(Value::numeric);
            return match number {
                Some(number) => {
                    self.take(token)?;
                    self.components_of(number)
                }
                None => self.not_numeric(token),
            };
        }
        let value = self.variable(token)?;
        if let Value::String(text) = &value
            && precedence(self.peek_behind()?.kind) == 3
        {
            return self.compared(text);
        }
        match value.numeric() {
            Some(number) => self.components_of(number),
            None if value.is_callable() => self.call_value(&value),
            None => {
                let message = format!("expected a number or vector, found {}", value.describe());
                Err(self.fail(place, message))
            }
        }
    }

    /// A name that is not a number: a function to be called, or an error.
    fn not_numeric(&mut self, token: Token) -> PResult<Vector> {
        let found = token.symbol().and_then(|s| self.scopes.find(s));
        if matches!(found, Some(Value::String(_))) && precedence(self.raw_ahead(1).kind) == 3 {
            let text = self.string()?;
            return self.compared(&text);
        }
        if let Some(symbol) = token.symbol() {
            self.declare_internal(symbol);
        }
        let callee = token.symbol().and_then(|s| self.scopes.find(s));
        let callee = callee.filter(|value| value.is_callable()).cloned();
        match callee {
            Some(callee) => {
                self.take(token)?;
                self.call_value(&callee)
            }
            None => Err(self.unexpected(token, "a number or vector")),
        }
    }

    /// Calls the value that was just named.
    fn call_value(&mut self, callee: &Value) -> PResult<Vector> {
        let value = match callee {
            Value::Function(function) => {
                let called = self.nested(|p| p.call_function(function))?;
                Vector::float(called)
            }
            Value::Spline(spline) => self.nested(|p| p.call_spline(spline))?,
            Value::Thing(Thing::PigmentFunction(pigment)) => {
                self.nested(|p| p.call_pigment(pigment))?
            }
            Value::Thing(Thing::TransformFunction(map)) => {
                self.nested(|p| p.call_transform(map))?
            }
            _ => {
                let place = self.place();
                return Err(self.fail(place, format!("{} cannot be called", callee.describe())));
            }
        };
        self.components_of(value)
    }

    fn word_in_expression(&mut self, token: Token) -> PResult<Vector> {
        let Some(word) = token.word() else {
            return Err(self.unexpected(token, "a number or vector"));
        };
        let value = match word.kind() {
            WordKind::Constant => {
                let value = self.constant(word);
                self.take(token)?;
                value
            }
            WordKind::FloatFunction => {
                self.take(token)?;
                let place = self.place();
                Vector::float(self.nested(|p| p.float_function(word, place))?)
            }
            WordKind::VectorFunction => {
                self.take(token)?;
                let place = self.place();
                self.nested(|p| p.vector_function(word, place))?
            }
            WordKind::StringFunction => {
                let text = self.string()?;
                return self.compared(&text);
            }
            WordKind::Color => return self.nested_end(Self::color_expression).map(Vector::rgbft),
            WordKind::Scope => {
                let value = self.variable(token)?;
                match value.numeric() {
                    Some(number) => number,
                    None => {
                        let place = self.place();
                        let found = value.describe();
                        return Err(
                            self.fail(place, format!("expected a number or vector, found {found}"))
                        );
                    }
                }
            }
            _ => return Err(self.unexpected(token, "a number or vector")),
        };
        self.components_of(value)
    }

    fn constant(&mut self, word: Word) -> Vector {
        let o = self.options;
        Vector::float(match word {
            Word::X => return Vector::xyz(1.0, 0.0, 0.0),
            Word::Y => return Vector::xyz(0.0, 1.0, 0.0),
            Word::Z => return Vector::xyz(0.0, 0.0, 1.0),
            Word::T => return Vector::new(&[0.0, 0.0, 0.0, 1.0]),
            Word::U => return Vector::new(&[1.0, 0.0]),
            Word::V => return Vector::new(&[0.0, 1.0]),
            Word::Pi => std::f64::consts::PI,
            Word::Tau => std::f64::consts::TAU,
            Word::True | Word::Yes | Word::On => 1.0,
            // POV-Ray keeps the clock as a 32-bit number (measured): `clock >= 0.7` is false for a clock of 0.7.
            Word::Clock => f64::from(o.clock as f32),
            Word::ClockOn => truth(o.frame.animated),
            Word::ClockDelta => o.frame.clock_delta,
            Word::FinalClock => o.frame.final_clock,
            Word::FinalFrame => o.frame.last,
            Word::FrameNumber => o.frame.number,
            Word::ImageHeight => f64::from(o.image_height),
            Word::ImageWidth => f64::from(o.image_width),
            Word::InitialClock => o.frame.initial_clock,
            Word::InitialFrame => o.frame.first,
            Word::Now => self.host.now(),
            Word::Version => self.version,
            _ => 0.0,
        })
    }

    /// The value as a float.
    pub(crate) fn as_float(&mut self, value: Vector, place: Place) -> PResult<f64> {
        match value.as_float() {
            Some(x) => Ok(x),
            None => {
                let message = format!(
                    "expected a float, found a vector of {} components",
                    value.len()
                );
                Err(self.fail_hint(
                    place,
                    message,
                    "use one of its components, such as `.x`, or its `vlength`",
                ))
            }
        }
    }
}
