//! From the description to a scene ready to be traced: passes from value to value.
//!
//! 1. [`flatten`]: the tree of objects becomes lists of primitives per group; unions are dissolved, transformations
//!    baked where that is exact, CSG trees built, everything validated.
//! 2. [`spaces`]: small objects far from the origin move into coordinate systems of their own.
//! 3. [`assemble`]: groups in order of dependence, with element numbers and bounds.
//! 4. [`view`]: camera and lights, if the scene has none.
//! 5. the acceleration structures ([`Prepared::build`]).

mod assemble;
mod bounds;
mod csg;
mod cut;
mod flatten;
mod inherit;
mod inside;
mod materials;
mod operation;
mod shapes;
mod spaces;
mod view;

use crate::blocks::Blocks;
use crate::light_sets::{LightSets, Lit};
use crate::objects::Objects;
use crate::prim::{Prim, PrimKind};
use crate::scene::{Part, RenderGroup, RenderScene};
use crate::uses::InstanceUse;
use assemble::Assembled;
use shapes::{Flagged, GroupShapes};
use std::sync::Arc;
use strahl_accel::{Accelerator, AcceleratorKind, AnyAccelerator};
use strahl_math::{Aabb, Transform};
use strahl_scene::{
    Background, BackgroundAlpha, Camera, Diagnostic, Fog, Problems, Rainbow, Scene, SceneLight,
    Settings, SourceMap,
};
use strahl_shade::{Color, Material};

/// How to compile a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CompileOptions {
    /// The acceleration structure.
    pub accelerator: AcceleratorKind,
}

/// A scene after all passes but the last: everything except the acceleration structures.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The world first, each before those it instances.
    groups: Vec<Assembled>,
    objects: Objects,
    materials: Vec<Arc<Material>>,
    /// Whether shadow rays pass through each of them.
    transmitting: Vec<bool>,
    texture_spaces: Vec<Transform>,
    lights: Vec<SceneLight>,
    light_sets: LightSets,
    masks: Vec<Option<InstanceUse>>,
    ambient: Color,
    background: Background,
    background_alpha: BackgroundAlpha,
    fogs: Vec<Fog>,
    rainbows: Vec<Rainbow>,
    camera: Camera,
    settings: Settings,
    sources: SourceMap,
    warnings: Vec<Diagnostic>,
}

/// Compiles a scene. [`Session::compile`](crate::Session::compile) returns the warnings too.
///
/// # Errors
/// All errors of the scene, each with its place.
pub fn compile(scene: &Scene, options: &CompileOptions) -> Result<RenderScene, Problems> {
    Ok(Prepared::new(scene)?.build(options.accelerator))
}

impl Prepared {
    /// All passes but the last.
    ///
    /// # Errors
    /// All errors of the scene, each with its place.
    pub fn new(scene: &Scene) -> Result<Self, Problems> {
        let mut flat = flatten::flatten(scene)?;
        spaces::open_spaces(&mut flat);
        let quality = scene.settings.quality;
        let mut masks = match quality.has_shadows() {
            true => masks(scene, &flat.lights)?,
            false => vec![],
        };
        let groups = assemble::assemble(flat.groups, flat.world, scene, &mut masks)?;
        let bounds = groups.first().map_or(Aabb::EMPTY, |world| world.bounds);
        let mut warnings = flat.diagnostics;
        let camera = match &scene.camera {
            Some(camera) => match camera.problem() {
                None => camera.clone(),
                Some(problem) => {
                    return Err(vec![Diagnostic::error(problem).at(camera.span)].into());
                }
            },
            None => view::frame(bounds),
        };
        if groups.first().is_none_or(|world| world.prims.is_empty()) {
            warnings.push(Diagnostic::warning(
                "the scene has no objects: the picture shows the background only",
            ));
        }
        let light_sets = flat
            .light_sets
            .finished(scene.lights.len(), flat.lights.len());
        let (mut lights, ambient) = view::lights(scene, flat.lights, &camera, bounds);
        for light in &mut lights {
            light.light = light.light.of_quality(quality);
        }
        let (fogs, rainbows) = match quality.has_air() {
            true => (scene.fogs.clone(), scene.rainbows.clone()),
            false => (vec![], vec![]),
        };
        let background_alpha = match scene.background {
            Some(_) => scene.background_alpha,
            None => BackgroundAlpha::LeftOut,
        };
        let background = match &scene.background {
            Some(background) => background.of_quality(quality),
            None => view::background(scene, &camera),
        };
        let (materials, transmitting) = flat.materials.into_lists();
        Ok(Self {
            groups,
            objects: flat.objects.completed(),
            materials,
            transmitting,
            texture_spaces: flat.texture_spaces,
            lights,
            light_sets,
            masks,
            ambient,
            background_alpha,
            background,
            fogs,
            rainbows,
            camera,
            settings: scene.settings,
            sources: scene.sources.clone(),
            warnings,
        })
    }

