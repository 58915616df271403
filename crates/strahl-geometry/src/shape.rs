use crate::*;
use std::sync::Arc;
use strahl_math::{Aabb, DVec2, Interval, Ray, Transform};

/// Makes the enum of all shapes from the table below: the variants, the dispatch without virtual calls, the conversions.
macro_rules! shapes {
    ($($(#[$doc:meta])* $variant:ident($($type:tt)+),)+) => {
        /// Any shape: what scenes store.
        ///
        /// It is itself a [`Primitive`] and delegates to the shape within.
        #[derive(Clone, Debug)]
        #[non_exhaustive]
        pub enum Shape {
            $($(#[$doc])* $variant($($type)+),)+
        }

        impl Primitive for Shape {
            fn kind(&self) -> &'static str {
                match self { $(Self::$variant(shape) => shape.kind(),)+ }
            }

            fn validate(&self) -> Result<(), GeometryError> {
                match self { $(Self::$variant(shape) => shape.validate(),)+ }
            }

            fn bounds(&self) -> Aabb {
                match self { $(Self::$variant(shape) => shape.bounds(),)+ }
            }

            fn elements(&self) -> u32 {
                match self { $(Self::$variant(shape) => shape.elements(),)+ }
            }

            #[inline]
            fn closest_hit(
                &self,
                ray: &Ray,
                range: Interval,
                from: Option<SurfaceId>,
                scratch: &mut Scratch,
            ) -> Option<PrimHit> {
                match self { $(Self::$variant(shape) => shape.closest_hit(ray, range, from, scratch),)+ }
            }

            #[inline]
            fn any_hit(
                &self,
                ray: &Ray,
                range: Interval,
                from: Option<SurfaceId>,
                scratch: &mut Scratch,
            ) -> bool {
                match self { $(Self::$variant(shape) => shape.any_hit(ray, range, from, scratch),)+ }
            }

            fn wants_box(&self) -> bool {
                match self { $(Self::$variant(shape) => shape.wants_box(),)+ }
            }

            fn all_hits(
                &self,
                ray: &Ray,
                range: Interval,
                from: Option<SurfaceId>,
                scratch: &mut Scratch,
                out: &mut Vec<PrimHit>,
            ) {
                match self { $(Self::$variant(shape) => shape.all_hits(ray, range, from, scratch, out),)+ }
            }

            fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
                match self { $(Self::$variant(shape) => shape.surface_at(ray, hit),)+ }
            }

            fn store_bare_surface(&self, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
                // Each in a function of its own: all in one would save and restore the registers that the largest needs.
                match self { $(Self::$variant(shape) => store_bare(shape, ray, hit, out),)+ }
            }

            fn texture_uv(&self, hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
                match self { $(Self::$variant(shape) => shape.texture_uv(hit, uv),)+ }
            }

            fn as_solid(&self) -> Option<&dyn Solid> {
                match self { $(Self::$variant(shape) => shape.as_solid(),)+ }
            }

            fn baked(&self, map: &Transform) -> Option<Shape> {
                match self { $(Self::$variant(shape) => shape.baked(map),)+ }
            }
        }

        $(conversions!($variant $($type)+);)+
    };
}

/// [`Primitive::store_bare_surface`] out of line.
#[inline(never)]
fn store_bare<P: Primitive>(shape: &P, ray: &Ray, hit: &PrimHit, out: &mut SurfacePoint) {
    shape.store_bare_surface(ray, hit, out);
}

/// The conversions from a shape to its variant; those in an `Arc` are also put into it.
macro_rules! conversions {
    ($variant:ident Arc<$type:ident>) => {
        impl From<$type> for Shape {
            fn from(shape: $type) -> Self {
                Self::$variant(Arc::new(shape))
            }
        }

        impl From<Arc<$type>> for Shape {
            fn from(shape: Arc<$type>) -> Self {
                Self::$variant(shape)
            }
        }
    };
    ($variant:ident $type:ty) => {
        impl From<$type> for Shape {
            fn from(shape: $type) -> Self {
                Self::$variant(shape)
            }
        }
    };
}

// The table of shapes: a new one is one line here. Large shapes are held in an `Arc`, so that the enum stays small.
shapes! {
    /// A sphere.
    Sphere(Sphere),
    /// An infinite plane.
    Plane(Plane),
    /// A box with faces along the axes.
    Cuboid(Cuboid),
    /// A flat round disc, perhaps with a hole.
    Disc(Disc),
    /// A cylinder, closed or open.
    Cylinder(Cylinder),
    /// A cone or truncated cone, closed or open.
    Cone(Cone),
    /// A torus.
    Torus(Torus),
    /// An egg.
    Ovus(Arc<Ovus>),
    /// An arc turned about an axis, with caps.
    Lemon(Arc<Lemon>),
    /// A surface of degree 2.
    Quadric(Arc<Quadric>),
    /// A plane figure swept along an axis.
    Prism(Arc<Prism>),
    /// A letter.
    Glyph(Glyph),
    /// A curve turned about an axis.
    Lathe(Arc<Lathe>),
    /// A surface of revolution whose radius is a function of the height.
    Sor(Arc<Sor>),
    /// The volume that a moving sphere sweeps.
    SphereSweep(Arc<SphereSweep>),
    /// A surface of a degree up to 35.
    Polynomial(Arc<Polynomial>),
    /// Balls and capsules that merge smoothly.
    Blob(Arc<Blob>),
    /// A superquadric ellipsoid.
    Superellipsoid(Superellipsoid),
    /// A flat triangle.
    Triangle(Triangle),
    /// A triangle with a normal at each corner.
    SmoothTriangle(Arc<SmoothTriangle>),
    /// A flat polygon, possibly with holes.
    Polygon(Polygon),
    /// Triangles that share their vertices.
    TriangleMesh(Arc<TriangleMesh>),
    /// A height field.
    HeightField(Arc<HeightField>),
    /// A surface where a function has a given value.
    Isosurface(Arc<Isosurface>),
    /// A surface where the interpolation of samples has a given value.
    GridIsosurface(Arc<GridIsosurface>),
    /// A surface whose points are functions of two parameters.
    Parametric(Arc<Parametric>),
    /// A bicubic Bezier patch.
    BicubicPatch(Arc<BicubicPatch>),
    /// A NURBS surface, trimmed or whole.
    Nurbs(Arc<Nurbs>),
    /// The volume within trimmed NURBS surfaces.
    NurbsBrep(Arc<NurbsBrep>),
    /// A subdivision surface.
    Subdivision(Arc<Subdivision>),
    /// A slice of a Julia set in four dimensions.
    Julia(Arc<Julia>),
    /// A Mandelbulb.
    Mandelbulb(Arc<Mandelbulb>),
    /// Menger's sponge.
    Menger(Arc<Menger>),
    /// A fractal terrain.
    Terrain(Arc<Terrain>),
    /// A tree of solids, combined.
    Csg(Arc<Csg>),
    /// A closed mesh with an inside.
    Brep(Arc<Brep>),
    /// A shape that is seen through its bounds only.
    Bounded(Arc<Bounded>),
    /// A primitive from outside of this crate.
    Custom(Arc<dyn Primitive>),
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_math::DVec3;

    #[test]
    fn a_shape_answers_like_the_primitive_within() {
        let sphere = Sphere::new(DVec3::ZERO, 2.0);
        let custom: Arc<dyn Primitive> = Arc::new(sphere.clone());
        let ray = Ray::new(DVec3::new(0.0, 0.5, -9.0), DVec3::Z);
        let scratch = &mut Scratch::default();
        let expected = sphere.closest_hit(&ray, Interval::FORWARD, None, scratch);
        assert!(expected.is_some());
        for shape in [Shape::from(sphere), Shape::from(custom)] {
            assert_eq!(shape.kind(), "sphere");
            assert_eq!(
                shape.closest_hit(&ray, Interval::FORWARD, None, scratch),
                expected
            );
            assert!(shape.any_hit(&ray, Interval::FORWARD, None, scratch));
            assert!(
                shape.as_solid().is_some() && shape.validate().is_ok() && shape.elements() == 1
            );
        }
    }

    #[test]
    fn shapes_stay_small() {
        assert!(
            size_of::<Shape>() <= 96,
            "{}: put the largest shape into an Arc",
            size_of::<Shape>()
        );
    }
}
