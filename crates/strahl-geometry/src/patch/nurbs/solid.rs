//! Closed surfaces as solids.

use super::data::Patches;
use super::part::Part;
use super::{Nurbs, hit};
use crate::patch::search::Frame;
use crate::patch::winding::{Pass, Winding};
use crate::{Crossings, Scratch, Solid, SurfaceId};
use std::collections::HashMap;
use strahl_accel::Visitor;
use strahl_math::{DVec3, Interval, Ray};

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

impl Winding for Nurbs {
    const ROUNDINGS: u32 = 128;

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
        all.passes
    }

    fn is_inside_out(&self) -> bool {
        self.is_inside_out
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
        self.crossings_by_winding(ray, range, from, out);
    }

    fn contains(&self, point: DVec3) -> bool {
        self.contains_by_winding(point)
    }
}
