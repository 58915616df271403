use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::Kind;
use std::collections::BTreeMap;
use strahl_geometry::Polynomial;

/// `cubic { <20 coefficients> ... }`
pub(super) fn cubic(p: &mut Parser<'_>) -> PResult<Entity> {
    listed(p, Some(3))
}

/// `quartic { <35 coefficients> ... }`
pub(super) fn quartic(p: &mut Parser<'_>) -> PResult<Entity> {
    listed(p, Some(4))
}

/// `poly { order, <coefficients> ... }`
pub(super) fn poly(p: &mut Parser<'_>) -> PResult<Entity> {
    listed(p, None)
}

fn listed(p: &mut Parser<'_>, order: Option<u32>) -> PResult<Entity> {
    p.shape(|p| {
        let order = match order {
            Some(order) => order,
            None => p.order()?,
        };
        let count = Polynomial::coefficient_count(order);
        p.expect(Kind::Less)?;
        let mut coefficients = Vec::with_capacity(count);
        while coefficients.len() < count {
            let token = p.peek()?;
            if token.kind == Kind::Greater {
                let found = coefficients.len();
                let message = format!(
                    "a polynomial of order {order} has {count} coefficients, found {found}"
                );
                return Err(p.fail(p.place_of(token), message));
            }
            coefficients.push(p.float()?);
            p.comma()?;
        }
        p.expect(Kind::Greater)?;
        Ok(Polynomial::try_from_list(order, &coefficients))
    })
}

/// `polynomial { order, xyz(powers of x, y and z): coefficient, ... }`
///
/// Terms that are not named are zero; of a term named twice the last value counts.
pub(super) fn polynomial(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let order = p.order()?;
        let mut terms = BTreeMap::new();
        while p.accept_word(Word::Xyz)? {
            let place = p.place();
            p.expect(Kind::LeftParen)?;
            let mut powers = [0; 3];
            for (axis, power) in powers.iter_mut().enumerate() {
                if axis > 0 {
                    p.comma()?;
                }
                let value = p.float()?;
                if !(0.0..=f64::from(order)).contains(&value) || value.fract() != 0.0 {
                    let message = format!(
                        "a power is a whole number from 0 to the order {order}, found {value}"
                    );
                    return Err(p.fail(place, message));
                }
                *power = value as u32;
            }
            p.expect(Kind::RightParen)?;
            let sum: u32 = powers.iter().sum();
            if sum > order {
                let message = format!("the powers add up to {sum}, but the order is {order}");
                return Err(p.fail(place, message));
            }
            p.expect(Kind::Colon)?;
            terms.insert(powers, p.float()?);
            p.comma()?;
        }
        Ok(Polynomial::try_new(terms))
    })
}

impl Parser<'_> {
    /// The order of a polynomial and an optional comma.
    fn order(&mut self) -> PResult<u32> {
        let token = self.peek()?;
        let place = self.place_of(token);
        let order = self.float()?;
        if !(2.0..=35.0).contains(&order) {
            let message =
                format!("the order of a polynomial is a whole number from 2 to 35, found {order}");
            return Err(self.fail(place, message));
        }
        self.comma()?;
        // The fraction is dropped.
        Ok(order as u32)
    }
}