    /// The warnings.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }

    /// Builds the acceleration structures.
    pub fn build(self, kind: AcceleratorKind) -> RenderScene {
        let groups = self.groups.into_iter().map(|g| {
            let accelerator = AnyAccelerator::build_from(kind, &GroupShapes(&g));
            let blocks = Blocks::new(&accelerator, &g.lists());
            accelerator.gather_pages();
            blocks.gather_pages();
            let [stopping, transmitting] =
                [Prim::STOPS, Prim::TRANSMITS].map(|flag| part(kind, &g, flag));
            let uniform_flags = crate::blocks::uniform_flags(&g.lists());
            RenderGroup {
                uniform_flags,
                sheared: blocks.has_triangles() || !g.meshes.is_empty(),
                spheres: g
                    .spheres
                    .completed(accelerator.slots(), &g.prims, |block| blocks.place(block)),
                prims: g.prims,
                shapes: g.shapes,
                meshes: g.meshes,
                instances: g.instances,
                first_ids: g.first_ids,
                count: g.count,
                bounds: g.bounds,
                accelerator,
                blocks,
                stopping,
                transmitting,
            }
        });
        let air = !self.fogs.is_empty() || !self.rainbows.is_empty();
        let shows = |m: &Arc<Material>| materials::material_shows(m);
        let disperses = |m: &Arc<Material>| m.interior.as_ref().is_some_and(|i| i.disperses());
        RenderScene {
            disperses: self.materials.iter().any(disperses),
            fills: air || self.materials.iter().any(shows),
            groups: groups.collect(),
            objects: Arc::new(self.objects),
            uses_uv: self.materials.iter().map(|m| m.uses_uv()).collect(),
            materials: self.materials.into(),
            texture_spaces: self.texture_spaces.into(),
            lights: self.lights,
            light_sets: self.light_sets,
            masks: self.masks,
            ambient: self.ambient,
            opaque_background: self.background.opaque(self.background_alpha),
            background: self.background,
            background_alpha: self.background_alpha,
            fogs: self.fogs,
            rainbows: self.rainbows,
            camera: self.camera,
            settings: self.settings,
            sources: self.sources,
            transmits: self.transmitting.contains(&true),
            transmitting: self.transmitting.into(),
        }
    }
}

/// A separate accelerator over the primitives of a group that have a flag; `None` if these are so many that leaving out the
/// others does not pay.
fn part(kind: AcceleratorKind, group: &Assembled, flag: u8) -> Option<Box<Part>> {
    // The flags of a run are those of its first primitive.
    let flagged = || group.prims.runs().filter(|(p, _)| p.flags & flag != 0);
    let some: usize = flagged().map(|(_, places)| places.len()).sum();
    if 4 * some > 3 * group.prims.len() {
        return None;
    }
    let shapes = Flagged {
        all: GroupShapes(group),
        flag,
    };
    let accelerator = match some {
        0 => AnyAccelerator::build(kind, &[]),
        _ => AnyAccelerator::build_from(kind, &shapes),
    };
    let blocks = Blocks::new(&accelerator, &group.lists());
    accelerator.gather_pages();
    blocks.gather_pages();
    let is_triangle = |p: Prim| matches!(p.kind(), PrimKind::Triangle(..));
    Some(Box::new(Part {
        sheared: blocks.has_triangles() || flagged().any(|(p, _)| is_triangle(p)),
        accelerator,
        blocks,
    }))
}

/// The mask that the light of each light source has to pass through; empty if none has one.
fn masks(
    scene: &Scene,
    of_objects: &[SceneLight],
) -> Result<Vec<Option<InstanceUse>>, Vec<Diagnostic>> {
    let lights = || scene.lights.iter().chain(of_objects);
    if lights().all(|light| light.mask.is_none()) {
        return Ok(vec![]);
    }
    let masks = lights().map(|light| {
        let Some(mask) = light.mask.as_deref() else {
            return Ok(None);
        };
        let (id, count) = (mask.group.0, scene.groups.len());
        if id as usize >= count {
            let message =
                format!("a light has to cross group {id}, but the scene has {count} groups");
            return Err(vec![Diagnostic::error(message).at(light.span)]);
        }
        Ok(Some(InstanceUse {
            group: id,
            transform: mask.transform,
            lit: Lit::DEFAULT,
        }))
    });
    masks.collect()
}
