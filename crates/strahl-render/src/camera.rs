use strahl_math::Ray;
use strahl_scene::{Camera, Projection};

/// Makes the primary rays of a picture.
#[derive(Clone, Copy, Debug)]
pub struct PrimaryRays {
    camera: Camera,
    width: f64,
    height: f64,
}

impl PrimaryRays {
    /// For a picture of `width` by `height` pixels.
    pub fn new(camera: &Camera, width: u32, height: u32) -> Self {
        let (width, height) = (f64::from(width), f64::from(height));
        let mut camera = *camera;
        camera.right *= camera.aspect.unwrap_or(width / height);
        Self {
            camera,
            width,
            height,
        }
    }

    /// The ray through image coordinates in pixels: `(0, 0)` is the top left corner of the picture, `(0.5, 0.5)` the
    /// centre of its first pixel. The direction is a unit vector.
    pub fn ray(&self, x: f64, y: f64) -> Ray {
        let c = &self.camera;
        let sideways =
            c.right * (2.0 * x / self.width - 1.0) + c.up * (1.0 - 2.0 * y / self.height);
        match c.projection {
            Projection::Perspective => Ray::new(c.eye, (c.direction + sideways).normalize()),
            Projection::Orthographic => Ray::new(c.eye + sideways, c.direction.normalize()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strahl_math::DVec3;

    #[test]
    fn the_picture_is_not_mirrored() {
        let c = Camera::perspective(DVec3::Z, DVec3::ZERO, DVec3::Y, std::f64::consts::FRAC_PI_2);
        let rays = PrimaryRays::new(&c, 200, 100);
        let top_left = rays.ray(0.0, 0.0).direction;
        assert!((top_left - DVec3::new(-2.0, 1.0, -1.0).normalize()).length() < 1e-15);
        assert!((rays.ray(100.0, 50.0).direction - DVec3::NEG_Z).length() < 1e-15);
    }

    #[test]
    fn orthographic_rays_are_parallel() {
        let c = Camera::orthographic(DVec3::Z, DVec3::ZERO, DVec3::Y, 2.0);
        let rays = PrimaryRays::new(&c, 100, 100);
        let (a, b) = (rays.ray(0.0, 0.0), rays.ray(100.0, 100.0));
        assert_eq!(a.direction, b.direction);
        assert!((a.origin - DVec3::new(-1.0, 1.0, 1.0)).length() < 1e-15);
    }
}
