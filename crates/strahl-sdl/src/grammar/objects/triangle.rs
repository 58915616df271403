use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::{Shape, SmoothTriangle, Triangle};
use strahl_math::DVec3;

/// `triangle { corner, corner, corner ... }`
pub(super) fn triangle(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let [a, b, c] = corners(p)?;
        Ok(Triangle::try_new(a, b, c))
    })
}

/// `smooth_triangle { corner, normal, corner, normal, corner, normal ... }`
pub(super) fn smooth_triangle(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let (corners, normals) = corners_with_normals(p)?;
        let [a, b, c] = corners;
        // Interpolation needs all three normals.
        if normals.contains(&DVec3::ZERO) {
            return Ok(Triangle::try_new(a, b, c).map(Shape::from));
        }
        Ok(SmoothTriangle::try_new(corners, normals).map(Shape::from))
    })
}

pub(super) fn corners(p: &mut Parser<'_>) -> PResult<[DVec3; 3]> {
    let mut corners = [DVec3::ZERO; 3];
    for corner in &mut corners {
        *corner = p.vector3()?;
        p.comma()?;
    }
    Ok(corners)
}

pub(super) fn corners_with_normals(p: &mut Parser<'_>) -> PResult<([DVec3; 3], [DVec3; 3])> {
    let (mut corners, mut normals) = ([DVec3::ZERO; 3], [DVec3::ZERO; 3]);
    for (corner, normal) in corners.iter_mut().zip(&mut normals) {
        *corner = p.vector3()?;
        p.comma()?;
        *normal = p.vector3()?;
        p.comma()?;
    }
    Ok((corners, normals))
}
