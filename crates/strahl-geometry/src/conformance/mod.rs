//! Tests that every primitive must pass.
//!
//! ```
//! # use strahl_geometry::{primitive_tests, Sphere};
//! # use strahl_math::DVec3;
//! primitive_tests!(unit_sphere, || Sphere::new(DVec3::ZERO, 1.0));
//! # fn main() {}
//! ```
//!
//! makes a module `unit_sphere` with one test per promise of [`Primitive`] and [`Solid`]. The module is part of the library, so
//! that primitives outside of this crate can be tested against the same contract. Its functions panic if a promise is broken,
//! and name the ray that shows it.
//!
//! Rays come from a small deterministic generator, so failures repeat. Shapes without bounds are tested within 3 units of the
//! origin, so make them about one unit large and near it.
//!
//! [`Solid`]: crate::Solid

mod checks;
mod crossing_checks;
mod placed;
mod rays;

use crate::Primitive;
use std::sync::Arc;
use strahl_math::{Aabb, DVec3, Ray, Transform};

pub use rays::Random;

/// The rounding error allowed, relative to the largest magnitude involved: about a thousand times the unit of f64.
const TOLERANCE: f64 = 1.0 / (1u64 << 42) as f64;

/// A primitive under test: each method checks one promise and panics if it is broken.
#[derive(Clone, Debug)]
pub struct Subject {
    shape: Arc<dyn Primitive>,
    /// The region in which the surface is searched.
    region: Aabb,
    /// The largest extent of that region.
    size: f64,
    /// Its smallest extent, unless it is flat.
    thickness: f64,
    /// How many rays each check shoots.
    rays: usize,
}

impl Subject {
    /// A primitive as it is.
    pub fn new(shape: impl Primitive + 'static) -> Self {
        let limit =
            |v: DVec3, infinite: f64| DVec3::select(v.is_finite_mask(), v, DVec3::splat(infinite));
        let bounds = shape.bounds();
        let region = Aabb::new(limit(bounds.min, -3.0), limit(bounds.max, 3.0));
        Self::with_region(Arc::new(shape), region, 1500)
    }

    fn with_region(shape: Arc<dyn Primitive>, region: Aabb, rays: usize) -> Self {
        let extent = region.size();
        let size = extent.max_element();
        let thickness = extent
            .to_array()
            .into_iter()
            .filter(|e| *e > 1e-6 * size)
            .fold(size, f64::min);
        Self {
            shape,
            region,
            size,
            thickness,
            rays,
        }
    }

    /// The same primitive seen through a map, with fewer rays.
    fn placed(&self, map: Transform) -> Self {
        let region = map.bounds_to_world(&self.region);
        let placed = placed::Placed::new(Arc::clone(&self.shape), map);
        Self::with_region(Arc::new(placed), region, 150)
    }

    /// A bound of the rounding error of a point on a ray at `t`.
    fn tolerance(&self, ray: &Ray, t: f64) -> f64 {
        let reach = ray.origin.length() + (ray.direction * t).length() + self.region.max_abs();
        TOLERANCE * reach
    }
}

/// Makes a module of tests, one per promise of the primitive's contract: `primitive_tests!(name, || shape)`.
#[macro_export]
macro_rules! primitive_tests {
    ($name:ident, $make:expr) => {
        mod $name {
            #[allow(unused_imports, reason = "whatever the expression needs")]
            use super::*;

            fn subject() -> $crate::conformance::Subject {
                $crate::conformance::Subject::new($make())
            }

            $crate::primitive_tests!(@tests
                is_valid
                hits_lie_on_the_surface
                normals_agree_with_neighbouring_hits
                rays_leave_the_surface
                hits_are_inside_the_bounds
                any_hit_agrees_with_closest_hit
                all_hits_are_closest_hits_one_behind_the_other
                ranges_cut_exactly
                t_scales_with_the_direction
                crossings_alternate
                maps_change_nothing
                all_scales_and_places
                hostile_input_is_harmless
            );
        }
    };
    (@tests $($test:ident)+) => {
        $(#[test]
        fn $test() {
            subject().$test();
        })+
    };
}
