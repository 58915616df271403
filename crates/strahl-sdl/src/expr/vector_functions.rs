use crate::keywords::Word;
use crate::parser::{PResult, Parser, Place};
use crate::token::Kind;
use crate::value::Vector;
use strahl_math::noise::Turbulence;
use strahl_math::{DVec3, Transform};

/// Rotates about the x axis, then y, then z, by degrees.
pub(crate) fn rotation(degrees: DVec3) -> Transform {
    let about = |axis, angle: f64| match angle {
        0.0 => Transform::IDENTITY,
        _ => Transform::rotate(axis, angle.to_radians()),
    };
    about(DVec3::X, degrees.x)
        .then(&about(DVec3::Y, degrees.y))
        .then(&about(DVec3::Z, degrees.z))
}

impl Parser<'_> {
    /// A vector function whose keyword is taken.
    pub(super) fn vector_function(&mut self, word: Word, place: Place) -> PResult<Vector> {
        self.expect(Kind::LeftParen)?;
        let value = match word {
            Word::Vcross => {
                let a = self.vector3()?;
                self.comma()?;
                let b = self.vector3()?;
                a.cross(b)
            }
            Word::Vnormalize => {
                let v = self.vector3()?;
                let length = v.length();
                if length > 0.0 {
                    v / length
                } else {
                    DVec3::ZERO
                }
            }
            Word::Vrotate => {
                let v = self.vector3()?;
                self.comma()?;
                let degrees = self.vector3()?;
                rotation(degrees).vector_to_world(v)
            }
            Word::VaxisRotate => {
                let v = self.vector3()?;
                self.comma()?;
                let axis = self.vector3()?;
                self.comma()?;
                let degrees = self.full_float()?;
                Transform::rotate(axis, degrees.to_radians()).vector_to_world(v)
            }
            Word::MinExtent | Word::MaxExtent => self.ask_extent(word)?,
            Word::Trace => self.ask_trace(place)?,
            Word::Vturbulence => {
                let lambda = self.full_float()?;
                self.comma()?;
                let omega = self.full_float()?;
                self.comma()?;
                let octaves = self.full_float()?;
                self.comma()?;
                let point = self.vector3()?;
                let turbulence = Turbulence {
                    octaves: octaves.clamp(1.0, 10.0) as u32,
                    omega,
                    lambda,
                };
                turbulence.vector(point)
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
        Ok(value.into())
    }
}
