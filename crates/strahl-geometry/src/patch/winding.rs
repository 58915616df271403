//! Closed surfaces of patches as solids: a point is inside if the surface winds around it.

use crate::{Crossing, Crossings, PrimHit, Primitive, Scratch, Side, Solid, SurfaceId};
use strahl_math::error::gamma;
use strahl_math::{DVec3, Interval, Ray};

/// The direction of the ray that `contains` uses: not parallel to anything that occurs in scenes.
const ASKANCE: DVec3 = DVec3::new(0.526_438_109_1, 0.315_904_772_9, 0.789_365_214_7);

/// A pass of a ray through a surface; the sign is that of the direction along `dS/du x dS/dv`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pass {
    pub(super) hit: PrimHit,
    pub(super) sign: i32,
}

/// A closed surface: every line leaves it as often as it enters.
pub(super) trait Winding: Primitive {
    /// So many roundings are on the way to a point.
    const ROUNDINGS: u32;

    /// All passes of a line, in no order.
    fn passes(&self, ray: &Ray) -> Vec<Pass>;

    /// Whether `dS/du x dS/dv` points inwards.
    fn is_inside_out(&self) -> bool;

    /// All passes of a line, in their order.
    fn passes_in_order(&self, ray: &Ray) -> Vec<Pass> {
        let mut passes = self.passes(ray);
        passes.sort_by(|a, b| {
            let element = |pass: &Pass| pass.hit.surface.element;
            a.hit
                .t
                .total_cmp(&b.hit.t)
                .then(element(a).cmp(&element(b)))
        });
        passes
    }

    /// Finds out whether `dS/du x dS/dv` points inwards: a ray from outside to one of these points passes along it first.
    fn finds_inside_out(&self, aims: impl Iterator<Item = DVec3>) -> bool {
        for target in aims.take(64) {
            let from = target - ASKANCE * (4.0 * self.bounds().size().max_element());
            let passes = self.passes_in_order(&Ray::new(from, ASKANCE));
            if let Some(first) = passes.first() {
                return first.sign > 0;
            }
        }
        false
    }

    /// What passing does to the number of times that the surface winds around the ray.
    fn change(&self, pass: &Pass) -> i32 {
        if self.is_inside_out() {
            pass.sign
        } else {
            -pass.sign
        }
    }

    /// A bound on the error of `t` at a hit.
    fn t_error(&self, ray: &Ray, hit: &PrimHit) -> f64 {
        let length = ray.direction.length();
        let bounds = self.bounds();
        let reach = bounds.max_abs() + ray.origin.abs().max_element();
        let (error, size) = (gamma(Self::ROUNDINGS) * reach, bounds.size().length());
        let normal = self.bare_surface_at(ray, hit).n_geom;
        let along = error / (normal.dot(ray.direction) / length).abs();
        // A ray along the surface is near it as far as it is there.
        let most = if along < size { along } else { size };
        most / length + gamma(8) * hit.t.abs()
    }
}

impl<S: Winding> Solid for S {
    fn crossings(
        &self,
        ray: &Ray,
        range: Interval,
        from: Option<SurfaceId>,
        _scratch: &mut Scratch,
        out: &mut Crossings,
    ) {
        let range = if from.is_some() && range.min < 0.0 {
            Interval { min: 0.0, ..range }
        } else {
            range
        };
        let mut winding = 0;
        for pass in self.passes_in_order(ray) {
            let t = pass.hit.t;
            if t > range.max && t > range.min {
                break;
            }
            let before = winding;
            winding += self.change(&pass);
            if !range.accepts(t) {
                out.inside_at_start = winding > 0;
                continue;
            }
            let side = match (before > 0, winding > 0) {
                (false, true) => Side::Enter,
                (true, false) => Side::Exit,
                _ => Side::Inner,
            };
            let error = self.t_error(ray, &pass.hit);
            out.list.push(Crossing::new(pass.hit, error, side));
        }
    }

    fn contains(&self, point: DVec3) -> bool {
        let bounds = self.bounds();
        if !bounds.contains(point) {
            return false;
        }
        let near = gamma(64) * (point.abs().max_element() + bounds.max_abs());
        let mut winding = 0;
        for pass in self.passes_in_order(&Ray::new(point, ASKANCE)) {
            if pass.hit.t.abs() <= near {
                return true;
            }
            if pass.hit.t > 0.0 {
                winding -= self.change(&pass);
            }
        }
        winding > 0
    }
}
