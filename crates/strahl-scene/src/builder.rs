use crate::{
    Background, Camera, Group, GroupId, Object, Scene, SceneLight, Settings, Span, Visibility,
};
use std::panic::Location;
use std::sync::Arc;
use strahl_math::{DVec3, SingularTransform, Transform};
use strahl_shade::{Color, Light, Material};

/// Methods to set the attributes of any object, also directly on shapes.
///
/// ```
/// use strahl_geometry::Sphere;
/// use strahl_math::DVec3;
/// use strahl_scene::ObjectExt;
/// use strahl_shade::{Color, Material};
///
/// let ball = Sphere::new(DVec3::ZERO, 1.0)
///     .material(Material::matte(Color::new(0.9, 0.2, 0.1)))
///     .named("ball")
///     .translated(DVec3::new(0.0, 1.0, 0.0));
/// assert_eq!(ball.name.as_deref(), Some("ball"));
/// ```
pub trait ObjectExt: Into<Object> {
    /// Sets the material; pass an `Arc` to share one among many objects.
    fn material(self, material: impl Into<Arc<Material>>) -> Object {
        Object {
            material: Some(material.into()),
            ..self.into()
        }
    }

    /// Sets the name.
    fn named(self, name: &str) -> Object {
        Object {
            name: Some(name.into()),
            ..self.into()
        }
    }

    /// Sets the place in the source.
    fn spanned(self, span: Span) -> Object {
        Object {
            span,
            ..self.into()
        }
    }

    /// Sets the kinds of rays that can see the object.
    fn visible_to(self, visibility: Visibility) -> Object {
        Object {
            visibility,
            ..self.into()
        }
    }

    /// Transforms the object, after the transformations it already has.
    fn transformed(self, transform: &Transform) -> Object {
        let object: Object = self.into();
        let before = object.transform.as_deref().copied().unwrap_or_default();
        let after = before.then(transform);
        let transform = (!after.is_identity()).then(|| Box::new(after));
        Object {
            transform,
            ..object
        }
    }

    /// Moves the object.
    fn translated(self, offset: DVec3) -> Object {
        self.transformed(&Transform::translate(offset))
    }

    /// Rotates the object about an axis through the origin, by radians.
    fn rotated(self, axis: DVec3, radians: f64) -> Object {
        self.transformed(&Transform::rotate(axis, radians))
    }

    /// Scales the object about the origin.
    ///
    /// # Errors
    /// [`SingularTransform`] if a factor is zero or not finite.
    fn try_scaled(self, factors: DVec3) -> Result<Object, SingularTransform> {
        Ok(self.transformed(&Transform::try_scale(factors)?))
    }
}

impl<T: Into<Object>> ObjectExt for T {}

impl Scene {
    /// An empty scene.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds an object. An object without a place of its own remembers the caller's source line, so that ray trees can name
    /// it.
    #[must_use]
    #[track_caller]
    #[expect(
        clippy::should_implement_trait,
        reason = "a scene is built by adding to it; nobody writes `scene + sphere`"
    )]
    pub fn add(mut self, object: impl Into<Object>) -> Self {
        let mut object = object.into();
        if !object.span.is_some() {
            object.span = self.caller(Location::caller());
        }
        self.objects.0.push(object);
        self
    }

    /// Adds a light.
    #[must_use]
    #[track_caller]
    pub fn light(mut self, light: Light) -> Self {
        let span = self.caller(Location::caller());
        self.lights.push(SceneLight {
            light,
            mask: None,
            name: None,
            span,
        });
        self
    }

    /// Sets the camera.
    #[must_use]
    pub fn camera(mut self, camera: Camera) -> Self {
        self.camera = Some(camera);
        self
    }

    /// Sets the ambient light Ia.
    #[must_use]
    pub fn ambient(mut self, color: Color) -> Self {
        self.ambient = Some(color);
        self
    }

    /// Sets the background.
    #[must_use]
    pub fn background(mut self, background: Background) -> Self {
        self.background = Some(background);
        self
    }

    /// Sets the renderer's defaults.
    #[must_use]
    pub fn settings(mut self, settings: Settings) -> Self {
        self.settings = settings;
        self
    }

    /// Adds a group of objects that [`Object::instance`] can place any number of times.
    pub fn add_group(&mut self, objects: Vec<Object>) -> GroupId {
        self.groups.push(Group {
            name: None,
            objects: crate::Children(objects),
        });
        GroupId(self.groups.len() as u32 - 1)
    }

    fn caller(&mut self, location: &Location<'_>) -> Span {
        let file = self.sources.add(location.file());
        Span {
            file,
            line: location.line(),
            column: location.column(),
            length: 0,
        }
    }
}
