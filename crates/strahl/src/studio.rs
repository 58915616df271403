//! The studio: a ground, a camera and lights for mesh files, which have none.

use std::sync::Arc;
use strahl_geometry::{Disc, Primitive};
use strahl_math::{Aabb, DVec3, Transform, det};
use strahl_scene::{
    Background, Camera, Children, Object, ObjectExt, ObjectKind, Scene, SceneLight, Span,
};
use strahl_shade::{AreaLight, Color, Light, Material};

/// Vertical angle of the camera.
const ANGLE: f64 = 32.0 * std::f64::consts::PI / 180.0;

/// The fraction of the picture's height that the objects fill.
const MARGIN: f64 = 0.86;

/// The gap between the objects and the ground, relative to their size. Without it, a flat bottom would coincide with the ground.
const GAP: f64 = 1e-4;

/// Adds a ground, a camera and three lights to a scene without camera and lights: a large soft key light from the left, a weak
/// light from the right and one from behind. Returns whether anything was added.
///
/// Scenes with a camera or a light, and scenes without bounds, stay as they are. `up` is the scene's up direction. All additions
/// depend only on the bounds of the objects, and scale with them.
pub fn studio(scene: &mut Scene, up: DVec3) -> bool {
    if scene.camera.is_some() || !scene.lights.is_empty() || has_lights(&scene.objects) {
        return false;
    }
    let bounds = bounds(&scene.objects, scene, &Transform::default(), 0);
    let radius = 0.5 * bounds.size().length();
    if !(bounds.is_bounded() && radius > 0.0 && radius.is_finite()) {
        return false;
    }
    let up = up.normalize_or(DVec3::Y);
    // To the right in the picture, and towards the viewer.
    let across = if up == DVec3::Z {
        DVec3::X
    } else {
        up.any_orthonormal_vector()
    };
    let (right, front) = match up == DVec3::Y {
        true => (DVec3::X, DVec3::Z),
        false => (across, across.cross(up)),
    };
    let center = bounds.center();
    let towards = (0.42 * right + 0.38 * up + front).normalize();
    let camera = camera(center, 0.5 * bounds.size(), towards, up);

    let half = 0.5 * bounds.size();
    let below = (half * up).abs().element_sum() + GAP * radius;
    let foot = center - up * below;
    // Objects without a material look like plaster.
    for object in &mut scene.objects.0 {
        if object.material.is_none() && matches!(object.kind, ObjectKind::Shape(_)) {
            object.material = Some(plaster());
        }
    }
    let ground = Object::from(Disc::new(foot, up, 400.0 * radius, 0.0))
        .material(Material::matte(Color::new(0.36, 0.375, 0.41)))
        .named("ground of the studio");
    scene.objects.0.push(ground);

    let light = |name: &str, place: DVec3, color: Color, shadows: bool| {
        let mut light = Light::point(center + radius * place, color);
        light.casts_shadows = shadows;
        light.highlights = shadows;
        SceneLight {
            light,
            mask: None,
            name: Some(name.into()),
            span: Span::NONE,
        }
    };
    let mut key = light(
        "key light",
        -3.2 * right + 5.0 * up + 3.4 * front,
        Color::new(0.88, 0.84, 0.77),
        true,
    );
    let mut soft = AreaLight::new(2.2 * radius * right, 2.2 * radius * up, 9, 9);
    soft.adaptive = Some(1);
    soft.jitter = true;
    soft.circular = true;
    soft.orient = true;
    key.light.area = Some(soft);
    let fill = light(
        "fill light",
        5.0 * right + 2.0 * up + 4.0 * front,
        Color::new(0.14, 0.16, 0.2),
        false,
    );
    let rim = light(
        "rim light",
        1.5 * right + 3.5 * up - 6.0 * front,
        Color::new(0.24, 0.25, 0.27),
        false,
    );
    scene.lights = vec![key, fill, rim];
    scene.ambient.get_or_insert(Color::new(0.1, 0.105, 0.12));
    scene.background.get_or_insert(Background::Gradient {
        up,
        bottom: Color::new(0.09, 0.1, 0.12),
        top: Color::new(0.16, 0.19, 0.24),
    });
    scene.camera = Some(camera);
    true
}

/// The material of objects without one: off-white, with a soft highlight.
fn plaster() -> Arc<Material> {
    Arc::new(Material::shiny(Color::new(0.84, 0.77, 0.67), 0.18, 24.0).named("plaster"))
}

