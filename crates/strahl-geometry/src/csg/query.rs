//! What is asked of a tree: a ray, and the part of it that matters.

use super::fusing::{Fusing, TooClose};
use super::leaf::Leaf;
use crate::{PrimHit, SurfaceId};
use std::ops::ControlFlow;
use strahl_math::{Interval, Ray};

/// A ray and what is asked of it.
pub(super) struct Query<'a> {
    pub(super) ray: &'a Ray,
    pub(super) range: Interval,
    /// Crossings before this don't count: it is a little before the range, so that crossings on both sides of its start are
    /// distinguished, but not behind the surface that the ray leaves.
    pub(super) begin: f64,
    /// The part of the ray on which leaves matter, a little wider than what is required of it.
    pub(super) alive: Interval,
    /// The leaf that the ray starts on, and its surface there.
    pub(super) from: Option<(u32, SurfaceId)>,
    pub(super) fusing: Fusing,
}

impl<'a> Query<'a> {
    /// `None` if the range is empty.
    #[inline(always)]
    pub(super) fn new(
        ray: &'a Ray,
        range: Interval,
        from: Option<(u32, SurfaceId)>,
    ) -> Option<Self> {
        let fusing = Fusing::new(ray);
        let (start, begin) = start_and_begin(range, from.is_some(), &fusing);
        let range = Interval::new(start, range.max);
        (start < range.max).then(|| Self {
            ray,
            range,
            begin,
            alive: Interval::new(begin, fusing.widened(range).max),
            from,
            fusing,
        })
    }

    /// The surface that the ray starts on, if it belongs to this leaf.
    #[inline]
    pub(super) fn own(&self, leaf: u32) -> Option<SurfaceId> {
        let (other, surface) = self.from?;
        (other == leaf).then_some(surface)
    }

    /// Whether a crossing could coincide with the surface that the ray leaves.
    #[inline]
    pub(super) fn starts_at(&self, t: f64) -> bool {
        self.from.is_some() && t.abs() <= self.fusing.gap(t, 0.0)
    }

    /// Visits a crossing of the surface of the tree on a facet of a leaf, if it is visible and behind the beginning of the range.
    #[inline(always)]
    pub(super) fn shows(
        &self,
        leaf: &Leaf,
        t: f64,
        facet: u32,
        visit: &mut impl FnMut(PrimHit) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if !(leaf.visible && t > self.range.min) {
            return ControlFlow::Continue(());
        }
        let surface = SurfaceId {
            element: leaf.first_element,
            facet,
        };
        visit(PrimHit {
            surface,
            ..PrimHit::simple(t, 0)
        })
    }

    /// Fails for a crossing and the next one if they could coincide.
    #[inline(always)]
    pub(super) fn check_apart(&self, t: f64, next: f64) -> Result<(), TooClose> {
        if next - t > self.fusing.gap(t, next) || next == f64::INFINITY || t == f64::NEG_INFINITY {
            Ok(())
        } else {
            Err(TooClose)
        }
    }
}

/// Where a ray that starts on a surface or not begins to be searched, and the place before which no crossing counts ([`Query::begin`]).
pub(super) fn start_and_begin(range: Interval, on_surface: bool, fusing: &Fusing) -> (f64, f64) {
    let forward = |t: f64| if on_surface && t < 0.0 { 0.0 } else { t };
    let start = forward(range.min);
    (start, forward(start - 4.0 * fusing.gap(start, start)))
}
