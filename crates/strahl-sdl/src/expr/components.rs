//! Components of vectors, `V.x`, and what they are where a vector is wanted.

use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::Kind;
use crate::value::Vector;

/// The vectors of which components were taken, for [`Parser::vector3`].
#[derive(Debug, Default)]
pub(crate) struct Members {
    /// Whether the next operand begins an expression where a vector is wanted.
    at_start: bool,
    /// The one whose component the last operand was, if it was one.
    last: Option<Vector>,
    /// The same for the operand that began the expression.
    first: Option<Vector>,
}

impl Parser<'_> {
    /// A number of any kind where a vector is wanted. A float that begins with a component of a vector keeps the other components, as in
    /// POV-Ray (measured): after `translate V.y` with `V = <1, 2, 3>` an object has moved by `<2, 2, 3>`, after `translate 1*V.y` by
    /// `<2, 2, 2>`.
    ///
    /// # Errors
    /// If there is no numeric expression.
    pub(super) fn as_vector(&mut self) -> PResult<Vector> {
        let place = self.place_of(self.raw());
        self.members = Members {
            at_start: true,
            ..Members::default()
        };
        let value = self.expression()?;
        let of = self.members.first.take();
        self.members.at_start = false;
        let (Some(x), Some(of)) = (value.as_float(), of) else {
            return Ok(value);
        };
        let vector = of.with_first(x);
        if vector.to_dvec3() != value.to_dvec3() {
            self.warn_hint(
                place,
                "where a vector is wanted, a component keeps the other components of its vector, as in POV-Ray",
                "put it into parentheses for equal components: with V = <1, 2, 3> `V.y` is <2, 2, 3> here, `(V.y)` is <2, 2, 2>",
            );
        }
        Ok(vector)
    }

    #[inline]
    pub(super) fn factor(&mut self) -> PResult<Vector> {
        if !self.members.at_start {
            return self.operand();
        }
        self.members = Members::default();
        let value = self.operand();
        self.members.first = self.members.last.take();
        value
    }

    /// `.x`, `.red`, ... after a value.
    #[inline]
    pub(super) fn components_of(&mut self, value: Vector) -> PResult<Vector> {
        let token = self.peek_behind()?;
        self.members.last = None;
        if token.kind != Kind::Dot {
            return Ok(value);
        }
        self.members.last = (value.len() > 1).then_some(value);
        self.take(token)?;
        let name = self.next()?;
        let index = match name.word() {
            Some(Word::X | Word::U | Word::Red) => 0,
            Some(Word::Y | Word::V | Word::Green) => 1,
            Some(Word::Z | Word::Blue) => 2,
            Some(Word::T | Word::Filter) => 3,
            Some(Word::Transmit) => 4,
            Some(Word::Gray | Word::Grey) => {
                let [r, g, b, ..] = value.components();
                return Ok(Vector::float(0.297 * r + 0.589 * g + 0.114 * b));
            }
            _ => {
                let place = self.place();
                let found = self.describe(name);
                let message = format!("expected a component, found {found}");
                return Err(self.fail_hint(
                    place,
                    message,
                    "components are x, y, z, t, u, v, red, green, blue, filter, transmit, gray",
                ));
            }
        };
        // A float has all components.
        let all = value.promoted(value.len().max(if value.len() == 1 { 5 } else { 1 }));
        match all.as_slice().get(index) {
            Some(x) => Ok(Vector::float(*x)),
            None => {
                let place = self.place();
                let len = value.len();
                Err(self.fail(
                    place,
                    format!("a vector of {len} components has no such component"),
                ))
            }
        }
    }
}
