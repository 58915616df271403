use super::Texture;
use super::objects::{Shared, Tally};
use super::query::Query;
use std::sync::atomic::AtomicU32;
use std::sync::{Arc, OnceLock};
use strahl_math::Transform;
use strahl_scene::{CsgOp, Object, ObjectKind};

/// An object while it is read: the scene's object with additional data.
#[derive(Clone, Debug)]
pub struct Entity {
    /// The object. Its material is that of `texture`; without one it is left to the parent or the defaults.
    pub object: Object,
    /// The texture, to be modified where the object is used again; it lives in the object's own space.
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
    /// An object of which no visible part is left: a union without children.
    pub(crate) fn nothing() -> Self {
        Object::csg(CsgOp::Union, vec![]).into()
    }

    /// Moves the object, after the transformations it has.
    pub(crate) fn transform(&mut self, map: &Transform) {
        transform(&mut self.object, map);
    }

    /// From the object's own space to that of its parent.
    pub(crate) fn placement(&self) -> Transform {
        self.object
            .transform
            .as_deref()
            .copied()
            .unwrap_or_default()
    }
}

/// Moves an object in place.
pub(crate) fn transform(object: &mut Object, map: &Transform) {
    match &mut object.transform {
        Some(before) => **before = before.then(map),
        None if map.is_identity() => {}
        none => *none = Some(Box::new(*map)),
    }
}

/// Whether no surface of an object is left.
pub(crate) fn is_nothing(object: &Object) -> bool {
    matches!(&object.kind, ObjectKind::Csg { children, .. } if children.0.is_empty())
}

/// An object with a name: read once, used any number of times.
#[derive(Debug)]
pub struct Declared {
    pub(crate) entity: Entity,
    pub(crate) tally: Tally,
    /// How often it has been used.
    pub(crate) uses: AtomicU32,
    /// Its number among the objects whose uses share one group.
    pub(crate) shared: OnceLock<u32>,
    /// Answers `inside`, `trace` and the extents; built when it is needed first.
    pub(crate) query: OnceLock<Option<Arc<Query>>>,
}

impl Declared {
    /// Names an object; `shared` are the objects that its instances stand for.
    pub(super) fn new(entity: Entity, shared: &Shared) -> Self {
        Self {
            tally: Tally::of(&entity.object, shared),
            entity,
            uses: AtomicU32::new(0),
            shared: OnceLock::new(),
            query: OnceLock::new(),
        }
    }
}
