//! `camera { ... }`: the view; effects such as focal blur are read in [`effects`].

mod effects;
mod mesh;

use crate::keywords::Word;
use crate::parser::{PResult, Parser, Place};
use crate::token::Token;
use effects::LensDraft;
use mesh::MeshDraft;
use std::sync::Arc;
use strahl_math::{DVec3, Transform, det};
use strahl_scene::{Camera, Projection, Span};
use strahl_shade::normal::PovNormal;

/// The version from which on `angle` and `direction` have an effect on orthographic cameras, each camera starts from the default, and the order of
/// its items does not matter.
const CAMERAS_SINCE: f64 = 3.5;

/// `camera { ... }` as a statement: the last one counts.
pub(super) fn camera_statement(p: &mut Parser<'_>) -> PResult<()> {
    // Before version 3.5 a second camera changes the first (measured).
    let base = match (&p.scene.camera, p.version < CAMERAS_SINCE) {
        (Some(camera), true) => Draft::of(camera),
        _ => Draft::new(),
    };
    let camera = p.camera_on(base)?;
    p.scene.camera = Some(camera);
    Ok(())
}

/// The view of a scene without a `camera` statement: from the origin along z.
pub(crate) fn default_camera() -> Camera {
    let draft = Draft::new();
    Camera {
        eye: draft.location,
        direction: draft.direction,
        right: draft.right * 0.5,
        up: draft.up * 0.5,
        lens: None,
        normal: None,
        projection: draft.projection,
        aspect: Some(1.0),
        span: Span::NONE,
    }
}

