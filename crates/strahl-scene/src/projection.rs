use std::sync::Arc;
use strahl_math::{DVec2, DVec3, Transform};

/// The projection of a camera. Angles are full angles in radians, from edge to edge of the picture.
///
/// The cameras besides perspective and orthographic ones are those of POV-Ray (manual, "Types of Projection"; the formulas were
/// found by measuring the directions of its rays).
#[derive(Clone, Debug, PartialEq)]
pub enum Projection {
    /// All rays start at the eye.
    Perspective,
    /// Parallel to the viewing direction, from the plane through the eye.
    Orthographic,
    /// The angle to the viewing direction grows with the distance from the centre of the picture; beyond the circle of the
    /// picture that the lengths of `right` and `up` leave, nothing is seen.
    Fisheye {
        /// Across the whole circle.
        angle: f64,
    },
    /// A fisheye that fills the rectangle.
    UltraWideAngle {
        /// From the left to the right edge; from bottom to top it is this times the ratio of `up` to `right`.
        angle: f64,
    },
    /// A fisheye of 180 degrees with the lens of Omnimax projectors: the view ends 45 degrees below the horizon.
    Omnimax,
    /// Onto an ellipsoid whose axes are `right`, `up` and `direction`: 180 degrees in both directions.
    Panoramic,
    /// Onto a cylinder around the eye.
    Cylinder {
        /// Whether the axis of the cylinder is `up`, and not `right`.
        upright: bool,
        /// Whether the eye moves along the axis, so that rays stand at right angles to it.
        moving: bool,
        /// Around the axis.
        angle: f64,
    },
    /// Onto a sphere by longitude and latitude.
    Spherical {
        /// From the left to the right edge.
        horizontal: f64,
        /// From the bottom to the top edge.
        vertical: f64,
    },
    /// A ray for each face of a mesh.
    Mesh(Arc<MeshCamera>),
}

impl Projection {
    /// Its name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Perspective => "perspective",
            Self::Orthographic => "orthographic",
            Self::Fisheye { .. } => "fisheye",
            Self::UltraWideAngle { .. } => "ultra wide angle",
            Self::Omnimax => "omnimax",
            Self::Panoramic => "panoramic",
            Self::Cylinder { .. } => "cylindrical",
            Self::Spherical { .. } => "spherical",
            Self::Mesh(_) => "mesh",
        }
    }

    /// The angles, if there are any.
    pub(crate) fn angles(&self) -> impl Iterator<Item = f64> {
        let (a, b) = match self {
            Self::Fisheye { angle }
            | Self::UltraWideAngle { angle }
            | Self::Cylinder { angle, .. } => (Some(*angle), None),
            Self::Spherical {
                horizontal,
                vertical,
            } => (Some(*horizontal), Some(*vertical)),
            _ => (None, None),
        };
        a.into_iter().chain(b)
    }
}

/// Rays from the faces of meshes, along their normals (POV-Ray manual, "Mesh projection").
#[derive(Clone, Debug, PartialEq)]
pub struct MeshCamera {
    /// Which face belongs to a pixel.
    pub layout: MeshLayout,
    /// The meshes.
    pub meshes: Vec<CameraMesh>,
    /// Distance of a ray's origin in front of its face.
    pub offset: f64,
    /// Whether rays start at the back of the faces.
    pub reversed: bool,
    /// Whether directions are interpolated between the normals of the corners, in the layout by uv coordinates.
    pub smooth: bool,
}

/// Which face of a mesh camera a pixel gets. Pixels are counted row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshLayout {
    /// Its own number, in each of so many meshes; the mean of their rays is seen.
    Each(u32),
    /// Its own number, and that number after each further picture, in all meshes together; the mean of so many rays is seen.
    Joined(u32),
    /// Its own number in the mesh of its part of the picture, which the meshes share from left to right.
    SideBySide,
    /// The face of the first mesh that its place in the picture lies in, by uv coordinates.
    ByUv,
}

/// A mesh that serves as camera: the faces of its parts, numbered consecutively.
///
/// Cameras that take many rays for a pixel consist of many copies of one mesh, moved a little each. Their parts share the faces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CameraMesh {
    parts: Vec<CameraPart>,
}

/// Faces and the place where they are.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPart {
    /// The faces, in a space of their own.
    pub faces: Arc<[CameraFace]>,
    /// The map from that space to the world.
    pub transform: Transform,
}

impl CameraPart {
    /// The corners of a face in the world.
    #[inline]
    pub fn corners_in_world(&self, face: &CameraFace) -> [DVec3; 3] {
        let [a, b, c] = face.corners;
        let map = &self.transform;
        [
            map.point_to_world(a),
            map.point_to_world(b),
            map.point_to_world(c),
        ]
    }

    /// A face in the world.
    pub fn in_world(&self, face: &CameraFace) -> CameraFace {
        let map = &self.transform;
        let turned = |n: DVec3| map.normal_to_world(n).normalize_or_zero();
        CameraFace {
            corners: self.corners_in_world(face),
            normals: face.normals.map(|n| n.map(turned)),
            ..*face
        }
    }
}

impl CameraMesh {
    /// Adds faces behind those there are.
    pub fn push(&mut self, part: CameraPart) {
        self.parts.push(part);
    }

    /// The parts, in the order of their faces.
    pub fn parts(&self) -> &[CameraPart] {
        &self.parts
    }

    /// The number of faces.
    pub fn len(&self) -> usize {
        self.parts.iter().map(|part| part.faces.len()).sum()
    }

    /// Whether there are no faces.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A face and its part; `None` if there are fewer.
    pub fn find(&self, mut index: usize) -> Option<(&CameraPart, &CameraFace)> {
        for part in &self.parts {
            match part.faces.get(index) {
                Some(face) => return Some((part, face)),
                None => index -= part.faces.len(),
            }
        }
        None
    }
}

impl From<Vec<CameraFace>> for CameraMesh {
    /// Faces that are where they are in the world.
    fn from(faces: Vec<CameraFace>) -> Self {
        let part = CameraPart {
            faces: faces.into(),
            transform: Transform::IDENTITY,
        };
        Self { parts: vec![part] }
    }
}

/// A face of a mesh that serves as camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraFace {
    /// The corners.
    pub corners: [DVec3; 3],
    /// The side to which the normal of the plane points.
    pub front: CameraFront,
    /// The unit normals at the corners.
    pub normals: Option<[DVec3; 3]>,
    /// The uv coordinates of the corners.
    pub uv: Option<[DVec2; 3]>,
}

/// The side of a face from which its corners run in this direction, in left-handed space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraFront {
    /// Clockwise.
    Clockwise,
    /// Counter-clockwise.
    Counterclockwise,
}

impl CameraFront {
    /// The unit normal of the plane through these corners; z if they are on a line.
    #[inline]
    pub fn normal(self, [a, b, c]: [DVec3; 3]) -> DVec3 {
        let clockwise = (c - a).cross(b - a).normalize_or(DVec3::Z);
        match self {
            Self::Clockwise => clockwise,
            Self::Counterclockwise => -clockwise,
        }
    }
}

impl CameraFace {
    /// The unit normal of the plane; z if the corners are on a line.
    pub fn normal(&self) -> DVec3 {
        self.front.normal(self.corners)
    }
}
