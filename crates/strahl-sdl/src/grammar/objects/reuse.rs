//! Reuse of declared objects without copies.
//!
//! While the scene is read, each use of a large or frequently used declared object is an [`ObjectKind::Instance`] whose number is
//! an index into the declared objects ([`Shared`]), not yet into the scene's groups. At the end, [`link`] turns them into groups:
//! one for each declared object and each material that its parts inherit from the use. An object that is used only once replaces
//! its instance, so that a scene built step by step (`#declare All = union { object { All } ... }`) does not become a tower of
//! instances. A small object that other declared objects use is copied into their groups: levels of instances within each other cost rays
//! more than a larger group, most of all where they overlap. Operations other than unions need all their parts: within them the last use of a declared object takes its parts,
//! and earlier uses copy them.

use super::extents::own_extent;
use crate::grammar::Entity;
use crate::grammar::entity::{Declared, has_no_surface};
use crate::grammar::texture::is_bare;
use crate::parser::{PResult, Parser};
use crate::symbol::Symbol;
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use strahl_geometry::{Primitive, Shape};
use strahl_math::Aabb;
use strahl_scene::{Children, CsgOp, Group, GroupId, Object, ObjectKind, Scene};
use strahl_shade::Material;

/// For objects with at most this many parts, the first uses are copies; for larger ones, copies would cost rays more than the
/// additional level of an instance.
const SMALL: u64 = 8;

/// After this many uses, an object of several parts is shared.
const OFTEN: u32 = 16;

/// A declared object with at most this many parts, all those of other declared objects included, is copied where a group uses it ...
const COPIED: u64 = 4096;

/// ... until all such copies of a scene together have as many parts.
const MOST_COPIED: u64 = 1 << 16;

/// A mesh of up to this many triangles counts as small.
const FEW_TRIANGLES: u64 = 64;

/// Counts of the parts of an object.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    /// The number of shapes and operations.
    parts: u64,
    /// The number of elements of the shapes, such as the triangles of meshes.
    elements: u64,
    /// Whether a part inherits its material from the use.
    inherits: bool,
    /// Whether a part has a texture but no interior, so that a use may give it one.
    unfilled: bool,
    /// Whether a part has an interior but no texture, so that each use gives it one.
    bare: bool,
    /// Whether a part is a light or a light group.
    lights: bool,
    /// Whether a part is a smooth height field, whose normals depend on the scale of each use. Copies share the heights.
    smooth_fields: bool,
    /// Whether a part is a box.
    boxes: bool,
    /// Whether a part has a texture on texture coordinates.
    mapped: bool,
    /// The number of shapes and operations, including those of the declared objects in it.
    pub(in crate::grammar) expanded: u64,
}

impl Tally {
    pub(crate) fn of(object: &Object, shared: &Shared) -> Self {
        let mut tally = Self::default();
        let mut waiting = vec![(object, false)];
        while let Some((object, above)) = waiting.pop() {
            let has_material = above || (tally.parts > 0 && object.material.is_some());
            if let Some(material) = object.material.as_deref().filter(|_| tally.parts > 0) {
                tally.bare |= is_bare(material);
                tally.unfilled |= material.interior.is_none();
            }
            tally.parts += 1;
            tally.expanded = tally.expanded.saturating_add(1);
            tally.mapped |=
                object.uv_mapped || object.material.as_ref().is_some_and(|m| m.uses_uv());
            match &object.kind {
                ObjectKind::Csg { op, children } => {
                    // A light group determines which lights illuminate its parts, even if it has no lights.
                    tally.lights |= matches!(op, CsgOp::LightGroup { .. });
                    waiting.extend(children.0.iter().map(|child| (child, has_material)));
                }
                ObjectKind::Shape(shape) => {
                    tally.elements += u64::from(shape.elements());
                    tally.smooth_fields |=
                        matches!(shape, Shape::HeightField(field) if field.is_smooth());
                    tally.inherits |= !has_material;
                    tally.boxes |= matches!(shape, Shape::Cuboid(_));
                }
                ObjectKind::Instance(id) => {
                    // Its parts may inherit the material; checking them would not be worth the time.
                    tally.inherits |= !has_material;
                    let inside = shared.objects.get(id.0 as usize);
                    tally.unfilled |= inside.is_some_and(|d| d.tally.unfilled);
                    tally.boxes |= inside.is_some_and(|d| d.tally.boxes);
                    tally.mapped |= inside.is_some_and(|d| d.tally.mapped);
                    let parts = inside.map_or(0, |declared| declared.tally.expanded);
                    tally.expanded = tally.expanded.saturating_add(parts);
                }
                ObjectKind::Light(_) => tally.lights = true,
            }
        }
        tally
    }
}

