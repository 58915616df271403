use crate::expr::rotation;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use crate::token::{Kind, Token};
use strahl_math::{DMat3, DVec3, Transform};

impl Parser<'_> {
    /// Reads a transformation, if one follows: `translate`, `rotate`, `scale`, `matrix`, `transform`.
    ///
    /// # Errors
    /// If the transformation is invalid or has no inverse.
    pub(crate) fn transformation(&mut self, token: Token) -> PResult<Option<Transform>> {
        let word = match token.word() {
            Some(
                w @ (Word::Translate | Word::Rotate | Word::Scale | Word::Matrix | Word::Transform),
            ) => w,
            _ => return Ok(None),
        };
        self.take(token)?;
        let transform = match word {
            Word::Translate => Transform::translate(self.finite_vector(word)?),
            Word::Rotate => rotation(self.finite_vector(word)?),
            Word::Scale => self.scale()?,
            Word::Matrix => self.matrix()?,
            _ => self.transform_block()?,
        };
        Ok(Some(transform))
    }

    /// The vector after `translate` or `rotate`.
    fn finite_vector(&mut self, word: Word) -> PResult<DVec3> {
        let place = self.place();
        let vector = self.vector3()?;
        if vector.is_finite() {
            return Ok(vector);
        }
        let message = format!("`{}` needs finite numbers, found {vector}", word.text());
        Err(self.fail(place, message))
    }

    /// The vector after `scale`. Factors of zero count as 1, as in POV-Ray, with a warning.
    fn scale(&mut self) -> PResult<Transform> {
        let place = self.place();
        let mut factors = self.vector3()?;
        for axis in 0..3 {
            if factors[axis] == 0.0 {
                self.warn(
                    place,
                    "a scale factor of 0 would make everything flat; 1 is used, as in POV-Ray",
                );
                factors[axis] = 1.0;
            }
        }
        Transform::try_scale(factors).map_err(|e| self.fail(place, e.to_string()))
    }

    /// `<m00, m01, ..., m32>`: images of x, y, z, and the translation.
    fn matrix(&mut self) -> PResult<Transform> {
        let place = self.place();
        self.expect(Kind::Less)?;
        let mut rows = [DVec3::ZERO; 4];
        for row in &mut rows {
            for axis in 0..3 {
                row[axis] = self.float()?;
                self.comma()?;
            }
        }
        self.expect(Kind::Greater)?;
        for axis in 0..3 {
            if rows.iter().take(3).all(|row| row[axis] == 0.0) {
                self.warn(
                    place,
                    "a matrix with a column of zeros would make everything flat; 1 is used on its diagonal",
                );
                rows[axis][axis] = 1.0;
            }
        }
        let [x, y, z, translation] = rows;
        Transform::try_new(DMat3::from_cols(x, y, z), translation)
            .map_err(|e| self.fail(place, e.to_string()))
    }

    /// `{ ... }` or a name after `transform`; `inverse`, wherever it stands, inverts all of the braces once, as in POV-Ray (measured).
    pub(crate) fn transform_block(&mut self) -> PResult<Transform> {
        if let Some(named) = self.accept_transform()? {
            return Ok(named);
        }
        let (mut all, mut is_inverse) = (Transform::IDENTITY, false);
        self.braces(|p| {
            p.items("`transform`", |p, token| {
                if let Some(next) = p.transformation(token)? {
                    all = all.then(&next);
                } else if token.is(Word::Inverse) {
                    p.take(token)?;
                    is_inverse = true;
                } else if let Some(named) = p.accept_transform()? {
                    all = all.then(&named);
                } else {
                    return Err(p.unexpected(token, "a transformation"));
                }
                Ok(())
            })
        })?;
        Ok(if is_inverse { all.inverted() } else { all })
    }

    fn accept_transform(&mut self) -> PResult<Option<Transform>> {
        let named = self.accept_thing(|thing| match thing {
            super::Thing::Transform(t) => Some(t),
            _ => None,
        })?;
        Ok(named.map(|t| *t))
    }
}
