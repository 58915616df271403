//! Sets of points whose orbits stay near the origin: what their search needs to know, whatever is iterated.

use crate::implicit::Octree;
use crate::{Container, Sphere, SurfaceId};
use std::sync::Arc;
use strahl_math::{Aabb, DVec3};

/// The surface of the set.
pub(super) const SURFACE: SurfaceId = SurfaceId {
    element: 0,
    facet: 0,
};

/// The ball around the set, which clips it if orbits are too short; it is invisible.
pub(super) const BALL: SurfaceId = SurfaceId {
    element: 0,
    facet: 1,
};

/// The events along a ray.
pub(super) enum Event {
    /// The ray starts in the ball around the set, inside of the set from there on or not.
    Start { inside: bool },
    /// It crosses the surface, or (unseen) the ball around the set within it.
    Crossing {
        t: f64,
        surface: SurfaceId,
        enters: bool,
    },
}

/// How a point lies to the surface.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    /// Half of the squared length of the orbit's end over that of the bail-out radius, less a half: negative inside of the set,
    /// infinite if the end is not a number.
    pub(super) value: f64,
    /// There is no surface nearer than this, by an estimate or a proof.
    pub(super) reach: f64,
}

/// How many points of a line are looked at together: two vectors. The steps of an orbit wait for each other, so that two vectors take hardly
/// longer than one.
pub(super) const LINE_BATCH: usize = 8;

/// How several points of a line lie to the surface, as [`Place`]s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Places {
    pub(super) values: [f64; LINE_BATCH],
    pub(super) reaches: [f64; LINE_BATCH],
}

/// What is the same for all sets: the ball that they are searched in, and what is known of it.
#[derive(Clone, Debug)]
pub(super) struct BallSearch {
    pub(super) around: Container,
    pub(super) radius: f64,
    /// The least step.
    pub(super) shortest: f64,
    pub(super) octree: Arc<Octree>,
}

impl BallSearch {
    /// In the ball around the origin, in an octree whose cells are halved `levels` times; features smaller than a fiftieth of the
    /// reciprocal of `precision` may be missed. The set lies within `reach`, which is not above the radius.
    pub(super) fn new(radius: f64, reach: f64, precision: f64, levels: u32) -> Self {
        let precision = if precision > 1.0 { precision } else { 1.0 };
        Self {
            around: Container::Sphere(Sphere::new(DVec3::ZERO, reach)),
            radius,
            shortest: radius / (50.0 * precision),
            octree: Arc::new(Octree::new(
                Aabb::new(DVec3::splat(-reach), DVec3::splat(reach)),
                levels,
            )),
        }
    }

    pub(super) fn bounds(&self) -> Aabb {
        self.around.bounds()
    }
}

/// A set of points whose orbits stay near the origin.
pub(super) trait OrbitSet: Sized {
    /// The ball around the set.
    fn search(&self) -> &BallSearch;
    /// The [`Place::value`] of a point.
    fn value(&self, p: DVec3) -> f64;
    /// How a point lies to the surface.
    fn place(&self, p: DVec3) -> Place;
    /// Stores how points of a line lie to the surface, those at `origin + direction s`, if that takes little more time than one;
    /// else does nothing and returns `false`.
    // In place: a result of this size would be read before its stores have ended.
    fn store_places(
        &self,
        _line: (DVec3, DVec3),
        _s: &[f64; LINE_BATCH],
        _out: &mut Places,
    ) -> bool {
        false
    }
    /// Whether the points up to this distance from a point are all inside of the set or all outside.
    fn is_decided(&self, center: DVec3, radius: f64) -> bool;
    /// The gradient of the value.
    fn gradient(&self, p: DVec3) -> DVec3;
    /// A bound of the relative rounding error of an orbit's points.
    fn rounding(&self) -> f64;
    /// A bound of the rounding error of the value.
    fn noise(&self, p: DVec3) -> f64;
    /// The length of a direction as [`Place::reach`] counts it.
    fn speed(&self, direction: DVec3) -> f64 {
        direction.length()
    }
}