/// The declared objects whose uses share a group, and the names of objects.
#[derive(Debug, Default)]
pub(crate) struct Shared {
    objects: Vec<Arc<Declared>>,
    /// The boxes around them, in their own spaces.
    extents: Vec<Aabb>,
    names: HashMap<Symbol, Arc<str>>,
}

impl Shared {
    pub(super) fn kind_of(&self, id: GroupId) -> Option<&Object> {
        let declared = self.objects.get(id.0 as usize)?;
        Some(&declared.entity.object)
    }

    /// The box around a declared object.
    pub(super) fn extent(&self, id: GroupId) -> Aabb {
        let extent = self.extents.get(id.0 as usize);
        extent.copied().unwrap_or(Aabb::EMPTY)
    }
}

impl Parser<'_> {
    /// The text of a name, shared by all objects.
    pub(super) fn name_of(&mut self, symbol: Symbol) -> Arc<str> {
        let text = self.symbols.text(symbol);
        let names = &mut self.state.shared.names;
        Arc::clone(names.entry(symbol).or_insert_with(|| text.into()))
    }

    /// Uses a declared object.
    pub(super) fn use_declared(&mut self, declared: &Arc<Declared>) -> Entity {
        let Tally {
            parts, elements, ..
        } = declared.tally;
        let uses = declared.uses.fetch_add(1, Ordering::Relaxed);
        // Lights illuminate from their own positions, so each use needs its own; each use gives bare parts their texture, and smooth
        // height fields their normals.
        let Tally {
            lights,
            bare,
            smooth_fields,
            ..
        } = declared.tally;
        if lights {
            let mut entity = declared.entity.clone();
            take_outer_lights(&mut entity.object, &self.state.shared);
            return entity;
        }
        if bare || smooth_fields {
            return declared.entity.clone();
        }
        let large = parts > SMALL || elements > FEW_TRIANGLES + parts;
        if !(large || (parts > 1 && uses >= OFTEN)) {
            return declared.entity.clone();
        }
        let shared = &mut self.state.shared;
        let id = *declared.shared.get_or_init(|| {
            let extent = own_extent(&declared.entity.object.kind, shared);
            shared.extents.push(extent);
            shared.objects.push(Arc::clone(declared));
            shared.objects.len() as u32 - 1
        });
        let kind = ObjectKind::Instance(GroupId(id));
        Entity {
            object: attributes(&declared.entity.object, kind),
            texture: declared.entity.texture.clone(),
        }
    }

    /// Replaces the instances within an object by the parts of the declared objects.
    ///
    /// # Errors
    /// If there are too many parts.
    pub(in crate::grammar) fn expand_instances(&mut self, object: &mut Object) -> PResult<()> {
        if has_instances(object) {
            self.count_objects(Tally::of(object, &self.state.shared).expanded)?;
            *object = expanded(object, &self.state.shared);
        }
        Ok(())
    }

    /// The same for an object that is mirrored, if boxes in it may have textures on texture coordinates, unless it has too many parts.
    ///
    /// # Errors
    /// If the scene has too many parts.
    pub(super) fn expand_mapped_boxes(&mut self, object: &mut Object) -> PResult<()> {
        let Tally {
            boxes,
            mapped,
            expanded,
            ..
        } = Tally::of(object, &self.state.shared);
        if !(boxes && mapped && has_instances(object)) {
            return Ok(());
        }
        if expanded <= MOST_COPIED {
            return self.expand_instances(object);
        }
        let place = self.place();
        self.warn(
            place,
            "the textures of boxes in this object are mirrored with it, as they are not in POV-Ray: it has too many parts",
        );
        Ok(())
    }

    /// The same for an object that gives its parts an interior, if it needs all of them or some have a texture but no interior.
    ///
    /// # Errors
    /// If there are too many parts.
    pub(in crate::grammar) fn expand_unfilled(&mut self, object: &mut Object) -> PResult<()> {
        let combines = matches!(&object.kind, ObjectKind::Csg { op, .. } if !op.is_union());
        if combines || Tally::of(object, &self.state.shared).unfilled {
            self.expand_instances(object)?;
        }
        Ok(())
    }

    /// Creates the scene's groups; called when the whole text is read and names are no longer needed.
    ///
    /// # Errors
    /// If operations other than unions have too many parts after expanding all declared objects in them.
    pub(crate) fn link_instances(&mut self) -> PResult<()> {
        let shared = std::mem::take(&mut self.state.shared);
        if shared.objects.is_empty() {
            return Ok(());
        }
        let mut linker = Linker::new(shared.objects);
        let copied = linker.count_all(&self.scene);
        self.count_objects(copied)?;
        linker.link(&mut self.scene);
        Ok(())
    }
}

