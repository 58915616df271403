use crate::{Lens, Projection, Span};
use std::sync::Arc;
use strahl_math::{DVec3, det};
use strahl_shade::normal::PovNormal;

/// The eye and its viewing coordinate system.
///
/// The picture spans `right` and `up` from its centre to its edges, so image coordinates `x, y` in `-1..=1` (x to the right, y
/// upwards) name the point `eye + direction + x·right + y·up` of the image plane. `right` is stretched by the
/// picture's aspect ratio unless `aspect` fixes one. Nothing requires the three vectors to be perpendicular.
#[derive(Clone, Debug)]
pub struct Camera {
    /// Position of the eye.
    pub eye: DVec3,
    /// From the eye to the centre of the image plane: the main viewing direction, the negative z axis of the viewing system.
    pub direction: DVec3,
    /// From the centre of the picture to its right edge, for a square picture.
    pub right: DVec3,
    /// From the centre of the picture to its top edge.
    pub up: DVec3,
    /// How rays leave it.
    pub projection: Projection,
    /// The lens for focal blur; `None` is a pinhole.
    pub lens: Option<Lens>,
    /// Perturbs the rays; evaluated at the position in the picture, from -0.5 to 0.5 in x and y.
    pub normal: Option<Arc<PovNormal>>,
    /// Fixed width-to-height ratio of the view; `None` takes the picture's.
    pub aspect: Option<f64>,
    /// The place of the camera in the scene file.
    pub span: Span,
}

impl Camera {
    /// A perspective camera: `vertical_angle` is the full angle in radians from the bottom to the top of the picture, in
    /// `0..pi`.
    pub fn perspective(eye: DVec3, look_at: DVec3, up: DVec3, vertical_angle: f64) -> Self {
        let half = det::tan(vertical_angle * 0.5);
        Self::looking(eye, look_at - eye, up, half, half, Projection::Perspective)
    }

    /// An orthographic camera that sees `height` world units from the bottom to the top of the picture.
    pub fn orthographic(eye: DVec3, look_at: DVec3, up: DVec3, height: f64) -> Self {
        Self::looking(
            eye,
            look_at - eye,
            up,
            height * 0.5,
            height * 0.5,
            Projection::Orthographic,
        )
    }

    /// A camera from its eye, any viewing direction, any vector that is not parallel to it and marks "up", and the half
    /// extents of the image plane (at distance 1 from the eye in perspective).
    pub fn looking(
        eye: DVec3,
        direction: DVec3,
        up: DVec3,
        half_width: f64,
        half_height: f64,
        projection: Projection,
    ) -> Self {
        let w = direction.normalize_or(DVec3::NEG_Z);
        let mut u = w.cross(up);
        if !(u.length() > 1e-12 * up.length()) {
            // Looking along "up": any other axis will do.
            u = w.cross(if w.x.abs() < 0.9 { DVec3::X } else { DVec3::Y });
        }
        let u = u.normalize_or(DVec3::X);
        let v = u.cross(w);
        Self {
            eye,
            direction: w,
            right: u * half_width,
            up: v * half_height,
            projection,
            lens: None,
            normal: None,
            aspect: None,
            span: Span::NONE,
        }
    }

    /// The error in the camera, if there is one: non-finite numbers, or vectors that span no picture.
    pub fn problem(&self) -> Option<&'static str> {
        let all = [self.eye, self.direction, self.right, self.up];
        if all.iter().any(|v| !v.is_finite()) {
            return Some("the camera has a value that is not a finite number");
        }
        if self.aspect.is_some_and(|a| !(a > 0.0 && a.is_finite())) {
            return Some("the camera's aspect ratio must be positive");
        }
        if self
            .projection
            .angles()
            .any(|a| !(a > 0.0 && a.is_finite()))
        {
            return Some("the camera's angle must be positive");
        }
        if matches!(self.projection, Projection::Mesh(_)) {
            // The direction comes from the faces.
            return None;
        }
        let volume = self.right.cross(self.up).dot(self.direction);
        if volume == 0.0 || !volume.is_finite() {
            return Some(
                "the camera sees nothing: its viewing direction, right and up vectors must span space \
                 (is the eye at the point looked at, or the angle 0 or 180 degrees?)",
            );
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn right_is_right_and_up_is_up() {
        let c = Camera::perspective(
            DVec3::new(0.0, 0.0, 5.0),
            DVec3::ZERO,
            DVec3::Y,
            std::f64::consts::FRAC_PI_2,
        );
        assert_eq!(c.direction, DVec3::NEG_Z);
        assert!((c.right - DVec3::X).length() < 1e-15 && (c.up - DVec3::Y).length() < 1e-15);
        assert_eq!(c.problem(), None);
    }

    #[test]
    fn looking_along_up_still_gives_a_picture() {
        let c = Camera::orthographic(DVec3::Z, DVec3::ZERO, DVec3::Z, 2.0);
        assert_eq!(c.problem(), None);
    }

    #[test]
    fn impossible_cameras_are_named() {
        let flat = Camera::perspective(DVec3::ZERO, DVec3::X, DVec3::Y, 0.0);
        assert!(flat.problem().is_some_and(|p| p.contains("sees nothing")));
        let nan = Camera::perspective(DVec3::splat(f64::NAN), DVec3::X, DVec3::Y, 1.0);
        assert!(nan.problem().is_some_and(|p| p.contains("finite")));
    }
}
