//! What objects inherit from the objects that they are parts of.

use super::bounds::Bound;
use super::materials::material_of;
use crate::light_sets::Lit;
use std::rc::Rc;
use std::sync::Arc;
use strahl_math::Transform;
use strahl_scene::{Object, Span, Visibility};
use strahl_shade::Material;

/// An object with the attributes it inherits.
#[derive(Clone)]
pub(super) struct Todo<'a> {
    pub(super) object: &'a Object,
    pub(super) transform: Transform,
    pub(super) material: Option<&'a Arc<Material>>,
    /// From the space of the object that has the material to the group's.
    pub(super) material_space: Transform,
    pub(super) name: Option<&'a Arc<str>>,
    pub(super) span: Span,
    pub(super) visibility: Visibility,
    pub(super) hollow: bool,
    /// Whether it or an object that it is a part of has `uv_mapping`.
    pub(super) uv_mapped: bool,
    /// Whether the object that has the material has `uv_mapping`.
    pub(super) material_uv_mapped: bool,
    pub(super) lit: Lit,
    /// Whether it is the body of a light.
    pub(super) is_lamp: bool,
    /// The body that it is or is a part of; `None` if it is the first of one that has no number yet.
    pub(super) body: Option<u32>,
    /// The bounds that it is seen through.
    pub(super) bounds: Rc<[Bound]>,
}

impl<'a> Todo<'a> {
    pub(super) fn new(object: &'a Object, parent: Option<&Self>) -> Self {
        let own = object.transform.as_deref().copied().unwrap_or_default();
        let Some(p) = parent else {
            return Self {
                object,
                transform: own,
                material: object.material.as_ref(),
                material_space: own,
                name: object.name.as_ref(),
                span: object.span,
                visibility: object.visibility,
                hollow: object.hollow == Some(true),
                uv_mapped: object.uv_mapped,
                material_uv_mapped: object.uv_mapped,
                lit: Lit {
                    both_sides: object.double_illuminated,
                    ..Lit::DEFAULT
                },
                is_lamp: object.is_lamp,
                body: None,
                bounds: Rc::default(),
            };
        };
        let (a, b) = (object.visibility, p.visibility);
        let transform = own.then(&p.transform);
        Self {
            object,
            transform,
            material_space: if object.material.is_some() {
                transform
            } else {
                p.material_space
            },
            material: material_of(object, p.material),
            name: object.name.as_ref().or(p.name),
            span: if object.span.is_some() {
                object.span
            } else {
                p.span
            },
            visibility: Visibility {
                camera: a.camera && b.camera,
                secondary: a.secondary && b.secondary,
                shadow: a.shadow && b.shadow,
            },
            hollow: object.hollow.unwrap_or(p.hollow),
            uv_mapped: object.uv_mapped || p.uv_mapped,
            material_uv_mapped: if object.material.is_some() {
                object.uv_mapped
            } else {
                p.material_uv_mapped
            },
            body: if fills_itself(object, p.material) {
                None
            } else {
                p.body
            },
            bounds: Rc::clone(&p.bounds),
            lit: Lit {
                set: p.lit.set,
                both_sides: object.double_illuminated || p.lit.both_sides,
            },
            is_lamp: object.is_lamp || p.is_lamp,
        }
    }
}

/// Whether an object has a medium of its own and not that of the whole: parts that got theirs from the whole share it.
fn fills_itself(object: &Object, whole: Option<&Arc<Material>>) -> bool {
    let interior = |m: Option<&Arc<Material>>| m.and_then(|m| m.interior.as_ref().map(Arc::as_ptr));
    let own = interior(object.material.as_ref());
    own.is_some() && own != interior(whole)
}