/// In POV-Ray (measured) the lights of a group shine on the objects of a group within it if that one has been declared, alone or within another object;
/// but not on its unions, intersections and the like. Those become groups of their own without lights, on which the nearest lights shine.
fn take_outer_lights(object: &mut Object, shared: &Shared) {
    let mut waiting = vec![object];
    while let Some(object) = waiting.pop() {
        let ObjectKind::Csg { op, children } = &mut object.kind else {
            continue;
        };
        let has_lights = children
            .0
            .iter()
            .any(|c| matches!(c.kind, ObjectKind::Light(_)));
        if let CsgOp::LightGroup { outer_lights, .. } = op
            && has_lights
        {
            *outer_lights = true;
            for child in children.0.iter_mut().filter(|c| is_composite(c, shared)) {
                let op = CsgOp::LightGroup {
                    global_lights: false,
                    outer_lights: false,
                };
                let span = child.span;
                let parts = std::mem::replace(child, Object::csg(op, vec![]));
                *child = Object::csg(op, vec![parts]);
                child.span = span;
            }
        }
        waiting.extend(&mut children.0);
    }
}

/// Whether an object is a union, intersection, difference or merge of others.
fn is_composite(object: &Object, shared: &Shared) -> bool {
    let kind = match &object.kind {
        ObjectKind::Instance(id) => shared.kind_of(*id).map(|declared| &declared.kind),
        kind => Some(kind),
    };
    let Some(ObjectKind::Csg { op, .. }) = kind else {
        return false;
    };
    match op {
        CsgOp::Union | CsgOp::Merge | CsgOp::Intersection | CsgOp::Difference => true,
        CsgOp::Inverse | CsgOp::Clip | CsgOp::Bound | CsgOp::LightGroup { .. } => false,
    }
}

/// A copy of an object's properties with another kind.
fn attributes(object: &Object, kind: ObjectKind) -> Object {
    Object {
        name: object.name.clone(),
        span: object.span,
        material: object.material.clone(),
        transform: object.transform.clone(),
        visibility: object.visibility,
        hollow: object.hollow,
        double_illuminated: object.double_illuminated,
        uv_mapped: object.uv_mapped,
        is_lamp: object.is_lamp,
        kind,
    }
}

