use crate::hit::{Hit, RayClass};
use crate::query::Tracer;
use crate::scene::RenderScene;
use strahl_accel::{Step, TraversalStats};
use strahl_math::{Interval, Ray};

/// What happened while the closest hit of one ray was searched, in order.
#[derive(Clone, Debug, Default)]
pub struct RayWalk {
    /// The stations.
    pub events: Vec<WalkEvent>,
    /// The closest hit.
    pub hit: Option<Hit>,
    /// What the search cost.
    pub stats: TraversalStats,
}

/// Something that happened on the way.
#[derive(Clone, Copy, Debug)]
pub enum WalkEvent {
    /// The accelerator looked at a node or a cell; what follows is in it, if it is a leaf.
    Step(Step),
    /// A primitive was tested.
    Test {
        /// Number of its first element.
        id: u64,
        /// Number of its object.
        object: u32,
        /// The closest hit so far, after the test; `None` if there is none.
        closest: Option<f64>,
        /// Whether the test found that hit.
        found: bool,
    },
    /// An instance was entered; what follows is in its space, whose `t` is the same.
    Enter {
        /// Number of its first element.
        id: u64,
    },
    /// It was left.
    Leave,
}

/// Follows a camera ray to its closest hit and tells every node, cell and test on the way.
pub fn walk(scene: &RenderScene, ray: &Ray) -> RayWalk {
    let mut tracer = Tracer::new(scene);
    let mut events = Vec::new();
    let hit = tracer.watched_hit(ray, Interval::FORWARD, RayClass::Camera, &mut events);
    RayWalk {
        events,
        hit,
        stats: tracer.stats,
    }
}
