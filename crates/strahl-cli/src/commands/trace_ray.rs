use crate::args::TraceRayArgs;
use crate::input::{DEFAULT_SIZE, Input};
use crate::output::say;
use crate::report::{Failure, Reporter};
use crate::words::{counted, fixed, triple};
use serde_json::json;
use strahl::accel::{Exit, Place, Step};
use strahl::math::{Aabb, DVec3};
use strahl::tracing::{PrimaryRays, RayWalk, RenderScene, WalkEvent, walk};

/// `strahl trace-ray`: prints the path of a ray through an accelerator.
pub(crate) fn run(args: &TraceRayArgs) -> Result<(), Failure> {
    let (input, reporter) = (Input::of(&args.scene)?, Reporter::new(false));
    let (scene, _) = input.compiled(input.still(), &args.accelerator, &reporter)?;
    let (width, height) = args.size.or(scene.settings().size).unwrap_or(DEFAULT_SIZE);
    let (x, y) = args.pixel;
    if x >= width || y >= height {
        return Err(Failure::new(format!(
            "there is no pixel {x},{y} in a picture of {width}x{height} pixels"
        )));
    }
    let rays = PrimaryRays::new(scene.camera(), width, height);
    let ray = rays.ray(f64::from(x) + 0.5, f64::from(y) + 0.5);
    let ray =
        ray.ok_or_else(|| Failure::new(format!("the camera has no ray through pixel {x},{y}")))?;
    let way = walk(&scene, &ray);
    let kind = args.accelerator.kind();
    if args.json {
        let all = json!({
            "pixel": [x, y],
            "size": [width, height],
            "accelerator": kind.to_string(),
            "ray": { "origin": point(ray.origin), "direction": point(ray.direction) },
            "events": strahl_view::walk_events(&scene, &way),
            "steps": way.stats.node_visits,
            "tests": way.stats.primitive_tests,
            "hit": way.hit.map(|h| json!({ "t": h.t, "element": h.id })),
        });
        say!("{all:#}");
        return Ok(());
    }
    say!("pixel {x},{y} of {width}x{height}, accelerator {kind}");
    say!(
        "ray   from {} along {}",
        triple(ray.origin),
        triple(ray.direction)
    );
    print_events(&scene, &way);
    match way.hit {
        Some(hit) => say!("hit   t = {}", hit.t),
        None => say!("hit   none"),
    }
    say!(
        "cost  {}, {}",
        counted(way.stats.node_visits, "step"),
        counted(way.stats.primitive_tests, "test")
    );
    Ok(())
}

fn print_events(scene: &RenderScene, way: &RayWalk) {
    // Tests are listed below the leaf in which they are made.
    let (mut depth, mut level, mut inside) = (0, 0, Vec::new());
    for event in &way.events {
        let indent = "  ".repeat(depth);
        match event {
            WalkEvent::Step(step) => {
                level = step.level as usize;
                say!("{indent}{}", describe(step));
            }
            WalkEvent::Test {
                id,
                object,
                found,
                closest,
            } => {
                let Some(object) = scene.objects().get(*object) else {
                    continue;
                };
                let name = object.name.as_deref().unwrap_or("");
                let outcome = match (found, closest) {
                    (true, Some(t)) => format!("hit at t = {t}"),
                    _ => "no closer hit".to_owned(),
                };
                say!(
                    "{indent}{}  test {} {name} (element {id}): {outcome}",
                    "  ".repeat(level),
                    object.kind
                );
            }
            WalkEvent::Enter { id } => {
                say!(
                    "{indent}{}  instance (elements from {id}):",
                    "  ".repeat(level)
                );
                depth += level + 2;
                inside.push(level);
            }
            WalkEvent::Leave => {
                level = inside.pop().unwrap_or(0);
                depth = depth.saturating_sub(level + 2);
            }
        }
    }
}

/// A step in words: the cell or node, its interval on the ray, and where the ray leaves it.
fn describe(step: &Step) -> String {
    let place = match step.place {
        Place::Node(b) => format!("node {}", extent(&b)),
        Place::Leaf(b) => format!("leaf {}", extent(&b)),
        Place::Sphere(c, r) => format!("sphere around {} radius {r:.6}", triple(c)),
        Place::LeafSphere(c, r) => format!("leaf sphere around {} radius {r:.6}", triple(c)),
        Place::Cell([x, y, z], b) => format!("cell {x},{y},{z} {}", extent(&b)),
        Place::Empty(b) => format!("empty block {}", extent(&b)),
        _ => "place".to_owned(),
    };
    let range = if step.far.is_finite() {
        format!("t {} to {}", fixed(step.near), fixed(step.far))
    } else {
        format!("t from {}", fixed(step.near))
    };
    let exit = step.exit.map_or(String::new(), |exit| {
        let region = exit
            .region
            .map_or(String::new(), |r| format!(", region {r}"));
        format!(", exit {}{region}", face(&exit))
    });
    format!("{}{place}, {range}{exit}", "  ".repeat(step.level as usize))
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

fn point(p: DVec3) -> [f64; 3] {
    p.to_array()
}

fn extent(b: &Aabb) -> String {
    format!("{} to {}", triple(b.min), triple(b.max))
}