fn has_instances(object: &Object) -> bool {
    let mut waiting = vec![object];
    while let Some(object) = waiting.pop() {
        match &object.kind {
            ObjectKind::Instance(_) => return true,
            ObjectKind::Csg { children, .. } => waiting.extend(&children.0),
            ObjectKind::Shape(_) | ObjectKind::Light(_) => {}
        }
    }
    false
}

/// A copy with all instances replaced by their objects. Trees may be deeper than the stack, so the traversal uses a list.
pub(crate) fn expanded(object: &Object, shared: &Shared) -> Object {
    copy(object, Some(shared))
}

fn copy(object: &Object, expand: Option<&Shared>) -> Object {
    enum Step<'a> {
        /// Copy this kind, with these attributes.
        Visit(&'a Object, &'a ObjectKind),
        Build(&'a Object, CsgOp, usize),
    }
    let mut steps = vec![Step::Visit(object, &object.kind)];
    let mut done: Vec<Object> = vec![];
    while let Some(step) = steps.pop() {
        match step {
            Step::Visit(like, ObjectKind::Csg { op, children }) => {
                steps.push(Step::Build(like, *op, children.0.len()));
                steps.extend(children.0.iter().rev().map(|c| Step::Visit(c, &c.kind)));
            }
            Step::Visit(like, ObjectKind::Instance(id)) if expand.is_some() => {
                match expand.and_then(|shared| shared.kind_of(*id)) {
                    Some(inner) => steps.push(Step::Visit(like, &inner.kind)),
                    None => done.push(Object::csg(CsgOp::Union, vec![])),
                }
            }
            Step::Visit(like, kind) => done.push(attributes(like, kind.clone())),
            Step::Build(like, op, count) => {
                let mut children = done.split_off(done.len() - count);
                // A use of an object without a surface.
                children.retain(|child| !has_no_surface(child));
                let children = Children(children);
                done.push(attributes(like, ObjectKind::Csg { op, children }));
            }
        }
    }
    // The last result is the copy of the root.
    done.pop()
        .unwrap_or_else(|| Object::csg(CsgOp::Union, vec![]))
}

/// A declared object with the material that its parts inherit from the use.
type Key = (u32, Option<*const Material>);

/// Turns indices of declared objects into groups.
struct Linker {
    /// The declared objects; each is `None` after its last variant has taken it.
    objects: Vec<Option<Arc<Declared>>>,
    /// Whether parts of each object inherit their material from the use.
    inherits: Vec<bool>,
    /// All keys in the order of the scene, with their materials.
    variants: Vec<(u32, Option<Arc<Material>>)>,
    /// The number of uses of each variant, and its group once it exists.
    uses: Vec<u32>,
    groups: Vec<Option<GroupId>>,
    known: HashMap<Key, usize>,
    /// The number of uses of each declared object within operations that need all its parts.
    whole: Vec<u64>,
    /// How often the parts of each declared object are still needed, for variants and for such operations.
    open: Vec<u64>,
    /// The number of parts that have been copied into groups.
    copied: u64,
}

/// A place in which instances are replaced.
#[derive(Clone, Copy)]
struct Place {
    /// Whether an operation around it needs all parts.
    whole: bool,
    /// Whether it is in a group.
    in_group: bool,
    /// Whether it is in a copy: then an object that is used once may be met several times.
    copied: bool,
}

// The pointers are only keys. `variants` keeps the materials alive; the pointers are never dereferenced.
impl Linker {
    fn new(objects: Vec<Arc<Declared>>) -> Self {
        let open = vec![0; objects.len()];
        Self {
            inherits: objects.iter().map(|d| d.tally.inherits).collect(),
            objects: objects.into_iter().map(Some).collect(),
            variants: vec![],
            uses: vec![],
            groups: vec![],
            known: HashMap::new(),
            whole: open.clone(),
            open,
            copied: 0,
        }
    }

