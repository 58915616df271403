use crate::keywords::Word;
use crate::parser::{PResult, Parser, Place};
use crate::token::Token;
use strahl_math::{DVec3, Transform, det};
use strahl_scene::{Camera, Projection};

/// `camera { ... }` as a statement: the last one counts.
pub(super) fn camera_statement(p: &mut Parser<'_>) -> PResult<()> {
    let camera = p.camera()?;
    p.scene.camera = Some(camera);
    Ok(())
}

/// A camera being read. The order of items does not matter: the view is made of them at the closing brace, first the angle,
/// then `look_at`, then the transformations (measured with POV-Ray 3.7).
struct Draft {
    location: DVec3,
    direction: DVec3,
    /// As long as the picture is wide.
    right: DVec3,
    /// As long as the picture is high.
    up: DVec3,
    sky: DVec3,
    look_at: Option<DVec3>,
    /// Horizontal and vertical angle in degrees.
    angle: Option<(f64, Option<f64>)>,
    projection: Projection,
    /// Whether `right` or `up` was given.
    sized: bool,
    /// Whether it began as a declared camera, whose view is already made.
    named: bool,
    transform: Transform,
}

impl Draft {
    fn new() -> Self {
        Self {
            location: DVec3::ZERO,
            direction: DVec3::Z,
            right: DVec3::new(1.33, 0.0, 0.0),
            up: DVec3::Y,
            sky: DVec3::Y,
            look_at: None,
            angle: None,
            projection: Projection::Perspective,
            sized: false,
            named: false,
            transform: Transform::IDENTITY,
        }
    }

    fn of(camera: &Camera) -> Self {
        Self {
            location: camera.eye,
            direction: camera.direction,
            right: camera.right * 2.0,
            up: camera.up * 2.0,
            projection: camera.projection,
            sized: true,
            named: true,
            ..Self::new()
        }
    }

    /// Turns the camera to a point: lengths and handedness of its vectors stay. `false` if the point is at the camera.
    fn turn_to(&mut self, point: DVec3) -> bool {
        let forward = (point - self.location).normalize_or_zero();
        if forward == DVec3::ZERO {
            return false;
        }
        let handedness = self.up.cross(self.direction).dot(self.right);
        let sideways = self.sky.cross(forward);
        // Straight along the sky the camera does not turn sideways.
        let right = if sideways.length() > 1e-12 * self.sky.length() {
            sideways.normalize()
        } else {
            self.right.normalize_or(DVec3::X)
        };
        // An `up` along the direction, as scenes with z upwards have it by default, counts as right-handed.
        let side = if handedness > 0.0 { 1.0 } else { -1.0 };
        let up = forward.cross(right).normalize_or(DVec3::Y);
        self.direction = forward * self.direction.length();
        self.right = right * (self.right.length() * side);
        self.up = up * self.up.length();
        true
    }

    /// Fits lengths to the angle.
    fn apply_angle(&mut self) {
        let slope = self
            .angle
            .map(|(angle, _)| det::tan(angle.to_radians() * 0.5));
        match (self.projection, slope) {
            (Projection::Perspective, Some(slope)) => {
                let distance = self.right.length() * 0.5 / slope;
                self.direction = self.direction.normalize_or_zero() * distance;
            }
            (Projection::Orthographic, _) => {
                // A perspective camera would see the same at the point looked at.
                let distance = (self.look_at.unwrap_or(DVec3::Z) - self.location).length();
                let scale = match slope {
                    Some(slope) => 2.0 * slope * distance / self.right.length(),
                    None if self.sized => 1.0,
                    None => distance / self.direction.length(),
                };
                self.right *= scale;
                self.up *= scale;
            }
            _ => {}
        }
    }
}

