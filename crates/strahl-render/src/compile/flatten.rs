use super::bounds::{Bound, bounded};
use super::inherit::Todo;
use super::materials::{MaterialTable, material_fills, material_problem};
use super::operation::wrong_count;
use crate::appearance::{Appearance, Appearances, UvMapping};
use crate::hit::RayClass;
use crate::light_sets::{LightSetsDraft, Lit};
use crate::objects::{ObjectInfo, Objects};
use crate::prim::{Prim, PrimKind};
use crate::runs::RunList;
use crate::spheres::{CompactSphere, Spheres};
use crate::uses::{InstanceUse, MeshUse, ShapeUse};
use std::collections::HashSet;
use std::sync::Arc;
use strahl_geometry::{GeometryError, Polygon, Primitive, Shape};
use strahl_math::Transform;
use strahl_scene::{
    Children, CsgOp, Diagnostic, Object, ObjectKind, Scene, SceneLight, Visibility,
};
use strahl_shade::texture::Texture;
use strahl_shade::{MaterialId, Sides};

/// The lists of one group.
#[derive(Debug, Default)]
pub(super) struct FlatGroup {
    pub(super) prims: RunList<Prim>,
    pub(super) shapes: Vec<ShapeUse>,
    pub(super) spheres: Spheres,
    pub(super) meshes: Vec<MeshUse>,
    pub(super) instances: Vec<InstanceUse>,
}

impl FlatGroup {
    /// Adds a shape in the group's own space.
    pub(super) fn add_shape(
        &mut self,
        shape: Shape,
        appearance: Appearances,
        visible: u8,
        flags: u8,
    ) {
        let compact = match &shape {
            Shape::Sphere(sphere) => CompactSphere::of(sphere),
            _ => None,
        };
        let kind = match (compact, appearance) {
            (Some(sphere), Appearances::One(appearance)) => {
                PrimKind::Sphere(self.spheres.push(sphere, appearance))
            }
            (_, appearance) => {
                self.shapes.push(ShapeUse {
                    early_box: ShapeUse::early_box(&shape, None),
                    shape,
                    transform: None,
                    appearance,
                    inside: None,
                });
                PrimKind::Shape(self.shapes.len() as u32 - 1)
            }
        };
        self.prims.push(Prim::new(kind, visible, flags));
    }
}

/// The scene as lists.
#[derive(Debug, Default)]
pub(super) struct Flat {
    /// The scene's groups by their numbers, the world, and spaces for small objects.
    pub(super) groups: Vec<FlatGroup>,
    /// Index of the world.
    pub(super) world: usize,
    pub(super) objects: Objects,
    pub(super) materials: MaterialTable,
    pub(super) texture_spaces: Vec<Transform>,
    /// Lights found among the objects.
    pub(super) lights: Vec<SceneLight>,
    pub(super) light_sets: LightSetsDraft,
    /// Warnings.
    pub(super) diagnostics: Vec<Diagnostic>,
}

/// Most errors reported in one run.
const MOST_ERRORS: usize = 20;

/// Makes the lists, or returns all errors.
pub(super) fn flatten(scene: &Scene) -> Result<Flat, Vec<Diagnostic>> {
    let mut pass = Pass {
        flat: Flat {
            materials: MaterialTable::new(scene.settings.quality),
            world: scene.groups.len(),
            ..Flat::default()
        },
        errors: vec![],
        checked: HashSet::new(),
        in_world: false,
        bodies: 0,
    };
    let world = std::iter::once(&scene.objects);
    for objects in scene.groups.iter().map(|g| &g.objects).chain(world) {
        let mut group = FlatGroup::default();
        let lights = pass.flat.lights.len();
        pass.in_world = pass.flat.groups.len() == pass.flat.world;
        pass.objects(&objects.0, scene, &mut group);
        pass.flat.groups.push(group);
        if !pass.in_world
            && let Some(light) = pass.flat.lights.get(lights)
        {
            let message =
                "a light in a group that is instanced does not shine; put it beside the instances";
            let warning = Diagnostic::warning(message).at(light.span);
            pass.flat.diagnostics.push(warning);
            pass.flat.lights.truncate(lights);
        }
    }
    if pass.errors.is_empty() {
        return Ok(pass.flat);
    }
    let more = pass.errors.len().saturating_sub(MOST_ERRORS);
    pass.errors.truncate(MOST_ERRORS);
    if more > 0 {
        pass.errors.push(Diagnostic::error(format!(
            "and {more} more errors of this kind"
        )));
    }
    Err(pass.errors)
}