    /// Counts all uses; returns the number of parts needed by operations other than unions.
    fn count_all(&mut self, scene: &Scene) -> u64 {
        for object in &scene.objects.0 {
            self.count(object, None);
        }
        // Variants used by other variants are appended.
        let mut next = 0;
        while next < self.variants.len() {
            let (id, material) = self.variants[next].clone();
            if let Some(declared) = self.objects.get(id as usize).cloned().flatten() {
                self.count_kind(&declared.entity.object, material);
            }
            next += 1;
        }
        // A declared object consists of objects declared before it, which have lower indices.
        let mut wanted = 0u64;
        for id in (0..self.whole.len()).rev() {
            let times = self.whole.get(id).copied().unwrap_or(0);
            let declared = self.objects.get(id).cloned().flatten();
            let Some(declared) = declared.filter(|_| times > 0) else {
                continue;
            };
            wanted = wanted.saturating_add(times.saturating_mul(declared.tally.parts));
            let mut waiting = vec![&declared.entity.object];
            while let Some(object) = waiting.pop() {
                match &object.kind {
                    ObjectKind::Csg { children, .. } => waiting.extend(&children.0),
                    ObjectKind::Instance(inner) => self.use_whole(inner.0, times),
                    ObjectKind::Shape(_) | ObjectKind::Light(_) => {}
                }
            }
        }
        for (open, whole) in self.open.iter_mut().zip(&self.whole) {
            *open = open.saturating_add(*whole);
        }
        wanted
    }

    /// Counts uses of a declared object within operations that need all its parts.
    fn use_whole(&mut self, id: u32, times: u64) {
        if let Some(whole) = self.whole.get_mut(id as usize) {
            *whole = whole.saturating_add(times);
        }
    }

    fn link(mut self, scene: &mut Scene) {
        let mut objects = std::mem::take(&mut scene.objects.0);
        let mut waiting = vec![];
        for object in &mut objects {
            self.replace(object, None, false, scene, &mut waiting);
        }
        scene.objects.0 = objects;
        while let Some((group, variant)) = waiting.pop() {
            let Some((id, material)) = self.variants.get(variant).cloned() else {
                continue;
            };
            let mut object = Object::new(self.kind(id));
            object.material = material;
            self.replace(&mut object, None, true, scene, &mut waiting);
            if let Some(group) = scene.groups.get_mut(group) {
                object.name = group.name.clone();
                group.objects.0.push(object);
            }
        }
    }

    fn count(&mut self, object: &Object, inherited: Option<Arc<Material>>) {
        let material = object.material.clone().or(inherited);
        self.count_kind(object, material);
    }

    /// Counts the instances within an object whose parts inherit this material.
    fn count_kind(&mut self, object: &Object, material: Option<Arc<Material>>) {
        let mut waiting = vec![(object, material, false)];
        while let Some((object, material, whole)) = waiting.pop() {
            match &object.kind {
                ObjectKind::Shape(_) | ObjectKind::Light(_) => {}
                ObjectKind::Csg { op, children } => {
                    let whole = whole || !op.is_union();
                    waiting.extend(children.0.iter().rev().map(|child| {
                        let own = child.material.as_ref().or(material.as_ref());
                        (child, own.cloned(), whole)
                    }));
                }
                ObjectKind::Instance(id) if whole => self.use_whole(id.0, 1),
                ObjectKind::Instance(id) => {
                    let variant = self.variant(id.0, material);
                    if let Some(uses) = self.uses.get_mut(variant) {
                        *uses = uses.saturating_add(1);
                    }
                }
            }
        }
    }

    fn variant(&mut self, id: u32, material: Option<Arc<Material>>) -> usize {
        let inherits = self.inherits.get(id as usize) == Some(&true);
        let material = material.filter(|_| inherits);
        let key = (id, material.as_ref().map(Arc::as_ptr));
        *self.known.entry(key).or_insert_with(|| {
            self.variants.push((id, material));
            self.uses.push(0);
            self.groups.push(None);
            if let Some(open) = self.open.get_mut(id as usize) {
                *open += 1;
            }
            self.variants.len() - 1
        })
    }

