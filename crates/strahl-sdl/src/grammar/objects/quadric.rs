use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::Quadric;

/// `quadric { <A, B, C>, <D, E, F>, <G, H, I>, J ... }`
pub(super) fn quadric(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let mut coefficients = [0.0; 10];
        for triple in coefficients.chunks_exact_mut(3) {
            triple.copy_from_slice(&p.vector3()?.to_array());
            p.comma()?;
        }
        coefficients[9] = p.float()?;
        Ok(Quadric::try_new(coefficients))
    })
}
