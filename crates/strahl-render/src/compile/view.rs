use strahl_math::{Aabb, DVec3};
use strahl_scene::{Background, Camera, Scene, SceneLight, Span};
use strahl_shade::{Color, Light};

/// Vertical angle of the camera that frames objects.
const ANGLE: f64 = 35.0 * std::f64::consts::PI / 180.0;

/// The part of the picture's height that the bounding box of the objects may take.
const MARGIN: f64 = 0.95;

/// A camera that sees all of a box from the front, a little from the right and from above (y is up).
pub(super) fn frame(bounds: Aabb) -> Camera {
    let (center, half) = if bounds.is_bounded() && bounds.size() != DVec3::ZERO {
        (bounds.center(), 0.5 * bounds.size())
    } else {
        (DVec3::ZERO, DVec3::ONE)
    };
    let towards = DVec3::new(0.45, 0.35, 1.0).normalize();
    let right = DVec3::Y.cross(towards).normalize();
    let up = towards.cross(right);
    // From this distance all corners of the box lie within the middle square of the picture, with a margin.
    let slope = MARGIN * strahl_math::det::tan(ANGLE * 0.5);
    let mut distance = 0.0;
    for corner in 0..8 {
        let side = |bit: u32| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let c = half * DVec3::new(side(0), side(1), side(2));
        let (across, above) = (right.dot(c).abs(), up.dot(c).abs());
        let needed = towards.dot(c) + if across > above { across } else { above } / slope;
        if needed > distance {
            distance = needed;
        }
    }
    Camera::perspective(center + towards * distance, center, DVec3::Y, ANGLE)
}

/// The scene's lights and ambient light. A scene with neither camera nor lights (a bare mesh) gets a key light over the
/// viewer's left shoulder, a weaker fill light from the right and a faint one from behind; only the key light casts shadows.
pub(super) fn lights(
    scene: &Scene,
    of_objects: Vec<SceneLight>,
    camera: &Camera,
    bounds: Aabb,
) -> (Vec<SceneLight>, Color) {
    let ambient = scene.ambient.unwrap_or(Color::gray(0.1));
    let own = [scene.lights.as_slice(), &of_objects].concat();
    let emits = own.is_empty() && scene.camera.is_none();
    if !emits || !bounds.is_bounded() {
        return (own, ambient);
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
            mask: None,
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

/// A gentle gradient behind objects that are framed by the renderer; black otherwise.
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
