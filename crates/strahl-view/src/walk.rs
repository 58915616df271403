//! The way of a ray through an accelerator as data.

use serde_json::{Value, json};
use strahl::accel::{Exit, Place};
use strahl::math::{Aabb, DVec3};
use strahl::prelude::{Ray, RenderScene};
use strahl::tracing::{RayWalk, WalkEvent, walk};

/// The way of a ray: its events, its cost, and what it hits.
pub(crate) fn walk_json(scene: &RenderScene, ray: &Ray) -> Value {
    let way = walk(scene, ray);
    json!({
        "accelerator": scene.accelerator_name(),
        "ray": { "origin": point(ray.origin), "direction": point(ray.direction) },
        "events": walk_events(scene, &way),
        "steps": way.stats.node_visits,
        "tests": way.stats.primitive_tests,
        "hit": way.hit.map(|h| json!({ "t": h.t, "element": h.id })),
    })
}

/// The events of a ray's way through an accelerator, as `strahl trace-ray --json` prints them.
pub fn walk_events(scene: &RenderScene, way: &RayWalk) -> Vec<Value> {
    let event = |event: &WalkEvent| match event {
        WalkEvent::Step(step) => {
            let (kind, place) = match step.place {
                Place::Node(b) => ("node", bounds(&b)),
                Place::Leaf(b) => ("leaf", bounds(&b)),
                Place::Sphere(c, r) => ("sphere", json!({ "center": point(c), "radius": r })),
                Place::LeafSphere(c, r) => {
                    ("leaf sphere", json!({ "center": point(c), "radius": r }))
                }
                Place::Cell(index, b) => (
                    "cell",
                    json!({ "index": index, "min": point(b.min), "max": point(b.max) }),
                ),
                Place::Empty(b) => ("empty block", bounds(&b)),
                _ => ("place", Value::Null),
            };
            json!({
                "event": kind,
                "place": place,
                "level": step.level,
                "near": number(step.near),
                "far": number(step.far),
                "exit": step.exit.map(|e| json!({ "face": face(&e), "region": e.region })),
            })
        }
        WalkEvent::Test {
            id,
            object,
            closest,
            found,
        } => {
            let info = scene.objects().get(*object);
            let info = info.as_ref();
            json!({
                "event": "test",
                "element": id,
                "object": object,
                "kind": info.map(|i| i.kind),
                "name": info.and_then(|i| i.name.as_deref()),
                "hit": found.then_some(closest),
            })
        }
        WalkEvent::Enter { id } => json!({ "event": "enter instance", "element": id }),
        WalkEvent::Leave => json!({ "event": "leave instance" }),
    };
    way.events.iter().map(event).collect()
}

fn face(exit: &Exit) -> &'static str {
    match (exit.axis, exit.up) {
        (0, true) => "+x",
        (0, false) => "-x",
        (1, true) => "+y",
        (1, false) => "-y",
        (_, true) => "+z",
        (_, false) => "-z",
    }
}

fn bounds(b: &Aabb) -> Value {
    json!({ "min": point(b.min), "max": point(b.max) })
}

fn point(p: DVec3) -> [f64; 3] {
    p.to_array()
}

/// JSON has no infinity: it becomes null.
fn number(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}