    /// Whether a declared object has so few parts that its uses may be copies.
    fn is_small(&self, id: u32) -> bool {
        let declared = self.objects.get(id as usize).and_then(Option::as_ref);
        declared.is_some_and(|declared| declared.tally.expanded <= COPIED)
    }

    /// Takes note of a copy within a group, unless there are too many parts or the object has a mesh, whose triangles copies would not share.
    fn copies(&mut self, id: u32) -> bool {
        let declared = self.objects.get(id as usize).and_then(Option::as_ref);
        let Some(Tally {
            parts,
            elements,
            expanded,
            ..
        }) = declared.map(|declared| declared.tally)
        else {
            return false;
        };
        let may = expanded <= COPIED
            && elements <= FEW_TRIANGLES + parts
            && self.copied + expanded <= MOST_COPIED;
        self.copied += if may { expanded } else { 0 };
        may
    }

    /// The kind of a declared object; moved out at its last use, copied otherwise. Small objects are always copied, because copies of others may
    /// use them.
    fn kind(&mut self, id: u32) -> ObjectKind {
        let is_small = self.is_small(id);
        let nothing = Object::csg(CsgOp::Union, vec![]).kind;
        let (Some(slot), Some(open)) = (
            self.objects.get_mut(id as usize),
            self.open.get_mut(id as usize),
        ) else {
            return nothing;
        };
        *open = open.saturating_sub(1);
        let taken = if *open == 0 && !is_small {
            slot.take()
        } else {
            slot.clone()
        };
        match taken.map(Arc::try_unwrap) {
            Some(Ok(declared)) => declared.entity.object.kind,
            Some(Err(declared)) => copy(&declared.entity.object, None).kind,
            None => nothing,
        }
    }

    /// Replaces the instances within an object by instances of the scene's groups, or by objects that are used only here or are copied into a
    /// group. New groups are queued to be filled.
    fn replace(
        &mut self,
        object: &mut Object,
        inherited: Option<Arc<Material>>,
        in_group: bool,
        scene: &mut Scene,
        new: &mut Vec<(usize, usize)>,
    ) {
        let place = Place {
            whole: false,
            in_group,
            copied: false,
        };
        let mut waiting = vec![(object, inherited, place)];
        while let Some((object, inherited, mut place)) = waiting.pop() {
            let material = object.material.clone().or(inherited);
            while let ObjectKind::Instance(id) = object.kind {
                if place.whole {
                    object.kind = self.kind(id.0);
                    continue;
                }
                if place.in_group && self.copies(id.0) {
                    place.copied = true;
                    object.kind = self.kind(id.0);
                    continue;
                }
                let variant = self.variant(id.0, material.clone());
                if place.copied || self.uses.get(variant).is_some_and(|uses| *uses > 1) {
                    let id = self.group(variant, &object.name, scene, new);
                    object.kind = ObjectKind::Instance(id);
                    break;
                }
                object.kind = self.kind(id.0);
            }
            if let ObjectKind::Csg { op, children } = &mut object.kind {
                place.whole |= !op.is_union();
                let children = children.0.iter_mut().rev();
                waiting.extend(children.map(|child| (child, material.clone(), place)));
            }
        }
    }

    /// The group of a variant, named after its first use.
    fn group(
        &mut self,
        variant: usize,
        name: &Option<Arc<str>>,
        scene: &mut Scene,
        new: &mut Vec<(usize, usize)>,
    ) -> GroupId {
        let Some(slot) = self.groups.get_mut(variant) else {
            return GroupId(0);
        };
        *slot.get_or_insert_with(|| {
            let index = scene.groups.len();
            scene.groups.push(Group {
                name: name.clone(),
                objects: Children::default(),
            });
            new.push((index, variant));
            GroupId(index as u32)
        })
    }
}