/// A camera looking against `towards` that sees all of a box.
fn camera(center: DVec3, half: DVec3, towards: DVec3, up: DVec3) -> Camera {
    let right = up.cross(towards).normalize();
    let above = towards.cross(right);
    // From this distance all corners of the box lie within the middle square of the picture, with a margin.
    let slope = MARGIN * det::tan(ANGLE * 0.5);
    let mut distance = 0.0;
    for corner in 0..8 {
        let side = |bit: u32| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let c = half * DVec3::new(side(0), side(1), side(2));
        let (x, y) = (right.dot(c).abs(), above.dot(c).abs());
        let needed = towards.dot(c) + if x > y { x } else { y } / slope;
        if needed > distance {
            distance = needed;
        }
    }
    Camera::perspective(center + towards * distance, center, up, ANGLE)
}

/// Whether one of the objects is a light, or has one among its parts.
fn has_lights(objects: &Children) -> bool {
    let mut waiting = vec![objects];
    while let Some(objects) = waiting.pop() {
        for object in &objects.0 {
            match &object.kind {
                ObjectKind::Light(_) => return true,
                ObjectKind::Csg { children, .. } => waiting.push(children),
                ObjectKind::Shape(_) | ObjectKind::Instance(_) => {}
            }
        }
    }
    false
}

/// The largest nesting depth that is searched.
const DEEPEST: u32 = 100;

/// A box around all objects, without those that have no bounds.
fn bounds(objects: &Children, scene: &Scene, map: &Transform, depth: u32) -> Aabb {
    let mut all = Aabb::EMPTY;
    if depth > DEEPEST {
        return all;
    }
    for object in &objects.0 {
        let own = object.transform.as_deref().copied().unwrap_or_default();
        let map = own.then(map);
        let one = match &object.kind {
            ObjectKind::Shape(shape) => {
                let bounds = shape.bounds();
                if bounds.is_bounded() && !bounds.is_empty() {
                    map.bounds_to_world(&bounds)
                } else {
                    Aabb::EMPTY
                }
            }
            ObjectKind::Csg { children, .. } => bounds(children, scene, &map, depth + 1),
            ObjectKind::Instance(id) => match scene.groups.get(id.0 as usize) {
                Some(group) => bounds(&group.objects, scene, &map, depth + 1),
                None => Aabb::EMPTY,
            },
            ObjectKind::Light(_) => Aabb::EMPTY,
        };
        all = all.union(&one);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_geometry::Sphere;

    fn staged(center: DVec3, radius: f64, up: DVec3) -> Scene {
        let mut scene = Scene::new().add(Sphere::new(center, radius));
        assert!(studio(&mut scene, up));
        scene
    }

    fn pixels(scene: &Scene) -> Vec<[f32; 3]> {
        let scene = strahl_render::compile(scene, &strahl_render::CompileOptions::default())
            .expect("a valid scene");
        let options = strahl_render::RenderOptions::new(&scene, 40, 30);
        let film = strahl_render::render(&scene, &options).expect("a picture");
        film.film.pixels
    }

    fn difference(a: &[[f32; 3]], b: &[[f32; 3]]) -> f32 {
        let sum: f32 = a
            .as_flattened()
            .iter()
            .zip(b.as_flattened())
            .map(|(a, b)| (a - b).abs())
            .sum();
        sum / a.as_flattened().len() as f32
    }

    #[test]
    fn the_picture_does_not_depend_on_size_place_and_direction() {
        let reference = pixels(&staged(DVec3::ZERO, 1.0, DVec3::Y));
        for (center, radius, up) in [
            (DVec3::ZERO, 1e-3, DVec3::Y),
            (DVec3::new(300.0, -500.0, 70.0), 250.0, DVec3::Y),
            (DVec3::ZERO, 2.0, DVec3::Z),
        ] {
            let other = pixels(&staged(center, radius, up));
            let d = difference(&reference, &other);
            assert!(d < 0.02, "{center} {radius} {up}: {d}");
        }
        // A light object on a darker ground, neither black nor overexposed.
        let gray = |x: usize, y: usize| reference[y * 40 + x][1];
        assert!((0.3..1.0).contains(&gray(17, 12)), "{}", gray(17, 12));
        assert!((0.05..0.6).contains(&gray(2, 2)), "{}", gray(2, 2));
    }

    #[test]
    fn scenes_with_a_camera_or_a_light_stay_as_they_are() {
        let sphere = || Scene::new().add(Sphere::new(DVec3::ZERO, 1.0));
        let camera = Camera::perspective(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y, 0.5);
        let light = Light::point(DVec3::Y * 5.0, Color::gray(1.0));
        for mut scene in [Scene::new(), sphere().camera(camera), sphere().light(light)] {
            let objects = scene.objects.0.len();
            assert!(!studio(&mut scene, DVec3::Y));
            assert_eq!(scene.objects.0.len(), objects);
        }
    }
}
