use strahl_math::{Aabb, DVec3};
use strahl_scene::{Background, Camera, Scene, SceneLight, Span};
use strahl_shade::{Color, Light};

/// Vertical angle of the camera that frames objects.
const ANGLE: f64 = 35.0 * std::f64::consts::PI / 180.0;

/// A camera that sees all of a box from the front, a little from the right and from above (y is up).
pub(super) fn frame(bounds: Aabb) -> Camera {
    let (center, radius) = if bounds.is_bounded() {
        (bounds.center(), 0.5 * bounds.size().length())
    } else {
        (DVec3::ZERO, 1.0)
    };
    let radius = if radius > 0.0 { radius } else { 1.0 };
    let towards = DVec3::new(0.45, 0.35, 1.0).normalize();
    // The bounding sphere just fits between bottom and top, with a margin of 5 %.
    let distance = 1.05 * radius / strahl_math::det::sin(ANGLE * 0.5);
    Camera::perspective(center + towards * distance, center, DVec3::Y, ANGLE)
}

/// The scene's lights and ambient light. A scene with neither camera nor lights (a bare mesh) gets a key light over the
/// viewer's left shoulder, a weaker fill light from the right and a faint one from behind; they cast no shadows onto
/// what the viewer wants to see but the key light's.
pub(super) fn lights(scene: &Scene, camera: &Camera, bounds: Aabb) -> (Vec<SceneLight>, Color) {
    let ambient = scene.ambient.unwrap_or(Color::gray(0.1));
    let emits = scene.lights.is_empty() && scene.camera.is_none();
    if !emits || !bounds.is_bounded() {
        return (scene.lights.clone(), ambient);
    }
    let (w, u, v) = (
        camera.direction,
        camera.right.normalize(),
        camera.up.normalize(),
    );
    let light = |name: &str, direction: DVec3, strength: f64, shadows: bool| {
        let mut light = Light::directional(direction, Color::gray(strength));
        light.casts_shadows = shadows;
        SceneLight {
            light,
            name: Some(name.into()),
            span: Span::NONE,
        }
    };
    let lights = vec![
        light("key light", w * 0.7 + u * 0.55 - v * 0.75, 0.85, true),
        light("fill light", w * 0.8 - u * 0.9 - v * 0.1, 0.25, false),
        light("rim light", -w * 0.8 - u * 0.2 - v * 0.6, 0.2, false),
    ];
    (lights, ambient)
}

/// Behind objects framed by the renderer: a quiet gradient. Otherwise black.
pub(super) fn background(scene: &Scene, camera: &Camera) -> Background {
    if scene.camera.is_some() {
        return Background::default();
    }
    let up = camera.up.normalize();
    Background::Gradient {
        up,
        bottom: Color::gray(0.12),
        top: Color::new(0.32, 0.36, 0.42),
    }
}
