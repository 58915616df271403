//! The Mandelbulb, and its Julia sets.

mod power;
#[cfg(test)]
mod tests;

use super::orbit_search;
use super::orbit_set::{BallSearch, OrbitSet, Place};
use crate::{
    Crossings, GeometryError, PrimHit, Primitive, Scratch, Solid, SurfaceId, SurfacePoint,
};
use power::{growth, power, power_with};
use strahl_math::det;
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec3, Interval, Ray};

/// The levels of the octree.
const LEVELS: u32 = 6;

/// The Mandelbulb: the points `c` whose orbit `0 -> c -> cⁿ + c -> ...` stays near the origin for a number of iterations; or, with a
/// constant parameter, a Julia set of the same power, the points `p` whose orbit `p -> pⁿ + c -> ...` does.
///
/// The power of a point multiplies its length and its angles from the z axis and around it. Near means within the
/// radius `(1 + m)^(1/(n-1))`, where `m` is 1, or the length of the constant parameter: an orbit that gets farther away never comes back,
/// so these solids shrink towards the whole set with every iteration. Their surface is that where the end of the orbit
/// has this distance: it has no thickness and no steps, at any size of the picture.
///
/// Rays march by distances that are proven: the image of a ball is in a ball of known radius, so if all balls of an orbit stay near, or one of
/// them is far away, the first one has no surface. Where the proof gives less than the least step, `radius / (50 precision)`, rays go by that
/// step and look for a change of side; so parts thinner than that may be missed. Crossings are refined to the last digit. Normals are the
/// gradient of the end's distance. Facet 0; there are no texture coordinates.
///
/// D. White and P. Nylander, 2009; for the bounds see `power`. The search is that of [`Julia`](crate::Julia).
#[derive(Clone, Debug)]
pub struct Mandelbulb {
    power: u32,
    /// The constant that is added, for a Julia set.
    parameter: Option<DVec3>,
    /// How often the power is taken.
    iterations: u32,
    search: BallSearch,
}

/// Orbits are followed up to so many bail-out radii, where it is easier to see how far away the surface is.
const FAR: f64 = 4.0;

/// More than the relative rounding errors of an iteration.
const ROUNDING: f64 = 1e-12;

/// An estimated distance is halved so often until it is proven.
const TRIALS: u32 = 4;

impl Mandelbulb {
    /// The greatest power.
    pub const MAX_POWER: u32 = 16;

    /// The set of a power; features smaller than a fiftieth of the reciprocal of `precision` may be missed.
    ///
    /// # Errors
    /// The power is not from 2 to [`Mandelbulb::MAX_POWER`], there are no iterations, or the parameter is not finite.
    pub fn try_new(
        power: u32,
        parameter: Option<DVec3>,
        iterations: u32,
        precision: f64,
    ) -> Result<Self, GeometryError> {
        if !(2..=Self::MAX_POWER).contains(&power) {
            return Err(GeometryError::OutOfRange {
                what: "power of the mandelbulb",
                expected: "from 2 to 16",
                found: f64::from(power),
            });
        }
        if iterations == 0 {
            return Err(GeometryError::OutOfRange {
                what: "max_iteration of the mandelbulb",
                expected: "1 or greater",
                found: 0.0,
            });
        }
        let size = parameter.map_or(1.0, DVec3::length);
        if !size.is_finite() {
            return Err(GeometryError::NotFinite {
                what: "parameter of the mandelbulb",
            });
        }
        let radius = det::pow(1.0 + size, 1.0 / f64::from(power - 1));
        Ok(Self {
            power,
            parameter,
            iterations,
            search: BallSearch::new(radius, radius, precision, LEVELS),
        })
    }

    /// What is added in every iteration of the orbit of a point.
    fn added(&self, start: DVec3) -> DVec3 {
        self.parameter.unwrap_or(start)
    }

    /// The [`Place::value`] of the end of an orbit.
    fn value_of(&self, end: DVec3) -> f64 {
        let radius = self.search.radius;
        let value = 0.5 * (end.length_squared() / (radius * radius) - 1.0);
        if value.is_nan() { f64::INFINITY } else { value }
    }

    /// The value of a point, the point of its orbit at which a distance can be estimated, and a bound (to first order) of its derivative.
    fn follow(&self, start: DVec3) -> (f64, f64, f64) {
        let limit = self.search.radius * self.search.radius;
        let added = self.added(start);
        let drift = if self.parameter.is_some() { 0.0 } else { 1.0 };
        let (mut h, mut slope) = (start, 1.0);
        let mut end = h;
        let mut is_near = h.length_squared() <= limit;
        for _ in 0..self.iterations {
            if !(h.length_squared() <= FAR * FAR * limit) {
                break;
            }
            slope = slope * growth(h, self.power, 0.0) + drift;
            h = power(h, self.power) + added;
            if is_near {
                end = h;
                is_near = h.length_squared() <= limit;
            }
        }
        (self.value_of(end), h.length(), slope)
    }
}

