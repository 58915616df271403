//! Surfaces whose points are functions of two parameters.

mod patches;
#[cfg(test)]
mod tests;

use super::container::Container;
use super::workspace::with_workspace;
use crate::{GeometryError, PrimHit, Primitive, Scratch, SurfaceId, SurfacePoint};
use patches::{Patches, Piece, Rectangle};
use std::sync::OnceLock;
use strahl_function::{Bounds, Function, ScalarField, Workspace};
use strahl_math::error::gamma;
use strahl_math::{Aabb, DVec2, DVec3, Interval, Ray};

/// Options of a parametric surface; the defaults are POV-Ray's.
#[derive(Clone, Debug, PartialEq)]
pub struct ParametricOptions {
    /// Details smaller than this may be missed.
    pub accuracy: f64,
    /// The largest change of a coordinate per unit of a parameter. Used only if a function calls patterns or pigments, for
    /// which there are no bounds.
    pub max_gradient: f64,
}

impl Default for ParametricOptions {
    fn default() -> Self {
        Self {
            accuracy: 0.001,
            max_gradient: 1.0,
        }
    }
}

/// The surface of all points `(x(u, v), y(u, v), z(u, v))` for parameters of a rectangle, as far as they lie in a container.
///
/// It is an open surface without an inside. Texture coordinates are the parameters; the front is the side to which the product of the
/// derivatives by `u` and `v` points. One facet, 0.
///
/// The rectangle is quartered until its pieces are flat, with boxes from interval bounds of the functions, when the
/// first ray comes. On a piece whose box it meets, a ray is followed to the surface by Newton's method in the two
/// parameters (Martin, Cohen, Fish, Shirley, "Practical ray tracing of trimmed NURBS surfaces", Journal of Graphics Tools
/// 5(1), 2000). Not robust at singular points, where the derivatives are parallel or vanish: there pieces stay round however
/// small they are, and details below the accuracy may be missed.
#[derive(Debug)]
pub struct Parametric {
    functions: [Function; 3],
    domain: Rectangle,
    container: Container,
    options: ParametricOptions,
    is_bounded: bool,
    patches: OnceLock<Patches>,
}

/// The surface.
const SURFACE: SurfaceId = SurfaceId {
    element: 0,
    facet: 0,
};
/// A ray hits a flat piece at most once if the cosine between it and the normal in the middle is above the spread of the
/// normals by this factor: then it crosses the piece in one direction only.
const STEEP: f64 = 2.0;
/// How far beyond its piece, in parts of it, a point may be found: neighbours overlap, so that no ray slips through between
/// them.
const OVERLAP: f64 = 1e-6;
/// Pieces that are not flat are quartered so often for a single ray.
const DEEPER: u32 = 8;
/// Newton's method doubles the digits in each round, from one or two.
const ROUNDS: u32 = 16;

/// A point of the surface with its derivatives.
#[derive(Clone, Copy)]
struct Jet {
    point: DVec3,
    by_u: DVec3,
    by_v: DVec3,
}

/// A search for the nearest hit.
struct Quest<'a> {
    ray: &'a Ray,
    range: Interval,
    /// Two directions across the ray.
    across: [DVec3; 2],
    nearest: Option<PrimHit>,
}

impl Quest<'_> {
    fn meets(&self, bounds: &Aabb) -> bool {
        let range = self
            .nearest
            .map_or(self.range, |hit| self.range.with_max(hit.t));
        // Covers the rounding error of points on a ray from far away.
        let pad = (self.ray.origin.abs() + bounds.min.abs().max(bounds.max.abs())) * gamma(32);
        bounds.padded(pad).clip(self.ray, range).is_some()
    }
}

impl Parametric {
    /// The surface of three functions of two parameters between two corners of a rectangle.
    ///
    /// # Errors
    /// The container is degenerate, a function has other than two parameters, a number is not finite, the rectangle has no
    /// area, or accuracy or gradient are not positive.
    pub fn try_new(
        functions: [Function; 3],
        corners: [DVec2; 2],
        container: Container,
        options: ParametricOptions,
    ) -> Result<Self, GeometryError> {
        container.validate()?;
        for function in &functions {
            let found = function.parameters().len() as u64;
            if found != 2 {
                return Err(GeometryError::WrongCount {
                    what: "parameters of a function of a parametric surface",
                    expected: 2,
                    found,
                });
            }
        }
        let [a, b] = corners;
        if !(a.is_finite() && b.is_finite()) {
            return Err(GeometryError::NotFinite {
                what: "range of the parameters",
            });
        }
        if a.x == b.x || a.y == b.y {
            return Err(GeometryError::Degenerate {
                what: "parametric surface",
                why: "the range of a parameter is empty",
            });
        }
        crate::primitives::check_positive("accuracy of the parametric surface", options.accuracy)?;
        crate::primitives::check_positive(
            "max_gradient of the parametric surface",
            options.max_gradient,
        )?;
        Ok(Self {
            is_bounded: functions.iter().all(Function::is_bounded),
            functions,
            domain: Rectangle {
                min: a.min(b),
                max: a.max(b),
            },
            container,
            options,
            patches: OnceLock::new(),
        })
    }