/// The object that is clipped, if it is a shape that lies within all that clips it: as programs write it that clip everything by the limits of what
/// they show.
fn unclipped<'a>(children: &'a Children, todo: &Todo<'a>) -> Option<Todo<'a>> {
    let (object, clips) = children.0.split_first()?;
    let ObjectKind::Shape(shape) = &object.kind else {
        return None;
    };
    let whole = Todo::new(object, Some(todo));
    // Meshes that are moved are copied, unless they are parts of trees.
    if matches!(shape, Shape::TriangleMesh(_)) && !whole.transform.is_identity() {
        return None;
    }
    let holds = |clip: &Object| {
        Bound::of(clip, &todo.transform).is_some_and(|clip| clip.holds(shape, &whole.transform))
    };
    (!clips.is_empty() && clips.iter().all(holds)).then_some(whole)
}

pub(super) struct Pass {
    pub(super) flat: Flat,
    pub(super) errors: Vec<Diagnostic>,
    /// Materials already validated.
    pub(super) checked: HashSet<MaterialId>,
    /// Whether the world is being flattened, not a group.
    pub(super) in_world: bool,
    /// Bodies so far.
    pub(super) bodies: u32,
}

impl Pass {
    fn objects(&mut self, objects: &[Object], scene: &Scene, group: &mut FlatGroup) {
        // A stack instead of recursion: unions may be nested arbitrarily deep.
        let mut waiting: Vec<Todo<'_>> = Vec::new();
        let mut rest = objects.iter().map(|o| Todo::new(o, None));
        while let Some(mut todo) = waiting.pop().or_else(|| rest.next()) {
            self.number_body(&mut todo);
            let object = todo.object;
            match &object.kind {
                ObjectKind::Csg {
                    op: CsgOp::Bound,
                    children,
                } => {
                    let inner = self.bounded_part(children, &mut todo);
                    waiting.extend(inner.map(|c| Todo::new(c, Some(&todo))));
                }
                ObjectKind::Csg {
                    op: CsgOp::Clip,
                    children,
                } if let Some(whole) = unclipped(children, &todo) => waiting.push(whole),
                ObjectKind::Csg { op, children } if op.is_union() => {
                    let children = self.union_parts(*op, children, &mut todo);
                    waiting.extend(children.rev().map(|c| Todo::new(c, Some(&todo))));
                }
                ObjectKind::Csg { .. } => self.csg(&todo, group),
                ObjectKind::Shape(shape) => self.shape(shape, &todo, group),
                ObjectKind::Light(light) => self.light(light, &todo),
                ObjectKind::Instance(id) if (id.0 as usize) < scene.groups.len() => {
                    let lit = self.lit(&todo);
                    group.instances.push(InstanceUse {
                        group: id.0,
                        transform: todo.transform,
                        lit,
                    });
                    self.flat.light_sets.add_instance(lit);
                    let index = group.instances.len() as u32 - 1;
                    let filled = if todo.is_lamp { 0 } else { Prim::FILLED };
                    group.prims.push(Prim::new(
                        PrimKind::Instance(index),
                        visible(todo.visibility),
                        Prim::STOPS | Prim::TRANSMITS | filled,
                    ));
                }
                ObjectKind::Instance(id) => {
                    let message = format!(
                        "instance of group {}, but the scene has {} groups",
                        id.0,
                        scene.groups.len()
                    );
                    self.errors.push(Diagnostic::error(message).at(todo.span));
                }
            }
        }
    }

    /// Numbers the body that an object is the first of.
    pub(super) fn number_body(&mut self, todo: &mut Todo<'_>) {
        todo.body.get_or_insert_with(|| {
            self.bodies = self.bodies.wrapping_add(1);
            self.bodies
        });
    }

