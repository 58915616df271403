//! Where the time of a picture goes: by kind of ray, phase, object, texture, light and kind of primitive.

use crate::activity::{Activities, Activity, Phase, RayPurpose};
use crate::names::light_kind;
use crate::prim::PrimKind;
use crate::scene::RenderScene;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Counts of what threads were found doing.
///
/// Each sample of a thread counts one. If samples are taken at equal intervals, the share of an activity among all samples is
/// its share of the time, with a standard error of about the square root of its count.
#[derive(Clone, Debug, Default)]
pub struct Profile {
    counts: HashMap<Activity, u64>,
}

/// The result of a [`Profile`], in the names and places of a scene. All lists are sorted from the most to the fewest samples.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProfileReport {
    /// The number of samples, of all threads together.
    pub samples: u64,
    /// By what the threads did.
    pub phases: Vec<Part>,
    /// By the ray that they worked for.
    pub rays: Vec<Part>,
    /// By the kind of primitive that was intersected. Triangles, polygons and spheres that are stored side by side count as
    /// traversal.
    pub primitives: Vec<Part>,
    /// By object: its intersections, surfaces, textures and shading. Objects of the same name and place count as one.
    pub objects: Vec<Part>,
    /// By texture: its evaluation.
    pub textures: Vec<Part>,
    /// By light: all work for its shadow rays.
    pub lights: Vec<Part>,
}

/// What has a part of the time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// A name: `sphere "ball"`, `shadow rays`.
    pub name: String,
    /// The place in the scene's files, as `file:line:column`; of a texture that of the object which has it most often.
    pub place: Option<String>,
    /// The number of objects that were met, if it stands for objects.
    pub objects: Option<usize>,
    /// The number of samples.
    pub samples: u64,
    /// The samples divided by those of the whole profile, from 0 to 1.
    pub share: f64,
}

/// What a profile needs of an element.
#[derive(Clone, Copy)]
struct Element {
    object: u32,
    material: u32,
    primitive: &'static str,
}

impl Profile {
    /// Takes a sample of each thread.
    pub fn sample(&mut self, activities: &Activities) {
        for activity in activities.now() {
            *self.counts.entry(activity).or_default() += 1;
        }
    }

    /// The profile of a picture of this scene.
    pub fn report(&self, scene: &RenderScene) -> ProfileReport {
        let samples = self.counts.values().sum();
        let mut tables = Tables::default();
        let mut known = HashMap::new();
        for (activity, &count) in &self.counts {
            let element = activity
                .element
                // Numbers from elsewhere are left out: they can't be found in the scene.
                .filter(|id| *id < scene.groups.first().map_or(0, |world| world.count))
                .map(|id| *known.entry(id).or_insert_with(|| Element::of(scene, id)));
            tables.add(scene, activity, element, count);
        }
        tables.report(scene, samples)
    }
}

impl Element {
    fn of(scene: &RenderScene, id: u64) -> Self {
        let at = scene.locate(id);
        let appearance = at.group.appearance(at.prim, at.element);
        let primitive = match at.group.prims.at(at.prim).kind() {
            PrimKind::Triangle(..) => "triangle",
            PrimKind::Sphere(_) => "sphere",
            PrimKind::Shape(index) | PrimKind::Placed(index) => {
                strahl_geometry::Primitive::kind(&at.group.shapes[index as usize].shape)
            }
            PrimKind::Instance(_) => "instance",
        };
        Self {
            object: appearance.object,
            material: appearance.material.0,
            primitive,
        }
    }
}

/// Sums of samples, by what they are shown as.
#[derive(Default)]
struct Tables {
    phases: BTreeMap<&'static str, u64>,
    rays: BTreeMap<&'static str, u64>,
    primitives: BTreeMap<&'static str, u64>,
    /// By name and place: the samples and the objects.
    objects: BTreeMap<(String, Option<String>), (u64, BTreeSet<u32>)>,
    /// By material: the samples, and those of each object.
    textures: BTreeMap<u32, (u64, BTreeMap<u32, u64>)>,
    lights: BTreeMap<u32, u64>,
}

impl Tables {
    fn add(
        &mut self,
        scene: &RenderScene,
        activity: &Activity,
        element: Option<Element>,
        count: u64,
    ) {
        let phase = match activity.phase {
            Phase::Sampling => "sampling",
            Phase::Traversal => "traversal",
            Phase::Intersection => "intersection",
            Phase::Surface => "surfaces",
            Phase::Texture => "textures",
            Phase::Shading => "shading",
        };
        *self.phases.entry(phase).or_default() += count;
        let ray = match activity.ray {
            RayPurpose::Primary => "primary rays",
            RayPurpose::Reflection => "reflection rays",
            RayPurpose::Refraction => "transparency rays",
            RayPurpose::Gather => "gather rays",
            RayPurpose::Shadow(light) => {
                *self.lights.entry(light).or_default() += count;
                "shadow rays"
            }
        };
        *self.rays.entry(ray).or_default() += count;
        let Some(element) = element else {
            return;
        };
        let mut name = scene.object_name(element.object);
        if activity.phase == Phase::Intersection {
            *self.primitives.entry(element.primitive).or_default() += count;
            if element.primitive == "csg" {
                // The whole tree is intersected; its first part says where it is.
                name = format!("csg of {name}");
            }
        }
        let place = scene.object_place(element.object, None);
        let object = self.objects.entry((name, place)).or_default();
        object.0 += count;
        object.1.insert(element.object);
        if activity.phase == Phase::Texture {
            let texture = self.textures.entry(element.material).or_default();
            texture.0 += count;
            *texture.1.entry(element.object).or_default() += count;
        }
    }

    fn report(self, scene: &RenderScene, samples: u64) -> ProfileReport {
        let part = |name: String, place, objects, count: u64| Part {
            name,
            place,
            objects,
            samples: count,
            share: count as f64 / samples.max(1) as f64,
        };
        let named = |table: BTreeMap<&'static str, u64>| {
            let rows = table.into_iter();
            sorted(rows.map(|(name, count)| part(name.to_owned(), None, None, count)))
        };
        let objects = self.objects.into_iter();
        let objects =
            objects.map(|((name, place), (count, all))| part(name, place, Some(all.len()), count));
        let textures = self.textures.into_iter();
        let textures = textures.map(|(material, (count, objects))| {
            let most = objects.iter().max_by_key(|(_, count)| **count);
            let place = most.and_then(|(object, _)| scene.object_place(*object, None));
            let name = scene.material_name(material);
            part(name, place, Some(objects.len()), count)
        });
        let lights = self.lights.into_iter().map(|(light, count)| {
            let kind = scene.lights.get(light as usize);
            let kind = kind.map_or("", |described| light_kind(&described.light));
            let name = format!("{}, {kind}", scene.light_name(light));
            part(name, scene.light_place(light), None, count)
        });
        ProfileReport {
            samples,
            phases: named(self.phases),
            rays: named(self.rays),
            primitives: named(self.primitives),
            objects: sorted(objects),
            textures: sorted(textures),
            lights: sorted(lights),
        }
    }
}

/// The parts with the most samples first.
fn sorted(parts: impl Iterator<Item = Part>) -> Vec<Part> {
    let mut parts: Vec<Part> = parts.collect();
    // Stable: equal ones stay in the order of their names.
    parts.sort_by_key(|part| std::cmp::Reverse(part.samples));
    parts
}
