//! The surfaces of revolution as primitives, each given by a meridian.

use super::revolution::Revolution;
use super::spans::WholeLine;
use super::{Lathe, Sor};
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Solid, SurfaceId, SurfacePoint,
};
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray};

/// Makes a shape with a field `meridian` a primitive.
macro_rules! turned_about_the_axis {
    ($shape:ident, $kind:literal, $what:literal, degenerate if $why:literal) => {
        impl Primitive for $shape {
            fn kind(&self) -> &'static str {
                $kind
            }

            fn validate(&self) -> Result<(), GeometryError> {
                if self.meridian.arcs.iter().any(|arc| arc.visible) {
                    return Ok(());
                }
                Err(GeometryError::Degenerate {
                    what: $what,
                    why: $why,
                })
            }

            fn wants_box(&self) -> bool {
                true
            }

            fn bounds(&self) -> Aabb {
                Revolution(&self.meridian).bounds()
            }

            fn closest_hit(
                &self,
                ray: &Ray,
                range: Interval,
                from: Option<SurfaceId>,
                scratch: &mut Scratch,
            ) -> Option<PrimHit> {
                Revolution(&self.meridian).first_hit(ray, range, from, scratch)
            }

            fn any_hit(
                &self,
                ray: &Ray,
                range: Interval,
                from: Option<SurfaceId>,
                scratch: &mut Scratch,
            ) -> bool {
                Revolution(&self.meridian).any_hit(ray, range, from, scratch)
            }

            fn all_hits(
                &self,
                ray: &Ray,
                range: Interval,
                from: Option<SurfaceId>,
                scratch: &mut Scratch,
                out: &mut Vec<PrimHit>,
            ) {
                crate::primitive::hits_of_solid(self, ray, range, from, scratch, out);
            }

            fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
                Revolution(&self.meridian).surface_at(ray, hit)
            }

            fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
                Revolution(&self.meridian).store_bare_surface(ray, hit, out);
            }

            fn texture_uv(&self, _hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
                Some(uv)
            }

            fn as_solid(&self) -> Option<&dyn Solid> {
                Some(self)
            }
        }

        impl Solid for $shape {
            fn crossings(
                &self,
                ray: &Ray,
                range: Interval,
                from: Option<SurfaceId>,
                scratch: &mut Scratch,
                out: &mut Crossings,
            ) {
                Revolution(&self.meridian).all_crossings(ray, range, from, scratch, out);
            }

            fn contains(&self, point: DVec3) -> bool {
                Revolution(&self.meridian).contains(point)
            }
        }
    };
}

turned_about_the_axis!(
    Lathe,
    "lathe",
    "lathe",
    degenerate if "its curve has too few points, is a point, or runs along the axis"
);
turned_about_the_axis!(
    Sor,
    "sor",
    "surface of revolution",
    degenerate if "it has fewer than four points, or all radii are 0"
);
