use crate::hit::{Hit, RayClass};
use crate::query::Tracer;
use crate::scene::RenderScene;
use strahl_accel::{Step, TraversalStats};
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

/// An event of the traversal.
#[derive(Clone, Copy, Debug)]
pub enum WalkEvent {
    /// The accelerator visited a node or a cell; if it is a leaf, the following events belong to it.
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
    /// An instance was entered; the following events are in its space, whose `t` is the same.
    Enter {
        /// Number of its first element.
        id: u64,
    },
    /// The instance was left.
    Leave,
}

/// Searches the closest hit of a camera ray and records every node, cell and test on the way.
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
