use crate::appearance::{Appearance, Appearances};
use crate::blocks::Blocks;
use crate::first_ids::FirstIds;
use crate::light_sets::LightSets;
use crate::objects::Objects;
use crate::prim::{Prim, PrimKind};
use crate::runs::RunList;
use crate::spheres::Spheres;
use crate::uses::{InstanceUse, MeshUse, ShapeUse};
use std::sync::Arc;
use strahl_accel::{Accelerator, AnyAccelerator};
use strahl_geometry::Shape;
use strahl_math::{Aabb, DVec3, Transform};
use strahl_scene::{
    Background, BackgroundAlpha, Camera, Fog, Rainbow, SceneLight, Settings, SourceMap,
};
use strahl_shade::{Color, Material};

/// A list of primitives with its accelerator: the world, an instanced group, or the separate space of small objects far from
/// the origin.
#[derive(Debug)]
pub(crate) struct RenderGroup {
    pub(crate) prims: RunList<Prim>,
    pub(crate) shapes: Vec<ShapeUse>,
    pub(crate) spheres: Spheres,
    pub(crate) meshes: Vec<MeshUse>,
    pub(crate) instances: Vec<InstanceUse>,
    /// First element number of each primitive, if some primitive has more than one element.
    pub(crate) first_ids: Option<FirstIds>,
    /// Number of elements, instances expanded.
    pub(crate) count: u64,
    pub(crate) bounds: Aabb,
    pub(crate) accelerator: AnyAccelerator,
    /// Separate accelerators for opaque and for transmitting primitives, where these save shadow rays work.
    pub(crate) stopping: Option<Box<Part>>,
    pub(crate) transmitting: Option<Box<Part>>,
    /// Visibility and flags of the primitives that are tested in blocks, if these are the same for all of them.
    pub(crate) uniform_flags: Option<(u8, u8)>,
    /// Whether it has triangles, which are tested with the shear of the ray.
    pub(crate) sheared: bool,
    /// The primitives in the order of the accelerator's leaves.
    pub(crate) blocks: Blocks,
}

/// Some of a group's primitives with a separate accelerator; the numbers are the group's.
#[derive(Debug)]
pub(crate) struct Part {
    pub(crate) accelerator: AnyAccelerator,
    pub(crate) blocks: Blocks,
    /// Whether it has triangles, which are tested with the shear of the ray.
    pub(crate) sheared: bool,
}

impl RenderGroup {
    /// The first element number of a primitive, relative to the group.
    #[inline]
    pub(crate) fn first_id(&self, prim: u32) -> u64 {
        match &self.first_ids {
            None => u64::from(prim),
            Some(ids) => ids.of(prim),
        }
    }

    /// The primitive an element belongs to; the number must be below `count`.
    #[inline]
    pub(crate) fn prim_of(&self, id: u64) -> u32 {
        match &self.first_ids {
            None => id as u32,
            Some(ids) => ids.prim_of(id),
        }
    }
}

/// A scene ready to be traced: immutable, `Sync`, ids instead of references. Copies share what is large.
#[derive(Clone, Debug)]
pub struct RenderScene {
    /// Group 0 is the world.
    pub(crate) groups: Arc<[RenderGroup]>,
    pub(crate) objects: Arc<Objects>,
    pub(crate) materials: Arc<[Arc<Material>]>,
    /// Whether shadow rays pass through each material.
    pub(crate) transmitting: Box<[bool]>,
    /// Whether each of them uses texture coordinates.
    pub(crate) uses_uv: Arc<[bool]>,
    /// Transforms from texture space to the group's space.
    pub(crate) texture_spaces: Arc<[Transform]>,
    pub(crate) lights: Vec<SceneLight>,
    pub(crate) light_sets: LightSets,
    /// By light, the group that its light has to pass through; empty if no light has one.
    pub(crate) masks: Vec<Option<InstanceUse>>,
    pub(crate) ambient: Color,
    pub(crate) background: Background,
    /// The same for pictures without an alpha channel.
    pub(crate) opaque_background: Background,
    /// How much of the background the alpha channel leaves out of the picture.
    pub(crate) background_alpha: BackgroundAlpha,
    pub(crate) fogs: Vec<Fog>,
    /// Whether some material has dispersion.
    pub(crate) disperses: bool,
    pub(crate) rainbows: Vec<Rainbow>,
    pub(crate) camera: Camera,
    pub(crate) settings: Settings,
    pub(crate) sources: SourceMap,
    /// Whether any material lets shadow rays pass.
    pub(crate) transmits: bool,
    /// Whether it matters to rays what the eye is inside of.
    pub(crate) fills: bool,
}

