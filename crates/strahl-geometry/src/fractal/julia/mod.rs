//! Julia sets in four dimensions.

mod complex;
mod march;
mod orbit;
mod power;
#[cfg(test)]
mod tests;

use crate::implicit::{Octree, Passage};
use crate::{
    Container, Crossing, Crossings, GeometryError, PrimHit, Primitive, Scratch, Side, Solid,
    Sphere, SurfaceId, SurfacePoint,
};
pub use complex::HypercomplexFunction;
use march::March;
use orbit::{Four, Rule, norm2};
use std::ops::ControlFlow;
use std::sync::Arc;
use strahl_math::error::{ROUNDOFF, gamma};
use strahl_math::{Aabb, DVec3, Interval, Ray};

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
/// Rays march by an estimate of the distance, from the first derivative of the orbit's end (by half of it where it may be too long); crossings are then refined to
/// the last digit. An octree, whose cells are examined when a ray first meets them, stores where the surface may be at all: of squares
/// and cubes it is proven where it is not. Shading takes the normal POV-Ray has: that of the set of one point
/// more, in the three directions of space as if they were not tilted by the slice. There are no texture coordinates. Facet 0.
///
/// J. C. Hart, D. J. Sandin, L. H. Kauffman, "Ray tracing deterministic 3-D fractals", SIGGRAPH 1989.
#[derive(Clone, Debug)]
pub struct Julia {
    rule: Rule,
    /// Offset and factors of the fourth component.
    fourth: (f64, DVec3),
    around: Container,
    radius: f64,
    shortest: f64,
    /// The largest growth of a distance in space that the slice causes.
    tilt: f64,
    octree: Arc<Octree>,
}

/// The octree's cells are halved so often.
const LEVELS: u32 = 6;

/// The surface of the set.
const SURFACE: SurfaceId = SurfaceId {
    element: 0,
    facet: 0,
};

/// The ball around the set, which clips it if orbits are too short; it is invisible.
const BALL: SurfaceId = SurfaceId {
    element: 0,
    facet: 1,
};

/// The events along a ray.
enum Event {
    /// The ray starts in the ball around the set, inside of the set from there on or not.
    Start { inside: bool },
    /// It crosses the surface, or (unseen) the ball around the set within it.
    Crossing {
        t: f64,
        surface: SurfaceId,
        enters: bool,
    },
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
        let precision = if options.precision > 1.0 {
            options.precision
        } else {
            1.0
        };
        Ok(Self {
            rule: Rule {
                algebra,
                parameter,
                points: options.max_iteration,
                exit,
            },
            fourth: (options.distance * length / nw, -DVec3::new(nx, ny, nz) / nw),
            around: Container::Sphere(Sphere::new(DVec3::ZERO, exit)),
            radius: exit,
            shortest: exit / (50.0 * precision),
            tilt: norm2([1.0, nx / nw, ny / nw, nz / nw]).sqrt(),
            octree: Arc::new(Octree::new(
                Aabb::new(DVec3::splat(-exit), DVec3::splat(exit)),
                LEVELS,
            )),
        })
    }

    /// The number that a point stands for.
    fn number(&self, p: DVec3) -> Four {
        let (offset, factors) = self.fourth;
        [p.x, p.y, p.z, offset + factors.dot(p)]
    }

    fn value(&self, p: DVec3) -> f64 {
        self.rule.value(self.number(p))
    }

    /// The gradient of the value in space.
    fn gradient(&self, p: DVec3) -> DVec3 {
        let [x, y, z, w] = self.rule.gradient(self.number(p), 0);
        DVec3::new(x, y, z) + self.fourth.1 * w
    }

    /// The rounding error of the value: the error of the first points, propagated, and those of all further ones.
    fn noise(&self, p: DVec3) -> f64 {
        gamma(16 * self.rule.points.min(1 << 16) + 16)
            * (self.rule.slope(self.number(p)) * self.radius + 1.0)
    }

    /// Reports the events along a ray to the visitor until it stops. Those after the range may be left out.
    fn walk(
        &self,
        ray: &Ray,
        (range, from): (Interval, Option<SurfaceId>),
        scratch: &mut Scratch,
        mut visit: impl FnMut(Event) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let Some(passage) = self.around.passage(ray, None, scratch) else {
            return ControlFlow::Continue(());
        };
        let (mut start, end) = (passage.start(), passage.exit.hit.t);
        if from.is_some() && start < 0.0 {
            start = 0.0;
        }
        if !(start < end && end.is_finite() && start.is_finite()) {
            return ControlFlow::Continue(());
        }
        let (length, origin) = (end - start, ray.at(start));
        // An empty range has a side at its start, too.
        let needed = range.max.max(range.min) - start;
        let line = (origin, ray.direction);
        let mut march = March::new(self, line, (start, length, needed), &mut visit);
        if from.is_some() && march.value.abs() < self.noise(origin) {
            // Where rounding hides the side, the direction of the ray decides.
            let leaves = self.gradient(origin).dot(ray.direction) >= 0.0;
            march.set_side(!leaves);
        }
        let inside = march.inside;
        if started_within(&passage, start) {
            (march.visit)(Event::Start { inside })?;
        } else if inside {
            (march.visit)(Event::Crossing {
                t: start,
                surface: BALL,
                enters: true,
            })?;
        }
        self.octree.walk(Interval::new(0.0, length), &mut march)?;
        march.leave()
    }

    fn t_error(&self, ray: &Ray, t: f64) -> f64 {
        let p = ray.at(t);
        let gradient = self.gradient(p);
        let reach = (ray.origin.abs() + (ray.direction * t).abs()) * gamma(4);
        let error = (self.noise(p) + gradient.abs().dot(reach)) / gradient.dot(ray.direction).abs();
        let longest = self.shortest / ray.direction.abs().max_element();
        gamma(4) * t.abs() + if error < longest { error } else { longest }
    }
}