    fn jet(&self, workspace: &mut Workspace, uv: DVec2) -> Jet {
        let rows = self
            .functions
            .each_ref()
            .map(|f| f.gradient(workspace, &uv.to_array()));
        let column = |k: usize| DVec3::from_array(rows.map(|(_, partials)| partials[k]));
        Jet {
            point: DVec3::from_array(rows.map(|(value, _)| value)),
            by_u: column(0),
            by_v: column(1),
        }
    }

    /// The box of the surface over a rectangle; empty where there is none.
    fn bounds_over(&self, workspace: &mut Workspace, r: &Rectangle) -> Aabb {
        let side = |k: usize| Bounds::new(r.min[k], r.max[k]);
        let arguments = [side(0), side(1)];
        let reach = self.options.max_gradient * 0.5 * (r.size().x + r.size().y);
        let ranges = self.functions.each_ref().map(|f| {
            if self.is_bounded {
                let b = f.bounds(workspace, &arguments);
                return (b.min, b.max);
            }
            let middle = f.value(workspace, &r.center().to_array());
            (middle - reach, middle + reach)
        });
        Aabb::new(
            DVec3::from_array(ranges.map(|r| r.0)),
            DVec3::from_array(ranges.map(|r| r.1)),
        )
    }

    fn examine(&self, workspace: &mut Workspace, r: &Rectangle) -> Option<Piece> {
        let bounds = self.bounds_over(workspace, r);
        let bounds = bounds.intersection(&self.container.bounds());
        if bounds.is_empty() || self.container.excludes(&bounds) {
            return None;
        }
        let mut normal = |u: f64, v: f64| {
            let jet = self.jet(workspace, DVec2::new(u, v));
            jet.by_u.cross(jet.by_v).normalize_or_zero()
        };
        let middle = normal(r.center().x, r.center().y);
        let corners = [
            normal(r.min.x, r.min.y),
            normal(r.max.x, r.min.y),
            normal(r.min.x, r.max.y),
            normal(r.max.x, r.max.y),
        ];
        let known = middle != DVec3::ZERO && corners.iter().all(|n| *n != DVec3::ZERO);
        let spread = if known {
            corners
                .iter()
                .fold(0.0, |spread: f64, n| spread.max((*n - middle).length()))
        } else {
            f64::INFINITY
        };
        Some(Piece { bounds, spread })
    }

    fn patches(&self, workspace: &mut Workspace) -> &Patches {
        /// The box, and a gradient in the middle and at each corner.
        const EVALUATIONS: u64 = 6;
        self.patches.get_or_init(|| {
            let once = self.functions.iter().fold(0_u64, |sum, f| {
                sum.saturating_add(ScalarField::cost(f).operations)
            });
            let cost = once.saturating_mul(EVALUATIONS);
            Patches::build(self.domain, cost, |r| self.examine(workspace, r))
        })
    }

    /// Searches a hit on a piece. A piece that is not flat is quartered first; a piece on which Newton's method proved nothing,
    /// afterwards.
    fn search(
        &self,
        workspace: &mut Workspace,
        quest: &mut Quest<'_>,
        r: &Rectangle,
        piece: &Piece,
        deeper: u32,
    ) {
        let small = piece.bounds.size().max_element() <= self.options.accuracy;
        let last = small || deeper == 0;
        let settled = (piece.is_flat() || last) && self.approach(workspace, quest, r, piece.spread);
        if settled || last {
            return;
        }
        for quarter in r.quarters() {
            if let Some(piece) = self.examine(workspace, &quarter)
                && quest.meets(&piece.bounds)
            {
                self.search(workspace, quest, &quarter, &piece, deeper - 1);
            }
        }
    }

