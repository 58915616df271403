//! Julia sets in four dimensions.

mod complex;
mod orbit;
mod power;
mod real;
#[cfg(test)]
mod tests;

use super::orbit_search;
use super::orbit_set::{BALL, BallSearch, LINE_BATCH, OrbitSet, Place, Places};
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Solid, SurfaceId, SurfacePoint,
};
pub use complex::HypercomplexFunction;
use orbit::{Four, Rule, Slice, norm2};
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec3, Interval, Ray};

/// The levels of the octree. Estimates of the distance are good, and eight places are looked at together, so that smaller cells take longer
/// than they save.
const LEVELS: u32 = 2;

/// A function of quaternions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuaternionFunction {
    /// `h * h`
    Square,
    /// `h * h * h`
    Cube,
}

/// The algebra and the function that is iterated in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JuliaAlgebra {
    /// Hamilton's quaternions.
    Quaternion(QuaternionFunction),
    /// Hypercomplex numbers, whose multiplication is commutative.
    Hypercomplex(HypercomplexFunction),
}

/// Options of the slice and of the search; the defaults are POV-Ray's.
#[derive(Clone, Debug, PartialEq)]
pub struct JuliaOptions {
    /// How many points of an orbit, including the starting point, have to stay near the origin.
    pub max_iteration: u32,
    /// Features smaller than a fiftieth of the reciprocal of this may be missed.
    pub precision: f64,
    /// The normal of the three-dimensional slice, of any length; its fourth component must not be zero.
    pub slice: [f64; 4],
    /// The distance of the slice from the origin.
    pub distance: f64,
}

impl Default for JuliaOptions {
    fn default() -> Self {
        Self {
            max_iteration: 20,
            precision: 20.0,
            slice: [0.0, 0.0, 0.0, 1.0],
            distance: 0.0,
        }
    }
}

/// A three-dimensional slice of a Julia set: the points `h` whose orbit under `f(h) + parameter` stays near the origin.
///
/// Near means within the radius `1 + |parameter|` for quaternions and 4 for hypercomplex numbers, for the first `max_iteration` points of the orbit;
/// this is the set that POV-Ray 3.7 shows (measured). It is a solid with a smooth surface. A point of space has the
/// first three components of the number, the slice gives the fourth.
///
/// Of squares and cubes only a smaller ball is searched: a number that is too long has a next point beyond the bail-out radius.
/// Rays march by an estimate of the distance, from the first derivative of the orbit's end (by half of it where it may be too long); crossings are then refined to
/// the last digit. An octree, whose cells are examined when a ray first meets them, stores where the surface may be at all: of squares
/// and cubes it is proven where it is not. Shading takes the normal POV-Ray has: that of the set of one point
/// more, in the three directions of space as if they were not tilted by the slice. There are no texture coordinates. Facet 0.
///
/// J. C. Hart, D. J. Sandin, L. H. Kauffman, "Ray tracing deterministic 3-D fractals", SIGGRAPH 1989.
#[derive(Clone, Debug)]
pub struct Julia {
    rule: Rule,
    slice: Slice,
    search: BallSearch,
    /// The largest growth of a distance in space that the slice causes.
    tilt: f64,
}

