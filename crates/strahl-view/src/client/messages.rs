//! What a page's settings mean, and what it is told about scenes and pictures.

use crate::hub::{Defaults, Hub};
use crate::pictures::{Kind, Picture};
use crate::protocol::{
    CameraData, DEEPEST, LONGEST_SIDE, MOST_LIGHTS, MOST_PIXELS, MovedLight, Settings, Slot,
};
use crate::scenes::{Compiled, Key, Request};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;
use strahl::prelude::*;
use strahl::sdl::Texts;
use strahl::tracing::{light_kind, light_position};

/// The size of pictures for which nobody has another.
const USUAL_SIZE: (u32, u32) = (800, 600);

/// Whether settings of a page make sense.
pub(super) fn check(settings: &Settings) -> Result<(), String> {
    if let Some([width, height]) = settings.size {
        check_size(width, height)?;
    }
    if settings
        .depth
        .is_some_and(|depth| !(1..=DEEPEST).contains(&depth))
    {
        return Err(format!("the depth is a number from 1 to {DEEPEST}"));
    }
    if settings
        .cutoff
        .is_some_and(|cutoff| !(0.0..=1.0).contains(&cutoff))
    {
        return Err("the cutoff is a number from 0 to 1".into());
    }
    if !(-30.0..=30.0).contains(&settings.exposure) {
        return Err("the exposure is a number from -30 to 30".into());
    }
    if let Some(sampling) = &settings.sampling {
        sampling.parse::<Sampling>().map_err(|e| e.to_string())?;
    }
    if let Some(shading) = &settings.shading {
        shading.parse::<ShadingModel>().map_err(|e| e.to_string())?;
    }
    if let Some(accelerator) = &settings.accelerator {
        // Not with any parameters: a page may not ask for a grid of any size.
        if !accelerators().any(|name| name == accelerator) {
            return Err(format!("there is no accelerator `{accelerator}`"));
        }
    }
    if settings.lights.len() > MOST_LIGHTS {
        return Err(format!("at most {MOST_LIGHTS} lights are moved"));
    }
    if settings.clock.is_some_and(|clock| !clock.is_finite()) {
        return Err("the clock is a number".into());
    }
    Ok(())
}

/// The accelerators that a page may ask for: all of them, and the octree with each of its ways through cells.
pub(super) fn accelerators() -> impl Iterator<Item = &'static str> {
    const WAYS: [&str; 3] = [
        "octree:traversal=exit-face",
        "octree:traversal=trial-plane",
        "octree:traversal=neighbours",
    ];
    let all = AcceleratorKind::ALL.iter().map(|kind| kind.name());
    all.chain(WAYS)
}

fn check_size(width: u32, height: u32) -> Result<(), String> {
    let pixels = u64::from(width) * u64::from(height);
    let sides = 1..=LONGEST_SIDE;
    match sides.contains(&width) && sides.contains(&height) && pixels <= MOST_PIXELS {
        true => Ok(()),
        false => Err(format!(
            "the viewer shows pictures of at most {LONGEST_SIDE} pixels a side and {MOST_PIXELS} in all, not {width} x {height}"
        )),
    }
}

/// The scene that settings ask for.
pub(super) fn key_of(path: &Path, texts: &Texts, settings: &Settings, defaults: &Defaults) -> Key {
    let named = settings.accelerator.as_ref();
    let accelerator = named.and_then(|name| name.parse().ok());
    Key {
        request: Request {
            path: path.to_owned(),
            texts: texts.clone(),
            size: settings.size.map(Into::into).or(defaults.size),
            clock: settings.clock.unwrap_or(defaults.clock),
        },
        accelerator: accelerator.unwrap_or(defaults.accelerator),
    }
}

