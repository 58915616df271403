use crate::{SceneLight, Span};
use std::sync::Arc;
use strahl_geometry::Shape;
use strahl_math::Transform;
use strahl_shade::Material;

/// Index of a group of objects in [`Scene::groups`](crate::Scene::groups), to be instanced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GroupId(pub u32);

/// How children are combined into one object, as in POV-Ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CsgOp {
    /// All children together; surfaces inside of other children are kept (and visible if the outer ones are transparent).
    /// Children may be open surfaces.
    Union,
    /// All children together as one solid without inner surfaces.
    Merge,
    /// The points inside of every child.
    Intersection,
    /// The first child without the others.
    Difference,
    /// The points outside of the one child.
    Inverse,
    /// The part of the first child's surface that is inside of the others; the cut is not closed by a cap. Its inverse is that of the
    /// first child, clipped by the same others.
    Clip,
    /// The first child, seen only by rays that hit each of the others somewhere. Meshes of triangles that are no operands are seen by
    /// all rays.
    Bound,
    /// A union whose own lights (those that are children themselves, not parts of children) shine only on the other children. Within a group, one
    /// without lights has those of the group around it, and one with lights its own only, unless it takes `outer_lights`. Objects of all groups cast
    /// shadows.
    LightGroup {
        /// Whether the lights that are in no group shine on the children too. Of groups within each other the outermost
        /// decides for all.
        global_lights: bool,
        /// Whether the lights of the group around it shine on the children too: those of the nearest one that has lights.
        outer_lights: bool,
    },
}

impl CsgOp {
    /// Whether the operation keeps all children as they are.
    pub const fn is_union(self) -> bool {
        matches!(self, Self::Union | Self::LightGroup { .. })
    }

    /// The name of the operation.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Union => "union",
            Self::Merge => "merge",
            Self::Intersection => "intersection",
            Self::Difference => "difference",
            Self::Inverse => "inverse",
            Self::Clip => "clipped-by",
            Self::Bound => "bounded-by",
            Self::LightGroup { .. } => "light group",
        }
    }
}

/// A list of objects that can be nested arbitrarily deep: dropping it takes no stack.
#[derive(Clone, Debug, Default)]
pub struct Children(pub Vec<Object>);

impl Drop for Children {
    fn drop(&mut self) {
        let mut waiting = std::mem::take(&mut self.0);
        while let Some(mut object) = waiting.pop() {
            if let ObjectKind::Csg { children, .. } = &mut object.kind {
                waiting.append(&mut children.0);
            }
        }
    }
}

/// The kind of an object.
#[derive(Clone, Debug)]
pub enum ObjectKind {
    /// A surface or solid.
    Shape(Shape),
    /// Children combined to one object.
    Csg {
        /// How.
        op: CsgOp,
        /// What; material, name and span of the parent hold for children that have none.
        children: Children,
    },
    /// An instance of a group, which is not copied.
    Instance(GroupId),
    /// A light, transformed with the object it belongs to; it has no surface.
    Light(Box<SceneLight>),
}

/// The kinds of rays that can see an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Visibility {
    /// Camera rays, also behind transparent objects.
    pub camera: bool,
    /// Reflection rays, also behind transparent objects.
    pub secondary: bool,
    /// Shadow rays.
    pub shadow: bool,
}

impl Default for Visibility {
    fn default() -> Self {
        Self {
            camera: true,
            secondary: true,
            shadow: true,
        }
    }
}

/// One object of a scene.
#[derive(Clone, Debug)]
pub struct Object {
    /// Name for ray trees and messages.
    pub name: Option<Arc<str>>,
    /// The place in the scene that made it.
    pub span: Span,
    /// The material; `None` takes the parent's, or the default material.
    pub material: Option<Arc<Material>>,
    /// The transform to its parent's space; `None` is the identity.
    pub transform: Option<Box<Transform>>,
    /// The rays that can see it.
    pub visibility: Visibility,
    /// Whether fog and rainbows also fill its inside (POV-Ray's `hollow`); `None` takes the parent's, or no.
    pub hollow: Option<bool>,
    /// Whether light on its back shows on its front, too (POV-Ray's `double_illuminate`).
    pub double_illuminated: bool,
    /// Whether its textures and those of its parts lie on the texture coordinates of the surfaces (POV-Ray's `uv_mapping`).
    pub uv_mapped: bool,
    /// Whether it is the visible body of a light (POV-Ray's `looks_like`). As in POV-Ray (measured) rays of the eye never start inside
    /// of it, and in a light group the lights outside of the group shine on it too.
    pub is_lamp: bool,
    /// Its kind.
    pub kind: ObjectKind,
}

/// A list of objects that instances refer to.
#[derive(Clone, Debug, Default)]
pub struct Group {
    /// Name for messages.
    pub name: Option<Arc<str>>,
    /// The objects, in the group's own space.
    pub objects: Children,
}

impl Object {
    /// An object of this kind: no name, no place, default material.
    pub fn new(kind: ObjectKind) -> Self {
        Self {
            name: None,
            span: Span::NONE,
            material: None,
            transform: None,
            visibility: Visibility::default(),
            hollow: None,
            double_illuminated: false,
            uv_mapped: false,
            is_lamp: false,
            kind,
        }
    }

    /// Combines objects.
    pub fn csg(op: CsgOp, children: Vec<Self>) -> Self {
        Self::new(ObjectKind::Csg {
            op,
            children: Children(children),
        })
    }

    /// A light.
    pub fn light(light: SceneLight) -> Self {
        Self::new(ObjectKind::Light(Box::new(light)))
    }

    /// An instance of a group.
    pub fn instance(group: GroupId) -> Self {
        Self::new(ObjectKind::Instance(group))
    }
}

impl<T: Into<Shape>> From<T> for Object {
    fn from(shape: T) -> Self {
        Self::new(ObjectKind::Shape(shape.into()))
    }
}
