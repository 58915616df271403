//! The analytic shapes: surfaces with a formula of their own, one file each.

mod arcs;
mod cone;
pub(crate) mod convex;
mod cuboid;
mod cylinder;
mod disc;
pub(crate) mod frame;
mod frustum;
mod lemon;
mod ovus;
mod plane;
mod quadric;
mod sphere;
mod torus;

pub use cone::Cone;
pub use cuboid::Cuboid;
pub(crate) use cuboid::Unfolding;
pub use cylinder::Cylinder;
pub use disc::Disc;
pub use lemon::Lemon;
pub use ovus::Ovus;
pub use plane::Plane;
pub use quadric::Quadric;
pub use sphere::Sphere;
pub use torus::Torus;

pub(crate) use convex::start_of;
pub(crate) use frame::turn;

use crate::GeometryError;
use strahl_math::error::{ROUNDOFF, gamma};
use strahl_math::{DVec3, Ray};

/// Checks that a point or vector has no NaN or infinite coordinate.
pub(crate) fn check_finite(what: &'static str, v: DVec3) -> Result<(), GeometryError> {
    if v.is_finite() {
        Ok(())
    } else {
        Err(GeometryError::NotFinite { what })
    }
}

/// Checks that a length is finite and greater than zero.
pub(crate) fn check_positive(what: &'static str, found: f64) -> Result<(), GeometryError> {
    check_length(what, found)?;
    if found > 0.0 {
        return Ok(());
    }
    let expected = "greater than 0";
    Err(GeometryError::OutOfRange {
        what,
        expected,
        found,
    })
}

/// Checks that a length is finite and not negative.
pub(crate) fn check_length(what: &'static str, found: f64) -> Result<(), GeometryError> {
    if !found.is_finite() {
        return Err(GeometryError::NotFinite { what });
    }
    if found >= 0.0 {
        return Ok(());
    }
    let expected = "0 or greater";
    Err(GeometryError::OutOfRange {
        what,
        expected,
        found,
    })
}

/// Checks a direction that was normalised on construction, where a vector without direction became zero.
pub(crate) fn check_direction(
    what: &'static str,
    shape: &'static str,
    unit: DVec3,
) -> Result<(), GeometryError> {
    check_finite(what, unit)?;
    if unit != DVec3::ZERO {
        return Ok(());
    }
    Err(GeometryError::Degenerate {
        what: shape,
        why: "a direction is given by a vector of length 0",
    })
}

/// The unit vector along `v`; zero if `v` is zero, NaN if it has a NaN or infinite coordinate.
///
/// Scaled first, so that tiny and huge vectors neither vanish nor overflow when squared.
pub(crate) fn unit_vector(v: DVec3) -> DVec3 {
    let largest = v.abs().max_element();
    if largest == 0.0 {
        return DVec3::ZERO;
    }
    if !v.is_finite() {
        return DVec3::NAN;
    }
    let scaled = v / largest;
    scaled / scaled.length()
}

/// The error of a point computed as `center + local` with about `operations` roundings on the way to `local`, whose coordinates
/// are at most `extent`: the position errors of all primitives are computed here.
///
/// Never zero, so that an offset by it moves the point.
pub(crate) fn point_error(position: DVec3, extent: f64, operations: u32) -> DVec3 {
    let local = gamma(operations) * extent;
    position.abs() * (2.0 * ROUNDOFF) + DVec3::splat(local + f64::MIN_POSITIVE)
}

/// The error of the parameter at which a ray crosses a plane, if the coordinates of both are rounded.
pub(crate) fn plane_t_error(ray: &Ray, t: f64, point: DVec3, normal: DVec3) -> f64 {
    let n = normal.abs();
    let magnitude = (ray.origin.abs() + point.abs() + ray.direction.abs() * t.abs()).dot(n);
    gamma(8) * magnitude / ray.direction.dot(normal).abs()
}
