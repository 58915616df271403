//! The reported path of a ray through a structure.

use crate::hits::{Closest, hit_box};
use crate::kinds;
use crate::scenes::{Rng, boxes, ray};
use strahl_accel::{Accelerator, AnyAccelerator, Place, Step, TraversalStats, Visitor};
use strahl_math::{Aabb, DVec3, Interval, Ray};

/// Looks for the closest hit and records the reported steps.
struct Watcher<'a> {
    closest: Closest<'a>,
    events: Vec<Event>,
}

enum Event {
    Step(Step),
    Visit(u32),
}

impl Visitor for Watcher<'_> {
    const WATCHES: bool = true;

    fn visit(&mut self, id: u32, t_max: f64) -> f64 {
        self.events.push(Event::Visit(id));
        self.closest.visit(id, t_max)
    }

    fn step(&mut self, step: Step) {
        self.events.push(Event::Step(step));
    }
}

fn closest<'a>(boxes: &'a [Aabb], ray: &Ray) -> Closest<'a> {
    Closest {
        hit: hit_box,
        boxes,
        ray: *ray,
        t_min: 0.0,
        best: None,
    }
}

/// A scene, rays through it, and the steps reported for each.
fn watched(
    accelerator: &AnyAccelerator,
    boxes: &[Aabb],
    see: impl Fn(&Ray, &[Event], TraversalStats),
) {
    let mut rng = Rng(9);
    for _ in 0..300 {
        let ray = ray(&mut rng, boxes, DVec3::ZERO, 1.0);
        if ray.direction == DVec3::ZERO {
            continue;
        }
        let (mut alone, mut stats) = (closest(boxes, &ray), TraversalStats::default());
        accelerator.traverse(&ray, Interval::FORWARD, &mut alone, &mut stats);
        let mut watcher = Watcher {
            closest: closest(boxes, &ray),
            events: Vec::new(),
        };
        let mut told = TraversalStats::default();
        accelerator.traverse(&ray, Interval::FORWARD, &mut watcher, &mut told);
        assert_eq!((watcher.closest.best, told), (alone.best, stats), "{ray:?}");
        see(&ray, &watcher.events, stats);
    }
}

fn bounded(seed: u64, count: usize) -> Vec<Aabb> {
    let mut boxes = boxes(&mut Rng(seed), count, DVec3::ZERO, 1.0);
    boxes.retain(|b| b.is_bounded());
    boxes
}

/// Whether a box lies in another, up to f32 rounding.
fn within(inner: &Aabb, outer: &Aabb) -> bool {
    let outer = outer.padded(DVec3::splat(1e-6));
    outer.contains(inner.min) && outer.contains(inner.max)
}

#[test]
fn watching_changes_nothing_and_all_but_the_list_tell_of_places() {
    let boxes = bounded(10, 200);
    for kind in kinds() {
        let accelerator = AnyAccelerator::build(kind, &boxes);
        let steps = std::cell::Cell::new(0);
        watched(&accelerator, &boxes, |_, events, stats| {
            let visits = events.iter().filter(|e| matches!(e, Event::Visit(_)));
            assert_eq!(visits.count() as u64, stats.primitive_tests, "{kind}");
            let told = events.iter().filter(|e| matches!(e, Event::Step(_)));
            steps.set(steps.get() + told.count());
        });
        assert_eq!(steps.get() == 0, kind.name() == "list", "{kind}");
    }
}

/// Top-down: the box of every step lies in that of an earlier node one level up, and primitives lie in the last leaf.
#[test]
fn trees_of_boxes_tell_of_every_node() {
    let boxes = bounded(11, 300);
    for name in ["bvh", "bvh2"] {
        let kind = name.parse().expect("an accelerator");
        let accelerator = AnyAccelerator::build(kind, &boxes);
        watched(&accelerator, &boxes, |ray, events, stats| {
            let mut nodes: Vec<(u32, Aabb)> = Vec::new();
            let mut leaf = Aabb::EMPTY;
            for event in events {
                match event {
                    Event::Visit(id) => {
                        assert!(within(&boxes[*id as usize], &leaf), "{name} {ray:?}");
                    }
                    Event::Step(step) => {
                        let (Place::Node(own) | Place::Leaf(own)) = step.place else {
                            panic!("{name} told of {step:?}");
                        };
                        let parent = nodes
                            .iter()
                            .find(|(level, b)| level + 1 == step.level && within(&own, b));
                        assert_eq!(parent.is_none(), step.level == 0, "{name} {step:?}");
                        assert!(!(step.near > step.far), "{name} {step:?}");
                        match step.place {
                            Place::Node(_) => nodes.push((step.level, own)),
                            _ => leaf = own,
                        }
                    }
                }
            }
            assert_eq!(nodes.len() as u64, stats.node_visits, "{name} {ray:?}");
        });
    }
}
