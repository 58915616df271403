//! Closed surfaces as solids.

use super::data::Patches;
use super::part::Part;
use super::{Nurbs, hit};
use crate::patch::search::Frame;
use crate::{Crossing, Crossings, PrimHit, Scratch, Side, Solid, SurfaceId};
use std::collections::HashMap;
use strahl_accel::Visitor;
use strahl_math::error::gamma;
use strahl_math::{DVec3, Interval, Ray};

/// The direction of the ray that [`Solid::contains`] uses: not parallel to anything that occurs in scenes.
const ASKANCE: DVec3 = DVec3::new(0.526_438_109_1, 0.315_904_772_9, 0.789_365_214_7);

/// Whether each curve of the outer border of a whole surface belongs to it in both directions, or is collapsed to a point.
///
/// Then the border winds around no ray, so that every line leaves the surface as often as it enters.
pub(super) fn is_closed(patches: &Patches) -> bool {
    let [across, up] = [0, 1].map(|k| patches.breaks[k].len() - 1);
    let mut open: HashMap<Vec<[u64; 4]>, i32> = HashMap::new();
    let mut add = |part: &Part, side: usize| {
        let curve = part.patch.border(side);
        if curve.windows(2).all(|pair| pair[0] == pair[1]) {
            return;
        }
        let mut back = curve.clone();
        back.reverse();
        let (key, sign) = match curve.cmp(&back) {
            std::cmp::Ordering::Less => (curve, 1),
            std::cmp::Ordering::Greater => (back, -1),
            // There and back again.
            std::cmp::Ordering::Equal => return,
        };
        *open.entry(key).or_default() += sign;
    };
    for (index, part) in patches.parts.iter().enumerate() {
        let (a, b) = (index % across, index / across);
        let is_outside = [b == 0, a + 1 == across, b + 1 == up, a == 0];
        for side in (0..4).filter(|side| is_outside[*side]) {
            add(part, side);
        }
    }
    open.values().all(|sum| *sum == 0)
}

/// A pass of a ray through the surface; the sign is that of the direction along `dS/du x dS/dv`.
#[derive(Clone, Copy, Debug)]
struct Pass {
    hit: PrimHit,
    sign: i32,
}

/// Collects all passes.
struct All<'a> {
    nurbs: &'a Nurbs,
    frame: Frame,
    passes: Vec<Pass>,
}

impl Visitor for All<'_> {
    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        let found = self
            .nurbs
            .with_part(id, |part, keep| part.patch.all(&self.frame, keep));
        self.passes
            .extend(found.into_iter().flatten().map(|candidate| Pass {
                hit: hit(id, &candidate),
                sign: candidate.sign,
            }));
        t_max
    }
}

impl Nurbs {
    /// All passes of the line, in their order.
    fn passes(&self, ray: &Ray) -> Vec<Pass> {
        let Some(frame) = Frame::new(ray) else {
            return vec![];
        };
        let mut all = All {
            nurbs: self,
            frame,
            passes: vec![],
        };
        self.walk(ray, Interval::LINE, &mut all);
        let mut passes = all.passes;
        passes.sort_by(|a, b| {
            let element = |pass: &Pass| pass.hit.surface.element;
            a.hit
                .t
                .total_cmp(&b.hit.t)
                .then(element(a).cmp(&element(b)))
        });
        passes
    }

    /// Whether `dS/du x dS/dv` points inwards: a ray from outside passes along it first.
    pub(super) fn is_inside_out(&self) -> bool {
        let aims = self.parts.iter().map(|part| part.patch.jet(0.5, 0.5)[0]);
        for target in aims.take(64) {
            let from = target - ASKANCE * (4.0 * self.bounds.size().max_element());
            let passes = self.passes(&Ray::new(from, ASKANCE));
            if let Some(first) = passes.first() {
                return first.sign > 0;
            }
        }
        false
    }

    /// What passing does to the number of times that the surface winds around the ray.
    fn change(&self, pass: &Pass) -> i32 {
        let outwards = if self.is_inside_out {
            -pass.sign
        } else {
            pass.sign
        };
        -outwards
    }

    /// A bound on the error of `t` at a hit.
    fn t_error(&self, ray: &Ray, hit: &PrimHit) -> f64 {
        let length = ray.direction.length();
        let reach = self.bounds.max_abs() + ray.origin.abs().max_element();
        let (error, size) = (gamma(128) * reach, self.bounds.size().length());
        let normal = super::Primitive::surface_at(self, ray, hit).n_geom;
        let along = error / (normal.dot(ray.direction) / length).abs();
        // A ray along the surface is near it as far as it is there.
        let most = if along < size { along } else { size };
        most / length + gamma(8) * hit.t.abs()
    }
}

impl Solid for Nurbs {
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
        for pass in self.passes(ray) {
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
        if !self.bounds.contains(point) {
            return false;
        }
        let near = gamma(64) * (point.abs().max_element() + self.bounds.max_abs());
        let mut winding = 0;
        for pass in self.passes(&Ray::new(point, ASKANCE)) {
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