/// Sizes of a compiled scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneStats {
    /// Objects of the description that ended up in the scene.
    pub objects: usize,
    /// Primitives stored, instances not expanded.
    pub primitives: usize,
    /// Primitive elements, instances expanded.
    pub elements: u64,
    /// Instances, including the spaces of small objects far from the origin.
    pub instances: usize,
    /// Materials.
    pub materials: usize,
    /// Lights.
    pub lights: usize,
    /// Bytes of the acceleration structures.
    pub accelerator_bytes: usize,
    /// Nodes of the acceleration structures.
    pub nodes: usize,
    /// References from leaves to primitives.
    pub references: usize,
    /// Bytes of primitives, meshes and spheres. What other shapes keep beside themselves isn't counted: operands of CSG, functions, control points.
    pub geometry_bytes: usize,
    /// Bytes of names and places of objects.
    pub object_bytes: usize,
}

/// Where an element of the scene is: the chain of instances and the primitive.
pub(crate) struct Located<'s> {
    pub(crate) group: &'s RenderGroup,
    pub(crate) prim: u32,
    pub(crate) element: u32,
    /// Where the elements of the innermost instance begin; 0 in the world.
    pub(crate) space: u64,
}

impl RenderScene {
    /// The camera in use (the scene's, or one that frames the objects).
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The lights in use.
    pub fn lights(&self) -> &[SceneLight] {
        &self.lights
    }

    /// The same scene with one of its lights at another position, given by its number in [`RenderScene::lights`]. Nothing is built again. What the
    /// light looks like and the object it shines through stay where they are. `None` if there is no such light, or it has no position.
    #[must_use]
    pub fn with_light_at(&self, number: usize, position: DVec3) -> Option<Self> {
        let mut scene = self.clone();
        let light = &mut scene.lights.get_mut(number)?.light;
        *light = light.moved_to(position)?;
        Some(scene)
    }

    /// The group that a light has to pass through, if it is `projected_through` one.
    pub(crate) fn mask(&self, light: usize) -> Option<&InstanceUse> {
        self.masks.get(light)?.as_ref()
    }

    /// The ambient light Ia.
    pub fn ambient(&self) -> Color {
        self.ambient
    }

    /// The scene's own settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The files the scene was made from.
    pub fn sources(&self) -> &SourceMap {
        &self.sources
    }

    /// The objects, indexed by object number.
    pub fn objects(&self) -> &Objects {
        &self.objects
    }

    /// The materials, indexed by material number.
    pub fn materials(&self) -> &[Arc<Material>] {
        &self.materials
    }

    /// A box around everything bounded.
    pub fn bounds(&self) -> Aabb {
        self.groups[0].bounds
    }

    /// Length of the diagonal of [`RenderScene::bounds`]; 1 for a scene without extent.
    pub fn diagonal(&self) -> f64 {
        let length = self.bounds().size().length();
        if length > 0.0 && length.is_finite() {
            length
        } else {
            1.0
        }
    }

