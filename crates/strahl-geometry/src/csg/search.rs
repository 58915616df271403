//! The search of one ray through one tree: what it is asked, and what it has found so far.

use super::boxes::Slabs;
use super::compiled::Csg;
use super::fusing::{Fusing, TooClose};
use super::query::start_and_begin;
use super::timeline::Timeline;
use crate::{Scratch, SurfaceId};
use strahl_math::{Interval, Ray};

/// The lists of a search, reused from ray to ray.
#[derive(Debug, Default)]
pub(super) struct Lists {
    pub(super) timeline: Timeline,
    /// The operands found by hierarchies, operation by operation.
    pub(super) candidates: Vec<u32>,
    /// The root's operands whose boxes begin behind the first window, and where they begin.
    pub(super) later: Vec<(u32, f64)>,
}

/// The search of one ray for the first surface of one tree.
pub(super) struct Search<'a> {
    pub(super) csg: &'a Csg,
    pub(super) ray: &'a Ray,
    /// Computed when the first box is tested.
    pub(super) slabs: Option<Slabs>,
    /// The leaf on which the ray starts, and its surface there.
    pub(super) from: Option<(u32, SurfaceId)>,
    pub(super) fusing: Fusing,
    /// The range of the query.
    pub(super) range: Interval,
    /// The beginning of the timeline: a little before the range, so that crossings on both sides of its start are
    /// distinguished, but not behind the surface that the ray leaves.
    pub(super) begin: f64,
    pub(super) lists: &'a mut Lists,
    pub(super) scratch: &'a mut Scratch,
}

impl<'a> Search<'a> {
    /// `None` if the range is empty.
    // Inline: it has 160 bytes, which would be copied.
    #[inline(always)]
    pub(super) fn new(
        csg: &'a Csg,
        ray: &'a Ray,
        range: Interval,
        from: Option<SurfaceId>,
        lists: &'a mut Lists,
        scratch: &'a mut Scratch,
    ) -> Option<Self> {
        let fusing = Fusing::new(ray);
        let (start, begin) = start_and_begin(range, from.is_some(), &fusing);
        if !(start < range.max) {
            return None;
        }
        lists.timeline.clear(csg.node_count());
        lists.candidates.clear();
        lists.later.clear();
        Some(Self {
            csg,
            ray,
            slabs: None,
            from: from.map(|surface| csg.leaf_surface(surface)),
            fusing,
            range: Interval::new(start, range.max),
            begin,
            lists,
            scratch,
        })
    }

    /// The surface that the ray starts on, if it belongs to this leaf.
    pub(super) fn start_on(&self, leaf: u32) -> Option<SurfaceId> {
        let (other, surface) = self.from?;
        (other == leaf).then_some(surface)
    }

    /// Fails for crossings that could coincide with the surface that the ray leaves.
    pub(super) fn check_start(&self, t: f64) -> Result<(), TooClose> {
        if self.from.is_none() || t.abs() > self.fusing.gap(t, 0.0) {
            Ok(())
        } else {
            Err(TooClose)
        }
    }
}