    /// The object within its bounds, which the bounds of `todo` become.
    pub(super) fn bounded_part<'a>(
        &mut self,
        children: &'a Children,
        todo: &mut Todo<'a>,
    ) -> Option<&'a Object> {
        if let Some(problem) = wrong_count(CsgOp::Bound, children.0.len()) {
            self.errors.push(Diagnostic::error(problem).at(todo.span));
        }
        let (inner, others) = children.0.split_first()?;
        let mut bounds = todo.bounds.to_vec();
        for other in others {
            match Bound::of(other, &todo.transform) {
                Some(bound) if bound.surrounds_object(inner, &todo.transform) => {}
                Some(bound) => bounds.push(bound),
                None => {
                    let message = "what bounds this object is no valid shape; give a solid or a surface with finite parameters";
                    self.errors.push(Diagnostic::error(message).at(todo.span));
                }
            }
        }
        todo.bounds = bounds.into();
        Some(inner)
    }

    /// The children of a union. Those of a light group get a light set, which the lights of the group join here.
    pub(super) fn union_parts<'a>(
        &mut self,
        op: CsgOp,
        children: &'a Children,
        todo: &mut Todo<'a>,
    ) -> impl DoubleEndedIterator<Item = &'a Object> + use<'a> {
        let is_group = self.in_world && matches!(op, CsgOp::LightGroup { .. });
        let own_light =
            move |child: &Object| is_group && matches!(child.kind, ObjectKind::Light(_));
        if is_group {
            todo.lit.set = self.flat.light_sets.open(op, todo.lit.set);
            for child in children.0.iter().filter(|c| own_light(c)) {
                if let ObjectKind::Light(light) = &child.kind {
                    let number = self.flat.lights.len();
                    self.flat.light_sets.add_light(todo.lit.set, number);
                    self.light(light, &Todo::new(child, Some(todo)));
                }
            }
        }
        children.0.iter().filter(move |c| !own_light(c))
    }

    /// How an object is lit: the bodies of lights in a light group have a set of their own.
    fn lit(&mut self, todo: &Todo<'_>) -> Lit {
        let mut lit = todo.lit;
        if todo.is_lamp {
            lit.set = self.flat.light_sets.of_lamps(lit.set);
        }
        lit
    }

    pub(super) fn light(&mut self, light: &SceneLight, todo: &Todo<'_>) {
        self.flat.lights.push(SceneLight {
            name: light.name.as_ref().or(todo.name).cloned(),
            ..light.transformed(&todo.transform)
        });
    }

    /// Registers object and material.
    pub(super) fn appearance(&mut self, todo: &Todo<'_>, kind: &'static str) -> Appearance {
        let material = self.flat.materials.id(todo.material);
        if self.checked.insert(material)
            && let Some(problem) = material_problem(self.flat.materials.get(material))
        {
            self.errors.push(Diagnostic::error(problem).at(todo.span));
        }
        self.flat.objects.push(ObjectInfo {
            name: todo.name.cloned(),
            kind,
            span: todo.span,
        });
        let object = self.flat.objects.len() as u32 - 1;
        let lit = self.lit(todo);
        self.flat.light_sets.add_object(lit, object);
        let spaces = &mut self.flat.texture_spaces;
        let textured = self.flat.materials.get(material).texture.is_some();
        let texture_space = if !textured || todo.material_space.is_identity() {
            Appearance::NO_SPACE
        } else {
            // Neighbours, such as the parts of a union, often have the same one.
            if spaces.last() != Some(&todo.material_space) {
                spaces.push(todo.material_space);
            }
            spaces.len() as u32 - 1
        };
        Appearance {
            object,
            material,
            texture_space,
            body: todo.body.unwrap_or(0),
            hollow: todo.hollow,
            uv: self.uv_mapping(todo, material, kind),
        }
    }

    fn uv_mapping(&self, todo: &Todo<'_>, material: MaterialId, kind: &str) -> UvMapping {
        let of_components = || {
            let texture = &self.flat.materials.get(material).texture;
            kind == "blob"
                && texture
                    .as_ref()
                    .is_some_and(|t| matches!(*t.0, Texture::Shared(..)))
        };
        match todo.uv_mapped {
            false => UvMapping::Off,
            true if todo.material_uv_mapped && !of_components() => UvMapping::Fixed,
            true => UvMapping::Moved,
        }
    }

    pub(super) fn flags(&self, todo: &Todo<'_>, material: MaterialId) -> u8 {
        let light = if self.flat.materials.transmits(material) {
            Prim::TRANSMITS
        } else {
            Prim::STOPS
        };
        let material = self.flat.materials.get(material);
        let sides = match material.sides {
            Sides::Front => Prim::ONE_SIDED,
            Sides::Two => 0,
        };
        let mask = if material.is_masked() {
            Prim::MASKED
        } else {
            0
        };
        let filtered = if sides | mask == 0 { 0 } else { Prim::FILTERED };
        let filled = if material_fills(material) && !todo.is_lamp {
            Prim::FILLED
        } else {
            0
        };
        light | sides | mask | filtered | filled
    }

    pub(super) fn invalid(&mut self, todo: &Todo<'_>, kind: &str, error: &GeometryError) {
        let name = todo.name.map_or_else(String::new, |n| format!(" `{n}`"));
        self.errors
            .push(Diagnostic::error(format!("{kind}{name}: {error}")).at(todo.span));
    }

    fn shape(&mut self, shape: &Shape, todo: &Todo<'_>, group: &mut FlatGroup) {
        let rectangle = rectangle(shape);
        let shape = rectangle.as_ref().unwrap_or(shape);
        if let Err(error) = shape.validate() {
            self.invalid(todo, shape.kind(), &error);
            return;
        }
        let appearance = self.appearance(todo, shape.kind());
        let flags = self.flags(todo, appearance.material);
        let visible = visible(todo.visibility);
        let identity = todo.transform.is_identity();
        // Triangles of meshes are seen by all rays.
        let is_mesh = matches!(shape, Shape::TriangleMesh(_));
        let here = shape_at(shape, &todo.transform);
        let shape = here.as_ref().unwrap_or(shape);
        let hidden = (!is_mesh).then(|| bounded(shape, &todo.bounds, &todo.transform));
        let hidden = hidden.flatten();
        let shape = hidden.as_ref().unwrap_or(shape);
        let baked = if identity {
            Some(shape.clone())
        } else {
            shape.baked(&todo.transform)
        };
        // Meshes become one primitive per triangle.
        if let Some(Shape::TriangleMesh(mesh)) = &baked {
            let index = group.meshes.len() as u32;
            let count = mesh.triangle_count();
            group.meshes.push(MeshUse {
                mesh: Arc::clone(mesh),
                appearance,
            });
            for triangle in 0..count {
                let kind = PrimKind::Triangle(index, triangle);
                group.prims.push(Prim::new(kind, visible, flags));
            }
            return;
        }
        if let Some(baked) = baked {
            group.add_shape(baked, Appearances::One(appearance), visible, flags);
            return;
        }
        group.shapes.push(ShapeUse {
            shape: shape.clone(),
            transform: Some(Box::new(todo.transform)),
            early_box: ShapeUse::early_box(shape, Some(&todo.transform)),
            appearance: Appearances::One(appearance),
            inside: None,
        });
        let kind = PrimKind::Placed(group.shapes.len() as u32 - 1);
        group.prims.push(Prim::new(kind, visible, flags));
    }
}