/// A camera being read. The order of items does not matter: the view is computed at the closing brace, first the angle, then
/// `look_at`, then the transformations. Before version 3.5 each item acts on the vectors as they are where it stands (both measured with POV-Ray 3.7).
struct Draft {
    location: DVec3,
    direction: DVec3,
    /// Its length is the width of the picture.
    right: DVec3,
    /// Its length is the height of the picture.
    up: DVec3,
    sky: DVec3,
    look_at: Option<DVec3>,
    /// Horizontal and vertical angle in degrees.
    angle: Option<(f64, Option<f64>)>,
    projection: Projection,
    /// The meshes of `mesh_camera`.
    mesh: Option<MeshDraft>,
    /// Whether a mesh camera uses interpolated normals.
    smooth: bool,
    lens: LensDraft,
    normal: Option<Arc<PovNormal>>,
    /// Whether `right` or `up` was given.
    sized: bool,
    /// Whether it is a declared camera, whose view is already computed.
    named: bool,
    /// Whether an item has been read.
    begun: bool,
    /// Whether `right` and `up` are the size of the view, as in orthographic cameras before version 3.5.
    fixed: bool,
    /// Whether each item acts at once, as before version 3.5.
    in_order: bool,
    /// Of a camera whose items act at once it moves only the focal point.
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
            mesh: None,
            smooth: false,
            lens: LensDraft::default(),
            normal: None,
            sized: false,
            named: false,
            begun: false,
            fixed: false,
            in_order: false,
            transform: Transform::IDENTITY,
        }
    }

    fn of(camera: &Camera) -> Self {
        Self {
            location: camera.eye,
            direction: camera.direction,
            right: camera.right * 2.0,
            up: camera.up * 2.0,
            projection: camera.projection.clone(),
            lens: LensDraft::of(camera),
            normal: camera.normal.clone(),
            sized: true,
            named: true,
            begun: true,
            ..Self::new()
        }
    }

    /// Turns the camera to a point; lengths and handedness of its vectors stay. Returns `false` if the point is at the camera.
    fn turn_to(&mut self, point: DVec3) -> bool {
        let forward = (point - self.location).normalize_or_zero();
        if forward == DVec3::ZERO {
            return false;
        }
        let handedness = self.up.cross(self.direction).dot(self.right);
        let sideways = self.sky.cross(forward);
        // If the direction is parallel to the sky, the camera keeps its right vector.
        let right = if sideways.length() > 1e-12 * self.sky.length() {
            sideways.normalize()
        } else {
            self.right.normalize_or(DVec3::X)
        };
        // An `up` parallel to the direction, which is the default in scenes with z up, counts as right-handed.
        let side = if handedness > 0.0 { 1.0 } else { -1.0 };
        let up = forward.cross(right).normalize_or(DVec3::Y);
        self.direction = forward * self.direction.length();
        self.right = right * (self.right.length() * side);
        self.up = up * self.up.length();
        true
    }

    /// `orthographic` before version 3.5 (measured): as the first item it makes `right` and `up` the size of the view; after other
    /// items it sets them to the view of the perspective camera described so far, at the distance of `look_at`.
    fn fix_size(&mut self) {
        if self.begun && !self.fixed {
            let distance = (self.look_at.unwrap_or(DVec3::Z) - self.location).length();
            let scale = distance / self.direction.length();
            self.right *= scale;
            self.up *= scale;
        }
        self.fixed = true;
    }

    /// Half of the width of the view at a distance of 1, if there is an angle.
    fn slope(&self) -> Option<f64> {
        self.angle
            .filter(|(angle, _)| *angle != 0.0)
            .map(|(angle, _)| det::tan(angle.to_radians() * 0.5))
    }

    /// Makes the direction so long that the width of the picture fits the slope.
    fn fit_direction(&mut self, slope: f64) {
        let distance = self.right.length() * 0.5 / slope;
        self.direction = self.direction.normalize_or_zero() * distance;
    }

    /// Moves the view.
    fn apply(&mut self, t: &Transform) {
        self.location = t.point_to_world(self.location);
        self.direction = t.vector_to_world(self.direction);
        self.right = t.vector_to_world(self.right);
        self.up = t.vector_to_world(self.up);
    }

    /// Scales the vectors to fit the angle.
    fn apply_angle(&mut self) {
        let slope = self.slope();
        match (&self.projection, slope) {
            (Projection::Perspective, Some(slope)) => self.fit_direction(slope),
            (Projection::Orthographic, _) => {
                // An orthographic camera shows what a perspective camera would show at the distance of `look_at`.
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

    /// Whether straight lines stay straight.
    fn is_flat(&self) -> bool {
        matches!(
            self.projection,
            Projection::Perspective | Projection::Orthographic
        )
    }

    /// An angle of 0, which exporters write, does not count for flat pictures; but an orthographic camera with it is no wider than a perspective
    /// one, whether `right` and `up` are given or not (measured).
    fn drop_no_angle(&mut self) {
        if self.is_flat() && matches!(self.angle, Some((0.0, _))) {
            self.angle = None;
            self.sized = false;
        }
    }

    /// Puts the angle into projections that have one; without an angle, POV-Ray's default stays.
    fn fill_angle(&mut self) {
        let Some((across, upwards)) = self.angle else {
            return;
        };
        match &mut self.projection {
            Projection::Fisheye { angle }
            | Projection::UltraWideAngle { angle }
            | Projection::Cylinder { angle, .. } => *angle = across.to_radians(),
            Projection::Spherical {
                horizontal,
                vertical,
            } => {
                *horizontal = across.to_radians();
                *vertical = upwards.unwrap_or(0.5 * across).to_radians();
            }
            _ => {}
        }
    }
}

/// The projection that a word names, with its default angle (measured with POV-Ray 3.7).
fn projection_of(word: Word) -> Option<Projection> {
    let angle = std::f64::consts::FRAC_PI_2;
    Some(match word {
        Word::Perspective => Projection::Perspective,
        Word::Orthographic => Projection::Orthographic,
        Word::Fisheye => Projection::Fisheye { angle },
        Word::UltraWideAngle => Projection::UltraWideAngle { angle },
        Word::Omnimax => Projection::Omnimax,
        Word::Panoramic => Projection::Panoramic,
        Word::Spherical => Projection::Spherical {
            horizontal: 4.0 * angle,
            vertical: 2.0 * angle,
        },
        _ => return None,
    })
}

impl Parser<'_> {
    /// `{ ... }` or `{ Name ... }` after `camera`.
    pub(super) fn camera(&mut self) -> PResult<Camera> {
        self.camera_on(Draft::new())
    }

    fn camera_on(&mut self, mut draft: Draft) -> PResult<Camera> {
        let place = self.place();
        draft.in_order = self.version < CAMERAS_SINCE;
        self.braces(|p| {
            p.items("`camera`", |p, token| {
                let named = p.accept_thing(|thing| match thing {
                    super::Thing::Camera(camera) => Some(camera),
                    _ => None,
                })?;
                if let Some(camera) = named {
                    let in_order = draft.in_order;
                    draft = Draft {
                        in_order,
                        ..Draft::of(&camera)
                    };
                    return Ok(());
                }
                p.camera_item(&mut draft, token)?;
                draft.begun = true;
                Ok(())
            })
        })?;
        self.finish_camera(draft, place)
    }

    fn camera_item(&mut self, draft: &mut Draft, token: Token) -> PResult<()> {
        if let Some(next) = self.transformation(token)? {
            draft.transform = draft.transform.then(&next);
            if draft.in_order {
                draft.apply(&next);
            }
            return Ok(());
        }
        let Some(word) = token.word() else {
            return Err(self.unexpected(token, "an item of `camera`, or `}`"));
        };
        if let Some(projection) = projection_of(word) {
            self.take(token)?;
            if projection == Projection::Orthographic && self.version < CAMERAS_SINCE {
                draft.fix_size();
            }
            draft.projection = projection;
            return Ok(());
        }
        match word {
            Word::Cylinder => {
                self.take(token)?;
                draft.projection = self.cylinder_camera()?;
            }
            Word::MeshCamera => {
                self.take(token)?;
                draft.mesh = Some(self.mesh_camera()?);
            }
            Word::Smooth => {
                self.take(token)?;
                draft.smooth = self.switched()?;
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
                let acts = draft.in_order && draft.is_flat();
                if let Some(slope) = draft.slope().filter(|_| acts) {
                    draft.fit_direction(slope);
                }
            }
            Word::LookAt => {
                self.take(token)?;
                let (place, point) = (self.place_of(token), self.vector3()?);
                draft.look_at = Some(point);
                if draft.in_order {
                    self.turn_camera(draft, point, place);
                }
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
            _ => return self.camera_effect(draft, token, word),
        }
        Ok(())
    }

    /// Carries out `look_at`.
    fn turn_camera(&mut self, draft: &mut Draft, point: DVec3, place: Place) {
        if !draft.turn_to(point) {
            self.warn(
                place,
                "`look_at` has no effect: the point is where the camera is",
            );
        }
    }

    /// The type after `cylinder`, 1 to 4.
    fn cylinder_camera(&mut self) -> PResult<Projection> {
        let number = self.float()?;
        let (upright, moving) = match number {
            1.0 => (true, false),
            2.0 => (false, false),
            3.0 => (true, true),
            4.0 => (false, true),
            other => {
                let place = self.place();
                let message =
                    format!("the type of a cylinder camera must be 1, 2, 3 or 4, not {other}");
                return Err(self.fail(place, message));
            }
        };
        Ok(Projection::Cylinder {
            upright,
            moving,
            angle: std::f64::consts::FRAC_PI_2,
        })
    }

    fn finish_camera(&mut self, mut draft: Draft, place: Place) -> PResult<Camera> {
        draft.drop_no_angle();
        if let (Some((angle, _)), Projection::Perspective | Projection::Orthographic) =
            (draft.angle, &draft.projection)
            && !(angle > 0.0 && angle < 180.0)
        {
            let message =
                format!("the angle of this camera must be between 0 and 180 degrees, not {angle}");
            return Err(self.fail(place, message));
        }
        draft.fill_angle();
        if !draft.in_order && (!draft.named || draft.angle.is_some()) {
            draft.apply_angle();
        }
        if let Some(mesh) = draft.mesh.take() {
            // Here `location` is the distance of a ray's start from its face, and `direction` selects the side to which it goes.
            let camera = mesh.finish(draft.location.z, draft.direction.z < 0.0, draft.smooth);
            draft.projection = Projection::Mesh(Arc::new(camera));
        }
        if !draft.in_order {
            if let Some(point) = draft.look_at {
                self.turn_camera(&mut draft, point, place);
            }
            let all = draft.transform;
            draft.apply(&all);
        }
        let camera = Camera {
            eye: draft.location,
            direction: draft.direction,
            right: draft.right * 0.5,
            up: draft.up * 0.5,
            lens: draft.lens.finish(&draft.transform),
            normal: draft.normal,
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