impl Parser<'_> {
    /// `{ ... }` or `{ Name ... }` behind `camera`.
    pub(super) fn camera(&mut self) -> PResult<Camera> {
        let place = self.place();
        let mut draft = Draft::new();
        self.braces(|p| {
            p.items("`camera`", |p, token| {
                let named = p.accept_thing(|thing| match thing {
                    super::Thing::Camera(camera) => Some(camera),
                    _ => None,
                })?;
                if let Some(camera) = named {
                    draft = Draft::of(&camera);
                    return Ok(());
                }
                p.camera_item(&mut draft, token)
            })
        })?;
        self.finish_camera(draft, place)
    }

    fn camera_item(&mut self, draft: &mut Draft, token: Token) -> PResult<()> {
        if let Some(next) = self.transformation(token)? {
            draft.transform = draft.transform.then(&next);
            return Ok(());
        }
        let Some(word) = token.word() else {
            return Err(self.unexpected(token, "an item of `camera`, or `}`"));
        };
        let place = self.place_of(token);
        match word {
            Word::Perspective | Word::Orthographic => {
                self.take(token)?;
                draft.projection = match word {
                    Word::Perspective => Projection::Perspective,
                    _ => Projection::Orthographic,
                };
            }
            Word::Fisheye
            | Word::UltraWideAngle
            | Word::Omnimax
            | Word::Panoramic
            | Word::Spherical
            | Word::Cylinder
            | Word::MeshCamera => {
                self.take(token)?;
                self.warn_hint(
                    place,
                    format!("the `{}` camera is not supported yet", word.text()),
                    "a perspective camera takes its place: the picture will show another view",
                );
                match word {
                    Word::Cylinder => drop(self.float()?),
                    Word::MeshCamera => self.skip_body()?,
                    _ => {}
                }
            }
            Word::Angle => {
                self.take(token)?;
                let horizontal = self.float()?;
                self.comma()?;
                let vertical = if self.number_follows()? {
                    Some(self.float()?)
                } else {
                    None
                };
                draft.angle = Some((horizontal, vertical));
            }
            Word::LookAt => {
                self.take(token)?;
                draft.look_at = Some(self.vector3()?);
            }
            Word::Location => {
                self.take(token)?;
                draft.location = self.vector3()?;
            }
            Word::Direction => {
                self.take(token)?;
                draft.direction = self.vector3()?;
            }
            Word::Sky => {
                self.take(token)?;
                draft.sky = self.vector3()?;
            }
            Word::Right => {
                self.take(token)?;
                draft.right = self.vector3()?;
                draft.sized = true;
            }
            Word::Up => {
                self.take(token)?;
                draft.up = self.vector3()?;
                draft.sized = true;
            }
            _ => return self.camera_effect(token, word),
        }
        Ok(())
    }

    /// Items that blur or bend the view: read, and named as missing where they matter.
    fn camera_effect(&mut self, token: Token, word: Word) -> PResult<()> {
        let place = self.place_of(token);
        match word {
            Word::Aperture => {
                self.take(token)?;
                if self.float()? != 0.0 {
                    self.warn_hint(
                        place,
                        "`aperture`: focal blur is not supported yet",
                        "the picture will be sharp everywhere",
                    );
                }
            }
            Word::BlurSamples => {
                self.take(token)?;
                self.float()?;
                self.comma()?;
                if self.number_follows()? {
                    self.float()?;
                }
            }
            Word::Confidence | Word::Variance => {
                self.take(token)?;
                self.float()?;
            }
            Word::FocalPoint => {
                self.take(token)?;
                self.vector3()?;
            }
            Word::Normal | Word::Bokeh => {
                self.take(token)?;
                let message = format!("`{}` in `camera` is not supported yet", word.text());
                self.warn_hint(place, message, "the picture will lack its effect");
                self.skip_body()?;
            }
            _ => return self.skip_item(token, "`camera`"),
        }
        Ok(())
    }

    fn finish_camera(&mut self, mut draft: Draft, place: Place) -> PResult<Camera> {
        if let (Some((angle, _)), Projection::Perspective | Projection::Orthographic) =
            (draft.angle, draft.projection)
            && !(angle > 0.0 && angle < 180.0)
        {
            let message =
                format!("the angle of this camera must be between 0 and 180 degrees, not {angle}");
            return Err(self.fail(place, message));
        }
        if !draft.named || draft.angle.is_some() {
            draft.apply_angle();
        }
        if let Some(point) = draft.look_at
            && !draft.turn_to(point)
        {
            self.warn(
                place,
                "`look_at` has no effect: the point is where the camera is",
            );
        }
        let t = &draft.transform;
        let camera = Camera {
            eye: t.point_to_world(draft.location),
            direction: t.vector_to_world(draft.direction),
            right: t.vector_to_world(draft.right) * 0.5,
            up: t.vector_to_world(draft.up) * 0.5,
            projection: draft.projection,
            aspect: Some(1.0),
            span: self.span_at(place),
        };
        match camera.problem() {
            None => Ok(camera),
            Some(problem) => Err(self.fail(place, problem)),
        }
    }
}
