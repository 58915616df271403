use super::extrusion::Extrusion;
use super::four_rays::{FourFirstHits, FourHits};
use super::outline::Outline;
use super::spans::WholeLine;
use crate::blocks::convex::{FourRays, sub};
use crate::primitive::hits_of_solid;
use crate::primitives::check_finite;
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Shape, Solid, SurfaceId, SurfacePoint,
};
use std::sync::Arc;
use strahl_math::{Aabb, DMat3, DVec3, Interval, Ray, Transform};
use strahl_simd::Isa;

/// A letter: an outline in the x-y plane, moved to its position and swept from there along the z axis.
///
/// Any number of letters share one outline. Facets: 0 the cap at the smaller z, 1 the cap at the greater one, then the walls of the
/// outline's pieces in their order. There are no texture coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Glyph {
    outline: Arc<Outline>,
    origin: DVec3,
    thickness: f64,
}

impl Glyph {
    /// A letter with the outline's origin at `origin`; with a negative thickness it extends towards smaller z.
    ///
    /// # Errors
    /// A number is not finite, or the thickness is 0.
    pub fn try_new(
        outline: Arc<Outline>,
        origin: DVec3,
        thickness: f64,
    ) -> Result<Self, GeometryError> {
        let glyph = Self {
            outline,
            origin,
            thickness,
        };
        glyph.validate().map(|()| glyph)
    }

    /// The outline.
    pub fn outline(&self) -> &Arc<Outline> {
        &self.outline
    }

    /// The position of the outline's origin.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    fn extrusion(&self) -> Extrusion<'_> {
        let (a, b) = (0.0, self.thickness);
        Extrusion {
            outline: &self.outline,
            conic: false,
            low: if a < b { a } else { b },
            high: if a < b { b } else { a },
            capped: true,
        }
    }

    fn local(&self, ray: &Ray) -> Ray {
        Ray::new(ray.origin - self.origin, ray.direction)
    }
}

/// See [`Extrusion::first_hits`].
impl FourFirstHits for Glyph {
    #[inline(always)]
    fn first_hits<I: Isa>(
        &self,
        isa: I,
        FourRays { origin, direction }: FourRays<I>,
        wanted: u32,
        min: f64,
        max: I::F64x4,
    ) -> FourHits {
        let local = FourRays {
            origin: sub(isa, origin, self.origin.to_array().map(|x| isa.splat(x))),
            direction,
        };
        self.extrusion().first_hits(isa, local, wanted, min, max)
    }
}

impl Primitive for Glyph {
    fn kind(&self) -> &'static str {
        "glyph"
    }

    fn validate(&self) -> Result<(), GeometryError> {
        check_finite("origin of the letter", self.origin)?;
        if !self.thickness.is_finite() {
            let what = "thickness of the letter";
            return Err(GeometryError::NotFinite { what });
        }
        if self.thickness != 0.0 {
            return Ok(());
        }
        Err(GeometryError::Degenerate {
            what: "text",
            why: "its thickness is 0",
        })
    }

    fn wants_box(&self) -> bool {
        true
    }

    fn bounds(&self) -> Aabb {
        let Aabb { min, max } = self.extrusion().bounds();
        Aabb::new(self.origin + min, self.origin + max)
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        self.extrusion()
            .first_hit(&self.local(ray), range, from, scratch)
    }

    fn all_hits(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Vec<PrimHit>,
    ) {
        hits_of_solid(self, ray, range, from, scratch, out);
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        let mut surface = self.extrusion().surface_at(&self.local(ray), hit);
        let rounding = self.origin.abs() * f64::EPSILON;
        surface.position += self.origin;
        surface.position_error += surface.position.abs() * f64::EPSILON + rounding;
        surface
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }

    /// A letter that is only translated stays a letter.
    fn baked(&self, map: &Transform) -> Option<Shape> {
        (map.linear() == DMat3::IDENTITY).then(|| {
            Shape::Glyph(Self {
                origin: map.point_to_world(self.origin),
                ..self.clone()
            })
        })
    }
}

impl Solid for Glyph {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        self.extrusion()
            .all_crossings(&self.local(ray), range, from, scratch, out);
    }

    fn contains(&self, point: DVec3) -> bool {
        self.extrusion().contains(point - self.origin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::OutlineBuilder;
    use strahl_math::DVec2;

    /// Somewhat like an "a" of a TrueType font: parabolas, lines and a hole.
    fn letter() -> Arc<Outline> {
        let p = |x: f64, y: f64| DVec2::new(x, y);
        let mut builder = OutlineBuilder::default();
        builder.move_to(p(0.5, 0.0));
        builder.line_to(p(0.5, 0.4));
        builder.quadratic_to(p(0.5, 0.6), p(0.3, 0.6));
        builder.quadratic_to(p(0.1, 0.6), p(0.05, 0.5));
        builder.line_to(p(0.15, 0.45));
        builder.quadratic_to(p(0.4, 0.7), p(0.4, 0.35));
        builder.quadratic_to(p(0.0, 0.4), p(0.0, 0.15));
        builder.quadratic_to(p(0.0, 0.0), p(0.2, 0.0));
        builder.move_to(p(0.25, 0.1));
        builder.quadratic_to(p(0.1, 0.1), p(0.1, 0.2));
        builder.quadratic_to(p(0.1, 0.3), p(0.4, 0.25));
        builder.line_to(p(0.4, 0.1));
        Arc::new(builder.finish().unwrap())
    }

    crate::primitive_tests!(a_letter, || Glyph::try_new(
        letter(),
        DVec3::new(0.2, -0.1, 0.3),
        0.25
    )
    .unwrap());

    #[test]
    fn letters_go_back_and_forth() {
        for thickness in [0.5, -0.5] {
            let glyph = Glyph::try_new(letter(), DVec3::X, thickness).unwrap();
            let ray = Ray::new(DVec3::new(1.45, 0.3, -2.0), DVec3::Z);
            let hit = glyph
                .closest_hit(&ray, Interval::FORWARD, None, &mut Scratch::default())
                .unwrap();
            assert_eq!(hit.t, if thickness > 0.0 { 2.0 } else { 1.5 });
            assert_eq!(glyph.surface_at(&ray, &hit).n_geom, DVec3::NEG_Z);
        }
        assert!(matches!(
            Glyph::try_new(letter(), DVec3::X, 0.0),
            Err(GeometryError::Degenerate { .. })
        ));
    }
}
