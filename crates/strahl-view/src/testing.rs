//! What several tests need.

use strahl::prelude::*;

/// A ball of radius 1 with this name, lit from the upper right.
pub(crate) fn ball(name: &str) -> Scene {
    Scene::new()
        .add(Sphere::new(DVec3::ZERO, 1.0).named(name))
        .light(Light::point(DVec3::new(4.0, 8.0, 6.0), Color::WHITE))
        .camera(Camera::perspective(
            DVec3::Z * 7.0,
            DVec3::ZERO,
            DVec3::Y,
            0.7,
        ))
}
