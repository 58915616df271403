use crate::grammar::Entity;
use crate::parser::{PResult, Parser};
use strahl_geometry::{GeometryError, Shape, SmoothTriangle, Triangle};
use strahl_math::DVec3;

/// `triangle { corner, corner, corner ... }`
pub(super) fn triangle(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let [a, b, c] = corners(p)?;
        // POV-Ray's front is the other side (measured).
        Ok(Triangle::try_new(a, c, b))
    })
}

/// Whether the normals stand on one side of the plane through the corners. POV-Ray shows nothing of other smooth triangles, but for
/// those of meshes (measured).
fn on_one_side([a, b, c]: [DVec3; 3], normals: [DVec3; 3]) -> bool {
    let side = (b - a).cross(c - a);
    normals.iter().all(|n| side.dot(*n) > 0.0) || normals.iter().all(|n| side.dot(*n) < 0.0)
}

/// `smooth_triangle { corner, normal, corner, normal, corner, normal ... }`
pub(super) fn smooth_triangle(p: &mut Parser<'_>) -> PResult<Entity> {
    p.shape(|p| {
        let (corners, normals) = corners_with_normals(p)?;
        let [a, b, c] = corners;
        // POV-Ray interpolates between unit vectors (measured).
        let normals = normals.map(|n| n.try_normalize().unwrap_or(n));
        // Interpolation needs all three normals.
        if normals.contains(&DVec3::ZERO) {
            return Ok(Triangle::try_new(a, c, b).map(Shape::from));
        }
        if !on_one_side(corners, normals) {
            return Ok(Err(GeometryError::Degenerate {
                what: "smooth triangle",
                why: "its normals stand on both sides of it, or along it; within a `mesh` it would be seen",
            }));
        }
        // The front is the side of the normals (measured).
        if (b - a).cross(c - a).dot(normals[0]) < 0.0 {
            return Ok(
                SmoothTriangle::try_new([a, c, b], [normals[0], normals[2], normals[1]])
                    .map(Shape::from),
            );
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
