use crate::grammar::Entity;
use crate::keywords::Word;
use crate::parser::{PResult, Parser};
use strahl_geometry::BicubicPatch;
use strahl_math::{DVec2, DVec3};

/// `bicubic_patch { type t [flatness f] [u_steps n] [v_steps n] [uv_vectors four corners] sixteen points ... }`
///
/// The surface is met as it is, so how finely POV-Ray would divide it is read and ignored. A point with four components has a
/// weight, which makes the patch rational; this is an extension. Version 1 of the language had numbers without words instead:
/// `0 u_steps v_steps`, `1 u_steps v_steps` or `2 flatness u_steps v_steps`.
pub(super) fn bicubic_patch(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let corners = p.patch_items()?;
        let (mut points, mut weights) = ([[DVec3::ZERO; 4]; 4], [[1.0; 4]; 4]);
        for (point, weight) in points
            .as_flattened_mut()
            .iter_mut()
            .zip(weights.as_flattened_mut())
        {
            let place = p.place();
            let value = p.expression()?;
            let count = value.len();
            let point_of = if count == 1 { value.promoted(3) } else { value };
            let [x, y, z, w, ..] = point_of.components();
            if count > 4 {
                let message = format!(
                    "a control point has three components, or four with a weight, found {count}"
                );
                return Err(p.fail(place, message));
            }
            if count == 4 {
                *weight = w;
            }
            *point = DVec3::new(x, y, z);
            p.comma()?;
        }
        let patch = BicubicPatch::try_rational(points, weights);
        Ok(match corners {
            Some(corners) => patch.and_then(|patch| patch.with_uv(corners)),
            None => patch,
        })
    })
}

impl Parser<'_> {
    /// The items before the control points; returns the texture coordinates of the corners.
    fn patch_items(&mut self) -> PResult<Option<[DVec2; 4]>> {
        let (mut corners, mut has_type) = (None, false);
        loop {
            let token = self.peek()?;
            match token.word() {
                Some(Word::Type) => {
                    self.take(token)?;
                    self.float()?;
                    has_type = true;
                }
                Some(Word::Flatness | Word::USteps | Word::VSteps | Word::Accuracy) => {
                    self.take(token)?;
                    self.float()?;
                }
                Some(Word::UvVectors) => {
                    self.take(token)?;
                    let mut four = [DVec2::ZERO; 4];
                    for corner in &mut four {
                        *corner = DVec2::from_array(self.vector2()?);
                        self.comma()?;
                    }
                    corners = Some(four);
                }
                _ if has_type => return Ok(corners),
                _ => {
                    let place = self.place();
                    let value = self.expression()?;
                    if value.len() != 1 {
                        let message = "a `bicubic_patch` begins with its `type`, before its points";
                        return Err(self.fail(place, message));
                    }
                    let kind = value.components()[0];
                    self.comma()?;
                    for _ in 0..if kind == 2.0 { 3 } else { 2 } {
                        self.float()?;
                        self.comma()?;
                    }
                    has_type = true;
                }
            }
            self.comma()?;
        }
    }
}