/// A shape as it is at its place in the group, if that matters to more than its place.
pub(super) fn shape_at(shape: &Shape, to_group: &Transform) -> Option<Shape> {
    match shape {
        Shape::HeightField(field) => field.shaded_in(to_group).map(Shape::from),
        _ => None,
    }
}

/// A box whose opposite faces coincide within rounding, as the one sheet that it is by itself. (In CSG it stays a solid without content.)
fn rectangle(shape: &Shape) -> Option<Shape> {
    let Shape::Cuboid(cuboid) = shape else {
        return None;
    };
    let (min, max) = (cuboid.min(), cuboid.max());
    let extent = max - min;
    let thin = 16.0 * f64::EPSILON * (min.abs().max_element() + extent.max_element());
    let mut flat = (0..3).filter(|&axis| extent[axis] <= thin);
    let (Some(axis), None) = (flat.next(), flat.next()) else {
        return None;
    };
    Polygon::flat_box(cuboid, axis).map(Shape::from).ok()
}

pub(super) fn visible(v: Visibility) -> u8 {
    let bit = |seen: bool, class: RayClass| if seen { class.bit() } else { 0 };
    bit(v.camera, RayClass::Camera)
        | bit(v.secondary, RayClass::Secondary)
        | bit(v.shadow, RayClass::Shadow)
}
