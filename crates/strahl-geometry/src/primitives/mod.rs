//! The analytic shapes: surfaces with a formula of their own, one file each.

mod convex;
mod cuboid;
mod frame;
mod sphere;

pub use cuboid::Cuboid;
pub use sphere::Sphere;

use crate::GeometryError;
use strahl_math::{DVec3, error::ROUNDOFF};

/// Checks that a point or vector has no NaN or infinite coordinate.
fn check_finite(what: &'static str, v: DVec3) -> Result<(), GeometryError> {
    if v.is_finite() {
        Ok(())
    } else {
        Err(GeometryError::NotFinite { what })
    }
}

/// The error of a point computed as `center + local` with about `operations` roundings on the way to `local`, whose
/// coordinates are at most `extent`: the one place where the primitives' position errors are put together.
///
/// Never zero, so that an offset by it does move the point.
fn point_error(position: DVec3, extent: f64, operations: u32) -> DVec3 {
    let local = strahl_math::error::gamma(operations) * extent;
    position.abs() * (2.0 * ROUNDOFF) + DVec3::splat(local + f64::MIN_POSITIVE)
}