/// The view that settings ask for. They have been checked.
///
/// # Errors
/// The scene asks for a picture that is too large.
pub(super) fn view_of(
    scene: &Arc<RenderScene>,
    camera: &Camera,
    settings: &Settings,
    hub: &Hub,
) -> Result<View, String> {
    let defaults = &hub.defaults;
    let size = settings.size.map(Into::into).or(defaults.size);
    let (width, height) = size.or(scene.settings().size).unwrap_or(USUAL_SIZE);
    check_size(width, height)?;
    let mut view = moved(scene, &settings.lights)
        .view(width, height)
        .with_camera(camera.clone());
    let sampling = settings.sampling.as_ref().and_then(|s| s.parse().ok());
    view.sampling = sampling.unwrap_or(defaults.sampling);
    if settings.channel.kind() != Kind::Color {
        // One ray per pixel shows its values.
        view.sampling = Sampling::Center;
    }
    view.seed = defaults.seed;
    view.trace.max_tree_rays = defaults.max_tree_rays;
    let shading = settings.shading.as_ref().and_then(|s| s.parse().ok());
    view.trace.force_shading = shading.or(defaults.shading);
    if let Some(depth) = settings.depth.or(defaults.depth) {
        view.trace.max_depth = depth;
    }
    if let Some(cutoff) = settings.cutoff.or(defaults.cutoff) {
        view.trace.adc_bailout = cutoff;
    }
    if let Some(camera) = &settings.camera {
        view.camera = camera.apply(&view.camera);
    }
    Ok(view)
}

/// The scene with lights at other positions. Lights that it doesn't have, because it has changed meanwhile, are passed over.
pub(super) fn moved(scene: &Arc<RenderScene>, lights: &[MovedLight]) -> Arc<RenderScene> {
    let mut scene = Arc::clone(scene);
    for moved in lights {
        if let Some(other) = scene.with_light_at(moved.light, moved.position.into()) {
            scene = Arc::new(other);
        }
    }
    scene
}

/// The first lights of a scene.
fn lights(scene: &RenderScene) -> Vec<Value> {
    let lights = scene.lights().iter().take(MOST_LIGHTS).enumerate();
    let told = lights.map(|(number, one)| {
        let ("at", position) = light_position(&one.light) else {
            return Value::Null;
        };
        let place = scene.sources().locate(one.span);
        json!({
            "name": scene.light_name(number as u32),
            "kind": light_kind(&one.light),
            "position": position.to_array(),
            "file": place.as_ref().map(|place| place.file),
            "line": place.as_ref().map(|place| place.span.line),
        })
    });
    told.collect()
}

pub(super) fn scene_message(
    slot: Slot,
    title: &str,
    compiled: Option<&Compiled>,
    loading: bool,
) -> Value {
    let files = compiled.map_or(&[][..], |compiled| &compiled.files);
    let shown = files.iter().filter(|file| file.is_text());
    let stats = compiled.and_then(|compiled| {
        let scene = compiled.scene.as_ref()?;
        let (stats, bounds) = (scene.stats(), scene.bounds());
        Some(json!({
            "objects": scene.objects().len(),
            "primitives": stats.primitives,
            "lights": scene.lights().len(),
            "accelerator": scene.accelerator_name(),
            "low": bounds.min.to_array(),
            "high": bounds.max.to_array(),
            "placed": lights(scene),
        }))
    });
    json!({
        "type": "scene",
        "slot": slot,
        "name": title,
        "number": compiled.map(|compiled| compiled.number),
        "loading": loading,
        "said": compiled.map(|compiled| &compiled.said),
        "files": shown.map(|file| json!({ "name": file.name, "built_in": file.built_in.is_some() })).collect::<Vec<_>>(),
        "seconds": compiled.map(|compiled| compiled.seconds),
        "stats": stats,
        "clock": compiled.is_some_and(|compiled| compiled.clock),
    })
}

pub(super) fn picture_message(slot: Slot, picture: &Picture, own: &Camera) -> Value {
    let view = &picture.view;
    json!({
        "type": "picture",
        "slot": slot,
        "picture": picture.number,
        "width": view.width,
        "height": view.height,
        "sampling": view.sampling.to_string(),
        "depth": view.trace.max_depth,
        "cutoff": view.trace.adc_bailout,
        "camera": CameraData::of(&view.camera),
        "own_camera": CameraData::of(own),
        "aspect": view.camera.aspect,
    })
}
