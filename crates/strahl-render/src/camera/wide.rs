//! The rays of cameras that are neither perspective nor orthographic.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use strahl_math::{DVec3, Ray, det};
use strahl_scene::{Camera, Projection};

/// The axes of a camera.
struct Axes {
    /// The picture's width and height as vectors.
    right: DVec3,
    up: DVec3,
    /// Unit vectors to the right, up and forward.
    side: DVec3,
    above: DVec3,
    forward: DVec3,
}

/// The direction of a ray, of any length, and the position at which the camera's `normal` is evaluated.
type Direction = (DVec3, [f64; 2]);

/// The ray at coordinates from -1 to 1, and the position at which the camera's `normal` is evaluated: the two angles, where the
/// projection has them (measured with POV-Ray 3.7, except for panoramic cameras).
pub(super) fn ray(camera: &Camera, at: [f64; 2]) -> Option<(Ray, [f64; 2])> {
    let (right, up) = (camera.right * 2.0, camera.up * 2.0);
    let axes = &Axes {
        right,
        up,
        side: right.normalize_or_zero(),
        above: up.normalize_or_zero(),
        forward: camera.direction.normalize_or_zero(),
    };
    let half = at.map(|x| 0.5 * x);
    let mut eye = camera.eye;
    let (direction, place) = match camera.projection {
        Projection::Fisheye { angle } => fisheye(axes, at, angle)?,
        Projection::Omnimax => omnimax(axes, at)?,
        Projection::UltraWideAngle { angle } => ultra_wide_angle(axes, half, angle),
        Projection::Panoramic => panoramic(axes, half, camera.direction),
        Projection::Cylinder {
            upright,
            moving,
            angle,
        } => {
            let (straight, along, place) = cylinder(axes, half, upright, angle);
            if moving {
                eye += along;
                (straight, place)
            } else {
                (straight + along, place)
            }
        }
        Projection::Spherical {
            horizontal,
            vertical,
        } => spherical(axes, half, [horizontal, vertical]),
        Projection::Perspective | Projection::Orthographic | Projection::Mesh(_) => return None,
    };
    let length = direction.length();
    (length > 0.0).then(|| (Ray::new(eye, direction / length), place))
}

fn fisheye(axes: &Axes, [u, v]: [f64; 2], angle: f64) -> Option<Direction> {
    let (a, b) = (u * axes.right.length(), v * axes.up.length());
    let radius = (a * a + b * b).sqrt();
    if radius > 1.0 {
        return None;
    }
    let theta = radius * angle * 0.5;
    Some((polar(theta, [a, b], axes), [turn(a, b), theta]))
}

fn omnimax(axes: &Axes, at: [f64; 2]) -> Option<Direction> {
    let [a, b] = omnimax_film(at, axes.right.length() / axes.up.length());
    let r = (a * a + b * b).sqrt();
    if r > 1.0 {
        return None;
    }
    // The lens of Omnimax projectors: the angle as a function of the distance from the axis of the film (N. Max,
    // "Computer graphics distortion for IMAX and OMNIMAX projection", Nicograph 1983).
    let theta = r * (1.411_269 + r * r * (r * r * 0.256_74 - 0.094_39));
    let direction = polar(theta, [a, b], axes);
    if direction.dot(axes.above) < -direction.dot(axes.forward) {
        return None;
    }
    Some((direction, [turn(a, b), theta]))
}

fn ultra_wide_angle(axes: &Axes, [half_u, half_v]: [f64; 2], angle: f64) -> Direction {
    let a = half_u * angle;
    let b = half_v * angle * axes.up.length() / axes.right.length();
    let ((sin_a, cos_a), (sin_b, cos_b)) = (det::sin_cos(a), det::sin_cos(b));
    let flat = axes.side * sin_a + axes.above * sin_b;
    (flat + axes.forward * (cos_a * cos_b), [a, b])
}

/// `direction` is the camera's, whose length counts.
fn panoramic(axes: &Axes, [half_u, half_v]: [f64; 2], direction: DVec3) -> Direction {
    let (a, b) = (half_u * PI, half_v * PI);
    let ((sin_a, cos_a), (sin_b, cos_b)) = (det::sin_cos(a), det::sin_cos(b));
    let level = axes.right * sin_a + direction * cos_a;
    // The place for `normal` is measured from the right (as in POV-Ray).
    (level * cos_b + axes.up * sin_b, [FRAC_PI_2 - a, b])
}

/// The direction perpendicular to the axis of the cylinder, the way along the axis, and the position for `normal`.
fn cylinder(
    axes: &Axes,
    [half_u, half_v]: [f64; 2],
    upright: bool,
    angle: f64,
) -> (DVec3, DVec3, [f64; 2]) {
    let (axis, along, around, across) = if upright {
        (axes.up, half_v, half_u * angle, axes.side)
    } else {
        (axes.right, half_u, half_v * angle, axes.above)
    };
    let (sin, cos) = det::sin_cos(around);
    let straight = across * sin + axes.forward * cos;
    let distance = along * axis.length();
    let place = if upright {
        [around, distance]
    } else {
        [distance, around]
    };
    (straight, axis * along, place)
}

fn spherical(
    axes: &Axes,
    [half_u, half_v]: [f64; 2],
    [horizontal, vertical]: [f64; 2],
) -> Direction {
    // First a rotation about the axis to the right, then one about the vertical axis.
    let (a, b) = (half_u * horizontal, half_v * vertical);
    let tilted = turned(axes.forward, axes.side, -b);
    (turned(tilted, axes.above, a), [a, b])
}

/// The position on the film of an Omnimax projector for a position in a picture with this aspect ratio: the visible part of the
/// dome reaches the top of the picture, and in wide pictures the bottom too (measured with POV-Ray 3.7).
fn omnimax_film([u, v]: [f64; 2], aspect: f64) -> [f64; 2] {
    /// Half the height of the film from the top of the dome down to 45 degrees below the horizon.
    const HALF_HEIGHT: f64 = 0.779_14;
    let tall = 1.0 / aspect;
    let scale = if tall > HALF_HEIGHT {
        tall
    } else {
        HALF_HEIGHT
    };
    let (wide, raised) = (scale * aspect, 1.0 - scale);
    [
        if wide > 1.0 { u * wide } else { u },
        scale * v + if raised > 0.0 { raised } else { 0.0 },
    ]
}

/// The direction at the angle `theta` from the axis forward, on the side of the point `[a, b]` in the plane of the other two.
fn polar(theta: f64, [a, b]: [f64; 2], axes: &Axes) -> DVec3 {
    let radius = (a * a + b * b).sqrt();
    let (sin, cos) = det::sin_cos(theta);
    let straight = axes.forward * cos;
    if radius > 0.0 {
        straight + (axes.side * a + axes.above * b) * (sin / radius)
    } else {
        straight
    }
}

/// The polar angle of a point in the plane, from -90 to 270 degrees as POV-Ray counts it.
fn turn(a: f64, b: f64) -> f64 {
    let angle = det::atan2(b, a);
    if angle < -FRAC_PI_2 {
        angle + TAU
    } else {
        angle
    }
}

/// A vector rotated by an angle about a unit axis (Rodrigues' formula).
fn turned(v: DVec3, axis: DVec3, angle: f64) -> DVec3 {
    let (sin, cos) = det::sin_cos(angle);
    v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos))
}
