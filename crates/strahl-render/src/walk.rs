use crate::hit::{Hit, RayClass};
use crate::query::{Intersector, WalkEvent};
use crate::scene::RenderScene;
use strahl_accel::TraversalStats;
use strahl_math::{Interval, Ray};

/// The traversal of the accelerator by one ray that searches its closest hit, in order.
#[derive(Clone, Debug, Default)]
pub struct RayWalk {
    /// The events.
    pub events: Vec<WalkEvent>,
    /// The closest hit.
    pub hit: Option<Hit>,
    /// The cost of the search.
    pub stats: TraversalStats,
}

/// Searches the closest hit of a camera ray and records every node, cell and test on the way.
pub fn walk(scene: &RenderScene, ray: &Ray) -> RayWalk {
    let mut intersector = Intersector::new(scene);
    let mut events = Vec::new();
    let hit = intersector.watched_hit(ray, Interval::FORWARD, RayClass::Camera, &mut events);
    RayWalk {
        events,
        hit,
        stats: intersector.stats,
    }
}
