//! The fast path for expressions that consist of floats and vectors only.
//!
//! Most expressions are numbers, names, vectors of them and the four operations. They are evaluated here directly from the
//! tokens, without expanding macros and without errors; at the first token that needs more, the attempt ends, nothing has
//! changed, and the full evaluator starts from the beginning. Both give the same bits, because the operations are the same.

use super::{OPERATORS_SINCE, equal, precedence, truth};
use crate::keywords::Word;
use crate::parser::Parser;
use crate::token::{Kind, Token};
use crate::value::{Value, Vector};
use strahl_math::det;

/// Nested parentheses; deeper ones are left to the full evaluator.
const DEPTH: u32 = 8;

/// Whether an expression certainly ends before this token: nothing that could expand to an operator, index or argument.
const fn ends(kind: Kind) -> bool {
    matches!(
        kind,
        Kind::Comma
            | Kind::Greater
            | Kind::RightBrace
            | Kind::RightParen
            | Kind::RightBracket
            | Kind::Semicolon
            | Kind::Word
    )
}

impl Parser<'_> {
    /// The number at the position, if it is unsigned and certainly the whole expression; the position then moves past it.
    #[inline]
    pub(super) fn lone_number(&mut self) -> Option<f64> {
        let token = self.raw();
        if token.kind != Kind::Number || !ends(self.raw_ahead(1).kind) {
            return None;
        }
        self.pass(1);
        Some(f64::from_bits(token.bits))
    }

    /// The vector at the position, if its components are numbers and it is certainly the whole expression; the position then
    /// moves past it. Exported scenes consist mostly of such vectors. Returns the components and their number.
    #[inline]
    pub(super) fn lone_vector(&mut self) -> Option<([f64; 5], usize)> {
        let begin = self.position();
        let mut tokens = self.current_file().tokens_from(begin).iter();
        if tokens.next()?.kind != Kind::Less {
            return None;
        }
        let mut components = [0.0; 5];
        for count in 0..5 {
            let mut token = tokens.next()?;
            let negative = token.kind == Kind::Minus;
            if negative {
                token = tokens.next()?;
            }
            if token.kind != Kind::Number {
                return None;
            }
            let number = f64::from_bits(token.bits);
            *components.get_mut(count)? = if negative { -number } else { number };
            match tokens.next()?.kind {
                Kind::Comma => {}
                Kind::Greater if count > 0 && ends(tokens.as_slice().first()?.kind) => {
                    let left = tokens.len();
                    let passed = self.current_file().tokens_from(begin).len() - left;
                    self.pass(passed);
                    return Some((components, count + 1));
                }
                _ => return None,
            }
        }
        None
    }

    /// The float expression at the position with operators of at least this precedence; the position then moves past it. Returns
    /// `None`, and the position stays, if the expression needs more than floats.
    #[inline]
    pub(super) fn quick(&mut self, weakest: u8) -> Option<f64> {
        let first = self.raw().kind;
        if !matches!(
            first,
            Kind::Number | Kind::Name | Kind::Minus | Kind::LeftParen | Kind::Word
        ) || self.stands_alone(weakest)
        {
            return None;
        }
        let begin = self.position();
        let mut position = begin;
        let value = self.quick_binary(&mut position, weakest, DEPTH)?;
        self.pass(position - begin);
        Some(value)
    }

    /// The same for expressions of floats and vectors.
    #[inline]
    pub(super) fn quick_number(&mut self, weakest: u8) -> Option<Vector> {
        if self.stands_alone(weakest) {
            return None;
        }
        let first = self.raw();
        let vector = match first.kind {
            Kind::Less => true,
            Kind::Name => matches!(self.scopes.find(first.symbol()?)?, Value::Vector(_)),
            _ => false,
        };
        if !vector && let Some(x) = self.quick(weakest) {
            return Some(Vector::float(x));
        }
        let begin = self.position();
        let mut position = begin;
        let value = self.quick_vector_binary(&mut position, weakest)?;
        self.pass(position - begin);
        Some(value)
    }

    /// Whether numbers of this version have no operators here.
    pub(super) fn stands_alone(&self, weakest: u8) -> bool {
        weakest == 4 && self.version < OPERATORS_SINCE
    }

    fn quick_vector_binary(&self, position: &mut usize, weakest: u8) -> Option<Vector> {
        let mut left = self.quick_vector_operand(position)?;
        loop {
            let kind = self.token_at(*position).kind;
            let binds = precedence(kind);
            if binds == 0 || binds < weakest {
                return (binds > 0 || ends(kind)).then_some(left);
            }
            *position += 1;
            let right = if binds == 5 {
                self.quick_vector_operand(position)?
            } else {
                self.quick_vector_binary(position, binds + 1)?
            };
            left = match kind {
                Kind::Plus => left.zip(right, |a, b| a + b),
                Kind::Minus => left.zip(right, |a, b| a - b),
                Kind::Star => left.zip(right, |a, b| a * b),
                Kind::Slash => {
                    let divisor = right.promoted(left.len().max(right.len()));
                    if divisor.as_slice().contains(&0.0) {
                        return None;
                    }
                    left.zip(right, |a, b| a / b)
                }
                _ => return None,
            };
        }
    }

    fn quick_vector_operand(&self, position: &mut usize) -> Option<Vector> {
        let token = self.token_at(*position);
        let value = match token.kind {
            Kind::Less => {
                *position += 1;
                self.quick_components(position)?
            }
            Kind::Name => match self.scopes.find_plain(token.symbol()?)? {
                Value::Float(x) => {
                    *position += 1;
                    Vector::float(*x)
                }
                Value::Vector(v) => {
                    *position += 1;
                    *v
                }
                _ => return None,
            },
            _ => Vector::float(self.quick_operand(position, DEPTH)?),
        };
        let after = self.token_at(*position).kind;
        (ends(after) || precedence(after) > 0).then_some(value)
    }

    /// The components after a `<`, up to and including the `>`.
    fn quick_components(&self, position: &mut usize) -> Option<Vector> {
        let mut components = [0.0; 5];
        for count in 0..5 {
            *components.get_mut(count)? = self.quick_binary(position, 4, DEPTH)?;
            let kind = self.token_at(*position).kind;
            *position += 1;
            match kind {
                Kind::Comma => {}
                Kind::Greater if count > 0 => return Some(Vector::of(components, count + 1)),
                _ => return None,
            }
        }
        None
    }

    #[inline]
    fn token_at(&self, position: usize) -> Token {
        self.current_file().token(position).unwrap_or(Token::END)
    }

    fn quick_binary(&self, position: &mut usize, weakest: u8, depth: u32) -> Option<f64> {
        let mut left = self.quick_operand(position, depth)?;
        loop {
            let kind = self.token_at(*position).kind;
            let binds = precedence(kind);
            if binds == 0 || binds < weakest {
                return (binds > 0 || ends(kind)).then_some(left);
            }
            *position += 1;
            let right = if binds == 5 {
                self.quick_operand(position, depth)?
            } else {
                self.quick_binary(position, binds + 1, depth)?
            };
            left = match kind {
                Kind::Plus => left + right,
                Kind::Minus => left - right,
                Kind::Star => left * right,
                Kind::Slash if right != 0.0 => left / right,
                Kind::Less => truth(left < right),
                Kind::Greater => truth(left > right),
                Kind::Equal => truth(equal(left, right)),
                Kind::NotEqual => truth(!equal(left, right)),
                Kind::LessEqual => truth(left < right || equal(left, right)),
                Kind::GreaterEqual => truth(left > right || equal(left, right)),
                _ => return None,
            };
        }
    }

    fn quick_operand(&self, position: &mut usize, depth: u32) -> Option<f64> {
        let token = self.token_at(*position);
        *position += 1;
        let value = match token.kind {
            Kind::Number => f64::from_bits(token.bits),
            Kind::Name => match self.scopes.find_plain(token.symbol()?)? {
                Value::Float(x) => *x,
                _ => return None,
            },
            Kind::Minus if depth > 0 => return Some(-self.quick_operand(position, depth - 1)?),
            Kind::LeftParen => self.quick_parenthesised(position, depth)?,
            Kind::Word => {
                let function = match token.word()? {
                    Word::Sin => det::sin,
                    Word::Cos => det::cos,
                    Word::Abs => f64::abs,
                    Word::Floor => f64::floor,
                    _ => return None,
                };
                if self.token_at(*position).kind != Kind::LeftParen {
                    return None;
                }
                *position += 1;
                function(self.quick_parenthesised(position, depth)?)
            }
            _ => return None,
        };
        let after = self.token_at(*position).kind;
        (ends(after) || precedence(after) > 0).then_some(value)
    }

    /// The expression after a `(`, up to and including the `)`.
    fn quick_parenthesised(&self, position: &mut usize, depth: u32) -> Option<f64> {
        let value = self.quick_binary(position, 1, depth.checked_sub(1)?)?;
        let closed = self.token_at(*position).kind == Kind::RightParen;
        *position += 1;
        closed.then_some(value)
    }
}