    /// Name of the acceleration structure.
    pub fn accelerator_name(&self) -> &'static str {
        self.groups[0].accelerator.name()
    }

    /// The acceleration structure over the primitives of the world.
    pub fn accelerator(&self) -> &AnyAccelerator {
        &self.groups[0].accelerator
    }

    /// The instructions its kernels are compiled for.
    pub fn simd(&self) -> strahl_simd::Level {
        self.groups[0].accelerator.simd()
    }

    /// Sizes.
    pub fn stats(&self) -> SceneStats {
        let mut s = SceneStats {
            objects: self.objects.len(),
            elements: self.groups[0].count,
            materials: self.materials.len(),
            lights: self.lights.len(),
            object_bytes: self.objects.bytes(),
            ..SceneStats::default()
        };
        for g in self.groups.iter() {
            s.primitives += g.prims.len();
            s.instances += g.instances.len();
            s.accelerator_bytes += g.accelerator.bytes();
            s.nodes += g.accelerator.nodes();
            s.references += g.accelerator.references();
            for part in [&g.stopping, &g.transmitting].into_iter().flatten() {
                s.accelerator_bytes += part.accelerator.bytes();
                s.geometry_bytes += part.blocks.bytes();
            }
            s.geometry_bytes += g.prims.bytes()
                + size_of_val(g.shapes.as_slice())
                + g.spheres.bytes()
                + size_of_val(g.instances.as_slice())
                + g.blocks.bytes()
                + g.meshes.iter().map(|m| m.mesh.bytes()).sum::<usize>();
        }
        s
    }

    /// Finds an element by its number; the number must come from a hit in this scene.
    pub(crate) fn locate(&self, id: u64) -> Located<'_> {
        self.descend(id, |_| ())
    }

    /// The same, and the map from the group's space to the world; `None` for the world itself. A map that no instance has is stored
    /// in `made`.
    // References: a map has 192 bytes.
    pub(crate) fn locate_with_map<'m>(
        &'m self,
        id: u64,
        made: &'m mut Option<Transform>,
    ) -> (Located<'m>, Option<&'m Transform>) {
        let (mut outermost, mut nested) = (None::<&Transform>, false);
        let at = self.descend(id, |instance| match outermost {
            None => outermost = Some(&instance.transform),
            Some(outermost) => {
                let outer = if nested { made.as_ref() } else { None };
                let both = instance.transform.then(outer.unwrap_or(outermost));
                (*made, nested) = (Some(both), true);
            }
        });
        (at, if nested { made.as_ref() } else { outermost })
    }

    /// Finds an element, and visits the instances that it lies in, the outermost first.
    #[inline(always)]
    fn descend<'s>(&'s self, id: u64, mut visit: impl FnMut(&'s InstanceUse)) -> Located<'s> {
        let (mut group, mut rest) = (&self.groups[0], id);
        loop {
            let prim = group.prim_of(rest);
            rest -= group.first_id(prim);
            let PrimKind::Instance(index) = group.prims.at(prim).kind() else {
                return Located {
                    group,
                    prim,
                    element: rest as u32,
                    space: id - group.first_id(prim) - rest,
                };
            };
            let instance = &group.instances[index as usize];
            visit(instance);
            group = &self.groups[instance.group as usize];
        }
    }

    /// The object an element belongs to; the number must come from a hit in this scene.
    pub(crate) fn object_of(&self, id: u64) -> u32 {
        let at = self.locate(id);
        at.group.appearance(at.prim, at.element).object
    }

    /// The line of the scene file that made the triangle with this number, if its mesh stores it.
    pub(crate) fn face_line(&self, id: u64) -> Option<u32> {
        let at = self.locate(id);
        match at.group.prims.at(at.prim).kind() {
            PrimKind::Triangle(mesh, triangle) => {
                at.group.meshes[mesh as usize].mesh.face_line(triangle)
            }
            _ => None,
        }
    }
}

impl RenderGroup {
    /// Object and material of an element of a primitive that is no instance.
    #[inline]
    pub(crate) fn appearance(&self, prim: u32, element: u32) -> Appearance {
        self.appearance_of(self.prims.at(prim).kind(), element)
    }

    /// The same for a primitive of this kind.
    #[inline]
    pub(crate) fn appearance_of(&self, kind: PrimKind, element: u32) -> Appearance {
        match kind {
            PrimKind::Triangle(mesh, _) => self.meshes[mesh as usize].appearance,
            PrimKind::Sphere(number) => self.spheres.appearance(number),
            PrimKind::Shape(index) | PrimKind::Placed(index) => {
                let used = &self.shapes[index as usize];
                match (&used.appearance, &used.shape) {
                    (Appearances::One(appearance), _) => *appearance,
                    (Appearances::Leaves { appearances, .. }, Shape::Csg(csg)) => {
                        appearances[csg.leaf_tag(csg.leaf_of(element).0) as usize]
                    }
                    (Appearances::Leaves { appearances, .. }, _) => appearances[0],
                }
            }
            PrimKind::Instance(_) => unreachable!("locate ends at a primitive that is no instance"),
        }
    }

    /// The corners of a triangle of a mesh, as that stores them.
    #[inline(always)]
    pub(crate) fn stored_corners(&self, prim: u32) -> Option<[[f32; 3]; 3]> {
        match self.prims.at(prim).kind() {
            PrimKind::Triangle(mesh, triangle) => {
                self.meshes[mesh as usize].mesh.stored_corners(triangle)
            }
            _ => None,
        }
    }

    /// Whether a ray of this direction sees the front of a flat primitive; `None` if only the surface at the hit can decide.
    #[inline]
    pub(crate) fn shows_front(&self, prim: u32, direction: DVec3) -> Option<bool> {
        match self.prims.at(prim).kind() {
            PrimKind::Triangle(mesh, triangle) => self.meshes[mesh as usize]
                .mesh
                .shows_front(triangle, direction),
            PrimKind::Shape(index) => match &self.shapes[index as usize].shape {
                Shape::Polygon(polygon) => Some(polygon.normal().dot(direction) < 0.0),
                _ => None,
            },
            _ => None,
        }
    }
}
