//! A vertex as one of its faces sees it.

use super::SubdivisionScheme;
use super::rules::{Facet, Fan, Spoke, Tip};
use std::sync::Arc;
use strahl_math::{Aabb, DVec3};

/// A vertex with all that is around it, beginning with a face: facet 0 is that face, between the spokes 0 and 1.
///
/// Views of one fan from all of its faces take no more memory than the fan: they differ in where they begin.
#[derive(Clone, Debug)]
pub(super) struct View {
    fan: Arc<Fan>,
    /// The index of its first spoke in the fan.
    first: usize,
}

impl View {
    pub(super) fn new(fan: Fan) -> Self {
        Self::of(Arc::new(fan), 0)
    }

    /// A fan, seen from facet `first`.
    pub(super) fn of(fan: Arc<Fan>, first: usize) -> Self {
        Self { fan, first }
    }

    pub(super) fn point(&self) -> DVec3 {
        self.fan.point
    }

    /// The [`Fan::depth`].
    pub(super) fn depth(&self) -> u32 {
        self.fan.depth
    }

    pub(super) fn edges(&self) -> usize {
        self.fan.spokes.len()
    }

    pub(super) fn spoke(&self, j: usize) -> Spoke {
        self.fan.spokes[self.fan.turn(self.first, j)]
    }

    /// The spoke before the first.
    pub(super) fn spoke_before(&self) -> Spoke {
        self.fan.spokes[self.fan.before(self.first)]
    }

    pub(super) fn facet(&self, j: usize) -> Facet {
        self.fan.facets[self.fan.turn(self.first, j)]
    }

    /// The facet before the first: the face beyond the first spoke.
    pub(super) fn facet_before(&self) -> Facet {
        self.fan.facets[self.fan.before(self.first)]
    }

    /// The same vertex, seen from the face that is so many places earlier.
    pub(super) fn rotated(&self, places: usize) -> Self {
        let count = self.edges();
        let first = self.fan.turn(self.first, count - places % count);
        Self::of(Arc::clone(&self.fan), first)
    }

    /// The vertex on the next level, with the new vertices on its edges and the new faces at it.
    pub(super) fn refined(&self, scheme: SubdivisionScheme) -> Self {
        Self::of(self.fan.refined(scheme), self.first)
    }

    /// Where the vertex ends.
    pub(super) fn place(&self, scheme: SubdivisionScheme) -> DVec3 {
        self.fan.place(scheme)
    }

    /// Whether [`Self::tip`] without a limit is known.
    pub(super) fn has_tip(&self) -> bool {
        self.fan.origin.is_some()
    }

    /// The surface about the vertex; with a limit, only if the first facet is narrower.
    pub(super) fn tip(&self, scheme: SubdivisionScheme, limit: Option<f64>) -> Option<Tip> {
        self.fan.tip(scheme, self.first, limit)
    }

    /// A box around what the first facet becomes on later levels.
    pub(super) fn hull(&self, scheme: SubdivisionScheme, level: u32) -> Aabb {
        self.fan.hull(scheme, self.first, level)
    }

    /// The spoke `j + 1` or `j - 1` and the one behind it, as seen from the smooth spoke `j`; behind a sharp one the surface
    /// is continued so that it ends there just as it does.
    pub(super) fn aside(&self, j: usize, is_after: bool) -> [DVec3; 2] {
        let j = self.fan.turn(self.first, j);
        let step = |j: usize| {
            if is_after {
                self.fan.turn(j, 1)
            } else {
                self.fan.before(j)
            }
        };
        let spokes = &self.fan.spokes;
        let side = spokes[step(j)];
        let behind = if side.sharpness > 0.0 {
            (side.point + self.fan.point) - spokes[j].point
        } else {
            spokes[step(step(j))].point
        };
        [side.point, behind]
    }

    /// The bytes that it takes, but for those that it shares with all faces at the vertex.
    pub(super) fn own_bytes(&self) -> usize {
        let fans = [Some(&self.fan), self.fan.origin.as_ref()];
        let own = fans.into_iter().flatten().filter(|fan| !fan.is_shared());
        size_of::<Self>() + own.map(|fan| fan.bytes()).sum::<usize>()
    }

    /// The bytes of the fan, and of what it has made for all faces.
    pub(super) fn shared_bytes(&self) -> usize {
        let origin = self.fan.origin.as_ref().map_or(0, |fan| fan.bytes());
        self.fan.bytes() + origin
    }

    /// Whether it begins where the fan does.
    pub(super) fn is_first(&self) -> bool {
        self.first == 0
    }
}
