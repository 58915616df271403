use crate::args::SceneArgs;
use crate::input::Input;
use crate::memory;
use crate::output::say;
use crate::report::{Failure, Reporter};
use crate::words::{counted, triple};
use std::collections::BTreeMap;
use strahl::accel::AcceleratorKind;
use strahl::shade::LightKind;
use strahl::tracing::{Prepared, RenderScene};

/// `strahl info`: prints the contents of a scene.
pub(crate) fn run(args: &SceneArgs) -> Result<(), Failure> {
    let (input, reporter) = (Input::of(args)?, Reporter::new(false));
    let description = input.load(input.still(), &reporter)?;
    let prepared = match Prepared::new(&description) {
        Ok(prepared) => prepared,
        Err(errors) => {
            reporter.print(&errors.0, Some(&description.sources));
            return Err(Failure::Reported);
        }
    };
    let staged = input.is_staged();
    let (own_camera, own_lights) = (
        description.camera.is_some() && !staged,
        !description.lights.is_empty() && !staged,
    );
    let scene = prepared.build(AcceleratorKind::default());
    say!("scene       {}", input.name());
    objects(&scene);
    if staged {
        say!("studio      a ground, a camera and three lights were added: the file has none");
    }
    view(&scene, own_camera, own_lights);
    let s = scene.stats();
    say!("materials   {}", s.materials);
    say!(
        "memory      geometry {}, {} {} ({}, {})",
        memory::size(s.geometry_bytes),
        scene.accelerator_name(),
        memory::size(s.accelerator_bytes),
        counted(s.nodes as u64, "node"),
        counted(s.references as u64, "reference"),
    );
    Ok(())
}

fn objects(scene: &RenderScene) {
    let s = scene.stats();
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    for object in scene.objects().iter() {
        *kinds.entry(object.kind).or_default() += 1;
    }
    let kinds: Vec<String> = kinds
        .iter()
        .map(|(kind, count)| format!("{count} {kind}"))
        .collect();
    let kinds = if kinds.is_empty() {
        String::new()
    } else {
        format!(": {}", kinds.join(", "))
    };
    say!("objects     {}{kinds}", s.objects);
    say!(
        "primitives  {} stored, {} with instances expanded",
        s.primitives,
        s.elements
    );
    if s.instances > 0 {
        say!("instances   {}", s.instances);
    }
    let b = scene.bounds();
    if b.is_empty() {
        say!("bounds      none");
    } else {
        say!(
            "bounds      {} to {}, size {}",
            triple(b.min),
            triple(b.max),
            triple(b.size())
        );
    }
}

fn view(scene: &RenderScene, own_camera: bool, own_lights: bool) {
    let c = scene.camera();
    let kind = c.projection.name();
    let chosen = if own_camera {
        ""
    } else {
        " (chosen to frame the objects)"
    };
    say!(
        "camera      {kind}, eye {}, direction {}{chosen}",
        triple(c.eye),
        triple(c.direction)
    );
    if let Some((w, h)) = scene.settings().size {
        say!("size        {w}x{h}");
    }
    for light in scene.lights() {
        let place = match light.light.kind {
            LightKind::Point { position } => format!("point light at {}", triple(position)),
            LightKind::Directional { direction } => {
                format!("directional light along {}", triple(direction))
            }
            LightKind::Spot { position, .. } => format!("spot light at {}", triple(position)),
            LightKind::Parallel { direction, .. } => {
                format!("parallel light along {}", triple(direction))
            }
            LightKind::Beam { position, .. } => format!("beam of light from {}", triple(position)),
            _ => "light".to_owned(),
        };
        let c = light.light.color;
        let chosen = if own_lights { "" } else { " (added)" };
        say!(
            "light       {place}, colour {} {} {}{chosen}",
            c.r,
            c.g,
            c.b
        );
    }
}
