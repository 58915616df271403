//! Reuse of declared objects without copies.
//!
//! While the scene is read, each use of a large or frequently used declared object is an [`ObjectKind::Instance`] whose number is
//! an index into the declared objects ([`Shared`]), not yet into the scene's groups. At the end, [`link`] turns them into groups:
//! one for each declared object and each material that its parts inherit from the use (a pattern that an object around the use has lies elsewhere
//! on each use, so it is another material for each). An object that is used only once replaces
//! its instance, so that a scene built step by step (`#declare All = union { object { All } ... }`) does not become a tower of
//! instances. A small object that other declared objects use is copied into their groups: levels of instances within each other cost rays
//! more than a larger group, most of all where they overlap. Operations other than unions need all their parts: within them the last use of a declared object takes its parts,
//! and earlier uses copy them.

mod linker;

use super::extents::own_extent;
use crate::grammar::Entity;
use crate::grammar::entity::{Declared, has_no_surface};
use crate::grammar::texture::is_bare;
use crate::parser::{PResult, Parser};
use crate::symbol::Symbol;
use linker::Linker;
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use strahl_geometry::{Primitive, Shape};
use strahl_math::Aabb;
use strahl_scene::{Children, CsgOp, GroupId, Object, ObjectKind};

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
        let left = (self.options.limits.objects as u64).saturating_sub(self.state.objects);
        let copied = linker.count_all(&self.scene, left);
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
