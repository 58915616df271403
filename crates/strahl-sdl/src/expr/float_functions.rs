use crate::keywords::Word;
use crate::parser::{PResult, Parser, Place};
use crate::token::Kind;
use strahl_math::det;

impl Parser<'_> {
    /// A float function whose keyword is taken.
    pub(super) fn float_function(&mut self, word: Word, place: Place) -> PResult<f64> {
        if word == Word::Defined {
            return self.is_defined().map(super::truth);
        }
        self.expect(Kind::LeftParen)?;
        let value = match word {
            Word::Abs => self.full_float()?.abs(),
            Word::Acos => det::acos(self.full_float()?.clamp(-1.0, 1.0)),
            Word::Acosh => self.inverse(place, "acosh", |x| x >= 1.0, det::acosh)?,
            Word::Asin => det::asin(self.full_float()?.clamp(-1.0, 1.0)),
            Word::Asinh => det::asinh(self.full_float()?),
            Word::Atan => det::atan(self.full_float()?),
            Word::Atanh => self.inverse(place, "atanh", |x| x.abs() < 1.0, det::atanh)?,
            Word::Ceil => self.full_float()?.ceil(),
            Word::Cos => det::cos(self.full_float()?),
            Word::Cosh => det::cosh(self.full_float()?),
            Word::Degrees => self.full_float()?.to_degrees(),
            Word::Exp => det::exp(self.full_float()?),
            Word::Floor => self.full_float()?.floor(),
            Word::Int => self.full_float()?.trunc(),
            Word::Ln => self.inverse(place, "ln", |x| x > 0.0, det::ln)?,
            Word::Log => self.inverse(place, "log", |x| x > 0.0, det::log10)?,
            Word::Radians => self.full_float()?.to_radians(),
            Word::Sin => det::sin(self.full_float()?),
            Word::Sinh => det::sinh(self.full_float()?),
            Word::Sqr => {
                let x = self.full_float()?;
                x * x
            }
            Word::Sqrt => self.inverse(place, "sqrt", |x| x >= 0.0, f64::sqrt)?,
            Word::Tan => det::tan(self.full_float()?),
            Word::Tanh => det::tanh(self.full_float()?),
            Word::Atan2 => self.pair().map(|(y, x)| det::atan2(y, x))?,
            Word::Div => {
                let (a, b) = self.divided(place)?;
                (a / b).trunc()
            }
            Word::Mod => {
                let (a, b) = self.divided(place)?;
                a % b
            }
            Word::Pow => self.pair().map(|(a, b)| det::pow(a, b))?,
            Word::Max => self.fold(|a, b| if b > a { b } else { a })?,
            Word::Min => self.fold(|a, b| if b < a { b } else { a })?,
            Word::BitwiseAnd => self.bitwise(|a, b| a & b)?,
            Word::BitwiseOr => self.bitwise(|a, b| a | b)?,
            Word::BitwiseXor => self.bitwise(|a, b| a ^ b)?,
            Word::Select => self.select()?,
            Word::Inside => super::truth(self.ask_inside()?),
            Word::Seed => {
                let seed = self.full_float()?;
                self.seed(seed, place)?
            }
            Word::Rand => {
                let stream = self.full_float()?;
                self.rand(stream, place)?
            }
            Word::Dimensions => self.array_argument()?.dimensions().len() as f64,
            Word::DimensionSize => {
                let array = self.array_argument()?;
                self.comma()?;
                let which = self.full_float()?;
                let index = (which - 1.0 + 1e-8).max(-1.0);
                let size = (index >= 0.0).then(|| array.dimensions().get(index as usize));
                match size.flatten() {
                    Some(size) => *size as f64,
                    None => {
                        let count = array.dimensions().len();
                        let message = format!(
                            "the array has {count} dimensions; there is no dimension {which}"
                        );
                        return Err(self.fail(place, message));
                    }
                }
            }
            Word::Vdot => {
                let a = self.vector3()?;
                self.comma()?;
                let b = self.vector3()?;
                a.dot(b)
            }
            Word::Vlength => self.vector3()?.length(),
            Word::Strlen => self.string()?.chars().count() as f64,
            Word::Strcmp => {
                let a = self.string()?;
                self.comma()?;
                let b = self.string()?;
                difference(&a, &b)
            }
            Word::Asc => {
                let text = self.string()?;
                text.chars().next().map_or(0.0, |c| f64::from(u32::from(c)))
            }
            Word::Val => {
                let text = self.string()?;
                super::strings::leading_number(&text)
            }
            Word::FileExists => {
                let name = self.file_name()?;
                super::truth(self.exists(&name, place))
            }
            _ => {
                let text = word.text();
                return Err(self.fail(
                    place,
                    format!("the function `{text}` is not supported here"),
                ));
            }
        };
        self.expect(Kind::RightParen)?;
        Ok(value)
    }

    /// A float in the parentheses of a function, where comparisons are unambiguous.
    pub(crate) fn full_float(&mut self) -> PResult<f64> {
        let token = self.peek()?;
        let place = self.place_of(token);
        let value = self.full_expression()?;
        self.as_float(value, place)
    }

    fn pair(&mut self) -> PResult<(f64, f64)> {
        let a = self.full_float()?;
        self.comma()?;
        Ok((a, self.full_float()?))
    }

    fn divided(&mut self, place: Place) -> PResult<(f64, f64)> {
        let (a, b) = self.pair()?;
        if b == 0.0 {
            return Err(self.fail(place, "division by zero"));
        }
        Ok((a, b))
    }

    /// A function whose domain is not all numbers.
    fn inverse(
        &mut self,
        place: Place,
        name: &str,
        defined: fn(f64) -> bool,
        f: fn(f64) -> f64,
    ) -> PResult<f64> {
        let x = self.full_float()?;
        if defined(x) {
            return Ok(f(x));
        }
        Err(self.fail(place, format!("`{name}({x})` is undefined")))
    }

    fn fold(&mut self, f: fn(f64, f64) -> f64) -> PResult<f64> {
        let mut value = self.full_float()?;
        while self.accept(Kind::Comma)? {
            value = f(value, self.full_float()?);
        }
        Ok(value)
    }

    fn bitwise(&mut self, f: fn(i64, i64) -> i64) -> PResult<f64> {
        let mut value = self.full_float()? as i64;
        while self.accept(Kind::Comma)? {
            value = f(value, self.full_float()? as i64);
        }
        Ok(value as f64)
    }

    /// `select(a, b, c)`: b if a is negative, else c; `select(a, b, c, d)`: b, c or d as a is negative, zero or positive.
    fn select(&mut self) -> PResult<f64> {
        let (a, b) = self.pair()?;
        self.comma()?;
        let c = self.full_float()?;
        let d = if self.accept(Kind::Comma)? {
            self.full_float()?
        } else {
            c
        };
        Ok(if a < 0.0 {
            b
        } else if a == 0.0 {
            c
        } else {
            d
        })
    }
}

/// The difference of the first bytes in which two strings differ (a minus b), as in C's `strcmp`; strings end with a zero byte.
fn difference(a: &str, b: &str) -> f64 {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let at = a.iter().zip(b).take_while(|(x, y)| x == y).count();
    let byte = |text: &[u8]| text.get(at).copied().map_or(0.0, f64::from);
    byte(a) - byte(b)
}
