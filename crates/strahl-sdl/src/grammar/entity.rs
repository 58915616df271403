use super::Texture;
use super::objects::{Shared, Tally};
use super::query::Query;
use std::sync::atomic::AtomicU32;
use std::sync::{Arc, OnceLock};
use strahl_math::{Aabb, Transform};
use strahl_scene::{CsgOp, Object, ObjectKind};

/// An object being read: the scene's object with additional data.
#[derive(Clone, Debug)]
pub struct Entity {
    /// The object. Its material is that of `texture`; without one, the parent or the default decides.
    pub object: Object,
    /// The texture, kept so that a later use of the object can modify it; it is in the object's own space.
    pub texture: Option<Texture>,
}

impl From<Object> for Entity {
    fn from(object: Object) -> Self {
        Self {
            object,
            texture: None,
        }
    }
}

impl Entity {
    /// An object without a visible part: a union without children.
    pub(crate) fn nothing() -> Self {
        Object::csg(CsgOp::Union, vec![]).into()
    }

    /// Transforms the object, after its other transformations.
    pub(crate) fn transform(&mut self, map: &Transform) {
        transform(&mut self.object, map);
    }

    /// The transformation from the object's own space to that of its parent.
    pub(crate) fn placement(&self) -> Transform {
        self.object
            .transform
            .as_deref()
            .copied()
            .unwrap_or_default()
    }
}

/// Transforms an object in place.
pub(crate) fn transform(object: &mut Object, map: &Transform) {
    match &mut object.transform {
        Some(before) => **before = before.then(map),
        None if map.is_identity() => {}
        none => *none = Some(Box::new(*map)),
    }
}

/// Whether an object has no surface: it is nothing or everything.
pub(crate) fn has_no_surface(object: &Object) -> bool {
    matches!(&object.kind, ObjectKind::Csg { children, .. } if children.0.is_empty())
}

/// Whether an object has no points at all.
pub(crate) fn is_nothing(object: &Object) -> bool {
    has_no_surface(object) && !is_everything(object)
}

/// Whether an object is all of space, as the inverse of nothing.
pub(crate) fn is_everything(object: &Object) -> bool {
    matches!(&object.kind, ObjectKind::Csg { op: CsgOp::Inverse, children } if children.0.is_empty())
}

/// A declared object: read once, used any number of times.
#[derive(Debug)]
pub struct Declared {
    pub(crate) entity: Entity,
    pub(crate) tally: Tally,
    /// The number of uses so far.
    pub(crate) uses: AtomicU32,
    /// Its number among the objects whose uses share one group.
    pub(crate) shared: OnceLock<u32>,
    /// The box around it, once it has been asked for.
    pub(crate) extent: OnceLock<Aabb>,
    /// Answers `inside` and `trace`; built on first use.
    pub(crate) query: OnceLock<Option<Arc<Query>>>,
}

impl Declared {
    /// Declares an object; `shared` are the objects that its instances refer to.
    pub(super) fn new(entity: Entity, shared: &Shared) -> Self {
        Self {
            tally: Tally::of(&entity.object, shared),
            entity,
            uses: AtomicU32::new(0),
            shared: OnceLock::new(),
            extent: OnceLock::new(),
            query: OnceLock::new(),
        }
    }
}