impl OrbitSet for Mandelbulb {
    fn search(&self) -> &BallSearch {
        &self.search
    }

    /// The orbit ends with the first point beyond the bail-out radius, or the last one.
    fn value(&self, start: DVec3) -> f64 {
        let limit = self.search.radius * self.search.radius;
        let added = self.added(start);
        let mut h = start;
        for _ in 0..self.iterations {
            // NaN counts as escaped.
            if !(h.length_squared() <= limit) {
                break;
            }
            h = power(h, self.power) + added;
        }
        self.value_of(h)
    }

    fn place(&self, p: DVec3) -> Place {
        let (value, r, slope) = self.follow(p);
        let mut reach = (r - self.search.radius).abs() / slope;
        for _ in 0..TRIALS {
            if !(reach > self.search.shortest) {
                break;
            }
            if self.is_decided(p, reach) {
                return Place { value, reach };
            }
            reach *= 0.5;
        }
        Place { value, reach: 0.0 }
    }

    fn is_decided(&self, center: DVec3, radius: f64) -> bool {
        let exit = self.search.radius;
        // A little more, for the rounding of points on rays.
        let first = radius * (1.0 + 1e-9);
        let drift = if self.parameter.is_some() { 0.0 } else { first };
        let added = self.added(center);
        let (mut h, mut ball) = (center, first);
        for n in 0..=self.iterations {
            let r = h.length();
            if r - ball > exit {
                return true;
            }
            if !(r + ball < exit) {
                // Some points may be out; all of them are only if they go farther together.
                return self.all_escape(h, ball, added, (n, drift));
            }
            if n == self.iterations {
                break;
            }
            (h, ball) = self.next(h, ball, added, drift);
        }
        true
    }

    fn gradient(&self, start: DVec3) -> DVec3 {
        let limit = self.search.radius * self.search.radius;
        let added = self.added(start);
        let drift = if self.parameter.is_some() { 0.0 } else { 1.0 };
        let (mut h, mut rows) = (start, DVec3::AXES);
        for _ in 0..self.iterations {
            if !(h.length_squared() <= limit) {
                break;
            }
            let (value, derivatives) = power_with(h, self.power, rows);
            h = value + added;
            let axes = DVec3::AXES;
            rows = [0, 1, 2].map(|k| derivatives[k] + axes[k] * drift);
        }
        DVec3::new(h.dot(rows[0]), h.dot(rows[1]), h.dot(rows[2])) / limit
    }

    fn rounding(&self) -> f64 {
        gamma(64 * self.iterations.min(1 << 16) + 64)
    }

    /// The error of the first points, propagated, and those of all further ones.
    fn noise(&self, p: DVec3) -> f64 {
        let (_, r, slope) = self.follow(p);
        let radius = self.search.radius;
        let end = if r < radius { r } else { radius };
        self.rounding() * (slope * end / radius + 1.0)
    }
}

impl Mandelbulb {
    /// The ball that the next points of a ball are in.
    #[inline(always)]
    fn next(&self, h: DVec3, ball: f64, added: DVec3, drift: f64) -> (DVec3, f64) {
        let grown = ball * growth(h, self.power, ball) + drift;
        let next = power(h, self.power) + added;
        let error = ROUNDING * (next.length() + added.length() + 1.0);
        (next, grown * (1.0 + ROUNDING) + error)
    }

    /// Whether the orbits of a ball, at its point number `n`, all leave the bail-out radius for good.
    fn all_escape(
        &self,
        mut h: DVec3,
        mut ball: f64,
        added: DVec3,
        (n, drift): (u32, f64),
    ) -> bool {
        let exit = self.search.radius;
        for _ in n..self.iterations {
            if !(h.length() <= FAR * exit) {
                break;
            }
            (h, ball) = self.next(h, ball, added, drift);
            if h.length() - ball > exit {
                return true;
            }
        }
        false
    }
}

impl Primitive for Mandelbulb {
    fn kind(&self) -> &'static str {
        "mandelbulb"
    }

    /// [`Mandelbulb::try_new`] has validated everything.
    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
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

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        orbit_search::surface_at(self, ray, hit)
    }

    fn as_solid(&self) -> Option<&dyn Solid> {
        Some(self)
    }
}

impl Solid for Mandelbulb {
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