    /// Newton's method for the parameters at which the ray hits the surface, within (nearly) a rectangle. Returns whether a
    /// flat piece certainly has no other hit.
    fn approach(
        &self,
        workspace: &mut Workspace,
        quest: &mut Quest<'_>,
        r: &Rectangle,
        spread: f64,
    ) -> bool {
        let ray = quest.ray;
        let [n1, n2] = quest.across;
        let (size, mut uv) = (r.size(), r.center());
        let mut steep = false;
        for round in 0..ROUNDS {
            let jet = self.jet(workspace, uv);
            if round == 0 {
                let normal = jet.by_u.cross(jet.by_v).normalize_or_zero();
                steep = normal.dot(n1.cross(n2)).abs() > STEEP * spread;
            }
            let off = jet.point - ray.origin;
            let (e1, e2) = (off.dot(n1), off.dot(n2));
            let (a, b) = (jet.by_u.dot(n1), jet.by_v.dot(n1));
            let (c, d) = (jet.by_u.dot(n2), jet.by_v.dot(n2));
            let determinant = a * d - b * c;
            let step = DVec2::new(e1 * d - b * e2, a * e2 - e1 * c) / determinant;
            // The ray runs along the surface, or the surface is singular.
            if !step.is_finite() {
                return false;
            }
            uv -= step;
            let away = ((uv - r.center()) / size).abs().max_element();
            // It has left the piece.
            if away > 2.0 {
                return steep;
            }
            if (step / size).abs().max_element() < 1e-9 {
                if away <= 0.5 + OVERLAP {
                    self.accept(workspace, quest, uv);
                }
                return steep;
            }
        }
        false
    }

    /// Accepts a hit if it is the nearest so far.
    fn accept(&self, workspace: &mut Workspace, quest: &mut Quest<'_>, uv: DVec2) {
        let ray = quest.ray;
        let uv = uv.clamp(self.domain.min, self.domain.max);
        let point = self.jet(workspace, uv).point;
        let t = (point - ray.origin).dot(ray.direction) / ray.direction.dot(ray.direction);
        if quest.range.accepts(t)
            && quest.nearest.is_none_or(|best| t < best.t)
            && self.container.contains(point)
        {
            quest.nearest = Some(PrimHit {
                t,
                surface: SURFACE,
                uv: uv.to_array(),
            });
        }
    }

    /// The rounding error of the coordinates near a point.
    fn noise(&self, workspace: &mut Workspace, uv: DVec2, jet: &Jet) -> DVec3 {
        let place = (jet.by_u * uv.x).abs() + (jet.by_v * uv.y).abs() + jet.point.abs();
        let point = Rectangle { min: uv, max: uv };
        let width = self.bounds_over(workspace, &point).size();
        let known = self.is_bounded && width.is_finite() && width.min_element() >= 0.0;
        place * gamma(16) + if known { width } else { place * gamma(64) }
    }
}

impl Primitive for Parametric {
    fn kind(&self) -> &'static str {
        "parametric"
    }

    /// [`Parametric::try_new`] has validated everything.
    fn validate(&self) -> Result<(), GeometryError> {
        Ok(())
    }

    fn bounds(&self) -> Aabb {
        with_workspace(|workspace| self.patches(workspace).bounds())
    }

    fn closest_hit(
        &self,
        ray: &Ray,
        range: Interval,
        _from: Option<SurfaceId>,
        _scratch: &mut Scratch,
    ) -> Option<PrimHit> {
        let along = ray.direction.try_normalize()?;
        if !(ray.origin.is_finite() && ray.direction.is_finite()) {
            return None;
        }
        let first = along.any_orthonormal_vector();
        let quest = std::cell::RefCell::new(Quest {
            ray,
            range,
            across: [first, along.cross(first)],
            nearest: None,
        });
        with_workspace(|workspace| {
            let patches = self.patches(workspace);
            let meets = |bounds: &Aabb| quest.borrow().meets(bounds);
            patches.visit(self.domain, meets, |rectangle, piece| {
                self.search(workspace, &mut quest.borrow_mut(), rectangle, piece, DEEPER);
            });
        });
        quest.into_inner().nearest
    }

    fn surface_at(&self, ray: &Ray, hit: &PrimHit) -> SurfacePoint {
        with_workspace(|workspace| {
            let uv = DVec2::from_array(hit.uv);
            let jet = self.jet(workspace, uv);
            let normal = jet
                .by_u
                .cross(jet.by_v)
                .try_normalize()
                .or_else(|| (-ray.direction).try_normalize())
                .unwrap_or(DVec3::Y);
            let error = self.noise(workspace, uv, &jet);
            SurfacePoint {
                uv,
                dpdu: jet.by_u,
                dpdv: jet.by_v,
                ..SurfacePoint::bare(jet.point, error, normal)
            }
        })
    }

    fn texture_uv(&self, _hit: &PrimHit, uv: DVec2) -> Option<DVec2> {
        Some(uv)
    }
}