/// Whether the ray enters the ball before this.
fn started_within(passage: &Passage, start: f64) -> bool {
    passage.enter.is_none_or(|enter| enter.hit.t < start)
}

impl Primitive for Julia {
    fn kind(&self) -> &'static str {
        "julia_fractal"
    }

    /// [`Julia::try_new`] has validated everything.
    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        self.around.bounds()
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let mut closest = None;
        // The result only matters while visiting.
        let _ = self.walk(ray, (range, from), scratch, |event| match event {
            Event::Crossing { t, surface, .. } if surface == SURFACE && range.accepts(t) => {
                closest = Some(PrimHit::simple(t, SURFACE.facet));
                ControlFlow::Break(())
            }
            Event::Crossing { t, .. } if t > range.max => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        });
        closest
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        if hit.surface == BALL {
            return self.around.surface_at(ray, &PrimHit::simple(hit.t, 0));
        }
        let mut p = ray.at(hit.t);
        let mut value = self.value(p);
        let mut gradient = self.gradient(p);
        for _ in 0..2 {
            let step = gradient * (value / gradient.dot(gradient));
            if !(step.length() < self.shortest) {
                break;
            }
            let next = self.value(p - step);
            if !(next.abs() < value.abs()) {
                break;
            }
            p -= step;
            value = next;
            gradient = self.gradient(p);
        }
        let off = (self.noise(p) + value.abs()) / gradient.length();
        let off = if off < self.shortest {
            off
        } else {
            self.shortest
        };
        let normal = gradient
            .try_normalize()
            .or_else(|| (-ray.direction).try_normalize())
            .unwrap_or(DVec3::Y);
        let error = DVec3::splat(off + f64::MIN_POSITIVE) + p.abs() * (4.0 * ROUNDOFF);
        // POV-Ray's normal is that of the set with one point more, before it is cut (measured).
        let [x, y, z, _] = self.rule.gradient(self.number(p), 1);
        let shading = DVec3::new(x, y, z).try_normalize();
        SurfacePoint {
            n_shade: shading.filter(|n| n.dot(normal) > 0.0).unwrap_or(normal),
            ..SurfacePoint::bare(p, error, normal)
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
        scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let start = if from.is_some() && range.min < 0.0 {
            0.0
        } else {
            range.min
        };
        let needed = Interval::new(start, range.max);
        let _ = self.walk(ray, (needed, from), scratch, |event| {
            match event {
                Event::Start { inside } => out.inside_at_start = inside,
                Event::Crossing { t, enters, .. } if t <= start => out.inside_at_start = enters,
                Event::Crossing { t, surface, enters } if t <= range.max => {
                    let side = if enters { Side::Enter } else { Side::Exit };
                    let hit = PrimHit::simple(t, surface.facet);
                    let mut crossing = Crossing::new(hit, self.t_error(ray, t), side);
                    crossing.visible = surface == SURFACE;
                    out.list.push(crossing);
                }
                Event::Crossing { .. } => return ControlFlow::Break(()),
            }
            ControlFlow::Continue(())
        });
    }

    fn contains(&self, point: DVec3) -> bool {
        self.around.contains(point) && self.value(point) <= 0.0
    }
}
