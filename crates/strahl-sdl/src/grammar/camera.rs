use crate::keywords::Word;
use crate::parser::{PResult, Parser, Place};
use strahl_math::{DVec3, Transform, det};
use strahl_scene::{Camera, Projection};

/// `camera { ... }` as a statement: the last one counts.
pub(super) fn camera_statement(p: &mut Parser<'_>) -> PResult<()> {
    let camera = p.camera()?;
    p.scene.camera = Some(camera);
    Ok(())
}

/// The vectors of the language's camera. `right` points to the right edge with its whole length the width of the picture.
struct View {
    location: DVec3,
    direction: DVec3,
    right: DVec3,
    up: DVec3,
    sky: DVec3,
    projection: Projection,
    angle: Option<f64>,
}

impl View {
    /// Turns the camera to a point: lengths and handedness of its vectors stay.
    fn look_at(&mut self, point: DVec3) -> bool {
        let forward = point - self.location;
        let handedness = self.up.cross(self.direction).dot(self.right);
        let sideways = self.sky.cross(forward);
        if !(forward.length() > 0.0
            && sideways.length() > 1e-12 * self.sky.length() * forward.length())
        {
            return false;
        }
        let direction = forward.normalize();
        let right = sideways.normalize();
        let up = direction.cross(right);
        let side = if handedness < 0.0 { -1.0 } else { 1.0 };
        self.direction = direction * self.direction.length();
        self.right = right * (self.right.length() * side);
        self.up = up * self.up.length();
        true
    }

    fn transform(&mut self, t: &Transform) {
        self.location = t.point_to_world(self.location);
        for v in [
            &mut self.direction,
            &mut self.right,
            &mut self.up,
            &mut self.sky,
        ] {
            *v = t.vector_to_world(*v);
        }
    }
}

impl Parser<'_> {
    /// `{ ... }` or `{ Name ... }` behind `camera`.
    pub(super) fn camera(&mut self) -> PResult<Camera> {
        let place = self.place();
        let mut view = View {
            location: DVec3::ZERO,
            direction: DVec3::Z,
            right: DVec3::new(4.0 / 3.0, 0.0, 0.0),
            up: DVec3::Y,
            sky: DVec3::Y,
            projection: Projection::Perspective,
            angle: None,
        };
        let mut named = None;
        self.braces(|p| {
            named = p.accept_thing(|thing| match thing {
                super::Thing::Camera(camera) => Some(camera),
                _ => None,
            })?;
            if let Some(camera) = &named {
                view.location = camera.eye;
                view.direction = camera.direction;
                view.right = camera.right * 2.0;
                view.up = camera.up * 2.0;
                view.projection = camera.projection;
            }
            p.items("`camera`", |p, token| {
                let Some(word) = token.word() else {
                    return Err(p.unexpected(token, "an item of `camera`, or `}`"));
                };
                match word {
                    Word::Perspective | Word::Orthographic => {
                        p.take(token)?;
                        view.projection = match word {
                            Word::Perspective => Projection::Perspective,
                            _ => Projection::Orthographic,
                        };
                        return Ok(());
                    }
                    Word::Angle => {
                        p.take(token)?;
                        view.angle = Some(p.camera_angle()?);
                        return Ok(());
                    }
                    Word::LookAt => {
                        p.take(token)?;
                        let at = p.vector3()?;
                        if !view.look_at(at) {
                            let place = p.place();
                            p.warn(place, "`look_at` has no effect: the point is at the camera, or straight along `sky`");
                        }
                        return Ok(());
                    }
                    _ => {}
                }
                let vector = match word {
                    Word::Location => &mut view.location,
                    Word::Direction => &mut view.direction,
                    Word::Right => &mut view.right,
                    Word::Up => &mut view.up,
                    Word::Sky => &mut view.sky,
                    _ => {
                        return match p.transformation(token)? {
                            Some(t) => {
                                view.transform(&t);
                                Ok(())
                            }
                            None => p.skip_item(token, "`camera`"),
                        };
                    }
                };
                p.take(token)?;
                *vector = p.vector3()?;
                Ok(())
            })
        })?;
        self.finish_camera(view, place)
    }

    fn camera_angle(&mut self) -> PResult<f64> {
        let angle = self.float()?;
        let place = self.place();
        if angle > 0.0 && angle < 180.0 {
            return Ok(angle);
        }
        Err(self.fail(
            place,
            format!("the angle of a perspective camera is between 0 and 180 degrees, not {angle}"),
        ))
    }

    fn finish_camera(&mut self, mut view: View, place: Place) -> PResult<Camera> {
        if let (Some(angle), Projection::Perspective) = (view.angle, view.projection) {
            // The angle spans the width of the picture.
            let distance = view.right.length() * 0.5 / det::tan(angle.to_radians() * 0.5);
            view.direction = view.direction.normalize_or_zero() * distance;
        }
        let camera = Camera {
            eye: view.location,
            direction: view.direction,
            right: view.right * 0.5,
            up: view.up * 0.5,
            projection: view.projection,
            aspect: Some(1.0),
            span: self.span_at(place),
        };
        match camera.problem() {
            None => Ok(camera),
            Some(problem) => Err(self.fail(place, problem)),
        }
    }
}