impl Julia {
    /// The Julia set of a parameter.
    ///
    /// # Errors
    /// A number is not finite, the slice has no fourth component, or no points are asked for.
    pub fn try_new(
        parameter: [f64; 4],
        algebra: JuliaAlgebra,
        options: &JuliaOptions,
    ) -> Result<Self, GeometryError> {
        let finite = |what, numbers: &[f64]| {
            let all = numbers.iter().all(|x| x.is_finite());
            if all {
                Ok(())
            } else {
                Err(GeometryError::NotFinite { what })
            }
        };
        finite("parameter of the Julia set", &parameter)?;
        finite("slice of the Julia set", &options.slice)?;
        finite("distance of the slice", &[options.distance])?;
        if let JuliaAlgebra::Hypercomplex(HypercomplexFunction::Power(re, im)) = algebra {
            finite("exponent of the Julia set", &[re, im])?;
        }
        let [nx, ny, nz, nw] = options.slice;
        if nw == 0.0 {
            return Err(GeometryError::Degenerate {
                what: "Julia set",
                why: "the fourth component of the slice's normal is 0",
            });
        }
        if options.max_iteration == 0 {
            return Err(GeometryError::OutOfRange {
                what: "max_iteration of the Julia set",
                expected: "1 or greater",
                found: 0.0,
            });
        }
        let size = norm2(parameter).sqrt();
        let exit = match algebra {
            JuliaAlgebra::Quaternion(_) => 1.0 + size,
            JuliaAlgebra::Hypercomplex(_) => 4.0,
        };
        let length = norm2(options.slice).sqrt();
        let rule = Rule {
            algebra,
            parameter,
            points: options.max_iteration,
            exit,
        };
        Ok(Self {
            rule,
            slice: Slice {
                offset: options.distance * length / nw,
                factors: -DVec3::new(nx, ny, nz) / nw,
            },
            search: BallSearch::new(exit, rule.reach(), options.precision, LEVELS),
            tilt: norm2([1.0, nx / nw, ny / nw, nz / nw]).sqrt(),
        })
    }

    /// The number that a point stands for.
    fn number(&self, p: DVec3) -> Four {
        self.slice.number(p.to_array())
    }
}

impl OrbitSet for Julia {
    fn search(&self) -> &BallSearch {
        &self.search
    }

    fn value(&self, p: DVec3) -> f64 {
        self.rule.value(self.number(p))
    }

    fn place(&self, p: DVec3) -> Place {
        self.rule.place(self.number(p))
    }

    #[inline]
    fn store_places(
        &self,
        (origin, direction): (DVec3, DVec3),
        s: &[f64; LINE_BATCH],
        out: &mut Places,
    ) -> bool {
        let line = [origin.to_array(), direction.to_array()];
        self.rule.store_places(&self.slice, line, s, out)
    }

    fn is_decided(&self, center: DVec3, radius: f64) -> bool {
        // A little more, for the rounding of points on rays.
        let radius = radius * self.tilt * (1.0 + 1e-9);
        self.rule.is_decided(self.number(center), radius)
    }

    /// The gradient of the value in space.
    fn gradient(&self, p: DVec3) -> DVec3 {
        let [x, y, z, w] = self.rule.gradient(self.number(p), 0);
        DVec3::new(x, y, z) + self.slice.factors * w
    }

    fn rounding(&self) -> f64 {
        gamma(16 * self.rule.points.min(1 << 16) + 16)
    }

    /// The rounding error of the value: the error of the first points, propagated, and those of all further ones.
    fn noise(&self, p: DVec3) -> f64 {
        self.rounding() * (self.rule.slope(self.number(p)) * self.search.radius + 1.0)
    }

    /// The distance between numbers.
    fn speed(&self, direction: DVec3) -> f64 {
        let fourth = self.slice.factors.dot(direction);
        norm2([direction.x, direction.y, direction.z, fourth]).sqrt()
    }
}

impl Primitive for Julia {
    fn kind(&self) -> &'static str {
        "julia_fractal"
    }

    /// [`Julia::try_new`] has validated everything.
    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn wants_box(&self) -> bool {
        true
    }

    fn bounds(&self) -> Aabb {
        self.search.bounds()
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        orbit_search::closest_hit(self, ray, range, from)
    }

    fn any_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> bool {
        orbit_search::any_hit(self, ray, range, from)
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
        let point = orbit_search::surface_at(self, ray, hit);
        if hit.surface == BALL {
            return point;
        }
        // POV-Ray's normal is that of the set with one point more, before it is cut (measured).
        let [x, y, z, _] = self.rule.gradient(self.number(point.position), 1);
        let shading = DVec3::new(x, y, z).try_normalize();
        SurfacePoint {
            n_shade: shading
                .filter(|n| n.dot(point.n_geom) > 0.0)
                .unwrap_or(point.n_geom),
            ..point
        }
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }
}

impl Solid for Julia {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        orbit_search::crossings(self, ray, range, from, out);
    }

    fn contains(&self, point: DVec3) -> bool {
        orbit_search::contains(self, point)
    }
}
